"""The LaTeX that ``derive --out`` writes: a fragment per equation, one document, a manifest."""

import json
import re
from collections import Counter
from collections.abc import Iterable, Sequence

from force_diffusion.derivations.commands.folder import DOCUMENT, MANIFEST, PROGRAM
from force_diffusion.derivations.export.plain import mutant_counts, relation_of
from force_diffusion.derivations.export.prose import prose_latex
from force_diffusion.derivations.framework.record import Derivation, Outcome
from force_diffusion.symbolic.kernel.decisions import Verdict
from force_diffusion.symbolic.printing.latex import latex
from force_diffusion.symbolic.printing.lines import latex_body

RELATIONS = {"=": "=", "≈": r"\approx", "∼": r"\sim", "∝": r"\propto"}
"""Signs of ``Derivation.relation`` in LaTeX."""

_HEAD = r"""\documentclass[10pt]{article}
\usepackage[a4paper,margin=27mm]{geometry}
\usepackage{amsmath,array}
\setlength{\parindent}{0pt}
\setlength{\parskip}{4pt plus 1pt}
\setlength{\emergencystretch}{4em}
\renewcommand{\labelitemi}{$\bullet$}
\makeatletter\@beginparpenalty=10000\makeatother % no page ends between a heading and its list
\newcommand{\heading}[1]{\par\vskip 0pt plus 4\baselineskip\penalty-200
  \vskip 0pt plus -4\baselineskip\smallskip\noindent\textbf{#1}\par\nobreak}
\title{Forces in nearly-ordered packings of frictionless discs:\\
  the equations, derived and checked}
\author{}
\date{}
\begin{document}
\maketitle
"""

READING = (
    "The equations keep the numbers that they have in the paper. Proved means that an exact "
    "decision procedure found the printed equation to follow from its assumptions; refuted, that "
    "it found a counterexample; undecided, that it could do neither. A witness is a comparison of "
    "another kind, with exact or high-precision numbers for packings drawn at random: it agrees "
    "or disagrees, and proves nothing. A mutant is the printed equation with one mechanical "
    "change, which the same procedure has to refute; one that is an equivalent rewriting is "
    "listed with the proof that it is."
)
"""What the words of a report mean."""


def statement_latex(derivation: Derivation) -> str:
    """The printed equation as one numbered display, ready to paste."""
    body = latex_body(derivation.printed, RELATIONS[derivation.relation])
    return f"\\begin{{equation}}\n{body}\n\\end{{equation}}\n"


def fragment_name(derivation: Derivation) -> str:
    """File name of an equation's fragment."""
    return f"eq{derivation.number:02}.tex"


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


def _steps(derivation: Derivation) -> str:
    items = []
    for step in derivation.steps():
        if derivation.printed == (step.formula,):  # not the same display twice
            reason = prose_latex(step.reason.rstrip(".:"))
            items.append(f"{reason}: Eq.~({derivation.number}).")
            continue
        item = prose_latex(step.reason)
        if step.formula is not None:
            relation = RELATIONS[relation_of(derivation, step)]
            item += f"\n\\[\n{latex_body([step.formula], relation, room=380.0)}\n\\]"
        items.append(item)
    return _list("enumerate", items)


_KINDS = {
    "sign flipped": r"sign of .* flipped",
    "term dropped": r".* dropped",
    "number changed": r".* changed to .*",
    "bound or case shifted": r"(lower bound|upper bound|case) .* shifted to .*",
    "index shifted": r".* shifted to .*",
    "symbol swapped": r".* replaced by .*",
}
"""Kinds of mechanical change, and how ``symbolic.kernel.mutants`` describes one of each."""


def change_kind(change: str) -> str:
    """Kind of a change, from its description; on which side it is does not matter."""
    words = change.removeprefix("left: ")
    kinds = (kind for kind, form in _KINDS.items() if re.fullmatch(form, words, re.DOTALL))
    return next(kinds, "other change")


def _mutants(outcome: Outcome) -> str:
    if not outcome.mutants:
        return ""
    counts = mutant_counts(outcome)
    kinds = Counter(change_kind(mutant.change) for mutant in outcome.mutants)
    told = (
        f"\\par {counts['made']} made, {counts['refuted']} refuted, "
        f"{counts['equivalent']} equivalent rewritings. By kind: "
        + "; ".join(f"{kind}: {count}" for kind, count in kinds.most_common())
        + f". \\texttt{{{MANIFEST}}} lists each of them.\n"
    )
    survivors = [m for m in outcome.mutants if m.ruling.verdict is not Verdict.REFUTED]
    return told + _list(
        "itemize",
        (
            _noted(
                "equivalent" if mutant.equivalent else mutant.ruling.verdict,
                mutant.change,
                mutant.ruling.note,
            )
            for mutant in survivors
        ),
    )


