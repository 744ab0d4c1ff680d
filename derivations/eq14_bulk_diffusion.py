"""Eq. 14: variance of the contact forces under a bulk load; exact, and to leading order."""

from collections.abc import Iterator
from functools import cache

import sympy
from force_diffusion.derivations import eq04_contact_plus as eq04
from force_diffusion.derivations import eq05_contact_minus as eq05
from force_diffusion.derivations import eq06_force_balance as eq06
from force_diffusion.derivations import eq11_total_force as eq11
from force_diffusion.derivations import eq12_delta_weights as eq12
from force_diffusion.derivations import eq13_surface_diffusion as eq13
from force_diffusion.derivations.framework.exact_cases import exact_cases, exact_steps
from force_diffusion.derivations.framework.record import Claim, Derivation, ExactCase, Step, Witness
from force_diffusion.derivations.witnesses import squared_weights as witnesses
from force_diffusion.symbolic.algebra import affine
from force_diffusion.symbolic.algebra.affine import Region
from force_diffusion.symbolic.algebra.exact import FIELD
from force_diffusion.symbolic.algebra.reading import Reader
from force_diffusion.symbolic.as_printed import equation, power, terms, times
from force_diffusion.symbolic.kernel.decisions import (
    Ruling,
    all_of,
    decide_identity,
    decide_vector_identity,
    from_test,
    proved,
    undecided,
)
from force_diffusion.symbolic.kernel.searches import LAYERS, parts_in_the_limit
from force_diffusion.symbolic.notation import Symbol
from force_diffusion.symbolic.symbols import (
    ForceMinus,
    ForcePlus,
    Load,
    M,
    i,
    j,
    k,
    l,
    m,
    m_g,
    n_y,
    phi,
    r,
    sigma,
    z,
)
from force_diffusion.symbolic.variances.certified_sums import certified_sum
from force_diffusion.symbolic.variances.orders import (
    compare_leading_order,
    edges_follow,
    next_order_is,
    no_radius_dominates,
    weights_follow,
)
from force_diffusion.symbolic.variances.variance import ClosedForm, exact_variances, order
from force_diffusion.symbolic.variances.weights import take_apart

RELATIVE_VARIANCE = Symbol(
    "relative_variance", r"\frac{\sigma_f^2(z)}{\langle f\rangle_z^2}", "σ_f²(z)/⟨f⟩_z²"
)
MEAN_FORCE = Symbol("mean_force", r"\langle f\rangle_z", "⟨f⟩_z")

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
def exact_forms() -> dict[str, ClosedForm]:
    """Exact σ_f²/⟨f⟩_z² under a bulk load at every layer, from Eq. 11 site by site."""
    return exact_variances(eq11.in_radii(bulk_force()))


def at_finite_size() -> dict[str, ExactCase]:
    """The exact forms, case by case."""
    return exact_cases(RELATIVE_VARIANCE, exact_forms())


def bulk_weights() -> tuple[sympy.Expr, sympy.Expr]:
    """Weights of Δ for m ≤ j and for m > j: those of Eq. 12 summed over l, over M − j."""
    below = certified_sum(l - j, l, j + 1, M) / (M - j)
    above = certified_sum(l - m, l, m, M) / (M - j)
    return below, above


