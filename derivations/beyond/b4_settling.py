"""Eq. B4: the mean displacement of the beads, which is of second order: the pile settles."""

from collections.abc import Iterator
from fractions import Fraction
from functools import cache

import sympy
from force_diffusion.derivations import eq02_displacement as eq02
from force_diffusion.derivations import eq04_contact_plus as eq04
from force_diffusion.derivations.beyond.means import decide_in_field
from force_diffusion.derivations.framework.follows import identity
from force_diffusion.derivations.framework.record import Claim, Derivation, Step, Witness, usual
from force_diffusion.derivations.witnesses import second_order as witnesses
from force_diffusion.symbolic.algebra.affine import Region
from force_diffusion.symbolic.algebra.exact import FIELD, RationalFunction
from force_diffusion.symbolic.as_printed import equation, minus, power, terms, times
from force_diffusion.symbolic.kernel.decisions import (
    Ruling,
    all_of,
    decide_identity,
    decide_vector_identity,
    from_test,
    undecided,
)
from force_diffusion.symbolic.mechanics import second_order
from force_diffusion.symbolic.mechanics.contacts import radii
from force_diffusion.symbolic.mechanics.lattice import N_MINUS, N_PLUS
from force_diffusion.symbolic.mechanics.second_order import (
    SETTLED,
    STEP,
    TURN,
    d_plus,
    mean_square,
    tilt,
)
from force_diffusion.symbolic.notation import Symbol
from force_diffusion.symbolic.printing.text import text
from force_diffusion.symbolic.symbols import (
    DeltaNPlus,
    Dot,
    b_minus,
    b_plus,
    e_y,
    i,
    j,
    m,
    n_minus,
    n_y,
    phi,
    r,
    sigma,
)
from force_diffusion.symbolic.variances.certified_sums import certified_sum
from force_diffusion.symbolic.variances.variance import leading, variance

MEAN_HEIGHT = Symbol("mean_delta_y", r"\langle\delta y_{ij}\rangle", "⟨δy_ij⟩")

PRINTED = equation(
    MEAN_HEIGHT,
    minus(
        times(
            r / (2 * n_y * (1 - phi**2)),
            terms(times(2, j, terms(j, -1)), times(phi**2, j), 1, minus(phi)),
            power(times(sigma, 1 / r), 2),
        )
    ),
)

TILT = Dot(n_minus, DeltaNPlus(i, j))
"""ν = n⁻·δn⁺_ij, all that a change of direction holds."""


@cache
def tilt_variance() -> tuple[RationalFunction, RationalFunction]:
    """⟨ν²⟩ for j ≥ 1, and at j = 0, from Eq. 4 site by site."""
    in_radii = TILT.replace(DeltaNPlus, eq04.contact_direction)
    return (
        variance(in_radii, Region({j: 1})),
        variance(in_radii.xreplace({j: sympy.Integer(0)}), Region({})),
    )


@cache
def mean_line_sum() -> sympy.Expr:
    """⟨n^±·δx_ij⟩ at order σ² for j ≥ 1: the steps of all layers below, summed."""
    later, first = (SETTLED.xreplace({mean_square: value.to_sympy()}) for value in tilt_variance())
    return first + certified_sum(sympy.expand(later.xreplace({j: m})), m, sympy.Integer(1), j - 1)


def _vanishes(_: int, candidate: sympy.Eq) -> Ruling:
    return decide_identity(candidate.lhs - candidate.rhs, second_order.constraint())


def _step_down(_: int, candidate: sympy.Eq) -> Ruling:
    """What the constraint fixes: put in, it vanishes."""
    if candidate.lhs != d_plus:
        return undecided(f"the left-hand side is not {text(d_plus)}")
    left = second_order.constraint().xreplace({d_plus: candidate.rhs})
    return decide_identity(left, sympy.Integer(0))


def _tilts(part: int, candidate: sympy.Eq) -> Ruling:
    return identity({mean_square: tilt_variance()[part].to_sympy()})(part, candidate)


