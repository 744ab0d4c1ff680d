"""The mean of a contact's force at second order, from the balance of the bead above it.

What loads and forces a loading states do not fluctuate, at any order. Along b⁺ the contact forces
f⁺ of a bead count, and what the changes of all four directions carry: of each contact that is known
from covariances of first-order quantities. So ⟨f⁺⟩ below a bead follows from ⟨f⁺⟩ above it; b⁻ and
f⁻ are the mirror image.
"""

import sympy

from .. import symbols as sy
from ..algebra.exact import FIELD, RationalFunction
from ..printing.text import text
from . import axioms, moments, second_order
from .rules import BRANCHES, Rule, instance
from .theorem import (
    Facts,
    NotProvedError,
    Theorem,
    check,
    flat,
    isolated,
    made,
    put_in,
)
from .where import Where


def mean_below(*facts: Theorem | tuple[Theorem, ...]) -> Rule:
    """The mean of a contact's force at second order, less its ordered value.

    Args:
        facts: what gives all four forces of the bead above in the radii, to be put in one after the
            other, and what is known of the mean of the upper one of the same branch.
    """

    def rule(formula: sympy.Eq, where: Where) -> Theorem:
        check(formula, where)
        about, stated = isolated(formula, where)
        if not isinstance(about, sy.Shift):
            raise NotProvedError(f"{text(about)} is not the mean of a contact's force")
        (force,) = about.args
        loads = axioms.loads(where.loading) if where.loading else ()
        found = _from_above(force, where, (loads, *facts))
        if not (found - FIELD.from_sympy(stated.xreplace(where.solved))).is_zero():
            raise NotProvedError("the mean balance of the bead above gives another value")
        return made(formula, where, "mean balance of the bead above", flat(facts))

    return rule


def _from_above(force: sympy.Expr, where: Where, facts: Facts) -> RationalFunction:
    own, other = type(force), next(one for one in BRANCHES if one is not type(force))
    side = BRANCHES[own]
    across, layer = force.args
    bead = (sympy.expand(across + side), sympy.expand(layer + 1))
    instance(axioms.balance(), dict(zip((sy.site_r, sy.site_s), bead, strict=True)), where)
    load = put_in(sy.Load(*bead), facts[:1], where, ())
    if load.has(sy.SiteFunction):
        raise NotProvedError(f"whether {text(sy.Load(*bead))} fluctuates is not known")
    above = own(*bead)
    total = FIELD.zero
    if put_in(above, facts[:1], where, ()).has(sy.SiteFunction):
        total = moments.value(sy.Shift(above), facts, where)
    beside = other(sympy.expand(bead[0] + side), layer)
    for one, sign in ((above, 1), (other(*bead), 1), (force, -1), (beside, -1)):
        turned = second_order.turned(one, side, where, lambda of, at: moments.value(of, facts, at))
        total = total + FIELD.constant(sign) * turned
    return total.reduced()
