"""Rules about averages over the layers of a packing, and about what they go to as it grows.

What is proved in a limit is used by rules of limits alone, and never at finite size.
"""

from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from functools import cache
from math import lcm
from operator import mul

import sympy

from .. import symbols as sy
from ..algebra.exact import (
    FIELD,
    UNKNOWNS,
    Domain,
    RationalFunction,
)
from ..algebra.signs import sign
from ..as_printed import equation, in_place
from ..notation import by_name
from ..printing.text import text
from .axioms import GAUSSIAN_BELOW, GAUSSIAN_FORCES
from .limits import FIXED, even, leading, limit_of, order
from .rules import Rule
from .sums import Sums, layer_by_layer
from .surds import surd
from .theorem import NotProvedError, Theorem, applies, check, made
from .where import AT_FIXED_RATIO, Limit, Where

_HALF = sympy.S.Half
_NOTHING = sympy.S.Zero


def total(*layers: Theorem) -> Rule:
    """A sum over consecutive layers, from what is known of each: none missing, none met twice."""

    def rule(formula: sympy.Eq, where: Where) -> Theorem:
        check(formula, where)
        sums = Sums(where)
        (series,) = _only(sympy.Sum, formula.lhs)
        value, used = sums.layers(series, layers)
        sums.known[series] = value
        if not (sums.read(formula.lhs) - sums.read(formula.rhs)).is_zero():
            raise NotProvedError("the sum over the layers is another one")
        return made(formula, where, "total", used)

    return rule


def _only(kind: type, side: sympy.Expr) -> list[sympy.Expr]:
    found = list(side.atoms(kind))
    if len(found) != 1:
        raise NotProvedError(f"the left-hand side holds {len(found)} of {kind.__name__}, not one")
    return found


def expansion(*exact: Theorem) -> Rule:
    """The leading orders of what is known at finite size, as many as the limit says are the same.

    Harmonic sums are bounded by the number of their terms, and must count for less.
    """

    def rule(formula: sympy.Eq, where: Where) -> Theorem:
        limit = limit_of(formula, where, "∼")
        sums = Sums(where.in_the_limit(None))
        known = _put_in(formula, exact, sums)
        left, right = (_fixed_but(sums.read(side), limit, sums.lengths) for side in known.args)
        rest = left - right
        low, high = _bound(rest, limit, sums), order(right, limit)
        if any(map(right.holds, sums.lengths)):
            raise NotProvedError("the right-hand side is not shown to be of one order")
        if not low <= high - limit.orders:
            raise NotProvedError(f"left less right is of order {low}, the right-hand side {high}")
        if not even(FIELD.one / right, limit):
            raise NotProvedError("what the right-hand side goes as may vanish")
        return made(formula, where, "leading orders", exact)

    return rule


def _put_in(formula: sympy.Eq, exact: Sequence[Theorem], sums: Sums) -> sympy.Eq:
    """Names for left-hand sides of theorems that hold on all of the domain, at finite size."""
    image = {}
    for one in exact:
        if not applies(one, {s: s for s in one.indices}, sums.where, ()):
            raise NotProvedError("what is put in does not hold on all of the domain")
        image[one.formula.lhs] = sympy.Dummy()
        sums.known[image[one.formula.lhs]] = sums.read(one.formula.rhs)
    return equation(*(side.xreplace(image) for side in formula.args))


def _fixed_but(
    value: RationalFunction, limit: Limit, names: Iterable[sympy.Symbol] = ()
) -> RationalFunction:
    """The same, if all but what grows is fixed."""
    known = {*FIXED, *limit.growing, *names}
    for one in FIELD.generators:
        if value.holds(one) and one not in known:
            raise NotProvedError(f"{text(one)} neither grows nor is fixed")
    return value.reduced()


