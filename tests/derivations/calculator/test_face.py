"""What a user types: calls, symbols, and constants of one's own."""

import pickle
import subprocess
import sys
from fractions import Fraction

import pytest
import sympy
from force_diffusion.derivations.calculator.observables import INDICES, NAMED

import force_diffusion as fd
from force_diffusion import symbols
from force_diffusion.symbols import (
    M, N, delta_n_plus, delta_r, delta_x, dot, e_x, e_y, f_load, f_minus, f_plus, i, j, k, l,
    m_g, n_minus, n_y, p, p_plus, phi, r, sigma,
)  # fmt: skip

_CALLS = """
import sys
import force_diffusion as fd
assert not {"sympy", "numpy", "flint", "islpy"} & {*sys.modules}, sorted(sys.modules)
from force_diffusion.symbols import f_minus, f_plus, i, j
assert isinstance(fd.variance(f_plus(i, j) - f_minus(i, j), load="surface"), fd.ClosedForm)
"""

HERE = {"M": 6, "j": 2, "phi": Fraction(1, 3), "sigma": 1, "r": 1}


def test_calls_of_a_fresh_process():
    command = [sys.executable, "-c", _CALLS]
    done = subprocess.run(command, check=False, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr


def test_every_symbol_is_documented():
    words = symbols.__doc__ or ""
    for name in symbols.__all__:
        assert f"``{name}``" in words or f"``{name}(" in words, name


def test_symbols_that_others_may_be_taken_for_are_those_of_the_module():
    assert {*NAMED} == {*symbols.__all__}
    assert all(name == each.name for name, each in NAMED.items() if isinstance(each, sympy.Symbol))
    assert {*INDICES} <= {*NAMED.values()}
    for name in ("f_plus", "delta_r", "M"):  # else f_plus would be a constant, without variance
        with pytest.raises(fd.ForceDiffusionError, match=f"{name} is not the {name} of"):
            fd.variance(sympy.Symbol(name))


# constants


def test_a_constant_stands_in_the_answer_and_is_asked_for():
    a, b = sympy.symbols("a b")
    form = fd.variance(a * f_plus(i, j) - b * f_minus(i, j))
    assert all(piece.expr.free_symbols >= {a, b} for piece in form.pieces)
    three = fd.variance(3 * f_plus(i, j) + f_minus(i, j) / 2).at(**HERE)
    assert form.at(a=3, b=Fraction(-1, 2), **HERE) == three
    assert form.at(a=[3, 3], b=Fraction(-1, 2), **HERE).tolist() == [three, three]
    with pytest.raises(fd.ForceDiffusionError, match=r"a must be given: .* takes M, j"):
        form.at(b=1, **HERE)
    assert fd.mean(sympy.Symbol("self") * f_plus(i, j)).at(self=3, M=2, j=1) == 3


def test_a_constant_in_source_leading_orders_and_candidates():
    a = sympy.Symbol("a", positive=True)
    form, plain = fd.variance(f_plus(i, j) / a), fd.variance(f_plus(i, j))
    names: dict[str, object] = {}
    exec(form.python(), names)
    assert names["closed_form"](a=2, **HERE) == form.at(a=2, **HERE)  # type: ignore[operator]
    assert sympy.simplify(form.leading() * a**2 - plain.leading()) == 0
    first = plain.pieces[0].expr
    assert form.on(j >= 2, j <= M - 2).equals(first / a**2)
    mean = fd.mean(f_plus(i, j) / a)
    assert str(mean.decide(1 / a)).startswith("proved")
    ruling = str(mean.decide(2 / a))
    assert ruling.startswith("refuted")
    doubled = fd.mean(a * f_plus(i, j)).decide(3 * a)
    assert str(doubled) == "refuted: at j = 0, M = 1: left minus right is −2 a"
    assert str(mean.decide(sympy.Symbol("a"))).startswith("not a statement: this a is not that of")
    assert str(mean.decide(sympy.Symbol("b"))).startswith("not a statement: b is not a symbol of")


def test_leading_orders_that_depend_on_other_indices_are_refused():
    first, second = fd.variance(f_plus(i, j)), fd.covariance(f_plus(i, j), f_plus(k, j))
    assert sympy.simplify(second.on(sympy.Eq(k, i), j >= 2, j <= M - 2) - first.pieces[0].expr) == 0
    with pytest.raises(fd.ForceDiffusionError, match="its leading orders differ, as for"):
        second.leading()
    assert second.leading(1, sympy.Eq(k, i)) == first.leading(1)
    with pytest.raises(fd.ForceDiffusionError, match="phi - 1 is not affine in the indices"):
        second.leading(1, phi > 0)
    third = fd.covariance(f_plus(i, j), f_plus(i + 2 * p, j))
    for form, relation in ((first, j >= M - 3), (first, j <= 3), (third, p >= j)):
        with pytest.raises(fd.ForceDiffusionError, match="at fixed z = j/M"):
            form.leading(1, relation)


def test_six_constants_and_no_more():
    several = sympy.symbols("a:7")
    six = fd.mean(sum(several[:6]) * f_plus(i, j))
    assert six.at(M=2, j=0, **{f"a{n}": n for n in range(6)}) == 15
    with pytest.raises(fd.ForceDiffusionError, match="more than 6 symbols of your own"):
        fd.mean(sum(several) * f_plus(i, j))


# units


@pytest.mark.parametrize(
    ("observable", "load", "unit"),
    [
        (f_plus(i, j), "surface", f_load / (2 * n_y)),
        (f_plus(i, j), "bulk", (M - j) * m_g / (2 * n_y)),
        (p_plus(i, j), "surface", f_load),
        (p_plus(i, j), "bulk", (M - j) * m_g),
        (dot(e_y, delta_x(i, j)), "surface", r),
        (delta_r(i, j), "surface", r),
        (dot(e_x, delta_n_plus(i, j)), "bulk", sympy.S.One),
    ],
)
def test_the_bare_quantity_is_its_unit_times_the_relative_one(observable, load, unit):
    bare = fd.variance(observable, load=load, relative=False)
    relative = fd.variance(observable, load=load)
    given = {f_load: 2, m_g: 3, r: 5, sigma: 7, phi: sympy.Rational(1, 3)}
    names = {"f_load": 2, "m_g": 3, "r": 5, "sigma": 7, "phi": Fraction(1, 3), "M": 4}
    for layer in range(4):
        square = (unit**2).subs(n_y**2, (1 + phi) / 2).subs({**given, M: 4, j: layer})
        at = [
            form.at(j=layer, **{name: names[name] for name in names if name in form.symbols})
            for form in (bare, relative)
        ]
        assert at[0] == square * at[1]


def test_the_ordered_forces_are_means():
    def only(form: fd.ClosedForm) -> sympy.Expr:
        (piece,) = form.pieces
        return piece.expr

    assert only(fd.mean(f_plus(i, j), relative=False)) == f_load / (2 * n_y)
    assert only(fd.mean(f_plus(i, j), load="bulk", relative=False)) == (M - j) * m_g / (2 * n_y)
    assert only(fd.mean(fd.response(i, j), load="bulk", relative=False)) == (M - j) * m_g
    leaning = fd.mean(f_minus(i, j), load=fd.leaning(symbols.t, "bulk"), relative=False)
    assert only(leaning) == symbols.t * symbols.L_plus * (M - j)


# where it holds


@pytest.mark.parametrize(
    ("observable", "words"),
    [
        (f_plus(i, j), "0 ≤ j ≤ M − 1"),
        (f_plus(i, j) + f_plus(i + 1, j + 1), "0 ≤ j ≤ M − 2"),
        (f_plus(i, j - 1) - f_minus(i, j + 1), "1 ≤ j ≤ M − 2"),
        (f_plus(i, j) + delta_r(i + 1, j + 1), "0 ≤ j ≤ M − 1"),
        (f_plus(i, j) + delta_r(i + 2, j + 2), "0 ≤ j ≤ M − 2"),
        (f_plus(0, 2), "M ≥ 3"),
        (dot(e_y, delta_x(i, j)), "j ≥ 0"),
        (sigma, ""),
    ],
)
def test_domains_in_words(observable, words):
    assert fd.variance(observable).domain == words


@pytest.mark.parametrize(
    ("observable", "words"),
    [
        (f_plus(i, j), "forces over their ordered values"),
        (fd.response(i, j), "vertical forces over the load above"),
        (
            f_plus(i, j) + delta_r(i, j),
            "forces over their ordered values, lengths over the mean radius",
        ),
        (dot(n_minus, delta_n_plus(i, j)), ""),
    ],
)
def test_what_quantities_are_divided_by_is_said(observable, words):
    form, bare = fd.variance(observable), fd.variance(observable, relative=False)
    said, bare_said = (str(each).partition("\n")[0] for each in (form, bare))
    assert said == bare_said + (f"; {words}" if words else "")
    assert (rf"\text{{{words}}}" in form.latex()) == bool(words)
    assert fd.equation(13).exact().units == pickle.loads(pickle.dumps(bare)).units == ""
    assert pickle.loads(pickle.dumps(form)).units == words


def test_the_weight_of_a_bead_is_squared_as_a_product():
    form = fd.variance(f_plus(i, j), load="bulk", relative=False)
    assert "(mg)²" in str(form)
    assert "(mg)^{2}" in form.latex()


def test_no_variance_has_a_minus_sign_that_it_can_do_without():
    up = fd.variance(dot(e_y, delta_x(i, j)))
    assert str(up.pieces[0].expr) == "sigma**2*(4*j - 1)/(r**2*(phi + 1))"


def test_a_domain_that_the_caller_gives():
    whole, part = fd.variance(f_plus(i, j)), fd.variance(f_plus(i, j), where=(j >= 2, j <= M - 2))
    assert part.domain == "2 ≤ j ≤ M − 2"
    assert [piece.expr for piece in part.pieces] == [whole.pieces[0].expr]
    assert part.at(**HERE) == whole.at(**HERE)
    assert fd.variance(f_plus(i, j), where=j >= 0).domain == whole.domain


def test_layers_are_those_of_the_contact_and_not_of_the_index():
    moved = fd.variance(f_plus(i, j + 2))
    assert moved.domain == "−2 ≤ j ≤ M − 3"
    assert moved.at(**{**HERE, "j": -2}) == fd.variance(f_plus(i, j)).at(**{**HERE, "j": 0})
    right, left = (fd.covariance(f_plus(i, j), f_plus(i + step, l)) for step in (1, -1))
    assert right.at(**{**HERE, "j": 3, "l": 2}) == left.at(**{**HERE, "j": 2, "l": 3})


def test_neighbours():
    form = fd.variance(fd.mean_over(f_plus(i, j), N))
    assert form.domain == "N ≥ 1, 0 ≤ j ≤ M − 1"
    first, second = (f_plus(i + 2 * n, j) for n in (0, 1))
    assert form.at(N=2, **HERE) == fd.variance((first + second) / 2).at(**HERE)
    assert form.at(N=1, **HERE) == fd.variance(fd.mean_over(f_plus(i, j), 1)).at(**HERE)
    leftwards, at_rest = (fd.mean_over(f_plus(i - p, j), 2, *over) for over in ((p,), (i, p)))
    assert form.at(N=2, **HERE) == fd.variance(leftwards).at(**HERE)
    assert form.at(N=1, **HERE) == fd.variance(at_rest).at(**HERE)
