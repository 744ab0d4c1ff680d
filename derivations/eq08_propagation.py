"""Eq. 8: how a contact force passes through one bead."""

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
from force_diffusion.symbolic.kernel.where import PASSING
from force_diffusion.symbolic.mechanics import balance
from force_diffusion.symbolic.mechanics.lattice import mirror
from force_diffusion.symbolic.symbols import (
    DeltaNMinus,
    DeltaNPlus,
    Dot,
    ForceMinus,
    ForcePlus,
    n_minus,
    n_plus,
    phi,
    site_r,
    site_s,
)

WHERE = Where.of(site_s >= 1, loading=PASSING)
HERE = (site_r, site_s)
LEFT, RIGHT = (site_r - 1, site_s - 1), (site_r + 1, site_s - 1)
TURN = Dot(n_minus, terms(DeltaNPlus(*LEFT), minus(DeltaNPlus(*HERE))))

PRINTED = (
    equation(ForcePlus(*LEFT) / ForcePlus(*HERE), terms(1, times(phi / (1 - phi**2), TURN))),
    equation(ForceMinus(*RIGHT) / ForcePlus(*HERE), minus(times(1 / (1 - phi**2), TURN))),
)


def straight(across: sympy.Expr, layer: sympy.Expr) -> sympy.Expr:
    """f⁺ leaving over f⁺ entering a bead (Eq. 8, first part)."""
    return PRINTED[0].rhs.xreplace({site_r: across, site_s: layer})


def branching(across: sympy.Expr, layer: sympy.Expr) -> sympy.Expr:
    """f⁻ leaving over f⁺ entering a bead (Eq. 8, second part)."""
    return PRINTED[1].rhs.xreplace({site_r: across, site_s: layer})


@cache
def solved(entering: str) -> balance.Solved:
    """Eq. 6 solved for an incoming unit force along n⁺ ("+") or n⁻ ("-")."""
    along = n_plus + DeltaNPlus(*HERE) if entering == "+" else n_minus + DeltaNMinus(*HERE)
    return eq06.solved(along, site_r, site_s)


FORCES = (ForcePlus(*LEFT), ForceMinus(*RIGHT))


@cache
def steps() -> Lines:
    """The same 2×2 system with an incoming contact force in place of the load."""
    lines = Lines(WHERE)
    loads = axioms.loads(PASSING)
    expanded = eq06.solving(
        lines,
        solved("+"),
        "Eq. 6 holds with the load replaced by the incoming force −f⁺_rs (n⁺ + δn⁺_rs). "
        "Dotted with n⁺ and n⁻, in units of f⁺_rs:",
        axioms.balance(),
        dict(zip(balance.FORCES, (one / ForcePlus(*HERE) for one in FORCES), strict=True)),
        loads,
        after=(eq06.DERIVATION,),
    )
    printed = lines.show(
        "The direction of the other support drops out, since nothing leaves along it at order 0.",
        sympy.Tuple(*PRINTED),
        solve(axioms.balance(), FORCES, loads),
        after=(expanded,),
    )
    lines.show(
        "For an incoming force along n⁻ the same system, solved in the same way, gives the mirror "
        "images.",
        sympy.Tuple(*map(mirror, PRINTED)),
        (mirror_of(Part(printed, 0)), mirror_of(Part(printed, 1))),
        where=WHERE.mirrored(),
        after=(eq06.DERIVATION,),
    )
    return lines


DERIVATION = Derivation(
    number=8,
    name="propagation",
    title="Passage of a contact force through a bead",
    symbols=(
        (ForcePlus(*HERE), "force entering bead (r, s) from above along n⁺"),
        (ForcePlus(*LEFT), "force leaving it along n⁺"),
        (ForceMinus(*RIGHT), "force leaving it along n⁻: the branch"),
        (phi, "n⁺·n⁻"),
    ),
    assumptions=("first order in δn^±", *WHERE.in_words()),
    premises=(eq06.DERIVATION,),
    printed=PRINTED,
    loads=("any",),
    steps=steps,
    where=WHERE,
    remarks=("The paper leaves the incoming force along n⁻ to symmetry; it is solved for here.",),
)

if __name__ == "__main__":
    from force_diffusion.derivations.commands.alone import run_alone

    raise SystemExit(run_alone(DERIVATION))
