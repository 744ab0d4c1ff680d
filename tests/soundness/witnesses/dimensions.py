"""Packings of spheres, solved exactly, against the first-order weights of any dimension."""

from collections import defaultdict
from collections.abc import Iterator, Mapping
from fractions import Fraction
from functools import cache
from itertools import product
from typing import Any

import mpmath
from force_diffusion.numeric.arithmetic.systems import zeros
from force_diffusion.numeric.lattice.branch import PerAxis
from force_diffusion.numeric.lattice.layers import whole
from force_diffusion.numeric.mechanics.sweep import deposit, sweep_down

from tests.numeric.mechanics.any_dimension import (
    Bead,
    force_weights,
    reciprocal,
    squared,
    stepped,
    together,
)
from tests.numeric.mechanics.taylor import Series

from .draws import SmallPacking

DIGITS, STRENGTH = 50, mpmath.mpf(10) ** -20


@cache
def spheres(phi: Fraction, height: int, layer: int) -> tuple[tuple[Bead, Any], ...]:
    """Weights of the same force in three dimensions, by enlarging one sphere after the other.

    Spheres are placed by Newton's method on the three contact conditions, and forces follow from
    the balance of each sphere; a weight is the central difference at strength 1e-20, 50 digits.
    """
    with mpmath.workdps(DIGITS):
        parts = force_weights(3, height, layer, phi)
        beads = [bead for bead, weight in together(parts).items() if weight]
        found = []
        for bead in beads:
            plus, minus = (_force({bead: sign * STRENGTH}, phi, height, layer) for sign in (1, -1))
            found.append((bead, (plus - minus) / (2 * STRENGTH)))
        return tuple(found)


def _force(deviation: Mapping[Bead, Any], phi: Fraction, height: int, layer: int) -> Any:
    """The force of the contact, the ordered one being 1."""
    cosine = mpmath.mpf(phi.numerator) / phi.denominator
    gram = mpmath.matrix(3, 3)
    for a, c in product(range(3), repeat=2):
        gram[a, c] = 1 if a == c else cosine
    columns = mpmath.cholesky(gram)  # its rows are three unit vectors with these dot products
    base = [columns[a, :].T for a in range(3)]
    placed: dict[Bead, Any] = {}

    def radius(bead: Bead) -> Any:
        return 1 + deviation.get(bead, mpmath.mpf(0))

    def place(bead: Bead) -> Any:
        if bead not in placed:
            here = 2 * sum((base[a] * bead[a] for a in range(3)), mpmath.matrix(3, 1))
            if sum(bead):
                here = _rest(here, bead)
            placed[bead] = here
        return placed[bead]

    def _rest(here: Any, bead: Bead) -> Any:
        supports = [stepped(bead, a, -1) for a in range(3)]
        for _ in range(4):  # quadratic: 1e-20, 1e-40, done
            apart = [here - place(support) for support in supports]
            jacobian, wrong = mpmath.matrix(3, 3), mpmath.matrix(3, 1)
            for a, support in enumerate(supports):
                jacobian[a, :] = 2 * apart[a].T
                reach = radius(bead) + radius(support)
                wrong[a] = (apart[a].T * apart[a])[0] - reach**2
            here = here - mpmath.lu_solve(jacobian, wrong)
        return here

    def unit(bead: Bead, axis: int) -> Any:
        upper = stepped(bead, axis)
        return (place(upper) - place(bead)) / (radius(upper) + radius(bead))

    load = sum(base, mpmath.matrix(3, 1))
    below: dict[Bead, Any] = {}

    def lower(bead: Bead) -> Any:
        """Forces of the three contacts below a bead."""
        if bead not in below:
            carried = load.copy()
            if sum(bead) < height:
                carried = mpmath.matrix(3, 1)
                for a in range(3):
                    carried += unit(bead, a) * lower(stepped(bead, a))[a]
            matrix = mpmath.matrix(3, 3)
            for a in range(3):
                matrix[:, a] = unit(stepped(bead, a, -1), a)
            below[bead] = mpmath.lu_solve(matrix, carried)
        return below[bead]

    return lower((layer + 1, 0, 0))[0]


def remainders(phi: Fraction, height: int, layer: int) -> Iterator[tuple[Bead, Any]]:
    """How far the weights of spheres are from the fractions."""
    exact = together(force_weights(3, height, layer, phi))
    with mpmath.workdps(DIGITS):
        for bead, weight in spheres(phi, height, layer):
            stated = mpmath.mpf(exact[bead].numerator) / exact[bead].denominator
            yield bead, abs(weight - stated)


def cosine_of(packing: SmallPacking) -> Fraction:
    """φ of the drawn directions, or 1/5 where spheres would overlap."""
    cosine = packing.n[1] ** 2 - packing.n[0] ** 2
    return cosine if Fraction(-1, 3) < cosine < Fraction(1, 2) else Fraction(1, 5)


