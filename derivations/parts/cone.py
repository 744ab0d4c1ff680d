"""The forces below a point load: inside of its cone, on it and beside it."""

import sympy
from force_diffusion.symbolic.kernel import rules
from force_diffusion.symbolic.kernel.rules import Rule
from force_diffusion.symbolic.kernel.theorem import Theorem
from force_diffusion.symbolic.kernel.where import POINT
from force_diffusion.symbolic.mechanics.paths import IN_CONE
from force_diffusion.symbolic.symbols import (
    DeltaNMinus,
    DeltaNPlus,
    Dot,
    ForcePlus,
    VerticalMinus,
    VerticalPlus,
    e_y,
    f_load,
    i,
    j,
    k,
    l,
    n,
    n_minus,
    n_plus,
    n_y,
    p,
    q,
)
from sympy import Eq, Rational

from .. import eq07_load_split as eq07
from .. import eq09_straight_path as eq09
from .. import eq10_branched_path as eq10
from ..framework.grounds import Beside
from ..framework.vocabulary import (
    Where,
    axioms,
    equation,
    minus,
    terms,
    times,
)

ORDERED = f_load / (2 * n_y)
"""Force of the contacts of the ordered packing: those on the legs of the cone."""

CONE = Where.of(p >= 1, q >= 1, *(Eq(symbol, at) for symbol, at in IN_CONE.items()), loading=POINT)
INSIDE = CONE.also(j >= 0)
"""Beads (i, j) inside of the cone below bead (k, l)."""

ON_LEFT_LEG = {symbol: value.xreplace({q: sympy.Integer(0)}) for symbol, value in IN_CONE.items()}
LEFT_LEG = Where.of(
    p >= 1, *(Eq(symbol, at) for symbol, at in ON_LEFT_LEG.items()), j >= 0, loading=POINT
)

UPPER_RIGHT = eq10.branched_plus(i, j, p)
UPPER_LEFT = eq10.PRINTED.rhs.xreplace({n: q})
"""The forces f⁺_ij and f⁻_ij on a bead inside of the cone, over f_load/2n_y, to first order.

Each has one path with one branch from the loaded bead: q steps along n⁻ and p along n⁺, or the
other way round. The branch is of first order; what enters it counts at order 0, f_load/2n_y.
"""

PRESSED = VerticalPlus(i, j) + VerticalMinus(i, j)
"""p: the vertical force that a bead gets from both upper contacts."""

LEG_CONTACT = eq09.first_order_product(eq07.split_plus(k, l), eq09.PRINTED.rhs)
"""f⁺_ij over f_load/2n_y on the left leg: the split of the load, carried down a straight path."""

LEG_RESPONSE = (LEG_CONTACT + Dot(e_y, DeltaNPlus(i, j)) / n_y) / 2
"""Its vertical component over f_load, the contact's own direction being tilted."""

LEG_TILTS = terms(Dot(n_minus, DeltaNPlus(i, j)), minus(Dot(n_plus, DeltaNMinus(k + 1, l - 1))))

# The forces, proved from layer to layer down. In layer l − n the cone holds the contacts f⁺ with
# q = 0 (on its left leg) and q = 1, …, n − 1 steps along n⁻ above them; the others are zero.

BELOW = (k - n + 2 * q, l - n)
"""Lower bead of a contact f⁺ in layer l − n."""

LAYERS = Where.of(n >= 1, n <= l, loading=POINT)

_INWARDS = {i: BELOW[0], j: BELOW[1], p: n - q}
_STRAIGHT = {i: k - n, j: l - n}
_LEG_BELOW, _BRANCHED = LEG_CONTACT.xreplace(_STRAIGHT), UPPER_RIGHT.xreplace(_INWARDS)

RIGHT_OF_ALL = (equation(ForcePlus(*BELOW), 0), LAYERS.also(q >= n, indices=(q,)))
LEFT_OF_ALL = (equation(ForcePlus(*BELOW), 0), LAYERS.also(q <= -1, indices=(q,)))

FAMILY = (
    (equation(ForcePlus(k - n, l - n), times(ORDERED, _LEG_BELOW)), LAYERS),
    (
        equation(ForcePlus(*BELOW), times(ORDERED, _BRANCHED)),
        LAYERS.also(q >= 1, q <= n - 1, indices=(q,)),
    ),
    LEFT_OF_ALL,
    RIGHT_OF_ALL,
)

_PLACES = ((q <= -1,), (q >= 1, q <= n - 2), (q >= 1, Eq(q, n - 1)), (q >= n,))


def _forces() -> tuple[Theorem, ...]:
    loads = axioms.loads(POINT)

    def step(supposed: tuple[Theorem, ...]) -> Rule:
        balanced = rules.below(axioms.balance(), (*supposed, *loads))
        split = rules.cases(balanced, *_PLACES)
        return lambda formula, where: (split if q in where.indices else balanced)(formula, where)

    top = rules.below(axioms.balance(), loads)
    plus = rules.inducted(n, Rational(1), top, step, FAMILY, mirrored=True)
    return (*plus, *map(rules.mirror, plus))


FORCES = Beside(_forces)
"""The force of every contact below the load."""
