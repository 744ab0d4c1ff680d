"""Means over N neighbours of one layer: covariances, the variance of the mean, all windows."""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from functools import cached_property

import sympy
from force_diffusion.symbolic.kernel import moments
from force_diffusion.symbolic.kernel.where import Loading, at_fixed_height
from force_diffusion.symbolic.notation import Symbol
from force_diffusion.symbolic.symbols import Covariance, M, N, Variance, i, j, m, p
from sympy import Eq, Ge, Rational

from ..framework.grounds import Source, facts_of
from ..framework.proving import Line
from ..framework.record import ExactCase, Missed
from ..framework.vocabulary import (
    UNIT,
    By,
    Lines,
    Where,
    asymptotic,
    cases,
    equation,
    moment,
    relations,
    terms,
    times,
)

COVARIANCES = tuple(
    Symbol(f"C_{place}", f"C_{{{place}}}", f"C{lowered}") for place, lowered in enumerate("₀₁₂")
)
"""Covariances of two that are 0, 1, 2 places apart, over the squared mean of one."""
FAR = Symbol("C_p", "C_{p}", "C_p")
"""That of two that are p places apart."""
OWN, FIRST, SECOND = COVARIANCES
OF_MEAN = (N * OWN + 2 * (N - 1) * FIRST + 2 * (N - 2) * SECOND) / N**2
"""Variance of the mean of N of them, if those farther apart are uncorrelated."""
SPREAD = OWN + 2 * FIRST + 2 * SECOND
"""What each of many neighbours adds to the variance of their sum."""
KEPT = -2 * FIRST - 4 * SECOND
"""What is left of that variance beside N times ``SPREAD``."""


def apart(quantity: sympy.Expr, places: sympy.Expr | int) -> sympy.Expr:
    """The same of the contact or bead so many places to the right, in the same layer."""
    return quantity.xreplace({i: i + 2 * places})


@dataclass(frozen=True)
class Window:
    """Numbers of neighbours, layers and heights with a closed form of their own.

    Attributes:
        validity: which, in words that are read as relations; M ≥ j + 1 where they leave M open.
        added: what it has beyond the printed form, in units of ``UNIT``/N²; None for a closed form
            that is found.
        missed: the height M with a value of its own, if there is one.
        parts: on which it is proved one by one, where too many places may be one on all of it.
    """

    validity: str
    added: sympy.Expr | None = None
    missed: int | None = None
    parts: tuple[tuple[sympy.Basic, ...], ...] = ((),)

    @cached_property
    def relations(self) -> tuple[sympy.Basic, ...]:
        """Which, as relations."""
        found = relations(self.validity)
        return found if any(one.has(M) for one in found) else (*found, Ge(M, j + 1))


