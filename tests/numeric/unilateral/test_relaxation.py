"""Packings without tension: where beads come to rest, and the errors where they don't."""

import sys
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from force_diffusion.numeric.accuracy import ToleranceError
from force_diffusion.numeric.unilateral import certificate, deposited
from force_diffusion.numeric.unilateral.grains import Grains
from force_diffusion.numeric.unilateral.network import Network, UnfinishedError

import force_diffusion as fd
from tests.numeric.scenes import listed_loads
from tests.numeric.unilateral.packings import must_hold, network_of, packing_of, strip


@pytest.fixture(scope="module")
def relaxed() -> fd.Outcome:
    return strip().run()


def at_rest(outcome: fd.Outcome, *, moved: bool = True) -> Network:
    """Give where beads came to rest, ``moved`` by linear programs or as they were deposited."""
    network = network_of(outcome)
    assert (network.programs > 0) == moved
    gap, forces = must_hold(packing_of(network))
    assert gap > network.smallest_gap - 1e-12
    assert network.forces.astype(float) == pytest.approx(forces, rel=1e-6, abs=1e-9 * forces.max())
    return network


def pressed(folder: Path, pressure: float, first: float) -> fd.Scene:
    """Give a strip whose surface bears a pressure, but its first bead this instead."""
    rows = [(i, 8, 0, -pressure if i else -first) for i in range(0, 32, 2)]
    return strip(load=listed_loads(folder, rows))


def own(deviations: dict[tuple[int, int], float], width: int = 5, spacing: float = 3) -> fd.Scene:
    """Two layers of beads on the base, of radius 1 but for those named (layer, column)."""
    delta = np.zeros((3, width))
    for at, value in deviations.items():
        delta[at] = value
    radii = fd.GivenRadii(delta_r=delta)
    return strip(height=2, width=width, spacing=spacing, radii=radii)


def test_no_contact_pulls(relaxed):
    bilateral = strip(contacts="bilateral").run().physical
    assert bilateral is not None
    assert bilateral.tensile > 0
    network = at_rest(relaxed)
    assert network.fall > 0
    assert all(force > 0 for force in network.forces)
    assert max(float(force.rad()) for force in network.forces) < 1e-15


def test_positions_are_those_of_the_network(relaxed):
    network = network_of(relaxed)
    positions = strip("positions").run().arrays
    assert positions["x"].astype(float).tolist() == network.x[:, 0].astype(float).tolist()
    assert (positions["contacts"] > 0).sum() == len(np.unique(network.pairs))
    assert (positions["contacts"][network.rattlers] == 0).all()
    (single,) = strip("positions", at=[3, 5]).run().rows()
    (same,) = (row for row in strip("positions").run().rows() if (row["i"], row["j"]) == (3, 5))
    assert single == same


@pytest.mark.parametrize("seed", [0, 2])
def test_without_tension_forces_are_as_deposited(seed):
    usual: dict[str, Any] = {"seed": seed, "tolerance": Fraction(1, 10**20)}
    unilateral = strip(**usual).run()
    bilateral = strip(contacts="bilateral", certified=True, **usual).run()
    assert network_of(unilateral).programs == 0
    rows = {(row["i"], row["j"], row["branch"]): row for row in bilateral.decimals()}
    for row in unilateral.decimals():
        other = rows[row["i"], row["j"], row["branch"]]
        assert abs(Fraction(row["force"]) - Fraction(other["force"])) < Fraction(1, 10**19)


@pytest.mark.parametrize(
    "scene",
    [
        strip(std=0.04, width=8, load=fd.BulkLoad()),
        strip(std=0.03, width=8, load=fd.SurfaceLoad(angle_deg=10)),
        strip(std=0.03, load=fd.PointLoad(at=[0, 8])),
        *(strip(std=0.03, width=width, seed=seed) for width, seed in ((3, 2), (4, 4), (5, 2))),
    ],
)
def test_beads_come_to_rest(scene):
    outcome = scene.run()
    assert outcome.accuracy.certified
    at_rest(outcome)


