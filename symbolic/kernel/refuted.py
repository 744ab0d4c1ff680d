"""Why a statement is not proved: where its sides differ. No theorem rests on what is found here."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import cycle, islice

import islpy as isl
import sympy

from .. import sets
from .. import symbols as sy
from ..algebra.bases import LINE_SUM
from ..algebra.exact import FIELD, SITE, NotProvedError, RationalFunction
from ..forms import NUMBER, RADII, Form, Image, Key
from ..printing.text import text
from ..quotients import factored
from .domain import Domain, Limit
from .theorem import FalseStatementError, Groups, flat, names_for


def refuse(
    apart: Sequence[Form],
    domain: Domain,
    groups: Groups = (),
    formula: sympy.Basic = sympy.S.Zero,
) -> NotProvedError:
    """Why two sides of a formula that differ are not equal: that they do somewhere, or may.

    Radii are independent: what holds nothing else is false where a weight differs. Of a vector it
    says along which base vector its sides differ.
    """
    keys = {key for form in apart for key in form.parts}
    if keys <= {NUMBER, RADII} and not any(group.supposed for group in flat(groups)):
        along = ("",) if len(apart) == 1 else (f"along {text(n)}, " for n in LINE_SUM.normals)
        for form, direction in zip(apart, along, strict=True):
            for key, weights in form.parts.items():
                for points, value in weights.pieces:
                    if where := _witness(points, value, domain):
                        own = {there: symbol for symbol, there in names_for(formula).items()}
                        return FalseStatementError(_at_odds(key, where, own, direction))
    return NotProvedError("the normal forms of both sides differ")


def other_order(
    apart: RationalFunction, left: RationalFunction | None, right: RationalFunction, limit: Limit
) -> NotProvedError:
    """How two sides go differently in a limit: what their difference goes as, or their ratio to.

    What goes as a power of H_M has no order that others are compared with.
    """
    if left is None:
        words = f"as {limit.words}, left minus right goes as {shown(apart, limit)}"
    else:
        words = f"as {limit.words}, left over right goes to {shown(left / right, limit)}, not to 1"
    return (NotProvedError if right.holds(sy.H_M) else FalseStatementError)(words)


def other_ratio(ratio: RationalFunction, power: int, limit: Limit) -> NotProvedError:
    """How left over right, to a power that frees it of roots, goes otherwise than the sign says.

    With H_M in it, it may go as the sign says nevertheless.
    """
    which = f", to the power {power}," if power > 1 else ""
    goes = "goes to {}, not to 1" if limit.relation == "=" else "varies as {}, and not with φ alone"
    words = f"as {limit.words}, left over right{which} {goes.format(shown(ratio))}"
    return (NotProvedError if ratio.holds(sy.H_M) else FalseStatementError)(words)


def too_large(dropped: int, kept: int, limit: Limit) -> FalseStatementError:
    """That the variance of what is dropped is not of lower order than that of the force."""
    of_rest, of_force = (text(limit.growing[0] ** power) for power in (dropped, kept))
    return FalseStatementError(
        f"as {limit.words}, the variance of left minus right goes as {of_rest}, and has to be of "
        f"lower order than that of the force, which goes as {of_force}"
    )


def shown(value: RationalFunction, limit: Limit | None = None) -> str:
    """A function in words, of z where that is fixed."""
    if limit and {*limit.growing} == {sy.M, sy.j}:
        value = value.substitute({sy.j: FIELD.generator(sy.z) * FIELD.generator(sy.M)})
    return _short(factored(value.reduced()))


_LONGEST = 400
"""Characters of a value that is shown."""


def _short(value: sympy.Expr) -> str:
    words = text(value)
    return words if len(words) <= _LONGEST else f"an expression of {len(words)} characters"


def _witness(
    points: sets.Set, value: RationalFunction, domain: Domain
) -> tuple[dict[sympy.Symbol, sympy.Integer], dict[sympy.Symbol, sympy.Integer], sympy.Expr] | None:
    """A point at which a function is not zero: its indices, its site, and the value there."""
    for part in sets.parts(points):
        for at in _samples(
            part, [generator for generator in FIELD.generators if value.holds(generator)]
        ):
            numbers = {symbol: sympy.Integer(number) for symbol, number in at.items()}
            constants = {s: FIELD.constant(n) for s, n in numbers.items() if value.holds(s)}
            straight = domain.straight.image
            if value.holds(sy.H_M):
                height = straight.get(sy.M, sy.M).xreplace(numbers)
                constants[sy.H_M] = FIELD.constant(sympy.harmonic(height))
            there = value.substitute(constants)
            if not there.is_zero():
                indices = {
                    index: straight.get(index, index).xreplace(numbers)
                    for index in domain.indices
                    if value.holds(index) or sets.depends_on(part, index)
                }
                return indices, {s: numbers[s] for s in SITE}, factored(there.reduced())
    return None


def _at_odds(key: Key, where: tuple[Image, Image, sympy.Expr], own: Image, direction: str) -> str:
    """How two sides differ at a point, in words, with a user's own symbols."""
    indices, site, value = where[0], where[1], where[2].xreplace(dict(own))
    at = ", ".join(f"{text(symbol)} = {text(number)}" for symbol, number in indices.items())
    if any(name == RADII[0][0] for name, _ in key):
        first, second, *_ = site.values()
        bead = f"({text(first - second)}, {text(first + second)})"
        what = f"the weight of δr_{bead} differs by {_short(value)}"
    else:
        what = f"left minus right is {_short(value)}"
    return f"at {at}: {direction}{what}" if at else direction + what


def _samples(
    points: sets.Set, among: Iterable[sympy.Symbol] = (), most: int = 8
) -> Iterator[Mapping[sympy.Symbol, int]]:
    """Some points of a set, which differ in what it is said by and in symbols ``among``.

    A function may vanish along a line: each symbol in turn goes on, farther each time.
    """
    axes = [
        symbol for symbol in sets.DIMENSIONS if symbol in among or sets.depends_on(points, symbol)
    ]
    idle = (symbol for symbol in sets.DIMENSIONS if symbol not in axes)
    points = points & sets.where(*(sympy.Eq(symbol, 0, evaluate=False) for symbol in idle))
    ahead = points
    for turn, symbol in enumerate(islice(cycle(axes or sets.DIMENSIONS), most), start=1):
        if points.is_empty():
            return
        here = points if ahead.is_empty() else ahead
        at = sets.sample(here)
        yield at
        points = points - isl.Set.from_point(here.sample_point())
        ahead = points & sets.where(sympy.Ge(symbol, at[symbol] + turn, evaluate=False))
