"""Printers: the paper's notation, its order of terms, and lines that fit."""

import re

import pytest
import sympy
from force_diffusion.derivations.framework.catalogue import modules
from force_diffusion.derivations.framework.record import load
from force_diffusion.derivations.framework.rows import Row
from force_diffusion.symbolic import symbols as sy
from force_diffusion.symbolic.as_printed import minus, power, terms, times
from force_diffusion.symbolic.printing.code import python_source, sympy_source
from force_diffusion.symbolic.printing.latex import latex
from force_diffusion.symbolic.printing.lines import (
    LINE_WIDTH,
    folded,
    latex_lines,
    split_fraction,
    text_lines,
    width,
)
from force_diffusion.symbolic.printing.structure import in_order
from force_diffusion.symbolic.printing.text import text
from force_diffusion.symbolic.symbols import M, i, j, m, phi, r, sigma, z
from force_diffusion.symbolic.trees import equation
from hypothesis import given
from hypothesis import strategies as st

from tests.derivations.rows import each

HALF = sympy.Rational(1, 2)


@pytest.mark.parametrize(
    ("expression", "source", "plain"),
    [
        (sy.DeltaR(-j + i, 0), r"\delta r_{i-j,0}", "δr_(i−j,0)"),
        (sy.DeltaR(2 + i + j - m, m), r"\delta r_{i+j-m+2,m}", "δr_(i+j−m+2,m)"),
        (terms(times(2, z), 1), "2 z + 1", "2 z + 1"),
        (minus(HALF * M), r"-\frac{M}{2}", "−M/2"),
        (M / (2 * r), r"\frac{M}{2 r}", "M/(2 r)"),
        (sy.ForcePlus(i, j) ** 2, r"(f^{+}_{ij})^{2}", None),
        (terms(1, sy.Dot(sy.n_plus, sy.DeltaNPlus(i, j))), None, "1 + n⁺·δn⁺_ij"),
        (sympy.Le(j, M - 1), None, "j ≤ M − 1"),
        (sympy.Eq(j, 0), None, "j = 0"),
        (times(1 / r, minus(times(2, z))), r"\frac{1}{r} (-2 z)", "(1/r) (−2 z)"),
        (times(2, power(-1, -1)), r"\frac{2}{-1}", None),
    ],
)
def test_notation(expression, source, plain):
    if source is not None:
        assert latex(expression) == source
    if plain is not None:
        assert text(expression) == plain


def test_the_order_in_which_it_was_built_is_kept():
    built = terms(sy.DeltaR(j, i), minus(sy.DeltaR(i, j)), times(r, terms(j, i)))
    assert text(built) == "δr_ji − δr_ij + r (j + i)"


def test_brackets_grow_outwards():
    inner = terms(i, j)
    middle = terms(1, times(2, inner))
    outer = times(r, terms(z, times(r, middle)))
    assert text(outer) == "r {z + r [1 + 2 (i + j)]}"
    assert latex(times(r, middle)) == r"r \left[ 1 + 2 (i + j) \right]"


def long_sum(count: int) -> sympy.Expr:
    return terms(*(times(number + 2, sy.DeltaR(i + number, j)) for number in range(count)))


@given(st.integers(1, 60))
def test_long_equations_fit_their_lines_and_lose_nothing(count):
    printed = equation(M, long_sum(count))
    lines = latex_lines(printed)
    assert all(width(line) <= LINE_WIDTH * 1.02 for line in lines)
    assert sum(line.count(r"\delta r") for line in lines) == count
    plain = text_lines(printed, room=80)
    assert all(len(line) <= 80 for line in plain)
    assert "".join(plain).count("δr") == count


def test_a_wide_product_is_broken_within_its_bracket():
    printed = equation(M, times(r, long_sum(40)))
    lines = latex_lines(printed)
    assert len(lines) > 1
    joined = " ".join(lines)
    assert joined.count(r"\biggl\{") == joined.count(r"\biggr\}") == 1
    assert r"\left" not in joined  # a pair may not span two lines


POINT = {M: 7, j: 3, phi: 5, r: 11, sigma: 13, z: 17}
numbers = st.fractions(max_denominator=9).map(lambda f: sympy.Rational(f.numerator, f.denominator))
atoms = st.sampled_from([M, j, phi, r, sigma, z]) | numbers
scalars = st.recursive(
    atoms,
    lambda inner: (
        st.builds(lambda a, b: a + b, inner, inner)
        | st.builds(lambda a, b: a * b, inner, inner)
        | st.builds(lambda a, n: a**n if a != 0 else a, inner, st.integers(-2, 3))
    ),
    max_leaves=8,
)


@given(scalars)
def test_sympy_source_reads_back(expression):
    read = eval(sympy_source(expression), {**vars(sympy), **vars(sy)})
    assert (read + sympy.S.Zero).subs(POINT) == expression.subs(POINT)


@given(scalars)
def test_printers_take_any_scalar_and_balance_their_brackets(expression):
    source, plain = latex(expression), text(expression)
    assert source.count("{") == source.count("}")
    assert source.count(r"\left") == source.count(r"\right")
    assert all(plain.count(a) == plain.count(b) for a, b in ("()", "[]", "{}"))


