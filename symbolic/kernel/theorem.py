"""What a theorem is: an equation between dual numbers, where it holds, and what it rests on.

A theorem is made by the rules of this room and by nothing else. Quantities that belong to the
disordered packing are dual numbers: an ordered value, and a change of first order in the
deviations of the radii; products of two changes are dropped. So an equation holds "to first order"
when both of its sides are the same dual number, which one normal form decides.
"""

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import InitVar, dataclass
from functools import cached_property, lru_cache

import sympy

from .. import symbols as sy
from ..algebra import affine
from ..algebra.bases import CARTESIAN, LINE_SUM, Basis
from ..algebra.exact import UNKNOWNS, NotExactError, RationalFunction
from ..algebra.linear_forms import LinearForm
from ..algebra.reading import Reader
from ..as_printed import equation
from ..notation import by_name
from ..printing.text import text
from .where import Mapped, Where

SUMMATION = (sy.m, sy.n)
"""The indices that a statement may sum over."""

_SPARE = (*SUMMATION, sy.p, sy.q)
"""Those that a sum may be over once facts are put in."""

FORCES = (sy.ForcePlus, sy.ForceMinus)
_PLANE = {sy.n_x, sy.n_y, sy.spacing, *sy.VECTORS}
_MADE_HERE = object()


class NotProvedError(ValueError):
    """A rule does not prove a statement, and why."""


class DisprovedError(NotProvedError):
    """A rule finds that a statement is false, and where or how."""


class NotAStatementError(NotProvedError):
    """What is written has no value, or no single one, somewhere on its domain."""


@dataclass(frozen=True, eq=False)
class Supposition:
    """That a statement holds for one value of an index, until an induction ends it.

    Nor is anything put in for the symbols of the value from which that induction starts: steps are
    counted from there.
    """

    index: sympy.Symbol
    start: sympy.Expr = sympy.S.Zero

    @property
    def fixed(self) -> set[sympy.Basic]:
        """The symbols for which nothing else may be put in."""
        return {self.index, *self.start.free_symbols}


@dataclass(frozen=True, eq=False)
class Theorem:
    """A proved equation.

    Attributes:
        formula: the equation; dual numbers, or vectors of them.
        where: for which indices, loads and packings it holds.
        rule: the rule that proved it, in words.
        premises: the theorems that it rests on.
        supposed: the suppositions that it rests on, each of an induction not yet ended.
        assuming: what it rests on that no rule ends, in words, such as "the forces are Gaussian".
    """

    formula: sympy.Eq
    where: Where
    rule: str
    premises: tuple["Theorem", ...] = ()
    supposed: frozenset[Supposition] = frozenset()
    assuming: frozenset[str] = frozenset()
    made_by: InitVar[object] = None

    def __post_init__(self, made_by: object) -> None:
        if made_by is not _MADE_HERE:
            raise TypeError("a theorem is made by the rules of the kernel alone")

    @cached_property
    def indices(self) -> tuple[sympy.Symbol, ...]:
        """The indices for which others may be put in: all but those of a supposition."""
        return tuple(symbol for symbol in self.where.indices if symbol not in self.fixed)

    @cached_property
    def fixed(self) -> set[sympy.Basic]:
        """The symbols of its suppositions."""
        return set().union(*(one.fixed for one in self.supposed))

    @cached_property
    def solved(self) -> tuple[sympy.Expr, sympy.Expr]:
        """What it is about, alone, and what that equals.

        Raises:
            NotProvedError: it is not about one quantity, times what vanishes nowhere.
        """
        return isolated(self.formula, self.where)


def made(
    formula: sympy.Eq,
    where: Where,
    rule: str,
    premises: Iterable[Theorem] = (),
    *,
    supposed: Iterable[Supposition] = (),
    ended: Iterable[Supposition] = (),
    assuming: Iterable[str] = (),
) -> Theorem:
    """Make a theorem: for the rules of this room.

    It rests on all suppositions of its premises but those of inductions that have ended, and on all
    that they assume.
    """
    premises = tuple(premises)
    open_ones = frozenset(supposed).union(*(one.supposed for one in premises)) - frozenset(ended)
    assumed = frozenset(assuming).union(*(one.assuming for one in premises))
    return Theorem(formula, where, rule, premises, open_ones, assumed, _MADE_HERE)


