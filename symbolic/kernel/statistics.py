"""Statistics of what is linear in the radii: means, variances and covariances as closed forms.

The radii are independent, of mean zero and variance σ². A form Σ w(x) δr_x with an ordered value
has that value as its mean, and σ² Σ w(x)² as its variance. The weights are those that theorems give
quantities in the radii, put in one after the other. They are polynomials on sets of sites and
indices, so a moment is a polynomial on each of a few sets of indices: its closed form.
"""

from collections.abc import Iterable, Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass, field, replace
from functools import cached_property, lru_cache

import sympy

from .. import sets, spheres, words
from .. import symbols as sy
from ..algebra.exact import FIELD, SOURCE, UNKNOWNS, Domain, NotExactError, RationalFunction
from ..as_printed import equation
from ..forms import NUMBER, Form, Known, Reader, Straightening, Value
from ..notation import by_name
from ..printing.text import text
from ..second_order import RADII, SHIFT, Jet, Means, covariance
from ..weights import Weights
from .decisions import Ruling, not_a_statement, proved, refuted, undecided
from .rules import Rule
from .theorem import (
    DisprovedError,
    NotAStatementError,
    NotProvedError,
    Theorem,
    check,
    made,
)
from .where import Loading, Where

_SQUARE = FIELD.generator(sy.sigma) ** 2
_PLANE = 2


_SPHERES = "each bead rests on three others, and "
_DIRECTION = "a load along the sum of the base vectors"
_LEANS = "a load −Σ_a L^a n^a, L^2 = t_2 L^1, L^3 = t_3 L^1"
SPHERES = {
    name: Loading(name, _SPHERES + words, place)
    for name, words, place in (
        ("surface", f"each bead of the surface carries {_DIRECTION}", (sy.M,)),
        ("bulk", f"each bead above the base carries {_DIRECTION}", (sy.M,)),
        ("surface leaning", f"each bead of the surface carries {_LEANS}", (sy.M,)),
        ("bulk leaning", f"each bead above the base carries {_LEANS}", (sy.M,)),
        ("point", f"bead (0, 0, l) alone carries {_DIRECTION}", (sy.l,)),
    )
}
"""The loads on packings of spheres. What forces are in the radii is part of what is trusted."""


# what theorems say of quantities


@lru_cache(maxsize=64)
def _known(facts: tuple[Theorem, ...], kind: type[Form]) -> Mapping[type, tuple[Known, ...]]:
    """Quantities in the radii; forces by way of directions, and these of positions.

    Raises:
        NotProvedError: a theorem does not say what one quantity of a bead is.
    """
    if kind is Jet:
        return Means(_known(facts, Form)).jets()
    found: dict[type, tuple[Known, ...]] = {}
    left = list(facts)
    while left:
        open_ones = {_about(one) for one in left}
        ready = [one for one in left if not open_ones & _held(one)]
        if not ready:
            raise NotProvedError("theorems that are put in rest on one another in a circle")
        values = [(_about(one), _said(one, found)) for one in ready]
        for quantity, value in values:
            found[quantity] = (*found.get(quantity, ()), value)
        left = [one for one in left if one not in ready]
    return found


def _about(theorem: Theorem) -> type:
    return type(theorem.solved[0])


def _held(theorem: Theorem) -> set[type]:
    return {type(quantity) for quantity in theorem.solved[1].atoms(sy.SiteFunction)}


def _said(theorem: Theorem, known: Mapping[type, tuple[Known, ...]]) -> Known:
    """What a theorem says of a quantity, by the coordinates of the quantity's bead."""
    about, value = theorem.solved
    reader = Reader(sets.EVERYTHING, Straightening.of(theorem.where.even), known)
    reader = reader.within(*theorem.where.relations)
    site = zip(SOURCE, reader.site(*about.args), strict=False)
    here = sets.where(*(sympy.Eq(symbol, at, evaluate=False) for symbol, at in site))
    loading, points = theorem.where.loading, reader.points & here
    named = set().union(*(one.free_symbols for one in loading.place)) if loading else set()
    bound = [symbol for symbol in theorem.where.indices if symbol not in named]
    forms = reader.vector(value) if about.is_vector else (reader.number(value),)
    return Known(
        sets.without(points, *bound),
        tuple(form.on(points).without(*bound).merged() for form in forms),
    )


