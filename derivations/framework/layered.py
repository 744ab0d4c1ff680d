"""A moment at every layer of a packing, as a derivation tells it: weights, squares, closed forms.

One theorem for the interior, one for each edge, one for each small packing that has a value of its
own; each with its ``where``, from which users get the range of the closed form.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import sympy
from force_diffusion.symbolic.algebra.exact import FIELD, RationalFunction
from force_diffusion.symbolic.as_printed import equation, in_place, minus, terms, times
from force_diffusion.symbolic.kernel import moments
from force_diffusion.symbolic.kernel.theorem import Theorem
from force_diffusion.symbolic.kernel.where import Loading, Where, at_fixed_height, in_a_layer
from force_diffusion.symbolic.symbols import (
    LargestShare,
    M,
    Moment,
    j,
    phi,
    r,
    sigma,
)
from force_diffusion.symbolic.variances.listed import listed, squares, weights
from force_diffusion.symbolic.variances.variance import CASES, ClosedForm

from .grounds import (
    By,
    Proved,
    Source,
    asymptotic,
    bounded,
    facts_of,
    moment,
    rewrite,
)
from .proving import Line, Lines, Meaning
from .record import Derivation, ExactCase, Missed

SCALE = r * (1 - phi**2)
"""What the change of a force over its mean is multiplied by when its weights are shown."""

UNIT = (sigma / r) ** 2 / (1 - phi**2) ** 2
"""What variances of forces over their mean squared are numbers and powers of M times."""


@dataclass(frozen=True)
class Case:
    """Some layers with one closed form.

    Attributes:
        validity: which, in words.
        relations: the same as relations; equations fix the layer at an edge.
        missed: packings (M, j) of these layers with a value of their own.
    """

    validity: str
    relations: tuple[sympy.Basic, ...]
    missed: tuple[tuple[int, int], ...] = ()

    @property
    def layers(self) -> tuple[sympy.Basic, ...]:
        """The relations of the closed form and of what it misses together."""
        fixed = tuple(one for one in self.relations if isinstance(one, sympy.Eq))
        return fixed if self.missed else self.relations


def _case(name: str) -> Case:
    at, region, validity, heights = CASES[name]
    edge = [sympy.Eq(symbol, value) for symbol, value in at.items()]
    bounds = [sympy.Ge(symbol, bound) for symbol, bound in region.lower_bounds.items()]
    missed = [(size, int(at[j].xreplace({M: sympy.Integer(size)}))) for size in heights]
    return Case(validity, (*edge, *bounds), tuple(missed))


EVERY_LAYER: Mapping[str, Case] = {name: _case(name) for name in CASES}
"""All layers 0 ≤ j < M of a contact: the interior, both edges, and small packings."""


@dataclass(frozen=True, eq=False)
class Layered:
    """A mean, a variance or a covariance at every layer.

    Attributes:
        symbol: what is printed for it.
        moment: what that is, such as ``Variance(f⁺_ij/⟨f⟩)``, or a sum of several.
        facts: what gives its forces in the radii, to be put in one after the other.
        loading: of the packing; a load's direction is a symbol of the facts.
        meaning: of further symbols in the moment.
        cases: the layers, the interior first.
        by: what proves its closed forms; working out the moments, for most.
        said_as: what the symbol stands for there, if it is not the moment.
        dimension: of the packing.
        ordered_by: symbols by whose powers long sums are shown to users.
    """

    symbol: sympy.Expr
    moment: sympy.Expr
    facts: tuple[Source, ...]
    loading: Loading
    meaning: Meaning = field(default_factory=dict)
    cases: Mapping[str, Case] = field(default_factory=lambda: EVERY_LAYER)
    by: By | None = None
    said_as: sympy.Expr | None = None
    dimension: int | sympy.Symbol = 2
    ordered_by: tuple[sympy.Symbol, ...] = ()

    @property
    def meant(self) -> Meaning:
        """What a line's symbols stand for."""
        said_as = self.moment if self.said_as is None else self.said_as
        return {self.symbol: said_as, **self.meaning}

    @property
    def rule(self) -> By:
        """What proves its closed forms."""
        return self.by or moment(*self.facts)

    def where(self, case: str = "interior") -> Where:
        """The domain of a closed form."""
        return self._where(*self.cases[case].relations)

    @property
    def in_the_limit(self) -> Where:
        """The domain of what the interior goes as at a fixed relative height."""
        return self._large("interior", "∼")

    def _small(self, height: int, layer: int) -> Where:
        return self._where(sympy.Eq(j, layer), sympy.Eq(M, height))

    def _where(self, *relations: sympy.Basic) -> Where:
        return replace(Where.of(*relations, loading=self.loading), dimension=self.dimension)

    def _value(self, where: Where) -> RationalFunction:
        meant, facts = in_place(self.moment, self.meaning), facts_of(self.facts)
        if isinstance(meant, Moment):
            return moments.value(meant, facts, where)
        worked_out = moments.without_moments(equation(meant, sympy.S.Zero), facts, where).lhs
        return FIELD.from_sympy(worked_out).reduced()

    @cached_property
    def forms(self) -> dict[str, ClosedForm]:
        """The closed form of every case, as it is found; the lines say that it is right."""
        found = {}
        for name, case in self.cases.items():
            small = [(*at, self._value(self._small(*at)).to_sympy()) for at in case.missed]
            found[name] = ClosedForm(case.validity, tuple(small), self._value(self.where(name)))
        return found

    def exact(self, to_order: str = "first order") -> dict[str, ExactCase]:
        """The closed forms as users get them."""
        return {
            name: ExactCase(
                self.symbol,
                form.validity,
                self._shown(form.expression),
                domain=self.cases[name].layers,
                missed=tuple(
                    Missed(f"M = {size}, j = {at}", (sympy.Eq(M, size), sympy.Eq(j, at)), value)
                    for size, at, value in form.exceptions
                ),
                to_order=to_order,
            )
            for name, form in self.forms.items()
        }

    def _shown(self, expression: sympy.Expr) -> sympy.Expr:
        """The same; so ordered, long sums fit a column of a page."""
        if not self.ordered_by:
            return expression
        return expression.replace(
            lambda one: isinstance(one, sympy.Add) and one.has(*self.ordered_by),
            lambda one: sympy.collect(one, self.ordered_by),
        )

    def theorems(self, lines: Lines) -> tuple[Theorem, ...]:
        """What lines prove of every layer, and of the small packings."""
        values = {form.expression for form in self.forms.values()}
        values |= {value for *_, value in self._exceptions()}
        said = [equation(self.symbol, value) for value in values]
        return tuple(one.theorems[0] for one in lines if one.formula in said)

    # lines

    def show_weights(
        self, lines: Lines, scale: sympy.Expr = SCALE, factor: Sequence[sympy.Expr] = ()
    ) -> Line:
        """Show every radius of a variance with its weight, and the weights squared.

        ``scale`` is what the deviation from 1 is multiplied by, in factors of the paper's order.
        """
        (ratio,) = self.moment.args
        where, facts = self.where(), facts_of(self.facts)
        form = moments.in_the_radii(in_place(ratio, self.meaning), facts, where)
        found_in = moments.pieces(form, where)
        found = list(weights(found_in, where, FIELD.from_sympy(scale)))
        shown = times(*(factor or (r, terms(1, -(phi**2)))), terms(ratio, -1))
        every = lines.show(
            f"Exact, for {self.cases['interior'].validity}: every radius once, with its weight.",
            equation(shown, listed(found)),
            rewrite(*self.facts),
            where=where,
            meaning=self.meaning,
        )
        return lines.show(
            "Every weight squared:",
            equation(self.symbol, times((sigma / scale) ** 2, squares(found))),
            moment(*self.facts),
            where=where,
            meaning=self.meant,
            after=(every,),
        )

    def show_forms(self, lines: Lines, how: str, *after: Proved) -> Line:
        """Show the closed form of every layer, and the small packings with a value of their own.

        ``how`` they come about; the one in the interior, which is returned, comes ``after``.
        """
        shown: list[Line] = []
        place = "in the interior"
        for name, form in self.forms.items():
            shown.append(
                lines.show(
                    f"Exact {place}, {form.validity}: {how}.",
                    equation(self.symbol, form.expression),
                    self.rule,
                    where=self.where(name),
                    meaning=self.meant,
                    after=() if shown else after,
                )
            )
            place = "at the edge"
        for size, at, value in self._exceptions():
            lines.show(
                f"The packing M = {size}, j = {at} is none of these:",
                equation(self.symbol, value),
                self.rule,
                where=self._small(size, at),
                meaning=self.meant,
            )
        return shown[0]

    def claim_forms(self, lines: Lines, name: str) -> None:
        """Claim the closed form of every layer, and the values of small packings."""
        said = [(self.symbol, form.expression, self.where(at)) for at, form in self.forms.items()]
        small = ((value, self._small(size, at)) for size, at, value in self._exceptions())
        said += [(self.symbol, value, where) for value, where in small]
        lines.claim_each(name, said, self.rule, meaning=self.meant)

    def _exceptions(self) -> Iterator[tuple[int, int, sympy.Expr]]:
        yield from dict.fromkeys(one for form in self.forms.values() for one in form.exceptions)

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

    def claim_edges(self, lines: Lines, name: str, **goes_as: sympy.Expr) -> None:
        """Claim what the closed forms of edges go as, by the case."""
        said = ((self.symbol, one, self._large(case, "∼")) for case, one in goes_as.items())
        lines.claim_each(name, said, asymptotic(*self.facts), meaning=self.meant)

    def claim_shares(self, lines: Lines) -> None:
        """Claim that no radius dominates, inside and at the edges."""
        (ratio,) = self.moment.args
        lines.claim_each(
            "at fixed z, and in the layers next to base and surface, no radius has more than "
            "O(1/M) of the variance: what Lindeberg's theorem needs",
            ((LargestShare(ratio), 1 / M, self._large(case, "O")) for case in self.cases),
            bounded(*self.facts),
            meaning=self.meaning,
        )

    def _large(self, case: str, relation: str) -> Where:
        where = self.where(case)
        limit = in_a_layer(relation) if where.solved else at_fixed_height(relation)
        return where.in_the_limit(limit)


@dataclass(frozen=True)
class EveryLayer:
    """What an equation's lines prove of every layer."""

    of: Layered
    derivation: Derivation

    @property
    def theorems(self) -> tuple[Theorem, ...]:
        """One for each closed form."""
        lines = self.derivation.steps()
        assert isinstance(lines, Lines)
        return self.of.theorems(lines)

    @property
    def words(self) -> str:
        """How a line names it."""
        return self.derivation.words
