"""``derive`` from the outside: what it prints, what it writes, how it fails."""

import errno
import json
import os
import re
import subprocess
import sys
from importlib.metadata import version
from typing import Any

import pytest
from force_diffusion.derivations.commands.output import Output
from force_diffusion.derivations.framework import runner
from force_diffusion.numeric.figures.catalogue import PaperFigure
from force_diffusion.numeric.figures.names import FIGURES

from tests.derivations import fakes


@pytest.fixture
def made_up(monkeypatch: pytest.MonkeyPatch) -> dict[int, object]:
    """Equations 1 and 2 are made-up ones; their verdicts can be chosen."""
    table: dict[int, object] = {1: fakes.PREMISE, 2: fakes.CONCLUSION}
    true = runner.load
    monkeypatch.setattr(runner, "load", lambda number: table.get(number) or true(number))
    return table


def test_premises_are_proved_first(made_up, printed):
    *lines, last = printed("derive", 2, 1).splitlines()
    assert [line.split()[:2] for line in lines] == [["1", "proved"], ["2", "proved"]]
    assert all(re.search(r" \(\d+\.\d\d s\)$", line) for line in lines)
    assert last == "2 proved."


def test_of_a_single_equation_all_steps_and_claims_are_printed(made_up, printed):
    made_up[2] = fakes.with_claim(fakes.guessed)
    premise, blank, *lines = printed("derive", 2).splitlines()
    assert premise.startswith("  1  proved     A premise")
    assert (blank, lines[0]) == ("", "Eq. 2: B")
    steps, claims = lines.index("Steps"), lines.index("Claims")
    assert lines[steps + 1] == "  1. Again:"
    assert "     proved, from Eq. 1" in lines[steps:claims]
    words = f"proved, assuming {fakes.GUESS}"
    assert any(line.startswith(f"  - {words}: doubtful (proof)") for line in lines[claims:])
    assert lines[-2].startswith(f"Eq. 2 is {words} (")
    assert lines[-1] == f"1 proved; 1 proved assuming {fakes.GUESS}."


def test_status_1_says_what_is_wrong(made_up, call):
    made_up[2] = fakes.with_claim(fakes.baffled)
    status, stdout, _ = call("derive", 1, 2)
    assert status == 1
    assert "the claim 'doubtful': nobody knows" in " ".join(stdout.split())
    assert "1 proved; 1 undecided." in stdout


def test_json_follows_its_schema(made_up, tmp_path, call):
    made_up[2] = fakes.with_claim(fakes.baffled)
    status, stdout, stderr = call("derive", 2, 1, 1, "--json", "--out", tmp_path / "out")
    assert (status, stderr) == (1, "")
    content = json.loads(stdout)
    assert list(content) == ["equations"]
    assert [entry["number"] for entry in content["equations"]] == [2, 1]  # it has no premises
    manifest = json.loads((tmp_path / "out" / "manifest.json").read_text())
    assert [entry["number"] for entry in manifest["equations"]] == [1, 2]
    for entry in content["equations"]:
        assert " ".join(entry).startswith("number name title premises verdict assuming checks")
        assert entry["verdict"] in ("proved", "undecided")
        assert (entry["assuming"], entry["refuted as expected"]) == ([], 0)
        assert entry["seconds"] >= 0
        for check in entry["checks"]:
            assert list(check) == ["kind", "name", "verdict", "note", "assuming"]
            assert check["kind"] in ("step", "proof")
            assert check["verdict"] in ("proved", "undecided")


