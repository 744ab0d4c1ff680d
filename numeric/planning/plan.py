"""What a plan is: a problem, steps, what is left out, and the ways to the answer."""

from dataclasses import asdict, dataclass
from fractions import Fraction
from functools import cached_property
from importlib.util import find_spec
from typing import Any

from ..arithmetic.decimals import bound_string, short
from ..arithmetic.systems import FLOAT64, Balls, NumberSystem
from ..disorder.radii import ArrayRadii, DrawnRadii, MeasuredRadii
from ..mechanics.engine import worth_compiling
from ..mechanics.images import sees_images
from ..mechanics.physicality import PHYSICAL
from ..mechanics.problem import Problem, Route
from ..mechanics.work import ESTIMATE
from ..quantities.base import Quantity, has_theory
from ..scene.scene import Scene
from ..tables import text_table
from ..theory.expected import (
    ExpectedTension,
    critical_height,
    expected_tension,
    expected_tension_of_spheres,
)
from .memory import size

CERTIFY = "certify"
# How plans call the way to the numbers.
ALGORITHMS = {
    Route.ORDERED: "closed form",
    Route.LINE_SUMS: "line sums",
    Route.FIRST_ORDER: "first-order sweep",
    Route.EXACT: "exact sweep in deviation form",
    Route.UNILATERAL: "beads move until no contact pulls",
}
_WHOLE = "spheres are always swept in whole layers"


@dataclass(frozen=True)
class Method:
    """An arithmetic; in float64, sweeps of the first ``repeated`` realisations carry errors."""

    system: NumberSystem
    repeated: int = 0

    @property
    def certified(self) -> bool:
        """Whether the error is a rigorous bound."""
        return isinstance(self.system, Balls)


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
class Candidate:
    """A method that was looked at, and its plan, or why it is out.

    ``error``: relative to the largest change, expected (balls: bounded) before anything runs.
    """

    algorithm: str
    method: Method
    error: Fraction
    out: str
    plan: "Plan | None"

    @property
    def arithmetic(self) -> str:
        """What the arithmetic is called."""
        return self.method.system.name

    @property
    def certified(self) -> bool:
        """Whether the error would be a rigorous bound."""
        return self.method.certified

    def data(self) -> dict[str, Any]:
        """Give what JSON can hold of it."""
        return {
            "algorithm": self.algorithm,
            "arithmetic": self.arithmetic,
            "certified": self.certified,
            "repeated": self.method.repeated,
            "expected_error": bound_string(self.error),
            "memory_bytes": None if self.plan is None else self.plan.memory,
            "out": self.out,
        }


@dataclass(frozen=True)
class Choice:
    """What a tolerance led to; ``candidates`` stand in the order in which they are tried."""

    tolerance: Fraction
    reason: str
    candidates: tuple[Candidate, ...]

    @property
    def tried(self) -> tuple[Candidate, ...]:
        """What is tried, the chosen one first; nothing comes after balls."""
        possible = [c for c in self.candidates if not c.out]
        last = next((k for k, c in enumerate(possible) if c.certified), len(possible))
        return tuple(possible[: last + 1])

    def data(self) -> dict[str, Any]:
        """Give what JSON can hold of it; the chosen method is the first of the candidates."""
        looked_at = [candidate.data() for candidate in self.candidates]
        return {
            "tolerance": short(self.tolerance),
            "reason": self.reason,
            "chosen": looked_at[0],
            "candidates": looked_at,
        }


