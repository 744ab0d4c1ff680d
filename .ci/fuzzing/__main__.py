"""Scenes, files and questions that nobody would ask: each ends in words, or in a right answer.

``fuzzing --seconds 60 --seed N`` tries cases until the time is over, each in a process of its
own, with limits on memory and time. Case K of a seed is tried again with
``--case K``, and its files stay in the current folder. Exit status: 0 all ended well, 1 some not.
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
from collections import Counter, defaultdict
from collections.abc import Callable
from importlib import import_module
from itertools import count
from pathlib import Path
from random import Random

import answers
import commands
import files
from force_diffusion.numeric.mechanics import loops, physicality, sweep

ENOUGH = 2  # seconds after which a case is interrupted, as by Ctrl-C
PATIENCE = 60  # seconds in which it has to end then
MEMORY = 4 * 2**30
# What matters is loaded once, and not by every process.
LOADED = ["numeric.figures.style", "numeric.figures.answers", "numeric.run.cost"]

Case = Callable[[Random, Path], "list[str] | answers.Judged"]
KINDS: dict[str, tuple[int, Case]] = {
    "scenes, mildly changed": (35, commands.of_mild_scene),
    "example scenes, wildly changed": (14, commands.of_wild_scene),
    "NumPy files": (8, files.array),
    "tables": (9, files.table),
    "compared with balls": (12, answers.of_balls),
    "arrays, compared with balls": (8, answers.of_radii),
}
"""All kinds of cases, with how often each is drawn: it gives a command, or a status and a fault."""

Ended = tuple[str, int, str]
"""Kind of a case, exit status, and what was wrong, or nothing."""


def tried(seed: int, number: int, folder: Path) -> Ended:
    """Draw a case and try it, in a process of its own."""
    os.chdir(folder)
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    signal.signal(signal.SIGINT, signal.default_int_handler)
    warnings.simplefilter("error")
    warnings.simplefilter("ignore", ResourceWarning)  # of fonts, which matplotlib's library leaves
    random = Random(f"{seed} {number}")
    if random.random() < 0.5:  # as without numba
        sweep.loops = physicality.loops = lambda: None
    kind = random.choices(list(KINDS), [often for often, _ in KINDS.values()])[0]
    try:
        found = KINDS[kind][1](random, folder)
        if isinstance(found, tuple):
            return kind, *found
        end = commands.said(found)
        what = commands.wrong(found, end)
        return kind, end.status, f"{' '.join(map(repr, found))} {what}" if what else ""
    except KeyboardInterrupt:
        return kind, 130, ""
    except Exception:
        return kind, 1, traceback.format_exc()[-2500:]


def ended(seed: int, number: int, folder: Path) -> Ended:
    """Start that process, interrupt it if it takes long, and wait for its end."""
    reading, writing = os.pipe()
    child = os.fork()
    if not child:
        os.write(writing, json.dumps(tried(seed, number, folder)).encode())
        os._exit(0)
    os.close(writing)
    with open(reading, encoding="utf-8") as pipe:
        quick = select.select([pipe], [], [], ENOUGH)[0]
        if not quick:
            os.kill(child, signal.SIGINT)
            if not select.select([pipe], [], [], PATIENCE)[0]:
                os.kill(child, signal.SIGKILL)
        said = pipe.read()
    if died := os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]):
        return "?", 1, f"ended the process with {died}"
    kind, status, what = json.loads(said)
    # what Python says of callbacks in which it ignored an interrupt is no word of ours
    return kind, status, what if quick or status not in commands.ENDED else ""


def main() -> int:
    """Try cases until the time is over."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seconds", type=float, default=60)
    parser.add_argument("--seed", type=int, required=True)
    parser.add_argument("--case", type=int, help="try only this one, and leave its files")
    options = parser.parse_args()
    print(f"seed {options.seed}", flush=True)
    root = Path.cwd() / f"fuzz-{options.seed}"
    root.mkdir()
    for name in LOADED:
        import_module(f"force_diffusion.{name}")
    for name in ("run", "figures", "ensemble"):
        commands.said([name, "--help"])
    loops.loops()
    end, wrong = time.monotonic() + options.seconds, 0
    statuses: defaultdict[str, Counter[int]] = defaultdict(Counter)
    for number in count() if options.case is None else [options.case]:
        if time.monotonic() > end:
            break
        folder = root / str(number)
        folder.mkdir()
        kind, status, what = ended(options.seed, number, folder)
        statuses[kind][status] += 1
        if what:
            wrong += 1
            print(f"case {number}, {kind}: {what}\n", flush=True)
        if options.case is None:
            shutil.rmtree(folder)
    for kind, found in sorted(statuses.items()):
        print(f"{kind}: {found.total()}, by exit status {dict(sorted(found.items()))}")
    print(f"{sum(found.total() for found in statuses.values())} cases, {wrong} wrong")
    return 1 if wrong else 0


if __name__ == "__main__":
    raise SystemExit(main())
