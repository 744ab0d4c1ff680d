"""T6 (Eqs. B7, B8, B12, B21): correlations of contact forces; here those of different layers."""

from functools import cache

import sympy
from force_diffusion.derivations import eq11_total_force as eq11
from force_diffusion.derivations import eq12_delta_weights as eq12
from force_diffusion.derivations import eq13_surface_diffusion as eq13
from force_diffusion.derivations import eq14_bulk_diffusion as eq14
from force_diffusion.derivations.beyond.t6_neighbours import (
    B7,
    B8,
    B21,
    BANDS,
    BOTH,
    IN_BULK,
    OF_BULK,
    ON_SURFACE,
)
from force_diffusion.derivations.framework.catalogue import Number
from force_diffusion.derivations.framework.grounds import facts_of
from force_diffusion.derivations.framework.proving import Line
from force_diffusion.derivations.framework.record import FIRST_ORDER, ExactCase, usual
from force_diffusion.derivations.framework.vocabulary import (
    UNIT,
    Claim,
    Derivation,
    Lines,
    Where,
    asymptotic,
    equation,
    formula,
    moment,
    relations,
    rewrite,
    terms,
    times,
)
from force_diffusion.derivations.parts.neighbours import FAR
from force_diffusion.symbolic.kernel import moments
from force_diffusion.symbolic.kernel.decisions import Ruling, from_test
from force_diffusion.symbolic.kernel.where import BULK, SURFACE, Limit, Loading
from force_diffusion.symbolic.notation import Symbol
from force_diffusion.symbolic.symbols import (
    Covariance,
    ForceMinus,
    M,
    f_load,
    i,
    j,
    k,
    l,
    m,
    n_y,
    p,
    phi,
    r,
    sigma,
    z,
)
from sympy import Eq, Rational

COVARIANCE = Symbol(
    "layers_covariance",
    r"\frac{\langle\Delta f^{+}_{ij}\,\Delta f^{+}_{i+l-j,\,l}\rangle}{\langle f\rangle^2}",
    "⟨Δf⁺_ij Δf⁺_{i+l−j,l}⟩/⟨f⟩²",
)
CORRELATION = Symbol("layers_correlation", r"\rho_{jl}", "ρ_jl")
z_upper = Symbol("z_upper", "z'", "z′", positive=True)
"""Relative height l/M of the upper contact."""
AT_HEIGHTS = {z: j / M, z_upper: l / M}

LAYERS = equation(
    COVARIANCE,
    formula("""
        (1/(4(1 − φ²)²)) [(M − l)(8M² + 8M l − 12j² − 4l²) − 6M(M + j + l) + 6(j² + jl + l²)
            + 2φ²[9(M − l) − 4] + 2φ(2M − j − l − 2) − 8M + 7j + 9l + 6] (σ_δr/r)²"""),
)

UPPER = relations("0 ≤ j ≤ l < M")
"""A contact of layer j and one of layer l, which is not below it."""
IN_WORDS = "2 ≤ j ≤ l − 2 and l ≤ M − 2"
INSIDE, DEEP = relations(IN_WORDS), relations("4 ≤ j ≤ l − 4 and l ≤ M − 2")
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
HIGHEST, REST = formula("(M − l)(2M² + 2M l − 3j² − l²)"), formula("−(M − l)(3M − 3j − 1)")
ON_SURFACE_LEADING = times(formula("M³(1 − z′)[3(1 − z²) − (1 − z′)²]", z_upper), UNIT)
IN_BULK_LEADING = times(
    formula("(M³/(10(1 − z)))(1 − z′)(3 + 6z′ − 15z² − 6z′² + 10z³ + 2z′³)", z_upper), UNIT
)
"""The same for a bulk load, both forces over their own means."""
AT_TWO_HEIGHTS = Limit(
    "∼", "M → ∞ at fixed z = j/M and z′ = l/M, 0 < z < z′ < 1", (M, j, l), (j, l - j, M - l)
)


def between(*relations: sympy.Basic, loading: Loading | None = SURFACE) -> Where:
    """A domain of two layers, of the indices i, j, l, M and p."""
    return Where.of(*relations, loading=loading).without((k,))


