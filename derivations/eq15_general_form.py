"""Eq. 15: σ_f/⟨f⟩ averaged over the system, and the height M* at which forces turn tensile."""

from functools import cache

import sympy
from force_diffusion.derivations import eq03_extrapolation as eq03
from force_diffusion.derivations import eq13_surface_diffusion as eq13
from force_diffusion.derivations import eq14_bulk_diffusion as eq14
from force_diffusion.derivations.formulas.closed_form import ClosedForm
from force_diffusion.derivations.framework.averaging import (
    density,
    expansion,
    integral,
    mean_of_roots,
    proportional,
    restated,
    tensile,
    total,
    unit_height,
)
from force_diffusion.derivations.framework.layered import Layered
from force_diffusion.derivations.framework.proving import Line
from force_diffusion.derivations.framework.record import FIRST_ORDER, usual
from force_diffusion.derivations.framework.vocabulary import (
    UNIT,
    Derivation,
    Lines,
    Where,
    differentiate,
    equation,
    moment,
    power,
    rewrite,
    terms,
    times,
)
from force_diffusion.symbolic.as_printed import in_place
from force_diffusion.symbolic.kernel.axioms import GAUSSIAN_BELOW
from force_diffusion.symbolic.kernel.where import AT_FIXED_RATIO, at_large_height
from force_diffusion.symbolic.notation import Symbol
from force_diffusion.symbolic.printing.text import text
from force_diffusion.symbolic.symbols import (
    DeltaX,
    Dot,
    M,
    Mean,
    Tensile,
    UnitHeight,
    Variance,
    i,
    j,
    k,
    m,
    n,
    n_minus,
    n_plus,
    phi,
    r,
    sigma,
    z,
)
from force_diffusion.symbolic.variances.averages import LayerAverage, layer_average
from sympy import Rational

DEVIATION = Symbol("relative_deviation", r"\frac{\sigma_f}{\langle f\rangle}", "σ_f/⟨f⟩")
MEAN_SQUARE = Symbol(
    "mean_square", r"\overline{\sigma_f^2/\langle f\rangle^2}", "mean of σ_f²/⟨f⟩²"
)
HEIGHT = Symbol("M_star", "M^{*}", "M*", positive=True)
TENSILE = Symbol("tensile", "P(f<0)", "P(f < 0)")
PRINTED = equation(DEVIATION, times(power(M, Rational(3, 2)), sigma, 1 / r))
PRINTED_HEIGHT = equation(HEIGHT, power(times(sigma, 1 / r), Rational(-2, 3)))

LOADS = {"surface": eq13, "bulk": eq14}

LEADING = {"surface": sympy.Integer(1), "bulk": Rational(1, 5)}
"""Mean of σ_f²/⟨f⟩² over the layers, in units of M³ (σ/r)²/(1−φ²)²."""

NEXT = {"surface": -Rational(1, 2), "bulk": Rational(11, 40)}
"""Its next order, in units of M² (σ/r)²/(1−φ²)²."""

HEIGHT_SHIFT = {"surface": Rational(1, 6), "bulk": Rational(-11, 24)}
"""M at which the exact mean is 1, less M*, as M* → ∞."""

ROOTS = {
    "surface": (sympy.Integer(2), terms(1, times(2, z)), (2 - z) / 5),
    "bulk": (Rational(3, 10), terms(1, times(4, z)), (11 - 6 * z) / 60),
}
"""a, b, Q: σ_f/⟨f⟩ goes as (1−z)√(ab), and √a Q b^(3/2) is an antiderivative of that."""

MEAN_DEVIATION = {
    "surface": sympy.sqrt(2) * (3 * sympy.sqrt(3) - 2) / 5,
    "bulk": sympy.sqrt(Rational(3, 10)) * (25 * sympy.sqrt(5) - 11) / 60,
}
"""Mean of σ_f/⟨f⟩ itself, in units of M^(3/2) (σ/r)/(1−φ²)."""


PROFILES = {
    "surface": times(2, terms(1, -z) ** 2, terms(1, times(2, z))),
    "bulk": times(Rational(3, 2), terms(1, -z) ** 2, terms(1, times(4, z))),
}
"""σ_f²/⟨f⟩² at leading order in units of (M/M*)³: their mean over z is 1."""

SPREAD = {
    "surface": times(2, terms(1, -z), power(terms(1, times(2, z)), sympy.S.Half)),
    "bulk": times(sympy.sqrt(3), terms(1, -z), power(terms(1, times(4, z)), sympy.S.Half)),
}
"""√(2 profile): what a Gaussian's error function has below one."""

