"""The plan: which beads a scene's question needs, what is done with them, and what is left out.

One planner serves both explaining and running: the runner takes its regions, its route and its
steps from here and adds nothing but the measured cost.
"""

from dataclasses import replace
from fractions import Fraction

from force_diffusion.numeric.arithmetic.systems import FLOAT64, Balls
from force_diffusion.numeric.disorder.radii import DrawnRadii, MeasuredRadii, Monodisperse, Radii
from force_diffusion.numeric.lattice import regions
from force_diffusion.numeric.lattice.layers import Region, standing_on_base, whole
from force_diffusion.numeric.lattice.regions import Rows
from force_diffusion.numeric.mechanics import first_order
from force_diffusion.numeric.mechanics.load_spec import LoadSpec
from force_diffusion.numeric.planning import budget, float_range
from force_diffusion.numeric.planning.choice import choose
from force_diffusion.numeric.planning.cost_model import Model, defaults, predicted
from force_diffusion.numeric.planning.images import sees_images
from force_diffusion.numeric.planning.plan import (
    CERTIFY,
    ESTIMATE,
    FORCE_QUANTITIES,
    LONGER,
    PHYSICAL,
    Plan,
    Skipped,
    Step,
    Way,
)
from force_diffusion.numeric.scene.sections import DisorderSection, Scene, SceneError
from force_diffusion.numeric.scene.tables import Site, TableError, read_loads, read_radii

__all__ = ["Plan", "Skipped", "Step", "plan"]


def plan(
    scene: Scene,
    tolerance: Fraction | None = None,
    memory_limit: int | None = None,
    *,
    certified: bool = False,
    model: Model | None = None,
) -> Plan:
    """Plan a scene; ``tolerance`` and ``certified`` override the scene's own.

    With a tolerance the cheapest way that should meet it is chosen, by the cost model (by default
    that for any machine); ``certified`` keeps the choice to balls. Reads the scene's files. Raises
    ``SceneError`` for a scene that is too large for the memory (``memory_limit`` bytes, by default
    most of what is free) or for a lifetime, and ``TableError``.
    """
    tolerance = tolerance or scene.ask.tolerance
    certified = certified or scene.ask.certified
    limit = budget.memory_limit() if memory_limit is None else memory_limit
    model = defaults() if model is None else model
    outline = _Outline(scene, tolerance, limit, model)
    if tolerance is None:
        if certified:
            raise SceneError("ask.certified", True, "needs a tolerance, as tolerance = 1e-30")
        return outline.plan(outline.usual_way())
    if outline.route == "ordered":
        return outline.plan(Way(Balls(budget.initial_bits(tolerance, scene.packing.height))))
    outlines = {outline.algorithm: outline}
    if outline.route == "line sums" and outline.realisations > 1:
        # One by one they visit fewer beads, but a sweep takes many realisations at once.
        try:
            sweep = _Outline(scene, tolerance, limit, model, line_sums=False)
        except SceneError:  # the memory would not hold its region
            pass
        else:
            if sweep.route == "first-order":  # not where no load comes near the contact
                outlines[sweep.algorithm] = sweep
    return choose(outlines, tolerance, model.source, certified=certified)


