"""The reference: packings of discs or spheres from first principles, nothing linearised.

A bead is laid where it touches the d beads below it: d circles, or spheres, meet in a point. The d
forces below it balance its load and what comes in from above: d linear equations. Numbers are
mpmath's, with ``DIGITS`` digits. This shares nothing with the package.

A bead is named by its whole steps a = (a₁, …, a_d) along the d base vectors; it rests on the beads
a − e_c. Its layer is the sum of the steps; layer 0 is the base, which is held. The packing repeats:
W steps along one base vector and W back along the last lead to an image. In the plane the base
vectors are n⁺ and n⁻, and the paper's (i, j) is (a₁ − a₂, a₁ + a₂).
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from itertools import product
from operator import add, mul, sub
from typing import Any

from mpmath import MPContext

DIGITS = 100

mp = MPContext()  # of its own: nobody else changes its precision
mp.dps = DIGITS

Number = Any  # mpmath's numbers have no types
Vector = tuple[Number, ...]
Site = tuple[int, ...]
Contact = tuple[Site, int]
"""The bead below, and the base vector along which the one above lies."""


def dot(u: Sequence[Number], v: Sequence[Number]) -> Number:
    return sum(map(mul, u, v))


def plus(u: Vector, v: Vector) -> Vector:
    return tuple(map(add, u, v))


def minus(u: Vector, v: Vector) -> Vector:
    return tuple(map(sub, u, v))


def times(factor: Number, u: Vector) -> Vector:
    return tuple(factor * x for x in u)


def step(site: Site, c: int, by: int = 1) -> Site:
    return (*site[:c], site[c] + by, *site[c + 1 :])


def determinant(rows: Sequence[Vector]) -> Number:
    """By the first column, whose minors alternate in sign."""
    if len(rows) == 1:
        return rows[0][0]
    if len(rows) == 2:  # the usual case, spared the recursion
        (a, b), (c, d) = rows
        return a * d - b * c
    minors = (
        determinant([row[1:] for row in (*rows[:c], *rows[c + 1 :])]) for c in range(len(rows))
    )
    return sum(
        (-1) ** c * row[0] * minor for c, (row, minor) in enumerate(zip(rows, minors, strict=True))
    )


def solve(columns: Sequence[Vector], right: Vector) -> Vector:
    """x with Σ x_c column_c = right, by Cramer's rule."""
    whole = determinant(columns)
    return tuple(
        determinant([*columns[:c], right, *columns[c + 1 :]]) / whole for c in range(len(columns))
    )


def base_vectors(d: int, cosine: Number) -> tuple[Vector, ...]:
    """d unit vectors with one mutual cosine and the same rise; n⁺ and n⁻ for d = 2.

    Their horizontal parts are the corners of a regular simplex, made one dimension at a time.
    """
    corners: list[Vector] = [(mp.mpf(1),), (mp.mpf(-1),)]
    for k in range(2, d):
        # a new corner on top; the others move down, so that their cosines become −1/k
        down = mp.mpf(-1) / k
        corners = [(*times(mp.sqrt(1 - down**2), corner), down) for corner in corners]
        corners.append((*(mp.mpf(0),) * (k - 1), mp.mpf(1)))
    rise = mp.sqrt((1 + (d - 1) * cosine) / d)
    return tuple((*times(mp.sqrt(1 - rise**2), corner), rise) for corner in corners)


class FallsThroughError(ArithmeticError):
    """A bead is too small to rest on those below it."""


def upper_meeting_point(centres: Sequence[Vector], reaches: Sequence[Number]) -> Vector:
    """The upper of the two points that have these distances from d centres.

    Raises:
        FallsThroughError: there is none.
    """
    first, *others = centres
    edges = [minus(centre, first) for centre in others]
    d = len(centres)
    # at right angles to all edges: the vector product
    cut = [[(*edge[:c], *edge[c + 1 :]) for edge in edges] for c in range(d)]
    across = tuple((-1) ** c * determinant(rows) for c, rows in enumerate(cut))
    # |u|² = R², |u − e|² = R'²: u has a known component along each edge
    along = [
        (reaches[0] ** 2 + dot(edge, edge) - reach**2) / 2
        for edge, reach in zip(edges, reaches[1:], strict=True)
    ]
    rows = [*edges, across]
    foot = solve(list(zip(*rows, strict=True)), (*along, mp.mpf(0)))
    height_squared = reaches[0] ** 2 - dot(foot, foot)
    if height_squared < 0:
        raise FallsThroughError
    height = mp.sqrt(height_squared / dot(across, across))
    upwards = height if across[-1] > 0 else -height
    return plus(plus(first, foot), times(upwards, across))


