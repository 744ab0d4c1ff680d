"""Statements that are false, and true ones in another form, made from a printed equation by rule.

Each is false, or true, for the reason that its rule states, which no decision is asked about. A
checker must prove none of the false ones and refute none of the true ones. What says nothing at
some place of the domain, or has no meaning, counts as false: it is not the equation.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import product

import sympy
from force_diffusion.symbolic import symbols as sy
from force_diffusion.symbolic.kernel.where import Where
from force_diffusion.symbolic.notation import by_name
from force_diffusion.symbolic.printing.text import text
from sympy import Add, Mul, Pow, Rational, Sum

from . import variations
from .sources import (
    Made,
    Source,
    Zeros,
    equal,
    over,
    plus,
    put_in,
    times,
)

Rule = Callable[[Source], Made]

_MILLIONTH = Rational(1, 10**6)


@dataclass(frozen=True)
class Statement:
    """One statement, whether it holds, of which kind it is, and why.

    Its domain is that of the printed equation, or ``where``.
    """

    holds: bool
    kind: str
    reason: str
    equation: sympy.Eq
    where: Where | None = None


# false: what has no value, or says nothing, somewhere in the domain


def _at_zero(source: Source, zeros: Zeros) -> Made:
    for where, a in zeros:
        yield f"0/0 at {where}", source.right(times(a, over(a)))
        yield f"0/0 at {where}, squared", source.right(times(a**2, over(a, 2)))


def _zero_over_zero(source: Source) -> Made:
    yield from _at_zero(source, source.zeros())


def _zero_over_zero_below(source: Source) -> Made:
    yield from _at_zero(source, ((f"φ = {c}", sy.phi - c) for c in source.cosines if c < 0))


def _zero_over_zero_above(source: Source) -> Made:
    yield from _at_zero(source, ((f"φ = {c}", sy.phi - c) for c in source.cosines if c > 0))


def _zero_over_zero_on_the_left(source: Source) -> Made:
    for where, a in source.zeros():
        yield f"0/0 at {where}, on the left", source.left(times(a, over(a)))


def _divided(source: Source) -> Made:
    for where, a in source.zeros():
        yield f"both sides divided by zero at {where}", source.both(times(over(a)))


def _added_and_taken_off(source: Source) -> Made:
    for where, a in source.zeros():
        pole = source.term(over(a))
        both = Add(pole, -pole, evaluate=False)
        yield f"∞ − ∞ at {where}", source.right(plus(both))


def _nothing_said(source: Source) -> Made:
    for where, a in source.zeros():
        yield f"0 = 0 at {where}", source.both(times(a))
    yield "0 = 0", source.both(times(sympy.Integer(0)))


def _pole(source: Source) -> Made:
    small = source.size if source.relation in "≈∼" else sympy.Integer(10**6)
    for (where, a), power in product(source.zeros(), (1, 2)):
        one = 1 + over(a, power) / small
        yield f"a pole at {where}", source.right(times(one))


# false: another size


def _another_factor(source: Source) -> Made:
    if source.relation == "∝":
        return
    for factor in (sympy.Integer(2), -sympy.S.One, 1 + _MILLIONTH, 1 - _MILLIONTH, Rational(2, 3)):
        yield f"{factor} times too large", source.right(times(factor))
    for cosine in (
        1 + sy.phi,
        1 + sy.phi * _MILLIONTH,
        1 + sy.phi**2,
        1 - sy.phi**2,
        2 * sy.n_x**2,
    ):
        yield "another function of φ", source.right(times(cosine))
    yield "another function of φ", source.right(times(sy.n_y, over(sy.n_x)))


def _another_power(source: Source) -> Made:
    scales = [s for s in (sy.M, sy.l, sy.j, sy.sigma, sy.r) if s in source.printed.rhs.free_symbols]
    for scale in scales if source.relation != "=" else ():
        for power in (1, -1, Rational(1, 2), Rational(-1, 3)):
            yield f"{text(scale)}^({power}) too much", source.right(times(Pow(scale, power)))


def _added(source: Source) -> Made:
    if source.relation == "∝":
        return
    unit = source.printed.rhs if source.relation == "∼" else source.term(sympy.Integer(1))
    yield "a constant too much", source.right(plus(_MILLIONTH * unit))
    if not source.is_vector:
        weight = sy.M**2 if source.relation == "≈" else _MILLIONTH
        for radius in source.radii():
            yield "a radius too much", source.right(plus(weight * radius))


def _in_one_component(direction: sympy.Expr) -> Rule:
    def rule(source: Source) -> Made:
        if source.is_vector:
            for radius in (sympy.Integer(1), *source.radii()):
                term = _MILLIONTH * radius * direction
                yield f"{text(radius)} too much along {text(direction)}", source.right(plus(term))

    return rule


def _up_to(highest: int, layer: sympy.Symbol) -> sympy.Expr:
    """The layer, but no more than the highest, as a sum whose bounds are in order."""
    one, zero, last = map(sympy.Integer, (1, 0, highest))
    return Sum(sy.Braces(one, zero, sy.m, last), (sy.m, 1, layer))


def _near_the_base(source: Source) -> Made:
    for layer in (sy.j, sy.l, sy.site_s):
        if source.relation == "=" and layer in source.free:
            place = source.within(layer, 2)
            below, at, above = (_up_to(place + one, layer) for one in (-1, 0, 1))
            once = 2 * at - above - below  # 1 in that layer, and 0 in all others
            wrong = source.right(plus(source.term(_MILLIONTH) * once))
            yield f"wrong at {text(layer)} = {place} alone", wrong


def _as_large_somewhere(source: Source) -> Made:
    if source.relation not in "≈∼":
        return
    places = [*source.heights(), *((f"φ = {c}", sy.phi - c) for c in source.cosines)]
    for (where, a), (grows, even) in product(places, ((2, 2), (1, 2), (3, 4), (4, 2))):
        bump = 1 + over(1 + source.size**grows * a**even)
        yield f"twice as large at {where}, of lower order beside it", source.right(times(bump))


def _negative_or_zero(source: Source) -> Made:
    if source.relation != "∝":
        return
    yield "it is negative", source.right(times(sympy.Integer(-1)))
    yield "it is negative", source.right(times(sy.phi - 1))
    yield "it is negative", source.right(times(sy.phi**2 - 1, over(sy.n_x)))
    for c in source.cosines:
        a = sy.phi - c
        yield f"it changes its sign at φ = {c}", source.right(times(a))
        yield f"it vanishes at φ = {c}", source.right(times(a**2))
        yield f"it has a pole at φ = {c}", source.right(times(over(a, 2)))
        large = 1 + sy.M * a**2
        yield f"another order at φ = {c}", source.right(times(large, over(sy.M)))
    yield "it depends on the height", source.right(times(sy.z))


# false: sums


def _sums(source: Source) -> Made:
    for series in source.sums():
        (m, low, high), body = series.limits[0], series.function
        if source.relation == "=":  # elsewhere two terms are of an order that is dropped
            yield "two terms too many", source.with_sum(series, Sum(body, (m, low, high + 2)))
            yield "two terms too few", source.with_sum(series, Sum(body, (m, low + 2, high)))
        for words, other in (
            ("divided by the index", Sum(body * over(m), (m, low, high))),
            ("another weight", Sum(body * m, (m, low, high))),
            ("another weight", Sum(body * (1 + _MILLIONTH), (m, low, high))),
            ("divided by zero in the sum", Sum(times(m - 2, over(m - 2))(body), (m, low, high))),
        ):
            yield words, source.with_sum(series, other)


def _empty_sums(source: Source) -> Made:
    for series in source.sums():
        (m, low, high), body = series.limits[0], series.function
        if source.relation == "=":
            short = Sum(body, (m, low, high - 1)) + body.xreplace({m: high})
            first = [body.xreplace({m: low + step}) for step in (0, 1)]
            long = Add(*first, Sum(body, (m, low + 2, high)))
            yield "a last term where the sum is empty", source.with_sum(series, short)
            yield "first terms where the sum is empty", source.with_sum(series, long)
        turned = -Sum(body, (m, high + 1, low - 1))
        yield "bounds reversed, the empty sum is 0", source.with_sum(series, turned)


def _cases_in_sums(source: Source) -> Made:
    for series in source.sums():
        (m, low, high), body = series.limits[0], series.function
        found = by_name(body.atoms(sy.Braces))
        for braces in found:
            first, second, index, last = braces.args

            def with_case(
                other: sympy.Expr, end: sympy.Expr, s: sympy.Sum = series, b: sympy.Expr = braces
            ) -> sympy.Eq:
                (at, start, _), inside = s.limits[0], s.function
                return source.with_sum(s, Sum(inside.xreplace({b: other}), (at, start, end)))

            yield "the upper case dropped", with_case(braces, last)
            above = sy.Braces(first, second, index, high)
            yield "a case that starts above the sum's end", with_case(above, last)
            yield "one case everywhere", with_case(above, high)
            below = sy.Braces(first, second, index, low - 1)
            yield "the other case everywhere", with_case(below, high)
            swapped = sy.Braces(second, first, index, last)
            yield "the cases swapped", with_case(swapped, high)
            halved = sy.Braces(first, second, index, sy.j - 20)
            yield "a case at j − 20, which may be below the sum", with_case(halved, high)
        if not found:
            for end, words in ((low, "after the first term"), (low - 1, "everywhere")):
                doubled = sy.Braces(sympy.Integer(1), sympy.Integer(2), m, end)
                yield (
                    f"doubled {words}",
                    source.with_sum(series, Sum(doubled * body, (m, low, high))),
                )
            beyond = sy.Braces(sympy.Integer(0), sympy.Integer(1), m, high + 1)
            other = Sum(beyond * body, (m, low, high))
            yield "the case of its whole range is zero", source.with_sum(series, other)


def _no_meaning(source: Source) -> Made:
    radius, unit = sy.DeltaR(sy.m, sy.m), source.term(sympy.Integer(1))
    for series in source.sums():
        (m, low, high), body = series.limits[0], series.function
        for index in by_name(source.free & set(sy.INDICES)):
            other = Sum(body.xreplace({m: index}), (index, low, high))
            yield f"{text(index)} is free and summed over", source.with_sum(series, other)
        yield "a sum up to its own index", source.with_sum(series, Sum(body, (m, low, m)))
        twice = Sum(Sum(body, (m, low, high)), (m, 1, 1))
        yield "one index for two sums", source.with_sum(series, twice)
    shadowed = Sum(Sum(radius, (sy.m, 1, sy.m)), (sy.m, 1, 2)) * unit
    yield "a shadowed index", source.right(plus(shadowed))
    yield "a sum over φ", source.right(plus(Sum(sy.phi, (sy.phi, 1, 2)) * unit))
    yield (
        "a number and a vector added",
        source.right(plus(sympy.Integer(1) if source.is_vector else sy.n_plus)),
    )
    yield "an unknown symbol", source.right(plus(sympy.Symbol("t") * unit))
    yield "infinity", source.right(plus(sympy.oo * unit))
    yield "a float", source.right(times(sympy.Float("1.0000001")))
    yield "an angle", source.right(times(1 + sympy.sin(sy.phi)))
    for symbol in by_name(source.free):
        stranger = sympy.Symbol(symbol.name, real=True)
        factor = Mul(symbol, over(stranger), evaluate=False)
        yield f"{symbol.name} in two roles", source.right(times(factor))


# true


def _circle(source: Source) -> Made:
    one = sy.n_x**2 + sy.n_y**2
    yield "n_x² + n_y² = 1", source.right(times(one))
    yield "n_x² + n_y² = 1", source.right(times(over(one)))
    yield (
        "1 − φ² = 4n_x²n_y²",
        source.right(times(4 * sy.n_x**2 * sy.n_y**2, over(1 - sy.phi**2))),
    )
    yield "2n_y² = 1 + φ", source.right(times(1 + sy.phi, over(2 * sy.n_y**2)))
    yield "2n_x² = 1 − φ", source.right(times(2 * sy.n_x**2, over(1 - sy.phi)))
    yield "s = 4rn_x", source.right(times(sy.spacing, over(4 * sy.r * sy.n_x)))
    for old, new in (
        (1 - sy.phi**2, 4 * sy.n_x**2 * sy.n_y**2),
        (sy.phi, sy.n_y**2 - sy.n_x**2),
        (sy.phi, 1 - 2 * sy.n_x**2),
    ):
        if source.printed.has(old):
            image = {old: new}
            yield f"{text(old)} = {text(new)}", source.both(put_in(image))


def _safe_divisor(source: Source) -> Made:
    divisors = [1 + sy.phi**2, 2 + sy.phi, 1 - sy.phi, 1 + 2 * sy.phi, 3 + sy.phi - sy.phi**2]
    divisors += [sy.n_x, sy.n_x + sy.n_y, 1 + 2 * sy.n_x * sy.n_y, 4 * sy.n_x**2 - 1, sy.r]
    if sy.M in source.free:
        divisors += [sy.M, sy.M + 1]
    if sy.z in source.free:
        divisors += [sy.z, 1 - sy.z, 1 + sy.z, 1 + sy.z - sy.z**2, sy.z**2 - sy.z + 1]
    for a in divisors:
        yield f"{text(a)} vanishes nowhere", source.right(times(a, over(a)))


def _multiple(source: Source) -> Made:
    two = sympy.Integer(2)
    for factor in (two, -two, sy.r, 1 + sy.phi, over(2 - sy.phi), sy.n_x):
        yield f"times {text(factor)}", source.both(times(factor))


def _rearranged(source: Source) -> Made:
    left, right = source.printed.args
    yield "sides exchanged", equal(right, left)
    if right:
        yield "all on one side", equal(Add(left, -right, evaluate=False), sympy.Integer(0))
        three = Add(right, right, -right, evaluate=False)
        yield "thrice less twice", equal(left, three)
        yield "expanded", equal(left, sympy.expand(right))


def _sums_rewritten(source: Source) -> Made:
    for series in source.sums():
        (m, low, high), body = series.limits[0], series.function
        if not body.has(sy.Braces):
            shifted = Sum(body.xreplace({m: m + 1}), (m, low - 1, high - 1))
            yield "the index shifted", source.with_sum(series, shifted)
            mirrored = Sum(body.xreplace({m: low + high - m}), (m, low, high))
            yield "summed from its end", source.with_sum(series, mirrored)
            always = sy.Braces(sympy.Integer(1), sympy.Integer(2), m, high + 1)
            other = Sum(always * body, (m, low, high))
            yield "a case above the sum's end", source.with_sum(series, other)
        (other_index,) = {sy.m, sy.n} - {m}
        if not source.printed.has(other_index):
            renamed = Sum(body.xreplace({m: other_index}), (other_index, low, high))
            yield "another name of the index", source.with_sum(series, renamed)


def _sums_apart(source: Source) -> Made:
    for series in source.sums():
        (m, low, high), body = series.limits[0], series.function
        for braces in body.atoms(sy.Braces):
            first, second, _, last = braces.args
            below = Sum(body.xreplace({braces: first}), (m, low, last))
            above = Sum(body.xreplace({braces: second}), (m, last + 1, high))
            yield "a sum for each case", source.with_sum(series, below + above)
        # no contact is below the base or above the surface
        if not body.has(sy.Braces, sy.DeltaNPlus, sy.DeltaNMinus):
            ends = body.xreplace({m: low - 1}) + body.xreplace({m: high + 1})
            more = Sum(body, (m, low - 1, high + 1)) - ends
            yield "a term at each end added and taken off", source.with_sum(series, more)


def _lower_order(source: Source) -> Made:
    if source.relation not in "≈∼":
        return
    big = source.size
    for one in (
        1 + 1 / big,
        1 - 10**6 / big,
        big / (big + 1),
        1 + sy.phi / (big * (1 - sy.phi**2)),
        1 + sy.n_x / (big * (1 + sy.phi**2)),
        1 + 1 / (big + sy.j),
    ):
        yield "of lower order everywhere", source.right(times(one))
    if source.relation == "≈":
        for radius in (sy.DeltaR(sy.i, sy.j), sy.M * sy.DeltaR(sy.i - sy.j, 0)):
            yield "a radius whose variance is dropped", source.right(plus(radius))
    if sy.z in source.free:
        in_layers = {sy.z: sy.j / sy.M}
        yield "z = j/M", source.both(lambda side: side.xreplace(in_layers))
        yield "lower order", source.right(times(1 + 1 / (big * (1 + sy.z))))


def _in_proportion(source: Source) -> Made:
    if source.relation != "∝":
        return
    seven = sympy.Integer(7)
    for factor in (seven, 2 + sy.phi, sy.n_x, over(1 - sy.phi), over(sy.n_y), 1 + 2 * sy.phi):
        yield "positive for every φ", source.right(times(factor))
    if sy.M in source.free:
        for factor in (1 + 1 / sy.M, 1 - 10**6 / sy.M, 2 + sy.phi / sy.M):
            yield "the same order", source.right(times(factor))


_DIRECTIONS = (sy.b_plus, sy.b_minus, sy.e_y, sy.n_plus - sy.n_minus)

FALSE: dict[str, tuple[Rule, ...]] = {
    "zero over zero": (
        _zero_over_zero,
        _zero_over_zero_below,
        _zero_over_zero_above,
        _zero_over_zero_on_the_left,
        variations.zero_over_zero_beside_a_definition,
        _divided,
    ),
    "a root of what is negative": (variations.root_of_what_is_negative,),
    "infinite terms": (_added_and_taken_off, _pole),
    "nothing said": (_nothing_said,),
    "another size": (_another_factor, _another_power, _added),
    "a factor in an index": (variations.factor_in_an_index,),
    "another component": (
        *map(_in_one_component, _DIRECTIONS),
        variations.one_sided,
        variations.another_component,
    ),
    "another definition": (variations.wrong_definition,),
    "the form of one layer": (variations.form_of_one_layer,),
    "wrong in one layer": (_near_the_base,),
    "as large at one place": (_as_large_somewhere,),
    "not positive": (_negative_or_zero,),
    "another sum": (_sums, _empty_sums, variations.sums_split_wrongly),
    "another case in a sum": (_cases_in_sums,),
    "no meaning": (_no_meaning,),
}
"""Rules of what is false, by kind."""

TRUE: dict[str, tuple[Rule, ...]] = {
    "circle relation": (_circle,),
    "divisor that vanishes nowhere": (_safe_divisor,),
    "multiple": (_multiple,),
    "rearranged": (_rearranged,),
    "sum rewritten": (_sums_rewritten, _sums_apart, variations.sums_split),
    "one component": (variations.one_component,),
    "definition": (variations.definition,),
    "exact form": (variations.exact_form,),
    "lower order": (_lower_order,),
    "in proportion": (_in_proportion,),
}
"""Rules of what is true, by kind."""


LARGER = "a larger domain"
"""The kind of what is false because it is said on too large a domain."""


def statements(source: Source, turn: int | None = None) -> Iterator[Statement]:
    """Yield all statements, or, for a turn, one of each rule: another one for another turn."""
    for reason, where in variations.larger_domains(source, turn):
        yield Statement(False, LARGER, reason, source.printed, where)
    for holds, kinds in ((False, FALSE), (True, TRUE)):
        for kind, rules in kinds.items():
            for rule in rules:
                made = [one for one in rule(source) if one[1] != source.printed]
                if source.dimension != 2:  # n_x and n_y are of the plane
                    made = [one for one in made if not (holds and one[1].has(sy.n_x, sy.n_y))]
                if turn is not None and made:
                    made = [made[turn % len(made)]]
                for reason, equation in made:
                    yield Statement(holds, kind, reason, equation)