# moments


@dataclass(frozen=True, eq=False)
class Statistics(Reader):
    """Reads numbers, and moments of what is linear in the radii.

    Attributes:
        facts: the theorems that give quantities in the radii.
        spheres: the load in three dimensions.
    """

    facts: tuple[Theorem, ...] = ()
    spheres: Loading | None = None

    @classmethod
    def on(cls, where: Where, facts: Iterable[Theorem]) -> "Statistics":
        """Those on a domain.

        Raises:
            NotProvedError: a theorem is of other packings or loads.
        """
        facts = tuple(dict.fromkeys(facts))
        for one in facts:
            same = one.where.loading in (None, where.loading)
            if one.where.dimension != where.dimension or one.where.limit or not same:
                raise NotProvedError(f"{text(one.solved[0])} is known of other packings or loads")
        load = None if where.dimension == _PLANE else where.loading
        if load and load not in SPHERES.values():
            raise NotProvedError(f"forces under {load.name} are not known in three dimensions")
        empty = cls(sets.EVERYTHING, Straightening.of(where.even), facts=facts, spheres=load)
        return empty.within(*where.relations)  # type: ignore[return-value]

    def read(self, expression: sympy.Expr) -> Value:
        """A number; moments are worked out."""
        if isinstance(expression, sy.Moment):
            return Form({NUMBER: self.moment(expression)})
        return super().read(expression)

    def moment(self, moment: sy.Moment) -> Weights:
        """A moment, as a function of the indices.

        Raises:
            NotExactError: what it is of is not linear, or not given by the radii.
        """
        if isinstance(moment, sy.Shift):
            form = self.in_radii(moment.args[0], Jet)
            return form.parts.get(SHIFT, Weights()).scaled(_SQUARE)
        forms = [self.in_radii(one, Form).merged() for one in moment.args]
        if isinstance(moment, sy.Mean):
            return forms[0].parts.get(NUMBER, Weights())
        if isinstance(moment, sy.Variance | sy.Covariance):
            dimension = 3 if self.spheres else _PLANE
            return covariance(forms[0], forms[-1], dimension).scaled(_SQUARE)
        raise NotExactError(f"{text(moment)} is not worked out")

    def in_radii(self, expression: sympy.Expr, kind: type[Form] = Form) -> Form:
        """A number as an ordered value and weights of the radii.

        Raises:
            NotExactError: it is not linear in them, or holds what is not given by them.
        """
        if self.spheres and kind is not Form:
            raise NotExactError("means to second order are not known in three dimensions")
        known = spheres.known(self.spheres.name) if self.spheres else _known(self.facts, kind)
        reader = Reader(self.points, self.straight, known, kind, linear=kind is Form)
        form = reader.number(expression).on(self.points)
        if strange := {*form.parts} - {NUMBER, RADII, SHIFT}:
            raise NotExactError(f"{min(strange)} is not given by the radii")
        return form


Relations = tuple[sympy.Basic, ...]


@dataclass(frozen=True)
class Piece:
    """A formula of a closed form.

    Attributes:
        where: where it holds, as relations of indices; those of any of several parts.
        value: the formula.
    """

    where: tuple[Relations, ...]
    value: RationalFunction


def constants(expression: sympy.Expr) -> dict[sympy.Symbol, sympy.Symbol]:
    """Symbols that are not the paper's, and which unknown numbers stand for them.

    Raises:
        NotExactError: there are too many.
    """
    found = by_name(expression.free_symbols - {*FIELD.generators, *sy.VECTORS})
    spare = UNKNOWNS[1]
    if len(found) > len(spare):
        raise NotExactError(f"{len(found)} constants: up to {len(spare)} are allowed")
    return dict(zip(found, spare, strict=False))


