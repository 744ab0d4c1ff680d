"""Explicit packings to second order in one radius at a time, and the means that follow.

The coefficient of ε² is a quadratic form in the radii; in the mean only its diagonal is left. Under
loads that are alike along a layer one bead of each layer is enlarged, and what all sites of a layer
feel of it is added up: by translation, what one site feels of all beads. Below one load each bead
that counts is enlarged in turn.
"""

from dataclasses import dataclass, field
from fractions import Fraction
from functools import lru_cache

from .dual import NOWHERE, ZERO, Dual, TooLargeError, Vector
from .packing import Given, Site

HIGHEST = 6
Series = tuple[Fraction, Fraction, Fraction]
"""Coefficients of 1, ε and ε²."""
Pair = tuple[Series, Series]
_NOTHING: Series = (Fraction(0),) * 3


def _plus(u: Series, v: Series, scale: int = 1) -> Series:
    return u[0] + scale * v[0], u[1] + scale * v[1], u[2] + scale * v[2]


def _times(u: Series, v: Series) -> Series:
    return (
        u[0] * v[0],
        u[0] * v[1] + u[1] * v[0],
        u[0] * v[2] + u[1] * v[1] + u[2] * v[0],
    )


def _inverse(u: Series) -> Series:
    first = -u[1] / u[0]
    return 1 / u[0], first / u[0], (first**2 - u[2] / u[0]) / u[0]


def _cross(u: Pair, v: Pair) -> Series:
    return _plus(_times(u[0], v[1]), _times(u[1], v[0]), -1)


def _apart(u: Pair, v: Pair) -> Pair:
    return _plus(u[0], v[0], -1), _plus(u[1], v[1], -1)


@dataclass
class Enlarged:
    """A packing in which one bead has the radius r + ε."""

    n: tuple[Fraction, Fraction]
    radius: Fraction
    source: Site
    given: Given
    _places: dict[Site, Pair] = field(default_factory=dict)
    _below: dict[Site, tuple[Series, Series]] = field(default_factory=dict)

    def _radii(self, one: Site, other: Site) -> Series:
        grown = Fraction((one == self.source) + (other == self.source))
        return 2 * self.radius, grown, Fraction(0)

    def place(self, site: Site) -> Pair:
        """Centre of a bead: at both contacts below it the distance is the sum of the radii."""
        if site not in self._places:
            across, layer = site
            x, y = (2 * self.radius * c * one for c, one in zip(self.n, site, strict=True))
            here: Pair = (x, *_NOTHING[1:]), (y, *_NOTHING[1:])
            from_source = layer - self.source[1]
            if layer > 0 and from_source >= abs(across - self.source[0]):
                supports = [(across + side, layer - 1) for side in (-1, 1)]
                for _ in range(2):  # one order each
                    here = self._step(here, site, supports)
            self._places[site] = here
        return self._places[site]

    def _step(self, here: Pair, site: Site, supports: list[Site]) -> Pair:
        rows = []
        for support in supports:
            u, v = _apart(here, self.place(support))
            reach = self._radii(site, support)
            square = _plus(_times(u, u), _times(v, v))
            rows.append((2 * u[0], 2 * v[0], _plus(_times(reach, reach), square, -1)))
        (a, b, left), (c, d, right) = rows
        whole = a * d - b * c
        x, y = here
        return (
            _plus(x, tuple((p * d - b * q) / whole for p, q in zip(left, right, strict=True))),  # type: ignore[arg-type]
            _plus(y, tuple((a * q - p * c) / whole for p, q in zip(left, right, strict=True))),  # type: ignore[arg-type]
        )

    def unit(self, branch: int, site: Site) -> Pair:
        """Unit vector to the bead above."""
        above = (site[0] + branch, site[1] + 1)
        over = _inverse(self._radii(site, above))
        x, y = _apart(self.place(above), self.place(site))
        return _times(x, over), _times(y, over)

    def force(self, branch: int, site: Site) -> Series:
        """Force of the contact above a bead."""
        if site[1] >= self.given.top:
            force = self.given.force("+" if branch == 1 else "-", *site)
            if force.value or force.slope:
                raise TooLargeError("what comes from above may fluctuate")
            return _NOTHING
        above = (site[0] + branch, site[1] + 1)
        return self._supports(above)[0 if branch == 1 else 1]

    def push(self, branch: int, site: Site) -> Series:
        """Its vertical component."""
        force = self.force(branch, site)
        return _times(force, self.unit(branch, site)[1]) if any(force) else _NOTHING

    def _supports(self, site: Site) -> tuple[Series, Series]:
        """Forces f⁺ and f⁻ below a bead that balance what it carries."""
        if site not in self._below:
            load = self.given.load(*site)
            if load.x.slope or load.y.slope:
                raise TooLargeError("the loads fluctuate")
            carried: Pair = tuple(  # type: ignore[assignment]
                (-Fraction(part.value), Fraction(0), Fraction(0)) for part in (load.x, load.y)
            )
            for branch in (1, -1):
                force = self.force(branch, site)
                if any(force):
                    unit = self.unit(branch, site)
                    carried = tuple(  # type: ignore[assignment]
                        _plus(one, _times(force, part))
                        for one, part in zip(carried, unit, strict=True)
                    )
            if not any(map(any, carried)):
                self._below[site] = _NOTHING, _NOTHING
                return self._below[site]
            plus = self.unit(1, (site[0] - 1, site[1] - 1))
            minus = self.unit(-1, (site[0] + 1, site[1] - 1))
            over = _inverse(_cross(plus, minus))
            self._below[site] = (
                _times(_cross(carried, minus), over),
                _times(_cross(plus, carried), over),
            )
        return self._below[site]


