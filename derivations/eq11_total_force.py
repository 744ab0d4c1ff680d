"""Eq. 11: the contact force under a surface load, as the sum over all loads and paths."""

from functools import cache

import sympy
from force_diffusion.derivations import eq04_contact_plus as eq04
from force_diffusion.derivations import eq05_contact_minus as eq05
from force_diffusion.derivations import eq07_load_split as eq07
from force_diffusion.derivations import eq09_straight_path as eq09
from force_diffusion.derivations import eq10_branched_path as eq10
from force_diffusion.derivations.framework.vocabulary import (
    SUPPOSED,
    Chain,
    Derivation,
    Lines,
    Part,
    Where,
    axioms,
    below,
    equation,
    induct,
    minus,
    mirror_of,
    rewrite,
    terms,
    times,
)
from force_diffusion.symbolic.kernel.where import ENTERING, LOADED_VERTICALLY, SURFACE
from force_diffusion.symbolic.mechanics.lattice import mirror
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

WHERE = Where.of(j >= 0, j < M, loading=SURFACE)

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


ONE_LOAD = Where.of(j >= 0, n >= 1, n <= M - j - 1)
"""Branches of surface loads above a contact."""


@cache
def steps() -> Lines:
    """One straight path, M − j − 1 paths with one branch."""
    lines = Lines(WHERE)
    split, carried = straight_factors()
    straight, branched = contributions()
    printed = terms(*PRINTED.rhs.args[:2]), PRINTED.rhs.args[2]
    geometry = Where.of(j >= 0, j < M)
    at_load = dict(zip((k, l), STRAIGHT_LOAD, strict=True))
    factors = lines.show(
        "The surface bead straight above the contact is (i+M−j, M). Its load splits by Eq. 7, and "
        "Eq. 9 carries the force down.",
        sympy.Tuple(
            equation(ForcePlus(*TOP) / ORDERED, split),
            equation(ForcePlus(i, j) / ForcePlus(*TOP), carried),
        ),
        (rewrite(Part(eq07.DERIVATION, 0)), rewrite(eq09.DERIVATION)),
        where=(
            geometry.loaded(LOADED_VERTICALLY.put_in(at_load)),
            geometry.loaded(ENTERING.put_in(at_load)),
        ),
    )
    product = lines.show(
        "To first order the changes in the product of the two add up. The direction of the contact "
        "below the straight load cancels.",
        equation(straight, printed[0]),
        rewrite(),
        where=geometry,
        after=(factors,),
    )
    turned = ONE_LOAD.also(sympy.Eq(2 * n, (l - j) - (i - k)), sympy.Eq(l, M), indices=(k, l))
    turning = lines.show(
        "A surface load that reaches the contact with one branch turns at the bead (i+n, j+n): "
        "the mirror image of Eq. 10. It is the load on bead (k, l),",
        sympy.Tuple(*map(equation, (k, l), branched_load(n))),
        rewrite(),
        where=turned,
        after=(eq10.DERIVATION,),
    )
    mirrored = mirror(eq10.PRINTED)
    bringing = lines.show(
        "one for each n = 1, …, M−j−1. It brings, of the force along n⁻ below its bead,",
        equation(mirrored.lhs, eq10.branched_plus(i, j, n)),
        mirror_of(eq10.DERIVATION),
        where=eq10.WHERE.mirrored(),
        after=(turning,),
    )
    summed = lines.show(
        "Each enters with the ordered force as its source, since the branch is of first order. "
        "Added up over n:",
        equation(branched, printed[1]),
        rewrite(),
        where=geometry,
        after=(bringing,),
    )
    loads = axioms.loads(SURFACE)
    lines.show(
        "Both together:",
        PRINTED,
        induct(
            j,
            M - 1,
            below(axioms.balance(), loads),
            below(axioms.balance(), (SUPPOSED, loads)),
            down=True,
            mirrored=True,
        ),
        after=(product, summed),
    )
    first, last = branched_load(sympy.Integer(1))[0], branched_load(M - j - 1)[0]
    lines.claim(
        "each surface load has one n; those that branch are k = i−M+j+2, …, i+M−j−2",
        sympy.Tuple(
            equation(((M - j) + (branched_load(n)[0] - i)) / 2, n),
            equation(branched_load(((M - j) + (k - i)) / 2)[0], k),
            equation(branched_load(M - j)[0], STRAIGHT_LOAD[0]),
            equation(first, i - M + j + 2),
            equation(last, i + M - j - 2),
        ),
        rewrite(),
        where=ONE_LOAD.also(indices=(k,)),
    )
    lines.claim(
        "at j = M − 1 the sum is empty and Eq. 7 is left",
        equation(PRINTED.rhs.xreplace({j: M - 1}), eq07.split_plus(i + 1, M)),
        rewrite(),
        where=geometry.put_in({j: M - 1}, (i, M)),
    )
    base = {j: sympy.Integer(0)}
    lines.claim(
        "at j = 0 it holds in the radii too",
        equation(
            *(in_radii(one.xreplace(base)) for one in (PRINTED.rhs, terms(straight, branched)))
        ),
        rewrite(),
        where=geometry.put_in(base, (i, M)),
    )
    return lines


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
        *WHERE.in_words(),
        "no horizontal boundary is met (W > M)",
    ),
    premises=(eq04.DERIVATION, eq05.DERIVATION, eq07.DERIVATION, eq09.DERIVATION, eq10.DERIVATION),
    printed=(PRINTED,),
    loads=("surface",),
    steps=steps,
    where=WHERE,
)

DIRECTIONS = (eq04.DERIVATION, eq05.DERIVATION)
"""Both contact directions in the radii."""
IN_RADII = Chain((DERIVATION, DIRECTIONS))
"""Forces in the radii: Eqs. 4 and 5 put in."""

if __name__ == "__main__":
    from force_diffusion.derivations.commands.alone import run_alone

    raise SystemExit(run_alone(DERIVATION))
