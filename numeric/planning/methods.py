"""A tolerance chooses the arithmetic: the first of float64, pairs and balls that should do.

What is promised is measured afterwards: a bound by balls, or an estimate, and a method whose
estimate misses the tolerance gives way to the next (see ``run``). Last come balls, whose bits are
raised until their bound fits. What a scene names is never replaced: all methods answer the same
question about the same packings.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction

from ..arithmetic.carried import LONGER, PAIRS, Pairs
from ..arithmetic.decimals import short
from ..arithmetic.systems import FLOAT64, Balls, NumberSystem
from ..mechanics.problem import Problem, Route
from ..theory.expected import critical_height

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


@dataclass(frozen=True)
class Method:
    """An arithmetic, and how the error of its answer becomes known.

    In float64 and pairs, sweeps of the first ``repeated`` realisations carry their errors, and
    ``longer`` holds both together; what is longer still is repeated in ``longer``. None stands for
    balls, which certify.
    """

    system: NumberSystem
    longer: NumberSystem | None = None
    repeated: int = 0

    @property
    def certified(self) -> bool:
        """Whether the error is a rigorous bound."""
        return isinstance(self.system, Balls)

    @property
    def carries(self) -> bool:
        """Whether sweeps carry their own errors."""
        return self.system is FLOAT64 or isinstance(self.system, Pairs)


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


def methods(tolerance: Fraction, problem: Problem) -> Iterator[Method]:
    """Give what is tried, in that order; few realisations are repeated rather than all."""
    if problem.realisations > FEW:
        yield Method(FLOAT64, LONGER, FEW)
    yield Method(FLOAT64, LONGER, problem.realisations)
    yield Method(PAIRS, PAIRS, problem.realisations)
    yield Method(Balls(initial_bits(tolerance, problem.height)))


def why_not(
    method: Method, problem: Problem, error: Fraction, tolerance: Fraction, *, certified: bool
) -> str:
    """Say why a method won't do; an empty string where it may."""
    if method.certified:
        return ""
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
