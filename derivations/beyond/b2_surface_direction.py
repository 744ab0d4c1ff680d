"""Eq. B2: variance of the contact forces under a surface load in any direction."""

from collections.abc import Iterator
from functools import cache

import sympy
from force_diffusion.derivations import eq13_surface_diffusion as eq13
from force_diffusion.derivations.beyond import t1_forces as b1
from force_diffusion.derivations.beyond.directions import (
    UNLOADED,
    VARIANCE_PLUS,
    decided,
    height_is,
    is_vertical,
    printed,
    searched,
    witnessed,
)
from force_diffusion.derivations.framework import exact_cases
from force_diffusion.derivations.framework.follows import identity
from force_diffusion.derivations.framework.record import Claim, Derivation, Step, usual
from force_diffusion.symbolic.algebra.exact import FIELD
from force_diffusion.symbolic.as_printed import equation
from force_diffusion.symbolic.kernel.decisions import Ruling, all_of, from_test
from force_diffusion.symbolic.symbols import ForcePlus, L_plus, M, i, j, phi, r, sigma, t, z
from force_diffusion.symbolic.variances.orders import UNIT, no_radius_dominates
from force_diffusion.symbolic.variances.variance import ClosedForm, exact_variances, leading

PRINTED = printed(sympy.Integer(2), 2)


@cache
def exact_forms() -> dict[str, ClosedForm]:
    """Exact variance of f⁺ over its mean squared at every layer, from Eq. B1 site by site."""
    return exact_variances(b1.in_radii(0))


def next_order() -> sympy.Expr:
    """The M² term at fixed z, without (σ/r)²/(1−φ²)²."""
    return t**2 * eq13.next_order()


decide = decided(exact_forms)


def steps() -> Iterator[Step]:
    """Square the weights of Eq. B1."""
    yield Step(
        "In Eq. B1 every second difference comes with t: the sum of squared weights that gives "
        "Eq. 13 is multiplied by t² for f⁺ and, as its mirror image, by 1/t² for f⁻.",
        sympy.Tuple(*PRINTED),
        decide,
        ("Eq. 13", "Eq. B1"),
    )
    ratio = ForcePlus(i, j) / L_plus
    yield from exact_cases.variance_steps(
        VARIANCE_PLUS, ratio, b1.in_radii(0), exact_forms(), 1, "Eq. B1"
    )
    yield exact_cases.next_order(
        VARIANCE_PLUS, PRINTED[0].rhs, exact_forms(), next_order(), "Eq. B2", "step 4"
    )
    yield Step(
        "As L⁻ is taken away, t → 0, the tilt of the contact itself is left, for 1 ≤ j ≤ M − 1: "
        "a variance that knows nothing of M.",
        equation(VARIANCE_PLUS, UNLOADED),
        identity({VARIANCE_PLUS: exact_forms()["interior"].expression.xreplace({t: NOTHING})}),
        ("step 4",),
    )


NOTHING = sympy.Integer(0)


def _unloaded() -> Ruling:
    """At t = 0, and the variance of f⁻ in units of (L⁺)² there: t² times its form at 1/t."""
    forms, none = exact_forms(), {t: FIELD.zero}
    stated = FIELD.from_sympy(UNLOADED)
    heights = {"interior": {}, "base+1": {j: FIELD.one}, "surface": {j: FIELD.from_sympy(M - 1)}}
    same = all(
        (forms[case].value.substitute(none) - stated.substitute(at)).is_zero()
        for case, at in heights.items()
    )
    # degree 2 in t: t² times the form at 1/t is at t = 0 the coefficient of t²
    other = forms["interior"].value.coefficients(t)
    vertical = FIELD.from_sympy(eq13.PRINTED.rhs.xreplace({z: j / M}))
    return all_of(
        from_test(same, "where n⁻ is not loaded σ² of f⁺ is φ²(4j + φ²)/2 (σ/r)²/(1−φ²)², j ≥ 1"),
        from_test(
            len(other) == 3 and (leading(other[2]) - leading(vertical)).is_zero(),
            "there f⁻ has the mean 0, and Eq. 13 is its variance in units of (L⁺)²",
        ),
    )


def _edges() -> Ruling:
    forms = exact_forms()
    base = FIELD.from_sympy(PRINTED[0].rhs.xreplace({z: sympy.Integer(0)}))
    surface = FIELD.from_sympy(2 * M * (t**2 + phi**2) * UNIT)
    return from_test(
        (leading(forms["base"].value) - base).is_zero()
        and (leading(forms["surface"].value) - surface).is_zero(),
        "at j = 0 the leading order is the printed form at z = 0; at j = M − 1 it is 2(t²+φ²) M in "
        "units of (σ/r)²/(1−φ²)²",
    )


DERIVATION = Derivation(
    number="B2",
    name="surface_direction",
    title="Variance of the forces under a surface load in any direction",
    symbols=(
        (t, "L⁻/L⁺ of the load −(L⁺n⁺ + L⁻n⁻)"),
        *usual(sigma, r, M, z, phi),
    ),
    assumptions=(
        "the radii are independent, of zero mean and variance σ²",
        "first order in δr",
        "L⁺, L⁻ > 0",
        "printed form: M → ∞ at fixed z and t; exact form, for f⁺: every 0 ≤ j < M. For f⁻ put "
        "1/t in place of t",
    ),
    premises=(b1.B1, eq13.DERIVATION),
    printed=PRINTED,
    relation="∼",
    exact=lambda: exact_cases.exact_cases(VARIANCE_PLUS, exact_forms()),
    steps=steps,
    decide=decide,
    search=searched(exact_forms),
    claims=(
        Claim("for t = 1 it is Eq. 13, exactly", lambda: is_vertical(exact_forms(), eq13)),
        Claim("leading orders of the exact forms at the base and below the surface", _edges),
        Claim(
            "at fixed z, and in the layers next to base and surface, no radius has more than "
            "O(1/M) of the variance",
            lambda: no_radius_dominates(b1.in_radii(0), exact_forms()),
        ),
        Claim(
            "as n⁻ is unloaded f⁺ keeps a variance of the order j, whatever M; f⁻ keeps that of "
            "Eq. 13 while its mean vanishes: half of its contacts pull",
            _unloaded,
        ),
        Claim(
            "M* is that of a vertical load divided by t^(2/3) for f⁺ and by (1/t)^(2/3) for f⁻",
            lambda: height_is(exact_forms(), sympy.Integer(1)),
        ),
    ),
    witnesses=witnessed("surface", exact_forms),
    remarks=(
        "The mean force of a contact is fixed by its own component of the load, its fluctuation "
        "by that of the other branch: the branch that carries less fluctuates more, and the height "
        "M* at which forces turn tensile falls as min(t, 1/t)^(2/3).",
    ),
)

if __name__ == "__main__":
    from force_diffusion.derivations.commands.alone import run_alone

    raise SystemExit(run_alone(DERIVATION))
