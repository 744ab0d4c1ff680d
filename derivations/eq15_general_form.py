"""Eq. 15: σ_f/⟨f⟩ averaged over the system, and the height M* of packings with tensile forces."""

# fmt: off
from functools import cache, partial

import sympy
from force_diffusion.derivations import (
    eq03_extrapolation as eq03, eq11_total_force as eq11, eq13_surface_diffusion as eq13,
    eq14_bulk_diffusion as eq14)
from force_diffusion.derivations.framework.vocabulary import (
    FIRST_ORDER, ClosedForm, Derivation, Domain, Groups, Steps, Symbol, asymptotic, axioms,
    equation, instance, layers, moment, power, power_law, rewrite, tensile, terms, times, usual)
from force_diffusion.symbolic.kernel.domain import AT_FIXED_RATIO, at_large_height
from force_diffusion.symbolic.symbols import (
    DeltaX, Dot, H_M, M, Mean, Tensile, UnitHeight, Variance, i, j, m, n_minus, n_plus, phi, r,
    sigma, z)
from sympy import Rational
# fmt: on

DEVIATION = Symbol("relative_deviation", r"\frac{\sigma_f}{\langle f\rangle}", "σ_f/⟨f⟩")
HEIGHT = Symbol("M_star", "M^{*}", "M*", positive=True)
MEAN_SQUARE = Symbol(
    "mean_square", r"\overline{\sigma_f^2/\langle f\rangle^2}", "mean of σ_f²/⟨f⟩²"
)
FRACTION = Symbol("tensile", "P(f<0)", "P(f < 0)")

PRINTED = equation(DEVIATION, times(power(M, Rational(3, 2)), sigma, 1 / r))
PRINTED_HEIGHT = equation(HEIGHT, power(times(sigma, 1 / r), Rational(-2, 3)))

LOADS = ("surface", "bulk")
FORCE = {"surface": eq11.PRINTED.lhs, "bulk": eq14.RATIO}
"""The force of contact (i, j) over its mean."""
IN_RADII = {"surface": eq11.in_radii, "bulk": eq14.in_radii}
LOADING = {"surface": axioms.SURFACE, "bulk": axioms.BULK}
OF_LAYER = {"surface": eq13.DERIVATION, "bulk": eq14.DERIVATION}

LEADING = {"surface": sympy.Integer(1), "bulk": Rational(1, 5)}
"""Mean of σ_f²/⟨f⟩² over the layers, in units of M³ (σ/r)²/(1−φ²)²."""
NEXT = {"surface": -Rational(1, 2), "bulk": Rational(11, 40)}
"""Its next order, in units of M² (σ/r)²/(1−φ²)²."""
HEIGHT_SHIFT = {"surface": Rational(1, 6), "bulk": Rational(-11, 24)}
"""M at which the exact mean is 1, less M*, as M* → ∞."""

PROFILES = {
    "surface": times(2, (1 - z) ** 2, 1 + 2 * z),
    "bulk": times(Rational(3, 2), (1 - z) ** 2, 1 + 4 * z),
}
"""σ_f²/⟨f⟩² at leading order in units of (M/M*)³."""
BELOW_THE_PEAK = {
    "surface": (sympy.Integer(2), 2 * z**2 * (3 - 2 * z)),
    "bulk": (Rational(125, 72), (1 - 6 * z) ** 2 * (17 - 12 * z) / 72),
}
"""The largest value of a profile, at z = 0 and 1/6, and what a profile is below it."""


def mean(load: str, kind: type) -> sympy.Expr:
    """The mean over the layers of what depends on a force over its mean.

    The contacts are those that start at the beads (j, j), one in each layer.
    """
    return sympy.Sum(kind(FORCE[load].xreplace({i: m, j: m})), (m, 0, M - 1)) / M


@cache
def of_layers(load: str) -> Groups:
    """What Eq. 13 or 14 says exactly of the contact that starts at bead (m, m)."""
    at, exact = {i: m, j: m}, OF_LAYER[load].exact_theorems
    return tuple(instance(theorem, at, theorem.domain.put_in(at)) for theorem in exact)