@pytest.mark.long
@pytest.mark.parametrize(("std", "width", "seed"), [(0.03, 16, 3), (0.3, 16, 1), (0.354, 5, 1)])
def test_what_cannot_be_deposited_starts_from_a_stretched_lattice(std, width, seed):
    """Up to 4 M*; as deposited, these have overlaps or beads that can't rest."""
    at_rest(strip(std=std, seed=seed, width=width).run())


@pytest.mark.long
@pytest.mark.parametrize("pressure", [0.1, 10])
def test_a_point_load_on_pressure(pressure, tmp_path):
    """Under little pressure the load sinks and pushes beads aside, which become rattlers."""
    outcome = pressed(tmp_path, pressure, 1 + pressure).run()
    network = at_rest(outcome)
    height = float(network.x[8 * 16, 1])
    assert (height < 5) if pressure < 1 else (10 < height < 11)  # deposited at 10.6
    assert (len(network.rattlers) > 10) == (pressure < 1)


@pytest.mark.long
def test_under_no_pressure_to_speak_of_beads_are_no_equilibrium(tmp_path):
    """The load sinks to the base, and all others stay in the air."""
    with pytest.raises(UnfinishedError, match="bears a load, and no contact holds it"):
        pressed(tmp_path, 1e-12, 1).run()


@pytest.mark.parametrize("tiny", [1e-9, 1e-14, 1e-300])
def test_a_bead_that_bears_next_to_nothing_is_held_or_is_no_answer(tiny, tmp_path):
    """One bead of the surface bears so little that its contacts may count as bearing nothing."""
    try:
        outcome = pressed(tmp_path, 1, tiny).run()
    except UnfinishedError as error:
        assert "bead 128 bears a load, and no contact holds it" in str(error)  # noqa: PT017
    else:
        assert 128 in at_rest(outcome).pairs


@pytest.mark.parametrize("load", [fd.SurfaceLoad(angle_deg=20), fd.BulkLoad()], ids=str)
def test_equal_radii_rest_as_deposited(load):
    at_rest(strip(std=0, width=8, load=load).run(), moved=False)


def test_equal_radii_under_one_load_are_no_strict_minimum():
    """Two straight chains bear it, whose beads nothing presses from the side."""
    outcome = strip(std=0, load=fd.PointLoad(at=[0, 8])).run()
    assert len(network_of(outcome).pairs) == 16
    assert "strict" not in outcome.data()["network"]["rest"]


# What is said where there is no answer


@pytest.mark.parametrize(("angle", "stands"), [(48, True), (49, False), (-49, False)])
def test_the_base_holds_loads_that_lean_less_than_its_contacts(angle, stands):
    """Beads between two of the base touch them at asin(3/4) = 48.6° to the vertical."""
    scene = strip(std=0, load=fd.SurfaceLoad(angle_deg=angle))
    if stands:
        assert network_of(scene.run()).programs == 0
    else:
        with pytest.raises(UnfinishedError, match=r"^no .* leans by 49° .* 48.59°"):
            scene.run()


def test_a_small_bead_is_held_at_the_side_of_a_large_one():
    """Centres of radii 0.9 and 1.2, 3 apart, touched by 0.9: 2.1 and 1.8 from them, by Heron."""
    x = np.array([[0.0, 0.0], [3.0, 0.0], [1.5, 2.0]])
    # from the horizontal at the bead of 1.2: cos = (3² + 2.1² − 1.8²) / (2 · 3 · 2.1)
    steepest = np.pi / 2 - np.arccos((9 + 2.1**2 - 1.8**2) / 12.6)
    other = np.pi / 2 - np.arccos((9 + 1.8**2 - 2.1**2) / 10.8)
    most = max(steepest, other)
    for lean, holds in ((most - 1e-6, True), (most + 1e-6, False)):
        load = np.array([[0, 0], [0, 0], [np.sin(lean), -np.cos(lean)]])
        grains = Grains(x, np.array([1.2, 0.9, 0.9]), 6.0, load, 2)
        if holds:
            deposited.must_hold(grains)
        else:
            with pytest.raises(UnfinishedError, match="no packing can stand"):
                deposited.must_hold(grains)


