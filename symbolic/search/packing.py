"""Explicit packings to first order, as wide as one looks, from first principles.

A bead rests on two others: its position is the ordered one and the step of Newton's method from
there, which over dual numbers is exact. Forces are balanced bead by bead from the top down. What
a loading leaves open, loads and forces from above alike, is drawn, so that nothing coincides.
"""

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import cache

from .dual import (
    NOWHERE,
    ZERO,
    Dual,
    TooLargeError,
    Vector,
)

Site = tuple[int, int]
Branch = str
"""\"+\" for the contact from a bead to the one up to its right, "-" up to its left."""

HIGHEST = 48
"""The highest layer whose positions are computed, and most layers that a force is followed."""

_DIAGONALS, _LAYERS = 67, 31  # sites that are told apart by their radii


MIRRORED = ", mirrored"
"""How the name of a loading ends that is the mirror image of another."""


class AbsentError(ValueError):
    """No such bead or contact is in the packing."""


class BelowError(AbsentError):
    """It is on the lattice, and below the base."""


class UnknownLoadingError(ValueError):
    """No packing is known for a loading of this name."""


@cache
def _primes() -> tuple[int, ...]:
    end = 60_000
    sieve = bytearray([1]) * end
    for number in range(2, int(end**0.5) + 1):
        if sieve[number]:
            sieve[number * number :: number] = bytes(len(range(number * number, end, number)))
    return tuple(number for number in range(11, end) if sieve[number])


def drawn(across: int, layer: int, what: int = 0) -> Fraction:
    """A fraction of a site, another one for each: primes over primes, so that sums don't cancel.

    ``what`` tells quantities of one site apart.
    """
    place = layer % _LAYERS * _DIAGONALS + (across - layer) // 2 % _DIAGONALS
    numbers, size = _primes(), _LAYERS * _DIAGONALS
    sign = -1 if place % 4 in (1, 2) and not what else 1
    return Fraction(
        sign * numbers[(place * 5 + what * 17) % size + size], numbers[place + what + size]
    )


@dataclass(frozen=True)
class Geometry:
    """Beads on a fixed base, of radius r + ε δr.

    Attributes:
        n: (n_x, n_y) of the ordered contacts, rational.
        radius: r.
    """

    n: tuple[Fraction, Fraction]
    radius: Fraction
    _positions: dict[Site, Vector] = field(default_factory=dict, repr=False, compare=False)
    _directions: dict[tuple[Branch, int, int], Vector] = field(
        default_factory=dict, repr=False, compare=False
    )

    def radius_of(self, across: int, layer: int) -> Dual:
        """Radius of a bead."""
        return Dual(self.radius, drawn(across, layer))

    def ordered(self, across: int, layer: int) -> Vector:
        """Position of a bead of the ordered packing: touching ones are 2r apart along n^±."""
        x, y = self.n
        return Vector(Dual(2 * self.radius * x * across), Dual(2 * self.radius * y * layer))

    def position(self, across: int, layer: int) -> Vector:
        """Position of a bead: at each contact the distance is the sum of the radii."""
        found = self._positions.get((across, layer))
        if found is None:
            found = self._positions[across, layer] = self._rest(across, layer)
        return found

    def _rest(self, across: int, layer: int) -> Vector:
        start = self.ordered(across, layer)
        if layer <= 0:
            return start
        if layer > HIGHEST:
            raise TooLargeError(f"layer {layer} is higher than {HIGHEST}")
        own, rows = self.radius_of(across, layer), []
        for side in (-1, 1):
            apart = start - self.position(across + side, layer - 1)
            length = own + self.radius_of(across + side, layer - 1)
            gap = length * length - apart.dot(apart)
            if gap.value:
                raise AssertionError("ordered beads touch")
            # 2 apart·step = gap; the gap has no order 0, so that of apart alone counts
            rows.append((2 * apart.x.value, 2 * apart.y.value, gap.slope))
        (a, b, left), (c, d, right) = rows
        determinant = Fraction(a * d - b * c)
        step = (left * d - b * right) / determinant, (a * right - left * c) / determinant
        return start + Vector(Dual(0, step[0]), Dual(0, step[1]))

    def direction(self, branch: Branch, across: int, layer: int) -> Vector:
        """Unit vector from a bead to the one above it: their separation over their radii."""
        found = self._directions.get((branch, across, layer))
        if found is None:
            above = (across + (1 if branch == "+" else -1), layer + 1)
            apart = self.position(*above) - self.position(across, layer)
            length = self.radius_of(across, layer) + self.radius_of(*above)
            found = self._directions[branch, across, layer] = apart.times(length.inverse())
        return found


