"""Attempts to prove what is false, through every public name of the kernel.

Each attempt is refused in the right words. Beside it stands what is true, and is proved. Importing
this proves equations: tests do so when they run.
"""

import copy
import pickle
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from types import SimpleNamespace
from typing import Any

import sympy
from force_diffusion.derivations import eq07_load_split as eq07
from force_diffusion.derivations import eq09_straight_path as eq09
from force_diffusion.derivations import eq10_branched_path as eq10
from force_diffusion.derivations import eq11_total_force as eq11
from force_diffusion.derivations import eq12_delta_weights as eq12
from force_diffusion.derivations import eq13_surface_diffusion as eq13
from force_diffusion.derivations import eq15_general_form as eq15
from force_diffusion.derivations import eq16_response as eq16
from force_diffusion.derivations.framework import decide
from force_diffusion.derivations.framework.proof import Steps
from force_diffusion.derivations.framework.record import load
from force_diffusion.symbolic import symbols as sy
from force_diffusion.symbolic.algebra.exact import CONSTANTS, SITE, UNKNOWNS
from force_diffusion.symbolic.kernel import axioms, limits, rules
from force_diffusion.symbolic.kernel.averages import power_law, tensile
from force_diffusion.symbolic.kernel.domain import (
    AT_FIXED_RATIO,
    Domain,
    Limit,
    Loading,
    at_fixed_height,
    at_large_height,
)
from force_diffusion.symbolic.kernel.rules import Rule
from force_diffusion.symbolic.kernel.statistics import SPHERES, moment
from force_diffusion.symbolic.kernel.theorem import Theorem, made
from force_diffusion.symbolic.symbols import H_M, M, N, i, j, k, l, m, n, n_x, n_y, phi, r, sigma, z
from force_diffusion.symbolic.trees import equation, in_place
from sympy import Derivative, Eq, Integer, Mul, Pow, Rational, Sum, Symbol, sqrt

REFUSALS = ValueError, TypeError
"""NotProvedError, NotExactError and NotAStatementError are ValueErrors."""

Attempt = Callable[[], object]
Sides = tuple[Any, Any]


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


def proof(rule: Rule, sides: Sides, domain: Domain) -> Attempt:
    return partial(prove, rule, *sides, domain)


def table(rule: Rule, domain: Domain, *rows: tuple[str, Sides, str, Sides]) -> None:
    """Of one rule on one domain: what is tried, what is false, the refusal, and what is true."""
    for name, wrong, refused, sides in rows:
        attack(name, proof(rule, wrong, domain), refused, proof(rule, sides, domain))


def beside(about: str, true: Attempt, *rows: tuple[str, Attempt, str]) -> None:
    """What is tried beside one thing that is true, and the refusals."""
    for name, false, refused in rows:
        attack(f"{about}, {name}", false, refused, true)


REWRITE = rules.rewrite()
BEADS, ABOVE = Domain.of(j >= 0), Domain.of(j >= 1)
IN_SPACE = replace(BEADS, dimension=3)
TWO = Domain.of(j >= 0, l >= 0)
SURFACE = Domain.of(j >= 0, j <= M - 1, indices=(i,), loading=axioms.SURFACE)
LOADED = Domain.of(l >= 1, loading=axioms.LOADED)
HEIGHTS = Domain.of(indices=(M,))
HERE, BETWEEN, THERE = sy.DeltaR(i, j), sy.DeltaR(i - 1, j - 1), sy.DeltaR(k, l)
MOVE, PLACE = sy.DeltaX(i, j), sy.Position(i, j)
FORCE, TOP = sy.ForcePlus(i, j), sy.ForcePlus(k, l)
ON_LOADED = axioms.loads(axioms.LOADED)
POSITIONS, DISPLACED, BASE = load(1).theorem, load(3).theorem, axioms.base()
MOVED = DISPLACED.formula.args
DIRECTIONS = load(4).theorem, load(5).theorem
FORCES = eq11.in_radii()
ZERO = Integer(0)
NOTHING = equation(r, ZERO)
V = Symbol("v")


def limit(relation: str, orders: int = 1) -> Domain:
    return HEIGHTS.in_the_limit(at_large_height(relation, orders))


def over(divisor: sympy.Expr) -> sympy.Expr:
    return Pow(divisor, -1, evaluate=False)


def over_itself(divisor: sympy.Expr) -> sympy.Expr:
    return Mul(divisor, over(divisor), evaluate=False)


def times(factor: Any, theorem: Theorem) -> Sides:
    left, right = theorem.formula.args
    return factor * left, factor * right


def rule_returning(theorem: Theorem) -> Attempt:
    """A rule that returns this theorem, whatever is to be proved."""
    return partial(rules.proved_by, lambda *_: theorem)


# What is tried stands above its refusal and what is true.
# fmt: off

# theorems are made by the kernel alone

attack("a theorem by its class", lambda: Theorem(NOTHING, BEADS, "mine"),
       "only rules of the kernel", proof(REWRITE, (r, r), BEADS))
attack("another formula of a theorem", lambda: replace(BASE, formula=NOTHING),
       "only rules of the kernel", proof(rules.follows(BASE), (2 * MOVE, 0), BASE.domain))
for way in (copy.copy, copy.deepcopy, lambda thm: pickle.loads(pickle.dumps(thm))):
    attack("a theorem, copied", partial(way, BASE),
           "neither copied nor pickled", partial(way, (1, 2)))


class Forged(Theorem):
    """A theorem that anybody makes."""

    def __post_init__(self, made_by: object) -> None:
        pass


FORGED = Forged(equation(MOVE, 2 * MOVED[1]), DISPLACED.domain, "mine")
SAME = SimpleNamespace(formula=NOTHING, domain=BEADS, supposed=(), assuming=())
for name, attempt in (
    ("put in", lambda thm: prove(rules.rewrite(thm), *thm.formula.args, thm.domain)),
    ("followed", lambda thm: prove(rules.follows(thm), *thm.formula.args, thm.domain)),
    ("mirrored", rules.mirror),
    ("put elsewhere", lambda thm: rules.instance(thm, {i: i + 2}, thm.domain)),
    ("taken along a vector", lambda thm: rules.along(thm, sy.n_plus)),
    ("solved", lambda thm: prove(rules.solve([thm], [MOVE]), *thm.formula.args, thm.domain)),
    ("a premise", lambda thm: made(equation(r, r), BEADS, "mine", (thm,))),
):
    attack(f"a forged theorem, {name}", partial(attempt, FORGED),
           "theorems only", partial(attempt, DISPLACED))
THE_BASE = partial(rule_returning(BASE), BASE.formula, BASE.domain)
beside("a rule that is no rule", THE_BASE,
       ("but a forged theorem", partial(rule_returning(FORGED), FORGED.formula, FORGED.domain),
        "the rule made no theorem"),
       ("but something like a theorem", partial(rule_returning(SAME), SAME.formula, BEADS),
        "the rule made no theorem"),
       ("but another statement", partial(rule_returning(BASE), NOTHING, BASE.domain),
        "another statement"))

# domains, loads and limits

for number in (1, 4):
    attack(f"dimension {number}", partial(Domain.of, j >= 0, dimension=number),
           "2 and 3", partial(Domain.of, j >= 0, dimension=3))
