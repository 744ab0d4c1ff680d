"""Attacks on means at second order."""

from functools import cache

import sympy
from force_diffusion.symbolic.attacks.attack import BEADS, attack, told
from force_diffusion.symbolic.kernel import axioms, moments, rules
from force_diffusion.symbolic.kernel.any_dimension import SURFACE as IN_ANY_DIMENSION
from force_diffusion.symbolic.kernel.rules import Rule
from force_diffusion.symbolic.kernel.theorem import Theorem
from force_diffusion.symbolic.kernel.where import POINT, SURFACE, Where
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
    n_y,
    phi,
)
from sympy import Eq, Symbol

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
