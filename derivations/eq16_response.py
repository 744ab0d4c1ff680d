"""Eq. 16: variance of the response to a point load, inside of its cone and on it."""

from collections.abc import Iterable, Iterator
from fractions import Fraction
from functools import cache

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
from force_diffusion.derivations.witnesses import squared_weights as witnesses
from force_diffusion.symbolic.algebra.affine import Region
from force_diffusion.symbolic.algebra.exact import FIELD, NotExactError, RationalFunction
from force_diffusion.symbolic.algebra.linear_forms import NO_SITE, LinearForm
from force_diffusion.symbolic.algebra.reading import Reader
from force_diffusion.symbolic.as_printed import equation, minus, power, terms, times
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
from force_diffusion.symbolic.kernel.searches import parts_in_the_limit
from force_diffusion.symbolic.mechanics.lattice import mirror
from force_diffusion.symbolic.mechanics.paths import IN_CONE, STEPS_BELOW
from force_diffusion.symbolic.notation import Symbol
from force_diffusion.symbolic.printing.text import text
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
    n_x,
    n_y,
    p,
    phi,
    q,
    r,
    sigma,
)
from force_diffusion.symbolic.variances.cases import Case, Piece, first_difference, squares_by_case
from force_diffusion.symbolic.variances.orders import UNIT
from force_diffusion.symbolic.variances.variance import (
    grows_evenly,
    leading,
    order,
    without_constant,
)
from sympy import Rational

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

SIZES = (j, p, q)
"""What grows in the limit: l = j + p + q → ∞ at fixed j/l and (i − k)/l inside of the cone."""

# The closed forms, all proved below. The bead (i, j) lies p steps along n⁺ and q steps along n⁻
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
    Piece("j = 0, beside the left leg", {j: 0, q: 1}, 6 * l - 8 - phi + phi**2),
    Piece("j = 0, beside the right leg", {j: 0, p: 1}, 6 * l - 8 - phi + phi**2),
    Piece("j = 0, further inside", {j: 0}, 6 * l - 9 + phi**2),
    Piece("j = 1, l = 3", {j: 1, p: 1, q: 1}, 6 * l + 4 + phi**2 + _BELOW_LOAD),
    Piece("j = 1, l > 3", {j: 1}, 6 * l + 4 + phi**2),
    Piece("j = 2, l = 4", {j: 2, p: 1, q: 1}, 6 * l + Rational(9, 2) + phi**2 + _BELOW_LOAD),
    Piece("j = 2, l > 4", {j: 2}, 6 * l + Rational(9, 2) + phi**2),
    Piece("i = k, j = l − 2 ≥ 3", {p: 1, q: 1}, _INSIDE + _BELOW_LOAD),
    Piece("j ≥ 3, every other bead inside of the cone", {}, _INSIDE),
)
"""Variance of the vertical force that a bead gets from both upper contacts, over f_load²."""

CONTACT = (
    Piece("j = 0, k − i = 2 − l", {j: 0, p: 1}, Rational(7, 2) - _HALF * phi + _HALF * phi**2),
    Piece("inside of the cone", {}, 3 * (l + j + k - i) - 3 + _HALF * phi**2),
)
"""Variance of the vertical component of f⁺_ij inside of the cone, over f_load²."""

_LEG = 2 * l + 2 * j - 2 + 2 * phi + phi**2

LEG = (
    Piece("j = 0, l = 1", {j: 0, p: 1}, _HALF * (1 + phi) ** 2),
    Piece("j = 0, l > 1", {j: 0}, _LEG - phi),
    Piece("j = 1, l = 2", {j: 1, p: 1}, _LEG + Rational(3, 2) - _TOP),
    Piece("j = 1, l > 2", {j: 1}, _LEG + Rational(3, 2)),
    Piece("j = l − 1 ≥ 2", {p: 1}, _LEG - _TOP),
    Piece("2 ≤ j ≤ l − 2, on a leg", {}, _LEG),
)
"""Variance of the vertical component of the contact force on a leg of the cone, over f_load²."""

_LEG_FORCE = 2 * (l - 1) + 2 * phi**2 * j + Rational(5, 2) * phi**2 + _HALF * phi**4

