"""What accuracy costs: what the rows say; nothing here depends on how long anything takes."""

import json
from fractions import Fraction
from typing import Any

import flint
import pytest
from force_diffusion.numeric.arithmetic.systems import midpoint
from force_diffusion.numeric.run import cost as module
from force_diffusion.numeric.run.cost import CostStudy, Way
from force_diffusion.numeric.scene.sections import SceneError

import force_diffusion as fd
from tests.numeric.scenes import basic, scene

EVERY = [("float64", 16), ("balls", 15), ("balls", 30), ("balls", 100), ("mpmath", 30)]


pytestmark = pytest.mark.usefixtures("timed_once")


def names(study: CostStudy) -> list[tuple[str, int]]:
    return [(way.way, way.digits) for way in study.ways]


SCENES: dict[str, dict[str, dict[str, Any]]] = {
    "profile": basic(5, 12, quantity="profile", realisations=8),
    "first order": basic(5, 12) | {"effects": {"geometry": "first-order"}},
    "slab": basic(5, 12, quantity="contact", at=[1, 1, "-"]) | {"packing": {"height": 6}},
    "spheres": basic(3, 5) | {"packing": {"height": 3, "width": 5, "dimension": 3}},
}


@pytest.mark.parametrize("name", SCENES)
def test_errors_are_those_of_the_digits(name):
    asked = scene(SCENES[name])
    study = fd.cost(asked)
    assert names(study) == EVERY
    assert not study.skipped
    for way in study.ways:
        assert 0 < way.error < 10.0 ** (2 - way.digits)
        assert way.error_is == ("certified" if way.way == "balls" else "measured")
        assert not way.extrapolated
        assert way.seconds > 0
        assert way.relative_cost == pytest.approx(way.seconds / study.ways[0].seconds)
        assert max(map(len, str(way).splitlines())) <= 80


def test_the_error_of_float64_is_that_of_its_numbers():
    """Beside 100 digits; balls of the row's reference are closer than its last digit."""
    asked = scene(basic(5, 12))
    true = asked.run(Fraction(1, 10**100), certified=True)
    near = asked.run()
    exact = [midpoint(ball) for ball in true.table.numbers["change"]]
    rounded = map(float, near.arrays["change"])
    off = max(abs(Fraction(a) - b) for a, b in zip(rounded, exact, strict=True))
    expected = float(off / max(map(abs, exact)))
    assert float(fd.cost(asked).ways[0].error) == pytest.approx(expected, rel=1e-3)


def test_what_takes_too_long_is_extrapolated_by_its_beads(monkeypatch):
    asked = scene(basic(40, 12) | {"packing": {"height": 40, "width": 12, "allow_images": True}})
    layers: list[int] = []

    def timed(planned: Any, name: str, digits: int) -> module._Timed:
        layers.append(planned.problem.height)
        numbers = module.np.array([flint.arb(1)])
        return module._Timed(1e-3 * planned.problem.region.beads, numbers, 0.0)

    monkeypatch.setattr(module, "_run", timed)
    study = fd.cost(asked, seconds=0.4)
    assert names(study) == EVERY
    for way in study.ways:
        assert (way.extrapolated, way.error_is) == (True, "estimated")
        assert way.error == float(f"1e-{way.digits}")
        assert "estimated" in str(way)
    assert [way.seconds for way in study.ways] == pytest.approx([0.001 * 12 * 41] * 5)
    assert set(layers) == {4, 8}  # 16 would take more than its share
    layers.clear()
    study = fd.cost(asked, seconds=3)
    assert not any(way.extrapolated for way in study.ways)
    assert set(layers) == {4, 40}


def test_where_balls_take_too_long_the_error_of_float64_is_stated(monkeypatch):
    taken = module._Study._timed

    def slow_balls(study: Any, name: str, digits: int, allowed: float) -> Any:
        return taken(study, name, digits, 100 if name == "float64" else 0)

    monkeypatch.setattr(module._Study, "_timed", slow_balls)
    asked = scene(basic())
    study = fd.cost(asked)
    assert [way.error_is for way in study.ways] == ["stated", *["estimated"] * 4]
    assert float(study.ways[0].error) == asked.run().accuracy.error_bound


def test_without_any_change_there_is_nothing_to_measure():
    beside = basic(quantity="contact", at=[21, 1, "+"]) | {"load": {"kind": "point", "at": [1, 3]}}
    for sections in (basic() | {"effects": {"geometry": "ordered"}}, beside):
        with pytest.raises(SceneError, match="exactly zero"):
            fd.cost(scene(sections))


def test_disorder_that_float64_can_not_hold():
    sections = basic(3, 8)
    sections["disorder"] |= {"relative_std": "=1e-400"}
    study = fd.cost(scene(sections))
    assert names(study) == EVERY[1:]
    assert study.ways[0].relative_cost == 1
    assert "can't hold" in study.skipped["float64, 16 digits"]
    assert "can't hold" in str(study)


@pytest.mark.parametrize("std", ["1e-200", "1e-5"])
def test_rows_and_tables_say_the_same(std):
    sections = basic(3, 8)
    sections["disorder"] |= {"relative_std": f"={std}"}
    seen: list[Way] = []
    study = fd.cost(scene(sections), progress=seen.append)
    assert tuple(seen) == study.ways
    assert json.loads(json.dumps(study.data()))["rows"] == study.rows()
    for way, row, line in zip(study.ways, study.rows(), str(study).splitlines()[1:], strict=True):
        assert row["error"] == way.error
        assert way.error <= float(line.split()[2]) <= 1.01 * way.error
    assert study._repr_html_().count("<tr>") == 1 + len(study.ways)


def test_the_plot_shows_every_way():
    pytest.importorskip("matplotlib")
    ways = (
        Way("float64", 16, 1e-16, "measured", 0.01, 1, False),
        Way("balls", 100, 1e-100, "estimated", 50, 5000, True),
    )
    figure = CostStudy("profile", ways, {}).plot("$name")
    (axes,) = figure.axes
    low, high = axes.get_ylim()
    assert low < 1e-100
    assert high > 1e-16
    assert [text.get_text() for text in axes.texts] == [" 16 digits", " 100 digits"]
    assert axes.get_title() == r"\$name"
    assert [key.get_marker() for key in axes.get_legend().get_lines()] == ["o", "s", "^"]
    figure.canvas.draw()
