"""The LaTeX that ``derive --out`` writes: a fragment per equation, and one document."""

from collections.abc import Iterable, Sequence

from force_diffusion.symbolic.kernel.decisions import in_words
from force_diffusion.symbolic.printing.latex import RELATIONS, latex
from force_diffusion.symbolic.printing.lines import latex_body
from sympy import Basic

from ..coq.record import recorded
from ..framework.catalogue import Number
from ..framework.record import Outcome, Statement
from ..framework.rows import Row
from .prose import prose_latex
from .terminal import follows_text

DOCUMENT, MANIFEST = "equations.tex", "manifest.json"

_HEAD = r"""\documentclass[10pt]{article}
\usepackage[a4paper,margin=27mm]{geometry}
\usepackage{amsmath,array}
\setlength{\parindent}{0pt}
\setlength{\parskip}{4pt plus 1pt}
\setlength{\emergencystretch}{4em}
\widowpenalty=10000
\clubpenalty=10000
\displaywidowpenalty=10000
\setcounter{secnumdepth}{0} % equations have numbers, their sections have none
\renewcommand{\labelitemi}{$\bullet$}
\allowdisplaybreaks
\makeatletter\@beginparpenalty=10000\makeatother % no page ends between a heading and its list
\newcommand{\heading}[1]{\par\vskip 0pt plus 4\baselineskip\penalty-200
  \vskip 0pt plus -4\baselineskip\smallskip\noindent\textbf{#1}\par\nobreak}
\title{Forces in nearly-ordered packings of frictionless discs:\\
  the equations, derived and checked}
\author{}
\date{}
\begin{document}
\maketitle
\pagenumbering{roman} % pages are counted after the contents, however long these are
\tableofcontents
\clearpage
\pagenumbering{arabic}
"""

READING = (
    "The equations keep the numbers that they have in the paper; B1 and so on go beyond it. "
    "Proved means that the rules of the kernel, which decide exactly, give the printed equation "
    "from its assumptions; proved, assuming, that it rests on a further one, which is named and "
    "which no rule discharges; refuted, that a counterexample was found; undecided, that neither "
    "was done; not a statement, that what is written has no value, or no single meaning, "
    "somewhere on its domain. Accepted is a word of "
    "Coq, an unrelated proof assistant, about the printed equation on exact packings; it is on "
    "record with the hash of what was asked."
)
"""What the words of the document mean."""


def statement_latex(derivation: Statement, columns: int = 1) -> str:
    """The printed equation as a numbered display, ready to paste into text of 1 or 2 columns.

    Its label is ``eq:fd13`` of Eq. 13, and so on; several displays are (B7a), (B7b) and so on.
    """
    label = f"\\label{{eq:fd{derivation.number}}}"
    first, *others = derivation.displays(columns)
    if not others:
        return f"\\begin{{equation}}{label}\n{first}\n\\end{{equation}}\n"
    displays = (f"\\begin{{equation}}\n{one}\n\\end{{equation}}\n" for one in (first, *others))
    return f"\\begin{{subequations}}{label}\n{''.join(displays)}\\end{{subequations}}\n"


def fragment_name(number: Number) -> str:
    """File name of an equation's fragment."""
    return f"eq{number:02}.tex" if isinstance(number, int) else f"eq{number}.tex"


def _list(kind: str, items: Iterable[str]) -> str:
    lines = [f"\\item {item}" for item in items]
    if not lines:
        return ""
    spacing = r"\setlength{\itemsep}{1pt}\setlength{\parskip}{0pt}\setlength{\topsep}{0pt}"
    return f"\\begin{{{kind}}}{spacing}\n" + "\n".join(lines) + f"\n\\end{{{kind}}}\n"


def _part(title: str, body: str) -> str:
    return f"\\heading{{{title}}}\n{body}" if body else ""


def sentence(words: str) -> str:
    """Words with a capital letter, where they start with a word, and a full stop."""
    first = words.split(" ", 1)[0]
    capital = first[:1].upper() + words[1:] if first.isalpha() and len(first) > 1 else words
    return capital + ("" if words.endswith((".", "!", "?", ":")) else ".")


def _noted(verdict: str, name: str, note: str) -> str:
    said = f"\\emph{{{verdict}}}: {prose_latex(sentence(name))}"
    return f"{said} {prose_latex(sentence(note))}" if note else said


