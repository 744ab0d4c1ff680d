"""The steps of a derivation: what each shows, why it holds, and the theorem that the kernel made.

A step calls a rule of the kernel, and holds the theorem that it returns. What it rests on is read
off that theorem.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property, partialmethod
from typing import Any

import sympy
from force_diffusion.symbolic import symbols as sy
from force_diffusion.symbolic.algebra.exact import NotProvedError
from force_diffusion.symbolic.kernel.domain import Domain
from force_diffusion.symbolic.kernel.rules import Rule, proved_by
from force_diffusion.symbolic.kernel.theorem import FalseStatementError, Theorem
from force_diffusion.symbolic.piecewise import Relations
from force_diffusion.symbolic.trees import in_place
from force_diffusion.symbolic.words import in_their_words
from sympy.core.function import UndefinedFunction

from .catalogue import Number, in_order

Definitions = Mapping[Any, Any]
"""What stands for a symbol of a step's own, or for a function of its arguments."""

_MEANINGS = {
    sy.spacing: sy.Dot(sy.e_x, sy.Position(sy.i + 2, sy.j) - sy.Position(sy.i, sy.j)),
    sy.L_minus: sy.t * sy.L_plus,
}
"""Symbols of the paper that steps define, as this alone."""
_NAMES = {symbol.name for symbol in (*sy.INDICES, *sy.PARAMETERS, *sy.VECTORS, sy.H_M)}


@dataclass(frozen=True, eq=False, repr=False)
class Step:
    """One or more equations with one reason.

    Attributes:
        equation: the number of the derivation.
        reason: why it holds, in plain words (Unicode).
        formula: the equation, or a Tuple of equations, as shown.
        rules: that prove them, and anything put in their place.
        domains: where they hold.
        definitions: what symbols of each stand for.
        theorems: what the kernel made of them.
        number: its place among the steps, from 1; 0 of a claim.
    """

    equation: Number
    reason: str
    formula: sympy.Basic
    rules: tuple[Rule, ...]
    domains: tuple[Domain, ...]
    definitions: tuple[Definitions, ...]
    theorems: tuple[Theorem, ...]
    number: int = 0

    def __repr__(self) -> str:
        return f"<step {self.number} of Eq. {self.equation}: {self.reason}>"

    @property
    def equations(self) -> tuple[sympy.Eq, ...]:
        """Its equations, one by one."""
        return tuple(self.formula) if isinstance(self.formula, sympy.Tuple) else (self.formula,)

    @property
    def theorem(self) -> Theorem:
        """The theorem of a step with one equation."""
        (theorem,) = self.theorems
        return theorem

    @cached_property
    def relations(self) -> Relations:
        """The relations between indices that hold for all of its equations."""
        first, *others = self.domains
        return tuple(each for each in first.relations if all(each in of.relations for of in others))

    @cached_property
    def cases(self) -> tuple[Relations, ...]:
        """Further ones, for each equation; () if there are none."""
        further = tuple(
            tuple(relation for relation in domain.relations if relation not in self.relations)
            for domain in self.domains
        )
        return further if any(further) else ()

    @property
    def where(self) -> str:
        """Where all of its equations hold, in words; "" for everywhere."""
        if limit := self.domains[0].limit:
            return f"as {limit.words}"
        return f"for {in_their_words(self.relations)}" * bool(self.relations)

    @property
    def relation(self) -> str:
        """How it relates its sides: "=", or as in the limit that it is about."""
        return self.domains[0].relation

    @property
    def assuming(self) -> tuple[str, ...]:
        """What its proof assumes and no rule discharges."""
        return tuple(sorted(set().union(*(theorem.assuming for theorem in self.theorems))))

    @cached_property
    def _sources(self) -> tuple["Place", ...]:
        return tuple(_sources(premise for theorem in self.theorems for premise in theorem.premises))

    @property
    def equations_used(self) -> tuple[Number, ...]:
        """The other equations that its theorems rest on."""
        return in_order({equation for equation, _ in self._sources} - {self.equation})

    @property
    def steps_used(self) -> tuple[int, ...]:
        """The numbers of earlier steps that its theorems rest on."""
        numbers = {number for equation, number in self._sources if equation == self.equation}
        return tuple(sorted(numbers - {0}))

    @property
    def uses(self) -> tuple[str, ...]:
        """Both, in words."""
        equations = (f"Eq. {number}" for number in self.equations_used)
        return (*equations, *(f"step {number}" for number in self.steps_used))


Place = tuple[Number, int]
"""An equation and one of its steps; 0 for none of them."""

_PLACE_OF: dict[Theorem, Place] = {}
"""Where a theorem is shown."""


def shown(equation: Number, *theorems: Theorem) -> tuple[Theorem, ...]:
    """The theorems that an equation shows, without its other steps."""
    for theorem in theorems:
        _PLACE_OF.setdefault(theorem, (equation, 0))
    return theorems


