"""Expressions as code: SymPy source in the names of ``symbolic.symbols``, and plain Python."""

from force_diffusion.symbolic import symbols as sy
from force_diffusion.symbolic.printing.structure import rebuilt
from sympy import Basic, Rational, Sum, Symbol
from sympy.printing.str import StrPrinter

_NAMES = {symbol: name for name, symbol in vars(sy).items() if isinstance(symbol, Symbol)}

_CALLS = {
    "DeltaR": "dr",
    "Position": "x",
    "DeltaX": "dx",
    "DeltaNPlus": "dn_plus",
    "DeltaNMinus": "dn_minus",
    "ForcePlus": "f_plus",
    "ForceMinus": "f_minus",
    "Load": "load",
    "SecondDifference": "second_difference",
    "Dot": "dot",
    "MatrixTimes": "matrix_times",
}
_VALUES = (sy.M, sy.z, *sy.INDICES, *sy.PARAMETERS, *sy.VECTORS)


class _SymPySource(StrPrinter):  # type: ignore[misc]
    """SymPy source; ``S(1)/2`` keeps a fraction exact when Python reads it."""

    def _print_Symbol(self, expr: Symbol) -> str:
        return _NAMES.get(expr, str(expr.name))

    def _print_Rational(self, expr: Rational) -> str:
        return f"S({expr.p})/{expr.q}"


class _PythonSource(StrPrinter):  # type: ignore[misc]
    """Python that needs no import: numbers of any type, and functions of a bead for the rest."""

    def _print_Symbol(self, expr: Symbol) -> str:
        return _NAMES.get(expr, str(expr.name))

    def _print_Function(self, expr: Basic) -> str:
        name = type(expr).__name__
        if name == "Braces":
            return self._print_Braces(expr)
        return f"{_CALLS.get(name, name)}({self.stringify(expr.args, ', ')})"

    def _print_Sum(self, expr: Sum) -> str:
        loops = " ".join(
            f"for {self._print(index)} in range({self._print(low)}, {self._print(high + 1)})"
            for index, low, high in reversed(expr.limits)
        )
        return f"sum({self._print(expr.function)} {loops})"

    def _print_Braces(self, expr: Basic) -> str:
        first, second, index, last = map(self._print, expr.args)
        return f"({first} if {index} <= {last} else {second})"


def sympy_source(expr: Basic) -> str:
    """One line of SymPy source.

    >>> sympy_source(sy.DeltaR(sy.i - 1, sy.j) / 2)
    'DeltaR(i - 1, j)/2'
    """
    return str(_SymPySource().doprint(rebuilt(expr)))


def python_source(name: str, doc: str, expr: Basic) -> str:
    """A Python function that returns the expression.

    >>> print(python_source("half", "Half of it.", sy.DeltaR(sy.i, sy.j) / 2))
    def half(i, j, dr):
        \"\"\"Half of it.\"\"\"
        return dr(i, j)/2
    """
    expr = rebuilt(expr)
    free = expr.free_symbols
    values = [_NAMES[symbol] for symbol in dict.fromkeys(_VALUES) if symbol in free]
    others = sorted(_NAMES.get(s, str(s.name)) for s in free if s not in _VALUES)
    used = {type(atom).__name__ for atom in expr.atoms(sy.SiteFunction, sy.Dot, sy.MatrixTimes)}
    calls = [call for kind, call in _CALLS.items() if kind in used]
    body = _PythonSource().doprint(expr)
    return (
        f'def {name}({", ".join([*values, *others, *calls])}):\n    """{doc}"""\n    return {body}'
    )
