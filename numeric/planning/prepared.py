"""All of a plan but its arithmetic: the beads, the theory, and what is left out."""

from dataclasses import dataclass
from fractions import Fraction

from ..arithmetic.systems import FLOAT64, NumberSystem
from ..disorder.radii import Monodisperse, Radii
from ..lattice.layers import Region, Rows
from ..mechanics.engine import chunk_size, worth_compiling
from ..mechanics.images import sees_images
from ..mechanics.problem import Problem, Route
from ..quantities.base import Quantity
from ..scene.scene import Scene
from . import budget, float_range, segments
from .plan import Method, Plan, Skipped
from .sources import load_of, radii_of
from .steps import steps_of

# How plans call the way to the numbers.
ALGORITHMS = {
    Route.ORDERED: "closed form",
    Route.LINE_SUMS: "line sums",
    Route.FIRST_ORDER: "first-order sweep",
    Route.EXACT: "exact sweep in deviation form",
    Route.UNILATERAL: "beads move until no contact pulls",
}


@dataclass(frozen=True)
class PreparedScene:
    """A scene's question as a problem, of which any method makes a plan.

    ``limit``: bytes that may be used. ``closed``: whether closed forms or line sums answer it.
    ``text``: whether its rows become text.
    """

    scene: Scene
    quantity: Quantity
    problem: Problem
    skipped: tuple[Skipped, ...]
    limit: int
    closed: bool
    tolerance: Fraction | None
    text: bool

    @property
    def algorithm(self) -> str:
        """How plans call the way to the numbers."""
        return ALGORITHMS[self.problem.route]

    def plan(self, method: Method) -> Plan:
        """Plan a method. Raises ``SceneError`` where it takes too much, or numbers can't hold."""
        scene, problem = self.scene, self.problem
        together = chunk_size(problem, method.system)
        images = problem.route == Route.UNILATERAL or sees_images(
            problem, self.quantity.lowest_layer
        )
        if method.carries or method.system.dtype is not object:
            float_range.check(scene, problem.radii, problem.load)
        steps = steps_of(self.quantity, problem, method)
        visited = max((step.beads for step in steps), default=0)
        memory = self._memory(method, together, visited)
        cut = None
        if memory > self.limit or problem.region.beads > segments.QUICKER:
            cut = segments.cut(problem, method, scene, self.tolerance, self.limit)
        if cut is not None:
            steps = segments.steps(steps, cut, self.quantity, memory, self.limit)
            memory = segments.memory(cut, self.quantity, text=self.text)
            problem = cut
        budget.refuse_memory(scene, memory, self.limit)
        return Plan(
            scene,
            self.quantity,
            problem,
            self.tolerance,
            method,
            steps,
            self.skipped,
            memory,
            images,
        )

    def _memory(self, method: Method, together: int, visited: int) -> int:
        """Give the memory needed.

        ``together`` realisations are swept at once; the longest step has ``visited`` beads.
        """
        problem = self.problem
        n, region = problem.realisations, problem.region
        at_once = region.beads * min(n, together)
        if self.closed and problem.dimension == 2:  # one realisation after the other
            at_once = visited // n
        elif problem.route == Route.ORDERED and problem.dimension == 2:
            at_once = 0
        at_once += self.quantity.gathered(region, min(n, together))
        longer = None if method.carries else method.longer  # only gathered in
        systems = [s for s in (method.system, longer) if s is not None]
        most = max(
            _memory(self.scene, self.quantity, region, at_once, n, s, self.text) for s in systems
        )
        return most + budget.COMPILED * worth_compiling(
            problem, method.system, carried=method.carries
        )


def _memory(
    scene: Scene, quantity: Quantity, region: Region, beads: int, n: int, system: NumberSystem,
    text: bool,
) -> int:  # fmt: skip
    return budget.memory(
        beads=beads,
        rows=quantity.answer_rows(region, n),
        numbers=quantity.numbers,
        listed=0 if quantity.merged or n == 1 else n,
        layers=len(region.rows),
        system=system,
        dimension=scene.packing.dimension,
        text=text,
        file=scene.disorder is not None and scene.disorder.file is not None,
    )