attack("a domain of sites", lambda: Domain.of(j >= 0, i >= 0, Eq(SITE[0], -9, evaluate=False)),
       "paper's indices", lambda: Domain.of(j >= 0, i >= 0, Eq(i, j)))
attack("relations of what a domain does not name", lambda: Domain((i,), (j >= 0,)),
       "all of which it names", lambda: Domain((i, j), (j >= 0,), beads=((i, j),)))
attack("a relation that is false", proof(REWRITE, (1, 0), BEADS.also(sympy.false)),
       "its domain is empty: nowhere", proof(REWRITE, (1, 1), BEADS.also(sympy.true)))
attack("a place where no bead is", proof(REWRITE, (HERE, 0), BEADS.also(Eq(i + j, 1))),
       "its domain is empty", proof(REWRITE, (HERE, HERE), BEADS.also(Eq(i + j, 2))))
attack("beads at two places that can't be",
       lambda: Domain.of(j >= 0, beads=[(i, j), (i + 1, j)]).points,
       "not shown to be even", lambda: Domain.of(j >= 0, beads=[(i, j), (i + 2, j)]).points)
attack("a limit of no order", lambda: Limit("∼", "", (M,), (M,), 0),
       "at least one order", lambda: Limit("∼", "", (M,), (M,), 2))
attack("a limit in which indices grow in no ratio", lambda: Limit("∼", "", (M, j), (M, M - j)),
       "each sum is what grows", lambda: Limit("∼", "", (M, j), (M - j, j)))
NO_LOAD = equation(sy.LoadForce(sy.site_r, sy.site_s), 0)
attack("an unknown loading",
       lambda: axioms.loads(replace(axioms.SURFACE, everywhere=((NO_LOAD, ()),))),
       "not a known loading", lambda: axioms.loads(axioms.SURFACE.put_in({M: M + 1})))
NONE_BELOW = axioms.loads(axioms.SURFACE)[0]
PLACELESS = Loading("mine", "", (), (), axioms.SURFACE.everywhere)
attack("the same loads without their place",
       proof(rules.follows(NONE_BELOW), NO_LOAD.args, NONE_BELOW.domain.loaded(PLACELESS)),
       "is not known there", proof(rules.follows(NONE_BELOW), NO_LOAD.args, NONE_BELOW.domain))
attack("a load at bead (r, s), which is any bead", lambda: axioms.SURFACE.put_in({M: sy.site_s}),
       "stand for any bead", lambda: axioms.SURFACE.put_in({M: l}))

# what is a statement


class Alias(sy.SiteFunction):
    """A quantity with the name of another one."""


Alias.__name__ = "DeltaR"
TRIPLE = Sum(n, (n, 1, m), (m, 1, j))
table(
    REWRITE, BEADS,
    ("an index of no domain", (k * r, k * r), "does not say what k is", (j * r, r * j)),
    *(("a reserved name", (name, name), "name that the kernel reserves", (r, r))
      for name in (SITE[0], UNKNOWNS[0], CONSTANTS[0][0])),
    ("a number and a vector", (sy.n_plus, sy.n_plus + 1), "added to a vector",
     (sy.n_plus, sy.n_plus)),
    ("a vector that is a number", (sy.n_plus, 1), "equal to a vector", (sy.n_plus * 0, 0)),
    ("no bead", (sy.DeltaR(i + 1, j),) * 2, "there may be no bead", (HERE, HERE)),
    ("below the base", (BETWEEN, BETWEEN), "below the base", (HERE, HERE)),
    *(("zero over zero", (over_itself(zero), 1), "may be zero", (over_itself(2 + zero**2), 1))
      for zero in (phi, 4 * phi - 1, n_x - n_y, n_x**2 + n_y**2 - 1, 1 - phi - 2 * n_x**2, j - 3,
                   z - Rational(1, 2))),
    ("near an end", (over_itself(100 * n_x - 51), 1), "may be zero", (over_itself(2 * n_x - 1), 1)),
    ("ε over itself", (over_itself(sy.epsilon), 1), "may be zero",
     (over_itself(1 + sy.epsilon), 1)),
    ("a sum that ends early", (Sum(1, (m, 3, j)), j - 2), "no agreed value",
     (Sum(1, (m, 1, j)), j)),
    ("one index for two sums", (Sum(n, (n, 1, 2), (n, 1, j)), 3 * j), "has another meaning",
     (TRIPLE, j * (j + 1) * (j + 2) / 6)),
    ("a square of a displacement and a first order", (HERE, 0), "differs by 1", (HERE**2, 0)),
    ("s of another packing", (sy.spacing, 4 * r * n_y), "left minus right is",
     (sy.spacing, 4 * r * n_x)),
    ("a mean of unknown forces", (sy.MeanOver(FORCE, 2, i), FORCE), "not known",
     (sy.MeanOver(HERE, 1, i), HERE)),
)
table(
    REWRITE, TWO,
    ("a sum over an index of the domain", (Sum(l, (l, 1, j)), j * (j + 1) / 2),
     "has another meaning", (Sum(n, (n, 1, j)), j * (j + 1) / 2)),
    ("two radii that may be one", (HERE, THERE), "differs by", (HERE - THERE, HERE - THERE)),
)
table(
    REWRITE, Domain.of(indices=(k, N)),
    ("a sum over the layer of a bead", (Sum(k, (l, 1, 2)), 3 - 2 * l + 2 * k),
     "has another meaning", (Sum(k, (n, 1, 2)), 2 * k)),
    ("a mean over layers, read as one over columns", (sy.MeanOver(k, N, l), k + N - 1),
     "left minus right", (sy.MeanOver(k, N, l), k)),
    ("a mean along a diagonal, read as a steeper one", (sy.MeanOver(k, N, k, l), k + 2 * N - 2),
     "left minus right", (sy.MeanOver(k, N, k, l), k + N - 1)),
)
SLANTED = sy.DeltaR(i - sy.p, j), sy.DeltaR(i - sy.p - 2, j)
table(
    REWRITE, Domain.of(j >= 0, beads=[(i - sy.p, j)]),
    ("a mean over what is taken off", (sy.MeanOver(SLANTED[0], 2, sy.p), SLANTED[0]), "differs by",
     (sy.MeanOver(SLANTED[0], 2, sy.p), sympy.Add(*SLANTED) / 2)),
)
table(
    REWRITE, Domain.of(i <= -1, j >= 1, l >= 0),
    ("a mean over −1 neighbours or fewer", (sy.MeanOver(1, i, k), 0), "neighbours has no value",
     (sy.MeanOver(1, -i, k), 1)),
)
table(
    REWRITE, HEIGHTS,
    ("a sum without a closed form", (Sum(over(m**2), (m, 1, M)), H_M), "more than one divisor",
     (Sum(over(m), (m, 1, M)), H_M)),
    ("a leading order at finite size", (M + 1, M), "left minus right is", (M + 1, 1 + M)),
)
table(REWRITE, Domain.of(Eq(M, 3)),
      ("H_M of another height", (H_M, Rational(3, 2)), "left minus right", (H_M, Rational(11, 6))))
table(REWRITE, Domain.of(j >= 1, j <= M - 1),
      ("the other height z", (z * M, j + 1), "left minus right is", (z * M, j)))
table(moment(), BEADS,
      ("a quantity with a name of the paper's", (sy.Variance(Alias(i, j)), sigma**2),
       "not a quantity of a packing", (sy.Variance(HERE), sigma**2)))

