"""Every exact form against exact packings, at as many points as its degree asks for.

Where it has one formula a form is, times its divisors, a polynomial of some degree in its indices,
and so is what it stands for. Two such polynomials are the same if they are at points at
which no polynomial of that degree but 0 vanishes. The base vectors are fractions of so many digits
that two functions of φ with shorter factors are the same if they are there.
"""

from collections.abc import Callable, Iterable, Iterator, Sequence
from fractions import Fraction
from functools import cache, cached_property
from itertools import chain, product
from typing import Any

import numpy as np
import pytest
import sympy
from flint import fmpq
from force_diffusion.derivations.framework import catalogue
from force_diffusion.symbolic import symbols as sy
from force_diffusion.symbolic import words
from force_diffusion.symbolic.piecewise import Piece

import force_diffusion as fd
from tests.derivations.rows import late
from tests.soundness.witnesses.moments import Packing, Spheres, exact

TALL, TALL_PARTS = ("B22", "both"), 15
"""The form whose packings take minutes: CI compares one of its formulas."""
HIGHEST = 29
"""Of packings that are looked at."""
FARTHER = 3
"""Heights at which no point is to be new before there is held to be none."""

Point = dict[sympy.Symbol, int]
Grid = np.ndarray[Any, np.dtype[np.int64]]
"""Points, one a row; columns are symbols."""


def direction(u: int, v: int) -> tuple[Fraction, Fraction]:
    """A rational unit vector."""
    square = u * u + v * v
    return Fraction(2 * u * v, square), Fraction(u * u - v * v, square)


N_XY = direction(2_199_023_255_579, 1_072_694_270_807)
PHI = N_XY[1] ** 2 - N_XY[0] ** 2
RATIOS = Fraction(1_000_003, 999_983), Fraction(1_299_709, 1_000_033)
"""For t, or for t_2 and t_3."""
NUMBERS = {
    sy.phi: PHI, sy.r: 1, sy.sigma: 1, sy.t: RATIOS[0], sy.t_2: RATIOS[0], sy.t_3: RATIOS[1],
    sy.n_y: N_XY[1], sy.L_plus: 1, sy.f_load: 2 * N_XY[1], sy.m_g: 2 * N_XY[1],
}  # fmt: skip


@pytest.mark.parametrize("number", late(list(catalogue.modules())[12:], share=6, sample=2))
def test_exact_forms(number):
    equation = fd.equation(number)
    for name in equation.forms:
        if (number, name) == TALL:
            continue
        form = equation.exact(name)
        certify(name, form, form.pieces)


@pytest.mark.long(share=TALL_PARTS)
@pytest.mark.parametrize("part", range(TALL_PARTS))
def test_the_form_that_needs_the_tallest_packings(part):
    form = fd.equation(TALL[0]).exact(TALL[1])
    certify(TALL[1], form, form.pieces[part::TALL_PARTS])


def certify(name: str, form: fd.ClosedForm, formulas: Sequence[Piece]) -> int:
    """Compare formulas of a form with exact packings, and count the points."""
    places, count = Places(form), 0
    true = truth(name, form)
    for formula in formulas:
        for at in places.telling_apart(formula.where):
            value = form.value({s: sympy.Rational(n) for s, n in {**NUMBERS, **at}.items()})
            assert exact(value) == true(at), f"{name} at {at}"
            count += 1
    return count


def truth(name: str, form: fd.ClosedForm) -> Callable[[Point], fmpq]:
    """What a form stands for, in an exact packing."""
    loading = form.kernel_domain.loading.name if form.kernel_domain.loading else "surface"
    load = next(kind for kind in ("surface", "bulk", "point") if loading.startswith(kind))
    order = 2 if form.statistic.has(sy.Shift) else 1

    def packing(at: Point) -> Packing | Spheres:
        numbers: dict[sympy.Symbol, Any] = {sy.i: at.get(sy.j, 0) % 2, **at}
        height = at[sy.l] if load == "point" else at.get(sy.M, at.get(sy.j, 0) + 1)
        if form.kernel_domain.dimension == 3:
            ratios = RATIOS if "leaning" in loading else (Fraction(1), Fraction(1))
            return Spheres(height, PHI, load, ratios, numbers)
        ratio = Fraction(1) if loading in ("surface", "bulk", "point") else RATIOS[0]
        return Packing(height, N_XY, load, ratio, numbers, order)

    if form.statistic.has(sympy.Sum):  # Eq. 15: an average over the layers
        layers = {"surface": fd.equation(13), "bulk": fd.equation(14)}[name].exact()
        of_layer = truth("layer", layers)

        def average(at: Point) -> fmpq:
            every = (of_layer({**at, sy.j: layer}) for layer in range(at[sy.M]))
            return sum(every, fmpq(0)) / at[sy.M]

        return average
    divisor = exact(form.divisor.xreplace({s: sympy.Rational(n) for s, n in NUMBERS.items()}))
    return lambda at: packing(at).moment(form.statistic) / divisor


# points that tell polynomials of a degree apart