def section_latex(outcome: Outcome) -> str:
    """All about one equation; the statement itself is read from its fragment."""
    derivation = outcome.derivation
    symbols = [f"${latex(symbol)}$: {prose_latex(words)}" for symbol, words in derivation.symbols]
    rests = ", ".join(f"({premise.number})" for premise in derivation.premises)
    plural = "s" if len(derivation.premises) > 1 else ""
    checks = [_noted(check.verdict, check.name, check.note) for check in outcome.checks]
    return "".join(
        [
            f"\\section*{{Eq.\\ ({derivation.number}): {prose_latex(derivation.title)}}}\n",
            f"\\setcounter{{equation}}{{{derivation.number - 1}}}\n",
            f"\\input{{{fragment_name(derivation).removesuffix('.tex')}}}%\n",
            f"Verdict: \\textbf{{{outcome.verdict}}}."
            + (f" Rests on Eq{plural}.\\ {rests}.\n" if rests else "\n"),
            _part("Symbols", _list("itemize", symbols)),
            _part("Assumptions", _list("itemize", map(prose_latex, derivation.assumptions))),
            _part("Steps", _steps(derivation)),
            _part("Checks", _list("itemize", checks)),
            _part("Mutants", _mutants(outcome)),
            _part("Remarks", _list("itemize", map(prose_latex, derivation.remarks))),
        ]
    )


def _overview(outcomes: Sequence[Outcome]) -> str:
    rows = []
    for outcome in outcomes:
        kinds = [check.kind for check in outcome.checks]
        counts = mutant_counts(outcome)
        rows.append(
            f"({outcome.derivation.number}) & {prose_latex(outcome.derivation.title)} & "
            f"{outcome.verdict} & {kinds.count('proof')} & {kinds.count('witness')} & "
            f"{counts['made']} & {counts['refuted']} & {counts['equivalent']} \\\\\n"
        )
    return (
        "\\begin{center}\\small\n\\begin{tabular}{r>{\\raggedright}p{46mm}lrrrrr}\n\\hline\n"
        " & & & & & \\multicolumn{3}{c}{mutants} \\\\\n"
        "Eq. & title & verdict & proofs & witnesses & made & refuted & equivalent \\\\\n\\hline\n"
        + "".join(rows)
        + "\\hline\n\\end{tabular}\n\\end{center}\n"
    )


def manifest(outcomes: Sequence[Outcome]) -> str:
    """What was written and what was found, for machines; the same on every run."""
    files = [*(fragment_name(outcome.derivation) for outcome in outcomes), DOCUMENT, MANIFEST]
    equations = [
        {
            "number": outcome.derivation.number,
            "name": outcome.derivation.name,
            "title": outcome.derivation.title,
            "fragment": fragment_name(outcome.derivation),
            "premises": [premise.number for premise in outcome.derivation.premises],
            "verdict": str(outcome.verdict),
            "checks": [
                {
                    "kind": check.kind,
                    "name": check.name,
                    "verdict": str(check.verdict),
                    "note": check.note,
                }
                for check in outcome.checks
            ],
            "mutants": {
                **mutant_counts(outcome),
                "changes": [
                    {
                        "change": mutant.change,
                        "kind": change_kind(mutant.change),
                        "verdict": "equivalent" if mutant.equivalent else mutant.ruling.verdict,
                        "note": mutant.ruling.note,
                    }
                    for mutant in outcome.mutants
                ],
            },
        }
        for outcome in outcomes
    ]
    content = {"program": PROGRAM, "document": DOCUMENT, "files": files, "equations": equations}
    return json.dumps(content, indent=2, ensure_ascii=False) + "\n"


def output_files(outcomes: Sequence[Outcome]) -> dict[str, str]:
    """Every file of the output folder, by name."""
    files = {
        fragment_name(outcome.derivation): statement_latex(outcome.derivation)
        for outcome in outcomes
    }
    body = "\n".join(section_latex(outcome) for outcome in outcomes)
    reading = f"{prose_latex(READING)}\n"
    files[DOCUMENT] = f"{_HEAD}{reading}{_overview(outcomes)}\n{body}\n\\end{{document}}\n"
    files[MANIFEST] = manifest(outcomes)
    return files
