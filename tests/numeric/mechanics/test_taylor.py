"""The exact Taylor coefficients: contacts, force balance and symmetries."""

from fractions import Fraction

import flint
import pytest
from hypothesis import given

from tests.numeric.mechanics import taylor
from tests.numeric.strategies import Case, cases, sites

ORDER = 2


def solved(case: Case, order: int = ORDER) -> taylor.TaylorPacking:
    return taylor.solve(
        case.width, case.height, n=case.n, rho=case.rho, loads=case.loads, order=order
    )


def times(a: list[Fraction], b: list[Fraction]) -> list[Fraction]:
    return [sum((a[k] * b[n - k] for k in range(n + 1)), Fraction(0)) for n in range(len(a))]


@given(cases())
def test_beads_touch_to_every_order(case: Case) -> None:
    """With unit directions and force balance, below, this is all that determines a packing."""
    t = solved(case)
    for i, j in sites(case.width, case.height - 1):
        for branch, side in (("+", 1), ("-", -1)):
            apart = [Fraction(2), Fraction(0), Fraction(0)]
            for bead in ((i, j), (i + side, j + 1)):
                for (k, m), value in case.rho.items():
                    if m == bead[1] and (k - bead[0]) % (2 * case.width) == 0:
                        apart[1] += value
            ends = [t.displacement(i, j), t.displacement(i + side, j + 1)]
            for axis, n in enumerate((side * case.n[0], case.n[1])):
                direction = list(t.direction(i, j, branch)[axis])
                direction[0] += n
                moved = [b - a for a, b in zip(ends[0][axis], ends[1][axis], strict=True)]
                moved[0] += 2 * n
                assert moved == times(apart, direction)


@given(cases())
def test_force_balance_at_every_bead_to_every_order(case: Case) -> None:
    """Full forces along the full directions balance the load: exactly zero, no tolerance."""
    t = solved(case)
    nx, ny = case.n
    for i, j in sites(case.width, case.height):
        if j == 0:
            continue
        total = [[Fraction(0)] * (ORDER + 1), [Fraction(0)] * (ORDER + 1)]
        contacts = [(i - 1, j - 1, "+", 1), (i + 1, j - 1, "-", 1)]
        if j < case.height:
            contacts += [(i, j, "+", -1), (i, j, "-", -1)]
        for a, b, branch, sign in contacts:
            f = t.force(a, b, branch)
            for axis, n in enumerate((nx if branch == "+" else -nx, ny)):
                direction = list(t.direction(a, b, branch)[axis])
                direction[0] += n
                for k, value in enumerate(times(f, direction)):
                    total[axis][k] += sign * value
        for site, (fx, fy) in case.loads.items():
            if site == (i, j):
                total[0][0] += fx
                total[1][0] += fy
        assert total == [[0] * (ORDER + 1)] * 2


@given(cases())
def test_directions_stay_unit_vectors(case: Case) -> None:
    t = solved(case)
    for i, j in sites(case.width, case.height - 1):
        for branch, nx in (("+", case.n[0]), ("-", -case.n[0])):
            x, y = (list(v) for v in t.direction(i, j, branch))
            x[0] += nx
            y[0] += case.n[1]
            square = [a + b for a, b in zip(times(x, x), times(y, y), strict=True)]
            assert square == [1] + [0] * ORDER


@given(cases())
def test_mirror_image(case: Case) -> None:
    """Reflecting i → −i swaps the branches and turns x around."""
    mirror = Case(
        case.width,
        case.height,
        case.n,
        {(-i, j): v for (i, j), v in case.rho.items()},
        {(-i, j): (-fx, fy) for (i, j), (fx, fy) in case.loads.items()},
    )
    t, m = solved(case), solved(mirror)
    for i, j in sites(case.width, case.height):
        x, y = t.displacement(i, j)
        assert m.displacement(-i, j) == ([-v for v in x], y)
        if j < case.height:
            assert m.force(-i, j, "-") == t.force(i, j, "+")
            assert m.force(-i, j, "+") == t.force(i, j, "-")


@given(cases())
def test_first_order_is_linear_in_the_radii(case: Case) -> None:
    one = solved(case, 1)
    double = taylor.solve(
        case.width, case.height, n=case.n, loads=case.loads,
        rho={s: -3 * v for s, v in case.rho.items()},
    )  # fmt: skip
    for i, j in sites(case.width, case.height - 1):
        for branch in "+-":
            assert double.force(i, j, branch)[1] == -3 * one.force(i, j, branch)[1]


def test_the_global_cap_is_put_back() -> None:
    before = flint.ctx.cap
    with pytest.raises(ValueError, match="unit vector"):
        taylor.solve(2, 1, n=(Fraction(1, 2), Fraction(1, 2)), rho={}, loads={})
    taylor.solve(2, 1, n=(Fraction(3, 5), Fraction(4, 5)), rho={}, loads={}, order=3)
    assert flint.ctx.cap == before
