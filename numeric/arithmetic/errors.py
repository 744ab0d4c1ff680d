"""The errors that say what is wrong with what was given or asked for.

Every one of them derives from ``ForceDiffusionError``, which carries the exit status with which
the command line ends.
"""

from typing import TYPE_CHECKING, Any, ClassVar

if TYPE_CHECKING:
    from pydantic import ValidationError

WRONG_INPUT, NOT_REACHED = 2, 3


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

    ``exit_status``: 2 where the input is wrong; 3 where what was asked for can't be reached, or
    something outside the program failed.
    """

    exit_status: ClassVar[int] = WRONG_INPUT

    def __str__(self) -> str:
        """Give the message; what it quotes can't command a terminal."""
        return printable(super().__str__())


class NotReachedError(ForceDiffusionError):
    """What was asked for can't be reached with the memory, the range or the libraries at hand."""

    exit_status = NOT_REACHED


class MissingLibraryError(NotReachedError):
    """An optional library is not installed; the message says how to install it."""


class UndecidedError(ForceDiffusionError, ArithmeticError):
    """Balls have grown so wide that a question stays open: more bits are needed."""

    exit_status = NOT_REACHED


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
            return "must be a whole number, written without point or exponent"
        case "float_type" | "float_parsing":
            return "must be a number"
        case "value_error":
            return str(context["error"])
    return first["msg"].lower().replace("input should", "must").replace("string should", "must")
