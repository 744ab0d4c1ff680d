"""Attempts to prove what is false, through every public name of the kernel.

Each attempt is refused in the right words. Beside it stands what is true, and is proved. Importing
this proves equations: tests do so when they run.
"""

import copy
import pickle
from collections.abc import Callable
from dataclasses import dataclass, replace
from types import SimpleNamespace
from typing import Any

import sympy
from force_diffusion.derivations import eq11_total_force as eq11
from force_diffusion.derivations import eq12_delta_weights as eq12
from force_diffusion.derivations import eq13_surface_diffusion as eq13
from force_diffusion.derivations import eq15_general_form as eq15
from force_diffusion.derivations.framework import decide
from force_diffusion.derivations.framework.loading import load
from force_diffusion.derivations.framework.proof import Steps
from force_diffusion.symbolic import symbols as sy
from force_diffusion.symbolic.algebra.exact import CONSTANTS, SITE, UNKNOWNS
from force_diffusion.symbolic.kernel import axioms, rules
from force_diffusion.symbolic.kernel.averages import power_law, tensile
from force_diffusion.symbolic.kernel.domain import (
    AT_FIXED_RATIO,
    Domain,
    Limit,
    Loading,
    at_fixed_height,
    at_large_height,
)
from force_diffusion.symbolic.kernel.limits import (
    asymptotic,
    bounded,
    negligible,
    of_what_is_kept,
)
from force_diffusion.symbolic.kernel.rules import Rule
from force_diffusion.symbolic.kernel.statistics import moment
from force_diffusion.symbolic.kernel.theorem import Theorem, made
from force_diffusion.symbolic.symbols import (
    H_M,
    Covariance,
    DeltaNMinus,
    DeltaNPlus,
    DeltaR,
    DeltaX,
    Dot,
    ForceMinus,
    ForcePlus,
    LargestShare,
    LoadForce,
    M,
    MatrixTimes,
    Mean,
    MeanOver,
    N,
    Position,
    Shift,
    Variance,
    VerticalMinus,
    VerticalPlus,
    e_x,
    e_y,
    epsilon,
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
    p,
    phi,
    q,
    r,
    sigma,
    site_r,
    site_s,
    spacing,
    t,
    z,
)
from force_diffusion.symbolic.trees import equation, in_place
from sympy import Derivative, Eq, Integer, Mul, Pow, Rational, Sum, Symbol, sqrt

REFUSALS = ValueError, TypeError
"""NotProvedError, NotExactError and NotAStatementError are ValueErrors."""

Attempt = Callable[[], object]


@dataclass(frozen=True)
class Attack:
    """Attributes:
    name: what is tried.
    false: tries it; what it returns is false.
    refused: words of the refusal.
    true: the same, of what is true.
    """

    name: str
    false: Attempt
    refused: str
    true: Attempt


ATTACKS: list[Attack] = []


def attack(name: str, false: Attempt, refused: str, true: Attempt) -> None:
    ATTACKS.append(Attack(name, false, refused, true))


def prove(rule: Rule, left: Any, right: Any, domain: Domain) -> Theorem:
    return rules.proved_by(rule, equation(*map(sympy.sympify, (left, right))), domain)


def both(
    name: str, rule: Rule, sides: tuple[Any, Any], wrong: tuple[Any, Any], refused: str, on: Domain
) -> None:
    """One rule on one domain, of a true and of a false statement."""
    attack(name, lambda: prove(rule, *wrong, on), refused, lambda: prove(rule, *sides, on))


BEADS, ABOVE = Domain.of(j >= 0), Domain.of(j >= 1)
TWO = Domain.of(j >= 0, l >= 0)
SURFACE = Domain.of(j >= 0, j <= M - 1, indices=(i,), loading=axioms.SURFACE)
LOADED = Domain.of(l >= 1, loading=axioms.LOADED)
HEIGHTS = Domain.of(indices=(M,))
HERE, BETWEEN = DeltaR(i, j), DeltaR(i - 1, j - 1)
FORCE, TOP = ForcePlus(i, j), ForcePlus(k, l)
ON_LOADED = axioms.loads(axioms.LOADED)
POSITIONS, DISPLACED, BASE = load(1).theorem, load(3).theorem, axioms.base()
DIRECTIONS = load(4).theorem, load(5).theorem
FORCES = eq11.in_radii()
A, B = Symbol("a", positive=True), Symbol("b", positive=True)


def limit(relation: str, orders: int = 1) -> Domain:
    return HEIGHTS.in_the_limit(at_large_height(relation, orders))


def over(divisor: sympy.Expr) -> sympy.Expr:
    return Pow(divisor, -1, evaluate=False)


def over_itself(divisor: sympy.Expr) -> sympy.Expr:
    return Mul(divisor, over(divisor), evaluate=False)


# theorems are made by the kernel alone

attack(
    "a theorem by its class",
    lambda: Theorem(equation(r, Integer(0)), BEADS, "mine"),
    "only rules of the kernel",
    lambda: prove(rules.rewrite(), r, r, BEADS),
)
attack(
    "another formula of a theorem",
    lambda: replace(BASE, formula=equation(r, Integer(0))),
    "only rules of the kernel",
    lambda: prove(rules.follows(BASE), 2 * DeltaX(i, j), 0, BASE.domain),
)
for name, copied in (
    ("copied", copy.copy),
    ("copied deeply", copy.deepcopy),
    ("pickled", lambda one: pickle.loads(pickle.dumps(one))),
):
    attack(
        f"a theorem {name}",
        lambda c=copied: c(BASE),  # type: ignore[misc]
        "neither copied nor pickled",
        lambda c=copied: c((1, 2)),  # type: ignore[misc]
    )


class Forged(Theorem):
    """A theorem that anybody makes."""

    def __post_init__(self, made_by: object) -> None:
        pass


