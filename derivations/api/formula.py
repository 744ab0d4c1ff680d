"""What an equation and its exact forms have in common: SymPy objects, names, numbers, code."""

import inspect
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable
from functools import cached_property
from typing import Any

import sympy
from force_diffusion.symbolic import symbols as sy
from force_diffusion.symbolic.notation import Symbol
from force_diffusion.symbolic.printing.code import python_source, sympy_source
from force_diffusion.symbolic.printing.latex import RELATIONS
from force_diffusion.symbolic.printing.lines import column_width, latex_body
from force_diffusion.symbolic.printing.text import text

from .evaluation import Evaluation
from .numpy_function import numpy_function


class Formula(ABC):
    """One or more printed lines, each a SymPy ``Eq``."""

    def __init__(
        self, name: str, heading: str, lines: tuple[sympy.Eq, ...], relation: str = "="
    ) -> None:
        self._name, self._heading, self._lines, self._relation = name, heading, lines, relation

    @property
    def expr(self) -> sympy.Basic:
        """The formula as a SymPy ``Eq``, or a ``Tuple`` of them where several lines are printed.

        ``Eq`` stands for the printed sign too where that is ≈, ∼ or ∝.

        >>> import force_diffusion as fd
        >>> type(fd.equation(13).expr).__name__
        'Equality'
        >>> [type(line).__name__ for line in fd.equation(7).expr]
        ['Equality', 'Equality']
        """
        return _one_or_tuple(self._lines)

    @property
    def rhs(self) -> sympy.Basic:
        """The right-hand side, or a ``Tuple`` of them where several lines are printed.

        A string is no symbol of it: take symbols from :attr:`symbols`, or use :meth:`at`.

        >>> import force_diffusion as fd
        >>> eq = fd.equation(13)
        >>> M, z = eq.symbols["M"], eq.symbols["z"]
        >>> eq.rhs.subs({M: 10, z: 0})
        2000*sigma**2/(r**2*(1 - phi**2)**2)
        """
        return _one_or_tuple(line.rhs for line in self._lines)

    @property
    def symbols(self) -> dict[str, Any]:
        """The symbols, and the functions of a bead, by the names that code and messages use.

        They carry assumptions (M is a positive whole number), so that ``sympy.Symbol("M")`` is
        another symbol.

        >>> import force_diffusion as fd
        >>> list(fd.equation(13).symbols)
        ['sigma', 'r', 'M', 'z', 'phi', 'relative_variance', 'j']
        >>> list(fd.equation(3).symbols)
        ['DeltaX', 'i', 'j', 'DeltaR', 'm', 'b_plus', 'b_minus']
        """
        return dict(self._vocabulary)

    @cached_property
    def _vocabulary(self) -> dict[str, Any]:
        return vocabulary(self._lines)

    def latex(self, columns: int = 1) -> str:
        r"""LaTeX for mathematics mode, which needs amsmath alone; long formulas in several lines.

        The lines fit text of one column, or of two. Raises ``ValueError`` for any other number.

        >>> import force_diffusion as fd
        >>> print(fd.equation(15).latex())
        \begin{aligned}
        \frac{\sigma_f}{\langle f\rangle} &\propto \frac{M^{3/2} \sigma_{\delta r}}{r} \\
        M^{*} &\propto \left( \frac{\sigma_{\delta r}}{r} \right)^{-2/3}
        \end{aligned}
        """
        relation, room = RELATIONS[self._relation], column_width(columns)
        return latex_body(self._lines, relation, room, self._below)

    @property
    def _below(self) -> Iterable[str]:
        """Pieces of LaTeX that stand below the lines."""
        return ()

    def _repr_latex_(self) -> str:
        return rf"$\displaystyle {self.latex()}$"

    def sympy_code(self) -> str:
        """SymPy source of the right-hand side, in the names of :attr:`symbols`; a line for each.

        >>> import force_diffusion as fd
        >>> fd.equation(13).sympy_code()
        '2*M**3*sigma**2*(1 - z)**2*(2*z + 1)/(r**2*(1 - phi**2)**2)'
        """
        return "\n".join(sympy_source(_value_side(line)) for line in self._lines)

    def python_code(self) -> str:
        """Python source of the right-hand side: a function for each, which needs no import.

        >>> import force_diffusion as fd
        >>> print(fd.equation(15).python_code())
        def general_form_1(M, r, sigma):
            \"""Eq. 15: σ_f/⟨f⟩.\"""
            return M**(3/2)*sigma/r
        <BLANKLINE>
        <BLANKLINE>
        def general_form_2(r, sigma):
            \"""Eq. 15: M*.\"""
            return r**(2/3)/sigma**(2/3)
        """
        several = len(self._lines) > 1
        return "\n\n\n".join(
            python_source(
                f"{self._name}_{place}" if several else self._name,
                f"{self._heading}: {self._about(line)}.",
                _value_side(line),
            )
            for place, line in enumerate(self._lines, start=1)
        )

    @property
    @abstractmethod
    def _evaluation(self) -> Evaluation:
        """What numbers are put into.

        Raises:
            ArgumentError: the right-hand side is no number.
        """

    @property
    def _meanings(self) -> dict[sympy.Basic, str]:
        return {}

    def function(self) -> Callable[..., Any]:
        """The right-hand side as a function for NumPy, by position or by name.

        It takes numbers and arrays that broadcast, calculates in float64, and gives a float, an
        array, or a tuple of these where several lines are printed. Its signature and its docstring
        say what it takes. ``at`` is slower: it is exact for exact numbers, and rounds a float once.

        >>> import force_diffusion as fd
        >>> import numpy as np
        >>> variance = fd.equation(13).function()
        >>> variance(M=10, z=np.array([0, 0.5, 1]), phi=0, sigma=0.01, r=1)
        array([0.2, 0.1, 0. ])
        >>> import inspect
        >>> inspect.signature(variance), variance.__doc__.splitlines()[0]
        (<Signature (M, z, phi, sigma, r)>, 'Eq. 13: σ_f²(z)/⟨f⟩².')

        Raises:
            ArgumentError: the right-hand side is no number; the function raises it for a value that
                is not allowed, and never gives a value where the formula is not meant.
        """
        return _Function(self)

    def _numpy(self) -> Callable[..., Any]:
        about = "; ".join(self._about(line) for line in self._lines)
        heading = f"{self._heading}: {about}."
        return numpy_function(self._evaluation, self._name, heading, self._meanings)

    def _about(self, line: sympy.Eq) -> str:
        return "what must vanish" if line.rhs == 0 else text(line.lhs)


