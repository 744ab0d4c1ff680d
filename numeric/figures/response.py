"""Figure 4: the response to a vertical load on one bead, its mean (a) and its fluctuation (b).

p is the vertical force that a bead gets from *both* its upper contacts. To first order the two lie
on different diagonals, whose heights add up to l + j: their variances add up to Eq. 16, whatever
the horizontal position. One contact alone depends on the position. On a leg of the cone one
contact carries all of p, half of the load on average, and fluctuates less. The variances at finite
l are the closed forms, exact to first order; the simulation is exact and nonlinear.
"""

from collections.abc import Callable
from dataclasses import dataclass
from math import asin, sqrt
from typing import Any

import numpy as np

from ..arithmetic.systems import Array
from ..closed_forms import bead_response, contact_response
from ..mechanics.problem import Solved
from ..planning.plan import Plan
from ..quantities import response as quantities
from ..scene.sections import PointLoad
from ..statistics.bands import Band, averaged, simultaneous
from .models.double_y import Profile, profiles
from .packings import (
    Medium,
    Notice,
    Row,
    planned,
    solved,
)

APEX = 24  # the loaded bead is (0, APEX)
MEDIUM = Medium(std=1e-4)  # far below M*
LEVEL = 0.99
CUTS = (18, 12, 6, 0)


