"""The LaTeX that ``derive --out`` writes: a fragment for each equation, and the paper re-derived.

The words of the document that belong to no equation are in ``equations.tex``, next to this module.
"""

from collections.abc import Iterable, Sequence
from pathlib import Path

from force_diffusion.symbolic import words
from force_diffusion.symbolic.printing.latex import RELATIONS, latex
from force_diffusion.symbolic.printing.lines import LINE_WIDTH, latex_body, latex_cases, width
from force_diffusion.symbolic.symbols import SiteFunction
from sympy import Basic

from ..coq.statements import recorded
from ..framework.catalogue import Number
from ..framework.display import over_common, with_commas
from ..framework.proof import Step
from ..framework.record import ProofOutcome, Statement
from .prose import prose_latex

DOCUMENT, MANIFEST = "equations.tex", "manifest.json"
_ROOM = 400.0  # points for a line of the document
_BETWEEN = 20.0  # points between two formulas of one line


def label(number: Number) -> str:
    """The number of an equation as file names and labels have it: "03" or "B05"."""
    return f"{number:02}" if isinstance(number, int) else f"{number[0]}{int(number[1:]):02}"


def fragment_name(number: Number) -> str:
    """File name of an equation's fragment."""
    return f"eq{label(number)}.tex"


def statement_latex(derivation: Statement) -> str:
    """The printed equation as a numbered display, ready to paste into text of one or two columns.

    Its label is ``eq:fd13`` of Eq. 13, and so on; several displays are (B7a), (B7b) and so on.
    """
    named = f"\\label{{eq:fd{label(derivation.number)}}}"
    first, *others = derivation.displays(columns=2)
    if not others:
        return f"\\begin{{equation}}{named}\n{first}\n\\end{{equation}}\n"
    displays = (f"\\begin{{equation}}\n{body}\n\\end{{equation}}\n" for body in (first, *others))
    return f"\\begin{{subequations}}{named}\n{''.join(displays)}\\end{{subequations}}\n"


def sentence(words: str) -> str:
    """Words with a capital letter, where they start with a word, and a full stop."""
    first = words.split(" ", 1)[0]
    capital = first[:1].upper() + words[1:] if first.isalpha() and len(first) > 1 else words
    return capital + ("" if words.endswith((".", "!", "?", ":")) else ".")


def display(formulas: Sequence[Basic], relation: str) -> str:
    """Formulas without numbers: in one line, or in several between which a page may end."""
    sign = RELATIONS[relation]
    alone = [latex_body([formula], sign, _ROOM) for formula in formulas]
    size = sum(map(width, alone)) + _BETWEEN * (len(alone) - 1)
    if size <= _ROOM and not any(r"\begin{aligned}" in body for body in alone):
        return "\\[ " + r" \qquad ".join(alone) + " \\]\n"
    body = latex_body(formulas, sign, _ROOM)
    lines = body.removeprefix("\\begin{aligned}\n").removesuffix("\n\\end{aligned}")
    return f"\\begin{{align*}}\n{lines}\n\\end{{align*}}\n"


def step_latex(step: Step, room: float = LINE_WIDTH) -> str:
    """What a step shows, for one display: the cases of a quantity, or its formulas."""
    if not _is_in_cases(step):
        return latex_body([step.formula], RELATIONS[step.relation], room)
    factor, values = over_common([equation.rhs for equation in step.equations])
    where = [with_commas(words.parts(case, words.LATEX)) for case in step.cases]
    rows = list(zip(values, where, strict=True))
    return latex_cases(step.equations[0].lhs, factor, rows, (), room)


def _is_in_cases(step: Step) -> bool:
    """Whether it shows the cases of one quantity."""
    quantities = {equation.lhs for equation in step.equations}
    return bool(step.cases) and len(quantities) == 1 and not step.formula.has(SiteFunction)


def _step(step: Step, derivation: Statement) -> str:
    """A step with its number, and in the margin what it rests on, and where it holds."""
    rests = [*map(str, step.steps_used), *(f"({number})" for number in step.equations_used)]
    margin = ", ".join([*rests, *step.assuming]), prose_latex(derivation.where(step))
    lines = r" \\ ".join(filter(None, margin))
    head = f"\\step{{{step.number}}}{{{lines}}}"
    if {*step.equations} <= {*derivation.printed} and step.relation == derivation.domain.relation:
        # not the same display twice
        return f"{head}{prose_latex(step.reason.rstrip('.:'))}: Eq.~({derivation.number}).\n"
    head += f"{prose_latex(step.reason)}\n"
    if _is_in_cases(step):
        return f"{head}\\[ {step_latex(step, _ROOM)} \\]\n"
    return head + display([*dict.fromkeys(step.equations)], step.relation)