def _bound(value: RationalFunction, limit: Limit, sums: Sums) -> int:
    """A power with which it grows at most, each harmonic sum being at most its number of terms."""
    grows = [0] * len(FIELD.generators)
    for one in limit.growing:
        grows[FIELD.position[one]] = 1
    for name, length in sums.lengths.items():
        value.degree(name)  # refuses what stands below
        grows[FIELD.position[name]] = max(order(length, limit), 0)
    if value.is_zero():
        return order(value, limit)
    above, below = (
        max(sum(map(mul, grows, map(int, powers))) for powers in side.to_dict())
        for side in (value.numerator, value.denominator)
    )
    power: int = above - below
    return power


# powers of what is positive

Read = Callable[[sympy.Expr], RationalFunction]

_read = FIELD.from_sympy


def _power(node: sympy.Expr, exponent: sympy.Rational, read: Read) -> RationalFunction:
    """A power of a product of powers. Roots are taken of what is positive, and of nothing else."""
    if isinstance(node, sympy.Mul):
        product = FIELD.one
        for factor in node.args:
            product = product * _power(factor, exponent, read)
        return product
    if isinstance(node, sympy.Pow) and node.exp.is_Rational:
        if not node.exp.is_Integer and not _is_positive(node.base, read):
            raise NotProvedError(f"{text(node.base)}, of which a root is taken, may be negative")
        return _power(node.base, exponent * node.exp, read)
    if not exponent.is_Integer:
        raise NotProvedError(f"a root of {text(node)} is left")
    return read(node) ** int(exponent)


def _is_positive(node: sympy.Expr, read: Read) -> bool:
    if isinstance(node, sympy.Mul):
        return all(_is_positive(one, read) for one in node.args)
    if isinstance(node, sympy.Pow) and node.exp.is_Rational:
        return _is_positive(node.base, read)
    return sign(read(node).to_sympy()) == 1


def _roots(*sides: sympy.Expr) -> sympy.Integer:
    """The lowest whole power of which nothing holds a root."""
    powers = (one.exp for side in sides for one in side.atoms(sympy.Pow))
    return sympy.Integer(lcm(*(int(one.q) for one in powers if one.is_Rational)))


def _gathered(node: sympy.Expr) -> sympy.Expr:
    """The same, a root that is a factor of all terms of a sum taken out of it."""
    if not isinstance(node, sympy.Add | sympy.Mul | sympy.Pow):
        return node
    args = list(map(_gathered, node.args))
    if isinstance(node, sympy.Add):
        parts = [_root_and_rest(term) for term in args]
        root = parts[0][0]
        if root and all(one == root for one, _ in parts):
            powers = (sympy.Pow(base, e, evaluate=False) for base, e in root.items())
            rest = sympy.Add(*(one for _, one in parts), evaluate=False)
            return sympy.Mul(*powers, rest, evaluate=False)
    return node.func(*args, evaluate=False)


def _root_and_rest(term: sympy.Expr) -> tuple[dict[sympy.Expr, sympy.Rational], sympy.Expr]:
    """Bases and exponents between 0 and 1 of the roots in a product, and what else is in it."""
    powers: Counter[sympy.Expr] = Counter()
    factors = [term]
    while factors:
        one = factors.pop()
        if isinstance(one, sympy.Mul):
            factors += one.args
        else:
            base, exponent = one.args if isinstance(one, sympy.Pow) else (one, sympy.S.One)
            powers[base] += exponent
    roots = {base: e % 1 for base, e in powers.items() if e % 1}
    wholes = (sympy.Pow(base, e - e % 1, evaluate=False) for base, e in powers.items())
    return roots, sympy.Mul(*wholes, evaluate=False)


