"""Eq. 2: how far a deposited bead moves when its own and its supports' radii deviate."""

from collections.abc import Iterator

import sympy
from force_diffusion.derivations import eq01_ordered_positions as eq01
from force_diffusion.derivations.framework.record import Claim, Derivation, Step, Witness
from force_diffusion.derivations.witnesses.both_sides import about, compare, each_bead, search
from force_diffusion.symbolic.algebra.affine import Region
from force_diffusion.symbolic.algebra.bases import CARTESIAN
from force_diffusion.symbolic.as_printed import equation, minus, terms, times
from force_diffusion.symbolic.kernel.decisions import Ruling, all_of, decide_identity, decide_linear
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

LEFT, RIGHT = DeltaX(i - 1, j - 1), DeltaX(i + 1, j - 1)
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


def steps() -> Iterator[Step]:
    """Differentiate both contact constraints and invert the 2×2 system."""
    constraint = contacts.contact_constraint(eq01.ordered_separation(1, 1))
    yield Step(
        "The bead touches its support: the squared distance of the centres is the squared "
        "sum of the radii. With ε the strength of the disorder, Δx, Δy the difference of "
        "the two displacements and ρ the sum of the two δr, this vanishes:",
        equation(constraint.exact, 0),
    )
    yield Step(
        "At ε = 0 it holds by Eq. 1; its derivative there must vanish too.",
        equation(sympy.factor(constraint.order_1), 0),
    )
    yield Step(
        "So a contact fixes one component of the displacement.",
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
    )
    yield Step(
        "The matrix of the two contacts has the rows n⁺ and n⁻; the columns of its inverse "
        "are the reciprocal vectors b⁺ and b⁻.",
        equation(
            sympy.Pow(contacts.constraint_matrix(), -1, evaluate=False),
            contacts.constraint_matrix().inv(),
        ),
    )
    yield Step("Applied to both right-hand sides:", equation(DeltaX(i, j), resting_on(LEFT, RIGHT)))
    yield Step("Written out in Cartesian components, this is the printed form.", PRINTED)


def decide(_: int, candidate: sympy.Eq) -> Ruling:
    """Compare with the solved constraints, in Cartesian components."""
    if other := about(candidate, DeltaX(i, j), "none", each_bead):
        return other
    return decide_linear(
        candidate.rhs, resting_on(LEFT, RIGHT), Region({}), is_vector=True, basis=CARTESIAN
    )


def _linearisation() -> Ruling:
    rulings = []
    for sign in (1, -1):
        constraint = contacts.contact_constraint(eq01.ordered_separation(sign, 1))
        along = sign * n_x * contacts.dx + n_y * contacts.dy
        rulings.append(decide_identity(constraint.order_0, sympy.Integer(0)))
        rulings.append(decide_identity(constraint.order_1, 4 * r * (along - contacts.radii)))
    return all_of(*rulings)


def _reciprocal_vectors() -> Ruling:
    inverse = contacts.constraint_matrix().inv()
    b = {"+": (1 / (2 * n_x), 1 / (2 * n_y)), "-": (-1 / (2 * n_x), 1 / (2 * n_y))}
    return all_of(
        *(
            decide_identity(inverse[row, column], b[branch][row])
            for column, branch in enumerate("+-")
            for row in range(2)
        )
    )


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
        "the bead rests on (i−1, j−1) and (i+1, j−1), j ≥ 1",
        "the contacts are those of the ordered packing",
    ),
    premises=(eq01.DERIVATION,),
    printed=(PRINTED,),
    steps=steps,
    decide=decide,
    search=search("none", each_bead),
    claims=(
        Claim(
            "the constraint holds at ε = 0 and its derivative is 4r (n·(δx − δx′) − ρ)",
            _linearisation,
        ),
        Claim(
            "the inverse of the constraint matrix has the columns b⁺ and b⁻", _reciprocal_vectors
        ),
    ),
    witnesses=(
        Witness(
            "an exact packing obeys it, both sides at orders ε⁰ and ε¹",
            lambda packing: compare(PRINTED, packing, "none", each_bead),
        ),
    ),
)

if __name__ == "__main__":
    from force_diffusion.derivations.commands.alone import run_alone

    raise SystemExit(run_alone(DERIVATION))
