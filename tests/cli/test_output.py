"""The output folder: whole files only, and only our own are replaced."""

import errno
import hashlib
import json
import os
import random
import re
import signal
import subprocess
import sys
import textwrap
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from force_diffusion.derivations.commands import output as module
from force_diffusion.derivations.commands.cli import _GIVEN
from force_diffusion.derivations.commands.output import OutputError, output
from force_diffusion.derivations.export.manifest import LARGEST, Manifest, read_manifest

import force_diffusion as fd
from force_diffusion.__main__ import main

ROOT = Path(__file__).parents[2]
ENVIRONMENT = {**os.environ, "PYTHONPATH": str(ROOT)}
SCENE = """
packing = {height = 3, width = 5}
disorder = {kind = "uniform", relative_std = 1e-4}
ask = {quantity = "contact_forces"}
"""


@pytest.fixture(autouse=True)
def _typed() -> None:
    _GIVEN.set(["test"])


def write(
    folder: Path, files: dict[str, str], question: str = "derive", overwrite: bool = False
) -> None:
    with output(folder, question, list(files), overwrite) as out:
        assert out is not None
        out.write(files)


def contents(folder: Path) -> dict[str, str]:
    return {path.name: path.read_text() for path in folder.iterdir()}


def listed(folder: Path) -> dict[str, str]:
    manifest = read_manifest(folder)
    assert manifest is not None
    return {name: made.result_of for name, made in manifest.files.items()}


def test_a_new_folder_holds_the_files_and_what_made_them(tmp_path: Path) -> None:
    out = tmp_path / "deep" / "out"
    write(out, {"a.tex": "one", "b.csv": "two"})
    assert set(contents(out)) == {"a.tex", "b.csv", "manifest.json"}
    data = json.loads((out / "manifest.json").read_text())
    assert data["program"] == "force-diffusion"
    assert set(data["files"]) == {"a.tex", "b.csv"}
    assert data["files"]["a.tex"]["command"] == "force-diffusion test"
    assert (out / "a.tex").stat().st_mode == (out / "manifest.json").stat().st_mode
    plain = tmp_path / "plain"
    plain.touch()
    assert (out / "a.tex").stat().st_mode == plain.stat().st_mode  # as the user's umask has it


def test_without_a_folder_there_is_none() -> None:
    with output(None, "derive", []) as out:
        assert out is None


def test_again_it_replaces_its_own_and_keeps_the_rest(tmp_path: Path) -> None:
    write(tmp_path, {"a": "one", "b": "two"})
    (tmp_path / "thesis.tex").write_text("mine")
    write(tmp_path, {"a": "new"})
    write(tmp_path, {"c": "three"}, "figures")
    found = contents(tmp_path)
    del found["manifest.json"]
    assert found == {"a": "new", "b": "two", "c": "three", "thesis.tex": "mine"}
    assert listed(tmp_path) == {"a": "derive", "b": "derive", "c": "figures"}


def test_what_was_taken_away_is_forgotten(tmp_path: Path) -> None:
    write(tmp_path, {"a": "one", "b": "two"})
    (tmp_path / "b").unlink()
    write(tmp_path, {"a": "new"})
    (tmp_path / "b").write_text("mine")
    with pytest.raises(OutputError, match=r"'.*b' is there, and no manifest"):
        write(tmp_path, {"b": "three"})


def link(path: Path) -> None:
    path.symlink_to(path.parent / "elsewhere")


IN_THE_WAY: dict[str, tuple[Callable[[Path], object], str]] = {
    "not listed": (lambda path: path.write_text("mine"), "no manifest.json says"),
    "a link": (link, "no manifest.json says"),
    "a pipe": (os.mkfifo, "no manifest.json says"),
    "a folder": (Path.mkdir, "is a folder"),
}


