"""Equations as functions: arrays of arguments, the profile of a packing, functions for NumPy."""

import inspect
from decimal import Decimal
from fractions import Fraction
from typing import Any

import numpy as np
import pytest
import sympy
from force_diffusion.derivations.api.equation import NoSuchFormError
from force_diffusion.derivations.api.evaluation import ArgumentError
from force_diffusion.derivations.framework.catalogue import modules
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
    layers = fd.equation(13).exact("interior").at(M=10, j=range(2, 9), **EXACT)
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


def test_a_layer_that_is_fixed_may_be_left_out_of_arrays() -> None:
    form = fd.equation(13).exact("surface")
    found = form.at(M=range(1, 6), **EXACT)
    assert found.tolist() == [form.at(M=M, j=M - 1, **EXACT) for M in range(1, 6)]


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


def test_a_layer_that_a_form_is_not_for_is_named_and_the_profile_too() -> None:
    with pytest.raises(ArgumentError, match=r"element \[0\]: .*not for j = 0.*profile\("):
        fd.equation(13).exact("interior").at(M=10, j=range(10), **FLOATS)


@pytest.mark.parametrize("phi", [0, 0.0])
def test_a_layer_that_is_left_out_lies_in_the_packing(phi: Any) -> None:
    """In a packing of one layer there is no layer 1."""
    form = fd.equation(14).exact("base+1")
    with pytest.raises(ArgumentError, match="j = 1, M = 1: 0 ≤ j < M"):
        form.at(M=1, phi=phi, sigma=1, r=1)
    with pytest.raises(ArgumentError, match="j = 1, M = 1: 0 ≤ j < M"):
        form.function()(M=1, phi=phi, sigma=1, r=1)


# --- the profile of a packing


@pytest.mark.parametrize("number", [13, 14])
@pytest.mark.parametrize("height", range(1, 8))
def test_a_profile_has_every_layer(number: int, height: int) -> None:
    form = {13: closed_forms.surface_variance, 14: closed_forms.bulk_variance}[number]
    found = fd.equation(number).profile(M=height, **EXACT)
    phi, sigma, r = map(Fraction, EXACT.values())
    assert found.j.tolist() == list(range(height))
    assert found.z.tolist() == [j / height for j in range(height)]
    assert found.values.tolist() == [form(height, j, phi, sigma, r) for j in range(height)]
    floats = fd.equation(number).profile(M=height, **FLOATS)
    assert floats.values.dtype == np.float64


def test_a_profile_says_which_form_each_layer_has() -> None:
    found = fd.equation(13).profile(M=5, **EXACT)
    assert found.cases == ("base", "base+1", "interior", "interior", "surface")
    lines = str(found).splitlines()
    assert lines[0].startswith("Eq. 13, M = 5, φ = -1/8")
    assert [line.split()[0] for line in lines[-5:]] == ["4", "3", "2", "1", "0"]


@pytest.mark.parametrize(("sigma", "told"), [("0.008", "M* = 25."), (0, "σ_f²(z)/⟨f⟩²")])
def test_a_profile_prints_heights_and_where_first_order_ends(sigma: Any, told: str) -> None:
    """(0.008)^(−2/3) = 25; without scatter there is no such height."""
    found = fd.equation(13).profile(M=4, phi=0, sigma=Decimal(sigma), r=1)
    *heading, names, top, _, _, base = str(found).splitlines()
    assert heading[-1].endswith(told)
    assert names.split()[:3] == ["j", "z", "value"]
    assert (top.split()[:2], base.split()[:2]) == (["3", "0.75"], ["0", "0"])


def test_the_printed_equation_is_a_form_where_it_is_exact() -> None:
    """Eq. B7 is printed for the interior; its other layers have forms of their own."""
    found = fd.equation("B7").profile(M=9, N=3, layers=range(9), **EXACT)
    assert "printed" in found.cases
    assert found.values.shape == (9,)
    assert found.values[5] == fd.equation("B7").at(M=9, N=3, j=5, **EXACT)


def test_a_profile_is_of_one_quantity() -> None:
    eq = fd.equation("B10")
    flux = eq.profile("flux-interior", M=6, **EXACT)
    assert flux.cases[0] == "flux-base"
    assert flux.values[0] == eq.exact("flux-base").at(M=6, **EXACT)
    assert eq.profile(M=6, **EXACT).cases[0] == "base"


@pytest.mark.parametrize("number", list(modules()))
def test_a_profile_never_holds_what_is_no_number(number: Any) -> None:
    eq = fd.equation(number)
    given = {
        "M": 7,
        "N": 3,
        "l": 6,
        "t": 2,
        "i": 0,
        "k": 0,
        "q": 1,
        "d": 2,
        "tau_1": 2,
        "tau_2": 3,
        **EXACT,
    }
    for case in eq.cases or (None,):
        try:
            found = eq.profile(case, **{n: v for n, v in given.items() if n in eq.symbols})
        except (ArgumentError, NoSuchFormError):
            continue
        assert len(found.values) == len(found.j) == len(found.cases)
        assert all(isinstance(one, sympy.Expr) and one.is_finite for one in found.values)


