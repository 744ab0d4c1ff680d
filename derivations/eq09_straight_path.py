"""Eq. 9: the contribution of a contact force to a contact straight below it."""

from collections.abc import Iterator

import sympy
from force_diffusion.derivations import eq08_propagation as eq08
from force_diffusion.derivations.framework.follows import at, identity, linear, states, walks
from force_diffusion.derivations.framework.record import Derivation, Step, Witness
from force_diffusion.derivations.witnesses.both_sides import about, compare, search, straight_below
from force_diffusion.symbolic.algebra.affine import Region
from force_diffusion.symbolic.as_printed import equation, minus, terms, times
from force_diffusion.symbolic.kernel.decisions import (
    Ruling,
    Verdict,
    all_of,
    decide_linear,
    proved,
)
from force_diffusion.symbolic.mechanics.paths import ENTRY, straight_end
from force_diffusion.symbolic.symbols import (
    DeltaNPlus,
    Dot,
    ForcePlus,
    epsilon,
    i,
    j,
    n_minus,
    phi,
    q,
)

PRINTED = equation(
    ForcePlus(i, j) / ForcePlus(*ENTRY),
    terms(
        1,
        times(phi / (1 - phi**2), Dot(n_minus, terms(DeltaNPlus(i, j), minus(DeltaNPlus(*ENTRY))))),
    ),
)


def first_order_product(left: sympy.Expr, right: sympy.Expr) -> sympy.Expr:
    """(1 + A)(1 + B) to first order, 1 + A and 1 + B given: one plus both changes."""
    return terms(left, right, -1)


def after(candidate: sympy.Expr, steps_down: sympy.Expr) -> sympy.Expr:
    """The ratio at the contact that lies ``steps_down`` straight below the entry."""
    across, layer = straight_end(steps_down)
    return candidate.xreplace({i: across, j: layer})


NO_BEAD = sympy.Integer(0)
FIRST, SECOND = sympy.symbols("A B")


def _step(ratio: sympy.Expr) -> sympy.Expr:
    """What a ratio becomes at the next bead: Eq. 8, to first order."""
    return first_order_product(after(ratio, q), eq08.straight(*straight_end(q)))


def steps() -> Iterator[Step]:
    """Induction on the number q of beads passed."""
    yield Step(
        "After q beads the contact reached has the lower bead (k−1−q, l−1−q).",
        sympy.Tuple(*map(equation, (i, j), straight_end(q))),
        walks(ENTRY, dict(zip(eq08.HERE, eq08.LEFT, strict=True)), q),
        ("Eq. 8",),
    )
    yield Step(
        "The next bead multiplies by Eq. 8.",
        equation(
            ForcePlus(*straight_end(q + 1)) / ForcePlus(*straight_end(q)),
            eq08.straight(*straight_end(q)),
        ),
        states(at(eq08.PRINTED[0], dict(zip(eq08.HERE, straight_end(q), strict=True)))),
        ("Eq. 8", "step 1"),
    )
    yield Step(
        "To first order the changes in a product add up.",
        equation(
            times(terms(1, epsilon * FIRST), terms(1, epsilon * SECOND)),
            terms(1, times(epsilon, terms(FIRST, SECOND)), epsilon**2 * FIRST * SECOND),
        ),
        identity(),
    )
    yield Step(
        "The direction in between cancels: the printed ratio at q times Eq. 8 is that at q + 1.",
        equation(_step(PRINTED.rhs), after(PRINTED.rhs, q + 1)),
        linear(region=Region({q: 0})),
        ("step 2", "step 3"),
    )
    yield Step(
        "At the entry itself, q = 0, the printed ratio is 1: no bead has been passed. So for every "
        "q the ends are left.",
        PRINTED,
        decide,
        ("step 4",),
    )


def decide(_: int, candidate: sympy.Eq) -> Ruling:
    """Base case q = 0 and the inductive step with symbolic q."""
    if other := about(candidate, ForcePlus(i, j) / ForcePlus(*ENTRY), "single", straight_below):
        return other
    base = decide_linear(after(candidate.rhs, NO_BEAD), sympy.Integer(1), Region({}))
    step = decide_linear(after(candidate.rhs, q + 1), _step(candidate.rhs), Region({q: 0}))
    ruling = all_of(base, step)
    if ruling.verdict is Verdict.PROVED:
        return proved("base case q = 0 and inductive step with a symbolic number q of beads")
    return ruling


DERIVATION = Derivation(
    number=9,
    name="straight_path",
    title="Straight path without a branch",
    symbols=(
        (ForcePlus(*ENTRY), "force entering below the loaded bead (k, l) along n⁺"),
        (ForcePlus(i, j), "force of a contact straight below it, k − i = l − j"),
        (DeltaNPlus(i, j), "change of the direction from (i, j) to (i+1, j+1)"),
        (n_minus, "direction of the ordered contacts, up and to the left"),
        (phi, "n⁺·n⁻"),
        (q, "number of beads passed"),
    ),
    assumptions=("first order in δn^±", "k − i = l − j ≥ 1", "the beads passed carry no load"),
    premises=(eq08.DERIVATION,),
    printed=(PRINTED,),
    loads=("single",),
    steps=steps,
    decide=decide,
    search=search("single", straight_below),
    witnesses=(
        Witness(
            "an exact packing obeys it, both sides at orders ε⁰ and ε¹",
            lambda packing: compare(PRINTED, packing, "single", straight_below),
        ),
    ),
)

if __name__ == "__main__":
    from force_diffusion.derivations.commands.alone import run_alone

    raise SystemExit(run_alone(DERIVATION))
