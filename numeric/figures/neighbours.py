"""Figure B7: how the mean force of N neighbours fluctuates, for one branch and for beads.

Simulated are exact, nonlinear packings under a surface load; curves are Eqs. B7 and B8, exact to
first order, in the N that they are for, and what independent contacts would have.
"""

import numpy as np

from .. import closed_forms
from ..arithmetic.systems import Array
from ..lattice.branch import Branch
from ..mechanics.problem import Solved
from . import specification as spec
from .packings import PAPER, PAPER_STD, PHI, Options, band_of_roots, gathered, of_ensembles, planned

HEIGHT, LAYER = 32, 16
WINDOWS = (1, 2, 3, 5, 8, 14)


def contacts(count: int) -> float:
    """Variance of the mean of f⁺/⟨f⟩ over N neighbours in layer j (Eq. B7)."""
    form = closed_forms.contacts_mean_variance
    return float(form(HEIGHT, LAYER, count, float(PHI), PAPER_STD, 1.0))


def beads(count: int) -> float:
    """The same of the vertical force on a bead over its mean (Eq. B8)."""
    form = closed_forms.beads_mean_variance
    return float(form(HEIGHT, LAYER, count, float(PHI), PAPER_STD, 1.0))


def window_means(answer: Solved, number: int) -> tuple[Array]:
    """Mean squares of windows of contacts, then of beads; (number, 2 windows)."""
    forces, packing, upper = answer.forces, answer.packing, LAYER + 1
    assert forces is not None
    assert packing is not None
    relative, vertical = [], []
    for branch in Branch:
        change, ordered = forces.change[branch][upper], forces.ordered[branch][upper]
        a, b = (part[upper] for part in zip(*packing.dn[branch], strict=True))
        relative.append((change / ordered).reshape(number, -1))
        push = (ordered + change) * PAPER.n_y * (1 + a + b) - ordered * PAPER.n_y
        vertical.append(push.reshape(number, -1))
    # contacts are named by their upper bead: bead q of an even layer has f⁺ at q, f⁻ at q − 1
    bead = vertical[0] + np.roll(vertical[1], 1, axis=1)
    each = [
        np.asarray(sum(np.roll(values, -q, axis=1) for q in range(count)) / count) ** 2
        for values in (relative[0], bead)
        for count in WINDOWS
    ]
    return (np.stack([square.mean(axis=1) for square in each], axis=1),)


def simulated(o: Options) -> spec.Comparison:
    """Average neighbours of one layer in windows at every place; σ of contacts, then of beads."""
    ensemble = planned("profile", height=HEIGHT, seed=o.seed, realisations=o.realisations)
    (square,) = gathered(ensemble, o.notice, "figure B7", window_means)
    exact = [form(N) for form in (contacts, beads) for N in WINDOWS]
    what = f"M = {HEIGHT}, j = {LAYER}: Eqs. B7 and B8"
    return spec.Comparison(what, band_of_roots(square, o.seed), np.sqrt(exact))


def figure(o: Options) -> spec.Figure:
    """σ of the mean over N, on logarithmic axes."""
    found, every, count = simulated(o), np.array(WINDOWS), len(WINDOWS)
    halves = slice(0, count), slice(count, None)
    names = ("contacts of one branch", "beads, vertical force")
    panel = spec.Panel(
        [
            *(
                (
                    spec.Line(every, found.theory[halves[b]], b, name=name),
                    found.points(every, b, rows=halves[b]),
                )
                for b, name in enumerate(names)
            ),
            spec.Line(
                every, found.band.value[0] / np.sqrt(every), dashes=":",
                name="independent contacts",
            ),
        ],
        spec.Axis("number of neighbours $N$", log=True, ticks=(1, 2, 5, 10)),
        spec.Axis(r"$\sigma$ of the mean over $N$, relative", log=True),
        legend="lower left",
    )  # fmt: skip
    windows = [(of, N) for of in ("contacts", "beads") for N in WINDOWS]
    columns = found.columns("sigma_")
    exact = {"sigma_exact_first_order": found.theory}
    return spec.Figure(
        spec.Picture([panel], 2.6),
        tables={"figureB7": spec.table("of N", windows) | columns | exact},
        facts=of_ensembles(o, PAPER_STD, height=HEIGHT, layer=LAYER) | found.fact(),
        comparisons=[found],
    )
