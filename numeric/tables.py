"""Results as rows, as tables for people, and as columns of text."""

import math
import re
from collections.abc import Iterable, Mapping, Sequence
from functools import cache
from importlib import import_module
from typing import TYPE_CHECKING, Any

import numpy as np

from .arithmetic.decimals import short
from .arithmetic.errors import MissingLibraryError
from .arithmetic.systems import Array, as_floats

if TYPE_CHECKING:
    from pandas import DataFrame
    from xarray import Dataset

Row = dict[str, Any]
SHOWN = 20


def rows_of(columns: Mapping[str, Array]) -> list[Row]:
    """Give arrays of equal length row by row, ready for a data frame.

    Numbers become Python's int and float, those of other arithmetics (mpmath, balls) floats.

    >>> import numpy as np
    >>> rows_of({"j": np.arange(2), "std": np.array([0.5, 0.25])})
    [{'j': 0, 'std': 0.5}, {'j': 1, 'std': 0.25}]
    """
    lists = [
        [float(value) for value in column] if column.dtype == object else column.tolist()
        for column in columns.values()
    ]
    return [dict(zip(columns, row, strict=True)) for row in zip(*lists, strict=True)]


DIMENSIONS = {"realisation": "packing", "j": "layer", "i": "column"}
"""Names of dimensions, of columns that number something; others keep theirs."""
LABELS = ("realisation", "j", "i", "p", "q", "branch", "component")


class Tabled:
    """What has columns of one length, ``arrays``."""

    @property
    def arrays(self) -> dict[str, Array]:
        """The columns."""
        raise NotImplementedError

    def to_dataframe(self) -> "DataFrame":
        """The rows as a data frame of pandas (the extra ``tables``); numbers are floats.

        Raises ``MissingLibraryError``.
        """
        pandas = _library("pandas")
        columns = {
            name: as_floats(v) if v.dtype == object else v for name, v in self.arrays.items()
        }
        return pandas.DataFrame(columns)

    def to_xarray(self) -> "Dataset":
        """The columns as a dataset of xarray (the extra ``tables``), by layer, column and branch.

        A column is that of an array of radii, (i − j mod 2)/2; of spheres there are p and q. Of
        several packings there is the dimension packing, of a histogram bin; where contacts may
        open, row. What isn't there is NaN. Raises ``MissingLibraryError``.
        """
        dataset = _library("xarray").Dataset
        frame = self.to_dataframe()
        names = [name for name in LABELS if name in frame]
        if "i" in frame:
            frame["i"] = (frame["i"] - frame["j"] % 2) // 2
        if not names or frame.duplicated(names).any():
            indexed = frame.rename_axis("row" if names else "bin")
        else:
            dimensions = [DIMENSIONS.get(name, name) for name in names]
            indexed = frame.rename(columns=DIMENSIONS).set_index(dimensions)
        found: Dataset = dataset.from_dataframe(indexed)
        return found


class Answered(Tabled):
    """The answer to a question, as a table whose numbers are known to so many digits."""

    @property
    def quantity(self) -> str:
        """The question, by its name in a scene."""
        raise NotImplementedError

    @property
    def text(self) -> dict[str, list[str]]:
        """The columns as text: decimals with the digits that are known."""
        raise NotImplementedError

    @property
    def number_of_rows(self) -> int:
        """How many rows there are."""
        return len(next(iter(self.arrays.values()), ()))

    @property
    def whole_numbers(self) -> list[str]:
        """The names of columns of whole numbers: sites and counts."""
        return whole(self.arrays)

    def decimals(self) -> list[Row]:
        """The table row by row, numbers as decimal strings with the digits that are known."""
        return rows_of_text(self.text, self.whole_numbers)

    def _repr_html_(self) -> str:
        """Show the first rows as a table in a notebook."""
        first = {name: text[:SHOWN] for name, text in self.text.items()}
        rows = rows_of_text(first, self.whole_numbers)
        return html_table(rows, str(self).splitlines(), self.number_of_rows)


def whole(columns: Mapping[str, Array]) -> list[str]:
    """Name the columns of whole numbers."""
    return [name for name, column in columns.items() if column.dtype.kind == "i"]


def _library(name: str) -> Any:
    """Import pandas or xarray. Raises ``MissingLibraryError``."""
    try:
        return import_module(name)
    except ModuleNotFoundError:
        raise MissingLibraryError(
            f"{name} is missing; pip install 'force-diffusion[tables]'"
        ) from None


