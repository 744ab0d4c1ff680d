"""Scenes that a case is made of: tiny ones that are sound, and ones that are changed."""

import json
import shutil
from pathlib import Path
from random import Random
from typing import Any

from force_diffusion import numeric

SCENES = sorted(Path(numeric.__file__).parents[1].joinpath("scenes").glob("*.toml"))
Sections = dict[str, dict[str, Any]]

# Values, as TOML has them, that are good at least somewhere: changes reach beyond the reader.
GOOD = {
    "packing.height": ["1", "2", "3", "5", "9"],
    "packing.dimension": ["2", "3", "4"],
    "packing.width": ["1", "2", "3", "4", "8", "16"],
    "packing.spacing": ["2.05", "3.0", "3.4641", "3.99", "4.0"],
    "packing.radius": ["1", "1e-100", "1e100", "1e-400", "0.5"],
    "packing.allow_images": ["true", "false"],
    "disorder.kind": ['"uniform"', '"normal"', '"two-point"', '"file"'],
    "disorder.relative_std": ["0", "1e-30", "1e-9", "1e-3", "0.01", "0.1"],
    "disorder.seed": ["0", "7", "18446744073709551615"],
    "load.kind": ['"surface"', '"bulk"', '"point"', '"file"'],
    "load.magnitude": ["1", "1e-60", "3.7", "1e60", "1e400"],
    "load.angle_deg": ["0", "10", "-29", "60", "95", "-180"],
    "load.at": ["[0, 0, 3]", "[0, 4]", "[1, 1]", "[0, 0]", "[0, 2]"],
    "effects.geometry": ['"ordered"', '"exact"', '"first-order"'],
    "effects.contacts": ['"unilateral"', '"bilateral"'],
    "effects.most_programs": ["1", "3", "1000"],
    "effects.most_seconds": ["1e-3", "0.5", "60"],
    "ask.quantity": [
        '"contact_forces"', '"contact"', '"profile"', '"histogram"', '"response"', '"positions"',
    ],
    "ask.tolerance": ["1e-3", "1e-12", "1e-30"],
    "ask.certified": ["true", "false"],
    "ask.realisations": ["1", "2", "5"],
    "ask.bins": ["1", "2", "10"],
    "ask.layers": ["[0]", "[0, 2]", "[1]"],
    "ask.at": ['[1, 1, 1, "2"]', "[1, 1]", '[1, 1, "+"]', '[0, 0, "-"]', "[0, 0, 1]"],
}  # fmt: skip
# What is good nowhere, or means something else there.
VALUES = [
    "0", "-1", "1", "2", "7", "1e-3", "1e-300", "1e-5000", "1e999999999", "-0.0", "nan", "-inf",
    "true", "[]", "[[[[1]]]]", "[0, 0]", '[0, 0, "+"]', '[-7, 1, "-"]', "{}", '""', '"surface"',
    '"exact"', '"contact"', '"normal"', '"file"', '"../.."', '"/dev/zero"', '"radii.csv"',
    '"\\u0000"', '"\\u001b[2J"', "1979-05-27", "1_000", "0x" + "f" * 5000, "9" * 5000,
    "1000000000000", "18446744073709551616", "3.46410161513775458705489268301174487", "2.0", "2.1",
]  # fmt: skip
KEYS = [*(key.partition(".")[2] for key in GOOD), "file", "a.b.c.d", '"\\u2028"', "heigth"]
WORDS = ["i,j,fx,fy", "i,j,delta_r", "1,1,0,-1", "0,0,1e-3", "x", "1,1,nan,1", "\x00", "9" * 400]


def toml(sections: Sections) -> str:
    """Write sections; values that are lists or words are written as JSON has them."""
    return "\n".join(
        f"[{name}]\n" + "".join(f"{key} = {_written(value)}\n" for key, value in keys.items())
        for name, keys in sections.items()
    )


