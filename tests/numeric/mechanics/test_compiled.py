"""The compiled sweeps against the NumPy sweeps: every bit, every count, every error."""

import re
import sys
from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from force_diffusion.numeric.arithmetic.systems import FLOAT64, LONGDOUBLE, Array
from force_diffusion.numeric.disorder.radii import DrawnRadii, RadiusError, rows_of
from force_diffusion.numeric.lattice.branch import Branch, Contact, PerBranch
from force_diffusion.numeric.lattice.layers import Layer, Region, standing_on_base, whole
from force_diffusion.numeric.lattice.regions import contact_rows, downward_cone, upward_cone
from force_diffusion.numeric.mechanics import engine, forces, packing
from force_diffusion.numeric.mechanics.forces import (
    CompiledForces,
    Forces,
    Loads,
    NotStandingError,
)
from force_diffusion.numeric.mechanics.packing import SolvedPacking, UnbuildableError
from force_diffusion.numeric.mechanics.work import Work
from hypothesis import assume, given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from tests.numeric.scenes import basic, planned

pytest.importorskip("numba")
import numba
from force_diffusion.numeric.disorder import compiled as drawing
from force_diffusion.numeric.mechanics import compiled as fast
from numba.extending import intrinsic

SIZES = st.tuples(st.integers(1, 9), st.integers(1, 3), st.integers(1, 33))
N_X = st.fractions(Fraction(51, 100), Fraction(86, 100), max_denominator=10**6)


@st.composite
def radii(draw: st.DrawFn, largest: float = 0.05) -> tuple[Region, tuple[Array, ...]]:
    """A packing, or a batch of them, with |δr/r| up to ``largest``."""
    height, batch, width = draw(SIZES)
    size = draw(st.sampled_from([largest, largest * 1e-3, largest * 1e-9, 1e-300]))
    shape = (height + 1, width) if batch == 1 else (height + 1, batch, width)
    values = draw(arrays(np.float64, shape, elements=st.floats(-1, 1)))
    return whole(width, height), tuple(values * size)


@st.composite
def loads_on(draw: st.DrawFn, region: Region) -> Loads:
    width = region.width
    assert width is not None
    row = st.none() | arrays(np.float64, width, elements=st.floats(-3, 3))
    rows = st.tuples(*[row] * len(region.rows))
    return Loads(draw(rows), draw(rows))


def bits(solved: SolvedPacking | Forces) -> Any:
    names = ("rho", "c", "dn") if isinstance(solved, SolvedPacking) else ("ordered", "change")

    def raw(value: Any) -> Any:
        if isinstance(value, PerBranch):
            return raw(value.plus), raw(value.minus)
        if not isinstance(value, np.ndarray):
            return [raw(v) for v in value]
        return value.shape, value.dtype, value.tobytes()

    return [raw(getattr(solved, name)) for name in names]


def outcome(function: Any, *arguments: Any, **keywords: Any) -> tuple[Any, str]:
    with FLOAT64.active():
        try:
            return function(*arguments, **keywords), ""
        except (UnbuildableError, NotStandingError) as error:
            return None, str(error)


@given(st.data(), N_X, radii())
def test_every_bit_is_that_of_the_numpy_sweep(
    data: st.DataObject, n_x: Fraction, case: tuple[Region, tuple[Array, ...]]
) -> None:
    region, rho = case
    loads = data.draw(loads_on(region))
    work, compiled_work = Work(trace=True), Work(trace=True)
    solved, why = outcome(packing.deposit, n_x, region, rho, FLOAT64, work)
    compiled, compiled_why = outcome(fast.deposit, n_x, region, rho, FLOAT64, compiled_work)
    assert compiled_why == why
    assume(solved is not None)
    assert isinstance(compiled, fast.CompiledPacking)
    assert bits(compiled) == bits(solved)
    found, why = outcome(forces.sweep_down, solved, region.rows, loads, work=work)
    quick, quick_why = outcome(fast.sweep_down, compiled, region.rows, loads, work=compiled_work)
    assert quick_why == why
    if found is not None:
        assert bits(quick) == bits(found)
        assert compiled_work == work


@st.composite
def regions(draw: st.DrawFn) -> tuple[Region, tuple[Layer, ...]]:
    """Beads that decide one contact, or those below a loaded bead; of a slab or a strip."""
    width = draw(st.none() | st.integers(1, 14))
    top, i = draw(st.integers(1, 8)), draw(st.integers(-9, 9))
    rows = downward_cone([(2 * i + top % 2, top)], width)
    if draw(st.booleans()):
        contact = Contact(2 * i, 0, draw(st.sampled_from(Branch)))
        rows = contact_rows(contact, upward_cone(contact.upper, top, width), width)
    return standing_on_base(rows, width), rows


