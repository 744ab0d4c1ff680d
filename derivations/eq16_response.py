"""Eq. 16: variance of the response to a point load, inside of its cone and on it."""

from collections.abc import Iterable, Iterator
from fractions import Fraction

import sympy
from force_diffusion.derivations import eq07_load_split as eq07
from force_diffusion.derivations import eq09_straight_path as eq09
from force_diffusion.derivations import eq10_branched_path as eq10
from force_diffusion.derivations import eq11_total_force as eq11
from force_diffusion.derivations.framework.follows import Decide, identity, states
from force_diffusion.derivations.framework.record import (
    Claim,
    Derivation,
    ExactCase,
    Missed,
    Step,
    Witness,
    usual,
)
from force_diffusion.derivations.parts import cone
from force_diffusion.derivations.witnesses import squared_weights as witnesses
from force_diffusion.symbolic.algebra.affine import Region
from force_diffusion.symbolic.algebra.exact import FIELD, NotExactError, RationalFunction
from force_diffusion.symbolic.algebra.linear_forms import NO_SITE
from force_diffusion.symbolic.as_printed import equation, power, terms, times
from force_diffusion.symbolic.kernel.decisions import (
    Ruling,
    Verdict,
    all_of,
    decide_identity,
    decide_linear,
    from_test,
    proved,
    refuted,
    undecided,
)
from force_diffusion.symbolic.mechanics.lattice import mirror
from force_diffusion.symbolic.mechanics.paths import IN_CONE, STEPS_BELOW
from force_diffusion.symbolic.notation import Symbol
from force_diffusion.symbolic.printing.text import text
from force_diffusion.symbolic.search.limits import parts_in_the_limit
from force_diffusion.symbolic.symbols import (
    ForceMinus,
    ForcePlus,
    f_load,
    i,
    j,
    k,
    l,
    n,
    n_x,
    n_y,
    p,
    phi,
    q,
    r,
    sigma,
)
from force_diffusion.symbolic.variances.cases import Case, Piece, first_difference
from force_diffusion.symbolic.variances.orders import UNIT
from force_diffusion.symbolic.variances.variance import (
    grows_evenly,
    leading,
    order,
)

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
    times(3 / (2 * (1 - phi**2) ** 2), terms(l, j), power(times(sigma, 1 / r), 2)),
)


def at_finite_size() -> dict[str, ExactCase]:
    """The exact forms, for a bead, one contact, and a leg of the cone."""

    def case(
        quantity: sympy.Expr,
        pieces: tuple[Piece, ...],
        unit: sympy.Expr,
        steps_below: dict[sympy.Symbol, sympy.Expr],
    ) -> ExactCase:
        *edges, main = (
            Missed(
                piece.where,
                tuple(sympy.Eq(s.xreplace(steps_below), value) for s, value in piece.at.items()),
                piece.expression.xreplace(_numbers(piece.at)) * unit,
            )
            for piece in pieces
        )
        inside = tuple(sympy.Ge(steps, 1) for steps in steps_below.values())
        return ExactCase(quantity, main.where, main.expression, inside, tuple(edges))

    in_cone, on_leg = STEPS_BELOW, {p: l - j}
    return {
        "bead": case(RESPONSE, cone.BEAD, UNIT / 4, in_cone),
        "contact": case(ONE_CONTACT, cone.CONTACT, UNIT / 4, in_cone),
        "leg": case(ON_LEG, cone.LEG, UNIT / 4, on_leg),
        "leg-force": case(LEG_MAGNITUDE, cone.LEG_FORCE, UNIT, on_leg),
    }


def _numbers(at: dict[sympy.Symbol, int]) -> dict[sympy.Symbol, sympy.Integer]:
    return {symbol: sympy.Integer(value) for symbol, value in at.items()}


DOWN = {i: k - p + q, j: l - p - q}
"""Where p steps along n⁺ and q along n⁻ lead from (k, l), each one layer down."""


def _value(quantity: sympy.Expr, cases: Iterable[Case], unit: sympy.Expr) -> Decide:
    """The closed form against the sum of squared weights where no two sites coincide."""
    (deep,) = (case.value for case in cases if not case.at)
    coordinates = IN_CONE if quantity in (RESPONSE, ONE_CONTACT) else cone.ON_LEFT_LEG
    known = {quantity: deep.to_sympy() * unit, **coordinates}
    return lambda _, candidate: decide_identity(*(side.xreplace(known) for side in candidate.args))