def _written(value: Any) -> str:
    return value.text if isinstance(value, Raw) else json.dumps(value)


class Raw:
    """A value that is written as it is."""

    def __init__(self, text: str) -> None:
        self.text = text


def tiny(random: Random) -> Sections:
    """Draw a scene that is solved in a moment, and that most commands answer."""
    dimension = random.choice([2] * 15 + [3] * 5)
    spheres = dimension > 2
    height = random.randrange(1, 4 if spheres else 6)
    width = random.randrange(height + 1, 6 if spheres else 9)
    packing: dict[str, Any] = {"height": height, "width": width}
    if spheres:
        packing["dimension"] = dimension
    elif random.random() < 0.3:
        packing["spacing"] = Raw(random.choice(["2.1", "2.5", "3.0", "3.4"]))
    std = random.choice(["1e-3", "1e-2", "0.03", "0.06", "1e-9", "1e-100", "0"])
    kind = random.choice(["uniform", "normal", "two-point"])
    seed = random.randrange(1000)
    found: Sections = {
        "packing": packing,
        "disorder": {"kind": kind, "relative_std": Raw(std), "seed": seed},
    }
    load = random.choice(["surface", "surface", "bulk", "point"])
    found["load"] = {"kind": load}
    if load == "point":
        found["load"]["at"] = bead(random, height, width, dimension, lowest=1)
    elif random.random() < 0.3:
        found["load"]["angle_deg"] = random.choice([5, -20, 31])
    quantities = ["contact", "contact_forces", "positions", "profile", "histogram"]
    quantities += ["response"] * 2 * (load == "point")
    ask: dict[str, Any] = {"quantity": random.choice(quantities)}
    found["effects"] = {}
    if ask["quantity"] == "contact":
        branch = random.choice("123" if spheres else "+-")
        ask["at"] = [*bead(random, height - 1, width, dimension), branch]
    elif random.random() < 0.3:
        ask["realisations"] = random.choice([2, 3])
    if random.random() < 0.25:
        found["effects"]["geometry"] = random.choice(["ordered", "first-order"])
    elif random.random() < 0.1 and not spheres and width > 2:
        found["effects"]["contacts"] = "unilateral"
        ask = {"quantity": random.choice(["contact_forces", "positions"])}
    return {**found, "ask": ask}


def bead(random: Random, top: int, width: int, dimension: int, lowest: int = 0) -> list[int]:
    """Draw a bead."""
    j = random.randrange(lowest, top + 1)
    if dimension > 2:
        return [*(random.randrange(width) for _ in range(dimension - 1)), j]
    return [2 * random.randrange(width) + j % 2, j]


def changed(random: Random, sections: Sections, times: int) -> Sections:
    """Change some keys to what is good somewhere."""
    found = {name: dict(keys) for name, keys in sections.items()}
    for key in random.sample(list(GOOD), times):
        section, _, name = key.partition(".")
        found[section][name] = Raw(random.choice(GOOD[key]))
    return found


def mild(random: Random) -> str:
    """Write a scene that is changed so little that about half of all are answered."""
    return toml(changed(random, tiny(random), random.choice([0, 0, 0, 1, 1, 2])))


def wild(random: Random, folder: Path) -> bytes:
    """Write an example scene with anything changed, and a table of radii beside it."""
    source = random.choice(SCENES)
    shutil.copy(source.with_name("radii.csv"), folder)
    lines = source.read_text(encoding="utf-8").splitlines()
    for _ in range(random.choice([0, 1, 1, 1, 2, 3, 8])):
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
    if random.random() < 0.2:
        for _ in range(random.choice([1, 1, 5])):
            content[random.randrange(len(content))] = random.randrange(256)
    if random.random() < 0.1:
        rows = [random.choice(WORDS) for _ in range(random.randrange(6))]
        (folder / "radii.csv").write_text("\n".join(rows), encoding="utf-8")
    return bytes(content)