class Places:
    """The points of a form's domain."""

    def __init__(self, form: fd.ClosedForm) -> None:
        self._form = form
        self._symbols = [symbol for symbol in sy.INDICES if symbol in form.symbols.values()]

    @cached_property
    def _top(self) -> sympy.Symbol:
        """The height of packings; or the layer of the loaded bead, or of the only one."""
        return next(symbol for symbol in (sy.M, sy.l, sy.j) if symbol in self._symbols)

    @cached_property
    def _powers(self) -> Grid:
        """Those of the indices in the terms of all formulas, times their divisors."""
        places = [self._form.pieces[0].value.domain.position[symbol] for symbol in self._symbols]
        terms = chain.from_iterable(piece.value.numerator.to_dict() for piece in self._form.pieces)
        powers = [[int(term[place]) for place in places] for term in terms]
        return np.array(powers or [[0] * len(places)])

    @cached_property
    def _degree(self) -> int:
        return int(self._powers.sum(axis=1).max())

    @cache  # noqa: B019
    def _of_height(self, height: int) -> Grid:
        """Those of packings of a height, not farther out than the degree asks for."""
        far = height + self._degree + 2
        ranges = []
        for symbol in self._symbols:
            if symbol == self._top:
                ranges.append(np.array([height] if height or not symbol.is_positive else []))
            elif symbol == sy.k and sy.i in self._symbols:
                ranges.append(np.array([height % 2]))  # only i − k matters
            else:
                across = symbol in (sy.i, sy.k, sy.p, sy.q)
                ranges.append(np.arange(-far if across else 0, far + 1))
        grid = np.stack(np.meshgrid(*ranges, indexing="ij"), -1).reshape(-1, len(ranges))
        grid = grid[self._meeting(grid, self._form.kernel_domain.relations)]
        for form in self._form.even:
            if form.free_symbols <= {*self._symbols}:
                grid = grid[self._values(grid, form) % 2 == 0]
        return grid[np.argsort(abs(grid).sum(axis=1), kind="stable")]

    def _values(self, grid: Grid, form: sympy.Expr) -> Grid:
        """What a sum of indices is at each point."""
        terms = sympy.expand(form).as_coefficients_dict()
        factors = [int(terms.get(symbol, 0)) for symbol in self._symbols]
        return grid @ np.array(factors, dtype=np.int64) + int(terms.get(sympy.S.One, 0))

    def _meeting(self, grid: Grid, relations: Iterable[sympy.Basic]) -> np.ndarray[Any, Any]:
        """At which points all relations hold."""
        mask = np.ones(len(grid), dtype=bool)
        for relation in relations:
            if not relation.free_symbols <= {*self._symbols}:
                continue
            left, right = (self._values(grid, side) for side in relation.args)
            compare = {
                sympy.Eq: np.equal, sympy.Ge: np.greater_equal, sympy.Gt: np.greater,
                sympy.Le: np.less_equal, sympy.Lt: np.less,
            }[relation.func]  # fmt: skip
            mask &= compare(left, right)
        return mask

    def telling_apart(self, parts: Sequence[Sequence[sympy.Basic]]) -> Iterator[Point]:
        """Points at which no polynomial of the degree but 0 vanishes on all of some parts.

        At least one is in each part.
        """
        given = set.intersection(*({eq.lhs for eq in words.equations(part)} for part in parts))
        free = [n for n, symbol in enumerate(self._symbols) if symbol not in given]
        if sy.k in self._symbols and sy.i in self._symbols:
            free.remove(self._symbols.index(sy.k))
        highest = self._powers.max(axis=0)[free]
        if given:  # in its place stand other indices, whose powers add up
            highest[:] = self._degree
        basis, last = Basis(highest, self._degree), HIGHEST
        unseen = set(range(len(parts)))
        for height in range(HIGHEST + 1):
            grid = self._of_height(height)
            for place, part in enumerate(parts):
                for point in grid[self._meeting(grid, part)]:
                    if basis.is_full and place not in unseen:
                        break
                    if basis.takes(point[free]) or place in unseen:
                        last = height
                        unseen -= {place}
                        yield {s: int(n) for s, n in zip(self._symbols, point, strict=True)}
            if not unseen and (basis.is_full or height >= last + FARTHER):
                return
        raise AssertionError(f"packings of more than {HIGHEST} layers are needed")


PRIME = 2**31 - 1


class Basis:
    """Values of monomials at points, as rows that don't depend on each other.

    Of all monomials up to a degree, and up to one in each variable. They are calculated modulo a
    prime: rows that don't depend on each other then never do.
    """

    def __init__(self, highest: Grid, degree: int) -> None:
        ranges = (range(int(power) + 1) for power in highest)
        self._monomials = [powers for powers in product(*ranges) if sum(powers) <= degree]
        self._rows = np.zeros((0, len(self._monomials)), dtype=np.int64)
        self._pivots: list[int] = []

    @property
    def is_full(self) -> bool:
        return len(self._pivots) == len(self._monomials)

    def takes(self, point: Grid) -> bool:
        """Take a point if the values there don't follow from those at the others."""
        row = np.ones(len(self._monomials), dtype=np.int64)
        for place, monomial in enumerate(self._monomials):
            for number, power in zip(point, monomial, strict=True):
                row[place] = row[place] * pow(int(number), power, PRIME) % PRIME
        for own, pivot in zip(self._rows, self._pivots, strict=True):
            row = (row - row[pivot] * own) % PRIME
        if not row.any():
            return False
        pivot = int(np.flatnonzero(row)[0])
        row = row * pow(int(row[pivot]), -1, PRIME) % PRIME
        self._rows = np.vstack([self._rows, row])
        self._pivots.append(pivot)
        return True