LEG_FORCE = (
    Piece("j = 0, l = 1", {j: 0, p: 1}, _HALF * (1 - 2 * phi + 6 * phi**2 - 2 * phi**3 + phi**4)),
    Piece("j = 0, l > 1", {j: 0}, _LEG_FORCE - _HALF * phi * (1 + phi**2)),
    Piece("j = 1, l = 2", {j: 1, p: 1}, _LEG_FORCE + Rational(3, 2) * phi - phi * _TOP),
    Piece("j = 1, l > 2", {j: 1}, _LEG_FORCE + Rational(3, 2) * phi),
    Piece("j = l − 1 ≥ 2", {p: 1}, _LEG_FORCE - phi * _TOP),
    Piece("2 ≤ j ≤ l − 2, on a leg", {}, _LEG_FORCE),
)
"""Variance of the magnitude of the contact force on a leg, over its mean squared."""

INSIDE = {j: 0, p: 1, q: 1}
BELOW = {j: 0, p: 1}
ON_LEFT_LEG = {symbol: value.xreplace({q: sympy.Integer(0)}) for symbol, value in IN_CONE.items()}

UPPER_RIGHT = eq10.branched_plus(i, j, p)
UPPER_LEFT = eq10.PRINTED.rhs.xreplace({n: q})
"""The forces f⁺_ij and f⁻_ij on a bead inside of the cone, over f_load/2n_y, to first order.

Each has one path with one branch from the loaded bead: q steps along n⁻ and p along n⁺, or the
other way round. The branch is of first order; what enters it counts at order 0, f_load/2n_y.
"""

BEAD_RESPONSE = (UPPER_RIGHT + UPPER_LEFT) / 2
"""p/f_load: the vertical component of both, n_y (f⁺ + f⁻) to first order."""

LEG_CONTACT = eq09.first_order_product(eq07.split_plus(k, l), eq09.PRINTED.rhs)
"""f⁺_ij over f_load/2n_y on the left leg: the split of the load, carried down a straight path."""

LEG_RESPONSE = (LEG_CONTACT + Dot(e_y, DeltaNPlus(i, j)) / n_y) / 2
"""Its vertical component over f_load, the contact's own direction being tilted."""

LEG_TILTS = terms(Dot(n_minus, DeltaNPlus(i, j)), minus(Dot(n_plus, DeltaNMinus(k + 1, l - 1))))


@cache
def _bead_form() -> LinearForm:
    return Reader(Region(INSIDE)).scalar(eq11.in_radii(BEAD_RESPONSE))


@cache
def _leg_form() -> LinearForm:
    return Reader(Region(BELOW)).scalar(eq11.in_radii(LEG_RESPONSE).xreplace(ON_LEFT_LEG))


@cache
def bead_cases() -> tuple[Case, ...]:
    """Σ weight² of p/f_load for every bead inside of the cone."""
    return tuple(squares_by_case(without_constant(_bead_form()), INSIDE, generic=3))


@cache
def contact_cases() -> tuple[Case, ...]:
    """The same of one contact's vertical force."""
    form = Reader(Region(BELOW)).scalar(eq11.in_radii(UPPER_RIGHT / 2))
    return tuple(_by_case(form))


@cache
def leg_cases() -> tuple[Case, ...]:
    """The same of the vertical force on the left leg."""
    return tuple(_by_case(_leg_form()))


@cache
def leg_force_cases() -> tuple[Case, ...]:
    """The same of the magnitude of that force."""
    form = Reader(Region(BELOW)).scalar(eq11.in_radii(LEG_CONTACT).xreplace(ON_LEFT_LEG))
    return tuple(_by_case(form))


def interior() -> RationalFunction:
    """Exact variance of p/f_load in the cone's interior, in j, p and q."""
    (deep,) = (case.value for case in bead_cases() if not case.at)
    return deep * FIELD.from_sympy(sigma**2)


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
        "bead": case(RESPONSE, BEAD, UNIT / 4, in_cone),
        "contact": case(ONE_CONTACT, CONTACT, UNIT / 4, in_cone),
        "leg": case(ON_LEG, LEG, UNIT / 4, on_leg),
        "leg-force": case(LEG_MAGNITUDE, LEG_FORCE, UNIT, on_leg),
    }


def _numbers(at: dict[sympy.Symbol, int]) -> dict[sympy.Symbol, sympy.Integer]:
    return {symbol: sympy.Integer(value) for symbol, value in at.items()}


