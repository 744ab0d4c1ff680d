"""Measured radii and loads from CSV files: decimals read exactly, every error naming its line."""

import csv
import re
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from fractions import Fraction
from pathlib import Path
from typing import TextIO

from ..arithmetic.decimals import parse, short
from ..arithmetic.errors import ForceDiffusionError

Site = tuple[int, int]
_WHOLE = re.compile(r"[+-]?[0-9]{1,18}", re.ASCII)
LONGEST_LINE = 20_000  # characters; a number has at most 5000
MOST = 10**100  # of δr/r: gaps between beads are measured in float64, which holds their squares


class TableError(ForceDiffusionError, ValueError):
    """A radii or loads file can't be used; the message names the file, line and bead."""


@contextmanager
def _named(key: str) -> Iterator[None]:
    """Put the scene's key before what is wrong with its file."""
    try:
        yield
    except TableError as error:
        raise TableError(f"{key}: {error}") from None


def _rows(path: Path, header: list[str]) -> Iterator[tuple[str, Site, list[Fraction]]]:
    try:
        if not path.is_file():  # a device or a pipe may have no end
            why = "must be an ordinary file" if path.exists() else "there is no such file"
            raise TableError(f"{path}: {why}")
        with path.open(encoding="utf-8-sig", newline="") as file:
            reader = csv.reader(_lines(path, file), strict=True)
            first = next(reader, None)
            if first is None or [name.strip() for name in first] != header:
                raise TableError(f"{path.name}: the first line must be {','.join(header)}")
            for row in reader:
                if not row:
                    continue
                yield _parsed(f"{path.name}, line {reader.line_num}", row, header)
    except OSError as error:
        raise TableError(f"{path}: can't be read ({error.strerror})") from None
    except (UnicodeDecodeError, csv.Error) as error:
        raise TableError(f"{path.name}: is no CSV text in UTF-8 ({error})") from None


def _lines(path: Path, file: TextIO) -> Iterator[str]:
    """Give the lines; one without end must not fill the memory."""
    number = 0
    while line := file.readline(LONGEST_LINE + 1):
        number += 1
        if len(line) > LONGEST_LINE:
            raise TableError(
                f"{path.name}, line {number}: a line has at most {LONGEST_LINE} characters"
            )
        yield line


def _parsed(where: str, row: list[str], header: list[str]) -> tuple[str, Site, list[Fraction]]:
    if len(row) != len(header):
        raise TableError(f"{where}: {len(row)} values where {len(header)} are expected")
    coordinates = []
    for name, text in zip(header[:2], row, strict=False):
        if not _WHOLE.fullmatch(text.strip()):
            shown = text if len(text) <= 40 else text[:40] + "…"
            raise TableError(
                f"{where}: {name} = {shown!r} must be a whole number of at most 18 digits"
            )
        coordinates.append(int(text))
    site = (coordinates[0], coordinates[1])
    values = []
    for name, text in zip(header[2:], row[2:], strict=True):
        try:
            values.append(parse(text))
        except ValueError as error:
            raise TableError(f"{where}: bead {site}: {name}: {error}") from None
    return where, site, values


def _check_site(where: str, site: Site, width: int | None, height: int) -> None:
    i, j = site
    if (i + j) % 2:
        raise TableError(f"{where}: bead {site}: i + j must be even")
    if not 0 <= j <= height or (width is not None and not 0 <= i < 2 * width):
        across = "" if width is None else f"0 <= i < {2 * width}, "
        raise TableError(
            f"{where}: bead {site} lies outside the packing: {across}0 <= j <= {height}"
        )


@_named("disorder.file")
def read_radii(
    path: Path,
    *,
    radius: Fraction,
    width: int | None,
    height: int,
    needed: Callable[[Site], bool],
) -> dict[Site, Fraction]:
    """Read ``i,j,delta_r`` into {(i, j): δr/r}, keeping only ``needed`` beads.

    ``radius`` is r, in the unit of the file. A periodic packing's file must name each of its
    W (M + 1) beads once. Raises ``TableError``.
    """
    rho: dict[Site, Fraction] = {}
    for where, site, (delta,) in _rows(path, ["i", "j", "delta_r"]):
        _check_site(where, site, width, height)
        if delta <= -radius:
            raise TableError(
                f"{where}: bead {site}: delta_r = {short(delta)} leaves no positive radius"
            )
        if delta > MOST * radius:
            raise TableError(
                f"{where}: bead {site}: delta_r = {short(delta)} must be at most 1e100 r"
            )
        if width is not None or needed(site):
            if site in rho:
                raise TableError(f"{where}: bead {site} is named twice")
            rho[site] = delta / radius
    if width is not None and len(rho) < width * (height + 1):
        for j in range(height + 1):
            for i in range(j % 2, 2 * width, 2):
                if (i, j) not in rho:
                    raise TableError(f"{path.name}: bead {(i, j)} is missing")
    return rho


@_named("load.file")
def read_loads(
    path: Path, *, magnitude: Fraction, width: int | None, height: int
) -> dict[Site, tuple[Fraction, Fraction]]:
    """Read ``i,j,fx,fy`` into {(i, j): (fx, fy)/magnitude}. Raises ``TableError``."""
    loads: dict[Site, tuple[Fraction, Fraction]] = {}
    for where, site, (fx, fy) in _rows(path, ["i", "j", "fx", "fy"]):
        _check_site(where, site, width, height)
        if site in loads:
            raise TableError(f"{where}: bead {site} is named twice")
        loads[site] = (fx / magnitude, fy / magnitude)
    return loads
