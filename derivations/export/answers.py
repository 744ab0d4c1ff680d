"""An answer as files: ``result.json`` beside CSV, NPZ or Parquet, and what stands in each.

The columns are those of the answer. CSV and JSON have decimals with the digits that are known. NPZ
and Parquet hold float64 as it is, and numbers of longer arithmetics as decimals; all that is said
about the answer is in them, too, as JSON: in NPZ as ``about``, in Parquet as metadata of the
schema under ``force-diffusion``.
"""

import io
import json
from collections.abc import Iterable, Sequence
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
    def arrays(self) -> dict[str, Array]:
        """The columns as numbers."""

    @property
    def text(self) -> dict[str, list[str]]:
        """The columns as text."""

    @property
    def whole_numbers(self) -> list[str]:
        """Which columns are whole numbers."""


def rows_of(answer: Answered) -> int:
    """Count the rows."""
    return len(next(iter(answer.arrays.values()), ()))


def check(written: Format) -> None:
    """Raise ``ForceDiffusionError`` where a library is missing, before anything is solved."""
    if written == Format.PARQUET:
        try:
            import pyarrow  # noqa: F401
        except ImportError:
            raise ForceDiffusionError(
                "--format parquet needs PyArrow, which is missing: "
                "pip install 'force-diffusion[tables]', or take npz"
            ) from None


def files_of(
    answers: Sequence[Answered], about: dict[str, Any], written: Format
) -> dict[str, bytes]:
    """Give the files of answers by name; ``about`` is all that JSON says of them but their rows."""
    files = {f"{answer.quantity}.{written}": answer for answer in answers}
    if written == Format.CSV:
        tables = {name: csv_bytes(answer.text) for name, answer in files.items()}
        return {"result.json": json_bytes(answers, about), **tables}
    about = about | {
        "results": {
            answer.quantity: {"file": name, "rows": rows_of(answer)}
            for name, answer in files.items()
        }
    }
    text = json.dumps(about, indent=2) + "\n"
    made = {"result.json": text.encode()}
    for name, answer in files.items():
        columns = {column: _column(answer, column) for column in answer.arrays}
        made[name] = _npz(columns, text) if written == Format.NPZ else _parquet(columns, text)
    return made


def names_of(quantities: Iterable[str]) -> list[str]:
    """Name all files that answers to these questions may have."""
    return ["result.json", *(f"{name}.{written}" for name in quantities for written in Format)]


def json_bytes(answers: Sequence[Answered], about: dict[str, Any]) -> bytes:
    """Give all of some answers as JSON, each of their rows on a line."""
    whole = json.dumps(about, indent=2).encode() + b"\n"
    at = whole.index(b'\n  "results": {\n')  # no string of JSON holds a line's end
    for answer in answers:
        rows = json_rows(answer.text, answer.whole_numbers)
        if rows:
            at = whole.index(f'\n    "{answer.quantity}": []'.encode(), at)
            at = whole.index(b"[]", at) + 1
            whole = whole[:at] + b"\n" + rows + b"\n    " + whole[at:]
    return whole


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
