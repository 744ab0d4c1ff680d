"""Figure 4: the response to a vertical load on one bead, its mean (a) and its fluctuation (b).

p is the vertical force that a bead gets from *both* its upper contacts. To first order the two lie
on different diagonals, whose heights add up to l + j: their variances add up to Eq. 16, whatever
the horizontal position. One contact alone depends on the position. On a leg of the cone one
contact carries all of p, half of the load on average, and fluctuates less. The variances at finite
l are the closed forms, exact to first order; the simulation is exact and nonlinear.
"""

from dataclasses import dataclass
from math import asin
from typing import Any

import numpy as np

from ..arithmetic.systems import Array
from ..closed_forms import bead_response, contact_response
from ..mechanics.problem import Solved
from ..planning.plan import Plan
from ..quantities import response as quantities
from ..scene.sections import PointLoad
from ..statistics.bands import averaged, simultaneous
from . import specification as spec
from .double_y import Profile, profiles
from .elements import cone
from .packings import LEVEL, Medium, Options, gathered, of_ensembles, planned

APEX = 24  # the loaded bead is (0, APEX)
MEDIUM = Medium(std=1e-4)  # far below M*
CUTS = (18, 12, 6, 0)
SITES = [(i, j) for j in range(APEX) for i in range(-(APEX - j), APEX - j + 1, 2)]
"""The beads of the cone, legs included, layer by layer from the base up."""
COLUMN, LAYER = np.array(SITES).T
LEG = np.abs(COLUMN) == APEX - LAYER
ORDERED = np.where(LEG, 0.5, 0.0)
"""The mean in the ordered packing."""
ON_CUTS = np.concatenate([np.flatnonzero(j == LAYER) for j in CUTS])
VARIANCE = r"$\sigma^2_{\rm ensemble}(p)\,/\,(f^{\rm load}\sigma_{\delta r}/r)^2$"


