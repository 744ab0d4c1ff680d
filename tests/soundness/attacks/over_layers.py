"""Attacks on averages over the layers, on what they go to, and on heights and integrals."""

from collections.abc import Callable
from dataclasses import replace
from functools import cache
from typing import Any

import sympy
from force_diffusion.symbolic.as_printed import equation, power, terms, times
from force_diffusion.symbolic.kernel import averages, rules, statistics
from force_diffusion.symbolic.kernel.axioms import FORCE, GAUSSIAN_BELOW, GAUSSIAN_FORCES, SQUARE
from force_diffusion.symbolic.kernel.theorem import NotProvedError, Theorem, made
from force_diffusion.symbolic.kernel.where import (
    AT_FIXED_RATIO,
    SURFACE,
    Where,
    at_fixed_height,
    at_large_height,
)
from force_diffusion.symbolic.symbols import (
    Covariance,
    DeltaR,
    M,
    Mean,
    Tensile,
    UnitHeight,
    Variance,
    j,
    k,
    l,
    m,
    n,
    phi,
    r,
    sigma,
    z,
)
from sympy import Derivative, Eq, Expr, Integer, Integral, Pow, Rational, S, Sum, Symbol, erfc, sqrt

from .attack import (
    HERE,
    ROOT,
    attack,
    only_supposed,
    told,
)

Premise = Callable[[], Theorem]
Premises = Callable[[], Theorem | tuple[Theorem, ...]]
VARIANCE = sigma**2
UNKNOWN = Symbol("nu", real=True)
LAYERS, HEIGHTS = Where.of(j >= 0, j <= M - 1), Where((M,), (M >= 3,))
LARGE, TWO_ORDERS, IN_PROPORTION, AS_IT_IS = (
    HEIGHTS.in_the_limit(at_large_height(*how)) for how in (("∼",), ("∼", 2), ("∝",), ("=",))
)
AT_M = DeltaR(m, m)


def over_layers(term: Expr) -> Expr:
    """The mean over the layers."""
    return Sum(term, (m, 0, M - 1)) / M


def layer(weight: Expr, where: Where = LAYERS) -> Theorem:
    """That the variance of a radius times a weight is what it is."""
    return told(statistics.moment(), Variance(weight * HERE), weight**2 * VARIANCE, where)


@cache
def _every() -> Theorem:
    """Variances (M − j)² σ²."""
    return layer(M - j)


OVER = over_layers(Variance((M - m) * AT_M))
"""Their mean over the layers, (M + 1)(2M + 1) σ²/6."""


@cache
def _exact() -> Theorem:
    return told(averages.total(_every()), OVER, (M + 1) * (2 * M + 1) * VARIANCE / 6, HEIGHTS)


@cache
def _leading() -> Theorem:
    return told(averages.expansion(_exact()), OVER, M**2 * VARIANCE / 3, LARGE)


def _covariance(weight: Expr) -> Theorem:
    return told(statistics.moment(), Covariance(HERE, weight * HERE), weight * VARIANCE, LAYERS)


HARMONIC = over_layers(Covariance(AT_M, AT_M / (M - m)))
INVERSES, NO_INVERSES = Sum(1 / n, (n, 1, M - 1)), Sum(1 / n, (n, 2, 1))

# sums over the layers

