"""Every mechanical change of a printed equation fails the very property that the equation has.

On packings that are always the same: nothing is drawn, so that nothing depends on chance.
"""

from collections.abc import Callable, Iterator

import pytest
import sympy
from force_diffusion.symbolic.printing.text import text

from tests.properties import test_first_order, test_variances, test_weights
from tests.properties.mutants import EQUIVALENT, mutants
from tests.properties.orders import printed
from tests.properties.reading import AbsentError, NonsenseError

Check = Callable[[sympy.Eq, object], None]

CHECKS: dict[int | str, tuple[Check, list[object]]] = {
    **test_first_order.CHECKS,
    **test_weights.CHECKS,
    **test_variances.CHECKS,
}
"""The property of each equation, and where its changes are held against it."""

Change = tuple[int, str, sympy.Eq]
"""The line, the change in words, and what it makes of the line."""


def changes(number: int | str) -> Iterator[Change]:
    """Of every line: each mechanical change, each factor dropped, and the sign of one side."""
    for line, equation in enumerate(printed(number)):
        for change, mutant in mutants(equation):
            yield line, change, mutant
        left, right = equation.args
        for factor, other in without_a_factor(right):
            yield line, f"factor {factor} dropped", sympy.Eq(left, other, evaluate=False)
        if right != 0:
            yield line, "the sign of one side", sympy.Eq(left, -right, evaluate=False)


def without_a_factor(side: sympy.Expr) -> Iterator[tuple[str, sympy.Expr]]:
    for product in side.atoms(sympy.Mul):
        for place, factor in enumerate(product.args):
            others = (*product.args[:place], *product.args[place + 1 :])
            if factor != -1:
                other = side.xreplace({product: sympy.Mul(*others, evaluate=False)})
                yield text(factor), other


def passes(check: Check, equation: sympy.Eq, packing: object) -> bool:
    try:
        check(equation, packing)
    except (AssertionError, AbsentError, NonsenseError):
        return False
    return True


@pytest.mark.parametrize(
    "number", [pytest.param(n, marks=[pytest.mark.long] * (n in (12, 15))) for n in CHECKS]
)
def test_each_change_of_what_is_printed_fails(number):
    """But for those that say the same at the order that the equation keeps."""
    same = EQUIVALENT.get(number, {})
    every = list(changes(number))
    seen = [change for change in every if change[1] not in same]
    assert len(every) - len(seen) == len(same)
    assert len(seen) >= 15
    check, packings = CHECKS[number]
    assert all(passes(check, line, packing) for line in printed(number) for packing in packings)
    for change in seen:
        failed = not all(passes(check, change[2], packing) for packing in packings)
        assert failed, f"line {change[0]}, {change[1]}: holds as well"
