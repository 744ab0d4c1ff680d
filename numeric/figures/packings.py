"""Ensembles for figures: scenes written as text, solved batch after batch by the engine."""

from collections.abc import Callable, Iterator
from fractions import Fraction
from math import sqrt
from typing import Any

import numpy as np
from force_diffusion.numeric.arithmetic.systems import FLOAT64
from force_diffusion.numeric.lattice.layers import Array
from force_diffusion.numeric.mechanics.engine import Solved, solve
from force_diffusion.numeric.mechanics.first_order import displace
from force_diffusion.numeric.mechanics.forces import Forces, sweep_down
from force_diffusion.numeric.mechanics.packing import Packing
from force_diffusion.numeric.mechanics.work import Work
from force_diffusion.numeric.planning.planner import Plan, plan
from force_diffusion.numeric.scene.sections import parse_scene

Notice = Callable[[str], None]
"""Told, now and then, what is being done."""

Row = dict[str, Any]
"""One line of a CSV file."""

# (σ_δr/r)² = 1e-6/12, uniform radii, and s = 3 r, as in the caption of figure 3.
PAPER_STD = sqrt(1e-6 / 12)
SPACING = Fraction(3)
N_X = SPACING / 4
PHI = 1 - 2 * N_X**2
# Beads that are solved together: their arrays still fit into a cache.
BATCH = 100_000

_SCENE = """
packing = {{height = {height}{width}, spacing = {spacing}}}
disorder = {{kind = "{kind}", relative_std = {std!r}, seed = {seed}}}
load = {{kind = {load}}}
effects = {{geometry = "{geometry}"}}
ask = {{quantity = {quantity}, realisations = {realisations}}}
"""


def planned(
    quantity: str,
    *,
    height: int,
    width: int | None,
    seed: int,
    realisations: int = 1,
    std: float = PAPER_STD,
    kind: str = "uniform",
    load: str = '"surface"',
    geometry: str = "exact",
) -> Plan:
    """Plan an ensemble. ``quantity`` and ``load`` are TOML and may carry further keys.

    Raises ``SceneError`` where a number is out of range or the memory does not suffice.
    """
    return plan(
        parse_scene(
            _SCENE.format(
                height=height,
                width="" if width is None else f", width = {width}, allow_images = true",
                spacing=int(SPACING),
                kind=kind,
                std=std,
                seed=seed,
                load=load,
                geometry=geometry,
                quantity=quantity,
                realisations=realisations,
            )
        )
    )


def solved(
    ensemble: Plan, realisations: range, notice: Notice | None = None, what: str = ""
) -> Iterator[tuple[Solved, int]]:
    """Solve realisations in batches; give each batch with the number of its realisations.

    Arrays of a batch of one have no axis of realisations: ``batched`` adds it.
    """
    size = max(1, BATCH // max(ensemble.region.beads, 1))
    with FLOAT64.active():
        for at in range(0, len(realisations), size):
            batch = realisations[at : at + size]
            if notice is not None:
                notice(f"{what}: realisation {at} of {len(realisations)}")
            yield solve(ensemble, batch, FLOAT64, Work()), len(batch)


def batched(values: Array, number: int) -> Array:
    """Give an array its axis of realisations; shape (number, count)."""
    return values.reshape(number, -1)


def forces_of(answer: Solved) -> Forces:
    """Give the forces of an ensemble that asked for them."""
    assert answer.forces is not None
    return answer.forces


def impulses(ensemble: Plan) -> Solved:
    """Solve to first order with δr = r on one bead at a time: the weights of δr/r in everything.

    The first axis of all arrays runs over the beads of the region, base first.
    """
    region = ensemble.region
    unit = np.eye(region.beads)
    edges = np.cumsum([row.count for row in region.rows])[:-1]
    rho = tuple(np.split(unit, edges, axis=1))
    with FLOAT64.active():
        packing = displace(N_X, region, rho, FLOAT64)
        strength = ensemble.load.strength(N_X, FLOAT64)
        loads = ensemble.load.on(ensemble.force_rows, strength, FLOAT64)
        forces = sweep_down(packing, ensemble.force_rows, loads, linear=True)
    return Solved(FLOAT64, packing, forces, None)


def centres(packing: Packing, j: int) -> tuple[Array, Array, Array, Array]:
    """Give x and y of the beads of a layer, ordered and displaced, in units of r."""
    nx, ny = float(N_X), sqrt(1 - float(N_X) ** 2)
    x = np.array(packing.region.rows[j].sites()) * (2 * nx)
    y = np.full(len(x), 2 * j * ny)
    cp, cm = packing.c_plus[j], packing.c_minus[j]
    return x, y, x + (cp - cm) / (2 * nx), y + (cp + cm) / (2 * ny)
