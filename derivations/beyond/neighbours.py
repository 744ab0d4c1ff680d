"""What Eqs. B7, B8 and B21 have in common: means of N neighbours, from covariances of two."""

from collections.abc import Callable
from fractions import Fraction
from functools import cache

import sympy
from force_diffusion.derivations.beyond.means import decide_in_field
from force_diffusion.derivations.framework.follows import Decide
from force_diffusion.derivations.framework.record import Search, Witness
from force_diffusion.derivations.witnesses import neighbours as witnesses
from force_diffusion.symbolic.algebra import explicit
from force_diffusion.symbolic.algebra.affine import Region
from force_diffusion.symbolic.algebra.exact import FIELD, RationalFunction
from force_diffusion.symbolic.kernel.decisions import (
    Ruling,
    all_of,
    decide_identity,
    from_test,
    undecided,
)
from force_diffusion.symbolic.notation import Symbol
from force_diffusion.symbolic.printing.text import text
from force_diffusion.symbolic.symbols import M, N, i, j, k, p, phi, q, r, sigma
from force_diffusion.symbolic.variances.means import covariance, covariances_by_case
from force_diffusion.symbolic.variances.variance import leading

FARTHEST = 2
"""Neighbours that are farther apart than this many places are uncorrelated."""

Split = tuple[dict[sympy.Symbol, sympy.Expr], dict[sympy.Symbol, int]]
"""Indices in terms of others, and the lower bounds of these."""


COVARIANCES = tuple(
    Symbol(f"C_{k}", f"C_{{{k}}}", f"C{lowered}") for k, lowered in enumerate("₀₁₂")
)
"""Covariances of two that are k = 0, 1, 2 places apart, over the squared mean of one."""
FAR = Symbol("C_k", "C_{k}", "C_k")
"""That of two that are k ≥ 3 places apart."""
OF_MEAN = (N * COVARIANCES[0] + 2 * (N - 1) * COVARIANCES[1] + 2 * (N - 2) * COVARIANCES[2]) / N**2
"""Variance of the mean of N of them."""


def told(
    subject: sympy.Symbol, values: tuple[RationalFunction, ...]
) -> dict[sympy.Symbol, sympy.Expr]:
    """What stands for the covariances, and for the variance of the mean."""
    known = dict(zip(COVARIANCES, (value.to_sympy() for value in values), strict=True))
    return {**known, subject: mean_of_neighbours(values)}


def none_far(zero: Callable[[], Ruling]) -> Decide:
    """That far covariances are zero, by ``zero``."""

    def decide(_: int, candidate: sympy.Eq) -> Ruling:
        if candidate.lhs != FAR:
            return undecided(f"the left-hand side is not {text(FAR)}")
        return all_of(decide_identity(candidate.rhs, sympy.Integer(0)), zero())

    return decide


def apart(form: sympy.Expr, places: sympy.Expr) -> sympy.Expr:
    """The same quantity so many contacts or beads to the right, in the same layer."""
    return form.xreplace({i: i + 2 * places})


def near(form: sympy.Expr, region: Region) -> tuple[RationalFunction, ...]:
    """Covariances C_0, C_1, C_2 of a quantity with itself and its first two neighbours."""
    return tuple(
        covariance(form, apart(form, sympy.Integer(places)), region)
        for places in range(FARTHEST + 1)
    )


def mean_of_neighbours(covariances: tuple[RationalFunction, ...]) -> sympy.Expr:
    """Variance of the mean of N: [N C_0 + 2 Σ_k (N − k) C_k]/N², where C_k = 0 for k > 2."""
    own, *others = (value.to_sympy() for value in covariances)
    pairs = sum(2 * (N - place) * value for place, value in enumerate(others, start=1))
    return (N * own + pairs) / N**2


def spread(covariances: tuple[RationalFunction, ...]) -> RationalFunction:
    """C_0 + 2 Σ_k C_k: the variance that N contacts add, each, to their sum."""
    total = covariances[0]
    for value in covariances[1:]:
        total = total + value + value
    return total


def far_is_zero(form: sympy.Expr, splits: tuple[Split, ...]) -> Ruling:
    """No covariance at k ≥ 3 places, for all indices of the splits."""
    count = 0
    for at, lower in splits:
        left, right = form.xreplace(at), apart(form, k).xreplace(at)
        for case in covariances_by_case(left, right, lower, generic=3):
            count += 1
            if not case.value.is_zero():
                return from_test(False, "", f"not at {case.at}, {case.lower}")
    return from_test(True, f"no covariance in any of {count} cases, which cover all places")


