"""A tolerance is kept, whatever method is taken to it; choices are sound."""

import itertools
from collections.abc import Iterator
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest
from force_diffusion.numeric.arithmetic.systems import FLOAT64, midpoint
from force_diffusion.numeric.planning import sources
from force_diffusion.numeric.planning.plan import Plan
from force_diffusion.numeric.planning.planner import in_balls
from force_diffusion.numeric.quantities.answer import answer
from force_diffusion.numeric.run import run
from force_diffusion.numeric.run.outcome import Outcome
from force_diffusion.numeric.scene.sections import SceneError
from hypothesis import given
from hypothesis import strategies as st

import force_diffusion as fd
from tests.numeric.scenes import basic, planned, scenes
from tests.numeric.test_run import numbers

QUANTITIES = ("contact", "contact_forces", "positions", "profile", "histogram", "response")
TOLERANCES = ("1e-3", "1e-6", "1e-9", "1e-11", "1e-12", "1e-14", "1e-16", "1e-18", "1e-30", "1e-60")
SPACINGS = ("2.05", "2.75", "3.0", "3.4")
# height, width (None: the slab); 4 on 3 is a strip that sees its images
SHAPES: tuple[tuple[int, int | None], ...] = ((4, 9), (3, 4), (5, None), (4, 3))


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
    table = answer(plan.quantities, plan.problem, realisations, plan.system).table
    values = [midpoint(value) for value in table.numbers["change"]]
    edges = [(Fraction(row["low"]), Fraction(row["high"])) for row in bins]
    alike = (plan.scene.ask.realisations or 1) // plan.problem.realisations
    return [alike * sum(low <= value < high for value in values) for low, high in edges]


def assert_kept(outcome: Outcome, true: Outcome, tolerance: Fraction) -> None:
    """Compare what was printed, relative to the largest change."""
    assert outcome.accuracy.error_bound <= tolerance
    assert true.accuracy.certified
    if outcome.plan.scene.ask.quantity == "histogram":
        assert recounted(outcome.decimals(), true.plan) == [
            row["count"] for row in outcome.decimals()
        ]
        return
    largest = max((abs(Fraction(v)) for _, v in numbers(true, True)), default=0)
    rows = zip(numbers(outcome, True), numbers(true, True), strict=True)
    error = max((abs(Fraction(a) - Fraction(b)) for (_, a), (_, b) in rows), default=0)
    assert error <= tolerance * largest
    # what is stated holds, too, and not only what was asked for
    assert error <= Fraction(outcome.accuracy.error_bound) * largest * Fraction(1001, 1000)


