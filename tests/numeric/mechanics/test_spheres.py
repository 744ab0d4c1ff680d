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
    LONGDOUBLE,
    Array,
    Balls,
    BigFloat,
    NumberSystem,
    as_floats,
    from_floats,
    zeros,
)
from force_diffusion.numeric.mechanics.any_dimension import force_weights, together
from force_diffusion.numeric.mechanics.engine import packings
from force_diffusion.numeric.mechanics.forces import NotStandingError
from force_diffusion.numeric.mechanics.packing import UnbuildableError
from force_diffusion.numeric.mechanics.spheres import (
    Placed,
    along,
    bear,
    deposit,
    gaps,
    metric,
    near_pairs,
)

import force_diffusion as fd

STEPS = ((1, 0), (0, 1), (0, 0))  # of (p, q), one layer up along each axis


def scene(
    quantity: str = "contact_forces",
    *,
    height: int = 2,
    width: int = 3,
    std: float = 1e-2,
    load: fd.Load | None = None,
    geometry: Any = "exact",
    **ask: Any,
) -> fd.Scene:
    return fd.Scene(
        packing=fd.Packing(
            height=height, width=width, dimension=3, spacing=2.9, allow_images=width <= height
        ),
        disorder=fd.Disorder(kind="uniform", relative_std=std, seed=5),
        load=load or fd.SurfaceLoad(),
        effects=fd.Effects(geometry=geometry),
        ask=fd.Ask(quantity=quantity, **ask),  # type: ignore[arg-type]
    )


def columns(outcome: fd.Outcome, *names: str) -> Iterator[tuple[Any, ...]]:
    return zip(*(outcome.arrays[name].tolist() for name in names), strict=True)


def drawn(asked: fd.Scene) -> dict[tuple[int, int, int], Fraction]:
    """δr/r of every bead, exact."""
    problem = asked.explain().problem
    assert asked.packing.width is not None
    found = {}
    for row in problem.region.rows:
        with Balls(200).active():
            values = problem.radii.row(row, [0], Balls(200))
        for column, value in enumerate(values):
            p, q = divmod(column, asked.packing.width)
            found[p, q, row.j] = Fraction(*map(int, (value.mid().fmpq().p, value.mid().fmpq().q)))
    return found


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
             fd.PointLoad(at=(0, 1, 1), pressure=0.5)],
    ids=["surface", "bulk", "point", "point and pressure"],
)  # fmt: skip
def test_forces_solve_the_balance_of_all_beads_at_once(load: fd.Load) -> None:
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
    for bead in beads:
        pressed = load.kind == "bulk" or (load.kind == "surface" and bead[2] == height)
        if load.kind == "point":
            pressed = bead == tuple(load.at)
        b[row[bead] + 2] = int(pressed)
        if load.pressure and bead[2] == height:
            b[row[bead] + 2] += mpmath.mpf(1) / 2
    solved = mpmath.lu_solve(A, b)
    outcome = scene("contact_forces", height=height, width=width, load=load).run(tolerance="1e-38")
    found = dict.fromkeys(numbers, mpmath.mpf(0))
    for p, q, j, branch, force in columns(outcome, "p", "q", "j", "branch", "force"):
        found[(p, q, j), int(branch) - 1] = mpmath.mpf(force.mid().str(50, radius=False))
    for contact, column in numbers.items():
        assert abs(found[contact] - solved[column]) < mpmath.mpf(10) ** -36


def random_radii(dimension: int, height: int, width: int, size: float) -> list[Array]:
    rng = np.random.default_rng(7)
    return [size * rng.uniform(-1, 1, (width,) * (dimension - 1)) for _ in range(height + 1)]


