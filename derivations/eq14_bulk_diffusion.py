"""Eq. 14: variance of the contact forces under a bulk load; exact, and to leading order."""

from collections.abc import Iterator
from functools import cache

import sympy

from derivations import eq11_total_force as eq11
from derivations import eq12_delta_weights as eq12
from derivations import eq13_surface_diffusion as eq13
from derivations import witnesses
from derivations.asymptotics import compare_leading_order, exact_steps
from derivations.record import Claim, Derivation, Step, Witness
from derivations.runner import run_alone
from symbolic.as_printed import equation, power, terms, times
from symbolic.certified_sums import certified_sum
from symbolic.exact import FIELD
from symbolic.kernel import Ruling, all_of, decide_identity, from_test
from symbolic.printing.text import text
from symbolic.symbols import ForcePlus, M, i, j, l, m, m_g, n_y, phi, r, sigma, z
from symbolic.variance import ExactForm, exact_variances, leading

RELATIVE_VARIANCE = sympy.Symbol(r"\sigma_f^2(z)/\langle f\rangle_z^2")
MEAN_FORCE = sympy.Symbol(r"\langle f\rangle_z")

PRINTED = equation(
    RELATIVE_VARIANCE,
    times(
        3 * M**3 / (10 * (1 - phi**2) ** 2),
        terms(1, -z) ** 2,
        terms(times(4, z), 1),
        power(times(sigma, 1 / r), 2),
    ),
)


def bulk_force() -> sympy.Expr:
    """f⁺_ij over its ordered value (M − j) m g/2n_y: Eq. 11 for a load on each layer above j.

    A load on layer l feels the geometry up to layer l alone, so it acts as the surface load of
    a packing of height l; loads add up because force balance is linear.
    """
    return sympy.Sum(eq11.PRINTED.rhs.xreplace({M: l}), (l, j + 1, M)) / (M - j)


@cache
def exact_forms() -> dict[str, ExactForm]:
    """Exact σ_f²/⟨f⟩_z² under a bulk load at every layer, from Eq. 11 site by site."""
    return exact_variances(eq11.in_radii(bulk_force()))


def bulk_weights() -> tuple[sympy.Expr, sympy.Expr]:
    """Weights of Δ for m ≤ j and for m > j: those of Eq. 12 summed over l, over M − j."""
    below = certified_sum(l - j, l, j + 1, M) / (M - j)
    above = certified_sum(l - m, l, m, M) / (M - j)
    return below, above


def sum_of_weights() -> sympy.Expr:
    """6 Σ w² over the second differences, by SymPy, each sum with its certificate."""
    below, above = bulk_weights()
    scale = (M - j) ** 2
    lower = certified_sum(sympy.expand(below**2 * scale), m, sympy.Integer(1), j)
    upper = certified_sum(sympy.expand(above**2 * scale), m, j + 1, M)
    return 6 * (lower + upper) / scale


def steps() -> Iterator[Step]:
    """Superpose the surface loads of all layers above the contact."""
    yield Step(
        "The weight of the beads in layer l acts as the surface load of a packing of "
        "height l. The ordered forces of the layers above j add up to",
        equation(MEAN_FORCE, (M - j) * m_g / (2 * n_y)),
    )
    yield Step(
        "In units of this mean, f⁺_ij is the average of Eq. 11 over the heights l = j+1, …, M.",
        equation(
            ForcePlus(i, j) / MEAN_FORCE,
            times(1 / (M - j), sympy.Sum(eq11.PRINTED.rhs.xreplace({M: l}), (l, j + 1, M))),
        ),
    )
    below, above = bulk_weights()
    yield Step(
        "The weights of Δ in Eq. 12, averaged: for m ≤ j and for m > j",
        sympy.Tuple(sympy.factor(below), sympy.factor(above)),
    )
    yield Step("Six times the sum of their squares has the leading order printed.", PRINTED)
    yield from exact_steps(RELATIVE_VARIANCE, exact_forms())
    yield Step("The next order in M at fixed z, relative to (σ/r)²/(1−φ²)²:", next_order())
    profile = times(terms(1, -z) ** 2, terms(times(4, z), 1))
    yield Step(
        "The profile is largest at z = 1/6.",
        equation(sympy.Derivative(profile, z), sympy.factor(sympy.diff(profile.doit(), z))),
    )


def next_order() -> sympy.Expr:
    """The M² term of the exact variance at fixed z, without (σ/r)²/(1−φ²)²."""
    return sympy.Rational(3, 8) * M**2 * (1 - z) ** 2


def decide(_: int, candidate: sympy.Eq) -> Ruling:
    """The exact variance less the candidate is of order M² at most."""
    return compare_leading_order(exact_forms()["interior"].value, candidate.rhs)


