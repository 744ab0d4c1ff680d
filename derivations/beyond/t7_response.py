"""T7: the mean response to a point load at second order in the radii, Eq. B9.

Of one contact: a plateau inside of the cone, and what its legs carry. Of the vertical force p on a
bead, the paper's Green's function: the same plateau down to the base, which the legs pay for.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cache

import sympy
from force_diffusion.derivations import eq11_total_force as eq11
from force_diffusion.derivations import eq16_response as eq16
from force_diffusion.derivations.beyond import t4_second_order as t4
from force_diffusion.derivations.framework.proving import facts_of
from force_diffusion.derivations.framework.record import ExactCase, Piece, usual
from force_diffusion.derivations.framework.vocabulary import (
    UNIT,
    Beside,
    Chain,
    Derivation,
    Lines,
    Where,
    Witness,
    equation,
    exhausting,
    minus,
    moment,
    power,
    rewrite,
    terms,
    times,
)
from force_diffusion.derivations.parts import cone
from force_diffusion.derivations.witnesses import second_order as witnesses
from force_diffusion.derivations.witnesses.draws import SmallPacking
from force_diffusion.derivations.witnesses.squared_weights import compare
from force_diffusion.symbolic.algebra import explicit
from force_diffusion.symbolic.kernel import rules
from force_diffusion.symbolic.kernel.decisions import Ruling
from force_diffusion.symbolic.kernel.mean_balance import mean_below
from force_diffusion.symbolic.kernel.rules import Rule
from force_diffusion.symbolic.kernel.theorem import Theorem
from force_diffusion.symbolic.mechanics.paths import STEPS_BELOW
from force_diffusion.symbolic.mechanics.second_order import with_force
from force_diffusion.symbolic.notation import Symbol
from force_diffusion.symbolic.symbols import (
    Covariance,
    Dot,
    ForcePlus,
    Shift,
    b_minus,
    b_plus,
    f_load,
    i,
    j,
    k,
    l,
    n,
    p,
    phi,
    q,
    r,
    sigma,
)
from sympy import Eq, Integer, Rational

INSIDE = Symbol(
    "mean_inside",
    r"\frac{\langle f^{\pm}_{ij}\rangle_{\mathrm{inside}}}{f^{\mathrm{load}}/2 n_{y}}",
    "⟨f^±_ij inside⟩/(f_load/2n_y)",
)
ON_LEG = Symbol(
    "mean_on_leg",
    r"\frac{\langle f_{ij}\rangle_{\mathrm{leg}}}{f^{\mathrm{load}}/2 n_{y}}",
    "⟨f_ij on a leg⟩/(f_load/2n_y)",
)
BEAD = Symbol(
    "mean_push",
    r"\frac{\langle p\rangle_{\mathrm{inside}}}{f^{\mathrm{load}}}",
    "⟨p inside⟩/f_load",
)
PUSH_ON_LEG = Symbol(
    "mean_push_on_leg",
    r"\frac{\langle p\rangle_{\mathrm{leg}}}{f^{\mathrm{load}}}",
    "⟨p on a leg⟩/f_load",
)
LOSS = Symbol("leg_loss", r"\Delta_{\mathrm{leg}}", "loss of a leg per layer")

_VARIANCE = power(times(sigma, 1 / r), 2)
PRINTED = (
    equation(
        INSIDE,
        times(1 / (1 - phi**2) ** 2, terms(times(2, phi**2), times(3, phi), -1), _VARIANCE),
    ),
    equation(
        terms(ON_LEG, -1),
        times(
            1 / (1 - phi**2) ** 2,
            terms(
                times(2, l, terms(1, -phi) ** 2),
                minus(times(terms(times(2, phi**2), phi, 1), terms(l, -j))),
                minus(times(Rational(1, 2), phi**3)),
                times(Rational(9, 4), phi**2),
                times(3, phi),
                minus(Rational(3, 4)),
            ),
            _VARIANCE,
        ),
    ),
)

# Closed forms at every site, in units of (σ/r)²/(1−φ²)², the first that fits: the contact f⁺_ij, or
# the bead (i, j), lies p steps along n⁺ and q along n⁻ below the loaded bead, on a leg for q = 0.

_PLATEAU = 2 * phi**2 + 3 * phi - 1
_LEG = (
    2 * l * (1 - phi) ** 2
    - (2 * phi**2 + phi + 1) * (l - j)
    - phi**3 / 2 + 9 * phi**2 / 4 + 3 * phi - Rational(3, 4)
)  # fmt: skip
LEG_LOSS = 2 * phi**2 + phi + 1
_BESIDE_ALL, _STRAIGHT_BELOW = (p >= 2, q >= 2), {p: 1, q: 1}

CONTACT = (
    Piece("j = 0, straight below the load", {j: 0, **_STRAIGHT_BELOW},
          (1 + 9 * phi + 6 * phi**2) / 4),
    Piece("j = 0, q = 1", {j: 0, q: 1}, (5 * phi**2 + 13 * phi - 2) / 4, (p >= 2,)),
    Piece("j = 0, p = 1", {j: 0, p: 1}, (7 * phi**2 + 7 * phi + 2) / 4, (q >= 2,)),
    Piece("j = 0, further inside", {j: 0}, (6 * phi**2 + 11 * phi - 1) / 4, _BESIDE_ALL),
    Piece("j = 1, q = 1", {j: 1, q: 1}, (7 * phi**2 + 17 * phi - 8) / 4),
    Piece("j = 1, q > 1", {j: 1}, (8 * phi**2 + 15 * phi - 7) / 4, (q >= 2,)),
    Piece("j ≥ 2, q = 1", {q: 1}, (7 * phi**2 + 14 * phi - 5) / 4, (j >= 2,)),
    Piece("j ≥ 2, every other contact inside of the cone", {}, _PLATEAU, (j >= 2, q >= 2)),
)  # fmt: skip
"""⟨f⁺_ij⟩ over f_load/2n_y, inside."""

LEG = (
    Piece("j = 0, l = 1", {j: 0, p: 1}, (1 - phi) * (2 - phi) * (1 - 2 * phi) / 2),
    Piece("j = 0, l > 1", {j: 0},
          l * (1 - 5 * phi) - (3 * phi**3 - 11 * phi**2 - 11 * phi + 3) / 4, (p >= 2,)),
    Piece("j = 1, l = 2", {j: 1, p: 1}, (1 - phi) * (3 * phi**2 - 16 * phi + 6) / 4),
    Piece("j = 1, l > 2", {j: 1},
          l * (1 - 5 * phi) - (2 * phi**3 - 17 * phi**2 - 19 * phi + 2) / 4, (p >= 2,)),
    Piece("j = l − 1 ≥ 2", {p: 1}, (1 - phi) * (8 * l * (1 - phi) + 3 * phi**2 - 7) / 4, (j >= 2,)),
    Piece("2 ≤ j ≤ l − 2, on a leg", {}, _LEG, (j >= 2, p >= 2)),
)  # fmt: skip
"""⟨f⟩ on a leg over f_load/2n_y, less 1."""

PUSH = (
    Piece("j = 0, straight below the load", {j: 0, **_STRAIGHT_BELOW},
          (phi**2 + 16 * phi - 1) / 4),
    Piece("j = 0, beside the left leg", {j: 0, q: 1}, (phi**2 + 36 * phi - 5) / 8, (p >= 2,)),
    Piece("j = 0, beside the right leg", {j: 0, p: 1}, (phi**2 + 36 * phi - 5) / 8, (q >= 2,)),
    Piece("i = k, j = l − 2 ≥ 1", _STRAIGHT_BELOW, (22 * phi - 5 - phi**2) / 4, (j >= 1,)),
    Piece("j ≥ 1, beside the left leg", {q: 1}, (42 * phi - 9 - phi**2) / 8, (j >= 1, p >= 2)),
    Piece("j ≥ 1, beside the right leg", {p: 1}, (42 * phi - 9 - phi**2) / 8, (j >= 1, q >= 2)),
    Piece("every other bead inside of the cone", {}, 5 * phi - 1, _BESIDE_ALL),
)  # fmt: skip
"""⟨p⟩/f_load inside, p being the vertical force that a bead gets from both upper contacts."""

LEG_PUSH = (
    Piece("j = l − 1, below the load", {p: 1}, Integer(0)),
    Piece("j = 0, l > 1", {j: 0}, (4 * (1 - 5 * phi) * l - phi**2 + 24 * phi - 7) / 8, (p >= 2,)),
    Piece("1 ≤ j ≤ l − 2, on a leg", {},
          (4 * (1 - 5 * phi) * (l - j) + phi**2 + 18 * phi - 3) / 8, (j >= 1, p >= 2)),
)  # fmt: skip
"""⟨p⟩/f_load on a leg, less ½."""


@dataclass(frozen=True)
class _Mean:
    """What has closed forms: its symbol and what that is, where it is, and the forms."""

    printed: sympy.Expr
    is_: sympy.Expr
    where: Where
    pieces: tuple[Piece, ...]
    steps_below: dict[sympy.Symbol, sympy.Expr]

    @property
    def domains(self) -> tuple[Where, ...]:
        """Those of its closed forms."""
        return cone.domains(self.where, self.pieces)


MEANS = {
    "contact": _Mean(INSIDE, Shift(ForcePlus(i, j) / cone.ORDERED), cone.INSIDE, CONTACT,
                     STEPS_BELOW),
    "leg-force": _Mean(ON_LEG - 1, Shift(ForcePlus(i, j) / cone.ORDERED), cone.LEFT_LEG, LEG,
                       cone.STEPS_DOWN_LEG),
    "bead": _Mean(BEAD, Shift(cone.PRESSED), cone.INSIDE, PUSH, STEPS_BELOW),
    "leg": _Mean(PUSH_ON_LEG - Rational(1, 2), Shift(cone.VERTICAL_PLUS), cone.LEFT_LEG, LEG_PUSH,
                 cone.STEPS_DOWN_LEG),
}  # fmt: skip
"""By the names of their exact forms; nothing inside of the cone is of order 0."""

OF_RADII = Chain((cone.FORCES, t4.DIRECTIONS))
"""Forces and directions to first order, in the radii."""


def at_finite_size() -> dict[str, ExactCase]:
    """The exact forms, of a contact and of a bead's p, inside of the cone and on its legs."""
    return {
        name: cone.exact_case(one.printed, one.pieces, UNIT, one.steps_below, "second order")
        for name, one in MEANS.items()
    }


