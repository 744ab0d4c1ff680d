"""Equations as functions: arrays of arguments, the profile of a packing, functions for NumPy."""

import inspect
from decimal import Decimal
from fractions import Fraction
from typing import Any

import numpy as np
import pytest
import sympy
from force_diffusion.derivations.api.equation import NoSuchFormError
from force_diffusion.derivations.framework.evaluation import ArgumentError
from force_diffusion.numeric import closed_forms
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as drawn

import force_diffusion as fd

FLOATS = {"phi": -0.125, "sigma": 0.01, "r": 1.0}
EXACT = {"phi": Fraction(-1, 8), "sigma": Fraction(1, 100), "r": 1}


@given(drawn.arrays(float, drawn.array_shapes(max_dims=3, max_side=4), elements=st.floats(0, 1)))
def test_each_float_of_an_array_is_what_it_is_alone(z: np.ndarray) -> None:
    found = fd.equation(13).at(M=10, z=z, **FLOATS)
    assert found.dtype == np.float64
    assert found.shape == z.shape
    alone = [fd.equation(13).at(M=10, z=one, **FLOATS) for one in z.flat]
    assert found.ravel().tolist() == alone


def test_exact_numbers_stay_exact() -> None:
    layers = fd.equation(13).exact().at(M=10, j=range(2, 9), **EXACT)
    assert layers.dtype == object
    assert layers.shape == (7,)
    for j, value in zip(range(2, 9), layers, strict=True):
        assert isinstance(value, sympy.Rational)
        assert value == closed_forms.surface_variance(10, j, *map(Fraction, EXACT.values()))


KINDS = [
    [1, 2, 3], (1, 2, 3), range(1, 4), np.arange(1, 4), np.arange(1, 4, dtype=np.int8),
    [Fraction(1), 2, sympy.Integer(3)], [Decimal(1), Decimal("2.0"), 3], sympy.Tuple(1, 2, 3),
]  # fmt: skip


@pytest.mark.parametrize("layers", KINDS, ids=repr)
def test_whole_numbers_of_any_kind_are_exact(layers: Any) -> None:
    found = fd.equation(13).at(M=8, j=layers, **EXACT)
    assert all(isinstance(one, sympy.Rational) for one in found)
    assert found.tolist() == [fd.equation(13).at(M=8, j=j, **EXACT) for j in (1, 2, 3)]


def test_a_decimal_is_the_number_that_it_writes() -> None:
    given = EXACT | {"sigma": Decimal("0.01"), "phi": Decimal("-0.125")}
    assert fd.equation(13).at(M=10, j=3, **given) == fd.equation(13).at(M=10, j=3, **EXACT)
    with pytest.raises(ArgumentError, match=r"sigma = Decimal\('NaN'\)"):
        fd.equation(13).at(M=10, j=3, **EXACT | {"sigma": Decimal("NaN")})


def test_one_float_among_exact_numbers_makes_floats_of_all() -> None:
    found = fd.equation(13).at(M=8, z=[0, Fraction(1, 3), 0.5], **EXACT)
    assert found.dtype == np.float64
    alone = fd.equation(13).at(M=8, z=Fraction(1, 3), **EXACT)
    assert found[1] == int(alone.p) / int(alone.q)


def test_arrays_are_broadcast() -> None:
    heights, z = np.array([[4], [8]]), np.linspace(0, 1, 3)
    found = fd.equation(13).at(M=heights, z=z, **FLOATS)
    assert found.shape == (2, 3)
    assert found[1, 2] == 0
    assert found[1, 1] == fd.equation(13).at(M=8, z=0.5, **FLOATS)


def test_two_lines_are_two_arrays() -> None:
    deviation, height = fd.equation(15).at(M=[1, 4], sigma=Fraction(1, 8), r=1)
    assert deviation.tolist() == [Fraction(1, 8), 1]
    assert height.tolist() == [4, 4]


def test_no_elements_are_no_values_and_names_are_looked_at_all_the_same() -> None:
    found = fd.equation(13).at(M=10, z=np.array([]), **FLOATS)
    assert found.shape == (0,)
    with pytest.raises(ArgumentError, match="holds no x"):
        fd.equation(13).at(M=10, x=[], **FLOATS)