# forces as divisors

table(rules.rewrite(ON_LOADED), LOADED,
      ("a force over itself, which is zero", (over_itself(TOP), 0), "may be zero", (TOP, 0)))


ORIGIN, *_ = axioms.ordered()
ALONG_IT = sy.Dot(sy.n_plus, sy.Position(0, 0))


def over_no_force() -> Theorem:
    """That r = 0, by what vanishes as r times a force that is zero, over that force."""
    product = prove(rules.rewrite(ON_LOADED, ORIGIN), ALONG_IT, TOP * r, LOADED)
    ratio = prove(rules.rewrite(product), ALONG_IT / TOP, r, LOADED)
    return prove(rules.follows(ratio, ORIGIN), r, 0, LOADED)


ENTERING = sy.ForcePlus(sy.site_r, sy.site_s)
attack("a force that is zero, divided by where that is not put in", over_no_force, "may be zero",
       proof(REWRITE, (over_itself(ENTERING), 1),
             Domain.of(sy.site_s >= 0, loading=axioms.PASSING)))


def from_product(premises: Any, factor: Any, zero: Any, domain: Domain) -> Theorem:
    """That what vanishes times a factor vanishes."""
    product = prove(rules.rewrite(*premises), factor * zero, 0, domain)
    return prove(rules.rewrite(product), zero, 0, domain)


attack("a force that is zero, squared and divided by",
       partial(from_product, [ON_LOADED], TOP**2, THERE, LOADED),
       "not shown to vanish nowhere", partial(from_product, [ON_LOADED], r**2, TOP, LOADED))
attack("a factor that is zero at φ = 0", partial(from_product, [BASE], phi, MOVE, BASE.domain),
       "not shown to vanish nowhere", partial(from_product, [BASE], 2 + phi, MOVE, BASE.domain))
STRAIGHT = load(9).theorem
ZERO_AT_ORDER_0 = prove(
    rules.rewrite(STRAIGHT), (1 - STRAIGHT.formula.lhs) * HERE, 0, STRAIGHT.domain
)
attack("a determinant that is zero for one force",
       proof(rules.solve([ZERO_AT_ORDER_0], [HERE]), (HERE, 0), STRAIGHT.domain),
       "the determinant holds a force", proof(rules.solve([DISPLACED], [MOVE]), MOVED, ABOVE))

# rewrite, follows, along, order, solve, below

table(rules.rewrite(DISPLACED), ABOVE,
      ("half of Eq. 3", (MOVE, MOVED[1] / 2), "differs by", MOVED))
table(
    rules.follows(DISPLACED), ABOVE,
    ("a factor that may be zero", times(phi, DISPLACED), "may be zero", times(2 + phi, DISPLACED)),
    ("a factor that is zero in one layer", times(j - 2, DISPLACED), "may be zero",
     times(j, DISPLACED)),
    ("nothing at all", (MOVE, MOVE), "not a multiple", MOVED[::-1]),
)
attack("beyond its domain", proof(rules.follows(DISPLACED), MOVED, BEADS),
       "is not known there", proof(rules.follows(DISPLACED), MOVED, ABOVE.also(j >= 2)))
attack("the same on another domain", lambda: rules.same(DISPLACED)(DISPLACED.formula, BEADS),
       "another statement", lambda: rules.same(DISPLACED)(DISPLACED.formula, ABOVE))
attack("along what is not a vector", lambda: rules.along(BASE, sy.n_plus / phi),
       "not a base vector", lambda: rules.along(BASE, sy.e_x))
PLUS, MINUS, UP_ONLY = (rules.along(DISPLACED, to) for to in (sy.n_plus, sy.n_minus, sy.e_y))
table(rules.follows(PLUS), ABOVE,
      ("one component for another", MINUS.formula.args, "not a multiple", PLUS.formula.args))
CONTACT = axioms.contact(1)
LEANS = sy.Dot(sy.n_plus, MOVE - sy.DeltaX(i - 1, j - 1))
RADII = HERE + BETWEEN
table(rules.order(CONTACT, 1), ABOVE,
      ("the order 1 in ε", (4 * r * LEANS, 2 * r * RADII), "not the order 1",
       (4 * r * LEANS, 4 * r * RADII)))
table(rules.order(CONTACT, 0), ABOVE,
      ("the order 0 in ε", (LEANS, RADII), "not the order 0", (4 * r**2, 4 * r**2)))
attack("an order below zero", proof(rules.order(CONTACT, -1), (LEANS, HERE), ABOVE),
       "no such power", proof(rules.order(CONTACT, 3), (0, 0), ABOVE))
MOVED_BY_SUPPORTS = load(2).printed[0].args
table(load(2).step_of(0)[0].rules[0], ABOVE,
      ("a solution of another system", (MOVE, 2 * MOVED_BY_SUPPORTS[1]), "is not the solution",
       MOVED_BY_SUPPORTS))


def solved(*rows: Theorem) -> Attempt:
    return proof(rules.solve(rows, [MOVE]), MOVED, ABOVE)


beside("two components", solved(MINUS, UP_ONLY),
       ("of one equation", solved(PLUS), "1 equations for 2"),
       ("of one equation, twice", solved(PLUS, PLUS), "determinant may be zero"),
       ("of another bead", solved(BASE), "not known there"))
VERTICALLY = axioms.loads(axioms.LOADED_VERTICALLY)
SUPPORTED = Domain.of(l >= 1, loading=axioms.LOADED_VERTICALLY)
attack("f⁺ = 5 f_load",
       proof(eq07.balancing(VERTICALLY), (sy.ForcePlus(k - 1, l - 1), 5 * sy.f_load), SUPPORTED),
       "not the solution", lambda: load(7).proof[0].theorems)

# instance, mirror

ANY = Domain.of(indices=(i,), beads=())
PLACES = prove(REWRITE, Sum(i, (n, 1, 2)), Sum(i, (n, 2, 3)), ANY)
CIRCLE = prove(REWRITE, 1 - phi**2, 4 * n_x**2 * n_y**2, BEADS)
HEIGHT = prove(REWRITE, Sum(1, (m, 1, M)), M, HEIGHTS)
HARMONIC = prove(REWRITE, Sum(over(n), (n, 1, M)), H_M, HEIGHTS)
LAYER = Domain.of(indices=(l,), beads=())
PAIR = prove(REWRITE, sy.MeanOver(HERE, 2, i), (HERE + sy.DeltaR(i + 2, j)) / 2, BEADS)
for name, theorem, refused, (image, domain), (right_image, right) in (
    ("for φ", CIRCLE, "not a whole number", ({phi: Rational(1, 3)}, BEADS),
     ({j: j + 1, i: i + 1}, BEADS)),
    ("for r", CIRCLE, "not a whole number", ({r: Integer(0)}, BEADS), ({i: i + 2}, BEADS)),
    ("half an index", HEIGHT, "not a whole number", ({M: M / 2}, HEIGHTS), ({M: 2 * M}, HEIGHTS)),
    ("an index that is summed over", PLACES, "two meanings", ({i: n}, replace(ANY, indices=(n,))),
     ({i: i + 2}, ANY)),
    ("an index over which a mean is taken", PAIR, "two meanings", ({i: j}, BEADS),
     ({j: j + 2}, BEADS)),
    ("beyond its domain", DISPLACED, "not known there", ({j: j - 2}, ABOVE), ({j: j + 2}, ABOVE)),
    ("off the lattice", DISPLACED, "not known there", ({i: i + 1}, ABOVE), ({i: i + 2}, ABOVE)),
    ("a height that may be negative", HEIGHT, "not known there", ({M: l}, LAYER),
     ({M: l}, replace(LAYER, relations=(l >= 1,)))),
    ("another height of H_M", HARMONIC, "that of the height M", ({M: M + 1}, HEIGHTS),
     ({}, HEIGHTS)),
    ("in three dimensions", CIRCLE, "not known there", ({}, IN_SPACE), ({}, BEADS)),
    ("in a limit", HEIGHT, "not known there", ({}, limit("∼")), ({}, HEIGHTS)),
    *((f"under {words} load", NONE_BELOW, "not known there",
       ({}, NONE_BELOW.domain.loaded(loading)), ({}, NONE_BELOW.domain))
      for words, loading in (("another", axioms.BULK), ("no", None))),
):
    attack(f"an instance, {name}", partial(rules.instance, theorem, image, domain),
           refused, partial(rules.instance, theorem, right_image, right))


