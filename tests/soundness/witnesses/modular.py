"""First-order forces of packings with long windows, modulo a prime.

Fractions of Taylor packings grow with M; residues don't, and NumPy takes whole layers of them. The
contacts are linearised (Eqs. 2–5) and the beads balanced (Eqs. 6–11) anew, so that a false closed
form agrees by chance once in 2³¹ places. Beads are named (a, j) with i = 2a + j: a is the same all
along a diagonal of n⁺, and one less a layer up along n⁻.
"""

from dataclasses import dataclass
from fractions import Fraction
from functools import cache, cached_property
from itertools import pairwise
from typing import Any

import numpy as np
import numpy.typing as npt

Residues = npt.NDArray[np.int64]
PRIME = 2**31 - 1
"""Products of two residues are below 2⁶²."""


def residue(value: Fraction | int) -> int:
    """A fraction modulo the prime.

    Raises:
        ZeroDivisionError: the prime divides its denominator.

    >>> residue(Fraction(1, 2)) * 2 % PRIME
    1
    """
    value = Fraction(value)
    if value.denominator % PRIME == 0:
        raise ZeroDivisionError(f"{value} has no value modulo {PRIME}")
    return value.numerator * pow(value.denominator, -1, PRIME) % PRIME


def _times(one: Any, other: Any) -> Any:
    return one * other % PRIME


def _total(one: Residues, other: Residues) -> int:
    """Sum of products, which for two weights is a covariance."""
    return int(_times(one, other).sum()) % PRIME


@dataclass(frozen=True)
class ModularPacking:
    """Changes of all forces when one bead of a layer is enlarged, of each layer in turn.

    Arrays have one row for each layer with an enlarged bead, (0, s), and one column for each a.

    Attributes:
        height: M.
        width: beads a layer, modulo which a is taken.
        phi: n⁺·n⁻.
        load: "surface" or "bulk", each bead with the same.
    """

    height: int
    width: int
    phi: Fraction
    load: str

    def carried(self, layer: int) -> int:
        """Ordered force of the contacts that start in this layer."""
        if layer >= self.height:
            return 0
        return self.height - layer if self.load == "bulk" else 1

    @cached_property
    def tilts(self) -> tuple[tuple[Residues, ...], tuple[Residues, ...]]:
        """n^∓·δn^± of the contacts above each layer, r = 1 (Eqs. 4, 5)."""
        layers = range(self.height + 1)
        radii = [np.zeros((self.height + 1, self.width), dtype=np.int64) for _ in layers]
        for layer in layers:
            radii[layer][layer, 0] = 1
        # n^±·δx of each bead: each contact with a support adds both radii (Eqs. 2, 3)
        plus, minus = [np.zeros_like(radii[0])], [np.zeros_like(radii[0])]
        for below, here in pairwise(radii):
            plus.append((plus[-1] + below + here) % PRIME)
            minus.append((self._right(minus[-1] + below) + here) % PRIME)
        phi, half = residue(self.phi), residue(Fraction(1, 2))
        found: tuple[list[Residues], list[Residues]] = [], []
        for j in range(self.height):
            along_plus = radii[j] + radii[j + 1]
            along_minus = radii[j] + self._left(radii[j + 1])
            turned = minus[j + 1] - minus[j] - _times(phi, along_plus)
            found[0].append(_times(turned % PRIME, half))
            turned = self._left(plus[j + 1]) - plus[j] - _times(phi, along_minus)
            found[1].append(_times(turned % PRIME, half))
        return tuple(found[0]), tuple(found[1])

    @staticmethod
    def _right(of: Residues) -> Residues:
        """Of (a + 1, ·) at (a, ·): of the beads below along n⁻."""
        return np.roll(of, -1, axis=1)

    @staticmethod
    def _left(of: Residues) -> Residues:
        """Of (a − 1, ·) at (a, ·): of the beads above along n⁻."""
        return np.roll(of, 1, axis=1)

    @cached_property
    def changes(self) -> tuple[tuple[Residues, ...], tuple[Residues, ...]]:
        """Changes of f⁺ and f⁻ above each layer, a load adding 1 to both (Eq. 11)."""
        phi, over_all = residue(self.phi), residue(1 / (1 - self.phi**2))
        zero = np.zeros((self.height + 1, self.width), dtype=np.int64)
        found: tuple[list[Residues], list[Residues]] = [], []
        plus = minus = above_plus = above_minus = zero
        for j in reversed(range(self.height)):
            below_plus, below_minus = (tilts[j] for tilts in self.tilts)
            over, under = self.carried(j + 1), self.carried(j)
            # what the beads of layer j + 1 lose along b⁻ and b⁺, as their contacts turn
            lost_plus = (over * above_plus - under * below_plus) % PRIME
            lost_minus = (over * above_minus - under * self._right(below_minus)) % PRIME
            gain_plus = _times((lost_minus - _times(phi, lost_plus)) % PRIME, over_all)
            gain_minus = _times((lost_plus - _times(phi, lost_minus)) % PRIME, over_all)
            plus = (plus + gain_plus) % PRIME
            minus = self._left((minus + gain_minus) % PRIME)
            found[0].append(plus)
            found[1].append(minus)
            above_plus, above_minus = below_plus, below_minus
        return tuple(reversed(found[0])), tuple(reversed(found[1]))

    def weights(self, quantity: str, layer: int) -> Residues:
        """Weights in δr/r of f⁺/⟨f⟩ ("force"), or of p/⟨p⟩ ("bead"), in layer j < M.

        p is the vertical force that a bead gets from both upper contacts.
        """
        plus, minus = (of[layer] for of in self.changes)
        per_load = residue(Fraction(1, self.carried(layer)))
        if quantity == "force":
            return np.asarray(_times(plus, per_load))
        if quantity != "bead":
            raise ValueError(f'there are weights of a "force" or a "bead", not of a "{quantity}"')
        turned = _times((self.tilts[0][layer] + self.tilts[1][layer]) % PRIME, self._upright)
        both = _times((plus + minus) % PRIME, per_load) + turned
        return np.asarray(_times(both % PRIME, residue(Fraction(1, 2))))

    @property
    def _upright(self) -> int:
        return residue(1 / (1 + self.phi))


@cache
def packing(height: int, phi: Fraction, load: str) -> ModularPacking:
    """One so wide that 2M neighbours don't meet their images."""
    return ModularPacking(height, 3 * height + 4, phi, load)


@cache
def mean_variances(quantity: str, height: int, layer: int, phi: Fraction) -> tuple[int, ...]:
    """Variances of the mean over 1, 2, …, 2M neighbours, for r = σ = 1.

    ``quantity`` is "force", "bulk" (the force under a bulk load) or "bead".
    """
    within = packing(height, phi, "bulk" if quantity == "bulk" else "surface")
    single = within.weights("bead" if quantity == "bead" else "force", layer)
    summed, found = np.zeros_like(single), []
    for count in range(1, 2 * height + 1):
        summed = (summed + np.roll(single, count, axis=1)) % PRIME
        found.append(_times(_total(summed, summed), residue(Fraction(1, count**2))))
    return tuple(found)


def between_layers(height: int, lower: int, upper: int, places: int, phi: Fraction) -> int:
    """Covariance of f⁺/⟨f⟩ in two layers, so many places beside one diagonal, r = σ = 1."""
    within = packing(height, phi, "surface")
    above = np.roll(within.weights("force", upper), -places, axis=1)
    return _total(within.weights("force", lower), above)
