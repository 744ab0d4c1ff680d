"""The compiled loops against the same source on NumPy: every bit, every error, every name."""

import platform
import re
import sys
from collections import Counter
from collections.abc import Sequence
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from force_diffusion.numeric.arithmetic.carried import CARRYING, Carried
from force_diffusion.numeric.arithmetic.systems import FLOAT64, Array
from force_diffusion.numeric.disorder.radii import DrawnRadii, RadiusError, rows_of
from force_diffusion.numeric.lattice.branch import Branch, Contact, per_direction
from force_diffusion.numeric.lattice.layers import Region, Rows, standing_on_base, whole
from force_diffusion.numeric.lattice.regions import contact_rows, downward_cone, upward_cone
from force_diffusion.numeric.mechanics import engine, physicality, sweep
from force_diffusion.numeric.mechanics.engine import worth_compiling
from force_diffusion.numeric.mechanics.problem import Solved
from force_diffusion.numeric.mechanics.sweep import NotStandingError, UnbuildableError
from force_diffusion.numeric.mechanics.work import Work
from force_diffusion.numeric.run import Scene, run
from force_diffusion.numeric.scene.sections import Ask, Disorder, Load, Packing
from hypothesis import assume, given
from hypothesis import strategies as st

from tests.numeric.scenes import basic, planned

pytest.importorskip("numba")
import numba
from force_diffusion.numeric.arithmetic import compiling
from force_diffusion.numeric.disorder import compiled as drawing
from force_diffusion.numeric.mechanics import kernels, local, passes, sweeps
from numba.extending import intrinsic

# Between the directions at which beads of the ordered packing overlap, for d = 2 and 3.
PHI = st.fractions(Fraction(-32, 100), Fraction(47, 100), max_denominator=10**6)


def rows_in(region: Region, values: Array, *, carried: bool) -> list[Any]:
    """Rows of (batch, parts, beads), as the NumPy sweep has them."""
    parts = [
        np.split(values[0, part] if len(values) == 1 else values[:, part], region.starts[1:-1], -1)
        for part in range(1 + carried)
    ]
    return [Carried(*pair) for pair in zip(*parts, strict=True)] if carried else parts[0]


def raw(values: Any, layers: Sequence[int]) -> list[bytes]:
    """All bits of rows, of which some may be tuples."""
    return [
        np.ascontiguousarray(one).tobytes()
        for j in layers
        for one in (values[j] if isinstance(values[j], tuple) else [values[j]])
    ]


def outcome(function: Any, *arguments: Any) -> Any:
    """Give what a function gives; None where a bead can't rest or stand."""
    with FLOAT64.active():
        try:
            return function(*arguments)
        except (UnbuildableError, NotStandingError):
            return None


@st.composite
def regions(draw: st.DrawFn) -> tuple[Region, Rows]:
    """A whole packing of discs or spheres, or beads that decide something of a slab or strip."""
    d = draw(st.sampled_from([0, 2, 3]))
    if d:
        height, width = draw(st.integers(1, 7)), draw(st.integers(1, (33, 6)[d - 2]))
        found = whole(width ** (d - 1), height, d)
        return found, found.rows
    width = draw(st.none() | st.integers(1, 14))
    top, i = draw(st.integers(1, 8)), draw(st.integers(-9, 9))
    rows = downward_cone([(2 * i + top % 2, top)], width)
    if draw(st.booleans()):
        contact = Contact(2 * i, 0, draw(st.sampled_from(Branch)))
        rows = contact_rows(contact, upward_cone(contact.upper, top, width), width)
    return standing_on_base(rows, width), rows


