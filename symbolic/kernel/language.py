"""The statements that can be decided: what a candidate may hold so that *proved* has a meaning.

A statement is read over one domain: 0 < z < 1, −½ < φ < ½ with n_x, n_y > 0 to match, positive
radius, spacing, σ, loads and M, and whole indices in their region. Everything in it must have a
value everywhere there. What has none, or is not shown to, is not a statement; what has one and is
written in words that no procedure reads is left undecided.
"""

from collections.abc import Collection

import sympy

from .. import symbols as sy
from ..algebra.exact import Domain, NotExactError
from ..algebra.signs import never_zero
from ..as_printed import in_place
from ..notation import by_name
from ..printing.text import text
from .decisions import Ruling, not_a_statement, undecided

SUMMATION = (sy.m, sy.n)
"""The indices that a candidate may sum over: no derivation puts anything in for them."""

HIGHEST_POWER, LARGEST_BOUND = 40, 1000
"""What is higher or larger is not read: it would take for ever."""

_NO_NUMBERS = {sympy.oo, -sympy.oo, sympy.zoo, sympy.nan}
_FORCES = (sy.ForcePlus, sy.ForceMinus)
_OF_THE_PLANE = {sy.n_x, sy.n_y, sy.spacing, *sy.VECTORS}
_GEOMETRY = {sy.phi, sy.r, *_OF_THE_PLANE}
_LAYERS = (sy.j, sy.l, sy.site_s)
_ACROSS = {sy.i, sy.k, sy.site_r}


class OutsideError(ValueError):
    """Something has no place in the language: it is not read."""


class NoMeaningError(OutsideError):
    """Something has no value, or no single meaning."""


def unreadable(
    candidate: sympy.Eq,
    printed: Collection[sympy.Eq],
    named: Collection[sympy.Basic] = (),
    dimension: int = 2,
) -> Ruling | None:
    """Why a candidate for one of the printed equations is no statement, or not read; None: it is.

    ``named`` are further symbols of the derivation, ``dimension`` is that of its packing.
    """
    own = set().union(*(line.free_symbols for line in printed))
    try:
        _refuse_strangers(candidate, _known(own, named, dimension))
        if across := by_name((_counting(candidate) & _ACROSS) - _counting(*printed)):
            raise OutsideError(
                f"{text(across[0])} says where a bead is, and is no number in this equation"
            )
        if {_sort(side) for side in candidate.args} == {"number", "vector"}:
            raise NoMeaningError("a number is set equal to a vector")
        _refuse_sums(candidate, own | candidate.free_symbols)
        _refuse_forces_in_sums(candidate)
    except NoMeaningError as reason:
        return not_a_statement(str(reason))
    except OutsideError as reason:
        return undecided(str(reason))
    return None


def is_of_vectors(equation: sympy.Eq) -> bool:
    """Whether it equates vectors, and not numbers."""
    return "vector" in map(_sort, equation.args)


def _known(
    own: Collection[sympy.Basic], named: Collection[sympy.Basic], dimension: int
) -> set[sympy.Basic]:
    """What may stand free in a candidate: an index only in a role that the equation has for it."""
    known = _GEOMETRY | set(own)
    known |= {one for one in named if isinstance(one, sympy.Symbol) and one not in SUMMATION}
    if sy.z not in own:  # it is averaged over, or there is no height
        known.discard(sy.z)
    if {sy.j, sy.M} <= known:
        known.add(sy.z)
    elif sy.z in known:
        known.add(sy.j)
    return known - _OF_THE_PLANE if dimension != 2 else known


def _counting(*nodes: sympy.Basic) -> set[sympy.Basic]:
    """The symbols that are numbers there, and not only the place of a bead."""
    found: set[sympy.Basic] = set()
    for node in nodes:
        if not isinstance(node, sy.SiteFunction):
            found |= {node} if isinstance(node, sympy.Symbol) else _counting(*node.args)
    return found


