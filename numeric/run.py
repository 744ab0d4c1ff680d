"""Runs a plan: chooses nothing that the plan does not say, raises precision, keeps the books."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from time import perf_counter
from typing import Any

from force_diffusion.numeric.accuracy.enclosed import Accuracy, of_balls, of_floats, strings
from force_diffusion.numeric.accuracy.repeated import edge_in_doubt, of_repeat
from force_diffusion.numeric.arithmetic.decimals import short
from force_diffusion.numeric.arithmetic.errors import NOT_REACHED, ForceDiffusionError
from force_diffusion.numeric.arithmetic.systems import FLOAT64, Balls, NumberSystem
from force_diffusion.numeric.mechanics.engine import Solved, batches, solve
from force_diffusion.numeric.mechanics.forces import NotStandingError
from force_diffusion.numeric.mechanics.packing import UnbuildableError, UndecidedError
from force_diffusion.numeric.mechanics.physicality import Physicality
from force_diffusion.numeric.mechanics.work import Progress, Work
from force_diffusion.numeric.planning.budget import DEFAULT_BINS, MOST_BITS, initial_bits
from force_diffusion.numeric.planning.plan import CERTIFY, ESTIMATE, PHYSICAL, Choice, Plan
from force_diffusion.numeric.quantities.answers import GATHERERS, Table
from force_diffusion.numeric.statistics import histogram
from force_diffusion.numeric.studies.cost.ways import solve_plainly
from force_diffusion.numeric.theory.critical_height import critical_height

__all__ = ["MOST_BITS", "Missed", "Outcome", "ToleranceError", "critical_height", "run"]


class ToleranceError(ForceDiffusionError, ArithmeticError):
    """The asked tolerance can't be reached; the message says why."""

    exit_status = NOT_REACHED


@dataclass(frozen=True)
class Missed:
    """A way that was tried before the one that answered, and why it did not."""

    algorithm: str
    arithmetic: str
    why: str


@dataclass(frozen=True)
class Outcome:
    """A finished run: the printed answer, its accuracy, what was physical and what it cost.

    ``plan`` is that of the way that answered; ``missed`` are those tried before.
    """

    plan: Plan
    rows: list[dict[str, Any]]
    accuracy: Accuracy
    physical: Physicality | None
    stopped: tuple[int, int, str] | None
    work: Work
    total_seconds: float
    missed: tuple[Missed, ...] = ()


@dataclass
class _Attempt:
    table: Table
    bins: list[tuple[Fraction, Fraction, int]] | None
    physical: Physicality | None
    stopped: tuple[int, int, str] | None


def run(plan: Plan, progress: Progress | None = None) -> Outcome:
    """Run a plan, to the tolerance that it was made for.

    Where the estimated error of a way misses the tolerance, the next way of the plan's choice is
    taken. Raises ``ToleranceError``, and what the sweeps raise for a packing that can't be built.
    """
    start = perf_counter()
    work = Work(progress=progress)
    missed: list[Missed] = []
    if plan.choice is not None:
        plan, attempt, accuracy = _chosen(plan, plan.choice, work, missed)
    elif plan.way.certified:
        plan, attempt, accuracy = _certified(plan, work)
    else:
        attempt = _attempt(plan, plan.system, range(plan.realisations), work)
        accuracy = _estimate(plan, attempt, work)
    rows = _rows(attempt, accuracy, plan.system)
    zero = not accuracy.certified and not accuracy.error_bound
    if zero and _squares_vanish(plan):
        note = "every change is zero, or below what float64 holds: a tolerance tells which"
        accuracy = replace(accuracy, error_bound=math.inf, note=note)
    return Outcome(
        plan, rows, accuracy, attempt.physical, attempt.stopped, work,
        perf_counter() - start, tuple(missed),
    )  # fmt: skip


def _chosen(
    plan: Plan, choice: Choice, work: Work, missed: list[Missed]
) -> tuple[Plan, _Attempt, Accuracy]:
    """Try the ways in their order, until an estimate is within the tolerance or balls certify."""
    for candidate in choice.tried:
        assert candidate.plan is not None
        tried = replace(candidate.plan, choice=choice)
        if candidate.ends:
            return _certified(tried, work)
        try:
            if candidate.certified:  # in the plain form, whose balls may grow too wide to decide
                return _certified(tried, work)
            attempt = _attempt(tried, tried.system, range(tried.realisations), work)
            accuracy = _estimate(tried, attempt, work)
            why = _shortfall(attempt, accuracy, choice.tolerance)
        except (UnbuildableError, NotStandingError, ArithmeticError) as error:
            why = str(error)  # rounding may have made it so: the next way tells
        if not why:
            return tried, attempt, accuracy
        missed.append(Missed(candidate.algorithm, candidate.arithmetic, why))
    balls = next(c for c in choice.candidates if c.certified)
    raise ToleranceError(
        f"the tolerance can't be reached: {missed[-1].arithmetic}: {missed[-1].why}; and "
        f"{balls.arithmetic}: {balls.out}"
    )


