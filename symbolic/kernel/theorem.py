"""What a theorem is: an equation between dual numbers, where it holds, and what it rests on.

A theorem is made by the rules of this package and by nothing else. Quantities that belong to the
disordered packing are dual numbers: an ordered value, and a change of first order in the
deviations of the radii; products of two changes are dropped. So an equation holds "to first order"
when both of its sides are the same dual number, as weights on sites: the one normal form.
"""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import InitVar, dataclass, replace
from functools import cached_property, lru_cache, partial
from typing import NoReturn

import sympy

from .. import sets
from .. import symbols as sy
from ..algebra.bases import LINE_SUM
from ..algebra.exact import (
    CONSTANTS,
    FIELD,
    SITE,
    SOURCE,
    UNKNOWNS,
    NotAStatementError,
    NotProvedError,
)
from ..forms import FORCES, Form, Image, Known, Reader, is_whole
from ..notation import by_name
from ..printing.text import text
from ..second_order import Means
from ..signs import never_zero
from ..trees import equation, in_place
from ..weights import Weights
from .domain import Domain, Loading

_MADE_HERE = object()
_RESERVED = {*SITE, *SOURCE, *UNKNOWNS, *CONSTANTS[0], *CONSTANTS[1]}


class FalseStatementError(NotProvedError):
    """A statement is false, and where."""


@dataclass(frozen=True, eq=False)
class Supposition:
    """That statements hold for the value ``before`` that of an index, until an induction ends it.

    Nor is anything put in for the symbols of the value from which that induction starts: steps are
    counted from there.
    """

    index: sympy.Symbol
    start: sympy.Expr
    before: int
    members: tuple[tuple[sympy.Eq, Domain], ...]

    @property
    def fixed(self) -> set[sympy.Symbol]:
        """The symbols for which nothing else may be put in."""
        return {self.index, *self.start.free_symbols}


@dataclass(frozen=True, eq=False, repr=False)
class Theorem:
    """A proved equation.

    Attributes:
        formula: the equation; dual numbers, or vectors of them.
        domain: for which indices, loads and packings it holds.
        rule: the rule that proved it, in words.
        premises: the theorems that it rests on.
        supposed: the suppositions that it rests on, each of an induction not yet ended.
        assuming: unproved assumptions that it rests on, in words, such as "Gaussian forces".
    """

    formula: sympy.Eq
    domain: Domain
    rule: str
    premises: tuple["Theorem", ...] = ()
    supposed: frozenset[Supposition] = frozenset()
    assuming: frozenset[str] = frozenset()
    made_by: InitVar[object] = None

    def __post_init__(self, made_by: object) -> None:
        if made_by is not _MADE_HERE:
            raise TypeError("only rules of the kernel make theorems")

    def __repr__(self) -> str:
        left, right = map(text, self.formula.args)
        return f"<Theorem, by {self.rule}: {left} = {right}>"

    def __reduce__(self) -> NoReturn:
        raise TypeError("a theorem is neither copied nor pickled")

    @cached_property
    def fixed(self) -> set[sympy.Symbol]:
        """The symbols for which nothing is put in: those of its suppositions."""
        return set().union(*(supposition.fixed for supposition in self.supposed))

    @cached_property
    def subject(self) -> tuple[sympy.Expr, sympy.Expr]:
        """The one quantity that it is about, and what that equals.

        Raises:
            NotProvedError: it is not about one quantity, times what vanishes nowhere.
        """
        return isolated(self.formula, self.domain)


def made(
    formula: sympy.Eq,
    domain: Domain,
    rule: str,
    premises: Iterable[Theorem] = (),
    *,
    supposed: Iterable[Supposition] = (),
    ended: Iterable[Supposition] = (),
    assuming: Iterable[str] = (),
) -> Theorem:
    """Make a theorem: for the rules of this package.

    It rests on all suppositions of its premises but those of inductions that have ended, and on all
    that they assume.

    Raises:
        TypeError: a premise is no theorem.
    """
    premises = tuple(dict.fromkeys(premises))
    if not all(type(premise) is Theorem for premise in premises):
        raise TypeError("a theorem rests on theorems only")
    supposed = {*supposed}.union(*(premise.supposed for premise in premises)) - {*ended}
    assumed = frozenset(assuming).union(*(premise.assuming for premise in premises))
    return Theorem(formula, domain, rule, premises, frozenset(supposed), assumed, _MADE_HERE)


Group = Theorem | tuple[Theorem, ...]
Groups = tuple[Group, ...]
"""Theorems to be put in one after the other; those of a tuple at once."""


