"""Expressions as Coq reads them, symbol by symbol, in the words of ``proofs/Model.v``."""

import re

import sympy
from force_diffusion.symbolic import symbols as sy


class NotStatedError(ValueError):
    """An expression or an equation for which there are no words in ``Model.v``."""


EXPANSION = "e"  # the strength ε of the disorder, on which every quantity depends

_SITES = {
    "DeltaR": "delta_r rho",
    "Position": "position X",
    "DeltaX": "delta_x X",
    "SecondDifference": "second_difference rho",
    "DeltaNPlus": "delta_n_plus G X",
    "DeltaNMinus": "delta_n_minus G X",
    "ForcePlus": "f_plus F",
    "ForceMinus": "f_minus F",
    "Load": "single k l f_load",
}
FIXED = ("Position", "Load")  # do not depend on ε
_SCALARS = {sy.r: "r G", sy.n_x: "n_x G", sy.n_y: "n_y G", sy.phi: "phi G"}
HEIGHT = sympy.Symbol("M_star", positive=True)  # the height of Eq. 15, a real number
_SCALARS |= {HEIGHT: "M_star"}
_SCALARS |= {one: one.name for one in (sy.L_plus, sy.L_minus, sy.t)}
_SCALARS |= {sy.f_load: "f_load", sy.sigma: "sigma", sy.z: "(IZR j / IZR M)"}
_VECTORS = {v: f"{v.name} G" for v in (sy.n_plus, sy.n_minus, sy.b_plus, sy.b_minus)}
_VECTORS[sy.e_y] = "e_y"


def index(expression: sympy.Expr) -> str:
    """A whole number, with the symbols in the order of ``symbols.INDICES``."""
    linear = sympy.Poly(expression, *sy.INDICES)
    if linear.total_degree() > 1 or not all(c.is_Integer for c in linear.coeffs()):
        raise NotStatedError(f"{expression} is no index")
    terms = [(linear.coeff_monomial(symbol), symbol.in_code) for symbol in sy.INDICES]
    terms += [(linear.coeff_monomial(1), "")]
    shown = ""
    for factor, name in terms:
        if factor:
            times = f"{abs(factor)} * {name}" if name and abs(factor) != 1 else name
            sign = " - " if factor < 0 else " + "
            shown += (sign if shown or factor < 0 else "") + (times or str(abs(factor)))
    return shown.strip() or "0"


def is_vector(expression: sympy.Basic) -> bool:
    """Whether it is a vector of the plane."""
    if isinstance(expression, sy.SiteFunction):
        return expression.is_vector
    if isinstance(expression, sy.Dot | sympy.Sum):
        return False
    if isinstance(expression, sy.MatrixTimes) or expression in sy.VECTORS:
        return True
    return any(map(is_vector, expression.args))


def _site(expression: sy.SiteFunction) -> str:
    kind = type(expression).__name__
    if kind not in _SITES:
        raise NotStatedError(f"{kind} has no name in Model.v")
    at = " ".join(atom(index(argument)) for argument in expression.args)
    return f"{_SITES[kind]} {at}" + ("" if kind in FIXED else f" {EXPANSION}")


def atom(shown: str) -> str:
    """As an argument: a word, or in parentheses."""
    return shown if re.fullmatch(r"\w+", shown) else f"({shown})"


def _negative(term: sympy.Expr) -> sympy.Expr | None:
    """The positive of a term with a minus sign in front."""
    if isinstance(term, sympy.Mul) and term.args[0].is_Number and term.args[0] < 0:
        first, *others = term.args
        rest = others if first == -1 else [-first, *others]
        return rest[0] if len(rest) == 1 else sympy.Mul(*rest, evaluate=False)
    return -term if term.is_Number and term < 0 else None


