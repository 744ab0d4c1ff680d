"""The result of an ensemble as plain data: no time and no worker in it, so that it is the same.

Numbers are the shortest decimals that stand for the float64.
"""

import math
from fractions import Fraction
from typing import Any

from .estimates import root
from .run import Result


def result_data(result: Result) -> dict[str, Any]:
    """Give a finished ensemble; the guide says what each key means."""
    estimates = result.estimates
    m = estimates.measurement
    data: dict[str, Any] = {
        "ensemble": {
            "realisations": estimates.realisations,
            "contacts_in_a_group": m.members,
            "arithmetic": "float64, summed exactly",
        },
        "skipped": [{"effect": s.effect, "reason": s.reason} for s in m.plan.skipped],
        "results": {m.quantity: bins(result) if m.edges else rows(result)},
        "confidence": {
            "level": result.confidence,
            "largest_relative_half_width": _finite(result.half_width),
            "looks": result.look,
            "reached": result.reached,
        },
    }
    if m.edges:  # of all that was counted
        data["statistics"] = rows(result)[0]
    if m.covariance and estimates.realisations > 1:
        of = "mean square change of a packing" if m.squares else "change"
        data["covariance"] = {
            "of": of,
            "labels": m.labels,
            "matrix": estimates.covariance().tolist(),
        }
    return data


def rows(result: Result) -> list[dict[str, Any]]:
    """One row a group."""
    estimates = result.estimates
    m = estimates.measurement
    ordered = m.ordered()
    theory = m.theory() if "component" not in m.labels else None
    layers = m.labels.get("j")
    found = []
    for g in range(m.groups):
        row = {name: column[g] for name, column in m.labels.items()}
        row["samples"] = estimates.samples
        row["mean"] = _text(float(ordered[g] + estimates.mean[g]))
        row["mean_change"] = _text(float(estimates.mean[g]))
        row["mean_change_error"] = _text(estimates.mean_error[g])
        row["std"] = _text(estimates.std[g])
        row["std_error"] = _text(estimates.std_error[g])
        if theory is not None and layers is not None:
            row["first_order_std"] = f"{float(theory[layers[g]]):.12g}"
        row["tensile"] = int(estimates.sums.tensile[g])
        found.append(row)
    return found


def bins(result: Result) -> list[dict[str, Any]]:
    """One row a bin, first and last what lies outside; ``share_error`` from the scatter."""
    estimates = result.estimates
    m, N = estimates.measurement, estimates.realisations
    edges = ["-inf", *(_text(edge) for edge in m.edges), "inf"]
    counts, squares = estimates.sums.bins.tolist()
    found = []
    for k, (count, square) in enumerate(zip(counts, squares, strict=True)):
        error = None
        if N > 1:  # of the share of each packing, over all packings
            scatter = Fraction(N * square - count * count, N * (N - 1))
            error = float(root(scatter / N) / m.members)
        found.append(
            {
                "low": edges[k],
                "high": edges[k + 1],
                "count": count,
                "share": _text(count / estimates.samples),
                "share_error": _text(error),
            }
        )
    return found


def _text(number: float | None) -> str:
    return "" if number is None else repr(number)


def _finite(number: float) -> float | None:
    return number if math.isfinite(number) else None
