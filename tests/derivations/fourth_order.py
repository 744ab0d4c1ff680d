"""The variance of f⁺/⟨f⟩ at order σ⁴, of exact packings with Gaussian radii, r = 1.

In the radii, f⁺/⟨f⟩ = 1 + Σ w_a ρ_a + Σ Q_ab ρ_a ρ_b + Σ T_abc ρ_a ρ_b ρ_c + …; by Wick's theorem
the order σ⁴ of its variance is 2 Σ Q_ab² + 6 Σ w_a T_abb. The coefficients are derivatives of discs
on discs and of their balances, in float64, by products of polynomials in two strengths s and t, up
to s t². Shares no code with the package.
"""

from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]
POWERS = ((0, 0), (1, 0), (0, 1), (1, 1), (0, 2), (1, 2))
"""Those of s and t that are kept."""
PRODUCTS = [
    (first, second, POWERS.index((a + c, b + d)))
    for first, (a, b) in enumerate(POWERS)
    for second, (c, d) in enumerate(POWERS)
    if (a + c, b + d) in POWERS
]


@dataclass(frozen=True, eq=False)
class Jet:
    """A polynomial in s and t; one array of shape (packings, beads of a layer) for each power."""

    terms: tuple[Any, ...]

    def __add__(self, other: "Jet | float") -> "Jet":
        if isinstance(other, Jet):
            return Jet(tuple(a + b for a, b in zip(self.terms, other.terms, strict=True)))
        return Jet((self.terms[0] + other, *self.terms[1:]))

    def __mul__(self, other: "Jet | float") -> "Jet":
        if not isinstance(other, Jet):
            return Jet(tuple(a * other for a in self.terms))
        terms: list[Any] = [0.0] * len(POWERS)
        for a, b, place in PRODUCTS:
            terms[place] = terms[place] + self.terms[a] * other.terms[b]
        return Jet(tuple(terms))

    def __sub__(self, other: "Jet | float") -> "Jet":
        return self + other * -1

    def inverse(self) -> "Jet":
        """By Newton: each step doubles the order that is right."""
        result = constant(1 / self.terms[0])
        for _ in range(2):
            result = result * ((self * result) * -1 + 2)
        return result

    def root(self) -> "Jet":
        """The square root, in the same way."""
        result = constant(1 / np.sqrt(self.terms[0]))
        for _ in range(2):
            result = result * ((self * result * result) * -0.5 + 1.5)
        return self * result

    def rolled(self, places: int, around: float = 0.0) -> "Jet":
        """That of the bead so many places to the left; ``around`` is the width, of positions."""
        first, *others = (np.roll(term, places, axis=1) for term in self.terms)
        columns = np.arange(first.shape[1])
        beyond = np.where(columns < places, -around, 0.0) + np.where(
            columns >= len(columns) + places, around, 0.0
        )
        return Jet((first + beyond, *others))


def constant(value: Array) -> Jet:
    """The same for all s and t."""
    return Jet((value, *(np.zeros_like(value) for _ in POWERS[1:])))


