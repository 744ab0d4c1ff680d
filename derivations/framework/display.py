"""What displays of several formulas share: a common factor, and where each of them holds."""

from collections.abc import Iterable, Sequence

import sympy
from force_diffusion.numeric.arithmetic.errors import ArgumentError, quoted
from force_diffusion.symbolic import symbols as sy
from force_diffusion.symbolic import words
from force_diffusion.symbolic.algebra.exact import FIELD, Field
from force_diffusion.symbolic.piecewise import Relations
from force_diffusion.symbolic.printing.lines import COLUMNS
from force_diffusion.symbolic.quotients import factored


def room_of(columns: int) -> float:
    """Points for a line of text in one column, or in two. Raises ``ArgumentError``."""
    if not isinstance(columns, int) or isinstance(columns, bool) or columns not in COLUMNS:
        raise ArgumentError(f"columns = {quoted(columns)}: must be 1 or 2")
    return COLUMNS[columns]


def alternatives_in_latex(parts: Iterable[Relations], before: str = "") -> list[str]:
    """Where a formula holds, as pieces of LaTeX; what all alternatives share comes first."""
    several = [words.parts(part, words.LATEX) for part in parts]
    shared = [phrase for phrase in several[0] if all(phrase in part for part in several)]
    first, *others = ([phrase for phrase in part if phrase not in shared] for part in several)
    if shared and first:
        first[0] = rf"\text{{either }} {first[0]}"
    pieces = with_commas([*shared, *first], before)
    if not others:
        return pieces
    return [" ".join(pieces), *(" ".join(with_commas(part, " or")) for part in others)]


def with_commas(parts: Sequence[str], before: str = "") -> list[str]:
    """Pieces of LaTeX behind one another, with a word before the first."""
    if parts and before:
        parts = [rf"\text{{{before} }} {parts[0]}", *parts[1:]]
    return [*(rf"{part},\;" for part in parts[:-1]), *parts[-1:]]


def over_common(
    formulas: Sequence[sympy.Expr], field: Field = FIELD
) -> tuple[sympy.Expr, list[sympy.Expr]]:
    """What formulas have in common, and what else each of them holds."""
    factor = field.from_sympy(_common(formulas))
    return factored(factor), [factored(field.from_sympy(formula) / factor) for formula in formulas]


def _common(formulas: Iterable[sympy.Expr]) -> sympy.Expr:
    """A factor of formulas: of divisors, only those that hold an index are left in each."""
    numbers, powers = [], []
    for number, rest in (formula.as_coeff_Mul() for formula in formulas if formula != 0):
        numbers.append(number)
        powers_of_rest = rest.as_powers_dict()
        if square := powers_of_rest.pop(1 - sy.phi**2, 0):
            for base in (1 - sy.phi, 1 + sy.phi):
                powers_of_rest[base] = powers_of_rest.get(base, 0) + square
        powers.append(powers_of_rest)
    above, below = (number.p for number in numbers), (number.q for number in numbers)
    factor = sympy.Rational(sympy.igcd(0, *above), sympy.ilcm(1, *below))
    for base in set().union(*powers):
        exponents = [powers_of_rest.get(base, 0) for powers_of_rest in powers]
        if max(exponents) < 0 and base.free_symbols & {*sy.INDICES}:
            factor *= base ** max(exponents)
        elif min(exponents) > 0 or not base.free_symbols & {*sy.INDICES}:
            factor *= base ** min(exponents)
    return factor
