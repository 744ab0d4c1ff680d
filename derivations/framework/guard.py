"""How every program of this package ends: with a status, and a message in place of a traceback."""

import errno
import io
import os
import sys
from collections.abc import Callable
from contextlib import suppress
from types import TracebackType

WRONG_USAGE = 2
FAILED_OUTSIDE = 3
INTERRUPTED = 130

_INTERRUPTED = "force-diffusion: interrupted; no half-written file is left."


class _Heedless(io.FileIO):
    """A file of messages: where one can't be written, the exit status alone has to tell."""

    def write(self, message: bytes) -> int:  # type: ignore[override]
        """Write what can be written."""
        with suppress(OSError):
            return super().write(message) or 0
        return len(message)


def guarded(program: Callable[[], int]) -> int:
    """Run a program; return its exit status, which is that of a failure if there was one."""
    _prepare_streams()
    try:
        status = program()
    except KeyboardInterrupt:
        status = INTERRUPTED
    except OSError as failure:
        status = _outside(failure)
    if status == INTERRUPTED:
        print(_INTERRUPTED, file=sys.stderr)
    try:
        sys.stdout.flush()
    except OSError as failure:
        status = _outside(failure)
    return status


def _prepare_streams() -> None:
    """Let standard output fail where it is closed, and standard error never."""
    if sys.stdout is None:  # what is printed has to fail as it does on a full disk
        unwritable = os.open(os.devnull, os.O_RDONLY)
        sys.stdout = open(unwritable, "w", encoding="utf-8")  # noqa: SIM115
    if sys.stderr is sys.__stderr__:  # unless somebody put another one there
        number = 2 if sys.stderr else os.open(os.devnull, os.O_WRONLY)
        sys.stderr = io.TextIOWrapper(
            _Heedless(number, "w", closefd=False),  # unbuffered, as with python -u
            encoding=getattr(sys.stderr, "encoding", None),
            write_through=True,
        )
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):  # δ on a terminal that can't show it
            stream.reconfigure(errors="replace")


def _outside(failure: OSError) -> int:
    """Say what failed outside of the program, and what to do."""
    if failure.filename is None:
        # nothing more can reach standard output, not even when the interpreter closes it
        with suppress(OSError):
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    if failure.errno != errno.EPIPE:
        where = f"'{failure.filename}'" if failure.filename else "standard output"
        remedy = {
            errno.ENOSPC: "Free some space, or write to another place.",
            errno.EDQUOT: "Free some space, or write to another place.",
        }.get(failure.errno or 0, "Choose a place that can be written to.")
        reason = failure.strerror or str(failure)
        print(f"force-diffusion: writing to {where} failed: {reason}. {remedy}", file=sys.stderr)
    return FAILED_OUTSIDE


def end_interrupts_quietly() -> None:
    """See to interrupts that come while modules still load, before anything is guarded."""
    usual = sys.excepthook

    def hook(kind: type[BaseException], error: BaseException, where: TracebackType | None) -> None:
        if issubclass(kind, KeyboardInterrupt):
            with suppress(OSError):
                print(_INTERRUPTED, file=sys.stderr)
            raise SystemExit(INTERRUPTED)
        usual(kind, error, where)

    sys.excepthook = hook
