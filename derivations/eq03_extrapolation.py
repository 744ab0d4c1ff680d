"""Eq. 3: the displacement in terms of the radii alone, by induction from the base."""

# fmt: off
from functools import cache

import sympy
from force_diffusion.derivations import eq02_displacement as eq02
from force_diffusion.derivations.framework.vocabulary import (
    Derivation, Domain, Steps, Theorem, along, axioms, equation, follows, inducted, rewrite, shown,
    terms, times, usual)
from force_diffusion.symbolic.symbols import (
    DeltaR, DeltaX, Dot, b_minus, b_plus, i, j, m, n_minus, n_plus)
# fmt: on

ABOVE = Domain.of(j >= 1)

LEFT_DIAGONAL = sympy.Sum(DeltaR(i - (j - m), m), (m, 1, j - 1))
RIGHT_DIAGONAL = sympy.Sum(DeltaR(i + (j - m), m), (m, 1, j - 1))
"""The radii between the bead and the base, along n⁺ to the left and along n⁻ to the right."""

PRINTED = equation(
    DeltaX(i, j),
    terms(
        times(terms(DeltaR(i - j, 0), DeltaR(i, j), times(2, LEFT_DIAGONAL)), b_plus),
        times(terms(DeltaR(i + j, 0), DeltaR(i, j), times(2, RIGHT_DIAGONAL)), b_minus),
    ),
)

FIRST_LAYER = terms(times(eq02.LEFT_RADII, b_plus), times(eq02.RIGHT_RADII, b_minus))


@cache
def from_the_base_up(formula: sympy.Eq, domain: Domain) -> Theorem:
    """Prove a displacement by induction: a bead rests on two of the layer below (Eq. 2)."""
    resting, base = eq02.DERIVATION.theorem, axioms.base()
    first, next_layer = rewrite(resting, base), lambda supposed: rewrite(resting, supposed)
    return inducted(j, 1, first, next_layer, [(formula, domain)])[0]


def positions() -> tuple[Theorem, ...]:
    """The displacement of every bead in the radii."""
    return *shown(3, from_the_base_up(PRINTED, ABOVE)), axioms.base()


def show_steps(steps: Steps) -> None:
    """Base case on the fixed base, then one step of Eq. 2 with symbolic i and j."""
    resting, base = eq02.DERIVATION.theorem, axioms.base()
    steps.show(
        "The base is fixed, δx_(i,0) = 0, and a bead of layer 1 rests on two of its beads. So Eq. "
        "2 gives the printed equation at j = 1, where both sums are empty:",
        equation(DeltaX(i, j), FIRST_LAYER),
        rewrite(resting, base),
        Domain.of(sympy.Eq(j, 1)),
    )
    steps.show(
        "By Eq. 2, the component along n⁺ is that of the left support, which lies on the same "
        "diagonal, plus two δr; and likewise to the right:",
        sympy.Tuple(
            equation(
                Dot(n_plus, DeltaX(i, j)), terms(Dot(n_plus, eq02.LEFT), *eq02.LEFT_RADII.args)
            ),
            equation(
                Dot(n_minus, DeltaX(i, j)), terms(Dot(n_minus, eq02.RIGHT), *eq02.RIGHT_RADII.args)
            ),
        ),
        [follows(along(resting, n_plus)), follows(along(resting, n_minus))],
    )
    steps.show(
        "Suppose that the printed equation holds in layer j − 1 ≥ 1. The radius of the support is "
        "counted once there and once by the new contact, so it joins the sum with the weight 2. "
        "This is the printed equation in layer j.",
        PRINTED,
        from_the_base_up,
    )
    empty = dict.fromkeys(PRINTED.rhs.atoms(sympy.Sum), sympy.S.Zero)
    steps.claim(
        "at j = 0 the printed sums, read as empty, would leave 2δr_(i,0)(b⁺ + b⁻), not 0",
        equation(PRINTED.rhs.xreplace(empty), 2 * DeltaR(i, 0) * (b_plus + b_minus)),
        rewrite(),
        Domain.of(sympy.Eq(j, 0)),
    )


DERIVATION = Derivation(
    number=3,
    name="extrapolation",
    title="Displacements in terms of the radii",
    symbols=usual(DeltaX(i, j), DeltaR(i, j), m, b_plus, b_minus),
    assumptions=(
        "first order in δr",
        "the centres of the base beads are fixed: δx_(i,0) = 0",
        "no diagonal meets a side wall",
        *ABOVE.in_words(),
    ),
    printed=(PRINTED,),
    domain=ABOVE,
    show_steps=show_steps,
    remarks=(
        "Erratum: the printed formula is for j ≥ 1. At j = 0 its empty sums leave "
        "2δr_(i,0)(b⁺ + b⁻), while the base is fixed: δx_(i,0) = 0 is a separate condition.",
    ),
)

if __name__ == "__main__":
    from force_diffusion.derivations.commands.cli import run_alone

    raise SystemExit(run_alone(3))
