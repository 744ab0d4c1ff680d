"""Eq. 16: variance of the response to a point load, inside its cone and on it."""

# fmt: off
from functools import cache

from force_diffusion.derivations import (
    eq05_contact_minus as eq05, eq07_load_split as eq07, eq09_straight_path as eq09,
    eq10_branched_path as eq10)
from force_diffusion.derivations.framework.vocabulary import (
    FIRST_ORDER, ClosedForm, Derivation, Domain, Groups, Limit, Steps, Symbol, Theorem, asymptotic,
    axioms, equation, layers, minus, mirror, moment, power, rewrite, same, shown,
    terms, times, usual)
from force_diffusion.symbolic.symbols import (
    DeltaNMinus, DeltaNPlus, Dot, ForceMinus, ForcePlus, Mean, Variance, VerticalMinus,
    VerticalPlus, e_y, f_load, i, j, k, l, n, n_minus, n_plus, n_y, phi, q, r, sigma)
from sympy import Eq, Rational, S, Tuple
# fmt: on

RESPONSE, ONE_CONTACT = (
    Symbol(name, rf"\frac{{{latex}}}{{(f^{{\mathrm{{load}}}})^{{2}}}}", f"{words}/f_load²")
    for name, latex, words in (
        ("response", r"\sigma_{\mathrm{ensemble}}^{2}(p)", "σ²(p)"),
        ("contact_response", r"\sigma^{2}(p_{ij}^{+})", "σ²(p⁺_ij)"),
    )
)
ORDERED = f_load / (2 * n_y)
"""Force of the contacts of the ordered packing: those on the legs of the cone."""
PRESSED = VerticalPlus(i, j) + VerticalMinus(i, j)
"""p: the vertical force that a bead gets from both upper contacts."""

MEANING = {
    RESPONSE: Variance(PRESSED / f_load),
    ONE_CONTACT: Variance(VerticalPlus(i, j) / f_load),
}
"""What the symbols stand for."""

PRINTED = equation(RESPONSE, times(3 / (2 * (1 - phi**2) ** 2), terms(l, j), power(sigma / r, 2)))

# bead (i, j) is n steps along n⁺ and q steps along n⁻ below the loaded bead (k, l)
ALL_BELOW = Domain.of(j >= 0, j < l, indices=(i, k), loading=axioms.POINT)
REACHED = ALL_BELOW.also(Eq(k, i + n - q), Eq(l, j + n + q))
INSIDE = REACHED.also(n >= 1, q >= 1)
LEFT_LEG = REACHED.also(n >= 1, Eq(q, 0))
_FIXED = "l → ∞ at fixed j/l and (i − k)/l, inside the cone"
CONE = INSIDE.in_the_limit(Limit("∼", _FIXED, (j, n, q), (j, n, q)))
DOWN_LEG = Limit("∼", "l → ∞ at fixed j/l, on a leg of the cone", (j, n), (j, n))
ALONG_BASE = Limit("∼", "l → ∞ at j = 0 and fixed (i − k)/l, inside the cone", (n, q), (n, q))

UPPER_RIGHT = eq10.branched_plus(i, j, n)
"""The force f⁺_ij on a bead inside the cone, over f_load/2n_y, to first order.

It has one path with one branch from the loaded bead: q steps along n⁻ and n along n⁺. The branch is
of first order; what enters it counts at order 0, f_load/2n_y.
"""
LEG_CONTACT = eq09.first_order_product(eq07.split_plus(k, l), eq09.PRINTED.rhs)
"""f⁺_ij over f_load/2n_y on the left leg: the split of the load, carried down a straight path."""
LEG_RESPONSE = (LEG_CONTACT + Dot(e_y, DeltaNPlus(i, j)) / n_y) / 2
"""Its vertical component over f_load, the contact's own direction being tilted."""
LEG_TILTS = terms(Dot(n_minus, DeltaNPlus(i, j)), minus(Dot(n_plus, DeltaNMinus(k + 1, l - 1))))

FAMILY = (
    (equation(ForcePlus(i, j), times(ORDERED, LEG_CONTACT)), ALL_BELOW.also(Eq(k - i, l - j))),
    (equation(ForcePlus(i, j), times(ORDERED, UPPER_RIGHT)), INSIDE),
    (equation(ForcePlus(i, j), S.Zero), ALL_BELOW.also(k - i >= l - j + 1)),
    (equation(ForcePlus(i, j), S.Zero), ALL_BELOW.also(i - k >= l - j)),
)
"""All forces along n⁺ below the load: on the left leg, inside the cone, and none beside it."""

