"""One bead: its rest on d supports, the forces of its contacts, its gap to another; d = 2, 3.

All sweeps use these functions. They calculate with +, −, ×, / and ``sqrt`` only, and no value
decides what they do. Vectors are tuples of components. A component is a NumPy array of floats or
of objects (balls, mpmath), a number that carries its rounding error (``arithmetic.carried``), or,
where ``loops`` compiles these functions, a number of one bead. The compiler knows every ``len``,
and removes the branches for the other dimension.

Base vectors n^1 … n^d have one mutual dot product φ; bead x rests on x − e_1 … x − e_d. A
displacement is carried as c_a = n^a·δx: to first order each is a line sum of δr (Eqs. 2 and 3).
Let p^a be δx minus the displacement of the support x − e_a, ρ^a the sum of the two δr, and r = 1.
Then the contacts say exactly

    n^a·p^a + |p^a|²/4 = R^a,        R^a = ρ^a + ρ^a²/4.

With the equation of a = d subtracted, they are linear in p = p^d except for A = |p|²/4. A obeys a
quadratic, whose small root has a form without cancellation. Every |p^a|²/4 is a sum of terms of
second order, so no value of order zero or one is ever subtracted.
"""

from collections.abc import Callable, Sequence
from fractions import Fraction
from itertools import combinations
from typing import Any, NamedTuple

from ..arithmetic.carried import sqrt

# Gaps smaller than this, in units of r, are below the rounding of float64.
RESOLUTION = 1e-14

Vector = tuple[Any, ...]


class Metric(NamedTuple):
    """φ, b^a·b^a − b^a·b^c and b^a·b^c of the reciprocal vectors, in a number system."""

    phi: Any
    own: Any
    cross: Any


def cosine(n_x: Fraction) -> Fraction:
    """Give φ = n^a·n^b = 1 − 2 n_x² of neighbours in a row that are s = 4 n_x apart, r = 1."""
    return 1 - 2 * n_x**2


def vertical_square(dimension: int, n_x: Fraction) -> Fraction:
    """Give the square of the vertical component of the base vectors: n_y², or n_z² of three."""
    return 1 - Fraction(2 * (dimension - 1), dimension) * n_x**2


def metric(dimension: int, phi: Fraction, scalar: Callable[[Fraction], Any]) -> Metric:
    """Give what φ decides."""
    cosine = scalar(phi)
    less = 1 - cosine
    return Metric(cosine, 1 / less, -cosine / (less * (1 + (dimension - 1) * cosine)))


def level(dimension: int) -> tuple[tuple[int, ...], ...]:
    """Give level vectors as whole numbers of the n^a: n^1 − n^d, and 2 n^2 − n^1 − n^3 of three.

    They are perpendicular; the square of number k = 1, 2 is k (k + 1) (1 − φ).
    """
    return ((1, -1),) if dimension == 2 else ((1, 0, -1), (-1, 2, -1))


def total(v: Any) -> Any:
    """Add the components, from the first to the last."""
    return v[0] + v[1] if len(v) == 2 else v[0] + v[1] + v[2]


def plus(u: Any, v: Any) -> Any:
    """Add two vectors."""
    if len(u) == 2:
        return u[0] + v[0], u[1] + v[1]
    return u[0] + v[0], u[1] + v[1], u[2] + v[2]


def less(u: Any, v: Any) -> Any:
    """Subtract two vectors."""
    if len(u) == 2:
        return u[0] - v[0], u[1] - v[1]
    return u[0] - v[0], u[1] - v[1], u[2] - v[2]


def times(u: Any, v: Any) -> Any:
    """Multiply component by component."""
    if len(u) == 2:
        return u[0] * v[0], u[1] * v[1]
    return u[0] * v[0], u[1] * v[1], u[2] * v[2]


def scaled(v: Any, x: Any) -> Any:
    """Multiply all components by a number."""
    if len(v) == 2:
        return v[0] * x, v[1] * x
    return v[0] * x, v[1] * x, v[2] * x


def over(v: Any, n: Any) -> Any:
    """Divide all components by a whole number."""
    if len(v) == 2:
        return v[0] / n, v[1] / n
    return v[0] / n, v[1] / n, v[2] / n


def shifted(v: Any, x: Any) -> Any:
    """Add a number to all components."""
    if len(v) == 2:
        return v[0] + x, v[1] + x
    return v[0] + x, v[1] + x, v[2] + x


