"""T7: the mean response to a point load at second order in the radii, Eq. B9.

Of one contact: a plateau inside of the cone, and what its legs carry. Of the vertical force p on a
bead, the paper's Green's function: the same plateau down to the base, which the legs pay for.
"""

from collections.abc import Iterator, Sequence
from functools import cache

import sympy
from force_diffusion.derivations import eq11_total_force as eq11
from force_diffusion.derivations import eq16_response as eq16
from force_diffusion.derivations.beyond import t4_second_order as t4
from force_diffusion.derivations.beyond.t7_averages import B22
from force_diffusion.derivations.beyond.t7_pairs import B23
from force_diffusion.derivations.framework.catalogue import Number
from force_diffusion.derivations.framework.grounds import Beside, facts_of
from force_diffusion.derivations.framework.record import SECOND_ORDER, ExactCase, Piece, usual
from force_diffusion.derivations.framework.vocabulary import (
    UNIT,
    Chain,
    Derivation,
    Lines,
    Where,
    equation,
    exhausting,
    formula,
    moment,
    relations,
    rewrite,
    terms,
    times,
)
from force_diffusion.derivations.parts import cone
from force_diffusion.symbolic.kernel import rules
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


def _printed(left: sympy.Expr, change: str) -> sympy.Eq:
    return equation(left, times(1 / (1 - phi**2) ** 2, formula(change), formula("(σ_δr/r)²")))


_PLATEAU = "2φ² + 3φ − 1"
_LEG = "2l(1 − φ)² − (2φ² + φ + 1)(l − j) − φ³/2 + 9φ²/4 + 3φ − 3/4"
PRINTED = (_printed(INSIDE, _PLATEAU), _printed(terms(ON_LEG, -1), _LEG))

# Closed forms at every site, in units of (σ/r)²/(1−φ²)², the first that fits: the contact f⁺_ij, or
# the bead (i, j), lies p steps along n⁺ and q along n⁻ below the loaded bead, on a leg for q = 0.

LEG_LOSS = formula("2φ² + φ + 1")
_BESIDE_ALL, _STRAIGHT_BELOW = (p >= 2, q >= 2), {p: 1, q: 1}

CONTACT = (
    Piece("j = 0, straight below the load", {j: 0, **_STRAIGHT_BELOW}, formula("(1 + 9φ + 6φ²)/4")),
    Piece("j = 0, q = 1", {j: 0, q: 1}, formula("(5φ² + 13φ − 2)/4"), (p >= 2,)),
    Piece("j = 0, p = 1", {j: 0, p: 1}, formula("(7φ² + 7φ + 2)/4"), (q >= 2,)),
    Piece("j = 0, further inside", {j: 0}, formula("(6φ² + 11φ − 1)/4"), _BESIDE_ALL),
    Piece("j = 1, q = 1", {j: 1, q: 1}, formula("(7φ² + 17φ − 8)/4")),
    Piece("j = 1, q > 1", {j: 1}, formula("(8φ² + 15φ − 7)/4"), (q >= 2,)),
    Piece("j ≥ 2, q = 1", {q: 1}, formula("(7φ² + 14φ − 5)/4"), (j >= 2,)),
    Piece("j ≥ 2, every other contact inside of the cone", {}, formula(_PLATEAU), (j >= 2, q >= 2)),
)
"""⟨f⁺_ij⟩ over f_load/2n_y, inside."""

LEG = (
    Piece("j = 0, l = 1", {j: 0, p: 1}, formula("(1 − φ)(2 − φ)(1 − 2φ)/2")),
    Piece("j = 0, l > 1", {j: 0},
          formula("l(1 − 5φ) − (3φ³ − 11φ² − 11φ + 3)/4"), (p >= 2,)),
    Piece("j = 1, l = 2", {j: 1, p: 1}, formula("(1 − φ)(3φ² − 16φ + 6)/4")),
    Piece("j = 1, l > 2", {j: 1},
          formula("l(1 − 5φ) − (2φ³ − 17φ² − 19φ + 2)/4"), (p >= 2,)),
    Piece("j = l − 1 ≥ 2", {p: 1}, formula("(1 − φ)[8l(1 − φ) + 3φ² − 7]/4"), (j >= 2,)),
    Piece("2 ≤ j ≤ l − 2, on a leg", {}, formula(_LEG), (j >= 2, p >= 2)),
)  # fmt: skip
"""⟨f⟩ on a leg over f_load/2n_y, less 1."""

