"""From radii to an answer by one short way: which files run, and that it is the way of scenes."""

import sys
from pathlib import Path
from types import FrameType
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_array_equal

import force_diffusion as fd

NUMERIC = Path(str(sys.modules[fd.solve.__module__].__file__)).parents[1]


def test_few_files_run_code_on_the_way() -> None:
    pytest.importorskip("numba")
    radii = 1 + 1e-4 * np.random.default_rng(1).uniform(-1, 1, (2, 9, 16))
    found = set()

    def seen(frame: FrameType, event: str, _: Any) -> None:
        path = Path(frame.f_code.co_filename).resolve()
        if event == "call" and path.is_relative_to(NUMERIC.resolve()):
            found.add(path.relative_to(NUMERIC.resolve()).as_posix())

    _ = fd.solve(radii[0], spacing=3).force
    sys.setprofile(seen)
    try:
        _ = fd.solve(radii[1], spacing=3).force
    finally:
        sys.setprofile(None)
    assert len(found) <= 12, sorted(found)


@pytest.mark.parametrize("shape", [(4, 7), (3, 4, 7), (5, 6), (3, 4, 4), (2, 3, 5, 5)])
@given(
    st.sampled_from([fd.SurfaceLoad(), fd.BulkLoad(magnitude=2.5)]), st.integers(0, 2**32),
    st.sampled_from([1e-9, 1e-4, 3e-2]), st.sampled_from([1, 0.25]),
)  # fmt: skip
def test_forces_are_those_of_the_scene(
    shape: tuple[int, ...], load: fd.Load, seed: int, size: float, radius: float
) -> None:
    drawn = np.random.default_rng(seed).uniform(-size, size, shape)
    dimension = 3 if shape in {(3, 4, 4), (2, 3, 5, 5)} else 2
    try:
        solution = fd.solve(delta_r=radius * drawn, radius=radius, dimension=dimension, load=load)
    except fd.ForceDiffusionError:
        return
    assert solution.found is not None
    outcome = solution.forces
    for name in ("force", "change"):
        rows = solution._lattice(name)
        assert_array_equal(getattr(solution, name), rows)
    assert solution.error == outcome.accuracy.error_bound
    assert solution.physical == outcome.physical
