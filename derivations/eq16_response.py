"""Eq. 16: variance of the response to a point load, inside of its cone and on it."""

from functools import cache

import sympy
from force_diffusion.derivations import eq04_contact_plus as eq04
from force_diffusion.derivations import eq05_contact_minus as eq05
from force_diffusion.derivations import eq07_load_split as eq07
from force_diffusion.derivations import eq09_straight_path as eq09
from force_diffusion.derivations import eq10_branched_path as eq10
from force_diffusion.derivations import eq11_total_force as eq11
from force_diffusion.derivations.formulas.closed_form import ClosedForm
from force_diffusion.derivations.framework.grounds import Beside, facts_of
from force_diffusion.derivations.framework.record import FIRST_ORDER, usual
from force_diffusion.derivations.framework.vocabulary import (
    UNIT,
    Derivation,
    Lines,
    Where,
    asymptotic,
    axioms,
    equation,
    formula,
    minus,
    moment,
    rewrite,
    terms,
    times,
)
from force_diffusion.symbolic.kernel import rules, statistics
from force_diffusion.symbolic.kernel.rules import Rule
from force_diffusion.symbolic.kernel.theorem import Theorem, flat
from force_diffusion.symbolic.kernel.where import POINT, along_base, inside_cone, on_leg
from force_diffusion.symbolic.mechanics.lattice import mirror
from force_diffusion.symbolic.mechanics.paths import IN_CONE
from force_diffusion.symbolic.notation import Symbol
from force_diffusion.symbolic.symbols import (
    Covariance,
    DeltaNMinus,
    DeltaNPlus,
    Dot,
    ForceMinus,
    ForcePlus,
    Mean,
    Variance,
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
    phi,
    q,
    r,
    sigma,
)
from sympy import Eq, Rational

RESPONSE = Symbol(
    "response",
    r"\frac{\sigma_{\mathrm{ensemble}}^{2}(p)}{(f^{\mathrm{load}})^{2}}",
    "σ²(p)/f_load²",
)
ONE_CONTACT = Symbol(
    "contact_response",
    r"\frac{\sigma^{2}(n_{y} f_{ij}^{+})}{(f^{\mathrm{load}})^{2}}",
    "σ²(n_y f⁺_ij)/f_load²",
)
ON_LEG = Symbol(
    "leg_response",
    r"\frac{\sigma_{\mathrm{leg}}^{2}(p)}{(f^{\mathrm{load}})^{2}}",
    "σ²(p on a leg)/f_load²",
)
LEG_MAGNITUDE = Symbol(
    "leg_force",
    r"\frac{\sigma_{\mathrm{leg}}^{2}(f)}{\langle f\rangle^{2}}",
    "σ²(f on a leg)/⟨f⟩²",
)

PRINTED = equation(
    RESPONSE,
    formula("(3/(2(1 − φ²)²)) (l + j)(σ_δr/r)²"),
)

# the forces below the load: inside of its cone, on it and beside it

ORDERED = f_load / (2 * n_y)
"""Force of the contacts of the ordered packing: those on the legs of the cone."""

CONE = Where.of(p >= 1, q >= 1, *(Eq(symbol, at) for symbol, at in IN_CONE.items()), loading=POINT)
INSIDE = CONE.also(j >= 0)
"""Beads (i, j) inside of the cone below bead (k, l)."""

_ON_LEFT_LEG = (Eq(symbol, at.xreplace({q: sympy.S.Zero})) for symbol, at in IN_CONE.items())
LEFT_LEG = Where.of(p >= 1, *_ON_LEFT_LEG, j >= 0, loading=POINT)

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

_PLACE_BELOW = (k - n + 2 * q, l - n)
"""Lower bead of a contact f⁺ in layer l − n."""

LAYERS = Where.of(n >= 1, n <= l, loading=POINT)

_INWARDS = {i: _PLACE_BELOW[0], j: _PLACE_BELOW[1], p: n - q}
_STRAIGHT = {i: k - n, j: l - n}
_LEG_BELOW, _BRANCHED = LEG_CONTACT.xreplace(_STRAIGHT), UPPER_RIGHT.xreplace(_INWARDS)