def usual_form(candidate: sympy.Eq, printed: Collection[sympy.Eq]) -> sympy.Eq:
    """The same statement about a printed left-hand side, where it can be brought to that.

    s = 4 r n_x is put in, and z = j/M where no z is printed. Sides are exchanged; what is all on
    one side is taken apart; factors beside the subject that vanish nowhere go to the other side.
    """
    image = {sy.spacing: 4 * sy.r * sy.n_x}
    if not any(line.has(sy.z) for line in printed):
        image[sy.z] = sy.j / sy.M
    left, right = (in_place(side, image) for side in candidate.args)
    subjects = [line.lhs for line in printed]
    if left == 0 or (right in subjects and left not in subjects):
        left, right = right, left
    if right == 0 and isinstance(left, sympy.Add):
        for term in left.args:
            if term in subjects:
                rest = [-other for other in left.args if other is not term]
                return sympy.Eq(term, sympy.Add(*rest, evaluate=False), evaluate=False)
    for subject in subjects:
        if left != subject and (ratio := _over(left, subject)):
            above, below = ratio
            others = _factors(right)
            for factor in above:
                if factor in others:
                    others.remove(factor)
                elif right:
                    others.append(sympy.Pow(factor, -1, evaluate=False))
            return sympy.Eq(subject, sympy.Mul(*others, *below, evaluate=False), evaluate=False)
    return sympy.Eq(left, right, evaluate=False)


def _over(side: sympy.Expr, subject: sympy.Expr) -> tuple[list[sympy.Expr], ...] | None:
    """Factors of a side over those of the subject, if all of them vanish nowhere."""
    above, below = _factors(side), []
    for part in _factors(subject):
        if part in above:
            above.remove(part)
        else:
            below.append(part)
    return (above, below) if all(map(never_zero, (*above, *below))) else None


def _factors(side: sympy.Expr) -> list[sympy.Expr]:
    if not isinstance(side, sympy.Mul):
        return [side]
    return [factor for part in side.args for factor in _factors(part)]


def says_less(candidate: sympy.Eq, printed: sympy.Eq) -> str:
    """Why it may say less than the printed equation of what that is about; "" when it does not.

    What is multiplied by a factor that vanishes somewhere says nothing there.
    """
    known = _GEOMETRY | {*sy.INDICES, *sy.PARAMETERS} | printed.rhs.free_symbols
    observed = by_name(printed.lhs.free_symbols - known)
    if not observed or (candidate.lhs == printed.lhs and not candidate.rhs.has(observed[0])):
        return ""
    told, meant = (sympy.diff(one.lhs - one.rhs, observed[0]) for one in (candidate, printed))
    domain = Domain(by_name(told.free_symbols | meant.free_symbols))
    try:
        if never_zero((domain.from_sympy(told) / domain.from_sympy(meant)).to_sympy()):
            return ""
    except NotExactError:
        pass
    return f"it is not shown to tell {text(observed[0])} everywhere"


def _refuse_strangers(candidate: sympy.Basic, known: Collection[sympy.Basic]) -> None:
    names = {symbol.name for symbol in known}
    summed = {*SUMMATION} - candidate.free_symbols
    for symbol in by_name(candidate.atoms(sympy.Symbol) - set(known) - summed):
        if symbol.name in names:
            raise NoMeaningError(
                f"{symbol.name}: not this equation's symbol, but another of the same name; take "
                "it from .symbols"
            )
        raise NoMeaningError(f"{symbol.name} is no symbol of this equation")


