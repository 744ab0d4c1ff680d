"""Eq. B16: the mean contact force under a bulk load in any direction, to second order."""

from collections.abc import Iterator
from functools import cache

import sympy
from force_diffusion.derivations import eq11_total_force as eq11
from force_diffusion.derivations.beyond import b4_settling as b4
from force_diffusion.derivations.beyond import b6_mean_bulk as b6
from force_diffusion.derivations.beyond import b15_mean_surface_direction as b15
from force_diffusion.derivations.beyond import t1_forces as b1
from force_diffusion.derivations.beyond import t2_variance as t2
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
from force_diffusion.symbolic.kernel.decisions import Ruling, from_test
from force_diffusion.symbolic.mechanics.second_order import FORCE_AT_ANGLE, mean_force
from force_diffusion.symbolic.notation import Symbol
from force_diffusion.symbolic.symbols import M, j, phi, r, sigma, t, z
from force_diffusion.symbolic.variances.orders import UNIT
from force_diffusion.symbolic.variances.variance import ClosedForm

PLUS, MINUS = (
    Symbol(
        f"mean_{name}_bulk_ratio",
        rf"\frac{{\langle f^{{{sign}}}_{{ij}}\rangle}}{{(M-j)\,L^{{{sign}}}}}",
        f"⟨f{raised}_ij⟩/[(M−j) L{raised}]",
    )
    for name, sign, raised in (("plus", "+", "⁺"), ("minus", "-", "⁻"))
)

PRINTED = printed(
    (PLUS, MINUS),
    terms(
        times(4, j, terms(1, times(2, phi**2))),
        minus(times(4, phi, M)),
        times(phi**2, terms(3, -phi)),
        (1 - phi) ** 2 / (M - j),
    ),
    terms(
        times(4, j, terms(1, minus(times(3, phi)))),
        times(4, phi**2, terms(M, -j)),
        minus(times(phi, terms(2, -phi, phi**2))),
        minus(times(phi, (1 - phi) ** 2, 1 / (M - j))),
    ),
)


@cache
def exact_forms() -> dict[str, ClosedForm]:
    """⟨f⁺⟩/[(M − j) L⁺] less 1, at every layer, exact to order σ²."""
    return mean_forms(eq11.in_radii(b1.bulk_force()))


decide = decided(exact_forms, (PLUS, MINUS))


def shift() -> sympy.Expr:
    """The leading order in M of ⟨f⁺⟩/[(M − j) L⁺] − 1."""
    own = z * (1 + 2 * phi**2) - phi
    other = z * (1 - 3 * phi) + phi**2 * (1 - z)
    return M * (own + t * other) * UNIT


def steps() -> Iterator[Step]:
    """The same balance; the first-order force is that of Eq. B3."""
    yield Step(
        "The loads do not fluctuate here either, so that the balance of Eq. B15 holds:",
        equation(mean_force, FORCE_AT_ANGLE),
        balances,
        ("Eq. B4", "Eq. B15"),
    )
    yield Step(
        "α₁ is now the average of Eq. B1 over the loads of all layers above, as in Eq. B3. For "
        "2 ≤ j ≤ M − 2",
        sympy.Tuple(*PRINTED),
        decide,
        ("Eq. 11", "Eq. B1", "Eq. B3", "step 1"),
    )
    yield from exact_steps(PLUS - 1, exact_forms(), "the covariances there", "step 1", "step 2")
    yield Step(
        "To leading order:",
        equation(terms(PLUS, -1), shift()),
        shifted(exact_forms(), PLUS),
        ("Eq. B16",),
        relation="∼",
    )


def _one_layer_below_the_surface() -> Ruling:
    difference = exact_forms()["surface"].value - b15.exact_forms()["surface"].value
    return from_test(difference.is_zero(), "at j = M − 1 Eqs. B15 and B16 agree")


DERIVATION = Derivation(
    number="B16",
    name="mean_bulk_direction",
    title="Mean contact force under a bulk load in any direction, to second order",
    symbols=(
        (PLUS, "mean of f⁺ over its value in the ordered packing"),
        (MINUS, "the same of f⁻"),
        (t, "L⁻/L⁺ of the load −(L⁺n⁺ + L⁻n⁻) on every bead"),
        *usual(sigma, r, M, phi),
    ),
    assumptions=(
        "the radii are independent, of zero mean and variance σ², of whatever law",
        "second order in δr",
        "every bead above the base carries the same load, whatever its radius; L⁺, L⁻ > 0",
        "printed form: 2 ≤ j ≤ M − 2; exact forms, for f⁺: every 0 ≤ j < M. For f⁻ put 1/t in "
        "place of t",
    ),
    premises=(
        eq11.DERIVATION,
        b1.B1,
        t2.DERIVATIONS["B3"],
        b4.DERIVATION,
        b6.DERIVATION,
        b15.DERIVATION,
    ),
    printed=PRINTED,
    domain=(sympy.Ge(j, 2), sympy.Ge(M, j + 2)),
    exact=lambda: exact_cases(PLUS - 1, exact_forms(), "second order"),
    steps=steps,
    decide=decide,
    search=searched("bulk", (PLUS, MINUS)),
    claims=(
        Claim(
            "for t = 1 it is Eq. B6; it is linear in t, as forces are in the load",
            lambda: superposes(exact_forms, b6.exact_forms),
        ),
        Claim(
            "to leading order a load along n⁻ alone gives f⁺ a mean of (M − j) L⁻ "
            "M[z(1 − 3φ) + φ²(1 − z)](σ/r)²/(1−φ²)²",
            lambda: leading_is(exact_forms(), shift()),
        ),
        Claim("one layer below the surface both loads agree", _one_layer_below_the_surface),
    ),
    witnesses=witnessed("bulk", exact_forms),
)

if __name__ == "__main__":
    from force_diffusion.derivations.commands.alone import run_alone

    raise SystemExit(run_alone(DERIVATION))