def proportional(*facts: Theorem) -> Rule:
    """Left over right goes to a positive number that depends on φ alone.

    Each side is a product of powers, of which only leading parts are kept; these vanish nowhere.
    ``facts`` are the leading orders of what stands on the left, or heights.
    """

    def rule(formula: sympy.Eq, where: Where) -> Theorem:
        known = _heights(formula, facts, where)
        limit = limit_of(known, where, "∝")
        if known is not formula and known.has(sy.M):
            raise NotProvedError("M is the height of a packing, and stands in what a height is")
        sums = Sums(where.in_the_limit(None))
        image = {}
        for one in facts:
            of = one.where.limit
            if of and of.relation == "∼" and one.where.in_the_limit(limit) == where:
                about, value = one.formula.args
                image[about] = sympy.Dummy()
                sums.known[image[about]] = sums.read(value)
        sides = [_gathered(side.xreplace(image)) for side in known.args]

        @cache
        def read(node: sympy.Expr) -> RationalFunction:
            return leading(_fixed_but(sums.read(node), limit), limit)

        if not all(_is_positive(side, read) for side in sides):
            raise NotProvedError("a side is not shown to be positive")
        left, right = (_power(side, _roots(*sides), read) for side in sides)
        ratio = (left / right).reduced()
        for one in FIELD.generators:
            if ratio.holds(one) and one not in (sy.phi, sy.n_x, sy.n_y):
                raise NotProvedError(f"left over right depends on {text(one)}")
        return made(formula, where, "proportional", facts)

    return rule


# the height at which a leading order is one


def unit_height(order_of: Theorem) -> Rule:
    """The height M at which the leading order of a quantity is one: a definition, and what it is.

    ``order_of`` says that the quantity goes as c M^p: with c > 0, p ≥ 1 there is one such height.
    """

    def rule(formula: sympy.Eq, where: Where) -> Theorem:
        height, value = formula.args
        limit = limit_of(equation(order_of.formula.lhs, value), where, "=")
        of = order_of.where.limit
        if of is None or (of.relation, of.growing) != ("∼", limit.growing):
            raise NotProvedError("the leading order is one of another limit")
        if order_of.where.in_the_limit(limit) != where:
            raise NotProvedError("the leading order is one of another packing")
        if height != sy.UnitHeight(order_of.formula.lhs):
            raise NotProvedError("it is not the height that is defined by this leading order")
        first = leading(_read(order_of.formula.rhs), limit)
        grows = order(first, limit)
        scale = first / FIELD.generator(sy.M) ** grows
        if grows < 1:
            raise NotProvedError("there is not one height at which the leading order is one")
        if not _is_positive(value, _read):
            raise NotProvedError("a height is positive")
        number = _roots(value)
        there = _power(value, number * grows, _read) * scale ** int(number)
        if not (there - FIELD.one).is_zero():
            raise NotProvedError("the leading order is not one there")
        return made(formula, where, "definition of a height", (order_of,))

    return rule


def _heights(formula: sympy.Eq, facts: Sequence[Theorem], where: Where) -> sympy.Eq:
    """An equation with heights put in."""
    if not formula.has(sy.UnitHeight):
        return formula
    image = {}
    for one in facts:
        if isinstance(one.formula.lhs, sy.UnitHeight) and one.where.limit is not None:
            if one.where.loading != where.loading or one.where.dimension != where.dimension:
                raise NotProvedError("the height is one of another packing")
            image[one.formula.lhs] = one.formula.rhs
    return equation(*(side.xreplace(image) for side in formula.args))


def restated(theorem: Theorem, *heights: Theorem) -> Rule:
    """What a theorem in a limit says, its right-hand side written in another way."""

    def rule(formula: sympy.Eq, where: Where) -> Theorem:
        known = _heights(formula, heights, where)
        limit_of(known, where, theorem.where.limit.relation if theorem.where.limit else "")
        if theorem.where != where or known.lhs != theorem.formula.lhs:
            raise NotProvedError("the theorem is about something else")
        image = {sy.z: sy.j / sy.M} if sy.j in where.indices else {}
        sides = (
            _power(side.xreplace(image), sympy.S.One, _read)
            for side in (known.rhs, theorem.formula.rhs)
        )
        if not _same(*sides):
            raise NotProvedError("the right-hand side is another one")
        return made(formula, where, "restated", (theorem, *heights))

    return rule


