"""What is summed up of each packing: the same to the bit however realisations are put together."""

import math
from contextlib import suppress
from fractions import Fraction
from functools import reduce
from operator import add
from typing import Any

import numpy as np
import pytest
from force_diffusion.numeric.arithmetic.systems import FLOAT64, Array
from force_diffusion.numeric.ensemble import sums
from force_diffusion.numeric.ensemble.estimates import Estimates
from force_diffusion.numeric.ensemble.measure import Measurement, measurement
from force_diffusion.numeric.ensemble.sums import Sums, from_bytes, measured
from force_diffusion.numeric.mechanics import engine
from force_diffusion.numeric.mechanics.engine import solve
from force_diffusion.numeric.mechanics.problem import Route
from force_diffusion.numeric.mechanics.work import Work
from force_diffusion.numeric.run import run
from force_diffusion.numeric.scene.sections import SceneError
from hypothesis import given
from hypothesis import strategies as st

from tests.numeric.ensemble.cases import CASES, PROFILE, case
from tests.numeric.scenes import planned, scene

ALL = pytest.mark.parametrize("name", CASES)


def changes(m: Measurement, realisations: range) -> list[Array]:
    """The changes (groups, members) of single realisations, each solved alone."""
    with FLOAT64.active():
        alone = [m.changes(solve(m.problem, [k], FLOAT64, Work()), 1)[1] for k in realisations]
    return [g[:, 0] for g in alone]


