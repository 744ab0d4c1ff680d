"""Several equations derived together, premises first: the verdicts, as JSON and as LaTeX."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any

from force_diffusion.numeric.arithmetic.errors import checked
from force_diffusion.symbolic.kernel.decisions import Verdict

from ..export import terminal
from ..export.document import DOCUMENT, document, fragment_name, statement_latex
from ..framework.catalogue import Number, modules
from ..framework.record import ProofOutcome
from ..framework.runner import run_all
from .equation import numbers_of


@dataclass(frozen=True)
class Derived:
    """What :func:`derive` found; it prints one line for each equation, followed by what is wrong.

    Attributes:
        outcomes: the verdict and the checks of each equation, premises first.
    """

    outcomes: tuple[ProofOutcome, ...]

    @property
    def verdicts(self) -> dict[Number, Verdict]:
        """Verdicts by the equation's number: proved; proved, assuming; refuted; or undecided."""
        return {outcome.derivation.number: outcome.verdict for outcome in self.outcomes}

    @property
    def proved(self) -> bool:
        """Whether all are proved, perhaps under assumptions; ``counts`` says how many.

        Printed statements that are refuted as expected make no difference.
        """
        return all(verdict.is_proved for verdict in self.verdicts.values())

    def counts(self) -> str:
        """How many equations have each verdict, and how many printed statements are refuted."""
        return terminal.counts_text(self.outcomes)

    def data(self) -> dict[str, Any]:
        """Data for JSON: verdicts and checks of each equation, times in seconds."""
        return terminal.outcomes_data(self.outcomes)

    def latex(self) -> dict[str, str]:
        """LaTeX by file name: a fragment for each equation, and the paper re-derived.

        The fragments fit text of one column and of two.
        """
        statements = [outcome.derivation for outcome in self.in_order]
        fragments = {fragment_name(each.number): statement_latex(each) for each in statements}
        return {**fragments, DOCUMENT: document(self.in_order)}

    @property
    def in_order(self) -> list[ProofOutcome]:
        """The outcomes by number, not premises first."""
        place = {number: at for at, number in enumerate(modules())}
        return sorted(self.outcomes, key=lambda each: place.get(each.derivation.number, len(place)))

    def __str__(self) -> str:
        return "\n".join([*map(terminal.summary_text, self.outcomes), f"{self.counts()}."])

    __repr__ = __str__


@checked
def derive(
    numbers: Iterable[Number] | None = None,
    *,
    notice: Callable[[str], None] = lambda _: None,
    finished: Callable[[ProofOutcome], None] = lambda _: None,
) -> Derived:
    """Prove equations and all that they rest on.

    :meth:`Equation.prove` is the same for one equation.

    >>> import force_diffusion as fd
    >>> derived = fd.derive([3])
    >>> {number: str(verdict) for number, verdict in derived.verdicts.items()}
    {2: 'proved', 3: 'proved'}
    >>> derived.proved, derived.counts(), sorted(derived.latex())
    (True, '2 proved', ['eq02.tex', 'eq03.tex', 'equations.tex'])

    Args:
        numbers: of the equations, all of them by default.
        notice: called with the equation that comes next.
        finished: called with the outcome of each equation as soon as it is known.

    Raises:
        NoSuchFormError: there is no equation of that number.
        WrongTypeError: ``numbers`` is a single number.
    """
    wanted = numbers_of(modules() if numbers is None else numbers, "derive")
    outcomes = []
    for outcome in run_all(wanted, lambda statement: notice(f"Eq. {statement.number}")):
        outcomes.append(outcome)
        finished(outcome)
    return Derived(tuple(outcomes))