# what is a statement


def check(formula: sympy.Eq, where: Where, *, in_a_limit: bool = False) -> None:
    """Refuse what has no value, or no single one, somewhere on the domain.

    Raises:
        NotAStatementError: with the reason.
        NotProvedError: it is a statement in a limit, which this rule does not prove.
    """
    if (where.limit is not None) != in_a_limit:
        raise NotProvedError("it is one in a limit" if where.limit else "it is not one in a limit")
    if not isinstance(formula, sympy.Eq):
        raise NotAStatementError("it is no equation")
    if where.is_empty:
        raise NotAStatementError(f"nothing is in its domain: {where}")
    known = set(where.indices)
    if undeclared := by_name(set().union(*(one.free_symbols for one in where.relations)) - known):
        raise NotAStatementError(f"its domain does not say what {text(undeclared[0])} is")
    free = set().union(*(side.free_symbols for side in formula.args))
    for symbol in by_name(free & set(sy.INDICES)):
        if symbol not in known:
            raise NotAStatementError(f"its domain does not say what {text(symbol)} is")
    if reserved := by_name(free & {*UNKNOWNS[0], *UNKNOWNS[1]}):
        raise NotAStatementError(f"{text(reserved[0])} is a name of the kernel's own")
    if where.dimension < 2:
        raise NotAStatementError("a packing has two dimensions or more")
    if where.dimension != 2 and (found := by_name(free & _PLANE)):
        raise NotAStatementError(f"{text(found[0])} belongs to the plane")
    for side in formula.args:
        _check(side, where, frozenset(known))


def _check(node: sympy.Basic, where: Where, outer: frozenset[sympy.Symbol]) -> None:
    if isinstance(node, sympy.Sum):
        for index, low, high in reversed(node.limits):
            if index not in SUMMATION:
                raise NotAStatementError(f"a sum over {text(index)}: write it over m or n")
            if index in outer:
                raise NotAStatementError(f"two meanings of {text(index)}")
            first, last = (affine.from_sympy(end) for end in (low, high))
            length = affine.shifted(affine.add(last, first, -1), 1)
            if not where.nonnegative(length):
                raise NotAStatementError(
                    f"the sum over {text(index)} from {text(low)} to {text(high)} may end more "
                    "than one below its start, where it has no agreed value"
                )
            where, outer = where.within(index, low, high), outer | {index}
        _check(node.function, where, outer)
        return
    if isinstance(node, sy.SiteFunction):
        if type(node) not in _QUANTITIES:
            raise NotAStatementError(f"{type(node).__name__} is no quantity of a packing")
        try:
            if not where.on_lattice(*node.args):
                raise NotAStatementError(f"{text(node)} is not shown to be at a bead")
        except NotExactError as reason:
            raise NotAStatementError(str(reason)) from None
        return
    if isinstance(node, _MOMENTS) and any(one.has(*_MOMENTS) for one in node.args):
        raise NotAStatementError("a moment of a moment")
    if isinstance(node, sympy.Pow):
        _check_power(node, where)
    elif not (isinstance(node, (*_READ, sympy.Rational)) or node.is_Symbol) or (
        not node.is_commutative
    ):
        raise NotAStatementError(f"{type(node).__name__} is not in the language of statements")
    for argument in node.args:
        _check(argument, where, outer)


_MOMENTS = (sy.Moment, sy.LargestShare, sy.LargestWeight)
_READ = (sympy.Add, sympy.Mul, sy.Dot, sy.MatrixTimes, sy.Braces, *_MOMENTS)
_QUANTITIES = {
    *FORCES, sy.VerticalPlus, sy.VerticalMinus, sy.DeltaNMinus, sy.DeltaNPlus, sy.DeltaR,
    sy.DeltaX, sy.Load, sy.Position, sy.SecondDifference,
}  # fmt: skip


