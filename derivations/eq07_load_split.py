"""Eq. 7: how a vertical load splits between the two supports."""

from functools import cache

import sympy
from force_diffusion.derivations import eq06_force_balance as eq06
from force_diffusion.derivations.framework.vocabulary import (
    Derivation,
    Lines,
    Part,
    Where,
    axioms,
    equation,
    minus,
    mirror_of,
    solve,
    terms,
    times,
)
from force_diffusion.symbolic.kernel.where import LOADED_VERTICALLY
from force_diffusion.symbolic.mechanics import balance
from force_diffusion.symbolic.mechanics.lattice import mirror
from force_diffusion.symbolic.symbols import (
    DeltaNMinus,
    DeltaNPlus,
    Dot,
    ForceMinus,
    ForcePlus,
    f_load,
    k,
    l,
    n_minus,
    n_plus,
    n_y,
    phi,
)

WHERE = Where.of(l >= 1, loading=LOADED_VERTICALLY)
LEFT, RIGHT = eq06.LEFT, eq06.RIGHT
TILT_PLUS = Dot(n_minus, DeltaNPlus(*LEFT))
TILT_MINUS = Dot(n_plus, DeltaNMinus(*RIGHT))
ORDERED = f_load / (2 * n_y)

PRINTED = (
    equation(
        ForcePlus(*LEFT),
        times(
            ORDERED,
            terms(1, times(1 / (1 - phi**2), terms(times(phi, TILT_PLUS), minus(TILT_MINUS)))),
        ),
    ),
    equation(
        ForceMinus(*RIGHT),
        times(
            ORDERED,
            terms(1, times(1 / (1 - phi**2), terms(times(phi, TILT_MINUS), minus(TILT_PLUS)))),
        ),
    ),
)


def split_plus(across: sympy.Expr, layer: sympy.Expr) -> sympy.Expr:
    """f⁺ below a loaded bead over f_load/2n_y, to first order (Eq. 7)."""
    return PRINTED[0].rhs.args[1].xreplace({k: across, l: layer})


FORCES = (ForcePlus(*LEFT), ForceMinus(*RIGHT))


@cache
def solved() -> balance.Solved:
    """Eq. 6 solved for a load that points straight down, in units of f_load/2n_y."""
    return eq06.solved(terms(n_plus, n_minus), k, l)


@cache
def steps() -> Lines:
    """Dot the balance with n⁺ and n⁻, invert, and expand in the strength ε."""
    lines = Lines(WHERE)
    loads = axioms.loads(LOADED_VERTICALLY)
    expanded = eq06.solving(
        lines,
        solved(),
        "A vertical load is −(f_load/2n_y)(n⁺ + n⁻). Dotted with n⁺ and n⁻, Eq. 6 is a "
        "2×2 system for the two forces in units of f_load/2n_y; ν⁺ = n⁻·δn⁺ and "
        "ν⁻ = n⁺·δn⁻ are all that δn^± holds, by Eqs. 4 and 5.",
        eq06.DERIVATION,
        dict(zip(balance.FORCES, (one / ORDERED for one in FORCES), strict=True)),
        loads,
    )
    printed = lines.show(
        "In the paper's symbols:",
        sympy.Tuple(*PRINTED),
        solve(eq06.DERIVATION, FORCES, loads),
        after=(expanded,),
    )
    lines.claim(
        "the second part is the mirror image of the first",
        equation(mirror(PRINTED[0].lhs), mirror(PRINTED[0].rhs)),
        mirror_of(Part(printed, 0)),
    )
    return lines


DERIVATION = Derivation(
    number=7,
    name="load_split",
    title="Split of a load between the two supports",
    symbols=(
        (f_load, "magnitude of the vertical load on bead (k, l)"),
        (phi, "n⁺·n⁻, between −½ and ½"),
        (ForcePlus(*LEFT), "force of the contact from (k−1, l−1)"),
        (ForceMinus(*RIGHT), "force of the contact from (k+1, l−1)"),
    ),
    assumptions=("first order in δn^±", *WHERE.in_words()),
    premises=(eq06.DERIVATION,),
    printed=PRINTED,
    loads=("single",),
    steps=steps,
    where=WHERE,
)

if __name__ == "__main__":
    from force_diffusion.derivations.commands.alone import run_alone

    raise SystemExit(run_alone(DERIVATION))
