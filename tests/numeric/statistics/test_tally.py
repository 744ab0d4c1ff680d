"""The compiled sums and counts: bitwise NumPy's; and how far both are from exact sums."""

import math
from fractions import Fraction

import numpy as np
import pytest
from force_diffusion.numeric.arithmetic.systems import Array
from force_diffusion.numeric.statistics.moments import by_halves
from hypothesis import given
from hypothesis import strategies as st

FLOATS = st.floats(-1e3, 1e3) | st.floats(-1e-150, 1e-150)
UNIT = 2.0**-52


@given(st.lists(FLOATS, min_size=1, max_size=300))
def test_halves_are_exact_but_for_the_logarithm_of_their_number(values: list[float]) -> None:
    """Each number passes one addition a halving, and one or two where a number is left over."""
    exact = sum(map(Fraction, values))
    size = math.fsum(map(abs, values))
    allowed = (2 * math.log2(len(values)) + 1) * UNIT / 2 * size
    assert abs(Fraction(float(by_halves(np.array(values)))) - exact) <= allowed


def test_other_axes_decide_no_bit() -> None:
    values = np.random.default_rng(1).standard_normal((3, 4, 101))
    alone = [[by_halves(one.copy()) for one in part] for part in values]
    assert by_halves(values).tolist() == np.array(alone).tolist()
    assert by_halves(values.transpose(1, 0, 2)).tolist() == np.array(alone).T.tolist()
    assert by_halves(values[..., ::2]).tolist() == by_halves(values[..., ::2].copy()).tolist()


@st.composite
def numbers(draw: st.DrawFn) -> Array:
    """Give packings of numbers on two branches, (packings, 2, …)."""
    packings, count = draw(st.integers(1, 3)), draw(st.integers(1, 40))
    few = draw(st.lists(FLOATS, min_size=1, max_size=40))
    places = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    return places.choice(few, (packings, 2, count))


@given(numbers(), st.integers(-3, 3), st.integers(1, 9), st.data())
def test_compiled_sums_and_counts_are_those_of_numpy(
    g: Array, unit: int, bins: int, data: st.DataObject
) -> None:
    pytest.importorskip("numba")
    from force_diffusion.numeric.statistics.tally import tally

    packings, _, size = g.shape
    cut = data.draw(st.integers(0, size))
    blocks = [(k, *ends) for k in (0, 1) for ends in ((0, cut), (cut, size)) if ends[0] < ends[1]]
    edges = np.linspace(-100, 100, bins + 1) if data.draw(st.booleans()) else np.zeros(0)
    sums, negative = np.empty((packings, 2, len(blocks))), np.empty((packings, len(blocks)), int)
    counts = np.zeros((packings, len(edges) and bins + 2), int)
    F = np.random.default_rng(size).choice([0.0, 1e-200, 1.0, 1e3], (2, size))
    tally(g, F, np.array(blocks), 2.0**unit, edges, sums, negative, counts)
    for p, (branch, start, stop) in enumerate(blocks):
        own = g[:, branch, start:stop]
        scaled = own * 2.0**unit
        assert sums[:, 0, p].tolist() == by_halves(scaled).tolist()
        assert sums[:, 1, p].tolist() == by_halves(scaled * scaled).tolist()
        assert negative[:, p].tolist() == (F[branch, start:stop] + own < 0).sum(axis=1).tolist()
    if len(edges):
        limits = [-np.inf, *edges, np.inf]  # np.histogram closes the last bin; none ends there
        meant = [np.histogram(one, limits)[0].tolist() for one in g]
        assert counts.tolist() == meant