def _same(left: RationalFunction, right: RationalFunction) -> bool:
    return (left - right).is_zero()


# integrals over 0 < z < 1


def integral(*slopes: Theorem) -> Rule:
    """A mean over 0 < z < 1: of a polynomial, or of what an antiderivative is known of.

    ``slopes`` are theorems d/dz F = f. The integrand is f times a positive number.
    """

    def rule(formula: sympy.Eq, where: Where) -> Theorem:
        (average,) = _only(sympy.Integral, formula.lhs)
        inside = _integrand(average)
        if any(side.xreplace({average: _NOTHING}).has(sy.z) for side in formula.args):
            raise NotProvedError("z is averaged over, and stands for itself as well")
        check(equation(inside, _NOTHING), where)
        check(equation(formula.lhs.xreplace({average: _NOTHING}), formula.rhs), where)
        if not slopes:
            value = _mean(_read(inside)).to_sympy()
            left, right = map(_read, (formula.lhs.xreplace({average: value}), formula.rhs))
            if not _same(left, right):
                raise NotProvedError("the integral is another one")
        elif formula.lhs != average or surd(formula.rhs) != _by_antiderivative(inside, slopes):
            raise NotProvedError("the integral is another one")
        return made(formula, where, "integral", slopes)

    return rule


def _integrand(average: sympy.Integral) -> sympy.Expr:
    if average.limits != (sympy.Tuple(sy.z, 0, 1),):
        raise NotProvedError("it is no mean over 0 < z < 1")
    inside: sympy.Expr = average.function
    return inside


def _mean(profile: RationalFunction) -> RationalFunction:
    """zⁿ gives 1/(n + 1)."""
    found = FIELD.zero
    for degree, coefficient in enumerate(profile.coefficients(sy.z)):
        found = found + coefficient / FIELD.constant(degree + 1)
    return found


def _by_antiderivative(inside: sympy.Expr, slopes: Sequence[Theorem]) -> dict[int, sympy.Rational]:
    """c (F(1) − F(0)) for d/dz F = f and the integrand c f, c > 0.

    F, made of powers, is continuous inside, where f has a value, and at an end where it has one.
    """
    for one in slopes:
        slope, f = one.formula.args
        if not isinstance(slope, sympy.Derivative) or slope.variables != (sy.z,):
            raise NotProvedError("an antiderivative is of another variable")
        square = _power(inside, sympy.Integer(2), _read) / _power(f, sympy.Integer(2), _read)
        c = square.to_sympy()
        if not (c.is_Rational and _is_positive(inside, _read) and _is_positive(f, _read)):
            continue
        parts = sympy.preorder_traversal(slope.expr)
        if not all(part == sy.z or isinstance(part, _ALGEBRAIC) for part in parts):
            raise NotProvedError("the antiderivative may not be continuous")
        ends = [slope.expr.xreplace({sy.z: sympy.Integer(at)}) for at in (1, 0)]
        return surd(sympy.sqrt(c) * (ends[0] - ends[1]))
    raise NotProvedError("no antiderivative is known of it")


_ALGEBRAIC = (sympy.Add, sympy.Mul, sympy.Pow, sympy.Rational)


# limits of sums over the layers


def mean_of_roots(*layers: Theorem) -> Rule:
    """(1/M) Σ √variance goes as the integral of the root of a profile, M → ∞.

    Variance and profile differ by at most C M^p in every layer, edges included, p below the power
    of M in the profile. So their roots differ by √(C M^p) at most. The rest is a Riemann sum of a
    function that is continuous on 0 ≤ z ≤ 1.
    """

    def rule(formula: sympy.Eq, where: Where) -> Theorem:
        series, term, inside = _riemann(formula, where)
        roots = [one for one in (term, inside) if isinstance(one, sympy.Pow) and one.exp == _HALF]
        if len(roots) != 2:
            raise NotProvedError("it is not about roots")
        squared = sympy.Sum(term.base, *series.limits)
        check(equation(inside, _NOTHING), where.in_the_limit(None))
        _close(squared, layers, _read(inside.base), where)
        return made(formula, where, "limit of Riemann sums", layers)

    return rule


