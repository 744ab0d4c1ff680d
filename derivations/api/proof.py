"""What proving an equation found, and the steps of its derivation, as a Python user reads them."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Self

from force_diffusion.symbolic.kernel.decisions import Verdict
from force_diffusion.symbolic.printing.latex import RELATIONS
from force_diffusion.symbolic.printing.lines import latex_body

from ..export.terminal import (
    check_text,
    expected_text,
    follows_text,
    heading,
    relation_of,
    steps_text,
    summary_line,
)
from ..framework.proving import Shown
from ..framework.record import Check, Outcome, Statement


@dataclass(frozen=True)
class Proof:
    """What :meth:`Equation.prove` found; it prints as lines, and as a table in a notebook.

    >>> import force_diffusion as fd
    >>> proof = fd.equation(2).prove()
    >>> [(outcome.derivation.number, str(outcome.verdict)) for outcome in proof.outcomes]
    [(1, 'proved'), (2, 'proved')]
    >>> proof.checks[0].name, proof.checks[0].note
    ('printed equation', 'by the rule: solve')

    Attributes:
        outcomes: all that has been run, premises first; the last is the equation's own.
        premises_run: whether the premises have been proved too, or are taken as proved.
    """

    outcomes: tuple[Outcome, ...]
    premises_run: bool

    @property
    def verdict(self) -> Verdict:
        """Proved; proved, assuming; refuted or undecided: of the equation, given its premises."""
        return self.outcomes[-1].verdict

    @property
    def checks(self) -> tuple[Check, ...]:
        """The printed equation, steps and claims, each with its verdict and note."""
        return self.outcomes[-1].checks

    @property
    def refuted(self) -> tuple[Check, ...]:
        """Printed statements that were refuted as expected: ERRATA.md says why."""
        return self.outcomes[-1].refuted

    def _said(self) -> str:
        outcome, refuted = self.outcomes[-1], expected_text(len(self.refuted))
        return f"Eq. {outcome.derivation.number} is {outcome.words}{refuted and f'; {refuted}'}."

    def _premises(self) -> str:
        numbers = [str(one.number) for one in self.outcomes[-1].derivation.premises]
        if not numbers:
            return "It rests on no other equation."
        plural = "s" if len(numbers) > 1 else ""
        state = "run too" if self.premises_run else "taken as proved, not run"
        return f"Its premise{plural}, Eq{plural}. {', '.join(numbers)}: {state}."

    def __str__(self) -> str:
        return "\n".join(
            [
                f"{self._said()} {self._premises()}",
                *map(summary_line, self.outcomes[:-1]),
                *map(check_text, self.checks),
            ]
        )

    __repr__ = __str__

    def _repr_markdown_(self) -> str:
        def row(*cells: str) -> str:
            return f"| {' | '.join(cell.replace('|', chr(92) + '|') for cell in cells)} |"

        rows = [row(one.kind, one.words, one.name, one.note) for one in self.checks]
        return "\n".join(
            [
                f"**{self._said()}** {self._premises()}",
                "",
                row("kind", "verdict", "check", "note"),
                row("---", "---", "---", "---"),
                *rows,
            ]
        )


class Steps(tuple[Shown, ...]):
    """The steps of a derivation, which print as a numbered list.

    >>> import force_diffusion as fd
    >>> print(str(fd.equation(13).steps())[:46])
    Eq. 13: Variance of the forces under a surface
    """

    _derivation: Statement

    @classmethod
    def of(cls, derivation: Statement) -> Self:
        """The steps of one derivation."""
        made = cls(derivation.steps())
        made._derivation = derivation
        return made

    def __reduce__(self) -> tuple[Callable[[Statement], Self], tuple[Statement]]:
        """Derive them anew: no theorem comes out of a pickle."""
        return self.of, (self._derivation,)

    def __str__(self) -> str:
        verdicts = [str(step.ruling) for step in self]
        return f"{heading(self._derivation)}\n\n{steps_text(self._derivation, verdicts)}"

    __repr__ = __str__

    def _repr_markdown_(self) -> str:
        lines = []
        for place, step in enumerate(self, start=1):
            relation = RELATIONS[relation_of(self._derivation, step)]
            lines.append(f"{place}. {step.reason}")
            lines.append(f"$$\n{latex_body([step.formula], relation)}\n$$")
            lines.append(follows_text(step, step.ruling.words))
        return "\n\n".join(lines)
