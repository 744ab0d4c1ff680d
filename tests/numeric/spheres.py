"""Small scenes of spheres, and what their answers say."""

from collections.abc import Iterator
from fractions import Fraction
from typing import Any

from force_diffusion.numeric.arithmetic.systems import Balls

import force_diffusion as fd


def scene(
    quantity: str = "contact_forces",
    *,
    height: int = 2,
    width: int = 3,
    std: float = 1e-2,
    load: fd.Load | None = None,
    geometry: Any = "exact",
    **ask: Any,
) -> fd.Scene:
    return fd.Scene(
        packing=fd.Packing(
            height=height, width=width, dimension=3, spacing=2.9, allow_images=width <= height
        ),
        disorder=fd.Disorder(kind="uniform", relative_std=std, seed=5),
        load=load or fd.SurfaceLoad(),
        effects=fd.Effects(geometry=geometry),
        ask=fd.Ask(quantity=quantity, **ask),  # type: ignore[arg-type]
    )


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
