"""Generated closed forms: as the derivations give them, exact on fractions, accurate in float64."""

from collections.abc import Callable
from fractions import Fraction
from itertools import product
from typing import Any

import flint
import mpmath
import numpy as np
import pytest
import sympy
from force_diffusion.derivations import eq13_surface_diffusion as eq13
from force_diffusion.derivations import eq14_bulk_diffusion as eq14
from force_diffusion.derivations.export import generate_closed_forms as generator
from force_diffusion.numeric import closed_forms
from force_diffusion.symbolic import symbols as sy
from hypothesis import given
from hypothesis import strategies as st

import force_diffusion as fd
from tests.soundness.witnesses.moments import DIRECTIONS, Packing, exact

ONE = Fraction(1)
EXACT = {"surface": closed_forms.surface_variance, "bulk": closed_forms.bulk_variance}


def test_the_file_is_what_the_derivations_generate() -> None:
    written = generator.TARGET.read_text(encoding="utf-8")
    assert written == generator.source(), (
        "run python -m force_diffusion.derivations.export.generate_closed_forms"
    )


def of_packing(
    number: int | str, name: str, load: str, height: int, layer: int, n: Any,
    ratio: Fraction = Fraction(1), count: int = 1,
) -> flint.fmpq:  # fmt: skip
    """What a closed form stands for, in an exact packing, for r = σ = 1."""
    at = {sy.i: layer % 2, sy.j: layer, sy.N: count}
    packing = Packing(height, n, load, ratio, at)
    return packing.moment(fd.equation(number).exact(name).statistic)


@pytest.mark.parametrize("load", EXACT)
@pytest.mark.parametrize("height", range(1, 9))
def test_exact_variance_is_that_of_exact_packings(load: str, height: int) -> None:
    """The same sums with weights that the nonlinear packing gives, nothing symbolic in them."""
    number = {"surface": 13, "bulk": 14}[load]
    for n, layer in product(DIRECTIONS[:2], range(height)):
        phi = n[1] ** 2 - n[0] ** 2
        true = of_packing(number, "layer", load, height, layer, n)
        assert exact(EXACT[load](height, layer, phi, ONE, ONE)) == true


heights = st.one_of(st.integers(1, 40), st.integers(1, 10**9))
cosines = st.fractions(Fraction(-49, 100), Fraction(49, 100), max_denominator=1000)


@st.composite
def contacts(draw: st.DrawFn) -> tuple[int, int]:
    height = draw(heights)
    near_base, near_surface = st.integers(0, min(height, 9) - 1), st.integers(1, min(height, 9))
    layer = draw(
        st.one_of(near_base, near_surface.map(lambda k: height - k), st.integers(0, height - 1))
    )
    return height, layer


@given(contact=contacts(), phi=cosines)
@pytest.mark.parametrize("load", EXACT)
def test_float64_is_accurate(load: str, contact: tuple[int, int], phi: Fraction) -> None:
    height, layer = contact
    form = EXACT[load]
    rounded = Fraction(float(phi))
    exact = form(height, layer, rounded, Fraction(1), Fraction(1))
    found = Fraction(form(float(height), float(layer), float(phi), 1.0, 1.0))
    # about 40 roundings, each enlarged at most fivefold by the mild cancellation at M = 3, j = 1
    assert abs(found - exact) <= 200 * Fraction(2) ** -53 * exact


@given(z=st.fractions(0, 1), height=heights, phi=cosines)
@pytest.mark.parametrize("form", [closed_forms.surface_diffusion, closed_forms.bulk_diffusion])
def test_printed_forms_are_accurate(
    form: Callable[..., Any], z: Fraction, height: int, phi: Fraction
) -> None:
    at = Fraction(float(z))
    exact = form(height, at, Fraction(float(phi)), Fraction(1), Fraction(1))
    found = Fraction(form(float(height), float(z), float(phi), 1.0, 1.0))
    # fifteen roundings; 1 − z is exact or rounded once, whatever z is
    assert abs(found - exact) <= 30 * Fraction(2) ** -53 * exact


