"""The packings are packings: beads touch and are balanced, and another solver finds the same."""

from fractions import Fraction

import pytest
from force_diffusion.symbolic.search.counterexample import WORLDS
from force_diffusion.symbolic.search.dual import NOWHERE, ZERO, Dual, TooLargeError, Vector
from force_diffusion.symbolic.search.packing import (
    HIGHEST,
    AbsentError,
    Geometry,
    Packing,
    UnknownLoadingError,
    drawn,
    given,
)
from force_diffusion.symbolic.symbols import L_minus, L_plus, f_load
from hypothesis import given as examples
from hypothesis import strategies as st

from tests.numeric.mechanics import taylor

F_LOAD, WEIGHT = Fraction(11, 7), Fraction(13, 5)
TILTED = Vector(Dual(Fraction(-2, 7)), Dual(Fraction(-5, 3)))
PLACES = {
    None: (),
    "loaded": (1, 5),
    "loaded vertically": (1, 5),
    "passing": (1, 5),
    "entering": (1, 5),
    "surface": (5,),
    "bulk": (5,),
    "surface tilted": (5,),
    "bulk tilted": (5,),
}
GEOMETRIES = [world.geometry for world in WORLDS]


def packing(name: str | None, geometry: Geometry = GEOMETRIES[0]) -> Packing:
    return Packing(geometry, given(name, PLACES[name], F_LOAD, WEIGHT, TILTED))


def push(made: Packing, branch: str, across: int, layer: int) -> Vector:
    """Force of a contact on its upper bead; without a force the contact may be absent."""
    force = made.force(branch, across, layer)
    return made.geometry.direction(branch, across, layer).times(force) if force else NOWHERE


def carried(made: Packing, across: int, layer: int) -> Vector:
    below = push(made, "+", across - 1, layer - 1) + push(made, "-", across + 1, layer - 1)
    return below - push(made, "+", across, layer) - push(made, "-", across, layer)


beads = st.tuples(st.integers(-8, 8), st.integers(1, 8)).map(lambda at: (2 * at[0] - at[1], at[1]))


@pytest.mark.parametrize("geometry", GEOMETRIES)
def test_contacts_are_rational_and_inside_of_the_range(geometry: Geometry) -> None:
    x, y = geometry.n
    assert x**2 + y**2 == 1
    assert abs(y**2 - x**2) < Fraction(1, 2)
    assert geometry.radius != 1


def test_both_signs_of_the_cosine_come_first() -> None:
    cosines = [geometry.n[1] - geometry.n[0] for geometry in GEOMETRIES]
    assert cosines[0] < 0 < cosines[1]


@examples(st.sampled_from(GEOMETRIES), beads)
def test_beads_touch_and_directions_are_unit_vectors(
    geometry: Geometry, bead: tuple[int, int]
) -> None:
    for branch, side in (("+", -1), ("-", 1)):
        support = (bead[0] + side, bead[1] - 1)
        apart = geometry.position(*bead) - geometry.position(*support)
        length = geometry.radius_of(*bead) + geometry.radius_of(*support)
        assert apart.dot(apart) == length * length
        direction = geometry.direction(branch, *support)
        assert direction.dot(direction) == Dual(1)
        x, y = geometry.n
        assert (direction.x.value, direction.y.value) == (-side * x, y)


@examples(st.sampled_from(list(PLACES)), st.sampled_from(GEOMETRIES), beads)
def test_every_bead_is_balanced(
    name: str | None, geometry: Geometry, bead: tuple[int, int]
) -> None:
    made = packing(name, geometry)
    if made.given.surface is None or bead[1] <= made.given.surface:
        assert not carried(made, *bead) + made.load(*bead)


@pytest.mark.parametrize("name", ["loaded", "loaded vertically"])
def test_a_loaded_bead_carries_nothing_else(name: str) -> None:
    made = packing(name)
    assert made.force("+", 1, 5) == ZERO == made.force("-", 1, 5)
    assert made.force("+", 3, 5) != ZERO
    load = made.load(1, 5)
    if name == "loaded":
        assert all((load.x.value, load.x.slope, load.y.value, load.y.slope))
    else:
        assert load == Vector(ZERO, Dual(-F_LOAD))


def test_one_force_passes_a_bead_without_a_load() -> None:
    made = packing("passing")
    assert not made.load(1, 5)
    assert made.force("-", 1, 5) == ZERO
    entering = made.force("+", 1, 5)
    assert entering.value
    assert entering.slope
    assert made.load(3, 5)


def test_one_force_enters_and_nothing_else_is_below() -> None:
    made = packing("entering")
    assert made.force("+", 0, 4).value
    for across in (-4, -2, 2, 4):
        assert made.force("+", across, 4) == ZERO
    for across in (-2, 0, 2):
        assert made.force("-", across, 4) == ZERO
        assert not made.load(across, 4)
    assert made.load(1, 5)