def add_up_to_zero(form: sympy.Expr) -> Ruling:
    """Covariances of f^± at k = j − 1, …, j + 2 places add up to zero; those beyond are zero."""
    at: dict[sympy.Symbol, sympy.Expr] = {M: j + q}
    ends = sum((apart(form, j + places) for places in (-1, 0, 1, 2)), sympy.Integer(0))
    beyond = apart(form, j + 3 + p)
    cases = [
        *covariances_by_case(form.xreplace(at), ends.xreplace(at), {j: 4, q: 1}, generic=3),
        *covariances_by_case(form.xreplace(at), beyond.xreplace(at), {j: 4, q: 1, p: 0}, generic=3),
    ]
    return from_test(
        all(case.value.is_zero() for case in cases),
        f"{len(cases)} cases, which cover all j ≥ 4 and M ≥ j + 1: those of k = j − 1, …, j + 2 "
        "add up to zero, and those of k ≥ j + 3 are zero",
    )


def same_at(form: sympy.Expr, general: RationalFunction, places: int, split: Split) -> bool:
    """Whether a covariance C_k of the interior holds in every case of a split of j and M."""
    at, lower = split
    image = {symbol: FIELD.from_sympy(value) for symbol, value in at.items()}
    left, right = form.xreplace(at), apart(form, sympy.Integer(places)).xreplace(at)
    stated = general.substitute(image) / FIELD.from_sympy(sigma**2)
    return all(
        (case.value - case.put_in(stated)).is_zero()
        for case in covariances_by_case(left, right, lower, generic=3)
    )


def hold_everywhere(
    form: sympy.Expr, covariances: tuple[RationalFunction, ...], layer: int, above: int
) -> Ruling:
    """C_0, C_1, C_2 are those of the interior for all j ≥ ``layer``, M ≥ j + ``above``."""
    inside = ({M: j + q}, {j: layer, q: above})
    return from_test(
        all(same_at(form, value, places, inside) for places, value in enumerate(covariances)),
        f"the three covariances hold for all j ≥ {layer} and M ≥ j + {above}",
    )


CORRELATIONS = (sympy.Integer(1), -sympy.Rational(2, 3), sympy.Rational(1, 6))
"""Of a contact with itself and its first two neighbours, to leading order."""


def correlated(
    covariances: tuple[RationalFunction, ...], variance: sympy.Expr, number: int
) -> Ruling:
    """To leading order they are the shares ``CORRELATIONS`` of the variance of Eq. ``number``."""
    printed = leading(FIELD.from_sympy(variance))
    return from_test(
        all(
            (leading(value) - printed * FIELD.from_sympy(share)).is_zero()
            for value, share in zip(covariances, CORRELATIONS, strict=True)
        ),
        f"to leading order the correlations are −2/3 and 1/6: 2/(3N²) of Eq. {number} is left "
        "for N ≥ 2",
    )


def decided(
    covariances: Callable[[], tuple[RationalFunction, ...]], subject: sympy.Symbol
) -> Decide:
    """The candidate equals the exact variance of the mean, as a rational function."""
    exact = cache(lambda: mean_of_neighbours(covariances()))

    def decide(_: int, candidate: sympy.Eq) -> Ruling:
        if candidate.lhs != subject:
            return undecided("the left-hand side is not the variance of the mean of N")
        return decide_in_field(candidate.rhs, exact())

    return decide


Places = tuple[tuple[int, int, int], ...]
"""Packings (M, j, N)."""


@cache
def _found(quantity: str, height: int, layer: int, count: int) -> Fraction:
    return witnesses.mean_variance(quantity, height, layer, count, witnesses.DIRECTION)


def searched(quantity: str, subject: sympy.Symbol, places: Places) -> Search:
    """Exact packings in which the variance is another, r = σ = 1."""
    values = {**explicit.geometry(*witnesses.DIRECTION, Fraction(1)), sigma: 1}

    def search(candidate: sympy.Eq) -> str | None:
        if candidate.lhs != subject:
            return None
        for height, layer, count in places:
            try:
                stated = explicit.number(candidate.rhs, {**values, M: height, j: layer, N: count})
            except explicit.AmbiguousError:
                return None
            true = _found(quantity, height, layer, count)
            if stated != true:
                return f"for M = {height}, j = {layer}, N = {count} it is {stated}, not {true}"
        return None

    return search


def witnessed(quantity: str, printed: sympy.Eq, places: Places) -> Witness:
    """Exact packings, in which weights of neighbours are summed before they are squared."""

    def stated(height: int, layer: int, count: int, cosine: Fraction) -> Fraction:
        values: explicit.Values = {M: height, j: layer, N: count, phi: cosine, sigma: 1, r: 1}
        return explicit.number(printed.rhs, values)

    return Witness(
        "exact packings: squares of summed weights, as fractions",
        lambda packing: witnesses.agree(quantity, stated, places, packing),
    )
