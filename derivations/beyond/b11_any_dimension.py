"""Eq. B11: variance of the contact forces in any dimension, to leading order."""

from collections.abc import Callable, Iterator
from fractions import Fraction
from functools import cache

import mpmath
import sympy
from force_diffusion.derivations import eq11_total_force as eq11
from force_diffusion.derivations import eq13_surface_diffusion as eq13
from force_diffusion.derivations.beyond import b4_settling as b4
from force_diffusion.derivations.framework.follows import Decide, identity
from force_diffusion.derivations.framework.record import (
    Claim,
    Derivation,
    Search,
    Step,
    Witness,
    usual,
)
from force_diffusion.derivations.witnesses import dimensions as witnesses
from force_diffusion.derivations.witnesses.draws import SmallPacking
from force_diffusion.derivations.witnesses.squared_weights import compare
from force_diffusion.numeric.mechanics import any_dimension
from force_diffusion.symbolic.algebra import affine, explicit
from force_diffusion.symbolic.algebra.affine import Region
from force_diffusion.symbolic.algebra.exact import FIELD, Domain, NotExactError, RationalFunction
from force_diffusion.symbolic.algebra.linear_forms import LinearForm
from force_diffusion.symbolic.algebra.reading import Reader
from force_diffusion.symbolic.algebra.signs import never_zero
from force_diffusion.symbolic.as_printed import equation, power, terms, times
from force_diffusion.symbolic.kernel.decisions import (
    Ruling,
    Verdict,
    all_of,
    decide_identity,
    from_test,
    proved,
    refuted,
    undecided,
)
from force_diffusion.symbolic.notation import Symbol
from force_diffusion.symbolic.search.limits import LAYERS, parts_in_the_limit
from force_diffusion.symbolic.symbols import (
    DeltaNMinus,
    Dot,
    M,
    d,
    i,
    j,
    kappa,
    m,
    n,
    n_plus,
    phi,
    r,
    sigma,
    z,
)
from force_diffusion.symbolic.variances.certified_sums import certified_sum
from force_diffusion.symbolic.variances.variance import order
from force_diffusion.symbolic.variances.weights import take_apart

PRINTED = equation(
    eq13.RELATIVE_VARIANCE,
    times(
        sympy.Rational(2, 3) * kappa**2 * M**3,
        terms(d, -1),
        terms(times(2, d), -1),
        terms(1, -z) ** 2,
        terms(times(2, z), 1),
        power(times(sigma, 1 / r), 2),
    ),
)

KAPPA: sympy.Expr = (1 + (d - 2) * phi) / ((1 - phi) * (1 + (d - 1) * phi))
"""b^a·b^a of the reciprocal vectors of d base vectors with the mutual dot product φ."""
CROSSED = -phi / ((1 - phi) * (1 + (d - 1) * phi))
"""b^a·b^c of two of them."""

DEEP = Region({j: 4, M: j + 4})

LINES = -Dot(n_plus, DeltaNMinus(i + M - j + 1, M - 1)) - sympy.Sum(
    Dot(n_plus, DeltaNMinus(i + n + 1, j + n - 1) - DeltaNMinus(i + n, j + n)),
    (n, 1, M - j - 1),
)
"""X: what one other direction c puts on lines along the contact, over κ; Eq. 11 without ν."""


@cache
def _form(lines: sympy.Expr) -> LinearForm:
    return Reader(DEEP).scalar(eq11.in_radii(lines))


@cache
def one_direction(lines: sympy.Expr = LINES) -> RationalFunction:
    """Variance of X in the plane of the contact and one other direction."""
    return take_apart(_form(lines), DEEP).sum_of_squares() * FIELD.from_sympy(sigma**2)


@cache
def two_directions(lines: sympy.Expr = LINES) -> RationalFunction:
    """Covariance of X for two other directions, which share the line through the contact alone."""
    own = affine.from_sympy(i - j)
    form = _form(lines)
    shared = LinearForm(
        {
            site: weight
            for site, weight in form.sites.items()
            if affine.add(site.i, site.j, -1) == own
        },
        {ray: weight for ray, weight in form.rays.items() if ray.slope == 1 and ray.line == own},
    )
    return take_apart(shared, DEEP).sum_of_squares() * FIELD.from_sympy(sigma**2)


@cache
def along_lines(lines: sympy.Expr = LINES) -> sympy.Expr:
    """Variance of the sum over the d − 1 other directions, exact for j ≥ 4, M ≥ j + 4."""
    own, shared = one_direction(lines).to_sympy(), two_directions(lines).to_sympy()
    return kappa**2 * ((d - 1) * own + (d - 1) * (d - 2) * shared)


@cache
def the_rest() -> tuple[RationalFunction, RationalFunction]:
    """Variances that bound what is left, in M and j, without factors of d and φ.

    The tilt of the contact towards each other direction; and a sum over the contact's path of line
    sums along another direction, which lie on different lines, up to the layer above the surface.
    """
    area = certified_sum(4 * (j + m + 1) - 2, m, sympy.Integer(1), M - j) * sigma**2
    return b4.tilt_variance()[0], FIELD.from_sympy(area)