# The means of all f⁺, from layer to layer down, proved together: below the bead that a contact
# leads to, what enters is known, and the balance of that bead in the mean gives what leaves it.

_DOWN = {j: l - n, p: n - q}
_STEPS = tuple(
    (*across, *down)
    for across in ((q <= -1,), (Eq(q, 0),), (Eq(q, 1),), (q >= 2,))
    for down in ((q >= n,), (Eq(q, n - 1),), (Eq(q, n - 2),), (q <= n - 3,))
)
"""Contacts by their distances from the legs."""


def _members(pieces: Sequence[Piece], *sites: sympy.Basic) -> Iterator[tuple[sympy.Eq, Where]]:
    for piece in pieces:
        relations = (
            *sites, *(Eq(symbol, at) for symbol, at in piece.at.items()), *piece.further
        )  # fmt: skip
        moved = (
            one.func(*(side.xreplace(_DOWN) for side in one.args), evaluate=False)
            for one in relations
        )
        value = piece.expression.xreplace(_DOWN) * UNIT * cone.ORDERED
        where = cone.LAYERS.also(*moved, indices=(q,))
        yield equation(Shift(ForcePlus(*cone.BELOW)), value), where


def _means() -> tuple[Theorem, ...]:
    facts = facts_of((OF_RADII,))

    def below(*known: tuple[Theorem, ...]) -> Rule:
        return rules.cases(mean_below(*known, *facts), *_STEPS)

    outside = [
        (equation(Shift(ForcePlus(*cone.BELOW)), 0), cone.LAYERS.also(one, indices=(q,)))
        for one in (q <= -1, q >= n)
    ]
    members = (*_members(LEG, Eq(q, 0)), *_members(CONTACT, q >= 1, p >= 1), *outside)
    top = mean_below(*facts)
    plus = rules.inducted(n, Integer(1), top, below, members)
    return (*plus, *map(rules.mirror, plus))


