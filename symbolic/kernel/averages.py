"""Rules about averages over the layers of a packing, and about what they go to as it grows.

What is proved in a limit is used by rules of limits alone, and never at finite size.
"""

from collections.abc import Callable, Sequence
from math import lcm

import sympy
from force_diffusion.symbolic import symbols as sy
from force_diffusion.symbolic.algebra.exact import (
    FIELD,
    UNKNOWNS,
    Domain,
    RationalFunction,
)
from force_diffusion.symbolic.algebra.signs import sign
from force_diffusion.symbolic.as_printed import equation
from force_diffusion.symbolic.kernel.axioms import GAUSSIAN_BELOW, GAUSSIAN_FORCES
from force_diffusion.symbolic.kernel.limits import FIXED, even, leading, limit_of, order
from force_diffusion.symbolic.kernel.rules import Rule
from force_diffusion.symbolic.kernel.sums import Sums, layer_by_layer
from force_diffusion.symbolic.kernel.surds import surd
from force_diffusion.symbolic.kernel.theorem import NotProvedError, Theorem, applies, check, made
from force_diffusion.symbolic.kernel.where import AT_FIXED_RATIO, Limit, Where
from force_diffusion.symbolic.notation import by_name
from force_diffusion.symbolic.printing.text import text

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
        left, right = (_fixed_but(sums.read(side), limit, sums) for side in known.args)
        rest = left - right
        low, high = _bound(rest, limit, sums), order(right, limit)
        if any(map(right.holds, sums.lengths)):
            raise NotProvedError("the right-hand side is not shown to be of one order")
        if not low <= high - limit.orders:
            raise NotProvedError(f"left less right is of order {low}, the right-hand side {high}")
        if not all(even(one, limit) for one in (rest, right, FIELD.one / right)):
            raise NotProvedError("the orders are not shown to hold everywhere")
        return made(formula, where, "leading orders", exact)

    return rule


def _put_in(formula: sympy.Eq, exact: Sequence[Theorem], sums: Sums) -> sympy.Eq:
    """Names for left-hand sides of theorems that hold on all of the domain, at finite size."""
    bound = {limit[0] for one in formula.atoms(sympy.Sum) for limit in one.limits}
    image = {}
    for one in exact:
        about, value = one.formula.args
        if bound & one.formula.free_symbols:
            raise NotProvedError("an index of a sum would have two meanings")
        if not applies(one, {s: s for s in one.indices}, sums.where, ()):
            raise NotProvedError("what is put in does not hold on all of the domain")
        image[about] = sympy.Dummy()
        sums.known[image[about]] = sums.read(value)
    return equation(*(side.xreplace(image) for side in formula.args))


def _fixed_but(value: RationalFunction, limit: Limit, sums: Sums) -> RationalFunction:
    """The same, if all but what grows is fixed."""
    known = {*FIXED, *limit.growing, *sums.lengths}
    for one in FIELD.generators:
        if value.holds(one) and one not in known:
            raise NotProvedError(f"{text(one)} neither grows nor is fixed")
    return value.reduced()


def _bound(value: RationalFunction, limit: Limit, sums: Sums) -> int:
    """A power with which it grows at most, each harmonic sum being at most its number of terms."""
    names = sums.lengths
    if any(RationalFunction(FIELD, value.denominator, FIELD.one.numerator).holds(s) for s in names):
        raise NotProvedError("a harmonic sum stands in a divisor")
    found = [order(value.substitute(dict.fromkeys(names, FIELD.zero)), limit)]
    for name, length in names.items():
        without = value - value.substitute({name: FIELD.zero})
        found.append(order(without.substitute({name: length}), limit))
        if any(without.holds(other) for other in names if other != name):
            raise NotProvedError("a product of harmonic sums")
        if value.degree(name) > 1:
            raise NotProvedError("a power of a harmonic sum")
    return max(found)


# powers of what is positive

Read = Callable[[sympy.Expr], RationalFunction]


