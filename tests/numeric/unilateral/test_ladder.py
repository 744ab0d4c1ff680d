"""What finds packings where linear programs from the deposited one don't, and what is said else."""

import sys
from typing import Any

import numpy as np
import pytest
from force_diffusion.numeric.planning.planner import plan
from force_diffusion.numeric.unilateral import UnfinishedError, relaxation
from force_diffusion.numeric.unilateral.grains import Grains
from force_diffusion.numeric.unilateral.interior_path import HELD, MOST_STEPS, _Stiffness, follow
from force_diffusion.numeric.unilateral.starts import dropped, in_pockets, start

import force_diffusion as fd
from tests.numeric.unilateral.test_unilateral import strip

PROGRAMS = "linear programs from the deposited packing"
DROPPED = "beads dropped one by one"
POCKETS = "pockets of the base"
PATH = "the end of an interior path"


def leaning(
    seed: int, *packing: Any, bulk: bool = False, kind: Any = "uniform", **effects: Any
) -> fd.Scene:
    """Give a scene by (M, W, s, angle, σ/r)."""
    height, width, spacing, angle, std = packing
    return fd.Scene(
        packing=fd.Packing(height=height, width=width, spacing=spacing, allow_images=True),
        disorder=fd.Disorder(kind=kind, relative_std=std, seed=seed),
        load=(fd.BulkLoad if bulk else fd.SurfaceLoad)(angle_deg=angle),
        effects=fd.Effects(contacts="unilateral", **effects),
        ask=fd.Ask(quantity="contact_forces"),
    )


# Beads slide on and on by linear programs from the deposited packing.
SLIDES = (48, 5, 4, 2.502, 35.7, 0.09918)
HOPELESS = (1, 3, 5, 2.204, 32.4, 0.14815)


def rung(outcome: fd.Outcome) -> str:
    (network,) = outcome.answer.networks
    assert outcome.data()["networks"][0]["rung"] == network.rung
    return network.rung


def test_what_linear_programs_answer_is_the_first_rung_of_the_ladder() -> None:
    alone = strip(protocol="linear-programs").run()
    found = strip(protocol="ladder").run()
    assert rung(alone) == rung(found) == PROGRAMS
    assert found.decimals() == alone.decimals()
    assert found.packings() == alone.packings()


def test_programs_that_start_from_a_stretched_lattice_say_so() -> None:
    found = strip(std=0.08, seed=3, protocol="ladder").run()
    assert rung(found) == "linear programs from a stretched lattice"


def test_an_interior_path_ends_lower_than_programs_from_the_deposited_packing() -> None:
    """It did in three packings that were compared, by 4 to 24 % of the fall."""
    path = strip(std=0.03, seed=3, protocol="interior-path").run()
    assert rung(path) == PATH
    (lower,) = path.answer.networks
    (higher,) = strip(std=0.03, seed=3, protocol="linear-programs").run().answer.networks
    heights = [float((n.x * n.frame.load).sum()) for n in (lower, higher)]  # less the energy
    assert heights[0] > heights[1]


def test_an_interior_path_keeps_all_gaps_open_and_lowers_the_load() -> None:
    problem = plan(strip(std=0.03, protocol="interior-path")).problem
    found, _, _ = start(problem, 0)
    energies: list[float] = []
    gaps: list[float] = []

    def looked(step: int) -> None:
        energies.append(found.energy())
        gaps.append(found.gaps(found.near(0.1)).min())

    pairs, order = follow(found, looked)
    assert len(energies) < MOST_STEPS
    assert energies[-1] < energies[0]
    # open until they are linear, and then to rounding and to what bends within the last moves
    assert min(gaps[:-20]) > 0
    assert min(gaps) > -1e-12
    sizes = np.sort(order)
    jumps = sizes[1:] / sizes[:-1]
    first = int(np.argmax(jumps))
    assert sizes[first] < 1 < sizes[first + 1]
    assert jumps[first] > 1e6  # contacts and others are told apart
    touching = pairs[order > 1]
    assert len(touching) == 2 * len(np.setdiff1d(touching, np.arange(found.fixed)))


@pytest.mark.parametrize(
    ("protocol", "package"), [("interior-path", "cvxopt"), ("linear-programs", "highspy")]
)
def test_a_solver_that_is_not_installed_is_asked_for(
    protocol: str, package: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, package, None)
    with pytest.raises(
        fd.ForceDiffusionError, match=rf"{package}: pip install .force-diffusion\[unilateral\]"
    ):
        strip(protocol=protocol).run()


