"""``equation``: SymPy objects with the right symbols, numbers, proofs and verdicts."""

import math
import re
import subprocess
import sys
from collections.abc import Callable
from fractions import Fraction
from typing import Any

import numpy as np
import pytest
import sympy
from force_diffusion.derivations.framework.catalogue import modules, paper
from force_diffusion.derivations.framework.evaluation import ArgumentError
from force_diffusion.numeric import closed_forms
from force_diffusion.numeric.arithmetic.errors import ForceDiffusionError
from force_diffusion.symbolic import symbols as sy
from force_diffusion.symbolic.kernel.decisions import Verdict
from force_diffusion.symbolic.printing.lines import column_width, width
from force_diffusion.symbolic.printing.structure import rebuilt
from hypothesis import given
from hypothesis import strategies as st

import force_diffusion as fd
from tests.properties.mutants import mutants

ALL = [fd.equation(number) for number in modules()]
every_equation = pytest.mark.parametrize("eq", ALL, ids=lambda eq: f"eq{eq.number:02}")
PAPER = [eq for eq in ALL if eq.number in paper()]
every_printed = pytest.mark.parametrize("eq", PAPER, ids=lambda eq: f"eq{eq.number:02}")

fractions = st.fractions(max_denominator=99)
cosines = st.fractions(Fraction(-48, 97), Fraction(48, 97), max_denominator=99)
positive = st.fractions(Fraction(1, 99), 99, max_denominator=99)


def test_the_package_is_light_until_it_is_used() -> None:
    program = (
        "import sys, force_diffusion as fd; dir(fd); import force_diffusion.numeric; "
        "heavy = {'sympy', 'numpy', 'flint'}; assert not heavy & set(sys.modules); "
        "fd.equation; assert 'sympy' in sys.modules"
    )
    subprocess.run([sys.executable, "-c", program], check=True, timeout=600)


@every_equation
def test_expr_and_rhs(eq: fd.Equation) -> None:
    lines = [eq.expr] if isinstance(eq.expr, sympy.Eq) else list(eq.expr)
    sides = list(eq.rhs) if isinstance(eq.rhs, sympy.Tuple) else [eq.rhs]
    assert [line.rhs for line in lines] == sides
    printed = {7: 2, 8: 2, 15: 2, "B1": 2}.get(eq.number, 1)
    assert len(lines) == (len(eq.forms) if eq not in PAPER and eq.forms else printed)


@every_equation
def test_source_reads_back_with_its_own_symbols(eq: fd.Equation) -> None:
    lines = [eq.expr] if isinstance(eq.expr, sympy.Eq) else list(eq.expr)
    names = {**vars(sympy), **eq.symbols}
    for source, line in zip(eq.sympy_code().splitlines(), lines, strict=True):
        side = line.lhs if line.rhs == 0 and isinstance(eq.number, int) else line.rhs
        assert rebuilt(sympy.sympify(eval(source, names))) == rebuilt(side)


def test_a_symbol_by_its_name_is_the_one_in_the_formula() -> None:
    eq = fd.equation(13)
    assert eq.rhs.subs({eq.symbols["M"]: 10, eq.symbols["z"]: 1}) == 0
    assert {"M", "j", "z", "phi", "sigma", "r"} <= set(eq.symbols)
    assert {"i", "j", "k", "l"} <= set(fd.equation(16).symbols)
    for name, symbol in eq.symbols.items():
        assert symbol.in_code == name


# What amsmath, MathJax and KaTeX all know.
STANDARD = {
    "displaystyle",
    "frac", "left", "right", "sum", "delta", "sigma", "phi", "langle", "rangle", "hat", "bf", "rm",
    "cdot", "begin", "end", "approx", "sim", "propto", "Delta", "biggl", "biggr", "quad", "qquad",
    "leq", "overline", "int", "sqrt", "operatorname", "limits", "infty", "nu", "rho", "varepsilon",
    "pm", "kappa", "mathrm", "mathbf", "times", "psi", "tau", "geq", "text",
}  # fmt: skip


