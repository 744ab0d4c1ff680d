"""Eq. 10: the contribution of a contact force along a path with exactly one branch."""

from functools import cache

import sympy
from force_diffusion.derivations import eq08_propagation as eq08
from force_diffusion.derivations import eq09_straight_path as eq09
from force_diffusion.derivations.framework.proving import Line
from force_diffusion.derivations.framework.vocabulary import (
    SUPPOSED,
    By,
    Claim,
    Derivation,
    Lines,
    Part,
    Where,
    axioms,
    below,
    equation,
    in_cases,
    in_terms_of,
    induct,
    minus,
    rewrite,
    terms,
    times,
    walk,
)
from force_diffusion.symbolic.kernel.decisions import Ruling
from force_diffusion.symbolic.kernel.where import ENTERING, PASSING
from force_diffusion.symbolic.mechanics.lattice import mirror
from force_diffusion.symbolic.mechanics.paths import (
    BRANCH_COUNT,
    ENTRY,
    branched_end,
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

WHERE = Where.of(n >= 1, n < l - j, sympy.Eq(2 * n, 2 * BRANCH_COUNT), j >= 0, loading=ENTERING)

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


def beside(places: sympy.Expr) -> tuple[sympy.Expr, sympy.Expr]:
    """The lower bead ``places`` to the right of the straight path, q layers below the entry."""
    return eq09.left_of(-places)


BY_BRANCH = {i: beside(n)[0], j: beside(n)[1]}
"""The contact that is reached n steps below the branch, q layers below the entry."""

IN_CONE = eq09.PATH.also(n >= 1, n <= q, indices=(n,))

FAMILY = (
    (equation(*(side.xreplace(eq09.BY_BEADS) for side in eq09.PRINTED.args)), eq09.PATH),
    *(
        (equation(force(*beside(p)), 0), eq09.PATH.also(one, indices=(p,)))
        for force, one in (
            (ForcePlus, p <= -1),
            (ForcePlus, p >= 1),
            (ForceMinus, p <= 0),
            (ForceMinus, p >= q + 1),
        )
    ),
)
"""All other forces that the entering one makes: those of Eq. 9 on the path, none beside."""


def by_layers(family: tuple[tuple[sympy.Eq, Where], ...]) -> By:
    """From layer to layer down, by the balance of each bead."""
    loads = axioms.loads(ENTERING)
    step = in_cases(
        (n, ((sympy.Eq(n, 1),), (n >= 2,))),
        (
            p,
            (
                (p <= -1,),
                (sympy.Eq(p, 0),),
                (p >= 1, p <= q - 1),
                (p >= 1, sympy.Eq(p, q)),
                (p >= q + 1,),
            ),
        ),
        by=below(axioms.balance(), (SUPPOSED, loads)),
    )
    return induct(q, 0, rewrite(loads), step, family=family)


@cache
def steps() -> Lines:
    """Count the paths with one branch; only the branch itself is of first order."""
    lines = Lines(WHERE)
    ends = lines.show(
        "A branch is of first order in δn^± (Eq. 8), so that a first-order calculation "
        "needs the paths with no branch or with one. With p straight steps, a branch and "
        "q ≥ 1 steps along n⁻, the contact reached has the lower bead",
        sympy.Tuple(*map(equation, (i, j), branched_end())),
        walk(
            dict(zip((i, j), straight_end(p), strict=True)),
            {i: i + 1, j: j - 1},
            q,
            eq08.DERIVATION,
            eq09.DERIVATION,
        ),
        where=Where.of(p >= 0, q >= 0, indices=(i, k)),
    )
    on_path = [
        *map(sympy.Eq, (i, j), branched_end()),
        *map(sympy.Eq, (site_r, site_s), straight_end(p)),
        sympy.Eq(2 * n, 2 * BRANCH_COUNT),
    ]
    counted = lines.show(
        "This is (i, j) for exactly one pair (p, q): q is the paper's n, and a path exists when "
        "q ≥ 1 and p ≥ 0, so when 1 ≤ n < l − j.",
        sympy.Tuple(
            equation(p, terms(times(sympy.Rational(1, 2), terms(l - j, k - i)), -1)),
            equation(q, times(sympy.Rational(1, 2), terms(l - j, minus(k - i)))),
            equation(p, terms(l - j, minus(n), -1)),
        ),
        rewrite(),
        where=Where.of(*on_path),
        after=(ends,),
    )
    branch = lines.show(
        "The branch is at the bead",
        sympy.Tuple(equation(site_r, i - n), equation(site_s, j + n)),
        rewrite(),
        where=Where.of(*on_path),
        after=(counted,),
    )
    leaving = lines.show(
        "There the force along n⁻ that leaves is, by Eq. 8,",
        equation(
            ForceMinus(i - n + 1, j + n - 1) / ForcePlus(i - n, j + n), eq08.branching(i - n, j + n)
        ),
        rewrite(Part(eq08.DERIVATION, 1)),
        where=Where.of(n >= 1, j >= 0, loading=PASSING.put_in({site_r: i - n, site_s: j + n})),
        after=(branch,),
    )
    lines.show(
        "The straight pieces count at order 0, where they are 1 (Eq. 9).",
        PRINTED,
        in_terms_of(BY_BRANCH, {q: l - 1 - j}, IN_CONE, by_layers(FAMILY)),
        after=(eq09.DERIVATION, leaving),
    )
    return lines


def balance_everywhere() -> Ruling:
    """All forces that one entering contact force makes: Eqs. 9 and 10, and none elsewhere."""
    inside = equation(*(side.xreplace(BY_BRANCH) for side in PRINTED.args))
    (first, domain), *others = FAMILY
    return Line("", first, by_layers((*others, (inside, IN_CONE))), domain).ruling


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
    assumptions=("first order in δn^±", "n is whole", *WHERE.in_words()),
    premises=(eq08.DERIVATION, eq09.DERIVATION),
    printed=(PRINTED,),
    loads=("single",),
    steps=steps,
    where=WHERE,
    claims=(
        Claim(
            "Eqs. 9 and 10, and zero elsewhere, balance every bead to first order",
            balance_everywhere,
        ),
    ),
)

if __name__ == "__main__":
    from force_diffusion.derivations.commands.alone import run_alone

    raise SystemExit(run_alone(DERIVATION))
