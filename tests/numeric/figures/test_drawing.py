"""What a picture says is what is drawn."""

from typing import Any

import numpy as np
import pytest

pytest.importorskip("matplotlib")
from force_diffusion.numeric.figures import (
    drawing,
    mean_forces,
    neighbours,
    notation,
    style,
)
from force_diffusion.numeric.figures import specification as spec
from force_diffusion.numeric.figures.packings import Options
from matplotlib.axes import Axes
from matplotlib.figure import Figure

FEW = Options(realisations=16)


def drawn(picture: spec.Picture) -> Figure:
    with style.house_style():
        figure = drawing.draw(picture)
        figure.draw_without_rendering()
    return figure


def names(axes: Axes) -> list[str]:
    found = axes.get_legend()
    assert found is not None
    return [text.get_text() for text in found.get_texts()]


def labels(axes: Axes, axis: str) -> list[str]:
    """The labels of the ticks that lie within the axis."""
    part = getattr(axes, f"{axis}axis")
    low, high = getattr(axes, f"get_{axis}lim")()
    ticks = [*part.get_major_ticks(), *part.get_minor_ticks()]
    words = [tick.label1.get_text() for tick in ticks if low <= tick.get_loc() <= high]
    return [word for word in words if word]


@pytest.mark.parametrize("low", [1e-250, 4e-9, 4e-3, 7e5])
@pytest.mark.parametrize("times", [4, 11, 70, 700, 3e4])
def test_a_logarithmic_axis_has_labels_enough(low: float, times: float) -> None:
    line = spec.Line([1, 2, 3], [low, 2 * low, times * low])
    figure = drawn(spec.Picture([spec.Panel([line], y=spec.Axis(log=True))], 2.6))
    assert len(labels(figure.axes[0], "y")) >= 3


def test_figure_b7_has_labels_on_both_axes() -> None:
    (axes,) = drawn(neighbours.figure(FEW).picture).axes
    assert labels(axes, "x") == ["1", "2", "5", "10"]
    assert len(labels(axes, "y")) >= 3


def test_panels_are_lettered_where_there_are_several() -> None:
    figure = drawn(mean_forces.figure(FEW).picture)
    assert [axes.get_title(loc="left") for axes in figure.axes] == ["(a)", "(b)"]
    (alone,) = drawn(neighbours.figure(FEW).picture).axes
    assert not alone.get_title(loc="left")


def test_names_of_figure_1_lie_within_their_beads() -> None:
    figure = drawn(notation.figure(Options()).picture)
    (axes,) = figure.axes
    shown = {text.get_text(): text for text in axes.texts}
    for site, words in notation.NAMED.items():
        box = shown[words].get_window_extent().transformed(axes.transData.inverted())
        corners = [(x, y) for x in (box.x0, box.x1) for y in (box.y0, box.y1)]
        away = np.linalg.norm(np.array(corners) - notation.at(*site), axis=1)
        assert away.max() < 1, words


def test_keys_without_a_place_are_drawn_in_the_legend_alone() -> None:
    elements: list[Any] = [
        spec.Line([0, 1], [0, 1]), spec.Line(name="line"), spec.Points(name="points"),
        spec.Area(name="area"),
    ]  # fmt: skip
    (axes,) = drawn(spec.Picture([spec.Panel(elements)], 2.6)).axes
    assert names(axes) == ["line", "points", "area"]
    assert axes.dataLim.bounds == (0, 0, 1, 1)
