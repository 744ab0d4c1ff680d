"""Observables of the calculator: what they may contain, and where all their beads exist."""

from keyword import iskeyword
from typing import Any

import sympy
from force_diffusion.symbolic import sets
from force_diffusion.symbolic import symbols as sy
from force_diffusion.symbolic.algebra.exact import FIELD, NotExactError
from force_diffusion.symbolic.kernel.domain import Domain
from force_diffusion.symbolic.notation import by_name
from force_diffusion.symbolic.printing.structure import is_vector
from force_diffusion.symbolic.printing.text import text

from force_diffusion import symbols

from .loads import PLANE, LoadCase, ObservableError

DISCS = (sy.ForcePlus, sy.ForceMinus, sy.VerticalPlus, sy.VerticalMinus)
"""Forces of contacts between discs."""

SPHERES = (sy.ForceAlong, sy.VerticalAlong)
"""Forces of contacts between spheres."""

_BEADS = (sy.DeltaX, sy.DeltaR)
_PLANAR = (*DISCS, sy.DeltaNPlus, sy.DeltaNMinus, *_BEADS)
INDICES = (sy.i, sy.j, sy.k, sy.l, sy.p, sy.q, sy.M, sy.N)
"""Those that a user may write; others are bound in sums."""
ACROSS = (sy.i, sy.k, sy.p, sy.q)
"""Those that may lie across the packing."""

NAMED = {name: getattr(symbols, name) for name in symbols.__all__}
"""The symbols and quantities of ``force_diffusion.symbols``."""

FARTHEST = 10**9
"""The largest number in a place: isl takes machine integers, and sums of places are formed."""
_NAMES = ", ".join(map(text, INDICES))
_PLACE = f"only whole numbers up to {FARTHEST} and {_NAMES}, times such numbers, are allowed"


def read(observable: Any, dimension: int) -> sympy.Expr:
    """An observable, if it holds only symbols and quantities that the calculator knows.

    Raises:
        ObservableError: it holds others, a float, or is a vector.
    """
    if isinstance(observable, str):
        raise ObservableError(
            f"{observable!r} is text: write it with the symbols of force_diffusion.symbols"
        )
    if isinstance(observable, type):
        raise ObservableError("an observable needs a place, as in f_plus(i, j)")
    try:
        expression = sympy.sympify(observable, strict=True)  # else SymPy evaluates text
    except sympy.SympifyError:
        expression = None
    if not isinstance(expression, sympy.Expr) or expression.is_Matrix:
        raise ObservableError(f"{observable!r} is not a SymPy expression")
    _check_symbols(expression)
    for number in expression.atoms(sympy.Float):
        raise ObservableError(f"{number} is a float: write a fraction, such as Rational(1, 2)")
    for quantity in by_name(expression.atoms(sy.SiteFunction, sy.ForceAlong)):
        _check_quantity(quantity, dimension)
    if is_vector(expression):
        raise ObservableError(
            f"{text(expression)} is a vector: take a component, such as dot(e_y, …)"
        )
    return expression


def _check_symbols(observable: sympy.Expr) -> None:
    """Refuse symbols that may be taken for others.

    Raises:
        ObservableError: with what to do.
    """
    own: dict[str, sympy.Symbol] = {}
    for symbol in by_name(observable.free_symbols):
        ours = NAMED.get(symbol.name)
        if ours is not None and symbol not in (ours, sy.site_r):
            raise ObservableError(
                f"{symbol.name} is not the {symbol.name} of force_diffusion.symbols: "
                "import it from there, or rename yours"
            )
        if symbol in (sy.z, sy.m, sy.n):
            instead = "write j/M" if symbol == sy.z else "use another symbol"
            raise ObservableError(f"{symbol.name} can't be used in an observable: {instead}")
        if symbol in FIELD.position or symbol in sy.VECTORS:
            continue
        if symbol.name in own:
            raise ObservableError(f"two symbols have the name {symbol.name}")
        if not symbol.is_commutative or not symbol.name.isidentifier() or iskeyword(symbol.name):
            raise ObservableError(
                f"{symbol.name}: a constant has to be commutative, and its name has to be "
                "a valid name of a Python argument"
            )
        own[symbol.name] = symbol


