"""Eq. 10: the contribution of a contact force along a path with exactly one branch."""

from collections.abc import Iterator
from functools import cache

import sympy
from force_diffusion.derivations import eq08_propagation as eq08
from force_diffusion.derivations import eq09_straight_path as eq09
from force_diffusion.derivations.framework.follows import at, identity, states, walks
from force_diffusion.derivations.framework.record import Claim, Derivation, Step, Witness
from force_diffusion.derivations.witnesses import squared_weights as witnesses
from force_diffusion.derivations.witnesses.both_sides import about, compare, inside_cone, search
from force_diffusion.symbolic.algebra.affine import Region
from force_diffusion.symbolic.as_printed import equation, minus, terms, times
from force_diffusion.symbolic.kernel.decisions import Ruling, all_of, decide_linear
from force_diffusion.symbolic.mechanics.lattice import mirror
from force_diffusion.symbolic.mechanics.paths import (
    BRANCH_COUNT,
    BY_BRANCH,
    ENTRY,
    branched_end,
    solve_for_path,
    straight_end,
)
from force_diffusion.symbolic.symbols import (
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
    site_r,
    site_s,
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


@cache
def _on_path() -> dict[sympy.Symbol, sympy.Expr]:
    """(p, q) by (i, j), SymPy solving, and the branching bead that they lead to."""
    solution = solve_for_path()
    bead = (index.xreplace(solution) for index in straight_end(p))
    return {**solution, n: BRANCH_COUNT, **dict(zip(eq08.HERE, bead, strict=True))}


def steps() -> Iterator[Step]:
    """Count the paths with one branch; only the branch itself is of first order."""
    yield Step(
        "A branch is of first order in δn^± (Eq. 8), so that a first-order calculation "
        "needs the paths with no branch or with one. With p straight steps, a branch and "
        "q ≥ 1 steps along n⁻, the contact reached has the lower bead",
        sympy.Tuple(*map(equation, (i, j), branched_end())),
        walks(straight_end(p), dict(zip(eq08.HERE, eq08.RIGHT, strict=True)), q),
        ("Eq. 8", "Eq. 9"),
    )
    yield Step(
        "This is (i, j) for exactly one pair (p, q): q is the paper's n, and a path exists when "
        "q ≥ 1 and p ≥ 0, so when 1 ≤ n < l − j.",
        sympy.Tuple(
            equation(p, terms(times(sympy.Rational(1, 2), terms(l - j, k - i)), -1)),
            equation(q, times(sympy.Rational(1, 2), terms(l - j, minus(k - i)))),
            equation(p, terms(l - j, minus(n), -1)),
        ),
        identity(_on_path()),
        ("step 1",),
    )
    yield Step(
        "The branch is at the bead",
        sympy.Tuple(equation(site_r, i - n), equation(site_s, j + n)),
        identity(_on_path()),
        ("step 2",),
    )
    yield Step(
        "There the force along n⁻ that leaves is, by Eq. 8,",
        equation(
            ForceMinus(i - n + 1, j + n - 1) / ForcePlus(i - n, j + n), eq08.branching(i - n, j + n)
        ),
        states(at(eq08.PRINTED[1], {site_r: i - n, site_s: j + n})),
        ("Eq. 8", "step 3"),
    )
    yield Step(
        "The straight pieces count at order 0, where they are 1 (Eq. 9).",
        PRINTED,
        decide,
        ("Eq. 9", "step 4"),
    )


def decide(_: int, candidate: sympy.Eq) -> Ruling:
    """Follow the path: the branching bead is where p straight steps have led."""
    if other := about(candidate, ForceMinus(i, j) / ForcePlus(*ENTRY), "single", inside_cone):
        return other
    bead = tuple(index.xreplace(BY_BRANCH) for index in straight_end(p))
    derived = eq08.branching(*bead)
    return decide_linear(candidate.rhs.xreplace(BY_BRANCH), derived, Region({n: 1, p: 0}))


def _response(
    branches: int, straight: sympy.Expr, turned: sympy.Expr
) -> tuple[tuple[sympy.Expr, sympy.Expr], tuple[sympy.Expr, sympy.Expr]]:
    """Claimed ((order 0, order 1) of f⁺, the same of f⁻) over the entering force.

    The contacts are those whose lower bead is reached by ``straight`` steps along n⁺ and
    ``turned`` steps along n⁻; ``branches`` says whether ``turned`` is zero (0) or at least one
    (1). On the straight path f⁺ is Eq. 9 and there is no f⁻; beside it f⁻ is Eq. 10 and f⁺ zero.
    """
    zero, one = sympy.Integer(0), sympy.Integer(1)
    if branches == 0:
        return (one, eq09.after(eq09.PRINTED.rhs, straight) - 1), (zero, zero)
    across, layer = (index.xreplace({p: straight, q: turned}) for index in branched_end())
    return (zero, zero), (zero, PRINTED.rhs.xreplace({i: across, j: layer, n: turned}))


def _leaving(
    entering: tuple[tuple[sympy.Expr, sympy.Expr], tuple[sympy.Expr, sympy.Expr]],
    bead: tuple[sympy.Expr, sympy.Expr],
) -> tuple[tuple[sympy.Expr, sympy.Expr], tuple[sympy.Expr, sympy.Expr]]:
    """Send forces through a bead by Eq. 8 and its mirror image, order by order."""
    (plus_0, plus_1), (minus_0, minus_1) = entering
    at = {site_r: bead[0], site_s: bead[1]}
    straight, branch = eq08.straight(*bead) - 1, eq08.branching(*bead)
    mirrored, turned_back = (mirror(part.rhs).xreplace(at) for part in eq08.PRINTED)
    return (
        (plus_0, plus_1 + plus_0 * straight + minus_0 * turned_back),
        (minus_0, minus_1 + minus_0 * (mirrored - 1) + plus_0 * branch),
    )


def balance_everywhere() -> Ruling:
    """Eqs. 9 and 10, and zero elsewhere, pass through every bead by Eq. 8, to first order.

    A bead that (p, q) steps lead to receives the two contacts that are named by it; what leaves
    along n⁺ is named by (p + 1, q), what leaves along n⁻ by (p, q + 1). All other beads receive
    nothing. p and q are symbols: beads on the straight path (q = 0), and beside it (q ≥ 1).
    """
    zero = sympy.Integer(0)
    rulings = []
    for branches, turned in ((0, zero), (1, q)):
        bead = tuple(index.xreplace({q: turned}) for index in branched_end())
        plus, minus = _leaving(_response(branches, p, turned), (bead[0], bead[1]))
        claimed_plus = _response(branches, p + 1, turned)[0]
        claimed_minus = _response(1, p, turned + 1)[1]
        region = Region({p: 0, q: 1})
        for left, right in ((plus, claimed_plus), (minus, claimed_minus)):
            rulings += [
                decide_linear(one, other, region) for one, other in zip(left, right, strict=True)
            ]
    return all_of(*rulings)


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
    loads=("single",),
    steps=steps,
    decide=decide,
    search=search("single", inside_cone),
    claims=(
        Claim(
            "Eqs. 9 and 10, and zero elsewhere, balance every bead to first order",
            balance_everywhere,
        ),
    ),
    witnesses=(
        Witness(
            "an exact packing obeys it, both sides at orders ε⁰ and ε¹",
            lambda packing: compare(PRINTED, packing, "single", inside_cone),
        ),
        Witness("no force of first order left of the cone", witnesses.zero_outside),
    ),
)

if __name__ == "__main__":
    from force_diffusion.derivations.commands.alone import run_alone

    raise SystemExit(run_alone(DERIVATION))
