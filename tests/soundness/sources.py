"""A printed equation as other statements are made from it: its parts, and changes of its sides."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import NamedTuple

import sympy
from force_diffusion.symbolic import symbols as sy
from force_diffusion.symbolic.kernel.where import Where
from force_diffusion.symbolic.notation import by_name
from force_diffusion.symbolic.printing.text import text
from sympy import Add, Eq, Mul, Pow, Rational, Sum

Change = Callable[[sympy.Expr], sympy.Expr]
Made = Iterator[tuple[str, sympy.Eq]]
"""Why it is false, or true, and the statement."""
Zeros = Iterator[tuple[str, sympy.Expr]]
"""A place of the domain, in words, and what vanishes there."""

COSINES = tuple(Rational(*c) for c in ((1, 4), (-1, 4), (0, 1), (1, 3), (-49, 100), (49, 100)))
_HIGHEST = 10  # of layers and heights that are looked at
HEIGHTS = tuple(Rational(*z) for z in ((1, 2), (1, 3), (3, 4), (1, 100)))


class Form(NamedTuple):
    """An exact form of what is printed, and whether it is for one layer alone."""

    name: str
    expression: sympy.Expr
    of_one_layer: bool


@dataclass(frozen=True)
class Source:
    """A printed equation and its sign: "=", "≈", "∼" or "∝".

    Attributes:
        printed: the equation.
        relation: its sign.
        exact: forms at finite size of the same quantity.
        where: the domain, where the kernel proves it.
        dimension: of the packing.
    """

    printed: sympy.Eq
    relation: str
    exact: tuple[Form, ...] = ()
    where: Where | None = None
    dimension: int = 2

    @property
    def cosines(self) -> list[Rational]:
        """Values of φ, which is above −1/d."""
        return [one for one in COSINES if one * self.dimension > -1]

    @property
    def free(self) -> set[sympy.Symbol]:
        """The symbols that are not summed over."""
        return set(self.printed.free_symbols)

    @property
    def is_vector(self) -> bool:
        """Whether it equates vectors."""
        factors = Mul.make_args(self.printed.lhs)
        found = any(getattr(one, "is_vector", False) for one in factors)
        return found or self.printed.rhs == 0

    @property
    def size(self) -> sympy.Symbol:
        """What grows in the limit."""
        return sy.M if sy.M in self.free else sy.l

    def right(self, change: Change) -> sympy.Eq:
        """The right-hand side changed, or, where that is zero, one term of the left one."""
        left, right = self.printed.args
        if right:
            return equal(left, change(right))
        first, *others = left.args
        return equal(Add(change(first), *others, evaluate=False), right)

    def both(self, change: Change) -> sympy.Eq:
        """The same change of both sides."""
        return equal(*map(change, self.printed.args))

    def left(self, change: Change) -> sympy.Eq:
        """The left-hand side changed."""
        return equal(change(self.printed.lhs), self.printed.rhs)

    def term(self, factor: sympy.Expr) -> sympy.Expr:
        """A term that may stand beside the right-hand side: a factor times a unit of its kind."""
        return factor * sy.b_plus if self.is_vector else factor

    def sums(self) -> list[sympy.Sum]:
        """The sums in it."""
        return by_name(self.printed.atoms(Sum))

    def with_sum(self, series: sympy.Sum, other: sympy.Expr) -> sympy.Eq:
        """One sum replaced."""
        return equal(*(side.xreplace({series: other}) for side in self.printed.args))

    def radii(self) -> list[sympy.Expr]:
        """The radius of the bead that it is about, and two on the base; none for statistics."""
        found = by_name(self.printed.atoms(sy.SiteFunction))
        beads = [one for one in found if one.free_symbols <= self.free]  # none within a sum
        if not beads:
            return []
        across, layer = beads[0].args
        sites = ((across - layer, 0), (across + layer, 0), (across, layer))
        return [sy.DeltaR(*site) for site in sites]

    def zeros(self) -> Zeros:
        """Yield places of the domain, in words, with what vanishes there."""
        for c in self.cosines:
            yield f"φ = {c}", sy.phi - c
        yield "φ = 0", sy.n_x - sy.n_y
        yield "φ = 5/13", 3 * sy.n_x - 2 * sy.n_y
        yield "φ = 1/4", 8 * sy.n_x**2 - 3
        yield "φ = ±1/4", 1 - 16 * sy.phi**2
        if self.relation == "=":
            for layer in (sy.j, sy.l, sy.site_s):
                if layer in self.free:
                    at = self.within(layer, 3)
                    yield f"{text(layer)} = {at}", layer - at
            if sy.M in self.free:
                at, above = self.within(sy.M, 4), self.within(sy.M - sy.j, 2)
                yield f"M = {at}", sy.M - at
                yield f"M = j + {above}", sy.M - sy.j - above
        yield from self.heights()

    def within(self, index: sympy.Expr, least: int) -> int:
        """The first whole number from ``least`` on that an index has in the domain."""
        if self.where is None or not index.free_symbols <= {*self.where.indices}:
            return least
        found = (at for at in range(least, _HIGHEST) if not self._misses(index, at))
        return next(found, least)

    def _misses(self, index: sympy.Expr, at: int) -> bool:
        assert self.where is not None
        return self.where.also(Eq(index, at, evaluate=False)).is_empty

    def heights(self) -> Zeros:
        """Yield relative heights, with what vanishes there."""
        height = sy.z if sy.z in self.free else sy.j / self.size
        if self.relation in "≈∼":
            for at in HEIGHTS:
                yield f"{text(height)} = {at}", height - at
        elif {sy.j, sy.M} <= self.free:
            yield "j = M/2", 2 * sy.j - sy.M


def equal(left: sympy.Expr, right: sympy.Expr) -> sympy.Eq:
    """An equation as it stands."""
    return Eq(left, right, evaluate=False)


def times(*factors: sympy.Expr) -> Change:
    """Multiply a side."""
    return lambda side: Mul(*factors, side, evaluate=False)


def plus(term: sympy.Expr) -> Change:
    """Add a term to a side."""
    return lambda side: Add(side, term, evaluate=False)


def put_in(image: dict[sympy.Expr, sympy.Expr]) -> Change:
    """Put something in place of what stands in a side."""
    return lambda side: side.xreplace(image)


def over(divisor: sympy.Expr, power: int = 1) -> sympy.Expr:
    """1 over a power, as it stands."""
    return Pow(divisor, -power, evaluate=False)
