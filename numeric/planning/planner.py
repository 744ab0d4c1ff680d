"""From a scene to a plan: which beads, what is done with them, what is left out, in which digits.

One planner serves both explaining and running: ``run`` takes its problem and its method from here
and adds nothing but the measured cost.

A tolerance chooses the arithmetic: the first of float64, pairs and balls that should do. What is
promised is measured afterwards: a bound by balls, or an estimate, and a method whose estimate
misses the tolerance gives way to the next (see ``run``). Last come balls, whose bits are raised
until their bound fits. What a scene names is never replaced: all methods answer the same question
about the same packings.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import cached_property, lru_cache
from time import monotonic

from ..arithmetic.carried import LONGER, PAIRS, Pairs
from ..arithmetic.decimals import short
from ..arithmetic.machine import memory_limit as free_memory
from ..arithmetic.systems import FLOAT64, Balls, NumberSystem
from ..disorder.radii import Monodisperse, Radii
from ..lattice.layers import Region, Rows
from ..mechanics.engine import chunk_size, worth_compiling
from ..mechanics.problem import Problem, Route
from ..quantities import quantity_of
from ..quantities.base import Quantity
from ..scene.scene import Scene
from ..scene.sections import SceneError
from ..theory.expected import critical_height
from .memory import COMPILED, TooLargeError, fitting, memory, refuse_beads, refuse_memory
from .plan import ALGORITHMS, Candidate, Choice, Method, Plan, Skipped
from .sources import load_of, radii_of, refuse_beyond_floats

# Where so many realisations agree with a longer significand, the others are taken to do so, too;
# one is enough of packings that are not small.
FEW, SMALL = 4, 20_000
# To which packings are enclosed whose contacts open, relative to the largest force.
TOUCHING = Fraction(1, 10**17)
# Nearer to M* than this, disorder itself grows with the height, and rounding errors with it.
SOUND = 0.5
# A measured error is doubled: what repeats it is not exact.
SAFETY = 2
# Realisations that nobody repeated. Rounding errors of independent packings are alike, and near
# normal: of N numbers the largest is below 6 standard deviations for every N that is allowed, and
# that the largest of four is below 6/1000 of one has a chance of 5e-10.
UNSEEN = 1000
# Room for printing: a number that its error swallows is printed as 0, and digits are cut off.
PRINTED = 2


def plan(
    scene: Scene,
    tolerance: Fraction | None = None,
    memory_limit: int | None = None,
    *,
    certified: bool = False,
    system: NumberSystem = FLOAT64,
    text: bool = True,
) -> Plan:
    """Plan a scene; ``tolerance`` and ``certified`` override the scene's own.

    With a tolerance the first of float64, pairs and balls is chosen that should meet it;
    ``certified`` keeps the choice to balls. Without one ``system`` is the arithmetic. Room is left
    for rows as ``text``, as files and screens have them. Reads the
    scene's files. Raises ``SceneError`` for a scene that is too large for the memory
    (``memory_limit`` bytes, by default most of what is free), and ``TableError``.
    """
    tolerance = tolerance or scene.ask.tolerance
    certified = certified or scene.ask.certified
    if certified and tolerance is None:
        raise SceneError("ask.certified", True, "needs a tolerance, as tolerance = 1e-30")
    limit = _free(int(monotonic()), free_memory) if memory_limit is None else memory_limit

    def planned(scene: Scene) -> Plan:
        return _plan(scene, tolerance, limit, system, certified=certified, text=text)

    try:
        return planned(scene)
    except TooLargeError as refused:
        said = f"{refused.allowed}{fitting(scene, planned)}"
        raise TooLargeError(refused.key, refused.value, said) from None


@lru_cache(maxsize=1)
def _free(second: int, look: Callable[[], int]) -> int:
    """Give the free memory; it is looked up once in a second."""
    return look()


def _plan(
    scene: Scene,
    tolerance: Fraction | None,
    limit: int,
    system: NumberSystem,
    *,
    certified: bool,
    text: bool,
) -> Plan:
    """Plan a scene with this very tolerance."""
    asked = _Asked(quantity_of(scene), tolerance, limit, text)
    problem = asked.problem
    if problem.route == Route.ORDERED:  # exactly known, whatever is asked
        bits = initial_bits(tolerance or Fraction(1, 2**60), problem.height)
        return asked.plan(Method(Balls(bits)))
    if problem.route == Route.UNILATERAL:  # found in float64, proved in balls
        return asked.plan(Method(Balls(initial_bits(tolerance or TOUCHING, 1))))
    if tolerance is None:
        return asked.plan(usual_method(problem, system, merged=asked.quantity.merged))
    return asked.choose(tolerance, certified=certified)


@dataclass
class _Asked:
    """A scene's question, as a problem of which any method makes a plan in ``limit`` bytes.

    ``skipped``: effects that are left out, each with the reason, once there is a problem.
    """

    quantity: Quantity
    tolerance: Fraction | None
    limit: int
    text: bool
    skipped: dict[str, str] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self.scene = self.quantity.scene
        geometry, disorder = self.scene.effects.geometry, self.scene.disorder
        self.unilateral = self.scene.effects.contacts == "unilateral"
        # Whether it is plain without reading any file that nothing is disordered.
        self.ordered = not self.unilateral and (
            disorder is None
            or geometry == "ordered"
            or (disorder.kind not in ("file", "given") and not disorder.relative_std)
        )
        # Whether closed forms or line sums give the one answer.
        self.single = self.quantity.single and (self.ordered or geometry == "first-order")

    @cached_property
    def problem(self) -> Problem:
        """Which beads are solved, by which theory.

        Raises ``SceneError`` for a scene that is too large, before a single row of beads is made,
        and ``TableError``.
        """
        scene, quantity = self.scene, self.quantity
        beads = 5 * scene.packing.height if self.single else quantity.most_beads()
        if self.ordered and scene.packing.dimension == 2:
            beads = 0
        refuse_beads(quantity, beads, self.limit, text=self.text)
        load = load_of(scene)
        if not quantity.needs_forces:
            if "load" in scene.model_fields_set:
                self.skipped["load"] = "positions follow from the radii alone"
        elif not scene.load.angle_deg and scene.load.kind != "file":
            self.skipped["load at an angle"] = "the load points straight down"
        rows, region = Rows(), Region(load.width, Rows())
        if not self.single:
            rows, region = quantity.beads(load)
        unloaded = not region.rows or (quantity.needs_forces and load.loaded == [])
        radii, route = self._theory(region, unloaded=unloaded and not self.single)
        realisations = scene.ask.realisations
        if realisations > 1 and route == Route.ORDERED:
            why = "without disorder all realisations are the same: one is solved"
            self.skipped["realisations"] = why
            realisations = 1
        return Problem(
            scene.n_x,
            radii,
            load,
            route,
            region,
            rows,
            quantity.needs_forces,
            scene.contact,
            scene.site,
            realisations,
            scene.effects.most_programs,
            scene.effects.most_seconds,
        )

    def _theory(self, region: Region, *, unloaded: bool) -> tuple[Radii, Route]:
        """Give the radii and the route, and say what that leaves out."""
        scene, skipped = self.scene, self.skipped
        geometry = scene.effects.geometry
        radii: Radii = Monodisperse()
        if scene.disorder is not None and not self.ordered:
            radii = radii_of(scene, region.rows)
        if self.unilateral:
            return radii, Route.UNILATERAL
        if scene.packing.dimension == 2:
            why = 'contacts = "unilateral" would let beads move where a contact pulls'
            skipped["contacts that open"] = why
        why = ""
        if scene.disorder is None:
            why = "the scene names none: all radii are equal"
        elif geometry == "ordered":
            why = 'geometry = "ordered" looks at the ordered packing only'
        elif self.ordered:
            why = "its relative_std is 0"
        elif not radii.relative_std() and not self.single:
            why = "every delta_r in the file is 0"
        elif unloaded:
            why = "no load reaches what is asked for: the forces are exactly zero"
        if why:
            skipped["disorder"] = why
            return Monodisperse(), Route.ORDERED
        if geometry == "exact":
            return radii, Route.EXACT
        skipped["nonlinear geometry"] = 'geometry = "first-order" sums the radii along diagonals'
        return radii, Route.LINE_SUMS if self.single else Route.FIRST_ORDER

    def plan(self, method: Method) -> Plan:
        """Plan a method. Raises ``SceneError`` where it takes too much, or numbers can't hold."""
        quantity, problem, scene = self.quantity, self.problem, self.scene
        if method.carries or method.system.dtype is not object:
            refuse_beyond_floats(scene, problem.radii, problem.load)
        needed = self._memory(method)
        refuse_memory(scene, needed, self.limit)
        skipped = tuple(Skipped(*one) for one in self.skipped.items())
        return Plan(scene, quantity, problem, self.tolerance, method, skipped, needed)

    def choose(self, tolerance: Fraction, *, certified: bool) -> Plan:
        """Give the plan of the first method that should do, with all that were looked at.

        Raises ``SceneError`` if no method is possible.
        """
        problem, algorithm = self.problem, ALGORITHMS[self.problem.route]
        found: list[Candidate] = []
        refused: SceneError | None = None
        for method in methods(tolerance, problem):
            error = expected(method, problem.height, problem.realisations)
            out = why_not(method, problem, error, tolerance, certified=certified)
            made = None
            try:
                made = self.plan(method)
            except SceneError as why:
                refused, out = why, out or str(why)
            found.append(Candidate(algorithm, method, error, out, None if out else made))
        found.sort(key=lambda candidate: bool(candidate.out))
        possible, first = sum(not one.out for one in found), found[0].plan
        if first is None:  # balls, the last, are refused as well
            assert refused is not None
            raise refused
        reason = f"the first of {possible} that should meet it"
        if certified:
            reason = "certified was asked for, and only balls certify"
        elif possible == 1:
            reason = "the only one that should meet it"
        return replace(first, choice=Choice(tolerance, reason, tuple(found)))

    def _memory(self, method: Method) -> int:
        """Give the memory needed, of a whole packing."""
        problem, quantity = self.problem, self.quantity
        n, region = problem.realisations, problem.region
        together = min(n, chunk_size(problem, method.system))
        at_once = region.beads * together
        if problem.route == Route.LINE_SUMS:  # one realisation after the other
            at_once = quantity.line_beads(problem.load)
        elif problem.route == Route.ORDERED and problem.dimension == 2:
            at_once = 0
        at_once += quantity.gathered(region, together)
        longest = method.system
        if not method.carries and method.longer is not None:  # else that is only gathered in
            longest = method.longer
        compiler = COMPILED * worth_compiling(problem, method.system, carried=method.carries)
        return memory(quantity, region, at_once, n, longest, text=self.text) + compiler


