"""Decimals as written: read exactly into fractions, written with as many digits as known."""

import math
import re
from decimal import MAX_EMAX, MIN_EMIN, ROUND_DOWN, ROUND_HALF_EVEN, Context, Decimal
from fractions import Fraction
from functools import cache
from numbers import Rational

import flint

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
    if isinstance(value, bool) or not isinstance(value, Rational | flint.fmpz | flint.fmpq):
        kinds = ": whole, a Fraction, a Decimal or a float of 64 bits"
        raise ValueError(f"must be a number{kinds if hasattr(value, '__float__') else ''}")
    found = Fraction(int(value.numerator), int(value.denominator))
    if abs(found) >= _MOST or found.denominator >= _MOST**2:
        raise ValueError(f"must have at most {MOST_DIGITS} digits")
    return found


def parse(text: str) -> Fraction:
    """Read a decimal, as ``-1.5e-3``, exactly.

    >>> parse(" 0.1 ")
    Fraction(1, 10)
    """
    stripped = text.strip()
    if not _DECIMAL.fullmatch(stripped) or len(stripped) > MOST_DIGITS:
        shown = stripped if len(stripped) <= 40 else stripped[:40] + "…"
        raise ValueError(f"{shown!r} is no finite decimal number")
    return exact(Decimal(stripped))


def decimal_string(value: Fraction, error: Fraction | None) -> str:
    """Write a number with the digits that an absolute error leaves, at most 1 in the last one.

    Without an error all of an exact decimal is written, or 40 digits. A value that its error
    swallows is written as "0".

    >>> decimal_string(Fraction(2, 3), Fraction(1, 10**5)), decimal_string(Fraction(-5, 4), None)
    ('0.6667', '-1.25')
    """
    if not value:
        return "0"
    if error is None or not error:
        digits = 40
    else:
        if abs(value) < error:
            return "0"
        digits = max(_exponent(value) - _exponent(error), 1)
    return _rounded(value, digits)


def short(value: Fraction) -> str:
    """Write a number for a message, in a few digits, however far outside a float's range.

    >>> short(Fraction(1, 3)), short(Fraction(25, 10**5000))
    ('0.333333', '2.5e-4999')
    """
    if not value or Fraction(1, 10**300) < abs(value) < 10**300:
        return f"{float(value):.6g}"
    sign, figures, exponent = _figures(value, 6)
    return _scientific(sign, figures.rstrip("0"), exponent)


def _exponent(value: Fraction) -> int:
    """Give the power of ten of the leading digit, exactly.

    >>> _exponent(Fraction(1, 1000)), _exponent(Fraction(999)), _exponent(Fraction(1000))
    (-3, 2, 3)
    """
    return _divided(abs(value), _context(1, ROUND_DOWN)).adjusted()


@cache
def _context(digits: int, rounding: str = ROUND_HALF_EVEN) -> Context:
    return Context(prec=digits, rounding=rounding, Emin=MIN_EMIN, Emax=MAX_EMAX)


def _divided(value: Fraction, context: Context) -> Decimal:
    """Round a fraction, once."""
    return context.divide(Decimal(value.numerator), Decimal(value.denominator))


def bound_string(value: Fraction) -> str:
    """Write a positive bound in three digits, rounded up.

    >>> bound_string(Fraction(12301, 10**404))
    '1.24e-400'
    """
    exponent = _exponent(value)
    scaled = math.ceil(value * Fraction(10) ** (2 - exponent))
    return short(Fraction(scaled) * Fraction(10) ** (exponent - 2))


def _figures(value: Fraction, digits: int) -> tuple[str, str, int]:
    rounded = _divided(abs(value), _context(digits))
    mantissa, _, exponent = f"{rounded:.{digits - 1}e}".partition("e")
    return "-" if value < 0 else "", mantissa.replace(".", ""), int(exponent)


def _rounded(value: Fraction, digits: int) -> str:
    sign, figures, exponent = _figures(value, digits)
    if digits == 40:
        figures = figures.rstrip("0")
    if -5 <= exponent < len(figures) + 3 and exponent < 40:
        if exponent < 0:
            return f"{sign}0.{'0' * (-exponent - 1)}{figures}"
        if len(figures) <= exponent + 1:
            if digits != 40 and len(figures) < exponent + 1:
                return _scientific(sign, figures, exponent)
            return sign + figures + "0" * (exponent + 1 - len(figures))
        return f"{sign}{figures[: exponent + 1]}.{figures[exponent + 1 :]}"
    return _scientific(sign, figures, exponent)


def _scientific(sign: str, figures: str, exponent: int) -> str:
    mantissa = figures[0] + ("." + figures[1:] if len(figures) > 1 else "")
    return f"{sign}{mantissa}e{exponent:+03d}"
