"""Eq. B5: the mean contact force under a surface load, to second order."""

from collections.abc import Iterator
from functools import cache

import sympy
from force_diffusion.derivations import eq11_total_force as eq11
from force_diffusion.derivations.beyond import b4_settling as b4
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
from force_diffusion.derivations.framework.follows import identity
from force_diffusion.derivations.framework.record import (
    Claim,
    Derivation,
    Step,
    Witness,
    usual,
)
from force_diffusion.derivations.witnesses import second_order as witnesses
from force_diffusion.symbolic.as_printed import equation, minus, power, terms, times
from force_diffusion.symbolic.kernel.decisions import Ruling, decide_identity
from force_diffusion.symbolic.mechanics import second_order
from force_diffusion.symbolic.mechanics.second_order import FORCE, mean_force
from force_diffusion.symbolic.notation import Symbol
from force_diffusion.symbolic.symbols import M, j, phi, r, sigma, z
from force_diffusion.symbolic.variances.variance import ClosedForm

MEAN = Symbol(
    "mean_force_ratio",
    r"\frac{\langle f^{\pm}_{ij}\rangle}{f^{\mathrm{load}}/2 n_{y}}",
    "⟨f^±_ij⟩/(f_load/2n_y)",
)

PRINTED = equation(
    terms(MEAN, -1),
    times(
        1 / ((1 - phi**2) * (1 + phi)) / 2,
        terms(times(4, terms(j, minus(times(phi, M)))), times(phi, terms(1, phi))),
        power(times(sigma, 1 / r), 2),
    ),
)


@cache
def exact_forms() -> dict[str, ClosedForm]:
    """⟨f⟩ over its ordered value, less 1, at every layer, exact to order σ²."""
    return mean_forms(eq11.in_radii(eq11.PRINTED.rhs))


decide = decided(exact_forms, MEAN)


def shift() -> sympy.Expr:
    """The leading order in M of ⟨f⟩/(f_load/2n_y) − 1."""
    return 2 * M * (z - phi) * (sigma / r) ** 2 / ((1 - phi**2) * (1 + phi))


VERTICAL = Symbol("momentum", "p_{y}", "p_y", real=True)
"""Vertical part of force times direction at order ε², over the ordered force."""


def _vanishes(_: int, candidate: sympy.Eq) -> Ruling:
    return decide_identity(candidate.lhs - candidate.rhs, second_order.vertical_balance())


def steps() -> Iterator[Step]:
    """The vertical momentum of a layer in the mean; what it leaves of ⟨α₂⟩; the covariances."""
    momentum = second_order.momentum()[1]
    yield Step(
        "A contact force is 1 + εα₁ + ε²α₂ in units of its ordered value, α₁ being Eq. 11, and "
        "its direction n⁺ + εν b⁻ + ε²u₂. The vertical part of their product at order ε²:",
        equation(VERTICAL, momentum),
        identity({VERTICAL: momentum}),
        ("Eq. 11",),
    )
    yield Step(
        "Force passes from layer to layer, and what enters is the load, which does not fluctuate: "
        "the mean vertical force through each layer is that of the ordered packing. By symmetry "
        "both branches carry the same. With u₂ from the constraint (Eq. B4):",
        equation(second_order.vertical_balance(), sympy.Integer(0)),
        _vanishes,
        ("Eq. B4", "step 1"),
    )
    yield Step(
        "So three means of products of first-order quantities of one contact are all it takes:",
        equation(mean_force, FORCE),
        balances,
        ("step 2",),
    )
    yield Step(
        "The tilt ν of a contact and its force α₁ are linear forms in the radii: line sums that "
        "share few sites. Their covariances, weight by weight, give for 2 ≤ j ≤ M − 2",
        PRINTED,
        decide,
        ("Eq. 11", "step 3"),
    )
    yield from exact_steps(
        MEAN - 1, exact_forms(), "the three covariances there", "step 3", "step 4"
    )
    yield Step(
        "To leading order at fixed z, where the shift changes its sign at z = φ:",
        equation(terms(MEAN, -1), shift()),
        shifted(exact_forms(), MEAN),
        ("step 5",),
        relation="∼",
    )


DERIVATION = Derivation(
    number="B5",
    name="mean_surface",
    title="Mean contact force under a surface load, to second order",
    symbols=(
        (MEAN, "mean of f⁺ and of f⁻ over its value in the ordered packing"),
        *usual(sigma, r, M, phi),
    ),
    assumptions=(
        "the radii are independent, of zero mean and variance σ², of whatever law",
        "second order in δr",
        "printed form: 2 ≤ j ≤ M − 2; exact forms: every 0 ≤ j < M",
    ),
    premises=(eq11.DERIVATION, b4.DERIVATION),
    printed=(PRINTED,),
    domain=(sympy.Ge(j, 2), sympy.Ge(M, j + 2)),
    exact=lambda: exact_cases(MEAN - 1, exact_forms(), "second order"),
    steps=steps,
    decide=decide,
    search=searched("surface", MEAN),
    claims=(
        Claim(
            "to leading order the shift is 2M(z − φ)(σ/r)²/[(1−φ²)(1+φ)]: forces rise above z = φ "
            "and fall below",
            lambda: leading_is(exact_forms(), shift()),
        ),
        Claim(
            "next to the base two layers of contacts go their own way: forces rise at j = 0; at "
            "j = 1 they fall for φ > −3/8 and rise for φ < −3/8, by shares of order M(σ/r)² that "
            "z → 0 does not give",
            lambda: edges_are(
                exact_forms(),
                base=3 * M * (1 - 2 * phi) / 4,
                above=-M * (3 + 8 * phi) / 4,
            ),
        ),
    ),
    witnesses=(
        Witness(
            "exact packings, ε²: the mean force of every layer, as fractions",
            lambda packing: witnesses.forces(exact_forms(), "surface", packing),
        ),
    ),
    remarks=(
        "Third moments of the radii enter at order ε³ only: the coefficient of ε² is a quadratic "
        "form in independent radii.",
        "The fluctuation of Eq. 13 is of order M³(σ/r)², the shift of the mean of order M(σ/r)²: "
        "at M* one is of order 1, the other of order (σ/r)^(4/3).",
    ),
)

if __name__ == "__main__":
    from force_diffusion.derivations.commands.alone import run_alone

    raise SystemExit(run_alone(DERIVATION))
