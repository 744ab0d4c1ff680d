"""Ensembles of packings whose contacts are unilateral."""

from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from force_diffusion.numeric.ensemble.measure import measurement
from force_diffusion.numeric.ensemble.run import RealisationError
from force_diffusion.numeric.ensemble.sums import from_bytes
from force_diffusion.numeric.statistics.ratios import moments

import force_diffusion as fd
from tests.numeric.ensemble.cases import bytes_of_first


def strip(quantity: str = "profile", **more: Any) -> fd.Scene:
    """Give a strip of 6 layers in which about half of the packings have tension."""
    effects: dict[str, Any] = {"contacts": "unilateral"}
    if protocol := more.pop("protocol", None):
        effects["protocol"] = protocol
    return fd.Scene(
        packing=fd.Packing(height=6, width=12),
        disorder=fd.Disorder(kind="uniform", relative_std=more.pop("std", 0.02), seed=1),
        load=more.pop("load", fd.SurfaceLoad()),
        effects=fd.Effects(**more.pop("effects", effects)),
        ask=fd.Ask(quantity=quantity, **more),
    )


@pytest.mark.parametrize("load", [fd.SurfaceLoad(), fd.BulkLoad()], ids=["surface", "bulk"])
def test_without_tension_it_is_the_ensemble_of_the_lattice(load: fd.Load) -> None:
    """Layer by layer, over both branches; σ/r is small, so that no digit may be cancelled."""
    opened = fd.ensemble(strip(std=1e-7, load=load), 8)
    closed = fd.ensemble(strip(std=1e-7, load=load, effects={}), 8)
    assert (opened.samples, opened.index["j"].tolist()) == (8 * 2 * 6 * 12, list(range(6)))
    np.testing.assert_allclose(opened.mean, closed.mean.reshape(6, 2).mean(axis=1), rtol=1e-13)
    # rounded forces of size 1 to 6 leave 1e-15 of changes of 1e-6; their squares twice that share
    mean, square = (
        values.reshape(6, 2).mean(axis=1) for values in (closed.mean_change, closed.mean_square)
    )
    np.testing.assert_allclose(opened.std, np.sqrt(square - mean**2), rtol=1e-8)


@pytest.fixture(scope="module")
def six() -> fd.Ensemble:
    return fd.ensemble(strip(), 6)


def test_it_holds_what_runs_of_each_packing_give(six: fd.Ensemble) -> None:
    scene = strip("contact_forces", realisations=6)
    rows = scene.run().arrays
    force, layer = rows["force"].astype(float), rows["j"]
    for j, samples, mean, std in zip(
        six.index["j"], six.arrays["samples"], six.mean, six.std, strict=True
    ):
        own = force[layer == j]
        assert len(own) == samples
        assert mean == pytest.approx(own.mean(), rel=1e-13)
        assert std == pytest.approx(own.std(), rel=1e-12)
    assert any(network.events for network in scene.run().answer.networks)


def test_neither_workers_nor_an_interruption_change_a_digit(
    six: fd.Ensemble, tmp_path: Path
) -> None:
    store = tmp_path / "store"

    def interrupt(done: int, width: float | None) -> None:
        if done == 2:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        fd.ensemble(strip(), 6, store=store, progress=interrupt)
    assert fd.read_store(store).realisations == 2
    again = fd.ensemble(strip(), 6, store=store, workers=2)
    assert again.solved == 4
    assert again.data() == six.data()


def test_what_does_not_come_to_rest_is_counted() -> None:
    """About half of these packings rest as deposited, and all others need more programs."""
    effects = {"contacts": "unilateral", "most_events": 2}
    found = fd.ensemble(strip(effects=effects), 12)
    assert 0 < found.unbuildable < 12
    assert found.realisations + found.unbuildable == 12
    first = found.data()["ensemble"]["first_unbuildable"]
    scene = strip("contact_forces", effects=effects, realisations=first + 1)
    with pytest.raises(fd.ForceDiffusionError) as raised:
        scene.run()
    assert raised.value.__notes__ == [f"realisation {first}; an ensemble leaves such out"]
    assert "come to rest" in str(found)


def test_where_none_comes_to_rest_it_says_why() -> None:
    load = fd.SurfaceLoad(angle_deg=60)
    with pytest.raises(RealisationError, match=r"2 of 2 .* realisation 0: no packing can stand"):
        fd.ensemble(strip(load=load), 2)


