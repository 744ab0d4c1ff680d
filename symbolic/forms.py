"""Linear forms in quantities on the lattice: SymPy expressions, read into weights on sites.

A form holds a number, and for each quantity (a radius, a component of a displacement, a force) the
weights of its sites. Vectors are two forms, their components n^±·v. Products are those of dual
numbers: what is of first order in both factors is dropped.

Indices across the packing are *straightened* while forms are read: with i = j − 2i′ a bead (i, j)
is i′ steps along n⁻ and j − i′ along n⁺ from the origin, and no condition "i + j is even" is left.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from typing import Self

import sympy

from . import sets
from .algebra.bases import LINE_SUM
from .algebra.exact import FIELD, SITE, SOURCE, NotExactError, RationalFunction
from .printing.text import text
from .sets import Set
from .symbols import (
    INDICES,
    Braces,
    DeltaNMinus,
    DeltaNPlus,
    Dot,
    ForceAlong,
    ForceMinus,
    ForcePlus,
    MeanOver,
    SecondDifference,
    SiteFunction,
    VerticalMinus,
    VerticalPlus,
    e_y,
    i,
    k,
    m,
    n,
    n_y,
    p,
    q,
    site_r,
)
from .weights import Weights

NUMBER = ""
"""What the part of a form that holds no quantity is filed under."""

VERTICAL = {VerticalPlus: (ForcePlus, DeltaNPlus), VerticalMinus: (ForceMinus, DeltaNMinus)}
"""The vertical component of a contact's force: the force, and how the contact turns."""

_ACROSS = (i, k, site_r, p, q)
"""Indices that lie across the packing, or may."""

_HIGHEST = 4  # power of a quantity

Image = Mapping[sympy.Symbol, sympy.Expr]


@dataclass(frozen=True)
class Straightening:
    """Indices that are put in for others, so that forms that have to be even are.

    Attributes:
        image: what is put in: i = j − 2i for i + j, where the new i is ½(j − i).
        back: what the new indices are in terms of the old ones.
    """

    image: Image = field(default_factory=dict)
    back: Image = field(default_factory=dict)

    @classmethod
    def of(cls, even: Iterable[sympy.Expr]) -> Self:
        """For these forms.

        Raises:
            NotExactError: one of them is not even, and can't be made even.
        """
        image: dict[sympy.Symbol, sympy.Expr] = {}
        back: dict[sympy.Symbol, sympy.Expr] = {}
        for one in even:
            form = sympy.expand(one.xreplace(image))
            factors, constant = sets.row(form)
            if not any(number % 2 for number in (constant, *factors.values())):
                continue
            free = (s for s in (*_ACROSS, *INDICES) if factors.get(s) in (1, -1) and s not in image)
            symbol = next(free, None)
            if symbol is None:
                raise NotExactError(f"{text(one)} is not shown to be even")
            rest = form - factors[symbol] * symbol
            value = {symbol: rest - 2 * symbol}
            image = {s: sympy.expand(old.xreplace(value)) for s, old in image.items()} | value
            back[symbol] = sympy.expand((rest.xreplace(back) - symbol) / 2)
        return cls(image, back)

    def relation(self, relation: sympy.Basic) -> sympy.Basic:
        """A relation with new indices put in."""
        if not isinstance(relation, sympy.core.relational.Relational):
            return relation
        return relation.func(*(side.xreplace(self.image) for side in relation.args), evaluate=False)