for tried, layers, left, right, where, false, refused in (
    ("another sum", _every, OVER, (M + 1) * (2 * M + 1) * VARIANCE / 3, HEIGHTS, "it is half of it",
     "is another one"),
    ("a divisor that may vanish", _every, OVER, times(
        (M + 1) * (2 * M + 1) * VARIANCE / 6, M - 4, Pow(M - 4, -1)), HEIGHTS, "0/0 at M = 4",
     "not shown to differ"),
    ("two sums", _every, OVER + over_layers(Variance(AT_M)), M * VARIANCE, HEIGHTS,
     "they are not both known", "2 of Sum"),
    ("the base is left out", lambda: layer(M - j, Where.of(j >= 1, j <= M - 1)), OVER,
     (M - 1) * (2 * M - 1) * VARIANCE / 6, HEIGHTS, "M² is missing", "nothing is known of layer 0"),
    ("the top is left out", lambda: layer(M - j, Where.of(j >= 0, j <= M - 2)), OVER,
     (M + 1) * (2 * M + 1) * VARIANCE / 6 - VARIANCE / M, HEIGHTS, "1 is missing",
     "nothing is known of layer M − 1"),
    ("low packings are left out", lambda: layer(M - j, Where.of(j >= 0, j <= M - 1, M >= 5)), OVER,
     (M + 1) * (2 * M + 1) * VARIANCE / 6, HEIGHTS, "nothing is known at M = 3",
     "nothing is known of layer 0"),
    ("another quantity", lambda: layer(2 * M - j), OVER,
     (2 * M + 1) * (7 * M + 1) * VARIANCE / 6, HEIGHTS, "its weights are others",
     "nothing is known of layer 0"),
    ("a harmonic sum with other ends", lambda: _covariance(1 / (M - j)), HARMONIC,
     VARIANCE * INVERSES / M, HEIGHTS, "1/M is missing", "is another one"),
    ("a sum of inverse squares", lambda: _covariance(1 / (M - j) ** 2), over_layers(
        Covariance(AT_M, AT_M / (M - m) ** 2)), VARIANCE / M * Sum(1 / n, (n, 1, M)), HEIGHTS,
     "it is below 2", "stands in a denominator"),
    ("what is about no layer", lambda: told(rules.rewrite(), S.One, 1, LAYERS), OVER, M * VARIANCE,
     HEIGHTS, "nothing is known", "nothing is known of layer 0"),
):  # fmt: skip

    @attack("total", tried, false, refused)
    def _(
        layers: Premises = layers, left: Expr = left, right: Expr = right, where: Where = where
    ) -> object:
        found = layers()
        every = found if isinstance(found, tuple) else (found,)
        return told(averages.total(*every), left, right, where)


@attack("total", "layers that are only supposed", "nothing is proved", "supposed")
def _() -> object:
    one = only_supposed(Variance(HERE), 2 * VARIANCE, LAYERS)
    mean = told(averages.total(one), over_layers(Variance(AT_M)), 2 * VARIANCE, HEIGHTS)
    if mean.supposed:
        raise NotProvedError("it rests on what is supposed")
    return mean


# leading orders

for tried, exact, left, right, where, false, refused in (
    ("the same order", _exact, OVER, M**2 * VARIANCE, LARGE, "the ratio is ⅓", "is of order 2"),
    ("another second order", _exact, OVER, (M**2 / 3 + M) * VARIANCE, TWO_ORDERS,
     "it is M/2", "is of order 1"),
    ("another limit", _exact, OVER, M**2 * VARIANCE / 3, AS_IT_IS, "both grow, and part",
     "not with the sign"),
    ("known at one height", lambda: told(averages.total(_every()), OVER, 14 * VARIANCE / 3,
     Where((M,), (Eq(M, 3),))), OVER, 14 * VARIANCE / 3, LARGE, "it grows", "does not hold on all"),
    ("an index that is left", None, k**2 * M, k**2 * (M + 1), LARGE.also(indices=(k, l)),
     "0/0 at k = 0", "neither grows"),
    ("a relative height", None, M**2 + z, M**2, LARGE, "there is no layer", "neither grows"),
    ("a sum without terms that counts as one", None, M**2 * NO_INVERSES + M,
     M**2 * NO_INVERSES + 1, LARGE, "M ∼ 1", "not shown to be of one order"),
    ("a harmonic sum that counts", None, M + M * INVERSES, M, LARGE, "it grows as M ln M",
     "is of order 2"),
    ("a leading part that vanishes at φ = 0", None, phi * M + 1, phi * M + 2, LARGE, "½ at φ = 0",
     "may vanish"),
):  # fmt: skip

    @attack("expansion", tried, false, refused)
    def _(
        exact: Premise | None = exact, left: Expr = left, right: Expr = right, where: Where = where
    ) -> object:
        return told(averages.expansion(*([exact()] if exact else [])), left, right, where)


