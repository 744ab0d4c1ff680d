"""Contact forces on a solved packing, as additive changes g = f − F of the ordered forces F.

Forces are in units of the load's magnitude, loads in components of the *supporting* direction:
F_load = −(L⁺ n⁺ + L⁻ n⁻). A contact is indexed by its upper bead (i, j): ``plus`` has the lower
bead (i − 1, j − 1) and is the paper's f⁺_(i−1, j−1), ``minus`` has (i + 1, j − 1), f⁻_(i+1, j−1).
At every bead (Eq. 6, exact, N = n + δn)

    g⁺N⁺ + g⁻N⁻ (lower) = Σ g N (upper) + Σ F δn (upper) − Σ F δn (lower),

where the load and all that is ordered have dropped out by themselves. Components are taken along
n⁺ and n⁻, so that the linear part of a layer is a shift and an addition.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..arithmetic.errors import ForceDiffusionError, UndecidedError
from ..arithmetic.systems import MOST_BITS, Array, Balls, NumberSystem, zeros
from ..lattice.branch import AxisContact, Branch, Contact, Direction, PerBranch
from ..lattice.layers import Layer, pick
from .packing import SolvedPacking
from .work import Work


class NotStandingError(ForceDiffusionError, ValueError):
    """The two contacts below a bead are parallel: no forces can hold it up; ``site`` names it."""

    def __init__(
        self, site: tuple[int, ...], reason: str = "the two contacts below it are parallel"
    ) -> None:
        """Name the bead."""
        super().__init__(f"bead {site}: {reason}")
        self.site = site


Loads = PerBranch[tuple[Array | None, ...]]
"""Loads on the beads of rows[j] (j = 0 … top): components L^± (units of the magnitude).

