"""Sums by SymPy, each accepted only with its telescoping certificate."""

from functools import cache

import sympy
from force_diffusion.symbolic.algebra.exact import FIELD


class SumRefusedError(ValueError):
    """What SymPy returned for a sum does not telescope."""


@cache
def _sum_up_to(power: sympy.Expr, index: sympy.Symbol, low: sympy.Expr) -> sympy.Expr:
    """Σ from low to the index itself, whose name is free outside of the sum."""
    bound = sympy.Dummy("bound", integer=True)
    return sympy.Sum(power.xreplace({index: bound}), (bound, low, index)).doit()


@cache
def partial_sum(term: sympy.Expr, index: sympy.Symbol, low: sympy.Expr) -> sympy.Expr:
    """S(n) = Σ term from low up to n, by ``Sum.doit``, with the index's name for n.

    S(n) − S(n−1) must be the term at n and S(low−1) must be zero, in the exact field: the two
    together are a proof by induction.

    Raises:
        SumRefusedError: when either fails.
    """
    # term by term: of a whole polynomial SymPy first asks, with solve, whether it telescopes
    monomials = (
        one.as_independent(index, as_Add=False) for one in sympy.Add.make_args(sympy.expand(term))
    )
    partial = sympy.Add(*(factor * _sum_up_to(power, index, low) for factor, power in monomials))
    telescopes = FIELD.from_sympy(partial - partial.xreplace({index: index - 1}) - term)
    starts = FIELD.from_sympy(partial.xreplace({index: low - 1}))
    if not (telescopes.is_zero() and starts.is_zero()):
        raise SumRefusedError(f"the sum of {term} over {index} fails its certificate")
    return partial


def certified_sum(
    term: sympy.Expr, index: sympy.Symbol, low: sympy.Expr, high: sympy.Expr
) -> sympy.Expr:
    """Σ term for low ≤ index ≤ high, by :func:`partial_sum`; zero when high = low − 1."""
    return partial_sum(term, index, low).xreplace({index: high})


def carried_out(expression: sympy.Expr) -> sympy.Expr:
    """An expression with every sum in closed form."""
    return expression.replace(
        sympy.Sum, lambda term, limits: certified_sum(carried_out(term), *limits)
    )