def vertical(kind: Any, turn: Any, force: Any) -> Sides:
    return kind(i, j), force(i, j) * (n_y + sy.Dot(sy.e_y, turn(i, j)))


TILTED = prove(REWRITE, *vertical(sy.VerticalPlus, sy.DeltaNPlus, sy.ForcePlus), BEADS)
table(rules.follows(rules.mirror(TILTED)), BEADS,
      ("the mirror image of a vertical component",
       vertical(sy.VerticalPlus, sy.DeltaNMinus, sy.ForceMinus), "not a multiple",
       vertical(sy.VerticalMinus, sy.DeltaNMinus, sy.ForceMinus)))
table(rules.follows(rules.mirror(DIRECTIONS[0])), BEADS,
      ("its own mirror image", (sy.DeltaNMinus(i, j), DIRECTIONS[0].formula.rhs),
       "not a multiple", DIRECTIONS[1].formula.args))
TURNED = sy.MatrixTimes(0, 0, 1, 0, sy.n_plus), n_x * sy.e_y
for name, wrong, sides in (
    ("a place", (i * HERE, HERE * i), (j * HERE, HERE * j)),
    ("a matrix", TURNED, (sy.n_plus + sy.n_minus, 2 * n_y * sy.e_y)),
):
    attack(f"the mirror image of {name}", partial(rules.mirror, prove(REWRITE, *wrong, BEADS)),
           "a horizontal index", partial(rules.mirror, prove(REWRITE, *sides, BEADS)))

# induction

q = sy.q
STAYS, COUNT = rules.rewrite(BASE), Domain.of(q >= 0)


def grows(size: sympy.Expr) -> Sides:
    """That the origin, which stays where it is, has moved."""
    return sy.DeltaX(0, 0), size * sy.e_y


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


SUPPOSED: list[Theorem] = []


def leak(supposed: tuple[Theorem, ...]) -> Rule:
    SUPPOSED.extend(supposed)
    return STAYS


def leaked(formula: sympy.Eq, domain: Domain) -> Theorem:
    rules.inducted(q, 0, STAYS, leak, [(equation(*grows(Integer(0))), COUNT)])
    return rules.rewrite(BASE, SUPPOSED[0])(formula, domain)


def induction(
    size: Any, start: Any = 0, at_first: Rule = STAYS, step: Any = never,
    index: sympy.Symbol = q, down: bool = False,
) -> Attempt:
    def rule(formula: sympy.Eq, domain: Domain) -> Theorem:
        return rules.inducted(index, start, at_first, step, [(formula, domain)], down=down)[0]

    return proof(rule, grows(sympy.sympify(size)), COUNT)


ITSELF = by_instance({})
beside("induction", induction(0),
       ("no step", induction(q), "left minus right is"),
       ("no base", induction(q + 1, step=ITSELF), "left minus right is"),
       ("what is supposed, of the next value",
        induction(Sum(1, (n, 1, q)), step=by_instance({q: q + 1})), "not known there"),
       ("what is supposed, by itself", induction(q, step=ITSELF), "not a multiple"),
       ("a start that is not the domain's", induction(q * (q - 1), 1, step=ITSELF), "goes beyond"),
       ("downwards from nowhere", induction(q, step=ITSELF, down=True), "goes beyond"),
       ("another supposition", induction(q * (q + 1), step=anew),
        "not what the induction is about"),
       ("a base that rests on what is supposed", induction(0, at_first=leaked),
        "nothing supposed"),
       ("a step that proves another statement", induction(q, step=lambda _: lambda *_: BASE),
        "another statement"),
       ("an index of no domain", induction(0, index=sy.p), "goes beyond"),
       ("one within another", induction(0, step=lambda _: leaked), "be nested"))


def decided(rule: Rule, theorem: Theorem) -> str:
    ruling = decide.decide(theorem.formula, theorem.domain, [rule])
    if not ruling.verdict.is_proved:
        raise ValueError(ruling.note)
    return str(ruling)


attack("what is only supposed is no proof", lambda: decided(lambda *_: SUPPOSED[0], SUPPOSED[0]),
       "only supposed", lambda: decided(rules.same(BASE), BASE))
REACHED = POSITIONS.formula.args
HIGH = Domain.of(Eq(j, 0), indices=(M,), beads=())
attack("a bead in column 0 of a layer M that may be odd",
       proof(REWRITE, (sy.Braces(ZERO, Integer(1), M, j), 0),
             Domain.of(Eq(j, 0), indices=(M,), beads=[(ZERO, M)])),
       "not shown to be even", proof(REWRITE, (sy.Braces(ZERO, Integer(1), M, j), 1), HIGH))

table(
    REWRITE, BEADS.also(indices=(M,)),
    ("a sum up to M, or to no number",
     (Sum(1, (m, 1, Mul(M, over_itself(j - 1), evaluate=False))), M), "not affine",
     (Sum(1, (m, 1, M)), M)),
    ("a sum up to M + log z − log z",
     (Sum(1, (m, 1, sympy.Add(M, sympy.log(z), -sympy.log(z), evaluate=False))), M), "not affine",
     (Sum(1, (m, 1, M)), M)),
    ("the place of a radius",
     (sy.DeltaR(Mul(i, over_itself(j - 1), evaluate=False), j), HERE), "not affine",
     (sy.DeltaR(i + 0, j), HERE)),
)

# what is known for one value of an index

p = sy.p
ONE_OR_ONE = sy.Braces(Integer(1), Integer(1), p, Integer(3))
NAMED = prove(rules.rewrite(POSITIONS), PLACE, ONE_OR_ONE * REACHED[1], BEADS.also(p >= 3, p <= 4))
attack("a theorem for each of two values",
       proof(rules.rewrite(NAMED), (PLACE, 2 * REACHED[1]), BEADS), "does not say what p is",
       proof(rules.rewrite(POSITIONS), REACHED, BEADS))

SLOPE = Domain.of(i + j >= 0, beads=())
ALONG = sy.Position(i - j, i + j), 2 * r * (i * sy.n_plus + j * sy.n_minus)
ASIDE = prove(rules.rewrite(POSITIONS), ALONG[0],
              sy.Position(i - j - 2, i + j) + 2 * r * (sy.n_plus - sy.n_minus), SLOPE)


