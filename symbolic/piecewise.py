"""Functions of indices: as formulas on parts of a domain, in the fewest words, and as Piecewise."""

from collections.abc import Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass, field, replace
from functools import cached_property

import sympy
from sympy.core.relational import Relational

from . import sets, shortest, words
from . import symbols as sy
from .algebra.exact import (
    FIELD,
    Field,
    NotAStatementError,
    NotExactError,
    NotProvedError,
    RationalFunction,
)
from .forms import NUMBER, Straightening
from .kernel.domain import Domain
from .kernel.statistics import worked_out
from .kernel.theorem import Group, bound_in, names_for
from .notation import by_name
from .printing.text import text
from .quotients import factored
from .trees import in_place, nodes
from .weights import Weights

Relations = tuple[sympy.Basic, ...]


@dataclass(frozen=True, eq=False)
class Piece:
    """A formula of a function, and where it holds.

    Attributes:
        where: relations of indices; those of any of several parts.
        value: the formula as the kernel has it.
    """

    where: tuple[Relations, ...]
    value: RationalFunction

    @cached_property
    def domain(self) -> str:
        """Where it holds, in words, beside what holds of the whole function."""
        return words.alternatives(self.where)

    @cached_property
    def expr(self) -> sympy.Expr:
        """The formula."""
        return factored(self.value)


@dataclass(frozen=True, eq=False)
class PiecewiseFunction:
    """A function of indices.

    Attributes:
        weights: the number, by straightened indices.
        points: its domain, straightened.
        straight: which indices are put in for others.
        constants: symbols that are not the paper's, and what stands for them in ``weights``.
    """

    weights: Weights
    points: sets.Set
    straight: Straightening
    constants: Mapping[sympy.Symbol, sympy.Symbol] = field(default_factory=dict)

    @classmethod
    def of(
        cls,
        expression: sympy.Expr,
        domain: Domain,
        *groups: Group,
        divisor: sympy.Expr = sympy.S.One,
    ) -> "PiecewiseFunction":
        """An expression in moments on a domain, over a number that depends on no index.

        Args:
            expression: in means, variances and covariances.
            domain: of its indices, with the load.
            groups: theorems that give quantities in the radii, put in one after the other.
            divisor: that number.

        Raises:
            NotExactError: an observable is not linear in the radii, or not determined by them.
        """
        own = names_for(expression, divisor)
        form = worked_out(expression.xreplace(own), domain, groups)
        if {*form.parts} - {NUMBER}:
            raise NotExactError("it depends on single beads")
        inverse = FIELD.one / FIELD.from_sympy(divisor.xreplace(own))
        weights = form.parts.get(NUMBER, Weights()).scaled(inverse)
        return cls(weights, domain.points, domain.straight, own)

    @cached_property
    def _names(self) -> Field:
        """The field, in which constants have their own names."""
        own = {stand_in: symbol for symbol, stand_in in self.constants.items()}
        return (
            Field(own.get(generator, generator) for generator in FIELD.generators) if own else FIELD
        )

    @cached_property
    def domain(self) -> Relations:
        """The fewest relations that say where it holds, beside what is even."""
        (relations,) = self.relations(self.points, sets.EVERYTHING)
        return relations

    @cached_property
    def pieces(self) -> tuple[Piece, ...]:
        """Its formulas, on parts of the domain that cover it and share no point."""
        pieces = []
        left = self.points
        for whole, value in self.weights.formulas():
            left = left - whole
            pieces.append(Piece(self.relations(whole), self._formula(whole, value)))
        if not left.is_empty():
            pieces.append(Piece(self.relations(left), FIELD.zero))
        return tuple(pieces)

    def part(self, *relations: sympy.Basic) -> "PiecewiseFunction":
        """The same on a part of its domain."""
        points = self.points & sets.where(*map(self.straight.relation, relations))
        return replace(self, weights=self.weights.on(points), points=points)

    def put_in(self, image: Mapping[sympy.Symbol, sympy.Expr]) -> "PiecewiseFunction":
        """The same with other numbers for symbols that are no indices."""
        values = {symbol: FIELD.from_sympy(value) for symbol, value in image.items()}
        return replace(self, weights=self.weights.mapped(lambda value: value.substitute(values)))

    def on(self, *relations: sympy.Basic) -> RationalFunction:
        """Its formula on a part of its domain where a single formula holds.

        Raises:
            NotProvedError: several formulas hold there.
        """
        pieces = self.part(*relations).pieces
        if len(pieces) != 1:
            raise NotProvedError(f"there it is not one formula, but {len(pieces)}")
        return pieces[0].value

    def total(self, index: sympy.Symbol, weight: sympy.Expr) -> Weights:
        """The sum over all values of an index, of which the number is multiplied by a weight."""
        factor = FIELD.from_sympy(weight.xreplace(self.straight.image))
        return self.weights.scaled(factor).summed(index)

    @cached_property
    def indices(self) -> set[sympy.Symbol]:
        """The indices on which it depends."""
        symbols = set().union(
            *(row.free_symbols for piece in self.pieces for part in piece.where for row in part)
        )
        return symbols | {s for piece in self.pieces for s in sy.INDICES if piece.value.holds(s)}

    def relations(self, whole: sets.Set, context: sets.Set | None = None) -> tuple[Relations, ...]:
        """Relations of indices, those of any of several parts, of a set within the domain."""
        context = self.points if context is None else context
        return tuple(
            (
                *(sympy.Eq(self._whole(form), 0, evaluate=False) for form in equations),
                *(sympy.Ge(self._whole(form), 0, evaluate=False) for form in bounds),
            )
            for equations, bounds in shortest.conditions(whole, context)
        )

    def _formula(self, whole: sets.Set, value: RationalFunction) -> RationalFunction:
        """A value in the old indices, without those that the equations of its part give."""
        value = value.substitute({s: FIELD.from_sympy(x) for s, x in self.straight.back.items()})
        equations = (sympy.Eq(self._whole(row), 0, evaluate=False) for row in sets.equations(whole))
        given = {fixed.lhs: FIELD.from_sympy(fixed.rhs) for fixed in words.equations(equations)}
        with suppress(NotExactError):  # a divisor vanishes there
            value = value.substitute(given)
        value = value.reduced()
        return RationalFunction(self._names, value.numerator, value.denominator)

    def _whole(self, form: sets.Row) -> sympy.Expr:
        """A form in the old indices, without fractions."""
        value = sympy.Add(*(n * s for s, n in form[0].items()), form[1])
        value = sympy.expand(value.xreplace(self.straight.back))
        return sympy.ilcm(1, *(n.q for n in value.as_coefficients_dict().values())) * value


