"""Means to second order in the deviations of the radii, from covariances of first-order forms.

A quantity is X + εX₁ + ε²X₂. X₁ is linear in the radii, and has mean zero; ⟨X₂⟩ is what the mean
shifts by. Of a product XY it is X⟨Y₂⟩ + Y⟨X₂⟩ + ⟨X₁Y₁⟩. Geometry and balance give the rest:

* The centres of a contact along n⁺ are 2r n⁺ + ε(ρ n⁺ + 2r δn⁺) + ε² d₂ apart, ρ being the sum of
  both δr, and as far as the radii together. With δn⁺ = ν b⁻ and |b⁻|² = 1/(1 − φ²), order ε² says
  n⁺·d₂ = −r ν²/(1 − φ²): the line sum n⁺·δx of the upper bead exceeds that of the lower one by it.
* The contact's unit vector has at order ε² the components n⁺·d₂/2r and (n⁻·d₂ − νρ)/2r, and in the
  mean n⁻·d₂ is n⁺·d₂.
* At every bead the contacts above pass on force times unit vector to those below, and loads do not
  fluctuate. Along b⁺, of the two contacts below f⁺ counts, and what the changes of both unit
  vectors turn into that direction; so ⟨f⁺₂⟩ below a bead follows from ⟨f⁺₂⟩ above it.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Self

import sympy

from . import sets
from .algebra.exact import FIELD, SITE, SOURCE, NotExactError
from .forms import NUMBER, RADII, SHIFT, Form, Known
from .symbols import DeltaNMinus, DeltaNPlus, DeltaX, ForceMinus, ForcePlus, n, phi, r
from .weights import Weights

PLUS, MINUS = 0, 1
"""The two branches, and the components n⁺·v and n⁻·v of a vector."""

_TURN, _FORCE = (DeltaNPlus, DeltaNMinus), (ForcePlus, ForceMinus)
_BEAD = SOURCE[:2]
_PHI, _R, _TWO = FIELD.generator(phi), FIELD.generator(r), FIELD.constant(2)
_SQUARE = FIELD.one - _PHI**2
_ABOVE = sets.where(n >= 1)
_BEADS = sets.where(sympy.Add(*_BEAD) >= 0)


def covariance(first: Form, second: Form, dimension: int = 2) -> Weights:
    """Σ w w′ over all sites, for radii of variance 1."""
    left, right = (form.parts.get(RADII, Weights()) for form in (first, second))
    return left.times(right).summed(*SITE[:dimension])


class Jet(Form):
    """A form with the shift of its mean, for radii of variance 1."""

    def times(self, other: Form) -> Self:
        """The product, its mean to second order."""
        return super().times(other) + type(self)({SHIFT: covariance(self, other)})


@dataclass(frozen=True, eq=False)
class Means:
    """Shifts of the means in a packing whose first order is known.

    Attributes:
        known: contact directions, displacements and forces by the coordinates of their bead.
        top: the layer above which there are no forces; None without a load.
    """

    known: Mapping[type, tuple[Known, ...]]
    top: sympy.Expr | None = None

    def jets(self) -> dict[type, tuple[Known, ...]]:
        """The same quantities, with the shifts of their means."""
        shifts: dict[type, tuple[Weights, ...]] = {
            DeltaNPlus: (self.along[PLUS], self.beside[PLUS]),
            DeltaNMinus: (self.beside[MINUS], self.along[MINUS]),
        }
        if DeltaX in self.known:
            shifts[DeltaX] = tuple(self._line_sum(branch) for branch in (PLUS, MINUS))
        if ForcePlus in self.known:
            shifts |= {kind: (self._force(branch),) for branch, kind in enumerate(_FORCE)}
        return {
            kind: tuple(
                replace(
                    jet,
                    value=tuple(
                        Jet({**form.parts, SHIFT: shift.on(jet.points)})
                        for form, shift in zip(jet.value, shifts[kind], strict=True)
                    ),
                )
                for jet in self.known[kind]
            )
            for kind in shifts
            if kind in self.known
        }

    def _first_order(self, kind: type, component: int = 0) -> Form:
        """What is known of all contacts, up to those below the surface.

        Raises:
            NotExactError: of some nothing is known.
        """
        total, left = Form(), _BEADS
        if kind in _FORCE and self.top is not None:
            left = left & sets.where(sympy.Le(sympy.Add(*_BEAD), self.top - 1, evaluate=False))
        counted = sets.NOTHING
        for known in self.known.get(kind, ()):
            total = total + known.value[component].on(known.points - counted)
            counted, left = counted | known.points, left - known.points
        if not left.is_empty() or not {*total.parts} <= {NUMBER, RADII}:
            raise NotExactError(f"{kind.__name__} is not determined by the radii for every bead")
        return total

    @cached_property
    def _tilts(self) -> tuple[Form, Form]:
        """ν of both contacts that lead up from a bead."""
        return self._first_order(DeltaNPlus, MINUS), self._first_order(DeltaNMinus, PLUS)

    @cached_property
    def along(self) -> tuple[Weights, Weights]:
        """⟨n⁺·u₂⟩ of a contact along n⁺, ε² u₂ being its unit vector's, and the mirror image."""
        scale = -FIELD.one / (_TWO * _SQUARE)
        first, second = (covariance(tilt, tilt).scaled(scale).merged() for tilt in self._tilts)
        return first, second

    @cached_property
    def beside(self) -> tuple[Weights, Weights]:
        """⟨n⁻·u₂⟩ of a contact along n⁺, and the mirror image."""
        turns = []
        for branch, tilt in enumerate(self._tilts):
            radii = _radius() + _radius().at({_BEAD[branch]: _BEAD[branch] + 1})
            with_radii = covariance(tilt, radii).scaled(-FIELD.one / (_TWO * _R))
            turns.append((self.along[branch] + with_radii).merged())
        return turns[PLUS], turns[MINUS]

    def _turned(self, branch: int, side: int) -> Weights:
        """⟨force times unit vector⟩ along b⁺ or b⁻ at second order, less ⟨force⟩ along it."""
        force = self._first_order(_FORCE[branch])
        with_tilt = covariance(self._tilts[branch], force)
        own, other = self.along[branch], self.beside[branch]
        if side != branch:
            own, other = other, own
        unit = own - other.scaled(_PHI)
        total = with_tilt.scaled(-_PHI if side == branch else FIELD.one)
        return (total + force.parts.get(NUMBER, Weights()).times(unit)).scaled(FIELD.one / _SQUARE)

    def _force(self, branch: int) -> Weights:
        """⟨f⟩ at second order: what every bead further up the contact's line turns into it."""
        turned = [self._turned(side, branch) for side in (PLUS, MINUS)]
        gained = Weights()
        for weights, axis in zip(turned, _BEAD, strict=True):
            gained = gained + weights - weights.at({axis: axis - 1})
        upwards = {_BEAD[branch]: _BEAD[branch] + n}
        return gained.merged().at(upwards).on(_ABOVE).summed(n).merged()

    def _line_sum(self, branch: int) -> Weights:
        """⟨n⁺·δx⟩ or ⟨n⁻·δx⟩ at second order: the steps of all contacts down to the base."""
        downwards = {_BEAD[branch]: _BEAD[branch] - n}
        steps = self.along[branch].scaled(_TWO * _R)
        return steps.at(downwards).on(_ABOVE).summed(n).merged()


def _radius() -> Form:
    """δr of the bead itself."""
    here = (sympy.Eq(symbol, at, evaluate=False) for symbol, at in zip(SITE, _BEAD, strict=False))
    return Form({RADII: Weights.of(*here)})