def all_of(load: str) -> Groups:
    """The same, and what gives moments of other forces."""
    return *of_layers(load), *IN_RADII[load]()


def heights(load: str) -> Domain:
    """Packings of every height under a load."""
    return Domain.of(indices=(M,), loading=LOADING[load])


def meaning(load: str) -> dict[sympy.Symbol, sympy.Expr]:
    """What the symbols stand for."""
    square = mean(load, Variance)
    return {
        MEAN_SQUARE: square,
        DEVIATION: power(square, sympy.S.Half),
        HEIGHT: UnitHeight(square),
        FRACTION: mean(load, Tensile),
    }


def two_orders(load: str) -> sympy.Eq:
    """The mean of σ_f²/⟨f⟩² to its two leading orders."""
    return equation(MEAN_SQUARE, times(terms(LEADING[load] * M**3, NEXT[load] * M**2), layers.UNIT))


def critical_height(load: str) -> sympy.Eq:
    """M*: where the leading order of the mean of σ_f²/⟨f⟩² is 1."""
    root = power(times(terms(1, -(phi**2)), r, 1 / sigma), Rational(2, 3))
    return equation(HEIGHT, times(LEADING[load] ** Rational(-1, 3), root))


def tensile_fraction(load: str) -> sympy.Expr:
    """Expected fraction of tensile contacts at M ≫ 1 as a function of M/M*."""
    ratio = power(times(HEIGHT, 1 / M), Rational(3, 2))
    number, square, rest = PROFILES[load].args
    over_roots = power(2 * number, Rational(-1, 2)), power(rest, Rational(-1, 2))
    inner = times(ratio, over_roots[0], power(square.base, -1), over_roots[1])
    half = times(sympy.S.Half, sympy.erfc(inner, evaluate=False))
    return sympy.Integral(half, (z, 0, 1))


NEGATIVE = (
    "A Gaussian force of mean 1 and variance v is tensile with the probability ½ erfc(1/√(2v)). To "
    "first order the forces are Gaussian for normal radii and, in the limit, for all radii of "
    "finite variance: no radius dominates (Eqs. 13 and 14), which is what Lindeberg's theorem "
    "needs. Averaged over the layers as M → ∞ at fixed M/M*, the expected fraction under a surface "
    "load is"
)


def show_steps(steps: Steps) -> None:
    """Average the exact variances; set the average to one; count negative Gaussian forces."""
    for load, how in (
        ("surface", "layers hold equally many contacts, so their mean is that over the layers"),
        ("bulk", "the same under a bulk load"),
    ):
        layers.show_closed_form(steps, how, DERIVATION.exact_forms[load])
    in_proportion = at_large_height("∝")
    for reason, formula, rule, limit in (
        (
            "The two leading orders of the mean, up to terms of order M, under a surface load and "
            "under a bulk load:",
            two_orders, asymptotic, at_large_height("∼", 2),
        ),
        ("Under both loads its root goes as printed.", lambda _: PRINTED, power_law, in_proportion),
        (
            "M* is defined here as the height at which the leading order of this mean is one. "
            "Under both loads it scales as the paper says.",
            lambda _: PRINTED_HEIGHT, power_law, in_proportion,
        ),
        (
            "With its prefactor, under a surface load and under a bulk load:",
            critical_height, power_law, at_large_height("="),
        ),
    ):  # fmt: skip
        steps.show(
            reason,
            sympy.Tuple(*map(formula, LOADS)),
            [rule(*of_layers(load)) for load in LOADS],
            [heights(load).in_the_limit(limit) for load in LOADS],
            [meaning(load) for load in LOADS],
        )
    ones = steps.claim(
        "under both loads the mean of a force over its mean is one in every layer",
        sympy.Tuple(*(equation(Mean(FORCE[load]), sympy.S.One) for load in LOADS)),
        [moment(*IN_RADII[load]()) for load in LOADS],
        [eq11.LAYERS.loaded(LOADING[load]) for load in LOADS],
    )
    for load, of_one in zip(LOADS, ones.theorems, strict=True):
        steps.show(
            NEGATIVE if load == "surface" else "In the same way, under a bulk load:",
            equation(FRACTION, tensile_fraction(load)),
            tensile(OF_LAYER[load].theorem, of_one, *of_layers(load)),
            heights(load).in_the_limit(AT_FIXED_RATIO),
            meaning(load),
        )
    claims(steps)


