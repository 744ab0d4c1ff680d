"""What is true has no counterexample; what is false in one place alone has one."""

from itertools import chain

import pytest
import sympy
from force_diffusion.derivations.framework.loading import load
from force_diffusion.symbolic import symbols as sy
from force_diffusion.symbolic.kernel.where import (
    ENTERING,
    LOADED,
    LOADED_VERTICALLY,
    PASSING,
    SURFACE,
    Loading,
    Where,
)
from force_diffusion.symbolic.search import counterexample as module
from force_diffusion.symbolic.search.counterexample import counterexample
from force_diffusion.symbolic.symbols import (
    Braces,
    DeltaNMinus,
    DeltaNPlus,
    DeltaR,
    DeltaX,
    Dot,
    ForceMinus,
    ForcePlus,
    Load,
    M,
    Position,
    b_plus,
    e_y,
    f_load,
    i,
    j,
    k,
    l,
    m,
    n,
    n_minus,
    n_plus,
    n_x,
    n_y,
    phi,
    r,
    site_r,
    site_s,
    spacing,
    z,
)
from hypothesis import given
from hypothesis import strategies as st
from sympy import Add, Eq, Integer, Mul, Pow, Rational, Sum

from tests.properties.mutants import EQUIVALENT, mutants
from tests.soundness.corpus import TRUE
from tests.soundness.sources import Source
from tests.symbolic.search.domains import DOMAINS

PRINTED = [
    pytest.param(number, equation, id=f"{number}.{part}")
    for number in DOMAINS
    for part, equation in enumerate(load(number).printed)
]
MILLIONTH = Rational(1, 10**6)
IN_PLANE = [one for one in sy.PARAMETERS if one not in (sy.t_2, sy.t_3)]


def equal(left: sympy.Expr | int, right: sympy.Expr | int) -> sympy.Eq:
    return Eq(left, right, evaluate=False)


@pytest.mark.parametrize(("number", "equation"), PRINTED)
def test_the_printed_equation_has_none(number: int, equation: sympy.Eq) -> None:
    assert module._search(equation, DOMAINS[number]) is None


@pytest.mark.parametrize(("number", "equation"), PRINTED)
def test_every_mutant_has_one(number: int, equation: sympy.Eq) -> None:
    assert number not in EQUIVALENT
    for mutant in mutants(equation):
        assert counterexample(mutant.equation, DOMAINS[number]), mutant.change


@pytest.mark.long
@pytest.mark.parametrize(("number", "equation"), PRINTED)
def test_true_statements_in_another_form_have_none(number: int, equation: sympy.Eq) -> None:
    source = Source(equation, "=")
    true = [made for rule in chain(*TRUE.values()) for made in rule(source)]
    assert len(true) > 20
    for reason, statement in true:
        assert module._search(statement, DOMAINS[number]) is None, reason


@pytest.mark.parametrize("number", [1, 2, 3, 4, 5, 8, 9, 10, 11])
def test_the_same_elsewhere_on_the_lattice_has_none(number: int) -> None:
    """An equation without a fixed place holds at any bead; fixed ones speak of their own."""
    for equation in load(number).printed:
        image = {i: i + 2, k: k + 2, site_r: site_r + 2}
        moved = equal(*(side.xreplace(image) for side in equation.args))
        found = module._search(moved, DOMAINS[number])
        assert (found is None) == (number not in (8, 9, 10))


# false in one place alone

