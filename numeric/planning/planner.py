"""From a scene to a plan: which beads, what is done with them, what is left out, in which digits.

One planner serves both explaining and running: ``run`` takes its problem and its method from here
and adds nothing but the measured cost.
"""

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import cached_property, lru_cache
from time import monotonic

from ..arithmetic.errors import ForceDiffusionError
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
from .memory import COMPILED, TooLargeError, divided, memory, refuse_beads, refuse_memory, size
from .methods import (
    TOUCHING,
    Method,
    expected,
    initial_bits,
    methods,
    usual_method,
    why_not,
)
from .plan import ALGORITHMS, Candidate, Choice, Plan, Skipped
from .sources import load_of, radii_of, refuse_beyond_floats


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
    try:
        return _plan(scene, tolerance, limit, system, certified=certified, text=text)
    except TooLargeError as refused:
        if tolerance is None or certified:
            raise
        try:
            free = _plan(scene, None, limit, system, certified=False, text=text)
        except ForceDiffusionError:
            raise refused from None
        takes = f"about {size(free.memory)}"
        said = f"{refused.allowed}; without the tolerance it would take {takes}"
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
        refuse_beads(quantity, beads, self.tolerance, self.limit, text=self.text)
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
            scene.effects.stop_at_tension,
            realisations,
            scene.effects.protocol if self.unilateral else "",
            scene.effects.most_events,
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
            skipped["stop at tension"] = "contacts open before they pull"
            return radii, Route.UNILATERAL
        if not scene.effects.stop_at_tension:
            skipped["stop at tension"] = "not asked for: tensile contacts are counted, not acted on"
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
        problem, needed, because = divided(
            quantity, problem, method, self.tolerance, self._memory(method), self.limit,
            text=self.text,
        )  # fmt: skip
        refuse_memory(scene, needed, self.limit)
        skipped = tuple(Skipped(*one) for one in self.skipped.items())
        return Plan(scene, quantity, problem, self.tolerance, method, skipped, needed, because)

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
