"""From a SymPy expression to its normal form: the only way in, whatever is to be proved."""

from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Protocol

import sympy

from ..printing.text import text
from ..symbols import (
    INDICES,
    Braces,
    DeltaNMinus,
    DeltaNPlus,
    Dot,
    MatrixTimes,
    SecondDifference,
    SiteFunction,
)
from . import affine
from .affine import Affine
from .bases import LINE_SUM, Basis
from .exact import FIELD, NotExactError, RationalFunction
from .linear_forms import LinearForm

Vector = tuple[LinearForm, LinearForm]


class Bounds(Protocol):
    """A domain of indices, in which bounds of sums are compared and divisors looked at."""

    def nonnegative(self, value: Affine) -> bool:
        """Whether value ≥ 0 everywhere."""

    def below(self, left: Affine, right: Affine) -> bool:
        """Whether left < right everywhere."""

    def never_zero(self, expression: sympy.Expr) -> bool:
        """Whether an expression is shown to vanish nowhere."""

    def within(self, index: sympy.Symbol, low: sympy.Expr, high: sympy.Expr) -> "Bounds":
        """The same for the terms of a sum."""


class UnsafeDivisorError(NotExactError):
    """A divisor is not shown to be different from zero everywhere in the region."""


class UnsafeBoundsError(NotExactError):
    """A sum's bounds are not shown to be in order everywhere in the region."""


