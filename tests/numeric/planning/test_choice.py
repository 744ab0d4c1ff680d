"""A tolerance is kept, whatever method is taken to it; choices are sound."""

from collections.abc import Iterator
from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from force_diffusion.numeric.accuracy import Accuracy, edge_in_doubt
from force_diffusion.numeric.arithmetic.systems import FLOAT64, midpoint
from force_diffusion.numeric.planning.plan import Plan
from force_diffusion.numeric.planning.planner import in_balls
from force_diffusion.numeric.quantities.answer import answer
from force_diffusion.numeric.quantities.base import Table
from force_diffusion.numeric.run.outcome import Outcome
from force_diffusion.numeric.run.running import run
from force_diffusion.numeric.scene.sections import SceneError
from hypothesis import given
from hypothesis import strategies as st

from tests.numeric.scenes import basic, by_numpy, planned, scenes
from tests.numeric.test_run import numbers, unit_of_last_digit

TOLERANCES = ("1e-3", "1e-6", "1e-9", "1e-11", "1e-12", "1e-14", "1e-16", "1e-18", "1e-30", "1e-60")


def both(plan: Plan) -> Iterator[Plan]:
    """Give the plan in float64, where that may meet the tolerance, and in balls."""
    if not plan.certified:
        yield plan
        plan = in_balls(plan, "")
    yield plan


def reference(sections: dict[str, dict[str, Any]]) -> Outcome:
    """Certify far more digits than are asked for."""
    tolerance = Fraction(sections["ask"]["tolerance"][1:]) / 10**15
    digits = len(str(tolerance.denominator)) + 1
    ask = {**sections["ask"], "tolerance": f"=1e-{digits}", "certified": True}
    return run(planned({**sections, "ask": ask}))


def recounted(bins: list[dict[str, Any]], plan: Plan) -> list[int]:
    """Count the true changes into the printed bins; of realisations that are alike, all of them."""
    realisations = range(plan.problem.realisations)
    table = answer(plan.quantities, plan.problem, realisations, plan.system).tables[0]
    values = [midpoint(value) for value in table.numbers["change"]]
    edges = [(Fraction(row["low"]), Fraction(row["high"])) for row in bins]
    alike = (plan.scene.ask.realisations or 1) // plan.problem.realisations
    return [alike * sum(low <= value < high for value in values) for low, high in edges]


def assert_kept(outcome: Outcome, true: Outcome, tolerance: Fraction) -> None:
    """Compare what was printed, relative to the largest change."""
    assert outcome.accuracy.error_bound <= tolerance
    assert true.accuracy.certified
    if outcome.plan.scene.ask.quantity == "histogram":
        bins = outcome.decimals()
        assert recounted(bins, true.plan) == [row["count"] for row in bins]
        return
    largest = max((abs(Fraction(v)) for _, v in numbers(true, True)), default=0)
    rows = zip(numbers(outcome, True), numbers(true, True), strict=True)
    error = max((abs(Fraction(a) - Fraction(b)) for (_, a), (_, b) in rows), default=0)
    assert error <= tolerance * largest
    # what is stated holds, too, and not only what was asked for
    assert error <= Fraction(outcome.accuracy.error_bound) * largest * Fraction(1001, 1000)
    for (name, a), (_, b) in zip(numbers(outcome), numbers(true), strict=True):
        off = abs(Fraction(a) - Fraction(b))
        if outcome.accuracy.certified:  # the last digit is off by one at most
            assert a == "0" or off <= unit_of_last_digit(a) * Fraction(11, 10)
        elif name != "std_over_mean":  # what is no change is rounded once more
            bound = Fraction(outcome.accuracy.error_bound) * largest
            assert off <= bound + abs(Fraction(b)) / 2**50, name


@pytest.mark.parametrize(("value", "near"), [(0.5, True), (0.5 + 1e-9, True), (0.51, False)])
def test_changes_near_the_edge_of_a_bin_are_left_to_balls(value, near):
    table = Table({}, {"change": np.array([0.9, 1.0, value])}, ("change",))
    edges = [Fraction(0), Fraction(1, 2), Fraction(2)]
    assert edge_in_doubt(table, edges, Accuracy(1e-8, False, "float64")) == near


