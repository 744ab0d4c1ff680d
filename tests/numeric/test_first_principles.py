"""Stated errors hold: random packings, small and large disorder, against mpmath alone."""

from fractions import Fraction
from itertools import product
from typing import Any

import mpmath
import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

import force_diffusion as fd
from tests.numeric.mechanics.plain_packing import PlainPacking

EXAMPLES = settings.default.max_examples if settings.default else 20
DIGITS = 50


def scenes(dimension: int, height: int, width: int, widest: int) -> st.SearchStrategy[Any]:
    """Height, width, s/r, size of disorder, load, tolerance or None, and a seed."""
    return st.tuples(
        st.just(dimension),
        st.integers(1, height),
        st.integers(1, width),
        st.integers(205, widest).map(lambda s: Fraction(s, 100)),
        st.floats(-12, -1),
        st.sampled_from([fd.SurfaceLoad(), fd.BulkLoad(), fd.BulkLoad(magnitude=2.5)]),
        st.sampled_from([None, None, 1e-20]),
        st.integers(0, 2**32),
    )


@pytest.mark.long(sample=1)
@settings(max_examples=3 * EXAMPLES)
@given(scenes(2, 5, 6, 340))
def test_discs(scene: Any) -> None:
    stated_error_holds(scene)


@pytest.mark.long(sample=1)
@settings(max_examples=EXAMPLES)
@given(scenes(3, 3, 3, 320))
def test_spheres(scene: Any) -> None:
    stated_error_holds(scene)


def stated_error_holds(scene: Any) -> None:
    d, height, width, spacing, size, load, tolerance, seed = scene
    shape = (height + 1, *[width] * (d - 1))
    delta = np.random.default_rng(seed).uniform(-1, 1, shape) * 10**size
    try:
        solution = fd.solve(
            delta_r=delta, spacing=spacing, load=load, dimension=d, tolerance=tolerance,
            allow_images=True,
        )  # fmt: skip
    except fd.ForceDiffusionError:
        assume(False)
        return
    with mpmath.workdps(DIGITS):
        true = changes(d, spacing, delta, load)
        if true is None:  # mpmath's Newton method found no place
            assume(False)
            return
        found = solution.change
        middle = np.vectorize(number, [object])(found)
        off = max(abs(x) for x in (middle - true).reshape(-1))
        assert off <= solution.error * max(abs(x) for x in middle.reshape(-1))
        if tolerance is not None:
            assert solution.error <= tolerance


def number(x: Any) -> Any:
    """Take a float, or the midpoint of a ball."""
    exact = hasattr(x, "mid")
    return mpmath.mpf(x.mid().str(DIGITS, radius=False)) if exact else mpmath.mpf(float(x))


def changes(d: int, spacing: Fraction, delta: Any, load: fd.Load) -> Any:
    """Changes of all contact forces, as ``Solution`` has them; None where a bead finds no rest."""
    height, width = len(delta) - 1, delta.shape[1]
    n_x = spacing / 4
    phi = 1 - 2 * n_x**2
    sites = list(product(range(height + 1), *[range(width)] * (d - 1)))
    named = {site: name(site, width) for site in sites}
    plain = PlainPacking(
        d, height, width, phi, {named[site]: Fraction(float(delta[site])) for site in sites}
    )
    square = 1 - Fraction(2 * (d - 1), d) * n_x**2
    share = mpmath.mpf(float(load.magnitude)) / d
    share /= mpmath.sqrt(mpmath.mpf(square.numerator) / square.denominator)

    def on(bead: tuple[int, ...]) -> list[Any]:
        loaded = bead[-1] == height or (load.kind == "bulk" and bead[-1])
        return [share if loaded else mpmath.mpf(0)] * d

    found = np.empty((d, height, *delta.shape[1:]), dtype=object)
    for j, *q in sites[width ** (d - 1) :]:
        *columns, layer = named[j, *q]
        try:
            forces = plain.below((*columns, layer - sum(columns)), on)
        except (ArithmeticError, ZeroDivisionError):
            return None
        times = height - j + 1 if load.kind == "bulk" else 1
        for a, force in enumerate(forces):
            lower = [x - (k == a) for k, x in enumerate(columns)]
            found[a, j - 1, *place(lower, j - 1, width)] = force - times * share
    return found


def name(site: tuple[int, ...], width: int) -> tuple[int, ...]:
    """Name a bead (layer, columns) as ``PlainPacking`` does: in the plane i = 2 x_1 − j."""
    j, *q = site
    if len(q) > 1:
        return (*q, j)
    return (q[0] + (j + j % 2) // 2) % width, j


def place(columns: list[int], j: int, width: int) -> list[int]:
    """Give the columns that ``Solution`` has, of the first numbers of a bead."""
    if len(columns) > 1:
        return [x % width for x in columns]
    return [(columns[0] - (j + j % 2) // 2) % width]
