"""Eq. 1: where the beads of the ordered packing are, and for which spacings it is a packing."""

from functools import cache

import sympy
from force_diffusion.derivations.framework.vocabulary import (
    Derivation,
    Lines,
    Where,
    axioms,
    equation,
    follows,
    reach,
    rewrite,
    terms,
    times,
)
from force_diffusion.symbolic.symbols import (
    Dot,
    Position,
    e_x,
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


def separation(across: sympy.Expr | int, layer: sympy.Expr | int) -> sympy.Expr:
    """x_(i+across, j+layer) − x_ij, Eq. 1 put in."""
    return PRINTED.rhs.xreplace({i: i + across, j: j + layer}) - PRINTED.rhs


TOUCHING = sympy.Tuple(
    equation(Position(0, 0), 0),
    equation(Position(i + 1, j + 1) - Position(i, j), 2 * r * n_plus),
    equation(Position(i - 1, j + 1) - Position(i, j), 2 * r * n_minus),
)
"""What the ordered packing is: its origin, and each bead touching the two above it."""

WHERE = Where.of(j >= 0)


def _squared_distance(across: sympy.Expr, up: sympy.Expr) -> sympy.Expr:
    return Dot(separation(across, up), separation(across, up))


@cache
def steps() -> Lines:
    """From touching along the two lattice directions to the range of the spacing."""
    lines = Lines(WHERE)
    touching = lines.show(
        "Bead (0, 0) is the origin; each bead touches the two above it, so one step up "
        "moves by a full diameter along n⁺ or n⁻. The printed positions do so.",
        TOUCHING,
        tuple(map(follows, axioms.ordered())),
        where=(Where(), WHERE, WHERE),
    )
    printed = lines.show(
        "No other positions do: going (j+i)/2 steps along n⁺ and (j−i)/2 along n⁻ reaches bead "
        "(i, j).",
        PRINTED,
        reach(touching),
    )
    apart = lines.show(
        "Beads of one layer are two indices apart, which defines the spacing s.",
        equation(spacing, 4 * r * n_x),
        rewrite(printed),
        meaning={spacing: Dot(e_x, Position(i + 2, j) - Position(i, j))},
    )
    squared = {SQUARED_DISTANCE: _squared_distance}
    in_spacing = {**squared, spacing: 4 * r * n_x}
    distance = lines.show(
        "The squared distance of two beads that are (a, b) apart, a + b even.",
        equation(SQUARED_DISTANCE(a, b), 4 * r**2 * (a**2 * n_x**2 + b**2 * n_y**2)),
        rewrite(printed),
        meaning=squared,
    )
    lines.show(
        "The four contacts (±1, ±1) touch.",
        sympy.Tuple(
            equation(SQUARED_DISTANCE(1, 1), 4 * r**2), equation(SQUARED_DISTANCE(1, -1), 4 * r**2)
        ),
        rewrite(printed),
        meaning=squared,
        after=(distance,),
    )
    lines.show(
        "Every other pair has |a| ≥ 2 or |b| ≥ 2; the tightest are (2, 0) and (0, 2). They do "
        "not overlap when both of these are positive.",
        sympy.Tuple(
            equation(SQUARED_DISTANCE(2, 0) - 4 * r**2, spacing**2 - 4 * r**2),
            equation(SQUARED_DISTANCE(0, 2) - 4 * r**2, 12 * r**2 - spacing**2),
        ),
        rewrite(apart, distance),
        meaning=in_spacing,
    )
    lines.show(
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
        rewrite(distance),
        meaning=squared,
    )
    lines.show(
        "Hence s lies between 2r and 2√3 r, and in terms of φ = n⁺·n⁻ both bounds together "
        "say |φ| < ½; and 1 − φ² is positive.",
        sympy.Tuple(
            equation(sympy.Rational(1, 2) - phi, (spacing**2 - 4 * r**2) / (8 * r**2)),
            equation(sympy.Rational(1, 2) + phi, (12 * r**2 - spacing**2) / (8 * r**2)),
            equation(1 - phi**2, 4 * n_x**2 * n_y**2),
        ),
        rewrite(apart),
        meaning=in_spacing,
    )
    return lines


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
        *WHERE.in_words(),
    ),
    premises=(),
    printed=(PRINTED,),
    steps=steps,
    where=WHERE,
)

if __name__ == "__main__":
    from force_diffusion.derivations.commands.alone import run_alone

    raise SystemExit(run_alone(DERIVATION))
