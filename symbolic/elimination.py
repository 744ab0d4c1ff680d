"""Cramer's rule: factors that eliminate all unknowns but one, which their user checks."""

from collections.abc import Callable, Sequence
from itertools import permutations

import sympy

from . import symbols as sy
from .algebra.exact import FIELD, UNKNOWNS, NotExactError, RationalFunction
from .forms import Form
from .trees import equation


def eliminated(
    rows: Sequence[sympy.Eq],
    unknown: sympy.Expr,
    unknowns: Sequence[sympy.Expr],
    forms: Callable[[sympy.Eq], tuple[Form, ...]],
) -> tuple[Form, list[list[Form]]]:
    """The determinant of linear equations, and what they are multiplied by.

    For each component of one unknown, the products add up to the determinant times this component,
    and what holds no unknown.

    Args:
        rows: the equations.
        unknown: the one that is left.
        unknowns: all of them; a vector counts for two.
        forms: the left less the right side of an equation.

    Raises:
        NotExactError: there are more or fewer equations than unknowns, or one is not linear.
    """
    image, names = _named(unknowns)
    named = (equation(*(side.xreplace(image) for side in row.args)) for row in rows)
    system = [part for row in named for part in forms(row)]
    involved = [name for quantity in unknowns for name in names[quantity]]
    if len(system) != len(involved):
        raise NotExactError(f"{len(system)} equations for {len(involved)} unknown numbers")
    matrix = [[_slope(row, name, involved) for name in involved] for row in system]
    columns = [involved.index(name) for name in names[unknown]]
    cofactors = [[_cofactor(matrix, n, column) for n in range(len(involved))] for column in columns]
    return _determinant(matrix), cofactors


def _named(
    unknowns: Sequence[sympy.Expr],
) -> tuple[dict[sympy.Expr, sympy.Expr], dict[sympy.Expr, tuple[sympy.Symbol, ...]]]:
    """Names for unknown numbers; two for a vector, its components n^±·v."""
    image: dict[sympy.Expr, sympy.Expr] = {}
    names: dict[sympy.Expr, tuple[sympy.Symbol, ...]] = {}
    spare = list(reversed(UNKNOWNS))
    for unknown in unknowns:
        if getattr(unknown, "is_vector", False):
            names[unknown] = (spare.pop(), spare.pop())
            image[unknown] = names[unknown][0] * sy.b_plus + names[unknown][1] * sy.b_minus
        else:
            names[unknown] = (spare.pop(),)
            image[unknown] = names[unknown][0]
    return image, names


def _slope(row: Form, name: sympy.Symbol, names: Sequence[sympy.Symbol]) -> Form:
    """The factor of an unknown number, of which a row is a linear function."""

    def slope(value: RationalFunction) -> RationalFunction:
        powers = value.coefficients(name)
        if len(powers) > 2 or any(powers[-1].holds(other) for other in names if len(powers) == 2):
            raise NotExactError("an equation to be solved is not linear")
        return powers[1] if len(powers) == 2 else FIELD.zero

    return row.mapped(lambda weights: weights.mapped(slope))


def _cofactor(matrix: Sequence[Sequence[Form]], number: int, column: int) -> Form:
    rest = [[*row[:column], *row[column + 1 :]] for n, row in enumerate(matrix) if n != number]
    return _determinant(rest).scaled(FIELD.constant((-1) ** (number + column)))


def _determinant(matrix: Sequence[Sequence[Form]]) -> Form:
    total = Form()
    for columns in permutations(range(len(matrix))):
        odd = sum(a > b for n, a in enumerate(columns) for b in columns[n + 1 :]) % 2
        product = Form.number(FIELD.constant(-1 if odd else 1))
        for row, column in zip(matrix, columns, strict=True):
            product = product.times(row[column])
        total = total + product
    return total
