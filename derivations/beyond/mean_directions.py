"""What Eqs. B15 and B16 have in common: mean forces to second order for a load in any direction."""

from collections.abc import Callable
from fractions import Fraction
from functools import cache

import sympy
from force_diffusion.derivations import eq11_total_force as eq11
from force_diffusion.derivations.beyond import b4_settling as b4
from force_diffusion.derivations.beyond.directions import in_other_branch
from force_diffusion.derivations.beyond.mean_forces import SUM_OF_RADII, combined
from force_diffusion.derivations.beyond.means import decide_in_field
from force_diffusion.derivations.framework.follows import Decide
from force_diffusion.derivations.framework.record import Search, Witness
from force_diffusion.derivations.witnesses import second_order as witnesses
from force_diffusion.symbolic.algebra import explicit
from force_diffusion.symbolic.algebra.affine import Region
from force_diffusion.symbolic.algebra.exact import FIELD, RationalFunction
from force_diffusion.symbolic.as_printed import equation, power, terms, times
from force_diffusion.symbolic.kernel.decisions import (
    Ruling,
    all_of,
    decide_identity,
    from_test,
    undecided,
)
from force_diffusion.symbolic.mechanics import second_order
from force_diffusion.symbolic.mechanics.second_order import (
    FORCE_AT_ANGLE,
    mean_force,
    mean_square,
    with_both,
    with_force,
    with_other,
    with_radii,
)
from force_diffusion.symbolic.printing.text import text
from force_diffusion.symbolic.symbols import M, j, phi, r, sigma, t
from force_diffusion.symbolic.variances.means import covariance
from force_diffusion.symbolic.variances.variance import ClosedForm, by_layer

Forms = Callable[[], dict[str, ClosedForm]]
Subjects = tuple[sympy.Symbol, sympy.Symbol]


def _mirrored(value: RationalFunction) -> RationalFunction:
    """The same of the other branch: 1/t in place of t."""
    total = FIELD.zero
    for power_of_t, coefficient in enumerate(value.coefficients(t)):
        total = total + coefficient / FIELD.generator(t) ** power_of_t
    return total


def _known(
    force: sympy.Expr, at: dict[sympy.Symbol, sympy.Expr], region: Region
) -> dict[sympy.Symbol, RationalFunction]:
    """The means of products of first-order quantities of a contact, and of its mirror image."""
    nu, rho, alpha = (e.xreplace(at) for e in (eq11.in_radii(b4.TILT), SUM_OF_RADII, force - 1))
    own = covariance(nu, alpha, region)
    return {
        mean_square: covariance(nu, nu, region),
        with_radii: covariance(nu, rho, region),
        with_force: own,
        with_other: _mirrored(own),
        with_both: covariance(alpha, rho, region),
    }


def mean_forms(force: sympy.Expr) -> dict[str, ClosedForm]:
    """⟨f⁺⟩ over its ordered value less 1; ``force`` is f⁺ to first order in the radii."""
    return by_layer(lambda at, region: combined(FORCE_AT_ANGLE, _known(force, at, region)))


def printed(subjects: Subjects, own: sympy.Expr, other: sympy.Expr) -> tuple[sympy.Eq, sympy.Eq]:
    """What each branch's own load changes in ⟨f⟩/L less 1, and t or 1/t times what the other's."""

    below, variance = 4 * (1 - phi**2) ** 2, power(times(sigma, 1 / r), 2)
    plus = times(1 / below, terms(*own.args, times(t, other)), variance)
    minus = times(1 / (t * below), terms(times(t, own), *other.args), variance)
    return equation(terms(subjects[0], -1), plus), equation(terms(subjects[1], -1), minus)


def balances(_: int, candidate: sympy.Eq) -> Ruling:
    """⟨α₂⟩ put into the balance along b⁺, which then vanishes."""
    if candidate.lhs != mean_force:
        return undecided(f"the left-hand side is not {text(mean_force)}")
    left = second_order.balance_along_b().xreplace({mean_force: candidate.rhs})
    return decide_identity(left, sympy.Integer(0))


def decided(forms: Forms, subjects: Subjects) -> Decide:
    """The candidate equals the mean for 2 ≤ j ≤ M − 2; f⁻ is f⁺ with t ↔ 1/t."""

    @cache
    def mean(part: int) -> sympy.Expr:
        own = 1 + forms()["interior"].expression
        return in_other_branch(own) if part else own

    def decide(part: int, candidate: sympy.Eq) -> Ruling:
        return decide_in_field(candidate.rhs, candidate.lhs.xreplace({subjects[part]: mean(part)}))

    return decide


def searched(load: str, subjects: Subjects) -> Search:
    """Exact packings in which a mean force is another, at t = 3/5."""
    ratio = Fraction(3, 5)
    values = {**explicit.geometry(*witnesses.N, Fraction(1)), sigma: 1, t: ratio}

    def search(candidate: sympy.Eq) -> str | None:
        for height, layer in ((4, 2), (5, 2), (5, 3)):
            plus, minus = (
                1 + witnesses.means(height, witnesses.N, load, ratio, branch)[0][layer]
                for branch in "+-"
            )
            at = {**values, M: height, j: layer, subjects[0]: plus, subjects[1]: minus}
            try:
                left, right = (explicit.number(side, at) for side in candidate.args)
            except explicit.AmbiguousError:
                return None
            if left != right:
                return f"for M = {height}, j = {layer}, t = {ratio}: {left} on the left, {right}"
        return None

    return search


def superposes(forms: Forms, vertical: Forms) -> Ruling:
    """For t = 1 it is the vertical load's; it is linear in t, as forces are in the load."""
    known = vertical()
    ones = {t: FIELD.one}
    return all_of(
        from_test(
            all(
                (form.value.substitute(ones) - known[case].value).is_zero()
                for case, form in forms().items()
            ),
            "for t = 1 equal in the interior and at the edges",
        ),
        from_test(
            all(len(form.value.coefficients(t)) == 2 for form in forms().values()),
            "linear in t in every layer",
        ),
    )


def ratio_stays(force: sympy.Expr, at: sympy.Expr) -> Ruling:
    """The mean contact moments of both branches, for the load and for a vertical one (``at``)."""

    def both(of: sympy.Expr, axis: int, angle: sympy.Expr) -> RationalFunction:
        """Moments of f⁺ and f⁻ at order ε², over those of the ordered packing."""
        part = second_order.mean_of(second_order.contact_moment()[axis], angle)
        own = combined(part, _known(of, {}, Region({j: 2, M: j + 2})))
        return (own + FIELD.generator(t) * _mirrored(own)) / FIELD.from_sympy(1 + t)

    return from_test(
        all(
            (both(force, axis, FORCE_AT_ANGLE) - both(at, axis, second_order.FORCE)).is_zero()
            for axis in range(2)
        ),
        "S_xx and S_yy change by the same shares for every t",
    )


def witnessed(load: str, forms: Forms) -> tuple[Witness, ...]:
    """Exact packings under loads that are not vertical."""
    return tuple(
        Witness(
            f"exact packings, ε²: the mean f{sign} of every layer, as fractions",
            lambda packing, branch=branch: witnesses.forces(  # type: ignore[misc]
                forms(), load, packing, packing.components[1] / packing.components[0], branch
            ),
        )
        for branch, sign in (("+", "⁺"), ("-", "⁻"))
    )
