"""One equation of the paper as a Python user holds it: a SymPy object with its proof at hand."""

import sympy
from force_diffusion.derivations.framework.catalogue import load, modules
from force_diffusion.derivations.framework.record import Derivation
from force_diffusion.numeric.arithmetic.errors import ForceDiffusionError


class NoSuchEquationError(ForceDiffusionError, ValueError):
    """There is no equation of that number."""


class Equation:
    """An equation of the paper; :func:`equation` gives it by its number."""

    def __init__(self, derivation: Derivation) -> None:
        self._derivation = derivation

    @property
    def number(self) -> int:
        """Its number in the paper."""
        return self._derivation.number

    @property
    def name(self) -> str:
        """Its name in this package: ``surface_diffusion``."""
        return self._derivation.name

    @property
    def title(self) -> str:
        """Its title in words."""
        return self._derivation.title

    @property
    def expr(self) -> sympy.Basic:
        """The printed equation, a SymPy ``Eq``; a ``Tuple`` of them where several are printed."""
        printed = self._derivation.printed
        return printed[0] if len(printed) == 1 else sympy.Tuple(*printed)

    @property
    def rhs(self) -> sympy.Basic:
        """The right-hand side; a ``Tuple`` of them where several equations are printed."""
        sides = [printed.rhs for printed in self._derivation.printed]
        return sides[0] if len(sides) == 1 else sympy.Tuple(*sides)


def equation(number: int) -> Equation:
    """The equation of the paper with this number.

    >>> import force_diffusion as fd
    >>> fd.equation(13).title
    'Variance of the forces under a surface load'

    Raises:
        NoSuchEquationError: there is none.
    """
    if number not in modules():
        known = modules()
        raise NoSuchEquationError(
            f"there is no equation {number!r}: give a number from {min(known)} to {max(known)}"
        )
    return Equation(load(number))
