"""Every mechanical change of a printed equation fails the very property that the equation has.

On packings that are always the same: nothing is drawn, so that nothing depends on chance.
"""

from collections.abc import Callable, Iterator

import pytest
import sympy

from tests.properties import (
    test_contacts,
    test_one_load,
    test_paths,
    test_positions,
    test_surface_load,
    test_variances,
)
from tests.properties.mutants import EQUIVALENT, mutants
from tests.properties.orders import printed
from tests.properties.reading import AbsentError, NonsenseError

Check = Callable[[sympy.Eq, object], None]

CHECKS: dict[int, tuple[Check, list[object]]] = {
    **test_positions.CHECKS,
    **test_contacts.CHECKS,
    **test_one_load.CHECKS,
    **test_paths.CHECKS,
    **test_surface_load.CHECKS,
    **test_variances.CHECKS,
}
"""The property of each equation, and where its changes are held against it."""

Change = tuple[int, str, sympy.Eq]
"""The line, the change in words, and what it makes of the line."""


def changes(number: int) -> Iterator[Change]:
    """Every mechanical change of every line, and the sign of the whole right-hand side."""
    for line, equation in enumerate(printed(number)):
        for _, change, mutant in mutants(equation):
            yield line, change, mutant
        if equation.rhs != 0:
            yield (
                line,
                "the sign of one side",
                sympy.Eq(equation.lhs, -equation.rhs, evaluate=False),
            )


def passes(check: Check, equation: sympy.Eq, packing: object) -> bool:
    try:
        check(equation, packing)
    except (AssertionError, AbsentError, NonsenseError):
        return False
    return True


@pytest.mark.parametrize(
    "number", [pytest.param(n, marks=pytest.mark.long if n == 12 else ()) for n in CHECKS]
)
def test_each_change_of_what_is_printed_fails(number: int) -> None:
    """But for those that say the same at the order that the equation keeps."""
    same = EQUIVALENT.get(number, {})
    every = list(changes(number))
    seen = [change for change in every if change[1] not in same]
    assert len(every) - len(seen) == len(same)
    assert len(seen) >= 18
    check, packings = CHECKS[number]
    assert all(passes(check, line, packing) for line in printed(number) for packing in packings)
    for change in seen:
        failed = not all(passes(check, change[2], packing) for packing in packings)
        assert failed, f"line {change[0]}, {change[1]}: holds as well"