@ALL
def test_batches_and_single_packings_give_the_same_bytes(
    name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    m = case(name, covariance=True)
    whole = measured(m, range(7)).to_bytes()
    assert reduce(add, (measured(m, [k]) for k in (3, 0, 6, 2, 5, 1, 4))).to_bytes() == whole
    monkeypatch.setattr(
        engine, "chunk_size", lambda problem, _: 1 if problem.route == Route.LINE_SUMS else 3
    )
    assert measured(m, range(7)).to_bytes() == whole
    monkeypatch.setattr(sums, "AT_ONCE", 2)
    assert measured(m, range(7)).to_bytes() == whole


@pytest.mark.parametrize("width", [5, 33, 2050])
def test_compiled_and_numpy_sweeps_give_the_same_bytes(
    width: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    pytest.importorskip("numba")
    m = measurement(scene({**PROFILE, "packing": {"height": 4, "width": width}}))
    usual = measured(m, range(3)).to_bytes()
    monkeypatch.setattr(engine, "COMPILED_FROM", 1)
    with FLOAT64.active():
        packing = solve(m.problem, [0], FLOAT64, Work()).packing
    assert packing is not None
    assert packing.memory is not None
    assert measured(m, range(3)).to_bytes() == usual


@pytest.mark.long(sample=46)
@ALL
@pytest.mark.parametrize("kind", ["uniform", "normal", "two-point"])
def test_whoever_solves_gives_the_same_bytes(
    name: str, kind: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    pytest.importorskip("numba")
    m = case(name, covariance=True, kind=kind)
    usual = measured(m, range(7)).to_bytes()
    monkeypatch.setattr(engine, "COMPILED_FROM", 1)
    if m.problem.route == Route.EXACT:
        with FLOAT64.active():
            solved = solve(m.problem, [0], FLOAT64, Work())
        assert solved.forces is not None
        assert solved.forces.g is not None
    assert measured(m, range(7)).to_bytes() == usual
    assert reduce(add, (measured(m, [k]) for k in (3, 0, 6, 2, 5, 1, 4))).to_bytes() == usual
    monkeypatch.setattr(engine, "chunk_size", lambda *_: 1)
    assert measured(m, range(7)).to_bytes() == usual


def test_what_compiled_sums_refuse_is_summed_up_by_the_others(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    pytest.importorskip("numba")
    from force_diffusion.numeric.statistics import compiled

    m, taken = case("histogram of all"), compiled.Tally.add
    usual, asked = measured(m, range(7)).to_bytes(), []

    def refusing(tally: compiled.Tally, g: Array) -> Array | None:
        asked.append(len(g))
        return None if len(asked) % 2 else taken(tally, g)

    monkeypatch.setattr(engine, "COMPILED_FROM", 1)
    monkeypatch.setattr(engine, "at_once", lambda *_: 2)
    monkeypatch.setattr(compiled.Tally, "add", refusing)
    assert measured(m, range(7)).to_bytes() == usual
    assert asked == [2, 2, 2, 1]


@ALL
def test_sums_are_those_of_the_changes_as_fractions(name: str) -> None:
    m, N = case(name, covariance=True), 3
    found = Estimates(m, measured(m, range(N)))
    g = [
        [[Fraction(float(v)) for v in group] for group in packing]
        for packing in changes(m, range(N))
    ]
    for k in range(m.groups):
        every = [v for packing in g for v in packing[k]]
        mean = sum(every) / len(every)
        assert found.mean[k] == mean
        assert found.variance[k] == sum((v - mean) ** 2 for v in every) / len(every)
        assert found.std[k] == pytest.approx(math.sqrt(found.variance[k]), rel=1e-15)
    # scatter over packings, from numbers that are rounded once a packing
    a = np.array([[float(sum(group) / m.members) for group in packing] for packing in g])
    b = np.array([[float(sum(v * v for v in group) / m.members) for group in p] for p in g])
    assert found.mean_error == pytest.approx(a.std(axis=0, ddof=1) / math.sqrt(N), rel=1e-9)
    linear = (b - 2 * a.mean(axis=0) * a).std(axis=0, ddof=1) / math.sqrt(N)
    std = np.array(found.std)
    some = std > 0
    expected = linear[some] / (2 * std[some])
    assert np.array(found.std_error)[some].astype(float) == pytest.approx(expected, rel=1e-9)
    x = b if m.quantity == "profile" else a
    meant = np.cov(x, rowvar=False).reshape(m.groups, m.groups)
    assert found.covariance() == pytest.approx(meant, rel=1e-7, abs=1e-9 * abs(meant).max())


def test_a_profile_is_that_of_run() -> None:
    outcome = run(planned({**PROFILE, "ask": {"quantity": "profile", "realisations": 6}}))
    found = Estimates(m := case("profile"), measured(case("profile"), range(6)))
    assert m.labels == {n: [row[n] for row in outcome.decimals()] for n in ("j", "branch")}
    for name, values in (("std", found.std), ("mean_change", [float(v) for v in found.mean])):
        meant = outcome.arrays[name].tolist()
        assert values == pytest.approx(meant, rel=1e-12, abs=1e-15 * max(found.std))
    assert [float(v) for v in m.ordered()] == pytest.approx([1 / math.sqrt(7 / 4)] * 8)


@pytest.mark.parametrize("name", ["response", "all contacts", "contact of a slab"])
def test_labels_and_changes_are_those_of_run(name: str) -> None:
    m = case(name)
    outcome = run(planned(CASES[name]))
    rows = {(r["i"], r["j"], r["branch"]): r for r in outcome.rows()}
    assert len(rows) * (2 if name == "response" else 1) == m.groups
    contacts = zip(m.labels["i"], m.labels["j"], m.labels["branch"], strict=True)
    meant, ordered = [], []
    for k, contact in enumerate(contacts):
        vertical = "component" in m.labels and m.labels["component"][k] == "vertical"
        meant.append(rows[contact]["vertical_change" if vertical else "change"])
        ordered.append(rows[contact]["vertical" if vertical else "force"])
    (found,) = changes(m, range(1))
    assert found[:, 0].tolist() == pytest.approx(meant, rel=1e-9, abs=1e-16)
    total = [float(F) + g for F, g in zip(m.ordered(), found[:, 0], strict=True)]
    assert total == pytest.approx(ordered, rel=1e-9, abs=1e-12)


@pytest.mark.parametrize("name", ["histogram of all", "histogram of one"])
def test_bins_are_fixed_and_count_everything(name: str) -> None:
    m, N = case(name), 5
    found = measured(m, range(N))
    edges = np.array([-math.inf, *m.edges, math.inf])
    counts = [np.histogram(g, edges)[0] for g in changes(m, range(N))]
    assert found.bins[0].tolist() == np.sum(counts, axis=0).tolist()
    assert found.bins[1].tolist() == np.sum(np.square(counts), axis=0).tolist()
    assert found.bins[0].sum() == N * m.members
    assert m.edges == tuple(-edge for edge in reversed(m.edges))


def test_the_smallest_disorder_keeps_all_digits() -> None:
    def relative(std: str) -> list[float]:
        m = case("profile, first order", relative_std=f"={std}")
        found = Estimates(m, measured(m, range(4)))
        both = zip(found.variance, found.std_error, strict=True)
        assert all(error is not None and error > 0 for _, error in both)
        return [float(v / Fraction(std) ** 2) for v in found.variance]

    usual = relative("1e-3")
    for std in ("1e-9", "1e-160", "1e-300"):
        assert relative(std) == pytest.approx(usual, rel=1e-12)


@given(st.data())
def test_bytes_that_are_no_sums_are_refused(data: st.DataObject) -> None:
    m = case("histogram of all")
    written = measured(m, range(2)).to_bytes()
    assert from_bytes(written, m).to_bytes() == written
    wrong = bytearray(written)
    if data.draw(st.booleans()):
        wrong = wrong[: data.draw(st.integers(0, len(written) - 1))]
        with pytest.raises(ValueError, match="end"):
            from_bytes(bytes(wrong), m)
        return
    wrong[data.draw(st.integers(0, len(written) - 1))] ^= 1 << data.draw(st.integers(0, 7))
    with suppress(ValueError):  # whatever is read, it is read without harm; checksums tell
        assert isinstance(from_bytes(bytes(wrong), m), Sums)


@pytest.mark.parametrize(
    ("change", "says"),
    [
        ({"ask": {"quantity": "positions"}}, "ask.quantity"),
        ({"ask": {"quantity": "profile", "tolerance": "=1e-9"}}, "ask.tolerance"),
        ({"effects": {"stop_at_tension": True}}, "stop_at_tension"),
        ({"effects": {"geometry": "ordered"}}, "every realisation would be the same"),
        ({"disorder": {"kind": "file", "file": "radii.csv"}}, "drawn"),
        ({"disorder": {"kind": "normal", "relative_std": "=0.0"}}, "the same"),
        (
            {"ask": {"quantity": "histogram"}, "load": {"kind": "point", "at": [0, 4]}},
            "--reach",
        ),
        (
            {"packing": {"height": 100, "width": 101}, "ask": {"quantity": "contact_forces"}},
            "20200",
        ),
    ],
)
def test_what_has_no_statistics_is_refused(change: dict[str, Any], says: str) -> None:
    with pytest.raises(SceneError, match=says):
        measurement(scene({**PROFILE, **change}), covariance=True)
