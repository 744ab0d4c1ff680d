"""The plan: which beads a scene's question needs, what is done with them, and what is left out.

One planner serves both explaining and running: the runner takes its regions, its route and its
steps from here and adds nothing but the measured cost.
"""

import os
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import cached_property

from numeric import first_order, regions
from numeric.lattice import Region, whole
from numeric.load_spec import LoadSpec
from numeric.radii import DrawnRadii, MeasuredRadii, Monodisperse, Radii
from numeric.regions import Rows
from numeric.scene import DisorderSection, Scene, SceneError
from numeric.systems import FLOAT64, Balls, NumberSystem
from numeric.tables import Site, TableError, read_loads, read_radii

# Bytes a bead takes while it is solved, and an entry takes in the answer; measured, rounded up.
BYTES_FLOAT, BYTES_OBJECT, BYTES_ENTRY, BYTES_FILE, BYTES_ROW = 150, 2200, 1400, 600, 900
# Seconds a bead takes in each sweep; measured on one core, good to a factor of a few.
SECONDS_FLOAT, SECONDS_OBJECT, SECONDS_LAYER, SECONDS_ROW = 3e-7, 6e-5, 4e-4, 3e-5
LONGEST = 24 * 3600.0
FORCE_QUANTITIES = {
    "contact", "contact_forces", "profile", "histogram", "response", "base_reactions"
}  # fmt: skip


@dataclass(frozen=True)
class Step:
    """One step of a plan; ``beads`` counts those that it visits, in all realisations."""

    step: str
    reason: str
    beads: int
    arithmetic: str = ""


@dataclass(frozen=True)
class Skipped:
    """An effect that is not simulated, and why."""

    effect: str
    reason: str


@dataclass(frozen=True)
class Plan:
    """What will be done. ``route`` is "ordered", "line sums", "first-order" or "exact"."""

    scene: Scene
    radii: Radii
    load: LoadSpec
    route: str
    region: Region
    force_rows: Rows
    realisations: int
    tolerance: Fraction | None
    system: NumberSystem
    steps: tuple[Step, ...]
    skipped: tuple[Skipped, ...]
    memory: int
    estimated_seconds: float
    sees_images: bool
    notes: tuple[str, ...] = field(default=())

    @cached_property
    def needs_forces(self) -> bool:
        """Whether the question is about forces at all."""
        return self.scene.ask.quantity in FORCE_QUANTITIES

    @cached_property
    def single_contact(self) -> bool:
        """Whether one contact is asked for, and not the whole packing."""
        return _asks_one_contact(self.scene)


def _asks_one_contact(scene: Scene) -> bool:
    ask = scene.ask
    return ask.quantity == "contact" or (ask.quantity == "histogram" and ask.at is not None)


def initial_bits(tolerance: Fraction, height: int) -> int:
    """Choose a first precision for balls: the digits asked for, the loss up and down, a margin."""
    digits = max(tolerance.denominator.bit_length() - tolerance.numerator.bit_length(), 0)
    return digits + 4 * height.bit_length() + 48


