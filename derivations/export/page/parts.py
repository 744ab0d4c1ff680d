"""What a part of the report consists of, besides the equations: words, tables, figures, commands.

Everything that is drawn or measured comes in as a ``Part``.
"""

import base64
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from decimal import Decimal
from typing import Any

from markupsafe import Markup, escape

from ..tables import csv_text
from .html import number, prose

ONE_COLUMN = 360.0
"""Points: narrower drawings are for one column."""


@dataclass(frozen=True)
class Data:
    """A file that the page carries within itself, to be saved by a link."""

    name: str
    content: str
    kind: str = "text/csv"

    @property
    def link(self) -> str:
        """The file as an address."""
        return data_url(self.content.encode(), self.kind)


@dataclass(frozen=True)
class Table:
    """Rows by the names of their columns; cells are numbers or words, None where none applies."""

    caption: str
    rows: Sequence[Mapping[str, Any]]
    data: Data | None = None

    @property
    def columns(self) -> list[tuple[str, bool]]:
        """Every heading, and whether numbers stand below it."""
        return [
            (name.replace("_", " "), any(_cell(row[name])[0] for row in self.rows))
            for name in (self.rows[0] if self.rows else {})
        ]

    @property
    def cells(self) -> list[list[tuple[bool, Markup]]]:
        """Every cell, and whether it holds a number."""
        return [[_cell(value) for value in row.values()] for row in self.rows]


@dataclass(frozen=True)
class Figure:
    """A drawing, what it shows in words for those who can't see it, its data, what makes it."""

    svg: bytes
    alt: str
    caption: str
    data: Sequence[Data] = ()
    command: str = ""

    @property
    def link(self) -> str:
        """The drawing as an address; an image has its own names, styles and no scripts."""
        return data_url(self.svg, "image/svg+xml")

    @property
    def narrow(self) -> bool:
        """Whether it is made for one column of two."""
        width = re.search(rb'<svg[^>]*?\swidth="([\d.]+)pt"', self.svg)
        return width is not None and float(width[1]) < ONE_COLUMN


@dataclass(frozen=True)
class Part:
    """A section of the page; ``command`` makes all of its content again, where one does."""

    id: str
    title: str
    words: tuple[str, ...]
    command: str = ""
    figures: tuple[Figure, ...] = ()
    tables: tuple[Table, ...] = ()
    files: tuple[Data, ...] = ()


def data_url(content: bytes, kind: str) -> str:
    """Content as an address that holds it."""
    return f"data:{kind};base64,{base64.b64encode(content).decode()}"


def csv_data(name: str, rows: Sequence[Mapping[str, Any]]) -> Data:
    """Rows as a CSV file."""
    return Data(name, csv_text(rows))


def _cell(value: Any) -> tuple[bool, Markup]:
    if value is None or isinstance(value, int | float | Decimal):
        return True, escape(number(value))
    return False, prose(str(value))
