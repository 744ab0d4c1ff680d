"""Eq. 6: force balance of the loaded bead, from the constraints that its contacts impose."""

from collections.abc import Iterator

import sympy
from force_diffusion.derivations import eq04_contact_plus as eq04
from force_diffusion.derivations import eq05_contact_minus as eq05
from force_diffusion.derivations.framework.record import Claim, Derivation, Step, Witness
from force_diffusion.derivations.witnesses.both_sides import compare, loaded_bead, search
from force_diffusion.symbolic.algebra.signs import never_zero
from force_diffusion.symbolic.as_printed import equation, terms, times
from force_diffusion.symbolic.kernel.decisions import (
    Ruling,
    all_of,
    cartesian,
    decide_identity,
    decide_vector_identity,
)
from force_diffusion.symbolic.mechanics.balance import Solved, solve
from force_diffusion.symbolic.symbols import (
    DeltaNMinus,
    DeltaNPlus,
    ForceMinus,
    ForcePlus,
    Load,
    e_y,
    f_load,
    k,
    l,
    n_minus,
    n_plus,
    n_x,
    n_y,
    phi,
)

LEFT, RIGHT = (k - 1, l - 1), (k + 1, l - 1)

PRINTED = equation(
    terms(
        Load(k, l),
        times(terms(n_plus, DeltaNPlus(*LEFT)), ForcePlus(*LEFT)),
        times(terms(n_minus, DeltaNMinus(*RIGHT)), ForceMinus(*RIGHT)),
    ),
    sympy.Integer(0),
)

# a support at (X, Y) pushes on the bead at (x, y) along the gradient of their distance
x, y, X, Y = sympy.symbols("x y X Y", real=True)
DISTANCE = sympy.sqrt((x - X) ** 2 + (y - Y) ** 2)


def steps() -> Iterator[Step]:
    """A frictionless contact pushes along the gradient of the distance of the two centres."""
    yield Step(
        "A frictionless contact opposes only a change of the distance of its two centres: "
        "its force on the bead is f times the gradient of that distance, f ≥ 0 when "
        "compressive.",
        sympy.Tuple(DISTANCE, sympy.diff(DISTANCE, x), sympy.diff(DISTANCE, y)),
    )
    yield Step(
        "That gradient is the unit vector from the support to the bead: from (k−1, l−1) "
        "along n⁺, from (k+1, l−1) along n⁻.",
        sympy.Tuple(terms(n_plus, DeltaNPlus(*LEFT)), terms(n_minus, DeltaNMinus(*RIGHT))),
    )
    yield Step("The load and the two forces add up to zero.", PRINTED)
    yield Step(
        "In the ordered packing, with the load f_load downwards, both supports carry f_load/2n_y.",
        equation(f_load / (2 * n_y) * terms(n_plus, n_minus), f_load * e_y),
    )


def pushed(direction: tuple[sympy.Expr, sympy.Expr]) -> list[sympy.Expr]:
    """Gradient of the distance, in Cartesian components, for a support in −``direction``.

    The centres are D apart along the unit vector ``direction``; SymPy differentiates the
    distance, then x − X = D N is put in.
    """
    root = sympy.Symbol("D", positive=True)
    gradient = [sympy.diff(DISTANCE, axis).xreplace({1 / DISTANCE: 1 / root}) for axis in (x, y)]
    placed = {x: X + root * direction[0], y: Y + root * direction[1]}
    return [sympy.expand(part.xreplace(placed)) for part in gradient]


def decide(_: int, candidate: sympy.Eq) -> Ruling:
    """Compare with load + Σ f ∇(distance) = 0, component by component, for any directions.

    A multiple says the same when its factor vanishes nowhere: the factor of the load.
    """
    rulings = []
    load, sides = cartesian(Load(k, l), 0), cartesian(candidate.lhs - candidate.rhs, 0)
    factor = sympy.expand(sides).coeff(load)
    if not never_zero(factor):
        factor = sympy.Integer(1)
    contacts = (
        (ForcePlus(*LEFT), n_plus + DeltaNPlus(*LEFT)),
        (ForceMinus(*RIGHT), n_minus + DeltaNMinus(*RIGHT)),
    )
    for axis in range(2):
        balance = cartesian(Load(k, l), axis)
        for force, unit in contacts:
            balance += force * pushed((cartesian(unit, 0), cartesian(unit, 1)))[axis]
        rulings.append(
            decide_identity(cartesian(candidate.lhs - candidate.rhs, axis), factor * balance)
        )
    return all_of(*rulings)


def solved(carried: sympy.Expr, across: sympy.Expr, layer: sympy.Expr) -> Solved:
    """The forces below bead (across, layer) when it has to carry ``carried`` (a vector)."""
    at = {k: across, l: layer}
    forces = (ForcePlus(*LEFT).xreplace(at), ForceMinus(*RIGHT).xreplace(at))
    return solve(PRINTED.lhs.xreplace(at), forces, Load(k, l).xreplace(at), carried)


def _gradient_is_unit_vector() -> Ruling:
    # the square root is taken out: D ∂D/∂x = x − X, and the components' squares add up to one
    gradient = [sympy.diff(DISTANCE, axis) for axis in (x, y)]
    squared = DISTANCE**2
    root = sympy.Symbol("D", positive=True)
    in_root = [part.xreplace({DISTANCE: root, 1 / DISTANCE: 1 / root}) for part in gradient]
    return all_of(
        decide_identity(in_root[0] * root, x - X),
        decide_identity(in_root[1] * root, y - Y),
        decide_identity((in_root[0] ** 2 + in_root[1] ** 2) * root**2, squared),
    )


def _ordered_solution() -> Ruling:
    """The ordered forces f_load/2n_y carry the load; and n⁺·n⁻ = φ."""
    return all_of(
        decide_vector_identity(f_load / (2 * n_y) * (n_plus + n_minus), f_load * e_y),
        decide_identity(n_y**2 - n_x**2, phi),
    )


DERIVATION = Derivation(
    number=6,
    name="force_balance",
    title="Force balance of the loaded bead",
    symbols=(
        (Load(k, l), "load on bead (k, l)"),
        (ForcePlus(k - 1, l - 1), "force of the contact from (k−1, l−1), compressive when > 0"),
        (ForceMinus(k + 1, l - 1), "force of the contact from (k+1, l−1)"),
    ),
    assumptions=(
        "no friction; contacts push along the line of centres",
        "bead (k, l) carries nothing but its load",
    ),
    premises=(eq04.DERIVATION, eq05.DERIVATION),
    printed=(PRINTED,),
    steps=steps,
    decide=decide,
    search=search("single", loaded_bead),
    claims=(
        Claim(
            "the gradient of the distance is the unit vector from the support to the bead",
            _gradient_is_unit_vector,
        ),
        Claim("two forces f_load/2n_y along n⁺ and n⁻ carry the load f_load", _ordered_solution),
    ),
    witnesses=(
        Witness(
            "an exact packing obeys it, both sides at orders ε⁰ and ε¹",
            lambda packing: compare(PRINTED, packing, "single", loaded_bead),
        ),
    ),
)

if __name__ == "__main__":
    from force_diffusion.derivations.commands.alone import run_alone

    raise SystemExit(run_alone(DERIVATION))