def from_the_left(start: Any, shift: Any) -> Attempt:
    """By the bead to the left of it, which is supposed to be shifted as far."""
    def step(supposed: tuple[Theorem, ...]) -> Rule:
        return lambda formula, domain: rules.rewrite(
            rules.instance(ASIDE, {}, domain), supposed[0]
        )(formula, domain)

    def rule(formula: sympy.Eq, domain: Domain) -> Theorem:
        base = rules.rewrite(POSITIONS)
        return rules.inducted(i, start, base, step, [(formula, domain)])[0]

    return proof(rule, (ALONG[0], ALONG[1] + shift), SLOPE.also(i >= 0))


attack("an induction that starts nowhere", from_the_left(i - 1, r * sy.n_plus),
       "goes beyond", from_the_left(0, 0))


def diagonal(steps: Any) -> sympy.Expr:
    return sy.Position(steps, steps)


STEEP, STEP = Domain.of(q >= 1, beads=()), 2 * r * sy.n_plus
UPWARDS = prove(rules.rewrite(POSITIONS), diagonal(q), diagonal(q - 1) + STEP, STEEP.also(q >= 2))
DOWNWARDS = prove(rules.rewrite(POSITIONS), diagonal(q), diagonal(q + 1) - STEP,
                  STEEP.also(Eq(q, 1)))


def from_below(start: int, shift: Any) -> Attempt:
    """By the bead below it, and at the first bead by the one above, if that is known."""
    def rule(formula: sympy.Eq, domain: Domain) -> Theorem:
        return rules.inducted(
            q, start, rules.rewrite(POSITIONS),
            lambda supposed: rules.rewrite(DOWNWARDS, UPWARDS, supposed[0]), [(formula, domain)],
        )[0]

    return proof(rule, (diagonal(q), q * STEP + shift), STEEP)


attack("what is supposed of one layer, put in for all", from_below(0, r * sy.n_minus),
       "differ", from_below(1, 0))
WEDGE = Domain.of(q >= 0, i >= 0, i <= 2 * q - 2, beads=[(i, ZERO)])
AT_BASE = prove(rules.rewrite(POSITIONS), diagonal(ZERO), 0, Domain())


def by_means(formula: sympy.Eq, domain: Domain) -> Theorem:
    """A bead's place by the mean of it and of the one below it."""
    def place(axis: sympy.Expr, steps: sympy.Expr) -> sympy.Expr:
        return sy.Dot(axis, diagonal(steps))

    def step(supposed: tuple[Theorem, ...]) -> Rule:
        def rule(formula: sympy.Eq, domain: Domain) -> Theorem:
            upper = q - i / 2
            rows = [
                prove(REWRITE, 2 * sy.MeanOver(place(axis, upper - 1), 2, q, i),
                      place(axis, upper - 1) + place(axis, upper), domain)
                for axis in (sy.n_plus, sy.n_minus)
            ]
            known = supposed[0], AT_BASE
            return rules.solve(rows, [diagonal(upper)], known)(formula, domain)

        return rule

    return rules.inducted(q, 0, REWRITE, step, [(formula, domain)])[0]


attack("a mean over what is supposed for one value",
       proof(by_means, (diagonal(q - i / 2), 3 * (q - i / 2) * r * sy.n_plus), WEDGE),
       "stands for one value",
       proof(rules.rewrite(POSITIONS), (diagonal(q - i / 2), (q - i / 2) * STEP), WEDGE))
LATER = Domain.of(n >= 1, beads=())


ASTRAY = n * STEP + (n - 1) * r * sy.n_minus


def in_a_sum(of: Any, rule: Callable[[Theorem], Rule]) -> Attempt:
    """By the sum of what is supposed of the one before, over all of them."""
    def step(supposed: tuple[Theorem, ...]) -> Rule:
        right = sy.Dot(sy.n_plus, ASTRAY.xreplace({n: n - 1}))
        sides = (Sum(each, (n, 2, q)) for each in (of(sy.Dot(sy.n_plus, diagonal(n - 1))), right))
        return rules.rewrite(POSITIONS, prove(rule(supposed[0]), *sides, STEEP))

    line = equation(diagonal(n), ASTRAY)
    return lambda: rules.inducted(n, 1, rules.rewrite(POSITIONS), step, [(line, LATER)])


for of, rule in ((sympy.Add, rules.rewrite), (sy.Mean, moment)):
    attack(f"a sum over the index of an induction, by {rule.__name__}", in_a_sum(of, rule),
           "another meaning",
           proof(rule(POSITIONS), (Sum(of(sy.Dot(sy.n_plus, diagonal(n))), (n, 1, q)),
                                   q * (q + 1) * r), STEEP))
AT_THE_LOAD = Domain.of(
    Eq(i, 0), Eq(j, 0), Eq(k, 4), Eq(l, 4), q >= 0,
    beads=[(i, j), (k, l), (p, q)], loading=axioms.POINT,
)
RADIUS = sy.DeltaR(p, q)


def of_another_load(mean: sympy.Expr, zero: sympy.Expr) -> Theorem:
    """That a radius is as it should be, by a force less its mean over loads."""
    row = prove(REWRITE, (mean - FORCE) * RADIUS, 0, AT_THE_LOAD)
    return prove(rules.solve([row], [RADIUS], *eq16.in_radii()), RADIUS, zero, AT_THE_LOAD)


attack("a force that is the same under another load",
       partial(of_another_load, sy.MeanOver(FORCE, 2, k), 0), "stands for one value",
       proof(REWRITE, ((sy.MeanOver(r, 2, i) - r) * RADIUS, 0), AT_THE_LOAD))
FLOOR, FLAT = Domain.of(i >= -M, i <= M - 1, beads=()), sy.n_plus - sy.n_minus


def bulges(steps: sympy.Expr, height: int) -> Sides:
    """The base, so many columns from the middle, without an index outside of a bead's place."""
    here, end, before = (
        sy.Dot(sy.e_x, sy.Position(2 * place, Integer(2))) for place in (steps, M, M - 1)
    )
    bulge = height * (here * here - end * end) * (here * here - before * before) / r**3
    return sy.Position(2 * steps, ZERO), here / (2 * n_x) * FLAT + bulge * sy.e_y


def from_both_sides(height: int, mirrored: bool) -> tuple[Theorem, ...]:
    """A row by its mirror image, which goes on where the row has not come to."""
    sides = [equation(*bulges(i + ahead, height)) for ahead in (0, 1)]
    base = rules.rewrite(POSITIONS)

    def step(supposed: tuple[Theorem, ...]) -> Rule:
        def rule(formula: sympy.Eq, domain: Domain) -> Theorem:
            known = supposed[1 if formula == sides[0] else 2] if mirrored else POSITIONS
            return rules.rewrite(known, POSITIONS)(formula, domain)

        return rule

    return rules.inducted(i, -M, base, step, [(side, FLOOR) for side in sides], mirrored=mirrored)


attack("the mirror image of what is supposed of one column", partial(from_both_sides, 1, True),
       "no mirror image", partial(from_both_sides, 0, False))