@pytest.mark.long(sample=8)
@every_equation
def test_notebooks_can_set_it(eq: fd.Equation) -> None:
    for formula in (eq, *map(eq.exact, eq.forms)):
        shown = formula._repr_latex_()
        assert shown == rf"$\displaystyle {formula.latex()}$"
        assert set(re.findall(r"\\([A-Za-z]+)", shown)) <= STANDARD
        assert shown.count("{") == shown.count("}")
        assert shown.count("$") == 2
        assert shown.isascii()


@pytest.mark.long(sample=8, share=2)
@pytest.mark.parametrize("columns", [1, 2])
@every_equation
def test_the_lines_of_exact_forms_fit(eq: fd.Equation, columns: int) -> None:
    for form in map(eq.exact, eq.forms):
        for line in form.latex(columns).splitlines():
            assert width(line) <= column_width(columns) + 12, line  # 12: of &


def test_where_formulas_hold_stands_beside_them() -> None:
    lines = fd.equation(13).exact().latex().splitlines()
    assert lines[-2] == r"&\quad \text{for } 0 \leq j \leq M - 1"
    assert lines[3].endswith(r"& 2 \leq j \leq M - 2 \\")
    assert lines[-4].endswith("& M = 1")


def test_what_formulas_have_in_common_stands_before_them() -> None:
    for number, common in ((13, "2"), (14, "120")):
        lines = fd.equation(number).exact().latex().splitlines()
        assert lines[1].endswith(
            rf"\frac{{1}}{{{common} (1 - \phi^{{2}})^{{2}}}} "
            r"\left( \frac{\sigma_{\delta r}}{r} \right)^{2} \times \\"
        )
        assert not any(r"\sigma" in line for line in lines[2:])


@pytest.mark.parametrize("number", [13, 14])
def test_every_layer_has_its_exact_value(number: int) -> None:
    form = {13: closed_forms.surface_variance, 14: closed_forms.bulk_variance}[number]
    exact, phi = fd.equation(number).exact(), Fraction(2, 7)
    for height in range(1, 8):
        for layer in range(height):
            found = exact.at(M=height, j=layer, phi=phi, sigma=Fraction(1, 3), r=2)
            assert found == form(height, layer, phi, Fraction(1, 3), Fraction(2))


@given(st.integers(1, 9), st.data())
def test_responses_are_those_of_the_closed_forms(level: int, data: st.DataObject) -> None:
    """The generated Python has branches of its own."""
    layer = data.draw(st.integers(0, level - 1))
    across = data.draw(st.sampled_from(range(layer - level, level - layer + 1, 2)))
    k = level % 2
    site = {"i": k + across, "j": layer, "k": k, "l": level}
    values = {"phi": Fraction(1, 5), "sigma": Fraction(1), "r": Fraction(3)}
    exact = fd.equation(16).exact
    assert exact("bead").at(**site, **values) == closed_forms.bead_response(**site, **values)
    stated = exact("contact").at(**site, **values)
    assert stated == closed_forms.contact_response(**site, branch="+", **values)
    if across == layer - level:
        stated = exact("force").at(**site, **values)
        assert stated == closed_forms.leg_variance(layer, level, **values)


@pytest.mark.parametrize(
    ("load", "form"),
    [("surface", closed_forms.surface_variance), ("bulk", closed_forms.bulk_variance)],
)
def test_averages_are_means_over_the_layers(load: str, form: Callable[..., Fraction]) -> None:
    average = fd.equation(15).exact(load)
    values = {"phi": Fraction(-2, 7), "sigma": Fraction(1, 9), "r": Fraction(1)}
    for height in (1, 2, 3, 4, 7, 40):
        total = sum(form(height, layer, **values) for layer in range(height))
        assert average.at(M=height, **values) == total / height
        floats = {name: float(value) for name, value in values.items()}
        assert average.at(M=height, **floats) == pytest.approx(float(total / height), rel=1e-14)


