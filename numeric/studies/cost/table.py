"""The result of a study of cost: a row a way, arrays, plain data, the table for a terminal."""

from dataclasses import asdict, dataclass
from decimal import ROUND_CEILING, Context, Decimal
from functools import cached_property
from typing import TYPE_CHECKING, Any

from ... import tables
from ...arithmetic.systems import Array
from ...figures.library import drawing
from ...planning.plan import Skipped
from .rows import Reference, Way

if TYPE_CHECKING:
    from matplotlib.figure import Figure

MEMORY = (
    "tracemalloc: what Python and NumPy allocate; with big numbers a lower bound (≥), since their "
    "limbs are allocated elsewhere"
)
SHOWN = (
    "way", "arithmetic", "realisations", "error", "model_error", "rounding_error",
    "sampling_error", "certified_bound", "seconds", "seconds_min", "seconds_max", "runs",
)  # fmt: skip


@dataclass(frozen=True)
class CostStudy:
    """All ways to one answer, from the largest measured error to the smallest.

    ``ways`` are measurements, ``reference`` is what errors are measured against, ``skipped`` says
    which ways do not apply, and why. ``sampling_floor`` is the standard error of the scene's
    ensemble, relative to the largest |change|; None where no ensemble is asked for.
    """

    quantity: str
    reference: Reference
    ways: tuple[Way, ...]
    skipped: tuple[Skipped, ...]
    sampling_floor: Decimal | None = None

    def rows(self) -> list[tables.Row]:
        """One row a way, ready for a data frame; the columns are those of ``Way``.

        Errors are relative to the largest |change|; below 1e-323 they read 0 (``data`` has their
        decimals). None: does not apply.
        """
        return [tables.plain(asdict(way)) for way in self.ways]

    @cached_property
    def arrays(self) -> dict[str, Array]:
        """The columns of ``rows``, each of shape (ways,); NaN where a number does not apply."""
        return tables.columns_of(self.rows())

    def data(self) -> dict[str, Any]:
        """Give it as JSON can hold it; errors are decimal strings, smaller than floats may be."""
        return {
            "quantity": self.quantity,
            "errors_relative_to": "the largest |change| of the answer",
            "reference": _plain(asdict(self.reference)),
            "sampling_floor": _number(self.sampling_floor),
            "peak_memory": MEMORY,
            "rows": [_plain(asdict(way)) for way in self.ways],
            "skipped": [{"way": s.effect, "reason": s.reason} for s in self.skipped],
        }

    def plot(self, title: str = "") -> "Figure":
        """Draw error against time, both logarithmic, with the Pareto front named.

        Needs matplotlib (the extra ``plots``). Raises ``MissingLibraryError``.
        """
        with drawing():
            from .cost_plot import draw

            name = f"{title}: {self.quantity}" if title else self.quantity
            return draw(name, self.ways, self.reference, self.sampling_floor)

    def __str__(self) -> str:
        """Give the table; * marks the Pareto front."""
        return "\n".join(_lines(self.data()))

    def _repr_html_(self) -> str:
        """Show the table in a notebook."""
        shown = "way", "arithmetic", "realisations", "error", "certified_bound", "seconds", "pareto"
        rows = [{name: row[name] for name in shown} for row in self.data()["rows"]]
        *_, reference = (line for line in str(self).splitlines() if line.startswith("Reference"))
        return tables.html_table(rows, [reference])


def _plain(values: dict[str, Any]) -> dict[str, Any]:
    return {name: _number(value) for name, value in values.items()}


def _number(value: Any) -> Any:
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


def csv_rows(data: dict[str, Any], command: str) -> list[dict[str, Any]]:
    """Give the rows for a CSV file; each ends with the reference and the command behind it."""
    reference = data["reference"]
    common = {
        "quantity": data["quantity"],
        "reference": reference["kind"],
        "reference_radius": reference["radius"],
        "sampling_floor": data["sampling_floor"],
        "command": command,
    }
    return [{**row, **common} for row in data["rows"]]


def _shown(row: dict[str, Any]) -> tables.Row:
    """Give what text shows of a row."""
    kilobytes = f"{row['peak_bytes'] / 1e3:.0f}"
    return {
        " ": "*" if row["pareto"] else " ",
        **{name: row[name] for name in SHOWN},
        "peak_kB": f"≥{kilobytes}" if row["peak_is_bound"] else kilobytes,
    }


def _lines(data: dict[str, Any]) -> list[str]:
    result = [
        f"Ways to '{data['quantity']}', measured errors relative to the largest |change|; "
        "* Pareto front of measured error and least time",
        *tables.text_table([_shown(row) for row in data["rows"]]),
    ]
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
