"""Bases in which vectors are read: line-sum components n^±·v, or Cartesian ones."""

from dataclasses import dataclass

import sympy

from ..symbols import b_minus, b_plus, e_y, n_minus, n_plus, n_x, n_y, phi
from .exact import FIELD, RationalFunction

Pair = tuple[RationalFunction, RationalFunction]


def _pair(first: sympy.Expr, second: sympy.Expr) -> Pair:
    return (
        FIELD.from_sympy(first),
        FIELD.from_sympy(second),
    )


@dataclass(frozen=True, eq=False)  # each basis is one of its own
class Basis:
    """Components of the paper's vectors, and the metric of dot products in these components."""

    name: str
    axes: tuple[str, str]
    vectors: dict[sympy.Symbol, Pair]
    metric: tuple[RationalFunction, RationalFunction]  # diagonal and off-diagonal entry


_ONE, _ZERO = sympy.Integer(1), sympy.Integer(0)

LINE_SUM = Basis(
    "line sums",
    ("+", "-"),
    {
        n_plus: _pair(_ONE, phi),
        n_minus: _pair(phi, _ONE),
        b_plus: _pair(_ONE, _ZERO),
        b_minus: _pair(_ZERO, _ONE),
        e_y: _pair(n_y, n_y),
    },
    _pair(1 / (1 - phi**2), -phi / (1 - phi**2)),
)
"""Components c^± = n^±·v; v = c⁺ b⁺ + c⁻ b⁻."""

CARTESIAN = Basis(
    "Cartesian",
    ("x", "y"),
    {
        n_plus: _pair(n_x, n_y),
        n_minus: _pair(-n_x, n_y),
        b_plus: _pair(1 / (2 * n_x), 1 / (2 * n_y)),
        b_minus: _pair(-1 / (2 * n_x), 1 / (2 * n_y)),
        e_y: _pair(_ZERO, _ONE),
    },
    _pair(_ONE, _ZERO),
)
"""Horizontal and vertical components."""
