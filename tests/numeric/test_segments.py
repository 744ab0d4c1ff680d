"""A packing that the memory does not hold: the numbers of one that it holds; its checkpoint."""

import os
from dataclasses import replace
from fractions import Fraction
from itertools import count, product
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from force_diffusion.numeric.arithmetic.errors import NotReachedError
from force_diffusion.numeric.arithmetic.systems import FLOAT64, Balls, BigFloat, as_ball
from force_diffusion.numeric.disorder.radii import RadiusError
from force_diffusion.numeric.mechanics import engine
from force_diffusion.numeric.mechanics.physicality import Physicality
from force_diffusion.numeric.mechanics.sweep import UnbuildableError
from force_diffusion.numeric.mechanics.work import Work
from force_diffusion.numeric.planning import memory
from force_diffusion.numeric.planning.plan import Plan
from force_diffusion.numeric.planning.planner import plan
from force_diffusion.numeric.quantities.answer import answer
from force_diffusion.numeric.run import checkpoint
from force_diffusion.numeric.run.checkpoint import Checkpoint as CheckpointOf
from force_diffusion.numeric.run.checkpoint import CheckpointError
from force_diffusion.numeric.run.outcome import Outcome
from force_diffusion.numeric.run.running import Scene, run
from force_diffusion.numeric.scene.sections import Ask, GivenRadii, Packing, SceneError

from tests.numeric.scenes import planned, scene

pytest.importorskip("numba")

DISORDER = {"kind": "uniform", "relative_std": "=1e-4", "seed": 3}
STRIP = {"height": 21, "width": 46}
SPHERES = {"height": 9, "width": 20, "dimension": 3}
POINT = {"kind": "point", "at": [3, 17]}
CASES: dict[str, dict[str, dict[str, Any]]] = {
    "profile": {"packing": STRIP, "ask": {"quantity": "profile"}},
    "profile, bulk load": {
        "packing": STRIP, "load": {"kind": "bulk", "magnitude": "=3.7"},
        "ask": {"quantity": "profile"},
    },
    "profile, point load": {"packing": STRIP, "load": POINT, "ask": {"quantity": "profile"}},
    "response": {
        "packing": STRIP, "load": POINT, "ask": {"quantity": "response", "layers": [16, 0, 9, 8]},
    },
    "response below the load": {
        "packing": STRIP, "load": POINT, "ask": {"quantity": "response", "layers": [16]},
    },
    "response of a slab": {
        "packing": {"height": 19}, "load": {"kind": "point", "at": [-4, 18], "angle_deg": 7},
        "ask": {"quantity": "response", "layers": [3]},
    },
    "histogram": {"packing": STRIP, "ask": {"quantity": "histogram", "bins": 7}},
    "histogram of a layer": {"packing": STRIP, "ask": {"quantity": "histogram", "layers": [9]}},
    "histogram of a point load": {
        "packing": STRIP, "load": POINT | {"magnitude": "=3.7"}, "ask": {"quantity": "histogram"},
    },
    "contact": {"packing": STRIP, "ask": {"quantity": "contact", "at": [1, 7, "-"]}},
    "contact of a slab": {
        "packing": {"height": 18}, "ask": {"quantity": "contact", "at": [0, 4, "+"]},
    },
    "all forces": {"packing": STRIP, "ask": {"quantity": "contact_forces"}},
    "all forces, in another unit": {
        "packing": STRIP, "load": {"kind": "bulk", "magnitude": "=3.7"},
        "ask": {"quantity": "contact_forces"},
    },
    "all forces of a point load": {
        "packing": STRIP, "load": POINT, "ask": {"quantity": "contact_forces"},
    },
    "whole response": {"packing": STRIP, "load": POINT, "ask": {"quantity": "response"}},
    "positions": {"packing": STRIP, "ask": {"quantity": "positions"}},
    "one position": {"packing": {"height": 21}, "ask": {"quantity": "positions", "at": [1, 15]}},
    "spheres, profile": {"packing": SPHERES, "ask": {"quantity": "profile"}},
    "spheres, forces": {"packing": SPHERES, "ask": {"quantity": "contact_forces"}},
    "spheres, forces of a point load": {
        "packing": SPHERES, "load": {"kind": "point", "at": [1, 2, 7]},
        "ask": {"quantity": "contact_forces"},
    },
    "spheres, response": {
        "packing": SPHERES, "load": {"kind": "point", "at": [1, 2, 7]},
        "ask": {"quantity": "response"},
    },
    "spheres, positions": {"packing": SPHERES, "ask": {"quantity": "positions"}},
    "spheres, one position": {
        "packing": SPHERES, "ask": {"quantity": "positions", "at": [1, 2, 5]},
    },
    "spheres, contact": {
        "packing": SPHERES, "ask": {"quantity": "contact", "at": [1, 2, 3, "2"]},
    },
    "spheres, histogram": {"packing": SPHERES, "ask": {"quantity": "histogram", "bins": 5}},
}  # fmt: skip