def flat(groups: Groups) -> Iterator[Theorem]:
    """All theorems of groups."""
    for group in groups:
        yield from group if isinstance(group, tuple) else (group,)


# what is a statement


def check_domain(formula: sympy.Eq, domain: Domain, *, in_a_limit: bool = False) -> None:
    """Refuse what is no equation on a domain that says what its indices are.

    Raises:
        NotAStatementError: with the reason.
        NotProvedError: it is a statement in a limit, which this rule does not prove.
    """
    if (domain.limit is not None) != in_a_limit:
        raise NotProvedError("it is one in a limit" if domain.limit else "it is not one in a limit")
    if not isinstance(formula, sympy.Eq):
        raise NotAStatementError("it is not an equation")
    if domain.points.is_empty():
        raise NotAStatementError(f"its domain is empty: {domain}")
    free = set().union(*(side.free_symbols for side in formula.args))
    for symbol in by_name(free & {*sy.INDICES} - {*domain.indices}):
        raise NotAStatementError(f"its domain does not say what {text(symbol)} is")
    if domain.dimension > 2 and free & {sy.n_x, sy.n_y}:
        raise NotAStatementError(f"{text(sy.n_x)} and {text(sy.n_y)} belong to discs")
    if free & _RESERVED:
        raise NotAStatementError("it uses a name that the kernel reserves")
    if domain.loading and (both := by_name(_summed(formula) & domain.loading.fixed)):
        raise NotAStatementError(f"{text(both[0])} is both the place of the load and summed over")


def isolated(formula: sympy.Eq, domain: Domain) -> tuple[sympy.Expr, sympy.Expr]:
    """The one quantity that an equation is about, and what that equals.

    A quantity, or its component along n⁺ or n⁻, is a factor of the left-hand side.

    Raises:
        NotProvedError: the equation does not fix it everywhere.
    """
    factors = sympy.Mul.make_args(formula.lhs)
    about = [quantity for quantity in factors if _is_quantity(quantity)]
    if len(about) != 1 or formula.rhs.has(about[0]):
        raise NotProvedError(f"{text(formula.lhs)} is not a single quantity times a known factor")
    others = [quantity for quantity in factors if quantity != about[0]]
    for factor in others:
        is_power = isinstance(factor, sympy.Pow) and isinstance(factor.base, FORCES)
        if is_power and factor.exp.is_negative:
            continue
        if factor.has(sy.SiteFunction) or not never_zero(
            domain.reader().scalar(factor), domain.points, domain.dimension
        ):
            raise NotProvedError(f"{text(factor)} is not shown to vanish nowhere")
    inverse = sympy.Mul(*others, evaluate=False)
    value = formula.rhs if inverse == 1 else sympy.Mul(formula.rhs, 1 / inverse, evaluate=False)
    return about[0], value


def _is_quantity(node: sympy.Basic) -> bool:
    if isinstance(node, sy.Dot):
        return node.args[0] in (sy.n_plus, sy.n_minus) and isinstance(node.args[1], sy.SiteFunction)
    return isinstance(node, sy.SiteFunction)


# what theorems say, put in


@lru_cache(maxsize=4096)
def known_quantities(
    groups: Groups, loading: Loading | None, kind: type[Form] = Form
) -> Mapping[type, tuple[Known, ...]]:
    """What theorems say of quantities, in terms of what those of later groups say.

    Raises:
        NotProvedError: one is of other loads, or says of no single quantity what it is.
    """
    if not groups:
        return {}
    if kind is not Form:
        top = loading.place[-1] if loading else None
        return Means(known_quantities(groups, loading), top).jets()
    later = known_quantities(groups[1:], loading)
    first: dict[type, tuple[Known, ...]] = {}
    for theorem in flat(groups[:1]):
        about, what = _what_it_says(_under(theorem, loading), later, _named(groups, loading))
        first[about] = (*first.get(about, ()), what)
    return {key: first.get(key, ()) + later.get(key, ()) for key in {**first, **later}}


def _under(theorem: Theorem, loading: Loading | None) -> Theorem:
    """A theorem at the place that a load has.

    Raises:
        NotProvedError: it is of other loads.
    """
    own = theorem.domain.loading
    if own is None or (loading is not None and loading.implies(own)):
        return theorem
    pairs = zip(own.place, loading.place if loading else (), strict=False)
    image = {symbol: at for symbol, at in pairs if symbol != at}
    if not all(symbol.is_Symbol for symbol in image) or own.put_in(image) != loading:
        raise NotProvedError(f"{text(theorem.formula.lhs)} is known under another load")
    return instance(theorem, image, theorem.domain.put_in(image))


