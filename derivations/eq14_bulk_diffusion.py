"""Eq. 14: variance of the contact forces under a bulk load; exact, and to leading order."""

# fmt: off
from functools import cache

import sympy
from force_diffusion.derivations import (
    eq05_contact_minus as eq05, eq11_total_force as eq11, eq12_delta_weights as eq12)
from force_diffusion.derivations.eq13_surface_diffusion import KEPT_VARIANCE
from force_diffusion.derivations.framework.vocabulary import (
    FIRST_ORDER, ClosedForm, Derivation, Domain, Groups, Limit, Steps, Symbol, asymptotic,
    at_fixed_height, axioms, certificate, differentiate, drop_terms, equation, layers, minus,
    mirror, moment, negligible, power, rewrite, shown, terms, times, usual)
from force_diffusion.symbolic.symbols import (
    Braces, ForcePlus, M, Mean, Variance, i, j, l, m, m_g, n, n_y, phi, r, sigma, z)
# fmt: on

LOADED = eq11.LAYERS.loaded(axioms.BULK)
IN_THE_LIMIT = LOADED.in_the_limit(at_fixed_height("∼"))

RELATIVE_VARIANCE = Symbol(
    "relative_variance", r"\frac{\sigma_f^2(z)}{\langle f\rangle_z^2}", "σ_f²(z)/⟨f⟩_z²"
)
MEAN_FORCE = Symbol("mean_force", r"\langle f\rangle_z", "⟨f⟩_z", positive=True)

PRINTED = equation(
    RELATIVE_VARIANCE,
    times(3 * M**3 / (10 * (1 - phi**2) ** 2), (1 - z) ** 2, 4 * z + 1, power(sigma / r, 2)),
)

RATIO = ForcePlus(i, j) / ((M - j) * m_g / (2 * n_y))
"""The force over its mean, (M − j) m g/2n_y."""
MEANING = {RELATIVE_VARIANCE: Variance(RATIO)}

AVERAGED = times(sympy.S.Half, M - j + 1), times(sympy.S.Half, M - m, M - m + 1, 1 / (M - j))
"""The weights of Δ for m ≤ j and for m > j: those of Eq. 12 averaged over the heights l."""
OVER_HEIGHTS = (
    times(1 / (M - j), sympy.Sum(l - j, (l, j + 1, M))),
    times(1 / (M - j), sympy.Sum(l - m, (l, m, M))),
)
AVERAGE_OF_EQ_12 = minus(
    times(eq12.PREFACTOR, sympy.Sum(times(Braces(*AVERAGED, m, j), eq12.ON_DIAGONAL), (m, 1, M)))
)
KEPT = {KEPT_VARIANCE: Variance(AVERAGE_OF_EQ_12)}

WEIGHTS = times(
    6,
    terms(
        sympy.Sum(power(AVERAGED[0], 2), (m, 1, j)), sympy.Sum(power(AVERAGED[1], 2), (m, j + 1, M))
    ),
)
HIGHEST = 3 * (M - j) ** 2 * (M + 4 * j) / 10
REST = times(
    sympy.Rational(1, 10),
    terms(30 * M**2 * j, -5 * M**2, -60 * M * j**2, 25 * M * j, 30 * j**3, -20 * j**2, 2),
    1 / (M - j),
)
"""Six times the sum of their squares is HIGHEST and this."""
NEXT_ORDER = 3 * M**2 * (1 - z) ** 2 / 8
"""The M² term of the exact variance at fixed z, in units of (σ/r)²/(1−φ²)²."""
PROFILE = times((1 - z) ** 2, 4 * z + 1)


def averaged_force() -> sympy.Expr:
    """f⁺_ij over its ordered value: Eq. 11 averaged over the heights l = j + 1, …, M.

    A load on layer l feels the geometry up to layer l alone, so it acts as the surface load of
    a packing of height l; loads add up because force balance is linear.
    """
    of_height_l = eq11.PRINTED.rhs.xreplace({M: l})
    return times(1 / (M - j), sympy.Sum(of_height_l, (l, j + 1, M)))


FORCE = equation(RATIO, averaged_force())


@cache
def in_radii() -> Groups:
    """The forces and, in the radii, the directions of contacts: both branches."""
    (force,) = shown(14, eq11.from_the_surface_down(FORCE, LOADED))
    return (force, mirror(force)), eq05.directions()


def next_to_the_maximum(above: int) -> Domain:
    """A layer j at z = 1/6, next to the one above it: M = 6j + ``above``."""
    limit = Limit("∼", f"M → ∞, M = 6j + {above}", (j,), (j,))
    return LOADED.also(sympy.Eq(M, 6 * j + above)).in_the_limit(limit)


def gained(above: int) -> sympy.Eq:
    """What the exact form gains from layer j to j + 1, which is half a layer above it on average.

    To leading order it is proportional to the distance of j + 1/2 from M/6 − 5/24; the factor is
    the second derivative of Eq. 14 in j at its maximum.
    """
    upper = RATIO.xreplace({i: i + 1, j: j + 1})
    apart = (j + sympy.S.Half - (M / 6 - sympy.Rational(5, 24))).xreplace({M: 6 * j + above})
    return equation(
        terms(Variance(upper), -RELATIVE_VARIANCE), times(layers.UNIT, -3, M, sympy.expand(apart))
    )


