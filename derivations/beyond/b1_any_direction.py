"""Eq. B1: the contact forces under a surface load in any direction."""

from collections.abc import Iterator
from functools import cache

import sympy
from force_diffusion.derivations import eq06_force_balance as eq06
from force_diffusion.derivations import eq09_straight_path as eq09
from force_diffusion.derivations import eq10_branched_path as eq10
from force_diffusion.derivations import eq11_total_force as eq11
from force_diffusion.derivations.framework.follows import states, vector_identity
from force_diffusion.derivations.framework.record import Claim, Derivation, Step, Witness
from force_diffusion.derivations.witnesses.both_sides import about, compare, each_tilted, search
from force_diffusion.symbolic.algebra.affine import Region
from force_diffusion.symbolic.as_printed import equation, minus, terms, times
from force_diffusion.symbolic.kernel.decisions import (
    Ruling,
    all_of,
    decide_identity,
    decide_linear,
    decide_vector_identity,
)
from force_diffusion.symbolic.mechanics import balance
from force_diffusion.symbolic.mechanics.lattice import mirror
from force_diffusion.symbolic.notation import Symbol
from force_diffusion.symbolic.symbols import (
    DeltaNMinus,
    DeltaNPlus,
    Dot,
    ForceMinus,
    ForcePlus,
    L_minus,
    L_plus,
    Load,
    M,
    e_y,
    f_load,
    i,
    j,
    k,
    l,
    n,
    n_minus,
    n_plus,
    n_x,
    n_y,
    phi,
    t,
)

CARRIED = terms(times(L_plus, n_plus), times(L_minus, n_minus))
"""What the supports of a loaded bead have to carry: minus its load."""


def _forces(share: sympy.Expr) -> sympy.Expr:
    """Eq. 11 with the changes of directions along n⁻ times the share that n⁻ carries."""
    weight = share / (1 - phi**2)
    return terms(
        1,
        times(phi / (1 - phi**2), Dot(n_minus, DeltaNPlus(i, j))),
        minus(times(weight, Dot(n_plus, DeltaNMinus(i + M - j + 1, M - 1)))),
        minus(
            times(
                weight,
                sympy.Sum(
                    Dot(
                        n_plus,
                        terms(DeltaNMinus(i + n + 1, j + n - 1), minus(DeltaNMinus(i + n, j + n))),
                    ),
                    (n, 1, M - j - 1),
                ),
            )
        ),
    )


PRINTED = (
    equation(ForcePlus(i, j) / L_plus, _forces(t)),
    equation(ForceMinus(i, j) / L_minus, mirror(_forces(1 / t))),
)
SUBJECTS = (ForcePlus(i, j) / L_plus, ForceMinus(i, j) / L_minus)

put_in_radii = eq11.in_radii
"""Eqs. 4 and 5 for the contact directions of an expression."""


def in_radii(part: int) -> sympy.Expr:
    """The right-hand side of one of the two lines in the radii."""
    return put_in_radii(PRINTED[part].rhs)


RATIO = {L_minus: t * L_plus}


@cache
def solved() -> balance.Solved:
    """Eq. 6 solved for a load −(L⁺n⁺ + L⁻n⁻)."""
    return eq06.solved(CARRIED, k, l)


def split_plus(across: sympy.Expr, layer: sympy.Expr) -> sympy.Expr:
    """f⁺ below a loaded bead over L⁺, to first order."""
    in_ratio = sympy.expand(solved().first_order(0).xreplace(RATIO) / L_plus)
    return in_ratio.xreplace({k: across, l: layer})


def contributions() -> tuple[sympy.Expr, sympy.Expr]:
    """Straight contribution over L⁺, to first order, and the sum of the branched ones."""
    across, layer = eq11.STRAIGHT_LOAD
    at_load = {k: across, l: layer}
    straight = eq09.first_order_product(
        split_plus(across, layer), eq09.PRINTED.rhs.xreplace(at_load)
    )
    return straight, t * sympy.Sum(eq10.branched_plus(i, j, n), (n, 1, M - j - 1))


def steps() -> Iterator[Step]:
    """The paths of Eq. 11; what enters along n⁻ is L⁻, what enters along n⁺ is L⁺."""
    yield Step(
        "A load in any direction has two components along the contacts:",
        equation(Load(k, l), minus(CARRIED)),
        vector_identity({Load(k, l): -CARRIED}),
    )
    below = ForcePlus(k - 1, l - 1) / L_plus
    yield Step(
        "Eq. 6, solved for it to first order as in Eq. 7, gives f⁺ below the loaded bead, over L⁺:",
        equation(
            below,
            terms(
                1,
                times(
                    1 / (1 - phi**2),
                    terms(
                        times(phi, Dot(n_minus, DeltaNPlus(k - 1, l - 1))),
                        minus(times(t, Dot(n_plus, DeltaNMinus(k + 1, l - 1)))),
                    ),
                ),
            ),
        ),
        states(equation(below, split_plus(k, l))),
        ("Eq. 6", "step 1"),
    )
    straight, branched = contributions()
    *printed_straight, printed_branched = PRINTED[0].rhs.args
    yield Step(
        "The paths are those of Eq. 11. The straight one carries L⁺ (Eq. 9); to first order,",
        equation(straight, terms(*printed_straight)),
        states(equation(straight, straight), region=eq11.INTERIOR),
        ("Eq. 9", "Eq. 11", "step 2"),
    )
    yield Step(
        "Those that branch into the contact start along n⁻, so that L⁻ enters their branch "
        "(Eq. 10); over L⁺:",
        equation(branched, printed_branched),
        states(equation(branched, branched), region=eq11.INTERIOR),
        ("Eq. 10", "Eq. 11"),
    )
    yield Step(
        "Added up; f⁻ is the mirror image, with L⁺ and L⁻ exchanged, t ↔ 1/t.",
        sympy.Tuple(*PRINTED),
        decide,
        ("step 3", "step 4"),
    )


