"""Rulings on the orders of a variance in M: a printed leading order, edges, the next order."""

import sympy
from force_diffusion.symbolic.algebra.exact import FIELD, NotExactError, RationalFunction
from force_diffusion.symbolic.kernel.decisions import Ruling, from_test, proved, refuted, undecided
from force_diffusion.symbolic.printing.text import text
from force_diffusion.symbolic.symbols import INDICES, M, j, phi, r, sigma, z
from force_diffusion.symbolic.variances.variance import (
    CASES,
    ClosedForm,
    at_fixed_z,
    grows_evenly,
    largest_weight,
    order,
)

UNIT = (sigma / r) ** 2 / (1 - phi**2) ** 2
"""What variances of forces over their mean squared are numbers and powers of M times."""


def compare_leading_order(exact: RationalFunction, candidate: sympy.Expr) -> Ruling:
    """Rule on a candidate in M and z: exact − candidate must be of lower order than exact."""
    try:
        difference = (exact - FIELD.from_sympy(candidate.xreplace({z: j / M}))).reduced()
    except NotExactError as reason:
        return undecided(str(reason))
    strange = [s for s in INDICES if difference.holds(s) and s not in (M, j) and not exact.holds(s)]
    if strange:
        return refuted(f"exact − candidate depends on {', '.join(map(text, strange))}")
    if difference.is_zero():
        return proved("equal at every order")
    power = order(difference)
    shown = f"{text(at_fixed_z(difference))} · M^{power}"
    if power < order(exact):
        if not grows_evenly(difference):
            return undecided(f"the order of {shown} is not shown to hold at every z and φ")
        return proved(f"exact − printed is of order M^{power}: {shown}")
    return refuted(f"exact − candidate is of the leading order M^{power} itself: {shown}")


def same_leading_order(candidate: sympy.Eq) -> Ruling:
    """Two functions of M, j and z = j/M have the same leading order."""
    return compare_leading_order(
        FIELD.from_sympy(candidate.lhs.xreplace({z: j / M})), candidate.rhs
    )


def next_order_is(name: sympy.Symbol, forms: dict[str, ClosedForm], candidate: sympy.Eq) -> Ruling:
    """The exact form in the interior less its leading order, on the left, is as on the right."""
    left = candidate.lhs.xreplace({name: forms["interior"].expression})
    return same_leading_order(sympy.Eq(left, candidate.rhs, evaluate=False))


def no_radius_dominates(force: sympy.Expr, forms: dict[str, ClosedForm]) -> Ruling:
    """The largest squared weight over the variance: what the central limit theorem needs."""
    shares = [
        2 * largest_weight(force.xreplace(at), region) - order(forms[case].value)
        for case, (at, region, *_) in CASES.items()
    ]
    return from_test(
        max(shares) == -1,
        "a radius has a share of order 1/M in the variance, at fixed z and for j = 0, 1 and M − 1",
    )
