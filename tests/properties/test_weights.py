"""Eq. 12: the weights of the second differences Δ, to leading order in the height."""

from fractions import Fraction

import sympy
from force_diffusion.symbolic.symbols import Variance, i, j, sigma
from hypothesis import given
from hypothesis import strategies as st

from tests.properties.drawn import FEWER, GEOMETRY, Geometry, geometries, lengths
from tests.properties.moments import ACCURATE, Slab, moment, read
from tests.properties.orders import ROUNDING, printed
from tests.properties.packing import mp

Place = tuple[int, int]
"""M and j."""

Line = tuple[Geometry, Fraction, tuple[Place, ...]]
"""φ and r, half the load on a bead, and four contacts at equal distances, 2 ≤ j ≤ M − 2."""

LINES: tuple[tuple[Place, Place], ...] = (((4, 2), (1, 0)), ((4, 2), (1, 1)), ((7, 2), (0, 1)))
"""Along each coordinate, and along both at once."""


def contacts(start: Place, along: Place) -> tuple[Place, ...]:
    (height, layer), (up, by) = start, along
    return tuple((height + t * up, layer + t * by) for t in range(4))


lines = st.tuples(geometries, lengths, st.sampled_from([contacts(*line) for line in LINES]))


def leaves_out_order_two(equation: sympy.Eq, line: Line) -> None:
    """The mean is the same, and of the variance an order of M is left out.

    The variance of what is left out is a polynomial in M and j of degree two, while that of the
    force is one of degree three: along a line its third difference vanishes.
    """
    geometry, load, contacts = line
    left, right = equation.args
    rest = sympy.Add(left, sympy.Mul(-1, right, evaluate=False), evaluate=False)

    def slab(height: int) -> Slab:
        return Slab(geometry, height, "surface", (load, load))

    height, layer = contacts[0]
    mean = read(slab(height), rest, {i: layer, j: layer}, 0, mp.mpf(0), (0,))
    assert abs(mean) <= ROUNDING, "the mean is another"
    a, b, c, d = (
        moment(slab(height), Variance(rest), {i: layer, j: layer, sigma: 1})
        for height, layer in contacts
    )
    third = d - 3 * c + 3 * b - a
    assert abs(third) < ACCURATE, f"what is left out has a third difference, {mp.nstr(third, 5)}"


FIXED = [(GEOMETRY, Fraction(5, 3), contacts(*line)) for line in LINES]
CHECKS = {12: (leaves_out_order_two, FIXED)}


@FEWER
@given(lines)
def test_eq_12_leaves_out_one_order_of_the_height(line):
    for equation in printed(12):
        leaves_out_order_two(equation, line)
