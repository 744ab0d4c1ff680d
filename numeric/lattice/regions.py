"""What a question depends on: the beads that must be visited, and how many they are.

The exact position of a bead depends on the whole triangle below it. A contact force depends on
every bead that stands above the contact's upper bead x (its upward cone, up to the highest load),
on their supports, and on the triangles below those. Its beads then number, layer by layer,
2M − j − m for a contact f^±_ij under a surface or bulk load, in all (M + 1)(3M − 2j)/2.

To first order a contact force depends only on line sums down three neighbouring diagonals and,
through δn of the contact itself, on two diagonals of the other orientation.
"""

from collections.abc import Iterable

from .layers import Layer, Region, hull, row, supports

Site = tuple[int, int]
Rows = tuple[Layer, ...]


def upper_bead(i: int, j: int, branch: str) -> Site:
    """Give the upper bead of the contact f^±_ij."""
    return (i + 1 if branch == "+" else i - 1, j + 1)


def triangle(i: int, j: int, width: int | None) -> Region:
    """Give the beads on which the exact position of (i, j) depends: the triangle below it."""
    return Region(width, tuple(row(m, i - (j - m), i + (j - m), width) for m in range(j + 1)))


def triangle_beads(j: int) -> int:
    """Count the beads of a triangle with its tip in layer j.

    >>> triangle_beads(3) == triangle(0, 3, None).beads == 10
    True
    """
    return (j + 1) * (j + 2) // 2


def downward_cone(loaded: Iterable[Site], width: int | None) -> Rows:
    """Give the beads that loads on ``loaded`` reach: rows of layers 0 … highest load.

    Loads far apart share a row that holds the beads between them too.
    """
    own: dict[int, Layer] = {}
    for i, j in loaded:
        bead = Layer(j, i, 1)
        own[j] = hull(own[j], bead, width) if j in own else bead
    if not own:
        return (Layer(0, 0, 0),)
    top = max(own)
    rows = [own[top]]
    for m in range(top - 1, -1, -1):
        below = supports(rows[-1], width)
        rows.append(hull(below, own[m], width) if m in own else below)
    return tuple(reversed(rows))


def upward_cone(x: Site, top: int, width: int | None) -> Rows:
    """Give the beads that stand on bead x, in rows 0 … top; rows below x are empty."""
    i, j = x
    return tuple(
        row(m, i - (m - j), i + (m - j), width) if m >= j else Layer(m, m % 2, 0)
        for m in range(top + 1)
    )


def meet(a: Layer, b: Layer, width: int | None) -> Layer:
    """Intersect two rows of one layer; where images would split the result, ``b`` is kept whole."""
    if not a.count or not b.count:
        return Layer(a.j, a.first, 0)
    if width is not None:
        if width in (a.count, b.count):
            return b if a.count == width else a
        period = 2 * width
        turn = round((a.first + a.last - b.first - b.last) / 2 / period) * period
        b = Layer(b.j, b.first + turn, b.count)
        if a.count + b.count > width:
            return b
    first, last = max(a.first, b.first), min(a.last, b.last)
    return Layer(a.j, first, max((last - first) // 2 + 1, 0))


def contact_rows(contact: tuple[int, int, str], reach: Rows, width: int | None) -> Rows:
    """Give the beads whose force balance decides one contact force.

    ``reach`` are the beads that the loads reach (all of the packing for surface and bulk loads).
    Every row is empty where no load reaches the contact: its force is then exactly zero.
    """
    x = upper_bead(*contact)
    top = len(reach) - 1
    if top < x[1]:
        return ()
    up = upward_cone(x, top, width)
    rows = tuple(meet(a, b, width) for a, b in zip(up, reach, strict=True))
    if not rows[x[1]].count:
        return ()
    while not rows[-1].count:
        rows = rows[:-1]
    return rows


def contact_beads(j: int, height: int) -> int:
    """Count the beads on which the exact f^±_ij depends (surface or bulk load, W ≥ 2M − j).

    The cone above the contact holds M − j beads of the surface; layer m lies M − m below it, and
    the triangles widen by one bead a layer: 2M − j − m beads, summed over m = 0 … M.

    >>> contact_beads(0, 1), contact_beads(0, 64)
    (3, 6240)
    """
    return (height + 1) * (3 * height - 2 * j) // 2
