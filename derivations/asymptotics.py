"""What the derivations of asymptotic variances share: leading order, and explicit packings."""

from fractions import Fraction

import sympy

from symbolic import explicit
from symbolic.exact import FIELD, NotExactError, RationalFunction
from symbolic.kernel import GEOMETRIES, Ruling, Verdict, proved, refuted, undecided
from symbolic.symbols import M, i, j, sigma, z
from symbolic.variance import ExactForm, at_fixed_z, order, packings, value_at


def compare_leading_order(exact: RationalFunction, candidate: sympy.Expr) -> Ruling:
    """Rule on a candidate in M and z: exact − candidate must be of lower order than exact."""
    try:
        difference = exact - FIELD.from_sympy(candidate.xreplace({z: j / M}))
    except NotExactError as reason:
        return undecided(str(reason))
    if difference.is_zero():
        return proved("equal at every order")
    power = order(difference)
    shown = f"{at_fixed_z(difference)} · M^{power}"
    if power < order(exact):
        return proved(f"exact − printed is of order M^{power}: {shown}")
    return refuted(f"exact − candidate is of the leading order M^{power} itself: {shown}")


def explicit_variances(
    forms: dict[str, ExactForm], expression: sympy.Expr, up_to: int = 5
) -> Ruling:
    """Compare closed forms with Σ weight², each weight read off an explicit small packing."""
    count = 0
    for height, layer, case in packings(up_to):
        geometry = GEOMETRIES[count % len(GEOMETRIES)]
        values = {**geometry, M: height, j: layer, i: layer}
        found = explicit.weights(expression, values)
        total = sum((w**2 for key, w in found.items() if key[0]), Fraction(0))
        closed = value_at(forms, height, layer, case)
        if explicit.number(closed, {**values, sigma: 1}) != total:
            return Ruling(Verdict.DISAGREES, f"M = {height}, j = {layer}: not {total}")
        count += 1
    return Ruling(Verdict.AGREES, f"{count} contacts, as fractions")