def test_no_packing_is_too_high_for_floats() -> None:
    """To leading order the mean is M³/5 (σ/r)²/(1−φ²)², with a next order of relative 1/M."""
    found = fd.equation(15).exact("bulk").at(M=10**12, phi=0.0, sigma=1, r=1)
    assert found == pytest.approx(1e36 / 5, rel=3e-12)


@given(st.integers(1, 10**6), st.data(), cosines, positive, positive)
@pytest.mark.parametrize("number", [13, 14])
def test_printed_forms_at_a_layer(
    number: int, height: int, data: st.DataObject, phi: Fraction, sigma: Fraction, r: Fraction
) -> None:
    form = {13: closed_forms.surface_diffusion, 14: closed_forms.bulk_diffusion}[number]
    layer, eq = data.draw(st.integers(0, height - 1)), fd.equation(number)
    found = eq.at(M=height, j=layer, phi=phi, sigma=sigma, r=r)
    assert isinstance(found, sympy.Rational)
    assert found == form(height, Fraction(layer, height), phi, sigma, r)
    assert found == eq.at(M=height, z=Fraction(layer, height), phi=phi, sigma=sigma, r=r)


@given(st.integers(1, 10**6), st.floats(0, 1), st.floats(-0.49, 0.49), st.floats(1e-9, 1e-3))
def test_a_float_is_rounded_once(height: int, z: float, phi: float, sigma: float) -> None:
    eq = fd.equation(13)
    exact = eq.at(M=height, z=Fraction(z), phi=Fraction(phi), sigma=Fraction(sigma), r=1)
    found = eq.at(M=height, z=z, phi=phi, sigma=sigma, r=1)
    assert type(found) is float
    assert found == float(Fraction(int(exact.p), int(exact.q)))


@pytest.mark.parametrize("kind", [int, np.int64, np.int32, Fraction, sympy.Integer])
def test_exact_types(kind: Callable[[int], Any]) -> None:
    found = fd.equation(13).at(M=kind(4), j=kind(1), phi=kind(0), sigma=kind(1), r=kind(2))
    assert found == sympy.Rational(27, 1)
    assert isinstance(found, sympy.Rational)


@pytest.mark.parametrize("kind", [float, np.float64, np.float32, np.float16])
def test_inexact_types(kind: Callable[[float], Any]) -> None:
    found = fd.equation(13).at(M=kind(4), j=1, phi=kind(0), sigma=1, r=2)
    assert type(found) is float
    assert found == 27


def test_powers_that_are_no_fractions() -> None:
    deviation, height = fd.equation(15).at(M=2, sigma=Fraction(1, 10), r=1)
    assert deviation == sympy.sqrt(2) / 5
    assert height == 10 ** sympy.Rational(2, 3)
    deviation, height = fd.equation(15).at(M=2, sigma=0.1, r=1)
    assert deviation == pytest.approx(math.sqrt(2) / 5, rel=4e-16)
    assert height == pytest.approx(10 ** (2 / 3), rel=4e-16)


GOOD = {"M": 10, "j": 3, "phi": 0, "sigma": 1, "r": 1}


