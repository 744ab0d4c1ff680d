"""The folder of results: as a whole or not at all, and nothing that others put there is lost."""

import errno
import os
import shutil
import signal
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from force_diffusion.derivations.commands.output import Output, OutputError

import force_diffusion as fd

NAMES = ["a", "b"]
OLD, NEW = {"a": "old", "b": "old"}, {"a": "new"}


@pytest.fixture(autouse=True)
def _here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def write(out: str, files: dict[str, str], overwrite: bool = False) -> None:
    Output(Path(out), NAMES, overwrite).write(files)


def contents(folder: str | Path) -> dict[str, str]:
    return {path.name: path.read_text() for path in Path(folder).iterdir()}


def everything() -> list[str]:
    return sorted(str(path) for path in Path().rglob("*"))


@pytest.mark.parametrize("out", ["out", "deep/er/out", "a/../out"])
def test_a_new_folder_holds_the_files_and_no_others_lie_beside_it(out):
    Path("a").mkdir()
    write(out, OLD)
    assert contents(out) == OLD
    assert not [path for path in everything() if ".new" in path or ".old" in path]
    Path("usual").mkdir()
    assert Path(out).stat().st_mode == Path("usual").stat().st_mode  # as the user's umask has it


def test_earlier_results_are_replaced_on_request():
    write("out", OLD)
    with pytest.raises(OutputError, match=r"^'out' exists already\. .* --overwrite\.$"):
        write("out", NEW)
    assert contents("out") == OLD
    write("out", NEW, overwrite=True)
    assert contents("out") == NEW
    assert everything() == ["out", "out/a"]


@pytest.mark.parametrize(
    "put",
    [
        lambda out: (out / "mine").write_text("mine"),
        lambda out: (out / "b").mkdir(),
        lambda out: (out / "b").symlink_to("a"),
    ],
    ids=["another file", "a folder", "a link"],
)
def test_a_folder_with_other_files_is_never_replaced(put):
    write("out", NEW)
    before = Output(Path("out"), NAMES, True)
    put(Path("out"))
    with pytest.raises(OutputError, match="'out' contains files that this command doesn't write"):
        Output(Path("out"), NAMES, True)
    with pytest.raises(OutputError, match=r"such as .* The results are in '(.*)'") as raised:
        before.write(OLD)
    assert contents(str(raised.value).split("'")[-2]) == OLD  # the answer is not lost either
    assert (Path("out") / "a").read_text() == "new"
    assert len(list(Path("out").iterdir())) == 2


@pytest.mark.parametrize(
    ("put", "out", "says"),
    [
        (lambda: Path("out").write_text("mine"), "out", r"^'out' is a file or a link\."),
        (lambda: Path("out").symlink_to("nowhere"), "out", r"^'out' is a file or a link\."),
        (lambda: Path("out").write_text("mine"), "out/deep/er", r"^'out' is a file or a link\."),
        (lambda: Path("out.old").mkdir(), "out", "'out.old' exists: .* stopped while it"),
    ],
)
def test_an_obstacle_to_writing_is_named(put, out, says):
    put()
    before = everything()
    with pytest.raises(OutputError, match=says):
        Output(Path(out), NAMES, True)
    assert everything() == before


@pytest.mark.parametrize("failure", [OSError(errno.ENOSPC, "No space left"), KeyboardInterrupt()])
def test_a_failed_write_leaves_the_earlier_results(monkeypatch, failure):
    write("deep/out", OLD)
    before, real = everything(), Path.write_bytes

    def failing(path: Path, content: bytes) -> int:
        if path.name == "b":
            raise failure
        return real(path, content)

    monkeypatch.setattr(Path, "write_bytes", failing)
    for folder in ("deep/out", "new"):
        with pytest.raises(type(failure)) as raised:
            write(folder, {"a": "new", "b": "new"}, overwrite=True)
        if isinstance(raised.value, OSError):
            assert raised.value.filename == f"{folder}/b"
        assert everything() == before
    assert contents("deep/out") == OLD


def killed(calls: int) -> bool:
    """Replace a folder in a process that is killed at so many changes; say whether it was."""
    child = os.fork()
    if not child:
        remaining = iter(range(calls))

        def counted(real: Callable[..., Any]) -> Callable[..., Any]:
            def call(*arguments: Any, **more: Any) -> Any:
                if next(remaining, None) is None:
                    os.kill(os.getpid(), signal.SIGKILL)
                return real(*arguments, **more)

            return call

        os.rename = counted(os.rename)
        for name in ("mkdir", "write_bytes", "unlink", "rmdir"):
            setattr(Path, name, counted(getattr(Path, name)))
        try:
            write("out", {"a": "new", "b": "new"}, overwrite=True)
            os._exit(0)
        finally:
            os._exit(1)
    ended = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
    assert ended in {0, -signal.SIGKILL}
    return ended != 0


def test_a_killed_write_loses_nothing_and_the_next_one_says_where_it_is():
    seen = set()
    for calls in range(100):
        write("out", OLD)
        if not killed(calls):
            break
        there = {path.name: contents(path) for path in Path().iterdir()}
        whole = [name for name, files in there.items() if files == OLD]
        replaced = there.get("out") == {"a": "new", "b": "new"}
        if "out.old" in there:
            with pytest.raises(OutputError, match=r"^'out\.old' exists: .* the old content"):
                Output(Path("out"), NAMES, False)
        else:
            write("out", NEW, overwrite=True)
            assert contents("out") == NEW
        seen.add((*whole, replaced))
        for folder in Path().iterdir():
            shutil.rmtree(folder)
    assert seen == {("out", False), ("out.old", False), ("out.old", True), (True,)}
    assert contents("out") == {"a": "new", "b": "new"}
    assert everything() == ["out", "out/a", "out/b"]


def test_the_second_of_two_writers_puts_its_results_beside_the_folder():
    first, second = (Output(Path("out"), NAMES, False) for _ in range(2))
    first.write(OLD)
    with pytest.raises(OutputError, match=r"exists already\. .* The results are in '.*'") as raised:
        second.write(NEW)
    assert contents("out") == OLD
    assert contents(str(raised.value).split("'")[-2]) == NEW


@pytest.mark.parametrize(
    "command",
    [
        "derive 1",
        "derive 1 --article paper",
        "run scene.toml",
        "run scene.toml --set load.kind=bulk,surface",
        "cost scene.toml",
        "ensemble scene.toml --realisations 9",
        "figures 1",
        "certify 1",
    ],
)
@pytest.mark.usefixtures("scene")
def test_every_command_refuses_an_existing_folder_before_it_solves(command, monkeypatch, refused):
    for name in ("framework.runner.run", "commands.scenes._answer", "commands.figures._own"):
        monkeypatch.setattr(f"force_diffusion.derivations.{name}", None)
    for name in ("derive", "figure", "ensemble", "cost", "certify"):
        monkeypatch.setattr(fd, name, None)
    Path("mine/load.kind=bulk").mkdir(parents=True)
    Path("paper").mkdir()
    before = everything()
    out = ["--out", "mine"] if "article" not in command else []
    says = "' exists already. Give another folder, or --overwrite."
    assert says in refused(*command.split(), *out)
    assert everything() == before
