"""The supplement of the article: all closed forms beyond the paper."""

from collections.abc import Sequence

from force_diffusion.symbolic.printing.latex import latex

from ..framework.catalogue import modules
from ..framework.record import ProofOutcome, load
from ..framework.rows import Row
from .prose import prose_latex, text_latex
from .terminal import counts_text

SUPPLEMENT = "supplement.tex"

_HEAD = r"""\documentclass[twocolumn]{article}
\usepackage[a4paper,margin=15mm]{geometry}
\usepackage{amsmath}
\setlength{\parindent}{0pt}
\emergencystretch=3em
\interlinepenalty=10000
\raggedbottom
\begin{document}
\begin{center}\large Supplement: the closed forms of Eqs.~B2 to B25\end{center}
"""
_INTRODUCTION = (
    "Each formula is exact for the indices beside or below it. Among several formulas, “otherwise” "
    "is for all indices that the others leave; what holds for all of them stands below the last. "
    "The word in brackets is the name of a form in the program. For spheres p and q count steps, "
    "and the force on a bead is written out. B11 and B20 compare Eqs. 13, B13 and Eqs. 14, B14."
)


def supplement(outcomes: Sequence[ProofOutcome]) -> str:
    """The supplement as LaTeX; it reports what the present run has derived."""
    rows = map(load, modules())
    sections = "".join(_section(row) for row in rows if isinstance(row, Row))
    counts = f"The verdicts of the run that wrote this text: {counts_text(outcomes)}."
    about = prose_latex(f"{_INTRODUCTION} {counts}")
    return f"{_HEAD}{about}\n{sections}\\end{{document}}\n"


def _section(row: Row) -> str:
    """The closed forms of a row, and what their quantities mean."""
    meanings = (f"${latex(symbol)}$: {prose_latex(words)}" for symbol, words in row.quantities)
    title = f"\n\\medskip\\textbf{{Eq.~{row.number}. {prose_latex(row.title)}.}} "
    parts = [f"{title}{'; '.join(meanings)}.\n"]
    for name, form in row.exact_forms.items():
        parts.append(f"\n\\nobreak [\\texttt{{{text_latex(name)}}}]\n")
        parts += [f"\\[ {display} \\]\n" for display in form.displays(columns=2)]
    return "".join(parts)
