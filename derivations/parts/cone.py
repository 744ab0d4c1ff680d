"""Forces below a point load, and closed forms of their variances: inside of its cone and on it."""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from fractions import Fraction

import sympy
from force_diffusion.symbolic.algebra import explicit
from force_diffusion.symbolic.kernel import rules
from force_diffusion.symbolic.kernel.rules import Rule
from force_diffusion.symbolic.kernel.theorem import Theorem
from force_diffusion.symbolic.kernel.where import POINT
from force_diffusion.symbolic.mechanics.paths import IN_CONE
from force_diffusion.symbolic.symbols import (
    DeltaNMinus,
    DeltaNPlus,
    Dot,
    ForceMinus,
    ForcePlus,
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
    phi,
    q,
)
from sympy import Eq, Rational

from .. import eq07_load_split as eq07
from .. import eq09_straight_path as eq09
from .. import eq10_branched_path as eq10
from ..framework.grounds import Beside
from ..framework.record import ExactCase, Missed, Piece
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

# The closed forms, all proved in Eq. 16. The bead (i, j) lies p steps along n⁺ and q steps along n⁻
# below the loaded bead (k, l): inside of the cone for p, q ≥ 1, on its left leg for q = 0. They are
# written for the left half where that matters; the right half is its mirror image. Variances over
# f_load² are in units of UNIT/4, those over a mean force squared in units of UNIT.
_HALF = Rational(1, 2)
_INSIDE = 6 * l + 6 * j - 6 + phi**2
_BELOW_LOAD = _HALF * (1 + phi) ** 2
_TOP = _HALF * (1 - phi) ** 2

BEAD = (
    Piece(
        "j = 0, l = 2",
        {j: 0, p: 1, q: 1},
        Rational(11, 2) - phi + Rational(3, 2) * phi**2,
    ),
    Piece("j = 0, beside the left leg", {j: 0, q: 1}, 6 * l - 8 - phi + phi**2, (p >= 2,)),
    Piece("j = 0, beside the right leg", {j: 0, p: 1}, 6 * l - 8 - phi + phi**2, (q >= 2,)),
    Piece("j = 0, further inside", {j: 0}, 6 * l - 9 + phi**2, (p >= 2, q >= 2)),
    Piece("j = 1, l = 3", {j: 1, p: 1, q: 1}, 6 * l + 4 + phi**2 + _BELOW_LOAD),
    Piece("j = 1, l > 3", {j: 1}, 6 * l + 4 + phi**2, (p + q >= 3,)),
    Piece("j = 2, l = 4", {j: 2, p: 1, q: 1}, 6 * l + Rational(9, 2) + phi**2 + _BELOW_LOAD),
    Piece("j = 2, l > 4", {j: 2}, 6 * l + Rational(9, 2) + phi**2, (p + q >= 3,)),
    Piece("i = k, j = l − 2 ≥ 3", {p: 1, q: 1}, _INSIDE + _BELOW_LOAD, (j >= 3,)),
    Piece("j ≥ 3, every other bead inside of the cone", {}, _INSIDE, (j >= 3, p + q >= 3)),
)
"""Variance of the vertical force that a bead gets from both upper contacts, over f_load²."""

CONTACT = (
    Piece("j = 0, k − i = 2 − l", {j: 0, p: 1}, Rational(7, 2) - _HALF * phi + _HALF * phi**2),
    Piece("inside of the cone", {}, 3 * (l + j + k - i) - 3 + _HALF * phi**2, (j + p >= 2,)),
)
"""Variance of the vertical component of f⁺_ij inside of the cone, over f_load²."""

_LEG = 2 * l + 2 * j - 2 + 2 * phi + phi**2

LEG = (
    Piece("j = 0, l = 1", {j: 0, p: 1}, _HALF * (1 + phi) ** 2),
    Piece("j = 0, l > 1", {j: 0}, _LEG - phi, (p >= 2,)),
    Piece("j = 1, l = 2", {j: 1, p: 1}, _LEG + Rational(3, 2) - _TOP),
    Piece("j = 1, l > 2", {j: 1}, _LEG + Rational(3, 2), (p >= 2,)),
    Piece("j = l − 1 ≥ 2", {p: 1}, _LEG - _TOP, (j >= 2,)),
    Piece("2 ≤ j ≤ l − 2, on a leg", {}, _LEG, (j >= 2, p >= 2)),
)
"""Variance of the vertical component of the contact force on a leg of the cone, over f_load²."""

_LEG_FORCE = 2 * (l - 1) + 2 * phi**2 * j + Rational(5, 2) * phi**2 + _HALF * phi**4

LEG_FORCE = (
    Piece("j = 0, l = 1", {j: 0, p: 1}, _HALF * (1 - 2 * phi + 6 * phi**2 - 2 * phi**3 + phi**4)),
    Piece("j = 0, l > 1", {j: 0}, _LEG_FORCE - _HALF * phi * (1 + phi**2), (p >= 2,)),
    Piece("j = 1, l = 2", {j: 1, p: 1}, _LEG_FORCE + Rational(3, 2) * phi - phi * _TOP),
    Piece("j = 1, l > 2", {j: 1}, _LEG_FORCE + Rational(3, 2) * phi, (p >= 2,)),
    Piece("j = l − 1 ≥ 2", {p: 1}, _LEG_FORCE - phi * _TOP, (j >= 2,)),
    Piece("2 ≤ j ≤ l − 2, on a leg", {}, _LEG_FORCE, (j >= 2, p >= 2)),
)
"""Variance of the magnitude of the contact force on a leg, over its mean squared."""

