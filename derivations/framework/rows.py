"""A row of the calculator: a statistic with a label, what it means, and what is claimed of it."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache, cached_property

import sympy
from force_diffusion.symbolic.as_printed import equation
from force_diffusion.symbolic.kernel.decisions import Ruling, proved, refuted
from force_diffusion.symbolic.words import in_words

from ..api.closed_form import ClosedForm
from .catalogue import Number
from .grounds import By, closed
from .proving import Lines
from .record import Claim, Derivation

Forms = dict[str, ClosedForm]
"""Closed forms by name; the first is the usual one."""


@dataclass(frozen=True, eq=False)
class Row:
    """One or more statistics that the calculator gives.

    Attributes:
        number: its label.
        name: in code and JSON.
        title: in words.
        call: how a user asks for the first of them.
        forms: gives the closed forms; the quantity of each is a symbol of its own.
        meaning: what they say, in a sentence.
        symbols: each with its meaning.
        assumptions: in words.
        claims: further statements, each with what decides it from the closed forms.
        premises: the derivations that it rests on, by number.
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
    premises: tuple[Derivation, ...]
    claims: tuple[tuple[str, Callable[[Forms], Ruling]], ...] = ()
    remarks: tuple[str, ...] = ()
    dimension: int = 2

    @cached_property
    def exact(self) -> Forms:
        """The closed forms, computed once."""
        return self.forms()

    def steps(self) -> Lines:
        """A line for each formula."""
        first = next(iter(self.exact.values()))
        lines = Lines(first.where)
        for form in self.exact.values():
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

    @property
    def derivation(self) -> Derivation:
        """The row as an equation: printed is the first formula of each closed form."""
        return Derivation(
            number=self.number,
            name=self.name,
            title=self.title,
            symbols=self.symbols,
            assumptions=self.assumptions,
            premises=self.premises,
            printed=tuple(
                equation(form.quantity, form.formulas[0].value.to_sympy())
                for form in self.exact.values()
            ),
            steps=cache(self.steps),
            claims=tuple(
                Claim(name, lambda decide=decide: decide(self.exact)) for name, decide in self.claims
            ),
            remarks=(self.meaning, *self.remarks),
            where=next(iter(self.exact.values())).where,
            dimension=self.dimension,
            exact=lambda: self.exact,
        )


def _by(form: ClosedForm) -> By:
    return closed(lambda: form.theorems, *form._facts)


# what may be claimed


def leads(form: ClosedForm, *terms: sympy.Expr) -> Ruling:
    """Whether the highest orders at fixed z are these terms."""
    found = form.leading(len(terms))
    same = sympy.cancel(sympy.together(found - sympy.Add(*terms))) == 0
    return proved("the leading orders of the closed form") if same else refuted(f"{found} is true")
