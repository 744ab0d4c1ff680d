"""Contacts and force balance to second order in the strength ε, by SymPy, for a contact along n⁺.

Its first order is Eqs. 4 and 5: the separation of the two centres changes by d₁ = ρ n⁺ + 2r δn⁺,
where ρ is the sum of both δr, and δn⁺ = ν b⁻ with ν = n⁻·δn⁺.
"""

from functools import cache

import sympy

from ..notation import Symbol
from ..symbols import epsilon, n_x, n_y, phi, r, t
from .contacts import radii
from .lattice import N_PLUS

B_PLUS = sympy.ImmutableMatrix([1 / (2 * n_x), 1 / (2 * n_y)])
B_MINUS = sympy.ImmutableMatrix([-1 / (2 * n_x), 1 / (2 * n_y)])

tilt = Symbol("nu", r"\nu", "ν", real=True)  # n⁻·δn⁺

# components along n⁺ and n⁻ of the separation's second order, and of the unit vector's
d_plus = Symbol("d_plus", r"\hat{\mathbf{n}}^{+}\!\cdot\mathbf{d}_{2}", "n⁺·d₂", real=True)
d_minus = Symbol("d_minus", r"\hat{\mathbf{n}}^{-}\!\cdot\mathbf{d}_{2}", "n⁻·d₂", real=True)
u_plus = Symbol("u_plus", r"\hat{\mathbf{n}}^{+}\!\cdot\mathbf{u}_{2}", "n⁺·u₂", real=True)
u_minus = Symbol("u_minus", r"\hat{\mathbf{n}}^{-}\!\cdot\mathbf{u}_{2}", "n⁻·u₂", real=True)
# the force over its ordered value is 1 + εα₁ + ε²α₂
alpha_1 = Symbol("alpha_1", r"\alpha_{1}", "α₁", real=True)
alpha_2 = Symbol("alpha_2", r"\alpha_{2}", "α₂", real=True)

# means over the ensemble
mean_square = Symbol("V", r"\langle\nu^2\rangle", "⟨ν²⟩", real=True)
with_radii = Symbol("C_rho", r"\langle\nu\rho\rangle", "⟨νρ⟩", real=True)
with_force = Symbol("C_alpha", r"\langle\nu\alpha_{1}\rangle", "⟨να₁⟩", real=True)
with_other = Symbol("C_other", r"\langle\nu^{-}\alpha_{1}^{-}\rangle", "⟨ν⁻α₁⁻⟩", real=True)
mean_other = Symbol("A_other", r"\langle\alpha_{2}^{-}\rangle", "⟨α₂⁻⟩", real=True)
mean_force = Symbol("A", r"\langle\alpha_{2}\rangle", "⟨α₂⟩", real=True)


def _order_2(expression: sympy.Expr) -> sympy.Expr:
    """The coefficient of ε²."""
    return sympy.diff(expression, epsilon, 2).subs(epsilon, 0) / 2


def _separation() -> sympy.ImmutableMatrix:
    first = radii * N_PLUS + 2 * r * tilt * B_MINUS
    return 2 * r * N_PLUS + epsilon * first + epsilon**2 * (d_plus * B_PLUS + d_minus * B_MINUS)


@cache
def constraint() -> sympy.Expr:
    """Order ε² of |separation|² − (sum of the radii)², which has to vanish."""
    apart = _separation()
    return _order_2(apart.dot(apart) - (2 * r + epsilon * radii) ** 2)


@cache
def unit_vector() -> sympy.ImmutableMatrix:
    """Order ε² of the contact's unit vector, in Cartesian components."""
    return sympy.ImmutableMatrix((_separation() / (2 * r + epsilon * radii)).applyfunc(_order_2))


@cache
def momentum() -> sympy.ImmutableMatrix:
    """Order ε² of force times unit vector, over the ordered force, in Cartesian components."""
    unit = N_PLUS + epsilon * tilt * B_MINUS + epsilon**2 * (u_plus * B_PLUS + u_minus * B_MINUS)
    force = 1 + epsilon * alpha_1 + epsilon**2 * alpha_2
    return sympy.ImmutableMatrix((force * unit).applyfunc(_order_2))


