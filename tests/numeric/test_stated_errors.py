"""Every question, by compiled loops and by NumPy: the stated error holds, and gaps are the same."""

from itertools import product
from typing import Any

import numpy as np
import pytest
from force_diffusion.numeric.arithmetic.systems import FLOAT64, Balls, as_ball
from force_diffusion.numeric.disorder.radii import RadiusError
from force_diffusion.numeric.mechanics import engine
from force_diffusion.numeric.mechanics.physicality import Physicality
from force_diffusion.numeric.mechanics.work import Work
from force_diffusion.numeric.planning.plan import Plan
from force_diffusion.numeric.quantities.answer import answer
from force_diffusion.numeric.run.running import run

from tests.numeric.scenes import planned

pytest.importorskip("numba")

DISORDER = {"kind": "uniform", "relative_std": "=1e-4", "seed": 3}
STRIP = {"height": 21, "width": 46}
SPHERES = {"height": 9, "width": 20, "dimension": 3}
POINT = {"kind": "point", "at": [3, 17]}
CASES: dict[str, dict[str, dict[str, Any]]] = {
    "profile": {"packing": STRIP, "ask": {"quantity": "profile"}},
    "profile, bulk load": {
        "packing": STRIP, "load": {"kind": "bulk", "magnitude": "=3.7"},
        "ask": {"quantity": "profile"},
    },
    "profile, point load": {"packing": STRIP, "load": POINT, "ask": {"quantity": "profile"}},
    "response": {
        "packing": STRIP, "load": POINT, "ask": {"quantity": "response", "layers": [16, 0, 9, 8]},
    },
    "response below the load": {
        "packing": STRIP, "load": POINT, "ask": {"quantity": "response", "layers": [16]},
    },
    "response of a slab": {
        "packing": {"height": 19}, "load": {"kind": "point", "at": [-4, 18], "angle_deg": 7},
        "ask": {"quantity": "response", "layers": [3]},
    },
    "histogram": {"packing": STRIP, "ask": {"quantity": "histogram", "bins": 7}},
    "histogram of a layer": {"packing": STRIP, "ask": {"quantity": "histogram", "layers": [9]}},
    "histogram of a point load": {
        "packing": STRIP, "load": POINT | {"magnitude": "=3.7"}, "ask": {"quantity": "histogram"},
    },
    "contact": {"packing": STRIP, "ask": {"quantity": "contact", "at": [1, 7, "-"]}},
    "contact of a slab": {
        "packing": {"height": 18}, "ask": {"quantity": "contact", "at": [0, 4, "+"]},
    },
    "all forces": {"packing": STRIP, "ask": {"quantity": "contact_forces"}},
    "all forces, in another unit": {
        "packing": STRIP, "load": {"kind": "bulk", "magnitude": "=3.7"},
        "ask": {"quantity": "contact_forces"},
    },
    "all forces of a point load": {
        "packing": STRIP, "load": POINT, "ask": {"quantity": "contact_forces"},
    },
    "whole response": {"packing": STRIP, "load": POINT, "ask": {"quantity": "response"}},
    "positions": {"packing": STRIP, "ask": {"quantity": "positions"}},
    "one position": {"packing": {"height": 21}, "ask": {"quantity": "positions", "at": [1, 15]}},
    "spheres, profile": {"packing": SPHERES, "ask": {"quantity": "profile"}},
    "spheres, forces": {"packing": SPHERES, "ask": {"quantity": "contact_forces"}},
    "spheres, forces of a point load": {
        "packing": SPHERES, "load": {"kind": "point", "at": [1, 2, 7]},
        "ask": {"quantity": "contact_forces"},
    },
    "spheres, response": {
        "packing": SPHERES, "load": {"kind": "point", "at": [1, 2, 7]},
        "ask": {"quantity": "response"},
    },
    "spheres, positions": {"packing": SPHERES, "ask": {"quantity": "positions"}},
    "spheres, one position": {
        "packing": SPHERES, "ask": {"quantity": "positions", "at": [1, 2, 5]},
    },
    "spheres, contact": {
        "packing": SPHERES, "ask": {"quantity": "contact", "at": [1, 2, 3, "2"]},
    },
    "spheres, histogram": {"packing": SPHERES, "ask": {"quantity": "histogram", "bins": 5}},
}  # fmt: skip


def sections(name: str, **disorder: Any) -> dict[str, dict[str, Any]]:
    return {"disorder": DISORDER | disorder, **CASES[name]}


def true_error(plan: Plan) -> float:
    """Of the answer, relative to the largest change: what balls of the same radii say."""
    system, one = Balls(160), range(1)
    table = run(plan).answer.table
    exact = answer(plan.quantity, plan.problem, one, system).table
    with system.active():
        pairs = [
            (as_ball(b), as_ball(a))
            for name in table.small
            for a, b in zip(table.numbers[name], exact.numbers[name], strict=True)
        ]
        largest = max(float(abs(b).upper()) for b, _ in pairs)
        return max(float(abs(b - a).upper()) for b, a in pairs) / largest


@pytest.mark.long(sample=1, share=3)
@pytest.mark.parametrize("name", CASES)
def test_the_stated_error_covers_the_true_one(name: str) -> None:
    for seed, std in product(range(10), ("=1e-8", "=1e-3")):
        made = planned(sections(name, seed=seed, relative_std=std))
        assert true_error(made) <= run(made).accuracy.error_bound, (seed, std)


@pytest.mark.parametrize("name", ["profile", "spheres, profile"])
def test_a_radius_that_is_not_positive_is_named_alike(
    name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Of spheres as (p, q, j), and not by the column in the row of W² beads."""
    made = planned(sections(name, kind="normal", relative_std="=0.45"))
    said = []
    for threshold in (1, 10**9):
        monkeypatch.setattr(engine, "COMPILED_FROM", threshold)
        with pytest.raises(RadiusError) as found:
            run(made)
        said.append(str(found.value))
    assert said[0] == said[1]
    assert len(said[0].split(":")[0].split(",")) == made.problem.dimension


@pytest.mark.long(sample=12)
@pytest.mark.parametrize("kind", ["uniform", "two-point"])
@pytest.mark.parametrize("name", CASES)
def test_gaps_by_compiled_loops_are_those_of_numpy(
    name: str, kind: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    problem = planned(sections(name, kind=kind, relative_std="=0.02")).problem
    found = []
    for threshold in (1, 10**9):
        monkeypatch.setattr(engine, "COMPILED_FROM", threshold)
        physical = Physicality()
        with FLOAT64.active():
            for _ in engine.packings(problem, range(5), FLOAT64, Work(), physical):
                pass
        found.append(physical)
    assert found[0] == found[1]
    assert found[0].smallest_gap is not None
    assert np.isfinite(found[0].smallest_gap)
