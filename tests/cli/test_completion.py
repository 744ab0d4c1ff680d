"""Completion in real shells: a line is typed on a terminal, with a tab."""

import os
import pty
import re
import select
import shutil
import subprocess
import sys
import time
from pathlib import Path

import pytest

PROGRAM = Path(sys.executable).parent / "force-diffusion"
START = {
    "bash": ["--norc", "--noprofile", "-i"],
    "zsh": ["-f", "-i"],
    "fish": ["--no-config", "-i"],
}
# The line that loads what --show-completion has printed into a file.
LOAD = {
    "bash": "source {0}",
    "zsh": "autoload -Uz compinit; compinit -u -D; source {0}",
    "fish": "source {0}",
}

ON_ITS_TERMINAL = """
import fcntl, os, sys, termios
os.setsid()
fcntl.ioctl(0, termios.TIOCSCTTY, 0)
os.execvp(sys.argv[1], sys.argv[1:])
"""


def environment(home: Path) -> dict[str, str]:
    path = f"{PROGRAM.parent}{os.pathsep}{os.environ['PATH']}"
    return {"PATH": path, "HOME": str(home), "TERM": "xterm", "LANG": "C.UTF-8", "COLUMNS": "200"}


def script(shell: str, home: Path) -> str:
    """What ``--show-completion`` prints when a shell of this kind calls it."""
    command = [shutil.which(shell) or shell, "-c", "force-diffusion --show-completion; true"]
    return subprocess.run(
        command, env=environment(home), capture_output=True, text=True, check=True, timeout=600
    ).stdout


def typed(shell: str, home: Path, load: str, line: str, until: str) -> str:
    """Start a shell on a terminal, type a line and a tab, and read until words appear, or in vain.

    A shell that is not ready yet may lose what was typed: it is typed again.
    """
    terminal, theirs = pty.openpty()
    process = subprocess.Popen(
        [sys.executable, "-c", ON_ITS_TERMINAL, shell, *START[shell]],
        cwd=home, env=environment(home), stdin=theirs, stdout=theirs, stderr=theirs,
    )  # fmt: skip
    os.close(theirs)
    shown, started = "", time.monotonic()
    try:
        for turn in range(10):
            time.sleep(0.5)
            os.write(terminal, f"{load}\r".encode())
            for keys in (f"\x15{line}\t", "\r"):
                time.sleep(0.5 + turn / 2)
                os.write(terminal, keys.encode())
            patience = time.monotonic() + 3 + 3 * turn
            while until not in shown and time.monotonic() < patience:
                if select.select([terminal], [], [], 0.2)[0]:
                    shown += re.sub(
                        r"\x1b\[[0-9;?]*[A-Za-z]",
                        "",
                        os.read(terminal, 4096).decode(errors="replace"),
                    )
            if until in shown or time.monotonic() > started + 600:
                break
    except OSError:  # the shell has ended
        pass
    finally:
        process.kill()
        process.wait()
        os.close(terminal)
    return shown


@pytest.mark.long(sample=1)
@pytest.mark.parametrize("shell", START)
def test_a_shell_completes_the_names_of_commands(shell: str, tmp_path: Path) -> None:
    if shutil.which(shell) is None:
        pytest.skip(f"there is no {shell} here")
    (tmp_path / "load").write_text(script(shell, tmp_path))
    load = LOAD[shell].format(tmp_path / "load")
    says = "Missing argument 'FILE'"  # as the command says whose name was completed
    assert says in typed(shell, tmp_path, load, "force-diffusion ensemble-", until=says)


@pytest.mark.parametrize(
    ("line", "offered"),
    [
        ("force-diffusion expl", "explain"),
        ("force-diffusion show --as s", "sympy steps"),
        ("force-diffusion nonsense s", "show"),
    ],
)
def test_what_is_offered(line: str, offered: str, tmp_path: Path) -> None:
    words = line.split()
    variables = {"COMP_WORDS": "\n".join(words), "COMP_CWORD": str(len(words) - 1)}
    done = subprocess.run(
        [PROGRAM],
        env={**environment(tmp_path), **variables, "_FORCE_DIFFUSION_COMPLETE": "complete_bash"},
        capture_output=True, text=True, check=True, timeout=600,
    )  # fmt: skip
    assert (done.stdout.split(), done.stderr) == (offered.split(), "")


@pytest.mark.parametrize("option", ["--show-completion", "--install-completion"])
def test_a_shell_that_it_does_not_know(option: str, tmp_path: Path) -> None:
    shell = tmp_path / "tcsh"
    shell.symlink_to("/bin/sh")
    command = f"force-diffusion {option}; exit $?"
    done = subprocess.run(
        [shell, "-c", command],
        env=environment(tmp_path), capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.returncode == 2
    assert "bash, zsh or fish" in done.stderr
    assert sorted(tmp_path.iterdir()) == [shell]