STEP = -r * tilt**2 / (1 - phi**2)
"""n⁺·d₂, which the constraint fixes: −r |δn|²."""

TURN: tuple[sympy.Expr, sympy.Expr] = (d_plus / (2 * r), (d_minus - tilt * radii) / (2 * r))
"""n⁺·u₂ and n⁻·u₂, from the unit vector."""

SETTLED = STEP.xreplace({tilt**2: mean_square})
"""⟨n^±·d₂⟩: on average both line sums of a bead lie this much above those of the layer below."""

LAYER = SETTLED / (r * (1 + phi))
"""What that adds to the mean height of a layer, in units of the ordered one, 2r n_y."""


@cache
def _mean_momentum() -> sympy.ImmutableMatrix:
    """Mean momentum of a contact at order ε², in Cartesian components."""
    means = {
        tilt * alpha_1: with_force,
        tilt * radii: with_radii,
        alpha_2: mean_force,
        d_plus: SETTLED,
        d_minus: SETTLED,
    }
    turned = {u_plus: TURN[0], u_minus: TURN[1]}
    return momentum().applyfunc(lambda part: sympy.expand(part.xreplace(turned)).subs(means))


def vertical_balance() -> sympy.Expr:
    """Mean vertical momentum of a contact at order ε², which vanishes in every layer.

    The loads fix the mean vertical force that passes through a layer; both branches carry the same.
    """
    return _mean_momentum()[1]


FORCE = (mean_square / (1 - phi**2) + with_radii / (2 * r) - with_force) / (1 + phi)
"""⟨α₂⟩ from the vertical balance, in means of products of first-order quantities."""


def balance_along_b() -> sympy.Expr:
    """Mean momentum of both contacts of a bead along b⁺ at order ε², over L⁺; it vanishes, too.

    The ordered forces are L⁺ and L⁻ = t L⁺. A contact along n⁻ is the mirror image of one along n⁺,
    with forces of its own.
    """
    x, y = _mean_momentum().xreplace({with_force: with_other, mean_force: mean_other})
    return B_PLUS.dot(_mean_momentum() + t * sympy.ImmutableMatrix([-x, y]))


_OWN = SETTLED / (2 * r)
"""⟨n⁺·u₂⟩"""
_OTHER = (SETTLED - with_radii) / (2 * r)
"""⟨n⁻·u₂⟩"""
FORCE_AT_ANGLE = (phi * with_force - t * with_other - (1 - phi * t) * _OWN + (phi - t) * _OTHER) / (
    1 - phi**2
)
"""⟨α₂⟩ of f⁺ from the balance along b⁺."""


with_both = Symbol("C_force_radii", r"\langle\alpha_{1}\rho\rangle", "⟨α₁ρ⟩", real=True)


@cache
def contact_moment() -> sympy.ImmutableMatrix:
    """Order ε² of f ℓ N_x², f ℓ N_y² and f ℓ N_x N_y, ℓ the length, over their ordered values."""
    unit = N_PLUS + epsilon * tilt * B_MINUS + epsilon**2 * (u_plus * B_PLUS + u_minus * B_MINUS)
    force = 1 + epsilon * alpha_1 + epsilon**2 * alpha_2
    length = 1 + epsilon * radii / (2 * r)
    return sympy.ImmutableMatrix(
        [
            _order_2(force * length * unit[a] * unit[b]) / (N_PLUS[a] * N_PLUS[b])
            for a, b in ((0, 0), (1, 1), (0, 1))
        ]
    )


def mean_of(expression: sympy.Expr, force: sympy.Expr = FORCE) -> sympy.Expr:
    """A mean at order ε², with ⟨α₂⟩ and ⟨u₂⟩ put in, in means of products of first order."""
    turned = expression.xreplace({u_plus: TURN[0], u_minus: TURN[1]})
    means = {
        tilt * alpha_1: with_force,
        tilt * radii: with_radii,
        alpha_1 * radii: with_both,
        tilt**2: mean_square,
        alpha_2: force,
        d_plus: SETTLED,
        d_minus: SETTLED,
    }
    return sympy.expand(turned).subs(means)