def _weights() -> Ruling:
    total = FIELD.from_sympy(sum_of_weights() * eq12.PREFACTOR**2 * sigma**2)
    printed = FIELD.from_sympy(PRINTED.rhs.xreplace({z: j / M}))
    return from_test(
        (leading(total) - leading(printed)).is_zero(),
        "6σ² Σ w² of the averaged weights has the printed leading order",
    )


def _mean() -> Ruling:
    ordered = certified_sum(m_g / (2 * n_y), l, j + 1, M)
    in_z = ordered.xreplace({j: z * M})
    return all_of(
        decide_identity(ordered, (M - j) * m_g / (2 * n_y)),
        decide_identity(in_z, M * m_g * (1 - z) / (2 * n_y)),
    )


def _edges() -> Ruling:
    forms = exact_forms()
    at_zero = FIELD.from_sympy(PRINTED.rhs.xreplace({z: sympy.Integer(0)}))
    surface = FIELD.from_sympy(2 * M * (1 + phi**2) * (sigma / r) ** 2 / (1 - phi**2) ** 2)
    return from_test(
        (leading(forms["base"].value) - at_zero).is_zero()
        and (leading(forms["surface"].value) - surface).is_zero(),
        "at j = 0 the leading order is Eq. 14 at z = 0; at j = M − 1 it is 2(1+φ²) M",
    )


def _one_layer_below_the_surface() -> Ruling:
    difference = exact_forms()["surface"].value - eq13.exact_forms()["surface"].value
    return from_test(
        difference.is_zero(),
        "at j = M − 1 only the surface beads load the contact: Eqs. 13 and 14 agree",
    )


def _next_order() -> Ruling:
    value = exact_forms()["interior"].value
    scale = (sigma / r) ** 2 / (1 - phi**2) ** 2
    rest = value - FIELD.from_sympy(PRINTED.rhs.xreplace({z: j / M}))
    expected = FIELD.from_sympy((next_order() * scale).xreplace({z: j / M}))
    return from_test(
        (leading(rest) - expected).is_zero(),
        f"the next order is {text(next_order())} (σ/r)²/(1−φ²)²",
    )


def _corollaries() -> Ruling:
    profile = (1 - z) ** 2 * (4 * z + 1)
    slope = sympy.diff(profile, z)
    maximum = sympy.Rational(1, 6)
    unnormalised = sympy.diff((1 - z) ** 2 * profile, z)
    curvature = sympy.diff(profile, z, 2).xreplace({z: maximum})
    negative = curvature.is_Rational and curvature < 0
    return all_of(
        decide_identity(slope, 2 * (1 - z) * (1 - 6 * z)),
        decide_identity(slope.xreplace({z: maximum}), sympy.Integer(0)),
        from_test(
            bool(negative),
            "the slope is 2(1−z)(1−6z): one maximum, at z = 1/6; without "
            "the normalisation it is −20z(1−z)³, zero at the base",
        ),
        decide_identity(unnormalised, -20 * z * (1 - z) ** 3),
    )


DERIVATION = Derivation(
    number=14,
    name="bulk_diffusion",
    title="Variance of the forces under a bulk load",
    symbols=(
        (sigma, "standard deviation σ_δr of the radii"),
        (r, "mean radius"),
        (M, "height of the packing"),
        (z, "relative height j/M"),
        (phi, "n⁺·n⁻"),
        (m_g, "weight of a bead"),
    ),
    assumptions=(
        "the radii are independent, of zero mean and variance σ²",
        "first order in δr",
        "every bead above the base weighs mg, whatever its radius",
        "printed form: M → ∞ at fixed z; exact form: every 0 ≤ j < M",
    ),
    premises=(eq11.DERIVATION, eq12.DERIVATION, eq13.DERIVATION),
    printed=(PRINTED,),
    relation="∼",
    steps=steps,
    decide=decide,
    claims=(
        Claim("the mean force is M m g (1 − z)/2n_y", _mean),
        Claim("the squared weights of Eq. 12, averaged over l, sum to the printed form", _weights),
        Claim("the next order in M", _next_order),
        Claim("exact forms at the base and below the surface", _edges),
        Claim("one layer below the surface both loads agree", _one_layer_below_the_surface),
        Claim(
            "the maximum is at z = 1/6; the unnormalised variance is stationary at the base",
            _corollaries,
        ),
    ),
    witnesses=(
        Witness(
            "exact variances equal sums of squared weights of exact packings, all j < M ≤ 4",
            lambda packing: witnesses.variances(exact_forms(), "bulk", packing),
        ),
    ),
)

if __name__ == "__main__":
    raise SystemExit(run_alone(DERIVATION))
