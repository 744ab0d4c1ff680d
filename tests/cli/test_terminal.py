"""On a terminal: a live display while it runs, and the same lines in the end."""

import os
import pty
import re
import subprocess
import sys
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
        env=environment,
        stdout=theirs,
        stderr=theirs,
        stdin=theirs,
    ) as process:
        os.close(theirs)
        shown = b""
        while True:
            try:
                piece = os.read(ours, 4096)
            except OSError:  # the other end is closed
                break
            if not piece:
                break
            shown += piece
    os.close(ours)
    return process.returncode, shown.decode()


def plain(shown: str) -> str:
    return re.sub(r"\x1b\[[0-9;?]*[A-Za-z]", "", shown).replace("\r", "")


@pytest.mark.long
def test_a_live_bar_and_a_line_for_each_equation() -> None:
    status, shown = on_a_terminal("derive", "1", "2")
    assert status == 0
    assert "\x1b[" in shown
    text = plain(shown)
    assert "0/?" in text  # what the two rest on is known once they are proved
    assert "2/? Eq. 2" in text
    assert "1  proved" in text
    assert "2 proved." in text


@pytest.mark.long(sample=1)
@pytest.mark.parametrize("arguments", [("derive", "1"), ("list",), ("show", "4")])
def test_a_dumb_terminal_gets_plain_lines(arguments: tuple[str, ...]) -> None:
    status, shown = on_a_terminal(*arguments, term="dumb")
    assert status == 0
    assert "\x1b" not in shown
