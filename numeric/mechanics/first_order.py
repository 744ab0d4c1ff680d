"""The first-order theory by line sums (Eqs. 2–12): no quadratic, no nonlinear solver.

For any loads, with F the ordered forces and A the contact f⁺_ij itself, β^±_y = n^∓·δn^±_y,
a^+ = −φ β⁺/(1 − φ²), a^- = β⁻/(1 − φ²),

    g⁺_A = −F⁺_A a⁺_A + Σ_y [F⁻_y a⁻_y − F⁻_(y − e₋) a⁻_(y − e₋)],    y = x, x + e₊, x + 2e₊, …

with x the upper bead of the contact. Terms of F⁺ telescope for every load. β⁻ is a difference of
two line sums c⁺, so that radii on three neighbouring diagonals decide the sum. The mirror image
gives f⁻.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise
from typing import Any, NamedTuple

from ..arithmetic.systems import NumberSystem
from .loads import LoadSpec
from .local import cosine

RadiusAt = Callable[[int, int], Any]
"""δr/r of a site, already in the number system."""


def line_sum(rho: list[Any]) -> list[Any]:
    """Give c of every bead up a diagonal from its δr/r, base first: c = 0 at the base (Eq. 3).

    >>> line_sum([1, 10, 100])
    [0, 11, 121]
    """
    sums = [0 * rho[0]] if rho else []
    for below, here in pairwise(rho):
        sums.append(sums[-1] + below + here)
    return sums


@dataclass
class Diagonals:
    """The diagonals parallel to a contact, and its two cross diagonals, read bead by bead.

    A diagonal's offset is that of its i from the contact's own diagonal in the same layer. Each
    bead is read once; ``read`` counts them.
    """

    i: int
    j: int
    side: int  # +1 for f⁺, −1 for f⁻
    radius_at: RadiusAt
    known: dict[tuple[int, int], Any]

    def _rho(self, i: int, m: int) -> Any:
        if (i, m) not in self.known:
            self.known[i, m] = self.radius_at(i, m)
        return self.known[i, m]

    def along(self, offset: int, top: int) -> list[Any]:
        """δr/r up a diagonal parallel to the contact, layers 0 … top."""
        start = self.i - self.side * self.j + offset
        return [self._rho(start + self.side * m, m) for m in range(top + 1)]

    def across(self, i: int, top: int) -> list[Any]:
        """δr/r up the other diagonal through bead (i, top), layers 0 … top."""
        return [self._rho(i + self.side * (top - m), m) for m in range(top + 1)]


def contact_change(
    contact: tuple[int, int, str],
    *,
    own: Any,
    above: Mapping[int, Any],
    below: Mapping[int, Any],
    radius_at: RadiusAt,
    n_x: Fraction,
    system: NumberSystem,
) -> tuple[Any, int]:
    """Give g^±_ij to first order, and the number of beads read.

    ``own`` is the ordered force F^±_ij, or None where it is zero. ``above[m]`` (``below[m]``) is
    the ordered force, of the other orientation, in the contact above (below) the bead y of layer m
    that lies straight up the contact; layers that are absent have none.
    """
    i, j, branch = contact
    side = 1 if branch == "+" else -1
    phi = cosine(n_x)
    over = system.number(1 / (1 - phi**2))
    phi = system.number(phi)
    lines = Diagonals(i, j, side, radius_at, {})
    total = system.number(Fraction(0))
    if above:
        top = max(above)
        outer, main = lines.along(-2 * side, top + 1), lines.along(0, top)
        c_outer, c_main = line_sum(outer), line_sum(main)
        for layer, f in above.items():
            rho = outer[layer + 1] + main[layer]
            beta = (c_outer[layer + 1] - c_main[layer] - phi * rho) / 2
            total = total + f * beta * over
    if below:
        top = max(below)
        main, inner = lines.along(0, top), lines.along(2 * side, top - 1)
        c_main, c_inner = line_sum(main), line_sum(inner)
        for layer, f in below.items():
            rho = main[layer] + inner[layer - 1]
            beta = (c_main[layer] - c_inner[layer - 1] - phi * rho) / 2
            total = total - f * beta * over
    if own is not None:
        upper, lower = lines.across(i + side, j + 1), lines.across(i, j)
        rho = upper[-1] + lower[-1]
        beta = (line_sum(upper)[-1] - line_sum(lower)[-1] - phi * rho) / 2
        total = total + own * phi * beta * over
    return total, len(lines.known)


def crossing_layers(contact: tuple[int, int, str], load: LoadSpec) -> tuple[list[int], list[int]]:
    """Say in which layers the beads straight up the contact have crossing contacts under force.

    Gives the layers m of the beads y whose contact of the other orientation *above* them carries an
    ordered force, and those where the one *below* them does.
    """
    i, j, branch = contact
    side, other = (1, "-") if branch == "+" else (-1, "+")
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


def lines_read(contact: tuple[int, int, str], load: LoadSpec) -> list[Line]:
    """Give the diagonals that ``contact_change`` reads."""
    i, j, branch = contact
    side = 1 if branch == "+" else -1
    start = i - side * j
    above, below = crossing_layers(contact, load)
    lines = []
    if above:
        lines.append(Line(start - 2 * side, side, max(above) + 1))
    if above or below:
        lines.append(Line(start, side, max([*above, *below])))
    if below:
        lines.append(Line(start + 2 * side, side, max(below) - 1))
    if load.carries(*contact):
        lines.append(Line(i + side * (j + 2), -side, j + 1))
        lines.append(Line(i + side * j, -side, j))
    return lines


def beads_read(contact: tuple[int, int, str], load: LoadSpec) -> int:
    """Count the beads whose radii decide the first-order f^±_ij, for any load.

    The three parallel diagonals reach as high as force crosses them; the two cross diagonals matter
    where the contact itself carries an ordered force.
    """
    j = contact[1]
    above, below = crossing_layers(contact, load)
    outer = max(above) + 2 if above else 0
    main = max([*above, *below]) + 1 if above or below else 0
    inner = max(below) if below else 0
    if not load.carries(*contact):
        return outer + main + inner
    # x and the contact's lower bead lie on the main diagonal, two more beads on the inner one.
    shared = (2 if main else 0) + (min(j + 1, 2) if inner else 0)
    return outer + main + inner + 2 * j + 3 - shared


def contact_beads(j: int, height: int) -> int:
    """Count the beads on which the first-order f^±_ij depends (surface or bulk load).

    Three diagonals of M + 1, M + 1 and M beads, and what the two cross diagonals add.

    >>> contact_beads(0, 1), contact_beads(5, 64), contact_beads(63, 64)
    (3, 203, 254)
    """
    cross = j + max(j - 1, 0)
    parallel = 3 * height + 2 if j <= height - 2 else 2 * height + 1
    return parallel + cross