@pytest.mark.parametrize(
    ("change", "says"),
    [
        ({"z": [0.5, 1.5]}, r"element \[1\]: z = 1.5: 0 ≤ z ≤ 1 is allowed"),
        ({"z": [0.5, np.nan]}, r"element \[1\]: z = nan: one int, Fraction"),
        ({"z": np.array([[0.5, -1.0]])}, r"element \[0, 1\]: z = -1.0"),
        ({"z": ["a", 1]}, r"element \[0\]: z = 'a'"),
        ({"z": [[0.1], [0.1, 0.2]]}, r"element \[0\]: z = \[0.1\]"),
        ({"z": "0.5"}, "^z = '0.5': one int, Fraction"),
        ({"z": {0.5}}, r"^z = {0.5}: one int"),
        ({"z": {0.5: 1}}, r"^z = {0.5: 1}: one int"),
        ({"z": np.ma.masked_array([0.1, 0.2], [0, 1])}, "z is a masked array"),
        ({"z": np.zeros(3), "M": [4, 5]}, r"M of shape \(2,\) and z of shape \(3,\) do not"),
        ({"z": np.zeros(2) + 1j}, r"element \[0\]: z = 1j"),
        ({"M": np.array([4, 4.5]), "z": 0}, r"element \[1\]: M = 4.5: a whole number"),
    ],
)
def test_what_is_wrong_with_an_array_is_named(change: dict[str, Any], says: str) -> None:
    with pytest.raises(ArgumentError, match=says):
        fd.equation(13).at(**{"M": 10} | FLOATS | change)


def test_a_layer_that_is_not_in_the_packing_is_named() -> None:
    with pytest.raises(ArgumentError, match=r"element \[10\]: .*not for j = 10, M = 10"):
        fd.equation(13).exact().at(M=10, j=range(11), **FLOATS)


# --- the profile of a packing


@pytest.mark.parametrize("number", [13, 14])
@pytest.mark.parametrize("height", range(1, 8))
def test_a_profile_has_every_layer(number: int, height: int) -> None:
    form = {13: closed_forms.surface_variance, 14: closed_forms.bulk_variance}[number]
    found = fd.equation(number).exact().profile(M=height, **EXACT)
    phi, sigma, r = map(Fraction, EXACT.values())
    assert found.tolist() == [form(height, j, phi, sigma, r) for j in range(height)]
    floats = fd.equation(number).exact().profile(M=height, **FLOATS)
    assert floats.dtype == np.float64


@pytest.mark.parametrize(
    ("number", "given", "says"),
    [
        (13, {"M": 10, "z": 0.5}, "holds no z"),
        (13, {}, "a profile needs a form that depends on the layer j, and M or l"),
        (13, {"M": 0}, "M = 0"),
        (13, {"M": 10, "phi": 0.7}, "phi = 0.7: −1/2 < φ < 1/2"),
        (15, {"M": 10}, "a profile needs a form that depends on the layer j"),
    ],
)
def test_what_a_profile_does_not_take_is_named(number: int, given: Any, says: str) -> None:
    with pytest.raises(fd.ForceDiffusionError, match=says):
        fd.equation(number).exact().profile(**FLOATS | given)


# --- functions for NumPy


def test_a_function_has_a_signature_and_says_what_it_is() -> None:
    function = fd.equation(13).function()
    assert str(inspect.signature(function)) == "(M, z, phi, sigma, r)"
    assert function.__name__ == "surface_diffusion"
    told = inspect.getdoc(function)
    assert told is not None
    for words in ("Eq. 13", "σ_f²(z)/⟨f⟩²", "M: height of the packing", "0 ≤ z ≤ 1"):
        assert words in told


@pytest.mark.parametrize("number", [13, 14, 15, 16])
def test_a_function_is_the_formula_in_floats(number: int) -> None:
    """A few dozen roundings."""
    formula = fd.equation(number)
    function = formula.function()
    names = list(inspect.signature(function).parameters)
    for j in range(7):
        here = {"M": 9, "z": j / 9, "j": j, "l": 7}
        given = {name: value for name, value in (FLOATS | here).items() if name in names}
        expected = formula.at(**given)
        assert function(**given) == pytest.approx(expected, rel=1e-13)
        shown = function(**{name: np.full((2, 1), value) for name, value in given.items()})
        for one in shown if isinstance(shown, tuple) else (shown,):
            assert one.shape == (2, 1)
            assert one.dtype == np.float64


