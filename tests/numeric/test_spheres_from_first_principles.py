"""Stated errors of spheres hold, of small and of large disorder: against mpmath alone."""

from dataclasses import replace
from fractions import Fraction
from itertools import product
from typing import Any

import numpy as np
from hypothesis import assume, given
from hypothesis import strategies as st

import force_diffusion as fd
from tests.properties.packing import DIGITS, Packing, mp


@given(
    height=st.integers(1, 3),
    width=st.integers(1, 3),
    spacing=st.integers(205, 320),
    size=st.floats(-12, -1),
    load=st.sampled_from([fd.SurfaceLoad(), fd.BulkLoad(), fd.BulkLoad(magnitude=2.5)]),
    tolerance=st.sampled_from([None, None, 1e-20]),
    seed=st.integers(0, 2**32),
)
def test_the_stated_error_holds(
    height, width, spacing, size, load,
    tolerance, seed
):  # fmt: skip
    delta = np.random.default_rng(seed).uniform(-1, 1, (height + 1, width, width)) * 10**size
    try:
        solution = fd.solve(
            delta_r=delta, spacing=Fraction(spacing, 100), load=load, dimension=3,
            tolerance=tolerance, allow_images=True,
        )  # fmt: skip
    except fd.ForceDiffusionError:
        assume(False)
        return
    change = np.vectorize(number, [object])(solution.change)
    off = max(abs(x) for x in (change - true_change(mp.mpf(spacing) / 100, delta, load)).flat)
    assert off <= solution.error * max(abs(x) for x in change.flat)
    if tolerance is not None:
        assert solution.error <= tolerance


def number(x: Any) -> Any:
    """Take a float, or the midpoint of a ball."""
    return mp.mpf(x.mid().str(DIGITS, radius=False) if hasattr(x, "mid") else float(x))


def true_change(spacing: Any, delta: Any, load: fd.Load) -> Any:
    """Changes of all contact forces, as ``Solution`` has them."""
    height, width = len(delta) - 1, delta.shape[1]
    ordered = Packing(1 - spacing**2 / 8, width, height, d=3)
    change = {(p, q, j - p - q): mp.mpf(float(x)) for (j, p, q), x in np.ndenumerate(delta)}
    weight = mp.mpf(float(load.magnitude))
    loads = (ordered.bulk_load if load.kind == "bulk" else ordered.surface_load)(weight)
    before, after = (x.forces(loads) for x in (ordered, replace(ordered, change=change)))
    changes = np.empty((3, height, width, width), dtype=object)
    for c, j, p, q in product(range(3), range(height), range(width), range(width)):
        contact = (p, q, j - p - q), c
        changes[c, j, p, q] = after[contact] - before[contact]
    return changes