def steps() -> Iterator[Step]:
    """One path to each contact; squared weights; the sum of both upper contacts of a bead."""
    source = f_load / (2 * n_y)
    yield Step(
        "Let (i, j) lie p steps along n⁺ and q steps along n⁻ below the loaded bead (k, l): inside "
        "of the cone for p, q ≥ 1. The loaded bead is",
        sympy.Tuple(equation(k, IN_CONE[k]), equation(l, IN_CONE[l])),
        identity(DOWN),
    )
    left, right = mirror(eq10.PRINTED), eq10.PRINTED
    paths = (
        equation(ForcePlus(i, j) / source, left.rhs.xreplace({n: p})),
        equation(ForceMinus(i, j) / source, right.rhs.xreplace({n: q})),
    )
    yield Step(
        "One path with one branch leads to f⁺_ij, along n⁻ and then n⁺, and one to f⁻_ij, along n⁺ "
        "and then n⁻ (Eq. 10). The branch is of first order, and f_load/2n_y enters it (Eq. 7).",
        sympy.Tuple(
            equation(ForcePlus(i, j) / source, cone.UPPER_RIGHT),
            equation(ForceMinus(i, j) / source, cone.UPPER_LEFT),
        ),
        states(*paths, region=Region(cone.INSIDE)),
        ("Eq. 7", "Eq. 10"),
    )
    yield Step(
        "They turn in the layers j + p and j + q; the two add up to l + j wherever the bead is.",
        equation(terms(j + p, j + q), l + j),
        identity({l: IN_CONE[l]}),
        ("step 1",),
    )
    yield Step(
        "In the radii (Eqs. 4 and 5) f⁺_ij is a sum of second differences up to the layer below "
        "its turn, as in Eq. 12, and four radii. Exact variance of its vertical component:",
        equation(ONE_CONTACT, cone.CONTACT[-1].expression * UNIT / 4),
        _value(ONE_CONTACT, cone.contact_cases(), sigma**2),
        ("Eq. 11", "step 2"),
    )
    yield Step(
        "It depends on the horizontal position: what the paper says of the force at one contact "
        "is refuted. What does not is the vertical force p that the "
        "bead gets from both contacts together: their second differences lie on two diagonals, and "
        "where these cross, the common weights add up to zero. Exact, for j ≥ 3:",
        equation(RESPONSE, cone.BEAD[-1].expression * UNIT / 4),
        _value(RESPONSE, cone.bead_cases(), sigma**2),
        ("Eq. 11", "step 2"),
    )
    yield Step("To leading order:", PRINTED, decide, ("step 5",))
    yield Step(
        "On the left leg of the cone f⁺_ij is the split of the load (Eq. 7), carried down by "
        "Eq. 9. With the contact's own tilt its vertical component over f_load is",
        equation(
            cone.LEG_RESPONSE,
            terms(
                sympy.Rational(1, 2),
                times(sympy.Rational(1, 2), 1 / (1 - phi**2), cone.LEG_TILTS),
            ),
        ),
        states(equation(cone.LEG_RESPONSE, cone.LEG_RESPONSE)),
        ("Eq. 7", "Eq. 9"),
    )
    yield Step(
        "The two tilts are independent but for a few radii. Exact, for 2 ≤ j ≤ l − 2:",
        equation(ON_LEG, cone.LEG[-1].expression * UNIT / 4),
        _value(ON_LEG, cone.leg_cases(), sigma**2),
        ("Eq. 11", "step 7"),
    )
    yield Step(
        "The magnitude of that force, over its mean squared:",
        equation(LEG_MAGNITUDE, cone.LEG_FORCE[-1].expression * UNIT),
        _value(LEG_MAGNITUDE, cone.leg_force_cases(), sigma**2),
        ("Eq. 11", "step 7"),
    )


def decide(_: int, candidate: sympy.Eq) -> Ruling:
    """The exact variance of p less the candidate is of order l⁰ at most."""
    if candidate.lhs != RESPONSE:
        return undecided("the left-hand side is not σ²(p)/f_load²")
    return compare(cone.interior(), candidate.rhs)