def sections(name: str, **disorder: Any) -> dict[str, dict[str, Any]]:
    return {"disorder": DISORDER | disorder, **CASES[name]}


def cut(made: Plan, layers: int, every: int = 1) -> Plan:
    found = memory.by_segments(made.problem, made.system, made.scene, None)
    assert found is not None
    return replace(made, problem=replace(found[0], segment=layers, every=every))


def same(a: Outcome, b: Outcome) -> None:
    assert list(a.arrays) == list(b.arrays)
    for name, column in a.arrays.items():
        assert column.tobytes() == b.arrays[name].tobytes(), name
    assert a.decimals()[0].keys() == b.decimals()[0].keys()
    assert a.physical == b.physical


@pytest.mark.long(sample=8)
@pytest.mark.parametrize("layers", [2, 6, 8, 40])
@pytest.mark.parametrize("name", CASES)
@pytest.mark.parametrize("kind", ["uniform", "two-point"])
def test_segments_give_every_bit_of_the_sweep_in_memory(name: str, layers: int, kind: str) -> None:
    made = planned(sections(name, kind=kind))
    same(run(made), run(cut(made, layers)))


@pytest.mark.long(sample=12)
@pytest.mark.parametrize("every", [2, 3, 5])
@pytest.mark.parametrize("name", CASES)
def test_so_they_do_where_few_layers_are_kept(name: str, every: int) -> None:
    """Layers that are found once more on the way down; none is kept longer than it is needed."""
    made = planned(sections(name))
    found = run(cut(made, 2, every))
    same(run(made), found)
    assert found.work.deposited > run(cut(made, 2)).work.deposited


@pytest.mark.parametrize("quantity", ["profile", "contact_forces", "positions"])
@pytest.mark.parametrize("dimension", [2, 3])
def test_given_radii_are_swept_by_segments(quantity: str, dimension: int) -> None:
    shape = (10, 24) if dimension == 2 else (10, 20, 20)
    radii = 1 + np.random.default_rng(3).uniform(-1e-3, 1e-3, shape)
    asked = Scene(
        packing=Packing(height=9, width=shape[1], dimension=dimension),
        disorder=GivenRadii(radii=radii),
        ask=Ask(quantity=quantity),
    )
    made = plan(asked)
    same(run(made), run(cut(made, 4)))
    assert run(made).accuracy.error_bound < 1e-12


def true_error(plan: Plan) -> float:
    """Of the answer, relative to the largest change: what balls of the same radii say."""
    system, one = Balls(160), range(1)
    table = run(plan).answer.table
    exact = answer(plan.quantity, plan.problem, one, system).table
    with system.active():
        pairs = [
            (as_ball(b), as_ball(a))
            for name in table.small
            for a, b in zip(table.numbers[name], exact.numbers[name], strict=True)
        ]
        largest = max(float(abs(b).upper()) for b, _ in pairs)
        return max(float(abs(b - a).upper()) for b, a in pairs) / largest


@pytest.mark.long(sample=1, share=3)
@pytest.mark.parametrize("name", CASES)
def test_the_stated_error_covers_the_true_one(name: str) -> None:
    for seed, std in product(range(10), ("=1e-8", "=1e-3")):
        made = planned(sections(name, seed=seed, relative_std=std))
        assert true_error(made) <= run(cut(made, 6)).accuracy.error_bound, (seed, std)


@pytest.mark.long(share=3)
@pytest.mark.parametrize("layers", [2, 8, 40])
@pytest.mark.parametrize("name", CASES)
def test_the_error_is_that_of_the_sweep_in_memory(name: str, layers: int) -> None:
    for kind, seed in product(("uniform", "two-point"), range(3)):
        made = planned(sections(name, kind=kind, seed=seed))
        alike(run(cut(made, layers)), run(made))


@pytest.mark.parametrize("name", ["profile", "histogram", "spheres, response"])
def test_one_segment_is_the_small_case(name: str) -> None:
    """Nothing is done twice, and the error is as exact as in memory."""
    made = planned(sections(name))
    one = cut(made, 40)
    assert made.problem.segments == one.problem.segments == 1
    assert cut(made, 2).problem.segments == (made.problem.region.top + 1) // 2
    usual, found = run(made), run(one)
    same(usual, found)
    assert found.accuracy == usual.accuracy
    assert found.work.deposited == usual.work.deposited == made.problem.region.beads


