"""What a reader of a figure sees: labels, letters, names in their places."""

import numpy as np
import pytest

pytest.importorskip("matplotlib")
from force_diffusion.numeric.figures import mean_forces, neighbours, notation, style
from force_diffusion.numeric.figures.packings import Made, Options
from matplotlib.axes import Axes

FEW = Options(realisations=16)


def laid_out(made: Made) -> list[Axes]:
    made.figure.draw_without_rendering()
    return list(made.figure.axes)


def labels(axes: Axes, axis: str) -> list[str]:
    """The labels of the ticks that lie within the axis."""
    part = getattr(axes, f"{axis}axis")
    low, high = getattr(axes, f"get_{axis}lim")()
    ticks = [*part.get_major_ticks(), *part.get_minor_ticks()]
    words = [tick.label1.get_text() for tick in ticks if low <= tick.get_loc() <= high]
    return [word for word in words if word]


def test_figure_b7_has_labels_on_both_axes() -> None:
    (axes,) = laid_out(neighbours.figure(FEW))
    assert labels(axes, "x") == ["1", "2", "5", "10"]
    assert len(labels(axes, "y")) >= 3


def test_panels_are_lettered_where_there_are_several() -> None:
    both = laid_out(mean_forces.figure(FEW))
    assert [axes.get_title(loc="left") for axes in both] == ["(a)", "(b)"]
    (alone,) = laid_out(neighbours.figure(FEW))
    assert not alone.get_title(loc="left")


def test_names_of_figure_1_lie_within_their_beads() -> None:
    with style.house_style():
        (axes,) = laid_out(notation.figure(Options()))
    shown = {text.get_text(): text for text in axes.texts}
    for site, words in notation.NAMED.items():
        box = shown[words].get_window_extent().transformed(axes.transData.inverted())
        corners = [(x, y) for x in (box.x0, box.x1) for y in (box.y0, box.y1)]
        away = np.linalg.norm(np.array(corners) - notation.at(*site), axis=1)
        assert away.max() < 1, words
