"""The stability table's promises, asserted on the table's own rows."""

from fractions import Fraction
from functools import cache

import numpy as np
import pytest
from force_diffusion.numeric.arithmetic.errors import ForceDiffusionError, UndecidedError
from force_diffusion.numeric.arithmetic.systems import Balls
from force_diffusion.numeric.studies import timing
from force_diffusion.numeric.studies.distances import answer
from force_diffusion.numeric.studies.stability import enclosures
from force_diffusion.numeric.studies.stability import stability as study
from force_diffusion.numeric.studies.stability.closed import closed_form_rows
from force_diffusion.numeric.studies.stability.enclosures import (
    LINE_SUMS,
    POSITIONS,
    Enclosure,
    Strip,
    enclose,
    strips,
)
from force_diffusion.numeric.studies.stability.floats import Case, Comparison, cases, measure
from force_diffusion.numeric.studies.stability.stability import stability
from force_diffusion.numeric.studies.stability.strips import strip
from force_diffusion.numeric.theory.expected import critical_height

UNIT = 2.0**-53  # of float64: one unit in the last place is at most 2 of these


@pytest.fixture(autouse=True)
def _one_run(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(timing, "ENOUGH_SECONDS", 0.0)
    monkeypatch.setattr(timing, "LEAST_RUNS", 1)


@cache
def rows(group: str) -> list[Comparison]:
    """Measure a group, once; the reference must be far better than what is measured by it."""
    found = [measure(case) for case in cases() if case.group == group]
    for row in found:
        assert row.ball_error is not None
        assert row.error is not None
        assert row.ball_error < 1e-6 * row.error
    return found


@cache
def enclosed(form: str, height: int, relative_std: str) -> Enclosure:
    return enclose(Strip(form, height, Fraction(relative_std)))


def lost(form: str, height: int, relative_std: str) -> float:
    found = enclosed(form, height, relative_std)
    assert found.bits_lost is not None
    return found.bits_lost


def test_float64_keeps_its_digits_at_every_disorder() -> None:
    """σ/r from 1e-2 to 1e-300: a few hundred units in the last place, the table says a few."""
    assert {row.relative_std for row in rows("disorder")} >= {1e-2, 1e-15, 1e-30, 1e-300}
    for row in rows("disorder"):
        assert row.error is not None
        assert row.error < 300 * UNIT


def test_the_plain_form_loses_them() -> None:
    for row in rows("disorder"):
        assert row.plain_error is not None
        # One rounding of positions of order 1 is already this much of a change of order σ/r.
        assert row.plain_error > min(0.05 * UNIT / row.relative_std, 0.5)
        if row.relative_std <= 1e-15:
            assert row.plain_error > 0.5  # no digit


def test_near_the_limits_of_the_spacing() -> None:
    for row in rows("spacing"):
        assert row.error is not None
        assert row.error < 300 * UNIT
    crowded = [row for row in rows("spacing") if row.relative_std == 1e-6]
    assert all(row.overlaps for row in crowded)


@pytest.mark.long
def test_errors_grow_slowly_with_the_height() -> None:
    """Up to 4096 layers: the float error grows no faster than √M, that of balls than M^(3/2)."""
    assert max(row.height for row in rows("height")) == 4096
    for row in rows("height"):
        assert row.error is not None
        assert row.error < 20 * UNIT * row.height**0.5
        assert row.ball_bits_lost is not None
        # Balls add up worst cases: M^(3/2) at most, and a constant from the operations of a bead.
        assert row.ball_bits_lost < 8 + 1.5 * (row.height.bit_length())


def test_beyond_the_critical_height_accuracy_is_reported() -> None:
    below, *beyond = rows("breakdown")
    assert below.tensile == 0
    assert all(row.tensile for row in beyond)
    bits = [row.ball_bits_lost for row in beyond]
    assert all(a is not None for a in bits)
    assert max(a for a in bits if a is not None) > 200  # exponential, and seen


def test_where_nothing_is_left_it_is_said() -> None:
    """Far beyond M* the enclosures burst or no packing exists: no number is given."""
    row = measure(Case("breakdown", 512, 16, Fraction(1, 100), bits=128))
    assert row.ball_error is None
    assert row.note


def test_closed_forms_in_float64_up_to_a_billion_layers() -> None:
    """A few roundings each, also where terms cancel: 16 half units in the last place."""
    heights = set()
    for row in closed_form_rows():
        heights.add(row.height)
        assert row.relative_error < 16 * UNIT
    assert max(heights) == 10**9


def test_positions_lose_a_constant_number_of_bits_a_layer() -> None:
    """A box around a bead holds the turned boxes of two supports.

    With half-widths (a, b) of a support's x and y, those of the bead are at least a + b n_y/n_x and
    b + a n_x/n_y, a matrix with eigenvalue 2: no evaluation in positions loses less than one bit a
    layer. The rate is the same at all heights, which is what exponential means; a tenth is left for
    the first layers.
    """
    first = (lost(POSITIONS, 64, "1e-4") - lost(POSITIONS, 16, "1e-4")) / 48
    then = (lost(POSITIONS, 256, "1e-4") - lost(POSITIONS, 64, "1e-4")) / 192
    assert first > 1
    assert abs(then / first - 1) < 0.1


@pytest.mark.parametrize(("low", "high"), [(4, 16), (16, 64), (64, 256)])
def test_line_sums_lose_a_power_of_the_height(low: int, high: int) -> None:
    """Far below M*: worst cases add up as M^(3/2) at most, which is 3 bits in 4 times the layers.

    M* is 2e5 layers here. One tenth of a bit is what the printed losses are rounded by, twice.
    """
    grown = lost(LINE_SUMS, high, "1e-8") - lost(LINE_SUMS, low, "1e-8")
    assert grown < 1.5 * 2 + 0.1


def test_line_sums_at_the_critical_height() -> None:
    """512 layers at σ/r = 1e-4, M* = 464: below 40 bits, where positions lose a bit a layer.

    23 bits are the power law's (8 + 1.5 · 10); the rest is room for the growth that sets in.
    """
    assert lost(LINE_SUMS, 512, "1e-4") < 40


def test_beyond_the_critical_height_line_sums_lose_exponentially_too() -> None:
    """There it is the packing that is unstable: half a bit a layer and more at σ/r = 1e-2."""
    assert enclosed(LINE_SUMS, 32, "1e-2").critical_height < 22
    beyond = (lost(LINE_SUMS, 64, "1e-2") - lost(LINE_SUMS, 32, "1e-2")) / 32
    below = (lost(LINE_SUMS, 64, "1e-8") - lost(LINE_SUMS, 32, "1e-8")) / 32
    assert beyond > 0.5 > 10 * below


@pytest.mark.parametrize(
    ("form", "height", "std"), [(POSITIONS, 64, "1e-4"), (LINE_SUMS, 64, "1e-2")]
)
def test_fifty_digits_are_left_and_hardly_more_bits_taken(form: str, height: int, std: str) -> None:
    found = enclosed(form, height, std)
    assert found.bits is not None
    assert found.error is not None
    assert found.bits_lost is not None
    assert 0 < found.error <= 1e-50
    needed = enclosures.GOAL + found.bits_lost
    assert needed <= found.bits <= 1.25 * (needed + enclosures.SPARE + 1)


def test_what_can_not_be_enclosed_is_said(monkeypatch: pytest.MonkeyPatch) -> None:
    falls = enclose(Strip(LINE_SUMS, 512, Fraction(1, 100)))
    assert falls.bits_lost is None
    assert falls.note.startswith("bead (")
    monkeypatch.setattr(enclosures, "MOST_BITS", 200)
    short = enclose(Strip(POSITIONS, 64, Fraction(1, 100)))
    assert (short.bits, short.error) == (None, None)
    assert "200 bits" in short.note


def test_wide_balls_are_undecided_not_unbuildable() -> None:
    """At 60 bits nothing is left of 64 layers in positions; the packing stands all the same."""
    plan = strip(64, 16, Fraction(1, 10**4), Fraction(3))
    with pytest.raises(UndecidedError):
        answer(plan, Balls(60), [0], plainly=True)


def test_the_table_goes_beyond_the_critical_height_in_both_forms() -> None:
    for form in (POSITIONS, LINE_SUMS):
        here = [strip for strip in strips() if strip.form == form]
        assert any(s.height > critical_height(s.relative_std) for s in here)
        assert any(s.height < critical_height(s.relative_std) / 10 for s in here)


def test_one_table_alone() -> None:
    told: list[str] = []
    found = stability(told.append, only=["closed_forms"])
    assert len(told) == len(found.rows("closed_forms"))
    heights = {row["height"] for row in found.rows("closed_forms")}
    worst = max(row["relative_error"] for row in found.rows("closed_forms"))
    assert f" {worst:.3g}" in str(found)
    assert len(str(found).splitlines()) == 2 + 4 * len(heights)  # the worst of each form
    assert [row["form"] for row in found.rows("closed_forms")] == found.arrays["closed_forms"][
        "form"
    ].tolist()
    with pytest.raises(ForceDiffusionError, match='needs the tables "rows" and "enclosures"'):
        found.plot()
    with pytest.raises(ForceDiffusionError, match='no table "balls"'):
        stability(only=["balls"])


def test_missing_numbers_are_nan(monkeypatch: pytest.MonkeyPatch) -> None:
    strip = enclosures.Strip(enclosures.LINE_SUMS, 512, Fraction(1, 100))
    monkeypatch.setattr(study, "strips", lambda: iter([strip]))
    found = stability(only=["enclosures"])
    assert found.rows("enclosures")[0]["bits"] is None  # no such strip stands
    assert np.isnan(found.arrays["enclosures"]["bits"]).all()