def alike(a: Outcome, b: Outcome) -> None:
    """The error of parts is kept as a float, rounded up."""
    assert a.accuracy.note == b.accuracy.note
    assert a.accuracy.error_bound == pytest.approx(float(b.accuracy.error_bound), rel=1e-12)


@pytest.mark.parametrize("name", ["contact", "base of a slab", "response", "histogram"])
def test_without_a_long_double_big_floats_repeat_it(name: str) -> None:
    made = planned(sections(name, seed=4))
    made = replace(made, method=replace(made.method, longer=BigFloat(35)))
    found = run(cut(made, 6))
    alike(found, run(made))


def test_one_contact_of_many_beads_has_its_own_error() -> None:
    """An error of 16 columns in its place was a third of the true one."""
    parts: dict[str, dict[str, Any]] = {
        "packing": {"height": 400, "width": 802},
        "disorder": {"kind": "uniform", "relative_std": "=1e-8", "seed": 4},
        "ask": {"quantity": "contact", "at": [0, 0, "+"]},
    }
    by_parts = plan(scene(parts), memory_limit=25 * 10**7)
    assert by_parts.problem.segment
    alike(run(by_parts), run(plan(scene(parts), memory_limit=10**10)))


def test_a_plan_that_the_memory_does_not_hold_is_made_of_segments() -> None:
    asked = scene(sections("profile") | {"packing": {"height": 1999, "width": 2002}})
    whole = plan(asked, memory_limit=4 * 10**9)
    parts = plan(asked, memory_limit=4 * 10**8)
    assert not whole.problem.segment
    assert parts.problem.segment % 2 == 0
    assert 0 < parts.memory < 4 * 10**8 < whole.memory
    text = str(parts)
    assert "twice" in text
    assert f"{parts.problem.segment} of 2000 layers at a time" in text
    assert f"{memory.size(whole.memory)} of memory would be needed and 400 MB may be used" in text
    with pytest.raises(SceneError, match="width = 2002: this scene would need"):
        plan(asked, memory_limit=2 * 10**8)


def test_a_plan_of_more_beads_still_keeps_fewer_layers() -> None:
    """Of 10⁹ beads: less than 1 GB, and what is kept is found once more on the way down."""
    asked = scene(sections("profile") | {"packing": {"height": 31_621, "width": 31_623}})
    made = plan(asked, memory_limit=10**11)
    assert made.problem.every > 1
    assert made.memory < 10**9
    assert "three times" in str(made)
    assert made.memory < plan(
        scene(sections("profile") | {"packing": {"height": 9999, "width": 10_002}}),
        memory_limit=10**11,
    ).memory + 6 * 10**8  # fmt: skip


def test_a_plan_of_very_many_beads_is_made_of_segments_since_that_is_quicker() -> None:
    asked = scene(sections("profile") | {"packing": {"height": 2999, "width": 3002}})
    parts = plan(asked, memory_limit=10**11)
    assert parts.problem.segment
    assert "of memory that was not used before take longer" in str(parts)
    assert not plan(asked, Fraction(1, 10**8), memory_limit=10**11).problem.segment


@pytest.mark.parametrize("said", ["in the scene", "beside it"])
def test_with_a_tolerance_it_is_refused_and_said_that_without_it_runs(said: str) -> None:
    """Segments are swept in float64 alone: no answer to a tolerance, wherever it stands."""
    wanted: dict[str, dict[str, Any]] = sections("profile", relative_std="=1e-8")
    wanted |= {"packing": {"height": 1999, "width": 2002}}
    without = plan(scene(wanted), memory_limit=4 * 10**8)
    inside = {"tolerance": "=1e-8"} if said == "in the scene" else {}
    asked = scene(wanted | {"ask": {"quantity": "profile"} | inside})
    beside = None if inside else Fraction(1, 10**8)
    advice = f"without the tolerance it would take about {memory.size(without.memory)}$"
    with pytest.raises(SceneError, match=advice):
        plan(asked, beside, memory_limit=4 * 10**8)
    assert not plan(asked, beside, memory_limit=4 * 10**9).problem.segment
    for limit, certified in ((2 * 10**8, False), (4 * 10**8, True)):  # it would not run, won't do
        with pytest.raises(SceneError, match=r"or for a smaller packing$"):
            plan(asked, beside, memory_limit=limit, certified=certified)


def test_without_numba_it_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(memory, "find_spec", lambda name: None)
    asked = scene(sections("profile") | {"packing": {"height": 1999, "width": 2002}})
    with pytest.raises(SceneError, match="may be used"):
        plan(asked, memory_limit=4 * 10**8)


