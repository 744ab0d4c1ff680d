"""Studies of cost: what the rows say; nothing here depends on how long anything takes."""

from dataclasses import fields
from decimal import Decimal
from fractions import Fraction
from typing import Any

import flint
import pytest
from force_diffusion.numeric.arithmetic.systems import FLOAT64, Balls
from force_diffusion.numeric.planning.planner import plan
from force_diffusion.numeric.scene.sections import SceneError
from force_diffusion.numeric.studies import timing
from force_diffusion.numeric.studies.cost import cost
from force_diffusion.numeric.studies.cost_plot import lines
from force_diffusion.numeric.studies.distances import answer, decimal
from force_diffusion.numeric.studies.reference import BEYOND
from force_diffusion.numeric.studies.rows import Way, marked, pareto
from force_diffusion.numeric.studies.table import CostStudy
from force_diffusion.numeric.studies.ways import systems
from hypothesis import given
from hypothesis import strategies as st

from tests.numeric.scenes import basic, scene


@pytest.fixture(autouse=True)
def _one_run(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(timing, "LEAST_RUNS", 1)
    monkeypatch.setattr(timing, "ENOUGH_SECONDS", 0.0)


def profile(geometry: str = "exact", **ask: Any) -> dict[str, dict[str, Any]]:
    sections = basic(5, 12, quantity="profile", **{"realisations": 8, **ask})
    sections["effects"] = {"geometry": geometry}
    return sections


def one(found: CostStudy, way: str, arithmetic: str = "float64") -> Way:
    (row,) = [r for r in found.ways if (r.way, r.arithmetic) == (way, arithmetic)]
    return row


def reasons(found: CostStudy) -> dict[str, str]:
    return {s.effect: s.reason for s in found.skipped}


def check_certified(found: CostStudy) -> None:
    reference = found.reference
    assert reference.kind == "certified"
    assert reference.radius < Decimal(10) ** -310
    for row in found.ways:
        assert reference.radius * 1000 < row.error
        assert row.sampling_error is None
        assert row.model_error is not None
        assert row.rounding_error is not None
        assert row.error <= row.model_error + row.rounding_error + 2 * reference.radius
        if row.arithmetic.startswith("arb"):
            assert row.certified_bound is not None
            assert row.error <= row.certified_bound + 2 * reference.radius
        else:
            assert row.certified_bound is None
        assert row.seconds_min <= row.seconds <= row.seconds_max
        assert row.runs >= 1
        assert row.peak_bytes > 0
    assert found.ways == marked(found.ways)
    assert any(row.pareto for row in found.ways)


def test_one_periodic_packing() -> None:
    found = cost(scene(basic(4, 6)))
    check_certified(found)
    arithmetics = {system.name for system in systems()}
    assert len(arithmetics) >= 11
    assert {r.arithmetic for r in found.ways if r.way == "exact"} == arithmetics
    exact = one(found, "exact")
    assert exact.error <= Decimal("1e-12")
    assert exact.model_error == 0
    linear = one(found, "first-order line sums")
    assert linear.rounding_error is not None
    assert linear.rounding_error <= Decimal("1e-12") < Decimal("1e-8") < linear.error
    assert set(reasons(found)) >= {
        "printed asymptotic formula", "exact finite-M formula", "Monte Carlo"
    }  # fmt: skip
    assert found.sampling_floor is None


@pytest.mark.long(sample=2)
@pytest.mark.parametrize(
    ("sections", "way", "why"),
    [
        (basic(4, 6) | {"effects": {"geometry": "first-order"}}, "exact", "asks"),
        (
            profile() | {"load": {"kind": "point", "at": [1, 5]}},
            "exact finite-M formula",
            "one packing is studied",
        ),
    ],
)
def test_what_does_not_apply_is_listed_with_the_reason(
    sections: dict[str, dict[str, Any]], way: str, why: str
) -> None:
    found = cost(scene(sections))
    check_certified(found)
    assert why in reasons(found)[way]
    assert way not in {row.way for row in found.ways}
    own = "first-order line sums"
    if sections.get("effects", {}).get("geometry") != "first-order":
        own = "exact"
    assert one(found, own).error <= Decimal("1e-12")


def test_an_ensemble_has_an_estimated_reference_and_a_floor() -> None:
    found = cost(scene(profile()))
    assert found.reference.kind == "estimated"
    assert found.reference.radius > 0
    assert found.sampling_floor is not None
    exact, printed = one(found, "exact finite-M formula"), one(found, "printed asymptotic formula")
    assert exact.error < printed.error
    assert exact.sampling_error is None
    for way in ("Monte Carlo, exact", "Monte Carlo, first-order"):
        rows = [row for row in found.ways if row.way == way]
        assert sorted(row.realisations or 0 for row in rows) == [2, 8]
        for row in rows:
            assert row.certified_bound is None
            assert row.sampling_error is not None
            assert row.model_error is not None
            assert row.rounding_error is not None
            assert row.rounding_error <= Decimal("1e-12") < row.sampling_error
            # the floor belongs to the largest ensemble; smaller ones scatter √4 times as much
            assert row.sampling_error < 12 * found.sampling_floor
            assert row.error <= (row.model_error + row.sampling_error) * Decimal("1.001")
        exactly = way == "Monte Carlo, exact"
        assert all((row.model_error == 0) is exactly for row in rows)


def test_a_first_order_ensemble_is_known_exactly() -> None:
    found = cost(scene(profile("first-order")))
    assert found.reference.radius == 0
    formula = one(found, "exact finite-M formula")
    assert formula.model_error == 0
    assert formula.error <= Decimal("1e-12")
    assert "Monte Carlo, exact" in reasons(found)


@pytest.mark.parametrize("change", [{"disorder": {}}, {"effects": {"geometry": "ordered"}}])
def test_without_any_change_there_is_nothing_to_measure(change: dict[str, Any]) -> None:
    sections = {k: v for k, v in (basic() | change).items() if v}
    with pytest.raises(SceneError, match="exactly zero"):
        cost(scene(sections))


def test_a_contact_that_no_load_reaches() -> None:
    sections = basic(5, 20, quantity="contact", at=[21, 1, "+"])
    with pytest.raises(SceneError, match="exactly zero"):
        cost(scene(sections | {"load": {"kind": "point", "at": [1, 3]}}))


points = st.tuples(
    st.sampled_from([0.5, 1.0, 2.0, 3.0]) | st.floats(1e-6, 1e3),
    st.sampled_from([Decimal(1), Decimal("1e-400")]) | st.decimals("1e-350", 1, places=360),
)


@given(st.lists(points, min_size=1, max_size=12))
def test_the_pareto_front(found: list[tuple[float, Decimal]]) -> None:
    front = pareto(found)
    best = [point for point, on in zip(found, front, strict=True) if on]
    assert best
    for (s, e), on in zip(found, front, strict=True):
        beaten = [(t, d) for t, d in best if t <= s and d <= e and (t, d) != (s, e)]
        assert bool(beaten) is not on  # each point is on the front or beaten by one that is
    ordered = sorted(set(best))
    assert [e for _, e in ordered] == sorted((e for _, e in ordered), reverse=True)


def test_errors_are_rounded_up_and_may_be_smaller_than_floats() -> None:
    with Balls(2000).active():
        third = flint.arb(flint.fmpq(1, 3)) * flint.arb(10) ** -400
        assert decimal(third) == Decimal("3.3334e-401")
        assert decimal(flint.arb(0)) == 0
    assert Fraction(1, 10**310) > BEYOND


def test_the_data_say_how_they_came_about() -> None:
    found = cost(scene(basic(2, 4)))
    data = found.data()
    assert [row["error"] for row in data["rows"]] == sorted(
        (row["error"] for row in data["rows"]), key=Decimal, reverse=True
    )
    assert set(data["rows"][0]) == {field.name for field in fields(Way)}
    assert data["reference"]["kind"] == "certified"
    assert "tracemalloc" in data["peak_memory"]
    for row in found.listed():
        assert row["reference_radius"] == data["reference"]["radius"]
    text = str(found)
    for skip in data["skipped"]:
        assert skip["reason"] in text
    assert text.count("\n* ") == sum(row["pareto"] for row in data["rows"])


def test_the_float64_row_is_the_answer_of_a_run() -> None:
    planned = plan(scene(basic(3, 5)))
    table = answer(planned, FLOAT64, [0])
    assert len(table.numbers["change"]) == 2 * 3 * 5


def test_arrays_rows_and_decimals_say_the_same() -> None:
    found = cost(scene(basic(2, 4)))
    rows, decimals = found.rows(), found.data()["rows"]
    assert len(rows) == len(decimals) == len(found.ways)
    for column in found.arrays.values():
        assert column.shape == (len(rows),)
    for row, exact, error in zip(rows, decimals, found.arrays["error"], strict=True):
        assert row["error"] == error == pytest.approx(float(exact["error"]), rel=0.01)
        assert (row["certified_bound"] is None) == (row["arithmetic"][:3] != "arb")
    assert found._repr_html_().count("<tr>") == 1 + min(len(rows), 20)


def test_a_line_joins_ensembles_by_their_size() -> None:
    """Errors of ensembles scatter: by error, a line would go back and forth in time."""
    nothing = {"model_error": Decimal(0), "rounding_error": Decimal(0)}
    rows = [
        Way(
            way="Monte Carlo", arithmetic="float64", realisations=N, error=Decimal(error),
            **nothing, seconds=N / 100, seconds_min=0.1, seconds_max=9.0, runs=3,
            peak_bytes=1, peak_is_bound=False,
        )
        for N, error in ((40, "0.01"), (10, "0.02"), (160, "0.03"))
    ]  # fmt: skip
    (line,) = lines(rows)
    assert [row.realisations for row in line] == [10, 40, 160]


def test_a_clock_that_did_not_tick_tells_a_time(monkeypatch: pytest.MonkeyPatch) -> None:
    """As where a machine is crowded, or counts in steps of 15 ms."""
    monkeypatch.setattr(timing, "process_time", lambda: 0.0)
    monkeypatch.setattr(timing, "MOST_RUNS", 3)
    study = cost(scene(basic(2, 4)))
    assert all(row.seconds > 0 for row in study.ways)
    pytest.importorskip("matplotlib")
    assert study.plot("of a still clock").axes


def test_the_plot_has_all_of_the_front_within_its_axes() -> None:
    found = cost(scene(basic(2, 4)))
    (axes,) = found.plot("a scene").axes
    marks = [one.lines[0] for one in axes.containers if len(one.lines[0].get_xdata())]
    filled = [mark for mark in marks if mark.get_markerfacecolor() != "white"]
    assert len(filled) == sum(way.pareto for way in found.ways)
    for mark in marks:
        for (low, high), (value,) in (
            (axes.get_xlim(), mark.get_xdata()),
            (axes.get_ylim(), mark.get_ydata()),
        ):
            assert low < value < high


@pytest.mark.parametrize("std", ["=1e-100", "=1e-160", "=1e-290", "=1e-299"])
def test_disorder_whose_square_no_float_holds(std: str) -> None:
    """Relative errors are those at 1e-9: to first order σ_f is proportional to σ/r."""

    def errors(std: str) -> list[Decimal]:
        sections = profile("exact")
        sections["disorder"]["relative_std"] = std
        found = cost(scene(sections))
        assert found.sampling_floor is not None
        rows = sorted(found.ways, key=lambda row: (row.way, row.realisations or 0))
        sampled = [row.error for row in rows if row.sampling_error is not None]
        assert len(sampled) == 4
        return [found.sampling_floor, *sampled]

    for found, expected in zip(errors(std), errors("=1e-9"), strict=True):
        assert float(found) == pytest.approx(float(expected), rel=1e-4)
        assert 0.01 < found < 1
