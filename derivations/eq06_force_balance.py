"""Eq. 6: force balance of the loaded bead, from the constraints that its contacts impose."""

from functools import cache

import sympy
from force_diffusion.derivations import eq04_contact_plus as eq04
from force_diffusion.derivations import eq05_contact_minus as eq05
from force_diffusion.derivations.framework.grounds import Source
from force_diffusion.derivations.framework.proving import Line, Meaning
from force_diffusion.derivations.framework.vocabulary import (
    Derivation,
    Lines,
    Where,
    along,
    axioms,
    differentiate,
    equation,
    follows,
    rewrite,
    solve,
    terms,
    times,
)
from force_diffusion.symbolic.kernel.rules import instance
from force_diffusion.symbolic.kernel.theorem import Theorem
from force_diffusion.symbolic.kernel.where import LOADED, Loading
from force_diffusion.symbolic.mechanics.balance import FORCES, ORDER_0, ORDER_1, Solved
from force_diffusion.symbolic.mechanics.balance import solve as solve_balance
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
    site_r,
    site_s,
)

WHERE = Where.of(l >= 1, loading=LOADED)
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


@cache
def _balance() -> Theorem:
    """The balance of bead (k, l)."""
    return instance(axioms.balance(), {site_r: k, site_s: l}, Where.of(l >= 1))


@cache
def steps() -> Lines:
    """A frictionless contact pushes along the gradient of the distance of the two centres."""
    lines = Lines(WHERE)
    gradient = [sympy.Derivative(DISTANCE, axis) for axis in (x, y)]
    pushes = lines.show(
        "A frictionless contact opposes only a change of the distance of its two centres, (X, Y) "
        "for the support and (x, y): its force on the bead is f times the gradient of that "
        "distance, f ≥ 0 when compressive.",
        sympy.Tuple(
            *(
                equation(slope, apart / DISTANCE)
                for slope, apart in zip(gradient, (x - X, y - Y), strict=True)
            )
        ),
        differentiate(ROOT, DISTANCE**2),
        where=Where(),
    )
    unit = lines.show(
        "That gradient points from the support to the bead, and is a unit vector: n⁺ + δn⁺ from "
        "(k−1, l−1), n⁻ + δn⁻ from (k+1, l−1).",
        equation(terms(*(slope**2 for slope in gradient)), 1),
        differentiate(ROOT, DISTANCE**2, pushes),
        where=Where(),
    )
    printed = lines.show(
        "The load and the two forces add up to zero.",
        PRINTED,
        follows(_balance(), axioms.loads(LOADED)),
        after=(pushes, unit),
    )
    lines.show(
        "In the ordered packing, with the load f_load downwards, both supports carry f_load/2n_y.",
        equation(f_load / (2 * n_y) * terms(n_plus, n_minus), f_load * e_y),
        rewrite(printed),
    )
    lines.show(
        "The two directions enclose an angle with the cosine φ.",
        equation(Dot(n_plus, n_minus), phi),
        rewrite(),
    )
    return lines


def solved(carried: sympy.Expr, across: sympy.Expr, layer: sympy.Expr) -> Solved:
    """The forces below bead (across, layer) when it has to carry ``carried`` (a vector)."""
    at = {k: across, l: layer}
    forces = (ForcePlus(*LEFT).xreplace(at), ForceMinus(*RIGHT).xreplace(at))
    return solve_balance(PRINTED.lhs.xreplace(at), forces, Load(k, l).xreplace(at), carried)


def solving(
    lines: Lines,
    system: Solved,
    dotted: str,
    balance: Source,
    unit: Meaning,
    *facts: Source,
    after: tuple[Derivation, ...] = (),
) -> Line:
    """Three lines: the balance dotted with n⁺ and n⁻, solved, and expanded in ε.

    ``unit`` says what the forces F^± of the system are; ``after`` names what the text refers to.
    """
    rows = lines.show(
        dotted,
        sympy.Tuple(*system.rows),
        (along(balance, n_plus, *facts), along(balance, n_minus, *facts)),
        meaning={**unit, **system.meaning, epsilon: sympy.Integer(1)},
        after=after,
    )
    obeyed = Loading("system", "F⁺ and F⁻ obey the two equations", given=system.rows)
    solution = lines.show(
        "Solved, the adjugate of the matrix over its determinant:",
        sympy.Tuple(*map(equation, FORCES, system.solution)),
        solve(axioms.loads(obeyed), FORCES),
        where=Where(loading=obeyed),
        after=(rows,),
    )
    at_zero = [one.subs(epsilon, 0) for one in system.solution]
    slopes = [sympy.diff(one, epsilon).subs(epsilon, 0) for one in system.solution]
    orders = dict(zip((*ORDER_0, *ORDER_1), (*at_zero, *slopes), strict=True))
    return lines.show(
        "Expanded in ε, the values at ε = 0 and the derivatives there:",
        sympy.Tuple(*map(equation, orders, (*system.at_zero, *system.slope))),
        rewrite(),
        where=Where(),
        meaning=orders,
        after=(solution,),
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
        *WHERE.in_words(),
    ),
    premises=(eq04.DERIVATION, eq05.DERIVATION),
    printed=(PRINTED,),
    loads=("single",),
    steps=steps,
    where=WHERE,
)

if __name__ == "__main__":
    from force_diffusion.derivations.commands.alone import run_alone

    raise SystemExit(run_alone(DERIVATION))
