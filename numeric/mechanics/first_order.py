"""The first-order theory by line sums (Eqs. 2–12): no quadratic, no nonlinear solver.

For any loads, with F the ordered forces and A the contact f⁺_ij itself, β^±_y = n^∓·δn^±_y,
a^+ = −φ β⁺/(1 − φ²), a^- = β⁻/(1 − φ²),

    g⁺_A = −F⁺_A a⁺_A + Σ_y [F⁻_y a⁻_y − F⁻_(y − e₋) a⁻_(y − e₋)],    y = x, x + e₊, x + 2e₊, …

with x the upper bead of the contact. Terms of F⁺ telescope for every load. β⁻ is a difference of
two line sums c⁺, so that radii on three neighbouring diagonals decide the sum. The mirror image
gives f⁻.
"""

from collections.abc import Callable
from fractions import Fraction
from typing import Any, NamedTuple

import numpy as np

from ..arithmetic.carried import accumulated
from ..arithmetic.systems import FLOAT64, NumberSystem
from ..lattice.branch import Contact
from ..lattice.layers import Rows
from .loads import LoadSpec, Strength
from .local import cosine


class Line(NamedTuple):
    """Beads up a diagonal from (start, 0) to layer ``top``; i grows by ``step`` a layer."""

    start: int
    step: int
    top: int

    @property
    def rows(self) -> Rows:
        """Its beads, one a row, from the base up."""
        layers = np.arange(self.top + 1)
        return Rows(self.start + self.step * layers, np.ones_like(layers))


def line_sum(rho: Any) -> Any:
    """Give c of every bead up a diagonal from its δr/r, base first: c = 0 at the base (Eq. 3).

    >>> line_sum(np.array([1, 10, 100]))
    array([  0,  11, 121])
    """
    c = 0 * rho
    c[1:] = accumulated(rho[np.arange(1, 2 * len(rho) - 1) // 2])[1::2]
    return c


def ordered_forces(
    contact: Contact, load: LoadSpec, strength: Strength, system: NumberSystem
) -> tuple[Any, Any, Any]:
    """Give the ordered forces that decide a contact: its own, and those of contacts that cross it.

    Its own is alone in an array, which is empty where the contact lies above every load. The
    others, of the other orientation, are those above the beads straight up the contact, from its
    upper one on, and those below these beads.
    """
    i, j, branch = contact
    side, other = branch.side, 1 - branch.number
    main, outer = (
        load.ordered(Line(i - side * (j + 2 * off), side, load.top).rows, strength, system)
        for off in (0, 1)
    )
    return main[branch.number, j : j + 1], outer[other, j + 1 :], main[other, j:]


LineRadii = Callable[[Line], Any]
"""Gives δr/r of the beads of a line."""


def contact_change(
    contact: Contact, load: LoadSpec, rho: LineRadii, n_x: Fraction, system: NumberSystem
) -> tuple[Any, Any]:
    """Give F^±_ij and g^±_ij to first order, from δr/r of the beads of ``lines_read``."""
    j, phi = contact.j, cosine(n_x)
    over, cosine_ = system.number(1 / (1 - phi**2)), system.number(phi)
    own, above, below = ordered_forces(contact, load, load.strength(n_x, system), system)
    zero, lines = system.number(Fraction(0)), lines_read(contact, load)
    radii = {name: rho(line) for name, line in lines.items()}
    c = {name: line_sum(values) for name, values in radii.items()}

    def change(forces: Any, upper: str, lower: str, layer: int) -> Any:
        """Add up F β of the beads of a line from ``layer`` on, β to the beads below in another."""
        if not {upper, lower} <= lines.keys():
            return zero
        count = min(lines[upper].top + 1, lines[lower].top + 2) - layer
        y, z = slice(layer, layer + count), slice(layer - 1, layer - 1 + count)
        both = radii[upper][y] + radii[lower][z]
        beta = (c[upper][y] - c[lower][z] - cosine_ * both) / 2
        return accumulated(forces[:count] * beta)[-1]

    crossing = change(above, "outer", "main", j + 2) - change(below, "main", "inner", j + 1)
    force = own[0] if "upper" in lines else zero
    return force, (crossing + cosine_ * change(own, "upper", "lower", j + 1)) * over


def lines_read(contact: Contact, load: LoadSpec) -> dict[str, Line]:
    """Give the diagonals that decide a contact: its own, its neighbours, and two that cross it."""
    i, j, branch = contact
    side = branch.side
    start = i - side * j
    own, *crossing = ordered_forces(contact, load, load.count, FLOAT64)
    above, below = (j + 1 + np.flatnonzero(part).max(initial=-j - 1) for part in crossing)
    lines = {}
    if above:
        lines["outer"] = Line(start - 2 * side, side, int(above) + 1)
    if above or below:
        lines["main"] = Line(start, side, int(max(above, below)))
    if below:
        lines["inner"] = Line(start + 2 * side, side, int(below) - 1)
    if own.any():
        lines["upper"] = Line(i + side * (j + 2), -side, j + 1)
        lines["lower"] = Line(i + side * j, -side, j)
    return lines


def beads_read(contact: Contact, load: LoadSpec) -> int:
    """Count the beads whose radii decide the first-order f^±_ij, for any load.

    The three parallel diagonals reach as high as force crosses them; the two cross diagonals matter
    where the contact itself carries an ordered force.
    """
    lines = lines_read(contact, load)
    beads = sum(line.top + 1 for line in lines.values())
    if "lower" in lines:
        # x and the contact's lower bead lie on the main diagonal, two more beads on the inner one.
        beads -= 2 * ("main" in lines) + min(contact[1] + 1, 2) * ("inner" in lines)
    return beads
