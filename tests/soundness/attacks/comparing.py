"""Attacks on what is said of orders: largest weights and shares, what is dropped, slopes."""

import sympy
from force_diffusion.symbolic.as_printed import equation, times
from force_diffusion.symbolic.kernel import limits, rules
from force_diffusion.symbolic.kernel.theorem import NotProvedError, Supposition, Theorem
from force_diffusion.symbolic.kernel.where import SURFACE, Where, at_fixed_height, in_a_layer
from force_diffusion.symbolic.symbols import (
    DeltaR,
    ForceMinus,
    ForcePlus,
    LargestShare,
    LargestWeight,
    M,
    Mean,
    Variance,
    epsilon,
    f_load,
    i,
    j,
    m,
    n,
    n_x,
    n_y,
    phi,
    q,
    z,
)
from sympy import Derivative, Eq, Pow, Rational, Sum, Symbol

from .attack import BEADS, HERE, attack, told

UNKNOWN = Symbol("nu", real=True)
HEIGHTS = Where.of(j >= 2, j + 2 <= M, loading=SURFACE)
AT_ORDER, DROPPING, BY_WEIGHT = (
    HEIGHTS.in_the_limit(at_fixed_height(one)) for one in ("O", "≈", "≈ by weight")
)
OTHER = HEIGHTS.also(indices=(q,))
"""And another bead of a layer, which may be the same one."""

LINE = Sum(DeltaR(i - j + m, m), (m, 1, M))
NEAR = HERE + DeltaR(i + 2, j)


def along(weight: sympy.Expr) -> sympy.Expr:
    """Radii of a diagonal, each with a weight."""
    return Sum(weight * DeltaR(i - j + m, m), (m, 1, M))


def _line(across: sympy.Expr) -> sympy.Expr:
    """Radii of a diagonal, from a bead of the base up to the surface."""
    return Sum(DeltaR(across + m, m), (m, 0, M - 1))


STEEP = M**2 / (M * phi**2 + 1) ** 2
"""Of order 1, but for φ = 0, where it is M²."""

# bounded: the weight of each radius, or its share in the variance

for tried, most, bound, where, false, refused in (
    ("no statement", LargestWeight(DeltaR(i + 1, j)), 1, AT_ORDER, "no bead is there", "not shown"),
    ("a statement at finite size", LargestWeight(HERE), 1, HEIGHTS, "how large is not said",
     "it is not one in a limit"),
    ("the sign of another limit", LargestWeight(HERE), 1, DROPPING, "≈ says more",
     "not with the sign O"),
    ("a mean", Mean(HERE), 1, AT_ORDER, "it is no weight", "no largest share"),
    ("a variance", Variance(M * HERE), 1, AT_ORDER, "it grows", "no largest share"),
    ("a weight that grows", LargestWeight(M * HERE), 1, AT_ORDER, "it is M", "has more"),
    ("one that grows along a diagonal", LargestWeight(along(m)), 1, AT_ORDER, "it is M at m = M",
     "has more"),
    ("a share of one radius", LargestShare(HERE), 1 / M, AT_ORDER, "it is 1", "has more"),
    ("a share of two", LargestShare(M * HERE + LINE - DeltaR(i, j)), 1 / M, AT_ORDER,
     "one has nearly all", "has more"),
    ("a bound that vanishes", LargestWeight(HERE), 2 * j - M, AT_ORDER, "it is 0 at z = ½",
     "of one order everywhere"),
    ("a bound of zero", LargestWeight(HERE), M - M, AT_ORDER, "the weight is 1",
     "of one order everywhere"),
    ("a variance that vanishes", LargestShare(HERE - HERE), 1, AT_ORDER, "it is 0/0",
     "of one order everywhere"),
    ("a weight with a pole", LargestWeight(HERE / (2 * j - M + Rational(1, 2))), 1, AT_ORDER,
     "it is 2 at j = M/2", "not shown to differ from zero"),
    ("a weight that is large at φ = 0", LargestWeight(STEEP * HERE), 1, AT_ORDER, "it is M² there",
     "not shown to hold everywhere"),
    ("a weight with an index that is left", LargestWeight(i * HERE), 1, AT_ORDER,
     "i is any number", "neither grows nor is fixed"),
    ("an end with an index that is left",
     LargestWeight(Sum(n * DeltaR(i - j + n, n), (n, 1, q - 1))), M,
     HEIGHTS.also(q >= 1, indices=(q,)).in_the_limit(at_fixed_height("O")), "q is any number",
     "does not hold all of"),
    ("weights that fall with the distance", LargestWeight(
        Sum(DeltaR(i - j + n, n) / (j - n), (n, 0, j - 1))), 1 / M, AT_ORDER,
     "that of the bead below is 1", "n stands in a denominator"),
    ("a share where two lines may be one",
     LargestShare(_line(i - j) - _line(i + 2 * q - j) + DeltaR(i - j + M, M)), 1 / M,
     OTHER.in_the_limit(at_fixed_height("O")), "it is 1 for q = 0",
     "it is not one function in all of"),
    ("a weight over a layer", LargestWeight(along(1 / m)), 1 / M, AT_ORDER, "it is 1 at m = 1",
     "m stands in a denominator"),
    ("a strength", LargestWeight(epsilon * HERE), 1, AT_ORDER, "it is no number",
     "neither grows nor is fixed"),
    ("a force", LargestWeight(ForcePlus(i, j)), 1, AT_ORDER, "it grows", "not given by the radii"),
):  # fmt: skip

    @attack("bounded", tried, false, refused)
    def _(
        most: sympy.Expr = most, bound: sympy.Expr | int = bound, where: Where = where
    ) -> Theorem:
        return told(limits.bounded(), most, bound, where)