ONLY = {
    "j = 0": (11, Braces(1, 0, j, 0)),
    "j = 2": (11, Braces(1, 0, j, 2) * Braces(0, 1, j, 1)),
    "j = 5": (3, Braces(1, 0, j, 5) * Braces(0, 1, j, 4)),
    "M = j + 1": (11, Braces(1, 0, M, j + 1)),
    "M = 4": (11, Braces(1, 0, M, 4) * Braces(0, 1, M, 3)),
    "2j = M": (11, Braces(1, 0, 2 * j, M) * Braces(0, 1, 2 * j, M - 1)),
    "j = 3, M = 5": (11, Braces(1, 0, j * M, 15) * Braces(0, 1, j * M, 14)),
    "i = 0": (11, Braces(1, 0, i, 0) * Braces(0, 1, i, -1)),
    "i = −3": (4, Braces(1, 0, i, -3) * Braces(0, 1, i, -4)),
    "i = j": (4, Braces(1, 0, i, j) * Braces(0, 1, i, j - 1)),
    "l = 1": (7, Braces(1, 0, l, 1)),
    "s = 2": (8, Braces(1, 0, site_s, 2) * Braces(0, 1, site_s, 1)),
    "l = j + 1": (9, Braces(1, 0, l, j + 1)),
    "n = 1": (10, Braces(1, 0, n, 1)),
    "n = l − j − 1": (10, Braces(0, 1, n, l - j - 2)),
    "j = 1, n = 2": (10, Braces(1, 0, j, 1) * Braces(0, 1, j, 0) * Braces(1, 0, n, 2)),
    "k = i": (10, Braces(1, 0, k, i) * Braces(0, 1, k, i - 1)),
}


@pytest.mark.parametrize("place", ONLY)
def test_what_is_wrong_in_one_place_alone(place: str) -> None:
    number, there = ONLY[place]
    printed = load(number).printed[0]
    layer = {7: (k, l), 8: (site_r, site_s)}.get(number, (i, j))
    unit = b_plus if number in (3, 4) else 1
    wrong = MILLIONTH * there * DeltaR(layer[0] - 1, layer[1] - 1 + Braces(2, 0, layer[1], 0))
    assert counterexample(equal(printed.lhs, printed.rhs + wrong * unit), DOMAINS[number])


@pytest.mark.parametrize("along", [n_plus, b_plus, e_y, n_plus - n_minus])
@pytest.mark.parametrize("number", range(1, 6))
def test_one_component_of_a_vector(number: int, along: sympy.Expr) -> None:
    (printed,) = load(number).printed
    wrong = MILLIONTH * DeltaR(i - j, 0) * along
    assert counterexample(equal(printed.lhs, printed.rhs + wrong), DOMAINS[number])


# values of everything that is free


@pytest.mark.parametrize(
    ("left", "right", "where"),
    [
        (spacing, 4 * r * n_x, Where()),
        (phi, n_y**2 - n_x**2, Where()),
        (Dot(n_plus, n_minus), phi, Where()),
        (sy.t, sy.L_minus / sy.L_plus, Where()),
        (Dot(b_plus, b_plus), 1 / (1 - phi**2), Where()),
        (z * M, j, DOMAINS[11]),
        (j, M - 1, DOMAINS[11].also(Eq(j, M - 1))),
        (Dot(n_plus, DeltaNPlus(i, j)), 0, DOMAINS[4]),
        (Dot(n_plus, DeltaX(i, 0)), 0, DOMAINS[4].also(Eq(j, 0))),
        (DeltaR(i, j) * DeltaR(i, j), 0, DOMAINS[4]),
        (Position(i, j), j * r * (n_plus + n_minus) + i * r * (n_plus - n_minus), DOMAINS[1]),
        (ForcePlus(i + M - j, M), 0, DOMAINS[11]),
        (ForceMinus(k - 1, l - 1), 0, Where.of(l >= 1, loading=ENTERING)),
    ],
)
def test_true(left: sympy.Expr, right: sympy.Expr, where: Where) -> None:
    assert module._search(equal(left, right), where) is None
    assert counterexample(
        equal(left, right + (MILLIONTH * e_y if left.has(Position) else 1)), where
    )