MOVED = load(3).theorem
FORGED = Forged(equation(DeltaX(i, j), 2 * MOVED.formula.rhs), MOVED.domain, "mine")
SAME = SimpleNamespace(formula=equation(r, Integer(0)), domain=BEADS, supposed=(), assuming=())
for name, attempt in (
    ("put in", lambda one: prove(rules.rewrite(one), *one.formula.args, one.domain)),
    ("followed", lambda one: prove(rules.follows(one), *one.formula.args, one.domain)),
    ("mirrored", rules.mirror),
    ("put elsewhere", lambda one: rules.instance(one, {i: i + 2}, one.domain)),
    ("taken along a vector", lambda one: rules.along(one, n_plus)),
    (
        "solved",
        lambda one: prove(rules.solve([one], [DeltaX(i, j)]), *one.formula.args, one.domain),
    ),
):
    attack(
        f"a forged theorem, {name}",
        lambda a=attempt: a(FORGED),  # type: ignore[misc]
        "theorems only",
        lambda a=attempt, b=MOVED: a(b),  # type: ignore[misc]
    )
attack(
    "a forged theorem as it is",
    lambda: rules.proved_by(rules.same(FORGED), FORGED.formula, FORGED.domain),
    "the rule made no theorem",
    lambda: rules.proved_by(rules.same(BASE), BASE.formula, BASE.domain),
)
attack(
    "something like a theorem",
    lambda: rules.proved_by(lambda *_: SAME, SAME.formula, BEADS),  # type: ignore[arg-type,return-value]
    "the rule made no theorem",
    lambda: rules.proved_by(lambda *_: BASE, BASE.formula, BASE.domain),
)
attack(
    "a theorem that is another statement",
    lambda: rules.proved_by(lambda *_: BASE, equation(r, Integer(0)), BASE.domain),
    "another statement",
    lambda: rules.proved_by(lambda *_: BASE, BASE.formula, BASE.domain),
)
attack(
    "a premise that is none",
    lambda: made(equation(r, r), BEADS, "mine", (FORGED,)),
    "theorems only",
    lambda: made(equation(r, r), BEADS, "mine", (BASE,)),
)

# domains, loads and limits

attack(
    "dimension 4",
    lambda: Domain.of(j >= 0, dimension=4),
    "2 and 3",
    lambda: Domain.of(j >= 0, dimension=3),
)
attack(
    "dimension 1 by replacement",
    lambda: replace(BEADS, dimension=1),
    "2 and 3",
    lambda: replace(BEADS, dimension=3),
)
attack(
    "a domain of sites",
    lambda: Domain.of(j >= 0, i >= 0, Eq(SITE[0], -9, evaluate=False)),
    "paper's indices",
    lambda: Domain.of(j >= 0, i >= 0, Eq(i, j)),
)
attack(
    "relations of what a domain does not name",
    lambda: Domain((i,), (j >= 0,)),
    "all of which it names",
    lambda: Domain((i, j), (j >= 0,), beads=((i, j),)),
)
attack(
    "a place where no bead is",
    lambda: prove(rules.rewrite(), HERE, 0, BEADS.also(Eq(i + j, 1))),
    "its domain is empty",
    lambda: prove(rules.rewrite(), HERE, HERE, BEADS.also(Eq(i + j, 2))),
)
attack(
    "beads at two places that can't be",
    lambda: Domain.of(j >= 0, beads=[(i, j), (i + 1, j)]).points,
    "not shown to be even",
    lambda: Domain.of(j >= 0, beads=[(i, j), (i + 2, j)]).points,
)
attack(
    "a limit of no order",
    lambda: Limit("∼", "", (M,), (M,), 0),
    "at least one order",
    lambda: Limit("∼", "", (M,), (M,), 2),
)
attack(
    "a limit in which indices grow in no ratio",
    lambda: Limit("∼", "", (M, j), (M, M - j)),
    "each sum is what grows",
    lambda: Limit("∼", "", (M, j), (M - j, j)),
)
attack(
    "an unknown loading",
    lambda: axioms.loads(
        replace(axioms.SURFACE, everywhere=((equation(LoadForce(site_r, site_s), 0), ()),))
    ),
    "not a known loading",
    lambda: axioms.loads(axioms.SURFACE.put_in({M: M + 1})),
)
PLACELESS = Loading("mine", "", (), (), axioms.SURFACE.everywhere)
NONE_BELOW = axioms.loads(axioms.SURFACE)[0]
attack(
    "the same loads without their place",
    lambda: prove(
        rules.follows(NONE_BELOW),
        LoadForce(site_r, site_s),
        0,
        replace(NONE_BELOW.domain, loading=PLACELESS),
    ),
    "is not known there",
    lambda: prove(rules.follows(NONE_BELOW), LoadForce(site_r, site_s), 0, NONE_BELOW.domain),
)
attack(
    "a load at bead (r, s), which is any bead",
    lambda: axioms.SURFACE.put_in({M: site_s}),
    "stand for any bead",
    lambda: axioms.SURFACE.put_in({M: l}),
)

# what is a statement

both(
    "an index of no domain",
    rules.rewrite(),
    (j * r, r * j),
    (k * r, k * r),
    "does not say what k is",
    BEADS,
)
for reserved in (SITE[0], UNKNOWNS[0], CONSTANTS[0][0]):
    both(
        "a reserved name",
        rules.rewrite(),
        (r, r),
        (reserved, reserved),
        "name that the kernel reserves",
        BEADS,
    )
