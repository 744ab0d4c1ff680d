"""Variances in tall packings, extrapolated from nonlinear packings of a few layers.

Weights of the radii are polynomials in M and j, and so are sums of their squares; a polynomial is
known from its values in as many small packings as its degree asks for. That the degree is high
enough is seen in packings that are taller than those (``test_variances.py``).
"""

from collections.abc import Mapping
from fractions import Fraction
from functools import lru_cache
from itertools import product
from math import comb

from force_diffusion.symbolic import symbols as sy

from tests.properties.drawn import Geometry
from tests.properties.moments import Slab, moment
from tests.properties.packing import Number

VERTICAL = Fraction(1), Fraction(1)
RATIO = {
    "surface": 2 * sy.n_y * sy.ForcePlus(sy.i, sy.j) / sy.f_load,
    "bulk": 2 * sy.n_y * sy.ForcePlus(sy.i, sy.j) / (sy.m_g * (sy.M - sy.j)),
}
"""f⁺_ij/⟨f⟩."""
RESPONSE = (sy.VerticalPlus(sy.i, sy.j) + sy.VerticalMinus(sy.i, sy.j)) / sy.f_load
"""p/f_load of a bead, from both of its upper contacts."""


class Newton:
    """A polynomial in u and v, from its values at all u + v ≤ its degree."""

    def __init__(self, values: Mapping[tuple[int, int], Number]) -> None:
        self.differences = {
            (p, q): sum(
                (-1) ** (p - a + q - b) * comb(p, a) * comb(q, b) * values[a, b]
                for a, b in product(range(p + 1), range(q + 1))
            )
            for p, q in values
        }

    def __call__(self, u: int, v: int) -> Number:
        terms = self.differences.items()
        return sum(comb(u, p) * comb(v, q) * difference for (p, q), difference in terms)


def variance(geometry: Geometry, load: str, height: int, layer: int) -> Number:
    """σ_f²/⟨f⟩² of a layer for σ = 1, from nonlinear packings of this height."""
    slab = Slab(geometry, height, load, VERTICAL)
    return moment(slab, sy.Variance(RATIO[load]), {sy.i: layer, sy.j: layer, sy.sigma: 1})


@lru_cache(maxsize=64)
def _small(geometry: Geometry, load: str) -> Newton:
    places = [(u, v) for u in range(5) for v in range(5 - u)]
    return Newton({(u, v): (u + 2) * variance(geometry, load, 4 + u + v, 2 + v) for u, v in places})


def tall_variance(geometry: Geometry, load: str, height: int, layer: int) -> Number:
    """The same for any M, and 2 ≤ j ≤ M − 2, from packings of up to eight layers.

    Times M − j it is a polynomial of degree four in M and j: up to M − j bulk loads, which their
    number divides, are of degree one each, and squares are summed along a line.
    """
    u, v = height - layer - 2, layer - 2
    return _small(geometry, load)(u, v) / (height - layer)


@lru_cache(maxsize=64)
def _rounded(geometry: Geometry, load: str) -> Newton:
    """In floats, which are ten times as fast."""
    small = _small(geometry, load)
    return Newton({place: float(small(*place)) for place in small.differences})


@lru_cache(maxsize=1024)
def mean_variance(geometry: Geometry, load: str, height: int) -> float:
    """The mean over the layers 2 ≤ j ≤ M − 2, in floats; the three others are a share 3/M of it."""
    small, inner = _rounded(geometry, load), range(2, height - 1)
    total = sum(small(height - layer - 2, layer - 2) / (height - layer) for layer in inner)
    return total / len(inner)


def response(geometry: Geometry, level: int, layer: int, across: int) -> Number:
    """σ²(p)/f_load² of the bead so many columns to the right of the loaded one, for σ = 1."""
    slab = Slab(geometry, level, "point", VERTICAL)
    first = level % 2
    at = {sy.i: first + across, sy.j: layer, sy.k: first, sy.l: level, sy.sigma: 1}
    return moment(slab, sy.Variance(RESPONSE), at)


@lru_cache(maxsize=64)
def _responses(geometry: Geometry) -> Newton:
    starts = {(0, 0): (6, 3, 1), (1, 0): (7, 3, 0), (0, 1): (7, 4, 1)}
    return Newton({place: response(geometry, *at) for place, at in starts.items()})


def deep_response(geometry: Geometry, level: int, layer: int) -> Number:
    """The same inside the cone, three layers or more from the load and the base.

    It is linear in l and j: single radii along four lines, with weights that are the same for all.
    """
    return _responses(geometry)(level - layer - 3, layer - 3)
