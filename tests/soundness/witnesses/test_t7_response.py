"""Eqs. B9, B22 and B23: the response to point loads, its mean and its averages."""

from collections.abc import Iterable, Iterator
from fractions import Fraction
from itertools import product

import pytest
import sympy
from force_diffusion.derivations.beyond import t7_averages, t7_pairs, t7_response
from force_diffusion.symbolic.algebra import explicit
from force_diffusion.symbolic.symbols import N, i, j, k, l, p, phi, q, r, sigma

from tests.soundness.witnesses import second_order
from tests.soundness.witnesses.comparing import assert_equal
from tests.soundness.witnesses.draws import SmallPacking
from tests.soundness.witnesses.squared_weights import mean_response

pytestmark = pytest.mark.long(sample=1)

LEVELS = (1, 2, 3, 5)
"""Layers of the load; below the last there are contacts of every closed form."""


def stated_mean(inside: str, leg: str, at: explicit.Values) -> Fraction:
    """By a closed form, the first that fits; nothing outside of the cone."""
    if at[p] < 1 or at[q] < 0:
        return Fraction(0)
    return t7_response.MEANS[inside if at[q] else leg].value(at)


def test_the_mean_of_every_contact_and_bead_of_a_cone(packing: SmallPacking) -> None:
    values = {**explicit.geometry(*packing.n, Fraction(1)), sigma: 1, r: 1}

    def pairs() -> Iterator[tuple[str, Fraction, Fraction]]:
        for level in LEVELS:
            forces = second_order.response(level, packing.n)
            pushes = second_order.pushes(level, packing.n)
            for layer in range(level):
                for left in range(-1, level - layer + 2):
                    right = level - layer - left
                    at = {**values, l: level, j: layer, p: left, q: right}
                    where = f"l = {level}, j = {layer}, p = {left}, q = {right}"
                    for branch, side in (("+", 1), ("-", -1)):
                        true = forces[(side * (right - left), layer), branch]
                        yield f"f{branch}, {where}", stated_mean("contact", "leg-force", at), true
                    if left < 1:  # on the right leg it is as on the left one
                        at |= {p: right, q: left}
                    yield f"p, {where}", stated_mean("bead", "leg", at), pushes[right - left, layer]

    assert_equal(pairs())


def sites() -> Iterator[tuple[str, dict[sympy.Symbol, int]]]:
    """Where there may be a closed form, in words and as indices: loads in layer l ≤ 8."""
    for level, layer, left, count in product((4, 6, 8), range(6), range(1, 7), range(2, 5)):
        right = level - layer - left
        if right >= 1:
            at = {l: level, j: layer, p: left, q: right, N: count, k: 0, i: right - left}
            yield f"l = {level}, j = {layer}, p = {left}, q = {right}, N = {count}", at


def stated_and_true(
    packing: SmallPacking,
    form: sympy.Expr,
    at: dict[sympy.Symbol, int],
    pairs: Iterable[tuple[int, int]],
) -> tuple[Fraction, Fraction]:
    """What is stated of a mean over pairs, and what is true, r = σ = 1."""
    cosine = packing.n[1] ** 2 - packing.n[0] ** 2
    stated = explicit.number(form, {**at, phi: cosine, sigma: 1, r: 1})
    return stated, mean_response(at[l], (at[i], at[j]), tuple(pairs), packing.n)


def test_averages_over_loads_and_beads(packing: SmallPacking) -> None:
    def pairs() -> Iterator[tuple[str, Fraction, Fraction]]:
        for one in t7_averages.BLOCKS:
            forms = [(form, where) for *_, form, where in one.forms()]
            for (words, at), (form, where) in product(sites(), forms):
                if where.holds(at):
                    loads = range(at[N] if one is not t7_averages.BEADS else 1)
                    beads = range(at[N] if one is not t7_averages.LOADS else 1)
                    both = stated_and_true(packing, form, at, product(loads, beads))
                    yield f"{one.name}, {words}", *both

    assert_equal(pairs())


def test_averages_over_pairs(packing: SmallPacking) -> None:
    def pairs() -> Iterator[tuple[str, Fraction, Fraction]]:
        forms = [(t7_pairs.ROW.rhs, t7_pairs.SHORT), *t7_pairs._rows()]
        for words, at in sites():
            for form, where in forms:
                if where.holds(at):
                    places = ((place, place) for place in range(at[N]))
                    yield words, *stated_and_true(packing, form, at, places)

    assert_equal(pairs())
