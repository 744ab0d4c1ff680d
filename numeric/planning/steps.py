"""The steps of a plan, each with its reason."""

from dataclasses import replace
from importlib.util import find_spec

from ..disorder.radii import DrawnRadii
from ..mechanics.engine import worth_compiling
from ..mechanics.physicality import PHYSICAL
from ..mechanics.problem import Problem, Route
from ..mechanics.work import ESTIMATE
from ..quantities.base import Quantity
from .plan import CERTIFY, Method, Step

# How plans call the way to the numbers.
ALGORITHMS = {
    Route.ORDERED: "closed form",
    Route.LINE_SUMS: "line sums",
    Route.FIRST_ORDER: "first-order sweep",
    Route.EXACT: "exact sweep in deviation form",
    Route.UNILATERAL: "beads move until no contact pulls",
}
_WHOLE = "spheres are always swept in whole layers"


def steps_of(quantity: Quantity, problem: Problem, method: Method) -> tuple[Step, ...]:
    """List what is done for all realisations."""
    n, arithmetic = problem.realisations, method.system.name
    one = _solving(quantity, problem, method)
    steps = [replace(step, beads=step.beads * n, arithmetic=arithmetic) for step in one]
    if problem.route != Route.ORDERED:
        steps.append(_judging(one, problem, method))
    return tuple(steps)


def _solving(quantity: Quantity, problem: Problem, method: Method) -> list[Step]:
    """List the steps of one realisation."""
    if problem.route == Route.ORDERED:
        return [Step("closed form", "the ordered packing is known: nothing is swept", 0)]
    source = "draw radii" if isinstance(problem.radii, DrawnRadii) else "read radii"
    if problem.route == Route.LINE_SUMS:
        beads = quantity.line_beads(problem.load)
        return [
            Step(source, "only the beads on the diagonals that the answer depends on", beads),
            Step("line sums", "to first order the answer is a sum down a few diagonals", beads),
        ]
    if problem.route == Route.UNILATERAL:
        beads, why = problem.region.beads, "every bead may move"
        return [
            Step(source, why, beads),
            Step("relax", f"{problem.protocol}: contacts that pull open, others close", beads),
        ]
    beads, exact = problem.region.beads, problem.route == Route.EXACT
    steps = [Step(source, _why_region(problem), beads)]
    if exact:
        quick = worth_compiling(problem, method.system) and find_spec("numba") is not None
        by = ", by compiled code" if quick else ""
        why = f"exact positions, as deviations in line-sum coordinates{by}"
        steps.append(Step("deposit", why, beads))
    else:
        steps.append(Step("line sums", "displacements to first order, layer by layer", beads))
    if problem.needs_forces:
        visited = problem.force_rows[1:].beads
        steps.append(Step("balance forces", _why_forces(problem), visited))
    if exact:
        steps.append(Step(PHYSICAL, "gaps, overlaps and signs, always", beads))
    return steps


def _judging(one: list[Step], problem: Problem, method: Method) -> Step:
    """Give the last step, which says how accurate the answer is."""
    if problem.route == Route.UNILATERAL:
        why = "Kantorovich's theorem in balls: beads touch exactly, forces and gaps are positive"
        return Step(CERTIFY, why, 0, method.system.name)
    if method.longer is None:
        why = "balls enclose the answer; bits are added, and all is done again, until it fits"
        return Step(CERTIFY, why, 0, method.system.name)
    if method.carries and method.repeated == problem.realisations:
        why = "the sweep carried the rounding error of every number along"
        return Step(ESTIMATE, why, 0, method.system.name)
    passes = 1 if method.repeated == problem.realisations else 2
    visits = sum(step.beads for step in one if step.step != PHYSICAL)
    longer = method.longer.name
    again = "their rounding errors carried along" if method.carries else "a longer significand"
    return Step(
        ESTIMATE,
        f"the first realisations again with {again}",
        passes * method.repeated * visits,
        longer
        if passes == 1
        else method.system.name
        if method.carries
        else f"{method.system.name}, then {longer}",
    )


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
