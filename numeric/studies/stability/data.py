"""The measurements of stability as plain data: JSON, rows of CSV files, lines for a terminal."""

from collections.abc import Iterator
from dataclasses import asdict
from typing import Any

from .closed import ClosedFormRow, closed_form_rows
from .enclosures import DIGITS, Enclosed, enclose, strips
from .floats import Row, cases, measure

Measured = Row | Enclosed | ClosedFormRow
FLOATS, ENCLOSURES, CLOSED_FORMS = "rows", "enclosures", "closed_forms"
FILES = {
    FLOATS: "stability.csv",
    ENCLOSURES: "stability_balls.csv",
    CLOSED_FORMS: "closed_forms.csv",
}


def measurements() -> Iterator[tuple[str, Measured]]:
    """Measure everything, about 40 s of work: pairs (name of a table, its next row)."""
    for case in cases():
        yield FLOATS, measure(case)
    for strip in strips():
        yield ENCLOSURES, enclose(strip)
    for row in closed_form_rows():
        yield CLOSED_FORMS, row


def stability_data(found: list[tuple[str, Measured]], command: str) -> dict[str, Any]:
    """Give all tables as JSON can hold them."""
    tables = {name: [asdict(row) for table, row in found if table == name] for name in FILES}
    return {"command": command, "errors_relative_to": "the largest |change|", **tables}


def csv_rows(data: dict[str, Any]) -> dict[str, list[dict[str, Any]]]:
    """Give the rows of each CSV file; each ends with the command behind it."""
    command = {"command": data["command"]}
    return {file: [row | command for row in data[name]] for name, file in FILES.items()}


HEADS = {
    FLOATS: (
        "Both forms in float64, and balls; errors of change relative to the largest, against an "
        "enclosure\nof all contact forces; ratio: seconds of the deviation form / of the plain "
        "form.\n"
        "group       M    W   sigma/r  s/r             deviation form       plain form         "
        "ratio   balls: lost bits, time  pulling overlaps"
    ),
    ENCLOSURES: (
        f"Balls in positions and in line-sum coordinates, at the precision that leaves {DIGITS} "
        "digits.\n"
        "balls in      M    W   sigma/r        M*  lost bits  per layer  of bits  certified error"
        "   seconds"
    ),
    CLOSED_FORMS: (
        "Closed forms of Eqs. 13 and 14 in float64, against exact rationals: largest errors."
    ),
}


def line(name: str, row: dict[str, Any]) -> str:
    """Give a row of the first two tables for a terminal."""
    return _float_line(row) if name == FLOATS else _ball_line(row)


def _number(value: float | None, spec: str = "7.1e") -> str:
    width = int(spec.split(".", maxsplit=1)[0])
    return f"{'--':>{width}}" if value is None else f"{value:{spec}}"


def _float_line(row: dict[str, Any]) -> str:
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


def _ball_line(row: dict[str, Any]) -> str:
    lost = row["bits_lost"]
    each = None if lost is None else lost / row["height"]
    return (
        f"{row['form']:<10}{row['height']:6}{row['width']:5}  {row['relative_std']:8.1e}  "
        f"{row['critical_height']:8.4g}  {_number(lost, '9.1f')}  {_number(each, '9.3f')}  "
        f"{row['bits'] or '--':>7}  {_number(row['error'], '15.1e')}  "
        f"{_number(row['seconds'], '8.1e')}s  {row['note']}"
    ).rstrip()


def closed_form_lines(rows: list[dict[str, Any]]) -> Iterator[str]:
    """Give the largest error of each closed form at each height."""
    for height, form in sorted({(row["height"], row["form"]) for row in rows}):
        here = [row for row in rows if (row["height"], row["form"]) == (height, form)]
        worst = max(here, key=lambda row: float(row["relative_error"]))
        yield f"{form:<18} M = {height:<11} {worst['relative_error']:.1e} at j = {worst['j']}"
