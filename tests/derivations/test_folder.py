"""The output folder: whole files only, our own files only."""

import errno
import json
import os
import subprocess
import sys
import textwrap
from pathlib import Path

import pytest
from force_diffusion.derivations.commands.folder import NotOurFolderError, output_folder

OURS = {"eq01.tex": "one", "eq02.tex": "two", "equations.tex": "document"}


def files(*names: str) -> dict[str, str]:
    listed = [*names, "manifest.json"]
    manifest = json.dumps({"program": "force-diffusion", "files": listed})
    return {**{name: OURS[name] for name in names}, "manifest.json": manifest}


def write(folder: Path, content: dict[str, str]) -> None:
    with output_folder(folder) as out:
        out.publish(content)


def names(folder: Path) -> set[str]:
    return {path.name for path in folder.iterdir()}


def test_a_new_folder_holds_exactly_the_files(tmp_path: Path) -> None:
    write(tmp_path / "deep" / "out", files(*OURS))
    assert names(tmp_path / "deep" / "out") == {*OURS, "manifest.json"}


def test_running_again_replaces_and_drops_its_own(tmp_path: Path) -> None:
    write(tmp_path, files(*OURS))
    (tmp_path / "eq01.tex").write_text("edited")
    write(tmp_path, files("eq01.tex", "equations.tex"))
    assert names(tmp_path) == {"eq01.tex", "equations.tex", "manifest.json"}
    assert (tmp_path / "eq01.tex").read_text() == "one"


def test_what_latex_leaves_is_no_obstacle(tmp_path: Path) -> None:
    write(tmp_path, files(*OURS))
    for suffix in ("aux", "log", "pdf"):
        (tmp_path / f"equations.{suffix}").write_text("by pdflatex")
    write(tmp_path, files(*OURS))
    assert (tmp_path / "equations.pdf").read_text() == "by pdflatex"


@pytest.mark.parametrize("before", [True, False])
def test_others_files_are_refused_and_untouched(tmp_path: Path, before: bool) -> None:
    if before:
        write(tmp_path, files(*OURS))
    (tmp_path / "thesis.tex").write_text("mine")
    there = names(tmp_path)
    with pytest.raises(NotOurFolderError, match=r"thesis\.tex"):
        write(tmp_path, files("eq01.tex"))
    assert names(tmp_path) == there
    assert (tmp_path / "thesis.tex").read_text() == "mine"


@pytest.mark.parametrize(
    "manifest",
    [
        "not JSON",
        "[]",
        '{"program": "another", "files": ["eq01.tex"]}',
        '{"program": "force-diffusion", "files": "eq01.tex"}',
        '{"program": "force-diffusion", "files": ["../outside", 3, null]}',
        '{"program": "force-diffusion"}',
        "[" * 5000,
        "\udcff",
    ],
)
def test_a_foreign_manifest_gives_no_right_to_a_file(tmp_path: Path, manifest: str) -> None:
    folder = tmp_path / "out"
    folder.mkdir()
    (tmp_path / "outside").write_text("mine")
    (folder / "eq01.tex").write_text("mine")
    (folder / "manifest.json").write_bytes(manifest.encode("utf-8", "surrogateescape"))
    with pytest.raises(NotOurFolderError):
        write(folder, files("eq01.tex"))
    assert (folder / "eq01.tex").read_text() == "mine"
    assert (tmp_path / "outside").read_text() == "mine"


@pytest.mark.parametrize("failure", [OSError(errno.ENOSPC, "No space left"), KeyboardInterrupt()])
@pytest.mark.parametrize("earlier", [True, False])
def test_a_failed_write_leaves_what_was_there(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, failure: BaseException, earlier: bool
) -> None:
    folder = tmp_path / "out"
    if earlier:
        write(folder, files("eq01.tex"))
    real = Path.write_text
    written = []

    def failing(path: Path, *args: object, **kwargs: object) -> int:
        written.append(path)
        if len(written) == 2:
            raise failure
        return real(path, *args, **kwargs)  # type: ignore[arg-type]

    monkeypatch.setattr(Path, "write_text", failing)
    with pytest.raises(type(failure)):
        write(folder, files(*OURS))
    assert folder.exists() == earlier
    if earlier:
        assert names(folder) == {"eq01.tex", "manifest.json"}
        assert (folder / "eq01.tex").read_text() == "one"


def ended_process() -> int:
    with subprocess.Popen([sys.executable, "-c", ""]) as process:
        process.wait(timeout=20)
    return process.pid


@pytest.mark.parametrize("left_by", ["abc", "ended", "ours", "9" * 30])
def test_what_a_killed_run_left_aside_is_cleared(tmp_path: Path, left_by: str) -> None:
    number = {"ended": ended_process(), "ours": os.getpid()}.get(left_by, left_by)
    aside = tmp_path / f".force-diffusion-{number}"
    aside.mkdir()
    (aside / "eq01.tex").write_text("half")
    write(tmp_path, files("eq01.tex"))
    assert names(tmp_path) == {"eq01.tex", "manifest.json"}


def test_two_runs_at_once_leave_each_other_alone(tmp_path: Path) -> None:
    """This process writes into the folder while another one holds it open."""
    program = textwrap.dedent(
        """
        import sys
        from pathlib import Path
        from tests.derivations.test_folder import OURS, files, output_folder

        with output_folder(Path(sys.argv[1])) as out:
            print("open", flush=True)
            sys.stdin.readline()
            out.publish(files(*OURS))
        """
    )
    with subprocess.Popen(
        [sys.executable, "-c", program, str(tmp_path)],
        cwd=Path(__file__).parents[2],
        text=True,
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
    ) as other:
        assert other.stdout is not None
        assert other.stdout.readline() == "open\n"
        write(tmp_path, files("eq01.tex"))
        assert {"eq01.tex", "manifest.json"} < names(tmp_path)
        other.communicate("\n", timeout=20)
    assert other.returncode == 0
    assert names(tmp_path) == {*OURS, "manifest.json"}
