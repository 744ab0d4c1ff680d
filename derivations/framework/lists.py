"""Lists in words."""

from collections.abc import Sequence


def either(words: Sequence[str]) -> str:
    """Alternatives in words.

    >>> either(["a", "b", "c"])
    'a, b or c'
    """
    *others, last = words
    return f"{', '.join(others)} or {last}" if others else last


def both(words: Sequence[str]) -> str:
    """Several things in words.

    >>> both(["Eq. 1", "step 1", "step 2"])
    'Eq. 1, step 1 and step 2'
    """
    *others, last = words
    return f"{', '.join(others)} and {last}" if others else last
