"""Eq. 10: the contribution of a contact force along a path with exactly one branch."""

from collections.abc import Iterator

import sympy

from derivations import eq08_propagation as eq08
from derivations import eq09_straight_path as eq09
from derivations import witnesses
from derivations.record import Claim, Derivation, Step, Witness
from derivations.runner import run_alone
from symbolic.affine import Region
from symbolic.as_printed import equation, minus, terms, times
from symbolic.kernel import Ruling, all_of, decide_identity, decide_linear
from symbolic.lattice import mirror
from symbolic.paths import (
    BRANCH_COUNT,
    BY_BRANCH,
    ENTRY,
    branched_end,
    solve_for_path,
    straight_end,
)
from symbolic.symbols import (
    DeltaNPlus,
    Dot,
    ForceMinus,
    ForcePlus,
    i,
    j,
    k,
    l,
    n,
    n_minus,
    p,
    phi,
    q,
)

PRINTED = equation(
    ForceMinus(i, j) / ForcePlus(*ENTRY),
    minus(
        times(
            1 / (1 - phi**2),
            Dot(n_minus, terms(DeltaNPlus(i - n - 1, j + n - 1), minus(DeltaNPlus(i - n, j + n)))),
        )
    ),
)


def branched_plus(across: sympy.Expr, layer: sympy.Expr, count: sympy.Expr) -> sympy.Expr:
    """f⁺ at a site over the f⁻ that branched ``count`` steps above: Eq. 10's mirror image."""
    return mirror(PRINTED.rhs).xreplace({i: across, j: layer, n: count})


def steps() -> Iterator[Step]:
    """Count the paths with one branch; only the branch itself is of first order."""
    yield Step(
        "A branch is of first order in δn^± (Eq. 8), so that a first-order calculation "
        "needs the paths with no branch or with one. With p straight steps, a branch and "
        "q ≥ 1 steps along n⁻, the contact reached has the lower bead",
        sympy.Tuple(*branched_end()),
    )
    solution = solve_for_path()
    yield Step(
        "This is (i, j) for exactly one pair (p, q): q is the paper's n.",
        sympy.Tuple(equation(p, solution[p]), equation(q, solution[q])),
    )
    yield Step(
        "A path exists when q ≥ 1 and p ≥ 0, and p = (l−j) − n − 1, so when "
        "1 ≤ n < l − j. The branch is at the bead",
        sympy.Tuple(i - n, j + n),
    )
    yield Step(
        "The straight pieces count at order 0, where they are 1 (Eq. 9); the branch is Eq. 8.",
        PRINTED,
    )


def decide(_: int, candidate: sympy.Eq) -> Ruling:
    """Follow the path: the branching bead is where p straight steps have led."""
    bead = tuple(index.xreplace(BY_BRANCH) for index in straight_end(p))
    derived = eq08.branching(*bead)
    return decide_linear(candidate.rhs.xreplace(BY_BRANCH), derived, Region({n: 1, p: 0}))


def _one_path() -> Ruling:
    solution = solve_for_path()
    across, layer = (index.xreplace(solution) for index in branched_end())
    return all_of(
        decide_identity(across, i),
        decide_identity(layer, j),
        decide_identity(solution[q], BRANCH_COUNT),
        decide_identity(solution[p], (l - j) - BRANCH_COUNT - 1),
    )


def _branching_bead() -> Ruling:
    solution = solve_for_path()
    across, layer = (index.xreplace(solution) for index in straight_end(p))
    return all_of(
        decide_identity(across, i - BRANCH_COUNT), decide_identity(layer, j + BRANCH_COUNT)
    )


def _balance_everywhere() -> Ruling:
    """Claimed responses, at order 0 and 1, against Eq. 8 and its mirror image, bead by bead.

    On the straight path (q = 0) the incoming f⁺ is 1 + A and no f⁻ comes in, so that f⁺ leaves
    as Eq. 9 and f⁻ as Eq. 10 with n = 1. Beside it (n ≥ 1) only f⁻, of first order, comes in:
    it passes unchanged, and leaves no f⁺ of first order.
    """
    on_path = straight_end(p)
    leaving = {k: BY_BRANCH[k], l: BY_BRANCH[l]}
    below = (on_path[0] + 1, on_path[1] - 1)
    branch = decide_linear(
        PRINTED.rhs.xreplace({i: below[0], j: below[1], n: sympy.Integer(1)}),
        eq08.branching(*on_path),
        Region({p: 0}),
    )
    further = decide_linear(
        PRINTED.rhs.xreplace({i: i + 1, j: j - 1, n: n + 1}).xreplace(leaving),
        PRINTED.rhs.xreplace(leaving),
        Region({n: 1, p: 0}),
    )
    onward = decide_linear(
        eq09.after(eq09.PRINTED.rhs, p + 1),
        eq09.first_order_product(eq09.after(eq09.PRINTED.rhs, p), eq08.straight(*on_path)),
        Region({p: 0}),
    )
    return all_of(branch, further, onward)


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
    assumptions=("first order in δn^±", "n is whole and 1 ≤ n < l − j; zero otherwise"),
    premises=(eq08.DERIVATION, eq09.DERIVATION),
    printed=(PRINTED,),
    steps=steps,
    decide=decide,
    claims=(
        Claim("exactly one (p, q) leads to (i, j): q = n and p = (l−j) − n − 1 ≥ 0", _one_path),
        Claim("its branching bead is (i − n, j + n)", _branching_bead),
        Claim(
            "Eqs. 9 and 10, and zero elsewhere, balance every bead to first order",
            _balance_everywhere,
        ),
    ),
    witnesses=(
        Witness(
            "Taylor coefficients of the exact packing equal it as fractions, zero outside",
            lambda packing: witnesses.branched_path(PRINTED.rhs, packing),
        ),
    ),
)

if __name__ == "__main__":
    raise SystemExit(run_alone(DERIVATION))