def test_surface_and_weights() -> None:
    surface, bulk = packing("surface"), packing("bulk")
    assert surface.load(1, 5) == Vector(ZERO, Dual(-F_LOAD))
    assert not surface.load(0, 4)
    assert bulk.load(1, 5) == bulk.load(0, 0) == Vector(ZERO, Dual(-WEIGHT))
    # order 0: a layer carries what is above it, on two contacts of height n_y for each bead
    y = surface.geometry.n[1]
    for layer in range(5):
        across = layer % 2
        assert surface.force("+", across, layer).value == F_LOAD / (2 * y)
        assert bulk.force("-", across, layer).value == WEIGHT * (5 - layer) / (2 * y)
    with pytest.raises(AbsentError, match="above the surface"):
        surface.quantity("DeltaR", 0, 6)
    with pytest.raises(AbsentError, match="above the surface"):
        surface.quantity("DeltaNPlus", 1, 5)


def test_loads_that_are_not_vertical() -> None:
    surface, bulk = packing("surface tilted"), packing("bulk tilted")
    assert surface.load(1, 5) == bulk.load(1, 5) == bulk.load(2, 2) == TILTED
    assert not surface.load(2, 2)
    # order 0: every contact below carries its own branch's component, −load = L⁺n⁺ + L⁻n⁻
    x, y = surface.geometry.n
    across, down = -TILTED.x.value, -TILTED.y.value
    for branch, side in (("+", 1), ("-", -1)):
        own = (down / y + side * across / x) / 2
        for layer in range(5):
            site = (layer % 2, layer)
            assert surface.force(branch, *site).value == own
            assert bulk.force(branch, *site).value == own * (5 - layer)


def test_the_load_of_a_world_has_its_components() -> None:
    for world in WORLDS:
        values, (x, y) = world.values(), world.n
        plus, minus = values[L_plus], values[L_minus]
        load = Packing(world.geometry, world.given("bulk tilted", (3,))).load(1, 1)
        assert (load.x.value, load.y.value) == (-(plus - minus) * x, -(plus + minus) * y)
        assert world.given("surface", (3,)).load(1, 3) == Vector(ZERO, Dual(-values[f_load]))


def test_another_solver_finds_the_same() -> None:
    """It solves the nonlinear packing, with power series, on a periodic strip that is wider."""
    height, width = 5, 14
    geometry = Geometry((Fraction(20, 29), Fraction(21, 29)), Fraction(1))
    rho = {
        (across % (2 * width), layer): drawn(across, layer)
        for layer in range(height + 1)
        for across in range(layer % 2 - width, width, 2)
    }
    assert len(rho) == width * (height + 1)
    surface = range(height % 2, 2 * width, 2)
    loads = {(across, height): (Fraction(0), -F_LOAD) for across in surface}
    solved = taylor.solve(width, height, n=geometry.n, rho=rho, loads=loads, order=1)
    made = packing("surface", geometry)
    for across, layer in ((-3, 1), (2, 2), (1, 1), (0, 0), (3, 3), (0, 4)):
        moved = solved.displacement(across, layer)
        assert made.quantity("DeltaX", across, layer) == Vector(*(Dual(0, c[1]) for c in moved))
        for branch, kind in (("+", "DeltaNPlus"), ("-", "DeltaNMinus")):
            turned = solved.direction(across, layer, branch)
            found = made.quantity(kind, across, layer)
            assert found == Vector(*(Dual(0, c[1]) for c in turned))
            assert made.force(branch, across, layer) == Dual(*solved.force(across, layer, branch))


def test_what_is_not_there_is_said() -> None:
    made = packing(None)
    with pytest.raises(AbsentError, match="odd"):
        made.quantity("DeltaR", 1, 2)
    with pytest.raises(AbsentError, match="below the base"):
        made.quantity("DeltaX", 1, -1)
    with pytest.raises(TooLargeError):
        made.quantity("DeltaX", 0, HIGHEST + 2)
    with pytest.raises(TooLargeError):
        Packing(GEOMETRIES[0], given("surface", (1000,), F_LOAD, WEIGHT)).force("+", 0, 0)
    for name, place in (("hanging", (1,)), ("surface", (1, 1)), ("passing", (1,))):
        with pytest.raises(UnknownLoadingError, match=name):
            given(name, place, F_LOAD, WEIGHT)


def test_no_two_radii_nearby_are_equal() -> None:
    radii = [drawn(a - b, a + b) for a in range(-9, 20) for b in range(-9, 20) if 0 <= a + b < 20]
    assert len(set(radii)) == len(radii)
    assert len({abs(one.denominator) for one in radii}) == len(radii)
