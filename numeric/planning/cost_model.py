"""The cost model: predicted seconds are coefficients times work, step by step.

The work of a pass over a packing is counted from its plan: calls (layers times chunks, what NumPy
and the interpreter take whatever the layer holds), beads, and for numbers of any precision beads
times their kilobits and times the square of these. The coefficients belong to a family of number
systems and are fitted to a calibration (``calibrating``); without one, the defaults hold,
which were fitted on another machine.
"""

import importlib.util
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

from force_diffusion.numeric.arithmetic.systems import FLOAT64, LONGDOUBLE, Balls, NumberSystem
from force_diffusion.numeric.disorder.radii import MeasuredRadii
from force_diffusion.numeric.planning import budget
from pydantic import BaseModel, ConfigDict, Field

if TYPE_CHECKING:
    from force_diffusion.numeric.planning.plan import Plan

Work = dict[str, dict[str, float]]
"""Amounts of work by step and term."""

TERMS = ("once", "calls", "beads", "limbs", "limbs2")
DEFAULTS_FILE = Path(__file__).with_name("default_costs.json")


class Fitted(BaseModel):
    """Coefficients of a step, in seconds for a unit of each term, and how well they fit.

    ``misfit``: the largest factor between a fitted and a measured time in the calibration.
    """

    model_config = ConfigDict(extra="forbid", frozen=True)

    seconds: dict[str, float] = Field(default_factory=dict)
    misfit: float = Field(ge=1)


class Model(BaseModel):
    """All coefficients, by family of number systems and step; ``source`` says where they are from.

    ``load_seconds``: what loading the compiled sweeps takes.
    """

    model_config = ConfigDict(extra="forbid", frozen=True)

    source: str
    load_seconds: float = Field(ge=0)
    families: dict[str, dict[str, Fitted]]

    def seconds(self, family: str, work: Work) -> float:
        """Predict the seconds of some work."""
        steps = self.families[family]
        return sum(
            steps[step].seconds.get(term, 0.0) * amount
            for step, terms in work.items()
            if step in steps
            for term, amount in terms.items()
        )


@cache
def defaults() -> Model:
    """Give the coefficients for a machine that has not been calibrated."""
    return Model.model_validate_json(DEFAULTS_FILE.read_text(encoding="utf-8"))


def compiled(plan: "Plan", system: NumberSystem, realisations: int) -> bool:
    """Say whether the engine will take its compiled sweeps."""
    from force_diffusion.numeric.mechanics.engine import (
        COMPILED_FROM,  # which knows plans, and these their cost
    )

    much = plan.region.beads * realisations >= COMPILED_FROM
    exact = system is FLOAT64 and plan.route == "exact" and not plan.scene.effects.stop_at_tension
    whole = plan.scene.packing.width is not None and not plan.single_contact
    return much and exact and whole and importlib.util.find_spec("numba") is not None


def family(plan: "Plan", system: NumberSystem, realisations: int) -> str:
    """Name the family of number systems whose coefficients hold."""
    if isinstance(system, Balls):
        return "balls"
    if system is FLOAT64:
        return "compiled" if compiled(plan, system, realisations) else "float64"
    return "longdouble" if system is LONGDOUBLE else "mpmath"


def _amounts(system: NumberSystem, calls: float, beads: float, once: float = 0) -> dict[str, float]:
    size = system.bits / 1000 if system.dtype is object else 0
    return {
        "once": once, "calls": calls, "beads": beads, "limbs": beads * size,
        "limbs2": beads * size**2,
    }  # fmt: skip


