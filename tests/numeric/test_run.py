"""Answers as a user gets them: bounds hold, routes agree, units and batches change nothing."""

from collections.abc import Iterator
from fractions import Fraction

import numpy as np
import pytest
from force_diffusion.numeric.disorder.radii import RadiusError
from force_diffusion.numeric.mechanics.sweep import UnbuildableError
from force_diffusion.numeric.quantities.answer import answer as gathered
from force_diffusion.numeric.run.outcome import Outcome

import force_diffusion as fd
from tests.numeric.scenes import answer, basic, planned, question, scene

SMALL = {
    "change", "dx", "dy", "change_x", "change_y", "mean_change", "std", "vertical_change",
    "force_mean_change", "force_std", "vertical_mean_change", "vertical_std",
}  # fmt: skip


def unit_of_last_digit(text: str) -> Fraction:
    mantissa, _, exponent = text.partition("e")
    decimals = len(mantissa.partition(".")[2])
    return Fraction(10) ** (int(exponent or 0) - decimals)


def numbers(outcome: Outcome, small_only: bool = False) -> Iterator[tuple[str, str]]:
    for row in outcome.decimals():
        for key, value in row.items():
            wanted = key in SMALL if small_only else key not in {"branch", "first_order_std"}
            if isinstance(value, str) and wanted and value and not key.endswith("_error"):
                yield key, value


def test_statistics_have_standard_errors_and_no_digits_beyond_them():
    outcome = answer(basic(4, 9, quantity="profile", realisations=50))
    for row, printed in zip(outcome.rows(), outcome.decimals(), strict=True):
        for name, of in (("mean", "mean_change"), ("mean_change", "mean_change"), ("std", "std")):
            error = f"{of}_error"
            assert float(printed[error]) == pytest.approx(row[error], rel=0.006)
            # two digits beyond the first of the error, and what is cut off at most half of the last
            assert abs(float(printed[name]) - row[name]) < row[error] / 20
            assert unit_of_last_digit(printed[name]) * 1000 > row[error] / 10
    assert outcome.sampling_error is not None
    assert 0.01 < outcome.sampling_error < 0.5
    assert outcome.data()["accuracy"]["sampling_error"] == outcome.sampling_error
    assert "sampling error 0." in str(outcome)
    alone = answer(basic(4, 9, quantity="profile"))
    assert alone.sampling_error is None
    assert {row["std_error"] for row in alone.decimals()} == {""}


def test_a_profile_under_a_point_load_keeps_the_digits_of_its_changes():
    """The spread of the ordered forces, of order one, stays out of changes of order 1e-30."""
    sections = basic(4, 9, quantity="profile")
    sections["disorder"]["relative_std"] = "=1e-30"
    sections["load"] = {"kind": "point", "at": [4, 4]}
    for row in answer(sections).decimals():
        assert 1e-32 < float(row["std"]) < 1e-28


@pytest.mark.parametrize(
    "quantity", ["contact_forces", "profile", "histogram", "response", "contact"]
)
@pytest.mark.parametrize("tolerance", [None, "=1e-25", "=1e-40"])
def test_forces_come_back_in_the_unit_of_the_load(quantity, tolerance):
    """A power of two as magnitude: every number is multiplied, and not a bit is lost."""
    sections = basic(4, 9, quantity=quantity)
    if tolerance:
        sections["ask"]["tolerance"] = tolerance
    if quantity == "contact":
        sections["ask"]["at"] = [0, 2, "+"]
    load = {"kind": "point", "at": [4, 4]} if quantity == "response" else {"kind": "surface"}
    low, high = (answer({**sections, "load": {**load, **unit}}) for unit in ({}, {"magnitude": 64}))
    for name, column in low.arrays.items():
        same = column.dtype.kind in "iU" or name == "std_over_mean" or name[-1] in "xy"
        expected, result = column if same else column * 64, high.arrays[name]
        if column.dtype == object:
            for a, b in zip(expected, result, strict=True):
                assert (a - b).contains(0) if hasattr(a, "contains") else a == b
        elif name == "first_order_std":  # twelve digits
            np.testing.assert_allclose(result, expected, rtol=1e-11)
        else:
            np.testing.assert_array_equal(result, expected)
    assert float(low.accuracy.error_bound) == pytest.approx(float(high.accuracy.error_bound))


def test_an_ensemble_and_gaps_come_back_in_the_units_of_the_scene():
    def asked(radius: int, magnitude: int) -> fd.Scene:
        load = fd.SurfaceLoad(magnitude=magnitude)
        return question("profile", 4, 9, radius=radius, spacing=3 * radius, load=load)

    low, high = (fd.ensemble(asked(4, magnitude), 40) for magnitude in (1, 64))
    for name in ("mean", "mean_change", "std", "std_error", "first_order_std"):
        assert (getattr(low, name) * 64 == getattr(high, name)).all()
    wide, small = (asked(radius, 1).run() for radius in (4, 1))
    gaps = [outcome.data()["physical"]["smallest_gap"] for outcome in (wide, small)]
    assert gaps[0] == 4 * gaps[1]
    for outcome, gap in zip((wide, small), gaps, strict=True):  # one name, one unit
        assert outcome.physical is not None
        assert outcome.physical.smallest_gap == gap