@given(scalars)
def test_text_can_be_read_in_one_way(expression):
    """Put back into Python, the text has the value of the expression."""
    plain = text(expression).translate(str.maketrans("[]{}−φ", "()()-f")).replace("σ_δr", "s")
    plain = re.sub("[⁰¹²³⁴⁵⁶⁷⁸⁹]+", lambda match: "**" + sympy_digits(match[0]), plain)
    plain = re.sub(r"\^\((-?\d+)\)", r"**(\1)", plain)
    plain = re.sub(r"(?<=[\w)]) (?=[\w(])", "*", plain)
    names = {text(symbol)[0]: sympy.Integer(value) for symbol, value in POINT.items()}
    names["f"], names["s"] = names.pop("φ"), names.pop("σ")
    plain = re.sub(r"(?<![\w.])(\d+)", r"Integer(\1)", plain)
    result = eval(plain, {"Integer": sympy.Integer}, names)
    expected = expression.subs(POINT)
    assert result == expected or expected in (sympy.zoo, sympy.nan)


def sympy_digits(raised: str) -> str:
    return raised.translate(str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹", "0123456789"))


def test_python_source_takes_any_number_type():
    scope: dict[str, object] = {}
    exec(python_source("f", "Doc.", M**2 / (2 * r) + sympy.Sum(sy.DeltaR(m, j), (m, 1, M))), scope)
    function = scope["f"]
    assert function(M=3, j=0, r=9.0, dr=lambda a, b: a + b) == 6.5  # type: ignore[operator]


def test_no_fraction_has_three_storeys():
    product = times(1 + j, power(sigma / r, 2), power(M, -1))
    assert latex(product) == r"\frac{j + 1}{M} \left( \frac{\sigma_{\delta r}}{r} \right)^{2}"
    assert text(product).count("/") == 2
    other = times(terms(j, z / r), power(M, -1))
    assert latex(other) == r"\frac{1}{M} \left( j + \frac{z}{r} \right)"


def test_no_line_is_a_lone_factor():
    first, last = folded(r"a = \frac{1}{b} (c + d) (e + f) (g)^2", 110)
    assert last.startswith(r"\times (e + f) (g)^2")
    assert first == r"a = \frac{1}{b} (c + d)"


@pytest.mark.parametrize(
    ("factor", "shown"),
    [(terms(1, phi), ("(φ + 1)", r"(\phi + 1)")), (sigma**2 / (2 * r), ("σ_δr²", r"\sigma"))],
    ids=["a bracket", "a fraction"],
)
def test_a_broken_product_keeps_its_first_factor(factor, shown):
    product = times(factor, terms(*(sy.DeltaR(i + k, j) for k in range(9))))
    for lines, part in zip(
        (text_lines(product, room=40), latex_lines(product, room=120.0)), shown, strict=True
    ):
        assert len(lines) > 1
        assert part in " ".join(lines)
        assert "GAP" not in " ".join(lines)  # which stands in for a fraction while it is broken


@pytest.mark.parametrize("room", [120, 222, 330])
@pytest.mark.parametrize("number", each(modules()))
def test_lines_put_together_are_the_formula(number, room):
    """Nothing is lost or doubled, and a line that was broken fits."""
    derivation = load(number)
    formulas = [] if isinstance(derivation, Row) else [*derivation.printed]
    for form in derivation.exact_forms.values():
        formulas += [equation(form.quantity, piece.expr) for piece in form.pieces]
    for line in formulas:
        whole = " ".join(f"{latex(line.lhs)} = {latex(line.rhs)}".split())
        lines = folded(whole, room)
        joined = " ".join(lines).replace(r" \times ", " ")
        joined = joined.replace(r"\biggl", r"\left").replace(r"\biggr", r"\right")
        assert joined in (whole, split_fraction(whole, room))
        # what a fraction leaves that was made a product is estimated before it is put in brackets
        assert all(width(part) <= room + 4 for part in lines[:-1])
        assert all(part.count(r"\left") == part.count(r"\right") for part in lines)


@pytest.mark.parametrize("number", each(modules()))
def test_a_polynomial_in_order_is_the_same(number):
    """Its parts are factored, each with its sign, and add up to it."""
    for form in load(number).exact_forms.values():
        for piece in form.pieces:
            for polynomial in piece.expr.atoms(sympy.Add):
                assert sympy.expand(sympy.Add(*in_order(polynomial)) - polynomial) == 0


def test_the_highest_degree_comes_first_factored():
    form = sympy.expand(8 * (M - j) ** 2 * (M + 2 * j) - 6 * M + M * (1 - phi) ** 2 + phi + 1)
    assert text(form) == "8 (M − j)² (M + 2 j) + M (φ² − 2 φ − 5) + φ + 1"
    assert text(sympy.expand(j * (7 - 2 * phi) - j**2 * (1 - phi) ** 4 + 1)) == (
        "1 − j² (1 − φ)⁴ − j (2 φ − 7)"
    )
