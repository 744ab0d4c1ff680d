"""Eq. B8: the vertical force averaged over N neighbouring beads is hyperuniform."""

from collections.abc import Iterator
from functools import cache

import sympy
from force_diffusion.derivations import eq11_total_force as eq11
from force_diffusion.derivations import eq13_surface_diffusion as eq13
from force_diffusion.derivations.beyond import b7_neighbouring_contacts as b7
from force_diffusion.derivations.beyond.neighbours import (
    COVARIANCES,
    FAR,
    Split,
    decided,
    far_is_zero,
    hold_everywhere,
    near,
    none_far,
    searched,
    told,
    witnessed,
)
from force_diffusion.derivations.framework.follows import identity, states
from force_diffusion.derivations.framework.record import Claim, Derivation, Step, usual
from force_diffusion.symbolic.algebra.affine import Region
from force_diffusion.symbolic.algebra.exact import FIELD, RationalFunction
from force_diffusion.symbolic.as_printed import equation, minus, power, terms, times
from force_diffusion.symbolic.kernel.decisions import Ruling, from_test
from force_diffusion.symbolic.mechanics.lattice import mirror
from force_diffusion.symbolic.notation import Symbol
from force_diffusion.symbolic.symbols import (
    DeltaNMinus,
    DeltaNPlus,
    Dot,
    M,
    N,
    f_load,
    i,
    j,
    k,
    l,
    n_minus,
    n_plus,
    p,
    phi,
    r,
    sigma,
    z,
)
from force_diffusion.symbolic.variances.variance import leading

MEAN_OF_N = Symbol(
    "mean_of_N_beads",
    r"\frac{\sigma^2(\overline{p}_{N})}{(f^{\mathrm{load}})^{2}}",
    "σ²(mean of N p)/f_load²",
)

PRINTED = equation(
    MEAN_OF_N,
    times(
        1 / (12 * N**2 * (1 - phi**2) ** 2),
        terms(
            times(8, terms(M, -j) ** 2, terms(M, times(2, j))),
            minus(times(6, terms(M, -j) ** 2)),
            times(terms(M, -j), terms(times(6, phi**2), times(24, phi), -2)),
            times(3, terms(1, -phi) ** 2),
        ),
        power(times(sigma, 1 / r), 2),
    ),
)

VERTICAL = (
    (eq11.PRINTED.rhs + mirror(eq11.PRINTED.rhs)) / 2
    - 1
    + (Dot(n_minus, DeltaNPlus(i, j)) + Dot(n_plus, DeltaNMinus(i, j))) / (2 * (1 + phi))
)
"""p/f_load − 1: n_y(f⁺ + f⁻) and the tilts of both contacts, to first order."""

DEEP = Region({j: 5, M: j + 5})
PLACES = ((10, 5, 3), (11, 6, 3), (12, 6, 4))
"""Packings (M, j, N) of the interior for witnesses and searches."""


@cache
def _form() -> sympy.Expr:
    return eq11.in_radii(VERTICAL)


@cache
def covariances() -> tuple[RationalFunction, ...]:
    """C_0, C_1, C_2 of neighbouring p/f_load in the interior."""
    return near(_form(), DEEP)


decide = decided(covariances, MEAN_OF_N)


BEAD = Symbol("p_bead", "p", "p")
"""The vertical force that a bead gets from both upper contacts."""


def steps() -> Iterator[Step]:
    """The same for what a bead gets from both upper contacts."""
    known = told(MEAN_OF_N, covariances())
    change = terms(BEAD / f_load, -1)
    yield Step(
        "The vertical force that bead (i, j) gets from both upper contacts, over f_load and less "
        "1, by Eq. 11, its mirror image, and the tilts of both:",
        equation(change, VERTICAL),
        states(equation(change, VERTICAL), region=eq11.INTERIOR),
        ("Eq. 11",),
    )
    yield Step(
        "Covariances of beads k = 0, 1, 2 places apart:",
        sympy.Tuple(*(equation(name, known[name]) for name in COVARIANCES)),
        identity(known),
        ("step 1",),
    )
    yield Step(
        "For 3 ≤ k ≤ j − 3, k ≤ M − j − 2 it is zero:",
        equation(FAR, 0),
        none_far(_uncorrelated),
        ("step 1",),
    )
    own, first, second = COVARIANCES
    yield Step(
        "This sum is zero exactly: the vertical force through a layer is the load, so that a "
        "window's sum changes through its ends alone.",
        equation(own + 2 * first + 2 * second, 0),
        identity(known),
        ("step 2",),
    )
    yield Step(
        "So what is left of the variance of the mean is",
        equation(MEAN_OF_N, -2 * (first + 2 * second) / N**2),
        identity(known),
        ("Eq. B7", "step 3", "step 4"),
    )
    yield Step("With these covariances:", PRINTED, decide, ("step 2", "step 5"))


SPLITS: tuple[Split, ...] = (({j: k + p, M: 2 * k + p + l}, {k: 3, p: 3, l: 2}),)
"""All places with 3 ≤ k ≤ j − 3 and k ≤ M − j − 2."""


@cache
def _uncorrelated() -> Ruling:
    return far_is_zero(_form(), SPLITS)


def _everywhere() -> Ruling:
    return hold_everywhere(_form(), covariances(), 5, 5)


def _leading() -> Ruling:
    own = covariances()[0]
    printed = FIELD.from_sympy(eq13.PRINTED.rhs.xreplace({z: j / M}) / 2)
    return from_test(
        (leading(own) - leading(printed)).is_zero(),
        "for N = 1 it is half of Eq. 13: the two contacts of a bead are uncorrelated to leading "
        "order",
    )


DERIVATION = Derivation(
    number="B8",
    name="neighbouring_beads",
    title="Mean vertical force over N neighbouring beads",
    symbols=(
        (MEAN_OF_N, "variance of the mean of p over N neighbours of one layer"),
        (N, "number of neighbouring beads"),
        *usual(sigma, r, M, phi),
    ),
    assumptions=(
        "the radii are independent, of zero mean and variance σ²",
        "first order in δr",
        "a surface load; p is the vertical force that a bead gets from both upper contacts",
        "3 ≤ N ≤ j − 2 and N ≤ M − j − 2",
    ),
    premises=(eq11.DERIVATION, eq13.DERIVATION, b7.DERIVATION),
    printed=(PRINTED,),
    domain=(sympy.Ge(N, 3), sympy.Ge(j, N + 2), sympy.Ge(M, j + N + 2)),
    steps=steps,
    decide=decide,
    search=searched("bead", MEAN_OF_N, PLACES),
    claims=(
        Claim("these covariances hold in every layer j ≥ 5 of M ≥ j + 5", _everywhere),
        Claim("for a single bead it is half of Eq. 13, to leading order", _leading),
    ),
    witnesses=(witnessed("bead", PRINTED, PLACES),),
)

if __name__ == "__main__":
    from force_diffusion.derivations.commands.alone import run_alone

    raise SystemExit(run_alone(DERIVATION))