@pytest.mark.parametrize(
    "quantity",
    [*IN_PLANE, sy.N, ForcePlus(k, l), ForceMinus(k, l), Dot(e_y, Load(k, l))],
)
def test_nothing_free_has_one_value(quantity: sympy.Expr) -> None:
    where = Where.of(l >= 0)
    found = counterexample(equal(quantity, 1), where)
    value = module.WORLDS[0].values().get(quantity, Rational(5, 7))
    assert found
    assert counterexample(equal(quantity, Rational(value.numerator, value.denominator)), where)


def test_a_domain_of_one_point_is_tried_with_every_cosine() -> None:
    for world in module.WORLDS:
        cosine = world.values()[phi]
        assert counterexample(equal(phi, Rational(cosine.numerator, cosine.denominator)), Where())
    cosines = Mul(*(phi - Rational(*w.values()[phi].as_integer_ratio()) for w in module.WORLDS[:3]))
    assert counterexample(equal(cosines, 0), Where())


@pytest.mark.parametrize("false", [Sum(1, (m, 1, 3 - j)), Dot(e_y, DeltaX(i, 13 * j))])
def test_places_where_nothing_can_be_said_are_passed_over(false: sympy.Expr) -> None:
    """At j = 4, which comes first, the sum has no agreed value, and layer 52 is too high."""
    assert next(module.points(DOMAINS[1]))[j] == 4
    found = counterexample(equal(false, 0), DOMAINS[1])
    assert found
    assert "j = 4" not in found


LOADINGS = [LOADED, LOADED_VERTICALLY, PASSING, ENTERING, SURFACE]
MIRRORED = [PASSING.mirrored(), ENTERING.mirrored()]
# "r" and "s" stand for any bead of a loading that says something of all
MOVED = [one.put_in({k: i + M - j, l: M}) for one in (*LOADINGS[:2], ENTERING, MIRRORED[1])]
MOVED += [PASSING.put_in({site_r: k + 1, site_s: l + 1})]


@pytest.mark.long(sample=2)
@pytest.mark.parametrize("loading", [*LOADINGS, *MIRRORED, *MOVED, *(o.mirrored() for o in MOVED)])
def test_what_a_loading_says_has_none_and_other_places_have(loading: Loading) -> None:
    """The packings know a loading by its name alone."""
    relations = [j >= 0, j < M] if loading.place[-1] == M else [loading.place[-1] >= 1]
    above = Where.of(*relations, loading=loading)
    given_there = [(one, ()) for one in loading.given]
    for equation, when in chain(given_there, loading.everywhere):
        held = Where.of(*relations, site_s >= 0, *when, loading=loading) if when else above
        assert module._search(equation, held) is None, (equation, when)
        if when:
            elsewhere = Where.of(*relations, site_s >= 0, loading=loading)
        else:
            elsewhere = Where.of(*above.relations, indices=above.indices)
        assert counterexample(equation, elsewhere), (equation, when)


@pytest.mark.long(sample=1)
@pytest.mark.parametrize("loading", [None, LOADED, LOADED_VERTICALLY, PASSING, ENTERING])
def test_any_bead_is_balanced(loading: Loading | None) -> None:
    def push(force: type, change: type, unit: sympy.Symbol, *at: sympy.Expr) -> sympy.Expr:
        return force(*at) * (unit + change(*at))

    plus, minus = (ForcePlus, DeltaNPlus, n_plus), (ForceMinus, DeltaNMinus, n_minus)
    below = push(*plus, i - 1, j - 1) + push(*minus, i + 1, j - 1)
    above = push(*plus, i, j) + push(*minus, i, j)
    where = Where.of(j >= 1, *([loading.place[-1] >= 1] if loading else []), loading=loading)
    assert module._search(equal(Load(i, j) + below - above, 0), where) is None
    assert counterexample(equal(Load(i, j) + below, 0), where)


def test_an_index_that_the_domain_does_not_name_is_drawn_too() -> None:
    found = counterexample(equal(DeltaR(i, j), DeltaR(k, l)), DOMAINS[1])
    assert "k = " in found
    assert counterexample(equal(DeltaR(k, l), DeltaR(k, l)), DOMAINS[1]) is None