PUSH = (
    Piece("j = 0, straight below the load", {j: 0, **_STRAIGHT_BELOW}, formula("(φ² + 16φ − 1)/4")),
    Piece("j = 0, beside the left leg", {j: 0, q: 1}, formula("(φ² + 36φ − 5)/8"), (p >= 2,)),
    Piece("j = 0, beside the right leg", {j: 0, p: 1}, formula("(φ² + 36φ − 5)/8"), (q >= 2,)),
    Piece("i = k, j = l − 2 ≥ 1", _STRAIGHT_BELOW, formula("(22φ − 5 − φ²)/4"), (j >= 1,)),
    Piece("j ≥ 1, beside the left leg", {q: 1}, formula("(42φ − 9 − φ²)/8"), (j >= 1, p >= 2)),
    Piece("j ≥ 1, beside the right leg", {p: 1}, formula("(42φ − 9 − φ²)/8"), (j >= 1, q >= 2)),
    Piece("every other bead inside of the cone", {}, formula("5φ − 1"), _BESIDE_ALL),
)
"""⟨p⟩/f_load inside, p being the vertical force that a bead gets from both upper contacts."""

LEG_PUSH = (
    Piece("j = l − 1, below the load", {p: 1}, Integer(0)),
    Piece("j = 0, l > 1", {j: 0}, formula("[4(1 − 5φ)l − φ² + 24φ − 7]/8"), (p >= 2,)),
    Piece("1 ≤ j ≤ l − 2, on a leg", {},
          formula("[4(1 − 5φ)(l − j) + φ² + 18φ − 3]/8"), (j >= 1, p >= 2)),
)  # fmt: skip
"""⟨p⟩/f_load on a leg, less ½."""


def _mean(
    left: sympy.Expr,
    of: sympy.Expr,
    pieces: tuple[Piece, ...],
    sites: tuple[Where, dict[sympy.Symbol, sympy.Expr]],
) -> cone.Below:
    where, steps = sites
    return cone.Below(left, Shift(of), where, pieces, UNIT, steps, "second order")


_INSIDE, _ON_LEG = (cone.INSIDE, STEPS_BELOW), (cone.LEFT_LEG, cone.STEPS_DOWN_LEG)
MEANS = {
    "contact": _mean(INSIDE, ForcePlus(i, j) / cone.ORDERED, CONTACT, _INSIDE),
    "leg-force": _mean(ON_LEG - 1, ForcePlus(i, j) / cone.ORDERED, LEG, _ON_LEG),
    "bead": _mean(BEAD, cone.PRESSED, PUSH, _INSIDE),
    "leg": _mean(PUSH_ON_LEG - Rational(1, 2), cone.VERTICAL_PLUS, LEG_PUSH, _ON_LEG),
}
"""By the names of their exact forms; nothing inside of the cone is of order 0."""

OF_RADII = Chain((cone.FORCES, eq11.DIRECTIONS))
"""Forces and directions to first order, in the radii."""


def at_finite_size() -> dict[str, ExactCase]:
    """The exact forms, of a contact and of a bead's p, inside of the cone and on its legs."""
    return {name: one.exact() for name, one in MEANS.items()}


# The means of all f⁺, from layer to layer down, proved together: below the bead that a contact
# leads to, what enters is known, and the balance of that bead in the mean gives what leaves it.

