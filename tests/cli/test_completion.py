"""Completion: what shells are given to run, and what is offered for a line."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

PROGRAM = Path(sys.executable).parent / "force-diffusion"


def called(shell: str, line: str, folder: Path, **more: str) -> subprocess.CompletedProcess[str]:
    """Run a line in a shell that has the name of another one, by which the program knows it."""
    program = folder / shell
    program.symlink_to(shutil.which("bash") or "/bin/bash")
    path = f"{PROGRAM.parent}{os.pathsep}{os.environ['PATH']}"
    usual = {"HOME": str(folder), "TERM": "xterm", "LANG": "C.UTF-8", "COLUMNS": "200"}
    return subprocess.run(
        [program, "-c", line], env={"PATH": path, **usual, **more},
        capture_output=True, text=True, check=False, timeout=600,
    )  # fmt: skip


COMPLETED = """
source <(force-diffusion --show-completion)
words=($(complete -p force-diffusion))
COMP_WORDS=(force-diffusion ensemble-) COMP_CWORD=1
"${words[-2]}" force-diffusion
echo "${COMPREPLY[@]}"
"""


def test_bash_completes_the_names_of_commands_with_what_it_is_given(tmp_path):
    done = called("bash", COMPLETED, tmp_path)
    assert (done.stdout, done.stderr) == ("ensemble-status\n", "")


@pytest.mark.parametrize(
    ("line", "offered"), [("show --as s", "sympy steps"), ("nonsense s", "show")]
)
def test_what_is_offered(line, offered, tmp_path):
    words = ["force-diffusion", *line.split()]
    variables = {"COMP_WORDS": "\n".join(words), "COMP_CWORD": str(len(words) - 1)}
    asked = {**variables, "_FORCE_DIFFUSION_COMPLETE": "complete_bash"}
    done = called("bash", "exec force-diffusion", tmp_path, **asked)
    assert (done.returncode, done.stdout.split(), done.stderr) == (0, offered.split(), "")


@pytest.mark.parametrize(
    ("shell", "option", "status", "says"),
    [
        ("zsh", "--show-completion", 0, "_FORCE_DIFFUSION_COMPLETE=complete_zsh"),
        ("tcsh", "--install-completion", 2, "bash, zsh or fish"),
    ],
)
def test_other_shells(shell, option, status, says, tmp_path):
    done = called(shell, f"force-diffusion {option}; exit $?", tmp_path)
    assert (done.returncode, says in done.stdout + done.stderr) == (status, True)
    assert [path.name for path in tmp_path.iterdir()] == [shell]
