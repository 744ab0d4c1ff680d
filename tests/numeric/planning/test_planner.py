"""Only what is called for: tests on the work that was executed, and on what it depends on."""

import sys

import pytest
from force_diffusion.numeric.planning.memory import float_bead
from force_diffusion.numeric.run.running import run
from hypothesis import given
from hypothesis import strategies as st

from tests.numeric.scenes import basic, listed_loads, planned, question, radii_read

contacts = st.integers(1, 12).flatmap(
    lambda M: st.tuples(
        st.just(M), st.integers(0, M - 1), st.integers(-9, 9), st.sampled_from("+-")
    )
)


@given(contacts, st.sampled_from(["exact", "first-order"]))
def test_a_contact_of_the_slab_visits_the_number_of_beads_in_the_formula(where, geometry):
    M, j, column, branch = where
    sections = basic(M, None, quantity="contact", at=[2 * abs(column) + j % 2, j, branch])
    sections["effects"] = {"geometry": geometry}
    plan = planned(sections)
    solved, sites = radii_read(plan)
    count = (M + 1) * (3 * M - 2 * j) // 2
    if geometry == "first-order":  # three diagonals up, and what two cross ones add
        count = j + max(j - 1, 0) + (3 * M + 2 if j <= M - 2 else 2 * M + 1)
    assert len(sites) == count
    if geometry == "exact":
        assert solved.block.shape[-1] == count
        assert solved.g.shape[-1] == (M - j) * (M - j + 1) // 2
    else:
        assert solved.block is solved.g is None
    assert plan.beads == count


@given(contacts, st.sampled_from(["exact", "first-order"]))
def test_below_a_point_load_a_plan_counts_the_beads_that_are_read(where, geometry):
    M, j, column, branch = where
    sections = basic(M, None, quantity="contact", at=[2 * column + j % 2, j, branch])
    sections |= {"effects": {"geometry": geometry}, "load": {"kind": "point", "at": [M % 2, M]}}
    plan = planned(sections)
    assert plan.beads == len(radii_read(plan)[1])


def test_without_disorder_nothing_is_swept():
    for quantity in ("contact_forces", "profile", "positions", "histogram"):
        sections = basic(quantity=quantity)
        del sections["disorder"]
        plan = planned(sections)
        solved, sites = radii_read(plan)
        assert not sites
        assert solved.block is None
        assert plan.beads == 0


def test_without_a_load_nothing_is_swept(tmp_path):
    load = listed_loads(tmp_path, [(4, 4, 0, 0)])
    plan = question("contact_forces", 6, 14, load=load).explain()
    assert [*plan.skipped] == ["disorder"]
    assert plan.beads == 0
    assert all(force == 0 for force in run(plan).arrays["force"])


def test_a_point_load_stays_in_its_cone():
    sections = basic(8, 20, quantity="response")
    sections["load"] = {"kind": "point", "at": [5, 7]}
    solved, _ = radii_read(planned(sections))
    for row in solved.rows:
        assert all(abs(i - 5) <= 7 - row.j for i in row.sites())
    assert solved.g.shape[-1] == sum(7 - j + 1 for j in range(1, 8))
    assert solved.block.shape[-1] == 8 * 9 // 2


@pytest.mark.parametrize("realisations", [1, 3, 7])
@pytest.mark.parametrize("quantity", ["contact", "contact_forces", "positions", "profile"])
@pytest.mark.parametrize("geometry", ["exact", "first-order"])
def test_the_plan_is_what_runs(geometry, quantity, realisations):
    at = {"at": [2, 2, "+"]} if quantity == "contact" else {}
    sections = basic(quantity=quantity, realisations=realisations, **at)
    plan = planned(sections | {"effects": {"geometry": geometry}})
    seen: list[int] = []
    kinds = {"deposited", "summed"}
    outcome = run(plan, progress=lambda kind, beads: seen.append(beads * (kind in kinds)))
    assert sum(seen) == plan.beads
    assert outcome.accuracy.arithmetic == plan.system.name


def test_memory_knows_what_is_solved_together():
    single, batch = (planned(basic(quantity="profile", realisations=n)) for n in (1, 1000))
    assert batch.memory > single.memory + 900 * single.problem.region.beads * float_bead(2)


@pytest.mark.parametrize("quantity", ["contact", "histogram", "profile", "response"])
def test_a_plan_takes_no_longer_the_more_layers_there_are(quantity):
    def calls(height: int) -> int:
        sections = basic(height, 7, quantity=quantity)
        sections["packing"]["allow_images"] = True
        sections["disorder"]["relative_std"] = "=1e-12"
        if quantity == "response":
            sections |= {"load": {"kind": "point", "at": [height % 2, height]}}
            sections["ask"]["layers"] = [0]
        if quantity == "contact":
            sections["ask"]["at"] = [0, 0, "+"]
        counted = 0

        def count(frame: object, event: str, argument: object) -> None:
            nonlocal counted
            counted += event == "call"

        sys.setprofile(count)
        try:
            made = planned(sections)
        finally:
            sys.setprofile(None)
        assert made.problem.region.top == height
        return counted

    assert calls(200_001) <= 2 * calls(101)