_DOWN = {j: l - n, p: n - q}
_STEPS = tuple(
    (*across, *down)
    for across in map(relations, ("q ≤ −1", "q = 0", "q = 1", "q ≥ 2"))
    for down in map(relations, ("q ≥ n", "q = n − 1", "q = n − 2", "q ≤ n − 3"))
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

TILTED = tuple(map(formula, ("2φ", "φ(4j + φ² + 2)/2", "(8φj + 2φ³ − φ² + 6φ − 1)/4")))
"""⟨να₁⟩ in units of (σ/r)²/(1−φ²), for j ≥ 2: inside, on a leg's first contact, further down it."""

_BY_HEIGHT = ((Eq(j, 0),), (Eq(j, 1),), (j >= 2,))
_OF_FORCE, _OF_PUSH = moment(OF_FORCES), moment(OF_FORCES, OF_RADII, cases=_BY_HEIGHT)


@cache
def steps() -> Lines:
    """The balance of every bead in the mean: its sources, what they add up to, all sites."""
    inside, leg = MEANS["contact"].domains[-1], MEANS["leg-force"].domains[-1]
    meaning = {symbol: of for one in MEANS.values() for symbol, of in one.meaning.items()}
    lines = Lines(inside, _OF_FORCE, meaning)
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
        sympy.Tuple(*(equation(with_force, one * scale) for one in TILTED)),
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
        after=(t4.B4, balance, sources),
    )
    loss = lines.show(
        "The leg pays for it: it loses per layer",
        equation(LOSS, LEG_LOSS * UNIT),
        where=leg.also(p >= 3),
        meaning={LOSS: (Shift(ForcePlus(i + 1, j + 1)) - Shift(ForcePlus(i, j))) / cone.ORDERED},
        after=(t4.B4, balance, sources),
    )
    lines.show(
        "From the loaded bead downwards, summed:",
        PRINTED[1],
        where=leg,
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
        where=(inside.also(j >= 3), inside.also(p >= 2)),
    )
    lines.claim(
        "on the two lines of contacts that start at the bead straight below the load it is "
        "¼(7φ² + 14φ − 5)(σ/r)²/(1−φ²)² for 2 ≤ j ≤ l − 2",
        equation(INSIDE, formula("(7φ² + 14φ − 5)/4") * UNIT),
        where=cone.INSIDE.also(Eq(q, 1), j >= 2),
    )
    lines.claim(
        "the plateau is positive for φ > (√17 − 3)/4 and negative below; the legs lose "
        "2φ² + φ + 1 > 0 per layer, in units of (σ/r)²/(1−φ²)²",
        sympy.Tuple(
            equation(8 * formula(_PLATEAU), terms((4 * phi + 3) ** 2, -17)),
            equation(8 * LEG_LOSS, terms((4 * phi + 1) ** 2, 7)),
        ),
        rewrite(),
        where=Where(),
    )
    for name, one in MEANS.items():
        by = _OF_FORCE if name in ("contact", "leg-force") else _OF_PUSH
        lines.claim_each(_NAMES[name], one.forms(), exhausting(one.where, one.domains, by))
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
        where=tuple(cone.LAYERS.also(one, indices=(q,)) for one in (q <= -1, q >= n)),
    )


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
        (q, "steps along n⁻; the contact in question is f⁺_ij, and for f⁻ p and q change places"),
        *usual(sigma, r, phi),
    ),
    assumptions=(
        *SECOND_ORDER,
        "inside: 2 ≤ j ≤ l − 3, and not on the two lines of contacts that start at the bead "
        "straight below the load; leg: 2 ≤ j ≤ l − 2; exact forms: every site",
    ),
    premises=(eq11.DERIVATION, eq16.DERIVATION, t4.B4),
    printed=PRINTED,
    domain=(sympy.Ge(j, 2), sympy.Ge(l, j + 3)),  # where both lines have a contact
    where=MEANS["contact"].domains[-1],
    exact=at_finite_size,
    steps=steps,
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

DERIVATIONS: dict[Number, Derivation] = {one.number: one for one in (B9, B22, B23)}

if __name__ == "__main__":
    from force_diffusion.derivations.commands.alone import run_alone

    raise SystemExit(run_alone(DERIVATIONS))
