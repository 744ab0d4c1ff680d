"""Further statements from a printed equation, each false or true by the rule that makes it.

Factors in an index, domains that are too large, one component of a vector, definitions put in,
exact forms, roots, sums split and exchanged. As in ``corpus``, no decision is asked.
"""

from collections.abc import Callable, Iterator
from dataclasses import replace

import sympy
from force_diffusion.symbolic import symbols as sy
from force_diffusion.symbolic.algebra import affine
from force_diffusion.symbolic.kernel.where import Where
from force_diffusion.symbolic.notation import by_name
from force_diffusion.symbolic.printing.text import text
from force_diffusion.symbolic.search.counterexample import counterexample
from force_diffusion.symbolic.search.points import points
from sympy import Add, Pow, Rational, Sum

from .sources import (
    Change,
    Made,
    Source,
    equal,
    over,
    plus,
    put_in,
    times,
)

_MILLIONTH = Rational(1, 10**6)
_FEW = 3  # points at the edge of a domain at which a statement is looked at


# factors


def factor_in_an_index(source: Source) -> Made:
    """False: a factor that differs from place to place."""
    indices = by_name(source.free & {*sy.INDICES, sy.N})
    for one in indices:
        if source.relation == "=":
            yield (
                f"({text(one)} + 1)/{text(one)} times too large",
                source.right(times(one + 1, over(one))),
            )
        if one != sy.M or source.relation == "=":  # else it may be of another order alone
            yield f"it grows with {text(one)}", source.right(times(1 + _MILLIONTH * one))
            yield f"{text(one)}²⁰ times too large", source.right(times(one**20))
    if source.relation != "∝" and (sy.z in source.free or {sy.j, sy.M} <= source.free):
        yield "it grows with the height", source.right(times(1 + _MILLIONTH * sy.z))
        yield "it vanishes at the base", source.right(times(sy.z))
    else:
        yield "no height is in it", source.right(times(1 + sy.z * _MILLIONTH))


# domains


def larger_domains(source: Source, turn: int | None = None) -> Iterator[tuple[str, Where]]:
    """The domain with one more layer at one end, where the equation is false or says nothing.

    That it is, is found on the layer added alone: a sum there ends more than one below its start,
    or explicit packings have other values, or hold no such bead. For a turn there is one of these.
    """
    where = source.where
    if where is None or where.limit:  # a limit does not depend on one layer more
        return
    ends = [n for n, one in enumerate(where.relations) if not isinstance(one, sympy.Eq)]
    start = turn % len(ends) if turn is not None and ends else 0
    for place in (*ends[start:], *ends[:start]):
        one = where.relations[place]
        by = -1 if isinstance(one, sympy.Ge | sympy.Gt) else 1
        more = one.func(one.lhs, one.rhs + by, evaluate=False)
        is_strict = isinstance(one, sympy.Lt | sympy.Gt)
        last = sympy.Eq(one.lhs, one.rhs if is_strict else one.rhs + by, evaluate=False)
        others = where.relations[:place], where.relations[place + 1 :]
        added = replace(where, relations=(*others[0], last, *others[1]))
        if found := _wrong_there(source, added):
            larger = replace(where, relations=(*others[0], more, *others[1]))
            yield f"on a larger domain, {text(more)}: {found}", larger
            if turn is not None:
                return


def _wrong_there(source: Source, added: Where) -> str:
    for series in source.sums():
        _, low, high = series.limits[0]
        length = affine.from_sympy(sympy.expand(high - low))
        for _, at in zip(range(_FEW), points(added), strict=False):
            terms = zip(sy.INDICES, length, strict=False)
            if length[-1] + sum(c * at[one] for one, c in terms if c) < -1:
                return f"a sum over {text(series.limits[0][0])} ends more than one below its start"
    return counterexample(source.printed, added, at_most=_FEW) or ""


# components


def _directions() -> tuple[sympy.Expr, ...]:
    return (sy.e_x, *sy.VECTORS)


