"""Averages over the layers of a packing: powers that they go as, and the share of negative forces.

Each side is a product of powers of what is positive. Of each base only the leading part counts.
"""

from collections.abc import Iterable, Iterator
from math import lcm

import sympy

from .. import symbols as sy
from ..algebra.exact import FIELD, NotProvedError, RationalFunction
from ..printing.text import text
from ..sets import EVERYTHING
from ..signs import sign
from ..trees import equation
from .axioms import GAUSSIAN_FORCES
from .domain import AT_FIXED_RATIO, Domain, at_fixed_height, at_large_height
from .limits import in_the_limit, leading, limit_of, order
from .refuted import other_ratio
from .rules import Rule
from .theorem import FalseStatementError, Group, Groups, Theorem, flat, made, read, with_indices

Power = tuple[RationalFunction, sympy.Rational]
"""A base, and its exponent."""


def power_law(*groups: Group) -> Rule:
    """Left over right goes to 1 ("="), or to a positive function of φ alone ("∝")."""

    def rule(formula: sympy.Eq, domain: Domain) -> Theorem:
        relation = domain.limit.relation if domain.limit else ""
        if relation not in ("=", "∝"):
            raise NotProvedError("it is not in a limit, or not with the sign = or ∝")
        limit = limit_of(formula, domain, relation)
        if limit != at_large_height(relation):
            raise NotProvedError("only what is fixed as M grows is read")
        if formula.rhs.as_coeff_Mul()[0].is_negative:
            rule(equation(formula.lhs, -formula.rhs), domain)
            raise FalseStatementError("left over right is negative")

        left, right = (list(_powers(side, domain, groups)) for side in formula.args)
        ratio, power = _whole_power([*left, *((base, -power) for base, power in right)])
        others = {*FIELD.generators} - {sy.phi, sy.n_x, sy.n_y}
        is_one = (ratio - FIELD.one).is_zero()
        if any(map(ratio.holds, others)) or (relation == "=" and not is_one):
            raise other_ratio(ratio, power, limit)
        return made(formula, domain, "comparing powers", flat(groups))

    return rule


def _powers(
    node: sympy.Expr, domain: Domain, groups: Groups, exponent: sympy.Rational = sympy.S.One
) -> Iterator[Power]:
    """The leading order of a side as powers of what is positive.

    Raises:
        NotProvedError: a base is not shown to be positive, or an exponent is not a number.
    """
    if isinstance(node, sympy.Mul):
        for factor in node.args:
            yield from _powers(factor, domain, groups, exponent)
        return
    if isinstance(node, sympy.Pow):
        if not isinstance(node.exp, sympy.Rational):
            raise NotProvedError(f"the exponent {text(node.exp)} is not a number")
        yield from _powers(node.base, domain, groups, exponent * node.exp)
        return
    limit, quantity = at_large_height("="), node
    if isinstance(node, sy.UnitHeight):
        (quantity,) = node.args
    value = leading(in_the_limit(quantity, domain.in_the_limit(limit), groups), limit)
    if isinstance(node, sy.UnitHeight):  # of a quantity that goes as c M^p
        power = order(value, limit)
        if power < 1 or value.holds(sy.H_M):
            raise NotProvedError("there is not one height at which the leading order is one")
        value, exponent = value / FIELD.generator(sy.M) ** power, -exponent / sympy.Integer(power)
    if sign(value, EVERYTHING) != 1:
        raise NotProvedError(f"{text(quantity)} is not shown to be positive")
    yield value, exponent


def _whole_power(powers: Iterable[Power]) -> tuple[RationalFunction, int]:
    """The lowest power of a product that holds no root, and which it is."""
    powers = tuple(powers)
    common = lcm(*(int(power.q) for _, power in powers))
    product = FIELD.one
    for base, power in powers:
        product = product * base ** int(common * power)
    return product.reduced(), common


def tensile(variance: Theorem, mean: Theorem, *groups: Group) -> Rule:
    """The mean over the layers of P(f < 0), for Gaussian forces of mean 1: ∫ ½ erfc(1/√(2v)) dz.

    ``variance`` says what v, the variance of a force over its mean, goes as at a fixed height z,
    ``mean`` that the mean of that force is 1.
    """

    def rule(formula: sympy.Eq, domain: Domain) -> Theorem:
        limit_of(formula, domain, "=")
        if domain.limit != AT_FIXED_RATIO or variance.domain.limit != at_fixed_height("∼"):
            raise NotProvedError("the limits are others than that of M at fixed M/M*")
        if not domain.loading == variance.domain.loading == mean.domain.loading:
            raise NotProvedError("the packings differ")
        relations = (*variance.domain.relations, *mean.domain.relations)
        named = set().union(*(each.free_symbols for each in relations))
        beads = {*variance.domain.beads, *mean.domain.beads}
        if not named <= {sy.j, sy.M} or not beads <= {(sy.i, sy.j)}:
            raise NotProvedError("the force depends on more than its layer")
        force = variance.formula.lhs.args[0]
        if variance.formula.lhs != sy.Variance(force) or mean.formula.args != (sy.Mean(force), 1):
            raise NotProvedError("they are not the variance and the mean of one force, 1")
        if mean.domain.limit is not None:
            raise NotProvedError("the mean is known in a limit")
        limit_of(mean.formula, mean.domain.in_the_limit(at_fixed_height("=")), "=")
        there = with_indices(equation(force, sympy.S.Zero), {sy.i: sy.m, sy.j: sy.m})
        within = sympy.Ge(sy.m, 0), sympy.Le(sy.m, sy.M - 1)
        read(there, Domain.of(*within, loading=domain.loading))  # it has a value in every layer
        each = sy.Tensile(there.lhs)
        if formula.lhs != sympy.Sum(each, (sy.m, 0, sy.M - 1)) / sy.M:
            raise NotProvedError("it is not about the mean over all layers of P(f < 0)")
        below = _powers(_argument(formula.rhs), domain, groups)
        v = FIELD.from_sympy(variance.formula.rhs) * FIELD.constant(2)
        if any(v.holds(index) for index in sy.INDICES if index != sy.M):
            raise NotProvedError("the variance is not said in terms of z and M")
        twice = [(base, 2 * power) for base, power in below]
        if not (_whole_power([*twice, (v, sympy.S.One)])[0] - FIELD.one).is_zero():
            raise NotProvedError("the argument of erfc is not 1/√(2v)")
        premises = (variance, mean, *flat(groups))
        return made(formula, domain, "a Gaussian integral", premises, assuming=(GAUSSIAN_FORCES,))

    return rule


def _argument(side: sympy.Expr) -> sympy.Expr:
    """x of ∫ ½ erfc(x) dz from 0 to 1."""
    if isinstance(side, sympy.Integral) and side.limits == (sympy.Tuple(sy.z, 0, 1),):
        half, other = side.function.as_coeff_Mul()
        if half == sympy.S.Half and isinstance(other, sympy.erfc):
            inside: sympy.Expr = other.args[0]
            return inside
    raise NotProvedError("it is not ∫ ½ erfc(…) dz from 0 to 1")
