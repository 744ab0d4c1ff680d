"""Figure 4: the response to a vertical load on one bead, its mean (a) and its fluctuation (b).

p is the vertical force that a bead gets from *both* its upper contacts. To first order the two lie
on different diagonals, whose heights add up to l + j: their variances add up to Eq. 16, whatever
the horizontal position. One contact alone depends on the position. On a leg of the cone one
contact carries all of p, half of the load on average, and fluctuates less. The variances at finite
l are the closed forms, exact to first order; the simulation is exact and nonlinear.
"""

from functools import partial
from math import asin

import numpy as np
from matplotlib.axes import Axes

from ..arithmetic.systems import Array
from ..closed_forms import response
from ..lattice.branch import Branch
from ..mechanics.sweep import Solved
from ..planning.plan import Plan
from ..quantities import response as quantities
from ..scene.sections import PointLoad
from . import double_y, packings
from .beads import draw_cone
from .packings import LEVEL, Comparison, Made, Medium, Options, Table
from .style import GREY, PAGE, panels, points

APEX = 24  # the loaded bead is (0, APEX)
MEDIUM = Medium(std=1e-4)  # far below M*
CUTS = (18, 12, 6, 0)
ALONE = 6
"""The cut on which one contact is drawn, too."""
SITES = [(i, j) for j in range(APEX) for i in range(-(APEX - j), APEX - j + 1, 2)]
"""The beads of the cone, legs included, layer by layer from the base up."""
COLUMN, LAYER = np.array(SITES).T
LEG = np.abs(COLUMN) == APEX - LAYER
ON_CUTS = np.flatnonzero(np.isin(LAYER, CUTS))


def simulated(o: Options) -> tuple[Table, Comparison]:
    """Evaluate the closed forms, and simulate: a row a bead, in units of the load.

    Variances are in units of (σ/r)²; ``variance_upper_plus_contact`` is that of the bead's upper
    right contact alone. Compared is σ on the beads of ``ON_CUTS``.
    """
    medium = o.medium(MEDIUM)
    load = PointLoad(at=(0, APEX))
    ensemble = packings.planned("response", o, medium, height=APEX, width=None, load=load)
    change, each = (
        packings.gathered(plan, o.notice, "figure 4", partial(vertical, plan))
        for plan in (ensemble, packings.unit_changes(ensemble))
    )
    exact, single = (each.sum(axis=1) ** 2).sum(axis=0), (each[:, 0] ** 2).sum(axis=0)
    change = change.sum(axis=1)
    phi, square = medium.phi, change.var(axis=0) / medium.std**2
    off = (change - change.mean(axis=0))[:, ON_CUTS] / medium.std
    band = packings.band_of_roots(off**2, o.seed)
    low, high = (np.full(len(SITES), "", dtype=object) for _ in range(2))
    low[ON_CUTS], high[ON_CUTS] = (edge**2 for edge in band.limits)
    ordered = np.where(LEG, 0.5, 0.0)
    printed = np.array([float(response(j, APEX, phi)) for j in LAYER.tolist()], dtype=object)
    table = {
        "i": COLUMN,
        "j": LAYER,
        "on_cone": LEG.astype(int),
        "mean_ordered": ordered,
        "mean_simulated": ordered + change.mean(axis=0),
        "mean_standard_error": medium.std * np.sqrt(square / (o.realisations - 1)),
        "variance_exact": exact,
        "variance_printed": np.where(LEG, "", printed),
        "variance_simulated": square,
        "variance_upper_plus_contact": single,
        "band_low": low,
        "band_high": high,
    }
    what = f"apex l = {APEX}: exact first-order fluctuation"
    return table, Comparison(what, band, np.sqrt(exact[ON_CUTS]))


def vertical(ensemble: Plan, answer: Solved, number: int) -> Array:
    """Give the changes of p that beads of the cone get from f⁺ and f⁻, (number, 2, beads)."""
    quantity = ensemble.quantity
    assert isinstance(quantity, quantities.Response)
    _, changes = quantity.changes(ensemble.problem, answer, number)
    labels, change_of_p = quantity.labels(ensemble.problem), np.zeros((number, 2, len(SITES)))
    names = zip(*(labels[name] for name in ("i", "j", "branch", "component")), strict=True)
    for (i, j, branch, component), change in zip(names, changes[:, :, 0], strict=True):
        if component == "vertical":
            change_of_p[:, Branch(branch).number, SITES.index((i, j))] = change
    return change_of_p