def pass_work(plan: "Plan", system: NumberSystem, realisations: int, *, again: bool) -> Work:
    """Count the work of solving and gathering some realisations; ``again`` looks at no gaps."""
    n, beads = realisations, plan.region.beads
    rows = numbers(plan, n)
    layers = len(plan.region.rows)
    work: Work = {}
    if plan.route == "ordered":
        work[gathering(plan)] = _amounts(system, layers, rows, 1)
        return work
    if plan.route == "line sums":
        read = line_beads(plan)
        work["radii of lines"] = _amounts(system, n, read * n)
        work["line sums of one"] = _amounts(system, n, read * n)
        work[gathering(plan)] = _amounts(system, n, rows, 1)
        return work
    chunks = -(-n // budget.chunk_size(plan.region, system, plan.scene))
    radii = "listed radii" if isinstance(plan.radii, MeasuredRadii) else "radii"
    work[radii] = _amounts(system, layers * n, beads * n, 1)
    exact = plan.route == "exact"
    form = "plain " if plan.way.plain else ""
    work[f"{form}deposit" if exact else "line sums"] = _amounts(system, layers * chunks, beads * n)
    if plan.needs_forces:
        held = sum(layer.count for layer in plan.force_rows[1:])
        step = f"{form}balance forces" if exact else "balance to first order"
        work[step] = _amounts(system, len(plan.force_rows) * chunks, held * n)
    if exact and not again:
        work["check"] = _amounts(system, layers * chunks, beads * n)
    gather = gathering(plan)
    if gather == "average":
        work[gather] = _amounts(system, layers * chunks, beads * n, 1)
    else:
        if plan.scene.ask.quantity == "response":
            rows *= n
        work[gather] = _amounts(system, (1 if plan.single_contact else layers) * n, rows, 1)
    return work


def gathering(plan: "Plan") -> str:
    """Name the step that gathers an answer: each quantity has its own way."""
    quantity = plan.scene.ask.quantity
    if plan.single_contact:
        return "gather one"
    return {
        "profile": "average",
        "positions": "gather positions",
        "histogram": "gather changes",
    }.get(quantity, "gather")


def numbers(plan: "Plan", realisations: int) -> int:
    """Count the rows of the answer (of a histogram, the changes that it counts)."""
    scene, n = plan.scene, realisations
    quantity, width = scene.ask.quantity, scene.packing.width
    if quantity == "profile":
        return 2 * scene.packing.height
    if plan.single_contact or (quantity == "positions" and scene.ask.at is not None):
        return n
    if quantity == "positions":
        return n * plan.region.beads
    if quantity == "base_reactions":
        return n * (width or (plan.force_rows[0].count if plan.force_rows else 1))
    if quantity == "contact_forces" and width is not None:
        return n * 2 * width * scene.packing.height
    held = 2 * sum(layer.count for layer in plan.force_rows[1:])
    return held if quantity == "response" else n * held


def line_beads(plan: "Plan") -> int:
    """Count the beads that the line sums of one realisation read."""
    return next(s.beads for s in plan.steps if s.step == "line sums") // plan.realisations


def last_work(plan: "Plan", system: NumberSystem, repeated: int) -> Work:
    """Count what follows the passes: comparing or certifying, counting into bins or printing."""
    rows = numbers(plan, plan.realisations)
    work: Work = {
        "certify": _amounts(system, 0, rows, 1),
        "compare": _amounts(system, 0, numbers(plan, repeated), 1),
    }
    if plan.scene.ask.quantity == "histogram":
        work["bins"] = _amounts(system, plan.scene.ask.bins or budget.DEFAULT_BINS, rows, 1)
    else:
        work["print"] = _amounts(system, 0, rows, 1)
    return work


def predicted(plan: "Plan", model: Model) -> float:
    """Predict the seconds of a plan: its own pass, what is repeated, what is judged and printed."""
    way, n = plan.way, plan.realisations
    own = family(plan, way.system, n)
    spent = model.load_seconds if own == "compiled" else 0.0
    spent += model.seconds(own, pass_work(plan, way.system, n, again=False))
    last = last_work(plan, way.system, way.repeated)
    if way.longer is None:
        del last["compare"]
        return spent + model.seconds(own, last)
    systems = [way.longer] if way.repeated == n else [way.system, way.longer]
    for system in systems:
        again = pass_work(plan, system, way.repeated, again=True)
        spent += model.seconds(family(plan, system, way.repeated), again)
    compare = {"compare": _amounts(way.longer, 0, numbers(plan, way.repeated), 1)}
    longer = family(plan, way.longer, way.repeated)
    del last["certify"], last["compare"]
    return spent + model.seconds(own, last) + model.seconds(longer, compare)