@attack("expansion", "a mean of layers that are only supposed", "nothing is proved", "supposed")
def _() -> object:
    one = only_supposed(Variance(HERE), 2 * VARIANCE, LAYERS)
    mean = told(averages.total(one), over_layers(Variance(AT_M)), 2 * VARIANCE, HEIGHTS)
    large = told(averages.expansion(mean), over_layers(Variance(AT_M)), 2 * VARIANCE, LARGE)
    if large.supposed:
        raise NotProvedError("it rests on what is supposed")
    return large


# proportions

ROOT_OVER = power(OVER, S.Half)

for tried, left, right, false, refused in (
    ("another power of M", ROOT_OVER, M**2 * sigma, "it goes as M", "depends on M"),
    ("a length too much", ROOT_OVER, M * sigma / r, "it holds no r", "depends on r"),
    ("a length too few", ROOT_OVER, M, "it goes as σ", "depends on σ"),
    ("a negative root", ROOT_OVER, -M * sigma, "a root is positive", "not shown to be positive"),
    ("what vanishes at φ = 0", ROOT_OVER, phi**2 * M * sigma, "it is 0 at φ = 0",
     "not shown to be positive"),
    ("a leading part that vanishes at φ = 0", ROOT_OVER, (phi * M + 1) * sigma,
     "it stays at φ = 0", "not shown to be positive"),
    ("0/0", ROOT_OVER, times(M * sigma, phi, Pow(phi, -1)), "0/0 at φ = 0", "not shown to differ"),
    ("an unknown number", ROOT_OVER, M * sigma * (1 + UNKNOWN**2), "it may grow",
     "not a rational function"),
    ("a harmonic sum", ROOT_OVER, M * sigma * INVERSES, "it grows as M ln M", "neither grows"),
    ("a relative height", ROOT_OVER, M * sigma * (1 + z), "there is no layer", "neither grows"),
    ("a root of what may be negative", ROOT_OVER, M * sigma * sqrt(1 + 3 * phi),
     "φ may be below −⅓", "may be negative"),
):  # fmt: skip

    @attack("proportional", tried, false, refused)
    def _(left: Expr = left, right: Expr = right) -> object:
        return told(averages.proportional(_leading()), left, right, IN_PROPORTION)


def _proportion() -> Theorem:
    return told(averages.proportional(_leading()), ROOT_OVER, M * sigma, IN_PROPORTION)


# heights

UNIT = UnitHeight(OVER)
IS_ONE = sqrt(3) / sigma
"""The height at which M² σ²/3 is one."""


@cache
def _height() -> Theorem:
    return told(averages.unit_height(_leading()), UNIT, IS_ONE, AS_IT_IS)


@attack("proportional", "the height of a packing in what a height is", "it is not both", "M is the")
def _() -> object:
    return told(averages.proportional(_height()), UNIT, (1 + 1 / M) / sigma, IN_PROPORTION)


@attack("proportional", "the height of another packing", "nothing is known", "another packing")
def _() -> object:
    return told(averages.proportional(_height()), UNIT, 1 / sigma, IN_PROPORTION.loaded(SURFACE))


def _of_proportion() -> Theorem:
    return told(averages.proportional(_leading()), OVER, 2 * M**2 * VARIANCE, IN_PROPORTION)


@cache
def _constant() -> Theorem:
    return told(averages.expansion(), S.One, 1 + 1 / M, LARGE)