# words


def test_words() -> None:
    found = counterexample(equal(j + Rational(3, 4), j - r), Where.of(Eq(j, 2), Eq(i, 0)))
    assert found == "at j = 2, φ = −7/25, r = 7/3: 11/4 on the left and −1/3 on the right".replace(
        "at j", "at i = 0, j"
    )
    found = counterexample(equal(DeltaR(0, 0) - DeltaR(0, 0), n_plus), Where())
    assert found.endswith("(0, 0) on the left and (4/5, 3/5) on the right")


@pytest.mark.parametrize(
    ("quantity", "words"),
    [
        (DeltaR(i + 1, j), "there is no bead (1, 4): the sum of its indices is odd"),
        (DeltaR(i, j - 20), "there is no bead (0, −16): it would be below the base"),
        (DeltaR(i, M + 2), "it would be above the surface"),
        (Dot(e_y, DeltaNPlus(i, M)), "it would be above the surface"),
        (DeltaR(i, j + Rational(1, 2)), "there is no such bead: 9/2 is no whole number"),
        (1 / (j - 4), "it divides by j − 4, which is 0"),
        (1 / DeltaR(i, j), "it divides by δr_ij, which is 0 without disorder"),
    ],
)
def test_what_is_not_there_and_what_has_no_value(quantity: sympy.Expr, words: str) -> None:
    where = DOMAINS[11] if quantity.has(M) else DOMAINS[1]
    assert words in counterexample(equal(quantity, quantity), where)


def test_sides_are_both_in_decimals_or_none() -> None:
    long, short = Rational(10**9 + 7, 7 * 10**8), Rational(5, 2)
    found = counterexample(equal(long, short), Where())
    assert found.endswith(": 1.42857 on the left and 2.5 on the right")
    found = counterexample(equal(long + Rational(1, 3), j), DOMAINS[1])
    assert found.endswith(": 1.7619 on the left and 4 on the right")


def test_sides_that_look_the_same_are_told_apart() -> None:
    found = counterexample(equal(1 + Rational(1, 10**9), 1 - Rational(1, 10**9)), Where())
    assert found.endswith(": 1 on the left and 1 on the right, apart by 1/500000000")


def test_what_is_summed_over_is_not_named() -> None:
    found = counterexample(equal(Sum(m, (m, 1, j)), 0), DOMAINS[1])
    assert found.startswith("at i = 0, j = 4, φ = ")


def test_long_fractions_are_cut() -> None:
    for mutant in mutants(load(11).printed[0]):
        assert len(counterexample(mutant.equation, DOMAINS[11])) < 250


# whatever comes in


def _tower(steps: int) -> sympy.Expr:
    tower = DeltaR(i, j)
    for _ in range(steps):
        tower = Add(Mul(2, tower, evaluate=False), 1, evaluate=False)
    return tower


def _doubled(times: int, doubled: sympy.Expr) -> sympy.Expr:
    for _ in range(times):
        doubled = Add(doubled, doubled, evaluate=False)
    return doubled


def _powers() -> sympy.Expr:
    power = Integer(3)
    for _ in range(8):
        power = Pow(power, 60, evaluate=False)
    return power


WHEREVER = Where.of(j >= 0, indices=(i, M))


