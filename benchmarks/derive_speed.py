"""How long the derivations take, cold, against importing SymPy in the same run.

Every figure is the median of several fresh processes, which take turns with the baseline so
that a busy machine slows both. Run with ``python benchmarks/derive_speed.py``; exit status 1
when a target is missed.
"""

import os
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from statistics import median
from time import perf_counter

ROOT = Path(__file__).parents[1]
ENVIRONMENT = {**os.environ, "PYTHONPATH": str(ROOT)}
ROUNDS = 7
PLAIN_LIMIT = 60.0  # seconds for each equation by the plain route

PROOFS = """
from force_diffusion.derivations.framework.loading import load, with_premises
from force_diffusion.derivations.framework.runner import proofs
for derivation in with_premises(map(load, range(1, 17))):
    for check in proofs(derivation):
        assert check.verdict == "proved", (derivation.number, check)
"""
PROOFS_OF_ONE = """
import sys
from time import perf_counter
from force_diffusion.derivations.framework.loading import load
from force_diffusion.derivations.framework.runner import proofs
derivation = load(int(sys.argv[1]))
start = perf_counter()
assert all(check.verdict == "proved" for check in proofs(derivation))
print(perf_counter() - start)
"""
COMMAND = ("-m", "force_diffusion")


@dataclass(frozen=True)
class Run:
    """One finished process: its time on the wall and its peak memory."""

    seconds: float
    megabytes: float


def timed(arguments: Sequence[str]) -> Run:
    """Run Python in a fresh process; its peak memory is its own, as the kernel counted it."""
    start = perf_counter()
    process = subprocess.Popen(
        [sys.executable, *arguments],
        env=ENVIRONMENT,
        stdout=subprocess.DEVNULL,
    )
    _, status, usage = os.wait4(process.pid, 0)
    seconds = perf_counter() - start
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode:
        raise SystemExit(f"{' '.join(arguments)[:60]} ended with status {process.returncode}")
    return Run(seconds, usage.ru_maxrss / 1024)


def in_turn(tasks: dict[str, Sequence[str]]) -> dict[str, Run]:
    """Median time and largest memory of each task, the tasks taking turns."""
    for arguments in tasks.values():
        timed(arguments)  # byte code compiled, files in the system's cache: for all alike
    runs: dict[str, list[Run]] = {name: [] for name in tasks}
    for _ in range(ROUNDS):
        for name, arguments in tasks.items():
            runs[name].append(timed(arguments))
    return {
        name: Run(median(r.seconds for r in found), max(r.megabytes for r in found))
        for name, found in runs.items()
    }


def seconds_of(arguments: Sequence[str]) -> tuple[float, str]:
    """What a process says about its own time, and the words that follow."""
    try:
        done = subprocess.run(
            [sys.executable, *arguments],
            env=ENVIRONMENT,
            text=True,
            capture_output=True,
            timeout=PLAIN_LIMIT,
            check=True,
        )
    except subprocess.TimeoutExpired:
        return PLAIN_LIMIT, f"not within {PLAIN_LIMIT:.0f} s"
    number, _, words = done.stdout.strip().partition(" ")
    return float(number), words


def plain_routes() -> None:
    """Print each equation's proofs beside the plain SymPy route."""
    route = str(Path(__file__).with_name("plain_route.py"))
    print("\nProofs of one equation, import not counted, against plain SymPy (solve, simplify,")
    print("Sum.doit). The plain route covers the printed equation alone, and of Eqs. 13, 14 and")
    print("16 the leading order alone; 'not decided' means that it ended without an answer.\n")
    print("| Eq. | here, ms | plain, ms | plain / here | plain route |")
    print("|----:|---------:|----------:|-------------:|-------------|")
    for number in range(1, 17):
        here = median(seconds_of(["-c", PROOFS_OF_ONE, str(number)])[0] for _ in range(3))
        plain, outcome = min(seconds_of([route, str(number)]) for _ in range(3))
        print(
            f"| {number} | {1e3 * here:.1f} | {1e3 * plain:.1f} | {plain / here:.1f} | {outcome} |",
            flush=True,
        )


def main() -> int:
    """Measure, print, and compare with the targets."""
    with tempfile.TemporaryDirectory() as folder:
        found = in_turn(
            {
                "import sympy": ["-c", "import sympy"],
                "proofs of 1-16": ["-c", PROOFS],
                "derive 1-16": [*COMMAND, "derive", *map(str, range(1, 17)), "--out", folder],
                "derive": [*COMMAND, "derive", "--out", folder],
                "bare interpreter": ["-c", "pass"],
                "show 13": [*COMMAND, "show", "13"],
                "--help": [*COMMAND, "--help"],
            }
        )
    base, bare = found["import sympy"].seconds, found["bare interpreter"].seconds
    print("| process | seconds | MB | against import sympy | against a bare interpreter |")
    print("|---------|--------:|---:|---------------------:|---------------------------:|")
    for name, run in found.items():
        print(
            f"| {name} | {run.seconds:.3f} | {run.megabytes:.0f} | {run.seconds / base:.2f} "
            f"| {run.seconds / bare:.1f} |"
        )
    targets = [
        ("proofs of 1-16, times import sympy", found["proofs of 1-16"].seconds / base, 5),
        ("derive 1-16, times import sympy", found["derive 1-16"].seconds / base, 7),
        ("derive, MB", found["derive"].megabytes, 300),
    ]
    print()
    for name, value, limit in targets:
        print(f"{'met' if value <= limit else 'MISSED'}: {name}: {value:.2f}, target {limit}")
    plain_routes()
    return 0 if all(value <= limit for _, value, limit in targets) else 1


if __name__ == "__main__":
    raise SystemExit(main())
