"""Eq. B17: mean contact stress under a bulk load, to second order."""

from collections.abc import Iterator
from functools import cache

import sympy
from force_diffusion.derivations import eq11_total_force as eq11
from force_diffusion.derivations import eq14_bulk_diffusion as eq14
from force_diffusion.derivations.beyond import b10_stress as b10
from force_diffusion.derivations.beyond import t4_second_order as t4
from force_diffusion.derivations.beyond.stress import (
    BY_FLUX,
    MEAN_XX,
    MEAN_YY,
    RATIO,
    SYMBOLS,
    VERTICAL,
    Stress,
    means,
)
from force_diffusion.derivations.framework.exact_cases import exact_cases, exact_steps
from force_diffusion.derivations.framework.follows import identity
from force_diffusion.derivations.framework.record import Claim, Derivation, Step, usual
from force_diffusion.symbolic.as_printed import equation, minus, power, terms, times
from force_diffusion.symbolic.kernel.decisions import Ruling, from_test
from force_diffusion.symbolic.symbols import M, j, phi, r, sigma

VARIANCE = power(times(sigma, 1 / r), 2)
HALF_UNIT = 1 / ((1 - phi**2) * (1 + phi)) / 2

PRINTED = (
    equation(
        terms(RATIO, -1),
        times(
            1 / (1 - phi**2) ** 2,
            terms(
                times(4, j),
                minus(times(4, phi, M)),
                times(phi**2, terms(1, -phi)),
                (1 - phi) ** 2 / (M - j),
            ),
            VARIANCE,
        ),
    ),
    equation(
        terms(VERTICAL, -1),
        times(
            HALF_UNIT,
            terms(1, minus(phi**2), minus(times(2, terms(M, -j))), minus((1 - phi) / (M - j))),
            VARIANCE,
        ),
    ),
    equation(
        terms(BY_FLUX, -1),
        times(
            HALF_UNIT,
            terms(1, times(6, j), minus(times(2, M)), minus((1 - phi) / (M - j))),
            VARIANCE,
        ),
    ),
)

STRESS = Stress("bulk", cache(lambda: eq11.in_radii(eq14.bulk_force())))


def steps() -> Iterator[Step]:
    """The means of Eq. B10; the first-order force is that of Eq. 14."""
    first, second = means()
    yield Step(
        "The weight of the beads does not fluctuate (Eq. B6), so that the means of Eq. B10 hold:",
        sympy.Tuple(equation(MEAN_XX, first), equation(MEAN_YY, second)),
        identity({MEAN_XX: first, MEAN_YY: second}),
        ("Eq. B4", "Eq. B6", "Eq. B10"),
    )
    yield Step(
        "α₁ is now that of Eq. 14. The ratio of the means, for 2 ≤ j ≤ M − 2:",
        PRINTED[0],
        lambda _, candidate: STRESS.decide(0, candidate),
        ("Eq. 11", "Eq. 14", "step 1"),
    )
    yield Step(
        "The vertical moment itself:",
        PRINTED[1],
        lambda _, candidate: STRESS.decide(1, candidate),
        ("Eq. 11", "Eq. 14", "step 1"),
    )
    yield from STRESS.flux_steps(1)
    yield Step(
        "The four covariances put in there:",
        PRINTED[2],
        lambda _, candidate: STRESS.decide(2, candidate),
        ("Eq. 11", "Eq. 14", "step 4"),
    )
    yield from exact_steps(
        RATIO - 1, STRESS.ratio(), "the four covariances there", "step 1", "step 2"
    )


def _leading() -> Ruling:
    stated = 4 * (j - phi * M) * (sigma / r) ** 2 / (1 - phi**2) ** 2
    return STRESS.leading_is(stated, "4M(z − φ)(σ/r)²/(1−φ²)²")


def _one_layer_below_the_surface() -> Ruling:
    loads = (STRESS, b10.STRESS)
    here, there = ([of()["surface"].value for _, of in stress.parts] for stress in loads)
    return from_test(
        all((one - other).is_zero() for one, other in zip(here, there, strict=True)),
        "at j = M − 1 Eqs. B10 and B17 agree",
    )


DERIVATION = Derivation(
    number="B17",
    name="stress_bulk",
    title="Mean contact stress under a bulk load, to second order",
    symbols=(*SYMBOLS, *usual(sigma, r, M, phi)),
    assumptions=(
        "the radii are independent, of zero mean and variance σ², of whatever law",
        "second order in δr",
        "every bead above the base weighs mg, whatever its radius",
        "printed form: 2 ≤ j ≤ M − 2; exact forms of the ratio: every 0 ≤ j < M",
    ),
    premises=(
        eq11.DERIVATION,
        eq14.DERIVATION,
        t4.B4,
        t4.B6,
        b10.DERIVATION,
    ),
    printed=PRINTED,
    domain=(sympy.Ge(j, 2), sympy.Ge(M, j + 2)),
    exact=lambda: exact_cases(RATIO - 1, STRESS.ratio(), "second order"),
    steps=steps,
    decide=STRESS.decide,
    search=STRESS.search,
    claims=(
        Claim(
            "to leading order the ratio changes by 4M(z − φ)(σ/r)²/(1−φ²)²: no constant, and not "
            "that of a surface load",
            _leading,
        ),
        Claim("over all layers, edges included, moments and flux agree", STRESS.virial),
        Claim("one layer below the surface both loads agree", _one_layer_below_the_surface),
    ),
    witnesses=STRESS.witnesses,
)

if __name__ == "__main__":
    from force_diffusion.derivations.commands.alone import run_alone

    raise SystemExit(run_alone(DERIVATION))
