"""The compiled sweeps of spheres against the NumPy sweeps: every bit, every gap, every error."""

import re
from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from force_diffusion.numeric.arithmetic.systems import FLOAT64, Array
from force_diffusion.numeric.disorder.radii import ArrayRadii
from force_diffusion.numeric.lattice.layers import whole
from force_diffusion.numeric.mechanics import engine, spheres
from force_diffusion.numeric.mechanics.forces import NotStandingError
from force_diffusion.numeric.mechanics.packing import UnbuildableError
from force_diffusion.numeric.mechanics.physicality import Physicality
from force_diffusion.numeric.mechanics.problem import Problem
from force_diffusion.numeric.mechanics.three_dimensions import Spheres
from force_diffusion.numeric.mechanics.work import Work
from force_diffusion.numeric.planning.times import predicted
from hypothesis import assume, given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

import force_diffusion as fd
from tests.numeric.spheres import scene

pytest.importorskip("numba")
from force_diffusion.numeric.mechanics.compiled_spheres import SphereSweeps

# Between the directions at which beads of the ordered packing overlap.
PHI = st.fractions(Fraction(-32, 100), Fraction(49, 100), max_denominator=10**6)
SIZES = st.tuples(st.integers(1, 3), st.integers(2, 8), st.integers(1, 7))


@st.composite
def radii(draw: st.DrawFn, largest: float = 0.05) -> Array:
    """δr/r of a batch of packings, (batch, layers, W, W), up to ``largest``."""
    batch, layers, width = draw(SIZES)
    size = draw(st.sampled_from([largest, largest * 1e-3, largest * 1e-9, 1e-300]))
    shape = batch, layers, width, width
    return np.asarray(draw(arrays(np.float64, shape, elements=st.floats(-1, 1))) * size)


def bits(rows: Any, lowest: int) -> list[bytes]:
    return [row.tobytes() for row in list(rows)[lowest:]]


def usual(rho: Array, phi: Fraction, loads: list[Array | None]) -> tuple[Any, Any, str]:
    """What the NumPy sweeps give, as far as they come, and why they stop."""
    rows = [row[0] if len(rho) == 1 else row for row in rho.swapaxes(0, 1)]
    placed, borne = None, None
    with FLOAT64.active():
        try:
            m = spheres.metric(3, phi, FLOAT64)
            placed = spheres.deposit(rows, m, FLOAT64, linear=False)
            borne = spheres.bear(placed, loads, FLOAT64, linear=False)
        except (UnbuildableError, NotStandingError) as error:
            return placed, borne, str(error)
    return placed, borne, ""


def quick(rho: Array, phi: Fraction, loads: list[Array | None]) -> tuple[Any, Any]:
    """What the compiled ones give, or None."""
    batch, layers, width, _ = rho.shape
    given = ArrayRadii(rho.reshape(batch, layers, -1), Fraction(0), Fraction(1))
    m = spheres.metric(3, phi, FLOAT64)
    sweeps = SphereSweeps(given, m, whole(width**2, layers - 1))
    rows = sweeps.radii(range(batch))
    placed = sweeps.deposit([row.reshape(*row.shape[:-1], width, width) for row in rows])
    return placed, None if placed is None else sweeps.bear(placed, loads)


def loads_on(data: st.DataObject, rho: Array) -> list[Array | None]:
    _, layers, *shape = rho.shape
    row = st.none() | arrays(np.float64, tuple(shape), elements=st.floats(-3, 3))
    return data.draw(st.lists(row, min_size=layers, max_size=layers))


@given(st.data(), PHI, radii())
def test_every_bit_is_that_of_the_numpy_sweep(
    data: st.DataObject, phi: Fraction, rho: Array
) -> None:
    loads = loads_on(data, rho)
    placed, borne, _ = usual(rho, phi, loads)
    compiled, forces = quick(rho, phi, loads)
    assert (compiled is None) == (placed is None)
    assume(placed is not None)
    assert bits(compiled.c, 0) == bits(placed.c, 0)
    assert bits(compiled.dn, 1) == bits(placed.dn, 1)
    assert (forces is None) == (borne is None)
    if borne is not None:
        assert bits(forces.ordered, 1) == bits(borne.ordered, 1)
        assert bits(forces.change, 1) == bits(borne.change, 1)


