"""Eq. 7: how a vertical load splits between the two supports."""

# fmt: off
from collections.abc import Iterable, Sequence
from functools import cache, partial

import sympy
from force_diffusion.derivations import (
    eq04_contact_plus as eq04, eq05_contact_minus as eq05, eq06_force_balance as eq06)
from force_diffusion.derivations.framework.vocabulary import (
    Derivation, Domain, NotProvedError, Rule, Steps, Theorem, along, axioms, equation, follows,
    inducted, instance, isolated, minus, solve, terms, times, usual)
from force_diffusion.symbolic.symbols import (
    DeltaNMinus, DeltaNPlus, Dot, ForceMinus, ForcePlus, f_load, j, k, l, n_minus, n_plus, n_y,
    phi, site_r, site_s)
# fmt: on

LOADED = Domain.of(l >= 1, loading=axioms.LOADED_VERTICALLY)
FORCES = ForcePlus(k - 1, l - 1), ForceMinus(k + 1, l - 1)
TILT_PLUS = Dot(n_minus, DeltaNPlus(k - 1, l - 1))
TILT_MINUS = Dot(n_plus, DeltaNMinus(k + 1, l - 1))
ORDERED = f_load / (2 * n_y)

SIDES = {ForcePlus: 1, ForceMinus: -1}
"""Forces of contacts, and the side of the upper bead."""

SHARES = tuple(
    terms(1, times(1 / (1 - phi**2), terms(times(phi, own), minus(other))))
    for own, other in ((TILT_PLUS, TILT_MINUS), (TILT_MINUS, TILT_PLUS))
)
"""The forces over f_load/2n_y."""


def of_load(shares: Iterable[sympy.Expr]) -> list[sympy.Eq]:
    """Both forces as shares of f_load/2n_y."""
    pairs = zip(FORCES, shares, strict=True)
    return [equation(force, times(ORDERED, share)) for force, share in pairs]


PRINTED = tuple(of_load(SHARES))


def split_plus(across: sympy.Expr, layer: sympy.Expr) -> sympy.Expr:
    """f⁺ below a loaded bead over f_load/2n_y, to first order."""
    return SHARES[0].xreplace({k: across, l: layer})


@cache
def right_angles() -> tuple[Theorem, ...]:
    """What is used of Eqs. 4 and 5: n⁺·δn⁺ = 0 and n⁻·δn⁻ = 0."""
    return eq04.DERIVATION.proof[-1].theorem, eq05.DERIVATION.proof[-1].theorem


def balancing(loads: tuple[Theorem, ...], above: tuple[Theorem, ...] = ()) -> Rule:
    """The rule for a force, from the balance of the bead above, given the forces above that."""

    def rule(formula: sympy.Eq, domain: Domain) -> Theorem:
        force, _ = isolated(formula, domain)
        if type(force) not in SIDES:
            raise NotProvedError("it is not about a contact force")
        across, layer = force.args[0] + SIDES[type(force)], force.args[1] + 1
        bead = instance(axioms.balance(), {site_r: across, site_s: layer}, domain)
        forces = [kind(across - side, layer - 1) for kind, side in SIDES.items()]
        return solve([bead], forces, (*above, *loads), right_angles())(formula, domain)

    return rule


def carried_down(
    top: sympy.Expr,
    loads: tuple[Theorem, ...],
    statements: Sequence[tuple[sympy.Eq, Domain]],
    in_top_layer: Rule | None = None,
    *,
    mirrored: bool = False,
) -> tuple[Theorem, ...]:
    """Forces of contacts by induction on j from ``top`` down, balancing bead after bead.

    Args:
        top: the highest layer with such contacts.
        loads: on the beads.
        statements: about the forces, with their domains; proved together.
        in_top_layer: proves them there, by default by balancing as well.
        mirrored: whether the mirror images are put in, too.
    """
    first, next_layer = in_top_layer or balancing(loads), partial(balancing, loads)
    return inducted(j, top, first, next_layer, statements, down=True, mirrored=mirrored)


def show_steps(steps: Steps) -> None:
    """Dot the balance with n⁺ and n⁻, invert, and expand in the tilts."""
    loads = axioms.loads(axioms.LOADED_VERTICALLY)
    balance = eq06.DERIVATION.theorem
    (plus, minus_), carried = FORCES, times(ORDERED, terms(1, phi))
    rows = steps.show(
        "A vertical load is −(f_load/2n_y)(n⁺ + n⁻). Dotted with n⁺ and n⁻, Eq. 6 is a 2×2 system "
        "for the two forces. By Eqs. 4 and 5, δn^± is at right angles to its own contact, so only "
        "the tilts ν⁺ = n⁻·δn⁺_(k−1,l−1) and ν⁻ = n⁺·δn⁻_(k+1,l−1) enter:",
        sympy.Tuple(
            equation(terms(plus, times(terms(phi, eq06.nu_minus), minus_)), carried),
            equation(terms(times(terms(phi, eq06.nu_plus), plus), minus_), carried),
        ),
        [follows(along(balance, axis), loads, right_angles()) for axis in (n_plus, n_minus)],
    )
    forces = eq06.to_first_order(sympy.Matrix([1 + phi, 1 + phi]))
    steps.show(
        "Solved by elimination, with the pivots 1 and, at order 0, 1 − φ², and expanded in ν:",
        sympy.Tuple(*of_load(forces)),
        solve(rows.theorems, FORCES),
    )
    steps.show("In the paper's symbols:", sympy.Tuple(*PRINTED), solve(rows.theorems, FORCES))


DERIVATION = Derivation(
    number=7,
    name="load_split",
    title="Split of a load between the two supports",
    symbols=(
        (f_load, "magnitude of the vertical load on bead (k, l)"),
        *usual(phi),
        (FORCES[0], "force of the contact from (k−1, l−1)"),
        (FORCES[1], "force of the contact from (k+1, l−1)"),
    ),
    assumptions=("first order in δn^±", *LOADED.in_words()),
    printed=PRINTED,
    domain=LOADED,
    show_steps=show_steps,
    definitions={eq06.nu_plus: TILT_PLUS, eq06.nu_minus: TILT_MINUS},
)

if __name__ == "__main__":
    from force_diffusion.derivations.commands.cli import run_alone

    raise SystemExit(run_alone(7))
