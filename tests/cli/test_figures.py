"""The command ``figures`` as a user calls it."""

import csv
import hashlib
import json
import shlex
from pathlib import Path
from xml.etree import ElementTree

import pytest
from PIL import Image


def check_images(folder: Path, name: str, command: str) -> None:
    with Image.open(folder / f"{name}.png") as image:
        image.load()
        assert min(image.size) > 500  # 300 to the inch
        assert image.info["Description"] == command
        assert len(image.convert("L").getcolors() or []) > 10  # something is drawn
    root = ElementTree.parse(folder / f"{name}.svg").getroot()
    assert root.tag.endswith("svg")
    svg = (folder / f"{name}.svg").read_text(encoding="utf-8")
    assert command in svg
    assert "dc:date" not in svg
    pdf = (folder / f"{name}.pdf").read_bytes()
    assert pdf.startswith(b"%PDF-")
    assert pdf.rstrip().endswith(b"%%EOF")
    assert command.encode() in pdf
    assert b"CreationDate" not in pdf


@pytest.mark.long
def test_figures_name_the_command_that_makes_them_again_to_the_byte(tmp_path, printed, monkeypatch):
    words = ["1", "2", "3", "--heights", "2,4", "--realisations", "16", "--out", "out"]
    contents = []
    for folder in ("a", "b"):
        out = tmp_path / folder / "out"
        out.parent.mkdir()
        monkeypatch.chdir(out.parent)
        stdout = printed("figures", *words)
        contents.append({path.name: path.read_bytes() for path in out.iterdir()})
        words = shlex.split(json.loads((out / "figure1.json").read_text())["command"])[2:]
    assert contents[0] == contents[1]  # the second time by the command that the first one noted
    assert "inside the simultaneous 99% band" in stdout or "outside" in stdout
    for name in ("1", "2", "3"):
        record = json.loads((out / f"figure{name}.json").read_text())
        assert shlex.split(record["command"])[:5] == ["force-diffusion", "figures", "1", "2", "3"]
        check_images(out, f"figure{name}", record["command"])
        for file in record["files"]:
            assert file in contents[0]
            if file.endswith(".csv"):
                lines = (out / file).read_text().splitlines()
                assert lines[:2] == [f"# {record['title']}", f"# {record['command']}"]
                assert len(list(csv.DictReader(lines[2:]))) > 1
    assert [row["of"].partition(":")[0] for row in record["comparisons"]] == ["M = 2", "M = 4"]


def test_heights_that_cannot_be_built(tmp_path, refused):
    """Far above M* beads no longer find a rest."""
    rough = ["--heights", "40", "--relative-std", "0.3", "--realisations", 16]
    message = refused("figures", 3, *rough, "--out", tmp_path / "out")
    assert "figure 3: bead" in message
    assert "less disorder, fewer layers or a smaller spacing" in message
    assert not (tmp_path / "out").exists()


@pytest.mark.usefixtures("without_matplotlib")
def test_without_matplotlib(tmp_path, refused):
    message = refused("figures", "1", "--out", tmp_path / "out", status=3)
    assert "need matplotlib" in message
    assert "force-diffusion[plots]" in message
    assert not (tmp_path / "out").exists()


@pytest.mark.long
@pytest.mark.usefixtures("only_svg")
def test_simpler_models_are_drawn_and_overwritten_with_their_figures(tmp_path, printed):
    out, models = tmp_path / "out", ["--with", "q-model", "--with", "double-y"]
    printed("figures", 3, 4, "--heights", "3", "--realisations", 32, *models, "--out", out)
    assert {"figure3_q_model.csv", "figure4_double_y.csv"} <= {path.name for path in out.iterdir()}
    printed("figures", 1, "--out", out, "--overwrite")
    assert {path.stem for path in out.iterdir()} == {"figure1"}


def test_a_scene_is_answered_and_drawn(tmp_path, printed, refused):
    scene, out = tmp_path / "my $cene.toml", tmp_path / "out"
    scene.write_text(
        "packing = {height = 4, width = 9, spacing = 2.6}\n"
        'disorder = {kind = "two-point", relative_std = 1e-3, seed = 4}\n'
        'ask = {quantity = "profile"}\n'
    )
    printed("figures", scene, "--out", out)
    result = json.loads((out / "my $cene.json").read_text())
    check_images(out, "my $cene", result["command"])
    hashed = hashlib.sha256(scene.read_bytes()).hexdigest()
    source = result["answer"]["source"]
    assert (source["seed"], source["sha256"]["scene"], source["file"]) == (4, hashed, scene.name)
    title, command, *rows = (out / "my $cene.csv").read_text().splitlines()
    assert (title, command) == ("# my $cene: profile", f"# {result['command']}")
    assert len(list(csv.DictReader(rows))) == 8
    again = tmp_path / "other" / scene.name
    for words, says in (([scene, again], "the same files"), ([scene, "--seed", 5], "--seed")):
        assert says in refused("figures", *words, "--out", out)
