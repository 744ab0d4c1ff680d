"""What LaTeX and plain text share: the order of terms, signs, fractions and brackets.

SymPy's own printers rebuild products while they look for signs and denominators, which loses
the paper's order of factors. Here the structure is read as it stands: an expression that was
built with ``evaluate=False`` is printed as it was built, and one in SymPy's canonical order,
which says nothing, is put into a readable order.
"""

from abc import abstractmethod
from collections.abc import Mapping, Sequence
from functools import cache, lru_cache
from typing import Any

import sympy
from flint import Ordering, fmpz_mpoly_ctx
from sympy import Add, Basic, Expr, Integer, Mul, Pow, Rational, Sum, Symbol
from sympy.printing.printer import Printer

from .. import symbols as sy


@cache
def rebuilt(expr: Basic) -> Basic:
    """An expression in SymPy's own order, whatever order it was built in; sums stay sums."""
    return expr.func(*map(rebuilt, expr.args)) if expr.args else expr


@cache
def in_order(expr: Expr) -> Sequence[Expr]:
    """The terms of a sum, or the factors of a product, as a reader should meet them."""
    args = list(expr.args)
    if rebuilt(expr) != expr:
        return args  # built on purpose in this order
    if isinstance(expr, Mul):
        return sorted(args, key=_factor_key)
    if not expr.has(sy.SiteFunction):
        args = list(_by_degree(expr))
    return positive_first(args)


_MANY = 4  # terms of a polynomial that is put in order


def _by_degree(expr: Expr) -> tuple[Expr, ...]:
    """The terms of a polynomial in indices: the highest degree first, each part factored."""
    terms = expr.as_ordered_terms()
    held = expr.atoms(Symbol)
    symbols = [symbol for symbol in (*sy.INDICES, sy.H_M) if symbol in held]
    if len(terms) < _MANY or not symbols or not expr.is_polynomial(*symbols):
        return tuple(terms)
    parts: dict[int, dict[Expr, list[tuple[Expr, Expr]]]] = {}
    for term in terms:
        rest, monomial = term.as_independent(*symbols, as_Add=False)
        degree = sum(n for symbol, n in monomial.as_powers_dict().items() if symbol != sy.H_M)
        parts.setdefault(int(degree), {}).setdefault(monomial, []).append((rest, term))
    return tuple(factor for n in sorted(parts, reverse=True) for factor in _factored(parts[n]))


def _factored(part: Mapping[Expr, Sequence[tuple[Expr, Expr]]]) -> list[Expr]:
    """A sum of monomials, each with its terms' factors and these: as a product, or one by one."""
    if len(part) > 1:
        number, factors = _factors(Add(*(term for pairs in part.values() for _, term in pairs)))
        if sum(power for _, power in factors) > 1:
            return [_product(number, factors)]
    expanded = []
    for monomial, pairs in part.items():
        if len(pairs) == 1 or monomial == 1:
            expanded += [term for _, term in pairs]
        else:
            number, factors = _factors(Add(*(rest for rest, _ in pairs)))
            if len(factors) > 1:  # unlike (1 − φ)²
                factors = [(Add(*(rest / number for rest, _ in pairs)), 1)]
            expanded.append(_product(number, [*monomial.as_powers_dict().items(), *factors]))
    return expanded


def _factors(whole: Expr) -> tuple[Expr, list[tuple[Expr, int]]]:
    """A number and the factors of a polynomial with their powers.

    The first term of a factor, the highest in M or in another index, has a plus sign.
    """
    divisor, polynomial = sympy.Poly(whole, expand=False).clear_denoms(convert=True)
    if not polynomial.domain.is_ZZ:
        return sympy.S.One, [(whole, 1)]
    indices = [symbol for symbol in reversed(sy.INDICES) if symbol in polynomial.gens]
    generators = [*indices, *sorted({*polynomial.gens} - {*indices}, key=str)]
    context = fmpz_mpoly_ctx.get([f"g{n}" for n in range(len(generators))], Ordering.lex)
    terms = {powers: int(c) for powers, c in polynomial.reorder(*generators).terms()}
    number, parts = context.from_dict(terms).factor()
    factors = [
        (sympy.Poly({x: int(c) for x, c in part.to_dict().items()}, *generators), power)
        for part, power in parts
    ]
    return int(number) / divisor, [(factor.as_expr(), int(power)) for factor, power in factors]


def _product(number: Expr, factors: Sequence[tuple[Expr, int]]) -> Expr:
    """A product whose number is not multiplied out; 1 − φ stands for φ − 1."""
    if (power := dict(factors).get(sy.phi - 1)) is not None:
        factors = [(1 - sy.phi if base == sy.phi - 1 else base, n) for base, n in factors]
        number *= (-1) ** power
    ordered = sorted((base**power for base, power in factors), key=_factor_key)
    return Mul(*([] if number == 1 else [number]), *ordered, evaluate=False)


