"""Attacks on means, variances and covariances, and on leading orders."""

import sympy
from force_diffusion.symbolic.kernel import limits, rules, statistics
from force_diffusion.symbolic.kernel.theorem import Theorem
from force_diffusion.symbolic.kernel.where import SURFACE, Limit, Where, at_fixed_height
from force_diffusion.symbolic.symbols import (
    Covariance,
    DeltaNPlus,
    DeltaR,
    ForcePlus,
    M,
    Mean,
    N,
    Variance,
    b_plus,
    epsilon,
    f_load,
    i,
    j,
    k,
    l,
    m,
    n,
    p,
    phi,
    q,
    r,
    sigma,
    z,
)
from sympy import Eq, Sum, Symbol

from .attack import BEADS, HERE, attack, told

SQUARE = sigma**2
UNKNOWN = Symbol("nu", real=True)
ON_SURFACE = Where.of(j >= 0, j < M, loading=SURFACE)
TWO_BEADS = Where.of(j >= 0, l >= 0)
ONE_LAYER = Where.of(j >= 0, Eq(l, j), k >= i)
HEIGHTS = Where.of(j >= 2, j + 2 <= M)
AT_Z = HEIGHTS.in_the_limit(at_fixed_height("∼"))
"""Between base and surface, M → ∞."""

for tried, left, right, where, false, refused in (
    ("no statement", Variance(DeltaR(i + 1, j)), SQUARE, BEADS, "no bead is there", "not shown"),
    ("a moment of a moment", Mean(Variance(HERE)), SQUARE, BEADS, "it is a number",
     "a moment of a moment"),
    ("another variance", Variance(2 * HERE), 2 * SQUARE, BEADS, "it is 4σ²",
     "the true value less this one is 2 σ_δr²"),
    ("the mean of a square", Mean((1 + HERE) ** 2), 2, BEADS, "it is 1 + σ²",
     "a product of two quantities"),
    ("an unknown force", Variance(ForcePlus(i, j)), 0, ON_SURFACE, "it fluctuates",
     "not given by the radii"),
    ("a direction", Mean(DeltaNPlus(i, j)), 0, BEADS, "it is a vector", "is a vector"),
    ("an unknown number", Variance(UNKNOWN + HERE), SQUARE, BEADS, "that may fluctuate, too",
     "not a rational function"),
    ("two beads that may be one", Variance(HERE + DeltaR(k, l)), 2 * SQUARE, TWO_BEADS,
     "it is 4σ² for (k, l) = (i, j)", "l = 0 the true value less this one is 2 σ_δr²"),
    ("two beads of a layer that may be one", Covariance(HERE, DeltaR(k, l)), 0, ONE_LAYER,
     "it is σ² for k = i", "the true value less this one is σ_δr²"),
    ("a bead on a diagonal, perhaps", Variance(Sum(DeltaR(m, m), (m, 0, j)) + DeltaR(k, l)),
     (j + 2) * SQUARE, TWO_BEADS, "it is more where (k, l) is one of these",
     "the true value less this one is 2 σ_δr²"),
    ("two beads of a layer, told apart by no sign",
     Covariance(HERE, DeltaR(i + 4 * p + 6 * q, j)), 0, BEADS.also(indices=(p, q)),
     "it is σ² for p = q = 0", "at p = 0, q = 0 the true value"),
    ("a vector's", Variance(HERE * b_plus), SQUARE, BEADS, "it has more than one",
     "is a vector"),
    ("a covariance without half", Covariance(HERE, HERE), 2 * SQUARE, BEADS, "it is σ²",
     "the true value less this one is −σ_δr²"),
):  # fmt: skip

    @attack("moment", tried, false, refused)
    def _(left: sympy.Expr = left, right: sympy.Expr | int = right, where: Where = where) -> object:
        return told(statistics.moment(), left, right, where)


def _summed(one: sympy.Expr, count: sympy.Expr = N) -> sympy.Expr:
    """A sum over neighbours of one layer."""
    return Sum(one.xreplace({i: i + 2 * m, k: k + 2 * m}), (m, 0, count - 1))