INSIDE_PLACES = tuple(
    {j: Fraction(a), p: Fraction(b), q: Fraction(c)}
    for a, b, c in ((1, 1, 1), (2, 1, 1), (3, 1, 2), (1, 2, 3), (1, 100, 1), (1, 1, 100))
)


def search(candidate: sympy.Eq) -> str | None:
    """Sites inside of a growing cone where the candidate and the exact variance part."""
    if candidate.lhs != RESPONSE:
        return None
    exact = cone.interior().to_sympy()
    return parts_in_the_limit(exact, candidate.rhs.xreplace(IN_CONE), INSIDE_PLACES)


def compare(exact: RationalFunction, candidate: sympy.Expr) -> Ruling:
    """Rule on a candidate in l, j, k − i: exact − candidate must be of lower order than exact."""
    try:
        difference = (exact - FIELD.from_sympy(candidate.xreplace(IN_CONE))).reduced()
    except NotExactError as reason:
        return undecided(str(reason))
    names = [text(symbol) for symbol in FIELD.generators if _is_strange(difference, symbol)]
    if names:
        return refuted(f"exact − candidate depends on {', '.join(names)}")
    if difference.is_zero():
        return proved("equal at every order")
    size = order(difference, *cone.SIZES)
    shown = text(in_layers(leading(difference, *cone.SIZES)).to_sympy())
    if size < order(exact, *cone.SIZES):
        if not grows_evenly(difference, *cone.SIZES):
            return undecided(f"the order of {shown} is not shown to hold at every site and φ")
        return proved(f"exact − printed is of order l^{size}: {shown}")
    return refuted(f"exact − candidate is of the leading order l^{size} itself: {shown}")


def _is_strange(value: RationalFunction, symbol: sympy.Expr) -> bool:
    """Whether it holds a symbol other than layers, steps and what the packing is made of."""
    return symbol not in (*cone.SIZES, phi, n_x, n_y, r, sigma) and value.holds(symbol)


def in_layers(value: RationalFunction) -> RationalFunction:
    """A function of j, p and q in terms of l, j and q."""
    layers = FIELD.generator(l) - FIELD.generator(j) - FIELD.generator(q)
    return value.substitute({p: layers})


def _stated(pieces: tuple[Piece, ...], cases: Iterable[Case], unit: sympy.Expr) -> Ruling:
    """Closed forms against exact sums of squared weights, case by case."""
    found_in = tuple(cases)
    coordinates = IN_CONE if pieces in (cone.BEAD, cone.CONTACT) else cone.ON_LEFT_LEG
    wrong = first_difference(pieces, found_in, FIELD.from_sympy(unit / sigma**2), coordinates)
    return from_test(
        wrong is None, f"{len(found_in)} cases, which cover all sites, agree", f"not so: {wrong}"
    )


def _bead() -> Ruling:
    return _stated(cone.BEAD, cone.bead_cases(), UNIT / 4)


def _independent_of_position() -> Ruling:
    """For j ≥ 3 no case but p = q = 1 depends on more than l + j."""
    deep = [case for case in cone.bead_cases() if case.lower.get(j) == 3]
    rest = [case for case in deep if (case.at.get(p), case.at.get(q)) != (1, 1)]
    same = all(
        (case.value - case.put_in(cone.interior() / FIELD.from_sympy(sigma**2))).is_zero()
        for case in rest
    )
    return from_test(
        same and len(rest) == len(deep) - 1 and not in_layers(cone.interior()).holds(q),
        f"for all p, q ≥ 1 but p = q = 1 it is {text(cone.BEAD[-1].expression)} in units of "
        "(σ/r)²/4(1−φ²)²",
    )


def _one_contact() -> Ruling:
    exact = _stated(cone.CONTACT, cone.contact_cases(), UNIT / 4)
    turn = (l + j + k - i) / 2
    value = FIELD.from_sympy((cone.CONTACT[-1].expression * UNIT / 4).xreplace(IN_CONE))
    return all_of(
        exact,
        decide_identity(turn.xreplace(IN_CONE), j + p),
        compare(value, 3 * turn * UNIT / 2),
        from_test(
            compare(value, PRINTED.rhs).verdict is Verdict.REFUTED,
            "the printed form is refuted for one contact: its variance is 3s/2, s = ½(l+j+k−i) the "
            "layer where it turns, which is half of the printed one for i = k",
        ),
    )