@dataclass(frozen=True, eq=False, repr=False)
class Plan:
    """What will be done; ``choice`` says what a tolerance led to, None without one."""

    scene: Scene
    quantity: Quantity
    problem: Problem
    tolerance: Fraction | None
    method: Method
    skipped: tuple[Skipped, ...]
    memory: int
    choice: Choice | None = None

    @property
    def system(self) -> NumberSystem:
        """The arithmetic of the answer."""
        return self.method.system

    @cached_property
    def sees_images(self) -> bool:
        """Whether the answer is that of the periodic strip, and not of the slab."""
        unilateral = self.problem.route == Route.UNILATERAL
        return unilateral or sees_images(self.problem)

    @cached_property
    def steps(self) -> tuple[Step, ...]:
        """What is done for all realisations, each step with its reason."""
        return steps_of(self.quantity, self.problem, self.method)

    @cached_property
    def tension(self) -> ExpectedTension | None:
        """How many contacts of a packing are expected to pull.

        None where no theory says so: it knows drawn radii of packings wider than high, under
        surface and bulk loads, of spheres straight down, whose contacts may pull.
        """
        load, problem = self.scene.load, self.problem
        known = self.scene.effects.contacts == "bilateral" and self.quantity.needs_forces
        if not known or problem.width is None or not has_theory(problem):
            return None
        phi, std = float(1 - 2 * problem.n_x**2), float(problem.radii.relative_std())
        if problem.dimension > 2:
            return expected_tension_of_spheres(problem.height, problem.width, phi, std, load.kind)
        plus, minus = map(float, problem.load.strength(problem.n_x, FLOAT64).unit)
        return expected_tension(problem.height, problem.width, phi, std, load.kind, (plus, minus))

    @cached_property
    def critical_height(self) -> float:
        """M*, where contacts begin to pull; infinite where radii are equal."""
        return critical_height(self.problem.radii.relative_std())

    @property
    def notes(self) -> list[str]:
        """What should be known before an answer is used."""
        notes = []
        problem = self.problem
        if self.tension is not None and self.tension.typical:
            contacts = problem.dimension * (problem.width or 0) * problem.height
            notes.append(
                f"a typical packing of this scene has tension: about {self.tension.contacts:.2g} "
                f"of its {contacts} contacts pull; at "
                f"this width one does from a height of about {self.tension.height_of_one} on"
            )
        angle = self.scene.load.angle_deg
        if abs(angle) > 90:
            notes.append(
                f"load.angle_deg = {short(angle)} is counted from straight down: beyond 90 the "
                "load pulls upwards, and contacts bear tension"
            )
        radii = problem.radii
        spread = radii.relative_std()
        if isinstance(radii, MeasuredRadii | ArrayRadii) and abs(radii.mean) > float(spread) / 2:
            notes.append(
                f"the mean of the given radii differs from packing.radius by {radii.mean:.3g} r: "
                f"changes, σ/r = {short(spread)} and M* are about packing.radius"
            )
        highest = self.critical_height
        if self.tension is None and self.quantity.needs_forces and problem.height > highest:
            notes.append(
                f"the height M = {problem.height} is above M* = {highest:.3g}, where forces "
                "scatter as widely as they are large: many contacts may pull"
            )
        return notes

    def data(self) -> dict[str, Any]:
        """Give what JSON can hold of it; seconds of steps are not known before it runs."""
        tension = self.tension
        expected = None
        if tension is not None:
            contacts = float(f"{tension.contacts:.3g}")
            expected = {"expected_contacts": contacts, "height_of_one": tension.height_of_one}
        return {
            "plan": [asdict(step) | {"seconds": None} for step in self.steps],
            "skipped": [asdict(skipped) for skipped in self.skipped],
            "memory_bytes": self.memory,
            "sees_images": self.sees_images,
            "tension": expected,
            "notes": self.notes,
            "choice": None if self.choice is None else self.choice.data(),
        }

    def __str__(self) -> str:
        """Say what would be done, what is left out, and why."""
        return "\n".join([*plan_lines(self.data()), *map("Note: {}".format, self.notes)])

    __repr__ = __str__


def steps_of(quantity: Quantity, problem: Problem, method: Method) -> tuple[Step, ...]:
    """List what is done for all realisations."""
    name, n = method.system.name, problem.realisations
    if problem.route == Route.ORDERED:
        return (Step("closed form", "the ordered packing is known: nothing is swept", 0, name),)
    source = "draw radii" if isinstance(problem.radii, DrawnRadii) else "read radii"
    if problem.route == Route.LINE_SUMS:
        beads = n * quantity.line_beads(problem.load)
        steps = [
            Step(source, "only the beads on the diagonals that the answer depends on", beads, name),
            Step(
                "line sums", "to first order the answer is a sum down a few diagonals", beads, name
            ),
        ]
    elif problem.route == Route.UNILATERAL:
        beads = n * problem.region.beads
        moves = "linear programs: contacts that pull open, others close"
        steps = [
            Step(source, "every bead may move", beads, name),
            Step("relax", moves, beads, name),
        ]
    else:
        steps = _sweeping(source, problem, method)
    return (*steps, _judging(steps, problem, method))


