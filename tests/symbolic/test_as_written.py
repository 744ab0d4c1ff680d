"""Formulas read from text: what is read is what is written, and all else is refused, with where."""

from collections.abc import Iterator

import pytest
import sympy
from force_diffusion.derivations.framework.catalogue import modules
from force_diffusion.derivations.framework.loading import load
from force_diffusion.derivations.framework.rows import Row
from force_diffusion.symbolic import symbols as sy
from force_diffusion.symbolic.as_printed import minus, power, terms, times
from force_diffusion.symbolic.as_written import VOCABULARY, FormulaError, formula, relations
from force_diffusion.symbolic.notation import Symbol
from force_diffusion.symbolic.printing.structure import rebuilt
from force_diffusion.symbolic.printing.text import text
from force_diffusion.symbolic.symbols import M, N, j, l, phi, q, r, sigma, z
from sympy import Eq, Ge, Integer, Le, Rational

UPPER = Symbol("z_upper", "z'", "z′", positive=True)
RATIO = Symbol("ratio", "R", "⟨S_xx⟩/⟨S_yy⟩ − 1")


@pytest.mark.parametrize(
    ("written", "meant"),
    [
        ("φ", phi),
        ("−φ²", minus(phi**2)),
        ("-φ²", minus(phi**2)),
        ("(−φ)²", power(minus(phi), 2)),
        ("2 − φ", terms(2, minus(phi))),
        ("φ − 2", terms(phi, Integer(-2))),
        ("φ − 3/4", terms(phi, Rational(-3, 4))),
        ("z + j + 1", terms(z, j, Integer(1))),
        (
            "4j(1 + φ) − 8φM + 4φ + φ² − φ³",
            terms(
                times(4, j, terms(1, phi)),
                minus(times(8, phi, M)),
                times(4, phi),
                phi**2,
                minus(phi**3),
            ),
        ),
        ("(1 − φ)²/(M − j)", times(terms(1, minus(phi)) ** 2, 1 / (M - j))),
        ("9φ²/4", times(Rational(9, 4), phi**2)),
        ("(M − j)φ/2", times(Rational(1, 2), terms(M, minus(j)), phi)),
        ("4φ/2", times(4, Rational(1, 2), phi)),
        ("1/(12N²(1 − φ²)²)", times(Rational(1, 12), N**-2, (1 - phi**2) ** -2)),
        ("1/(2φ)²", power(times(2, phi), -2)),
        ("1/(1 − φ)", 1 / (1 - phi)),
        ("1/(−φ)", power(minus(phi), -1)),
        ("1/φ²", phi**-2),
        ("1/√M", M ** Rational(-1, 2)),
        ("φ/(1/M)", times(phi, power(1 / M, -1))),
        ("(φ/M)z", times(times(phi, 1 / M), z)),
        ("(σ_δr/r)²", power(times(sigma, 1 / r), 2)),
        ("M^(3/2)", M ** Rational(3, 2)),
        ("M^(−2/3)", M ** Rational(-2, 3)),
        ("t⁻¹", 1 / sy.t),
        ("φ¹²", phi**12),
        ("n_yn", times(sy.n_y, sy.n)),
        ("jl", times(j, l)),
        ("mg z", times(sy.m_g, z)),
        ("m g_x", times(sy.m, Symbol("g_x"))),
        ("f_load/(2n_y)", times(Rational(1, 2), sy.f_load, 1 / sy.n_y)),
        ("z′ − z", terms(UPPER, minus(z))),
        ("2{1 − [z + (j − 1)]}", times(2, terms(1, minus(terms(z, terms(j, Integer(-1))))))),
        ("(L⁺)²", sy.L_plus**2),
        ("⟨S_xx⟩/⟨S_yy⟩ − 1 + z", terms(RATIO, z)),
        ("\n 1 \n +  z ", terms(1, z)),
    ],
)
def test_it_is_read_as_it_is_written(written: str, meant: sympy.Expr) -> None:
    assert sympy.srepr(formula(written, UPPER, RATIO, Symbol("g_x"))) == sympy.srepr(meant)
    assert formula(written, UPPER, RATIO, Symbol("g_x")).args == meant.args  # in this order


