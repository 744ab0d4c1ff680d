"""Sets of whole numbers in few convex parts, and in few words."""

from collections.abc import Iterable, Sequence
from typing import Any

from .sets import OpenSumError, Row, Set, constraint, equations, parts, rows, union


def joined(pieces: Sequence[Set]) -> Set:
    """The union of sets, in as few convex parts as isl and a look at their hull find.

    Single points far apart are not joined to a line that holds no others.
    """
    whole = union(pieces).coalesce()
    if whole.n_basic_set() > 1:
        hull = whole.simple_hull().to_set()
        if hull.is_subset(whole):
            whole = hull
    several = [part.to_set() for part in whole.get_basic_sets()]
    if not any(map(_steep, several)):
        return whole
    before = [part.to_set() for part in union(pieces).get_basic_sets()]
    known = set().union(*map(_steep, before))
    return union(
        shorter
        for part in several
        for shorter in ([part] if _steep(part) <= known else (part & other for other in before))
    )


def _steep(part: Set) -> set[Any]:
    """The equations of a convex set in which a symbol has another factor than 1 or −1."""
    return {
        (frozenset(factors.items()), constant)
        for factors, constant in equations(part)
        if any(abs(factor) > 1 for factor in factors.values())
    }


Conditions = tuple[list[Row], list[Row]]
"""Forms that are 0, and that are at least 0."""


def conditions(whole: Set, context: Set) -> list[Conditions]:
    """The fewest forms that tell a part of a context from the rest; any of several may hold.

    Raises:
        OpenSumError: the part holds a condition on remainders.
    """
    choices: list[Conditions] = []
    left = whole & context
    for part in parts(whole & context):
        if part.is_disjoint(left):
            continue
        needed = _needed(sorted(equations(part), key=_length), context)
        forms = [*sorted(rows(part)[1], key=_length, reverse=True), *reversed(needed)]
        for row in tuple(forms):
            fewer = [form for form in forms if form is not row]
            if _inside(context, fewer, needed).is_subset(whole):
                forms = fewer
        left = left - _inside(context, forms, needed)
        choices.append(
            (
                [form for form in needed if form in forms],
                [form for form in reversed(forms) if form not in needed],
            )
        )
    sets = (_inside(context, (*equal, *bounds), equal) for equal, bounds in choices)
    if not left.is_empty() or not all(part.is_subset(whole) for part in sets):
        raise OpenSumError(f"{whole} is not written by forms")
    return choices


def _inside(points: Set, forms: Iterable[Row], equations: Iterable[Row]) -> Set:
    """The points at which some forms are 0, as those of ``equations`` are, or at least 0."""
    for form in forms:
        points = points.add_constraint(constraint(form, form in equations))
    return points


def _needed(equations: Iterable[Row], context: Set) -> list[Row]:
    """Equations that the context and those before them do not imply."""
    needed = []
    for equation in equations:
        more = context.add_constraint(constraint(equation, True))
        if not context.is_subset(more):
            needed.append(equation)
            context = more
    return needed


def _length(form: Row) -> tuple[int, int]:
    return len(form[0]), sum(abs(factor) for factor in form[0].values())