def _with_ratio(factors: Sequence[Expr]) -> Sequence[Expr]:
    """Factors with a power of σ/r at their end, where they hold that of σ and of 1/r."""
    powers = dict(factor.as_base_exp() for factor in factors)
    power = powers.get(sy.sigma, 0)
    if power <= 1 or powers.get(sy.r) != -power:
        return factors
    ratio = Pow(Mul(sy.sigma, 1 / sy.r, evaluate=False), power, evaluate=False)
    return [*(f for f in factors if f.as_base_exp()[0] not in (sy.sigma, sy.r)), ratio]


def _stands_beside(factor: Expr) -> bool:
    """Whether a factor stands beside a fraction rather than in its numerator."""
    is_ratio = isinstance(factor, Pow) and factor.base.is_Mul
    return is_operand(factor) or factor.is_Mul or is_ratio


def positive_first(terms: list[Expr]) -> list[Expr]:
    """Terms with one that has no minus sign in front: 1 - φ² rather than -φ² + 1."""
    first = next((place for place, term in enumerate(terms) if not is_negative(term)), 0)
    return [terms[first], *terms[:first], *terms[first + 1 :]]


def _factor_key(factor: Expr) -> tuple[int, int]:
    """Numbers, then M and the indices, then sums of them, then scales, then other parameters."""
    base = factor.base if isinstance(factor, Pow) else factor
    if factor.is_number:
        return 0, 0
    if is_operand(factor) or base.has(sy.SiteFunction):
        return 5, 0
    if base in sy.INDICES:
        return 1, -1 if base == sy.M else sy.INDICES.index(base)
    if base in sy.PARAMETERS:
        return 3, 0 if base in sy.SCALES else 1 + sy.PARAMETERS.index(base)
    if base.free_symbols <= set(sy.INDICES):
        return 2, -int(factor.exp) if isinstance(factor, Pow) else -1
    return 4, 0


def is_negative(term: Expr) -> bool:
    """Whether a term is written with a minus sign in front."""
    while isinstance(term, Mul):
        term = term.args[0]
    return bool(term.is_Rational and term.is_negative)


def without_sign(term: Expr) -> Expr:
    """A term that ``is_negative``, with that sign taken away and nothing else changed."""
    if not isinstance(term, Mul):
        return -term
    first, *rest = term.args
    first = without_sign(first)
    factors = rest if first == 1 else [first, *rest]
    return factors[0] if len(factors) == 1 else Mul(*factors, evaluate=False)


@cache
def is_operand(factor: Expr) -> bool:
    """Whether a factor is a vector, or a sum or product of some."""
    return bool(factor.has(Sum, sy.Dot, sy.MatrixTimes)) or is_vector(factor)


@cache
def is_vector(expr: Expr) -> bool:
    """Whether an expression holds a vector outside of a scalar product."""
    if isinstance(expr, sy.SiteFunction):
        return expr.is_vector
    if isinstance(expr, sy.Dot):
        return False
    return expr in sy.VECTORS or any(is_vector(arg) for arg in expr.args)


_LONGEST = 10_000  # bits of a number that is written out, within what Python converts


def digits(number: int) -> str:
    """A whole number; of one that is too long for a page, how many digits it has."""
    length = int(number).bit_length()
    if length <= _LONGEST:
        return str(int(number))
    return f"[a number of about {length * 3 // 10} digits]"


def _index_key(term: Expr) -> int:
    """Place of a term within an index: letters in their fixed order, numbers last."""
    return min(map(sy.INDICES.index, term.free_symbols & {*sy.INDICES}), default=len(sy.INDICES))


