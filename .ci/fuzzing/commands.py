"""Commands, each over in a moment: they end with a documented status, in words, and leave no half.

A case is drawn by its number alone, so that it can be tried again.
"""

import io
import json
import sys
import traceback
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
    before = sys.stdout, sys.stderr
    streams = [io.TextIOWrapper(io.BytesIO(), encoding="utf-8") for _ in range(2)]
    sys.stdout, sys.stderr = streams
    try:
        status = program(command)
    except SystemExit as end:
        status = end.code if isinstance(end.code, int) else 1
    except Exception:
        status = 1
        traceback.print_exc()
    finally:
        sys.stdout, sys.stderr = before
    return Said(status, *(_written(one) for one in streams))


def _written(stream: io.TextIOWrapper) -> str:
    stream.seek(0)
    return stream.read()


def wrong(command: list[str], found: Said) -> str:
    """Say what was wrong with the end of a command, or nothing."""
    words = found.err
    silent = found.status in {2, 3} and not words.strip()
    if found.status not in ENDED or "Traceback" in words or "Warning:" in words or silent:
        return f"ended with status {found.status} and said\n{words[-2500:]}"
    raw = {c for c in words if not c.isprintable() and c != "\n"}
    if raw:
        return f"echoed {raw} raw"
    if "--json" in command and found.status == 0:
        try:
            json.loads(found.out)
        except ValueError:
            return f"printed no JSON: {found.out[:200]}"
    return ""


def of_scene(random: Random, folder: Path, *, mildly: bool) -> list[str]:
    """Give a scene to a command."""
    name = random.choice(NAMES)
    text = questions.mild(random).encode() if mildly else questions.wild(random, folder)
    (folder / name).write_bytes(text)
    # one in a hundred is drawn or measured, which takes a second
    usual = ["explain"] + ["run"] * 4 + ["ensemble"] * 3
    command = random.choice(usual if random.random() < 0.99 else ["figures", "cost"])
    return [command, name, *_options(random, command)]


def _options(random: Random, command: str) -> list[str]:
    key = random.choice(list(questions.GOOD))
    value = random.choice([random.choice(questions.GOOD[key]), random.choice(questions.VALUES)])
    changes: dict[str, list[list[str]]] = {
        "explain": [[], ["--json"], ["--tolerance", "1e-30"]],
        "run": [
            [],
            ["--json"],
            ["--out", "out"],
            ["--out", "out", "--format", random.choice(["npz", "parquet"])],
            ["--tolerance", random.choice(["1e-20", "1e-9", "0", "1e-99999", "x"])],
            ["--tolerance", "1e-15", "--certified"],
            ["--seed", random.choice(["5", "-1", "1,2", "3..5", "9" * 99])],
            ["--set", f"{key}={value}"],
            ["--set", f"{key}={value}", "--set", "disorder.seed=3", "--json"],
            ["--set", f"{random.choice(questions.KEYS)}={value}"],
        ],
        "ensemble": [
            [],
            ["--json"],
            ["--covariance", "--out", "out"],
            ["--covariance", "--json"],
            ["--out", "out", "--format", random.choice(["npz", "parquet"])],
            ["--until", random.choice(["1e-300", "0.5", "nan", "-1", "1e-9999", "1e300"])],
            ["--until", "0.9", "--confidence", random.choice(["0.5", "1", "0", "nan"])],
            ["--reach", random.choice(["1", "1e-300", "1e300", "inf", "0"])],
            ["--store", random.choice(["new", "scene.toml", ".", "no/where"])],
        ],
        "figures": [["--json"]],
        "cost": [["--json"]],
    }
    if random.random() < 0.5:
        return _few(random, command)
    return [*_few(random, command), *random.choice(changes[command])]


def _few(random: Random, command: str) -> list[str]:
    few = ["--realisations", random.choice(["2", "3", "3", "40", "1"]), "--workers", "1"]
    return {"ensemble": few, "figures": ["--out", "out"], "cost": ["--out", "out"]}.get(command, [])
