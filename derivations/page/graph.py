"""The graph of the proofs as a drawing: every equation to the right of those that it rests on."""

from collections.abc import Sequence

from markupsafe import Markup

from derivations.record import Outcome

_COLUMN, _ROW, _RADIUS = 56, 64, 17


def depths(premises: dict[int, Sequence[int]]) -> dict[int, int]:
    """Length of the longest chain of premises below each equation, given premises first.

    >>> depths({1: [], 2: [1], 3: [], 4: [2, 3]})
    {1: 0, 2: 1, 3: 0, 4: 2}
    """
    found: dict[int, int] = {}
    for number, rests_on in premises.items():
        found[number] = 1 + max((found[one] for one in rests_on), default=-1)
    return found


def proof_graph(outcomes: Sequence[Outcome]) -> Markup:
    """The graph; each node is a link to its equation."""
    premises = {o.derivation.number: [p.number for p in o.derivation.premises] for o in outcomes}
    columns: dict[int, list[int]] = {}
    for number, depth in depths(premises).items():
        columns.setdefault(depth, []).append(number)
    tallest = max(map(len, columns.values()))
    longest = max(
        (depth - _depth_of(columns, one) for depth, numbers in columns.items()
         for number in numbers for one in premises[number]),
        default=1,
    )  # fmt: skip
    margin = 16 + 11 * longest  # room for the arcs
    middle = margin + (tallest - 1) * _ROW / 2 + _RADIUS
    places = {
        number: (
            _RADIUS + 6 + depth * _COLUMN,
            middle + (row - (len(numbers) - 1) / 2) * _ROW,
        )
        for depth, numbers in columns.items()
        for row, number in enumerate(numbers)
    }
    edges, nodes = [], []
    for number, rests_on in premises.items():
        edges += [_edge(places[one], places[number], middle) for one in rests_on]
    for outcome in outcomes:
        derivation = outcome.derivation
        x, y = places[derivation.number]
        nodes.append(
            Markup(
                '<a href="#eq-{0}" aria-label="Eq. {0}: {3}"><circle class="{4}" cx="{1:g}" '
                'cy="{2:g}" r="{5}"/><text x="{1:g}" y="{2:g}" dy="0.35em">{0}</text></a>'
            ).format(derivation.number, x, y, derivation.title, outcome.verdict, _RADIUS)
        )
    width = 2 * (_RADIUS + 6) + (len(columns) - 1) * _COLUMN
    return Markup(
        '<svg class="graph" viewBox="0 0 {w:g} {h:g}" width="{w:g}" height="{h:g}" role="group" '
        'aria-label="Which equation rests on which"><defs><marker id="arrow" viewBox="0 0 8 8" '
        'refX="7" refY="4" markerWidth="7" markerHeight="7" orient="auto-start-reverse">'
        '<path class="head" d="M0 1 7 4 0 7z"/></marker></defs>{edges}{nodes}</svg>'
    ).format(w=width, h=2 * middle, edges=Markup("").join(edges), nodes=Markup("").join(nodes))


def _depth_of(columns: dict[int, list[int]], number: int) -> int:
    return next(depth for depth, numbers in columns.items() if number in numbers)


def _edge(start: tuple[float, float], end: tuple[float, float], middle: float) -> Markup:
    """An arrow between two circles: straight to a neighbour, else an arc above or below all."""
    (x0, y0), (x1, y1) = start, end
    span = round((x1 - x0) / _COLUMN)
    bulge = 0.0 if span <= 1 else 22.0 * span * (1 if (y0 + y1) / 2 > middle else -1)
    if span > 1 and y0 == y1 == middle and round(x1 / _COLUMN) % 2:
        bulge = -bulge
    cx, cy = (x0 + x1) / 2, (y0 + y1) / 2 + bulge
    ax, ay = _towards(x0, y0, cx, cy, _RADIUS + 1)
    bx, by = _towards(x1, y1, cx, cy, _RADIUS + 3)
    return Markup('<path class="edge" d="M{:.1f} {:.1f}Q{:.1f} {:.1f} {:.1f} {:.1f}"/>').format(
        ax, ay, cx, cy, bx, by
    )


def _towards(x: float, y: float, to_x: float, to_y: float, by: float) -> tuple[float, float]:
    distance = ((to_x - x) ** 2 + (to_y - y) ** 2) ** 0.5
    return x + by * (to_x - x) / distance, y + by * (to_y - y) / distance