def _riemann(formula: sympy.Eq, where: Where) -> tuple[sympy.Sum, sympy.Expr, sympy.Expr]:
    """A mean over the layers 0 ≤ j < M that goes to one over 0 < z < 1: sum, term, integrand."""
    side, average = formula.args
    relation = "=" if side.has(sy.Tensile) else "∼"
    limit = limit_of(equation(side.replace(sy.Tensile, sy.Variance), _NOTHING), where, relation)
    (series,) = _only(sympy.Sum, side)
    ((_, low, high),) = series.limits
    if side != series / sy.M or (low, high) != (0, sy.M - 1):
        raise NotProvedError("the left-hand side is no mean over the layers 0 ≤ j < M")
    if not isinstance(average, sympy.Integral):
        raise NotProvedError("the right-hand side is no mean over 0 < z < 1")
    if limit.orders != 1 or limit.growing != (sy.M,):
        raise NotProvedError("the leading order alone is known, M → ∞")
    return series, series.function, _integrand(average)


def _close(
    series: sympy.Sum, layers: Sequence[Theorem], profile: RationalFunction, where: Where
) -> list[Theorem]:
    """Check that the terms differ from a profile at z = j/M by a lower order, in all layers alike.

    Raises:
        NotProvedError: the orders are the same; the profile is no power of M times a function of z.
    """
    index, limit, finite = series.limits[0][0], where.limit, where.in_the_limit(None)
    assert limit is not None
    grows = order(profile, limit)
    if (profile / FIELD.generator(sy.M) ** grows).reduced().holds(sy.M):
        raise NotProvedError("the profile is no power of M times a function of z")
    at_layer = _read(profile.to_sympy().xreplace({sy.z: index / sy.M}))
    used = []
    for first, last, theorem in layer_by_layer(series, layers, finite):
        used.append(theorem)
        apart = Sums(finite).read(theorem.formula.rhs) - at_layer
        apart = _fixed_but(apart, limit, [index])
        if first == last:
            apart = apart.substitute({index: _read(first)})
            found = order(apart, limit)
        else:
            found = _uniform(apart, index)
        if not found < grows:
            raise NotProvedError(f"in layer {text(first)} the rest is of order {found}")
    return used


def tensile(
    probability: Theorem, height: Theorem, layers: Sequence[Theorem], means: Sequence[Theorem]
) -> Rule:
    """The mean over the layers of P(f < 0), M → ∞ at fixed M/M*. It assumes Gaussian forces.

    The integrand is ½ erfc A. With 1/2A² for the variance at z, which holds M/M* and z alone, the
    rest goes as in ``mean_of_roots``: erfc(1/√(2v)) is uniformly continuous in v ≥ 0, and the rest
    of the variance is of a lower order than what is fixed with M/M*.

    Args:
        probability: the Gaussian probability that a force over its mean is below f.
        height: what M* is.
        layers: the variances.
        means: that the mean of a force over its mean is one.
    """

    def rule(formula: sympy.Eq, where: Where) -> Theorem:
        series, term, inside = _riemann(formula, where)
        if where.limit != AT_FIXED_RATIO or not isinstance(term, sy.Tensile):
            raise NotProvedError("it is not about tensile forces at fixed M/M*")
        if probability.formula != GAUSSIAN_BELOW or height.where.loading != where.loading:
            raise NotProvedError("it is not about Gaussian forces, or of another load")
        half, function = inside.as_independent(sympy.erfc, as_Add=False)
        if half != _HALF or not isinstance(function, sympy.erfc):
            raise NotProvedError("it is no mean of ½ erfc")
        variances, ones = (
            sympy.Sum(kind(*term.args), *series.limits) for kind in (sy.Variance, sy.Mean)
        )
        finite = where.in_the_limit(None)
        for _, _, one in layer_by_layer(ones, means, finite):
            if one.formula.rhs != 1:
                raise NotProvedError("the mean is not one")
        about, value = height.formula.args
        inner = function.args[0]
        ratio = UNKNOWNS[0][0]
        two = sympy.Integer(2)
        alone = _power(inner.xreplace({about: ratio * sy.M}), two, _read)
        if any(alone.holds(one) for one in FIELD.generators if one not in (ratio, sy.z)):
            raise NotProvedError("it depends on more than M/M* and z")
        check(equation(in_place(inner, {about: sy.r}), _NOTHING), finite)  # any positive number
        known = inner.xreplace({about: value})
        if not _is_positive(known, _read):
            raise NotProvedError("the argument is not shown to be positive")
        profile = (FIELD.constant(2) * _power(known, two, _read)) ** -1
        used = _close(variances, layers, profile, where)
        premises = (probability, height, *used, *means)
        return made(formula, where, "Gaussian forces", premises, assuming=[GAUSSIAN_FORCES])

    return rule