for tried, order, left, right, where, false, refused in (
    ("another number", _leading, UNIT, 1 / sigma, AS_IT_IS, "it is √3/σ", "is not one there"),
    ("a negative height", _leading, UNIT, -IS_ONE, AS_IT_IS, "M is positive", "is positive"),
    ("of another quantity", _leading, UnitHeight(2 * OVER), IS_ONE, AS_IT_IS, "it is lower",
     "not the height that is defined"),
    ("of what is only in proportion", _of_proportion, UNIT, 1 / (sqrt(2) * sigma), AS_IT_IS,
     "it is √3/σ", "another limit"),
    ("of what is known at finite size", _exact, UNIT, IS_ONE, AS_IT_IS, "it is less there",
     "another limit"),
    ("of what does not grow", _constant, UnitHeight(S.One), Integer(5), AS_IT_IS,
     "any height is one", "not one height"),
    ("in another packing", _leading, UNIT, IS_ONE, AS_IT_IS.loaded(SURFACE), "it is another one",
     "another packing"),
    ("with 0/0", _leading, UNIT, times(IS_ONE, phi, Pow(phi, -1)), AS_IT_IS, "0/0 at φ = 0",
     "not shown to differ"),
):  # fmt: skip

    @attack("unit_height", tried, false, refused)
    def _(
        order: Premise = order, left: Expr = left, right: Expr = right, where: Where = where
    ) -> object:
        return told(averages.unit_height(order()), left, right, where)


def _one() -> Theorem:
    return told(averages.expansion(), S.One, 1, LARGE)


AT_Z = LAYERS.in_the_limit(at_fixed_height("∼"))


def _negative() -> Theorem:
    return told(averages.expansion(), 1 - M, -M, LARGE)


for tried, theorem, left, right, where, false, refused in (
    ("another value", _leading, OVER, M**2 * VARIANCE, LARGE, "it is a third", "another one"),
    ("another quantity", _leading, 2 * OVER, M**2 * VARIANCE / 3, LARGE, "it is twice that",
     "about something else"),
    ("another domain", _leading, OVER, M**2 * VARIANCE / 3, TWO_ORDERS, "a second order is M/2",
     "about something else"),
    ("a root of a square", _negative, 1 - M, power(power(-M, 2), S.Half), LARGE,
     "it is −M", "may be negative"),
    ("a root left out", _one, S.One, power(M, S.Half), LARGE, "√M grows",
     "is left"),
    ("0/0", _leading, OVER, times(M**2 * VARIANCE / 3, phi, Pow(phi, -1)), LARGE, "0/0 at φ = 0",
     "not shown to differ"),
):  # fmt: skip

    @attack("restated", tried, false, refused)
    def _(
        theorem: Premise = theorem, left: Expr = left, right: Expr = right, where: Where = where
    ) -> object:
        return told(averages.restated(theorem()), left, right, where)


@attack("restated", "what holds at finite size", "nothing is said of a limit", "not one in a limit")
def _() -> object:
    return told(averages.restated(_exact()), OVER, (M + 1) * (2 * M + 1) * VARIANCE / 6, HEIGHTS)


@attack("restated", "what is only supposed", "nothing is proved", "supposed")
def _() -> object:
    again = told(averages.restated(only_supposed(M, 2 * M, LARGE)), M, M + M, LARGE)
    if again.supposed:
        raise NotProvedError("it rests on what is supposed")
    return again


# integrals


def _mean(inside: Expr) -> Integral:
    return Integral(inside, (z, 0, 1))


@cache
def _slope() -> Theorem:
    """d/dz (2/3)(1 + z)^(3/2) = √(1 + z)."""
    return told(rules.differentiate(ROOT, 1 + z), Derivative(
        2 * (1 + z) ** Rational(3, 2) / 3, z), sqrt(1 + z), Where())  # fmt: skip


def _step() -> Theorem:
    """A step at z = ½ has no slope beside it."""
    leap = sympy.Piecewise((0, z < S.Half), (1, True))
    return made(equation(Derivative(z + leap, z), S.One), Where(), "differentiate")


def _twice() -> Theorem:
    return told(rules.differentiate(ROOT, 1 + z), Derivative(z**2 / 2, z, z), 1, Where())


