"""Eq. 9: the contribution of a contact force to a contact straight below it."""

from functools import cache

import sympy
from force_diffusion.derivations import eq08_propagation as eq08
from force_diffusion.derivations.framework.vocabulary import (
    SUPPOSED,
    Derivation,
    Lines,
    Part,
    Where,
    axioms,
    below,
    equation,
    in_terms_of,
    induct,
    minus,
    rewrite,
    terms,
    times,
    walk,
)
from force_diffusion.symbolic.kernel.where import ENTERING, PASSING
from force_diffusion.symbolic.mechanics.paths import ENTRY, straight_end
from force_diffusion.symbolic.symbols import (
    DeltaNPlus,
    Dot,
    ForceMinus,
    ForcePlus,
    epsilon,
    i,
    j,
    k,
    l,
    n_minus,
    p,
    phi,
    q,
)

WHERE = Where.of(sympy.Eq(k - i, l - j), l - j >= 1, j >= 0, loading=ENTERING)

PRINTED = equation(
    ForcePlus(i, j) / ForcePlus(*ENTRY),
    terms(
        1,
        times(phi / (1 - phi**2), Dot(n_minus, terms(DeltaNPlus(i, j), minus(DeltaNPlus(*ENTRY))))),
    ),
)


def first_order_product(left: sympy.Expr, right: sympy.Expr) -> sympy.Expr:
    """(1 + A)(1 + B) to first order, 1 + A and 1 + B given: one plus both changes."""
    return terms(left, right, -1)


def after(candidate: sympy.Expr, steps_down: sympy.Expr) -> sympy.Expr:
    """The ratio at the contact that lies ``steps_down`` straight below the entry."""
    across, layer = straight_end(steps_down)
    return candidate.xreplace({i: across, j: layer})


FIRST, SECOND = sympy.symbols("A B")

BY_BEADS = dict(zip((i, j), straight_end(q), strict=True))
"""The contact reached after q beads."""

PATH = Where.of(q >= 0, q <= l - 1, loading=ENTERING)
"""Numbers q of beads passed, down to the base."""


def left_of(beads: sympy.Expr) -> tuple[sympy.Expr, sympy.Expr]:
    """The bead ``beads`` places to the left of the path, in the layer that q beads lead to."""
    across, layer = straight_end(q)
    return across - 2 * beads, layer


NOTHING_BESIDE = (
    (equation(ForceMinus(*left_of(p)), 0), PATH.also(p >= 0, indices=(p,))),
    (equation(ForcePlus(*left_of(p)), 0), PATH.also(p >= 1, indices=(p,))),
)
"""No force to the left of the path, nor along n⁻ on it: what is proved together with Eq. 9."""


@cache
def steps() -> Lines:
    """Induction on the number q of beads passed."""
    lines = Lines(WHERE)
    here = dict(zip(eq08.HERE, straight_end(q), strict=True))
    reached = lines.show(
        "After q beads the contact reached has the lower bead (k−1−q, l−1−q).",
        sympy.Tuple(*map(equation, (i, j), straight_end(q))),
        walk(
            dict(zip((i, j), ENTRY, strict=True)),
            {i: i - 1, j: j - 1},
            q,
            eq08.DERIVATION,
        ),
        where=Where.of(q >= 0, indices=(i, k)),
    )
    next_bead = lines.show(
        "The next bead multiplies by Eq. 8.",
        equation(
            ForcePlus(*straight_end(q + 1)) / ForcePlus(*straight_end(q)),
            eq08.straight(*straight_end(q)),
        ),
        rewrite(Part(eq08.DERIVATION, 0)),
        where=Where.of(q >= 0, q <= l - 2, loading=PASSING.put_in(here)),
        after=(reached,),
    )
    product = lines.show(
        "To first order the changes in a product add up.",
        equation(
            times(terms(1, epsilon * FIRST), terms(1, epsilon * SECOND)),
            terms(1, times(epsilon, terms(FIRST, SECOND)), epsilon**2 * FIRST * SECOND),
        ),
        rewrite(),
        where=Where(),
    )
    cancelled = lines.show(
        "The direction in between cancels: the printed ratio at q times Eq. 8 is that at q + 1.",
        equation(
            first_order_product(after(PRINTED.rhs, q), eq08.straight(*straight_end(q))),
            after(PRINTED.rhs, q + 1),
        ),
        rewrite(),
        where=Where.of(q >= 0, q <= l - 2, indices=(k,)),
        after=(next_bead, product),
    )
    loads = axioms.loads(ENTERING)
    lines.show(
        "At the entry itself, q = 0, the printed ratio is 1: no bead has been passed. So for every "
        "q the ends are left.",
        PRINTED,
        in_terms_of(
            BY_BEADS,
            {q: l - 1 - j},
            PATH,
            induct(
                q,
                0,
                rewrite(loads),
                below(axioms.balance(), (SUPPOSED, loads)),
                family=NOTHING_BESIDE,
            ),
        ),
        after=(cancelled,),
    )
    return lines


DERIVATION = Derivation(
    number=9,
    name="straight_path",
    title="Straight path without a branch",
    symbols=(
        (ForcePlus(*ENTRY), "force entering below the loaded bead (k, l) along n⁺"),
        (ForcePlus(i, j), "force of a contact straight below it, k − i = l − j"),
        (DeltaNPlus(i, j), "change of the direction from (i, j) to (i+1, j+1)"),
        (n_minus, "direction of the ordered contacts, up and to the left"),
        (phi, "n⁺·n⁻"),
        (q, "number of beads passed"),
    ),
    assumptions=("first order in δn^±", *WHERE.in_words()),
    premises=(eq08.DERIVATION,),
    printed=(PRINTED,),
    loads=("single",),
    steps=steps,
    where=WHERE,
)

if __name__ == "__main__":
    from force_diffusion.derivations.commands.alone import run_alone

    raise SystemExit(run_alone(DERIVATION))
