"""What the derivations of asymptotic variances share: the comparison of leading orders."""

import sympy

from symbolic.exact import FIELD, NotExactError, RationalFunction
from symbolic.kernel import Ruling, proved, refuted, undecided
from symbolic.printing.text import text
from symbolic.symbols import M, j, z
from symbolic.variance import at_fixed_z, order


def compare_leading_order(exact: RationalFunction, candidate: sympy.Expr) -> Ruling:
    """Rule on a candidate in M and z: exact − candidate must be of lower order than exact."""
    try:
        difference = exact - FIELD.from_sympy(candidate.xreplace({z: j / M}))
    except NotExactError as reason:
        return undecided(str(reason))
    if difference.is_zero():
        return proved("equal at every order")
    power = order(difference)
    shown = f"{text(at_fixed_z(difference))} · M^{power}"
    if power < order(exact):
        return proved(f"exact − printed is of order M^{power}: {shown}")
    return refuted(f"exact − candidate is of the leading order M^{power} itself: {shown}")
