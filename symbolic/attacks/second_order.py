"""Attacks on means at second order."""

from collections.abc import Callable
from functools import cache

import sympy
from force_diffusion.symbolic.as_printed import equation
from force_diffusion.symbolic.attacks.attack import BEADS, HERE, attack, told
from force_diffusion.symbolic.kernel import axioms, moments, rules
from force_diffusion.symbolic.kernel.any_dimension import SURFACE as IN_ANY_DIMENSION
from force_diffusion.symbolic.kernel.mean_balance import mean_below
from force_diffusion.symbolic.kernel.rules import Rule
from force_diffusion.symbolic.kernel.theorem import Supposition, Theorem, made
from force_diffusion.symbolic.kernel.where import LOADED, PASSING, POINT, SURFACE, Where
from force_diffusion.symbolic.symbols import (
    DeltaNMinus,
    DeltaNPlus,
    DeltaR,
    DeltaX,
    Dot,
    ForceMinus,
    ForceOfLayer,
    ForcePlus,
    M,
    Shift,
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
    p,
    phi,
    site_r,
    site_s,
)
from sympy import Eq, Expr, S, Symbol

UNKNOWN = Symbol("nu", real=True)
BELOW_LOADS = Where.of(Eq(j, M - 1), j >= 1, loading=SURFACE)
"""The contacts that bear the loaded beads."""
FORCE = ForcePlus(i, j) / f_load
RAISED = Dot(e_y, DeltaX(i, j))
ANY = Where((j, M), (j >= 0, j + 1 <= M), IN_ANY_DIMENSION, dimension=d)
AT_POINT = Where.of(Eq(j, l - 1), Eq(i, k - 1), l >= 2, loading=POINT)


@cache
def _below_loads() -> tuple[Theorem, Theorem]:
    """Both forces that bear a loaded bead, in the directions of the two contacts."""
    half = f_load / (2 * n_y)
    loads = axioms.loads(SURFACE)
    turns = Dot(n_minus, DeltaNPlus(i, j)) * phi - Dot(n_plus, DeltaNMinus(i + 2, j))
    plus = told(
        rules.below(axioms.balance(), loads), ForcePlus(i, j),
        half * (1 + turns / (1 - phi**2)), BELOW_LOADS,
    )  # fmt: skip
    return plus, rules.mirror(plus)


def _at_second_order() -> Rule:
    """The rule with these forces, whose directions no fact gives in the radii."""
    return moments.moment(_below_loads())


for tried, left, where, false, refused in (
    ("a radius", Shift(DeltaR(i, j)), BEADS, "its mean is given", "at second order is not known"),
    ("a square", Shift(FORCE**2), BELOW_LOADS, "it is the force's and its variance",
     "at second order is not known"),
    ("a product", Shift(FORCE * ForceMinus(i, j)), BELOW_LOADS, "they are correlated",
     "at second order is not known"),
    ("an unknown number", Shift(UNKNOWN * FORCE), BELOW_LOADS, "that may fluctuate, too",
     "depends on the radii is not known"),
    ("an unknown number beside it", Shift(UNKNOWN + FORCE), BELOW_LOADS,
     "that may fluctuate, too", "depends on the radii is not known"),
    ("a strength", Shift(epsilon * FORCE), BELOW_LOADS, "orders in ε are not told apart",
     "depends on the radii is not known"),
    ("a force that no fact gives", Shift(FORCE), Where.of(j >= 2, j + 2 <= M, loading=SURFACE),
     "it may be any", "not given by the radii"),
    ("directions that no fact gives", Shift(FORCE), BELOW_LOADS, "they tilt",
     "not given by the radii"),
    ("a load on one bead", Shift(FORCE), AT_POINT, "contacts of a layer differ",
     "alike along a layer"),
    ("no load", Shift(FORCE), BEADS, "no force is known", "alike along a layer"),
    ("a bead of the base, perhaps", Shift(RAISED), BEADS, "that stays where it is",
     "to lie above the base"),
    ("another direction", Shift(Dot(b_plus, DeltaX(i, j))), Where.of(j >= 1),
     "that is half of it", "at second order is not known"),
    ("any dimension", Shift(ForceOfLayer(j)), ANY, "it is not known there",
     "second order is not known"),
):  # fmt: skip

    @attack("moment", f"at second order: {tried}", false, refused)
    def _(left: sympy.Expr = left, where: Where = where) -> object:
        return told(_at_second_order(), left, 0, where)


# the mean balance of a bead


def _supposed(left: sympy.Expr, right: sympy.Expr, where: Where) -> Theorem:
    """What is only supposed, so that nothing else is in the way."""
    return made(equation(left, right), where, "supposition", supposed=(Supposition(p),))


STILL = tuple(_supposed(kind(i, j), S.Zero, BEADS) for kind in (DeltaNPlus, DeltaNMinus))
"""No contact turns."""
ENTERS = Where.of(site_s >= 2, loading=PASSING)
BELOW_ONE = Where.of(l >= 2, loading=POINT)
AT_LOADED = Where.of(l >= 2, loading=LOADED)
LEFT = ForcePlus(k - 1, l - 1)


def _carried(where: Where) -> tuple[Theorem, ...]:
    """All forces are f_load."""
    beads = where.also(j >= 0, indices=(i, j))
    return tuple(_supposed(kind(i, j), f_load, beads) for kind in (ForcePlus, ForceMinus))


def _mean(kind: type[Expr], value: Expr, where: Where) -> Theorem:
    return _supposed(Shift(kind(i, j)), value, where.also(j >= 0, indices=(i, j)))


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
    ("a force for its mean", lambda: _supposed(LEFT, S.Zero, BELOW_ONE), Shift(LEFT), BELOW_ONE,
     "zero to first order may be another at second", "alike along a layer"),
    ("the mean of another place", lambda: _supposed(Shift(ForcePlus(k + 1, l - 1)), S.Zero,
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
