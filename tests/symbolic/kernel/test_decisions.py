"""The checker: what is false is refuted, what it can't read is undecided, what holds is proved."""

import pytest
import sympy
from force_diffusion.symbolic.algebra.affine import Region
from force_diffusion.symbolic.kernel.decisions import (
    Ruling,
    Verdict,
    all_of,
    decide_identity,
    decide_linear,
    decide_vector_identity,
    proved,
    refuted,
    undecided,
)
from force_diffusion.symbolic.symbols import (
    DeltaR,
    DeltaX,
    Dot,
    M,
    b_plus,
    i,
    j,
    m,
    n_minus,
    n_plus,
    n_x,
    n_y,
    phi,
    r,
)

LAYERS = Region({j: 1, M: j + 1})
LINE = sympy.Sum(DeltaR(i - j + m, m), (m, 1, j))


@pytest.mark.parametrize(
    ("left", "right"),
    [
        (LINE, sympy.Sum(DeltaR(i - m, j - m), (m, 0, j - 1))),
        (LINE, sympy.Sum(DeltaR(i - j + m, m), (m, 1, j - 1)) + DeltaR(i, j)),
        (Dot(n_plus, b_plus) * DeltaR(i, j), DeltaR(i, j)),
        ((1 - phi**2) * DeltaR(i, j), 4 * n_x**2 * n_y**2 * DeltaR(i, j)),
    ],
)
def test_what_holds_is_proved(left: sympy.Expr, right: sympy.Expr) -> None:
    assert decide_linear(left, right, LAYERS).verdict is Verdict.PROVED


@pytest.mark.parametrize(
    ("left", "right"),
    [
        (LINE, -LINE),
        (LINE, sympy.Sum(DeltaR(i - j + m, m), (m, 1, j - 1))),
        (LINE, sympy.Sum(DeltaR(i - j + m, m), (m, 0, j))),
        (LINE, sympy.Sum(DeltaR(i + j - m, m), (m, 1, j))),
        (DeltaR(i, j), DeltaR(i + 2, j)),
        (DeltaR(i, j), phi * DeltaR(i, j)),
        (DeltaR(i, j), sympy.Integer(1)),
        (Dot(n_plus, n_minus) * DeltaR(i, j), DeltaR(i, j)),
    ],
)
def test_what_is_false_is_refuted(left: sympy.Expr, right: sympy.Expr) -> None:
    ruling = decide_linear(left, right, LAYERS)
    assert ruling.verdict is Verdict.REFUTED
    assert "weight" in ruling.note


@pytest.mark.parametrize(
    "strange",
    [
        sympy.sin(phi) * DeltaR(i, j),
        DeltaR(i, j) * DeltaR(i, j),
        sympy.Float(1.0) * DeltaR(i, j),
        n_plus,
    ],
)
def test_what_can_not_be_read_is_undecided(strange: sympy.Expr) -> None:
    assert decide_linear(strange, strange, LAYERS).verdict is Verdict.UNDECIDED


@pytest.mark.parametrize(
    "strange",
    [
        DeltaR(i, j) / phi,  # φ may be zero
        DeltaR(i, j) / (j - 1),
        sympy.Sum(DeltaR(i - j + m, m), (m, 3, j)),  # its bounds cross for j = 1
    ],
)
def test_what_has_no_value_is_not_a_statement(strange: sympy.Expr) -> None:
    assert decide_linear(strange, strange, LAYERS).verdict is Verdict.NOT_A_STATEMENT


def test_identities() -> None:
    assert decide_identity(phi, n_y**2 - n_x**2).verdict is Verdict.PROVED
    assert decide_identity(phi, n_x**2 - n_y**2).verdict is Verdict.REFUTED
    assert decide_identity(r / r, sympy.Integer(1)).verdict is Verdict.PROVED
    assert decide_identity(sympy.sqrt(r), r).verdict is Verdict.UNDECIDED
    at = DeltaX(i, j)
    assert decide_vector_identity(2 * at + n_plus, n_plus + at + at).verdict is Verdict.PROVED
    assert decide_vector_identity(at, n_plus).verdict is Verdict.REFUTED


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
