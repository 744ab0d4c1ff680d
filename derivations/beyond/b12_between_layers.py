"""Eq. B12: covariance of contact forces in different layers: a diagonal remembers its force."""

from collections.abc import Iterator
from fractions import Fraction
from functools import cache

import sympy
from force_diffusion.derivations import eq11_total_force as eq11
from force_diffusion.derivations import eq12_delta_weights as eq12
from force_diffusion.derivations import eq13_surface_diffusion as eq13
from force_diffusion.derivations import eq14_bulk_diffusion as eq14
from force_diffusion.derivations.beyond.means import decide_in_field
from force_diffusion.derivations.beyond.neighbours import apart
from force_diffusion.derivations.framework.follows import Decide, summed
from force_diffusion.derivations.framework.record import Claim, Derivation, Step, Witness, usual
from force_diffusion.derivations.witnesses import neighbours as witnesses
from force_diffusion.derivations.witnesses.draws import SmallPacking
from force_diffusion.derivations.witnesses.squared_weights import compare
from force_diffusion.symbolic.algebra import explicit
from force_diffusion.symbolic.algebra.affine import Region
from force_diffusion.symbolic.algebra.exact import FIELD, NotExactError, RationalFunction
from force_diffusion.symbolic.as_printed import equation, minus, power, terms, times
from force_diffusion.symbolic.kernel.decisions import (
    Ruling,
    all_of,
    decide_identity,
    from_test,
    undecided,
)
from force_diffusion.symbolic.mechanics.lattice import mirror
from force_diffusion.symbolic.notation import Symbol
from force_diffusion.symbolic.printing.text import text
from force_diffusion.symbolic.symbols import M, i, j, k, l, m, p, phi, q, r, sigma, z
from force_diffusion.symbolic.variances.means import covariance, covariances_by_case
from force_diffusion.symbolic.variances.orders import UNIT
from force_diffusion.symbolic.variances.variance import grows_evenly, leading, order

COVARIANCE = Symbol(
    "layers_covariance",
    r"\frac{\langle\Delta f^{+}_{ij}\,\Delta f^{+}_{i+l-j,\,l}\rangle}{\langle f\rangle^2}",
    "⟨Δf⁺_ij Δf⁺_{i+l−j,l}⟩/⟨f⟩²",
)
CORRELATION = Symbol("layers_correlation", r"\rho_{jl}", "ρ_jl")
z_upper = Symbol("z_upper", "z'", "z′", positive=True)
"""Relative height l/M of the upper contact."""

PRINTED = equation(
    COVARIANCE,
    times(
        1 / (4 * (1 - phi**2) ** 2),
        terms(
            times(
                terms(M, -l),
                terms(
                    times(8, M**2), times(8, M, l), minus(times(12, j**2)), minus(times(4, l**2))
                ),
            ),
            minus(times(6, M, terms(M, j, l))),
            times(6, terms(j**2, times(j, l), l**2)),
            times(2, phi**2, terms(times(9, terms(M, -l)), -4)),
            times(2, phi, terms(times(2, M), -j, -l, -2)),
            minus(times(8, M)),
            times(7, j),
            times(9, l),
            6,
        ),
        power(times(sigma, 1 / r), 2),
    ),
)

FORCE = eq11.PRINTED.rhs - 1
DEEP = Region({j: 2, l: j + 2, M: l + 2})
PLACES = ((7, 2, 4), (8, 3, 6), (8, 2, 5))
"""Packings (M, j, l) for searches."""

WEIGHTS = Symbol("products", r"\sum w\,w'", "Σw w′")
"""Sum over all radii of the products of both weights in Eq. 12, its prefactor left out."""
PRODUCTS = times(
    6,
    terms(
        times(terms(M, -l), sympy.Sum(M - j, (m, 1, j))),
        times(terms(M, -l), sympy.Sum(M - m, (m, j + 1, l))),
        sympy.Sum((M - m) ** 2, (m, l + 1, M)),
    ),
)
HIGHEST = times(terms(M, -l), terms(times(2, M**2), times(2, M, l), minus(times(3, j**2)), -(l**2)))
REST = minus(times(terms(M, -l), terms(times(3, M), minus(times(3, j)), -1)))


def _in_heights(lower: sympy.Expr, upper: sympy.Expr) -> sympy.Expr:
    """The leading order for a surface load."""
    return times(
        M**3,
        terms(1, -upper),
        terms(times(3, terms(1, -(lower**2))), minus(terms(1, -upper) ** 2)),
        UNIT,
    )


