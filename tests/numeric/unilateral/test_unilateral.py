"""Packings without tension: protocols, certificates, and a checker that knows neither."""

import copy
import json
import re
from collections.abc import Callable
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from force_diffusion.numeric.accuracy import ToleranceError
from force_diffusion.numeric.quantities.base import Quantity
from force_diffusion.numeric.unilateral import event_driven
from force_diffusion.numeric.unilateral.grains import Grains
from force_diffusion.numeric.unilateral.network import UnfinishedError
from force_diffusion.numeric.unilateral.starts import must_hold

import force_diffusion as fd

PROTOCOLS = ("linear-programs", "interior-path", "event-driven")


def strip(
    quantity: str = "contact_forces", *, std: float = 0.016, seed: int = 1, **more: Any
) -> fd.Scene:
    """Give a strip in which contacts would pull (seed 1, and σ/r as it is here)."""
    effects = {"contacts": "unilateral", "protocol": more.pop("protocol", "linear-programs")}
    if more.pop("bilateral", False):
        effects = {}
    return fd.Scene(
        packing=fd.Packing(height=8, width=more.pop("width", 16), allow_images=True),
        disorder=fd.Disorder(kind="uniform", relative_std=std, seed=seed),
        load=more.pop("load", fd.SurfaceLoad()),
        effects=fd.Effects(**effects),
        ask=fd.Ask(quantity=quantity, **more),
    )


def pressed(load: float, folder: Path) -> fd.Load:
    """Give a load of 1 on bead (0, 8) of the surface, beside a ``load`` on each of its beads."""
    rows = [f"{i},8,0,{-load - (not i)!r}" for i in range(0, 32, 2)]
    (folder / "loads.csv").write_text("\n".join(["i,j,fx,fy", *rows]))
    return fd.Load(kind="file", file=str(folder / "loads.csv"))


@pytest.fixture(scope="module", params=PROTOCOLS)
def relaxed(request: pytest.FixtureRequest) -> fd.Outcome:
    return strip(protocol=request.param).run()


def written(
    outcome: fd.Outcome, folder: Path, change: Callable[[dict[str, Any]], None]
) -> fd.Verdict:
    """Check a packing's file after a change."""
    data = copy.deepcopy(outcome.packings())
    change(data["packings"][0])
    path = folder / "packings.json"
    path.write_text(json.dumps(data))
    (verdict,) = fd.check_packings(path)
    return verdict


def test_without_the_effect_some_contact_pulls() -> None:
    found = strip(bilateral=True).run().physical
    assert found is not None
    assert found.tensile > 0


def test_no_contact_pulls_and_the_balance_holds_exactly(relaxed: fd.Outcome) -> None:
    (network,) = relaxed.answer.networks
    assert network.events > 0
    assert network.fall > 0
    assert all(force > 0 for force in network.forces)
    with relaxed.plan.system.active():
        rest = network.frame.load.copy()
        for (a, b), push in zip(network.pairs, network.pushes(), strict=True):
            rest[a], rest[b] = rest[a] + push, rest[b] - push
        for value in rest[network.width :].ravel():
            assert value.contains(0)
            assert value.rad() < 1e-15


def test_contacts_touch_and_nothing_overlaps(relaxed: fd.Outcome) -> None:
    """Every pair of beads, images included, by brute force in float64."""
    (network,) = relaxed.answer.networks
    x = network.x.astype(float)
    radii, period = network.frame.radii.astype(float), float(network.frame.period)
    touching = {frozenset(pair) for pair in network.pairs.tolist()}
    for a in range(len(x)):
        for b in range(max(a + 1, network.width), len(x)):
            gaps = [
                np.hypot(x[a, 0] - x[b, 0] + k * period, x[a, 1] - x[b, 1]) - radii[a] - radii[b]
                for k in (-1, 0, 1)
            ]
            # centres of this size are rounded by 1e-14
            if frozenset((a, b)) in touching:
                assert min(gaps) == pytest.approx(0, abs=1e-12)
            else:
                assert min(gaps) > network.smallest_gap - 1e-12


