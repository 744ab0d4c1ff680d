"""Hypothesis strategies for small packings; they shrink towards few beads, one radius, one load."""

from dataclasses import dataclass
from fractions import Fraction

from force_diffusion.numeric.lattice.layers import whole
from hypothesis import strategies as st

# Pythagorean directions with 1/2 < n_x < √3/2: the ordered packing is rational.
DIRECTIONS = [
    (Fraction(a, c), Fraction(b, c))
    for a, b, c in [(3, 4, 5), (4, 3, 5), (20, 21, 29), (21, 20, 29), (33, 56, 65), (56, 33, 65)]
    if Fraction(1, 4) < Fraction(a, c) ** 2 < Fraction(3, 4)
]


@dataclass(frozen=True)
class Case:
    """A small periodic packing with rational radii δr/r = ε ρ and rational loads."""

    width: int
    height: int
    n: tuple[Fraction, Fraction]
    rho: dict[tuple[int, int], Fraction]
    loads: dict[tuple[int, int], tuple[Fraction, Fraction]]


def sites(width: int, height: int) -> list[tuple[int, int]]:
    """All sites (i, j) of a periodic packing, layer by layer."""
    return [(i, layer.j) for layer in whole(width, height).rows for i in layer.sites()]


def fractions(bound: int) -> st.SearchStrategy[Fraction]:
    return st.builds(Fraction, st.integers(-bound, bound), st.integers(1, 6))


@st.composite
def cases(draw: st.DrawFn, max_height: int = 5, max_width: int = 7) -> Case:
    width = draw(st.integers(1, max_width))
    height = draw(st.integers(1, max_height))
    places = st.sampled_from(sites(width, height))
    loaded = [s for s in sites(width, height) if s[1]]
    return Case(
        width,
        height,
        draw(st.sampled_from(DIRECTIONS)),
        draw(st.dictionaries(places, fractions(6), max_size=width * (height + 1))),
        draw(
            st.dictionaries(
                st.sampled_from(loaded),
                st.tuples(fractions(4), fractions(4)),
                min_size=1,
                max_size=6,
            )
        ),
    )
