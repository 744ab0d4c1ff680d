"""What symbols are made of: each carries the forms in which it is printed.

SymPy's own printers, and with them notebooks, ask an object for its LaTeX (``_latex``); the
printers of this package ask in the same way for plain text (``_text``) and Python (``_python``).
"""

from collections.abc import Iterable
from functools import cache
from typing import Any, Self, TypeVar

import sympy

T = TypeVar("T", bound=sympy.Basic)

_RAISED = str.maketrans("0123456789+-", "⁰¹²³⁴⁵⁶⁷⁸⁹⁺⁻")


def raised(written: str) -> str:
    """Digits and signs as superscripts."""
    return written.translate(_RAISED)


_written = cache(str)  # SymPy takes longer to write an expression than to read it


def by_name(found: Iterable[T]) -> list[T]:
    """Expressions in the order of their text, so that the order of a set decides nothing."""
    return sorted(found, key=_written)


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