both(
    "a number and a vector",
    rules.rewrite(),
    (n_plus, n_plus),
    (n_plus, n_plus + 1),
    "added to a vector",
    BEADS,
)
both(
    "a vector that is a number",
    rules.rewrite(),
    (n_plus - n_plus, 0),
    (n_plus, 1),
    "equal to a vector",
    BEADS,
)
both(
    "no bead",
    rules.rewrite(),
    (HERE, HERE),
    (DeltaR(i + 1, j), DeltaR(i + 1, j)),
    "there may be no bead",
    BEADS,
)
both("below the base", rules.rewrite(), (HERE, HERE), (BETWEEN, BETWEEN), "below the base", BEADS)
for zero in (
    phi,
    4 * phi - 1,
    n_x - n_y,
    n_x**2 + n_y**2 - 1,
    1 - phi - 2 * n_x**2,
    j - 3,
    z - Rational(1, 2),
):
    both(
        "zero over zero",
        rules.rewrite(),
        (over_itself(2 + zero**2), 1),
        (over_itself(zero), 1),
        "may be zero",
        BEADS,
    )
both(
    "ε over itself",
    rules.rewrite(),
    (over_itself(1 + epsilon), 1),
    (over_itself(epsilon), 1),
    "may be zero",
    BEADS,
)
both(
    "a sum that ends early",
    rules.rewrite(),
    (Sum(1, (m, 1, j)), j),
    (Sum(1, (m, 3, j)), j - 2),
    "no agreed value",
    BEADS,
)
both(
    "a sum over an index of the domain",
    rules.rewrite(),
    (Sum(n, (n, 1, j)), j * (j + 1) / 2),
    (Sum(l, (l, 1, j)), j * (j + 1) / 2),
    "has another meaning",
    TWO,
)
both(
    "one index for two sums",
    rules.rewrite(),
    (Sum(n, (n, 1, m), (m, 1, j)), j * (j + 1) * (j + 2) / 6),
    (Sum(n, (n, 1, 2), (n, 1, j)), 3 * j),
    "has another meaning",
    BEADS,
)
both(
    "a sum without a closed form",
    rules.rewrite(),
    (Sum(over(m), (m, 1, M)), H_M),
    (Sum(over(m**2), (m, 1, M)), H_M),
    "more than one divisor",
    HEIGHTS,
)
both(
    "a square of a displacement and a first order",
    rules.rewrite(),
    (HERE**2, 0),
    (HERE, 0),
    "differs by 1",
    BEADS,
)
both(
    "two radii that may be one",
    rules.rewrite(),
    (HERE - DeltaR(k, l), HERE - DeltaR(k, l)),
    (HERE, DeltaR(k, l)),
    "differs by",
    TWO,
)
both(
    "s of another packing",
    rules.rewrite(),
    (spacing, 4 * r * n_x),
    (spacing, 4 * r * n_y),
    "differ by",
    BEADS,
)
both(
    "the other height z",
    rules.rewrite(),
    (z * M, j),
    (z * M, j + 1),
    "differ by",
    Domain.of(j >= 1, j <= M - 1),
)


class Alias(sy.SiteFunction):
    """A quantity with the name of another one."""


Alias.__name__ = "DeltaR"
both(
    "a quantity with a name of the paper's",
    moment(),
    (Variance(HERE), sigma**2),
    (Variance(Alias(i, j)), sigma**2),
    "not a quantity of a packing",
    BEADS,
)

# forces as divisors

both(
    "a force over itself, which is zero",
    rules.rewrite(ON_LOADED),
    (TOP, 0),
    (over_itself(TOP), 0),
    "may be zero",
    LOADED,
)
attack(
    "a force that is zero, squared and divided by",
    lambda: prove(
        rules.rewrite(prove(rules.rewrite(ON_LOADED), TOP**2 * DeltaR(k, l), 0, LOADED)),
        DeltaR(k, l),
        0,
        LOADED,
    ),
    "not shown to vanish nowhere",
    lambda: prove(
        rules.rewrite(prove(rules.rewrite(ON_LOADED), r**2 * TOP, 0, LOADED)), TOP, 0, LOADED
    ),
)
attack(
    "a factor that is zero at φ = 0",
    lambda: prove(
        rules.rewrite(prove(rules.rewrite(BASE), phi * DeltaX(i, j), 0, BASE.domain)),
        DeltaX(i, j),
        0,
        BASE.domain,
    ),
    "not shown to vanish nowhere",
    lambda: prove(
        rules.rewrite(prove(rules.rewrite(BASE), (2 + phi) * DeltaX(i, j), 0, BASE.domain)),
        DeltaX(i, j),
        0,
        BASE.domain,
    ),
)
STRAIGHT = load(9).theorem
ZERO_AT_ORDER_0 = prove(
    rules.rewrite(STRAIGHT), (1 - STRAIGHT.formula.lhs) * HERE, 0, STRAIGHT.domain
)
attack(
    "a determinant that is zero for one force",
    lambda: prove(rules.solve([ZERO_AT_ORDER_0], [HERE]), HERE, 0, STRAIGHT.domain),
    "the determinant holds a force",
    lambda: prove(rules.solve([DISPLACED], [DeltaX(i, j)]), *DISPLACED.formula.args, ABOVE),
)

# rewrite, follows, along, order, solve, below

