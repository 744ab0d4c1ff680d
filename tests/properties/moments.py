"""Moments from nonlinear packings alone: one radius is changed after the other.

Radii are independent, so that to first order var X = σ² Σ (∂X/∂δr)², summed over the beads, and to
second order ⟨X⟩ is X of the ordered packing and ½σ² Σ ∂²X/∂δr². Both derivatives are central
differences; what they leave out falls as the square of the change. The beads of a layer are alike:
one of each layer is changed, and X is read at all places beside it.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import lru_cache
from itertools import product

import sympy
from force_diffusion.symbolic import symbols as sy

from tests.properties.drawn import Geometry, exactly
from tests.properties.packing import Number, Packing, Site, minus, mp, plus
from tests.properties.reading import Plane, Value, steps_to

At = Mapping[sympy.Symbol, Value]

CHANGE = mp.mpf("1e-18")
"""δr/r of one bead. Differences leave out its square, 10⁻³⁶, times a higher derivative."""

ACCURATE = mp.mpf("1e-20")
"""Of a moment, which here is at most some 10⁶. A second difference over the square of the change is
rounded to 10⁻⁴⁴."""


@dataclass(frozen=True)
class Slab:
    """Packings of one height under one load, in each of which one radius is changed.

    Attributes:
        geometry: φ, of each two base vectors, and r.
        height: M, or l of a load on one bead.
        load: "surface", "bulk" or "point".
        shares: the load's components along the base vectors: L⁺ and L⁻ for discs.
        reach: so many places to the right of its bead is what a quantity is of.
        order: 2 where second derivatives are asked for.
    """

    geometry: Geometry
    height: int
    load: str
    shares: tuple[Fraction, ...]
    reach: int = 0
    order: int = 1

    @property
    def origins(self) -> Iterator[Site]:
        """The places of a layer, as steps from the first one."""
        return product(range(self.width), repeat=len(self.shares) - 1)

    @property
    def width(self) -> int:
        """So wide that nothing sees an image: a cone of M layers and a contact, or two of these."""
        return self.order * (self.height + 1) + 1 + self.reach

    def symbols(self, rise: Number) -> dict[sympy.Symbol, Value]:
        """Loads in the paper's symbols; a vertical one is 2n_y of its shares."""
        first, *others = map(exactly, self.shares)
        symbols = (sy.t,) if len(others) == 1 else (sy.t_2, sy.t_3)
        ratios = (other / first for other in others)
        vertical = 2 * rise * first
        given = {sy.f_load: vertical, sy.m_g: vertical, sy.L_plus: first}
        return given | dict(zip(symbols, ratios, strict=True))


@lru_cache(maxsize=512)  # all loads see the same packings
def packing(
    geometry: Geometry, d: int, width: int, height: int, layer: int, change: Number
) -> Packing:
    """With δr = ``change`` of the first bead of a layer."""
    bare = Packing(exactly(geometry[0]), width, height, exactly(geometry[1]), d=d)
    return replace(bare, change={next(bare.sites(layer)): change} if change else {})


@lru_cache(maxsize=512)
def plane(slab: Slab, layer: int, change: Number, loaded: Site | None = None) -> Plane:
    """The same with its loads: on the bead ``loaded`` alone, if there is one."""
    shares = [*map(exactly, slab.shares)]
    laid = packing(slab.geometry, len(shares), slab.width, slab.height, layer, change)
    lowest = 1 if slab.load == "bulk" else slab.height
    carrying = (site for above in range(lowest, slab.height + 1) for site in laid.sites(above))
    loads = laid.along(shares, 1, carrying if loaded is None else [laid.home(loaded)])
    return Plane(laid, loads, given=slab.symbols(laid.base[0][-1]))


def read(
    slab: Slab, quantity: sympy.Expr, at: At, layer: int, change: Number, origin: Site
) -> Number:
    """A quantity so many places to the right of the bead that is changed."""
    steps = (*origin, -sum(origin))
    loaded = plus(loaded_bead(steps, at), steps) if slab.load == "point" else None
    return plane(slab, layer, change, loaded).read(quantity, at, steps)


def loaded_bead(steps: Site, at: At) -> Site:
    return steps_to(at[sy.k], at[sy.l]) if len(steps) == 2 else (0, 0, at[sy.l])


def carries(slab: Slab, at: At, layer: int, origin: Site) -> bool:
    """Whether the bead that is changed lies in the cone below the load, which holds all forces."""
    if slab.load != "point":
        return True
    steps = (*origin, -sum(origin))
    first = (*(0,) * len(origin), layer)
    *across, _ = minus(plus(loaded_bead(steps, at), steps), first)
    return sum(a % slab.width for a in across) <= slab.height - layer


def moment(slab: Slab, statistic: sympy.Expr, at: At) -> Number:
    """A variance, a covariance, or the shift of a mean at second order, from differences."""
    step = CHANGE * exactly(slab.geometry[1])
    ordered = [read(slab, arg, at, 0, 0, (0,) * (len(slab.shares) - 1)) for arg in statistic.args]
    total = mp.mpf(0)
    for layer, origin in product(range(slab.height + 1), slab.origins):
        if not carries(slab, at, layer, origin):
            continue
        larger = [read(slab, arg, at, layer, step, origin) for arg in statistic.args]
        smaller = [read(slab, arg, at, layer, -step, origin) for arg in statistic.args]
        if isinstance(statistic, sy.Shift):
            total += (larger[0] + smaller[0] - 2 * ordered[0]) / step**2 / 2
        else:
            slopes = [(a - b) / (2 * step) for a, b in zip(larger, smaller, strict=True)]
            total += slopes[0] * slopes[-1]
    return at[sy.sigma] ** 2 * total
