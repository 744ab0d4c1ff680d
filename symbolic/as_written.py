"""Formulas read from text, in the order in which they are written: what a person types and reads.

The language is what :func:`.printing.text.text` prints of sums, products, quotients and powers:

    −[2l(1 − φ)² − (2φ² + φ + 1)(l − j)]/(1 − φ²)²

Side by side is a product; −φ² is −(φ²); a quotient ends with its one divisor, so that a/bc, which
people read in two ways, is refused, and so is whatever else is not in the language. Nothing is
evaluated, in no sense of the word.
"""

import re
from collections.abc import Iterable
from math import gcd, prod
from typing import NamedTuple

import sympy
from sympy import Integer, Rational

from . import symbols as sy
from .as_printed import minus, power, terms, times
from .printing.structure import rebuilt
from .trees import nodes

_BEADS_OWN = (sy.site_r, sy.site_s)
VOCABULARY = (
    *(one for one in sy.INDICES if one not in _BEADS_OWN),
    *sy.PARAMETERS,
)
"""Symbols that every formula may hold; r and s are the radius and the spacing."""

_RAISED = dict(zip("⁰¹²³⁴⁵⁶⁷⁸⁹⁻", "0123456789-", strict=True))
_DIGITS = "0123456789"
_CLOSING = {"(": ")", "[": "]", "{": "}"}
_SIGNS = {"=": sympy.Eq, "≤": sympy.Le, "<": sympy.Lt, "≥": sympy.Ge, ">": sympy.Gt}
_TURNED = {sympy.Eq: sympy.Eq, sympy.Le: sympy.Ge, sympy.Lt: sympy.Gt}
_TURNED |= {other: one for one, other in _TURNED.items()}
_MINUS = "−-"
_WORD = re.compile("pi|[A-Za-z]{3,}")
_LONGEST, _DEEPEST = 4000, 40  # characters, brackets in each other: more is a mistake


class FormulaError(ValueError):
    """A formula that is not in the language; the message says where, and what is allowed."""


def formula(written: str, *symbols: sympy.Symbol) -> sympy.Expr:
    """The expression that is written, with its terms and factors in that order.

    Args:
        written: sums, products, quotients, whole powers raised (φ², t⁻¹) or others as ^(3/2),
            roots √; whole numbers; names as they are printed in text.
        symbols: may stand in it beside those of ``VOCABULARY``.

    Raises:
        FormulaError: it is not in the language; two symbols have one name.

    >>> from force_diffusion.symbolic.printing.text import text
    >>> text(formula("4j(1 − φ) − 8φM + φ²/2"))
    '4 j (1 − φ) − 8 M φ + φ²/2'
    """
    reader = _Reader(written, symbols)
    found = reader.expression()
    reader.end()
    return found


def relations(written: str, *symbols: sympy.Symbol) -> tuple[sympy.Basic, ...]:
    """The relations that are written, parted by commas or "and": "2 ≤ j ≤ l − 2 and l < M".

    Each has its sides in SymPy's own order, and a number on the right.

    Raises:
        FormulaError: it is not in the language; the signs of a chain go both ways.

    >>> relations("0 ≤ j < M, N = 2")
    (j >= 0, j < M, Eq(N, 2))
    """
    reader = _Reader(written, symbols)
    found = [*reader.chain()]
    while reader.takes(",") or reader.takes("and"):
        found += reader.chain()
    reader.end()
    return tuple(found)


class _Term(NamedTuple):
    """A term of a sum: its sign, and the factors above and below its line."""

    negative: bool
    above: list[sympy.Expr]
    below: list[sympy.Expr]

    def expression(self) -> sympy.Expr:
        """What it is; a whole number below the line goes to the one in front, as in SymPy."""
        number = prod(int(one) for one in self.below if _counts(one))
        front, *rest = self.above if self.above[0].is_Integer else (Integer(1), *self.above)
        numbers = [front, Rational(1, number)] if gcd(front, number) > 1 else [front / number]
        others = (_inverse(one) for one in self.below if not _counts(one))
        factors = [one for one in (*numbers, *rest, *others) if one != 1] or [Integer(1)]
        found = times(*factors) if len(factors) > 1 else factors[0]
        if not self.negative:
            return found
        return -found if found.is_Rational else minus(found)


def _counts(factor: sympy.Expr) -> bool:
    return bool(factor.is_Integer and factor > 0)


def _inverse(factor: sympy.Expr) -> sympy.Expr:
    if factor.is_Pow and factor.exp > 0:
        return power(factor.base, -factor.exp)
    return power(factor, -1)


