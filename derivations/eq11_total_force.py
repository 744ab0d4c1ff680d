"""Eq. 11: the contact force under a surface load, as the sum over all loads and paths."""

from collections.abc import Iterator
from functools import cache

import sympy
from force_diffusion.derivations import eq04_contact_plus as eq04
from force_diffusion.derivations import eq05_contact_minus as eq05
from force_diffusion.derivations import eq07_load_split as eq07
from force_diffusion.derivations import eq09_straight_path as eq09
from force_diffusion.derivations import eq10_branched_path as eq10
from force_diffusion.derivations.framework.follows import at, states
from force_diffusion.derivations.framework.record import Claim, Derivation, Step, Witness
from force_diffusion.derivations.witnesses import remainders
from force_diffusion.derivations.witnesses.both_sides import about, compare, each_contact, search
from force_diffusion.symbolic.algebra.affine import Region
from force_diffusion.symbolic.algebra.exact import FIELD
from force_diffusion.symbolic.algebra.linear_forms import CONSTANT
from force_diffusion.symbolic.algebra.reading import Reader
from force_diffusion.symbolic.as_printed import equation, minus, terms, times
from force_diffusion.symbolic.kernel.decisions import (
    Ruling,
    all_of,
    decide_identity,
    decide_linear,
    from_test,
    undecided,
)
from force_diffusion.symbolic.mechanics.lattice import mirror
from force_diffusion.symbolic.mechanics.paths import BRANCH_COUNT
from force_diffusion.symbolic.printing.text import text
from force_diffusion.symbolic.symbols import (
    DeltaNMinus,
    DeltaNPlus,
    Dot,
    ForcePlus,
    M,
    f_load,
    i,
    j,
    k,
    l,
    n,
    n_minus,
    n_plus,
    n_y,
    phi,
)

PRINTED = equation(
    ForcePlus(i, j) / (f_load / (2 * n_y)),
    terms(
        1,
        times(
            1 / (1 - phi**2),
            terms(
                times(phi, Dot(n_minus, DeltaNPlus(i, j))),
                minus(Dot(n_plus, DeltaNMinus(i + M - j + 1, M - 1))),
            ),
        ),
        minus(
            times(
                1 / (1 - phi**2),
                sympy.Sum(
                    Dot(
                        n_plus,
                        terms(DeltaNMinus(i + n + 1, j + n - 1), minus(DeltaNMinus(i + n, j + n))),
                    ),
                    (n, 1, M - j - 1),
                ),
            )
        ),
    ),
)

ORDERED = f_load / (2 * n_y)
INTERIOR = Region({j: 0, M: j + 1})

STRAIGHT_LOAD = (i + M - j, M)
"""The surface bead straight above the contact."""


def branched_load(count: sympy.Expr) -> tuple[sympy.Expr, sympy.Expr]:
    """The surface bead whose force turns towards the contact ``count`` beads above (i, j)."""
    return i + 2 * count - (M - j), M


@cache
def in_radii(expression: sympy.Expr) -> sympy.Expr:
    """Put Eqs. 4 and 5 in for the contact directions."""
    return expression.replace(DeltaNPlus, eq04.contact_direction).replace(
        DeltaNMinus, eq05.contact_direction
    )


def straight_factors() -> tuple[sympy.Expr, sympy.Expr]:
    """Split below the straight load (Eq. 7), and what arrives of it at the contact (Eq. 9)."""
    at_load = {k: STRAIGHT_LOAD[0], l: STRAIGHT_LOAD[1]}
    return eq07.split_plus(*STRAIGHT_LOAD), eq09.PRINTED.rhs.xreplace(at_load)


def contributions() -> tuple[sympy.Expr, sympy.Expr]:
    """Straight contribution, to first order, and the sum of the branched ones (Eq. 10)."""
    branched = sympy.Sum(eq10.branched_plus(i, j, n), (n, 1, M - j - 1))
    return eq09.first_order_product(*straight_factors()), branched


TOP = (STRAIGHT_LOAD[0] - 1, M - 1)
"""Lower bead of the contact through which the straight load comes in."""


def _put_in(part: int, candidate: sympy.Eq) -> Ruling:
    """Eq. 7 below the straight load, in units of the ordered force, and Eq. 9 from there."""
    at_load = {k: STRAIGHT_LOAD[0], l: STRAIGHT_LOAD[1]}
    split, carried = at(eq07.PRINTED[0], at_load), at(eq09.PRINTED, at_load)
    in_units = equation(split.lhs / ORDERED, split.rhs / ORDERED)
    return states(in_units, carried, region=INTERIOR)(part, candidate)


def _load(part: int, candidate: sympy.Eq) -> Ruling:
    """By Eq. 10, mirrored, a load at k turns n = ½[(l − j) − (i − k)] steps above the contact."""
    mirrored = BRANCH_COUNT.xreplace({k: -k, i: -i})
    if candidate.lhs != (k, l)[part]:
        return undecided(f"the left-hand side is not {text((k, l)[part])}")
    if part:
        return decide_identity(candidate.rhs, M)
    return decide_identity(mirrored.xreplace({k: candidate.rhs, l: M}), n)


