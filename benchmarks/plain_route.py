"""The same equations by SymPy's general tools alone: solve, simplify, Sum.doit, limit.

Each function returns True when these tools reduce the question to zero; when they finish
without doing so they have decided nothing. Run one as ``python benchmarks/plain_route.py 7``.
"""

import sys
from collections.abc import Callable
from time import perf_counter

from sympy import (
    Expr,
    Function,
    Matrix,
    Rational,
    Sum,
    Symbol,
    diff,
    integrate,
    limit,
    simplify,
    solve,
    sqrt,
    symbols,
)

r, n_x, eps = symbols("r n_x epsilon", positive=True)
n_y = sqrt(1 - n_x**2)
phi, z = symbols("phi z", real=True)
i, j, k, l, m, n, p, q = symbols("i j k l m n p q", integer=True)  # noqa: E741
M = Symbol("M", integer=True, positive=True)
dr = Function("dr")


def eq01() -> bool:
    """Squared distances of the tightest pairs, and the bounds on φ."""
    cosine = n_y**2 - n_x**2
    return simplify(1 - cosine**2 - 4 * n_x**2 * n_y**2) == 0


def _contact(sign: int, x: Expr, y: Expr, radii: Expr) -> Expr:
    return (
        (2 * r * sign * n_x + eps * x) ** 2
        + (2 * r * n_y + eps * y) ** 2
        - (2 * r + eps * radii) ** 2
    )


def eq02() -> bool:
    """Both linearised constraints, solved, against the printed matrix form."""
    x, y, xl, yl, xr, yr, own, left, right = symbols("x y xl yl xr yr own left right")
    first = diff(_contact(1, x - xl, y - yl, own + left), eps).subs(eps, 0)
    second = diff(_contact(-1, x - xr, y - yr, own + right), eps).subs(eps, 0)
    found = solve([first, second], [x, y])
    turned = Matrix([[0, n_y / n_x], [n_x / n_y, 0]]) * Matrix([xr - xl, yr - yl])
    plus, minus = (Matrix([s / (2 * n_x), 1 / (2 * n_y)]) for s in (1, -1))
    printed = (
        Matrix([xl + xr, yl + yr]) / 2 - turned / 2 + (own + left) * plus + (own + right) * minus
    )
    return all(simplify(found[v] - printed[row]) == 0 for row, v in enumerate((x, y)))


def _component(sign: int, across: Expr, layer: Expr) -> Expr:
    along = Sum(dr(across - sign * (layer - m), m), (m, 1, layer - 1))
    return dr(across - sign * layer, 0) + dr(across, layer) + 2 * along


def eq03() -> bool:
    """The inductive step, sums left to simplify."""
    steps = (
        _component(s, i, j) - _component(s, i - s, j - 1) - dr(i, j) - dr(i - s, j - 1)
        for s in (1, -1)
    )
    return all(simplify(step.doit()) == 0 for step in steps)


def _direction(sign: int) -> bool:
    along = _component(sign, i + sign, j + 1) - _component(sign, i, j)
    across = _component(-sign, i + sign, j + 1) - _component(-sign, i, j)
    radii = dr(i, j) + dr(i + sign, j + 1)
    tail = Sum(dr(i + sign * (j - m + 2), m) - dr(i + sign * (j - m), m), (m, 1, j))
    printed = radii + dr(i + sign * (j + 2), 0) - dr(i + sign * j, 0) + 2 * tail
    return all(simplify(d.doit()) == 0 for d in (along - radii, across - printed))


def eq04() -> bool:
    """The two components of δn⁺ from Eq. 3."""
    return _direction(1)


def eq05() -> bool:
    """The two components of δn⁻ from Eq. 3."""
    return _direction(-1)


def eq06() -> bool:
    """The gradient of the distance is the unit vector; two ordered forces carry the load."""
    x, y = symbols("x y", real=True)
    distance = sqrt(x**2 + y**2)
    gradient = Matrix([diff(distance, x), diff(distance, y)])
    return simplify(gradient.dot(gradient)) == 1


def _forces(plus: Expr, minus: Expr, right: tuple[Expr, Expr]) -> tuple[Expr, Expr]:
    a, b = symbols("a b")
    found = solve(
        [a + b * (phi + eps * minus) - right[0], a * (phi + eps * plus) + b - right[1]], [a, b]
    )
    return found[a], found[b]


