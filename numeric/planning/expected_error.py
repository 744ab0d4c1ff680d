"""The error that a method is expected to answer with, before anything runs."""

from fractions import Fraction

from ..arithmetic.systems import FLOAT64, NumberSystem
from .plan import Method

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