@dataclass(frozen=True)
class Response:
    """The response on layers j = 0 … l − 1, in units of the load; lists hold one array a layer.

    Layer j has the l − j + 1 beads i = −(l − j), …, l − j within the cone, its two legs included.
    ``variance`` and ``one_contact`` (upper contacts "+", the bead's upper right) are exact to first
    order, in (σ/r)²; ``simulated_*`` are those of the ensemble, and ``bands`` lie around its ln σ.
    """

    apex: int
    realisations: int
    medium: Medium
    variance: tuple[Array, ...]
    one_contact: tuple[Array, ...]
    mean: tuple[Array, ...]
    simulated_mean: tuple[Array, ...]
    simulated_variance: tuple[Array, ...]
    band: Band
    double_y: tuple[Profile, ...]

    def printed(self, j: int) -> float:
        """Eq. 16, in (σ/r)²."""
        return 1.5 / float(1 - self.medium.phi**2) ** 2 * (self.apex + j)

    def sites(self, j: int) -> Array:
        """All i of layer j within the cone."""
        return np.arange(-(self.apex - j), self.apex - j + 1, 2)

    def limits(self) -> dict[int, tuple[Array, Array]]:
        """Give the band of the variance, legs included, by height of the cuts."""
        low, high = (edge**2 for edge in self.band.limits)
        found, at = {}, 0
        for j in CUTS:
            n = self.apex - j + 1
            found[j] = (low[at : at + n], high[at : at + n])
            at += n
        return found

    def standard_error(self, j: int, q: int) -> float:
        """Give the standard error of the simulated mean on the q-th bead of layer j."""
        return self.medium.std * sqrt(
            float(self.simulated_variance[j][q]) / (self.realisations - 1)
        )

    def deviation(self) -> float:
        """Give the largest deviation of the exact first-order σ on the cuts, in half-widths."""
        return self.band.deviation(np.sqrt(_on_cuts(self.variance)))

    def tables(self) -> dict[str, list[Row]]:
        """CSV files: the map, the cuts with their bands, and the double Y where asked for."""
        beads: list[Row] = []
        cuts: list[Row] = []
        limits = self.limits()
        for j in range(self.apex):
            sites = self.sites(j).tolist()
            for q, i in enumerate(sites):
                leg = q in {0, len(sites) - 1}
                row: Row = {
                    "i": i,
                    "j": j,
                    "on_cone": int(leg),
                    "mean_ordered": float(self.mean[j][q]),
                    "mean_simulated": float(self.simulated_mean[j][q]),
                    "mean_standard_error": self.standard_error(j, q),
                    "variance_exact_first_order": float(self.variance[j][q]),
                    "variance_printed": "" if leg else self.printed(j),
                    "variance_simulated": float(self.simulated_variance[j][q]),
                    "variance_upper_plus_contact": float(self.one_contact[j][q]),
                }
                beads.append(row)
                if j in limits:
                    low, high = (float(side[q]) for side in limits[j])
                    cuts.append({**row, "band_low": low, "band_high": high})
        tables = {"figure4": beads, "figure4_cuts": cuts}
        if self.double_y:
            tables["figure4_double_y"] = [row for one in self.double_y for row in one.rows()]
        return tables

    def facts(self) -> dict[str, Any]:
        """Verdicts, and what the paper says of apex and base."""
        below, base = self.variance[self.apex - 2], self.variance[1]
        found: dict[str, Any] = {
            "apex": self.apex,
            "realisations": self.realisations,
            "spacing_over_r": float(self.medium.spacing),
            "relative_std": self.medium.std,
            "simultaneous_level": LEVEL,
            "exact_first_order_inside": self.deviation() <= 1,
            "largest_deviation_in_half_widths": self.deviation(),
            "variance_below_apex_over_base_exact": float(below[1] / base[len(base) // 2]),
            "variance_below_apex_over_base_printed": self.printed(self.apex - 2) / self.printed(1),
        }
        if self.double_y:
            found["double_y"] = [one.facts() for one in self.double_y]
        return found

    def lines(self) -> list[str]:
        """Say whether theory holds."""
        deviation = self.deviation()
        where = "inside" if deviation <= 1 else "outside"
        return [
            f"apex l = {self.apex}: exact first-order fluctuation {where} the simultaneous "
            f"{LEVEL:.0%} band ({deviation:.2f} of its half-width)"
        ]


def _on_cuts(layers: tuple[Array, ...]) -> Array:
    """Put the beads of the cuts one after the other."""
    return np.concatenate([layers[j] for j in CUTS], axis=-1)


def respond(
    realisations: int,
    seed: int,
    notice: Notice,
    *,
    double_y: bool = False,
    medium: Medium = MEDIUM,
) -> Response:
    """Evaluate the closed forms, and simulate."""
    ensemble = planned(
        "response",
        height=APEX,
        width=None,
        seed=seed,
        std=medium.std,
        spacing=medium.spacing,
        load=PointLoad(at=(0, APEX)),
        realisations=realisations,
    )
    ordered = tuple(_ordered(j) for j in range(APEX))
    samples: list[tuple[Array, ...]] = []
    for answer, number in solved(ensemble, range(realisations), notice, "figure 4"):
        samples.append(vertical(ensemble, answer, number))
    changes = tuple(np.concatenate(parts) for parts in zip(*samples, strict=True))
    cut = _on_cuts(changes) / medium.std
    variance = cut.var(axis=0)
    influence = (cut - cut.mean(axis=0)) ** 2 / (2 * variance) - 0.5
    return Response(
        APEX,
        realisations,
        medium,
        tuple(_exact(j, medium, bead_response) for j in range(APEX)),
        tuple(_exact(j, medium, contact_response, "+") for j in range(APEX)),
        ordered,
        tuple(F + p.mean(axis=0) for F, p in zip(ordered, changes, strict=True)),
        tuple(p.var(axis=0) / medium.std**2 for p in changes),
        simultaneous(averaged(np.log(variance) / 2, influence), LEVEL, seed),
        profiles(asin(medium.n_x), seed) if double_y else (),
    )


def _ordered(j: int) -> Array:
    mean = np.zeros(APEX - j + 1)
    mean[[0, -1]] = 0.5
    return mean


def _exact(j: int, medium: Medium, variance: Callable[..., Any], *branch: str) -> Array:
    """Evaluate a closed form on all beads of layer j within the cone, in (f_load σ/r)²."""
    reach = APEX - j
    phi = medium.phi
    found = [variance(i, j, 0, APEX, *branch, phi, 1, 1) for i in range(-reach, reach + 1, 2)]
    return np.array(found, dtype=float)


def vertical(ensemble: Plan, answer: Solved, number: int) -> tuple[Array, ...]:
    """Give the change of p by layer 0 … l − 1, shapes (number, l − j + 1): beads of the cone."""
    quantity = ensemble.quantity
    assert isinstance(quantity, quantities.Response)
    *_, contacts = quantity.both(ensemble.problem, answer, number)
    found, at = [], 0
    for row in ensemble.problem.force_rows[1:]:
        plus, minus = contacts[:, at : at + row.count], contacts[:, at + row.count :]
        nothing = np.zeros((number, 1))
        found.append(
            np.concatenate((plus, nothing), axis=1)
            + np.concatenate((nothing, minus[:, : row.count]), axis=1)
        )
        at += 2 * row.count
    return tuple(found)