@given(st.data(), PHI, regions(), st.booleans(), st.sampled_from([5e-2, 1e-5, 1e-11, 1e-300, 0.9]))
def test_every_bit_is_that_of_the_same_source_on_numpy(
    data: st.DataObject,
    phi: Fraction,
    case: tuple[Region, Rows],
    carried: bool,
    size: float,
) -> None:
    region, rows = case
    d, batch = region.dimension, data.draw(st.integers(1, 3))
    rng = np.random.default_rng(data.draw(st.integers(0, 2**32)))
    rho = rng.uniform(-1, 1, (batch, 1 + carried, region.beads)) * size
    if carried:
        rho[:, 1] *= 2.0**-54
    loaded = data.draw(st.lists(st.booleans(), min_size=len(rows), max_size=len(rows)))
    shares: list[list[Any]] = [
        [rng.uniform(-3, 3, row.count) if on else None
         for row, on in zip(rows, loaded, strict=True)] for _ in range(d)
    ]  # fmt: skip
    if carried:
        shares = [[s if s is None else Carried(s, s * 2.0**-55) for s in of] for of in shares]
    loads = per_direction([tuple(share) for share in shares])
    own = rows_in(region, rho, carried=carried)
    solved = outcome(sweep.deposit, phi, region, own, CARRYING if carried else FLOAT64)
    with FLOAT64.active():
        deposition = passes.Deposition(phi, region, carried=carried)
        block = deposition(rho)
    assert (block is None) == (solved is None)
    assume(block is not None)
    assert block is not None
    part = d + d * d
    for number, name in enumerate(("value", "error") if carried else ("value",)):
        if number and size < 1e-100:
            continue  # Dekker's product has parts that are too small for a float
        own = slice(number * part, (number + 1) * part)
        most = deposition.most[:, own]
        told = passes.told(phi, region, rho[:, number : number + 1], block[:, own], most)
        above = np.arange(part)[None, :, None] >= d  # of the base δn are no numbers
        there = np.arange(region.beads) >= above * region.rows[0].count
        sizes = np.where(there, np.abs(block[:, own, : region.beads]), 0)
        assert np.array_equal(most, sizes.max(axis=2))
        for field, lowest in (("c", 0), ("dn", 1)):
            for (_, ours), (_, theirs) in zip(
                getattr(told, field), getattr(solved, field), strict=True
            ):
                for j in range(lowest, region.top + 1):
                    mine, usual = ours[j], theirs[j]
                    if field == "c":
                        mine, usual = (mine,), (usual,)
                    for a, b in zip(mine, usual, strict=True):
                        assert np.array_equal(a, getattr(b, name) if carried else b)
    forces = outcome(sweep.sweep_down, solved, rows, loads)
    descent = passes.Descent(region, rows, loads, carried=carried)
    g = descent(block)
    assert (g is None) == (forces is None)
    if g is None or forces is None:
        return
    for a, ((_, change), (_, F)) in enumerate(zip(forces.change, forces.ordered, strict=True)):
        for j in range(descent.lowest, len(rows)):
            of = slice(descent.starts[j], descent.starts[j + 1])
            values, ordered = change[j], F[j]
            if carried:
                if size > 1e-100:
                    assert np.array_equal(g[:, d + a, of].reshape(values.error.shape), values.error)
                values, ordered = values.value, ordered.value
            assert np.array_equal(g[:, a, of].reshape(values.shape), values)
            assert np.array_equal(descent.F[a, of], ordered)


@given(PHI, regions(), st.integers(0, 2**32))
def test_gaps_are_those_of_numpy(phi: Fraction, case: tuple[Region, Rows], seed: int) -> None:
    region, _ = case
    rng = np.random.default_rng(seed)
    rho = rng.uniform(-1, 1, (2, 1, region.beads)) * 10.0 ** rng.uniform(-9, -1)
    deposition = passes.Deposition(phi, region)
    block = deposition(rho)
    assume(block is not None)
    assert block is not None
    compiled = passes.told(phi, region, rho[:, :1], block, deposition.most)
    usual = outcome(sweep.deposit, phi, region, rows_in(region, rho, carried=False), FLOAT64)
    assert physicality.gaps(compiled) == physicality.gaps(usual)


def test_the_code_on_disk_follows_each_of_its_sources(monkeypatch: pytest.MonkeyPatch) -> None:
    """Another rest of a bead, another loop, another way to compile: another file."""
    usual = kernels.source(2)
    assert usual == kernels.source(2)
    taken = local.rest

    def other(*arguments: Any, **keywords: Any) -> Any:
        found = taken(*arguments, **keywords)
        return found._replace(c=tuple(x + x for x in found.c))

    monkeypatch.setattr(local, "rest", other)
    assert kernels.source(2) != usual
    monkeypatch.undo()
    read = Path.read_text
    for name in ("loops.py", Path(compiling.__file__).name):

        def changed(path: Path, *a: Any, name: str = name, **k: Any) -> str:
            return read(path, *a, **k) + ("# new" if path.name == name else "")

        monkeypatch.setattr(Path, "read_text", changed)
        assert kernels.source(2) != usual
        monkeypatch.undo()


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
    layers = Rows([2 * i + j % 2 for j, (i, _) in enumerate(rows)], [n for _, n in rows])
    usual = np.concatenate(
        [
            source.row(layer, realisations, FLOAT64).reshape(len(realisations), layer.count)
            for layer in layers
        ],
        axis=-1,
    )
    rho = sweeps.Drawing(source, Region(width, layers))(realisations)
    assert rho.tobytes() == usual.tobytes()
    both = sweeps.Drawing(source, Region(width, layers), carried=True)(realisations)
    exact: list[Any] = [source.row(layer, realisations, CARRYING) for layer in layers]
    for part, name in enumerate(("value", "error")):
        rows_of_part = [getattr(row, name).reshape(len(realisations), -1) for row in exact]
        assert both[:, part].tobytes() == np.concatenate(rows_of_part, axis=-1).tobytes()


