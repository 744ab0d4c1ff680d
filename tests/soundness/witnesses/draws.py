"""Small packings with rational radii, for witnesses and counterexamples."""

from dataclasses import dataclass
from fractions import Fraction
from random import Random

Site = tuple[int, int]

DIRECTIONS = tuple(
    (Fraction(a, c), Fraction(b, c))
    for a, b, c in ((3, 4, 5), (4, 3, 5), (20, 21, 29), (21, 20, 29), (33, 56, 65), (48, 55, 73))
)
"""Rational base vectors (n_x, n_y) with ½ < n_x < √3/2, φ of either sign."""


@dataclass(frozen=True)
class SmallPacking:
    """A periodic packing with rational radii δr = ε ρ, r = 1.

    Attributes:
        width: W beads a layer; W > M, so that first-order formulas see no image.
        height: M.
        n: rational (n_x, n_y).
        rho: ρ of every bead that deviates, i in [0, 2W).
        load: magnitude of the load on a bead.
        loaded: the bead (k, l), l ≥ 2, that alone is loaded where an equation asks for one.
        contacts: lower beads (i, j) of the contacts to look at, 0 ≤ j < M.
    """

    width: int
    height: int
    n: tuple[Fraction, Fraction]
    rho: dict[Site, Fraction]
    load: Fraction
    loaded: Site
    contacts: tuple[Site, ...]

    def surface_load(self) -> dict[Site, tuple[Fraction, Fraction]]:
        """Return the load, downwards, on every bead of the surface."""
        parity = self.height % 2
        return {
            (across, self.height): (Fraction(0), -self.load)
            for across in range(parity, 2 * self.width, 2)
        }

    @property
    def components(self) -> tuple[Fraction, Fraction]:
        """L⁺ and L⁻ of a load −(L⁺n⁺ + L⁻n⁻) that is not vertical."""
        return self.load, self.load * Fraction(self.loaded[1], self.height + 1)

    def tilted_load(self) -> dict[Site, tuple[Fraction, Fraction]]:
        """Return that load on every bead of the surface, in Cartesian components."""
        plus, minus = self.components
        force = ((minus - plus) * self.n[0], -(plus + minus) * self.n[1])
        return dict.fromkeys(self.surface_load(), force)


def draw(seed: int) -> SmallPacking:
    """Draw a small packing, the same for the same seed."""
    random = Random(seed)
    height = random.randint(3, 6)
    width = height + random.randint(1, 3)
    rho = {
        (across, layer): Fraction(random.randint(-9, 9), random.randint(1, 9))
        for layer in range(height + 1)
        for across in range(layer % 2, 2 * width, 2)
    }
    level = random.randint(2, height)
    layers = (0, height - 1, *(random.randrange(height) for _ in range(3)))
    return SmallPacking(
        width,
        height,
        random.choice(DIRECTIONS),
        rho,
        load=Fraction(random.randint(1, 9), random.randint(1, 9)),
        loaded=(2 * random.randrange(width) + level % 2, level),
        contacts=tuple((2 * random.randrange(width) + layer % 2, layer) for layer in layers),
    )