@given(PHI, radii(largest=0.9), st.sampled_from([0.0, -1.0, np.nan, np.inf, 1e200]))
def test_what_cannot_be_built_is_left_to_the_numpy_sweep(
    phi: Fraction, rho: Array, odd: float
) -> None:
    rho[:, len(rho[0]) // 2, 0, 0] += odd
    load: list[Array | None] = [None] * (len(rho[0]) - 1) + [np.ones(rho.shape[2:])]
    placed, borne, _ = usual(rho, phi, load)
    compiled, forces = quick(rho, phi, load)
    if compiled is not None:
        assert bits(compiled.c, 0) == bits(placed.c, 0)
    assert (compiled is None) == (placed is None)
    if forces is not None:
        assert bits(forces.change, 1) == bits(borne.change, 1)


def test_a_strip_may_be_longer_than_what_is_copied_at_a_time() -> None:
    """Layers of 400 beads, in batches of two."""
    rho = np.random.default_rng(1).uniform(-1e-2, 1e-2, (2, 4, 20, 20))
    load: list[Array | None] = [None, np.ones((20, 20)), None, np.ones((20, 20))]
    placed, borne, _ = usual(rho, Fraction(1, 5), load)
    compiled, forces = quick(rho, Fraction(1, 5), load)
    assert bits(compiled.dn, 1) == bits(placed.dn, 1)
    assert bits(forces.change, 1) == bits(borne.change, 1)


def solved(problem: Problem, realisations: int) -> Spheres:
    with FLOAT64.active():
        found = engine.solve(problem, range(realisations), FLOAT64, Work())
    assert isinstance(found, Spheres)
    return found


@given(radii(), PHI)
def test_every_gap_is_that_of_numpy(rho: Array, phi: Fraction) -> None:
    def looked(placed: Any) -> Physicality:
        physical = Physicality(looks_at=range(len(rho)))
        Spheres(FLOAT64, None, None, None, placed=placed, phi=phi).look_at_gaps(physical)
        return physical

    load: list[Array | None] = [None] * len(rho[0])
    placed, _, _ = usual(rho, phi, load)
    compiled, _ = quick(rho, phi, load)
    assume(placed is not None)
    assert isinstance(compiled, spheres.CompiledPlaced)
    assert looked(compiled) == looked(placed)


POINT = fd.PointLoad(at=(1, 2, 2))
ASKED: dict[str, Any] = {
    "contact_forces": {},
    "profile": {},
    "histogram": {"bins": 7},
    "positions": {},
    "base_reactions": {},
    "response": {"load": POINT},
    "contact": {"at": (1, 2, 1, "2")},
}


@pytest.mark.parametrize("quantity", ASKED)
@pytest.mark.parametrize(
    "load",
    [
        fd.SurfaceLoad(),
        fd.BulkLoad(angle_deg=20),
        POINT,
        fd.PointLoad(at=(0, 1, 3), pressure=0.5),
    ],
    ids=["surface", "bulk, 20°", "point", "point and pressure"],
)
@pytest.mark.parametrize("realisations", [1, 5])
def test_answers_are_those_without_numba(
    quantity: str, load: fd.Load, realisations: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked = scene(quantity, height=3, width=4, realisations=realisations,
                  **({"load": load} | ASKED[quantity]))  # fmt: skip
    monkeypatch.setattr(engine, "TOGETHER", 100)  # two packings, so that the last is alone
    before = asked.run()
    monkeypatch.setattr(engine, "COMPILED_FROM", 1)
    after = asked.run()
    for name, values in before.arrays.items():
        assert after.arrays[name].tobytes() == values.tobytes()
    assert after.physical == before.physical


def test_a_drawn_radius_that_is_not_positive_is_named_alike(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    asked = scene("profile", height=5, width=6).model_copy(
        update={"disorder": fd.Disorder(kind="normal", relative_std=0.9, seed=1)}
    )
    with pytest.raises(fd.ForceDiffusionError, match=r"bead \(\d, \d, \d\)") as usual_error:
        asked.run()
    monkeypatch.setattr(engine, "COMPILED_FROM", 1)
    with pytest.raises(fd.ForceDiffusionError, match=re.escape(str(usual_error.value))):
        asked.run()


def test_the_engine_takes_the_compiled_sweeps_for_as_much_work_as_of_discs(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    problem = scene("profile", height=3, width=4, realisations=4).explain().problem
    monkeypatch.setattr(engine, "ONCE_LOADED", 1)  # the compiler is, here
    assert not isinstance(solved(problem, 4).placed, spheres.CompiledPlaced)
    work = 4 * (problem.region.beads + 4 * engine.OF_ROW)
    for limit, taken in ((work + 1, False), (work, True)):
        monkeypatch.setattr(engine, "COMPILED_FROM", limit)
        assert isinstance(solved(problem, 4).placed, spheres.CompiledPlaced) == taken


def test_a_plan_says_that_compiled_sweeps_are_taken_and_quicker(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    plan = scene("profile", height=60, width=200).explain()
    assert plan.problem.region.beads > engine.COMPILED_FROM
    quick_one = predicted(plan.quantity, plan.problem, plan.method, 1)
    assert any(step.reason.endswith("by compiled code") for step in plan.steps)
    monkeypatch.setattr(engine, "COMPILED_FROM", 1 << 60)
    assert quick_one < predicted(plan.quantity, plan.problem, plan.method, 1)


def test_first_order_draws_compiled_radii(monkeypatch: pytest.MonkeyPatch) -> None:
    asked = scene("contact_forces", height=3, width=4, geometry="first-order", realisations=3)
    before = asked.run().arrays["change"]
    monkeypatch.setattr(engine, "COMPILED_FROM", 1)
    assert asked.run().arrays["change"].tobytes() == before.tobytes()


def test_processes_of_an_ensemble_compile_and_sum_up_alike(monkeypatch: pytest.MonkeyPatch) -> None:
    """As many packings as make them take compiled sweeps by themselves."""
    asked = scene("profile", height=10, width=20)
    packings = engine.COMPILED_FROM // asked.explain().problem.region.beads + 1
    found = [fd.ensemble(asked, packings, workers=workers).std.tolist() for workers in (1, 2)]
    monkeypatch.setattr(engine, "COMPILED_FROM", 1 << 60)
    usual = fd.ensemble(asked, packings, workers=1).std.tolist()
    assert found == [usual, usual]
