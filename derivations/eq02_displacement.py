"""Eq. 2: how far a deposited bead moves when its own and its supports' radii deviate."""

from collections.abc import Iterator
from functools import cache

import sympy
from force_diffusion.derivations import eq01_ordered_positions as eq01
from force_diffusion.derivations.framework.follows import linear
from force_diffusion.derivations.framework.record import Derivation, Step, Witness
from force_diffusion.derivations.witnesses.both_sides import about, compare, each_bead, search
from force_diffusion.symbolic.algebra.affine import Region
from force_diffusion.symbolic.algebra.bases import CARTESIAN
from force_diffusion.symbolic.as_printed import equation, minus, terms, times
from force_diffusion.symbolic.kernel.decisions import (
    Ruling,
    all_of,
    cartesian,
    decide_identity,
    decide_linear,
)
from force_diffusion.symbolic.mechanics import contacts
from force_diffusion.symbolic.symbols import (
    DeltaR,
    DeltaX,
    Dot,
    MatrixTimes,
    b_minus,
    b_plus,
    e_y,
    i,
    j,
    n_minus,
    n_plus,
    n_x,
    n_y,
    r,
)

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
    left, right = (contacts.contact_constraint(eq01.ordered_separation(a, 1)) for a in (1, -1))
    return left, right


@cache
def solved() -> sympy.Expr:
    """δx_ij from both constraints, SymPy inverting their matrix, as a vector expression."""
    across, up = contacts.resting(constraints(), (i, j), SUPPORTS)
    return across * contacts.E_X + up * e_y


ROWS = sympy.ImmutableMatrix([[n_x, n_y], [-n_x, n_y]])


def _at_zero(part: int, candidate: sympy.Eq) -> Ruling:
    order_0 = constraints()[part].order_0
    return all_of(
        decide_identity(candidate.lhs - candidate.rhs, order_0),
        decide_identity(order_0, sympy.Integer(0)),
    )


def _exact(part: int, candidate: sympy.Eq) -> Ruling:
    return decide_identity(candidate.lhs - candidate.rhs, constraints()[part].exact)


def _derivative(part: int, candidate: sympy.Eq) -> Ruling:
    return decide_identity(candidate.lhs - candidate.rhs, constraints()[part].order_1)


def _component(part: int, candidate: sympy.Eq) -> Ruling:
    """The derivative is 4r times left less right side, Δx, Δy and ρ put in."""
    return decide_linear(
        4 * r * (candidate.lhs - candidate.rhs),
        contacts.of_beads(constraints()[part].order_1, (i, j), SUPPORTS[part]),
        Region({}),
        basis=CARTESIAN,
    )


def _inverse(_: int, candidate: sympy.Eq) -> Ruling:
    """The matrix of the derivatives over 4r; times what has the columns b^±, it is 1."""
    matrix, exponent = candidate.lhs.as_base_exp()
    derivatives = sympy.Matrix([constraint.order_1 for constraint in constraints()])
    rows = derivatives.jacobian([contacts.dx, contacts.dy])
    reciprocal = [[cartesian(b, axis) for b in (b_plus, b_minus)] for axis in range(2)]
    compared = (
        (4 * r * matrix, rows),
        (matrix ** (-exponent) * candidate.rhs, sympy.eye(2)),
        (candidate.rhs, sympy.Matrix(reciprocal)),
    )
    return all_of(
        *(
            decide_identity(one, other)
            for left, right in compared
            for one, other in zip(left, right, strict=True)
        )
    )


def _follows(_: int, candidate: sympy.Eq) -> Ruling:
    return linear({DeltaX(i, j): solved()}, is_vector=True, basis=CARTESIAN)(0, candidate)


def steps() -> Iterator[Step]:
    """Differentiate both contact constraints and invert the 2×2 system."""
    yield Step(
        "The bead touches both supports: the squared distance of the centres is the squared "
        "sum of the radii. With ε the strength of the disorder, Δx, Δy the difference of "
        "the two displacements and ρ the sum of the two δr, this vanishes, from the left support "
        "and from the right:",
        sympy.Tuple(*(equation(constraint.exact, 0) for constraint in constraints())),
        _exact,
        ("Eq. 1",),
    )
    yield Step(
        "At ε = 0 it holds.",
        sympy.Tuple(*(equation(constraint.order_0, 0) for constraint in constraints())),
        _at_zero,
        ("step 1",),
    )
    yield Step(
        "So its derivative there must vanish too.",
        sympy.Tuple(
            *(
                equation(times(4 * r, terms(across, n_y * contacts.dy, -contacts.radii)), 0)
                for across in (n_x * contacts.dx, -n_x * contacts.dx)
            )
        ),
        _derivative,
        ("step 1",),
    )
    yield Step(
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
        _component,
        ("step 3",),
    )
    yield Step(
        "The matrix of the two contacts has the rows n⁺ and n⁻; the columns of its inverse "
        "are the reciprocal vectors b⁺ and b⁻.",
        equation(sympy.Pow(ROWS, -1, evaluate=False), ROWS.inv()),
        _inverse,
        ("step 3",),
        positive=(ROWS,),
    )
    yield Step(
        "Applied to both right-hand sides:",
        equation(DeltaX(i, j), resting_on(LEFT, RIGHT)),
        _follows,
        ("step 4", "step 5"),
    )
    yield Step(
        "Written out in Cartesian components, this is the printed form.",
        PRINTED,
        decide,
        ("step 4", "step 5"),
    )


def decide(_: int, candidate: sympy.Eq) -> Ruling:
    """Compare with the solved constraints, in Cartesian components."""
    if other := about(candidate, DeltaX(i, j), "none", each_bead):
        return other
    return _follows(0, candidate)


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
