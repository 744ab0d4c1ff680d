"""The shape of a derivation: the fields that every ``eqNN_…`` module fills, and its verdicts."""

from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from functools import cached_property
from importlib import import_module
from time import perf_counter
from types import MappingProxyType

import sympy
from force_diffusion.symbolic.algebra.exact import NotProvedError
from force_diffusion.symbolic.kernel.decisions import Ruling, Verdict, all_of
from force_diffusion.symbolic.kernel.domain import Domain
from force_diffusion.symbolic.kernel.rules import Rule
from force_diffusion.symbolic.kernel.theorem import Theorem
from force_diffusion.symbolic.printing.latex import RELATIONS
from force_diffusion.symbolic.printing.lines import latex_body, text_lines

from .catalogue import Number, in_order, modules
from .closed_form import ClosedForm
from .display import room_of
from .proof import Definitions, Step, Steps, equations_of, shown

_SECONDS: list[float] = []
"""How long each proof took, without those that ran within it."""


FIRST_ORDER = ("the radii are independent, of zero mean and variance σ²", "first order in δr")
SECOND_ORDER = (
    "the radii are independent, of zero mean and variance σ², of whatever law",
    "second order in δr",
)
"""What is assumed of all variances and covariances, and of all mean values."""


class Statement:
    """A derivation of an equation, or a row of the calculator."""

    number: Number
    name: str
    title: str
    symbols: tuple[tuple[sympy.Basic, str], ...]
    assumptions: tuple[str, ...]
    printed: tuple[sympy.Eq, ...]
    remarks: tuple[str, ...]
    domain: Domain
    step_domain: Domain | None = None
    definitions: Definitions = MappingProxyType({})
    show_steps: Callable[[Steps], None]
    exact: Callable[[], Mapping[str, ClosedForm]] | None
    call: str = ""
    """How the calculator is asked for it; "" where it is no row of that."""

    def __reduce__(self) -> tuple[Callable[[Number], "Statement"], tuple[Number]]:
        """It is made of functions, so a pickle holds its number."""
        return load, (self.number,)

    @cached_property
    def proof(self) -> Steps:
        """Its steps and claims, proved.

        Raises:
            NotProvedError: one of them is not.
        """
        start, others = perf_counter(), sum(_SECONDS)
        steps = Steps(self.number, self.step_domain or self.domain, self.definitions)
        self.show_steps(steps)
        steps.seconds = perf_counter() - start - (sum(_SECONDS) - others)
        _SECONDS.append(steps.seconds)
        return steps

    @property
    def premises(self) -> tuple[Number, ...]:
        """The equations that what is printed rests on, as its theorems say; none if not proved."""
        with suppress(NotProvedError, LookupError):
            return equations_of(self.theorems, self.number)
        return ()

    @property
    def used(self) -> tuple[Number, ...]:
        """The equations that some step or claim rests on; none where it is not proved."""
        with suppress(NotProvedError):
            shown = (*self.proof, *self.proof.claims)
            return in_order(number for step in shown for number in step.equations_used)
        return ()

    @cached_property
    def exact_forms(self) -> Mapping[str, ClosedForm]:
        """Closed forms, exact at finite size, by name; the first is the usual one."""
        return self.exact() if self.exact else {}

    @cached_property
    def exact_theorems(self) -> tuple[Theorem, ...]:
        """What the kernel proves of the usual closed form, on each part of its domain."""
        usual, *_ = self.exact_forms.values()
        return shown(self.number, *usual.theorems)

    @property
    def theorems(self) -> tuple[Theorem, ...]:
        """What the kernel proves of it, one theorem for each printed equation."""
        parts = (self.step_of(part) for part in range(len(self.printed)))
        return tuple(step.theorems[place] for step, place in parts)

    @property
    def theorem(self) -> Theorem:
        """The theorem of a derivation with one printed equation."""
        (theorem,) = self.theorems
        return theorem

    def step_of(self, part: int) -> tuple[Step, int]:
        """The step that shows one of ``printed``, and its place there.

        Raises:
            LookupError: there is none of its domain, and so of its sign.
        """
        wanted = self.printed[part], self.domain
        for step in self.proof:
            shown = [*zip(step.equations, step.domains, strict=True)]
            if wanted in shown:
                return step, shown.index(wanted)
        raise LookupError(f"no step of Eq. {self.number} shows what is printed, on its domain")

    def where(self, step: Step) -> str:
        """Where a step holds; "" if its reason says it, or the printed equation holds there."""
        home = step if self.call else self.step_of(0)[0]
        return step.where if step.where != home.where else ""

    def latex(self, columns: int = 1) -> str:
        """What is printed, for one display in text of one column or of two."""
        return latex_body(self.printed, RELATIONS[self.domain.relation], room_of(columns))

    def displays(self, columns: int = 1) -> list[str]:
        """The same, in as many displays as it takes to fit pages."""
        return [self.latex(columns)]

    def lines(self, room: int) -> list[str]:
        """What is printed, as lines of plain text."""
        return text_lines(sympy.Tuple(*self.printed), self.domain.relation, room)


