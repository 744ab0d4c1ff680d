"""Eq. 5: the change of the direction of the contact along n⁻, derived, and as a mirror image."""

# fmt: off
import sympy
from force_diffusion.derivations import eq04_contact_plus as eq04
from force_diffusion.derivations.framework.vocabulary import (
    Derivation, Domain, Steps, Theorem, equation, follows, lattice, minus, mirror, rewrite, terms,
    times, usual)
from force_diffusion.symbolic.symbols import (
    DeltaNMinus, DeltaR, Dot, b_minus, b_plus, i, j, m, n_minus, r)
# fmt: on

BEADS = Domain.of(j >= 0)

NEXT_TO_EACH_OTHER = terms(DeltaR(i - (j - m) - 2, m), minus(DeltaR(i - (j - m), m)))
"""Two beads of layer m, on neighbouring diagonals along n⁺."""
BASE = terms(DeltaR(i - j - 2, 0), minus(DeltaR(i - j, 0)))

PRINTED = equation(
    times(2, r, DeltaNMinus(i, j)),
    terms(
        times(terms(DeltaR(i, j), DeltaR(i - 1, j + 1)), terms(b_plus, b_minus, minus(n_minus))),
        times(b_plus, terms(*BASE.args, times(2, sympy.Sum(NEXT_TO_EACH_OTHER, (m, 1, j))))),
    ),
)


def show_steps(steps: Steps) -> None:
    """The same derivation for the other contact, and the mirror image of Eq. 4."""
    printed = eq04.show_change(
        steps,
        -1,
        PRINTED,
        (
            "As for Eq. 4, from the exact unit vector of the contact along n⁻:",
            "By Eq. 3, the b⁻ component is now the sum of the two δr alone:",
            "The b⁺ component is the difference of two neighbouring diagonals along n⁺.",
        ),
    )
    steps.show(
        "It is also the mirror image of Eq. 4, in which i → −i at every bead, n⁺ ↔ n⁻ and b⁺ ↔ b⁻:",
        lattice.mirror(eq04.PRINTED),
        follows(mirror(eq04.DERIVATION.theorem)),
    )
    steps.show(
        "Again a unit vector changes at right angles to itself:",
        equation(Dot(n_minus, DeltaNMinus(i, j)), 0),
        rewrite(printed.theorem),
    )


def directions() -> tuple[Theorem, ...]:
    """The changes of both contact directions in the radii, by Eqs. 4 and 5."""
    return eq04.DERIVATION.theorem, DERIVATION.theorem


DERIVATION = Derivation(
    number=5,
    name="contact_minus",
    title="Change of the contact direction along n⁻",
    symbols=usual(DeltaNMinus(i, j), DeltaR(i, j), n_minus, b_plus, b_minus, m),
    assumptions=("first order in δr", "fixed base", *BEADS.in_words()),
    printed=(PRINTED,),
    domain=BEADS,
    show_steps=show_steps,
)

if __name__ == "__main__":
    from force_diffusion.derivations.commands.cli import run_alone

    raise SystemExit(run_alone(5))