@pytest.mark.parametrize("kind", IN_THE_WAY)
@pytest.mark.parametrize("before", [True, False])
def test_others_files_are_named_and_left_alone(kind: str, before: bool, tmp_path: Path) -> None:
    put, says = IN_THE_WAY[kind]
    if before:
        write(tmp_path, {"a": "one"})
    put(tmp_path / "b")
    there = sorted(tmp_path.iterdir())
    with pytest.raises(OutputError, match=f"'{tmp_path}/b' .*{says}"):
        write(tmp_path, {"a": "two", "b": "two"})
    assert sorted(tmp_path.iterdir()) == there
    if before:
        assert (tmp_path / "a").read_text() == "one"


@pytest.mark.parametrize("kind", IN_THE_WAY)
def test_they_are_replaced_if_that_is_asked_for(kind: str, tmp_path: Path) -> None:
    (tmp_path / "elsewhere").write_text("mine")
    IN_THE_WAY[kind][0](tmp_path / "b")
    if kind == "a folder":
        with pytest.raises(OutputError, match=r"is a folder\. Give another folder\.$"):
            write(tmp_path, {"b": "two"}, overwrite=True)
        return
    write(tmp_path, {"b": "two"}, overwrite=True)
    assert (tmp_path / "b").read_text() == "two"
    assert not (tmp_path / "b").is_symlink()
    assert (tmp_path / "elsewhere").read_text() == "mine"
    write(tmp_path, {"b": "three"})  # from now on it is ours


def test_what_was_changed_is_not_replaced(tmp_path: Path) -> None:
    write(tmp_path, {"a": "one"})
    (tmp_path / "a").write_text("one, and my own words")
    with pytest.raises(OutputError, match=r"'.*a' was changed after .* --overwrite"):
        write(tmp_path, {"a": "two"})
    write(tmp_path, {"a": "two"}, overwrite=True)


def test_the_answer_to_another_question_is_not_replaced(tmp_path: Path) -> None:
    write(tmp_path, {"result.json": "a"}, "run a.toml")
    with pytest.raises(OutputError, match=r"'.*result\.json' is the result of 'run a\.toml'"):
        write(tmp_path, {"result.json": "b"}, "run b.toml")
    write(tmp_path, {"result.json": "b"}, "run b.toml", overwrite=True)
    assert listed(tmp_path) == {"result.json": "run b.toml"}


def test_a_file_that_appears_meanwhile_is_not_replaced(tmp_path: Path) -> None:
    with output(tmp_path, "derive", ["a"]) as out:
        assert out is not None
        (tmp_path / "a").write_text("mine")
        with pytest.raises(OutputError, match=r"'.*a' is there"):
            out.write({"a": "two"})
    assert contents(tmp_path) == {"a": "mine"}


def test_two_at_once_keep_each_others_files(tmp_path: Path) -> None:
    with output(tmp_path, "derive", ["a"]) as out:
        assert out is not None
        write(tmp_path, {"b": "other"}, "figures")
        out.write({"a": "one"})
    assert listed(tmp_path) == {"a": "derive", "b": "figures"}


def at_once(root: str, kind: str) -> list[list[str]]:
    """Start two processes, have them begin together; give what they print."""
    program = "from tests.cli.test_output import rounds; rounds()"
    programs = [
        subprocess.Popen(
            [sys.executable, "-c", program, root, kind, k],
            env=ENVIRONMENT, cwd=ROOT, text=True, stdin=subprocess.PIPE, stdout=subprocess.PIPE,
        )
        for k in "ab"
    ]  # fmt: skip
    for one in programs:
        assert one.stdout is not None
        assert one.stdout.readline() == "ready\n"
    start = time.time() + 0.1
    for one in programs:
        assert one.stdin is not None
        print(start, file=one.stdin, flush=True)
    found = [one.communicate(timeout=60)[0].splitlines() for one in programs]
    assert [one.returncode for one in programs] == [0, 0]
    return found


ROUNDS, APART, SLOW = 40, 0.15, 0.02


