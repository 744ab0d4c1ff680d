"""Line-sum components n^±·v, in which vectors are read: v = (n⁺·v) b⁺ + (n⁻·v) b⁻."""

from dataclasses import dataclass

import sympy

from ..symbols import b_minus, b_plus, e_y, n_minus, n_plus, n_y, phi
from .exact import FIELD, RationalFunction

Pair = tuple[RationalFunction, RationalFunction]


def _pair(first: sympy.Expr | int, second: sympy.Expr | int) -> Pair:
    return FIELD.from_sympy(sympy.sympify(first)), FIELD.from_sympy(sympy.sympify(second))


@dataclass(frozen=True)
class LineSums:
    """Components of the paper's vectors, and the metric of dot products in these components.

    Attributes:
        normals: what vectors are multiplied by.
        vectors: the components of base vectors.
        metric: b⁺·b⁺ and b⁺·b⁻.
    """

    normals: tuple[sympy.Symbol, sympy.Symbol]
    vectors: dict[sympy.Symbol, Pair]
    metric: Pair


LINE_SUM = LineSums(
    (n_plus, n_minus),
    {
        n_plus: _pair(1, phi),
        n_minus: _pair(phi, 1),
        b_plus: _pair(1, 0),
        b_minus: _pair(0, 1),
        e_y: _pair(n_y, n_y),
    },
    _pair(1 / (1 - phi**2), -phi / (1 - phi**2)),
)
