"""What accuracy costs: the time and error of one packing of a scene in each arithmetic.

Errors are relative to the largest |change| of the answer, and are distances from balls, which
enclose it. What would take too long is extrapolated from fewer layers.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from fractions import Fraction
from numbers import Real
from pathlib import Path
from time import process_time
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from .. import tables
from ..accuracy import ToleranceError, upper
from ..arithmetic.decimals import bound_string
from ..arithmetic.errors import UndecidedError, WrongTypeError, check_progress, checked, printable
from ..arithmetic.systems import Array, Balls, BigFloat, as_ball, largest_of
from ..disorder.radii import BeadError
from ..mechanics.problem import Route
from ..planning.plan import Plan
from ..planning.planner import plan
from ..quantities.answer import answer
from ..scene.scene import refuse
from ..scene.sections import Ask, Disorder, Load, SceneError
from .running import Scene, read_scene, run

if TYPE_CHECKING:
    from matplotlib.figure import Figure

# Of balls the digits that they certify; of mpmath those of each number.
DIGITS = {"float64": (16,), "balls": (15, 30, 100), "mpmath": (30,)}
# The first packing that is timed has so many layers.
FEW = 4
# Runs that take less are repeated, and the quickest counts.
SHORT, RUNS = 0.2, 3
# Of a run in which the processor's clock did not tick.
TICK = 1e-6
FAILURES = (BeadError, UndecidedError, ToleranceError, SceneError, ArithmeticError)
MEASURED, CERTIFIED, STATED, ESTIMATED = "measured", "certified", "stated", "estimated"
HEAD = f"{'way':<9}{'digits':>6}  {'error':<10}{'':<10}{'seconds':>10}  relative cost"


class Way(NamedTuple):
    """An arithmetic with its decimal digits, error and time.

    ``error`` is relative to the largest |change|. It is "measured" (the distance from balls),
    "certified" (the radius of balls), "stated" (of float64, if balls take too long) or
    "estimated" (the error that the arithmetic is set up for). ``seconds`` are processor time, and
    ``relative_cost`` is that time over the time of float64. ``extrapolated``: the time is
    extrapolated from fewer layers.
    """

    way: str
    digits: int
    error: float
    error_is: str
    seconds: float
    relative_cost: float
    extrapolated: bool

    def __str__(self) -> str:
        mark = f"  {ESTIMATED}" if self.extrapolated else ""
        error = bound_string(Fraction(self.error)) if self.error else "0"
        return (
            f"{self.way:<9}{self.digits:>6}  {error:<10}{self.error_is:<10}"
            f"{self.seconds:>10.3g}  {self.relative_cost:>13.3g}{mark}"
        )


@dataclass(frozen=True)
class CostStudy:
    """Error and time in each arithmetic; ``skipped`` says which failed, and why."""

    quantity: str
    ways: tuple[Way, ...]
    skipped: dict[str, str]

    def rows(self) -> list[tables.Row]:
        """A row for each arithmetic, ready for a data frame."""
        return [way._asdict() for way in self.ways]

    def data(self) -> dict[str, Any]:
        """Data for JSON."""
        return {
            "quantity": self.quantity,
            "errors_relative_to": "the largest |change| of the answer",
            "rows": self.rows(),
            "skipped": self.skipped,
        }

    def plot(self, title: str = "") -> "Figure":
        """Draw error over time, both logarithmic; needs matplotlib (the extra ``plots``)."""
        from ..figures.style import PAGE, HouseFigure, house_style

        with house_style():
            figure = HouseFigure(figsize=(PAGE, 3.4))
            axes = figure.subplots()
            for c, (name, marker) in enumerate(zip(DIGITS, "os^", strict=True)):
                color = f"C{c}"
                ways = [way for way in self.ways if way.way == name]
                seconds, errors = [w.seconds for w in ways], [w.error for w in ways]
                axes.loglog(seconds, errors, f":{marker}", c=color, mfc=color, label=name)
                for way in ways:
                    at = way.seconds, way.error
                    if way.extrapolated:
                        axes.plot(*at, marker, color=color)  # hollow, as the house style has it
                    axes.annotate(f" {way.digits} digits", at, va="bottom")
            hollow = any(way.extrapolated for way in self.ways)
            fewer = " (hollow: estimated from fewer layers)" if hollow else ""
            axes.set_xlabel(f"processor time in seconds{fewer}")
            axes.set_ylabel("error / largest |change|")
            axes.set_title(printable(title or self.quantity).replace("$", r"\$"))
            axes.margins(x=0.15)
            axes.legend()
        return figure

    def __str__(self) -> str:
        """Give the table."""
        failed = [f"{name}: {why}" for name, why in self.skipped.items()]
        return "\n".join([HEAD, *map(str, self.ways), *failed])

    def _repr_html_(self) -> str:
        """Show the table in a notebook."""
        return tables.html_table(self.rows(), [])


@checked
def cost(
    scene: Scene | str | Path, seconds: float = 20, progress: bool | Callable[[Way], object] = False
) -> CostStudy:
    """Measure what accuracy costs: the error and time of one packing in each arithmetic.

    ``scene`` may be a path. The arithmetics are float64, balls that certify 15, 30 and 100 digits,
    and mpmath. ``seconds`` limits the time of the whole study; whatever would take longer is
    extrapolated from fewer layers. ``progress=True`` prints each result as soon as it is known; a
    function is called with it. Raises ``SceneError`` if no force changes, and the errors of ``run``
    for packings that can't be built.

    >>> import force_diffusion as fd
    >>> scene = fd.Scene(
    ...     packing=fd.Packing(height=3, width=6),
    ...     disorder=fd.Disorder(kind="uniform", relative_std=1e-6, seed=1),
    ...     ask=fd.Ask(quantity="contact_forces"),
    ... )
    >>> for way in fd.cost(scene).ways:
    ...     print(way.way, way.digits, way.error < 10 ** (2 - way.digits), way.error_is)
    float64 16 True measured
    balls 15 True certified
    balls 30 True certified
    balls 100 True certified
    mpmath 30 True measured
    """
    check_progress(progress)
    if isinstance(scene, str | Path):
        scene = read_scene(scene)
    if not isinstance(scene, Scene):
        raise WrongTypeError(f"cost takes a scene or its path, not {type(scene).__name__}")
    refuse("cost", scene)
    if not isinstance(seconds, Real) or not 0 < seconds < 1e9:
        raise SceneError("seconds", seconds, "must be a positive number")
    single = scene.asking(realisations=1, tolerance=None, certified=False)
    study = _Study(single, process_time() + seconds)
    ways = []
    for way in study.ways():
        ways.append(way)
        if progress:
            (print if progress is True else progress)(way)
    if not ways:
        raise next(iter(study.failures.values()))
    skipped = {name: str(error) for name, error in study.failures.items()}
    return CostStudy(str(scene.ask.quantity), tuple(ways), skipped)


class _Timed(NamedTuple):
    """A run: its seconds, what was found, and the error that is stated.

    ``numbers`` is None where it was a run of fewer layers, whose seconds are extrapolated.
    """

    seconds: float
    numbers: Array | None
    stated: float


class _Study:
    """One packing in each arithmetic, until the processor's time ``end``."""

    def __init__(self, scene: Scene, end: float) -> None:
        self.scene, self.end = scene, end
        self.plan = plan(scene, Fraction(1, 10), certified=True)
        self.failures: dict[str, Exception] = {}
        self.true: tuple[Array, Balls] | None = None
        if self.plan.problem.route == Route.ORDERED:
            self._refuse_zero()

    def _refuse_zero(self) -> None:
        why = "every change is exactly zero here: there is nothing that errors could be relative to"
        raise SceneError("ask.quantity", self.scene.ask.quantity, why)

    def ways(self) -> Iterator[Way]:
        """Give each way, that of float64 as soon as balls tell its error."""
        every = [(name, digits) for name, all_ in DIGITS.items() for digits in all_]
        waiting: list[tuple[str, int, _Timed]] = []
        unit = None
        for place, (name, digits) in enumerate(every):
            allowed = max(self.end - process_time(), 0) / (len(every) - place)
            try:
                timed = self._timed(name, digits, allowed)
                unit = timed.seconds if unit is None else unit
                waiting.append((name, digits, timed))
            except FAILURES as error:
                self.failures[f"{name}, {digits} digits"] = error
            if self.true is not None or name == "mpmath":
                yield from (self._way(*way, unit or 1) for way in waiting)
                waiting = []

    def _way(self, name: str, digits: int, timed: _Timed, unit: float) -> Way:
        error, kind = float(f"1e-{digits}"), ESTIMATED
        if timed.numbers is not None and self.true is not None:
            error, kind = self._error(timed.numbers), CERTIFIED if name == "balls" else MEASURED
        elif timed.numbers is not None and name == "float64":
            error, kind = timed.stated, STATED
        relative = timed.seconds / unit
        return Way(name, digits, error, kind, timed.seconds, relative, timed.numbers is None)

    def _error(self, numbers: Array) -> float:
        """Bound the largest distance from balls, over the largest number; of balls, their radius.

        Raises ``SceneError`` where all of them are zero.
        """
        assert self.true is not None
        true, system = self.true
        with system.active():
            largest = largest_of(ball.abs_lower() for ball in true)
            if not largest > 0:
                self._refuse_zero()
            if hasattr(numbers[0], "rad"):
                off = largest_of(ball.rad() for ball in numbers)
            else:
                pairs = zip(numbers, true, strict=True)
                off = largest_of((as_ball(value) - ball).abs_upper() for value, ball in pairs)
            return float(upper(off / largest))

    def _timed(self, name: str, digits: int, allowed: float) -> _Timed:
        """Run a packing of more and more layers, and the whole one if it takes what is allowed."""
        height, beads = self.scene.packing.height, self.plan.problem.region.beads
        layers = FEW
        while layers < height:
            small = _planned(_smaller(self.plan, layers), name, digits)
            measured = _run(small, name, digits)
            whole = measured.seconds * beads / small.problem.region.beads
            if whole <= allowed:
                break
            if 4 * measured.seconds > allowed:
                return measured._replace(seconds=whole, numbers=None)
            layers *= 2
        measured = _run(_planned(self.scene, name, digits), name, digits)
        if name == "balls":
            assert measured.numbers is not None
            self.true = measured.numbers, Balls(4 * digits + 200)
        return measured


