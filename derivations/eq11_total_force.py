"""Eq. 11: the contact force under a surface load, as the sum over all loads and paths."""

# fmt: off
from functools import cache

import sympy
from force_diffusion.derivations import (
    eq05_contact_minus as eq05, eq07_load_split as eq07, eq09_straight_path as eq09,
    eq10_branched_path as eq10)
from force_diffusion.derivations.framework.vocabulary import (
    Derivation, Domain, Groups, Steps, Theorem, axioms, equation, follows, lattice, minus, mirror,
    moment, rewrite, shown, terms, times, usual)
from force_diffusion.symbolic.symbols import (
    M, DeltaNMinus, DeltaNPlus, Dot, ForcePlus, Variance, f_load, i, j, k, l, n, n_minus, n_plus,
    n_y, phi, r, sigma)
# fmt: on

LAYERS = Domain.of(j >= 0, j < M)
LOADED = LAYERS.loaded(axioms.SURFACE)
ORDERED = f_load / (2 * n_y)

WEIGHT = 1 / (1 - phi**2)
BRANCH = Dot(n_plus, terms(DeltaNMinus(i + n + 1, j + n - 1), minus(DeltaNMinus(i + n, j + n))))
"""By how much a force along n⁻ turns at the bead from which it branches into the contact."""

PRINTED = equation(
    ForcePlus(i, j) / ORDERED,
    terms(
        1,
        times(
            WEIGHT,
            terms(
                times(phi, Dot(n_minus, DeltaNPlus(i, j))),
                minus(Dot(n_plus, DeltaNMinus(i + M - j + 1, M - 1))),
            ),
        ),
        minus(times(WEIGHT, sympy.Sum(BRANCH, (n, 1, M - j - 1)))),
    ),
)

STRAIGHT_LOAD = (i + M - j, M)
"""The surface bead straight above the contact."""
TOP = (STRAIGHT_LOAD[0] - 1, M - 1)
"""Lower bead of the contact through which its load comes in."""


@cache
def from_the_surface_down(formula: sympy.Eq, domain: Domain) -> Theorem:
    """Prove a force by induction, balancing bead after bead."""
    loads = axioms.loads(domain.loading)
    return eq07.carried_down(M - 1, loads, [(formula, domain)], mirrored=True)[0]


@cache
def in_radii() -> Groups:
    """The forces and, in the radii, the directions of contacts: both branches."""
    (force,) = shown(11, from_the_surface_down(PRINTED, LOADED))
    return (force, mirror(force)), eq05.directions()


def show_steps(steps: Steps) -> None:
    """One straight path, M − j − 1 paths with one branch."""
    at_load = dict(zip((k, l), STRAIGHT_LOAD, strict=True))
    split, carried = eq07.split_plus(*STRAIGHT_LOAD), eq09.PRINTED.rhs.xreplace(at_load)
    steps.show(
        "The surface bead straight above the contact is (i+M−j, M). Its load splits by Eq. 7, and "
        "Eq. 9 carries the force down.",
        sympy.Tuple(
            equation(ForcePlus(*TOP) / ORDERED, split),
            equation(ForcePlus(i, j) / ForcePlus(*TOP), carried),
        ),
        [rewrite(eq07.DERIVATION.theorems[0]), rewrite(eq09.DERIVATION.theorem)],
        [
            LAYERS.loaded(axioms.LOADED_VERTICALLY.put_in(at_load)),
            LAYERS.loaded(axioms.ENTERING.put_in(at_load)),
        ],
    )
    straight, printed = eq09.first_order_product(split, carried), PRINTED.rhs.args
    steps.show(
        "To first order the changes in the product of the two add up. The direction of the contact "
        "below the straight load cancels.",
        equation(straight, terms(*printed[:2])),
        rewrite(),
        LAYERS,
    )
    steps.show(
        "A load that reaches the contact by a path with one branch, at the bead (i+n, j+n), does "
        "so as in the mirror image of Eq. 10. It is the load on the bead (k, l) with",
        sympy.Tuple(equation(k, i + 2 * n - (M - j)), equation(l, M)),
        rewrite(),
        Domain.of(
            j >= 0, n >= 1, n <= M - j - 1, sympy.Eq(2 * n, (l - j) - (i - k)), sympy.Eq(l, M)
        ),
    )
    steps.show(
        "There is one such load for each n = 1, …, M−j−1. Relative to the force along n⁻ below its "
        "bead, it contributes",
        lattice.mirror(eq10.PRINTED),
        follows(mirror(eq10.DERIVATION.theorem)),
        eq10.BRANCHED.mirrored(),
    )
    branched = sympy.Sum(eq10.branched_plus(i, j, n), (n, 1, M - j - 1))
    steps.show(
        "As the branch is of first order, the force that enters it counts at order 0, f_load/2n_y. "
        "Summed over n:",
        equation(branched, printed[2]),
        rewrite(),
        LAYERS,
    )
    steps.show(
        "Both parts together balance every bead, as induction shows, layer after layer down.",
        PRINTED,
        from_the_surface_down,
    )
    steps.claim(
        "the tilt of a contact, the component of δn⁻ along n⁺, is of order √j for j ≥ 1",
        equation(
            Variance(Dot(n_plus, DeltaNMinus(i, j))),
            times(terms(4 * j, phi**2), sigma**2, 1 / (2 * r**2)),
        ),
        moment(eq05.DERIVATION.theorem),
        Domain.of(j >= 1),
    )


DERIVATION = Derivation(
    number=11,
    name="total_force",
    title="Contact force under a surface load",
    symbols=(
        *usual(ForcePlus(i, j), M),
        (f_load, "load on every bead of the surface layer j = M, downwards"),
        (n, "layers between the contact and the bead at which a force branches into it"),
    ),
    assumptions=("first order in δr", *LOADED.in_words(), "no path meets a side wall (W > M)"),
    printed=(PRINTED,),
    domain=LOADED,
    show_steps=show_steps,
)

if __name__ == "__main__":
    from force_diffusion.derivations.commands.cli import run_alone

    raise SystemExit(run_alone(11))