def test_the_output_folder_twice(made_up, tmp_path, call):
    out = tmp_path / "out"
    assert call("derive", "--out", out, 2)[0] == 0
    first = {path.name: path.read_bytes() for path in out.iterdir()}
    assert set(first) == {"eq01.tex", "eq02.tex", "equations.tex", "manifest.json"}
    assert [name for name in first if rb"\documentclass" in first[name]] == ["equations.tex"]
    manifest = json.loads(first["manifest.json"])
    assert manifest["command"] == f"force-diffusion derive --out {out} 2"
    assert manifest["version"] == version("force-diffusion")
    assert [entry["verdict"] for entry in manifest["equations"]] == ["proved", "proved"]
    assert manifest["equations"][1]["premises"] == [1]
    assert [check["kind"] for check in manifest["equations"][0]["checks"]] == [
        "proof", "step", "step", "proof"
    ]  # fmt: skip
    assert call("derive", "--out", out, 2, "--overwrite")[0] == 0
    again = {path.name: path.read_bytes() for path in out.iterdir()}
    del first["manifest.json"], again["manifest.json"]  # which has the command
    assert again == first
    assert call("derive", "--out", out, 1, "--overwrite")[0] == 0
    assert {path.name for path in out.iterdir()} == {"eq01.tex", "equations.tex", "manifest.json"}


@pytest.fixture
def drawn(monkeypatch: pytest.MonkeyPatch) -> None:
    """Figures that take no time."""

    def figure(name: str, **_: Any) -> PaperFigure:
        file = f"{FIGURES[name].file}.pdf"
        return PaperFigure(name, {file: b"%PDF", "x.csv": ""}, {}, ["all inside"])

    monkeypatch.setattr("force_diffusion.numeric.figures.catalogue.figure", figure)


@pytest.mark.long
def test_the_article_says_what_was_derived(made_up, drawn, tmp_path, monkeypatch, printed):
    out, paper = tmp_path / "out", tmp_path / "paper"
    monkeypatch.setattr("force_diffusion.derivations.export.supplement.modules", lambda: ["B2"])
    command = ["derive", 2, "--out", out, "--article", paper]
    assert f"2 proved. Written to {out} and {paper}." in printed(*command)
    first = {path.name: path.read_bytes() for path in paper.iterdir()}
    assert {"article.tex", "supplement.tex", "figureB2.pdf"} < set(first)
    assert "x.csv" not in first
    supplement = " ".join(first["supplement.tex"].decode().split())
    assert "The verdicts of the run that wrote this text: 2 proved." in supplement
    assert "equations.tex" in {path.name for path in out.iterdir()}
    printed(*command, "--overwrite")
    assert {path.name: path.read_bytes() for path in paper.iterdir()} == first


def test_an_article_that_can_not_be_written_costs_no_proof(made_up, drawn, tmp_path, refused):
    """That a folder is there already is refused by every command: ``test_output``."""
    out = tmp_path / "out"
    assert "is also the folder of --out" in refused("derive", 2, "--article", out, "--out", out)


@pytest.mark.usefixtures("made_up", "without_matplotlib")
def test_an_article_without_what_draws_costs_no_proof(tmp_path, refused):
    says = refused("derive", 2, "--article", tmp_path / "new", status=3)
    assert "force-diffusion[plots]" in says
    assert not (tmp_path / "new").exists()


@pytest.mark.parametrize(
    ("number", "says"), [(errno.ENOSPC, "Free some space"), (errno.EROFS, "Choose a place")]
)
def test_a_disk_that_fails(made_up, tmp_path, monkeypatch, call, number, says):
    out = tmp_path / "out"

    def failing(self: Output, files: object) -> None:
        raise OSError(number, os.strerror(number), str(out / "eq01.tex"))

    monkeypatch.setattr(Output, "write", failing)
    status, _, stderr = call("derive", 1, "--out", out)
    assert status == 3
    for words in ("eq01.tex", os.strerror(number), says):
        assert words in stderr
    assert not out.exists()


def test_a_terminal_that_knows_only_ascii():
    environment = {**os.environ, "PYTHONIOENCODING": "ascii", "PYTHONUTF8": "0"}
    command = [sys.executable, "-m", "force_diffusion", "show", "4"]
    shown = subprocess.run(command, env=environment, capture_output=True, text=True, check=True)
    assert shown.stdout.isascii()
