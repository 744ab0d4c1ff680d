"""A tolerance chooses the arithmetic: the first of float64, pairs and balls that should do.

An expected error only orders the methods. What is promised is measured afterwards: a bound by
balls, or an estimate from a repeat, and a method whose estimate misses the tolerance gives way to
the next (see ``run``). Last come balls, whose bits are raised until their bound fits. What a scene
names is never replaced: all methods answer the same question about the same packings.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from fractions import Fraction

from ..arithmetic.carried import LONGER, PAIRS, Pairs
from ..arithmetic.decimals import short
from ..arithmetic.systems import (
    FLOAT64,
    MOST_BITS,
    Balls,
    BigFloat,
    NumberSystem,
)
from ..mechanics.problem import Problem, Route
from ..scene.sections import SceneError
from ..theory.critical_height import critical_height
from .expected_error import expected, initial_bits, usual_units
from .outline import Outline
from .plan import Candidate, Choice, Method, Plan

# Where so many realisations agree with a longer significand, the others are taken to do so, too.
FEW = 4
# Nearer to M* than this, disorder itself grows with the height, and rounding errors with it.
SOUND = 0.5
PLAIN = "exact sweep in plain form"


def choose(outlines: Sequence[Outline], tolerance: Fraction, *, certified: bool) -> Plan:
    """Give the plan of the first method that should do, with all that were looked at.

    Raises ``SceneError`` if no method is possible.
    """
    found = candidates(outlines, tolerance, certified)
    possible = [c for c in found if not c.out]
    if not possible:
        problem = outlines[0].problem
        outlines[0].plan(Method(Balls(initial_bits(tolerance, problem.height))))  # says why not
    reason = f"the first of {len(possible)} that should meet it"
    if certified:
        reason = "certified was asked for, and only balls certify"
    elif len(possible) == 1:
        reason = "the only one that should meet it"
    more, less = tolerance / 10, tolerance * 10
    choice = Choice(
        tolerance,
        reason,
        tuple(found),
        _first(outlines, more, certified),
        _first(outlines, less, certified) if less < 1 else None,
    )
    assert possible[0].plan is not None
    return replace(possible[0].plan, choice=choice)


def _first(outlines: Sequence[Outline], tolerance: Fraction, certified: bool) -> Candidate | None:
    return next((c for c in candidates(outlines, tolerance, certified) if not c.out), None)


def candidates(
    outlines: Sequence[Outline], tolerance: Fraction, certified: bool
) -> list[Candidate]:
    """Look at all methods: those that may answer first, in the order in which they are tried."""
    found: list[tuple[int, Candidate]] = []
    for outline in outlines:
        problem = outline.problem
        for order, method in _methods(tolerance, problem):
            error = expected(method, problem.height, problem.realisations)
            out = "" if method.certified else _why_not(method, problem, error, tolerance, certified)
            made = None
            try:
                made = outline.plan(method)
            except SceneError as refused:
                out = out or str(refused)
            candidate = Candidate(
                outline.algorithm, method.system.name, method.certified, method.repeated, error,
                None if made is None else made.estimated_seconds, out, None if out else made,
            )  # fmt: skip
            found.append((order, candidate))
        if problem.route == Route.EXACT and problem.dimension == 2:
            found.append((len(found), _in_plain_form(tolerance, problem)))

    def rank(one: tuple[int, Candidate]) -> tuple[bool, int, float]:
        order, candidate = one
        seconds = math.inf if candidate.seconds is None else candidate.seconds
        return bool(candidate.out), order, seconds

    return [candidate for _, candidate in sorted(found, key=rank)]


def _methods(tolerance: Fraction, problem: Problem) -> Iterator[tuple[int, Method]]:
    """Give the arithmetics in their order, with the digits that the tolerance needs."""
    height, realisations = problem.height, problem.realisations
    bits = initial_bits(tolerance, height)
    balls = Balls(initial_bits(Fraction(1, 10**25), height))
    digits = _digits(tolerance, height)
    systems: list[tuple[NumberSystem, NumberSystem]] = [(FLOAT64, LONGER), (PAIRS, PAIRS)]
    systems.append((BigFloat(digits), Balls(max(bits, balls.bits) + 32)))
    for order, (system, longer) in enumerate(systems):
        yield order, Method(system, longer, realisations)
        if realisations > FEW and system is not PAIRS:
            yield order, Method(system, longer, FEW)
    yield len(systems), Method(Balls(bits))


def _digits(tolerance: Fraction, height: int) -> int:
    """Give the decimal digits that big floats need."""
    room = 2 * 2 * usual_units(BigFloat(20), height)  # both sides of the comparison, and printing
    ratio = room / tolerance
    powers = ratio.numerator.bit_length() - ratio.denominator.bit_length() + 1
    return max(math.ceil(powers * math.log10(2)) + 1, 18)


def _in_plain_form(tolerance: Fraction, problem: Problem) -> Candidate:
    """Say what the plain form would take: three bits a layer (measured), and those of σ/r."""
    order = 1 / problem.radii.relative_std()
    size = order.numerator.bit_length() - order.denominator.bit_length()
    lost = 3 * problem.height + max(size, 0)
    method = Method(Balls(initial_bits(tolerance, problem.height) + lost))
    error = expected(method, problem.height, problem.realisations, lost)
    out = "the deviation form certifies the same with fewer bits"
    return Candidate(PLAIN, method.system.name, True, 0, error, None, out, None)


def _why_not(
    method: Method, problem: Problem, error: Fraction, tolerance: Fraction, certified: bool
) -> str:
    """Say why an estimate won't do; an empty string where it may."""
    if certified:
        return "its error would be estimated, and certified was asked for"
    if isinstance(method.system, BigFloat) and not isinstance(method.system, Pairs):
        return "balls of as many digits take less time, and certify"
    if problem.stop_at_tension:
        return "where the sweep stops hangs on the signs of forces, which only balls decide"
    if method.system.bits > MOST_BITS:
        return f"{MOST_BITS} bits are the most"
    highest = critical_height(problem.radii.relative_std())
    if problem.route == Route.EXACT and problem.height > highest * SOUND:
        return f"the height is above M*/2 = {highest / 2:.3g}, where rounding errors grow with it"
    if error > tolerance:
        return f"expected to err by {short(error)}"
    return ""
