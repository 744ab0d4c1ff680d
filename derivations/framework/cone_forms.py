"""Closed forms of the response to a point load (Eq. 16), for every contact and bead of its cone.

The bead (i, j) lies p steps along n⁺ and q steps along n⁻ below the loaded bead (k, l): inside
of the cone for p, q ≥ 1, on its left leg for q = 0. All forms are proved in Eq. 16. They are
written once, for the left half where that matters; the right half is the mirror image.
Variances over f_load² are in units of ¼ (σ/r)²/(1−φ²)², those over a mean force squared in
units of (σ/r)²/(1−φ²)².
"""

from force_diffusion.symbolic.algebra.exact import FIELD, RationalFunction
from force_diffusion.symbolic.mechanics.paths import IN_CONE
from force_diffusion.symbolic.symbols import i, j, k, l, p, phi, q
from force_diffusion.symbolic.variances.cases import Piece
from sympy import Expr, Rational, Symbol

HALF = Rational(1, 2)
_INSIDE = 6 * l + 6 * j - 6 + phi**2
_BELOW_LOAD = HALF * (1 + phi) ** 2
_TOP = HALF * (1 - phi) ** 2

BEAD = (
    Piece("j = 0, l = 2", {j: 0, p: 1, q: 1}, Rational(11, 2) - phi + Rational(3, 2) * phi**2),
    Piece("j = 0, beside the left leg", {j: 0, q: 1}, 6 * l - 8 - phi + phi**2),
    Piece("j = 0, beside the right leg", {j: 0, p: 1}, 6 * l - 8 - phi + phi**2),
    Piece("j = 0, further inside", {j: 0}, 6 * l - 9 + phi**2),
    Piece("j = 1, l = 3", {j: 1, p: 1, q: 1}, 6 * l + 4 + phi**2 + _BELOW_LOAD),
    Piece("j = 1, l > 3", {j: 1}, 6 * l + 4 + phi**2),
    Piece("j = 2, l = 4", {j: 2, p: 1, q: 1}, 6 * l + Rational(9, 2) + phi**2 + _BELOW_LOAD),
    Piece("j = 2, l > 4", {j: 2}, 6 * l + Rational(9, 2) + phi**2),
    Piece("i = k, j = l − 2 ≥ 3", {p: 1, q: 1}, _INSIDE + _BELOW_LOAD),
    Piece("j ≥ 3, every other bead inside of the cone", {}, _INSIDE),
)
"""Variance of the vertical force that a bead gets from both upper contacts, over f_load²."""

CONTACT = (
    Piece("j = 0, k − i = 2 − l", {j: 0, p: 1}, Rational(7, 2) - HALF * phi + HALF * phi**2),
    Piece("inside of the cone", {}, 3 * (l + j + k - i) - 3 + HALF * phi**2),
)
"""Variance of the vertical component of f⁺_ij inside of the cone, over f_load²."""

_LEG = 2 * l + 2 * j - 2 + 2 * phi + phi**2

LEG = (
    Piece("j = 0, l = 1", {j: 0, p: 1}, HALF * (1 + phi) ** 2),
    Piece("j = 0, l > 1", {j: 0}, _LEG - phi),
    Piece("j = 1, l = 2", {j: 1, p: 1}, _LEG + Rational(3, 2) - _TOP),
    Piece("j = 1, l > 2", {j: 1}, _LEG + Rational(3, 2)),
    Piece("j = l − 1 ≥ 2", {p: 1}, _LEG - _TOP),
    Piece("2 ≤ j ≤ l − 2, on a leg", {}, _LEG),
)
"""Variance of the vertical component of the contact force on a leg of the cone, over f_load²."""

_LEG_FORCE = 2 * (l - 1) + 2 * phi**2 * j + Rational(5, 2) * phi**2 + HALF * phi**4

LEG_FORCE = (
    Piece("j = 0, l = 1", {j: 0, p: 1}, HALF * (1 - 2 * phi + 6 * phi**2 - 2 * phi**3 + phi**4)),
    Piece("j = 0, l > 1", {j: 0}, _LEG_FORCE - HALF * phi * (1 + phi**2)),
    Piece("j = 1, l = 2", {j: 1, p: 1}, _LEG_FORCE + Rational(3, 2) * phi - phi * _TOP),
    Piece("j = 1, l > 2", {j: 1}, _LEG_FORCE + Rational(3, 2) * phi),
    Piece("j = l − 1 ≥ 2", {p: 1}, _LEG_FORCE - phi * _TOP),
    Piece("2 ≤ j ≤ l − 2, on a leg", {}, _LEG_FORCE),
)
"""Variance of the magnitude of the contact force on a leg, over its mean squared."""


def covariance(piece: Piece) -> RationalFunction:
    """Twice the covariance of a bead's two contacts, for one piece of ``BEAD``.

    It is what the variances of the contacts leave of the bead's.
    """

    def put_in(other: Piece, coordinates: dict[Symbol, Expr]) -> RationalFunction:
        value = FIELD.from_sympy(other.expression.xreplace(IN_CONE).xreplace(coordinates))
        return value.substitute({s: FIELD.constant(at) for s, at in piece.at.items()})

    def contact(at: dict[Symbol, int]) -> Piece:
        return next(found for found in CONTACT if found.at.items() <= at.items())

    swapped = {p: q, q: p}  # f⁻ is the mirror image of f⁺
    mirrored = {swapped.get(symbol, symbol): value for symbol, value in piece.at.items()}
    left, right = put_in(contact(mirrored), swapped), put_in(contact(piece.at), {})
    return put_in(piece, {}) - left - right
