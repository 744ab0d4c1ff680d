"""``derive`` from the outside: what it prints, what it writes, how it fails."""

import errno
import json
import os
import re
import subprocess
import sys
from importlib.metadata import version
from pathlib import Path
from typing import Any

import pytest
from force_diffusion.derivations.commands.output import Output
from force_diffusion.derivations.framework import loading
from force_diffusion.numeric.figures.catalogue import PaperFigure
from force_diffusion.numeric.figures.names import FIGURES

from force_diffusion.__main__ import main
from tests.derivations import fakes

ROOT = Path(__file__).parents[2]


@pytest.fixture
def made_up(monkeypatch: pytest.MonkeyPatch) -> dict[int, object]:
    """Equations 1 and 2 are made-up ones; their verdicts can be chosen."""
    table: dict[int, object] = {1: fakes.PREMISE, 2: fakes.CONCLUSION}
    true = loading.load
    monkeypatch.setattr(loading, "load", lambda number: table.get(number) or true(number))
    return table


def test_premises_are_proved_first(made_up, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["derive", "2", "1"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert [line.split()[:2] for line in lines[:2]] == [["1", "proved"], ["2", "proved"]]
    assert all(re.search(r" \(\d+\.\d\d s\)$", line) for line in lines[:2])
    assert lines[2:] == ["2 proved."]


def test_of_a_single_equation_all_steps_and_claims_are_printed(made_up, capsys) -> None:
    made_up[2] = fakes.with_claim(fakes.guessed)
    assert main(["derive", "2"]) == 0
    premise, blank, *lines = capsys.readouterr().out.splitlines()
    assert premise.startswith("  1  proved     A premise")
    assert blank == ""
    assert lines[0] == "Eq. 2: B"
    steps, claims = lines.index("Steps"), lines.index("Claims")
    assert lines[steps + 1] == "  1. Again:"
    assert "     proved, from Eq. 1" in lines[steps:claims]
    words = f"proved, assuming {fakes.GUESS}"
    assert any(line.startswith(f"  - {words}: doubtful (proof)") for line in lines[claims:])
    assert lines[-2].startswith(f"Eq. 2 is {words} (")
    assert lines[-1] == f"1 proved; 1 proved assuming {fakes.GUESS}."


def test_status_1_says_what_is_wrong(made_up, capsys: pytest.CaptureFixture[str]) -> None:
    made_up[2] = fakes.with_claim(fakes.baffled)
    assert main(["derive", "1", "2"]) == 1
    printed = capsys.readouterr().out
    assert "the claim 'doubtful': nobody knows" in " ".join(printed.split())
    assert "1 proved; 1 undecided." in printed


def test_json_follows_its_schema(made_up, capsys: pytest.CaptureFixture[str]) -> None:
    made_up[2] = fakes.with_claim(fakes.baffled)
    assert main(["derive", "2", "1", "1", "--json"]) == 1
    printed = capsys.readouterr()
    assert printed.err == ""
    content = json.loads(printed.out)
    assert list(content) == ["equations"]
    assert [entry["number"] for entry in content["equations"]] == [2, 1]  # it has no premises
    for entry in content["equations"]:
        assert " ".join(entry).startswith("number name title premises text latex exact verdict")
        assert entry["verdict"] in ("proved", "undecided")
        assert (entry["assuming"], entry["refuted as expected"]) == ([], 0)
        assert entry["seconds"] >= 0
        for check in entry["checks"]:
            assert list(check) == ["kind", "name", "verdict", "note", "assuming"]
            assert check["kind"] in ("step", "proof")
            assert check["verdict"] in ("proved", "undecided")


def test_the_output_folder_twice(made_up, tmp_path: Path, capsys) -> None:
    out = tmp_path / "out"
    assert main(["derive", "--out", str(out), "2"]) == 0
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
    assert main(["derive", "--out", str(out), "2", "--overwrite"]) == 0
    again = {path.name: path.read_bytes() for path in out.iterdir()}
    del first["manifest.json"], again["manifest.json"]  # which has the command
    assert again == first
    assert main(["derive", "--out", str(out), "1", "--overwrite"]) == 0
    assert {path.name for path in out.iterdir()} == {"eq01.tex", "equations.tex", "manifest.json"}


@pytest.fixture
def drawn(monkeypatch: pytest.MonkeyPatch) -> None:
    """Figures that take no time."""

    def figure(name: str, **_: Any) -> PaperFigure:
        file = f"{FIGURES[name].file}.pdf"
        return PaperFigure(name, {file: b"%PDF", "x.csv": ""}, {}, ["all inside"])

    monkeypatch.setattr("force_diffusion.numeric.figures.catalogue.figure", figure)


@pytest.mark.long
def test_the_article_says_what_was_derived(
    made_up, drawn, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys
) -> None:
    out, paper = tmp_path / "out", tmp_path / "paper"
    monkeypatch.setattr("force_diffusion.derivations.export.supplement.modules", lambda: ["B2"])
    command = ["derive", "2", "--out", str(out), "--article", str(paper)]
    assert main(command) == 0
    assert f"2 proved. Written to {out} and {paper}." in capsys.readouterr().out
    first = {path.name: path.read_bytes() for path in paper.iterdir()}
    assert {"article.tex", "supplement.tex", "figureB2.pdf"} < set(first)
    assert "x.csv" not in first
    supplement = " ".join(first["supplement.tex"].decode().split())
    assert "derived 2 equations: 2 proved. Not derived in it:" in supplement
    assert "equations.tex" in {path.name for path in out.iterdir()}
    assert main([*command, "--overwrite"]) == 0
    assert {path.name: path.read_bytes() for path in paper.iterdir()} == first


def test_an_article_that_can_not_be_written_costs_no_proof(
    made_up, drawn, tmp_path, capsys
) -> None:
    out = str(tmp_path / "out")
    for words, says in ((["--out", out], "is also the folder of --out"), ([], "exists already")):
        assert main(["derive", "2", "--article", out, *words]) == 2
        printed = capsys.readouterr()
        assert printed.out == ""
        assert says in printed.err
        Path(out).mkdir(exist_ok=True)


def test_an_article_without_what_draws_costs_no_proof(
    made_up, without_matplotlib, tmp_path, capsys
) -> None:
    assert main(["derive", "2", "--article", str(tmp_path / "new")]) == 3
    printed = capsys.readouterr()
    assert printed.out == ""
    assert "force-diffusion[plots]" in printed.err
    assert not (tmp_path / "new").exists()


@pytest.mark.parametrize(
    ("number", "says"),
    [
        (errno.ENOSPC, "Free some space"),
        (errno.EROFS, "Choose a place"),
    ],
)
def test_a_disk_that_fails(made_up, tmp_path: Path, monkeypatch, capsys, number, says) -> None:
    out = tmp_path / "out"

    def failing(self: Output, files: object) -> None:
        raise OSError(number, os.strerror(number), str(out / "eq01.tex"))

    monkeypatch.setattr(Output, "write", failing)
    assert main(["derive", "1", "--out", str(out)]) == 3
    message = capsys.readouterr().err
    assert "eq01.tex" in message
    assert os.strerror(number) in message
    assert says in message
    assert not out.exists()


@pytest.mark.skipif(not Path("/proc/self").exists(), reason="there is no /proc here")
def test_a_file_system_that_takes_no_files(made_up, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["derive", "1", "--out", "/proc/out"]) == 3
    assert "/proc/out" in capsys.readouterr().err


def test_a_terminal_that_knows_only_ascii() -> None:
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "PYTHONIOENCODING": "ascii"}
    environment["PYTHONUTF8"] = "0"
    command = [sys.executable, "-m", "force_diffusion", "show", "4"]
    shown = subprocess.run(command, env=environment, capture_output=True, text=True, check=True)
    assert shown.stdout.isascii()
