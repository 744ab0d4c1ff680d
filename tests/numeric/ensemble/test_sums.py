"""What is summed up of each packing: the same to the bit however realisations are put together."""

import math
from collections.abc import Iterator, Sequence

import numpy as np
import pytest
from force_diffusion.numeric.arithmetic.systems import FLOAT64, Array
from force_diffusion.numeric.ensemble import sums
from force_diffusion.numeric.ensemble.sums import Measurement, measurement, solve_block
from force_diffusion.numeric.mechanics.engine import solve
from force_diffusion.numeric.mechanics.work import Work
from force_diffusion.numeric.run.running import run
from force_diffusion.numeric.scene.sections import SceneError

from tests.numeric.ensemble.cases import CASES, PROFILE, case, ensemble_of, first
from tests.numeric.scenes import planned, scene

ALL = pytest.mark.parametrize("name", CASES)


def changes(m: Measurement, realisations: range) -> list[Array]:
    """The changes (groups, members) of single realisations, each solved alone."""
    with FLOAT64.active():
        alone = [
            m.quantity.changes(m.problem, solve(m.problem, [k], FLOAT64, Work()), 1)[1]
            for k in realisations
        ]
    return [g[:, 0] for g in alone]


@pytest.mark.long(sample=17)
@ALL
@pytest.mark.parametrize("kind", ["uniform", "normal", "two-point"])
@pytest.mark.parametrize("std", ["=1e-4", "=0.12"])
def test_batches_and_single_packings_give_the_same_bytes(name, kind, std, monkeypatch):
    """In rough packings contacts pull, and some can't be built."""
    m = case(name, kind=kind, relative_std=std)
    usual = solve_block(m, 0, 7).to_bytes()
    alone = sums._solved

    def one_by_one(m: Measurement, numbers: Sequence[int]) -> Iterator[sums._Solved]:
        for number in numbers:
            yield from alone(m, [number])

    monkeypatch.setattr(sums, "_solved", one_by_one)
    assert solve_block(m, 0, 7).to_bytes() == usual


@ALL
def test_estimates_are_those_of_the_changes(name):
    """Within 10⁻¹³ of what they are made of; their standard errors are 10⁻² of them here."""
    m, N = case(name), 5
    ensemble = ensemble_of(m, N)
    names = [n for n in ("j", "i", "p", "q", "branch", "component") if n in m.labels]
    rows = sorted(range(m.groups), key=lambda k: [m.labels[name][k] for name in names])
    g = np.array(changes(m, range(N)))[:, rows]  # (packings, groups, members)
    mean, std = g.mean(axis=(0, 2)), g.std(axis=(0, 2))
    assert ensemble.mean_change == pytest.approx(mean, rel=1e-13, abs=2e-15 * std.max())
    assert ensemble.std == pytest.approx(std, rel=1e-13)
    assert ensemble.mean_square == pytest.approx(std**2 + mean**2)
    # scatter over packings
    own, square = g.mean(axis=2), (g * g).mean(axis=2)
    error, error_of_square = (
        x.std(axis=0, ddof=1) / math.sqrt(N) for x in (own, square - 2 * own.mean(axis=0) * own)
    )
    assert ensemble.mean_change_error == pytest.approx(error, rel=1e-12)
    with np.errstate(invalid="ignore"):  # where nothing varies no error is known
        expected = std * np.expm1(error_of_square / std**2) / 2
    assert ensemble.std_error == pytest.approx(expected, rel=1e-11, nan_ok=True)


def test_a_profile_is_that_of_run():
    outcome = run(planned({**PROFILE, "ask": {"quantity": "profile", "realisations": 6}}))
    ensemble = ensemble_of(m := case("profile"), 6)
    assert m.labels == {n: [row[n] for row in outcome.decimals()] for n in ("j", "branch")}
    for name in ("samples", "mean", "mean_change", "std", "std_over_mean"):
        same = pytest.approx(outcome.arrays[name], rel=1e-12, abs=1e-15 * max(ensemble.std))
        assert ensemble.arrays[name] == same
    for name in ("std", "mean_change"):
        errors = ensemble.arrays[f"{name}_error"]
        assert errors == pytest.approx(outcome.standard_errors[name], rel=1e-9)


@pytest.mark.parametrize("name", ["response", "all contacts", "contact of a slab"])
def test_labels_and_changes_are_those_of_run(name):
    m = case(name)
    outcome = run(planned(CASES[name]))
    rows = {(r["i"], r["j"], r["branch"]): r for r in outcome.rows()}
    assert len(rows) * (2 if name == "response" else 1) == m.groups
    contacts = zip(m.labels["i"], m.labels["j"], m.labels["branch"], strict=True)
    expected, ordered = [], []
    for k, contact in enumerate(contacts):
        vertical = "component" in m.labels and m.labels["component"][k] == "vertical"
        expected.append(rows[contact]["vertical_change" if vertical else "change"])
        ordered.append(rows[contact]["vertical" if vertical else "force"])
    (values,) = changes(m, range(1))
    assert values[:, 0].tolist() == pytest.approx(expected, rel=1e-9, abs=1e-16)
    total = [float(F) + g for F, g in zip(m.ordered(), values[:, 0], strict=True)]
    assert total == pytest.approx(ordered, rel=1e-9, abs=1e-12)
    assert first(m, 1).tensile.tolist() == [force < 0 for force in total]


@pytest.mark.parametrize("name", ["histogram of all", "histogram of one"])
def test_bins_are_fixed_and_count_everything(name):
    m, N = case(name), 5
    totals = first(m, N)
    edges = np.array([-math.inf, *m.edges, math.inf])
    counts = [np.histogram(g, edges)[0] for g in changes(m, range(N))]
    assert totals.bins[0].tolist() == np.sum(counts, axis=0).tolist()
    assert totals.bins[1].tolist() == np.sum(np.square(counts), axis=0).tolist()
    assert totals.bins[0].sum() == N * m.members
    shares = np.array(counts) / m.members
    bins = ensemble_of(m, N).bins
    assert bins is not None
    assert bins["share"] == pytest.approx(shares.mean(axis=0))
    assert bins["share_error"] == pytest.approx(shares.std(axis=0, ddof=1) / math.sqrt(N))
    assert m.edges == tuple(-edge for edge in reversed(m.edges))


def test_the_smallest_disorder_keeps_all_digits():
    def relative(std: str) -> Array:
        m = case("profile, first order", relative_std=f"={std}")
        ensemble = ensemble_of(m, 4)
        assert (ensemble.std_error > 0).all()
        return np.array([ensemble.std, ensemble.std_error]) / float(std)

    usual = relative("1e-3")
    for std in ("1e-9", "1e-160", "1e-300"):
        assert relative(std) == pytest.approx(usual, rel=1e-12)


@pytest.mark.parametrize(
    ("change", "says"),
    [
        ({"effects": {"geometry": "ordered"}}, "every realisation would be the same"),
        ({"disorder": {"kind": "normal", "relative_std": "=0.0"}}, "the same"),
        ({"ask": {"quantity": "histogram"}, "load": {"kind": "point", "at": [0, 4]}}, "--reach"),
    ],
)
def test_what_has_no_statistics_is_refused(change, says):
    with pytest.raises(SceneError, match=says):
        measurement(scene({**PROFILE, **change}))
