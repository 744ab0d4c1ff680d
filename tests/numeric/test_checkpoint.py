"""A damaged checkpoint gives no answer at all; a killed run leaves one that is gone on from."""

import os
import random
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from io import BytesIO
from pathlib import Path
from typing import Any
from zipfile import ZipFile

import numpy as np
import pytest
from force_diffusion.numeric.arithmetic.errors import NotReachedError
from force_diffusion.numeric.planning.plan import Plan
from force_diffusion.numeric.run import checkpoint as module
from force_diffusion.numeric.run.checkpoint import Checkpoint, CheckpointError
from force_diffusion.numeric.run.running import run

from tests.numeric.scenes import planned
from tests.numeric.test_segments import cut, same

pytest.importorskip("numba")


class KilledError(Exception):
    pass


def small(quantity: str = "profile", seed: int = 3, layers: int = 2, dimension: int = 2) -> Plan:
    sections: dict[str, dict[str, Any]] = {
        "packing": {"height": 9, "width": 12, "dimension": dimension},
        "disorder": {"kind": "uniform", "relative_std": "=1e-4", "seed": seed},
        "ask": {"quantity": quantity},
    }
    return cut(planned(sections), layers)


def made(plan: Plan, path: Path) -> bytes:
    """A whole run's checkpoint."""
    run(plan, checkpoint=path)
    return path.read_bytes()


def refused(plan: Plan, path: Path, content: bytes) -> None:
    """See that there is no answer, and that the file stays as it is."""
    path.write_bytes(content)
    with pytest.raises(CheckpointError, match=str(path)):
        run(plan, checkpoint=path)
    assert path.read_bytes() == content


def states(plan: Plan, path: Path, monkeypatch: pytest.MonkeyPatch) -> list[bytes]:
    """Every content that the file has in a run."""
    found: list[bytes] = []
    real = os.replace

    def replace(a: Any, b: Any) -> None:
        real(a, b)
        if Path(b) == path:
            found.append(path.read_bytes())

    with monkeypatch.context() as patch:
        patch.setattr(module, "OFTEN", 0)
        patch.setattr(os, "replace", replace)
        run(plan, checkpoint=path)
    return found


@pytest.mark.long(sample=1)
@pytest.mark.parametrize("quantity", ["profile", "histogram", "contact_forces"])
def test_no_byte_of_a_checkpoint_can_be_changed(quantity: str, tmp_path: Path) -> None:
    """Any bit, any byte: of headers, of names, of numbers, of the sum; 500 of all."""
    plan, path, dice = small(quantity), tmp_path / "kept", random.Random(5)
    content = made(plan, path)
    last = range(len(content) - 100, len(content))
    for place in [*range(60), *dice.sample(range(len(content)), 400), *last]:
        for changed in {content[place] ^ 1 << dice.randrange(8), dice.randrange(256)}:
            if changed != content[place]:
                refused(plan, path, content[:place] + bytes([changed]) + content[place + 1 :])


@pytest.mark.parametrize("quantity", ["profile", "histogram"])
def test_wherever_it_is_cut_off_it_is_refused(quantity: str, tmp_path: Path) -> None:
    plan, path, dice = small(quantity), tmp_path / "kept", random.Random(5)
    content = made(plan, path)
    for stop in [*range(65), *dice.sample(range(len(content)), 100), len(content) - 1]:
        refused(plan, path, content[:stop])