def test_where_none_comes_to_rest_within_the_limits_the_status_is_3() -> None:
    limited = strip(std=0.06, effects={"contacts": "unilateral", "most_events": 1})
    with pytest.raises(RealisationError, match=r"2 of 2 packings are left out.*most_events") as e:
        fd.ensemble(limited, 2)
    assert e.value.exit_status == 3


def test_a_contact_that_opens_in_all_packings_has_no_ratio() -> None:
    scene = fd.Scene(
        packing=fd.Packing(height=5, width=8, spacing=2.5),
        disorder=fd.Disorder(kind="uniform", relative_std=0.06, seed=202),
        effects=fd.Effects(contacts="unilateral"),
        ask=fd.Ask(quantity="contact", at=[7, 1, "-"]),
    )
    (row,) = fd.ensemble(scene, 2).data()["results"]["contact"]
    assert (row["mean"], row["std"], row["std_over_mean"]) == ("0", "0", "")


def test_a_histogram_counts_every_force() -> None:
    found = fd.ensemble(strip("histogram", bins=10), 4)
    assert found.bins is not None
    assert found.bins["count"].sum() == found.samples
    assert found.bins["share"].sum() == pytest.approx(1)
    assert found.bins["low"][1] == 0
    assert not found.bins["count"][0]
    (axes,) = found.plot().axes
    assert axes.get_xlabel() == "$f$"


def test_a_response_is_what_beads_bear() -> None:
    """A single load on weightless beads pushes them aside: wherever it goes, the base bears it."""
    scene = strip("response", load=fd.PointLoad(at=[0, 6]), realisations=3)
    found = fd.ensemble(scene)
    assert found.mean[found.index["j"] == 0].sum() == pytest.approx(1)
    rows = scene.run().arrays
    for i, j, mean in zip(found.index["i"], found.index["j"], found.mean, strict=True):
        own = (rows["i"] == i) & (rows["j"] == j)
        assert mean == pytest.approx(rows["vertical"][own].astype(float).sum() / 3)


def test_standard_errors_are_those_of_the_jackknife() -> None:
    """Leaving out one packing after the other knows nothing of ratios."""
    rng = np.random.default_rng(1)
    packings = [rng.gamma(2 + size / 9, size=size) for size in rng.integers(3, 30, 400)]
    sums = np.array([[[len(p)], [p.sum()], [(p**2).sum()]] for p in packings])
    *_, of_mean, of_std = moments(*np.swapaxes(sums, 0, 1))
    whole = sums.sum(axis=0)[:, 0]
    left = whole - sums[:, :, 0]
    means = left[:, 1] / left[:, 0]
    stds = np.sqrt(left[:, 2] / left[:, 0] - means**2)
    for error, values in ((of_mean, means), (of_std, stds)):
        jackknife = np.sqrt(((values - values.mean()) ** 2).sum() * 399 / 400)
        assert error[0] == pytest.approx(jackknife, rel=0.02)  # both are good to 1/packings


def test_damaged_sums_are_refused() -> None:
    m = measurement(strip("histogram"))
    content = bytes_of_first(m, 2)
    assert from_bytes(content, m).to_bytes() == content
    nan, less = np.array([np.nan]).tobytes(), np.array([-1]).tobytes()
    for damaged in (b"", content[:-8], content + nan, content[:-8] + nan, less + content[8:]):
        with pytest.raises(ValueError, match="sums"):
            from_bytes(damaged, m)


@pytest.mark.parametrize("quantity", ["contact_forces", "positions"])
def test_what_has_no_statistics_is_refused(quantity: str) -> None:
    with pytest.raises(fd.SceneError, match=r"ask\.quantity"):
        fd.ensemble(strip(quantity), 2)


def test_limits_of_ensembles() -> None:
    effects = {"contacts": "unilateral", "most_events": 3}
    found = fd.ensemble(strip(effects=effects), 8)
    assert 0 < found.unbuildable < 8
    with pytest.raises(fd.SceneError, match="most_events"):
        fd.ensemble(strip(effects={"contacts": "unilateral", "most_seconds": 1}), 2)


def test_covariances_are_refused() -> None:
    with pytest.raises(fd.ForceDiffusionError, match="covariance"):
        fd.ensemble(strip(), 2, covariance=True)


@pytest.mark.parametrize("power", [-400, 300, 400])
@pytest.mark.parametrize("quantity", ["profile", "histogram"])
def test_units_beyond_floats_are_refused(quantity: str, power: int) -> None:
    load = fd.SurfaceLoad(magnitude=Fraction(10) ** power)
    with pytest.raises(fd.SceneError, match=r"^load.magnitude = .*choose another unit"):
        fd.ensemble(strip(quantity, load=load), 2)
