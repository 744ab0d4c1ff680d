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
from force_diffusion.derivations.framework import exact_cases
from force_diffusion.derivations.framework.follows import (
    by_certificate,
    certificate,
    differentiated,
    identity,
    states,
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
from force_diffusion.symbolic.algebra import affine
from force_diffusion.symbolic.algebra.affine import Region
from force_diffusion.symbolic.algebra.exact import FIELD
from force_diffusion.symbolic.algebra.reading import Reader
from force_diffusion.symbolic.algebra.signs import sign
from force_diffusion.symbolic.as_printed import equation, power, terms, times
from force_diffusion.symbolic.kernel.decisions import (
    Ruling,
    all_of,
    decide_vector_identity,
    from_test,
    proved,
    undecided,
)
from force_diffusion.symbolic.notation import Symbol
from force_diffusion.symbolic.printing.text import text
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
    n,
    n_y,
    phi,
    r,
    sigma,
    z,
)
from force_diffusion.symbolic.variances.orders import (
    UNIT,
    edges_follow,
    no_radius_dominates,
)
from force_diffusion.symbolic.variances.variance import (
    ClosedForm,
    exact_variances,
    leading,
    order,
)
from force_diffusion.symbolic.variances.weights import take_apart

RELATIVE_VARIANCE = Symbol(
    "relative_variance", r"\frac{\sigma_f^2(z)}{\langle f\rangle_z^2}", "σ_f²(z)/⟨f⟩_z²"
)
MEAN_FORCE = Symbol("mean_force", r"\langle f\rangle_z", "⟨f⟩_z", positive=True)

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