BELOW_THE_PEAK = {
    "surface": (sympy.Integer(2), times(2, z**2, terms(3, times(-2, z)))),
    "bulk": (
        Rational(125, 72),
        times(Rational(1, 72), power(terms(1, times(-6, z)), 2), terms(17, times(-12, z))),
    ),
}
"""The largest value of a profile, at z = 0 and 1/6, and what a profile is below it."""


def tensile_fraction(load: str) -> sympy.Expr:
    """Expected fraction of tensile contacts at M ≫ 1 as a function of M/M*."""
    ratio = power(times(HEIGHT, 1 / M), Rational(3, 2))
    inner = times(ratio, power(SPREAD[load], -1))
    half = times(sympy.S.Half, sympy.erfc(inner, evaluate=False))
    return sympy.Integral(half, (z, 0, 1))


@cache
def averages() -> dict[str, LayerAverage]:
    """Exact mean of σ_f²/⟨f⟩² over all layers, for either load, as it is found."""
    return {load: layer_average(module.VARIANCE.form) for load, module in LOADS.items()}


def at_finite_size() -> dict[str, ClosedForm]:
    """The exact averages, load by load."""
    every = Where((M,), (sympy.Ge(M, 1, evaluate=False),))
    return {
        load: ClosedForm(MEAN_SQUARE, average.form, every, (LOADS[load].DERIVATION.number,))
        for load, average in averages().items()
    }


def critical_height(load: str) -> sympy.Expr:
    """M*: where the leading order of the mean of σ_f²/⟨f⟩² is 1."""
    scale = times(terms(1, -(phi**2)), r, 1 / sigma)
    number = LEADING[load] ** Rational(-1, 3)
    root = power(scale, Rational(2, 3))
    return root if number == 1 else times(number, root)


# what is averaged: the contacts that start at the beads (j, j), one in each layer


def force(load: str) -> sympy.Expr:
    """The force of contact (i, j) over its mean."""
    of = LOADS[load].VARIANCE
    (found,) = in_place(of.moment, of.meaning).args
    return found


def mean(load: str, kind: type, *, of_roots: bool = False) -> sympy.Expr:
    """The mean over the layers of what depends on a force over its mean, or of its root."""
    each = kind(force(load).xreplace({i: m, j: m}))
    return sympy.Sum(sympy.sqrt(each) if of_roots else each, (m, 0, M - 1)) / M


def heights(load: str, *relations: sympy.Basic) -> Where:
    """Packings of these heights under a load."""
    return Where((M,), relations or (M >= 3,), LOADS[load].VARIANCE.loading)


def every_layer(load: str) -> Layered:
    """What is proved of the variance in every layer."""
    return LOADS[load].VARIANCE


LARGE = at_large_height