@pytest.mark.parametrize(
    ("written", "at", "words"),
    [
        ("", "at its end", "is missing"),
        ("()", "“)”, character 2", "is missing"),
        ("+φ", "“+φ”, character 1", "a minus also before the first"),
        ("1 + +φ", "“+φ”, character 5", "signs stand between two terms"),
        ("1 − −φ", "“−φ”, character 5", "signs stand between two terms"),
        ("−−φ", "“−φ”, character 2", "signs stand between two terms"),
        ("2−", "at its end", "is missing"),
        ("φ(−)", "“)”, character 4", "is missing"),
        ("φ/Mz", "“/Mz”, character 2", "a/(bc)"),
        ("1/2φ", "“/2φ”, character 2", "a/(bc)"),
        ("1/2 φ", "“/2 φ”, character 2", "a/(bc)"),
        ("1/2(1 − φ)", "“/2(1 − φ)”, character 2", "a/(bc)"),
        ("φ/M/z", "“/M/z”, character 2", "a/(bc)"),
        ("φ/0", "“0”, character 3", "divided by zero"),
        ("φ/(0M)", "“(0M)”, character 3", "divided by zero"),
        ("φ/−M", "“−M”, character 3", "signs stand between"),
        ("φ2", "“2”, character 2", "in front of"),
        ("2 3", "“3”, character 3", "in front of"),
        ("0.5", "“.5”, character 2", "continues no formula"),
        ("1e3", "“e3”, character 2", "continues no formula"),
        ("1,5", "“,5”, character 2", "continues no formula"),
        ("2·φ", "“·φ”, character 2", "continues no formula"),
        ("2*φ", "“*φ”, character 2", "continues no formula"),
        ("φ**2", "“**2”, character 2", "continues no formula"),
        ("φ^2", "“^2”, character 2", "whole number raised"),
        ("φ^(j)", "“^(j)”, character 2", "whole number raised"),
        ("φ^(1/2)²", "“²”, character 8", "power of a power"),
        ("φ⁻", "“⁻”, character 2", "whole number"),
        ("φ¹", "“¹”, character 2", "nobody writes"),
        ("φ⁰", "“⁰”, character 2", "nobody writes"),
        ("φ²⁻¹", "“²⁻¹”, character 2", "whole number"),
        ("φ²^(2)", "“^(2)”, character 3", "power of a power"),
        ("φ ²", "“²”, character 3", "continues no formula"),
        ("²", "“²”, character 1", "is missing"),
        ("√M²", "“√M²”, character 1", "how far"),
        ("√√M", "“√M”, character 2", "is missing"),
        ("√2M", "“√2M”, character 1", "how far"),
        ("√M(1 + φ)", "“√M(1 + φ)”, character 1", "how far"),
        ("L⁺²", "“L⁺²”, character 1", "(L⁺)²"),
        ("L⁻¹", "“L⁻¹”, character 1", "(L⁻)²"),
        ("(φ]", "“]”, character 3", "“)” is missing, for the bracket at character 1"),
        ("[φ)", "“)”, character 3", "“]” is missing, for the bracket at character 1"),
        ("[(φ)", "at its end", "“]” is missing, for the bracket at character 1"),
        ("φ)", "“)”, character 2", "continues no formula"),
        ("x + φ", "“x + φ”, character 1", "The names are"),
        ("phi", "“phi”, character 1", "is a word"),
        ("sqrt(M)", "“sqrt(M)”, character 1", "is a word"),  # not s q r t M
        ("2pi", "“pi”, character 2", "is a word"),
        ("jlM", "“jlM”, character 1", "Leave blanks"),
        ("mgz", "“mgz”, character 1", "Leave blanks"),
        ("ϕ", "“ϕ”, character 1", "The names are"),  # another letter than φ
        ("–φ", "“–φ”, character 1", "is missing"),  # a dash is no minus
        ("φ\u00a0+ 1", "“\u00a0+ 1”, character 2", "continues no formula"),
        ("٣φ", "“٣φ”, character 1", "is missing"),  # a digit of another script
        ("½φ", "“½φ”, character 1", "is missing"),
        ("z′", "“′”, character 2", "continues no formula"),  # not declared here
        ("n_z", "“_z”, character 2", "continues no formula"),
        ("f_ij", "“f_ij”, character 1", "is missing"),
        ("j = 1", "“= 1”, character 3", "continues no formula"),
        ("(" * 50 + "φ" + ")" * 50, "character 41", "at most 40 brackets"),
        ("__import__('os')", "“__import__('os')”, character 1", "is missing"),
    ],
)
def test_all_else_is_refused_and_where(written: str, at: str, words: str) -> None:
    with pytest.raises(FormulaError) as refused:
        formula(written)
    assert at in str(refused.value)
    assert words in str(refused.value)