def test_the_stiffness_is_solved() -> None:
    """Against NumPy, with the matrix written out, for two stiffnesses of one list of pairs."""
    problem = plan(strip(std=0.03, width=4)).problem
    found, _, _ = start(problem, 0)
    pairs = found.near(0.5)
    stiffness, random = _Stiffness(pairs, found), np.random.default_rng(7)
    A = found.jacobian(pairs).toarray()
    for _ in range(2):
        k, right = random.uniform(1, 2, len(pairs)), random.standard_normal(found.unknowns)
        full = A.T @ np.diag(k) @ A + HELD * np.eye(found.unknowns)
        move = stiffness.solved(found.directions(pairs), k, right)
        np.testing.assert_allclose(full @ move, right, atol=1e-10)


def test_where_rounding_ends_an_interior_path_programs_go_on(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def singular(*_: Any) -> None:
        raise ArithmeticError("not positive definite")

    monkeypatch.setattr(_Stiffness, "solved", singular)
    outcome = strip(std=0.03, protocol="interior-path").run()
    assert rung(outcome) == f"linear programs from {PATH}"
    (network,) = outcome.answer.networks
    assert 0 < network.events < 100  # programs alone


def test_where_nothing_moves_no_rung_answered() -> None:
    assert rung(strip(seed=0, protocol="ladder").run()) == ""


def test_the_next_rung_is_tried_where_beads_slide() -> None:
    found = leaning(*SLIDES).run()
    assert rung(found) == f"linear programs from {DROPPED}"
    with pytest.raises(
        UnfinishedError, match='protocol = "ladder", or "event-ladder", tries more ways'
    ) as raised:
        leaning(*SLIDES, protocol="linear-programs").run()
    assert "a stretched lattice: sliding: after 400 linear programs" in str(raised.value)


@pytest.mark.long(sample=1)
@pytest.mark.parametrize("angle", [45, 48])
def test_a_loaded_bead_rests_in_each_pocket_of_the_base(angle: int) -> None:
    """The base holds loads up to 48.6° here; all others bear nothing, and lie above."""
    found = strip(load=fd.SurfaceLoad(angle_deg=angle), protocol="ladder").run()
    assert rung(found) == POCKETS
    (network,) = found.answer.networks
    assert set(network.pairs[:, 0].tolist()) == set(range(8 * 16, 9 * 16))
    assert (network.pairs[:, 1] < 16).all()
    assert (network.events, network.fall) == (0, 0)
    assert "a strict local minimum" in found.data()["networks"][0]["rest"]


def test_where_no_rung_answers_each_says_why() -> None:
    with pytest.raises(UnfinishedError) as raised:
        leaning(*HOPELESS).run()
    said = str(raised.value)
    assert "none is known, and none is proved to be impossible" in said
    assert said.count("sliding: after 400 linear programs a loaded bead falls by 0.") == 2
    assert f"{POCKETS}: not one loaded bead in each pocket of the base: 2 of 5" in said
    assert "perhaps" not in said


def test_what_is_not_proved_is_refused_and_the_next_rung_tried(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    proof = relaxation._certified

    def only_dropped(problem: Any, realisation: int, settled: Any, system: Any) -> Any:
        if settled.rung.start != DROPPED:
            raise UnfinishedError("no proof")
        return proof(problem, realisation, settled, system)

    monkeypatch.setattr(relaxation, "_certified", only_dropped)
    assert rung(strip(protocol="ladder").run()) == f"linear programs from {DROPPED}"
    with pytest.raises(UnfinishedError, match=f"{PROGRAMS}: no proof"):
        strip(protocol="linear-programs").run()


@pytest.mark.parametrize("limit", [{"most_events": 401}, {"most_seconds": 1e-6}])
def test_limits_are_of_all_rungs_together(limit: dict[str, Any]) -> None:
    """The first takes 400 programs."""
    with pytest.raises(UnfinishedError, match=f"not at rest after effects.{next(iter(limit))}"):
        leaning(*SLIDES, **limit).run()


def test_beads_that_bear_loads_and_fall_through_the_base_are_told() -> None:
    """Radii scatter by 0.3 r, and beads of the base are 3.3 r apart."""
    with pytest.raises(UnfinishedError, match=r"fell through the base: \d+ .* of 24; the widest"):
        leaning(143, 6, 4, 3.3, 10, 0.3, bulk=True, protocol="linear-programs").run()


@pytest.mark.parametrize(("std", "seed", "width"), [(0.03, 3, 16), (0.12, 3, 16), (0.354, 1, 5)])
def test_events_start_from_dropped_beads_where_the_deposited_overlap(
    std: float, seed: int, width: int
) -> None:
    found = strip(std=std, seed=seed, width=width, protocol="event-ladder").run()
    assert rung(found) == f"events from {DROPPED}"
    with pytest.raises(UnfinishedError, match="and events start there"):
        strip(std=std, seed=seed, width=width, protocol="event-driven").run()


def test_forces_that_are_zero_are_told_before_all_bits_are_tried() -> None:
    """It ended after 8192 bits, as a tolerance that can't be reached."""
    two_sizes = (1390, 6, 4, 3.274, 38.02, 0.06043)
    with pytest.raises(UnfinishedError, match="degenerate: a contact bears less than 1e-60"):
        leaning(*two_sizes, kind="two-point", protocol="linear-programs").run()
    assert rung(leaning(*two_sizes, kind="two-point").run()) == f"linear programs from {DROPPED}"


def test_pairs_that_are_held_apart_at_the_end_are_no_contacts() -> None:
    """It ended in a traceback: contacts were fewer than the coordinates of all beads."""
    scene = leaning(73, 5, 6, 3.009, 40.06, 0.02996, kind="two-point", protocol="event-driven")
    (network,) = scene.run().answer.networks
    assert network.events > 100


def grains(load: list[float], radii: list[float], fixed: int = 4) -> Grains:
    """Give beads above a base of ``fixed`` beads, 3 apart, all of which bear the load."""
    loads = np.zeros((len(radii), 2))
    loads[fixed:] = load
    return Grains(np.zeros((len(radii), 2)), np.array(radii), 3.0 * fixed, loads, fixed)


def test_dropped_beads_touch_two_earlier_ones_that_hold_them() -> None:
    random = np.random.default_rng(5)
    found = grains([0.3, -1], [*random.uniform(0.8, 1.2, 4 * 9)])
    q, j = np.meshgrid(np.arange(4), np.arange(9))
    home = np.stack([(3 * q + 1.5 * (j % 2)).ravel(), (1.32 * j).ravel()], axis=1)
    pairs = dropped(found, home)
    assert pairs[:, 0].tolist() == [bead for bead in range(4, 36) for _ in range(2)]
    assert (pairs[:, 1] < pairs[:, 0]).all()
    np.testing.assert_allclose(found.gaps(pairs), 0, atol=1e-12)
    assert found.gaps(found.near(1.0)).min() > -1e-9
    push = found.directions(pairs).reshape(-1, 2, 2)  # bead, support, coordinate
    borne = np.linalg.solve(push.transpose(0, 2, 1), np.full((32, 2, 1), [[-0.3], [1]]))
    assert (borne > 0).all()


def test_pockets_take_the_beads_that_they_hold() -> None:
    """Radii 1 on radii 1, 3 apart: contacts at asin(3/4) to the vertical hold 45°."""
    found = grains([1, -1], [1.0] * 8)
    contacts = in_pockets(found)
    np.testing.assert_allclose(found.gaps(contacts), 0, atol=1e-14)
    forces = relaxation.balanced(found, contacts)
    # (3/4)(F⁺ + F⁻)... : F⁻ − F⁺ = 4/3 sideways, F⁻ + F⁺ = 1/√(7/16) upwards
    up, side = 4 / np.sqrt(7), 4 / 3
    np.testing.assert_allclose(np.sort(forces), [(up - side) / 2] * 4 + [(up + side) / 2] * 4)
    with pytest.raises(UnfinishedError, match="4 of 4 would roll out"):
        in_pockets(grains([1.2, -1], [1.0] * 8))
    with pytest.raises(UnfinishedError, match="8 beads bear loads, and the base has 4 pockets"):
        in_pockets(grains([0, -1], [1.0] * 12))
    with pytest.raises(UnfinishedError, match="1 of 4 would roll out"):  # it falls through
        in_pockets(grains([0, -1], [*[1.0] * 7, 0.4]))
