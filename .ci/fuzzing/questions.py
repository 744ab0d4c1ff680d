"""Scenes that a case is made of: tiny ones that are sound, and ones that are changed."""

import shutil
from pathlib import Path
from random import Random

from force_diffusion import numeric

SCENES = sorted(Path(numeric.__file__).parents[1].joinpath("scenes").glob("*.toml"))
QUANTITIES = ["contact_forces", "contact", "profile", "histogram", "response", "positions"]
Sections = dict[str, dict[str, object]]
"""Values are written as TOML."""

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
    "ask.quantity": [f'"{quantity}"' for quantity in QUANTITIES],
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


def tiny(random: Random) -> Sections:
    """Draw a scene that is solved in a moment, and that most commands answer."""
    spheres = random.random() < 0.25
    height = random.randrange(1, 4 if spheres else 6)
    packing = {"height": height, "width": random.randrange(height + 1, 6 if spheres else 9)}
    top, contact = [height % 2, height], [0, 0, random.choice("+-")]
    if spheres:
        packing["dimension"] = 3
        top, contact = [0, 0, height], [0, 0, 0, random.choice("123")]
    disorder = {
        "kind": random.choice(['"uniform"', '"normal"', '"two-point"']),
        "relative_std": random.choice(["1e-3", "1e-2", "0.03", "0.06", "1e-9", "1e-100", "0"]),
        "seed": random.randrange(1000),
    }
    load, quantity = random.choice(["surface", "bulk", "point"]), random.choice(QUANTITIES)
    found: Sections = {"packing": packing, "disorder": disorder, "load": {}, "effects": {}}
    if quantity == "response" or load == "point":
        found["load"] = {"kind": '"point"', "at": top}
    elif load == "bulk":
        found["load"] = {"kind": '"bulk"', "angle_deg": random.choice([0, 5, -20, 31])}
    found["ask"] = {"quantity": f'"{quantity}"'}
    if quantity == "contact":
        found["ask"]["at"] = str(contact).replace("'", '"')
    elif random.random() < 0.3:
        found["ask"]["realisations"] = random.choice([2, 3])
    elif quantity in {"contact_forces", "positions"} and random.random() < 0.3:
        found["effects"]["contacts"] = '"unilateral"'
    return found


def mild(random: Random) -> str:
    """Write a scene that is changed so little that about half of all are answered."""
    sections = tiny(random)
    for key in random.sample(list(GOOD), random.choice([0, 0, 0, 1, 1, 2])):
        section, _, name = key.partition(".")
        sections[section][name] = random.choice(GOOD[key])
    return "\n".join(
        f"[{name}]\n" + "".join(f"{key} = {value}\n" for key, value in keys.items())
        for name, keys in sections.items()
    )


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
    return bytes(content)
