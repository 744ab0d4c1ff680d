"""Eq. 8: how a contact force passes through one bead."""

# fmt: off
import sympy
from force_diffusion.derivations import eq06_force_balance as eq06
from force_diffusion.derivations import eq07_load_split as eq07
from force_diffusion.derivations.framework.vocabulary import (
    Derivation, Domain, Steps, Symbol, along, axioms, equation, follows, instance, lattice, minus,
    mirror, solve, terms, times, usual)
from force_diffusion.symbolic.symbols import (
    DeltaNMinus, DeltaNPlus, Dot, ForceMinus, ForcePlus, epsilon, n_minus, n_plus, phi,
    site_r, site_s)
# fmt: on

PASSED = Domain.of(site_s >= 1, loading=axioms.PASSING)
HERE = (site_r, site_s)
LEFT, RIGHT = (site_r - 1, site_s - 1), (site_r + 1, site_s - 1)
FORCES = ForcePlus(*LEFT), ForceMinus(*RIGHT)
ENTERING = ForcePlus(*HERE)
RATIOS = FORCES[0] / ENTERING, FORCES[1] / ENTERING
TURN = Dot(n_minus, terms(DeltaNPlus(*LEFT), minus(DeltaNPlus(*HERE))))

PRINTED = (
    equation(RATIOS[0], terms(1, times(phi / (1 - phi**2), TURN))),
    equation(RATIOS[1], minus(times(1 / (1 - phi**2), TURN))),
)

nu_in = Symbol("nu_in", r"\nu_{rs}", "ν_rs")  # n⁻·δn⁺ of the contact above
TILTS = {
    eq06.nu_plus: Dot(n_minus, DeltaNPlus(*LEFT)),
    eq06.nu_minus: Dot(n_plus, DeltaNMinus(*RIGHT)),
    nu_in: Dot(n_minus, DeltaNPlus(*HERE)),
}


def at_bead(across: sympy.Expr, layer: sympy.Expr) -> dict[sympy.Symbol, sympy.Expr]:
    """A bead in place of (r, s)."""
    return {site_r: across, site_s: layer}


def straight(across: sympy.Expr, layer: sympy.Expr) -> sympy.Expr:
    """f⁺ leaving over f⁺ entering a bead (first part)."""
    return PRINTED[0].rhs.xreplace(at_bead(across, layer))


def branching(across: sympy.Expr, layer: sympy.Expr) -> sympy.Expr:
    """f⁻ leaving over f⁺ entering a bead (second part)."""
    return PRINTED[1].rhs.xreplace(at_bead(across, layer))


def show_steps(steps: Steps) -> None:
    """The same 2×2 system with an incoming contact force in place of the load."""
    loads, (plus, minus_) = axioms.loads(axioms.PASSING), FORCES
    balance = instance(axioms.balance(), {}, PASSED)
    rows = steps.show(
        "As in Eq. 6, with the incoming force −f⁺_rs (n⁺ + δn⁺_rs) in place of the load. Dotted "
        "with n⁺ and n⁻, with the tilts ν⁺ = n⁻·δn⁺_(r−1,s−1) and ν⁻ = n⁺·δn⁻_(r+1,s−1) of the "
        "contacts below, and ν_rs = n⁻·δn⁺_rs of that above:",
        sympy.Tuple(
            equation(terms(plus, times(terms(phi, eq06.nu_minus), minus_)), ENTERING),
            equation(
                terms(times(terms(phi, eq06.nu_plus), plus), minus_),
                times(terms(phi, nu_in), ENTERING),
            ),
        ),
        [follows(along(balance, axis), loads, eq07.right_angles()) for axis in (n_plus, n_minus)],
    )
    forces = eq06.to_first_order(sympy.Matrix([1, phi + epsilon * nu_in]))
    steps.show(
        "Solved as for Eq. 7, and expanded in the three tilts ν:",
        sympy.Tuple(*map(equation, RATIOS, forces)),
        solve(rows.theorems, FORCES),
    )
    printed = steps.show(
        "The direction of the other support drops out, since nothing leaves along it at order 0.",
        sympy.Tuple(*PRINTED),
        solve(rows.theorems, FORCES),
    )
    steps.show(
        "For an incoming force along n⁻, which the paper leaves to symmetry, the same system gives",
        sympy.Tuple(*map(lattice.mirror, PRINTED)),
        tuple(follows(mirror(theorem)) for theorem in printed.theorems),
        PASSED.mirrored(),
    )


DERIVATION = Derivation(
    number=8,
    name="propagation",
    title="Passage of a contact force through a bead",
    symbols=(
        (ENTERING, "force entering bead (r, s), here two indices, from above along n⁺"),
        (FORCES[0], "force leaving it along n⁺"),
        (FORCES[1], "force leaving it along n⁻: the branch"),
        *usual(phi),
    ),
    assumptions=("first order in δn^±", *PASSED.in_words()),
    printed=PRINTED,
    domain=PASSED,
    show_steps=show_steps,
    definitions=TILTS,
)

if __name__ == "__main__":
    from force_diffusion.derivations.commands.cli import run_alone

    raise SystemExit(run_alone(8))
