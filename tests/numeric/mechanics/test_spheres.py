"""Three dimensions: distances, a dense balance of all forces, and the sweep of two dimensions."""

from collections.abc import Iterator
from fractions import Fraction
from itertools import product
from pathlib import Path
from typing import Any

import flint
import mpmath
import numpy as np
import pytest
from force_diffusion.numeric.arithmetic.errors import UndecidedError
from force_diffusion.numeric.arithmetic.systems import (
    FLOAT64,
    Array,
    Balls,
    BigFloat,
    NumberSystem,
    as_floats,
)
from force_diffusion.numeric.lattice.layers import Region, whole
from force_diffusion.numeric.mechanics.engine import packings
from force_diffusion.numeric.mechanics.physicality import by_distance, gaps
from force_diffusion.numeric.mechanics.sweep import (
    NotStandingError,
    SolvedPacking,
    UnbuildableError,
    deposit,
    sweep_down,
)

import force_diffusion as fd
from tests.numeric.mechanics.any_dimension import force_weights, together
from tests.numeric.spheres import columns, drawn, scene

STEPS = ((1, 0), (0, 1), (0, 0))  # of (p, q), one layer up along each axis


def spheres(rho: list[Array]) -> tuple[Region, Array]:
    """The region of layers (W, W), and δr/r of one packing."""
    region = whole(rho[0].size, len(rho) - 1, dimension=3)
    return region, np.stack(rho).reshape(1, -1)


def from_above(region: Region, share: Any) -> Array:
    """Ordered forces of a load on the highest layer, the same along all axes."""
    beads = region.beads - region.rows[0].count
    return np.full((region.dimension, beads), share)


class Lattice:
    """Positions that a scene answers with, continued periodically; 40 digits, as drawn radii."""

    def __init__(self, asked: fd.Scene, outcome: fd.Outcome) -> None:
        assert asked.packing.width is not None
        self.width, self.height = asked.packing.width, asked.packing.height
        self.at = {
            (p, q, j): tuple(mpmath.mpf(str(v.mid().str(60, radius=False))) for v in place)
            for p, q, j, *place in columns(outcome, "p", "q", "j", "x", "y", "z")
        }
        s = mpmath.mpf("2.9") * self.width
        self.periods = (s, mpmath.mpf(0)), (s / 2, s * mpmath.sqrt(3) / 2)

    def place(self, p: int, q: int, j: int) -> tuple[Any, Any, Any]:
        """Where a bead of the infinite lattice is; a step −e_3 keeps p and q."""
        (a, b), (c, d) = self.periods
        (m, p), (n, q) = divmod(p, self.width), divmod(q, self.width)
        x, y, z = self.at[p, q, j]
        return x + m * a + n * c, y + m * b + n * d, z

    def apart(self, lower: tuple[int, int, int], upper: tuple[int, int, int]) -> Any:
        return mpmath.matrix(
            [b - a for a, b in zip(self.place(*lower), self.place(*upper), strict=True)]
        )


@pytest.fixture
def digits() -> Iterator[None]:
    with mpmath.workdps(60):
        yield


def contacts(width: int, height: int) -> Iterator[tuple[tuple[int, int, int], int]]:
    """Lower beads and axes of all contacts."""
    for j, p, q, axis in product(range(height), range(width), range(width), range(3)):
        yield (p, q, j), axis


def upper(lower: tuple[int, int, int], axis: int) -> tuple[int, int, int]:
    p, q, j = lower
    return p + STEPS[axis][0], q + STEPS[axis][1], j + 1


@pytest.mark.usefixtures("digits")
def test_beads_touch_their_three_supports() -> None:
    asked = scene("positions", height=3, width=2)
    lattice = Lattice(asked, asked.run(tolerance="1e-40"))
    radii = drawn(asked)
    for lower, axis in contacts(2, 3):
        high = upper(lower, axis)
        d = lattice.apart(lower, high)
        reach = 2 + radii[lower] + radii[high[0] % 2, high[1] % 2, high[2]]
        reach = mpmath.mpf(reach.numerator) / reach.denominator
        # the answer has 40 digits of the largest displacement, of about 0.1
        assert abs(mpmath.norm(d) - reach) < mpmath.mpf(10) ** -40