@pytest.mark.long(sample=8)
@pytest.mark.parametrize(
    ("dimension", "effects"), [(2, "exact"), (2, "first-order"), (3, "exact"), (3, "ordered")]
)
@pytest.mark.parametrize("more", [{}, {"realisations": 3}, {"tolerance": "=1e-25"}])
def test_some_layers_of_a_response_are_those_of_the_whole(dimension, effects, more):
    """Layers may come in any order; with a tolerance, within twice of it."""
    sections = basic(5, 7, **{"quantity": "response", **more})
    at = [2, 4] if dimension == 2 else [1, 2, 4]
    if dimension == 3:
        sections["packing"] |= {"dimension": 3, "spacing": "=2.2"}
    sections |= {"load": {"kind": "point", "at": at}, "effects": {"geometry": effects}}
    whole = answer(sections)
    some = answer({**sections, "ask": {**sections["ask"], "layers": [3, 0]}})
    asked = np.isin(whole.arrays["j"], [0, 3])
    assert 0 < asked.sum() < len(asked)
    for name, column in some.arrays.items():
        if column.dtype == object:
            error = abs(column - whole.arrays[name][asked])
            assert all(float(value) < 2e-25 for value in error)
        else:
            assert column.tobytes() == whole.arrays[name][asked].tobytes(), name


@pytest.mark.parametrize(("beads", "size", "std"), [("ij", (24, 25), 1e-2), ("pqj", (5, 7), 2e-2)])
def test_contacts_that_pull_are_counted_and_the_first_is_named(beads, size, std):
    outcome = question("contact_forces", *size, dimension=len(beads), std=std).run("1e-12")
    pulling = [
        tuple(row[name] for name in (*beads, "branch"))
        for row in outcome.decimals()
        if Fraction(row["force"]) < 0
    ]
    assert outcome.physical is not None
    assert outcome.physical.tensile == len(pulling) > 0
    assert outcome.physical.first_tensile is not None
    assert tuple(outcome.physical.first_tensile.values()) in pulling


def test_a_sign_that_no_precision_settles_stays_open():
    """Equal radii below a point load: inside its cone the forces are exactly zero."""
    delta = np.full((4, 20), 0.01)
    delta[1, 15] = 0.02
    radii, load = fd.GivenRadii(delta_r=delta), fd.PointLoad(at=(11, 3))
    outcome = question("contact_forces", 3, 20, radii=radii, load=load).run(1e-12, certified=True)
    assert outcome.accuracy.certified
    assert outcome.physical is not None
    assert outcome.physical.undecided_signs > 0
    assert outcome.physical.tensile == 0
    assert "open whether it is physical" in str(outcome)


def test_a_realisation_that_can_not_be_built_is_named():
    sections = basic(6, 8, quantity="contact_forces")
    sections["disorder"] |= {"kind": "normal", "relative_std": "=0.08"}
    sections["ask"]["realisations"] = 30
    with pytest.raises((UnbuildableError, RadiusError)) as caught:
        answer(sections)
    (note,) = caught.value.__notes__
    k, made = int(note.removeprefix("realisation ")), planned(sections)
    assert k > 0
    with pytest.raises(type(caught.value)) as again:
        gathered(made.quantities, made.problem, [k], made.system)
    assert str(again.value) == str(caught.value)


@pytest.mark.parametrize("power", [-400, 400])
def test_a_profile_in_units_beyond_floats_is_that_in_others(power):
    loads = (fd.SurfaceLoad(magnitude=Fraction(10) ** k) for k in (0, power))
    usual, other = (question("profile", 4, 10, load=load).run("1e-20").decimals() for load in loads)
    for a, b in zip(usual, other, strict=True):
        for name in ("first_order_std", "std", "mean"):
            shift = Fraction(a[name]) * Fraction(10) ** power / Fraction(b[name])
            assert abs(shift - 1) < Fraction(1, 10**10), name


def test_standard_errors_in_units_beyond_floats_are_not_known():
    """Some of the errors are 0 before they get their unit, as with radii that are drawn alike."""
    outcome = question(
        "response", 1, 4, dimension=3, kind="two-point", std=0.06, seed=556, realisations=3,
        load=fd.PointLoad(at=(3, 3, 1), magnitude=Fraction(10) ** 400),
    ).run("1e-20")  # fmt: skip
    assert not any(np.isfinite(error).any() for error in outcome.standard_errors.values())


def test_progress_is_shown(capsys, monkeypatch):
    monkeypatch.setenv("FORCE_COLOR", "1")  # as on a terminal
    monkeypatch.setenv("TERM", "xterm")
    fd.run(scene(basic(4, 9, realisations=30)), progress=True)
    shown = capsys.readouterr().err
    assert "solving" in shown
    assert "100%" in shown
    fd.ensemble(scene(basic(4, 9, quantity="profile")), 200, until=0.2, progress=True)
    shown = capsys.readouterr().err
    assert "of 200 realisations" in shown
    assert "until 0.2" in shown
