"""Eq. 13: variance of the contact forces under a surface load; exact, and to leading order."""

from functools import cache

import sympy
from force_diffusion.derivations import eq11_total_force as eq11
from force_diffusion.derivations import eq12_delta_weights as eq12
from force_diffusion.derivations.framework.record import FIRST_ORDER, usual
from force_diffusion.derivations.framework.vocabulary import (
    UNIT,
    Derivation,
    Layered,
    Lines,
    Where,
    asymptotic,
    equation,
    formula,
    minus,
    moment,
    rewrite,
    slope,
    terms,
    times,
)
from force_diffusion.symbolic.as_printed import certificate
from force_diffusion.symbolic.kernel.where import SURFACE, at_fixed_height
from force_diffusion.symbolic.notation import Symbol
from force_diffusion.symbolic.symbols import M, Variance, j, m, n, phi, r, sigma, z

RELATIVE_VARIANCE = Symbol(
    "relative_variance", r"\frac{\sigma_f^2(z)}{\langle f\rangle^2}", "σ_f²(z)/⟨f⟩²"
)

PRINTED = equation(
    RELATIVE_VARIANCE,
    formula("(2M³/(1 − φ²)²) (1 − z)²(2z + 1)(σ_δr/r)²"),
)

VARIANCE = Layered(13, RELATIVE_VARIANCE, Variance(eq11.PRINTED.lhs), (eq11.IN_RADII,), SURFACE)


SQUARES = Symbol("squares", r"\sum w^2", "Σw²")
"""Sum of the squared weights of all radii in Eq. 12, its prefactor left out."""

OF_DELTA = Variance(sympy.Sum(times(eq12.BRACES, eq12.ON_DIAGONAL), (m, 1, M))) / sigma**2
"""What it is."""

WEIGHTS = times(
    6,
    terms(sympy.Sum((M - j) ** 2, (m, 1, j)), sympy.Sum((M - m) ** 2, (m, j + 1, M))),
)
TOTAL = formula("2(M − j)²(M + 2j) − 3(M − j)² + (M − j)")
"""The same in closed form."""

EVERY = Where.of(j >= 0, j < M)


def _squares_to(last: sympy.Expr) -> sympy.Expr:
    """Σ k² for k < last."""
    return last * (last - 1) * (2 * last - 1) / 6


@cache
def steps() -> Lines:
    """Six radii's worth for each Δ, the squared weights summed."""
    lines = Lines(EVERY)
    of_delta = lines.show(
        "Each Δ holds one radius with the weight 2 and two with the weight −1: its square sum is "
        "6. Those of Eq. 12 lie in different layers and share no radius.",
        equation(SQUARES, WEIGHTS),
        moment(),
        where=EVERY.also(j >= 1),
        meaning={SQUARES: OF_DELTA},
        after=(eq12.DERIVATION,),
    )
    below, above = sympy.Sum((M - j) ** 2, (m, 1, n)), sympy.Sum((M - m) ** 2, (m, j + 1, n))
    certified = lines.show(
        "Each of the two sums has a certificate: what it is up to n gains the term at n, and is "
        "zero before the first term, at n = 0 (first) and at n = j (second).",
        sympy.Tuple(
            *certificate(below, n * (M - j) ** 2),
            *certificate(above, terms(_squares_to(M - j), minus(_squares_to(M - n)))),
        ),
        rewrite(),
        where=EVERY.also(n >= j, indices=(n,)),
    )
    added = lines.show("Added up:", equation(WEIGHTS, TOTAL), rewrite(), after=(certified,))
    highest = lines.show(
        "The first term has the highest order. With the prefactor of Eq. 12 squared, the factor "
        "(M − j)²(M + 2j) is the printed form at z = j/M.",
        equation(times(eq12.PREFACTOR**2, sigma**2, TOTAL.args[0]), PRINTED.rhs),
        rewrite(),
        meaning={z: j / M},
        after=(of_delta, added),
    )
    VARIANCE.show_leading(
        lines,
        "What Eq. 12 drops does not change it: the printed form is the leading order of the exact "
        "variance, which follows.",
        PRINTED,
        highest,
    )
    inside = VARIANCE.show_forms(
        lines, "Eqs. 4 and 5 put into Eq. 11, every radius has one weight; each sum telescopes"
    )
    VARIANCE.show_next(lines, PRINTED.rhs, next_order(), DERIVATION, inside)
    profile = formula("(1 − z)²(2z + 1)")
    lines.show(
        "The profile ceases to broaden at the base, where its slope vanishes.",
        equation(sympy.Derivative(profile, z), -6 * z * (1 - z)),
        slope(),
        where=Where(),
        after=(DERIVATION,),
    )
    lines.claim(
        "the first term of the sum of squares has its highest order",
        equation(TOTAL, TOTAL.args[0]),
        asymptotic(),
        where=EVERY.in_the_limit(at_fixed_height("∼")),
    )
    VARIANCE.claim_edges(
        lines,
        "leading orders of the exact forms at the base and below the surface",
        {
            sympy.S.Zero: PRINTED.rhs.xreplace({z: sympy.S.Zero}),
            M - 1: 2 * M * (1 + phi**2) * UNIT,
        },
    )
    VARIANCE.claim_shares(lines)
    return lines


def next_order() -> sympy.Expr:
    """The M² term of the exact variance at fixed z, without (σ/r)²/(1−φ²)²."""
    return sympy.Rational(-3, 2) * M**2 * (1 - z) * (1 + 3 * z)


DERIVATION = Derivation(
    number=13,
    name="surface_diffusion",
    title="Variance of the forces under a surface load",
    symbols=usual(sigma, r, M, z, phi),
    assumptions=(
        *FIRST_ORDER,
        "printed form: M → ∞ at fixed z; exact form: every 0 ≤ j < M",
    ),
    premises=(eq11.DERIVATION, eq12.DERIVATION),
    printed=(PRINTED,),
    loads=("surface",),
    relation="∼",
    exact=lambda: VARIANCE.exact(4, 5, 11),
    steps=steps,
    where=VARIANCE.in_the_limit,
    remarks=(
        "The limit is taken at fixed z. A fixed number of layers below the surface the "
        "printed form does not apply: at j = M − 1 the exact variance grows as 2(1+φ²) M, "
        "not 6 M, in units of (σ/r)²/(1 − φ²)².",
    ),
)

if __name__ == "__main__":
    from force_diffusion.derivations.commands.alone import run_alone

    raise SystemExit(run_alone(DERIVATION))
