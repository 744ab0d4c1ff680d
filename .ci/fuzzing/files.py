"""Files that a case reads: arrays and tables in which something is odd."""

import io
from pathlib import Path
from random import Random

import numpy as np


def _damaged(random: Random, content: bytes) -> bytes:
    """Change some bytes, most near the front, where headers are; or cut the end off."""
    changed = bytearray(content)
    for _ in range(random.choice([0, 1, 1, 2, 8])):
        at = random.randrange(min(len(changed), random.choice([12, 128, len(changed)])))
        changed[at] = random.choice([random.randrange(256), *b"(){}',0123456789<>|fiuOc"])
    return bytes(changed[: random.randrange(len(changed))] if random.random() < 0.1 else changed)


def _number(random: Random) -> str:
    odd = ["0", "-1", "1e400", "1e308", "-1e-400", "1e999", "2", "x", str(2**70)]
    return random.choice(["1", "1", "1.001", "0.99", *odd])


def array(random: Random, folder: Path) -> list[str]:
    """Give radii in a NumPy file that is damaged, or whose numbers are odd."""
    values = np.full((4, 5), 1.0)
    odd = [1.0, 1.0, 1.0, 1.0, 1.0, np.nan, np.inf, 1.7e308, 1e-320, -1.0, 1e200]
    values += np.array([0, random.choice([0, 1e-3, 0.01])] * 10).reshape(4, 5)
    values[random.randrange(4), random.randrange(5)] = random.choice(odd)
    kinds = ["<f8"] * 9 + [">f8", "<f4", "<i8", "|b1", "<c16", "<U3"]
    with np.errstate(all="ignore"):
        given = values.astype(random.choice(kinds))
    buffer = io.BytesIO()
    random.choice([np.save] * 8 + [np.savez])(buffer, given)
    content = buffer.getvalue()
    content = content if random.random() < 0.3 else _damaged(random, content)
    (folder / "radii.npy").write_bytes(content)
    return _of_file(folder, "radii.npy", random)


def table(random: Random, folder: Path) -> list[str]:
    """Give radii in a table of which one place or number is odd."""
    step, beads = 7**0.5 / 2, [(i, j) for j in range(4) for i in range(j % 2, 10, 2)]
    header = random.choice(["x,y,r", "i,j,r", "i,j,delta_r"])
    rows = [[str(i), str(j), "1" if header[-2] == "," else "0"] for i, j in beads]
    if header[0] == "x":
        rows = [[str(1.5 * i), str(step * j), "1"] for i, j in beads]
    for _ in range(random.choice([0, 1, 1, 1, 2])):
        rows[random.randrange(len(rows))][random.choice([0, 1, 2, 2, 2])] = _number(random)
    if random.random() < 0.2:
        header, rows = "i,j,fx,fy", [["0", "2", _number(random), "-1"], ["4", "2", "0", "-1"]]
    text = "\n".join([header, *(",".join(row) for row in rows)])
    (folder / "radii.csv").write_text(text, encoding="utf-8")
    return _of_file(folder, "radii.csv", random)


def _of_file(folder: Path, name: str, random: Random) -> list[str]:
    quantity = random.choice(["profile", "contact_forces", "histogram"])
    unit = random.choice([""] * 6 + [", radius = 1e-100", ", radius = 1e300"])
    lines = [f"packing = {{height = 3, width = 5{unit}}}", f"ask = {{quantity = '{quantity}'}}"]
    loads = (folder / name).read_bytes().startswith(b"i,j,fx")
    lines.append(f"{'load' if loads else 'disorder'} = {{kind = 'file', file = '{name}'}}")
    (folder / "scene.toml").write_text("\n".join(lines), encoding="utf-8")
    command = random.choice([["run"]] * 12 + [["explain"]] * 7 + [["figures", "--out", "out"]])
    return [*command, "scene.toml"]