def usual_units(system: NumberSystem, height: int) -> Fraction:
    """Give the largest rounding error to be expected, in units 2^-bits of the largest change.

    Measured up to height 128, in all quantities, loads and geometries, from σ/r = 1e-3 down to
    1e-100: at most 17, growing with the height. Hardware floats sum forces with compensation, big
    floats do not.
    """
    return Fraction(8) + (Fraction(height, 4) if system.dtype is not object else 2 * height)


def initial_bits(tolerance: Fraction, height: int) -> int:
    """Choose a first precision for balls: the digits asked for, the loss up and down, a margin."""
    digits = max(tolerance.denominator.bit_length() - tolerance.numerator.bit_length(), 0)
    return digits + 4 * height.bit_length() + 48


def expected(method: Method, height: int, realisations: int) -> Fraction:
    """Give the error that an answer is expected to be printed with, relative to its largest change.

    For balls, what they should certify: they lose some bits for the depth of the packing.
    """
    bits = method.system.bits
    if method.certified:
        return Fraction(max(height, 4) ** 2 * 2**12, 2**bits)
    if method.repeated >= realisations:  # all sweeps carry their errors
        few = 4 if method.system is FLOAT64 else 8 * height
        return Fraction(PRINTED * few, 2**bits)
    units = usual_units(method.system, height) * UNSEEN
    return (PRINTED * units + merging(method, realisations)) * Fraction(1, 2**bits)


