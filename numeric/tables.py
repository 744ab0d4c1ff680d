"""Results as rows, as tables to be looked at, and as columns of text, all rows at once.

A column of text is a matrix of bytes, a row each, in which zero bytes stand for nothing and are
dropped in the end: so CSV and JSON are written in less time than solving takes.
"""

import math
from collections.abc import Iterable, Mapping, Sequence
from decimal import Decimal
from fractions import Fraction
from functools import cache
from html import escape
from typing import Any

import numpy as np

from .arithmetic.systems import Array

Row = dict[str, Any]
SHOWN = 20
# Rows that are worked on together: they fit into a cache.
BLOCK = 8192
MOST = 17  # digits that tell all doubles apart
# Numbers within 10^±BULK are written here, the few others one by one.
BULK = 250


def rows_of(columns: Mapping[str, Array]) -> list[Row]:
    """Give arrays of equal length row by row, ready for a data frame.

    Numbers become Python's int and float, those of other arithmetics (mpmath, balls) floats.

    >>> import numpy as np
    >>> rows_of({"j": np.arange(2), "std": np.array([0.5, 0.25])})
    [{'j': 0, 'std': 0.5}, {'j': 1, 'std': 0.25}]
    """
    lists = [
        [float(value) for value in column] if column.dtype == object else column.tolist()
        for column in columns.values()
    ]
    return [dict(zip(columns, row, strict=True)) for row in zip(*lists, strict=True)]


def columns_of(rows: Sequence[Mapping[str, Any]]) -> dict[str, Array]:
    """Give rows as arrays of shape (rows,); where a number is missing, it is NaN.

    >>> columns_of([{"way": "a", "bound": None}, {"way": "b", "bound": 0.5}])
    {'way': array(['a', 'b'], dtype='<U1'), 'bound': array([nan, 0.5])}
    """
    columns = {name: [row[name] for row in rows] for name in (rows[0] if rows else {})}
    return {
        name: np.array(
            [math.nan if value is None else value for value in column] if None in column else column
        )
        for name, column in columns.items()
    }


def plain(row: Mapping[str, Any]) -> Row:
    """Give a row with floats in place of decimals, ready for a data frame."""
    return {n: float(value) if isinstance(value, Decimal) else value for n, value in row.items()}


def text_table(rows: Sequence[Mapping[str, Any]]) -> list[str]:
    """Give rows as lines of text below their names: words to the left, numbers to the right.

    >>> print("\\n".join(text_table([{"way": "a", "error": 1e-9}, {"way": "bc", "error": None}])))
    way  error
    a    1e-09
    bc
    """
    names = list(rows[0]) if rows else []
    lines = [names, *([_text(row[name]) for name in names] for row in rows)]
    adjusted = []
    for name, column in zip(names, zip(*lines, strict=True), strict=True):
        width = max(map(len, column))
        words = any(isinstance(row[name], str) and row[name][:1].isalpha() for row in rows)
        adjusted.append([one.ljust(width) if words else one.rjust(width) for one in column])
    return ["  ".join(line).rstrip() for line in zip(*adjusted, strict=True)]


def _text(value: Any) -> str:
    if isinstance(value, float):
        return f"{value:.3g}"
    return "" if value is None else str(value)


def html_table(
    rows: Sequence[Mapping[str, Any]], words: Iterable[str], count: int | None = None
) -> str:
    """Show the first of ``count`` rows as a table in HTML, and lines of words below it."""
    left = (len(rows) if count is None else count) - SHOWN
    heads = "".join(f"<th>{escape(name)}</th>" for name in (rows[0] if rows else {}))
    body = "".join(
        "<tr>" + "".join(f"<td>{_cell(value)}</td>" for value in row.values()) + "</tr>"
        for row in rows[:SHOWN]
    )
    more = f"<p>… and {left} more rows</p>" if left > 0 else ""
    below = "<br>".join(map(escape, words))
    return f"<table><tr>{heads}</tr>{body}</table>{more}<p>{below}</p>"


def _cell(value: Any) -> str:
    if value is None:
        return ""
    return escape(f"{value:.6g}" if isinstance(value, float) else str(value))


