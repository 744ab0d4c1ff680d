"""P(f) against the Gaussian: is a contact force normal, with the mean and the width of theory?

One contact is taken from each realisation, so that samples are independent; the packings are exact.
The null hypothesis is fully specified, with no parameter fitted: mean ⟨f⟩ = f_load/2n_y, and the
exact finite-M σ_f (Eq. 13). To first order f is a weighted sum of independent radii: it becomes
Gaussian as M grows, and isn't at M = 2 with two-point radii.
"""

from typing import Any

import numpy as np
from matplotlib.axes import Axes

from ..arithmetic.systems import Array
from ..mechanics.sweep import Solved
from ..quantities.base import ContactQuantity
from ..theory.expected import stds_by_layer
from .packings import Made, Options, gathered, planned, table
from .style import PAGE, panels, points

CASES = (("uniform", 32), ("two-point", 2))
SIMULATED_TESTS = 999
LEAST_P = 1 / (SIMULATED_TESTS + 1)
LEVEL = 0.01


def in_words(p: float) -> str:
    """Give a p-value, none below what simulated tests can tell."""
    return f"p ≤ {LEAST_P:g}" if p <= LEAST_P else f"p = {p:.2g}"


def p_values(deviates: Array, seed: int) -> tuple[float, float]:
    """Test against N(0, 1), nothing fitted: Kolmogorov–Smirnov (exact), Anderson–Darling."""
    from scipy import stats

    anderson = stats.goodness_of_fit(
        stats.norm, deviates, known_params={"loc": 0, "scale": 1}, statistic="ad",
        n_mc_samples=SIMULATED_TESTS, rng=np.random.default_rng(seed),
    )  # fmt: skip
    return float(stats.kstest(deviates, "norm").pvalue), float(anderson.pvalue)


def simulated(o: Options, number: int) -> tuple[Array, dict[str, Any]]:
    """Draw f⁺ at the base from each realisation of a case, and test; cases share no radii.

    Gives (f − ⟨f⟩)/σ_f, shape (realisations,), and what the tests find.
    """
    (kind, M), medium = CASES[number], o.medium()
    plan = planned("contact", o, medium, height=M, width=None, kind=kind, at=(0, 0, "+"))
    quantity = plan.quantity
    assert isinstance(quantity, ContactQuantity)

    def each(answer: Solved, number: int) -> Array:
        F, g = quantity.changes(plan.problem, answer, number)
        return np.asarray(g[0, :, 0] / F[0, 0])

    changes = gathered(plan, o.notice, f"P(f), {kind} radii, M = {M}", each, number << 32)
    std = stds_by_layer("surface", M, float(medium.phi))[0] * medium.std
    smirnov, anderson = p_values(changes / std, o.seed)
    return changes / std, {
        "radii": kind,
        "height": M,
        "p_kolmogorov_smirnov": smirnov,
        "p_anderson_darling": anderson,
        "gaussian_rejected": min(smirnov, anderson) < LEVEL / 2,
    }


def figure(o: Options) -> Made:
    """P(f) of one contact at the base, for two laws of the radii and two heights."""
    medium, rows, samples, lines = o.medium(), [], [], []
    drawn, axes = panels("ab", PAGE, 2.6)
    for c, panel in enumerate(axes):
        deviates, tested = simulated(o, c)
        kind, M = CASES[c]
        smirnov = f"Kolmogorov–Smirnov {in_words(tested['p_kolmogorov_smirnov'])}"
        anderson = f"Anderson–Darling {in_words(tested['p_anderson_darling'])}"
        _draw(panel, deviates, c, f"{kind} radii, $M={M}$", f"{smirnov}\n{anderson}")
        rows += [(kind, M, k, value) for k, value in enumerate(deviates.tolist())]
        samples.append(tested)
        verdict = "the tests reject" if tested["gaussian_rejected"] else "no test rejects"
        lines.append(f"{kind} radii, M = {M}: {verdict} the Gaussian ({smirnov}, {anderson})")
    facts = {
        "spacing_over_r": float(medium.spacing),
        "relative_std": medium.std,
        "realisations": o.realisations,
        "level_of_both_tests_together": LEVEL,
        "samples": samples,
    }
    return Made(drawn, {"pf": table("radii height realisation deviate", rows)}, facts, lines)


def _draw(axes: Axes, deviates: Array, c: int, name: str, tests: str) -> None:
    edges, v = np.linspace(-4, 4, 41), np.linspace(-4, 4, 321)
    counts, _ = np.histogram(deviates, edges)
    some, unit = counts > 0, len(deviates) * (edges[1] - edges[0])
    middle = ((edges[1:] + edges[:-1]) / 2)[some]
    axes.plot(v, np.exp(-(v**2) / 2) / np.sqrt(2 * np.pi), "k", label="Gaussian")
    points(axes, middle, counts[some] / unit, c, name, np.sqrt(counts[some]) / unit)
    axes.set(xlim=(-4, 4), yscale="log", ylim=(8e-5, 1))
    axes.set(xlabel=r"$(f-\langle f\rangle)\,/\,\sigma_f$", ylabel=r"$\sigma_f\,P(f)$")
    axes.legend(loc="lower center", title=tests)  # below the curve