BULK = times(
    M**3 / (10 * (1 - z)),
    terms(1, -z_upper),
    terms(
        3, times(6, z_upper), minus(times(15, z**2)), minus(times(6, z_upper**2)),
        times(10, z**3), times(2, z_upper**3),
    ),
    UNIT,
)  # fmt: skip
"""The same for a bulk load, both forces over their own means."""


def _with(force: sympy.Expr, across: sympy.Expr) -> sympy.Expr:
    """A contact of layer l, so many columns to the right of (i, j)."""
    return force.xreplace({i: i + across, j: l})


@cache
def between(places: int) -> RationalFunction:
    """Covariance of f⁺_ij/⟨f⟩ with that of layer l, ``places`` to the right of its diagonal."""
    own = eq11.in_radii(FORCE)
    return covariance(own, _with(own, l - j + 2 * places), DEEP if not places else DEEPER)


DEEPER = Region({j: 4, l: j + 4, M: l + 2})


def to_leading_order(exact: RationalFunction, subject: sympy.Expr) -> Decide:
    """The exact value less the right-hand side is of lower order in M, j and l."""

    def decide(_: int, candidate: sympy.Eq) -> Ruling:
        if candidate.lhs != subject:
            return undecided(f"the left-hand side is not {text(subject)}")
        try:
            side = FIELD.from_sympy(candidate.rhs.xreplace({z: j / M, z_upper: l / M}))
        except NotExactError as reason:
            return undecided(str(reason))
        rest = (exact - side).reduced()
        if not grows_evenly(rest):
            return undecided("the order of what is left is not shown to hold at every height")
        size = order(rest, M, j, l)
        return from_test(size < order(exact, M, j, l), f"what is left is of order M^{size}")

    return decide


FAR = Symbol("far", r"C_{p}", "C_p")
"""Covariance of contacts whose diagonals are p ≥ 3 places apart, away from ``LEFT_OVER``."""

Split = tuple[sympy.Expr, dict[sympy.Symbol, sympy.Expr], dict[sympy.Symbol, int]]
"""Places to the right, indices in terms of others, and the lower bounds of these; l = j + k."""

FAR_PLACES: tuple[Split, ...] = (
    (p, {j: p + q, M: p + q + k + l}, {p: 3, q: 2, k: 2, l: 2}),
    (j + 3 + q, {M: j + k + l}, {j: 2, q: 0, k: 2, l: 2}),
    (-p, {k: p + q, M: j + p + q + l}, {p: 3, q: 2, j: 2, l: 2}),
    (-(k + q), {j: q + 2 + l, M: q + 2 + l + k + p}, {k: 2, q: 2, l: 0, p: 2}),
    (-(j + k + 3 + q), {M: j + k + l}, {j: 2, q: 0, k: 2, l: 2}),
)
"""Where they are uncorrelated, for 2 ≤ j ≤ l − 2 and l ≤ M − 2."""


def _ends(above: sympy.Expr) -> tuple[sympy.Expr, ...]:
    """What is left at p = j − 1, …, j + 2, ``above`` layers of the other contact's path up."""
    return (
        3 * phi * above / 4,
        phi * (3 - 5 * above) / 4,
        phi * (above - 2) / 4,
        phi * (above - 1) / 4,
    )


LEFT_OVER = {
    **dict(zip((j - 1, j, j + 1, j + 2), _ends(M - j - k), strict=True)),
    **dict(zip((1 - j - k, -j - k, -1 - j - k, -2 - j - k), _ends(M - j), strict=True)),
    1 - k: -(phi**2) * (4 * j + 3 - 2 * phi) / 4,
    -k: phi**2 * (4 * j + 1) / 2,
    -1 - k: -(phi**2) * (4 * j - 1 + 2 * phi) / 4,
}
"""Places to the right where two contacts, l = j + k, are correlated after all, in ``UNIT``."""


def _none(lower: sympy.Expr, upper: sympy.Expr, splits: tuple[Split, ...]) -> Ruling:
    """No covariance of two contacts in any case of the splits."""
    count = 0
    for places, at, bounds in splits:
        left, right = lower.xreplace(at), apart(upper, places).xreplace(at)
        for case in covariances_by_case(left, right, bounds, generic=3):
            count += 1
            if not case.value.is_zero():
                return from_test(False, "", f"not {places} places away, {case.at}, {case.lower}")
    return from_test(True, f"no covariance in any of {count} cases, which cover all such contacts")


