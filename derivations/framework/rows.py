"""A row of the calculator: a statistic with a label, what it means, and what is claimed of it."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, partial

import sympy
from force_diffusion.symbolic.as_printed import equation
from force_diffusion.symbolic.kernel.decisions import Ruling, proved, refuted
from force_diffusion.symbolic.kernel.where import Where
from force_diffusion.symbolic.words import in_words

from ..api.closed_form import ClosedForm
from .catalogue import Number
from .grounds import By, closed
from .proving import Lines
from .record import Claim, Statement

Forms = dict[str, ClosedForm]
"""Closed forms by name; the first is the usual one."""


@dataclass(frozen=True, eq=False)
class Row(Statement):
    """One or more statistics that the calculator gives, under a label.

    Nothing is computed before it is asked for.

    Attributes:
        number: its label.
        name: in code and JSON.
        title: in words.
        call: how a user asks for the first of them.
        forms: gives the closed forms; the quantity of each is a symbol of its own.
        meaning: what they say, in a sentence.
        symbols: each with its meaning.
        assumptions: in words.
        premises: the derivations that it rests on.
        statements: further statements, each with what decides it from the closed forms.
        dimension: of the packing.
    """

    number: Number
    name: str
    title: str
    call: str
    forms: Callable[[], Forms]
    meaning: str
    symbols: tuple[tuple[sympy.Basic, str], ...]
    assumptions: tuple[str, ...]
    premises: tuple[Statement, ...]
    statements: tuple[tuple[str, Callable[[Forms], Ruling]], ...] = ()
    dimension: int = 2
    relation = "="
    loads = ()

    def exact(self) -> Forms:  # type: ignore[override]
        """The closed forms, by name."""
        return self.forms()

    @property
    def remarks(self) -> tuple[str, ...]:
        """What the forms say."""
        return (self.meaning,)

    @cached_property
    def printed(self) -> tuple[sympy.Eq, ...]:  # type: ignore[override]
        """The closed forms as equations."""
        return tuple(form.equation for form in self.exact_forms.values())

    def latex(self, columns: int = 1) -> str:
        """The closed forms, for one display in text of one column or of two."""
        first, *others = (form.latex(columns) for form in self.exact_forms.values())
        if not others:
            return first
        body = " \\\\[6pt]\n&".join((first, *others))
        return f"\\begin{{aligned}}\n&{body}\n\\end{{aligned}}"

    def displays(self, columns: int = 1) -> list[str]:
        """The same, in as many displays as it takes to fit pages."""
        return [one for form in self.exact_forms.values() for one in form.displays(columns)]

    def lines(self, room: int) -> list[str]:
        """The closed forms as lines of plain text."""
        return [line for form in self.exact_forms.values() for line in form.lines(room)]

    def rule_on(self, part: int, candidate: sympy.Eq, where: Where | None = None) -> Ruling:
        """Rule on a candidate for one of the closed forms."""
        return [*self.exact_forms.values()][part].rule_on(candidate)

    @property
    def where(self) -> Where:
        """The domain of the first closed form."""
        return next(iter(self.exact_forms.values())).where

    @property
    def claims(self) -> tuple[Claim, ...]:  # type: ignore[override]
        """Further statements, decided from the closed forms."""
        return tuple(
            Claim(words, partial(decide, self.exact_forms)) for words, decide in self.statements
        )

    def steps(self) -> Lines:  # type: ignore[override]
        """A line for each formula and part of its domain."""
        return self._steps

    @cached_property
    def _steps(self) -> Lines:
        lines = Lines(self.where)
        for form in self.exact_forms.values():
            by = _by(form)
            for formula in form.formulas:
                for part in formula.where:
                    lines.show(
                        f"For {in_words(part) or form.domain}:",
                        equation(form.quantity, formula.value.to_sympy()),
                        by,
                        where=form.where.also(*part),
                        meaning={form.quantity: form.meant},
                    )
        return lines


def _by(form: ClosedForm) -> By:
    return closed(lambda: form.theorems, *form.facts)


# what may be claimed


def leads(form: ClosedForm, *terms: sympy.Expr) -> Ruling:
    """Whether the highest orders at fixed z are these terms."""
    found = form.leading(len(terms))
    same = sympy.cancel(sympy.together(found - sympy.Add(*terms))) == 0
    return proved("the leading orders of the closed form") if same else refuted(f"{found} is true")