def test_as_many_contacts_as_coordinates(relaxed: fd.Outcome) -> None:
    (network,) = relaxed.answer.networks
    free = len(network.x) - network.width - len(network.rattlers)
    assert len(network.pairs) == 2 * free


def test_the_checker_agrees(relaxed: fd.Outcome, tmp_path: Path) -> None:
    verdict = written(relaxed, tmp_path, lambda packing: None)
    assert verdict.proved, verdict
    assert verdict.within is not None
    assert verdict.within < 1e-15


def _moved(packing: dict[str, Any]) -> None:
    packing["centres"][100][1] = str(float(packing["centres"][100][1]) + 1e-5)


def _grown(packing: dict[str, Any]) -> None:
    packing["radii"][100] = "1.05"


def _upside_down(packing: dict[str, Any]) -> None:
    packing["loads"] = [[x, y.removeprefix("-")] for x, y in packing["loads"]]


def _one_contact_less(packing: dict[str, Any]) -> None:
    packing["contacts"].pop()


def _another_contact(packing: dict[str, Any]) -> None:
    packing["contacts"][-1] = [20, 100]


def _onto_another(packing: dict[str, Any]) -> None:
    """Put a bead that nothing touches onto another one."""
    for values in ("radii", "loads"):
        packing[values].append(packing[values][100])
    packing["loads"][-1] = ["0", "0"]
    packing["centres"].append(packing["centres"][100])


@pytest.mark.long(sample=5)
@pytest.mark.parametrize(
    "change", [_moved, _grown, _upside_down, _one_contact_less, _another_contact, _onto_another]
)
def test_the_checker_refuses(
    relaxed: fd.Outcome, tmp_path: Path, change: Callable[[dict[str, Any]], None]
) -> None:
    assert not written(relaxed, tmp_path, change).proved


@pytest.mark.parametrize(
    "text",
    ["", "{", "[]", "null", '{"format": "another", "packings": []}', "[" * 100_000, "\ud800"],
)
def test_a_file_that_is_none_is_refused_in_words(tmp_path: Path, text: str) -> None:
    path = tmp_path / "packings.json"
    path.write_text(text, errors="surrogatepass")
    with pytest.raises(fd.ForceDiffusionError, match=r"packings\.json") as raised:
        fd.check_packings(path)
    assert not re.search(r"_File|: :|Input", str(raised.value))


@pytest.mark.parametrize("seed", [0, 2])
@pytest.mark.parametrize("protocol", PROTOCOLS)
def test_without_tension_forces_are_as_deposited(seed: int, protocol: str) -> None:
    unilateral = strip(seed=seed, protocol=protocol, tolerance=Fraction(1, 10**20)).run()
    bilateral = strip(
        seed=seed, bilateral=True, tolerance=Fraction(1, 10**20), certified=True
    ).run()
    (network,) = unilateral.answer.networks
    assert network.events == 0
    known = {(row["i"], row["j"], row["branch"]): row for row in bilateral.decimals()}
    for row in unilateral.decimals():
        other = known[row["i"], row["j"], row["branch"]]
        apart = abs(Fraction(row["force"]) - Fraction(other["force"]))
        assert apart < Fraction(1, 10**19)


@pytest.mark.long
@pytest.mark.parametrize(
    "load", [fd.BulkLoad(), fd.SurfaceLoad(angle_deg=10), fd.PointLoad(at=[0, 8])], ids=str
)
@pytest.mark.parametrize("protocol", PROTOCOLS)
def test_all_loads_come_to_rest(load: fd.Load, protocol: str) -> None:
    outcome = strip(std=0.03, load=load, protocol=protocol).run()
    assert outcome.accuracy.certified
    assert outcome.answer.networks[0].events > 0