both(
    "half of Eq. 3",
    rules.rewrite(DISPLACED),
    (DeltaX(i, j), DISPLACED.formula.rhs),
    (DeltaX(i, j), DISPLACED.formula.rhs / 2),
    "differs by",
    ABOVE,
)
both(
    "a factor that may be zero",
    rules.follows(DISPLACED),
    tuple((2 + phi) * one for one in DISPLACED.formula.args),
    tuple(phi * one for one in DISPLACED.formula.args),
    "may be zero",
    ABOVE,
)
both(
    "a factor that is zero in one layer",
    rules.follows(DISPLACED),
    tuple(j * one for one in DISPLACED.formula.args),
    tuple((j - 2) * one for one in DISPLACED.formula.args),
    "may be zero",
    ABOVE,
)
both(
    "nothing at all",
    rules.follows(DISPLACED),
    DISPLACED.formula.args[::-1],
    (DeltaX(i, j), DeltaX(i, j)),
    "not a multiple",
    ABOVE,
)
attack(
    "beyond its domain",
    lambda: prove(rules.follows(DISPLACED), *DISPLACED.formula.args, BEADS),
    "is not known there",
    lambda: prove(rules.follows(DISPLACED), *DISPLACED.formula.args, ABOVE.also(j >= 2)),
)
attack(
    "the same on another domain",
    lambda: rules.same(DISPLACED)(DISPLACED.formula, BEADS),
    "another statement",
    lambda: rules.same(DISPLACED)(DISPLACED.formula, ABOVE),
)
attack(
    "along what is not a vector",
    lambda: rules.along(BASE, n_plus / phi),
    "not a base vector",
    lambda: rules.along(BASE, e_x),
)
attack(
    "one component for another",
    lambda: prove(
        rules.follows(rules.along(DISPLACED, n_plus)),
        *rules.along(DISPLACED, n_minus).formula.args,
        ABOVE,
    ),
    "not a multiple",
    lambda: prove(
        rules.follows(rules.along(DISPLACED, n_plus)),
        *rules.along(DISPLACED, n_plus).formula.args,
        ABOVE,
    ),
)
CONTACT = axioms.contact(1)
LEANS = Dot(n_plus, DeltaX(i, j) - DeltaX(i - 1, j - 1))
both(
    "the order 1 in ε",
    rules.order(CONTACT, 1),
    (4 * r * LEANS, 4 * r * (HERE + BETWEEN)),
    (4 * r * LEANS, 2 * r * (HERE + BETWEEN)),
    "not the order 1",
    ABOVE,
)
both(
    "the order 0 in ε",
    rules.order(CONTACT, 0),
    (4 * r**2, 4 * r**2),
    (LEANS, HERE + BETWEEN),
    "not the order 0",
    ABOVE,
)
attack(
    "an order below zero",
    lambda: prove(rules.order(CONTACT, -1), LEANS, HERE, ABOVE),
    "no such power",
    lambda: prove(rules.order(CONTACT, 3), 0, 0, ABOVE),
)
both(
    "a solution of another system",
    load(2).step_of(0)[0].rules[0],
    load(2).printed[0].args,
    (DeltaX(i, j), 2 * load(2).printed[0].rhs),
    "is not the solution",
    ABOVE,
)
PLUS, MINUS, UP_ONLY = (rules.along(DISPLACED, one) for one in (n_plus, n_minus, e_y))
for name, rows, refused in (
    ("more unknowns than equations", [PLUS], "1 equations for 2"),
    ("one equation, twice", [PLUS, PLUS], "determinant may be zero"),
    ("equations of another bead", [BASE], "not known there"),
):
    attack(
        name,
        lambda a=rows: prove(rules.solve(a, [DeltaX(i, j)]), *DISPLACED.formula.args, ABOVE),  # type: ignore[misc]
        refused,
        lambda: prove(
            rules.solve([MINUS, UP_ONLY], [DeltaX(i, j)]), *DISPLACED.formula.args, ABOVE
        ),
    )
VERTICALLY = axioms.loads(axioms.LOADED_VERTICALLY)
SUPPORTED = Domain.of(l >= 1, loading=axioms.LOADED_VERTICALLY)
RIGHT = ForcePlus(k - 1, l - 1)
attack(
    "f⁺ = 5 f_load",
    lambda: prove(rules.below(VERTICALLY), RIGHT, 5 * f_load, SUPPORTED),
    "not the solution",
    lambda: load(7).proof[0].theorems,
)

# instance, mirror

ANY = Domain.of(indices=(i,), beads=())
PLACES = prove(rules.rewrite(), Sum(i, (n, 1, 2)), Sum(i, (n, 2, 3)), ANY)
CIRCLE = prove(rules.rewrite(), 1 - phi**2, 4 * n_x**2 * n_y**2, BEADS)
HEIGHT = prove(rules.rewrite(), Sum(1, (m, 1, M)), M, HEIGHTS)
HARMONIC = prove(rules.rewrite(), Sum(over(n), (n, 1, M)), H_M, HEIGHTS)
LAYER = Domain.of(indices=(l,), beads=())
for name, theorem, image, domain, refused, right_image, right in (
    (
        "an instance for φ",
        CIRCLE,
        {phi: Rational(1, 3)},
        BEADS,
        "not a whole number",
        {j: j + 1, i: i + 1},
        BEADS,
    ),
    (
        "an instance for r",
        CIRCLE,
        {r: Integer(0)},
        BEADS,
        "not a whole number",
        {i: i + 2},
        BEADS,
    ),
    ("half an index", HEIGHT, {M: M / 2}, HEIGHTS, "not a whole number", {M: 2 * M}, HEIGHTS),
    (
        "an index that is summed over",
        PLACES,
        {i: n},
        replace(ANY, indices=(n,)),
        "two meanings",
        {i: i + 2},
        ANY,
    ),
    ("beyond its domain", DISPLACED, {j: j - 2}, ABOVE, "not known there", {j: j + 2}, ABOVE),
    ("off the lattice", DISPLACED, {i: i + 1}, ABOVE, "not known there", {i: i + 2}, ABOVE),
    (
        "a height that may be negative",
        HEIGHT,
        {M: l},
        LAYER,
        "not known there",
        {M: l},
        replace(LAYER, relations=(l >= 1,)),
    ),
    ("another height of H_M", HARMONIC, {M: M + 1}, HEIGHTS, "that of the height M", {}, HEIGHTS),
    ("in three dimensions", CIRCLE, {}, replace(BEADS, dimension=3), "not known there", {}, BEADS),
    ("in a limit", HEIGHT, {}, limit("∼"), "not known there", {}, HEIGHTS),
    (
        "under another load",
        NONE_BELOW,
        {},
        NONE_BELOW.domain.loaded(axioms.BULK),
        "not known there",
        {},
        NONE_BELOW.domain,
    ),
    (
        "without its load",
        NONE_BELOW,
        {},
        NONE_BELOW.domain.loaded(None),
        "not known there",
        {},
        NONE_BELOW.domain,
    ),
):
    attack(
        name,
        lambda a=theorem, b=image, c=domain: rules.instance(a, b, c),  # type: ignore[misc]
        refused,
        lambda a=theorem, b=right_image, c=right: rules.instance(a, b, c),  # type: ignore[misc]
    )


