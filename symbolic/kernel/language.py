"""The statements that can be decided: what a candidate may hold so that *proved* has a meaning.

A statement is read over one domain: 0 < z < 1, −½ < φ < ½ with n_x, n_y > 0 to match, positive
radius, spacing, σ, loads and M, and whole indices in their region. Everything in it must have a
value everywhere there. What does not, or is not shown to, is outside: it can be refuted by
explicit values, and it is never proved.
"""

from collections.abc import Collection, Iterator
from itertools import chain

import sympy
from force_diffusion.symbolic import symbols as sy
from force_diffusion.symbolic.algebra.signs import sign
from force_diffusion.symbolic.printing.text import text

SUMMATION = (sy.m, sy.n)
"""The indices that a candidate may sum over: no derivation puts anything in for them."""

_FORCES = (sy.ForcePlus, sy.ForceMinus)


def unreadable(candidate: sympy.Eq, printed: Collection[sympy.Eq]) -> str:
    """Why a candidate for one of the printed equations has no meaning; "" when it has."""
    free = set().union(*(line.free_symbols for line in printed)) | candidate.free_symbols
    return next(chain(_zeros(candidate), _sums(candidate, free), _indices(candidate)), "")


def without_value(candidate: sympy.Eq) -> str:
    """Why it is not shown to have a value everywhere; "" when it is."""
    return next(_values(candidate), "")


def _zeros(candidate: sympy.Eq) -> Iterator[str]:
    divided = any(p.base == 0 and p.exp.is_negative for p in candidate.atoms(sympy.Pow))
    if divided or candidate.has(sympy.zoo, sympy.nan, sympy.oo, -sympy.oo):
        yield "it holds a division by zero"


def _values(candidate: sympy.Eq) -> Iterator[str]:
    # in an unevaluated tree two equal powers are one node, and a/a keeps its divisor
    for power in sorted(candidate.atoms(sympy.Pow), key=str):
        if not isinstance(power.exp, sympy.Rational):
            yield f"{text(power)} has an exponent that is no number"
        elif power.exp.is_Integer and power.exp.is_negative:
            if not isinstance(power.base, _FORCES) and not _has_one_sign(power.base):
                yield f"the divisor {text(power.base)} is not shown to differ from zero"
        elif not power.exp.is_Integer and _has_one_sign(power.base) != 1:
            yield f"{text(power.base)}, of which a root is taken, is not shown to be positive"


def _has_one_sign(base: sympy.Expr) -> int:
    """The sign, with j between 0 and M where both stand."""
    below = sympy.Dummy("below", positive=True)
    image = {sy.M: sy.j + below} if base.has(sy.j) and base.has(sy.M) else {}
    return sign(base.xreplace(image), (sy.j, below))


def _sums(candidate: sympy.Basic, free: Collection[sympy.Basic]) -> Iterator[str]:
    for series in candidate.atoms(sympy.Sum):
        bound = [limit[0] for limit in series.limits]
        inner = {limit[0] for one in series.function.atoms(sympy.Sum) for limit in one.limits}
        for place, index in enumerate(bound):
            if index not in SUMMATION:
                names = " or ".join(map(text, SUMMATION))
                yield f"a sum over {text(index)}: write it over {names}"
            elif index in free:
                yield f"{text(index)} is summed over and stands for itself as well"
            elif index in inner or index in bound[:place] or _in_own_bounds(series, index):
                yield f"two sums over {text(index)}, one inside of the other"


def _in_own_bounds(series: sympy.Sum, index: sympy.Symbol) -> bool:
    return any(end.has(index) for limit in series.limits if limit[0] == index for end in limit[1:])


def _indices(candidate: sympy.Eq) -> Iterator[str]:
    summed = {limit[0] for one in candidate.atoms(sympy.Sum) for limit in one.limits}
    for force in sorted(candidate.atoms(*_FORCES), key=str):
        if force.free_symbols & summed:
            yield f"the force {text(force)} stands in a sum"
