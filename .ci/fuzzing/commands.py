"""Commands, each over in a moment: they end with a documented status, in words, and leave no half.

A case is drawn by its number alone, so that it can be tried again.
"""

import io
import json
import traceback
from contextlib import redirect_stderr, redirect_stdout
from pathlib import Path
from random import Random
from typing import NamedTuple

import questions

from force_diffusion.__main__ import main as program

ENDED = {0, 2, 3, 130}
NAMES = ["scene.toml"] * 5 + ["$x^{$.toml", "a\x1b[2Jb.toml", "δ.toml"]


class Said(NamedTuple):
    """How a command ended, and what it wrote on its two streams."""

    status: int
    out: str
    err: str


def said(command: list[str]) -> Said:
    """Give a command to the program, in this process."""
    out, err = (io.TextIOWrapper(io.BytesIO(), "utf-8", write_through=True) for _ in range(2))
    with redirect_stdout(out), redirect_stderr(err):
        try:
            status = program(command)
        except SystemExit as end:
            status = end.code if isinstance(end.code, int) else 1
        except Exception:
            status = 1
            traceback.print_exc()
    return Said(status, *(one.buffer.getvalue().decode() for one in (out, err)))


def wrong(command: list[str], found: Said) -> str:
    """Say what was wrong with the end of a command, or nothing."""
    silent = found.status in {2, 3} and not found.err.strip()
    if found.status not in ENDED or "Traceback" in found.err or "Warning:" in found.err or silent:
        return f"ended with status {found.status} and said\n{found.err[-2500:]}"
    raw = {c for c in found.err if not c.isprintable() and c != "\n"}
    if raw:
        return f"echoed {raw} raw"
    if "--json" in command and found.status == 0:
        try:
            json.loads(found.out)
        except ValueError:
            return f"printed no JSON: {found.out[:200]}"
    return ""


def of_mild_scene(random: Random, folder: Path) -> list[str]:
    """Give a scene to a command, about half of which are answered."""
    return _of_scene(random, folder, questions.mild(random).encode())


def of_wild_scene(random: Random, folder: Path) -> list[str]:
    """Give an example scene with anything changed to a command."""
    return _of_scene(random, folder, questions.wild(random, folder))


def _of_scene(random: Random, folder: Path, content: bytes) -> list[str]:
    name = random.choice(NAMES)
    (folder / name).write_bytes(content)
    # one in a hundred is drawn or measured, which takes a second
    if random.random() < 0.01:
        return [random.choice(["figures", "cost"]), name, "--out", "out"]
    command = random.choice(["explain"] + ["run"] * 4 + ["ensemble"] * 3)
    few = ["--realisations", random.choice(["2", "3", "40", "1"]), "--workers", "1"]
    more = random.choice(_options(random)[command]) if random.random() < 0.5 else []
    return [command, name, *few * (command == "ensemble"), *more]


def _options(random: Random) -> dict[str, list[list[str]]]:
    key = random.choice([*questions.GOOD, *questions.KEYS])
    value = random.choice([*questions.GOOD.get(key, []), *questions.VALUES])
    written = ["--out", "out", "--format", random.choice(["npz", "parquet", "csv"])]
    return {
        "explain": [["--json"], ["--tolerance", "1e-30"]],
        "run": [
            ["--json"],
            written,
            ["--tolerance", random.choice(["1e-20", "1e-9", "0", "1e-99999", "x"])],
            ["--tolerance", "1e-15", "--certified"],
            ["--set", f"disorder.seed={random.choice(['5', '-1', '3..5', '9' * 99])}"],
            ["--set", f"{key}={value}"],
            ["--set", f"{key}={value}", "--set", "disorder.seed=3", "--json"],
        ],
        "ensemble": [
            ["--json"],
            written,
            ["--until", random.choice(["1e-300", "0.5", "nan", "-1", "1e-9999", "1e300"])],
            ["--until", "0.9", "--confidence", random.choice(["0.5", "1", "0", "nan"])],
            ["--reach", random.choice(["1", "1e-300", "1e300", "inf", "0"])],
            ["--store", random.choice(["new", "scene.toml", ".", "no/where"])],
        ],
    }
