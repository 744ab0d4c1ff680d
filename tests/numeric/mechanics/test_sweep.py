"""The one sweep against first principles, in both dimensions; and its own errors."""

from collections.abc import Iterator
from fractions import Fraction
from itertools import product
from typing import Any

import mpmath
import numpy as np
import pytest
from force_diffusion.numeric.arithmetic.carried import CARRYING
from force_diffusion.numeric.arithmetic.systems import BigFloat, NumberSystem
from force_diffusion.numeric.lattice.layers import Region, whole
from force_diffusion.numeric.mechanics import local
from force_diffusion.numeric.mechanics.sweep import UnbuildableError, deposit, sweep_down
from hypothesis import assume, given
from hypothesis import strategies as st

from tests.numeric.mechanics.plain_packing import PlainPacking

PHI = st.fractions(Fraction(-30, 100), Fraction(45, 100), max_denominator=1000)
CASES = st.tuples(st.sampled_from([2, 3]), st.integers(1, 4), st.integers(1, 3), PHI,
                  st.floats(-9, -1.2), st.integers(0, 2**32))  # fmt: skip


@pytest.fixture(autouse=True)
def digits() -> Iterator[None]:
    with mpmath.workdps(60):
        yield


def column(columns: tuple[int, ...], layer: int, width: int) -> int:
    """Where a bead is in its row: in the plane, i = x_1 − x_2 = 2 x_1 − j is 2q + j mod 2."""
    if len(columns) == 1:
        return (2 * columns[0] - layer - layer % 2) // 2 % width
    return sum(x * width**k for k, x in enumerate(reversed(columns)))


def solved(
    region: Region, phi: Fraction, rho: Any, share: list[Fraction], system: NumberSystem
) -> tuple[Any, Any]:
    with system.active():
        packing = deposit(phi, region, rho, system)
        F = system.zeros(len(share), region.beads - region.rows[0].count)
        for a, x in enumerate(share):
            F[a] = F[a] + system.number(x)
        return packing, sweep_down(packing, region.rows, F)


@given(CASES)
def test_positions_and_forces_are_those_of_first_principles(
    case: tuple[int, int, int, Fraction, float, int],
) -> None:
    d, height, width, phi, size, seed = case
    rng = np.random.default_rng(seed)
    drawn = {
        (*columns, j): Fraction(float(rng.uniform(-1, 1) * 10**size))
        for j in range(height + 1)
        for columns in product(range(width), repeat=d - 1)
    }
    share = [Fraction(float(x)) for x in rng.uniform(0.2, 1, d)]
    region = whole(width ** (d - 1), height, d)
    rows: list[list[Fraction]] = [[Fraction(0)] * width ** (d - 1) for _ in range(height + 1)]
    for (*columns, j), value in drawn.items():
        rows[j][column(tuple(columns), j, width)] = value
    plain = PlainPacking(d, height, width, phi, drawn)
    values = [mpmath.mpf(x.numerator) / x.denominator for x in share]

    def load(bead: tuple[int, ...]) -> list[Any]:
        return values if bead[-1] == height else [mpmath.mpf(0)] * d

    system = BigFloat(50)
    beads = [x for row in rows for x in row]
    floats = CARRYING.from_floats(np.array([[float(x) for x in beads]]))
    try:
        exact = solved(region, phi, _row(system, beads)[None], share, system)
        carried = solved(region, phi, floats, share, CARRYING)
        places = {key: plain.at((*key[:-1], key[-1] - sum(key[:-1]))) for key in drawn}
    except (UnbuildableError, ArithmeticError, ZeroDivisionError):
        assume(False)
        return
    # 50 digits, of which steep supports and narrow angles take some
    room = mpmath.mpf(10) ** -38
    largest = max(abs(g) for _, of in exact[1].change for row in of[1:] for g in row)
    for (*columns, j), place in places.items():
        bead = (*columns, j - sum(columns))
        q = column(tuple(columns), j, width)
        ordered = 2 * sum((plain.n[a] * bead[a] for a in range(d)), mpmath.matrix(d, 1))
        for a, (_, c) in enumerate(exact[0].c):
            want = (plain.n[a].T * (place - ordered))[0]
            assert abs(mpmath.mpf(c[j][q]) - want) < room
        if not j:
            continue
        forces = plain.below(bead, load)
        for a, (_, of) in enumerate(exact[1].change):
            want = forces[a] - values[a]
            assert abs(mpmath.mpf(of[j][q]) - want) < room
            ours = [rows for _, rows in carried[1].change][a][j]
            found = mpmath.mpf(float(ours.value[q])) + mpmath.mpf(float(ours.error[q]))
            # second order in 1e-16, and roundings of errors: far below float64
            assert abs(found - want) < mpmath.mpf(10) ** -27 * max(largest, mpmath.mpf(10) ** -12)


def _row(system: BigFloat, row: list[Fraction]) -> Any:
    return np.array([system.number(x) for x in row], dtype=object)


@pytest.mark.parametrize("d", [2, 3])
def test_a_bead_rests_on_its_supports(d: int) -> None:
    """Contacts hold as they are written in ``local``, and forces balance."""
    rng, system = np.random.default_rng(d), BigFloat(60)
    mp = system.context
    phi = Fraction(1, 7)
    m = local.metric(d, phi, system.number)

    def numbers(*shape: int) -> Any:
        values = rng.uniform(-0.03, 0.03, shape)
        return np.vectorize(lambda x: mp.mpf(float(x)), otypes=[object])(values)

    under = [tuple(row) for row in numbers(d, d)]
    rho, below = numbers(1)[0], tuple(numbers(d))
    found = local.rest(tuple(under), rho, below, m)
    for a in range(d):
        p = local.less(found.c, under[a])
        both = rho + below[a]
        square = local.dot(local.raised(p, m), p)
        assert abs(p[a] + square / 4 - both - both * both / 4) < 1e-55
        # δn = (p − ρ n)/(2 + ρ), by its components along the base vectors
        lowered = [x + m.phi * (sum(found.dn[a]) - x) for x in found.dn[a]]
        for b in range(d):
            along = (p[b] - both * (1 if a == b else m.phi)) / (2 + both)
            assert abs(lowered[b] - along) < 1e-55
    above = [(numbers(1)[0] + 1, numbers(1)[0], tuple(numbers(d))) for _ in range(d)]
    F = tuple(one[0] + mp.mpf(1) for one in above)
    borne = local.balance(*zip(*above, strict=True), F, found.dn)
    for b in range(d):
        down = sum((F[a] + borne.g[a]) * ((1 if a == b else 0) + found.dn[a][b]) for a in range(d))
        up = sum((f + g) * ((1 if a == b else 0) + dn[b]) for a, (f, g, dn) in enumerate(above))
        assert abs(down - up - mp.mpf(1)) < 1e-55
