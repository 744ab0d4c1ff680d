"""Mean, variance and covariance of what is linear in the radii, as exact closed forms."""

from collections.abc import Iterable

import sympy
from force_diffusion.symbolic import symbols as sy
from force_diffusion.symbolic.algebra.exact import NotExactError
from force_diffusion.symbolic.kernel import statistics
from force_diffusion.symbolic.kernel.theorem import NotProvedError, Theorem
from force_diffusion.symbolic.kernel.where import Where
from force_diffusion.symbolic.notation import by_name
from force_diffusion.symbolic.printing.text import text

from ..api.closed_form import ClosedForm
from .loads import PLANE, Load, ObservableError, geometry, load_of

_CONTACTS = (sy.ForcePlus, sy.ForceMinus, sy.VerticalPlus, sy.VerticalMinus)
_SPHERES = (sy.ForceAlong, sy.VerticalAlong)
_ALLOWED = (*_CONTACTS, sy.DeltaNPlus, sy.DeltaNMinus, sy.DeltaX, sy.DeltaR)
_NAMED = {
    name: symbol
    for symbol in (*sy.INDICES, *sy.PARAMETERS)
    for name in (symbol.name, symbol.in_code)
}


def response(across: sympy.Expr, layer: sympy.Expr) -> sympy.Expr:
    """The vertical force on bead (i, j) from both contacts above it."""
    return sy.VerticalPlus(across, layer) + sy.VerticalMinus(across, layer)


def force_moment(
    across: sympy.Expr, layer: sympy.Expr, first: sympy.Expr, second: sympy.Expr
) -> sympy.Expr:
    """Σ f ℓ (u·N)(v·N) of both contacts above bead (i, j): the stress of a layer times its area.

    ℓ is the distance of the two centres, N the unit vector between them.

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
    """The average of an observable over ``count`` neighbours in a layer, two columns apart each.

    Args:
        observable: of a place that is named by an index across the packing.
        count: how many.
        across: the indices that go on, all together; i where none is given. With k it is an average
            over the loads of ``point(k, l)``.

    Raises:
        ObservableError: no index says where across the packing it is.
    """
    if across:
        return sy.MeanOver(observable, count, *across)
    places = [one.args[0] for one in observable.atoms(sy.SiteFunction)]
    indices = [s for s in (sy.i, sy.site_r) if any(one.has(s) for one in places)]
    if not indices or not all(one.has(*indices) for one in places):
        raise ObservableError(
            f"mean_over({text(observable)}): name the place across the packing by the index i"
        )
    return sy.MeanOver(observable, count, *indices)


def variance(
    observable: sympy.Expr,
    *,
    load: str | Load = "surface",
    relative: bool = True,
    dimension: int = 2,
    where: Iterable[sympy.Basic] = (),
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
        where: relations of indices, to which the domain is restricted.

    Raises:
        ObservableError: it is not linear, not given by the radii, or holds a foreign symbol.
    """
    return _closed(sy.Variance, [observable], load, relative, dimension, where)


def covariance(
    one: sympy.Expr,
    other: sympy.Expr,
    *,
    load: str | Load = "surface",
    relative: bool = True,
    dimension: int = 2,
    where: Iterable[sympy.Basic] = (),
) -> ClosedForm:
    """The exact covariance of two observables; arguments and errors are those of ``variance``."""
    return _closed(sy.Covariance, [one, other], load, relative, dimension, where)