def rounds() -> None:
    """Write into one folder after the other, each at a fixed moment; print how it went.

    The disk is slow: what a manifest said is old by the time that it is written anew.
    """
    root, kind, own = sys.argv[1:]
    _GIVEN.set([])

    def slow(folder: Path) -> Manifest | None:
        found = read_manifest(folder)
        time.sleep(SLOW)
        return found

    module.read_manifest = slow  # type: ignore[assignment]
    print("ready", flush=True)
    start = float(sys.stdin.readline())
    for turn in range(ROUNDS):
        folder = Path(root) / str(turn)
        time.sleep(max(0, start + turn * APART - time.time()))
        try:
            if kind == "one fails" and own == "b":
                with output(folder, "run b.toml", ["b"]):
                    print("failed")
            else:
                name = "result.json" if kind == "one name" else own
                write(folder, {name: own * 5000}, f"run {own}.toml")
                print("written")
        except OutputError as error:
            known = ("is the result of 'run", "is about to be written by another command")
            print("refused" if any(word in str(error) for word in known) else error)


@pytest.mark.long
@pytest.mark.parametrize("kind", ["two names", "one name", "one fails"])
def test_commands_at_the_same_moment_lose_no_answer(kind: str, tmp_path: Path) -> None:
    """What is written is listed; one that could not write its file was told before it solved."""
    found = at_once(str(tmp_path), kind)
    expected = {
        "two names": {("written", "written")},
        "one name": {("written", "refused"), ("refused", "written")},
        "one fails": {("written", "failed")},
    }[kind]
    turns = list(zip(*found, strict=True))
    assert len(turns) == ROUNDS
    assert set(turns) <= expected
    for turn, said in enumerate(turns):
        folder = tmp_path / str(turn)
        own = [k for k, word in zip("ab", said, strict=True) if word == "written"]
        names = {"result.json" if kind == "one name" else k: k for k in own}
        assert listed(folder) == {name: f"run {k}.toml" for name, k in names.items()}
        there = contents(folder)
        del there["manifest.json"]
        assert there == {name: k * 5000 for name, k in names.items()}
        for name, k in names.items():
            write(folder, {name: "new"}, f"run {k}.toml")  # its hash is that of the file


def test_a_name_is_kept_from_others_until_its_command_ends(tmp_path: Path) -> None:
    with output(tmp_path, "run a.toml", ["result.json", "a"]):
        for question, overwrite in (("run b.toml", False), ("run a.toml", True)):
            with pytest.raises(OutputError, match=r"'.*/a' is about to be written by another"):
                write(tmp_path, {"a": "other"}, question, overwrite)
        write(tmp_path, {"b": "other"}, "run b.toml")
    assert set(contents(tmp_path)) == {"b", "manifest.json"}
    write(tmp_path, {"a": "one"}, "run a.toml")
    assert set(contents(tmp_path)) == {"a", "b", "manifest.json"}


def test_a_lock_dies_with_its_process(tmp_path: Path) -> None:
    program = textwrap.dedent(
        """
        import sys
        from pathlib import Path
        from tests.cli.test_output import output

        with output(Path(sys.argv[1]), "run a.toml", ["a"]):
            print("solving", flush=True)
            sys.stdin.read()
        """
    )
    with subprocess.Popen(
        [sys.executable, "-c", program, str(tmp_path)],
        env=ENVIRONMENT, cwd=ROOT, text=True, stdin=subprocess.PIPE, stdout=subprocess.PIPE,
    ) as process:  # fmt: skip
        assert process.stdout is not None
        assert process.stdout.readline() == "solving\n"
        with pytest.raises(OutputError, match="is about to be written"):
            write(tmp_path, {"a": "two"}, "run b.toml")
        process.send_signal(signal.SIGKILL)
    write(tmp_path, {"a": "two"}, "run b.toml")
    assert set(contents(tmp_path)) == {"a", "manifest.json"}


