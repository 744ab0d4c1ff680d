"""Processes of this machine: how they start, and how they end."""

import os
import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from multiprocessing import connection, parent_process


@contextmanager
def without_interrupts() -> Iterator[None]:
    """Let signals of a terminal wait; they come to us afterwards.

    None of these signals reaches processes that are started meanwhile: those that load their
    modules could only end with a traceback, and the one that keeps account of all others must see
    their end.
    """
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT, signal.SIGHUP})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def end_with_parent() -> None:
    """Leave interrupts to the parent, and end with it, however it ends; a pool does not see it."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # held back until now
    threading.Thread(target=_follow_parent, daemon=True).start()


def _follow_parent() -> None:
    parent = parent_process()
    if parent is not None:
        connection.wait([parent.sentinel])
        os._exit(1)