@pytest.mark.long
@pytest.mark.parametrize(
    ("std", "width", "seed"),
    [(0.03, 16, 3), (0.08, 16, 3), (0.12, 16, 3), (0.3, 16, 1), (0.354, 5, 1)],
)
def test_what_cannot_be_deposited_starts_from_a_stretched_lattice(
    std: float, width: int, seed: int, tmp_path: Path
) -> None:
    """Up to 4 M*; as deposited, these have overlaps or beads that can't rest."""
    outcome = strip(std=std, seed=seed, width=width).run()
    assert outcome.answer.networks[0].events > 0
    assert proved(outcome, tmp_path)


@pytest.mark.long
def test_beads_that_fall_through_the_base_are_told() -> None:
    """Radii down to 0.48 r, 3 r apart: four weightless beads fall, all others come to rest."""
    with pytest.raises(UnfinishedError, match=r"bead 23 fell through the base, and 3 more"):
        strip(std=0.3, seed=3).run()


@pytest.mark.parametrize("protocol", PROTOCOLS)
@pytest.mark.parametrize("second", [0.5, 0.6])
def test_beads_of_the_base_that_overlap_or_touch_are_no_answer(
    protocol: str, second: float
) -> None:
    """Their centres are 3 apart, their radii 1.5 and as much or more."""
    with pytest.raises(UnfinishedError, match="beads 2 and 1 overlap, or can't be told"):
        own({(0, 1): 0.5, (0, 2): second}, protocol=protocol).run()


def test_beads_of_the_base_that_overlap_are_told_before_others_move() -> None:
    """Of radii up to 1.56 two neighbours need more than 3."""
    with pytest.raises(UnfinishedError, match="beads 3 and 4 of the base overlap"):
        strip(std=0.354, seed=3, width=5).run()


@pytest.mark.parametrize("radius", [1.9, 2.3])
def test_beads_above_a_quarter_of_the_period_are_no_answer(radius: float) -> None:
    """A period of 7.5: what touches such a bead may touch its image as well."""
    with pytest.raises(UnfinishedError, match="bead 7 is so large"):
        own({(2, 1): radius - 1}, width=3, spacing=2.5).run()


def own(
    deviations: dict[tuple[int, int], float], width: int = 5, spacing: float = 3, **effects: str
) -> fd.Scene:
    """Two layers of beads on the base, of radius 1 but for those named (layer, column)."""
    delta = np.zeros((3, width))
    for at, value in deviations.items():
        delta[at] = value
    return fd.Scene(
        packing=fd.Packing(height=2, width=width, spacing=spacing, allow_images=True),
        disorder=fd.GivenRadii(delta_r=delta),
        load=fd.SurfaceLoad(),
        effects=fd.Effects(contacts="unilateral", **effects),
        ask=fd.Ask(quantity="contact_forces"),
    )


@pytest.mark.long(sample=1)
@pytest.mark.parametrize("tiny", ["1e-9", "1e-14", "1e-300"])
@pytest.mark.parametrize("protocol", PROTOCOLS)
def test_a_bead_that_bears_next_to_nothing_is_held_or_is_no_answer(
    protocol: str, tiny: str, tmp_path: Path
) -> None:
    """One bead of the surface bears so little that its contacts may count as bearing nothing."""
    rows = [f"{i},8,0,{'-' + tiny if i == 6 else -1}" for i in range(0, 32, 2)]
    (tmp_path / "loads.csv").write_text("\n".join(["i,j,fx,fy", *rows, ""]))
    load = fd.Load(kind="file", file="loads.csv")
    scene = strip(load=load, protocol=protocol).model_copy(update={"folder": tmp_path})
    try:
        outcome = scene.run()
    except UnfinishedError as error:
        assert "bead 131 bears a load, and no contact holds it" in str(error)  # noqa: PT017
    else:
        assert outcome.answer.networks[0].events > 0
        assert 131 in outcome.answer.networks[0].pairs
        assert proved(outcome, tmp_path)


