"""Arrays of NumPy that others or nobody would write: read as NumPy does, or refused in words."""

import io
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from force_diffusion.numeric.scene.files import ForeignFileError, TableError, read_numbers
from hypothesis import given
from hypothesis import strategies as st

import force_diffusion as fd
from tests.numeric.scenes import question

LAYERS, WIDTH = 4, 5
GOOD = np.linspace(0.99, 1.01, LAYERS * WIDTH).reshape(LAYERS, WIDTH)


def npy(values: Any = GOOD) -> bytes:
    buffer = io.BytesIO()
    np.save(buffer, values)
    return buffer.getvalue()


def headed(header: str, version: bytes = b"\x01\x00") -> bytes:
    """Give the good array under a header of one's own."""
    text = header.encode().ljust(118 - 1) + b"\n"
    return b"\x93NUMPY" + version + len(text).to_bytes(2, "little") + text + GOOD.tobytes()


def about(descr: str = "<f8", order: str = "False", shape: str = "(4, 5)", more: str = "") -> bytes:
    return headed(f"{{'descr': '{descr}', 'fortran_order': {order}, 'shape': {shape}, {more}}}")


NO_FILE = "is not a NumPy file"


def read(path: Path) -> Any:
    radii = fd.Disorder(kind="file", file=str(path))
    return question("contact_forces", LAYERS - 1, WIDTH, radii=radii).run()


@pytest.mark.parametrize(
    ("content", "says"),
    {
        "archive": (b"PK\x03\x04" + bytes(50), "is a ZIP archive"),
        "nested": (about(shape="(" * 50), NO_FILE),
        "a calculation": (about(shape="(4, 5**1)"), NO_FILE),
        "huge": (about(shape="(4, 999999999999999999)"), NO_FILE),
        "many axes": (about(shape="(4, 5" + ", 1" * 9 + ")"), "shape"),
        "empty": (about(shape="(4, 0)"), "is empty"),
        "objects": (about("|O"), NO_FILE),
        "version": (headed("{}", b"\x09\x00"), NO_FILE),
        "cut": (npy()[:-1], NO_FILE),
        "nothing": (b"", NO_FILE),
        "infinite": (npy(GOOD * np.inf), "finite"),
        "large": (npy(GOOD * 1.7e308), "at most 1e\\+300"),
        "another unit": (npy(GOOD * 2.5), "mean radius"),
    }.values(),
)
def test_what_is_no_array_of_numbers(content, says, tmp_path):
    path = tmp_path / "radii.npy"
    path.write_bytes(content)
    with pytest.raises(TableError, match=rf"disorder.file: .*radii.npy: .*{says}"):
        read(path)


@pytest.mark.parametrize(
    "values",
    [np.asfortranarray(GOOD), GOOD.astype(">f8"), GOOD.astype(np.longdouble),
     np.ones((LAYERS, WIDTH), dtype=np.int16), np.ones((LAYERS, WIDTH), dtype="|u1")],
)  # fmt: skip
def test_all_real_arrays_of_numpy_are_read(values, tmp_path):
    path = tmp_path / "radii.npy"
    path.write_bytes(npy(values))
    array = read_numbers(path)
    assert array.dtype == values.dtype
    assert (array == values).all()
    assert read(path).number_of_rows == 2 * WIDTH * (LAYERS - 1)


@given(data=st.data())
def test_a_changed_file_is_read_or_refused(data, tmp_path_factory):
    content = bytearray(npy())
    for _ in range(data.draw(st.integers(1, 4))):
        at = data.draw(st.integers(0, 127))
        content[at] = data.draw(st.sampled_from(b"0123456789<>|fiuOcU'(),{} \x00\xff\n-*"))
    path = tmp_path_factory.mktemp("npy") / "radii.npy"
    path.write_bytes(content)
    with suppress(ForeignFileError):
        assert read_numbers(path).dtype.kind in "iuf"
