"""How accurate an answer is: enclosed by balls, or estimated; and numbers with the digits known.

Answers in balls are certified: bits are added until the enclosure is small enough. Numbers of
float64 are corrected by the errors that their sweep carried and rounded once; what is stated is
that rounding, those of gathering them, and what the carried errors leave out.
"""

import math
from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction
from typing import Any, NamedTuple

import numpy as np

from .arithmetic.carried import UNIT, Sizes, bound_error
from .arithmetic.decimals import nearest, short
from .arithmetic.errors import NotReachedError, UndecidedError
from .arithmetic.systems import FLOAT64, Array, Balls, NumberSystem, as_floats, largest_of, midpoint
from .mechanics.sweep import NotStandingError
from .mechanics.work import Work
from .planning.plan import Plan
from .planning.planner import gathering, initial_bits
from .quantities.answer import Answer, answer
from .quantities.base import RATIO, SCATTER_OF, Quantity, Table
from .tables import significant, text_of

# No balls of more bits are tried: what they leave open stays open.
MOST_BITS = 8192
CARRIED = "estimated, as the sweep carried it, not certified"
# A decimal that a ball's radius cuts off is wrong by at most one unit in its last digit: 20 radii.
CUT_OFF = 20
# An estimated bound is twice what the number may be off, or more: so one within half of it may be
# printed as 0, and others rounded, and what is printed is within the bound.
SWALLOWED = 2
# Forces and positions, which are no changes, are off by so much of themselves more: they are sums
# and products of a few rounded numbers. At most 2.4 × 2^-52 was measured.
ROUNDED = 2.0**-50


class Accuracy(NamedTuple):
    """Error of the changes in an answer, relative to the largest of them.

    ``certified``: a rigorous bound (balls). Otherwise it is estimated, from errors that the sweep
    carried. A bound that is too small for a float is a fraction.
    """

    error_bound: float | Fraction
    certified: bool
    arithmetic: str
    note: str = ""

    def within(self, tolerance: Fraction | None) -> bool:
        """Say whether the error is at most as large; without a tolerance any is."""
        bound = self.error_bound
        return tolerance is None or (math.isfinite(bound) and Fraction(bound) <= tolerance)

    @property
    def still(self) -> str:
        """Say how large the error still is."""
        if not math.isfinite(self.error_bound):
            return self.note or "nothing is left of the answer"
        return f"the error is still {short(Fraction(self.error_bound))}"


class ToleranceError(NotReachedError, ArithmeticError):
    """The tolerance can't be reached; the message says why."""


def of_balls(table: Table, system: Balls, floor: Fraction) -> Accuracy:
    """Judge an answer in balls; ``floor`` is the size below which a change counts as zero."""
    values = [value for name in table.small for value in table.numbers[name]]
    if not all(value.is_finite() for value in values):
        return Accuracy(math.inf, True, system.name)
    largest = largest_of(value.abs_lower() for value in values)
    radius = largest_of(value.rad() for value in values)
    if radius == 0 and largest == 0:
        return Accuracy(0.0, True, system.name)
    note = ""
    if not largest > 0:
        if not floor:
            return Accuracy(math.inf, True, system.name)
        largest = system.number(floor)
        note = "no change can be told from zero; the error is relative to σ/r instead"
    rounded = system.number(Fraction(10) ** (1 - most_digits(system)))
    printed = (radius / largest).upper() * CUT_OFF + rounded
    return Accuracy(upper(printed), True, system.name, note)


def upper(value: Any) -> float | Fraction:
    """Round a small positive ball up to a float; below the range of floats, to a fraction."""
    bound = midpoint(value.upper())
    if bound < Fraction(1, 10**300):
        return bound
    return float(bound) * (1 + 1e-15) if bound < 10**300 else math.inf


def enclosed(plan: Plan, work: Work) -> tuple[Plan, Answer, list[Accuracy]]:
    """Raise the precision until the enclosures of all answers are small enough.

    Gives the plan with the precision that was. Raises ``ToleranceError``, which says why more bits
    do not help.
    """
    problem, spread = plan.problem, plan.problem.radii.relative_std
    system = plan.system
    assert isinstance(system, Balls)
    if system.bits > MOST_BITS:
        first_bits = MOST_BITS - initial_bits(Fraction(1), problem.height)
        raise ToleranceError(
            f"the tolerance can't be reached: {short(plan.tolerance or UNIT)} at height "
            f"{problem.height} needs {system.bits} bits or more, and {MOST_BITS} are "
            f"the most; ask for about 1e-{int(first_bits * 0.30102)} at best"
        )
    floors = [
        spread * (plan.scene.load.magnitude if quantity.of_forces else 1)
        for quantity in plan.quantities
    ]
    while True:
        try:
            solved = answer(plan.quantities, problem, range(problem.realisations), system, work)
            with system.active():
                judged = [
                    of_balls(table, system, floor)
                    for table, floor in zip(solved.tables, floors, strict=True)
                ]
            missed = [accuracy for accuracy in judged if not accuracy.within(plan.tolerance)]
            if not missed:
                return replace(plan, system=system), solved, judged
            why = f"at {system.bits} bits {missed[0].still}"
        except (UndecidedError, NotStandingError) as error:
            why = f"at {system.bits} bits: {error}"
        if system.bits == MOST_BITS:
            break
        system = Balls(min(2 * system.bits, MOST_BITS))
    message = f"the tolerance can't be reached: {why}, and more than {MOST_BITS} are not tried"
    highest = plan.critical_height
    if problem.height > highest / 2:
        message += (
            f"; the height is {problem.height}, and the theory holds well below "
            f"M* = (σ/r)^(-2/3) = {highest:.3g}"
        )
    raise ToleranceError(message)


