"""Expressions as code: SymPy source in the names of ``symbolic.symbols``, and plain Python."""

from sympy import Basic, Rational, Sum, Symbol
from sympy.printing.str import StrPrinter

from .. import symbols as sy
from .structure import rebuilt

_FUNCTIONS = (*sy.SiteFunction.__subclasses__(), sy.Dot, sy.MatrixTimes)
# the order of arguments: σ before r, as in closed forms
_VALUES = (sy.M, sy.z, *sy.INDICES, sy.phi, sy.sigma, *sy.PARAMETERS, *sy.VECTORS)


def name_of(symbol: Symbol) -> str:
    """What a symbol is called in code."""
    return str(getattr(symbol, "in_code", symbol.name))


class _SymPySource(StrPrinter):  # type: ignore[misc]
    """SymPy source; ``S(1)/2`` keeps a fraction exact when Python reads it."""

    def _print_Symbol(self, expr: Symbol) -> str:
        return name_of(expr)

    def _print_Rational(self, expr: Rational) -> str:
        return f"S({expr.p})/{expr.q}"


class _PythonSource(StrPrinter):  # type: ignore[misc]
    """Python that needs no import: numbers of any type, and functions of a bead for the rest."""

    printmethod = "_python"

    def _print_Symbol(self, expr: Symbol) -> str:
        return name_of(expr)

    def _print_Function(self, expr: Basic) -> str:
        name = getattr(expr, "in_code", type(expr).__name__)
        return f"{name}({self.stringify(expr.args, ', ')})"

    def _print_Sum(self, expr: Sum) -> str:
        loops = " ".join(
            f"for {self._print(index)} in range({self._print(low)}, {self._print(high + 1)})"
            for index, low, high in reversed(expr.limits)
        )
        return f"sum({self._print(expr.function)} {loops})"


def sympy_source(expr: Basic) -> str:
    """One line of SymPy source.

    >>> sympy_source(sy.DeltaR(sy.i - 1, sy.j) / 2)
    'DeltaR(i - 1, j)/2'
    """
    return str(_SymPySource().doprint(rebuilt(expr)))


def python_expression(expr: Basic) -> str:
    """An expression in Python.

    >>> python_expression(sy.j**2 / 2)
    'j**2/2'
    """
    return str(_PythonSource().doprint(rebuilt(expr)))


def python_source(name: str, doc: str, expr: Basic) -> str:
    """A Python function that returns the expression.

    >>> print(python_source("half", "Half of it.", sy.DeltaR(sy.i, sy.j) / 2))
    def half(i, j, dr):
        \"\"\"Half of it.\"\"\"
        return dr(i, j)/2
    """
    expr = rebuilt(expr)
    free = expr.free_symbols
    values = [name_of(symbol) for symbol in dict.fromkeys(_VALUES) if symbol in free]
    others = sorted(name_of(symbol) for symbol in free if symbol not in _VALUES)
    used = {type(atom) for atom in expr.atoms(*_FUNCTIONS)}
    calls = [kind.in_code for kind in _FUNCTIONS if kind in used]
    body = _PythonSource().doprint(expr)
    return (
        f'def {name}({", ".join([*values, *others, *calls])}):\n    """{doc}"""\n    return {body}'
    )
