"""Eq. 5: the change of the direction of the contact along n⁻, derived, and as a mirror image."""

from collections.abc import Iterator
from functools import cache

import sympy
from force_diffusion.derivations import eq01_ordered_positions as eq01
from force_diffusion.derivations import eq03_extrapolation as eq03
from force_diffusion.derivations import eq04_contact_plus as eq04
from force_diffusion.derivations.framework.follows import linear
from force_diffusion.derivations.framework.record import Derivation, Step, Witness
from force_diffusion.derivations.witnesses.both_sides import about, compare, each_contact, search
from force_diffusion.symbolic.algebra.affine import Region
from force_diffusion.symbolic.algebra.bases import CARTESIAN
from force_diffusion.symbolic.as_printed import equation, minus, terms, times
from force_diffusion.symbolic.kernel.decisions import Ruling
from force_diffusion.symbolic.mechanics import contacts
from force_diffusion.symbolic.mechanics.lattice import mirror
from force_diffusion.symbolic.symbols import (
    DeltaNMinus,
    DeltaR,
    DeltaX,
    Dot,
    b_minus,
    b_plus,
    i,
    j,
    m,
    n_minus,
    r,
)

PRINTED = equation(
    times(2, r, DeltaNMinus(i, j)),
    terms(
        times(terms(DeltaR(i, j), DeltaR(i - 1, j + 1)), terms(b_plus, b_minus, minus(n_minus))),
        times(
            b_plus,
            terms(
                DeltaR(i - j - 2, 0),
                minus(DeltaR(i - j, 0)),
                times(
                    2,
                    sympy.Sum(
                        terms(DeltaR(i - (j - m) - 2, m), minus(DeltaR(i - (j - m), m))), (m, 1, j)
                    ),
                ),
            ),
        ),
    ),
)

ABOVE = (i - 1, j + 1)


def contact_direction(across: sympy.Expr, layer: sympy.Expr) -> sympy.Expr:
    """δn⁻ at a site, as a vector expression in the radii (Eq. 5), for layers 0 and above."""
    return (PRINTED.rhs / (2 * r)).xreplace({i: across, j: layer})


def from_displacements(above: sympy.Expr, below: sympy.Expr) -> sympy.Expr:
    """2r δn⁻_ij: difference of the displacements less n⁻ times the sum of the two δr."""
    return terms(above, minus(below), minus(times(n_minus, terms(DeltaR(i, j), DeltaR(*ABOVE)))))


@cache
def change(across: sympy.Expr = i, layer: sympy.Expr = j) -> sympy.Expr:
    """δn⁻ in the displacements and radii of its two beads: SymPy differentiates the unit vector."""
    derivative = contacts.unit_vector_change(eq01.ordered_separation(-1, 1))
    return contacts.of_beads(derivative, ABOVE, (i, j)).xreplace({i: across, j: layer})


def steps() -> Iterator[Step]:
    """The same derivation for the other contact, and the mirror image of Eq. 4."""
    yield Step(
        "As for Eq. 4, from the exact unit vector of the contact along n⁻:",
        equation(times(2, r, DeltaNMinus(i, j)), from_displacements(DeltaX(*ABOVE), DeltaX(i, j))),
        linear({DeltaNMinus: change}, is_vector=True, basis=CARTESIAN),
        ("Eq. 1",),
    )
    across = Dot(n_minus, terms(DeltaX(*ABOVE), minus(DeltaX(i, j))))
    yield Step(
        "With Eq. 3 for both beads, for j ≥ 1, now the b⁻ component is the two radii alone.",
        equation(across, terms(DeltaR(i, j), DeltaR(*ABOVE))),
        linear({DeltaX: eq04.displaced}, Region({j: 1})),
        ("Eq. 3",),
    )
    yield Step(
        "The b⁺ component compares two neighbouring diagonals along n⁺.",
        PRINTED,
        decide,
        ("Eq. 3", "step 1"),
    )
    yield Step(
        "It is the mirror image of Eq. 4: i → −i at every bead, n⁺ ↔ n⁻ and b⁺ ↔ b⁻ in that "
        "equation give this one.",
        equation(mirror(eq04.PRINTED.lhs), mirror(eq04.PRINTED.rhs)),
        linear({DeltaNMinus: contact_direction}, Region({j: 0}), is_vector=True),
        ("Eq. 4", "Eq. 5"),
    )
    yield Step(
        "Again the change is at right angles to the contact.",
        equation(Dot(n_minus, DeltaNMinus(i, j)), 0),
        linear({DeltaNMinus: contact_direction}, Region({j: 0})),
        ("Eq. 5",),
    )


def decide(_: int, candidate: sympy.Eq) -> Ruling:
    """Compare 2r δn⁻ with the derivative of the unit vector, Eq. 3 put in."""
    if other := about(candidate, 2 * r * DeltaNMinus(i, j), "none", each_contact):
        return other
    return eq04.follows(candidate, change())


DERIVATION = Derivation(
    number=5,
    name="contact_minus",
    title="Change of the contact direction along n⁻",
    symbols=(
        (DeltaNMinus(i, j), "change of the direction from (i, j) to (i−1, j+1)"),
        (DeltaR(i, j), "deviation of the radius of bead (i, j)"),
        (n_minus, "direction of the ordered contact, up and to the left"),
        (b_plus, "reciprocal vector: n⁺·b⁺ = 1, n⁻·b⁺ = 0"),
        (b_minus, "reciprocal vector: n⁻·b⁻ = 1, n⁺·b⁻ = 0"),
        (m, "layer of a bead on a diagonal down to the base"),
    ),
    assumptions=("first order in δr", "fixed base; j ≥ 0"),
    premises=(eq01.DERIVATION, eq03.DERIVATION, eq04.DERIVATION),
    printed=(PRINTED,),
    steps=steps,
    decide=decide,
    search=search("none", each_contact),
    witnesses=(
        Witness(
            "an exact packing obeys it, both sides at orders ε⁰ and ε¹",
            lambda packing: compare(PRINTED, packing, "none", each_contact),
        ),
    ),
)

if __name__ == "__main__":
    from force_diffusion.derivations.commands.alone import run_alone

    raise SystemExit(run_alone(DERIVATION))