def prepared(
    scene: Scene,
    quantity: Quantity,
    limit: int,
    tolerance: Fraction | None,
    *,
    text: bool = True,
) -> PreparedScene:
    """Say which beads are solved, by which theory, and what is left out.

    ``text``: rows become text. Raises ``SceneError`` for a scene
    that is too large, before a single row of beads is made, and ``TableError``.
    """
    unilateral = scene.effects.contacts == "unilateral"
    ordered = _ordered(scene) and not unilateral
    first_order = scene.effects.geometry == "first-order"
    has_line_sums = quantity.single and (scene.contact is not None or scene.site is not None)
    closed = ordered or (first_order and has_line_sums)
    _refuse_beads(scene, quantity, limit, tolerance, ordered=ordered, closed=closed, text=text)
    skipped: list[Skipped] = []
    load = load_of(scene)
    if not quantity.needs_forces:
        if "load" in scene.model_fields_set:
            skipped.append(Skipped("load", "positions follow from the radii alone"))
    elif not scene.load.angle_deg and scene.load.kind != "file":
        skipped.append(Skipped("load at an angle", "the load points straight down"))
    single = closed and quantity.single
    force_rows, region = (Rows(), Region(load.width, Rows())) if single else quantity.beads(load)
    unloaded = not region.rows or (quantity.needs_forces and load.loaded == [])
    radii, route = _theory(
        scene, region, skipped, ordered=ordered, closed=closed, unloaded=unloaded
    )
    realisations = scene.ask.realisations
    if realisations > 1 and route == Route.ORDERED:
        why = "without disorder all realisations are the same: one is solved"
        skipped.append(Skipped("realisations", why))
        realisations = 1
    problem = Problem(
        scene.n_x,
        radii,
        load,
        route,
        region,
        force_rows,
        quantity.needs_forces,
        scene.contact,
        scene.site,
        scene.effects.stop_at_tension,
        realisations,
        scene.effects.protocol if route == Route.UNILATERAL else "",
        scene.effects.most_events,
        scene.effects.most_seconds,
    )
    return PreparedScene(scene, quantity, problem, tuple(skipped), limit, closed, tolerance, text)


def _ordered(scene: Scene) -> bool:
    """Say whether it is plain without reading any file that nothing is disordered."""
    disorder = scene.disorder
    if disorder is None or scene.effects.geometry == "ordered":
        return True
    drawn = disorder.kind not in ("file", "given")
    return drawn and not disorder.relative_std


def _refuse_beads(
    scene: Scene,
    quantity: Quantity,
    limit: int,
    tolerance: Fraction | None,
    *,
    ordered: bool,
    closed: bool,
    text: bool,
) -> None:
    """Refuse what surely takes too much memory."""
    beads = quantity.most_beads()
    if closed and quantity.single:
        beads = 5 * scene.packing.height
    if ordered and scene.packing.dimension == 2:
        beads = 0
    layers = 0 if quantity.single and not beads else scene.packing.height + 1
    nothing = Region(scene.packing.width, Rows())
    needed = _memory(scene, quantity, nothing, beads, 1, FLOAT64, text)
    if segments.suits(scene, tolerance):
        height = scene.packing.height
        widest = min(scene.packing.width or 2 * height + 2, -(-2 * beads // (height + 1)))
        least = segments.division(widest, height, scene.packing.dimension, 0)
        needed = min(needed, least.bytes)
    budget.refuse_memory(scene, needed + layers * budget.PLAN_LAYER, limit)


def _theory(
    scene: Scene,
    region: Region,
    skipped: list[Skipped],
    *,
    ordered: bool,
    closed: bool,
    unloaded: bool,
) -> tuple[Radii, Route]:
    """Give the radii and the route, and say what that leaves out."""

    def skip(effect: str, reason: str) -> None:
        skipped.append(Skipped(effect, reason))

    if scene.effects.contacts == "unilateral":
        skip("stop at tension", "contacts open before they pull")
        given = scene.disorder is not None
        return radii_of(scene, region.rows) if given else Monodisperse(), Route.UNILATERAL
    if not scene.effects.stop_at_tension:
        skip("stop at tension", "not asked for: tensile contacts are counted, not acted on")
    if scene.packing.dimension == 2:
        why = 'contacts = "unilateral" would let beads move where a contact pulls'
        skip("contacts that open", why)
    if scene.disorder is None:
        skip("disorder", "the scene names none: all radii are equal")
        return Monodisperse(), Route.ORDERED
    if ordered:
        why = "its relative_std is 0"
        if scene.effects.geometry == "ordered":
            why = 'geometry = "ordered" looks at the ordered packing only'
        skip("disorder", why)
        return Monodisperse(), Route.ORDERED
    radii = radii_of(scene, region.rows)
    if not radii.relative_std() and not closed:
        skip("disorder", "every delta_r in the file is 0")
        return Monodisperse(), Route.ORDERED
    if not closed and unloaded:
        skip("disorder", "no load reaches what is asked for: the forces are exactly zero")
        return Monodisperse(), Route.ORDERED
    if scene.effects.geometry == "exact":
        return radii, Route.EXACT
    skip("nonlinear geometry", 'geometry = "first-order" sums the radii along diagonals')
    return radii, Route.LINE_SUMS if closed else Route.FIRST_ORDER
