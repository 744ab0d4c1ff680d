"""Attacks on means at second order."""

from collections.abc import Callable
from functools import cache

import sympy
from force_diffusion.symbolic.as_printed import terms, times
from force_diffusion.symbolic.kernel import axioms, moments, rules
from force_diffusion.symbolic.kernel.any_dimension import SURFACE as IN_ANY_DIMENSION
from force_diffusion.symbolic.kernel.mean_balance import mean_below
from force_diffusion.symbolic.kernel.rules import Rule
from force_diffusion.symbolic.kernel.theorem import NotProvedError, Theorem
from force_diffusion.symbolic.kernel.where import LOADED, PASSING, POINT, SURFACE, Loading, Where
from force_diffusion.symbolic.symbols import (
    DeltaNMinus,
    DeltaNPlus,
    DeltaR,
    DeltaX,
    Dot,
    ForceMinus,
    ForceOfLayer,
    ForcePlus,
    Load,
    M,
    Shift,
    b_minus,
    b_plus,
    d,
    e_y,
    epsilon,
    f_load,
    i,
    j,
    k,
    l,
    n_minus,
    n_plus,
    n_x,
    n_y,
    phi,
    r,
    sigma,
    site_r,
    site_s,
)
from sympy import Eq, Expr, Pow, S, Symbol

from .attack import BEADS, HERE, attack, only_supposed, told

UNKNOWN = Symbol("nu", real=True)
FORCE = ForcePlus(i, j) / f_load
RAISED = Dot(e_y, DeltaX(i, j))
ANY = Where((j, M), (j >= 0, j + 1 <= M), IN_ANY_DIMENSION, dimension=d)
AT_POINT = Where.of(Eq(j, l - 1), Eq(i, k - 1), l >= 2, loading=POINT)
ABOVE_LOADS = Where.of(Eq(j, M - 1), j >= 1, loading=SURFACE)
ONE_LAYER = Where.of(Eq(j, 0), Eq(M, 1), loading=SURFACE)
"""The contacts between the base and one layer of loaded beads."""


def _loads_at(*loads: tuple[int, int]) -> Loading:
    """Loads on beads at these places across the surface; of others nothing is said."""
    above = [one for one in SURFACE.everywhere if not one[0].lhs.has(Load)]
    given = [
        (Eq(Load(across, M), -number * f_load * e_y, evaluate=False), ())
        for across, number in loads
    ]
    return Loading("two loads", "two beads of the surface carry loads", (M,), (), (*above, *given))


TWO_LOADS = Where.of(
    Eq(j, 0), Eq(M, 1), Eq(i, -1), loading=_loads_at((0, 1), (-2, 3)),
)  # fmt: skip
"""The two contacts of bead (−1, 0) below them."""


@cache
def _radii() -> tuple[Theorem | tuple[Theorem, ...], ...]:
    """Directions of the contacts of the base, by the displacements of the beads that it bears."""
    rows, turns = [], []
    for branch, unit, turn in ((1, n_plus, DeltaNPlus(i, j)), (-1, n_minus, DeltaNMinus(i, j))):
        moved = DeltaX(i, j) - DeltaX(i - branch, j - 1)
        touch = DeltaR(i, j) + DeltaR(i - branch, j - 1)
        rule = rules.order(axioms.contact(branch), 1)
        rows.append(told(rule, 4 * r * Dot(unit, moved), 4 * r * touch, Where.of(j >= 1)))
        apart = DeltaX(i + branch, j + 1) - DeltaX(i, j)
        touch = DeltaR(i, j) + DeltaR(i + branch, j + 1)
        rule = rules.order(axioms.direction(branch), 1)
        turns.append(told(rule, 2 * r * turn, apart - unit * touch, BEADS))
    left, right = (DeltaR(i, j) + DeltaR(i - branch, 0) for branch in (1, -1))
    borne = told(
        rules.solve(rows, [DeltaX(i, j)], axioms.base()), DeltaX(i, j),
        left * b_plus + right * b_minus, Where.of(Eq(j, 1)),
    )  # fmt: skip
    return tuple(turns), borne, axioms.base()


@cache
def _forces(where: Where, left: int = 1) -> tuple[Theorem, Theorem]:
    """Both forces on the bead (i, j) below loaded ones, the left load so many times the right."""
    assert where.loading is not None
    loads = [
        one if one.formula.lhs.has(site_r) else rules.instance(one, {site_r: i, site_s: j}, where)
        for one in axioms.loads(where.loading)
    ]
    half, square = f_load / (2 * n_y), 1 - phi**2
    turns = Dot(n_minus, DeltaNPlus(i, j)) * phi - Dot(n_plus, DeltaNMinus(i + 2, j))
    other = Dot(n_plus, DeltaNMinus(i, j)) * phi - Dot(n_minus, DeltaNPlus(i - 2, j))
    rule = rules.below(axioms.balance(), *loads)
    return (
        told(rule, ForcePlus(i, j), half * (1 + turns / square), where),
        told(rule, ForceMinus(i, j), left * half * (1 + other / square), where),
    )


