"""Scenes, files and stores that nobody would write: each ends in words and a documented status.

``fuzz.py --seconds 60 --seed N`` tries cases until the time is over, each in a process of its own,
with limits on memory and time. Case K of a seed is tried again with ``--case K``; its files stay in
the current folder. Exit status: 0 all ended well, 1 some did not.
"""

import argparse
import io
import json
import os
import resource
import shutil
import signal
import sqlite3
import sys
import time
from collections import Counter
from contextlib import redirect_stderr, redirect_stdout
from pathlib import Path
from random import Random
from typing import Any

import numpy as np

from force_diffusion import numeric
from force_diffusion.__main__ import main as program

SCENES = sorted(Path(numeric.__file__).parents[1].joinpath("scenes").glob("*.toml"))
PATIENCE = 20.0  # seconds in which what solves nothing has to end
ENOUGH = 3.0  # seconds after which what solves packings is interrupted, and has to end then
MEMORY = 4 * 2**30
ENDED = {0, 2, 3, 130}
QUICK = {"explain", "ensemble-status", "check-packings"}

# Values that are good at least somewhere, so that changes reach beyond what reads a scene.
GOOD = {
    "height": ["1", "2", "3", "5", "9", "16"],
    "dimension": ["2", "3", "3"],
    "width": ["1", "2", "3", "4", "8", "32"],
    "spacing": ["2.05", "3.0", "3.4641", "3.99", "4.0"],
    "kind": ['"uniform"', '"normal"', '"surface"', '"bulk"', '"point"'],
    "relative_std": ["0", "1e-30", "1e-9", "1e-3", "0.01", "0.1"],
    "angle_deg": ["0", "10", "-29", "60"],
    "pressure": ["0", "0.5", "1"],
    "at": ["[0, 0, 3]", '[1, 1, 1, "2"]', "[0, 4]", "[1, 1]", '[1, 1, "+"]', '[0, 0, "-"]'],
    "allow_images": ["true", "false"],
    "geometry": ['"ordered"', '"exact"', '"first-order"'],
    "contacts": ['"unilateral"', '"bilateral"'],
    "protocol": ['"linear-programs"', '"event-driven"'],
    "most_events": ["1", "3", "1000"],
    "most_seconds": ["1e-3", "0.5", "60"],
    "stop_at_tension": ["true", "false"],
    "quantity": [
        '"contact_forces"', '"contact"', '"profile"', '"histogram"', '"response"', '"positions"',
        '"base_reactions"',
    ],
    "tolerance": ["1e-3", "1e-12", "1e-30"],
    "certified": ["true", "false"],
    "realisations": ["1", "2", "5"],
    "bins": ["2", "10"],
    "layers": ["[0]", "[0, 2]"],
}  # fmt: skip
SECTIONS = {
    "packing": ["height", "width", "dimension", "spacing", "allow_images"],
    "disorder": ["kind", "relative_std"],
    "load": ["kind", "angle_deg", "pressure", "at"],
    "effects": [
        "geometry",
        "contacts",
        "protocol",
        "most_events",
        "most_seconds",
        "stop_at_tension",
    ],
    "ask": ["quantity", "tolerance", "certified", "realisations", "bins", "layers", "at"],
}
VALUES = [
    "0", "-1", "1", "2", "7", "1e-3", "1e-300", "1e-5000", "1e999999999", "-0.0", "nan", "-inf",
    "true", "[]", "[[[[1]]]]", "[0, 0]", '[0, 0, "+"]', '[-7, 1, "-"]', "{}", '""', '"surface"',
    '"exact"', '"contact"', '"normal"', '"file"', '"../.."', '"/dev/zero"', '"radii.csv"',
    '"\\u0000"', '"\\u001b[2J"', "1979-05-27", "1_000", "0x" + "f" * 5000, "9" * 5000,
    "1000000000000", "18446744073709551616", "3.46410161513775458705489268301174487", "2.0", "2.1",
]  # fmt: skip
KEYS = [
    "height", "width", "spacing", "radius", "allow_images", "kind", "relative_std", "seed", "file",
    "magnitude", "angle_deg", "at", "geometry", "stop_at_tension", "quantity", "tolerance",
    "certified", "realisations", "bins", "layers", "a.b.c.d", '"\\u2028"', "heigth",
]  # fmt: skip
WORDS = ["i,j,fx,fy", "i,j,delta_r", "1,1,0,-1", "0,0,1e-3", "x", "1,1,nan,1", "\x00", "9" * 400]


