"""What proving an equation found, and the steps of its derivation, as a Python user reads them."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Self

from force_diffusion.symbolic.kernel.decisions import Verdict

from ..export.document import step_latex
from ..export.terminal import (
    check_text,
    expected_text,
    follows_text,
    heading,
    rests_text,
    steps_text,
    summary_line,
)
from ..framework.proof import Step
from ..framework.record import Check, ProofOutcome, Statement


@dataclass(frozen=True)
class Proof:
    """What :meth:`Equation.prove` found; it prints as lines.

    >>> import force_diffusion as fd
    >>> proof = fd.equation(3).prove()
    >>> [(outcome.derivation.number, str(outcome.verdict)) for outcome in proof.outcomes]
    [(2, 'proved'), (3, 'proved')]
    >>> proof.checks[0].name, proof.checks[0].note
    ('printed equation', 'by induction')

    Attributes:
        outcomes: all that has been run, premises first; the last is the equation's own.
    """

    outcomes: tuple[ProofOutcome, ...]

    @property
    def verdict(self) -> Verdict:
        """Proved; proved, assuming; refuted or undecided."""
        return self.outcomes[-1].verdict

    @property
    def checks(self) -> tuple[Check, ...]:
        """The printed equation, steps and claims, each with its verdict and note."""
        return self.outcomes[-1].checks

    @property
    def refuted(self) -> tuple[Check, ...]:
        """Printed statements that were refuted as expected: ERRATA.md says why."""
        return self.outcomes[-1].refuted

    def _headline(self) -> str:
        outcome, refuted = self.outcomes[-1], expected_text(len(self.refuted))
        number, verdict = outcome.derivation.number, f"{outcome.words}{refuted and f'; {refuted}'}"
        premises = f" {rests_text(outcome.derivation)}" if outcome.verdict.is_proved else ""
        return f"Eq. {number} is {verdict}.{premises}"

    def __str__(self) -> str:
        return "\n".join(
            [
                self._headline(),
                *map(summary_line, self.outcomes[:-1]),
                *map(check_text, self.checks),
            ]
        )

    __repr__ = __str__


class StepList(tuple[Step, ...]):
    """The steps of a derivation, which print as a numbered list.

    >>> import force_diffusion as fd
    >>> print(str(fd.equation(13).steps())[:46])
    Eq. 13: Variance of the forces under a surface
    """

    _derivation: Statement

    @classmethod
    def of(cls, derivation: Statement) -> Self:
        """The steps of one derivation."""
        steps = cls(derivation.proof)
        steps._derivation = derivation
        return steps

    def __reduce__(self) -> tuple[Callable[[Statement], Self], tuple[Statement]]:
        """Derive them anew: no theorem comes out of a pickle."""
        return self.of, (self._derivation,)

    def __str__(self) -> str:
        return f"{heading(self._derivation)}\n\n{steps_text(self)}"

    __repr__ = __str__

    def _repr_markdown_(self) -> str:
        lines = []
        for step in self:
            lines.append(f"{step.number}. {step.reason}")
            lines.append(f"$$\n{step_latex(step)}\n$$")
            lines.append(follows_text(step))
        return "\n\n".join(lines)
