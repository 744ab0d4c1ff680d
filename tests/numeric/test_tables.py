"""Columns as text: what Python would write number by number."""

import csv
import io
import json
import math
from fractions import Fraction

import numpy as np
from force_diffusion.numeric import tables
from force_diffusion.numeric.accuracy import known_digits
from hypothesis import assume, given
from hypothesis import strategies as st


@given(st.floats(), st.integers(1, 17))
def test_numbers_are_those_of_python(value, digits):
    (text,) = tables.significant(np.array([value]), np.array([digits]))
    assert text == ("" if math.isnan(value) else f"{value:.{digits}g}")


@given(st.floats(-1e200, 1e200), st.floats(2.0**-52, 1e3))
def test_printing_takes_half_of_the_stated_error(value, ratio):
    """Of a change: the other half is what the number itself may be off."""
    error = abs(value) * ratio
    assume(error > 1e-290)
    (text,) = known_digits(np.array([value]), error)
    assert abs(Fraction(text) - Fraction(value)) <= Fraction(error) / 2 * (1 + Fraction(1, 10**15))


@given(st.lists(st.tuples(st.integers(-(10**12), 10**12), st.sampled_from("+-"), st.floats())))
def test_rows_are_those_of_the_libraries(rows):
    names = ["i", "branch", "force"]
    columns = {name: [row[n] for row in rows] for n, name in enumerate(names)}
    written = {
        "i": tables.text_of(np.array(columns["i"], dtype=np.int64)),
        "branch": columns["branch"],
        "force": tables.significant(np.array(columns["force"], float), np.full(len(rows), 17)),
    }
    file = csv.DictReader(io.StringIO(tables.csv_bytes(written).decode()))
    read = list(file)
    assert file.fieldnames == names  # also where there is no row
    same = [
        {"i": int(r["i"]), "branch": r["branch"], "force": float(r["force"] or "nan")} for r in read
    ]
    objects = json.loads(b"[" + tables.json_rows(written, ["i"]) + b"]")
    for records in (same, [row | {"force": float(row["force"] or "nan")} for row in objects]):
        assert len(records) == len(rows)
        for row, (i, branch, force) in zip(records, rows, strict=True):
            assert (row["i"], row["branch"]) == (i, branch)
            assert row["force"] == force or math.isnan(force)
