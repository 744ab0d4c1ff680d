"""Stated errors of spheres hold: small and large disorder, against mpmath alone."""

from fractions import Fraction
from itertools import product
from typing import Any

import mpmath
import numpy as np
from hypothesis import assume, given
from hypothesis import strategies as st

import force_diffusion as fd
from tests.numeric.mechanics.plain_packing import PlainPacking

DIGITS = 50


@given(
    height=st.integers(1, 3),
    width=st.integers(1, 3),
    spacing=st.integers(205, 320).map(lambda s: Fraction(s, 100)),
    size=st.floats(-12, -1),
    load=st.sampled_from([fd.SurfaceLoad(), fd.BulkLoad(), fd.BulkLoad(magnitude=2.5)]),
    tolerance=st.sampled_from([None, None, 1e-20]),
    seed=st.integers(0, 2**32),
)
def test_the_stated_error_holds(
    height: int, width: int, spacing: Fraction, size: float, load: fd.Load,
    tolerance: float | None, seed: int,
) -> None:  # fmt: skip
    delta = np.random.default_rng(seed).uniform(-1, 1, (height + 1, width, width)) * 10**size
    try:
        solution = fd.solve(
            delta_r=delta, spacing=spacing, load=load, dimension=3, tolerance=tolerance,
            allow_images=True,
        )  # fmt: skip
    except fd.ForceDiffusionError:
        assume(False)
        return
    with mpmath.workdps(DIGITS):
        true = changes(spacing, delta, load)
        if true is None:  # mpmath's Newton method found no place
            assume(False)
            return
        middle = np.vectorize(number, [object])(solution.change)
        off = max(abs(x) for x in (middle - true).reshape(-1))
        assert off <= solution.error * max(abs(x) for x in middle.reshape(-1))
        if tolerance is not None:
            assert solution.error <= tolerance


def number(x: Any) -> Any:
    """Take a float, or the midpoint of a ball."""
    exact = hasattr(x, "mid")
    return mpmath.mpf(x.mid().str(DIGITS, radius=False)) if exact else mpmath.mpf(float(x))


def changes(spacing: Fraction, delta: Any, load: fd.Load) -> Any:
    """Changes of all contact forces, as ``Solution`` has them; None where a bead finds no rest."""
    height, width = len(delta) - 1, delta.shape[1]
    n_x = spacing / 4
    radii = {(p, q, j): Fraction(float(value)) for (j, p, q), value in np.ndenumerate(delta)}
    plain = PlainPacking(3, height, width, 1 - 2 * n_x**2, radii)
    square = 1 - Fraction(4, 3) * n_x**2
    share = mpmath.mpf(float(load.magnitude)) / 3
    share /= mpmath.sqrt(mpmath.mpf(square.numerator) / square.denominator)

    def on(bead: tuple[int, ...]) -> list[Any]:
        loaded = bead[-1] == height or load.kind == "bulk"
        return [share if loaded else mpmath.mpf(0)] * 3

    found = np.empty((3, height, width, width), dtype=object)
    for j, p, q in product(range(1, height + 1), range(width), range(width)):
        try:
            forces = plain.below((p, q, j - p - q), on)
        except (ArithmeticError, ZeroDivisionError):
            return None
        times = height - j + 1 if load.kind == "bulk" else 1
        for axis, force in enumerate(forces):
            lower = (p - (axis == 0)) % width, (q - (axis == 1)) % width
            found[axis, j - 1, *lower] = force - times * share
    return found