def _sweeping(source: str, problem: Problem, method: Method) -> list[Step]:
    """List the steps of a sweep."""
    name, n = method.system.name, problem.realisations
    exact, beads = problem.route == Route.EXACT, n * problem.region.beads
    how, done = "line sums", "displacements to first order, layer by layer"
    if exact:
        quick = worth_compiling(problem, method.system) and find_spec("numba") is not None
        done = "exact positions, as deviations in line-sum coordinates"
        how, done = "deposit", f"{done}{', by compiled code' if quick else ''}"
    steps = [Step(source, _why_region(problem), beads, name), Step(how, done, beads, name)]
    if problem.needs_forces:
        visited = n * problem.force_rows[1:].beads
        steps.append(Step("balance forces", _why_forces(problem), visited, name))
    if exact:
        steps.append(Step(PHYSICAL, "gaps, overlaps and signs, always", beads, name))
    return steps


def _judging(steps: list[Step], problem: Problem, method: Method) -> Step:
    """Give the last step, which says how accurate the answer is."""
    name = method.system.name
    if problem.route == Route.UNILATERAL:
        why = "Kantorovich's theorem in balls: beads touch exactly, forces and gaps are positive"
        return Step(CERTIFY, why, 0, name)
    if method.certified:
        why = "balls enclose the answer; bits are added, and all is done again, until it fits"
        return Step(CERTIFY, why, 0, name)
    if method.repeated == problem.realisations:
        return Step(ESTIMATE, "the sweep carried the rounding error of every number along", 0, name)
    visits = sum(step.beads for step in steps if step.step != PHYSICAL) // problem.realisations
    why = "the first realisations again with their rounding errors carried along"
    return Step(ESTIMATE, why, 2 * method.repeated * visits, name)


def _why_region(problem: Problem) -> str:
    if problem.dimension > 2:
        return f"{_WHOLE}, up to the highest load or bead asked for"
    if problem.region.beads == (problem.width or 0) * (problem.height + 1):
        return "the answer depends on every bead"
    return "only the beads that the answer depends on: the triangles below what is asked"


def _why_forces(problem: Problem) -> str:
    if problem.dimension > 2:
        return _WHOLE
    if problem.load.loaded is not None:
        return "only beads in the downward cone of the load carry force"
    if problem.contact is not None:
        return "only beads above the contact decide its force"
    return "every bead passes its load on"


def plan_lines(data: dict[str, Any]) -> list[str]:
    """Say in lines of text what a plan holds, before it runs or afterwards."""
    lines = ["What is done"]
    for step in data["plan"]:
        spent = "" if step["seconds"] is None else f", {step['seconds']:.3g} s"
        cost = f"{step['beads']} beads, {step['arithmetic']}{spent}"
        lines.append(f"  {step['step']}: {step['reason']} ({cost})")
    lines.append("What is left out")
    lines += [f"  {s['effect']}: {s['reason']}" for s in data["skipped"]] or ["  nothing"]
    lines += _choice_lines(data["choice"]) if data["choice"] else []
    lines.append(f"Memory: about {size(data['memory_bytes'])}")
    if data["tension"]:
        expected, one = data["tension"]["expected_contacts"], data["tension"]["height_of_one"]
        low = "at no height allowed" if one is None else f"from a height of about {one} on"
        many = f"About {expected:.2g} contacts are" if expected >= 1e-3 else "No contact is"
        lines.append(f"{many} expected to pull; one does {low}")
    if data["sees_images"]:
        lines.append("The answer sees periodic images: it is that of the strip, not of the slab")
    return lines


def _choice_lines(choice: dict[str, Any]) -> list[str]:
    """Say what was chosen, and from what."""
    chosen = choice["chosen"]
    kind = "certified" if chosen["certified"] else "estimated"
    table = [
        {
            " ": "*" if one == chosen else "",
            "method": one["algorithm"],
            "arithmetic": one["arithmetic"],
            "repeated": one["repeated"] or None,
            "error": one["expected_error"],
            "memory": None if one["memory_bytes"] is None else size(one["memory_bytes"]),
            "": one["out"],
        }
        for one in choice["candidates"]
    ]
    lines = [
        f"How, for a tolerance of {choice['tolerance']}: {chosen['algorithm']}, "
        f"{chosen['arithmetic']}, {kind}",
        f"  {choice['reason']}",
        *(f"  {line}" for line in text_table(table)),
    ]
    for missed in choice.get("missed", []):
        lines.append(
            f"Tried before: {missed['algorithm']}, {missed['arithmetic']}: {missed['why']}"
        )
    return lines
