"""Force chains: every contact of one packing, as thick as its force is large.

The disorder is strong enough for the height to come near M* = (σ/r)^(-2/3), where contacts begin to
pull: those are drawn in a colour of their own. The packing is solved exactly, under a surface load.
"""

from dataclasses import dataclass
from fractions import Fraction
from typing import TYPE_CHECKING, Any

import numpy as np

from ..mechanics.physicality import Physicality
from ..theory.critical_height import critical_height
from .packings import (
    Medium,
    Notice,
    Row,
    centres,
    forces_of,
    planned,
    solved,
)

if TYPE_CHECKING:
    from matplotlib.figure import Figure

HEIGHT, WIDTH = 24, 64
MEDIUM = Medium(std=5e-3)
SHOWN = 34  # beads of a layer that are drawn


@dataclass(frozen=True)
class Chains:
    """Contacts: lower bead (i, j), branch, both ends in units of r, f over the mean force."""

    contacts: tuple[Row, ...]
    medium: Medium
    smallest_gap: float | None

    def tables(self) -> dict[str, list[Row]]:
        """CSV files."""
        return {"chains": list(self.contacts)}

    def facts(self) -> dict[str, Any]:
        """How many contacts pull."""
        forces = [row["force"] for row in self.contacts]
        return {
            "height": HEIGHT,
            "width": WIDTH,
            "spacing_over_r": float(self.medium.spacing),
            "relative_std": self.medium.std,
            "critical_height": critical_height(Fraction(self.medium.std)),
            "contacts": len(forces),
            "tensile": sum(f < 0 for f in forces),
            "largest_force": max(forces),
            "smallest_force": min(forces),
            "smallest_gap": self.smallest_gap,
        }

    def lines(self) -> list[str]:
        """Say how many contacts pull."""
        facts = self.facts()
        return [
            f"{facts['tensile']} of {facts['contacts']} contacts pull at M = {HEIGHT}, "
            f"M* = {facts['critical_height']:.3g}"
        ]


def contacts(seed: int, notice: Notice, medium: Medium = MEDIUM) -> Chains:
    """Solve one packing."""
    notice("chains")
    plan = planned(
        "contact_forces", height=HEIGHT, width=WIDTH, seed=seed, std=medium.std,
        spacing=medium.spacing,
    )  # fmt: skip
    answer = next(solved(plan, range(1)))[0]
    forces, packing = forces_of(answer), answer.packing
    assert packing is not None
    physical = Physicality()
    physical.look_at_gaps(packing)
    period = float(medium.spacing * WIDTH)
    found: list[Row] = []
    for j in range(1, HEIGHT + 1):
        upper, lower = centres(packing, j)[2:], centres(packing, j - 1)[2:]
        sites, below = packing.region.rows[j].sites(), packing.region.rows[j - 1].sites()
        for branch, F, g in forces.below(j):
            for q, i in enumerate(sites):
                k = below.index((i - branch.side) % (2 * WIDTH))
                x = float(lower[0][k])
                x += period * round((float(upper[0][q]) - x) / period)
                found.append(
                    {
                        "i": (i - branch.side) % (2 * WIDTH),
                        "j": j - 1,
                        "branch": branch,
                        "x_low": x,
                        "y_low": float(lower[1][k]),
                        "x_high": float(upper[0][q]),
                        "y_high": float(upper[1][q]),
                        "force": float((F[q] + g[q]) / F[q]),
                    }
                )
    return Chains(tuple(found), medium, physical.smallest_gap)


def draw(data: Chains) -> "Figure":
    """Draw contacts as lines, pressing ones dark, pulling ones vermillion; widths in proportion."""
    from . import parts, style

    figure = style.figure(style.PAGE, 2.75)
    axes = figure.subplots()
    forces = np.array([row["force"] for row in data.contacts])
    ends = np.array([[(r["x_low"], r["y_low"]), (r["x_high"], r["y_high"])] for r in data.contacts])
    parts.force_chains(axes, ends, forces)
    right, top = float(data.medium.spacing) * SHOWN, ends[..., 1].max()
    parts.surface_load(axes, 0, right, top)
    axes.set_xlim(0, right)
    axes.set_ylim(-1.5, top + 5)
    axes.set_aspect("equal")
    axes.axis("off")
    shown = [
        (1.0, r"$f=\langle f\rangle$"),
        (3.0, r"$f=3\langle f\rangle$"),
        (-1.0, r"pulling, $f=-\langle f\rangle$"),
    ]
    handles = parts.chain_keys(forces, shown)
    figure.legend(handles=handles, loc="outside lower center", ncols=3)
    return figure