def replaced(v: Any, a: Any, x: Any) -> Any:
    """Give a vector with another component ``a``."""
    if len(v) == 2:
        return x if a == 0 else v[0], x if a == 1 else v[1]
    return x if a == 0 else v[0], x if a == 1 else v[1], x if a == 2 else v[2]


def raised(v: Any, m: Any) -> Any:
    """Turn n^a·v into v^a of v = Σ v^a n^a: multiply by the inverse of the Gram matrix."""
    return shifted(scaled(v, m.own), total(v) * m.cross)


def dot(u: Any, v: Any) -> Any:
    """Give the dot product of two vectors, one of them ``raised``."""
    return total(times(u, v))


class Rest(NamedTuple):
    """A bead at rest: c_a = n^a·δx, and δn^a = Σ_b dn[a][b] n^b of the contact with x − e_a.

    ``holds`` are positive if it can rest: first a discriminant, then measures of tilt.
    """

    c: Any
    dn: Any
    holds: Any


def rest(under: Any, rho: Any, rho_under: Any, m: Any) -> Any:
    """Rest a bead on its supports (Eqs. 2, 4 and 5, exact).

    ``under[a]`` holds n^b·δx of the support x − e_a, ``rho`` and ``rho_under`` are δr/r of the bead
    and of its supports.
    """
    both = shifted(rho_under, rho)
    more = over(times(both, both), 4)
    reach = plus(both, more)
    guess, lift, step, det = _line(under, reach, m)  # p = guess − lift − A step
    start = less(guess, lift)
    size = dot(raised(start, m), start)
    along = raised(step, m)
    half = 1 + dot(along, start) / 2
    discriminant = half * half - dot(along, step) * size / 4
    square = size / (half + sqrt(discriminant)) / 2
    squares = plus(lift, scaled(step, square))
    rise, second = less(reach, squares), less(more, squares)
    if len(under) == 2:
        own: Any = under[0][0], under[1][1]
        x, y = less(own, under[0]), less(own, under[1])
        dn: Any = (
            _turn(0, plus(rise, x), both[0], second[0], m),
            _turn(1, plus(rise, y), both[1], second[1], m),
        )
        return Rest(plus(own, rise), dn, (discriminant, det, step[0]))
    own = under[0][0], under[1][1], under[2][2]
    x, y, z = less(own, under[0]), less(own, under[1]), less(own, under[2])
    dn = (
        _turn(0, plus(rise, x), both[0], second[0], m),
        _turn(1, plus(rise, y), both[1], second[1], m),
        _turn(2, plus(rise, z), both[2], second[2], m),
    )
    return Rest(plus(own, rise), dn, (discriminant, det, step[0], step[1]))


def _line(under: Any, reach: Any, m: Any) -> Any:
    """Give guess, lift and step of p = guess − lift − A step, and a determinant, by Cramer's rule.

    ``lift`` is of second order.
    """
    if len(under) == 2:
        u = less(under[1], under[0])  # p^1 − p
        t = raised(u, m)
        det = 1 + t[0] / 2
        guess: Any = reach[0] - u[0], reach[1]
        lift = dot(t, plus(guess, over(u, 2))) / 2 / det
        return guess, (lift, 0), ((1 - t[1] / 2) / det, 1), det
    u, v = less(under[2], under[0]), less(under[2], under[1])
    s, t = raised(u, m), raised(v, m)
    guess = reach[0] - u[0], reach[1] - v[1], reach[2]
    p, q = dot(s, plus(guess, over(u, 2))) / 2, dot(t, plus(guess, over(v, 2))) / 2
    x, y = 1 - s[2] / 2, 1 - t[2] / 2
    a, b, c, d = 1 + s[0] / 2, s[1] / 2, t[0] / 2, 1 + t[1] / 2
    det = a * d - b * c
    lifts = (d * p - b * q) / det, (a * q - c * p) / det, 0
    return guess, lifts, ((d * x - b * y) / det, (a * y - c * x) / det, 1), det


def _turn(a: Any, p: Any, both: Any, second: Any, m: Any) -> Any:
    """Give δn^a of the contact along n^a, from n^b·p^a; n^a·(p^a − ρ^a n^a) is of second order."""
    across = replaced(shifted(p, -(both * m.phi)), a, second)
    return scaled(raised(across, m), 1 / (2 + both))


