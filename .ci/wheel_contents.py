"""Compare the contents of a wheel with what is tracked: wheel_contents.py CHECKOUT WHEEL."""

import re
import subprocess
import sys
import tomllib
from email import message_from_bytes
from email.policy import default
from pathlib import Path
from zipfile import ZipFile


def expected(checkout: Path) -> set[str]:
    """Every tracked file of a room, under the name that it has when it is installed."""
    project = tomllib.loads((checkout / "pyproject.toml").read_text(encoding="utf-8"))
    rooms = {folder: name for name, folder in project["tool"]["setuptools"]["package-dir"].items()}
    listed = subprocess.run(
        ["git", "-C", str(checkout), "ls-files", "-z", *rooms],
        capture_output=True, text=True, check=True,
    ).stdout  # fmt: skip
    names = set()
    for path in listed.split("\0")[:-1]:
        room, rest = path.split("/", 1)
        names.add(f"{rooms[room].replace('.', '/')}/{rest}")
    return names


def main(checkout: Path, wheel: Path) -> int:
    """Say what differs; 1 if anything does."""
    with ZipFile(wheel) as archive:
        names = set(archive.namelist())
        info = next(name for name in names if name.endswith(".dist-info/METADATA"))
        metadata = message_from_bytes(archive.read(info), policy=default)
    meta = {name for name in names if name.startswith(info.removesuffix("METADATA"))}
    wanted = expected(checkout)
    wrong = [f"not in the wheel: {name}" for name in sorted(wanted - names)]
    wrong += [f"in the wheel, and not tracked: {name}" for name in sorted(names - meta - wanted)]
    if not any(name.endswith("/licenses/LICENSE") for name in meta):
        wrong.append("the licence is not in the wheel")
    links = r"""(?:\]\(\s*|^\[[^]]+\]:\s*|(?:src|href)\s*=\s*["']?)([^)\s"'>]+)"""
    for target in re.findall(links, metadata.get_content(), re.MULTILINE):
        if not re.match(r"https://|#", target):
            wrong.append(f"a link of the description leads nowhere once it is installed: {target}")
    print("\n".join(wrong) or f"{wheel.name}: {len(wanted)} files, as they are tracked")
    return 1 if wrong else 0


if __name__ == "__main__":
    raise SystemExit(main(Path(sys.argv[1]), Path(sys.argv[2])))
