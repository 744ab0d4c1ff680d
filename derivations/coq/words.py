"""Expressions as Coq reads them, in the words of ``proofs/Model.v``."""

import re
from functools import reduce
from typing import Any

import sympy
from force_diffusion.symbolic import symbols as sy
from force_diffusion.symbolic.printing.code import sympy_source
from force_diffusion.symbolic.printing.structure import is_vector
from sympy.printing.precedence import PRECEDENCE
from sympy.printing.str import StrPrinter

HEIGHT = sympy.Symbol("M_star", positive=True)  # the height of Eq. 15, a real number
FIXED = {sy.Position: "position X", sy.LoadForce: "single k l f_load"}
"""Quantities that do not depend on ε."""
_SITES = FIXED | {
    sy.DeltaR: "delta_r rho",
    sy.DeltaX: "delta_x X",
    sy.SecondDifference: "second_difference rho",
    sy.DeltaNPlus: "delta_n_plus G X",
    sy.DeltaNMinus: "delta_n_minus G X",
    sy.ForcePlus: "f_plus F",
    sy.ForceMinus: "f_minus F",
}
_BY_NAME = {
    HEIGHT.name: "M_star",
    "relative_variance": "relative_variance L f",
    "relative_deviation": "root_mean_square L f",
    "response": "variance L f / f_load ^ 2",
}
"""Left-hand sides that are about random radii, and a quantity f, by the names of their symbols."""
_SYMBOLS = {
    **{sy.r: "r G", sy.n_x: "n_x G", sy.n_y: "n_y G", sy.phi: "phi G"},
    **{sy.f_load: "f_load", sy.sigma: "sigma", sy.z: "(IZR j / IZR M)", sy.e_y: "e_y"},
    **{v: f"{v.name} G" for v in (sy.n_plus, sy.n_minus, sy.b_plus, sy.b_minus)},
    **{symbol: f"IZR {symbol.in_code}" for symbol in sy.INDICES},
}


def argument(shown: str) -> str:
    """As an argument: a word, or in parentheses."""
    return shown if re.fullmatch(r"\w+", shown) else f"({shown})"


def index(expression: sympy.Expr) -> str:
    """A whole number."""
    return sympy_source(expression)


class _Words(StrPrinter):  # type: ignore[misc]
    """As SymPy writes Python, but for powers, functions and vectors."""

    printmethod = "_coq"

    def arguments(self, expressions: Any) -> str:
        """Real numbers and vectors as arguments of a function."""
        return " ".join(argument(self._print(expression)) for expression in expressions)

    def _print_Symbol(self, expr: sympy.Symbol) -> str:
        return _BY_NAME.get(expr.name) or _SYMBOLS[expr]

    def _print_Function(self, expr: sympy.Function) -> str:
        at = " ".join(argument(index(place)) for place in expr.args)
        return f"{_SITES[type(expr)]} {at}" + ("" if type(expr) in FIXED else " e")

    def _print_Dot(self, expr: sy.Dot) -> str:
        return f"dot {self.arguments(expr.args)}"

    def _print_MatrixTimes(self, expr: sy.MatrixTimes) -> str:
        return f"matrix {self.arguments(expr.args)}"

    def _print_Braces(self, expr: sy.Braces) -> str:
        below, above, name, last = expr.args
        return f"braces {self.arguments((below, above))} {index(name)} {argument(index(last))}"

    def _print_Sum(self, expr: sympy.Sum) -> str:
        ((name, *bounds),) = expr.limits
        low, high = (argument(index(bound)) for bound in bounds)
        return f"Sum {low} {high} (fun {index(name)} => {self._print(expr.function)})"

    def _print_Add(self, expr: sympy.Add, order: Any = None) -> str:
        if not is_vector(expr):
            return str(super()._print_Add(expr, order))
        terms = map(self._print, expr.args)
        return str(reduce(lambda left, right: f"add {argument(left)} {argument(right)}", terms))

    def _print_Mul(self, expr: sympy.Mul) -> str:
        if not is_vector(expr):
            return str(super()._print_Mul(expr))
        numbers = [factor for factor in expr.args if not is_vector(factor)]
        (of,) = (factor for factor in expr.args if is_vector(factor))
        return f"scale {self.arguments((sympy.Mul(*numbers, evaluate=False), of))}"

    def _print_Pow(self, expr: sympy.Pow, rational: bool = False) -> str:
        base, exponent = expr.args
        if exponent < 0:
            return f"1/{self._print_Pow(sympy.Pow(base, -exponent, evaluate=False))}"
        shown = self.parenthesize(base, PRECEDENCE["Pow"])
        if exponent.q > 1:
            shown = f"root {exponent.q} {argument(self._print(base))}"
        return shown if exponent.p == 1 else f"{shown} ^ {exponent.p}"


def words(expression: sympy.Expr) -> str:
    """A real number or a vector at the strength e of the disorder."""
    return str(_Words({"order": "none"}).doprint(expression))