def set_key(lines: list[str], section: str, key: str, value: str) -> list[str]:
    """Give the lines of a scene in which a key has this value; its section is added if missing."""
    head = f"[{section}]"
    if head not in lines:
        return [*lines, head, f"{key} = {value}"]
    first = lines.index(head) + 1
    stop = next((k for k in range(first, len(lines)) if lines[k].startswith("[")), len(lines))
    within = [line for line in lines[first:stop] if line.split("=")[0].strip() != key]
    return [*lines[:first], f"{key} = {value}", *within, *lines[stop:]]


def scene(random: Random, folder: Path) -> list[str]:
    """Write an example scene with something changed, and say what is asked of it."""
    source = random.choice(SCENES)
    shutil.copy(source.with_name("radii.csv"), folder)
    lines = source.read_text(encoding="utf-8").splitlines()
    mild = random.random() < 0.75
    for _ in range(random.choice([0, 1, 1, 2, 4]) if mild else 0):
        section = random.choice(list(SECTIONS))
        key = random.choice(SECTIONS[section])
        lines = set_key(lines, section, key, random.choice(GOOD[key]))
    for _ in range(0 if mild else random.choice([1, 1, 1, 2, 3, 8])):
        at = random.randrange(len(lines))
        kind = random.randrange(6)
        if kind <= 1 and "=" in lines[at]:
            lines[at] = lines[at].split("=")[0] + f"= {random.choice(VALUES)}"
        elif kind == 2:
            lines.insert(at, f"{random.choice(KEYS)} = {random.choice(VALUES)}")
        elif kind == 3:
            del lines[at]
            lines = lines or ["[packing]"]
        elif kind == 4:
            lines.insert(at, random.choice(lines))
        else:
            lines.insert(at, f"[{random.choice(['packing', 'disorder', 'load', 'effects', 'x'])}]")
    content = bytearray("\n".join(lines).encode())
    if not mild and random.random() < 0.2:
        for _ in range(random.choice([1, 1, 5])):
            content[random.randrange(len(content))] = random.randrange(256)
    name = random.choice(["scene.toml"] * 5 + ["$x^{$.toml", "a\x1b[2Jb.toml", "δ.toml"])
    (folder / name).write_bytes(content)
    if random.random() < 0.1:
        rows = [random.choice(WORDS) for _ in range(random.randrange(6))]
        (folder / "radii.csv").write_text("\n".join(rows), encoding="utf-8")
    command = random.choice(["explain"] * 2 + ["run"] * 2 + ["ensemble"] * 2 + ["figures", "cost"])
    options = {
        "explain": [[], ["--json"]],
        "run": [
            [],
            ["--json"],
            ["--out", "out"],
            ["--out", "out", "--format", random.choice(["npz", "parquet"])],
            ["--tolerance", "1e-20"],
            ["--set", f"packing.height={random.choice(VALUES)}"],
            ["--set", f"{random.choice(KEYS)}={random.choice(VALUES)}"],
        ],
        "ensemble": [
            ["--realisations", "3", "--workers", "1", *more]
            for more in (
                [],
                ["--covariance", "--out", "out"],
                ["--covariance", "--json"],
                ["--until", random.choice(["1e-300", "0.5", "nan", "-1", "1e-9999"])],
                ["--reach", random.choice(["1", "1e-300", "1e300", "inf"])],
            )
        ],
        "figures": [["--out", "out"]],
        "cost": [["--out", "out"]],
    }
    return [command, name, *random.choice(options[command])]


def store(random: Random, folder: Path, whole: Path) -> list[str]:
    """Damage a store, its bytes or what it says, and look at it or go on from it."""
    path = folder / "store"
    shutil.copy(whole, path)
    shutil.copy(whole.with_name("scene.toml"), folder)
    kind = random.randrange(4)
    if kind == 0:
        content = bytearray(path.read_bytes())
        for _ in range(random.choice([1, 1, 2, 20])):
            content[random.randrange(len(content))] ^= 1 << random.randrange(8)
        path.write_bytes(content)
    elif kind == 1:
        content = bytearray(path.read_bytes())
        path.write_bytes(content[: random.randrange(len(content))] + random.randbytes(9) * 9)
    else:
        _forge(random, path)
    if random.random() < 0.5:
        return ["ensemble-status", "store", *random.choice([[], ["--json"]])]
    return ["ensemble", "scene.toml", "--store", "store", "--workers", "1"]


def _damaged(random: Random, content: bytes) -> bytes:
    """Change some bytes, most near the front, where headers are; or cut the end off."""
    changed = bytearray(content)
    for _ in range(random.choice([0, 1, 1, 2, 8])):
        at = random.randrange(min(len(changed), random.choice([12, 128, len(changed)])))
        changed[at] = random.choice([random.randrange(256), *b"(){}',0123456789<>|fiuOc"])
    return bytes(changed[: random.randrange(len(changed))] if random.random() < 0.1 else changed)