def carried(across: Any, layer: Any, *more: sympy.Expr) -> Sides:
    """That a bead's load is what its supports carry, less what comes from above."""
    left, right = (across - 1, layer - 1), (across + 1, layer - 1)
    below = (sy.n_plus + sy.DeltaNPlus(*left)) * sy.ForcePlus(*left), (
        (sy.n_minus + sy.DeltaNMinus(*right)) * sy.ForceMinus(*right)
    )
    return sy.LoadForce(across, layer), sympy.Add(*more) - sympy.Add(*below)


FROM_ABOVE = (
    (sy.n_plus + sy.DeltaNPlus(i, M)) * sy.ForcePlus(i, M),
    (sy.n_minus + sy.DeltaNMinus(i, M)) * sy.ForceMinus(i, M),
)
TOP_LAYER = Domain.of(indices=(i, M), beads=[(i, M)])
BALANCED = rules.instance(axioms.balance(), {sy.site_r: i, sy.site_s: M}, TOP_LAYER)
AT_TOP = prove(rules.follows(BALANCED), *carried(i, M, *FROM_ABOVE), TOP_LAYER)
ON_SURFACE = rules.rewrite(AT_TOP, axioms.loads(axioms.SURFACE))
attack("what a load says of the surface, put in for all layers",
       proof(ON_SURFACE, carried(i, j), SURFACE.also(j >= 1)), "differ",
       proof(ON_SURFACE, carried(i, M), TOP_LAYER.loaded(axioms.SURFACE)))

# derivatives

OF_Z = Derivative(z**2 * phi, z), 2 * z * phi
DEPENDS = "may depend on the variable"
table(
    rules.differentiate, Domain(),
    ("the derivative of n_x", (Derivative(n_x, phi), 0), DEPENDS, OF_Z),
    ("the derivative of φ", (Derivative(phi, n_y), 0), DEPENDS, OF_Z),
    ("the derivative of L⁻", (Derivative(sy.L_minus, sy.t), 0), DEPENDS, OF_Z),
    ("the derivative of L⁺t", (Derivative(sy.L_plus * sy.t, sy.L_minus), 0), DEPENDS, OF_Z),
    ("the second derivative of v n_x", (Derivative(V * n_x, V, phi), 0), DEPENDS, OF_Z),
    ("the derivative of v z", (Derivative(V * z, z), V), DEPENDS, OF_Z),
    ("the derivative of z j", (Derivative(z * j, j), z), DEPENDS, OF_Z),
    ("another derivative", (Derivative(V**2, V), V), "left minus right is",
     (Derivative(V**2, V), 2 * V)),
    ("a derivative of 0/0", (Derivative(Mul(over_itself(phi), z, evaluate=False), z), 1),
     "may be zero", (Derivative(z, z), 1)),
)

# moments

Mean, Variance = sy.Mean, sy.Variance
LENGTH = sy.Dot(MOVE, MOVE)
OF_MEAN = (N - 1) * (2 * N - 1) * sigma**2 / (6 * N)
table(
    moment(*FORCES), SURFACE,
    ("⟨f²⟩ = ⟨f⟩²", (Mean(FORCE**2), Mean(FORCE) ** 2), "is not linear",
     (Mean(FORCE) ** 2, (sy.f_load / (2 * n_y)) ** 2)),
    ("no variance", (Variance(FORCE), 0), "left minus right is",
     (sy.Covariance(FORCE, FORCE), Variance(FORCE))),
)
table(
    moment(), TWO,
    ("no covariance anywhere", (sy.Covariance(HERE, THERE), 0), "left minus right is",
     (sy.Covariance(HERE, sy.DeltaR(i + 2, j)), 0)),
)
table(
    moment((DISPLACED, BASE)), ABOVE,
    ("a matrix for a product", (Mean(sy.Dot(sy.n_plus, sy.MatrixTimes(HERE, 0, 0, 0, MOVE))), 0),
     "is not linear", (Mean(sy.Dot(sy.n_plus, sy.MatrixTimes(1, 0, 0, 1, MOVE))), 0)),
)
table(moment(), SURFACE,
      ("a force that is not known", (Variance(FORCE), 0), "not determined by the radii",
       (Variance(HERE), sigma**2)))
OF_THREE = Mean(sy.MeanOver(1 + HERE, 3, i)), 1
table(
    moment(), BEADS,
    ("a moment of a vector", (Mean(sy.n_plus), 0), "is a vector",
     (Mean(sy.Dot(sy.e_y, sy.n_plus)), n_y)),
    ("a mean over −3 neighbours", (Mean(sy.MeanOver(1 + HERE, -3, i)), 0),
     "neighbours has no value", OF_THREE),
    ("a mean over an angle", (Mean(sy.MeanOver(1 + HERE, 3, phi)), 1),
     "neighbours has no value", OF_THREE),
)
attack("a mean that captures n",
       proof(moment(), (Variance(sy.MeanOver(n * HERE, N, i)), OF_MEAN),
             Domain.of(j >= 0, n >= 1, N >= 2)),
       "with the index n",
       proof(moment(), (Variance(sy.MeanOver(l * HERE, N, i)), l**2 * sigma**2 / N),
             Domain.of(j >= 0, l >= 1, N >= 2)))
OF_RADIUS = Variance(HERE), sigma**2
table(
    moment(), Domain.of(M >= 5, beads=(), loading=SPHERES["surface"], dimension=3),
    ("a force between spheres below the base", (Mean(sy.ForceAlong(1, 0, 0, -2)), 0),
     "below the base", (Mean(sy.ForceAlong(1, 0, 0, 2)), 1)),
    ("n_y between spheres", (2 * Mean(sy.ForceAlong(1, 0, 0, 2)) * n_y**2, phi + 1),
     "belong to discs", (Mean(sy.ForceAlong(1, 0, 0, 2)) * phi, phi)),
)
beside("a larger domain", proof(moment(on=BEADS), OF_RADIUS, ABOVE),
       ("of another dimension", proof(moment(on=IN_SPACE), OF_RADIUS, BEADS), "is another one"),
       ("that is smaller", proof(moment(on=ABOVE), OF_RADIUS, BEADS),
        "no part of the larger one"))
table(moment(), ABOVE,
      ("the square of an unknown displacement", (sy.Shift(LENGTH), 0),
       "not determined by the radii", (sy.Shift(HERE**2), sigma**2)))


def part_of(group: tuple[Theorem, ...], *relations: sympy.Basic) -> tuple[Theorem, ...]:
    return tuple(rules.instance(theorem, {}, theorem.domain.also(*relations)) for theorem in group)


SHIFTED = sy.Shift(FORCE), (
    sy.f_load * sigma**2 * (4 * j - 4 * M * phi + phi**2 + phi)
    / (4 * n_y * r**2 * (1 - phi**2) * (1 + phi))
)
ENTERS = axioms.loads(axioms.ENTERING)
BELOW_IT = eq07.carried_down(
    l - 1, ENTERS,
    [(eq10.PRINTED, eq10.BRANCHED), (eq09.PRINTED, eq09.STRAIGHT), *eq10.NOTHING_BESIDE],
    rules.rewrite(ENTERS),
)
OFF_THE_PATH = Domain.of(
    j >= 0, j <= l - 4, Eq(k - i, l - j - 2), indices=(k,), loading=axioms.ENTERING
)
attack("the second order of forces that are known by another force",
       proof(moment(tuple(BELOW_IT), *FORCES[1:]), (sy.Shift(FORCE), 0), OFF_THE_PATH),
       "not determined by the radii",
       proof(moment(tuple(BELOW_IT), *FORCES[1:]), (Mean(FORCE), 0), OFF_THE_PATH))
