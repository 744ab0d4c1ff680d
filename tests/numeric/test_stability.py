"""How stable solving is: float64 against certified balls, where it is hard to be accurate.

Errors are those of changes, which vanish with the disorder, relative to the largest of them.
"""

import math
from fractions import Fraction
from functools import cache
from typing import Any

import flint
import numpy as np
import pytest
from force_diffusion.numeric.arithmetic.errors import UndecidedError
from force_diffusion.numeric.arithmetic.systems import Balls
from force_diffusion.numeric.mechanics import engine
from force_diffusion.numeric.mechanics.sweep import UnbuildableError
from force_diffusion.numeric.mechanics.work import Work
from force_diffusion.numeric.theory.expected import critical_height

import force_diffusion as fd

# Of float64: a number that is rounded once is off by this share of itself at most.
UNIT = 2.0**-53
# What is rounded carries an error of its own, which is far smaller.
ONCE = 1.01 * UNIT
LOADS = {
    "surface": fd.SurfaceLoad(),
    "bulk": fd.BulkLoad(),
    "leaning": fd.SurfaceLoad(angle_deg=30),
    "leaning bulk": fd.BulkLoad(angle_deg=30),
    "point": fd.PointLoad(at=(5, 15)),
}


def solved(
    height: int, width: int, std: float, spacing: Any = 3, load: str = "surface",
    dimension: int = 2, **how: Any,
) -> fd.Solution:  # fmt: skip
    """Solve a strip with uniform radii, the same but for their scale at every σ/r."""
    shape = (height + 1, *[width] * (dimension - 1))
    drawn = np.random.default_rng([height, width]).uniform(-1, 1, shape)
    return fd.solve(
        delta_r=std * 3**0.5 * drawn, spacing=spacing, load=LOADS[load], dimension=dimension,
        allow_images=True, **how,
    )  # fmt: skip


def measured(*strip: Any, **more: Any) -> tuple[float, fd.Solution, fd.Solution]:
    """Give the largest error in float64, and the solutions in float64 and in balls."""
    floats = solved(*strip, **more)
    balls = solved(*strip, **more, tolerance="1e-60", certified=True)
    assert balls.certified
    assert balls.error < 1e-6 * UNIT  # far better than what is measured by it
    with flint.ctx.workprec(500):
        pairs = list(zip(floats.change.flat, balls.change.flat, strict=True))
        largest = max(abs(ball).lower() for _, ball in pairs)
        away = max((flint.arb(number) - ball).abs_upper() for number, ball in pairs)
        return float((away / largest).upper()), floats, balls


def accurate(*arguments: Any, **more: Any) -> fd.Solution:
    """Solve a strip whose changes have to be rounded once, and no less accurate than is said.

    What is said has room for printing, which may round once more.
    """
    error, solution, _ = measured(*arguments, **more)
    assert error <= ONCE
    assert error <= solution.error <= 2.1 * ONCE
    return solution


@cache
def lost(height: int, std: float) -> float:
    """Bits that balls lose in a strip of 16 beads a layer."""
    return bits_lost(solved(height, 16, std, tolerance="1e-40", certified=True))


def bits_lost(solution: fd.Solution) -> float:
    """Give the bits of the arithmetic that the answer lacks; printing takes 20 radii of a ball."""
    system = solution.forces.plan.system
    return system.bits + math.log2(solution.error / 20)


@pytest.mark.parametrize(
    ("height", "width", "std", "more"),
    [
        *((16, 34, 10.0**-k, {}) for k in (2, 3, 8, 12, 15, 16, 30, 300)),
        *((16, 34, 10.0**-k, {"load": load}) for k in (2, 15) for load in [*LOADS][1:]),
        *((128, 16, 10.0**-k, {}) for k in (2, 3, 16)),
        *((M, 9, 1e-6, {"spacing": Fraction(9, 4), "dimension": 3}) for M in (2, 20)),
    ],
)
def test_digits_depend_on_neither_disorder_nor_load_nor_height(height, width, std, more):
    accurate(height, width, std, **more)


@pytest.mark.parametrize(
    "spacing",
    [Fraction(2) + Fraction(1, 10**k) for k in (6, 12, 13)] + [Fraction("3.464101615137")],
)
@pytest.mark.parametrize("std", [1e-6, 1e-14])
def test_near_the_limits_of_the_spacing(spacing, std):
    """Next to 2 r and 2√3 r: beads of a layer nearly touch, or those two layers apart."""
    solution = accurate(16, 34, std, spacing=spacing)
    assert solution.physical is not None
    room = float(min(spacing - 2, 2 * math.sqrt(3) - spacing))
    # σ/r far above the room that there is left, or far below it
    if std > 100 * room:
        assert solution.physical.overlaps
    if std < room / 100:
        assert not solution.physical.overlaps


@pytest.mark.long
@pytest.mark.parametrize("height", [16, 256, 1024])
def test_very_tall_packings(height):
    """Balls add up worst cases: M^(3/2) at most, and a constant from the operations of a bead."""
    _, solution, balls = measured(height, 16, 1e-6)
    assert solution.error <= 2.1 * ONCE
    assert bits_lost(balls) < 8 + 1.5 * math.log2(height)


@pytest.mark.parametrize(
    ("height", "std", "load"),
    [(48, 0.006, "bulk"), (96, 0.003, "leaning bulk"), (96, 0.006, "surface")],
)
def test_beyond_the_critical_height(height, std, load):
    """Contacts pull there, and the packing is unstable: what is answered is as accurate."""
    assert height > critical_height(Fraction(str(std)))
    solution = accurate(height, 16, std, load=load)
    assert solution.physical is not None
    assert solution.physical.tensile


def test_fifty_digits_are_certified_beyond_the_critical_height():
    solution = solved(96, 16, 0.006, tolerance="1e-50", certified=True)
    assert solution.certified
    assert solution.error <= 1e-50
    assert bits_lost(solution) > 40  # and were made up for
    with flint.ctx.workprec(1000):
        more = solved(96, 16, 0.006, tolerance="1e-100").change
        for a, b in zip(solution.change.flat, more.flat, strict=True):
            assert a.overlaps(b)


def test_the_error_names_the_bead_where_no_packing_exists():
    for tolerance in (None, "1e-40"):
        with pytest.raises(UnbuildableError, match=r"^bead \(\d+, \d+\): its supports are too far"):
            solved(128, 16, 0.03, tolerance=tolerance)


def test_balls_that_are_too_wide_are_undecided_not_unbuildable():
    """128 layers at σ/r = 1e-2 stand, and lose more than the 60 bits of these balls."""
    problem = solved(128, 16, 0.01).forces.plan.problem
    system = Balls(60)
    with system.active(), pytest.raises(UndecidedError):
        engine.solve(problem, [0], system, Work())


@pytest.mark.parametrize(("low", "high"), [(4, 16), (16, 64), (64, 256)])
def test_balls_lose_a_power_of_the_height(low, high):
    """Far below M*, 2e5 layers here: M^(3/2) at most, which is 3 bits in 4 times the layers.

    One tenth of a bit is what the losses are rounded by, twice.
    """
    assert lost(high, 1e-8) - lost(low, 1e-8) < 1.5 * 2 + 0.1


def test_beyond_the_critical_height_balls_lose_digits_exponentially():
    """The packing itself is unstable there: half a bit a layer and more at σ/r = 1e-2."""
    assert critical_height(Fraction(1, 100)) < 32
    beyond = (lost(64, 1e-2) - lost(32, 1e-2)) / 32
    below = (lost(64, 1e-8) - lost(32, 1e-8)) / 32
    assert beyond > 0.5 > 10 * below
