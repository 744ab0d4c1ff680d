"""Ensembles for figures: planned, and solved batch after batch by the engine."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import sqrt
from typing import Any

import numpy as np

from ..arithmetic.systems import FLOAT64, Array
from ..mechanics.engine import packings
from ..mechanics.problem import Solved
from ..mechanics.sweep import Forces, SolvedPacking, deposit, sweep_down
from ..planning.plan import Plan
from ..planning.planner import plan
from ..quantities.base import ContactQuantity
from ..scene.scene import Scene
from ..scene.sections import (
    Ask,
    Disorder,
    Effects,
    Load,
    Packing,
    SurfaceLoad,
)
from ..statistics.bands import Band, averaged, log_relative_std, simultaneous

Notice = Callable[[str], None]
"""Told, now and then, what is being done."""

LEVEL = 0.99
"""Of all simultaneous bands."""

# (σ_δr/r)² = 1e-6/12, uniform radii, and s = 3 r, as in the caption of figure 3.
PAPER_STD = sqrt(1e-6 / 12)
SPACING = Fraction(3)


@dataclass(frozen=True)
class Medium:
    """What packings are made of: the spacing s in units of r, and σ_δr/r."""

    spacing: Fraction = SPACING
    std: float = PAPER_STD

    @property
    def n_x(self) -> Fraction:
        """Horizontal component of n⁺."""
        return self.spacing / 4

    @property
    def n_y(self) -> float:
        """Vertical component of n⁺ and n⁻."""
        return sqrt(1 - float(self.n_x) ** 2)

    @property
    def phi(self) -> Fraction:
        """φ = n⁺·n⁻."""
        return 1 - 2 * self.n_x**2


PAPER = Medium()
N_X, PHI = PAPER.n_x, PAPER.phi


@dataclass(frozen=True)
class Options:
    """What can be chosen of figures."""

    heights: Sequence[int] = (8, 32, 128)
    realisations: int = 0
    seed: int = 1
    models: frozenset[str] = frozenset()
    spacing: Fraction | None = None
    relative_std: float | None = None
    notice: Notice = lambda _: None

    def medium(self, usual: Medium = PAPER) -> Medium:
        """Give what was chosen, in place of what is usual for a figure."""
        return Medium(self.spacing or usual.spacing, self.relative_std or usual.std)


def planned(
    quantity: Any,
    *,
    height: int,
    seed: int,
    width: int | None = 0,
    realisations: int = 1,
    std: float = PAPER_STD,
    kind: Any = "uniform",
    at: tuple[int, int, str] | None = None,
    load: Load | None = None,
    geometry: Any = "exact",
    spacing: Fraction = SPACING,
    dimension: int = 2,
) -> Plan:
    """Plan an ensemble. Raises ``SceneError`` where a number is out of range or too large.

    A ``width`` of 0 is 2M: then no exact force sees an image. None is the infinite slab.
    """
    width, narrow = 2 * height if width == 0 else width, width is not None
    scene = Scene(
        packing=Packing(
            height=height, width=width, spacing=spacing, dimension=dimension, allow_images=narrow
        ),
        disorder=Disorder(kind=kind, relative_std=std, seed=seed),
        load=SurfaceLoad() if load is None else load,
        effects=Effects(geometry=geometry),
        ask=Ask(quantity=quantity, at=at, realisations=realisations),
    )
    return plan(scene)


def solved(
    ensemble: Plan, realisations: range, notice: Notice | None = None, what: str = ""
) -> Iterator[tuple[Solved, int]]:
    """Solve realisations; give what was solved together with the number of its realisations.

    Arrays of a batch of one have no axis of realisations.
    """
    with FLOAT64.active():
        for answer, chunk in packings(ensemble.problem, realisations, FLOAT64):
            yield answer, len(chunk)
            if notice is not None:
                notice(f"{what}: realisation {chunk[-1] - realisations[0]} of {len(realisations)}")


def gathered(
    ensemble: Plan,
    notice: Notice,
    what: str,
    each: Callable[[Solved, int], tuple[Array, ...]],
    start: int = 0,
) -> tuple[Array, ...]:
    """Solve all realisations from ``start`` on; join what ``each`` gives, (realisations, …)."""
    numbers = range(start, start + ensemble.scene.ask.realisations)
    found = [each(*solution) for solution in solved(ensemble, numbers, notice, what)]
    return tuple(np.concatenate(parts) for parts in zip(*found, strict=True))


def moments(
    ensemble: Plan,
    notice: Notice,
    what: str,
    over: Callable[[Array], Array],
    start: int = 0,
) -> tuple[Array, Array]:
    """Solve all realisations of a profile; give averages of g/F and of its square.

    ``over`` takes (M, branches, realisations, contacts) to averages, (realisations, L).
    """
    quantity, problem = ensemble.quantity, ensemble.problem
    assert isinstance(quantity, ContactQuantity)

    def each(answer: Solved, number: int) -> tuple[Array, Array]:
        F, g = quantity.changes(problem, answer, number)
        change = (g / F[:, None]).reshape(problem.height, problem.dimension, number, -1)
        return over(change), over(change**2)

    mean, square = gathered(ensemble, notice, what, each, start)
    return mean, square


def by_layer(change: Array) -> Array:
    """Average over all contacts of a layer; (realisations, M)."""
    return np.asarray(change.mean(axis=3).mean(axis=1).T)


def band_of_roots(squares: Array, seed: int) -> Band:
    """Give the band of root mean squares, of ``squares``, (realisations, L)."""
    mean = squares.mean(axis=0)
    influence = (squares - mean) / mean / 2
    return simultaneous(averaged(np.log(mean) / 2, influence), LEVEL, seed)


def band_of_spread(mean: Array, square: Array, seed: int) -> Band:
    """Give the band of σ/⟨f⟩ (``log_relative_std``)."""
    return simultaneous(averaged(*log_relative_std(mean, square)), LEVEL, seed)


def forces_of(answer: Solved) -> Forces:
    """Give the forces of an ensemble that asked for them."""
    assert answer.forces is not None
    return answer.forces


def impulses(plan: Plan) -> Solved:
    """Solve to first order with δr = r on one bead at a time: the weights of δr/r in everything.

    The first axis of all arrays runs over the beads of the region, base first.
    """
    ensemble = plan.problem
    region = ensemble.region
    unit = np.eye(region.beads)
    edges = np.cumsum([row.count for row in region.rows])[:-1]
    rho = tuple(np.split(unit, edges, axis=1))
    with FLOAT64.active():
        packing = deposit(ensemble.phi, region, rho, FLOAT64, linear=True)
        strength = ensemble.load.strength(ensemble.n_x, FLOAT64)
        loads = ensemble.load.on(ensemble.force_rows, strength, FLOAT64)
        forces = sweep_down(packing, ensemble.force_rows, loads, linear=True)
    return Solved(FLOAT64, packing, forces, None)


def centres(packing: SolvedPacking, j: int) -> tuple[Array, Array, Array, Array]:
    """Give x and y of the beads of a layer, ordered and displaced, in units of r."""
    nx = sqrt((1 - packing.phi) / 2)
    ny = sqrt(1 - nx**2)
    x = np.array(packing.region.rows[j].sites()) * (2 * nx)
    y = np.full(len(x), 2 * j * ny)
    cp, cm = packing.c.plus[j], packing.c.minus[j]
    return x, y, x + (cp - cm) / (2 * nx), y + (cp + cm) / (2 * ny)


def of_ensembles(o: Options, std: float, **parameters: Any) -> dict[str, Any]:
    """Give the facts of a figure that draws ensembles."""
    return {
        **parameters,
        "realisations": o.realisations,
        "relative_std": std,
        "simultaneous_level": LEVEL,
    }