def _at_second_order(where: Where) -> Rule:
    """The rule with these forces; directions above the base are given by no fact."""
    if where is TWO_LOADS:
        return moments.moment(_forces(where, 3), *_radii())
    return moments.moment(_forces(ONE_LAYER if where is ONE_LAYER else ABOVE_LOADS), *_radii())


for tried, left, right, where, false, refused in (
    ("a radius", Shift(DeltaR(i, j)), 0, BEADS, "its mean is given",
     "at second order is not known"),
    ("a square", Shift(FORCE**2), 0, ONE_LAYER, "it is the force's and its variance",
     "at second order is not known"),
    ("a product", Shift(FORCE * ForceMinus(i, j)), 0, ONE_LAYER, "they are correlated",
     "at second order is not known"),
    ("an unknown number", Shift(UNKNOWN * FORCE), UNKNOWN * Shift(FORCE), ONE_LAYER,
     "that may fluctuate, too", "depends on the radii is not known"),
    ("an unknown number beside it", Shift(UNKNOWN + FORCE), Shift(FORCE), ONE_LAYER,
     "that may fluctuate, too", "depends on the radii is not known"),
    ("a strength", Shift(epsilon * FORCE), epsilon * Shift(FORCE), ONE_LAYER,
     "orders in ε are not told apart", "depends on the radii is not known"),
    ("another value", Shift(FORCE), 2 * Shift(FORCE), ONE_LAYER, "it is half of it",
     "both sides differ"),
    ("a force that no fact gives", Shift(FORCE), 0,
     Where.of(j >= 2, j + 2 <= M, loading=SURFACE), "it may be any", "not given by the radii"),
    ("directions that no fact gives", Shift(FORCE), 0, ABOVE_LOADS, "they tilt",
     "not given by the radii"),
    ("a load on one bead", Shift(FORCE), 0, AT_POINT, "contacts of a layer differ",
     "alike along a layer"),
    ("loads that differ along the layer", Shift(FORCE),
     sigma**2 * (5 - 17 * phi + 11 * phi**2 - 3 * phi**3) / (4 * n_y * r**2 * (1 - phi**2) ** 2),
     TWO_LOADS, "the force below a bead of the surface does not depend on the load of the next",
     "alike along a layer"),
    ("no load", Shift(FORCE), 0, BEADS, "no force is known", "alike along a layer"),
    ("another direction", Shift(Dot(b_plus, DeltaX(i, j))), 0, Where.of(j >= 1),
     "that is half of it", "at second order is not known"),
    ("any dimension", Shift(ForceOfLayer(j)), 0, ANY, "it is not known there",
     "second order is not known"),
):  # fmt: skip

    @attack("moment", f"at second order: {tried}", false, refused)
    def _(left: sympy.Expr = left, right: sympy.Expr | int = right, where: Where = where) -> object:
        return told(_at_second_order(where), left, right, where)


@attack("moment", "at second order: a bead of the base", "that stays where it is",
        "to lie above the base")  # fmt: skip
def _() -> object:
    above = only_supposed(DeltaNPlus(i, j), DeltaR(i, j) * b_minus / r, Where.of(j >= 1))
    value = sigma**2 * (1 + phi - phi**2) / (2 * r * n_y * (1 - phi**2))
    return told(moments.moment(above, *_radii()), Shift(RAISED), value, Where.of(Eq(j, 0)))


# the mean balance of a bead

STILL = tuple(only_supposed(kind(i, j), S.Zero, BEADS) for kind in (DeltaNPlus, DeltaNMinus))
"""No contact turns."""
ENTERS = Where.of(site_s >= 2, loading=PASSING)
BELOW_ONE = Where.of(l >= 2, loading=POINT)
AT_LOADED = Where.of(l >= 2, loading=LOADED)
LEFT = ForcePlus(k - 1, l - 1)


def _carried(where: Where) -> tuple[Theorem, ...]:
    """All forces are f_load."""
    beads = where.also(j >= 0, indices=(i, j))
    return tuple(only_supposed(kind(i, j), f_load, beads) for kind in (ForcePlus, ForceMinus))


def _mean(kind: type[Expr], value: Expr, where: Where) -> Theorem:
    return only_supposed(Shift(kind(i, j)), value, where.also(j >= 0, indices=(i, j)))


