"""The beads on which a question depends, and how many there are.

The exact position of a bead depends on the whole triangle below it. A contact force depends on
every bead that stands above the contact's upper bead x (its upward cone, up to the highest load),
on their supports, and on the triangles below those. Its beads then number, layer by layer,
2M − j − m for a contact f^±_ij under a surface or bulk load, in all (M + 1)(3M − 2j)/2.

To first order a contact force depends only on line sums down three neighbouring diagonals and,
through δn of the contact itself, on two diagonals of the other orientation.
"""

from collections.abc import Iterable

import numpy as np

from .branch import Contact, Site
from .layers import Layer, Region, Rows, closed_below, taken


def downward_cone(loaded: Iterable[Site], width: int | None) -> Rows:
    """Give the beads that loads on ``loaded`` reach: rows of layers 0 … highest load.

    Of one bead that is the triangle below it, on which its exact position depends.
    Loads far apart share a row that holds the beads between them too.
    """
    sites = np.array(list(loaded), np.int64).reshape(-1, 2)
    if not len(sites):
        return Rows([0], [0])
    i, j = sites.T
    layers = np.arange(j.max() + 1)
    first, last = np.full(len(layers), i.max() + 1), np.full(len(layers), i.min() - 1)
    np.minimum.at(first, j, i)
    np.maximum.at(last, j, i)
    return closed_below(layers, first, last, width)


def reached(loaded: Iterable[Site], rows: Rows, region: Region) -> list[Layer]:
    """Give the beads of ``rows`` that loads on ``loaded`` reach: of each layer, runs of neighbours.

    ``rows`` are those of ``downward_cone``, or whole layers.
    """
    on: dict[int, list[int]] = {}
    for i, j in loaded:
        on.setdefault(j, []).append(i)
    layers = list[Layer]()
    upper, above = Layer(0, 0, 0), np.zeros(0, bool)
    for row in reversed(rows):
        columns = (np.array(on.get(row.j, []), np.int64) - row.first) // 2
        here = np.zeros(row.count, bool)
        here[columns % (region.width or max(row.count, 1))] = True
        for axis in range(region.dimension if upper.count else 0):
            here |= taken(above, region.columns(upper, row, region.step(axis, 1)), False)
        ends = np.flatnonzero(np.diff(here, prepend=False, append=False)).reshape(-1, 2)
        layers += [Layer(row.j, row.first + 2 * a, b - a) for a, b in ends[::-1].tolist()]
        upper, above = row, here
    return layers[::-1]


def upward_cone(x: Site, top: int, width: int | None) -> Rows:
    """Give the beads that stand on bead x, in rows 0 … top; rows below x are empty."""
    i, j = x
    layers = np.arange(top + 1)
    above = layers - j
    below = above < 0
    return Rows.between(
        np.where(below, layers % 2, i - above), np.where(below, -2, i + above), width
    )


def meet(a: Rows, b: Rows, width: int | None) -> Rows:
    """Intersect rows of the same layers; where images would split one, ``b``'s is kept whole."""
    shift = np.zeros_like(b.firsts)
    if width is not None:
        period = 2 * width
        shift = np.rint((a.firsts + a.lasts - b.firsts - b.lasts) / 2 / period).astype(int) * period
    first, last = np.maximum(a.firsts, b.firsts + shift), np.minimum(a.lasts, b.lasts + shift)
    count = np.maximum((last - first) // 2 + 1, 0)
    if width is not None:
        split = a.counts + b.counts > width
        first, count = np.where(split, b.firsts + shift, first), np.where(split, b.counts, count)
        for full, other in ((b, a), (a, b)):
            first = np.where(full.counts == width, other.firsts, first)
            count = np.where(full.counts == width, other.counts, count)
    empty = (a.counts == 0) | (b.counts == 0)
    return Rows(np.where(empty, a.firsts, first), np.where(empty, 0, count), a.lowest)


def contact_rows(contact: Contact, reach: Rows, width: int | None) -> Rows:
    """Give the beads whose force balance decides one contact force.

    ``reach`` are the beads that the loads reach (all of the packing for surface and bulk loads).
    There is none where no load reaches the contact: its force is then exactly zero.
    """
    x = contact.upper
    top = len(reach) - 1
    if top < x[1]:
        return Rows()
    rows = meet(upward_cone(x, top, width), reach, width)
    if not rows[x[1]].count:
        return Rows()
    return rows[: int(np.flatnonzero(rows.counts)[-1]) + 1]
