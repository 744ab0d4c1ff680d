"""What stability costs: the three tables of measurements, as arrays, plain data and text."""

from collections.abc import Callable, Collection, Iterator
from dataclasses import asdict, dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

from ... import tables
from ...arithmetic.errors import ForceDiffusionError
from ...arithmetic.systems import Array
from ...figures.library import drawing
from .closed import ClosedFormRow, closed_form_rows
from .enclosures import DIGITS, Enclosed, enclose, strips
from .floats import Comparison, cases, measure

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Measured = Comparison | Enclosed | ClosedFormRow
FLOATS, ENCLOSURES, CLOSED_FORMS = "rows", "enclosures", "closed_forms"


def _number(value: float | None, spec: str = "7.1e") -> str:
    width = int(spec.split(".", maxsplit=1)[0])
    return f"{'--':>{width}}" if value is None else f"{value:{spec}}"


def _float_line(row: tables.Row) -> str:
    own, plain = row["seconds"], row["plain_seconds"]
    ratio = own / plain if own and plain else None
    return (
        f"{row['group']:<10}{row['height']:5}{row['width']:5}  {row['relative_std']:8.1e}  "
        f"{row['spacing']:<15} {_number(row['error'])} {_number(own, '8.1e')}s  "
        f"{_number(row['plain_error'], '8.1e')} {_number(plain, '8.1e')}s {_number(ratio, '5.1f')} "
        f"{_number(row['ball_bits_lost'], '7.1f')} of {row['ball_bits']:<4} "
        f"{_number(row['ball_seconds'], '8.1e')}s  {row['tensile']!s:>6} {row['overlaps']!s:>8}"
        f"  {row['note']}"
    ).rstrip()


def _ball_line(row: tables.Row) -> str:
    lost = row["bits_lost"]
    each = None if lost is None else lost / row["height"]
    return (
        f"{row['form']:<10}{row['height']:6}{row['width']:5}  {row['relative_std']:8.1e}  "
        f"{row['critical_height']:8.4g}  {_number(lost, '9.1f')}  {_number(each, '9.3f')}  "
        f"{row['bits'] or '--':>7}  {_number(row['error'], '15.1e')}  "
        f"{_number(row['seconds'], '8.1e')}s  {row['note']}"
    ).rstrip()


def _worst_lines(rows: list[tables.Row]) -> Iterator[str]:
    for height, form in sorted({(row["height"], row["form"]) for row in rows}):
        here = [row for row in rows if (row["height"], row["form"]) == (height, form)]
        worst = max(here, key=lambda row: float(row["relative_error"]))
        yield f"{form:<18} M = {height:<11} {worst['relative_error']:.1e} at j = {worst['j']}"


@dataclass(frozen=True)
class _Table:
    """A table: its file, its head, what measures its rows, and a row as a line of text.

    Without a ``line`` the worst rows are told, once all are known.
    """

    file: str
    head: str
    measured: Callable[[], Iterator[Measured]]
    line: Callable[[tables.Row], str] | None

    def lines(self, rows: list[tables.Row]) -> list[str]:
        """Give all lines of text, but for the head."""
        return list(_worst_lines(rows) if self.line is None else map(self.line, rows))


TABLES = {
    FLOATS: _Table(
        "stability.csv",
        "Both forms in float64, and balls; errors of change relative to the largest, against an "
        "enclosure\nof all contact forces; ratio: seconds of the deviation form / of the plain "
        "form.\n"
        "group       M    W   sigma/r  s/r             deviation form       plain form         "
        "ratio   balls: lost bits, time  pulling overlaps",
        lambda: map(measure, cases()),
        _float_line,
    ),
    ENCLOSURES: _Table(
        "stability_balls.csv",
        f"Balls in positions and in line-sum coordinates, at the precision that leaves {DIGITS} "
        "digits.\n"
        "balls in      M    W   sigma/r        M*  lost bits  per layer  of bits  certified error"
        "   seconds",
        lambda: map(enclose, strips()),
        _ball_line,
    ),
    CLOSED_FORMS: _Table(
        "closed_forms.csv",
        "Closed forms of Eqs. 13 and 14 in float64, against exact rationals: largest errors.",
        closed_form_rows,
        None,
    ),
}
FILES = {name: table.file for name, table in TABLES.items()}