Change = Callable[[bytes, bytes], bytes]
CHANGES: dict[str, Change] = {
    "twice": lambda own, _: own + own,
    "a page of zeros": lambda own, _: own + bytes(4096),
    "zeros before it": lambda own, _: bytes(8) + own,
    "text": lambda own, _: own + b"# a note\n" * 100,
    "another behind it": lambda own, other: own + other,
    "the sum of another": lambda own, other: own[:-64] + other[-64:],
    "the end of another": lambda own, other: own[:-300] + other[-300:],
    "the middle of another": lambda own, other: own[:300] + other[300:-300] + own[-300:],
    "two halves swapped": lambda own, _: own[len(own) // 2 :] + own[: len(own) // 2],
    "a name of another segment": lambda own, _: own.replace(b"words1.npy", b"words2.npy"),
    "a kind of another": lambda own, _: own.replace(b"numbers1 ", b"numbers3 "),
    "another run": lambda _, other: other,
    "another version": lambda own, _: own.replace(b'"format": 3', b'"format": 4'),
    "the format before": lambda *_: b'{"is": "force-diffusion checkpoint", "format": 2}\n',
    "another zip": lambda *_: zipped("notes.txt"),
    "a zip whose first name begins alike": lambda *_: zipped(module.FIRST),
    "nothing": lambda *_: b"",
    "a list": lambda *_: b"[" * 9999 + b"\n",
    "no text": lambda *_: b"\xff\xfe\n",
    "zeros": lambda *_: bytes(300),
}  # fmt: skip


def zipped(name: str) -> bytes:
    content = BytesIO()
    with ZipFile(content, "w") as file:
        file.writestr(name, "{}")
    return content.getvalue()


@pytest.mark.parametrize("other", ["other radii", "other segments"])
@pytest.mark.parametrize("change", CHANGES)
def test_what_is_not_as_it_was_written_is_refused(change: str, other: str, tmp_path: Path) -> None:
    plan, path = small(), tmp_path / "kept"
    own = made(plan, path)
    second = small(seed=4) if other == "other radii" else small(layers=4)
    foreign = made(second, tmp_path / "foreign")
    wrong = CHANGES[change](own, foreign)
    assert wrong != own
    refused(plan, path, wrong)


@pytest.mark.parametrize(
    ("change", "why"),
    [
        ("the format before", "of an older version of the program: finish it with that, or delete"),
        ("another run", "of another scene, or of another version"),
        ("zeros", "is no checkpoint"),
        ("twice", "is damaged, .*: delete it, and the same command begins anew"),
    ],
)
def test_what_to_do_is_said(change: str, why: str, tmp_path: Path) -> None:
    path = tmp_path / "kept"
    own, other = made(small(), path), made(small(seed=4), tmp_path / "other")
    path.write_bytes(CHANGES[change](own, other))
    with pytest.raises(CheckpointError, match=why):
        run(small(), checkpoint=path)


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("quantity", ["profile", "histogram", "contact_forces", "positions"])
def test_from_each_state_of_it_the_answer_is_the_same(
    quantity: str, dimension: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A run killed at any moment leaves one of these, and is gone on from: none is solved twice."""
    plan, path = small(quantity, dimension=dimension), tmp_path / "kept"
    usual, found = run(plan), states(plan, path, monkeypatch)
    assert len(found) > 8
    deposited = []
    for content in found:
        path.write_bytes(content)
        again = run(plan, checkpoint=path)
        same(usual, again)
        assert again.accuracy == usual.accuracy
        deposited.append(again.work.deposited)
    assert deposited == sorted(deposited, reverse=True)
    assert deposited[0] == usual.work.deposited
    assert not deposited[-1]


def test_one_that_is_interrupted_keeps_what_is_done(tmp_path: Path) -> None:
    plan, path = small(layers=2), tmp_path / "kept"
    calls = iter(range(100))

    def stop(kind: str, beads: int) -> None:
        if next(calls) == 20:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt) as found:
        run(plan, stop, checkpoint=path)
    assert "goes on from there" in "".join(found.value.__notes__)
    again = run(plan, checkpoint=path)
    same(run(plan), again)
    assert again.work.deposited < run(plan).work.deposited


@pytest.mark.parametrize("torn", [0, 10, 50, 2000])
def test_what_a_killed_run_left_beside_it_is_removed(torn: int, tmp_path: Path) -> None:
    plan, path = small(), tmp_path / "kept"
    part, content = tmp_path / "kept.part", made(plan, path)
    for whole in (True, False):
        part.write_bytes(content[:torn])
        if not whole:
            path.unlink()
        same(run(plan), run(plan, checkpoint=path))
        assert not part.exists()


def test_a_file_of_somebody_else_beside_it_is_left_alone(tmp_path: Path) -> None:
    plan, path, part = small(), tmp_path / "kept", tmp_path / "kept.part"
    part.write_text("somebody's own notes, and a few words more")
    with pytest.raises(CheckpointError, match=f"{part} is in the way"):
        run(plan, checkpoint=path)
    assert part.read_text().startswith("somebody's")
    assert not path.exists()


def test_two_runs_are_not_let_into_one_file(tmp_path: Path) -> None:
    path = tmp_path / "kept"
    with Checkpoint(path, {}) as kept:
        kept.put("a", np.zeros(3))
        kept.save()
        with pytest.raises(CheckpointError, match="another run works on"):
            Checkpoint(path, {})
    with Checkpoint(path, {}) as kept:
        found = kept.get("a")
        assert found is not None
        assert (found == 0).all()


@pytest.mark.parametrize("room", [100, 3000, 5001])
def test_a_full_disk_is_said_and_gone_on_from(room: int, tmp_path: Path) -> None:
    """A limit of the file's size stands for the full disk: writing fails in the middle."""
    resource = pytest.importorskip("resource")
    plan, path = small(), tmp_path / "kept"
    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    try:
        resource.setrlimit(resource.RLIMIT_FSIZE, (room, limits[1]))
        with pytest.raises((NotReachedError, CheckpointError), match="File too large"):
            run(plan, checkpoint=path)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)
    assert not (tmp_path / "kept.part").exists()
    same(run(small()), run(plan, checkpoint=path))


LONG = """
from pathlib import Path
from force_diffusion.numeric.run import checkpoint
from force_diffusion.numeric.run.running import run
from tests.numeric.test_checkpoint import small
checkpoint.OFTEN = 0
plan = small("histogram", layers=2)
print("ready", flush=True)
while True:
    run(plan, checkpoint=Path("kept"))
    Path("kept").unlink()
"""


@pytest.mark.long
@pytest.mark.skipif(not hasattr(os, "fork"), reason="SIGKILL")
def test_killed_at_any_moment_it_is_whole_or_not_there(tmp_path: Path) -> None:
    plan, path, dice = small("histogram", layers=2), tmp_path / "kept", random.Random(1)
    usual, whole = run(plan), 0
    root = Path(__file__).parents[2]
    for _ in range(6):
        process = subprocess.Popen(
            [sys.executable, "-c", LONG], cwd=tmp_path, stdout=subprocess.PIPE,
            env=os.environ | {"PYTHONPATH": str(root)},
        )  # fmt: skip
        assert process.stdout is not None
        assert process.stdout.readline() == b"ready\n"
        for _ in range(3):
            time.sleep(dice.uniform(0.01, 0.2))
        process.send_signal(signal.SIGKILL)
        process.wait()
        process.stdout.close()
        whole += path.exists()
        same(usual, run(plan, checkpoint=path))
        assert not (tmp_path / "kept.part").exists()
        if dice.random() < 0.5:
            path.unlink()
    assert whole
