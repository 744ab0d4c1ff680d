"""Packings and their forces, swept layer by layer: discs or spheres, any number system.

The beads of a row are calculated with as arrays, by the one source in ``local``. ``kernels`` runs
the same source compiled, bit for bit. Forces are in units of the load's magnitude, loads in
components of the *supporting* direction: F_load = −Σ_a L^a n^a. A contact is indexed by its upper
bead x, and has the lower bead x − e_a: in two dimensions ``plus`` below (i, j) is the paper's
f⁺_(i−1, j−1), ``minus`` is f⁻_(i+1, j−1).
"""

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from fractions import Fraction
from functools import partial
from typing import Any

import numpy as np

from ..arithmetic.carried import CARRYING, Carried
from ..arithmetic.errors import ForceDiffusionError, UndecidedError
from ..arithmetic.systems import Array, NumberSystem, zeros
from ..disorder.radii import RadiusError
from ..lattice.branch import AxisContact, Contact, Direction, PerBranch, per_direction
from ..lattice.layers import Layer, Region, Rows, bead_of
from . import defects
from .local import balance, metric, nested, rest
from .work import Work


class UnbuildableError(ForceDiffusionError, ValueError):
    """A bead can't rest on its supports; ``site`` names it."""

    def __init__(self, site: tuple[int, ...], reason: str) -> None:
        """Name the bead and what is wrong with it."""
        super().__init__(f"bead {site}: {reason}")
        self.site = site


class NotStandingError(ForceDiffusionError, ValueError):
    """No forces hold a bead up, since its contacts lie in a line or plane; ``site`` names it."""

    def __init__(self, site: tuple[int, ...]) -> None:
        """Name the bead."""
        why = "the two contacts below it are parallel"
        if len(site) > 2:
            why = "the contacts below it lie in one plane"
        super().__init__(f"bead {site}: {why}")
        self.site = site


@contextmanager
def radii_named(region: Region) -> Iterator[None]:
    """Let a ``RadiusError`` about a site of a row name the bead."""
    try:
        yield
    except RadiusError as error:
        if region.dimension == 2:
            raise
        i, j = error.site
        raise RadiusError(bead_of((i, j), region.side), error.reason) from None


@dataclass(frozen=True)
class SolvedPacking:
    """Beads at rest: per layer j, arrays over the beads of ``region.rows[j]``, units of r.

    ``rho``: δr/r. ``c``: n^a·δx/r of each direction. ``dn[branch][j]`` (empty at j = 0): δn of the
    contacts below along it, as the components of δn = Σ_b dn_b n^b. Arrays of a batch of packings
    have a first axis more. ``memory``: all numbers in one block, where compiled loops made them.
    """

    phi: Fraction
    system: NumberSystem
    region: Region
    rho: Sequence[Array]
    c: PerBranch[Sequence[Array]]
    dn: PerBranch[Sequence[tuple[Array, ...]]]
    memory: "Memory | None" = None


@dataclass(frozen=True)
class Memory:
    """What compiled loops fill: ``rho`` (batch, beads); ``block`` (batch, d + d², …), c and δn.

    ``most``: how large each quantity of the block is at the most, (batch, d + d²).
    """

    rho: Array
    block: Array
    most: Array


Loads = PerBranch[tuple[Array | None, ...]]
"""Loads on the beads of rows[j] (j = 0 … top): components L^a (units of the magnitude).

Rows that carry no load may be None; shape of the others: (rows[j].count,).
"""


@dataclass(frozen=True)
class Forces:
    """Contact forces below the beads of ``rows[j]`` (empty at j = 0), indexed by the upper bead.

    ``ordered``: F^a, ``change``: g^a = f^a − F^a; per layer arrays of shape (count,), changes of a
    batch of packings (…, count). ``F`` (d, …) and ``g`` (batch, d, …) hold all of compiled loops,
    from the lowest row that forces reach on. ``hold``: it is known that none of them pulls.
    """

    system: NumberSystem
    region: Region
    rows: Rows
    ordered: PerBranch[Sequence[Array]]
    change: PerBranch[Sequence[Array]]
    F: Array | None = None
    g: Array | None = None
    hold: bool = False

    def below(self, j: int) -> Iterator[tuple[Direction, Array, Array]]:
        """Give (branch, F, g) of the contacts below row j."""
        for branch, F in self.ordered:
            yield branch, F[j], self.change[branch][j]

    def contact(self, layer: Layer, branch: Direction, column: int) -> Contact | AxisContact:
        """Name the contact below a bead of a row."""
        return self.region.contact_below(layer, branch, column)


