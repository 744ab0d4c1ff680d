"""Whether the main paths have become slower: instruction counts against a stored baseline.

``python benchmarks/regressions.py [PATH…]`` counts the instructions of each path under valgrind's
callgrind, in a minute or two, and compares them with ``baseline.json``; a PATH is any part of a
path's name. ``--update`` writes the baseline anew, ``--list`` names the paths. Counts of one and
the same program hardly differ from run to run, whatever else the machine does. Compiled code is
made too slowly under valgrind: of it, the ratio of its time to fixed NumPy arithmetic is compared.

Exit status: 0 no path is slower, 1 a path is slower than the baseline by more than its limit,
2 wrong usage or baseline, 3 counts can't be compared: valgrind is missing, versions differ from the
baseline's, or a path failed. (On another processor only the ratio can't, which is said.)
"""

import argparse
import json
import os
import platform
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

from main_paths import COUNTED, PROOFS

ROOT = Path(__file__).parents[1]
BASELINE = Path(__file__).with_name("baseline.json")
INSTRUCTIONS, RATIO = "instructions", "ratio"
# Counts repeat to 0.3 %, so that 5 % are no accident and small matters pass. Ratios of times
# differ by up to a third between runs on a busy machine: only a half more is taken as real.
LIMITS = {INSTRUCTIONS: 1.05, RATIO: 1.5}
FAST = "fast sweep / NumPy arithmetic, 256 × 512"
ALL = [*COUNTED, *PROOFS, FAST]
PACKAGES = ("numpy", "sympy", "python-flint", "mpmath", "typer", "rich", "pydantic")
ONLY_RATIO = ("numba", "processor")
"""What a ratio of times depends on, and a count does not."""
ENVIRONMENT = {
    **{name: os.environ[name] for name in ("PATH", "HOME") if name in os.environ},
    "PYTHONPATH": str(ROOT),
    "PYTHONHASHSEED": "0",  # the order of sets, and so what is done with them
    "OPENBLAS_NUM_THREADS": "1",
    "LC_ALL": "C.UTF-8",
}


class UnusableError(Exception):
    """No comparison is possible; the message says why and what to do."""


@dataclass(frozen=True)
class Measured:
    """What was measured of a path: instructions, or a ratio of times."""

    kind: str
    value: float


@dataclass(frozen=True)
class Compared:
    """One path beside the baseline; ``ratio`` is None where there is nothing to compare."""

    path: str
    kind: str
    before: float | None
    now: float
    ratio: float | None
    verdict: str

    def __str__(self) -> str:
        """Give the line in Markdown."""
        shown = "" if self.ratio is None else f"{self.ratio:.4f}"
        before = "" if self.before is None else _figure(self.kind, self.before)
        now = _figure(self.kind, self.now)
        return f"| {self.path} | {before} | {now} | {shown} | {self.verdict} |"


def _figure(kind: str, value: float) -> str:
    return f"{value / 1e6:.2f} M" if kind == INSTRUCTIONS else f"{value:.3g}"


def differing(before: Mapping[str, str], now: Mapping[str, str], kind: str) -> list[str]:
    """Name the versions that differ, of those that this kind of measurement depends on."""
    names = [n for n in {**before, **now} if kind == RATIO or n not in ONLY_RATIO]
    if kind == RATIO:  # of the two programs valgrind is not one
        names = [name for name in names if name != "valgrind"]
    return [
        f"{name}: {before.get(name, 'none')}, now {now.get(name, 'none')}"
        for name in names
        if before.get(name) != now.get(name)
    ]


