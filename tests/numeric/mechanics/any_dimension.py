"""First-order weights of a contact force on the lattice of any dimension, as fractions.

Every bead rests on d others, along d base vectors of equal mutual dot product φ; a bead is named by
d whole numbers, whose sum is its layer. A load −Σ_a L^a n^a, L^1 = 1, r = 1.
"""

from collections import defaultdict
from collections.abc import Mapping
from fractions import Fraction
from functools import cache
from itertools import product

Bead = tuple[int, ...]
Weights = dict[Bead, Fraction]


def stepped(bead: Bead, axis: int, count: int = 1) -> Bead:
    """The bead so many steps up along a base vector."""
    return (*bead[:axis], bead[axis] + count, *bead[axis + 1 :])


def reciprocal(dimension: int, phi: Fraction) -> tuple[Fraction, Fraction]:
    """b^a·b^a and b^a·b^c of the reciprocal vectors."""
    below = (1 - phi) * (1 + (dimension - 1) * phi)
    return (1 + (dimension - 2) * phi) / below, -phi / below


def force_weights(
    dimension: int,
    height: int,
    layer: int,
    phi: Fraction,
    *,
    bulk: bool = False,
    ratios: tuple[Fraction, ...] | None = None,
) -> tuple[Weights, Weights]:
    """Weights in δr of f/⟨f⟩ above bead (layer, 0, …) along the first vector, r = 1.

    Two parts that add up: the line sums along the contact's own vector, and all others. To first
    order f of a bead's lower contact is what enters it and b^a·Σ_c(δn^c − δn^c below), each times
    what its contacts carry: 1, or under a ``bulk`` load the beads straight above, times L^c, the
    ``ratios`` of L^2 and so on to L^1, which are 1 if none are given.
    """
    # A weight is its part's factor times n − φ m, with numbers n and m, which are counted.
    Counts = dict[Bead, list[int | Fraction]]
    parts: tuple[Counts, Counts] = defaultdict(lambda: [0, 0]), defaultdict(lambda: [0, 0])
    carried = (1, *(ratios or (1,) * (dimension - 1)))

    def line_sum(to: Counts, bead: Bead, along: int, sign: int | Fraction) -> None:
        top = sum(bead)
        for below in range(top + 1 if top else 0):
            share = sign if below in (0, top) else 2 * sign
            to[stepped(bead, along, -below)][0] += share

    def tilt(to: Counts, bead: Bead, up: int, along: int, sign: int | Fraction) -> None:
        upper = stepped(bead, up)
        line_sum(to, upper, along, sign)
        line_sum(to, bead, along, -sign)
        for end in (bead, upper):
            to[end][1] += sign

    start = (layer, *(0 for _ in range(dimension - 1)))
    for count in range(1, height - layer + 1):
        bead = stepped(start, 0, count)
        for up, along in product(range(dimension), repeat=2):
            if up == along:
                continue
            to = parts[along != 0]
            above = height - sum(bead)
            if above:
                tilt(to, bead, up, along, carried[up] * (above if bulk else 1))
            below = carried[up] * (above + 1 if bulk else 1)
            tilt(to, stepped(bead, up, -1), up, along, -below)

    def weights(counts: Counts, factor: Fraction) -> Weights:
        weight = cache(lambda n, m: factor * (n - phi * m))
        return {bead: weight(*count) for bead, count in counts.items()}

    twice = 2 * (height - layer if bulk else 1)
    own, other = (one / twice for one in reciprocal(dimension, phi))
    return weights(parts[0], own), weights(parts[1], other)


def squared(weights: Mapping[Bead, Fraction]) -> Fraction:
    """Sum of squares."""
    return sum((w**2 for w in weights.values()), Fraction(0))


def together(parts: tuple[Weights, Weights]) -> Weights:
    """Both parts added."""
    total: Weights = defaultdict(Fraction)
    for part in parts:
        for bead, weight in part.items():
            total[bead] += weight
    return total