@pytest.mark.long
def test_two_runs_at_once_into_one_folder(tmp_path: Path) -> None:
    """One answers; the other is refused, in words, and may be given another folder."""
    for name in "ab":
        (tmp_path / f"{name}.toml").write_text(SCENE)
    for turn in range(4):
        runs = [
            subprocess.Popen(
                [sys.executable, "-m", "force_diffusion", "run", f"{k}.toml", "--out", f"{turn}"],
                env=ENVIRONMENT, cwd=tmp_path, text=True, stderr=subprocess.PIPE,
                stdout=subprocess.DEVNULL,
            )
            for k in "ab"
        ]  # fmt: skip
        told = [one.communicate(timeout=60)[1] for one in runs]
        assert sorted(one.returncode for one in runs) == [0, 2]
        winner = runs[1].returncode == 0
        assert told[winner] == ""
        words = f"'{turn}/result.json' is (the result of|about to be written by another command)"
        assert re.search(words, told[not winner])
        assert set(listed(tmp_path / f"{turn}").values()) == {f"run {'ab'[winner]}.toml"}


GOOD = {"result_of": "derive", "command": "", "version": "", "sha256": ""}
NOT_OURS = {
    "not JSON": "not JSON",
    "empty": "",
    "a list": "[]",
    "null": "null",
    "another program": json.dumps({"program": "another", "files": {"a": GOOD}}),
    "files are a word": '{"program": "force-diffusion", "files": "a"}',
    "files are a list": '{"program": "force-diffusion", "files": ["a"]}',
    "an entry is empty": '{"program": "force-diffusion", "files": {"a": {}}}',
    "a number for a word": json.dumps(
        {"program": "force-diffusion", "files": {"a": {**GOOD, "sha256": 1}}}
    ),
    "no files": '{"program": "force-diffusion"}',
    "equations are words": '{"program": "force-diffusion", "files": {}, "equations": ["1"]}',
    "deep": "[" * 500_000,
    "deep inside": '{"program": "force-diffusion", "files": {}, "x": ' + "[" * 500_000,
    "bad UTF-8": "\udcff",
    "large": " " * LARGEST + json.dumps({"program": "force-diffusion", "files": {"a": GOOD}}),
}


@pytest.mark.parametrize("kind", NOT_OURS)
def test_a_manifest_that_is_not_ours_gives_no_right_to_a_file(kind: str, tmp_path: Path) -> None:
    (tmp_path / "a").write_text("mine")
    manifest = tmp_path / "manifest.json"
    manifest.write_bytes(NOT_OURS[kind].encode("utf-8", "surrogateescape"))
    for names in (["a"], ["b"]):  # beside it, nothing can be added to a foreign manifest
        with pytest.raises(OutputError):
            write(tmp_path, dict.fromkeys(names, "new"))
    assert (tmp_path / "a").read_text() == "mine"
    write(tmp_path, {"b": "new"}, overwrite=True)
    assert listed(tmp_path) == {"b": "derive"}


@pytest.mark.parametrize("kind", ["device", "pipe", "folder", "sparse gigabyte"])
def test_a_manifest_that_has_no_end_is_not_read(kind: str, tmp_path: Path) -> None:
    manifest = tmp_path / "manifest.json"
    if kind == "device":
        manifest.symlink_to("/dev/zero")
    elif kind == "pipe":
        os.mkfifo(manifest)
    elif kind == "folder":
        manifest.mkdir()
    else:
        with manifest.open("wb") as file:
            file.truncate(10**9)
    with pytest.raises(OutputError, match=r"manifest\.json"):
        write(tmp_path, {"a": "new"})
    assert [path.name for path in tmp_path.iterdir()] == ["manifest.json"]


