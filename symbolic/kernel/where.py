"""Where a statement holds: whole indices and relations between them, and the load.

The relations are affine, so that what follows from them is decided: by Fourier–Motzkin elimination
over the rationals, with constants rounded to whole numbers. What is found to follow does follow at
every integer point; what needs the integers more than that is not found, and nothing is proved
from it.
"""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property, lru_cache
from itertools import product
from math import gcd
from typing import Any

import sympy

from .. import symbols as sy
from ..algebra import affine
from ..algebra.affine import Affine
from ..algebra.exact import Domain, NotExactError
from ..algebra.signs import sign
from ..mechanics import lattice
from ..notation import by_name
from ..printing.text import text

Mapped = Mapping[sympy.Basic, sympy.Expr]
"""What is put in for symbols."""

LATTICE = ((sy.i, sy.j), (sy.k, sy.l), (sy.site_r, sy.site_s))
"""Indices of beads, across and up: their sum is even."""

_SIGNS = {sympy.Eq: "=", sympy.Le: "≤", sympy.Lt: "<", sympy.Ge: "≥", sympy.Gt: ">"}
_TURNED = {sympy.Ge: sympy.Le, sympy.Gt: sympy.Lt}
_MANY = 4000  # rows of an elimination; beyond that nothing is decided


@dataclass(frozen=True)
class Loading:
    """What is known of the loads and of the forces above, before any balance.

    Attributes:
        name: "loaded", "passing", "entering", "surface" or "surface tilted", for example.
        words: the same in plain words.
        place: the indices that it names, which stand for the same wherever it is used.
        given: equations that hold at that place.
        everywhere: equations about any bead (r, s), each with relations of r and s.
    """

    name: str
    words: str
    place: tuple[sympy.Expr, ...] = ()
    given: tuple[sympy.Eq, ...] = ()
    everywhere: tuple[tuple[sympy.Eq, tuple[sympy.Basic, ...]], ...] = ()

    def put_in(self, image: Mapped) -> "Loading":
        """The same at another place."""
        named = set().union(*(one.free_symbols for one in self.place))
        image = {symbol: one for symbol, one in image.items() if symbol in named}
        if self.everywhere and any(one.has(sy.site_r, sy.site_s) for one in image.values()):
            raise NotExactError("the indices r and s stand for any bead of this loading")

        def at(one: sympy.Basic) -> sympy.Basic:
            return one.func(*(side.xreplace(image) for side in one.args), evaluate=False)

        return replace(
            self,
            place=tuple(one.xreplace(image) for one in self.place),
            given=tuple(map(at, self.given)),
            everywhere=tuple((at(one), tuple(map(at, when))) for one, when in self.everywhere),
        )

    def mirrored(self) -> "Loading":
        """The mirror image; one that is its own stays the same."""
        given = tuple(map(lattice.mirror, self.given))
        everywhere = tuple(
            (lattice.mirror(one), tuple(map(lattice.mirrored_relation, when)))
            for one, when in self.everywhere
        )
        if set(given) == set(self.given) and set(everywhere) == set(self.everywhere):
            return self
        end = ", mirrored"
        name = self.name.removesuffix(end) if self.name.endswith(end) else self.name + end
        before = "the mirror image of: "
        words = before + self.words if name.endswith(end) else self.words.removeprefix(before)
        place = self.place
        if len(place) == 2:  # that of a bead; a height is its own mirror image
            place = lattice.mirrored_place(*place)
        return replace(
            self, name=name, words=words, place=place, given=given, everywhere=everywhere
        )


@dataclass(frozen=True)
class Limit:
    """How indices grow together, and how a statement relates its sides then.

    Attributes:
        relation: "∼": left over right goes to 1; "O": left over right stays bounded; "≈": the
            variance of left less right is of a lower order than that of the force it is about; "∝":
            left over right goes to a function of φ, which is positive; "≈ by weight": the largest
            weight of left less right is of a lower order than that of left; "=": both sides go to
            the same.
        words: the same in plain words, such as "M → ∞ at fixed z = j/M, 0 < z < 1".
        growing: the indices that grow.
        positive: as many sums of them, which all grow in fixed positive ratios; uniformly so while
            the ratios, and φ, stay within closed parts of their ranges.
        orders: of what is related by "∼", how many leading orders are the same: left over right is
            1 up to what vanishes faster than size^(1−orders).
    """

    relation: str
    words: str
    growing: tuple[sympy.Symbol, ...]
    positive: tuple[sympy.Expr, ...]
    orders: int = 1


