"""Eq. B7: the mean over N neighbouring contacts of one branch fluctuates as 1/N, not 1/√N."""

from collections.abc import Iterator
from functools import cache

import sympy
from force_diffusion.derivations import eq11_total_force as eq11
from force_diffusion.derivations import eq13_surface_diffusion as eq13
from force_diffusion.derivations.beyond.neighbours import (
    COVARIANCES,
    FAR,
    OF_MEAN,
    Split,
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
from force_diffusion.derivations.framework.record import Claim, Derivation, Step, usual
from force_diffusion.symbolic.algebra.affine import Region
from force_diffusion.symbolic.algebra.exact import FIELD, RationalFunction
from force_diffusion.symbolic.as_printed import equation, minus, power, terms, times
from force_diffusion.symbolic.kernel.decisions import Ruling, all_of, from_test
from force_diffusion.symbolic.notation import Symbol
from force_diffusion.symbolic.symbols import M, N, j, k, p, phi, q, r, sigma, z
from force_diffusion.symbolic.variances.orders import UNIT

MEAN_OF_N = Symbol(
    "mean_of_N_variance",
    r"\frac{\sigma^2(\overline{f^{\pm}}_{N})}{\langle f\rangle^2}",
    "σ²(mean of N f^±)/⟨f⟩²",
)

_RADII = power(times(sigma, 1 / r), 2)

PRINTED = equation(
    MEAN_OF_N,
    terms(
        times((1 - phi) ** 2 / (2 * N * (1 + phi) ** 2), _RADII),
        times(
            1 / (3 * N**2 * (1 - phi**2) ** 2),
            terms(
                times(4, terms(M, -j) ** 2, terms(M, times(2, j))),
                minus(times(3, M**2)),
                minus(times(6, M, j)),
                times(9, j**2),
                times(3, phi**2, terms(times(5, M), minus(times(3, j)))),
                minus(times(6, phi, terms(M, -j))),
                times(2, terms(M, times(2, j))),
                times(6, phi**3),
                minus(times(18, phi**2)),
                times(15, phi),
                -6,
            ),
            _RADII,
        ),
    ),
)

FORCE = eq11.PRINTED.rhs - 1
DEEP = Region({j: 4, M: j + 3})
PLACES = ((7, 4, 3), (8, 5, 3), (8, 5, 4), (9, 6, 5))
"""Packings (M, j, N) of the interior for witnesses and searches."""


@cache
def covariances() -> tuple[RationalFunction, ...]:
    """C_0, C_1, C_2 of neighbouring f⁺/⟨f⟩ in the interior."""
    return near(eq11.in_radii(FORCE), DEEP)


decide = decided(covariances, MEAN_OF_N)


def steps() -> Iterator[Step]:
    """Covariances of two; none beyond the second neighbour; their sum."""
    known = told(MEAN_OF_N, covariances())
    yield Step(
        "Eq. 11 in the radii is a sum of second differences on one diagonal, and of what hangs on "
        "single sites. Two neighbouring contacts, k places apart, share radii on two of three "
        "lines (k = 1) or one (k = 2). Their covariances over ⟨f⟩², for k = 0, 1, 2:",
        sympy.Tuple(*(equation(name, known[name]) for name in COVARIANCES)),
        identity(known),
        ("Eq. 11",),
    )
    yield Step(
        "From k = 3 on it is zero, exactly, for k ≤ j − 2: first differences of one contact's tilt "
        "cross the second differences of the other, and the products add up to nothing.",
        equation(FAR, 0),
        none_far(_uncorrelated),
        ("Eq. 11",),
    )
    yield Step(
        "So the variance of the mean of N is",
        equation(MEAN_OF_N, OF_MEAN),
        identity(known),
        ("step 1", "step 2"),
    )
    own, first, second = COVARIANCES
    yield Step(
        "What grows with M cancels in",
        equation(own + 2 * first + 2 * second, spread(covariances()).to_sympy()),
        identity(known),
        ("step 1",),
    )
    yield Step("All of it:", PRINTED, decide, ("step 1", "step 3"))


SPLITS: tuple[Split, ...] = (({j: k + p, M: k + p + q}, {k: 3, p: 2, q: 1}),)
"""All places with 3 ≤ k ≤ j − 2 and j < M."""


@cache
def _uncorrelated() -> Ruling:
    return far_is_zero(eq11.in_radii(FORCE), SPLITS)


def _everywhere() -> Ruling:
    return hold_everywhere(eq11.in_radii(FORCE), covariances(), 4, 3)


def _leading() -> Ruling:
    return correlated(covariances(), eq13.PRINTED.rhs.xreplace({z: j / M}), 13)


def _momentum() -> Ruling:
    """What N contacts add is what the momentum balance of a layer leaves to one branch.

    From N = j on, beyond what is printed, covariances join in whose sum is zero.
    """
    stated = FIELD.from_sympy((1 - phi) ** 4 / 2 * UNIT)
    return all_of(
        from_test(
            (spread(covariances()) - stated).is_zero(),
            "C₀ + 2C₁ + 2C₂ = (1−φ)²/[2(1+φ)²] (σ/r)², which knows neither j nor M",
        ),
        add_up_to_zero(eq11.in_radii(FORCE)),
    )


DERIVATION = Derivation(
    number="B7",
    name="neighbouring_contacts",
    title="Mean over N neighbouring contacts of one branch",
    symbols=(
        (MEAN_OF_N, "variance of the mean of f^± over N neighbours of one layer"),
        (N, "number of neighbouring contacts"),
        *usual(sigma, r, M, phi),
    ),
    assumptions=(
        "the radii are independent, of zero mean and variance σ²",
        "first order in δr",
        "a surface load",
        "3 ≤ N ≤ j − 1 and M ≥ j + 3",
    ),
    premises=(eq11.DERIVATION, eq13.DERIVATION),
    printed=(PRINTED,),
    domain=(sympy.Ge(N, 3), sympy.Ge(j, N + 1), sympy.Ge(M, j + 3)),
    steps=steps,
    decide=decide,
    search=searched("force", MEAN_OF_N, PLACES),
    claims=(
        Claim("these covariances hold in every layer j ≥ 4 of M ≥ j + 3", _everywhere),
        Claim(
            "to leading order a contact's correlation with its first neighbour is −2/3, with its "
            "second 1/6: of Eq. 13 the mean keeps 2/(3N²)",
            _leading,
        ),
        Claim(
            "the part that falls as 1/N has no M in it, and stays from N = j on, where covariances "
            "for k = j − 1, …, j + 2 join in and add up to zero: it takes over from N of order M³ "
            "on",
            _momentum,
        ),
    ),
    witnesses=(witnessed("force", PRINTED, PLACES),),
    remarks=(
        "N independent contacts would have σ_f²/N. Force fluctuations are hyperuniform along a "
        "layer up to N of order M³, where the radii of the two layers that touch take over.",
    ),
)

if __name__ == "__main__":
    from force_diffusion.derivations.commands.alone import run_alone

    raise SystemExit(run_alone(DERIVATION))
