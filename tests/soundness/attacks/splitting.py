"""Attacks on moments and leading orders, and on disproofs."""

from collections.abc import Callable
from dataclasses import replace

import sympy
from force_diffusion.symbolic.as_printed import equation
from force_diffusion.symbolic.kernel import limits, rules, statistics
from force_diffusion.symbolic.kernel.disproofs import Disproof, other_leading_order
from force_diffusion.symbolic.kernel.theorem import NotProvedError, Supposition, Theorem
from force_diffusion.symbolic.kernel.where import (
    POINT,
    Limit,
    Where,
    inside_cone,
)
from force_diffusion.symbolic.symbols import (
    Covariance,
    DeltaR,
    ForcePlus,
    Mean,
    Variance,
    b_minus,
    b_plus,
    i,
    j,
    k,
    l,
    n_plus,
    p,
    q,
    sigma,
)
from sympy import Eq

from .attack import BEADS, HERE, attack, only_supposed, told

SQUARE = sigma**2
TWO_LAYERS = Where.of(j >= 0, l >= 0, Eq(k, i))
BOTH = HERE + DeltaR(k, l)


for tried, left, right, where, false, refused in (
    ("layers that may be one", Variance(BOTH), 2 * SQUARE, TWO_LAYERS, "it is 4σ² for l = j",
     "l = 0 the true value less this one is 2 σ_δr²"),
    ("layers that may be one, at one height", Variance(BOTH), 2 * SQUARE, TWO_LAYERS.also(Eq(j, 2)),
     "it is 4σ² for l = 2", "at i = 2, j = 2, k = 2, l = 2"),
    ("a mean of one layer", Mean(j + HERE), 2, BEADS, "it is j", "at j = 0 the true value"),
    ("a covariance of layers that may be one", Covariance(HERE, DeltaR(k, l)), 0, TWO_LAYERS,
     "it is σ² for l = j", "the true value less this one is σ_δr²"),
    ("another side than a number", Variance(HERE), SQUARE + DeltaR(i, j), BEADS, "radii differ",
     "different weights of single beads"),
    ("many moments", sum(Variance(n * HERE) for n in range(1, 12)), 0, BEADS, "they are positive",
     "the true value less this one is 506 σ_δr²"),
    ("a vector, along n⁺", Mean(2 + HERE) * n_plus, 2 * n_plus + b_plus, BEADS,
     "they differ along n⁺", "is a vector"),
    ("a vector, along n⁻", Mean(2 + HERE) * n_plus, 2 * n_plus + b_minus, BEADS,
     "they differ along n⁻", "is a vector"),
):  # fmt: skip

    @attack("moment", tried, false, refused)
    def _(
        left: sympy.Expr = left,
        right: sympy.Expr | int = right,
        where: Where = where,
    ) -> object:
        return told(statistics.moment(), left, right, where)


@attack("moment", "of what is supposed, elsewhere", "f⁺ is anything", "does not hold there")
def _() -> object:
    supposed = rules.suppose(equation(ForcePlus(i, j), j), BEADS, Supposition(j), 0)
    mean = told(statistics.moment(supposed), Mean(ForcePlus(i, j)), j)
    return rules.instance(mean, {j: j + 2}, BEADS)


# leading orders with indices that equations give

CONE = Where.of(Eq(k, i + p - q), Eq(l, j + p + q), j >= 0, p >= 1, q >= 1, loading=POINT)
AT_CONE = CONE.in_the_limit(inside_cone("∼"))

for tried, left, right, where, false, refused in (
    ("an index that an equation gives", l + j, j + p, AT_CONE, "q grows",
     "left over right goes to"),
    ("an equation between what grows", l, 2 * p, AT_CONE.also(Eq(p, q)), "j grows",
     "does not hold all of"),
    ("an equation that stops what grows", l + j, l + 1, AT_CONE.also(Eq(j, 1)), "j grows",
     "does not hold all of"),
    ("a place across", k - i, i, AT_CONE, "i may be anything", "neither grows nor is fixed"),
    ("a side of the packing", k - i + l, l, AT_CONE.also(k >= i), "q may be less than p",
     "does not hold all of"),
):  # fmt: skip

    @attack("asymptotic", tried, false, refused)
    def _(
        left: sympy.Expr = left,
        right: sympy.Expr = right,
        where: Where = where,
    ) -> object:
        return told(limits.asymptotic(), left, right, where)


# disproofs

TRUE = told(limits.asymptotic(), l + 3, j + p + q, AT_CONE)
"""l + 3 ∼ j + p + q."""


ELSEWHERE = Where.of(Eq(l, 2 * j + p + q), j >= 0, p >= 1, q >= 1).in_the_limit(inside_cone("∼"))


def disproved(
    theorem: Theorem, right: sympy.Expr, left: sympy.Expr = l + 3, where: Where = AT_CONE
) -> Disproof:
    """What is disproved by a theorem."""
    return other_leading_order(theorem)(equation(left, right), where)


for tried, right, left, where, false, refused in (
    ("what is true", l - 7, l + 3, AT_CONE, "they go the same way", "go the same way"),
    ("what is true, written otherwise", l * (l + 1) / (j + p + q), l + 3, AT_CONE,
     "they go the same way", "go the same way"),
    ("another left-hand side", 2 * l, 2 * l, AT_CONE, "it is true", "about another"),
    ("another domain", 2 * j + p + q, l + 3, ELSEWHERE, "it is true there", "about another"),
    ("a statement at finite size", l + 3, l + 3, CONE, "it is true", "not one in a limit"),
    ("another limit", l, l + 3, CONE.in_the_limit(
     Limit("∼", "l → ∞ at fixed p and q", (j,), (j,))), "it is true there", "does not hold all"),
    ("what is no statement", 1 / (j - p), l + 3, AT_CONE, "it has no value at j = p",
     "not shown to differ"),
    ("an index that is left", l + i, l + 3, AT_CONE, "true at each i", "neither grows nor is"),
):  # fmt: skip

    @attack("disproof", tried, false, refused)
    def _(right: sympy.Expr = right, left: sympy.Expr = left, where: Where = where) -> object:
        return disproved(TRUE, right, left, where)


@attack("disproof", "by what is supposed", "it may be false", "only supposed")
def _() -> object:
    return disproved(only_supposed(l + 3, 5 * l, AT_CONE), l)


@attack("disproof", "by a theorem at finite size", "l ∼ l + 3", "about another")
def _() -> object:
    return disproved(told(rules.rewrite(), l + 3, l + 3, CONE), l)


def _forged(made: Callable[[], Disproof]) -> Disproof:
    try:
        return made()
    except TypeError as reason:
        raise NotProvedError(str(reason)) from None


attack("disproof", "one of one's own", "nobody has disproved it", "made by the rules")(
    lambda: _forged(lambda: Disproof(equation(l, l), AT_CONE, TRUE, "of course"))
)
attack("disproof", "one changed", "nobody has disproved it", "made by the rules")(
    lambda: _forged(lambda: replace(disproved(TRUE, j + p), formula=equation(l + 3, l)))
)
