"""A question is one class: how its beads are solved, and in what, is none of its concern."""

from collections.abc import Sequence
from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from force_diffusion.numeric import quantities
from force_diffusion.numeric.arithmetic.systems import NumberSystem
from force_diffusion.numeric.lattice.layers import Region
from force_diffusion.numeric.mechanics.problem import Problem
from force_diffusion.numeric.mechanics.sweep import Solved
from force_diffusion.numeric.quantities.base import Gatherer, Quantity, Table, column
from force_diffusion.numeric.run.running import run

from tests.numeric.scenes import basic, planned


class Products(Quantity):
    """The mean of f⁺f⁻ over the beads of each layer: of the first two contacts below a bead."""

    name = "products"
    merged = True

    def answer_rows(self, region: Region, realisations: int) -> int:
        return self.height

    def gatherer(self, problem: Problem, system: NumberSystem) -> "Means":
        return Means(system)


class Means(Gatherer):
    def __init__(self, system: NumberSystem) -> None:
        self.system = system
        self.sums: dict[int, Any] = {}
        self.counts: dict[int, int] = {}

    def add(self, solved: Solved, realisations: Sequence[int]) -> None:
        assert solved.forces is not None
        for j in range(1, len(solved.forces.rows)):
            plus, minus = (solved.forces.ordered(a, j) + solved.forces.change(a, j) for a in (0, 1))
            product = plus * minus
            self.sums[j] = self.sums.get(j, 0) + product.sum()
            self.counts[j] = self.counts.get(j, 0) + product.size

    def table(self) -> Table:
        layers = sorted(self.sums)
        means = [self.sums[j] / self.counts[j] for j in layers]
        return Table({"j": np.array(layers) - 1}, {"mean": column(means, self.system)}, ("mean",))


@pytest.fixture(autouse=True)
def _known(monkeypatch: pytest.MonkeyPatch) -> None:
    """Profiles are asked for by name; this question answers."""
    monkeypatch.setitem(quantities.QUANTITIES, "profile", Products)


def by_hand(sections: dict[str, dict[str, Any]]) -> dict[int, Fraction]:
    """Give the same of the forces of all contacts, named one by one."""
    ask = {**sections["ask"], "quantity": "contact_forces"}
    rows = run(planned({**sections, "ask": ask})).decimals()
    three = sections["packing"].get("dimension") == 3
    bead: dict[tuple[Any, ...], dict[str, Fraction]] = {}
    width = sections["packing"]["width"]
    for row in rows:
        if three:
            step = {"1": (1, 0), "2": (0, 1), "3": (0, 0)}[row["branch"]]
            upper = ((row["p"] + step[0]) % width, (row["q"] + step[1]) % width)
        else:
            upper = ((row["i"] + (1 if row["branch"] == "+" else -1)) % (2 * width),)
        key = (row.get("realisation", 0), *upper, row["j"])
        bead.setdefault(key, {})[row["branch"]] = Fraction(row["force"])
    one, other = ("1", "2") if three else ("+", "-")
    products: dict[int, list[Fraction]] = {}
    for (*_, j), forces in bead.items():
        products.setdefault(j, []).append(forces[one] * forces[other])
    return {j: sum(found, Fraction(0)) / len(found) for j, found in products.items()}


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("realisations", [1, 5])
@pytest.mark.parametrize("tolerance", [None, "=1e-20", "=1e-40"])
def test_a_new_question_is_answered_in_every_dimension_and_arithmetic(
    dimension: int, realisations: int, tolerance: str | None
) -> None:
    sections = basic(5, 7 if dimension == 3 else 12, quantity="profile", realisations=realisations)
    sections["packing"]["dimension"] = dimension
    sections["disorder"]["relative_std"] = "=1e-3"
    if tolerance is not None:
        sections["ask"]["tolerance"] = tolerance
    found = {row["j"]: Fraction(row["mean"]) for row in run(planned(sections)).decimals()}
    true = by_hand({**sections, "ask": {**sections["ask"], "tolerance": "=1e-50"}})
    assert found.keys() == true.keys() == set(range(5))
    allowed = Fraction(tolerance[1:]) if tolerance else Fraction(1, 10**13)  # hundreds of roundings
    for j, mean in found.items():
        assert abs(mean - true[j]) <= allowed * max(true.values())
