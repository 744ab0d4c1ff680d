"""Scenes, files and questions that nobody would ask: each ends in words, or in a right answer.

``fuzzing --seconds 60 --seed N`` tries cases until the time is over, or ``--cases`` of them. They
are tried one after another in a process with limits on memory and time, and in a new one after
some thousand, or where one has ended it. Case K of a seed is tried again with ``--case K``, and
its files stay in the current folder. Exit status: 0 all ended well, 1 some did not.
"""

import argparse
import json
import os
import resource
import select
import shutil
import signal
import time
import traceback
import warnings
from collections import Counter
from collections.abc import Callable
from importlib import import_module
from pathlib import Path
from random import Random

import answers
import commands
import files

ENOUGH = 2.0  # seconds of processor time after which a case is interrupted, and has to end
PATIENCE = 60.0  # seconds in which it has to end then
MEMORY = 4 * 2**30
TOGETHER = 2000  # cases of one process
QUICK = {"explain", "ensemble-status"}  # which solve nothing
# What matters is loaded once, and not by every process.
LOADED = ["numeric.figures.style", "numeric.figures.answers_drawing", "numeric.studies.cost.cost"]

Case = Callable[[Random, Path], "list[str] | answers.Judged"]


def kinds(whole: Path) -> dict[str, tuple[int, Case]]:
    """Give all kinds of cases, with how often each is drawn."""
    return {
        "scenes, mildly changed": (
            30, lambda random, folder: commands.of_scene(random, folder, mildly=True)
        ),
        "example scenes, wildly changed": (
            12, lambda random, folder: commands.of_scene(random, folder, mildly=False)
        ),
        "stores": (8, lambda random, folder: files.store(random, folder, whole)),
        "NumPy files": (7, files.array),
        "tables": (8, files.table),
        "compared with balls": (9, answers.of_balls),
        "arrays, compared with balls": (6, answers.of_radii),
        "threads": (4, answers.of_threads),
        "files read back": (5, answers.of_files),
    }  # fmt: skip


_interrupted: list[int] = []  # the signals, in one case


def _interrupt(number: int, *_: object) -> None:
    _interrupted.append(number)
    signal.raise_signal(signal.SIGINT)


def tried(case: Case, random: Random, folder: Path) -> tuple[int, str]:
    """Try a case in this folder; give its exit status, and what was wrong."""
    os.chdir(folder)
    try:
        found = case(random, folder)
        if isinstance(found, tuple):
            return found
        end = commands.said(found)
        what = commands.wrong(found, end)
    except Exception:
        # a compiler that was interrupted raises what it will, and no command would show it
        return (130, "") if _interrupted else (1, traceback.format_exc()[-2500:])
    if _interrupted:  # what Python then says of callbacks that it ignored is no word of ours
        what = f"had no end after {ENOUGH} s" if found[0] in QUICK else ""
        what = what if end.status in commands.ENDED else f"was interrupted: {end}"[:2500]
    return end.status, f"{' '.join(map(repr, found))} {what}" if what else ""


def work(root: Path, seed: int, numbers: range, pipe: int, keep: bool) -> None:
    """Try cases in a process of its own; tell each end through a pipe."""
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    signal.signal(signal.SIGINT, signal.default_int_handler)
    signal.signal(signal.SIGPROF, _interrupt)
    warnings.simplefilter("error")
    warnings.simplefilter("ignore", ResourceWarning)  # of fonts, which matplotlib's library leaves
    drawn = kinds(root / "whole" / "store")
    for number in numbers:
        random, folder = Random(f"{seed} {number}"), root / str(number)
        folder.mkdir()
        kind = random.choices(list(drawn), [often for often, _ in drawn.values()])[0]
        start = time.monotonic()
        _interrupted.clear()
        try:
            signal.setitimer(signal.ITIMER_PROF, ENOUGH, PATIENCE / 10)
            status, what = tried(drawn[kind][1], random, folder)
            signal.setitimer(signal.ITIMER_PROF, 0)
        except KeyboardInterrupt:
            signal.setitimer(signal.ITIMER_PROF, 0)
            status, what = 130, ""
        told = [number, kind, status, what, time.monotonic() - start]
        os.write(pipe, json.dumps(told).encode() + b"\n")
        os.chdir(root)
        if not keep:
            shutil.rmtree(folder)