@dataclass(frozen=True, eq=False)
class Means:
    """Covariances of a quantity and its neighbours in a layer, and the variance of their mean.

    Attributes:
        symbol: what is printed for the variance of the mean of N.
        quantity: at (i, j), over its mean.
        loading: of the packing.
        alone: how many places apart two may be correlated; at all others they are not.
        validity: of the printed form, in words that are read as relations.
        printed: that form.
        windows: all others.
        facts: what gives its forces in the radii.
    """

    symbol: sympy.Symbol
    quantity: sympy.Expr
    loading: Loading
    alone: tuple[sympy.Expr, ...]
    validity: str
    printed: sympy.Eq
    windows: Mapping[str, Window]
    facts: tuple[Source, ...] = field(repr=False, default=())

    def on(self, *relations: sympy.Basic) -> Where:
        """A domain of statements about it."""
        return Where.of(*relations, loading=self.loading).tightened()

    @cached_property
    def where(self) -> Where:
        """The domain of the printed form."""
        return self.on(*self.relations)

    @cached_property
    def relations(self) -> tuple[sympy.Basic, ...]:
        """That domain as relations."""
        return Window(self.validity).relations

    @cached_property
    def meaning(self) -> dict[sympy.Expr, sympy.Expr]:
        """What the symbols of its lines stand for."""
        both = {one: apart(self.quantity, place) for place, one in enumerate(COVARIANCES)}
        summed = sympy.Sum(apart(self.quantity, m), (m, 0, N - 1))
        return {
            **{one: Covariance(self.quantity, other) for one, other in both.items()},
            FAR: Covariance(self.quantity, apart(self.quantity, p)),
            self.symbol: Variance(summed / N),
        }

    @property
    def by(self) -> By:
        """How all of it is proved."""
        return moment(*self.facts, alone=self.alone)

    def lines(self) -> Lines:
        """Those about it, so far none."""
        return Lines(self.where, self.by, self.meaning)

    def value(self, symbol: sympy.Symbol, where: Where) -> sympy.Expr:
        """What one of the symbols is found to be; a line says that this is right."""
        facts = facts_of(self.facts)
        found = moments.value(self.meaning[symbol], facts, where, alone=self.alone)
        return found.to_sympy()

    @cached_property
    def exact(self) -> dict[str, ExactCase]:
        """The forms beside the printed one, as users get them."""
        return {name: self._case(window) for name, window in self.windows.items()}

    def _case(self, window: Window) -> ExactCase:
        where, domain = self.on(*window.relations), window.relations
        if window.added is None:
            form = self.value(self.symbol, where)
        else:
            more = times(sympy.factor(window.added / N**2), UNIT)
            form = terms(self.printed.rhs, more) if window.added else self.printed.rhs
        missed = tuple[Missed, ...]()
        if window.missed:
            domain = tuple(one for one in domain if not one.has(M))
            small = Eq(M, window.missed)
            value = self.value(self.symbol, self.on(*domain, small))
            words = f"{window.validity.rsplit(' and M', 1)[0]} and M = {window.missed}"
            missed = (Missed(words, (small,), value),)
        by = self.by if window.parts == ((),) else cases(self.by, *window.parts)
        line = Line(window.validity, equation(self.symbol, form), by, where, self.meaning)
        return ExactCase(self.symbol, window.validity, form, domain, missed, line=line)

    def _forms(self) -> Iterator[tuple[sympy.Expr, Where, By]]:
        """The forms of all windows, and of the heights that they miss."""
        for form in self.exact.values():
            assert form.line
            assert isinstance(form.line.by, By)
            for one in form.missed:
                yield one.expression, self.on(*form.domain, *one.when), form.line.by
            yield form.expression, form.line.domain(0), form.line.by

    def claim_windows(self, lines: Lines, name: str) -> None:
        """Claim what all windows, layers and heights have that the printed form is not for."""
        forms = [*self._forms()]
        said = ((self.symbol, form, where) for form, where, _ in forms)
        lines.claim_each(name, said, tuple(by for *_, by in forms))

    def claim_pairs(
        self, lines: Lines, name: str, pairs: Iterable[tuple[sympy.Expr, sympy.Expr]]
    ) -> None:
        """Claim covariances of two so many places apart, in units of ``UNIT``, deep inside."""
        deep = (j >= 6, Ge(M, j + 6))
        said = ((FAR, times(value, UNIT), self.on(*deep, Eq(p, place))) for place, value in pairs)
        lines.claim_each(name, said)

    def claim_shares(self, lines: Lines, variance: sympy.Expr, number: int) -> None:
        """Claim the correlations of neighbours to leading order, and what a mean keeps."""
        lines.claim(
            "to leading order a contact's correlation with its first neighbour is −2/3, with its "
            f"second 1/6: of Eq. {number} the mean keeps 2/(3N²)",
            sympy.Tuple(
                equation(FIRST, times(-Rational(2, 3), variance)),
                equation(SECOND, times(Rational(1, 6), variance)),
                equation(KEPT, times(Rational(2, 3), variance)),
            ),
            asymptotic(*self.facts),
            where=self.on(*relations("j ≥ 4, M ≥ j + 2")).in_the_limit(at_fixed_height("∼")),
        )