def inside_cone(relation: str) -> Limit:
    """The limit l → ∞ at a fixed place inside of the cone below a point load.

    The indices j, p and q grow: what l and k are stands in the domain.
    """
    words = "l → ∞ at fixed j/l and (i − k)/l, inside of the cone"
    return Limit(relation, words, (sy.j, sy.p, sy.q), (sy.j, sy.p, sy.q))


def on_leg(relation: str) -> Limit:
    """The limit l → ∞ at a fixed place on a leg of that cone."""
    return Limit(relation, "l → ∞ at fixed j/l, on a leg of the cone", (sy.j, sy.p), (sy.j, sy.p))


def along_base(relation: str) -> Limit:
    """The limit l → ∞ at the base, inside of that cone."""
    words = "l → ∞ at j = 0 and fixed (i − k)/l, inside of the cone"
    return Limit(relation, words, (sy.p, sy.q), (sy.p, sy.q))


def at_fixed_height(relation: str) -> Limit:
    """The limit M → ∞ at a fixed relative height z = j/M between base and surface."""
    words = "M → ∞ at fixed z = j/M, 0 < z < 1"
    return Limit(relation, words, (sy.M, sy.j), (sy.j, sy.M - sy.j))


def at_large_height(relation: str, orders: int = 1) -> Limit:
    """The limit M → ∞ of what belongs to no layer."""
    return Limit(relation, "M → ∞", (sy.M,), (sy.M,), orders)


def in_a_layer(relation: str) -> Limit:
    """The limit M → ∞ of a layer at a fixed distance from base or surface."""
    return Limit(relation, "M → ∞ in a fixed layer", (sy.M,), (sy.M,))


AT_FIXED_RATIO = Limit("=", "M → ∞ at fixed M/M*, as σ decreases", (sy.M,), (sy.M,))
"""The limit in which variances over squared means stay, as M* grows with M."""


