"""The loads that a packing may carry, and the theorems about its forces under each."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import sympy
from force_diffusion.numeric.arithmetic.errors import ForceDiffusionError
from force_diffusion.symbolic.kernel import axioms
from force_diffusion.symbolic.kernel.domain import Loading
from force_diffusion.symbolic.kernel.statistics import SPHERES
from force_diffusion.symbolic.symbols import L_plus, M, f_load, j, k, l, m_g, n_y, t, t_2, t_3

from .. import eq03_extrapolation as eq03
from .. import eq05_contact_minus as eq05
from .. import eq11_total_force as eq11
from .. import eq14_bulk_diffusion as eq14
from .. import eq16_response as eq16
from .. import leaning as tilted
from ..framework.vocabulary import Groups

PLANE = 2
"""The dimension of a packing of discs."""


class ObservableError(ForceDiffusionError, ValueError):
    """An observable or load that the calculator doesn't take; the message says what it takes."""


def without_load() -> Groups:
    """What contact directions and positions are in the radii."""
    return eq05.directions(), eq03.positions()


@dataclass(frozen=True)
class LoadCase:
    """A load, and the forces in the ordered packing.

    Attributes:
        loading: what the kernel knows of it.
        top: the layer that bears it, or the highest of those.
        ordered: the ordered forces of a contact of layer j along n⁺ and along n⁻ (in three
            dimensions along n¹, n² and n³), or what forces are compared with where some are zero.
        forces: gives what they and contact directions are in the radii; of spheres nothing.
    """

    loading: Loading
    top: sympy.Symbol
    ordered: tuple[sympy.Expr, ...]
    forces: Callable[[], Groups]

    def groups(self) -> Groups:
        """What forces, contact directions and positions are in the radii; of spheres nothing."""
        return (*self.forces(), eq03.positions()) if self.dimension == PLANE else ()

    @property
    def dimension(self) -> int:
        """Of the packing."""
        return len(self.ordered)

    @property
    def unit(self) -> sympy.Expr:
        """What a vertical force on a bead is compared with."""
        return sympy.Add(*self.ordered) * (n_y if self.dimension == PLANE else 1)


def _vertical(
    forces: Callable[[], Groups], loading: Loading, top: sympy.Symbol, force: sympy.Expr
) -> LoadCase:
    return LoadCase(loading, top, (force / (2 * n_y),) * 2, forces)


def _leaning(load: str, loading: Loading, layers: sympy.Expr) -> LoadCase:
    ordered = layers * L_plus, layers * t * L_plus
    return LoadCase(loading, M, ordered, partial(tilted.in_radii, load))


_POINT_LOAD = _vertical(eq16.in_radii, axioms.POINT, l, f_load)
_BY_NAME = {
    "surface": _vertical(eq11.in_radii, axioms.SURFACE, M, f_load),
    "bulk": _vertical(eq14.in_radii, axioms.BULK, M, (M - j) * m_g),
}
_LEANING = {
    "surface": _leaning("surface", axioms.SURFACE_TILTED, sympy.S.One),
    "bulk": _leaning("bulk", axioms.BULK_TILTED, M - j),
}


def _spheres(name: str, factor: sympy.Expr, leaning: bool, top: sympy.Symbol = M) -> LoadCase:
    """A load in three dimensions; forces are in units of what one layer of it gives along n¹."""
    ratios = (sympy.S.One, t_2, t_3) if leaning else (sympy.S.One,) * 3
    return LoadCase(SPHERES[name], top, tuple(factor * ratio for ratio in ratios), tuple)


_IN_THREE = {
    "surface": _spheres("surface", sympy.S.One, False),
    "bulk": _spheres("bulk", M - j, False),
    "surface leaning": _spheres("surface leaning", sympy.S.One, True),
    "bulk leaning": _spheres("bulk leaning", M - j, True),
    "point": _spheres("point", sympy.S.One, False, l),
}
"""Loads on packings of spheres, by their names."""


def point(across: sympy.Expr, layer: sympy.Expr) -> LoadCase:
    """A load f_load straight down on bead (k, l), and none on the others.

    Args:
        across: k, of ``force_diffusion.symbols``.
        layer: l.

    Raises:
        ObservableError: these are other indices than k and l.
    """
    if (across, layer) != (k, l):
        raise ObservableError(f"point({across}, {layer}): name the loaded bead (k, l)")
    return _POINT_LOAD


def leaning(ratio: sympy.Expr, load: str = "surface") -> LoadCase:
    """A load −(L⁺n⁺ + L⁻n⁻) on every bead of the surface, or on every bead, with L⁻ = t L⁺.

    Args:
        ratio: t, of ``force_diffusion.symbols``; ``at(t=…)`` of a closed form takes its value.
        load: "surface" or "bulk".

    Raises:
        ObservableError: the ratio or the load is something else.
    """
    if load not in _LEANING:
        raise ObservableError(f"leaning(…, {load!r}): 'surface' or 'bulk' is allowed")
    if ratio != t:
        raise ObservableError(f"leaning({ratio}): the symbol t is allowed; at(t=…) takes its value")
    return _LEANING[load]


def load_of(load: str | LoadCase, dimension: int = 2) -> LoadCase:
    """A load by its name, or as it is.

    Raises:
        ObservableError: there is none of that name, or none in that dimension.
    """
    if dimension not in (2, 3):
        raise ObservableError(f"dimension={dimension!r}: 2 and 3 are allowed")
    if dimension == PLANE and isinstance(load, LoadCase):
        return load
    known = _BY_NAME if dimension == PLANE else _IN_THREE
    if isinstance(load, str) and load in known:
        return known[load]
    allowed = "'surface', 'bulk', point(k, l) and leaning(t) are allowed"
    if dimension != PLANE:
        allowed = f"{', '.join(map(repr, known))} are allowed in three dimensions"
    shown = load.loading.name if isinstance(load, LoadCase) else repr(load)
    raise ObservableError(f"load={shown}: {allowed}")