# negligible: of a statement about one force, which is supposed to be the sum of a diagonal

WITH_Q = Where.of(j >= 2, j + 2 <= M, loading=SURFACE, indices=(q,))
FORCE = rules.suppose(equation(ForcePlus(i, j), f_load * (1 + LINE)), WITH_Q, Supposition(q), 1)
F = ForcePlus(i, j) / f_load

for tried, left, right, where, false, refused in (
    ("a statement at finite size", F, 1 + LINE, HEIGHTS, "how much is dropped is not said",
     "it is not one in a limit"),
    ("the sign of another limit", F, 1 + LINE, AT_ORDER, "O says less", "not with the sign ≈"),
    ("half of it", F, 1 + LINE / 2, DROPPING, "a quarter of the variance is dropped",
     "what is dropped varies as the power 1"),
    ("all of it", F, 1, DROPPING, "all of the variance is dropped", "as the power 1"),
    ("another mean", F, 2 + LINE, DROPPING, "the means are 1 and 2",
     "the means of both sides differ"),
    ("no force", 1 + LINE, 1 + LINE, DROPPING, "it says nothing", "not about one contact force"),
    ("a force that both sides hold", F, F + HERE, DROPPING, "f = f says nothing",
     "of one order everywhere"),
    ("a large part that both sides hold", F + M * LINE, 1 + M * LINE, DROPPING,
     "all of the force is dropped", "as the power 1"),
    ("two forces", F, ForcePlus(i + 2, j) / f_load, DROPPING, "of which is it?",
     "not about one contact force"),
    ("a force of the other branch", F, ForceMinus(i, j) / f_load, DROPPING, "of which is it?",
     "not about one contact force"),
    ("another force, which is unknown", ForceMinus(i, j), f_load, DROPPING, "it fluctuates",
     "not given by the radii"),
    ("a force times a radius", F * HERE, HERE, DROPPING, "of which order is it?",
     "a product of two quantities"),
    ("forces summed over", Sum(ForcePlus(i - j + m, m), (m, 2, j)), f_load * (j - 1), DROPPING,
     "of which is it?", "of one order everywhere"),
    ("a factor that vanishes at z = ½", F * (2 * j - M), (2 * j - M) * (1 + LINE), DROPPING,
     "it says nothing there", "of one order everywhere"),
    ("a factor that z makes vanish", F * (2 * z - 1), (2 * z - 1) * (1 + LINE), DROPPING,
     "it says nothing at z = ½", "of one order everywhere"),
    ("a factor with an index that is left", F * i, i * (1 + LINE), DROPPING, "i is any number",
     "neither grows nor is fixed"),
    ("a factor that i makes vanish", F * (M + i), (M + i) * (1 + LINE) + HERE, DROPPING,
     "the bead itself is left at i = −M", "neither grows nor is fixed"),
    ("an index that is left", F, 1 + LINE + i * HERE, DROPPING, "i is any number",
     "neither grows nor is fixed"),
    ("a part that is large at φ = 0", F, 1 + LINE + STEEP * HERE, DROPPING, "it is M² there",
     "not shown to hold everywhere"),
    ("a pole at z = ½", F, 1 + LINE + HERE / (2 * j - M + Rational(1, 2)), DROPPING,
     "it is large there", "not shown to differ from zero"),
):  # fmt: skip

    @attack("negligible", tried, false, refused)
    def _(left: sympy.Expr = left, right: sympy.Expr | int = right, where: Where = where) -> object:
        return told(limits.negligible(FORCE), left, right, where)


# heaviest: which weights are the largest

