"""``equation``: SymPy objects with the right symbols, numbers, proofs and verdicts."""

import re

import pytest
import sympy
from force_diffusion.derivations.framework.catalogue import modules, paper
from force_diffusion.symbolic.kernel.decisions import Verdict
from force_diffusion.symbolic.printing.lines import COLUMNS, width
from force_diffusion.symbolic.printing.structure import rebuilt

import force_diffusion as fd
from tests.derivations.rows import each

every_equation = pytest.mark.parametrize("number", each(modules()))


@every_equation
def test_expr_rhs_and_source_which_reads_back_with_its_own_symbols(number):
    eq = fd.equation(number)
    lines = [eq.expr] if isinstance(eq.expr, sympy.Eq) else list(eq.expr)
    sides = list(eq.rhs) if isinstance(eq.rhs, sympy.Tuple) else [eq.rhs]
    assert [line.rhs for line in lines] == sides
    printed = {7: 2, 8: 2, 15: 2, "B1": 2}.get(eq.number, 1)
    assert len(lines) == (len(eq.forms) if number not in paper() and eq.forms else printed)
    names = {**vars(sympy), **eq.symbols}
    for source, line in zip(eq.sympy_code().splitlines(), lines, strict=True):
        side = line.lhs if line.rhs == 0 and isinstance(eq.number, int) else line.rhs
        assert rebuilt(sympy.sympify(eval(source, names))) == rebuilt(side)


def test_a_symbol_by_its_name_is_the_one_in_the_formula():
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


@every_equation
def test_notebooks_can_set_it(number):
    eq = fd.equation(number)
    for formula in (eq, *map(eq.exact, eq.forms)):
        shown = formula._repr_latex_()
        assert shown == rf"$\displaystyle {formula.latex()}$"
        assert set(re.findall(r"\\([A-Za-z]+)", shown)) <= STANDARD
        assert shown.count("{") == shown.count("}")
        assert shown.count("$") == 2
        assert shown.isascii()


@pytest.mark.parametrize("columns", [1, 2])
@every_equation
def test_the_lines_of_exact_forms_fit(number, columns):
    eq = fd.equation(number)
    for form in map(eq.exact, eq.forms):
        for line in form.latex(columns).splitlines():
            assert width(line) <= COLUMNS[columns] + 12, line  # 12: of &


@pytest.mark.long
def test_a_proof_runs_its_premises():
    proof = fd.equation(4).prove()
    assert [outcome.derivation.number for outcome in proof.outcomes] == [2, 3, 4]
    assert proof.verdict is Verdict.PROVED
    assert str(proof).splitlines()[0] == "Eq. 4 is proved. It rests on Eq. 3."
    assert "It rests on no other equation." in repr(fd.equation(1).prove())