# functions that are given in pieces, by Piecewise


def alternatives_of(formula: sympy.Basic) -> Iterator[tuple[sympy.Basic, Relations]]:
    """What a formula is without pieces, with relations; the first that fits counts.

    It holds nan where a function given in pieces has no value.

    Raises:
        NotAStatementError: such a function has no value anywhere.
        NotExactError: its cases depend on an index over which is summed, or averaged.
    """
    given = [node for node in nodes(formula) if isinstance(node, sympy.Piecewise)]
    if not given:
        yield formula, ()
        return
    cases = given[-1]  # what it is made of comes before it
    named = set().union(*(each.free_symbols for each in cases.atoms(Relational)))
    if bound := by_name(named & bound_in(formula)):
        raise NotExactError(f"cases depend on {text(bound[0])}, which is summed or averaged over")
    if all(condition == sympy.false for _, condition in cases.args):
        raise NotAStatementError("it has no value anywhere")
    nowhere = in_place(formula, {cases: sympy.nan})
    for value, condition in cases.args:
        inside = tuple(alternatives_of(in_place(formula, {cases: value})))
        for part in by_name(sympy.Or.make_args(sympy.to_dnf(condition))):
            relations = tuple(by_name({*sympy.And.make_args(part)} - {sympy.true}))
            for alternative, further in inside:
                yield alternative, (*relations, *further)
            if inside[0][1]:  # relations, beside which it may have no value
                yield nowhere, relations


def parts_of(candidate: sympy.Eq, function: PiecewiseFunction) -> list[tuple[sympy.Eq, sets.Set]]:
    """The formulas of a candidate that may be given in pieces, each with its part of a domain.

    Args:
        candidate: an equation.
        function: which is meant, on that domain.

    Raises:
        NotAStatementError: it has no value on some part of the domain.
        NotExactError: its cases are not read.
    """
    rest, parts = function.points, []
    for formula, relations in alternatives_of(candidate):
        here = rest & sets.where(*map(function.straight.relation, relations))
        rest = rest - here
        if not here.is_empty():
            parts.append((formula, here))
    if not rest.is_empty():
        left_out = words.alternatives(function.relations(rest))
        raise NotAStatementError(f"it has no value for {left_out}")
    return parts