INNER = SURFACE.also(j >= 2, j <= M - 2)
attack("the second order of a packing that ends early",
       lambda: prove(moment(part_of(FORCES[0], j <= M - 3), *FORCES[1:]), *SHIFTED,
                     INNER.also(j <= M - 3)),
       "for every bead",
       lambda: prove(moment((*FORCES[0], *part_of(FORCES[0], j >= 3)), *FORCES[1:]), *SHIFTED,
                     INNER))

# leading orders

ASYMPTOTIC = limits.asymptotic()
LIKE_M = M + H_M**3 / M**2 + phi, M
table(
    ASYMPTOTIC, limit("∼"),
    ("zero and zero", (0, 0), "may vanish", LIKE_M),
    ("twice as much", (2 * M, M), "left over right", LIKE_M),
    ("another power", (M**2, M), "left minus right", LIKE_M),
    ("a divisor that mixes", (M * (1 + over(1 + M**2 * phi**2)), M), "mixes what grows", LIKE_M),
    ("a divisor that mixes, at odds", (M * (1 + M * over(1 + M**2 * phi**2)), M),
     "mixes what grows", LIKE_M),
    ("a small power", (M * (1 + M ** Rational(-1, 1000)), M), "not a rational function", LIKE_M),
    ("H_M in a divisor", (M + M**3 * over(M**2 + H_M**3), M), "goes to 2", LIKE_M),
    ("H_M M", (M + H_M * M, M), "left over right", LIKE_M),
    ("another index", (M + i, M), "does not say what i is", LIKE_M),
    ("a constant of one's own", (M + Symbol("a", positive=True), M), "not a rational function",
     LIKE_M),
    ("what vanishes at φ = 0", (phi * M + 1, phi * M), "may vanish",
     ((1 + phi**2) * n_x * M + 1, (1 + phi**2) * M * (n_x + (1 - phi) / 2) / (n_x + 1))),
)
table(ASYMPTOTIC, limit("∼", 2),
      ("the second order", (M**2 + M + 1, M**2 + 2 * M), "left minus right",
       (M**2 + M + 1, M**2 + M)))
FIXED = at_fixed_height("∼")
attack("a limit beside its domain",
       proof(ASYMPTOTIC, (M + j, M),
             Domain.of(j >= 0, j <= 9, indices=(M,)).in_the_limit(FIXED)),
       "does not hold all of",
       proof(ASYMPTOTIC, (M + 1, M), Domain.of(j >= 0, j <= M).in_the_limit(FIXED)))
attack("a limit that says nothing of j",
       proof(ASYMPTOTIC, (M + j, M),
             Domain.of(j >= 0, indices=(M,), beads=()).in_the_limit(at_large_height("∼"))),
       "neither grows nor is fixed", proof(ASYMPTOTIC, (M + 1, M), limit("∼")))
DROPPING = eq12.DERIVATION.domain
LEFT, RIGHT = eq12.PRINTED.args
DROPPED = LEFT, RIGHT + H_M * M * HERE
table(
    limits.negligible(*FORCES), DROPPING,
    ("half of it", (LEFT, RIGHT / 2), "goes as M³, and has", DROPPED),
    ("a large radius", (LEFT, RIGHT + M**2 * HERE), "goes as M⁴, and has", DROPPED),
    ("a place across", (LEFT, RIGHT + i * HERE), "place across the packing matters", DROPPED),
    ("another mean", (LEFT, RIGHT + 1), "means of both sides differ", DROPPED),
    ("two forces", (LEFT, RIGHT + sy.ForcePlus(i + 2, j)), "does not stand alone", DROPPED),
    ("a force that a sum takes off", (LEFT + FORCE * M - Sum(FORCE, (m, 1, M)), 5 * RIGHT),
     "does not stand alone", DROPPED),
    ("a force that its value takes off",
     ((M + 1) * LEFT - M * (eq11.PRINTED.rhs - 1), 5 * RIGHT), "does not stand alone", DROPPED),
)
KEPT = limits.drop_terms(
    eq12.DERIVATION.theorem,
    eq13.DERIVATION.proof[2].theorem,
)
OF_FORCE = eq13.PRINTED.rhs
table(
    KEPT, eq13.IN_THE_LIMIT,
    ("another variance than that of what is kept", (Variance(LEFT), 2 * OF_FORCE),
     "left over right", (Variance(LEFT), OF_FORCE)),
    ("the variance of another quantity", (Variance(2 * LEFT), OF_FORCE),
     "something was dropped from", (Variance(LEFT + 1), OF_FORCE)),
    ("the variance of what has no value", (Variance(LEFT + over_itself(2 * j - M)), OF_FORCE),
     "may be zero", (Variance(LEFT + 1), OF_FORCE)),
    ("the variance of two forces", (Variance(LEFT + sy.ForcePlus(0, 0)), OF_FORCE),
     "something was dropped from", (Variance(LEFT + 1), OF_FORCE)),
)
ON_DIAGONAL = eq13.IN_THE_LIMIT.also(Eq(i, j))
DROPPED_THERE = limits.drop_terms(
    prove(limits.negligible(*FORCES), LEFT, RIGHT, DROPPING.also(Eq(i, j))),
    eq13.DERIVATION.proof[2].theorem,
)
attack("the variance of what something was dropped from elsewhere",
       proof(DROPPED_THERE, (Variance(LEFT), OF_FORCE), eq13.IN_THE_LIMIT), "is so elsewhere",
       proof(DROPPED_THERE, (Variance(LEFT), OF_FORCE), ON_DIAGONAL))

# moments that theorems give

IN_ONE_COLUMN = prove(moment(), Mean(1 + i), 1, Domain.of(Eq(i, 0), beads=()))


def grows_as(quantity: sympy.Expr, *relations: sympy.Basic) -> Attempt:
    domain = Domain.of(*relations, indices=(i, M), beads=())
    grown = domain.in_the_limit(at_large_height("∼"))
    return proof(limits.asymptotic(IN_ONE_COLUMN), (M * quantity, M), grown)


beside("a mean that is known in one column", grows_as(Mean(1 + i), Eq(i, 0)),
       ("put in for all", grows_as(Mean(1 + i)), "neither grows"),
       ("put in for its neighbours", grows_as(sy.MeanOver(Mean(1 + i), 3, i), Eq(i, 0)),
        "on a remainder"))
AT_LEFT = prove(moment(), Mean(i), 4, Domain.of(Eq(i, 4), Eq(j, 0)))
attack("a mean that is known of beads, put in for whole numbers",
       proof(moment(AT_LEFT), (Mean(i), 4), Domain.of(Eq(i, -2), Eq(j, 0), beads=())),
       "of other beads", proof(moment(AT_LEFT), (Mean(i), 4), AT_LEFT.domain))
OF_LAYER = eq13.DERIVATION.theorem
VARIES, *_ = eq13.DERIVATION.exact_theorems
EXACTLY = VARIES.formula.args
WITHIN = VARIES.domain
beside("an exact variance", proof(moment(VARIES), EXACTLY, WITHIN),
       ("put in under another load", proof(moment(VARIES), EXACTLY, WITHIN.loaded(axioms.BULK)),
        "other packings"),
       ("put in for more layers", proof(moment(VARIES), EXACTLY, SURFACE), "by the radii"),
       ("put in for its leading order",
        proof(moment(OF_LAYER), OF_LAYER.formula.args, WITHIN), "other packings"))
