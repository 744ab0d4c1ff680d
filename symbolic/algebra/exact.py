"""The exact domain: rational functions over ℚ, in which zero is decided and never guessed.

Polynomials are python-flint's ``fmpq_mpoly``; a quotient of two in lowest terms is all that is
added here. The direction cosines obey n_x² + n_y² = 1 and φ = n_y² − n_x²: squares of them are
written by φ before the numerator is compared with zero.
"""

from collections.abc import Iterable, Mapping, Sequence
from fractions import Fraction
from functools import cache, lru_cache
from math import comb, prod
from typing import Any, Self

import sympy
from flint import Ordering, fmpq, fmpq_mpoly_ctx

from ..printing.text import text
from ..symbols import H_M, INDICES, PARAMETERS, M, n_x, n_y, phi

Polynomial = Any  # flint's fmpq_mpoly, which ships no types


class NotProvedError(ValueError):
    """A rule doesn't prove a statement; the message says why."""


class NotExactError(NotProvedError):
    """An expression is outside the domain in which equality can be decided."""


class NotAStatementError(NotExactError):
    """What is written has no value, or no single one, somewhere on its domain."""


SITE = tuple(sympy.Dummy(f"site_{axis}", integer=True) for axis in (1, 2, 3))
"""A site: how many steps along each base vector lead to it from the origin."""
SOURCE = tuple(sympy.Dummy(f"source_{axis}", integer=True) for axis in (1, 2, 3))
"""Another one, over which is summed."""


class Field:
    """A field ℚ(generators) and the way into it from SymPy.

    Args:
        generators: SymPy symbols, or applied functions that stand for unknowns.
    """

    def __init__(self, generators: Iterable[sympy.Expr]):
        self.generators = tuple(generators)
        names = tuple(f"g{number}" for number in range(len(self.generators)))
        self.context = fmpq_mpoly_ctx.get(names, Ordering.lex)
        self.position = {g: number for number, g in enumerate(self.generators)}
        self._gens = self.context.gens()
        self._elements = [*map(self.polynomial, self._gens)]
        self.zero = self.constant(0)
        self.one = self.constant(1)

    def constant(self, value: int | Fraction | sympy.Rational | fmpq) -> "RationalFunction":
        """A rational number as an element of the field."""
        if not isinstance(value, fmpq):
            value = fmpq(int(value.numerator), int(value.denominator))
        return self.polynomial(self.context.constant(value))

    def polynomial(self, value: Polynomial) -> "RationalFunction":
        """A polynomial as an element of the field."""
        return RationalFunction(self, value, self.context.constant(1))

    def generator(self, symbol: sympy.Expr) -> "RationalFunction":
        """The generator that stands for ``symbol``."""
        try:
            return self._elements[self.position[symbol]]
        except KeyError:
            raise NotExactError(f"{symbol} is not a symbol of the exact domain") from None

    def from_sympy(self, expression: sympy.Expr) -> "RationalFunction":
        """Read a SymPy expression made of +, ·, integer powers, rationals and generators.

        Raises:
            NotExactError: for anything else, floats included.
            NotAStatementError: it is infinite, or no number.
        """
        return _read(self, expression)

    def expanded(self, polynomial: Polynomial) -> sympy.Expr:
        """A polynomial as a SymPy sum."""
        return sympy.Add(
            *(
                sympy.Mul(
                    sympy.Rational(int(c.p), int(c.q)),
                    *(g ** int(e) for g, e in zip(self.generators, x, strict=True) if e),
                )
                for x, c in polynomial.to_dict().items()
            )
        )

    def coefficients(
        self, polynomial: Polynomial, symbols: Iterable[sympy.Expr]
    ) -> dict[tuple[int, ...], Polynomial]:
        """The coefficients of the powers of some generators."""
        parts: dict[tuple[int, ...], Polynomial] = {(): polynomial}
        for place in map(self.position.__getitem__, symbols):
            by_powers: dict[tuple[int, ...], Polynomial] = {}
            for powers, part in parts.items():
                rest, power = part, 0
                while rest != 0:
                    constant = rest.subs({place: 0})
                    if constant != 0:
                        by_powers[(*powers, power)] = constant
                    rest, power = (rest - constant) / self._gens[place], power + 1
            parts = by_powers
        return parts

    def total(self, values: Iterable["RationalFunction"]) -> "RationalFunction":
        """The sum of elements; what has one denominator is brought to lowest terms once."""
        sums: list[list[Polynomial]] = []  # numerators and denominators; flint's have no hash
        for value in values:
            same = next((part for part in sums if part[1] == value.denominator), None)
            if same is None:
                sums.append([value.numerator, value.denominator])
            else:
                same[0] = same[0] + value.numerator
        return sum((RationalFunction(self, *part) for part in sums), self.zero)


