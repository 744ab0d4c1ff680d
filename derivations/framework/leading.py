"""The leading orders of a closed form: its highest powers of M at fixed z = j/M."""

from collections.abc import Iterable, Iterator
from numbers import Integral

import sympy
from force_diffusion.numeric.arithmetic.errors import ArgumentError, quoted
from force_diffusion.symbolic import sets
from force_diffusion.symbolic import symbols as sy
from force_diffusion.symbolic.algebra.exact import FIELD, RationalFunction
from force_diffusion.symbolic.piecewise import Piece, Relations
from force_diffusion.symbolic.quotients import factored

_ORDERS = 100


def leading_orders(pieces: Iterable[Piece], domain: Relations, orders: int) -> sympy.Expr:
    """The highest powers of M at fixed z, as a sum.

    Args:
        pieces: formulas in M and j, on parts of a domain.
        domain: its own relations.
        orders: how many of them.

    Raises:
        ArgumentError: there are none at fixed z, they differ on several parts, or ``orders`` is
            not a whole number from 1 to 100.
    """
    if not isinstance(orders, Integral) or not 1 <= orders <= _ORDERS:
        raise ArgumentError(f"orders = {quoted(orders)}: must be whole, from 1 to {_ORDERS}")
    inside = [piece for piece in pieces if any(map(_reaches_inside, piece.where))]
    if not inside or not _reaches_inside(domain):
        raise ArgumentError("leading orders are those of a form in M and j, at fixed z = j/M")
    layer = FIELD.generator(sy.z) * FIELD.generator(sy.M)
    domains = {
        tuple(_highest(piece.value.substitute({sy.j: layer}), orders)): piece.domain
        for piece in reversed(inside)
    }
    if len(domains) > 1:
        several = ", and for ".join([*domains.values()][:2])
        raise ArgumentError(
            f"its leading orders differ, as for {several}. Say which part is meant, as in "
            "leading(1, N >= 2)"
        )
    return sympy.Add(*next(iter(domains)))


def _reaches_inside(part: Iterable[sympy.Basic]) -> bool:
    """Whether M → ∞ at fixed z = j/M, 0 < z < 1, stays in a part for some other indices."""
    for relation in part:
        form, equation = sets.condition(relation)
        at_base, at_surface = (form[0].get(sy.M, 0) + z * form[0].get(sy.j, 0) for z in (0, 1))
        is_fixed = at_base == at_surface == 0
        if not is_fixed and (equation or min(at_base, at_surface) < 0):
            return False
    return True


def _highest(value: RationalFunction, orders: int) -> Iterator[sympy.Expr]:
    """The highest powers of M of a function, by division of its numerator."""
    height = FIELD.generator(sy.M)
    divisor = value.domain.polynomial(value.denominator)
    below = divisor.coefficients(sy.M)
    rest = value.domain.polynomial(value.numerator) * height**orders  # so that no power is negative
    for _ in range(orders):
        if rest.is_zero():
            return
        above = rest.coefficients(sy.M)
        term = above[-1] / below[-1] * height ** (len(above) - len(below))
        yield factored(term / height**orders)
        rest = rest - term * divisor