class StructuredPrinter(Printer):  # type: ignore[misc]
    """Reads the structure of an expression; subclasses say how each piece is set.

    What it has written is remembered, since breaking lines writes the same parts many times.
    """

    minus = "-"
    juxtaposition = " "

    def __init__(self) -> None:
        super().__init__({"order": "none"})
        self._remembered = lru_cache(maxsize=16_384)(super()._print)

    def _print(self, expr: Any, **kwargs: Any) -> str:
        hashable = isinstance(expr, Basic) and not kwargs
        return str(self._remembered(expr) if hashable else super()._print(expr, **kwargs))

    @abstractmethod
    def set_fraction(self, over: str, under: str, *, alone: bool) -> str:
        """A fraction; ``alone`` when no factor follows it."""

    @abstractmethod
    def set_brackets(self, inner: str) -> str:
        """Brackets around an expression."""

    @abstractmethod
    def set_power(self, base: str, exponent: Expr) -> str:
        """A power of something that needs no more brackets."""

    @abstractmethod
    def set_root(self, inner: str) -> str:
        """A square root."""

    def is_tall(self, factor: Expr) -> bool:
        """Whether a factor would make a third storey of the fraction in whose numerator it is."""
        return False

    def set_group(self, product: str) -> str:
        """A product within a product, with something after it."""
        return product

    # sums

    def terms(self, expr: Expr) -> list[tuple[str, str]]:
        """The additive terms of an expression: the sign (``+``, ``-`` or nothing) and the rest."""
        pieces = in_order(expr) if isinstance(expr, Add) else [expr]
        signed = []
        for place, term in enumerate(pieces):
            negative = is_negative(term)
            body = without_sign(term) if negative else term
            text = self._print(body)
            if isinstance(body, Add):
                text = self.set_brackets(text)
            sign = self.minus if negative else "+" if place else ""
            signed.append((sign, text))
        return signed

    def _print_Add(self, expr: Expr, **_: Any) -> str:
        return self.joined(self.terms(expr))

    def joined(self, terms: Sequence[tuple[str, str]]) -> str:
        """Signed terms in one line."""
        text = ""
        for sign, body in terms:
            text += f" {sign} {body}" if text else f"{sign}{body}"
        return text

    # products

    def _print_Mul(self, expr: Expr) -> str:
        if is_negative(expr):
            body = without_sign(expr)
            text = self._print(body)
            return self.minus + (self.set_brackets(text) if isinstance(body, Add) else text)
        over: list[Expr] = []
        under: list[Expr] = []
        beside: list[Expr] = []
        for factor in _with_ratio(in_order(expr)):
            if isinstance(factor, Rational) and factor.q != 1:
                over += [Integer(factor.p)] if factor.p != 1 else []
                under.append(Integer(factor.q))
            elif isinstance(factor, Pow) and factor.exp.is_Rational and factor.exp.is_negative:
                under.append(factor.base if factor.exp == -1 else factor.base**-factor.exp)
            else:
                over.append(factor)
        if under:
            # a person writes the fraction first, then what it multiplies
            beside = [f for f in over if _stands_beside(f) or self.is_tall(f)]
            over = [f for f in over if f not in beside]
        if not under:
            return self._side_by_side(over)
        fraction = self.set_fraction(
            self._one_or_more(over), self._one_or_more(under), alone=not beside
        )
        return self.juxtaposition.join(
            [fraction, *([self._side_by_side(beside, alone=False)] if beside else [])]
        )

    def _one_or_more(self, factors: list[Expr]) -> str:
        if not factors:
            return "1"
        return self._print(factors[0]) if len(factors) == 1 else self._side_by_side(factors)

    def _side_by_side(self, factors: list[Expr], *, alone: bool = True) -> str:
        texts = []
        alone = alone and len(factors) == 1
        for place, factor in enumerate(factors):
            last = place == len(factors) - 1
            text = self._print(factor)
            open_ended = isinstance(factor, Sum | Mul) and factor.has(Sum) and not last
            if (
                isinstance(factor, Add)
                or open_ended
                or (text.startswith(("-", self.minus)) and not alone)
            ):
                text = self.set_brackets(text)
            elif isinstance(factor, Mul) and not last:
                text = self.set_group(text)
            texts.append(text)
        return self.juxtaposition.join(texts)

    def _print_Integer(self, expr: Integer) -> str:
        return digits(expr.p).replace("-", self.minus)

    def _print_Rational(self, expr: Rational) -> str:
        if expr.p < 0:
            return f"{self.minus}{self._print(-expr)}"
        return self.set_fraction(digits(expr.p), digits(expr.q), alone=True)

    def _print_Pow(self, expr: Pow, **_: Any) -> str:
        if expr.exp.is_negative and (expr.exp.is_Integer or expr.exp == Rational(-1, 2)):
            return self._print_Mul(Mul(Integer(1), expr, evaluate=False))
        base = self._print(expr.base)
        if expr.exp == Rational(1, 2):
            return self.set_root(base)
        simple = isinstance(expr.base, Symbol | sy.SiteFunction) or (
            expr.base.is_Integer and expr.base >= 0
        )
        simple &= expr.base != sy.m_g  # printed as a product
        return self.set_power(base if simple else self.set_brackets(base), expr.exp)

    def parenthesize(self, item: Expr, level: int, *_: Any, **__: Any) -> str:
        """What stands within a product: brackets around sums."""
        text = str(self._print(item))
        return self.set_brackets(text) if item.is_Add else text

    # indices

    def index(self, expr: Expr) -> str:
        """One index, tightly set: letters in the paper's order, numbers last."""
        if not isinstance(expr, Add):
            return str(self._print(expr)).replace(" ", "")
        terms = [*expr.args]
        if rebuilt(expr) == expr:
            terms = positive_first(sorted(terms, key=_index_key))
        pieces = self.terms(Add(*terms, evaluate=False)) if len(terms) > 1 else []
        return "".join(sign + body for sign, body in pieces).replace(" ", "")
