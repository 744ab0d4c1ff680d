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
from force_diffusion.symbolic import symbols as sy
from force_diffusion.symbolic.algebra import affine
from force_diffusion.symbolic.algebra.exact import FIELD, RationalFunction, sum_polynomial
from force_diffusion.symbolic.kernel.theorem import NotProvedError
from force_diffusion.symbolic.kernel.where import (
    BULK,
    BULK_TILTED,
    SURFACE,
    SURFACE_TILTED,
    Where,
)
from force_diffusion.symbolic.printing.text import text

Value = Callable[[sy.Moment, Where], RationalFunction]
"""Works out a moment to leading order."""

_R, _PHI, _TWO = FIELD.generator(sy.r), FIELD.generator(sy.phi), FIELD.constant(2)
_SQUARE = FIELD.one - _PHI**2
_UP = {sy.n_plus: FIELD.one, sy.n_minus: FIELD.one, sy.e_y: FIELD.one / FIELD.generator(sy.n_y)}
"""What a displacement with the line sum 1 along both n⁺ and n⁻ is along a vector."""
_ALIKE = (SURFACE, BULK, SURFACE_TILTED, BULK_TILTED)
"""Loads that are alike along a layer and do not fluctuate."""


def shift(expression: sympy.Expr, where: Where, value: Value) -> RationalFunction:
    """The mean of what is linear in one force or displacement, less its ordered value.

    Raises:
        NotProvedError: it is not of one of them, or the loads differ along a layer.
    """
    factor, held = expression.as_independent(sy.SiteFunction, as_Add=False)
    if isinstance(expression, sympy.Add):
        return sum((shift(one, where, value) for one in expression.args), FIELD.zero)
    if not expression.has(sy.SiteFunction):
        _known(expression)
        return FIELD.zero
    _known(factor)
    scale = FIELD.from_sympy(factor)
    if isinstance(held, sy.ForcePlus | sy.ForceMinus):
        return scale * _force(held, where, value)
    if isinstance(held, sy.Dot) and isinstance(held.args[1], sy.DeltaX) and held.args[0] in _UP:
        return scale * _UP[held.args[0]] * _line_sum(held.args[1], where, value)
    raise NotProvedError(f"the mean of {text(held)} at second order is not known")


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


def _force(force: sympy.Expr, where: Where, value: Value) -> RationalFunction:
    if where.loading not in _ALIKE:
        raise NotProvedError("the loads are not shown to be alike along a layer")
    across, layer = force.args
    branch = 1 if isinstance(force, sy.ForcePlus) else -1
    other = (sy.ForceMinus if branch == 1 else sy.ForcePlus)(across, layer)
    ordered = value(sy.Mean(force), where)
    tilt, beside = _tilt(branch, across, layer), _tilt(-branch, across, layer)
    radii = sy.DeltaR(across, layer) + sy.DeltaR(across + branch, layer + 1)
    carried = value(sy.Mean(other), where)
    square = value(sy.Variance(tilt), where)
    along = -square / (_TWO * _SQUARE)
    turned = along - value(sy.Covariance(tilt, radii), where) / (_TWO * _R)
    products = _PHI * value(sy.Covariance(tilt, force), where)
    products = products - value(sy.Covariance(beside, other), where)
    units = (_PHI * carried - ordered) * along + (_PHI * ordered - carried) * turned
    return (products + units) / _SQUARE
