"""Eq. 6: force balance of the loaded bead, from the constraints that its contacts impose."""

from collections.abc import Iterator

import sympy
from force_diffusion.derivations import eq04_contact_plus as eq04
from force_diffusion.derivations import eq05_contact_minus as eq05
from force_diffusion.derivations.framework.follows import identity, linear, vector_identity
from force_diffusion.derivations.framework.record import Derivation, Step, Witness
from force_diffusion.derivations.witnesses.both_sides import compare, loaded_bead, search
from force_diffusion.symbolic.algebra.signs import never_zero
from force_diffusion.symbolic.as_printed import equation, terms, times
from force_diffusion.symbolic.kernel.decisions import (
    Ruling,
    all_of,
    cartesian,
    decide_identity,
    undecided,
)
from force_diffusion.symbolic.mechanics.balance import (
    FORCES,
    ORDER_0,
    ORDER_1,
    Solved,
    solve,
)
from force_diffusion.symbolic.symbols import (
    DeltaNMinus,
    DeltaNPlus,
    Dot,
    ForceMinus,
    ForcePlus,
    Load,
    e_y,
    epsilon,
    f_load,
    k,
    l,
    n_minus,
    n_plus,
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


ROOT = sympy.Symbol("D", positive=True)


def _differentiated(_: int, candidate: sympy.Eq) -> Ruling:
    """SymPy differentiates; the root is taken out, as a symbol with (x − X)² + … as its square."""

    def rational(side: sympy.Expr) -> sympy.Expr:
        return side.doit().xreplace({DISTANCE: ROOT, 1 / DISTANCE: 1 / ROOT})

    difference = rational(candidate.lhs) - rational(candidate.rhs)
    if not all(power.exp.is_Integer for power in difference.atoms(sympy.Pow)):
        return undecided("a root of another distance is left")
    difference = sympy.together(difference)
    return decide_identity(sympy.expand(difference).subs(ROOT**2, DISTANCE**2), sympy.Integer(0))


def steps() -> Iterator[Step]:
    """A frictionless contact pushes along the gradient of the distance of the two centres."""
    gradient = [sympy.Derivative(DISTANCE, axis) for axis in (x, y)]
    yield Step(
        "A frictionless contact opposes only a change of the distance of its two centres, (X, Y) "
        "for the support and (x, y): its force on the bead is f times the gradient of that "
        "distance, f ≥ 0 when compressive.",
        sympy.Tuple(
            *(
                equation(slope, apart / DISTANCE)
                for slope, apart in zip(gradient, (x - X, y - Y), strict=True)
            )
        ),
        _differentiated,
        positive=(DISTANCE**2,),
    )
    yield Step(
        "That gradient points from the support to the bead, and is a unit vector: n⁺ + δn⁺ from "
        "(k−1, l−1), n⁻ + δn⁻ from (k+1, l−1).",
        equation(terms(*(slope**2 for slope in gradient)), 1),
        _differentiated,
        ("step 1",),
        positive=(DISTANCE**2,),
    )
    yield Step("The load and the two forces add up to zero.", PRINTED, decide, ("step 1", "step 2"))
    yield Step(
        "In the ordered packing, with the load f_load downwards, both supports carry f_load/2n_y.",
        equation(f_load / (2 * n_y) * terms(n_plus, n_minus), f_load * e_y),
        vector_identity(),
        ("Eq. 6",),
    )
    yield Step(
        "The two directions enclose an angle with the cosine φ.",
        equation(Dot(n_plus, n_minus), phi),
        linear(),
    )


def pushed(direction: tuple[sympy.Expr, sympy.Expr]) -> list[sympy.Expr]:
    """Gradient of the distance, in Cartesian components, for a support in −``direction``.

    The centres are D apart along the unit vector ``direction``; SymPy differentiates the
    distance, then x − X = D N is put in.
    """
    gradient = [sympy.diff(DISTANCE, axis).xreplace({1 / DISTANCE: 1 / ROOT}) for axis in (x, y)]
    placed = {x: X + ROOT * direction[0], y: Y + ROOT * direction[1]}
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


def solving(system: Solved, dotted: str, uses: tuple[str, ...]) -> Iterator[Step]:
    """Three steps: the balance dotted with n⁺ and n⁻, solved, and expanded in ε."""
    put_in = dict(zip(FORCES, system.solution, strict=True))

    def is_row(part: int, candidate: sympy.Eq) -> Ruling:
        return decide_identity(candidate.lhs - candidate.rhs, system.balance[part])

    def is_solution(part: int, candidate: sympy.Eq) -> Ruling:
        zero = sympy.Integer(0)
        rows = (decide_identity(one.xreplace(put_in), zero) for one in system.balance)
        return all_of(identity(put_in)(part, candidate), *rows)

    at_zero = [one.subs(epsilon, 0) for one in system.solution]
    slopes = [sympy.diff(one, epsilon).subs(epsilon, 0) for one in system.solution]
    orders = dict(zip((*ORDER_0, *ORDER_1), (*at_zero, *slopes), strict=True))
    yield Step(dotted, sympy.Tuple(*system.rows), is_row, uses)
    yield Step(
        "Solved, the adjugate of the matrix over its determinant:",
        sympy.Tuple(*map(equation, FORCES, system.solution)),
        is_solution,
        ("step 1",),
        positive=(system.determinant,),
    )
    yield Step(
        "Expanded in ε, the values at ε = 0 and the derivatives there:",
        sympy.Tuple(*map(equation, orders, (*system.at_zero, *system.slope))),
        identity(orders),
        ("step 2",),
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
    loads=("single",),
    steps=steps,
    decide=decide,
    search=search("single", loaded_bead),
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