def html_table(
    rows: Sequence[Mapping[str, Any]], words: Iterable[str], count: int | None = None
) -> str:
    """Show the first of ``count`` rows as a table in HTML, and lines of words below it."""
    from html import escape  # its names of characters take long to load

    def cell(value: Any) -> str:
        if value is None:
            return ""
        return escape(f"{value:.6g}" if isinstance(value, float) else str(value))

    left = (len(rows) if count is None else count) - SHOWN
    heads = "".join(f"<th>{escape(name)}</th>" for name in (rows[0] if rows else {}))
    body = "".join(
        "<tr>" + "".join(f"<td>{cell(value)}</td>" for value in row.values()) + "</tr>"
        for row in rows[:SHOWN]
    )
    more = f"<p>… and {left} more rows</p>" if left > 0 else ""
    below = "<br>".join(map(escape, words))
    return f"<table><tr>{heads}</tr>{body}</table>{more}<p>{below}</p>"


def latex_table(rows: Sequence[Mapping[str, Any]]) -> str:
    r"""Show rows as an array in LaTeX, which MathJax reads, too.

    >>> print(latex_table([{"j": 0, "component": "force", "std_error": 2.5e-7}]))
    $\displaystyle\begin{array}{rrr}
    \mathrm{j} & \mathrm{component} & \mathrm{std\_error} \\ \hline
    0 & \mathrm{force} & 2.5\times10^{-7}
    \end{array}$
    """

    def line(words: Iterable[str]) -> str:
        return " & ".join(words).replace("_", r"\_")

    def cell(value: Any) -> str:
        text = f"{value:.3g}" if isinstance(value, float) else str(value)
        if text[:1].isalpha():
            return rf"\mathrm{{{text}}}"
        return re.sub(r"e([+-])0*(\d+)$", r"\\times10^{\1\2}", text)

    heads = line(rf"\mathrm{{{name}}}" for name in rows[0])
    cells = (line(map(cell, row.values())) for row in rows)
    start = rf"$\displaystyle\begin{{array}}{{{'r' * len(rows[0])}}}"
    return "\n".join([start, heads + r" \\ \hline", " \\\\\n".join(cells), r"\end{array}$"])


def counted(count: int, noun: str) -> str:
    """Say how many there are.

    >>> counted(1, "row"), counted(8, "row")
    ('1 row', '8 rows')
    """
    return f"{count} {noun}{'s' * (count != 1)}"


def significant(values: Array, digits: Array) -> list[str]:
    """Write float64 with 1 to 17 significant digits each; nothing for NaN.

    >>> significant(np.array([0.75, -1.25e-7, np.nan]), np.array([17, 2, 3]))
    ['0.75', '-1.2e-07', '']
    """
    pairs = zip(values.tolist(), digits.tolist(), strict=True)
    return [f"{value:.{count}g}" if not math.isnan(value) else "" for value, count in pairs]


def text_of(column: Array) -> list[str]:
    """Write whole numbers, words without quotes and commas, floats (15 digits), fractions (12).

    >>> text_of(np.array([3, -12])), text_of(np.array(["+", "-"]))
    (['3', '-12'], ['+', '-'])
    """
    if column.dtype == object:
        return [short(value, 12) for value in column]
    if column.dtype.kind == "f":
        return significant(column, np.full(len(column), 15))
    shared = cache(str)  # few sites and branches, many times
    return list(map(shared, column.tolist()))


def rows_of_text(columns: Mapping[str, list[str]], whole: Sequence[str]) -> list[Row]:
    """Give columns of text row by row: those that are ``whole`` as int, the others as strings."""
    listed = [map(int, text) if name in whole else text for name, text in columns.items()]
    return [dict(zip(columns, row, strict=True)) for row in zip(*listed, strict=True)]


def csv_bytes(columns: Mapping[str, list[str]]) -> bytes:
    """Write columns of text as CSV: a header, and the rows."""
    if not columns:
        return b""
    rows = map(",".join, zip(*columns.values(), strict=True))
    return "\n".join([",".join(columns), *rows, ""]).encode()


def json_rows(columns: Mapping[str, list[str]], bare: Sequence[str]) -> bytes:
    """Write columns of text as JSON objects, a line a row; all but the ``bare`` are strings."""
    places = {name: "%s" if name in bare else '"%s"' for name in columns}
    form = "      {" + ", ".join(f'"{name}": {place}' for name, place in places.items()) + "}"
    return ",\n".join(form % row for row in zip(*columns.values(), strict=True)).encode()
