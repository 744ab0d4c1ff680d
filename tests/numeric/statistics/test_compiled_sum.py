"""Compiled sums against the exact ones: every digit, every rounding, every count."""

import math

import numpy as np
import pytest
from force_diffusion.numeric.arithmetic.systems import Array
from force_diffusion.numeric.statistics.exact_sum import rows_and_squares
from hypothesis import given
from hypothesis import strategies as st

pytest.importorskip("numba")
from force_diffusion.numeric.statistics.compiled import Tally

GROUPS = 3


@st.composite
def changes(draw: st.DrawFn) -> Array:
    """Packings of three groups on two branches, (packings, 2, 3 n), over many binades."""
    packings, n = draw(st.integers(1, 3)), draw(st.sampled_from([1, 7, 256, 300]))
    size = 2.0 ** draw(st.sampled_from([0, -10, -300]))
    numbers = st.floats(-1, 1, allow_subnormal=False) | st.integers(-90, 0).map(
        lambda e: math.ldexp(1.5, e)
    )
    # 5400 draws of a number each would be more than Hypothesis takes: draw some, and place them
    few = draw(st.lists(numbers, min_size=1, max_size=60))
    places = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    return places.choice(few, (packings, 2, GROUPS * n)) * size


def pieces(n: int) -> Array:
    """A group holds as many contacts of either branch."""
    return np.array([(g, branch, g * n, g * n, n) for g in range(GROUPS) for branch in (0, 1)])


@given(changes(), st.integers(-330, 3), st.floats(1e-3, 1))
def test_sums_and_counts_are_the_exact_ones(g: Array, unit: int, reach: float) -> None:
    n, packings = g.shape[2] // GROUPS, len(g)
    edges = tuple(np.linspace(-reach, reach, 8).tolist())
    F = np.linspace(0, 1, GROUPS * n)
    tally = Tally(pieces(n), (F, F), GROUPS, 2 * n, unit, edges)
    means = tally.add(g)
    rows = g.reshape(packings, 2, GROUPS, n).transpose(2, 0, 1, 3)
    exact = rows_and_squares(rows.reshape(-1, 2 * n))
    if means is None:  # then nothing was added, and some number is very small
        # beside the largest, or below the 2^-400 at which squares would lose digits
        assert np.abs(g[g != 0]).min() < max(np.abs(g).max() * 2.0**-90, 2.0**-400)
        assert not tally.tensile.any()
        return
    assert means is not None
    for k, (total, found) in enumerate(zip(exact, tally.sums(), strict=True)):
        by_packing = total.reshaped(GROUPS, packings)
        assert found == by_packing.over(1)
        usual = by_packing.rounded(-(k + 1) * unit) / (2 * n)
        assert means[k].tobytes() == usual.tobytes()
    pulls = (F.reshape(GROUPS, 1, 1, n) + rows < 0).sum(axis=(1, 2, 3))
    assert tally.tensile.tolist() == pulls.tolist()
    places = np.searchsorted(edges, g, side="right").reshape(packings, -1)
    counts = np.array([np.bincount(one, minlength=len(edges) + 1) for one in places])
    assert tally.bins.tolist() == [counts.sum(axis=0).tolist(), (counts**2).sum(axis=0).tolist()]


@pytest.mark.parametrize("odd", [np.nan, np.inf, 2.0**30, 2.0**-500])
def test_what_is_out_of_the_ordinary_is_left_to_the_exact_sums(odd: float) -> None:
    g = np.full((2, 2, GROUPS), odd)
    g[0] = 1e-3
    tally = Tally(pieces(1), (np.ones(GROUPS), np.ones(GROUPS)), GROUPS, 2, 0, ())
    assert tally.add(g) is None
    assert tally.sums()[0].fractions() == [0] * GROUPS
