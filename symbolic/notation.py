"""What symbols are made of: each carries the forms in which it is printed.

SymPy's own printers, and with them notebooks, ask an object for its LaTeX (``_latex``); the
printers of this package ask in the same way for plain text (``_text``) and Python (``_python``).
"""

from collections.abc import Iterable
from functools import cache
from typing import Any, Self, TypeVar

import sympy
from sympy.printing.precedence import PRECEDENCE

T = TypeVar("T", bound=sympy.Basic)

_RAISED = str.maketrans("0123456789+-", "⁰¹²³⁴⁵⁶⁷⁸⁹⁺⁻")


def raised(written: str) -> str:
    """Digits and signs as superscripts."""
    return written.translate(_RAISED)


_written = cache(str)  # SymPy takes longer to write an expression than to read it


def by_name(expressions: Iterable[T]) -> list[T]:
    """Expressions in the order of their text, so that the order of a set decides nothing."""
    return sorted(expressions, key=_written)


class Symbol(sympy.Symbol):  # type: ignore[misc]
    """A SymPy symbol with its LaTeX, its plain text and its name in code.

    Symbols with other forms, or other assumptions, are other symbols.

    >>> sympy.latex(Symbol("sigma", r"\\sigma_{\\delta r}", "σ_δr", positive=True) ** 2)
    '\\\\sigma_{\\\\delta r}^{2}'

    Args:
        name: what SymPy calls it.
        latex: its LaTeX; what SymPy makes of the name where none is given.
        text: its plain text; the name where none is given.
        code: its name in Python source and in tables of names; the name where none is given.
        assumptions: SymPy's, such as ``positive=True``.
    """

    __slots__ = ("in_code", "in_latex", "in_text")

    def __new__(
        cls, name: str, latex: str = "", text: str = "", code: str = "", **assumptions: bool
    ) -> Self:
        """Make the symbol."""
        cls._sanitize(assumptions, cls)
        made: Self = sympy.Symbol.__xnew__(cls, name, **assumptions)
        made.in_latex, made.in_text, made.in_code = latex, text or name, code or name
        return made

    def __getnewargs_ex__(self) -> tuple[tuple[str, ...], dict[str, bool]]:
        return (self.name, self.in_latex, self.in_text, self.in_code), self._assumptions_orig

    def _hashable_content(self) -> tuple[Any, ...]:
        return (*super()._hashable_content(), self.in_latex, self.in_text, self.in_code)

    def _latex(self, printer: Any) -> str:
        return self.in_latex or str(printer._print_Symbol(self))


class OfExpressions(sympy.Function):  # type: ignore[misc]
    """A function of expressions and numbers; text, which SymPy would evaluate, is refused.

    Raises:
        TypeError: an argument is something else.
    """

    def __new__(cls, *arguments: Any, **options: Any) -> Any:
        """Make it of checked arguments."""
        for argument in arguments:
            try:
                sympy.sympify(argument, strict=True)
            except sympy.SympifyError:
                raise TypeError(
                    f"an expression is needed, such as i + 1, not {argument!r}"
                ) from None
        return super().__new__(cls, *arguments, **options)


class Written(OfExpressions):
    """A function written by forms, in which %(0)s, %(1)s, … stand for its arguments.

    Those in the places ``factors`` stand in a product.
    """

    latex_form = text_form = ""
    factors: tuple[int, ...] = ()

    def _filled(self, form: str, printer: Any) -> str:
        def shown(place: int, argument: sympy.Expr) -> str:
            if place in self.factors:
                return str(printer.parenthesize(argument, PRECEDENCE["Mul"]))
            return str(printer._print(argument))

        return form % {str(n): shown(n, argument) for n, argument in enumerate(self.args)}

    def _latex(self, printer: Any, exp: str | None = None) -> str:
        return _raised_to(exp, self._filled(self.latex_form, printer))

    def _text(self, printer: Any) -> str:
        return self._filled(self.text_form, printer)


def _raised_to(exponent: str | None, shown: str) -> str:
    """LaTeX with an exponent, where SymPy gives one."""
    return shown if exponent is None else rf"({shown})^{{{exponent}}}"


class WrittenAtSite(OfExpressions):
    """A quantity of a bead, or of the contact along n⁺ or n⁻ above it, with its indices below."""

    latex_head = text_head = in_code = ""
    branch = ""  # "+" or "-" for a contact's quantity

    def _subscript(self, printer: Any) -> tuple[str, bool]:
        """Indices side by side, and whether each is a single letter (then without commas)."""
        set_tightly = getattr(printer, "index", printer._print)
        letters = all(index.is_Symbol for index in self.args)
        return ("" if letters else ",").join(map(set_tightly, self.args)), letters

    def _latex(self, printer: Any, exp: str | None = None) -> str:
        branch = f"^{{{self.branch}}}" if self.branch else ""
        shown = f"{self.latex_head}{branch}_{{{self._subscript(printer)[0]}}}"
        return _raised_to(exp, shown)

    def _text(self, printer: Any) -> str:
        indices, letters = self._subscript(printer)
        return f"{self.text_head}{raised(self.branch)}_{indices if letters else f'({indices})'}"
