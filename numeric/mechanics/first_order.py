"""The first-order theory by line sums (Eqs. 2–12): no quadratic, no nonlinear solver.

For any loads, with F the ordered forces and A the contact f⁺_ij itself, β^±_y = n^∓·δn^±_y,
a^+ = −φ β⁺/(1 − φ²), a^- = β⁻/(1 − φ²),

    g⁺_A = −F⁺_A a⁺_A + Σ_y [F⁻_y a⁻_y − F⁻_(y − e₋) a⁻_(y − e₋)],    y = x, x + e₊, x + 2e₊, …

with x the upper bead of the contact. Terms of F⁺ telescope for every load. β⁻ is a difference of
two line sums c⁺, so that radii on three neighbouring diagonals decide the sum. The mirror image
gives f⁻.
"""

from collections.abc import Mapping
from fractions import Fraction
from itertools import pairwise
from typing import Any, NamedTuple

from ..arithmetic.systems import NumberSystem
from ..lattice.branch import Branch, Contact, Site
from .loads import LoadSpec
from .local import cosine


def line_sum(rho: list[Any]) -> list[Any]:
    """Give c of every bead up a diagonal from its δr/r, base first: c = 0 at the base (Eq. 3).

    >>> line_sum([1, 10, 100])
    [0, 11, 121]
    """
    sums = [0 * rho[0]] if rho else []
    for below, here in pairwise(rho):
        sums.append(sums[-1] + below + here)
    return sums


def contact_change(
    contact: Contact,
    load: LoadSpec,
    rho: Mapping[Site, Any],
    n_x: Fraction,
    system: NumberSystem,
) -> tuple[Any, Any]:
    """Give F^±_ij and g^±_ij to first order, from δr/r of the beads of ``lines_read``."""
    i, j, branch = contact
    side, other, phi = branch.side, branch.other, cosine(n_x)
    over, cosine_ = system.number(1 / (1 - phi**2)), system.number(phi)
    strength = load.strength(n_x, system)
    radii = {
        name: [rho[site] for site in line.sites()]
        for name, line in lines_read(contact, load).items()
    }
    sums = {name: line_sum(along) for name, along in radii.items()}

    def ordered(at: int, m: int, orientation: Branch) -> Any:
        return load.ordered_force((at, m, orientation), strength, system)

    def beta(upper: str, m: int, lower: str, n: int) -> Any:
        both = radii[upper][m] + radii[lower][n]
        return (sums[upper][m] - sums[lower][n] - cosine_ * both) / 2

    above, below = crossing_layers(contact, load)
    total = system.number(Fraction(0))
    for m in above:
        total = total + ordered(i + side * (m - j), m, other) * beta("outer", m + 1, "main", m)
    for m in below:
        force = ordered(i + side * (m - j + 1), m - 1, other)
        total = total - force * beta("main", m, "inner", m - 1)
    own = ordered(i, j, branch)
    if load.carries(*contact):
        total = total + own * cosine_ * beta("upper", -1, "lower", -1)
    return own, total * over


def crossing_layers(contact: Contact, load: LoadSpec) -> tuple[list[int], list[int]]:
    """Say in which layers the beads straight up the contact have crossing contacts under force.

    Gives the layers m of the beads y whose contact of the other orientation *above* them carries an
    ordered force, and those where the one *below* them does.
    """
    i, j, branch = contact
    side, other = branch.side, branch.other
    if load.loaded is None:
        return list(range(j + 1, load.height)), list(range(j + 1, load.height + 1))
    top = max((site[1] for site in load.loaded), default=0)
    layers = range(j + 1, top + 1)
    return (
        [m for m in layers if load.carries(i + side * (m - j), m, other)],
        [m for m in layers if load.carries(i + side * (m - j + 1), m - 1, other)],
    )


class Line(NamedTuple):
    """Beads up a diagonal from (start, 0) to layer ``top``; i grows by ``step`` a layer."""

    start: int
    step: int
    top: int

    def at(self, m: int) -> int:
        """Give i in layer m."""
        return self.start + self.step * m

    def sites(self) -> list[Site]:
        """Give its beads, from the base up."""
        return [(self.at(m), m) for m in range(self.top + 1)]


def bead_lines(site: Site) -> tuple[Line, Line]:
    """Give the diagonals up to a bead whose sums are c⁺ and c⁻ (Eq. 3)."""
    i, j = site
    return Line(i - j, 1, j), Line(i + j, -1, j)


def lines_read(contact: Contact, load: LoadSpec) -> dict[str, Line]:
    """Give the diagonals that decide a contact: its own, its neighbours, and two that cross it."""
    i, j, branch = contact
    side = branch.side
    start = i - side * j
    above, below = crossing_layers(contact, load)
    lines = {}
    if above:
        lines["outer"] = Line(start - 2 * side, side, max(above) + 1)
    if above or below:
        lines["main"] = Line(start, side, max([*above, *below]))
    if below:
        lines["inner"] = Line(start + 2 * side, side, max(below) - 1)
    if load.carries(*contact):
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
