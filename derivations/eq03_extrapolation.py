"""Eq. 3: the displacement in terms of the radii alone, by induction from the base."""

from collections.abc import Iterator
from functools import cache

import sympy
from force_diffusion.derivations import eq02_displacement as eq02
from force_diffusion.derivations.framework.follows import linear
from force_diffusion.derivations.framework.record import Claim, Derivation, Step, Witness
from force_diffusion.derivations.witnesses import remainders
from force_diffusion.derivations.witnesses.both_sides import about, compare, each_bead, search
from force_diffusion.symbolic.algebra.affine import Region
from force_diffusion.symbolic.as_printed import equation, terms, times
from force_diffusion.symbolic.kernel.decisions import Ruling, Verdict, all_of, decide_linear, proved
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

NOTHING = sympy.Integer(0)


@cache
def displacement(across: sympy.Expr, layer: sympy.Expr) -> sympy.Expr:
    """δx at a site of layer 1 or above, as a vector expression in the radii (Eq. 3)."""
    return PRINTED.rhs.xreplace({i: across, j: layer})


@cache
def _at(candidate: sympy.Expr, across: sympy.Expr, layer: sympy.Expr) -> sympy.Expr:
    return candidate.xreplace({i: across, j: layer})


def _resting(across: sympy.Expr, layer: sympy.Expr) -> sympy.Expr:
    """δx of a bead on its supports (Eq. 2), and on the fixed base."""
    if layer == 0:
        return NOTHING
    at = {i: across, j: layer}
    return eq02.resting_on(eq02.LEFT, eq02.RIGHT).xreplace(at).replace(DeltaX, _held)


def _held(across: sympy.Expr, layer: sympy.Expr) -> sympy.Expr:
    return NOTHING if layer == 0 else DeltaX(across, layer)


FIRST_LAYER = terms(
    times(terms(DeltaR(i, 1), DeltaR(i - 1, 0)), b_plus),
    times(terms(DeltaR(i, 1), DeltaR(i + 1, 0)), b_minus),
)


def _first_layer(_: int, candidate: sympy.Eq) -> Ruling:
    """Eq. 2 on the fixed base, and the printed equation there."""
    printed = {DeltaX(i, 1): _at(PRINTED.rhs, i, sympy.Integer(1))}
    return all_of(
        *(linear(known, is_vector=True)(0, candidate) for known in ({DeltaX: _resting}, printed))
    )


def _along(across: sympy.Expr, layer: sympy.Expr) -> tuple[sympy.Expr, sympy.Expr]:
    """n⁺·δx and n⁻·δx, as they are printed."""
    along_plus, along_minus = (_at(term.args[0], across, layer) for term in PRINTED.rhs.args)
    return along_plus, along_minus


def steps() -> Iterator[Step]:
    """Base case on the fixed base, then one step of Eq. 2 with symbolic i and j."""
    yield Step(
        "The base is held, δx_(i,0) = 0. A bead of layer 1 rests on two such beads. What Eq. 2 "
        "gives is the printed equation at j = 1, where both of its sums are empty.",
        equation(DeltaX(i, 1), FIRST_LAYER),
        _first_layer,
        ("Eq. 2",),
    )
    left, right = _along(i - 1, j - 1)[0], _along(i + 1, j - 1)[1]
    yield Step(
        "Suppose that it holds in layer j − 1 ≥ 1. The support to the left lies on the "
        "same diagonal towards the base, so that n⁺·δx gains the two radii of the new "
        "contact, and likewise to the right.",
        sympy.Tuple(
            equation(Dot(n_plus, DeltaX(i, j)), terms(left, DeltaR(i, j), DeltaR(i - 1, j - 1))),
            equation(Dot(n_minus, DeltaX(i, j)), terms(right, DeltaR(i, j), DeltaR(i + 1, j - 1))),
        ),
        linear({DeltaX(i, j): _from_the_layer_below(PRINTED.rhs)}, LAYERS_ABOVE),
        ("Eq. 2",),
    )
    yield Step(
        "The radius of the support is counted once by its own formula and once by the new "
        "contact: it joins the sum with the weight 2. This is the printed equation in "
        "layer j.",
        PRINTED,
        decide,
        ("step 1", "step 2"),
    )


LAYERS_ABOVE = Region({j: 2})


def _from_the_layer_below(supposed: sympy.Expr) -> sympy.Expr:
    """δx_ij by Eq. 2, its supports having what is supposed."""
    return eq02.resting_on(_at(supposed, i - 1, j - 1), _at(supposed, i + 1, j - 1))


def decide(_: int, candidate: sympy.Eq) -> Ruling:
    """Base case j = 1, and the inductive step for symbolic j ≥ 2."""
    if other := about(candidate, DeltaX(i, j), "none", each_bead):
        return other
    one = sympy.Integer(1)
    base = decide_linear(
        _at(candidate.rhs, i, one),
        _at(eq02.resting_on(NOTHING, NOTHING), i, one),
        Region({}),
        is_vector=True,
    )
    step = decide_linear(
        candidate.rhs, _from_the_layer_below(candidate.rhs), LAYERS_ABOVE, is_vector=True
    )
    ruling = all_of(base, step)
    if ruling.verdict is Verdict.PROVED:
        return proved("base case j = 1 and inductive step with symbolic i and j ≥ 2")
    return ruling


def _at_the_base() -> Ruling:
    """Its sums from 1 to −1 have no terms to be read; SymPy would take the layer 0 off."""
    empty = displacement(i, NOTHING).replace(sympy.Sum, lambda *_: NOTHING)
    return decide_linear(empty, 2 * DeltaR(i, 0) * (b_plus + b_minus), Region({}), is_vector=True)


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
        "j ≥ 1; no horizontal boundary is met",
    ),
    premises=(eq02.DERIVATION,),
    printed=(PRINTED,),
    steps=steps,
    decide=decide,
    search=search("none", each_bead),
    claims=(
        Claim(
            "at j = 0 the printed sums, read as empty, would leave 2δr_(i,0)(b⁺ + b⁻), not 0",
            _at_the_base,
        ),
    ),
    witnesses=(
        Witness(
            "an exact packing obeys it, both sides at orders ε⁰ and ε¹",
            lambda packing: compare(PRINTED, packing, "none", each_bead),
        ),
        Witness(
            "exact positions at 80 digits differ from it by a remainder of order ε²",
            lambda packing: remainders.positions(PRINTED.rhs, packing),
        ),
    ),
    remarks=(
        "The printed formula is for j ≥ 1. At j = 0 its empty sums leave 2δr_(i,0)(b⁺ + b⁻), "
        "while the base is fixed: δx_(i,0) = 0 is a condition of its own.",
    ),
)

if __name__ == "__main__":
    from force_diffusion.derivations.commands.alone import run_alone

    raise SystemExit(run_alone(DERIVATION))
