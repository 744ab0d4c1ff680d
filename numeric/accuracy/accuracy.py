"""What is known of an answer's error, and its numbers printed with the digits that this leaves."""

import math
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import flint
import numpy as np

from ..arithmetic.decimals import short
from ..arithmetic.errors import NOT_REACHED, ForceDiffusionError
from ..arithmetic.systems import FLOAT64, Array, Balls, NumberSystem, as_ball, as_floats
from ..quantities.base import RATIO, SCATTER_OF, Table
from ..tables import significant, text_of

# An estimated bound is twice what was measured or more: a number within half of it is printed as 0,
# which is then off by its size and by its own error, together no more than the bound.
SWALLOWED = 2


@dataclass(frozen=True)
class Accuracy:
    """Error of the answer's small columns, relative to the largest entry of them.

    ``certified``: a rigorous bound (balls). Otherwise it is estimated, from errors that the sweep
    carried, or from a second solution with a longer significand. ``bits_lost``: bits of the
    arithmetic that the answer lacks. A bound below what a float can hold is a fraction.
    """

    error_bound: float | Fraction
    certified: bool
    arithmetic: str
    bits_lost: float
    note: str = ""

    def within(self, tolerance: Fraction) -> bool:
        """Say whether the error is at most as large."""
        bound = self.error_bound
        return math.isfinite(bound) and Fraction(bound) <= tolerance

    @property
    def still(self) -> str:
        """Say how large the error still is."""
        if not math.isfinite(self.error_bound):
            return "nothing is left of the answer"
        return f"the error is still {short(Fraction(self.error_bound))}"


class ToleranceError(ForceDiffusionError, ArithmeticError):
    """The asked tolerance can't be reached; the message says why."""

    exit_status = NOT_REACHED


def most_digits(system: Balls) -> int:
    """Give the digits to which even an exact number is printed."""
    return int(system.bits * 0.30103) + 1


def printed(
    table: Table, accuracy: Accuracy, system: NumberSystem, *, sampled: bool
) -> dict[str, Array]:
    """Give the number columns as text (see ``tables``), each number with the digits that are known.

    Standard errors stand beside their columns, with three digits, and nothing where they are not
    known. ``sampled``: whether to leave out digits that would be others in another sample.
    """
    numbers: dict[str, Array] = {}
    for name, column in table.numbers.items():
        sampling = _of_sampling(table, name) if sampled else 0.0
        if system is FLOAT64 or np.any(sampling):  # what scatters needs no more than a float has
            error = _of_arithmetic(table, name, accuracy)
            numbers[name] = known_digits(as_floats(column), error, sampling)
        elif isinstance(system, Balls):
            most = most_digits(system)
            numbers[name] = text_of([_ball_string(v, most) for v in column])
        else:
            numbers[name] = text_of(_long_strings(table, name, accuracy, system))
        if name in table.errors:
            numbers[f"{name}_error"] = of_errors(table.errors[name])
    return numbers


def of_errors(errors: Array) -> Array:
    """Write standard errors with three digits; nothing where there is none."""
    text = significant(errors, np.full(len(errors), 3))
    text[~np.isfinite(errors)] = 0
    return text


def _of_arithmetic(table: Table, name: str, accuracy: Accuracy) -> Array | float:
    """Give the absolute error of a column, but for how it would scatter."""
    small = [as_floats(abs(table.numbers[k])) for k in table.small]
    largest = max((float(one.max(initial=0)) for one in small), default=0)
    bound = float(accuracy.error_bound) * largest if math.isfinite(accuracy.error_bound) else np.inf
    return bound / _over(table, name)


def _of_sampling(table: Table, name: str) -> Array | float:
    """Give the standard errors of a column, 0 where they are not known."""
    errors = table.errors.get(name if name in table.errors else SCATTER_OF.get(name, ""))
    return 0.0 if errors is None else np.nan_to_num(errors, posinf=np.inf) / _over(table, name)


def _over(table: Table, name: str) -> Array | float:
    """The error of σ_f/⟨f⟩ is that of σ_f over ⟨f⟩, since ⟨f⟩ is known far better."""
    return abs(as_floats(table.numbers["mean"])) if name == RATIO else 1.0


def _long_strings(table: Table, name: str, accuracy: Accuracy, system: NumberSystem) -> list[str]:
    """Print numbers that a float can't hold, two digits beyond their error."""
    error, unit = flint.arb(0), flint.arb((1, 1 - system.bits))
    for small in table.small:
        for value in table.numbers[small]:
            error = error.max(abs(as_ball(value)))
    bound = Fraction(accuracy.error_bound)
    error = error * flint.arb(flint.fmpq(bound.numerator, bound.denominator))
    scales = table.numbers["mean"] if name == RATIO else [1.0] * table.rows
    exact = map(as_ball, table.numbers[name])
    return [
        _two_beyond(value, error / abs(as_ball(scale)) + abs(value) * unit)
        for value, scale in zip(exact, scales, strict=True)
    ]


def _two_beyond(value: Any, error: Any) -> str:
    if not SWALLOWED * abs(value) > error:
        return "0"
    # powers of two, from which the digits follow within one
    digits = (_power(value) - _power(error)) * 0.30103
    return str(value.str(math.ceil(digits) + 3, radius=False))


def _power(value: Any) -> int:
    mantissa, exponent = value.mid().man_exp()
    return int(mantissa).bit_length() + int(exponent)


def _ball_string(value: Any, most: int) -> str:
    if value.contains(0):
        return "0"
    return str(value.str(most, radius=False))


def known_digits(column: Array, error: Array | float, sampling: Array | float = 0.0) -> Array:
    """Write float64 as text, up to two digits beyond its absolute errors.

    A number that the ``error`` of its arithmetic swallows is 0; ``sampling`` swallows none.
    """
    size = np.abs(column)
    with np.errstate(all="ignore"):
        off = error + size * 2.0**-52
        known = np.isfinite(column) & (SWALLOWED * size > off)
        # two digits beyond the error: cutting the rest off adds at most a twentieth of it
        seen = np.floor(np.log10(np.maximum(off, sampling)))
        digits = np.floor(np.log10(size)) - seen + 2
    digits = np.where(known, np.clip(digits, 1, 17), 1).astype(np.int64)
    text = significant(np.where(known | ~np.isfinite(column), column, 0.0), digits)
    text[np.isnan(column)] = 0
    return text
