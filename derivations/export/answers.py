"""An answer as files: ``result.json`` beside CSV, NPZ or Parquet, and what stands in each.

The columns are those of the answer. CSV and JSON have decimals with the digits that are known. NPZ
and Parquet hold float64 as it is, and numbers of longer arithmetics as decimals; all that is said
about the answer is in them, too, as JSON: in NPZ as ``about``, in Parquet as metadata of the
schema under ``force-diffusion``.
"""

import io
import json
from collections.abc import Iterable
from enum import StrEnum
from typing import Any, Protocol

import numpy as np
from force_diffusion.numeric.arithmetic.errors import ForceDiffusionError
from force_diffusion.numeric.arithmetic.systems import Array
from force_diffusion.numeric.tables import csv_bytes, json_rows


class Format(StrEnum):
    """How the rows of an answer are written."""

    CSV = "csv"
    NPZ = "npz"
    PARQUET = "parquet"


class Answered(Protocol):
    """What has been answered: a run of a scene, or an ensemble."""

    @property
    def quantity(self) -> str:
        """What was asked."""

    @property
    def count(self) -> int:
        """How many rows there are."""

    @property
    def arrays(self) -> dict[str, Array]:
        """The columns as numbers."""

    @property
    def text(self) -> dict[str, list[str]]:
        """The columns as text."""

    @property
    def whole_numbers(self) -> list[str]:
        """Which columns are whole numbers."""


def check(written: Format) -> None:
    """Raise ``ForceDiffusionError`` where a library is missing, before anything is solved."""
    if written == Format.PARQUET:
        try:
            import pyarrow  # noqa: F401
        except ImportError:
            raise ForceDiffusionError(
                "--format parquet needs PyArrow, which is missing: "
                "pip install 'force-diffusion[parquet]', or take npz"
            ) from None


def files_of(answer: Answered, about: dict[str, Any], written: Format) -> dict[str, bytes]:
    """Give the files of an answer by name; ``about`` is all that JSON says of it but its rows."""
    quantity = answer.quantity
    name = f"{quantity}.{written}"
    if written == Format.CSV:
        return {"result.json": json_bytes(answer, about), name: csv_bytes(answer.text)}
    about = about | {"results": {quantity: {"file": name, "rows": answer.count}}}
    text = json.dumps(about, indent=2) + "\n"
    columns = {name: _column(answer, name) for name in answer.arrays}
    content = _npz(columns, text) if written == Format.NPZ else _parquet(columns, text)
    return {"result.json": text.encode(), name: content}


def names_of(quantities: Iterable[str]) -> list[str]:
    """Name all files that answers to these questions may have."""
    return ["result.json", *(f"{name}.{written}" for name in quantities for written in Format)]


def json_bytes(answer: Answered, about: dict[str, Any]) -> bytes:
    """Give all of an answer as JSON, each of its rows on a line."""
    quantity = answer.quantity
    whole = json.dumps(about, indent=2) + "\n"
    place = f'\n  "results": {{\n    "{quantity}": []'  # no string of JSON holds a line's end
    before, _, after = whole.partition(place)
    rows = json_rows(answer.text, answer.whole_numbers)
    start = place.removesuffix("]").encode()
    return b"".join(
        [before.encode(), start, b"\n" + rows + b"\n    ]" if rows else b"]", after.encode()]
    )


def _column(answer: Answered, name: str) -> Array:
    column = answer.arrays[name]
    if column.dtype == np.float64 or column.dtype.kind in "iU":
        return column
    return np.array(answer.text[name], dtype=np.str_)


def _npz(columns: dict[str, Array], about: str) -> bytes:
    file = io.BytesIO()
    np.savez(file, allow_pickle=False, about=np.array(about), **columns)
    return file.getvalue()


def _parquet(columns: dict[str, Array], about: str) -> bytes:
    import pyarrow
    from pyarrow import parquet

    table = pyarrow.table({name: _arrow(column) for name, column in columns.items()})
    table = table.replace_schema_metadata({"force-diffusion": about})
    file = io.BytesIO()
    parquet.write_table(table, file)
    return file.getvalue()


def _arrow(column: Array) -> Any:
    import pyarrow

    if column.dtype.kind != "U":
        return pyarrow.array(column)
    words, places = np.unique(column, return_inverse=True)
    if len(words) < len(column) // 2:  # branches
        return pyarrow.DictionaryArray.from_arrays(pyarrow.array(places.astype(np.int32)), words)
    return pyarrow.array(column.tolist())