EXACT = {
    RESPONSE: times(terms(6 * l, 6 * j, -6, phi**2), layers.UNIT / 4),
    ONE_CONTACT: times(terms(3 * l, 3 * j, 3 * k, -3 * i, -3, phi**2 / 2), layers.UNIT / 4),
}
"""The usual formulas, away from base, load and legs."""
ON_LEG = times(terms(2 * l, 2 * j, -2, 2 * phi, phi**2), layers.UNIT / 4)
"""That of a contact on the left leg."""
DEEP = INSIDE.also(j >= 3, n + q >= 3)
"""Beads inside the cone, from the third layer on, but that straight below the load."""


@cache
def forces() -> tuple[Theorem, ...]:
    """The force of every contact below the load."""
    plus = eq07.carried_down(l - 1, axioms.loads(axioms.POINT), FAMILY, mirrored=True)
    return (*shown(16, *plus), *map(mirror, plus))


@cache
def in_radii() -> Groups:
    """The forces and, in the radii, the directions of contacts."""
    return forces(), eq05.directions()


def show_steps(steps: Steps) -> None:
    """One path to each contact; squared weights; the sum of both upper contacts of a bead."""
    groups = in_radii()
    by = moment(*groups)
    steps.show(
        "Let (i, j) lie n steps along n⁺ and q steps along n⁻ below the loaded bead (k, l): on the "
        "left leg of the cone for q = 0, on its right leg for n = 0, inside the cone for n, q ≥ 1. "
        "The forces along n⁺ follow by balancing bead after bead, from the load down. They are, in "
        "this order: on the left leg the split of the load (as in Eq. 7), carried down (as in "
        "Eq. 9); inside the cone the force that branches off the right leg (as in Eq. 10), which "
        "is of first order; and zero on the right leg and outside the cone. The forces along n⁻ "
        "are their mirror image.",
        Tuple(*(statement for statement, _ in FAMILY)),
        [same(theorem) for theorem in forces()[: len(FAMILY)]],
        [domain for _, domain in FAMILY],
    )
    steps.show(
        "The two forces on a bead inside the cone branch off in the layers j + n and j + q. The "
        "two heights add up to l + j wherever the bead is.",
        equation(terms(j + n, j + q), l + j),
        rewrite(),
    )
    steps.show(
        "By Eq. 5, f⁺_ij is a sum of second differences up to the layer below its branch, as in "
        "Eq. 12, and of four radii. Its vertical component p⁺_ij has, for n, q ≥ 1 and j + n ≥ 2, "
        "exactly the variance",
        equation(ONE_CONTACT, EXACT[ONE_CONTACT]),
        moment(forces(), eq05.DERIVATION.theorem),
        INSIDE.also(j + n >= 2),
    )
    exact = steps.show(
        "It depends on the horizontal position, so what the paper says of the force at one contact "
        "does not hold. It holds for the vertical force p that the bead gets from both contacts "
        "together: their second differences lie on two diagonals, and where these cross, the "
        "products of their weights add up to zero. Exactly, for n, q ≥ 1, n + q ≥ 3 and j ≥ 3:",
        equation(RESPONSE, EXACT[RESPONSE]),
        by,
        DEEP,
    )
    steps.show("To leading order:", PRINTED, asymptotic(exact.theorem), CONE)
    steps.show(
        "On the left leg the contact itself is tilted, too, so that p⁺_ij over f_load is",
        equation(
            LEG_RESPONSE, terms(Rational(1, 2), times(Rational(1, 2), 1 / (1 - phi**2), LEG_TILTS))
        ),
        rewrite(eq07.right_angles()[0]),
        LEFT_LEG,
    )
    steps.show(
        "The two tilts share only a few radii. Exactly, for 2 ≤ j ≤ l − 2 on the left leg:",
        equation(ONE_CONTACT, ON_LEG),
        by,
        LEFT_LEG.also(j >= 2, n >= 2),
    )
    claims(steps)