def deposit(
    phi: Fraction,
    region: Region,
    rho: Sequence[Any],
    system: NumberSystem,
    work: Work | None = None,
    *,
    linear: bool = False,
) -> SolvedPacking:
    """Deposit beads layer by layer on the ordered base; to first order only if ``linear``.

    ``phi`` is the dot product of any two base vectors.
    ``rho[j]`` holds δr/r of the beads of ``region.rows[j]`` (shape (count,), or (…, count) for a
    batch of packings). The caller activates ``system``. Raises ``UnbuildableError``, naming the
    bead, where a radius is not
    positive (or no number) or the supports are too far apart or too steep, and ``UndecidedError``
    where balls are too wide to tell.
    """
    d, kind = region.dimension, "summed" if linear else "deposited"
    m = metric(d, phi, system.scalar)
    nothing = zeros(system, 0)
    base = zeros(system, *_shape(rho[0]))
    down = [region.step(a, -1) for a in range(d)]
    c: list[tuple[Any, ...]] = [(base,) * d]
    dn: list[tuple[tuple[Any, ...], ...]] = [((nothing,) * d,) * d]
    layers = tuple(region.rows)
    for j, layer in enumerate(layers):
        if work is not None:
            work.did(kind, layer, _beads(rho[j]) // max(layer.count, 1))
        if not linear:
            _check_radii(rho[j], layer, region, system)
        if not j:
            continue
        looks = [region.look(layers[j - 1], layer, one) for one in down]
        under = [tuple([_moved(look, v) for v in c[-1]]) for look in looks]
        radii = tuple([_moved(look, rho[j - 1]) for look in looks])
        if system is CARRYING and not linear:
            found = defects.rest(under, rho[j], radii, m)
        else:
            found = rest(under, rho[j], radii, m, system.sqrt, linear=linear)
        _check_rest(found.holds, layer, region, system, partial(nested, under, radii, m))
        c.append(found.c)
        dn.append(found.dn)

    def turned(a: int) -> tuple[Any, ...]:
        return tuple(row[a] for row in dn)

    return SolvedPacking(
        phi,
        system,
        region,
        rho,
        per_direction([tuple(row[a] for row in c) for a in range(d)]),
        per_direction([turned(a) for a in range(d)]),
    )


def sweep_down(
    packing: SolvedPacking,
    rows: Rows,
    loads: Loads,
    *,
    linear: bool = False,
    work: Work | None = None,
) -> Forces:
    """Carry loads down from the highest of ``rows`` through the beads of ``rows``.

    Exactly; or, with ``linear``, to first order: then forces are sums along the base vectors, and
    there is nothing to invert (Eqs. 6–11, for a packing that was deposited so).

    ``rows[j]`` for j = 0 … top lie within the packing's region; ``loads`` belong to them. Beads
    above or beside the rows pass no force on to them. The caller activates the number system.
    Raises ``NotStandingError`` where contacts are parallel within the arithmetic.
    """
    top, region, system = len(rows) - 1, packing.region, packing.system
    d = region.dimension
    compensated = system.dtype is not object
    zero = zeros(system, 1)[0] if system is not CARRYING else 0.0
    nothing = zeros(system, 0)
    ordered: list[tuple[Any, ...]] = [(nothing,) * d] * (top + 1)
    change: list[tuple[Any, ...]] = [(nothing,) * d] * (top + 1)
    lost: tuple[Any, ...] = ()
    dn = [rows_of for _, rows_of in packing.dn]
    shares = [of for _, of in loads]
    up = [region.step(a, 1) for a in range(d)]
    layers, deposited = tuple(rows), tuple(region.rows)
    for j in range(top, 0, -1):
        layer = layers[j]
        if not layer.count:
            break
        above: list[tuple[Any, Any, tuple[Any, ...], Any]] = []
        for a in range(d):
            if j == top:
                none = zeros(system, layer.count)
                above.append((none, none, (none,) * d, np.zeros(layer.count)))
                continue
            own = region.look(layers[j + 1], layer, up[a], zero)
            packed = region.look(deposited[j + 1], layer, up[a], zero)
            above.append(
                (
                    _moved(own, ordered[j + 1][a]),
                    _moved(own, change[j + 1][a]),
                    tuple([_moved(packed, v) for v in dn[a][j + 1]]),
                    _moved(own, lost[a]) if compensated else None,
                )
            )
        F = tuple(
            above[a][0] if share[j] is None else above[a][0] + share[j]
            for a, share in enumerate(shares)
        )
        here = partial(region.here, source=deposited[j], layer=layer)
        below = [tuple([_moved(here, x) for x in dn[a][j]]) for a in range(d)]
        if system is CARRYING and not linear:
            found = defects.balance(above, F, below)
        else:
            found = balance(above, F, below, linear=linear, compensated=compensated)
        if not linear:
            check_standing(found.det, layer, region, system)
        if work is not None:
            work.did("balanced", layer, _beads(found.g[0]) // layer.count)
        ordered[j], change[j], lost = F, found.g, found.lost
    return Forces(
        system,
        region,
        rows,
        per_direction([tuple(row[a] for row in ordered) for a in range(d)]),
        per_direction([tuple(row[a] for row in change) for a in range(d)]),
    )


def straight_down(
    rows: Sequence[Layer], region: Region, loads: Loads, system: NumberSystem
) -> list[tuple[Any, ...]]:
    """Give the ordered forces below each row: loads go straight down."""
    d, top = region.dimension, len(rows) - 1
    zero = zeros(system, 1)[0] if system is not CARRYING else 0.0
    found: list[tuple[Any, ...]] = [(zeros(system, 0),) * d] * (top + 1)
    for j in range(top, 0, -1):
        layer = rows[j]
        if not layer.count:
            break
        parts = []
        for a, (_, share) in enumerate(loads):
            F = zeros(system, layer.count)
            if j < top:
                look = region.look(rows[j + 1], layer, region.step(a, 1), zero)
                F = _moved(look, found[j + 1][a])
            parts.append(F if share[j] is None else F + share[j])
        found[j] = tuple(parts)
    return found


# A float64 force has no sign within so much of its layer's largest change.
SIGNS = 2.0**-40


def pulling(force: Any, change: Any, system: NumberSystem) -> tuple[Array, Array]:
    """Tell contacts that surely pull and those whose sign is open; two boolean arrays.

    Balls decide by their own radius. Hardware floats have none: there a force is taken as open
    within 2^-40 of its layer's largest change, far above their measured error below M*.
    """
    if isinstance(force, Carried):
        force, change = force.value, change.value
    if system.dtype is object:
        pulls, holds = system.signs(-force)
        return pulls, ~(pulls | holds)
    room = SIGNS * np.abs(change).max(initial=0)
    return force < -room, (np.abs(force) <= room) & (force != 0)


def _moved(function: Callable[[Array], Array], values: Any) -> Any:
    """Look values up at other sites; those that carry errors with them."""
    if isinstance(values, Carried):
        return Carried(function(values.value), function(values.error))
    return function(values)


def _shape(values: Any) -> tuple[int, ...]:
    return tuple((values.value if isinstance(values, Carried) else values).shape)


def _beads(values: Any) -> int:
    return int((values.value if isinstance(values, Carried) else values).size)


def _check_radii(rho: Any, layer: Layer, region: Region, system: NumberSystem) -> None:
    _, bad = system.signs(1 + rho)
    if bad.any():
        raise UnbuildableError(_site(bad, layer, region), "its radius is no positive number")


# What is wrong where one of the measures of ``local.rest`` is not positive.
REMEDY = "; less disorder or fewer layers would help"
APART = (
    "its supports are too far apart to hold it; less disorder, fewer layers or a smaller spacing "
    "would help"
)
NESTED = (
    "its supports are too close to hold it up, and one is much larger than the other; less "
    "disorder or a larger spacing would help"
)
STEEP = f"the line through its supports is steeper than n⁺ or n⁻{REMEDY}"
STEEP_PLANE = (
    f"the plane through its supports is steeper than a base vector, or they lie crosswise{REMEDY}"
)


def _check_rest(
    holds: Sequence[Any],
    layer: Layer,
    region: Region,
    system: NumberSystem,
    close: Callable[[], Sequence[Any]],
) -> None:
    """Raise ``UnbuildableError`` or ``UndecidedError`` unless every bead surely rests.

    ``close`` gives what is positive where two supports are too close.
    """
    open_question = False
    for number, values in enumerate(holds):
        good, bad = system.signs(values)
        if bad.any():
            why, first = STEEP if region.dimension == 2 else STEEP_PLANE, tuple(np.argwhere(bad)[0])
            if not number:
                why = NESTED if any(system.signs(one)[0][first] for one in close()) else APART
            raise UnbuildableError(_site(bad, layer, region), why)
        open_question |= not good.all()
    if open_question:
        raise UndecidedError(
            f"layer {layer.j}: the enclosures are too wide to tell whether beads rest"
        )


def check_standing(det: Any, layer: Layer, region: Region, system: NumberSystem) -> None:
    """Raise ``NotStandingError`` where contacts are parallel; ``det`` is that of their N."""
    good, bad = system.signs(det * det)
    if not good.all():
        wrong = ~good if not bad.any() else bad
        raise NotStandingError(_site(wrong, layer, region))


def _site(bad: Array, layer: Layer, region: Region) -> tuple[int, ...]:
    return region.bead(layer, int(np.argwhere(bad)[0][-1]))
