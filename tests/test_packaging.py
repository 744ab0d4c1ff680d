"""What ``pyproject.toml`` says of the packages; ``.ci/wheel`` tries the wheel itself."""

import tomllib
from pathlib import Path

ROOT = Path(__file__).parents[1]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))


def test_every_folder_of_the_rooms_is_a_package() -> None:
    setuptools = PROJECT["tool"]["setuptools"]
    found = []
    for name, room in setuptools["package-dir"].items():
        for module in (ROOT / room).rglob("*.py"):
            inner = module.parent.relative_to(ROOT / room).parts
            found.append(".".join([name, *inner]))
    assert sorted(setuptools["packages"]) == sorted(set(found))
