"""Attacks on moments of contact forces in any dimension, and below a point load in three."""

from dataclasses import replace

import sympy
from force_diffusion.symbolic.kernel import limits, moments, rules
from force_diffusion.symbolic.kernel.any_dimension import (
    BULK,
    BULK_LEANING,
    POINT,
    SURFACE,
    SURFACE_LEANING,
    value,
)
from force_diffusion.symbolic.kernel.theorem import NotProvedError
from force_diffusion.symbolic.kernel.where import SURFACE as IN_THE_PLANE
from force_diffusion.symbolic.kernel.where import Where, at_fixed_height
from force_diffusion.symbolic.symbols import (
    Covariance,
    ForceBelow,
    ForceOfLayer,
    M,
    Mean,
    PushBelow,
    Shift,
    Variance,
    d,
    epsilon,
    j,
    l,
    p,
    phi,
    q,
    r,
    sigma,
)
from sympy import Eq, Integer, Symbol

from .attack import attack, told

INSIDE = (j >= 2, j + 2 <= M)
ANY = Where((j, M), INSIDE, SURFACE, dimension=d)
SPHERES = replace(ANY, dimension=3)
TOP = Where((M,), (M >= 3,), SURFACE, dimension=3)
CONE = Where((j, l, p, q), (j >= 0, p >= 1, q >= 1, Eq(l, j + p + q)), POINT, dimension=3)
FIRST, SECOND, THIRD, NONE = map(Integer, (1, 2, 3, 0))
FACE = ForceBelow(SECOND, p, q, NONE)
HERE = ForceOfLayer(j)
UNKNOWN = Symbol("nu", real=True)
ONE_BELOW = ForceOfLayer(M - 1)
BELOW_TOP = (
    6 * M * (1 + 2 * phi + 3 * phi**2) * (sigma / r) ** 2 / ((1 - phi) ** 2 * (1 + 2 * phi) ** 2)
)
"""What its variance goes as, for d = 3."""
WITH_Q = Where((j, q, M), INSIDE, SURFACE, dimension=3)

for tried, left, right, where, false, refused in (
    ("no such contact above", Mean(ForceOfLayer(M)), 1, TOP, "above the surface", "to be there"),
    ("no such contact below", Mean(ForceOfLayer(j - 3)), 1, SPHERES, "below the base",
     "to be there"),
    ("another load", Mean(HERE), 1, replace(SPHERES, loading=POINT), "no layer is alike",
     "none under this load"),
    ("the load of discs", Mean(HERE), 1, replace(SPHERES, loading=IN_THE_PLANE),
     "it is vertical there, of discs", "none under this load"),
    ("no load", Mean(HERE), 1, replace(SPHERES, loading=None), "no force is known",
     "none under this load"),
    ("one dimension", Mean(HERE), 1, replace(SPHERES, dimension=1), "a chain is no packing",
     "two dimensions or more"),
    ("a mean at second order", Shift(HERE), Variance(HERE), ANY, "that is a variance",
     "second order is not known"),
    ("another mean", Mean(2 * HERE), 1, ANY, "it is 2", "both sides differ"),
    ("a square", Mean(HERE**2), 1, ANY, "it fluctuates", "not a rational function"),
    ("an inverse", Mean(1 / HERE), 1, ANY, "it fluctuates", "not shown to differ from zero"),
    ("an unknown number", Variance(UNKNOWN * HERE), UNKNOWN**2 * Variance(HERE), ANY,
     "that may fluctuate, too", "depends on the radii is not known"),
    ("an unknown number beside it", Mean(UNKNOWN + HERE), UNKNOWN + 1, ANY,
     "that may fluctuate, too", "depends on the radii is not known"),
    ("a strength", Variance(epsilon * HERE), epsilon**2 * Variance(HERE), ANY,
     "orders in ε are not told apart", "depends on the radii is not known"),
    ("d, where it is three", Mean(d * HERE), d, SPHERES, "d is three",
     "depends on the radii is not known"),
    ("two layers", Covariance(HERE, ForceOfLayer(j + 1)), 0, SPHERES,
     "which contacts of both is not said", "two layers"),
    ("a fourth vector", Mean(ForceBelow(Integer(4), p, q, NONE)), 0, CONE, "there are three",
     "none of three vectors"),
    ("a vector that is any", Mean(ForceBelow(p, p, q, NONE)), 0, CONE, "p may be 7",
     "none of three vectors"),
    ("a bead beside the cone", Mean(ForceBelow(SECOND, p - 2, q, NONE)), 0, CONE,
     "p may be 1", "to be there"),
    ("a bead below the base", Mean(ForceBelow(SECOND, p + 1, q, NONE)), 0, CONE,
     "j may be 0", "to be there"),
    ("a leg in the plane", Mean(ForceBelow(FIRST, p, NONE, NONE)), 1,
     replace(CONE, dimension=2), "there are two vectors", "none under this load"),
    ("a leg under another load", Mean(ForceBelow(FIRST, p, NONE, NONE)), 1,
     replace(CONE, loading=SURFACE), "all beads are loaded", "none under this load"),
    ("a leg that turns", Mean(FACE), 1, CONE, "it is zero", "both sides differ"),
    ("another variance", Variance(2 * ONE_BELOW), 2 * Variance(ONE_BELOW), TOP, "it is 4",
     "both sides differ"),
    ("a covariance without half", Covariance(ONE_BELOW, ONE_BELOW), 2 * Variance(ONE_BELOW), TOP,
     "it is the variance", "both sides differ"),
    ("another load's variance", Variance(HERE), value(Variance(HERE), ANY).to_sympy(),
     replace(ANY, loading=BULK), "it is less under a bulk load", "both sides differ"),
    ("upright loads for leaning ones", Variance(HERE), value(Variance(HERE), ANY).to_sympy(),
     replace(ANY, loading=SURFACE_LEANING), "they count with τ₁ and τ₂", "both sides differ"),
    ("leaning loads for upright ones", Variance(HERE),
     value(Variance(HERE), replace(ANY, loading=SURFACE_LEANING)).to_sympy(), ANY,
     "each counts alike", "both sides differ"),
    ("another leaning load's variance", Variance(HERE),
     value(Variance(HERE), replace(ANY, loading=SURFACE_LEANING)).to_sympy(),
     replace(ANY, loading=BULK_LEANING), "it is less under a bulk load", "both sides differ"),
    ("the variance of discs", Variance(HERE),
     value(Variance(HERE), ANY).to_sympy().xreplace({d: Integer(2)}), SPHERES,
     "spheres fluctuate more", "both sides differ"),
    ("a contact that leads out of the cone", Variance(ForceBelow(SECOND, p, NONE, NONE)),
     Variance(ForceBelow(SECOND, p, Integer(1), NONE)), CONE.also(j >= 2, p >= 2, q >= 2),
     "it is zero", "both sides differ"),
    ("one layer too low", Variance(HERE), value(Variance(HERE), SPHERES).to_sympy(),
     Where((j, M), (j >= 1, j + 2 <= M), SURFACE, dimension=3), "another one at j = 1",
     "another one where"),
    ("one layer too high", Variance(HERE), value(Variance(HERE), SPHERES).to_sympy(),
     Where((j, M), (j >= 2, j + 1 <= M), SURFACE, dimension=3), "another one at j = M − 1",
     "another one where"),
    ("a face with its leg", Variance(FACE), value(Variance(FACE), CONE.also(j >= 1)).to_sympy(),
     Where((j, l, p, q), (j >= 1, p >= 0, q >= 1, Eq(l, j + p + q)), POINT, dimension=3),
     "p = 0 is a leg", "another one where"),
    ("a leg's magnitude for its push", Variance(PushBelow(FIRST, p, NONE, NONE)),
     Variance(ForceBelow(FIRST, p, NONE, NONE)), CONE.also(j >= 2, p >= 2),
     "its direction changes, too", "both sides differ"),
):  # fmt: skip

    @attack("moment", f"in any dimension: {tried}", false, refused)
    def _(left: sympy.Expr = left, right: sympy.Expr | int = right, where: Where = where) -> object:
        return told(moments.moment(), left, right, where)


