"""A scene becomes an outcome: planned, solved, checked, and its error known.

``Scene`` adds to ``CheckedScene`` the two verbs that need all the rooms below.
"""

from collections.abc import Iterator, Mapping
from contextlib import contextmanager, nullcontext
from fractions import Fraction
from pathlib import Path
from time import perf_counter
from typing import Any

from ..accuracy import Accuracy, ToleranceError, enclosed, estimated, shortfall
from ..arithmetic.decimals import Exact, exact, parse
from ..arithmetic.errors import WrongTypeError, check_progress, checked, quoted
from ..disorder.radii import BeadError
from ..mechanics.work import Progress, Work, bar
from ..planning.plan import Plan
from ..planning.planner import in_balls
from ..planning.planner import plan as make_plan
from ..quantities.answer import Answer
from ..scene import reading
from ..scene.scene import CheckedScene, files_read
from ..scene.sections import SceneError
from .outcome import Outcome, outcome_of


@checked
def run(what: Plan | CheckedScene | str | Path, progress: bool | Progress = False) -> Outcome:
    """Answer the question of a scene, of a scene file or of a plan.

    ``progress=True`` shows a bar; a function is called with the kind of work and the number of
    beads just done. If the estimated error of float64 misses the tolerance, the answer is computed
    in balls. Raises ``ToleranceError``, ``SceneError``, ``WrongTypeError`` for something else, and
    ``UnbuildableError``, ``NotStandingError`` or ``RadiusError`` for packings that can't be built.
    """
    check_progress(progress)
    if isinstance(what, str | Path):
        what = read_scene(what)
    if isinstance(what, CheckedScene):
        what = make_plan(what)
    if not isinstance(what, Plan):
        raise WrongTypeError(f"run takes a scene, its path or a plan, not {type(what).__name__}")
    plan = what
    start = perf_counter()
    files = files_read(plan.scene)
    with _bar(plan) if progress is True else nullcontext(progress or None) as follow:
        plan, answer, judged = _answered(plan, Work(progress=follow))
    return outcome_of(plan, answer, judged, perf_counter() - start, files)


@contextmanager
def _bar(plan: Plan) -> Iterator[Progress]:
    """Show a bar of the beads solved."""
    with bar("solving", plan.beads) as update:

        def progress(kind: str, beads: int) -> None:
            if kind in {"deposited", "summed"}:
                update(advance=beads)

        yield progress


def _answered(plan: Plan, work: Work) -> tuple[Plan, Answer, list[Accuracy]]:
    """Answer a plan; gives the plan that did it in the end."""
    if not plan.certified:
        try:
            answer, judged = estimated(plan, work)
            missed = shortfall(plan, answer, judged)
        except (BeadError, ArithmeticError) as error:
            if plan.tolerance is None:
                raise
            missed = str(error)  # rounding may have made it so: balls tell
        if missed:
            try:
                plan = in_balls(plan, f"float64 was tried: {missed}")
            except SceneError as error:
                why = f"float64: {missed}; and balls: {error}"
                raise ToleranceError(f"the tolerance can't be reached: {why}") from None
    if plan.certified:
        return enclosed(plan, work)
    return plan, answer, judged


def read_tolerance(value: Any) -> Fraction:
    """Give a tolerance as a fraction. Raises ``SceneError``."""
    try:
        asked = parse(value) if isinstance(value, str) else exact(value)
    except ValueError as error:
        raise SceneError("tolerance", value, str(error)) from None
    if not 0 < asked < 1:
        raise SceneError("tolerance", value, "must lie between 0 and 1: 1e-12 asks for 12 digits")
    return asked


class Scene(CheckedScene):
    """A scene, which can be explained and run; :func:`read_scene` makes one from a TOML file.

    Its sections are ``packing``, ``disorder`` (None: all radii are equal), ``load`` (by default a
    surface load), ``effects`` and ``ask``; paths of files start at ``folder``. Raises
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

    @checked
    def explain(self, tolerance: Exact | None = None, *, certified: bool = False) -> Plan:
        """Say what ``run`` would do, what it would leave out, and why; ``print`` shows it.

        ``tolerance`` is the largest error allowed, relative to the largest change; ``certified``
        accepts only a rigorous bound. Both override the scene. Raises ``SceneError`` for a scene
        that takes too much memory or time, and ``TableError`` for a file of radii or loads.
        """
        asked = None if tolerance is None else read_tolerance(tolerance)
        return make_plan(self, asked, certified=certified)

    @checked
    def run(
        self,
        tolerance: Exact | None = None,
        *,
        certified: bool = False,
        progress: bool | Progress = False,
    ) -> Outcome:
        """Answer the scene's question; arguments as for ``explain``.

        ``progress`` is that of ``fd.run``. Raises also
        ``ToleranceError``, and ``UnbuildableError``, ``NotStandingError`` or ``RadiusError`` for a
        packing that can't be built.
        """
        return run(self.explain(tolerance, certified=certified), progress)


@checked
def read_scene(path: str | Path, changes: Mapping[str, str] | None = None) -> Scene:
    """Read and check a scene file. Raises ``SceneError``.

    ``changes`` are new values for some keys, written as in the file:
    ``{"packing.height": "16", "disorder.kind": "normal"}``.
    """
    if not isinstance(path, str | Path):
        raise WrongTypeError(f"read_scene takes the path of a file, not {quoted(path)}")
    if not isinstance(changes, Mapping | None):
        raise WrongTypeError(f"changes are values by key, not {quoted(changes)}")
    for key, value in (changes or {}).items():
        if not isinstance(key, str):
            raise WrongTypeError(f"keys of changes are text, such as 'ask.at', not {quoted(key)}")
        if not isinstance(value, str):
            raise SceneError(key, value, "must be text, as a scene file has it")
    return reading.read_scene(Path(path), Scene, changes)