def equations_of(theorems: Iterable[Theorem], own: Number = 0) -> tuple[Number, ...]:
    """The equations, but for their ``own``, that show theorems, or what these rest on."""
    return in_order(equation for equation, _ in _sources(theorems, own))


def _sources(theorems: Iterable[Theorem], own: Number = 0) -> Iterator[Place]:
    """Where theorems are shown, or what these rest on: the nearest place on each way.

    Places of their ``own`` equation are passed.
    """
    rest, seen = list(theorems), set[Theorem]()
    while rest:
        theorem = rest.pop(0)
        if theorem in seen:
            continue
        seen.add(theorem)
        if theorem in _PLACE_OF and _PLACE_OF[theorem][0] != own:
            yield _PLACE_OF[theorem]
        else:
            rest += theorem.premises


@dataclass(frozen=True)
class Refuted:
    """A printed statement that is false, as expected.

    Attributes:
        reading: how the paper's words are read.
        formula: the equation.
        domain: where it should hold.
        reason: why it is false, as the rule says.
    """

    reading: str
    formula: sympy.Eq
    domain: Domain
    reason: str


class Steps(list[Step]):
    """The steps of a derivation, which number themselves.

    ``seconds`` is how long their proof took, without those of the equations that it rests on.

    Args:
        equation: the number of the derivation.
        domain: of a step that does not have its own.
        definitions: what symbols of all steps stand for.
    """

    def __init__(self, equation: Number, domain: Domain, definitions: Definitions) -> None:
        super().__init__()
        self._equation, self._domain, self._definitions = equation, domain, definitions
        self.claims: list[Step] = []
        self.refuted: list[Refuted] = []
        self.seconds = 0.0

    def show(
        self,
        reason: str,
        formula: sympy.Basic,
        rule: Rule | Sequence[Rule],
        domain: Domain | Sequence[Domain] | None = None,
        definitions: Definitions | Sequence[Definitions] = (),
        *,
        is_claim: bool = False,
    ) -> Step:
        """Prove a step, or a claim, and add it.

        Raises:
            NotProvedError: the rule does not prove it.
        """
        number = 0 if is_claim else len(self) + 1
        equations = tuple(formula) if isinstance(formula, sympy.Tuple) else (formula,)
        count = len(equations)
        rules: tuple[Rule, ...] = _for_each(rule, count)
        domains: tuple[Domain, ...] = _for_each(self._domain if domain is None else domain, count)
        own: tuple[Definitions, ...] = _for_each(definitions, count)
        defined = tuple({**self._definitions, **further} for further in own)
        for symbol, meaning in (item for each in defined for item in each.items()):
            if not _may_be_defined(symbol, meaning):
                raise NotProvedError(f"{symbol} has a meaning of its own")
        try:
            theorems = tuple(
                proved_by(by, in_place(line, symbols), where)
                for line, by, where, symbols in zip(equations, rules, domains, defined, strict=True)
            )
        except NotProvedError as error:
            name = "the claim" if is_claim else f"step {number},"
            raise NotProvedError(f"{name} '{reason}': {error}") from error
        if any(theorem.supposed for theorem in theorems):
            raise NotProvedError(f"it rests on what is only supposed: {reason}")
        proof = rules, domains, defined, theorems
        step = Step(self._equation, reason, formula, *proof, number)
        for theorem in shown(self._equation, *theorems):
            if _PLACE_OF[theorem] == (self._equation, 0):
                _PLACE_OF[theorem] = self._equation, number
        (self.claims if is_claim else self).append(step)
        return step

    claim = partialmethod(show, is_claim=True)
    """Prove a further statement, which is not one of the steps."""

    def refute(self, reading: str, formula: sympy.Eq, rule: Rule, domain: Domain) -> None:
        """Show that a printed statement is false.

        Raises:
            NotProvedError: it is not shown to be so.
        """
        try:
            rule(in_place(formula, self._definitions), domain)
        except FalseStatementError as reason:
            self.refuted.append(Refuted(reading, formula, domain, str(reason)))
            return
        raise NotProvedError(f"this is proved, and was to be refuted: {reading}")


def _may_be_defined(what: Any, meaning: Any) -> bool:
    """Whether a step may say what something stands for: it is, or holds, a new symbol."""
    if what in _MEANINGS:
        return bool(meaning == _MEANINGS[what])
    if isinstance(what, UndefinedFunction):
        return True
    if isinstance(what, type) or what.has(sympy.Function):
        return False
    return any(symbol.name not in _NAMES for symbol in what.free_symbols)


def _for_each(given: Any, count: int) -> tuple[Any, ...]:
    """One for each equation of a step, where one is for all."""
    if isinstance(given, tuple | list):
        return tuple(given) or ({},) * count
    return (given,) * count
