"""Forces below a point load: contacts and beads inside of its cone and on it, and their variances.

Closed forms are stated here, and sums of squared weights found, case by case: Eq. 16 compares them.
"""

from collections.abc import Iterator
from functools import cache

import sympy
from force_diffusion.derivations import eq07_load_split as eq07
from force_diffusion.derivations import eq09_straight_path as eq09
from force_diffusion.derivations import eq10_branched_path as eq10
from force_diffusion.derivations import eq11_total_force as eq11
from force_diffusion.symbolic.algebra.affine import Region
from force_diffusion.symbolic.algebra.exact import FIELD, RationalFunction
from force_diffusion.symbolic.algebra.linear_forms import LinearForm
from force_diffusion.symbolic.algebra.reading import Reader
from force_diffusion.symbolic.as_printed import minus, terms
from force_diffusion.symbolic.mechanics.paths import IN_CONE
from force_diffusion.symbolic.symbols import (
    DeltaNMinus,
    DeltaNPlus,
    Dot,
    e_y,
    i,
    j,
    k,
    l,
    n,
    n_minus,
    n_plus,
    n_y,
    p,
    phi,
    q,
    sigma,
)
from force_diffusion.symbolic.variances.cases import Case, Piece, squares_by_case
from force_diffusion.symbolic.variances.variance import without_constant
from sympy import Rational

SIZES = (j, p, q)
"""What grows in the limit: l = j + p + q → ∞ at fixed j/l and (i − k)/l inside of the cone."""

# The closed forms, all proved in Eq. 16. The bead (i, j) lies p steps along n⁺ and q steps along n⁻
# below the loaded bead (k, l): inside of the cone for p, q ≥ 1, on its left leg for q = 0. They are
# written for the left half where that matters; the right half is its mirror image. Variances over
# f_load² are in units of UNIT/4, those over a mean force squared in units of UNIT.
_HALF = Rational(1, 2)
_INSIDE = 6 * l + 6 * j - 6 + phi**2
_BELOW_LOAD = _HALF * (1 + phi) ** 2
_TOP = _HALF * (1 - phi) ** 2

BEAD = (
    Piece(
        "j = 0, l = 2",
        {j: 0, p: 1, q: 1},
        Rational(11, 2) - phi + Rational(3, 2) * phi**2,
    ),
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
    Piece("j = 0, k − i = 2 − l", {j: 0, p: 1}, Rational(7, 2) - _HALF * phi + _HALF * phi**2),
    Piece("inside of the cone", {}, 3 * (l + j + k - i) - 3 + _HALF * phi**2),
)
"""Variance of the vertical component of f⁺_ij inside of the cone, over f_load²."""

_LEG = 2 * l + 2 * j - 2 + 2 * phi + phi**2

LEG = (
    Piece("j = 0, l = 1", {j: 0, p: 1}, _HALF * (1 + phi) ** 2),
    Piece("j = 0, l > 1", {j: 0}, _LEG - phi),
    Piece("j = 1, l = 2", {j: 1, p: 1}, _LEG + Rational(3, 2) - _TOP),
    Piece("j = 1, l > 2", {j: 1}, _LEG + Rational(3, 2)),
    Piece("j = l − 1 ≥ 2", {p: 1}, _LEG - _TOP),
    Piece("2 ≤ j ≤ l − 2, on a leg", {}, _LEG),
)
"""Variance of the vertical component of the contact force on a leg of the cone, over f_load²."""

_LEG_FORCE = 2 * (l - 1) + 2 * phi**2 * j + Rational(5, 2) * phi**2 + _HALF * phi**4

LEG_FORCE = (
    Piece("j = 0, l = 1", {j: 0, p: 1}, _HALF * (1 - 2 * phi + 6 * phi**2 - 2 * phi**3 + phi**4)),
    Piece("j = 0, l > 1", {j: 0}, _LEG_FORCE - _HALF * phi * (1 + phi**2)),
    Piece("j = 1, l = 2", {j: 1, p: 1}, _LEG_FORCE + Rational(3, 2) * phi - phi * _TOP),
    Piece("j = 1, l > 2", {j: 1}, _LEG_FORCE + Rational(3, 2) * phi),
    Piece("j = l − 1 ≥ 2", {p: 1}, _LEG_FORCE - phi * _TOP),
    Piece("2 ≤ j ≤ l − 2, on a leg", {}, _LEG_FORCE),
)
"""Variance of the magnitude of the contact force on a leg, over its mean squared."""

