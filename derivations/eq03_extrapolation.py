"""Eq. 3: the displacement in terms of the radii alone, by induction from the base."""

from functools import cache

import sympy
from force_diffusion.derivations import eq02_displacement as eq02
from force_diffusion.derivations.framework.vocabulary import (
    SUPPOSED,
    Derivation,
    Lines,
    Where,
    axioms,
    equation,
    induct,
    rewrite,
    supposing,
    terms,
    times,
)
from force_diffusion.symbolic.symbols import (
    DeltaR,
    DeltaX,
    Dot,
    b_minus,
    b_plus,
    i,
    j,
    m,
    n_minus,
    n_plus,
)

WHERE = Where.of(j >= 1)

PRINTED = equation(
    DeltaX(i, j),
    terms(
        times(
            terms(
                DeltaR(i - j, 0),
                DeltaR(i, j),
                times(2, sympy.Sum(DeltaR(i - (j - m), m), (m, 1, j - 1))),
            ),
            b_plus,
        ),
        times(
            terms(
                DeltaR(i + j, 0),
                DeltaR(i, j),
                times(2, sympy.Sum(DeltaR(i + (j - m), m), (m, 1, j - 1))),
            ),
            b_minus,
        ),
    ),
)

FIRST_LAYER = terms(
    times(terms(DeltaR(i, 1), DeltaR(i - 1, 0)), b_plus),
    times(terms(DeltaR(i, 1), DeltaR(i + 1, 0)), b_minus),
)


def _along(across: sympy.Expr, layer: sympy.Expr) -> tuple[sympy.Expr, sympy.Expr]:
    """n⁺·δx and n⁻·δx, as they are printed."""
    at = {i: across, j: layer}
    along_plus, along_minus = (term.args[0].xreplace(at) for term in PRINTED.rhs.args)
    return along_plus, along_minus


@cache
def steps() -> Lines:
    """Base case on the fixed base, then one step of Eq. 2 with symbolic i and j."""
    lines = Lines(WHERE)
    resting = eq02.DERIVATION
    above = WHERE.also(j >= 2)
    first = lines.show(
        "The base is held, δx_(i,0) = 0. A bead of layer 1 rests on two such beads. What Eq. 2 "
        "gives is the printed equation at j = 1, where both of its sums are empty.",
        equation(DeltaX(i, 1), FIRST_LAYER),
        rewrite(resting, axioms.base()),
        where=WHERE.put_in({j: sympy.Integer(1)}, (i,)),
    )
    left, right = _along(i - 1, j - 1)[0], _along(i + 1, j - 1)[1]
    step = lines.show(
        "Suppose that it holds in layer j − 1 ≥ 1. The support to the left lies on the "
        "same diagonal towards the base, so that n⁺·δx gains the two radii of the new "
        "contact, and likewise to the right.",
        sympy.Tuple(
            equation(Dot(n_plus, DeltaX(i, j)), terms(left, DeltaR(i, j), DeltaR(i - 1, j - 1))),
            equation(Dot(n_minus, DeltaX(i, j)), terms(right, DeltaR(i, j), DeltaR(i + 1, j - 1))),
        ),
        supposing(PRINTED, WHERE, j, rewrite(resting, SUPPOSED)),
        where=above,
    )
    lines.show(
        "The radius of the support is counted once by its own formula and once by the new "
        "contact: it joins the sum with the weight 2. This is the printed equation in "
        "layer j.",
        PRINTED,
        induct(j, 1, rewrite(resting, axioms.base()), rewrite(resting, SUPPOSED)),
        after=(first, step),
    )
    zero = sympy.Integer(0)
    empty = dict.fromkeys(PRINTED.rhs.atoms(sympy.Sum), zero)
    lines.claim(
        "at j = 0 the printed sums, read as empty, would leave 2δr_(i,0)(b⁺ + b⁻), not 0",
        equation(
            PRINTED.rhs.xreplace(empty).xreplace({j: zero}), 2 * DeltaR(i, 0) * (b_plus + b_minus)
        ),
        rewrite(),
        where=Where.of(j >= 0).put_in({j: zero}, (i,)),
    )
    return lines


DERIVATION = Derivation(
    number=3,
    name="extrapolation",
    title="Displacements in terms of the radii",
    symbols=(
        (DeltaX(i, j), "displacement of bead (i, j)"),
        (DeltaR(i, j), "deviation of the radius of bead (i, j)"),
        (m, "layer of a bead on one of the two diagonals down to the base"),
        (b_plus, "reciprocal vector: n⁺·b⁺ = 1, n⁻·b⁺ = 0"),
        (b_minus, "reciprocal vector: n⁻·b⁻ = 1, n⁺·b⁻ = 0"),
    ),
    assumptions=(
        "first order in δr",
        "the centres of the base beads are fixed: δx_(i,0) = 0",
        "no horizontal boundary is met",
        *WHERE.in_words(),
    ),
    premises=(eq02.DERIVATION,),
    printed=(PRINTED,),
    steps=steps,
    where=WHERE,
    remarks=(
        "The printed formula is for j ≥ 1. At j = 0 its empty sums leave 2δr_(i,0)(b⁺ + b⁻), "
        "while the base is fixed: δx_(i,0) = 0 is a condition of its own.",
    ),
)

if __name__ == "__main__":
    from force_diffusion.derivations.commands.alone import run_alone

    raise SystemExit(run_alone(DERIVATION))
