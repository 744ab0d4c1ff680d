"""A scene becomes an outcome: planned, solved, checked, and its error known.

``Scene`` is the one of ``numeric.scene`` with the two verbs that need all the rooms below.
"""

import math
from collections.abc import Mapping
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from time import perf_counter
from typing import Any

from ..accuracy import Accuracy, ToleranceError, enclosed, estimated, shortfall
from ..arithmetic.decimals import exact, parse
from ..mechanics.sweep import NotStandingError, UnbuildableError
from ..mechanics.work import Progress, Work
from ..planning.plan import Choice, Plan
from ..planning.planner import plan
from ..quantities.answer import Answer
from ..scene import reading, scene
from ..scene.scene import files_read
from ..scene.sections import SceneError
from .outcome import Missed, Outcome


def run(plan: Plan, progress: Progress | None = None) -> Outcome:
    """Run a plan, to the tolerance that it was made for.

    Where the estimated error of a method misses the tolerance, the next one of the plan's choice is
    taken. Raises ``ToleranceError``, ``TypeError`` for what is no plan, and what the sweeps raise
    for a packing that can't be built.
    """
    if not isinstance(plan, Plan):
        raise TypeError(
            f"run takes a plan, not {type(plan).__name__}: read_scene(path).run() runs a file, "
            "Scene(…).run() a scene"
        )
    start = perf_counter()
    files = files_read(plan.scene)
    work = Work(progress=progress)
    missed: list[Missed] = []
    if plan.choice is not None:
        plan, answer, accuracy = _chosen(plan.choice, work, missed)
    elif plan.method.certified:
        plan, answer, accuracy = enclosed(plan, work)
    else:
        answer, accuracy = estimated(plan, work)
    if not accuracy.certified and not accuracy.error_bound and _squares_vanish(plan):
        note = "every change is zero, or below what float64 holds: a tolerance tells which"
        accuracy = replace(accuracy, error_bound=math.inf, note=note)
    seconds = perf_counter() - start
    return Outcome(plan, answer, accuracy, work, seconds, files, tuple(missed))


def _chosen(choice: Choice, work: Work, missed: list[Missed]) -> tuple[Plan, Answer, Accuracy]:
    """Try the methods in order, until an estimate is within the tolerance or balls certify."""
    for candidate in choice.tried:
        assert candidate.plan is not None
        tried = replace(candidate.plan, choice=choice)
        if candidate.certified:
            return enclosed(tried, work)
        try:
            answer, accuracy = estimated(tried, work)
            why = shortfall(answer, accuracy, choice.tolerance)
        except (UnbuildableError, NotStandingError, ArithmeticError) as error:
            why = str(error)  # rounding may have made it so: the next method tells
        if not why:
            return tried, answer, accuracy
        missed.append(Missed(candidate.algorithm, candidate.arithmetic, why))
    balls = next(c for c in choice.candidates if c.certified)
    raise ToleranceError(
        f"the tolerance can't be reached: {missed[-1].arithmetic}: {missed[-1].why}; and "
        f"{balls.arithmetic}: {balls.out}"
    )


def _squares_vanish(plan: Plan) -> bool:
    """Say whether changes of second order, left where the first cancels, round to zero."""
    return 0 < plan.problem.radii.relative_std() ** 2 < Fraction(1, 10**300)


def read_tolerance(value: Any) -> Fraction:
    """Give a tolerance as a fraction. Raises ``SceneError``."""
    try:
        asked = parse(value) if isinstance(value, str) else exact(value)
    except ValueError as error:
        raise SceneError("tolerance", value, str(error)) from None
    if not 0 < asked < 1:
        raise SceneError("tolerance", value, "must lie between 0 and 1")
    return asked


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
        asked = None if tolerance is None else read_tolerance(tolerance)
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


def read_scene(path: str | Path, changes: Mapping[str, str] | None = None) -> Scene:
    """Read and check a scene file. Raises ``SceneError``.

    ``changes`` are new values for some keys, written as in the file:
    ``{"packing.height": "16", "disorder.kind": "normal"}``.
    """
    return reading.read_scene(Path(path), Scene, changes or {})
