"""What displays of several formulas share: a common factor, and where each of them holds."""

from collections.abc import Iterable, Sequence

import sympy
from force_diffusion.symbolic import symbols as sy
from force_diffusion.symbolic import words
from force_diffusion.symbolic.algebra.exact import FIELD, Domain
from force_diffusion.symbolic.piecewise import Relations
from force_diffusion.symbolic.quotients import factored


def alternatives_in_latex(parts: Iterable[Relations], before: str = "") -> list[str]:
    """Where a formula holds, as pieces of LaTeX."""
    first, *others = (words.parts(one, words.LATEX) for one in parts)
    return [
        *with_commas(first, before),
        *(one for part in others for one in with_commas(part, " or")),
    ]


def with_commas(parts: Sequence[str], before: str = "") -> list[str]:
    """Pieces of LaTeX behind one another, with a word before the first."""
    if parts and before:
        parts = [rf"\text{{{before} }} {parts[0]}", *parts[1:]]
    return [*(rf"{one},\;" for one in parts[:-1]), *parts[-1:]]


def over_common(
    formulas: Sequence[sympy.Expr], field: Domain = FIELD
) -> tuple[sympy.Expr, list[sympy.Expr]]:
    """What formulas have in common, and what else each of them holds."""
    factor = field.from_sympy(_common(formulas))
    return factored(factor), [factored(field.from_sympy(one) / factor) for one in formulas]


def _common(formulas: Iterable[sympy.Expr]) -> sympy.Expr:
    """A factor of formulas: of divisors, only those that hold an index are left in each."""
    numbers, powers = [], []
    for number, rest in (one.as_coeff_Mul() for one in formulas if one != 0):
        numbers.append(number)
        held = rest.as_powers_dict()
        if square := held.pop(1 - sy.phi**2, 0):
            for base in (1 - sy.phi, 1 + sy.phi):
                held[base] = held.get(base, 0) + square
        powers.append(held)
    factor = sympy.Rational(
        sympy.igcd(0, *(one.p for one in numbers)), sympy.ilcm(1, *(one.q for one in numbers))
    )
    for base in set().union(*powers):
        found = [held.get(base, 0) for held in powers]
        if max(found) < 0 and base.free_symbols & {*sy.INDICES}:
            factor *= base ** max(found)
        elif min(found) > 0 or not base.free_symbols & {*sy.INDICES}:
            factor *= base ** min(found)
    return factor