def covariance(piece: Piece) -> RationalFunction:
    """Twice the covariance of a bead's two contacts, for one piece of ``BEAD``.

    It is what the variances of the contacts leave of the bead's.
    """

    def put_in(other: Piece, coordinates: dict[sympy.Symbol, sympy.Expr]) -> RationalFunction:
        value = FIELD.from_sympy(other.expression.xreplace(IN_CONE).xreplace(coordinates))
        return value.substitute({s: FIELD.constant(at) for s, at in piece.at.items()})

    def contact(at: dict[sympy.Symbol, int]) -> Piece:
        return next(found for found in CONTACT if found.at.items() <= at.items())

    swapped = {p: q, q: p}  # f⁻ is the mirror image of f⁺
    mirrored = {swapped.get(symbol, symbol): value for symbol, value in piece.at.items()}
    left, right = put_in(contact(mirrored), swapped), put_in(contact(piece.at), {})
    return put_in(piece, {}) - left - right


DOWN = {i: k - p + q, j: l - p - q}
"""Where p steps along n⁺ and q along n⁻ lead from (k, l), each one layer down."""


def _value(quantity: sympy.Expr, cases: Iterable[Case], unit: sympy.Expr) -> Decide:
    """The closed form against the sum of squared weights where no two sites coincide."""
    (deep,) = (case.value for case in cases if not case.at)
    coordinates = IN_CONE if quantity in (RESPONSE, ONE_CONTACT) else ON_LEFT_LEG
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
            equation(ForcePlus(i, j) / source, UPPER_RIGHT),
            equation(ForceMinus(i, j) / source, UPPER_LEFT),
        ),
        states(*paths, region=Region(INSIDE)),
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
        equation(ONE_CONTACT, CONTACT[-1].expression * UNIT / 4),
        _value(ONE_CONTACT, contact_cases(), sigma**2),
        ("Eq. 11", "step 2"),
    )
    yield Step(
        "It depends on the horizontal position: what the paper says of the force at one contact "
        "is refuted. What does not is the vertical force p that the "
        "bead gets from both contacts together: their second differences lie on two diagonals, and "
        "where these cross, the common weights add up to zero. Exact, for j ≥ 3:",
        equation(RESPONSE, BEAD[-1].expression * UNIT / 4),
        _value(RESPONSE, bead_cases(), sigma**2),
        ("Eq. 11", "step 2"),
    )
    yield Step("To leading order:", PRINTED, decide, ("step 5",))
    yield Step(
        "On the left leg of the cone f⁺_ij is the split of the load (Eq. 7), carried down by "
        "Eq. 9. With the contact's own tilt its vertical component over f_load is",
        equation(
            LEG_RESPONSE,
            terms(
                sympy.Rational(1, 2),
                times(sympy.Rational(1, 2), 1 / (1 - phi**2), LEG_TILTS),
            ),
        ),
        states(equation(LEG_RESPONSE, LEG_RESPONSE)),
        ("Eq. 7", "Eq. 9"),
    )
    yield Step(
        "The two tilts are independent but for a few radii. Exact, for 2 ≤ j ≤ l − 2:",
        equation(ON_LEG, LEG[-1].expression * UNIT / 4),
        _value(ON_LEG, leg_cases(), sigma**2),
        ("Eq. 11", "step 7"),
    )
    yield Step(
        "The magnitude of that force, over its mean squared:",
        equation(LEG_MAGNITUDE, LEG_FORCE[-1].expression * UNIT),
        _value(LEG_MAGNITUDE, leg_force_cases(), sigma**2),
        ("Eq. 11", "step 7"),
    )


def decide(_: int, candidate: sympy.Eq) -> Ruling:
    """The exact variance of p less the candidate is of order l⁰ at most."""
    if candidate.lhs != RESPONSE:
        return undecided("the left-hand side is not σ²(p)/f_load²")
    return compare(interior(), candidate.rhs)


INSIDE_PLACES = tuple(
    {j: Fraction(a), p: Fraction(b), q: Fraction(c)}
    for a, b, c in ((1, 1, 1), (2, 1, 1), (3, 1, 2), (1, 2, 3), (1, 100, 1), (1, 1, 100))
)


def search(candidate: sympy.Eq) -> str | None:
    """Sites inside of a growing cone where the candidate and the exact variance part."""
    if candidate.lhs != RESPONSE:
        return None
    exact = interior().to_sympy()
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
    size = order(difference, *SIZES)
    shown = text(in_layers(leading(difference, *SIZES)).to_sympy())
    if size < order(exact, *SIZES):
        if not grows_evenly(difference, *SIZES):
            return undecided(f"the order of {shown} is not shown to hold at every site and φ")
        return proved(f"exact − printed is of order l^{size}: {shown}")
    return refuted(f"exact − candidate is of the leading order l^{size} itself: {shown}")


