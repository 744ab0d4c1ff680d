"""The exact packing in every number system: agreement, symmetry, balance, order of remainder."""

from fractions import Fraction

import mpmath
import numpy as np
from force_diffusion.numeric.arithmetic.systems import (
    FLOAT64,
    Balls,
    BigFloat,
    NumberSystem,
)
from hypothesis import given
from hypothesis import strategies as st

from tests.numeric.mechanics import taylor
from tests.numeric.mechanics.plain_packing import PlainPacking
from tests.numeric.mechanics.small_packing import Solution, solve
from tests.numeric.strategies import Case, cases, sites

STRENGTH = Fraction(1, 10**6)  # far below M* of these heights: every packing can be built
mp = BigFloat(60).context


def solved(case: Case, system: NumberSystem, strength: Fraction = STRENGTH) -> Solution:
    return solve(
        case.width, case.height, n_x=case.n[0], rho=case.rho, loads=case.loads,
        strength=strength, system=system,
    )  # fmt: skip


def contacts(case: Case) -> list[tuple[int, int, str]]:
    return [(i, j, b) for i, j in sites(case.width, case.height - 1) for b in "+-"]


def scale(case: Case) -> Fraction:
    """Bound |change| loosely: loads times radii times the number of terms."""
    load = sum(abs(fx) + abs(fy) for fx, fy in case.loads.values())
    radii = sum(map(abs, case.rho.values()), Fraction(0))
    return 4 * load * radii


@given(cases())
def test_number_systems_agree(case: Case) -> None:
    """float64 stays within rounding of 60 digits; balls contain the 60 digits.

    Rounding: each layer adds a few roundings of terms no larger than ``scale``; up and down
    through at most 5 layers, 200 units in the last place are ample and still far from chance.
    """
    reference = solved(case, BigFloat(60))
    ball = solved(case, Balls(256))
    unit = scale(case) * STRENGTH * Fraction(2) ** -53
    rounded = solved(case, FLOAT64)
    for contact in contacts(case):
        error = abs(mp.mpf(float(rounded.change(*contact))) - reference.change(*contact))
        assert error <= 200 * mp.mpf(unit.numerator) / unit.denominator
    for contact in contacts(case):
        enclosure = ball.change(*contact)
        value = reference.change(*contact)
        assert abs(mp.mpf(str(enclosure.mid().str(70, radius=False))) - value) <= mp.mpf(10) ** -55
        assert enclosure.rad() < 1e-60


@given(cases())
def test_it_agrees_with_first_principles(case: Case) -> None:
    """Positions of order 10 carry 60 digits; 1e-52 leaves room for ~1e6 roundings of them."""
    found, width = solved(case, BigFloat(60)), case.width
    nx, ny = (mp.mpf(n.numerator) / n.denominator for n in case.n)
    rho = {((i + j) // 2 % width, j): Fraction(0) for i, j in sites(width, case.height)}
    for (i, j), value in case.rho.items():
        rho[(i + j) // 2 % width, j] += STRENGTH * value
    shares: dict[tuple[int, int], list[mpmath.mpf]] = {}
    for (i, j), force in case.loads.items():
        fx, fy = (mp.mpf(f.numerator) / f.denominator for f in force)
        shares[(i + j) // 2 % width, j] = [-(fy / ny + fx / nx) / 2, -(fy / ny - fx / nx) / 2]
    with mpmath.workdps(70):
        true = PlainPacking(2, case.height, width, 1 - 2 * case.n[0] ** 2, rho)
        for i, j in sites(width, case.height):
            bead = (i + j) // 2, (j - i) // 2
            dx, dy = found.displacement(i, j)
            home = [2 * (bead[0] * n + bead[1] * m) for n, m in zip(*true.n, strict=True)]
            moved = [a - b for a, b in zip(true.at(bead), home, strict=True)]
            for n, c in zip(true.n, (nx * dx + ny * dy, ny * dy - nx * dx), strict=True):
                assert abs(sum(a * b for a, b in zip(n, moved, strict=True)) - c) < 1e-52
            if j:
                forces = true.below(bead, lambda own: shares.get(own, [0, 0]))
                for side, branch, force in ((-1, "+", forces[0]), (1, "-", forces[1])):
                    assert abs(found.force(i + side, j - 1, branch) - force) < 1e-52


@given(cases(), st.sampled_from(["1e-15", "1e-20"]))
def test_what_three_orders_leave_is_of_the_fourth(case: Case, strength: str) -> None:
    """Coefficients of ε⁴ are below 10¹²: with the largest radii and loads here they reach 6·10⁸."""
    t = taylor.solve(case.width, case.height, n=case.n, rho=case.rho, loads=case.loads, order=3)
    solution, eps = solved(case, BigFloat(90), Fraction(strength)), mp.mpf(strength)
    for contact in contacts(case):
        series = (mp.mpf(c.numerator) / c.denominator for c in t.force(*contact)[1:])
        powers = sum(c * eps**order for order, c in enumerate(series, 1))
        assert abs(solution.change(*contact) - powers) <= mp.mpf(10) ** 12 * eps**4


@given(cases(), st.integers(-300, 300))
def test_scale_and_translation_change_no_bit(case: Case, shift: int) -> None:
    """Moving everything by two columns moves the answer, bit for bit; so do whole periods."""
    moved = Case(
        case.width,
        case.height,
        case.n,
        {(i + 2 * shift, j): v for (i, j), v in case.rho.items()},
        {(i + 2 * shift, j): v for (i, j), v in case.loads.items()},
    )
    a, b = solved(case, FLOAT64), solved(moved, FLOAT64)
    for i, j, branch in contacts(case):
        x, y = a.change(i, j, branch), b.change(i + 2 * shift, j, branch)
        assert np.array_equal(x, y)


@given(cases(), st.integers(-900, 900))
def test_loads_scaled_by_a_power_of_two(case: Case, power: int) -> None:
    """Force balance is linear in the load: a power of two changes exponents only."""
    factor = Fraction(2) ** power
    scaled = Case(
        case.width, case.height, case.n, case.rho,
        {s: (fx * factor, fy * factor) for s, (fx, fy) in case.loads.items()},
    )  # fmt: skip
    a, b = solved(case, FLOAT64), solved(scaled, FLOAT64)
    for contact in contacts(case):
        expected = a.force(*contact)
        got = b.force(*contact)
        if 1e-250 < abs(expected * 2.0**power) < 1e250:  # clear of under- and overflow
            assert got == expected * 2.0**power
