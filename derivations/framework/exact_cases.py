"""The closed forms of a variance, layer by layer, as a derivation tells them."""

from collections.abc import Callable, Iterator

import sympy
from force_diffusion.derivations.framework.follows import Decide, identity
from force_diffusion.derivations.framework.record import ExactCase, Missed, Search, Step
from force_diffusion.symbolic.algebra.exact import FIELD
from force_diffusion.symbolic.algebra.reading import Reader
from force_diffusion.symbolic.as_printed import equation, minus, terms, times
from force_diffusion.symbolic.kernel.decisions import Ruling, from_test, undecided
from force_diffusion.symbolic.printing.text import text
from force_diffusion.symbolic.search.limits import LAYERS, parts_in_the_limit
from force_diffusion.symbolic.symbols import M, j, phi, r, sigma
from force_diffusion.symbolic.variances.listed import listed, squares, weights
from force_diffusion.symbolic.variances.orders import UNIT, compare_leading_order, next_order_is
from force_diffusion.symbolic.variances.variance import (
    CASES,
    ClosedForm,
    fluctuation,
    pieces_of,
)

SCALE = r * (1 - phi**2)
"""What the change of a force over its mean is multiplied by when its weights are shown."""


def variance_steps(
    variance: sympy.Expr,
    ratio: sympy.Expr,
    force: sympy.Expr,
    forms: dict[str, ClosedForm],
    before: int,
    source: str = "Eq. 11",
) -> Iterator[Step]:
    """Show the weights of all radii, their squares, and the exact form of every layer.

    ``force`` is what ``ratio``, a force over its mean, is in the radii, by the equation ``source``;
    ``before`` steps are told.
    """
    _, region, validity, _ = CASES["interior"]
    unit = FIELD.from_sympy(SCALE)
    found = list(weights(pieces_of(force, region), region, unit))
    change = times(r, terms(1, -(phi**2)), terms(ratio, -1))

    def has_weights(_: int, candidate: sympy.Eq) -> Ruling:
        if candidate.lhs != change:
            return undecided(f"the left-hand side is not {text(change)}")
        rest = Reader(region).scalar(candidate.rhs) - fluctuation(force, region).scaled(unit)
        return _zero(rest.is_zero(), "weights")

    def is_sum_of_squares(_: int, candidate: sympy.Eq) -> Ruling:
        total = Reader(region).scalar(candidate.rhs).constant_part()
        if candidate.lhs != variance or total is None:
            return undecided("no sum of squares")
        return _zero((total - forms["interior"].value).is_zero(), "sums")

    yield Step(
        f"Exact, for {validity}: every radius once, with its weight.",
        equation(change, listed(found)),
        has_weights,
        (source,),
    )
    yield Step(
        "Every weight squared:",
        equation(variance, times((sigma / SCALE) ** 2, squares(found))),
        is_sum_of_squares,
        (f"step {before + 1}",),
    )
    inside = f"step {before + 2}"
    yield from exact_steps(variance, forms, "each sum telescopes", source, inside)


def exact_steps(
    quantity: sympy.Expr,
    forms: dict[str, ClosedForm],
    how: str,
    source: str = "Eq. 11",
    inside: str = "",
) -> Iterator[Step]:
    """Show the exact form of every layer, and the small packings that have one of their own.

    ``how`` they come about; ``source`` is what they follow from, ``inside`` that in the interior.
    """
    where = "in the interior"
    for form in forms.values():
        yield Step(
            f"Exact {where}, {form.validity}: {how}.",
            equation(quantity, form.expression),
            identity({quantity: form.expression}),
            (inside or source,) if where == "in the interior" else (source,),
            positive=(M - 1,),  # where it is divided by, j = 1 and M ≥ 3
        )
        where = "at the edge"
    small = {(size, at): value for form in forms.values() for size, at, value in form.exceptions}
    for (size, at), value in small.items():
        yield Step(
            f"The packing M = {size}, j = {at} is none of these:",
            equation(quantity, value),
            identity({quantity: value}),
            (source,),
        )


def next_order(
    variance: sympy.Symbol,
    printed: sympy.Expr,
    forms: dict[str, ClosedForm],
    following: sympy.Expr,
    *uses: str,
) -> Step:
    """Show what the exact form has beyond its printed leading order, in units of ``UNIT``."""
    return Step(
        "The next order in M at fixed z:",
        equation(terms(variance, minus(printed)), times(UNIT, following)),
        lambda _, candidate: next_order_is(variance, forms, candidate),
        uses,
        relation="∼",
    )


def to_leading_order(variance: sympy.Symbol, forms: Callable[[], dict[str, ClosedForm]]) -> Decide:
    """The exact variance in the interior less the candidate is of lower order."""

    def decide(_: int, candidate: sympy.Eq) -> Ruling:
        if candidate.lhs != variance:
            return undecided(f"the left-hand side is not {text(variance)}")
        return compare_leading_order(forms()["interior"].value, candidate.rhs)

    return decide


def parting(variance: sympy.Symbol, forms: Callable[[], dict[str, ClosedForm]]) -> Search:
    """Values at growing M where the candidate and the exact variance part."""

    def search(candidate: sympy.Eq) -> str | None:
        if candidate.lhs != variance:
            return None
        return parts_in_the_limit(forms()["interior"].expression, candidate.rhs, LAYERS)

    return search


def _zero(outcome: bool, what: str) -> Ruling:
    return from_test(outcome, f"the {what} are equal", f"the {what} differ")


def exact_cases(
    variance: sympy.Expr, forms: dict[str, ClosedForm], to_order: str = "first order"
) -> dict[str, ExactCase]:
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
            to_order=to_order,
        )

    return {place: case(place, form) for place, form in forms.items()}