def _check_power(power: sympy.Pow, where: Where) -> None:
    base, exponent = power.args
    if not isinstance(exponent, sympy.Rational):
        raise NotAStatementError(f"the power {text(exponent)} is not read here")
    if not exponent.is_Integer:
        has_root = where.sign(base) == 1 or (exponent > 0 and _never_negative(base, where))
        if not has_root:
            raise NotAStatementError(f"{text(base)}, of which a root is taken, may be negative")
        return
    if exponent > 0:
        return
    if isinstance(base, FORCES) or (isinstance(base, sympy.Symbol) and base.is_positive):
        return  # a force that others are compared with is one that acts
    if not where.never_zero(base):
        raise NotAStatementError(f"the divisor {text(base)} is not shown to differ from zero")


def _never_negative(node: sympy.Expr, where: Where) -> bool:
    """Whether it is a variance, or such times what is positive, or a sum of these."""
    if isinstance(node, sympy.Mul):
        return all(_never_negative(one, where) or where.sign(one) == 1 for one in node.args)
    if isinstance(node, sympy.Sum):
        return _never_negative(node.function, where.within(*node.limits[0]))
    return isinstance(node, sy.Variance)


# normal forms

Forms = tuple[LinearForm, ...]
Place = tuple[object, ...]
"""A quantity and its site, as far as the domain tells them apart."""


def basis(*together: sympy.Expr) -> Basis:
    """Components in which expressions are read: Cartesian ones where a matrix acts on a vector."""
    return CARTESIAN if any(one.has(sy.MatrixTimes) for one in together) else LINE_SUM


class Normal:
    """Normal forms of expressions on one domain; unknown numbers have one meaning in all of them.

    Args:
        where: the domain.
        together: every expression that will be read.
    """

    def __init__(self, where: Where, *together: sympy.Expr):
        self.where = where
        held = set().union(*(one.atoms(*FORCES, sympy.Symbol) for one in together))
        bound = {index for one in together for index in _summed(one)}
        if any(isinstance(one, FORCES) and bound & one.free_symbols for one in held):
            raise NotProvedError("a force is summed over, which is not one unknown number")
        known = {*sy.INDICES, *sy.PARAMETERS, *sy.VECTORS, *UNKNOWNS[0], *UNKNOWNS[1]}
        left = [list(reversed(UNKNOWNS[0])), list(reversed(UNKNOWNS[1]))]
        for used in held & {*UNKNOWNS[0], *UNKNOWNS[1]}:
            for one in left:
                if used in one:
                    one.remove(used)
        self._image: dict[sympy.Basic, sympy.Expr] = {}
        sites = self._sites = dict[Place, sympy.Expr]()
        for one in by_name(held - known):
            is_force = isinstance(one, FORCES)
            key = _site(one, where) if is_force else (one,)
            if key not in sites:
                spare = left[0 if is_force or one.is_positive else 1]
                if not spare:
                    raise NotExactError("too many unknown numbers in one statement")
                sites[key] = spare.pop()
            self._image[one] = sites[key]
        self._reader = Reader(where, basis(*together), first_order=True)

    def __call__(self, expression: sympy.Expr) -> Forms:
        """The normal form: one, or two of a vector.

        Raises:
            NotProvedError: it could not be read.
        """
        inside = _on(expression.xreplace({**self._image}), self.where)
        try:
            read = self._reader.read(inside)
        except (NotExactError, ZeroDivisionError, RecursionError) as reason:
            raise NotProvedError(str(reason)) from None
        return read if isinstance(read, tuple) else (read,)

    def never_zero(
        self, value: RationalFunction, spared: Mapping[Place, int] | None = None
    ) -> bool:
        """Whether a number is shown to vanish nowhere; a force may, or powers of it ``spared``."""
        forces = {self._sites[place]: place for place in self._sites if place[0] in FORCES}
        plain = []
        for one in sympy.Mul.make_args(value.to_sympy()):
            base, exponent = one.as_base_exp()
            if not (base in forces and 0 < -exponent <= (spared or {}).get(forces[base], 0)):
                plain.append(one)
        rest = sympy.Mul(*plain)
        return not rest.has(*forces) and self.where.never_zero(rest)

    def difference(self, formula: sympy.Eq) -> Forms:
        """Left less right side; the number 0 beside a vector is the zero vector."""
        left, right = map(self, formula.args)
        if len(left) != len(right):
            small, large = sorted((left, right), key=len)
            if not small[0].is_zero():
                raise NotProvedError("a number is set equal to a vector")
            left, right = (side if side is large else (LinearForm(),) * 2 for side in (left, right))
        return tuple(a - b for a, b in zip(left, right, strict=True))


