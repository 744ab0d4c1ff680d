"""The graph of the proofs as a drawing: every equation to the right of those that it rests on."""

from collections.abc import Mapping, Sequence

from markupsafe import Markup

from ...framework.catalogue import Number
from ...framework.record import Outcome

_COLUMN, _ROW, _RADIUS = 56, 64, 17


def depths(premises: Mapping[Number, Sequence[Number]]) -> dict[Number, int]:
    """Length of the longest chain of premises below each equation, given premises first.

    >>> depths({1: [], 2: [1], 3: [], 4: [2, 3]})
    {1: 0, 2: 1, 3: 0, 4: 2}
    """
    found: dict[Number, int] = {}
    for number, rests_on in premises.items():
        found[number] = 1 + max((found[one] for one in rests_on), default=-1)
    return found


def direct(premises: Mapping[Number, Sequence[Number]]) -> dict[Number, list[Number]]:
    """Leave premises out that others rest on, given premises first.

    >>> direct({1: [], 2: [1], 3: [1, 2]})
    {1: [], 2: [1], 3: [2]}
    """
    below: dict[Number, set[Number]] = {}
    for number, rests_on in premises.items():
        below[number] = set(rests_on).union(*(below[one] for one in rests_on))
    return {
        number: [one for one in rests_on if not any(one in below[other] for other in rests_on)]
        for number, rests_on in premises.items()
    }


def proof_graph(outcomes: Sequence[Outcome]) -> Markup:
    """The graph; each node is a link to its equation."""
    premises = {o.derivation.number: [p.number for p in o.derivation.premises] for o in outcomes}
    columns: dict[int, list[Number]] = {}
    for number, depth in depths(premises).items():
        columns.setdefault(depth, []).append(number)
    places = {
        number: (depth * _COLUMN, (row - (len(numbers) - 1) / 2) * _ROW)
        for depth, numbers in columns.items()
        for row, number in enumerate(numbers)
    }
    curves = [
        _curve(places[one], places[number], upwards=place % 2 == 1)
        for place, (number, rests_on) in enumerate(direct(premises).items())
        for one in rests_on
    ]
    nodes = []
    for outcome in outcomes:
        derivation = outcome.derivation
        x, y = places[derivation.number]
        nodes.append(
            Markup(
                '<a href="#eq-{0}" aria-label="Eq. {0}: {3}"><circle class="{4}" cx="{1:g}" '
                'cy="{2:g}" r="{5}"/><text x="{1:g}" y="{2:g}" dy="0.35em">{0}</text></a>'
            ).format(
                derivation.number, x, y, derivation.title, outcome.verdict.replace(",", ""), _RADIUS
            )
        )
    edges = [
        Markup('<path class="edge" d="M{:.1f} {:.1f}Q{:.1f} {:.1f} {:.1f} {:.1f}"/>').format(*curve)
        for curve in curves
    ]
    heights = [_turn(y0, y1, y2) for _, y0, _, y1, _, y2 in curves]
    heights += [y for _, y in places.values()]
    edge = _RADIUS + 5
    top, width = min(heights) - edge, (len(columns) - 1) * _COLUMN + 2 * edge
    height = max(heights) + edge - top
    return Markup(
        '<svg class="graph" viewBox="{x:g} {y:g} {w:g} {h:g}" width="{w:g}" height="{h:g}" '
        'role="group" aria-label="Which equation rests on which"><defs><marker id="arrow" '
        'viewBox="0 0 8 8" refX="7" refY="4" markerWidth="7" markerHeight="7" orient="auto">'
        '<path class="head" d="M0 1 7 4 0 7z"/></marker></defs>{edges}{nodes}</svg>'
    ).format(
        x=-edge, y=top, w=width, h=height, edges=Markup().join(edges), nodes=Markup().join(nodes)
    )


def _curve(
    start: tuple[float, float], end: tuple[float, float], *, upwards: bool
) -> tuple[float, ...]:
    """From circle to circle: straight to a neighbour, else an arc above or below what is between.

    The three points of a quadratic curve.
    """
    (x0, y0), (x1, y1) = start, end
    span = round((x1 - x0) / _COLUMN)
    side = -1 if y0 + y1 < 0 or (y0 + y1 == 0 and upwards) else 1
    bulge = side * 20.0 * span if span > 1 else 0.0
    x, y = (x0 + x1) / 2, (y0 + y1) / 2 + bulge
    first = _towards(x0, y0, x, y, _RADIUS + 1)
    last = _towards(x1, y1, x, y, _RADIUS + 3)
    return *first, x, y, *last


def _turn(y0: float, y1: float, y2: float) -> float:
    """Height at which a quadratic curve turns; where it does not, that of its start."""
    bend = y0 - 2 * y1 + y2
    share = (y0 - y1) / bend if bend else 0.0
    return y0 - (y0 - y1) * share if 0 < share < 1 else y0


def _towards(x: float, y: float, to_x: float, to_y: float, by: float) -> tuple[float, float]:
    distance = ((to_x - x) ** 2 + (to_y - y) ** 2) ** 0.5
    return x + by * (to_x - x) / distance, y + by * (to_y - y) / distance
