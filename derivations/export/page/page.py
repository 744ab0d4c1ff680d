"""The page put together: what each equation shows, and the template that holds it all."""

import os
import platform
import re
from base64 import b64encode
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from hashlib import sha256
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup

from ...coq.record import recorded
from ...framework.record import Check, Derivation, Outcome
from ..document import READING, sentence, statement_latex
from ..prose import both
from ..terminal import (
    expected_text,
    mutant_counts,
    relation_of,
    tried_counts,
    tried_text,
)
from .html import display, prose, symbol
from .parts import Part
from .proof_graph import proof_graph

_HERE = Path(__file__).parent
_SIZE = "0.00 MB"
_HASHES = "'sha256-'"
_PACKAGES = (
    "force-diffusion", "sympy", "numpy", "mpmath", "python-flint", "matplotlib", "Jinja2",
    "math-core", "numba",
)  # fmt: skip
_MARKS = {"proved": "✓", "agrees": "✓", "refuted": "✗", "disagrees": "✗", "undecided": "?",
          "proved, assuming": "✓", "not a statement": "∅",
          "equivalent": "≡", "accepted": "✓", "stale": "?", "not on record": "–",
          "not stated": "–"}  # fmt: skip


@dataclass(frozen=True)
class Note:
    """A verdict on something, and what it rests on."""

    verdict: str
    name: Markup
    note: Markup


def _noted(verdict: str, name: str, note: str, assuming: Sequence[str] = ()) -> Note:
    told = [f"It assumes {one}" for one in assuming] + [note] * bool(note)
    return Note(verdict, prose(sentence(name)), prose(" ".join(map(sentence, told))))


def _steps(derivation: Derivation, checks: Sequence[Check]) -> Iterator[tuple[Markup | str, ...]]:
    """Reason, formula, verdict, what it assumes, and what it follows from."""
    for step, check in zip(derivation.steps(), checks, strict=True):
        formula = display([step.formula], relation_of(derivation, step))
        uses, assumed = (prose(both(one)) if one else "" for one in (step.uses, check.assuming))
        yield prose(step.reason), formula, check.verdict, assumed, uses


def equation_view(outcome: Outcome, outcomes: Sequence[Outcome]) -> dict[str, Any]:
    """All that the page shows of one equation."""
    derivation = outcome.derivation
    kinds = {
        kind: [c for c in outcome.checks if c.kind == kind]
        for kind in ("step", "proof", "witness", "refutation")
    }
    return {
        "number": derivation.number,
        "title": prose(derivation.title),
        "verdict": outcome.verdict,
        "assuming": prose(" and ".join(outcome.assuming)),
        "coq": recorded(derivation),
        "printed": display(derivation.printed, derivation.relation),
        "refuted": [
            (display([one.formula], one.relation), _noted(str(c.verdict), c.name, c.note))
            for one, c in zip(derivation.refuted, kinds["refutation"], strict=True)
        ],
        "symbols": [(symbol(one), prose(words)) for one, words in derivation.symbols],
        "assumptions": [prose(sentence(words)) for words in derivation.assumptions],
        "premises": [premise.number for premise in derivation.premises],
        "used_by": [
            other.derivation.number
            for other in outcomes
            if derivation.number in [premise.number for premise in other.derivation.premises]
        ],
        "steps": list(_steps(derivation, kinds["step"])),
        "proofs": [_noted(c.verdict, c.name, c.note, c.assuming) for c in kinds["proof"]],
        "witnesses": [_noted(c.verdict, c.name, c.note) for c in kinds["witness"]],
        "counts": mutant_counts(outcome),
        "mutants": [
            Note(mutant.verdict, prose(mutant.change), prose(mutant.note))
            for mutant in outcome.mutants
        ],
        "remarks": [prose(words) for words in derivation.remarks],
        "latex": statement_latex(derivation).strip(),
        "seconds": f"{outcome.seconds:.2f}",
    }


def versions() -> list[tuple[str, str]]:
    """What made the page: Python, the system, and the packages that are installed."""
    system = f"{platform.system()}, {platform.machine()}, {os.cpu_count()} cores"
    found = [("Python", platform.python_version()), ("system", system)]
    for name in _PACKAGES:
        try:
            found.append((name, version(name)))
        except PackageNotFoundError:  # an extra that is not installed, or a checkout
            continue
    return found


def page(outcomes: Sequence[Outcome], parts: Sequence[Part], command: str, made: str) -> str:
    """The whole page, which states its own size.

    ``made`` is the time at which it was made, in words; ``command`` is what makes it again.
    """
    style = (_HERE / "style.css").read_text(encoding="utf-8")
    environment = Environment(
        loader=FileSystemLoader(_HERE),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    checks = [check for outcome in outcomes for check in outcome.checks]
    counts = [mutant_counts(outcome) for outcome in outcomes]
    text = environment.get_template("page.html").render(
        style=Markup(style),
        style_hashes=Markup(_HASHES),
        equations=[equation_view(outcome, outcomes) for outcome in outcomes],
        totals={
            "proved": sum(one.verdict.is_proved and not one.assuming for one in outcomes),
            "assuming": sum(one.verdict.is_proved and bool(one.assuming) for one in outcomes),
            "expected": expected_text(sum(check.is_expected for check in checks)),
            "proofs": sum(check.kind == "proof" for check in checks),
            "witnesses": sum(check.kind == "witness" for check in checks),
            **{kind: sum(count[kind] for count in counts) for kind in counts[0]},
            "seconds": f"{sum(outcome.seconds for outcome in outcomes):.1f}",
        },
        tried=tried_text(tried_counts(outcomes)),
        marks=_MARKS,
        reading=READING,
        graph=proof_graph(outcomes),
        parts=parts,
        versions=versions(),
        command=command,
        made=made,
        size=_SIZE,
        prose=prose,
    )
    # MathML aligns the cells of tables, and moves what \! does, by style attributes
    styles = dict.fromkeys([style, *re.findall(r'<m\w+ style="([^"]*)"', text)])
    text = text.replace(_HASHES, " ".join(map(_hash, styles)), 1)
    return text.replace(_SIZE, f"{len(text.encode()) / 1e6:.2f} MB", 1)


def _hash(style: str) -> str:
    """What the page's policy allows: this style and no other."""
    return f"'sha256-{b64encode(sha256(style.encode()).digest()).decode()}'"
