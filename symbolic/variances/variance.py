"""Variances of linear forms in closed form, by the layers that they are for.

The radii are independent with variance σ², so the variance of a form is σ² times the sum of its
squared weights.
"""

from dataclasses import dataclass
from functools import cached_property

import sympy

from ..algebra.affine import Region
from ..algebra.exact import RationalFunction
from ..symbols import M, j


@dataclass(frozen=True)
class ClosedForm:
    """A variance in closed form, exact for every packing that ``validity`` names.

    Attributes:
        validity: the range of M and j, in words.
        exceptions: packings (M, j) of this case that the form misses, with their own variance.
        value: the variance as an element of the exact field.
    """

    validity: str
    exceptions: tuple[tuple[int, int, sympy.Expr], ...]
    value: RationalFunction

    @cached_property
    def expression(self) -> sympy.Expr:
        """The variance as a SymPy expression in M, j, phi, sigma, r."""
        return self.value.to_sympy()


_ZERO, _ONE = sympy.Integer(0), sympy.Integer(1)

CASES: dict[str, tuple[dict[sympy.Symbol, sympy.Expr], Region, str, tuple[int, ...]]] = {
    "interior": ({}, Region({j: 2, M: j + 2}), "2 ≤ j ≤ M − 2", ()),
    "base": ({j: _ZERO}, Region({M: 2}), "j = 0 and M ≥ 2", (1,)),
    "base+1": ({j: _ONE}, Region({M: 3}), "j = 1 and M ≥ 3", (2,)),
    "surface": ({j: M - 1}, Region({M: 3}), "j = M − 1 and M ≥ 3", (1, 2)),
}
"""Layers with a closed form of their own: substitution, region, its words, heights missed."""


def value_at(forms: dict[str, ClosedForm], height: int, layer: int, case: str) -> sympy.Expr:
    """The exact variance of one packing, from its closed form or from the exceptions."""
    form = forms[case]
    for size, at, small in form.exceptions:
        if (size, at) == (height, layer):
            return small
    return form.expression.xreplace({M: sympy.Integer(height), j: sympy.Integer(layer)})
