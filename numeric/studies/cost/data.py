"""Studies of cost as plain data: what ``cost --json`` prints, and the table for a terminal."""

from dataclasses import asdict
from decimal import ROUND_CEILING, Context, Decimal
from typing import Any

from .rows import Row, Study

MEMORY = (
    "tracemalloc: what Python and NumPy allocate; with big numbers a lower bound (≥), since their "
    "limbs are allocated elsewhere"
)
ERRORS = "model_error", "rounding_error", "sampling_error"


def study_data(study: Study, command: str) -> dict[str, Any]:
    """Give a study as JSON can hold it; errors are decimal strings, smaller than floats may be."""
    return {
        "command": command,
        "quantity": study.quantity,
        "errors_relative_to": "the largest |change| of the answer",
        "reference": {k: _plain(v) for k, v in asdict(study.reference).items()},
        "sampling_floor": _plain(study.sampling_floor),
        "peak_memory": MEMORY,
        "rows": [_row(row) for row in study.rows],
        "skipped": [{"way": s.effect, "reason": s.reason} for s in study.skipped],
    }


def _row(row: Row) -> dict[str, Any]:
    return {k: _plain(v) for k, v in asdict(row).items()}


def _plain(value: Any) -> Any:
    if isinstance(value, Decimal):
        return short(value)
    return float(f"{value:.4g}") if isinstance(value, float) else value


def short(value: Decimal) -> str:
    """Print an error to three digits, rounded up.

    >>> short(Decimal("1.23456E-337")), short(Decimal(0))
    ('1.24e-337', '0')
    """
    up = Context(prec=3, rounding=ROUND_CEILING).create_decimal(value)
    return f"{up:.2e}" if value else "0"


def csv_rows(data: dict[str, Any]) -> list[dict[str, Any]]:
    """Give the rows for a CSV file; each ends with the reference and the command behind it."""
    reference = data["reference"]
    common = {
        "quantity": data["quantity"],
        "reference": reference["kind"],
        "reference_radius": reference["radius"],
        "sampling_floor": data["sampling_floor"],
        "command": data["command"],
    }
    return [{**row, **common} for row in data["rows"]]


def lines(data: dict[str, Any]) -> list[str]:
    """Give the table for a terminal; * marks the Pareto front."""
    result = [
        f"Ways to '{data['quantity']}', measured errors relative to the largest |change|; "
        "* Pareto front of measured error and median time",
        f"{'':2}{'way':<27}{'arithmetic':<20}{'N':>6} {'error':>9} {'model':>9} {'rounding':>9} "
        f"{'sampling':>9} {'bound':>9}  {'median s':>9} {'min … max s':>19} "
        f"{'runs':>4} {'peak kB':>9}",
    ]
    for row in data["rows"]:
        parts = [row["error"], *(row[k] for k in ERRORS), row["certified_bound"]]
        shown = " ".join(f"{'' if part is None else part:>9}" for part in parts)
        spread = f"{row['seconds_min']:.2e} … {row['seconds_max']:.2e}"
        result.append(
            f"{'* ' if row['pareto'] else '  '}{row['way']:<27}{row['arithmetic']:<20}"
            f"{row['realisations'] or '':>6} {shown}  {row['seconds']:9.2e} {spread:>19} "
            f"{row['runs']:>4} {'≥' if row['peak_is_bound'] else '':>2}"
            f"{row['peak_bytes'] / 1e3:>7.0f}"
        )
    reference = data["reference"]
    result.append(
        f"Reference: {reference['what']}, {reference['kind']}, radius {reference['radius']} "
        f"({reference['arithmetic']})"
    )
    if data["sampling_floor"] is not None:
        result.append(f"Standard error of the scene's own ensemble: {data['sampling_floor']}")
    result.append(f"Peak memory by {data['peak_memory']}")
    result.append("Does not apply")
    result += [f"  {s['way']}: {s['reason']}" for s in data["skipped"]] or ["  nothing"]
    return result
