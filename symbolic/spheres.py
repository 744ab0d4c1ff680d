"""Contact forces to first order in d = 2 or 3 dimensions, as weights on sites.

Every bead rests on d others, along base vectors n^a of equal mutual dot product φ, and the base is
flat. A bead is named by its steps along the base vectors; their sum is its layer. Contacts fix
n^a·δx as a line sum,

    L_a(x) = Σ [δr(y) + δr(y − e_a)],  over the beads y from x down along n^a to layer 1,

and so a contact from x along n^c turns by

    2r n^a·δn^c = L_a(x + e_c) − L_a(x) − φ(δr_x + δr_(x+e_c))

for a ≠ c, while n^c·δn^c = 0. With the reciprocal vectors b^a the balance of bead x along b^a says
that the contact below along n^a carries what comes in from above along n^a, and

    b^a·Σ_c [F_c δn^c(x) − F_c δn^c(x − e_c)],

F_c being the ordered forces. Summed along the contact's line up to the load this is its force.
"""

from collections.abc import Callable, Mapping, Sequence
from functools import cache, lru_cache, partial

import sympy

from . import sets
from .algebra.exact import FIELD, SITE, SOURCE, RationalFunction
from .forms import NUMBER, RADII, Form, Known
from .symbols import ForceAlong, M, VerticalAlong, l, n, phi, r, t_2, t_3
from .weights import Weights

_UPWARDS = sets.where(n >= 1)
_HALF = FIELD.from_sympy(1 / (2 * r))


def reciprocal(dimension: int) -> tuple[RationalFunction, ...]:
    """b^a·b^a and b^a·b^c, times a divisor; and this."""
    divisor = (1 - phi) * (1 + (dimension - 1) * phi)
    return tuple(map(FIELD.from_sympy, (1 + (dimension - 2) * phi, -phi, divisor)))


@lru_cache(maxsize=8)
def turns(dimension: int) -> tuple[tuple[Weights, ...], ...]:
    """2r n^a·δn^c of the contact from bead ``SOURCE`` along n^c, by a and c."""
    beads, sites = SOURCE[:dimension], SITE[:dimension]
    cosine = FIELD.generator(phi)

    def radius(axis: int | None = None) -> Weights:
        place = (bead + int(number == axis) for number, bead in enumerate(beads))
        return Weights.of(*map(_is, sites, place))

    def line_sum(axis: int) -> Weights:
        down = dict(zip(sites, beads, strict=True)) | {sites[axis]: beads[axis] - n}
        run = [_is(site, place) for site, place in down.items()]
        layer = sympy.Add(*sites)
        both = Weights.of(*run, n >= 0, layer >= 1) + Weights.of(*run, n >= 1, layer >= 0)
        return both.summed(n)

    def turn(a: int, c: int) -> Weights:
        if a == c:
            return Weights()
        line = line_sum(a)
        rest = (radius() + radius(c)).scaled(cosine)
        return (line.at({beads[c]: beads[c] + 1}) - line - rest).merged()

    axes = range(dimension)
    return tuple(tuple(turn(a, c) for c in axes) for a in axes)


def force(ordered: Sequence[Weights], axis: int) -> Known:
    """The force of the contact from a bead along n^axis; ``ordered`` gives F_c by the bead."""
    dimension = len(ordered)
    own, cross, divisor = reciprocal(dimension)
    beads = SOURCE[:dimension]
    gained = Weights()
    for c, carried in enumerate(ordered):
        turned = Weights()
        for a in range(dimension):
            turn = turns(dimension)[a][c].scaled(own if a == axis else cross)
            turned = turned + turn.times(carried)
        gained = gained + turned - turned.at({beads[c]: beads[c] - 1})
    upwards = gained.merged().at({beads[axis]: beads[axis] + n}).on(_UPWARDS)
    weights = upwards.summed(n).merged().scaled(_HALF / divisor)  # polynomials up to here
    return Known(sets.EVERYTHING, (Form({NUMBER: ordered[axis], RADII: weights}),))


def vertical(force: Known, dimension: int, axis: int) -> Known:
    """The vertical component of the same over n_z: 1 + Σ_a n^a·δn^axis/[1 + (d − 1)φ] of it."""
    tilted = Weights()
    for a in range(dimension):
        tilted = tilted + turns(dimension)[a][axis]
    scale = _HALF / FIELD.from_sympy(1 + (dimension - 1) * phi)
    unit = Form.number(FIELD.one) + Form({RADII: tilted.scaled(scale)})
    (value,) = force.value
    return Known(force.points, (unit.times(value).merged(),))


# loads in three dimensions

_LAYER = sympy.Add(*SOURCE)
_RATIOS = (sympy.S.One, t_2, t_3)


def _layered(factor: sympy.Expr, ratios: Sequence[sympy.Expr]) -> tuple[Weights, ...]:
    within = (_LAYER >= 0, sympy.Le(_LAYER, M - 1, evaluate=False))
    values = (FIELD.from_sympy(factor * ratio) for ratio in ratios)
    return tuple(Weights.of(*within, value=value) for value in values)


def _legs() -> tuple[Weights, ...]:
    """One on each leg below bead (0, 0, l), along which the load comes down."""

    def leg(axis: int) -> Weights:
        place = [0, 0, l]
        place[axis] = place[axis] - n
        steps = sum((SOURCE[2] - l, *SOURCE[:2]))
        run = (_is(bead, at) for bead, at in zip(SOURCE, place, strict=True))
        return Weights.of(*run, n >= 1, _LAYER >= 0, _is(steps, -n)).without(n)

    return tuple(map(leg, range(3)))


ORDERED: Mapping[str, Callable[[], tuple[Weights, ...]]] = {
    "surface": lambda: _layered(sympy.S.One, (sympy.S.One,) * 3),
    "bulk": lambda: _layered(M - _LAYER, (sympy.S.One,) * 3),
    "surface leaning": lambda: _layered(sympy.S.One, _RATIOS),
    "bulk leaning": lambda: _layered(M - _LAYER, _RATIOS),
    "point": _legs,
}
"""F_c by the bead, in units of what the load gives contacts along n¹ for each layer of it."""


@cache
def _force(load: str, axis: int) -> Known:
    return force(ORDERED[load](), axis)


@cache
def _vertical(load: str, axis: int) -> Known:
    return vertical(_force(load, axis), 3, axis)


def forces_in_radii(load: str) -> Mapping[type, Callable[[int], Known]]:
    """The forces of all contacts of a packing of spheres, as functions of the axis."""
    return {ForceAlong: partial(_force, load), VerticalAlong: partial(_vertical, load)}


def _is(symbol: sympy.Symbol, value: sympy.Expr) -> sympy.Basic:
    return sympy.Eq(symbol, value, evaluate=False)
