"""Printed equations and the steps to them, compared with files that a person has looked at."""

from collections.abc import Sequence
from pathlib import Path
from textwrap import indent

import pytest
from force_diffusion.derivations.export.document import fragment_name, statement_latex, step_latex
from force_diffusion.derivations.export.prose import prose_latex
from force_diffusion.derivations.export.terminal import heading, step_lines
from force_diffusion.derivations.framework.catalogue import modules
from force_diffusion.derivations.framework.lists import both
from force_diffusion.derivations.framework.proof import Refuted, Step
from force_diffusion.derivations.framework.record import load
from force_diffusion.symbolic.printing.latex import RELATIONS
from force_diffusion.symbolic.printing.lines import TEXT_WIDTH, latex_body, text_lines

from tests.derivations.rows import each

GOLDEN = Path(__file__).parents[2] / "golden"


def compare(path: Path, text: str, update: bool) -> None:
    """Compare with a file, or write it anew."""
    if update:
        path.parent.mkdir(exist_ok=True)
        path.write_text(text, encoding="utf-8")
    assert path.read_text(encoding="utf-8") == text, "run pytest --update-golden and review"


def shown(head: str, lines: Sequence[str], words: str, latex: str) -> str:
    """A formula as text, and below it words and the formula as LaTeX."""
    parts = (head, indent("\n".join(lines), "    "), prose_latex(words), indent(latex, "    "))
    return "\n\n".join(parts) + "\n"


def step_shown(step: Step, where: str) -> str:
    """A step as text and below it as LaTeX: the reason, and the formula that it gives."""
    uses = f", from {both(step.uses)}" if step.uses else ""
    head = f"Step {step.number} {where}".rstrip() + f"{uses}\n\n{step.reason}"
    return shown(head, step_lines(step), step.reason, step_latex(step))


def refuted_shown(refutation: Refuted) -> str:
    """A printed statement that does not hold, as text and below it as LaTeX."""
    relation = refutation.domain.relation
    lines = text_lines(refutation.formula, relation, TEXT_WIDTH)
    latex = latex_body([refutation.formula], RELATIONS[relation])
    return shown(f"Printed as well: {refutation.reading}", lines, refutation.reading, latex)


@pytest.mark.parametrize("number", each(modules()))
def test_statement(number, update_golden):
    derivation = load(number)
    compare(GOLDEN / fragment_name(derivation.number), statement_latex(derivation), update_golden)


def test_names_and_labels_have_two_digits():
    assert [*map(fragment_name, (3, "B5", "B13"))] == ["eq03.tex", "eqB05.tex", "eqB13.tex"]
    assert r"\label{eq:fd03}" in statement_latex(load(3))


@pytest.mark.parametrize("number", range(1, 17))
def test_steps(number, update_golden):
    derivation = load(number)
    steps = [step_shown(step, derivation.where(step)) for step in derivation.proof]
    refuted = [refuted_shown(refutation) for refutation in derivation.proof.refuted]
    text = "\n\n".join([f"{heading(derivation)}\n", *steps, *refuted])
    path = GOLDEN / "steps" / fragment_name(derivation.number).replace(".tex", ".txt")
    compare(path, text, update_golden)