def figure(o: Options) -> Made:
    """Maps of mean and fluctuation, line cuts, and the double Y where it is asked for."""
    (table, cuts), medium = simulated(o), o.medium(MEDIUM)
    models = double_y.profiles(asin(medium.n_x), o.seed) if "double-y" in o.models else {}
    if models:
        drawn, axes = panels("ab;cd", PAGE, 4.7, height_ratios=(1, 1.05))
    else:
        drawn, axes = panels("ac;bc", PAGE, 3.4, width_ratios=(0.85, 1.1))
    step = np.array([2 * float(medium.n_x), 2 * medium.n_y])
    variance = table["variance_exact"]
    highest = float(variance[APEX - 2 == LAYER][1])
    for panel, shades, most, label in (
        (axes[0], table["mean_simulated"], 0.5, r"$\langle p\rangle\,/\,f^{\rm load}$"),
        (axes[1], variance, highest, r"$\sigma^2(p)$, unit of (c)"),
    ):
        apex, location = np.array([0.0, APEX * step[1]]), "bottom" if models else "right"
        centres = np.array(SITES) * step
        draw_cone(panel, centres, shades, apex, most, location=location, label=label)
    _draw_cuts(axes[2], table)
    drawn.legend(*axes[2].get_legend_handles_labels(), loc="outside lower center", ncols=5)
    made = packings.compared(
        drawn, "figure4", o, [cuts], {}, apex=APEX, spacing_over_r=float(medium.spacing),
        relative_std=medium.std,
    )  # fmt: skip
    tables = {"figure4": table}
    if models:
        double_y.draw(axes[3], models, float(medium.n_x) / medium.n_y)
        tables["figure4_double_y"] = double_y.table(models)
    return Made(drawn, tables, made.facts, made.lines)


def _draw_cuts(axes: Axes, table: Table) -> None:
    """Draw variances over the horizontal position, layer by layer."""
    x, variance = COLUMN / APEX, table["variance_exact"]
    upper = table["variance_upper_plus_contact"]
    for c, j in enumerate(CUTS):
        here, colour = j == LAYER, f"C{c}"
        inside, legs = here & ~LEG, here & LEG
        low, high = (table[edge][here].astype(float) for edge in ("band_low", "band_high"))
        axes.fill_between(x[inside], low[1:-1], high[1:-1], color=colour, alpha=0.2, lw=0)
        axes.vlines(x[legs], low[[0, -1]], high[[0, -1]], color=colour, alpha=0.2, lw=3)
        axes.plot(x[inside], variance[inside], color=colour)
        axes.plot(x[legs], variance[legs], "_", color=colour, ms=7, mew=0.9)
        points(axes, x[here], table["variance_simulated"][here], c, ms=2.6)
        reach, printed = 1 - j / APEX, float(table["variance_printed"][inside][0])
        axes.plot([-reach, reach], [printed, printed], "k--", lw=0.8)
        axes.annotate(
            f"$j={j}$", (reach, printed), (3, -1), textcoords="offset points", color=colour,
            va="center", fontsize=7.5,
        )  # fmt: skip
    axes.text(0, 5, "legs of the cone", color="0.3", size=7.5, ha="center", va="center")
    axes.plot([], [], color=GREY, label="exact to first order")
    axes.plot([], [], "k--", label="Eq. (16), printed")
    points(axes, [], [], 0, "simulated", ms=2.6)
    axes.fill_between([], [], color=GREY, alpha=0.2, lw=0, label=f"{LEVEL:.0%} band of all")
    own, colour = (LAYER == ALONE) & ~LEG, f"C{CUTS.index(ALONE)}"
    axes.plot(x[own], upper[own], ":", color=colour, label=f"one contact, $j={ALONE}$")
    axes.set(xlabel="horizontal position $i/l$", xlim=(-1.08, 1.4))
    axes.set_ylabel(r"$\sigma^2_{\rm ensemble}(p)\,/\,(f^{\rm load}\sigma_{\delta r}/r)^2$")
    axes.set_ylim(bottom=0)
