"""What ``pyproject.toml`` says of the packages; ``.ci/wheel`` tries the wheel itself."""

import tomllib
from pathlib import Path

import force_diffusion as fd

ROOT = Path(__file__).parents[1]
CITATION, CHANGES = ((ROOT / name).read_text("utf-8") for name in ("CITATION.cff", "CHANGELOG.md"))
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))


def test_every_folder_of_the_rooms_is_a_package():
    setuptools = PROJECT["tool"]["setuptools"]
    packages = []
    for name, room in setuptools["package-dir"].items():
        for module in (ROOT / room).rglob("*.py"):
            inner = module.parent.relative_to(ROOT / room).parts
            packages.append(".".join([name, *inner]))
    assert sorted(setuptools["packages"]) == sorted(set(packages))


def test_one_version_everywhere():
    assert f"\nversion: {fd.__version__}\n" in CITATION
    newest = next(line for line in CHANGES.splitlines() if line.startswith("## "))
    assert newest.removeprefix("## ").split(",")[0] == fd.__version__
