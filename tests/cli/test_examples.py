"""``examples``, and ``--version``."""

from pathlib import Path

import pytest

import force_diffusion as fd
from force_diffusion.__main__ import main

ROOT = Path(__file__).parents[2]
SCENES = {
    path.name: path.read_bytes()
    for path in (ROOT / "scenes").iterdir()
    if path.is_file() and path.suffix != ".py"
}


def contents(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in folder.iterdir()}


def test_all_are_copied_and_named(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "new" / "scenes"
    for options in ([], ["--overwrite"]):
        assert main(["examples", str(out), *options]) == 0
        assert contents(out) == SCENES
        assert capsys.readouterr().out.splitlines() == [str(out / name) for name in sorted(SCENES)]
    (out / "mine.toml").write_text("mine")
    assert main(["examples", str(out), "--overwrite"]) == 2
    assert "doesn't write, such as 'mine.toml'" in capsys.readouterr().err
    assert contents(out) == {**SCENES, "mine.toml": b"mine"}


def test_the_version_is_that_of_the_package(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["--version"]) == 0
    assert capsys.readouterr().out == f"force-diffusion {fd.__version__}\n"
