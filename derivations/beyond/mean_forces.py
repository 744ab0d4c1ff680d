"""What Eqs. B5 and B6 have in common: the mean force of a layer, from three covariances."""

from collections.abc import Callable, Collection, Mapping
from fractions import Fraction
from functools import cache

import sympy
from force_diffusion.derivations import eq11_total_force as eq11
from force_diffusion.derivations.beyond import t4_second_order as t4
from force_diffusion.derivations.beyond.means import decide_in_field
from force_diffusion.derivations.framework.follows import Decide
from force_diffusion.derivations.framework.record import Search
from force_diffusion.derivations.witnesses import second_order as witnesses
from force_diffusion.symbolic.algebra.affine import Region
from force_diffusion.symbolic.algebra.exact import FIELD, RationalFunction
from force_diffusion.symbolic.as_printed import terms
from force_diffusion.symbolic.kernel.decisions import (
    Ruling,
    decide_identity,
    from_test,
    undecided,
)
from force_diffusion.symbolic.mechanics import second_order
from force_diffusion.symbolic.mechanics.second_order import (
    FORCE,
    mean_force,
    mean_square,
    with_both,
    with_force,
    with_radii,
)
from force_diffusion.symbolic.printing.text import text
from force_diffusion.symbolic.symbols import DeltaR, M, i, j, phi, r, sigma, z
from force_diffusion.symbolic.variances.means import covariance
from force_diffusion.symbolic.variances.orders import compare_leading_order
from force_diffusion.symbolic.variances.variance import ClosedForm, by_layer, leading

SUM_OF_RADII = DeltaR(i, j) + DeltaR(i + 1, j + 1)
"""ρ of the contact above (i, j) along n⁺."""


def combined(
    expression: sympy.Expr, known: Mapping[sympy.Symbol, RationalFunction]
) -> RationalFunction:
    """A linear combination of means, each in closed form."""
    total = FIELD.zero
    for symbol, found in known.items():
        total = total + FIELD.from_sympy(sympy.diff(expression, symbol)) * found
    return total.reduced()


def known(
    force: sympy.Expr,
    at: dict[sympy.Symbol, sympy.Expr],
    region: Region,
    needed: Collection[sympy.Basic],
) -> dict[sympy.Symbol, RationalFunction]:
    """Means of products of two first-order quantities of a contact; ``force`` is f⁺ in δr."""
    nu, rho, alpha = (e.xreplace(at) for e in (eq11.in_radii(t4.TILT), SUM_OF_RADII, force - 1))
    products = {
        mean_square: (nu, nu),
        with_radii: (nu, rho),
        with_force: (nu, alpha),
        with_both: (alpha, rho),
    }
    return {mean: covariance(*both, region) for mean, both in products.items() if mean in needed}


@cache
def forms_of(part: sympy.Expr, force: sympy.Expr) -> dict[str, ClosedForm]:
    """A combination of these means, in closed form at every layer."""
    needed = part.free_symbols
    return by_layer(lambda at, region: combined(part, known(force, at, region, needed)))


def mean_forms(force: sympy.Expr) -> dict[str, ClosedForm]:
    """⟨f⟩ over its ordered value less 1; ``force`` is f⁺ to first order in the radii."""
    return forms_of(FORCE, force)


def decided(forms: Callable[[], dict[str, ClosedForm]], subject: sympy.Symbol) -> Decide:
    """The candidate equals the mean for 2 ≤ j ≤ M − 2, as a rational function of M, j and φ."""

    def decide(_: int, candidate: sympy.Eq) -> Ruling:
        mean = 1 + forms()["interior"].expression
        return decide_in_field(candidate.rhs, candidate.lhs.xreplace({subject: mean}))

    return decide


def searched(load: str, subject: sympy.Symbol) -> Search:
    """Exact packings in which the mean force is another."""

    def exact(height: int, layer: int) -> dict[sympy.Symbol, Fraction]:
        return {subject: 1 + witnesses.means(height, witnesses.N, load)[0][layer]}

    return lambda candidate: witnesses.fails(candidate, exact)


def balances(_: int, candidate: sympy.Eq) -> Ruling:
    """⟨α₂⟩ put into the vertical balance, which then vanishes."""
    if candidate.lhs != mean_force:
        return undecided(f"the left-hand side is not {text(mean_force)}")
    left = second_order.vertical_balance().xreplace({mean_force: candidate.rhs})
    return decide_identity(left, sympy.Integer(0))


def shifted(forms: dict[str, ClosedForm], subject: sympy.Symbol) -> Decide:
    """The mean less 1 has the right-hand side as its leading order, by the exact interior form."""
    change = terms(subject, -1)

    def decide(_: int, candidate: sympy.Eq) -> Ruling:
        if candidate.lhs != change:
            return undecided(f"the left-hand side is not {text(change)}")
        return compare_leading_order(forms["interior"].value, candidate.rhs)

    return decide


def edges_are(forms: dict[str, ClosedForm], *, base: sympy.Expr, above: sympy.Expr) -> Ruling:
    """The leading orders in M at j = 0 and j = 1, in units of (σ/r)²/[(1−φ²)(1+φ)]."""
    unit = (sigma / r) ** 2 / ((1 - phi**2) * (1 + phi))
    found = {"base": base, "base+1": above}
    return from_test(
        all(
            (leading(forms[case].value) - FIELD.from_sympy(stated * unit)).is_zero()
            for case, stated in found.items()
        ),
        f"{text(base)} at j = 0 and {text(above)} at j = 1, in units of (σ/r)²/[(1−φ²)(1+φ)]",
    )


def leading_is(forms: dict[str, ClosedForm], shift: sympy.Expr) -> Ruling:
    """The leading order in M, at fixed z."""
    found = leading(forms["interior"].value)
    stated = FIELD.from_sympy(shift.xreplace({z: j / M}))
    return from_test((found - stated).is_zero(), f"the shift is {text(shift)} to leading order")