def vertical(kind: Any, turn: Any, force: Any) -> tuple[sympy.Expr, sympy.Expr]:
    return kind(i, j), force(i, j) * (n_y + Dot(e_y, turn(i, j)))


TILTED = prove(rules.rewrite(), *vertical(VerticalPlus, DeltaNPlus, ForcePlus), BEADS)
both(
    "the mirror image of a vertical component",
    rules.mirror_of(TILTED),
    vertical(VerticalMinus, DeltaNMinus, ForceMinus),
    vertical(VerticalPlus, DeltaNMinus, ForceMinus),
    "not a multiple",
    BEADS,
)
both(
    "its own mirror image",
    rules.mirror_of(DIRECTIONS[0]),
    DIRECTIONS[1].formula.args,
    (DeltaNMinus(i, j), DIRECTIONS[0].formula.rhs),
    "not a multiple",
    BEADS,
)
attack(
    "the mirror image of a place",
    lambda: rules.mirror(prove(rules.rewrite(), i * HERE, HERE * i, BEADS)),
    "a horizontal index",
    lambda: rules.mirror(prove(rules.rewrite(), j * HERE, HERE * j, BEADS)),
)
attack(
    "the mirror image of a matrix",
    lambda: rules.mirror(prove(rules.rewrite(), MatrixTimes(0, 0, 1, 0, n_plus), n_x * e_y, BEADS)),
    "a horizontal index",
    lambda: rules.mirror(prove(rules.rewrite(), n_plus + n_minus, 2 * n_y * e_y, BEADS)),
)

# induction and reach

STAYS, COUNT = rules.rewrite(BASE), Domain.of(q >= 0)


def grows(size: sympy.Expr) -> tuple[sympy.Expr, sympy.Expr]:
    """That the origin, which stays where it is, has moved."""
    return DeltaX(0, 0), size * e_y


def by_instance(image: dict[sympy.Symbol, sympy.Expr]) -> Callable[[tuple[Theorem, ...]], Rule]:
    def step(supposed: tuple[Theorem, ...]) -> Rule:
        return lambda formula, domain: rules.follows(
            rules.instance(supposed[0], image, domain) if image else supposed[0]
        )(formula, domain)

    return step


def never(_: tuple[Theorem, ...]) -> Rule:
    return STAYS


def anew(supposed: tuple[Theorem, ...]) -> Rule:
    """Another statement, of the value considered, under the supposition of the first."""
    (supposition,) = supposed[0].supposed
    return rules.rewrite(rules.suppose(equation(*grows(q)), COUNT, supposition))


def rests_on(supposed: tuple[Theorem, ...]) -> Rule:
    return rules.rewrite(*supposed)


SUPPOSED: list[Theorem] = []


def leak(supposed: tuple[Theorem, ...]) -> Rule:
    SUPPOSED.extend(supposed)
    return STAYS


def leaked(formula: sympy.Eq, domain: Domain) -> Theorem:
    prove(rules.induct(q, 0, STAYS, leak), *grows(Integer(0)), COUNT)
    return rules.rewrite(BASE, SUPPOSED[0])(formula, domain)


GO = rules.induct(q, 0, STAYS, never)
for name, size, wrong, refused in (
    ("no step", q, rules.induct(q, 0, STAYS, never), "differ"),
    ("no base", q + 1, rules.induct(q, 0, STAYS, by_instance({})), "differ"),
    (
        "what is supposed, of the next value",
        Sum(1, (n, 1, q)),
        rules.induct(q, 0, STAYS, by_instance({q: q + 1})),
        "not known there",
    ),
    (
        "what is supposed, by itself",
        q,
        rules.induct(q, 0, STAYS, by_instance({})),
        "not a multiple",
    ),
    (
        "a start that is not the domain's",
        q * (q - 1),
        rules.induct(q, 1, STAYS, by_instance({})),
        "goes beyond",
    ),
    (
        "downwards from nowhere",
        q,
        rules.induct(q, 0, STAYS, by_instance({}), down=True),
        "goes beyond",
    ),
    (
        "another supposition",
        q * (q + 1),
        rules.induct(q, 0, STAYS, anew),
        "not what the induction is about",
    ),
    (
        "a base that rests on what is supposed",
        Integer(0),
        rules.induct(q, 0, leaked, never),
        "nothing supposed",
    ),
    (
        "a step that proves another statement",
        q,
        rules.induct(q, 0, STAYS, lambda _: lambda *_: BASE),
        "another statement",
    ),
    ("an index of no domain", Integer(0), rules.induct(p, 0, STAYS, never), "goes beyond"),
    (
        "one within another",
        Integer(0),
        rules.induct(q, 0, STAYS, lambda supposed: leaked),
        "be nested",
    ),
):
    attack(
        f"induction, {name}",
        lambda a=wrong, b=size: prove(a, *grows(b), COUNT),  # type: ignore[misc]
        refused,
        lambda: prove(GO, *grows(Integer(0)), COUNT),
    )
attack(
    "what is only supposed is no proof",
    lambda: _decided(lambda *_: SUPPOSED[0], SUPPOSED[0]),
    "only supposed",
    lambda: _decided(rules.same(BASE), BASE),
)


def _decided(rule: Rule, theorem: Theorem) -> None:
    ruling = decide.decide(theorem.formula, theorem.domain, [rule])
    if not ruling.verdict.is_proved:
        raise ValueError(ruling.note)