@dataclass(frozen=True, eq=False)
class ClosedForm:
    """A number that is a function of indices: a formula on each of a few parts of its domain.

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

    def __reduce__(self) -> tuple[type["ClosedForm"], tuple[object, ...]]:
        """Relations are left out of pickles: SymPy would evaluate them."""
        return ClosedForm, (self.weights, self.points, self.straight, self.constants)

    @classmethod
    @lru_cache(maxsize=256)
    def of(
        cls,
        expression: sympy.Expr,
        where: Where,
        facts: tuple[Theorem, ...],
        values: tuple[tuple[sympy.Symbol, sympy.Rational], ...] = (),
    ) -> "ClosedForm":
        """An expression in moments on a domain.

        Args:
            expression: in means, variances and covariances.
            where: the domain.
            facts: theorems that give quantities in the radii.
            values: of parameters, of which the facts hold whatever they are.

        Raises:
            NotExactError: what it is of is not linear, or not given by the radii.
        """
        reader, own = Statistics.on(where, facts), constants(expression)
        weights = reader.number(expression.xreplace(own)).parts.get(NUMBER, Weights())
        weights = weights.having({s: FIELD.constant(n) for s, n in values})
        return cls(weights.on(reader.points), reader.points, reader.straight, own)

    @cached_property
    def _names(self) -> Domain:
        """The field, in which constants have their own names."""
        own = {stand_in: symbol for symbol, stand_in in self.constants.items()}
        return FIELD.named(own) if own else FIELD

    @cached_property
    def domain(self) -> Relations:
        """The fewest relations that say where it holds, beside what is even."""
        (found,) = self._relations(self.points, sets.EVERYTHING)
        return found

    @cached_property
    def pieces(self) -> tuple[Piece, ...]:
        """Its formulas, on parts of the domain that cover it and share no point."""
        found = []
        left = self.points
        for whole, value in self.weights.formulas():
            left = left - whole
            found.append(Piece(self._relations(whole, self.points), self._formula(whole, value)))
        if not left.is_empty():
            found.append(Piece(self._relations(left, self.points), FIELD.zero))
        return tuple(found)

    def part(self, *relations: sympy.Basic) -> "ClosedForm":
        """The same on a part of its domain."""
        points = self.points & sets.where(*map(self.straight.relation, relations))
        return replace(self, weights=self.weights.on(points), points=points)

    def put_in(self, image: Mapping[sympy.Symbol, sympy.Expr]) -> "ClosedForm":
        """The same with other numbers for symbols that are no indices."""
        values = {symbol: FIELD.from_sympy(one) for symbol, one in image.items()}
        return replace(self, weights=self.weights.having(values))

    def on(self, *relations: sympy.Basic) -> RationalFunction:
        """Its formula on a part of its domain, where it is one.

        Raises:
            NotProvedError: it is not.
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
    def weights_symbols(self) -> set[sympy.Symbol]:
        """The indices on which it depends."""
        held = set().union(*(one.free_symbols for piece in self.pieces
                             for part in piece.where for one in part))  # fmt: skip
        return held | {s for s in sy.INDICES if any(piece.value.holds(s) for piece in self.pieces)}

    def _relations(self, whole: sets.Set, context: sets.Set) -> tuple[Relations, ...]:
        return tuple(
            (
                *(sympy.Eq(self._whole(form), 0, evaluate=False) for form in equations),
                *(sympy.Ge(self._whole(form), 0, evaluate=False) for form in bounds),
            )
            for equations, bounds in sets.conditions(whole, context)
        )

    def _formula(self, whole: sets.Set, value: RationalFunction) -> RationalFunction:
        """A value in the old indices, without those that the equations of its part give."""
        value = value.substitute({s: FIELD.from_sympy(x) for s, x in self.straight.back.items()})
        held = (sympy.Eq(self._whole(form), 0, evaluate=False) for form in sets.equations(whole))
        given = {one.lhs: FIELD.from_sympy(one.rhs) for one in words.equations(held)}
        with suppress(NotExactError):  # a divisor vanishes there
            value = value.substitute(given)
        return value.reduced().named(self._names)

    def _whole(self, form: sets.Row) -> sympy.Expr:
        """A form in the old indices, without fractions."""
        value = sympy.Add(*(n * s for s, n in form[0].items()), form[1])
        value = sympy.expand(value.xreplace(self.straight.back))
        return sympy.ilcm(1, *(n.q for n in value.as_coefficients_dict().values())) * value