OF_FORCES = Beside(_means)
"""The mean of every contact's force below the load, less its ordered value."""

# lines

WITHIN = 2 * phi
AT_LOAD = (8 * phi * j + 2 * phi**3 - phi**2 + 6 * phi - 1) / 4
FURTHER = phi * (4 * j + phi**2 + 2) / 2
"""⟨να₁⟩ in units of (σ/r)²/(1−φ²), for j ≥ 2: inside, on a leg's first contact, further down it."""

_BY_HEIGHT = ((Eq(j, 0),), (Eq(j, 1),), (j >= 2,))
_OF_FORCE, _OF_PUSH = moment(OF_FORCES), moment(OF_FORCES, OF_RADII, cases=_BY_HEIGHT)


def _meaning(name: str) -> dict[sympy.Symbol, sympy.Expr]:
    one = MEANS[name]
    (symbol,) = one.printed.free_symbols
    return {symbol: one.is_ + symbol - one.printed}


@cache
def steps() -> Lines:
    """The balance of every bead in the mean: its sources, what they add up to, all sites."""
    inside, leg = MEANS["contact"].domains[-1], MEANS["leg-force"].domains[-1]
    lines = Lines(inside)
    balance = lines.show(
        "At order ε² the momentum of a contact is α₂n + α₁δn + α₀u₂, with α₀ = 1 on the legs of "
        "the cone and 0 inside. In the mean it balances at every bead: along b⁺, with δn^± = "
        "ν b^∓, ⟨α₂⟩ of the lower f⁺ is that of the upper one, and what is lost of ⟨να₁⟩ and ⟨u₂⟩ "
        "on the way. For that,",
        sympy.Tuple(
            equation(Dot(b_plus, b_plus), 1 / (1 - phi**2)),
            equation(Dot(b_plus, b_minus), -phi / (1 - phi**2)),
        ),
        rewrite(),
        where=Where(),
    )
    scale = sigma**2 / (r**2 * (1 - phi**2))
    sources = lines.show(
        "α₁ is Eq. 10 inside, Eqs. 7 and 9 on a leg. ⟨να₁⟩ inside, further down a leg, and on its "
        "first contact, for j ≥ 2:",
        sympy.Tuple(*(equation(with_force, one * scale) for one in (WITHIN, FURTHER, AT_LOAD))),
        moment(OF_RADII),
        where=(cone.INSIDE.also(j >= 2), leg, cone.LEFT_LEG.also(Eq(p, 1), j >= 2)),
        meaning={with_force: Covariance(t4.TILT, ForcePlus(i, j) / cone.ORDERED)},
        after=(eq11.DERIVATION, eq16.DERIVATION),
    )
    lines.show(
        "Inside it is the same for all contacts: nothing is lost, and f⁺ stays as it entered. At "
        "the right leg it enters with what the tilt of the leg changes from layer to layer, the "
        "same at each height:",
        PRINTED[0],
        _OF_FORCE,
        meaning=_meaning("contact"),
        after=(t4.B4, balance, sources),
    )
    loss = lines.show(
        "The leg pays for it: it loses per layer",
        equation(LOSS, LEG_LOSS * UNIT),
        _OF_FORCE,
        where=leg.also(p >= 3),
        meaning={LOSS: (Shift(ForcePlus(i + 1, j + 1)) - Shift(ForcePlus(i, j))) / cone.ORDERED},
        after=(t4.B4, balance, sources),
    )
    lines.show(
        "From the loaded bead downwards, summed:",
        PRINTED[1],
        _OF_FORCE,
        where=leg,
        meaning=_meaning("leg-force"),
        after=(loss,),
    )
    _claim(lines)
    return lines


