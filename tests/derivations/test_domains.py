"""Eqs. B1–B21 answer where they hold, and nowhere else: against all small exact packings."""

from collections.abc import Iterator
from fractions import Fraction
from itertools import product
from typing import Any

import pytest
import sympy
from force_diffusion.derivations.api.evaluation import ArgumentError
from force_diffusion.derivations.beyond import b12_between_layers as b12
from force_diffusion.derivations.witnesses import second_order
from force_diffusion.numeric import closed_forms
from force_diffusion.symbolic.printing.text import text
from force_diffusion.symbolic.symbols import M, j, k
from force_diffusion.symbolic.symbols import phi as cosine

import force_diffusion as fd
from tests.derivations.first_principles import covariance, mean_variance, weights

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
            if name and stated is not None:
                assert {getattr(closed_forms, name)(height, layer, count, phi, ONE, ONE)} == true
            elif name:
                with pytest.raises(ValueError, match="is allowed"):
                    getattr(closed_forms, name)(height, layer, count, phi, ONE, ONE)
    assert answers >= 7


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
                form = closed_forms.layers_covariance
                assert fraction(stated) == form(height, lower, upper, phi, ONE, ONE)
    assert answers >= 20


def test_a_contact_three_diagonals_away_may_be_correlated() -> None:
    """What was claimed to be zero: M = 20, j = 8, l = 14, six places to the left, φ = −41/841."""
    found = weights(20, Fraction(-41, 841), "surface")["+"]
    value = covariance(found[8], found[14], (14 - 8) + 2 * -6)
    assert value == Fraction(13078332971, 331914240000)
    stated = b12.LEFT_OVER[-k] * b12.UNIT.xreplace({b12.sigma: 1, b12.r: 1})
    at = {j: sympy.Integer(8), k: sympy.Integer(6), cosine: sympy.Rational(-41, 841)}
    assert fraction(sympy.sympify(stated).xreplace(at)) == value


def instances(splits: tuple[b12.Split, ...], size: int) -> set[tuple[int, int, int, int]]:
    """All (M, j, l, places) with M ≤ ``size`` that splits of M, j, k = l − j and places hold."""
    held = set()
    for places, at, bounds in splits:
        named = [at.get(symbol, symbol) for symbol in (M, j, k)]
        evaluate = sympy.lambdify(list(bounds), [*named, places.xreplace(at)], modules="math")
        for values in product(*(range(bound, size + 1) for bound in bounds.values())):
            height, lower, above, across = evaluate(*values)
            if height <= size:
                held.add((height, lower, lower + above, across))
    return held


def test_far_contacts_are_uncorrelated_where_step_6_says_and_correlated_elsewhere() -> None:
    size, phi = 12, PHIS[0]
    step = next(step for step in fd.equation("B12").steps() if step.formula.lhs == b12.FAR)
    assert "none of j − 1, …, j + 2" in step.reason
    far = set()
    for height in range(6, size + 1):
        found = weights(height, phi, "surface")["+"]
        for lower, upper in layers(height):
            if not 2 <= lower <= upper - 2 <= height - 4:
                continue
            above = upper - lower
            right = set(range(lower - 1, lower + 3))
            left = {*range(upper - 1, upper + 3), *range(above - 1, above + 2)}
            assert right | {-place for place in left} == {
                int(place.xreplace({j: lower, k: above})) for place in b12.LEFT_OVER
            }
            for place in (*range(3, size + 1), *range(-size, -2)):
                value = covariance(found[lower], found[upper], above + 2 * place)
                if place in right or -place in left:
                    continue
                assert value == 0, (height, lower, upper, place)
                far.add((height, lower, upper, place))
    covered = instances(b12.FAR_PLACES, size)
    assert {one for one in covered if abs(one[3]) <= size} == far


def test_what_is_left_at_the_other_places() -> None:
    height, lower, upper = 18, 6, 12
    found = weights(height, Fraction(1, 5), "surface")["+"]
    at = {M: height, j: lower, k: upper - lower, cosine: sympy.Rational(1, 5)}
    unit = 1 / (1 - Fraction(1, 5) ** 2) ** 2
    for place, value in b12.LEFT_OVER.items():
        across = upper - lower + 2 * int(place.xreplace(at))
        true = covariance(found[lower], found[upper], across)
        assert true == fraction(sympy.sympify(value).xreplace(at)) * unit != 0


def crossings(height: int) -> Iterator[tuple[int, int, int]]:
    """(j, l, s): where the diagonals of f⁺ of j and f⁻ of l cross, s layers above j."""
    return (
        (lower, upper, above)
        for lower, upper in layers(height)
        for above in range(-lower, height - lower)
    )


def test_the_other_branch_is_uncorrelated_where_B12_says() -> None:
    size, phi = 17, PHIS[0]
    found = weights(size, phi, "surface")
    held = {one[1:] for one in instances(b12.CROSSINGS, size) if one[0] == size}
    met_at_base = 0
    for lower, upper, above in crossings(size):
        layer = lower + above
        value = covariance(found["+"][lower], found["-"][upper], 2 * above - (upper - lower))
        far = min(abs(above), abs(layer - upper), layer, size - layer) >= 4
        at_base = layer > upper and abs(layer - upper - lower) < 4
        assert ((lower, upper, above) in held) == (far and not at_base)
        if far and not at_base:
            assert value == 0, (lower, upper, above)
        elif far:
            met_at_base += value != 0
    assert met_at_base  # what the claim used to call uncorrelated


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


# --- second order: Eqs. B5, B6 and B9 -----------------------------------------------------------

DIRECTIONS = {
    Fraction(-41, 841): (Fraction(21, 29), Fraction(20, 29)),
    Fraction(7, 25): (Fraction(3, 5), Fraction(4, 5)),
}


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
    (claim,) = (
        one.name for one in fd.equation(number)._derivation.claims if "go their own way" in one.name
    )
    assert "at j = 1 they fall for φ > −3/8 and rise for φ < −3/8" in claim
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
    assert domain.count("≥") >= 2
    source = fd.equation(number).python_code()
    assert source.count(f", for {domain}.") == source.count("def ")
