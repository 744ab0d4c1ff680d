"""The errors that say what is wrong with what was given or asked for.

Every one of them derives from ``ForceDiffusionError``, which carries the exit status with which
the command line ends.
"""

from typing import ClassVar

WRONG_INPUT, NOT_REACHED = 2, 3


class ForceDiffusionError(Exception):
    """Something that a user can mend; the message says what was wrong, where, and what to do.

    ``exit_status``: 2 where the input is wrong, 3 where what was asked for can't be reached.
    """

    exit_status: ClassVar[int] = WRONG_INPUT


class NotReachedError(ForceDiffusionError):
    """What was asked for can't be reached with the memory, the range or the libraries at hand."""

    exit_status = NOT_REACHED


class UndecidedError(ForceDiffusionError, ArithmeticError):
    """Balls have grown so wide that a question stays open: more bits are needed."""

    exit_status = NOT_REACHED