@attack("moment", "more parts than are looked at", "it is not decided",
        "two places may be one")  # fmt: skip
def _() -> object:
    return value(Variance(HERE), Where((j, M), (j >= 0, j + 1 <= M), SURFACE, dimension=3), 0)


@attack("moment", "in any dimension: a slice that stands for two", "it is counted twice",
        "may stand for another slice")  # fmt: skip
def _() -> object:
    tight = Where((j, M), (j >= 2, j + 1 <= M, j + 1 >= M), SURFACE, dimension=3)
    found = value(Variance(HERE), tight)
    if found == value(Variance(HERE), replace(tight, relations=(j >= 2, Eq(M, j + 1)))):
        raise NotProvedError("that is what it is")
    return found


@attack("moment", "the surface's theorem below a bulk load", "it is another load",
        "does not hold")  # fmt: skip
def _() -> object:
    same = told(moments.moment(), Mean(HERE) * M, M, ANY)
    return told(rules.follows(same), M, M, replace(ANY, loading=BULK))


for tried, small, right, where, false, refused in (
    ("half of its variance", Variance(ONE_BELOW), BELOW_TOP / 2, TOP, "their ratio is 2",
     "of order 1"),
    ("a leading part that vanishes at φ = −¼", M * (4 * phi + 1), M * (4 * phi + 1) + 1, TOP,
     "1 and 0 there", "not shown to vanish nowhere"),
    ("a leading part of no sign", M * (d - 3), M * (d - 3) + 1, replace(TOP, dimension=d),
     "it vanishes for d = 3", "not shown to vanish nowhere"),
    ("d, where it is three", M * d, M * d + 1, TOP, "d is three", "neither grows nor is fixed"),
    ("another index", M * q, M * q + 1, WITH_Q, "it may grow, too", "neither grows nor is fixed"),
):  # fmt: skip

    @attack("asymptotic", f"in any dimension: {tried}", false, refused)
    def _(
        left: sympy.Expr = small, right: sympy.Expr | int = right, where: Where = where
    ) -> object:
        limit = replace(at_fixed_height("∼"))
        if j not in where.indices:
            limit = replace(limit, growing=(M,), positive=(M,))
        return told(limits.asymptotic(), left, right, where.in_the_limit(limit))
