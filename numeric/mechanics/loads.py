"""Loads as components of the supporting direction, and the ordered forces they cause.

F_load = −(L⁺ n⁺ + L⁻ n⁻), so that in the ordered packing a load adds L^± to every contact of the
same orientation straight below it. A vertical unit load has L⁺ = L⁻ = 1/(2 n_y).
"""

from collections.abc import Mapping
from typing import Any

from force_diffusion.numeric.arithmetic.systems import NumberSystem, zeros
from force_diffusion.numeric.lattice.layers import Layer, lowest_column
from force_diffusion.numeric.mechanics.forces import Loads

Components = tuple[Any, Any]


def components(fx: Any, fy: Any, n_x: Any, n_y: Any) -> Components:
    """Turn a Cartesian load (fx, fy) into (L⁺, L⁻).

    >>> from fractions import Fraction
    >>> components(0, -1, Fraction(3, 5), Fraction(4, 5))
    (Fraction(5, 8), Fraction(5, 8))
    """
    return (-(fx / n_x) - fy / n_y) / 2, (fx / n_x - fy / n_y) / 2


def on_rows(
    loads: Mapping[tuple[int, int], Components],
    rows: tuple[Layer, ...],
    width: int | None,
    system: NumberSystem,
) -> Loads:
    """Put the loads of single beads {(i, j): (L⁺, L⁻)} on the rows; beads outside are left out."""
    plus: list[Any] = [None] * len(rows)
    minus: list[Any] = [None] * len(rows)
    for (i, j), (up, um) in loads.items():
        if j >= len(rows):
            continue
        q = (i - rows[j].first) // 2
        if width is not None:
            q %= width
        if not 0 <= q < rows[j].count:
            continue
        if plus[j] is None:
            plus[j] = zeros(system, rows[j].count)
            minus[j] = zeros(system, rows[j].count)
        plus[j][q] = plus[j][q] + up
        minus[j][q] = minus[j][q] + um
    return Loads(tuple(plus), tuple(minus))


def on_layers(
    load: Components, rows: tuple[Layer, ...], layers: range, system: NumberSystem
) -> Loads:
    """Put the same load on every bead of some layers (surface: only M; bulk: all)."""
    plus: list[Any] = [None] * len(rows)
    minus: list[Any] = [None] * len(rows)
    for j in layers:
        plus[j] = zeros(system, rows[j].count) + load[0]
        minus[j] = zeros(system, rows[j].count) + load[1]
    return Loads(tuple(plus), tuple(minus))


def sites(width: int, height: int) -> list[tuple[int, int]]:
    """All sites (i, j) of a periodic packing, layer by layer."""
    return [(i, j) for j in range(height + 1) for i in range(lowest_column(j), 2 * width, 2)]
