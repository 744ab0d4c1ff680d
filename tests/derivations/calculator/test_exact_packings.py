"""Exact forms of drawn observables against squared weights of exact packings, as fractions.

Values and domains both: for every packing up to M = 6, at every bead where all contacts exist the
form has the value of the packing, and at every other place it has none.
"""

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from fractions import Fraction
from functools import reduce
from itertools import product
from operator import add

import pytest
import sympy
from flint import fmpq
from force_diffusion.derivations.calculator.loads import LoadCase
from force_diffusion.numeric.arithmetic.errors import ArgumentError
from hypothesis import given, settings
from hypothesis import strategies as st

import force_diffusion as fd
from force_diffusion.symbols import N, f_minus, f_plus, i, j, k, l, p, t
from tests.properties.reading import AbsentError
from tests.soundness.witnesses.moments import DIRECTIONS, Packing, Value, covariance, exact

HIGHEST = 6
FEW, SOME = (settings(max_examples=max(2, settings.default.max_examples // n)) for n in (20, 10))
TWO = DIRECTIONS[:2]
"""With φ of either sign; packings are shared by examples."""

Bead = tuple[int, int]


@dataclass(frozen=True)
class Term:
    """A multiple of a contact's force over its ordered value, so many columns and layers away."""

    factor: int
    branch: str
    across: int
    up: int

    def force(self, column: sympy.Expr, layer: sympy.Expr) -> sympy.Expr:
        """The same for the calculator."""
        kind = f_plus if self.branch == "+" else f_minus
        return self.factor * kind(column + self.across, layer + self.up)

    def value(self, packing: Packing, bead: Bead) -> Value:
        """The same in a packing."""
        force = self.bare(packing, bead)
        return force.scaled(self.factor / force.ordered)

    def bare(self, packing: Packing, bead: Bead) -> Value:
        """The contact's force."""
        name = "ForcePlus" if self.branch == "+" else "ForceMinus"
        return packing.quantity(name, bead[0] + self.across, bead[1] + self.up)


Terms = tuple[Term, ...]


def observable(terms: Terms, column: sympy.Expr, layer: sympy.Expr) -> sympy.Expr:
    return sympy.Add(*(term.force(column, layer) for term in terms))


def value(terms: Terms, packing: Packing, bead: Bead) -> Value:
    return reduce(add, (term.value(packing, bead) for term in terms))


def _terms(most: int) -> st.SearchStrategy[Terms]:
    """Different contacts, so that none cancels."""
    term = st.builds(
        lambda factor, branch, across, up: Term(factor, branch, 2 * across + up % 2, up),
        st.integers(-3, 3).filter(bool),
        st.sampled_from("+-"),
        st.integers(-2, 2),
        st.integers(-1, 2),
    )
    return st.lists(
        term, min_size=1, max_size=most, unique_by=lambda term: (term.branch, term.across, term.up)
    ).map(tuple)


@dataclass(frozen=True)
class Drawn:
    """A load, and packings under it.

    Attributes:
        kind: "surface" or "bulk".
        ratio: t; the load is vertical where none is given.
        n: rational base vectors.
    """

    kind: str
    ratio: Fraction | None
    n: tuple[Fraction, Fraction]

    @property
    def load(self) -> str | LoadCase:
        if self.ratio is None:
            return self.kind
        return fd.leaning(t, self.kind)

    def packing(self, height: int) -> Packing:
        return Packing(height, self.n, self.kind, self.ratio or Fraction(1))

    def numbers(self, form: fd.ClosedForm, height: int) -> dict[str, Fraction | int]:
        """Values of a form's symbols, except those that place a bead."""
        given = {"M": height, "phi": self.n[1] ** 2 - self.n[0] ** 2, "sigma": 1, "r": 1}
        if self.ratio:
            given["t"] = self.ratio
        return {name: given[name] for name in given if name in form.symbols}


loads = st.builds(
    Drawn,
    st.sampled_from(["surface", "bulk"]),
    st.sampled_from([None, Fraction(2), Fraction(3, 5)]),
    st.sampled_from(TWO),
)


def compare(
    form: fd.ClosedForm, drawn: Drawn, places: Iterable[dict[str, int]],
    true: Callable[[Packing, dict[str, int]], fmpq],
    heights: Iterable[int] = range(1, HIGHEST + 1),
) -> None:  # fmt: skip
    """Compare a form with packings at each place, and where it has a value with where it is."""
    places = list(places)
    for height in heights:
        packing, numbers = drawn.packing(height), drawn.numbers(form, height)
        for at in places:
            try:
                expected = true(packing, at)
            except AbsentError:
                with pytest.raises(ArgumentError, match=r" is for .*, not for "):
                    form.at(**at, **numbers)
            else:
                assert exact(form.at(**at, **numbers)) == expected, (height, at)


LAYERS = range(-2, HIGHEST + 3)


def beads(form: fd.ClosedForm) -> Iterator[dict[str, int]]:
    assert {*form.symbols} >= {"M", "j"}
    return ({"j": layer} for layer in LAYERS)


@SOME
@given(_terms(3), loads)
def test_variances(terms, drawn):
    form = fd.variance(observable(terms, i, j), load=drawn.load)

    def true(packing: Packing, at: dict[str, int]) -> fmpq:
        whole = value(terms, packing, (at["j"] % 2, at["j"]))
        return covariance(whole, whole)

    compare(form, drawn, beads(form), true)


@pytest.mark.long
@FEW
@given(_terms(1), _terms(1), loads, st.integers(-9, 8))
def test_two_layers(terms, others, drawn, apart):
    """At any distance; where the distance is of the wrong parity there is no bead."""
    form = fd.covariance(observable(terms, i, j), observable(others, i + p, l), load=drawn.load)

    def true(packing: Packing, at: dict[str, int]) -> fmpq:
        first, second = (at["j"] % 2, at["j"]), (at["j"] % 2 + at["p"], at["l"])
        return covariance(value(terms, packing, first), value(others, packing, second))

    places = [{"j": a, "l": b, "p": c} for a, b, c in product(LAYERS, LAYERS, (apart, apart + 1))]
    compare(form, drawn, places, true, heights=(2, HIGHEST))


def mean(terms: Terms, packing: Packing, bead: Bead, count: int) -> Value:
    several = (value(terms, packing, (bead[0] + 2 * place, bead[1])) for place in range(count))
    return reduce(add, several).scaled(fmpq(1, count))


@pytest.mark.long
@FEW
@given(_terms(1), loads, st.sampled_from([(i, i), (i - p, p)]))
def test_any_number_of_neighbours(terms, drawn, places):
    column, over = places
    form = fd.variance(fd.mean_over(observable(terms, column, j), N, over), load=drawn.load)

    def true(packing: Packing, at: dict[str, int]) -> fmpq:
        if at["N"] < 1:
            raise AbsentError("no neighbour")
        whole = mean(terms, packing, (at["j"] % 2, at["j"]), at["N"])
        return covariance(whole, whole)

    compare(form, drawn, ({"j": layer, "N": n} for layer in LAYERS for n in range(9)), true)


@FEW
@given(_terms(2), st.sampled_from(TWO))
def test_second_order_of_products(terms, n):
    """The shift of the mean of the product of all terms."""
    drawn = Drawn("surface", Fraction(3, 5), n)
    forces = sympy.Mul(*(term.force(i, j) for term in terms))
    form = fd.mean(forces, order=2, load=drawn.load)

    def true(packing: Packing, at: dict[str, int]) -> fmpq:
        values = (term.value(packing, (at["j"] % 2, at["j"])) for term in terms)
        return reduce(lambda a, b: a * b, values).shift

    compare(form, drawn, beads(form), true)


@FEW
@given(_terms(2), st.sampled_from(TWO))
def test_below_one_loaded_bead(terms, n):
    """Of forces over f_load/2n_y, as the ordered one is zero off the legs."""
    form = fd.variance(observable(terms, i, j), load=fd.point(k, l))
    cosine = n[1] ** 2 - n[0] ** 2
    for level in range(1, 5):
        packing = Packing(level, n, "point", at={k: level % 2}, order=1)
        for layer, column in product(range(-2, level + 3), range(-level - 5, level + 7)):
            at = {"i": column, "j": layer, "k": level % 2, "l": level, "phi": cosine}
            try:
                forces = (term.bare(packing, (column, layer)).scaled(term.factor) for term in terms)
                whole = reduce(add, forces)
            except AbsentError:
                with pytest.raises(ArgumentError, match=r" is for .*, not for "):
                    form.at(**at, sigma=1, r=1)
            else:
                assert exact(form.at(**at, sigma=1, r=1)) == covariance(whole, whole), at