class Tally:
    """What has been found so far."""

    def __init__(self) -> None:
        self.statuses: dict[str, Counter[int]] = {}
        self.seconds: Counter[str] = Counter()
        self.wrong = 0

    def add(self, number: int, kind: str, status: int, what: str, seconds: float) -> None:
        """Count a case, and print what was wrong."""
        self.statuses.setdefault(kind, Counter())[status] += 1
        self.seconds[kind] += seconds
        if what:
            self.wrong += 1
            print(f"case {number}, {kind}: {what}\n", flush=True)

    def __str__(self) -> str:
        lines = []
        for kind, found in sorted(self.statuses.items()):
            share, each = found[0] / found.total(), 1000 * self.seconds[kind] / found.total()
            by_status = dict(sorted(found.items()))
            lines.append(
                f"{kind}: {found.total()}, {share:.0%} answered, {by_status}, {each:.0f} ms each"
            )
        total = sum(found.total() for found in self.statuses.values())
        return "\n".join([*lines, f"{total} cases, {self.wrong} wrong"])


def batch(root: Path, seed: int, numbers: range, end: float, keep: bool, tally: Tally) -> int:
    """Try cases in one process, while it lives and there is time; give the next number."""
    reading, writing = os.pipe()
    child = os.fork()
    if not child:
        os.close(reading)
        try:
            work(root, seed, numbers, writing, keep)
        except BaseException:
            traceback.print_exc()
            os._exit(1)
        os._exit(0)
    os.close(writing)
    after, left = numbers.start, b""
    why = ""
    with open(reading, "rb", buffering=0) as pipe:
        while after < numbers.stop and time.monotonic() < end:
            if not select.select([pipe], [], [], ENOUGH + PATIENCE)[0]:
                why = f"had no end after {ENOUGH + PATIENCE} s"
                break
            if not (read := pipe.read(2**16)):
                break
            *lines, left = (left + read).split(b"\n")
            for line in lines:
                tally.add(*json.loads(line))
                after += 1
    if after < numbers.stop and time.monotonic() >= end:
        os.kill(child, signal.SIGKILL)
        os.waitpid(child, 0)
        return after
    if why:
        os.kill(child, signal.SIGKILL)
    status = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
    if after < numbers.stop:
        tally.add(after, "?", 1, why or f"ended the process with {status}", 0.0)
        return after + 1
    return after


def whole_store(folder: Path) -> None:
    """Make a sound store, with its scene beside it."""
    folder.mkdir()
    os.chdir(folder)
    text = files.SCENE_OF_A_STORE
    Path("scene.toml").write_text(text, encoding="utf-8")
    command = ["ensemble", "scene.toml", "--realisations", "300", "--store", "store"]
    found = commands.said([*command, "--workers", "1"])
    if found.status:
        raise SystemExit(f"no store could be made: {found.err}")


def main() -> int:
    """Try cases until the time is over, or as many as are asked for."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seconds", type=float, default=float("inf"))
    parser.add_argument("--cases", type=int, default=10**9)
    parser.add_argument("--seed", type=int, required=True)
    parser.add_argument("--case", type=int, help="try only this one, and leave its files")
    options = parser.parse_args()
    print(f"seed {options.seed}", flush=True)
    root = Path.cwd() / f"fuzz-{options.seed}"
    root.mkdir()
    for name in LOADED:
        import_module(f"force_diffusion.{name}")
    for command in ("run", "figures", "ensemble"):
        commands.said([command, "--help"])
    maker = os.fork()  # what solves may start threads, which a fork would lose
    if not maker:
        whole_store(root / "whole")
        os._exit(0)
    if os.waitpid(maker, 0)[1]:
        return 1
    end, tally = time.monotonic() + options.seconds, Tally()
    at, stop, one = options.case or 0, options.cases, options.case is not None
    if one:
        stop = at + 1
    while at < stop and time.monotonic() < end:
        numbers = range(at, min(at + TOGETHER, stop))
        at = batch(root, options.seed, numbers, end, one, tally)
    print(tally)
    return 1 if tally.wrong else 0


if __name__ == "__main__":
    raise SystemExit(main())