def _summed(expression: sympy.Basic) -> set[sympy.Basic]:
    """The indices of its sums."""
    return {limit[0] for one in expression.atoms(sympy.Sum) for limit in one.limits}


def _site(atom: sy.SiteFunction, where: Where) -> Place:
    inside = (_on(one, where) for one in atom.args)
    return (type(atom), *(affine.from_sympy(sympy.expand(one)) for one in inside))


def _on(expression: sympy.Expr, where: Where) -> sympy.Expr:
    """The same with indices that equations of the domain fix put in."""
    return expression.xreplace(where.solved) if where.solved else expression


def holds(formula: sympy.Eq, where: Where) -> bool:
    """Whether both sides have the same normal form on all of the domain."""
    return all(one.is_zero() for one in Normal(where, *formula.args).difference(formula))


# one quantity of an equation alone


def subject(side: sympy.Expr) -> sympy.Expr | None:
    """What a side is about: a quantity that is a factor of it, or an unknown number alone.

    The mean of a force at second order is a quantity, too.
    """
    found = [one for one in sympy.Mul.make_args(side) if _is_quantity(one)]
    if len(found) == 1:
        return found[0]
    known = {*sy.INDICES, *sy.PARAMETERS, *sy.VECTORS}
    return side if isinstance(side, sympy.Symbol) and side not in known else None


def _is_quantity(node: sympy.Basic) -> bool:
    if isinstance(node, sy.Shift):
        return isinstance(node.args[0], FORCES)
    return isinstance(node, sy.SiteFunction)


def isolated(formula: sympy.Eq, where: Where) -> tuple[sympy.Expr, sympy.Expr]:
    """What an equation is about, and what that equals.

    Raises:
        NotProvedError: the equation does not fix it everywhere.
    """
    about = subject(formula.lhs)
    if divisors(formula.rhs, where):
        raise NotProvedError(f"{text(formula.rhs)} divides by a force, which may vanish")
    if about is not None and not formula.rhs.has(about):
        factors = [one for one in sympy.Mul.make_args(formula.lhs) if one != about]
        others = sympy.Mul(*factors, evaluate=False)  # a force over itself is not one
        if others == 1:
            return about, formula.rhs
        if not fixes(others, where):
            raise NotProvedError(f"{text(others)} is not shown to vanish nowhere")
        return about, sympy.Mul(formula.rhs, sympy.Pow(others, -1), evaluate=False)
    raise NotProvedError(f"{text(formula.lhs)} is not one quantity, times what vanishes nowhere")


def fixes(factor: sympy.Expr, where: Where) -> bool:
    """Whether a factor of a quantity vanishes nowhere; a force that it is divided by does not."""
    held = (one for one in sympy.Mul.make_args(factor) if not _divides(one))
    return where.never_zero(sympy.Mul(*held, evaluate=False))


def _divides(power: sympy.Basic) -> bool:
    """Whether it is the inverse of a force, or of a power of it."""
    return isinstance(power, sympy.Pow) and isinstance(power.base, FORCES) and power.exp.is_negative


