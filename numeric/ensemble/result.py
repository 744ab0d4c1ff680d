"""The result of an ensemble: arrays, a table, and data that name no times and no workers."""

import math
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from .. import tables
from ..accuracy import Accuracy, printed
from ..arithmetic.errors import ForceDiffusionError
from ..arithmetic.systems import FLOAT64, Array
from ..lattice.branch import ORDER
from ..quantities.base import RATIO, Table, first_order_std
from ..scene.scene import source_of
from ..statistics.confidence import half_width
from ..statistics.moments import error_of_std, with_errors
from .sums import Measurement, Sums

if TYPE_CHECKING:
    from matplotlib.figure import Figure

LEAST = 1e-300  # floats that are smaller have fewer digits


@dataclass(frozen=True, eq=False, repr=False)
class Ensemble(tables.Answered):
    """Statistics over N packings, for G groups of equivalent contacts.

    A group is a layer and branch of a profile, a single contact, or all contacts of a histogram.
    Forces have the unit of the load's magnitude. Unless stated otherwise, arrays are float64 of
    shape (G,), in the order of the table: by j, i (or p, q), branch and component. Standard errors
    come from the scatter between packings, which are independent.

    ``half_width`` holds for all σ_f together with confidence ``confidence``. ``until`` is the
    relative half-width that was asked for, or None; ``looks`` counts how often that was tested.
    ``solved`` packings were solved in this call; the others were read from a store.
    """

    measurement: Measurement
    sums: Sums
    confidence: float
    until: float | None = None
    looks: int = 0
    solved: int = 0

    @property
    def quantity(self) -> str:
        """The question, by its name in a scene."""
        return self.measurement.plan.quantity.name

    @property
    def realisations(self) -> int:
        """The number N of packings."""
        return self.sums.packings

    @property
    def unbuildable(self) -> int:
        """How many packings were drawn and left out, because they can't be built."""
        return self.sums.left_out

    @property
    def samples(self) -> int:
        """How many contacts a group has in all packings; those of one packing are correlated."""
        return self.realisations * self.measurement.members

    @cached_property
    def half_width(self) -> float:
        """Half-width of the widest of the simultaneous intervals of σ_f, relative to σ_f."""
        _, std, _, log_error = self._moments
        known = np.isfinite(log_error)
        errors = log_error[known].tolist()
        if self.realisations < 2 or (self.realisations == 2 and (std[~known] > 0).any()):
            errors = [math.inf]  # of single contacts two packings don't tell it
        return half_width(errors, self.realisations, self.confidence, self.looks)

    @property
    def reached(self) -> bool | None:
        """Whether ``until`` was reached; None if it was not given."""
        return None if self.until is None else self.half_width <= self.until

    @cached_property
    def _order(self) -> Array:
        """Where the rows of the table stand among the groups."""
        labels = self.measurement.labels
        keys = [labels[name] for name in ("component", *ORDER) if name in labels]
        return np.lexsort(keys) if keys else np.arange(self.measurement.groups)

    @property
    def _unit(self) -> float:
        """The load's magnitude."""
        return float(self.measurement.plan.scene.load.magnitude)

    @cached_property
    def _moments(self) -> tuple[Array, Array, Array, Array]:
        """Mean change, σ, and standard errors of the mean and of ln σ, as they were summed up."""
        return with_errors(self.realisations, self.sums.means, self.sums.products)

    def _forces(self, values: Array) -> Array:
        """Give what was summed up in the order of the table, in the unit of force."""
        scaled = np.ldexp(values[self._order], self.measurement.unit)
        return np.asarray(scaled * self._unit)

    def _squares(self, roots: Array) -> Array:
        """Raises ``ForceDiffusionError`` if squares of forces are out of range in this unit."""
        with np.errstate(all="ignore"):
            squares = np.asarray(roots**2)
        if ((roots != 0) & ~((squares > LEAST) & np.isfinite(squares))).any():
            raise ForceDiffusionError(
                f"squares of forces are beyond what floats hold where load.magnitude is "
                f"{self._unit:g}: choose another unit"
            )
        return squares

    @cached_property
    def mean(self) -> Array:
        """Mean force ⟨f⟩."""
        change = np.ldexp(self._moments[0], self.measurement.unit)
        return np.asarray((self.measurement.ordered() + change)[self._order] * self._unit)

    @cached_property
    def mean_change(self) -> Array:
        """Mean of the change g = f − F from the ordered force F."""
        return self._forces(self._moments[0])

    @cached_property
    def mean_change_error(self) -> Array:
        """Standard error of ``mean_change``."""
        return self._forces(self._moments[2])

    @cached_property
    def mean_square(self) -> Array:
        """Mean of g², the variance about the ordered force, which Eqs. 13 and 14 predict.

        Raises ``ForceDiffusionError`` if squares of forces overflow or underflow in this unit.
        """
        return self._squares(self._forces(np.sqrt(self.sums.means[1])))

    @cached_property
    def std(self) -> Array:
        """σ_f, the standard deviation of g about its mean."""
        return self._forces(self._moments[1])

    @cached_property
    def std_error(self) -> Array:
        """Standard error of ``std``, for intervals of about ± 2 errors; NaN if nothing varies.

        It is σ_f (e^2ε − 1)/2, where ε is the standard error of ln σ_f.
        """
        _, std, _, log_error = self._moments
        return self._forces(error_of_std(std, log_error))

    @property
    def variance(self) -> Array:
        """σ_f². Raises ``ForceDiffusionError`` as ``mean_square`` does."""
        return self._squares(self.std)

    @cached_property
    def index(self) -> dict[str, Array]:
        """Columns that name the groups: j, branch, i or p, q, component; none for a histogram."""
        labels = self.measurement.labels
        return {name: np.array(column)[self._order] for name, column in labels.items()}

    @property
    def z(self) -> Array | None:
        """Relative heights j/M of the contacts; None for a histogram."""
        layers = self.index.get("j")
        return None if layers is None else np.asarray(layers / self.measurement.problem.height)

    @property
    def std_over_mean(self) -> Array | None:
        """σ_f/⟨f⟩, as in the paper's figures; None if a mean may be zero: loads at an angle.

        Its standard error is that of ``std``, divided by ⟨f⟩.
        """
        load = self.measurement.problem.load
        if load.loaded is not None or load.angle_deg or "component" in self.index:
            return None
        ratio: Array = self.std / self.mean
        return ratio

    @cached_property
    def first_order_std(self) -> Array | None:
        """σ_f to first order, exact at finite M (Eqs. 13, 14, B2, B3); None if none applies."""
        if "j" not in self.index or "component" in self.index:
            return None
        contacts = zip(self.index["j"].tolist(), self.index["branch"], strict=True)
        theory = first_order_std(self.measurement.problem, contacts)
        return None if theory is None else theory.astype(np.float64) * self._unit

    @property
    def tensile(self) -> Array:
        """How many contacts pull; int64."""
        return self.sums.tensile[self._order]

    @cached_property
    def bins(self) -> dict[str, Array] | None:
        """Bins of a histogram of g; None for other quantities.

        Columns of shape (B + 2,): ``low``, ``high``, ``count``, ``share`` of all samples, and its
        standard error ``share_error``. The first and the last bin hold what lies outside.
        """
        m = self.measurement
        if not m.edges:
            return None
        edges = np.array([-math.inf, *m.edges, math.inf]) * self._unit
        N, (count, square) = self.realisations, self.sums.bins
        variance = np.maximum(square - count * (count / N), 0) / (N - 1)
        return {
            "low": edges[:-1],
            "high": edges[1:],
            "count": count,
            "share": count / self.samples,
            "share_error": np.sqrt(variance * N) / self.samples,
        }

    @cached_property
    def _groups(self) -> Table:
        theory, ratio = self.first_order_std, self.std_over_mean
        index = {**self.index, "samples": np.full(self.measurement.groups, self.samples)}
        if theory is not None:
            index["first_order_std"] = np.array([*map(Fraction, theory)])
        index["tensile"] = self.tensile
        numbers = {"mean": self.mean, "mean_change": self.mean_change, "std": self.std}
        if ratio is not None:
            numbers[RATIO] = ratio
        errors = {"mean_change": self.mean_change_error, "std": self.std_error}
        return Table(index, numbers, tuple(errors), errors)

    @property
    def arrays(self) -> dict[str, Array]:
        """The table's columns by name; an entry for each group, or for each bin of a histogram."""
        return self.bins or self._groups.columns

    @property
    def rows(self) -> int:
        """How many rows the table has."""
        return self.number_of_rows

    @cached_property
    def text(self) -> dict[str, list[str]]:
        """The columns as text, to two digits beyond their standard errors."""
        if self.bins is None:
            return _printed(self._groups)
        numbers = self.bins.copy()
        return _printed(Table({}, numbers, (), {"share": numbers.pop("share_error")}))

    @cached_property
    def source(self) -> dict[str, Any]:
        """Where it came from: program, version, scene, seed, and the SHA-256 of files read."""
        source = source_of(self.measurement.plan.scene)
        del source["scene"]["ask"]["realisations"]  # of the plan of one packing
        return source

    def data(self, *, rows: bool = True) -> dict[str, Any]:
        """Data for JSON; numbers have all known digits.

        Without ``rows`` the list of results is empty, since it may have millions of rows.
        """
        m, known = self.measurement, math.isfinite(self.half_width)
        written = self.decimals() if rows else []
        data: dict[str, Any] = {
            "source": self.source,
            "ensemble": {
                "realisations": self.realisations,
                "unbuildable": self.unbuildable,
                "unbuildable_share": self.unbuildable / (self.realisations + self.unbuildable),
                "first_unbuildable": self.sums.first_left_out if self.unbuildable else None,
                "contacts_in_a_group": m.members,
                "arithmetic": "float64",
            },
            "skipped": m.plan.data()["skipped"],
            "results": {self.quantity: written},
            "confidence": {
                "level": self.confidence,
                "largest_relative_half_width": self.half_width if known else None,
                "looks": self.looks,
                "reached": self.reached,
            },
        }
        if self.bins:  # of all that was counted
            groups = self._groups
            whole = tables.whole(groups.columns)
            (data["statistics"],) = tables.rows_of_text(_printed(groups), whole)
        return data

    def plot(self) -> "Figure":
        """Draw it; needs matplotlib (the extra ``plots``).

        A profile is drawn as σ_f beside theory, a histogram as P(f), contact forces as lines as
        thick as σ_f, a response as a map. Raises ``SceneError`` for a single contact.
        """
        from ..figures.answers import figure_of

        columns, errors = self.arrays, {"std": self.std_error}
        if "component" in self.index:
            vertical = self.index["component"] == "vertical"
            columns = {name: column[~vertical] for name, column in self.index.items()}
            columns["vertical_mean"] = self.mean[vertical]
            columns["force_std"] = self.std[~vertical]
        return figure_of(self.measurement.plan, columns, errors)

    def __str__(self) -> str:
        """Say how many rows and packings there are, and how sure they are."""
        rows = tables.counted(self.number_of_rows, "row")
        lines = [f"{self.quantity}: {rows}, {self.realisations} packings"]
        if math.isfinite(self.half_width):
            lines.append(
                f"all σ_f known to {float(f'{100 * self.half_width:.2g}'):g} % "
                f"({100 * self.confidence:g} %, simultaneous)"
            )
        if self.unbuildable:
            share = self.unbuildable / (self.realisations + self.unbuildable)
            lines.append(
                f"{self.unbuildable} more, {100 * share:.2g} % of all, can't be built and are left "
                f"out, the first of them realisation {self.sums.first_left_out}"
            )
        skipped = [f"{what} ({why})" for what, why in self.measurement.plan.skipped.items()]
        return "\n".join(lines + [f"skipped: {'; '.join(skipped)}"] * bool(skipped))

    __repr__ = __str__

    def _repr_latex_(self) -> str:
        """Show the first rows as a table in LaTeX."""
        first = {name: column[: tables.SHOWN] for name, column in self.arrays.items()}
        return tables.latex_table(tables.rows_of(first))


def _printed(table: Table) -> dict[str, list[str]]:
    """Write columns as text; rounding is far below the scatter over packings."""
    exact = Accuracy(0.0, certified=False, arithmetic=FLOAT64.name)
    return printed(table, exact, FLOAT64, sampled=True)
