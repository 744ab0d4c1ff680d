"""Hypothesis strategies for small packings; they shrink to equal radii and few layers."""

from fractions import Fraction

from force_diffusion.derivations.witnesses.draws import DIRECTIONS, SmallPacking
from hypothesis import strategies as st

rationals = st.builds(Fraction, st.integers(-9, 9), st.integers(1, 9))


@st.composite
def small_packings(draw: st.DrawFn, max_height: int = 5) -> SmallPacking:
    """A packing that is wider than high, one loaded bead, and contacts to look at."""
    height = draw(st.integers(2, max_height))
    width = height + draw(st.integers(1, 3))
    sites = [
        (across, layer) for layer in range(height + 1) for across in range(layer % 2, 2 * width, 2)
    ]
    lower = [site for site in sites if site[1] < height]
    return SmallPacking(
        width,
        height,
        draw(st.sampled_from(DIRECTIONS)),
        draw(st.dictionaries(st.sampled_from(sites), rationals)),
        load=draw(st.builds(Fraction, st.integers(1, 9), st.integers(1, 9))),
        loaded=draw(st.sampled_from([site for site in sites if site[1] >= 2])),
        contacts=tuple(draw(st.lists(st.sampled_from(lower), min_size=1, max_size=4))),
    )