@lru_cache(maxsize=4096, typed=True)
def _read(field: Field, expression: sympy.Expr) -> "RationalFunction":
    if expression in field.position:
        return field.generator(expression)
    if isinstance(expression, sympy.Rational):
        return field.constant(expression)
    if isinstance(expression, sympy.Add):
        return sum((_read(field, term) for term in expression.args), field.zero)
    if isinstance(expression, sympy.Mul):
        return prod((_read(field, factor) for factor in expression.args), start=field.one)
    if isinstance(expression, sympy.Pow) and isinstance(expression.exp, sympy.Integer):
        return _read(field, expression.base) ** int(expression.exp)
    raise _not_exact(expression)


_MOST_TERMS = 20_000
"""Of a polynomial that is multiplied out: fifty times what any equation takes."""


def _not_exact(expression: sympy.Expr) -> NotExactError:
    """Why an expression is no rational function."""
    if expression.has(*_NO_NUMBERS):
        return NotAStatementError(f"{text(expression)} is not a number")
    if decimals := sorted(map(float, expression.atoms(sympy.Float))):
        return NotExactError(
            f"it holds the decimal {decimals[0]!r}: write exact numbers, such as Rational(3, 2) "
            "for 1.5"
        )
    return NotExactError(f"{text(expression)} is not a rational function of the symbols")


_NO_NUMBERS = sympy.oo, -sympy.oo, sympy.zoo, sympy.nan


def _product(first: Polynomial, other: Polynomial) -> Polynomial:
    """The product, unless it may have too many terms.

    Raises:
        NotExactError: it may.
    """
    number = len(first) * len(other)
    if number > _MOST_TERMS:
        degrees = zip(first.degrees(), other.degrees(), strict=True)
        _refuse_more_terms(min(number, prod(int(a + b) + 1 for a, b in degrees)))
    return first * other


def _power(base: Polynomial, exponent: int) -> Polynomial:
    """The same of a power."""
    number = comb(max(len(base) + exponent - 1, 0), exponent)
    if number > _MOST_TERMS:
        degrees = (exponent * max(int(degree), 0) + 1 for degree in base.degrees())
        _refuse_more_terms(min(number, prod(degrees)))
    return base**exponent


def _refuse_more_terms(number: int) -> None:
    if number > _MOST_TERMS:
        raise NotExactError(f"multiplied out, it may have more than {_MOST_TERMS} terms")


