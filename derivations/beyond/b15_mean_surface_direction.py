"""Eq. B15: the mean contact force under a surface load in any direction, to second order."""

from collections.abc import Iterator
from functools import cache

import sympy
from force_diffusion.derivations import eq11_total_force as eq11
from force_diffusion.derivations.beyond import b4_settling as b4
from force_diffusion.derivations.beyond import b5_mean_surface as b5
from force_diffusion.derivations.beyond import t1_forces as b1
from force_diffusion.derivations.beyond.mean_directions import (
    balances,
    decided,
    mean_forms,
    printed,
    searched,
    superposes,
    witnessed,
)
from force_diffusion.derivations.beyond.mean_forces import leading_is, shifted
from force_diffusion.derivations.framework.exact_cases import exact_cases, exact_steps
from force_diffusion.derivations.framework.record import Claim, Derivation, Step, usual
from force_diffusion.symbolic.as_printed import equation, minus, terms, times
from force_diffusion.symbolic.mechanics.second_order import FORCE_AT_ANGLE, mean_force
from force_diffusion.symbolic.notation import Symbol
from force_diffusion.symbolic.symbols import M, j, phi, r, sigma, t, z
from force_diffusion.symbolic.variances.orders import UNIT
from force_diffusion.symbolic.variances.variance import ClosedForm

PLUS = Symbol("mean_plus_ratio", r"\frac{\langle f^{+}_{ij}\rangle}{L^{+}}", "⟨f⁺_ij⟩/L⁺")
MINUS = Symbol("mean_minus_ratio", r"\frac{\langle f^{-}_{ij}\rangle}{L^{-}}", "⟨f⁻_ij⟩/L⁻")

PRINTED = printed(
    (PLUS, MINUS),
    terms(
        times(4, j, terms(1, phi, times(2, phi**2))),
        minus(times(8, phi, M)),
        times(phi, terms(4, -phi), terms(1, phi)),
    ),
    terms(
        times(4, j, terms(1, minus(times(3, phi)), minus(times(2, phi**2)))),
        times(8, phi**2, M),
        minus(times(phi, terms(1, phi), terms(2, phi))),
    ),
)


@cache
def exact_forms() -> dict[str, ClosedForm]:
    """⟨f⁺⟩/L⁺ less 1, at every layer, exact to order σ²."""
    return mean_forms(b1.in_radii(0))


decide = decided(exact_forms, (PLUS, MINUS))


def shift() -> sympy.Expr:
    """The leading order in M of ⟨f⁺⟩/L⁺ − 1."""
    own = z * (1 + phi + 2 * phi**2) - 2 * phi
    other = z * (1 - 3 * phi - 2 * phi**2) + 2 * phi**2
    return M * (own + t * other) * UNIT


def steps() -> Iterator[Step]:
    """The momentum of a layer along b⁺ in the mean; the covariances."""
    yield Step(
        "The mean momentum through each layer is the load, which does not fluctuate. Along b⁺, "
        "where n⁻ has no part, its order ε² gives ⟨α₂⟩ of f⁺ at once. A contact along n⁻ is a "
        "mirror image, with t in front; ⟨ν²⟩ and ⟨νρ⟩ are alike for both, ⟨ν⁻α₁⁻⟩ is ⟨να₁⟩ with "
        "1/t in place of t:",
        equation(mean_force, FORCE_AT_ANGLE),
        balances,
        ("Eq. B4", "Eq. B5"),
    )
    yield Step(
        "α₁ is Eq. B1. The covariances, weight by weight, give for 2 ≤ j ≤ M − 2",
        sympy.Tuple(*PRINTED),
        decide,
        ("Eq. 11", "Eq. B1", "step 1"),
    )
    yield from exact_steps(PLUS - 1, exact_forms(), "the covariances there", "step 1", "step 2")
    yield Step(
        "To leading order:",
        equation(terms(PLUS, -1), shift()),
        shifted(exact_forms(), PLUS),
        ("Eq. B15",),
        relation="∼",
    )


DERIVATION = Derivation(
    number="B15",
    name="mean_surface_direction",
    title="Mean contact force under a surface load in any direction, to second order",
    symbols=(
        (PLUS, "mean of f⁺ over its value in the ordered packing"),
        (MINUS, "the same of f⁻"),
        (t, "L⁻/L⁺ of the load −(L⁺n⁺ + L⁻n⁻)"),
        *usual(sigma, r, M, phi),
    ),
    assumptions=(
        "the radii are independent, of zero mean and variance σ², of whatever law",
        "second order in δr",
        "L⁺, L⁻ > 0",
        "printed form: 2 ≤ j ≤ M − 2; exact forms, for f⁺: every 0 ≤ j < M. For f⁻ put 1/t in "
        "place of t",
    ),
    premises=(eq11.DERIVATION, b1.B1, b4.DERIVATION, b5.DERIVATION),
    printed=PRINTED,
    domain=(sympy.Ge(j, 2), sympy.Ge(M, j + 2)),
    exact=lambda: exact_cases(PLUS - 1, exact_forms(), "second order"),
    steps=steps,
    decide=decide,
    search=searched("surface", (PLUS, MINUS)),
    claims=(
        Claim(
            "for t = 1 it is Eq. B5; it is linear in t, as forces are in the load",
            lambda: superposes(exact_forms, b5.exact_forms),
        ),
        Claim(
            "to leading order a load along n⁻ alone gives f⁺ a mean of L⁻ M[z(1 − 3φ − 2φ²) + 2φ²]"
            "(σ/r)²/(1−φ²)², where the ordered packing has none",
            lambda: leading_is(exact_forms(), shift()),
        ),
    ),
    witnesses=witnessed("surface", exact_forms),
    remarks=(
        "Loads superpose, and a load along n⁻ is the mirror image of one along n⁺. So the mean "
        "stress under any load is a sum of two, alike in S_xx and S_yy and opposite in S_xy: the "
        "ratio S_xx/S_yy does not know the load's direction, at any order.",
    ),
)

if __name__ == "__main__":
    from force_diffusion.derivations.commands.alone import run_alone

    raise SystemExit(run_alone(DERIVATION))