def higher(quantity: sympy.Expr, places: sympy.Expr | int = 0) -> sympy.Expr:
    """The same in layer l, so many places to the right of the diagonal of (i, j)."""
    return quantity.xreplace({i: i + l - j + 2 * places, j: l})


MEANT = {COVARIANCE: Covariance(ON_SURFACE, higher(ON_SURFACE))}
FAR_LEFT = Symbol("C_minus_p", "C_{-p}", "C_−p")
FAR_APART = {
    FAR: Covariance(ON_SURFACE, higher(ON_SURFACE, p)),
    FAR_LEFT: Covariance(ON_SURFACE, higher(ON_SURFACE, -p)),
}
"""Covariances of contacts whose diagonals are p places apart."""
UNCORRELATED = (
    (FAR, relations("3 ≤ p ≤ j − 2")),
    (FAR, relations("p ≥ j + 3")),
    (FAR_LEFT, relations("3 ≤ p ≤ l − j − 2")),
    (FAR_LEFT, relations("l − j + 2 ≤ p ≤ l − 2")),
    (FAR_LEFT, relations("p ≥ l + 3")),
)
"""Where they are, away from base and surface."""


def _ends(above: sympy.Expr) -> tuple[sympy.Expr, ...]:
    """What is left at p = j − 1, …, j + 2, ``above`` layers of the other contact's path up."""
    return tuple(value.xreplace({M: above + j}).expand() for _, value in BANDS)


LEFT_OVER = (
    *((FAR, j + at, value) for at, value in enumerate(_ends(M - l), start=-1)),
    *((FAR_LEFT, l + at, value) for at, value in enumerate(_ends(M - j), start=-1)),
    (FAR_LEFT, l - j - 1, formula("−φ²(4j + 3 − 2φ)/4")),
    (FAR_LEFT, l - j, formula("φ²(4j + 1)/2")),
    (FAR_LEFT, l - j + 1, formula("−φ²(4j − 1 + 2φ)/4")),
)
"""Places where two contacts are correlated after all, in ``UNIT``."""

OTHER_BRANCH = Covariance(ON_SURFACE, ForceMinus(i + 2 * p + j - l, l) / (f_load / (2 * n_y)))
"""Of f⁺_ij and the f⁻ of layer l whose diagonal crosses that of f⁺, p layers above (i, j)."""
CROSSINGS = tuple(
    map(
        relations,
        (
            "4 − j ≤ p ≤ −4",
            "4 ≤ p ≤ l − j − 4",
            "l − j + 4 ≤ p ≤ M − j − 4 and p ≤ l − 4",
            "l − j + 4 ≤ p ≤ M − j − 4 and p ≥ l + 4",
        ),
    )
)
"""Where these two are uncorrelated: below both, between both, above both."""

_BETWEEN = relations("4 ≤ j ≤ l − 6 and M ≥ l + 4")
_APART_AT_BASE = tuple((*_BETWEEN, one) for one in relations("M ≥ l + j + 6, M ≤ l + j − 6"))
"""Where the tilts' lines do not meet at the base while the diagonals cross at the surface."""


def _beside(
    place: sympy.Expr | int, first: int, *written: str, where: tuple[sympy.Basic, ...] = _BETWEEN
) -> tuple[tuple[tuple[sympy.Basic, ...], sympy.Expr], ...]:
    """Covariances where the crossing is so many layers and more above ``place``, in ``UNIT``."""
    return tuple(
        ((*where, Eq(p, place + at)), formula(one)) for at, one in enumerate(written, start=first)
    )