def theorems(quantity: sympy.Expr, where: Where, facts: tuple[Theorem, ...]) -> tuple[Theorem, ...]:
    """What the closed form of a quantity says: a theorem for each part of its domain."""
    return tuple(
        made(equation(quantity, piece.value.to_sympy()), where.also(*part), "moment on sets", facts)
        for piece in ClosedForm.of(quantity, where, facts, ()).pieces
        for part in piece.where
    )


def worked_out(formula: sympy.Eq, where: Where, facts: Iterable[Theorem]) -> sympy.Eq:
    """An equation with moments in closed form, each as on the largest part of the domain."""
    facts = tuple(facts)
    image = {
        one: ClosedForm.of(one, where, facts).pieces[0].value.to_sympy()
        for one in by_name(formula.atoms(sy.Moment))
    }
    return equation(*(side.xreplace(image) for side in formula.args))


def decide(form: ClosedForm, where: Where, candidate: sympy.Expr) -> Ruling:
    """Rule on a candidate for a closed form: whether it is the same on all of the domain."""
    where, left, difference = where.loaded(None), form.points, form.weights
    try:
        for value, part in _parts(candidate):
            domain = where.also(*part)
            if domain.is_empty:
                continue
            check(equation(value, value), domain)
            reader = Statistics.on(domain, ())
            read = reader.number(value.xreplace(form.constants))
            if strange := {*read.parts} - {NUMBER}:
                return undecided(f"it holds {min(strange)}, which belongs to single beads")
            difference = difference - read.parts.get(NUMBER, Weights()).on(left & reader.points)
            left = left - reader.points
        if not left.is_empty():
            return not_a_statement(f"it has no value at {_point(form, left)}")
        differences = difference.on(form.points).formulas()
    except NotAStatementError as reason:
        return not_a_statement(str(reason))
    except (NotExactError, NotProvedError, ZeroDivisionError) as reason:
        return undecided(str(reason))
    if not differences:
        return proved("the same on all of the domain")
    return refuted(_shown(form, *differences[0]))


def _parts(candidate: sympy.Expr) -> Iterator[tuple[sympy.Expr, Relations]]:
    """The formulas of a function that is given in pieces, with relations; the first that fits."""
    height = {sy.z: sy.j / sy.M}
    if not isinstance(candidate, sympy.Piecewise):
        yield candidate.xreplace(height), ()
        return
    for value, condition in candidate.args:
        plain = sympy.to_dnf(condition)
        either = plain.args if isinstance(plain, sympy.Or) else (plain,)
        for part in either:
            both = part.args if isinstance(part, sympy.And) else (part,)
            yield value.xreplace(height), tuple(one for one in both if one != sympy.true)


def _shown(form: ClosedForm, points: sets.Set, difference: RationalFunction) -> str:
    """A point at which a closed form differs from what was said of it."""
    at = sets.sample(sets.parts(points)[0])
    whole = {symbol: FIELD.constant(at[symbol]) for symbol in at if difference.holds(symbol)}
    value = text(difference.substitute(whole).named(form._names).to_sympy())
    return f"at {_point(form, points)} the true value less this one is {value}"


def _point(form: ClosedForm, points: sets.Set) -> str:
    """A point of a set, in words."""
    at = sets.sample(sets.parts(points)[0])
    indices = {symbol: old.xreplace({s: sympy.Integer(n) for s, n in at.items()})
               for symbol, old in form.straight.image.items()}  # fmt: skip
    held = form.weights_symbols
    values = {s: indices.get(s, at[s]) for s in sy.INDICES if s in held}
    return ", ".join(f"{text(one)} = {value}" for one, value in values.items()) or "every point"


def moment(*facts: Theorem) -> Rule:
    """Both sides are the same on all of the domain, moments worked out."""

    def rule(formula: sympy.Eq, where: Where) -> Theorem:
        check(formula, where)
        try:
            reader = Statistics.on(where, facts)
            left, right = map(reader.number, formula.args)
        except NotExactError as reason:
            raise NotProvedError(str(reason)) from None
        difference = (left - right).on(reader.points)
        if difference.is_zero():
            return made(formula, where, "moment", facts)
        rest = difference.parts.get(NUMBER, Weights())
        if rest.is_zero():
            raise NotProvedError("both sides hold different weights of single beads")
        form = ClosedForm(rest, reader.points, reader.straight)
        raise DisprovedError(_shown(form, *rest.formulas()[0]))

    return rule
