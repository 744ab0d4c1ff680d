"""Columns as text: what Python would write number by number."""

import csv
import io
import json
import math

import numpy as np
import pytest
from force_diffusion.numeric import tables
from hypothesis import given
from hypothesis import strategies as st

NUMBERS = st.one_of(
    st.floats(),
    st.integers(-400, 400).map(lambda k: float(f"1e{k}")),
    st.tuples(st.integers(-(10**18), 10**18), st.integers(-40, 20)).map(
        lambda pair: float(f"{pair[0]}e{pair[1]}")
    ),
    st.integers(-10_000, 10_000).map(lambda k: k / 16),  # ties
)


@given(st.lists(st.tuples(NUMBERS, st.integers(1, 17)), max_size=40))
def test_numbers_are_those_of_python(pairs: list[tuple[float, int]]) -> None:
    values = np.array([value for value, _ in pairs], dtype=np.float64)
    digits = np.array([count for _, count in pairs], dtype=np.int64)
    expected = [f"{value:.{count}g}" for value, count in pairs]
    assert tables.strings(tables.significant(values, digits)) == expected


@pytest.mark.parametrize("count", [0, 1, 8191, 8192, 8193, 30_000])
def test_blocks_are_put_together(count: int) -> None:
    values = np.random.default_rng(5).normal(0, 1e-3, count)
    digits = np.random.default_rng(6).integers(1, 18, count)
    expected = [f"{v:.{d}g}" for v, d in zip(values.tolist(), digits.tolist(), strict=True)]
    assert tables.strings(tables.significant(values, digits)) == expected
    assert tables.strings(tables.text_of(np.arange(count) - 7)) == [
        str(k - 7) for k in range(count)
    ]


@given(st.lists(st.tuples(st.integers(-(10**12), 10**12), st.sampled_from("+-"), st.floats())))
def test_rows_are_those_of_the_libraries(rows: list[tuple[int, str, float]]) -> None:
    names = ["i", "branch", "force"]
    columns = {name: [row[n] for row in rows] for n, name in enumerate(names)}
    written = {
        "i": tables.text_of(np.array(columns["i"], dtype=np.int64)),
        "branch": tables.text_of(columns["branch"]),
        "force": tables.significant(
            np.array(columns["force"], dtype=float), np.full(len(rows), 17)
        ),
    }
    file = csv.DictReader(io.StringIO(tables.csv_bytes(written).decode()))
    read = list(file)
    assert file.fieldnames == names  # also where there is no row
    same = [{"i": int(r["i"]), "branch": r["branch"], "force": float(r["force"])} for r in read]
    objects = json.loads(b"[" + tables.json_rows(written, ["i"]) + b"]")
    for found in (same, [one | {"force": float(one["force"])} for one in objects]):
        assert len(found) == len(rows)
        for one, (i, branch, force) in zip(found, rows, strict=True):
            assert (one["i"], one["branch"]) == (i, branch)
            assert one["force"] == force or math.isnan(force)
