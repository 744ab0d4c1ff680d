"""What the derivations of variances share: leading orders compared, exact forms shown."""

from collections.abc import Iterator

import sympy

from derivations.record import Step
from symbolic.as_printed import equation
from symbolic.exact import FIELD, NotExactError, RationalFunction
from symbolic.kernel import Ruling, proved, refuted, undecided
from symbolic.printing.text import text
from symbolic.symbols import M, j, z
from symbolic.variance import ExactForm, at_fixed_z, order


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


def exact_steps(variance: sympy.Expr, forms: dict[str, ExactForm]) -> Iterator[Step]:
    """Show the exact form of every layer, and the small packings that have one of their own."""
    where = "in the interior"
    for form in forms.values():
        reason = f"Exact {where}, {form.validity}: every radius with its weight squared."
        yield Step(reason, equation(variance, form.expression))
        where = "at the edge"
    small = {(size, at): value for form in forms.values() for size, at, value in form.exceptions}
    for (size, at), value in small.items():
        yield Step(f"The packing M = {size}, j = {at} is none of these:", equation(variance, value))