def divisors(node: sympy.Basic, where: Where, image: Mapped | None = None) -> Counter[Place]:
    """The forces that an equation divides by, with their powers; at another place by an image.

    An equation so divided says no more than the same multiplied by them, as they may vanish.
    """
    if _divides(node):
        return Counter({_site(node.base.xreplace(dict(image or {})), where): -int(node.exp)})
    total: Counter[Place] = Counter()
    for one in node.args:
        part = divisors(one, where, image)
        total = total | part if isinstance(node, sympy.Add | sympy.Eq) else total + part
    times = int(node.exp) if isinstance(node, sympy.Pow) and node.exp.is_positive else 1
    return Counter({place: times * power for place, power in total.items()})


# what is known, put in

Facts = Sequence["Theorem | tuple[Theorem, ...]"]
"""Theorems to be put in one after the other; those of a tuple at once."""


def put_in(expression: sympy.Expr, facts: Facts, where: Where, background: Facts) -> sympy.Expr:
    """Put in what theorems say of the quantities in an expression, where they hold."""
    for one in facts:
        together = one if isinstance(one, tuple) else (one,)
        expression = _put_in(expression, together, where, background)
    return expression


def _put_in(
    node: sympy.Expr, together: tuple[Theorem, ...], where: Where, background: Facts
) -> sympy.Expr:
    image: dict[sympy.Basic, sympy.Expr] = {}
    bound: set[sympy.Basic] = set()
    for series in node.atoms(sympy.Sum):
        inner = where
        for index, low, high in reversed(series.limits):
            inner = inner.within(index, low, high)
            bound.add(index)
        summed = _put_in(series.function, together, inner, background)
        if summed != series.function:
            image[series] = sympy.Sum(summed, *series.limits)
    for atom in node.atoms(sy.SiteFunction):
        if bound and atom.free_symbols & bound:
            continue  # it stands in a sum
        for theorem in together:
            found = _instance_of(theorem, atom, where, background)
            if found is not None:
                image[atom] = found
                break
    return node.xreplace(image) if image else node


@lru_cache(maxsize=20_000)
def _instance_of(
    theorem: Theorem, atom: sympy.Expr, where: Where, background: Facts
) -> sympy.Expr | None:
    """What a theorem says of a quantity, if it holds there."""
    about, value = theorem.solved
    (kind, own), (wanted_kind, wanted_at) = map(_kind_and_place, (about, atom))
    if kind != wanted_kind:
        return None
    image = placed(theorem, own, wanted_at, where)
    if image is None or not applies(theorem, image, where, background):
        return None
    wanted = [affine.from_sympy(sympy.expand(_on(a - b.xreplace(image), where)))
              for a, b in zip(wanted_at, own, strict=True)]  # fmt: skip
    if any(any(one) for one in wanted):
        return None
    found = _renamed(value, image, where).xreplace(image)
    return None if found.has(atom) else found  # the same quantity again says nothing


def _kind_and_place(quantity: sympy.Expr) -> tuple[tuple[type, ...], tuple[sympy.Expr, ...]]:
    """What a quantity is, and where; the mean of a force is where that is."""
    if isinstance(quantity, sy.Shift):
        return (sy.Shift, type(quantity.args[0])), quantity.args[0].args
    return (type(quantity),), quantity.args


def _renamed(value: sympy.Expr, image: Mapped, where: Where) -> sympy.Expr:
    """A value whose sums are over other indices than those of the domain and those put in."""
    taken = {*where.indices}.union(*(one.free_symbols for one in image.values()))
    for series in value.atoms(sympy.Sum):
        if taken & {limit[0] for limit in series.limits}:
            (index,) = {limit[0] for limit in series.limits}
            spare = [one for one in _SPARE if one not in taken and not series.has(one)]
            if not spare:
                raise NotProvedError(f"{text(index)} would have two meanings")
            value = value.xreplace({series: series.xreplace({index: spare[0]})})
    return value


