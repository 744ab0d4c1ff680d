"""σ_f to first order, M*, and how many contacts of a packing are expected to pull.

Estimates: to first order in δr (Eqs. 13, 14, B2, B3, B13 and B14), with Gaussian forces. M*
(Eq. 15) is the height where σ_f is about ⟨f⟩; in a packing of many contacts some pull far below.
"""

import math
from fractions import Fraction
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np

from .. import closed_forms
from ..arithmetic.systems import Array

# A typical packing has tension: the chance of none, exp(−number), is below one half.
TYPICAL = math.log(2)
# Of higher packings about so many layers are looked at, in the middle of as many equal parts.
LAYERS = 50
# In place of an ordered force that is zero: its square is lost beside that of the other contact.
NO_FORCE = 1e-30
HIGHEST = 10_000_000


def critical_height(relative_std: Fraction) -> float:
    """Give M* = (σ/r)^(−2/3), where contacts begin to pull (Eq. 15); inf beyond a float's range.

    >>> critical_height(Fraction(1, 1000))
    100.0
    """
    if not relative_std:
        return math.inf
    # whole numbers, which may lie outside a float's range
    log = math.log10(relative_std.numerator) - math.log10(relative_std.denominator)
    return round(10 ** (-2 * log / 3), 9) if log > -460 else math.inf


@lru_cache(maxsize=4096)
def stds_of_contacts(
    load: str, M: int, j: int, phi: float, components: tuple[float, ...]
) -> tuple[float, ...]:
    """Give σ of f^a of layer j, along each direction (Eqs. 13, 14, B2, B3, B13 and B14).

    ``load``: "surface" or "bulk"; ``phi``: the dot product of two base vectors; ``components``:
    (L⁺, L⁻) of the load, the unit of the result; of spheres (L^a), all alike. Under a bulk load it
    is per layer above the contact.
    """
    if len(components) > 2:
        form = getattr(closed_forms, f"{load}_variance_of_spheres")
        return tuple(math.sqrt(form(M, j, M - j, phi)) * own for own in components)
    tilted = getattr(closed_forms, f"{load}_variance_at_angle")
    pairs = ((own or NO_FORCE, other) for own, other in (components, components[::-1]))
    variances = ((own, tilted(M, j, M - j, other / own, phi)) for own, other in pairs)
    return tuple(abs(own) * math.sqrt(max(0.0, variance)) for own, variance in variances)


def stds_by_layer(
    load: str, M: int, phi: float, components: tuple[float, ...] = (1.0, 1.0)
) -> Array:
    """Give σ of f¹, or f⁺, of the layers from the base up, shape (M,); arguments as above."""
    return np.array([stds_of_contacts(load, M, j, phi, components)[0] for j in range(M)])


def leading_stds(load: str, M: int, z: Any, phi: float, *, spheres: bool = False) -> Array:
    """Give their leading orders at the relative heights z (Eqs. 13, 14, B13 and B14 as printed)."""
    form = getattr(closed_forms, f"{load}_diffusion{'_of_spheres' if spheres else ''}")
    return np.sqrt([form(M, at, phi) for at in z])


class ExpectedTension(NamedTuple):
    """About so many ``contacts`` pull, in one packing.

    ``height_of_one``: the height from which on it is one or more, at the same width; None beyond
    the highest packings.
    """

    contacts: float
    height_of_one: int | None

    @property
    def typical(self) -> bool:
        """Whether more than half of such packings have a contact that pulls."""
        return self.contacts > TYPICAL


@lru_cache(maxsize=16)
def expected_tension(
    height: int,
    beads: int,
    phi: float,
    relative_std: float,
    load: str,
    components: tuple[float, ...] = (1.0, 1.0),
) -> ExpectedTension:
    """Estimate how many of a packing's contacts pull: two a bead of discs, three of spheres.

    ``height``: M; ``beads``: of a layer; ``phi``: the dot product of two base vectors;
    ``relative_std``: σ/r; ``load``: "surface" or "bulk"; ``components``: (L⁺, L⁻) of the load, in
    any unit, straight down by default; of spheres (L^a), all alike.

    >>> found = expected_tension(16, 32, -1 / 8, 0.0055, "surface")
    >>> round(found.contacts, 1), found.height_of_one
    (7.0, 14)
    """

    def pulling(M: int, j: int) -> float:
        """Of a bead's contacts."""
        stds = stds_of_contacts(load, M, j, phi, components)
        return sum(
            _negative(mean, relative_std * std) for mean, std in zip(components, stds, strict=True)
        )

    def contacts(M: int) -> float:
        part = 2 * (M // (2 * LAYERS)) + 1  # odd: it has a layer in its middle
        return beads * part * sum(pulling(M, j) for j in range(part // 2, M, part))

    low, high = 0, 1
    while contacts(high) < 1:
        low, high = high, 2 * high
        if low > HIGHEST:
            return ExpectedTension(contacts(height), None)
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (low, middle) if contacts(middle) >= 1 else (middle, high)
    return ExpectedTension(contacts(height), high)


def _negative(mean: float, std: float) -> float:
    """Give the chance of a Gaussian number below zero."""
    return math.erfc(mean / (math.sqrt(2) * std)) / 2 if std else float(mean < 0)