def _power(node: sympy.Expr, exponent: sympy.Rational, read: Read) -> RationalFunction:
    """A power of a product of powers. Roots are taken of what is positive, and of nothing else."""
    if isinstance(node, sympy.Mul):
        if not exponent.is_Integer and not all(_is_positive(one, read) for one in node.args):
            raise NotProvedError(f"the root of {text(node)} is not that of its factors")
        product = FIELD.one
        for factor in node.args:
            product = product * _power(factor, exponent, read)
        return product
    if isinstance(node, sympy.Pow) and node.exp.is_Rational:
        whole = exponent.is_Integer and node.exp.is_Integer
        if not whole and not _is_positive(node.base, read):
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


def proportional(*facts: Theorem) -> Rule:
    """Left over right goes to a positive number that depends on φ alone.

    Each side is a product of powers, of which only leading parts are kept; these vanish nowhere.
    Heights are put in as they are defined, averages as they are known at finite size.
    """

    def rule(formula: sympy.Eq, where: Where) -> Theorem:
        known = _heights(formula, facts, where)
        limit = limit_of(known, where, "∝")
        if known is not formula and known.has(sy.M):
            raise NotProvedError("M is the height of a packing, and stands in what a height is")
        sums = Sums(where.in_the_limit(None))
        known = _put_in(known, [one for one in facts if one.where.limit is None], sums)

        def read(node: sympy.Expr) -> RationalFunction:
            value = _fixed_but(sums.read(node), limit, sums)
            plain = value.substitute(dict.fromkeys(sums.lengths, FIELD.zero))
            if not _bound(value - plain, limit, sums) < order(plain, limit):
                raise NotProvedError("a harmonic sum is not shown to count for less")
            found = leading(plain, limit)
            if not sign(found.to_sympy()):
                raise NotProvedError(f"{text(found.to_sympy())} may vanish")
            return found

        if not all(_is_positive(side, read) for side in known.args):
            raise NotProvedError("a side is not shown to be positive")
        left, right = (_power(side, _roots(*known.args), read) for side in known.args)
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
        limit = limit_of(equation(order_of.formula.lhs, value), where, "∼")
        of = order_of.where.limit
        if of is None or (of.relation, of.growing) != (limit.relation, limit.growing):
            raise NotProvedError("the leading order is one of another limit")
        if order_of.where.in_the_limit(limit) != where:
            raise NotProvedError("the leading order is one of another packing")
        if height != sy.UnitHeight(order_of.formula.lhs):
            raise NotProvedError("it is not the height that is defined by this leading order")
        if strange := by_name(value.free_symbols - FIXED):
            raise NotProvedError(f"{text(strange[0])} is no parameter")
        first = leading(FIELD.from_sympy(order_of.formula.rhs), limit)
        grows = order(first, limit)
        scale = first / FIELD.generator(sy.M) ** grows
        if grows < 1 or scale.holds(sy.M) or sign(scale.to_sympy()) != 1:
            raise NotProvedError("there is not one height at which the leading order is one")
        read = FIELD.from_sympy
        if not _is_positive(value, read):
            raise NotProvedError("a height is positive")
        number = _roots(value)
        there = _power(value, number * grows, read) * scale ** int(number)
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
    known = equation(*(side.xreplace(image) for side in formula.args))
    if known.has(sy.UnitHeight):
        raise NotProvedError("a height is not known")
    return known


