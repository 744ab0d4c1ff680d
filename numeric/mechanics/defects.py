"""One bead with its errors: how far rounded numbers miss the exact equations tells their error.

``local`` gives the numbers. What they leave of an equation that holds exactly, its defect, is found
by arithmetic that carries errors, and those of supports and upper contacts with it; one step of
Newton's method turns it into the error of first order of the numbers themselves. That takes half
the operations of carrying the errors of all that ``local`` calculates on the way.
"""

from collections.abc import Iterable, Sequence
from typing import Any

from ..arithmetic.carried import Carried
from .local import (
    Balanced,
    Metric,
    Rest,
    Sqrt,
    Vector,
    balance,
    dot,
    less,
    plus,
    rest,
    solved,
    turned,
)


def rest_with_errors(
    under: Sequence[Vector], rho: Any, rho_under: Vector, m: Metric, sqrt: Sqrt
) -> Rest:
    """Rest a bead as ``local.rest`` does; all is given and found with its errors.

    With q^a = p^a − ρ^a n^a and the length l = 2 + ρ^a of a contact, δn^a = q^a/l; that it has this
    length says n^a·q^a + δn^a·q^a/2 = 0.
    """
    d, scalar = len(under), Metric(*_values(m))
    near = rest([_values(v) for v in under], rho.value, _values(rho_under), scalar, sqrt,
                linear=False)  # fmt: skip
    left, turns, inverses = [], [], []
    for a, dn in enumerate(near.dn):
        both = rho + rho_under[a]
        length, turned_by = 2 + both, both * m.phi
        q = tuple(
            (Carried(near.c[b]) - under[a][b]) - (both if b == a else turned_by) for b in range(d)
        )
        inverse = 1 / length.value
        turn = tuple(_apart(x, length * y) * inverse
                     for x, y in zip(m.raised(q), dn, strict=True))  # fmt: skip
        left.append(_apart(-q[a], dot(tuple(map(Carried, dn, turn)), q) / 2))
        turns.append(turn)
        inverses.append(inverse)
    (moved,), _ = solved(near.dn, (left,))
    along = scalar.raised(tuple(moved))
    dn = tuple(
        tuple(map(Carried, of, plus(turn, tuple(x * inverse for x in along))))
        for of, turn, inverse in zip(near.dn, turns, inverses, strict=True)
    )
    return Rest(tuple(map(Carried, near.c, moved)), dn, tuple(map(Carried, near.holds)))


def balance_with_errors(
    above: Sequence[tuple[Any, Any, Vector, Any]], F: Vector, dn: Sequence[Vector]
) -> Balanced:
    """Balance a bead as ``local.balance`` does, ``compensated``; with errors, but for what is lost."""
    near = balance([(one.value, g.value, _values(n), lost) for one, g, n, lost in above],
                   _values(F), [_values(n) for n in dn], linear=False, compensated=True)  # fmt: skip
    d, g = len(F), tuple(map(Carried, near.g))
    turn = less(turned(plus(F, g), dn),
                turned([one + g for one, g, _, _ in above], [n for _, _, n, _ in above]))  # fmt: skip
    left = [_apart(one[1] - x, y) for one, x, y in zip(above, g, turn, strict=True)]
    (off,), _ = solved([[dn[a][b].value for a in range(d)] for b in range(d)], (left,))
    return Balanced(tuple(map(Carried, near.g, off)), near.lost, Carried(near.det))


def _values(of: Iterable[Any]) -> Vector:
    return tuple(one.value for one in of)


def _apart(x: Carried, y: Carried) -> Any:
    """Give x − y of two numbers that are near each other, without an error."""
    return (x.value - y.value) + (x.error - y.error)
