"""Eq. 5: the change of the direction of the contact along n⁻, derived, and as a mirror image."""

from collections.abc import Iterator

import sympy
from force_diffusion.derivations import eq01_ordered_positions as eq01
from force_diffusion.derivations import eq03_extrapolation as eq03
from force_diffusion.derivations import eq04_contact_plus as eq04
from force_diffusion.derivations.framework.record import Claim, Derivation, Step, Witness
from force_diffusion.derivations.witnesses.both_sides import about, compare, each_contact, search
from force_diffusion.symbolic.algebra.affine import Region
from force_diffusion.symbolic.as_printed import equation, minus, terms, times
from force_diffusion.symbolic.kernel.decisions import Ruling, all_of, decide_identity, decide_linear
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
    n_x,
    n_y,
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


def steps() -> Iterator[Step]:
    """The same derivation for the other contact, and the mirror image of Eq. 4."""
    yield Step(
        "As for Eq. 4, from the exact unit vector of the contact along n⁻:",
        equation(times(2, r, DeltaNMinus(i, j)), from_displacements(DeltaX(*ABOVE), DeltaX(i, j))),
    )
    yield Step("Eq. 3 put in; now the b⁻ component is the two radii alone.", PRINTED)
    yield Step(
        "It is the mirror image of Eq. 4: i → −i at every bead, n⁺ ↔ n⁻ and b⁺ ↔ b⁻ in that "
        "equation give this one."
    )
    yield Step(
        "Again the change is at right angles to the contact.",
        equation(Dot(n_minus, DeltaNMinus(i, j)), 0),
    )


def decide(_: int, candidate: sympy.Eq) -> Ruling:
    """Compare 2r δn⁻ with the derivative of the unit vector, Eq. 3 put in."""
    if other := about(candidate, 2 * r * DeltaNMinus(i, j), "none", each_contact):
        return other
    return eq04.follows(candidate.rhs, from_displacements, ABOVE)


def _unit_vector() -> Ruling:
    change = contacts.unit_vector_change(eq01.ordered_separation(-1, 1))
    expected = (contacts.dx + contacts.radii * n_x, contacts.dy - contacts.radii * n_y)
    return all_of(*(decide_identity(2 * r * change[axis], expected[axis]) for axis in range(2)))


def _mirror_image() -> Ruling:
    return decide_linear(mirror(eq04.PRINTED.rhs), PRINTED.rhs, Region({j: 0}), is_vector=True)


def _orthogonal() -> Ruling:
    return decide_linear(Dot(n_minus, PRINTED.rhs), sympy.Integer(0), Region({j: 0}))


DERIVATION = Derivation(
    number=5,
    name="contact_minus",
    title="Change of the contact direction along n⁻",
    symbols=(
        (DeltaNMinus(i, j), "change of the direction from (i, j) to (i−1, j+1)"),
        (DeltaR(i, j), "deviation of the radius of bead (i, j)"),
    ),
    assumptions=("first order in δr", "fixed base; j ≥ 0"),
    premises=(eq01.DERIVATION, eq03.DERIVATION, eq04.DERIVATION),
    printed=(PRINTED,),
    steps=steps,
    decide=decide,
    search=search("none", each_contact),
    claims=(
        Claim("the derivative of the exact unit vector is (δx − δx′ − ρ n⁻)/2r", _unit_vector),
        Claim("Eq. 5 is the mirror image of Eq. 4", _mirror_image),
        Claim("n⁻·δn⁻ = 0: a unit vector to first order", _orthogonal),
    ),
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
