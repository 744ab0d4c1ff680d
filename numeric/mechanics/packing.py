"""The exact packing in deviation form and line-sum coordinates (Eqs. 2–5, without linearising).

A bead's displacement δx is carried as c^± = n^±·δx. To first order each is a sum of δr down
one diagonal; here nothing is linearised. With v_A, v_B the displacements of the supports
A = x − e₊ and B = x − e₋, p = δx − v_A, q = δx − v_B, ρ^± = δr_x + δr_(x − e_±) and r = 1, the two
contacts say exactly

    n⁺·p + |p|²/4 = ρ⁺ + ρ⁺²/4        and        n⁻·q + |q|²/4 = ρ⁻ + ρ⁻²/4.

The unknown is A = |p|²/4, small of second order: it obeys a quadratic whose small root has a
form without cancellation, so no ordered position is ever added or subtracted.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, NamedTuple

import numpy as np

from ..arithmetic.errors import ForceDiffusionError, UndecidedError
from ..arithmetic.systems import Array, NumberSystem, zeros
from ..lattice.branch import PerBranch
from ..lattice.layers import Layer, Region, pick, shifted
from .work import Work


class Metric(NamedTuple):
    """φ = n⁺·n⁻ and 1/(1 − φ²), in the number system of a sweep."""

    phi: Any
    inverse_det: Any


def metric(n_x: Fraction, system: NumberSystem) -> Metric:
    """Turn n_x = s/4r into φ = 1 − 2 n_x² and 1/(1 − φ²); each is rounded once."""
    phi = 1 - 2 * n_x**2
    return Metric(system.scalar(phi), system.scalar(1 / (1 - phi**2)))


def raised(plus: Any, minus: Any, m: Metric) -> tuple[Any, Any]:
    """Turn the components n^±·d of a vector into those of d = d₊ n⁺ + d₋ n⁻ (multiply by G⁻¹)."""
    return (plus - m.phi * minus) * m.inverse_det, (minus - m.phi * plus) * m.inverse_det


class Placed(NamedTuple):
    """Beads at rest on their supports; all arrays have the beads' shape.

    ``c_plus``, ``c_minus``: n^±·δx. ``plus`` (``minus``): δn of the contact with x − e₊ (x − e₋),
    as components (a, b) of δn = a n⁺ + b n⁻. ``rests``: the discriminant and the two measures of
    the supports' tilt, all of which are positive where a bead can rest.
    """

    c_plus: Array
    c_minus: Array
    plus: tuple[Array, Array]
    minus: tuple[Array, Array]
    rests: tuple[Array, Array, Array]


def place(
    below: tuple[Array, Array, Array, Array],
    rho_plus: Array,
    rho_minus: Array,
    m: Metric,
    system: NumberSystem,
) -> Placed:
    """Rest beads on their supports (Eqs. 2, 4 and 5, exact).

    ``below`` holds (c⁺_A, c⁻_A, c⁺_B, c⁻_B) of the supports A = x − e₊, B = x − e₋; ``rho_plus``
    and ``rho_minus`` are δr_x + δr_A and δr_x + δr_B, in units of r.
    """
    ap, am, bp, bm = below
    up, um = ap - bp, am - bm
    Up, Um = raised(up, um, m)
    r_plus = rho_plus + rho_plus * rho_plus / 4
    r_minus = rho_minus + rho_minus * rho_minus / 4
    # First guess p⁰ = (R⁺, R⁻ − u⁻), then p = P − A e with A = |p|²/4 still unknown.
    guess = r_minus - um
    tilt_plus, tilt_minus = 1 - Up / 2, 1 + Um / 2
    gap = ((r_plus + up / 2) * Up + (guess + um / 2) * Um) / 2
    lift = gap / tilt_minus
    pm0 = guess - lift
    e = tilt_plus / tilt_minus
    Ep, Em = raised(1, e, m)
    Pp, Pm = raised(r_plus, pm0, m)
    size = r_plus * Pp + pm0 * Pm
    b = 1 + (r_plus * Ep + pm0 * Em) / 2
    discriminant = b * b - (Ep + e * Em) * size / 4
    A = size / (b + system.sqrt(discriminant)) / 2
    # |q|²/4 follows from the difference of the two contacts.
    B = A * e + lift
    plus = _direction(pm0 - A * e, rho_plus, A, m)
    swapped = _direction(r_plus - A + up, rho_minus, B, m)
    return Placed(
        ap + (r_plus - A),
        bm + (r_minus - B),
        plus,
        (swapped[1], swapped[0]),
        (discriminant, tilt_plus, tilt_minus),
    )


def _direction(across: Array, rho: Array, square: Array, m: Metric) -> tuple[Array, Array]:
    """Give δn = (d − ρ n)/(2 + ρ) as (component along n, component along the other n)."""
    length = 2 + rho
    return raised((rho * rho / 4 - square) / length, (across - m.phi * rho) / length, m)


@dataclass(frozen=True)
class SolvedPacking:
    """A solved packing: per layer j, arrays over the beads of ``region.rows[j]``, units of r.

    ``rho``: δr/r. ``c``: n^±·δx/r. ``dn.plus[j]``, ``dn.minus[j]`` (empty at j = 0): δn of the
    contacts below, as components (a, b) of δn = a n⁺ + b n⁻; ``plus`` belongs to the contact whose
    lower bead is (i − 1, j − 1), ``minus`` to that with (i + 1, j − 1).
    """

    n_x: Fraction
    system: NumberSystem
    region: Region
    rho: Sequence[Array]
    c: PerBranch[Sequence[Array]]
    dn: PerBranch[Sequence[tuple[Array, Array]]]


@dataclass(frozen=True)
class CompiledPacking(SolvedPacking):
    """A packing of compiled sweeps, whose beads lie row after row.

    ``flat``: δr/r, (batch, beads). ``block``, (batch, 6, …): c⁺, c⁻, the δn of plus, of minus.
    """

    flat: Array
    block: Array


class UnbuildableError(ForceDiffusionError, ValueError):
    """A bead can't rest on its two supports; ``site`` names it."""

    def __init__(self, site: tuple[int, ...], reason: str) -> None:
        """Name the bead and what is wrong with it."""
        super().__init__(f"bead {site}: {reason}")
        self.site = site


