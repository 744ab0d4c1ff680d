"""Sums by SymPy, each accepted only with its telescoping certificate."""

import sympy

from symbolic.exact import FIELD


class SumRefusedError(ValueError):
    """What SymPy returned for a sum does not telescope."""


def certified_sum(
    term: sympy.Expr, index: sympy.Symbol, low: sympy.Expr, high: sympy.Expr
) -> sympy.Expr:
    """Σ term for low ≤ index ≤ high, by ``Sum.doit``, checked in the exact field.

    With S(n) the sum up to n, S(n) − S(n−1) must be the term at n and S(low−1) must be zero:
    the two together are a proof by induction.

    Raises:
        SumRefusedError: when either fails.
    """
    end = index  # the bound name is free outside of the sum, so it can serve as the upper end
    bound = sympy.Dummy("bound", integer=True)
    # term by term: of a whole polynomial SymPy first asks, with solve, whether it telescopes
    monomials = sympy.Add.make_args(sympy.expand(term.xreplace({index: bound})))
    partial = sympy.Add(*(sympy.Sum(one, (bound, low, end)).doit() for one in monomials))
    telescopes = FIELD.from_sympy(partial - partial.xreplace({index: index - 1}) - term)
    starts = FIELD.from_sympy(partial.xreplace({index: low - 1}))
    if not (telescopes.is_zero() and starts.is_zero()):
        raise SumRefusedError(f"the sum of {term} over {index} fails its certificate")
    return partial.xreplace({index: high})