def _sort(node: sympy.Basic) -> str:
    """Whether it is a "number", a "vector", or the "zero" that is either.

    Raises:
        OutsideError: it has no place in the language.
    """
    if node in _NO_NUMBERS:
        raise NoMeaningError(f"{text(node)} is no number")
    if isinstance(node, sympy.Rational):
        return "number" if node else "zero"
    if isinstance(node, sympy.Symbol):
        return "vector" if node in sy.VECTORS else "number"
    if isinstance(node, sy.SiteFunction):
        if any(_number(index).has(sy.SiteFunction) for index in node.args):
            raise NoMeaningError(f"an index of {text(node)} holds what belongs to a bead")
        return "vector" if node.is_vector else "number"
    if isinstance(node, sympy.Add):
        return _one_sort(node.args)
    if isinstance(node, sympy.Mul):
        sorts = [_sort(factor) for factor in node.args]
        if sorts.count("vector") > 1:
            raise NoMeaningError("a product of two vectors: write it as Dot")
        return "zero" if "zero" in sorts else max(sorts)
    if isinstance(node, sympy.Pow):
        return _power(_number(node.base), node.exp)
    if isinstance(node, sympy.Sum):
        return _sum(node)
    if isinstance(node, sy.Braces):
        _number(node.args[2]), _number(node.args[3])
        return _one_sort(node.args[:2])
    if isinstance(node, sy.Dot | sy.MatrixTimes):
        *entries, vector = node.args
        if isinstance(node, sy.MatrixTimes):
            _one_sort((*entries, sympy.S.One))
            entries = []
        if any(_sort(part) == "number" for part in (*entries, vector)):
            raise NoMeaningError(f"{type(node).__name__} of a number")
        return "number" if isinstance(node, sy.Dot) else "vector"
    _refuse_decimal(node)
    raise OutsideError(f"{type(node).__name__} has no place in what is decided here")


def _refuse_decimal(node: sympy.Basic) -> None:
    if isinstance(node, sympy.Float):
        exact = "write exact numbers, such as Rational(3, 2) for 1.5"
        raise OutsideError(f"it holds the decimal {float(node)!r}: {exact}")


def _number(node: sympy.Basic) -> sympy.Basic:
    if _sort(node) == "vector":
        raise NoMeaningError(f"a vector, {text(node)}, where a number is needed")
    return node


def _one_sort(parts: Collection[sympy.Basic]) -> str:
    sorts = {_sort(part) for part in parts} - {"zero"}
    if len(sorts) > 1:
        raise NoMeaningError("a number and a vector are added, or stand in one case distinction")
    return sorts.pop() if sorts else "zero"


def _power(base: sympy.Basic, exponent: sympy.Basic) -> str:
    _refuse_decimal(exponent)
    if not isinstance(exponent, sympy.Rational):
        raise OutsideError(f"{text(exponent)} is an exponent, and no number")
    if abs(exponent) > HIGHEST_POWER:
        raise OutsideError(f"the power {exponent} is not read: {HIGHEST_POWER} is the highest")
    if base == 0 and exponent.is_negative:
        raise NoMeaningError("it holds a division by zero")
    return "number"


def _sum(series: sympy.Sum) -> str:
    for limit in series.limits:
        if len(limit) != 3:
            raise NoMeaningError("a sum without a lower and an upper bound")
        for end in limit[1:]:
            _number(end)
            if any(abs(number) > LARGEST_BOUND for number in end.atoms(sympy.Rational)):
                raise OutsideError(f"a sum's bound beyond {LARGEST_BOUND} is not read")
        if (limit[2] - limit[1]).is_Rational and limit[2] < limit[1] - 1:
            raise NoMeaningError(
                f"a sum from {text(limit[1])} to {text(limit[2])} has no agreed value"
            )
    return _sort(series.function)


def _refuse_sums(candidate: sympy.Basic, free: Collection[sympy.Basic]) -> None:
    for series in candidate.atoms(sympy.Sum):
        bound = [limit[0] for limit in series.limits]
        inner = {limit[0] for one in series.function.atoms(sympy.Sum) for limit in one.limits}
        for place, index in enumerate(bound):
            if index not in SUMMATION:
                names = " or ".join(map(text, SUMMATION))
                raise OutsideError(f"a sum over {text(index)}: write it over {names}")
            if index in free:
                raise NoMeaningError(f"{text(index)} is summed over and stands for itself as well")
            if index in inner or index in bound[:place] or _in_own_bounds(series, index):
                raise NoMeaningError(f"two sums over {text(index)}, one inside of the other")


def _in_own_bounds(series: sympy.Sum, index: sympy.Symbol) -> bool:
    return any(end.has(index) for limit in series.limits if limit[0] == index for end in limit[1:])


def _refuse_forces_in_sums(candidate: sympy.Eq) -> None:
    summed = {limit[0] for one in candidate.atoms(sympy.Sum) for limit in one.limits}
    for force in by_name(candidate.atoms(*_FORCES)):
        if force.free_symbols & summed:
            raise OutsideError(f"the force {text(force)} stands in a sum")
