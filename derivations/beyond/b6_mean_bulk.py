"""Eq. B6: the mean contact force under a bulk load, to second order."""

from collections.abc import Iterator
from functools import cache

import sympy
from force_diffusion.derivations import eq11_total_force as eq11
from force_diffusion.derivations import eq14_bulk_diffusion as eq14
from force_diffusion.derivations.beyond import b4_settling as b4
from force_diffusion.derivations.beyond import b5_mean_surface as b5
from force_diffusion.derivations.beyond.mean_forces import (
    balances,
    decided,
    edges_are,
    leading_is,
    mean_forms,
    searched,
    shifted,
)
from force_diffusion.derivations.framework.exact_cases import exact_cases, exact_steps
from force_diffusion.derivations.framework.record import (
    Claim,
    Derivation,
    Step,
    Witness,
    usual,
)
from force_diffusion.derivations.witnesses import second_order as witnesses
from force_diffusion.symbolic.as_printed import equation, minus, power, terms, times
from force_diffusion.symbolic.kernel.decisions import Ruling, from_test
from force_diffusion.symbolic.mechanics.second_order import FORCE, mean_force
from force_diffusion.symbolic.notation import Symbol
from force_diffusion.symbolic.symbols import M, j, m_g, n_y, phi, r, sigma, z
from force_diffusion.symbolic.variances.variance import ClosedForm

MEAN = Symbol(
    "mean_bulk_ratio",
    r"\frac{\langle f^{\pm}_{ij}\rangle}{(M-j)\,mg/2 n_{y}}",
    "⟨f^±_ij⟩/[(M−j) mg/2n_y]",
)

PRINTED = equation(
    terms(MEAN, -1),
    times(
        1 / ((1 - phi**2) * (1 + phi)) / 4,
        terms(
            times(8, j),
            minus(times(4, phi, terms(M, j))),
            minus(times(2, phi, terms(1, -phi))),
            (1 - phi) ** 2 / (M - j),
        ),
        power(times(sigma, 1 / r), 2),
    ),
)


@cache
def exact_forms() -> dict[str, ClosedForm]:
    """⟨f⟩ over its ordered value, less 1, at every layer, exact to order σ²."""
    return mean_forms(eq11.in_radii(eq14.bulk_force()))


decide = decided(exact_forms, MEAN)


def shift() -> sympy.Expr:
    """The leading order in M of ⟨f⟩ over its ordered value, less 1."""
    return M * (2 * z - phi * (1 + z)) * (sigma / r) ** 2 / ((1 - phi**2) * (1 + phi))


def steps() -> Iterator[Step]:
    """The same balance; the first-order force is that of Eq. 14."""
    yield Step(
        "The weight of the beads does not fluctuate, so that the mean vertical force through a "
        "layer is that of the ordered packing here too, and the balance of Eq. B5 holds:",
        equation(mean_force, FORCE),
        balances,
        ("Eq. B4", "Eq. B5"),
    )
    yield Step(
        "α₁ is now the average of Eq. 11 over the loads of all layers above, as in Eq. 14, and ν "
        "and ρ are as before. Their covariances give for 2 ≤ j ≤ M − 2",
        PRINTED,
        decide,
        ("Eq. 11", "Eq. 14", "step 1"),
    )
    yield from exact_steps(
        MEAN - 1, exact_forms(), "the three covariances there", "step 1", "step 2"
    )
    yield Step(
        "To leading order at fixed z, where the shift changes its sign at z = φ/(2 − φ):",
        equation(terms(MEAN, -1), shift()),
        shifted(exact_forms(), MEAN),
        ("step 3",),
        relation="∼",
    )


def _one_layer_below_the_surface() -> Ruling:
    difference = exact_forms()["surface"].value - b5.exact_forms()["surface"].value
    return from_test(difference.is_zero(), "at j = M − 1 Eqs. B5 and B6 agree")


DERIVATION = Derivation(
    number="B6",
    name="mean_bulk",
    title="Mean contact force under a bulk load, to second order",
    symbols=(
        (MEAN, "mean of f⁺ and of f⁻ over its value in the ordered packing"),
        (m_g, "weight of a bead"),
        (n_y, "vertical component of n^±"),
        *usual(sigma, r, M, phi),
    ),
    assumptions=(
        "the radii are independent, of zero mean and variance σ², of whatever law",
        "second order in δr",
        "every bead above the base weighs mg, whatever its radius",
        "printed form: 2 ≤ j ≤ M − 2; exact forms: every 0 ≤ j < M",
    ),
    premises=(eq11.DERIVATION, eq14.DERIVATION, b4.DERIVATION, b5.DERIVATION),
    printed=(PRINTED,),
    domain=(sympy.Ge(j, 2), sympy.Ge(M, j + 2)),
    exact=lambda: exact_cases(MEAN - 1, exact_forms(), "second order"),
    steps=steps,
    decide=decide,
    search=searched("bulk", MEAN),
    claims=(
        Claim(
            "to leading order the shift is M[2z − φ(1 + z)](σ/r)²/[(1−φ²)(1+φ)]: forces rise above "
            "z = φ/(2 − φ) and fall below",
            lambda: leading_is(exact_forms(), shift()),
        ),
        Claim(
            "next to the base two layers of contacts go their own way, as under a surface load: "
            "forces rise at j = 0; at j = 1 they fall for φ > −3/8 and rise for φ < −3/8",
            lambda: edges_are(
                exact_forms(),
                base=3 * M * (1 - 2 * phi) / 8,
                above=-M * (3 + 8 * phi) / 8,
            ),
        ),
        Claim("one layer below the surface both loads agree", _one_layer_below_the_surface),
    ),
    witnesses=(
        Witness(
            "exact packings, ε²: the mean force of every layer, as fractions",
            lambda packing: witnesses.forces(exact_forms(), "bulk", packing),
        ),
    ),
)

if __name__ == "__main__":
    from force_diffusion.derivations.commands.alone import run_alone

    raise SystemExit(run_alone(DERIVATION))
