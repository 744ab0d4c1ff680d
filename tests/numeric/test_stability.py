"""The stability table's promises, asserted on the table's own rows."""

from fractions import Fraction

import pytest

from numeric.stability import Case, Row, cases, closed_form_rows, measure

UNIT = 2.0**-53  # of float64: one unit in the last place is at most 2 of these


@pytest.fixture(scope="module")
def rows() -> dict[str, list[Row]]:
    found: dict[str, list[Row]] = {}
    for case in cases():
        found.setdefault(case.group, []).append(measure(case))
    return found


def test_float64_keeps_its_digits_at_every_disorder(rows: dict[str, list[Row]]) -> None:
    """σ/r from 1e-2 to 1e-300: a few hundred units in the last place, the table says a few."""
    assert {row.relative_std for row in rows["disorder"]} >= {1e-2, 1e-15, 1e-30, 1e-300}
    for row in rows["disorder"]:
        assert row.error is not None
        assert row.error < 300 * UNIT


def test_the_plain_form_loses_them(rows: dict[str, list[Row]]) -> None:
    for row in rows["disorder"]:
        assert row.plain_error is not None
        # One rounding of positions of order 1 is already this much of a change of order σ/r.
        assert row.plain_error > min(0.05 * UNIT / row.relative_std, 0.5)
        if row.relative_std <= 1e-15:
            assert row.plain_error > 0.5  # no digit


def test_the_reference_is_far_better_than_what_it_measures(rows: dict[str, list[Row]]) -> None:
    for group in rows.values():
        for row in group:
            assert row.ball_error is not None
            assert row.error is not None
            assert row.ball_error < 1e-6 * row.error


def test_near_the_limits_of_the_spacing(rows: dict[str, list[Row]]) -> None:
    for row in rows["spacing"]:
        assert row.error is not None
        assert row.error < 300 * UNIT
    crowded = [row for row in rows["spacing"] if row.relative_std == 1e-6]
    assert all(row.overlaps for row in crowded)


def test_errors_grow_slowly_with_the_height(rows: dict[str, list[Row]]) -> None:
    """Up to 4096 layers: the float error grows no faster than √M, that of balls than M^(3/2)."""
    assert max(row.height for row in rows["height"]) == 4096
    for row in rows["height"]:
        assert row.error is not None
        assert row.error < 20 * UNIT * row.height**0.5
        assert row.ball_bits_lost is not None
        # Balls add up worst cases: M^(3/2) at most, and a constant from the operations of a bead.
        assert row.ball_bits_lost < 8 + 1.5 * (row.height.bit_length())


def test_beyond_the_critical_height_accuracy_is_reported(rows: dict[str, list[Row]]) -> None:
    below, *beyond = rows["breakdown"]
    assert below.tensile == 0
    assert all(row.tensile for row in beyond)
    lost = [row.ball_bits_lost for row in beyond]
    assert all(a is not None for a in lost)
    assert max(a for a in lost if a is not None) > 200  # exponential, and seen


def test_units_change_no_digit(rows: dict[str, list[Row]]) -> None:
    small, one, large = rows["units"]
    for other in (small, large):
        assert (other.error, other.plain_error) == (one.error, one.plain_error)


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