def test_for_two_dimensions_it_is_the_sweep_of_discs() -> None:
    """Two codes, one packing: column p here is q + ⌈j/2⌉ there."""
    M, W = 6, 9
    rho = random_radii(2, M, W, 1e-2)
    given = np.stack([np.roll(row, -((j + 1) // 2)) for j, row in enumerate(rho)])
    change = fd.solve(delta_r=given, spacing=3).change
    with FLOAT64.active():
        placed = deposit(rho, metric(2, Fraction(-1, 8), FLOAT64), FLOAT64, linear=False)
        load = np.full(W, 1 / np.sqrt(1.75))
        borne = bear(placed, [None] * M + [load], FLOAT64, linear=False)
    for j in range(1, M + 1):
        lower = [np.roll(borne.change[j][0], -1), borne.change[j][1]]
        ours = np.stack([np.roll(row, -(j // 2)) for row in lower])
        # roundings of numbers of size 0.1, a few in each of six layers
        assert np.abs(ours - change[:, j - 1]).max() < 1e-15


@pytest.mark.parametrize("linear", [False, True])
def test_number_systems_agree(linear: bool) -> None:
    rho = random_radii(3, 5, 4, 1e-3)
    phi = Fraction(1, 5)

    def solved(system: NumberSystem) -> Array:
        with system.active():
            placed = deposit([from_floats(system, r) for r in rho], metric(3, phi, system),
                             system, linear=linear)  # fmt: skip
            load = zeros(system, 4, 4) + system.number(Fraction(1))
            return bear(placed, [None] * 5 + [load], system, linear=linear).change[1]

    enclosed = solved(Balls(200))
    assert max(float(ball.rad()) for ball in enclosed.reshape(-1)) < 1e-50
    for system, room in ((FLOAT64, 2.0**-46), (LONGDOUBLE, 2.0**-46), (BigFloat(40), 1e-38)):
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


@pytest.mark.parametrize("kind", ["surface", "bulk"])
def test_the_base_bears_the_load(kind: Any) -> None:
    load = fd.Load(kind=kind, magnitude=2.5)
    found = scene("base_reactions", height=4, width=5, load=load).run().arrays
    total = 2.5 * 25 * (1 if kind == "surface" else 5)
    assert found["fz"].sum() == pytest.approx(total, rel=1e-14)
    assert abs(found["fx"].sum()) + abs(found["fy"].sum()) < 1e-13 * total
    assert abs(found["change_z"]).max() > 1e-3


def test_a_point_load_comes_down_to_the_base() -> None:
    load = fd.PointLoad(at=(1, 1, 3))
    found = scene("base_reactions", height=3, width=5, load=load).run().arrays
    forces = [found[name].sum() for name in ("fx", "fy", "fz")]
    assert np.abs(np.array(forces) - (0, 0, 1)).max() < 1e-14


def test_a_response_has_vertical_forces_that_sum_to_the_load() -> None:
    load = fd.PointLoad(at=(1, 1, 3))
    found = scene("response", height=3, width=5, load=load).run().arrays
    for j in range(3):
        assert found["vertical"][found["j"] == j].sum() == pytest.approx(1, abs=1e-14)


@pytest.mark.usefixtures("digits")
def test_the_smallest_gap_is_that_of_all_pairs() -> None:
    asked = scene("positions", height=3, width=4, std=5e-2)
    outcome = asked.run(tolerance="1e-20")
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
    rho = [np.zeros((3, 3))] * 2
    m = metric(3, Fraction(1, 2), FLOAT64)
    placed = Placed(m, rho, [np.zeros((3, 3, 3))] * 2, [])
    found = gaps(placed, Fraction(1, 2), 0, (1, -1, 0))
    assert found is not None
    assert not found.any()


@pytest.mark.parametrize(("dimension", "least"), [(2, 2.25), (3, 2.6)])
def test_pairs_that_are_not_looked_at_are_far_apart(dimension: int, least: float) -> None:
    near = set(near_pairs(dimension))
    for steps in product(range(-4, 5), repeat=dimension):
        contact = sorted(map(abs, steps)) == [0] * (dimension - 1) + [1]
        if not any(steps) or contact or near & {steps, tuple(-s for s in steps)}:
            continue
        for phi in (-1 / dimension, 0.5):  # linear in φ: extremes are at the ends
            square = sum(s * s for s in steps) * (1 - phi) + sum(steps) ** 2 * phi
            assert square > least


def test_a_support_that_is_too_large_is_named() -> None:
    rho = [np.zeros((4, 4)), np.zeros((4, 4))]
    rho[0][2, 1] = 6.0
    with FLOAT64.active(), pytest.raises(UnbuildableError) as raised:
        deposit(rho, metric(3, Fraction(1, 5), FLOAT64), FLOAT64, linear=False)
    # it holds up (2, 1, 1), (3, 1, 1) and (2, 2, 1): the first in order is named
    assert raised.value.site == (2, 1, 1)


def test_a_radius_that_is_not_positive_is_named() -> None:
    asked = scene("profile", height=2, width=3, std=0.5)
    packed = asked.model_copy(
        update={"disorder": fd.Disorder(kind="normal", relative_std=0.9, seed=1)}
    )
    with pytest.raises(fd.ForceDiffusionError, match=r"bead \(\d, \d, \d\): the drawn radius"):
        packed.run()


def test_realisations_solved_together_are_those_solved_alone() -> None:
    problem = scene("profile", height=3, width=4, realisations=5).explain().problem
    with FLOAT64.active():
        ((batch, _),) = packings(problem, range(5), FLOAT64)
        for k in range(5):
            ((alone, _),) = packings(problem, [k], FLOAT64)
            one = batch.one(k)
            assert alone.forces is not None
            assert one.forces is not None
            for axis, rows in alone.forces.change:
                for j in range(1, 4):
                    assert (rows[j] == one.forces.change[axis][j]).all()


def test_one_contact_and_one_bead_are_those_of_all() -> None:
    every = scene(height=3, width=4).run()
    for p, q, j, branch, change in columns(every, "p", "q", "j", "branch", "change"):
        if (p + 2 * q + j) % 5 == 0:
            one = scene("contact", height=3, width=4, at=(p, q, j, branch)).run()
            assert one.arrays["change"].tolist() == [change]
            assert one.rows()[0]["branch"] == branch
    beads = scene("positions", height=3, width=4).run()
    one = scene("positions", height=3, width=4, at=(3, 1, 2)).run()
    assert one.rows()[0] in beads.rows()


@pytest.mark.parametrize("quantity", ["profile", "positions", "base_reactions"])
@pytest.mark.parametrize(("geometry", "height"), [("exact", 2), ("first-order", 3)])
def test_images_are_seen_where_a_wider_packing_differs(
    quantity: str, geometry: str, height: int
) -> None:
    """Which beads matter is tried one by one; images matter where two of them are W apart."""
    M, wide = height, 4 * height + 1
    lowest = 1 if quantity == "profile" else 0
    rng = np.random.default_rng(1)
    rho = [1e-3 * rng.uniform(-1, 1, (wide, wide)) for _ in range(M + 1)]
    phi, linear = Fraction(1, 5), geometry == "first-order"

    def asked(rows: list[Array]) -> Array:
        """Rows of the answer that tell most, by what they depend on."""
        with FLOAT64.active():
            placed = deposit(rows, metric(3, phi, FLOAT64), FLOAT64, linear=linear)
            if quantity == "positions":
                return np.asarray([np.abs(placed.c[M][:, 0, 0]).sum()])
            borne = bear(placed, [None] * M + [np.ones((wide, wide))], FLOAT64, linear=linear)
            change, dn = borne.change[1], placed.dn[1]
            if lowest:
                return np.asarray(change[:, 0, 0])
            parts = [along(change[a] + np.abs(dn[a]).sum(axis=0), a, 1, 3) for a in range(3)]
            return np.asarray([np.stack(parts)[:, 0, 0].sum()])

    before = asked(rho)
    matter: list[set[tuple[int, int, int]]] = [set() for _ in before]
    for j, p, q in product(range(M + 1), range(wide), range(wide)):
        rows = [row.copy() for row in rho]
        rows[j][p, q] += 1e-4
        unwrapped = (p if p <= wide // 2 else p - wide, q if q <= wide // 2 else q - wide, j)
        for beads, off in zip(matter, np.abs(asked(rows) - before), strict=True):
            if off > 1e-15:
                beads.add(unwrapped)
    for width in range(1, 2 * M + 2):
        homes = [{(p % width, q % width, j) for p, q, j in beads} for beads in matter]
        sees = any(len(home) < len(beads) for home, beads in zip(homes, matter, strict=True))
        plan = scene(quantity, height=M, width=width, geometry=geometry).explain()
        assert plan.sees_images == sees, width


@pytest.mark.parametrize(
    ("changes", "says"),
    [
        ({"packing": {"width": None}}, "packing.width"),
        ({"packing": {"spacing": 3.3}}, "packing.spacing = 3.3: must lie strictly"),
        ({"load": {"angle_deg": 3}}, "load.angle_deg"),
        ({"load": {"kind": "point", "at": (1, 1)}}, r"load.at.*\[p, q, l\]"),
        ({"load": {"kind": "point", "at": (9, 1, 1)}}, "p and q must be from 0 to 5"),
        ({"effects": {"contacts": "unilateral"}}, "effects.contacts"),
        ({"effects": {"stop_at_tension": True}}, "effects.stop_at_tension"),
        ({"ask": {"quantity": "contact", "at": (1, 1, "+")}}, "must be a contact"),
        ({"ask": {"quantity": "contact", "at": (1, 1, 4, "1")}}, "j must be from 0 to 3"),
        ({"ask": {"quantity": "positions", "at": (1, 1)}}, "must be a bead"),
        ({"ask": {"quantity": "histogram", "at": (1, 1, 1, "1")}}, "ask.at"),
        ({"disorder": {"kind": "file", "file": "radii.csv"}}, "disorder.file"),
    ],
)
def test_what_is_not_offered_is_refused(changes: dict[str, dict[str, Any]], says: str) -> None:
    sections: dict[str, dict[str, Any]] = {
        "packing": {"height": 4, "width": 6, "dimension": 3},
        "disorder": {"kind": "uniform", "relative_std": 1e-3},
        "load": {},
        "effects": {},
        "ask": {"quantity": "profile"},
    }
    for name, keys in changes.items():
        sections[name] = keys if name == "disorder" else sections[name] | keys
    with pytest.raises(fd.SceneError, match=says):
        fd.Scene(**sections)


def test_studies_and_other_plots_refuse_three_dimensions() -> None:
    asked = scene("profile", height=2, width=6)
    with pytest.raises(fd.SceneError, match=r"packing.dimension = 3: must be 2"):
        fd.cost(asked)
    with pytest.raises(fd.SceneError, match=r"packing.dimension = 3: contact_forces has"):
        scene(height=2, width=6).run().plot()


def test_a_profile_and_a_histogram_are_drawn() -> None:
    profile = scene("profile", height=2, width=6)
    axes = profile.run().plot().axes[0]
    names = axes.get_legend_handles_labels()[1]
    assert names == ["exact at finite $M$", *(f"simulated, $f^{a}$" for a in (1, 2, 3))]
    bins = fd.ensemble(scene("histogram", height=2, width=6, std=1e-4), 20).plot().axes[0]
    assert "theory: a Gaussian a layer" in bins.get_legend_handles_labels()[1]


@pytest.mark.parametrize("kind", ["surface", "bulk"])
@pytest.mark.parametrize(("height", "width"), [(3, 5), (3, 4)])
def test_a_profile_has_the_exact_first_order_width_where_no_image_is_seen(
    kind: Any, height: int, width: int
) -> None:
    """Squared weights by the recursion, not the closed forms; F is the load over 3 n_z."""
    load = fd.Load(kind=kind)
    found = scene("profile", height=height, width=width, load=load).run().arrays
    if width <= height + 1:
        assert "first_order_std" not in found
        return
    phi = 1 - Fraction("2.9") ** 2 / 8
    for j, stated in zip(found["j"].tolist(), found["first_order_std"].tolist(), strict=True):
        weights = together(force_weights(3, height, j, phi, bulk=kind == "bulk"))
        force = (height - j if kind == "bulk" else 1) / np.sqrt(3 * float(1 + 2 * phi))
        variance = float(sum(w * w for w in weights.values()))
        assert stated == pytest.approx(1e-2 * force * np.sqrt(variance), rel=1e-11)


def test_an_ensemble_has_the_width_of_theory() -> None:
    """With 400 packings σ_f is known to 1 %; what is sampled is independent of theory."""
    asked = scene("profile", height=4, width=6, std=1e-4)
    found = fd.ensemble(asked, 400)
    assert found.first_order_std is not None
    off = (found.std - found.first_order_std) / found.std_error
    # 12 rows: one beyond 4.5 standard errors has a chance below 1e-4; the seed is fixed
    assert np.abs(off).max() < 4.5
    assert (found.std_error / found.std).max() < 0.02


def inside(outcome: fd.Outcome, load: tuple[int, int, int], width: int) -> Array:
    """Whether a contact's lower bead is reached from the load by steps along all three axes."""
    found = []
    for p, q, j in columns(outcome, "p", "q", "j"):
        first, second = (load[0] - p) % width, (load[1] - q) % width
        steps = first, second, load[2] - j - first - second
        found.append(min(steps) > 0)
    return np.array(found)


def test_a_point_load_fluctuates_on_the_faces_of_its_cone_alone() -> None:
    """To first order; what the inside bears is of second order."""
    load = fd.PointLoad(at=(4, 4, 5))

    def largest(geometry: str, std: float) -> tuple[float, float]:
        outcome = scene("response", height=5, width=7, load=load, geometry=geometry, std=std).run()
        change, within = np.abs(outcome.arrays["change"]), inside(outcome, (4, 4, 5), 7)
        assert within.sum() > 20
        return change[within].max(), change[~within].max()

    silent, faces = largest("first-order", 1e-4)
    assert silent == 0
    assert faces > 1e-5
    (wide, wide_faces), (narrow, narrow_faces) = (largest("exact", std) for std in (1e-4, 1e-5))
    assert wide_faces / narrow_faces == pytest.approx(10, rel=0.02)
    assert wide / narrow == pytest.approx(100, rel=0.02)  # the next order is a share of 1e-3


def test_radii_of_ones_own_are_an_array_of_beads(tmp_path: Path) -> None:
    """The drawn radii, given as an array and in a file, make the same packing."""
    asked = scene(height=3, width=4)
    values = np.zeros((4, 4, 4))
    for (p, q, j), rho in drawn(asked).items():
        values[j, p, q] = float(1 + rho)
    np.save(tmp_path / "radii.npy", values)
    first = asked.run().arrays["change"]
    for disorder in (
        fd.GivenRadii(radii=values),
        fd.GivenRadii(radii=np.stack([values, values])),
        fd.Disorder(kind="file", file="radii.npy"),
    ):
        again = asked.model_copy(update={"disorder": disorder, "folder": tmp_path}).run()
        # radii near 1 are rounded to 1e-16, of which changes are a few times as much
        assert np.abs(again.arrays["change"] - first).max() < 1e-14


def test_an_array_of_another_shape_is_refused(tmp_path: Path) -> None:
    asked = {
        "packing": fd.Packing(height=3, width=5, dimension=3),
        "ask": fd.Ask(quantity="profile"),
    }
    for shape in ((4, 5), (4, 5, 4), (2, 2, 4, 5, 5)):
        with pytest.raises(fd.SceneError, match=r"give \(4, 5, 5\)|must be an array"):
            fd.Scene(disorder=fd.GivenRadii(radii=np.ones(shape)), **asked)
    np.save(tmp_path / "radii.npy", np.ones((4, 5)))
    given = fd.Disorder(kind="file", file="radii.npy")
    with pytest.raises(fd.ForceDiffusionError, match="of 5 × 5 beads"):
        fd.Scene(disorder=given, folder=tmp_path, **asked).run()


def test_roundings_of_forces_do_not_pile_up() -> None:
    """Three hundred layers: within four units of the last place, thrice less than plain sums."""
    M, phi, rng = 300, Fraction(1, 5), np.random.default_rng(3)
    rho = [1e-9 * rng.uniform(-1, 1, (3, 3)) for _ in range(M + 1)]

    def solved(system: NumberSystem) -> list[Array]:
        with system.active():
            beads = [from_floats(system, row) for row in rho]
            placed = deposit(beads, metric(3, phi, system), system, linear=False)
            load = zeros(system, 3, 3) + system.number(Fraction(1))
            borne = bear(placed, [None] * M + [load], system, linear=False)
            return [as_floats(row) for row in borne.change[1:]]

    near, enclosed = np.array(solved(FLOAT64)), np.array(solved(Balls(120)))
    assert np.abs(near - enclosed).max() < 4 * 2.0**-52 * np.abs(enclosed).max()


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
        deposit([np.array(row) for row in rho], metric(3, Fraction(1, 5), FLOAT64), FLOAT64,
                linear=False)  # fmt: skip
    assert raised.value.site[2] == 2


def test_contacts_in_one_plane_hold_nothing_up() -> None:
    """The first contact of bead (1, 0, 1) is turned onto the second."""
    m = metric(3, Fraction(1, 5), FLOAT64)
    dn = np.zeros((3, 3, 2, 2))
    dn[0, 0, 1, 0], dn[0, 1, 1, 0] = -1, 1
    nothing = [np.zeros((2, 2))] * 2
    placed = Placed(m, nothing, [np.zeros((3, 2, 2))] * 2, [np.zeros(0), dn])
    with FLOAT64.active(), pytest.raises(NotStandingError, match=r"\(1, 0, 1\).*one plane"):
        bear(placed, [None, np.ones((2, 2))], FLOAT64, linear=False)


@pytest.mark.parametrize("layer", [0, 1])
def test_a_radius_below_zero_is_named_in_any_layer(layer: int) -> None:
    rho = [np.zeros((2, 2)), np.zeros((2, 2))]
    rho[layer][0, 1] = -1.5
    with FLOAT64.active(), pytest.raises(UnbuildableError, match="no positive number") as raised:
        deposit(rho, metric(3, Fraction(1, 5), FLOAT64), FLOAT64, linear=False)
    assert raised.value.site == (0, 1, layer)


def test_what_balls_leave_open_is_undecided() -> None:
    system = Balls(60)
    with system.active():
        rho = [zeros(system, 2, 2), zeros(system, 2, 2)]
        rho[0][0, 1] = flint.arb(3, 3)  # a support of any size from r to 7 r
        with pytest.raises(UndecidedError, match="layer 1"):
            deposit(rho, metric(3, Fraction(1, 5), system), system, linear=False)


def test_what_no_load_reaches_is_not_solved_and_bears_nothing() -> None:
    load = fd.PointLoad(at=(1, 1, 2))
    asked = scene("contact", height=5, width=6, at=(1, 1, 3, "1"), load=load)
    assert asked.explain().problem.region.top == 2
    assert asked.run().rows()[0]["force"] == 0
    assert fd.ensemble(asked, 4).mean.tolist() == [0]


@pytest.mark.parametrize("height", [2, 3])
@pytest.mark.parametrize("width", [1, 2, 3, 4])
def test_the_response_to_a_point_load_sees_images_where_its_cone_meets_itself(
    height: int, width: int
) -> None:
    """All radii of a wide packing matter to some contact; images where two are W apart."""
    wide = 2 * height + 2
    apart = range(-height, 1)
    # the simplex below the load, whose beads all decide where the loaded bead lies
    beads = {(p, q, j) for j in range(height) for p in apart for q in apart
             if height - j + p + q >= 0}  # fmt: skip
    homes = {(p % width, q % width, j) for p, q, j in beads}
    load = fd.PointLoad(at=(0, 0, height))
    plan = scene("response", height=height, width=width, load=load).explain()
    assert plan.sees_images == (len(homes) < len(beads))
    assert not scene("response", height=height, width=wide, load=load).explain().sees_images


@pytest.mark.parametrize(("at", "width"), [(2, 2), (4, 2), (3, 2), (3, 3), (0, 2)])
def test_rays_of_an_ordered_packing_may_meet_on_the_base(at: int, width: int) -> None:
    load = fd.PointLoad(at=(0, 0, at))
    asked = scene("base_reactions", height=4, width=width, load=load, geometry="ordered")
    found = asked.run().arrays["fz"]
    bearing = sum(float(force) > 0 for force in found)
    assert asked.explain().sees_images == (bearing < 3 and at > 0)