AVERAGED = (
    times(sympy.Rational(1, 2), terms(M, -j, 1)),
    times(1 / (2 * (M - j)), terms(M, -m), terms(M, -m, 1)),
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
HIGHEST = times(sympy.Rational(3, 10), (M - j) ** 2, terms(M, 4 * j))


REST = (30 * M**2 * j - 5 * M**2 - 60 * M * j**2 + 25 * M * j + 30 * j**3 - 20 * j**2 + 2) / (
    10 * (M - j)
)
"""Six times the sum of their squares is HIGHEST and this."""


def _highest_term(_: int, candidate: sympy.Eq) -> Ruling:
    """The first term of the sum at z = j/M; the rest is of lower order."""
    rest = order(FIELD.from_sympy(REST))
    return all_of(
        identity({z: j / M})(0, candidate),
        from_test(rest < order(FIELD.from_sympy(HIGHEST)), f"the rest is of order M^{rest}"),
    )


def steps() -> Iterator[Step]:
    """Superpose the surface loads of all layers above the contact."""
    yield Step(
        "The weight of the beads in layer l acts as the surface load of a packing of "
        "height l. The ordered forces of the layers above j add up to",
        sympy.Tuple(
            equation(MEAN_FORCE, (M - j) * m_g / (2 * n_y)),
            equation(MEAN_FORCE, M * m_g * (1 - z) / (2 * n_y)),
        ),
        summed({MEAN_FORCE: sympy.Sum(m_g / (2 * n_y), (l, j + 1, M)), z: j / M}),
        ("Eq. 11",),
    )
    ratio = ForcePlus(i, j) / MEAN_FORCE
    yield Step(
        "In units of this mean, f⁺_ij is the average of Eq. 11 over the heights l = j+1, …, M.",
        equation(
            ratio,
            times(1 / (M - j), sympy.Sum(eq11.PRINTED.rhs.xreplace({M: l}), (l, j + 1, M))),
        ),
        states(equation(ratio, bulk_force()), region=eq11.INTERIOR),
        ("Eq. 11", "step 1"),
    )
    yield Step(
        "So the weights of Δ in Eq. 12 are averaged, for m ≤ j and for m > j:",
        sympy.Tuple(*map(equation, OVER_HEIGHTS, AVERAGED)),
        summed(),
        ("Eq. 12", "step 2"),
    )
    up_to_n = n * (n + 1) * (n + 2) * (3 * n**2 + 6 * n + 1) / 15
    yield Step(
        "Their squares are summed with a certificate: with M − m for m the second sum is, but for "
        "its factor, this one up to n = M − j − 1. It is zero at n = 0.",
        sympy.Tuple(*certificate(sympy.Sum(m**2 * (m + 1) ** 2, (m, 1, n)), up_to_n)),
        by_certificate,
    )
    yield Step(
        "Six times the sum of their squares:", equation(WEIGHTS, terms(HIGHEST, REST)), summed()
    )
    yield Step(
        "The first term has the highest order. With the prefactor of Eq. 12 squared it is the "
        "printed form at z = j/M.",
        equation(times(eq12.PREFACTOR**2, sigma**2, HIGHEST), PRINTED.rhs),
        _highest_term,
        ("step 3", "step 5"),
    )
    yield Step(
        "What Eq. 12 drops does not change it: the printed form is the leading order of the exact "
        "variance, which follows.",
        PRINTED,
        decide,
        ("step 2", "step 6"),
    )
    yield from exact_cases.variance_steps(
        RELATIVE_VARIANCE, ratio, eq11.in_radii(bulk_force()), exact_forms(), 7
    )
    yield exact_cases.next_order(
        RELATIVE_VARIANCE, PRINTED.rhs, exact_forms(), next_order(), "Eq. 14", "step 10"
    )
    profile = times(terms(1, -z) ** 2, terms(times(4, z), 1))
    yield Step(
        "The profile rises up to z = 1/6 and falls from there on. Without the normalisation it "
        "would be stationary at the base.",
        sympy.Tuple(
            equation(sympy.Derivative(profile, z), 2 * (1 - z) * (1 - 6 * z)),
            equation(
                sympy.Derivative(times(terms(1, -z) ** 2, profile), z), -20 * z * (1 - z) ** 3
            ),
        ),
        differentiated(),
        ("Eq. 14",),
    )


def next_order() -> sympy.Expr:
    """The M² term of the exact variance at fixed z, without (σ/r)²/(1−φ²)²."""
    return sympy.Rational(3, 8) * M**2 * (1 - z) ** 2


decide = exact_cases.to_leading_order(RELATIVE_VARIANCE, exact_forms)
"""The exact variance less a candidate is of order M² at most."""


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


def _one_maximum() -> Ruling:
    """The sign of the slope on both sides of z = 1/6; z runs from 0 to 1 in either case."""
    slope = sympy.diff((1 - z) ** 2 * (4 * z + 1), z)
    before, after = (slope.xreplace({z: part}) for part in (z / 6, (1 + 5 * z) / 6))
    return from_test(
        sign(before) == 1 and sign(after) == -1,
        "the slope is positive for 0 < z < 1/6 and negative for 1/6 < z < 1",
    )


def _maximum_at_finite_height() -> Ruling:
    """The slope of the exact form in j, at a fixed number of layers from j = M/6 − 5/24."""
    slope = exact_forms()["interior"].value.derivative(j) / FIELD.from_sympy(UNIT)
    place = FIELD.from_sympy(M / 6 - sympy.Rational(5, 24) + n)  # n stands for any number here
    at_place = slope.substitute({j: place}).reduced()
    found = leading(at_place, M)
    factor = found / (FIELD.generator(n) * FIELD.generator(M))
    steep = factor.to_sympy()
    return from_test(
        order(at_place, M) == 1 and bool(steep.is_Rational and steep < 0),
        f"c layers above it the slope of the exact form is {text(steep)} c M in units of "
        "(σ/r)²/(1−φ²)², to leading order: positive below, negative above, for every c",
        f"the slope there is {text(found.to_sympy())}",
    )


DERIVATION = Derivation(
    number=14,
    name="bulk_diffusion",
    title="Variance of the forces under a bulk load",
    symbols=(
        *usual(sigma, r, M, z, phi),
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
    loads=("bulk",),
    relation="∼",
    exact=lambda: exact_cases.exact_cases(RELATIVE_VARIANCE, exact_forms()),
    steps=steps,
    decide=decide,
    search=exact_cases.parting(RELATIVE_VARIANCE, exact_forms),
    claims=(
        Claim(
            "loads superpose, and one on layer l feels radii of layers ≤ l alone", _superposition
        ),
        Claim(
            "leading orders of the exact forms at the base and below the surface",
            lambda: edges_follow(exact_forms(), PRINTED.rhs),
        ),
        Claim(
            "at fixed z, and in the layers next to base and surface, no radius has more than "
            "O(1/M) of the variance: what Lindeberg's theorem needs",
            lambda: no_radius_dominates(eq11.in_radii(bulk_force()), exact_forms()),
        ),
        Claim("one layer below the surface both loads agree", _one_layer_below_the_surface),
        Claim("at fixed z the printed form has one maximum, at z = 1/6", _one_maximum),
        Claim(
            "there the exact form has a maximum at j = M/6 − 5/24, up to a shift that vanishes as "
            "M → ∞",
            _maximum_at_finite_height,
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
    from force_diffusion.derivations.commands.alone import run_alone

    raise SystemExit(run_alone(DERIVATION))