def one_sided(source: Source) -> Made:
    """False: nothing, or something else, is said of one component."""
    if not source.is_vector:
        return
    left, right = source.printed.args
    for one in (sy.e_x, sy.e_y):
        (other,) = {sy.e_x, sy.e_y} - {one}
        said = [one * sy.Dot(one, side) if side else side for side in (left, right)]
        yield f"nothing is said along {text(other)}", equal(*said)
        if right:
            yield f"it is zero along {text(other)}", equal(left, said[1])
            without = Add(right, -said[1], evaluate=False)
            yield f"it is zero along {text(one)}", equal(left, without)
            swapped = other * sy.Dot(one, right) + one * sy.Dot(other, right)
            yield "its components are exchanged", equal(left, swapped)
        else:
            yield "a component is doubled in one term", source.right(plus(_MILLIONTH * one))


def another_component(source: Source) -> Made:
    """False: numbers that are no component of both sides."""
    left, right = source.printed.args
    if source.is_vector:
        first = source.radii()[0]
        for one, other in ((sy.e_x, sy.e_y), (sy.e_y, sy.e_x), (sy.n_plus, sy.n_minus)):
            if right:
                words = f"along {text(one)} on the left, along {text(other)} on the right"
                yield words, equal(sy.Dot(one, left), sy.Dot(other, right))
            along = [sy.Dot(one, side) if side else side for side in (left, right)]
            more = Add(along[1], _MILLIONTH * first, evaluate=False)
            yield f"a radius too much along {text(one)}", equal(along[0], more)


def one_component(source: Source) -> Made:
    """True: both sides multiplied by a vector, of what the kernel proves."""
    if source.is_vector and source.where is not None:
        left, right = source.printed.args
        for one in (sy.e_x, sy.e_y, sy.b_plus, sy.b_minus):
            sides = (sy.Dot(one, side) if side else side for side in (left, right))
            yield f"its component along {text(one)}", equal(*sides)


# definitions

_ONE_LESS = 1 - sy.phi**2
_UP, _ACROSS = sy.n_y * sy.e_y, sy.n_x**2 * (sy.b_plus - sy.b_minus)
_BY_OTHERS = {
    sy.b_plus: (sy.n_plus - sy.phi * sy.n_minus) / _ONE_LESS,
    sy.b_minus: (sy.n_minus - sy.phi * sy.n_plus) / _ONE_LESS,
    sy.n_plus: _UP + _ACROSS,
    sy.n_minus: _UP - _ACROSS,
}
_FALSELY = {
    sy.b_plus: (sy.n_plus + sy.phi * sy.n_minus) / _ONE_LESS,
    sy.b_minus: sy.n_minus,
    sy.n_plus: _UP + sy.n_x * (sy.b_plus - sy.b_minus),
    sy.n_minus: _UP + _ACROSS,
}


Radii = Callable[[sympy.Expr, sympy.Expr], sympy.Expr]
"""Radii that stand for Δ at a bead."""


def _second_difference(across: sympy.Expr, layer: sympy.Expr) -> sympy.Expr:
    return sy.SecondDifference(across, layer).doit()


def _lopsided(across: sympy.Expr, layer: sympy.Expr) -> sympy.Expr:
    return _second_difference(across, layer) - sy.DeltaR(across, layer)


def _further(across: sympy.Expr, layer: sympy.Expr) -> sympy.Expr:
    return _second_difference(across + 2, layer)


def _radii_for_delta(radii: Radii) -> Change:
    return lambda side: side.replace(sy.SecondDifference, radii)


def definition(source: Source) -> Made:
    """True: what a symbol stands for is put in."""
    printed = source.printed
    for symbol, image in _BY_OTHERS.items():
        if printed.has(symbol):
            yield f"{text(symbol)} by other vectors", source.both(put_in({symbol: image}))
    if printed.has(sy.SecondDifference):
        yield "Δ by radii", source.both(_radii_for_delta(_second_difference))
    if sy.f_load in source.free:
        yield "⟨f⟩ = f_load/2n_y put in", source.both(times(sy.f_load, over(2 * sy.n_y)))


