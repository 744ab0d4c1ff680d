"""The compiled loops against the same source on NumPy, and their machine code on disk."""

import sys
from contextlib import nullcontext
from fractions import Fraction
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from force_diffusion.numeric.arithmetic import compiling
from force_diffusion.numeric.arithmetic.carried import CARRYING, Carried
from force_diffusion.numeric.arithmetic.systems import FLOAT64, Balls, as_floats
from force_diffusion.numeric.disorder import drawing
from force_diffusion.numeric.disorder.radii import DrawnRadii, RadiusError
from force_diffusion.numeric.lattice.branch import Contact, directions
from force_diffusion.numeric.lattice.layers import Region, Rows, standing_on_base, whole
from force_diffusion.numeric.lattice.regions import contact_rows, downward_cone, upward_cone
from force_diffusion.numeric.mechanics import local, loops, sweep
from force_diffusion.numeric.mechanics.physicality import Physicality
from hypothesis import assume, given
from hypothesis import strategies as st

from tests.numeric.scenes import by_numpy, question

pytestmark = pytest.mark.skipif(find_spec("numba") is None, reason="without numba")

# Between the directions at which beads of the ordered packing overlap.
PHI = st.fractions(Fraction(-32, 100), Fraction(47, 100), max_denominator=10**6)


@st.composite
def regions(draw: st.DrawFn) -> tuple[Region, Rows]:
    """A whole packing, or the beads on which a contact of a slab or strip depends."""
    if draw(st.booleans()):
        region = whole(draw(st.integers(1, 33)), draw(st.integers(1, 7)))
        return region, region.rows
    width = draw(st.none() | st.integers(1, 14))
    top, i = draw(st.integers(1, 8)), draw(st.integers(-9, 9))
    rows = downward_cone([(2 * i + top % 2, top)], width)
    if draw(st.booleans()):
        contact = Contact(2 * i, 0, draw(st.sampled_from(directions(2))))
        rows = contact_rows(contact, upward_cone(contact.upper, top, width), width)
    return standing_on_base(rows, width), rows


def solved(
    phi: Fraction, region: Region, rho: Any, rows: Rows, F: Any, system: Any
) -> sweep.Solved | None:
    """A packing and its forces; None where a bead can't rest or stand."""
    with system.active():
        try:
            return sweep.sweep_down(sweep.deposit(phi, region, rho, system), rows, F)
        except (sweep.UnbuildableError, sweep.NotStandingError):
            return None


@given(
    PHI, regions(), st.integers(0, 2**32), st.integers(1, 3), st.sampled_from([1e-2, 1e-5, 1e-9])
)
def test_loops_and_numpy_agree_and_carried_errors_are_those_of_balls(phi, case, seed, batch, size):
    region, rows = case
    rng = np.random.default_rng(seed)
    rho = rng.uniform(-1, 1, (batch, region.beads)) * size
    F = rng.uniform(-3, 3, (2, int(rows.starts_above[-1])))
    usual = solved(phi, region, rho, rows, F, FLOAT64)
    carried = solved(
        phi, region, CARRYING.from_floats(rho), rows, CARRYING.from_floats(F), CARRYING
    )
    with by_numpy():
        same = solved(phi, region, rho, rows, F, FLOAT64)
    assert (usual is None) == (same is None) == (carried is None)
    assume(usual is not None)
    assert usual is not None
    assert same is not None
    assert carried is not None
    for name in ("block", "g"):  # LLVM and NumPy round alike
        assert getattr(usual, name).tobytes() == getattr(same, name).tobytes()
    first, again = (Physicality(looks_at=range(len(rho))) for _ in range(2))
    first.look_at_gaps(usual)
    with by_numpy():
        again.look_at_gaps(usual)
    assert again == first
    balls = Balls(200)
    with balls.active():
        exact = solved(phi, region, balls.from_floats(rho[:1]), rows, balls.from_floats(F), balls)
        assert exact is not None
        for numbers, true in ((carried.block, exact.block), (carried.g, exact.g)):
            off = as_floats(true[0] - balls.from_floats(numbers.value[0]))
            # what is left out: products of errors, and their own roundings
            largest = np.abs(numbers.value[0]).max(initial=0)
            room = 1e-12 * np.abs(off).max(initial=0) + 2.0**-90 * largest
            assert np.abs(numbers.error[0] - off).max(initial=0) <= room