def placed(
    theorem: Theorem, at: tuple[sympy.Expr, ...], wanted: tuple[sympy.Expr, ...], where: Where
) -> dict[sympy.Symbol, sympy.Expr] | None:
    """The indices for which a theorem speaks of the wanted place: found by elimination.

    It is not trusted: that the place is the wanted one is checked where it is used.
    """
    image: dict[sympy.Symbol, sympy.Expr] = {}
    own, here = theorem.where.loading, where.loading
    if own and here and own.everywhere and own.name == here.name:
        image = {s: e for s, e in zip(own.place, here.place, strict=True) if s in theorem.indices}
    unknown = [s for s in theorem.indices if s not in image and any(one.has(s) for one in at)]
    try:
        rows = list(_rows(unknown, image, at, wanted, where))
    except NotExactError:
        return None
    found: dict[sympy.Symbol, _Row] = {}
    for place, symbol in enumerate(unknown):
        for number, (factors, rest) in enumerate(rows):
            c = factors[place]
            if c and not any(one % c for one in (*factors, *rest)):
                others = (*factors[:place], 0, *factors[place + 1 :])
                value = tuple(-one // c for one in others), tuple(-one // c for one in rest)
                rows[number] = (0,) * len(unknown), affine.ZERO
                rows = [_with(row, place, value) for row in rows]
                found = {s: _with(row, place, value) for s, row in found.items()}
                found[symbol] = value
                break
        else:
            return None
    return image | {symbol: affine.to_sympy(rest) for symbol, (_, rest) in found.items()}


_Row = tuple[tuple[int, ...], affine.Affine]
"""The factors of unknown indices, and what is known."""


def _rows(
    unknown: Sequence[sympy.Symbol],
    image: Mapped,
    at: tuple[sympy.Expr, ...],
    wanted: tuple[sympy.Expr, ...],
    where: Where,
) -> Iterator[_Row]:
    """What must vanish if a place is the wanted one."""
    known = {s: affine.from_sympy(_on(one, where)) for s, one in {**where.solved, **image}.items()}
    for one, other in zip(at, wanted, strict=True):
        rest = affine.from_sympy(one)
        factors = tuple(affine.coefficient(rest, symbol) for symbol in unknown)
        for symbol in unknown:
            rest = affine.without(rest, symbol)
        yield (
            factors,
            affine.add(affine.put_in(rest, known), affine.from_sympy(_on(other, where)), -1),
        )


def _with(row: _Row, place: int, value: _Row) -> _Row:
    """A row with the value of an unknown index put in."""
    factors, rest = row
    c, left = factors[place], (*factors[:place], 0, *factors[place + 1 :])
    together = tuple(a + c * b for a, b in zip(left, value[0], strict=True))
    return together, affine.add(rest, value[1], c)


def applies(theorem: Theorem, image: Mapped, where: Where, background: Facts) -> bool:
    """Whether a theorem, at another place, holds on all of a domain and under its loads.

    Indices of which the image does not speak stand for themselves.
    """
    own = theorem.where
    if own.dimension != where.dimension or own.limit is not None:
        return False
    for one in own.relations:
        moved = one.func(*(side.xreplace(image) for side in one.args), evaluate=False)
        if not where.implies(moved):
            return False
    for one in own.even:
        if not where.is_even(affine.from_sympy(sympy.expand(one.xreplace(image)))):
            return False
    if own.loading is None:
        return True
    if own.loading.everywhere or not own.loading.given:
        return own.loading.put_in(image) == where.loading
    return all(_given(one, where, background) for one in own.loading.put_in(image).given)


def _given(one: sympy.Eq, where: Where, background: Facts) -> bool:
    """Whether a theorem's condition on loads and forces holds by the loading, or by theorems."""
    if where.loading and one in where.loading.given:
        return True
    known = put_in(one.lhs, background, where, ())
    try:
        return holds(equation(known, one.rhs), where)
    except (NotProvedError, NotExactError):
        return False


def flat(facts: Facts) -> Iterator[Theorem]:
    """All theorems among facts, each once."""
    seen: set[int] = set()
    for one in facts:
        for theorem in one if isinstance(one, tuple) else (one,):
            if id(theorem) not in seen:
                seen.add(id(theorem))
                yield theorem