@dataclass(frozen=True)
class Where:
    """The domain of a statement.

    Attributes:
        indices: whole numbers that it speaks of, every one of the domain.
        relations: between whole numbers; all of them hold.
        loading: what is known of loads and forces; None for a statement about geometry alone.
        even: sums of indices that are even, since beads are there: i + j of a bead (i, j).
        dimension: d of the packing, 2 or 3: −1/d < φ < ½.
        limit: in which the statement holds, and not at finite size; None for most.
    """

    indices: tuple[sympy.Symbol, ...] = ()
    relations: tuple[sympy.Basic, ...] = ()
    loading: Loading | None = None
    even: tuple[sympy.Expr, ...] = ()
    dimension: int = 2
    limit: Limit | None = None
    rows: frozenset[Affine] = field(init=False, repr=False)

    def __post_init__(self) -> None:
        rows = frozenset(row for one in self.relations for row in _rows_of(one))
        object.__setattr__(self, "rows", rows)

    def __hash__(self) -> int:
        return self._hash

    def __reduce__(self) -> tuple[Any, ...]:
        """Relations are taken apart for pickles: out of one SymPy would evaluate them."""
        relations = tuple((type(one), one.args) for one in self.relations)
        others = self.loading, self.even, self.dimension, self.limit
        return _put_together, (self.indices, relations, *others)

    @cached_property
    def _hash(self) -> int:
        return hash((self.indices, self.relations, self.loading, self.even, self.limit))

    @classmethod
    def of(
        cls,
        *relations: sympy.Basic,
        indices: Iterable[sympy.Symbol] = (),
        loading: Loading | None = None,
        limit: Limit | None = None,
    ) -> "Where":
        """The domain of all indices that the relations and the load speak of, and further ones.

        With one index of a bead the other is one of them.
        """
        held = {*indices}.union(*(one.free_symbols for one in relations))
        if loading:
            held |= set().union(*(one.free_symbols for one in loading.place))
        beads = [bead for bead in LATTICE if held & set(bead)]
        held = held.union(*beads)
        ordered = tuple(symbol for symbol in sy.INDICES if symbol in held)
        even = tuple(across + layer for across, layer in beads)
        return cls(ordered, relations, loading, even, limit=limit)

    def also(self, *relations: sympy.Basic, indices: Iterable[sympy.Symbol] = ()) -> "Where":
        """The part of it where further relations hold, in further indices."""
        more = tuple(one for one in relations if one not in self.relations)
        named = {*self.indices, *indices}
        held = tuple(symbol for symbol in sy.INDICES if symbol in named)
        if not more and held == self.indices:
            return self
        beads = (bead for bead in LATTICE if {*bead} <= named and not {*bead} <= {*self.indices})
        return replace(
            self,
            indices=held,
            relations=(*self.relations, *more),
            even=(*self.even, *(across + layer for across, layer in beads)),
        )

    def loaded(self, loading: Loading | None) -> "Where":
        """The same indices under another load."""
        return replace(self, loading=loading)

    def in_the_limit(self, limit: Limit | None) -> "Where":
        """The same indices in a limit, or (None) at finite size."""
        return replace(self, limit=limit)

    def within(self, index: sympy.Symbol, low: sympy.Expr, high: sympy.Expr) -> "Where":
        """The domain of the terms of a sum."""
        return self.also(sympy.Ge(index, low), sympy.Le(index, high), indices=(index,))

    def without(self, given: Iterable[sympy.Symbol]) -> "Where":
        """What it says of the other indices alone, by elimination."""
        given = [one for one in self.indices if one in {*given}]
        kept = tuple(one for one in self.relations if not one.free_symbols & {*given})
        if len(kept) == len(self.relations):
            more: list[sympy.Basic] = []
        else:
            rows = set(self.rows)
            for one in given:
                rows = _eliminated(rows, sy.INDICES.index(one))
            more = [sympy.Ge(affine.to_sympy(row), 0, evaluate=False) for row in sorted(rows)]
        indices = tuple(one for one in self.indices if one not in given)
        even = tuple(one for one in self.even if not one.free_symbols & {*given})
        domain = replace(self, indices=indices, relations=kept, even=even)
        further = [one for one in more if not domain.implies(one)]
        return domain.also(*further)

    def put_in(self, image: Mapped, indices: Iterable[sympy.Symbol]) -> "Where":
        """The domain of other indices, in terms of which these are given."""
        relations = tuple(
            one.func(*(side.xreplace(image) for side in one.args), evaluate=False)
            for one in self.relations
        )
        return replace(
            self,
            indices=tuple(indices),
            relations=relations,
            loading=self.loading and self.loading.put_in(image),
            even=tuple(sympy.expand(one.xreplace(image)) for one in self.even),
        )

    def mirrored(self) -> "Where":
        """The domain of the mirror image of a statement."""
        relations = tuple(map(lattice.mirrored_relation, self.relations))
        loading = self.loading and self.loading.mirrored()
        return replace(self, relations=relations, loading=loading)

    # what follows

    def nonnegative(self, value: Affine) -> bool:
        """Whether an affine expression is ≥ 0 on all of the domain."""
        if not any(value[:-1]):
            return value[-1] >= 0 or self.is_empty
        if value not in self._decided:
            below = affine.shifted(affine.times(value, -1), -1)
            self._decided[value] = _infeasible(self.rows | {below})
        return self._decided[value]

    @cached_property
    def _decided(self) -> dict[Affine, bool]:
        """What is known of affine expressions."""
        return {}

    def below(self, left: Affine, right: Affine) -> bool:
        """Whether left < right on all of the domain."""
        return self.nonnegative(affine.shifted(affine.add(right, left, -1), -1))

    def differ(self, left: Affine, right: Affine) -> bool:
        """Whether left ≠ right on all of the domain: one is larger, or one is odd, one even."""
        apart = affine.add(left, right, -1)
        if not any(apart[:-1]):
            return apart[-1] != 0 or self.is_empty
        return (
            self.below(left, right)
            or self.below(right, left)
            or self.is_even(affine.shifted(apart, 1))
        )

    def implies(self, relation: sympy.Basic) -> bool:
        """Whether a relation between whole numbers holds on all of the domain."""
        if relation in self.relations or relation == sympy.true:
            return True
        return all(map(self.nonnegative, _rows_of(relation)))

    @cached_property
    def is_empty(self) -> bool:
        """Whether no point is in it."""
        return _infeasible(self.rows)

    def covered_by(self, parts: Iterable["Where"]) -> bool:
        """Whether no integer point of it is left out by all of the parts."""
        left = {self.rows}
        for part in parts:
            beyond = {
                rows | {affine.shifted(affine.times(row, -1), -1)}
                for rows in left
                for row in part.rows
                if row not in rows
            }
            if len(beyond) > _MANY:
                return False
            left = {rows for rows in beyond if not _infeasible(rows)}
        return not left

    def never_zero(self, expression: sympy.Expr) -> bool:
        """Whether an expression without lattice quantities is shown to vanish nowhere.

        Disorder is as weak as one likes: what differs from zero at ε = 0 does.
        """
        if expression.has(sy.SiteFunction):
            return False
        if expression.has(sy.epsilon):
            expression = sympy.expand(expression.xreplace({sy.epsilon: sympy.S.Zero}))
        return self.sign(expression) != 0

    def sign(self, expression: sympy.Expr) -> int:
        """1 or −1 where the expression is shown to be that side of zero everywhere, or else 0."""
        if isinstance(expression, sympy.Mul):
            found = 1
            for factor in expression.args:
                found *= self.sign(factor)
            return found
        if isinstance(expression, sympy.Pow) and expression.exp.is_Integer:
            base = self.sign(expression.base)
            return base ** (int(expression.exp) % 2) if base else 0
        held = expression.free_symbols & set(sy.INDICES)
        if not held:
            return sign(expression, dimension=self.dimension)
        try:
            value = affine.from_sympy(expression)
        except NotExactError:
            return self._sign_of_factors(expression)
        if self.nonnegative(affine.shifted(value, -1)):
            return 1
        return -1 if self.nonnegative(affine.shifted(affine.times(value, -1), -1)) else 0

    def _sign_of_factors(self, expression: sympy.Expr) -> int:
        domain = Domain(by_name(expression.free_symbols))
        try:
            value = domain.from_sympy(expression)
        except NotExactError:
            return 0
        if value.numerator == 0:
            return 0
        found = 1
        for polynomial in (value.numerator, value.denominator):
            number, powers = value.factors(polynomial)
            found *= 1 if number > 0 else -1
            for factor, power in powers.items():
                one = 0 if factor == expression else self.sign(factor)
                one = one or sign(factor, *self._positive)
                found *= one ** (power % 2) if one else 0
        return found

    @cached_property
    def _positive(self) -> tuple[tuple[sympy.Symbol, ...], tuple[sympy.Symbol, ...]]:
        """The indices that are positive, and those that are not negative."""
        found = [
            tuple(s for s in self.indices if self.nonnegative(affine.from_sympy(s - least)))
            for least in (1, 0)
        ]
        return found[0], found[1]

    def is_even(self, value: Affine) -> bool:
        """Whether an affine expression is even at every point with beads at their places."""
        return not any(_reduced(value, self._even_ones))

    @cached_property
    def _even_ones(self) -> list[Affine]:
        """What is even on the domain, modulo 2, none of it a sum of others."""
        equations = [one.lhs - one.rhs for one in self.relations if isinstance(one, sympy.Eq)]
        known: list[Affine] = []
        for one in map(affine.from_sympy, map(sympy.expand, (*self.even, *equations))):
            if any(rest := _reduced(one, known)):
                known.append(rest)
        return known

    def on_lattice(self, across: sympy.Expr, layer: sympy.Expr) -> bool:
        """Whether (across, layer) is a bead: the sum is even, and the layer not below the base."""
        height = affine.from_sympy(layer)
        return self.is_even(affine.add(affine.from_sympy(across), height)) and self.nonnegative(
            height
        )

    # how it is shown, and its points

    @cached_property
    def solved(self) -> dict[sympy.Symbol, sympy.Expr]:
        """Indices that equations between them fix, in terms of the others.

        An equation that begins with an index says what that one is.
        """
        image: dict[sympy.Symbol, sympy.Expr] = {}
        for one in self.relations:
            if isinstance(one, sympy.Eq):
                value = _tightened(
                    affine.from_sympy(sympy.expand((one.lhs - one.rhs).xreplace(image)))
                )
                first = [s for s in (sy.N, one.lhs) if s in self.indices]
                for symbol in (*first, *self.indices):
                    c = affine.coefficient(value, symbol)
                    if abs(c) == 1:
                        rest = affine.to_sympy(affine.times(affine.without(value, symbol), -c))
                        image = {
                            s: sympy.expand(e.xreplace({symbol: rest})) for s, e in image.items()
                        }
                        image[symbol] = rest
                        break
        return image

    def holds(self, at: Mapping[sympy.Symbol, int]) -> bool:
        """Whether a point is in it."""
        numbers = [at.get(symbol, 0) for symbol in sy.INDICES]
        return all(
            sum(c * n for c, n in zip(row, numbers, strict=False)) + row[-1] >= 0
            for row in self.rows
        )

    def in_words(self) -> tuple[str, ...]:
        """Its relations in plain text, such as "0 ≤ j < M", and its load."""
        shown = [
            " ".join(_SIGNS[one] if isinstance(one, type) else text(one) for one in chain)
            for chain in self._chains()
        ]
        further = [one.words for one in (self.loading, self.limit) if one]
        return (*shown, *further)

    def _chains(self) -> Iterator[list[sympy.Basic | type]]:
        """Relations that go on where the one before ends, as sides and kinds in turn."""
        chain: list[sympy.Basic | type] = []
        for one, following in zip(self.relations, (*self.relations[1:], None), strict=False):
            left, right, kind = one.lhs, one.rhs, one.func
            goes_on = following is not None and following.lhs == left
            if goes_on and kind in _TURNED and following.func not in _TURNED:
                left, right, kind = right, left, _TURNED[kind]
            if chain and chain[-1] == left and kind not in _TURNED:
                chain += [kind, right]
                continue
            if chain:
                yield chain
            chain = [left, kind, right]
        if chain:
            yield chain

    def __str__(self) -> str:
        return ", ".join(self.in_words())


