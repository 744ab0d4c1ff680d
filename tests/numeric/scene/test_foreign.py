"""Arrays of NumPy that others or nobody would write: read as NumPy does, or refused in words."""

import io
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from force_diffusion.numeric.arithmetic.foreign import ForeignFileError, read_numbers
from force_diffusion.numeric.scene.files import TableError
from hypothesis import given
from hypothesis import strategies as st

import force_diffusion as fd

LAYERS, WIDTH = 4, 5
GOOD = np.linspace(0.99, 1.01, LAYERS * WIDTH).reshape(LAYERS, WIDTH)


def npy(values: Any = GOOD) -> bytes:
    buffer = io.BytesIO()
    np.save(buffer, values)
    return buffer.getvalue()


def npz() -> bytes:
    buffer = io.BytesIO()
    np.savez(buffer, GOOD)
    return buffer.getvalue()


def headed(header: str, version: bytes = b"\x01\x00") -> bytes:
    """Give the good array under a header of one's own."""
    text = header.encode().ljust(118 - 1) + b"\n"
    return b"\x93NUMPY" + version + len(text).to_bytes(2, "little") + text + GOOD.tobytes()


def about(descr: str = "<f8", order: str = "False", shape: str = "(4, 5)", more: str = "") -> bytes:
    return headed(f"{{'descr': '{descr}', 'fortran_order': {order}, 'shape': {shape}, {more}}}")


def read(path: Path) -> Any:
    packing = fd.Packing(height=LAYERS - 1, width=WIDTH)
    scene = fd.Scene(
        packing=packing,
        disorder=fd.Disorder(kind="file", file=str(path)),
        ask=fd.Ask(quantity="contact_forces"),
    )
    return scene.run()


@pytest.mark.parametrize(
    ("content", "says"),
    {
        "archive": (npz(), "is a ZIP archive"),
        "PK": (b"PK", "is a ZIP archive"),
        "PK and more": (b"PK\x03\x04" + bytes(50), "is a ZIP archive"),
        "unclosed": (npy().replace(b"}", b" "), "is not a NumPy file"),
        "unclosed shape": (about(shape="(4, 5"), "is not a NumPy file"),
        "nested": (about(shape="(" * 50), "is not a NumPy file"),
        "a calculation": (about(shape="(4, 5**1)"), "is not a NumPy file"),
        "another key": (about(more="'x': 1"), "is not a NumPy file"),
        "commas": (about(shape="(4 5)"), "is not a NumPy file"),
        "huge": (about(shape="(4, 999999999999999999)"), "is not a NumPy file"),
        "many axes": (about(shape="(4, 5" + ", 1" * 9 + ")"), "shape"),
        "too long": (about(shape="(4, 9999999999999999999)"), "is not a NumPy file"),
        "negative": (about(shape="(-4, 5)"), "is not a NumPy file"),
        "empty": (about(shape="(4, 0)"), "is empty"),
        "objects": (about("|O"), "is not a NumPy file"),
        "no kind": (about("<q8"), "is not a NumPy file"),
        "no size": (about("<f3"), "is not a NumPy file"),
        "version": (headed("{}", b"\x09\x00"), "is not a NumPy file"),
        "cut": (npy()[:-1], "is not a NumPy file"),
        "header cut": (npy()[:60], "is not a NumPy file"),
        "length cut": (npy()[:9], "is not a NumPy file"),
        "infinite": (npy(GOOD * np.inf), "finite"),
        "large": (npy(GOOD * 1.7e308), "at most 1e\\+300"),
        "text": (b"i,j,r\n", "is not a NumPy file"),
        "nothing": (b"", "is not a NumPy file"),
        "few layers": (npy(GOOD[1:]), "shape"),
        "complex": (npy(GOOD.astype(complex)), "real numbers"),
        "another unit": (npy(GOOD * 2.5), "mean radius"),
    }.values(),
)
def test_what_is_no_array_of_numbers(content: bytes, says: str, tmp_path: Path) -> None:
    path = tmp_path / "radii.npy"
    path.write_bytes(content)
    with pytest.raises(TableError, match=rf"disorder.file: .*radii.npy: .*{says}"):
        read(path)


@pytest.mark.parametrize(
    "values",
    [
        GOOD,
        np.asfortranarray(GOOD),
        GOOD.astype(">f8"),
        GOOD.astype(np.float32),
        GOOD.astype(np.longdouble),
        np.ones((LAYERS, WIDTH), dtype=np.int16),
        np.ones((LAYERS, WIDTH), dtype="|u1"),
    ],
)
@pytest.mark.parametrize("version", [(1, 0), (2, 0), (3, 0)])
def test_all_real_arrays_of_numpy_are_read(
    values: Any, version: tuple[int, int], tmp_path: Path
) -> None:
    path = tmp_path / "radii.npy"
    with path.open("wb") as file:
        np.lib.format.write_array(file, values, version)
    found = read_numbers(path)
    assert found.dtype == values.dtype
    assert (found == values).all()
    assert read(path).count == 2 * WIDTH * (LAYERS - 1)


@given(data=st.data())
def test_a_changed_file_is_read_or_refused_as_numpy_would(
    data: Any, tmp_path_factory: pytest.TempPathFactory
) -> None:
    """NumPy's own reader is the expectation, where it gives an array of as many bytes at all."""
    content = bytearray(npy())
    for _ in range(data.draw(st.integers(1, 4))):
        at = data.draw(st.integers(0, 127))
        content[at] = data.draw(st.sampled_from(b"0123456789<>|fiuOcU'(),{} \x00\xff\n-*"))
    path = tmp_path_factory.mktemp("npy") / "radii.npy"
    path.write_bytes(content)
    try:
        found = read_numbers(path)
    except ForeignFileError:
        return
    expected = np.load(io.BytesIO(content), allow_pickle=False)
    assert (found.shape, found.dtype) == (expected.shape, expected.dtype)
    assert np.array_equal(found, expected, equal_nan=True)
