"""The result of an ensemble: arrays, rows, and plain data with no time and no worker in it."""

import math
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from ..arithmetic.systems import Array
from ..tables import Row, html_table, rows_of
from .estimates import Estimates, root

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@dataclass(frozen=True)
class Ensemble:
    """Statistics over N packings of G groups of alike contacts.

    A group is a layer and branch of a profile, one contact, or all of a histogram. Forces are in
    units of the load's magnitude; arrays are float64 of shape (G,) unless they say otherwise. The
    spread over packings, which are independent, gives the standard errors.

    ``half_width`` holds for all σ_f together, relative, with confidence ``confidence``. ``reached``
    says whether the ``until`` that was asked for was met, None where nothing was asked; ``looks``
    counts how often the sums were looked at for that, 0 where nothing was asked. ``solved``
    packings were solved now, and not read from a store. ``estimates`` has exact rationals.
    """

    estimates: Estimates
    confidence: float
    looks: int
    half_width: float
    reached: bool | None
    solved: int

    @property
    def quantity(self) -> str:
        """What was asked, as the scene calls it."""
        return self.estimates.measurement.quantity

    @property
    def realisations(self) -> int:
        """N packings."""
        return self.estimates.realisations

    @property
    def unbuildable(self) -> int:
        """Packings that were drawn and left out: a bead of them finds no rest."""
        return self.estimates.sums.unbuildable

    @property
    def samples(self) -> int:
        """Contacts of a group in all N packings; those of one packing are correlated."""
        return self.estimates.samples

    @cached_property
    def index(self) -> dict[str, Array]:
        """Columns that name the groups: j, branch, i, component; empty for a histogram."""
        labels = self.estimates.measurement.labels
        return {name: np.array(column) for name, column in labels.items()}

    @cached_property
    def mean(self) -> Array:
        """Mean force; of forces that differ to zeroth order already, their mean."""
        ordered = self.estimates.measurement.ordered()
        pairs = zip(ordered, self.estimates.mean, strict=True)
        return np.array([float(F + g) for F, g in pairs])

    @cached_property
    def mean_change(self) -> Array:
        """Mean of the change g = f − F from the ordered force F."""
        return np.array([float(g) for g in self.estimates.mean])

    @property
    def mean_change_error(self) -> Array:
        """Standard error of ``mean_change``."""
        return _floats(self.estimates.mean_error)

    @cached_property
    def mean_square(self) -> Array:
        """Mean of g², the variance about the ordered force: Eqs. 13 and 14 are its theory."""
        return np.array([float(g) for g in self.estimates.mean_square])

    @property
    def std(self) -> Array:
        """σ_f, the standard deviation of g about its mean."""
        return np.array(self.estimates.std)

    @property
    def std_error(self) -> Array:
        """Standard error of ``std``; NaN where nothing varies."""
        return _floats(self.estimates.std_error)

    @cached_property
    def first_order_std(self) -> Array | None:
        """σ_f to first order, exact at finite M (Eqs. 13 and 14); None where they don't apply."""
        m = self.estimates.measurement
        layers, theory = m.labels.get("j"), m.theory()
        if theory is None or layers is None or "component" in m.labels:
            return None
        return np.array([float(theory[j]) for j in layers])

    @property
    def tensile(self) -> Array:
        """How many contacts pull; int64."""
        return self.estimates.sums.tensile

    @cached_property
    def covariance(self) -> Array | None:
        """Covariance between groups from packing to packing, (G, G); None if not asked for.

        Of a profile that of mean squares of g over a packing's contacts, else that of g. Divided by
        N it is that of the means over all packings.
        """
        if not self.estimates.measurement.covariance:
            return None
        return self.estimates.covariance()

    @cached_property
    def bins(self) -> dict[str, Array] | None:
        """Bins of a histogram of g; None for other quantities.

        Columns of shape (B + 2,), first and last what lies outside: ``low``, ``high``, ``count``,
        ``share`` of all samples, and its standard error ``share_error``.
        """
        m, N = self.estimates.measurement, self.realisations
        if not m.edges:
            return None
        edges = np.array([-math.inf, *m.edges, math.inf])
        counts, squares = self.estimates.sums.bins.tolist()
        scatter = [  # of the share of each packing, over all packings
            Fraction(N * square - count * count, N * (N - 1))
            for count, square in zip(counts, squares, strict=True)
        ]
        return {
            "low": edges[:-1],
            "high": edges[1:],
            "count": np.array(counts, dtype=np.int64),
            "share": np.array([count / self.samples for count in counts]),
            "share_error": np.array([float(root(s / N) / m.members) for s in scatter]),
        }

    @cached_property
    def arrays(self) -> dict[str, Array]:
        """The table's columns by name, all of one length: of groups, or of a histogram's bins."""
        return self.bins or self._groups

    @cached_property
    def _groups(self) -> dict[str, Array]:
        theory = self.first_order_std
        return {
            **self.index,
            "samples": np.full(len(self.mean), self.samples),
            "mean": self.mean,
            "mean_change": self.mean_change,
            "mean_change_error": self.mean_change_error,
            "std": self.std,
            "std_error": self.std_error,
            **({} if theory is None else {"first_order_std": theory}),
            "tensile": self.tensile,
        }

    def rows(self) -> list[Row]:
        """The table row by row, ready for a data frame."""
        return rows_of(self.arrays)

    def data(self) -> dict[str, Any]:
        """Give what JSON can hold; numbers are the shortest decimals of the float64."""
        m = self.estimates.measurement
        data: dict[str, Any] = {
            "ensemble": {
                "realisations": self.realisations,
                "unbuildable": self.unbuildable,
                "unbuildable_share": self.unbuildable / self.estimates.sums.tried,
                "first_unbuildable": self.estimates.sums.first_unbuildable
                if self.unbuildable
                else None,
                "contacts_in_a_group": m.members,
                "arithmetic": "float64, summed exactly",
            },
            "skipped": [{"effect": s.effect, "reason": s.reason} for s in m.plan.skipped],
            "results": {m.quantity: [_printed(row) for row in self.rows()]},
            "confidence": {
                "level": self.confidence,
                "largest_relative_half_width": (
                    self.half_width if math.isfinite(self.half_width) else None
                ),
                "looks": self.looks,
                "reached": self.reached,
            },
        }
        if self.bins:
            data["statistics"] = _printed(rows_of(self._groups)[0])  # of all that was counted
        if self.covariance is not None:
            data["covariance"] = {
                "of": "mean square change of a packing" if m.squares else "change",
                "labels": m.labels,
                "matrix": self.covariance.tolist(),
            }
        return data

    def plot(self) -> "Figure":
        """Draw it; needs matplotlib (the extra ``plots``).

        A profile is drawn as σ_f beside theory, a histogram as P(f), contact forces as force chains
        of σ_f, a response as a map. Raises ``SceneError`` for one contact, which has no figure.
        """
        from ..figures.answers import figure_of

        columns, errors = self.arrays, {"std": self.std_error}
        if self.quantity == "response":
            vertical = self.index["component"] == "vertical"
            columns = {name: column[~vertical] for name, column in self.index.items()}
            columns["vertical_mean"] = self.mean[vertical]
            columns["force_std"] = self.std[~vertical]
        return figure_of(self.estimates.measurement.plan, columns, errors)

    def __str__(self) -> str:
        """Say how many rows and packings there are, and how sure they are."""
        data = self.data()
        lines = [f"{self.quantity}: {len(data['results'][self.quantity])} rows"]
        lines.append(f"{self.realisations} packings, {data['ensemble']['arithmetic']}")
        if self.unbuildable:
            lines.append(
                f"{self.unbuildable} more, {data['ensemble']['unbuildable_share']:.2g} of all, "
                "can't be built and are left out, the first of them realisation "
                f"{data['ensemble']['first_unbuildable']}: what is said holds for the others"
            )
        if math.isfinite(self.half_width):
            looks = f", looked at {self.looks} times" if self.looks else ""
            lines.append(
                f"every std together within {self.half_width:.2g} of itself, with confidence "
                f"{self.confidence:g}{looks}"
            )
        lines += [f"left out: {s['effect']}: {s['reason']}" for s in data["skipped"]]
        return "\n".join(lines)

    def _repr_html_(self) -> str:
        """Show the first rows as a table in a notebook."""
        return html_table(self.rows(), str(self).splitlines())


def _floats(values: list[float | None]) -> Array:
    return np.array([math.nan if value is None else value for value in values])


def _printed(row: Row) -> Row:
    """Print floats; nothing stands for NaN."""
    found = {
        name: ("" if math.isnan(value) else repr(value)) if isinstance(value, float) else value
        for name, value in row.items()
    }
    if "first_order_std" in row:
        found["first_order_std"] = f"{row['first_order_std']:.12g}"
    return found