AVERAGED = times(M - m, M - m + 1) / (2 * (M - j))
"""The weight of Δ for m > j, as a person would write it."""


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
    below, _ = bulk_weights()
    yield Step(
        "The weights of Δ in Eq. 12, averaged: for m ≤ j and for m > j",
        sympy.Tuple(sympy.cancel(below), AVERAGED),
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
    if candidate.lhs != RELATIVE_VARIANCE:
        return undecided("the left-hand side is not σ_f²/⟨f⟩²")
    return compare_leading_order(exact_forms()["interior"].value, candidate.rhs)


def search(candidate: sympy.Eq) -> str | None:
    """Values at growing M where the candidate and the exact variance part."""
    return parts_in_the_limit(exact_forms()["interior"].expression, candidate.rhs, LAYERS)


def _weights() -> Ruling:
    ordered = weights_follow(
        sum_of_weights() * eq12.PREFACTOR**2 * sigma**2,
        PRINTED.rhs,
        "6σ² Σ w² of the averaged weights has the printed leading order",
    )
    return all_of(ordered, decide_identity(bulk_weights()[1], AVERAGED))


def _mean() -> Ruling:
    ordered = certified_sum(m_g / (2 * n_y), l, j + 1, M)
    in_z = ordered.xreplace({j: z * M})
    return all_of(
        decide_identity(ordered, (M - j) * m_g / (2 * n_y)),
        decide_identity(in_z, M * m_g * (1 - z) / (2 * n_y)),
    )


def _superposition() -> Ruling:
    """What lets a load on layer l be treated as the surface load of a packing of height l.

    The balance is linear in forces and load, and the contacts that carry it, those below layer
    l, have directions that depend on radii of layers up to l alone.
    """
    balance = eq06.PRINTED.lhs
    atoms = ForcePlus(*eq06.LEFT), ForceMinus(*eq06.RIGHT), Load(k, l)
    forces = sympy.symbols("f_1 g_1 f_2 g_2")
    one, two = (*forces[:2], Load(0, 1)), (*forces[2:], Load(0, 2))
    both = [a + b for a, b in zip(one, two, strict=True)]
    carried = [balance.xreplace(dict(zip(atoms, case, strict=True))) for case in (one, two, both)]
    linear = decide_vector_identity(carried[0] + carried[1], carried[2])
    region = Region({j: 1})
    top = affine.from_sympy(j + 1)
    for direction in (eq04.contact_direction(i, j), eq05.contact_direction(i, j)):
        for component in Reader(region).vector(direction):
            pieces = take_apart(component, region)
            ends = [run.last for run in pieces.runs] + [site.j for site in pieces.special]
            if not all(region.nonnegative(affine.add(top, end, -1)) for end in ends):
                return undecided("a contact's direction depends on a layer above it")
    return all_of(linear, proved("a contact's direction depends on radii of layers ≤ j + 1"))


def _one_layer_below_the_surface() -> Ruling:
    difference = exact_forms()["surface"].value - eq13.exact_forms()["surface"].value
    return from_test(
        difference.is_zero(),
        "at j = M − 1 only the surface beads load the contact: Eqs. 13 and 14 agree",
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


def _maximum_at_finite_height() -> Ruling:
    """The slope in j of the two leading orders at j = M/6 − 5/24; lower ones change it by M⁰."""
    unit = (sigma / r) ** 2 / (1 - phi**2) ** 2
    slope = sympy.diff(PRINTED.rhs.doit() / unit + next_order(), z) / M
    at_maximum = sympy.Rational(1, 6) - sympy.Rational(5, 24) / M
    left = order(FIELD.from_sympy(slope.xreplace({z: at_maximum})))
    return from_test(
        left <= 0,
        "the slope there is of order M⁰, its derivative in j of order M¹: the maximum is at "
        "M/6 − 5/24 up to a shift that vanishes as M → ∞",
        f"the slope there is of order M^{left}",
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
    premises=(
        eq04.DERIVATION,
        eq05.DERIVATION,
        eq06.DERIVATION,
        eq11.DERIVATION,
        eq12.DERIVATION,
        eq13.DERIVATION,
    ),
    printed=(PRINTED,),
    relation="∼",
    exact=at_finite_size,
    steps=steps,
    decide=decide,
    search=search,
    claims=(
        Claim(
            "loads superpose, and one on layer l feels radii of layers ≤ l alone", _superposition
        ),
        Claim("the mean force is M m g (1 − z)/2n_y", _mean),
        Claim("the squared weights of Eq. 12, averaged over l, sum to the printed form", _weights),
        Claim(
            "the next order in M", lambda: next_order_is(exact_forms(), PRINTED.rhs, next_order())
        ),
        Claim(
            "exact forms at the base and below the surface",
            lambda: edges_follow(exact_forms(), PRINTED.rhs),
        ),
        Claim(
            "no radius has more than O(1/M) of the variance, in any layer",
            lambda: no_radius_dominates(eq11.in_radii(bulk_force()), exact_forms()),
        ),
        Claim("one layer below the surface both loads agree", _one_layer_below_the_surface),
        Claim(
            "the maximum is at z = 1/6; the unnormalised variance is stationary at the base",
            _corollaries,
        ),
        Claim("at finite M the maximum is at j = M/6 − 5/24 + …", _maximum_at_finite_height),
    ),
    witnesses=(
        Witness(
            "exact variances equal sums of squared weights of exact packings, all j < M ≤ 4",
            lambda packing: witnesses.variances(exact_forms(), "bulk", packing),
        ),
    ),
)

if __name__ == "__main__":
    from force_diffusion.derivations.commands.alone import run_alone

    raise SystemExit(run_alone(DERIVATION))