@pytest.mark.parametrize(
    ("change", "says"),
    [
        ({"M": 0}, "M = 0: a whole number from 1 on is allowed"),
        ({"M": 2.5}, "M = 2.5: a whole number from 1 on is allowed"),
        (
            {"M": "10"},
            "M = '10': one int, Fraction, SymPy Rational, Decimal or finite float is allowed",
        ),
        ({"M": None}, "M = None"),
        ({"M": np.array(["1", "2"])}, "element [0]: M = '1'"),
        ({"j": -1}, "j = -1: a whole number from 0 on is allowed"),
        ({"j": 10}, "j = 10, M = 10: 0 ≤ j < M is allowed"),
        ({"phi": 0.5}, "phi = 0.5: −1/2 < φ < 1/2 is allowed"),
        ({"phi": Fraction(-1, 2)}, "phi = -1/2: −1/2 < φ < 1/2 is allowed"),
        ({"phi": math.nan}, "phi = nan"),
        ({"phi": sympy.oo}, "phi = oo"),
        ({"sigma": -1}, "sigma = -1: a number from 0 on is allowed"),
        ({"r": 0}, "r = 0: a number above 0 is allowed"),
        ({"z": 0}, "z and j are given, and z is j/M: leave one of them out"),
        ({"x": 1, "width": 2}, "Eq. 13 holds no x or width: Eq. 13 takes M, j, phi, sigma, r"),
        ({"sigma": 1e300, "r": 1e-300}, "beyond the range of floats"),
    ],
)
def test_what_is_not_allowed_is_named(change: dict[str, Any], says: str) -> None:
    with pytest.raises(ArgumentError) as refused:
        fd.equation(13).at(**GOOD | change)
    assert says in str(refused.value)
    assert isinstance(refused.value, ForceDiffusionError)


def test_no_disorder_is_allowed() -> None:
    assert fd.equation(13).at(**GOOD | {"sigma": 0}) == 0


def test_a_missing_name_is_named() -> None:
    with pytest.raises(ArgumentError, match=r"z \(or j\)|r missing") as refused:
        fd.equation(13).at(M=3, j=1, phi=0, sigma=1)
    assert str(refused.value).startswith("r missing: Eq. 13 takes M, ")


@pytest.mark.parametrize("number", ["B13", "B14"])
def test_exact_forms_of_spheres_know_their_range_of_phi(number) -> None:
    for phi in (-0.4, Fraction(-1, 3)):
        with pytest.raises(fd.ForceDiffusionError, match="−1/3 < φ < 1/2 is allowed"):
            fd.equation(number).exact().at(M=9, j=4, phi=phi, sigma=1, r=1)


@pytest.mark.parametrize("eq", ALL[:12], ids=lambda eq: f"eq{eq.number:02}")
def test_formulas_of_single_beads_are_no_numbers(eq: fd.Equation) -> None:
    with pytest.raises(ArgumentError, match="single beads"):
        eq.at(i=0, j=1)


@pytest.mark.parametrize("j", [-1, 10, 11])
def test_an_exact_form_keeps_to_its_layers(j: int) -> None:
    with pytest.raises(ArgumentError, match=r"is for 0 ≤ j ≤ M − 1, not for j = .*, M = 10"):
        fd.equation(13).exact().at(M=10, j=j, phi=0, sigma=1, r=1)


@pytest.mark.parametrize("number", [0, 17, -1, "thirteen", 13.5, None, [13], True])
def test_no_such_equation(number: Any) -> None:
    with pytest.raises(ForceDiffusionError, match="from 1 to 16, or B1 to B"):
        fd.equation(number)


def test_no_such_exact_form() -> None:
    with pytest.raises(ForceDiffusionError, match="13, 14, 15, 16, B2"):
        fd.equation(3).exact()
    with pytest.raises(ForceDiffusionError, match=r"'Layer'. It has layer"):
        fd.equation(13).exact("Layer")
    with pytest.raises(ForceDiffusionError, match=r"'leg'. It has bead, contact and force"):
        fd.equation(16).exact("leg")
    assert fd.equation(3).forms == ()


@every_printed
def test_the_printed_equation_is_proved_and_a_mutant_refuted(eq: fd.Equation) -> None:
    lines = [eq.expr] if isinstance(eq.expr, sympy.Eq) else list(eq.expr)
    for line in lines:
        assert eq.decide(line).verdict is Verdict.PROVED
        mutant = next(mutants(sympy.Eq(sy.z, line.rhs or line.lhs, evaluate=False)))
        wrong = (
            (line.lhs, mutant.equation.rhs) if line.rhs != 0 else (mutant.equation.rhs, line.rhs)
        )
        assert eq.decide(sympy.Eq(*wrong, evaluate=False)).verdict is Verdict.REFUTED
    if len(lines) == 1:
        assert eq.decide(eq.rhs).verdict is Verdict.PROVED