Rows that carry no load may be None; shape of the others: (rows[j].count,).
"""


@dataclass(frozen=True)
class Forces:
    """Contact forces below the beads of ``rows[j]`` (empty at j = 0), indexed by the upper bead.

    ``ordered``: F^±, ``change``: g^± = f^± − F^±; per layer arrays of shape (count,), changes of a
    batch of packings (…, count). ``stopped`` names the first tensile contact where a sweep was
    asked to stop at one: the layers below it are then empty. ``lost``: what the sums of the lowest
    row that was balanced have lost (see ``added``), for a sweep that goes on from there.
    """

    system: NumberSystem
    rows: tuple[Layer, ...]
    ordered: PerBranch[Sequence[Array]]
    change: PerBranch[Sequence[Array]]
    stopped: Contact | None = None
    lost: tuple[Any, Any] = (0, 0)

    def below(self, j: int) -> Iterator[tuple[Direction, Array, Array]]:
        """Give (branch, F, g) of the contacts below row j."""
        for branch, F in self.ordered:
            yield branch, F[j], self.change[branch][j]

    def contact(self, layer: Layer, branch: Direction, column: int) -> Contact | AxisContact:
        """Name the contact below a bead of a row."""
        return Contact(layer.first + 2 * column - branch.side, layer.j - 1, Branch(branch))


Above = tuple[tuple[Array, Array], tuple[Array, Array], tuple[Any, Any]]
"""Forces of a row that is balanced already: F^±, g^±, and what the sums of g^± have lost."""


@dataclass(frozen=True)
class Ordered:
    """Ordered forces of all packings alike: numbers, where each row's begin, and where zeros are.

    By branches; ``start`` (layers + 1,), of which the last is that of nothing above the highest.
    """

    values: tuple[Array, ...]
    start: tuple[Array, ...]
    missing: tuple[int, int]


@dataclass(frozen=True, kw_only=True)
class CompiledForces(Forces):
    """Forces of compiled sweeps: their changes lie in ``g``, (batch, branches, …), row after row.

    ``F`` are the ordered ones; ``starts`` says where rows begin in ``g``, ``lowest`` which row is
    the lowest that forces reach.
    """

    F: Ordered
    g: Array
    starts: Array
    lowest: int


def sweep_down(
    packing: SolvedPacking,
    rows: tuple[Layer, ...],
    loads: Loads,
    *,
    linear: bool = False,
    stop_at_tension: bool = False,
    work: Work | None = None,
    above: Above | None = None,
) -> Forces:
    """Carry loads down from the highest of ``rows`` through the beads of ``rows``.

    Exactly; or, with ``linear``, to first order: then forces are sums down the diagonals, and there
    is nothing to invert (Eqs. 6–11, for a packing of ``first_order.displace``).

    ``rows[j]`` for j = 0 … top lie within the packing's region; ``loads`` belong to them. Beads
    above or beside the rows pass no force on to them. The caller activates the number system.
    ``stop_at_tension`` ends the sweep below the first layer with a tensile contact. ``above``: the
    forces of the highest row, where that is balanced already. Raises ``NotStandingError`` where two
    contacts are parallel within the arithmetic.
    """
    top = len(rows) - 1
    system, width = packing.system, packing.region.width
    stopped = None
    lost: tuple[Any, Any] = (0, 0)
    nothing = (zeros(system, 0), zeros(system, 0))
    ordered: list[tuple[Array, Array]] = [nothing] * (top + 1)
    change: list[tuple[Array, Array]] = [nothing] * (top + 1)
    if above is not None:
        ordered[top], change[top], lost = above
    for j in range(top if above is None else top - 1, 0, -1):
        layer = rows[j]
        if not layer.count:
            break

        def here(values: Array, of: Layer, layer: Layer = layer) -> Array:
            return pick(values, of, layer, width)

        plus = tuple(here(v, packing.region.rows[j]) for v in packing.dn.plus[j])
        minus = tuple(here(v, packing.region.rows[j]) for v in packing.dn.minus[j])
        Fp, Fm, gp, gm, turn_plus, turn_minus = _from_above(
            packing, rows, j, ordered=ordered, change=change, lost=lost, linear=linear
        )
        Lp, Lm = loads.plus[j], loads.minus[j]
        Fp = Fp if Lp is None else Fp + Lp
        Fm = Fm if Lm is None else Fm + Lm
        turn_plus = turn_plus - Fp * plus[0] - Fm * minus[0]
        turn_minus = turn_minus - Fp * plus[1] - Fm * minus[1]
        if not linear:
            # Cramer for h⁺(1 + a⁺, b⁺) + h⁻(a⁻, 1 + b⁻) = (s⁺, s⁻), written for h − s, which is
            # small of second order.
            minor = plus[0] * minus[1] - minus[0] * plus[1]
            det = 1 + (plus[0] + minus[1] + minor)
            check_standing(det, layer, system)
            sp, sm = gp + turn_plus, gm + turn_minus
            turn_plus = turn_plus - (sp * (plus[0] + minor) + sm * minus[0]) / det
            turn_minus = turn_minus - (sm * (minus[1] + minor) + sp * plus[1]) / det
        gp, lost_plus = added(gp, turn_plus, system)
        gm, lost_minus = added(gm, turn_minus, system)
        lost = (lost_plus, lost_minus)
        if work is not None:
            work.did("balanced", layer, gp.size // layer.count)
        ordered[j], change[j] = (Fp, Fm), (gp, gm)
        if stop_at_tension:
            stopped = first_tension(layer, (Fp + gp, gp), (Fm + gm, gm), system)
        if stopped is not None:
            break
    return Forces(
        system,
        rows,
        PerBranch(tuple(f[0] for f in ordered), tuple(f[1] for f in ordered)),
        PerBranch(tuple(g[0] for g in change), tuple(g[1] for g in change)),
        stopped,
        lost,
    )


def first_tension(
    layer: Layer, plus: tuple[Array, Array], minus: tuple[Array, Array], system: NumberSystem
) -> Contact | None:
    """Name the leftmost contact (i, j, branch) below ``layer`` that surely pulls, or None.

    ``plus`` and ``minus`` are pairs (force, change). Raises ``UndecidedError`` where balls leave a
    sign open; what floats leave open counts as holding, and what balls of the most bits do: a force
    that is exactly zero has no sign.
    """
    for (force, change), branch in ((plus, Branch.PLUS), (minus, Branch.MINUS)):
        pulls, undecided = pulling(force, change, system)
        if pulls.any():
            q = int(np.argwhere(pulls)[0][-1])
            return Contact(layer.first + 2 * q - branch.side, layer.j - 1, branch)
        if undecided.any() and isinstance(system, Balls) and system.bits < MOST_BITS:
            raise UndecidedError(f"layer {layer.j}: balls are too wide for the sign of a force")
    return None


def pulling(force: Array, change: Array, system: NumberSystem) -> tuple[Array, Array]:
    """Tell contacts that surely pull and those whose sign is open; two boolean arrays.

    Balls decide by their own radius. Hardware floats have none: there a force is taken as open
    within 2^-40 of its layer's largest change, far above their measured error below M*.
    """
    if system.dtype is object:
        pulls, holds = system.signs(-force)
        return pulls, ~(pulls | holds)
    room = 2.0**-40 * np.abs(change).max(initial=0)
    return force < -room, (np.abs(force) <= room) & (force != 0)


def _from_above(
    packing: SolvedPacking,
    rows: tuple[Layer, ...],
    j: int,
    *,
    ordered: list[tuple[Array, Array]],
    change: list[tuple[Array, Array]],
    lost: tuple[Any, Any],
    linear: bool,
) -> tuple[Array, Array, Array, Array, Array, Array]:
    """Collect F^±, g^± and the components of Σ (F + g) δn of the contacts above layer j.

    ``linear`` leaves g δn out, which is of second order. The last two hold what was ``lost``, too.
    """
    system, width, layer = packing.system, packing.region.width, rows[j]
    zero = zeros(system, 1)[0]
    if j == len(rows) - 1:
        nothing = zeros(system, layer.count)
        return (nothing,) * 6
    above = rows[j + 1]
    # The contact above and to the right of (i, j) has the upper bead (i + 1, j + 1).
    right = Layer(j + 1, layer.first + 1, layer.count)
    left = Layer(j + 1, layer.first - 1, layer.count)
    packed = packing.region.rows[j + 1]

    def get(values: Array, of: Layer, at: Layer) -> Array:
        return pick(values, of, at, width, zero)

    Fp, gp = get(ordered[j + 1][0], above, right), get(change[j + 1][0], above, right)
    Fm, gm = get(ordered[j + 1][1], above, left), get(change[j + 1][1], above, left)
    ap, bp = (get(v, packed, right) for v in packing.dn.plus[j + 1])
    am, bm = (get(v, packed, left) for v in packing.dn.minus[j + 1])
    fp, fm = (Fp, Fm) if linear else (Fp + gp, Fm + gm)
    turn_plus, turn_minus = fp * ap + fm * am, fp * bp + fm * bm
    if system.dtype is not object:
        turn_plus = turn_plus + get(lost[0], above, right)
        turn_minus = turn_minus + get(lost[1], above, left)
    return Fp, Fm, gp, gm, turn_plus, turn_minus


def added(force: Array, turn: Array, system: NumberSystem) -> tuple[Array, Any]:
    """Add, and give what the rounding lost (Knuth's two-sum), which the next layer takes along.

    One force passes straight down through every layer: without this its roundings pile up. Balls
    and series know their own errors, big floats have digits to spare.
    """
    total = force + turn
    if system.dtype is object:
        return total, None
    part = total - force
    return total, (force - (total - part)) + (turn - part)


def check_standing(det: Array, layer: Layer, system: NumberSystem) -> None:
    """Raise ``NotStandingError`` where two contacts are parallel; ``det`` is that of their N."""
    good, bad = system.signs(det * det)
    if not good.all():
        wrong = ~good if not bad.any() else bad
        raise NotStandingError((layer.first + 2 * int(np.argwhere(wrong)[0][-1]), layer.j))