def real(expression: sympy.Expr) -> str:
    """A real number."""
    if expression.is_Integer:
        return str(expression) if expression >= 0 else f"- {-expression}"
    if expression.is_Rational:
        shown = f"{abs(expression.p)} / {expression.q}"
        return shown if expression > 0 else f"- ({shown})"
    if expression in _SCALARS:
        return _SCALARS[expression]
    if expression in sy.INDICES:
        return f"IZR {expression.in_code}"
    if isinstance(expression, sy.SiteFunction) and not expression.is_vector:
        return _site(expression)
    if isinstance(expression, sy.Braces):
        below, above, name, last = expression.args
        values = f"{atom(real(below))} {atom(real(above))}"
        return f"braces {values} {atom(index(name))} {atom(index(last))}"
    if isinstance(expression, sy.Dot):
        return f"dot {' '.join(atom(vector(side)) for side in expression.args)}"
    if isinstance(expression, sympy.Sum):
        ((name, low, high),) = expression.limits
        bounds = f"{atom(index(low))} {atom(index(high))}"
        return f"Sum {bounds} (fun {name.in_code} => {real(expression.function)})"
    if isinstance(expression, sympy.Add):
        return _sum(expression.args)
    if isinstance(expression, sympy.Mul):
        return _product(expression.args)
    if isinstance(expression, sympy.Pow) and expression.exp.is_Integer:
        if expression.exp < 0:
            return _product((expression,))
        return f"{operand(expression.base)} ^ {expression.exp}"
    if isinstance(expression, sympy.Pow) and expression.exp.is_Rational:
        power = f"root {expression.exp.q} {atom(real(expression.base))} ^ {abs(expression.exp.p)}"
        return power if expression.exp > 0 else f"/ {power}"
    raise NotStatedError(f"{expression} has no words in Model.v")


def operand(expression: sympy.Expr) -> str:
    """What stands beside *, / or ^: a number, a name, an application, or in parentheses."""
    number = expression.is_Integer and expression >= 0
    compound = expression.is_Rational or isinstance(expression, sympy.Add | sympy.Mul | sympy.Pow)
    shown = real(expression)
    return f"({shown})" if compound and not number else shown


def _sum(terms: tuple[sympy.Expr, ...]) -> str:
    shown = ""
    for term in terms:
        opposite = _negative(term)
        part = term if opposite is None else opposite
        written = f"({real(part)})" if isinstance(part, sympy.Add) else real(part)
        sign = "+" if opposite is None else "-"
        shown += f" {sign} {written}" if shown else written if sign == "+" else f"- {written}"
    return shown


def _product(factors: tuple[sympy.Expr, ...]) -> str:
    if factors[0] == -1 and len(factors) > 1:
        return f"- ({_product(factors[1:]) if len(factors) > 2 else real(factors[1])})"
    shown = ""
    for factor in factors:
        if isinstance(factor, sympy.Pow) and factor.exp.is_Integer and factor.exp < 0:
            power = "" if factor.exp == -1 else f" ^ {-factor.exp}"
            shown = (shown or "1") + f" / {operand(factor.base)}{power}"
        else:
            shown += (" * " if shown else "") + operand(factor)
    return shown


def vector(expression: sympy.Expr) -> str:
    """A vector of the plane."""
    if expression == 0:
        return "zero"
    if expression in _VECTORS:
        return _VECTORS[expression]
    if isinstance(expression, sy.SiteFunction) and expression.is_vector:
        return _site(expression)
    if isinstance(expression, sy.MatrixTimes):
        *entries, of = expression.args
        shown = " ".join(atom(real(entry)) for entry in entries)
        return f"matrix {shown} {atom(vector(of))}"
    if isinstance(expression, sympy.Add):
        first, *others = expression.args
        shown = vector(first)
        for term in others:
            opposite = _negative(term)
            kind, part = ("add", term) if opposite is None else ("minus", opposite)
            shown = f"{kind} {atom(shown)} {atom(vector(part))}"
        return shown
    if isinstance(expression, sympy.Mul):
        vectors = [factor for factor in expression.args if is_vector(factor)]
        scalars = tuple(factor for factor in expression.args if not is_vector(factor))
        if len(vectors) == 1:
            number = real(scalars[0]) if len(scalars) == 1 else _product(scalars)
            return f"scale {atom(number)} {atom(vector(vectors[0]))}"
    raise NotStatedError(f"{expression} is no vector in the words of Model.v")
