"""Eq. 2: how far a deposited bead moves when its own and its supports' radii deviate."""

# fmt: off
import sympy
from force_diffusion.derivations.framework.vocabulary import (
    Derivation, Domain, Steps, Symbol, axioms, equation, follows, minus, order, rewrite, solve,
    terms, times, usual)
from force_diffusion.symbolic.symbols import (
    DeltaR, DeltaX, Dot, MatrixTimes, b_minus, b_plus, e_x, e_y, epsilon, i, j,
    n_minus, n_plus, n_x, n_y, r)
# fmt: on

ABOVE = Domain.of(j >= 1)
SUPPORTS = ((i - 1, j - 1), (i + 1, j - 1))
LEFT, RIGHT = (DeltaX(*support) for support in SUPPORTS)
LEFT_RADII, RIGHT_RADII = (terms(DeltaR(i, j), DeltaR(*support)) for support in SUPPORTS)
"""δr of the bead plus that of each support."""
half = sympy.Rational(1, 2)

PRINTED = equation(
    DeltaX(i, j),
    terms(
        times(half, terms(LEFT, RIGHT)),
        minus(times(half, MatrixTimes(0, n_y / n_x, n_x / n_y, 0, terms(RIGHT, minus(LEFT))))),
        times(LEFT_RADII, b_plus),
        times(RIGHT_RADII, b_minus),
    ),
)

# δx of the bead less that of a support, and δr of both together
dx = Symbol("dx", r"\Delta x", "Δx", real=True)
dy = Symbol("dy", r"\Delta y", "Δy", real=True)
rho = Symbol("rho", r"\rho", "ρ", real=True)
SIDES = sympy.ImmutableMatrix([[n_x, n_y], [-n_x, n_y]])
"""The directions n⁺ and n⁻ from the supports to the bead, as rows."""


def contact(side: int) -> sympy.Expr:
    """What a contact makes vanish: squared distance of the centres less squared sum of the radii.

    The strength of the disorder is ε.
    """
    apart = 2 * r * SIDES.row(side).T + epsilon * sympy.Matrix([dx, dy])
    return apart.dot(apart) - (2 * r + epsilon * rho) ** 2


def of_support(site: tuple[sympy.Expr, sympy.Expr]) -> dict[sympy.Symbol, sympy.Expr]:
    """What Δx, Δy and ρ are for one of the supports."""
    apart = DeltaX(i, j) - DeltaX(*site)
    return {dx: Dot(e_x, apart), dy: Dot(e_y, apart), rho: DeltaR(i, j) + DeltaR(*site)}


def show_steps(steps: Steps) -> None:
    """Differentiate both contact constraints and invert the 2×2 system."""
    contacts = sympy.Matrix([contact(0), contact(1)])
    supports = tuple(map(of_support, SUPPORTS))
    exact = steps.show(
        "The bead touches both supports, so the squared distance of the centres equals the "
        "squared sum of the radii. Let ε be the strength of the disorder, (Δx, Δy) the "
        "displacement of the bead less that of a support, and ρ the sum of their two δr. For the "
        "left and for the right support:",
        sympy.Tuple(*(equation(constraint, 0) for constraint in contacts)),
        (follows(axioms.contact(1)), follows(axioms.contact(-1))),
        definitions=supports,
    )
    slope = contacts.jacobian([epsilon]).subs(epsilon, 0)
    linear = steps.show(
        "This holds for all small ε, so the derivative at ε = 0 vanishes, too:",
        sympy.Tuple(*(equation(sympy.expand(side), 0) for side in slope)),
        tuple(order(theorem, 1) for theorem in exact.theorems),
        definitions=supports,
    )
    components = steps.show(
        "So each contact fixes one component of the displacement:",
        sympy.Tuple(
            equation(Dot(n_plus, terms(DeltaX(i, j), minus(LEFT))), LEFT_RADII),
            equation(Dot(n_minus, terms(DeltaX(i, j), minus(RIGHT))), RIGHT_RADII),
        ),
        tuple(map(follows, linear.theorems)),
    )
    inverse = SIDES.LUsolve(sympy.eye(2))  # its pivot n_x is positive
    steps.show(
        "The matrix of the two contacts has the rows n⁺ and n⁻. By elimination, with the pivot "
        "n_x > 0, the columns of its inverse are the reciprocal vectors b⁺ and b⁻:",
        sympy.Tuple(
            *(
                equation(Dot(axis, vector), inverse[row, column])
                for column, vector in enumerate((b_plus, b_minus))
                for row, axis in enumerate((e_x, e_y))
            )
        ),
        rewrite(),
        Domain(),
    )
    solved = solve(components.theorems, [DeltaX(i, j)])
    steps.show(
        "So the two components fix the displacement:",
        equation(
            DeltaX(i, j),
            terms(
                times(terms(Dot(n_plus, LEFT), *LEFT_RADII.args), b_plus),
                times(terms(Dot(n_minus, RIGHT), *RIGHT_RADII.args), b_minus),
            ),
        ),
        solved,
    )
    steps.show("In Cartesian components the solution is the printed form.", PRINTED, solved)


DERIVATION = Derivation(
    number=2,
    name="displacement",
    title="Displacement of a deposited bead",
    symbols=usual(DeltaX(i, j), DeltaR(i, j), b_plus, b_minus),
    assumptions=(
        "first order in δr",
        "the bead rests on (i−1, j−1) and (i+1, j−1)",
        "the contacts are those of the ordered packing",
        *ABOVE.in_words(),
    ),
    printed=(PRINTED,),
    domain=ABOVE,
    show_steps=show_steps,
)

if __name__ == "__main__":
    from force_diffusion.derivations.commands.cli import run_alone

    raise SystemExit(run_alone(2))
