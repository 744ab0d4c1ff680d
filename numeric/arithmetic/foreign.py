"""Reading files that other programs or people wrote; every such file is opened here.

Messages say what is wrong without the name of the file; the caller puts the name before them.
"""

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from tokenize import TokenError
from typing import BinaryIO

import numpy as np

from .errors import ForceDiffusionError
from .systems import Array


class ForeignFileError(ForceDiffusionError, ValueError):
    """A file can't be used; the message says why, without the file's name."""


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
