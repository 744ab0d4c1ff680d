"""What is shown to be false: a statement that a theorem about the same quantity contradicts."""

from collections.abc import Callable
from dataclasses import InitVar, dataclass

import sympy

from ..as_printed import equation
from .limits import how_apart, limit_of, order, read
from .theorem import NotProvedError, Theorem
from .where import Where

_MADE_HERE = object()


@dataclass(frozen=True, eq=False)
class Disproof:
    """A statement that is false at some place of its domain.

    Attributes:
        formula: the equation.
        where: the domain on which it does not hold throughout.
        theorem: what it contradicts.
        reason: how, in words.
    """

    formula: sympy.Eq
    where: Where
    theorem: Theorem
    reason: str
    made_by: InitVar[object] = None

    def __post_init__(self, made_by: object) -> None:
        if made_by is not _MADE_HERE:
            raise TypeError("a disproof is made by the rules of the kernel alone")


Refute = Callable[[sympy.Eq, Where], Disproof]
"""Disproves a statement on a domain.

Raises:
    NotProvedError: it does not, and why.
"""


def other_leading_order(theorem: Theorem) -> Refute:
    """The same left-hand side goes, in the same limit, as something else.

    Two functions of what grows and of parameters that differ in their leading parts do so at
    almost every ratio and φ: there left over right does not go to 1.
    """

    def refute(formula: sympy.Eq, where: Where) -> Disproof:
        limit = limit_of(formula, where, "∼")
        if theorem.supposed:
            raise NotProvedError("the theorem rests on what is only supposed")
        if theorem.where != where or theorem.formula.lhs != formula.lhs:
            raise NotProvedError("the theorem is about another quantity, domain or limit")
        true, said = (
            read(equation(sympy.S.One, one.rhs), (), where)[1] for one in (theorem.formula, formula)
        )
        if order(true - said, limit) < order(said, limit):
            raise NotProvedError("both go the same way")
        return Disproof(formula, where, theorem, how_apart(true, said, limit), _MADE_HERE)

    return refute