def test_changes_that_float64_can_not_hold_are_left_to_balls():
    """Inside of a load's cone all are zero to first order, and so would be any of second order."""
    sections = basic(4, 6, quantity="contact", at=[1, 1, 1, "1"], tolerance="=1e-3")
    sections["packing"]["dimension"] = 3
    sections["disorder"]["relative_std"] = "=1e-200"
    sections["load"] = {"kind": "point", "at": [2, 2, 4]}
    sections["effects"] = {"geometry": "first-order"}
    outcome = run(planned(sections))
    assert outcome.plan.reason.startswith("float64 was tried: every change is zero")
    assert outcome.accuracy.certified
    assert_kept(outcome, reference(sections), Fraction(1, 1000))


@given(scenes(), st.sampled_from(TOLERANCES))
def test_any_scene_keeps_its_tolerance_compiled_or_not(sections, wanted):
    sections["ask"]["tolerance"] = f"={wanted}"
    plan = planned(sections)
    true = reference(sections)
    for way in both(plan):
        outcome = run(way)
        assert_kept(outcome, true, Fraction(wanted))
        with by_numpy():
            assert run(way).data()["results"] == outcome.data()["results"]


@pytest.mark.parametrize("tolerance", ["1e-3", "1e-13", "1e-15"])
def test_float64_does_answer(tolerance):
    """Were its estimates too careful, balls would answer everything, and the tests above pass."""
    outcome = run(planned(basic(tolerance=f"={tolerance}")))
    assert outcome.plan.system is FLOAT64
    assert not outcome.plan.reason
    assert not outcome.accuracy.certified
    assert "estimated" in outcome.accuracy.note


def test_certified_leaves_balls_alone():
    plan = planned(basic(tolerance="=1e-3", certified=True))
    assert (plan.certified, plan.reason) == (True, "only balls certify")
    with pytest.raises(SceneError, match=r"ask\.certified.*tolerance"):
        planned(basic(certified=True))


def test_what_only_balls_decide_is_left_to_them():
    high = basic(24, 25, tolerance="=1e-3")
    high["disorder"]["relative_std"] = "=1e-2"
    tiny = basic(tolerance="=1e-3")
    tiny["disorder"]["relative_std"] = "=1e-400"
    sharp = basic(tolerance="=1e-20", realisations=9)
    for sections, why in ((high, r"M*/2"), (tiny, "float64 can't hold"), (sharp, "to err by")):
        plan = planned(sections)
        assert plan.certified
        assert why in plan.reason


def test_an_effect_is_never_replaced():
    for geometry in ("exact", "first-order"):
        sections = {**basic(tolerance="=1e-3"), "effects": {"geometry": geometry}}
        assert {way.problem.route for way in both(planned(sections))} == {geometry}


def test_a_change_about_as_small_as_its_error_is_within_the_stated_bound():
    """Two-point radii leave changes of second order, here 9e-16 of the largest one."""
    sections = basic(11, 6, quantity="positions", realisations=6, tolerance="=1e-12")
    sections["packing"] |= {"spacing": "=2.9999813928", "allow_images": True}
    sections["disorder"] = {"kind": "two-point", "relative_std": "=2e-16", "seed": 611859}
    true, plan = reference(sections), planned(sections)
    outcome = run(plan)
    assert outcome.plan.system is FLOAT64
    assert_kept(outcome, true, Fraction(1, 10**12))


def test_an_estimate_that_misses_gives_way(monkeypatch):
    """Balls answer, and the outcome says why float64 did not."""
    plan = planned(basic(tolerance="=1e-9"))
    assert not plan.certified
    monkeypatch.setattr("force_diffusion.numeric.arithmetic.carried.PRINTED", 10**9)
    outcome = run(plan)
    assert outcome.accuracy.certified
    assert "float64 was tried: the error is still" in outcome.data()["plan"]["reason"]