def test_a_listed_name_leads_nowhere_else(tmp_path: Path) -> None:
    out = tmp_path / "out"
    out.mkdir()
    (tmp_path / "outside").write_text("mine")
    data = {"program": "force-diffusion", "files": {"../outside": GOOD, "/etc/passwd": GOOD}}
    (out / "manifest.json").write_text(json.dumps(data))
    write(out, {"a": "new"})
    assert (tmp_path / "outside").read_text() == "mine"


def test_words_of_any_kind_can_be_read_again(tmp_path: Path) -> None:
    _GIVEN.set(["run", "\udcff\x1b[31m\n.toml"])
    for text in ("one", "two"):
        write(tmp_path, {"a": text}, "run \udcff\x1b[31m\n.toml")
    assert "\x1b" not in (tmp_path / "manifest.json").read_text()


def test_too_many_results_for_one_folder_are_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    write(tmp_path, {"a": "one"})
    before = contents(tmp_path)
    monkeypatch.setattr(module, "LARGEST", 300)
    with pytest.raises(OutputError, match="too many results"):
        write(tmp_path, {"b": "two"})
    assert contents(tmp_path) == before


@pytest.mark.parametrize("failure", [OSError(errno.ENOSPC, "No space left"), KeyboardInterrupt()])
@pytest.mark.parametrize("earlier", [True, False])
def test_a_failed_write_leaves_what_was_there(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, failure: BaseException, earlier: bool
) -> None:
    out = tmp_path / "deep" / "out"
    if earlier:
        write(out, {"a": "one"})
    before = contents(out) if earlier else None
    real, opened = Path.open, []

    def failing(path: Path, mode: str = "r", **others: Any) -> Any:
        opened.append(mode)
        if opened.count("xb") == 2:
            raise failure
        return real(path, mode, **others)

    monkeypatch.setattr(Path, "open", failing)
    with pytest.raises(type(failure)) as raised:
        write(out, {"a": "two", "b": "two"})
    if isinstance(raised.value, OSError):
        assert raised.value.filename == str(out / "b")
    monkeypatch.undo()
    assert (contents(out) if out.exists() else None) == before
    assert out.parent.exists() == earlier


def killed_at_random(folder: Path, moments: random.Random) -> None:
    """Have a process write both files again and again, and kill it at some moment."""
    program = textwrap.dedent(
        """
        import sys
        from pathlib import Path
        from tests.cli.test_output import _GIVEN, write

        _GIVEN.set([])
        for turn in range(10**9):
            text = str(turn % 10) * 300_000
            write(Path(sys.argv[1]), {"a": text, "b": text}, overwrite=True)
            if turn == 0:
                print("writing", flush=True)
        """
    )
    with subprocess.Popen(
        [sys.executable, "-c", program, str(folder)],
        env=ENVIRONMENT, cwd=ROOT, text=True, stdout=subprocess.PIPE,
    ) as process:  # fmt: skip
        assert process.stdout is not None
        assert process.stdout.readline() == "writing\n"
        time.sleep(0.05 + moments.random() / 10)
        process.send_signal(signal.SIGKILL)


def test_killed_at_any_moment_no_half_written_file_is_seen(tmp_path: Path) -> None:
    moments = random.Random(3)
    for _ in range(4):
        killed_at_random(tmp_path, moments)
        for name in ("a", "b"):
            text = (tmp_path / name).read_text()
            assert (len(text), len(set(text))) == (300_000, 1)
        assert set(listed(tmp_path)) == {"a", "b"}
        shown = {path.name for path in tmp_path.iterdir() if not path.name.startswith(".")}
        assert shown == {"a", "b", "manifest.json"}


def run_and(folder: Path, death: str, *options: str) -> int:
    """Answer a scene in a process that ends at a rename, ``death`` being what it does there."""
    program = textwrap.dedent(
        f"""
        import os, signal, sys
        from force_diffusion.__main__ import main

        real, renames = os.replace, []

        def replace(old, new):
            if os.path.basename(os.path.dirname(new)) == "out":  # caches are renamed, too
                renames.append(new)
                {death}
            real(old, new)

        os.replace = replace
        sys.exit(main(sys.argv[1:]))
        """
    )
    command = ["run", "scene.toml", "--out", "out", *options]
    done = subprocess.run(
        [sys.executable, "-c", program, *command],
        env=ENVIRONMENT, cwd=folder, capture_output=True, timeout=60, check=False,
    )  # fmt: skip
    return done.returncode


