"""Mean, variance and covariance of observables linear in the radii, as exact closed forms."""

from collections.abc import Iterable

import sympy
from force_diffusion.numeric.arithmetic.errors import checked, quoted
from force_diffusion.symbolic import sets
from force_diffusion.symbolic import symbols as sy
from force_diffusion.symbolic.algebra.exact import NotExactError, NotProvedError
from force_diffusion.symbolic.notation import by_name
from force_diffusion.symbolic.printing.text import text
from force_diffusion.symbolic.trees import in_place

from ..framework.closed_form import ClosedForm
from .loads import PLANE, LoadCase, ObservableError, load_of, without_load
from .observables import ACROSS, FARTHEST, SPHERES, domain, layer_of, read, relations_of

_ALLOWED = (
    "Allowed are sums of quantities times rational numbers and symbols; in mean(…, order=2) also "
    "products and whole powers of quantities"
)

ORDERED = "forces over their ordered values"


def response(across: sympy.Expr, layer: sympy.Expr) -> sympy.Expr:
    """The vertical force on bead (i, j) from both contacts above it."""
    return sy.VerticalPlus(across, layer) + sy.VerticalMinus(across, layer)


def force_moment(
    across: sympy.Expr, layer: sympy.Expr, first: sympy.Expr, second: sympy.Expr
) -> sympy.Expr:
    """Σ f ℓ (u·N)(v·N) over both contacts above bead (i, j): the stress of a layer times its area.

    ℓ is the distance between the two centres, N the unit vector from one to the other.

    Args:
        across: i.
        layer: j.
        first: the vector u, such as e_x.
        second: the vector v.
    """
    total = sympy.S.Zero
    for force, direction, turn, side in (
        (sy.ForcePlus, sy.n_plus, sy.DeltaNPlus, 1),
        (sy.ForceMinus, sy.n_minus, sy.DeltaNMinus, -1),
    ):
        length = 2 * sy.r + sy.DeltaR(across, layer) + sy.DeltaR(across + side, layer + 1)
        normal = direction + turn(across, layer)
        total += force(across, layer) * length * sy.Dot(first, normal) * sy.Dot(second, normal)
    return total


def mean_over(observable: sympy.Expr, count: sympy.Expr | int, *across: sympy.Symbol) -> sympy.Expr:
    """The average of an observable over ``count`` neighbours in a layer, at steps of 2 in i.

    Args:
        observable: an expression whose horizontal place is given by an index, such as i.
        count: a whole number from 1 up, or N.
        across: the indices that are shifted, all together; by default i. With k it is an average
            over the loads of ``point(k, l)``.

    Raises:
        ObservableError: the observable has no such index, or ``count`` is something else.
    """
    try:
        averaged, number = sympy.sympify(observable, strict=True), sympy.sympify(count, strict=True)
        if number.is_Integer and not 1 <= number <= FARTHEST:
            allowed = f"a whole number from 1 up to {FARTHEST} is allowed"
            raise ObservableError(f"mean_over(…, {quoted(int(number))}): {allowed}")
        sets.row(number)
    except (sympy.SympifyError, NotExactError):
        raise ObservableError(
            f"mean_over({quoted(observable)}, {quoted(count)}): give an expression of "
            "force_diffusion.symbols, and a whole number from 1 up or N"
        ) from None
    if any(term.has(sy.MeanOver) for mean in averaged.atoms(sy.MeanOver) for term in mean.args):
        raise ObservableError("averages of averages of averages are not supported")
    if across:
        if not {*across} <= {*ACROSS, sy.site_r}:
            raise ObservableError(f"mean_over(…, {across}): the average may run over i, k, p and q")
        return sy.MeanOver(averaged, number, *across)
    places = [place.args[0] for place in averaged.atoms(sy.SiteFunction)]
    indices = [s for s in (sy.i, sy.site_r) if any(place.has(s) for place in places)]
    if not indices or not all(place.has(*indices) for place in places):
        raise ObservableError(
            f"mean_over({text(averaged)}): write horizontal places with the index i"
        )
    return sy.MeanOver(averaged, number, *indices)


@checked
def variance(
    observable: sympy.Expr,
    *,
    load: str | LoadCase = "surface",
    relative: bool = True,
    dimension: int = 2,
    where: sympy.Basic | Iterable[sympy.Basic] = (),
) -> ClosedForm:
    """The exact variance of an observable that is linear in the radii.

    >>> import force_diffusion as fd
    >>> from force_diffusion.symbols import f_minus, f_plus, i, j
    >>> form = fd.variance(f_plus(i, j) - f_minus(i, j))
    >>> len(form.pieces)
    8

    Args:
        observable: linear in contact forces, contact directions, displacements and radii.
        load: "surface", "bulk", ``point(k, l)`` or ``leaning(t)``.
        relative: whether forces are relative to the ordered force of their own contact, vertical
            forces on beads to the load, and lengths to r.
        dimension: 3 for contact forces of spheres, ``f_along(axis, x, y, z)``.
        where: relations between indices that restrict the domain.

    Raises:
        ObservableError: it is not linear, not determined by the radii, or has an unknown symbol.
    """
    return _closed(sy.Variance, [observable], load, relative, dimension, where)