@lru_cache(maxsize=64)
def _enlarged(
    n: tuple[Fraction, Fraction], radius: Fraction, source: int, given: Given
) -> Enlarged:
    return Enlarged(n, radius, (source % 2, source), given)


@lru_cache(maxsize=1024)
def forces(
    n: tuple[Fraction, Fraction], radius: Fraction, given: Given, branch: int, site: Site,
    vertical: bool = False,
) -> Fraction:  # fmt: skip
    """Σ over all beads of the coefficient of ε² of a contact's force, or vertical component.

    Raises:
        TooLargeError: the packing is too high, or what it bears may fluctuate.
    """
    height, layer = given.surface, site[1]
    if given.top > HIGHEST:
        raise TooLargeError("it is too high")
    if height is None:
        if given.place is None:
            raise TooLargeError("it is no packing with a surface, nor below one load")
        at = (site[0] - given.place[0] + given.top, layer)
        load = given.load(*given.place)
        below = _below(n, radius, given.top, (Fraction(load.x.value), Fraction(load.y.value)))
        return sum((_of(one, branch, at, vertical)[2] for one in below), Fraction(0))
    for one in range(height + 1):
        load = given.load(one % 2, one)
        if load != given.load(one % 2 + 2, one) or load.x.slope or load.y.slope:
            raise TooLargeError("the loads differ along a layer, or fluctuate")
    total = Fraction(0)
    for source in range(height + 1):
        packing = _enlarged(n, radius, source, given)
        wide = 2 * height + 2
        for across in range(-wide, wide + 1):
            if (across + layer) % 2 == 0:
                total += _of(packing, branch, (across, layer), vertical)[2]
    return total


def _of(packing: Enlarged, branch: int, site: Site, vertical: bool) -> Series:
    return packing.push(branch, site) if vertical else packing.force(branch, site)


@lru_cache(maxsize=64)
def _below(
    n: tuple[Fraction, Fraction], radius: Fraction, top: int, load: tuple[Fraction, Fraction]
) -> tuple[Enlarged, ...]:
    """Packings below a load on bead (top, top), each with one bead enlarged that forces feel."""
    here, carried = (top, top), Vector(*map(Dual, load))
    given = Given(top, lambda *_: ZERO, lambda *at: carried if at == here else NOWHERE, place=here)
    sources = (
        (top + apart, layer)
        for layer in range(top + 1)
        for apart in range(layer - top - 1, top - layer + 2)
        if (top + apart + layer) % 2 == 0
    )
    return tuple(Enlarged(n, radius, source, given) for source in sources)


@lru_cache(maxsize=64)
def displacement(
    n: tuple[Fraction, Fraction], radius: Fraction, given: Given, layer: int
) -> tuple[Fraction, Fraction]:
    """The same of a bead's displacement."""
    if layer > HIGHEST:
        raise TooLargeError("it is too high")
    x, y = Fraction(0), Fraction(0)
    for source in range(layer + 1):
        packing = _enlarged(n, radius, source, given)
        for across in range(-layer - 2, layer + 3):
            if (across + layer) % 2 == 0:
                here = packing.place((across, layer))
                x, y = x + here[0][2], y + here[1][2]
    return x, y