def forces(along_s: Array, along_t: Array, phi: float, bulk: bool) -> list[Jet]:
    """f⁺/⟨f⟩ of each layer, by lower bead; radii are 1 + s·… + t·…, of shape (packings, M + 1, W).

    Bead q of layer j is (i, j) with i = 2q + (j modulo 2); the strip is periodic.
    """
    packings, layers, width = along_s.shape
    height, none = layers - 1, np.zeros((packings, width))
    n_x, n_y = np.sqrt((1 - phi) / 2), np.sqrt((1 + phi) / 2)
    spacing = 4 * n_x
    radii = [Jet((none + 1, along_s[:, j], along_t[:, j], none, none, none)) for j in range(layers)]
    x, y = [constant(none + spacing * np.arange(width))], [constant(none)]

    def supports(j: int) -> list[tuple[int, Jet, Jet, Jet]]:
        """Both of each bead of a layer: by how much they are rolled, where they are, radii."""
        rolls = (0, -1) if j % 2 else (1, 0)
        around = spacing * width
        return [
            (roll, x[j - 1].rolled(roll, around), y[j - 1].rolled(roll), radii[j - 1].rolled(roll))
            for roll in rolls
        ]

    for j in range(1, layers):
        (_, x_1, y_1, r_1), (_, x_2, y_2, r_2) = supports(j)
        across, up = x_2 - x_1, y_2 - y_1
        square = (across * across + up * up).inverse()
        left, right = radii[j] + r_1, radii[j] + r_2
        share = ((left * left - right * right) * square + 1) * 0.5
        rise = (left * left * square - share * share).root()
        x.append(x_1 + share * across - rise * up)
        y.append(y_1 + share * up + rise * across)

    ratios: list[Jet] = []
    push_x = push_y = constant(none)
    for j in range(height, 0, -1):
        if bulk or j == height:
            push_y = push_y + 2 * n_y
        sides = []
        for rolled, x_1, y_1, r_1 in supports(j):
            over = (radii[j] + r_1).inverse()
            sides.append((rolled, (x[j] - x_1) * over, (y[j] - y_1) * over))
        (roll_1, u_x, u_y), (roll_2, v_x, v_y) = sides
        over = (u_x * v_y - u_y * v_x).inverse()
        plus = (push_x * v_y - push_y * v_x) * over
        minus = (u_x * push_y - u_y * push_x) * over
        ratios.append(plus.rolled(-roll_1) * (1 / (height - j + 1 if bulk else 1)))
        push_x = (plus * u_x).rolled(-roll_1) + (minus * v_x).rolled(-roll_2)
        push_y = (plus * u_y).rolled(-roll_1) + (minus * v_y).rolled(-roll_2)
    return ratios[::-1]


@cache
def variances(height: int, phi: float, bulk: bool) -> tuple[tuple[float, float], ...]:
    """The orders σ² and σ⁴ of σ_f²/⟨f⟩², layer by layer."""
    width = 2 * height + 3  # no exact force sees an image of itself
    beads = (height + 1) * width
    each = np.eye(beads).reshape(beads, height + 1, width)

    def unit(layer: int) -> Array:
        return np.broadcast_to(each[layer * width], each.shape)

    middle, squares, thirds = width // 2, np.zeros(height), np.zeros(height)
    weights = [of_layer.terms[1][:, middle] for of_layer in forces(each, 0 * each, phi, bulk)]
    for layer in range(height + 1):  # by translation, of one bead of a layer on all contacts
        mixed = forces(each, unit(layer), phi, bulk)
        squares += [(of_layer.terms[3] ** 2).sum() / 4 for of_layer in mixed]
        for of, (of_layer, weight) in enumerate(zip(mixed, weights, strict=True)):
            rows = weight.reshape(height + 1, width)
            for column in range(width):
                own = np.roll(rows, column - middle, axis=1).ravel()
                thirds[of] += own @ of_layer.terms[5][:, column]
    return tuple(
        (float((weight**2).sum()), float(2 * square + 2 * third))
        for weight, square, third in zip(weights, squares, thirds, strict=True)
    )


@cache
def other_laws(height: int, phi: float, bulk: bool) -> tuple[tuple[float, float], ...]:
    """What skewness adds at order σ³, and excess kurtosis at σ⁴, layer by layer."""
    width = 2 * height + 3
    beads, middle = (height + 1) * width, width // 2
    each = np.eye(beads).reshape(beads, height + 1, width)
    values = []
    for of_layer in forces(each, each, phi, bulk):
        weight, twice, third = (of_layer.terms[place][:, middle] for place in (1, 4, 5))
        skew, kurtosis = 2 * (weight * twice).sum(), (twice**2 + 2 * weight * third / 3).sum()
        values.append((float(skew), float(kurtosis)))
    return tuple(values)


def surface_leading(phi: float) -> tuple[float, ...]:
    """Coefficients of M⁴, M³j, M²j², Mj³, j⁴ at order σ⁴, times (1 − φ²)⁴; fitted."""
    a, c = 69 - 120 * phi + 175 * phi**2, 83 - 256 * phi + 313 * phi**2
    b = 166 - 224 * phi + 394 * phi**2
    return a / 4, (b - 2 * a) / 4, (a - 2 * b + c) / 4, (b - 2 * c) / 4, c / 4


def bulk_leading(phi: float) -> tuple[float, ...]:
    """Coefficients of K⁴, K³j and K²j², K = M − j, times (1 − φ²)⁴, under a bulk load; fitted."""
    a, b, c = (667, -1152, 1673), (4380, -6696, 10632), (7155, -13500, 19845)
    return tuple((row[0] + row[1] * phi + row[2] * phi**2) / 360 for row in (a, b, c))