def _number(random: Random) -> str:
    return random.choice(["0", "-1", "1e400", "1e308", "-1e-400", "1e999", "2", "x", str(2**70)])


def array(random: Random, folder: Path) -> list[str]:
    """Give radii in a NumPy file that is damaged, or whose numbers are odd."""
    values = np.full((4, 5), 1.0)
    odd = [1.0, 1.0, 1.0, 1.0, 1.0, np.nan, np.inf, 1.7e308, 1e-320, -1.0, 1e200]
    values[random.randrange(4), random.randrange(5)] = random.choice(odd)
    with np.errstate(all="ignore"):
        kept: Any = values.astype(random.choice(["<f8", ">f8", "<f4", "<i8", "|b1", "<c16", "<U3"]))
    buffer = io.BytesIO()
    random.choice([np.save, np.save, np.save, np.savez])(buffer, kept)
    (folder / "radii.npy").write_bytes(_damaged(random, buffer.getvalue()))
    return _of_file(folder, "radii.npy", random)


def table(random: Random, folder: Path) -> list[str]:
    """Give radii in a table of which one place or number is odd."""
    step, beads = 7**0.5 / 2, [(i, j) for j in range(4) for i in range(j % 2, 10, 2)]
    header = random.choice(["x,y,r", "i,j,r", "i,j,delta_r"])
    rows = [[str(i), str(j), "1" if header[-2] == "," else "0"] for i, j in beads]
    if header[0] == "x":
        rows = [[str(1.5 * i), str(step * j), "1"] for i, j in beads]
    rows[random.randrange(len(rows))][random.randrange(3)] = _number(random)
    text = "\n".join([header, *(",".join(row) for row in rows)])
    (folder / "radii.csv").write_text(text, encoding="utf-8")
    return _of_file(folder, "radii.csv", random)


def _of_file(folder: Path, name: str, random: Random) -> list[str]:
    quantity = random.choice(["profile", "contact_forces", "histogram"])
    unit = random.choice(["", "", ", radius = 1e-100", ", radius = 1e300"])
    lines = [f"packing = {{height = 3, width = 5{unit}}}", f"ask = {{quantity = '{quantity}'}}"]
    lines.append(f"disorder = {{kind = 'file', file = '{name}'}}")
    (folder / "scene.toml").write_text("\n".join(lines), encoding="utf-8")
    return [*random.choice([["run"], ["explain"], ["figures", "--out", "out"]]), "scene.toml"]


PACKING: dict[str, Any] = {
    "period": "12",
    "fixed": 2,
    "radii": ["1"] * 3,
    "loads": [["0", "0"], ["0", "0"], ["0", "-1"]],
    "centres": [["0", "0"], ["3", "0"], ["1.5", "1.32287565553229529525080787681963021285513"]],
    "contacts": [[2, 0], [2, 1]],
}


def packings(random: Random, folder: Path) -> list[str]:
    """Give a file of packings in which something is odd."""
    packing = json.loads(json.dumps(PACKING))
    for _ in range(random.choice([1, 1, 2])):
        key = random.choice(list(PACKING))
        odd: Any = random.choice(
            [_number(random), 2**70, -1, [], None, 1.5, [[_number(random)] * 2]]
        )
        if isinstance(packing[key], list) and packing[key] and random.random() < 0.8:
            at = random.randrange(len(packing[key]))
            if isinstance(packing[key][at], list) and packing[key][at]:
                packing[key][at][random.randrange(len(packing[key][at]))] = odd
            else:
                packing[key][at] = odd
        else:
            packing[key] = odd
    text = json.dumps({"format": "force-diffusion packings 1", "packings": [packing]}).encode()
    damaged = _damaged(random, text) if random.random() < 0.2 else text
    (folder / "packings.json").write_bytes(damaged)
    return ["check-packings", "packings.json", *random.choice([[], ["--json"]])]