@pytest.mark.parametrize("number", ["B5", "B13"])
def test_a_closed_form_takes_arrays_itself(number: str) -> None:
    equation = fd.equation(number)
    with pytest.raises(ArgumentError, match=r"exact.*takes arrays"):
        equation.function()
    given = {"M": 9, "j": [0, 4], **FLOATS}
    assert np.array_equal(equation.at(**given), equation.exact().at(**given))


def test_whole_numbers_do_not_overflow() -> None:
    function = fd.equation(13).function()
    found = function(M=np.array([10**7]), z=0, phi=0, sigma=1, r=1)
    assert found[0] == pytest.approx(2e21)


@pytest.mark.parametrize("kind", [float, Fraction, Decimal, sympy.Rational, np.float32])
def test_a_function_takes_numbers_of_any_kind(kind: Any) -> None:
    half = kind("0.5") if kind in (Decimal, sympy.Rational) else kind(0.5)
    found = fd.equation(13).function()(M=10, z=[half, 0], phi=0, sigma=half, r=1)
    assert found == pytest.approx([250, 500], rel=1e-14)


def test_positions_and_names_are_one() -> None:
    function = fd.equation(13).function()
    by_name = function(M=10, z=0.3, **FLOATS)
    assert function(10, 0.3, -0.125, 0.01, 1.0) == by_name
    assert isinstance(by_name, float)


@pytest.mark.parametrize(
    ("given", "says"),
    [
        ({"z": [0.5, 1.5]}, r"element \[1\]: z = 1.5: 0 ≤ z ≤ 1 is allowed"),
        ({"z": np.nan}, "z = nan"),
        ({"M": 0}, "M = 0: a whole number from 1 on"),
        ({"M": [4, 2.5]}, r"element \[1\]: M = 2.5: a whole number"),
        ({"phi": 0.5}, "phi = 0.5: −1/2 < φ < 1/2"),
        ({"r": "1"}, "r = '1': numbers are allowed"),
        ({"r": 1j}, "r = 1j: numbers are allowed"),
        ({"r": np.array(["1"], dtype=object)}, "numbers are allowed"),
        ({"r": np.ma.masked_array([1.0, 2.0], [0, 1])}, "without a mask"),
        ({"sigma": 1e200}, "beyond the range of floats"),
        ({"M": [4, 5], "z": np.zeros(3)}, r"M of shape \(2,\) and z of shape \(3,\) do not"),
    ],
)
def test_a_function_keeps_to_its_domain(given: dict[str, Any], says: str) -> None:
    with pytest.raises(ArgumentError, match=says):
        fd.equation(13).function()(**{"M": 10, "z": 0.5} | FLOATS | given)


def test_a_function_of_a_layer_keeps_to_its_packing() -> None:
    function = fd.equation(16).function()
    with pytest.raises(ArgumentError, match=r"element \[1\]: j = 8, l = 7: 0 ≤ j ≤ l is allowed"):
        function(l=7, j=[7, 8], **FLOATS)
    with pytest.raises(TypeError, match="missing"):
        function(l=7)


def test_what_is_no_number_is_no_function() -> None:
    with pytest.raises(ArgumentError, match="single beads"):
        fd.equation(3).function()


# --- numbers of equations as words


@pytest.mark.parametrize(("word", "number"), [("13", 13), ("b5", "B5"), ("B5", "B5"), ("1", 1)])
def test_an_equation_by_the_word_for_its_number(word: str, number: Any) -> None:
    assert fd.equation(word) is fd.equation(number)


@pytest.mark.parametrize("word", ["", "0", "17", "13.0", "-1", "١٣", "T4", "9" * 5000])
def test_no_such_word(word: str) -> None:
    with pytest.raises(NoSuchFormError):
        fd.equation(word)
