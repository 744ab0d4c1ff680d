"""Stores of layout 2, whose sums were exact: they are read, answered from, and gone on with.

Those beside this file were written by force-diffusion 0.1.0 before layout 3: 45 packings in two
runs, of 20 and of 45, or 6 in two runs of 3 where contacts are unilateral.
"""

import shutil
import sqlite3
from pathlib import Path

import numpy as np
import pytest
from force_diffusion.numeric.ensemble.measure import Measurement, measurement
from force_diffusion.numeric.ensemble.older import blocks_of_layout_2
from force_diffusion.numeric.ensemble.store import StoreError
from hypothesis import given
from hypothesis import strategies as st

import force_diffusion as fd
from tests.numeric.ensemble.cases import CASES, PROFILE
from tests.numeric.ensemble.test_networks import strip
from tests.numeric.scenes import scene

FOLDER = Path(__file__).parent / "layout2"
SMALL = scene({**PROFILE, "packing": {"height": 2, "width": 3}})
STORES = {
    "profile": (SMALL, 20, 45, True),
    "histogram": (scene(CASES["histogram of all"]), 20, 45, True),
    "unilateral": (strip(protocol="linear-programs"), 3, 6, False),
}


def copied(name: str, folder: Path) -> Path:
    return Path(shutil.copy(FOLDER / f"{name}.fd", folder))


def layout(path: Path) -> int:
    database = sqlite3.connect(path)
    (found,) = database.execute("PRAGMA user_version").fetchone()
    database.close()
    return int(found)


def the_same(found: fd.Ensemble, fresh: fd.Ensemble) -> None:
    """All numbers agree but for rounding, far below what is printed."""
    for name, column in fresh.arrays.items():
        if column.dtype.kind == "f":
            np.testing.assert_allclose(found.arrays[name], column, rtol=1e-11, err_msg=name)
        else:
            assert found.arrays[name].tolist() == column.tolist()
    if fresh.covariance is not None:
        largest = abs(fresh.covariance).max()
        np.testing.assert_allclose(found.covariance, fresh.covariance, 1e-12, 1e-12 * largest)
    assert found.half_width == pytest.approx(fresh.half_width, rel=1e-11)


@pytest.mark.parametrize("name", STORES)
def test_it_is_answered_from_and_gone_on_with(name: str, tmp_path: Path) -> None:
    asked, first, last, covariance = STORES[name]
    path = copied(name, tmp_path)
    assert layout(path) == 2
    held = fd.read_store(path)
    assert (held.realisations, held.sizes_asked_for) == (last, (first, last))
    assert layout(path) == 2  # who only looks changes nothing
    for size, solved in ((first, 0), (last, 0), (last + 5, 5), (last, 0)):
        found = fd.ensemble(asked, size, store=path, covariance=covariance)
        assert found.solved == solved
        assert layout(path) == 3
        the_same(found, fd.ensemble(asked, size, covariance=covariance))
    assert fd.read_store(path).realisations == last + 5


def test_of_single_packings_nothing_is_rounded(tmp_path: Path) -> None:
    asked, _, last, _ = STORES["unilateral"]
    found = fd.ensemble(asked, last, store=copied("unilateral", tmp_path))
    assert found.sums.to_bytes() == fd.ensemble(asked, last).sums.to_bytes()


def test_what_is_refused_stays_in_its_layout(tmp_path: Path) -> None:
    path = copied("profile", tmp_path)
    before = path.read_bytes()
    with pytest.raises(StoreError, match="ask for 20 or 32"):
        fd.ensemble(SMALL, 25, store=path, covariance=True)
    with pytest.raises(StoreError, match=r"measured\.covariance"):
        fd.ensemble(SMALL, 45, store=path)
    assert path.read_bytes() == before


def content(name: str) -> tuple[bytes, Measurement]:
    asked, *_, covariance = STORES[name]
    database = sqlite3.connect(FOLDER / f"{name}.fd")
    (found,) = database.execute("SELECT content FROM sums WHERE first = 0").fetchone()
    database.close()
    return found, measurement(asked, covariance=covariance)


@given(st.sampled_from(list(STORES)), st.data())
def test_what_is_no_sum_is_refused_or_does_no_harm(name: str, data: st.DataObject) -> None:
    written, m = content(name)
    wrong = bytearray(written)
    for _ in range(data.draw(st.integers(1, 3))):
        wrong[data.draw(st.integers(0, len(written) - 1))] ^= data.draw(st.integers(1, 255))
    cut = data.draw(st.integers(0, len(written)))
    for forged in (bytes(wrong), bytes(wrong[:cut])):
        try:
            blocks = blocks_of_layout_2(forged, m, 0, STORES[name][1])
        except ValueError:
            continue
        assert blocks
