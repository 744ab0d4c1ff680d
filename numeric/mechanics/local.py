"""One bead: how it rests on its d supports, what its contacts bear, its gap to another; d = 2, 3.

The one source of all sweeps. Vectors are tuples of components, and components are what the caller
calculates with: NumPy arrays of floats or of objects, numbers that carry their rounding errors
(``arithmetic.carried``), or names, whose operations are recorded for the compiler
(``arithmetic.recording``). Only +, −, ×, / and ``sqrt`` are used, and no decision is made.

Base vectors n^1 … n^d have one mutual dot product φ; bead x rests on x − e_1 … x − e_d. A
displacement is carried as c_a = n^a·δx: to first order each is a line sum of δr (Eqs. 2 and 3).
With p^a = δx less the displacement of the support x − e_a, ρ^a the sum of the two δr, and r = 1,
the contacts say exactly

    n^a·p^a + |p^a|²/4 = R^a,        R^a = ρ^a + ρ^a²/4.

Less that of a = d they are linear in p = p^d but for A = |p|²/4, which obeys a quadratic: its small
root has a form without cancellation. Every |p^a|²/4 is found as a sum of terms of second order, so
that no ordered value, and none of first order, is ever subtracted.
"""

from collections.abc import Callable, Iterable, Sequence
from fractions import Fraction
from functools import reduce
from itertools import combinations
from operator import add, mul, sub
from typing import Any, NamedTuple

# Gaps smaller than this, in units of r, are below the rounding of float64.
RESOLUTION = 1e-14

Vector = tuple[Any, ...]
Sqrt = Callable[[Any], Any]


class Metric(NamedTuple):
    """φ, b^a·b^a − b^a·b^c and b^a·b^c of the reciprocal vectors, in a number system."""

    phi: Any
    own: Any
    cross: Any

    def raised(self, v: Vector) -> Vector:
        """Turn n^a·v into v^a of v = Σ v^a n^a: multiply by the inverse of the Gram matrix."""
        common = total(v) * self.cross
        return tuple([x * self.own + common for x in v])


def cosine(n_x: Fraction) -> Fraction:
    """Give φ = n^a·n^b = 1 − 2 n_x² of neighbours in a row that are s = 4 n_x apart, r = 1."""
    return 1 - 2 * n_x**2


def vertical_square(dimension: int, n_x: Fraction) -> Fraction:
    """Give the square of the vertical component of the base vectors: n_y², or n_z² of three."""
    return 1 - Fraction(2 * (dimension - 1), dimension) * n_x**2


def metric(dimension: int, phi: Fraction, scalar: Callable[[Fraction], Any]) -> Metric:
    """Round what φ decides, each number once."""
    cross = -phi / ((1 - phi) * (1 + (dimension - 1) * phi))
    return Metric(scalar(phi), scalar(1 / (1 - phi)), scalar(cross))


def level(dimension: int) -> tuple[tuple[int, ...], ...]:
    """Give level vectors as whole numbers of the n^a: n^1 − n^d, and 2 n^2 − n^1 − n^3 of three.

    They are perpendicular; the square of number k = 1, 2 is k (k + 1) (1 − φ).
    """
    return ((1, -1),) if dimension == 2 else ((1, 0, -1), (-1, 2, -1))


def total(values: Iterable[Any]) -> Any:
    """Add, from the first to the last."""
    return reduce(add, values)


def dot(u: Vector, v: Vector) -> Any:
    """Give the dot product of two vectors, one of them ``raised``."""
    return reduce(add, map(mul, u, v))


def plus(u: Vector, v: Vector) -> Vector:
    """Add two vectors."""
    return tuple(map(add, u, v))


def less(u: Vector, v: Vector) -> Vector:
    """Subtract two vectors."""
    return tuple(map(sub, u, v))


def solved(
    matrix: Sequence[Sequence[Any]], rights: Sequence[Sequence[Any]]
) -> tuple[list[list[Any]], Any]:
    """Solve (1 + matrix) x = right for each right side by elimination; give also the determinant.

    A small matrix needs no pivoting.
    """
    size = len(matrix)
    rows = [list(row) for row in matrix]
    found = [list(right) for right in rights]
    inverses = []
    for k in range(size):
        rows[k][k] = 1 + rows[k][k]
        inverses.append(1 / rows[k][k])
        for i in range(k + 1, size):
            factor = rows[i][k] * inverses[k]
            for x in found:
                x[i] = x[i] - factor * x[k]
            for c in range(k + 1, size):
                rows[i][c] = rows[i][c] - factor * rows[k][c]
    for x in found:
        for k in reversed(range(size)):
            for c in range(k + 1, size):
                x[k] = x[k] - rows[k][c] * x[c]
            x[k] = x[k] * inverses[k]
    det = rows[0][0]
    for k in range(1, size):
        det = det * rows[k][k]
    return found, det


class Rest(NamedTuple):
    """A bead at rest: c_a = n^a·δx, and δn^a = Σ_b dn[a][b] n^b of the contact with x − e_a.

    ``holds`` are positive where it can rest: first a discriminant, then measures of tilt.
    """

    c: Vector
    dn: tuple[Vector, ...]
    holds: Vector


