"""Eq. 7: how a vertical load splits between the two supports."""

from collections.abc import Iterator

import sympy

from derivations import eq06_force_balance as eq06
from derivations import witnesses
from derivations.record import Claim, Derivation, Step, Witness
from derivations.runner import run_alone
from symbolic import balance
from symbolic.affine import Region
from symbolic.as_printed import equation, minus, terms, times
from symbolic.kernel import Ruling, all_of, decide_identity, decide_linear
from symbolic.lattice import mirror
from symbolic.symbols import (
    DeltaNMinus,
    DeltaNPlus,
    Dot,
    ForceMinus,
    ForcePlus,
    epsilon,
    f_load,
    k,
    l,
    n_minus,
    n_plus,
    n_y,
    phi,
)

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


def solved(branch: int) -> sympy.Expr:
    """The inverted 2×2 system: ordered force times 1 plus the first-order change."""
    at_zero, slope = balance.solved("load")
    change = slope[branch].xreplace({balance.tilt_plus: TILT_PLUS, balance.tilt_minus: TILT_MINUS})
    return ORDERED * (at_zero[branch] + change)


def steps() -> Iterator[Step]:
    """Dot the balance with n⁺ and n⁻, invert, and expand in the strength ε."""
    yield Step(
        "A vertical load is −(f_load/2n_y)(n⁺ + n⁻). Dotted with n⁺ and n⁻, Eq. 6 is a "
        "2×2 system for the two forces in units of f_load/2n_y; ν⁺ = n⁻·δn⁺ and "
        "ν⁻ = n⁺·δn⁻ are all that δn^± holds, by Eqs. 4 and 5.",
        sympy.Tuple(balance.balance_matrix(), balance.incoming("load")),
    )
    yield Step(
        "Inverted, as its adjugate over its determinant; here the determinant and the adjugate:",
        sympy.Tuple(
            sympy.collect(balance.balance_matrix().det(), epsilon),
            balance.balance_matrix().adjugate(),
        ),
    )
    at_zero, slope = balance.solved("load")
    yield Step(
        "At ε = 0 both forces are 1; the derivatives with respect to ε at 0 are",
        sympy.Tuple(*slope),
    )
    assert len(at_zero) == len(PRINTED)
    yield Step("In the paper's symbols:", sympy.Tuple(*PRINTED))


def decide(part: int, candidate: sympy.Eq) -> Ruling:
    """Compare with the inverted system, for any contact directions."""
    return decide_linear(candidate.rhs, solved(part), Region({}))


def _solves_the_system() -> Ruling:
    at_zero, slope = balance.solved("load")
    matrix, right = balance.balance_matrix(), balance.incoming("load")
    order_0 = matrix.subs(epsilon, 0)
    order_1 = sympy.diff(matrix, epsilon).subs(epsilon, 0)
    zero = sympy.Integer(0)
    return all_of(
        *(
            ruling
            for row in range(2)
            for ruling in (
                decide_identity(
                    sum(order_0[row, c] * at_zero[c] for c in range(2)), right.subs(epsilon, 0)[row]
                ),
                decide_identity(
                    sum(
                        order_0[row, c] * slope[c] + order_1[row, c] * at_zero[c] for c in range(2)
                    ),
                    zero,
                ),
            )
        )
    )


def _mirror_image() -> Ruling:
    return decide_linear(mirror(PRINTED[0].rhs), PRINTED[1].rhs, Region({}))


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
    assumptions=("first order in δn^±", "the load is vertical"),
    premises=(eq06.DERIVATION,),
    printed=PRINTED,
    steps=steps,
    decide=decide,
    claims=(
        Claim("the expansion solves the balance at orders 0 and 1", _solves_the_system),
        Claim("the second part is the mirror image of the first", _mirror_image),
    ),
    witnesses=(
        Witness(
            "Taylor coefficients of the exact packing equal it as fractions",
            lambda packing: witnesses.split(PRINTED, packing),
        ),
    ),
)

if __name__ == "__main__":
    raise SystemExit(run_alone(DERIVATION))