def claims(steps: Steps) -> None:
    """What else follows."""
    for load in LOADS:
        shift = HEIGHT_SHIFT[load]
        shifted, sign = power(terms(M, -shift), 3), "−" if shift < 0 else "+"
        steps.claim(
            f"as M* → ∞ the exact mean is 1 at M* {sign} {abs(shift)} under a {load} load",
            equation(MEAN_SQUARE, times(LEADING[load], shifted, layers.UNIT)),
            asymptotic(*of_layers(load)),
            heights(load).in_the_limit(at_large_height("∼", 2)),
            meaning(load),
        )
        top, below = BELOW_THE_PEAK[load]
        steps.claim(
            f"to leading order σ_f²/⟨f⟩² is at most {top} (M/M*)³ under a {load} load",
            equation(terms(top, times(-1, PROFILES[load])), below),
            rewrite(),
            Domain(),
        )
    steps.claim(
        "displacements are of order M^(1/2) σ, so they reach r at a height of order (σ/r)^(−2), "
        "far above M*",
        sympy.Tuple(
            *(
                equation(Variance(Dot(unit, DeltaX(i, j))), (4 * j - 2) * sigma**2)
                for unit in (n_plus, n_minus)
            )
        ),
        moment(eq03.positions()),
        Domain.of(j >= 2),
    )


DERIVATION = Derivation(
    number=15,
    name="general_form",
    title="Average over the system, and the height of tensile contacts",
    symbols=(
        (DEVIATION, "root mean square over all contacts"),
        (HEIGHT, "height at which the leading order of the mean of σ_f²/⟨f⟩² is one"),
        (MEAN_SQUARE, "mean of σ_f²/⟨f⟩² over all contacts"),
        (FRACTION, "expected fraction of contacts with f < 0"),
        *usual(H_M, sigma, r, M, z, phi),
    ),
    assumptions=(
        *FIRST_ORDER,
        "printed form: M → ∞; exact averages: every M",
        "the fraction of tensile contacts: Gaussian forces, M → ∞ at fixed M/M*",
    ),
    printed=(PRINTED, PRINTED_HEIGHT),
    domain=heights("surface").in_the_limit(at_large_height("∝")),
    show_steps=show_steps,
    step_domain=Domain(),
    deciders=lambda: [power_law(*all_of("surface"))],
    exact=lambda: {
        load: ClosedForm(MEAN_SQUARE, mean(load, Variance), heights(load), partial(all_of, load))
        for load in LOADS
    },
    remarks=(
        "The paper writes M* = O[(σ/r)^(−2/3)] in the text. Here it is proved as ∝ for the M* "
        "defined above, with the prefactor (1−φ²)^(2/3) for a surface load, and 5^(1/3) times that "
        "for a bulk load.",
        "M* is our definition; the paper says only that a finite fraction of the forces is "
        "negative there. The fraction above bears this out: it lies between 0 and ½, as half of an "
        "error function does, and depends on M/M* alone.",
        "The fraction of tensile contacts is an estimate: to first order in δr the forces are "
        "Gaussian exactly for normal radii, and otherwise in the limit. The limit is Lindeberg's "
        "theorem, which is quoted; its condition is proved here.",
        "For the expected number of tensile contacts to vanish, rather than their fraction, the "
        "paper expects a much lower M*. With Gaussian forces it is enough, to leading order, to "
        "divide M* by the cube root of 8c ln M, c > 1, if the packing is as wide as it is high: by "
        "a logarithm, not by another power of σ/r. The bound on the variance, proved here, makes "
        "1/(2σ_f²), with σ_f relative to the mean, at least 2c ln M; Chernoff's inequality, "
        "P(f<0) ≤ exp[−1/(2σ_f²)] = M^(−2c) for each of the M² contacts, is quoted.",
    ),
)

if __name__ == "__main__":
    from force_diffusion.derivations.commands.cli import run_alone

    raise SystemExit(run_alone(15))
