"""What a user may hand to ``decide``: a line, the right-hand side of one, or all lines at once."""

from collections.abc import Callable, Collection, Sequence
from dataclasses import replace
from numbers import Rational
from typing import Any

import sympy
from force_diffusion.symbolic import symbols as sy
from force_diffusion.symbolic.algebra.exact import NotAStatementError, NotExactError
from force_diffusion.symbolic.forms import SUMMATION
from force_diffusion.symbolic.kernel.decisions import (
    Ruling,
    Verdict,
    all_of,
    not_a_statement,
    undecided,
)
from force_diffusion.symbolic.kernel.domain import Domain
from force_diffusion.symbolic.notation import by_name
from force_diffusion.symbolic.printing.text import text
from force_diffusion.symbolic.sizes import too_large
from force_diffusion.symbolic.trees import equation, in_place
from sympy.logic.boolalg import BooleanAtom

from .lists import either

OURS = {*sy.INDICES, *sy.PARAMETERS, *sy.VECTORS}

RuleOn = Callable[[int, sympy.Eq], Ruling]
"""Rules on a candidate for one of the lines, by its place."""


def decided(candidate: Any, lines: Sequence[sympy.Eq], rule_on: RuleOn) -> Ruling:
    """Rule on a candidate for printed lines.

    Args:
        candidate: a SymPy ``Eq``; an expression, number or closed form for a right-hand side; or as
            many of these as there are lines, in a ``Tuple``, tuple or list.
        lines: what is printed.
        rule_on: rules on an equation in the place of one of them; ``NotExactError`` of a candidate
            that it can't read.
    """
    try:
        if isinstance(candidate, sympy.Tuple | tuple | list):
            return _on_all(tuple(candidate), lines, rule_on)
        return _on_one(candidate, lines, rule_on)
    except NotExactError as reason:
        return unread(reason)
    except RecursionError:
        return undecided("it is nested too deeply to be read")


def _on_one(candidate: Any, lines: Sequence[sympy.Eq], rule_on: RuleOn) -> Ruling:
    is_number = isinstance(candidate, Rational) and not isinstance(candidate, bool)
    if is_number or hasattr(candidate, "_sympy_"):  # a closed form
        candidate = sympy.sympify(candidate)
    if isinstance(candidate, sympy.Basic):
        if reason := too_large(candidate):
            return undecided(reason)
        strange = [each for each in candidate.free_symbols if not each.is_commutative]
        if strange or candidate.has(sympy.Lambda, sympy.MatrixExpr):
            words = "it holds a function or a matrix, and numbers and vectors are read"
            return not_a_statement(words)
    if isinstance(candidate, sympy.Eq):
        parts = [n for n, line in enumerate(lines) if line.lhs == candidate.lhs]
        rulings = [rule_on(part, candidate) for part in parts or range(len(lines))]
        ranked = {ruling.verdict: ruling for ruling in reversed(rulings)}
        return next(ranked[verdict] for verdict in Verdict if verdict in ranked)
    if isinstance(candidate, sympy.Expr):
        return _on_a_side(candidate, lines, rule_on)
    kind = type(candidate).__name__
    if isinstance(candidate, bool | BooleanAtom):
        advice = "If SymPy made it from an Eq, write Eq(left, right, evaluate=False)"
        kind = f"{candidate}. {advice}"
    return not_a_statement(f"a SymPy Eq or expression is needed, not {kind}")


def _on_a_side(side: sympy.Expr, lines: Sequence[sympy.Eq], rule_on: RuleOn) -> Ruling:
    """Rule on an expression: it is to be the right-hand side of one of the lines."""
    rulings = [rule_on(part, equation(line.lhs, side)) for part, line in enumerate(lines)]
    if len(rulings) == 1:
        return rulings[0]
    rulings = [_about(line, ruling) for line, ruling in zip(lines, rulings, strict=True)]
    if proofs := [ruling for ruling in rulings if ruling.verdict.is_proved]:
        return proofs[0]
    if any(ruling.verdict is Verdict.UNDECIDED for ruling in rulings):
        sides = either([text(line.lhs) for line in lines])
        return undecided(f"which line is meant? Give an Eq whose left-hand side is {sides}")
    notes = "; ".join(ruling.note for ruling in rulings)
    return replace(all_of(*rulings), note=notes)


def _on_all(candidates: tuple[Any, ...], lines: Sequence[sympy.Eq], rule_on: RuleOn) -> Ruling:
    """Rule on as many candidates as lines: each in the place of the line that it is about.

    One that is about none of them, by its left-hand side, takes the first place that is left.
    """
    if len(candidates) != len(lines):
        few = "1 line is" if len(lines) == 1 else f"{len(lines)} lines are"
        return not_a_statement(f"{few} printed, and there are {len(candidates)} here")
    sides = [line.lhs for line in lines]
    named = {each.lhs: each for each in candidates if getattr(each, "lhs", None) in sides}
    others = [each for each in candidates if getattr(each, "lhs", None) not in sides]
    rulings = []
    for part, line in enumerate(lines):
        if line.lhs not in named and not others:
            return undecided(f"nothing is said of {text(line.lhs)}")
        candidate = named[line.lhs] if line.lhs in named else others.pop(0)
        ruling = _on_one(candidate, [line], lambda _, of, part=part: rule_on(part, of))  # type: ignore[misc]
        rulings.append(_about(line, ruling) if len(lines) > 1 else ruling)
    return all_of(*rulings)


def _about(line: sympy.Eq, ruling: Ruling) -> Ruling:
    return replace(ruling, note=f"{text(line.lhs)}: {ruling.note}")


def over_read_indices(candidate: sympy.Eq, domain: Domain) -> sympy.Eq:
    """The same, with sums over indices that are read, whatever the user calls them.

    One that the domain names stays: what is summed may depend on it without showing it.
    """
    bound = {index for series in candidate.atoms(sympy.Sum) for index, *_ in series.limits}
    taken = {*SUMMATION, *sy.PARAMETERS, *sy.VECTORS, *domain.indices, *candidate.free_symbols}
    unused = [index for index in SUMMATION if not candidate.has(index)]
    return in_place(candidate, dict(zip(by_name(bound - taken), unused, strict=False)))


def strange_symbol(formula: sympy.Basic, known: Collection[sympy.Symbol]) -> str:
    """Why a symbol may be taken for another one of the same name; "" where none may be."""
    names = {symbol.name for symbol in known}
    for symbol in by_name(formula.free_symbols - {*known}):
        if symbol.name in names:
            return f"this {symbol.name} is not that of the equation: take it from its symbols"
    return ""


def unread(reason: NotExactError) -> Ruling:
    """What is ruled on a candidate that can't be read."""
    is_statement = not isinstance(reason, NotAStatementError)
    return undecided(str(reason)) if is_statement else not_a_statement(str(reason))
