"""Small packings with rational radii, and what the exact solution says of them at order ε¹."""

from dataclasses import dataclass
from fractions import Fraction
from random import Random

import sympy

from symbolic import explicit

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
        loaded: the bead (k, l), l ≥ 1, that alone is loaded where an equation asks for one.
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


def draw(seed: int) -> SmallPacking:
    """Draw a small packing, the same for the same seed."""
    random = Random(seed)
    height = random.randint(3, 5)
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


class Truth:
    """Order-ε¹ values of every lattice quantity of one packing, under one set of loads."""

    def __init__(self, packing: SmallPacking, loads: dict[Site, tuple[Fraction, Fraction]]):
        from numeric import taylor  # with NumPy, which no proof needs

        self.packing = packing
        self.solved = taylor.solve(
            packing.width, packing.height, n=packing.n, rho=packing.rho, loads=loads, order=1
        )
        self.values = explicit.geometry(*packing.n, Fraction(1))

    def quantity(self, family: str, across: int, layer: int) -> Fraction:
        """Value of a lattice quantity, first order (families as in ``symbolic.explicit``)."""
        n_x, n_y = self.packing.n
        if family == "DeltaR":
            site = (across % (2 * self.packing.width), layer)
            return self.packing.rho.get(site, Fraction(0))
        if family in ("DeltaXx", "DeltaXy"):
            return self.solved.displacement(across, layer)["xy".index(family[-1])][1]
        branch, sign = {"DeltaNPlus": ("+", -1), "DeltaNMinus": ("-", 1)}[family]
        x, y = self.solved.direction(across, layer, branch)
        return sign * n_x * x[1] + n_y * y[1]  # n^∓·δn^±

    def total(self, weights: explicit.Weights) -> Fraction:
        """Value of the part of a form that depends on the packing."""
        return sum(
            (weight * self.quantity(*key) for key, weight in weights.items() if key[0]),
            Fraction(0),
        )

    def scalar(self, expression: sympy.Expr, at: explicit.Values) -> tuple[Fraction, Fraction]:
        """Orders ε⁰ and ε¹ of a printed scalar expression."""
        weights = explicit.weights(expression, {**self.values, **at})
        return weights.get(("", 0, 0), Fraction(0)), self.total(weights)

    def vector(self, expression: sympy.Expr, at: explicit.Values) -> tuple[Fraction, Fraction]:
        """Cartesian components, at order ε¹, of a printed vector expression."""
        x, y = explicit.vector_weights(expression, {**self.values, **at})
        return self.total(x), self.total(y)

    def force(self, across: int, layer: int, branch: str) -> tuple[Fraction, Fraction]:
        """Orders ε⁰ and ε¹ of a contact force."""
        zero, one = self.solved.force(across, layer, branch)
        return zero, one
