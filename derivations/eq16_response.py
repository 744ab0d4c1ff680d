"""Eq. 16: variance of the response to a point load, inside of its cone and on it."""

from functools import cache

import sympy
from force_diffusion.derivations import eq07_load_split as eq07
from force_diffusion.derivations import eq09_straight_path as eq09
from force_diffusion.derivations import eq10_branched_path as eq10
from force_diffusion.derivations import eq11_total_force as eq11
from force_diffusion.derivations.framework.record import FIRST_ORDER, ExactCase, usual
from force_diffusion.derivations.framework.vocabulary import (
    UNIT,
    Derivation,
    Lines,
    asymptotic,
    equation,
    exhausting,
    formula,
    moment,
    rewrite,
    terms,
    times,
)
from force_diffusion.derivations.parts import cone
from force_diffusion.symbolic.kernel.where import along_base, inside_cone, on_leg
from force_diffusion.symbolic.mechanics.lattice import mirror
from force_diffusion.symbolic.mechanics.paths import IN_CONE, STEPS_BELOW
from force_diffusion.symbolic.notation import Symbol
from force_diffusion.symbolic.symbols import (
    Covariance,
    ForceMinus,
    ForcePlus,
    Mean,
    Variance,
    f_load,
    i,
    j,
    k,
    l,
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


def at_finite_size() -> dict[str, ExactCase]:
    """The exact forms, for a bead, one contact, and a leg of the cone."""
    return {
        "bead": cone.exact_case(RESPONSE, cone.BEAD, UNIT / 4, STEPS_BELOW),
        "contact": cone.exact_case(ONE_CONTACT, cone.CONTACT, UNIT / 4, STEPS_BELOW),
        "leg": cone.exact_case(ON_LEG, cone.LEG, UNIT / 4, cone.STEPS_DOWN_LEG),
        "leg-force": cone.exact_case(LEG_MAGNITUDE, cone.LEG_FORCE, UNIT, cone.STEPS_DOWN_LEG),
    }


MEANING = {
    RESPONSE: Variance(cone.PRESSED),
    ONE_CONTACT: Variance(n_y * ForcePlus(i, j) / f_load),
    ON_LEG: Variance(cone.VERTICAL_PLUS),
    LEG_MAGNITUDE: Variance(ForcePlus(i, j) / cone.ORDERED),
}
"""What the symbols stand for; f⁺_ij inside of the cone has no part of order 0 to be tilted."""


def _of(*symbols: sympy.Symbol) -> dict[sympy.Symbol, sympy.Expr]:
    return {symbol: MEANING[symbol] for symbol in symbols}


OF_CONTACT = equation(ONE_CONTACT, times(Rational(3, 4), terms(l, j, k, -i), UNIT))
"""One contact to leading order: (3/2)(j + p), by the layer in which its path turns."""

READ_OF_ONE_CONTACT = equation(ONE_CONTACT, PRINTED.rhs)
"""The printed form as the paper's words have it."""

_NEAR = {s: ((Eq(s, 1),), (Eq(s, 2),), (s >= 3,)) for s in (p, q)}
BY_STEPS = [(*left, *right) for left in _NEAR[p] for right in _NEAR[q]]
"""Beads inside of the cone by their distances from its legs."""

BY_LAYERS = [
    (*low, *top)
    for low in ((Eq(j, 0),), (Eq(j, 1),), (j >= 2,))
    for top in ((Eq(p, 1),), (p >= 2,))
]
"""Contacts by their distances from the base and from where they turn."""

LATE = (j >= 3, p >= 3, q >= 3)


@cache
def steps() -> Lines:
    """One path to each contact; squared weights; the sum of both upper contacts of a bead."""
    lines = Lines(cone.INSIDE)
    source = f_load / (2 * n_y)
    facts = (cone.FORCES, eq11.IN_RADII)
    in_cone = moment(*facts, whole=cone.INSIDE, cases=BY_STEPS)
    of_contact = moment(*facts, whole=cone.INSIDE, cases=BY_LAYERS)
    in_leg = moment(*facts, whole=cone.LEFT_LEG, cases=BY_LAYERS)
    beads, contacts = (cone.domains(cone.INSIDE, one) for one in (cone.BEAD, cone.CONTACT))
    legs = cone.domains(cone.LEFT_LEG, cone.LEG)
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
            equation(ForcePlus(i, j) / source, cone.UPPER_RIGHT),
            equation(ForceMinus(i, j) / source, cone.UPPER_LEFT),
        ),
        rewrite(cone.FORCES),
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
        equation(ONE_CONTACT, cone.CONTACT[-1].expression * UNIT / 4),
        of_contact,
        where=contacts[-1],
        meaning=_of(ONE_CONTACT),
        after=(forces,),
    )
    interior = lines.show(
        "It depends on the horizontal position: what the paper says of the force at one contact "
        "is refuted. What does not is the vertical force p that the "
        "bead gets from both contacts together: their second differences lie on two diagonals, and "
        "where these cross, the common weights add up to zero. Exact, for j ≥ 3:",
        equation(RESPONSE, cone.BEAD[-1].expression * UNIT / 4),
        in_cone,
        where=beads[-1],
        meaning=_of(RESPONSE),
        after=(forces,),
    )
    lines.show(
        "To leading order:",
        PRINTED,
        asymptotic(*facts, late=LATE),
        where=cone.INSIDE.in_the_limit(inside_cone("∼")),
        meaning=_of(RESPONSE),
        after=(interior,),
    )
    leg = lines.show(
        "On the left leg of the cone f⁺_ij is the split of the load (Eq. 7), carried down by "
        "Eq. 9. With the contact's own tilt its vertical component over f_load is",
        equation(
            cone.LEG_RESPONSE,
            terms(Rational(1, 2), times(Rational(1, 2), 1 / (1 - phi**2), cone.LEG_TILTS)),
        ),
        rewrite(),
        where=cone.LEFT_LEG,
        after=(eq07.DERIVATION, eq09.DERIVATION),
    )
    lines.show(
        "The two tilts are independent but for a few radii. Exact, for 2 ≤ j ≤ l − 2:",
        equation(ON_LEG, cone.LEG[-1].expression * UNIT / 4),
        in_leg,
        where=legs[-1],
        meaning=_of(ON_LEG),
        after=(leg,),
    )
    lines.show(
        "The magnitude of that force, over its mean squared:",
        equation(LEG_MAGNITUDE, cone.LEG_FORCE[-1].expression * UNIT),
        in_leg,
        where=legs[-1],
        meaning=_of(LEG_MAGNITUDE),
        after=(leg,),
    )
    lines.claim(
        "the exact variance of p at every bead inside of the cone",
        cone.closed_forms(RESPONSE, cone.BEAD, UNIT / 4),
        exhausting(cone.INSIDE, beads, in_cone),
        where=beads,
        meaning=_of(RESPONSE),
    )
    lines.claim(
        "for j ≥ 3 it does not depend on the horizontal position, exactly, but for the bead "
        "straight below the load",
        equation(RESPONSE, times(terms(6 * (l + j), -6, phi**2), UNIT / 4)),
        in_cone,
        where=beads[-1],
        meaning=_of(RESPONSE),
    )
    lines.claim(
        "the exact variance of one contact's vertical force, everywhere inside of the cone",
        cone.closed_forms(ONE_CONTACT, cone.CONTACT, UNIT / 4),
        exhausting(cone.INSIDE, contacts, of_contact),
        where=contacts,
        meaning=_of(ONE_CONTACT),
    )
    of_one = lines.claim(
        "to leading order that of one contact is 3s/2 in units of (σ/r)²/(1−φ²)², "
        "s = ½(l+j+k−i) being the layer where it turns",
        OF_CONTACT,
        asymptotic(*facts, late=LATE),
        where=cone.INSIDE.in_the_limit(inside_cone("∼")),
        meaning=_of(ONE_CONTACT),
    )
    lines.refute(
        "the paper's reading is refuted: one contact alone depends on the horizontal position",
        READ_OF_ONE_CONTACT,
        of_one,
        where=cone.INSIDE.in_the_limit(inside_cone("∼")),
        meaning=_of(ONE_CONTACT),
    )
    both = Covariance(cone.VERTICAL_PLUS, cone.VERTICAL_MINUS)
    straight = times(Rational(1, 4), (1 + phi) ** 2, UNIT / 4)
    lines.claim(
        "the covariance of a bead's two contacts is zero for j ≥ 3, but for the bead straight "
        "below the load",
        sympy.Tuple(equation(both, 0), equation(both, straight)),
        in_cone,
        where=(beads[-1], beads[-2]),
    )
    lines.claim(
        "a bead passes on what it gets: forces do not change along a diagonal",
        sympy.Tuple(
            equation(ForcePlus(i - 1, j - 1), ForcePlus(i, j)),
            equation(ForceMinus(i + 1, j - 1), ForceMinus(i, j)),
        ),
        rewrite(cone.FORCES),
        where=cone.INSIDE.also(j >= 1),
    )
    lines.claim(
        "the mean is that of the ordered packing",
        sympy.Tuple(
            equation(Mean(cone.PRESSED), 0), equation(Mean(cone.VERTICAL_PLUS), Rational(1, 2))
        ),
        moment(*facts),
        where=(cone.INSIDE, cone.LEFT_LEG),
    )
    beside = (cone.LEFT_OF_ALL, cone.RIGHT_OF_ALL)
    lines.claim(
        "no force of first order outside of the cone",
        sympy.Tuple(*(one for one, _ in beside), *(mirror(one) for one, _ in beside)),
        rewrite(cone.FORCES),
        where=(*(where for _, where in beside), *(where.mirrored() for _, where in beside)),
    )
    lines.claim(
        "the exact variance on a leg of the vertical force, and of the magnitude",
        sympy.Tuple(
            *cone.closed_forms(ON_LEG, cone.LEG, UNIT / 4),
            *cone.closed_forms(LEG_MAGNITUDE, cone.LEG_FORCE, UNIT),
        ),
        exhausting(cone.LEFT_LEG, legs, in_leg),
        where=legs * 2,
        meaning=_of(ON_LEG, LEG_MAGNITUDE),
    )
    lines.claim(
        "on a leg the vertical force has a third of the variance, to leading order",
        equation(ON_LEG, PRINTED.rhs / 3),
        asymptotic(*facts, late=(j >= 2, p >= 2)),
        where=cone.LEFT_LEG.in_the_limit(on_leg("∼")),
        meaning=_of(ON_LEG),
    )
    at_base = cone.INSIDE.put_in({j: Rational(0)}, (i, k, l, p, q))
    apex = MEANING[RESPONSE].xreplace({i: k, j: l - 2})
    lines.claim(
        "the variance straight below the load is twice that at the base, as l → ∞",
        equation(apex, times(2, MEANING[RESPONSE].xreplace({j: Rational(0)}))),
        asymptotic(*facts, late=(p >= 3, q >= 3)),
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
    where=cone.CONE,
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