def available_memory() -> int:
    """Give the bytes of free memory, or 1 GiB where the system does not tell."""
    try:
        return os.sysconf("SC_AVPHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
    except (ValueError, OSError, AttributeError):
        return 2**30


def plan(
    scene: Scene,
    tolerance: Fraction | None = None,
    memory_limit: int | None = None,
) -> Plan:
    """Plan a scene; ``tolerance`` overrides the scene's own.

    Reads the scene's files. Raises ``SceneError`` for a scene that is too large for the memory
    (``memory_limit`` bytes, by default most of what is free) or for a lifetime, and ``TableError``.
    """
    return _Planner(scene, tolerance or scene.ask.tolerance, memory_limit).plan()


class _Planner:
    def __init__(self, scene: Scene, tolerance: Fraction | None, limit: int | None) -> None:
        self.scene = scene
        self.tolerance = tolerance
        self.limit = int(available_memory() * 0.8) if limit is None else limit
        self.width = scene.packing.width
        self.height = scene.packing.height
        self.quantity = scene.ask.quantity
        self.skipped: list[Skipped] = []

    def plan(self) -> Plan:
        self._refuse_if_too_large(self._rough_beads(), entries=0)
        load = self._load()
        needs_forces = self.quantity in FORCE_QUANTITIES
        force_rows = self._force_rows(load) if needs_forces else ()
        region = self._region(force_rows)
        radii, route = self._route(region, force_rows)
        realisations = self._realisations(route)
        system: NumberSystem = FLOAT64
        if self.tolerance is not None or route == "ordered":
            system = Balls(initial_bits(self.tolerance or Fraction(1, 2**60), self.height))
        steps = [
            replace(step, beads=step.beads * realisations, arithmetic=system.name)
            for step in self._steps(route, region, force_rows, load)
        ]
        beads = sum(step.beads for step in steps)
        memory = self._memory(route, region, system, realisations)
        self._refuse_memory(memory)
        seconds = self._seconds(beads, region, system, realisations)
        return Plan(
            self.scene, radii, load, route, region, force_rows, realisations,
            self.tolerance, system, tuple(steps), tuple(self.skipped), memory, seconds,
            self._sees_images(route, region),
        )  # fmt: skip

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

    def _single_contact(self) -> bool:
        return _asks_one_contact(self.scene)

    def _force_rows(self, load: LoadSpec) -> Rows:
        reach = self._reach(load)
        if self._single_contact():
            return regions.contact_rows(self.scene.contact, reach, self.width)
        return reach

    def _region(self, force_rows: Rows) -> Region:
        if self.quantity == "positions":
            if self.scene.ask.at is None:
                assert self.width is not None
                return whole(self.width, self.height)
            return regions.triangle(*self.scene.site, self.width)
        if not force_rows or not any(layer.count for layer in force_rows):
            return Region(self.width, ())
        return regions.geometry_for(force_rows, self.width)

    # How it is answered

    def _route(self, region: Region, force_rows: Rows) -> tuple[Radii, str]:
        scene = self.scene
        geometry = scene.effects.geometry
        disorder = scene.disorder
        if not scene.effects.stop_at_tension:
            self._skip(
                "stop at tension", "not asked for: tensile contacts are counted, not acted on"
            )
        if disorder is None:
            self._skip("disorder", "the scene names none: all radii are equal")
            return Monodisperse(), "ordered"
        if geometry == "ordered":
            self._skip("disorder", 'geometry = "ordered" looks at the ordered packing only')
            return Monodisperse(), "ordered"
        radii = self._radii(disorder, region)
        if not radii.relative_std():
            why = "every delta_r in the file is 0" if disorder.file else "relative_std is 0"
            self._skip("disorder", why)
            return Monodisperse(), "ordered"
        if self.quantity in FORCE_QUANTITIES and not region.rows:
            self._skip("disorder", "no load reaches what is asked for: the forces are exactly zero")
            return radii, "ordered"
        if geometry == "first-order":
            self._skip(
                "nonlinear geometry", 'geometry = "first-order" sums the radii along diagonals'
            )
            single = self._single_contact() or (
                self.quantity == "positions" and scene.ask.at is not None
            )
            return radii, "line sums" if single else "first-order"
        return radii, "exact"

    def _radii(self, disorder: DisorderSection, region: Region) -> Radii:
        """Give the source of radii; a file is read here."""
        if disorder.file is None:
            assert disorder.relative_std is not None
            return DrawnRadii(disorder.kind, disorder.relative_std, disorder.seed, self.width)
        rows = region.rows

        def needed(site: Site) -> bool:
            i, j = site
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
                        raise TableError(f"{disorder.file}: bead {(i, layer.j)} is missing")
        return MeasuredRadii(measured, self.width)

    def _realisations(self, route: str) -> int:
        asked = self.scene.ask.realisations
        if asked > 1 and route == "ordered":
            self._skip(
                "realisations", "without disorder all realisations are the same: one is solved"
            )
            return 1
        return asked

    def _sees_images(self, route: str, region: Region) -> bool:
        if self.width is None or route == "ordered" or not region.rows:
            return False
        if route == "exact":
            return any(self._slab_width(region, j) > self.width for j in range(len(region.rows)))
        return self.width <= self.height

    def _slab_width(self, region: Region, j: int) -> int:
        """Beads of layer j that a single answer would visit in an infinite slab."""
        height = region.top
        load = self.scene.load
        if self.quantity == "positions":
            tip = self.height if self.scene.ask.at is None else self.scene.site[1]
            return tip - j + 1
        if load.kind == "point":
            assert load.at is not None
            return load.at[1] - j + 1
        lowest = self.scene.contact[1] if self._single_contact() else 0
        return max(2 * height - lowest - j, 0)

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
                add("check that it is physical", "gaps, overlaps and signs, always", region.beads)
        if route != "ordered":
            if self.tolerance is None:
                add(
                    "estimate the error",
                    "the first realisations again with a longer significand",
                    0,
                )
            else:
                add("certify", "balls enclose the answer; bits are added until it fits", 0)
        return steps

    def _region_reason(self, region: Region) -> str:
        if self.width is not None and region.beads == self.width * (self.height + 1):
            return "the answer depends on every bead"
        return "only the beads that the answer depends on: the triangles below what is asked"

    def _force_reason(self, load: LoadSpec) -> str:
        if load.loaded is not None:
            return "only beads in the downward cone of the load carry force"
        if self._single_contact():
            return "only beads above the contact decide its force"
        return "every bead passes its load on"

    # What it costs

    def _rough_beads(self) -> int:
        """Bound the beads of the region before a single row is made."""
        M, W = self.height, self.width
        if self.quantity == "positions" and self.scene.ask.at is not None:
            tip = self.scene.site[1]
            beads = regions.triangle_beads(tip)
            layers = tip + 1
        elif self.scene.load.kind == "point" and self.quantity in FORCE_QUANTITIES:
            assert self.scene.load.at is not None
            layers = self.scene.load.at[1] + 1
            beads = layers * (layers + 1) // 2
        elif self._single_contact():
            beads = regions.contact_beads(self.scene.contact[1], M)
            layers = M + 1
        else:
            beads, layers = (M + 1) * (W or M + 1), M + 1
        if W is not None:
            beads = min(beads, W * layers)
        if self.scene.effects.geometry != "exact" and self._single_contact():
            beads = min(beads, 8 * M)
        return beads

    def _refuse_if_too_large(self, beads: int, entries: int) -> None:
        bytes_each = BYTES_FLOAT if self.tolerance is None else BYTES_OBJECT
        if self.scene.effects.geometry == "ordered" or self.scene.disorder is None:
            bytes_each = 16
        self._refuse_memory(beads * bytes_each + entries * BYTES_ENTRY + self.height * BYTES_ROW)

    def _refuse_memory(self, memory: int) -> None:
        if memory > self.limit:
            raise SceneError(
                "packing.height",
                self.height,
                f"this scene would need about {_size(memory)} of memory and "
                f"{_size(self.limit)} may be used: ask for less, or for a smaller packing",
            )

    def _entries(self, region: Region, realisations: int) -> int:
        """Bound the number of rows of the answer."""
        if self.quantity == "histogram":
            changes = 1 if self._single_contact() else region.beads // 50
            return (self.scene.ask.bins or 1) + realisations * changes
        if self.quantity == "contact_forces" and self.width is not None:
            return 2 * self.width * self.height * realisations
        one = {
            "contact": 1,
            "positions": 1 if self.scene.ask.at is not None else region.beads,
            "contact_forces": 2 * region.beads,
            "response": 2 * region.beads,
            "base_reactions": region.rows[0].count if region.rows else 1,
            "profile": 2 * self.height,
        }[self.quantity]
        return one * (1 if self.quantity in {"profile", "response"} else realisations)

    def _memory(self, route: str, region: Region, system: NumberSystem, realisations: int) -> int:
        each = BYTES_FLOAT if system is FLOAT64 else BYTES_OBJECT
        solved = 0 if route == "ordered" else min(region.beads, 10**18) * each
        if route == "line sums":
            solved = 8 * self.height * each
        if system is FLOAT64 and route != "ordered":
            solved *= 3  # the second solution, in long double
        if isinstance(system, Balls):
            solved = solved * (64 + system.bits) // 128 if system.bits > 64 else solved
        file = 0
        if self.scene.disorder is not None and self.scene.disorder.file is not None:
            file = region.beads * BYTES_FILE
        return (
            solved + file + self._entries(region, realisations) * BYTES_ENTRY
            + len(region.rows) * BYTES_ROW + 100_000_000
        )  # fmt: skip

    def _seconds(
        self, beads: int, region: Region, system: NumberSystem, realisations: int
    ) -> float:
        each = SECONDS_FLOAT if system is FLOAT64 else SECONDS_OBJECT
        chunks = -(-realisations // chunk_size(region, system, self.scene))
        layers = len(region.rows)
        seconds = beads * each + chunks * layers * SECONDS_LAYER
        seconds += realisations * layers * SECONDS_ROW
        if seconds > LONGEST:
            raise SceneError(
                "ask.realisations",
                realisations,
                f"this scene would take about {seconds / 86400:.3g} days; "
                f"at most {LONGEST / 86400:.0f} are allowed: ask for fewer or smaller packings",
            )
        return seconds


def chunk_size(region: Region, system: NumberSystem, scene: Scene) -> int:
    """Say how many realisations are swept together: as many as keep the arrays small."""
    if system.dtype is object or scene.effects.stop_at_tension:
        return 1
    return max(1, 200_000 // max(region.beads, 1))


def _size(memory: int) -> str:
    for unit in ("B", "kB", "MB", "GB", "TB"):
        if memory < 1000:
            return f"{memory:.3g} {unit}"
        memory = memory // 1000 if memory > 10**7 else memory / 1000  # type: ignore[assignment]
    return f"{memory:.3g} PB"
