"""Figure B7: how the mean force of N neighbours fluctuates, for one branch and for beads.

Simulated are exact, nonlinear packings under a surface load; curves are Eqs. B7 and B8, exact to
first order, in the N that they are for, what independent contacts would have, and what falls as
1/N.
"""

from functools import partial

import numpy as np

from ..arithmetic.systems import Array
from ..mechanics.problem import Route
from ..mechanics.sweep import Solved
from ..planning.plan import Plan
from . import packings
from .packings import PAPER, PAPER_STD, Comparison, Made, Options
from .style import COLUMN, GREY, label_logarithmic, panels, points

HEIGHT, LAYER = 32, 16
WINDOWS = (1, 2, 3, 5, 8, 14)
NAMES = ("contacts of one branch", "beads, vertical force")


def window_means(ensemble: Plan, answer: Solved, number: int) -> Array:
    """Mean squares of windows of contacts, then of beads; (number, 2 windows)."""
    upper = LAYER + 1
    linear = ensemble.problem.route == Route.FIRST_ORDER
    relative, vertical = [], []
    for a in range(2):
        change, ordered = answer.change(a, upper), answer.ordered(a, upper)
        tilt = answer.dn(a, upper).sum(axis=0)
        relative.append(change / ordered)
        force = ordered if linear else ordered + change
        vertical.append((change + force * tilt) * PAPER.n_y)
    # contacts are named by their upper bead: bead q of an even layer has f⁺ at q, f⁻ at q − 1
    bead = vertical[0] + np.roll(vertical[1], 1, axis=1)
    each = [
        np.asarray(sum(np.roll(values, -q, axis=1) for q in range(count)) / count) ** 2
        for values in (relative[0], bead)
        for count in WINDOWS
    ]
    return np.stack([square.mean(axis=1) for square in each], axis=1)


def simulated(o: Options) -> Comparison:
    """Average neighbours of one layer in windows at every place; σ of contacts, then of beads."""
    ensemble = packings.planned("profile", o, height=HEIGHT)
    square, each = (
        packings.gathered(plan, o.notice, "figure B7", partial(window_means, plan))
        for plan in (ensemble, packings.unit_changes(ensemble))
    )
    what, exact = f"M = {HEIGHT}, j = {LAYER}: Eqs. B7 and B8", np.sqrt(each.sum(axis=0))
    return Comparison(what, packings.band_of_roots(square, o.seed), PAPER_STD * exact)


def figure(o: Options) -> Made:
    """σ of the mean over N, on logarithmic axes."""
    comparison, every, count = simulated(o), np.array(WINDOWS), len(WINDOWS)
    drawn, (axes,) = panels("a", COLUMN, 2.6)
    for b, name in enumerate(NAMES):
        own = slice(b * count, (b + 1) * count)
        axes.plot(every, comparison.theory[own], color=f"C{b}", label=name)
        points(axes, every, comparison.band.value[own], b, error=comparison.bars[:, own])
    single = comparison.theory[0]
    axes.plot(every, single / np.sqrt(every), ":", color=GREY, label="independent contacts")
    axes.plot(every[2:], 0.7 * single / every[2:], "--", color=GREY, lw=0.7, label=r"$\propto 1/N$")
    axes.set(xscale="log", yscale="log", xlabel="number of neighbours $N$")
    axes.set_ylabel(r"$\sigma$ of the mean over $N$, relative")
    label_logarithmic(axes.xaxis)
    label_logarithmic(axes.yaxis)
    axes.legend(loc="lower left")
    rows = packings.table("of N", [(of, N) for of in ("contacts", "beads") for N in WINDOWS])
    return packings.compared(
        drawn, "figureB7", o, [comparison], rows, height=HEIGHT, layer=LAYER, relative_std=PAPER_STD
    )
