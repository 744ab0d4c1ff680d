"""Eq. 4: the change of the direction of the contact along n⁺."""

from collections.abc import Iterator
from functools import cache, partial

import sympy
from force_diffusion.derivations import eq01_ordered_positions as eq01
from force_diffusion.derivations import eq03_extrapolation as eq03
from force_diffusion.derivations.framework.follows import linear
from force_diffusion.derivations.framework.record import Derivation, Step, Witness
from force_diffusion.derivations.witnesses.both_sides import about, compare, each_contact, search
from force_diffusion.symbolic.algebra.affine import Region
from force_diffusion.symbolic.algebra.bases import CARTESIAN
from force_diffusion.symbolic.as_printed import equation, minus, terms, times
from force_diffusion.symbolic.kernel.decisions import Ruling, all_of, decide_linear
from force_diffusion.symbolic.mechanics import contacts
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

ZERO = sympy.Integer(0)
ABOVE = (i + 1, j + 1)


def contact_direction(across: sympy.Expr, layer: sympy.Expr) -> sympy.Expr:
    """δn⁺ at a site, as a vector expression in the radii (Eq. 4), for layers 0 and above."""
    return (PRINTED.rhs / (2 * r)).xreplace({i: across, j: layer})


def from_displacements(above: sympy.Expr, below: sympy.Expr) -> sympy.Expr:
    """2r δn⁺_ij: difference of the displacements less n⁺ times the sum of the two δr."""
    return terms(above, minus(below), minus(times(n_plus, terms(DeltaR(i, j), DeltaR(*ABOVE)))))


@cache
def change(across: sympy.Expr = i, layer: sympy.Expr = j) -> sympy.Expr:
    """δn⁺ in the displacements and radii of its two beads: SymPy differentiates the unit vector."""
    derivative = contacts.unit_vector_change(eq01.ordered_separation(1, 1))
    return contacts.of_beads(derivative, ABOVE, (i, j)).xreplace({i: across, j: layer})


def displaced(across: sympy.Expr, layer: sympy.Expr) -> sympy.Expr:
    """δx by Eq. 3, and on the fixed base."""
    return ZERO if layer == 0 else eq03.displacement(across, layer)


def steps() -> Iterator[Step]:
    """Differentiate the exact unit vector, then put in Eq. 3."""
    yield Step(
        "The centres of touching beads are exactly R + R′ apart, so the unit vector of the "
        "contact is their separation over R + R′ = 2r + ερ; its derivative at ε = 0 is "
        "(Δx − ρ n⁺)/2r.",
        equation(times(2, r, DeltaNPlus(i, j)), from_displacements(DeltaX(*ABOVE), DeltaX(i, j))),
        linear({DeltaNPlus: change}, is_vector=True, basis=CARTESIAN),
        ("Eq. 1",),
    )
    across = Dot(n_plus, terms(DeltaX(*ABOVE), minus(DeltaX(i, j))))
    yield Step(
        "With Eq. 3 for both beads, for j ≥ 1, the b⁺ component of the difference is the sum of "
        "the two radii alone, since both beads lie on one diagonal along n⁺.",
        equation(across, terms(DeltaR(i, j), DeltaR(*ABOVE))),
        linear({DeltaX: displaced}, Region({j: 1})),
        ("Eq. 3",),
    )
    yield Step(
        "The b⁻ component compares two neighbouring diagonals along n⁻.",
        PRINTED,
        decide,
        ("Eq. 3", "step 1"),
    )
    yield Step(
        "The contact's length has been used: the change is at right angles to n⁺.",
        equation(Dot(n_plus, DeltaNPlus(i, j)), 0),
        linear({DeltaNPlus: contact_direction}, Region({j: 0})),
        ("Eq. 4",),
    )


@cache
def _derived(changed: sympy.Expr, on_base: bool) -> sympy.Expr:
    """2r times a change of direction, Eq. 3 put in."""
    at = {j: ZERO} if on_base else {}
    return (2 * r * changed).xreplace(at).replace(DeltaX, displaced)


def follows(candidate: sympy.Eq, changed: sympy.Expr) -> Ruling:
    """Compare with Eq. 3 put into the derivative: for j ≥ 1, and on the fixed base for j = 0."""
    decided = partial(decide_linear, is_vector=True, basis=CARTESIAN)
    right = candidate.rhs
    return all_of(
        decided(right, _derived(changed, False), Region({j: 1})),
        decided(right.xreplace({j: ZERO}), _derived(changed, True), Region({})),
    )


def decide(_: int, candidate: sympy.Eq) -> Ruling:
    """Compare 2r δn⁺ with the derivative of the unit vector, Eq. 3 put in."""
    if other := about(candidate, 2 * r * DeltaNPlus(i, j), "none", each_contact):
        return other
    return follows(candidate, change())


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
    assumptions=("first order in δr", "fixed base; j ≥ 0"),
    premises=(eq01.DERIVATION, eq03.DERIVATION),
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
