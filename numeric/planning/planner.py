"""From a scene to a plan: which beads, what is done with them, what is left out, in which digits.

One planner serves both explaining and running: ``run`` takes its problem and its method from here
and adds nothing but the measured cost.
"""

from collections.abc import Callable
from dataclasses import dataclass, field
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
from . import division
from .memory import COMPILED, PLAN_LAYER, TooLargeError, memory, refuse_memory, size
from .methods import TOUCHING, choose, initial_bits, usual_method
from .plan import ALGORITHMS, Method, Plan, Skipped, steps_of
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
    algorithm = ALGORITHMS[problem.route]
    return choose(asked.plan, problem, algorithm, tolerance, certified=certified)


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
        self._refuse_beads()
        scene, quantity, load = self.scene, self.quantity, load_of(self.scene)
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

    def _refuse_beads(self) -> None:
        """Refuse what surely takes too much memory, with the least of plans."""
        quantity, packing = self.quantity, self.scene.packing
        beads = 5 * packing.height if self.single else quantity.most_beads()
        if self.ordered and packing.dimension == 2:
            beads = 0
        layers = 0 if quantity.single and not beads else packing.height + 1
        nothing, rows = Region(packing.width, Rows()), layers * PLAN_LAYER
        needed = memory(quantity, nothing, beads, 1, FLOAT64, text=self.text)
        if needed + rows > self.limit and division.suits(self.scene, self.tolerance):
            height = packing.height
            widest = min(packing.width or 2 * height + 2, -(-2 * beads // (height + 1)))
            needed = min(needed, division.division(widest, height, packing.dimension, 0).bytes)
        refuse_memory(self.scene, needed + rows, self.limit)

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
        needed, cut, because = self._memory(method), None, ""
        if needed > self.limit or problem.region.beads > division.QUICKER:
            cut = division.cut(problem, method, scene, self.tolerance, self.limit)
        if cut is not None:
            because = division.why(needed, self.limit)
            needed = division.memory(cut, quantity, text=self.text)
            problem = cut
        refuse_memory(scene, needed, self.limit)
        skipped = tuple(Skipped(*one) for one in self.skipped.items())
        return Plan(scene, quantity, problem, self.tolerance, method, skipped, needed, because)

    def _memory(self, method: Method) -> int:
        """Give the memory needed, of a whole packing."""
        problem, quantity = self.problem, self.quantity
        n, region = problem.realisations, problem.region
        together = min(n, chunk_size(problem, method.system))
        at_once = region.beads * together
        if problem.route == Route.LINE_SUMS:  # one realisation after the other
            at_once = max(step.beads for step in steps_of(quantity, problem, method)) // n
        elif problem.route == Route.ORDERED and problem.dimension == 2:
            at_once = 0
        at_once += quantity.gathered(region, together)
        longest = method.system
        if not method.carries and method.longer is not None:  # else that is only gathered in
            longest = method.longer
        compiler = COMPILED * worth_compiling(problem, method.system, carried=method.carries)
        return memory(quantity, region, at_once, n, longest, text=self.text) + compiler