def show_steps(steps: Steps) -> None:
    """Superpose the surface loads of all layers above the contact."""
    groups = in_radii()
    steps.show(
        "The weight of the beads in layer l acts as the surface load of a packing of "
        "height l. The ordered forces of the layers above j add up to",
        sympy.Tuple(
            equation(MEAN_FORCE, (M - j) * m_g / (2 * n_y)),
            equation(MEAN_FORCE, M * m_g * (1 - z) / (2 * n_y)),
        ),
        rewrite(),
        eq11.LAYERS,
        {MEAN_FORCE: sympy.Sum(m_g / (2 * n_y), (l, j + 1, M))},
    )
    steps.show(
        "In units of this mean, f⁺_ij is the average of Eq. 11 over the heights l = j+1, …, M, as "
        "balancing bead after bead shows, from the surface down:",
        FORCE,
        eq11.from_the_surface_down,
        LOADED,
    )
    steps.show(
        "So the weights of Δ in Eq. 12 are averaged, for m ≤ j and for m > j:",
        sympy.Tuple(*map(equation, OVER_HEIGHTS, AVERAGED)),
        rewrite(),
        eq12.INSIDE.also(m >= j + 1, m <= M),
    )
    approximation = steps.show(
        "As in Eq. 12, the variance of what is dropped is lower by an order in M:",
        equation(terms(RATIO, -1), AVERAGE_OF_EQ_12),
        negligible(*groups),
        LOADED.also(j >= 1).in_the_limit(at_fixed_height("≈")),
    )
    variance = steps.show(
        "The variance of the kept terms is six times the sum of their squared weights:",
        equation(KEPT_VARIANCE, times(layers.UNIT, WEIGHTS)),
        moment(),
        definitions=KEPT,
    )
    up_to_n = n * (n + 1) * (n + 2) * (3 * n**2 + 6 * n + 1) / 15
    steps.show(
        "The sum of squares below is checked as in Eq. 13; it is zero at n = 0. With M − m for m, "
        "the second sum above is a factor times this one at n = M − j − 1.",
        sympy.Tuple(*certificate(sympy.Sum(m**2 * (m + 1) ** 2, (m, 1, n)), up_to_n)),
        rewrite(),
        Domain.of(n >= 0),
    )
    added = steps.show(
        "Added up:",
        equation(KEPT_VARIANCE, times(layers.UNIT, terms(HIGHEST, REST))),
        moment(variance.theorem),
        definitions=KEPT,
    )
    steps.show(
        "The first term has the highest order. With z = j/M it is the printed form.",
        PRINTED,
        drop_terms(approximation.theorem, added.theorem),
        IN_THE_LIMIT,
    )
    how = "put into step 2, Eqs. 4 and 5 give every radius a weight; their squares add up"
    form = DERIVATION.exact_forms["layer"]
    layers.show_closed_form(steps, how, form)
    layers.show_next(steps, PRINTED, NEXT_ORDER, form)
    steps.show(
        "From the base up the profile rises to z = 1/6, and falls above it. Not divided by ⟨f⟩_z² "
        "it would be stationary at the base.",
        sympy.Tuple(
            equation(sympy.Derivative(PROFILE, z), 2 * (1 - z) * (1 - 6 * z)),
            equation(
                sympy.Derivative(times(terms(1, -z) ** 2, PROFILE), z), -20 * z * (1 - z) ** 3
            ),
        ),
        differentiate,
        Domain(),
    )
    steps.claim(
        "⟨f⟩_z is the mean of the force at every height",
        equation(Mean(ForcePlus(i, j)), (M - j) * m_g / (2 * n_y)),
        moment(*groups),
        LOADED,
    )
    layers.claim_edges(steps, PRINTED, form)
    layers.claim_exponent(
        steps,
        "superdiffusive near the surface, subdiffusive below: the local exponent "
        "d ln (σ_f²/⟨f⟩_z²)/d ln (1 − z) falls from 2 at the surface through 1, that of Brownian "
        "motion, at z = 3/8, is 0 at the maximum, z = 1/6, and negative nearer the base",
        PROFILE,
        times(12 * z - 2, 1 / (4 * z + 1)),
        (8 * z - 3) / (4 * z + 1),
    )
    steps.claim(
        "near z = 1/6 the exact form has a maximum at j = M/6 − 5/24, up to a shift that vanishes "
        "as M → ∞",
        sympy.Tuple(gained(4), gained(5)),
        asymptotic(*groups),
        [next_to_the_maximum(4), next_to_the_maximum(5)],
    )


DERIVATION = Derivation(
    number=14,
    name="bulk_diffusion",
    title="Variance of the forces under a bulk load",
    symbols=(*usual(sigma, r, M, z, phi), (m_g, "weight of a bead")),
    assumptions=(
        *FIRST_ORDER,
        "every bead above the base has the weight m g, whatever its radius",
        "printed form: M → ∞ at fixed z; exact form: every 0 ≤ j < M",
    ),
    printed=(PRINTED,),
    domain=IN_THE_LIMIT,
    show_steps=show_steps,
    step_domain=eq12.INSIDE,
    definitions=MEANING,
    deciders=lambda: [asymptotic(*in_radii())],
    exact=lambda: {"layer": ClosedForm(RELATIVE_VARIANCE, Variance(RATIO), LOADED, in_radii)},
)

if __name__ == "__main__":
    from force_diffusion.derivations.commands.cli import run_alone

    raise SystemExit(run_alone(14))