def deposit(
    n_x: Fraction,
    region: Region,
    rho: Sequence[Array],
    system: NumberSystem,
    work: Work | None = None,
    *,
    on: tuple[Array, Array] | None = None,
) -> SolvedPacking:
    """Deposit beads layer by layer on the ordered base, exactly (no linearisation).

    ``rho[j]`` holds δr/r of the beads of ``region.rows[j]`` (shape (count,), or (…, count) for a
    batch of packings). ``on`` holds c⁺ and c⁻ of the lowest row, if it is not the ordered base. The
    caller activates ``system``. Raises ``UnbuildableError``, naming the
    bead, where a radius is not positive (or no number) or the supports are too far apart or too
    steep, and ``UndecidedError`` where balls are too wide to tell.
    """
    m = metric(n_x, system)
    if work is not None:
        work.did("deposited", region.rows[0], rho[0].size // region.rows[0].count)
    nothing = zeros(system, 0)
    base = zeros(system, *rho[0].shape)
    c_plus, c_minus = ([base], [base]) if on is None else ([on[0]], [on[1]])
    plus = [(nothing, nothing)]
    minus = [(nothing, nothing)]
    _check_radii(rho[0], region.rows[0], system)
    for j in range(1, region.top + 1):
        _check_radii(rho[j], region.rows[j], system)
        layer, under = region.rows[j], region.rows[j - 1]
        left = Layer(j - 1, layer.first - 1, layer.count)
        right = shifted(layer, -1)

        def at(values: Array, wanted: Layer, under: Layer = under) -> Array:
            return pick(values, under, wanted, region.width)

        placed = place(
            (at(c_plus[-1], left), at(c_minus[-1], left),
             at(c_plus[-1], right), at(c_minus[-1], right)),
            rho[j] + at(rho[j - 1], left),
            rho[j] + at(rho[j - 1], right),
            m,
            system,
        )  # fmt: skip
        _check_rest(placed, layer, system)
        if work is not None:
            work.did("deposited", layer, rho[j].size // layer.count)
        c_plus.append(placed.c_plus)
        c_minus.append(placed.c_minus)
        plus.append(placed.plus)
        minus.append(placed.minus)
    return SolvedPacking(
        n_x,
        system,
        region,
        rho,
        PerBranch(tuple(c_plus), tuple(c_minus)),
        PerBranch(tuple(plus), tuple(minus)),
    )


def _check_radii(rho: Array, layer: Layer, system: NumberSystem) -> None:
    _, bad = system.signs(1 + rho)
    if bad.any():
        q = int(np.argwhere(bad)[0][-1])
        raise UnbuildableError((layer.first + 2 * q, layer.j), "its radius is no positive number")


def _check_rest(placed: Placed, layer: Layer, system: NumberSystem) -> None:
    """Raise ``UnbuildableError`` or ``UndecidedError`` unless every bead surely rests."""
    open_question = False
    for values, reason in zip(
        placed.rests,
        (
            "its supports are too far apart to hold it, or too close to hold it up",
            "the line through its supports is steeper than n⁻",
            "the line through its supports is steeper than n⁺",
        ),
        strict=True,
    ):
        good, bad = system.signs(values)
        if bad.any():
            q = int(np.argwhere(bad)[0][-1])
            raise UnbuildableError((layer.first + 2 * q, layer.j), reason)
        open_question |= not good.all()
    if open_question:
        raise UndecidedError(
            f"layer {layer.j}: the enclosures are too wide to tell whether beads rest"
        )
