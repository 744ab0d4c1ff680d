"""First-order weights of forces below one loaded bead, on the lattice of any dimension."""

from collections import defaultdict
from collections.abc import Mapping
from fractions import Fraction

Bead = tuple[int, ...]


def stepped(bead: Bead, axis: int, count: int) -> Bead:
    """The bead so many steps on along a base vector."""
    return (*bead[:axis], bead[axis] + count, *bead[axis + 1 :])


def reciprocal(dimension: int, phi: Fraction) -> tuple[Fraction, Fraction]:
    """b^a·b^a and b^a·b^c of the reciprocal vectors."""
    below = (1 - phi) * (1 + (dimension - 1) * phi)
    return (1 + (dimension - 2) * phi) / below, -phi / below


def response_weights(
    dimension: int, level: int, phi: Fraction, steps: Bead, axis: int, *, vertical: bool = False
) -> dict[Bead, Fraction]:
    """Weights in δr of one contact's force below a point load, r = 1, over the ordered legs' force.

    Beads are named by their steps down from the loaded one, in layer ``level``. The contact leads
    up along ``axis`` from the bead ``steps``. To first order what enters a bead leaves it along the
    same vector, but where the ordered force of a leg turns with its contacts. ``vertical``: the
    vertical component, over that of the ordered legs.
    """
    own, cross = reciprocal(dimension, phi)
    total: dict[Bead, Fraction] = defaultdict(Fraction)

    def carries(bead: Bead, along: int) -> bool:
        return 0 < sum(bead) == bead[along]

    def line_sum(bead: Bead, along: int, factor: Fraction) -> None:
        layer = level - sum(bead)
        for below in range(layer + 1 if layer else 0):
            total[stepped(bead, along, below)] += factor * (1 if below in (0, layer) else 2)

    def turn(bead: Bead, up: int, shares: Mapping[int, Fraction]) -> None:
        upper = stepped(bead, up, -1)
        for along in set(range(dimension)) - {up}:
            line_sum(upper, along, shares[along] / 2)
            line_sum(bead, along, -shares[along] / 2)
            for end in (bead, upper):
                total[end] -= phi * shares[along] / 2

    def products(sign: int) -> dict[int, Fraction]:
        return {along: sign * (own if along == axis else cross) for along in range(dimension)}

    bead = stepped(steps, axis, -1)
    while min(bead) >= 0:
        for c in range(dimension):
            for contact, sign in ((bead, 1), (stepped(bead, c, 1), -1)):
                if carries(contact, c):
                    turn(contact, c, products(sign))
        bead = stepped(bead, axis, -1)
    if vertical and carries(steps, axis):
        turn(steps, axis, dict.fromkeys(range(dimension), 1 / (1 + (dimension - 1) * phi)))
    return dict(total)
