"""Symbols carry the forms in which they are printed, for SymPy's own printers too."""

import pickle

import pytest
import sympy
from force_diffusion.symbolic import symbols as sy
from force_diffusion.symbolic.notation import Symbol

ALL = (*sy.INDICES, *sy.PARAMETERS, *sy.VECTORS)


def test_symbols_are_told_apart_by_assumptions_and_by_forms():
    assert Symbol("x") == Symbol("x")
    assert len({Symbol("x"), Symbol("x", real=True), Symbol("x", r"\xi"), Symbol("x")}) == 3
    assert sy.site_r != sy.r
    assert len({symbol.in_code for symbol in ALL}) == len(ALL)


@pytest.mark.parametrize("symbol", ALL, ids=lambda symbol: symbol.in_code)
def test_a_copy_is_the_same_symbol(symbol):
    copy = pickle.loads(pickle.dumps(symbol))
    assert copy == symbol
    assert hash(copy) == hash(symbol)
    assert (copy.in_latex, copy.in_text) == (symbol.in_latex, symbol.in_text)
    assert copy - symbol == 0


@pytest.mark.parametrize(
    ("expression", "source"),
    [
        (sy.sigma**2, r"\sigma_{\delta r}^{2}"),
        (sy.DeltaR(sy.i, sy.j), r"\delta r_{ij}"),
        (sy.DeltaR(sy.i - 1, sy.j) ** 2, r"(\delta r_{i - 1,j})^{2}"),
        (sy.Dot(sy.n_plus, sy.b_plus + sy.e_y), None),
        (sy.MatrixTimes(1, 2, 3, 4, sy.n_plus), None),
        (sy.Braces(sy.M, sy.j, sy.m, sy.j), None),
    ],
)
def test_notebooks_show_the_notation_of_the_paper(expression, source):
    shown = sympy.latex(expression)
    if source is not None:
        assert shown == source
    assert type(expression).__name__ not in shown
    assert expression._repr_latex_() == rf"$\displaystyle {shown}$"
