"""Where a statement holds: whole indices and relations between them, a load, and a limit."""

from collections.abc import Iterable
from dataclasses import dataclass, replace
from functools import cached_property

import sympy

from .. import sets
from .. import symbols as sy
from ..algebra.exact import NotExactError
from ..forms import Image, Reader, Straightening
from ..mechanics import lattice

Site = tuple[sympy.Expr, sympy.Expr]
"""Across and up."""

LATTICE: tuple[Site, ...] = ((sy.i, sy.j), (sy.k, sy.l), (sy.site_r, sy.site_s))
"""Indices of beads."""


@dataclass(frozen=True)
class Loading:
    """What is known of the loads and of the forces above, before any balance.

    Attributes:
        name: "loaded", "passing", "entering", "surface" or "leaning surface", for example.
        words: the same in plain words.
        place: the indices that it names, which stand for the same wherever it is used.
        given: equations that hold at that place.
        everywhere: equations about any bead (r, s), each with relations of r and s.
        acting: contact forces that are not zero.
    """

    name: str
    words: str
    place: tuple[sympy.Expr, ...] = ()
    given: tuple[sympy.Eq, ...] = ()
    everywhere: tuple[tuple[sympy.Eq, tuple[sympy.Basic, ...]], ...] = ()
    acting: tuple[sympy.Expr, ...] = ()

    @property
    def fixed(self) -> set[sympy.Symbol]:
        """The symbols of its place."""
        return set().union(*(coordinate.free_symbols for coordinate in self.place))

    def implies(self, other: "Loading | None") -> bool:
        """Whether all that is known by another one is known by this, at the same place.

        Of what another one says nothing in equations, as in three dimensions, nothing is implied.
        """
        if other is None or self == other:
            return True
        return bool(
            (other.given or other.everywhere)
            and other.fixed <= self.fixed
            and {*other.given} <= {*self.given}
            and {*other.everywhere} <= {*self.everywhere}
            and {*other.acting} <= {*self.acting}
        )

    def is_like(self, other: "Loading") -> bool:
        """Whether it is another one at another place."""
        image = dict(zip(other.place, self.place, strict=False))
        return len(self.place) == len(other.place) and other.put_in(image) == self

    def put_in(self, image: Image) -> "Loading":
        """The same at another place.

        Raises:
            NotExactError: the place would hold r or s, which stand for any bead.
        """
        image = {symbol: value for symbol, value in image.items() if symbol in self.fixed}
        if self.everywhere and any(value.has(sy.site_r, sy.site_s) for value in image.values()):
            raise NotExactError("the indices r and s stand for any bead of this loading")
        return replace(
            self,
            place=tuple(coordinate.xreplace(image) for coordinate in self.place),
            given=tuple(_at(item, image) for item in self.given),
            everywhere=tuple(
                (_at(law, image), tuple(_at(relation, image) for relation in when))
                for law, when in self.everywhere
            ),
            acting=tuple(force.xreplace(image) for force in self.acting),
        )

    def mirrored(self) -> "Loading":
        """The mirror image; one that is its own stays the same."""
        given = tuple(map(lattice.mirror, self.given))
        everywhere = tuple(
            (lattice.mirror(law), tuple(map(lattice.mirrored_relation, when)))
            for law, when in self.everywhere
        )
        acting = tuple(map(lattice.mirror, self.acting))
        same = set(given) == set(self.given) and set(everywhere) == set(self.everywhere)
        if same and acting == self.acting:
            return self
        end, before = ", mirrored", "the mirror image of: "
        back = self.name.endswith(end)
        name = self.name.removesuffix(end) if back else self.name + end
        words = self.words.removeprefix(before) if back else before + self.words
        place = self.place
        if len(place) == 2:  # that of a bead; a height is its own mirror image
            place = lattice.mirrored_place(*place)
        return Loading(name, words, place, given, everywhere, acting)


