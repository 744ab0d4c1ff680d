"""Moments of contact forces in any dimension, to first order in the radii.

Every bead rests on d others, along base vectors of equal mutual dot product φ, −1/d < φ < ½, and a
load points along their sum, or leans. What the forces are in the radii is part of what is trusted:
``weights_any_dimension`` and ``point_load`` say it, and sum squares.
"""

from dataclasses import replace

import sympy

from .. import symbols as sy
from ..algebra import affine
from ..algebra.exact import FIELD, NotExactError, RationalFunction
from ..algebra.weights import UndeterminedError
from ..notation import by_name
from ..printing.text import text
from . import weights_any_dimension
from .point_load import AXES, Weights
from .theorem import NotProvedError
from .where import Loading, Where

_WORDS = "the same load along the sum of the base vectors"
SURFACE = Loading(
    "surface, in any dimension", f"each bead of the surface j = M carries {_WORDS}", (sy.M,)
)
BULK = Loading("bulk, in any dimension", f"each bead above the base carries {_WORDS}", (sy.M,))
_LEANS = "the same load −Σ_a L^a n^a, τ_n = Σ_(a≠1) (L^a/L^1)ⁿ"
SURFACE_LEANING = Loading(
    "surface leaning, in any dimension", f"each bead of the surface j = M carries {_LEANS}", (sy.M,)
)
BULK_LEANING = Loading(
    "bulk leaning, in any dimension", f"each bead above the base carries {_LEANS}", (sy.M,)
)
LAYERED = (SURFACE, BULK, SURFACE_LEANING, BULK_LEANING)
POINT = Loading(
    "point, in any dimension",
    "one bead of layer l carries a load along the sum of the base vectors, no other a load",
    (sy.l,),
)
_KNOWN = {*sy.INDICES, *sy.PARAMETERS} - {sy.epsilon}
Linear = tuple[RationalFunction, dict[sympy.Expr, RationalFunction]]
"""A number, and the factor of each force."""


def value(one: sy.Moment, where: Where, parts: int = 24) -> RationalFunction:
    """A moment of what is linear in contact forces, exact to leading order in the radii.

    Where the domain leaves open which beads are one it is divided, and the form of one part holds
    on the other as well; into as many ``parts`` at the most.

    Raises:
        NotProvedError: it holds something else, or is not one form on all of the domain.
    """
    forms = [_linear(sympy.sympify(argument), where) for argument in one.args]
    try:
        return _of(one, forms, where)
    except UndeterminedError as reason:
        if reason.number is None or not parts:
            raise NotProvedError(f"two places may be one: {reason}") from None
        number = reason.number
    above = (sympy.Eq if where.implies(sympy.Le(number, 0)) else sympy.Ge)(number, 0)
    below = (sympy.Eq if where.implies(sympy.Ge(number, -1)) else sympy.Le)(number, -1)
    halves = [where.also(above), where.also(below)]
    found = [(value(one, half, parts - 1), half) for half in halves if not half.is_empty]
    for (form, _), (other, there) in zip(found, reversed(found), strict=True):
        image = {symbol: FIELD.from_sympy(fixed) for symbol, fixed in there.solved.items()}
        if (form.substitute(image) - other).is_zero():
            return form
    raise NotProvedError(f"it is another one where {text(number)} ≥ 0 and where it is below")


def _of(one: sy.Moment, forms: list[Linear], where: Where) -> RationalFunction:
    if isinstance(one, sy.Mean):
        found, forces = forms[0]
        for force, factor in forces.items():
            found = found + factor * FIELD.constant(_ordered(force, where))
        return found
    of = _of_layers if where.loading in LAYERED else _below_a_load
    found = of(forms[0], where)
    if isinstance(one, sy.Shift):
        raise NotProvedError("second order is not known in any dimension")
    if isinstance(one, sy.Covariance):
        both = of(_plus(*forms), where)
        found = (both - found - of(forms[1], where)) / FIELD.constant(2)
    return found * (FIELD.generator(sy.sigma) / FIELD.generator(sy.r)) ** 2