def restated(theorem: Theorem, *heights: Theorem) -> Rule:
    """What a theorem in a limit says, its right-hand side written in another way."""

    def rule(formula: sympy.Eq, where: Where) -> Theorem:
        known = _heights(formula, heights, where)
        limit_of(known, where, theorem.where.limit.relation if theorem.where.limit else "")
        if theorem.where != where or known.lhs != theorem.formula.lhs:
            raise NotProvedError("the theorem is about something else")
        image = {sy.z: sy.j / sy.M} if sy.j in where.indices else {}
        sides = (
            _power(side.xreplace(image), sympy.S.One, FIELD.from_sympy)
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
        if formula.xreplace({average: _NOTHING}).has(sy.z):
            raise NotProvedError("z is averaged over, and stands for itself as well")
        check(equation(inside, _NOTHING), where)
        check(equation(formula.lhs.xreplace({average: _NOTHING}), formula.rhs), where)
        if not slopes:
            value = _mean(FIELD.from_sympy(inside)).to_sympy()
            left, right = map(
                FIELD.from_sympy, (formula.lhs.xreplace({average: value}), formula.rhs)
            )
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
    """c (F(1) − F(0)) for d/dz F = f and the integrand c f, c > 0; F is continuous at both ends."""
    for one in slopes:
        slope, f = one.formula.args
        if not isinstance(slope, sympy.Derivative) or slope.variables != (sy.z,):
            raise NotProvedError("an antiderivative is of another variable")
        square = _power(inside, sympy.Integer(2), _read) / _power(f, sympy.Integer(2), _read)
        c = square.to_sympy()
        if not (c.is_Rational and _is_positive(inside, _read) and _is_positive(f, _read)):
            continue
        if not _continues(slope.expr):
            raise NotProvedError("the antiderivative may not be continuous")
        ends = [slope.expr.xreplace({sy.z: sympy.Integer(at)}) for at in (1, 0)]
        return surd(sympy.sqrt(c) * (ends[0] - ends[1]))
    raise NotProvedError("no antiderivative is known of it")


_read = FIELD.from_sympy


def _continues(node: sympy.Expr) -> bool:
    """Whether it is continuous on 0 ≤ z ≤ 1: whole powers, and roots of what is positive inside."""
    if isinstance(node, sympy.Add | sympy.Mul):
        return all(map(_continues, node.args))
    if isinstance(node, sympy.Pow) and node.exp.is_Rational and node.exp.is_positive:
        ends = [node.base.xreplace({sy.z: sympy.Integer(at)}) for at in (0, 1)]
        rooted = sign(node.base) == 1 and all(one.is_nonnegative for one in ends)
        return _continues(node.base) and (bool(node.exp.is_Integer) or rooted)
    return node == sy.z or isinstance(node, sympy.Rational)


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
    limit = limit_of(equation(side.replace(sy.Tensile, sy.Variance), _NOTHING), where, "∼")
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
    series: sympy.Sum,
    layers: Sequence[Theorem],
    profile: RationalFunction,
    where: Where,
    each: sympy.Symbol | None = None,
) -> list[Theorem]:
    """Check that the terms differ from a profile at z = j/M by a lower order, in all layers alike.

    With ``each`` they are all in proportion to its square, which then need not be fixed.

    Inside of the packing a term j^a k^b/k^c with k = M − j ≥ 1 is at most M^(a + max(b − c, 0)).

    Raises:
        NotProvedError: the orders are the same; the profile is no power of M times a polynomial.
    """
    index = series.limits[0][0]
    finite = where.in_the_limit(None)
    limit = where.limit
    assert limit is not None
    grows = order(profile, limit)
    shape = (profile / FIELD.generator(sy.M) ** grows).reduced()
    if shape.holds(sy.M) or sign(shape.to_sympy()) != 1:
        raise NotProvedError("the profile is no power of M times what is positive")
    for one in FIELD.generators:
        if shape.holds(one) and one not in {*FIXED, sy.z}:
            raise NotProvedError(f"{text(one)} neither grows nor is fixed")
    shape.degree(sy.z)  # refuses what z stands below in
    at_layer = _read(profile.to_sympy().xreplace({sy.z: index / sy.M}))
    used = []
    for first, last, theorem in layer_by_layer(series, layers, finite):
        used.append(theorem)
        apart = Sums(finite).read(theorem.formula.rhs) - at_layer
        if each is not None and (apart / FIELD.generator(each) ** 2).holds(each):
            raise NotProvedError(f"the rest is not in proportion to the square of {text(each)}")
        if first == last:
            alone = _fixed_but(apart.substitute({index: _read(first)}), limit, Sums(finite))
            found = order(alone, limit)
            if not even(alone, limit):
                raise NotProvedError("the order is not shown to hold everywhere")
        else:
            found = _uniform(apart, index, limit, finite.within(index, first, last))
        if not found < grows:
            raise NotProvedError(f"in layer {text(first)} the rest is of order {found}")
    return used


