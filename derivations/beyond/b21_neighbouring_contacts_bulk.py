"""Eq. B21: the mean over N neighbouring contacts of one branch under a bulk load."""

from collections.abc import Iterator
from functools import cache

import sympy
from force_diffusion.derivations import eq11_total_force as eq11
from force_diffusion.derivations import eq14_bulk_diffusion as eq14
from force_diffusion.derivations.beyond import b7_neighbouring_contacts as b7
from force_diffusion.derivations.beyond.b7_neighbouring_contacts import DEEP, MEAN_OF_N, PLACES
from force_diffusion.derivations.beyond.neighbours import (
    COVARIANCES,
    FAR,
    OF_MEAN,
    add_up_to_zero,
    correlated,
    decided,
    far_is_zero,
    hold_everywhere,
    near,
    none_far,
    searched,
    spread,
    told,
    witnessed,
)
from force_diffusion.derivations.framework.follows import identity
from force_diffusion.derivations.framework.record import Claim, Derivation, Step
from force_diffusion.symbolic.algebra.exact import RationalFunction
from force_diffusion.symbolic.as_printed import equation, minus, power, terms, times
from force_diffusion.symbolic.kernel.decisions import Ruling, all_of, from_test
from force_diffusion.symbolic.symbols import M, N, j, phi, r, sigma, z

_RADII = power(times(sigma, 1 / r), 2)

PRINTED = equation(
    MEAN_OF_N,
    terms(
        times((1 - phi) ** 2 / (2 * N * (1 + phi) ** 2), _RADII),
        times(
            1 / (60 * N**2 * (1 - phi**2) ** 2),
            terms(
                times(12, terms(M, -j) ** 2, terms(M, times(4, j))),
                times(15, terms(M, -j) ** 2),
                times(terms(M, -j), terms(20, minus(times(60, phi)), times(140, phi**2))),
                times(60, j, terms(1, times(2, phi**2))),
                times(120, phi**3),
                minus(times(210, phi**2)),
                times(240, phi),
                -105,
                (28 - 90 * phi + 100 * phi**2 - 30 * phi**3) / (M - j),
            ),
            _RADII,
        ),
    ),
)


@cache
def _form() -> sympy.Expr:
    return eq11.in_radii(eq14.bulk_force() - 1)


@cache
def covariances() -> tuple[RationalFunction, ...]:
    """C_0, C_1, C_2 of neighbouring f⁺/⟨f⟩ in the interior."""
    return near(_form(), DEEP)


decide = decided(covariances, MEAN_OF_N)


def steps() -> Iterator[Step]:
    """As for Eq. B7, with the force of Eq. 14."""
    known = told(MEAN_OF_N, covariances())
    yield Step(
        "Over its mean a force is the average of Eq. 11 over the loads of all layers above, as in "
        "Eq. 14. Covariances of contacts k = 0, 1, 2 places apart, over ⟨f⟩²:",
        sympy.Tuple(*(equation(name, known[name]) for name in COVARIANCES)),
        identity(known),
        ("Eq. 11", "Eq. 14"),
    )
    yield Step(
        "For 3 ≤ k ≤ j − 2 it is zero, as in Eq. B7:",
        equation(FAR, 0),
        none_far(_uncorrelated),
        ("Eq. 11", "Eq. 14"),
    )
    yield Step(
        "So the variance of the mean of N is",
        equation(MEAN_OF_N, OF_MEAN),
        identity(known),
        ("step 1", "step 2"),
    )
    yield Step("All of it:", PRINTED, decide, ("step 1", "step 3"))


@cache
def _uncorrelated() -> Ruling:
    return far_is_zero(_form(), b7.SPLITS)


def _everywhere() -> Ruling:
    return hold_everywhere(_form(), covariances(), 4, 3)


def _leading() -> Ruling:
    return correlated(covariances(), eq14.PRINTED.rhs.doit().xreplace({z: j / M}), 14)


def _spread() -> Ruling:
    return all_of(
        from_test(
            (spread(covariances()) - spread(b7.covariances())).is_zero(),
            "C₀ + 2C₁ + 2C₂ is that of Eq. B7",
        ),
        add_up_to_zero(_form()),
    )


DERIVATION = Derivation(
    number="B21",
    name="neighbouring_contacts_bulk",
    title="Mean over N neighbouring contacts of one branch under a bulk load",
    symbols=b7.DERIVATION.symbols,
    assumptions=(
        "the radii are independent, of zero mean and variance σ²",
        "first order in δr",
        "every bead above the base carries the same load, whatever its radius",
        "3 ≤ N ≤ j − 1 and M ≥ j + 3",
    ),
    premises=(eq11.DERIVATION, eq14.DERIVATION, b7.DERIVATION),
    printed=(PRINTED,),
    domain=(sympy.Ge(N, 3), sympy.Ge(j, N + 1), sympy.Ge(M, j + 3)),
    steps=steps,
    decide=decide,
    search=searched("bulk", MEAN_OF_N, PLACES),
    claims=(
        Claim("these covariances hold in every layer j ≥ 4 of M ≥ j + 3", _everywhere),
        Claim(
            "to leading order a contact's correlation with its first neighbour is −2/3, with its "
            "second 1/6: of Eq. 14 the mean keeps 2/(3N²)",
            _leading,
        ),
        Claim(
            "the part that falls as 1/N is that of a surface load, and stays from N = j on, as "
            "in Eq. B7",
            _spread,
        ),
    ),
    witnesses=(witnessed("bulk", PRINTED, PLACES),),
)

if __name__ == "__main__":
    from force_diffusion.derivations.commands.alone import run_alone

    raise SystemExit(run_alone(DERIVATION))
