"""Relations between whole numbers as a person writes them: "2 ≤ j ≤ M − 2", "j = M − 1"."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import lru_cache

import sympy

from .printing.code import python_expression
from .printing.latex import latex
from .printing.text import text
from .symbols import M, N, i, j, k, l, m, n, p, q, site_r, site_s

_ALONE = (N, p, q, n, m, i, site_r, j, k, site_s, l, M)
"""Which symbol stands alone, the first that can."""


@lru_cache(maxsize=4096)
def alone(form: sympy.Expr) -> tuple[sympy.Symbol, sympy.Expr, int]:
    """A symbol of a form c·symbol + rest with c = ±1, −rest/c, and c; any c where there is none."""
    factors = sympy.expand(form).as_coefficients_dict()
    alone = [symbol for symbol in _ALONE if factors.get(symbol)]
    symbol = next((symbol for symbol in alone if abs(factors[symbol]) == 1), alone[0])
    factor = factors[symbol]
    return symbol, sympy.expand(symbol - form / factor), 1 if factor > 0 else -1


def equations(relations: Iterable[sympy.Basic]) -> list[sympy.Eq]:
    """Equations form = 0, each solved for one symbol, which the others do not hold."""
    left = [relation.lhs for relation in relations if isinstance(relation, sympy.Eq)]
    solved: dict[sympy.Symbol, sympy.Expr] = {}
    while left:
        symbol, value, _ = min(map(alone, left), key=lambda row: len(row[1].free_symbols))
        left = [sympy.expand(form.xreplace({symbol: value})) for form in left]
        left = [form for form in left if form != 0]
        solved = {key: sympy.expand(at.xreplace({symbol: value})) for key, at in solved.items()}
        solved[symbol] = value
    return [sympy.Eq(key, solved[key], evaluate=False) for key in _ALONE if key in solved]


Bounds = tuple[list[sympy.Expr], sympy.Symbol, list[sympy.Expr]]
"""Lower bounds of a symbol, the symbol, and upper bounds."""


def bounds(relations: Iterable[sympy.Basic], given: Iterable[sympy.Eq] = ()) -> list[Bounds]:
    """Symbols between their bounds, from relations that are no equations.

    ``given`` symbols do not stand in them.
    """
    values = {item.lhs: item.rhs for item in given}
    limits: dict[sympy.Symbol, tuple[list[sympy.Expr], list[sympy.Expr]]] = {}
    for relation in relations:
        if isinstance(relation, sympy.Eq):
            continue
        above, below = relation.args
        if isinstance(relation, sympy.Le | sympy.Lt):
            above, below = below, above
        strict = int(isinstance(relation, sympy.Lt | sympy.Gt))
        form = _without_divisor((above - below - strict).xreplace(values))
        if not form.free_symbols:
            continue
        symbol, bound, sign = alone(form)
        limits.setdefault(symbol, ([], []))[0 if sign > 0 else 1].append(bound)
    return [(low, symbol, high) for symbol, (low, high) in limits.items()]


def _without_divisor(form: sympy.Expr) -> sympy.Expr:
    """A form of whole numbers that is at least 0 where another one is: x − 1 for 2 x − 1."""
    constant, rest = sympy.expand(form).as_coeff_Add()
    divisor, rest = rest.primitive()
    return rest + sympy.floor(constant / divisor)


def in_words(relations: Iterable[sympy.Basic]) -> str:
    """Relations as text: equations first, then what lies between bounds."""
    return ", ".join(parts(relations))


def in_their_words(relations: Sequence[sympy.Basic]) -> str:
    """Relations as text: as they are written, or as a person writes those of forms with 0."""
    if all(relation.rhs == 0 for relation in relations):
        return in_words(relations)
    return ", ".join(chains(relations))


def alternatives(several: Iterable[Iterable[sympy.Basic]]) -> str:
    """Relations as text, those of any of several parts."""
    return "; or ".join(map(in_words, several))


@dataclass(frozen=True)
class Style:
    """How expressions and the signs between them are written, without fractions for a program."""

    shown: Callable[[sympy.Expr], str]
    equal: str
    at_most: str
    at_least: str
    is_code: bool = False

    def chain(self, sign: str, *forms: sympy.Expr) -> str:
        """Forms with a sign between them."""
        numbers = [n for form in forms for n in form.as_coefficients_dict().values()]
        scale = sympy.ilcm(1, *(n.q for n in numbers)) if self.is_code else 1
        return sign.join(self.shown(sympy.expand(scale * form)) for form in forms)


TEXT = Style(lambda expr: text(expr).replace("-", "−"), " = ", " ≤ ", " ≥ ")
LATEX = Style(latex, " = ", r" \leq ", r" \geq ")
PYTHON = Style(python_expression, " == ", " <= ", " >= ", is_code=True)


def parts(relations: Iterable[sympy.Basic], style: Style = TEXT) -> list[str]:
    """The same, one by one."""
    relations = tuple(relations)
    solved = equations(relations)
    phrases = [style.chain(style.equal, *index.args) for index in solved]
    for low, symbol, high in bounds(relations, solved):
        if len(low) == 1 and high:
            phrases.append(style.chain(style.at_most, low[0], symbol, high[0]))
        else:
            phrases += [style.chain(style.at_least, symbol, bound) for bound in low]
        rest = high[1:] if len(low) == 1 else high
        phrases += [style.chain(style.at_most, symbol, bound) for bound in rest]
    return phrases


_SIGNS = {sympy.Eq: "=", sympy.Le: "≤", sympy.Lt: "<", sympy.Ge: "≥", sympy.Gt: ">"}
_TURNED = {sympy.Ge: sympy.Le, sympy.Gt: sympy.Lt}


def chains(relations: Sequence[sympy.Basic]) -> tuple[str, ...]:
    """Relations in their order, as "0 ≤ j < M" where one begins with what the last ends with."""
    if sympy.false in relations:
        return ("nowhere",)
    return tuple(
        " ".join(_SIGNS[link] if isinstance(link, type) else text(link) for link in chain)
        for chain in _chains(relations)
    )


def _chains(relations: Sequence[sympy.Basic]) -> Iterator[list[sympy.Basic | type]]:
    """Relations that go on where the one before ends, as sides and kinds in turn."""
    chain: list[sympy.Basic | type] = []
    for relation, following in zip(relations, (*relations[1:], None), strict=False):
        left, right, kind = relation.lhs, relation.rhs, relation.func
        goes_on = following is not None and following.lhs == left
        if goes_on and kind in _TURNED and following.func not in _TURNED:
            left, right, kind = right, left, _TURNED[kind]
        if chain and chain[-1] == left and kind not in _TURNED:
            chain += [kind, right]
            continue
        if chain:
            yield chain
        chain = [left, kind, right]
    if chain:
        yield chain
