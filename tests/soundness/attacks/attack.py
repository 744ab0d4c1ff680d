"""Attacks on the kernel: what must not become a theorem, tried by its own rules on every run.

Each names what is tried, why that is false (or no statement at all), and in which words it is to be
refused. For each guard of a rule there is at least one that comes through once the guard is gone;
``.ci/guards`` takes them away one at a time.
"""

from collections.abc import Callable
from dataclasses import dataclass

import sympy
from force_diffusion.symbolic.algebra.exact import NotExactError
from force_diffusion.symbolic.as_printed import equation, times
from force_diffusion.symbolic.kernel import axioms, rules
from force_diffusion.symbolic.kernel.rules import Rule
from force_diffusion.symbolic.kernel.theorem import (
    NotProvedError,
    Supposition,
    Theorem,
    check,
    made,
)
from force_diffusion.symbolic.kernel.where import LOADED, SURFACE, Where
from force_diffusion.symbolic.symbols import (
    DeltaR,
    DeltaX,
    ForceMinus,
    ForcePlus,
    Load,
    M,
    e_y,
    i,
    j,
    k,
    l,
    n,
    p,
    q,
)
from sympy import Eq, Integer, Pow, Sum

REFUSALS = (NotProvedError, NotExactError)
"""How the kernel refuses."""


@dataclass(frozen=True)
class Attack:
    """An attempt to prove what is false.

    Attributes:
        rule: the rule that is misused.
        tried: how.
        false: why the outcome would be false, or no statement.
        refused: words of the refusal.
        attempt: tries it; what it returns has been proved.
    """

    rule: str
    tried: str
    false: str
    refused: str
    attempt: Callable[[], object]


ATTACKS: list[Attack] = []


def attack(
    rule: str, tried: str, false: str, refused: str
) -> Callable[[Callable[[], object]], None]:
    """Add what follows to the attacks."""

    def keep(attempt: Callable[[], object]) -> None:
        ATTACKS.append(Attack(rule, tried, false, refused, attempt))

    return keep


# short words for statements

NO_SITE = DeltaR(i + 1, j)  # no bead is there
COUNTED = Where.of(q >= 0, indices=(i, k))
IN_TWO = Sum(Load(i - j + n, n), (n, j, j + 1))  # the loads of a bead and of the next along n⁺

BEADS, AT_BASE, ONE = Where.of(j >= 0), Where((i,), even=(i,)), Integer(1)
TOP = Where.of(Eq(j, M), j >= 0, loading=SURFACE)
BELOW = Where.of(j >= 0, j <= M - 1, loading=SURFACE)
AT_LOAD = Where.of(l >= 1, loading=LOADED)
ON_SURFACE, ON_LOADED = axioms.loads(SURFACE), axioms.loads(LOADED)
HERE, ABOVE = DeltaR(i, j), DeltaR(i + 1, j + 1)
ORIGIN = DeltaX(0, 0)  # no displacement at all: what is said of it is false but for 0
ROOT = sympy.Symbol("root", positive=True)


def told(rule: Rule, left: sympy.Expr, right: sympy.Expr | int, where: Where = BEADS) -> Theorem:
    """What a rule proves of two sides."""
    return rule(equation(left, sympy.sympify(right)), where)


def checked(side: sympy.Expr, where: Where = BEADS) -> None:
    """Ask whether something may be said."""
    check(equation(side, side), where)


def no_force(other: sympy.Expr) -> Theorem:
    """That f⁺_kl times anything is zero, since f⁺_kl is."""
    return told(rules.rewrite(ON_LOADED), other * ForcePlus(k, l), 0, AT_LOAD)


def over_no_force(number: int) -> Theorem:
    """That f⁺ is any number times f⁻, in the sense of 0 = 0, divided by f⁻."""
    where = Where.of(Eq(l, M), l >= 0, loading=SURFACE)
    plus, minus = ForcePlus(k, l), ForceMinus(k, l)
    same = told(rules.rewrite(ON_SURFACE), plus, number * minus, where)
    return told(rules.follows(same), plus / minus, number, where)


def displaced(size: sympy.Expr) -> sympy.Eq:
    """That the origin, which stays where it is, has been displaced."""
    return equation(ORIGIN, size * e_y)


def steps(count: sympy.Expr) -> sympy.Expr:
    """As large as the number of steps, where that is not negative."""
    return Sum(ONE, (n, 1, count))


def over_itself(quantity: sympy.Expr, number: int) -> Theorem:
    """quantity = number · f⁺/f⁺, where f⁺ vanishes: both sides times f⁺ are zero."""
    ratio = times(Integer(number), ForcePlus(k, l), Pow(ForcePlus(k, l), -1))
    return told(rules.follows(no_force(quantity - number)), quantity, ratio, AT_LOAD)


def only_supposed(left: sympy.Expr, right: sympy.Expr, where: Where) -> Theorem:
    """What nobody has proved, and what rests on it is no theorem."""
    return made(equation(left, right), where, "supposition", supposed=(Supposition(p),))


def another(_formula: sympy.Eq, where: Where) -> Theorem:
    """A rule that proves another statement."""
    return told(rules.rewrite(), ONE, 1, where)