def compare(
    baseline: Mapping[str, Any], versions: Mapping[str, str], found: Mapping[str, Measured]
) -> list[Compared]:
    """Compare measurements with a baseline, path by path.

    A path is SLOWER beyond ``LIMITS``, and as much faster below their inverse; where versions
    differ it is not compared, for then the difference is not this package's.
    """
    result = []
    for path, measured in found.items():
        stored = baseline["paths"].get(path)
        before = ratio = None
        if stored is None or stored["kind"] != measured.kind:
            verdict = "new: not in the baseline"
        elif differing(baseline["versions"], versions, measured.kind):
            before, verdict = stored["value"], "not comparable: other versions"
        else:
            before, limit = stored["value"], LIMITS[measured.kind]
            ratio = measured.value / before
            verdict = "SLOWER" if ratio > limit else "faster" if ratio < 1 / limit else "same"
        result.append(Compared(path, measured.kind, before, measured.value, ratio, verdict))
    return result


def status(compared: Sequence[Compared]) -> int:
    """Give the exit status: 1 slower, 3 where counts, or all that was asked, can't be compared."""
    if any(one.verdict == "SLOWER" for one in compared):
        return 1
    open_ = [one for one in compared if one.verdict.startswith("not comparable")]
    if any(one.kind == INSTRUCTIONS for one in open_):
        return 3
    return 3 if open_ and len(open_) == len(compared) else 0


def read_baseline(path: Path) -> dict[str, Any]:
    """Read a baseline; ``ValueError`` says what is wrong with it."""
    advice = "make one with --update"
    try:
        data = json.loads(path.read_text(encoding="utf-8"))
    except FileNotFoundError:
        raise ValueError(f"there is no {path.name}: {advice}") from None
    except ValueError as error:
        raise ValueError(f"{path.name} is damaged ({error}): {advice}") from None
    try:
        sound = all(isinstance(v, str) for v in data["versions"].values()) and all(
            one["kind"] in LIMITS and float(one["value"]) > 0 for one in data["paths"].values()
        )
    except (TypeError, KeyError, AttributeError, ValueError):
        sound = False
    if not sound:
        raise ValueError(f"{path.name} holds no baseline: {advice}")
    return dict(data)


def versions_now() -> dict[str, str]:
    """Give the versions that counts and times depend on."""
    found = {"python": platform.python_version(), "architecture": platform.machine()}
    for name in (*PACKAGES, "numba"):
        try:
            found[name] = version(name)
        except PackageNotFoundError:
            found[name] = "none"
    done = subprocess.run(["valgrind", "--version"], capture_output=True, text=True, check=False)
    found["valgrind"] = done.stdout.strip().removeprefix("valgrind-")
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
        found["processor"] = next(s.split(":")[1].strip() for s in lines if "model name" in s)
    except (OSError, StopIteration):
        found["processor"] = platform.processor() or "unknown"
    return found


def _run(command: Sequence[str]) -> str:
    done = subprocess.run(
        command, cwd=ROOT, env=ENVIRONMENT, capture_output=True, text=True, check=False
    )
    if done.returncode:
        last = (done.stderr.strip().splitlines() or ["it says nothing"])[-1]
        raise UnusableError(f"a path failed with status {done.returncode}: {last}")
    return done.stdout


def counted(arguments: Sequence[str]) -> list[int]:
    """Run Python under callgrind: the instructions up to each call of getppid(), and to the end."""
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "counts"
        options = ["--dump-before=getppid", f"--callgrind-out-file={out}"]
        _run(["valgrind", "-q", "--tool=callgrind", *options, sys.executable, *arguments])
        parts = sorted(out.parent.glob("counts.*"), key=lambda part: int(part.suffix[1:]))
        return [_total(part) for part in (*parts, out)]


def _total(dump: Path) -> int:
    for line in dump.read_text(encoding="utf-8", errors="replace").splitlines():
        if line.startswith("totals: "):
            return int(line.split()[1])
    raise UnusableError("callgrind wrote no total; is this valgrind 3.15 or newer?")


def _program(names: Sequence[str]) -> dict[str, Measured]:
    """Count paths in one process: before, path, between, path, …, after."""
    program = [str(Path(__file__).with_name("main_paths.py")), *names]
    counts = counted(program)
    if len(counts) != 2 * len(names) + 1:
        raise UnusableError(f"{len(counts)} counts came for {len(names)} paths")
    return {
        name: Measured(INSTRUCTIONS, count) for name, count in zip(names, counts[1::2], strict=True)
    }