ORIGIN, *UP = axioms.ordered()
CIRCULAR = [
    prove(
        rules.rewrite(POSITIONS),
        Position(i + s, j + 1) - Position(i, j),
        Position(i + s + 2, j + 1) - Position(i + 2, j),
        BEADS,
    )
    for s in (1, -1)
]
for name, up, sides, refused, domain in (
    ("r = 0", UP, (Position(i, j), Position(i, j) * 0), "differ by", BEADS),
    ("twice as far", UP, (Position(i, j), 2 * POSITIONS.formula.rhs), "differ by", BEADS),
    ("steps that say nothing", CIRCULAR, (Position(i, j), 0), "other beads", BEADS),
    ("one step for both", [UP[0], UP[0]], POSITIONS.formula.args, "every bead", BEADS),
    (
        "another place",
        UP,
        (Position(i + 2, j), POSITIONS.formula.rhs),
        "not a quantity of bead",
        BEADS,
    ),
    (
        "in three dimensions",
        UP,
        POSITIONS.formula.args,
        "not that of beads",
        Domain.of(j >= 0, dimension=3),
    ),
    ("below the base", UP, POSITIONS.formula.args, "not that of beads", Domain.of(j >= -1)),
):
    attack(
        f"reach, {name}",
        lambda a=up, b=sides, c=domain: prove(rules.reach(ORIGIN, a), *b, c),  # type: ignore[misc]
        refused,
        lambda: prove(rules.reach(ORIGIN, UP), *POSITIONS.formula.args, BEADS),
    )

# derivatives

V = Symbol("v")
for left, right in (
    (Derivative(n_x, phi), 0),
    (Derivative(phi, n_y), 0),
    (Derivative(sy.L_minus, t), 0),
    (Derivative(sy.L_plus * t, sy.L_minus), 0),
    (Derivative(V * n_x, V, phi), 0),
    (Derivative(V * z, z), V),
    (Derivative(z * j, j), z),
):
    attack(
        f"the derivative of {left.args[0]}",
        lambda a=left, b=right: prove(rules.differentiate, a, b, Domain()),  # type: ignore[misc]
        "may depend on the variable",
        lambda: prove(rules.differentiate, Derivative(z**2 * phi, z), 2 * z * phi, Domain()),
    )
both(
    "another derivative",
    rules.differentiate,
    (Derivative(V**2, V), 2 * V),
    (Derivative(V**2, V), V),
    "differ by",
    Domain(),
)
both(
    "a derivative of 0/0",
    rules.differentiate,
    (Derivative(z, z), 1),
    (Derivative(Mul(over_itself(phi), z, evaluate=False), z), 1),
    "may be zero",
    Domain(),
)

# moments

both(
    "⟨f²⟩ = ⟨f⟩²",
    moment(*FORCES),
    (Mean(FORCE) ** 2, (f_load / (2 * n_y)) ** 2),
    (Mean(FORCE**2), Mean(FORCE) ** 2),
    "is not linear",
    SURFACE,
)
both(
    "no covariance anywhere",
    moment(),
    (Covariance(HERE, DeltaR(i + 2, j)), 0),
    (Covariance(HERE, DeltaR(k, l)), 0),
    "differ by",
    TWO,
)
both(
    "two radii that may be one",
    moment(),
    (Variance(HERE + DeltaR(i + 2, j)), 2 * sigma**2),
    (Variance(HERE + DeltaR(k, l)), 2 * sigma**2),
    "differ by",
    TWO,
)
both(
    "a matrix for a product",
    moment((DISPLACED, BASE)),
    (Mean(Dot(n_plus, MatrixTimes(1, 0, 0, 1, DeltaX(i, j)))), 0),
    (Mean(Dot(n_plus, MatrixTimes(HERE, 0, 0, 0, DeltaX(i, j)))), 0),
    "is not linear",
    ABOVE,
)
both(
    "a force that is not known",
    moment(),
    (Variance(HERE), sigma**2),
    (Variance(FORCE), 0),
    "not determined by the radii",
    SURFACE,
)
both(
    "a moment of a vector",
    moment(),
    (Mean(Dot(e_y, n_plus)), n_y),
    (Mean(n_plus), 0),
    "is a vector",
    BEADS,
)
both(
    "no variance",
    moment(*FORCES),
    (Covariance(FORCE, FORCE), Variance(FORCE)),
    (Variance(FORCE), 0),
    "differ by",
    SURFACE,
)
OF_MEAN = (N - 1) * (2 * N - 1) * sigma**2 / (6 * N)
attack(
    "a mean that captures n",
    lambda: prove(
        moment(), Variance(MeanOver(n * HERE, N, i)), OF_MEAN, Domain.of(j >= 0, n >= 1, N >= 2)
    ),
    "with the index n",
    lambda: prove(
        moment(),
        Variance(MeanOver(l * HERE, N, i)),
        l**2 * sigma**2 / N,
        Domain.of(j >= 0, l >= 1, N >= 2),
    ),
)
both(
    "a mean of unknown forces",
    rules.rewrite(),
    (MeanOver(HERE, 1, i), HERE),
    (MeanOver(FORCE, 2, i), FORCE),
    "not known",
    BEADS,
)
both(
    "a mean over −3 neighbours",
    moment(),
    (Mean(MeanOver(1 + HERE, 3, i)), 1),
    (Mean(MeanOver(1 + HERE, -3, i)), 0),
    "neighbours has no value",
    BEADS,
)
both(
    "a mean over an angle",
    moment(),
    (Mean(MeanOver(1 + HERE, 3, i)), 1),
    (Mean(MeanOver(1 + HERE, 3, phi)), 1),
    "neighbours has no value",
    BEADS,
)
attack(
    "a larger domain of another dimension",
    lambda: prove(moment(on=replace(BEADS, dimension=3)), Variance(HERE), sigma**2, BEADS),
    "is another one",
    lambda: prove(moment(on=BEADS), Variance(HERE), sigma**2, ABOVE),
)
attack(
    "a larger domain that is smaller",
    lambda: prove(moment(on=ABOVE), Variance(HERE), sigma**2, BEADS),
    "no part of the larger one",
    lambda: prove(moment(on=BEADS), Variance(HERE), sigma**2, ABOVE),
)
LENGTH = Dot(DeltaX(i, j), DeltaX(i, j))
both(
    "the square of an unknown displacement",
    moment(),
    (Shift(HERE**2), sigma**2),
    (Shift(LENGTH), 0),
    "not determined by the radii",
    ABOVE,
)
GEOMETRY = DIRECTIONS, (DISPLACED, BASE)


