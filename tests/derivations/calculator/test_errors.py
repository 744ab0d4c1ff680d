"""What is refused, and in which words."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
import sympy
from force_diffusion.derivations.calculator.loads import ObservableError
from force_diffusion.numeric.arithmetic.errors import ArgumentError, WrongTypeError
from force_diffusion.symbolic.symbols import Position, n, z

import force_diffusion as fd
from force_diffusion.symbols import M, N, delta_x, f_along, f_minus, f_plus, i, j, k, l, p, phi, t

FORCE = f_plus(i, j)
IN_SPACE = f_along(1, i, j, k)
own = sympy.Symbol

OBSERVABLES = [
    (FORCE * f_minus(i, j), r"f⁻_ij f⁺_ij\): a product of two .* in mean\(…, order=2\) also"),
    (FORCE / f_minus(i, j), "the divisor 2 n_y f⁻_ij/f_load depends on the radii"),
    (sympy.sin(FORCE), r"sin\(f⁺_ij\)\): sin.* is not a rational function"),
    (sympy.exp(phi) * FORCE, r"exp\(φ\) is not a rational function of the symbols"),
    (0.5 * FORCE, r"is a float: write a fraction, such as Rational\(1, 2\)"),
    (sympy.oo * FORCE, "oo is not a number"),
    (own("phi") * FORCE, "phi is not the phi of force_diffusion.symbols: import"),
    (f_plus(own("i"), j), "i is not the i of force_diffusion.symbols"),
    (own("a") * own("a", real=True) * FORCE, "two symbols have the name a"),
    (own("a b") * FORCE, "a b: a constant has to be commutative, and its name has to be"),
    (own("A", commutative=False) * FORCE, "A: a constant has to be commutative"),
    (z * FORCE, "z can't be used in an observable: write j/M"),
    (f_plus(i + 2 * n, j), "n can't be used in an observable"),
    (f_plus(own("a"), j), "f⁺_aj is at a: only whole numbers up to 1000000000 and i, j, k, l, p"),
    (f_plus(i + sympy.Rational(1, 2), j), r"is at i \+ 1/2: only whole numbers"),
    (f_plus(i + 2**70, j), "whole numbers"),
    (FORCE + f_plus(i + 1, j), r"i \+ j must be even for each bead \(i, j\)"),
    (FORCE - f_plus(i + p, j) + f_plus(i + p + 1, j), r"i \+ j \+ p is not shown to be even"),
    (f_plus(1, -1) + FORCE, "no packing has these beads: a layer is too low or too high"),
    (IN_SPACE, "is a force between spheres: give dimension=3"),
    (Position(i, j), "x_ij does not depend on the radii, or is not known"),
    (delta_x(i, j), r"δx_ij is a vector: take a component, such as dot\(e_y, …\)"),
    (delta_x(i, j) ** 2, "δx_ij² is a vector"),
    ([FORCE], "is not a SymPy expression"),
    (sympy.eye(2), "is not a SymPy expression"),
    (f_plus, r"needs a place, as in f_plus\(i, j\)"),
]


@pytest.mark.parametrize(("observable", "says"), OBSERVABLES)
def test_observables(observable, says):
    for ask in (fd.variance, lambda other: fd.covariance(FORCE, other)):
        with pytest.raises(ObservableError, match=says):
            ask(observable)


CALLS: list[tuple[Callable[[Any], Any], tuple[Any, ...], str]] = [
    (lambda load: fd.variance(FORCE, load=load), ("point", None, [], FORCE, fd.PointLoad),
     r"'surface', 'bulk', point\(k, l\) and leaning\(t\) are allowed"),
    (lambda load: fd.variance(IN_SPACE, load=load, dimension=3), ("leaning", [], fd.leaning(t)),
     r"'surface leaning', .* allowed in three dimensions"),
    (fd.leaning, (0, 1, 0.5, "u", own("t"), sympy.pi, None),
     r"the symbol t is allowed; at\(t=…\) takes its value"),
    (lambda kind: fd.leaning(t, kind), ("point",), "'surface' or 'bulk' is allowed"),
    (lambda place: fd.point(*place), ((i, j), (0, 4), (l, k)), r"name the loaded bead \(k, l\)"),
    (lambda d: fd.variance(FORCE, dimension=d), (1, "3", None, [3]), "2 and 3 are allowed"),
    (lambda d: fd.variance(FORCE, dimension=d), (3,), r"is a quantity of discs: .* take f_along"),
    (lambda a: fd.variance(f_along(a, i, j, k), dimension=3), (0, 4, i), "1, 2 and 3 are allowed"),
    (lambda f: fd.mean(f, order=2, dimension=3), (IN_SPACE,),
     "that is not known in three dimensions"),
    (lambda order: fd.mean(FORCE, order=order), (0, 3, "2", None), "1 and 2 are allowed"),
    (lambda f: fd.mean(f, order=2), (FORCE**5,),
     "the power 5 of 2 n_y f⁺_ij/f_load is not a whole number"),
    (lambda f: fd.mean(f, order=2), (1 / FORCE,),
     "the divisor 2 n_y f⁺_ij/f_load depends on the radii, .* whole"),
    (lambda where: fd.variance(FORCE, where=where),
     ("j >= 2", [j], phi > 0, None, [j > 2, "M"], j**2 > 3),
     "relations between indices are allowed, such as"),
    (lambda where: fd.variance(FORCE, where=where), (j >= M,), "no packing has these beads"),
    (lambda where: fd.variance(FORCE - f_plus(i + p, j), where=where), (sympy.Eq(p, 1),),
     r"nowhere is i \+ j even for all of them"),
    (lambda where: fd.variance(FORCE, where=where), (k >= 4, (j > 2, k > l)), "k does not occur"),
    (lambda count: fd.variance(fd.mean_over(FORCE, count)),
     (0, -1, 2.5, "N", None, own("N"), N / 2, N**2), "a whole number from 1 up"),
    (lambda f: fd.mean_over(f, N), (f_plus(1, j), f_plus(p, j), FORCE + f_plus(k, l)),
     "write horizontal places with the index i"),
    (lambda f: fd.mean_over(fd.mean_over(fd.mean_over(f, 2), 3), N), (FORCE,),
     "are not supported"),
    (fd.mean, (FORCE / (M - 2 * j),), "the divisor M − 2 j may be zero"),
]  # fmt: skip


@pytest.mark.parametrize(
    ("ask", "given", "says"), [(ask, arg, says) for ask, values, says in CALLS for arg in values]
)
def test_calls(ask, given, says):
    with pytest.raises(ObservableError, match=says):
        ask(given)


def test_text_is_never_evaluated(tmp_path):
    code = f"__import__('pathlib').Path({str(tmp_path / 'evaluated')!r}).touch()"
    for ask in (
        fd.leaning,
        fd.variance,
        lambda text: fd.mean_over(text, 2),
        lambda text: fd.mean_over(FORCE, text),
        lambda text: fd.variance(FORCE, where=text),
        lambda text: f_plus(text, j),
        lambda text: fd.force_moment(i, j, text, text),
    ):
        for given in (code, [code], Exception(code)):
            with pytest.raises((ObservableError, TypeError), match="__import__"):
                ask(given)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("place", [None, "i", [1], object()])
def test_places_are_expressions(place):
    with pytest.raises(TypeError, match=r"an expression is needed, such as i \+ 1, not"):
        f_plus(place, j)


@pytest.mark.parametrize("name", ["a b", "class", "", "1x", None])
def test_names_of_functions(name):
    with pytest.raises(ArgumentError, match="must be a valid name of a Python function"):
        fd.variance(FORCE).python(name)


# numbers put in

HERE = {"M": 6, "j": 2, "phi": 0, "sigma": 1, "r": 1}


@pytest.mark.parametrize(
    ("change", "says"),
    [
        ({"j": 6}, r"var\(f⁺_ij\) is for 0 ≤ j ≤ M − 1, not for j = 6, M = 6"),
        ({"j": -1}, "not for j = −1, M = 6"),
        ({"M": -1, "j": -3}, "not for j = −3, M = −1"),
        ({"M": np.float64(6.5)}, "M = 13/2: a whole number is allowed"),
        ({"x": 1}, r"has no x: var\(f⁺_ij\) takes M, j, phi, sigma, r"),
        ({"j": [0, 6]}, r"element \[1\]: .*not for j = 6"),
    ],
)
def test_values(change, says):
    with pytest.raises(ArgumentError, match=says):
        fd.variance(FORCE).at(**{**HERE, **change})


def test_cosines_of_spheres_and_places_without_a_bead():
    in_space = fd.variance(IN_SPACE, dimension=3)
    with pytest.raises(ArgumentError, match="−1/3 < φ < 1/2 is allowed"):
        in_space.at(**{**HERE, "phi": -0.4, "i": 0, "k": 2})
    below = fd.variance(fd.response(i, j), load=fd.point(k, l))
    place = {"phi": 0, "sigma": 1, "r": 1, "i": 0, "j": 2, "k": 0, "l": 4}
    assert below.at(**place) != 0
    for change in ({"i": 1}, {"k": 1}, {"j": 1}, {"l": 3}):
        with pytest.raises(ArgumentError, match="i \\+ j even, k \\+ l even, not for"):
            below.at(**{**place, **change})


def test_division_by_zero():
    assert fd.mean(FORCE / (M - 2 * j), where=2 * j <= M - 1).at(M=5, j=2) == 1
    form = fd.mean(FORCE / (own("a") - 1))
    assert form.at(M=5, j=2, a=3) == sympy.Rational(1, 2)
    with pytest.raises(ArgumentError, match="it has no value there: it divides by 0"):
        form.at(M=5, j=2, a=1)


@pytest.mark.parametrize("number", [13, "B2"])
def test_values_without_names(number):
    with pytest.raises(WrongTypeError, match=r"^10 has no name: give values as at\(M=…, "):
        fd.equation(number).at(10)


def test_a_long_form_says_how_to_see_all_of_it():
    observable = FORCE - own("a") * f_minus(i, j) + own("b") * f_plus(i + 1, j + 1)
    form = fd.variance(observable, load=fd.leaning(t))
    for shown in (str(form), repr(form)):
        assert f"{len(form.pieces)} formulas" in shown
        assert "print(" in shown
        assert len(shown.splitlines()) <= 6
    assert len(form.lines()) > len(form.pieces)