def measure(names: Sequence[str]) -> Iterator[tuple[str, Measured]]:
    """Measure paths; counts in as many processes at once as there are processors."""
    groups = [[name for name in names if name in group] for group in (PROOFS, COUNTED)]
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        tasks = [pool.submit(_program, group) for group in groups if group]
        found: dict[str, Measured] = {}
        for task in tasks:
            found |= task.result()
    if FAST in names:  # alone: it is timed
        program = str(Path(__file__).with_name("main_paths.py"))
        try:
            found[FAST] = Measured(RATIO, float(_run([sys.executable, program, "--fast-ratio"])))
        except UnusableError as error:
            print(f"not measured: {FAST}: {error}", file=sys.stderr)
    for name in names:
        if name in found:
            yield name, found[name]


def chosen(words: Sequence[str]) -> list[str]:
    """Give the paths whose names hold any of the words; all without words."""
    for word in words:
        if not any(word in name for name in ALL):
            raise ValueError(f"no path is called '{word}'; --list names them")
    return [name for name in ALL if not words or any(word in name for word in words)]


def updated(
    old: Mapping[str, Any] | None, versions: Mapping[str, str], found: Mapping[str, Measured]
) -> dict[str, Any]:
    """Give the baseline with new values; those of other paths stay if the versions are the same."""
    kept = old["paths"] if old is not None and old["versions"] == versions else {}
    paths = {name: one for name, one in kept.items() if name in ALL}
    paths |= {name: {"kind": one.kind, "value": one.value} for name, one in found.items()}
    return {"versions": dict(versions), "paths": {n: paths[n] for n in ALL if n in paths}}


def _write(path: Path, data: Mapping[str, Any]) -> None:
    aside = path.with_suffix(".new")
    aside.write_text(json.dumps(data, indent=2, ensure_ascii=False) + "\n", encoding="utf-8")
    aside.replace(path)


def _failed(message: object, code: int) -> int:
    print(f"regressions: {message}", file=sys.stderr)
    return code


def main() -> int:
    """Measure, print the table, compare or update."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("paths", nargs="*", metavar="PATH", help="any part of a path's name")
    parser.add_argument("--update", action="store_true", help="write the baseline anew")
    parser.add_argument("--list", action="store_true", help="name the paths, and measure nothing")
    options = parser.parse_args()
    try:
        names = chosen(options.paths)
        if options.list:
            print("\n".join(names))
            return 0
        baseline = None
        if not options.update or (options.paths and BASELINE.exists()):
            baseline = read_baseline(BASELINE)
    except ValueError as error:
        return _failed(error, 2)
    if shutil.which("valgrind") is None:
        return _failed("valgrind is missing: install it, such as by 'apt install valgrind'", 3)
    versions = versions_now()
    if options.update and baseline is not None and baseline["versions"] != versions:
        return _failed("versions differ from the baseline's: update all paths, with no PATH", 2)
    try:
        found = dict(measure(names))
    except UnusableError as error:
        return _failed(error, 3)
    except KeyboardInterrupt:
        return _failed("interrupted", 130)
    if options.update:
        _write(BASELINE, updated(baseline, versions, found))
        print(f"{len(found)} paths written to {BASELINE.name}")
        return 0
    assert baseline is not None
    compared = compare(baseline, versions, found)
    print("| path | baseline | now | now / baseline | |\n|---|---:|---:|---:|---|")
    print("\n".join(map(str, compared)))
    changed = differing(baseline["versions"], versions, INSTRUCTIONS)
    changed += [s for s in differing(baseline["versions"], versions, RATIO) if s not in changed]
    if changed:
        print("\nVersions differ from the baseline's, so that not all can be compared:")
        print("\n".join(f"  {words}" for words in changed))
    return status(compared)


if __name__ == "__main__":
    raise SystemExit(main())
