"""Small scenes of spheres, and what their answers say."""

from collections.abc import Iterator
from fractions import Fraction
from typing import Any

from force_diffusion.numeric.arithmetic.systems import Balls

import force_diffusion as fd
from tests.numeric.scenes import question


def scene(
    quantity: str = "contact_forces", *, height: int = 2, width: int = 3, std: float = 1e-2,
    geometry: str = "exact", **more: Any,
) -> fd.Scene:  # fmt: skip
    return question(
        quantity, height, width, dimension=3, spacing=2.9, std=std, seed=5,
        effects={"geometry": geometry}, **more,
    )  # fmt: skip


def columns(outcome: fd.Outcome, *names: str) -> Iterator[tuple[Any, ...]]:
    return zip(*(outcome.arrays[name].tolist() for name in names), strict=True)


def drawn(asked: fd.Scene) -> dict[tuple[int, int, int], Fraction]:
    """δr/r of every bead, exact."""
    problem = asked.explain().problem
    assert asked.packing.width is not None
    found = {}
    with Balls(200).active():
        (values,) = problem.radii.of(problem.region.rows, [0], Balls(200))
    for number, value in enumerate(values):
        j, column = divmod(number, asked.packing.width**2)
        p, q = divmod(column, asked.packing.width)
        found[p, q, j] = Fraction(*map(int, (value.mid().fmpq().p, value.mid().fmpq().q)))
    return found