def estimated(plan: Plan, work: Work) -> tuple[Answer, list[Accuracy]]:
    """Answer in float64, and say how large the errors are, as sweeps carried them."""
    problem = plan.problem
    solved = answer(
        plan.quantities, problem, range(problem.realisations), FLOAT64, work, carried=True
    )
    tables = zip(plan.quantities, solved.tables, strict=True)
    return solved, [of_carried(quantity, table, solved.sizes, plan) for quantity, table in tables]


def of_carried(quantity: Quantity, table: Table, sizes: Sizes, plan: Plan) -> Accuracy:
    """State the error of an answer whose sweeps carried it.

    It is that of gathering numbers that were rounded once; to it comes what the carried errors
    leave out themselves (``Sizes.unseen``), which is doubled for sums of a few numbers.
    """
    problem, scene = plan.problem, plan.scene
    largest = Fraction(table.largest) if math.isfinite(table.largest) else Fraction(0)
    force, moved = sizes.unseen(problem.height)
    if not math.isfinite(force + moved):
        return Accuracy(math.inf, False, FLOAT64.name, "nothing is left of the answer")
    if not largest:
        # the square of a small σ/r, which is what is left where changes cancel, rounds to zero
        vanishes = 0 < problem.radii.relative_std**2 < Fraction(1, 10**300)
        if plan.tolerance is None and not (sizes.changed or sizes.moved or vanishes):
            return Accuracy(0.0, False, FLOAT64.name, CARRIED)
        note = "every change is zero here, and only balls (a tolerance) tell whether that is exact"
        return Accuracy(math.inf, False, FLOAT64.name, note)
    if quantity.of_forces:
        unseen = Fraction(force) * scene.load.magnitude
    else:
        unseen = Fraction(moved * float(1 / problem.n_x)) * scene.packing.radius
    bound = bound_error(gathering(quantity, problem), unseen / largest)
    return Accuracy(bound, False, FLOAT64.name, CARRIED)


def shortfall(plan: Plan, solved: Answer, judged: Sequence[Accuracy]) -> str:
    """Say why estimated answers do not meet the tolerance; an empty string where they do."""
    if plan.tolerance is None:
        return ""
    for table, accuracy in zip(solved.tables, judged, strict=True):
        if not accuracy.within(plan.tolerance):
            return accuracy.still
        if table.bins is not None and edge_in_doubt(table, table.bins.edges, accuracy):
            return "a change lies within its error of the edge of a bin"
    return ""


def edge_in_doubt(table: Table, exact: Sequence[Fraction], accuracy: Accuracy) -> bool:
    """Say whether a change lies within its error of the edge of a bin: counts may be off."""
    edges = np.array([*map(nearest, exact)])
    values = np.sort(as_floats(table.numbers["change"]))
    # bins are counted in float64, whatever the arithmetic; edges are rounded, too
    error = (float(accuracy.error_bound) + 2.0**-51) * table.largest
    after = np.searchsorted(values, edges)
    near = values[np.clip([after - 1, after], 0, len(values) - 1)]
    return bool((abs(near - edges) <= error).any())


def most_digits(system: Balls) -> int:
    """Give the digits to which even an exact number is printed."""
    return int(system.bits * 0.30103) + 1


def printed(
    table: Table, accuracy: Accuracy, system: NumberSystem, *, sampled: bool
) -> dict[str, list[str]]:
    """Give the columns as text (see ``tables``), each number with the digits that are known.

    Standard errors stand beside their columns, with three digits, and nothing where they are not
    known. ``sampled``: whether to leave out digits that would be others in another sample.
    """
    text = {name: text_of(column) for name, column in table.index.items()}
    for name, column in table.numbers.items():
        errors = table.errors.get(name if name in table.errors else SCATTER_OF.get(name, ""))
        bound, over, sampling = accuracy.error_bound, np.ones(1), np.zeros(1)
        if name == RATIO:  # its error is that of σ_f over ⟨f⟩, since ⟨f⟩ is known far better
            mean = abs(as_floats(table.numbers["mean"]))
            over = np.where(mean > 0, mean, 1.0)  # smaller than any float: so is the error
        if sampled and errors is not None:
            sampling = np.nan_to_num(errors, posinf=np.inf) / over
        if isinstance(system, Balls) and not np.any(sampling):
            most = most_digits(system)
            text[name] = ["0" if v.contains(0) else v.str(most, radius=False) for v in column]
        else:  # what scatters needs no more than a float has
            error = (float(bound) * table.largest if math.isfinite(bound) else np.inf) / over
            text[name] = known_digits(as_floats(column), error, sampling)
        if name in table.errors:
            own = table.errors[name]
            own = np.where(np.isfinite(own), own, np.nan)
            text[f"{name}_error"] = significant(own, np.full(len(own), 3))
    return text


def known_digits(column: Array, error: Array | float, sampling: Array | float = 0.0) -> list[str]:
    """Write float64 as text, up to two digits beyond its absolute errors.

    A number that the ``error`` of its arithmetic swallows is 0; ``sampling`` swallows none. What is
    cut off is less than half of ``error``, or than ``ROUNDED`` of the number.
    """
    size = np.abs(column)
    with np.errstate(all="ignore"):
        off = error + size * ROUNDED
        known = np.isfinite(column) & (SWALLOWED * size > off)
        # two digits beyond the error: cutting the rest off adds at most a twentieth of it
        seen = np.floor(np.log10(np.maximum(off, sampling)))
        digits = np.floor(np.log10(size)) - seen + 2
    digits = np.where(known, np.clip(digits, 1, 17), 1).astype(np.int64)
    return significant(np.where(known | ~np.isfinite(column), column, 0.0), digits)
