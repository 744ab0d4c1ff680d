"""Force chains: every contact of one packing, as thick as its force is large.

The disorder is strong enough for the height to come near M* = (σ/r)^(-2/3), where contacts begin to
pull: those are drawn in a colour of their own. The packing is solved exactly, under a surface load.
"""

from fractions import Fraction
from typing import Any

import numpy as np

from ..mechanics.physicality import Physicality
from ..theory.expected import critical_height
from . import specification as spec
from .elements import base, surface_load
from .packings import Medium, Options, centres, forces_of, planned, solved

HEIGHT, WIDTH = 24, 64
MEDIUM = Medium(std=5e-3)
SHOWN = 34  # beads of a layer that are drawn


def contacts(o: Options, medium: Medium) -> tuple[spec.Table, float | None]:
    """Solve one packing: lower bead (i, j), branch, both ends in units of r, f over its mean.

    Gives the smallest gap between beads, too.
    """
    plan = planned(
        "contact_forces", height=HEIGHT, width=WIDTH, seed=o.seed, std=medium.std,
        spacing=medium.spacing,
    )  # fmt: skip
    answer = next(solved(plan, range(1)))[0]
    forces, packing = forces_of(answer), answer.packing
    assert packing is not None
    physical = Physicality()
    physical.look_at_gaps(packing)
    period = float(medium.spacing * WIDTH)
    rows: list[tuple[Any, ...]] = []
    for j in range(1, HEIGHT + 1):
        upper, lower = centres(packing, j)[2:], centres(packing, j - 1)[2:]
        sites, below = packing.region.rows[j].sites(), packing.region.rows[j - 1].sites()
        for branch, F, g in forces.below(j):
            for q, i in enumerate(sites):
                own = (i - branch.side) % (2 * WIDTH)
                k = below.index(own)
                x, y, x_high = float(lower[0][k]), float(lower[1][k]), float(upper[0][q])
                x += period * round((x_high - x) / period)
                force = float((F[q] + g[q]) / F[q])
                rows.append((own, j - 1, branch, x, y, x_high, float(upper[1][q]), force))
    names = "i j branch x_low y_low x_high y_high force"
    return spec.table(names, rows), physical.smallest_gap


def figure(o: Options) -> spec.Figure:
    """Contacts as lines, pressing ones dark, pulling ones vermillion."""
    o.notice("chains")
    medium = o.medium(MEDIUM)
    found, smallest_gap = contacts(o, medium)
    forces = np.array(found["force"])
    ends = np.array([found[name] for name in ("x_low", "y_low", "x_high", "y_high")])
    ends = ends.T.reshape(-1, 2, 2)
    right, top = float(medium.spacing) * SHOWN, float(ends[..., 1].max())
    surface = np.unique(ends[np.array(found["j"]) == HEIGHT - 1, 1], axis=0)
    loaded = surface[(surface[:, 0] > 0) & (surface[:, 0] < right)]
    f = r"$f=\langle f\rangle$"
    keys = [(1.0, f), (3.0, r"$f=3\langle f\rangle$"), (-1.0, r"pulling, $f=-\langle f\rangle$")]
    if spec.alike(forces):
        keys = [(1.0, f)]
        for name, force in (("smallest", forces.min()), ("largest", forces.max())):
            keys.append((float(force), rf"{name}, ${100 * (force - 1):+.2g}\%$"))
    panel = spec.Panel(
        [spec.Chains(ends, forces, keys), base(0, right), *surface_load(loaded)],
        spec.Axis(low=0, high=right),
        spec.Axis(low=-1.5, high=top + 5),
        legend="below",
        columns=3,
        scaled=True,
        bare=True,
    )
    tensile, critical = int((forces < 0).sum()), critical_height(Fraction(medium.std))
    return spec.Figure(
        spec.Picture([panel], 2.75, page=True),
        tables={"chains": found},
        facts={
            "height": HEIGHT,
            "width": WIDTH,
            "spacing_over_r": float(medium.spacing),
            "relative_std": medium.std,
            "critical_height": critical,
            "contacts": len(forces),
            "tensile": tensile,
            "largest_force": float(forces.max()),
            "smallest_force": float(forces.min()),
            "smallest_gap": smallest_gap,
        },
        words=[f"{tensile} of {len(forces)} contacts pull at M = {HEIGHT}, M* = {critical:.3g}"],
    )