def _steps(outcome: Outcome) -> str:
    derivation, items = outcome.derivation, []
    for step in derivation.proof if outcome.verdict.is_proved else ():
        follows = f"\\emph{{{prose_latex(sentence(follows_text(step)))}}}"
        if derivation.printed == (step.formula,):  # not the same display twice
            reason = prose_latex(step.reason.rstrip(".:"))
            items.append(f"{reason}: Eq.~({derivation.number}). {follows}")
            continue
        relation = RELATIONS[step.relation]
        items.append(f"{prose_latex(step.reason)}\n{_shown(step.formula, relation)}{follows}")
    return _list("enumerate", items)


def _shown(formula: Basic, relation: str) -> str:
    """A display without a number; a page may end between its lines."""
    body = latex_body([formula], relation, room=380.0)
    lines = body.removeprefix("\\begin{aligned}\n").removesuffix("\n\\end{aligned}")
    return f"\\begin{{align*}}\n{lines}\n\\end{{align*}}\n"


def _refuted(outcome: Outcome) -> str:
    """Printed statements that do not hold; they are in no fragment."""
    return "".join(
        f"\\par {prose_latex(sentence(one.reading))}\n"
        f"{_shown(one.formula, RELATIONS[one.relation])}"
        for one in (outcome.derivation.proof.refuted if outcome.refuted else ())
    )


def _numbered(derivation: Statement) -> str:
    """What lets the next display have its number."""
    number = derivation.number
    if isinstance(number, int):
        return f"\\setcounter{{equation}}{{{number - 1}}}\n"
    return f"\\renewcommand{{\\theequation}}{{{number}}}\n"


def section_latex(outcome: Outcome) -> str:
    """All about one equation; the statement itself is read from its fragment."""
    derivation = outcome.derivation
    symbols = [
        f"$\\displaystyle {latex(symbol)}$: {prose_latex(words)}"
        for symbol, words in derivation.symbols
    ]
    rests = ", ".join(f"({number})" for number in derivation.premises)
    plural = "s" if len(derivation.premises) > 1 else ""
    claims = [
        _noted(in_words(check.verdict, check.assuming), check.name, check.note)
        for check in outcome.checks
        if check.kind != "step"
    ]
    return "".join(
        [
            f"\\section{{Eq.\\ ({derivation.number}): {prose_latex(derivation.title)}}}\n",
            _numbered(derivation),
            f"\\input{{{fragment_name(derivation.number).removesuffix('.tex')}}}%\n",
            f"Verdict: \\textbf{{{prose_latex(outcome.words)}}}. "
            f"Coq: {recorded(derivation.number)}."
            + (f" Rests on Eq{plural}.\\ {rests}.\n" if rests else "\n"),
            _part("Printed as well, and refuted", _refuted(outcome)),
            _part("Symbols", _list("itemize", symbols)),
            _part("Assumptions", _list("itemize", map(prose_latex, derivation.assumptions))),
            _part("Steps", "" if isinstance(derivation, Row) else _steps(outcome)),
            _part("Claims", _list("itemize", claims)),
            _part("Remarks", _list("itemize", map(prose_latex, derivation.remarks))),
        ]
    )


def _overview(outcomes: Sequence[Outcome]) -> str:
    """The paper's equations in one table, those beyond it in another: a page ends in between."""
    of_paper = [one for one in outcomes if isinstance(one.derivation.number, int)]
    beyond = [one for one in outcomes if not isinstance(one.derivation.number, int)]
    return "\n".join(_table(some) for some in (of_paper, beyond) if some)


def _table(outcomes: Iterable[Outcome]) -> str:
    rows = [
        f"({one.derivation.number}) & {prose_latex(one.derivation.title)} & "
        f"{prose_latex(one.words)} & {recorded(one.derivation.number).partition(' by ')[0]} \\\\\n"
        for one in outcomes
    ]
    return (
        "\\begin{center}\\footnotesize\\setlength{\\tabcolsep}{3pt}\n"
        "\\begin{tabular}{r>{\\raggedright}p{85mm}>{\\raggedright}p{30mm}l}\n\\hline\n"
        "Eq. & title & verdict & Coq \\\\\n\\hline\n"
        + "".join(rows)
        + "\\hline\n\\end{tabular}\n\\end{center}\n"
    )


def document(outcomes: Sequence[Outcome]) -> str:
    """The document about these equations; it reads the fragments beside it."""
    body = "\n".join(map(section_latex, outcomes))
    reading = f"{prose_latex(READING)}\n"
    return f"{_HEAD}{reading}{_overview(outcomes)}\n{body}\n\\end{{document}}\n"
