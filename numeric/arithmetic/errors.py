"""The errors that say what is wrong with what was given or asked for.

Every one of them derives from ``ForceDiffusionError``, which carries the exit status with which
the command line ends.
"""

from typing import ClassVar

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
    """Something that a user can mend; the message says what was wrong, where, and what to do.

    ``exit_status``: 2 where the input is wrong, 3 where what was asked for can't be reached.
    """

    exit_status: ClassVar[int] = WRONG_INPUT

    def __str__(self) -> str:
        """Give the message; what it quotes can't command a terminal."""
        return printable(super().__str__())


class NotReachedError(ForceDiffusionError):
    """What was asked for can't be reached with the memory, the range or the libraries at hand."""

    exit_status = NOT_REACHED


class UndecidedError(ForceDiffusionError, ArithmeticError):
    """Balls have grown so wide that a question stays open: more bits are needed."""

    exit_status = NOT_REACHED
