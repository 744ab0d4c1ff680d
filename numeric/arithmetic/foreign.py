"""The one door for files that other programs or people wrote.

Kind, size and numbers are looked at here, before NumPy or anything else makes something of them.
What is wrong is said without the name of the file, which who opens it puts before it.
"""

import math
import mmap
import os
import re
import stat
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, BinaryIO, Literal

import numpy as np

from .errors import ForceDiffusionError
from .systems import Array

LONGEST_HEADER = 10_000  # bytes of a NumPy header, as NumPy itself allows
_MAGIC = b"\x93NUMPY"
# Bytes that say how long the header is, for each version of the format.
_LENGTHS = {(1, 0): 2, (2, 0): 4, (3, 0): 4}
# The header as NumPy writes it: a dictionary of three, in any order.
_SIZE = "(?:0|[1-9][0-9]{0,17})L?[ ]*"
_KEYS = [
    r"""(?:'descr'|"descr")[ ]*:[ ]*['"]([^'"]{1,20})['"]""",
    r"""(?:'fortran_order'|"fortran_order")[ ]*:[ ]*(True|False)""",
    rf"""(?:'shape'|"shape")[ ]*:[ ]*\([ ]*((?:{_SIZE},[ ]*)+(?:{_SIZE})?|)\)""",
]
_HEADER = re.compile(
    r"\{[ ]*KEY[ ]*,[ ]*KEY[ ]*,[ ]*KEY[ ]*,?[ ]*\}[ \n]*".replace("KEY", f"(?:{'|'.join(_KEYS)})")
)
_REAL = re.compile(r"[<>|=]?[fiu][0-9]{1,2}", re.ASCII)


class ForeignFileError(ForceDiffusionError, ValueError):
    """A file can't be used; the message says why, and does not name it."""


@contextmanager
def opened(path: Path, most: int | None = None) -> Iterator[BinaryIO]:
    """Open an ordinary file of at most ``most`` bytes. Raises ``ForeignFileError``."""
    if not path.is_file():  # a device or a pipe may have no end
        raise ForeignFileError(
            "must be a regular file" if path.exists() else "there is no such file"
        )
    try:
        with path.open("rb") as file:
            found = os.fstat(file.fileno())
            if not stat.S_ISREG(found.st_mode):
                raise ForeignFileError("must be a regular file")
            if most is not None and found.st_size > most:
                raise ForeignFileError(f"must have at most {most} bytes, and has {found.st_size}")
            yield file
    except OSError as error:
        raise ForeignFileError(f"can't be read ({error.strerror})") from None


def read_numbers(path: Path) -> Array:
    """Map the array of a NumPy file (.npy) of real numbers; nothing of it is read yet.

    Raises ``ForeignFileError``.
    """
    with opened(path) as file:
        size = os.fstat(file.fileno()).st_size
        kind, fortran, shape = _header(file)
        if not math.prod(shape):
            raise ForeignFileError(f"is empty: its shape is {shape}")
        if math.prod(shape) * kind.itemsize > size - file.tell():
            raise _no_numbers(f"it is too short for its shape, {_shown(shape)}")
        mapped = mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ)
        order: Literal["F", "C"] = "F" if fortran else "C"
        return np.ndarray(shape, kind, buffer=mapped, offset=file.tell(), order=order)


def _shown(shape: tuple[int, ...]) -> str:
    return f"({', '.join(map(str, shape))})" if len(shape) < 9 else f"of {len(shape)} axes"


def _no_numbers(why: str) -> ForeignFileError:
    return ForeignFileError(f"is not a NumPy file of numbers: {why}")


def _header(file: BinaryIO) -> tuple[np.dtype[Any], bool, tuple[int, ...]]:
    """Read type, order and shape, which stand in front; only what NumPy itself writes is taken."""
    start = file.read(len(_MAGIC) + 2)
    if start[:2] == b"PK":
        raise _no_numbers("it is a ZIP archive, as .npz is; save the one array with np.save")
    if start[: len(_MAGIC)] != _MAGIC or len(start) < len(_MAGIC) + 2:
        raise _no_numbers("it does not begin as one")
    version = start[-2], start[-1]
    if version not in _LENGTHS:
        raise _no_numbers(f"its version is {version[0]}.{version[1]}")
    length = int.from_bytes(file.read(_LENGTHS[version]), "little")
    if length > LONGEST_HEADER:
        raise _no_numbers(f"its header has {length} bytes, and {LONGEST_HEADER} are allowed")
    text = file.read(length).decode("latin-1")
    found = [re.search(key, text) for key in _KEYS]
    if len(text) < length or not _HEADER.fullmatch(text) or None in found:
        raise _no_numbers("its header is damaged, or doesn't match the data")
    descr, order, shape = (one[1] for one in found if one)
    if not _REAL.fullmatch(descr):
        raise _no_numbers(f"real numbers are needed, and it holds '{descr}'")
    try:
        kind = np.dtype(descr)
    except TypeError:
        raise _no_numbers(f"the type {descr} is unknown here") from None
    sizes = tuple(int(word.strip().rstrip("L")) for word in shape.split(",") if word.strip())
    return kind, order == "True", sizes