_NAMES = {
    "contact": "the exact mean of every contact inside of the cone",
    "leg-force": "the exact mean on a leg",
    "bead": "the exact mean of the vertical force p on every bead inside of the cone: a plateau of "
    "5φ − 1, in units of (σ/r)²/(1−φ²)², at every height, the base too, off the beads beside a leg",
    "leg": "the exact mean of p on a leg",
}


def _claim(lines: Lines) -> None:
    inside = MEANS["contact"].domains[-1]
    here = ForcePlus(i, j)
    lines.claim(
        "what enters the cone is the same at every height j ≥ 2, and forces pass through the "
        "beads inside unchanged: the mean response inside is a plateau",
        sympy.Tuple(
            equation(Shift(ForcePlus(i - 1, j - 1)), Shift(here)),
            equation(Shift(ForcePlus(i + 2, j)), Shift(here)),
        ),
        _OF_FORCE,
        where=(inside.also(j >= 3), inside.also(p >= 2)),
    )
    lines.claim(
        "on the two lines of contacts that start at the bead straight below the load it is "
        "¼(7φ² + 14φ − 5)(σ/r)²/(1−φ²)² for 2 ≤ j ≤ l − 2",
        equation(INSIDE, (7 * phi**2 + 14 * phi - 5) / 4 * UNIT),
        _OF_FORCE,
        where=cone.INSIDE.also(Eq(q, 1), j >= 2),
        meaning=_meaning("contact"),
    )
    lines.claim(
        "the plateau is positive for φ > (√17 − 3)/4 and negative below; the legs lose "
        "2φ² + φ + 1 > 0 per layer, in units of (σ/r)²/(1−φ²)²",
        sympy.Tuple(
            equation(8 * _PLATEAU, terms((4 * phi + 3) ** 2, -17)),
            equation(8 * LEG_LOSS, terms((4 * phi + 1) ** 2, 7)),
        ),
        rewrite(),
        where=Where(),
    )
    for name, one in MEANS.items():
        by = _OF_FORCE if name in ("contact", "leg-force") else _OF_PUSH
        lines.claim(
            _NAMES[name],
            cone.closed_forms(one.printed, one.pieces, UNIT),
            exhausting(one.where, one.domains, by),
            where=one.domains,
            meaning=_meaning(name),
        )
    pushed = {k - l + j: 2, k - l + j + 2: 2, i: l - j - 3}
    lines.claim(
        "in p the legs pay what the plateau gains, in every layer: both legs, the beads beside "
        "them and the l − j − 3 others inside add up to no change",
        equation(
            sympy.Add(
                *(
                    count * Shift(cone.PRESSED.xreplace({i: across}))
                    for across, count in pushed.items()
                )
            ),
            0,
        ),
        _OF_PUSH,
        where=cone.INSIDE.also(*_BESIDE_ALL),
    )
    lines.claim(
        "outside of the cone the mean is zero at second order, too",
        sympy.Tuple(*(equation(Shift(ForcePlus(*cone.BELOW)), 0),) * 2),
        _OF_FORCE,
        where=tuple(cone.LAYERS.also(one, indices=(q,)) for one in (q <= -1, q >= n)),
    )