def significant(values: Array, digits: Array) -> Array:
    """Write float64 with 1 to 17 significant digits each, as ``f"{value:.{digits}g}"`` does.

    >>> strings(significant(np.array([0.75, -1.25e-7]), np.array([17, 2])))
    ['0.75', '-1.2e-07']
    """
    blocks = [
        _significant(values[at : at + BLOCK], digits[at : at + BLOCK])
        for at in range(0, len(values), BLOCK)
    ]
    width = max((block.shape[1] for block in blocks), default=0)
    found = np.zeros((len(values), width), np.uint8)
    for n, block in enumerate(blocks):
        found[n * BLOCK : n * BLOCK + len(block), : block.shape[1]] = block
    return found


def _significant(values: Array, digits: Array) -> Array:
    size = np.abs(values)
    with np.errstate(divide="ignore", invalid="ignore"):
        power = np.floor(np.log10(size))
        usual = np.abs(power) < BULK
    power = np.where(usual, power, 0).astype(np.int64)
    size = np.where(usual, size, 1.0)
    high, low = (part[power + BULK + MOST] for part in _powers())
    power -= (size < high) | ((size == high) & (low > 0))  # where the logarithm was rounded up
    whole, sure = _scaled(size, digits - 1 - power)
    # what is rounded up to a power of ten has a digit too many
    sure &= usual & (whole >= _WHOLE_POWERS[digits - 1]) & (whole < _WHOLE_POWERS[digits])
    figures = _figures(np.where(sure, whole * _WHOLE_POWERS[MOST - digits], 0))
    zero = values == 0
    others = np.flatnonzero(~(sure | zero))
    one_by_one = {int(n): f"{values[n]:.{digits[n]}g}" for n in others}
    width = max([MOST + 7, *map(len, one_by_one.values())])
    text = np.zeros((len(values), width), np.uint8)
    fixed = (power >= -4) & (power < digits)
    layout = power + BULK + np.where(fixed, 0, 2 * BULK)
    for key in np.flatnonzero(np.bincount(layout[sure], minlength=1)).tolist():
        rows = np.flatnonzero(sure & (layout == key))
        form, exponent = divmod(key, 2 * BULK)
        laid = (_scientific if form else _fixed)(figures[rows], exponent - BULK)
        text[rows, 1 : laid.shape[1] + 1] = laid
    text[zero, 1] = ord("0")
    text[:, 0] = np.where(np.signbit(values), ord("-"), 0)
    for n, shown in one_by_one.items():
        text[n] = 0
        text[n, : len(shown)] = np.frombuffer(shown.encode(), np.uint8)
    return text


_WHOLE_POWERS = 10 ** np.arange(MOST + 1, dtype=np.int64)


@cache
def _powers() -> tuple[Array, Array]:
    """Give 10^k for |k| ≤ BULK + MOST as sums of two doubles."""
    exact = [Fraction(10) ** k for k in range(-BULK - MOST, BULK + MOST + 1)]
    high = [float(value) for value in exact]
    low = [float(value - Fraction(near)) for value, near in zip(exact, high, strict=True)]
    return np.array(high), np.array(low)


def _scaled(size: Array, power: Array) -> tuple[Array, Array]:
    """Round size × 10^power to whole numbers, and say which are sure: no tie, as far as 2^-90."""
    high, low = (part[power + BULK + MOST] for part in _powers())
    product = size * high
    size_high, size_low = _halves(size)
    high_high, high_low = _halves(high)
    lost = size_low * high_low - (
        ((product - size_high * high_high) - size_low * high_high) - size_high * high_low
    )
    near = np.rint(product)
    rest = (product - near) + (lost + size * low)
    step = np.rint(rest)
    return near.astype(np.int64) + step.astype(np.int64), np.abs(rest - step) < 0.5 - 1e-6


def _halves(value: Array) -> tuple[Array, Array]:
    """Cut doubles into two halves of 26 bits (Dekker)."""
    much = value * 134217729.0
    high = much - (much - value)
    return high, value - high


@cache
def _quads() -> Array:
    """Give four figures as one number of 32 bits; then the same without zeros at their end."""
    listed = [f"{n:04d}".encode() for n in range(10_000)]
    whole = b"".join([*listed, *(four.rstrip(b"0").ljust(4, b"\0") for four in listed)])
    return np.frombuffer(whole, np.uint32)