class RationalFunction:
    """An element of a :class:`Field` in lowest terms."""

    __slots__ = ("_degrees", "denominator", "domain", "numerator")

    def __init__(self, domain: Field, numerator: Polynomial, denominator: Polynomial):
        self.domain = domain
        self._degrees: tuple[Sequence[int], Sequence[int]] | None = None
        if not denominator.is_one():
            common = numerator.gcd(denominator)
            if common != 1:
                numerator, denominator = numerator / common, denominator / common
            lead = denominator.leading_coefficient()
            if lead != 1:
                numerator, denominator = numerator / lead, denominator / lead
        self.numerator = numerator
        self.denominator = denominator

    def _same(self, numerator: Polynomial, denominator: Polynomial) -> Self:
        return type(self)(self.domain, numerator, denominator)

    def __add__(self, other: Self) -> Self:
        if self.numerator == 0:
            return other
        if other.numerator == 0:
            return self
        if self.denominator == other.denominator:
            return self._same(self.numerator + other.numerator, self.denominator)
        common = self.denominator.gcd(other.denominator)
        own, theirs = self.denominator / common, other.denominator / common
        return self._same(
            _product(self.numerator, theirs) + _product(other.numerator, own),
            _product(self.denominator, theirs),
        )

    def __eq__(self, other: object) -> bool:
        return isinstance(other, RationalFunction) and (
            self.numerator == other.numerator and self.denominator == other.denominator
        )

    __hash__ = None  # type: ignore[assignment]

    def __neg__(self) -> Self:
        negative = object.__new__(type(self))  # in lowest terms already
        negative.domain, negative.denominator = self.domain, self.denominator
        negative.numerator, negative._degrees = -self.numerator, self._degrees
        return negative

    def __sub__(self, other: Self) -> Self:
        return self + (-other)

    def __mul__(self, other: Self) -> Self:
        for first, scale in ((self, other), (other, self)):
            if scale.numerator == 1 and scale.denominator == 1:
                return first
        return self._same(
            _product(self.numerator, other.numerator),
            _product(self.denominator, other.denominator),
        )

    def __truediv__(self, other: Self) -> Self:
        if other.is_zero():
            raise NotExactError("division by zero")
        return self._same(
            _product(self.numerator, other.denominator),
            _product(self.denominator, other.numerator),
        )

    def __pow__(self, exponent: int) -> Self:
        if exponent < 0:
            return (self._same(self.denominator, self.denominator) / self) ** -exponent
        return self._same(_power(self.numerator, exponent), _power(self.denominator, exponent))

    def is_zero(self) -> bool:
        """Decide whether this is zero, given n_x² + n_y² = 1."""
        if len(self.numerator) <= 1:  # a single term is not zero
            return len(self.numerator) == 0
        degrees = self.numerator.degrees()
        if all(degrees[self.domain.position[component]] < 2 for component in (n_x, n_y)):
            return False  # 1, n_x, n_y and n_x n_y are independent over the functions of φ
        return bool(self._on_circle(self.numerator) == 0)

    def reduced(self) -> "RationalFunction":
        """The same element with n_x and n_y at most to the first power, as functions of φ.

        1, n_x, n_y and n_x n_y are independent over the functions of φ: what this leaves in the
        numerator is unique.
        """
        if not (self.holds(n_x) or self.holds(n_y)):
            return self
        return RationalFunction(
            self.domain, self._on_circle(self.numerator), self._on_circle(self.denominator)
        )

    def _on_circle(self, polynomial: Polynomial) -> Polynomial:
        unit, cosine = self.domain.context.constant(1), self.domain.generator(phi).numerator
        squares = {n_x: (unit - cosine) / 2, n_y: (unit + cosine) / 2}
        total = self.domain.context.constant(0)
        for powers, part in self.domain.coefficients(polynomial, squares).items():
            scale = unit
            for (symbol, square), power in zip(squares.items(), powers, strict=True):
                odd = self.domain.generator(symbol).numerator ** (power % 2)
                scale = scale * odd * square ** (power // 2)
            total += part * scale
        return total

    def holds(self, symbol: sympy.Expr) -> bool:
        """Whether a generator occurs."""
        place = self.domain.position[symbol]
        if self._degrees is None:
            self._degrees = self.numerator.degrees(), self.denominator.degrees()
        # of the zero polynomial every degree is −1
        return self._degrees[0][place] > 0 or self._degrees[1][place] > 0

    def degree(self, symbol: sympy.Expr) -> int:
        """Degree in ``symbol``, which the denominator must not hold."""
        position = self.domain.position[symbol]
        if self.denominator.degrees()[position]:
            raise NotExactError(f"{symbol} is in a denominator")
        return int(self.numerator.degrees()[position])

    def substitute(self, images: Mapping[sympy.Expr, "RationalFunction"]) -> "RationalFunction":
        """Replace generators by elements.

        Raises:
            NotExactError: a divisor vanishes.
        """
        if not any(self.holds(symbol) for symbol in images):
            return self
        if any(image.denominator != 1 for image in images.values()):
            return self._put_in(self.numerator, images) / self._put_in(self.denominator, images)
        full = list(self.domain._gens)
        for symbol, image in images.items():
            full[self.domain.position[symbol]] = image.numerator
        degrees = self.denominator.degrees()
        divided = any(degrees[self.domain.position[symbol]] > 0 for symbol in images)
        denominator = self.denominator.compose(*full) if divided else self.denominator
        if denominator == 0:
            raise NotExactError("a divisor is zero for one of the values")
        return self._same(self.numerator.compose(*full), denominator)

    def _put_in(
        self, polynomial: Polynomial, images: Mapping[sympy.Expr, "RationalFunction"]
    ) -> "RationalFunction":
        total = self.domain.zero
        for powers, part in self.domain.coefficients(polynomial, images).items():
            term = self.domain.polynomial(part)
            for image, power in zip(images.values(), powers, strict=True):
                term = term * image**power
            total = total + term
        return total

    def coefficients(self, symbol: sympy.Expr) -> list["RationalFunction"]:
        """Coefficients of powers 0, 1, … of ``symbol``."""
        parts = [self.domain.zero] * (self.degree(symbol) + 1)
        for (power,), part in self.domain.coefficients(self.numerator, [symbol]).items():
            parts[power] = self._same(part, self.denominator)
        return parts

    def to_sympy(self) -> sympy.Expr:
        """The same element as a SymPy quotient, multiplied out."""
        above = self.domain.expanded(self.numerator)
        return (
            above if self.denominator.is_one() else above / self.domain.expanded(self.denominator)
        )


def antidifference(f: RationalFunction, symbol: sympy.Expr) -> RationalFunction:
    """F with F(n) − F(n−1) = f(n) and F(0) = 0, for f polynomial in ``symbol``."""
    f.degree(symbol)  # it is not in the denominator
    total = f.domain.zero.numerator
    for (power,), part in f.domain.coefficients(f.numerator, [symbol]).items():
        total = total + part * _antidifference_of_power(f.domain, symbol, power).numerator
    return RationalFunction(f.domain, total, f.denominator)


@cache
def _antidifference_of_power(domain: Field, symbol: sympy.Expr, power: int) -> RationalFunction:
    """The same for f(n) = n^power.

    n^(k+1)/(k+1) has the difference n^k + lower powers, which are taken off in turn. The defining
    equation is checked, so the result is its own telescoping certificate.
    """
    n = domain.generator(symbol)
    before = {symbol: n - domain.one}
    first = n ** (power + 1) / domain.constant(power + 1)
    rest = first - first.substitute(before) - n**power
    total = first - antidifference(rest, symbol) if power else first
    if (total - total.substitute(before) - n**power).numerator != 0:  # pragma: no cover
        raise AssertionError("the telescoping certificate fails")
    return total


def sum_polynomial(
    f: RationalFunction, symbol: sympy.Expr, low: RationalFunction, high: RationalFunction
) -> RationalFunction:
    """Σ f(n) for low ≤ n ≤ high; zero when high = low − 1, Karr's convention below that."""
    if not f.holds(symbol):
        return f * (high - low + f.domain.one)
    total = antidifference(f, symbol)
    return total.substitute({symbol: high}) - total.substitute({symbol: low - f.domain.one})


def sum_over(
    f: RationalFunction, symbol: sympy.Expr, low: RationalFunction, high: RationalFunction
) -> RationalFunction:
    """Σ f(n) for low ≤ n ≤ high, where f may hold one divisor ±n + …, positive from low to high.

    The sum of its inverse is a difference of harmonic numbers, which end at a number or near M.

    Raises:
        NotExactError: the sum is of another kind.
    """
    place = f.domain.position[symbol]
    if not f.denominator.degrees()[place]:
        return sum_polynomial(f, symbol, low, high)
    divisors = [(d, e) for d, e in f.denominator.factor()[1] if d.degrees()[place] > 0]
    divisor = f.domain.polynomial(divisors[0][0])
    if divisor.coefficients(M)[-1] == -f.domain.one:  # M − n, not n − M
        divisor = -divisor
    rest, slope = divisor.coefficients(symbol) if divisor.degree(symbol) == 1 else (f, f)
    if len(divisors) > 1 or divisors[0][1] > 1 or slope * slope != f.domain.one:
        raise NotExactError(f"a sum over {symbol} has more than one divisor, or another one")
    above = f * divisor
    residue = above.substitute({symbol: -rest * slope})
    polynomial = (above - residue) / divisor
    first, last = (low, high) if slope == f.domain.one else (high, low)
    ends = [divisor.substitute({symbol: end}) for end in (first, last)]
    harmonic = _harmonic(ends[1]) - _harmonic(ends[0] - f.domain.one)
    return sum_polynomial(polynomial, symbol, low, high) + residue * harmonic


def _harmonic(last: RationalFunction) -> RationalFunction:
    """Σ 1/k for 1 ≤ k ≤ last, a number or near M."""
    field = last.domain
    total = field.generator(H_M) if last.holds(M) else field.zero
    offset = (last - field.generator(M) if last.holds(M) else last).numerator
    if not offset.is_constant() or abs(offset.leading_coefficient()) > _NEAR:
        raise NotExactError("a harmonic sum ends neither at a number nor near M")
    number = int(offset.leading_coefficient())
    if last.holds(M):
        between = range(min(number, 0), max(number, 0))
        steps = [field.generator(M) + field.constant(k) for k in between]
        inverse = [field.one / (step + field.one) for step in steps]
        return sum(inverse, total) if number > 0 else total - sum(inverse, field.zero)
    if number < 0:
        raise NotExactError("a harmonic sum starts below 1")
    return field.constant(sum((Fraction(1, k) for k in range(1, number + 1)), Fraction(0)))


_NEAR = 8


CONSTANTS = (
    tuple(sympy.Dummy(f"positive_{place}", positive=True) for place in range(6)),
    tuple(sympy.Dummy(f"real_{place}", real=True) for place in range(6)),
)
"""What stands for symbols of a user's own: positive ones, and any."""
UNKNOWNS = tuple(sympy.Dummy(f"unknown_{place}", real=True) for place in range(4))
"""What equations are solved for."""

FIELD = Field((*SITE, *SOURCE, *INDICES, *PARAMETERS, H_M, *UNKNOWNS, *CONSTANTS[0], *CONSTANTS[1]))
"""The field of all the paper's symbols, and of some more."""
