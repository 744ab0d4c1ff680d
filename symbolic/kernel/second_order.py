"""Means at second order in the deviations of the radii: what contacts and balance say of them.

A quantity is X + εX₁ + ε²X₂. X₁ is linear in the radii and has mean zero; the mean of X₂ is asked
for. It follows from means of products of two X₁, which are covariances:

* The centres of a contact along n⁺ are 2r n⁺ + ε(ρ n⁺ + 2r δn⁺) + ε² d₂ apart, ρ being the sum of
  both δr, and as far as the radii together. With δn⁺ = ν b⁻ and |b⁻|² = 1/(1 − φ²) order ε² says
  n⁺·d₂ = −r ν²/(1 − φ²). All contacts of a layer are alike in the mean.
* Its unit vector has at order ε² the components n⁺·d₂/2r and (n⁻·d₂ − νρ)/2r.
* A layer passes on the loads above it, which do not fluctuate, so that the mean of force times unit
  vector, f⁺N⁺ + f⁻N⁻ for each bead, stays that of the ordered packing. Along b⁺ it gives ⟨f⁺⟩.
"""

from collections.abc import Callable

import sympy

from .. import symbols as sy
from ..algebra import affine
from ..algebra.exact import FIELD, RationalFunction, sum_polynomial
from ..printing.text import text
from .theorem import Facts, NotProvedError, said_of
from .where import (
    BULK,
    BULK_TILTED,
    SURFACE,
    SURFACE_TILTED,
    Where,
)

Value = Callable[[sy.Moment, Where], RationalFunction]
"""Works out a moment to leading order."""

_R, _PHI, _TWO = FIELD.generator(sy.r), FIELD.generator(sy.phi), FIELD.constant(2)
_SQUARE = FIELD.one - _PHI**2
_UP = {sy.n_plus: FIELD.one, sy.n_minus: FIELD.one, sy.e_y: FIELD.one / FIELD.generator(sy.n_y)}
"""What a displacement with the line sum 1 along both n⁺ and n⁻ is along a vector."""
_ALIKE = (SURFACE, BULK, SURFACE_TILTED, BULK_TILTED)
"""Loads that are alike along a layer and do not fluctuate."""


def shift(expression: sympy.Expr, where: Where, value: Value, facts: Facts) -> RationalFunction:
    """The mean of what is linear in one force, push or displacement, less its ordered value.

    A mean of a force that a fact states is put in.

    Raises:
        NotProvedError: it is not of one of them, or the loads differ along a layer.
    """
    factor, held = expression.as_independent(sy.SiteFunction, as_Add=False)
    if isinstance(expression, sympy.Add):
        return sum((shift(one, where, value, facts) for one in expression.args), FIELD.zero)
    if not expression.has(sy.SiteFunction):
        _known(expression)
        return FIELD.zero
    _known(factor)
    scale = FIELD.from_sympy(factor)
    if isinstance(held, sy.ForcePlus | sy.ForceMinus):
        return scale * _force(held, where, value, facts)
    if (pushed := pushes(held)) is not None:
        both = sum((turned(pushed, side, where, value) for side in (1, -1)), FIELD.zero)
        return scale * FIELD.generator(sy.n_y) * (_force(pushed, where, value, facts) + both)
    if isinstance(held, sy.Dot) and isinstance(held.args[1], sy.DeltaX) and held.args[0] in _UP:
        return scale * _UP[held.args[0]] * _line_sum(held.args[1], where, value)
    raise NotProvedError(f"the mean of {text(held)} at second order is not known")


def pushes(product: sympy.Expr) -> sympy.Expr | None:
    """The contact force whose vertical component f⁺(n_y + e_y·δn⁺), or that of f⁻, this is."""
    for force, other in (product.args, product.args[::-1]) if len(product.args) == 2 else ():
        turn = sy.TURNS.get(type(force))
        unit = turn and {sy.n_y, sy.Dot(sy.e_y, turn(*force.args))}
        if unit and isinstance(other, sympy.Add) and {*other.args} == unit:
            return force
    return None


def _known(factor: sympy.Expr) -> None:
    """Refuse a factor that may depend on the radii."""
    if factor.free_symbols - {*sy.INDICES, *sy.PARAMETERS} | ({sy.epsilon} & factor.free_symbols):
        raise NotProvedError(f"whether {text(factor)} depends on the radii is not known")


def _tilt(branch: int, across: sympy.Expr, layer: sympy.Expr) -> sympy.Expr:
    """ν: all that a change of direction holds."""
    if branch == 1:
        return sy.Dot(sy.n_minus, sy.DeltaNPlus(across, layer))
    return sy.Dot(sy.n_plus, sy.DeltaNMinus(across, layer))


def _line_sum(bead: sy.DeltaX, where: Where, value: Value) -> RationalFunction:
    """⟨n^±·δx⟩: the steps of all contacts from the base up to a bead, which lies above it."""
    layer = sympy.expand(bead.args[1].xreplace(where.solved))
    if not where.nonnegative(affine.shifted(affine.from_sympy(layer), -1)):
        raise NotProvedError(f"{text(bead)} is not shown to lie above the base")
    squares = [
        value(sy.Variance(_tilt(1, sy.i, sy.j)), Where.of(domain))
        for domain in (sympy.Eq(sy.j, 0), sy.j >= 1)
    ]
    high = FIELD.from_sympy(layer) - FIELD.one
    return -_R * (squares[0] + sum_polynomial(squares[1], sy.j, FIELD.one, high)) / _SQUARE


def _force(force: sympy.Expr, where: Where, value: Value, facts: Facts) -> RationalFunction:
    told = said_of(sy.Shift(force), facts, where)
    if told is not None:
        return FIELD.from_sympy(told.xreplace(where.solved))
    if where.loading not in _ALIKE:
        raise NotProvedError("the loads are not shown to be alike along a layer")
    branch = 1 if isinstance(force, sy.ForcePlus) else -1
    other = (sy.ForceMinus if branch == 1 else sy.ForcePlus)(*force.args)
    return -turned(force, branch, where, value) - turned(other, branch, where, value)


def turned(force: sympy.Expr, side: int, where: Where, value: Value) -> RationalFunction:
    """⟨force times unit vector⟩ along b⁺ (1) or b⁻ (−1) at second order, less ⟨force⟩ along it.

    The unit vector is n + ε ν b + ε² u₂, b the reciprocal vector of the other branch.
    """
    across, layer = force.args
    branch = 1 if isinstance(force, sy.ForcePlus) else -1
    tilt = _tilt(branch, across, layer)
    kept, ordered = value(sy.Covariance(tilt, force), where), value(sy.Mean(force), where)
    kept = kept * (-_PHI if side == branch else FIELD.one) / _SQUARE
    if ordered.is_zero():
        return kept
    radii = sy.DeltaR(across, layer) + sy.DeltaR(across + branch, layer + 1)
    along = -value(sy.Variance(tilt), where) / (_TWO * _SQUARE)  # n·u₂
    beside = along - value(sy.Covariance(tilt, radii), where) / (_TWO * _R)  # of the other n
    own, other = (along, beside) if side == branch else (beside, along)
    return kept + ordered * (own - _PHI * other) / _SQUARE
