"""Files that other programs or people wrote: tables of radii and loads, and arrays.

Decimals are read exactly, and every error names its line. Each file from outside is opened here.
"""

import csv
import math
import os
import re
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from fractions import Fraction
from functools import partial
from io import TextIOWrapper
from pathlib import Path
from tokenize import TokenError
from typing import BinaryIO

import numpy as np

from ..arithmetic.decimals import parse, short
from ..arithmetic.errors import ForceDiffusionError, quoted
from ..arithmetic.systems import Array
from ..lattice.branch import Site, axis_names, bead_names
from ..lattice.layers import Naming, whole
from .sections import Packing, radii_array

Bead = tuple[int, ...]
_WHOLE = re.compile(r"[+-]?[0-9]{1,18}", re.ASCII)
LARGEST = 2**31  # bytes of a table; 10^8 beads
LONGEST_LINE = 20_000  # characters; numbers have at most 5000 digits
MOST = 10**100  # of δr/r: gaps between beads are measured in float64, which holds their squares
FARTHEST = 2**50  # r: beyond, float64 tells no beads apart


class ForeignFileError(ForceDiffusionError, ValueError):
    """A file can't be used; the message says why, and whoever opened it puts its name before."""


@contextmanager
def opened(path: Path, most: int | None = None) -> Iterator[BinaryIO]:
    """Open an ordinary file of at most ``most`` bytes. Raises ``ForeignFileError``."""
    if not path.is_file():  # a device or a pipe may have no end
        raise ForeignFileError(
            "must be a regular file" if path.exists() else "there is no such file"
        )
    try:
        with path.open("rb") as file:
            size = os.fstat(file.fileno()).st_size
            if most is not None and size > most:
                raise ForeignFileError(f"must have at most {most} bytes, and has {size}")
            yield file
    except OSError as error:
        raise ForeignFileError(f"can't be read ({error.strerror})") from None


def read_numbers(path: Path) -> Array:
    """Map the array of a NumPy file (.npy) of real numbers; nothing of it is read yet.

    Raises ``ForeignFileError``.
    """
    with opened(path) as file:
        if file.read(2) == b"PK":
            archive = "is a ZIP archive, as .npz is; save the one array with np.save"
            raise ForeignFileError(archive)
    try:
        with np.errstate(all="raise"):  # of sizes beyond all memory
            array = np.asarray(np.load(path, "r", allow_pickle=False))
    except (ValueError, TypeError, ArithmeticError, SyntaxError, EOFError, OSError, TokenError):
        raise ForeignFileError(
            "is not a NumPy file of numbers, as np.save writes one, or is cut off"
        ) from None
    if not array.size:
        raise ForeignFileError(f"is empty: its shape is {array.shape}")
    if array.dtype.kind not in "iuf":
        raise ForeignFileError(f"real numbers are needed, and it holds '{array.dtype}'")
    return array


class TableError(ForceDiffusionError, ValueError):
    """A file of radii or loads can't be used; the message names the file, line and bead."""


Row = tuple[str, list[str], list[str]]
"""Where it stands, the names of its columns, and what it says."""
SAME = {"radius": "r"}
"""What columns may be called as well."""


def rows_of_table(key: str, path: Path, *headers: list[str]) -> Iterator[Row]:
    """Read the columns of the first header that a table has all of, in whatever order.

    They are separated by commas, semicolons or tabs. Raises ``TableError``.
    """
    name = f"{key}: {path.name}"
    try:
        with (
            opened(path, LARGEST) as raw,
            TextIOWrapper(raw, encoding="utf-8-sig", newline="") as file,
        ):
            lines = _lines(name, file)
            first = next(lines, "")
            delimiter = max(",;\t", key=first.count)
            written = [
                word.strip().lower() for word in next(csv.reader([first], delimiter=delimiter), [])
            ]
            columns = [SAME.get(word, word) for word in written]
            header = next((names for names in headers if {*names} <= {*columns}), None)
            if header is None:
                allowed = " or ".join(map(",".join, headers))
                raise TableError(f"{name}: the first line must name the columns {allowed}")
            if twice := [word for word in header if columns.count(word) > 1]:
                raise TableError(f"{name}: the first line names {twice[0]} twice; radius is r, too")
            places = [columns.index(word) for word in header]
            reader = csv.reader(lines, delimiter=delimiter, strict=True)
            for row in filter(None, reader):
                where = f"{name}, line {reader.line_num + 1}"
                if len(row) != len(columns):
                    wrong = f"{len(row)} values where {len(columns)} are expected"
                    raise TableError(f"{where}: {wrong}")
                yield where, header, [row[place] for place in places]
    except ForeignFileError as error:
        raise TableError(f"{key}: {path}: {error}") from None
    except (UnicodeDecodeError, csv.Error) as error:
        raise TableError(f"{name}: is not a CSV file in UTF-8 ({error})") from None