def test_a_layer_without_a_form_is_named() -> None:
    eq = fd.equation("B12")
    with pytest.raises(ArgumentError, match=r"no exact form for j = 5.*layers=range\(5\)"):
        eq.profile(M=9, l=5, **EXACT)
    found = eq.profile(M=9, l=5, layers=range(5), **EXACT)
    assert len(found.values) == 5


@pytest.mark.parametrize(
    ("number", "given", "says"),
    [
        (13, {"M": 10, "z": 0.5}, "Eq. 13's profile holds no z"),
        (13, {"M": 10, "j": 3}, r"j is every layer; give layers=\[3\]"),
        (13, {"M": [10, 11]}, r"M = \[10, 11\]: a profile is of one packing"),
        (13, {}, "M missing"),
        (13, {"M": 0}, "M = 0: a whole number from 1 on"),
        (13, {"M": 2.5}, "M = 2.5: a whole number from 1 on"),
        (13, {"M": "10"}, "M = '10': one int"),
        (13, {"M": 10, "layers": [0, 10]}, "j = 10, M = 10: 0 ≤ j < M is allowed"),
        (13, {"M": 10, "layers": 3}, "layers = 3: several layers"),
        (13, {"M": 10, "layers": [0.5]}, "j = 0.5: a whole number"),
        (13, {"M": 10, "phi": 0.7}, "phi = 0.7: −1/2 < φ < 1/2"),
        (13, {"M": 10, "case": "leg"}, "no exact form for 'leg'"),
        (15, {"M": 10}, "Eq. 15, exact form 'surface-load', is of no single layer"),
        (3, {"M": 10}, "Eq. 3 has no exact form at finite size"),
    ],
)
def test_what_a_profile_does_not_take_is_named(number: int, given: Any, says: str) -> None:
    with pytest.raises(fd.ForceDiffusionError, match=says):
        fd.equation(number).profile(**FLOATS | given)


# --- functions for NumPy


def test_a_function_has_a_signature_and_says_what_it_is() -> None:
    function = fd.equation(13).function()
    assert str(inspect.signature(function)) == "(M, z, phi, sigma, r)"
    assert function.__name__ == "surface_diffusion"
    told = inspect.getdoc(function)
    assert told is not None
    for words in ("Eq. 13", "σ_f²(z)/⟨f⟩²", "M: height of the packing", "0 ≤ z ≤ 1"):
        assert words in told
    base = fd.equation(13).exact("base").function()
    assert str(inspect.signature(base)) == "(M, phi, sigma, r)"
    assert base.__name__ == "surface_diffusion_base"


SITES = {"M": 9, "j": 3, "l": 7, "i": 1, "k": 1, "q": 2, "N": 2, "d": 3, "z": 0.25, "t": 1.5,
         "tau_1": 1.75, "tau_2": 1.6}  # fmt: skip
NUMBERS = [fd.equation(number) for number in modules() if number not in range(1, 13)]
FORMS = [eq for eq in NUMBERS if eq.number != "B1"]
FORMS += [eq.exact(case) for eq in NUMBERS for case in eq.cases]


@pytest.mark.parametrize("formula", FORMS, ids=repr)
def test_a_function_is_the_formula_in_floats(formula: Any) -> None:
    """A few dozen roundings, in sums whose terms are up to a few thousand times the whole."""
    function = formula.function()
    names = list(inspect.signature(function).parameters)
    compared = 0
    places = [*((9, j, 7) for j in range(9)), (2, 1, 7), (2, 0, 7), (1, 0, 7), (9, 3, 15)]
    for M, j, l in places:  # noqa: E741
        here = {"M": M, "j": j, "l": l}
        given = {n: v for n, v in (SITES | FLOATS | here).items() if n in names}
        try:
            expected = formula.at(**given)
        except ArgumentError:
            with pytest.raises(ArgumentError):
                function(**given)
            continue
        compared += 1
        assert function(**given) == pytest.approx(expected, rel=1e-11)
        shown = function(**{n: np.full((2, 1), v) for n, v in given.items()})
        for one in shown if isinstance(shown, tuple) else (shown,):
            assert one.shape == (2, 1)
            assert one.dtype == np.float64
    assert compared or "N" in names  # one N suits few of the windows' forms


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


def test_an_exact_form_as_a_function_keeps_to_its_layers() -> None:
    function = fd.equation(13).exact("interior").function()
    with pytest.raises(ArgumentError, match=r"element \[1\]: .*not for j = 1"):
        function(M=10, j=[2, 1], **FLOATS)
    with pytest.raises(ArgumentError, match="0 ≤ j < M"):
        function(M=10, j=12, **FLOATS)
    with pytest.raises(TypeError, match="missing"):
        function(M=10)


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