def _is_strange(value: RationalFunction, symbol: sympy.Expr) -> bool:
    """Whether it holds a symbol other than layers, steps and what the packing is made of."""
    return symbol not in (*SIZES, phi, n_x, n_y, r, sigma) and value.holds(symbol)


def in_layers(value: RationalFunction) -> RationalFunction:
    """A function of j, p and q in terms of l, j and q."""
    layers = FIELD.generator(l) - FIELD.generator(j) - FIELD.generator(q)
    return value.substitute({p: layers})


def _stated(pieces: tuple[Piece, ...], cases: Iterable[Case], unit: sympy.Expr) -> Ruling:
    """Closed forms against exact sums of squared weights, case by case."""
    found_in = tuple(cases)
    coordinates = IN_CONE if pieces in (BEAD, CONTACT) else ON_LEFT_LEG
    wrong = first_difference(pieces, found_in, FIELD.from_sympy(unit / sigma**2), coordinates)
    return from_test(
        wrong is None, f"{len(found_in)} cases, which cover all sites, agree", f"not so: {wrong}"
    )


def _by_case(form: LinearForm) -> Iterator[Case]:
    return squares_by_case(without_constant(form), BELOW, generic=2)


def _bead() -> Ruling:
    return _stated(BEAD, bead_cases(), UNIT / 4)


def _independent_of_position() -> Ruling:
    """For j ≥ 3 no case but p = q = 1 depends on more than l + j."""
    deep = [case for case in bead_cases() if case.lower.get(j) == 3]
    rest = [case for case in deep if (case.at.get(p), case.at.get(q)) != (1, 1)]
    same = all(
        (case.value - case.put_in(interior() / FIELD.from_sympy(sigma**2))).is_zero()
        for case in rest
    )
    return from_test(
        same and len(rest) == len(deep) - 1 and not in_layers(interior()).holds(q),
        f"for all p, q ≥ 1 but p = q = 1 it is {text(BEAD[-1].expression)} in units of "
        "(σ/r)²/4(1−φ²)²",
    )


def _one_contact() -> Ruling:
    exact = _stated(CONTACT, contact_cases(), UNIT / 4)
    turn = (l + j + k - i) / 2
    value = FIELD.from_sympy((CONTACT[-1].expression * UNIT / 4).xreplace(IN_CONE))
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
    *_, below_load, deep = BEAD
    stated = FIELD.from_sympy((1 + phi) ** 2 / 2)
    return from_test(
        covariance(deep).is_zero()
        and (covariance(below_load) - stated).is_zero()
        and all(order(covariance(piece), *SIZES) <= 0 for piece in BEAD),
        "twice the covariance is ½(1+φ)² straight below the load for j ≥ 3, in units of "
        "(σ/r)²/4(1−φ²)²; no case of it grows with j or l",
    )


def _leg() -> Ruling:
    third = 3 * LEG[-1].expression - BEAD[-1].expression
    return all_of(
        _stated(LEG, leg_cases(), UNIT / 4),
        _stated(LEG_FORCE, leg_force_cases(), UNIT),
        decide_identity(third, 6 * phi + 2 * phi**2),
    )


def _mean() -> Ruling:
    """No constant part inside; ½ f_load on a leg, as in the ordered packing."""
    half = FIELD.constant(sympy.Rational(1, 2))
    on_leg = _leg_form().sites.get(NO_SITE, FIELD.zero)
    return from_test(
        NO_SITE not in _bead_form().sites and (on_leg - half).is_zero(),
        "linear in radii of zero mean inside of the cone; ½ and such a part on a leg",
    )


def _passed_on() -> Ruling:
    """The lower contacts of a bead carry the forces of its upper ones, first order in each."""
    below = {i: i - 1, j: j - 1, p: p + 1}
    return all_of(
        decide_linear(UPPER_RIGHT.xreplace(below), UPPER_RIGHT, Region({j: 1, p: 1, q: 1})),
        decide_linear(mirror(UPPER_RIGHT), UPPER_LEFT.xreplace({q: p}), Region({j: 0, p: 1})),
    )


def _apex_and_base() -> Ruling:
    """Directly below the load against the base, at every l ≥ 5."""
    apex = BEAD[-2].expression.xreplace({j: l - 2})
    base = BEAD[3].expression
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
        (p, "steps along n⁺ from (k, l) down to (i, j); q along n⁻ (p is no force there)"),
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