def is_whole(folder: Path, seed: int) -> bool:
    """Whether all files are those of one seed, listed, and the only ones there."""
    said = json.loads((folder / "result.json").read_text())
    manifest = read_manifest(folder)
    assert manifest is not None
    digests = {
        name: hashlib.sha256((folder / name).read_bytes()).hexdigest() for name in manifest.files
    }
    assert {name: made.sha256 for name, made in manifest.files.items()} == digests
    assert {path.name for path in folder.iterdir()} == {*manifest.files, "manifest.json"}
    return said["source"]["seed"] == seed and {m.seed for m in manifest.files.values()} == {seed}


@pytest.mark.long(sample=1)
@pytest.mark.parametrize("earlier", [True, False])
@pytest.mark.parametrize("rename", [1, 2, 3])
def test_killed_between_two_renames_the_same_command_repairs(
    rename: int, earlier: bool, tmp_path: Path
) -> None:
    out = tmp_path / "out"
    if earlier:
        (tmp_path / "scene.toml").write_text(SCENE)
        assert run_and(tmp_path, "pass") == 0
        assert is_whole(out, 0)
    (tmp_path / "scene.toml").write_text(SCENE.replace("1e-4", "1e-4, seed = 7"))
    death = f"if len(renames) == {rename}: os.kill(os.getpid(), signal.SIGKILL)"
    assert run_and(tmp_path, death) == -signal.SIGKILL
    assert any(path.name.endswith(".fd-part") for path in out.iterdir())
    assert run_and(tmp_path, "pass") == 0
    assert is_whole(out, 7)


@pytest.mark.long
@pytest.mark.parametrize("number", ["SIGINT", "SIGTERM"])
def test_an_interrupt_waits_until_all_is_renamed(number: str, tmp_path: Path) -> None:
    (tmp_path / "scene.toml").write_text(SCENE)
    assert run_and(tmp_path, f"os.kill(os.getpid(), signal.{number})") == 130
    assert is_whole(tmp_path / "out", 0)


@pytest.mark.long
def test_a_rename_that_fails_can_be_repaired(tmp_path: Path) -> None:
    (tmp_path / "scene.toml").write_text(SCENE)
    assert run_and(tmp_path, "pass") == 0
    (tmp_path / "scene.toml").write_text(SCENE.replace("1e-4", "1e-4, seed = 7"))
    death = "if len(renames) == 2: raise OSError(5, 'Input/output error', new)"
    assert run_and(tmp_path, death) == 3
    assert run_and(tmp_path, "pass") == 0
    assert is_whole(tmp_path / "out", 7)


def killed_while_renaming(folder: Path, files: dict[str, str], question: str) -> None:
    """Rename the first file, then leave the rest aside, as a kill does."""
    real, done = os.replace, []

    def replace(old: Path, new: Path) -> None:
        if done:
            os._exit(9)
        done.append(new)
        real(old, new)

    child = os.fork()
    if not child:
        os.replace = replace  # type: ignore[assignment]
        write(folder, files, question)
        os._exit(0)
    assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 9


def test_another_command_keeps_what_is_needed_to_repair(tmp_path: Path) -> None:
    write(tmp_path, {"a": "one", "b": "one"}, "run a.toml")
    killed_while_renaming(tmp_path, {"a": "two", "b": "two"}, "run a.toml")
    write(tmp_path, {"c": "other"}, "figures")
    assert contents(tmp_path).keys() == {"a", "b", "c", "manifest.json"}
    with pytest.raises(OutputError, match=r"is the result of 'run a\.toml'"):
        write(tmp_path, {"a": "three"}, "run b.toml")
    write(tmp_path, {"a": "two", "b": "two"}, "run a.toml")
    assert listed(tmp_path) == {"a": "run a.toml", "b": "run a.toml", "c": "figures"}