def rest(
    under: Sequence[Vector], rho: Any, rho_under: Vector, m: Metric, sqrt: Sqrt, *, linear: bool
) -> Rest:
    """Rest a bead on its supports (Eqs. 2, 4 and 5, exact); to first order only if ``linear``.

    ``under[a]`` holds n^b·δx of the support x − e_a, ``rho`` and ``rho_under`` are δr/r of the bead
    and of its supports.
    """
    d = len(under)
    both = tuple(rho + of for of in rho_under)
    own = tuple(under[a][a] for a in range(d))
    if linear:
        first = [m.raised(tuple(_across(a, both, own, under[a], both[a], m))) for a in range(d)]
        return Rest(plus(own, both), tuple(tuple(x / 2 for x in v) for v in first), ())
    more = tuple(x * x / 4 for x in both)
    reach = plus(both, more)
    last = d - 1
    apart = [less(under[last], under[a]) for a in range(last)]  # p^a − p
    tilts = [m.raised(u) for u in apart]
    # p = guess − lift − A step, where lift is of second order; p_d = R^d − A by its own contact
    guess = (*(reach[a] - apart[a][a] for a in range(last)), reach[last])
    matrix = [[tilts[a][b] / 2 for b in range(last)] for a in range(last)]
    second = [dot(t, plus(guess, tuple(x / 2 for x in u))) / 2
              for t, u in zip(tilts, apart, strict=True)]  # fmt: skip
    (lift, step), det = solved(matrix, (second, [1 - t[last] / 2 for t in tilts]))
    start = (*(guess[a] - lift[a] for a in range(last)), guess[last])
    up = m.raised(start)
    size = dot(up, start)
    along = m.raised((*step, 1))
    half = 1 + dot(along, start) / 2
    discriminant = half * half - dot(along, (*step, 1)) * size / 4
    square = size / (half + sqrt(discriminant)) / 2
    squares = (*(lift[a] + square * step[a] for a in range(last)), square)
    rise = less(reach, squares)
    dn = []
    for a in range(d):
        across = _across(a, rise, own, under[a], both[a], m)
        across[a] = more[a] - squares[a]
        inverse = 1 / (2 + both[a])
        dn.append(tuple(x * inverse for x in m.raised(tuple(across))))
    return Rest(plus(own, rise), tuple(dn), (discriminant, det, *step))


def nested(under: Sequence[Vector], rho_under: Vector, m: Metric) -> list[Any]:
    """Give, of each two supports, what is positive where a bead that touches one misses the other.

    The square of the difference of their radii, in units of r, less that of their distance.
    """
    found = []
    for a, b in combinations(range(len(under)), 2):
        turn = 2 * (1 - m.phi)
        apart = list(less(under[a], under[b]))
        apart[a], apart[b] = apart[a] - turn, apart[b] + turn
        sizes = rho_under[a] - rho_under[b]
        found.append(sizes * sizes - dot(m.raised(tuple(apart)), tuple(apart)))
    return found


def _across(a: int, rise: Vector, own: Vector, under: Vector, both: Any, m: Metric) -> list[Any]:
    """Give n^b·(p^a − ρ^a n^a) of one contact; component ``a`` is left at zero."""
    turned = both * m.phi
    return [0 if b == a else rise[b] + (own[b] - under[b]) - turned for b in range(len(own))]


class Balanced(NamedTuple):
    """Changes g^a of the forces below a bead; what their sums lost; a determinant, not zero."""

    g: Vector
    lost: Vector
    det: Any


def balance(
    above: Sequence[tuple[Any, Any, Vector, Any]],
    F: Vector,
    dn: Sequence[Vector],
    *,
    linear: bool,
    compensated: bool,
) -> Balanced:
    """Balance a bead (Eq. 6, exact): Σ g N (lower) = Σ g N + Σ F δn (upper) − Σ F δn (lower).

    ``above[a]`` holds F, g, δn and what the sum of g lost, of the contact with x + e_a; ``F`` and
    ``dn`` belong to the contacts below. All that is ordered, and the load, has dropped out by
    itself. One force passes straight down through every layer: where sums are ``compensated``
    (Knuth's two-sum), the next layer takes along what a rounding lost. To first order there is
    nothing to invert (``linear``, Eqs. 7–11).
    """
    d = len(F)
    g = tuple(one[1] for one in above)
    turn = turned([of if linear else of + change for of, change, _, _ in above],
                   [one[2] for one in above])  # fmt: skip
    if compensated:
        turn = plus(turn, tuple(one[3] for one in above))
    turn = less(turn, turned(F, dn))
    det = None
    if not linear:  # (1 + D) h = s, written for h − s, which is small of second order
        small = turned(plus(g, turn), dn)
        (away,), det = solved([[dn[a][b] for a in range(d)] for b in range(d)], (small,))
        turn = less(turn, tuple(away))
    found = plus(g, turn)
    if not compensated:
        return Balanced(found, (), det)
    part = less(found, g)
    return Balanced(found, plus(less(g, less(found, part)), less(turn, part)), det)


def turned(forces: Sequence[Any], dn: Sequence[Vector]) -> Vector:
    """Give Σ_a f_a δn^a."""
    return tuple([dot(tuple(forces), of) for of in zip(*dn, strict=True)])


def gap(
    steps: Sequence[Any], square: Any, excess: Any, u: Vector, both: Any, m: Metric, sqrt: Sqrt
) -> Any:
    """Give (|d|² − D²)/(|d| + D) of two beads, D the sum of their radii, without cancelling.

    ``steps`` is their distance on the lattice, in base vectors; ``square`` that of the ordered
    packing, and ``excess`` the same less 4, exact; ``u`` holds n^b·(δx − δx') and ``both`` the sum
    of the two δr.
    """
    change = 4 * dot(tuple(steps), u) + dot(m.raised(u), u)
    return (excess + (change - 4 * both - both * both)) / (sqrt(square + change) + (2 + both))