def _linear(expression: sympy.Expr, where: Where) -> Linear:
    expression = expression.xreplace(where.solved)
    forces = by_name(expression.atoms(*sy.CONTACTS))
    for one in forces:
        _exists(one, where)
    names = {one: sympy.Dummy() for one in forces}
    known = _KNOWN | ({sy.d} if where.dimension == sy.d else set())
    inside = expression.xreplace(names)
    if strange := by_name(inside.free_symbols - known - set(names.values())):
        raise NotProvedError(f"whether {text(strange[0])} depends on the radii is not known")
    try:
        factors = {one: sympy.diff(inside, name) for one, name in names.items()}
        rest = inside.xreplace(dict.fromkeys(names.values(), sympy.S.Zero))
        return FIELD.from_sympy(rest), {
            one: FIELD.from_sympy(factor) for one, factor in factors.items()
        }
    except NotExactError as reason:
        raise NotProvedError(str(reason)) from None


def _plus(left: Linear, right: Linear) -> Linear:
    both = {
        force: left[1].get(force, FIELD.zero) + right[1].get(force, FIELD.zero)
        for force in {**left[1], **right[1]}
    }
    return left[0] + right[0], both


def _exists(force: sympy.Expr, where: Where) -> None:
    """Refuse a contact that the packing may not have.

    Raises:
        NotProvedError: with the reason.
    """
    loading, dimension = where.loading, where.dimension
    if isinstance(force, sy.ForceOfLayer):
        (layer,) = force.args
        within = [layer, sy.M - 1 - layer]
        fits = loading in LAYERED
    else:
        axis, *steps = force.args
        if axis not in map(sympy.Integer, (1, 2, 3)):
            raise NotProvedError(f"{text(axis)} is none of three vectors")
        within = [*steps, sy.l - sympy.Add(*steps)]
        fits = loading == POINT and dimension == len(AXES)
    if not fits:
        raise NotProvedError(f"{text(force)} is none under this load, or in this dimension")
    for one in within:
        if not where.nonnegative(affine.from_sympy(sympy.expand(one.xreplace(where.solved)))):
            raise NotProvedError(f"{text(force)} is not shown to be there: {text(one)} ≥ 0")


def _of_layers(form: Linear, where: Where) -> RationalFunction:
    """Σ weight² for one contact of a layer."""
    if len(form[1]) > 1:
        raise NotProvedError("which contacts of two layers are meant is not said")
    total = FIELD.zero
    for force, factor in form[1].items():
        layer, height = (sympy.expand(one.xreplace(where.solved)) for one in (force.args[0], sy.M))
        geometry = replace(where, loading=None, limit=None, dimension=sy.d)
        bulk, leaning = (
            where.loading in both
            for both in ((BULK, BULK_LEANING), (SURFACE_LEANING, BULK_LEANING))
        )
        squares = weights_any_dimension.squares(layer, height, bulk, geometry, leaning)
        if where.dimension != sy.d:
            squares = squares.substitute({sy.d: FIELD.constant(where.dimension)}).reduced()
        total = total + factor**2 * squares
    return total


def _below_a_load(form: Linear, where: Where) -> RationalFunction:
    """Σ weight² for contacts below one loaded bead."""
    weights = _weights(where)
    for force, factor in form[1].items():
        _add(weights, force, factor.to_sympy())
    return weights.squares()


def _ordered(force: sympy.Expr, where: Where) -> int:
    """What a force is in the ordered packing, over that with which it is compared."""
    return 1 if isinstance(force, sy.ForceOfLayer) else _add(_weights(where), force, sympy.S.One)


def _weights(where: Where) -> Weights:
    return Weights(where, affine.from_sympy(sympy.expand(sy.l.xreplace(where.solved))))


def _add(weights: Weights, force: sympy.Expr, factor: sympy.Expr) -> int:
    axis, *steps = force.args
    u, v, w = (affine.from_sympy(sympy.expand(one)) for one in steps)
    add = weights.add_push if isinstance(force, sy.PushBelow) else weights.add_force
    return add(int(axis) - 1, (u, v, w), factor)