def claims(steps: Steps) -> None:
    """What else follows."""
    by, leading = moment(*in_radii()), asymptotic(*in_radii())
    steps.claim(
        "to leading order the variance at one contact is 3m/2 in units of (σ/r)²/(1−φ²)², where "
        "m = ½(l+j+k−i) is the layer in which its path branches",
        equation(ONE_CONTACT, times(Rational(3, 4), terms(l, j, k, -i), layers.UNIT)),
        asymptotic(forces(), eq05.DERIVATION.theorem),
        CONE,
    )
    steps.refute(
        "the paper's reading is refuted: at one contact the variance depends on the horizontal "
        "position",
        equation(ONE_CONTACT, PRINTED.rhs),
        leading,
        CONE,
    )
    steps.claim(
        "inside the cone a bead passes forces on: they do not change along a diagonal",
        Tuple(
            equation(ForcePlus(i - 1, j - 1), ForcePlus(i, j)),
            equation(ForceMinus(i + 1, j - 1), ForceMinus(i, j)),
        ),
        rewrite(forces()),
        INSIDE.also(j >= 1),
    )
    steps.claim(
        "the mean is that of the ordered packing",
        Tuple(
            equation(Mean(PRESSED), 0), equation(Mean(VerticalPlus(i, j) / f_load), Rational(1, 2))
        ),
        by,
        [INSIDE, LEFT_LEG],
    )
    steps.claim(
        "on a leg the vertical force has a third of the variance, to leading order",
        equation(ONE_CONTACT, PRINTED.rhs / 3),
        leading,
        LEFT_LEG.in_the_limit(DOWN_LEG),
    )
    apex = MEANING[RESPONSE].xreplace({i: k, j: l - 2})
    steps.claim(
        "the variance straight below the load is twice that at the base, as l → ∞",
        equation(apex, times(2, RESPONSE)),
        leading,
        INSIDE.also(Eq(j, 0)).in_the_limit(ALONG_BASE),
    )


DERIVATION = Derivation(
    number=16,
    name="response",
    title="Variance of the response to a point load: proved for a bead, refuted for a contact",
    symbols=(
        (RESPONSE, "variance of p, the vertical force on bead (i, j), over packings"),
        (VerticalPlus(i, j), "vertical component of the force f⁺_ij"),
        (ONE_CONTACT, "its variance"),
        (f_load, "the load on bead (k, l), downwards"),
        (l, "layer of the loaded bead, j that of bead (i, j)"),
        (n, "steps along n⁺ from (k, l) down to (i, j)"),
        (q, "steps along n⁻ from (k, l) down to (i, j)"),
        *usual(sigma, r, phi),
    ),
    assumptions=(
        *FIRST_ORDER,
        "p is the vertical force that bead (i, j) gets from both upper contacts together",
        "(i, j) is inside the cone below the load: n, q ≥ 1",
        "printed form: l → ∞ at fixed j/l and (i − k)/l; exact forms: every site",
    ),
    printed=(PRINTED,),
    domain=CONE,
    show_steps=show_steps,
    step_domain=INSIDE,
    definitions=MEANING,
    deciders=lambda: [asymptotic(*in_radii())],
    exact=lambda: {
        name: ClosedForm(symbol, MEANING[symbol], ALL_BELOW, in_radii)
        for name, symbol in (("bead", RESPONSE), ("contact", ONE_CONTACT))
    },
    remarks=(
        "Erratum: the paper's p is the vertical component of the force at a contact f^±_ij. For "
        "one contact the printed form does not hold: the variance is (3/2) m (σ/r)²/(1−φ²)² with "
        "the layer m = ½(l+j±(k−i)) in which its path branches, so it grows from (3/2) j beside "
        "one leg to (3/2) l beside the other. The printed form holds for both upper contacts of a "
        "bead together, and also for both lower ones, since the bead passes these forces on.",
        "For this p the horizontal position drops out exactly, not only to leading order, from the "
        "third layer above the base on, except straight below the load.",
        "The legs, which the paper leaves out, fluctuate to the same order: in units of "
        "(σ/r)²/(1−φ²)² the vertical force, of mean ½ f_load, has the variance (l + j)/2 there, "
        "and 3(l + j)/2 inside the cone.",
        "“Twice as large near the apex as near the base” is true of the variance; the standard "
        "deviation is √2 times as large.",
    ),
)

if __name__ == "__main__":
    from force_diffusion.derivations.commands.cli import run_alone

    raise SystemExit(run_alone(16))