def _of_another() -> Theorem:
    slope = Derivative(2 * (1 + r) ** Rational(3, 2) / 3, r)
    return told(rules.differentiate(ROOT, 1 + r), slope, sqrt(1 + r), Where())


OF_ROOT = _mean(sqrt(1 + z))
VALUE = (4 * sqrt(2) - 2) / 3

for tried, slope, left, right, false, refused in (
    ("another value", None, _mean(z**2), S.Half, "it is ⅓", "another one"),
    ("z outside as well", None, z * _mean(z**2), z / 3, "z is averaged over", "as well"),
    ("another range", None, Integral(z**2, (z, 0, 2)), Rational(1, 3), "it is 8/3", "no mean over"),
    ("another variable", None, Integral(r**2, (r, 0, 1)), Rational(1, 3), "r is a length",
     "no mean over"),
    ("0/0 inside", None, _mean(times(2 * z - 1, Pow(2 * z - 1, -1))), 1, "0/0 at z = ½",
     "not shown to differ"),
    ("0/0 outside", None, _mean(z), times(S.Half, phi, Pow(phi, -1)), "0/0 at φ = 0",
     "not shown to differ"),
    ("two integrals", None, _mean(z) + _mean(z**2), S.Half, "one is ⅓", "2 of Integral"),
    ("a pole", None, _mean(1 / (1 + z)), 1, "it is ln 2", "stands in a denominator"),
    ("another value of a root", _slope, OF_ROOT, VALUE / 2, "it is twice that", "another one"),
    ("another factor of a root", _slope, 2 * OF_ROOT, VALUE, "it is twice that", "another one"),
    ("another root", _slope, _mean(sqrt(2 + z)), VALUE, "it is larger", "no antiderivative"),
    ("a negative root", _slope, _mean(-sqrt(1 + z)), VALUE, "it is negative", "no antiderivative"),
    ("a step", _step, _mean(S.One), 2, "it is 1", "may not be continuous"),
    ("a second derivative", _twice, _mean(S.One), S.Half, "it is 1", "another variable"),
    ("no derivative of what is integrated", lambda: told(rules.rewrite(), z, z, Where()), _mean(z),
     1, "it is ½", "another variable"),
    ("an antiderivative by another variable", _of_another, OF_ROOT, VALUE,
     "nothing is known of z", "another variable"),
):  # fmt: skip

    @attack("integral", tried, false, refused)
    def _(slope: Premise | None = slope, left: Expr = left, right: Expr = right) -> object:
        return told(averages.integral(*([slope()] if slope else [])), left, right, Where())


# limits of sums over the layers

ROOTS = over_layers(sqrt(Variance((M - m) * AT_M)))
PROFILE = M**2 * (1 - z) ** 2 * VARIANCE


def _of_profile(profile: Expr) -> Integral:
    return _mean(power(profile, S.Half))


def _edge(value: Expr) -> tuple[Theorem, ...]:
    """Variances (M − j)² σ², supposing another one at the base."""
    base = Where.of(Eq(j, 0), M >= 2)
    return only_supposed(Variance((M - j) * HERE), value * VARIANCE, base), _layer_above()


def _layer_above() -> Theorem:
    return layer(M - j, Where.of(j >= 1, j <= M - 1))


def _inside(value: Expr) -> tuple[Theorem, ...]:
    """The same, supposing others above the base."""
    base = layer(M - j, Where.of(Eq(j, 0), M >= 2))
    where = Where.of(j >= 1, j <= M - 1)
    if value.has(l):
        where = where.also(indices=(k, l))
    return base, only_supposed(Variance((M - j) * HERE), value * VARIANCE, where)