@pytest.mark.usefixtures("digits")
@pytest.mark.parametrize(
    "load", [fd.SurfaceLoad(), fd.BulkLoad(), fd.PointLoad(at=(1, 2, 2)),
             fd.BulkLoad(angle_deg=20),
             fd.PointLoad(at=(1, 2, 2), angle_deg=-70), fd.Load(kind="file", file="loads.csv")],
    ids=["surface", "bulk", "point", "bulk, 20°", "point, −70°", "file"],
)  # fmt: skip
def test_forces_solve_the_balance_of_all_beads_at_once(load: fd.Load, tmp_path: Path) -> None:
    """A dense linear system, three equations a bead, of the positions alone."""
    width, height = 3, 2
    asked = scene("positions", height=height, width=width)
    lattice = Lattice(asked, asked.run(tolerance="1e-40"))
    numbers = {contact: n for n, contact in enumerate(contacts(width, height))}
    A, b = mpmath.zeros(len(numbers)), mpmath.zeros(len(numbers), 1)
    beads = [(p, q, j) for j in (1, 2) for p in range(width) for q in range(width)]
    row = {bead: 3 * n for n, bead in enumerate(beads)}
    for (lower, axis), column in numbers.items():
        d = lattice.apart(lower, upper(lower, axis))
        d = d / mpmath.norm(d)
        p, q, j = upper(lower, axis)
        for bead, sign in (((p % width, q % width, j), 1), (lower, -1)):
            for k in range(3 if bead in row else 0):
                A[row[bead] + k, column] += sign * d[k]
    listed = {(0, 1, 2): (0.5, -0.25, -1), (2, 2, 1): (-1, 2, 0.125)}  # doubles, exact
    lines = [",".join(map(str, (*bead, *force))) for bead, force in listed.items()]
    (tmp_path / "loads.csv").write_text("p,q,j,fx,fy,fz\n" + "\n".join(lines))
    angle = mpmath.mpf(int(load.angle_deg)) * mpmath.pi / 180
    for bead in beads:
        pressed = load.kind == "bulk" or (load.kind == "surface" and bead[2] == height)
        if load.kind == "point":
            pressed = bead == tuple(load.at)
        b[row[bead]], b[row[bead] + 2] = -pressed * mpmath.sin(angle), pressed * mpmath.cos(angle)
        for k in range(3 if load.kind == "file" else 0):
            b[row[bead] + k] = -listed.get(bead, (0, 0, 0))[k]
    solved = mpmath.lu_solve(A, b)
    asked = scene("contact_forces", height=height, width=width, load=load)
    outcome = asked.model_copy(update={"folder": tmp_path}).run(tolerance="1e-38")
    found = dict.fromkeys(numbers, mpmath.mpf(0))
    for p, q, j, branch, force in columns(outcome, "p", "q", "j", "branch", "force"):
        found[(p, q, j), int(branch) - 1] = mpmath.mpf(force.mid().str(50, radius=False))
    for contact, column in numbers.items():
        assert abs(found[contact] - solved[column]) < mpmath.mpf(10) ** -36


def random_radii(dimension: int, height: int, width: int, size: float) -> list[Array]:
    rng = np.random.default_rng(7)
    return [size * rng.uniform(-1, 1, (width,) * (dimension - 1)) for _ in range(height + 1)]