def test_a_drawn_radius_that_is_not_positive_is_named() -> None:
    source = DrawnRadii("normal", Fraction(1, 3), 5, 40)
    region = whole(40, 9)
    with pytest.raises(RadiusError) as usual:
        rows_of(source, region.rows, [3, 4], FLOAT64)
    with pytest.raises(RadiusError, match=re.escape(str(usual.value))):
        sweeps.Drawing(source, region)([3, 4])


def test_memory_that_is_used_again_changes_no_bit(monkeypatch: pytest.MonkeyPatch) -> None:
    plan = planned(basic(6, 9, quantity="contact_forces", realisations=7))
    monkeypatch.setattr(engine, "COMPILED_FROM", 1)
    monkeypatch.setattr(engine, "TOGETHER", 3 * plan.problem.region.beads)

    def bits(solved: Solved) -> list[bytes]:
        assert solved.packing is not None
        assert solved.forces is not None
        found = [*solved.forces.change, *solved.packing.c]
        return [one for _, rows in found for one in raw(rows, range(1, 7))]

    for carried in (False, True):
        with FLOAT64.active():
            found = [
                bits(solved)
                for solved, _ in engine.packings(plan.problem, range(7), FLOAT64, carried=carried)
            ]
            for at, one in zip((0, 3, 6), found, strict=True):
                some = range(at, min(at + 3, 7))
                alone = engine.solve(plan.problem, some, FLOAT64, Work(), carried=carried)
                assert one == bits(alone)


@pytest.mark.parametrize("carried", [False, True])
def test_the_engine_takes_the_compiled_sweeps_for_much_work(
    monkeypatch: pytest.MonkeyPatch, carried: bool
) -> None:
    scene = basic(6, 9, quantity="contact_forces", realisations=4)
    scene["packing"]["allow_images"] = True
    plan = planned(scene)
    monkeypatch.setattr(kernels, "LOADED", set())
    monkeypatch.setattr(engine, "_by_numpy", Counter())
    with FLOAT64.active():
        usual = engine.solve(plan.problem, range(4), FLOAT64, usual_work := Work(), carried=carried)
        monkeypatch.setattr(engine, "COMPILED_FROM", 1)
        quick = engine.solve(plan.problem, range(4), FLOAT64, quick_work := Work(), carried=carried)
    for one, memory in ((usual, False), (quick, True)):
        assert one.packing is not None
        assert (one.packing.memory is not None) == memory
    assert usual.forces is not None
    assert quick.forces is not None
    for (_, a), (_, b) in zip(usual.forces.change, quick.forces.change, strict=True):
        assert raw(a, range(1, 7)) == raw(b, range(1, 7))
    assert usual_work == quick_work


@pytest.mark.parametrize("carried", [False, True])
def test_small_packings_load_the_compiler_once_they_were_many(
    monkeypatch: pytest.MonkeyPatch, carried: bool
) -> None:
    plan = planned(basic(8, 16, quantity="contact_forces"))
    monkeypatch.setattr(engine, "worth_compiling", worth_compiling)
    monkeypatch.setattr(kernels, "LOADED", set())
    monkeypatch.setattr(engine, "_by_numpy", Counter())
    once = engine._work(plan.problem.region, 1, 1, carried=carried)
    monkeypatch.setattr(engine, "COMPILED_FROM", 3 * once)
    compiled = []
    with FLOAT64.active():
        for _ in range(5):
            found = engine.solve(plan.problem, [0], FLOAT64, Work(), carried=carried).packing
            assert found is not None
            compiled.append(found.memory is not None)
    assert compiled == [False, False, True, True, True]