def _planned(scene: Scene, name: str, digits: int) -> Plan:
    if name == "float64":
        return plan(scene)
    return plan(scene, Fraction(1, 10**digits), certified=True)


def _run(planned: Plan, name: str, digits: int) -> _Timed:
    """Time some runs, the first of which may load what the others need."""
    spent: list[float] = []
    while not spent or (len(spent) < RUNS and sum(spent) < SHORT):
        start = process_time()
        if name == "mpmath":
            (table,) = answer(planned.quantities, planned.problem, [0], BigFloat(digits)).tables
            stated = 0.0
        else:
            outcome = run(planned)
            if outcome.accuracy.certified and name == "float64":
                raise ToleranceError("float64 can't hold such small changes; balls can")
            table, stated = outcome.table, float(outcome.accuracy.error_bound)
        spent.append(max(process_time() - start, TICK))
    numbers = np.concatenate([table.numbers[column] for column in table.small])
    return _Timed(min(spent), numbers, stated)


def _smaller(whole: Plan, layers: int) -> Scene:
    """Give a scene of fewer layers, whose beads take as long, whatever their radii and load are."""
    scene = whole.scene
    ask = Ask(quantity="positions" if scene.ask.quantity == "positions" else "contact_forces")
    if scene.packing.width is None:
        ask = Ask(quantity="contact", at=(0, 0, "+"))
    std = whole.problem.radii.relative_std
    return Scene(
        packing=scene.packing.model_copy(update={"height": layers, "allow_images": True}),
        disorder=Disorder(kind="uniform", relative_std=std),
        load=Load(angle_deg=scene.load.angle_deg),
        effects=scene.effects,
        ask=ask,
    )