for tried, left, right, where, false, refused in (
    ("a statement at finite size", M * HERE, M * HERE, HEIGHTS, "orders are not said",
     "it is not one in a limit"),
    ("the sign of another limit", M * HERE, M * HERE, DROPPING, "≈ says another thing",
     "not with the sign ≈ by weight"),
    ("one of two", M * NEAR, M * HERE, BY_WEIGHT, "the other weighs as much", "of the order of"),
    ("all of a diagonal but one", M * LINE, M * HERE, BY_WEIGHT, "the others weigh as much",
     "of the order of"),
    ("nothing of one", HERE, 0, BY_WEIGHT, "it is the largest", "of the order of"),
    ("nothing of nothing", HERE - HERE, 0, BY_WEIGHT, "there is none", "of the order of"),
    ("one that is not the largest everywhere", (2 * j - M) * HERE + DeltaR(i + 2, j),
     (2 * j - M) * HERE, BY_WEIGHT, "at z = ½ the other is", "of the order of"),
    ("another mean", 1 + M * HERE, M * HERE, BY_WEIGHT, "1 is dropped",
     "the means of both sides differ"),
    ("a weight of the order on the right alone", M * HERE, M * NEAR, BY_WEIGHT, "it is added",
     "of the order of"),
    ("one that is larger at φ = 0", M * HERE + STEEP * DeltaR(i + 2, j), M * HERE, BY_WEIGHT,
     "it is M² there", "not shown to hold everywhere"),
    ("an index that is left", M * HERE + i * DeltaR(i + 2, j), M * HERE, BY_WEIGHT,
     "i is any number", "neither grows nor is fixed"),
):  # fmt: skip

    @attack("heaviest", tried, false, refused)
    def _(left: sympy.Expr = left, right: sympy.Expr | int = right, where: Where = where) -> object:
        return told(limits.heaviest(), left, right, where)


# slope: derivatives by z

for tried, left, right, where, false, refused in (
    ("another derivative", Derivative(z**2, z), z, Where(), "it is 2z", "derivatives differ"),
    ("by another symbol", Derivative(n_x, phi), n_x - n_x, Where(), "n_x is a function of φ",
     "not about a derivative by z"),
    ("by one symbol more", Derivative(z * n_y, z, phi), n_x - n_x, Where(),
     "n_y is a function of φ", "not about a derivative by z"),
    ("none", z, z, Where(), "nothing is differentiated", "not about a derivative by z"),
    ("of what may depend on z", Derivative(UNKNOWN * z, z), UNKNOWN, Where(), "ν is unknown",
     "may depend on z"),
    ("of a layer", Derivative(j * z, z), j, BEADS, "j is z M", "may depend on z"),
    ("of a radius", Derivative(HERE * z, z), HERE, BEADS, "of which bead?", "may depend on z"),
    ("what SymPy cancels", times(phi, Pow(phi, -1), Derivative(z, z)), 1, Where(), "0/0 is not 1",
     "not shown to differ"),
    ("what SymPy cancels below it", Derivative(times(phi, Pow(phi, -1), z), z), 1, Where(),
     "0/0 is not 1", "not shown to differ"),
    ("in a limit", Derivative(z, z), 1, AT_ORDER, "it says another thing there",
     "it is one in a limit"),
):  # fmt: skip

    @attack("slope", tried, false, refused)
    def _(left: sympy.Expr = left, right: sympy.Expr | int = right, where: Where = where) -> object:
        return told(rules.slope, left, sympy.sympify(right), where)


for tried, left, right, where, false, refused in (
    ("a layer that is not fixed", M + j, M, HEIGHTS.in_the_limit(in_a_layer("∼")),
     "j may grow, too", "does not hold all of"),
    ("a height that is fixed", M + 1, M, Where.of(Eq(M, 5), j >= 0).in_the_limit(in_a_layer("∼")),
     "6 is not 5", "does not hold all of"),
    ("a part that is large at φ = 0", M + STEEP, M, HEIGHTS.in_the_limit(at_fixed_height("∼")),
     "it is M² there", "not shown to hold everywhere"),
    ("z in a fixed layer", M * z + 1, 2 * M * z, Where.of(Eq(j, M - 1), M >= 3).in_the_limit(
     in_a_layer("∼")), "z M is M − 1 there", "left over right goes to 1/2"),
):  # fmt: skip

    @attack("asymptotic", tried, false, refused)
    def _(left: sympy.Expr = left, right: sympy.Expr | int = right, where: Where = where) -> object:
        return told(limits.asymptotic(), left, right, where)


# what is only supposed of a force is not proved by what follows from it

for name, rule, left, right, where in (
    ("asymptotic", limits.asymptotic(FORCE), Mean(F), 1,
     HEIGHTS.in_the_limit(at_fixed_height("∼"))),
    ("bounded", limits.bounded(FORCE), LargestWeight(F), 1, AT_ORDER),
    ("negligible", limits.negligible(FORCE), F, 1 + LINE, DROPPING),
    ("heaviest", limits.heaviest(FORCE), M * HERE + F, 1 + M * HERE, BY_WEIGHT),
):  # fmt: skip

    @attack(name, "what rests on a supposition", "it is only supposed", "only supposed")
    def _(
        rule: rules.Rule = rule,
        left: sympy.Expr = left,
        right: sympy.Expr | int = right,
        where: Where = where,
    ) -> Theorem:
        theorem = told(rule, left, right, where)
        if theorem.supposed:
            raise NotProvedError("it is only supposed")
        return theorem