def _put_together(
    indices: tuple[sympy.Symbol, ...], relations: Iterable[tuple[Any, Any]], *others: Any
) -> Where:
    """A domain from a pickle."""
    return Where(indices, tuple(kind(*args, evaluate=False) for kind, args in relations), *others)


@lru_cache(maxsize=4096)
def _rows_of(relation: sympy.Basic) -> tuple[Affine, ...]:
    """What is ≥ 0 where a relation between whole numbers holds."""
    if not isinstance(relation, sympy.Eq | sympy.Le | sympy.Lt | sympy.Ge | sympy.Gt):
        raise NotExactError(f"{relation} is no relation between whole numbers")
    left, right = (affine.from_sympy(sympy.expand(side)) for side in relation.args)
    apart = affine.add(left, right, -1)
    if isinstance(relation, sympy.Eq):
        return apart, affine.times(apart, -1)
    if isinstance(relation, sympy.Le | sympy.Lt):
        apart = affine.times(apart, -1)
    return (affine.shifted(apart, -1) if isinstance(relation, sympy.Lt | sympy.Gt) else apart,)


@lru_cache(maxsize=20_000)
def _infeasible(rows: frozenset[Affine]) -> bool:
    """Whether no rational point has all rows ≥ 0 (their constants rounded down to whole ones)."""
    left = {_tightened(row) for row in rows}
    while True:
        if any(not any(row[:-1]) and row[-1] < 0 for row in left):
            return True
        left = {row for row in left if any(row[:-1])}
        if not left or len(left) > _MANY:
            return False
        place = min(
            (place for place in range(len(sy.INDICES)) if any(row[place] for row in left)),
            key=lambda p: sum(row[p] > 0 for row in left) * sum(row[p] < 0 for row in left),
        )
        left = _eliminated(left, place)


