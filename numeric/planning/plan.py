"""A plan: a problem, the numbers it is solved in, and what is known before it runs."""

from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import Any

from ..arithmetic.decimals import bound_string, short
from ..arithmetic.systems import FLOAT64, Balls, NumberSystem
from ..disorder.radii import ArrayRadii, MeasuredRadii
from ..mechanics.images import sees_images
from ..mechanics.problem import Problem, Route
from ..quantities.base import Quantity, has_theory
from ..scene.scene import CheckedScene
from ..theory.expected import ExpectedTension, critical_height, expected_tension
from .memory import size

METHODS = {
    Route.ORDERED: "closed form of the ordered packing",
    Route.LINE_SUMS: "sums down a few diagonals, to first order",
    Route.FIRST_ORDER: "sweep layer by layer, to first order",
    Route.EXACT: "exact sweep layer by layer",
    Route.UNILATERAL: "linear programs: contacts that pull open, others close",
}


@dataclass(frozen=True, eq=False, repr=False)
class Plan:
    """How a scene will be solved, and what is known beforehand.

    ``system`` is the arithmetic, ``reason`` why it is no other. ``memory``: bytes at the peak;
    ``room``: those that could be used when it was made.
    ``error``: expected relative to the largest change; None where only the sweep can tell.
    ``skipped``: the effects that are left out, and why.
    """

    scene: CheckedScene
    quantities: tuple[Quantity, ...]
    problem: Problem
    tolerance: Fraction | None
    system: NumberSystem
    reason: str
    error: Fraction | None
    memory: int
    room: int
    skipped: dict[str, str]

    @property
    def quantity(self) -> Quantity:
        """The first question."""
        return self.quantities[0]

    @property
    def certified(self) -> bool:
        """Whether the error will be a rigorous bound."""
        return isinstance(self.system, Balls)

    @property
    def beads(self) -> int:
        """How many beads the answer depends on, over all realisations."""
        problem = self.problem
        if problem.route == Route.LINE_SUMS:
            return problem.realisations * problem.line_beads
        return 0 if problem.route == Route.ORDERED else problem.realisations * problem.region.beads

    @cached_property
    def sees_images(self) -> bool:
        """Whether the answer depends on periodic images, and so differs from the slab's."""
        return self.problem.route == Route.UNILATERAL or sees_images(self.problem)

    @cached_property
    def tension(self) -> ExpectedTension | None:
        """How many contacts of a packing are expected to pull.

        None if there is no theory. There is one for drawn radii and packings wider than high,
        under surface and bulk loads (for spheres straight down), whose contacts may pull.
        """
        load, problem = self.scene.load, self.problem
        known = self.scene.effects.contacts == "bilateral" and problem.needs_forces
        if not known or problem.width is None or not has_theory(problem):
            return None
        phi, std = float(problem.phi), float(problem.radii.relative_std)
        unit = tuple(map(float, problem.load.strength(problem.n_x, FLOAT64).unit))
        return expected_tension(problem.height, problem.width, phi, std, load.kind, unit)

    @cached_property
    def critical_height(self) -> float:
        """M* = (σ/r)^(-2/3), the height where σ_f is about ⟨f⟩; infinite for equal radii."""
        return critical_height(self.problem.radii.relative_std)

    @property
    def notes(self) -> list[str]:
        """What to know before using the answer."""
        notes = []
        problem, tension = self.problem, self.tension
        if tension is not None and tension.typical:
            contacts = problem.dimension * (problem.width or 0) * problem.height
            notes.append(
                f"a typical packing of this scene has tension: about {tension.contacts:.0f} of its "
                f"{contacts} contacts pull; at this width the first one is expected at a height of "
                f"about {tension.height_of_one}"
            )
        radii = problem.radii
        spread = radii.relative_std
        if isinstance(radii, MeasuredRadii | ArrayRadii) and abs(radii.mean) > float(spread) / 2:
            notes.append(
                f"the mean of the given radii differs from packing.radius by {radii.mean:.3g} r: "
                f"changes, σ/r = {short(spread)} and M* are relative to packing.radius"
            )
        highest = self.critical_height
        if tension is None and problem.needs_forces and problem.height > highest:
            notes.append(
                f"the height M = {problem.height} is above M* = {highest:.3g}, where σ_f is "
                "about as large as ⟨f⟩: many contacts may pull"
            )
        return notes

    def data(self) -> dict[str, Any]:
        """Data for JSON."""
        tension = self.tension
        expected = None
        if tension is not None:
            contacts = float(f"{tension.contacts:.3g}")
            expected = {"expected_contacts": contacts, "height_of_one": tension.height_of_one}
        return {
            "plan": {
                "method": METHODS[self.problem.route],
                "arithmetic": self.system.name,
                "reason": self.reason,
                "beads": self.beads,
                "memory_bytes": self.memory,
                "expected_error": None if self.error is None else bound_string(self.error),
            },
            "skipped": [{"effect": what, "reason": why} for what, why in self.skipped.items()],
            "sees_images": self.sees_images,
            "tension": expected,
            "notes": self.notes,
        }

    def __str__(self) -> str:
        """Say what would be done, what is left out, and why."""
        return "\n".join([*plan_lines(self.data()), *map("Note: {}".format, self.notes)])

    __repr__ = __str__


def plan_lines(data: dict[str, Any]) -> list[str]:
    """A plan as lines of text."""
    plan, tension = data["plan"], data["tension"]
    why = f": {plan['reason']}" if plan["reason"] else ""
    error = plan["expected_error"] or "known after the run"
    lines = [
        f"Method: {plan['method']}, in {plan['arithmetic']}{why}",
        *([f"Beads: {plan['beads']}"] if plan["beads"] else []),
        f"Memory: about {size(plan['memory_bytes'])}",
        f"Expected error, relative to the largest change: {error}",
    ]
    lines += [f"Skipped: {s['effect']}: {s['reason']}" for s in data["skipped"]]
    if tension:
        expected, height = tension["expected_contacts"], tension["height_of_one"]
        low = "at no allowed height" if height is None else f"at a height of about {height} layers"
        many = f"About {expected:.2g} contacts are" if expected >= 1e-3 else "No contact is"
        lines.append(f"{many} expected to pull; one is expected {low}")
    if data["sees_images"]:
        lines.append("The answer may depend on periodic images: it is for the strip, not the slab")
    return lines