INSIDE = {j: 0, p: 1, q: 1}
BELOW = {j: 0, p: 1}
ON_LEFT_LEG = {symbol: value.xreplace({q: sympy.Integer(0)}) for symbol, value in IN_CONE.items()}

UPPER_RIGHT = eq10.branched_plus(i, j, p)
UPPER_LEFT = eq10.PRINTED.rhs.xreplace({n: q})
"""The forces f⁺_ij and f⁻_ij on a bead inside of the cone, over f_load/2n_y, to first order.

Each has one path with one branch from the loaded bead: q steps along n⁻ and p along n⁺, or the
other way round. The branch is of first order; what enters it counts at order 0, f_load/2n_y.
"""

BEAD_RESPONSE = (UPPER_RIGHT + UPPER_LEFT) / 2
"""p/f_load: the vertical component of both, n_y (f⁺ + f⁻) to first order."""

LEG_CONTACT = eq09.first_order_product(eq07.split_plus(k, l), eq09.PRINTED.rhs)
"""f⁺_ij over f_load/2n_y on the left leg: the split of the load, carried down a straight path."""

LEG_RESPONSE = (LEG_CONTACT + Dot(e_y, DeltaNPlus(i, j)) / n_y) / 2
"""Its vertical component over f_load, the contact's own direction being tilted."""

LEG_TILTS = terms(Dot(n_minus, DeltaNPlus(i, j)), minus(Dot(n_plus, DeltaNMinus(k + 1, l - 1))))


@cache
def bead_form() -> LinearForm:
    """p/f_load inside of the cone, in the radii."""
    return Reader(Region(INSIDE)).scalar(eq11.in_radii(BEAD_RESPONSE))


@cache
def leg_form() -> LinearForm:
    """p/f_load on the left leg, in the radii."""
    return Reader(Region(BELOW)).scalar(eq11.in_radii(LEG_RESPONSE).xreplace(ON_LEFT_LEG))


@cache
def bead_cases() -> tuple[Case, ...]:
    """Σ weight² of p/f_load for every bead inside of the cone."""
    return tuple(squares_by_case(without_constant(bead_form()), INSIDE, generic=3))


@cache
def contact_cases() -> tuple[Case, ...]:
    """The same of one contact's vertical force."""
    form = Reader(Region(BELOW)).scalar(eq11.in_radii(UPPER_RIGHT / 2))
    return tuple(_by_case(form))


@cache
def leg_cases() -> tuple[Case, ...]:
    """The same of the vertical force on the left leg."""
    return tuple(_by_case(leg_form()))


@cache
def leg_force_cases() -> tuple[Case, ...]:
    """The same of the magnitude of that force."""
    form = Reader(Region(BELOW)).scalar(eq11.in_radii(LEG_CONTACT).xreplace(ON_LEFT_LEG))
    return tuple(_by_case(form))


def interior() -> RationalFunction:
    """Exact variance of p/f_load in the cone's interior, in j, p and q."""
    (deep,) = (case.value for case in bead_cases() if not case.at)
    return deep * FIELD.from_sympy(sigma**2)


def covariance(piece: Piece) -> RationalFunction:
    """Twice the covariance of a bead's two contacts, for one piece of ``BEAD``.

    It is what the variances of the contacts leave of the bead's.
    """

    def put_in(other: Piece, coordinates: dict[sympy.Symbol, sympy.Expr]) -> RationalFunction:
        value = FIELD.from_sympy(other.expression.xreplace(IN_CONE).xreplace(coordinates))
        return value.substitute({s: FIELD.constant(at) for s, at in piece.at.items()})

    def contact(at: dict[sympy.Symbol, int]) -> Piece:
        return next(found for found in CONTACT if found.at.items() <= at.items())

    swapped = {p: q, q: p}  # f⁻ is the mirror image of f⁺
    mirrored = {swapped.get(symbol, symbol): value for symbol, value in piece.at.items()}
    left, right = put_in(contact(mirrored), swapped), put_in(contact(piece.at), {})
    return put_in(piece, {}) - left - right


def _by_case(form: LinearForm) -> Iterator[Case]:
    return squares_by_case(without_constant(form), BELOW, generic=2)