@dataclass(frozen=True)
class Form:
    """Weights by the quantity that they are of."""

    parts: Mapping[str, Weights] = field(default_factory=dict)

    @classmethod
    def number(cls, value: RationalFunction) -> Self:
        """A number."""
        return cls({} if value.is_zero() else {NUMBER: Weights(((sets.EVERYTHING, value),))})

    def __add__(self, other: "Form") -> Self:
        found = dict(self.parts)
        for quantity, weights in other.parts.items():
            found[quantity] = found[quantity] + weights if quantity in found else weights
        return type(self)(found)

    def __sub__(self, other: "Form") -> Self:
        return self + other.scaled(FIELD.constant(-1))

    def scaled(self, factor: RationalFunction) -> Self:
        """The same, times a number."""
        return type(self)({name: weights.scaled(factor) for name, weights in self.parts.items()})

    def times(self, other: "Form") -> Self:
        """The product to first order."""
        left, right = (one.parts.get(NUMBER, Weights()) for one in (self, other))
        first = {name: weights.times(right) for name, weights in self.parts.items()}
        second = {
            name: weights.times(left) for name, weights in other.parts.items() if name != NUMBER
        }
        return type(self)(first) + type(self)(second)

    def on(self, points: Set) -> Self:
        """The same on a set of indices, and 0 elsewhere."""
        return type(self)({name: weights.on(points) for name, weights in self.parts.items()})

    def at(self, image: Image) -> Self:
        """The same at other indices."""
        return type(self)({name: weights.at(image) for name, weights in self.parts.items()})

    def summed(self, index: sympy.Symbol) -> Self:
        """Σ over all values of an index."""
        return type(self)({name: weights.summed(index) for name, weights in self.parts.items()})

    def without(self, *symbols: sympy.Symbol) -> Self:
        """The same in terms of other symbols, which give these."""
        return type(self)({name: weights.without(*symbols) for name, weights in self.parts.items()})

    def merged(self) -> Self:
        """The same in few pieces."""
        return type(self)({name: weights.merged() for name, weights in self.parts.items()})

    def is_zero(self) -> bool:
        """Whether nothing is left of it anywhere."""
        return all(weights.is_zero() for weights in self.parts.values())


Vector = tuple[Form, Form]
Value = Form | Vector


@dataclass(frozen=True)
class Known:
    """What a quantity of a bead is, by the bead's coordinates ``SOURCE``, on a set of beads."""

    points: Set
    value: tuple[Form, ...]

    def at(self, site: tuple[sympy.Expr, ...]) -> tuple[Set, tuple[Form, ...]]:
        """The same of a bead with other coordinates."""
        image = dict(zip(SOURCE, site, strict=False))
        return sets.at(self.points, image), tuple(one.at(image) for one in self.value)


