"""Every pair of beads that overlaps is found, own images and far neighbours included.

What ``physical`` says against all pairs of the beads where they are said to be, one by one.
"""

from fractions import Fraction
from itertools import product
from typing import Any

import numpy as np
import pytest
from force_diffusion.numeric.planning.planner import plan
from force_diffusion.numeric.run.running import run
from hypothesis import assume, given, settings
from hypothesis import strategies as st

import force_diffusion as fd
from tests.numeric.scenes import by_numpy, question

Array = np.ndarray[Any, Any]

ROUNDING = 1e-9
"""Of gaps. Of 3000 drawn packings the worst was 1e-14. Where a bead lies a height h above the line
of its supports rounding is enlarged by 1/h, and such are drawn with a chance of order h²: that one
is off by 1e-9 has a chance below 1e-13."""


def scene(delta: Array, spacing: float) -> fd.Scene:
    """Beads of radius 1 + ``delta``, (M + 1, W) discs or (M + 1, W, W) spheres."""
    height, width = delta.shape[0] - 1, delta.shape[1]
    radii = fd.GivenRadii(delta_r=delta)
    return question("positions", height, width, dimension=delta.ndim, spacing=spacing, radii=radii)


def every_gap(delta: Array, spacing: float, outcome: fd.Outcome) -> tuple[Array, Array]:
    """Gaps of all pairs but contacts, each once, with all images that may be near; and the least.

    The least gaps are those of two beads in any images, (beads, beads).

    Sites in steps of the base vectors, by a basis of their own: layer j of column p (and q) is
    p e_1 (+ q e_2) + (j − p − q) e_d in three dimensions, i = 2 p + j mod 2 in two.
    """
    d, W = delta.ndim, delta.shape[1]
    columns = outcome.arrays
    names = ("x", "y") if d == 2 else ("x", "y", "z")
    centres = np.stack([np.asarray(columns[name], dtype=float) for name in names], axis=-1)
    if d == 2:
        i, j = columns["i"], columns["j"]
        sites = np.stack([(j + i) // 2, (j - i) // 2], axis=-1)
        seams, shifts = [(W, -W)], [np.array([spacing * W, 0.0])]
        radii = 1 + delta[j, (i - j % 2) // 2]
    else:
        p, q, j = columns["p"], columns["q"], columns["j"]
        sites = np.stack([p, q, j - p - q], axis=-1)
        # n^1 − n^3 along x; all base vectors of one mutual angle, z up: differences of length s
        seams = [(W, 0, -W), (0, W, -W)]
        shifts = [
            np.array([spacing * W, 0.0, 0.0]),
            np.array([spacing * W / 2, spacing * W * np.sqrt(3) / 2, 0.0]),
        ]
        radii = 1 + delta[j, p, q]
    count = len(radii)
    seams_of, shifts_of = np.array(seams), np.array(shifts)
    flat = centres[:, None, : d - 1] - centres[None, :, : d - 1]
    near = np.round(flat @ np.linalg.inv(shifts_of[:, : d - 1])).astype(int)
    all_gaps, least = [], np.full((count, count), np.inf)
    for images in product(range(-4, 5), repeat=d - 1):
        around = near + images
        step = sites[None] - sites[:, None] + around @ seams_of
        apart = centres[None] - centres[:, None] + around @ shifts_of
        gaps = np.sqrt((apart**2).sum(axis=-1)) - radii[:, None] - radii[None]
        contact = (np.abs(step.sum(axis=-1)) == 1) & (np.abs(step).sum(axis=-1) == 1)
        once = np.triu(np.ones((count, count), dtype=bool), k=0 if images > (0,) * (d - 1) else 1)
        all_gaps.append(gaps[once & ~contact])
        least = np.minimum(least, np.where(once & ~contact, gaps, np.inf))
    return np.concatenate(all_gaps), np.minimum(least, least.T)


def agree(delta: Array, spacing: float) -> None:
    """Compare compiled loops, NumPy and balls with all pairs."""
    assume(delta.any())  # of equal radii nothing is solved
    try:
        asked = scene(delta, spacing)
        usual = run(plan(asked))
    except fd.ForceDiffusionError:
        assume(False)
        return
    gaps, least = every_gap(delta, spacing, usual)
    assume(np.abs(gaps).min() > ROUNDING)  # whether smaller ones overlap rounding may hide
    names = ("p", "q", "j") if delta.ndim > 2 else ("i", "j")
    sites = list(zip(*(usual.arrays[name] for name in names), strict=True))
    with by_numpy():
        swept = run(plan(asked))
    balls = run(plan(asked, Fraction(1, 10**20), certified=True))
    for physical in (usual.physical, swept.physical, balls.physical):
        assert physical is not None
        assert physical.overlaps == (gaps < 0).sum()
        assert physical.undecided_gaps == 0
        assert physical.smallest_gap == pytest.approx(gaps.min(), abs=ROUNDING)
        assert physical.between is not None
        nearest = tuple(map(sites.index, physical.between))
        assert least[nearest] == pytest.approx(gaps.min(), abs=ROUNDING)
        assert physical.sound == (gaps.min() > 0 and not physical.tensile)


@st.composite
def radii(draw: st.DrawFn, *shape: Any) -> Array:
    """Deviations of layers of one to four beads: small, or as large as beads themselves."""
    largest = draw(st.sampled_from([1, 10, 30, 70]))
    size = [draw(strategy) for strategy in shape]
    if len(size) == 3:
        size[2] = size[1]
    count = int(np.prod(size))
    values = draw(st.lists(st.integers(-largest, largest), min_size=count, max_size=count))
    return np.array(values).reshape(size) / 101


SPACINGS = st.sampled_from([2.03, 2.4, 3.0, 3.2, 3.45])
discs = radii(st.integers(2, 6), st.integers(1, 4))
spheres = radii(st.integers(2, 4), st.integers(1, 3), st.just(0))


@given(discs, SPACINGS)
def test_discs(delta, spacing):
    agree(delta, spacing)


@pytest.mark.long
@settings(max_examples=settings.default.max_examples // 2)
@given(spheres, st.sampled_from([2.03, 2.4, 2.9, 3.2]))
def test_spheres(delta, spacing):
    agree(delta, spacing)