CROSSED = {
    "the lower contact": _beside(
        0, -1,
        "−φ(M − l − 1)(4j − 1 + 2φ)/4",
        "φ[(M − l)(12j + 1 + 2φ) − 8j − 2]/4",
        "−φ[(M − l)(12j + 5 − 2φ) − 4j − 3 + 2φ]/4",
        "φ(M − l)(4j + 3 − 2φ)/4",
    ),
    "the upper contact": _beside(
        l - j, -1,
        "−φ[4l(M − l) + 2(l² − j²) − M − 5j + 2l + 2φ(M + j − 2l) − φ² + 4φ − 4]/4",
        "φ[12l(M − l) + 6(l² − j²) + M − 7j − 2l + 2φ(M + j − 2l) + 5φ² + 2φ − 1]/4",
        "−φ[12l(M − l) + 6(l² − j²) + 5M + j − 10l − 2φ(M + j − 2l) + 5φ² + 4φ − 2]/4",
        "φ[4l(M − l) + 2(l² − j²) + 3M + 3j − 6l − 2φ(M + j − 2l) − φ² + 6φ − 5]/4",
    ),
    "the base": _beside(
        -j, -2,
        "(M − j − 1)(M − l − 1)/4",
        "−(2M − j − l − 2)/4",
        "−[6(M − j)(M − l) − 5(2M − j − l) + 3]/4",
        "[8(M − j)(M − l) − 3(2M − j − l)]/4",
        "−3(M − j)(M − l)/4",
    ),
    "the base, where the lines of the tilts meet": _beside(
        l, 0, "−3φ²/4", "φ²/2", "φ²/4", where=_APART_AT_BASE[0]
    ),
    "the surface": tuple(
        one
        for where in _APART_AT_BASE
        for one in _beside(
            M - j, -1, "−(3 − 2φ + 3φ²)/4", "(1 − φ)²/2", "(1 + φ)²/4", where=where
        )
    ),
}  # fmt: skip
"""Where they are correlated after all, by what their diagonals cross next to."""

EDGES = {
    "next": "l = j + 1, j ≥ 2 and M ≥ l + 2",
    "base": "j = 0 and 2 ≤ l ≤ M − 2",
    "base, next": "j = 0, l = 1 and M ≥ 3",
    "base+1": "j = 1 and 3 ≤ l ≤ M − 2",
    "base+1, next": "j = 1, l = 2 and M ≥ 4",
    "surface": "2 ≤ j ≤ l − 2 and M = l + 1",
    "surface, next": "l = j + 1, j ≥ 2 and M = l + 1",
    "base, surface": "j = 0, l ≥ 2 and M = l + 1",
    "base, next, surface": "j = 0, l = 1 and M = 2",
    "base+1, next, surface": "j = 1, l = 2 and M = 3",
    "base+1, surface": "j = 1, l ≥ 3 and M = l + 1",
}
"""Pairs of layers with a closed form of their own."""


@cache
def edges() -> dict[str, ExactCase]:
    """The covariance at the edges, as users get it."""
    facts, found = facts_of((eq11.IN_RADII,)), {}
    for name, validity in EDGES.items():
        where = between(*relations(validity))
        form = moments.value(MEANT[COVARIANCE], facts, where).to_sympy()
        line = Line(validity, equation(COVARIANCE, form), moment(eq11.IN_RADII), where, MEANT)
        found[name] = ExactCase(COVARIANCE, validity, form, relations(validity), line=line)
    return found