class KilledError(Exception):
    pass


@pytest.mark.long(sample=9)
@pytest.mark.parametrize(
    ("name", "calls"),
    [
        ("profile", 1),
        ("profile", 5),
        ("profile", 9),
        ("profile", 14),
        ("profile", 20),
        ("profile", 31),
        ("histogram", 9),
        ("histogram", 30),
        ("histogram", 37),
        ("histogram", 46),
    ],
)
def test_a_killed_run_goes_on_from_its_checkpoint(
    tmp_path: Path, name: str, calls: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(checkpoint, "OFTEN", 0)
    monkeypatch.setattr(CheckpointOf, "__exit__", lambda self, *error: self._close())
    made = planned(sections(name))
    usual = run(made)
    path, left = tmp_path / "run.checkpoint", count(calls, -1)

    def kill(kind: str, beads: int) -> None:
        if not next(left):
            raise KilledError

    with pytest.raises(KilledError):
        run(cut(made, 4), kill, checkpoint=path)
    monkeypatch.undo()
    again = run(cut(made, 4), checkpoint=path)
    same(usual, again)
    ways = 2 if name == "histogram" else 1
    assert again.work.balanced <= ways * (usual.work.balanced + 46 * 6)
    finished = run(cut(made, 4), checkpoint=path)
    same(usual, finished)
    assert not finished.work.balanced


def test_what_is_no_checkpoint_of_this_run_is_left_alone(tmp_path: Path) -> None:
    whole = planned(sections("profile"))
    made = cut(whole, 4)
    other, foreign = tmp_path / "other", tmp_path / "foreign"
    run(cut(planned(sections("profile", seed=4)), 4), checkpoint=other)
    foreign.write_text('{"is": "a list"}\n')
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    for path, why in (
        (other, "of another scene"),
        (foreign, "is no checkpoint"),
        (tmp_path, "is no ordinary file"),
        (tmp_path / "nowhere" / "kept", "can't be opened"),
        (Path("/dev/zero"), "is no ordinary file"),
        (pipe, "is no ordinary file"),
    ):
        content = path.read_bytes() if path.is_file() else b""
        with pytest.raises(CheckpointError, match=why):
            run(made, checkpoint=path)
        if path != other and "nowhere" not in path.parts:  # also where none is needed
            with pytest.raises(CheckpointError, match=why):
                run(whole, checkpoint=path)
        assert not path.is_file() or path.read_bytes() == content


def test_a_bead_that_cannot_rest_is_named_alike() -> None:
    made = planned(sections("profile", relative_std="=0.07"))
    with pytest.raises(UnbuildableError) as usual:
        run(made)
    with pytest.raises(UnbuildableError) as found:
        run(cut(made, 4))
    assert str(found.value) == str(usual.value)


@pytest.mark.parametrize("name", ["profile", "spheres, profile"])
def test_a_radius_that_is_not_positive_is_named_alike(name: str) -> None:
    """Of spheres as (p, q, j), and not by the column in the row of W² beads."""
    made = planned(sections(name, kind="normal", relative_std="=0.45"))
    said = []
    for one in (made, cut(made, 4)):
        with pytest.raises(RadiusError) as found:
            run(one)
        said.append(str(found.value))
    assert said[0] == said[1]
    assert len(said[0].split(":")[0].split(",")) == made.problem.dimension


def test_a_force_that_is_no_number_is_said(monkeypatch: pytest.MonkeyPatch) -> None:
    from force_diffusion.numeric.mechanics import passes

    made = planned(sections("profile"))
    monkeypatch.setattr(passes.Descent, "__call__", lambda *_: None)
    with pytest.raises(NotReachedError, match="a force is beyond the range of float64"):
        run(cut(made, 4))


@pytest.mark.long(sample=12)
@pytest.mark.parametrize("kind", ["uniform", "two-point"])
@pytest.mark.parametrize("name", CASES)
def test_gaps_by_compiled_loops_are_those_of_numpy(
    name: str, kind: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    problem = planned(sections(name, kind=kind, relative_std="=0.02")).problem
    found = []
    for threshold in (1, 10**9):
        monkeypatch.setattr(engine, "COMPILED_FROM", threshold)
        physical = Physicality()
        with FLOAT64.active():
            for _ in engine.packings(problem, range(5), FLOAT64, Work(), physical):
                pass
        found.append(physical)
    assert found[0] == found[1]
    assert found[0].smallest_gap is not None
    assert np.isfinite(found[0].smallest_gap)
