"""What stability costs: the three tables of measurements, as arrays, plain data and text."""

from collections.abc import Callable, Collection, Iterator
from dataclasses import asdict, dataclass
from functools import cached_property
from typing import Any

from ... import tables
from ...arithmetic.errors import ForceDiffusionError
from ...arithmetic.systems import Array
from ...figures.specification import Picture
from ..study import Study
from .closed import ClosedFormRow, closed_form_rows
from .enclosures import DIGITS, Enclosure, enclose, strips
from .floats import Comparison, cases, measure
from .stability_plot import picture

Measured = Comparison | Enclosure | ClosedFormRow
FLOATS, ENCLOSURES, CLOSED_FORMS = "rows", "enclosures", "closed_forms"


@dataclass(frozen=True)
class _Table:
    """A table: its file, what it is of, what measures its rows, and those that text shows."""

    file: str
    title: str
    measured: Callable[[], Iterator[Measured]]
    shown: Callable[[list[tables.Row]], list[tables.Row]] = lambda rows: rows


def _worst(rows: list[tables.Row]) -> list[tables.Row]:
    """Give the row with the largest error of each form and height."""
    groups: dict[tuple[str, int], list[tables.Row]] = {}
    for row in rows:
        groups.setdefault((row["form"], row["height"]), []).append(row)
    return [max(group, key=lambda row: float(row["relative_error"])) for group in groups.values()]


TABLES = {
    FLOATS: _Table(
        "stability.csv",
        "Deviation form in float64, the plain form beside it (plain_…), and balls; errors of "
        "change relative to the largest, against an enclosure of all contact forces.",
        lambda: map(measure, cases()),
    ),
    ENCLOSURES: _Table(
        "stability_balls.csv",
        f"Balls in positions and in line-sum coordinates, at the precision that leaves {DIGITS} "
        "digits.",
        lambda: map(enclose, strips()),
    ),
    CLOSED_FORMS: _Table(
        "closed_forms.csv",
        "Closed forms of Eqs. 13 and 14 in float64, against exact rationals: largest errors.",
        closed_form_rows,
        _worst,
    ),
}


@dataclass(frozen=True)
class StabilityStudy(Study):
    """Three tables of measurements, by name.

    "rows": both forms in float64 against enclosures of all contact forces (``floats.Comparison``).
    "enclosures": bits that balls lose, in positions and in line sums (``enclosures.Enclosure``).
    "closed_forms": Eqs. 13 and 14 in float64 against exact rationals (``closed.ClosedFormRow``).
    Errors are relative to the largest |change| of a contact force.
    """

    measured: dict[str, tuple[Measured, ...]]
    name = "stability"

    def rows(self, table: str = FLOATS) -> list[tables.Row]:
        """The rows of one table, ready for a data frame; None: there is no such number."""
        return [asdict(row) for row in self.measured[table]]

    @cached_property
    def arrays(self) -> dict[str, dict[str, Array]]:  # type: ignore[override]  # of three tables
        """The columns of each table, each of shape (rows,); NaN where there is no number."""
        return {table: tables.columns_of(self.rows(table)) for table in self.measured}

    def data(self) -> dict[str, Any]:
        """Give all tables as JSON can hold them."""
        found = {table: self.rows(table) for table in self.measured}
        return {"errors_relative_to": "the largest |change|", **found}

    def files(self) -> dict[str, list[tables.Row]]:
        """Give the rows of each CSV file by its name."""
        return {TABLES[table].file: self.rows(table) for table in self.measured}

    def picture(self) -> Picture:
        """Say what is drawn: errors and lost bits, and the times they cost.

        Raises ``ForceDiffusionError`` where the first two tables were not measured.
        """
        if not {FLOATS, ENCLOSURES} <= set(self.measured):
            raise ForceDiffusionError(f'the figure needs the tables "{FLOATS}" and "{ENCLOSURES}"')
        return picture(self.rows(FLOATS), self.rows(ENCLOSURES))

    def __str__(self) -> str:
        """Give the tables."""
        return "\n\n".join(
            "\n".join([TABLES[name].title, *tables.text_table(TABLES[name].shown(self.rows(name)))])
            for name in self.measured
        )

    def _repr_html_(self) -> str:
        """Show the tables in a notebook."""
        return "".join(
            tables.html_table(self.rows(table), [TABLES[table].title]) for table in self.measured
        )


def stability(
    notice: Callable[[str], None] = lambda _: None, *, only: Collection[str] = tuple(TABLES)
) -> StabilityStudy:
    """Measure what stability costs: errors, lost bits and times with and without it.

    Takes about a minute; ``only`` names the tables to be measured. ``notice`` is told of
    every row that is measured. Raises ``ForceDiffusionError`` for a table that there is not.

    >>> import force_diffusion as fd
    >>> found = fd.stability(only=["closed_forms"])
    >>> bool(found.arrays["closed_forms"]["relative_error"].max() < 1e-14)
    True
    """
    if not callable(notice):
        told = f"stability takes a function that is told words, not {type(notice).__name__}"
        raise TypeError(told)
    for name in only:
        if name not in TABLES:
            raise ForceDiffusionError(f'there is no table "{name}"; there are {", ".join(TABLES)}')
    found: dict[str, tuple[Measured, ...]] = {}
    for name in (name for name in TABLES if name in only):
        rows = []
        for row in TABLES[name].measured():
            rows.append(row)
            notice(f"{TABLES[name].file}: row {len(rows)}")
        found[name] = tuple(rows)
    return StabilityStudy(found)
