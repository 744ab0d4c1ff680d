"""LaTeX in the paper's notation."""

import re
from typing import Any

from force_diffusion.symbolic import symbols as sy
from force_diffusion.symbolic.printing.structure import StructuredPrinter, ascending
from sympy import Expr, Matrix, Sum
from sympy.printing.latex import LatexPrinter

_SYMBOLS = {
    sy.sigma: r"\sigma_{\delta r}",
    sy.epsilon: r"\varepsilon",
    sy.f_load: r"f^{\rm load}",
    sy.m_g: "mg",
    sy.n_plus: r"\hat{\bf n}^{+}",
    sy.n_minus: r"\hat{\bf n}^{-}",
    sy.b_plus: r"{\bf b}^{+}",
    sy.b_minus: r"{\bf b}^{-}",
    sy.e_y: r"\hat{\bf e}_{y}",
}

_LOCAL = {  # symbols of a single derivation
    "delta_x": r"\Delta x",
    "delta_y": r"\Delta y",
    "nu_plus": r"\nu^{+}",
    "nu_minus": r"\nu^{-}",
    "nu_in": r"\nu_{\rm in}",
    "M_star": "M^{*}",
    "mean_square": r"\overline{\sigma_f^2/\langle f\rangle^2}",
    "tensile": r"P(f<0)",
    "response": r"\frac{\sigma_{\rm ensemble}^{2}(p)}{(f^{\rm load})^{2}}",
    "contact_response": r"\frac{\sigma^{2}(n_{y} f_{ij}^{+})}{(f^{\rm load})^{2}}",
    "leg_response": r"\frac{\sigma_{\rm leg}^{2}(p)}{(f^{\rm load})^{2}}",
    "leg_force": r"\frac{\sigma_{\rm leg}^{2}(f)}{\langle f\rangle^{2}}",
}
_SIGNS = {"==": "=", "<=": r"\leq", "!=": r"\neq"}
_TALL = re.compile(r"\\frac|\\sum|\\begin|\\left")
_SUBSCRIPT = re.compile(r"_\{[^{}]*\}")


class PaperLatex(StructuredPrinter, LatexPrinter):  # type: ignore[misc]
    """Sets expressions as the paper does; anything that it does not know as SymPy does."""

    def __init__(self) -> None:
        LatexPrinter.__init__(self, {"order": "none", "symbol_names": dict(_SYMBOLS)})

    def _print_Symbol(self, expr: Any, style: str = "plain") -> str:
        if "\\" in expr.name:  # given as LaTeX; a quotient becomes a fraction
            over, slash, under = expr.name.partition("/")
            return self.set_fraction(over, under, alone=True) if slash else over
        return _LOCAL.get(expr.name) or str(super()._print_Symbol(expr, style))

    def set_fraction(self, over: str, under: str, *, alone: bool) -> str:
        """A fraction."""
        return rf"\frac{{{over}}}{{{under}}}"

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

    def _print_SiteFunction(self, expr: sy.SiteFunction, exp: str | None = None) -> str:
        branch = f"^{{{expr.branch}}}" if expr.branch else ""
        text = f"{expr.latex_head}{branch}_{{{self.subscript(expr.args)[0]}}}"
        return text if exp is None else rf"({text})^{{{exp}}}"

    def _print_Dot(self, expr: sy.Dot) -> str:
        return r" \cdot ".join(
            self.set_brackets(self._print(arg)) if arg.is_Add else self._print(arg)
            for arg in expr.args
        )

    def _print_MatrixTimes(self, expr: sy.MatrixTimes) -> str:
        matrix = self._print(Matrix(2, 2, expr.args[:4]))
        vector = expr.args[4]
        text = self._print(vector)
        return f"{matrix} {self.set_brackets(text) if vector.is_Add else text}"

    def _print_MatrixBase(self, expr: Any) -> str:
        rows = r" \\[2pt] ".join(" & ".join(map(self._print, row)) for row in expr.tolist())
        return rf"\begin{{pmatrix}} {rows} \end{{pmatrix}}"

    def _print_Sum(self, expr: Sum) -> str:
        text = ""
        for index, lower, upper in reversed(expr.limits):
            text += rf"\sum_{{{self._print(index)}={self.index(lower)}}}^{{{self.index(upper)}}} "
        inner = self._print(expr.function)
        return text + (self.set_brackets(inner) if expr.function.is_Add else inner)

    def _print_Braces(self, expr: Any) -> str:
        first, second, index, last = expr.args
        rows = ((first, r"\leq", last), (second, ">", last))
        cases = r" \\ ".join(
            f"{self._print(value)} & {self._print(index)} {sign} {self.index(end)}"
            for value, sign, end in rows
        )
        return rf"\left\{{ \begin{{array}}{{r@{{\;:\;}}l}} {cases} \end{{array}} \right\}}"

    def _print_Relational(self, expr: Any) -> str:
        low, sign, high = ascending(expr)
        return f"{self._print(low)} {_SIGNS.get(sign, sign)} {self._print(high)}"


def latex(expr: Expr) -> str:
    """One expression as LaTeX for mathematics mode.

    >>> print(latex(sy.DeltaR(sy.i - sy.j, 0) / (1 - sy.phi**2)))
    \\frac{\\delta r_{i-j,0}}{1 - \\phi^{2}}
    """
    return str(PaperLatex().doprint(expr))