@pytest.mark.long
def test_under_no_load_to_speak_of_beads_are_no_equilibrium(tmp_path: Path) -> None:
    """The load sinks to the base; it was called a strict minimum with all others in the air."""
    with pytest.raises(UnfinishedError, match="bears a load, and no contact holds it"):
        strip(load=pressed(1e-12, tmp_path)).run()


@pytest.mark.parametrize("width", [3, 4])
def test_narrow_strips(width: int) -> None:
    outcome = strip(std=0.03, seed=2, width=width).run()
    assert all(force > 0 for force in outcome.answer.networks[0].forces)


def test_a_load_that_lifts_beads_off_is_never_an_answer() -> None:
    with pytest.raises((UnfinishedError, ToleranceError)):
        strip(load=fd.SurfaceLoad(angle_deg=180)).run()


@pytest.mark.long(sample=1)
def test_every_question_is_answered(relaxed: fd.Outcome) -> None:
    protocol = relaxed.plan.problem.protocol
    (network,) = relaxed.answer.networks
    total = float(sum(network.forces[1:], network.forces[0]))
    profile = strip("profile", protocol=protocol).run().arrays
    assert (profile["mean"].astype(float) * profile["samples"]).sum() == pytest.approx(total)
    counts = strip("histogram", protocol=protocol).run().arrays["count"]
    assert counts.sum() == len(network.forces)
    row = relaxed.rows()[5]
    at = [row["i"], row["j"], row["branch"]]
    (one,) = strip("contact", protocol=protocol, at=at).run().rows()
    assert one["force"] == row["force"]
    positions = strip("positions", protocol=protocol).run().arrays
    assert len(positions["x"]) == len(network.x)
    assert (positions["contacts"][network.rattlers] == 0).all()


@pytest.mark.long
def test_the_event_driven_energy_never_rises(monkeypatch: pytest.MonkeyPatch) -> None:
    from force_diffusion.numeric.unilateral import event_driven

    energies: list[float] = []
    step = event_driven._step

    def watched(grains: Any, *rest: Any) -> Any:
        met = step(grains, *rest)
        energies.append(grains.energy())
        return met

    monkeypatch.setattr(event_driven, "_step", watched)
    strip(protocol="event-driven", load=fd.SurfaceLoad(angle_deg=10), std=0.03).run()
    assert len(energies) > 10
    # each is a sum of 16 terms of size 20, rounded
    assert np.diff(energies).max() < 1e-12


@pytest.mark.parametrize(
    ("effects", "packing", "words"),
    [
        ({"geometry": "first-order"}, {}, "effects.geometry"),
        ({"stop_at_tension": True}, {}, "effects.stop_at_tension"),
        ({}, {"width": None}, "packing.width"),
        ({}, {"width": 2}, "packing.width"),
    ],
)
def test_what_has_no_meaning_is_refused(
    effects: dict[str, Any], packing: dict[str, Any], words: str
) -> None:
    with pytest.raises(fd.SceneError, match=words):
        fd.Scene(
            packing=fd.Packing(**{"height": 8, "width": 16, "allow_images": True, **packing}),
            effects=fd.Effects(contacts="unilateral", **effects),
            ask=fd.Ask(quantity="profile"),
        )


@pytest.mark.parametrize(
    "effects", [{"protocol": "event-driven"}, {"most_events": 3}, {"most_seconds": 1}]
)
def test_keys_of_protocols_alone_are_refused(effects: dict[str, Any]) -> None:
    with pytest.raises(fd.SceneError, match="unilateral"):
        fd.Scene(
            packing=fd.Packing(height=2, width=4),
            effects=fd.Effects(**effects),
            ask=fd.Ask(quantity="profile"),
        )


@pytest.mark.parametrize("protocol", PROTOCOLS)
@pytest.mark.parametrize("limit", [{"most_events": 3}, {"most_seconds": 1e-6}])
def test_limits_give_up_in_words(protocol: str, limit: dict[str, Any]) -> None:
    scene = strip(protocol=protocol, seed=3)
    effects = fd.Effects(contacts="unilateral", protocol=protocol, **limit)
    with pytest.raises(UnfinishedError, match=next(iter(limit))):
        scene.model_copy(update={"effects": effects}).run()


