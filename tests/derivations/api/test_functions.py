"""Equations as functions: arrays of arguments, the profile of a packing, functions for NumPy."""

import inspect
import math
import pydoc
from decimal import Decimal
from fractions import Fraction
from typing import Any

import mpmath
import numpy as np
import pytest
import sympy
from flint import fmpq, fmpz
from force_diffusion.numeric.arithmetic.errors import ArgumentError
from force_diffusion.symbolic.kernel.decisions import Verdict
from hypothesis import given
from hypothesis import strategies as st
from sympy import Rational

import force_diffusion as fd

FLOATS = {"phi": -0.125, "sigma": 0.01, "r": 1.0}
EXACT = {"phi": Fraction(-1, 8), "sigma": Fraction(1, 100), "r": 1}


REAL = np.array([0.25, 0.5])
KINDS: list[tuple[Any, type]] = [
    *((z, float) for z in (REAL, REAL.astype(np.float32), [0.25, 0.5], [Fraction(1, 4), 0.5])),
    *((z, object) for z in (
        [Fraction(1, 4), Decimal("0.5")], sympy.Tuple(Rational(1, 4), Rational(1, 2)),
        (fmpq(1, 4), fmpq(1, 2)), np.array([Fraction(1, 4), Fraction(1, 2)]),
    )),
]  # fmt: skip


@pytest.mark.parametrize(("z", "kind"), KINDS, ids=repr)
def test_one_float_makes_floats_of_all_and_else_all_is_exact(z, kind):
    values = fd.equation(13).at(M=8, z=z, **EXACT)
    alone = [fd.equation(13).at(M=8, z=z, **EXACT) for z in (Fraction(1, 4), Fraction(1, 2))]
    assert all(isinstance(value, sympy.Rational) for value in alone)
    assert values.dtype == kind
    assert values.tolist() == (
        alone if kind is object else [int(value.p) / int(value.q) for value in alone]
    )


def test_a_layer_stands_for_its_height_and_whole_numbers_are_of_any_type():
    expected = fd.equation(13).at(M=8, z=Fraction(3, 8), **EXACT)
    for kind in (int, np.int64, np.int8, Fraction, sympy.Integer, fmpz, Decimal):
        assert fd.equation(13).at(M=kind(8), j=kind(3), **EXACT) == expected
    layers = fd.equation(13).exact().at(M=8, j=np.arange(8, dtype=np.int8), **EXACT)
    assert layers.tolist() == fd.equation(13).exact().profile(M=8, **EXACT).tolist()
    assert fd.equation(13).at(M=8, j=3, **{**EXACT, "sigma": 0}) == 0


@given(st.integers(1, 10**6), st.floats(0, 1), st.floats(-0.49, 0.49), st.floats(1e-9, 1e-3))
def test_a_float_is_rounded_once(height, z, phi, sigma):
    exact = fd.equation(13).at(
        M=height, z=Fraction(z), phi=Fraction(phi), sigma=Fraction(sigma), r=1
    )
    value = fd.equation(13).at(M=height, z=z, phi=phi, sigma=sigma, r=1)
    assert type(value) is float
    assert value == int(exact.p) / int(exact.q)


def test_powers_that_are_no_fractions():
    deviation, height = fd.equation(15).at(M=2, sigma=Fraction(1, 10), r=1)
    assert (deviation, height) == (sympy.sqrt(2) / 5, 10 ** Rational(2, 3))
    deviation, height = fd.equation(15).at(M=2, sigma=0.1, r=1)
    assert deviation == pytest.approx(math.sqrt(2) / 5, rel=4e-16)
    assert height == pytest.approx(10 ** (2 / 3), rel=4e-16)


def test_numbers_of_thousands_of_digits_get_an_answer_or_a_sentence():
    equation = fd.equation(13)
    form, huge = equation.exact(), 10**5000
    assert form.at(M=huge, j=3, phi=0, sigma=1, r=1) > huge
    assert form.decide(form.pieces[0].expr + huge).verdict is Verdict.REFUTED
    assert "digits" in equation.decide(equation.rhs * huge).note
    assert equation.decide(equation.rhs + huge).verdict is Verdict.PROVED  # of a lower order
    for ask in (
        lambda: form.at(M=3, j=huge, phi=0, sigma=1, r=1),
        lambda: form.decide(form.pieces[0].expr, M=huge, j=4),
    ):
        with pytest.raises(ArgumentError) as raised:
            ask()
        assert len(str(raised.value)) < 200


def test_arrays_are_broadcast():
    heights, z = np.array([[4], [8]]), np.linspace(0, 1, 3)
    values = fd.equation(13).at(M=heights, z=z, **FLOATS)
    assert values.shape == (2, 3)
    assert values[1, 2] == 0
    assert values[1, 1] == fd.equation(13).at(M=8, z=0.5, **FLOATS)


def test_two_lines_are_two_arrays():
    deviation, height = fd.equation(15).at(M=[1, 4], sigma=Fraction(1, 8), r=1)
    assert deviation.tolist() == [Fraction(1, 8), 1]
    assert height.tolist() == [4, 4]