@dataclass(frozen=True)
class Reader:
    """Reads linear SymPy expressions; vectors become pairs of components in a basis.

    δn^± are unit-vector changes, so that n^±·δn^± = 0 (Eqs. 4 and 5) and each is one number,
    its component along the other direction.

    Attributes:
        region: where every sum must satisfy low ≤ high + 1; None reads formally (Karr).
        basis: components of vectors.
        first_order: whether products of two lattice quantities are of second order, and dropped;
            where they are not, they are outside of what is read.
    """

    region: Bounds | None
    basis: Basis = LINE_SUM
    first_order: bool = False

    def scalar(self, expression: sympy.Expr) -> LinearForm:
        """Read a scalar.

        Raises:
            NotExactError: when the expression is not linear, or not in the decided class.
        """
        value = self.read(expression)
        if isinstance(value, tuple):
            if all(component.is_zero() for component in value):
                return LinearForm()
            raise NotExactError(f"{expression} is a vector")
        return value

    def vector(self, expression: sympy.Expr) -> Vector:
        """Read a vector; the number 0 is the zero vector."""
        value = self.read(expression)
        if isinstance(value, tuple):
            return value
        if value.is_zero():
            return LinearForm(), LinearForm()
        raise NotExactError(f"{expression} is no vector")

    def read(self, expression: sympy.Expr) -> LinearForm | Vector:
        """Read a scalar or a vector; what was read lately is remembered, and never changed."""
        return read_with(self, expression)

    def _read_anew(self, expression: sympy.Expr) -> LinearForm | Vector:
        if expression in self.basis.vectors:
            first, second = self.basis.vectors[expression]
            return LinearForm.constant(first), LinearForm.constant(second)
        if isinstance(expression, SecondDifference):
            return self.read(expression.doit())
        if isinstance(expression, SiteFunction):
            return self._atom(expression)
        if isinstance(expression, sympy.Add):
            return self._sum_of(expression.args)
        if isinstance(expression, sympy.Mul):
            return self._product(expression.args)
        if isinstance(expression, sympy.Sum):
            return self._series(expression)
        if isinstance(expression, Dot):
            return self._dot(*expression.args)
        if isinstance(expression, MatrixTimes):
            return self._matrix(*expression.args)
        if isinstance(expression, sympy.Pow) and expression.atoms(SiteFunction):
            return self._power(*expression.args)
        return LinearForm.constant(self._coefficient(expression))

    def _power(self, base: sympy.Expr, exponent: sympy.Expr) -> LinearForm:
        if not (isinstance(exponent, sympy.Integer) and 0 < exponent <= 4):
            raise NotExactError(f"the power {exponent} of a lattice quantity is not read")
        product = one = self.scalar(base)
        for _ in range(int(exponent) - 1):
            product = self._times(product, one)
        return product

    def _coefficient(self, expression: sympy.Expr) -> RationalFunction:
        if self.region is not None:
            for power in expression.atoms(sympy.Pow):
                if power.exp.is_negative and not self.region.never_zero(power.base):
                    raise UnsafeDivisorError(f"{text(power.base)} may vanish")
        return FIELD.from_sympy(expression)

    def _atom(self, atom: SiteFunction) -> LinearForm | Vector:
        i, j = (affine.from_sympy(index) for index in atom.args)
        family = type(atom).__name__
        if not atom.is_vector:
            return LinearForm.at(family, i, j)
        if isinstance(atom, DeltaNPlus | DeltaNMinus):
            if self.basis is not LINE_SUM:
                raise NotExactError("contact directions are read in line-sum components")
            other = LinearForm.at(family, i, j)
            zero = LinearForm()
            return (zero, other) if isinstance(atom, DeltaNPlus) else (other, zero)
        first, second = (LinearForm.at(family + axis, i, j) for axis in self.basis.axes)
        return first, second

    def _sum_of(self, terms: tuple[sympy.Expr, ...]) -> LinearForm | Vector:
        values = [self.read(term) for term in terms]
        if any(isinstance(value, tuple) for value in values):
            total: Vector = (LinearForm(), LinearForm())
            for value, term in zip(values, terms, strict=True):
                if not isinstance(value, tuple):
                    if value.is_zero():
                        continue  # the number 0 stands for the zero vector as well
                    raise NotExactError(f"{term} is a number, added to a vector")
                total = (total[0] + value[0], total[1] + value[1])
            return total
        result = LinearForm()
        for value in values:
            assert isinstance(value, LinearForm)
            result = result + value
        return result

    def _product(self, factors: tuple[sympy.Expr, ...]) -> LinearForm | Vector:
        scale = FIELD.one
        linear: LinearForm | None = None
        vector: Vector | None = None
        for factor in factors:
            value = self.read(factor)
            if isinstance(value, tuple):
                if vector is not None:
                    raise NotExactError("a product of two vectors")
                vector = value
                continue
            constant = value.constant_part()
            if constant is not None:
                scale = scale * constant
            else:
                linear = value if linear is None else self._times(linear, value)
        if vector is None:
            return LinearForm.constant(scale) if linear is None else linear.scaled(scale)
        if linear is None:
            return vector[0].scaled(scale), vector[1].scaled(scale)
        first, second = (self._times(component, linear.scaled(scale)) for component in vector)
        return first, second

    def _times(self, left: LinearForm, right: LinearForm) -> LinearForm:
        if self.first_order:
            return left.times(right)
        for one, other in ((left, right), (right, left)):
            constant = one.constant_part()
            if constant is not None:
                return other.scaled(constant)
        raise NotExactError("a product of two lattice quantities")

    def _dot(self, u: sympy.Expr, v: sympy.Expr) -> LinearForm:
        left, right = self.vector(u), self.vector(v)
        diagonal, mixed = self.basis.metric
        total = LinearForm()
        for a, one in enumerate(left):
            for b, other in enumerate(right):
                weight = diagonal if a == b else mixed
                if not weight.is_zero():
                    total = total + self._times(one, other).scaled(weight)
        return total

    def _matrix(self, *entries: sympy.Expr) -> Vector:
        if self.basis is LINE_SUM:
            raise NotExactError("a matrix acts on Cartesian components")
        a, b, c, d = (self._coefficient(entry) for entry in entries[:4])
        x, y = self.vector(entries[4])
        return x.scaled(a) + y.scaled(b), x.scaled(c) + y.scaled(d)

    def _series(self, series: sympy.Sum) -> LinearForm | Vector:
        index, low, high = series.limits[-1]
        if index not in INDICES:
            raise NotExactError(f"{index} is no index of the exact domain")
        inner_limits = series.limits[:-1]
        body = sympy.Sum(series.function, *inner_limits) if inner_limits else series.function
        bounds = affine.from_sympy(low), affine.from_sympy(high)
        if body.has(Braces):
            total = LinearForm()
            for part, first, last in split_by_cases(body, index, *bounds, self.region):
                inner = self._within(index, affine.to_sympy(first), affine.to_sympy(last))
                total = total + self._summed(inner.scalar(part), index, first, last)
            return total
        value = self._within(index, low, high).read(body)
        if isinstance(value, tuple):
            one, other = (self._summed(part, index, *bounds) for part in value)
            return one, other
        return self._summed(value, index, *bounds)

    def _within(self, index: sympy.Symbol, low: sympy.Expr, high: sympy.Expr) -> "Reader":
        if self.region is None:
            return self
        return replace(self, region=self.region.within(index, low, high))

    def _summed(
        self, form: LinearForm, index: sympy.Symbol, low: Affine, high: Affine
    ) -> LinearForm:
        if self.region is not None:
            length = affine.shifted(affine.add(high, low, -1), 1)
            if not self.region.nonnegative(length):
                raise UnsafeBoundsError(
                    f"the sum over {index} from {affine.to_sympy(low)} to "
                    f"{affine.to_sympy(high)} is not shown to be in order for {self.region}"
                )
        return form.summed(index, low, high)


# Changed equations share most of their terms.
read_with = lru_cache(maxsize=10_000)(Reader._read_anew)


def split_by_cases(
    body: sympy.Expr, index: sympy.Symbol, low: Affine, high: Affine, region: Bounds | None = None
) -> list[tuple[sympy.Expr, Affine, Affine]]:
    """Split Σ over braces {a : index ≤ e; b : index > e} into one sum for each case.

    In a region e may lie beside the sum, which then has one case.
    """
    found = body.atoms(Braces)
    if len(found) != 1:
        raise NotExactError("more than one pair of braces in a sum")
    (braces,) = found
    first, second, braced_index, last = braces.args
    if braced_index != index:
        raise NotExactError(f"braces over {braced_index} in a sum over {index}")
    last_of_first = affine.from_sympy(last)
    if region is not None:
        if region.nonnegative(affine.add(last_of_first, high, -1)):
            return [(body.xreplace({braces: first}), low, high)]
        if region.below(last_of_first, low):
            return [(body.xreplace({braces: second}), low, high)]
    return [
        (body.xreplace({braces: first}), low, last_of_first),
        (body.xreplace({braces: second}), affine.shifted(last_of_first, 1), high),
    ]
