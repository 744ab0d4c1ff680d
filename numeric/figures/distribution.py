"""P(f) against the Gaussian: is a contact force normal, with the mean and the width of theory?

One contact is taken from each realisation, so that samples are independent; the packings are exact.
The null hypothesis is fully specified, with no parameter fitted: mean ⟨f⟩ = f_load/2n_y, and the
exact finite-M σ_f (Eq. 13). Kolmogorov and Smirnov's test has an exact p-value; Anderson and
Darling's, which looks at the tails, is simulated. To first order f is a weighted sum of independent
radii, so that its excess kurtosis is that of the radii times Σw⁴/(Σw²)²: it vanishes as M grows,
and at M = 2 with two-point radii there is no Gaussian.
"""

from dataclasses import dataclass
from math import sqrt
from typing import Any

import numpy as np

from .. import closed_forms
from ..arithmetic.systems import Array
from ..mechanics.problem import Solved
from ..quantities.base import ContactQuantity
from . import specification as spec
from .packings import Medium, Options, forces_of, gathered, impulses, planned

# Excess kurtosis of the radii.
KURTOSIS = {"uniform": -1.2, "normal": 0.0, "two-point": -2.0}
CASES = (("uniform", 32), ("two-point", 32), ("normal", 2), ("uniform", 2), ("two-point", 2))
DRAWN = (("uniform", 32), ("two-point", 2))
SIMULATED_TESTS = 999
LEAST_P = 1 / (SIMULATED_TESTS + 1)
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

    @property
    def rejected(self) -> bool:
        """Whether either test rejects the Gaussian, both together at ``LEVEL``."""
        return min(self.smirnov, self.anderson) < LEVEL / 2

    def says(self) -> str:
        """Say what the tests find, and what the kurtosis shows beside them."""
        found, expected = (
            round(value, 2) + 0.0 for value in (self.kurtosis, self.kurtosis_expected)
        )
        equal = "≤" if self.anderson <= LEAST_P else "="
        return (
            f"{self.kind} radii, M = {self.height}: "
            f"{'the tests reject' if self.rejected else 'no test rejects'} the Gaussian "
            f"(Kolmogorov–Smirnov p = {self.smirnov:.2g}, Anderson–Darling p {equal} "
            f"{self.anderson:.2g}); excess kurtosis {found:.2f}, to first order {expected:.2f}, of "
            f"so many Gaussian forces 0 ± {sqrt(24 / len(self.deviates)):.2f}"
        )

    def facts(self) -> dict[str, Any]:
        """The tests and the kurtosis."""
        return {
            "radii": self.kind,
            "height": self.height,
            "samples": len(self.deviates),
            "p_kolmogorov_smirnov": self.smirnov,
            "p_anderson_darling": self.anderson,
            "gaussian_rejected": self.rejected,
            "excess_kurtosis": self.kurtosis,
            "excess_kurtosis_first_order": self.kurtosis_expected,
        }


def simulated(o: Options, medium: Medium) -> list[Sample]:
    """Draw one contact from each realisation, and test."""
    found = [
        _deviates(case, number << 32, o, medium)
        for number, case in enumerate(CASES)  # samples share no radii
    ]
    o.notice("P(f): tests")
    values = tests(np.stack([deviates for deviates, _ in found]), o.seed)
    return [
        Sample(*case, deviates, *p_values, KURTOSIS[case[0]] * share)
        for case, (deviates, share), p_values in zip(CASES, found, values, strict=True)
    ]


def _deviates(case: tuple[str, int], start: int, o: Options, medium: Medium) -> tuple[Array, float]:
    """Give the deviates, and Σw⁴/(Σw²)² of the weights of the radii."""
    kind, M = case
    plan = planned(
        "contact", at=(0, 0, "+"), height=M, width=None, seed=o.seed, kind=kind,
        realisations=o.realisations, std=medium.std, spacing=medium.spacing,
    )  # fmt: skip
    quantity = plan.quantity
    assert isinstance(quantity, ContactQuantity)

    def each(answer: Solved, number: int) -> tuple[Array]:
        F, g = quantity.changes(plan.problem, answer, number)
        return (g[0, :, 0] / F[0, 0],)

    (found,) = gathered(plan, o.notice, f"P(f), {kind} radii, M = {M}", each, start)
    std = np.sqrt(closed_forms.surface_variance(M, 0, float(medium.phi), medium.std, 1.0))
    weights = forces_of(impulses(plan)).change.plus[1][:, 0]
    return found / std, float((weights**4).sum() / (weights**2).sum() ** 2)


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


def figure(o: Options) -> spec.Figure:
    """P(f) of one contact at the base, for several radii and heights; two of them drawn."""
    medium = o.medium()
    found = simulated(o, medium)
    facts = [one.facts() for one in found]
    drawn = [next(s for s in found if (s.kind, s.height) == case) for case in DRAWN]
    rows = [
        (one.kind, one.height, k, value)
        for one in found
        for k, value in enumerate(one.deviates.tolist())
    ]
    return spec.Figure(
        spec.Picture([_histogram(one, c) for c, one in enumerate(drawn)], 2.6, page=True),
        tables={
            "pf": spec.table("radii height realisation deviate", rows),
            "pf_tests": spec.table(" ".join(facts[0]), [one.values() for one in facts]),
        },
        facts={
            "spacing_over_r": float(medium.spacing),
            "relative_std": medium.std,
            "level_of_both_tests_together": LEVEL,
            "samples": facts,
        },
        words=[one.says() for one in found],
    )


def _histogram(one: Sample, c: int) -> spec.Panel:
    edges, v = np.linspace(-4, 4, 41), np.linspace(-4, 4, 321)
    counts, _ = np.histogram(one.deviates, edges)
    some, unit = counts > 0, len(one.deviates) * (edges[1] - edges[0])
    middle = ((edges[1:] + edges[:-1]) / 2)[some]
    return spec.Panel(
        [
            spec.Line(v, np.exp(-(v**2) / 2) / np.sqrt(2 * np.pi), "black", name="Gaussian"),
            spec.Points(
                middle, counts[some] / unit, c, f"{one.kind} radii, $M={one.height}$",
                np.sqrt(counts[some]) / unit,
            ),
        ],
        spec.Axis(r"$(f-\langle f\rangle)\,/\,\sigma_f$", -4, 4),
        spec.Axis(r"$\sigma_f\,P(f)$", 8e-5, 1, log=True),
        legend="lower center",  # below the curve
        legend_title=f"Kolmogorov–Smirnov {_p(one.smirnov)}\nAnderson–Darling {_p(one.anderson)}",
    )  # fmt: skip


def _p(value: float) -> str:
    if value < 0.001:
        return "$p<0.001$"
    return f"$p={value:.2f}$" if value >= 0.01 else f"$p={value:.3f}$"