@dataclass(frozen=True)
class StabilityStudy:
    """Three tables of measurements, by name.

    "rows": both forms in float64 against enclosures of all contact forces (``floats.Comparison``).
    "enclosures": bits that balls lose, in positions and in line sums (``enclosures.Enclosed``).
    "closed_forms": Eqs. 13 and 14 in float64 against exact rationals (``closed.ClosedFormRow``).
    Errors are relative to the largest |change| of a contact force.
    """

    measured: dict[str, tuple[Measured, ...]]

    def rows(self, table: str = FLOATS) -> list[tables.Row]:
        """The rows of one table, ready for a data frame; None: there is no such number."""
        return [asdict(row) for row in self.measured[table]]

    @cached_property
    def arrays(self) -> dict[str, dict[str, Array]]:
        """The columns of each table, each of shape (rows,); NaN where there is no number."""
        return {table: tables.columns_of(self.rows(table)) for table in self.measured}

    def data(self) -> dict[str, Any]:
        """Give all tables as JSON can hold them."""
        found = {table: self.rows(table) for table in self.measured}
        return {"errors_relative_to": "the largest |change|", **found}

    def plot(self) -> "Figure":
        """Draw errors and lost bits, and the times they cost.

        Needs matplotlib (the extra ``plots``). Raises ``MissingLibraryError``, and
        ``ForceDiffusionError`` where the first two tables were not measured.
        """
        if not {FLOATS, ENCLOSURES} <= set(self.measured):
            raise ForceDiffusionError(f'the figure needs the tables "{FLOATS}" and "{ENCLOSURES}"')
        with drawing():
            from .stability_plot import draw

            return draw(self.rows(FLOATS), self.rows(ENCLOSURES))

    def __str__(self) -> str:
        """Give the tables."""
        return "\n\n".join(
            "\n".join([TABLES[name].head, *TABLES[name].lines(self.rows(name))])
            for name in self.measured
        )

    def _repr_html_(self) -> str:
        """Show the tables in a notebook."""
        return "".join(
            tables.html_table(self.rows(table), TABLES[table].head.splitlines()[:1])
            for table in self.measured
        )


def stability(
    notice: Callable[[str], None] = lambda _: None, *, only: Collection[str] = tuple(FILES)
) -> StabilityStudy:
    """Measure what stability costs: errors, lost bits and times with and without it.

    Takes about 40 s; ``only`` names the tables to be measured. ``notice`` is told the lines of
    the tables as they come, those of the closed forms last. Raises ``ForceDiffusionError`` for a
    table that there is not.

    >>> import force_diffusion as fd
    >>> found = fd.stability(only=["closed_forms"])
    >>> bool(found.arrays["closed_forms"]["relative_error"].max() < 1e-14)
    True
    """
    if not callable(notice):
        told = f"stability takes a function that is told lines, not {type(notice).__name__}"
        raise TypeError(told)
    for name in only:
        if name not in FILES:
            raise ForceDiffusionError(f'there is no table "{name}"; there are {", ".join(FILES)}')
    found: dict[str, tuple[Measured, ...]] = {}
    for name, table in TABLES.items():
        if name not in only:
            continue
        notice(("\n" if found else "") + table.head)
        rows = []
        for row in table.measured():
            rows.append(row)
            if table.line is not None:
                notice(table.line(asdict(row)))
        found[name] = tuple(rows)
        for line in table.lines([asdict(row) for row in rows]) if table.line is None else ():
            notice(line)
    return StabilityStudy(found)


def csv_rows(data: dict[str, Any], command: str) -> dict[str, list[dict[str, Any]]]:
    """Give the rows of each CSV file; each ends with the command behind it."""
    own = {"command": command}
    return {file: [row | own for row in data[name]] for name, file in FILES.items()}