def instance(theorem: Theorem, image: Image, domain: Domain) -> Theorem:
    """A theorem with other indices, on a domain that lies in its own at these.

    Raises:
        NotProvedError: it does not hold there.
    """
    for symbol, at in image.items():
        if symbol not in sy.INDICES or not is_whole(at):
            raise NotProvedError(
                f"{text(symbol)} = {text(at)} is not a whole number, as an index must be"
            )
    there = theorem.domain.put_in(image)
    symbols = set().union(*(value.free_symbols for value in image.values())) & {*sy.INDICES}
    is_free = symbols <= {*domain.indices} and not theorem.fixed & {*image}
    if not (domain.shares_packings_of(there) and is_free and domain.lies_in(there)):
        raise NotProvedError(f"{text(theorem.formula.lhs)} is not known there")
    formula = with_indices(theorem.formula, image)
    check_domain(formula, domain)
    return made(formula, domain, "putting in other indices", (theorem,))


def with_indices(formula: sympy.Eq, image: Image) -> sympy.Eq:
    """An equation with other indices put in, none of which it sums over.

    Raises:
        NotProvedError: an index would have two meanings.
    """
    if sy.M in image and formula.has(sy.H_M):
        raise NotProvedError(f"{text(sy.H_M)} is that of the height {text(sy.M)} alone")
    if image and formula.has(sy.z):
        raise NotProvedError(f"{text(sy.z)} is the height of one layer alone")
    put_in = {*image}.union(*(value.free_symbols for value in image.values()))
    if both := by_name(bound_in(formula) & put_in):
        raise NotProvedError(f"{text(both[0])} would have two meanings")
    return equation(*(side.xreplace(dict(image)) for side in formula.args))


def bound_in(formula: sympy.Basic) -> set[sympy.Symbol]:
    """The indices over which a formula sums, and those over which it averages."""
    return _summed(formula).union(*(mean.args[2:] for mean in formula.atoms(sy.MeanOver)))


def _summed(formula: sympy.Basic) -> set[sympy.Symbol]:
    """The indices over which a formula sums."""
    summed = {limit[0] for atom in formula.atoms(sympy.Sum) for limit in atom.limits}
    return summed | ({sy.m, sy.n} if formula.has(sy.MeanOver) else set())


def _what_it_says(
    theorem: Theorem, later: Mapping[type, tuple[Known, ...]], named: set[sympy.Symbol]
) -> tuple[type, Known]:
    """What a theorem says of a quantity, by the coordinates of the quantity's bead.

    It holds for every value of its indices, but of those ``named``, which stand for one value.
    """
    domain = theorem.domain
    if domain.limit is not None or domain.dimension != 2:
        raise NotProvedError(f"{text(theorem.formula.lhs)} is known in a limit, or elsewhere")
    if theorem.formula.has(sy.z):
        raise NotProvedError(f"{text(sy.z)} is the height of one layer alone")
    subject, value = theorem.subject
    quantity = subject.args[1] if isinstance(subject, sy.Dot) else subject
    reader = replace(domain.reader(), known=later)
    if quantity.is_vector and not isinstance(subject, sy.Dot):
        forms: tuple[Form, ...] = reader.vector(value)
    else:
        forms = (reader.number(value),)
    if isinstance(subject, sy.Dot):
        axis = LINE_SUM.normals.index(subject.args[0])
        whole = list(reader.vector(quantity))
        whole[axis] = forms[0]
        forms = tuple(whole)
    site = reader.site(*quantity.args)
    here = zip(SOURCE, site, strict=False)
    points = reader.points & sets.where(*(sympy.Eq(a, b, evaluate=False) for a, b in here))
    bound = tuple(symbol for symbol in domain.indices if symbol not in named)
    given = sets.fixed(points, bound)
    for symbol in bound:
        if symbol not in given and sets.depends_on(points, symbol):
            raise NotProvedError(f"{text(theorem.formula.lhs)} does not say what {text(symbol)} is")
    by_bead = {symbol: given[symbol].to_sympy() for symbol in bound if symbol in given}
    forms = tuple(form.on(points).renamed(by_bead).without(*bound).merged() for form in forms)
    for form in forms:
        for factor, _ in (pair for key in form.parts for pair in key):
            if not isinstance(factor, str) and factor.free_symbols & {*bound}:
                raise NotProvedError(f"{text(value)} has a force at an unknown place")
    return type(quantity), Known(sets.without(points, *bound), forms)


