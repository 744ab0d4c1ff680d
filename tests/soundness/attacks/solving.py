"""Attacks on ``solve`` and ``below``."""

import sympy
from force_diffusion.symbolic.as_printed import minus, terms
from force_diffusion.symbolic.kernel import axioms, rules
from force_diffusion.symbolic.kernel.theorem import Theorem
from force_diffusion.symbolic.kernel.where import SURFACE, Where
from force_diffusion.symbolic.symbols import (
    DeltaNMinus,
    DeltaNPlus,
    DeltaR,
    DeltaX,
    Dot,
    ForceMinus,
    ForcePlus,
    M,
    MatrixTimes,
    Position,
    e_x,
    e_y,
    f_load,
    i,
    j,
    k,
    l,
    n_minus,
    n_plus,
    n_y,
    phi,
    r,
    site_r,
    site_s,
)
from sympy import Eq

from .attack import (
    ABOVE,
    AT_LOAD,
    BEADS,
    HERE,
    NO_SITE,
    ON_LOADED,
    ON_SURFACE,
    attack,
    no_force,
    over_itself,
    told,
)

# solve

SUPPORT, WEIGHT = Position(i, j), 2 * r * n_plus
BALANCE = axioms.balance()
ANY_FORCE = ForcePlus(site_r, site_s)
STEP_UP = axioms.ordered()[1]
NEXT = Position(i + 1, j + 1)


def _cartesian() -> Theorem:
    """A step up along n⁺, written with the unit matrix."""
    unit = MatrixTimes(1, 0, 0, 1, NEXT - SUPPORT)
    return told(rules.follows(STEP_UP), unit, WEIGHT)


MIXED = Dot(n_plus, SUPPORT + WEIGHT) * e_x + Dot(n_minus, SUPPORT + WEIGHT) * e_y
ALONG_X = told(rules.follows(rules.along(STEP_UP, n_plus)), Dot(n_plus, NEXT - SUPPORT), 2 * r)

for name, rows, unknowns, left, right, where, false, refused in (
    ("no statement", (STEP_UP,), (NEXT,), NEXT, terms(SUPPORT, WEIGHT, e_y * NO_SITE,
     minus(e_y * NO_SITE)), BEADS, "no bead is there", "not shown to be at a bead"),
    ("no rows", (), (HERE,), HERE, -1, BEADS, "nothing fixes it", "0 equations for 1"),
    ("no unknowns", (), (), HERE, 0, BEADS, "nothing fixes it", "not what is solved for"),
    ("too few rows", (ALONG_X,), (NEXT,), NEXT, SUPPORT + WEIGHT, BEADS,
     "one part of it is not fixed", "1 equations for 2"),
    ("one row twice", (ALONG_X, ALONG_X), (NEXT,), NEXT, SUPPORT + WEIGHT, BEADS,
     "one part of it is not fixed", "vanish nowhere"),
    ("a row that does not hold", (ON_SURFACE[2],), (ANY_FORCE,), ANY_FORCE, 0,
     Where.of(site_s >= 0, site_s <= M - 1, loading=SURFACE), "the load is carried there",
     "does not hold on all"),
    ("a row of another layer", (axioms.base(),), (DeltaX(i, j),), DeltaX(i, j), 0, BEADS,
     "only the base stays", "does not hold on all"),
    ("another solution", (STEP_UP,), (NEXT,), NEXT, SUPPORT, BEADS, "it is above", "not the solu"),
    ("another unknown", (STEP_UP,), (NEXT,), SUPPORT, NEXT, BEADS, "it is below", "solved for"),
    ("a number for a vector", (STEP_UP,), (NEXT,), NEXT, Dot(n_plus, SUPPORT + WEIGHT),
     BEADS, "it is no vector",
     "equal to a vector"),
    ("components of another basis", (_cartesian(),), (NEXT,), NEXT, MIXED, BEADS,
     "e_x and e_y are not b⁺ and b⁻", "not the solution"),
    ("what it is solved for on both sides", (STEP_UP,), (NEXT,), NEXT, 2 * NEXT - SUPPORT - WEIGHT,
     BEADS, "it says what it is from itself", "not one quantity"),
):  # fmt: skip
    attack("solve", name, false, refused)(
        lambda rs=rows, u=unknowns, a=left, b=right, w=where: told(rules.solve(rs, u), a, b, w)  # type: ignore[misc]
    )


