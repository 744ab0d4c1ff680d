"""Packings of discs: small ones that Hypothesis draws, which shrink to few beads and equal radii;
and one that is always the same."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import lru_cache

from hypothesis import Phase, settings
from hypothesis import strategies as st

from tests.properties.packing import Number, Packing, mp, step
from tests.properties.reading import Plane, place, steps_to

HIGHEST = 6


def exactly(value: Fraction) -> Number:
    return mp.mpf(value.numerator) / value.denominator


cosines = st.fractions(Fraction(-9, 20), Fraction(9, 20), max_denominator=20)
"""φ of either sign, within the range −½ < φ < ½ of packings."""

lengths = st.builds(Fraction, st.integers(1, 9), st.integers(1, 9))
"""Mean radii, loads and σ; 1 is the simplest."""

Geometry = tuple[Fraction, Fraction]
"""φ and r."""
geometries = st.tuples(cosines, lengths)

GEOMETRY = Fraction(1, 7), Fraction(3, 4)
"""One that is always the same."""

FEWER = settings(
    max_examples=max(2, settings().max_examples // 10),
    phases=[Phase.explicit, Phase.reuse, Phase.generate],
)
"""Where an example takes a second. The first is the simplest, so that there is little to shrink."""


@dataclass(frozen=True)
class Drawn:
    """A packing with δr = ε ρ for a strength ε, a load, and where to look.

    Attributes:
        cosine: φ.
        width: W, beads in a layer before they repeat.
        height: M.
        r: mean radius.
        rho: ρ of all beads, layer by layer from the base.
        load: "point", "surface", "bulk", "leaning": −(L⁺n⁺ + L⁻n⁻) on all beads of the surface, or
            "contact": nothing but a force f⁺ that enters the bead (k − 1, l − 1) from above.
        weight: the load on a bead, L⁺ of a leaning one, or the force that enters.
        at: the loaded bead, as the paper's (k, l); it may lie beyond the seam.
        t: L⁻/L⁺ of a leaning load.
    """

    cosine: Fraction
    width: int
    height: int
    r: Fraction
    rho: tuple[int, ...]
    load: str
    weight: Fraction
    at: tuple[int, int]
    t: Fraction = Fraction(1)

    def with_equal_radii(self) -> "Drawn":
        """The ordered packing."""
        return replace(self, rho=(0,) * len(self.rho))

    def base(self) -> Iterator[tuple[int, int]]:
        """The beads that are held, as (i, j)."""
        return self._places(range(1))

    def beads(self) -> Iterator[tuple[int, int]]:
        """All beads above the base, as (i, j)."""
        return self._places(range(1, self.height + 1))

    def contacts(self) -> Iterator[tuple[int, int]]:
        """The lower beads of all contacts, as (i, j)."""
        return self._places(range(self.height))

    def _places(self, layers: range) -> Iterator[tuple[int, int]]:
        packing = solved(self, mp.mpf(0)).packing
        return (place(site) for layer in layers for site in packing.sites(layer))


def fixed_packing(load: str) -> Drawn:
    """A packing that is always the same: no two of its radii are equal, and no δr is zero.

    It is so wide that no cone below a bead meets its own images. A cubic number modulo a prime of
    the form 3q + 2 is that of one number only, and no differences along a line vanish.
    """
    width, height = 8, 6
    rho = (number**3 % 113 for number in range(1, width * (height + 1) + 1))
    (cosine, r), weight = GEOMETRY, Fraction(5, 3)
    return Drawn(cosine, width, height, r, tuple(rho), load, weight, (3, 5), Fraction(2, 5))


@lru_cache(maxsize=64)  # all lines of an equation, and all of its changes, see the same packings
def solved(drawn: Drawn, epsilon: Number) -> Plane:
    """The nonlinear packing at one strength of the disorder, and its forces."""
    bare = Packing(exactly(drawn.cosine), drawn.width, drawn.height, exactly(drawn.r))
    sites = [site for layer in range(drawn.height + 1) for site in bare.sites(layer)]
    change = {site: epsilon * rho for site, rho in zip(sites, drawn.rho, strict=True)}
    packing = replace(bare, change=change)
    weight, loaded = exactly(drawn.weight), packing.home(steps_to(*drawn.at))
    match drawn.load:
        case "surface":
            return Plane(packing, packing.surface_load(weight))
        case "bulk":
            return Plane(packing, packing.bulk_load(weight))
        case "point":
            return Plane(packing, packing.downwards(weight, [loaded]))
        case "leaning":
            along = (1, exactly(drawn.t))
            return Plane(packing, packing.along(along, weight, packing.sites(drawn.height)))
    return Plane(packing, entering={(packing.home(step(loaded, 0, -1)), 0): weight})


@st.composite
def packings(
    draw: st.DrawFn, *loads: str, cone: bool = False, height: int = 2, level: int = 1
) -> Drawn:
    """A packing of up to ``HIGHEST`` layers under one of these loads, down to one bead wide.

    Args:
        draw: Hypothesis' own.
        loads: as ``Drawn.load``; where none is given, only positions matter.
        cone: so wide that the cone below the loaded bead does not meet its own images.
        height: the least one.
        level: the least layer of a bead that alone is loaded.
    """
    height = draw(st.integers(height, HIGHEST))
    load = draw(st.sampled_from(loads or ("surface",)))
    alone = load in ("point", "contact")
    l = draw(st.integers(level, height)) if alone else height  # noqa: E741
    width = draw(st.integers(l if cone else 1, height + 1))
    k = 2 * draw(st.integers(-width, width)) + l % 2
    beads = width * (height + 1)
    cosine, r = draw(geometries)
    rho = tuple(draw(st.lists(st.integers(-9, 9), min_size=beads, max_size=beads)))
    weight, t = draw(lengths), draw(lengths) if load == "leaning" else Fraction(1)
    return Drawn(cosine, width, height, r, rho, load, weight, (k, l), t)