def decide(part: int, candidate: sympy.Eq) -> Ruling:
    """Compare with the sum of all contributions, for 0 ≤ j < M."""
    if other := about(candidate, SUBJECTS[part], "tilted", each_tilted):
        return other
    derived = terms(*contributions())
    if part:
        derived = mirror(derived.doit(deep=False)).xreplace({t: 1 / t})
    return decide_linear(candidate.rhs, derived, eq11.INTERIOR)


def _split() -> Ruling:
    """The expansion in the strength, against the printed split."""
    stated = _forces(t).xreplace({j: M - 1})
    return decide_linear(split_plus(i + 1, M), stated, Region({M: 1}))


def _vertical() -> Ruling:
    return decide_linear(
        PRINTED[0].rhs.xreplace({t: sympy.Integer(1)}), eq11.PRINTED.rhs, eq11.INTERIOR
    )


SINE, COSINE = (Symbol(name, rf"\{name}\theta", f"{name} θ", real=True) for name in ("sin", "cos"))
COMPONENTS = (
    f_load * (COSINE / n_y - SINE / n_x) / 2,
    f_load * (COSINE / n_y + SINE / n_x) / 2,
)
"""L⁺ and L⁻ of a load at the angle θ from straight down, positive towards +i."""


def _compressive() -> Ruling:
    """The load again from its components; and their sign, as that of n_x cos θ ∓ n_y sin θ."""
    plus, other = COMPONENTS
    e_x = (n_plus - n_minus) / (2 * n_x)
    scale = 2 * n_x * n_y / f_load
    return all_of(
        decide_vector_identity(
            plus * n_plus + other * n_minus, f_load * (COSINE * e_y - SINE * e_x)
        ),
        decide_identity(scale * plus, n_x * COSINE - n_y * SINE),
        decide_identity(scale * other, n_x * COSINE + n_y * SINE),
    )


DERIVATION = Derivation(
    number="B1",
    name="any_direction",
    title="Contact forces under a surface load in any direction",
    symbols=(
        (L_plus, "component of the load on each surface bead, −(L⁺n⁺ + L⁻n⁻), along n⁺"),
        (L_minus, "its component along n⁻"),
        (t, "L⁻/L⁺; 1 for a vertical load"),
        (ForcePlus(i, j), "force of the contact from (i, j) to (i+1, j+1)"),
        (ForceMinus(i, j), "force of the contact from (i, j) to (i−1, j+1)"),
        (M, "height of the packing in layers above the base"),
        (n, "layers between the contact and the bead at which a force turns into it"),
    ),
    assumptions=(
        "first order in δr",
        "0 ≤ j < M",
        "only the surface beads are loaded, all alike",
        "L⁺ > 0 in the first part, L⁻ > 0 in the second",
        "no horizontal boundary is met (W > M)",
    ),
    premises=(eq06.DERIVATION, eq09.DERIVATION, eq10.DERIVATION, eq11.DERIVATION),
    printed=PRINTED,
    steps=steps,
    decide=decide,
    search=search("tilted", each_tilted),
    claims=(
        Claim("at j = M − 1 the sum is empty and the split of the load is left", _split),
        Claim("for t = 1 it is Eq. 11", _vertical),
        Claim(
            "at the angle θ from the vertical L⁺ and L⁻ have the signs of n_x cos θ ∓ n_y sin θ: "
            "the ordered packing is compressive for |tan θ| < n_x/n_y, a load within the angle of "
            "the contacts",
            _compressive,
        ),
    ),
    witnesses=tuple(
        Witness(
            f"an exact packing obeys it, both sides at orders ε⁰ and ε¹: {name} part",
            lambda packing, part=part: compare(  # type: ignore[misc]
                equation(PRINTED[part].lhs, in_radii(part)),
                packing,
                "tilted",
                each_tilted,
            ),
        )
        for part, name in enumerate(("first", "second"))
    ),
    remarks=(
        "Only the changes along the other branch carry t: what turns into f⁺ is what came along "
        "n⁻. As L⁻ is taken away, f⁺ stays near L⁺ and feels the tilt of its own contact alone.",
    ),
)

if __name__ == "__main__":
    from force_diffusion.derivations.commands.alone import run_alone

    raise SystemExit(run_alone(DERIVATION))
