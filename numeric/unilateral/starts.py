"""Where beads are before any contact opens: as deposited, dropped one by one, or in pockets."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
from scipy.optimize import linear_sum_assignment

from ..arithmetic.systems import FLOAT64, Array, NumberSystem, as_floats
from ..disorder.radii import rows_of
from ..lattice.branch import Branch
from ..lattice.layers import Region, column, whole
from ..mechanics.engine import solve
from ..mechanics.problem import Problem, Route, axes
from ..mechanics.sweep import UnbuildableError
from ..mechanics.work import Work
from .grains import Grains, Pairs
from .network import UnfinishedError

# Rows of earlier beads, and how far to the side, in radii of the largest, on which a bead may rest.
ROWS, ASIDE = 4, 6
# Places that overlap by less than this, in units of r, only touch: what float64 leaves.
TOUCHING = 1e-10


def start(problem: Problem, realisation: int) -> tuple[Grains, Pairs | None, int]:
    """Deposit the beads; a stretched lattice, and no supports, where some can't be deposited."""
    width, height = problem.width, problem.height
    assert width is not None
    region = whole(width, height)
    rho = rows_of(problem.radii, region.rows, [realisation], FLOAT64)
    radii = np.concatenate([1 + row for row in rho])
    nx, ny = (float(n) for n in axes(problem.n_x, FLOAT64))
    load = as_floats(loads_of(problem, region, FLOAT64))
    home, j = sites(problem), np.repeat(np.arange(height + 1), width)
    grains = Grains(np.zeros((len(radii), 2)), radii, 4 * nx * width, load, width)
    supports = lattice_contacts(width, height)
    try:
        deposited = replace(problem, route=Route.EXACT, needs_forces=False, region=region)
        with np.errstate(all="ignore"):
            packing = solve(deposited, [realisation], FLOAT64, Work()).packing
        assert packing is not None
        plus, minus = (np.concatenate(list(c)) for c in (packing.c.plus, packing.c.minus))
        grains.x = np.stack(
            [home[:, 0] + (plus - minus) / (2 * nx), home[:, 1] + (plus + minus) / (2 * ny)], axis=1
        )
        near = grains.near(0.1)
        others = near[~np.isin(grains.named(near), grains.named(supports))]
        overlaps = int(np.count_nonzero(grains.gaps(others) < 1e-9))
        if not overlaps or problem.protocol == "event-driven":
            return grains, supports, overlaps
    except UnbuildableError:
        pass
    if radii.min() <= 0:
        raise UnbuildableError((0, 0), "a radius is not positive")
    apart = 2 * float(radii.max()) * (1 + 1e-9)
    if apart >= 8 * nx:
        raise UnfinishedError(
            "no start without overlaps is known: some radius is the spacing or more"
        )
    rise, turn = np.sqrt(max(apart**2 - (2 * nx) ** 2, (2 * ny) ** 2)), np.zeros(width)
    if apart >= 4 * nx:  # neighbours in a layer would overlap: every second one is a step higher
        turn[1::2] = 1
        turn[-1] += width % 2 * 2  # the first follows the last
        rise = apart * (1 + turn.max())
    lift = np.where(j > 0, apart * np.tile(turn, height + 1), 0)
    grains.x = np.stack([home[:, 0], rise * j + lift], axis=1)
    return grains, None, 0


def sites(problem: Problem) -> Array:
    """Give the sites of the ordered lattice, (N, 2)."""
    assert problem.width is not None
    rows = whole(problem.width, problem.height).rows
    nx, ny = (float(n) for n in axes(problem.n_x, FLOAT64))
    i = np.concatenate([row.first + 2 * np.arange(row.count) for row in rows])
    return np.stack([2 * nx * i, 2 * ny * np.repeat(np.arange(len(rows)), problem.width)], axis=1)


def dropped(grains: Grains, home: Array) -> Pairs:
    """Let one bead after the other come to touch two earlier ones, and overlap none.

    ``home``: the sites of the ordered lattice, (N, 2). Of all such places where its two contacts
    would hold the bead under a load like the whole one, each takes that next to its home. Moves
    ``grains``, and gives these contacts: as many as there are coordinates.
    """
    fixed, radii = grains.fixed, grains.radii
    load = grains.load[fixed:].sum(axis=0)
    x, pairs = np.concatenate([home[:fixed], np.zeros_like(home[fixed:])]), []
    for bead in range(fixed, len(radii)):
        near = np.arange(max(bead - ROWS * fixed, 0), bead)
        aside = np.abs(_turned(x[near] - home[bead], grains.period)[:, 0])
        near = near[aside < ASIDE * radii.max()]
        for place, pair in _places(x, radii, grains.period, near, bead, load, home[bead]):
            apart = _turned(x[:bead] - place, grains.period)
            if (np.hypot(*apart.T) > radii[:bead] + radii[bead] - TOUCHING).all():
                x[bead] = place
                pairs += [(bead, support) for support in pair]
                break
        else:
            raise UnfinishedError(f"no two beads before it would hold bead {bead}")
    grains.x = x
    return np.array(pairs)


