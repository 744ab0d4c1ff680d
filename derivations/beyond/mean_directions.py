"""What Eqs. B15 and B16 have in common: mean forces to second order for a load in any direction."""

from collections.abc import Callable
from fractions import Fraction
from functools import cache

import sympy
from force_diffusion.derivations.beyond.mean_forces import combined, known
from force_diffusion.derivations.beyond.means import decide_in_field
from force_diffusion.derivations.framework.follows import Decide
from force_diffusion.derivations.framework.record import Search, Witness
from force_diffusion.derivations.witnesses import second_order as witnesses
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
    with_force,
    with_other,
)
from force_diffusion.symbolic.printing.text import text
from force_diffusion.symbolic.symbols import M, j, phi, r, sigma, t
from force_diffusion.symbolic.variances.variance import ClosedForm, by_layer

Forms = Callable[[], dict[str, ClosedForm]]
Subjects = tuple[sympy.Symbol, sympy.Symbol]


def mirrored(value: RationalFunction) -> RationalFunction:
    """The same of the other branch: 1/t in place of t."""
    total = FIELD.zero
    for power_of_t, coefficient in enumerate(value.coefficients(t)):
        total = total + coefficient / FIELD.generator(t) ** power_of_t
    return total


def in_means(
    part: sympy.Expr, force: sympy.Expr, at: dict[sympy.Symbol, sympy.Expr], region: Region
) -> RationalFunction:
    """A combination of means of a contact's first-order quantities, and of its mirror image's."""
    found = known(force, at, region, {*part.free_symbols, with_force})
    return combined(part, {**found, with_other: mirrored(found[with_force])})


def mean_forms(force: sympy.Expr) -> dict[str, ClosedForm]:
    """⟨f⁺⟩ over its ordered value less 1; ``force`` is f⁺ to first order in the radii."""
    return by_layer(lambda at, region: in_means(FORCE_AT_ANGLE, force, at, region))


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
        return own.xreplace({t: 1 / t}) if part else own

    def decide(part: int, candidate: sympy.Eq) -> Ruling:
        return decide_in_field(candidate.rhs, candidate.lhs.xreplace({subjects[part]: mean(part)}))

    return decide


def searched(load: str, subjects: Subjects) -> Search:
    """Exact packings in which a mean force is another, at t = 3/5."""

    def exact(height: int, layer: int) -> dict[sympy.Symbol, Fraction]:
        return {
            subject: 1
            + witnesses.means(height, witnesses.N, load, witnesses.SHARE, branch)[0][layer]
            for subject, branch in zip(subjects, "+-", strict=True)
        }

    return lambda candidate: witnesses.fails(candidate, exact)


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
        own = in_means(part, of, {}, Region({j: 2, M: j + 2}))
        return (own + FIELD.generator(t) * mirrored(own)) / FIELD.from_sympy(1 + t)

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