def test_enough_events_change_nothing(relaxed: fd.Outcome) -> None:
    protocol = relaxed.plan.problem.protocol
    (network,) = relaxed.answer.networks
    effects = fd.Effects(contacts="unilateral", protocol=protocol, most_events=network.events)
    again = strip(protocol=protocol).model_copy(update={"effects": effects}).run()
    assert again.rows() == relaxed.rows()


def test_quantities_are_the_same_under_the_effect() -> None:
    from force_diffusion.numeric.quantities import QUANTITIES
    from force_diffusion.numeric.quantities.contacts_that_open import NETWORK_QUANTITIES

    assert set(QUANTITIES) == set(NETWORK_QUANTITIES)
    assert all(issubclass(one, Quantity) for one in NETWORK_QUANTITIES.values())  # type: ignore[arg-type]


@pytest.mark.long
def test_statistics_end_where_they_scatter_from_packing_to_packing() -> None:
    found = strip("profile", realisations=4).run()
    for row, shown in zip(found.rows(), found.decimals(), strict=True):
        if row["samples"] < 10:  # two beads of the surface, in two packings
            assert shown["std_error"] == ""
            continue
        for name in ("mean", "std"):
            error = row[f"{name}_error"]
            assert abs(float(shown[name]) - row[name]) <= error / 10
            assert len(shown[name]) <= 6  # 0.764 ± 0.017, and no digits of these very packings
        assert row["std_over_mean"] == pytest.approx(row["std"] / row["mean"])
        assert len(shown["std_over_mean"]) <= 6


def test_a_scatter_too_small_for_its_balls_is_zero_and_has_no_error() -> None:
    scene = fd.Scene(
        packing=fd.Packing(height=4, width=6, spacing=2.5),
        disorder=fd.Disorder(kind="normal", relative_std=1e-100, seed=795),
        load=fd.BulkLoad(),
        effects=fd.Effects(contacts="unilateral"),
        ask=fd.Ask(quantity="profile", realisations=5),
    )
    for row in scene.run().decimals():
        assert (row["std"], row["std_error"], row["std_over_mean"]) == ("0", "", "0")
    (one, *_) = strip("profile").run().decimals()
    assert one["std_error"] == ""  # of one packing no scatter is known
    assert len(one["std"]) > 20


def proved(outcome: fd.Outcome, folder: Path) -> bool:
    return written(outcome, folder, lambda packing: None).proved


@pytest.mark.long
@pytest.mark.parametrize(
    ("protocol", "surface"),
    [("linear-programs", 0.1), ("linear-programs", 10), ("event-driven", 10)],
)
def test_a_point_load_beside_a_surface_load(protocol: str, surface: float, tmp_path: Path) -> None:
    """Where the surface bears little, the load sinks and pushes beads aside: they rattle."""
    outcome = strip(load=pressed(surface, tmp_path), protocol=protocol).run()
    (network,) = outcome.answer.networks
    assert network.events > 0
    height = float(network.x[8 * 16, 1])
    assert (height < 5) if surface < 1 else (10 < height < 11)  # deposited at 10.6
    assert (len(network.rattlers) > 10) == (surface < 1)
    assert proved(outcome, tmp_path)
    base = -network.frame.load[:16, 1].astype(float)  # each carries its own load
    np.add.at(base, network.pairs[:, 1][network.pairs[:, 1] < 16],
              network.pushes()[network.pairs[:, 1] < 16, 1].astype(float))  # fmt: skip
    assert base.sum() == pytest.approx(1 + 16 * surface)


@pytest.mark.parametrize("protocol", PROTOCOLS)
@pytest.mark.parametrize(("angle", "stands"), [(48, True), (49, False), (-49, False)])
def test_the_base_holds_loads_that_lean_less_than_its_contacts(
    protocol: str, angle: int, stands: bool
) -> None:
    """Beads between two of the base touch them at asin(3/4) = 48.6° to the vertical."""
    scene = strip(std=0, load=fd.SurfaceLoad(angle_deg=angle), protocol=protocol)
    if stands:
        assert scene.run().answer.networks[0].events == 0
    else:
        with pytest.raises(UnfinishedError, match=r"leans by 49° .* against 48.59°"):
            scene.run()


