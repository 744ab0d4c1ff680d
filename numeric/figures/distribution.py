"""P(f) against the Gaussian: is a contact force normal, with the mean and the width of theory?

One contact is taken from each realisation, so that samples are independent; the packings are exact.
The null hypothesis is fully specified, with no parameter fitted: mean ⟨f⟩ = f_load/2n_y, and the
exact finite-M σ_f (Eq. 13). Kolmogorov and Smirnov's test has an exact p-value; Anderson and
Darling's, which looks at the tails, is simulated. To first order f is a weighted sum of independent
radii, so that its excess kurtosis is that of the radii times Σw⁴/(Σw²)²: it vanishes as M grows,
and at M = 2 with two-point radii there is no Gaussian.
"""

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from .. import closed_forms
from ..arithmetic.systems import Array
from .packings import (
    PAPER,
    Medium,
    Notice,
    Row,
    changes,
    forces_of,
    impulses,
    planned,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

# Excess kurtosis of the radii.
KURTOSIS = {"uniform": -1.2, "normal": 0.0, "two-point": -2.0}
CASES = (("uniform", 32), ("two-point", 32), ("normal", 2), ("uniform", 2), ("two-point", 2))
DRAWN = (("uniform", 32), ("two-point", 2))
SIMULATED_TESTS = 999
LEVEL = 0.01


@dataclass(frozen=True)
class Sample:
    """Forces f⁺ at the base as (f − ⟨f⟩)/σ_f, shape (realisations,), and what the tests say."""

    kind: str
    height: int
    deviates: Array
    smirnov: float
    anderson: float
    kurtosis_expected: float

    @property
    def kurtosis(self) -> float:
        """Excess kurtosis of the sample about the mean of theory."""
        square = self.deviates**2
        return float((square**2).mean() / square.mean() ** 2 - 3)

    def facts(self) -> dict[str, Any]:
        """The tests and the kurtosis."""
        return {
            "radii": self.kind,
            "height": self.height,
            "samples": len(self.deviates),
            "p_kolmogorov_smirnov": self.smirnov,
            "p_anderson_darling": self.anderson,
            "gaussian_rejected": min(self.smirnov, self.anderson) < LEVEL / 2,
            "excess_kurtosis": self.kurtosis,
            "excess_kurtosis_first_order": self.kurtosis_expected,
        }


@dataclass(frozen=True)
class Distribution:
    """P(f) of one contact at the base, for several radii and heights."""

    samples: tuple[Sample, ...]
    medium: Medium

    def tables(self) -> dict[str, list[Row]]:
        """CSV files: the samples themselves, and the tests."""
        rows = [
            {"radii": one.kind, "height": one.height, "realisation": k, "deviate": value}
            for one in self.samples
            for k, value in enumerate(one.deviates.tolist())
        ]
        return {"pf": rows, "pf_tests": [one.facts() for one in self.samples]}

    def facts(self) -> dict[str, Any]:
        """What the tests say; both together at level 1 %."""
        return {
            "spacing_over_r": float(self.medium.spacing),
            "relative_std": self.medium.std,
            "level_of_both_tests_together": LEVEL,
            "samples": [one.facts() for one in self.samples],
        }

    def lines(self) -> list[str]:
        """One line a sample."""
        return [
            f"{one.kind} radii, M = {one.height}: Gaussian "
            f"{'rejected' if one.facts()['gaussian_rejected'] else 'not rejected'} "
            f"(Kolmogorov–Smirnov p = {one.smirnov:.2g}, Anderson–Darling p = {one.anderson:.2g})"
            for one in self.samples
        ]


def samples(realisations: int, seed: int, notice: Notice, medium: Medium = PAPER) -> Distribution:
    """Draw one contact from each realisation, and test."""
    found = [
        _sample(case, range(number << 32, (number << 32) + realisations), seed, medium, notice)
        for number, case in enumerate(CASES)  # samples share no radii
    ]
    notice("P(f): tests")
    values = tests(np.stack([deviates for deviates, _ in found]), seed)
    return Distribution(
        tuple(
            Sample(*case, deviates, *p_values, KURTOSIS[case[0]] * share)
            for case, (deviates, share), p_values in zip(CASES, found, values, strict=True)
        ),
        medium,
    )


def _sample(
    case: tuple[str, int], realisations: range, seed: int, medium: Medium, notice: Notice
) -> tuple[Array, float]:
    """Give the deviates, and Σw⁴/(Σw²)² of the weights of the radii."""
    kind, M = case
    plan = planned(
        "contact",
        at=(0, 0, "+"),
        height=M,
        width=None,
        seed=seed,
        kind=kind,
        realisations=len(realisations),
        std=medium.std,
        spacing=medium.spacing,
    )
    what = f"P(f), {kind} radii, M = {M}"
    found = [g[0, :, 0] / F[0, 0] for F, g in changes(plan, realisations, notice, what)]
    std = np.sqrt(closed_forms.surface_variance(M, 0, float(medium.phi), medium.std, 1.0))
    weights = forces_of(impulses(plan)).change.plus[1][:, 0]
    share = float((weights**4).sum() / (weights**2).sum() ** 2)
    return np.concatenate(found) / std, share


def tests(samples: Array, seed: int) -> list[tuple[float, float]]:
    """Give p-values of Kolmogorov–Smirnov and Anderson–Darling against N(0, 1), none fitted.

    ``samples``, shape (samples, n), are compared with the same simulated ones.
    """
    from scipy import stats

    anderson = stats.monte_carlo_test(
        samples, np.random.default_rng(seed).standard_normal, _anderson_darling,
        vectorized=True, n_resamples=SIMULATED_TESTS, alternative="greater", axis=-1, batch=100,
    ).pvalue  # fmt: skip
    smirnov = [stats.kstest(sample, "norm").pvalue for sample in samples]
    return [(float(one), float(other)) for one, other in zip(smirnov, anderson, strict=True)]


def _anderson_darling(samples: Array, axis: int) -> Array:
    """Give the statistic A² of samples along the last axis against N(0, 1)."""
    from scipy.special import log_ndtr

    n, ordered = samples.shape[axis], np.sort(samples, axis=axis)
    both = log_ndtr(ordered) + log_ndtr(-ordered[..., ::-1])
    return np.asarray(-n - ((2 * np.arange(1, n + 1) - 1) / n * both).sum(axis=axis))


def draw(data: Distribution) -> "Figure":
    """Draw histograms of two samples with the Gaussian of theory."""
    from . import style

    figure = style.figure(style.PAGE, 2.6)
    panels = figure.subplots(1, 2)
    for number, (axes, case) in enumerate(zip(panels, DRAWN, strict=True)):
        one = next(s for s in data.samples if (s.kind, s.height) == case)
        _histogram(axes, one, style.series(number))
    style.letter(panels)
    return figure


def _histogram(axes: "Axes", one: Sample, look: tuple[str, str]) -> None:
    from . import parts

    edges = np.linspace(-4, 4, 41)
    width = edges[1] - edges[0]
    counts, _ = np.histogram(one.deviates, edges)
    some = counts > 0
    middle = ((edges[1:] + edges[:-1]) / 2)[some]
    density = counts[some] / len(one.deviates) / width
    error = np.sqrt(counts[some]) / len(one.deviates) / width
    v = np.linspace(-4, 4, 321)
    axes.plot(v, np.exp(-(v**2) / 2) / np.sqrt(2 * np.pi), color="black", lw=1.0, label="Gaussian")
    name = f"{one.kind} radii, $M={one.height}$"
    parts.densities(axes, middle, density, error, look, name)
    axes.set_xlim(-4, 4)
    axes.set_ylim(8e-5, 1)
    axes.set_xlabel(r"$(f-\langle f\rangle)\,/\,\sigma_f$")
    axes.set_ylabel(r"$\sigma_f\,P(f)$")
    tests = f"Kolmogorov–Smirnov {_p(one.smirnov)}\nAnderson–Darling {_p(one.anderson)}"
    axes.legend(loc="lower center", title=tests, title_fontsize=7)  # below the curve


def _p(value: float) -> str:
    return (
        f"$p={value:.2f}$"
        if value >= 0.01
        else f"$p={value:.3f}$"
        if value >= 0.001
        else "$p<0.001$"
    )
