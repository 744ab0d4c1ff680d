"""A proof that a packing is an equilibrium, with none of the code that finds or certifies one.

Krawczyk's operator with a dense inverse of floats: an exact packing touches at these contacts
within ρ of the centres; over that box its forces are enclosed, and shown to be positive, all other
gaps as well. No other bead bears a load, radii are positive, and none of the beads lies below the
base. All pairs are looked at one by one; with a period above four radii one image is enough.
"""

from typing import Any

import flint
import numpy as np

from tests.numeric.unilateral.packings import BITS, Packing

UNIT = 2.0**-53
OPEN = 1e-5  # of gaps of contacts
APART = "(of beads that touch without force nothing can be proved)"


def why_not(packing: Packing) -> str:
    """Say why a packing is not proved to be a strict local minimum; nothing where it is."""
    with flint.ctx.workprec(BITS):
        return _why_not(packing)


def _why_not(packing: Packing) -> str:
    fixed, period = packing.fixed, flint.arb(packing.period)
    radii = [flint.arb(r) for r in packing.radii]
    x = [[flint.arb(v) for v in centre] for centre in packing.centres]
    loads = [[flint.arb(v) for v in load] for load in packing.loads]
    contacts = packing.contacts
    free = sorted({bead for pair in contacts for bead in pair if bead >= fixed})
    if why := _impossible(packing, radii, loads, free, period):
        return why

    def difference(a: int, b: int, off: Any) -> list[Any]:
        """Give x_a − x_b of nearest images, each coordinate of a held bead being off by so much."""
        d = [p - q for p, q in zip(x[a], x[b], strict=True)]
        d[0] -= round(float(d[0]) / float(period)) * period
        return [v + off * ((a in free) + (b in free)) for v in d]

    def length(d: list[Any]) -> Any:
        return (d[0] * d[0] + d[1] * d[1]).sqrt()

    gaps = [length(difference(a, b, flint.arb(0))) - radii[a] - radii[b] for a, b in contacts]
    worst = _upper(gaps)
    if not worst < OPEN:
        return f"the contacts are open or overlap by up to {worst:.2g}"
    rho = flint.arb(0, 20 * len(contacts) * worst + 1e-60)

    def jacobian(off: Any) -> list[list[Any]]:
        """Give the derivatives of the gaps, which are those of directions."""
        rows = [[flint.arb(0)] * len(gaps) for _ in gaps]
        for row, (a, b) in zip(rows, contacts, strict=True):
            d = difference(a, b, off)
            for bead, sign in ((a, 1), (b, -1)):
                if bead in free:
                    at = 2 * free.index(bead)
                    row[at : at + 2] = [sign * v / length(d) for v in d]
        return rows

    over = np.array(jacobian(rho), dtype=object)
    A = np.array([[float(v.mid()) for v in row] for row in over])
    there = np.array([[v.mid() != 0 or v.rad() != 0 for v in row] for row in over])
    wide = np.array([[_upper([v - m]) for v, m in zip(*rows, strict=True)]
                     for rows in zip(over, A, strict=True)])  # fmt: skip
    try:
        C = np.linalg.inv(A)
    except np.linalg.LinAlgError:
        return "the Jacobian of the gaps is singular: the packing is not rigid"
    n = len(A)
    E = abs(np.eye(n) - C @ A) + (n + 3) * UNIT * (abs(C) @ abs(A) + 1) + abs(C) @ wide * 1.001
    step = (abs(C) @ np.array([_upper([gap]) for gap in gaps])).max() * 1.001
    shrinks, transposed = E.sum(axis=1).max() * 1.001, E.sum(axis=0).max() * 1.001
    box = _upper([rho])
    if not (step + shrinks * box < box and transposed < 1):
        return f"Krawczyk's operator does not map the box into itself: {shrinks:.2g}"

    f, load = [flint.arb(0)] * n, [v for bead in free for v in loads[bead]]
    for _ in range(8):
        rest = [v + sum((over[k, c] * f[k] for k in np.flatnonzero(there[:, c])), flint.arb(0))
                for c, v in enumerate(load)]  # fmt: skip
        before, off = f, abs(C.T) @ np.full(n, _upper(rest) / (1 - transposed)) * 1.001
        f = [(v - float(s)).mid() for v, s in
             zip(f, C.T @ np.array([float(v.mid()) for v in rest]), strict=True)]  # fmt: skip
    for (a, b), force, error in zip(contacts, before, off, strict=True):
        if not force > float(error):
            return f"the force between beads {a} and {b} may not be positive {APART}"

    floor = min(float(x[bead][1]) for bead in range(fixed))
    if any(not x[bead][1] + rho > floor for bead in range(fixed, len(x))):
        return "a bead lies below the base, or is not shown to lie above it"
    at, r = np.array([[float(v) for v in centre] for centre in x]), np.array(radii, dtype=float)
    touching = {frozenset(pair) for pair in contacts}
    room = 1e-13 * (1 + abs(at).max() + float(period)) + 3 * box
    for a in range(len(x)):
        for b in range(a):
            d = at[a] - at[b]
            d[0] -= float(period) * round(d[0] / float(period))
            if frozenset((a, b)) not in touching and not np.hypot(*d) - r[a] - r[b] > room:
                return f"beads {b} and {a} overlap, or are not shown to be apart {APART}"
    return ""


def _impossible(
    packing: Packing, radii: list[Any], loads: list[list[Any]], free: list[int], period: Any
) -> str:
    """Say why these contacts can't hold an equilibrium, whatever the centres are."""
    fixed, contacts = packing.fixed, packing.contacts
    for bead, radius in enumerate(radii):
        if not radius > 0:
            return f"the radius of bead {bead} is not positive"
        if not period > 4 * radius:
            return f"the period is not above 4 radii of bead {bead}: images may meet"
    if not free or len(contacts) != 2 * len(free):
        return f"{len(contacts)} contacts hold {len(free)} beads: twice as many are needed"
    if any(a == b or max(a, b) < fixed for a, b in contacts):
        return "a contact joins a bead to itself, or two beads of the base"
    for bead in range(fixed, len(radii)):
        if bead not in free and not all(load == 0 for load in loads[bead]):
            return f"bead {bead} bears a load, and no contact holds it"
    return ""


def _upper(balls: list[Any]) -> float:
    """Round the largest size up."""
    return max(float(abs(ball).upper()) for ball in balls) * (1 + 1e-12) + 1e-300
