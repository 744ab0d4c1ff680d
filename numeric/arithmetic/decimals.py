"""Decimals as written: read exactly into fractions, written with as many digits as known."""

import math
import re
from decimal import MAX_EMAX, MIN_EMIN, ROUND_HALF_EVEN, Context, Decimal
from fractions import Fraction
from numbers import Rational
from typing import Any, TypeAlias

from .errors import quoted

Exact: TypeAlias = float | Fraction | Decimal | str
"""What is read as the exact number that it is, or that it is written as."""
LARGEST_EXPONENT = 5000
MOST_DIGITS = 5000
_MOST = 10**MOST_DIGITS
_DECIMAL = re.compile(r"[+-]?([0-9]+(\.[0-9]*)?|\.[0-9]+)([eE][+-]?[0-9]{1,6})?", re.ASCII)


def exact(value: object) -> Fraction:
    """Turn a number into the fraction that it is; a float into the decimal that Python prints.

    Whole and rational numbers may be those of NumPy, SymPy or python-flint. Raises ``ValueError``
    for anything else, longer floats too, and for more than 5000 digits or an exponent beyond ±5000:
    such a number is an accident, or a way to fill the memory.

    >>> exact(Decimal("2.2")), exact(0.1)
    (Fraction(11, 5), Fraction(1, 10))
    """
    if isinstance(value, float):
        value = Decimal(repr(float(value)))
    if isinstance(value, Decimal):
        if not value.is_finite():
            raise ValueError("must be a finite number")
        if len(value.as_tuple().digits) > MOST_DIGITS or abs(value.adjusted()) > LARGEST_EXPONENT:
            raise ValueError(
                f"must have at most {MOST_DIGITS} digits and an exponent within ±{LARGEST_EXPONENT}"
            )
        return Fraction(value)
    number: Any = value
    rational = isinstance(value, Rational) or type(value).__name__ in {"fmpz", "fmpq"}
    if isinstance(value, bool) or not rational:
        kinds = ": whole, a Fraction, a Decimal or a float of 64 bits"
        raise ValueError(f"must be a number{kinds if hasattr(value, '__float__') else ''}")
    fraction = Fraction(int(number.numerator), int(number.denominator))
    long = max(fraction.numerator.bit_length(), fraction.denominator.bit_length()) > MOST_DIGITS
    if long and (abs(fraction) >= _MOST or fraction.denominator >= _MOST**2):
        raise ValueError(f"must have at most {MOST_DIGITS} digits")
    return fraction


def parse(text: str) -> Fraction:
    """Read a decimal, as ``-1.5e-3``, exactly.

    >>> parse(" 0.1 ")
    Fraction(1, 10)
    """
    stripped = text.strip()
    if not _DECIMAL.fullmatch(stripped) or len(stripped) > MOST_DIGITS:
        raise ValueError(f"{quoted(stripped)} is not a finite decimal number")
    return exact(Decimal(stripped))


def nearest(value: Fraction) -> float:
    """Round to a float, which may be infinite."""
    try:
        return float(value)
    except OverflowError:
        return math.inf if value > 0 else -math.inf


def decimal_string(value: Fraction) -> str:
    """Write all of an exact decimal, or 40 digits.

    >>> decimal_string(Fraction(-5, 4)), decimal_string(Fraction(1, 8 * 10**6))
    ('-1.25', '1.25e-07')
    """
    number = _rounded(value, 40)
    if -5 <= number.adjusted() < min(len(number.as_tuple().digits) + 3, 40):
        return f"{number:f}"
    return _scientific(number)


def short(value: Fraction, digits: int = 6) -> str:
    """Write a number, for a message in a few digits, however far outside a float's range.

    >>> short(Fraction(1, 3)), short(Fraction(25, 10**5000))
    ('0.333333', '2.5e-4999')
    """
    if not value or Fraction(1, 10**300) < abs(value) < 10**300:
        return f"{float(value):.{digits}g}"
    return _scientific(_rounded(value, digits))


def bound_string(value: Fraction) -> str:
    """Write a positive bound in three digits, rounded up.

    >>> bound_string(Fraction(12301, 10**404))
    '1.24e-400'
    """
    exponent = _rounded(value, 6).adjusted()
    scaled = math.ceil(value * Fraction(10) ** (2 - exponent))
    return short(Fraction(scaled) * Fraction(10) ** (exponent - 2))


def _rounded(value: Fraction, digits: int) -> Decimal:
    """Round to so many digits, and drop zeros at the end."""
    context = Context(prec=digits, rounding=ROUND_HALF_EVEN, Emin=MIN_EMIN, Emax=MAX_EMAX)
    numerator, denominator = Decimal(value.numerator), Decimal(value.denominator)
    return context.normalize(context.divide(numerator, denominator))


def _scientific(number: Decimal) -> str:
    mantissa, _, exponent = f"{number:e}".partition("e")
    return f"{mantissa}e{int(exponent):+03d}"