def _lines(name: str, file: TextIOWrapper) -> Iterator[str]:
    """Read line by line: one that never ends is not held in memory."""
    for number, line in enumerate(iter(partial(file.readline, LONGEST_LINE + 1), ""), 1):
        if len(line) > LONGEST_LINE:
            most = f"a line has at most {LONGEST_LINE} characters, and this one has more"
            raise TableError(f"{name}, line {number}: {most}: is it a table with one bead a line?")
        yield line


def _parsed(where: str, header: list[str], row: list[str]) -> tuple[Bead, list[Fraction]]:
    """Read a bead (i, j) or (p, q, j), and the numbers after it."""
    count = header.index("j") + 1
    for name, text in zip(header[:count], row, strict=False):
        if not _WHOLE.fullmatch(text.strip()):
            allowed = "must be a whole number of at most 18 digits"
            raise TableError(f"{where}: {name} = {quoted(text)} {allowed}")
    bead = tuple(map(int, row[:count]))
    return bead, numbers_of(f"{where}: bead {bead}", header[count:], row[count:])


def numbers_of(where: str, header: list[str], row: list[str]) -> list[Fraction]:
    """Read decimals exactly. Raises ``TableError``."""
    values = []
    for name, text in zip(header, row, strict=True):
        try:
            values.append(parse(text))
        except ValueError as error:
            raise TableError(f"{where}: {name}: {error}") from None
    return values


def _on_lattice(where: str, x: Fraction, y: Fraction, packing: Packing) -> Site:
    """Name the site of the ordered packing, bead (0, 0) at the origin, nearest to a place."""
    r, s, width = packing.radius, packing.s, packing.width
    place = f"{where}: x = {short(x)}, y = {short(y)}"
    if max(abs(x), abs(y)) > FARTHEST * r:
        raise TableError(f"{place} lies more than 2^50 r from bead (0, 0)")
    across, up = float(x / s), float(y / r)
    step = 2 * math.sqrt(1 - float(packing.n_x) ** 2)

    def nearest(j: int) -> tuple[float, Site]:
        i = 2 * round(across - (j % 2) / 2) + j % 2
        return math.hypot((across - i / 2) * float(s / r), up - j * step), (i, j)

    below = math.floor(up / step)
    off, (i, j) = min(nearest(below), nearest(below + 1))
    if not off < 0.5:
        raise TableError(
            f"{place} lies {off:.2g} r from the nearest site {(i, j)} of the ordered packing, and "
            "half of r is allowed: bead (0, 0) is at 0, 0; in Python read_radii fits the lattice "
            "to the centres"
        )
    return (i if width is None else i % (2 * width)), j


def _site(where: str, bead: Bead, packing: Packing) -> Site:
    """Give the place of a bead (i, j) in its layer, or of (p, q, j) in a row of W²."""
    if why := packing.misplaced(bead, 0, packing.height):
        raise TableError(f"{where}: bead {bead}: {why}")
    return Naming(packing.dimension, packing.width).site(bead)