@pytest.mark.parametrize("side", [0, 1])
def test_forces_go_straight_down_below_a_load(side: int) -> None:
    height, width = 9, 3  # layers enough for a diagonal to go round
    row = np.arange(1.0, width + 1)
    none: tuple[Array | None, ...] = (None,) * (height + 1)
    on = (*none[:-1], row)
    region = whole(width, height)
    loads = per_direction([none, on] if side else [on, none])
    found = sweep.straight_down(region.rows, region, loads, FLOAT64)
    for j in range(1, height + 1):
        for q in range(width):  # what bears on (i, j) came down from (i ± (M − j), M)
            i = 2 * q + j % 2 + (height - j) * (-1 if side else 1)
            assert found[j][side][q] == row[(i - height % 2) // 2 % width]


def test_without_numba_the_engine_takes_the_numpy_sweeps(monkeypatch: pytest.MonkeyPatch) -> None:
    plan = planned(basic(6, 14))
    monkeypatch.setattr(engine, "COMPILED_FROM", 1)
    monkeypatch.delattr("force_diffusion.numeric.mechanics.sweeps")
    monkeypatch.setitem(sys.modules, "force_diffusion.numeric.mechanics.sweeps", None)
    with FLOAT64.active():
        packing = engine.solve(plan.problem, [0], FLOAT64, Work()).packing
    assert packing is not None
    assert packing.memory is None


@pytest.mark.long(sample=1)
@pytest.mark.skipif(platform.machine() not in {"x86_64", "AMD64"}, reason="other instructions")
@pytest.mark.parametrize("dimension", [2, 3])
def test_several_beads_are_taken_at_a_time(dimension: int) -> None:
    """LLVM stops doing so without a word where it has to compare too many addresses."""
    scope = vars(sys.modules[kernels.kernels(dimension).deposit.__module__])
    values, run = numba.float64[:, ::1], numba.int64[::1]
    loops = [("rest", 2, "sqrtpd"), ("balance", 4, "divpd")]
    loops += [("rest_errors", 2, "divpd"), ("balance_errors", 3, "divpd")]
    for name, arrays, packed in loops:
        made = numba.njit(error_model="numpy")(scope[name].py_func)
        made.compile((values,) * arrays + (run, numba.float64[::1]))
        (assembly,) = made.inspect_asm().values()
        assert packed in assembly, name


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


@pytest.mark.parametrize(
    ("dimension", "quantity"),
    [
        (d, q)
        for d in (2, 3)
        for q in ("contact_forces", "positions", "profile", "histogram", "response")
    ],
)
def test_an_answer_stays_when_the_next_one_takes_its_memory(
    dimension: int, quantity: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Memory stays for the next packing of its shape; what the last one was answered does, too."""
    monkeypatch.setattr(engine, "COMPILED_FROM", 1)
    at = [1, 5] if dimension == 2 else [1, 2, 5]
    load = Load(kind="point", at=at) if quantity == "response" else Load()
    blocks = []
    real = passes.Deposition.__call__

    def seen(self: passes.Deposition, *arguments: Any) -> Any:
        blocks.append(self.block)
        return real(self, *arguments)

    monkeypatch.setattr(passes.Deposition, "__call__", seen)

    def made(seed: int) -> dict[str, Any]:
        return Scene(
            packing=Packing(height=5, width=8, dimension=dimension),
            disorder=Disorder(kind="uniform", relative_std=1e-3, seed=seed),
            load=load,
            ask=Ask(quantity=quantity),
        ).run().arrays  # fmt: skip

    first = made(1)
    copies = {name: values.copy() for name, values in first.items()}
    second = made(2)
    assert blocks[-1].size  # it was used again
    assert all(first[name].tobytes() == copies[name].tobytes() for name in first)
    small = "count" if quantity == "histogram" else list(first)[-1]
    assert not np.array_equal(first[small], second[small], equal_nan=True)


@pytest.mark.parametrize("quantity", ["profile", "contact_forces", "histogram"])
def test_an_answer_is_the_same_whether_the_compiler_is_loaded_or_not(
    quantity: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    sections = basic(5, 7, quantity=quantity, realisations=5)
    sections["packing"]["allow_images"] = True
    sections["disorder"] |= {"relative_std": "=6e-2", "seed": 814}
    found = []
    for most in (10**12, 1):
        monkeypatch.setattr(engine, "COMPILED_FROM", most)
        found.append(run(planned(sections)))
    assert found[0].decimals() == found[1].decimals()