def test_names_that_may_be_read_in_two_ways_are_refused() -> None:
    ab = Symbol("ab")
    with pytest.raises(FormulaError, match="ab, or a and more"):
        formula("4ab²(c)", ab, Symbol("b"), Symbol("a"))
    with pytest.raises(FormulaError, match="xβ, or x and more"):
        formula("xβγ", Symbol("xβ"), Symbol("x"), Symbol("βγ"), Symbol("γ"))
    assert formula("ab c", ab, Symbol("c")) == ab * Symbol("c")
    with pytest.raises(FormulaError, match=r"n⁻, or n and more|a power of n⁻"):
        formula("n⁻¹", sy.n_minus)
    with pytest.raises(FormulaError, match="two symbols have the name p"):
        formula("p", Symbol("p_bead", "p", "p"))
    with pytest.raises(FormulaError, match="two symbols have the name r"):
        formula("r", sy.site_r)


def test_what_is_long_is_refused_at_once() -> None:
    with pytest.raises(FormulaError, match="too long"):
        formula("1" * 5000)
    assert formula("9⁹⁹⁹⁹⁹⁹⁹⁹⁹").exp == 999999999  # and never carried out
    with pytest.raises(FormulaError, match="too large"):
        relations("9⁹⁹⁹⁹⁹⁹⁹⁹⁹ ≤ j")
    nested = "1/(" * 39 + "φ" + ")" * 39
    assert text(formula(nested)).count("φ") == 1


@pytest.mark.parametrize(
    ("written", "meant"),
    [
        ("2 ≤ j ≤ l − 2 and l < M", (Ge(j, 2), Le(j, l - 2), sympy.Lt(l, M))),
        ("N = j ≥ 2, M ≥ j + 2", (Eq(N, j), Ge(j, 2), Ge(M, j + 2))),
        ("M ≥ 1", (Ge(M, 1, evaluate=False),)),
        ("0 > q", (sympy.Lt(q, 0),)),
        ("M = 2j", (Eq(M, 2 * j),)),
    ],
)
def test_relations(written: str, meant: tuple[sympy.Basic, ...]) -> None:
    assert relations(written) == meant


@pytest.mark.parametrize(
    ("written", "words"),
    [
        ("j", "one of = ≤ < ≥ > is missing"),
        ("j, q ≥ 1", "one of = ≤ < ≥ > is missing"),
        ("0 ≤ j > 2", "a chain goes one way"),
        ("j ≥ 2 and", "is missing"),
        ("j ≥ 2 or j = 0", "continues no formula"),
        ("j ≠ 2", "one of = ≤ < ≥ > is missing"),
        ("j >= 2", "is missing"),
        ("≤ 2", "is missing"),
    ],
)
def test_no_relations(written: str, words: str) -> None:
    with pytest.raises(FormulaError, match=words):
        relations(written)


# the printed statements and their exact forms


def _all() -> Iterator[tuple[str, sympy.Expr]]:
    for number in modules():
        derivation = load(number)
        for part, one in enumerate(() if isinstance(derivation, Row) else derivation.printed):
            yield from ((f"Eq. {number}, {part} {side}", one.args[side]) for side in (0, 1))
        for name, form in derivation.exact_forms.items():
            yield from ((f"Eq. {number}, {name}", piece.expr) for piece in form.pieces)


def test_what_the_printer_writes_is_read_again() -> None:
    read, left = 0, []
    for name, expression in _all():
        if expression.has(sy.SiteFunction, sympy.Sum, sy.Dot):
            left.append(name)
            continue
        own = expression.free_symbols - {*VOCABULARY}
        found = formula(text(expression), *own)
        assert sympy.cancel(rebuilt(found).doit() - expression.doit()) == 0, name
        if " r" in name or name[-2:] in (" 0", " 1"):  # printed: word by word
            assert text(found) == text(expression), name
        read += 1
    assert read > 350
    # sums and quantities of a bead are not in the language
    numbers = {name.split(",")[0].removeprefix("Eq. ") for name in left}
    assert numbers == {*map(str, range(1, 13)), "B1"}
