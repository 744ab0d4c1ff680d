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
from tests.properties.orders import ROUNDING
from tests.properties.packing import Number, Packing, Site, mp, plus
from tests.properties.reading import Plane, Value, steps_to

At = Mapping[sympy.Symbol, Value]

CHANGES = mp.mpf("1e-10"), mp.mpf("1e-12")
"""δr/r of one bead. The fourth derivative, which second differences leave out, is 10²⁰ times as
small as the second."""

DIFFERENCE_ROUNDING = ROUNDING / min(CHANGES) ** 2
"""Of a second difference over the square of the change: 10⁻⁵⁶."""


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
        return {
            sy.f_load: vertical,
            sy.m_g: vertical,
            sy.L_plus: first,
            **dict(zip(symbols, ratios, strict=True)),
        }


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
    loaded, steps = None, (*origin, -sum(origin))
    if slab.load == "point":
        bead = steps_to(at[sy.k], at[sy.l]) if len(steps) == 2 else (0, 0, at[sy.l])
        loaded = plus(bead, steps)
    return plane(slab, layer, change, loaded).read(quantity, at, steps)


def moment(slab: Slab, statistic: sympy.Expr, at: At, change: Number) -> Number:
    """A variance, a covariance, or the shift of a mean at second order, from differences.

    ``change`` is that of one radius, over r.
    """
    step = change * exactly(slab.geometry[1])
    total = mp.mpf(0)
    for layer, origin in product(range(slab.height + 1), slab.origins):
        larger, smaller = (
            [read(slab, one, at, layer, by, origin) for one in statistic.args]
            for by in (step, -step)
        )
        if isinstance(statistic, sy.Shift):
            (ordered,) = (read(slab, one, at, layer, 0, origin) for one in statistic.args)
            total += (larger[0] + smaller[0] - 2 * ordered) / step**2 / 2
        else:
            slopes = [(a - b) / (2 * step) for a, b in zip(larger, smaller, strict=True)]
            total += slopes[0] * slopes[-1]
    return at[sy.sigma] ** 2 * total