def steps() -> Iterator[Step]:
    """The recursion in line sums; which of them matter; squares."""
    yield Step(
        "Let a bead rest on d others, along base vectors n^a of equal mutual dot product φ. The "
        "reciprocal vectors have the products κ, with themselves, and κ′, with each other:",
        sympy.Tuple(
            equation(
                times(kappa, terms(1, -phi), terms(1, times(terms(d, -1), phi))),
                terms(1, times(terms(d, -2), phi)),
            ),
            equation(times(CROSS, terms(1, -phi), terms(1, times(terms(d, -1), phi))), -phi),
        ),
        lambda part, candidate: identity(({kappa: KAPPA}, {CROSS: CROSSED})[part])(0, candidate),
    )
    yield Step(
        "Each contact fixes n^a·δx again, a line sum along n^a, and to first order the force above "
        "a bead is what enters it and b^a·Σ_c(δn^c − δn^c below). With b = a this gives line sums "
        "along the contact itself, on its own line and on the 2(d − 1) next to it: X of Eq. 11, "
        "times κ, for each c. In the plane of one c it has the variance",
        equation(OWN, one_direction().to_sympy()),
        identity({OWN: one_direction().to_sympy()}),
        ("Eq. 11",),
    )
    yield Step(
        "and with another c it shares the contact's own line:",
        equation(SHARED, two_directions().to_sympy()),
        identity({SHARED: two_directions().to_sympy()}),
        ("Eq. 11",),
    )
    first, second = the_rest()
    yield Step(
        "What is left are tilts of the contact itself, and sums over its path of line sums along a "
        "third direction. Their variances are, up to factors of d and φ,",
        sympy.Tuple(equation(TILT, first.to_sympy()), equation(AREA, second.to_sympy())),
        identity({TILT: first.to_sympy(), AREA: second.to_sympy()}),
        ("Eq. B4",),
    )
    yield Step(
        "That is of order M² at most, and by Cauchy and Schwarz changes a variance of order M³ by "
        "order M^(5/2) at most. With d − 1 own and (d − 1)(d − 2) shared parts, to leading order:",
        PRINTED,
        decide,
        ("step 2", "step 3", "step 4"),
    )


CROSS = Symbol("kappa_cross", r"\kappa'", "κ′", real=True)
OWN, SHARED, TILT, AREA = (
    Symbol(f"V_{name}", rf"V_{{\mathrm{{{name}}}}}", f"V_{name}")
    for name in ("own", "shared", "tilt", "area")
)

SIZES = Domain((M, z, phi, kappa, sigma, r, d))


def _order_in_M(expression: sympy.Expr) -> int:
    """Degree in M at fixed z of a rational function; very negative for zero.

    Raises:
        NotExactError: what the denominator goes as may vanish at some z or φ.
    """
    value = SIZES.from_sympy(expression.xreplace({j: z * M}))
    if value.is_zero():
        return -(10**9)
    place = SIZES.position[M]
    below = RationalFunction(SIZES, value.denominator, SIZES.context.constant(1))
    if not never_zero(below.coefficients(M)[-1].to_sympy()):
        raise NotExactError("the order is not shown to hold at every z and φ")
    return int(value.numerator.degrees()[place]) - int(value.denominator.degrees()[place])


def to_leading_order(subject: sympy.Symbol, lines: Callable[[], sympy.Expr]) -> Decide:
    """The variance along the lines less the candidate is of order M² at most, as is the rest."""

    def decide(_: int, candidate: sympy.Eq) -> Ruling:
        if candidate.lhs != subject:
            return undecided("the left-hand side is not σ_f²/⟨f⟩²")
        right = candidate.rhs.xreplace({z: j / M}) if candidate.rhs.has(j) else candidate.rhs
        known = {kappa: KAPPA} if right.has(phi) else {}
        try:
            left = _order_in_M((along_lines(lines()) - right).xreplace(known))
        except NotExactError as reason:
            return undecided(str(reason))
        if left >= 3:
            return refuted(f"it differs by order M^{left} from the line sums along the contact")
        if max(order(value) for value in the_rest()) > 2:
            return undecided("what is left is not shown to be of order M²")
        return proved("equal to order M³; line sums off the contact's lines are of order M²")

    return decide


def parting(subject: sympy.Symbol, lines: Callable[[], sympy.Expr]) -> Search:
    """Values at growing M, in two, three and five dimensions, where the candidate parts."""

    def search(candidate: sympy.Eq) -> str | None:
        if candidate.lhs != subject:
            return None
        for dimension in (2, 3, 5):
            at = {d: sympy.Integer(dimension)}
            at |= {kappa: KAPPA.xreplace(at)}
            exact, right = (side.xreplace(at) for side in (along_lines(lines()), candidate.rhs))
            if found := parts_in_the_limit(exact, right, LAYERS, dimension):
                return f"d = {dimension}, {found}"
        return None

    return search


decide = to_leading_order(eq13.RELATIVE_VARIANCE, lambda: LINES)