def rest_linear(under: Any, rho: Any, rho_under: Any, m: Any) -> Rest:
    """Rest a bead to first order."""
    both = shifted(rho_under, rho)
    own = tuple(under[a][a] for a in range(len(under)))
    dn = []
    for a, of in enumerate(under):
        across = replaced(shifted(plus(both, less(own, of)), -(both[a] * m.phi)), a, 0 * both[a])
        dn.append(over(raised(across, m), 2))
    return Rest(plus(own, both), tuple(dn), ())


def nested(under: Sequence[Vector], rho_under: Vector, m: Metric) -> list[Any]:
    """Give, of each two supports, what is positive where a bead that touches one misses the other.

    The square of the difference of their radii, in units of r, less that of their distance.
    """
    differences = []
    for a, b in combinations(range(len(under)), 2):
        turn = 2 * (1 - m.phi)
        apart = list(less(under[a], under[b]))
        apart[a], apart[b] = apart[a] - turn, apart[b] + turn
        sizes = rho_under[a] - rho_under[b]
        differences.append(sizes * sizes - dot(raised(tuple(apart), m), tuple(apart)))
    return differences


class Balanced(NamedTuple):
    """Changes g^a of the forces below a bead, and a determinant, not zero."""

    g: Any
    det: Any


def balance(F_above: Any, g_above: Any, dn_above: Any, F: Any, dn: Any) -> Any:
    """Balance a bead (Eq. 6, exact): Σ g N (lower) = Σ g N + Σ F δn (upper) − Σ F δn (lower).

    What is ``above`` belongs to the contacts with x + e_a, ``F`` and ``dn`` to those below. All
    ordered values, and the load, have cancelled.
    """
    bearing = turned(plus(F_above, g_above), dn_above)
    turn = less(bearing, turned(F, dn))
    small = turned(plus(g_above, turn), dn)
    away, det = _solved(dn, small)  # (1 + D) h = s, written for h − s, which is of second order
    return Balanced(plus(g_above, less(turn, away)), det)


def balance_linear(F_above: Any, g_above: Any, dn_above: Any, F: Any, dn: Any) -> Balanced:
    """Balance a bead to first order (Eqs. 7–11): there is nothing to invert."""
    return Balanced(plus(g_above, less(turned(F_above, dn_above), turned(F, dn))), None)


def turned(forces: Any, dn: Any) -> Any:
    """Give Σ_a f_a δn^a."""
    if len(dn) == 2:
        return plus(scaled(dn[0], forces[0]), scaled(dn[1], forces[1]))
    both = plus(scaled(dn[0], forces[0]), scaled(dn[1], forces[1]))
    return plus(both, scaled(dn[2], forces[2]))


def _solved(dn: Any, right: Any) -> Any:
    """Solve Σ_a x_a (n^a + δn^a) = Σ_a right_a n^a by Cramer's rule; give also the determinant."""
    if len(dn) == 2:
        a, b = 1 + dn[0][0], 1 + dn[1][1]
        det = a * b - dn[1][0] * dn[0][1]
        x = b * right[0] - dn[1][0] * right[1]
        y = a * right[1] - dn[0][1] * right[0]
        return (x / det, y / det), det
    u, v, w = replaced(dn[0], 0, 1 + dn[0][0]), replaced(dn[1], 1, 1 + dn[1][1]), dn[2]
    w = replaced(w, 2, 1 + w[2])
    of_u, of_v, of_w = _crossed(v, w), _crossed(w, u), _crossed(u, v)
    det = dot(u, of_u)
    return (dot(right, of_u) / det, dot(right, of_v) / det, dot(right, of_w) / det), det


def _crossed(u: Any, v: Any) -> Any:
    """Give the cross product of three components each."""
    return u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]


def gap(steps: Any, square: Any, excess: Any, u: Any, both: Any, m: Any) -> Any:
    """Give (|d|² − D²)/(|d| + D) of two beads, D the sum of their radii, without cancelling.

    ``steps`` is their distance on the lattice, in base vectors; ``square`` that of the ordered
    packing, and ``excess`` the same less 4, exact; ``u`` holds n^b·(δx − δx') and ``both`` the sum
    of the two δr.
    """
    change = 4 * dot(steps, u) + dot(raised(u, m), u)
    distance = square + change  # its square, which rounding may have made negative
    near = distance * (distance > 0)
    return (excess + (change - 4 * both - both * both)) / (sqrt(near) + (2 + both))