def test_a_small_bead_is_held_at_the_side_of_a_large_one() -> None:
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
            must_hold(grains)
        else:
            with pytest.raises(UnfinishedError, match="no packing can stand"):
                must_hold(grains)


@pytest.mark.long
def test_a_motion_that_gets_stuck_ends(monkeypatch: pytest.MonkeyPatch) -> None:
    """Here steps shrink to nothing, though forces say that energy falls."""
    scene = fd.Scene(
        packing=fd.Packing(height=9, width=11, allow_images=True),
        disorder=fd.Disorder(kind="uniform", relative_std=0.03, seed=751671),
        load=fd.SurfaceLoad(angle_deg=-20),
        effects=fd.Effects(contacts="unilateral", protocol="event-driven"),
        ask=fd.Ask(quantity="profile"),
    )
    with pytest.raises(UnfinishedError, match="however small"):
        scene.run()
    monkeypatch.setattr(event_driven, "MOST_STEPS", 1)
    with pytest.raises(UnfinishedError, match="no pair met in 1 steps"):
        scene.run()


@pytest.mark.long
def test_contacts_that_stop_being_independent_are_no_answer(tmp_path: Path) -> None:
    """Beads that bear next to nothing are pushed aside until two contacts hold the same."""
    with pytest.raises(UnfinishedError, match="independent"):
        strip(load=pressed(0.01, tmp_path), protocol="event-driven").run()


@pytest.mark.parametrize("protocol", PROTOCOLS)
@pytest.mark.parametrize("load", [fd.SurfaceLoad(angle_deg=20), fd.BulkLoad()], ids=str)
def test_equal_radii_rest_as_deposited(protocol: str, load: fd.Load, tmp_path: Path) -> None:
    outcome = strip(std=0, load=load, protocol=protocol).run()
    assert outcome.answer.networks[0].events == 0
    assert proved(outcome, tmp_path)


def test_equal_radii_under_one_load_are_no_strict_minimum(tmp_path: Path) -> None:
    """Two straight chains bear it, whose beads nothing presses from the side."""
    outcome = strip(std=0, load=fd.PointLoad(at=[0, 8])).run()
    assert len(outcome.answer.networks[0].pairs) == 16
    assert "strict" not in outcome.data()["networks"][0]["rest"]
    assert not proved(outcome, tmp_path)


@pytest.mark.parametrize("seed", [2, 4])
@pytest.mark.parametrize("width", [3, 4, 5])
def test_narrow_strips_are_proved(width: int, seed: int, tmp_path: Path) -> None:
    assert proved(strip(std=0.03, seed=seed, width=width).run(), tmp_path)


@pytest.mark.long
def test_an_inclined_load_on_a_larger_strip(tmp_path: Path) -> None:
    outcome = strip(width=40, load=fd.SurfaceLoad(angle_deg=10)).run()
    (network,) = outcome.answer.networks
    assert network.events > 0
    assert proved(outcome, tmp_path)


@pytest.mark.long
def test_rattlers_touch_nothing(tmp_path: Path) -> None:
    """Beads that lost a load above them, or a support: each has room on all sides."""
    (network,) = strip(load=pressed(0.1, tmp_path)).run().answer.networks
    assert len(network.rattlers)
    assert not np.isin(network.rattlers, network.pairs).any()
    x, radii = network.x.astype(float), network.frame.radii.astype(float)
    period = float(network.frame.period)
    for a in network.rattlers:
        d = np.delete(x, a, axis=0) - x[a]
        d[:, 0] -= period * np.round(d[:, 0] / period)
        assert (np.hypot(*d.T) - np.delete(radii, a) - radii[a]).min() > 0
