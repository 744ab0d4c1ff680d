"""Eq. 14: variance of the contact forces under a bulk load; exact, and to leading order."""

from functools import cache

import sympy
from force_diffusion.derivations import eq04_contact_plus as eq04
from force_diffusion.derivations import eq05_contact_minus as eq05
from force_diffusion.derivations import eq06_force_balance as eq06
from force_diffusion.derivations import eq11_total_force as eq11
from force_diffusion.derivations import eq12_delta_weights as eq12
from force_diffusion.derivations import eq13_surface_diffusion as eq13
from force_diffusion.derivations.framework.proving import Line
from force_diffusion.derivations.framework.record import FIRST_ORDER, usual
from force_diffusion.derivations.framework.vocabulary import (
    SUPPOSED,
    UNIT,
    Chain,
    Derivation,
    Layered,
    Lines,
    Where,
    asymptotic,
    axioms,
    below,
    equation,
    formula,
    induct,
    moment,
    power,
    rewrite,
    slope,
    terms,
    times,
)
from force_diffusion.symbolic.as_printed import certificate
from force_diffusion.symbolic.kernel.where import BULK, Limit, at_fixed_height
from force_diffusion.symbolic.notation import Symbol
from force_diffusion.symbolic.symbols import (
    ForcePlus,
    M,
    Mean,
    Variance,
    i,
    j,
    l,
    m,
    m_g,
    n,
    n_y,
    phi,
    r,
    sigma,
    z,
)

RELATIVE_VARIANCE = Symbol(
    "relative_variance", r"\frac{\sigma_f^2(z)}{\langle f\rangle_z^2}", "σ_f²(z)/⟨f⟩_z²"
)
MEAN_FORCE = Symbol("mean_force", r"\langle f\rangle_z", "⟨f⟩_z", positive=True)

PRINTED = equation(
    RELATIVE_VARIANCE,
    formula("(3M³/(10(1 − φ²)²)) (1 − z)²(4z + 1)(σ_δr/r)²"),
)


def bulk_force() -> sympy.Expr:
    """f⁺_ij over its ordered value (M − j) m g/2n_y: Eq. 11 for a load on each layer above j.

    A load on layer l feels the geometry up to layer l alone, so it acts as the surface load of
    a packing of height l; loads add up because force balance is linear.
    """
    return sympy.Sum(eq11.PRINTED.rhs.xreplace({M: l}), (l, j + 1, M)) / (M - j)


WHERE = Where.of(j >= 0, j < M, loading=BULK)
EVERY = WHERE.loaded(None)
RATIO = ForcePlus(i, j) / MEAN_FORCE
ORDERED = {MEAN_FORCE: (M - j) * m_g / (2 * n_y)}
"""What the mean force is; a claim says so."""

FORCE = Line(
    "In units of this mean, f⁺_ij is the average of Eq. 11 over the heights l = j+1, …, M.",
    equation(RATIO, times(1 / (M - j), bulk_force().args[1])),
    induct(
        j,
        M - 1,
        below(axioms.balance(), axioms.loads(BULK)),
        below(axioms.balance(), (SUPPOSED, axioms.loads(BULK))),
        down=True,
        mirrored=True,
    ),
    WHERE,
    {**ORDERED, l: m},
    number=2,
)
"""The second step, on which the variance rests."""

IN_RADII = Chain((FORCE, eq11.DIRECTIONS))
VARIANCE = Layered(14, RELATIVE_VARIANCE, Variance(RATIO), (IN_RADII,), BULK, ORDERED)


TOP = sympy.Eq(j, M - 1, evaluate=False)
"""One layer below the surface."""

AVERAGED = (
    formula("(M − j + 1)/2"),
    formula("(M − m)(M − m + 1)/(2(M − j))"),
)
"""The weights of Δ for m ≤ j and for m > j: those of Eq. 12 averaged over the heights l."""

OVER_HEIGHTS = (
    times(1 / (M - j), sympy.Sum(l - j, (l, j + 1, M))),
    times(1 / (M - j), sympy.Sum(l - m, (l, m, M))),
)

WEIGHTS = times(
    6,
    terms(
        sympy.Sum(power(AVERAGED[0], 2), (m, 1, j)),
        sympy.Sum(power(AVERAGED[1], 2), (m, j + 1, M)),
    ),
)
HIGHEST = formula("(3/10)(M − j)²(M + 4j)")


REST = formula("(30M²j − 5M² − 60M j² + 25M j + 30j³ − 20j² + 2)/(10(M − j))")
"""Six times the sum of their squares is HIGHEST and this."""


PROFILE = formula("(1 − z)²(4z + 1)")


def next_to_the_maximum(above: int) -> Where:
    """A layer j at z = 1/6, next to the one above it: M = 6j + ``above``."""
    limit = Limit("∼", f"M → ∞, M = 6j + {above}", (j,), (j,))
    return VARIANCE.where.also(sympy.Eq(M, 6 * j + above)).in_the_limit(limit)


def gained(above: int) -> sympy.Eq:
    """What the exact form gains from layer j to j + 1, which is half a layer above it on average.

    To leading order it is proportional to the distance of j + 1/2 from M/6 − 5/24.
    """
    one_up = {i: i + 1, j: j + 1}
    upper = RATIO.xreplace(ORDERED).xreplace(one_up)
    apart = (j + sympy.Rational(1, 2) - (M / 6 - sympy.Rational(5, 24))).xreplace(
        {M: 6 * j + above}
    )
    return equation(terms(Variance(upper), -RELATIVE_VARIANCE), times(UNIT, CURVATURE, M, apart))


CURVATURE = -3
"""The second derivative of Eq. 14 in j at its maximum, over M, in units of ``UNIT``."""