def _shortfall(attempt: _Attempt, accuracy: Accuracy, tolerance: Fraction) -> str:
    """Say why an estimated answer does not meet the tolerance; an empty string where it does."""
    if not _within(accuracy, tolerance):
        return accuracy.note if not accuracy.bits_lost else _still(accuracy)
    if attempt.bins is not None:
        edges = [attempt.bins[0][0], *(high for _, high, _ in attempt.bins)] if attempt.bins else []
        if edge_in_doubt(attempt.table, edges, accuracy):
            return "a change lies within its error of the edge of a bin"
    return ""


def _squares_vanish(plan: Plan) -> bool:
    """Say whether changes of second order, left where the first cancels, round to zero."""
    return 0 < plan.radii.relative_std() ** 2 < Fraction(1, 10**300)


def _attempt(plan: Plan, system: NumberSystem, realisations: Sequence[int], work: Work) -> _Attempt:
    work.uses(system.name)
    physical = Physicality() if plan.route == "exact" and not work.repeating else None
    gatherer = GATHERERS[plan.scene.ask.quantity](plan, system)
    stopped = None
    solver = solve_plainly if plan.way.plain else solve
    with system.active():
        for chunk in batches(plan, realisations, system):
            solved = solver(plan, chunk, system, work)
            if physical is not None and solved.packing is not None:
                _check(physical, solved, len(chunk), work)
            if solved.forces is not None and stopped is None:
                stopped = solved.forces.stopped
            gatherer.add(solved, chunk)
        table = gatherer.table()
        bins = None
        if plan.scene.ask.quantity == "histogram" and not work.repeating:
            values = table.numbers["change"]
            bins = histogram.histogram(values, plan.scene.ask.bins or DEFAULT_BINS, system)
    return _Attempt(table, bins, physical, stopped)


def _check(physical: Physicality, solved: Solved, realisations: int, work: Work) -> None:
    assert solved.packing is not None
    with work.timed(PHYSICAL):
        physical.look_at_gaps(solved.packing)
        if solved.forces is not None:
            physical.look_at_forces(solved.forces)
    for layer in solved.packing.region.rows:
        work.did("checked", layer, realisations)


def _estimate(plan: Plan, attempt: _Attempt, work: Work) -> Accuracy:
    """Solve the first realisations again with a longer significand, and compare."""
    longer, few = plan.way.longer, range(plan.way.repeated)
    assert longer is not None
    part = replace(plan, realisations=len(few))
    with work.repeat(ESTIMATE):
        table = attempt.table
        if len(few) < plan.realisations:
            table = _attempt(part, plan.system, few, work).table
        again = _attempt(part, longer, few, work).table
        if plan.tolerance is None:
            return of_floats(table, again, attempt.table, FLOAT64)
        with longer.active():
            return of_repeat(table, again, attempt.table, plan)


def _certified(plan: Plan, work: Work) -> tuple[Plan, _Attempt, Accuracy]:
    """Raise the precision until the enclosure is small enough, or say why that does not help."""
    floor = plan.radii.relative_std()
    system = plan.system
    assert isinstance(system, Balls)
    if system.bits > MOST_BITS:
        raise ToleranceError(
            f"the tolerance can't be reached: {short(plan.tolerance or floor)} at height "
            f"{plan.scene.packing.height} needs {system.bits} bits or more, and {MOST_BITS} are "
            f"the most; ask for about {_least_tolerance(plan)} at best"
        )
    while True:
        try:
            attempt = _attempt(plan, system, range(plan.realisations), work)
            with work.timed(CERTIFY), system.active():
                accuracy = of_balls(attempt.table, system, floor)
            if plan.tolerance is None or _within(accuracy, plan.tolerance):
                return replace(plan, way=replace(plan.way, system=system)), attempt, accuracy
            why = f"at {system.bits} bits {_still(accuracy)}"
        except (UndecidedError, NotStandingError) as error:
            why = f"at {system.bits} bits: {error}"
        if system.bits == MOST_BITS:
            break
        system = Balls(min(2 * system.bits, MOST_BITS))
    message = f"the tolerance can't be reached: {why}, and more than {MOST_BITS} are not tried"
    height, highest = plan.scene.packing.height, critical_height(floor)
    if height > highest / 2:
        message += (
            f"; the height is {height}, and the theory holds well below "
            f"M* = (σ/r)^(-2/3) = {highest:.3g}"
        )
    raise ToleranceError(message)


def _least_tolerance(plan: Plan) -> str:
    """Give the power of ten that the highest precision starts with, at this height."""
    digits = MOST_BITS - initial_bits(Fraction(1), plan.scene.packing.height)
    return f"1e-{int(digits * 0.30102)}"


def _still(accuracy: Accuracy) -> str:
    bound = accuracy.error_bound
    if not math.isfinite(bound):
        return "nothing is left of the answer"
    return f"the error is still {short(Fraction(bound))}"


def _within(accuracy: Accuracy, tolerance: Fraction) -> bool:
    bound = accuracy.error_bound
    return math.isfinite(bound) and Fraction(bound) <= tolerance


def _rows(attempt: _Attempt, accuracy: Accuracy, system: NumberSystem) -> list[dict[str, Any]]:
    """Print the answer, row by row."""
    if attempt.bins is not None:
        return histogram.printed(attempt.bins)
    with system.active():
        printed = strings(attempt.table, accuracy, system)
    columns = {**attempt.table.index, **printed}
    return [dict(zip(columns, row, strict=True)) for row in zip(*columns.values(), strict=True)]
