"""Eq. 10: the contribution of a contact force along a path with exactly one branch."""

# fmt: off
import sympy
from force_diffusion.derivations import eq08_propagation as eq08
from force_diffusion.derivations import eq09_straight_path as eq09
from force_diffusion.derivations.framework.vocabulary import (
    Derivation, Domain, Steps, axioms, equation, lattice, minus, rewrite, terms, times)
from force_diffusion.symbolic.symbols import (
    DeltaNPlus, Dot, ForceMinus, ForcePlus, i, j, k, l, n, n_minus, p, phi, q)
from sympy import Eq
# fmt: on

ENTRY, BELOW = eq09.ENTRY, eq09.BELOW
BRANCHED = Domain.of(
    n >= 1, n < l - j, Eq(2 * n, (l - j) - (k - i)), j >= 0, loading=axioms.ENTERING
)

TURN = Dot(n_minus, terms(DeltaNPlus(i - n - 1, j + n - 1), minus(DeltaNPlus(i - n, j + n))))
PRINTED = equation(ForceMinus(i, j) / ForcePlus(*ENTRY), minus(times(1 / (1 - phi**2), TURN)))

NOTHING_BESIDE = tuple(
    (equation(force(i, j), sympy.S.Zero), BELOW.also(where))
    for force, where in (
        (ForcePlus, k - i >= l - j + 1),
        (ForcePlus, k - i <= l - j - 1),
        (ForceMinus, k - i >= l - j),
        (ForceMinus, k - i <= -(l - j) + 1),
    )
)
"""No other force than those of Eqs. 9 and 10."""


def branched_plus(across: sympy.Expr, layer: sympy.Expr, count: sympy.Expr) -> sympy.Expr:
    """f⁺ at a site over the f⁻ that branched ``count`` steps above: the mirror image."""
    return lattice.mirror(PRINTED.rhs).xreplace({i: across, j: layer, n: count})


def show_steps(steps: Steps) -> None:
    """Count the paths with one branch; only the branch itself is of first order."""
    on_path = Domain.of(Eq(i, k - 1 - p + q), Eq(j, l - 1 - p - q), p >= 0, q >= 1, j >= 0)
    steps.show(
        "A branch is of first order in δn^± (Eq. 8), so that a first-order calculation needs the "
        "paths with no branch or with one. With p straight steps, a branch and q ≥ 1 steps along "
        "n⁻, the contact reached has the lower bead (k−1−p+q, l−1−p−q). This is (i, j) for exactly "
        "one pair (p, q):",
        sympy.Tuple(
            equation(q, times(sympy.Rational(1, 2), terms(l - j, minus(k - i)))),
            equation(p, terms(l - j, minus(q), -1)),
        ),
        rewrite(),
        on_path,
    )
    steps.show(
        "q is the paper's n, and a path exists when q ≥ 1 and p ≥ 0, so when 1 ≤ n < l − j. The "
        "branch is at the bead (i−n, j+n), p steps below the entry:",
        sympy.Tuple(equation(k - 1 - p, i - q), equation(l - 1 - p, j + q)),
        rewrite(),
        on_path,
    )
    bead = (i - n, j + n)
    steps.show(
        "By Eq. 8, the force that leaves this bead along n⁻ is",
        equation(ForceMinus(i - n + 1, j + n - 1) / ForcePlus(*bead), eq08.branching(*bead)),
        rewrite(eq08.DERIVATION.theorems[1]),
        Domain.of(n >= 1, j >= 0, loading=axioms.PASSING.put_in(eq08.at_bead(*bead))),
    )
    steps.show(
        "The straight pieces count at order 0, where they are 1 (Eq. 9). By induction, layer after "
        "layer down, every bead is balanced by these forces and no others.",
        PRINTED,
        eq09.from_the_entry_down((eq09.PRINTED, eq09.STRAIGHT), *NOTHING_BESIDE),
    )


DERIVATION = Derivation(
    number=10,
    name="branched_path",
    title="Path with exactly one branch",
    symbols=(
        (ForcePlus(*ENTRY), "force entering below the loaded bead (k, l) along n⁺"),
        (ForceMinus(i, j), "force of a contact of the other orientation"),
        (n, "steps from the branch down to (i, j): n = ½[(l − j) − (k − i)]"),
        (p, "straight steps before the branch"),
    ),
    assumptions=("first order in δn^±", "n is whole", *BRANCHED.in_words()),
    printed=(PRINTED,),
    domain=BRANCHED,
    show_steps=show_steps,
)

if __name__ == "__main__":
    from force_diffusion.derivations.commands.cli import run_alone

    raise SystemExit(run_alone(10))
