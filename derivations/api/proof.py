"""The proof of an equation and the steps of its derivation, for Python users."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Self

from force_diffusion.symbolic.kernel.decisions import Verdict

from ..export import terminal
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

    def __str__(self) -> str:
        *others, own = self.outcomes
        premises = f" {terminal.rests_text(own.derivation)}" if own.verdict.is_proved else ""
        headline = f"Eq. {own.derivation.number} is {terminal.verdict_text(own)}.{premises}"
        checks = map(terminal.check_text, self.checks)
        return "\n".join([headline, *map(terminal.summary_text, others), *checks])

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
        return f"{terminal.heading(self._derivation)}\n\n{terminal.steps_text(self._derivation)}"

    __repr__ = __str__
