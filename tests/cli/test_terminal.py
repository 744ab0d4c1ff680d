"""On a terminal the equation under proof is named, and the final lines are the same."""

import os
import pty
import subprocess
import sys
from contextlib import suppress
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]


def on_a_terminal(*arguments: str, term: str = "xterm-256color") -> tuple[int, str]:
    """Run the command line with a terminal as its standard output."""
    ours, theirs = pty.openpty()
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "TERM": term, "COLUMNS": "100"}
    environment.pop("NO_COLOR", None)
    with subprocess.Popen(
        [sys.executable, "-m", "force_diffusion", *arguments],
        env=environment, stdin=theirs, stdout=theirs, stderr=theirs,
    ) as process:  # fmt: skip
        os.close(theirs)
        shown = b""
        with suppress(OSError):  # the other end is closed
            while piece := os.read(ours, 4096):
                shown += piece
    os.close(ours)
    return process.returncode, shown.decode()


@pytest.mark.long
def test_the_current_equation_is_named_and_each_leaves_a_line():
    status, shown = on_a_terminal("derive", "1", "2")
    assert status == 0
    assert "\x1b[KEq. 2\r\x1b[K" in shown
    lines = [line.rpartition("\x1b[K")[2] for line in shown.split("\r\n")]
    assert [line[:11] for line in lines[:2]] == ["  1  proved", "  2  proved"]
    assert lines[2] == "2 proved."


@pytest.mark.long
def test_a_dumb_terminal_gets_plain_lines():
    status, shown = on_a_terminal("derive", "1", term="dumb")
    assert status == 0
    assert "\x1b" not in shown