@dataclass(frozen=True)
class Given:
    """What a loading says, and what is drawn where it says nothing.

    Attributes:
        top: contacts from this layer on have the forces given here; below it beads are balanced.
        force: force of such a contact.
        load: load on a bead up to this layer; above it the load is what balances the bead.
        surface: the layer above which there is no bead, if there is one.
    """

    top: int
    force: Callable[[Branch, int, int], Dual]
    load: Callable[[int, int], Vector]
    surface: int | None = None


def _any_force(branch: Branch, across: int, layer: int) -> Dual:
    what = 1 if branch == "+" else 3
    return Dual(drawn(across, layer, what), drawn(across, layer, what + 1))


def _any_load(across: int, layer: int) -> Vector:
    x, y = (Dual(drawn(across, layer, w), drawn(across, layer, w + 1)) for w in (5, 7))
    return Vector(x, -y)


def given(
    name: str | None,
    place: tuple[int, ...],
    f_load: Fraction,
    m_g: Fraction,
    tilted: Vector = NOWHERE,
) -> Given:
    """What the loading of a name says at its place; without a name all forces are drawn.

    ``tilted`` is the load of a bead that is not straight down.

    Raises:
        UnknownLoadingError: there is no such loading.
    """
    if name is not None and name.endswith(MIRRORED) and len(place) == 2:
        straight = given(name.removesuffix(MIRRORED), (-place[0], place[1]), f_load, m_g, tilted)
        return _mirrored(straight)
    weightless = {"loaded": None, "loaded vertically": f_load}
    if name is None:
        return Given(0, _any_force, _any_load)
    carried = {
        "surface": Vector(ZERO, Dual(-f_load)),
        "bulk": Vector(ZERO, Dual(-m_g)),
        "surface tilted": tilted,
        "bulk tilted": tilted,
    }
    if name in carried and len(place) == 1:
        (height,) = place
        every = name.startswith("bulk")

        def weight(_: int, layer: int) -> Vector:
            return carried[name] if every or layer == height else NOWHERE

        return Given(height, lambda *_: ZERO, weight, surface=height)
    if len(place) == 2:
        if name in weightless:
            load = weightless[name]
            vertical = None if load is None else Vector(ZERO, Dual(-load))
            return Given(
                place[1],
                lambda branch, *at: ZERO if at == place else _any_force(branch, *at),
                lambda *at: vertical if vertical and at == place else _any_load(*at),
            )
        if name == "passing":
            return Given(
                place[1],
                lambda branch, *at: (
                    ZERO if at == place and branch == "-" else _any_force(branch, *at)
                ),
                lambda *at: NOWHERE if at == place else _any_load(*at),
            )
        if name == "point":
            down = Vector(ZERO, Dual(-f_load))
            here = (place[0], place[1])
            return Given(here[1], lambda *_: ZERO, lambda *at: down if at == here else NOWHERE)
        if name == "entering":
            entry = (place[0] - 1, place[1] - 1)
            return Given(
                entry[1],
                lambda branch, *at: (
                    _any_force(branch, *at)
                    if at[1] > entry[1] or (branch == "+" and at == entry)
                    else ZERO
                ),
                lambda *_: NOWHERE,
            )
    raise UnknownLoadingError(f"no packing is known for the loading {name!r}")


def _mirrored(made: Given) -> Given:
    """The mirror image at the line i = 0."""

    def force(branch: Branch, across: int, layer: int) -> Dual:
        return made.force("-" if branch == "+" else "+", -across, layer)

    def load(across: int, layer: int) -> Vector:
        straight = made.load(-across, layer)
        return Vector(-straight.x, straight.y)

    return replace(made, force=force, load=load)