@checked
def covariance(
    first: sympy.Expr,
    second: sympy.Expr,
    *,
    load: str | LoadCase = "surface",
    relative: bool = True,
    dimension: int = 2,
    where: sympy.Basic | Iterable[sympy.Basic] = (),
) -> ClosedForm:
    """The exact covariance of two observables; arguments and errors are those of ``variance``."""
    return _closed(sy.Covariance, [first, second], load, relative, dimension, where)


@checked
def mean(
    observable: sympy.Expr,
    *,
    order: int = 1,
    load: str | LoadCase = "surface",
    relative: bool = True,
    dimension: int = 2,
    where: sympy.Basic | Iterable[sympy.Basic] = (),
) -> ClosedForm:
    """The mean of an observable, or the shift of its mean to second order.

    Args:
        observable: linear for ``order=1``; a polynomial for ``order=2``.
        order: 1 for the value in the ordered packing, 2 for what disorder adds to it at order σ².
        load: as for ``variance``.
        relative: as for ``variance``.
        where: as for ``variance``.

    Raises:
        ObservableError: as for ``variance``, or another order is asked for.
    """
    if order not in (1, 2):
        raise ObservableError(f"order={order!r}: 1 and 2 are allowed")
    kind = sy.Mean if order == 1 else sy.Shift
    return _closed(kind, [observable], load, relative, dimension, where)


def _closed(
    kind: type[sy.Moment],
    observables: Iterable[sympy.Expr],
    load: str | LoadCase,
    relative: bool,
    dimension: int,
    where: sympy.Basic | Iterable[sympy.Basic],
) -> ClosedForm:
    under = load_of(load, dimension)
    statistic = kind(*(read(each, under.dimension) for each in observables))
    on = domain(statistic, under, *relations_of(where))
    scales, units = _scales(statistic, under) if relative else ({}, "")
    groups = without_load if under.dimension == PLANE and not on.loading else under.groups
    multiple, divisor = _without_divisors(in_place(statistic, scales))
    form = ClosedForm(statistic, multiple, on, groups, divisor, units)
    try:
        _ = form.function
    except NotExactError as reason:
        raise ObservableError(f"{text(statistic)}: {reason}. {_ALLOWED}") from None
    except NotProvedError as reason:
        raise ObservableError(f"{text(statistic)}: {reason}") from None
    return form


def _without_divisors(moment: sympy.Expr) -> tuple[sympy.Expr, sympy.Expr]:
    """A moment without divisors that hold constants and may be zero, such as 1 − t; and these.

    The moment over the divisor is what was given.
    """
    whole, observables = sympy.S.One, []
    for observable in moment.args:
        divisors = {
            power.base
            for power in observable.atoms(sympy.Pow)
            if power.exp.is_Integer and power.exp < 0 and _may_vanish(power.base)
        }
        divisor = sympy.Mul(*by_name(divisors))
        each = sympy.Add.make_args(observable)
        observables.append(sympy.Add(*(term * divisor for term in each)))
        whole *= divisor
    power = 2 if isinstance(moment, sy.Variance) else 1
    return moment.func(*observables), whole**power


def _may_vanish(divisor: sympy.Expr) -> bool:
    constants = divisor.free_symbols - {*sy.INDICES, sy.phi}
    return not divisor.is_positive and bool(constants) and constants == divisor.free_symbols


def _scales(statistic: sympy.Expr, load: LoadCase) -> tuple[dict[sympy.Expr, sympy.Expr], str]:
    """Every quantity over what it is compared with, and the same in words."""
    scales, units = {}, set()
    for quantity in statistic.atoms(sy.SiteFunction, *SPHERES):
        match quantity:
            case sy.VerticalPlus() | sy.VerticalMinus() | sy.VerticalAlong():
                unit, word = load.unit, "vertical forces over the load above"
            case sy.ForceAlong():
                unit, word = load.ordered[int(quantity.args[0]) - 1], ORDERED
            case sy.ForcePlus() | sy.ForceMinus():
                unit, word = load.ordered[isinstance(quantity, sy.ForceMinus)], ORDERED
            case sy.DeltaX() | sy.DeltaR():
                unit, word = sy.r, "lengths over the mean radius"
            case _:
                continue
        scales[quantity] = quantity / unit.xreplace({sy.j: layer_of(quantity)})
        units.add(word)
    return scales, ", ".join(sorted(units))