def wrong_definition(source: Source) -> Made:
    """False: something like a definition is put in."""
    if source.relation == "∝":
        return
    printed = source.printed
    for symbol, image in _FALSELY.items():
        if printed.has(symbol):
            yield f"{text(symbol)} by other vectors, wrongly", source.both(put_in({symbol: image}))
    if printed.has(sy.SecondDifference):
        yield "Δ, half of its middle radius", source.both(_radii_for_delta(_lopsided))
        yield "Δ, two beads further", source.both(_radii_for_delta(_further))
    if sy.f_load in source.free:
        yield "⟨f⟩ = f_load/2n_x on one side", source.right(times(sy.n_y, over(sy.n_x)))
    yield "s is not 4rn_y", source.right(times(sy.spacing, over(4 * sy.r * sy.n_y)))
    yield "s is not 2rn_x", source.right(times(sy.spacing, over(2 * sy.r * sy.n_x)))


def zero_over_zero_beside_a_definition(source: Source) -> Made:
    """False: 0/0 somewhere, beside a symbol for which something is put in before it is read."""
    for where, a in source.zeros():
        by_spacing = times(sy.spacing, over(4 * sy.r * sy.n_x), a, over(a))
        yield f"0/0 at {where}, beside s", source.right(by_spacing)
        if {sy.j, sy.M} <= source.free and sy.z not in source.free:
            by_height = times(1 + sy.z, over(1 + sy.j / sy.M), a, over(a))
            yield f"0/0 at {where}, beside z", source.right(by_height)


# roots


def root_of_what_is_negative(source: Source) -> Made:
    """False: a root that has no value somewhere, or another sign there."""
    half = Rational(1, 2)
    for where, a in source.zeros():
        roots = (Pow(a, half, evaluate=False), Pow(a, -half, evaluate=False))
        yield f"a root of what is negative beside {where}", source.right(times(*roots))
        size = Pow(Pow(a, 2, evaluate=False), half, evaluate=False)
        yield f"another sign beside {where}", source.right(times(size, over(a)))


# exact forms


def exact_form(source: Source) -> Made:
    """True: the exact form in place of the printed one."""
    for form in source.exact:
        if not form.of_one_layer:
            statement = equal(source.printed.lhs, form.expression)
            yield f"the exact form, {form.name}", statement


def form_of_one_layer(source: Source) -> Made:
    """False: the exact form of a layer at an edge."""
    for form in source.exact:
        if form.of_one_layer:
            statement = equal(source.printed.lhs, form.expression)
            yield f"the form of one layer, {form.name}", statement


# sums


def sums_split(source: Source) -> Made:
    """True: a sum in two, or as a double sum."""
    for series in source.sums():
        (m, low, high), body = series.limits[0], series.function
        other = _other_index(source, m)
        if not body.has(sy.Braces):
            for words, apart in (("before its start", low - 1), ("at its end", high)):
                first, second = Sum(body, (m, low, apart)), Sum(body, (m, apart + 1, high))
                both = Add(first, second, evaluate=False)
                yield f"a sum split {words}", source.with_sum(series, both)
        if other is not None:
            half = body / 2
            inside = Sum(Sum(half, (other, 1, 2)), (m, low, high))
            yield "a double sum", source.with_sum(series, inside)
            if not body.has(sy.Braces):  # which are read in the sum over their own index
                exchanged = Sum(Sum(half, (m, low, high)), (other, 1, 2))
                yield "a double sum, its order exchanged", source.with_sum(series, exchanged)


def sums_split_wrongly(source: Source) -> Made:
    """False: a term too many or too few, bounds or sums exchanged as they can't be."""
    for series in source.sums():
        (m, low, high), body = series.limits[0], series.function
        other = _other_index(source, m)
        yield "its bounds exchanged", source.with_sum(series, Sum(body, (m, high, low)))
        if source.relation == "=":
            whole = Sum(body, (m, low, high))
            for words, part in (("last", high), ("first", low)):
                twice = Add(whole, Sum(body, (m, part, part)), evaluate=False)
                yield f"split, its {words} term counted twice", source.with_sum(series, twice)
        if other is not None:
            thrice = Sum(Sum(body / 2, (m, low, high)), (other, 1, 3))
            yield "a double sum, a term too many", source.with_sum(series, thrice)
            outside = Sum(Sum(body, (m, low, high)), (other, m, m))
            yield "a double sum, exchanged with a bound in m", source.with_sum(series, outside)


def _other_index(source: Source, index: sympy.Symbol) -> sympy.Symbol | None:
    (other,) = {sy.m, sy.n} - {index}
    return None if source.printed.has(other) else other