@dataclass(frozen=True, eq=False)
class Reader:
    """Reads expressions on a domain.

    Attributes:
        points: the domain, straightened.
        straight: which indices are put in for others.
        known: what quantities are, by their kind; the others stay as they are.
        kind: of the forms that are read.
        linear: whether a product of two quantities that depend on the radii is refused.
    """

    points: Set
    straight: Straightening = Straightening()
    known: Mapping[type, tuple[Known, ...]] = field(default_factory=dict)
    kind: type[Form] = Form
    linear: bool = False

    def read(self, expression: sympy.Expr) -> Value:
        """A number as one form, a vector as two.

        Raises:
            NotExactError: it is neither, is not linear, or holds what is not read.
        """
        if expression in LINE_SUM.vectors:
            first, second = LINE_SUM.vectors[expression]
            return self.kind.number(first), self.kind.number(second)
        if isinstance(expression, SecondDifference):
            return self.read(expression.doit())
        if isinstance(expression, SiteFunction):
            return self._quantity(expression)
        if isinstance(expression, ForceAlong):
            return self._along(expression)
        if isinstance(expression, sympy.Add):
            return self._sum(expression.args)
        if isinstance(expression, sympy.Mul):
            return self._product(expression.args)
        if isinstance(expression, sympy.Sum):
            return self._series(expression)
        if isinstance(expression, MeanOver):
            return self._average(*expression.args)
        if isinstance(expression, sympy.Pow) and expression.has(SiteFunction):
            return self._power(*expression.args)
        if isinstance(expression, Dot):
            return self._dot(*map(self.vector, expression.args))
        if isinstance(expression, Braces):
            return self._cases(*expression.args)
        return self.kind.number(FIELD.from_sympy(expression.xreplace(self.straight.image)))

    def number(self, expression: sympy.Expr) -> Form:
        """A number as a form."""
        value = self.read(expression)
        if isinstance(value, tuple):
            raise NotExactError(f"{text(expression)} is a vector")
        return value

    def vector(self, expression: sympy.Expr) -> Vector:
        """The components of a vector; the number 0 is the zero vector."""
        value = self.read(expression)
        if isinstance(value, tuple):
            return value
        if not value.parts:
            return self.kind(), self.kind()
        raise NotExactError(f"{text(expression)} is no vector")

    def within(self, *relations: sympy.Basic) -> "Reader":
        """On the part of the domain where relations hold."""
        inside = sets.where(*map(self.straight.relation, relations))
        return replace(self, points=self.points & inside)

    def site(self, across: sympy.Expr, layer: sympy.Expr) -> tuple[sympy.Expr, sympy.Expr]:
        """The coordinates of a bead.

        Raises:
            NotExactError: no bead is there.
        """
        x, y = (sympy.expand(one.xreplace(self.straight.image)) for one in (across, layer))
        beside = sympy.expand((y - x) / 2)
        sets.row(beside)  # whole, or refused
        return sympy.expand(y - beside), beside

    def _quantity(self, quantity: SiteFunction) -> Value:
        kind, site = type(quantity), self.site(*quantity.args)
        if kind in VERTICAL:
            return self._vertical(kind, quantity)
        if kind in self.known:
            return self._known(quantity, site)
        if kind is DeltaNPlus:
            return self.kind(), self._alone(kind, "-", site)
        if kind is DeltaNMinus:
            return self._alone(kind, "+", site), self.kind()
        if quantity.is_vector:
            return self._alone(kind, "+", site), self._alone(kind, "-", site)
        return self._alone(kind, "", site)

    def _along(self, quantity: ForceAlong) -> Form:
        """A contact's force in three dimensions."""
        axis, *place = quantity.args
        if type(quantity) not in self.known or axis not in (1, 2, 3):
            raise NotExactError(f"{text(quantity)} is not known")
        site = tuple(sympy.expand(one.xreplace(self.straight.image)) for one in place)
        return self.known[type(quantity)][int(axis) - 1].at(site)[1][0]

    def _vertical(self, kind: type, quantity: SiteFunction) -> Form:
        """Force times vertical component of the contact's direction, n_y + e_y·δn."""
        force, turn = VERTICAL[kind]
        inside = replace(self, linear=False)
        tilted = inside.number(n_y + Dot(e_y, turn(*quantity.args)))
        return tilted.times(inside.number(force(*quantity.args)))

    def _alone(self, kind: type, axis: str, site: tuple[sympy.Expr, sympy.Expr]) -> Form:
        here = (sympy.Eq(one, at, evaluate=False) for one, at in zip(SITE, site, strict=False))
        return self.kind({kind.__name__ + axis: Weights.of(*here)})

    def _known(self, quantity: SiteFunction, site: tuple[sympy.Expr, sympy.Expr]) -> Value:
        left, found = self.points, (self.kind(), self.kind())
        for one in self.known[type(quantity)]:
            points, value = one.at(site)
            inside = left & points
            if not inside.is_empty():
                found = tuple(a + b.on(inside) for a, b in zip(found, value, strict=False))
                left = left - points
        if not left.is_empty():
            raise NotExactError(f"{text(quantity)} is not known on all of the domain")
        return found[0] if len(found) == 1 else found

    def _sum(self, terms: Iterable[sympy.Expr]) -> Value:
        values = [self.read(term) for term in terms]
        if not any(isinstance(value, tuple) for value in values):
            return sum(values, self.kind())
        pairs = [value if isinstance(value, tuple) else (value, value) for value in values]
        if any(pair[0] is pair[1] and pair[0].parts for pair in pairs):
            raise NotExactError("a number is added to a vector")
        return sum((pair[0] for pair in pairs), self.kind()), sum(
            (pair[1] for pair in pairs), self.kind()
        )

    def _product(self, factors: Iterable[sympy.Expr]) -> Value:
        product, vector = self.kind.number(FIELD.one), None
        for value in map(self.read, factors):
            if not isinstance(value, tuple):
                self._refuse_squares(product, value)
                product = product.times(value)
            elif vector is None:
                vector = value
            else:
                raise NotExactError("a product of two vectors")
        if vector is None:
            return product
        for component in vector:
            self._refuse_squares(component, product)
        return vector[0].times(product), vector[1].times(product)

    def _refuse_squares(self, one: Form, other: Form) -> None:
        if self.linear and all({*form.parts} - {NUMBER} for form in (one, other)):
            raise NotExactError(
                "a product of two quantities that depend on the radii is not linear"
            )

    def _dot(self, left: Vector, right: Vector) -> Form:
        total = self.kind()
        for a, one in enumerate(left):
            for b, other in enumerate(right):
                self._refuse_squares(one, other)
                total = total + one.times(other).scaled(LINE_SUM.metric[0 if a == b else 1])
        return total

    def _cases(self, *arguments: sympy.Expr) -> Form:
        first, second, index, last = arguments
        total = self.kind()
        for part, relation in ((first, sympy.Le(index, last)), (second, sympy.Gt(index, last))):
            inner = self.within(relation)
            if not inner.points.is_empty():
                total = total + inner.number(part).on(inner.points)
        return total

    def _power(self, base: sympy.Expr, exponent: sympy.Expr) -> Form:
        if not (isinstance(exponent, sympy.Integer) and 0 < exponent <= _HIGHEST):
            raise NotExactError(
                f"the power {text(exponent)} of {text(base)} is not read: 1 to {_HIGHEST} are"
            )
        power = self._product([base] * int(exponent))
        if isinstance(power, tuple):
            raise NotExactError("a power of a vector")
        return power

    def _average(self, expression: sympy.Expr, count: sympy.Expr, *indices: sympy.Symbol) -> Form:
        """Over neighbours two columns apart."""
        step = m if expression.has(MeanOver) else n
        inner = self.within(step >= 0, sympy.Le(step, count - 1, evaluate=False))
        there, back = (self._moved(indices, sign * 2 * step) for sign in (1, -1))
        wide = replace(self, points=sets.without(sets.at(inner.points, back), step))
        total = wide.number(expression).merged().at(there).on(inner.points).summed(step)
        return total.times(self.number(1 / count))

    def _moved(self, indices: Iterable[sympy.Symbol], by: sympy.Expr) -> Image:
        """Straightened indices, all of which go on by as many columns."""
        old = self.straight
        further = {one: old.back.get(one, one).xreplace({one: one + by}) for one in indices}
        return {
            index: sympy.expand(form.xreplace(dict(old.image))) for index, form in further.items()
        }

    def _series(self, series: sympy.Sum) -> Value:
        *others, (index, low, high) = series.limits
        short = self.within(sympy.Lt(high, low - 1, evaluate=False))
        if not short.points.is_empty():
            raise NotExactError(
                f"the sum over {text(index)} from {text(low)} to {text(high)} may end more than "
                "one below its start"
            )
        inner = self.within(*(
            kind(index, end, evaluate=False) for kind, end in ((sympy.Ge, low), (sympy.Le, high))
        ))  # fmt: skip
        body = sympy.Sum(series.function, *others) if others else series.function
        if inner.points.is_empty():
            return (
                self.kind()
                if not isinstance(self.read(body), tuple)
                else (self.kind(), self.kind())
            )
        value = inner.read(body)
        if isinstance(value, tuple):
            return tuple(one.on(inner.points).summed(index) for one in value)  # type: ignore
        return value.on(inner.points).summed(index)