RIGHT_OF_ALL = (equation(ForcePlus(*_PLACE_BELOW), 0), LAYERS.also(q >= n, indices=(q,)))
LEFT_OF_ALL = (equation(ForcePlus(*_PLACE_BELOW), 0), LAYERS.also(q <= -1, indices=(q,)))

FAMILY = (
    (equation(ForcePlus(k - n, l - n), times(ORDERED, _LEG_BELOW)), LAYERS),
    (
        equation(ForcePlus(*_PLACE_BELOW), times(ORDERED, _BRANCHED)),
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


FACTS = (FORCES, eq11.DIRECTIONS)
BELOW = Where.of(j >= 0, j < l, indices=(i, k), loading=POINT)
"""Contacts and beads below the loaded bead (k, l)."""


def at_finite_size() -> dict[str, ClosedForm]:
    """The exact forms everywhere below the load: of a bead, and of a contact along n⁺."""
    known = tuple(flat(facts_of(FACTS)))

    def closed(symbol: sympy.Symbol) -> ClosedForm:
        meant = MEANING[symbol]
        form = statistics.ClosedForm.of(meant, BELOW, known)
        return ClosedForm(symbol, form, BELOW, (4, 5, 7, 9, 10), meant, known)

    return {
        "bead": closed(RESPONSE),
        "contact": closed(ONE_CONTACT),
        "force": closed(LEG_MAGNITUDE),
    }


MEANING = {
    RESPONSE: Variance(PRESSED / f_load),
    ONE_CONTACT: Variance(VerticalPlus(i, j) / f_load),
    ON_LEG: Variance(VerticalPlus(i, j) / f_load),
    LEG_MAGNITUDE: Variance(ForcePlus(i, j) / ORDERED),
}
"""What the symbols stand for; f⁺_ij inside of the cone has no part of order 0 to be tilted."""


def _of(*symbols: sympy.Symbol) -> dict[sympy.Symbol, sympy.Expr]:
    return {symbol: MEANING[symbol] for symbol in symbols}


OF_CONTACT = equation(ONE_CONTACT, times(Rational(3, 4), terms(l, j, k, -i), UNIT))
"""One contact to leading order: (3/2)(j + p), by the layer in which its path turns."""

READ_OF_ONE_CONTACT = equation(ONE_CONTACT, PRINTED.rhs)
"""The printed form as the paper's words have it."""

DEEP = INSIDE.also(j >= 3, p + q >= 3)
"""Beads inside of the cone, from the third layer on, but that straight below the load."""
STRAIGHT = INSIDE.also(j >= 3, Eq(p, 1), Eq(q, 1))
TURNED = INSIDE.also(j + p >= 2)
DOWN_LEG = LEFT_LEG.also(j >= 2, p >= 2)

EXACT = {
    RESPONSE: (6 * l + 6 * j - 6 + phi**2) * UNIT / 4,
    ONE_CONTACT: (6 * l + 6 * j + 6 * k - 6 * i - 6 + phi**2) * UNIT / 8,
    ON_LEG: (2 * l + 2 * j - 2 + 2 * phi + phi**2) * UNIT / 4,
    LEG_MAGNITUDE: (4 * l - 4 + 4 * phi**2 * j + 5 * phi**2 + phi**4) * UNIT / 2,
}
"""The usual formulas, away from base, load and legs."""


@cache
def steps() -> Lines:
    """One path to each contact; squared weights; the sum of both upper contacts of a bead."""
    lines = Lines(INSIDE)
    source = f_load / (2 * n_y)
    by = moment(*FACTS)
    loaded = lines.show(
        "Let (i, j) lie p steps along n⁺ and q steps along n⁻ below the loaded bead (k, l): inside "
        "of the cone for p, q ≥ 1. The loaded bead is",
        sympy.Tuple(equation(k, IN_CONE[k]), equation(l, IN_CONE[l])),
        rewrite(),
    )
    forces = lines.show(
        "One path with one branch leads to f⁺_ij, along n⁻ and then n⁺, and one to f⁻_ij, along n⁺ "
        "and then n⁻ (Eq. 10). The branch is of first order, and f_load/2n_y enters it (Eq. 7).",
        sympy.Tuple(
            equation(ForcePlus(i, j) / source, UPPER_RIGHT),
            equation(ForceMinus(i, j) / source, UPPER_LEFT),
        ),
        rewrite(FORCES),
        after=(eq07.DERIVATION, eq10.DERIVATION),
    )
    lines.show(
        "They turn in the layers j + p and j + q; the two add up to l + j wherever the bead is.",
        equation(terms(j + p, j + q), l + j),
        rewrite(),
        after=(loaded,),
    )
    lines.show(
        "In the radii (Eqs. 4 and 5) f⁺_ij is a sum of second differences up to the layer below "
        "its turn, as in Eq. 12, and four radii. Exact variance of its vertical component:",
        equation(ONE_CONTACT, EXACT[ONE_CONTACT]),
        by,
        where=TURNED,
        meaning=_of(ONE_CONTACT),
        after=(forces,),
    )
    interior = lines.show(
        "It depends on the horizontal position: what the paper says of the force at one contact "
        "is refuted. What does not is the vertical force p that the "
        "bead gets from both contacts together: their second differences lie on two diagonals, and "
        "where these cross, the common weights add up to zero. Exact, for j ≥ 3:",
        equation(RESPONSE, EXACT[RESPONSE]),
        by,
        where=DEEP,
        meaning=_of(RESPONSE),
        after=(forces,),
    )
    lines.show(
        "To leading order:",
        PRINTED,
        asymptotic(*FACTS),
        where=INSIDE.in_the_limit(inside_cone("∼")),
        meaning=_of(RESPONSE),
        after=(interior,),
    )
    leg = lines.show(
        "On the left leg of the cone f⁺_ij is the split of the load (Eq. 7), carried down by "
        "Eq. 9. With the contact's own tilt its vertical component over f_load is",
        equation(
            LEG_RESPONSE,
            terms(Rational(1, 2), times(Rational(1, 2), 1 / (1 - phi**2), LEG_TILTS)),
        ),
        rewrite(),
        where=LEFT_LEG,
        after=(eq07.DERIVATION, eq09.DERIVATION),
    )
    lines.show(
        "The two tilts are independent but for a few radii. Exact, for 2 ≤ j ≤ l − 2:",
        equation(ON_LEG, EXACT[ON_LEG]),
        by,
        where=DOWN_LEG,
        meaning=_of(ON_LEG),
        after=(leg,),
    )
    lines.show(
        "The magnitude of that force, over its mean squared:",
        equation(LEG_MAGNITUDE, EXACT[LEG_MAGNITUDE]),
        by,
        where=DOWN_LEG,
        meaning=_of(LEG_MAGNITUDE),
        after=(leg,),
    )
    of_one = lines.claim(
        "to leading order that of one contact is 3s/2 in units of (σ/r)²/(1−φ²)², "
        "s = ½(l+j+k−i) being the layer where it turns",
        OF_CONTACT,
        asymptotic(*FACTS),
        where=INSIDE.in_the_limit(inside_cone("∼")),
        meaning=_of(ONE_CONTACT),
    )
    lines.refute(
        "the paper's reading is refuted: one contact alone depends on the horizontal position",
        READ_OF_ONE_CONTACT,
        of_one,
        where=INSIDE.in_the_limit(inside_cone("∼")),
        meaning=_of(ONE_CONTACT),
    )
    both = Covariance(VerticalPlus(i, j) / f_load, VerticalMinus(i, j) / f_load)
    straight = times(Rational(1, 4), (1 + phi) ** 2, UNIT / 4)
    lines.claim(
        "the covariance of a bead's two contacts is zero for j ≥ 3, but for the bead straight "
        "below the load",
        sympy.Tuple(equation(both, 0), equation(both, straight)),
        by,
        where=(DEEP, STRAIGHT),
    )
    lines.claim(
        "a bead passes on what it gets: forces do not change along a diagonal",
        sympy.Tuple(
            equation(ForcePlus(i - 1, j - 1), ForcePlus(i, j)),
            equation(ForceMinus(i + 1, j - 1), ForceMinus(i, j)),
        ),
        rewrite(FORCES),
        where=INSIDE.also(j >= 1),
    )
    lines.claim(
        "the mean is that of the ordered packing",
        sympy.Tuple(
            equation(Mean(PRESSED), 0),
            equation(Mean(VerticalPlus(i, j) / f_load), Rational(1, 2)),
        ),
        by,
        where=(INSIDE, LEFT_LEG),
    )
    beside = (LEFT_OF_ALL, RIGHT_OF_ALL)
    lines.claim(
        "no force of first order outside of the cone",
        sympy.Tuple(*(one for one, _ in beside), *(mirror(one) for one, _ in beside)),
        rewrite(FORCES),
        where=(*(where for _, where in beside), *(where.mirrored() for _, where in beside)),
    )
    lines.claim(
        "on a leg the vertical force has a third of the variance, to leading order",
        equation(ON_LEG, PRINTED.rhs / 3),
        asymptotic(*FACTS),
        where=LEFT_LEG.in_the_limit(on_leg("∼")),
        meaning=_of(ON_LEG),
    )
    at_base = INSIDE.put_in({j: Rational(0)}, (i, k, l, p, q))
    apex = MEANING[RESPONSE].xreplace({i: k, j: l - 2})
    lines.claim(
        "the variance straight below the load is twice that at the base, as l → ∞",
        equation(apex, times(2, MEANING[RESPONSE].xreplace({j: Rational(0)}))),
        asymptotic(*FACTS),
        where=at_base.in_the_limit(along_base("∼")),
    )
    return lines


DERIVATION = Derivation(
    number=16,
    name="response",
    title="Variance of the response to a point load: refuted for one contact, proved for a "
    "bead's two",
    symbols=(
        (
            RESPONSE,
            "variance of p over packings; p is the vertical force on bead (i, j), see below",
        ),
        (ONE_CONTACT, "the same for the vertical component of f⁺_ij alone"),
        (ON_LEG, "the same for the one contact on a leg of the cone"),
        (LEG_MAGNITUDE, "variance of its magnitude over the squared mean"),
        (f_load, "the load on bead (k, l), downwards"),
        (l, "layer of the loaded bead, j that of the one looked at"),
        (p, "steps along n⁺ from (k, l) down to (i, j) (p is no force there)"),
        (q, "steps along n⁻"),
        *usual(sigma, r, phi),
    ),
    assumptions=(
        *FIRST_ORDER,
        "p is the vertical force that bead (i, j) gets from both upper contacts together",
        "(i, j) is inside of the cone: p, q ≥ 1",
        "printed form: l → ∞ at fixed j/l and (i − k)/l; exact forms: every site",
    ),
    premises=(
        eq04.DERIVATION,
        eq05.DERIVATION,
        eq07.DERIVATION,
        eq09.DERIVATION,
        eq10.DERIVATION,
        eq11.DERIVATION,
    ),
    printed=(PRINTED,),
    loads=("single",),
    relation="∼",
    exact=at_finite_size,
    steps=steps,
    where=CONE,
    remarks=(
        "The paper's p is the vertical component of the force at a contact f^±_ij. For one contact "
        "the printed form does not hold: its variance is (3/2) s (σ/r)²/(1−φ²)² with the layer "
        "s = ½(l+j±(k−i)) in which its path turns, so it grows from (3/2) j beside one leg "
        "to (3/2) l beside the other. The printed form holds for both upper contacts of a bead "
        "together, and, since these pass through it, for both lower ones.",
        "For that p the horizontal position drops out exactly, not only to leading order, from the "
        "third layer above the base on, except straight below the load.",
        "The fluctuations on the cone, which the paper leaves out, are of the same order: "
        "(l + j)/2 in place of 3(l + j)/2 for the vertical force, on a mean of ½ f_load.",
        "'Twice as large near the apex as near the base' is the variance; the standard deviation "
        "is √2 times as large.",
    ),
)

if __name__ == "__main__":
    from force_diffusion.derivations.commands.alone import run_alone

    raise SystemExit(run_alone(DERIVATION))