def _forge(random: Random, path: Path) -> None:
    database = sqlite3.connect(path, isolation_level=None)
    tables = {"about": ["name", "content", "checksum"], "sums": ["first", "stop", "content"]}
    values = [
        None, 0, -1, 2**63 - 1, 1.5, "", "[", "null", "[" * 50_000, '{"a": 1}', "\x1b[2J",
        "nan", b"", b"\xff\xfe", random.randbytes(64), "9" * 5000, "x" * 10**6,
    ]  # fmt: skip
    statements: list[tuple[str, tuple[object, ...]]] = []
    for _ in range(random.choice([1, 1, 3])):
        table = random.choice(list(tables))
        column = random.choice(tables[table])
        statements.append(
            random.choice(
                [
                    (f"UPDATE {table} SET {column} = ?", (random.choice(values),)),
                    (f"DELETE FROM {table} WHERE rowid = ?", (random.randrange(4),)),
                    (f"DROP TABLE {table}", ()),
                    (f"ALTER TABLE {table} ADD COLUMN x CHECK (abs(x) > randomblob(9))", ()),
                    ("INSERT INTO sums VALUES (?, ?, ?, ?)", (5, 3, b"", "")),
                    (f"PRAGMA user_version = {random.randrange(-5, 5)}", ()),
                    ("CREATE VIEW v AS SELECT * FROM v", ()),
                ]
            )
        )
    for statement, arguments in statements:
        try:
            database.execute(statement, arguments)
        except (sqlite3.Error, OverflowError):
            continue
    database.close()


def ended(folder: Path, command: list[str], statuses: Counter[int]) -> str:
    """Run a command in a process of its own; say what was wrong with its end, or nothing."""
    out, err = folder / "stdout", folder / "stderr"
    child = os.fork()
    if not child:
        os.chdir(folder)
        resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
        for stream, path in ((1, out), (2, err)):
            os.dup2(os.open(path, os.O_WRONLY | os.O_CREAT | os.O_TRUNC), stream)
        signal.signal(signal.SIGINT, signal.default_int_handler)
        sys.stdout, sys.stderr = sys.__stdout__, sys.__stderr__
        try:
            status = program(command)
        except SystemExit as end:
            status = end.code if isinstance(end.code, int) else 1
        except BaseException:
            sys.excepthook(*sys.exc_info())
            status = 1
        sys.stdout.flush()
        os._exit(status)
    end = time.monotonic() + (PATIENCE if command[0] in QUICK else ENOUGH)
    interrupted = False
    while not (done := os.waitpid(child, os.WNOHANG))[0]:
        if time.monotonic() > end:
            os.kill(child, signal.SIGKILL if interrupted else signal.SIGINT)
            interrupted, end = True, end + PATIENCE
        time.sleep(0.002)
    status = os.waitstatus_to_exitcode(done[1])
    statuses[status] += 1
    said = err.read_text(encoding="utf-8", errors="replace")
    if command[0] == "check-packings" and status == 3:  # a verdict, which is no message
        said += out.read_text(encoding="utf-8", errors="replace")
    if interrupted and command[0] in QUICK:
        return f"had no end after {PATIENCE} s"
    if status not in ENDED or "Traceback" in said or (status in {2, 3} and not said.strip()):
        return f"ended with status {status} and said\n{said[-2000:]}"
    raw = {c for c in said if not c.isprintable() and c != "\n"}
    return f"echoed {raw} raw" if raw else ""


def whole_store(folder: Path) -> Path:
    """A sound store, with its scene beside it."""
    folder.mkdir()
    text = SCENES[0].with_name("ensemble.toml").read_text(encoding="utf-8")
    text = text.replace("height = 32", "height = 4").replace("width = 66", "width = 6")
    (folder / "scene.toml").write_text(text, encoding="utf-8")
    command = ["ensemble", "scene.toml", "--realisations", "300", "--store", "store"]
    if wrong := ended(folder, [*command, "--workers", "1"], Counter()):
        raise SystemExit(f"no store could be made: it {wrong}")
    return folder / "store"


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
    with redirect_stdout(io.StringIO()), redirect_stderr(io.StringIO()):
        program(["explain", str(SCENES[0])])  # what every process needs is loaded once
    whole = whole_store(root / "whole")
    statuses: Counter[int] = Counter()
    start, number, wrong = time.monotonic(), options.case or 0, 0
    while number == options.case or (
        options.case is None and time.monotonic() - start < options.seconds
    ):
        random = Random(f"{options.seed} {number}")
        folder = root / str(number)
        folder.mkdir()
        kind = random.choice(["store", "store", *["scene"] * 4, "array", "table", "packings"])
        command = (
            store(random, folder, whole)
            if kind == "store"
            else {"scene": scene, "array": array, "table": table, "packings": packings}[kind](
                random, folder
            )
        )
        if what := ended(folder, command, statuses):
            wrong += 1
            print(f"case {number}: {' '.join(map(repr, command))} {what}\n", flush=True)
        if options.case is None:
            shutil.rmtree(folder)
        number += 1
    print(f"{statuses.total()} cases by status: {dict(sorted(statuses.items()))}, {wrong} wrong")
    return 1 if wrong else 0


if __name__ == "__main__":
    raise SystemExit(main())