def test_printed_forms_are_the_printed_equations() -> None:
    values = {sy.M: 7, sy.z: Fraction(2, 5), sy.phi: Fraction(1, 3), sy.sigma: 3, sy.r: 7}
    for equation, form in (
        (eq13, closed_forms.surface_diffusion),
        (eq14, closed_forms.bulk_diffusion),
    ):
        printed = equation.PRINTED.rhs.xreplace({s: sympy.Rational(v) for s, v in values.items()})
        at = [Fraction(values[s]) for s in (sy.M, sy.z, sy.phi, sy.sigma, sy.r)]
        assert form(*at) == printed


PRINTED = (closed_forms.surface_diffusion, closed_forms.bulk_diffusion)


@pytest.mark.parametrize("form", EXACT.values())
@pytest.mark.parametrize("layer", [-1, 5, 6, 2.5, float("nan"), "2", None, [1, 2]])
def test_no_contact_outside(form: Callable[..., Any], layer: Any) -> None:
    with pytest.raises(ValueError, match="j = ") as refused:
        form(5, layer, 0.1, 1.0, 1.0)
    assert "allowed" in str(refused.value)


@pytest.mark.parametrize("form", [*EXACT.values(), *PRINTED])
@pytest.mark.parametrize("height", [0, -3, 4.5, float("inf"), np.array([5]), np.array([5, 6])])
def test_no_packing_of_such_a_height(form: Callable[..., Any], height: Any) -> None:
    with pytest.raises(ValueError, match=r"M = .* is allowed"):
        form(height, 0, 0.1, 1.0, 1.0)


@pytest.mark.parametrize("form", PRINTED)
@pytest.mark.parametrize("z", [-0.1, 2, Fraction(8, 7), float("nan"), np.array([0.1, 0.2])])
def test_no_contact_at_such_a_fraction(form: Callable[..., Any], z: Any) -> None:
    with pytest.raises(ValueError, match=r"z = .* is allowed"):
        form(5, z, 0.1, 1.0, 1.0)


@pytest.mark.parametrize("kind", [np.int64, np.int32, float, Fraction, mpmath.mpf])
@pytest.mark.parametrize("form", EXACT.values())
def test_whole_numbers_of_any_type_do_not_overflow(form: Callable[..., Any], kind: Any) -> None:
    phi = Fraction(1, 3)
    exact = form(10**9, 10**8, phi, ONE, ONE)
    assert exact > 0
    assert form(kind(10**9), kind(10**8), phi, ONE, ONE) == exact


@pytest.mark.parametrize("kind", [np.int64, np.int32, float, Fraction, mpmath.mpf])
@pytest.mark.parametrize("form", PRINTED)
def test_heights_of_any_type_do_not_overflow(form: Callable[..., Any], kind: Any) -> None:
    at = (Fraction(1, 6), Fraction(1, 3), ONE, ONE)
    assert form(kind(10**9), *at) == form(10**9, *at)


@pytest.mark.parametrize("form", [*EXACT.values(), *PRINTED])
def test_whole_phi_does_not_overflow(form: Callable[..., Any]) -> None:
    zero = np.int64(0)  # also as z or j, in the same place
    exact = form(2 * 10**9, 0, Fraction(0), ONE, ONE)
    assert form(2 * 10**9, zero, zero, 1.0, 1.0) == pytest.approx(float(exact), rel=1e-14)


@pytest.mark.parametrize("kind", [float, np.float64, np.float32, Fraction, mpmath.mpf, flint.arb])
@pytest.mark.parametrize("form", [*EXACT.values(), *PRINTED])
def test_the_result_is_of_the_type_of_phi(form: Callable[..., Any], kind: Any) -> None:
    quarter, two = kind(1) / kind(4), kind(2)
    found = form(10**9, 1, quarter, kind(1), two)
    assert type(found) is type(quarter)
    exact = form(10**9, 1, Fraction(1, 4), ONE, Fraction(2))
    assert float(found) == pytest.approx(float(exact), rel=1e-5)


