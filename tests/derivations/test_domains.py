"""Eqs. B1–B25 answer where they hold, and nowhere else: against all small exact packings."""

from collections.abc import Iterable, Iterator
from fractions import Fraction
from itertools import product
from typing import Any

import pytest
import sympy
from force_diffusion.derivations.api.evaluation import ArgumentError
from force_diffusion.derivations.beyond import t6_correlations as t6
from force_diffusion.numeric import closed_forms
from force_diffusion.symbolic.algebra import explicit
from force_diffusion.symbolic.printing.text import text
from force_diffusion.symbolic.symbols import M, j, l, p
from force_diffusion.symbolic.symbols import phi as cosine
from force_diffusion.symbolic.symbols import r as radius
from force_diffusion.symbolic.symbols import sigma as deviation

import force_diffusion as fd
from tests.derivations.first_principles import covariance, mean_variance, weights
from tests.soundness.witnesses import second_order
from tests.soundness.witnesses.squared_weights import mean_response

PHIS = (Fraction(-1, 8), Fraction(1, 5))
ONE = Fraction(1)
ONES = {"sigma": 1, "r": 1}


def fraction(value: Any) -> Fraction:
    return Fraction(int(value.p), int(value.q))


def answer(number: str, **arguments: Any) -> Any:
    """What the printed equation says, or None where it refuses."""
    try:
        return fd.equation(number).at(**arguments, **ONES)
    except ArgumentError:
        return None


def layers(height: int) -> Iterator[tuple[int, int]]:
    """All 0 ≤ j ≤ l < M."""
    return ((lower, upper) for upper in range(height) for lower in range(upper + 1))


# --- means over neighbours: Eqs. B7, B8 and B21 -------------------------------------------------

MEANS = {
    "B7": ("surface", "+-", 9, "contacts_mean_variance"),
    "B8": ("surface", "p", 12, "beads_mean_variance"),
    "B21": ("bulk", "+-", 9, None),
}


@pytest.mark.long(sample=1)
@pytest.mark.parametrize("number", MEANS)
def test_means_over_neighbours_answer_only_where_they_hold(number: str) -> None:
    load, kinds, highest, name = MEANS[number]
    phi, answers = PHIS[0], 0
    for height in range(1, highest + 1):
        found = weights(height, phi, load)
        for layer, count in product(range(height), (1, 2, 3, 4, 5, 7, 10)):
            true = {mean_variance(found[kind][layer], count) for kind in kinds}
            stated = answer(number, M=height, j=layer, N=count, phi=phi)
            if stated is not None:
                answers += 1
                assert {fraction(stated)} == true, (height, layer, count)
            told = exact_answers(number, M=height, j=layer, N=count, phi=phi)
            assert {fraction(one) for one in told} <= true, (height, layer, count)
            if count >= 2:  # one form for every N ≥ 2, every layer and height
                assert len(told) + (stated is not None) == 1, (height, layer, count)
            if name and stated is not None:
                assert {getattr(closed_forms, name)(height, layer, count, phi, ONE, ONE)} == true
            elif name:
                with pytest.raises(ValueError, match="is allowed"):
                    getattr(closed_forms, name)(height, layer, count, phi, ONE, ONE)
    assert answers >= 7


def exact_answers(number: str, of: Iterable[str] = ("",), **arguments: Any) -> list[Any]:
    """What the exact cases whose names begin so say; those that refuse are left out."""
    found = []
    for name in (one for one in fd.equation(number).cases if one.startswith(tuple(of))):
        try:
            found.append(fd.equation(number).exact(name).at(**arguments, **ONES))
        except ArgumentError:
            continue
    return found


