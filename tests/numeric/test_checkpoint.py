"""A damaged checkpoint gives no answer at all; one that ends early gives the same answer."""

import random
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path
from typing import Any

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

HEADER = 260  # bytes from which on a record has its array alone


def small(quantity: str = "profile", seed: int = 3, layers: int = 2) -> Plan:
    sections: dict[str, dict[str, Any]] = {
        "packing": {"height": 9, "width": 12},
        "disorder": {"kind": "uniform", "relative_std": "=1e-4", "seed": seed},
        "ask": {"quantity": quantity},
    }
    return cut(planned(sections), layers)


def records(plan: Plan, path: Path, monkeypatch: pytest.MonkeyPatch) -> list[bytes]:
    """Keep a whole run; give the file's first line and its records, in whatever format."""
    ends: list[int] = []
    real = Checkpoint.put

    def put(self: Checkpoint, name: str, values: Any) -> None:
        ends.append(path.stat().st_size)
        real(self, name, values)

    with monkeypatch.context() as patch:
        patch.setattr(Checkpoint, "put", put)
        run(plan, checkpoint=path)
    content = path.read_bytes()
    places = [0, *dict.fromkeys(ends), len(content)]
    assert len(places) > 10
    return [content[a:b] for a, b in pairwise(places)]


def refused(plan: Plan, path: Path, content: bytes) -> None:
    """See that there is no answer, and that the file stays as it is."""
    path.write_bytes(content)
    with pytest.raises(CheckpointError, match=str(path)):
        run(plan, checkpoint=path)
    assert path.read_bytes() == content


