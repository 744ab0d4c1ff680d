"""A scene becomes an outcome: planned, solved, checked, and its error known.

``Scene`` is the one of ``numeric.scene`` with the two verbs that need all the rooms below.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from pathlib import Path
from time import perf_counter
from typing import Any

from .accuracy.accuracy import Accuracy, ToleranceError
from .accuracy.enclosed import of_balls
from .accuracy.repeated import edge_in_doubt, of_floats, of_repeat
from .arithmetic.decimals import exact, short
from .arithmetic.errors import UndecidedError
from .arithmetic.systems import FLOAT64, Balls, NumberSystem
from .lattice.branch import Contact
from .mechanics.engine import packings
from .mechanics.forces import NotStandingError
from .mechanics.packing import UnbuildableError
from .mechanics.physicality import Physicality
from .mechanics.problem import Route, Solved
from .mechanics.work import Progress, Work
from .outcome import Missed, Outcome
from .planning.budget import MOST_BITS
from .planning.expected_error import initial_bits
from .planning.plan import CERTIFY, ESTIMATE, PHYSICAL, Choice, Plan
from .planning.planner import plan
from .quantities.base import Table
from .quantities.histogram import Histogram
from .scene import reading, scene
from .scene.sections import SceneError
from .statistics import histogram
from .theory.critical_height import critical_height


@dataclass
class _Attempt:
    table: Table
    bins: list[tuple[Fraction, Fraction, int]] | None
    physical: Physicality | None
    stopped: Contact | None


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
    elif plan.method.certified:
        plan, attempt, accuracy = _certified(plan, work)
    else:
        attempt = _attempt(plan, plan.system, range(plan.problem.realisations), work)
        accuracy = _estimate(plan, attempt, work)
    zero = not accuracy.certified and not accuracy.error_bound
    if zero and _squares_vanish(plan):
        note = "every change is zero, or below what float64 holds: a tolerance tells which"
        accuracy = replace(accuracy, error_bound=math.inf, note=note)
    return Outcome(
        plan,
        attempt.table,
        attempt.bins,
        accuracy,
        attempt.physical,
        attempt.stopped,
        work,
        perf_counter() - start,
        tuple(missed),
    )


def _chosen(
    plan: Plan, choice: Choice, work: Work, missed: list[Missed]
) -> tuple[Plan, _Attempt, Accuracy]:
    """Try the ways in their order, until an estimate is within the tolerance or balls certify."""
    for candidate in choice.tried:
        assert candidate.plan is not None
        tried = replace(candidate.plan, choice=choice)
        if candidate.certified:
            return _certified(tried, work)
        try:
            attempt = _attempt(tried, tried.system, range(tried.problem.realisations), work)
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
    return 0 < plan.problem.radii.relative_std() ** 2 < Fraction(1, 10**300)


def _attempt(plan: Plan, system: NumberSystem, realisations: Sequence[int], work: Work) -> _Attempt:
    work.uses(system.name)
    exact = plan.problem.route == Route.EXACT
    physical = Physicality() if exact and not work.repeating else None
    stopped, bins = None, None
    with system.active():
        gatherer = plan.quantity.gatherer(plan.problem, system)
        for solved, chunk in packings(plan.problem, realisations, system, work):
            if physical is not None:
                _check(physical, solved, len(chunk), work)
            if solved.forces is not None and stopped is None:
                stopped = solved.forces.stopped
            gatherer.add(solved, chunk)
        table = gatherer.table()
        if isinstance(plan.quantity, Histogram) and not work.repeating:
            bins = histogram.histogram(table.numbers["change"], plan.quantity.bins, system)
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
    longer, few = plan.method.longer, range(plan.method.repeated)
    assert longer is not None
    part = replace(plan, problem=replace(plan.problem, realisations=len(few)))
    with work.repeat(ESTIMATE):
        table = attempt.table
        if len(few) < plan.problem.realisations:
            table = _attempt(part, plan.system, few, work).table
        again = _attempt(part, longer, few, work).table
        if plan.tolerance is None:
            return of_floats(table, again, attempt.table, FLOAT64)
        with longer.active():
            return of_repeat(table, again, attempt.table, plan)


def _certified(plan: Plan, work: Work) -> tuple[Plan, _Attempt, Accuracy]:
    """Raise the precision until the enclosure is small enough, or say why that does not help."""
    floor = plan.problem.radii.relative_std()
    system = plan.system
    assert isinstance(system, Balls)
    if system.bits > MOST_BITS:
        raise ToleranceError(
            f"the tolerance can't be reached: {short(plan.tolerance or floor)} at height "
            f"{plan.problem.height} needs {system.bits} bits or more, and {MOST_BITS} are "
            f"the most; ask for about {_least_tolerance(plan)} at best"
        )
    while True:
        try:
            attempt = _attempt(plan, system, range(plan.problem.realisations), work)
            with work.timed(CERTIFY), system.active():
                accuracy = of_balls(attempt.table, system, floor)
            if plan.tolerance is None or _within(accuracy, plan.tolerance):
                return replace(plan, method=replace(plan.method, system=system)), attempt, accuracy
            why = f"at {system.bits} bits {_still(accuracy)}"
        except (UndecidedError, NotStandingError) as error:
            why = f"at {system.bits} bits: {error}"
        if system.bits == MOST_BITS:
            break
        system = Balls(min(2 * system.bits, MOST_BITS))
    message = f"the tolerance can't be reached: {why}, and more than {MOST_BITS} are not tried"
    height, highest = plan.problem.height, critical_height(floor)
    if height > highest / 2:
        message += (
            f"; the height is {height}, and the theory holds well below "
            f"M* = (σ/r)^(-2/3) = {highest:.3g}"
        )
    raise ToleranceError(message)


def _least_tolerance(plan: Plan) -> str:
    """Give the power of ten that the highest precision starts with, at this height."""
    digits = MOST_BITS - initial_bits(Fraction(1), plan.problem.height)
    return f"1e-{int(digits * 0.30102)}"


def _still(accuracy: Accuracy) -> str:
    bound = accuracy.error_bound
    if not math.isfinite(bound):
        return "nothing is left of the answer"
    return f"the error is still {short(Fraction(bound))}"


def _within(accuracy: Accuracy, tolerance: Fraction) -> bool:
    bound = accuracy.error_bound
    return math.isfinite(bound) and Fraction(bound) <= tolerance


class Scene(scene.Scene):
    """A scene that can be explained and run: the classes that a TOML file is read into.

    ``packing``, ``disorder`` (None: all radii are equal), ``load`` (by default a surface load),
    ``effects`` and ``ask`` are the sections; files are relative to ``folder``. Raises
    ``SceneError``, which names the key, its value and what is allowed.

    >>> from force_diffusion.numeric.scene.sections import Ask, Disorder, Packing
    >>> strip = Scene(
    ...     packing=Packing(height=4, width=10),
    ...     disorder=Disorder(kind="uniform", relative_std=1e-6, seed=1),
    ...     ask=Ask(quantity="profile"),
    ... )
    >>> outcome = strip.run()
    >>> outcome.arrays["std"].shape, outcome.accuracy.error_bound < 1e-14
    ((8,), True)
    """

    def explain(self, tolerance: Any = None, *, certified: bool = False) -> Plan:
        """Say what ``run`` would do, what it would leave out, and why; ``print`` shows it.

        ``tolerance``: error allowed, relative to the largest change; ``certified``: only a rigorous
        bound will do. Both override what the scene asks. Raises ``SceneError`` for a scene that
        takes too much memory or time, and ``TableError``.
        """
        if tolerance is None:
            return plan(self, certified=certified)
        try:
            asked = exact(tolerance)
        except ValueError as error:
            raise SceneError("tolerance", tolerance, str(error)) from None
        if not 0 < asked < 1:
            raise SceneError("tolerance", tolerance, "must lie between 0 and 1")
        return plan(self, asked, certified=certified)

    def run(
        self,
        tolerance: Any = None,
        *,
        certified: bool = False,
        progress: Progress | None = None,
    ) -> Outcome:
        """Answer the scene's question; arguments as for ``explain``.

        ``progress`` is called with the kind of work and the number of beads just done. Raises also
        ``ToleranceError``, and ``UnbuildableError``, ``NotStandingError`` or ``RadiusError`` for a
        packing that can't be built.
        """
        return run(self.explain(tolerance, certified=certified), progress)


def read_scene(path: str | Path) -> Scene:
    """Read and check a scene file. Raises ``SceneError``."""
    return reading.read_scene(Path(path), Scene)
