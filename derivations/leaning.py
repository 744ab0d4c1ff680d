"""Eq. B1: the contact forces under a load in any direction, on the surface or on every bead."""

# fmt: off
from functools import cache

import sympy
from force_diffusion.derivations import (
    eq05_contact_minus as eq05, eq07_load_split as eq07, eq08_propagation as eq08,
    eq10_branched_path as eq10, eq11_total_force as eq11)
from force_diffusion.derivations.framework.vocabulary import (
    Derivation, Groups, Steps, Theorem, axioms, equation, lattice, minus, rewrite, same, shown,
    terms, times, usual)
from force_diffusion.symbolic.symbols import (
    DeltaNMinus, DeltaNPlus, Dot, ForceMinus, ForcePlus, L_minus, L_plus, M, i, j, m, n, n_minus,
    n_plus, phi, t)
# fmt: on

ON_SURFACE = eq11.LAYERS.loaded(axioms.SURFACE_TILTED)
IN_BULK = eq11.LAYERS.loaded(axioms.BULK_TILTED)


def _along(own: sympy.Expr, turned: sympy.Expr) -> sympy.Add:
    """Eq. 11: ``own`` comes along n⁺, and of the other branch's load ``turned``/(1 − φ²) turns."""
    weight = turned / (1 - phi**2)
    return terms(
        own,
        times(own * phi / (1 - phi**2), Dot(n_minus, DeltaNPlus(i, j))),
        minus(times(weight, Dot(n_plus, DeltaNMinus(i + M - j + 1, M - 1)))),
        minus(times(weight, sympy.Sum(eq11.BRANCH, (n, 1, M - j - 1)))),
    )


FORCES = (
    equation(ForcePlus(i, j), _along(L_plus, t * L_plus)),
    equation(ForceMinus(i, j), lattice.mirror(_along(t * L_plus, L_plus))),
)
BULK = tuple(
    equation(force, sympy.Sum(value.xreplace({M: m}), (m, j + 1, M)))
    for force, value in (statement.args for statement in FORCES)
)
"""The same under a load on every bead: as surface loads of all heights m above the contact."""

PRINTED = (
    equation(ForcePlus(i, j) / L_plus, _along(sympy.S.One, t)),
    equation(ForceMinus(i, j) / L_minus, lattice.mirror(_along(sympy.S.One, 1 / t))),
)


@cache
def forces(load: str) -> tuple[Theorem, ...]:
    """Both forces under a leaning load on the "surface" or in the "bulk"."""
    statements, domain = (FORCES, ON_SURFACE) if load == "surface" else (BULK, IN_BULK)
    both = [(statement, domain) for statement in statements]
    return shown("B1", *eq07.carried_down(M - 1, axioms.loads(domain.loading), both))


@cache
def in_radii(load: str) -> Groups:
    """The forces and, in the radii, the directions of contacts."""
    return forces(load), eq05.directions()


def show_steps(steps: Steps) -> None:
    """From layer to layer down: what enters along n⁺ is L⁺, what turns into it was L⁻."""
    above = (i + 1, j + 1)
    steps.show(
        "Every bead passes on what it carries (Eq. 8 and its mirror image): f⁺ is what came along "
        "n⁺, and what branches off n⁻, which is of first order:",
        equation(
            ForcePlus(i, j),
            terms(
                times(ForcePlus(*above), eq08.straight(*above)),
                times(ForceMinus(*above), eq10.branched_plus(i, j, 1)),
            ),
        ),
        eq07.balancing(axioms.loads(axioms.SURFACE_TILTED)),
        ON_SURFACE.also(j <= M - 2),
    )
    steps.show(
        "Layer after layer, down from the surface, the changes along n⁺ cancel except for the "
        "last, and a part of L⁻ branches into f⁺ at each of M − j − 1 beads, as in Eq. 11. f⁻ is "
        "the mirror image, with L⁺ and L⁻ exchanged:",
        sympy.Tuple(*FORCES),
        tuple(map(same, forces("surface"))),
    )
    steps.show(
        "Divided by the two mean forces, L⁺ and L⁻:",
        sympy.Tuple(*PRINTED),
        rewrite(forces("surface")),
    )
    steps.show(
        "Under the same load on every bead, each layer m above the contact adds what it would add "
        "as the surface of a packing of height m:",
        sympy.Tuple(*BULK),
        tuple(map(same, forces("bulk"))),
        IN_BULK,
    )


DERIVATION = Derivation(
    number="B1",
    name="any_direction",
    title="Contact forces under a surface load in any direction",
    symbols=(
        (L_plus, "component of the load on each surface bead, −(L⁺n⁺ + L⁻n⁻), along n⁺"),
        (L_minus, "its component along n⁻"),
        (t, "L⁻/L⁺; 1 for a vertical load"),
        *usual(ForcePlus(i, j), ForceMinus(i, j), M),
        (n, "layers between the contact and the bead at which a force branches into it"),
    ),
    assumptions=(
        "first order in δr",
        *ON_SURFACE.in_words(),
        "L⁺ > 0 in the first part, L⁻ > 0 in the second",
        "no path meets a side wall (W > M)",
    ),
    printed=PRINTED,
    domain=ON_SURFACE,
    show_steps=show_steps,
    definitions={L_minus: t * L_plus},
    remarks=(
        "Only the changes along the other branch carry t, since the force that branches into f⁺ "
        "came along n⁻. As L⁻ goes to zero, f⁺ stays near L⁺, and only the tilt of its own contact "
        "changes it.",
    ),
)