SHARE = sy.LargestShare
table(
    limits.bounded(*FORCES), INNER.in_the_limit(at_fixed_height("O")),
    ("a share that is too small", (SHARE(FORCE), 1 / M**2 + H_M**3 / M**3), "has more",
     (SHARE(FORCE), 1 / M)),
    ("a share of no radius", (SHARE(sympy.S.One), 1 / M), "not shown to vanish",
     (SHARE(FORCE), 1 / M)),
)
ROW = Sum(sy.DeltaR(i + 2 * m, j), (m, 1, M))
table(
    limits.bounded(), BEADS.also(indices=(M,)).in_the_limit(Limit("O", "M → ∞", (M,), (M,))),
    ("the share of a radius that grows with H_M", (SHARE(ROW + H_M * HERE), 1 / M), "has more",
     (SHARE(ROW + HERE), 1 / M)),
)

# Eq. 15

CUBE, SQUARE = M**3 * sigma**2 / r**2, eq15.mean("surface", Variance)
IN_RADII = eq15.IN_RADII["surface"]()
AVERAGED = eq15.heights("surface").in_the_limit(at_large_height("="))
ROOT = sqrt(SQUARE), M ** Rational(3, 2) * sigma / r / (1 - phi**2)


def by_factor(factor: Any) -> Sides:
    return ROOT[0], Mul(ROOT[1], factor, evaluate=False)


table(
    power_law(*IN_RADII), AVERAGED,
    ("a factor that mixes M and φ", by_factor(1 + M * over(1 + M**2 * phi**2)),
     "mixes what grows", ROOT),
    ("a factor that may be zero", by_factor(1 - 4 * phi), "not shown to be positive", ROOT),
    ("a factor of another size", by_factor(2), "goes to", ROOT),
    ("a factor that is negative", by_factor(1 - 2 * n_x), "not shown to be positive", ROOT),
    ("a factor of another power", by_factor(M ** Rational(-1, 12)), "goes to", ROOT),
    ("a factor of nearly no other power", by_factor(M ** Rational(-1, 1000)),
     "more than 20000 terms", ROOT),
    ("a factor with a power that is not a number", by_factor(2**phi), "is not a number", ROOT),
)
POWER, OF_M = power_law(), (sy.UnitHeight(sigma * M / r), r / sigma)
attack("a power law as σ decreases",
       proof(POWER, (CUBE + M**2, CUBE), HEIGHTS.in_the_limit(AT_FIXED_RATIO)),
       "only what is fixed",
       proof(POWER, (M * (r + n_x) ** 2, M * (r * (r + 2 * n_x) + n_x**2)), limit("=")))
table(POWER, limit("="), *(
    ("a height for what does not grow as a power",
     (sy.UnitHeight(sigma * size / r), r / sigma), "not one height", OF_M)
    for size in (1 / M, H_M, M * H_M)
))
FRACTION = (
    eq15.mean("surface", sy.Tensile),
    in_place(eq15.tensile_fraction("surface"), {eq15.HEIGHT: sy.UnitHeight(SQUARE)}),
)
ONES = prove(moment(*FORCES), Mean(eq15.FORCE["surface"]), 1, eq11.LAYERS.loaded(axioms.SURFACE))
ONE_LAYER = rules.instance(ONES, {}, ONES.domain.also(Eq(j, 3)))


def fraction(means: Theorem = ONES, left: Any = 1, right: Any = 1) -> Attempt:
    rule = tensile(OF_LAYER, means, *IN_RADII)
    sides = left * FRACTION[0], right * FRACTION[1]
    return proof(rule, sides, eq15.heights("surface").in_the_limit(AT_FIXED_RATIO))


RATIO = eq15.FORCE["surface"]
IN_EVEN_LAYERS = Domain.of(
    j >= 0, j <= M - 1, indices=(i,), loading=axioms.SURFACE, beads=[(i, j), (j, ZERO)]
)


def of_all_beads(force: sympy.Expr, domain: Domain) -> Attempt:
    """The tensile fraction of forces, from moments that are those of Eq. 13 on a domain."""
    each = sy.Tensile(force.xreplace({i: m, j: m}))
    heights = eq15.heights("surface").also(indices=force.free_symbols & {sy.p})

    def proved() -> Theorem:
        ones = prove(moment(*FORCES), Mean(force), 1, domain)
        varies = prove(limits.asymptotic(*FORCES), Variance(force), OF_LAYER.formula.rhs,
                       domain.in_the_limit(at_fixed_height("∼")))
        return prove(tensile(varies, ones, *IN_RADII), Sum(each, (m, 0, M - 1)) / M, FRACTION[1],
                     heights.in_the_limit(AT_FIXED_RATIO))

    return proved


beside("the tensile fraction", fraction(),
       ("of forces of all sizes", of_all_beads(RATIO * (1 + sy.p), SURFACE.also(Eq(sy.p, 0))),
        "more than its layer"),
       ("of forces of other columns", of_all_beads(RATIO * (1 - i - j), SURFACE.also(Eq(i, -j))),
        "more than its layer"),
       ("of forces in even layers", of_all_beads(RATIO, IN_EVEN_LAYERS), "more than its layer"),
       ("of beads below the base",
        of_all_beads(RATIO + sy.DeltaR(i - 8, j - 8) / r, SURFACE.also(j >= 9)), "below the base"),
       ("of forces without a value in layer 5",
        of_all_beads(RATIO + HERE / (r * (j - 5)), SURFACE.also(j >= 9)), "may be zero"),
       ("with the mean of one layer", fraction(ONE_LAYER), "does not hold all of"),
       ("with another mean", fraction(OF_LAYER), "mean of one force"),
       ("of half the layers", fraction(left=Rational(1, 2)), "mean over all layers"),
       ("twice", fraction(right=2), "not ∫ ½ erfc"))

# definitions of a step


def shown(definitions: dict[Any, Any], left: Any, right: Any) -> object:
    formula = equation(left, right)
    return Steps(99, BEADS, {}).show("", formula, REWRITE, definitions=definitions)


OWN = "has a meaning of its own"
STRANGE_R = Symbol("r")
beside("a definition", lambda: shown({V: 2 * r}, V, 2 * r),
       ("of a radius", lambda: shown({sy.DeltaR: lambda *_: ZERO}, HERE, ZERO), OWN),
       ("of a radius of one bead", lambda: shown({HERE: ZERO}, HERE, ZERO), OWN),
       ("of a mean", lambda: shown({Mean: lambda _: ZERO}, Mean(HERE + 1), ZERO), OWN),
       ("of a number", lambda: shown({Integer(2): Integer(3)}, Integer(2), Integer(3)), OWN),
       ("of r", lambda: shown({r: ZERO}, r, ZERO), OWN),
       ("of s", lambda: shown({sy.spacing: ZERO}, sy.spacing, ZERO), OWN),
       ("of L⁻", lambda: shown({sy.L_minus: ZERO}, sy.L_minus, ZERO), OWN),
       ("of another r", lambda: shown({STRANGE_R: r - r}, STRANGE_R, ZERO), OWN),
       ("of H_M", lambda: shown({H_M: ZERO}, H_M, ZERO), OWN))