for tried, several, left, right, where, false, refused in (
    ("another factor", _every, ROOTS, _of_profile(2 * PROFILE), LARGE, "it is √2 times that",
     "the rest is of order 2"),
    ("another profile", _every, ROOTS, _of_profile(M**2 * (1 - z**2) * VARIANCE), LARGE,
     "its root has another mean", "the rest is of order 2"),
    ("a sum in place of a mean", _every, M * ROOTS, _of_profile(PROFILE), LARGE,
     "it is M times that", "no mean over the layers"),
    ("a few layers", lambda: layer(M - j, Where.of(j >= 0, j <= 1, M >= 3)),
     Sum(sqrt(Variance((M - m) * AT_M)), (m, 0, 1)) / M,
     _of_profile(PROFILE), LARGE, "it goes as 2σ", "no mean over the layers"),
    ("another factor of the integral", _every, ROOTS, 2 * _of_profile(PROFILE), LARGE,
     "it is half of it", "no mean over 0 < z < 1"),
    ("two orders", _every, ROOTS, _of_profile(PROFILE), TWO_ORDERS, "the second order differs",
     "leading order alone"),
    ("a limit at fixed z", _every, ROOTS, _of_profile(PROFILE), AT_Z, "there is no layer",
     "leading order alone"),
    ("another limit", _every, ROOTS, _of_profile(PROFILE), AS_IT_IS, "both grow, and part",
     "not with the sign"),
    ("a root of one and none of the other", _every, ROOTS, _mean(PROFILE), LARGE,
     "it goes as M σ", "not about roots"),
    ("another power of the profile", _every, ROOTS, _mean(power(PROFILE, Rational(3, 2))), LARGE,
     "it goes as M σ", "not about roots"),
    ("no root of the variance", _every, OVER, _of_profile(PROFILE), LARGE, "it goes as M²",
     "not about roots"),
    ("0/0", _every, ROOTS, _of_profile(times(PROFILE, 2 * z - 1, Pow(2 * z - 1, -1))), LARGE,
     "0/0 at z = ½", "may be negative"),
    ("a large base", lambda: _edge(M**6), ROOTS, _of_profile(PROFILE), LARGE, "it goes as M² σ",
     "the rest is of order 6"),
    ("layers that are large", lambda: _inside((M - j) ** 2 + M * j), ROOTS, _of_profile(PROFILE),
     LARGE, "it is larger", "the rest is of order 2"),
    ("layers that are large far from the surface", lambda: _inside((M - j) ** 2 + j**4 / (M - j)),
     ROOTS, _of_profile(PROFILE), LARGE, "as M³ there", "the rest is of order 4"),
    ("an index that may be large", lambda: _inside((M - j) ** 2 + l * M), ROOTS,
     _of_profile(PROFILE), LARGE.also(indices=(k, l)), "l may grow", "neither grows"),
):  # fmt: skip

    @attack("mean_of_roots", tried, false, refused)
    def _(
        layers: Premises = several, left: Expr = left, right: Expr = right, where: Where = where
    ) -> object:
        found = layers()
        every = found if isinstance(found, tuple) else (found,)
        return told(averages.mean_of_roots(*every), left, right, where)


@attack("mean_of_roots", "layers that are only supposed", "nothing is proved", "supposed")
def _() -> object:
    mean = told(averages.mean_of_roots(*_edge(M**2)), ROOTS, _of_profile(PROFILE), LARGE)
    if mean.supposed:
        raise NotProvedError("it rests on what is supposed")
    return mean


# Gaussian forces

TENSILE = over_layers(Tensile(1 + m * AT_M))
FORCE_VARIANCE = over_layers(Variance(1 + m * AT_M))
RATIO = M / UnitHeight(FORCE_VARIANCE)


@cache
def _forces(mean: int = 1) -> Theorem:
    return told(statistics.moment(), Variance(mean + j * HERE), j**2 * VARIANCE, LAYERS)


@cache
def _ones(mean: int = 1) -> Theorem:
    return told(statistics.moment(), Mean(mean + j * HERE), mean, LAYERS)