@pytest.mark.parametrize("quantity", ["profile", "histogram"])
@pytest.mark.parametrize(
    ("name", "other"),
    [("words1", "words0"), ("numbers2", "numbers3"), ("c1", "c3"), ("g3", "g2"), ("c2", "s2")],
)
def test_a_record_under_another_name_is_refused(
    quantity: str, name: str, other: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    plan, path = small(quantity), tmp_path / "kept"
    parts = records(plan, path, monkeypatch)
    before, after = f'"{name}"'.encode(), f'"{other}"'.encode()
    (at,) = [n for n, part in enumerate(parts) if before in part[:HEADER]]
    wrong = parts[at].replace(before, after)
    refused(plan, path, b"".join([*parts[:at], wrong, *parts[at + 1 :]]))
    refused(plan, path, b"".join([*parts[:at], wrong]))  # the last one of a killed run


@pytest.mark.long
def test_no_byte_of_a_checkpoint_can_be_changed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Every byte of all headers and 200 of the arrays: one bit of each, and another byte."""
    plan, path, dice = small(), tmp_path / "kept", random.Random(5)
    parts = records(plan, path, monkeypatch)
    content = b"".join(parts)
    starts = [sum(map(len, parts[:n])) for n in range(len(parts))]
    ends = [*starts[1:], len(content)]
    headers = [
        place for a, b in zip(starts, ends, strict=True) for place in range(a, min(a + HEADER, b))
    ]
    arrays = dice.sample(sorted(set(range(len(content))) - set(headers)), 200)
    for place in headers + arrays:
        for changed in (content[place] ^ 1 << dice.randrange(8), dice.randrange(256)):
            if changed != content[place]:
                refused(plan, path, content[:place] + bytes([changed]) + content[place + 1 :])


Change = Callable[[list[bytes], list[bytes]], list[bytes]]
CHANGES: dict[str, Change] = {
    "two swapped": lambda own, _: [*own[:3], own[4], own[3], *own[5:]],
    "the first two swapped": lambda own, _: [own[0], own[2], own[1], *own[3:]],
    "the last two swapped": lambda own, _: [*own[:-2], own[-1], own[-2]],
    "one twice": lambda own, _: [*own[:4], own[3], *own[4:]],
    "one twice, at the end": lambda own, _: [*own, own[3]],
    "the last twice": lambda own, _: [*own, own[-1]],
    "one missing": lambda own, _: [*own[:3], *own[4:]],
    "the first missing": lambda own, _: [own[0], *own[2:]],
    "all twice": lambda own, _: [*own, *own[1:]],
    "one of another": lambda own, other: [*own[:3], other[3], *own[4:]],
    "the last of another": lambda own, other: [*own[:-1], other[-1]],
    "one more of another": lambda own, other: [*own, other[2]],
    "the rest of another": lambda own, other: [*own[:3], *other[3:]],
    "the first line alone its own": lambda own, other: [own[0], *other[1:]],
    "the first line of another": lambda own, other: [other[0], *own[1:]],
    "a page of zeros": lambda own, _: [*own, bytes(4096)],
    "zeros in place of the last": lambda own, _: [*own[:-1], bytes(len(own[-1]))],
    "text": lambda own, _: [*own, b"# a note\n" * 100],
}


@pytest.mark.parametrize("other", ["other radii", "other segments"])
@pytest.mark.parametrize("change", CHANGES)
def test_records_stand_where_they_were_written(
    change: str, other: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    plan, path = small(), tmp_path / "kept"
    own = records(plan, path, monkeypatch)
    second = small(seed=4) if other == "other radii" else small(layers=4)
    foreign = records(second, tmp_path / "foreign", monkeypatch)
    refused(plan, path, b"".join(CHANGES[change](own, foreign)))


@pytest.mark.parametrize("quantity", ["profile", "histogram"])
def test_wherever_it_is_cut_off_the_answer_is_the_same(
    quantity: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    plan, path, dice = small(quantity), tmp_path / "kept", random.Random(5)
    parts = records(plan, path, monkeypatch)
    content, usual = b"".join(parts), run(small(quantity))
    ends = [sum(map(len, parts[:n])) for n in range(len(parts) + 1)]
    for stop in {*ends, *(end + 1 for end in ends[:-1]), *dice.sample(range(len(content)), 20)}:
        path.write_bytes(content[:stop])
        same(usual, run(plan, checkpoint=path))
        assert path.read_bytes()[:stop] == content[:stop]


def test_repeated_and_unknown_names_are_refused_though_all_sums_agree(tmp_path: Path) -> None:
    path = tmp_path / "kept"
    with Checkpoint(path, {}, {"a", "b"}) as kept:
        kept.put("a", np.zeros(3))
        kept.put("b", np.ones((2, 2)))
    with pytest.raises(CheckpointError, match=f"{path} is damaged"):
        Checkpoint(path, {}, {"a"})
    with Checkpoint(path, {}, {"a", "b"}) as kept:
        found = kept.get("b")
        assert found is not None
        assert (found == np.ones((2, 2))).all()
        kept._places.clear()  # so that it does not know better
        kept.put("a", np.ones(3))
    with pytest.raises(CheckpointError, match=f"{path} is damaged"):
        Checkpoint(path, {}, {"a", "b"})


def test_what_changes_while_it_is_used_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "kept"
    with Checkpoint(path, {}, {"a"}) as kept:
        kept.put("a", np.zeros(3))
        content = path.read_bytes()
        with path.open("r+b") as file:
            file.seek(len(content) - 5)
            file.write(b"\1")
        with pytest.raises(CheckpointError, match=f"{path} is damaged"):
            kept.get("a")


@pytest.mark.parametrize("room", [500, 3000, 5001])
def test_a_full_disk_is_said_and_gone_on_from(room: int, tmp_path: Path) -> None:
    """A limit of the file's size stands for the full disk: writing fails in the middle."""
    resource = pytest.importorskip("resource")
    plan, path = small(), tmp_path / "kept"
    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    try:
        resource.setrlimit(resource.RLIMIT_FSIZE, (room, limits[1]))
        with pytest.raises(NotReachedError, match="the same command goes on from there"):
            run(plan, checkpoint=path)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)
    assert path.stat().st_size == room
    same(run(small()), run(plan, checkpoint=path))


def test_one_of_an_older_format_is_named_so(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "kept"
    with monkeypatch.context() as patch:
        patch.setattr(module, "_FORMAT", 1)
        with Checkpoint(path, {}, set()):
            pass
    for first in (path.read_text(), '{"is": "force-diffusion checkpoint 1", "key": "0"}\n'):
        path.write_text(first)
        with pytest.raises(CheckpointError, match="of another version of the program"):
            Checkpoint(path, {}, set())


@pytest.mark.parametrize("line", [b"[" * 9_999 + b"\n", b"\xff\xfe\n", b"\0" * 300, b"{}", b"\n"])
def test_another_file_is_left_alone(line: bytes, tmp_path: Path) -> None:
    path = tmp_path / "kept"
    path.write_bytes(line)
    with pytest.raises(CheckpointError, match=f"{path} is no checkpoint"):
        Checkpoint(path, {}, set())
    assert path.read_bytes() == line
