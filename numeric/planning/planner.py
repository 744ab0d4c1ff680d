"""From a scene to a plan: which beads, what is done with them, what is left out, in which digits.

One planner serves both explaining and running: ``run`` takes its problem and its method from here
and adds nothing but the measured cost.

A tolerance chooses the arithmetic: float64 where that should do, and balls. What is promised is
measured afterwards: a bound by balls, or an estimate, and a method whose estimate misses the
tolerance gives way to the next (see ``run``). Last come balls, whose bits are raised until their
bound fits. What a scene names is never replaced: all methods answer the same question
about the same packings.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import cached_property, lru_cache
from math import isqrt
from time import monotonic

from ..arithmetic.decimals import short
from ..arithmetic.machine import memory_limit as free_memory
from ..arithmetic.systems import FLOAT64, Balls
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

# Where the errors of so many realisations are carried, the others are taken to be alike; one is
# enough of packings that are not small.
FEW, SMALL = 4, 20_000
# To which packings are enclosed whose contacts open, relative to the largest force.
TOUCHING = Fraction(1, 10**17)
# Nearer to M* than this, disorder itself grows with the height, and rounding errors with it.
SOUND = 0.5
# Realisations whose errors nobody carried. Rounding errors of independent packings are alike, and
# near normal: of N numbers the largest is below 6 standard deviations for every N that is allowed,
# and that the largest of four is below 6/1000 of one has a chance of 5e-10.
UNSEEN = 1000
# Room for printing: a number that its error swallows is printed as 0, and digits are cut off.
PRINTED = 2
# A float64 is off by so much of itself when it was rounded.
UNIT = Fraction(1, 2**53)


def plan(
    scene: Scene,
    tolerance: Fraction | None = None,
    memory_limit: int | None = None,
    *,
    certified: bool = False,
    text: bool = True,
) -> Plan:
    """Plan a scene; ``tolerance`` and ``certified`` override the scene's own.

    With a tolerance balls are chosen where float64 should not meet it; ``certified`` keeps the
    choice to balls. Room is left for rows as ``text``, as files and screens have them. Reads the
    scene's files. Raises ``SceneError`` for a scene that is too large for the memory
    (``memory_limit`` bytes, by default most of what is free), and ``TableError``.
    """
    tolerance = tolerance or scene.ask.tolerance
    certified = certified or scene.ask.certified
    if certified and tolerance is None:
        raise SceneError("ask.certified", True, "needs a tolerance, as tolerance = 1e-30")
    limit = _free(int(monotonic()), free_memory) if memory_limit is None else memory_limit

    def planned(scene: Scene) -> Plan:
        return _plan(scene, tolerance, limit, certified=certified, text=text)

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
        return asked.plan(usual_method(problem, merged=asked.quantity.merged))
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
        if not method.certified:
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
            error = expected(method, self.quantity, problem)
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
        carried = not method.certified
        compiler = COMPILED * worth_compiling(problem, method.system, carried=carried)
        return memory(quantity, region, at_once, n, method.system, text=self.text) + compiler


def gathering(quantity: Quantity, problem: Problem) -> int:
    """Estimate what gathering a number rounds, in ``UNIT`` of the largest change.

    Of a product with a magnitude two more. Rounding errors have random signs: of sums over a layer,
    which are added up by halves, and of statistics that are merged realisation by realisation. That
    is three times what was measured, of 3 × 5 to 40 × 90 beads and up to 300 realisations.
    """
    units = quantity.roundings
    if problem.needs_forces and quantity.scene.load.magnitude != 1:
        units += 2
    if quantity.merged:
        units += problem.region.widest.bit_length() // 2 + isqrt(problem.realisations)
    return units


def initial_bits(tolerance: Fraction, height: int) -> int:
    """Choose a first precision for balls: the digits asked for, the loss up and down, a margin."""
    digits = max(tolerance.denominator.bit_length() - tolerance.numerator.bit_length(), 0)
    return digits + 4 * height.bit_length() + 48


def expected(method: Method, quantity: Quantity, problem: Problem) -> Fraction:
    """Give the error that an answer is expected to be printed with, relative to its largest change.

    For balls, what they should certify: they lose some bits for the depth of the packing. What
    float64 errs by where no errors are carried was measured up to height 128, in all quantities,
    loads and geometries, from σ/r = 1e-3 down to 1e-100: at most 17 units, growing with the height.
    """
    if method.certified:
        return Fraction(max(problem.height, 4) ** 2 * 2**12, 2**method.system.bits)
    units = Fraction(1 + gathering(quantity, problem))
    if method.repeated < problem.realisations:
        units += UNSEEN * (8 + Fraction(problem.height, 4))
    return PRINTED * units * UNIT


def usual_method(problem: Problem, *, merged: bool) -> Method:
    """Say of how many realisations errors are carried, without a tolerance."""
    n = problem.realisations
    few = min(n, FEW if problem.region.beads < SMALL else 1)
    return Method(FLOAT64, few if merged else n)


def methods(tolerance: Fraction, problem: Problem) -> Iterator[Method]:
    """Give what is tried, in that order; the errors of few realisations rather than of all."""
    if problem.realisations > FEW:
        yield Method(FLOAT64, FEW)
    yield Method(FLOAT64, problem.realisations)
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