@cache
def _force_height(where: Where = AS_IT_IS) -> Theorem:
    exact = told(
        averages.total(_forces()), FORCE_VARIANCE, (M - 1) * (2 * M - 1) * VARIANCE / 6, HEIGHTS
    )
    order = told(averages.expansion(exact), FORCE_VARIANCE, M**2 * VARIANCE / 3, LARGE)
    return told(averages.unit_height(order), UnitHeight(FORCE_VARIANCE), IS_ONE, where)


@cache
def _below() -> Theorem:
    return averages.density(GAUSSIAN_BELOW, Where())


ARGUMENT = 1 / (sqrt(6) * z * RATIO)
AT_RATIO = HEIGHTS.in_the_limit(AT_FIXED_RATIO)


def _half(function: Expr) -> Integral:
    return _mean(times(S.Half, function))


def _error(argument: Expr) -> Expr:
    return erfc(argument, evaluate=False)


def _tensile(
    left: Expr = TENSILE,
    right: Expr | None = None,
    where: Where = AT_RATIO,
    means: Theorem | None = None,
    height: Theorem | None = None,
    below: Theorem | None = None,
    of: int = 1,
) -> Theorem:
    rule = averages.tensile(
        below or _below(), height or _force_height(), [_forces(of)], [means or _ones()]
    )
    return told(rule, left, _half(_error(ARGUMENT)) if right is None else right, where)


def _mirrored_height() -> Theorem:
    true = _force_height()
    return made(true.formula, true.where.loaded(SURFACE), true.rule, (true,))


for tried, how, false, refused in (
    ("another factor in erfc", {"right": _half(_error(2 * ARGUMENT))}, "it is less",
     "the rest is of order 2"),
    ("a negative argument", {"right": _half(_error(-ARGUMENT))}, "it is above ½",
     "not shown to be positive"),
    ("another factor before erfc", {"right": _mean(_error(ARGUMENT))}, "it is half of it",
     "no mean of ½ erfc"),
    ("no erfc", {"right": _half(S.One)}, "it is less", "no mean of ½ erfc"),
    ("a square of erfc", {"right": _half(_error(ARGUMENT) ** 2)}, "it is less", "no mean of ½"),
    ("a fixed σ", {"where": HEIGHTS.in_the_limit(at_large_height("="))}, "all go to ½",
     "not about tensile forces at fixed"),
    ("twice the probability", {"left": over_layers(2 * Tensile(1 + m * AT_M))},
     "it is twice that", "not about tensile forces"),
    ("another mean", {"means": "two", "left": over_layers(Tensile(2 + m * AT_M)), "of": 2},
     "two are farther from zero", "the mean is not one"),
    ("σ in the argument", {"right": _half(_error(1 / (sqrt(2) * M * sigma * z)))},
     "it is not about M/M*", "more than M/M*"),
    ("a variance of two orders", {"right": _half(_error(1 / sqrt(
        2 * (3 * z**2 * RATIO**2 + 1))))}, "it is less", "no power of M"),
    ("the height of another packing", {"height": "other"}, "another M*", "of another load"),
    ("another probability", {"below": "other"}, "it is not Gaussian", "not about Gaussian"),
    ("0/0 in the argument", {"right": _half(_error(times(
        ARGUMENT, (1 + times(2 * z - 1, Pow(2 * z - 1, -1))) / 2)))}, "0/0 at z = ½",
     "not shown to differ"),
):  # fmt: skip

    @attack("tensile", tried, false, refused)
    def _(how: dict[str, Any] = how) -> object:
        made_of = {"two": lambda: _ones(2), "other": _mirrored_height}
        given: dict[str, Any] = {
            name: made_of[one]() if name in ("means", "height") else one
            for name, one in how.items()
            if name != "below"
        }
        if "below" in how:
            given["below"] = only_supposed(S.One, S.One, Where())
        return _tensile(**given)


@attack("tensile", "the assumption forgotten", "forces may be others", "assuming Gaussian forces")
def _() -> object:
    found = _tensile()
    if found.assuming == {GAUSSIAN_FORCES}:
        raise NotProvedError("it is proved assuming Gaussian forces")
    return found