def _aside(title: str, parts: Iterable[str]) -> str:
    listed = "; ".join(parts)
    return f"\\aside{{\\emph{{{title}:}} {listed}.}}\n" if listed else ""


def _meanings(derivation: Statement, frame: str) -> list[str]:
    """What its symbols mean, but for those that the document explains before all equations."""
    named = [(f"${latex(symbol)}$", meaning) for symbol, meaning in derivation.symbols]
    return [f"{name}: {prose_latex(meaning)}" for name, meaning in named if name not in frame]


def section_latex(outcome: ProofOutcome, frame: str = "", explained: Sequence[str] = ()) -> str:
    """One equation and its steps; what is ``explained`` of a symbol is not said again."""
    derivation, number = outcome.derivation, outcome.derivation.number
    proof = derivation.proof if outcome.verdict.is_proved else None
    symbols = [each for each in _meanings(derivation, frame) if each not in explained]
    parts = [
        f"\\heading{{Eq.~({number}). {prose_latex(derivation.title)}}}\n",
        f"\\begin{{equation}}\\label{{eq:fd{label(number)}}}\\tag{{{number}}}\n",
        f"{latex_body(derivation.printed, RELATIONS[derivation.domain.relation], _ROOM)}\n",
        "\\end{equation}\n",
        _aside("Symbols", symbols),
        _aside("Assumptions", map(prose_latex, derivation.assumptions)),
    ]
    if proof is None:
        checks = (f"{of.words}: {sentence(of.name)} {sentence(of.note)}" for of in outcome.checks)
        return "".join([*parts, f"Verdict: {outcome.ruling.words}.\n\n", *map(prose_latex, checks)])
    for reading in proof.refuted:
        formula = display([reading.formula], reading.domain.relation)
        words = (prose_latex(sentence(part)) for part in (reading.reading, reading.reason))
        parts.append(f"\n{formula}".join(words) + "\n")
    parts += [_step(step, derivation) for step in proof]
    remarks = [prose_latex(remark) for remark in derivation.remarks]
    errata = [remark for remark in remarks if remark.startswith("Erratum")]
    parts += [f"\\par {remark}\n" for remark in errata]
    parts.append(_aside("Also proved", (prose_latex(claim.reason) for claim in proof.claims)))
    parts += [f"\\aside{{{remark}}}\n" for remark in remarks if remark not in errata]
    if derivation.exact_forms and not any(map(_is_in_cases, proof)):
        parts.append(
            "\\par Exact at every site below the load, in several braces where one is too long:\n"
        )
        for form in derivation.exact_forms.values():
            parts += [f"\\[ {body} \\]\n" for body in form.displays()]
    return "".join(parts)


def _sections(outcomes: Iterable[ProofOutcome], frame: str) -> str:
    """The paper's equations; each symbol is explained where it first has that meaning."""
    sections: list[str] = []
    explained: list[str] = []
    for outcome in outcomes:
        if isinstance(outcome.derivation.number, int):
            sections.append(section_latex(outcome, frame, explained))
            explained += _meanings(outcome.derivation, frame)
    return "\n".join(sections)


def _verdicts(outcomes: Iterable[ProofOutcome]) -> str:
    rows = (
        f"({of.derivation.number}) & {prose_latex(of.derivation.title)} & "
        f"{prose_latex(of.ruling.words)} & {recorded(of.derivation).partition(' by ')[0]} \\\\\n"
        for of in outcomes
    )
    return (
        "\\begin{center}\\footnotesize\\setlength{\\tabcolsep}{3pt}"
        "\\setlength{\\extrarowheight}{2pt}\n"
        "\\begin{tabular}{r>{\\raggedright}p{84mm}>{\\raggedright}p{26mm}l}\n\\hline\n"
        f"Eq. & title & verdict & Coq \\\\\n\\hline\n{''.join(rows)}\\hline\n"
        "\\end{tabular}\n\\end{center}\n"
    )


def document(outcomes: Sequence[ProofOutcome]) -> str:
    """The paper's equations with their steps, and the verdicts on all."""
    frame = Path(__file__).with_name(DOCUMENT).read_text(encoding="utf-8")
    filled = frame.replace("% the equations\n", _sections(outcomes, frame))
    return filled.replace("% the verdicts\n", _verdicts(outcomes))
