"""Eq. 9: the contribution of a contact force to a contact straight below it."""

# fmt: off
import sympy
from force_diffusion.derivations import eq07_load_split as eq07
from force_diffusion.derivations import eq08_propagation as eq08
from force_diffusion.derivations.framework.vocabulary import (
    Derivation, Domain, Rule, Steps, Theorem, axioms, equation, minus, rewrite, terms, times, usual)
from force_diffusion.symbolic.symbols import (
    DeltaNPlus, Dot, ForceMinus, ForcePlus, epsilon, i, j, k, l, n_minus, phi)
from sympy import Eq
# fmt: on

ENTRY = (k - 1, l - 1)
"""The lower bead of the contact through which the force enters."""
BELOW = Domain.of(j >= 0, j <= l - 1, indices=(i,), loading=axioms.ENTERING)
STRAIGHT = Domain.of(Eq(k - i, l - j), l - j >= 1, j >= 0, loading=axioms.ENTERING)

TURN = Dot(n_minus, terms(DeltaNPlus(i, j), minus(DeltaNPlus(*ENTRY))))
PRINTED = equation(ForcePlus(i, j) / ForcePlus(*ENTRY), terms(1, times(phi / (1 - phi**2), TURN)))

NOTHING_TO_THE_LEFT = (
    (equation(ForceMinus(i, j), sympy.S.Zero), BELOW.also(k - i >= l - j)),
    (equation(ForcePlus(i, j), sympy.S.Zero), BELOW.also(k - i >= l - j + 1)),
)
"""No force to the left of the path, nor along n⁻ on it: what is proved together with Eq. 9."""


def first_order_product(left: sympy.Expr, right: sympy.Expr) -> sympy.Expr:
    """(1 + A)(1 + B) to first order, 1 + A and 1 + B given: one plus both changes."""
    return terms(left, right, -1)


FIRST, SECOND = sympy.symbols("A B")


def from_the_entry_down(*others: tuple[sympy.Eq, Domain]) -> Rule:
    """The rule for a force below the entry, proved together with what is said of ``others``."""

    def rule(formula: sympy.Eq, domain: Domain) -> Theorem:
        loads = axioms.loads(axioms.ENTERING)
        statements = [(formula, domain), *others]
        return eq07.carried_down(l - 1, loads, statements, rewrite(loads))[0]

    return rule


def show_steps(steps: Steps) -> None:
    """Induction on the layer, downwards."""
    above = (i + 1, j + 1)
    steps.show(
        "Each bead that the force passes multiplies it by the factor of Eq. 8:",
        equation(ForcePlus(i, j) / ForcePlus(*above), eq08.straight(*above)),
        rewrite(eq08.DERIVATION.theorems[0]),
        Domain.of(j >= 0, loading=axioms.PASSING.put_in(eq08.at_bead(*above))),
    )
    steps.show(
        "To first order the changes in a product add up:",
        equation(
            times(terms(1, epsilon * FIRST), terms(1, epsilon * SECOND)),
            terms(1, times(epsilon, terms(FIRST, SECOND)), epsilon**2 * FIRST * SECOND),
        ),
        rewrite(),
        Domain(),
    )
    steps.show(
        "So the printed ratio at the contact above, times that factor, is the printed ratio at the "
        "contact below, as the direction in between cancels:",
        equation(
            first_order_product(PRINTED.rhs.xreplace({i: i + 1, j: j + 1}), eq08.straight(*above)),
            PRINTED.rhs,
        ),
        rewrite(),
        Domain.of(Eq(k - i, l - j), l - j >= 2, j >= 0),
    )
    steps.show(
        "At the entry, where no bead has been passed, the printed ratio is 1. By induction, layer "
        "after layer down, only the two ends are left.",
        PRINTED,
        from_the_entry_down(*NOTHING_TO_THE_LEFT),
    )


DERIVATION = Derivation(
    number=9,
    name="straight_path",
    title="Straight path without a branch",
    symbols=(
        (ForcePlus(*ENTRY), "force entering below the loaded bead (k, l) along n⁺"),
        (ForcePlus(i, j), "force of a contact straight below it, k − i = l − j"),
        *usual(DeltaNPlus(i, j), n_minus, phi),
    ),
    assumptions=("first order in δn^±", *STRAIGHT.in_words()),
    printed=(PRINTED,),
    domain=STRAIGHT,
    show_steps=show_steps,
)

if __name__ == "__main__":
    from force_diffusion.derivations.commands.cli import run_alone

    raise SystemExit(run_alone(9))
