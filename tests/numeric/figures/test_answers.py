"""Figures of one answer: what is drawn are the numbers of its table."""

from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from force_diffusion.numeric import closed_forms

import force_diffusion as fd
from tests.numeric.scenes import listed_loads, question

pytest.importorskip("matplotlib")
from force_diffusion.numeric.figures import beads as looks
from matplotlib.collections import LineCollection, PatchCollection
from matplotlib.colors import to_rgba
from matplotlib.container import ErrorbarContainer
from matplotlib.figure import Figure

M, W = 6, 14


def scene(quantity: str, std: float = 1e-4, width: int = W, **more: Any) -> fd.Scene:
    return question(quantity, M, width, std=std, seed=3, **more)


def lines(figure: Figure, panel: int = 0) -> tuple[LineCollection, LineCollection]:
    pressing, pulling = (c for c in figure.axes[panel].collections if isinstance(c, LineCollection))
    return pressing, pulling


def points(figure: Figure) -> list[tuple[np.ndarray[Any, Any], np.ndarray[Any, Any]]]:
    """Give x and y of each series with error bars."""
    series = []
    for container in figure.axes[0].containers:
        assert isinstance(container, ErrorbarContainer)
        data = container.lines[0].get_data()
        series.append((np.asarray(data[0]), np.asarray(data[1])))
    return series


def of_one_load(size: str, folder: Path) -> fd.Outcome:
    """An ordered packing, or to a tolerance: balls, which have no limits."""
    load = listed_loads(folder, [(i, M, 0, f"-{size}") for i in (0, 4)])
    return scene("contact_forces", std=0, load=load).run()


def test_forces_at_the_ends_of_the_range_are_drawn_and_none_beyond(tmp_path):
    usual, *others = (of_one_load(size, tmp_path).plot() for size in ("1", "1e-299", "1e279"))
    for other in others:
        assert lines(other)[0].get_linewidths() == pytest.approx(lines(usual)[0].get_linewidths())
    for size in ("1e308", "1e400", "1e-320"):
        with pytest.raises(fd.SceneError, match="choose another unit"):
            of_one_load(size, tmp_path).plot()


@pytest.mark.parametrize("power", [300, -400])
@pytest.mark.parametrize("quantity", ["contact_forces", "profile", "histogram", "positions"])
def test_no_unit_is_drawn_beyond_what_floats_hold(quantity, power):
    size = Fraction(10) ** power
    load = fd.SurfaceLoad(magnitude=size)
    with pytest.raises(fd.SceneError, match=r"(packing.radius|load.magnitude) = .*another unit"):
        scene(quantity, radius=size, spacing=3 * size, load=load).run("1e-20").plot()


def test_chains_are_as_thick_as_forces_and_tension_has_its_colour():
    outcome = scene("contact_forces", std=0.04).run()
    forces = outcome.arrays["force"]
    assert (forces < 0).any()
    pressing, pulling = lines(outcome.plot())
    assert len(pulling.get_segments()) == (forces < 0).sum()
    assert to_rgba(looks.PULLING) in map(tuple, pulling.get_colors())
    widths = np.array(pressing.get_linewidths()) / looks.WIDEST
    expected = forces[forces >= 0] / abs(forces).max()
    assert widths == pytest.approx(np.maximum(expected, 0.05 / looks.WIDEST))
    # each line is a contact of the ordered lattice, of length 2 r, also at the edges of the strip
    ends = np.array([*pressing.get_segments(), *pulling.get_segments()])
    assert np.hypot(*(ends[:, 1] - ends[:, 0]).T) == pytest.approx(2.0)


def test_a_point_load_near_the_edge_has_one_cone():
    size = Fraction(3, 10)
    load = fd.PointLoad(at=(0, M), magnitude=size)
    outcome = scene("response", load=load, width=2 * M).run()
    figure = outcome.plot()
    beads, _ = (c for c in figure.axes[0].collections if isinstance(c, PatchCollection))
    centres = np.array([path.get_extents().get_points().mean(axis=0) for path in beads.get_paths()])
    shades = np.asarray(beads.get_array())
    figure.draw_without_rendering()
    greys = np.asarray(beads.get_facecolor())[:, 0]
    assert greys[np.argmax(shades)] < 0.5 < greys[np.argmin(np.abs(shades))]  # white is nothing
    assert len(shades) == M * (M + 3) // 2  # l − j + 1 beads on layer j
    assert sum(centres[:, 0]) == pytest.approx(0)
    vertical = outcome.arrays["vertical"]
    for height in np.unique(centres[:, 1].round(6)):  # each layer bears the whole load
        assert shades[centres[:, 1].round(6) == height].sum() == pytest.approx(1, abs=1e-3)
    assert vertical.sum() == pytest.approx(float(size) * M, abs=1e-3 * M)


