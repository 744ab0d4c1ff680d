"""Standard errors and counts beside what they have to be: simulations, and counting one by one.

Of four packings a scatter divided by four in place of three is a quarter too small.
"""

import math
from bisect import bisect_right
from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from force_diffusion.numeric.statistics.moments import Scatter

import force_diffusion as fd

PACKINGS = 4


def of_their_spread(values: Any, errors: Any) -> None:
    """The mean squared error has to be the variance of the values, over independent repeats.

    Each is known from n repeats of N = 4 packings: the squares of errors scatter by about
    2/(N − 1) = 2/3 of themselves, those of the values by 2; four standard deviations are allowed,
    and must be less than the quarter that a wrong divisor makes.
    """
    repeats = len(values)
    allowed = 4 * math.sqrt((2 / (PACKINGS - 1) + 2) / repeats)
    assert allowed < 0.2
    ratio = np.mean(errors**2, axis=0) / np.var(values, axis=0, ddof=1)
    assert (abs(ratio - 1) < allowed).all(), ratio


def of_logarithms(stds: Any, errors: Any) -> Any:
    """Give errors ε of ln σ: σ (e^2ε − 1)/2 is stated of σ."""
    return np.log1p(2 * errors / stds) / 2


def test_the_scatter_of_made_up_packings() -> None:
    """Means of x and x² that are normal, and vary so little that the root is linear."""
    random = np.random.default_rng(5)
    means, stds, errors = [], [], []
    for _ in range(4000):
        mean = 0.001 * random.standard_normal((PACKINGS, 2))
        square = 1 + 0.01 * random.standard_normal((PACKINGS, 2))
        scatter = Scatter()
        scatter.add(mean[:1], square[:1])
        scatter.add(mean[1:], square[1:])
        errors.append(scatter.errors())
        means.append(mean.mean(axis=0))
        stds.append(np.sqrt(square.mean(axis=0) - mean.mean(axis=0) ** 2))
    of_their_spread(np.array(means), np.array([mean for mean, _ in errors]))
    of_their_spread(np.log(stds), of_logarithms(np.array(stds), np.array([e for _, e in errors])))


def scene(seed: int, quantity: str = "profile", **ask: Any) -> Any:
    """Packings so wide that σ_f of four is nearly linear in what scatters."""
    return fd.Scene(
        packing=fd.Packing(height=2, width=64),
        disorder=fd.Disorder(kind="uniform", relative_std=Fraction(1, 1000), seed=seed),
        ask=fd.Ask(quantity=quantity, **ask),  # type: ignore[arg-type]
    )


@pytest.mark.long
@pytest.mark.parametrize("gathered", ["run", "ensemble"])
def test_the_scatter_of_real_packings(gathered: str) -> None:
    means, stds, errors = [], [], []
    for seed in range(1200):
        if gathered == "run":
            found = scene(seed, realisations=PACKINGS).run()
            numbers, of = found.arrays, found.standard_errors
            means.append(numbers["mean_change"])
            stds.append(numbers["std"])
            errors.append((of["mean_change"], of["std"]))
        else:
            many = fd.ensemble(scene(seed), PACKINGS)
            means.append(many.mean_change)
            stds.append(many.std)
            errors.append((many.mean_change_error, many.std_error))
    of_their_spread(np.array(means), np.array([mean for mean, _ in errors]))
    of_their_spread(np.log(stds), of_logarithms(np.array(stds), np.array([e for _, e in errors])))


@pytest.mark.long
def test_the_scatter_of_shares() -> None:
    shares, errors = [], []
    for seed in range(1200):
        bins = fd.ensemble(scene(seed, "histogram", bins=3), PACKINGS, reach=0.0006).bins
        assert bins is not None
        shares.append(bins["share"])
        errors.append(bins["share_error"])
    of_their_spread(np.array(shares), np.array(errors))


def counted(values: list[Fraction], edges: list[Any]) -> list[int]:
    """Count values one by one: low ≤ value < high."""
    counts = [0] * (len(edges) - 1)
    for value in values:
        place = bisect_right(edges, value) - 1
        if 0 <= place < len(counts):
            counts[place] += 1
    return counts


@pytest.mark.parametrize("bins", [1, 2, 7, 100])
@pytest.mark.parametrize("tolerance", [None, "1e-30"])
def test_counts_are_those_of_the_changes(bins: int, tolerance: str | None) -> None:
    rows = scene(3, "histogram", realisations=3, bins=bins).run(tolerance).decimals()
    listed = scene(3, "contact_forces", realisations=3).run(tolerance).decimals()
    edges = [Fraction(rows[0]["low"]), *(Fraction(row["high"]) for row in rows)]
    assert len(rows) == bins
    changes = [Fraction(row["change"]) for row in listed]
    assert [row["count"] for row in rows] == counted(changes, edges)
    assert sum(row["count"] for row in rows) == len(changes) == 3 * 2 * 2 * 64


@pytest.mark.parametrize("bins", [1, 7, 100])
def test_counts_of_an_ensemble_are_those_of_its_packings(bins: int) -> None:
    found = fd.ensemble(scene(3, "histogram", bins=bins), 3, reach=0.004).bins
    assert found is not None
    listed = scene(3, "contact_forces", realisations=3).run().decimals()
    edges = [*found["low"].tolist(), math.inf]
    changes = [Fraction(row["change"]) for row in listed]
    assert list(found["count"]) == counted(changes, edges)


@pytest.mark.parametrize("effects", [{"geometry": "ordered"}, {}])
@pytest.mark.parametrize("dimension", [2, 3])
def test_realisations_that_are_alike_are_counted_too(
    effects: dict[str, Any], dimension: int
) -> None:
    """Without disorder one is solved, and stands for all."""
    std = Fraction(1, 100) if effects else Fraction(0)

    def asked(quantity: str, **disorder: Any) -> Any:
        return fd.Scene(
            packing=fd.Packing(height=3, width=5, dimension=dimension),
            disorder=fd.Disorder(kind="uniform", relative_std=std) if disorder else None,
            ask=fd.Ask(quantity=quantity, realisations=4),  # type: ignore[arg-type]
            effects=fd.Effects(**effects),
        ).run()

    beads = 5 ** (dimension - 1)
    for drawn in ({}, {"drawn": True}):
        assert set(asked("profile", **drawn).arrays["samples"]) == {4 * beads}
        assert asked("histogram", **drawn).arrays["count"].sum() == 4 * 3 * dimension * beads
