"""Rational functions as a person writes them: in factors, with whole numbers within each."""

import sympy

from .algebra.exact import Field, Polynomial, RationalFunction
from .symbols import M, j, l, phi


def factored(value: RationalFunction) -> sympy.Expr:
    """A rational function as a SymPy quotient of factors."""
    if value.numerator == 0:
        return sympy.Integer(0)
    number, powers = _factors(value.domain, value.numerator)
    below, under = _factors(value.domain, value.denominator)
    for factor, power in under.items():
        powers[factor] = powers.get(factor, 0) - power
    paired = min(-powers.get(1 - phi, 0), -powers.get(1 + phi, 0))
    if paired > 0:
        powers[1 - phi] += paired
        powers[1 + phi] += paired
        powers[1 - phi**2] = -paired
    return sympy.Mul(number / below, *(factor**power for factor, power in powers.items()))


def _factors(domain: Field, polynomial: Polynomial) -> tuple[sympy.Rational, dict[sympy.Expr, int]]:
    """A number, and factors with their powers, each in the sign that a person would write."""
    content, factors = polynomial.factor()
    number = sympy.Rational(int(content.p), int(content.q))
    powers: dict[sympy.Expr, int] = {}
    for factor, power in factors:
        scale, primitive = domain.expanded(factor).primitive()
        if _reads_negative(primitive):
            scale, primitive = -scale, -primitive
        number *= scale ** int(power)
        powers[primitive] = powers.get(primitive, 0) + int(power)
    return number, powers


def _reads_negative(factor: sympy.Expr) -> bool:
    """Whether −factor reads better: M − j rather than j − M, 1 − z rather than z − 1."""
    if height := next((symbol for symbol in (M, l, j) if symbol in factor.free_symbols), None):
        powers = {term: term.as_powers_dict()[height] for term in sympy.Add.make_args(factor)}
        highest = max(powers.values())
        top = sympy.Add(*(t / height**highest for t, power in powers.items() if power == highest))
        return bool(top.could_extract_minus_sign())
    signs = [term.could_extract_minus_sign() for term in sympy.Add.make_args(factor)]
    if 2 * sum(signs) != len(signs):
        return bool(2 * sum(signs) > len(signs))
    constant = factor.as_coeff_Add()[0]
    return bool(constant.is_negative or (constant == 0 and factor.could_extract_minus_sign()))