def test_empty_arrays_give_empty_arrays_and_names_are_still_checked():
    values = fd.equation(13).at(M=10, z=np.array([]), **FLOATS)
    assert values.shape == (0,)
    with pytest.raises(ArgumentError, match="has no x"):
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
        ({"z": np.ma.masked_array([0.1, 0.2], [0, 1])}, "z is a masked array"),
        ({"z": np.zeros(3), "M": [4, 5]}, r"M of shape \(2,\) and z of shape \(3,\) do not"),
        ({"M": np.array([4, 4.5]), "z": 0}, r"element \[1\]: M = 4.5: a whole number"),
        ({"M": 0, "z": 0}, "M = 0: a whole number from 1 up is allowed"),
        ({"j": 10}, "j = 10, M = 10: 0 ≤ j < M is allowed"),
        ({"j": 3, "phi": Fraction(-1, 2)}, "phi = .*: −1/2 < φ < 1/2 is allowed"),
        ({"j": 3, "r": 0}, "r = 0: a number above 0 is allowed"),
        ({"j": 3, "z": 0}, "z and j are given, and z is j/M: leave one of them out"),
        ({"j": 3, "x": 1, "width": 2}, "Eq. 13 has no x or width: Eq. 13 takes M, j, phi, si"),
        ({}, r"z must be given: Eq. 13 takes M, z \(or j\), phi, sigma, r"),
        ({"j": 3, "sigma": 1e300, "r": 1e-300}, "beyond the range of floats"),
        *(
            ({"j": 3, "sigma": sigma}, "sigma = .*allowed|sigma: .*allowed")
            for sigma in (mpmath.mpf("0.1"), [mpmath.mpf(1)], Decimal("1E-9999999"), -1, 1j, None)
        ),
    ],
)  # fmt: skip
def test_what_is_not_allowed_is_named(change, says):
    with pytest.raises(ArgumentError, match=says):
        fd.equation(13).at(**{"M": 10} | FLOATS | change)


# --- the profile of a packing


@pytest.mark.parametrize(
    ("number", "given", "says"),
    [
        (13, {"M": 10, "z": 0.5}, "has no z"),
        (13, {}, "a profile needs a form that depends on the layer j, and M or l"),
        (13, {"M": 10, "phi": 0.7}, "phi = 0.7: −1/2 < φ < 1/2"),
        (15, {"M": 10}, "a profile needs a form that depends on the layer j"),
    ],
)
def test_a_wrong_argument_of_a_profile_is_named(number, given, says):
    with pytest.raises(fd.ForceDiffusionError, match=says):
        fd.equation(number).exact().profile(**FLOATS | given)


# --- functions for NumPy


def test_a_function_has_a_signature_and_says_what_it_is():
    function = fd.equation(13).function()
    assert str(inspect.signature(function)) == "(M, z, phi, sigma, r)"
    assert function.__name__ == "surface_diffusion"
    docstring = inspect.getdoc(function)
    assert docstring is not None
    assert "0 ≤ z ≤ 1" in pydoc.render_doc(function)
    for words in ("Eq. 13", "σ_f²(z)/⟨f⟩²", "M: height of the packing", "0 ≤ z ≤ 1"):
        assert words in docstring


@pytest.mark.parametrize("number", [13, 14, 15, 16])
def test_a_function_is_the_formula_in_floats(number):
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
        for array in shown if isinstance(shown, tuple) else (shown,):
            assert array.shape == (2, 1)
            assert array.dtype == np.float64


@pytest.mark.parametrize("number", ["B5", "B13"])
def test_a_closed_form_takes_arrays_itself(number):
    equation = fd.equation(number)
    with pytest.raises(ArgumentError, match=r"exact.*takes arrays"):
        equation.function()
    given = {"M": 9, "j": [0, 4], **FLOATS}
    assert np.array_equal(equation.at(**given), equation.exact().at(**given))


@pytest.mark.parametrize("kind", [float, Fraction, Decimal, sympy.Rational, np.float32])
def test_a_function_takes_numbers_of_any_kind(kind):
    half = kind("0.5") if kind in (Decimal, sympy.Rational) else kind(0.5)
    values = fd.equation(13).function()(10**7, [half, 0], 0, half, r=1)  # M³ is no int64
    assert values == pytest.approx([2.5e20, 5e20], rel=1e-14)
    assert isinstance(fd.equation(13).function()(M=10, z=half, phi=0, sigma=1, r=1), float)


def test_a_function_takes_shapes_that_go_together_and_all_that_is_needed():
    function = fd.equation(13).function()
    masked = np.ma.masked_array([1.0, 2.0], [0, 1])
    assert function(10, 0.5, 0, masked, 1).mask.tolist() == [False, True]
    with pytest.raises(ValueError, match="shape mismatch"):
        function([4, 5], np.zeros(3), 0, 1, 1)
    with pytest.raises(TypeError, match="missing"):
        function(10)
    with pytest.raises(ArgumentError, match="single beads"):
        fd.equation(3).function()


@pytest.mark.parametrize("number", [13, 14, 15])
def test_source_takes_arguments_in_the_order_of_the_function(number):
    equation = fd.equation(number)
    scope: dict[str, Any] = {}
    exec(equation.python_code(), scope)
    first = next(function for name, function in scope.items() if name.startswith(equation.name))
    of_source, of_function = map(inspect.signature, (first, equation.function()))
    assert [*of_source.parameters] == [*of_function.parameters]