def test_machine_code_on_disk_follows_each_of_its_sources(tmp_path, monkeypatch):
    """Another rest of a bead, loop, way to compile, rule for errors, or release of numba."""
    used = [local.rest, loops.deposit]
    usual = compiling.stamp(used)
    assert usual == compiling.stamp(used)
    read = Path.read_bytes
    modules = (local, loops, compiling, sys.modules[Carried.__module__])
    sources = [Path(str(module.__file__)) for module in modules]
    release = Path(str(find_spec("numba").origin)).with_name("_version.py")
    for own in [*sources, release]:

        def changed(path: Path, own: Path = own) -> bytes:
            return read(path) + (b"# new" if path == own else b"")

        monkeypatch.setattr(Path, "read_bytes", changed)
        assert compiling.stamp(used) != usual
        monkeypatch.undo()


def _twice(p: Any, n: Any) -> int:
    for i in range(n):
        p[i] = p[i] * 2.0
    return int(n)


@pytest.mark.long
def test_what_was_compiled_is_taken_from_disk(tmp_path, monkeypatch):
    monkeypatch.setattr(compiling, "CODES", tmp_path / "codes")
    for made in (1, 1):
        functions = compiling.compiled([(_twice, ("float", "number"))], [])
        assert functions is not None
        values = np.arange(3.0)
        assert functions[0](values.ctypes.data, 3) == 3
        assert values.tolist() == [0, 2, 4]
        assert len(list((tmp_path / "codes").iterdir())) == made
        monkeypatch.setattr(compiling, "_made", None)  # nothing is compiled again


@given(
    st.sampled_from(["uniform", "normal", "two-point"]),
    st.integers(0, 2**63 - 1),
    st.lists(st.integers(0, 2**62), min_size=1, max_size=3),
    st.lists(st.tuples(st.integers(-40, 40), st.integers(0, 40)), min_size=1, max_size=4),
    st.none() | st.integers(40, 50),
)
def test_every_bit_of_a_drawn_radius_is_that_of_numpys(kind, seed, realisations, rows, width):
    source = DrawnRadii(kind, Fraction(1, 10**6), seed, width)
    layers = Rows([2 * i + j % 2 for j, (i, _) in enumerate(rows)], [n for _, n in rows])
    values = source.of(layers, realisations, FLOAT64)
    with by_numpy():
        assert source.of(layers, realisations, FLOAT64).tobytes() == values.tobytes()
    parts = [
        source.of(Rows([layer.first], [layer.count], layer.j), realisations, FLOAT64)
        for layer in layers
    ]
    assert np.concatenate(parts, axis=1).tobytes() == values.tobytes()
    if width is not None:
        around = Rows(layers.firsts + 2 * width, layers.counts)
        assert source.of(around, realisations, FLOAT64).tobytes() == values.tobytes()


@pytest.mark.parametrize("dimension", [2, 3])
def test_a_drawn_radius_that_is_not_positive_is_named_alike(dimension):
    """Of spheres as (p, q, j), and not by the column in the row of W² beads."""
    asked = question("profile", 6, 13, dimension=dimension, spacing=2.9, kind="normal", std=0.45)
    for way in (nullcontext, by_numpy):
        with way(), pytest.raises(RadiusError, match="the drawn radius is -") as error:
            asked.run()
        bead = str(error.value).split(":")[0]
        assert bead.count(",") == dimension - 1


def test_logarithms_and_cosines_are_right_to_a_few_units_in_the_last_place():
    numbers = np.random.default_rng(5).random(2000)
    for x in (numbers, numbers * 2.0**-50, 1 - numbers * 2.0**-30):
        assert drawing.logarithm(x) == pytest.approx(np.log(x), rel=1e-15, abs=0)
    assert drawing.cosine_of_turn(numbers) == pytest.approx(np.cos(2 * np.pi * numbers), abs=2e-15)


def test_without_numba_numpy_sweeps(monkeypatch):
    monkeypatch.setitem(sys.modules, "llvmlite", None)
    assert compiling.compiled([(_twice, ("float", "number"))], []) is None