@cache
def squares_of_spheres(
    phi: Fraction, height: int, load: str, ratios: tuple[Fraction, ...] = (Fraction(1),) * 2
) -> tuple[Fraction, ...]:
    """Sum of the squared Taylor coefficients of f/⟨f⟩ for each layer, exact; along vector 1.

    ``ratios`` are those of the load's components along the other vectors to that along this one.

    One sphere of each layer in turn has the radius r + ε; its effect on all contacts of a layer is,
    by translation, that of all spheres on one.
    """
    system, width = Series(1), height + 2  # wide enough to see no image, to first order
    found = [Fraction(0)] * height
    with system.active():
        region = whole(width**2, height, dimension=3)
        on = [
            tuple(
                zeros(system, width**2) + system.number(share)
                if load == "bulk" or j == height
                else None
                for j in range(height + 1)
            )
            for share in (Fraction(1), *ratios)
        ]
        for source in range(height + 1):
            rho = [zeros(system, width**2) for _ in range(height + 1)]
            rho[source][0] = system.series([Fraction(0), Fraction(1)])
            packing = deposit(phi, region, rho, system)
            forces = sweep_down(packing, region.rows, PerAxis(*on))
            for j in range(height):
                ordered = (height - j) if load == "bulk" else 1
                for change in forces.change.plus[j + 1]:
                    slope = Fraction(int(change[1].p), int(change[1].q)) / ordered
                    found[j] += slope**2
    return tuple(found)


def response_weights(
    dimension: int, level: int, phi: Fraction, steps: Bead, axis: int, *, vertical: bool = False
) -> dict[Bead, Fraction]:
    """Weights in δr of one contact's force below a point load, r = 1, over the ordered legs' force.

    Beads are named by their steps down from the loaded one, in layer ``level``. The contact leads
    up along ``axis`` from the bead ``steps``. To first order what enters a bead leaves it along the
    same vector, but where the ordered force of a leg turns with its contacts. ``vertical``: the
    vertical component, over that of the ordered legs.
    """
    own, cross = reciprocal(dimension, phi)
    total: dict[Bead, Fraction] = defaultdict(Fraction)

    def carries(bead: Bead, along: int) -> bool:
        return 0 < sum(bead) == bead[along]

    def line_sum(bead: Bead, along: int, factor: Fraction) -> None:
        layer = level - sum(bead)
        for below in range(layer + 1 if layer else 0):
            total[stepped(bead, along, below)] += factor * (1 if below in (0, layer) else 2)

    def turn(bead: Bead, up: int, shares: Mapping[int, Fraction]) -> None:
        upper = stepped(bead, up, -1)
        for along in set(range(dimension)) - {up}:
            line_sum(upper, along, shares[along] / 2)
            line_sum(bead, along, -shares[along] / 2)
            for end in (bead, upper):
                total[end] -= phi * shares[along] / 2

    def products(sign: int) -> dict[int, Fraction]:
        return {along: sign * (own if along == axis else cross) for along in range(dimension)}

    bead = stepped(steps, axis, -1)
    while min(bead) >= 0:
        for c in range(dimension):
            for contact, sign in ((bead, 1), (stepped(bead, c), -1)):
                if carries(contact, c):
                    turn(contact, c, products(sign))
        bead = stepped(bead, axis, -1)
    if vertical and carries(steps, axis):
        turn(steps, axis, dict.fromkeys(range(dimension), 1 / (1 + (dimension - 1) * phi)))
    return dict(total)


@cache
def response_variance(
    level: int, phi: Fraction, contacts: tuple[tuple[Bead, int], ...], *, vertical: bool = False
) -> Fraction:
    """Sum of the squared weights of several contacts' forces together, in three dimensions."""
    total: dict[Bead, Fraction] = defaultdict(Fraction)
    for steps, axis in contacts:
        for bead, w in response_weights(3, level, phi, steps, axis, vertical=vertical).items():
            total[bead] += w
    return squared(total)


def response_of_spheres(
    phi: Fraction, level: int, rho: Mapping[Bead, Fraction]
) -> dict[tuple[Bead, int], Fraction]:
    """Order ε¹ of every contact's force in an exact packing of spheres with one load.

    Radii are 1 + ερ, by steps down from the loaded bead; the packing is periodic, so wide that no
    contact in reach of the load sees an image.
    """
    system, width = Series(1), level + 2
    with system.active():
        region = whole(width**2, level, dimension=3)
        layers = [zeros(system, width**2) for _ in range(level + 1)]
        for bead, value in rho.items():
            place = -bead[0] % width * width + -bead[1] % width
            layers[level - sum(bead)][place] = system.series([Fraction(0), value])
        loaded = zeros(system, width**2)
        loaded[0] = system.number(Fraction(1))
        on = (None,) * level + (loaded,)
        packing = deposit(phi, region, layers, system)
        change = [rows for _, rows in sweep_down(packing, region.rows, PerAxis(on, on, on)).change]
        found = {}
        for steps, axis in product(product(range(level + 1), repeat=3), range(3)):
            x, y, _ = upper = stepped(steps, axis, -1)
            if 0 < sum(steps) <= level:
                force = change[axis][level - sum(upper)][-x % width * width + -y % width]
                found[steps, axis] = Fraction(int(force[1].p), int(force[1].q))
    return found