@given(st.data(), N_X, regions())
def test_every_bit_of_any_region_is_that_of_the_numpy_sweep(
    data: st.DataObject, n_x: Fraction, case: tuple[Region, tuple[Layer, ...]]
) -> None:
    region, rows = case
    batch = data.draw(st.integers(1, 3))
    values = data.draw(
        arrays(np.float64, (batch, region.beads), elements=st.floats(-1, 1)).map(lambda v: v / 50)
    )
    if batch == 1:
        values = values[0]
    edges = np.cumsum([row.count for row in region.rows])[:-1]
    rho = tuple(np.split(values, edges, axis=-1))
    row = [st.none() | arrays(np.float64, layer.count, elements=st.floats(-3, 3)) for layer in rows]
    loads = Loads(data.draw(st.tuples(*row)), data.draw(st.tuples(*row)))
    solved, why = outcome(packing.deposit, n_x, region, rho, FLOAT64)
    compiled, compiled_why = outcome(fast.deposit, n_x, region, rho, FLOAT64)
    assert compiled_why == why
    assume(solved is not None)
    assert bits(compiled) == bits(solved)
    found, why = outcome(forces.sweep_down, solved, rows, loads)
    quick, quick_why = outcome(fast.sweep_down, compiled, rows, loads)
    assert quick_why == why
    if found is not None:
        assert isinstance(quick, CompiledForces)
        assert bits(quick) == bits(found)


@given(
    st.sampled_from(["uniform", "normal", "two-point"]),
    st.integers(0, 2**63 - 1),
    st.lists(st.integers(0, 2**62), min_size=1, max_size=3),
    st.lists(st.tuples(st.integers(-40, 40), st.integers(0, 40)), min_size=1, max_size=4),
    st.none() | st.integers(40, 50),
)
def test_every_bit_of_a_drawn_radius_is_that_of_the_numpy_draw(
    kind: str,
    seed: int,
    realisations: list[int],
    rows: list[tuple[int, int]],
    width: int | None,
) -> None:
    source = DrawnRadii(kind, Fraction(1, 10**6), seed, width)
    layers = tuple(Layer(j, 2 * i + j % 2, n) for j, (i, n) in enumerate(rows))
    usual = np.concatenate(
        [
            source.row(layer, realisations, FLOAT64).reshape(len(realisations), layer.count)
            for layer in layers
        ],
        axis=-1,
    )
    rho, found = fast.Drawing(source, Region(width, layers))(realisations)
    assert rho.tobytes() == usual.tobytes()
    assert [row.shape[-1] for row in found] == [n for _, n in rows]


def test_a_drawn_radius_that_is_not_positive_is_named() -> None:
    source = DrawnRadii("normal", Fraction(1, 3), 5, 40)
    region = whole(40, 9)
    with pytest.raises(RadiusError) as usual:
        rows_of(source, region.rows, [3, 4], FLOAT64)
    with pytest.raises(RadiusError, match=re.escape(str(usual.value))):
        fast.Drawing(source, region)([3, 4])


def test_memory_that_is_used_again_changes_no_bit(monkeypatch: pytest.MonkeyPatch) -> None:
    plan = planned(basic(6, 9, quantity="contact_forces", realisations=7))
    monkeypatch.setattr(engine, "COMPILED_FROM", 1)
    monkeypatch.setattr(engine, "TOGETHER", 3 * plan.problem.region.beads)
    with FLOAT64.active():
        found = [
            (bits(solved.packing), bits(solved.forces))
            for solved, _ in engine.packings(plan.problem, range(7), FLOAT64)
        ]
        for at, one in zip((0, 3, 6), found, strict=True):
            alone = engine.solve(plan.problem, range(at, min(at + 3, 7)), FLOAT64, Work())
            assert one == (bits(alone.packing), bits(alone.forces))