def load(number: Number) -> Statement:
    """The derivation of one equation, or a row of the calculator.

    A module has one, ``DERIVATION``, or several by their numbers, ``DERIVATIONS``.
    """
    module = import_module(f"force_diffusion.derivations.{modules()[number]}")
    several: dict[Number, Statement] = getattr(module, "DERIVATIONS", {})
    return several[number] if several else module.DERIVATION


@dataclass(frozen=True)
class Derivation(Statement):
    """One numbered equation: what is printed, why it holds, and what else is known of it.

    ``show_steps`` is a function so that importing a derivation proves nothing and costs nothing.
    One of the steps is the printed equation.

    Attributes:
        number: of the paper; beyond it a label such as "B1".
        name: in code and JSON.
        title: in words.
        symbols: each with its meaning; ``glossary.usual`` gives the common ones.
        assumptions: in words.
        printed: the equations, each of which is the formula of a step.
        domain: where they are proved, with the load and the limit. The limit has the printed sign:
            "∼", left over right goes to 1; "≈", what is dropped varies less, by an order, than the
            force it is about; "∝", left over right goes to a positive function of φ alone.
        show_steps: proves them.
        step_domain: of a step that does not have its own; by default ``domain``.
        definitions: what symbols of all steps stand for.
        remarks: in words.
        exact: gives closed forms, exact at finite size, by name; the first is the usual one.
        deciders: rules that decide what is said of ``printed`` in a limit, beside that of its step.
    """

    number: Number
    name: str
    title: str
    symbols: tuple[tuple[sympy.Basic, str], ...]
    assumptions: tuple[str, ...]
    printed: tuple[sympy.Eq, ...]
    domain: Domain
    show_steps: Callable[[Steps], None]
    step_domain: Domain | None = None
    definitions: Definitions = field(default_factory=dict, hash=False)
    remarks: tuple[str, ...] = ()
    exact: Callable[[], Mapping[str, ClosedForm]] | None = None
    deciders: Callable[[], Sequence[Rule]] = tuple


@dataclass(frozen=True, kw_only=True)
class Check(Ruling):
    """The ruling on a step, a claim or a printed statement.

    Attributes:
        kind: "step", "proof", or "refutation" of a printed statement.
        name: what is checked.
    """

    kind: str
    name: str

    @property
    def is_expected(self) -> bool:
        """Whether a printed statement that is known not to hold was refuted."""
        return self.kind == "refutation" and self.verdict is Verdict.REFUTED


@dataclass(frozen=True)
class ProofOutcome:
    """What proving one equation showed: each check, and how long it took."""

    derivation: Statement
    checks: tuple[Check, ...]
    seconds: float = 0.0

    @cached_property
    def ruling(self) -> Ruling:
        """That on the equation: the worst of all, except for printed statements refuted."""
        return all_of(*(check for check in self.checks if check.kind != "refutation"))

    @property
    def verdict(self) -> Verdict:
        """The verdict on the equation."""
        return self.ruling.verdict

    @property
    def refuted(self) -> tuple[Check, ...]:
        """The printed statements that were refuted as expected; the verdict is on the others."""
        return tuple(check for check in self.checks if check.is_expected)