def tensile(
    probability: Theorem, height: Theorem, layers: Sequence[Theorem], means: Sequence[Theorem]
) -> Rule:
    """The mean over the layers of P(f < 0), M → ∞ at fixed M/M*. It assumes Gaussian forces.

    The integrand is ½ erfc A. With 1/2A² for the variance at z, which holds M/M* and z alone, the
    rest goes as in ``mean_of_roots``: erfc(1/√(2v)) is continuous in v ≥ 0, and σ² M^p is fixed.

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
        known = inner.xreplace({about: value})
        if known.has(sy.UnitHeight) or not _is_positive(known, _read):
            raise NotProvedError("the argument is not shown to be positive")
        profile = (FIELD.constant(2) * _power(known, two, _read)) ** -1
        used = _close(variances, layers, profile, where, each=sy.sigma)
        premises = (probability, height, *used, *means)
        return made(formula, where, "Gaussian forces", premises, assuming=[GAUSSIAN_FORCES])

    return rule


def density(formula: sympy.Eq, where: Where) -> Theorem:
    """SymPy differentiates the left-hand side; factors and exponents of e are compared apart."""
    slope, value = formula.args
    circle = sympy.Dummy("pi", positive=True)
    if not isinstance(slope, sympy.Derivative) or where != Where():
        raise NotProvedError("it is no derivative")
    parts = []
    for side in (slope.doit(), value):
        factors = sympy.Mul.make_args(sympy.powsimp(side).xreplace({sympy.pi: circle}))
        exponents = [one.exp for one in factors if isinstance(one, sympy.exp)]
        scale = sympy.Mul(*(one for one in factors if not isinstance(one, sympy.exp)))
        divisors = (one.base for e in exponents for one in e.atoms(sympy.Pow) if one.exp < 0)
        if sign(scale) != 1 or not all(map(sign, divisors)):
            raise NotProvedError(f"{text(side)} is not shown to be positive")
        parts.append((scale**2, sympy.Add(*exponents)))
    domain = Domain(by_name(formula.free_symbols | {circle}))
    for one, other in zip(*parts, strict=True):
        if not (domain.from_sympy(one) - domain.from_sympy(other)).is_zero():
            raise NotProvedError("the derivatives differ")
    return made(formula, where, "differentiate")


def _uniform(value: RationalFunction, index: sympy.Symbol, limit: Limit, where: Where) -> int:
    """A power p such that |value| ≤ C M^p at all of the layers of a domain."""
    k = FIELD.generator(sy.k)
    if (
        value.holds(sy.k)
        or not where.implies(sympy.Ge(index, 0))
        or not (where.implies(sympy.Ge(sy.M - index, 1)))
    ):
        raise NotProvedError("a layer lies outside of the packing")
    inside = value.substitute({sy.M: FIELD.generator(index) + k})
    places = FIELD.position[index], FIELD.position[sy.k]
    below = [tuple(map(int, one)) for one in inside.denominator.to_dict()]
    if any(one[places[0]] for one in below) or len({one[places[1]] for one in below}) > 1:
        raise NotProvedError("a divisor holds more than a power of M − j")
    for one in FIELD.generators:
        if inside.holds(one) and one not in {*FIXED, index, sy.k}:
            raise NotProvedError(f"{text(one)} neither grows nor is fixed")
    under = below[0][places[1]]
    return max(
        int(one[places[0]]) + max(int(one[places[1]]) - under, 0)
        for one in inside.numerator.to_dict()
    )