UPPER_RIGHT = eq10.branched_plus(i, j, p)
UPPER_LEFT = eq10.PRINTED.rhs.xreplace({n: q})
"""The forces f⁺_ij and f⁻_ij on a bead inside of the cone, over f_load/2n_y, to first order.

Each has one path with one branch from the loaded bead: q steps along n⁻ and p along n⁺, or the
other way round. The branch is of first order; what enters it counts at order 0, f_load/2n_y.
"""

VERTICAL_PLUS = times(terms(n_y, Dot(e_y, DeltaNPlus(i, j))), ForcePlus(i, j), 1 / f_load)
VERTICAL_MINUS = times(terms(n_y, Dot(e_y, DeltaNMinus(i, j))), ForceMinus(i, j), 1 / f_load)
PRESSED = VERTICAL_PLUS + VERTICAL_MINUS
"""p/f_load: the vertical force that a bead gets from both upper contacts."""

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


def closed_forms(quantity: sympy.Expr, pieces: Iterable[Piece], unit: sympy.Expr) -> sympy.Tuple:
    """What a quantity is for each piece."""
    return sympy.Tuple(*(equation(quantity, piece.expression * unit) for piece in pieces))


def domains(whole: Where, pieces: Iterable[Piece]) -> tuple[Where, ...]:
    """The domain of each piece."""
    return tuple(
        whole.also(*(Eq(symbol, at) for symbol, at in piece.at.items()), *piece.further)
        for piece in pieces
    )


STEPS_DOWN_LEG = {p: l - j}
"""Steps from the loaded bead down a leg."""


def exact_case(
    quantity: sympy.Expr,
    pieces: Iterable[Piece],
    unit: sympy.Expr,
    steps_below: Mapping[sympy.Symbol, sympy.Expr],
    to_order: str = "first order",
) -> ExactCase:
    """Closed forms as users get them; ``steps_below`` are those from the loaded bead."""

    def put_in(piece: Piece) -> sympy.Expr:
        at = {symbol: sympy.Integer(value) for symbol, value in piece.at.items()}
        return sympy.together(piece.expression.xreplace(at).doit()) * unit  # one fraction

    *edges, main = (
        Missed(
            piece.where,
            tuple(Eq(s.xreplace(dict(steps_below)), value) for s, value in piece.at.items()),
            put_in(piece),
        )
        for piece in pieces
    )
    inside = tuple(sympy.Ge(steps, 1) for steps in steps_below.values())
    return ExactCase(quantity, main.where, main.expression, inside, tuple(edges), to_order)


@dataclass(frozen=True)
class Below:
    """A statistic below a point load that has a closed form at every site.

    Attributes:
        printed: what stands on the left of its closed forms, a symbol but for a constant.
        of: what that is.
        where: all sites.
        pieces: its closed forms, the first that fits, in ``unit``.
        steps: p, and q where there is one, in other indices.
        to_order: to which it is exact.
    """

    printed: sympy.Expr
    of: sympy.Expr
    where: Where
    pieces: tuple[Piece, ...]
    unit: sympy.Expr
    steps: Mapping[sympy.Symbol, sympy.Expr]
    to_order: str = "first order"

    @property
    def symbol(self) -> sympy.Symbol:
        """That on the left."""
        (symbol,) = self.printed.free_symbols
        return symbol

    @property
    def meaning(self) -> dict[sympy.Symbol, sympy.Expr]:
        """What the symbol on the left stands for."""
        return {self.symbol: self.of + self.symbol - self.printed}

    @property
    def domains(self) -> tuple[Where, ...]:
        """Those of its closed forms, in the indices of ``where``."""
        steps = {s: one for s, one in self.steps.items() if s not in self.where.indices}
        found = []
        for piece in self.pieces:
            relations = (*(Eq(symbol, at) for symbol, at in piece.at.items()), *piece.further)
            found.append(self.where.also(*(one.xreplace(steps) for one in relations)))
        return tuple(found)

    def forms(self) -> Iterator[tuple[sympy.Expr, sympy.Expr, Where]]:
        """Both sides of each closed form, and its domain."""
        for piece, where in zip(self.pieces, self.domains, strict=True):
            yield self.printed, piece.expression * self.unit, where

    def exact(self) -> ExactCase:
        """Its closed forms as users get them."""
        return exact_case(self.printed, self.pieces, self.unit, self.steps, self.to_order)

    def value(self, at: explicit.Values) -> Fraction:
        """By the first closed form that fits."""
        return explicit.number(fitting(self.pieces, at) * self.unit, at)


def fitting(pieces: Iterable[Piece], at: explicit.Values) -> sympy.Expr:
    """The first closed form that fits."""
    return next(one.expression for one in pieces if one.at.items() <= at.items())
