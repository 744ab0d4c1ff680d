"""The loads that a packing may carry, and what theorems say of its forces then."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache

import sympy
from force_diffusion.derivations import eq03_extrapolation as eq03
from force_diffusion.derivations import eq04_contact_plus as eq04
from force_diffusion.derivations import eq05_contact_minus as eq05
from force_diffusion.derivations import eq11_total_force as eq11
from force_diffusion.derivations import eq14_bulk_diffusion as eq14
from force_diffusion.derivations.beyond import t1_forces as t1
from force_diffusion.derivations.parts import cone
from force_diffusion.numeric.arithmetic.errors import ForceDiffusionError
from force_diffusion.symbolic.kernel import axioms, rules
from force_diffusion.symbolic.kernel.theorem import Theorem
from force_diffusion.symbolic.kernel.where import BULK, POINT, SURFACE, Loading
from force_diffusion.symbolic.symbols import L_plus, M, f_load, j, k, l, m_g, n_y, t


class ObservableError(ForceDiffusionError, ValueError):
    """An observable or a load is none that the calculator knows; the message says what is allowed."""


@dataclass(frozen=True)
class Load:
    """A load, the forces in the ordered packing, and the theorems about those in a disordered one.

    Attributes:
        name: in words.
        loading: the same for the kernel.
        top: the layer that bears it, or the highest of those.
        ordered: the ordered forces of a contact of layer j along n⁺ and along n⁻, or what forces
            are compared with where some of these are zero.
        unit: what a vertical force on a bead is compared with.
        theorems: both forces in the radii.
        equations: where these are proved.
        values: numbers for symbols of the load.
    """

    name: str
    loading: Loading
    top: sympy.Symbol
    ordered: tuple[sympy.Expr, sympy.Expr]
    unit: sympy.Expr
    theorems: Callable[[], tuple[Theorem, ...]]
    equations: tuple[int | str, ...]
    values: tuple[tuple[sympy.Symbol, sympy.Expr], ...] = ()


@cache
def geometry() -> tuple[Theorem, ...]:
    """Positions and contact directions in the radii."""
    equations = (eq03, eq04, eq05)
    return (axioms.base(), *(one for eq in equations for one in eq.DERIVATION.theorems))


def _with_mirror_images(theorems: Callable[[], tuple[Theorem, ...]]) -> tuple[Theorem, ...]:
    return (*theorems(), *map(rules.mirror, theorems()))


SURFACE_LOAD = Load(
    "a surface load",
    SURFACE,
    M,
    (f_load / (2 * n_y),) * 2,
    f_load,
    cache(lambda: _with_mirror_images(lambda: eq11.DERIVATION.theorems)),
    (11,),
)
BULK_LOAD = Load(
    "a bulk load",
    BULK,
    M,
    ((M - j) * m_g / (2 * n_y),) * 2,
    (M - j) * m_g,
    cache(lambda: _with_mirror_images(lambda: eq14.FORCE.theorems)),
    (14,),
)
_POINT_LOAD = Load(
    "a load on one bead",
    POINT,
    l,
    (f_load / (2 * n_y),) * 2,
    f_load,
    cache(cone._forces),
    (7, 9, 10),
)


def _leaning(name: str, tilted: t1.Tilted) -> Load:
    both = tilted.ordered[0], tilted.layers * t * L_plus
    return Load(
        name, tilted.loading, M, both, sum(both) * n_y, cache(lambda: tilted.forces.theorems), ("B1",)
    )


_ON_SURFACE, _IN_BULK = t1.Tilted.both()
_LEANING = {
    "surface": _leaning("a leaning surface load", _ON_SURFACE),
    "bulk": _leaning("a leaning bulk load", _IN_BULK),
}
_BY_NAME = {"surface": SURFACE_LOAD, "bulk": BULK_LOAD}


def point(across: sympy.Expr, layer: sympy.Expr) -> Load:
    """A load f_load straight down on the bead (k, l), and nothing else.

    Args:
        across: k, of ``force_diffusion.symbols``.
        layer: l.

    Raises:
        ObservableError: other indices are given.
    """
    if (across, layer) != (k, l):
        raise ObservableError(f"point({across}, {layer}): name the loaded bead (k, l)")
    return _POINT_LOAD


def leaning(ratio: sympy.Expr, load: str = "surface") -> Load:
    """A load −(L⁺n⁺ + L⁻n⁻) on every bead of the surface, or on every bead, with L⁻ = ratio · L⁺.

    Args:
        ratio: t of ``force_diffusion.symbols``, or a positive rational number.
        load: "surface" or "bulk".

    Raises:
        ObservableError: the ratio is something else, or there is no such load.
    """
    if load not in _LEANING:
        raise ObservableError(f"leaning(…, {load!r}): 'surface' or 'bulk' is allowed")
    value = sympy.sympify(ratio)
    if value == t:
        return _LEANING[load]
    if not (isinstance(value, sympy.Rational) and value > 0):
        raise ObservableError(f"leaning({ratio}): the symbol t or a positive rational is allowed")
    return replace(_LEANING[load], values=((t, value),))


def load_of(load: str | Load) -> Load:
    """A load by its name, or as it is.

    Raises:
        ObservableError: there is none of that name.
    """
    if isinstance(load, Load):
        return load
    if load not in _BY_NAME:
        raise ObservableError(
            f"load={load!r}: 'surface', 'bulk', point(k, l) and leaning(t) are allowed"
        )
    return _BY_NAME[load]
