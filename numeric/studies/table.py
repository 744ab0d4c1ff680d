"""The result of a study of cost: a row a way, plain data, the table for a terminal."""

from dataclasses import asdict, dataclass
from decimal import ROUND_CEILING, Context, Decimal
from functools import cached_property
from typing import TYPE_CHECKING, Any

from .. import tables
from ..arithmetic.systems import Array
from ..planning.plan import Skipped
from .rows import Reference, Way

if TYPE_CHECKING:
    from matplotlib.figure import Figure

MEMORY = (
    "tracemalloc: what Python and NumPy allocate; with big numbers a lower bound (≥), since their "
    "limbs are allocated elsewhere"
)
SAMPLED = "Standard error of the scene's own ensemble"


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
        """The columns of ``rows``, each of shape (rows,); NaN where there is no number."""
        return tables.columns_of(self.rows())

    def data(self) -> dict[str, Any]:
        """Give it as JSON can hold it; errors are decimal strings, smaller than floats may be."""
        return {
            "quantity": self.quantity,
            "errors_relative_to": "the largest |change| of the answer",
            "reference": _shortened(asdict(self.reference)),
            "sampling_floor": None if self.sampling_floor is None else short(self.sampling_floor),
            "peak_memory": MEMORY,
            "rows": [_shortened(asdict(way)) for way in self.ways],
            "skipped": [{"way": s.effect, "reason": s.reason} for s in self.skipped],
        }

    def listed(self) -> list[tables.Row]:
        """Give the rows as decimals, each with the reference behind it."""
        data = self.data()
        reference = data["reference"]
        common = {
            "quantity": self.quantity,
            "reference": reference["kind"],
            "reference_radius": reference["radius"],
            "sampling_floor": data["sampling_floor"],
        }
        return [row | common for row in data["rows"]]

    def plot(self, title: str = "") -> "Figure":
        """Draw error against time, both logarithmic, with the Pareto front named.

        Needs matplotlib (the extra ``plots``). Raises ``MissingLibraryError``.
        """
        from ..figures.style import house_style  # first: it says what to install
        from .cost_plot import figure

        name = f"{title}: {self.quantity}" if title else self.quantity
        with house_style():
            return figure(name, self.ways, self.reference, self.sampling_floor)

    def __str__(self) -> str:
        """Give the table; * marks the Pareto front."""
        floor = self.sampling_floor
        return "\n".join(
            [
                f"Ways to '{self.quantity}', measured errors relative to the largest |change|; "
                "* Pareto front of measured error and least time",
                *tables.text_table(list(map(_shown, self.data()["rows"]))),
                self._told(),
                *([] if floor is None else [f"{SAMPLED}: {short(floor)}"]),
                f"Peak memory by {MEMORY}",
                "Does not apply",
                *([f"  {s.effect}: {s.reason}" for s in self.skipped] or ["  nothing"]),
            ]
        )

    def _told(self) -> str:
        own = self.reference
        radius = short(own.radius)
        return f"Reference: {own.what}, {own.kind}, radius {radius} ({own.arithmetic})"

    def _repr_html_(self) -> str:
        """Show the table in a notebook."""
        return tables.html_table(list(map(_shown, self.data()["rows"])), [self._told()])


def _shortened(values: dict[str, Any]) -> dict[str, Any]:
    """Give decimals as strings, and floats to four digits."""

    def shortened(one: Any) -> Any:
        if isinstance(one, Decimal):
            return short(one)
        return float(f"{one:.4g}") if isinstance(one, float) else one

    return {name: shortened(one) for name, one in values.items()}


def short(value: Decimal) -> str:
    """Print an error to three digits, rounded up.

    >>> short(Decimal("1.23456E-337")), short(Decimal(0))
    ('1.24e-337', '0')
    """
    up = Context(prec=3, rounding=ROUND_CEILING).create_decimal(value)
    return f"{up:.2e}" if value else "0"


def _shown(row: tables.Row) -> tables.Row:
    """Give what text shows of a row."""
    *own, peak, bound, best = row
    kilobytes = f"{'≥' * row[bound]}{row[peak] / 1e3:.0f}"
    return {" ": "*" if row[best] else " ", **{n: row[n] for n in own}, "peak_kB": kilobytes}