def merging(method: Method, realisations: int) -> int:
    """Bound the roundings of merged statistics, in units 2^-bits: a few for each realisation."""
    return 0 if method.repeated >= realisations else 8 * realisations


def usual_method(problem: Problem, system: NumberSystem, *, merged: bool) -> Method:
    """Say how the error becomes known of an answer in this arithmetic, without a tolerance."""
    if isinstance(system, Balls):
        return Method(system)
    n = problem.realisations
    few = min(n, FEW if problem.region.beads < SMALL else 1)
    if system is FLOAT64:
        return Method(system, LONGER, few if merged else n)
    if isinstance(system, Pairs):
        return Method(system, system, few if merged else n)
    return Method(system, Balls(system.bits + 128), few)


def methods(tolerance: Fraction, problem: Problem) -> Iterator[Method]:
    """Give what is tried, in that order; few realisations are repeated rather than all."""
    if problem.realisations > FEW:
        yield Method(FLOAT64, LONGER, FEW)
    yield Method(FLOAT64, LONGER, problem.realisations)
    yield Method(PAIRS, PAIRS, problem.realisations)
    yield Method(Balls(initial_bits(tolerance, problem.height)))


def why_not(
    method: Method, problem: Problem, error: Fraction, tolerance: Fraction, *, certified: bool
) -> str:
    """Say why a method won't do; an empty string where it may."""
    if method.certified:
        return ""
    if certified:
        return "its error would be estimated, and certified was asked for"
    highest = critical_height(problem.radii.relative_std())
    if problem.route == Route.EXACT and problem.height > highest * SOUND:
        return f"the height is above M*/2 = {highest / 2:.3g}, where rounding errors grow with it"
    if error > tolerance:
        return f"expected to err by {short(error)}"
    return ""
