"""How several formulas of one quantity are written: in LaTeX, as Python source and as text."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property

import sympy
from force_diffusion.numeric.arithmetic.errors import ArgumentError, quoted
from force_diffusion.symbolic import symbols as sy
from force_diffusion.symbolic import words
from force_diffusion.symbolic.algebra.exact import FIELD, Field
from force_diffusion.symbolic.piecewise import Piece, Relations
from force_diffusion.symbolic.printing.code import python_expression
from force_diffusion.symbolic.printing.lines import (
    COLUMNS,
    latex_body,
    latex_cases,
    pack,
    text_lines,
)
from force_diffusion.symbolic.quotients import factored
from force_diffusion.symbolic.trees import equation

_MANY = 6  # parts of a domain, beyond which LaTeX says "otherwise" of a formula
_HIGH = {1: 23, 2: 22}  # lines of a display that fits a page of usual classes, by columns
_SOURCES = {
    sy.H_M: "sum(1/n for n in range(1, M + 1))",
    sy.n_x: "((1 - phi)/2)**0.5",
    sy.n_y: "((1 + phi)/2)**0.5",
}
"""What Python computes from the other symbols."""


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


@dataclass(frozen=True)
class FormulasInLatex:
    """The formulas of a closed form as displays.

    Attributes:
        quantity: what they give.
        pieces: the formulas, each with where it holds.
        conditions: what holds wherever they do, as pieces of LaTeX.
        units: what the quantities are divided by, in words; "" if by nothing.
    """

    quantity: sympy.Expr
    pieces: Sequence[Piece]
    conditions: Sequence[str]
    units: str

    def display(self, columns: int) -> str:
        """All formulas in one display, for a page with so many columns."""
        return self._shown(self._in_order, columns)

    def displays(self, columns: int) -> list[str]:
        """The same in displays that fit a page, several if needed."""
        return self._in_halves(self._in_order, columns)

    def _in_halves(self, pieces: Sequence[Piece], columns: int) -> list[str]:
        whole, half = self._shown(pieces, columns), len(pieces) // 2
        if whole.count(r"\\") <= _HIGH[columns] or not half:
            return [whole]
        return [*self._in_halves(pieces[:half], columns), *self._in_halves(pieces[half:], columns)]

    @cached_property
    def _in_order(self) -> list[Piece]:
        """The formulas, those with many parts last; the last of them has what the others leave."""
        return sorted(self.pieces, key=lambda piece: max(len(piece.where), _MANY))

    def _shown(self, pieces: Sequence[Piece], columns: int) -> str:
        """Some of the formulas; where all hold, below the last."""
        room, is_last = room_of(columns), pieces[-1] is self._in_order[-1]
        conditions = [*self.conditions] if is_last else []
        units = [rf"\text{{{self.units}}}"] if self.units and is_last else []
        first, is_alone = pieces[0], len(pieces) == 1
        beside = self._where(first, "if") if is_alone else []
        word = " for" if beside else "for"
        below = [*beside, *with_commas([*conditions, *units], word if conditions else "")]
        if is_alone:
            return latex_body((equation(self.quantity, first.expr),), room=room, below=below)
        factor, values = self._over_common
        rows = [(values[piece], self._where(piece)) for piece in pieces]
        return latex_cases(self.quantity, factor, rows, below, room)

    def _where(self, piece: Piece, before: str = "") -> list[str]:
        if len(piece.where) > _MANY and piece is self._in_order[-1]:
            return [r"\text{otherwise}"]
        return alternatives_in_latex(piece.where, before)

    @cached_property
    def _over_common(self) -> tuple[sympy.Expr, dict[Piece, sympy.Expr]]:
        """What the formulas have in common, and what else each of them holds."""
        field = self.pieces[0].value.domain  # it has the user's own symbols, too
        factor, values = over_common([piece.expr for piece in self.pieces], field)
        return factor, dict(zip(self.pieces, values, strict=True))


def in_python(pieces: Sequence[Piece]) -> list[str]:
    """The body of a Python function that gives the value of the formula which holds."""
    lines = []
    for symbol, source in _SOURCES.items():
        if any(piece.expr.has(symbol) for piece in pieces):
            lines.append(f"    {symbol.in_code} = {source}")
    for piece in pieces:
        parts = [" and ".join(words.parts(part, words.PYTHON)) for part in piece.where]
        value = f"    return {python_expression(piece.expr)}"
        lines += [f"    if {' or '.join(parts)}:", f"    {value}"] if all(parts) else [value]
    return lines


def in_text(piece: Piece, room: int) -> list[str]:
    """Where a formula holds, and the formula, in one line or in several."""
    parts = f"{piece.domain or 'everywhere'}:".replace("; or ", ";\nor ").split("\n")
    where = pack([(part, len(part) + 1) for part in parts], room - 4, room - 2)
    formula = text_lines(piece.expr, room=room - 4)
    if len(where) + len(formula) == 2 and len(where[0] + formula[0]) < room - 3:
        return [f"  {where[0]} {formula[0]}"]
    return [f"  {where[0]}", *(f"    {line}" for line in (*where[1:], *formula))]