def steps() -> Iterator[Step]:
    """The constraint at order ε², the steps it makes in the mean, their sum."""
    yield Step(
        "Let the centres of a contact along n⁺ be 2r n⁺ + ε d₁ + ε² d₂ apart, ρ the sum of both "
        "δr. At order ε² the constraint of Eq. 2 demands",
        equation(second_order.constraint(), sympy.Integer(0)),
        _vanishes,
        ("Eq. 2",),
    )
    yield Step(
        "Here d₁ = ρ n⁺ + 2r δn⁺ by the first order, and δn⁺ = ν b⁻. So that, with |b⁻|² = "
        "1/(1−φ²), the line sum steps down by r |δn⁺|²:",
        equation(d_plus, STEP),
        _step_down,
        ("Eq. 4", "step 1"),
    )
    yield Step(
        "In the mean all contacts of a layer are alike. Their tilt has the variance, for j ≥ 1 and "
        "at the base,",
        sympy.Tuple(*(equation(mean_square, value.to_sympy()) for value in tilt_variance())),
        _tilts,
        ("Eq. 4",),
    )
    yield Step(
        "Both line sums of a bead are the sums of these steps from the base up, and a displacement "
        "with c⁺ = c⁻ = c is c (b⁺ + b⁻) = (c/n_y) e_y.",
        PRINTED,
        decide,
        ("step 2", "step 3"),
    )


def decide(_: int, candidate: sympy.Eq) -> Ruling:
    """Compare with the summed steps, for all j ≥ 1."""
    if candidate.lhs != MEAN_HEIGHT:
        return undecided("the left-hand side is not ⟨δy_ij⟩")
    return decide_in_field(candidate.rhs, mean_line_sum() / n_y)


def search(candidate: sympy.Eq) -> str | None:
    """Exact packings in which the mean displacement is another."""
    if candidate.lhs != MEAN_HEIGHT:
        return None

    def exact(height: int, layer: int) -> dict[sympy.Symbol, Fraction]:
        return {MEAN_HEIGHT: witnesses.means(height, witnesses.N, "surface")[1][layer][1]}

    return witnesses.fails(candidate, exact, [(4, layer) for layer in range(1, 5)])


def _unit_vector() -> Ruling:
    """The direction's second order; and that it stays a unit vector, 2 n·u₂ + |δn|² = 0."""
    unit = second_order.unit_vector()
    squared = tilt**2 / (1 - phi**2)
    return all_of(
        decide_identity(unit.dot(N_PLUS), TURN[0]),
        decide_identity(unit.dot(N_MINUS), TURN[1]),
        decide_identity(2 * TURN[0].xreplace({d_plus: STEP}) + squared, sympy.Integer(0)),
    )


def _upright() -> Ruling:
    return decide_vector_identity(radii * (b_plus + b_minus), radii / n_y * e_y)


def _surface() -> Ruling:
    mean = FIELD.from_sympy(mean_line_sum())
    stated = FIELD.from_sympy(-(j**2) * sigma**2 / (r * (1 - phi**2)))
    return from_test(
        (leading(mean, j) - stated).is_zero(),
        "⟨δy⟩ goes as −j² (σ/r)² r/(n_y (1−φ²)), a share of ½ j (σ/r)²/(n_y² (1−φ²)) of the height",
    )


DERIVATION = Derivation(
    number="B4",
    name="settling",
    title="Mean displacement of the beads",
    symbols=(
        (MEAN_HEIGHT, "mean vertical displacement of bead (i, j); the horizontal one is 0"),
        *usual(sigma, r, phi),
    ),
    assumptions=(
        "the radii are independent, of zero mean and variance σ², of whatever law",
        "second order in δr",
        "j ≥ 1; the beads of the base do not move",
    ),
    premises=(eq02.DERIVATION, eq04.DERIVATION),
    printed=(PRINTED,),
    domain=(sympy.Ge(j, 1),),
    steps=steps,
    decide=decide,
    search=search,
    claims=(
        Claim("the second order of the contact's direction, a unit vector", _unit_vector),
        Claim("equal line sums are a vertical displacement", _upright),
        Claim("the pile settles, by a share of its height that grows as its height", _surface),
    ),
    witnesses=(
        Witness(
            "exact packings, ε²: the mean of every bead, as fractions",
            lambda packing: witnesses.positions(PRINTED.rhs, packing),
        ),
    ),
    remarks=(
        "A contact that tilts, whichever way, carries its upper bead less far up: the pile "
        "settles, at any φ and with no gravity in the argument. It is the sum over j layers of a "
        "tilt that itself spreads as j, hence j².",
    ),
)

if __name__ == "__main__":
    from force_diffusion.derivations.commands.alone import run_alone

    raise SystemExit(run_alone(DERIVATION))