@pytest.mark.long(sample=1)
@pytest.mark.parametrize(
    "side",
    [
        _tower(5000),
        _doubled(100, DeltaR(i, j)),
        _powers(),
        Pow(phi, 10**9, evaluate=False),
        Sum(m, (m, 1, 10**9)),
        Sum(Sum(Sum(m + n, (m, 1, 900)), (n, 1, 900)), (sy.p, 1, 900)),
        DeltaR(i, _doubled(100, j)),
        Sum(Pow(10**1000 + m, -1), (m, 1, 900)),
        Sum(Sum(Pow(7**500 * m + n, -1), (m, 1, 900)), (n, 1, 900)),
        Dot(n_plus, Sum(DeltaX(i + 2 * m * (j + 1), j + 30), (m, 1, 900))),
        Add(*(DeltaR(i + 2 * one, j) for one in range(6000)), evaluate=False),
        DeltaX(i, j + 10**6),
        DeltaX(i, j) * 10 ** (10**5),
        sympy.Symbol("t"),
        sympy.Float(1.5),
        sympy.oo,
        sympy.nan,
        sympy.zoo,
        sympy.sqrt(M),
        sympy.sin(phi),
        sympy.Piecewise((1, j > 2), (0, True)),
        sympy.Function("f")(j),
        sympy.Derivative(phi**2, phi),
        sympy.ImmutableMatrix([[1, j]]),
        n_plus,
        n_plus * n_minus,
        Sum(m, (m, j, j - 2)),
        Sum(1, (m, 1, j / 2 + Rational(1, 4))),
        sympy.Lambda(j, j),
        sympy.Interval(0, 1),
        sympy.Order(j),
    ],
    ids=lambda side: type(side).__name__,
)
def test_it_ends_without_a_verdict_whatever_the_tree(side: sympy.Basic) -> None:
    assert counterexample(equal(side, 1), WHEREVER) is None
    assert counterexample(equal(DeltaR(i, j), 1), WHEREVER)


@pytest.mark.parametrize(
    ("statement", "where"),
    [
        (sympy.true, Where()),
        (None, Where()),
        ("1 = 2", Where()),
        (equal(1, 2), None),
        (equal(1, 2), Where(dimension=3)),
        (equal(j, 2), Where.of(j >= 2, j <= 1)),
        (equal(f_load, 1), Where(loading=Loading("hanging", "from above"))),
        (equal(f_load, 1), Where(loading=Loading("surface", "of no height"))),
    ],
)
def test_what_can_not_be_tried_is_not_refuted(statement: object, where: object) -> None:
    assert counterexample(statement, where) is None


leaves = st.sampled_from(
    [
        *map(Integer, (-2, 0, 1, 3)),
        Rational(1, 2),
        *(phi, n_x, n_y, r, j, i, m, n_plus, b_plus, e_y),
        *(DeltaR(i, j), DeltaX(i, j), DeltaNPlus(i, j), ForcePlus(i, j), Load(i, j)),
        *(sympy.Float(0.5), sympy.Symbol("phi"), sympy.oo, sympy.pi),
    ]
)


def _grown(inner: st.SearchStrategy[sympy.Expr]) -> st.SearchStrategy[sympy.Expr]:
    def kept(kind: type, **options: bool) -> object:
        return lambda one, other: kind(one, other, **options)

    return st.one_of(
        st.builds(kept(Add, evaluate=False), inner, inner),
        st.builds(kept(Mul, evaluate=False), inner, inner),
        st.builds(kept(Pow, evaluate=False), inner, inner),
        st.builds(kept(Dot), inner, inner),
        st.builds(kept(DeltaR), inner, inner),
        st.builds(Braces, inner, inner, inner, inner),
        st.builds(lambda body, end: Sum(body, (m, 1, end)), inner, inner),
    )


trees = st.recursive(leaves, _grown, max_leaves=12)


@given(trees, trees, st.sampled_from(list(DOMAINS.values())))
def test_no_tree_makes_it_fail(left: sympy.Expr, right: sympy.Expr, where: Where) -> None:
    found = counterexample(equal(left, right), where)
    assert found is None or found.startswith("at ")


@given(trees, st.sampled_from(list(DOMAINS.values())))
def test_nothing_differs_from_itself(side: sympy.Expr, where: Where) -> None:
    found = counterexample(equal(side, side), where)
    assert found is None or "bead" in found or "divides by" in found