class _Reader:
    """Reads from left to right; ``at`` is the place of what comes next."""

    def __init__(self, written: str, symbols: Iterable[sympy.Symbol]):
        self.written, self.at, self.depth = written, 0, 0
        self.names: dict[str, sympy.Symbol] = {}
        for one in (*VOCABULARY, *symbols):
            name = getattr(one, "in_text", one.name)
            if self.names.setdefault(name, one) != one:
                raise FormulaError(f"two symbols have the name {name}")
        if len(written) > _LONGEST:
            raise FormulaError(f"the formula is too long: at most {_LONGEST} characters are read")

    def refusal(self, words: str, at: int | None = None) -> FormulaError:
        """What is wrong at a place."""
        at = self.at if at is None else at
        rest = self.written[at : at + 20]
        place = f"at “{rest}”, character {at + 1}" if rest else "at its end"
        return FormulaError(f"“{self.written}” is not read, {place}: {words}")

    # what comes next

    def next(self) -> str:
        """The next character that is no blank; "" at the end."""
        while self.written[self.at : self.at + 1] in (" ", "\n"):
            self.at += 1
        return self.written[self.at : self.at + 1]

    def takes(self, *signs: str) -> bool:
        """Whether one of these is next; it is then behind."""
        self.next()
        for sign in signs:
            if self.written.startswith(sign, self.at):
                self.at += len(sign)
                return True
        return False

    def end(self) -> None:
        """Nothing may follow."""
        if self.next():
            raise self.refusal("this continues no formula")

    def starts_a_factor(self) -> bool:
        """Whether a number, a name, a bracket or a root is next."""
        sign = self.next()
        return bool(sign) and (sign in f"{_DIGITS}√" or self.opens() or self.starts_a_name())

    def opens(self) -> bool:
        """Whether a bracket is next; that of a name is none."""
        return self.next() in {*_CLOSING} and not self.starts_a_name()

    def starts_a_name(self, at: int | None = None) -> bool:
        """Whether a name starts here, or at another place."""
        at = self.at if at is None else at
        return any(self.written.startswith(name, at) for name in self.names)

    def joined(self) -> bool:
        """Whether a factor follows without a blank."""
        at = self.at
        found = self.starts_a_factor() and self.at == at
        self.at = at
        return found

    # sums, products, powers

    def expression(self) -> sympy.Expr:
        """A sum."""
        return _built(self.sum())

    def sum(self) -> list[_Term]:
        """Its terms; a minus may stand in front of the first, a plus stands between two."""
        found = [self.term(negative=self.takes(*_MINUS))]
        while (sign := self.next()) and self.takes("+", *_MINUS):
            found.append(self.term(negative=sign != "+"))
        return found

    def term(self, *, negative: bool) -> _Term:
        """Factors side by side, of which the first may be a number, over one divisor."""
        above = [self.power()]
        while self.starts_a_factor():
            if self.next() in {*_DIGITS}:
                raise self.refusal("a number stands in front of what it multiplies")
            above.append(self.power())
        if not self.takes("/"):
            return _Term(negative, above, [])
        start = self.at - 1
        below = self.divisor()
        if self.starts_a_factor() or self.next() == "/":
            told = "what is divided by what? Write a/(bc), or (a/b)c"
            raise self.refusal(told, start)
        return _Term(negative, above, below)

    def divisor(self) -> list[sympy.Expr]:
        """What stands below the line: one factor, or those of a product in brackets."""
        start = self.at
        if self.opens():
            inner = self.bracket()
            only, *others = inner
            if others or only.negative or only.below or self.starts_a_power():
                found = [self.raised(_built(inner))]
            else:
                found = only.above
        else:
            found = [self.power()]
        if any(one == 0 for one in found):
            raise self.refusal("nothing is divided by zero", start)
        return found

    def bracket(self) -> list[_Term]:
        """What stands in round, square or curly brackets."""
        start, closing = self.at, _CLOSING[self.next()]
        self.at += 1
        self.depth += 1
        if self.depth > _DEEPEST:
            raise self.refusal(f"at most {_DEEPEST} brackets are read within each other", start)
        found = self.sum()
        self.depth -= 1
        if not self.takes(closing):
            raise self.refusal(f"“{closing}” is missing, for the bracket at character {start + 1}")
        return found

    def power(self) -> sympy.Expr:
        """A number, a name, a bracket or a root, and what power of it."""
        if self.takes("√"):
            start, bracket = self.at - 1, self.opens()
            root = power(self.base("what the root is of"), Rational(1, 2))
            if self.starts_a_power() or (not bracket and self.joined()):
                raise self.refusal("how far does the root reach? Write brackets", start)
            return root
        return self.raised(self.base("a number, a name or a bracket"))

    def base(self, wanted: str) -> sympy.Expr:
        """A number, a name or a bracket."""
        if self.opens():
            return _built(self.bracket())
        return self.number() if self.next() in {*_DIGITS} else self.symbol(wanted)

    def number(self) -> Integer:
        """A whole number."""
        return Integer(self.run(_DIGITS))

    def run(self, characters: Iterable[str]) -> str:
        """As many of some characters as follow each other."""
        start = self.at
        while (sign := self.written[self.at : self.at + 1]) and sign in characters:
            self.at += 1
        return self.written[start : self.at]

    def symbol(self, wanted: str) -> sympy.Symbol:
        """A name: the longest that fits, if a shorter one leaves no name or power behind it."""
        start = self.at
        fit = sorted((one for one in self.names if self.written.startswith(one, start)), key=len)
        if not fit:
            if self.written[start : start + 1] in ("+", *_MINUS):
                raise self.refusal("signs stand between two terms; a minus also before the first")
            held = ", ".join(sorted(self.names))
            raise self.refusal(f"{wanted} is missing. The names are {held}")
        *shorter, name = fit
        word = _WORD.match(self.written, start)
        if word and len(word[0]) > len(name):
            raise self.refusal(f"{word[0]} is a word, or a product? Leave blanks in those", start)
        for one in shorter:
            if self.starts_a_name(start + len(one)):
                raise self.refusal(f"{name}, or {one} and more? Leave a blank", start)
        self.at += len(name)
        if name[-1] in "⁺⁻" and self.starts_a_power():
            raise self.refusal(f"a power of {name}? Write ({name})² then", start)
        return self.names[name]

    def starts_a_power(self) -> bool:
        """Whether what is behind is raised."""
        return self.written[self.at : self.at + 1] in {*_RAISED, "^"}

    def raised(self, base: sympy.Expr) -> sympy.Expr:
        """A power of it: a whole number raised, or a fraction behind ^."""
        if not self.starts_a_power():
            return base
        start = self.at
        if self.takes("^"):
            exponent = _built(self.bracket()) if self.opens() else None
            if exponent is None or not exponent.is_Rational:
                raise self.refusal("a power is a whole number raised, or a fraction: ^(3/2)", start)
        else:
            digits = "".join(_RAISED[one] for one in self.run(_RAISED))
            if not digits.removeprefix("-").isdigit():
                raise self.refusal("a power is a whole number: ², ⁻¹", start)
            exponent = Integer(digits)
            if exponent in (0, 1):
                raise self.refusal(f"nobody writes the power {exponent}", start)
        if self.starts_a_power():
            raise self.refusal("a power of a power? Write it in brackets")
        return power(base, exponent)

    # relations

    def chain(self) -> list[sympy.Basic]:
        """Relations of a chain such as 2 ≤ j < M."""
        found, sides, ways = [], [self.expression()], set()
        while (sign := self.next()) and sign in _SIGNS:
            self.at += 1
            sides.append(self.expression())
            ways |= {sign in "≤<"} if sign != "=" else set()
            if len(ways) > 1:
                raise self.refusal("a chain goes one way", self.at)
            if any(map(too_large, sides)):
                raise self.refusal("its numbers are too large", 0)
            left, right = map(rebuilt, sides[-2:])
            relation = _SIGNS[sign]
            if left.is_number:
                left, right, relation = right, left, _TURNED[relation]
            found.append(relation(left, right, evaluate=False))
        if not found:
            raise self.refusal(f"one of {' '.join(_SIGNS)} is missing")
        return found


