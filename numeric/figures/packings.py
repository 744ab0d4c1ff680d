"""Ensembles for figures: planned, solved in batches by the engine, and compared with theory."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from math import sqrt
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ..arithmetic.systems import FLOAT64, Array, NumberSystem
from ..lattice.layers import Rows
from ..mechanics.engine import packings
from ..mechanics.problem import Route
from ..mechanics.sweep import Solved
from ..planning.plan import Plan
from ..planning.planner import plan
from ..quantities.answer import answer
from ..quantities.base import ContactQuantity
from ..scene.scene import CheckedScene
from ..scene.sections import Ask, Disorder, Load, Packing, SurfaceLoad
from ..statistics.bands import Band, log_relative_std, simultaneous

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Notice = Callable[[str], None]
"""Told, now and then, what is being done."""
Table = Mapping[str, Any]
"""Columns of a CSV file by name, (rows,) each."""
LEVEL = 0.99
"""Of all simultaneous bands."""

# (σ_δr/r)² = 1e-6/12, uniform radii, and s = 3 r, as in the caption of figure 3.
PAPER_STD = sqrt(1e-6 / 12)
SPACING = Fraction(3)


class Medium(NamedTuple):
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


class Options(NamedTuple):
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


class Comparison(NamedTuple):
    """What was simulated, with its band, and what ``theory`` says, (L,); ``of``: in words."""

    of: str
    band: Band
    theory: Array

    @property
    def deviation(self) -> float:
        """Largest deviation of theory, in half-widths: inside is ≤ 1."""
        return self.band.deviation(self.theory)

    def verdict(self) -> str:
        """Say whether theory lies inside of the band."""
        where = "inside" if self.deviation <= 1 else "outside"
        off = f"off by {self.deviation:.2f} of its half-width at most"
        return f"{self.of} {where} the simultaneous {LEVEL:.0%} band, {off}"

    @property
    def bars(self) -> Array:
        """Lengths of error bars below and above what was simulated, (2, L)."""
        low, high = self.band.limits
        return np.array([self.band.value - low, high - self.band.value])


class Made(NamedTuple):
    """A figure, its CSV files by name, verdicts and parameters, verdicts in words."""

    figure: "Figure"
    tables: Mapping[str, Table]
    facts: Mapping[str, Any]
    lines: Sequence[str]


def compared(
    figure: "Figure", name: str, o: Options, cases: Sequence[Comparison], rows: Table, **facts: Any
) -> Made:
    """Give a figure of ensembles beside theory; ``rows`` names the rows of its CSV file."""
    columns = ([c.band.value, *c.band.limits, c.theory] for c in cases)
    names = ("simulated", "band_low", "band_high", "exact")
    table = {**rows, **dict(zip(names, np.concatenate([*columns], axis=1), strict=True))}
    verdicts = [
        {"of": c.of, "inside": c.deviation <= 1, "deviation_in_half_widths": c.deviation}
        for c in cases
    ]
    facts |= {"realisations": o.realisations, "level": LEVEL, "comparisons": verdicts}
    return Made(figure, {name: table}, facts, [c.verdict() for c in cases])


def table(names: str, rows: Sequence[Sequence[Any]]) -> Table:
    """Give the columns of rows, by names with spaces between them."""
    return dict(zip(names.split(), zip(*rows, strict=True), strict=True))


def planned(
    quantity: Any,
    o: Options,
    medium: Medium = PAPER,
    *,
    height: int,
    width: int | None = 0,
    kind: Any = "uniform",
    at: tuple[int, int, str] | None = None,
    load: Load | None = None,
    dimension: int = 2,
) -> Plan:
    """Plan packings. Raises ``SceneError`` where a number is out of range or too large.

    A ``width`` of 0 is 2M: then no exact force sees an image. None is the infinite slab.
    """
    width, narrow = 2 * height if width == 0 else width, width is not None
    packing = Packing(
        height=height, width=width, spacing=medium.spacing, dimension=dimension, allow_images=narrow
    )
    scene = CheckedScene(
        packing=packing,
        disorder=Disorder(kind=kind, relative_std=medium.std, seed=o.seed),
        load=SurfaceLoad() if load is None else load,
        ask=Ask(quantity=quantity, at=at, realisations=o.realisations or 1),
    )
    return plan(scene)


def solve_first(ensemble: Plan) -> Table:
    """Solve the first realisation; give the columns of its answer."""
    table = answer(ensemble.quantities, ensemble.problem, [0], FLOAT64).tables[0]
    return table.index | table.numbers


class _UnitChanges:
    """Packing k has δr = r of bead number k alone; only to first order can it be solved."""

    relative_std = Fraction(1)

    def of(self, rows: Rows, realisations: Sequence[int], system: NumberSystem) -> Array:
        """Give δr/r, (realisations, beads), in float64."""
        radii = np.zeros((len(realisations), rows.beads))
        radii[np.arange(len(radii)), realisations] = 1
        return radii


def unit_changes(ensemble: Plan) -> Plan:
    """Plan a packing for each bead, with no other radius changed, to first order.

    Of what is then found, sums of squares are variances in units of (σ/r)².
    """
    problem, radii, route = ensemble.problem, _UnitChanges(), Route.FIRST_ORDER
    beads = problem.region.beads
    problem = replace(problem, radii=radii, route=route, realisations=beads)
    return replace(ensemble, problem=problem)


def gathered(
    ensemble: Plan, notice: Notice, what: str, each: Callable[[Solved, int], Array], start: int = 0
) -> Array:
    """Solve all realisations from ``start`` on; join what ``each`` gives, (realisations, …).

    ``each`` takes what was solved, and of how many realisations.
    """
    count, parts = ensemble.problem.realisations, []
    with FLOAT64.active():
        for solved, chunk in packings(ensemble.problem, range(start, start + count), FLOAT64):
            parts.append(each(solved, len(chunk)))
            notice(f"{what}: realisation {chunk[-1] - start} of {count}")
    return np.concatenate(parts)


def moments(
    ensemble: Plan, notice: Notice, what: str, start: int = 0, axes: tuple[int, ...] = (1, 3)
) -> tuple[Array, Array]:
    """Solve all realisations of a profile; give averages of g/F and of its square.

    They are taken over ``axes`` of arrays (M, branches, realisations, contacts), by default over
    all contacts of a layer; shapes (realisations, L).
    """
    quantity, problem = ensemble.quantity, ensemble.problem
    assert isinstance(quantity, ContactQuantity)

    def each(solved: Solved, number: int) -> Array:
        F, g = quantity.changes(problem, solved, number)
        change = (g / F[:, None]).reshape(problem.height, problem.dimension, number, -1)
        return np.stack([change.mean(axis=axes).T, (change**2).mean(axis=axes).T], axis=1)

    mean, square = gathered(ensemble, notice, what, each, start).swapaxes(0, 1)
    return mean, square


def band_of_spread(mean: Array, square: Array, seed: int) -> Band:
    """Give the band of σ/⟨f⟩ (``log_relative_std``)."""
    return simultaneous(*log_relative_std(mean, square), LEVEL, seed)


def band_of_roots(squares: Array, seed: int) -> Band:
    """Give the band of root mean squares, of ``squares``, (realisations, L)."""
    mean = squares.mean(axis=0)
    return simultaneous(np.log(mean) / 2, squares / mean / 2 - 0.5, LEVEL, seed)


def band_of_shift(ensemble: Plan, changes: Callable[[Plan], Array], unit: float, seed: int) -> Band:
    """Give the band of a mean at order σ²: exact packings less the same ones to first order.

    The first-order change has mean zero and carries nearly all of the noise, so that the difference
    shows a shift far smaller than the scatter of the forces. ``changes``: (realisations, L).
    """
    linear = replace(ensemble, problem=replace(ensemble.problem, route=Route.FIRST_ORDER))
    each = (changes(ensemble) - changes(linear)) / unit
    mean = each.mean(axis=0)
    return simultaneous(mean, each - mean, LEVEL, seed, logarithmic=False)
