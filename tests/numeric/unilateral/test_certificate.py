"""The bound that a packing's proof rests on: a sparse matrix' smallest singular value."""

from typing import Any

import numpy as np
import pytest
from force_diffusion.numeric.arithmetic.errors import UndecidedError
from force_diffusion.numeric.unilateral import certificate
from force_diffusion.numeric.unilateral.certificate import smallest_singular_value
from scipy.sparse import csc_array, eye_array, random_array
from scipy.sparse.linalg import splu

Array = np.ndarray


def bound(dense: Array, near: Array | None = None) -> float:
    """Bound it; ``near``: the matrix whose factors choose the shift, by default the same."""
    factors = splu(csc_array(dense if near is None else near))
    return smallest_singular_value(csc_array(dense), factors)


def matrix(n: int, seed: int) -> Array:
    sparse = random_array((n, n), density=min(1, 4 / n), rng=np.random.default_rng(seed))
    return np.asarray(sparse.toarray() + np.eye(n))


@pytest.mark.parametrize("n", [1, 2, 5, 40, 300])
@pytest.mark.parametrize("seed", [1, 2, 3])
def test_the_smallest_singular_value_is_bounded_from_below_and_well(n: int, seed: int) -> None:
    dense = matrix(n, seed)
    exact = np.linalg.svd(dense, compute_uv=False)[-1]
    assert exact / 4 < bound(dense) <= exact


@pytest.mark.parametrize("wrong", [1e3, 1e-2])
def test_the_bound_holds_whatever_chose_the_shift(wrong: float) -> None:
    """Factors of a larger matrix give too large a shift, which is made smaller until it holds."""
    dense = matrix(40, 1)
    exact = np.linalg.svd(dense, compute_uv=False)[-1]
    assert bound(dense, wrong * dense) <= exact


def test_the_bound_holds_whatever_the_factorisation(monkeypatch: pytest.MonkeyPatch) -> None:
    """Factors of another matrix leave more than the shift, and prove nothing."""

    def wrong(shifted: Any, *how: Any, **options: Any) -> Any:
        return splu((shifted + eye_array(shifted.shape[0])).tocsc(), *how, **options)

    monkeypatch.setattr(certificate, "splu", wrong)
    with pytest.raises(UndecidedError):
        bound(matrix(40, 1) * 0.1)


def test_a_matrix_known_by_hand() -> None:
    """[[1, 1], [0, 1]]: the golden ratio and its inverse."""
    assert 0.4 < bound(np.array([[1.0, 1.0], [0.0, 1.0]])) <= (np.sqrt(5) - 1) / 2


@pytest.mark.parametrize("smallest", [0.0, 1e-12, 1e-9])
def test_nothing_is_bounded_where_rounding_is_larger(smallest: float) -> None:
    """Its square is below 1e-16, the rounding of the others'."""
    turn = np.linalg.qr(np.random.default_rng(1).standard_normal((8, 8)))[0]
    dense = turn @ np.diag([*[1.0] * 7, smallest]) @ turn.T
    with pytest.raises(UndecidedError, match="too inaccurate to bound"):
        bound(dense, np.eye(8) if smallest == 0 else dense)