def read_radii(
    path: Path, packing: Packing, needed: Callable[[Site], bool]
) -> dict[Site, Fraction]:
    """Read ``i,j,delta_r``, ``i,j,r`` or ``x,y,r`` into {(i, j): δr/r}, keeping ``needed`` beads.

    In three dimensions ``p,q,j,delta_r`` or ``p,q,j,r``, into rows of W² beads. Lengths are in the
    unit of the packing's; beads at x, y are put on the nearest site. A periodic packing's file must
    name each of its beads once. Raises ``TableError``.
    """
    rho: dict[Site, Fraction] = {}
    radius, width, dimension = packing.radius, packing.width, packing.dimension
    names = bead_names(dimension)
    headers = [[*names, "delta_r"], [*names, "r"]] + [["x", "y", "r"]] * (dimension == 2)
    bead: Bead
    for where, header, row in rows_of_table("disorder.file", path, *headers):
        if header[0] == "x":
            x, y, delta = numbers_of(where, header, row)
            bead = _on_lattice(where, x, y, packing)
        else:
            bead, (delta,) = _parsed(where, header, row)
        delta -= radius if header[-1] == "r" else 0
        site = _site(where, bead, packing)
        if delta <= -radius or delta > MOST * radius:
            what = f"delta_r = {short(delta)} must be at most 1e100 r"
            if delta < 0:
                what = f"its radius is {short(radius + delta)}, and must be greater than 0"
            raise TableError(f"{where}: bead {bead}: {what}")
        if width is not None or needed(site):
            if site in rho:
                raise TableError(f"{where}: bead {bead} is named twice")
            rho[site] = delta / radius
    if width is not None and len(rho) < width ** (dimension - 1) * (packing.height + 1):
        rows = whole(width ** (dimension - 1), packing.height).rows
        missing = next((i, row.j) for row in rows for i in row.sites() if (i, row.j) not in rho)
        bead = Naming(dimension, width).bead(missing)
        raise TableError(f"disorder.file: {path.name}: bead {bead} is missing")
    if abs(mean := math.fsum(map(float, rho.values())) / max(len(rho), 1)) > 0.5:
        raise TableError(
            f"disorder.file: {path.name}: the mean radius is {1 + mean:.3g} times packing.radius = "
            f"{short(radius)}: is it in another unit, or are radii listed as delta_r, not as r?"
        )
    return rho


def read_array(path: Path, packing: Packing) -> Array:
    """Read radii from a NumPy file (.npy) of the packing's ``shape``, layer 0 first, as float64.

    Raises ``TableError``.
    """
    name, shape = f"disorder.file: {path.name}", packing.shape
    if None in shape:
        raise TableError(f"{name}: an array needs packing.width: a slab has no last column")
    try:
        values = read_numbers(path)
    except ForeignFileError as error:
        raise TableError(f"disorder.file: {path}: {error}") from None
    if values.shape != shape:
        raise TableError(
            f"{name}: an array of shape {values.shape}; the packing has {shape[0]} layers, "
            f"base included, of {' × '.join(map(str, shape[1:]))} beads"
        )
    try:
        radii = radii_array(values)
    except ValueError as error:
        raise TableError(f"{name}: {error}") from None
    mean = float(radii.mean())
    if abs(Fraction(mean) - packing.radius) > packing.radius / 2:
        raise TableError(
            f"{name}: the mean radius is {mean:.3g}, and packing.radius is "
            f"{short(packing.radius)}: is it in another unit?"
        )
    return radii


def read_loads(
    path: Path, packing: Packing, magnitude: Fraction
) -> dict[Site, tuple[Fraction, ...]]:
    """Read ``i,j,fx,fy`` into {(i, j): (fx, fy)/magnitude}, in three dimensions ``p,q,j,fx,fy,fz``.

    Raises ``TableError``.
    """
    loads: dict[Site, tuple[Fraction, ...]] = {}
    d = packing.dimension
    header = [*bead_names(d), *(f"f{axis}" for axis in axis_names(d))]
    for where, _, row in rows_of_table("load.file", path, header):
        bead, force = _parsed(where, header, row)
        site = _site(where, bead, packing)
        if site in loads:
            raise TableError(f"{where}: bead {bead} is named twice")
        loads[site] = tuple(component / magnitude for component in force)
    return loads
