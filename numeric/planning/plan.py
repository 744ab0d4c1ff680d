"""What a plan is: steps, what is left out, and the ways to the answer that were weighed."""

from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property

from force_diffusion.numeric.arithmetic.systems import (
    FLOAT64,
    LONGDOUBLE,
    Balls,
    BigFloat,
    NumberSystem,
)
from force_diffusion.numeric.disorder.radii import Radii
from force_diffusion.numeric.lattice.layers import Region
from force_diffusion.numeric.lattice.regions import Rows
from force_diffusion.numeric.mechanics.load_spec import LoadSpec
from force_diffusion.numeric.planning import budget
from force_diffusion.numeric.scene.sections import Scene

PHYSICAL, ESTIMATE, CERTIFY = "check that it is physical", "estimate the error", "certify"
# What errors of float64 are estimated with: an own long double, where the platform has one.
LONGER: NumberSystem = LONGDOUBLE if LONGDOUBLE.bits > FLOAT64.bits else BigFloat(35)
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
class Way:
    """An arithmetic, and how the error of its answer becomes known.

    ``longer`` repeats the first ``repeated`` realisations; None stands for balls, which certify.
    ``plain`` solves for positions and forces, and subtracts the ordered ones.
    """

    system: NumberSystem
    longer: NumberSystem | None = None
    repeated: int = 0
    plain: bool = False

    @property
    def certified(self) -> bool:
        """Whether the error is a rigorous bound."""
        return isinstance(self.system, Balls)


@dataclass(frozen=True)
class Candidate:
    """A way that was weighed: what it is expected to cost and to err, or why it is out.

    ``error``: relative to the largest change, expected (balls: bounded) before anything runs.
    """

    algorithm: str
    arithmetic: str
    certified: bool
    repeated: int
    error: Fraction
    seconds: float | None
    out: str
    plan: "Plan | None"

    @property
    def ends(self) -> bool:
        """Whether nothing else can answer where this can't: balls, and not in the plain form."""
        return self.certified and self.plan is not None and not self.plan.way.plain


@dataclass(frozen=True)
class Choice:
    """What a tolerance led to; ``candidates`` stand in the order in which they are tried."""

    tolerance: Fraction
    reason: str
    coefficients: str
    candidates: tuple[Candidate, ...]
    digit_more: "Candidate | None" = None
    digit_less: "Candidate | None" = None

    @property
    def tried(self) -> tuple[Candidate, ...]:
        """What is tried, the chosen one first; nothing comes after a way that ends it."""
        possible = [c for c in self.candidates if not c.out]
        last = next((k for k, c in enumerate(possible) if c.ends), len(possible))
        return tuple(possible[: last + 1])


@dataclass(frozen=True)
class Plan:
    """What will be done. ``route`` is "ordered", "line sums", "first-order" or "exact".

    ``choice`` says which ways a tolerance was weighed for, None without one.
    """

    scene: Scene
    radii: Radii
    load: LoadSpec
    route: str
    region: Region
    force_rows: Rows
    realisations: int
    tolerance: Fraction | None
    way: Way
    steps: tuple[Step, ...]
    skipped: tuple[Skipped, ...]
    memory: int
    estimated_seconds: float
    sees_images: bool
    choice: Choice | None = None

    @property
    def system(self) -> NumberSystem:
        """The arithmetic of the answer."""
        return self.way.system

    @cached_property
    def needs_forces(self) -> bool:
        """Whether the question is about forces at all."""
        return self.scene.ask.quantity in FORCE_QUANTITIES

    @cached_property
    def single_contact(self) -> bool:
        """Whether one contact is asked for, and not the whole packing."""
        return budget.one_contact(self.scene)