def test_what_a_user_changed_after_a_kill_is_kept(tmp_path: Path) -> None:
    killed_while_renaming(tmp_path, {"a": "two", "b": "two"}, "run a.toml")
    (tmp_path / "a").write_text("mine")
    with pytest.raises(OutputError, match="was changed after this program wrote it"):
        write(tmp_path, {"a": "two", "b": "two"}, "run a.toml")


def test_only_what_is_left_by_this_program_is_cleared(tmp_path: Path) -> None:
    others = {
        "a.1234abcd.fd-part", ".a.fd-part", ".a.1234ABCD.fd-part", ".a.1234abcd.part", "b.fd-lock",
    }  # fmt: skip
    left = {".a.1234abcd.fd-part", ".other.00000000.fd-part", ".other.fd-lock"}
    for name in others | left:
        (tmp_path / name).write_text("")
    write(tmp_path, {"a": "one"})
    assert contents(tmp_path).keys() == {"a", "manifest.json"} | others


# What every command says of a folder that can't be used, before it solves anything.


@pytest.fixture
def scene(tmp_path: Path) -> Path:
    path = tmp_path / "scene.toml"
    path.write_text(SCENE)
    return path


@pytest.fixture
def _unsolved(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("framework.runner.run", "commands.scenes._solved", "commands.figures._made"):
        monkeypatch.setattr(f"force_diffusion.derivations.{name}", None)
    for name in ("derive", "figure", "ensemble", "cost"):
        monkeypatch.setattr(fd, name, None)


COMMANDS = {
    "derive 1": "eq01.tex",
    "run scene.toml": "result.json",
    "cost scene.toml": "cost.json",
    "ensemble scene.toml --realisations 9": "contact_forces.csv",
    "figures 1": "figure1.svg",
}


@pytest.mark.usefixtures("_unsolved", "scene")
@pytest.mark.parametrize("command", COMMANDS)
@pytest.mark.parametrize("kind", ["name", "file", "below a file", "dangling link", "loop"])
def test_every_command_refuses_before_it_solves(
    command: str, kind: str, tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str],
) -> None:  # fmt: skip
    monkeypatch.chdir(tmp_path)
    out, named = Path("out"), "'out'"
    says = "is a file"
    if kind == "name":
        out.mkdir()
        (out / COMMANDS[command]).write_text("mine")
        named, says = f"'out/{COMMANDS[command]}'", "--overwrite"
    elif kind.endswith("file"):
        out.write_text("mine")
        out = out / "below" if kind.startswith("below") else out
    else:
        out.symlink_to("nowhere" if kind == "dangling link" else "out")
        says = "is a link to"
    before = sorted(tmp_path.rglob("*"))
    assert main([*command.split(), "--out", str(out)]) == 2
    printed = capsys.readouterr()
    assert printed.out == ""
    assert f"force-diffusion: {named} " in printed.err
    assert says in printed.err
    assert sorted(tmp_path.rglob("*")) == before


def test_two_scenes_into_one_folder(
    tmp_path: Path, scene: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("b.toml").write_text(SCENE.replace("contact_forces", "positions"))
    assert main(["run", "scene.toml", "--out", "out"]) == 0
    before = contents(Path("out"))
    assert main(["run", "b.toml", "--out", "out"]) == 2
    assert "'out/result.json' is the result of 'run scene.toml'" in capsys.readouterr().err
    assert contents(Path("out")) == before
    assert main(["run", "b.toml", "--out", "out", "--overwrite"]) == 0
    assert set(contents(Path("out"))) == {*before, "positions.csv"}
    assert Path("out/contact_forces.csv").read_text() == before["contact_forces.csv"]
