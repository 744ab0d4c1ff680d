"""Exact sums against fractions, in any order, any chunking and any tree of merges."""

import math
from fractions import Fraction

import numpy as np
import pytest
from force_diffusion.numeric.arithmetic.systems import Array
from force_diffusion.numeric.statistics.exact_sum import (
    ExactSum,
    digits,
    rows_and_squares,
    total,
    total_matrix,
    total_products,
)
from hypothesis import given
from hypothesis import strategies as st

# Every double there is, with the exponents that cutting treats on their own made likely.
NUMBERS = st.one_of(
    st.floats(allow_nan=False, allow_infinity=False),
    st.floats(-1, 1),
    st.builds(
        math.ldexp,
        st.floats(-1, 1),
        st.sampled_from([-1074, -1000, -997, -401, -400, -399, -1, 0, 399, 400, 401, 997, 1023]),
    ),
    st.sampled_from([1e-300, -1e300, 5e-324, 0.0, -0.0, 1.0]),
)
SAMPLES = st.lists(NUMBERS, min_size=1, max_size=40)


def sums(values: Array) -> tuple[ExactSum, ExactSum]:
    cut = digits(values)
    return total(cut, values.shape[:-1]), total_products(cut, cut, values.shape[:-1])


def exactly(values: Array) -> list[Fraction]:
    return [Fraction(float(v)) for v in values]


@given(SAMPLES)
def test_sums_are_those_of_fractions(samples: list[float]) -> None:
    values = np.array(samples)
    assert all((np.abs(q) <= 2**21).all() for _, q in digits(values))  # products then fit
    first, second = sums(values)
    assert first.fractions() == [sum(exactly(values))]
    assert rows_and_squares(values[None]) == (first.reshaped(1), second.reshaped(1))
    assert second.fractions() == [sum(v * v for v in exactly(values))]


@given(st.data(), SAMPLES)
def test_any_order_chunking_and_tree_gives_the_same_bytes(
    data: st.DataObject, samples: list[float]
) -> None:
    whole = sums(np.array(samples))
    shuffled = data.draw(st.permutations(samples))
    cuts = sorted(data.draw(st.sets(st.integers(1, len(samples)), max_size=6)) | {len(samples)})
    parts = [sums(np.array(shuffled[a:b])) for a, b in zip([0, *cuts], cuts, strict=False)]
    while len(parts) > 1:  # merge any two, until one is left
        a = parts.pop(data.draw(st.integers(0, len(parts) - 1)))
        b = parts.pop(data.draw(st.integers(0, len(parts) - 1)))
        parts.append((a[0] + b[0], a[1] + b[1]))
    assert [s.to_bytes() for s in parts[0]] == [s.to_bytes() for s in whole]
    assert parts[0] == whole


@given(st.lists(st.lists(NUMBERS, min_size=3, max_size=3), min_size=1, max_size=8))
def test_products_of_all_pairs(rows: list[list[float]]) -> None:
    values = np.array(rows)  # realisations, variables
    found = total_matrix(digits(values.T), 3).fractions()
    columns = [exactly(column) for column in values.T]
    pairs = [(a, b) for a in range(3) for b in range(a, 3)]
    meant = [sum(x * y for x, y in zip(columns[a], columns[b], strict=True)) for a, b in pairs]
    assert found == meant
    a, b = digits(values.T[:2]), digits(values.T[1:])
    assert total_products(a, b, (2,)).fractions() == [meant[1], meant[4]]


@given(SAMPLES)
def test_bytes_can_be_read_back(samples: list[float]) -> None:
    for one in sums(np.array([samples, samples[::-1]])):
        written = one.to_bytes()
        read, end = ExactSum.from_bytes(memoryview(written + b"rest"), (2,))
        assert (read, end) == (one, len(written))
        with pytest.raises(ValueError, match="ends early"):
            ExactSum.from_bytes(memoryview(written[:-1]), (2,))