for tried, left, right, where, false, refused in (
    ("another value", Shift(LEFT), S.One, BELOW_ONE, "it is 0", "gives another value"),
    ("a load that is not known", Shift(LEFT), S.Zero, AT_LOADED, "it may fluctuate",
     "fluctuates is not known"),
    ("no load", Shift(FORCE * f_load), S.Zero, BEADS, "it may fluctuate",
     "fluctuates is not known"),
    ("a force that enters", Shift(ForcePlus(site_r - 1, site_s - 1)), S.Zero, ENTERS,
     "its mean is not known", "alike along a layer"),
    ("the force itself", LEFT, f_load, BELOW_ONE, "it fluctuates", "is not the mean"),
    ("an unknown number", UNKNOWN, S.Zero, BELOW_ONE, "it is none", "is not the mean"),
    ("a radius", Shift(HERE), S.Zero, BEADS, "no force balances it", "is not one quantity"),
    ("a square", Shift(LEFT**2), S.Zero, BELOW_ONE, "it is the variance", "is not one quantity"),
    ("twice the force", Shift(2 * LEFT), S.Zero, BELOW_ONE, "it is another mean",
     "is not one quantity"),
    ("where it vanishes, perhaps", phi * Shift(LEFT), S.Zero, BELOW_ONE, "φ may be 0",
     "is not shown to vanish"),
):  # fmt: skip

    @attack("mean_below", tried, false, refused)
    def _(left: Expr = left, right: Expr = right, where: Where = where) -> object:
        return told(mean_below(_carried(where), STILL), left, right, where)


for tried, fact, left, where, false, refused in (
    ("the mean of the other branch", lambda: _mean(ForceMinus, S.Zero, BELOW_ONE), Shift(LEFT),
     BELOW_ONE, "each branch has its own", "alike along a layer"),
    ("a force for its mean", lambda: only_supposed(LEFT, S.Zero, BELOW_ONE), Shift(LEFT), BELOW_ONE,
     "zero to first order may be another at second", "alike along a layer"),
    ("the mean of another place", lambda: only_supposed(Shift(ForcePlus(k + 1, l - 1)), S.Zero,
                                                    BELOW_ONE), Shift(LEFT), BELOW_ONE,
     "contacts of a layer differ", "alike along a layer"),
    ("the mean of other layers", lambda: _mean(ForcePlus, S.Zero, BELOW_ONE.also(j >= l)),
     Shift(LEFT), BELOW_ONE, "it is known above alone", "alike along a layer"),
    ("the mean under another load", lambda: _mean(ForcePlus, S.Zero, AT_LOADED), Shift(LEFT),
     BELOW_ONE, "each load has its own", "alike along a layer"),
    ("a mean that is not a number", lambda: _mean(ForcePlus, UNKNOWN, BELOW_ONE), Shift(LEFT),
     BELOW_ONE, "nothing is known of it", "not"),
    ("a push of another direction", lambda: _mean(ForcePlus, S.Zero, BELOW_ONE), Shift(
        LEFT * (n_x + Dot(e_y, DeltaNPlus(k - 1, l - 1)))), BELOW_ONE, "n_x is not upright",
     "at second order is not known"),
    ("a push along another contact", lambda: _mean(ForcePlus, S.Zero, BELOW_ONE), Shift(
        LEFT * (n_y + Dot(e_y, DeltaNPlus(k + 1, l - 1)))), BELOW_ONE, "it turns by itself",
     "at second order is not known"),
    ("a push along the other branch", lambda: _mean(ForcePlus, S.Zero, BELOW_ONE), Shift(
        LEFT * (n_y + Dot(e_y, DeltaNMinus(k - 1, l - 1)))), BELOW_ONE, "it turns by itself",
     "at second order is not known"),
    ("half of a push", lambda: _mean(ForcePlus, S.Zero, BELOW_ONE), Shift(
        LEFT * Dot(e_y, DeltaNPlus(k - 1, l - 1))), BELOW_ONE, "the rest is missing",
     "at second order is not known"),
):  # fmt: skip

    @attack("moment", f"at second order: {tried}", false, refused)
    def _(fact: Callable[[], Theorem] = fact, left: Expr = left, where: Where = where) -> object:
        return told(moments.moment((fact(),), _carried(where), STILL), left, 0, where)


@attack("reach", "the mean of a force", "it belongs to no bead", "belongs to no bead")
def _() -> object:
    return told(rules.reach(axioms.ordered()[0], axioms.ordered()[1:]), Shift(FORCE * f_load), 0)


@attack("reach", "an unknown number", "it belongs to no bead", "belongs to no bead")
def _() -> object:
    return told(rules.reach(axioms.ordered()[0], axioms.ordered()[1:]), UNKNOWN, 0)


@attack("mean_below", "forces that are only supposed", "nothing is proved", "supposed")
def _() -> object:
    found = told(mean_below(_carried(BELOW_ONE), STILL), Shift(LEFT), S.Zero, BELOW_ONE)
    if found.supposed:
        raise NotProvedError("it rests on what is supposed")
    return found


@attack("mean_below", "0/0", "0/0 at φ = 0", "not shown to differ")
def _() -> object:
    nothing = terms(times(phi, Pow(phi, -1)), -1)
    return told(mean_below(_carried(BELOW_ONE), STILL), Shift(LEFT), nothing, BELOW_ONE)