@pytest.mark.parametrize("linear", [False, True])
def test_number_systems_agree(linear: bool) -> None:
    rho = random_radii(3, 5, 4, 1e-3)
    phi = Fraction(1, 5)

    def solved(system: NumberSystem) -> Array:
        with system.active():
            region, rows = spheres(rho)
            placed = deposit(phi, region, system.from_floats(rows), system, linear=linear)
            F = from_above(region, system.number(Fraction(1)))
            forces = sweep_down(placed, region.rows, F, linear=linear)
            return np.stack([change[1] for _, change in forces.change])

    enclosed = solved(Balls(200))
    assert max(float(ball.rad()) for ball in enclosed.reshape(-1)) < 1e-50
    for system, room in ((FLOAT64, 2.0**-46), (BigFloat(40), 1e-38)):
        near = solved(system)
        off = [abs(float(mpmath.mpf(str(a)) - mpmath.mpf(b.mid().str(45, radius=False))))
               for a, b in zip(near.reshape(-1), enclosed.reshape(-1), strict=True)]  # fmt: skip
        assert max(off) < room * float(np.abs(as_floats(enclosed)).max())


def test_first_order_is_the_weights_of_any_dimension() -> None:
    """Fractions by another way: force_weights names beads of Z³, by their own numbers."""
    M, W, phi = 3, 5, 1 - Fraction("2.9") ** 2 / 8
    asked = scene(height=M, width=W, geometry="first-order")
    outcome, radii = asked.run(tolerance="1e-30"), drawn(asked)
    unit = 1 / mpmath.sqrt(float(3 * (1 + 2 * phi)))
    change = {
        (p, q, j, branch): float(g) / unit
        for p, q, j, branch, g in columns(outcome, "p", "q", "j", "branch", "change")
    }
    for j in range(M):
        weights = together(force_weights(3, M, j, phi))
        # its contact begins at (j, 0, 0), along the first axis: p = j, q = 0
        stated = sum(w * radii[a % W, b % W, a + b + c] for (a, b, c), w in weights.items())
        assert change[j % W, 0, j, "1"] == pytest.approx(float(stated), rel=1e-14)


def test_small_disorder_is_first_order() -> None:
    exact, first = (
        scene(height=3, width=4, std=1e-30, geometry=g).run(tolerance="1e-29")
        for g in ("exact", "first-order")
    )
    for a, b in zip(exact.arrays["change"], first.arrays["change"], strict=True):
        assert abs(float((a - b) / b)) < 1e-26  # second order, 1e-30, over the smallest change


@pytest.mark.usefixtures("digits")
def test_the_smallest_gap_is_that_of_all_pairs() -> None:
    asked = scene("positions", height=3, width=4, std=5e-2)
    outcome = asked.run(tolerance="1e-40")
    lattice, radii = Lattice(asked, outcome), drawn(asked)
    physical = outcome.physical
    assert physical is not None
    touching = {(lower, upper(lower, axis)) for lower, axis in contacts(4, 3)}
    least = mpmath.inf
    for a in product(range(4), range(4), range(4)):
        for dp, dq, dj in product(range(-3, 4), range(-3, 4), range(4)):
            b = a[0] + dp, a[1] + dq, a[2] + dj
            if b == a or b[2] > 3 or (a, b) in touching:
                continue
            reach = 2 + float(radii[a] + radii[b[0] % 4, b[1] % 4, b[2]])
            gap = mpmath.norm(lattice.apart(a, b)) - reach
            if gap < least:
                least, between = gap, {a, (b[0] % 4, b[1] % 4, b[2])}
    assert physical.smallest_gap == pytest.approx(float(least), abs=1e-14)
    assert physical.between is not None
    assert set(physical.between) == between


def test_gaps_of_touching_beads_are_told_apart() -> None:
    """At s = 2r beads of a layer touch: no gap, to the last place."""
    region, rho = spheres([np.zeros((3, 3))] * 2)
    with FLOAT64.active():
        found = gaps(deposit(Fraction(1, 2), region, rho, FLOAT64))
    assert found.smallest == 0
    # three pairs a bead, in each of two layers
    assert (found.overlaps, found.undecided) == (0, 3 * 9 * 2)


