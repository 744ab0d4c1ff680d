"""From a scene to what is measured of its ensemble: what has statistics, and where bins lie."""

from dataclasses import replace
from fractions import Fraction

from ..mechanics.problem import Route
from ..planning.planner import plan
from ..scene.scene import Scene
from ..scene.sections import SceneError
from .measure import Measurement

DEFAULT_BINS = 60
# Outer edges of a histogram, in units of the largest theoretical σ_f.
REACH = 6
# Variables of a covariance matrix, whose numbers grow with their square.
MOST_VARIABLES = 2048
KNOWN = ("profile", "contact", "contact_forces", "response", "histogram")


def measurement(
    scene: Scene, *, covariance: bool = False, reach: float | None = None
) -> Measurement:
    """Say what is measured of an ensemble of a scene's packings.

    ``reach`` is the outer edge of a histogram, in units of force; by default six times the largest
    theoretical σ_f. Raises ``SceneError`` for what has no statistics over an ensemble.
    """
    ask = scene.ask
    if ask.quantity not in KNOWN:
        raise SceneError("ask.quantity", ask.quantity, f"an ensemble is of {_either(KNOWN)}")
    if scene.effects.stop_at_tension:
        raise SceneError("effects.stop_at_tension", True, "an ensemble needs whole packings")
    if ask.tolerance is not None:
        raise SceneError(
            "ask.tolerance", ask.tolerance, "an ensemble is solved in float64: leave it out"
        )
    if scene.disorder is None or scene.disorder.kind == "file":
        raise SceneError("disorder", None, "an ensemble needs radii that are drawn")
    one = scene.model_copy(update={"ask": ask.model_copy(update={"realisations": 1})})
    planned = plan(one)
    if planned.problem.route == Route.ORDERED:
        why = planned.skipped[-1].reason
        raise SceneError("disorder", None, f"every realisation would be the same: {why}")
    made = Measurement(planned, (), covariance)
    if ask.quantity == "histogram":
        made = replace(made, edges=_edges(made, reach))
    elif reach is not None:
        raise SceneError("ask.quantity", ask.quantity, 'only a "histogram" has bins that reach')
    if made.variables > MOST_VARIABLES:
        raise SceneError(
            "ask.quantity",
            ask.quantity,
            f"the covariance of {made.variables} variables is too large, and {MOST_VARIABLES} "
            "are allowed: ask for a smaller packing, or leave the covariance out",
        )
    return made


def _edges(made: Measurement, reach: float | None) -> tuple[float, ...]:
    """Edges that are fixed before anything is drawn, symmetric about no change at all."""
    if reach is None:
        theory = made.theory()
        if theory is None:
            raise SceneError(
                "ask.quantity",
                "histogram",
                "no theory says how wide it will be here: give --reach, the outer edge of the "
                "bins in units of force",
            )
        if made.problem.contact is not None:
            theory = [theory[made.problem.contact.j]]
        reach = float(REACH * max(theory))
    if not 0 < reach < 1e300:
        raise SceneError("--reach", None, "must be a positive number below 1e300")
    bins = made.plan.scene.ask.bins or DEFAULT_BINS
    edges = tuple(float(Fraction(reach) * Fraction(2 * k - bins, bins)) for k in range(bins + 1))
    if len(set(edges)) <= bins:
        raise SceneError("ask.bins", bins, "are more than float64 can tell apart here")
    return edges


def _either(words: tuple[str, ...]) -> str:
    quoted = [f'"{word}"' for word in words]
    return ", ".join(quoted[:-1]) + f" or {quoted[-1]}"