@dataclass(frozen=True)
class Limit:
    """How indices grow together, and how a statement relates its sides then.

    Attributes:
        relation: "∼": left over right goes to 1; "O": left over right stays bounded; "≈": the
            variance of left less right is of a lower order than that of left, a force; "∝": left
            over right goes to a positive function of φ; "=": both sides go to the same.
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

    def __post_init__(self) -> None:
        if self.orders < 1:
            raise ValueError("a limit compares at least one order")
        image = {s: 2 * s - unit for s, unit in zip(self.growing, self.positive, strict=True)}
        if any(unit.xreplace(image) != s for s, unit in zip(image, self.positive, strict=True)):
            raise ValueError("each sum is what grows, less others that are such sums themselves")


def at_fixed_height(relation: str) -> Limit:
    """The limit M → ∞ at a fixed relative height z = j/M between base and surface."""
    words = "M → ∞ at fixed z = j/M, 0 < z < 1"
    return Limit(relation, words, (sy.M, sy.j), (sy.M - sy.j, sy.j))


def at_large_height(relation: str, orders: int = 1) -> Limit:
    """The limit M → ∞ of what belongs to no layer."""
    return Limit(relation, "M → ∞", (sy.M,), (sy.M,), orders)


def in_a_layer(relation: str) -> Limit:
    """The limit M → ∞ of a layer at a fixed distance from base or surface."""
    return Limit(relation, "M → ∞ in a fixed layer", (sy.M,), (sy.M,))


AT_FIXED_RATIO = Limit("=", "M → ∞ at fixed M/M*, as σ decreases", (sy.M,), (sy.M,))
"""The limit in which variances over squared means stay, as M* grows with M."""


@dataclass(frozen=True)
class Domain:
    """The domain of a statement; :meth:`of` makes it.

    Attributes:
        indices: whole numbers that it speaks of, every one of the domain.
        relations: between whole numbers; all of them hold.
        loading: what is known of loads and forces; None for a statement about geometry alone.
        beads: places at which beads are: across plus up is even there.
        dimension: d of the packing, 2 or 3: −1/d < φ < ½.
        limit: in which the statement holds, and not at finite size; None for most.
    """

    indices: tuple[sympy.Symbol, ...] = ()
    relations: tuple[sympy.Basic, ...] = ()
    loading: Loading | None = None
    beads: tuple[Site, ...] = ()
    dimension: int = 2
    limit: Limit | None = None

    def __post_init__(self) -> None:
        if self.dimension not in (2, 3):
            raise ValueError(f"dimension {self.dimension}: 2 and 3 are allowed")
        symbols = set().union(*(relation.free_symbols for relation in self.relations))
        symbols = symbols.union(*(x.free_symbols for bead in self.beads for x in bead))
        if not symbols <= {*self.indices} or not {*self.indices} <= {*sy.INDICES}:
            raise ValueError("a domain is one of the paper's indices, all of which it names")

    @classmethod
    def of(
        cls,
        *relations: sympy.Basic,
        indices: Iterable[sympy.Symbol] = (),
        loading: Loading | None = None,
        beads: Iterable[Site] | None = None,
        dimension: int = 2,
        limit: Limit | None = None,
    ) -> "Domain":
        """The domain of all indices that the relations, the load and the beads speak of.

        Beads are by default at (i, j), (k, l) and (r, s): with one of two indices the other is one
        of the domain, and their sum is even.

        Raises:
            ValueError: the dimension is neither 2 nor 3.
        """
        symbols = {*indices}.union(*(relation.free_symbols for relation in relations))
        symbols |= loading.fixed if loading else set()
        by_default = (bead for bead in LATTICE if symbols & {*bead})
        places = tuple(by_default if beads is None else beads)
        symbols = symbols.union(*(x.free_symbols for place in places for x in place))
        ordered = tuple(symbol for symbol in sy.INDICES if symbol in symbols)
        conditions = tuple(each for each in dict.fromkeys(relations) if each != sympy.true)
        return cls(ordered, conditions, loading, tuple(dict.fromkeys(places)), dimension, limit)

    @property
    def relation(self) -> str:
        """How a statement on it relates its sides: "=", or as in its limit."""
        return self.limit.relation if self.limit else "="

    def also(self, *relations: sympy.Basic, indices: Iterable[sympy.Symbol] = ()) -> "Domain":
        """The part of it where further relations hold, in further indices."""
        new = {*indices}.union(*(relation.free_symbols for relation in relations)) - {*self.indices}
        return Domain.of(
            *self.relations,
            *relations,
            indices=(*self.indices, *new),
            loading=self.loading,
            beads=(*self.beads, *(bead for bead in LATTICE if new & {*bead})),
            dimension=self.dimension,
            limit=self.limit,
        )

    def loaded(self, loading: Loading | None) -> "Domain":
        """The same indices under another load."""
        return replace(self, loading=loading)

    def in_the_limit(self, limit: Limit | None) -> "Domain":
        """The same indices in a limit, or (None) at finite size."""
        return replace(self, limit=limit)

    def put_in(self, image: Image) -> "Domain":
        """The domain of other indices, in terms of which these are given."""
        symbols = {*self.indices} - {*image}
        symbols |= set().union(*(image[s].free_symbols for s in self.indices if s in image))
        positive = (image[s] for s in self.indices if s in image and s.is_positive)
        return Domain(
            tuple(symbol for symbol in sy.INDICES if symbol in symbols),
            (
                *(_at(relation, image) for relation in self.relations),
                *(
                    sympy.Ge(expression, 1, evaluate=False)
                    for expression in positive
                    if not expression.is_positive
                ),
            ),
            self.loading and self.loading.put_in(image),
            tuple((a.xreplace(image), b.xreplace(image)) for a, b in self.beads),
            self.dimension,
            self.limit,
        )

    def mirrored(self) -> "Domain":
        """The domain of the mirror image of a statement."""
        return replace(
            self,
            relations=tuple(map(lattice.mirrored_relation, self.relations)),
            beads=tuple(lattice.mirrored_place(*place) for place in self.beads),
            loading=self.loading and self.loading.mirrored(),
        )

    # as a set

    @cached_property
    def straight(self) -> Straightening:
        """The indices in which no sum of them has to be even."""
        return Straightening.of(across + up for across, up in self.beads)

    @cached_property
    def points(self) -> sets.Set:
        """Its points, in straightened indices."""
        positive = (index for index in self.indices if index.is_positive)
        least = (sympy.Ge(symbol, 1, evaluate=False) for symbol in positive)
        return sets.where(*map(self.straight.relation, self.relations), *least)

    def reader(self) -> Reader:
        """Reads expressions on it."""
        if self.loading is None:
            return Reader(self.points, self.straight)
        fixed, acting = frozenset(self.loading.fixed), self.loading.acting
        return Reader(self.points, self.straight, fixed=fixed, acting=acting)

    def implies(self, *relations: sympy.Basic) -> bool:
        """Whether relations between whole numbers hold on all of it."""
        return bool(self.points.is_subset(sets.where(*map(self.straight.relation, relations))))

    def lies_in(self, other: "Domain") -> bool:
        """Whether each of its points is one of another domain, with beads at the same places."""
        even = [sympy.expand((a + b).xreplace(self.straight.image)) for a, b in other.beads]
        return self.implies(*other.relations) and all(
            self.points.is_subset(sets.even(form)) for form in even
        )

    def shares_packings_of(self, other: "Domain") -> bool:
        """Whether all that is known of another domain's packings is known of its own.

        The loads are at the same place, and what grows is the same.
        """
        known = other.loading is None or (self.loading and self.loading.implies(other.loading))
        return bool(known) and (self.dimension, self.limit) == (other.dimension, other.limit)

    # in words

    def in_words(self) -> tuple[str, ...]:
        """Its relations in plain text, such as "0 ≤ j < M", and its load."""
        from ..words import chains

        further = [part.words for part in (self.loading, self.limit) if part]
        return (*chains(self.relations), *further)

    def __str__(self) -> str:
        return ", ".join(self.in_words())


def _at(relation: sympy.Basic, image: Image) -> sympy.Basic:
    """A relation with other indices."""
    if not isinstance(relation, sympy.core.relational.Relational):
        return relation
    return relation.func(*(side.xreplace(dict(image)) for side in relation.args), evaluate=False)