def density(formula: sympy.Eq, where: Where) -> Theorem:
    """SymPy differentiates the left-hand side; factors and exponents of e are compared apart.

    That side is the printed one: no other has to be shown to have a slope.
    """
    slope, value = formula.args
    if slope != GAUSSIAN_BELOW.lhs:
        raise NotProvedError("the left-hand side is another one")
    circle = sympy.Dummy("pi", positive=True)
    _refuse_no_value(in_place(value, {sympy.pi: circle}))
    parts = []
    for side in (slope.doit(), value):
        factors = sympy.Mul.make_args(sympy.powsimp(side).xreplace({sympy.pi: circle}))
        exponents = [one.exp for one in factors if isinstance(one, sympy.exp)]
        scale = sympy.Mul(*(one for one in factors if not isinstance(one, sympy.exp)))
        if sign(scale) != 1:
            raise NotProvedError(f"{text(side)} is not shown to be positive")
        parts.append((scale**2, sympy.Add(*exponents)))
    domain = Domain(by_name(formula.free_symbols | {circle}))
    for one, other in zip(*parts, strict=True):
        if not (domain.from_sympy(one) - domain.from_sympy(other)).is_zero():
            raise NotProvedError("the derivatives differ")
    return made(formula, where, "differentiate")


def _refuse_no_value(node: sympy.Expr) -> None:
    """Refuse what may have no value, before SymPy cancels it."""
    if not (isinstance(node, (*_ALGEBRAIC, sympy.exp)) or node.is_Symbol):
        raise NotProvedError(f"{type(node).__name__} is not read here")
    if isinstance(node, sympy.Pow) and not (node.exp.is_Integer and node.exp > 0):
        may_be_negative = node.exp.is_Integer and sign(node.base)
        if not (may_be_negative or sign(node.base) == 1):
            raise NotProvedError(f"{text(node.base)} is not shown to be positive")
    for one in node.args:
        _refuse_no_value(one)


def _uniform(value: RationalFunction, index: sympy.Symbol) -> int:
    """A power p such that |value| ≤ C M^p in all layers 0 ≤ j < M.

    A term j^a k^b/k^c with k = M − j ≥ 1 is at most M^(a + max(b − c, 0)). What else is below is a
    product of whole numbers and of functions of φ that vanish nowhere.
    """
    k = FIELD.generator(sy.k)
    inside = value.substitute({sy.M: FIELD.generator(index) + k})
    places = FIELD.position[index], FIELD.position[sy.k]
    above, below = (
        [tuple(int(one[place]) for place in places) for one in side.to_dict()]
        for side in (inside.numerator, inside.denominator)
    )
    under = below[0][1] if len({*below}) == 1 else 0
    return max((a + max(b - under, 0) for a, b in above), default=-(10**9))
