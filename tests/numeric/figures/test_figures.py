"""What the figures show, against what is known in other ways."""

import csv
import json
import math
from collections.abc import Callable
from fractions import Fraction
from functools import cache
from typing import Any

import numpy as np
import pytest

pytest.importorskip("matplotlib")
from force_diffusion.numeric import closed_forms
from force_diffusion.numeric.figures import (
    chains, comparison, diffusion, directions, distribution, mean_forces, mean_response,
    neighbours, notation, point_load, spheres, style,
)  # fmt: skip
from force_diffusion.numeric.figures.catalogue import csv_file
from force_diffusion.numeric.figures.packings import (
    N_X, PAPER_STD, PHI, Comparison, Made, Medium, Options,
)  # fmt: skip
from matplotlib.axes import Axes

import force_diffusion as fd

NY = math.sqrt(1 - N_X**2)


@cache
def few(module: Any) -> Made:
    """A figure of few packings."""
    made: Made = module.figure(Options(realisations=16))
    return made


def test_figure_1_shows_beads_that_touch():
    table = notation.figure(Options(seed=4)).tables["figure1"]
    i, j, radius = (np.array(table[name]) for name in ("i", "j", "radius"))
    touching = (np.abs(i[:, None] - i) == 1) & (j[:, None] - j == 1)
    assert touching.sum() == 24
    both = (radius[:, None] + radius)[touching]
    for end, distance in (("", both), ("_ordered", np.full(24, 2.0))):
        x, y = (np.array(table[f"{axis}{end}"]) for axis in "xy")
        apart = np.hypot(x[:, None] - x, y[:, None] - y)[touching]
        assert apart == pytest.approx(distance, rel=1e-14)


def test_widths_of_figure_2_are_those_of_line_sums():
    """Weights of a line's radii are 1 at its ends, and 2 between; the own bead is in both lines."""
    M = 6
    x, y = diffusion.displacement_std(M)
    for j in range(1, M + 1):
        line = 1 + 4 * (j - 1)  # squares, but for that of the own bead
        assert (x[j], y[j]) == pytest.approx(
            (math.sqrt(2 * line) / (2 * float(N_X)), math.sqrt(2 * line + 2**2) / (2 * NY))
        )


def drawn(axes: Axes, label: str) -> tuple[Any, Any]:
    """Give x and y of the markers with this name."""
    (markers,) = (bars.lines[0] for bars in axes.containers if bars.get_label() == label)
    return markers.get_data()


def test_what_figure_3_says_draws_and_writes_is_the_same():
    made = comparison.figure(Options((2, 3), 16, models=frozenset({"q-model"})))
    assert json.loads(json.dumps(made.facts)) == made.facts
    inside = [row["inside"] for row in made.facts["comparisons"]]
    assert inside == ["inside" in line for line in made.lines]
    assert set(made.tables) == {"figure3", "figure3_q_model"}
    table = {key: list(column) for key, column in made.tables["figure3"].items()}
    lines = csv_file(made.tables["figure3"], "a title", "a command").splitlines()
    assert lines[:2] == ["# a title", "# a command"]
    for name, column in table.items():
        assert [float(row[name]) for row in csv.DictReader(lines[2:])] == column
    assert table["z"][2:] == [0, 1 / 3, 2 / 3]
    low, simulated, high = (np.array(table[n]) for n in ("band_low", "simulated", "band_high"))
    assert ((low < simulated) & (simulated < high)).all()
    panels = {axes.get_title(loc="left"): axes for axes in made.figure.axes}
    z, y = drawn(panels["(a)"], "simulated, $M=3$")
    assert z == pytest.approx(table["z"][2:])
    assert y == pytest.approx(1e4 * simulated[2:] / 3**1.5)
    ratio = panels["(b)"].containers[1].lines[0].get_ydata()
    assert ratio == pytest.approx(100 * (simulated[2:] / table["exact"][2:] - 1))


@pytest.mark.parametrize("heights", [[], 5, "8", iter(()), [8, 8]])
def test_figure_3_needs_heights(heights):
    with pytest.raises(fd.SceneError, match=r"heights = .*must be a list of different"):
        fd.figure(3, heights=heights)


def on_layer(values: Any, j: int) -> Any:
    """The beads of a layer, from the left leg of the cone to the right one."""
    return values[j == point_load.LAYER]


