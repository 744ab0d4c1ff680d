"""Plain Unicode text, one line for one expression."""

import re
from typing import Any

from sympy import Expr, Sum, Symbol
from sympy.printing.str import StrPrinter

from ..notation import raised
from .structure import StructuredPrinter

_ONE_FACTOR = re.compile(r"[\w⁺⁻⟨⟩]+(_\([^()]*\))?|\([^()]*\)\w?|√\w+")
_INDEX = re.compile(r"_\([^()]*\)|Σ\([^()]*\)")


def _is_sum(text: str) -> bool:
    """Whether a plus or minus stands outside of all brackets."""
    depth = 0
    for sign in text:
        depth += (sign in "([{") - (sign in ")]}")
        if depth == 0 and sign in "+−":
            return True
    return False


class PaperText(StructuredPrinter, StrPrinter):  # type: ignore[misc]
    """Sets expressions in Unicode; anything that it does not know as SymPy does."""

    printmethod = "_text"
    minus = "−"

    def set_fraction(self, over: str, under: str, *, alone: bool) -> str:
        """A fraction."""
        over = self.set_brackets(over) if _is_sum(over) else over
        simple = _ONE_FACTOR.fullmatch(under) is not None
        text = f"{over}/{under if simple else self.set_brackets(under)}"
        return text if alone else f"({text})"

    def set_group(self, product: str) -> str:
        """A quotient in brackets, so that what follows is not read as its denominator."""
        return f"({product})" if "/" in product else product

    def set_brackets(self, inner: str) -> str:
        """Round, then square, then braces, from the inside out; indices do not count."""
        flat = _INDEX.sub("", inner)
        if "[" in flat:
            return f"{{{inner}}}"
        return f"[{inner}]" if "(" in flat else f"({inner})"

    def set_root(self, inner: str) -> str:
        """A square root."""
        return f"√{inner}" if inner.isalnum() else f"√({inner})"

    def set_power(self, base: str, exponent: Expr) -> str:
        """A power, whole numbers raised."""
        if exponent.is_Integer:
            return base + raised(str(exponent))
        return f"{base}^({self._print(exponent)})"

    def _print_Symbol(self, expr: Symbol) -> str:
        return str(getattr(expr, "in_text", expr.name))

    def _print_Relational(self, expr: Any) -> str:
        sign = {"==": "=", ">=": "≥", "<=": "≤", "!=": "≠"}.get(expr.rel_op, expr.rel_op)
        return f"{self._print(expr.lhs)} {sign} {self._print(expr.rhs)}"

    def _print_Pi(self, _expr: Any) -> str:
        return "π"

    def _print_Sum(self, expr: Sum) -> str:
        text = ""
        for index, lower, upper in reversed(expr.limits):
            text += f"Σ({self._print(index)}={self.index(lower)}…{self.index(upper)}) "
        inner = self._print(expr.function)
        return text + (self.set_brackets(inner) if expr.function.is_Add else inner)

    def _print_Integral(self, expr: Any) -> str:
        if [len(limit) for limit in expr.limits] != [3]:
            return str(super()._print_Integral(expr))
        ((variable, lower, upper),) = expr.limits
        name = self._print(variable)
        return f"∫({name}={lower}…{upper}) {self._print(expr.function)} d{name}"

    def _print_Derivative(self, expr: Any) -> str:
        (variable, times), *_ = expr.variable_count
        power = "" if times == 1 else raised(str(times))
        inner = self.set_brackets(self._print(expr.expr))
        return f"d{power}/d{self._print(variable)}{power} {inner}"


TEXT = PaperText()


def text(expr: Any) -> str:
    """One expression as a line of text.

    >>> from force_diffusion.symbolic.symbols import DeltaR, i, j, phi
    >>> text(DeltaR(i, j) / (1 - phi**2) - DeltaR(i - 1, j))
    'δr_ij/(1 − φ²) − δr_(i−1,j)'
    """
    return str(TEXT.doprint(expr))