def _common_weights() -> Ruling:
    *_, below_load, deep = cone.BEAD
    stated = FIELD.from_sympy((1 + phi) ** 2 / 2)
    return from_test(
        cone.covariance(deep).is_zero()
        and (cone.covariance(below_load) - stated).is_zero()
        and all(order(cone.covariance(piece), *cone.SIZES) <= 0 for piece in cone.BEAD),
        "twice the covariance is ½(1+φ)² straight below the load for j ≥ 3, in units of "
        "(σ/r)²/4(1−φ²)²; no case of it grows with j or l",
    )


def _leg() -> Ruling:
    third = 3 * cone.LEG[-1].expression - cone.BEAD[-1].expression
    return all_of(
        _stated(cone.LEG, cone.leg_cases(), UNIT / 4),
        _stated(cone.LEG_FORCE, cone.leg_force_cases(), UNIT),
        decide_identity(third, 6 * phi + 2 * phi**2),
    )


def _mean() -> Ruling:
    """No constant part inside; ½ f_load on a leg, as in the ordered packing."""
    half = FIELD.constant(sympy.Rational(1, 2))
    on_leg = cone.leg_form().sites.get(NO_SITE, FIELD.zero)
    return from_test(
        NO_SITE not in cone.bead_form().sites and (on_leg - half).is_zero(),
        "linear in radii of zero mean inside of the cone; ½ and such a part on a leg",
    )


def _passed_on() -> Ruling:
    """The lower contacts of a bead carry the forces of its upper ones, first order in each."""
    below = {i: i - 1, j: j - 1, p: p + 1}
    return all_of(
        decide_linear(
            cone.UPPER_RIGHT.xreplace(below), cone.UPPER_RIGHT, Region({j: 1, p: 1, q: 1})
        ),
        decide_linear(
            mirror(cone.UPPER_RIGHT), cone.UPPER_LEFT.xreplace({q: p}), Region({j: 0, p: 1})
        ),
    )


def _apex_and_base() -> Ruling:
    """Directly below the load against the base, at every l ≥ 5."""
    apex = cone.BEAD[-2].expression.xreplace({j: l - 2})
    base = cone.BEAD[3].expression
    excess = (1 + 2 * phi - phi**2) / (2 * (6 * l - 9 + phi**2))
    limit = PRINTED.rhs.xreplace({j: l}) / PRINTED.rhs.xreplace({j: sympy.Integer(0)})
    return all_of(
        decide_identity(apex / base, 2 + excess),
        from_test(order(FIELD.from_sympy(excess), l) < 0, "what exceeds 2 vanishes as l → ∞"),
        decide_identity(limit, sympy.Integer(2)),
    )


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
        "the radii are independent, of zero mean and variance σ²",
        "first order in δr",
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
    decide=decide,
    search=search,
    claims=(
        Claim("the exact variance of p at every bead inside of the cone", _bead),
        Claim(
            "for j ≥ 3 it does not depend on the horizontal position, exactly, but for the bead "
            "straight below the load",
            _independent_of_position,
        ),
        Claim(
            "the paper's reading is refuted: one contact alone depends on the horizontal position",
            _one_contact,
        ),
        Claim(
            "the covariance of a bead's two contacts is zero for j ≥ 3, but for the bead straight "
            "below the load, and of order l⁰ everywhere",
            _common_weights,
        ),
        Claim("a bead passes on what it gets: forces do not change along a diagonal", _passed_on),
        Claim("the mean is that of the ordered packing", _mean),
        Claim("no force of first order outside of the cone", eq10.balance_everywhere),
        Claim("on a leg the vertical force has a third of the variance, to leading order", _leg),
        Claim(
            "the variance straight below the load is twice that at the base, as l → ∞",
            _apex_and_base,
        ),
    ),
    witnesses=(
        Witness(
            "exact variances equal sums of squared weights of an exact packing, every contact",
            lambda packing: witnesses.responses(packing, packing.height),
        ),
    ),
    remarks=(
        "The paper's p is the vertical component of the force at a contact f^±_ij. For one contact "
        "the printed form does not hold: its variance is (3/2) s (σ/r)²/(1−φ²)² with the layer "
        "s = ½(l + j ± (k − i)) in which its path turns, so it grows from (3/2) j beside one leg "
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