@pytest.mark.parametrize("number", ["B7", "B21"])
def test_from_N_equal_to_j_on_the_printed_mean_over_neighbours_is_another(number: str) -> None:
    """Why they refuse there: the covariances of k = j − 1, …, j + 2 join in, and add up to zero."""
    load, *_ = MEANS[number]
    phi, height, layer = PHIS[0], 9, 5
    single = weights(height, phi, load)["+"][layer]
    beyond = {place: covariance(single, single, 2 * place) for place in range(3, 3 * height)}
    assert {place for place, value in beyond.items() if value} == {4, 5, 6, 7}
    assert sum(beyond.values()) == 0
    printed = fd.equation(number).rhs.doit()
    at = {"M": height, "j": layer, "phi": sympy.Rational(-1, 8), **ONES}
    symbols = fd.equation(number).symbols
    for count in range(3, 15):
        stated = printed.xreplace(
            {symbols[name]: sympy.sympify(value) for name, value in {**at, "N": count}.items()}
        )
        assert (fraction(stated) == mean_variance(single, count)) == (count <= layer - 1), count


# --- between layers: Eq. B12 --------------------------------------------------------------------


@pytest.mark.parametrize("phi", PHIS)
def test_the_covariance_between_layers_is_answered_only_where_it_holds(phi: Fraction) -> None:
    answers = 0
    for height in range(1, 11):
        found = weights(height, phi, "surface")
        for lower, upper in layers(height):
            stated = answer("B12", M=height, j=lower, l=upper, phi=phi)
            if stated is not None:
                answers += 1
                for kind, side in (("+", 1), ("-", -1)):
                    pair = found[kind][lower], found[kind][upper]
                    assert fraction(stated) == covariance(*pair, side * (upper - lower))
    assert answers >= 20


def test_a_contact_three_diagonals_away_may_be_correlated() -> None:
    """What was claimed to be zero: M = 20, j = 8, l = 14, six places to the left, φ = −41/841."""
    found = weights(20, Fraction(-41, 841), "surface")["+"]
    value = covariance(found[8], found[14], (14 - 8) + 2 * -6)
    assert value == Fraction(13078332971, 331914240000)
    (stated,) = (one for side, place, one in t6.LEFT_OVER if side == t6.FAR_LEFT and place == l - j)
    assert at_values(stated * t6.UNIT, 20, 8, 14, Fraction(-41, 841)) == value


def at_values(form: sympy.Expr, height: int, lower: int, upper: int, phi: Fraction) -> Fraction:
    """A closed form of two layers, r = σ = 1."""
    values: explicit.Values = {
        M: height, j: lower, l: upper, cosine: phi, deviation: 1, radius: 1,
    }  # fmt: skip
    return explicit.number(form, values)


def holds(relations: tuple[sympy.Basic, ...], height: int, *layers: int, places: int) -> bool:
    """Whether relations of M, j, l and p hold."""
    lower, upper = layers
    at = {M: height, j: lower, l: upper, p: places}
    return t6.between(*relations, *t6.UPPER).holds(at)


def test_far_contacts_are_uncorrelated_where_step_6_says_and_correlated_elsewhere() -> None:
    size, phi = 12, PHIS[0]
    step = next(step for step in fd.equation("B12").steps() if step.equations[0].lhs == t6.FAR)
    assert "none of j − 1, …, j + 2" in step.reason
    seen = set()
    for height in range(6, size + 1):
        found = weights(height, phi, "surface")["+"]
        for lower, upper in layers(height):
            if not 2 <= lower <= upper - 2 <= height - 4:
                continue
            above = upper - lower
            right = set(range(lower - 1, lower + 3))
            left = {*range(upper - 1, upper + 3), *range(above - 1, above + 2)}
            for place in (*range(3, size + 1), *range(-size, -2)):
                value = covariance(found[lower], found[upper], above + 2 * place)
                side = t6.FAR if place > 0 else t6.FAR_LEFT
                told = any(
                    side == one and holds(when, height, lower, upper, places=abs(place))
                    for one, when in t6.UNCORRELATED
                )
                assert told != (place in right or -place in left), (height, lower, upper, place)
                if told:
                    seen.add(side)
                    assert value == 0, (height, lower, upper, place)
    assert seen == {t6.FAR, t6.FAR_LEFT}


