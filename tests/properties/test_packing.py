"""The reference itself, of discs and of spheres: beads touch, forces balance, images repeat."""

from dataclasses import replace
from fractions import Fraction
from itertools import product

from hypothesis import given, reject
from hypothesis import strategies as st

from tests.properties.drawn import exactly
from tests.properties.orders import ROUNDING
from tests.properties.packing import (
    DIGITS, FallsThroughError, Packing, Site, Vector, determinant, dot, minus, mp, plus, step,
    times,
)  # fmt: skip


def every(packing: Packing, first: int = 0) -> list[Site]:
    return [site for layer in range(first, packing.height + 1) for site in packing.sites(layer)]


@st.composite
def disordered(draw: st.DrawFn) -> Packing:
    """Two or three dimensions, radii that differ by up to a tenth, seams across every cone."""
    d = draw(st.sampled_from([2, 3]))
    width, height = draw(st.integers(1, 3)), draw(st.integers(1, 6 - d))
    # no horizontal neighbours overlap
    cosine = draw(st.fractions(Fraction(-1, 5), Fraction(2, 5), max_denominator=20))
    r = draw(st.builds(Fraction, st.integers(1, 9), st.integers(1, 9)))
    packing = Packing(exactly(cosine), width, height, exactly(r), {}, d)
    parts = st.just(0) | st.integers(-9, 9)
    change = {site: packing.r * draw(parts) / 90 for site in every(packing)}
    packing = replace(packing, change=change)
    try:
        packing.centre(next(packing.sites(height)))
    except FallsThroughError:  # as a small one above large ones may all the same, above all in 3D
        reject()
    return packing


@st.composite
def with_loads(draw: st.DrawFn) -> tuple[Packing, dict[Site, Vector]]:
    """A load in any direction on every bead above the base."""
    packing = draw(disordered())
    parts = st.tuples(*[st.integers(-9, 9)] * packing.d)
    loads = {site: times(mp.mpf(1), draw(parts)) for site in every(packing, 1)}
    return packing, loads


@given(disordered())
def test_base_vectors_are_of_unit_length_and_have_one_cosine(packing):
    for vector, other in product(packing.base, repeat=2):
        cosine = 1 if vector is other else packing.cosine
        assert abs(dot(vector, other) - cosine) < ROUNDING
    assert max(abs(vector[-1] - packing.base[0][-1]) for vector in packing.base) < ROUNDING


@given(disordered())
def test_beads_lie_on_top_of_those_that_they_touch(packing):
    for site in every(packing, 1):
        for c in range(packing.d):
            below = step(site, c, -1)
            apart = minus(packing.centre(site), packing.centre(below))
            deltas = (packing.change[packing.home(bead)] for bead in (site, below))
            reach = 2 * packing.r + sum(deltas)
            assert abs(dot(apart, apart) - reach**2) < ROUNDING
            turned = minus(times(reach, packing.direction((below, c))), apart)
            assert max(map(abs, turned)) < ROUNDING
        # the lower of the two meeting points would be the mirror image
        contacts = [packing.direction((step(site, c, -1), c)) for c in range(packing.d)]
        assert determinant(contacts) * determinant(packing.base) > 0


@given(with_loads())
def test_every_bead_is_in_balance(drawn):
    packing, loads = drawn
    forces = packing.forces(loads)
    for site in every(packing, 1):
        total = loads[site]
        for c in range(packing.d):
            below = step(site, c, -1)
            contact = packing.home(below), c
            total = plus(total, times(forces[contact], packing.direction(contact)))
            if sum(site) < packing.height:
                total = minus(total, times(forces[site, c], packing.direction((site, c))))
        assert max(map(abs, total)) < ROUNDING


@given(disordered())
def test_the_base_is_held_and_carries_all_loads(packing):
    weight = mp.mpf(3)
    for load, beads in (
        (packing.surface_load(weight), packing.width ** (packing.d - 1)),
        (packing.bulk_load(weight), packing.width ** (packing.d - 1) * packing.height),
    ):
        assert len(load) == beads
        forces = packing.forces(load)
        onto = [(lower, c) for lower, c in forces if sum(lower) == 0]
        carried = sum(forces[contact] * packing.direction(contact)[-1] for contact in onto)
        assert abs(carried - weight * beads) < ROUNDING
    for site in packing.sites(0):
        assert packing.centre(site) == packing.ordered(site)
        assert abs(packing.centre(site)[-1]) < ROUNDING


@given(with_loads())
def test_a_packing_of_twice_the_width_with_the_same_radii_is_the_same(drawn):
    """So that it makes no difference where the seam is."""
    packing, loads = drawn
    wide = replace(packing, width=2 * packing.width)
    wide = replace(wide, change={site: packing.change[packing.home(site)] for site in every(wide)})
    carried = wide.forces({site: loads[packing.home(site)] for site in every(wide, 1)})
    forces = packing.forces(loads)
    assert len(carried) == 2 ** (packing.d - 1) * len(forces)
    for (lower, c), force in carried.items():
        assert abs(force - forces[packing.home(lower), c]) < ROUNDING
    for site in every(wide):
        assert max(map(abs, minus(wide.centre(site), packing.centre(site)))) < ROUNDING


@given(with_loads())
def test_rounding_stays_below_what_is_allowed_for(drawn):
    """Positions and forces do not change when they are found with twice the digits."""
    packing, loads = drawn
    centres = {site: packing.centre(site) for site in every(packing)}
    forces = packing.forces(loads)
    with mp.workdps(2 * DIGITS):
        fine = replace(packing)
        for site, centre in centres.items():
            assert max(map(abs, minus(fine.centre(site), centre))) < ROUNDING
        for contact, force in fine.forces(loads).items():
            assert abs(force - forces[contact]) < ROUNDING
