"""Eq. 13: variance of the contact forces under a surface load; exact, and to leading order."""

from collections.abc import Iterator
from functools import cache

import sympy
from force_diffusion.derivations import eq11_total_force as eq11
from force_diffusion.derivations import eq12_delta_weights as eq12
from force_diffusion.derivations.framework import exact_cases
from force_diffusion.derivations.framework.follows import (
    by_certificate,
    certificate,
    differentiated,
    identity,
    summed,
)
from force_diffusion.derivations.framework.record import (
    Claim,
    Derivation,
    Step,
    Witness,
    usual,
)
from force_diffusion.derivations.witnesses import squared_weights as witnesses
from force_diffusion.symbolic.algebra.exact import FIELD
from force_diffusion.symbolic.as_printed import equation, minus, power, terms, times
from force_diffusion.symbolic.kernel.decisions import Ruling, all_of, from_test
from force_diffusion.symbolic.notation import Symbol
from force_diffusion.symbolic.symbols import M, j, m, n, phi, r, sigma, z
from force_diffusion.symbolic.variances.orders import (
    edges_follow,
    no_radius_dominates,
)
from force_diffusion.symbolic.variances.variance import (
    ClosedForm,
    exact_variances,
    order,
    variance,
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


SQUARES = Symbol("squares", r"\sum w^2", "Σw²")
"""Sum of the squared weights of all radii in Eq. 12, its prefactor left out."""

WEIGHTS = times(
    6,
    terms(sympy.Sum((M - j) ** 2, (m, 1, j)), sympy.Sum((M - m) ** 2, (m, j + 1, M))),
)
TOTAL = terms(times(2, (M - j) ** 2, terms(M, 2 * j)), minus(times(3, (M - j) ** 2)), M - j)
"""The same in closed form."""


def squared_weights(candidate: sympy.Eq) -> Ruling:
    """Six times a sum over layers against the weights of Eq. 12, squared radius by radius."""
    form = sympy.Sum(times(eq12.BRACES, eq12.ON_DIAGONAL), (m, 1, M))
    known = (variance(form, eq12.DEEP) / FIELD.from_sympy(sigma**2)).to_sympy()
    return summed({SQUARES: known})(0, candidate)


def _squares_to(last: sympy.Expr) -> sympy.Expr:
    """Σ k² for k < last."""
    return last * (last - 1) * (2 * last - 1) / 6


def _highest_term(_: int, candidate: sympy.Eq) -> Ruling:
    """The first term of ``TOTAL`` at z = j/M; the others are of lower order."""
    rest = order(FIELD.from_sympy(sympy.Add(*TOTAL.args[1:])))
    return all_of(
        identity({z: j / M})(0, candidate),
        from_test(rest < order(FIELD.from_sympy(TOTAL)), f"the rest is of order M^{rest}"),
    )


def steps() -> Iterator[Step]:
    """Six radii's worth for each Δ, the squared weights summed."""
    yield Step(
        "Each Δ holds one radius with the weight 2 and two with the weight −1: its square sum is "
        "6. Those of Eq. 12 lie in different layers and share no radius.",
        equation(SQUARES, WEIGHTS),
        lambda _, candidate: squared_weights(candidate),
        ("Eq. 12",),
    )
    below, above = sympy.Sum((M - j) ** 2, (m, 1, n)), sympy.Sum((M - m) ** 2, (m, j + 1, n))
    yield Step(
        "Each of the two sums has a certificate: what it is up to n gains the term at n, and is "
        "zero before the first term, at n = 0 (first) and at n = j (second).",
        sympy.Tuple(
            *certificate(below, n * (M - j) ** 2),
            *certificate(above, terms(_squares_to(M - j), minus(_squares_to(M - n)))),
        ),
        by_certificate,
    )
    yield Step(
        "Added up:",
        equation(WEIGHTS, TOTAL),
        summed(),
        ("step 2",),
    )
    yield Step(
        "The first term has the highest order. With the prefactor of Eq. 12 squared, the factor "
        "(M − j)²(M + 2j) is the printed form at z = j/M.",
        equation(times(eq12.PREFACTOR**2, sigma**2, TOTAL.args[0]), PRINTED.rhs),
        _highest_term,
        ("step 1", "step 3"),
    )
    yield Step(
        "What Eq. 12 drops does not change it: the printed form is the leading order of the exact "
        "variance, which follows.",
        PRINTED,
        decide,
        ("Eq. 11", "step 4"),
    )
    force = eq11.in_radii(eq11.PRINTED.rhs)
    yield from exact_cases.variance_steps(
        RELATIVE_VARIANCE, eq11.PRINTED.lhs, force, exact_forms(), 5
    )
    yield exact_cases.next_order(
        RELATIVE_VARIANCE, PRINTED.rhs, exact_forms(), next_order(), "Eq. 13", "step 8"
    )
    profile = times(terms(1, -z) ** 2, terms(times(2, z), 1))
    yield Step(
        "The profile ceases to broaden at the base, where its slope vanishes.",
        equation(sympy.Derivative(profile, z), -6 * z * (1 - z)),
        differentiated(),
        ("Eq. 13",),
    )


def next_order() -> sympy.Expr:
    """The M² term of the exact variance at fixed z, without (σ/r)²/(1−φ²)²."""
    return sympy.Rational(-3, 2) * M**2 * (1 - z) * (1 + 3 * z)


decide = exact_cases.to_leading_order(RELATIVE_VARIANCE, exact_forms)
"""The exact variance less a candidate is of order M² at most."""


def _no_radius_dominates() -> Ruling:
    return no_radius_dominates(eq11.in_radii(eq11.PRINTED.rhs), exact_forms())


DERIVATION = Derivation(
    number=13,
    name="surface_diffusion",
    title="Variance of the forces under a surface load",
    symbols=usual(sigma, r, M, z, phi),
    assumptions=(
        "the radii are independent, of zero mean and variance σ²",
        "first order in δr",
        "printed form: M → ∞ at fixed z; exact form: every 0 ≤ j < M",
    ),
    premises=(eq11.DERIVATION, eq12.DERIVATION),
    printed=(PRINTED,),
    loads=("surface",),
    relation="∼",
    exact=lambda: exact_cases.exact_cases(RELATIVE_VARIANCE, exact_forms()),
    steps=steps,
    decide=decide,
    search=exact_cases.parting(RELATIVE_VARIANCE, exact_forms),
    claims=(
        Claim(
            "leading orders of the exact forms at the base and below the surface",
            lambda: edges_follow(exact_forms(), PRINTED.rhs),
        ),
        Claim(
            "at fixed z, and in the layers next to base and surface, no radius has more than "
            "O(1/M) of the variance: what Lindeberg's theorem needs",
            _no_radius_dominates,
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
