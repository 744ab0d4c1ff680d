"""What is refused, and in which words."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import sympy
from force_diffusion.derivations.calculator.loads import ObservableError
from force_diffusion.derivations.framework.evaluation import ArgumentError
from force_diffusion.symbolic.symbols import Load, Position, m, n

import force_diffusion as fd
from force_diffusion.symbols import (
    M,
    N,
    delta_x,
    f_along,
    f_minus,
    f_plus,
    i,
    j,
    k,
    l,
    p,
    phi,
    t,
    z,
)  # fmt: skip

FORCE = f_plus(i, j)
own = sympy.Symbol


@pytest.mark.parametrize(
    ("observable", "says"),
    [
        (
            FORCE * f_minus(i, j),
            r"f⁻_ij f⁺_ij is not linear in quantities that depend on the radii; mean\(",
        ),
        (FORCE**2, r"f⁺_ij² is not linear"),
        (FORCE / f_minus(i, j), "divides by a quantity that depends on the radii"),
        (sympy.sin(FORCE), r"sin\(f⁺_ij\) is not linear"),
        (sympy.sqrt(FORCE), r"√\(f⁺_ij\) is not linear"),
        (sympy.exp(phi) * FORCE, r"exp\(φ\) can't be used: .* a symbol of your own"),
        (sympy.sqrt(2) * FORCE, "can't be used"),
        (0.5 * FORCE, r"is a float: write a fraction, such as Rational\(1, 2\)"),
        (sympy.I * FORCE, "I can't be used"),
        (sympy.nan * FORCE, "nan can't be used"),
        (sympy.oo * FORCE, "oo can't be used"),
        (own("phi") * FORCE, "phi is not the phi of force_diffusion.symbols: import"),
        (f_plus(own("i"), j), "i is not the i of force_diffusion.symbols"),
        (own("j", integer=True) * FORCE, "j is not the j of"),
        (own("a") * own("a", real=True) * FORCE, "two symbols have the name a"),
        (own("a b") * FORCE, "a b: a constant has to be commutative, and its name has to be"),
        (own("lambda") * FORCE, "lambda: a constant has to be commutative"),
        (own("A", commutative=False) * FORCE, "A: a constant has to be commutative"),
        (z * FORCE, "z can't be used in an observable: write j/M"),
        (f_plus(i + 2 * n, j), "n can't be used in an observable"),
        (m * FORCE, "m can't be used in an observable"),
        (
            f_plus(own("a"), j),
            "f⁺_aj is at a: only whole numbers and i, j, k, l, p, q, M, N, times",
        ),
        (f_plus(i + sympy.Rational(1, 2), j), r"is at i \+ 1/2: only whole numbers"),
        (f_plus(i, j**2), "is at j²: only whole numbers"),
        (f_plus(i * M, j), "is at M i: only whole numbers"),
        (f_plus(phi, j), "is at φ: only whole numbers"),
        (f_plus(i + 2**70, j), "whole numbers"),
        (FORCE + f_plus(i + 1, j), r"i \+ j must be even for each bead \(i, j\)"),
        (FORCE - f_plus(i + p, j) + f_plus(i + p + 1, j), "no packing has these beads"),
        (f_plus(1, 2), "no packing has these beads"),
        (f_plus(1, -1), "no packing has these beads: a layer is too low or too high"),
        (f_plus(1, -1) + FORCE, "no packing has these beads: a layer is too low or too high"),
        (f_plus(i, M), "no packing has these beads: a layer is too low or too high"),
        (f_along(1, i, j, k), "is a force between spheres: give dimension=3"),
        (Load(i, j), "Fˡᵒᵃᵈ_ij does not depend on the radii, or is not known"),
        (Position(i, j), "x_ij does not depend on the radii, or is not known"),
        (delta_x(i, j), r"δx_ij is a vector: take a component, such as dot\(e_y, …\)"),
        (delta_x(i, j) ** 2, "δx_ij is a vector, which has no powers"),
        ("f_plus(i, j)", "is text: write it with the symbols of force_diffusion.symbols"),
        (None, "None is not a SymPy expression"),
        ([FORCE], "is not a SymPy expression"),
        (sympy.Eq(FORCE, 1), "is not a SymPy expression"),
        (sympy.eye(2), "can't be used"),
        (f_plus, r"ForcePlus needs a place, such as \(i, j\)"),
    ],
)
def test_observables(observable: Any, says: str) -> None:
    with pytest.raises(ObservableError, match=says):
        fd.variance(observable)


def test_either_observable_of_a_covariance() -> None:
    for pair in ((FORCE, FORCE**2), (FORCE**2, FORCE)):
        with pytest.raises(ObservableError, match="is not linear"):
            fd.covariance(*pair)


@pytest.mark.parametrize(
    ("load", "says"),
    [
        *((one, r"'surface', 'bulk', point\(k, l\) and leaning\(t\) are allowed")
          for one in ("point", "Surface", "", None, 3, [], {}, FORCE, fd.PointLoad)),
    ],
)  # fmt: skip
def test_loads(load: Any, says: str) -> None:
    with pytest.raises(ObservableError, match=says):
        fd.variance(FORCE, load=load)


@pytest.mark.parametrize("load", ["leaning", None, [], fd.leaning(t), 2])
def test_loads_on_spheres(load: Any) -> None:
    with pytest.raises(ObservableError, match=r"'surface leaning', .* allowed in three dimensions"):
        fd.variance(f_along(1, i, j, k), load=load, dimension=3)


@pytest.mark.parametrize("ratio", [0, -1, 0.5, "u", own("t"), phi, sympy.pi, None, float("nan")])
def test_ratios(ratio: Any) -> None:
    with pytest.raises(ObservableError, match="the symbol t or a positive rational is allowed"):
        fd.leaning(ratio)


@pytest.mark.parametrize("wrapped", [str, lambda code: [code], Exception])
@pytest.mark.parametrize(
    "ask",
    [
        fd.leaning,
        fd.variance,
        fd.mean,
        lambda text: fd.covariance(f_plus(i, j), text),
        lambda text: fd.mean_over(text, 2),
        lambda text: fd.mean_over(f_plus(i, j), text),
        lambda text: fd.variance(f_plus(i, j), where=text),
    ],
)
def test_text_is_never_evaluated(ask: Any, wrapped: Any, tmp_path: Path) -> None:
    code = f"__import__('pathlib').Path({str(tmp_path / 'evaluated')!r}).touch()"
    with pytest.raises(ObservableError):
        ask(wrapped(code))
    assert not list(tmp_path.iterdir())


def test_other_loads() -> None:
    with pytest.raises(ObservableError, match="'surface' or 'bulk' is allowed"):
        fd.leaning(t, "point")
    for place in ((i, j), (0, 4), (l, k)):
        with pytest.raises(ObservableError, match=r"name the loaded bead \(k, l\)"):
            fd.point(*place)


@pytest.mark.parametrize("dimension", [1, 4, "3", None, 2.5, [3]])
def test_dimensions(dimension: Any) -> None:
    with pytest.raises(ObservableError, match="2 and 3 are allowed"):
        fd.variance(FORCE, dimension=dimension)


def test_discs_and_spheres() -> None:
    with pytest.raises(ObservableError, match=r"is a quantity of discs: .* take f_along"):
        fd.variance(FORCE, dimension=3)
    for axis in (0, 4, i):
        with pytest.raises(ObservableError, match="1, 2 and 3 are allowed"):
            fd.variance(f_along(axis, i, j, k), dimension=3)
    with pytest.raises(ObservableError, match="that is not known in three dimensions"):
        fd.mean(f_along(1, i, j, k), order=2, dimension=3)


@pytest.mark.parametrize("order", [0, 3, "2", None, 1.5])
def test_orders(order: Any) -> None:
    with pytest.raises(ObservableError, match="1 and 2 are allowed"):
        fd.mean(FORCE, order=order)


def test_second_order() -> None:
    with pytest.raises(ObservableError, match="the power 5 of f⁺_ij is not a whole number up to 4"):
        fd.mean(FORCE**5, order=2)
    with pytest.raises(ObservableError, match="divides by a quantity that depends on the radii"):
        fd.mean(1 / FORCE, order=2)


@pytest.mark.parametrize("where", ["j >= 2", [j], phi > 0, None, 3, [j > 2, "M"], j**2 > 3])
def test_domains(where: Any) -> None:
    with pytest.raises(ObservableError, match="relations between indices are allowed, such as"):
        fd.variance(FORCE, where=where)


def test_a_domain_with_nothing_in_it() -> None:
    with pytest.raises(ObservableError, match="no packing has these beads"):
        fd.variance(FORCE, where=j >= M)


@pytest.mark.parametrize("count", [0, -1, 2.5, "N", None, own("N"), own("a"), N / 2, N**2])
def test_numbers_of_neighbours(count: Any) -> None:
    with pytest.raises(ObservableError, match="a whole number from 1 on"):
        fd.variance(fd.mean_over(FORCE, count))


@pytest.mark.parametrize(
    "observable", [f_plus(1, j), f_plus(p, j), FORCE + f_plus(k, l), sympy.S.One]
)
def test_neighbours_need_a_place(observable: sympy.Expr) -> None:
    with pytest.raises(ObservableError, match="write horizontal places with the index i"):
        fd.mean_over(observable, N)


def test_averages_of_averages_of_averages() -> None:
    with pytest.raises(ObservableError, match="are not supported"):
        fd.mean_over(fd.mean_over(fd.mean_over(FORCE, 2), 3), N)


# numbers put in

FORM = fd.variance(FORCE)
HERE = {"M": 6, "j": 2, "phi": 0, "sigma": 1, "r": 1}


@pytest.mark.parametrize(
    ("change", "says"),
    [
        ({"j": 6}, r"var\(f⁺_ij\) is for 0 ≤ j ≤ M − 1, not for j = 6, M = 6"),
        ({"j": -1}, "not for j = −1, M = 6"),
        ({"M": 2}, "not for j = 2, M = 2"),
        ({"M": -1, "j": -3}, "not for j = −3, M = −1"),
        ({"j": 0.5}, "j = 1/2: a whole number is allowed"),
        ({"M": np.float64(6.5)}, "M = 13/2: a whole number is allowed"),
        *(({"j": one}, "j = .*: one int, Fraction, SymPy Rational, Decimal or finite float")
          for one in ("1", None, 1 + 2j, float("nan"), sympy.nan, sympy.I, own("j"), b"1", {1})),
        ({"M": sympy.oo}, "M = oo: one int"),
        ({"phi": 0.5}, "phi = 0.5: −1/2 < φ < 1/2 is allowed"),
        ({"r": 0}, "r = 0: a number above 0 is allowed"),
        ({"sigma": -1}, "sigma = -1: a number from 0 on is allowed"),
        ({"phi": sympy.pi / 10}, "phi = pi/10: one int"),
        ({"x": 1}, r"holds no x: var\(f⁺_ij\) takes M, j, phi, sigma, r"),
        ({"i": 1}, "holds no i"),
        ({"j": [0, 6]}, r"element \[1\]: .*not for j = 6"),
    ],
)  # fmt: skip
def test_values(change: dict[str, Any], says: str) -> None:
    with pytest.raises(ArgumentError, match=says):
        FORM.at(**{**HERE, **change})


@pytest.mark.parametrize("name", HERE)
def test_missing_values(name: str) -> None:
    with pytest.raises(ArgumentError, match=f"{name} missing: "):
        FORM.at(**{one: value for one, value in HERE.items() if one != name})


def test_where_no_bead_is() -> None:
    covariance = fd.covariance(FORCE, f_plus(i + p, l))
    assert covariance.at(l=3, p=1, **HERE) != 0
    with pytest.raises(ArgumentError, match=r"j \+ l \+ p even, not for .* p = 2"):
        covariance.at(l=3, p=2, **HERE)
    below = fd.variance(fd.response(i, j), load=fd.point(k, l))
    place = {"phi": 0, "sigma": 1, "r": 1, "i": 0, "j": 2, "k": 0, "l": 4}
    assert below.at(**place) != 0
    for change in ({"i": 1}, {"k": 1}, {"j": 1}, {"l": 3}):
        with pytest.raises(ArgumentError, match="i \\+ j even, k \\+ l even, not for"):
            below.at(**{**place, **change})


def test_division_by_zero() -> None:
    with pytest.raises(ObservableError, match="the divisor M − 2 j may be zero"):
        fd.mean(FORCE / (M - 2 * j))
    assert fd.mean(FORCE / (M - 2 * j), where=2 * j <= M - 1).at(M=5, j=2) == 1
    a = own("a")
    form = fd.mean(FORCE / (a - 1))
    assert form.at(M=5, j=2, a=3) == sympy.Rational(1, 2)
    with pytest.raises(ArgumentError, match="it has no value there: it divides by 0"):
        form.at(M=5, j=2, a=1)
    with pytest.raises(ObservableError, match="divides by 0 under this load"):
        fd.mean(FORCE / (1 - t), load=fd.leaning(1))
