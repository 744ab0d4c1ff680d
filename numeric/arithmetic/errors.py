"""The errors that users see.

All derive from ``ForceDiffusionError``, which carries the exit status of the command line.
"""

import inspect
from collections.abc import Callable, Iterable
from functools import wraps
from operator import index
from typing import TYPE_CHECKING, Any, ClassVar, ParamSpec, TypeGuard, TypeVar

if TYPE_CHECKING:
    from pydantic import ValidationError

P = ParamSpec("P")
T = TypeVar("T")
WRONG_INPUT, NOT_REACHED = 2, 3
LONGEST = 200
"""Characters of what messages quote."""


def printable(text: str) -> str:
    r"""Text from outside without what a terminal would obey: escapes, controls, broken UTF-8.

    >>> print(printable("\x1b[2J\u2028\udcff é"))
    \x1b[2J\u2028\udcff é
    """
    return "".join(
        c if c.isprintable() or c == "\n" else c.encode("unicode_escape").decode() for c in text
    )


class ForceDiffusionError(Exception):
    """Bad input or a failed environment; the message says what was wrong, where, and what to do.

    ``exit_status``: 2 if the input is wrong; 3 if what was asked for can't be reached, or
    something outside the program failed.
    """

    exit_status: ClassVar[int] = WRONG_INPUT

    def __str__(self) -> str:
        """Give the message; what it quotes can't command a terminal."""
        return printable(super().__str__())


class ArgumentError(ForceDiffusionError, ValueError):
    """An argument is not allowed; the message says what is."""


class WrongTypeError(ForceDiffusionError, TypeError):
    """A value has a wrong type, or an argument is unknown."""


class NotReachedError(ForceDiffusionError):
    """What was asked for can't be reached, with the memory, range, libraries or bits at hand."""

    exit_status = NOT_REACHED


class MissingLibraryError(NotReachedError):
    """An optional library is not installed; the message says how to install it."""


class UndecidedError(NotReachedError, ArithmeticError):
    """Balls are too wide to answer a question, so more bits are needed."""


def quoted(value: object) -> str:
    """Show a value as Python writes it, in at most 200 characters.

    >>> quoted("13"), quoted(10**5000)
    ("'13'", '<a number of more than 4300 digits>')
    """
    try:
        text = repr(value)
    except RecursionError:
        return "<what is nested too deeply>"
    except ValueError:
        return "<a number of more than 4300 digits>"
    return text if len(text) <= LONGEST else f"{text[: LONGEST - 1]}…"


def suggestion(name: str, known: Iterable[str]) -> str:
    """Say which of the known names could be meant; "" if none is close.

    >>> suggestion("spacng", ["radii", "spacing"]), suggestion("std", ["seed", "relative_std"])
    ('did you mean spacing? ', 'did you mean relative_std? ')
    """
    from difflib import get_close_matches  # of wrong names alone

    names, word = list(known), name[:LONGEST]
    close = [each for each in names if word.strip('"') in each.strip('"').split("_")]
    close = close or get_close_matches(word, names, n=1)
    return f"did you mean {close[0]}? " if close else ""


def checked(function: Callable[P, T]) -> Callable[P, T]:
    """Let a function raise ``WrongTypeError`` for a keyword that it doesn't take."""
    parameters = inspect.signature(function).parameters
    names = [name for name in parameters if name != "self"]

    @wraps(function)
    def call(*args: P.args, **kwargs: P.kwargs) -> T:
        for name in kwargs:
            if name not in names:
                takes = f"{function.__name__} takes {', '.join(names)}"
                raise WrongTypeError(
                    f"there is no argument {quoted(name)}; {suggestion(name, names)}{takes}"
                )
        return function(*args, **kwargs)

    return call


def is_whole(value: Any, least: int, most: int) -> TypeGuard[int]:
    """Say whether a value is a whole number, NumPy's included, from ``least`` to ``most``.

    >>> is_whole(3, 1, 3), is_whole(3.0, 1, 3), is_whole(4, 1, 3)
    (True, False, False)
    """
    try:
        return least <= index(value) <= most
    except TypeError:  # arrays have ``__index__``, too
        return False


def check_progress(progress: object) -> None:
    """Raise ``WrongTypeError`` if ``progress`` is neither a truth value nor a function."""
    if not (isinstance(progress, bool) or callable(progress)):
        raise WrongTypeError(f"progress must be True, False or a function, not {quoted(progress)}")


def rule(error: "ValidationError") -> str:
    """Say what pydantic's first error asks of a value."""
    first = error.errors()[0]
    context: dict[str, Any] = first.get("ctx", {})
    match first["type"]:
        case "greater_than_equal":
            return f"must be at least {context['ge']}"
        case "less_than_equal":
            return f"must be at most {context['le']}"
        case "int_type" | "int_parsing" | "int_from_float":
            return "must be a whole number, written without a decimal point or exponent"
        case "float_type" | "float_parsing":
            return "must be a number"
        case "value_error":
            return str(context["error"])
    return first["msg"].lower().replace("input should", "must").replace("string should", "must")