def _check_quantity(quantity: sympy.Expr, dimension: int) -> None:
    """Refuse what does not depend on the radii, and places that are not read.

    Raises:
        ObservableError: with what is allowed.
    """
    shown, place = text(quantity), quantity.args
    if isinstance(quantity, sy.ForceAlong):
        if dimension == PLANE:
            raise ObservableError(f"{shown} is a force between spheres: give dimension=3")
        axis, *place = place
        if axis not in (1, 2, 3):
            raise ObservableError(f"{shown} is along base vector {axis}: 1, 2 and 3 are allowed")
    elif not isinstance(quantity, _PLANAR):
        raise ObservableError(f"{shown} does not depend on the radii, or is not known")
    elif dimension != PLANE:
        raise ObservableError(f"{shown} is a quantity of discs: in three dimensions take f_along")
    for index in place:
        try:
            factors, constant = sets.row(index)
        except NotExactError:
            factors, constant = {sy.n: 0}, 0
        is_near = max(map(abs, (constant, *factors.values()))) <= FARTHEST
        if not is_near or not {*factors} <= {*INDICES, sy.site_r, sy.site_s}:
            raise ObservableError(f"{shown} is at {text(index)}: {_PLACE}")


def relations_of(where: Any) -> tuple[sympy.Basic, ...]:
    """Relations of indices, from one or several of them.

    Raises:
        ObservableError: something else is among them.
    """
    given = (where,) if isinstance(where, sympy.Basic | bool) else where
    try:
        several = tuple(sympy.sympify(relation, strict=True) for relation in given)
        sets.where(*several)
    except (TypeError, sympy.SympifyError, NotExactError):
        raise ObservableError(
            f"where={where!r}: relations between indices are allowed, such as (j >= 2, j < M)"
        ) from None
    return several


def domain(statistic: sympy.Expr, load: LoadCase, *more: sympy.Basic) -> Domain:
    """Where all contacts and beads that a statistic names exist, and further relations hold.

    Raises:
        ObservableError: that is nowhere, or a relation is about something else.
    """
    occurring = {sy.M, *load.loading.place, *statistic.free_symbols}
    for relation in more:
        if others := by_name(relation.free_symbols - occurring):
            raise ObservableError(f"where={text(relation)}: {text(others[0])} does not occur")
    quantities = by_name(statistic.atoms(sy.SiteFunction, *SPHERES))
    under_load = any(isinstance(quantity, (*DISCS, *SPHERES)) for quantity in quantities)
    counts = by_name({average.args[1] for average in statistic.atoms(sy.MeanOver)})
    relations = [sympy.Ge(count, 1, evaluate=False) for count in counts]
    for quantity in quantities:
        layer = layer_of(quantity)
        relations.append(sympy.Ge(layer, 0, evaluate=False))
        if under_load:
            top = load.top if isinstance(quantity, _BEADS) else load.top - 1
            relations.append(sympy.Le(layer, top, evaluate=False))
    relations += more
    if sets.where(*relations).is_empty():
        raise ObservableError("no packing has these beads: a layer is too low or too high")
    beads = [quantity.args for quantity in quantities if isinstance(quantity, sy.SiteFunction)]
    if under_load and load.loading.place == (sy.k, sy.l):
        beads.append(load.loading.place)
    whole = Domain.of(
        *(relation for relation in relations if relation.free_symbols),
        indices=statistic.free_symbols,
        loading=load.loading if under_load else None,
        beads=beads,
        dimension=load.dimension,
    )
    try:
        exists = not whole.points.is_empty()
    except NotExactError as reason:
        raise ObservableError(f"{reason}: i + j must be even for each bead (i, j)") from None
    if not exists:
        raise ObservableError("no packing has these beads: nowhere is i + j even for all of them")
    return whole


def layer_of(quantity: sympy.Expr) -> sympy.Expr:
    """The layer of a bead, or of the bead below a contact."""
    return sympy.Add(*quantity.args[1:]) if isinstance(quantity, SPHERES) else quantity.args[1]