@dataclass(frozen=True, eq=False)
class Packing:
    """A packing that repeats, of d dimensions.

    Attributes:
        cosine: φ, of each two base vectors.
        width: W; a layer has W^(d−1) beads.
        height: M, layers above the base.
        r: mean radius.
        change: δr by the beads of ``sites``; zero where none is given.
        d: dimensions.
    """

    cosine: Number
    width: int
    height: int
    r: Number = 1
    change: Mapping[Site, Number] = field(default_factory=dict)
    d: int = 2

    @cached_property
    def base(self) -> tuple[Vector, ...]:
        return base_vectors(self.d, self.cosine)

    def sites(self, layer: int) -> Iterator[Site]:
        """The beads of a layer, one of each and all of its images."""
        for steps in product(range(self.width), repeat=self.d - 1):
            yield (*steps, layer - sum(steps))

    def home(self, site: Site) -> Site:
        """Which of ``sites`` this is an image of."""
        steps = tuple(a % self.width for a in site[:-1])
        return (*steps, sum(site) - sum(steps))

    def radius(self, site: Site) -> Number:
        return self.r + self.change.get(self.home(site), 0)

    def ordered(self, steps: Site) -> Vector:
        """Where whole steps lead if all radii are r."""
        total = (mp.mpf(0),) * self.d
        for a, vector in zip(steps, self.base, strict=True):
            total = plus(total, times(2 * self.r * a, vector))
        return total

    def centre(self, site: Site) -> Vector:
        return self._image(self._centres, site)

    def _image(self, laid: Mapping[Site, Vector], site: Site) -> Vector:
        home = self.home(site)
        if home == site:
            return laid[site]
        return plus(laid[home], self.ordered(minus(site, home)))

    def _below(self, site: Site) -> list[Site]:
        return [step(site, c, -1) for c in range(self.d)]

    @cached_property
    def _disturbed(self) -> set[Site]:
        """Beads of another radius than r, and all that rest on such; others lie on the lattice."""
        disturbed = {self.home(site) for site, by in self.change.items() if by}
        for layer in range(1, self.height + 1):
            disturbed.update(
                site
                for site in self.sites(layer)
                if any(self.home(below) in disturbed for below in self._below(site))
            )
        return disturbed

    @cached_property
    def _centres(self) -> dict[Site, Vector]:
        positions = {site: self.ordered(site) for site in self.sites(0)}
        for layer in range(1, self.height + 1):
            for site in self.sites(layer):
                if site not in self._disturbed:
                    positions[site] = self.ordered(site)
                    continue
                below = self._below(site)
                centres = [self._image(positions, bead) for bead in below]
                reaches = [self.radius(site) + self.radius(bead) for bead in below]
                positions[site] = upper_meeting_point(centres, reaches)
        return positions

    def direction(self, contact: Contact) -> Vector:
        """The unit vector from the bead below to the one above."""
        lower, c = contact
        home = self.home(lower)
        if self.home(step(home, c)) not in self._disturbed:
            return self.base[c]
        if (home, c) not in self._directions:
            apart = minus(self.centre(step(home, c)), self.centre(home))
            self._directions[home, c] = times(1 / mp.sqrt(dot(apart, apart)), apart)
        return self._directions[home, c]

    @cached_property
    def _directions(self) -> dict[Contact, Vector]:
        return {}

    def forces(self, loads: Mapping[Site, Vector]) -> dict[Contact, Number]:
        """Contact forces, positive when compressive, under loads on beads of ``sites``.

        They are kept by the contact's home; a contact that carries nothing is left out.
        """
        forces: dict[Contact, Number] = {}
        carried = dict(loads)
        nothing = (mp.mpf(0),) * self.d
        for layer in range(self.height, 0, -1):
            for site in self.sites(layer):
                if site not in carried:
                    continue
                contacts = [(self.home(step(site, c, -1)), c) for c in range(self.d)]
                columns = [self.direction(contact) for contact in contacts]
                shares = solve(columns, times(-1, carried[site]))
                for contact, share, column in zip(contacts, shares, columns, strict=True):
                    forces[contact] = share
                    below = carried.get(contact[0], nothing)
                    carried[contact[0]] = minus(below, times(share, column))
        return forces

    def along(
        self, shares: Sequence[Number], weight: Number, sites: Iterable[Site]
    ) -> dict[Site, Vector]:
        """The same load on each of some beads: against each base vector a share of the weight."""
        load = (mp.mpf(0),) * self.d
        for share, vector in zip(shares, self.base, strict=True):
            load = minus(load, times(share * weight, vector))
        return dict.fromkeys(sites, load)

    def downwards(self, weight: Number, sites: Iterable[Site]) -> dict[Site, Vector]:
        """The same vertical load on each of some beads."""
        return {site: (*(mp.mpf(0),) * (self.d - 1), -weight) for site in sites}

    def surface_load(self, weight: Number) -> dict[Site, Vector]:
        """On all beads of the top layer."""
        return self.downwards(weight, self.sites(self.height))

    def bulk_load(self, weight: Number) -> dict[Site, Vector]:
        """On all beads above the base."""
        layers = range(1, self.height + 1)
        return self.downwards(weight, (site for layer in layers for site in self.sites(layer)))