class _Outline:
    """All of a plan but its arithmetic: regions, route, what is left out."""

    def __init__(
        self,
        scene: Scene,
        tolerance: Fraction | None,
        limit: int,
        model: Model,
        *,
        line_sums: bool = True,
    ) -> None:
        self.scene, self.tolerance, self.limit, self.model = scene, tolerance, limit, model
        self.width = scene.packing.width
        self.height = scene.packing.height
        self.quantity = scene.ask.quantity
        self.skipped: list[Skipped] = []
        ordered = self._ordered_from_the_start()
        self.closed = closed = ordered or (line_sums and self._line_sums_suffice())
        beads = 0 if ordered else budget.bound_of_beads(self.scene, closed=closed)
        self._refuse(None, beads, 1, Way(FLOAT64))
        self.load = self._load()
        self.force_rows = self._force_rows(self.load, closed) if self._needs_forces() else ()
        self.region = self._region(self.force_rows, closed)
        self.radii, self.route = self._route(self.region, ordered, closed)
        self.realisations = self._realisations(self.route)

    @property
    def algorithm(self) -> str:
        """How plans call the way to the numbers."""
        return {
            "ordered": "closed form",
            "line sums": "line sums",
            "first-order": "first-order sweep",
            "exact": "exact sweep in deviation form",
        }[self.route]

    def usual_way(self) -> Way:
        """Give the way without a tolerance: float64, or exactly known."""
        if self.route == "ordered":
            return Way(Balls(budget.initial_bits(Fraction(1, 2**60), self.height)))
        return Way(FLOAT64, LONGER, budget.repeated(self.region, self.realisations))

    def plan(self, way: Way) -> Plan:
        """Plan a way. Raises ``SceneError`` where it takes too much, or its numbers can't hold."""
        system, n = way.system, self.realisations
        if system.dtype is not object:
            float_range.check(self.scene, self.radii, self.load)
        steps = [
            replace(step, beads=step.beads * n, arithmetic=system.name)
            for step in self._steps(self.route, self.region, self.force_rows, self.load)
        ]
        if way.plain:
            why = "exact positions by intersecting circles, the ordered ones subtracted at the end"
            steps = [replace(s, reason=why) if s.step == "deposit" else s for s in steps]
        at_once = self.region.beads * min(n, budget.chunk_size(self.region, system, self.scene))
        if self.closed:  # one realisation after the other
            at_once = max((step.beads for step in steps), default=0) // n
        if self.route != "ordered":
            steps.append(self._judging(steps, way))
        elif not self.closed:
            at_once = 0
        memory = self._refuse(self.region, at_once, n, way)
        made = Plan(
            self.scene, self.radii, self.load, self.route, self.region, self.force_rows, n,
            self.tolerance, way, tuple(steps), tuple(self.skipped), memory, 0.0,
            sees_images(self.scene, self.load, self.route),
        )  # fmt: skip
        seconds = predicted(made, self.model)
        budget.refuse_seconds(self.scene, n, seconds)
        return replace(made, estimated_seconds=seconds)

    def _refuse(self, region: Region | None, beads: int, realisations: int, way: Way) -> int:
        """Give the memory needed, or refuse the scene; without a region, before there are rows."""
        rows = Region(self.width, ()) if region is None else region
        one = self.scene.ask.at is not None and not beads
        layers = (0 if one else self.height + 1) if region is None else len(rows.rows)
        needed = max(
            budget.memory(
                self.scene, rows, beads=beads, layers=layers, realisations=realisations, system=s
            )
            for s in (way.system, way.longer)
            if s is not None
        )
        budget.refuse_memory(self.scene, needed, self.limit)
        return needed

    def _needs_forces(self) -> bool:
        return self.quantity in FORCE_QUANTITIES

    def _ordered_from_the_start(self) -> bool:
        """Say whether it is plain without reading any file that nothing is disordered."""
        disorder = self.scene.disorder
        none = disorder is None or (disorder.file is None and not disorder.relative_std)
        return none or self.scene.effects.geometry == "ordered"

    def _line_sums_suffice(self) -> bool:
        one_bead = self.quantity == "positions" and self.scene.ask.at is not None
        return self.scene.effects.geometry == "first-order" and (
            one_bead or budget.one_contact(self.scene)
        )

    # What is asked

    def _load(self) -> LoadSpec:
        section = self.scene.load
        single = {}
        if section.kind == "file":
            assert section.file is not None
            single = read_loads(
                self.scene.folder / section.file,
                magnitude=section.magnitude,
                width=self.width,
                height=self.height,
            )
        at = None if section.at is None else (section.at[0], section.at[1])
        if self.quantity == "positions":
            if "load" in self.scene.model_fields_set:
                self._skip("load", "positions follow from the radii alone")
        elif not section.angle_deg and section.kind != "file":
            self._skip("load at an angle", "the load points straight down")
        return LoadSpec(section.kind, self.height, self.width, section.angle_deg, at, single)

    def _skip(self, effect: str, reason: str) -> None:
        self.skipped.append(Skipped(effect, reason))

    def _reach(self, load: LoadSpec) -> Rows:
        """Rows of beads that the load reaches."""
        if (loaded := load.loaded) is not None:
            return regions.downward_cone(loaded, self.width)
        if self.width is not None:
            return whole(self.width, self.height).rows
        # The slab: everything; a contact's own cone is cut out of rows wide enough for it.
        i, j, branch = self.scene.contact
        x = regions.upper_bead(i, j, branch)
        return regions.upward_cone(x, self.height, None)

    def _force_rows(self, load: LoadSpec, closed: bool) -> Rows:
        contact = budget.one_contact(self.scene)
        if contact and closed:
            return ()
        reach = self._reach(load)
        return regions.contact_rows(self.scene.contact, reach, self.width) if contact else reach

    def _region(self, force_rows: Rows, closed: bool) -> Region:
        if closed and self.scene.ask.at is not None:
            return Region(self.width, ())
        if self.quantity == "positions":
            if self.scene.ask.at is None:
                assert self.width is not None
                return whole(self.width, self.height)
            return regions.triangle(*self.scene.site, self.width)
        if not any(layer.count for layer in force_rows):
            return Region(self.width, ())
        return standing_on_base(force_rows, self.width)

    # How it is answered

    def _route(self, region: Region, ordered: bool, closed: bool) -> tuple[Radii, str]:
        scene = self.scene
        disorder = scene.disorder
        if not scene.effects.stop_at_tension:
            why = "not asked for: tensile contacts are counted, not acted on"
            self._skip("stop at tension", why)
        if disorder is None:
            self._skip("disorder", "the scene names none: all radii are equal")
            return Monodisperse(), "ordered"
        if ordered:
            why = "its relative_std is 0"
            if scene.effects.geometry == "ordered":
                why = 'geometry = "ordered" looks at the ordered packing only'
            self._skip("disorder", why)
            return Monodisperse(), "ordered"
        radii = self._radii(disorder, region)
        if not radii.relative_std() and not closed:
            self._skip("disorder", "every delta_r in the file is 0")
            return Monodisperse(), "ordered"
        if not closed and not region.rows:
            self._skip("disorder", "no load reaches what is asked for: the forces are exactly zero")
            return radii, "ordered"
        if scene.effects.geometry == "exact":
            return radii, "exact"
        why = 'geometry = "first-order" sums the radii along diagonals'
        self._skip("nonlinear geometry", why)
        return radii, "line sums" if closed else "first-order"

    def _radii(self, disorder: DisorderSection, region: Region) -> Radii:
        """Give the source of radii; a file is read here."""
        if disorder.file is None:
            assert disorder.relative_std is not None
            return DrawnRadii(disorder.kind, disorder.relative_std, disorder.seed, self.width)
        rows = region.rows

        def needed(site: Site) -> bool:
            i, j = site
            if not rows:  # line sums look up what they need
                return True
            return j < len(rows) and rows[j].first <= i <= rows[j].last

        measured = read_radii(
            self.scene.folder / disorder.file,
            radius=self.scene.packing.radius,
            width=self.width,
            height=self.height,
            needed=needed,
        )
        if self.width is None:
            for layer in rows:
                for i in layer.sites():
                    if (i, layer.j) not in measured:
                        raise TableError(
                            f"disorder.file: {disorder.file}: bead {(i, layer.j)} is missing"
                        )
        return MeasuredRadii(measured, self.width)

    def _realisations(self, route: str) -> int:
        asked = self.scene.ask.realisations
        if asked > 1 and route == "ordered":
            self._skip(
                "realisations", "without disorder all realisations are the same: one is solved"
            )
            return 1
        return asked

    def _line_beads(self, load: LoadSpec) -> int:
        """Count the beads of the line sums, as in regions: see ``first_order.contact_beads``."""
        if self.quantity == "positions":
            return 2 * self.scene.site[1] + 1
        return first_order.beads_read(self.scene.contact, load)

    def _steps(
        self,
        route: str,
        region: Region,
        force_rows: Rows,
        load: LoadSpec,
    ) -> list[Step]:
        """List the steps of one realisation."""
        needs_forces = self.quantity in FORCE_QUANTITIES
        steps: list[Step] = []

        def add(step: str, reason: str, beads: int) -> None:
            steps.append(Step(step, reason, beads))

        source = "read radii" if self.scene.disorder and self.scene.disorder.file else "draw radii"
        if route == "ordered":
            add("closed form", "the ordered packing is known: nothing is swept", 0)
        elif route == "line sums":
            beads = self._line_beads(load)
            add(source, "only the beads on the diagonals that the answer depends on", beads)
            add("line sums", "to first order the answer is a sum down a few diagonals", beads)
        else:
            add(source, self._region_reason(region), region.beads)
            if route == "exact":
                add(
                    "deposit",
                    "exact positions, as deviations in line-sum coordinates",
                    region.beads,
                )
            else:
                add("line sums", "displacements to first order, layer by layer", region.beads)
            if needs_forces:
                visited = sum(layer.count for layer in force_rows[1:])
                add("balance forces", self._force_reason(load), visited)
            if route == "exact":
                add(PHYSICAL, "gaps, overlaps and signs, always", region.beads)
        return steps

    def _judging(self, steps: list[Step], way: Way) -> Step:
        """Give the last step, which says how accurate the answer is."""
        if way.longer is None:
            why = "balls enclose the answer; bits are added, and all is done again, until it fits"
            return Step(CERTIFY, why, 0, way.system.name)
        passes = 1 if way.repeated == self.realisations else 2
        visits = sum(s.beads for s in steps if s.step != PHYSICAL) // self.realisations
        return Step(
            ESTIMATE,
            "the first realisations again with a longer significand",
            passes * way.repeated * visits,
            way.longer.name if passes == 1 else f"{way.system.name}, then {way.longer.name}",
        )

    def _region_reason(self, region: Region) -> str:
        if self.width is not None and region.beads == self.width * (self.height + 1):
            return "the answer depends on every bead"
        return "only the beads that the answer depends on: the triangles below what is asked"

    def _force_reason(self, load: LoadSpec) -> str:
        if load.loaded is not None:
            return "only beads in the downward cone of the load carry force"
        if budget.one_contact(self.scene):
            return "only beads above the contact decide its force"
        return "every bead passes its load on"
