"""Interrupts: Ctrl-C, SIGTERM and SIGHUP end a program in the same way, at every moment.

Imported before anything else; so it imports little itself. While Python itself starts, nothing can
be done.
"""

from __future__ import annotations

import os
import sys
from contextlib import suppress

TYPE_CHECKING = False  # typing takes as long to load as all of the rest
if TYPE_CHECKING:
    from types import FrameType, TracebackType
    from typing import Any

INTERRUPTED = 130
MESSAGE = "interrupted; no half-written file is left."

# the signals; where a module is loaded, an interrupt may be taken for an error
came: list[int] = []


def _interrupt(number: int, where: FrameType | None) -> None:
    came.append(number)
    raise KeyboardInterrupt


def _hook(kind: type[BaseException], error: BaseException, where: TracebackType | None) -> None:
    if not came and not issubclass(kind, KeyboardInterrupt):
        sys.__excepthook__(kind, error, where)
        return
    with suppress(OSError):
        os.write(2, f"force-diffusion: {MESSAGE}\n".encode())
    os._exit(INTERRUPTED)  # nothing is open yet, and nothing more need be loaded


def end_quietly() -> None:
    """See to interrupts that come while modules still load, before anything is guarded."""
    sys.excepthook = _hook
    heed("SIGINT")


def heed(*names: str) -> dict[int, Any]:
    """Let signals interrupt this program, unless it was started to ignore them (``nohup``).

    Gives what they did before; nothing is changed outside of the main thread.
    """
    import signal
    import threading

    before: dict[int, Any] = {}
    if threading.current_thread() is not threading.main_thread():
        return before
    for name in names:
        number = getattr(signal, name, None)  # Windows has no SIGHUP
        if number is None:
            continue
        usual = signal.getsignal(number)
        if usual in (signal.SIG_DFL, signal.default_int_handler, _interrupt):
            before[number] = signal.signal(number, _interrupt)
    return before
