"""Eq. 13: variance of the contact forces under a surface load; exact, and to leading order."""

# fmt: off
import sympy
from force_diffusion.derivations import eq11_total_force as eq11
from force_diffusion.derivations import eq12_delta_weights as eq12
from force_diffusion.derivations.framework.vocabulary import (
    FIRST_ORDER, ClosedForm, Derivation, Domain, Steps, Symbol, asymptotic, at_fixed_height,
    certificate, differentiate, drop_terms, equation, layers, minus, moment, power, rewrite, terms,
    times, usual)
from force_diffusion.symbolic.symbols import M, Variance, j, m, n, phi, r, sigma, z
# fmt: on

RELATIVE_VARIANCE = Symbol(
    "relative_variance", r"\frac{\sigma_f^2(z)}{\langle f\rangle^2}", "σ_f²(z)/⟨f⟩²"
)
MEANING = {RELATIVE_VARIANCE: Variance(eq11.PRINTED.lhs)}
IN_THE_LIMIT = eq11.LOADED.in_the_limit(at_fixed_height("∼"))

PRINTED = equation(
    RELATIVE_VARIANCE,
    times(2 * M**3 / (1 - phi**2) ** 2, (1 - z) ** 2, 2 * z + 1, power(sigma / r, 2)),
)

KEPT_VARIANCE = Symbol("kept_variance", r"\sigma^2_{\mathrm{kept}}", "σ²_kept")
"""The variance of what Eq. 12 keeps."""
KEPT = {KEPT_VARIANCE: Variance(eq12.PRINTED.rhs)}

WEIGHTS = times(
    6, terms(sympy.Sum((M - j) ** 2, (m, 1, j)), sympy.Sum((M - m) ** 2, (m, j + 1, M)))
)
"""Six times the squared weights of the Δ in Eq. 12."""
TOTAL = terms(2 * (M - j) ** 2 * (M + 2 * j), -3 * (M - j) ** 2, M - j)
"""The same in closed form."""
NEXT_ORDER = -3 * M**2 * (1 - z) * (1 + 3 * z) / 2
"""The M² term of the exact variance at fixed z, in units of (σ/r)²/(1−φ²)²."""
PROFILE = times((1 - z) ** 2, 2 * z + 1)


def _squares_to(last: sympy.Expr) -> sympy.Expr:
    """Σ k² for k < last."""
    return last * (last - 1) * (2 * last - 1) / 6


def show_steps(steps: Steps) -> None:
    """Each Δ has the variance 6σ²; the squares of its weights are added up."""
    variance = steps.show(
        "Each Δ holds one radius with the weight 2 and two with the weight −1: their squares add "
        "up to 6. Those of Eq. 12 lie in different layers and share no radius. With the "
        "prefactor, the variance of its right-hand side is",
        equation(KEPT_VARIANCE, times(layers.UNIT, WEIGHTS)),
        moment(),
        definitions=KEPT,
    )
    below, above = sympy.Sum((M - j) ** 2, (m, 1, n)), sympy.Sum((M - m) ** 2, (m, j + 1, n))
    steps.show(
        "The closed form of each sum up to n is checked: it grows by the term at n, and is zero "
        "before the first term, at n = 0 (first sum) and at n = j (second sum).",
        sympy.Tuple(
            *certificate(below, n * (M - j) ** 2),
            *certificate(above, terms(_squares_to(M - j), minus(_squares_to(M - n)))),
        ),
        rewrite(),
        eq12.INSIDE.also(n >= j),
    )
    added = steps.show(
        "Added up:",
        equation(KEPT_VARIANCE, times(layers.UNIT, TOTAL)),
        moment(variance.theorem),
        definitions=KEPT,
    )
    steps.show(
        "The variance of what Eq. 12 drops is lower by an order in M, and the first term has the "
        "highest order. With z = j/M it is the printed form.",
        PRINTED,
        drop_terms(eq12.DERIVATION.theorem, added.theorem),
        IN_THE_LIMIT,
    )
    how = "put into Eq. 11, Eqs. 4 and 5 give every radius a weight; their squares add up"
    form = DERIVATION.exact_forms["layer"]
    layers.show_closed_form(steps, how, form)
    layers.show_next(steps, PRINTED, NEXT_ORDER, form)
    steps.show(
        "At the base the profile no longer broadens, as its slope vanishes:",
        equation(sympy.Derivative(PROFILE, z), -6 * z * (1 - z)),
        differentiate,
        Domain(),
    )
    layers.claim_edges(steps, PRINTED, form)
    layers.claim_exponent(
        steps,
        "superdiffusive near the surface, subdiffusive nearer the base: the local exponent "
        "d ln σ_f²/d ln (1 − z) falls from 2 at the surface through 1, that of Brownian motion, at "
        "z = 1/4, to 0 at the base",
        PROFILE,
        6 * z / (2 * z + 1),
        (4 * z - 1) / (2 * z + 1),
    )


DERIVATION = Derivation(
    number=13,
    name="surface_diffusion",
    title="Variance of the forces under a surface load",
    symbols=usual(sigma, r, M, z, phi),
    assumptions=(*FIRST_ORDER, "printed form: M → ∞ at fixed z; exact form: every 0 ≤ j < M"),
    printed=(PRINTED,),
    domain=IN_THE_LIMIT,
    show_steps=show_steps,
    step_domain=eq12.INSIDE,
    definitions=MEANING,
    deciders=lambda: [asymptotic(*eq11.in_radii())],
    exact=lambda: {
        "layer": ClosedForm(
            RELATIVE_VARIANCE, Variance(eq11.PRINTED.lhs), eq11.LOADED, eq11.in_radii
        )
    },
    remarks=(
        "Erratum: the limit is taken at fixed z. A fixed number of layers below the surface the "
        "printed form does not apply: at j = M − 1 the exact variance grows as 2(1+φ²) M, "
        "not 6 M, in units of (σ/r)²/(1 − φ²)².",
        "The Gaussian distribution of the paper is that of one contact over the ensemble of "
        "packings, as M → ∞ at fixed z. Over a layer of one packing it is the same once the "
        "packing is much wider than high: contacts more than M apart share no radius. Over all "
        "contacts of a packing it is not: Gaussian laws of all widths are mixed then, and the "
        "kurtosis is 156/35, not 3. It is 3 ⟨g²⟩/⟨g⟩², averaged over 0 < z < 1, with the profile "
        "g = (1 − z)²(2z + 1).",
    ),
)

if __name__ == "__main__":
    from force_diffusion.derivations.commands.cli import run_alone

    raise SystemExit(run_alone(13))
