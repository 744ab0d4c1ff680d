"""Eq. 4: the change of the direction of the contact along n⁺."""

from functools import cache

import sympy
from force_diffusion.derivations import eq01_ordered_positions as eq01
from force_diffusion.derivations import eq03_extrapolation as eq03
from force_diffusion.derivations.framework.vocabulary import (
    By,
    Derivation,
    Lines,
    Where,
    axioms,
    cases,
    equation,
    minus,
    order,
    rewrite,
    terms,
    times,
)
from force_diffusion.symbolic.symbols import (
    DeltaNPlus,
    DeltaR,
    DeltaX,
    Dot,
    b_minus,
    b_plus,
    i,
    j,
    m,
    n_plus,
    r,
)

WHERE = Where.of(j >= 0)

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


def contact_direction(across: sympy.Expr, layer: sympy.Expr) -> sympy.Expr:
    """δn⁺ at a site, as a vector expression in the radii (Eq. 4), for layers 0 and above."""
    return (PRINTED.rhs / (2 * r)).xreplace({i: across, j: layer})


def from_displacements(above: sympy.Expr, below: sympy.Expr) -> sympy.Expr:
    """2r δn⁺_ij: difference of the displacements less n⁺ times the sum of the two δr."""
    return terms(above, minus(below), minus(times(n_plus, terms(DeltaR(i, j), DeltaR(*ABOVE)))))


def from_eq_3(changed: object) -> By:
    """A change of direction, with Eq. 3 for both beads, or the fixed base for the lower one."""
    put_in = rewrite(changed, (eq03.DERIVATION, axioms.base()))
    return cases(put_in, (sympy.Eq(j, 0),), (j >= 1,))


@cache
def steps() -> Lines:
    """Differentiate the exact unit vector, then put in Eq. 3."""
    lines = Lines(WHERE)
    changed = lines.show(
        "The centres of touching beads are exactly R + R′ apart, so the unit vector of the "
        "contact is their separation over R + R′ = 2r + ερ; its derivative at ε = 0 is "
        "(Δx − ρ n⁺)/2r.",
        equation(times(2, r, DeltaNPlus(i, j)), from_displacements(DeltaX(*ABOVE), DeltaX(i, j))),
        order(axioms.direction(1), 1),
        after=(eq01.DERIVATION,),
    )
    lines.show(
        "With Eq. 3 for both beads, for j ≥ 1, the b⁺ component of the difference is the sum of "
        "the two radii alone, since both beads lie on one diagonal along n⁺.",
        equation(
            Dot(n_plus, terms(DeltaX(*ABOVE), minus(DeltaX(i, j)))),
            terms(DeltaR(i, j), DeltaR(*ABOVE)),
        ),
        rewrite(eq03.DERIVATION),
        where=WHERE.also(j >= 1),
    )
    printed = lines.show(
        "The b⁻ component compares two neighbouring diagonals along n⁻.",
        PRINTED,
        from_eq_3(changed),
    )
    lines.show(
        "The contact's length has been used: the change is at right angles to n⁺.",
        equation(Dot(n_plus, DeltaNPlus(i, j)), 0),
        rewrite(printed),
    )
    return lines


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
    assumptions=("first order in δr", "fixed base", *WHERE.in_words()),
    premises=(eq01.DERIVATION, eq03.DERIVATION),
    printed=(PRINTED,),
    steps=steps,
    where=WHERE,
)

if __name__ == "__main__":
    from force_diffusion.derivations.commands.alone import run_alone

    raise SystemExit(run_alone(DERIVATION))
