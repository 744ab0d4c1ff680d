"""What is summed up of each packing: the same to the bit however realisations are put together."""

import math
import statistics
from collections.abc import Iterable
from contextlib import suppress
from fractions import Fraction
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from force_diffusion.numeric.arithmetic.systems import FLOAT64, Array
from force_diffusion.numeric.ensemble import sums
from force_diffusion.numeric.ensemble.estimates import Estimates
from force_diffusion.numeric.ensemble.measure import Measurement, measurement
from force_diffusion.numeric.ensemble.sums import (
    Sums,
    blocks_of,
    from_bytes,
    measured,
    nothing,
    total,
)
from force_diffusion.numeric.mechanics import engine
from force_diffusion.numeric.mechanics.engine import solve
from force_diffusion.numeric.mechanics.problem import Route
from force_diffusion.numeric.mechanics.work import Work
from force_diffusion.numeric.run import run
from force_diffusion.numeric.scene.sections import SceneError
from hypothesis import given
from hypothesis import strategies as st

from tests.numeric.ensemble.cases import CASES, PROFILE, bytes_of_first, case, first
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


def joined_from(m: Measurement, ranges: Iterable[tuple[int, int]]) -> bytes:
    """Sum up ranges one after the other, and put them together."""
    blocks = [block for first, stop in ranges for block in measured(m, first, stop)]
    return total(m, sorted(blocks, key=lambda block: block.first)).to_bytes()


