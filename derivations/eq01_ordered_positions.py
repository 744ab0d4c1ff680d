"""Eq. 1: where the beads of the ordered packing are, and for which spacings it is a packing."""

from collections.abc import Iterator

import sympy
from force_diffusion.derivations.framework.record import Claim, Derivation, Step, Witness
from force_diffusion.derivations.witnesses.both_sides import about, compare, each_contact, search
from force_diffusion.symbolic.algebra.affine import Region
from force_diffusion.symbolic.algebra.bases import CARTESIAN
from force_diffusion.symbolic.as_printed import equation, terms, times
from force_diffusion.symbolic.kernel.decisions import (
    Ruling,
    all_of,
    cartesian,
    decide_identity,
    decide_linear,
)
from force_diffusion.symbolic.symbols import (
    Position,
    i,
    j,
    n_minus,
    n_plus,
    n_x,
    n_y,
    phi,
    r,
    spacing,
)

PRINTED = equation(
    Position(i, j),
    terms(times(r, terms(j, i), n_plus), times(r, terms(j, -i), n_minus)),
)

SQUARED_DISTANCE = sympy.Function("D")  # D(a, b) = |x_(i+a, j+b) − x_ij|²
a, b = sympy.symbols("a b", integer=True)


def positions(across: sympy.Expr, layer: sympy.Expr) -> sympy.Expr:
    """x at a site, as a vector expression (Eq. 1)."""
    return PRINTED.rhs.xreplace({i: across, j: layer})


def ordered_separation(across: sympy.Expr | int, layer: sympy.Expr | int) -> sympy.ImmutableMatrix:
    """x_(i+across, j+layer) − x_ij in Cartesian components."""
    apart = sympy.expand(positions(i + across, j + layer) - positions(i, j))
    return sympy.ImmutableMatrix([cartesian(apart, axis) for axis in range(2)])


def steps() -> Iterator[Step]:
    """From touching along the two lattice directions to the range of the spacing."""
    yield Step(
        "Bead (0, 0) is the origin; each bead touches the two above it, so one step up "
        "moves by a full diameter along n⁺ or n⁻.",
        equation(Position(i + 1, j + 1) - Position(i, j), 2 * r * n_plus),
    )
    yield Step("Going (j+i)/2 steps along n⁺ and (j−i)/2 along n⁻ reaches bead (i, j).", PRINTED)
    yield Step(
        "In Cartesian components the bead is at (2 r i n_x, 2 r j n_y); beads of one layer "
        "are two indices apart, which defines the spacing s.",
        equation(spacing, 4 * r * n_x),
    )
    yield Step(
        "The squared distance of two beads that are (a, b) apart, a + b even.",
        equation(SQUARED_DISTANCE(a, b), 4 * r**2 * (a**2 * n_x**2 + b**2 * n_y**2)),
    )
    yield Step(
        "Besides the four contacts (±1, ±1), every pair has |a| ≥ 2 or |b| ≥ 2; the "
        "tightest are (2, 0) and (0, 2). They do not overlap when both of these are "
        "positive.",
        sympy.Tuple(
            equation(SQUARED_DISTANCE(2, 0) - 4 * r**2, spacing**2 - 4 * r**2),
            equation(SQUARED_DISTANCE(0, 2) - 4 * r**2, 12 * r**2 - spacing**2),
        ),
    )
    yield Step(
        "Hence s lies between 2r and 2√3 r, and in terms of φ = n⁺·n⁻ both bounds together "
        "say |φ| < ½.",
        sympy.Tuple(
            equation(sympy.Rational(1, 2) - phi, (spacing**2 - 4 * r**2) / (8 * r**2)),
            equation(sympy.Rational(1, 2) + phi, (12 * r**2 - spacing**2) / (8 * r**2)),
        ),
    )


def decide(_: int, candidate: sympy.Eq) -> Ruling:
    """The candidate is Eq. 1 when it puts bead (0, 0) at the origin and steps by 2r n^±."""
    if other := about(candidate, Position(i, j), "none", each_contact):
        return other

    def at(across: sympy.Expr, layer: sympy.Expr) -> sympy.Expr:
        return candidate.rhs.xreplace({i: across, j: layer})

    everywhere = Region({})
    zero = sympy.Integer(0)
    rulings = [
        decide_linear(at(zero, zero), zero * n_plus, everywhere, is_vector=True, basis=CARTESIAN)
    ]
    for direction, step in ((n_plus, 1), (n_minus, -1)):
        rulings.append(
            decide_linear(
                at(i + step, j + 1),
                terms(at(i, j), 2 * r * direction),
                everywhere,
                is_vector=True,
                basis=CARTESIAN,
            )
        )
    return all_of(*rulings)


def _squared_distance(across: sympy.Expr, up: sympy.Expr) -> sympy.Expr:
    separation = ordered_separation(across, up)
    return separation.dot(separation)


def _spacing_bounds() -> Ruling:
    in_spacing = {spacing: 4 * r * n_x}
    return all_of(
        decide_identity(_squared_distance(sympy.Integer(1), sympy.Integer(1)), 4 * r**2),
        decide_identity(_squared_distance(sympy.Integer(1), sympy.Integer(-1)), 4 * r**2),
        decide_identity(
            _squared_distance(sympy.Integer(2), sympy.Integer(0)) - 4 * r**2,
            (spacing**2 - 4 * r**2).xreplace(in_spacing),
        ),
        decide_identity(
            _squared_distance(sympy.Integer(0), sympy.Integer(2)) - 4 * r**2,
            (12 * r**2 - spacing**2).xreplace(in_spacing),
        ),
    )


def _no_other_pair_is_closer() -> Ruling:
    # a sum of terms that are not negative for |a| ≥ 2 (first) or |b| ≥ 2 (second)
    gap = _squared_distance(a, b) / (4 * r**2) - 1
    return all_of(
        decide_identity(gap, (a**2 - 4) * n_x**2 + b**2 * n_y**2 + (4 * n_x**2 - 1)),
        decide_identity(gap, a**2 * n_x**2 + (b**2 - 4) * n_y**2 + (4 * n_y**2 - 1)),
    )


def _cosine_bounds() -> Ruling:
    half = sympy.Rational(1, 2)
    return all_of(
        decide_identity(half - phi, (4 * n_x**2 - 1) / 2),
        decide_identity(half + phi, (4 * n_y**2 - 1) / 2),
        decide_identity(1 - phi**2, 4 * n_x**2 * n_y**2),
    )


DERIVATION = Derivation(
    number=1,
    name="ordered_positions",
    title="Positions in the ordered packing",
    symbols=(
        (Position(i, j), "centre of bead (i, j), i + j even"),
        (r, "radius of a bead"),
        (n_plus, "unit vector (n_x, n_y), up and to the right"),
        (n_minus, "unit vector (−n_x, n_y), up and to the left"),
        (spacing, "horizontal distance of two centres in one layer"),
    ),
    assumptions=(
        "all radii equal r",
        "bead (i, j) touches the beads (i±1, j±1)",
        "i + j is even; the base is j = 0",
    ),
    premises=(),
    printed=(PRINTED,),
    steps=steps,
    decide=decide,
    search=search("none", each_contact),
    claims=(
        Claim(
            "contacts touch; the pairs (2, 0) and (0, 2) are apart exactly for 2r < s < 2√3 r",
            _spacing_bounds,
        ),
        Claim(
            "no other pair is closer: its squared distance exceeds by non-negative terms",
            _no_other_pair_is_closer,
        ),
        Claim("the same bounds are −½ < φ < ½, and 1 − φ² = 4 n_x² n_y² > 0", _cosine_bounds),
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
