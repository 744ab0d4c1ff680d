"""Eq. 1: positions of the beads in the ordered packing, and the spacings at which none overlap."""

# fmt: off
from functools import partial

import sympy
from force_diffusion.derivations.framework.vocabulary import (
    Derivation, Domain, Rule, Steps, Theorem, axioms, equation, follows, inducted, instance, minus,
    read, rewrite, terms, times, usual)
from force_diffusion.symbolic.symbols import (
    Dot, Position, e_x, i, j, n_minus, n_plus, n_x, n_y, p, phi, q, r, spacing)
# fmt: on

BEADS = Domain.of(j >= 0)

PRINTED = equation(
    Position(i, j), terms(times(r, terms(j, i), n_plus), times(r, terms(j, -i), n_minus))
)

TOUCHING = sympy.Tuple(
    equation(Position(0, 0), 0),
    equation(Position(i + 1, j + 1), terms(Position(i, j), 2 * r * n_plus)),
    equation(Position(i - 1, j + 1), terms(Position(i, j), 2 * r * n_minus)),
)
"""What the ordered packing is: its origin, and each bead touching the two above it."""

PAIRS = Domain.of(j >= 0, j + q >= 0, beads=[(i, j), (i + p, j + q)])
D = sympy.Function("D")  # D(p, q) = |x_(i+p, j+q) − x_ij|²


def squared_distance(across: sympy.Expr, up: sympy.Expr) -> sympy.Expr:
    """The squared distance of two beads."""
    apart = Position(i + across, j + up) - Position(i, j)
    return Dot(apart, apart)


def beyond_the_closest(across: sympy.Expr, up: sympy.Expr, closest: tuple[int, int]) -> sympy.Eq:
    """A pair's squared distance less 4r²: that of the closest pair, and two terms more."""
    more = times(4 * r**2, across, n_x**2), times(4 * r**2, up, n_y**2)
    return equation(D(p, q) - 4 * r**2, terms(*more, terms(D(*closest), -4 * r**2)))


ON_BASE = equation(Position(2 * p, 0), times(2 * p * r, terms(n_plus, minus(n_minus))))


def along_base(origin: Theorem, *up: Theorem) -> Rule:
    """The rule for beads (2p, 0): by induction, to the right and to the left of bead (0, 0)."""
    down = [
        follows(bond)(equation(Position(i, j), bond.formula.lhs - 2 * r * unit), BEADS)
        for bond, unit in zip(up, (n_plus, n_minus), strict=True)
    ]

    def rule(formula: sympy.Eq, domain: Domain) -> Theorem:
        at_origin, right, left = rewrite(origin), domain.also(p >= 0), domain.also(p <= 0)
        to_right, to_left = partial(rewrite, down[1], up[0]), partial(rewrite, down[0], up[1])
        halves = (
            *inducted(p, 0, at_origin, to_right, [(formula, right)]),
            *inducted(p, 0, at_origin, to_left, [(formula, left)], down=True),
        )
        return rewrite(halves)(formula, domain)

    return rule


def above_base(base: Theorem, up: Theorem) -> Rule:
    """The rule for beads (i, j): by induction, from layer to layer."""
    to_here = instance(up, {i: i - 1, j: j - 1}, Domain.of(j >= 1))

    def rule(formula: sympy.Eq, domain: Domain) -> Theorem:
        read(formula, domain)  # all beads that it names exist, in every layer
        return inducted(j, 0, rewrite(base), partial(rewrite, to_here), [(formula, domain)])[0]

    return rule


def show_steps(steps: Steps) -> None:
    """From touching along the two lattice directions to the range of the spacing."""
    touching = steps.show(
        "Bead (0, 0) is the origin; each bead touches the two above it, so one step up moves by a "
        "full diameter along n⁺ or n⁻.",
        TOUCHING,
        tuple(map(follows, axioms.ordered())),
        (Domain(), BEADS, BEADS),
    )
    origin, *up = touching.theorems
    base = steps.show(
        "In the base, a step up along n⁺ and one down along n⁻ lead to the next bead to the right, "
        "and the same steps back to the next one to the left. So, for all whole p:",
        ON_BASE,
        along_base(origin, *up),
        Domain.of(indices=(p,), beads=()),
    )
    printed = steps.show(
        "From the base, j steps along n⁺ lead up to bead (i, j):",
        PRINTED,
        above_base(base.theorem, up[0]),
    )
    steps.show(
        "Neighbours in a layer are two indices apart. Their distance is the spacing s.",
        equation(spacing, 4 * r * n_x),
        rewrite(printed.theorem),
        definitions={spacing: Dot(e_x, Position(i + 2, j) - Position(i, j))},
    )
    steps.show(
        "Two beads that are (p, q) apart, p + q even, have the squared distance",
        equation(D(p, q), 4 * r**2 * (p**2 * n_x**2 + q**2 * n_y**2)),
        rewrite(printed.theorem),
        PAIRS,
    )
    steps.show(
        "Contacts to both sides have the length 2r:",
        sympy.Tuple(equation(D(1, 1), 4 * r**2), equation(D(-1, 1), 4 * r**2)),
        rewrite(printed.theorem),
    )
    steps.show(
        "Every other pair has |p| ≥ 2 or |q| ≥ 2; the closest are (2, 0) and (0, 2). They do "
        "not overlap if both of these are positive.",
        sympy.Tuple(
            equation(D(2, 0) - 4 * r**2, spacing**2 - 4 * r**2),
            equation(D(0, 2) - 4 * r**2, 12 * r**2 - spacing**2),
        ),
        rewrite(printed.theorem),
    )
    steps.show(
        "All other pairs are at least as far apart: none of the terms is negative for |p| ≥ 2 "
        "(first line) or |q| ≥ 2 (second line), and the last is that of the closest pair.",
        sympy.Tuple(
            beyond_the_closest(terms(p**2, -4), q**2, (2, 0)),
            beyond_the_closest(p**2, terms(q**2, -4), (0, 2)),
        ),
        rewrite(printed.theorem),
        PAIRS,
    )
    steps.show(
        "Hence s lies between 2r and 2√3 r. In terms of φ = n⁺·n⁻ both bounds together say "
        "|φ| < ½, and 1 − φ² is positive:",
        sympy.Tuple(
            equation(sympy.Rational(1, 2) - phi, (spacing**2 - 4 * r**2) / (8 * r**2)),
            equation(sympy.Rational(1, 2) + phi, (12 * r**2 - spacing**2) / (8 * r**2)),
            equation(1 - phi**2, 4 * n_x**2 * n_y**2),
        ),
        rewrite(),
    )


DERIVATION = Derivation(
    number=1,
    name="ordered_positions",
    title="Positions in the ordered packing",
    symbols=(
        (Position(i, j), "centre of bead (i, j), i + j even"),
        (r, "radius of a bead"),
        *usual(n_plus, n_minus),
        (spacing, "horizontal distance of two centres in one layer"),
    ),
    assumptions=(
        "all radii equal r",
        "bead (i, j) touches the beads (i±1, j±1)",
        "i + j is even; the base is j = 0",
        *BEADS.in_words(),
    ),
    printed=(PRINTED,),
    domain=BEADS,
    show_steps=show_steps,
    definitions={D: squared_distance},
)

if __name__ == "__main__":
    from force_diffusion.derivations.commands.cli import run_alone

    raise SystemExit(run_alone(1))