@cache
def _none_far() -> Ruling:
    own = eq11.in_radii(FORCE)
    return _none(own, own.xreplace({i: i + k, j: j + k}), FAR_PLACES)


def _far(_: int, candidate: sympy.Eq) -> Ruling:
    """Zero at all places but ``LEFT_OVER``."""
    if candidate.lhs != FAR:
        return undecided(f"the left-hand side is not {text(FAR)}")
    return all_of(decide_identity(candidate.rhs, sympy.Integer(0)), _none_far())


def _left_over() -> Ruling:
    """At the other places, away from base and surface: of order M, with a factor φ."""
    own = eq11.in_radii(FORCE)
    higher = own.xreplace({i: i + k, j: j + k})
    deep = Region({j: 6, k: 6, M: j + k + 6})
    return from_test(
        all(
            (
                covariance(own, apart(higher, places), deep) - FIELD.from_sympy(value * UNIT)
            ).is_zero()
            for places, value in LEFT_OVER.items()
        ),
        f"the covariances at {len(LEFT_OVER)} places are linear in M and j, with a factor φ or φ²",
    )


def _products(_: int, candidate: sympy.Eq) -> Ruling:
    """Six times a sum over layers against the weights of Eq. 12, multiplied radius by radius."""
    form = sympy.Sum(times(eq12.BRACES, eq12.ON_DIAGONAL), (m, 1, M))
    found = covariance(form, _with(form, l - j), DEEPER) / FIELD.from_sympy(sigma**2)
    return summed({WEIGHTS: found.to_sympy()})(0, candidate)


def _squared(_: int, candidate: sympy.Eq) -> Ruling:
    """The covariance squared over both variances, all to leading order."""
    below, above = (eq13.PRINTED.rhs.xreplace({z: at}) for at in (z, z_upper))
    known = {CORRELATION: _in_heights(z, z_upper) / sympy.sqrt(below * above)}
    return decide_identity(*(side.xreplace(known) for side in candidate.args))


def steps() -> Iterator[Step]:
    """Products of the weights of Eq. 12; exactly; beside the diagonal; as a correlation."""
    yield Step(
        "By Eq. 12 the forces of two contacts on one diagonal, j < l, are sums of the same Δ on "
        "it, with the weights M − max(j, m) and M − max(l, m). The squares of the radii in one Δ "
        "add up to 6. So the products of both weights are",
        equation(WEIGHTS, PRODUCTS),
        _products,
        ("Eq. 12",),
    )
    yield Step("Added up:", equation(PRODUCTS, terms(HIGHEST, REST)), summed(), ("step 1",))
    yield Step(
        "The first term, with the prefactor of Eq. 12 squared, is the leading order, z = j/M being "
        "the height of the lower contact and z′ = l/M that of the upper one:",
        equation(times(eq12.PREFACTOR**2, sigma**2, HIGHEST), _in_heights(z, z_upper)),
        lambda _, candidate: decide_identity(
            *(side.xreplace({z: j / M, z_upper: l / M}) for side in candidate.args)
        ),
        ("step 2",),
    )
    yield Step(
        "Eq. 11 in the radii, weight by weight, for 2 ≤ j ≤ l − 2 and l ≤ M − 2:",
        PRINTED,
        decide,
        ("Eq. 11",),
    )
    yield Step(
        "Its leading order is that of step 3; for z′ = z it is Eq. 13:",
        equation(COVARIANCE, _in_heights(z, z_upper)),
        to_leading_order(between(0), COVARIANCE),
        ("Eq. B12",),
        relation="∼",
    )
    yield Step(
        "Contacts of layer l whose diagonals are p ≥ 3 places away: to the right, where p is none "
        "of j − 1, …, j + 2; to the left, where it is none of l − 1, …, l + 2, nor of l − j − 1, "
        "…, l − j + 1. At those places a line of one contact's tilt meets the other's path where "
        "that begins or ends.",
        equation(FAR, 0),
        _far,
        ("Eq. 11",),
    )
    yield Step(
        "As a correlation, with Eq. 13 for both variances:",
        equation(
            CORRELATION**2,
            times(
                terms(times(3, terms(1, -(z**2))), minus(terms(1, -z_upper) ** 2)) ** 2,
                1 / (4 * terms(1, -z) ** 2),
                1 / terms(1, times(2, z)),
                1 / terms(1, times(2, z_upper)),
            ),
        ),
        _squared,
        ("Eq. 13", "step 5"),
        positive=(1 - z, 1 + 2 * z_upper),
    )