def test_figure_4_does_not_depend_on_the_horizontal_position():
    table, cuts = point_load.simulated(Options(realisations=400))
    for j in range(1, point_load.APEX - 1):
        inside = on_layer(table["variance_exact"], j)[1:-1]
        assert inside == pytest.approx(np.full(inside.shape, inside[0]), rel=1e-12)
        # Eq. 16 is the leading order in l + j: here it is off by no more than 2/(l + j)
        printed = on_layer(table["variance_printed"], j)[1]
        assert inside[0] == pytest.approx(printed, rel=2 / (point_load.APEX + j))
        if len(inside) > 1:
            single = on_layer(table["variance_upper_plus_contact"], j)[1:-1]
            assert (np.diff(single) < -0.5).all()
    for j in range(point_load.APEX):  # each layer bears the whole load in every packing
        assert on_layer(table["mean_simulated"], j).sum() == pytest.approx(1, rel=1e-13)
    assert cuts.deviation <= 1
    off = np.abs(table["mean_simulated"] - 0.5)[point_load.LEG]
    assert (off < 5 * table["mean_standard_error"][point_load.LEG]).all()


@pytest.mark.long
def test_theory_of_figure_4_is_eq_16():
    table, _ = point_load.simulated(Options(realisations=16))
    at = {"k": 0, "l": point_load.APEX, "phi": PHI, "sigma": 1, "r": 1}
    for name, of in (("variance_exact", "bead"), ("variance_upper_plus_contact", "contact")):
        form = fd.equation(16).exact(of)
        exact = [float(form.at(i=i, j=j, **at)) for i, j in point_load.SITES]
        assert table[name] == pytest.approx(exact, rel=1e-12, abs=1e-28)


@pytest.mark.long
def test_theory_of_figure_b7_is_eqs_b7_and_b8():
    forms = [fd.equation(number).exact("mean") for number in ("B7", "B8")]
    at = {"M": neighbours.HEIGHT, "j": neighbours.LAYER, "phi": PHI, "sigma": 1, "r": 1}
    exact = [float(form.at(N=N, **at)) for form in forms for N in neighbours.WINDOWS]
    theory = pytest.approx(PAPER_STD * np.sqrt(exact), rel=1e-12)
    assert neighbours.simulated(Options(realisations=16)).theory == theory


def test_chains_bear_the_load_of_all_beads_in_every_layer():
    made = chains.figure(Options(seed=2))
    table = {name: np.array(column) for name, column in made.tables["chains"].items()}
    along = np.stack([table[f"{axis}_high"] - table[f"{axis}_low"] for axis in "xy"])
    forces = table["force"] / (2 * NY) * along / np.hypot(*along)
    for j in range(chains.HEIGHT):
        layer = forces[:, table["j"] == j]
        assert layer.shape == (2, 2 * chains.WIDTH)
        # ends are rounded to 1e-12 r, and the largest force is below four times the load
        assert layer.sum(axis=1) == pytest.approx([0, chains.WIDTH], abs=1e-11 * chains.WIDTH)
    facts = made.facts
    assert 0 < facts["tensile"] < facts["contacts"] / 4
    assert chains.HEIGHT < facts["critical_height"] < 2 * chains.HEIGHT


def test_distributions():
    o = Options(realisations=200)
    for number, (kind, M) in enumerate(distribution.CASES):
        deviates, facts = distribution.simulated(o, number)
        assert (facts["radii"], facts["height"], len(deviates)) == (kind, M, 200)
        assert deviates.std() == pytest.approx(1, abs=5 / np.sqrt(2 * 200))


def test_goodness_of_fit_rejects_what_it_should():
    normal = np.random.default_rng(8).standard_normal(400)
    assert min(distribution.p_values(normal, 1)) > 0.01
    for wrong in (normal + 0.4, normal * 1.4):
        assert max(distribution.p_values(wrong, 1)) < 0.01


def test_figures_of_another_spacing_and_disorder_are_those_of_its_theory():
    s, usual = Fraction(12, 5), Fraction(3)
    other = comparison.simulated(6, Options(realisations=300, spacing=s, relative_std=1e-3))
    assert other.deviation <= 1
    assert other.band.deviation(comparison.curves(6)[0]) > 1
    assert other.band.deviation(comparison.curves(6, Medium(std=1e-3))[0]) > 1
    narrow, paper = (
        point_load.simulated(Options(realisations=300, spacing=spacing))[1]
        for spacing in (Fraction(21, 10), usual)
    )
    assert narrow.deviation <= 1
    assert narrow.band.deviation(paper.theory) > 1
    wide, reference = (diffusion.displacement_std(4, Medium(s)) for s in (Fraction(33, 10), usual))
    assert wide[0][-1] < reference[0][-1]
    assert wide[1][-1] > reference[1][-1]
    assert chains.figure(Options(relative_std=1e-4)).facts["tensile"] == 0