@given(N_X, radii(largest=0.9), st.sampled_from([0.0, -1.0, np.nan, np.inf, 1e200]))
def test_what_cannot_be_built_is_named_alike(
    n_x: Fraction, case: tuple[Region, tuple[Array, ...]], odd: float
) -> None:
    region, rho = case
    rho[len(rho) // 2][..., 0] += odd
    solved, why = outcome(packing.deposit, n_x, region, rho, FLOAT64)
    compiled, compiled_why = outcome(fast.deposit, n_x, region, rho, FLOAT64)
    assert compiled_why == why
    if solved is not None:
        assert bits(compiled) == bits(solved)


@given(radii(), st.booleans(), st.booleans())
def test_what_is_not_compiled_is_left_to_the_numpy_sweep(
    case: tuple[Region, tuple[Array, ...]], stop: bool, part: bool
) -> None:
    region, rho = case
    n_x = Fraction(3, 4)
    none = Loads((None,) * len(rho), (None,) * len(rho))
    longer = tuple(r.astype(np.longdouble) for r in rho)
    with LONGDOUBLE.active():
        solved = fast.deposit(n_x, region, longer, LONGDOUBLE)
    assert type(solved) is SolvedPacking
    compiled = fast.deposit(n_x, region, rho, FLOAT64)
    rows = region.rows[: len(rho) - part]
    cut = Loads(none.plus[: len(rows)], none.minus[: len(rows)])
    quick = fast.sweep_down(compiled, rows, cut, stop_at_tension=stop and rho[0].ndim == 1)
    assert bits(quick) == bits(forces.sweep_down(compiled, rows, cut))


def test_the_engine_takes_the_compiled_sweeps_for_much_work(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    scene = basic(6, 9, quantity="contact_forces", realisations=4)
    scene["packing"]["allow_images"] = True
    plan = planned(scene)
    with FLOAT64.active():
        usual = engine.solve(plan.problem, range(4), FLOAT64, usual_work := Work())
        monkeypatch.setattr(engine, "COMPILED_FROM", 1)
        quick = engine.solve(plan.problem, range(4), FLOAT64, quick_work := Work())
    assert type(usual.packing) is SolvedPacking
    assert isinstance(quick.packing, fast.CompiledPacking)
    assert usual.forces is not None
    assert quick.forces is not None
    assert bits(quick.packing) == bits(usual.packing)
    assert bits(quick.forces) == bits(usual.forces)
    assert usual_work == quick_work


@pytest.mark.parametrize("side", [0, 1])
def test_forces_go_straight_down_below_a_load(side: int) -> None:
    height, width = 9, 3  # layers enough for a diagonal to go round
    row = np.arange(1.0, width + 1)
    loads: list[Array | None] = [None] * (height + 1)
    loads[height] = row
    none = Loads((None,) * (height + 1), (None,) * (height + 1))
    solved = fast.deposit(
        Fraction(3, 4), whole(width, height), (np.zeros(width),) * (height + 1), FLOAT64
    )
    given = Loads(none.plus, tuple(loads)) if side else Loads(tuple(loads), none.minus)
    found = fast.sweep_down(solved, solved.region.rows, given)
    ordered = found.ordered.minus if side else found.ordered.plus
    for j in range(1, height + 1):
        for q in range(width):  # what bears on (i, j) came down from (i ± (M − j), M)
            i = 2 * q + j % 2 + (height - j) * (-1 if side else 1)
            assert ordered[j][q] == row[(i - height % 2) // 2 % width]


def test_without_numba_the_engine_takes_the_numpy_sweeps(monkeypatch: pytest.MonkeyPatch) -> None:
    plan = planned(basic(6, 14))
    monkeypatch.setattr(engine, "COMPILED_FROM", 1)
    monkeypatch.delattr("force_diffusion.numeric.mechanics.compiled")
    monkeypatch.setitem(sys.modules, "force_diffusion.numeric.mechanics.compiled", None)
    with FLOAT64.active():
        assert type(engine.solve(plan.problem, [0], FLOAT64, Work()).packing) is SolvedPacking


def test_the_compiled_code_fuses_no_product_with_a_sum() -> None:
    def sample(own: Array, result: Array) -> None:
        for q in range(own.size):
            result[q] = own[q] * own[q] + own[q]

    import numba

    compiled = numba.njit(error_model="numpy", nogil=True)(sample)
    u = 1 + 2.0**-52 * np.arange(1.0, 65.0)
    compiled(u, found := np.empty_like(u))
    assert found.tobytes() == (u * u + u).tobytes()


def test_products_of_words_are_exact_whatever_the_processor() -> None:
    """Wide registers have them made of halves, others as one product of 128 bits."""
    whole_product = intrinsic(drawing._product_code)

    @numba.njit
    def by_one(a: Any, b: Any) -> Any:
        return whole_product(a, b)

    ends = [0, 1, 2**32 - 1, 2**32, 2**63, 2**64 - 1]
    drawn = np.random.default_rng(3).integers(0, 2**64, (200, 2), dtype=np.uint64, endpoint=False)
    for a, b in [(a, b) for a in ends for b in ends] + [(int(a), int(b)) for a, b in drawn]:
        for made in (by_one, drawing._product_of_halves):
            high, low = made(np.uint64(a), np.uint64(b))
            assert (int(high) << 64) + int(low) == a * b