def part_of(group: tuple[Theorem, ...], *relations: sympy.Basic) -> tuple[Theorem, ...]:
    return tuple(rules.instance(one, {}, one.domain.also(*relations)) for one in group)


SHIFTED = (
    Shift(FORCE),
    f_load
    * sigma**2
    * (4 * j - 4 * M * phi + phi**2 + phi)
    / (4 * n_y * r**2 * (1 - phi**2) * (1 + phi)),
)
attack(
    "the second order of a packing that ends early",
    lambda: prove(
        moment(part_of(FORCES[0], j <= M - 3), *FORCES[1:]), *SHIFTED, INNER.also(j <= M - 3)
    ),
    "for every bead",
    lambda: prove(moment((*FORCES[0], *part_of(FORCES[0], j >= 3)), *FORCES[1:]), *SHIFTED, INNER),
)
INNER = SURFACE.also(j >= 2, j <= M - 2)

# leading orders

for name, false, refused in (
    ("twice as much", 2 * M, "left over right"),
    ("another power", M**2, "left less right"),
    ("a divisor that mixes", M * (1 + over(1 + M**2 * phi**2)), "mixes what grows"),
    ("a divisor that mixes, at odds", M * (1 + M * over(1 + M**2 * phi**2)), "mixes what grows"),
    ("a small power", M * (1 + M ** Rational(-1, 1000)), "not a rational function"),
    ("H_M in a divisor", M + M**3 * over(M**2 + H_M**3), "goes to 2"),
    ("H_M M", M + H_M * M, "left over right"),
    ("what may vanish", phi * M + 1, "left over right"),
    ("another index", M + i, "does not say what i is"),
    ("a constant of one's own", M + A, "not a rational function"),
):
    attack(
        f"∼, {name}",
        lambda a=false: prove(asymptotic(), a, M, limit("∼")),  # type: ignore[misc]
        refused,
        lambda: prove(asymptotic(), M + H_M**3 / M**2 + phi, M, limit("∼")),
    )
both(
    "what vanishes at φ = 0",
    asymptotic(),
    ((1 + phi**2) * n_x * M + 1, (1 + phi**2) * M * (n_x + (1 - phi) / 2) / (n_x + 1)),
    (phi * M + 1, phi * M),
    "may vanish",
    limit("∼"),
)
both(
    "the second order",
    asymptotic(),
    (M**2 + M + 1, M**2 + M),
    (M**2 + M + 1, M**2 + 2 * M),
    "left less right",
    limit("∼", 2),
)
both(
    "a leading order at finite size",
    rules.rewrite(),
    (M + 1, 1 + M),
    (M + 1, M),
    "differ by",
    HEIGHTS,
)
attack(
    "a limit beside its domain",
    lambda: prove(
        asymptotic(),
        M + j,
        M,
        Domain.of(j >= 0, j <= 9, indices=(M,)).in_the_limit(at_fixed_height("∼")),
    ),
    "does not hold all of",
    lambda: prove(
        asymptotic(), M + 1, M, Domain.of(j >= 0, j <= M).in_the_limit(at_fixed_height("∼"))
    ),
)
attack(
    "a limit that says nothing of j",
    lambda: prove(
        asymptotic(),
        M + j,
        M,
        Domain.of(j >= 0, indices=(M,), beads=()).in_the_limit(at_large_height("∼")),
    ),
    "neither grows nor is fixed",
    lambda: prove(asymptotic(), M + 1, M, limit("∼")),
)
DROPPING = eq12.DERIVATION.domain
LEFT, RIGHT_SIDE = eq12.PRINTED.args
for name, extra, refused in (
    ("half of it", -RIGHT_SIDE / 2, "is dropped"),
    ("a large radius", M**2 * HERE, "is dropped"),
    ("a place across", i * HERE, "place across the packing matters"),
    ("another mean", sympy.S.One, "means of both sides differ"),
    ("two forces", ForcePlus(i + 2, j), "not about one contact force"),
):
    attack(
        f"≈, {name}",
        lambda a=extra: prove(negligible(*FORCES), LEFT, RIGHT_SIDE + a, DROPPING),  # type: ignore[misc]
        refused,
        lambda: prove(negligible(*FORCES), LEFT, RIGHT_SIDE + H_M * M * HERE, DROPPING),
    )