def test_one_of_two_lines_is_found_by_its_left_hand_side() -> None:
    first, second = fd.equation(7).expr
    crossed = sympy.Eq(first.lhs, second.rhs, evaluate=False)
    assert fd.equation(7).decide(crossed).verdict is Verdict.REFUTED
    ruling = fd.equation(7).decide(sympy.sin(sy.phi))
    assert ruling.verdict is Verdict.UNDECIDED
    assert "f⁺_(k−1,l−1) or f⁻_(k+1,l−1)" in ruling.note


z, M = sy.z, sy.M
NO_EQUATION = [
    "M**3", None, 2.5, sympy.true, sympy.Matrix([[M]]), M < 3, sympy.S.EmptySet, (), [[M]],
]  # fmt: skip
NOTHING = sympy.Pow(0, -1, evaluate=False)
NO_VALUE = [
    sympy.oo, sympy.nan, sympy.zoo, sympy.Dummy("M"), NOTHING,
    sympy.Sum(M, (sy.m, 5, 1)),
]  # fmt: skip
NOT_READ = [
    sympy.Float(2.5), sympy.I, sympy.sin(sy.phi), sympy.Derivative(sy.phi**2, sy.phi),
    sympy.Integral(sy.phi, sy.phi), sympy.Piecewise((sy.phi, sy.phi > 0), (1, True)),
    sympy.Order(sy.phi), sympy.UnevaluatedExpr(sy.phi),
]  # fmt: skip
WRONG = [
    sy.MatrixTimes(1, 2, 3, 4, 5),
    M**M, sympy.sqrt(M), sympy.Wild("a"), sy.Braces(M, 1, sy.m, sy.j), M**1000, sympy.Symbol("y"),
    sympy.Sum(sy.Braces(M, 1, sy.m, sy.j), (sy.m, 1, M)), sy.n_plus, sy.DeltaR(1, 2), 1 / (1 - z),
]  # fmt: skip


@every_printed
def test_what_can_not_be_decided_is_told_with_the_reason(eq: fd.Equation) -> None:
    for candidates, verdict in (
        (NO_EQUATION, Verdict.NOT_A_STATEMENT),
        (NO_VALUE, Verdict.NOT_A_STATEMENT),
        (NOT_READ, Verdict.UNDECIDED),
    ):
        for candidate in candidates:
            ruling = eq.decide(candidate)
            if (eq.number, candidate) != (15, NOTHING):  # of which of its lines is asked there
                assert ruling.verdict is verdict, (candidate, str(ruling))
            assert ruling.note
    for candidate in WRONG:
        assert not eq.decide(candidate).verdict.is_proved, candidate


def test_a_symbol_of_the_same_name_is_no_symbol_of_the_equation() -> None:
    ruling = fd.equation(13).decide(fd.equation(13).rhs * sympy.Symbol("M") / M)
    assert ruling.verdict is Verdict.NOT_A_STATEMENT
    assert ruling.note == "M is not the M of the equation"


@pytest.mark.long
def test_a_proof_runs_its_premises() -> None:
    proof = fd.equation(4).prove()
    assert [one.derivation.number for one in proof.outcomes] == [2, 3, 4]
    assert proof.verdict is Verdict.PROVED
    assert str(proof).splitlines()[0] == "Eq. 4 is proved. It rests on Eq. 3."
    assert "It rests on no other equation." in repr(fd.equation(1).prove())


@pytest.mark.long
def test_a_table_of_checks_for_notebooks() -> None:
    proof = fd.equation(1).prove()
    lines = proof._repr_markdown_().splitlines()
    table = [line for line in lines if line.startswith("|")]
    assert len(table) == len(proof.checks) + 2
    assert {len(re.findall(r"(?<!\\)\|", line)) for line in table} == {5}
    steps = fd.equation(13).steps()
    assert steps._repr_markdown_().count("$$") == 2 * len(steps)
