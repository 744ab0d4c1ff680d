"""Attacks on ``suppose``: what rests on it is no theorem until its induction has ended."""

from force_diffusion.symbolic.as_printed import equation
from force_diffusion.symbolic.kernel import axioms, rules
from force_diffusion.symbolic.kernel.theorem import NotProvedError, Supposition, Theorem
from force_diffusion.symbolic.kernel.where import SURFACE, Where
from force_diffusion.symbolic.symbols import (
    ForcePlus,
    Load,
    M,
    Position,
    e_y,
    i,
    j,
    n_minus,
    n_plus,
    q,
    r,
    site_r,
    site_s,
)
from sympy import Eq, Expr, Integer

from .attack import (
    BEADS,
    HERE,
    ON_SURFACE,
    ONE,
    ORIGIN,
    attack,
    displaced,
    told,
)

ANY_NUMBER = Where((q,))


def _supposed(left: Expr, right: Expr, where: Where = ANY_NUMBER) -> Theorem:
    """What is wrong, supposed."""
    return rules.suppose(equation(left, right), where, Supposition(q), 1)


WRONG = _supposed(ORIGIN, e_y)
_UP = axioms.ordered()[1]
_FROM = Position(i, j) + 2 * r * n_plus
_UP_TO = Position(i + 1, j + 1)


def _closed(theorem: Theorem) -> Theorem:
    """What rests on nothing that is only supposed."""
    if theorem.supposed:
        raise NotProvedError("it rests on what is only supposed")
    return theorem


def _reached() -> Theorem:
    wrong = _supposed(Position(0, 0), n_plus)
    value = r * (j + i) * n_plus + r * (j - i) * n_minus + n_plus
    return told(rules.reach(wrong, axioms.ordered()[1:]), Position(i, j), value)


def _carried() -> Theorem:
    no_load = _supposed(Load(site_r, site_s), Integer(0), Where.of(site_s >= 0, indices=(q,)))
    where = Where.of(j >= 0, Eq(j, M - 1), loading=SURFACE)
    rule = rules.below(axioms.balance(), no_load, ON_SURFACE)
    return told(rule, ForcePlus(i, j), 0, where)


for rule, attempt in {
    "rewrite": lambda: told(rules.rewrite(WRONG), ORIGIN, e_y, ANY_NUMBER),
    "follows": lambda: told(rules.follows(WRONG), 2 * ORIGIN, 2 * e_y, ANY_NUMBER),
    "follows, put in": lambda: told(rules.follows(_UP, WRONG), *_UP.formula.args),
    "along": lambda: rules.along(WRONG, n_plus),
    "order": lambda: told(rules.order(WRONG, 0), ORIGIN, e_y, ANY_NUMBER),
    "solve": lambda: told(rules.solve([WRONG], [ORIGIN]), ORIGIN, e_y, ANY_NUMBER),
    "solve, put in": lambda: told(rules.solve([_UP], [_UP_TO], WRONG), _UP_TO, _FROM),
    "below": _carried,
    "cases": lambda: rules.cases(rules.rewrite(WRONG), (q >= 1,), (q <= 0,))(
        displaced(ONE), ANY_NUMBER
    ),
    "instance": lambda: rules.instance(WRONG, {}, ANY_NUMBER),
    "in_terms_of": lambda: rules.in_terms_of({}, {}, ANY_NUMBER, rules.rewrite(WRONG))(
        displaced(ONE), ANY_NUMBER
    ),
    "mirror": lambda: rules.mirror(WRONG),
    "reach": _reached,
}.items():
    attack("suppose", f"and {rule}", "bead (0, 0) stays where it is, and is loaded", "supposed")(
        lambda tried=attempt: _closed(tried())  # type: ignore[misc]
    )
attack("suppose", "no statement", "it vanishes in layer 3", "not shown to differ")(
    lambda: rules.suppose(equation(HERE, 1 / (j - 3)), BEADS, Supposition(j), 1)
)
