"""Generated closed forms: as the derivations give them, exact on fractions, accurate in float64."""

from collections.abc import Iterator
from fractions import Fraction
from inspect import signature
from itertools import product
from typing import Any

import pytest
from force_diffusion.derivations.export import generate_closed_forms as generator
from force_diffusion.numeric import closed_forms
from hypothesis import given
from hypothesis import strategies as st

import force_diffusion as fd

ONE = Fraction(1)
OF_CONTACTS = {
    "surface_variance_at_angle": ("B2", "plus"),
    "bulk_variance_at_angle": ("B3", "plus"),
    "surface_variance_of_spheres": ("B13", "first"),
    "bulk_variance_of_spheres": ("B14", "first"),
    "surface_mean_shift": ("B5", "force"),
    "bulk_mean_shift": ("B6", "force"),
}
"""The equation and the name of each; tests/derivations/calculator certifies these."""
LEADING = {
    "surface_diffusion": (13, "surface_variance_at_angle"),
    "bulk_diffusion": (14, "bulk_variance_at_angle"),
    "surface_diffusion_of_spheres": ("B13", "surface_variance_of_spheres"),
    "bulk_diffusion_of_spheres": ("B14", "bulk_variance_of_spheres"),
}
GIVEN = {"phi": Fraction(2, 7), "sigma": 1, "r": 1}


def called(name: str, **numbers: Any) -> Any:
    """Call a function with those of these numbers that it takes; k is M − j."""
    function = getattr(closed_forms, name)
    numbers = {"t": 1, "k": numbers["M"] - numbers["j"], **numbers}
    return function(**{key: numbers[key] for key in signature(function).parameters})


@pytest.mark.long
def test_the_file_is_what_the_derivations_generate():
    written = generator.TARGET.read_text(encoding="utf-8")
    assert written == generator.source(), (
        "run python -m force_diffusion.derivations.export.generate_closed_forms"
    )


def places(name: str) -> Iterator[dict[str, Any]]:
    """All contacts of small packings."""
    top = range(1, 7)
    ratios = [ONE / 3, ONE, ONE * 2] if name.endswith("at_angle") else [ONE]
    for M, j, t in product(top, top, ratios):
        if j <= M:
            yield {"M": M, "j": j - 1, "t": t}


@pytest.mark.long(sample=6)
@pytest.mark.parametrize("name", OF_CONTACTS)
def test_they_are_the_exact_forms(name):
    number, of = OF_CONTACTS[name]
    form = fd.equation(number).exact(of)
    for place in places(name):
        at = place | GIVEN
        assert called(name, **at) == form.at(**{key: at[key] for key in form.symbols})


@pytest.mark.parametrize("name", LEADING)
def test_leading_orders_are_those_of_tall_packings(name):
    number, exact = LEADING[name]
    M, j = 10**9, 4 * 10**8
    at = {"M": M, "j": j, **GIVEN}
    leading = called(name, z=Fraction(j, M), **at)
    assert abs(called(exact, **at) / leading - 1) < Fraction(20, M)
    if isinstance(number, int):
        assert leading == fd.equation(number).at(**at)


def test_the_printed_response():
    at = {"j": 3, "l": 7, **GIVEN}
    assert closed_forms.response(3, 7, GIVEN["phi"]) == fd.equation(16).at(**at)


# float64

heights = st.one_of(st.integers(1, 40), st.integers(1, 10**9))
cosines = st.fractions(Fraction(-49, 100), Fraction(49, 100), max_denominator=1000)


@given(height=heights, phi=cosines, data=st.data())
@pytest.mark.parametrize("name", ["surface_variance_at_angle", "bulk_variance_at_angle", *LEADING])
def test_float64_is_accurate(name, height, phi, data):
    near = st.integers(0, min(height, 9) - 1)
    j = data.draw(st.one_of(near, near.map(lambda k: height - 1 - k), st.integers(0, height - 1)))
    z, at = j / height, {"M": height, "j": j}
    exact = called(name, z=Fraction(z), phi=Fraction(float(phi)), **at)
    result = Fraction(called(name, z=z, phi=float(phi), **at))
    # about 40 roundings, the least favourable, at M = 3, j = 1 or (1+φ)² near φ = −½, enlarged
    # fivefold to tenfold by mild cancellation
    assert abs(result - exact) <= 200 * Fraction(2) ** -53 * exact
