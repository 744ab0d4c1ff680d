"""Counts beside what they have to be: counting one by one."""

from bisect import bisect_right
from collections import Counter
from fractions import Fraction
from typing import Any

import pytest

import force_diffusion as fd
from tests.numeric.scenes import question


def scene(quantity: str, **ask: Any) -> fd.Scene:
    return question(quantity, 2, 64, seed=3, realisations=3, **ask)


@pytest.mark.parametrize("bins", [1, 2, 7, 100])
@pytest.mark.parametrize("tolerance", [None, "1e-30"])
def test_counts_are_those_of_the_changes(bins: int, tolerance: str | None) -> None:
    """A change belongs to the bin of low ≤ change < high."""
    rows = scene("histogram", bins=bins).run(tolerance).decimals()
    listed = scene("contact_forces").run(tolerance).decimals()
    edges = [Fraction(row["low"]) for row in rows]
    expected = Counter(bisect_right(edges, Fraction(row["change"])) for row in listed)
    assert [row["count"] for row in rows] == [expected[place] for place in range(1, bins + 1)]
    assert expected.total() == 3 * 2 * 2 * 64


@pytest.mark.parametrize("effects", [{"geometry": "ordered"}, {}])
@pytest.mark.parametrize("dimension", [2, 3])
def test_realisations_that_are_alike_are_counted_too(
    effects: dict[str, Any], dimension: int
) -> None:
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