# witnesses

LEVELS = (1, 2, 3, 6)
"""Layers of the load; below the last there are contacts of every closed form."""


def _stated(inside: Sequence[Piece], leg: Sequence[Piece], at: explicit.Values) -> Fraction:
    """By a closed form, the first that fits; nothing outside of the cone."""
    if at[p] < 1 or at[q] < 0:
        return Fraction(0)
    pieces = inside if at[q] else leg
    piece = next(one for one in pieces if one.at.items() <= at.items())
    return explicit.number(piece.expression * UNIT, at)


def _witness(packing: SmallPacking) -> Ruling:
    values = {**explicit.geometry(*packing.n, Fraction(1)), sigma: 1, r: 1}

    def pairs() -> Iterator[tuple[str, Fraction, Fraction]]:
        for level in LEVELS:
            forces, pushes = (
                witnesses.response(level, packing.n),
                witnesses.pushes(level, packing.n),
            )
            for layer in range(level):
                for left in range(-1, level - layer + 2):
                    right = level - layer - left
                    at = {**values, l: level, j: layer, p: left, q: right}
                    where = f"l = {level}, j = {layer}, p = {left}, q = {right}"
                    for branch, side in (("+", 1), ("-", -1)):
                        true = forces[(side * (right - left), layer), branch]
                        yield f"f{branch}, {where}", _stated(CONTACT, LEG, at), true
                    if left < 1:  # on the right leg it is as on the left one
                        at |= {p: right, q: left}
                    yield f"p, {where}", _stated(PUSH, LEG_PUSH, at), pushes[right - left, layer]

    return compare(pairs())