@pytest.mark.parametrize(("height", "lower", "upper"), [(18, 6, 12), (11, 4, 8)])
def test_what_is_left_at_the_other_places(height: int, lower: int, upper: int) -> None:
    found = weights(height, Fraction(1, 5), "surface")["+"]
    for side, place, value in t6.LEFT_OVER:
        away = int(place.xreplace({j: lower, l: upper})) * (1 if side == t6.FAR else -1)
        true = covariance(found[lower], found[upper], upper - lower + 2 * away)
        assert true == at_values(value * t6.UNIT, height, lower, upper, Fraction(1, 5)) != 0


@pytest.mark.parametrize("phi", PHIS)
def test_the_covariance_at_the_edges(phi: Fraction) -> None:
    """With the printed form every pair of layers j < l has one; a bulk load is not told here."""
    for height in range(2, 9):
        found = weights(height, phi, "surface")["+"]
        for lower, upper in layers(height):
            if lower == upper:
                continue
            true = covariance(found[lower], found[upper], upper - lower)
            arguments = {"M": height, "j": lower, "l": upper, "phi": phi}
            told = [*exact_answers("B12", **arguments), answer("B12", **arguments)]
            stated = {fraction(one) for one in told if one is not None}
            assert stated == {true} or (upper - lower == 1 and upper == height - 1 and lower < 2)


def crossings(height: int) -> Iterator[tuple[int, int, int]]:
    """(j, l, s): where the diagonals of f⁺ of j and f⁻ of l cross, s layers above j."""
    return (
        (lower, upper, above)
        for lower, upper in layers(height)
        for above in range(-lower, height - lower)
    )


@pytest.mark.long
def test_the_other_branch_is_uncorrelated_where_B12_says() -> None:
    size, phi = 17, PHIS[0]
    found = weights(size, phi, "surface")
    met_at_base = 0
    for lower, upper, above in crossings(size):
        layer = lower + above
        value = covariance(found["+"][lower], found["-"][upper], 2 * above - (upper - lower))
        far = min(abs(above), abs(layer - upper), layer, size - layer) >= 4
        at_base = layer > upper and abs(layer - upper - lower) < 4
        told = any(holds(when, size, lower, upper, places=above) for when in t6.CROSSINGS)
        assert told == (far and not at_base)
        if told:
            assert value == 0, (lower, upper, above)
        elif far:
            met_at_base += value != 0
    assert met_at_base  # what the claim used to call uncorrelated


@pytest.mark.parametrize(("height", "lower", "upper"), [(22, 4, 11), (22, 10, 18), (24, 5, 13)])
def test_where_the_other_branch_is_correlated(height: int, lower: int, upper: int) -> None:
    phi = Fraction(1, 5)
    found = weights(height, phi, "surface")
    stated = [one for group in t6.CROSSED.values() for one in group]
    told = []
    for above in range(-lower - 2, height - lower + 2):
        true = covariance(found["+"][lower], found["-"][upper], 2 * above - (upper - lower))
        at = {M: height, j: lower, l: upper, p: above}
        values = [value for where, value in stated if t6.between(*where).holds(at)]
        assert len(values) == (true != 0), above
        for value in values:
            assert true == at_values(value * t6.UNIT, height, lower, upper, phi)
        told += values
    assert len(told) == (16 if height < lower + upper + 6 else 19)


@pytest.mark.parametrize("phi", PHIS)
def test_under_a_bulk_load_forces_are_correlated_where_diagonals_cross_above_both(
    phi: Fraction,
) -> None:
    """What the documentation called zero without naming a load; other crossings are as above."""
    size = 12
    found = weights(size, phi, "bulk")
    for lower, upper, above in crossings(size):
        layer = lower + above
        value = covariance(found["+"][lower], found["-"][upper], 2 * above - (upper - lower))
        if layer > upper:
            assert value != 0, (lower, upper, above)
        elif min(abs(above), abs(layer - upper), layer, size - layer) >= 4:
            assert value == 0, (lower, upper, above)


# --- averages of the response: Eqs. B22 and B23 ------------------------------------------------

N_OF_RESPONSE = (Fraction(3, 5), Fraction(4, 5))


