"""Cascades: what is counted agrees with a count by other means, and the contact is the weakest."""

from fractions import Fraction

import numpy as np
import pytest

import force_diffusion as fd


@pytest.fixture(scope="module")
def study() -> fd.CascadeStudy:
    return fd.cascade(heights=[6], packings=3, protocol="event-driven")


def packing(row: dict[str, object], factor: Fraction, **effects: str) -> fd.Outcome:
    std = Fraction(str(row["relative_std"])) * factor
    return fd.Scene(
        packing=fd.Packing(height=row["height"], width=row["width"]),
        disorder=fd.Disorder(kind="uniform", relative_std=std, seed=row["packing"]),
        load=fd.BulkLoad() if row["load"] == "bulk" else fd.SurfaceLoad(),
        effects=fd.Effects(**effects),
        ask=fd.Ask(quantity="contact_forces"),
    ).run()


def test_exactly_one_contact_pulls_and_none_just_below(study: fd.CascadeStudy) -> None:
    for row in study.rows():
        there = packing(row, Fraction(1)).physical
        below = packing(row, 1 - Fraction(1, 10**5)).physical
        assert there is not None
        assert below is not None
        assert (there.tensile, below.tensile) == (1, 0)


def test_the_shares_are_those_of_two_runs(study: fd.CascadeStudy) -> None:
    for row in study.rows():
        before = packing(row, Fraction(1)).rows()
        after = packing(row, Fraction(1), contacts="unilateral", protocol="event-driven").rows()
        old = {(r["i"], r["j"], r["branch"]): float(r["force"]) for r in before}
        new = {
            (r["i"], r["j"], r["branch"] or (r["upper_i"], r["upper_j"])): float(r["force"])
            for r in after
        }
        change = np.array([abs(old.get(key, 0.0) - new.get(key, 0.0)) for key in old | new])
        mean = np.mean(list(old.values()))
        assert (change > 0.01 * mean).mean() == pytest.approx(row["forces_1"])
        assert (change > 0.1 * mean).mean() == pytest.approx(row["forces_10"])
        assert len(set(new) - set(old)) / len(new) == pytest.approx(row["new"])


def test_a_summary_has_a_row_a_load(study: fd.CascadeStudy) -> None:
    assert [row["load"] for row in study.summary()] == ["surface", "bulk"]
    assert study.plot().axes


@pytest.mark.parametrize("wrong", [{"heights": [1]}, {"heights": []}, {"packings": 1}])
def test_wrong_sizes_are_refused(wrong: dict[str, object]) -> None:
    with pytest.raises(fd.ForceDiffusionError, match="cascade"):
        fd.cascade(**wrong)  # type: ignore[arg-type]


def test_an_unknown_protocol_is_refused() -> None:
    with pytest.raises(fd.ForceDiffusionError, match="event-driven"):
        fd.cascade(protocol="molecular")  # type: ignore[arg-type]