both(
    "nothing about a force",
    negligible(*FORCES),
    (LEFT, RIGHT_SIDE),
    (LEFT - LEFT + FORCE, FORCE),
    "not shown to vary",
    DROPPING,
)
KEPT = of_what_is_kept(
    eq12.DERIVATION.theorem,
    *(one.theorem for one in (eq13.DERIVATION.proof[0], eq13.DERIVATION.proof[2])),
)
AT_Z = eq13.IN_THE_LIMIT
UNIT = (sigma / r) ** 2 / (1 - phi**2) ** 2
WHOLE = Variance(LEFT + 1)
both(
    "another variance than that of what is kept",
    KEPT,
    (Variance(LEFT), eq13.PRINTED.rhs),
    (Variance(LEFT), 2 * eq13.PRINTED.rhs),
    "left over right",
    AT_Z,
)
both(
    "the variance of another quantity",
    KEPT,
    (WHOLE, eq13.PRINTED.rhs),
    (Variance(2 * LEFT), eq13.PRINTED.rhs),
    "something was dropped from",
    AT_Z,
)
AT_ORDER = SURFACE.also(j >= 2, j <= M - 2).in_the_limit(at_fixed_height("O"))
for name, wrong, refused in (
    ("that is too small", (LargestShare(FORCE), 1 / M**2 + H_M**3 / M**3), "has more"),
    ("of no radius", (LargestShare(sympy.S.One), 1 / M), "not shown to vanish"),
):
    true = (LargestShare(FORCE), 1 / M)
    both(f"a share {name}", bounded(*FORCES), true, wrong, refused, AT_ORDER)
ROW = sympy.Sum(DeltaR(i + 2 * m, j), (m, 1, M))
both(
    "the share of a radius that grows with H_M",
    bounded(),
    (LargestShare(ROW + HERE), 1 / M),
    (LargestShare(ROW + H_M * HERE), 1 / M),
    "has more",
    BEADS.also(indices=(M,)).in_the_limit(Limit("O", "M → ∞", (M,), (M,))),
)

# Eq. 15

CUBE, SQUARE = M**3 * sigma**2 / r**2, eq15.mean("surface", Variance)
AVERAGED = eq15.heights("surface").in_the_limit(at_large_height("="))
LAW = power_law(*eq15.IN_RADII["surface"]())
ROOT = sqrt(SQUARE), M ** Rational(3, 2) * sigma / r / (1 - phi**2)
for name, factor, refused in (
    ("that mixes M and φ", 1 + M * over(1 + M**2 * phi**2), "mixes what grows"),
    ("that may be zero", 1 - 4 * phi, "not shown to be positive"),
    ("of another size", Integer(2), "goes to"),
    ("that is negative", Integer(-1), "not shown to be positive"),
    ("of another power", M ** Rational(-1, 12), "goes to"),
    ("of nearly no other power", M ** Rational(-1, 1000), "more than 20000 terms"),
    ("with a power that is not a number", 2**phi, "is not a number"),
):
    attack(
        f"Eq. 15 times a factor {name}",
        lambda a=factor: prove(LAW, ROOT[0], Mul(ROOT[1], a, evaluate=False), AVERAGED),  # type: ignore[misc]
        refused,
        lambda: prove(LAW, *ROOT, AVERAGED),
    )
attack(
    "a power law as σ decreases",
    lambda: prove(power_law(), CUBE + M**2, CUBE, HEIGHTS.in_the_limit(AT_FIXED_RATIO)),
    "only what is fixed",
    lambda: prove(power_law(), M * (r + n_x) ** 2, M * (r * (r + 2 * n_x) + n_x**2), limit("=")),
)
for size in (1 / M, H_M, M * H_M):
    attack(
        "a height for what does not grow as a power",
        lambda a=size: prove(power_law(), sy.UnitHeight(sigma * a / r), r / sigma, limit("=")),  # type: ignore[misc]
        "not one height",
        lambda: prove(power_law(), sy.UnitHeight(sigma * M / r), r / sigma, limit("=")),
    )
FRACTION = (
    eq15.mean("surface", sy.Tensile),
    in_place(eq15.tensile_fraction("surface"), {eq15.HEIGHT: sy.UnitHeight(SQUARE)}),
)
ONES = prove(moment(*FORCES), Mean(eq15.FORCE["surface"]), 1, eq11.LAYERS.loaded(axioms.SURFACE))
ONE_LAYER = rules.moved(ONES, {}, ONES.domain.also(Eq(j, 3)))
OF_LAYER = eq13.DERIVATION.theorem
PACKING = eq15.heights("surface").in_the_limit(AT_FIXED_RATIO)
for name, premises, sides, refused in (
    ("with the mean of one layer", (OF_LAYER, ONE_LAYER), FRACTION, "does not hold all of"),
    ("with another mean", (OF_LAYER, OF_LAYER), FRACTION, "mean of one force"),
    (
        "of half the layers",
        (OF_LAYER, ONES),
        (FRACTION[0] / 2, FRACTION[1]),
        "mean over all layers",
    ),
    ("twice", (OF_LAYER, ONES), (FRACTION[0], 2 * FRACTION[1]), "not ∫ ½ erfc"),
):
    attack(
        f"the tensile fraction {name}",
        lambda a=premises, b=sides: prove(tensile(*a, *eq15.IN_RADII["surface"]()), *b, PACKING),  # type: ignore[misc]
        refused,
        lambda: prove(tensile(OF_LAYER, ONES, *eq15.IN_RADII["surface"]()), *FRACTION, PACKING),
    )

# definitions of a step


def shown(definitions: dict[Any, Any], left: Any, right: Any) -> object:
    return Steps(99, BEADS).show(
        "", equation(left, right), rules.rewrite(), definitions=definitions
    )


for name, what, image, left, right in (
    ("a radius", sy.DeltaR, lambda *_: Integer(0), HERE, Integer(0)),
    ("a radius of one bead", HERE, Integer(0), HERE, Integer(0)),
    ("a mean", sy.Mean, lambda _: Integer(0), Mean(HERE + 1), Integer(0)),
    ("a number", Integer(2), Integer(3), Integer(2), Integer(3)),
    ("r", r, Integer(0), r, Integer(0)),
    ("another r", Symbol("r"), r - r, Symbol("r"), Integer(0)),
    ("H_M", H_M, Integer(0), H_M, Integer(0)),
):
    attack(
        f"a definition of {name}",
        lambda a=what, b=image, c=left, d=right: shown({a: b}, c, d),  # type: ignore[misc]
        "has a meaning of its own",
        lambda: shown({V: 2 * r}, V, 2 * r),
    )
