"""Plain Unicode text, one line for one expression."""

import re
from typing import Any

from force_diffusion.symbolic import symbols as sy
from force_diffusion.symbolic.printing.structure import StructuredPrinter, ascending
from sympy import Expr, Matrix, Sum, Symbol
from sympy.printing.str import StrPrinter

_SYMBOLS = {
    sy.phi: "φ",
    sy.sigma: "σ_δr",
    sy.epsilon: "ε",
    sy.m_g: "mg",
    sy.n_plus: "n⁺",
    sy.n_minus: "n⁻",
    sy.b_plus: "b⁺",
    sy.b_minus: "b⁻",
}
_SIGNS = {"==": "=", "<=": "≤", "!=": "≠"}
_ONE_FACTOR = re.compile(r"[\w⁺⁻⟨⟩]+(_\([^()]*\))?|\([^()]*\)\w?|√\w+")
_INDEX = re.compile(r"_\([^()]*\)|Σ\([^()]*\)")
_LOCAL = {  # symbols of a single derivation
    "delta_x": "Δx",
    "delta_y": "Δy",
    "rho": "ρ",
    "nu_plus": "ν⁺",
    "nu_minus": "ν⁻",
    "nu_in": "ν_in",
    "M_star": "M*",
    "mean_square": "mean of σ_f²/⟨f⟩²",
    "tensile": "P(f < 0)",
    "response": "σ²(p)/f_load²",
    "contact_response": "σ²(n_y f⁺_ij)/f_load²",
    "leg_response": "σ²(p on a leg)/f_load²",
    "leg_force": "σ²(f on a leg)/⟨f⟩²",
}
_RAISED = str.maketrans("0123456789+-", "⁰¹²³⁴⁵⁶⁷⁸⁹⁺⁻")


def _plain(name: str) -> str:
    """The name of a symbol that is given as LaTeX."""
    for source, sign in ((r"\sigma", "σ"), (r"\langle", "⟨"), (r"\rangle", "⟩"), (" ", "")):
        name = name.replace(source, sign)
    return re.sub(r"\^(\d)", lambda found: found[1].translate(_RAISED), name)


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

    minus = "−"

    def __init__(self) -> None:
        StrPrinter.__init__(self, {"order": "none"})

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
            return base + str(exponent).translate(_RAISED)
        return f"{base}^({self._print(exponent)})"

    def _print_Symbol(self, expr: Symbol) -> str:
        if "\\" in expr.name:
            return _plain(expr.name)
        return _SYMBOLS.get(expr) or _LOCAL.get(expr.name, expr.name)

    def _print_SiteFunction(self, expr: sy.SiteFunction, exp: str | None = None) -> str:
        indices, letters = self.subscript(expr.args)
        branch = expr.branch.translate(_RAISED)
        text = f"{expr.text_head}{branch}_{indices if letters else f'({indices})'}"
        return text if exp is None else f"({text})^{exp}"

    def _print_Dot(self, expr: sy.Dot) -> str:
        return "·".join(
            self.set_brackets(self._print(arg)) if arg.is_Add else self._print(arg)
            for arg in expr.args
        )

    def _print_MatrixTimes(self, expr: sy.MatrixTimes) -> str:
        matrix = self._print(Matrix(2, 2, expr.args[:4]))
        vector = expr.args[4]
        text = self._print(vector)
        return f"{matrix} {self.set_brackets(text) if vector.is_Add else text}"

    def _print_MatrixBase(self, expr: Any) -> str:
        rows = [f"({', '.join(map(self._print, row))})" for row in expr.tolist()]
        return f"({', '.join(rows)})"

    def _print_Sum(self, expr: Sum) -> str:
        text = ""
        for index, lower, upper in reversed(expr.limits):
            text += f"Σ({self._print(index)}={self.index(lower)}…{self.index(upper)}) "
        inner = self._print(expr.function)
        return text + (self.set_brackets(inner) if expr.function.is_Add else inner)

    def _print_Integral(self, expr: Any) -> str:
        ((variable, lower, upper),) = expr.limits
        name = self._print(variable)
        return f"∫({name}={lower}…{upper}) {self._print(expr.function)} d{name}"

    def _print_Derivative(self, expr: Any) -> str:
        (variable, times), *_ = expr.variable_count
        power = "" if times == 1 else str(times).translate(_RAISED)
        inner = self.set_brackets(self._print(expr.expr))
        return f"d{power}/d{self._print(variable)}{power} {inner}"

    def _print_Braces(self, expr: Any) -> str:
        first, second, index, last = (self._print(arg) for arg in expr.args)
        return f"{{{first} if {index} ≤ {last}; {second} if {index} > {last}}}"

    def _print_Relational(self, expr: Any) -> str:
        low, sign, high = ascending(expr)
        return f"{self._print(low)} {_SIGNS.get(sign, sign)} {self._print(high)}"


def text(expr: Any) -> str:
    """One expression as a line of text.

    >>> from force_diffusion.symbolic.symbols import DeltaR, i, j, phi
    >>> text(DeltaR(i, j) / (1 - phi**2) - DeltaR(i - 1, j))
    'δr_ij/(1 − φ²) − δr_(i−1,j)'
    """
    return str(PaperText().doprint(expr))