def test_a_profile_stands_beside_theory():
    for load, number in ((fd.SurfaceLoad(), 13), (fd.BulkLoad(), 14)):
        outcome = scene("profile", realisations=20, load=load).run()
        figure = outcome.plot()
        for branch, (z, std) in zip("+-", points(figure), strict=True):
            own = outcome.arrays["branch"] == branch
            assert z == pytest.approx(np.arange(M) / M)
            assert std == pytest.approx(outcome.arrays["std"][own])
        exact, printed = figure.axes[0].get_lines()[:2]
        theory = [float(v) for v in outcome.arrays["first_order_std"][::2]]
        assert np.asarray(exact.get_ydata()) == pytest.approx(theory)
        assert printed.get_label() == f"Eq. ({number}), printed"
    # of the surface load the ordered force is 1/2n_y everywhere
    phi, F = 1 - 2 * 0.75**2, 0.5 / np.sqrt(1 - 0.75**2)
    figure = scene("profile").run().plot()
    own = [closed_forms.surface_diffusion(M, j / M, phi) * 1e-8 for j in range(M)]
    drawn = np.asarray(figure.axes[0].get_lines()[1].get_ydata())
    assert drawn == pytest.approx(F * np.sqrt(own))


def test_of_many_layers_some_are_marked_so_that_theory_is_seen():
    outcome = question("profile", 40, 82, std=1e-4, seed=3, realisations=2).run()
    plus, minus = ((40 * z).round().astype(int) for z, _ in points(outcome.plot()))
    assert plus.tolist() == list(range(0, 40, 3))
    assert minus.tolist() == list(range(1, 40, 3))


def test_theory_of_a_load_at_an_angle_is_drawn_for_either_branch():
    outcome = scene("profile", load=fd.BulkLoad(angle_deg=15)).run()
    figure = outcome.plot()
    for exact, branch in zip(figure.axes[0].get_lines()[:2], "+-", strict=True):
        own = outcome.arrays["branch"] == branch
        theory = [float(v) for v in outcome.arrays["first_order_std"][own]]
        assert np.asarray(exact.get_ydata()) == pytest.approx(theory)
        assert exact.get_label() == f"exact at finite $M$, $f^{branch}$"


@pytest.mark.parametrize("at", [None, (0, 0, "+")])
def test_densities_are_those_of_all_changes(at):
    outcome = scene("histogram", at=at, realisations=300).run()
    count = outcome.arrays["count"]
    figure = outcome.plot()
    ((v, density),) = points(figure)
    assert len(v) == (count > 0).sum()
    assert density.sum() * np.diff(v).min() == pytest.approx(1, rel=1e-9)
    gauss = figure.axes[0].get_lines()[-1]
    x, y = (np.asarray(side) for side in gauss.get_data())
    assert np.trapezoid(y, x) == pytest.approx(1, abs=0.01)
    # the unit is σ_f of theory: both have a variance of one, up to sampling (√(2/300) for one)
    assert (density * v**2).sum() * np.diff(v).min() == pytest.approx(1, abs=0.3)


def test_beads_have_their_radii():
    unit = Fraction(5, 2)
    outcome = scene("positions", std=0.02, radius=unit, spacing=3 * unit).run()
    (beads,) = (c for c in outcome.plot().axes[0].collections if isinstance(c, PatchCollection))
    boxes = np.array([path.get_extents().get_points() for path in beads.get_paths()])
    x, y = outcome.arrays["x"] / float(unit), outcome.arrays["y"] / float(unit)
    assert boxes.mean(axis=1)[:, 0] == pytest.approx(x, abs=1e-6)
    radii = np.ptp(boxes, axis=1)[:, 0] / 2
    assert radii.std() == pytest.approx(0.02, rel=0.3)
    apart = np.hypot(x[:, None] - x, y[:, None] - y)
    touching = np.abs(apart - (radii[:, None] + radii)) < 1e-5
    assert touching.sum() // 2 >= 2 * M * (W - 1)  # but for those across the edge