def _eliminated(rows: Iterable[Affine], place: int) -> set[Affine]:
    """What follows of the other indices."""
    rows = list(rows)
    above = [row for row in rows if row[place] > 0]
    below = [row for row in rows if row[place] < 0]
    left = {row for row in rows if not row[place]}
    for a, b in product(above, below):
        left.add(_tightened(affine.add(affine.times(a, -b[place]), b, a[place])))
    return left


def _reduced(value: Affine, known: Iterable[Affine]) -> Affine:
    """A value modulo 2, without what is known to be even."""
    rest = tuple(c % 2 for c in value)
    for row in known:
        if rest[row.index(1)]:
            rest = tuple((a + b) % 2 for a, b in zip(rest, row, strict=True))
    return rest


def _tightened(row: Affine) -> Affine:
    divisor = gcd(*row[:-1])
    if divisor < 2:
        return row
    return (*(c // divisor for c in row[:-1]), row[-1] // divisor)


_PLUS, _MINUS = sy.ForcePlus, sy.ForceMinus


def _zero(quantity: sympy.Expr) -> sympy.Eq:
    return sympy.Eq(quantity, 0, evaluate=False)


_BEAD = (sy.site_r, sy.site_s)
_DOWN = sympy.Eq(sy.Load(sy.k, sy.l), -sy.f_load * sy.e_y, evaluate=False)
_NOTHING_ABOVE = (_zero(_PLUS(sy.k, sy.l)), _zero(_MINUS(sy.k, sy.l)))

LOADED = Loading("loaded", "bead (k, l) carries nothing but its load", (sy.k, sy.l), _NOTHING_ABOVE)
"""A loaded bead that no contact presses from above."""

LOADED_VERTICALLY = Loading(
    "loaded vertically",
    "bead (k, l) carries nothing but its load, which points straight down",
    (sy.k, sy.l),
    (*_NOTHING_ABOVE, _DOWN),
)
"""The same, its load being of magnitude f_load and vertical."""

PASSING = Loading(
    "passing",
    "bead (r, s) carries no load of its own, and f⁺_rs alone enters it",
    _BEAD,
    (_zero(sy.Load(*_BEAD)), _zero(_MINUS(*_BEAD))),
)
"""A bead that one contact force passes."""

ENTERING = Loading(
    "entering",
    "f⁺ enters through the contact from (k−1, l−1) to (k, l), and nothing else does",
    (sy.k, sy.l),
    (),
    (
        (_zero(sy.Load(*_BEAD)), (sy.site_s <= sy.l - 1,)),
        (_zero(_MINUS(*_BEAD)), (sympy.Eq(sy.site_s, sy.l - 1),)),
        (_zero(_PLUS(*_BEAD)), (sympy.Eq(sy.site_s, sy.l - 1), sy.site_r <= sy.k - 2)),
        (_zero(_PLUS(*_BEAD)), (sympy.Eq(sy.site_s, sy.l - 1), sy.site_r >= sy.k)),
    ),
)
"""What one contact force contributes below itself."""

_AT_SURFACE = sympy.Eq(sy.site_s, sy.M)
_FREE_SURFACE = ((_zero(_PLUS(*_BEAD)), (_AT_SURFACE,)), (_zero(_MINUS(*_BEAD)), (_AT_SURFACE,)))


def _carries(load: sympy.Expr, *where: sympy.Basic) -> tuple[sympy.Eq, tuple[sympy.Basic, ...]]:
    return sympy.Eq(sy.Load(*_BEAD), load, evaluate=False), where


def _on_surface(name: str, words: str, load: sympy.Expr) -> Loading:
    """A load on each bead of the surface j = M."""
    none_below = (_zero(sy.Load(*_BEAD)), (sy.site_s <= sy.M - 1,))
    everywhere = (none_below, _carries(load, _AT_SURFACE), *_FREE_SURFACE)
    return Loading(name, words, (sy.M,), (), everywhere)


def _on_every_bead(name: str, words: str, load: sympy.Expr) -> Loading:
    """A load on each bead of a packing of height M; the base bears its own."""
    loaded = _carries(load, sy.site_s >= 1, sy.site_s <= sy.M)
    return Loading(name, words, (sy.M,), (), (loaded, *_FREE_SURFACE))


_TILTED = -sy.L_plus * (sy.n_plus + sy.t * sy.n_minus)

SURFACE = _on_surface(
    "surface",
    "each bead of the surface j = M carries f_load straight down, no other a load",
    -sy.f_load * sy.e_y,
)
"""A load on the surface of a packing of height M."""

BULK = _on_every_bead(
    "bulk",
    "each bead above the base carries its weight mg straight down, and nothing lies above j = M",
    -sy.m_g * sy.e_y,
)
"""A weight on every bead of a packing of height M."""

SURFACE_TILTED = _on_surface(
    "surface tilted",
    "each bead of the surface j = M carries −(L⁺n⁺ + L⁻n⁻), L⁻ = tL⁺, no other a load",
    _TILTED,
)
"""A load in any direction on the surface of a packing of height M."""

BULK_TILTED = _on_every_bead(
    "bulk tilted",
    "each bead above the base carries −(L⁺n⁺ + L⁻n⁻), L⁻ = tL⁺, and nothing lies above j = M",
    _TILTED,
)
"""A load in any direction on every bead of a packing of height M."""

_LEFT_OF_IT = (sympy.Eq(sy.site_s, sy.l), sy.site_r <= sy.k - 2)

POINT = Loading(
    "point",
    "bead (k, l) carries f_load straight down, no other bead in its layer or below it a load, and "
    "no force comes from above",
    (sy.k, sy.l),
    (_DOWN,),
    (
        (_zero(sy.Load(*_BEAD)), (sy.site_s <= sy.l - 1,)),
        (_zero(sy.Load(*_BEAD)), _LEFT_OF_IT),
        (_zero(sy.Load(*_BEAD)), tuple(map(lattice.mirrored_relation, _LEFT_OF_IT))),
        (_zero(_PLUS(*_BEAD)), (sympy.Eq(sy.site_s, sy.l),)),
        (_zero(_MINUS(*_BEAD)), (sympy.Eq(sy.site_s, sy.l),)),
    ),
)
"""A load on one bead, and nothing else."""