def decide(_: int, candidate: sympy.Eq) -> Ruling:
    """Compare with the sum of the products of all weights."""
    if candidate.lhs != COVARIANCE:
        return undecided(f"the left-hand side is not {text(COVARIANCE)}")
    return decide_in_field(candidate.rhs, _exact())


@cache
def _exact() -> sympy.Expr:
    return between(0).to_sympy()


def search(candidate: sympy.Eq) -> str | None:
    """Exact packings in which the covariance is another, r = σ = 1."""
    if candidate.lhs != COVARIANCE:
        return None
    values = {**explicit.geometry(*witnesses.DIRECTION, Fraction(1)), sigma: 1}
    for height, lower, upper in PLACES:
        try:
            stated = explicit.number(candidate.rhs, {**values, M: height, j: lower, l: upper})
        except explicit.AmbiguousError:
            return None
        true = witnesses.between_layers(height, lower, upper, 0, witnesses.DIRECTION)
        if stated != true:
            return f"for M = {height}, j = {lower}, l = {upper} it is {stated}, not {true}"
    return None


def _everywhere() -> Ruling:
    """The form of the interior holds in every case of j ≥ 2, l ≥ j + 2, M ≥ l + 2."""
    own = eq11.in_radii(FORCE)
    at = {l: j + p, M: j + p + q}
    left, right = own.xreplace(at), _with(own, l - j).xreplace(at)
    image = {symbol: FIELD.from_sympy(value) for symbol, value in at.items()}
    stated = between(0).substitute(image) / FIELD.from_sympy(sigma**2)
    cases = list(covariances_by_case(left, right, {j: 2, p: 2, q: 2}, generic=3))
    return from_test(
        all((case.value - case.put_in(stated)).is_zero() for case in cases),
        f"{len(cases)} cases, which cover all such contacts, agree",
    )


def _beside() -> Ruling:
    """−2/3 and 1/6 of the diagonal's own, one and two places away on either side."""
    own = leading(between(0), M, j, l)
    shares = {1: sympy.Rational(-2, 3), 2: sympy.Rational(1, 6)}
    return from_test(
        all(
            (leading(between(side * places), M, j, l) - own * FIELD.from_sympy(share)).is_zero()
            for places, share in shares.items()
            for side in (1, -1)
        ),
        "the covariances one and two places away are −2/3 and 1/6 of it to leading order",
    )


CROSSINGS: tuple[Split, ...] = (
    (-p, {j: p + q, M: p + q + k + l}, {p: 4, q: 4, k: 0, l: 1}),
    (p, {k: p + q, M: j + p + q + l}, {p: 4, q: 4, j: 0, l: 1}),
    (k + q, {j: q + p, M: q + p + k + q + l}, {q: 4, p: 4, k: 0, l: 4}),
    (k + q, {q: j + p, M: j + k + j + p + l}, {j: 0, p: 4, k: 0, l: 4}),
)
"""How many layers above (i, j) the diagonals of f⁺ and of f⁻, k layers higher, cross."""


def _other_branch() -> Ruling:
    """f⁺_ij with f⁻ of the layer k higher, whose diagonal crosses it in some layer."""
    own = eq11.in_radii(FORCE)
    other = mirror(own).xreplace({j: j + k, i: i - k})
    return _none(own, other, CROSSINGS)


def _to_the_surface() -> Ruling:
    """From the base to the surface: √3/2, and √5/3 under a bulk load."""
    surface = _in_heights(z, z_upper) ** 2 / (
        eq13.PRINTED.rhs * eq13.PRINTED.rhs.xreplace({z: z_upper})
    )
    bulk = BULK**2 / (eq14.PRINTED.rhs * eq14.PRINTED.rhs.xreplace({z: z_upper}))
    ends = {z: sympy.Integer(0), z_upper: sympy.Integer(1)}
    rulings = []
    for squared, value in ((surface, sympy.Rational(3, 4)), (bulk, sympy.Rational(5, 9))):
        # the factors (1 − z′)² of both cancel in the field
        at_ends = FIELD.from_sympy(squared.xreplace({z_upper: l})).reduced().to_sympy()
        rulings.append(decide_identity(at_ends.xreplace({z: ends[z], l: ends[z_upper]}), value))
    return all_of(*rulings)


def _bulk() -> Ruling:
    """The same for a bulk load, k = l − j layers higher."""
    force = eq11.in_radii(eq14.bulk_force() - 1)
    region = Region({j: 5, k: 5, M: j + k + 5})
    found = covariance(force, force.xreplace({i: i + k, j: j + k}), region)
    exact = found.substitute({k: FIELD.from_sympy(l - j)})
    return to_leading_order(exact, COVARIANCE)(0, equation(COVARIANCE, BULK))


