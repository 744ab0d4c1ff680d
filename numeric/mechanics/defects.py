"""The errors of one bead's numbers: how far they miss the exact equations.

``local`` gives the numbers. What they leave of an equation that holds exactly, its defect, is found
by arithmetic that carries errors, and those of supports and upper contacts with it; one step of
Newton's method turns it into the error of first order of the numbers themselves. That takes half
the operations of carrying the errors of all that ``local`` calculates on the way.
"""

from collections.abc import Iterable, Sequence
from typing import Any

from ..arithmetic.carried import Carried
from ..arithmetic.systems import FLOAT64
from . import local
from .local import Balanced, Metric, Rest, Vector, dot, less, plus, solved, turned


def rest_errors(
    c: Vector,
    dn: Sequence[Vector],
    under: Sequence[Vector],
    rho: Any,
    rho_under: Vector,
    m: Metric,
) -> tuple[Vector, list[Vector]]:
    """Give the errors of ``c`` and ``dn`` that ``local.rest`` found; all others carry theirs.

    With q^a = p^a − ρ^a n^a and the length l = 2 + ρ^a of a contact, δn^a = q^a/l; that N^a has
    length 1 says n^a·q^a + δn^a·q^a/2 = 0.
    """
    left, turns, inverses = [], [], []
    for a, turn in enumerate(dn):
        both = rho + rho_under[a]
        length, straight = 2 + both, both * m.phi
        q = tuple([(Carried(c[b]) - under[a][b]) - (both if b == a else straight)
                   for b in range(len(c))])  # fmt: skip
        inverse = 1 / length.value
        off = tuple([_apart(x, length * y) * inverse
                     for x, y in zip(m.raised(q), turn, strict=True)])  # fmt: skip
        left.append(_apart(-q[a], dot(tuple(map(Carried, turn, off)), q) / 2))
        turns.append(off)
        inverses.append(inverse)
    (moved,), _ = solved(dn, (left,))
    along = Metric(*_values(m)).raised(tuple(moved))
    return tuple(moved), [
        plus(off, tuple([x * inverse for x in along]))
        for off, inverse in zip(turns, inverses, strict=True)
    ]


def balance_errors(
    g: Vector, above: Sequence[tuple[Any, Any, Vector]], F: Vector, dn: Sequence[Vector]
) -> Vector:
    """Give the errors of ``g`` that ``local.balance`` found; all others carry theirs.

    ``above[a]`` holds F, g and δn of the contact with x + e_a.
    """
    found = tuple(map(Carried, g))
    reached = [one + change for one, change, _ in above]
    turn = less(turned(plus(F, found), dn), turned(reached, [of for _, _, of in above]))
    left = [_apart(change - x, y) for (_, change, _), x, y in zip(above, found, turn, strict=True)]
    (off,), _ = solved([_values(row) for row in zip(*dn, strict=True)], (left,))
    return tuple(off)


def rest(under: Sequence[Vector], rho: Any, rho_under: Vector, m: Metric) -> Rest:
    """Rest beads as ``local.rest`` does, all numbers with their errors."""
    found = local.rest([_values(v) for v in under], rho.value, _values(rho_under),
                       Metric(*_values(m)), FLOAT64.sqrt, linear=False)  # fmt: skip
    moved, off = rest_errors(found.c, found.dn, under, rho, rho_under, m)
    dn = [tuple(map(Carried, *of)) for of in zip(found.dn, off, strict=True)]
    return Rest(tuple(map(Carried, found.c, moved)), tuple(dn), tuple(map(Carried, found.holds)))


def balance(
    above: Sequence[tuple[Any, Any, Vector, Any]], F: Vector, dn: Sequence[Vector]
) -> Balanced:
    """Balance beads as ``local.balance`` does, all with errors but for what sums lost."""
    near = [(one.value, change.value, _values(of), lost) for one, change, of, lost in above]
    found = local.balance(near, _values(F), [_values(of) for of in dn], linear=False,
                          compensated=True)  # fmt: skip
    off = balance_errors(found.g, [one[:3] for one in above], F, dn)
    return Balanced(tuple(map(Carried, found.g, off)), found.lost, Carried(found.det))


def _values(of: Iterable[Any]) -> Vector:
    return tuple([one.value for one in of])


def _apart(x: Carried, y: Carried) -> Any:
    """Give x − y of two numbers that are near each other, without an error."""
    return (x.value - y.value) + (x.error - y.error)
