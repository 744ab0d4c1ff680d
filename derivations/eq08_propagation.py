"""Eq. 8: how a contact force passes through one bead."""

from collections.abc import Iterator

import sympy

from derivations import eq06_force_balance as eq06
from derivations import witnesses
from derivations.record import Claim, Derivation, Step, Witness
from derivations.runner import run_alone
from symbolic import balance
from symbolic.affine import Region
from symbolic.as_printed import equation, minus, terms, times
from symbolic.kernel import Ruling, all_of, decide_linear
from symbolic.lattice import mirror
from symbolic.symbols import (
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


def solved(entering: str, branch: int) -> sympy.Expr:
    """The inverted 2×2 system for an incoming force along ``entering``, to first order."""
    at_zero, slope = balance.solved(entering)
    inward = Dot(n_minus, DeltaNPlus(*HERE)) if entering == "+" else Dot(n_plus, DeltaNMinus(*HERE))
    return at_zero[branch] + slope[branch].xreplace(
        {
            balance.tilt_plus: Dot(n_minus, DeltaNPlus(*LEFT)),
            balance.tilt_minus: Dot(n_plus, DeltaNMinus(*RIGHT)),
            balance.tilt_incoming: inward,
        }
    )


def steps() -> Iterator[Step]:
    """The same 2×2 system with an incoming contact force in place of the load."""
    yield Step(
        "Eq. 6 holds with the load replaced by the incoming force −f⁺_rs (n⁺ + δn⁺_rs). "
        "Dotted with n⁺ and n⁻, in units of f⁺_rs:",
        sympy.Tuple(balance.balance_matrix(), balance.incoming("+")),
    )
    at_zero, slope = balance.solved("+")
    yield Step(
        "Inverted; the values at ε = 0 and the derivatives there are",
        sympy.Tuple(sympy.Tuple(*at_zero), sympy.Tuple(*slope)),
    )
    yield Step(
        "The direction of the other support drops out, since nothing leaves along it at order 0.",
        sympy.Tuple(*PRINTED),
    )
    yield Step(
        "For an incoming force along n⁻ the same system gives the mirror images.",
        sympy.Tuple(*(mirror(part) for part in PRINTED)),
    )


def decide(part: int, candidate: sympy.Eq) -> Ruling:
    """Compare with the inverted system, for any contact directions."""
    return decide_linear(candidate.rhs, solved("+", part), Region({}))


def _other_orientation() -> Ruling:
    return all_of(
        decide_linear(mirror(PRINTED[0].rhs), solved("-", 1), Region({})),
        decide_linear(mirror(PRINTED[1].rhs), solved("-", 0), Region({})),
    )


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
    assumptions=("first order in δn^±", "bead (r, s) carries no load of its own"),
    premises=(eq06.DERIVATION,),
    printed=PRINTED,
    steps=steps,
    decide=decide,
    claims=(
        Claim(
            "an incoming force along n⁻ gives both mirror images, solved for and compared",
            _other_orientation,
        ),
    ),
    witnesses=(
        Witness(
            "Taylor coefficients of the exact packing equal it as fractions",
            lambda packing: witnesses.passage(PRINTED, packing),
        ),
    ),
    remarks=("The paper leaves the incoming force along n⁻ to symmetry; it is solved for here.",),
)

if __name__ == "__main__":
    raise SystemExit(run_alone(DERIVATION))
