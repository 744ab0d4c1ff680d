"""Eq. 2: how far a deposited bead moves when its own and its supports' radii deviate."""

from functools import cache

import sympy
from force_diffusion.derivations import eq01_ordered_positions as eq01
from force_diffusion.derivations.framework.vocabulary import (
    Derivation,
    Lines,
    Part,
    Where,
    axioms,
    equation,
    follows,
    inverse,
    minus,
    order,
    solve,
    terms,
    times,
)
from force_diffusion.symbolic.mechanics import contacts
from force_diffusion.symbolic.symbols import (
    DeltaR,
    DeltaX,
    Dot,
    MatrixTimes,
    b_minus,
    b_plus,
    i,
    j,
    n_minus,
    n_plus,
    n_x,
    n_y,
    r,
)

WHERE = Where.of(j >= 1)
SUPPORTS = ((i - 1, j - 1), (i + 1, j - 1))
LEFT, RIGHT = (DeltaX(*support) for support in SUPPORTS)
half = sympy.Rational(1, 2)

PRINTED = equation(
    DeltaX(i, j),
    terms(
        times(half, terms(LEFT, RIGHT)),
        minus(times(half, MatrixTimes(0, n_y / n_x, n_x / n_y, 0, terms(RIGHT, minus(LEFT))))),
        times(terms(DeltaR(i, j), DeltaR(i - 1, j - 1)), b_plus),
        times(terms(DeltaR(i, j), DeltaR(i + 1, j - 1)), b_minus),
    ),
)


def resting_on(left: sympy.Expr, right: sympy.Expr) -> sympy.Expr:
    """δx_ij from its supports' displacements: each contact fixes one component n^±·δx."""
    return terms(
        times(terms(Dot(n_plus, left), DeltaR(i, j), DeltaR(i - 1, j - 1)), b_plus),
        times(terms(Dot(n_minus, right), DeltaR(i, j), DeltaR(i + 1, j - 1)), b_minus),
    )


@cache
def constraints() -> tuple[contacts.Linearised, contacts.Linearised]:
    """What both contacts impose, SymPy differentiating: from the left support, from the right."""
    apart = [
        sympy.ImmutableMatrix([n_x * 2 * r, n_y * 2 * r]),
        sympy.ImmutableMatrix([-n_x * 2 * r, n_y * 2 * r]),
    ]
    left, right = map(contacts.contact_constraint, apart)
    return left, right


ROWS = sympy.ImmutableMatrix([[n_x, n_y], [-n_x, n_y]])


def _derivative(constraint: contacts.Linearised) -> sympy.Eq:
    """That the derivative at ε = 0 vanishes, which is linear in Δx, Δy and ρ."""
    parts = (contacts.dx, contacts.dy, contacts.radii)
    slopes = (sympy.diff(constraint.order_1, one) / (4 * r) * one for one in parts)
    return equation(times(4 * r, terms(*slopes)), 0)


@cache
def steps() -> Lines:
    """Differentiate both contact constraints and invert the 2×2 system."""
    lines = Lines(WHERE)
    meaning = tuple(contacts.of_beads((i, j), support) for support in SUPPORTS)
    exact = lines.show(
        "The bead touches both supports: the squared distance of the centres is the squared "
        "sum of the radii. With ε the strength of the disorder, Δx, Δy the difference of "
        "the two displacements and ρ the sum of the two δr, this vanishes, from the left support "
        "and from the right:",
        sympy.Tuple(*(equation(constraint.exact, 0) for constraint in constraints())),
        (follows(axioms.contact(1)), follows(axioms.contact(-1))),
        meaning=meaning,
        after=(eq01.DERIVATION,),
    )
    lines.show(
        "At ε = 0 it holds.",
        sympy.Tuple(*(equation(constraint.order_0, 0) for constraint in constraints())),
        (order(Part(exact, 0), 0), order(Part(exact, 1), 0)),
        meaning=meaning,
    )
    derivatives = lines.show(
        "So its derivative there must vanish too.",
        sympy.Tuple(*map(_derivative, constraints())),
        (order(Part(exact, 0), 1), order(Part(exact, 1), 1)),
        meaning=meaning,
    )
    components = lines.show(
        "A contact fixes one component of the displacement.",
        sympy.Tuple(
            equation(
                Dot(n_plus, terms(DeltaX(i, j), minus(LEFT))),
                terms(DeltaR(i, j), DeltaR(i - 1, j - 1)),
            ),
            equation(
                Dot(n_minus, terms(DeltaX(i, j), minus(RIGHT))),
                terms(DeltaR(i, j), DeltaR(i + 1, j - 1)),
            ),
        ),
        (follows(Part(derivatives, 0)), follows(Part(derivatives, 1))),
    )
    inverted = lines.show(
        "The matrix of the two contacts has the rows n⁺ and n⁻; the columns of its inverse "
        "are the reciprocal vectors b⁺ and b⁻.",
        equation(sympy.Pow(ROWS, -1, evaluate=False), ROWS.inv()),
        inverse(),
        where=Where(),
        after=(derivatives,),
    )
    solved = solve(components, [DeltaX(i, j)])
    lines.show(
        "Applied to both right-hand sides:",
        equation(DeltaX(i, j), resting_on(LEFT, RIGHT)),
        solved,
        after=(inverted,),
    )
    lines.show(
        "Written out in Cartesian components, this is the printed form.",
        PRINTED,
        solved,
        after=(inverted,),
    )
    return lines


DERIVATION = Derivation(
    number=2,
    name="displacement",
    title="Displacement of a deposited bead",
    symbols=(
        (DeltaX(i, j), "displacement of bead (i, j) from its ordered position"),
        (DeltaR(i, j), "deviation of its radius from r"),
        (b_plus, "reciprocal vector (1/2n_x, 1/2n_y): n⁺·b⁺ = 1, n⁻·b⁺ = 0"),
        (b_minus, "reciprocal vector (−1/2n_x, 1/2n_y): n⁻·b⁻ = 1, n⁺·b⁻ = 0"),
    ),
    assumptions=(
        "first order in δr",
        "the bead rests on (i−1, j−1) and (i+1, j−1)",
        "the contacts are those of the ordered packing",
        *WHERE.in_words(),
    ),
    premises=(eq01.DERIVATION,),
    printed=(PRINTED,),
    steps=steps,
    where=WHERE,
)

if __name__ == "__main__":
    from force_diffusion.derivations.commands.alone import run_alone

    raise SystemExit(run_alone(DERIVATION))