@cache
def steps() -> Lines:
    """Superpose the surface loads of all layers above the contact."""
    lines = Lines(EVERY)
    ordered = lines.show(
        "The weight of the beads in layer l acts as the surface load of a packing of "
        "height l. The ordered forces of the layers above j add up to",
        sympy.Tuple(
            equation(MEAN_FORCE, (M - j) * m_g / (2 * n_y)),
            equation(MEAN_FORCE, M * m_g * (1 - z) / (2 * n_y)),
        ),
        rewrite(),
        meaning={MEAN_FORCE: sympy.Sum(m_g / (2 * n_y), (m, j + 1, M)), z: j / M},
        after=(eq11.DERIVATION,),
    )
    force = lines.add(FORCE, after=(eq11.DERIVATION, ordered))
    averaged = lines.show(
        "So the weights of Δ in Eq. 12 are averaged, for m ≤ j and for m > j:",
        sympy.Tuple(*map(equation, OVER_HEIGHTS, AVERAGED)),
        rewrite(),
        where=EVERY.also(m >= j + 1, m <= M, indices=(m,)),
        meaning={l: n},
        after=(eq12.DERIVATION, force),
    )
    up_to_n = n * (n + 1) * (n + 2) * (3 * n**2 + 6 * n + 1) / 15
    lines.show(
        "Their squares are summed with a certificate: with M − m for m the second sum is, but for "
        "its factor, this one up to n = M − j − 1. It is zero at n = 0.",
        sympy.Tuple(*certificate(sympy.Sum(m**2 * (m + 1) ** 2, (m, 1, n)), up_to_n)),
        rewrite(),
        where=EVERY.also(n >= 0, indices=(n,)),
    )
    squared = lines.show(
        "Six times the sum of their squares:", equation(WEIGHTS, terms(HIGHEST, REST)), rewrite()
    )
    highest = lines.show(
        "The first term has the highest order. With the prefactor of Eq. 12 squared it is the "
        "printed form at z = j/M.",
        equation(times(eq12.PREFACTOR**2, sigma**2, HIGHEST), PRINTED.rhs),
        rewrite(),
        meaning={z: j / M},
        after=(averaged, squared),
    )
    VARIANCE.show_leading(
        lines,
        "What Eq. 12 drops does not change it: the printed form is the leading order of the exact "
        "variance, which follows.",
        PRINTED,
        highest,
    )
    inside = VARIANCE.show_forms(lines, "every radius has one weight; each sum telescopes")
    VARIANCE.show_next(lines, PRINTED.rhs, next_order(), DERIVATION, inside)
    lines.show(
        "The profile rises up to z = 1/6 and falls from there on. Without the normalisation it "
        "would be stationary at the base.",
        sympy.Tuple(
            equation(sympy.Derivative(PROFILE, z), 2 * (1 - z) * (1 - 6 * z)),
            equation(
                sympy.Derivative(times(terms(1, -z) ** 2, PROFILE), z), -20 * z * (1 - z) ** 3
            ),
        ),
        slope(),
        where=Where(),
        after=(DERIVATION,),
    )
    lines.claim(
        "⟨f⟩_z is the mean of the force at every height",
        equation(Mean(ForcePlus(i, j)), (M - j) * m_g / (2 * n_y)),
        moment(IN_RADII),
        where=WHERE,
    )
    lines.claim(
        "the first term of the sum of squares has its highest order",
        equation(terms(HIGHEST, REST), HIGHEST),
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
    lines.claim(
        "one layer below the surface both loads agree",
        equation(RELATIVE_VARIANCE, eq13.VARIANCE.form.on(j >= 2, TOP).to_sympy()),
        moment(IN_RADII),
        where=VARIANCE.where.also(j >= 2, TOP),
        meaning=VARIANCE.meant,
    )
    lines.claim(
        "at fixed z the printed form has one maximum, at z = 1/6: it falls short of that by "
        "(z − 1/6)² (17/3 − 4z)",
        equation(
            terms(PROFILE.xreplace({z: sympy.Rational(1, 6)}), -PROFILE),
            (z - sympy.Rational(1, 6)) ** 2 * (sympy.Rational(17, 3) - 4 * z),
        ),
        rewrite(),
        where=Where(),
    )
    lines.claim(
        "there the exact form has a maximum at j = M/6 − 5/24, up to a shift that vanishes as "
        "M → ∞",
        sympy.Tuple(gained(4), gained(5)),
        asymptotic(IN_RADII),
        where=(next_to_the_maximum(4), next_to_the_maximum(5)),
        meaning=VARIANCE.meant,
    )
    return lines


def next_order() -> sympy.Expr:
    """The M² term of the exact variance at fixed z, without (σ/r)²/(1−φ²)²."""
    return sympy.Rational(3, 8) * M**2 * (1 - z) ** 2


DERIVATION = Derivation(
    number=14,
    name="bulk_diffusion",
    title="Variance of the forces under a bulk load",
    symbols=(
        *usual(sigma, r, M, z, phi),
        (m_g, "weight of a bead"),
    ),
    assumptions=(
        *FIRST_ORDER,
        "every bead above the base weighs mg, whatever its radius",
        "printed form: M → ∞ at fixed z; exact form: every 0 ≤ j < M",
    ),
    premises=(
        eq04.DERIVATION,
        eq05.DERIVATION,
        eq06.DERIVATION,
        eq11.DERIVATION,
        eq12.DERIVATION,
        eq13.DERIVATION,
    ),
    printed=(PRINTED,),
    loads=("bulk",),
    relation="∼",
    exact=lambda: VARIANCE.exact(4, 5, 14),
    steps=steps,
    where=VARIANCE.in_the_limit,
)

if __name__ == "__main__":
    from force_diffusion.derivations.commands.alone import run_alone

    raise SystemExit(run_alone(DERIVATION))