@attack("tensile", "layers that are only supposed", "nothing is proved", "supposed")
def _() -> object:
    layers = only_supposed(Variance(1 + j * HERE), j**2 * VARIANCE, LAYERS)
    rule = averages.tensile(_below(), _force_height(), [layers], [_ones()])
    found = told(rule, TENSILE, _half(_error(ARGUMENT)), AT_RATIO)
    if found.supposed:
        raise NotProvedError("it rests on what is supposed")
    return found


BELOW, DENSITY = GAUSSIAN_BELOW.args
LEAP = sympy.Piecewise((0, FORCE < 0), (1, True))

for tried, left, right, false, refused in (
    ("another factor", BELOW, 2 * DENSITY, "it is half of it", "the derivatives differ"),
    ("another sign", BELOW, -DENSITY, "a density is positive", "not shown to be positive"),
    ("another exponent", BELOW, sympy.exp(-((1 - FORCE) ** 2) / SQUARE) / sqrt(
        2 * sympy.pi * SQUARE), "it is too narrow", "the derivatives differ"),
    ("0/0 in the exponent", BELOW, sympy.exp(times(-(terms(1, -FORCE) ** 2) / (2 * SQUARE),
        terms(1, -FORCE), Pow(terms(1, -FORCE), -1))) / sqrt(2 * sympy.pi * SQUARE),
     "0/0 at f = 1", "not shown to be positive"),
    ("0/0 beside it", BELOW, times(DENSITY, SQUARE - 1, Pow(SQUARE - 1, -1)), "0/0 at v = 1",
     "not shown to be positive"),
    ("a root of what may be negative", BELOW, times(
        DENSITY, Pow(SQUARE - 1, S.Half), Pow(SQUARE - 1, -S.Half)), "v may be ½",
     "not shown to be positive"),
    ("what SymPy takes off", BELOW, times(DENSITY, terms(1, LEAP, -LEAP)), "it is another case",
     "is not read here"),
    ("a step", Derivative(BELOW.expr + LEAP, FORCE), DENSITY,
     "it has no slope at f = 0", "the left-hand side is another one"),
):  # fmt: skip

    @attack("density", tried, false, refused)
    def _(left: Expr = left, right: Expr = right) -> object:
        return averages.density(equation(left, right), Where())


# what is supposed stays supposed; other packings; too many names


def _proved(theorem: Theorem) -> Theorem:
    if theorem.supposed:
        raise NotProvedError("it rests on what is supposed")
    return theorem


@attack("proportional", "an order that is only supposed", "nothing is proved", "supposed")
def _() -> object:
    order = only_supposed(OVER, M**4 * VARIANCE, LARGE)
    right = M**2 * sigma
    return _proved(told(averages.proportional(order), ROOT_OVER, right, IN_PROPORTION))


@attack("unit_height", "an order that is only supposed", "nothing is proved", "supposed")
def _() -> object:
    order = only_supposed(OVER, M**2 * VARIANCE, LARGE)
    return _proved(told(averages.unit_height(order), UNIT, 1 / sigma, AS_IT_IS))


@attack("integral", "a slope that is only supposed", "nothing is proved", "supposed")
def _() -> object:
    slope = only_supposed(Derivative(2 * z, z), S.One, Where())
    return _proved(told(averages.integral(slope), _mean(S.One), 2, Where()))


@attack("proportional", "the height of a packing in space", "nothing is known", "another packing")
def _() -> object:
    where = replace(IN_PROPORTION, dimension=3)
    return told(averages.proportional(_height()), UNIT, 1 / sigma, where)


@attack("expansion", "more harmonic sums than have names", "they count", "too many harmonic")
def _() -> object:
    every = sum((Sum(1 / n, (n, first, M + 9)) for first in range(1, 9)), S.Zero)
    return told(averages.expansion(), M + every, M, LARGE)
