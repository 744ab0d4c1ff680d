"""Eq. 4: the change of the direction of the contact along n⁺."""

# fmt: off
from functools import cache

import sympy
from force_diffusion.derivations import eq03_extrapolation as eq03
from force_diffusion.derivations.framework.vocabulary import (
    Derivation, Domain, Steps, axioms, equation, minus, order, rewrite, terms, times)
from force_diffusion.symbolic.symbols import (
    DeltaNPlus, DeltaR, DeltaX, Dot, b_minus, b_plus, i, j, m, n_plus, r)
# fmt: on

BEADS = Domain.of(j >= 0)

PRINTED = equation(
    times(2, r, DeltaNPlus(i, j)),
    terms(
        times(terms(DeltaR(i, j), DeltaR(i + 1, j + 1)), terms(b_plus, b_minus, minus(n_plus))),
        times(
            b_minus,
            terms(
                DeltaR(i + j + 2, 0),
                minus(DeltaR(i + j, 0)),
                times(
                    2,
                    sympy.Sum(
                        terms(DeltaR(i + (j - m) + 2, m), minus(DeltaR(i + (j - m), m))), (m, 1, j)
                    ),
                ),
            ),
        ),
    ),
)

ABOVE = (i + 1, j + 1)


def from_displacements(above: sympy.Expr, below: sympy.Expr) -> sympy.Expr:
    """2r δn⁺_ij: difference of the displacements less n⁺ times the sum of the two δr."""
    return terms(above, minus(below), minus(times(n_plus, terms(DeltaR(i, j), DeltaR(*ABOVE)))))


@cache
def steps() -> Steps:
    """Differentiate the exact unit vector, then put in Eq. 3."""
    steps = Steps(4, BEADS)
    changed = steps.show(
        "The centres of touching beads are exactly R + R′ apart, so the unit vector of the "
        "contact is their separation over R + R′ = 2r + ερ; its derivative at ε = 0 is "
        "(Δx − ρ n⁺)/2r.",
        equation(times(2, r, DeltaNPlus(i, j)), from_displacements(DeltaX(*ABOVE), DeltaX(i, j))),
        order(axioms.direction(1), 1),
    )
    displaced = (eq03.DERIVATION.theorem, axioms.base())
    steps.show(
        "With Eq. 3 for both beads, the b⁺ component of the difference is the sum of the two radii "
        "alone, since both beads lie on one diagonal along n⁺.",
        equation(
            Dot(n_plus, terms(DeltaX(*ABOVE), minus(DeltaX(i, j)))),
            terms(DeltaR(i, j), DeltaR(*ABOVE)),
        ),
        rewrite(displaced),
    )
    printed = steps.show(
        "The b⁻ component compares two neighbouring diagonals along n⁻.",
        PRINTED,
        rewrite(changed.theorem, displaced),
    )
    steps.show(
        "The contact's length has been used: the change is at right angles to n⁺.",
        RIGHT_ANGLE,
        rewrite(printed.theorem),
    )
    return steps


RIGHT_ANGLE = equation(Dot(n_plus, DeltaNPlus(i, j)), 0)


DERIVATION = Derivation(
    number=4,
    name="contact_plus",
    title="Change of the contact direction along n⁺",
    symbols=(
        (DeltaNPlus(i, j), "change of the direction from (i, j) to (i+1, j+1)"),
        (DeltaR(i, j), "deviation of the radius of bead (i, j)"),
        (n_plus, "direction of the ordered contact, up and to the right"),
        (b_plus, "reciprocal vector: n⁺·b⁺ = 1, n⁻·b⁺ = 0"),
        (b_minus, "reciprocal vector: n⁻·b⁻ = 1, n⁺·b⁻ = 0"),
        (m, "layer of a bead on a diagonal down to the base"),
    ),
    assumptions=("first order in δr", "fixed base", *BEADS.in_words()),
    printed=(PRINTED,),
    domain=BEADS,
    steps=steps,
)

if __name__ == "__main__":
    from force_diffusion.derivations.commands.alone import run_alone

    raise SystemExit(run_alone(DERIVATION))
