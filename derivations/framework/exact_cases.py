"""The closed forms of a variance, layer by layer, as a derivation tells them."""

from collections.abc import Iterator

import sympy
from force_diffusion.derivations.framework.record import ExactCase, Missed, Step
from force_diffusion.symbolic.as_printed import equation
from force_diffusion.symbolic.symbols import M, j
from force_diffusion.symbolic.variances.variance import CASES, ClosedForm


def exact_steps(
    variance: sympy.Expr,
    forms: dict[str, ClosedForm],
    how: str = "every radius with its weight squared",
) -> Iterator[Step]:
    """Show the exact form of every layer, and the small packings that have one of their own."""
    where = "in the interior"
    for form in forms.values():
        reason = f"Exact {where}, {form.validity}: {how}."
        yield Step(reason, equation(variance, form.expression))
        where = "at the edge"
    small = {(size, at): value for form in forms.values() for size, at, value in form.exceptions}
    for (size, at), value in small.items():
        yield Step(f"The packing M = {size}, j = {at} is none of these:", equation(variance, value))


def exact_cases(variance: sympy.Expr, forms: dict[str, ClosedForm]) -> dict[str, ExactCase]:
    """The exact form of every layer, with the layers and heights that it is for."""

    def case(place: str, form: ClosedForm) -> ExactCase:
        at, region, *_ = CASES[place]
        inside = [sympy.Ge(index, bound) for index, bound in region.lower_bounds.items()]
        missed = [
            Missed(f"M = {size}, j = {layer}", (sympy.Eq(M, size), sympy.Eq(j, layer)), value)
            for size, layer, value in form.exceptions
        ]
        return ExactCase(
            variance,
            form.validity,
            form.expression,
            domain=(sympy.Eq(j, at[j]),) if at else tuple(inside),
            missed=tuple(missed),
        )

    return {place: case(place, form) for place, form in forms.items()}
