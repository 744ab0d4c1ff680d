"""Plans and outcomes as plain data: what ``--json`` prints and what result files hold."""

import math
from dataclasses import asdict
from fractions import Fraction
from typing import Any

from force_diffusion.numeric.arithmetic.decimals import bound_string, short
from force_diffusion.numeric.mechanics.physicality import Physicality
from force_diffusion.numeric.planning.plan import Candidate, Choice, Plan
from force_diffusion.numeric.run import Outcome
from force_diffusion.numeric.theory.critical_height import critical_height


def plan_data(plan: Plan) -> dict[str, Any]:
    """Give a plan before it runs; seconds are not known yet."""
    return {
        "plan": [
            {
                "step": step.step,
                "reason": step.reason,
                "beads": step.beads,
                "arithmetic": step.arithmetic,
                "seconds": None,
            }
            for step in plan.steps
        ],
        "skipped": [{"effect": s.effect, "reason": s.reason} for s in plan.skipped],
        "memory_bytes": plan.memory,
        "estimated_seconds": float(f"{plan.estimated_seconds:.3g}"),
        "sees_images": plan.sees_images,
        "choice": None if plan.choice is None else choice_data(plan.choice),
    }


def choice_data(choice: Choice) -> dict[str, Any]:
    """Give what a tolerance was weighed for; the chosen way is the first of the candidates."""

    def shown(way: Candidate) -> dict[str, Any]:
        return {
            "algorithm": way.algorithm,
            "arithmetic": way.arithmetic,
            "certified": way.certified,
            "repeated": way.repeated,
            "expected_error": bound_string(way.error),
            "seconds": None if way.seconds is None else float(f"{way.seconds:.3g}"),
            "out": way.out,
        }

    def digit(way: Candidate | None, tolerance: Fraction) -> dict[str, Any] | None:
        return None if way is None else {"tolerance": short(tolerance), **shown(way)}

    ways = [shown(way) for way in choice.candidates]
    return {
        "tolerance": short(choice.tolerance),
        "reason": choice.reason,
        "coefficients": choice.coefficients,
        "chosen": ways[0],
        "candidates": ways,
        "digit_more": digit(choice.digit_more, choice.tolerance / 10),
        "digit_less": digit(choice.digit_less, choice.tolerance * 10),
    }


def outcome_data(outcome: Outcome) -> dict[str, Any]:
    """Give a finished run; see scenes/README.md for the schema of each quantity."""
    data = plan_data(outcome.plan)
    work = outcome.work
    visited = {
        "read radii": work.radii,
        "draw radii": work.radii,
        "deposit": work.deposited,
        "line sums": work.summed,
        "balance forces": work.balanced,
        "check that it is physical": work.checked,
        "estimate the error": work.again,
    }
    for step in data["plan"]:
        name = step["step"]
        clock = "radii" if name in {"read radii", "draw radii"} else name
        step["seconds"] = _rounded(work.seconds.get(clock, 0.0))
        names = work.arithmetic_again if name == "estimate the error" else work.arithmetic
        step["arithmetic"] = ", then ".join(names)
        step["beads"] = visited.get(name, 0)
    accuracy = outcome.accuracy
    data["results"] = {outcome.plan.scene.ask.quantity: outcome.rows}
    data["accuracy"] = {
        "error_bound": _bound(accuracy.error_bound),
        "certified": accuracy.certified,
        "arithmetic": accuracy.arithmetic,
        "bits_lost": accuracy.bits_lost,
    }
    if accuracy.note:
        data["accuracy"]["note"] = accuracy.note
    if outcome.physical is not None:
        data["physical"] = physical_data(outcome.physical, outcome.plan)
    if outcome.stopped is not None:
        i, j, branch = outcome.stopped
        data["stopped_at_tension"] = {"i": i, "j": j, "branch": branch}
    data["seconds"] = _rounded(outcome.total_seconds)
    if data["choice"] is not None:
        data["choice"]["missed"] = [asdict(missed) for missed in outcome.missed]
        data["choice"]["measured_seconds"] = _rounded(outcome.total_seconds)
    return data


def physical_data(found: Physicality, plan: Plan) -> dict[str, Any]:
    """Say whether an exact packing is one that beads could make."""
    highest = critical_height(plan.radii.relative_std())
    pulls = found.tensile + found.undecided_signs
    sound = not (found.overlaps or found.undecided_gaps or pulls)
    data: dict[str, Any] = {
        "physical": sound,
        "smallest_gap": found.smallest_gap,
        "smallest_gap_between": None if found.between is None else [list(s) for s in found.between],
        "overlaps": found.overlaps,
        "tensile_contacts": found.tensile if found.forces_known else None,
        "undecided": found.undecided_gaps + found.undecided_signs,
        "contacts": found.contacts if found.forces_known else None,
        "height": plan.scene.packing.height,
        "critical_height": highest if math.isfinite(highest) else None,
    }
    if pulls and plan.load.loaded is not None:
        data["note"] = (
            "loads on single beads pull contacts inside their cones: such a packing stands when "
            "other loads press these contacts more"
        )
    if found.first_tensile is not None:
        i, j, branch = found.first_tensile
        period = plan.scene.packing.width
        home = i if period is None else i % (2 * period)
        data["first_tensile"] = {"i": home, "j": j, "branch": branch}
    return data


def _bound(bound: float | Fraction) -> float | str | None:
    """Give a number where a float can hold it, else a decimal string; None stands for infinity."""
    if isinstance(bound, Fraction):
        return bound_string(bound)
    return bound if math.isfinite(bound) else None


def _rounded(seconds: float | None) -> float | None:
    return None if seconds is None else round(seconds, 6)
