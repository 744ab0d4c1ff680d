"""Counts in bins, compared with counting one by one."""

from bisect import bisect_right
from collections import Counter
from fractions import Fraction
from typing import Any

import numpy as np
import pytest

import force_diffusion as fd
from tests.numeric.scenes import question


@pytest.mark.long(sample=5)
@pytest.mark.parametrize(("dimension", "width"), [(2, 32), (3, 6)])
@pytest.mark.parametrize("layers", [None, [2], [0, 2]])
@pytest.mark.parametrize(("bins", "tolerance"), [(1, None), (100, None), (7, "1e-30")])
def test_counts_are_those_of_the_changes(dimension, width, layers, bins, tolerance):
    """A change belongs to the bin of low ≤ change < high; bins reach from the first to the last."""
    of = {"dimension": dimension, "realisations": 3, "seed": 3}
    rows = question("histogram", 3, width, bins=bins, layers=layers, **of).run(tolerance).decimals()
    listed = question("contact_forces", 3, width, **of).run(tolerance).decimals()
    counted = range(3) if layers is None else layers
    edges = [Fraction(row["low"]) for row in rows]
    expected = Counter(
        bisect_right(edges, Fraction(row["change"])) for row in listed if row["j"] in counted
    )
    assert [row["count"] for row in rows] == [expected[place] for place in range(1, bins + 1)]
    assert expected.total() == 3 * dimension * len(counted) * width ** (dimension - 1)
    assert expected[1]
    assert expected[bins]


@pytest.mark.parametrize("effects", [{"geometry": "ordered"}, {}])
@pytest.mark.parametrize("dimension", [2, 3])
def test_realisations_that_are_alike_are_counted_too(effects, dimension):
    """Without disorder one is solved, and stands for all."""
    std = 0.01 if effects else 0.0

    def asked(quantity: str, **disorder: Any) -> Any:
        scene = question(
            quantity, 3, 5, dimension=dimension, std=std, effects=effects, realisations=4
        )
        return (scene if disorder else scene.model_copy(update={"disorder": None})).run()

    beads = 5 ** (dimension - 1)
    for drawn in ({}, {"drawn": True}):
        assert set(asked("profile", **drawn).arrays["samples"]) == {4 * beads}
        assert asked("histogram", **drawn).arrays["count"].sum() == 4 * 3 * dimension * beads


def layered(quantity: str, **more: Any) -> fd.Scene:
    return question(quantity, 6, 14, seed=5, **more)


def test_an_ensemble_counts_them_too():
    at: dict[str, Any] = {"realisations": 40, "bins": 6}
    every = fd.ensemble(layered("histogram", **at), reach=0.05)
    each = [fd.ensemble(layered("histogram", layers=[j], **at), reach=0.05) for j in range(6)]
    total = np.sum([ensemble.arrays["count"] for ensemble in each], axis=0)
    assert total.tolist() == every.arrays["count"].tolist()
    assert sum(each[2].arrays["count"]) == 40 * 2 * 14
    profile = fd.ensemble(layered("profile", realisations=40))
    own = profile.std[profile.index["j"] == 2]  # of both branches, about the mean of each
    assert each[2].std == pytest.approx([np.sqrt(np.mean(own**2))], rel=0.01)


def test_its_bins_reach_as_far_as_these_layers_do():
    top, base = (fd.ensemble(layered("histogram", layers=[j]), 40).arrays for j in (5, 0))
    assert top["low"][-1] < base["low"][-1]


def test_it_is_drawn_with_the_gaussians_of_these_layers():
    pytest.importorskip("matplotlib")
    (axes,) = layered("histogram", layers=[5], realisations=20).run().plot().axes
    line = next(curve for curve in axes.lines if len(curve.get_xdata()) == 321)
    v, gauss = line.get_xdata(), line.get_ydata()
    assert gauss == pytest.approx(np.exp(-(v**2) / 2) / np.sqrt(2 * np.pi))