TWO = HERE + DeltaR(i + 2, j)  # what it shares a radius with has the next one
MANY, THREE, APART = Where.of(j >= 0, N >= 2), Where.of(j >= 0, N >= 3), Where.of(N >= 2, j >= 0)
for tried, of, right, where, false, refused in (
    ("neighbours that share a radius", _summed(TWO), 2 * N, MANY, "it is (4N − 2)σ²",
     "at N = 2 the true value less this one is 2"),
    ("two neighbours that share a radius", _summed(TWO), 4, MANY.also(Eq(N, 2)), "it is 6σ²",
     "the true value less this one is 2 σ_δr²"),
    ("neighbours that differ", _summed(i * HERE), N * i**2, MANY, "it is Σ(i + 2m)²σ²",
     "the true value less this one is 4 σ_δr²"),
    ("neighbours times what may fluctuate", UNKNOWN * _summed(HERE), N * UNKNOWN**2, MANY,
     "nu may depend on the radii", "not a rational function"),
    ("neighbours, each twice", Sum(DeltaR(i + 2 * m, j), (m, 0, N - 1), (n, 1, 2)), N, MANY,
     "it is 4Nσ²", "the true value less this one is 6 σ_δr²"),
    ("neighbours times a radius", HERE * _summed(HERE), 0, MANY, "it is no first order",
     "a product of two quantities"),
    ("every second bead, taken for neighbours", Sum(TWO.xreplace({i: i + 4 * m}), (m, 0, N - 1)),
     4 * N - 2, MANY, "it is 2Nσ²", "holds a remainder"),
    ("a covariance left out", _summed(TWO + DeltaR(i + 4, j)), 9 * N - 4, THREE,
     "it is (9N − 8)σ²", "the true value less this one is −4 σ_δr²"),
    ("covariances of more neighbours than there may be", _summed(HERE + DeltaR(i + 6, j)),
     4 * N - 6, APART, "it is 4σ² for N = 2", "at N = 2 the true value"),
):  # fmt: skip

    @attack("moment", tried, false, refused)
    def _(left: sympy.Expr = of, right: sympy.Expr = right, where: Where = where) -> object:
        return told(statistics.moment(), Variance(left), right * SQUARE, where)


for tried, small, right, where, false, refused in (
    ("a domain at finite size", M, M + 1, HEIGHTS, "they differ", "it is not one in a limit"),
    ("the sign of another limit", M, M + 1, HEIGHTS.in_the_limit(at_fixed_height("≈")),
     "≈ says something else", "not with the sign ∼"),
    ("the same order", M**2, 2 * M**2, AT_Z, "their ratio is ½", "left over right goes to 1/2"),
    ("zero", M - M, M - 2 * M, AT_Z, "only one vanishes", "the left-hand side is zero"),
    ("a leading part that vanishes at z = ½", 2 * j - M + 1, (2 * z - 1) * M - 1, AT_Z,
     "1 and −1 at z = ½", "not shown to vanish nowhere"),
    ("a leading part that vanishes at φ = 0", phi * M + 1, phi * M + 2, AT_Z, "½ at φ = 0",
     "not shown to vanish nowhere"),
    ("an index that is left", M * i + i, M * i, AT_Z, "0/0 at i = 0", "neither grows nor is fixed"),
    ("an unknown number", M + UNKNOWN, M, AT_Z, "it may grow with M", "not a rational function"),
    ("a strength", M + epsilon * M**2, M, AT_Z, "it is no number", "neither grows nor is fixed"),
    ("a domain beside the limit", M + Variance(DeltaR(i + M, j + 2 - M)), M,
     Where.of(j >= 2, j + 2 >= M).in_the_limit(at_fixed_height("∼")),
     "no bead is there for z < 1", "does not hold all of"),
    ("a domain of one layer", M + j, M + 1, Where.of(Eq(j, 1), M >= 3).in_the_limit(
     at_fixed_height("∼")), "z → 0 there", "does not hold all of"),
    ("a limit that does not say how j grows", M + j, M, HEIGHTS.in_the_limit(
     Limit("∼", "M → ∞", (M,), (M,))), "j may grow, too", "does not hold all of"),
    ("a limit with two ways for one", M + 1, M, Where((M,), (M >= 3,)).in_the_limit(
     Limit("∼", "M → ∞", (M,), (M, 2 * M))), "it says nothing", "does not say how every index"),
    ("a limit with one way for two", M**2 + j, M**2, Where((j, M), (M >= 3,)).in_the_limit(
     Limit("∼", "M → ∞", (M, j), (M,))), "j may grow faster", "does not say how every index grows"),
):  # fmt: skip

    @attack("asymptotic", tried, false, refused)
    def _(
        left: sympy.Expr = small, right: sympy.Expr | int = right, where: Where = where
    ) -> object:
        return told(limits.asymptotic(), left, right, where)


def _in_the_limit() -> Theorem:
    """M + 1 ∼ M."""
    return told(limits.asymptotic(), M + 1, M, AT_Z)


@attack("asymptotic", "a leading order used at finite size", "M + 1 is not M", "does not hold")
def _() -> object:
    same = _in_the_limit()
    return told(rules.follows(same), M + 1, M, HEIGHTS)


@attack("moment", "a statement in a limit", "M + 1 is not M", "it is one in a limit")
def _() -> object:
    return told(
        statistics.moment(), Variance(HERE), SQUARE, BEADS.in_the_limit(at_fixed_height("∼"))
    )


@attack("rewrite", "a statement in a limit", "it says another thing there", "it is one in a limit")
def _() -> object:
    return told(rules.rewrite(), f_load, f_load, AT_Z)


@attack("asymptotic", "another power of a parameter", "r is a length", "left over right goes to r²")
def _() -> object:
    return told(limits.asymptotic(), M**3 * SQUARE, M**3 * SQUARE / r**2, AT_Z)