def _mean_of_diagonal() -> Ruling:
    """Twice the integral over 0 < z < z′ < 1, against that of the variance, by powers."""
    lower, upper = sympy.symbols("a b")
    of_pair = sympy.expand((1 - upper) * (3 * (1 - lower**2) - (1 - upper) ** 2))
    up_to = sympy.Poly(of_pair, lower).integrate().as_expr().xreplace({lower: upper})
    whole = 2 * sympy.Poly(up_to, upper).integrate()(1)
    single = sympy.Poly(2 * (1 - z) ** 2 * (1 + 2 * z), z).integrate()(1)
    return from_test(
        whole == sympy.Rational(4, 5) and single == 1,
        "the mean over a diagonal has 4/5 of the variance that a contact of it has on average",
    )


def _witness(packing: SmallPacking) -> Ruling:
    height = 8
    cosine = packing.n[1] ** 2 - packing.n[0] ** 2

    def pairs() -> Iterator[tuple[str, Fraction, Fraction]]:
        for upper in range(4, height - 1):
            for lower in range(2, upper - 1):
                values: explicit.Values = {
                    M: height, j: lower, l: upper, phi: cosine, sigma: 1, r: 1,
                }  # fmt: skip
                true = witnesses.between_layers(height, lower, upper, 0, packing.n)
                yield f"j = {lower}, l = {upper}", explicit.number(PRINTED.rhs, values), true

    return compare(pairs())


DERIVATION = Derivation(
    number="B12",
    name="between_layers",
    title="Covariance of contact forces in different layers",
    symbols=(
        (COVARIANCE, "covariance of f⁺_ij and of f⁺ in layer l on the same diagonal, over ⟨f⟩²"),
        (l, "layer of the upper contact, j that of the lower one"),
        *usual(sigma, r, M, phi),
    ),
    assumptions=(
        "the radii are independent, of zero mean and variance σ²",
        "first order in δr",
        "a surface load",
        "2 ≤ j ≤ l − 2 and l ≤ M − 2",
    ),
    premises=(eq11.DERIVATION, eq12.DERIVATION, eq13.DERIVATION, eq14.DERIVATION),
    printed=(PRINTED,),
    domain=(sympy.Ge(j, 2), sympy.Ge(l, j + 2), sympy.Ge(M, l + 2)),
    steps=steps,
    decide=decide,
    search=search,
    claims=(
        Claim("it holds for all j ≥ 2, l ≥ j + 2, M ≥ l + 2", _everywhere),
        Claim(
            "beside the diagonal, one and two places away, the covariances are −2/3 and 1/6 of it "
            "to leading order, as within a layer",
            _beside,
        ),
        Claim(
            "where the diagonal is p = j − 1, …, j + 2 places to the right, or to the left "
            "l − 1, …, l + 2 or l − j − 1, …, l − j + 1, a covariance of order M is left, for "
            "j, l − j and M − l from 6 on, and none for φ = 0",
            _left_over,
        ),
        Claim(
            "f⁺ and f⁻ are uncorrelated, exactly, where their diagonals cross four layers or more "
            "from both, from the base and from the surface, and, if q layers above both, where q "
            "and j differ by four or more",
            _other_branch,
        ),
        Claim(
            "under a bulk load, over both means, it goes as M³(1−z′)Q (σ/r)²/(1−φ²)², where "
            "10(1−z)Q = 3 + 6z′ − 15z² − 6z′² + 10z³ + 2z′³",
            _bulk,
        ),
        Claim(
            "along a diagonal from the base to the surface a correlation of √3/2 is left under a "
            "surface load, of √5/3 under a bulk load, as M → ∞ and then z′ → 1",
            _to_the_surface,
        ),
        Claim(
            "the mean over all contacts of a diagonal keeps 4/5 of the mean variance, to leading "
            "order",
            _mean_of_diagonal,
        ),
    ),
    witnesses=(Witness("exact packings: products of weights, as fractions", _witness),),
    remarks=(
        "Within a layer fluctuations cancel over neighbours (Eq. B7); along a diagonal they do "
        "not: a force that is large stays so through the whole packing. What a mean over a region "
        "leaves of them depends on its shape.",
    ),
)

if __name__ == "__main__":
    from force_diffusion.derivations.commands.alone import run_alone

    raise SystemExit(run_alone(DERIVATION))