def _figures(whole: Array) -> Array:
    """Give the 17 decimal figures of whole numbers, shape (rows, 17); zeros at the end are 0."""
    fours = -(-MOST // 4)
    found = np.empty((len(whole), fours), np.uint32)
    nothing_follows = np.full(len(whole), True)
    for n in reversed(range(fours)):
        rest = whole // 10_000
        four = whole - rest * 10_000
        found[:, n] = _quads()[four + 10_000 * nothing_follows]
        nothing_follows &= four == 0
        whole = rest
    return found.view(np.uint8)[:, 4 * fours - MOST :]


def _fixed(figures: Array, power: int) -> Array:
    if power < 0:
        lead = np.frombuffer(b"0." + b"0" * (-power - 1), np.uint8)
        return np.hstack([np.broadcast_to(lead, (len(figures), len(lead))), figures])
    before, after = figures[:, : power + 1], figures[:, power + 1 :]
    point = np.where(after[:, :1] > 0, ord("."), 0).astype(np.uint8)
    return np.hstack([np.where(before > 0, before, ord("0")).astype(np.uint8), point, after])


def _scientific(figures: Array, power: int) -> Array:
    point = np.where(figures[:, 1:2] > 0, ord("."), 0).astype(np.uint8)
    tail = np.frombuffer(f"e{power:+03d}".encode(), np.uint8)
    tails = np.broadcast_to(tail, (len(figures), len(tail)))
    return np.hstack([figures[:, :1], point, figures[:, 1:], tails])


def text_of(column: Sequence[object] | Array) -> Array:
    """Write whole numbers, or words without quotes and commas, as text.

    >>> strings(text_of([3, -12])), strings(text_of(["+", "-"]))
    (['3', '-12'], ['+', '-'])
    """
    values = np.asarray(column)
    if values.dtype.kind == "i" and len(values):
        low, high = int(values.min()), int(values.max())
        if high - low < max(len(values), 1000):  # few numbers, many times
            listed = np.array([b"%d" % n for n in range(low, high + 1)])
            return np.asarray(_bytes(listed)[values - low])
    return _bytes(values.astype("S"))


def _bytes(values: Array) -> Array:
    return values.view(np.uint8).reshape(len(values), values.dtype.itemsize)


def strings(text: Array) -> list[str]:
    """Give a column of text as strings."""
    if not len(text):
        return []
    ended = np.hstack([text, np.full((len(text), 1), ord("\n"), np.uint8)])
    return ended.tobytes().translate(None, b"\0").decode().split("\n")[:-1]


def rows_of_text(columns: Mapping[str, Array], whole: Sequence[str]) -> list[dict[str, Any]]:
    """Give columns of text row by row: those that are ``whole`` as int, the others as strings."""
    listed = [
        list(map(int, strings(text))) if name in whole else strings(text)
        for name, text in columns.items()
    ]
    return [dict(zip(columns, row, strict=True)) for row in zip(*listed, strict=True)]


def csv_bytes(columns: Mapping[str, Array]) -> bytes:
    """Write columns of text as CSV: a header, and the rows."""
    if not columns:
        return b""
    parts = [part for text in columns.values() for part in (text, b",")]
    return ",".join(columns).encode() + b"\n" + _rows([*parts[:-1], b"\n"])


def json_rows(columns: Mapping[str, Array], bare: Sequence[str]) -> bytes:
    """Write columns of text as JSON objects, a line a row; all but the ``bare`` are strings."""
    if not columns or not len(next(iter(columns.values()))):
        return b""
    parts: list[Array | bytes] = []
    for n, (name, text) in enumerate(columns.items()):
        quote = "" if name in bare else '"'
        parts += [f'{", " if n else "      {"}"{name}": {quote}'.encode(), text, quote.encode()]
    return _rows([*parts, b"},\n"])[:-2]


def _rows(parts: Sequence[Array | bytes]) -> bytes:
    """Put columns of text and what stands between them side by side."""
    count = next(len(part) for part in parts if not isinstance(part, bytes))
    widths = [len(part) if isinstance(part, bytes) else part.shape[1] for part in parts]
    found = []
    for at in range(0, count, BLOCK):
        rows = np.empty((min(BLOCK, count - at), sum(widths)), np.uint8)
        left = 0
        for part, width in zip(parts, widths, strict=True):
            put = (
                np.frombuffer(part, np.uint8) if isinstance(part, bytes) else part[at : at + BLOCK]
            )
            rows[:, left : left + width] = put
            left += width
        found.append(rows.tobytes().translate(None, b"\0"))
    return b"".join(found)