@cache
def steps() -> Lines:
    """Average the exact variances; set the average to one; count negative Gaussian forces."""
    lines = Lines(Where())
    exact: dict[str, Line] = {}
    order: dict[str, Line] = {}
    square = {load: mean(load, Variance) for load in LOADS}
    meant = {load: {MEAN_SQUARE: square[load], k: n} for load in LOADS}
    for load, average in averages().items():
        layers = every_layer(load)
        exact[load] = lines.show(
            "The same number of contacts starts in every layer 0 ≤ j < M: the mean over all "
            f"contacts is the mean over the layers. Exact under a {load} load, M ≥ 3, those at the "
            "edges included, each sum of powers by a telescoping certificate:",
            equation(MEAN_SQUARE, average.expression),
            total(layers),
            where=heights(load),
            meaning=meant[load],
        )
        for height, value in average.exceptions:
            lines.show(
                f"… and at M = {height}:",
                equation(MEAN_SQUARE, value),
                total(layers),
                where=heights(load, sympy.Eq(M, height)),
                meaning=meant[load],
            )
    for load, module in LOADS.items():
        order[load] = lines.show(
            f"Its two leading orders, {load} load:",
            equation(MEAN_SQUARE, times(terms(LEADING[load] * M**3, NEXT[load] * M**2), UNIT)),
            expansion(exact[load]),
            where=heights(load).in_the_limit(LARGE("∼", 2)),
            meaning=meant[load],
        )
        lines.show(
            "The first of them is the mean of the printed variance:",
            equation(sympy.Integral(module.PRINTED.rhs, (z, 0, 1)), LEADING[load] * M**3 * UNIT),
            integral(),
            where=heights(load),
            after=(module.DERIVATION,),
        )
    unit = {load: {HEIGHT: UnitHeight(square[load])} for load in LOADS}
    of_height = {
        load: Line(
            "",
            equation(HEIGHT, critical_height(load)),
            unit_height(order[load]),
            heights(load).in_the_limit(LARGE("=")),
            unit[load],
        )
        for load in LOADS
    }
    in_proportion = {load: heights(load).in_the_limit(LARGE("∝")) for load in LOADS}
    root = {load: {DEVIATION: power(square[load], sympy.S.Half)} for load in LOADS}
    lines.show(
        "So its root goes as printed, for both loads alike.",
        PRINTED,
        proportional(order["surface"], exact["surface"]),
        where=in_proportion["surface"],
        meaning=root["surface"],
        alike=(
            Line(
                "",
                PRINTED,
                proportional(order["bulk"], exact["bulk"]),
                in_proportion["bulk"],
                root["bulk"],
            ),
        ),
    )
    for load, (_, base, q) in ROOTS.items():
        slope = lines.show(
            "The mean of σ_f/⟨f⟩ itself goes the same way with another prefactor, in units of "
            f"M^(3/2) (σ/r)/(1−φ²). Under a {load} load, for an antiderivative,",
            equation(
                sympy.Derivative(times(q, power(base, Rational(3, 2))), z),
                times(terms(1, -z), power(base, sympy.S.Half)),
            ),
            differentiate(sympy.Symbol("W", positive=True), base),
        )
        lines.show(
            "so that the mean is",
            equation(mean_root(load), MEAN_DEVIATION[load]),
            integral(slope),
            after=(LOADS[load].DERIVATION,),
        )
    lines.show(
        "M* is defined here as the height at which the leading order of the mean of σ_f²/⟨f⟩² is "
        "one. It goes as the paper says.",
        PRINTED_HEIGHT,
        proportional(order["surface"], exact["surface"], of_height["surface"]),
        where=in_proportion["surface"],
        meaning=unit["surface"],
        alike=(
            Line(
                "",
                PRINTED_HEIGHT,
                proportional(order["bulk"], exact["bulk"], of_height["bulk"]),
                in_proportion["bulk"],
                unit["bulk"],
            ),
        ),
    )
    for load in LOADS:
        of_height[load] = lines.show(
            f"With its prefactor, {load} load:",
            equation(HEIGHT, critical_height(load)),
            unit_height(order[load]),
            where=heights(load).in_the_limit(LARGE("=")),
            meaning=unit[load],
            after=tuple(order.values()),
        )
    gaussian = lines.show(
        "The probability of a Gaussian force below a given one, with mean 1 and variance v: its "
        "derivative is the density, and far below it vanishes.",
        GAUSSIAN_BELOW,
        density(),
    )
    for load, module in LOADS.items():
        ones = lines.claim(
            f"in every layer the mean of a force over its mean is one, {load} load",
            equation(Mean(force(load)), sympy.S.One),
            moment(*module.VARIANCE.facts),
            where=Where.of(j >= 0, j < M, loading=module.VARIANCE.loading),
        )
        lines.show(
            "At f = 0 it is ½ erfc(1/√(2v)), the probability of a tensile contact. The forces are "
            "Gaussian, to first order, for normal radii, and in the limit for all radii of finite "
            "variance: no radius dominates, by Eqs. 13 and 14, which is what Lindeberg's theorem "
            "needs. Averaged over the layers as M → ∞ at fixed M/M*, the expected fraction under a "
            f"{load} load is",
            equation(TENSILE, tensile_fraction(load)),
            tensile(every_layer(load), of_height[load], gaussian, ones),
            where=heights(load).in_the_limit(AT_FIXED_RATIO),
            meaning={TENSILE: mean(load, Tensile), **unit[load]},
        )
    claims(lines, exact, of_height)
    return lines