def _places(
    x: Array, radii: Array, period: float, near: Array, bead: int, load: Array, home: Array
) -> Iterator[tuple[Array, Array]]:
    """Give places where a bead touches two of ``near``, which hold it: the next to home first."""
    pairs = near[np.stack(np.triu_indices(len(near), 1), axis=1)]
    one, other = (radii[pairs] + radii[bead]).T
    across = _turned(x[pairs[:, 1]] - x[pairs[:, 0]], period)
    apart = np.hypot(*across.T)
    along = (apart**2 + one**2 - other**2) / (2 * apart)
    met = along**2 < one**2
    pairs, across, along = pairs[met], across[met] / apart[met, None], along[met]
    up = np.sqrt(one[met] ** 2 - along**2)[:, None] * across[:, ::-1] * [-1, 1]
    found = [x[pairs[:, 0]] + along[:, None] * across + side * up for side in (1, -1)]
    places, pairs = np.concatenate(found), np.concatenate([pairs, pairs])
    first, second = (_turned(places - x[pairs[:, k]], period) for k in (0, 1))
    turn = first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0]
    held = ((load[1] * second[:, 0] - load[0] * second[:, 1]) * turn > 0) & (
        (load[0] * first[:, 1] - load[1] * first[:, 0]) * turn > 0
    )
    off = np.hypot(*_turned(places - home, period).T)
    for k in np.argsort(off, kind="stable"):
        if held[k] and places[k, 1] > 0:
            yield places[k], pairs[k]


def _turned(differences: Array, period: float) -> Array:
    """Give differences of positions to the nearest images."""
    around = np.round(differences[..., :1] / period)
    return np.asarray(differences - around * [period, 0])


def in_pockets(grains: Grains) -> Pairs:
    """Put each bead that bears a load between two beads of the base, and all others high above.

    Which bead goes where: so that the sum of the smaller ones of all beads' two forces is largest.
    Moves ``grains``, and gives these contacts. Raises ``UnfinishedError`` where some would not be
    held.
    """
    fixed, radii = grains.fixed, grains.radii
    spacing = grains.period / fixed
    loaded = fixed + np.flatnonzero(grains.load[fixed:].any(axis=1))
    if len(loaded) > fixed:
        raise UnfinishedError(f"{len(loaded)} beads bear loads, and the base has {fixed} pockets")
    pocket = np.arange(fixed)
    left = radii[pocket] + radii[loaded, None]
    right = radii[(pocket + 1) % fixed] + radii[loaded, None]
    along = (spacing**2 + left**2 - right**2) / (2 * spacing)
    with np.errstate(invalid="ignore"):  # what falls through has no height
        up = np.sqrt(left**2 - along**2)
        side, down = grains.load[loaded, 0, None], -grains.load[loaded, 1, None]
        pushes = [(down * (spacing - along) - side * up) * left, (down * along + side * up) * right]
        least = np.minimum(*pushes) / (spacing * up * np.hypot(side, down))
    fits = least > 0
    bead, chosen = linear_sum_assignment(np.where(fits, -least, 1e6))
    if not fits[bead, chosen].all():
        few = int(np.count_nonzero(~fits[bead, chosen]))
        raise UnfinishedError(
            f"not one loaded bead in each pocket of the base: {few} of {len(loaded)} would roll out"
        )
    wide = 2 * float(radii.max()) * (1 + 1e-9)
    free = np.setdiff1d(np.arange(fixed, len(radii)), loaded)
    row, at = np.divmod(np.arange(len(free)), int(grains.period / wide))
    x = np.zeros_like(grains.x)
    x[:fixed, 0] = spacing * pocket
    x[free] = np.stack([wide * at, wide * (3 + row)], axis=1)
    x[loaded] = np.stack([spacing * chosen + along[bead, chosen], up[bead, chosen]], axis=1)
    x[:, 0] += grains.period * np.round((grains.x[:, 0] - x[:, 0]) / grains.period)
    grains.x = x
    return np.stack([np.repeat(loaded, 2), np.stack([chosen, (chosen + 1) % fixed], 1).ravel()], 1)


def must_hold(grains: Grains) -> None:
    """Raise where beads of the base overlap, or can't push sideways as much as the load does.

    A bead that touches a bead of the base is at its side the further the smaller it is, until it
    touches the next one too; between those two none can fall through.
    """
    base, s = grains.radii[: grains.fixed], grains.period / grains.fixed
    wide = base + np.roll(base, -1) >= s
    if wide.any():
        q = int(np.argmax(wide))
        raise UnfinishedError(
            f"no packing can stand: beads {q} and {(q + 1) % grains.fixed} of the base overlap"
        )
    smallest = grains.radii[grains.fixed :].min()
    one = base + smallest
    sines = []
    for other in (np.roll(one, 1), np.roll(one, -1)):
        if (one + other <= s).any():
            return
        sines.append((s**2 + one**2 - other**2) / (2 * s * one))
    side, up = grains.load[grains.fixed :].sum(axis=0)
    lean, most = np.arctan2(abs(side), -up), np.arcsin(np.max(sines))
    if lean > most + 1e-9:
        raise UnfinishedError(
            f"no packing can stand: the load leans by {np.degrees(lean):.4g}° to the vertical, and "
            f"beads of the base hold others against {np.degrees(most):.4g}° at most"
        )


def lattice_contacts(width: int, height: int) -> Pairs:
    """List the contacts of the lattice: each bead above the base with its two supports."""
    pairs = [
        (j * width + q, (j - 1) * width + column(2 * q + j % 2 - branch.side, j - 1, width))
        for j in range(1, height + 1)
        for q in range(width)
        for branch in Branch
    ]
    return np.array(pairs)


def loads_of(problem: Problem, region: Region, system: NumberSystem) -> Array:
    """Give the Cartesian loads of all beads, (N, 2)."""
    nx, ny = axes(problem.n_x, system)
    rows = region.rows
    loads = problem.load.on(rows, problem.load.strength(problem.n_x, system), system)
    zero = system.number(problem.n_x * 0)
    out = np.full((len(rows) * rows[0].count, 2), zero, dtype=system.dtype)
    for j, (plus, minus) in enumerate(zip(loads.plus, loads.minus, strict=True)):
        if plus is not None:
            own = slice(j * rows[0].count, (j + 1) * rows[0].count)
            out[own, 0], out[own, 1] = (minus - plus) * nx, -(plus + minus) * ny
    return out