def _one_or_tuple(parts: Iterable[sympy.Basic]) -> sympy.Basic:
    first, *others = parts
    return sympy.Tuple(first, *others) if others else first


def _value_side(line: Any) -> sympy.Expr:
    """The side that says what the other one is; of a balance, the side that must vanish."""
    return line.lhs if line.rhs == 0 else line.rhs


def vocabulary(expressions: Iterable[sympy.Basic]) -> dict[str, Any]:
    """Symbols and functions by the names that they have in code, in their order of appearance."""
    found: dict[str, Any] = {}
    for expression in expressions:
        for node in sympy.preorder_traversal(expression):
            if isinstance(node, Symbol):
                found.setdefault(node.in_code, node)
            elif isinstance(node, sy.SiteFunction | sy.Dot | sy.MatrixTimes | sy.Braces):
                found.setdefault(type(node).__name__, type(node))
    return found


class _Function:
    """The function of a formula, which can be pickled: then the formula is, for processes."""

    def __init__(self, formula: Formula) -> None:
        self._formula, self._call = formula, formula._numpy()
        self.__signature__ = inspect.signature(self._call)
        self.__name__ = self.__qualname__ = self._call.__name__
        self.__doc__ = self._call.__doc__

    def __call__(self, *args: Any, **kwargs: Any) -> Any:
        return self._call(*args, **kwargs)

    def __reduce__(self) -> tuple[type["_Function"], tuple[Formula]]:
        return _Function, (self._formula,)

    def __repr__(self) -> str:
        return f"{self.__name__}{self.__signature__}"
