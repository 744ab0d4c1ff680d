"""Sums of squared weights for all values of the indices, split into cases.

Close to an edge, sites that are distinct elsewhere become one, and the closed form changes. Here
a region is split at its lowest index until no such coincidence is left open: the cases cover all
of it, each index value belongs to exactly one, and no case is chosen by hand.
"""

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass

import sympy
from force_diffusion.symbolic.algebra import affine
from force_diffusion.symbolic.algebra.affine import Region
from force_diffusion.symbolic.algebra.exact import FIELD, RationalFunction
from force_diffusion.symbolic.algebra.linear_forms import LinearForm
from force_diffusion.symbolic.algebra.weights import UndeterminedError
from force_diffusion.symbolic.printing.text import text

DEEPEST = 9  # no coincidence of the paper's forms is left open for indices from here on


@dataclass(frozen=True)
class Case:
    """Σ weight² where some indices have one value and the others a lower bound."""

    at: dict[sympy.Symbol, int]
    lower: dict[sympy.Symbol, int]
    value: RationalFunction

    def is_at(self, symbol: sympy.Symbol, value: int) -> bool | None:
        """Whether an index has a value: always, never, or (None) sometimes."""
        if symbol in self.at:
            return self.at[symbol] == value
        return False if self.lower[symbol] > value else None

    def put_in(self, value: RationalFunction) -> RationalFunction:
        """Another function of the indices, with the values that they have here."""
        return value.substitute({symbol: FIELD.constant(n) for symbol, n in self.at.items()})


Forms = tuple[LinearForm, ...]


def by_case(
    forms: Forms,
    lower: dict[sympy.Symbol, int],
    generic: int,
    value: Callable[[Forms, Region], RationalFunction],
    at: dict[sympy.Symbol, int] | None = None,
) -> Iterator[Case]:
    """A value of several forms for all indices from their lower bounds on.

    Values below ``generic`` become cases of their own at once, others only where they have to.
    The forms must have been read for these indices: their sums are in order for all of them.
    """
    at = at or {}
    symbol = min(lower, key=lambda index: lower[index], default=None)
    try:
        if symbol is None or lower[symbol] >= generic:
            yield Case(at, lower, value(forms, Region(lower)))
            return
    except UndeterminedError:
        if symbol is None or lower[symbol] >= DEEPEST:
            raise
    bound = lower[symbol]
    others = {index: least for index, least in lower.items() if index != symbol}
    fixed = tuple(form.put_in({symbol: affine.constant(bound)}) for form in forms)
    yield from by_case(fixed, others, generic, value, {**at, symbol: bound})
    yield from by_case(forms, {**lower, symbol: bound + 1}, generic, value, at)


@dataclass(frozen=True)
class Piece:
    """A closed form for the indices named in ``at``; the first of several that fits holds.

    ``further`` says in relations where none before it fits.
    """

    where: str
    at: dict[sympy.Symbol, int]
    expression: sympy.Expr
    further: tuple[sympy.Basic, ...] = ()

    def fits(self, case: Case) -> bool | None:
        """Whether it is for a case: for all of it, for none, or (None) for a part."""
        found = [case.is_at(symbol, value) for symbol, value in self.at.items()]
        return False if False in found else None if None in found else True


def first_difference(
    pieces: Sequence[Piece],
    cases: Iterable[Case],
    unit: RationalFunction,
    coordinates: dict[sympy.Symbol, sympy.Expr],
) -> str | None:
    """Compare closed forms, in a unit, with all cases: where they differ, or None for nowhere.

    ``coordinates`` says what stands for symbols of the closed forms that the cases do not use.
    """
    stated = {
        piece.where: FIELD.from_sympy(piece.expression.xreplace(coordinates)) * unit
        for piece in pieces
    }
    for case in cases:
        where = ", ".join(
            [f"{symbol} = {value}" for symbol, value in case.at.items()]
            + [f"{symbol} ≥ {value}" for symbol, value in case.lower.items()]
        )
        for piece in pieces:
            fits = piece.fits(case)
            if fits is None:
                return f"{where}: lies in part in '{piece.where}'"
            if fits:
                break
        else:
            return f"{where}: no closed form"
        difference = case.value - case.put_in(stated[piece.where])
        if not difference.is_zero():
            return f"{where}: the exact value exceeds it by {text(difference.to_sympy())}"
    return None