@cache
def layer_steps() -> Lines:
    """Products of the weights of Eq. 12; exactly; beside the diagonal; as a correlation."""
    lines = Lines(between(*INSIDE), moment(eq11.IN_RADII), {**MEANT, **FAR_APART, **AT_HEIGHTS})
    geometry = between(*UPPER, loading=None)
    products = lines.show(
        "By Eq. 12 the forces of two contacts on one diagonal, j < l, are sums of the same Δ on "
        "it, with the weights M − max(j, m) and M − max(l, m). The squares of the radii in one Δ "
        "add up to 6. So the products of both weights are",
        equation(WEIGHTS, PRODUCTS),
        moment(),
        where=between(*relations("1 ≤ j < l < M"), loading=None),
        meaning={WEIGHTS: Covariance(OF_DELTA, higher(OF_DELTA)) / sigma**2},
        after=(eq12.DERIVATION,),
    )
    added = lines.show(
        "Added up:",
        equation(PRODUCTS, terms(HIGHEST, REST)),
        rewrite(),
        where=geometry,
        after=(products,),
    )
    highest = lines.show(
        "The first term, with the prefactor of Eq. 12 squared, is the leading order, z = j/M being "
        "the height of the lower contact and z′ = l/M that of the upper one:",
        equation(times(eq12.PREFACTOR**2, sigma**2, HIGHEST), ON_SURFACE_LEADING),
        rewrite(),
        where=geometry,
        after=(added,),
    )
    exact = lines.show(
        "Eq. 11 in the radii, weight by weight, for 2 ≤ j ≤ l − 2 and l ≤ M − 2:", LAYERS
    )
    leading = lines.show(
        "Its leading order is that of step 3; for z′ = z it is Eq. 13:",
        equation(COVARIANCE, ON_SURFACE_LEADING),
        asymptotic(eq11.IN_RADII),
        where=between(*INSIDE).in_the_limit(AT_TWO_HEIGHTS),
        after=(highest, exact),
    )
    lines.show(
        "Contacts of layer l whose diagonals are p ≥ 3 places away: to the right, where p is none "
        "of j − 1, …, j + 2; to the left, where it is none of l − 1, …, l + 2, nor of l − j − 1, "
        "…, l − j + 1. At those places a line of one contact's tilt meets the other's path where "
        "that begins or ends.",
        sympy.Tuple(*(equation(one, 0) for one, _ in UNCORRELATED)),
        where=tuple(between(*places, *INSIDE) for _, places in UNCORRELATED),
    )
    below, above = (eq13.PRINTED.rhs.xreplace({z: at}) for at in (z, z_upper))
    lines.show(
        "As a correlation, with Eq. 13 for both variances:",
        equation(CORRELATION**2, SQUARED),
        rewrite(),
        where=geometry,
        meaning={CORRELATION**2: ON_SURFACE_LEADING**2 / (below * above), **AT_HEIGHTS},
        after=(eq13.DERIVATION, leading),
    )
    nearby = between(*DEEP).in_the_limit(AT_TWO_HEIGHTS)
    lines.claim_each(
        "beside the diagonal, one and two places away, the covariances are −2/3 and 1/6 of it "
        "to leading order, as within a layer",
        (
            (
                Covariance(ON_SURFACE, higher(ON_SURFACE, side * places)),
                times(share, ON_SURFACE_LEADING),
                nearby,
            )
            for places, share in ((1, -Rational(2, 3)), (2, Rational(1, 6)))
            for side in (1, -1)
        ),
        asymptotic(eq11.IN_RADII),
    )
    lines.claim_each(
        "where the diagonal is p = j − 1, …, j + 2 places to the right, or to the left "
        "l − 1, …, l + 2 or l − j − 1, …, l − j + 1, a covariance of order M is left, for j and "
        "l − j from 4 on and M − l from 2 on, and none for φ = 0",
        ((one, times(value, UNIT), between(*DEEP, Eq(p, at))) for one, at, value in LEFT_OVER),
    )
    lines.claim_each(
        "f⁺ and f⁻ are uncorrelated, exactly, where their diagonals cross four layers or more "
        "from both, from the base and from the surface, and, if q layers above both, where q "
        "and j differ by four or more",
        ((OTHER_BRANCH, sympy.S.Zero, between(*places, *UPPER)) for places in CROSSINGS),
        moment(BOTH),
    )
    crossed = (one for group in CROSSED.values() for one in group)
    lines.claim_each(
        "where their diagonals cross next to one of both, or to the base, a covariance of order M² "
        "is left, next to the surface one of order 1; for j from 4 on, l − j from 6 on and M − l "
        "from 4 on",
        ((OTHER_BRANCH, times(value, UNIT), between(*places)) for places, value in crossed),
        moment(BOTH),
    )
    summed = {name: terms(*(value for _, value in group)) for name, group in CROSSED.items()}
    del summed["the surface"]
    lines.claim(
        "next to each of both, and to the base, these covariances add up to zero",
        sympy.Tuple(*(equation(one, 0) for one in summed.values())),
        rewrite(),
        where=geometry,
    )
    in_bulk = between(*relations("2 ≤ j ≤ l − 2 and l < M"), loading=BULK)
    lines.claim(
        "under a bulk load, over both means, it goes as M³(1−z′)Q (σ/r)²/(1−φ²)², where "
        "10(1−z)Q = 3 + 6z′ − 15z² − 6z′² + 10z³ + 2z′³",
        equation(Covariance(OF_BULK, higher(OF_BULK)), IN_BULK_LEADING),
        asymptotic(IN_BULK),
        where=in_bulk.in_the_limit(AT_TWO_HEIGHTS),
    )
    bulk_squared = IN_BULK_LEADING.xreplace({1 - z_upper: sympy.S.One}) ** 2 / (
        eq14.PRINTED.rhs * eq14.PRINTED.rhs.xreplace({z: z_upper})
    ).xreplace({1 - z_upper: sympy.S.One})
    ends = {z: sympy.Integer(0), z_upper: sympy.Integer(1)}
    lines.claim(
        "along a diagonal from the base to the surface a correlation of √3/2 is left under a "
        "surface load, of √5/3 under a bulk load, as M → ∞ and then z′ → 1",
        sympy.Tuple(
            equation(SQUARED.xreplace(ends), Rational(3, 4)),
            equation(bulk_squared.xreplace(ends), Rational(5, 9)),
        ),
        rewrite(),
        where=geometry,
    )
    lines.claim_each(
        "the forms next to base and surface, and of neighbouring layers",
        ((COVARIANCE, one.expression, between(*one.domain)) for one in edges().values()),
    )
    return lines