@dataclass(frozen=True)
class Response:
    """The response on ``SITES``, in units of the load; shapes (sites,).

    ``variance`` and ``one_contact`` (upper contacts "+", the bead's upper right) are exact to first
    order, in (σ/r)², ``printed`` is Eq. 16; ``mean`` and ``simulated`` variances are those of the
    ensemble. ``cuts`` compares σ on the beads of ``ON_CUTS``.
    """

    medium: Medium
    variance: Array
    one_contact: Array
    printed: Array
    mean: Array
    standard_error: Array
    simulated: Array
    cuts: spec.Comparison

    def table(self) -> spec.Table:
        """One row a bead."""
        return {
            "i": COLUMN,
            "j": LAYER,
            "on_cone": LEG.astype(int),
            "mean_ordered": ORDERED,
            "mean_simulated": self.mean,
            "mean_standard_error": self.standard_error,
            "variance_exact_first_order": self.variance,
            "variance_printed": np.where(LEG, "", self.printed.astype(object)),
            "variance_simulated": self.simulated,
            "variance_upper_plus_contact": self.one_contact,
        }

    def below_apex_over_base(self, variance: Array) -> float:
        """Variance below the apex over that at the base, beside the legs and in the middle."""
        below, base = variance[APEX - 2 == LAYER], variance[LAYER == 1]
        return float(below[1] / base[len(base) // 2])


def simulated(o: Options) -> Response:
    """Evaluate the closed forms, and simulate."""
    medium = o.medium(MEDIUM)
    ensemble = planned(
        "response", height=APEX, width=None, seed=o.seed, std=medium.std, spacing=medium.spacing,
        load=PointLoad(at=(0, APEX)), realisations=o.realisations,
    )  # fmt: skip
    (change,) = gathered(
        ensemble, o.notice, "figure 4",
        lambda answer, number: (np.concatenate(vertical(ensemble, answer, number), axis=1),),
    )  # fmt: skip
    phi, square = medium.phi, change.var(axis=0) / medium.std**2
    exact = np.array([bead_response(i, j, 0, APEX, phi, 1, 1) for i, j in SITES], dtype=float)
    one = [float(contact_response(i, j, 0, APEX, "+", phi, 1, 1)) for i, j in SITES]
    cut = np.take(change, ON_CUTS, axis=1) / medium.std
    variance = cut.var(axis=0)
    influence = (cut - cut.mean(axis=0)) ** 2 / (2 * variance) - 0.5
    band = simultaneous(averaged(np.log(variance) / 2, influence), LEVEL, o.seed)
    what = f"apex l = {APEX}: exact first-order fluctuation"
    return Response(
        medium=medium,
        variance=exact,
        one_contact=np.array(one),
        printed=1.5 / float(1 - phi**2) ** 2 * (APEX + LAYER),
        mean=ORDERED + change.mean(axis=0),
        standard_error=medium.std * np.sqrt(square / (o.realisations - 1)),
        simulated=square,
        cuts=spec.Comparison(what, band, np.sqrt(exact[ON_CUTS])),
    )


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


def figure(o: Options) -> spec.Figure:
    """Maps of mean and fluctuation, line cuts, and the double Y where it is asked for."""
    found = simulated(o)
    low, high = (edge**2 for edge in found.cuts.band.limits)
    order = np.argsort(ON_CUTS)  # as the other file has them
    cuts = {name: np.asarray(column)[ON_CUTS[order]] for name, column in found.table().items()}
    cuts |= {"band_low": low[order], "band_high": high[order]}
    double_y = profiles(asin(found.medium.n_x), o.seed) if "double-y" in o.models else ()
    side = "bottom" if double_y else "right"
    centres = np.stack([2 * float(found.medium.n_x) * COLUMN, 2 * found.medium.n_y * LAYER], axis=1)
    apex = (0.0, 2 * found.medium.n_y * APEX)
    highest = float(found.variance[APEX - 2 == LAYER][1])
    panels = [
        cone(centres, found.mean, apex, r"$\langle p\rangle\,/\,f^{\rm load}$", side, 0.5),
        cone(centres, found.variance, apex, r"$\sigma^2(p)$, unit of (c)", side, highest),
        _cuts(found),
    ]
    tables = {"figure4": found.table(), "figure4_cuts": cuts}
    facts: dict[str, Any] = {
        **of_ensembles(o, found.medium.std, apex=APEX, spacing_over_r=float(found.medium.spacing)),
        **found.cuts.fact(),
        "exact_first_order_inside": found.cuts.deviation() <= 1,
        "variance_below_apex_over_base_exact": found.below_apex_over_base(found.variance),
        "variance_below_apex_over_base_printed": found.below_apex_over_base(found.printed),
    }
    picture = spec.Picture(panels, 3.4, page=True, mosaic="ac;bc", columns=(0.85, 1.1))
    if double_y:
        panels.append(_double_y(double_y, found.medium))
        picture = spec.Picture(panels, 4.7, page=True, mosaic="ab;cd", rows=(1, 1.05))
        own = [row for one in double_y for row in one.rows()]
        tables["figure4_double_y"] = spec.table(" ".join(own[0]), [row.values() for row in own])
        facts["double_y"] = [one.facts() for one in double_y]
    return spec.Figure(picture, tables, facts, [found.cuts])


def _cuts(found: Response) -> spec.Panel:
    elements: list[spec.Element] = []
    low, high = (edge**2 for edge in found.cuts.band.limits)
    for c, j in enumerate(CUTS):
        here, band = j == LAYER, j == LAYER[ON_CUTS]
        printed = float(found.printed[here][0])
        x, exact = COLUMN[here] / APEX, found.variance[here]
        inside, reach = slice(1, -1), 1 - j / APEX
        for rows in (inside, slice(0, 1), slice(-1, None)):
            elements += [
                spec.Area(x[rows], low[band][rows], high[band][rows], c, 0.2),
                spec.Line(x[rows], exact[rows], c),
            ]
        elements += [
            spec.Points(x, found.simulated[here], c, size=2.6),
            spec.Line([-reach, reach], [printed, printed], "black", "--", width=0.8),
            spec.Words(reach, printed, f"$j={j}$", c, ("left", "center"), (3, -1)),
        ]
    lower = CUTS[2]
    own = (lower == LAYER) & ~LEG
    elements += [
        spec.Words(0, 5, "legs of the cone", "0.3"),
        spec.Line(name="exact first order"),
        spec.Line(name="Eq. (16), printed", colour="black", dashes="--"),
        spec.Points(name="simulated", size=2.6),
        spec.Area(name=f"{LEVEL:.0%} band of all", alpha=0.2),
        spec.Line(COLUMN[own] / APEX, found.one_contact[own], 2, ":", f"one contact, $j={lower}$"),
    ]
    return spec.Panel(
        elements,
        spec.Axis("horizontal position $i/l$", -1.08, 1.4),
        spec.Axis(VARIANCE, 0),
        legend="below",
        columns=5,
    )


def _double_y(found: tuple[Profile, ...], medium: Medium) -> spec.Panel:
    dashes, slope = ("-", (0, (5, 2)), (0, (1, 1.2))), float(medium.n_x) / medium.n_y
    return spec.Panel(
        [
            *(
                spec.Line(
                    np.repeat(one.edges, 2), np.pad(np.repeat(one.density, 2), 1), c, dashes[c],
                    one.name, 1.0,
                )
                for c, one in enumerate(found)
            ),
            spec.Rule("x", -slope, dashes=(0, (1, 1.5))),
            spec.Rule("x", slope, dashes=(0, (1, 1.5)), name="the packing's cone"),
        ],
        spec.Axis("horizontal position $x/H$", -3, 3),
        spec.Axis(r"mean response $H\,p(x)\,/\,f^{\rm load}$", 0),
        legend="upper center",
        legend_title="double Y",
    )  # fmt: skip
