"""Statistics over packings whose contacts are unilateral, and their result."""

import math
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from ..arithmetic.systems import Array
from ..statistics.ratios import moments, ratio
from .estimates import Estimates
from .measure import Measurement
from .networks import NetworkSums
from .result import Ensemble
from .sums import AnySums, Sums, none

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@dataclass(frozen=True)
class NetworkEstimates(Estimates):
    """What sums over packings say; ``sums`` has their counts alone, ``networks`` all of them."""

    networks: NetworkSums

    @classmethod
    def of(cls, measurement: Measurement, networks: NetworkSums) -> "NetworkEstimates":
        """Take what was summed up."""
        sums = replace(
            none(measurement),
            realisations=networks.realisations,
            unbuildable=networks.unbuildable,
            first_unbuildable=networks.first_unbuildable,
        )
        return cls(measurement, sums, networks)

    @cached_property
    def counts(self) -> Array:
        """Samples of each group in all packings, (groups,); int64."""
        return np.asarray(self.networks.samples[:, 0].sum(axis=0).astype(np.int64))

    @property
    def samples(self) -> int:
        """Those of all groups."""
        return int(self.counts.sum())

    @cached_property
    def moments(self) -> tuple[Array, Array, Array, Array]:
        """Mean change from the ordered force, σ_f, and their standard errors, (groups,) each."""
        return moments(*np.swapaxes(self.networks.samples, 0, 1))

    @cached_property
    def mean(self) -> list[Fraction]:
        """Mean change from the ordered force; 0 where nothing was sampled."""
        return [Fraction(value) for value in np.nan_to_num(self.moments[0]).tolist()]

    @cached_property
    def mean_square(self) -> list[Fraction]:
        """Mean squared change."""
        pairs = zip(self.variance, self.mean, strict=True)
        return [variance + mean * mean for variance, mean in pairs]

    @cached_property
    def variance(self) -> list[Fraction]:
        """Variance of the force."""
        return [Fraction(value) ** 2 for value in np.nan_to_num(self.moments[1]).tolist()]

    @cached_property
    def mean_error(self) -> list[float | None]:
        """Standard errors of the means."""
        return list(self.moments[2])

    @cached_property
    def _std_error(self) -> list[tuple[Fraction, Fraction] | None]:
        pairs = zip(self.moments[3].tolist(), self.moments[1].tolist(), strict=True)
        return [
            (Fraction(error), Fraction(std)) if math.isfinite(error) and std > 0 else None
            for error, std in pairs
        ]


@dataclass(frozen=True)
class NetworkEnsemble(Ensemble):
    """Statistics over packings whose contacts are unilateral; forces are those of the contacts.

    A group is a layer of a profile, a contact of the lattice, a bead of a response (which has the
    vertical force that the bead bears), or all contacts of a histogram. The number of contacts
    differs from packing to packing: means are ratios of sums, and so are their errors.
    """

    estimates: NetworkEstimates

    left_out = "did not come to rest, or could not be proved to, and are left out"

    @cached_property
    def _order(self) -> Array:
        """The groups that have samples."""
        return np.flatnonzero(self.estimates.counts)

    @property
    def first_order_std(self) -> None:
        """Eqs. 13 and 14 are of contacts that may pull."""

    @property
    def covariance(self) -> None:
        """Not known."""

    @cached_property
    def bins(self) -> dict[str, Array] | None:
        """Bins of a histogram of f: see ``Ensemble``."""
        m, networks = self.estimates.measurement, self.estimates.networks
        if not m.edges:
            return None
        edges = np.array([-math.inf, *m.edges, math.inf]) * self._unit
        share, error = ratio(networks.samples[:, 0], networks.bins.astype(float))
        return {
            "low": edges[:-1],
            "high": edges[1:],
            "count": networks.bins.sum(axis=0),
            "share": share,
            "share_error": error,
        }

    @cached_property
    def _groups(self) -> dict[str, Array]:
        ratio = self.std_over_mean
        return {
            **self.index,
            "samples": self._sorted(self.estimates.counts),
            "mean": self.mean,
            "mean_error": self.mean_change_error,
            "std": self.std,
            "std_error": self.std_error,
            **({} if ratio is None else {"std_over_mean": ratio}),
        }

    def plot(self) -> "Figure":
        """Draw a profile or a histogram; needs matplotlib (the extra ``plots``)."""
        from ..figures.answers import figure_of

        return figure_of(self.estimates.measurement.plan, self.arrays, {})

    def data(self, *, rows: bool = True) -> dict[str, Any]:
        """Give what JSON can hold; numbers have the digits that are known."""
        data = super().data(rows=rows)
        del data["ensemble"]["contacts_in_a_group"]
        data["ensemble"]["arithmetic"] = "each packing proved in balls, forces rounded to float64"
        return data


def estimates_of(m: Measurement, sums: AnySums) -> Estimates:
    """Give the estimates that belong to sums of either kind."""
    if isinstance(sums, NetworkSums):
        return NetworkEstimates.of(m, sums)
    assert isinstance(sums, Sums)
    return Estimates(m, sums)