OF_DELTA = sympy.Sum(times(eq12.BRACES, eq12.ON_DIAGONAL), (m, 1, M))
"""Eq. 12 without its prefactor."""
SQUARED = formula("[3(1 − z²) − (1 − z′)²]² (1/(4(1 − z)²)) (1/(1 + 2z)) (1/(1 + 2z′))", z_upper)
"""The squared correlation of two contacts of one diagonal."""


def _mean_of_diagonal() -> Ruling:
    """Twice the integral over 0 < z < z′ < 1, against that of the variance, by powers."""
    lower, upper = sympy.symbols("a b")
    of_pair = sympy.expand((1 - upper) * (3 * (1 - lower**2) - (1 - upper) ** 2))
    up_to = sympy.Poly(of_pair, lower).integrate().as_expr().xreplace({lower: upper})
    whole = 2 * sympy.Poly(up_to, upper).integrate()(1)
    single = sympy.Poly(2 * (1 - z) ** 2 * (1 + 2 * z), z).integrate()(1)
    return from_test(
        whole == Rational(4, 5) and single == 1,
        "the mean over a diagonal has 4/5 of the variance that a contact of it has on average",
    )


B12 = Derivation(
    number="B12",
    name="between_layers",
    title="Covariance of contact forces in different layers",
    symbols=(
        (COVARIANCE, "covariance of f⁺_ij and of f⁺ in layer l on the same diagonal, over ⟨f⟩²"),
        (l, "layer of the upper contact, j that of the lower one"),
        *usual(sigma, r, M, phi),
    ),
    assumptions=(*FIRST_ORDER, "a surface load", IN_WORDS),
    premises=(eq11.DERIVATION, eq12.DERIVATION, eq13.DERIVATION, eq14.DERIVATION),
    printed=(LAYERS,),
    domain=INSIDE,
    where=between(*INSIDE),
    steps=layer_steps,
    exact=edges,
    claims=(
        Claim(
            "the mean over all contacts of a diagonal keeps 4/5 of the mean variance, to leading "
            "order",
            _mean_of_diagonal,
        ),
    ),
    remarks=(
        "Within a layer fluctuations cancel over neighbours (Eq. B7); along a diagonal they do "
        "not: a force that is large stays so through the whole packing. What a mean over a region "
        "leaves of them depends on its shape.",
    ),
)

DERIVATIONS: dict[Number, Derivation] = {one.number: one for one in (B7, B8, B12, B21)}

if __name__ == "__main__":
    from force_diffusion.derivations.commands.alone import run_alone

    raise SystemExit(run_alone(DERIVATIONS))