def eq07() -> bool:
    """Both forces, expanded in the disorder."""
    plus, minus = symbols("nu_plus nu_minus")
    forces = _forces(plus, minus, (1 + phi, 1 + phi))
    changes = (phi * plus - minus, phi * minus - plus)
    return all(
        simplify(force.subs(eps, 0) - 1) == 0
        and simplify(diff(force, eps).subs(eps, 0) - change / (1 - phi**2)) == 0
        for force, change in zip(forces, changes, strict=True)
    )


def eq08() -> bool:
    """A force passing through a bead, expanded in the disorder."""
    plus, minus, entering = symbols("nu_plus nu_minus nu_in")
    forces = _forces(plus, minus, (Rational(1), phi + eps * entering))
    changes = (phi * (plus - entering), -(plus - entering))
    return all(
        simplify(force.subs(eps, 0) - straight) == 0
        and simplify(diff(force, eps).subs(eps, 0) - change / (1 - phi**2)) == 0
        for force, change, straight in zip(forces, changes, (1, 0), strict=True)
    )


def eq09() -> bool:
    """One more bead on a straight path."""
    at = Function("at")
    after = (at(q + 1) - at(0)) - (at(q) - at(0)) - (at(q + 1) - at(q))
    return simplify(after) == 0


def eq10() -> bool:
    """The one path that fits."""
    found = solve([k - 1 - p + q - i, l - 1 - p - q - j], [p, q])
    return simplify(found[q] - ((l - j) - (k - i)) / 2) == 0


def eq11() -> bool:
    """All branched loads summed, against the printed sum, in terms of the directions."""
    dn = Function("dn")
    loads = Sum(dn(i + M - j - n + 1, M - n - 1) - dn(i + M - j - n, M - n), (n, 1, M - j - 1))
    printed = Sum(dn(i + n + 1, j + n - 1) - dn(i + n, j + n), (n, 1, M - j - 1))
    return simplify((loads - printed).doit()) == 0


def eq12() -> bool:
    """The double sum of Δ against the exact count."""
    delta = Function("delta")
    double = Sum(Sum(delta(m), (m, 1, j + n)), (n, 1, M - j))
    single = Sum((M - j) * delta(m), (m, 1, j)) + Sum((M - m + 1) * delta(m), (m, j + 1, M))
    return simplify((double - single).doit()) == 0


def eq13() -> bool:
    """The squared weights of Eq. 12 summed, and their leading order (not the exact form)."""
    total = 6 * (Sum((M - j) ** 2, (m, 1, j)) + Sum((M - m) ** 2, (m, j + 1, M))).doit()
    from sympy import oo

    leading = limit(simplify(total.subs(j, z * M)) / M**3, M, oo)
    return simplify(leading - 2 * (1 - z) ** 2 * (2 * z + 1)) == 0


def eq14() -> bool:
    """The same with the weights averaged over the loaded layers."""
    from sympy import oo

    height = Symbol("h", integer=True, positive=True)
    below = Sum(height - j, (height, j + 1, M)).doit() / (M - j)
    above = Sum(height - m, (height, m, M)).doit() / (M - j)
    total = 6 * (Sum(below**2, (m, 1, j)) + Sum(above**2, (m, j + 1, M))).doit()
    leading = limit(simplify(total.subs(j, z * M)) / M**3, M, oo)
    return simplify(leading - Rational(3, 10) * (1 - z) ** 2 * (4 * z + 1)) == 0


def eq15() -> bool:
    """The leading orders of Eqs. 13 and 14, averaged over z, go as M³."""
    surface = integrate(2 * M**3 * (1 - z) ** 2 * (2 * z + 1), (z, 0, 1))
    bulk = integrate(Rational(3, 10) * M**3 * (1 - z) ** 2 * (4 * z + 1), (z, 0, 1))
    return simplify(sqrt(surface) / M ** Rational(3, 2)) == 1 and simplify(5 * bulk / M**3) == 1


def eq16() -> bool:
    """Six radii's worth for each Δ below either turn, a quarter for ½(f⁺ + f⁻), ends left out."""
    below_turns = Sum(6, (m, 1, j + p)) + Sum(6, (m, 1, j + q))
    total = below_turns.doit().subs(p, l - j - q) / 4
    return simplify(total - Rational(3, 2) * (l + j)) == 0


ROUTES: dict[int, Callable[[], bool]] = {
    number: globals()[f"eq{number:02}"] for number in range(1, 17)
}

if __name__ == "__main__":
    start = perf_counter()
    decided = ROUTES[int(sys.argv[1])]()
    print(f"{perf_counter() - start:.6f} {'proved' if decided else 'not decided'}")
