"""Processes of this machine: how they start, how they end, and one that works beside this one."""

import ctypes
import os
import signal
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import contextmanager, suppress
from functools import partial
from multiprocessing import connection, get_context, parent_process
from multiprocessing.connection import Connection
from typing import Any

from .machine import cores

Start = Callable[..., Callable[[], Any]]
"""Takes a function and its arguments; gives what waits for its value. ``partial`` is one, too."""

_SIGNAL_OF_DEATH = 1  # PR_SET_PDEATHSIG of Linux

Answer = tuple[Any, Exception | None]
"""What a call gave, or why it did not."""


@contextmanager
def without_interrupts(*more: int) -> Iterator[None]:
    """Let signals of a terminal, and ``more``, wait; they come to us afterwards.

    None of these signals reaches processes that are started meanwhile: those that load their
    modules could only end with a traceback, and the one that keeps account of all others must see
    their end.
    """
    if not hasattr(signal, "pthread_sigmask"):  # not on this system
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT, signal.SIGHUP, *more})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def ending_with(parent: int) -> Callable[[], None] | None:
    """Give what another program does first (``preexec_fn``), so that it ends when its parent does.

    However that ends: SIGKILL leaves no time to end a program. None where the system can't do it.
    """
    try:
        prctl = ctypes.CDLL(None).prctl
    except (AttributeError, OSError, TypeError):  # not on this system
        return None

    def first() -> None:
        prctl(_SIGNAL_OF_DEATH, signal.SIGKILL)
        if os.getppid() != parent:  # it has ended before
            os._exit(1)

    return first


def end_with_parent() -> None:
    """Leave interrupts to the parent, and end with it, however it ends; a pool does not see it."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # held back until now
    threading.Thread(target=_follow_parent, daemon=True).start()


def _follow_parent() -> None:
    parent = parent_process()
    if parent is not None:
        connection.wait([parent.sentinel])
        os._exit(1)


@contextmanager
def beside() -> Iterator[Start]:
    """Give what calls functions in a process beside this one, one after the other.

    Who waits for a value calls meanwhile what is not begun, the latest first; all is called here
    where there is one core, or where no process starts, or it dies. Functions, arguments and
    values have to be picklable.
    """
    ours, theirs = get_context("spawn").Pipe()
    process = get_context("spawn").Process(target=_serve, args=(theirs,), daemon=True)
    try:
        if cores() < 2:
            raise OSError
        with without_interrupts():
            process.start()
    except OSError:
        yield partial
        return
    finally:
        theirs.close()

    def ask(task: Callable[[], Any]) -> Answer:
        ours.send(task)
        answer: Answer = ours.recv()
        return answer

    def start(function: Callable[..., Any], *arguments: Any) -> Callable[[], Any]:
        task = partial(function, *arguments)
        future = asking.submit(ask, task)
        given[future] = task

        def value() -> Any:
            while not future.done():
                latest = next((one for one in reversed(given) if one.cancel()), None)
                if latest is None:
                    break
                called[latest] = _answer(given.pop(latest))
            given.pop(future, None)
            try:
                found, error = called.pop(future) if future in called else future.result()
            except (EOFError, OSError):  # it died
                return task()
            if error is not None:
                raise error
            return found

        return value

    given: dict[Future[Answer], Callable[[], Any]] = {}
    called: dict[Future[Answer], Answer] = {}
    asking = ThreadPoolExecutor(1)
    try:
        yield start
    finally:
        process.terminate()  # nobody waits for what it is still at
        asking.shutdown(cancel_futures=True)
        process.join()
        ours.close()


def _serve(connected: Connection) -> None:
    end_with_parent()
    with suppress(EOFError, OSError):  # the parent has gone
        while True:
            task = connected.recv()
            connected.send(_answer(task))


def _answer(task: Callable[[], Any]) -> Answer:
    try:
        return task(), None
    except Exception as error:
        return None, error