@pytest.mark.parametrize(
    ("scene", "words"),
    [
        # of radii up to 1.56 two neighbours on the base need more than 3
        (strip(std=0.354, seed=3, width=5), r"^no .* can stand: beads 3 and 4 of the base over"),
        # centres 3 apart, radii of 1.5 and as much, or more
        (own({(0, 1): 0.5, (0, 2): 0.5}), "beads 2 and 1 overlap, or can't be told"),
        (own({(0, 1): 0.5, (0, 2): 0.6}), "beads 2 and 1 overlap, or can't be told"),
        # a period of 7.5: what touches such a bead may touch its image as well
        (own({(2, 1): 0.9}, width=3, spacing=2.5), "bead 7 is so large"),
        (own({(2, 1): 1.3}, width=3, spacing=2.5), "bead 7 is so large"),
        (
            strip(
                height=6, width=4, spacing=3.274, std=0.06043, seed=1390, kind="two-point",
                load=fd.SurfaceLoad(angle_deg=38.02),
            ),
            "degenerate: a contact bears less than 1e-60",
        ),
        (strip(seed=3, effects={"most_programs": 3}), r"after 3 .* \(effects\.most_programs\)"),
        (strip(seed=3, effects={"most_seconds": 1e-6}), r"after effects\.most_seconds = "),
        # radii down to 0.48 r, 3 r apart; which beads fall depends on the solver's vertices
        pytest.param(
            strip(std=0.3, seed=3), r"bead \d+ fell through the base, and \d+ more",
            marks=pytest.mark.long,
        ),
        pytest.param(
            strip(
                height=6, width=4, spacing=3.3, std=0.3, seed=143, load=fd.BulkLoad(angle_deg=10)
            ),
            r"\d+ beads .* of 24, fell through the base: the w",
            marks=pytest.mark.long,
        ),
    ],
)  # fmt: skip
def test_the_error_says_why_there_is_no_answer(scene, words):
    with pytest.raises(UnfinishedError, match=words):
        scene.run()


def test_a_radius_that_is_not_positive_is_named_before_beads_that_find_no_rest():
    loose = {(0, 0): -0.7, (0, 1): -0.7, (1, 0): -0.7}
    with pytest.raises(fd.UnbuildableError, match=r"bead \(4, 2\): its radius is not a positive"):
        own({**loose, (2, 2): -1.5}).run()


def test_a_load_that_lifts_beads_off_is_never_an_answer(tmp_path):
    with pytest.raises((UnfinishedError, ToleranceError)):
        pressed(tmp_path, -1, -1).run()


def test_what_is_not_proved_is_no_answer(monkeypatch):
    """Were forces below zero rounded up to it, the certificate would say so."""
    enclosed = certificate._enclosed

    def pulling(*words: Any) -> Any:
        x, forces, h = enclosed(*words)
        return x, -forces, h

    monkeypatch.setattr(certificate, "_enclosed", pulling)
    with pytest.raises(UnfinishedError, match=r"one may exist: a contact .* pulls"):
        strip().run()


def test_a_solver_that_is_not_installed_is_asked_for(monkeypatch):
    monkeypatch.setitem(sys.modules, "highspy", None)
    says = r"highspy: pip install .force-diffusion\[unilateral\]"
    with pytest.raises(fd.ForceDiffusionError, match=says):
        strip().run()


def test_enough_programs_change_nothing(relaxed):
    most = {"most_programs": network_of(relaxed).programs}
    assert strip(effects=most).run().rows() == relaxed.rows()


@pytest.mark.parametrize(
    ("width", "effects", "key"),
    [(2, {}, "packing.width"), (16, {"most_seconds": 0}, "effects.most_seconds")],
)
def test_wrong_effects_are_refused(width, effects, key):
    with pytest.raises(fd.SceneError, match=f"^{key}.*(unilateral|greater than 0)"):
        strip(width=width, effects=effects)
