"""Hypothesis strategies for small packings; they shrink to equal radii, few layers, and one place.

The base vectors are rational, and so is every first-order change.
"""

from fractions import Fraction

from hypothesis import strategies as st

from tests.soundness.witnesses.draws import SmallPacking


@st.composite
def directions(draw: st.DrawFn) -> tuple[Fraction, Fraction]:
    """A rational unit vector (n_x, n_y) with ½ < n_x < √3/2, φ of either sign."""
    half = draw(st.fractions(Fraction(3, 11), Fraction(4, 7), max_denominator=20))  # tan of half
    return 2 * half / (1 + half**2), (1 - half**2) / (1 + half**2)


@st.composite
def small_packings(draw: st.DrawFn) -> SmallPacking:
    """A packing of up to eight layers, one loaded bead, and contacts to look at.

    It is so wide that first-order formulas see no image.
    """
    height = draw(st.integers(2, 8))
    level = draw(st.integers(2, height))
    width = draw(st.integers(height + 1, height + 2))
    sites = [
        (across, layer) for layer in range(height + 1) for across in range(layer % 2, 2 * width, 2)
    ]
    radii = draw(st.lists(st.integers(-9, 9), min_size=len(sites), max_size=len(sites)))
    lower = st.sampled_from([site for site in sites if site[1] < height])
    return SmallPacking(
        width,
        height,
        draw(directions()),
        {site: Fraction(value) for site, value in zip(sites, radii, strict=True) if value},
        load=draw(st.builds(Fraction, st.integers(1, 9), st.integers(1, 9))),
        loaded=draw(st.sampled_from([site for site in sites if site[1] == level])),
        contacts=tuple(draw(st.lists(lower, min_size=1, max_size=3))),
    )
