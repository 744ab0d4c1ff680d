"""Tolerance chooses the method: of all ways that should meet it, the cheapest by the cost model.

An expected error only orders the ways. What is promised is measured afterwards: a bound by balls,
or an estimate from a repeat, and a way whose estimate misses the tolerance gives way to the next
(see ``runner``). Last come balls, whose bits are raised until their bound fits. What a scene names
is never replaced: all ways answer the same question about the same packings.
"""

import math
from collections.abc import Iterator, Mapping
from dataclasses import replace
from fractions import Fraction
from typing import Protocol

from force_diffusion.numeric.accuracy.repeated import expected, usual_units
from force_diffusion.numeric.arithmetic.decimals import short
from force_diffusion.numeric.arithmetic.systems import (
    FLOAT64,
    LONGDOUBLE,
    Balls,
    BigFloat,
    NumberSystem,
)
from force_diffusion.numeric.disorder.radii import Radii
from force_diffusion.numeric.lattice.layers import whole
from force_diffusion.numeric.planning import budget
from force_diffusion.numeric.planning.plan import Candidate, Choice, Plan, Way
from force_diffusion.numeric.scene.sections import Scene, SceneError
from force_diffusion.numeric.studies.cost.ways import why_not_plain
from force_diffusion.numeric.theory.critical_height import critical_height


class Outline(Protocol):
    """A scene and an algorithm, from which a plan is made of a way."""

    scene: Scene
    radii: Radii
    route: str
    height: int
    realisations: int

    def plan(self, way: Way) -> Plan:
        """Plan a way; ``SceneError`` where it takes too much, or its numbers can't hold."""


Outlines = Mapping[str, Outline]
"""By the name of the algorithm."""
# Where so many realisations agree with a longer significand, the others are taken to do so, too.
FEW = 4
# Nearer to M* than this, disorder itself grows with the height, and rounding errors with it.
SOUND = 0.5
# Of two ways whose predicted costs differ by less than predictions are good for, the one that
# certifies is taken.
WORTH = 1.25
PLAIN = "exact sweep in plain form"


def choose(outlines: Outlines, tolerance: Fraction, source: str, *, certified: bool) -> Plan:
    """Give the plan of the cheapest way, with all that were weighed.

    ``source`` says where the coefficients are from. Raises ``SceneError`` if no way is possible.
    """
    candidates = weighed(outlines, tolerance, certified)
    possible = [c for c in candidates if not c.out]
    if not possible:
        first = next(iter(outlines.values()))
        first.plan(Way(Balls(budget.initial_bits(tolerance, first.height))))  # which says why not
    reason = f"the cheapest of {len(possible)} ways that should meet it"
    if certified:
        reason = "certified was asked for, and only balls certify"
    elif len(possible) == 1:
        reason = "the only way that should meet it"
    elif possible[0].certified and possible[0].seconds != min(c.seconds or 0 for c in possible):
        reason = (
            "certified, and no way is predicted to take less by more than a quarter of its time"
        )
    more, less = tolerance / 10, tolerance * 10
    choice = Choice(
        tolerance, reason, source, tuple(candidates),
        _cheapest(outlines, more, certified),
        _cheapest(outlines, less, certified) if less < 1 else None,
    )  # fmt: skip
    assert possible[0].plan is not None
    return replace(possible[0].plan, choice=choice)


def _cheapest(outlines: Outlines, tolerance: Fraction, certified: bool) -> Candidate | None:
    return next((c for c in weighed(outlines, tolerance, certified) if not c.out), None)


def weighed(outlines: Outlines, tolerance: Fraction, certified: bool) -> list[Candidate]:
    """Weigh all ways: those that may answer first, the cheapest at the top; then the others."""
    found: list[Candidate] = []
    for algorithm, outline in outlines.items():
        for way in _ways(tolerance, outline):
            lost = _lost(outline) if way.plain else 0
            error = expected(way, outline.height, outline.realisations, lost)
            name = PLAIN if way.plain else algorithm
            out = "" if way.certified else _why_not(way, outline, error, tolerance, certified)
            made = None
            try:
                made = outline.plan(way)
                if way.plain:
                    out = _why_not_plain(made)
            except SceneError as refused:
                out = out or str(refused)
            seconds = None if made is None else made.estimated_seconds
            found.append(
                Candidate(
                    name, way.system.name, way.certified, way.repeated, error, seconds, out,
                    None if out else made,
                )
            )  # fmt: skip

    def rank(candidate: Candidate) -> tuple[bool, float]:
        seconds = math.inf if candidate.seconds is None else candidate.seconds
        return bool(candidate.out), seconds / (WORTH if candidate.certified else 1)

    return sorted(found, key=rank)


def _ways(tolerance: Fraction, outline: Outline) -> Iterator[Way]:
    """Give the arithmetics, with the digits that the tolerance needs, and what they repeat."""
    height, realisations = outline.height, outline.realisations
    room = 2 * 2 * usual_units(BigFloat(20), height)  # both sides of the comparison, and printing
    ratio = room / tolerance
    powers = ratio.numerator.bit_length() - ratio.denominator.bit_length() + 1
    digits = math.ceil(powers * math.log10(2)) + 1
    bits = budget.initial_bits(tolerance, height)
    balls = Balls(budget.initial_bits(Fraction(1, 10**25), height))
    systems: list[tuple[NumberSystem, NumberSystem]] = [
        (FLOAT64, LONGDOUBLE if LONGDOUBLE.bits > FLOAT64.bits else balls)
    ]
    if LONGDOUBLE.bits > FLOAT64.bits:
        systems.append((LONGDOUBLE, balls))
    systems.append((BigFloat(max(digits, 18)), Balls(max(bits, balls.bits) + 32)))
    for system, longer in systems:
        yield Way(system, longer, realisations)
        if realisations > FEW:
            yield Way(system, longer, FEW)
    yield Way(Balls(bits))
    if outline.route == "exact":
        yield Way(Balls(bits + _lost(outline)), plain=True)


def _lost(outline: Outline) -> int:
    """Give the bits that the plain form loses: three a layer (measured), and those of σ/r."""
    order = 1 / outline.radii.relative_std()
    return 3 * outline.height + max(
        order.numerator.bit_length() - order.denominator.bit_length(), 0
    )


def _why_not_plain(made: Plan) -> str:
    """Say why the plain form won't do; an empty string where it may."""
    why = why_not_plain(made)
    if why is not None:
        return why
    if made.region.beads != whole(made.region.width or 0, made.scene.packing.height).beads:
        return "it solves the whole packing, and the answer needs less"
    if made.system.bits > budget.MOST_BITS:
        return f"{budget.MOST_BITS} bits are the most"
    return _above(made.scene.packing.height, made.radii)


def _above(height: int, radii: Radii) -> str:
    """Say so where a packing is higher than errors can be expected for."""
    highest = critical_height(radii.relative_std())
    if height > highest * SOUND:
        return f"the height is above M*/2 = {highest / 2:.3g}, where rounding errors grow with it"
    return ""


def _why_not(
    way: Way, outline: Outline, error: Fraction, tolerance: Fraction, certified: bool
) -> str:
    """Say why an estimate won't do; an empty string where it may."""
    if certified:
        return "its error would be estimated, and certified was asked for"
    if outline.scene.effects.stop_at_tension:
        return "where the sweep stops hangs on the signs of forces, which only balls decide"
    if way.system.bits > budget.MOST_BITS:
        return f"{budget.MOST_BITS} bits are the most"
    if outline.route == "exact" and (above := _above(outline.height, outline.radii)):
        return above
    if error > tolerance:
        return f"expected to err by {short(error)}"
    return ""
