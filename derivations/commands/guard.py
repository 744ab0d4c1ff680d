"""How every program of this package ends: with a status, and a message in place of a traceback.

Commands raise errors and catch none. Errors that a user can mend derive from
``ForceDiffusionError`` and carry an exit status; only this module prints them, as
``force-diffusion: message``. A command can add what an error is about::

    with about(scene.name):
        outcome = run(plan)  # force-diffusion: scene.toml: no bead rests ...

It also reports an interrupt (130), a full memory, and a file or a stream that can't be written
(3). Everything else is a mistake in the program, and its traceback is shown.
"""

import errno
import io
import os
import signal
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from types import FrameType

from force_diffusion.numeric.arithmetic.errors import (
    NOT_REACHED,
    ForceDiffusionError,
    NotReachedError,
    printable,
)

FAILED_OUTSIDE, INTERRUPTED = NOT_REACHED, 130
INTERRUPTS = "SIGINT", "SIGTERM", "SIGHUP"  # of which Windows has two


@contextmanager
def about(name: str) -> Iterator[None]:
    """Put a name before the message of an error that leaves the block."""
    try:
        yield
    except (ForceDiffusionError, MemoryError) as error:
        error.add_note(name)
        raise


@contextmanager
def in_range() -> Iterator[None]:
    """Turn an overflow or a division by zero of the arithmetic into an error for users."""
    try:
        yield
    except ForceDiffusionError:
        raise
    except ArithmeticError as error:
        raise NotReachedError(f"a number left the range of the arithmetic ({error})") from error


def say(text: str) -> None:
    """Print words that may hold names from outside."""
    print(printable(text), flush=True)


def tell(message: str) -> None:
    """Say something on standard error, in the program's name."""
    print(f"force-diffusion: {printable(message)}", file=sys.stderr, flush=True)


def guarded(program: Callable[[], int]) -> int:
    """Run a program; return its exit status, which is that of a failure if there was one."""
    _prepare_streams()
    with _interruptible() as came:
        status = _status(program, came)
    try:
        sys.stdout.flush()
    except OSError as failure:
        status = _outside(failure)
    return status


@contextmanager
def _interruptible() -> Iterator[list[int]]:
    """Let signals interrupt this program, unless it was started to ignore them (``nohup``).

    Gives a list to which those that come are added: where a module is loaded, an interrupt may be
    taken for an error.
    """
    came: list[int] = []

    def interrupt(number: int, _: FrameType | None) -> None:
        came.append(number)
        raise KeyboardInterrupt

    before = {}
    in_main = threading.current_thread() is threading.main_thread()
    for number in (getattr(signal, name, None) for name in INTERRUPTS if in_main):
        if number and signal.getsignal(number) in (signal.SIG_DFL, signal.default_int_handler):
            before[number] = signal.signal(number, interrupt)
    try:
        yield came
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


def _status(program: Callable[[], int], came: list[int]) -> int:
    try:
        status = program()
    except BaseException as error:
        if not came and not isinstance(error, KeyboardInterrupt):
            return _known(error)
        status = INTERRUPTED
    if status and (came or status == INTERRUPTED):
        tell("interrupted; no half-written file is left.")
        return INTERRUPTED
    return status


def _known(error: BaseException) -> int:
    """Tell an error; raise it again where it is a mistake in the program."""
    match error:
        case ForceDiffusionError():
            return _failed(error, str(error), error.exit_status)
        case MemoryError():
            return _failed(error, "the memory is full; ask for less", FAILED_OUTSIDE)
        case OSError():
            return _outside(error)
    raise error


def _failed(error: Exception, message: str, status: int) -> int:
    notes = dict.fromkeys(reversed(getattr(error, "__notes__", [])))  # the outermost came last
    names = [name for name in notes if name not in message.partition(":")[0]]
    tell(": ".join([*names, message]))
    return status


def _prepare_streams() -> None:
    """Let printing fail where standard output is closed, and show δ on every terminal."""
    if sys.stdout is None:  # what is printed has to fail as it does on a full disk
        unwritable = os.open(os.devnull, os.O_RDONLY)
        sys.stdout = open(unwritable, "w", encoding="utf-8")  # noqa: SIM115
    if sys.stderr is None:
        sys.stderr = open(os.devnull, "w", encoding="utf-8")  # noqa: SIM115
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="replace")


def _outside(failure: OSError) -> int:
    """Say what failed outside of the program, and what to do."""
    if failure.filename is None:
        # nothing more can reach standard output, not even when the interpreter closes it
        with suppress(OSError):
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    if failure.errno != errno.EPIPE:
        where = f"'{failure.filename}'" if failure.filename else "standard output"
        remedy = "Choose a place that can be written to."
        if failure.errno in (errno.ENOSPC, errno.EDQUOT):
            remedy = "Free some space, or write to another place."
        reason = failure.strerror or str(failure)
        tell(f"writing to {where} failed: {reason}. {remedy}")
    return FAILED_OUTSIDE