def _reciprocal() -> Ruling:
    """The Gram matrix times the products of the reciprocal vectors is the unit matrix."""
    return all_of(
        decide_identity(KAPPA + (d - 1) * phi * CROSSED, sympy.Integer(1)),
        decide_identity(phi * KAPPA + CROSSED + (d - 2) * phi * CROSSED, sympy.Integer(0)),
    )


def _flat() -> Ruling:
    """For d = 2 it is Eq. 13."""
    two = {d: sympy.Integer(2)}
    return decide_identity(PRINTED.rhs.xreplace({kappa: KAPPA}).xreplace(two), eq13.PRINTED.rhs)


def _range() -> Ruling:
    """Where neighbours of the lattice that are not in contact are farther apart than 2r."""
    return all_of(
        decide_identity(2 * (1 - phi) - 1, 1 - 2 * phi),
        decide_identity(d + d * (d - 1) * phi - 1, (d - 1) * (1 + d * phi)),
    )


def _height() -> Ruling:
    """The mean of the profile over z, so that the mean variance is one at M*."""
    mean = sympy.integrate(sympy.expand((1 - z) ** 2 * (1 + 2 * z)), (z, 0, 1))
    return from_test(
        mean == sympy.Rational(1, 2),
        "the mean of the printed form over z is ⅓(d−1)(2d−1) κ² M³ (σ/r)²",
    )


def witness_of_lines(
    packing: SmallPacking, lines: sympy.Expr = LINES, *, bulk: bool = False
) -> Ruling:
    """The variance along the lines against squared weights in two, three and four dimensions."""
    cosine = packing.n[1] ** 2 - packing.n[0] ** 2

    def pairs() -> Iterator[tuple[str, Fraction, Fraction]]:
        for dimension in (2, 3, 4):
            if 1 + (dimension - 1) * cosine <= 0:
                continue
            own, _ = any_dimension.reciprocal(dimension, cosine)
            for height, layer in ((8, 4), (10, 5)):
                values: explicit.Values = {phi: cosine, sigma: 1, r: 1, M: height, j: layer}
                at = {**values, d: dimension, kappa: own}
                weights, _ = any_dimension.force_weights(
                    dimension, height, layer, cosine, bulk=bulk
                )
                where = f"d = {dimension}, M = {height}, j = {layer}"
                stated = explicit.number(along_lines(lines), at)
                yield where, stated, any_dimension.squared(weights)

    return compare(pairs())


def _spheres_witness(packing: SmallPacking) -> Ruling:
    cosine = witnesses.cosine_of(packing)
    worst = max(off for _, off in witnesses.remainders(cosine, 2, 1))
    # a central difference at 1e-20 with 50 digits: rounding 1e-30, curvature 1e-40
    good = worst < mpmath.mpf(10) ** -27
    return Ruling(
        Verdict.AGREES if good else Verdict.DISAGREES,
        f"weights of spheres, φ = {cosine}, M = 2: the same within {mpmath.nstr(worst, 2)}",
    )


DERIVATION = Derivation(
    number="B11",
    name="any_dimension",
    title="Variance of the forces in any dimension, to leading order",
    symbols=(
        (d, "dimensions; every bead rests on d others, along base vectors with one dot product φ"),
        (kappa, "b^a·b^a = [1 + (d−2)φ]/{(1−φ)[1 + (d−1)φ]}; 1/(1−φ²) for d = 2"),
        *usual(sigma, r, M, z),
        (phi, "mutual dot product of the base vectors, −1/d < φ < ½"),
    ),
    assumptions=(
        "the radii are independent, of zero mean and variance σ²",
        "first order in δr",
        "a surface load along the sum of the base vectors, M → ∞ at fixed z",
        "the base is flat and does not move",
    ),
    premises=(eq11.DERIVATION, eq13.DERIVATION, b4.DERIVATION),
    printed=(PRINTED,),
    relation="∼",
    steps=steps,
    decide=decide,
    search=parting(eq13.RELATIVE_VARIANCE, lambda: LINES),
    claims=(
        Claim("the products of the reciprocal vectors", _reciprocal),
        Claim("for d = 2 it is Eq. 13", _flat),
        Claim(
            "no overlap: (1 − 2φ) > 0 for neighbours in a layer, (d−1)(1 + dφ) > 0 for the bead "
            "straight above",
            _range,
        ),
        Claim("M* is [3 r²/((d−1)(2d−1)κ²σ²)]^(1/3): the exponent −2/3 stays", _height),
    ),
    witnesses=(
        Witness(
            "the variance along the lines, exact at finite M, in two, three and four dimensions",
            witness_of_lines,
        ),
        Witness("spheres in three dimensions, solved at 50 digits", _spheres_witness),
    ),
    remarks=(
        "What is special to discs is that nothing is left but lines: for d ≥ 3 the force also "
        "holds line sums along every third direction, summed over the contact's path. They cover "
        "an area with weights of order 1, and drop out of the leading order alone.",
        "Eqs. B13 and B14 are the exact forms at finite M for d = 3; Eq. B20 is for a bulk load.",
    ),
)

if __name__ == "__main__":
    from force_diffusion.derivations.commands.alone import run_alone

    raise SystemExit(run_alone(DERIVATION))