@given(SAMPLES)
def test_rounding_is_close_and_knows_only_the_number(samples: list[float]) -> None:
    first, _ = sums(np.array(samples))
    (meant,) = first.fractions()
    if abs(meant) >= 2**1023 or 0 < abs(meant) < Fraction(2) ** -1022:
        return  # out of the range of normal doubles, which a shift avoids
    found = float(first.rounded())
    assert abs(Fraction(found) - meant) <= Fraction(math.ulp(found))
    more = first + ExactSum.of([(-70, np.array(0)), (60, np.array(0))], ())
    assert more.rounded().tobytes() == first.rounded().tobytes()


@given(SAMPLES)
def test_equal_numbers_have_equal_bytes_whatever_was_added(samples: list[float]) -> None:
    first, second = sums(np.array(samples))
    for one in (first, second, first + second):
        assert not len(one.limbs) or (one.limbs[0].any() and one.limbs[-1].any())
    nothing, _ = sums(np.array([*samples, *(-v for v in samples)]))
    assert nothing == ExactSum.zero()
    assert nothing.to_bytes() == ExactSum.zero().to_bytes()


@given(SAMPLES, SAMPLES)
def test_each_row_has_its_own_sum(one: list[float], other: list[float]) -> None:
    values = np.zeros((2, max(len(one), len(other))))
    values[0, : len(one)], values[1, : len(other)] = one, other
    both = total(digits(values), (2,))
    assert both.fractions() == [sum(exactly(row)) for row in values]
    first = both.reshaped(1, 2)
    assert first.over(1).fractions() == [sum(exactly(values.reshape(-1)))]
    assert first.over(0) == both
    assert (first.over(1) == ExactSum.zero(1)) == (not any(first.over(1).fractions()))
    assert both != (0, both.limbs)


@given(SAMPLES, st.sampled_from([-300, -7, 3, 300]))
def test_rounding_takes_a_power_of_two_along(samples: list[float], shift: int) -> None:
    values = np.array([v for v in samples if 1e-200 < abs(v) < 1e200] or [1.0])
    found = float(total(digits(values), ()).rounded(shift))
    meant = sum(exactly(values)) * Fraction(2) ** shift
    assert abs(Fraction(found) - meant) <= Fraction(math.ulp(found))


def test_pairs_of_whole_numbers_and_of_nothing_but_zeros() -> None:
    ones = np.ones((2, 5))
    assert total_matrix(digits(ones), 2).fractions() == [5, 5, 5]
    assert total_matrix(digits(0 * ones), 2).fractions() == [0, 0, 0]
    assert total(digits(0 * ones), (2,)) == ExactSum.zero(2)
    assert total(digits(np.zeros((2, 0))), (2,)) == ExactSum.zero(2)


def test_many_of_the_largest_digits_do_not_overflow() -> None:
    values = np.full((1, 100_000), 2.0**53 - 1)
    first, second = sums(values)
    assert first.fractions() == [100_000 * (2**53 - 1)]
    assert second.fractions() == [100_000 * (2**53 - 1) ** 2]
    assert total_matrix(digits(values), 1) == second
    by_row = rows_and_squares(values.reshape(8, -1))
    assert [by_row[0].over(0), by_row[1].over(0)] == [s.reshaped() for s in (first, second)]
    assert (second + second).over(0).fractions() == [200_000 * (2**53 - 1) ** 2]


@pytest.mark.parametrize("odd", [math.nan, math.inf, -math.inf])
def test_what_is_not_finite_is_refused(odd: float) -> None:
    with pytest.raises(ArithmeticError, match="not finite"):
        digits(np.array([1.0, odd]))


def test_digits_beyond_their_range_are_refused() -> None:
    for digit, good in ((-(2**21), True), (2**21 - 1, True), (2**21, False), (-(2**21) - 1, False)):
        written = memoryview(ExactSum(0, np.array([digit])).to_bytes())
        if good:
            assert ExactSum.from_bytes(written, ())[0].fractions() == [digit]
        else:
            with pytest.raises(ValueError, match="digits"):
                ExactSum.from_bytes(written, ())


def test_damaged_digits_are_refused() -> None:
    written = bytearray(sums(np.array([1.0, 2.0]))[0].to_bytes())
    written[-1] = 0x7F
    with pytest.raises(ValueError, match="digits"):
        ExactSum.from_bytes(memoryview(bytes(written)), ())
