"""The deposited packing, before any contact opens: where beads start, or rest if none pulls."""

from dataclasses import replace

import numpy as np

from ..arithmetic.errors import UndecidedError
from ..arithmetic.systems import FLOAT64, Array, Balls, NumberSystem, as_floats
from ..lattice.layers import Region, contacts_of
from ..mechanics.engine import solve
from ..mechanics.physicality import pulling
from ..mechanics.problem import Problem, Route, axes, cartesian, ordered_places
from ..mechanics.sweep import Solved, UnbuildableError
from ..mechanics.work import Work
from .certificate import smallest_gap
from .grains import Grains, Pairs
from .network import Frame, ImpossibleError, Network, UnfinishedError


def start(problem: Problem, realisation: int) -> tuple[Grains, Pairs | None]:
    """Deposit the beads, in float64, and give them with the contacts of the lattice.

    Where some bead can't be deposited, or overlaps another one: a stretched lattice, and None.
    Raises ``UnbuildableError`` for a radius that is not positive, and ``UnfinishedError`` for one
    that is too large.
    """
    rows, width = problem.region.rows, problem.region.widest
    (rho,) = problem.radii.of(rows, [realisation], FLOAT64)
    radii, (i, j) = 1 + rho, rows.sites
    if radii.min() <= 0:
        first = int(np.argmax(radii <= 0))
        why = "its radius is not a positive number"
        raise UnbuildableError((int(i[first]), int(j[first])), why)
    nx, ny = (float(n) for n in axes(problem.n_x, FLOAT64))
    load = as_floats(loads(problem, FLOAT64))
    grains = Grains(np.zeros((len(radii), 2)), radii, 4 * nx * width, load, width)
    supports = lattice_contacts(problem.region)
    try:
        deposited = replace(problem, route=Route.EXACT, needs_forces=False)
        with np.errstate(all="ignore"):
            packing = solve(deposited, [realisation], FLOAT64, Work())
        grains.x = _centres(problem, packing, FLOAT64)
        near = grains.near(0.1)
        others = near[~np.isin(grains.named(near), grains.named(supports))]
        if (grains.gaps(others) > 1e-9).all():
            return grains, supports
    except UnbuildableError:
        pass
    apart = 2 * float(radii.max()) * (1 + 1e-9)
    if apart >= 8 * nx:
        raise UnfinishedError("can't start without overlaps: some radius is at least the spacing")
    rise, turn = np.sqrt(max(apart**2 - (2 * nx) ** 2, (2 * ny) ** 2)), np.zeros(width)
    if apart >= 4 * nx:  # neighbours in a layer would overlap: every second one is a step higher
        turn[1::2] = 1
        turn[-1] += width % 2 * 2  # the first follows the last
        rise = apart * (1 + turn.max())
    lift = np.where(j > 0, apart * np.tile(turn, len(rows)), 0)
    grains.x = np.stack([2 * nx * i, rise * j + lift], axis=1)
    return grains, None


def must_hold(grains: Grains) -> None:
    """Raise ``ImpossibleError`` where beads of the base overlap, or can't push sideways enough.

    A bead that touches a bead of the base is at its side the further the smaller it is, until it
    touches the next one too; between those two none can fall through.
    """
    base, s = grains.radii[: grains.fixed], grains.period / grains.fixed
    wide = base + np.roll(base, -1) >= s
    if wide.any():
        q = int(np.argmax(wide))
        raise ImpossibleError(
            f"no packing can stand: beads {q} and {(q + 1) % grains.fixed} of the base overlap"
        )
    smallest = grains.radii[grains.fixed :].min()
    reach = base + smallest
    sines = []
    for other in (np.roll(reach, 1), np.roll(reach, -1)):
        if (reach + other <= s).any():
            return
        sines.append((s**2 + reach**2 - other**2) / (2 * s * reach))
    side, up = grains.load[grains.fixed :].sum(axis=0)
    lean, most = np.arctan2(abs(side), -up), np.arcsin(np.max(sines))
    if lean > most + 1e-9:
        raise ImpossibleError(
            f"no packing can stand: the load leans by {np.degrees(lean):.4g}° from the vertical, "
            f"and the beads of the base can hold {np.degrees(most):.4g}° at most"
        )


def as_deposited(problem: Problem, realisation: int, known: Frame, system: Balls) -> Network:
    """Enclose the packing as without the effect: no contact pulls, and nothing moves.

    The caller activates ``system``. Raises ``UndecidedError`` where more bits may tell signs, and
    ``UnfinishedError`` where a contact pulls, or others than those of the lattice are closed.
    """
    deposited = replace(problem, route=Route.EXACT, needs_forces=True)
    solved = solve(deposited, [realisation], system, Work())
    pulls, undecided = pulling(solved)
    if np.any(pulls):
        raise UnfinishedError("a contact pulls by less than float64 can resolve")
    if np.any(undecided):
        raise UndecidedError("the enclosures are too wide to tell whether a contact pulls")
    pairs, values = lattice_contacts(problem.region), (solved.F + solved.g[0]).T.ravel()
    bearing = np.array([not (f.rad() == 0 and f == 0) for f in values], dtype=bool)
    x = _centres(problem, solved, system)
    rattlers = np.setdiff1d(np.arange(len(known.base), len(x)), pairs[bearing])
    smallest = smallest_gap(x, known, pairs)
    return Network(x, pairs[bearing], values[bearing], rattlers, smallest, known)


def frame(problem: Problem, realisation: int, system: NumberSystem) -> Frame:
    """Give what is exactly known of a packing."""
    (rho,) = problem.radii.of(problem.region.rows, [realisation], system)
    base, spacing = system.zeros(problem.region.widest, 2), 4 * problem.n_x
    base[:, 0] = [system.number(spacing * q) for q in range(len(base))]
    return Frame(1 + rho, base, system.number(spacing * len(base)), loads(problem, system))


def lattice_contacts(region: Region) -> Pairs:
    """List the contacts of the lattice: each bead above the base with its two supports."""
    pairs, number, _ = contacts_of(region)
    return pairs[np.lexsort((number, pairs[:, 1]))][:, ::-1]


def loads(problem: Problem, system: NumberSystem) -> Array:
    """Give the Cartesian loads of all beads, (N, 2)."""
    strength = problem.load.strength(problem.n_x, system)
    components = system.zeros(2, problem.region.beads)
    if problem.load.loaded is None:
        first = 0 if problem.load.kind == "bulk" else -problem.region.widest
        for own, share in zip(components, strength.unit, strict=True):
            own[first:] = share
    for site, load in strength.single.items():
        (bead,) = problem.region.numbers(np.array(site)[:, None])
        components[:, bead] += load
    return np.stack(cartesian(-components, problem, system, raised=True), axis=1)


def _centres(problem: Problem, packing: Solved, system: NumberSystem) -> Array:
    """Give the centres of deposited beads, (N, 2)."""
    home = ordered_places(packing.region.rows.sites, problem, system)
    moved = cartesian(packing.block[0, :2], problem, system, raised=False)
    return np.stack([*map(np.add, home, moved)], axis=1)
