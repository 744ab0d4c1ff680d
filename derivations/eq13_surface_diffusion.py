"""Eq. 13: variance of the contact forces under a surface load; exact, and to leading order."""

from collections.abc import Iterator
from functools import cache

import sympy
from force_diffusion.derivations import eq11_total_force as eq11
from force_diffusion.derivations import eq12_delta_weights as eq12
from force_diffusion.derivations.framework.exact_cases import exact_cases, exact_steps
from force_diffusion.derivations.framework.record import Claim, Derivation, ExactCase, Step, Witness
from force_diffusion.derivations.witnesses import squared_weights as witnesses
from force_diffusion.symbolic.as_printed import equation, power, terms, times
from force_diffusion.symbolic.kernel.decisions import Ruling, all_of, decide_identity, undecided
from force_diffusion.symbolic.kernel.searches import LAYERS, parts_in_the_limit
from force_diffusion.symbolic.notation import Symbol
from force_diffusion.symbolic.symbols import M, j, m, phi, r, sigma, z
from force_diffusion.symbolic.variances.certified_sums import certified_sum
from force_diffusion.symbolic.variances.orders import (
    compare_leading_order,
    edges_follow,
    next_order_is,
    no_radius_dominates,
    weights_follow,
)
from force_diffusion.symbolic.variances.variance import (
    ClosedForm,
    exact_variances,
)

RELATIVE_VARIANCE = Symbol(
    "relative_variance", r"\frac{\sigma_f^2(z)}{\langle f\rangle^2}", "σ_f²(z)/⟨f⟩²"
)

PRINTED = equation(
    RELATIVE_VARIANCE,
    times(
        2 * M**3 / (1 - phi**2) ** 2,
        terms(1, -z) ** 2,
        terms(times(2, z), 1),
        power(times(sigma, 1 / r), 2),
    ),
)


@cache
def exact_forms() -> dict[str, ClosedForm]:
    """Exact σ_f²/⟨f⟩² under a surface load at every layer, from Eq. 11 site by site."""
    return exact_variances(eq11.in_radii(eq11.PRINTED.rhs))


def at_finite_size() -> dict[str, ExactCase]:
    """The exact forms, case by case."""
    return exact_cases(RELATIVE_VARIANCE, exact_forms())


def sum_of_weights() -> sympy.Expr:
    """6 Σ w² over the second differences of Eq. 12, by SymPy, each sum with its certificate."""
    below = certified_sum((M - j) ** 2, m, sympy.Integer(1), j)
    above = certified_sum((M - m) ** 2, m, j + 1, M)
    return 6 * (below + above)


def steps() -> Iterator[Step]:
    """Six radii's worth for each Δ, the squared weights summed."""
    yield Step(
        "Each Δ holds one radius with the weight 2 and two with the weight −1: its variance "
        "is 6σ². Those of Eq. 12 lie in different layers and are independent.",
        6 * (sympy.Sum((M - j) ** 2, (m, 1, j)) + sympy.Sum((M - m) ** 2, (m, j + 1, M))),
    )
    yield Step("The sums, in closed form:", times(M - j, sympy.cancel(sum_of_weights() / (M - j))))
    yield Step(
        "Leading order in M at fixed z = j/M, with the prefactor of Eq. 12 squared:", PRINTED
    )
    yield from exact_steps(RELATIVE_VARIANCE, exact_forms())
    yield Step("The next order in M at fixed z, relative to (σ/r)²/(1−φ²)²:", next_order())


def next_order() -> sympy.Expr:
    """The M² term of the exact variance at fixed z, without (σ/r)²/(1−φ²)²."""
    return sympy.Rational(-3, 2) * M**2 * (1 - z) * (1 + 3 * z)


def decide(_: int, candidate: sympy.Eq) -> Ruling:
    """The exact variance less the candidate is of order M² at most."""
    if candidate.lhs != RELATIVE_VARIANCE:
        return undecided("the left-hand side is not σ_f²/⟨f⟩²")
    return compare_leading_order(exact_forms()["interior"].value, candidate.rhs)


def search(candidate: sympy.Eq) -> str | None:
    """Values at growing M where the candidate and the exact variance part."""
    return parts_in_the_limit(exact_forms()["interior"].expression, candidate.rhs, LAYERS)


def _weights() -> Ruling:
    return weights_follow(
        sum_of_weights() * eq12.PREFACTOR**2 * sigma**2,
        PRINTED.rhs,
        "6σ² Σ w² of Eq. 12 has the printed leading order",
    )


def _no_radius_dominates() -> Ruling:
    return no_radius_dominates(eq11.in_radii(eq11.PRINTED.rhs), exact_forms())


def _corollaries() -> Ruling:
    profile = (1 - z) ** 2 * (2 * z + 1)
    slope = sympy.diff(profile, z)
    return all_of(
        decide_identity(slope, -6 * z * (1 - z)),
        decide_identity(slope.xreplace({z: sympy.Integer(0)}), sympy.Integer(0)),
    )


DERIVATION = Derivation(
    number=13,
    name="surface_diffusion",
    title="Variance of the forces under a surface load",
    symbols=(
        (sigma, "standard deviation σ_δr of the radii"),
        (r, "mean radius"),
        (M, "height of the packing"),
        (z, "relative height j/M"),
        (phi, "n⁺·n⁻"),
    ),
    assumptions=(
        "the radii are independent, of zero mean and variance σ²",
        "first order in δr",
        "printed form: M → ∞ at fixed z; exact form: every 0 ≤ j < M",
    ),
    premises=(eq11.DERIVATION, eq12.DERIVATION),
    printed=(PRINTED,),
    relation="∼",
    exact=at_finite_size,
    steps=steps,
    decide=decide,
    search=search,
    claims=(
        Claim("the squared weights of Eq. 12 sum to the printed form", _weights),
        Claim(
            "the next order in M", lambda: next_order_is(exact_forms(), PRINTED.rhs, next_order())
        ),
        Claim(
            "exact forms at the base and below the surface",
            lambda: edges_follow(exact_forms(), PRINTED.rhs),
        ),
        Claim("no radius has more than O(1/M) of the variance, in any layer", _no_radius_dominates),
        Claim(
            "broadening stops at the base: the slope in z is −6z(1 − z), zero at z = 0",
            _corollaries,
        ),
    ),
    witnesses=(
        Witness(
            "exact variances equal sums of squared weights of exact packings, all j < M ≤ 4",
            lambda packing: witnesses.variances(exact_forms(), "surface", packing),
        ),
    ),
    remarks=(
        "The limit is taken at fixed z. A fixed number of layers below the surface the "
        "printed form does not apply: at j = M − 1 the exact variance grows as 2(1+φ²) M, "
        "not 6 M.",
    ),
)

if __name__ == "__main__":
    from force_diffusion.derivations.commands.alone import run_alone

    raise SystemExit(run_alone(DERIVATION))
