"""Generated closed forms: as the derivations give them, exact on fractions, accurate in float64."""

from collections.abc import Iterator
from fractions import Fraction
from inspect import signature
from itertools import product
from typing import Any

import flint
import mpmath
import numpy as np
import pytest
from force_diffusion.derivations.export import generate_closed_forms as generator
from force_diffusion.numeric import closed_forms
from hypothesis import given
from hypothesis import strategies as st

import force_diffusion as fd

ONE = Fraction(1)
OF_CONTACTS = {
    "surface_variance": (13, "layer"),
    "bulk_variance": (14, "layer"),
    "surface_variance_at_angle": ("B2", "plus"),
    "bulk_variance_at_angle": ("B3", "plus"),
    "surface_variance_of_spheres": ("B13", "first"),
    "bulk_variance_of_spheres": ("B14", "first"),
    "surface_mean_shift": ("B5", "force"),
    "bulk_mean_shift": ("B6", "force"),
}
"""The equation and the name of each; tests/derivations/calculator certifies these."""
LEADING = {
    "surface_diffusion": (13, "surface_variance"),
    "bulk_diffusion": (14, "bulk_variance"),
    "surface_diffusion_of_spheres": ("B13", "surface_variance_of_spheres"),
    "bulk_diffusion_of_spheres": ("B14", "bulk_variance_of_spheres"),
}
GIVEN = {"phi": Fraction(2, 7), "sigma": Fraction(1, 3), "r": Fraction(2)}


@pytest.mark.long
def test_the_file_is_what_the_derivations_generate():
    written = generator.TARGET.read_text(encoding="utf-8")
    assert written == generator.source(), (
        "run python -m force_diffusion.derivations.export.generate_closed_forms"
    )


def places(name: str) -> Iterator[dict[str, Any]]:
    """All contacts of small packings."""
    top = range(1, 7)
    ratios = [ONE / 3, ONE * 2] if name.endswith("at_angle") else [ONE]
    for M, j, t in product(top, top, ratios):
        if j <= M:
            yield {"M": M, "j": j - 1, "t": t}


@pytest.mark.long(sample=7)
@pytest.mark.parametrize("name", OF_CONTACTS)
def test_they_are_the_exact_forms(name):
    number, of = OF_CONTACTS[name]
    form, function = fd.equation(number).exact(of), getattr(closed_forms, name)
    for place in places(name):
        at = place | GIVEN
        value = function(**{key: at[key] for key in signature(function).parameters})
        assert value == form.at(**{key: at[key] for key in form.symbols})


@pytest.mark.parametrize("name", LEADING)
def test_leading_orders_are_those_of_tall_packings(name):
    number, exact = LEADING[name]
    M, j = 10**9, 4 * 10**8
    leading = getattr(closed_forms, name)(M, Fraction(j, M), **GIVEN)
    assert abs(getattr(closed_forms, exact)(M, j, **GIVEN) / leading - 1) < Fraction(20, M)
    if isinstance(number, int):
        assert leading == fd.equation(number).at(M=M, j=j, **GIVEN)


# float64

heights = st.one_of(st.integers(1, 40), st.integers(1, 10**9))
cosines = st.fractions(Fraction(-49, 100), Fraction(49, 100), max_denominator=1000)


@given(height=heights, phi=cosines, data=st.data())
@pytest.mark.parametrize("name", ["surface_variance", "bulk_variance", *LEADING])
def test_float64_is_accurate(name, height, phi, data):
    near = st.integers(0, min(height, 9) - 1)
    j = data.draw(st.one_of(near, near.map(lambda k: height - 1 - k), st.integers(0, height - 1)))
    at = {"M": height, "j": j, "z": Fraction(j / height)}
    function = getattr(closed_forms, name)
    where = [at[key] for key in list(signature(function).parameters)[:-3]]
    exact = function(*where, Fraction(float(phi)), ONE, ONE)
    rounded = [float(value) if isinstance(value, Fraction) else value for value in where]
    result = Fraction(function(*rounded, float(phi), 1.0, 1.0))
    # about 40 roundings, the least favourable, at M = 3, j = 1 or (1+φ)² near φ = −½, enlarged
    # fivefold to tenfold by mild cancellation
    assert abs(result - exact) <= 200 * Fraction(2) ** -53 * exact


EVERY = [getattr(closed_forms, name) for name in ("surface_variance", "bulk_variance", *LEADING)]
every = pytest.mark.parametrize("form", EVERY, ids=lambda form: form.__name__)


@pytest.mark.parametrize("kind", [np.int64, np.int32, float, Fraction, mpmath.mpf])
@every
def test_whole_numbers_of_any_type_do_not_overflow(form, kind):
    phi = Fraction(1, 3)
    exact = form(10**9, 1, phi, ONE, ONE)
    assert form(kind(10**9), kind(1), phi, ONE, ONE) == exact
    zero = kind(0)
    assert form(10**9, zero, zero, 1.0, 1.0) == pytest.approx(
        float(form(10**9, 0, Fraction(0), ONE, ONE)), rel=1e-14
    )


@pytest.mark.parametrize("kind", [float, np.float64, np.float32, Fraction, mpmath.mpf, flint.arb])
@every
def test_the_result_is_of_the_type_of_phi(form, kind):
    quarter, one, two = kind(1) / kind(4), kind(1), kind(2)
    value = form(10**9, 1, quarter, one, two)
    assert type(value) is type(quarter)
    if "z" not in signature(form).parameters:
        exact = form(10**9, 1, Fraction(1, 4), ONE, Fraction(2))
        assert float(value) == pytest.approx(float(exact), rel=1e-5)


REFUSED: list[tuple[str, tuple[Any, ...], str]] = [
    *(("bulk_variance", (5, j), "j = .*allowed") for j in (-1, 5, 2.5, "2", None, [1, 2])),
    *(("surface_variance", (M, 0), "M = .* is allowed") for M in (0, 4.5, np.array([5]))),
    *(("bulk_diffusion", (M, 0), "M = .* is allowed") for M in (-3, float("inf"))),
    *(("surface_diffusion", (5, z), "z = .* is allowed") for z in (-0.1, 2, float("nan"))),
    ("bulk_diffusion", (5, np.array([0.1, 0.2])), "z = .* is allowed"),
    ("response", (4, -2), "j = -2: one whole number from 0 up"),
    ("response", (float("nan"), 2), "l = nan"),
]


@pytest.mark.parametrize(("name", "at", "says"), REFUSED)
def test_what_is_not_allowed_is_named(name, at, says):
    with pytest.raises(ValueError, match=says):
        getattr(closed_forms, name)(*at, 0.1, 1.0, 1.0)