@pytest.mark.long(sample=1)
@pytest.mark.parametrize("level", [5, 6, 8])
def test_averages_of_the_response_have_one_form_wherever_all_beads_are_inside(level: int) -> None:
    phi, answers = Fraction(7, 25), 0
    for layer, left, count in product(range(level - 1), range(1, level), (2, 3)):
        right = level - layer - left
        if right < 1:
            continue
        at = {"l": level, "j": layer, "N": count, "phi": phi}
        at |= {"k": level, "i": level + right - left}
        one, many = range(1), range(count)
        blocks = {"loads": (many, one), "beads": (one, many), "both": (many, many)}
        for name, (loads, beads) in blocks.items():
            inside = all(min(left + a - b, right - a + b) >= 1 for a, b in product(loads, beads))
            told = exact_answers("B22", [name], **at)
            assert len(told) == inside, (name, at)
            if inside:
                pairs = tuple(product(loads, beads))
                answers += 1
                true = mean_response(level, (right - left, layer), pairs, N_OF_RESPONSE)
                assert fraction(told[0]) == true, (name, at)
        for stated in exact_answers("B23", **at):
            pairs = tuple((a, a) for a in many)
            assert fraction(stated) == mean_response(
                level, (right - left, layer), pairs, N_OF_RESPONSE
            )
    assert answers >= 20


# --- second order: Eqs. B5, B6 and B9 -----------------------------------------------------------

DIRECTIONS = {
    Fraction(-41, 841): (Fraction(21, 29), Fraction(20, 29)),
    Fraction(7, 25): (Fraction(3, 5), Fraction(4, 5)),
}


@pytest.mark.long(sample=1)
@pytest.mark.parametrize("phi", DIRECTIONS)
def test_the_mean_response_is_answered_only_where_it_holds(phi: Fraction) -> None:
    answers = 0
    for level in range(1, 8):
        found = second_order.response(level, DIRECTIONS[phi])
        for layer in range(level):
            stated = answer("B9", l=level, j=layer, phi=phi)
            if stated is None:
                continue
            answers += 1
            inside, leg = map(fraction, stated)
            depth = level - layer
            legs = {found[(-depth, layer), "+"], found[(depth, layer), "-"]}
            beside = range(4 - depth, depth, 2)  # off the line that starts below the load
            between = {found[(a, layer), "+"] for a in beside}
            between |= {found[(-a, layer), "-"] for a in beside}
            assert (legs, between) == ({leg}, {inside}), (level, layer)
    assert answers == 6


@pytest.mark.parametrize(("level", "layer"), [(5, 0), (5, 1), (5, 3), (5, 4), (2, 1)])
def test_the_mean_response_refuses_in_words(level: int, layer: int) -> None:
    with pytest.raises(ArgumentError, match=r"Eq\. B9 is for j ≥ 2, l ≥ j \+ 3, not for"):
        fd.equation("B9").at(l=level, j=layer, phi=Fraction(1, 5), **ONES)


STEEP = (Fraction(56, 65), Fraction(33, 65))
"""φ = −2047/4225, below −3/8."""


@pytest.mark.parametrize(("number", "load"), [("B5", "surface"), ("B6", "bulk")])
def test_forces_next_to_the_base_rise_or_fall_as_claimed(number: str, load: str) -> None:
    claims = [one.name for one in fd.equation(number)._derivation.all_claims]
    assert any("at j = 1 they fall for φ > −3/8 and rise for φ < −3/8" in one for one in claims)
    below = fd.equation(number).exact("base+1")
    for n, falls, height in ((STEEP, False, 4), (DIRECTIONS[Fraction(-41, 841)], True, 7)):
        phi = n[1] ** 2 - n[0] ** 2
        base, above, *_ = second_order.means(height, n, load)[0]
        assert base > 0
        assert (above < 0) == falls
        assert fraction(below.at(M=height, j=1, phi=phi, **ONES)) == above


@pytest.mark.parametrize("number", ["B7", "B8", "B9", "B12", "B21"])
def test_python_source_says_where_it_holds(number: str) -> None:
    """It checks nothing: whoever calls it has to know."""
    domain = ", ".join(text(relation) for relation in fd.equation(number)._derivation.domain)
    assert domain.count("≥") + domain.count("≤") >= 2
    source = fd.equation(number).python_code()
    assert source.count(f", for {domain}.") == source.count("def ")
