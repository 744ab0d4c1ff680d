"""LaTeX in the paper's notation."""

import re
from typing import Any

from sympy import Expr, Sum
from sympy.printing.latex import LatexPrinter

from .structure import StructuredPrinter

RELATIONS = {"=": "=", "≈": r"\approx", "∼": r"\sim", "∝": r"\propto"}
"""LaTeX of the signs between the two sides of a printed equation."""

_TALL = re.compile(r"\\frac|\\sum|\\begin|\\left")
_SUBSCRIPT = re.compile(r"_\{[^{}]*\}")


class PaperLatex(StructuredPrinter, LatexPrinter):  # type: ignore[misc]
    """Sets expressions as the paper does; anything that it does not know as SymPy does."""

    def set_fraction(self, over: str, under: str, *, alone: bool) -> str:
        """A fraction."""
        return rf"\frac{{{over}}}{{{under}}}"

    def is_tall(self, factor: Expr) -> bool:
        """Whether a factor holds a fraction."""
        return r"\frac" in self._print(factor)

    def set_brackets(self, inner: str) -> str:
        """Round, then square, then braces, from the inside out; braces also around sums."""
        flat = _SUBSCRIPT.sub("", inner)
        if not _TALL.search(flat) and "(" not in flat:
            return f"({inner})"
        if r"\sum" in flat or "[" in flat:
            return rf"\left\{{ {inner} \right\}}"
        if "(" in flat:
            return rf"\left[ {inner} \right]"
        return rf"\left( {inner} \right)"

    def set_root(self, inner: str) -> str:
        """A square root."""
        return rf"\sqrt{{{inner}}}"

    def set_power(self, base: str, exponent: Expr) -> str:
        """A power, its base in brackets where a superscript is in the way."""
        if "^" in base and re.fullmatch(r"[^()]*", base):
            base = f"({base})"
        if exponent.is_Rational and not exponent.is_Integer:
            return rf"{base}^{{{exponent.p}/{exponent.q}}}"
        return rf"{base}^{{{self._print(exponent)}}}"

    def _print_Derivative(self, expr: Any) -> str:
        ((symbol, _),), inner = expr.variable_count, expr.expr
        name = self._print(symbol)
        sign = r"\partial" if len(inner.free_symbols) > 1 else "d"
        return rf"\frac{{{sign}}}{{{sign} {name}}} {self.set_brackets(self._print(inner))}"

    def _print_Sum(self, expr: Sum) -> str:
        text = ""
        for index, lower, upper in reversed(expr.limits):
            text += rf"\sum_{{{self._print(index)}={self.index(lower)}}}^{{{self.index(upper)}}} "
        inner = self._print(expr.function)
        return text + (self.set_brackets(inner) if expr.function.is_Add else inner)


LATEX = PaperLatex()


def latex(expr: Expr) -> str:
    """One expression as LaTeX for mathematics mode.

    >>> from force_diffusion.symbolic.symbols import DeltaR, i, j, phi
    >>> print(latex(DeltaR(i - j, 0) / (1 - phi**2)))
    \\frac{\\delta r_{i-j,0}}{1 - \\phi^{2}}
    """
    return str(LATEX.doprint(expr))