B9 = Derivation(
    number="B9",
    name="mean_response",
    title="Mean response to a point load, to second order",
    symbols=(
        (INSIDE, "mean of a contact inside of the cone of the load on bead (k, l)"),
        (ON_LEG, "mean on a leg of the cone, over its value in the ordered packing"),
        (BEAD, "mean of p, the vertical force that a bead inside gets from both upper contacts"),
        (PUSH_ON_LEG, "the same on a leg, where one contact carries ½ f_load without disorder"),
        (f_load, "the load on bead (k, l), downwards"),
        (l, "layer of the loaded bead"),
        (p, "steps along n⁺ from (k, l) down to (i, j) (p is no force there)"),
        (q, "steps along n⁻; the contact in question is f⁺_ij, its mirror image f⁻"),
        *usual(sigma, r, phi),
    ),
    assumptions=(
        "the radii are independent, of zero mean and variance σ², of whatever law",
        "second order in δr",
        "inside: 2 ≤ j ≤ l − 3, and not on the two lines of contacts that start at the bead "
        "straight below the load; leg: 2 ≤ j ≤ l − 2; exact forms: every site",
    ),
    premises=(eq11.DERIVATION, eq16.DERIVATION, t4.B4),
    printed=PRINTED,
    domain=(sympy.Ge(j, 2), sympy.Ge(l, j + 3)),  # where both lines have a contact
    where=MEANS["contact"].domains[-1],
    exact=at_finite_size,
    steps=steps,
    witnesses=(
        Witness(
            "exact packings, ε²: the mean of every contact and bead of a cone, as fractions",
            _witness,
        ),
    ),
    remarks=(
        "The paper leaves open whether ensemble averaging and coarse graining agree. In the mean "
        "they do, exactly: loads superpose, and the ensemble is the same at every place, so that "
        "the response to N equal loads, averaged over N contacts, has the mean of this equation "
        "for each load and contact. Neither gives anything but two rays at order σ⁰; at order σ² "
        "both give the plateau between them.",
        "The plateau does not depend on the height, the depth or the place, but for the two layers "
        "of contacts next to the base, j = 0 and 1, which go their own way: the response does not "
        "spread as a diffusing ray would, and it does not decay away from the legs.",
        "In p, the vertical force on a bead and the paper's Green's function, the plateau is "
        "(5φ − 1)(σ/r)²/(1−φ²)² f_load down to the base itself. Vertical force is conserved, so "
        "that in p the legs pay just what the plateau gains; in f they do not, and the plateaus of "
        "p and of f differ in sign for 1/5 < φ < (√17 − 3)/4.",
    ),
)

DERIVATIONS = {B9.number: B9}

if __name__ == "__main__":
    from force_diffusion.derivations.commands.alone import run_alone

    raise SystemExit(run_alone(DERIVATIONS))
