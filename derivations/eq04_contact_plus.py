"""Eq. 4: the change of the direction of the contact along n⁺."""

# fmt: off
import sympy
from force_diffusion.derivations import eq03_extrapolation as eq03
from force_diffusion.derivations.framework.vocabulary import (
    Derivation, Domain, Step, Steps, axioms, equation, minus, order, rewrite, terms, times, usual)
from force_diffusion.symbolic.symbols import (
    DeltaNMinus, DeltaNPlus, DeltaR, DeltaX, Dot, b_minus, b_plus, i, j, m, n_minus, n_plus, r)
# fmt: on

BEADS = Domain.of(j >= 0)

NEXT_TO_EACH_OTHER = terms(DeltaR(i + (j - m) + 2, m), minus(DeltaR(i + (j - m), m)))
"""Two beads of layer m, on neighbouring diagonals along n⁻."""
BASE = terms(DeltaR(i + j + 2, 0), minus(DeltaR(i + j, 0)))

PRINTED = equation(
    times(2, r, DeltaNPlus(i, j)),
    terms(
        times(terms(DeltaR(i, j), DeltaR(i + 1, j + 1)), terms(b_plus, b_minus, minus(n_plus))),
        times(b_minus, terms(*BASE.args, times(2, sympy.Sum(NEXT_TO_EACH_OTHER, (m, 1, j))))),
    ),
)


def show_change(steps: Steps, side: int, printed: sympy.Eq, reasons: tuple[str, str, str]) -> Step:
    """Show how a contact turns: along n⁺ for the side 1, along n⁻ for −1.

    The exact unit vector is differentiated, and Eq. 3 put in: 2r δn is the difference of the
    displacements less n times the sum of the two δr.
    """
    change = DeltaNPlus(i, j) if side == 1 else DeltaNMinus(i, j)
    normal, above = n_plus if side == 1 else n_minus, (i + side, j + 1)
    radii, apart = terms(DeltaR(i, j), DeltaR(*above)), (DeltaX(*above), minus(DeltaX(i, j)))
    changed = steps.show(
        reasons[0],
        equation(times(2, r, change), terms(*apart, minus(times(normal, radii)))),
        order(axioms.direction(side), 1),
    )
    displaced = eq03.positions()
    steps.show(reasons[1], equation(Dot(normal, terms(*apart)), radii), rewrite(displaced))
    return steps.show(reasons[2], printed, rewrite(changed.theorem, displaced))


def show_steps(steps: Steps) -> None:
    """Differentiate the exact unit vector, then put in Eq. 3."""
    printed = show_change(
        steps,
        1,
        PRINTED,
        (
            "The centres of touching beads with the radii R and R′ are exactly R + R′ apart, so "
            "the unit vector of the contact is their separation over R + R′. To first order it "
            "changes by",
            "Both beads lie on one diagonal along n⁺, so by Eq. 3 the b⁺ component of the "
            "difference is the sum of their two δr alone:",
            "The b⁻ component is the difference of two neighbouring diagonals along n⁻.",
        ),
    )
    steps.show(
        "A unit vector changes at right angles to itself:",
        equation(Dot(n_plus, DeltaNPlus(i, j)), 0),
        rewrite(printed.theorem),
    )


DERIVATION = Derivation(
    number=4,
    name="contact_plus",
    title="Change of the contact direction along n⁺",
    symbols=usual(DeltaNPlus(i, j), DeltaR(i, j), n_plus, b_plus, b_minus, m),
    assumptions=("first order in δr", "fixed base", *BEADS.in_words()),
    printed=(PRINTED,),
    domain=BEADS,
    show_steps=show_steps,
)

if __name__ == "__main__":
    from force_diffusion.derivations.commands.cli import run_alone

    raise SystemExit(run_alone(4))
