"""A statistic of every layer of a packing: its exact closed form, and what that goes as."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property

import sympy
from force_diffusion.symbolic.as_printed import equation, in_place, minus, terms, times
from force_diffusion.symbolic.kernel import statistics
from force_diffusion.symbolic.kernel.theorem import Theorem, flat
from force_diffusion.symbolic.kernel.where import Loading, Where, at_fixed_height, in_a_layer
from force_diffusion.symbolic.symbols import LargestShare, M, Moment, j, phi, r, sigma
from force_diffusion.symbolic.words import in_words

from ..formulas.closed_form import ClosedForm
from .catalogue import Number
from .grounds import By, Proved, Source, asymptotic, bounded, closed, facts_of
from .proving import Line, Lines, Meaning

UNIT = (sigma / r) ** 2 / (1 - phi**2) ** 2
"""What variances of forces over their mean squared are numbers and powers of M times."""


@dataclass(frozen=True, eq=False)
class Layered:
    """A mean, a variance or a covariance at every layer 0 ≤ j < M.

    Attributes:
        number: of its equation.
        symbol: what is printed for it.
        moment: what that is, such as ``Variance(f⁺_ij/⟨f⟩)``, or a sum of several.
        facts: what gives its forces in the radii.
        loading: of the packing.
        meaning: of further symbols in the moment.
    """

    number: Number
    symbol: sympy.Expr
    moment: sympy.Expr
    facts: tuple[Source, ...]
    loading: Loading
    meaning: Meaning = field(default_factory=dict)

    @property
    def meant(self) -> Meaning:
        """What a line's symbols stand for."""
        return {self.symbol: self.moment, **self.meaning}

    @property
    def where(self) -> Where:
        """All layers."""
        return Where.of(j >= 0, j < M, loading=self.loading)

    @property
    def in_the_limit(self) -> Where:
        """The layers at a fixed relative height."""
        return self.where.in_the_limit(at_fixed_height("∼"))

    @cached_property
    def form(self) -> statistics.ClosedForm:
        """Its closed form."""
        return statistics.ClosedForm.of(self._meant, self.where, self._facts)

    @property
    def _meant(self) -> sympy.Expr:
        return in_place(self.moment, self.meaning)

    @cached_property
    def _facts(self) -> tuple[Theorem, ...]:
        return tuple(flat(facts_of(self.facts)))

    @cached_property
    def theorems(self) -> tuple[Theorem, ...]:
        """What the closed form says on each part of the packing."""
        return statistics.theorems(self._meant, self.where, self._facts)

    def exact(self, *premises: int | str) -> dict[str, ClosedForm]:
        """The closed form as users get it, with the equations that it rests on."""
        form = ClosedForm(self.symbol, self.form, self.where, premises, self._meant, self._facts)
        return {"layer": form}

    @property
    def words(self) -> str:
        """How a line names it."""
        return f"Eq. {self.number}"

    @property
    def rule(self) -> By:
        """What proves the closed form on each part of its domain."""
        return closed(lambda: self.theorems, *self.facts)

    def show_forms(self, lines: Lines, how: str, *after: Proved) -> Line:
        """Show the formula of each part of the packing; that of the interior is returned.

        ``how`` they come about; the first comes ``after`` other lines.
        """
        shown: list[Line] = []
        for piece in self.form.pieces:
            for part in piece.where:
                shown.append(
                    lines.show(
                        f"Exact for {in_words(part)}: {how}.",
                        equation(self.symbol, piece.value.to_sympy()),
                        self.rule,
                        where=self.where.also(*part),
                        meaning=self.meant,
                        after=() if shown else after,
                    )
                )
        return shown[0]

    def show_leading(self, lines: Lines, reason: str, formula: sympy.Eq, *after: Proved) -> Line:
        """Show what it goes as at a fixed relative height."""
        return lines.show(
            reason,
            formula,
            asymptotic(*self.facts),
            where=self.in_the_limit,
            meaning=self.meant,
            after=after,
        )

    def show_next(
        self, lines: Lines, printed: sympy.Expr, following: sympy.Expr, *after: Proved
    ) -> Line:
        """Show what it has beyond its printed leading order, in units of ``UNIT``."""
        return self.show_leading(
            lines,
            "The next order in M at fixed z:",
            equation(terms(self.symbol, minus(printed)), times(UNIT, following)),
            *after,
        )

    def claim_edges(self, lines: Lines, name: str, edges: Mapping[sympy.Expr, sympy.Expr]) -> None:
        """Claim what the closed form goes as in a layer next to base or surface."""
        said = ((self.symbol, one, self._edge(layer, "∼")) for layer, one in edges.items())
        lines.claim_each(name, said, asymptotic(*self.facts), meaning=self.meant)

    def claim_shares(self, lines: Lines) -> None:
        """Claim that no radius dominates, inside and at the edges."""
        assert isinstance(self.moment, Moment)
        (ratio,) = self.moment.args
        edges = (sympy.S.Zero, sympy.S.One, M - 1)
        wheres = (
            self.where.in_the_limit(at_fixed_height("O")),
            *(self._edge(layer, "O") for layer in edges),
        )
        lines.claim_each(
            "at fixed z, and in the layers next to base and surface, no radius has more than "
            "O(1/M) of the variance: what Lindeberg's theorem needs",
            ((LargestShare(ratio), 1 / M, where) for where in wheres),
            bounded(*self.facts),
            meaning=self.meaning,
        )

    def _edge(self, layer: sympy.Expr, relation: str) -> Where:
        fixed = sympy.Eq(j, layer, evaluate=False)
        domain = Where.of(fixed, j >= 0, j < M, loading=self.loading)
        return domain.in_the_limit(in_a_layer(relation))
