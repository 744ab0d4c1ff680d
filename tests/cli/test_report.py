"""``report`` from the outside: the folder, the exit status, what is said."""

import json
import os
import sys
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import pytest
from force_diffusion.derivations.export.page import sections
from force_diffusion.numeric.arithmetic import processes
from force_diffusion.symbolic.kernel.decisions import Verdict

from force_diffusion.__main__ import main
from tests.derivations import fakes
from tests.derivations.export.test_page import PART


@pytest.fixture
def made_up(monkeypatch: pytest.MonkeyPatch) -> dict[int, Any]:
    """Equations 1 and 2 are made-up ones, and one part stands for all that is sections."""
    table: dict[int, Any] = {1: fakes.PREMISE, 2: fakes.CONCLUSION}
    monkeypatch.setattr("force_diffusion.derivations.api.derived.load", table.__getitem__)
    monkeypatch.setattr("force_diffusion.derivations.commands.report.modules", lambda: table)
    monkeypatch.setattr(sections, "figures_part", lambda notice: PART)
    for name in ("cost", "stability"):
        stand_in = partial(replace, PART, id=name)
        monkeypatch.setattr(sections, f"{name}_part", stand_in)
    monkeypatch.setattr(processes, "cores", lambda: 1)  # what stands for them is not beside
    return table


@pytest.mark.long
def test_one_page_and_the_manifest(made_up, tmp_path: Path, capsys) -> None:
    out = tmp_path / "out"
    for _ in range(2):  # again into its own folder
        assert main(["report", "--out", str(out)]) == 0
        printed = capsys.readouterr()
        assert printed.err == ""
        assert f"2 proved. Written to {out / 'report.html'}, 0." in printed.out
        assert sorted(path.name for path in out.iterdir()) == ["manifest.json", "report.html"]
    assert set(json.loads((out / "manifest.json").read_text())["files"]) == {"report.html"}
    assert f"force-diffusion report --out {out}" in (out / "report.html").read_text("utf-8")


def test_the_folder_has_a_name_of_its_own(made_up, tmp_path: Path, monkeypatch) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["report"]) == 0
    assert (tmp_path / "report" / "report.html").is_file()


@pytest.mark.long(sample=1)
@pytest.mark.parametrize("verdict", [Verdict.REFUTED, Verdict.UNDECIDED])
def test_what_is_not_proved_ends_with_status_1_and_is_written(
    made_up, verdict, tmp_path: Path, capsys
) -> None:
    made_up[2] = fakes.with_claim(verdict)
    assert main(["report", "--out", str(tmp_path / "out")]) == 1
    assert f"1 proved, 1 {verdict}." in capsys.readouterr().out
    page = (tmp_path / "out" / "report.html").read_text("utf-8")
    assert f'<span class="verdict {verdict}">' in page


@pytest.mark.long
def test_it_stands_beside_other_results(made_up, tmp_path: Path) -> None:
    out = tmp_path / "out"
    assert main(["derive", "1", "--out", str(out)]) == 0
    (out / "thesis.tex").write_text("mine")
    before = {path.name: path.read_text() for path in out.iterdir()}
    assert main(["report", "--out", str(out)]) == 0
    after = {path.name: path.read_text() for path in out.iterdir()}
    assert set(after) - set(before) == {"report.html"}
    del after["report.html"], after["manifest.json"], before["manifest.json"]
    assert after == before


@pytest.mark.parametrize("arguments", [["--out"], ["--out", ""], ["13"], ["--json"]])
def test_wrong_usage(made_up, arguments: list[str], tmp_path: Path, monkeypatch, capsys) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["report", *arguments]) == 2
    assert "Traceback" not in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("missing", ["jinja2", "matplotlib", "math_core"])
def test_what_it_needs_is_named(made_up, missing: str, tmp_path: Path, monkeypatch, capsys) -> None:
    for name in [name for name in sys.modules if name.split(".")[0] == missing]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.setitem(sys.modules, missing, None)
    out = tmp_path / "out"
    assert main(["report", "--out", str(out)]) == 3
    message = capsys.readouterr().err
    assert missing in message
    assert "pip install 'force-diffusion[report]'" in message
    assert not out.exists()


@pytest.mark.long(sample=1)
@pytest.mark.parametrize(
    ("failure", "status"), [(KeyboardInterrupt(), 130), (OSError(28, os.strerror(28), "x"), 3)]
)
def test_what_ends_it_early_leaves_nothing(
    made_up, failure: BaseException, status: int, tmp_path: Path, monkeypatch, capsys
) -> None:
    def fail(_: object) -> None:
        raise failure

    monkeypatch.setattr(sections, "figures_part", fail)
    out = tmp_path / "out"
    assert main(["report", "--out", str(out)]) == status
    assert "Traceback" not in capsys.readouterr().err
    assert not out.exists()
