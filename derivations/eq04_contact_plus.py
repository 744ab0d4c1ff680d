"""Eq. 4: the change of the direction of the contact along n⁺."""

from collections.abc import Callable, Iterator

import sympy
from force_diffusion.derivations import eq01_ordered_positions as eq01
from force_diffusion.derivations import eq03_extrapolation as eq03
from force_diffusion.derivations.framework.record import Claim, Derivation, Step, Witness
from force_diffusion.derivations.witnesses.both_sides import about, compare, each_contact, search
from force_diffusion.symbolic.algebra.affine import Region
from force_diffusion.symbolic.as_printed import equation, minus, terms, times
from force_diffusion.symbolic.kernel.decisions import Ruling, all_of, decide_identity, decide_linear
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
    n_x,
    n_y,
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


def steps() -> Iterator[Step]:
    """Differentiate the exact unit vector, then put in Eq. 3."""
    yield Step(
        "The centres of touching beads are exactly R + R′ apart, so the unit vector of the "
        "contact is their separation over R + R′ = 2r + ερ; its derivative at ε = 0 is "
        "(Δx − ρ n⁺)/2r.",
        equation(times(2, r, DeltaNPlus(i, j)), from_displacements(DeltaX(*ABOVE), DeltaX(i, j))),
    )
    yield Step(
        "With Eq. 3 for both beads, the b⁺ component of the difference is the sum of the "
        "two radii alone, since both beads lie on one diagonal along n⁺; the b⁻ component "
        "compares two neighbouring diagonals along n⁻.",
        PRINTED,
    )
    yield Step(
        "The contact's length has been used: the change is at right angles to n⁺.",
        equation(Dot(n_plus, DeltaNPlus(i, j)), 0),
    )


def follows(
    candidate: sympy.Expr,
    derived: Callable[[sympy.Expr, sympy.Expr], sympy.Expr],
    above: tuple[sympy.Expr, sympy.Expr],
) -> Ruling:
    """Compare with Eq. 3 put into the derivative: for j ≥ 1, and on the fixed base for j = 0."""
    upper = eq03.displacement(*above)
    above_base = decide_linear(
        candidate, derived(upper, eq03.displacement(i, j)), Region({j: 1}), is_vector=True
    )
    at_base = decide_linear(
        candidate.xreplace({j: ZERO}),
        derived(upper, ZERO).xreplace({j: ZERO}),
        Region({}),
        is_vector=True,
    )
    return all_of(above_base, at_base)


def decide(_: int, candidate: sympy.Eq) -> Ruling:
    """Compare 2r δn⁺ with the derivative of the unit vector, Eq. 3 put in."""
    if other := about(candidate, 2 * r * DeltaNPlus(i, j), "none", each_contact):
        return other
    return follows(candidate.rhs, from_displacements, ABOVE)


def _unit_vector() -> Ruling:
    change = contacts.unit_vector_change(eq01.ordered_separation(1, 1))
    expected = (contacts.dx - contacts.radii * n_x, contacts.dy - contacts.radii * n_y)
    return all_of(*(decide_identity(2 * r * change[axis], expected[axis]) for axis in range(2)))


def _orthogonal() -> Ruling:
    return decide_linear(Dot(n_plus, PRINTED.rhs), sympy.Integer(0), Region({j: 0}))


DERIVATION = Derivation(
    number=4,
    name="contact_plus",
    title="Change of the contact direction along n⁺",
    symbols=(
        (DeltaNPlus(i, j), "change of the direction from (i, j) to (i+1, j+1)"),
        (DeltaR(i, j), "deviation of the radius of bead (i, j)"),
    ),
    assumptions=("first order in δr", "fixed base; j ≥ 0"),
    premises=(eq01.DERIVATION, eq03.DERIVATION),
    printed=(PRINTED,),
    steps=steps,
    decide=decide,
    search=search("none", each_contact),
    claims=(
        Claim("the derivative of the exact unit vector is (δx − δx′ − ρ n⁺)/2r", _unit_vector),
        Claim("n⁺·δn⁺ = 0: a unit vector to first order", _orthogonal),
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