def mean(
    observable: sympy.Expr,
    *,
    order: int = 1,
    load: str | Load = "surface",
    relative: bool = True,
    dimension: int = 2,
    where: Iterable[sympy.Basic] = (),
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
        raise ObservableError(f"order={order}: 1 and 2 are allowed")
    return _closed(
        sy.Mean if order == 1 else sy.Shift, [observable], load, relative, dimension, where
    )


def _closed(
    kind: type[sy.Moment],
    observables: Iterable[sympy.Expr],
    load: str | Load,
    relative: bool,
    dimension: int,
    where: Iterable[sympy.Basic],
) -> ClosedForm:
    statistic = kind(*map(_read, observables))
    known = load_of(load, dimension)
    return closed_form(statistic, statistic, known, *where, relative=relative)


def closed_form(
    quantity: sympy.Expr,
    statistic: sympy.Expr,
    load: Load,
    *where: sympy.Basic,
    relative: bool = True,
) -> ClosedForm:
    """The closed form of an expression in moments.

    Args:
        quantity: what is shown for it.
        statistic: means, variances and covariances of observables, and what is made of them.
        load: of the packing.
        where: relations of indices, to which its domain is restricted.
        relative: as for ``variance``.

    Raises:
        ObservableError: as for ``variance``.
    """
    observables = [one for moment in statistic.atoms(sy.Moment) for one in moment.args]
    on = domain(observables, load)
    more = set().union(*(one.free_symbols for one in where))
    on = on.also(*where, indices=more) if where else on
    scales = {}
    if relative:
        for one in observables:
            scales |= _scales(one, load)
    meant = statistic.xreplace(scales).xreplace(dict(load.values))
    facts: tuple[Theorem, ...] = ()
    equations: tuple[int | str, ...] = ()
    if load.dimension == PLANE:
        facts, equations = geometry(), (3, 4, 5)
        if on.loading:
            facts, equations = (*facts, *load.theorems()), (*equations, *load.equations)
    try:
        form = statistics.ClosedForm.of(meant, on, facts)
    except (NotExactError, NotProvedError) as reason:
        raise ObservableError(f"{text(statistic)}: {reason}") from None
    return ClosedForm(quantity, form, on, equations, meant, facts)


def _read(observable: sympy.Expr) -> sympy.Expr:
    """An observable, if it holds only what the calculator knows."""
    try:
        read = sympy.sympify(observable)
    except sympy.SympifyError:
        raise ObservableError(f"{observable!r} is no SymPy expression") from None
    if not isinstance(read, sympy.Expr):
        raise ObservableError(f"{observable!r} is no SymPy expression")
    for quantity in read.atoms(sy.SiteFunction):
        if not isinstance(quantity, _ALLOWED):
            raise ObservableError(f"{text(quantity)} is no quantity of a disordered packing")
    for symbol in by_name(read.free_symbols):
        ours = _NAMED.get(symbol.name)
        if ours is not None and ours != symbol:
            raise ObservableError(
                f"{symbol.name} is another symbol than {symbol.name} of force_diffusion.symbols: "
                "import it from there, or give yours another name"
            )
    return read


def domain(observables: Iterable[sympy.Expr], load: Load) -> Where:
    """Where all contacts and beads that are named exist."""
    quantities: set[sympy.Expr] = set()
    relations: list[sympy.Basic] = []
    for one in observables:
        quantities |= one.atoms(sy.SiteFunction, *_SPHERES)
        for average in one.atoms(sy.MeanOver):
            relations.append(sympy.Ge(average.args[1], 1, evaluate=False))
    forces = any(isinstance(one, (*_CONTACTS, *_SPHERES)) for one in quantities)
    even = []
    for one in by_name(quantities):
        layer = _layer(one)
        if isinstance(one, sy.SiteFunction):
            even.append(sympy.Add(*one.args))
        relations.append(sympy.Ge(layer, 0, evaluate=False))
        if forces:
            is_bead = isinstance(one, sy.DeltaX | sy.DeltaR)
            last = load.top if is_bead else load.top - 1
            relations.append(sympy.Le(layer, last, evaluate=False))
    relations = [one for one in dict.fromkeys(relations) if one.free_symbols]
    held = set().union(*(one.free_symbols for one in (*relations, *even, *observables)))
    if forces:
        held |= set().union(*(one.free_symbols for one in load.loading.place))
        even += [sy.k + sy.l] if {sy.k, sy.l} <= held else []
    indices = tuple(symbol for symbol in sy.INDICES if symbol in held)
    return Where(
        indices,
        tuple(relations),
        load.loading if forces else None,
        tuple(dict.fromkeys(even)),
        dimension=load.dimension,
    )


def _layer(quantity: sympy.Expr) -> sympy.Expr:
    if isinstance(quantity, _SPHERES):
        return sympy.Add(*quantity.args[1:])
    return quantity.args[1]


def _scales(observable: sympy.Expr, load: Load) -> dict[sympy.Expr, sympy.Expr]:
    """Every quantity over what it is compared with."""
    scales = {}
    for one in observable.atoms(sy.SiteFunction, *_SPHERES):
        at = {sy.j: _layer(one)}
        if isinstance(one, sy.VerticalPlus | sy.VerticalMinus | sy.VerticalAlong):
            unit = load.unit.xreplace(at)
        elif isinstance(one, sy.ForceAlong):
            unit = load.ordered[int(one.args[0]) - 1].xreplace(at)
        elif isinstance(one, sy.ForcePlus | sy.ForceMinus):
            unit = load.ordered[0 if isinstance(one, sy.ForcePlus) else 1].xreplace(at)
        elif isinstance(one, sy.DeltaX | sy.DeltaR):
            unit = sy.r
        else:
            continue
        scales[one] = one / unit
    return scales