def claims(lines: Lines, exact: dict[str, Line], of_height: dict[str, Line]) -> None:
    """What else follows."""
    for load, module in LOADS.items():
        lines.claim(
            f"as M* → ∞ the exact mean is 1 at {text(HEIGHT + HEIGHT_SHIFT[load])}, {load} load",
            equation(
                MEAN_SQUARE, times(LEADING[load], power(terms(M, -HEIGHT_SHIFT[load]), 3), UNIT)
            ),
            expansion(exact[load]),
            where=heights(load).in_the_limit(LARGE("∼", 2)),
            meaning={MEAN_SQUARE: mean(load, Variance)},
        )
        lines.claim(
            "the mean of σ_f/⟨f⟩ itself is that of the root of the printed variance, to leading "
            f"order in M, {load} load",
            equation(DEVIATION, sympy.Integral(power(module.PRINTED.rhs, sympy.S.Half), (z, 0, 1))),
            mean_of_roots(every_layer(load)),
            where=heights(load).in_the_limit(LARGE("∼")),
            meaning={DEVIATION: mean(load, Variance, of_roots=True)},
        )
        lines.claim(
            f"at leading order σ_f²/⟨f⟩² is (M/M*)³ times a profile, {load} load",
            equation(module.PRINTED.lhs, times(power(times(M, 1 / HEIGHT), 3), PROFILES[load])),
            restated(module.DERIVATION, of_height[load]),
            where=module.VARIANCE.in_the_limit,
            meaning={**module.VARIANCE.meant, HEIGHT: UnitHeight(mean(load, Variance))},
        )
        lines.claim(
            f"the mean of that profile is one, {load} load",
            equation(sympy.Integral(PROFILES[load], (z, 0, 1)), sympy.S.One),
            integral(),
        )
        top, below = BELOW_THE_PEAK[load]
        lines.claim(
            f"so that σ_f²/⟨f⟩² is nowhere above {text(top)} (M/M*)³ at leading order, {load} load",
            equation(terms(top, times(-1, PROFILES[load])), below),
            rewrite(),
        )
    for unit in (n_plus, n_minus):
        lines.claim(
            "displacements are of order M^(1/2) σ, so of order r at a height (σ/r)^(−2), far above "
            f"M*: along {text(unit)} exactly",
            equation(Variance(Dot(unit, DeltaX(i, j))), (4 * j - 2) * sigma**2),
            moment(eq03.DERIVATION),
            where=Where.of(j >= 2),
        )


def mean_root(load: str) -> sympy.Expr:
    """∫ (1−z)√(ab) dz from 0 to 1."""
    a, base, _ = ROOTS[load]
    return sympy.Integral(times(terms(1, -z), power(times(a, base), sympy.S.Half)), (z, 0, 1))


DERIVATION = Derivation(
    number=15,
    name="general_form",
    title="Average over the system, and the height of tensile contacts",
    symbols=(
        (DEVIATION, "relative standard deviation of the forces: root of the mean of its square"),
        (HEIGHT, "height at which the leading order of the mean of σ_f²/⟨f⟩² is one"),
        (MEAN_SQUARE, "mean over all contacts"),
        (TENSILE, "expected fraction of contacts with f < 0"),
        *usual(sigma, r, M, z, phi),
    ),
    assumptions=(
        *FIRST_ORDER,
        "printed form: M → ∞; exact averages: every M",
        "the fraction of tensile contacts: Gaussian forces, M → ∞ at fixed M/M*",
    ),
    premises=(eq03.DERIVATION, eq13.DERIVATION, eq14.DERIVATION),
    printed=(PRINTED, PRINTED_HEIGHT),
    loads=("surface", "bulk"),
    relation="∝",
    exact=at_finite_size,
    steps=steps,
    where=heights("surface").in_the_limit(LARGE("∝")),
    remarks=(
        "The paper writes M* = O[(σ/r)^(−2/3)] in the text; it is checked here as ∝, with the "
        "definition given, and the prefactor is found: (1−φ²)^(2/3) for a surface load, 5^(1/3) "
        "times that for a bulk load.",
        "M* is a definition: the paper says of it that a finite fraction of the forces is negative "
        "there, which the fraction below bears out.",
        "The fraction of tensile contacts is an estimate: the forces are Gaussian exactly for "
        "normal radii and else in the limit, to first order in δr. That they are in the limit is "
        "Lindeberg's theorem; its condition is decided, the theorem is quoted.",
        "As the complementary error function of a positive number lies between 0 and 1, the "
        "fraction of tensile contacts lies between 0 and ½; it depends on M/M* alone, and is "
        "finite at heights of the order of M*.",
        "To let the expected number of tensile contacts vanish, rather than their fraction, the "
        "paper expects a much lower M*. With Gaussian forces M* divided by the cube root of "
        "8c ln M, c > 1, is enough for a square packing, to leading order: a logarithm, not "
        "another power of σ/r. The bound on the variance is decided, by which 1/2σ_f² is at least "
        "2c ln M there; Chernoff's inequality, P(f<0) ≤ exp(−1/2σ_f²) = M^(−2c) for each of the "
        "M² contacts, is quoted.",
    ),
)

if __name__ == "__main__":
    from force_diffusion.derivations.commands.alone import run_alone

    raise SystemExit(run_alone(DERIVATION))
