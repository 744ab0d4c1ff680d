"""The supplement of the article: tables of all closed forms beyond the paper."""

import re
from collections.abc import Iterable, Sequence

import sympy
from force_diffusion.symbolic import symbols as sy
from force_diffusion.symbolic import words
from force_diffusion.symbolic.piecewise import Relations
from force_diffusion.symbolic.printing.latex import latex
from force_diffusion.symbolic.printing.structure import is_negative

from ..framework.catalogue import modules
from ..framework.closed_form import ClosedForm
from ..framework.layers import UNIT
from ..framework.lists import both
from ..framework.loading import load
from ..framework.record import ProofOutcome
from ..framework.rows import Row
from .prose import prose_latex, text_latex
from .terminal import verdicts_text

SUPPLEMENT = "supplement.tex"
UNITS = {2: UNIT, 3: (sy.sigma / sy.r) ** 2 / ((1 - sy.phi) * (1 + 2 * sy.phi)) ** 2}
"""What formulas are written in, by dimension: u and v of the article."""

_HEAD = r"""\documentclass{article}
\usepackage[a4paper,margin=17mm]{geometry}
\usepackage{amsmath,array,longtable}
\setlength{\parindent}{0pt}
\setlength{\LTpre}{3pt}
\setlength{\LTpost}{3pt}
\emergencystretch=3em
\begin{document}
\small
\begin{center}\large Supplement: the closed forms of Eqs.~B2 to B25\end{center}
"""
_INTRODUCTION = (
    "Each row of a table has a formula and the indices for which it holds; above it are what it is "
    "the value of, and the indices for which the rows together hold. Formulas for discs are in "
    "units of u = (σ/r)²/(1 − φ²)², formulas for spheres in units of v = (σ/r)²/[(1 − φ)² "
    "(1 + 2φ)²], where σ is the standard deviation of the radii, written σ_δr in the quantities. "
    "For spheres p and q count steps, and the force on a bead is written out. "
    "The name at the left is the one by which the program knows a form. Eqs. B11 and B20 put "
    "Eqs. 13 and B13, and Eqs. 14 and B14, side by side."
)
_TWICE = "B11", "B20"
"""Rows whose forms are those of others."""


def supplement(outcomes: Sequence[ProofOutcome]) -> str:
    """The supplement as LaTeX; it says what the run that writes it has derived."""
    rows = (load(label) for label in modules() if label not in _TWICE)
    tables = "".join(_tables(row) for row in rows if isinstance(row, Row))
    about = prose_latex(f"{_INTRODUCTION} {verdicts(outcomes)}")
    return f"{_HEAD}{about}\n\n\\medskip\n{tables}\\end{{document}}\n"


def verdicts(outcomes: Sequence[ProofOutcome]) -> str:
    """What the run that writes the article has derived."""
    derived = {outcome.derivation.number for outcome in outcomes}
    missing = [str(label) for label in modules() if label not in derived]
    refuted = [f"Eq. {outcome.derivation.number}" for outcome in outcomes if outcome.refuted]
    return (
        f"In the run that wrote this text the program derived {len(derived)} equations: "
        f"{verdicts_text(outcomes)}."
        + (f" Not derived in it: {', '.join(missing)}." if missing else "")
        + (f" As its words read in the paper, {both(refuted)} is refuted." if refuted else "")
    )


def _tables(row: Row) -> str:
    """The closed forms of a row, each in a table; the title stands in the first."""
    shown = {symbol for form in row.exact_forms.values() for symbol in form.quantity.free_symbols}
    meanings = [
        f"${latex(symbol)}$: {prose_latex(meaning)}"
        for symbol, meaning in row.quantities
        if symbol not in shown
    ]
    title = [f"\\textbf{{Eq.~{row.number}. {prose_latex(row.title)}.}} {'; '.join(meanings)}"]
    tables = []
    for name, form in row.exact_forms.items():
        where = _listed(form.conditions(words.LATEX))
        head = f"\\texttt{{{text_latex(name)}}}: $\\displaystyle {latex(form.quantity)}$"
        tables.append(_table([*title, f"{head} for {where}" if where else head], form))
        title = []
    return "".join(tables)


def _table(heads: Iterable[str], form: ClosedForm) -> str:
    above = "".join(
        f"\\multicolumn{{2}}{{@{{}}p{{\\textwidth}}@{{}}}}{{{head}}} \\\\*[3pt]\n" for head in heads
    )
    unit = UNITS[form.kernel_domain.dimension]
    lines = (
        f"${_formula(piece.expr / unit)}$ & {_conditions(piece.where)} \\\\[5pt]\n"
        for piece in form.pieces
    )
    return (
        "\\begin{longtable}{@{}>{\\raggedright}p{0.66\\textwidth}"
        ">{\\raggedright\\arraybackslash}p{0.3\\textwidth}@{}}\n"
        f"{above}\\hline\n\\noalign{{\\smallskip}}\n{''.join(lines)}\\hline\n\\end{{longtable}}\n"
    )


def _formula(value: sympy.Expr) -> str:
    """A formula in one line that can be broken: a fraction times factors, sums in brackets."""
    above, below = map(sympy.factor_list, sympy.fraction(sympy.cancel(value)))
    number, over = _positive(above)
    divisor, under = _positive(below)
    number /= divisor
    before = latex(sympy.Integer(abs(number.p)))
    if number.q > 1 or under:
        before = rf"\frac{{{before}}}{{{' '.join([*[latex(number.q)] * (number.q > 1), *under])}}}"
    factors = [before] if before != "1" or not over else []
    return f"{'-' if number < 0 else ''}{' '.join([*factors, *over])}"


def _positive(
    factored: tuple[sympy.Rational, Sequence[tuple[sympy.Expr, int]]],
) -> tuple[sympy.Rational, list[str]]:
    """The number and the factors, each as LaTeX, none of which begins with a minus sign."""
    number, factors = factored
    written = []
    for base, power in factors:
        terms = base.as_ordered_terms()
        turned = len(terms) > 1 and (base.subs(sy.phi, 0) == -1 or is_negative(terms[0]))
        number *= (-1) ** power if turned else 1
        body = latex(-base if turned else base)
        body = re.sub(r"\\(left|right)(?![a-z])", "", body)  # lines end between these brackets, too
        body = f"({body})" if len(terms) > 1 else body
        written.append(body if power == 1 else f"{body}^{{{power}}}")
    return number, written


def _conditions(parts: Iterable[Relations]) -> str:
    return "; or ".join(_listed(words.parts(part, words.LATEX)) for part in parts) or "everywhere"


def _listed(relations: Iterable[str]) -> str:
    return ", ".join(f"${relation}$" for relation in relations)