@dataclass(frozen=True)
class Packing:
    """A packing with its loads and forces."""

    geometry: Geometry
    given: Given
    _below: dict[Site, tuple[Dual, Dual]] = field(default_factory=dict, repr=False, compare=False)

    def beads(self) -> int:
        """How many beads have been laid or balanced so far."""
        return len(self.geometry._positions) + len(self._below)

    def force(self, branch: Branch, across: int, layer: int) -> Dual:
        """Force of the contact above a bead."""
        if layer >= self.given.top:
            return self.given.force(branch, across, layer)
        if self.given.top - layer > HIGHEST:
            raise TooLargeError(f"a force through more than {HIGHEST} layers")
        if branch == "+":
            return self._supports(across + 1, layer + 1)[0]
        return self._supports(across - 1, layer + 1)[1]

    def load(self, across: int, layer: int) -> Vector:
        """Load on a bead."""
        if layer <= self.given.top:
            return self.given.load(across, layer)
        plus, minus = (across - 1, layer - 1), (across + 1, layer - 1)
        held = self._push("+", *plus) + self._push("-", *minus)
        return self._pushed(across, layer) - held

    def _push(self, branch: Branch, across: int, layer: int) -> Vector:
        """Force of a contact on its upper bead."""
        force = self.force(branch, across, layer)
        if not force:
            return NOWHERE
        return self.geometry.direction(branch, across, layer).times(force)

    def _pushed(self, across: int, layer: int) -> Vector:
        """What the contacts above a bead take from what its supports give."""
        return self._push("+", across, layer) + self._push("-", across, layer)

    def _supports(self, across: int, layer: int) -> tuple[Dual, Dual]:
        """Forces f⁺ and f⁻ below a bead that balance what it carries."""
        found = self._below.get((across, layer))
        if found is None:
            carried = self._pushed(across, layer) - self.load(across, layer)
            found = (ZERO, ZERO)
            if carried:
                plus = self.geometry.direction("+", across - 1, layer - 1)
                minus = self.geometry.direction("-", across + 1, layer - 1)
                over = plus.cross(minus).inverse()
                found = carried.cross(minus) * over, plus.cross(carried) * over
            self._below[across, layer] = found
        return found

    def quantity(self, kind: str, across: int, layer: int) -> Dual | Vector:
        """Value of what ``symbolic.symbols`` names as this class, at a site.

        Radii, displacements and directions are what has changed in them to first order.

        Raises:
            AbsentError: there is no such bead, or no bead at the contact's upper end.
            TooLargeError: it is too far up to be computed.
        """
        self._look_for(across, layer)
        if kind == "DeltaR":
            return Dual(0, drawn(across, layer))
        if kind == "SecondDifference":
            left, here, right = (drawn(across + by, layer) for by in (-2, 0, 2))
            return Dual(0, 2 * here - left - right)
        if kind == "Position":
            return self.geometry.ordered(across, layer)
        if kind == "DeltaX":
            return _changed(self.geometry.position(across, layer))
        if kind in ("DeltaNPlus", "DeltaNMinus"):
            branch, side = ("+", 1) if kind == "DeltaNPlus" else ("-", -1)
            self._look_for(across + side, layer + 1)
            return _changed(self.geometry.direction(branch, across, layer))
        if kind in ("ForcePlus", "ForceMinus"):
            return self.force("+" if kind == "ForcePlus" else "-", across, layer)
        if kind == "Load":
            return self.load(across, layer)
        raise TypeError(f"{kind} is no quantity of a site")

    def _look_for(self, across: int, layer: int) -> None:
        bead = f"there is no bead ({across}, {layer})".replace("-", "−")
        if (across + layer) % 2:
            raise AbsentError(f"{bead}: the sum of its indices is odd")
        if layer < 0:
            raise BelowError(f"{bead}: it would be below the base")
        if self.given.surface is not None and layer > self.given.surface:
            raise AbsentError(f"{bead}: it would be above the surface")


def _changed(vector: Vector) -> Vector:
    return Vector(Dual(0, vector.x.slope), Dual(0, vector.y.slope))
