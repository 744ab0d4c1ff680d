"""How the programs end when a stream fails, on Ctrl-C, and on what they don't understand."""

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest
from force_diffusion.derivations.commands.guard import about, guarded, in_range
from force_diffusion.numeric.arithmetic.errors import ForceDiffusionError

ROOT = Path(__file__).parents[2]
ENVIRONMENT = {**os.environ, "PYTHONPATH": str(ROOT), "COLUMNS": "100"}
PYTHON = f"{sys.executable} -m force_diffusion"
ALONE = f"{PYTHON}.derivations.eq02_displacement"

full = pytest.mark.skipif(not Path("/dev/full").exists(), reason="there is no /dev/full here")


def shell(line: str) -> subprocess.CompletedProcess[str]:
    done = subprocess.run(
        ["bash", "-c", line],
        env=ENVIRONMENT, check=False, capture_output=True, text=True, timeout=600,
    )  # fmt: skip
    assert "Traceback" not in done.stderr
    assert "Exception" not in done.stderr
    return done


@pytest.mark.long(sample=2)
@pytest.mark.parametrize("program", [PYTHON, ALONE])
@pytest.mark.parametrize(
    ("line", "status", "says"),
    [
        pytest.param("{} --help > /dev/full", 3, "No space left on device", marks=full),
        ('{} --help | true; exit "${{PIPESTATUS[0]}}"', None, ""),
        ("{} bogus 2>&-", 2, ""),
    ],
    ids=["a full disk", "a reader that stops", "a message that nobody hears"],
)
def test_a_stream_that_fails(program, line, status, says):
    done = shell(line.format(program))
    # where a reader ends early it may be 0, if all was written before
    assert done.returncode == status or (status is None and done.returncode in (0, 3))
    assert says in done.stderr
    assert bool(says) == bool(done.stderr)
    assert status != 2 or not done.stdout


def test_an_interrupt_while_modules_load(tmp_path):
    (tmp_path / "typer.py").write_text(
        "import sys, time\nprint('loading', file=sys.stderr, flush=True)\ntime.sleep(60)\n"
    )
    with subprocess.Popen(
        [sys.executable, "-m", "force_diffusion"],
        env={**ENVIRONMENT, "PYTHONPATH": f"{tmp_path}{os.pathsep}{ROOT}"},
        cwd=tmp_path, text=True, stderr=subprocess.PIPE,
    ) as process:  # fmt: skip
        assert process.stderr is not None
        assert process.stderr.readline() == "loading\n"
        assert ended(process, signal.SIGINT) == (130, INTERRUPTED)


INTERRUPTED = "force-diffusion: interrupted; no half-written file is left.\n"


def ended(process: subprocess.Popen[str], how: signal.Signals) -> tuple[int, str]:
    """Send a signal: the status with which a program ends, and what it says of errors."""
    process.send_signal(how)
    _, errors = process.communicate(timeout=600)
    return process.returncode, errors


WAITING = """
import sys, time
from force_diffusion.derivations.commands.guard import guarded

def program():
    print("waiting", flush=True)
    try:
        time.sleep(float(sys.argv[1]))
    except KeyboardInterrupt:
        raise ImportError("as a module may take it")
    return 0

sys.exit(guarded(program))
"""


@pytest.mark.parametrize("how", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
@pytest.mark.parametrize("before", [[], ["nohup"]])
def test_every_signal_ends_a_program_in_the_same_way(how, before):
    """But for a hangup under nohup, which is ignored."""
    ignored = bool(before) and how == signal.SIGHUP
    with subprocess.Popen(
        [*before, sys.executable, "-c", WAITING, "0.5" if ignored else "60"],
        env=ENVIRONMENT, text=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
    ) as process:  # fmt: skip
        assert process.stdout is not None
        assert process.stdout.readline() == "waiting\n"
        assert ended(process, how) == ((0, "") if ignored else (130, INTERRUPTED))


class UnreachableError(ForceDiffusionError):
    exit_status = 3


OUT_OF_RANGE = "a number left the range of the arithmetic (too large)"


@pytest.mark.parametrize(
    ("error", "status", "says"),
    [
        (ForceDiffusionError("no such thing"), 2, "no such thing"),
        (UnreachableError("too far"), 3, "too far"),
        (MemoryError("Unable to allocate"), 3, "the memory is full; ask for less"),
        (ForceDiffusionError("\x1b[2J\u2028\udcff é"), 2, r"\x1b[2J\u2028\udcff é"),
        (OverflowError("too large"), 3, OUT_OF_RANGE),
        (ZeroDivisionError("too large"), 3, OUT_OF_RANGE),
    ],
)
def test_an_error_is_printed_once_with_its_context(error, status, says, capsys):
    def program() -> int:
        with about("file"), about("part"), in_range():
            raise error

    assert guarded(program) == status
    printed = capsys.readouterr()
    assert (printed.out, printed.err) == ("", f"force-diffusion: file: part: {says}\n")


def test_a_mistake_in_the_program_keeps_its_traceback():
    def program() -> int:
        raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        guarded(program)
