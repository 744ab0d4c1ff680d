"""What is known of an answer's error."""

import math
from dataclasses import dataclass
from fractions import Fraction

from ..arithmetic.decimals import short
from ..arithmetic.errors import NOT_REACHED, ForceDiffusionError


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