AT_ANGLE = {
    "surface": closed_forms.surface_variance_at_angle,
    "bulk": closed_forms.bulk_variance_at_angle,
}


@pytest.mark.parametrize("load", AT_ANGLE)
@pytest.mark.parametrize("height", range(1, 8))
@pytest.mark.parametrize("ratio", [Fraction(2, 3), Fraction(7, 2), Fraction(0)])
def test_at_an_angle_it_is_that_of_exact_packings(load: str, height: int, ratio: Fraction) -> None:
    n = DIRECTIONS[2]
    phi = n[1] ** 2 - n[0] ** 2
    number = {"surface": "B2", "bulk": "B3"}[load]
    for layer in range(height):
        true = of_packing(number, "plus", load, height, layer, n, ratio)
        assert exact(AT_ANGLE[load](height, layer, ratio, phi, ONE, ONE)) == true


@pytest.mark.parametrize("load", AT_ANGLE)
def test_straight_down_is_the_vertical_form(load: str) -> None:
    for height in range(1, 9):
        for layer in range(height):
            at = height, layer
            vertical = EXACT[load](*at, Fraction(2, 7), ONE, ONE)
            assert AT_ANGLE[load](*at, ONE, Fraction(2, 7), ONE, ONE) == vertical


@pytest.mark.parametrize("height", range(1, 7))
def test_means_are_those_of_exact_packings(height: int) -> None:
    n = DIRECTIONS[1]
    phi = n[1] ** 2 - n[0] ** 2
    shifts = {"surface": closed_forms.surface_mean_shift, "bulk": closed_forms.bulk_mean_shift}
    for (load, form), layer in product(shifts.items(), range(height)):
        number = {"surface": "B5", "bulk": "B6"}[load]
        true = of_packing(number, "force", load, height, layer, n)
        assert exact(form(height, layer, phi, ONE, ONE)) == true


@pytest.mark.parametrize(
    ("height", "layer", "count"),
    [(10, 5, 3), (12, 6, 4), (3, 2, 1), (4, 0, 2), (5, 1, 6), (4, 3, 3)],
)
def test_means_of_neighbours_are_those_of_exact_packings(
    height: int, layer: int, count: int
) -> None:
    n = DIRECTIONS[3]
    phi = n[1] ** 2 - n[0] ** 2
    forms = {
        "B7": closed_forms.contacts_mean_variance,
        "B8": closed_forms.beads_mean_variance,
    }
    for number, form in forms.items():
        true = of_packing(number, "mean", "surface", height, layer, n, count=count)
        assert exact(form(height, layer, count, phi, ONE, ONE)) == true
        with pytest.raises(ValueError, match="N = 0"):
            form(height, layer, 0, phi, ONE, ONE)
        with pytest.raises(ValueError, match=r"j = .*allowed"):
            form(height, height, count, phi, ONE, ONE)


@pytest.mark.parametrize("load", ["surface", "bulk"])
def test_the_leading_order_of_spheres_is_that_of_tall_packings(load: str) -> None:
    phi, height, layer = Fraction(1, 3), 10**9, 4 * 10**8
    printed = getattr(closed_forms, f"{load}_diffusion_of_spheres")
    exact = getattr(closed_forms, f"{load}_variance_of_spheres")
    leading = printed(height, Fraction(layer, height), phi, ONE, ONE)
    assert abs(exact(height, layer, phi, ONE, ONE) / leading - 1) < Fraction(20, height)


def test_the_printed_response_is_that_of_a_large_cone() -> None:
    phi, l = Fraction(-1, 8), 10**6  # noqa: E741
    for j in (l // 4, l // 2):
        exact = closed_forms.bead_response(0, j, 0, l, phi, ONE, ONE)
        assert abs(exact / closed_forms.response(l, j, phi, ONE, ONE) - 1) < Fraction(2, l)