def _built(found: list[_Term]) -> sympy.Expr:
    made = [one.expression() for one in found]
    return terms(*made) if len(made) > 1 else made[0]


def written_out(tree: sympy.Basic) -> int:
    """How many nodes a tree has when a part that it holds twice is counted twice."""
    count: dict[int, int] = {}
    for node in nodes(tree):
        count[id(node)] = 1 + sum(count[id(one)] for one in node.args)
    return count[id(tree)]


def bits(tree: sympy.Basic) -> int:
    """A bound on the length of its numbers when all of it is carried out; symbols count eight."""
    found: dict[int, int] = {}
    for node in nodes(tree):
        parts = [found[id(one)] for one in node.args]
        if isinstance(node, sympy.Rational):
            length = sum(int(part).bit_length() for part in (node.p, node.q))
        elif isinstance(node, sympy.Pow) and isinstance(node.exp, sympy.Rational):
            length = parts[0] * max(1, -(-abs(int(node.exp.p)) // int(node.exp.q)))
        elif isinstance(node, sympy.Piecewise):  # each alternative is read by itself
            length = max(parts, default=0)
        else:
            length = 8 + sum(parts)
        found[id(node)] = length
    return found[id(tree)]


_MOST_NODES = 100_000
"""Of what is read, written out: a hundred times the longest printed statement."""

_MOST_BITS = 50_000
"""Of its numbers: ten times those of the longest one."""


def too_large(tree: sympy.Basic) -> str:
    """Why a tree would take too long to be read; "" when it would not."""
    if written_out(tree) > _MOST_NODES:
        return f"it is too large: at most {_MOST_NODES} parts are read"
    if bits(tree) > _MOST_BITS:
        return f"it is too large: carried out, it may hold numbers of more than {_MOST_BITS} bits"
    return ""
