"""``examples``, and ``--version``."""

import os
import tomllib
from pathlib import Path

import pytest

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
    assert main(["examples", str(out)]) == 0
    assert contents(out) == SCENES
    assert capsys.readouterr().out.splitlines() == [str(out / name) for name in sorted(SCENES)]
    (out / "radii.csv").unlink()
    (out / "mine.toml").write_text("mine")
    assert main(["examples", str(out)]) == 0
    assert capsys.readouterr().out == f"{out / 'radii.csv'}\n"
    assert main(["examples", str(out)]) == 0
    assert f"All {len(SCENES)} files are in {out} already" in capsys.readouterr().out
    assert (out / "mine.toml").read_text() == "mine"


@pytest.mark.parametrize("kind", ["another file", "as long", "folder", "dangling link", "pipe"])
def test_what_differs_is_named_and_left_alone(
    kind: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "radii.csv"
    if kind == "folder":
        path.mkdir()
    elif kind == "dangling link":
        path.symlink_to("nowhere")
    elif kind == "pipe":
        os.mkfifo(path)
    else:
        length = 4 if kind == "another file" else len(SCENES["radii.csv"])
        path.write_text("x" * length)
    assert main(["examples", str(tmp_path)]) == 2
    assert f"'{path}' is " in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == [path]
    status = main(["examples", str(tmp_path), "--overwrite"])
    if kind == "folder":
        assert (status, list(tmp_path.iterdir())) == (2, [path])
    else:
        assert (status, contents(tmp_path)) == (0, SCENES)


@pytest.mark.parametrize(
    ("words", "says"),
    [
        ([], "Missing argument 'DIR'"),
        ([""], "'' names no folder"),
        (["a", "b"], "b"),
        (["file"], "'file' is a file"),
        (["file/below"], "'file' is a file"),
        (["link"], "'link' is a link to 'nowhere', which is not there"),
        (["link/below"], "'link' is a link to 'nowhere', which is not there"),
        (["--out", "a"], "--out"),
    ],
)
def test_wrong_folders(
    words: list[str], says: str, tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str],
) -> None:  # fmt: skip
    monkeypatch.chdir(tmp_path)
    Path("file").write_text("mine")
    Path("link").symlink_to("nowhere")
    assert main(["examples", *words]) == 2
    assert says in capsys.readouterr().err
    assert sorted(path.name for path in tmp_path.iterdir()) == ["file", "link"]


def test_the_version_is_that_of_the_project(capsys: pytest.CaptureFixture[str]) -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    assert main(["--version"]) == 0
    assert capsys.readouterr().out == f"force-diffusion {project['version']}\n"
    citation = (ROOT / "CITATION.cff").read_text(encoding="utf-8")
    assert f"\nversion: {project['version']}\n" in citation
