"""``fd.ensemble``: arrays, rows and data of one result, and what it refuses."""

import json
import math

import pytest
from force_diffusion.numeric.arithmetic.errors import ArgumentError
from force_diffusion.numeric.ensemble import ensemble as module
from force_diffusion.numeric.tables import rows_of

import force_diffusion as fd
from tests.numeric.ensemble.cases import CASES, PROFILE
from tests.numeric.scenes import basic, scene


@pytest.mark.parametrize("name", CASES)
def test_arrays_rows_and_data_say_the_same(name):
    result = fd.ensemble(scene(CASES[name]), 20)
    groups = len(result.mean)
    for array in (result.mean, result.mean_change, result.mean_change_error, result.mean_square,
                  result.std, result.std_error, result.tensile):  # fmt: skip
        assert array.shape == (groups,)
    assert result.mean_square == pytest.approx(result.std**2 + result.mean_change**2, rel=1e-9)
    data = json.loads(json.dumps(result.data()))
    rows = rows_of(result.arrays)
    assert result.rows == len(rows) == len(data["results"][result.quantity])
    for row, printed in zip(rows, data["results"][result.quantity], strict=True):
        assert list(row) == list(printed)
        for key, value in row.items():
            if not isinstance(value, float):
                assert printed[key] == value
            elif math.isnan(value):
                assert printed[key] == ""
            elif key.endswith("_error"):  # three digits
                assert float(printed[key]) == pytest.approx(value, rel=0.006)
            else:
                # theory is printed with twelve digits, what is measured to beyond its error
                of = {"mean": "mean_change", "std_over_mean": "std"}.get(key, key)
                error = row.get(f"{of}_error", 0.0)
                error = 0.0 if math.isnan(error) else error
                error /= row["mean"] if key == "std_over_mean" else 1
                allowed = error / 20 + abs(value) * (1e-11 if key == "first_order_std" else 0)
                assert float(printed[key]) == value or abs(float(printed[key]) - value) <= allowed
    assert 2 <= len(repr(result).splitlines()) <= 6
    assert result._repr_html_().count("<tr>") == 1 + min(len(rows), 20)
    assert result._repr_latex_().count(" & ") == (len(rows[0]) - 1) * (1 + min(len(rows), 20))


def test_layers_of_both_branches():
    ensemble = fd.ensemble(scene(PROFILE), 150)
    assert ensemble.mean - ensemble.mean_change == pytest.approx(0.7559289460184544)
    assert ensemble.solved == 150
    assert ensemble.variance == pytest.approx(ensemble.std**2)
    assert ensemble.z is not None
    assert ensemble.z.tolist() == [0, 0, 0.25, 0.25, 0.5, 0.5, 0.75, 0.75]
    assert f"known to {100 * ensemble.half_width:.2g} % (95 %, simultaneous)" in repr(ensemble)


@pytest.mark.parametrize(("kind", "angle"), [("surface", 25), ("bulk", 25), ("surface", 0)])
def test_a_load_at_an_angle_has_its_own_theory_for_either_branch(kind, angle):
    load = {"kind": kind, "angle_deg": angle}
    ensemble = fd.ensemble(scene({**PROFILE, "load": load}), 400)
    assert ensemble.first_order_std is not None
    assert (ensemble.std_over_mean is None) == bool(angle)
    ratio = ensemble.std / ensemble.first_order_std
    error = ensemble.std_error / ensemble.std
    assert (abs(ratio - 1) < 5 * error).all()
    plus = ensemble.index["branch"] == "+"
    # the theory of the other branch is refuted everywhere
    other = ensemble.std[plus] / ensemble.first_order_std[~plus]
    assert (abs(other - 1) > 5 * error[plus]).all() == bool(angle)


@pytest.mark.parametrize("reach", [-1, 0, math.nan])
def test_a_reach_that_is_not_positive_is_refused(reach):
    with pytest.raises(ArgumentError, match=r"reach = .*must be greater than 0"):
        fd.ensemble(scene(CASES["histogram of all"]), 9, reach=reach)


def test_memory_bounds_the_workers(monkeypatch):
    monkeypatch.setattr(module, "memory_limit", lambda: 10**8)
    with pytest.raises(ArgumentError, match="workers = 2: the free memory is enough for 1"):
        fd.ensemble(scene(PROFILE), 9, workers=2)
    assert fd.ensemble(scene(PROFILE), 9, workers=None).realisations == 9


@pytest.mark.parametrize("magnitude", ["=1e-298", "=1e200"])
def test_squares_beyond_floats_are_refused_and_not_zero(magnitude):
    sections = basic(4, 6, quantity="profile")
    sections["packing"]["allow_images"] = True
    sections["disorder"]["relative_std"] = "=1e-2"
    usual = fd.ensemble(scene(sections), 32)
    sections["load"] = {"kind": "surface", "magnitude": magnitude}
    ensemble = fd.ensemble(scene(sections), 32)
    for squares in ("mean_square", "variance"):
        with pytest.raises(fd.ForceDiffusionError, match="choose another unit"):
            getattr(ensemble, squares)
    assert ensemble.std / float(magnitude[1:]) == pytest.approx(usual.std, rel=1e-14)
    str(ensemble)