@pytest.mark.parametrize("quantity", ["profile", "histogram", "contact_forces", "response"])
def test_an_ensemble_is_drawn_too(quantity):
    load = fd.PointLoad(at=(0, M)) if quantity == "response" else fd.SurfaceLoad()
    ensemble = fd.ensemble(scene(quantity, load=load), 20)
    figure = ensemble.plot()
    if quantity == "profile":
        assert points(figure)[0][1] == pytest.approx(ensemble.std[::2])
        bars = figure.axes[0].containers[0].lines[2][0].get_segments()
        half = np.array([(bar[1, 1] - bar[0, 1]) / 2 for bar in bars])
        assert half == pytest.approx(ensemble.std_error[::2])
    if quantity == "contact_forces":
        widths = np.array(lines(figure)[0].get_linewidths())
        assert widths == pytest.approx(np.maximum(3 * ensemble.std / ensemble.std.max(), 0.05))
    assert figure._repr_png_()[1:4] == b"PNG"  # type: ignore[attr-defined]


def test_a_figure_ignores_the_user_s_matplotlib_settings():
    import matplotlib as mpl

    figure = scene("profile").run().plot()
    usual = figure._repr_png_()  # type: ignore[attr-defined]
    with mpl.rc_context({"font.family": "monospace", "xtick.direction": "out", "font.size": 20}):
        assert figure._repr_png_() == usual  # type: ignore[attr-defined]


def legend(figure: Figure) -> list[str]:
    return [text.get_text() for text in figure.legends[0].get_texts()]


def test_chains_that_differ_little_are_as_thick_as_they_exceed_the_smallest():
    outcome = scene("contact_forces", std=1e-5).run()
    forces = outcome.arrays["force"]
    assert 0.99 * forces.max() < forces.min()
    figure = outcome.plot()
    widths = np.array(lines(figure)[0].get_linewidths())
    assert widths.max() / widths.min() == pytest.approx(10)
    assert np.diff(widths[np.argsort(forces)]).min() >= 0  # in the order of the forces
    # linear: the mean force has the mean width
    middle = np.interp(forces.mean(), (forces.min(), forces.max()), (widths.min(), widths.max()))
    assert widths.mean() == pytest.approx(middle)
    off = [100 * (edge / forces.mean() - 1) for edge in (forces.min(), forces.max())]
    for name, value, says in zip(("smallest", "largest"), off, legend(figure)[1:], strict=True):
        assert says == rf"{name}, ${value:+.2g}\%$"


def arrows(figure: Figure) -> np.ndarray[Any, Any]:
    """Tips of all arrows, (arrows, 2)."""
    return np.array([text.xy for text in figure.axes[0].texts if text.arrow_patch is not None])  # type: ignore[attr-defined]


@pytest.mark.parametrize("angle", [0, 20])
def test_an_arrow_stands_on_each_bead_of_the_surface(angle):
    figure = scene("contact_forces", load=fd.SurfaceLoad(angle_deg=angle)).run().plot()
    nx, ny = 0.75, np.sqrt(1 - 0.75**2)
    tips = arrows(figure)
    assert len(tips) == W + 1  # the last one is the first one again, a period away
    tilt = np.radians(angle)
    beads = tips + 1.1 * np.array([np.sin(tilt), -np.cos(tilt)])
    assert beads[:, 1] == pytest.approx(np.full(W + 1, 2 * ny * M))
    assert beads[:, 0] / (2 * nx) == pytest.approx(np.arange(M % 2, 2 * W + 1, 2))


@pytest.mark.parametrize("quantity", ["response", "contact_forces"])
def test_the_arrow_of_a_point_load_leans_with_it(quantity):
    load = fd.PointLoad(at=(M % 2, M), angle_deg=30)
    panels = scene(quantity, load=load).run().plot().axes
    texts: list[Any] = [text for axes in panels for text in axes.texts]
    across, up = np.array([np.subtract(text.xy, text.xyann) for text in texts]).T
    assert up.max() < 0
    assert across / -up == pytest.approx(np.tan(np.radians(30)))


def test_arrows_stand_on_the_beads_of_a_packing_at_rest():
    free = scene("contact_forces", std=0.03, effects={"contacts": "unilateral"}).run()
    assert free.answer.network is not None
    top = free.answer.network.x[-W:]
    beads = np.array([[float(v) for v in centre] for centre in top])
    assert arrows(free.plot()) - beads == pytest.approx(np.tile((0, 1.1), (W, 1)))


def test_no_theory_is_drawn_where_none_applies():
    outcome = scene("profile", load=fd.PointLoad(at=(0, M))).run()
    assert "first_order_std" not in outcome.arrays
    labels = [text.get_text() for text in outcome.plot().axes[0].get_legend().get_texts()]
    assert labels == ["simulated, $f^+$", "simulated, $f^-$"]


def test_of_equal_forces_none_is_thicker():
    figure = scene("contact_forces", std=0).run().plot()
    assert len(set(lines(figure)[0].get_linewidths())) == 1
    assert legend(figure) == ["all, $f=0.756$"]
