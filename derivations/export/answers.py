"""An answer as files: ``result.json`` next to CSV, NPZ or Parquet, and the contents of each.

The columns are those of the answer. CSV and JSON have decimals with the digits that are known. NPZ
and Parquet hold float64 as it is, and numbers of longer arithmetics as decimals; all that is said
about the answer is in them, too, as JSON: in NPZ as ``about``, in Parquet as metadata of the
schema under ``force-diffusion``.
"""

import io
import json
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, get_args

from force_diffusion.numeric.arithmetic.errors import ForceDiffusionError

if TYPE_CHECKING:
    from force_diffusion.numeric.arithmetic.systems import Array
    from force_diffusion.numeric.tables import Answered

Format = Literal["csv", "npz", "parquet"]
"""How the rows of an answer are written."""


def check(written: Format, folder: Path | None) -> None:
    """Refuse a format that can't be written, before anything is solved."""
    if written != "csv" and folder is None:
        raise ForceDiffusionError(f"--format {written} writes files: give --out DIR, too")
    if written == "parquet":
        try:
            import pyarrow  # noqa: F401
        except ImportError:
            raise ForceDiffusionError(
                "--format parquet needs PyArrow, which is missing: "
                "pip install 'force-diffusion[tables]', or take npz"
            ) from None


def files_of(
    answers: "Sequence[Answered]", about: dict[str, Any], written: Format
) -> dict[str, bytes]:
    """Give the files of answers by name; ``about`` is all that JSON says of them but their rows."""
    from force_diffusion.numeric.tables import csv_bytes

    files = {f"{answer.quantity}.{written}": answer for answer in answers}
    if written == "csv":
        tables = {name: csv_bytes(answer.text) for name, answer in files.items()}
        return {"result.json": json_bytes(answers, about), **tables}
    about = about | {
        "results": {
            answer.quantity: {"file": name, "rows": answer.number_of_rows}
            for name, answer in files.items()
        }
    }
    text = json.dumps(about, indent=2) + "\n"
    encode = _npz if written == "npz" else _parquet
    tables = {name: encode(_columns(answer), text) for name, answer in files.items()}
    return {"result.json": text.encode(), **tables}


def names_of(quantities: Iterable[str]) -> list[str]:
    """Name all files that answers to these questions may have."""
    tables = (f"{name}.{written}" for name in quantities for written in get_args(Format))
    return ["result.json", *tables]


def json_bytes(answers: "Sequence[Answered]", about: dict[str, Any]) -> bytes:
    """Give all of some answers as JSON, each of their rows on a line."""
    from force_diffusion.numeric.tables import json_rows

    whole = json.dumps(about, indent=2).encode() + b"\n"
    at = whole.index(b'\n  "results": {\n')  # no string of JSON holds a line's end
    for answer in answers:
        rows = json_rows(answer.text, answer.whole_numbers)
        if rows:
            at = whole.index(f'\n    "{answer.quantity}": []'.encode(), at)
            at = whole.index(b"[]", at) + 1
            whole = whole[:at] + b"\n" + rows + b"\n    " + whole[at:]
    return whole


def _columns(answer: "Answered") -> "dict[str, Array]":
    """The columns; numbers that are neither whole nor float64 as decimals."""
    import numpy as np

    return {
        name: column
        if column.dtype == np.float64 or column.dtype.kind in "iU"
        else np.array(answer.text[name], dtype=np.str_)
        for name, column in answer.arrays.items()
    }


def _npz(columns: "dict[str, Array]", about: str) -> bytes:
    import numpy as np

    file = io.BytesIO()
    np.savez(file, allow_pickle=False, about=np.array(about), **columns)
    return file.getvalue()


def _parquet(columns: "dict[str, Array]", about: str) -> bytes:
    import pyarrow
    from pyarrow import parquet

    table = pyarrow.table(columns)
    table = table.replace_schema_metadata({"force-diffusion": about})
    file = io.BytesIO()
    parquet.write_table(table, file)
    return file.getvalue()