def steps() -> Iterator[Step]:
    """One straight path, M − j − 1 paths with one branch."""
    split, carried = straight_factors()
    straight, branched = contributions()
    printed = terms(*PRINTED.rhs.args[:2]), PRINTED.rhs.args[2]
    yield Step(
        "The surface bead straight above the contact is (i+M−j, M). Its load splits by Eq. 7, and "
        "Eq. 9 carries the force down.",
        sympy.Tuple(
            equation(ForcePlus(*TOP) / ORDERED, split),
            equation(ForcePlus(i, j) / ForcePlus(*TOP), carried),
        ),
        _put_in,
        ("Eq. 7", "Eq. 9"),
    )
    yield Step(
        "To first order the changes in the product of the two add up. The direction of the contact "
        "below the straight load cancels.",
        equation(straight, printed[0]),
        states(equation(straight, straight), region=INTERIOR),
        ("step 1",),
    )
    yield Step(
        "A surface load that reaches the contact with one branch turns at the bead (i+n, j+n): "
        "the mirror image of Eq. 10. It is the load on bead (k, l),",
        sympy.Tuple(*map(equation, (k, l), branched_load(n))),
        _load,
        ("Eq. 10",),
    )
    mirrored = mirror(eq10.PRINTED)
    yield Step(
        "one for each n = 1, …, M−j−1. It brings, of the force along n⁻ below its bead,",
        equation(mirrored.lhs, eq10.branched_plus(i, j, n)),
        states(mirrored, region=Region({j: 0, n: 1})),
        ("Eq. 10",),
    )
    yield Step(
        "Each enters with the ordered force as its source, since the branch is of first order. "
        "Added up over n:",
        equation(branched, printed[1]),
        states(equation(branched, branched), region=INTERIOR),
        ("step 4",),
    )
    yield Step("Both together:", PRINTED, decide, ("step 2", "step 5"))


def decide(_: int, candidate: sympy.Eq) -> Ruling:
    """Compare with the sum of all contributions, for 0 ≤ j < M (an empty sum for j = M − 1)."""
    if other := about(candidate, ForcePlus(i, j) / (f_load / (2 * n_y)), "surface", each_contact):
        return other
    straight, branched = contributions()
    return decide_linear(candidate.rhs, terms(straight, branched), INTERIOR)


def _loads() -> Ruling:
    # the mirror image of n = ½[(l−j) − (k−i)] at the load found must give n back, at each n
    across, layer = branched_load(n)
    count = ((layer - j) + (across - i)) / 2
    ends = (branched_load(sympy.Integer(1))[0], branched_load(M - j - 1)[0])
    # a load at any k has this one n, so that no load is counted twice; the straight one has
    # n = M − j, outside of the range of the sum
    any_load = ((layer - j) + (k - i)) / 2
    return all_of(
        decide_identity(count, n),
        decide_identity(branched_load(any_load)[0], k),
        decide_identity(branched_load(M - j)[0], STRAIGHT_LOAD[0]),
        decide_identity(ends[0], i - M + j + 2),
        decide_identity(ends[1], i + M - j - 2),
    )


def _next_to_the_surface() -> Ruling:
    top = {j: M - 1}
    left = PRINTED.rhs.xreplace(top)
    split = eq07.split_plus(i + 1, M)
    return decide_linear(left, split, Region({M: 1}))


def _next_to_the_base() -> Ruling:
    straight, branched = contributions()
    base = {j: sympy.Integer(0)}
    return decide_linear(
        in_radii(PRINTED.rhs.xreplace(base)),
        in_radii(terms(straight, branched).xreplace(base)),
        Region({M: 1}),
    )


def _mean() -> Ruling:
    form = Reader(INTERIOR).scalar(in_radii(PRINTED.rhs))
    constants = [weight for site, weight in form.sites.items() if site.family == CONSTANT]
    is_one = len(constants) == 1 and (constants[0] - FIELD.one).is_zero()
    return from_test(is_one, "the constant part is 1, all else is linear in radii of zero mean")


DERIVATION = Derivation(
    number=11,
    name="total_force",
    title="Contact force under a surface load",
    symbols=(
        (ForcePlus(i, j), "force of the contact from (i, j) to (i+1, j+1)"),
        (f_load, "load on every bead of the surface layer j = M, downwards"),
        (M, "height of the packing in layers above the base"),
        (n, "layers between the contact and the bead at which a force turns into it"),
    ),
    assumptions=(
        "first order in δr",
        "0 ≤ j < M",
        "only the surface beads are loaded",
        "no horizontal boundary is met (W > M)",
    ),
    premises=(eq04.DERIVATION, eq05.DERIVATION, eq07.DERIVATION, eq09.DERIVATION, eq10.DERIVATION),
    printed=(PRINTED,),
    loads=("surface",),
    steps=steps,
    decide=decide,
    search=search("surface", each_contact),
    claims=(
        Claim("each surface load has one n; those that branch are k = i−M+j+2, …, i+M−j−2", _loads),
        Claim("at j = M − 1 the sum is empty and Eq. 7 is left", _next_to_the_surface),
        Claim("at j = 0 it holds in the radii too", _next_to_the_base),
        Claim("the mean force is f_load/2n_y at every height", _mean),
    ),
    witnesses=(
        Witness(
            "an exact packing obeys it, both sides at orders ε⁰ and ε¹",
            lambda packing: compare(
                equation(PRINTED.lhs, in_radii(PRINTED.rhs)), packing, "surface", each_contact
            ),
        ),
        Witness(
            "exact forces at 80 digits differ from it by a remainder of order ε²",
            lambda packing: remainders.forces(in_radii(PRINTED.rhs), packing),
        ),
    ),
)

if __name__ == "__main__":
    from force_diffusion.derivations.commands.alone import run_alone

    raise SystemExit(run_alone(DERIVATION))