def grid() -> Iterator[Any]:
    """Every quantity, geometry and load; shapes, spacings, disorder and tolerances take turns."""
    loads: tuple[dict[str, Any], ...] = (
        {"kind": "surface"}, {"kind": "bulk", "angle_deg": 12}, {"kind": "point"}
    )  # fmt: skip
    turn = itertools.count()
    for quantity, geometry, load in itertools.product(QUANTITIES, ("exact", "first-order"), loads):
        k = next(turn)
        height, width = SHAPES[k % len(SHAPES)]
        point = quantity == "response" or load["kind"] == "point"
        listed = quantity in {"positions", "profile", "histogram", "contact_forces"}
        if width is None and listed:
            height, width = SHAPES[0]
        here = {"kind": "point", "at": [height % 2, height]} if point else load
        sections = basic(height, width, quantity=quantity)
        sections["packing"] |= {"spacing": f"={SPACINGS[k % 3 + k % 2]}", "allow_images": True}
        std = ("=2e-3", "=1e-7", "=1e-40")[k % 3 if quantity != "histogram" else 1]
        sections["disorder"] |= {"relative_std": std, "kind": ("uniform", "normal")[k % 2]}
        sections |= {"load": here, "effects": {"geometry": geometry}}
        if quantity == "contact":
            sections["ask"]["at"] = [k % 2, k % 2, "+-"[k // 2 % 2]]
        if k % 4 >= 2:
            sections["ask"]["realisations"] = 5
        for step in (0, 5) if geometry == "exact" else (0,):
            tolerance = TOLERANCES[(k + step) % len(TOLERANCES)]
            ask = {**sections["ask"], "tolerance": f"={tolerance}"}
            name = f"{quantity}-{geometry}-{here['kind']}-{tolerance}"
            yield pytest.param({**sections, "ask": ask}, id=name)


@pytest.mark.long(sample=36)
@pytest.mark.parametrize("sections", list(grid()))
def test_every_way_that_may_answer_keeps_the_tolerance(
    sections: dict[str, dict[str, Any]],
) -> None:
    """Not only the first."""
    plan, true = planned(sections), reference(sections)
    assert plan.tolerance is not None
    for way in both(plan):
        outcome = run(way)
        assert_kept(outcome, true, plan.tolerance)
        assert outcome.accuracy.certified == outcome.plan.certified


def test_changes_that_float64_can_not_hold_are_left_to_balls() -> None:
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
def test_any_scene_keeps_its_tolerance(sections: dict[str, dict[str, Any]], wanted: str) -> None:
    sections["ask"]["tolerance"] = f"={wanted}"
    plan = planned(sections)
    true = reference(sections)
    for way in both(plan):
        outcome = run(way)
        assert_kept(outcome, true, Fraction(wanted))
        outcome.data()


@pytest.mark.parametrize("tolerance", ["1e-3", "1e-13", "1e-15"])
def test_float64_does_answer(tolerance: str) -> None:
    """Were its estimates too careful, balls would answer everything, and the tests above hold."""
    outcome = run(planned(basic(tolerance=f"={tolerance}")))
    assert outcome.plan.system is FLOAT64
    assert not outcome.plan.reason
    assert not outcome.accuracy.certified
    assert "estimated" in outcome.accuracy.note


def test_certified_leaves_balls_alone() -> None:
    plan = planned(basic(tolerance="=1e-3", certified=True))
    assert (plan.certified, plan.reason) == (True, "only balls certify")
    with pytest.raises(SceneError, match=r"ask\.certified.*tolerance"):
        planned(basic(certified=True))


def test_what_only_balls_decide_is_left_to_them() -> None:
    high = basic(24, 25, tolerance="=1e-3")
    high["disorder"]["relative_std"] = "=1e-2"
    tiny = basic(tolerance="=1e-3")
    tiny["disorder"]["relative_std"] = "=1e-400"
    sharp = basic(tolerance="=1e-20", realisations=9)
    for sections, why in ((high, r"M*/2"), (tiny, "float64 can't hold"), (sharp, "to err by")):
        plan = planned(sections)
        assert plan.certified
        assert why in plan.reason


def test_an_effect_is_never_replaced() -> None:
    for geometry in ("exact", "first-order"):
        sections = {**basic(tolerance="=1e-3"), "effects": {"geometry": geometry}}
        assert {way.problem.route for way in both(planned(sections))} == {geometry}


def test_a_contact_that_no_load_comes_near_has_one_row_a_realisation() -> None:
    """Its sweep would be the ordered packing, and that one solved once."""
    sections = basic(6, 21, quantity="contact", at=[30, 2, "+"], realisations=5)
    sections |= {"effects": {"geometry": "first-order"}, "load": {"kind": "point", "at": [6, 6]}}
    plain = run(planned(sections)).decimals()
    sections["ask"]["tolerance"] = "=1e-6"
    rows = run(planned(sections)).decimals()
    assert [row["realisation"] for row in rows] == [0, 1, 2, 3, 4]
    assert rows == plain


def test_a_change_about_as_small_as_its_error_is_within_the_stated_bound() -> None:
    """Two-point radii leave changes of second order, here 9e-16 of the largest one."""
    sections = basic(11, 6, quantity="positions", realisations=6, tolerance="=1e-12")
    sections["packing"] |= {"spacing": "=2.9999813928", "allow_images": True}
    sections["disorder"] = {"kind": "two-point", "relative_std": "=2e-16", "seed": 611859}
    true, plan = reference(sections), planned(sections)
    outcome = run(plan)
    assert outcome.plan.system is FLOAT64
    assert_kept(outcome, true, Fraction(1, 10**12))


def test_an_estimate_that_misses_gives_way(monkeypatch: pytest.MonkeyPatch) -> None:
    """Balls answer, and the outcome says why float64 did not."""
    plan = planned(basic(tolerance="=1e-9"))
    assert not plan.certified
    monkeypatch.setattr("force_diffusion.numeric.arithmetic.carried.PRINTED", 10**9)
    outcome = run(plan)
    assert outcome.accuracy.certified
    assert "float64 was tried: the error is still" in outcome.data()["plan"]["reason"]


def test_radii_from_a_file_are_looked_through_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """A plan asks for their scatter again and again; each look takes as long as an answer."""
    looks = []

    class Counted(dict[tuple[int, int], Fraction]):
        def values(self) -> Any:
            looks.append(1)
            return super().values()

    found = sources.read_radii
    monkeypatch.setattr(sources, "read_radii", lambda *a, **k: Counted(found(*a, **k)))
    measured = fd.read_scene(Path(__file__).parents[3] / "scenes" / "measured.toml")
    measured.run("1e-12")
    assert len(looks) == 2  # for the scatter, and for the smallest