S = mean_forces.SPACINGS[0]


SIMULATED: dict[str, tuple[int, Callable[[Options], Comparison]]] = {
    "3": (300, lambda few: comparison.simulated(6, few)),
    "B2": (60, directions.simulated),
    "B5": (400, lambda few: mean_forces.simulated(few, "surface", S)),
    "B6": (400, lambda few: mean_forces.simulated(few, "bulk", S)),
    "B7": (200, neighbours.simulated),
    "B9": (6000, lambda few: mean_response.simulated(few, mean_response.SPACINGS[0])),
    "B13": (40, lambda few: spheres.simulated(few, 0)),
}
"""How many packings, and the simulation."""
WRONG: dict[str, Callable[[Any], Any]] = {
    "3": lambda _: comparison.curves(6)[1],  # as printed: at this height far off
    "B2": lambda theory: np.roll(theory, len(directions.ANGLES)),  # the branches exchanged
    "B5": lambda _: mean_forces.theory("bulk", mean_forces.HEIGHT, S),
    "B6": lambda theory: 1.2 * theory,
    "B7": lambda theory: 1.1 * theory,
    "B9": lambda theory: 0 * theory,
    "B13": lambda _: comparison.curves(8)[0],  # of discs
}


@pytest.mark.parametrize("name", SIMULATED)
def test_theory_is_within_the_band_and_a_wrong_one_outside(name):
    packings, simulated = SIMULATED[name]
    compared = simulated(Options(realisations=packings))
    wrong = WRONG[name](compared.theory)
    assert compared.deviation <= 1
    assert compared.band.deviation(wrong) > 1
    assert "outside" in compared._replace(theory=wrong).verdict()


@pytest.mark.parametrize(
    ("module", "name", "rows"),
    [
        (directions, "figureB2", 2 * len(directions.ANGLES)),
        (mean_forces, "figureB5", 4 * mean_forces.HEIGHT),
        (neighbours, "figureB7", 2 * len(neighbours.WINDOWS)),
        (mean_response, "figureB9", 2 * len(mean_response.OFFSETS)),
        (spheres, "figureB13", 8 + 16 + 16),
    ],
)
def test_points_with_bars_are_the_rows_of_the_table(module, name, rows):
    made = few(module)
    table = {key: np.array(column) for key, column in made.tables[name].items()}
    assert {len(column) for column in table.values()} == {rows}
    written = np.array([table[key] for key in ("band_low", "simulated", "band_high")])
    start = 0
    for series in (c for axes in made.figure.axes for c in axes.containers if c.has_yerr):
        y, bars = series.lines[0].get_ydata(), np.array(series.lines[2][0].get_segments())[:, :, 1]
        own = written[:, start : start + len(y)]
        # the units of the axes are not those of the table: the shape of each series is the same
        shape = np.array([bars[:, 0], y, bars[:, 1]]) / y.mean()
        assert shape == pytest.approx(own / own[1].mean(), rel=1e-9)
        start += len(y)
    assert start == rows


def test_figure_b13_has_the_leading_orders_of_the_exact_forms():
    z, M = np.array([0.25, 0.5]), 10**6
    for load, form in (
        ("surface", closed_forms.surface_variance_of_spheres),
        ("bulk", closed_forms.bulk_variance_of_spheres),
    ):
        layers = [int(at * M) for at in z]
        exact = np.array([form(M, j, M - j, float(spheres.PHI)) for j in layers]) / M**3
        assert spheres.leading(load, z) == pytest.approx(PAPER_STD * np.sqrt(exact), rel=1e-5)


def laid_out(made: Made) -> list[Axes]:
    made.figure.draw_without_rendering()
    return list(made.figure.axes)


def test_panels_are_lettered_where_there_are_several():
    both = laid_out(few(mean_forces))
    assert [axes.get_title(loc="left") for axes in both] == ["(a)", "(b)"]
    (alone,) = laid_out(few(neighbours))
    assert not alone.get_title(loc="left")


def test_names_of_figure_1_lie_within_their_beads():
    with style.house_style():
        (axes,) = laid_out(notation.figure(Options()))
    shown = {text.get_text(): text for text in axes.texts}
    for site, words in notation.NAMED.items():
        box = shown[words].get_window_extent().transformed(axes.transData.inverted())
        corners = [(x, y) for x in (box.x0, box.x1) for y in (box.y0, box.y1)]
        away = np.linalg.norm(np.array(corners) - notation.at(*site), axis=1)
        assert away.max() < 1, words
