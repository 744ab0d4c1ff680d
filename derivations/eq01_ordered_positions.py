"""Eq. 1: where the beads of the ordered packing are, and for which spacings it is a packing."""

from collections.abc import Iterator

import sympy
from force_diffusion.derivations.framework.follows import Known, identity, linear
from force_diffusion.derivations.framework.record import Derivation, Step, Witness
from force_diffusion.derivations.witnesses.both_sides import about, compare, each_contact, search
from force_diffusion.symbolic.algebra.bases import CARTESIAN
from force_diffusion.symbolic.as_printed import equation, terms, times
from force_diffusion.symbolic.kernel.decisions import (
    Ruling,
    all_of,
    cartesian,
    decide_identity,
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


TOUCHING = sympy.Tuple(
    equation(Position(0, 0), 0),
    equation(Position(i + 1, j + 1) - Position(i, j), 2 * r * n_plus),
    equation(Position(i - 1, j + 1) - Position(i, j), 2 * r * n_minus),
)
"""What the ordered packing is: its origin, and each bead touching the two above it."""

IN_SPACING = {spacing: 4 * r * n_x}


def _squared_distance(across: sympy.Expr, up: sympy.Expr) -> sympy.Expr:
    separation = ordered_separation(across, up)
    return separation.dot(separation)


def _known() -> Known:
    return {SQUARED_DISTANCE: _squared_distance, **IN_SPACING}


def _spacing(_: int, candidate: sympy.Eq) -> Ruling:
    """s is the horizontal distance of two beads of one layer, which are two indices apart."""
    apart = ordered_separation(2, 0)
    return all_of(
        identity({spacing: apart[0]})(0, candidate), decide_identity(apart[1], sympy.Integer(0))
    )


def steps() -> Iterator[Step]:
    """From touching along the two lattice directions to the range of the spacing."""
    yield Step(
        "Bead (0, 0) is the origin; each bead touches the two above it, so one step up "
        "moves by a full diameter along n⁺ or n⁻. The printed positions do so.",
        TOUCHING,
        linear({Position: positions}, is_vector=True, basis=CARTESIAN),
        ("Eq. 1",),
    )
    yield Step(
        "No other positions do: going (j+i)/2 steps along n⁺ and (j−i)/2 along n⁻ reaches bead "
        "(i, j).",
        PRINTED,
        decide,
        ("step 1",),
    )
    yield Step(
        "Beads of one layer are two indices apart, which defines the spacing s.",
        equation(spacing, 4 * r * n_x),
        _spacing,
        ("Eq. 1",),
    )
    yield Step(
        "The squared distance of two beads that are (a, b) apart, a + b even.",
        equation(SQUARED_DISTANCE(a, b), 4 * r**2 * (a**2 * n_x**2 + b**2 * n_y**2)),
        identity(_known()),
        ("Eq. 1",),
    )
    yield Step(
        "The four contacts (±1, ±1) touch.",
        sympy.Tuple(
            equation(SQUARED_DISTANCE(1, 1), 4 * r**2), equation(SQUARED_DISTANCE(1, -1), 4 * r**2)
        ),
        identity(_known()),
        ("step 4",),
    )
    yield Step(
        "Every other pair has |a| ≥ 2 or |b| ≥ 2; the tightest are (2, 0) and (0, 2). They do "
        "not overlap when both of these are positive.",
        sympy.Tuple(
            equation(SQUARED_DISTANCE(2, 0) - 4 * r**2, spacing**2 - 4 * r**2),
            equation(SQUARED_DISTANCE(0, 2) - 4 * r**2, 12 * r**2 - spacing**2),
        ),
        identity(_known()),
        ("step 3", "step 4"),
    )
    yield Step(
        "All others are further apart: none of the terms is negative for |a| ≥ 2 (first) or "
        "|b| ≥ 2 (second), the last one being that of the tightest pair.",
        sympy.Tuple(
            equation(
                SQUARED_DISTANCE(a, b) - 4 * r**2,
                terms(
                    times(4 * r**2, terms(a**2, -4), n_x**2),
                    times(4 * r**2, b**2, n_y**2),
                    terms(SQUARED_DISTANCE(2, 0), -4 * r**2),
                ),
            ),
            equation(
                SQUARED_DISTANCE(a, b) - 4 * r**2,
                terms(
                    times(4 * r**2, a**2, n_x**2),
                    times(4 * r**2, terms(b**2, -4), n_y**2),
                    terms(SQUARED_DISTANCE(0, 2), -4 * r**2),
                ),
            ),
        ),
        identity(_known()),
        ("step 4",),
    )
    yield Step(
        "Hence s lies between 2r and 2√3 r, and in terms of φ = n⁺·n⁻ both bounds together "
        "say |φ| < ½; and 1 − φ² is positive.",
        sympy.Tuple(
            equation(sympy.Rational(1, 2) - phi, (spacing**2 - 4 * r**2) / (8 * r**2)),
            equation(sympy.Rational(1, 2) + phi, (12 * r**2 - spacing**2) / (8 * r**2)),
            equation(1 - phi**2, 4 * n_x**2 * n_y**2),
        ),
        identity(_known()),
        ("step 3",),
    )


def decide(_: int, candidate: sympy.Eq) -> Ruling:
    """The candidate is Eq. 1 when it puts bead (0, 0) at the origin and steps by 2r n^±."""
    if other := about(candidate, Position(i, j), "none", each_contact):
        return other

    def at(across: sympy.Expr, layer: sympy.Expr) -> sympy.Expr:
        return candidate.rhs.xreplace({i: across, j: layer})

    holds = linear({Position: at}, is_vector=True, basis=CARTESIAN)
    return all_of(*(holds(part, one) for part, one in enumerate(TOUCHING)))


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