@ALL
def test_batches_and_single_packings_give_the_same_bytes(
    name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    m = case(name)
    whole = bytes_of_first(m, 7)
    assert joined_from(m, [(k, k + 1) for k in (3, 0, 6, 2, 5, 1, 4)]) == whole
    monkeypatch.setattr(
        engine, "chunk_size", lambda problem, _: 1 if problem.route == Route.LINE_SUMS else 3
    )
    assert bytes_of_first(m, 7) == whole
    monkeypatch.setattr(sums, "AT_ONCE", 2)
    assert bytes_of_first(m, 7) == whole


@given(st.lists(st.integers(1, 99), max_size=8, unique=True))
def test_however_they_are_cut_sums_are_the_same_to_the_bit(cuts: list[int]) -> None:
    m = case("profile")
    assert joined_from(m, pairwise([0, *sorted(cuts), 100])) == bytes_of_first(m, 100)


@pytest.mark.parametrize("size", [1, 2, 3, 64, 100])
def test_means_and_products_are_sound_where_means_are_large(size: int) -> None:
    """What numbers scatter by is 10⁻⁹ of them: squares of them would leave no digit of that."""
    m = case("profile")
    packings = nothing(m, size)
    drawn = 1 + 1e-9 * np.random.default_rng(size).standard_normal((size, 2, m.groups))
    packings.packings[:], packings.means[:] = (1, 0), drawn
    found = total(m, blocks_of(packings, 0))
    a = [Fraction(float(one)) for one in drawn[:, 0, 0]]
    b = [Fraction(float(one)) for one in drawn[:, 1, 0]]
    mean_a, mean_b = sum(a) / size, sum(b) / size
    assert found.means[:, 0] == pytest.approx([float(mean_a), float(mean_b)], rel=1e-15)
    products = [
        float(sum((x - of_x) * (y - of_y) for x, y in zip(p, q, strict=True)))
        for p, q, of_x, of_y in (
            (a, a, mean_a, mean_a), (a, b, mean_a, mean_b), (b, b, mean_b, mean_b),
        )
    ]  # fmt: skip
    # a mean of 1 is rounded by 10⁻¹⁶, which is 10⁻⁷ of the scatter
    assert found.products[:, 0] == pytest.approx(products, rel=1e-6, abs=1e-6 * size * 1e-18)


@pytest.mark.parametrize("width", [5, 33, 2050])
def test_compiled_and_numpy_sweeps_give_the_same_bytes(
    width: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    pytest.importorskip("numba")
    m = measurement(scene({**PROFILE, "packing": {"height": 4, "width": width}}))
    usual = bytes_of_first(m, 3)
    monkeypatch.setattr(engine, "COMPILED_FROM", 1)
    with FLOAT64.active():
        packing = solve(m.problem, [0], FLOAT64, Work()).packing
    assert packing is not None
    assert packing.memory is not None
    assert bytes_of_first(m, 3) == usual


@pytest.mark.long(sample=46)
@ALL
@pytest.mark.parametrize("kind", ["uniform", "normal", "two-point"])
@pytest.mark.parametrize("std", ["=1e-4", "=0.12"])
def test_whoever_solves_gives_the_same_bytes(
    name: str, kind: str, std: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """In rough packings contacts pull, and some can't be built."""
    pytest.importorskip("numba")
    m = case(name, kind=kind, relative_std=std)
    usual = bytes_of_first(m, 7)
    monkeypatch.setattr(engine, "COMPILED_FROM", 1)
    assert bytes_of_first(m, 7) == usual
    assert joined_from(m, [(k, k + 1) for k in (3, 0, 6, 2, 5, 1, 4)]) == usual
    monkeypatch.setattr(engine, "chunk_size", lambda *_: 1)
    assert bytes_of_first(m, 7) == usual


@pytest.mark.parametrize("name", ["profile", "histogram of all", "histogram of spheres"])
def test_what_compiled_loops_refuse_is_summed_up_by_the_others(
    name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    pytest.importorskip("numba")
    from force_diffusion.numeric.mechanics.sweeps import Sweeps

    m, taken = case(name), Sweeps.changes
    usual, asked = bytes_of_first(m, 7), []

    def refusing(sweeps: Sweeps, some: Any, descent: Any) -> Array | None:
        asked.append(len(some))
        return None if len(asked) % 2 else taken(sweeps, some, descent)

    monkeypatch.setattr(engine, "COMPILED_FROM", 1)
    monkeypatch.setattr(engine, "at_once", lambda *_: 2)
    monkeypatch.setattr(Sweeps, "changes", refusing)
    assert bytes_of_first(m, 7) == usual
    assert asked == [2, 2, 2, 1]


@ALL
def test_estimates_are_those_of_the_changes_as_fractions(name: str) -> None:
    """Within 10⁻¹³ of what they are made of; their standard errors are 10⁻² of them here."""
    m, N = case(name), 5
    found = Estimates(m, first(m, N))
    g = [
        [[Fraction(float(v)) for v in group] for group in packing]
        for packing in changes(m, range(N))
    ]
    names = [n for n in ("j", "i", "p", "q", "branch", "component") if n in m.labels]
    rows = sorted(range(m.groups), key=lambda k: [m.labels[name][k] for name in names])
    g = [[packing[k] for k in rows] for packing in g]
    std = [statistics.pstdev([v for packing in g for v in packing[k]]) for k in range(m.groups)]
    size = max(std)
    mean = [statistics.fmean([v for packing in g for v in packing[k]]) for k in range(m.groups)]
    assert found.mean_change == pytest.approx(mean, rel=1e-13, abs=1e-15 * size)
    assert found.std == pytest.approx(std, rel=1e-13)
    assert found.mean_square == pytest.approx([s**2 + a**2 for s, a in zip(std, mean, strict=True)])
    # scatter over packings
    a = [[sum(group) / m.members for group in packing] for packing in g]
    b = [[sum(v * v for v in group) / m.members for group in packing] for packing in g]
    for k in range(m.groups):
        own, square = [p[k] for p in a], [p[k] for p in b]
        root = math.sqrt(N)
        assert found.mean_change_error[k] == pytest.approx(statistics.stdev(own) / root, rel=1e-12)
        linear = [s - 2 * statistics.mean(own) * v for v, s in zip(own, square, strict=True)]
        if std[k]:
            error = statistics.stdev(linear) / root / (2 * std[k])
            assert found.std_error[k] == pytest.approx(error, rel=1e-11)
        else:
            assert math.isnan(found.std_error[k])


def test_a_profile_is_that_of_run() -> None:
    outcome = run(planned({**PROFILE, "ask": {"quantity": "profile", "realisations": 6}}))
    found = Estimates(m := case("profile"), first(case("profile"), 6))
    assert m.labels == {n: [row[n] for row in outcome.decimals()] for n in ("j", "branch")}
    for name, values in (("std", found.std), ("mean_change", found.mean_change)):
        meant = outcome.arrays[name].tolist()
        assert values == pytest.approx(meant, rel=1e-12, abs=1e-15 * max(found.std))
    assert m.ordered() == pytest.approx([1 / math.sqrt(7 / 4)] * 8)


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
    found = first(m, N)
    edges = np.array([-math.inf, *m.edges, math.inf])
    counts = [np.histogram(g, edges)[0] for g in changes(m, range(N))]
    assert found.bins[0].tolist() == np.sum(counts, axis=0).tolist()
    assert found.bins[1].tolist() == np.sum(np.square(counts), axis=0).tolist()
    assert found.bins[2].tolist() == (m.members * np.sum(counts, axis=0)).tolist()
    assert found.bins[0].sum() == N * m.members
    assert m.edges == tuple(-edge for edge in reversed(m.edges))


def test_the_smallest_disorder_keeps_all_digits() -> None:
    def relative(std: str) -> Array:
        m = case("profile, first order", relative_std=f"={std}")
        found = Estimates(m, first(m, 4))
        assert (found.std_error > 0).all()
        return np.array([found.std, found.std_error]) / float(std)

    usual = relative("1e-3")
    for std in ("1e-9", "1e-160", "1e-300"):
        assert relative(std) == pytest.approx(usual, rel=1e-12)


@given(st.data())
def test_bytes_that_are_no_sums_are_refused(data: st.DataObject) -> None:
    m = case("histogram of all")
    written = bytes_of_first(m, 2)
    assert from_bytes(written, m).to_bytes() == written
    wrong = bytearray(written)
    if data.draw(st.booleans()):
        wrong = wrong[: data.draw(st.integers(0, len(written) - 1))]
        with pytest.raises(ValueError, match="shorter"):
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
        ({"effects": {"geometry": "ordered"}}, "every realisation would be the same"),
        ({"disorder": {"kind": "file", "file": "radii.csv"}}, "drawn"),
        ({"disorder": {"kind": "normal", "relative_std": "=0.0"}}, "the same"),
        (
            {"ask": {"quantity": "histogram"}, "load": {"kind": "point", "at": [0, 4]}},
            "--reach",
        ),
    ],
)
def test_what_has_no_statistics_is_refused(change: dict[str, Any], says: str) -> None:
    with pytest.raises(SceneError, match=says):
        measurement(scene({**PROFILE, **change}))
