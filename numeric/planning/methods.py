"""A tolerance chooses the arithmetic: the first of float64, pairs and balls that should do.

What is promised is measured afterwards: a bound by balls, or an estimate, and a method whose
estimate misses the tolerance gives way to the next (see ``run``). Last come balls, whose bits are
raised until their bound fits. What a scene names is never replaced: all methods answer the same
question about the same packings.
"""

from collections.abc import Callable, Iterator
from dataclasses import replace
from fractions import Fraction

from ..arithmetic.carried import LONGER, PAIRS, Pairs
from ..arithmetic.decimals import short
from ..arithmetic.systems import FLOAT64, Balls, NumberSystem
from ..mechanics.problem import Problem, Route
from ..scene.sections import SceneError
from ..theory.critical_height import critical_height
from .plan import Candidate, Choice, Method, Plan

# Where so many realisations agree with a longer significand, the others are taken to do so, too;
# one is enough of packings that are not small.
FEW, SMALL = 4, 20_000
# To which packings are enclosed whose contacts open, relative to the largest force.
TOUCHING = Fraction(1, 10**17)
# Nearer to M* than this, disorder itself grows with the height, and rounding errors with it.
SOUND = 0.5
# A measured error is doubled: what repeats it is not exact.
SAFETY = 2
# Realisations that nobody repeated. Rounding errors of independent packings are alike, and near
# normal: of N numbers the largest is below 6 standard deviations for every N that is allowed, and
# that the largest of four is below 6/1000 of one has a chance of 5e-10.
UNSEEN = 1000
# Room for printing: a number that its error swallows is printed as 0, and digits are cut off.
PRINTED = 2


def usual_units(system: NumberSystem, height: int) -> Fraction:
    """Give the largest rounding error to be expected, in units 2^-bits of the largest change.

    Measured up to height 128, in all quantities, loads and geometries, from σ/r = 1e-3 down to
    1e-100: at most 17, growing with the height. Hardware floats sum forces with compensation, big
    floats do not.
    """
    return Fraction(8) + (Fraction(height, 4) if system.dtype is not object else 2 * height)


def initial_bits(tolerance: Fraction, height: int) -> int:
    """Choose a first precision for balls: the digits asked for, the loss up and down, a margin."""
    digits = max(tolerance.denominator.bit_length() - tolerance.numerator.bit_length(), 0)
    return digits + 4 * height.bit_length() + 48


def expected(method: Method, height: int, realisations: int) -> Fraction:
    """Give the error that an answer is expected to be printed with, relative to its largest change.

    For balls, what they should certify: they lose some bits for the depth of the packing.
    """
    bits = method.system.bits
    if method.certified:
        return Fraction(max(height, 4) ** 2 * 2**12, 2**bits)
    if method.repeated >= realisations:  # all sweeps carry their errors
        few = 4 if method.system is FLOAT64 else 8 * height
        return Fraction(PRINTED * few, 2**bits)
    units = usual_units(method.system, height) * UNSEEN
    return (PRINTED * units + merging(method, realisations)) * Fraction(1, 2**bits)


def merging(method: Method, realisations: int) -> int:
    """Bound the roundings of merged statistics, in units 2^-bits: a few for each realisation."""
    return 0 if method.repeated >= realisations else 8 * realisations


def usual_method(problem: Problem, system: NumberSystem, *, merged: bool) -> Method:
    """Say how the error becomes known of an answer in this arithmetic, without a tolerance."""
    if isinstance(system, Balls):
        return Method(system)
    n = problem.realisations
    few = min(n, FEW if problem.region.beads < SMALL else 1)
    if system is FLOAT64:
        return Method(system, LONGER, few if merged else n)
    if isinstance(system, Pairs):
        return Method(system, system, few if merged else n)
    return Method(system, Balls(system.bits + 128), few)


def choose(
    planned: Callable[[Method], Plan],
    problem: Problem,
    algorithm: str,
    tolerance: Fraction,
    *,
    certified: bool,
) -> Plan:
    """Give the plan of the first method that should do, with all that were looked at.

    Raises ``SceneError`` if no method is possible.
    """
    found: list[Candidate] = []
    for method in _methods(tolerance, problem):
        error = expected(method, problem.height, problem.realisations)
        out = "" if method.certified else _why_not(method, problem, error, tolerance, certified)
        made = None
        try:
            made = planned(method)
        except SceneError as refused:
            out = out or str(refused)
        found.append(Candidate(algorithm, method, error, out, None if out else made))
    possible = [candidate for candidate in found if not candidate.out]
    if not possible:
        planned(Method(Balls(initial_bits(tolerance, problem.height))))  # says why not
    reason = f"the first of {len(possible)} that should meet it"
    if certified:
        reason = "certified was asked for, and only balls certify"
    elif len(possible) == 1:
        reason = "the only one that should meet it"
    found.sort(key=lambda candidate: bool(candidate.out))
    first = found[0].plan
    assert first is not None
    return replace(first, choice=Choice(tolerance, reason, tuple(found)))


def _methods(tolerance: Fraction, problem: Problem) -> Iterator[Method]:
    """Give the arithmetics in their order; few realisations are repeated rather than all."""
    if problem.realisations > FEW:
        yield Method(FLOAT64, LONGER, FEW)
    yield Method(FLOAT64, LONGER, problem.realisations)
    yield Method(PAIRS, PAIRS, problem.realisations)
    yield Method(Balls(initial_bits(tolerance, problem.height)))


def _why_not(
    method: Method, problem: Problem, error: Fraction, tolerance: Fraction, certified: bool
) -> str:
    """Say why an estimate won't do; an empty string where it may."""
    if certified:
        return "its error would be estimated, and certified was asked for"
    if problem.stop_at_tension:
        return "where the sweep stops hangs on the signs of forces, which only balls decide"
    highest = critical_height(problem.radii.relative_std())
    if problem.route == Route.EXACT and problem.height > highest * SOUND:
        return f"the height is above M*/2 = {highest / 2:.3g}, where rounding errors grow with it"
    if error > tolerance:
        return f"expected to err by {short(error)}"
    return ""
