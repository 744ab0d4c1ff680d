"""First-order weights of forces from contacts and balances alone, as fractions.

One radius is enlarged. Two line sums place each bead on its two supports; the balance of each bead,
along both reciprocal vectors, says what leaves it. Shares no code with the package.
"""

from fractions import Fraction
from functools import cache

Site = tuple[int, int]
Weights = dict[Site, Fraction]


@cache
def weights(height: int, phi: Fraction, load: str) -> dict[str, tuple[Weights, ...]]:
    """Weights for r = 1 of f⁺/⟨f⟩ ("+"), f⁻/⟨f⟩ ("-") and p/⟨p⟩ ("p"), one mapping a layer j < M.

    Keys are (i' − i, j') of the radius. p is the vertical force on bead (i, j) from both upper
    contacts. ``load`` is "surface" or "bulk". The packing is so wide that nothing sees an image.
    """
    found: dict[str, tuple[Weights, ...]] = {
        kind: tuple({} for _ in range(height)) for kind in "+-p"
    }
    for source in range(height + 1):
        changes, tilts = _enlarged(height, phi, load, source)
        for layer in range(height):
            carried = _carried(height, layer, load)
            for across in _columns(height, layer):
                plus, minus = (change[across, layer] / carried for change in changes)
                turned = sum(tilt[across, layer] for tilt in tilts) / (1 + phi)
                key = (_offset(height, source % 2 - across), source)
                for kind, weight in (("+", plus), ("-", minus), ("p", (plus + minus + turned) / 2)):
                    if weight:
                        found[kind][layer][key] = weight
    return found


def covariance(first: Weights, second: Weights, across: int) -> Fraction:
    """Covariance of two of them, the second so many columns to the right, for r = σ = 1."""
    products = (w * second.get((offset - across, at), 0) for (offset, at), w in first.items())
    return sum(products, Fraction(0))


def mean_variance(single: Weights, count: int) -> Fraction:
    """Variance of the mean over ``count`` neighbours of one layer, for r = σ = 1."""
    apart = [covariance(single, single, 2 * place) for place in range(count)]
    pairs = sum(((count - place) * value for place, value in enumerate(apart)), Fraction(0))
    return (2 * pairs - count * apart[0]) / count**2


def _around(height: int) -> int:
    return 4 * height + 8


def _columns(height: int, layer: int) -> range:
    return range(layer % 2, _around(height), 2)


def _offset(height: int, across: int) -> int:
    half = _around(height) // 2
    return (across + half) % (2 * half) - half


def _carried(height: int, layer: int, load: str) -> int:
    """Ordered force of a contact that starts in this layer."""
    return (height - layer if load == "bulk" else 1) if layer < height else 0


def _enlarged(
    height: int, phi: Fraction, load: str, source: int
) -> tuple[tuple[Weights, Weights], tuple[Weights, Weights]]:
    """Changes of f⁺ and f⁻, and n^∓·δn^±, of all contacts by lower bead; one radius is 1 + ε."""
    around, none = _around(height), Fraction(0)
    sides = (1, -1)

    def radius(across: int, layer: int) -> int:
        return int((across, layer) == (source % 2, source))

    def upper(across: int, layer: int, side: int) -> Site:
        return (across + side) % around, layer + 1

    def lower(across: int, layer: int, side: int) -> Site:
        return (across - side) % around, layer - 1

    # n^±·δx: what the contact with the support straight down n^± fixes
    sums: tuple[Weights, Weights] = ({}, {})
    for layer in range(height + 1):
        for bead in ((across, layer) for across in _columns(height, layer)):
            for one, side in zip(sums, sides, strict=True):
                support = lower(*bead, side)
                one[bead] = one[support] + radius(*bead) + radius(*support) if layer else none

    tilts: tuple[Weights, Weights] = ({}, {})
    for layer in range(height):
        for bead in ((across, layer) for across in _columns(height, layer)):
            for tilt, side, other in zip(tilts, sides, sums[::-1], strict=True):
                above = upper(*bead, side)
                reach = radius(*bead) + radius(*above)
                tilt[bead] = (other[above] - other[bead] - phi * reach) / 2

    # b⁺·b⁺ = 1/(1 − φ²), b⁺·b⁻ = −φ/(1 − φ²), δn⁺ = (n⁻·δn⁺) b⁻
    changes: tuple[Weights, Weights] = ({}, {})
    for layer in range(height, 0, -1):
        over, under = (_carried(height, at, load) for at in (layer, layer - 1))
        for bead in ((across, layer) for across in _columns(height, layer)):
            supports = [lower(*bead, side) for side in sides]
            lost = [
                over * tilt.get(bead, none) - under * tilt[support]
                for tilt, support in zip(tilts, supports, strict=True)
            ]
            for a, support in enumerate(supports):
                gained = (lost[1 - a] - phi * lost[a]) / (1 - phi**2)
                changes[a][support] = changes[a].get(bead, none) + gained
    return changes, tilts