def _solved(row: Theorem, wrong: sympy.Expr | int, where: Where) -> Theorem:
    about = DeltaR(*(where.loading.place if where.loading else (i, j)))
    return told(rules.solve([row], [about]), about, wrong, where)


@attack("solve", "times what vanishes somewhere", "it says nothing where j = 3", "vanish nowhere")
def _() -> object:
    where = Where.of(Eq(j, 3))
    return _solved(told(rules.rewrite(), (j - 3) * HERE, 0, where), 0, where)


@attack("solve", "times a force that vanishes", "0 = 0 says nothing of δr", "vanish nowhere")
def _() -> object:
    return _solved(no_force(DeltaR(k, l)), 0, AT_LOAD)


@attack("solve", "a row divided by a force that vanishes", "0/0 is not 1", "divides by a force")
def _() -> object:
    return _solved(over_itself(DeltaR(k, l), 5), 5, AT_LOAD)


@attack("solve", "a determinant of first order", "changes have no inverse", "vanish nowhere")
def _() -> object:
    first = told(rules.rewrite(), HERE * ABOVE, 0, BEADS)
    return _solved(first, 0, BEADS)


@attack("solve", "a square", "±1 solve it, and so does 0 = 0", "not linear")
def _() -> object:
    row = told(rules.rewrite(ON_LOADED), ForcePlus(k, l) ** 2 + ForcePlus(k, l), 0, AT_LOAD)
    return told(rules.solve([row], [ForcePlus(k, l)]), ForcePlus(k, l), 0, AT_LOAD)


@attack("solve", "a square beside another unknown", "f⁺ is 0 on the surface", "not linear")
def _() -> object:
    where = Where.of(j >= 0, Eq(j, M - 1), loading=SURFACE)
    tilt = (phi * Dot(n_minus, DeltaNPlus(i, j)) - Dot(n_plus, DeltaNMinus(i + 2, j))) / (
        1 - phi**2
    )
    value, force, above = f_load / (2 * n_y) * (1 + tilt), ForcePlus(i, j), ForcePlus(i + 1, M)
    known = told(rules.below(BALANCE, ON_SURFACE), force, value, where)
    squared = told(rules.rewrite(known, ON_SURFACE), force**2 + above, value**2, where)
    return told(rules.solve([squared, known], [force, above]), above, value**2, where)


@attack("solve", "a product of unknowns", "two rows fix more than one pair", "not linear")
def _() -> object:
    where = Where.of(Eq(l, M), l >= 0, loading=SURFACE)
    plus, minus = ForcePlus(k, l), ForceMinus(k, l)
    rows = [
        told(rules.rewrite(ON_SURFACE), plus * minus + plus, 0, where),
        told(rules.rewrite(ON_SURFACE), minus, 0, where),
    ]
    return told(rules.solve(rows, [plus, minus]), plus, 0, where)


# below

attack("below", "no contact force", "a balance fixes two forces", "no contact force")(
    lambda: told(rules.below(BALANCE), HERE, 0)
)
attack("below", "under a bead with a load", "it carries that load", "not the solution")(
    lambda: told(
        rules.below(BALANCE, ON_SURFACE),
        ForcePlus(i, j),
        0,
        Where.of(j >= 0, Eq(j, M - 1), loading=SURFACE),
    )
)
attack("below", "the mirror image's", "it is f_load/2n_y to order 0 only", "not the solution")(
    lambda: told(
        rules.below(BALANCE, ON_SURFACE),
        ForcePlus(i, j),
        f_load / (2 * n_y),
        Where.of(j >= 0, Eq(j, M - 1), loading=SURFACE),
    )
)