@pytest.mark.parametrize(("dimension", "phi"), [(2, Fraction(-2, 5)), (3, Fraction(-3, 10))])
def test_pairs_come_by_distance_each_once(dimension: int, phi: Fraction) -> None:
    found = [pair for pair, _ in zip(by_distance(dimension, float(phi)), range(400), strict=False)]
    assert [distance for distance, _ in found] == sorted(distance for distance, _ in found)
    steps = {one for _, one in found}
    assert len(steps) == len(found)
    assert not steps & {tuple(-s for s in one) for one in steps}
    last = found[-1][0]
    for one in product(range(-5, 6), repeat=dimension):
        square = 4 * (sum(s * s for s in one) * (1 - phi) + sum(one) ** 2 * phi)
        contact = sum(map(abs, one)) == 1
        if any(one) and not contact and float(square) ** 0.5 < last - 1e-9:
            assert one in steps or tuple(-s for s in one) in steps


def test_a_support_that_is_too_large_is_named() -> None:
    rho = [np.zeros((4, 4)), np.zeros((4, 4))]
    rho[0][2, 1] = 6.0
    with FLOAT64.active(), pytest.raises(UnbuildableError) as raised:
        deposit(Fraction(1, 5), *spheres(rho), FLOAT64)
    # it holds up (2, 1, 1), (3, 1, 1) and (2, 2, 1): the first in order is named
    assert raised.value.site == (2, 1, 1)


def test_realisations_solved_together_are_those_solved_alone() -> None:
    problem = scene("profile", height=3, width=4, realisations=5).explain().problem
    with FLOAT64.active():
        ((batch, _),) = packings(problem, range(5), FLOAT64)
        for k in range(5):
            ((alone, _),) = packings(problem, [k], FLOAT64)
            one = batch.realisation(k)
            assert alone.forces is not None
            assert one.forces is not None
            for axis, rows in alone.forces.change:
                for j in range(1, 4):
                    assert (rows[j] == one.forces.change[axis][j]).all()


@pytest.mark.parametrize(
    "rho",
    [
        [[[0.7, 0.1], [0.2, 0.2]], [[2.0, 0.9], [1.1, 0.1]], [[1.1, -0.5], [-0.7, 1.6]]],
        [[[0.8, 1.3], [1.2, -0.8]], [[0.7, 1.7], [1.4, 1.0]], [[0.0, -0.4], [0.5, 1.8]]],
    ],
)
def test_supports_that_lie_too_steeply_are_named(rho: list[list[list[float]]]) -> None:
    """In the first their plane is steeper than a base vector, in the second two change places."""
    with FLOAT64.active(), pytest.raises(UnbuildableError, match="steeper") as raised:
        deposit(Fraction(1, 5), *spheres([np.array(row) for row in rho]), FLOAT64)
    assert raised.value.site[2] == 2


def test_contacts_in_one_plane_hold_nothing_up() -> None:
    """The first contact of bead (1, 0, 1) is turned onto the second."""
    block = np.zeros((1, 12, 8))
    block[0, 3:5, 6] = -1, 1
    region, nothing = spheres([np.zeros((2, 2))] * 2)
    placed = SolvedPacking(Fraction(1, 5), FLOAT64, region, nothing, block)
    with FLOAT64.active(), pytest.raises(NotStandingError, match=r"\(1, 0, 1\).*one plane"):
        sweep_down(placed, region.rows, from_above(region, 1.0))


@pytest.mark.parametrize("layer", [0, 1])
def test_a_radius_below_zero_is_named_in_any_layer(layer: int) -> None:
    rho = [np.zeros((2, 2)), np.zeros((2, 2))]
    rho[layer][0, 1] = -1.5
    with FLOAT64.active(), pytest.raises(UnbuildableError, match="not a positive number") as raised:
        deposit(Fraction(1, 5), *spheres(rho), FLOAT64)
    assert raised.value.site == (0, 1, layer)


def test_what_balls_leave_open_is_undecided() -> None:
    system = Balls(60)
    with system.active():
        rho = [system.zeros(2, 2), system.zeros(2, 2)]
        rho[0][0, 1] = flint.arb(3, 3)  # a support of any size from r to 7 r
        with pytest.raises(UndecidedError, match="layer 1"):
            deposit(Fraction(1, 5), *spheres(rho), system)
