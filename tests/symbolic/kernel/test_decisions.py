"""The checker: what is false is refuted, what it can't read is undecided, what holds is proved."""

import pytest
import sympy
from force_diffusion.symbolic.kernel.decisions import (
    Ruling,
    Verdict,
    all_of,
    decide_identity,
    proved,
    refuted,
    undecided,
)
from force_diffusion.symbolic.symbols import (
    n_x,
    n_y,
    phi,
    r,
)


def test_identities() -> None:
    assert decide_identity(phi, n_y**2 - n_x**2).verdict is Verdict.PROVED
    assert decide_identity(phi, n_x**2 - n_y**2).verdict is Verdict.REFUTED
    assert decide_identity(r / r, sympy.Integer(1)).verdict is Verdict.PROVED
    assert decide_identity(sympy.sqrt(r), r).verdict is Verdict.UNDECIDED


@pytest.mark.parametrize(
    ("rulings", "worst"),
    [
        ((proved("a"), undecided("b"), refuted("c")), refuted("c")),
        ((proved("a"), undecided("b")), undecided("b")),
        ((proved("a"), proved("b"), proved("a")), proved("a; b")),
    ],
)
def test_one_bad_ruling_spoils_all(rulings: tuple[Ruling, ...], worst: Ruling) -> None:
    assert all_of(*rulings) == worst
    assert str(worst) == f"{worst.verdict}: {worst.note}"
