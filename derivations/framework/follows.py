"""How a step follows: what is known is put in, and both sides are compared."""

from collections.abc import Callable, Mapping
from typing import Any

import sympy
from force_diffusion.symbolic.algebra.affine import Region
from force_diffusion.symbolic.algebra.bases import LINE_SUM, Basis
from force_diffusion.symbolic.algebra.exact import NotExactError
from force_diffusion.symbolic.as_printed import equation, terms
from force_diffusion.symbolic.kernel.decisions import (
    Ruling,
    decide_identity,
    decide_linear,
    decide_vector_identity,
    equal_forms,
    proved,
    undecided,
)
from force_diffusion.symbolic.printing.text import text
from force_diffusion.symbolic.variances.certified_sums import carried_out

Decide = Callable[[int, sympy.Eq], Ruling]
Known = Mapping[Any, Any]
"""What stands for a symbol; for a kind of lattice quantity: a function of its site."""


def put_in(expression: sympy.Expr, known: Known) -> sympy.Expr:
    """Put in what is known, one after the other."""
    for what, image in known.items():
        if isinstance(what, type):
            expression = expression.replace(what, image)
        else:
            expression = expression.xreplace({what: image})
    return expression


def linear(
    known: Known | None = None,
    region: Region | None = None,
    *,
    is_vector: bool = False,
    basis: Basis = LINE_SUM,
) -> Decide:
    """Both sides have the same normal form for all indices of the region."""
    where = region or Region({})

    def decide(_: int, candidate: sympy.Eq) -> Ruling:
        left, right = (put_in(side, known or {}) for side in candidate.args)
        return _normal_forms_first(left, right, where, is_vector=is_vector, basis=basis)

    return decide


def identity(known: Known | None = None) -> Decide:
    """Both sides are the same rational function."""
    return lambda _, candidate: decide_identity(
        put_in(candidate.lhs, known or {}), put_in(candidate.rhs, known or {})
    )


def summed(known: Known | None = None) -> Decide:
    """Both sides are the same rational function once their sums are carried out, certified."""
    return lambda _, candidate: decide_identity(
        *(carried_out(put_in(side, known or {})) for side in candidate.args)
    )


def certificate(total: sympy.Sum, up_to_n: sympy.Expr) -> tuple[sympy.Eq, sympy.Eq]:
    """What a sum up to n is, and its term at n as what that gains there: two lines of a step."""
    index, _, high = total.limits[0]
    parts = up_to_n.args if isinstance(up_to_n, sympy.Add) else (up_to_n,)
    after = [part for part in parts if part.has(high)]  # the others cancel
    before = [-part.xreplace({high: high - 1}) for part in after]
    term = total.function.xreplace({index: high})
    return equation(total, up_to_n), equation(term, terms(*after, *before))


def differentiated() -> Decide:
    """Both sides are the same once SymPy has differentiated."""
    return lambda _, candidate: decide_identity(candidate.lhs.doit(), candidate.rhs.doit())


def vector_identity(known: Known | None = None) -> Decide:
    """Both sides have the same Cartesian components."""
    return lambda _, candidate: decide_vector_identity(
        put_in(candidate.lhs, known or {}), put_in(candidate.rhs, known or {})
    )


def states(*known: sympy.Eq, region: Region | None = None) -> Decide:
    """Each candidate says what a known equation says, of the same left-hand side."""

    def decide(part: int, candidate: sympy.Eq) -> Ruling:
        if candidate == known[part]:
            return proved("what is known, put in")
        if candidate.lhs != known[part].lhs:
            return undecided(f"the left-hand side is not {text(known[part].lhs)}")
        return _normal_forms_first(candidate.rhs, known[part].rhs, region or Region({}))

    return decide


def _normal_forms_first(
    left: sympy.Expr,
    right: sympy.Expr,
    region: Region,
    *,
    is_vector: bool = False,
    basis: Basis = LINE_SUM,
) -> Ruling:
    """As ``decide_linear``, but packings are asked only where the normal forms differ.

    Every printed equation is tried with packings as well; steps are many, and would take long.
    """
    try:
        if equal := equal_forms(left, right, region, is_vector=is_vector, basis=basis):
            return equal
    except NotExactError:
        pass
    return decide_linear(left, right, region, is_vector=is_vector, basis=basis)


def at(statement: sympy.Eq, place: Mapping[Any, Any]) -> sympy.Eq:
    """A known equation at another place."""
    return equation(*(side.xreplace(place) for side in statement.args))
