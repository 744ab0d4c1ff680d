"""Force chains: every contact of one packing, drawn as thick as its force.

The disorder is strong enough for the height to come near M* = (σ/r)^(-2/3), where contacts begin to
pull: those are drawn in a colour of their own. The packing is solved exactly, under a surface load.
"""

from fractions import Fraction

import numpy as np

from ..theory.expected import critical_height
from .beads import alike, bare, draw_base, draw_chains, draw_surface_load, extremes
from .packings import Made, Medium, Options, Table, planned, solve_first
from .style import PAGE, panels

HEIGHT, WIDTH = 24, 64
MEDIUM = Medium(std=5e-3)
SHOWN = 34  # beads of a layer that are drawn


def contacts(o: Options, medium: Medium) -> Table:
    """Solve one packing: lower bead (i, j), branch, both ends in units of r, f over its mean."""
    columns = solve_first(planned("contact_forces", o, medium, height=HEIGHT, width=WIDTH))
    names = {"x_low": "x", "y_low": "y", "x_high": "upper_x", "y_high": "upper_y"}
    return {
        **{name: columns[name] for name in ("i", "j", "branch")},
        **{name: columns[column] for name, column in names.items()},
        "force": columns["force"] / (columns["force"] - columns["change"]),
    }


def figure(o: Options) -> Made:
    """Contacts as lines, pressing ones dark, pulling ones vermillion."""
    o.notice("chains")
    medium = o.medium(MEDIUM)
    columns = contacts(o, medium)
    forces = columns["force"]
    ends = np.stack([columns[name] for name in ("x_low", "y_low", "x_high", "y_high")], axis=1)
    ends = ends.reshape(-1, 2, 2)
    right, top = float(medium.spacing) * SHOWN, float(ends[..., 1].max())
    surface = np.unique(ends[columns["j"] == HEIGHT - 1, 1], axis=0)
    f = r"$f=\langle f\rangle$"
    keys = [(1.0, f), (3.0, r"$f=3\langle f\rangle$"), (-1.0, r"pulling, $f=-\langle f\rangle$")]
    if alike(forces):
        keys = [(1.0, f), *extremes(forces, 1)]
    drawn, (axes,) = panels("a", PAGE, 2.75)
    draw_chains(axes, ends, forces, keys)
    draw_base(axes, 0, right)
    draw_surface_load(axes, surface[(surface[:, 0] > 0) & (surface[:, 0] < right)])
    bare(axes, 0, right, -1.5, top + 5)
    tensile, critical = int((forces < 0).sum()), critical_height(Fraction(medium.std))
    facts = {
        "height": HEIGHT,
        "width": WIDTH,
        "spacing_over_r": float(medium.spacing),
        "relative_std": medium.std,
        "critical_height": critical,
        "contacts": len(forces),
        "tensile": tensile,
        "largest_force": float(forces.max()),
        "smallest_force": float(forces.min()),
    }
    says = f"{tensile} of {len(forces)} contacts pull at M = {HEIGHT}, M* = {critical:.3g}"
    return Made(drawn, {"chains": columns}, facts, [says])
