"""Every question, by compiled loops and by NumPy: the stated error holds, and gaps are the same."""

from contextlib import nullcontext
from fractions import Fraction
from itertools import product
from typing import Any

import flint
import numpy as np
import pytest
from force_diffusion.numeric.accuracy import known_digits
from force_diffusion.numeric.arithmetic.systems import Balls, as_ball, largest_of
from force_diffusion.numeric.disorder.radii import RadiusError
from force_diffusion.numeric.quantities.answer import answer
from force_diffusion.numeric.quantities.base import RATIO
from force_diffusion.numeric.run.outcome import Outcome
from force_diffusion.numeric.run.running import run
from hypothesis import assume, given
from hypothesis import strategies as st

from tests.numeric.scenes import by_numpy, planned

pytest.importorskip("numba")

DISORDER = {"kind": "uniform", "relative_std": "=1e-4", "seed": 3}
STRIP = {"height": 21, "width": 46}
SPHERES = {"height": 6, "width": 13, "dimension": 3}
POINT = {"kind": "point", "at": [3, 17]}
CASES: dict[str, dict[str, dict[str, Any]]] = {
    "profile, bulk load": {
        "packing": STRIP, "load": {"kind": "bulk", "magnitude": "=3.7"},
        "ask": {"quantity": "profile"},
    },
    "profile, point load": {"packing": STRIP, "load": POINT, "ask": {"quantity": "profile"}},
    "response": {
        "packing": STRIP, "load": POINT, "ask": {"quantity": "response", "layers": [16, 0, 9, 8]},
    },
    "response of a slab": {
        "packing": {"height": 19}, "load": {"kind": "point", "at": [-4, 18], "angle_deg": 7},
        "ask": {"quantity": "response", "layers": [3]},
    },
    "histogram": {"packing": STRIP, "ask": {"quantity": "histogram", "bins": 7}},
    "histogram of a point load": {
        "packing": STRIP, "load": POINT | {"magnitude": "=3.7"}, "ask": {"quantity": "histogram"},
    },
    "contact": {"packing": STRIP, "ask": {"quantity": "contact", "at": [1, 7, "-"]}},
    "contact of a slab": {
        "packing": {"height": 18}, "ask": {"quantity": "contact", "at": [0, 4, "+"]},
    },
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
    "spheres, forces of a point load": {
        "packing": SPHERES, "load": {"kind": "point", "at": [1, 2, 5]},
        "ask": {"quantity": "contact_forces"},
    },
    "spheres, response": {
        "packing": SPHERES, "load": {"kind": "point", "at": [1, 2, 5]},
        "ask": {"quantity": "response"},
    },
    "spheres, positions": {"packing": SPHERES, "ask": {"quantity": "positions"}},
    "spheres, contact": {
        "packing": SPHERES, "ask": {"quantity": "contact", "at": [1, 2, 3, "2"]},
    },
    "response of few beads": {
        "packing": {"height": 2, "width": 6}, "ask": {"quantity": "response"},
        "load": {"kind": "point", "at": [0, 2], "magnitude": "=4336.69", "angle_deg": -3},
    },
    "spheres, histogram": {"packing": SPHERES, "ask": {"quantity": "histogram", "bins": 5}},
}  # fmt: skip


def sections(name: str, **disorder: Any) -> dict[str, dict[str, Any]]:
    return {"disorder": DISORDER | disorder, **CASES[name]}


def beyond(outcome: Outcome) -> float:
    """How far printed decimals are off at the most, in units of what is stated of them.

    Truth is what balls of the same radii say. Changes are within the stated error times the largest
    of them, all else within 2^-50 of itself more.
    """
    plan, system, found = outcome.plan, Balls(220), [0.0]
    exact = answer(plan.quantities, plan.problem, range(1), system).table
    with system.active():
        true = {
            name: [as_ball(value).mid() for value in column]
            for name, column in exact.numbers.items()
        }
        largest = largest_of(abs(value) for name in exact.small for value in true[name])
        stated = as_ball(outcome.accuracy.error_bound) * largest
        for name in true if outcome.table.bins is None else ():
            for text, value, mean in zip(
                outcome.text[name], true[name], true.get("mean", true[name]), strict=True
            ):
                own = 0 if name in exact.small else abs(value) * 2.0**-50
                allowed = stated / (abs(mean) if name == RATIO else 1) + own
                off = abs(flint.arb(text) - value)
                if off > 1e-40:  # else below what these balls enclose of an exact zero
                    found.append(float((off / allowed).upper()))
    return max(found)


@pytest.mark.long(sample=4)
@pytest.mark.parametrize("name", CASES)
def test_the_stated_error_covers_what_is_printed_whether_compiled_or_not(name: str) -> None:
    for seed, std in product(range(2), ("=1e-8", "=1e-3", "=1e-140", "=1e-160")):
        made = planned(sections(name, seed=seed, relative_std=std))
        found = run(made)
        with by_numpy():
            other = run(made)
        assert other.accuracy == found.accuracy
        assert other.data()["results"] == found.data()["results"]
        assert beyond(found) <= 1, (seed, std)


@given(st.floats(-1e200, 1e200), st.floats(2.0**-52, 1e3))
def test_printing_takes_half_of_the_stated_error(value: float, ratio: float) -> None:
    """Of a change: the other half is what the number itself may be off."""
    error = abs(value) * ratio
    assume(error > 1e-290)
    (text,) = known_digits(np.array([value]), error)
    assert abs(Fraction(text) - Fraction(value)) <= Fraction(error) / 2 * (1 + Fraction(1, 10**15))


@pytest.mark.parametrize("name", ["profile, bulk load", "spheres, profile"])
def test_a_radius_that_is_not_positive_is_named_alike(name: str) -> None:
    """Of spheres as (p, q, j), and not by the column in the row of W² beads."""
    made = planned(sections(name, kind="normal", relative_std="=0.45"))
    said = []
    for way in (nullcontext, by_numpy):
        with way(), pytest.raises(RadiusError) as found:
            run(made)
        said.append(str(found.value))
    assert said[0] == said[1]
    assert len(said[0].split(":")[0].split(",")) == made.problem.dimension