# both sides of an equation


Sides = tuple[tuple[Form, ...], tuple[Form, ...]]


def read(formula: sympy.Eq, domain: Domain, groups: Groups = ()) -> Sides:
    """Both sides as forms, theorems put in; numbers, or components of vectors.

    Raises:
        NotAStatementError: a side has no value, or no single one, somewhere on the domain.
        NotProvedError: it is not read.
    """
    check_domain(formula, domain)
    return both_sides(formula, domain, knowing(domain.reader(), domain, groups))


def knowing(reader: Reader, domain: Domain, groups: Groups, kind: type[Form] = Form) -> Reader:
    """A reader on a domain that puts theorems in, one group after the other."""
    facts = known_quantities(groups, domain.loading, kind)  # type: ignore[arg-type]
    theorems = [_under(theorem, domain.loading) for theorem in flat(groups)]
    places = (domain, *(theorem.domain for theorem in theorems))
    for symbol in by_name(_named(groups, domain.loading)):
        images = (each.straight.image.get(symbol) for each in places if symbol in each.indices)
        if len({*images}) > 1:
            raise NotProvedError(f"{text(symbol)} is the place of a bead in one domain alone")
    fixed = reader.fixed.union(*(theorem.fixed for theorem in theorems))
    return replace(reader, known=facts, kind=kind, fixed=fixed)


def _named(groups: Groups, loading: Loading | None) -> set[sympy.Symbol]:
    """Indices that stand for the same wherever theorems are put in under a load."""
    place = loading.fixed if loading else ()
    return {*place}.union(*(theorem.fixed for theorem in flat(groups)))


def in_kernel_symbols(formula: sympy.Eq, domain: Domain) -> tuple[sympy.Expr, sympy.Expr]:
    """Both sides, in the symbols of the exact field."""
    left, right = (written_out(side, domain, names_for(formula)) for side in formula.args)
    return left, right


def written_out(side: sympy.Expr, domain: Domain, names: Image | None = None) -> sympy.Expr:
    """A side in which s is 4rn_x, and z is j/M with j and M; and names put in."""
    image = {**(names or {}), sy.spacing: 4 * sy.r * sy.n_x}
    if {sy.j, sy.M} <= {*domain.indices}:
        image[sy.z] = sy.j / sy.M
    return in_place(side, {symbol: value for symbol, value in image.items() if side.has(symbol)})


def both_sides(formula: sympy.Eq, domain: Domain, reader: Reader) -> Sides:
    """Both sides of an equation as forms; the number 0 beside a vector is the zero vector."""
    left, right = (
        side if isinstance(side, tuple) else (side,)
        for side in map(reader.read, in_kernel_symbols(formula, domain))
    )
    if len(left) != len(right):
        if any(form.parts for form in min(left, right, key=len)):
            raise NotAStatementError("a number is set equal to a vector")
        left, right = (side if len(side) == 2 else (Form(), Form()) for side in (left, right))
    return left, right


def names_for(*expressions: sympy.Basic) -> dict[sympy.Symbol, sympy.Symbol]:
    """Generators of the exact field for symbols that are none of this package's.

    Raises:
        NotProvedError: there are too many of them.
    """
    ours = {*FIELD.position, *sy.VECTORS}
    foreign = set().union(*(expression.free_symbols for expression in expressions)) - ours
    image: dict[sympy.Symbol, sympy.Symbol] = {}
    for positive, names in zip((True, False), CONSTANTS, strict=True):
        symbols = [symbol for symbol in by_name(foreign) if bool(symbol.is_positive) == positive]
        if len(symbols) > len(names):
            raise NotProvedError(f"it has more than {len(names)} symbols of your own")
        image |= dict(zip(symbols, names, strict=False))
    return image


def difference(sides: Sides, domain: Domain) -> tuple[Form, ...]:
    """Left less right side, in few pieces; nothing is left of it where they agree."""
    apart = [(a - b).on(domain.points) for a, b in zip(*sides, strict=True)]
    height = sets.fixed(domain.points).get(sy.M, FIELD.zero).to_sympy()
    if sy.M not in domain.straight.image and 0 < height <= _HIGHEST:
        harmonic = {sy.H_M: FIELD.from_sympy(sympy.harmonic(height))}
        numbers = partial(Weights.mapped, change=lambda value: value.substitute(harmonic))
        apart = [form.mapped(numbers) for form in apart]
    return tuple(form.merged() for form in apart)


_HIGHEST = 10_000
"""Up to this height H_M is a number where M is."""
