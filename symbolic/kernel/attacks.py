"""Attacks on the kernel: what must not become a theorem, tried by its own rules on every run.

Each names what is tried, why that is false (or no statement at all), and in which words it is to be
refused. For each guard of a rule there is at least one that comes through once the guard is gone;
``.ci/guards`` takes them away one at a time.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

import sympy
from force_diffusion.symbolic import symbols as sy
from force_diffusion.symbolic.algebra.exact import UNKNOWNS, NotExactError
from force_diffusion.symbolic.as_printed import equation, times
from force_diffusion.symbolic.kernel import axioms, rules
from force_diffusion.symbolic.kernel.rules import Rule
from force_diffusion.symbolic.kernel.theorem import (
    NotProvedError,
    Supposition,
    Theorem,
    check,
)
from force_diffusion.symbolic.kernel.where import (
    ENTERING,
    LOADED,
    LOADED_VERTICALLY,
    SURFACE,
    Where,
)
from force_diffusion.symbolic.symbols import (
    DeltaR,
    DeltaX,
    Dot,
    ForceMinus,
    ForcePlus,
    Load,
    M,
    MatrixTimes,
    Position,
    b_plus,
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
    site_r,
    site_s,
)
from sympy import Eq, Integer, Pow, Sum

REFUSALS = (NotProvedError, NotExactError, TypeError)
"""How the kernel refuses: a TypeError for theorems that are not made by it."""


@dataclass(frozen=True)
class Attack:
    """An attempt to prove what is false.

    Attributes:
        rule: the rule that is misused.
        tried: how.
        false: why the outcome would be false, or no statement.
        refused: words of the refusal.
        attempt: tries it; what it returns has been proved.
    """

    rule: str
    tried: str
    false: str
    refused: str
    attempt: Callable[[], object]


ATTACKS: list[Attack] = []


def _attack(
    rule: str, tried: str, false: str, refused: str
) -> Callable[[Callable[[], object]], None]:
    def keep(attempt: Callable[[], object]) -> None:
        ATTACKS.append(Attack(rule, tried, false, refused, attempt))

    return keep


def succeeded() -> Iterator[Attack]:
    """The attacks that the kernel does not refuse: it is at fault."""
    for one in ATTACKS:
        try:
            one.attempt()
        except REFUSALS:
            continue
        except Exception:  # a guard that stumbles guards nothing
            yield one
        else:
            yield one


# short words for statements

BEADS, AT_BASE, ONE = Where.of(j >= 0), Where((i,), even=(i,)), Integer(1)
TOP = Where.of(Eq(j, M), j >= 0, loading=SURFACE)
BELOW = Where.of(j >= 0, j <= M - 1, loading=SURFACE)
AT_LOAD = Where.of(l >= 1, loading=LOADED)
ON_SURFACE, ON_LOADED = axioms.loads(SURFACE), axioms.loads(LOADED)
HERE, ABOVE = DeltaR(i, j), DeltaR(i + 1, j + 1)
ORIGIN = DeltaX(0, 0)  # no displacement at all: what is said of it is false but for 0
ROOT = sympy.Symbol("root", positive=True)


def _told(rule: Rule, left: sympy.Expr, right: sympy.Expr | int, where: Where = BEADS) -> Theorem:
    return rule(equation(left, sympy.sympify(right)), where)


def _checked(side: sympy.Expr, where: Where = BEADS) -> None:
    check(equation(side, side), where)


def _no_force(other: sympy.Expr) -> Theorem:
    """That f⁺_kl times anything is zero, since f⁺_kl is."""
    return _told(rules.rewrite(ON_LOADED), other * ForcePlus(k, l), 0, AT_LOAD)


def _over_no_force(number: int) -> Theorem:
    """That f⁺ is any number times f⁻, in the sense of 0 = 0, divided by f⁻."""
    where = Where.of(Eq(l, M), l >= 0, loading=SURFACE)
    plus, minus = ForcePlus(k, l), ForceMinus(k, l)
    same = _told(rules.rewrite(ON_SURFACE), plus, number * minus, where)
    return _told(rules.follows(same), plus / minus, number, where)


def _displaced(size: sympy.Expr) -> sympy.Eq:
    """That the origin, which stays where it is, has been displaced."""
    return equation(ORIGIN, size * e_y)


def _steps(count: sympy.Expr) -> sympy.Expr:
    return Sum(ONE, (n, 1, count))


# what is a statement

for name, side, where, false, refused in (
    ("a divisor", HERE / (j - 3), BEADS, "it vanishes in layer 3", "not shown to differ"),
    ("a divisor in n", HERE / (n_x - n_y), BEADS, "it vanishes at φ = 0", "not shown to differ"),
    ("a divisor that is zero", HERE / ((j + 1) ** 2 - j**2 - 2 * j - 1), BEADS,
     "0 has no inverse", "not shown to differ"),
    ("ε as a divisor", HERE / epsilon, BEADS, "it vanishes without disorder", "not shown to dif"),
    ("a divisor of first order", 1 / HERE, BEADS, "it vanishes at order 0", "holds a quantity"),
    ("a root", sympy.sqrt(phi) * HERE, BEADS, "φ may be negative", "the power 1/2 is not read"),
    ("a function", sympy.Abs(phi) * HERE, BEADS, "no rule is sound for it", "not in the language"),
    ("a float", sympy.Float(0.1) * HERE, BEADS, "it is no exact number", "not in the language"),
    ("symbols that do not commute", sympy.Symbol("x", commutative=False) * HERE, BEADS,
     "x y − y x would be 0", "not in the language"),
    ("an index undeclared", k * HERE, BEADS, "nobody says what k is", "does not say what k is"),
    ("a relation of an index undeclared", HERE, Where((i, j), (j >= 0, n >= 3), even=(i + j,)),
     "a sum over n would be taken from 3 on", "does not say what n is"),
    ("an index summed over and free", n * Sum(n, (n, 1, 2)), Where((n,)), "n has two meanings",
     "stands for itself as well"),
    ("an index summed over and declared", Sum(n, (n, 1, 2)), Where((n,), (n >= 2,)),
     "the term n = 1 would be left out", "two meanings of n"),
    ("an index summed over twice", Sum(n * Sum(n, (n, 1, 2)), (n, 1, 2)), BEADS,
     "n has two meanings", "two meanings of n"),
    ("a sum over i", Sum(i, (i, 1, 2)), Where(), "i is the place of a bead", "a sum over i"),
    ("a sum that may end below its start", Sum(ONE, (n, 3, j)), BEADS, "it would be −2 at j = 0",
     "more than one below"),
    ("a site off the lattice", DeltaR(i + 1, j), BEADS, "no bead is there", "not shown to be at a"),
    ("a site below the base", DeltaR(i - 1, j - 1), BEADS, "no bead is there", "not shown to be"),
    ("a site that is no place", DeltaR(i * j, j), BEADS, "no bead is there", "not a whole-number"),
    ("an empty domain", HERE, Where.of(j >= 0, j <= -1), "everything holds there", "nothing is in"),
    ("a domain without whole numbers", ONE, Where.of(2 * q >= 2 * p + 1, 2 * q <= 2 * p + 1),
     "everything holds there", "nothing is in"),
    ("the plane's vectors in space", n_plus, Where(dimension=3), "they are of the plane",
     "belongs to the plane"),
    ("one dimension", 1 / (1 + 2 * phi), Where(dimension=1), "φ may be −½ there", "two dimensions"),
    ("a name of the kernel's own", UNKNOWNS[1][0], BEADS, "it may stand for an unknown as well",
     "name of the kernel"),
    ("a quantity of one's own", type("DeltaR", (sy.SiteFunction,), {})(i, j), BEADS,
     "it would be taken for δr", "no quantity of a packing"),
):  # fmt: skip
    _attack("statement", name, false, refused)(lambda s=side, w=where: _checked(s, w))  # type: ignore[misc]

_attack("statement", "no equation", "it says nothing", "no equation")(
    lambda: check(sympy.Ge(j, 0), BEADS)
)
_attack("statement", "a theorem of one's own", "nobody has proved it", "made by the rules")(
    lambda: Theorem(_displaced(ONE), Where(), "of course")
)
_attack("statement", "a theorem changed", "nobody has proved it", "made by the rules")(
    lambda: replace(axioms.base(), formula=equation(DeltaX(i, 0), e_y))
)

# rewrite: normal forms, and what is put in

IN_TWO = Sum(Load(i - j + n, n), (n, j, j + 1))
"""The loads of a bead and of the next one along n⁺."""

SPLIT = _told(rules.rewrite(), Load(i, j), IN_TWO - Load(i + 1, j + 1))

for name, facts, left, right, where, false, refused in (
    ("two quantities", (), HERE, ABOVE, BEADS, "they are independent", "normal forms"),
    ("a change of first order", (), HERE, 0, BEADS, "radii differ", "normal forms"),
    ("ε in front of it", (), epsilon * HERE, HERE, BEADS, "ε is not 1", "normal forms"),
    ("one part of a vector", (), Dot(n_plus, n_minus) * n_plus, n_minus, BEADS,
     "only their parts along n⁺ agree", "normal forms"),
    ("a vector and a number", (), DeltaX(i, j), HERE, BEADS, "one is a vector", "equal to a v"),
    ("a number added to a vector", (), HERE + DeltaX(i, j), 0, BEADS, "one is a vector", "added"),
    ("a product of positions", (), Dot(Position(i, j), Position(i, j)), 0, BEADS,
     "positions are of order 0", "order 0"),
    ("a load times a change", (), Dot(e_y, Load(i, j)) * HERE, 0, BEADS, "loads are of order 0",
     "order 0"),
    ("a change times a load", (), HERE * Dot(e_y, Load(i, j)), 0, BEADS, "loads are of order 0",
     "order 0"),
    ("two forces", (), ForcePlus(i, j), ForceMinus(i, j), BEADS, "they differ", "normal forms"),
    ("forces of two beads", (), ForcePlus(i, j), ForcePlus(i + 1, j + 1), BEADS, "they differ",
     "normal forms"),
    ("two numbers", (), sympy.Symbol("a"), sympy.Symbol("a", positive=True), BEADS,
     "they have one name, and are not the same", "normal forms"),
    ("forces summed over", (), Sum(n * ForcePlus(i + 2 * n, j), (n, 1, 2)),
     Sum(3 * ForcePlus(i + 2 * n, j), (n, 1, 2)) / 2, BEADS, "f⁺ differs from bead to bead",
     "a force is summed over"),
    ("the base's law above it", (axioms.base(),), DeltaX(i, j), 0, BEADS, "only the base stays",
     "normal forms"),
    ("a law of odd places", (axioms.base(),), DeltaX(i + 1, 1), 0, AT_BASE, "that is layer 1",
     "normal forms"),
    ("a quantity of another kind", (axioms.base(),), Position(i, 0), 0, AT_BASE, "they lie apart",
     "normal forms"),
    ("a load beyond its domain", (ON_SURFACE,), Load(i, j), 0, TOP, "these are loaded", "normal"),
    ("a load's place", (ON_SURFACE,), Load(i, j), 0, Where.of(j >= 0, j <= M, loading=SURFACE),
     "the surface is loaded", "normal forms"),
    ("another loading", (ON_SURFACE,), ForcePlus(k, l), 0, Where.of(Eq(l, M), l >= 0), "it may be "
     "loaded from above", "normal forms"),
    ("another load's place", (ON_LOADED,), ForcePlus(i, j), 0,
     Where.of(j >= 0, l >= 0, loading=LOADED), "another bead has no force above it", "normal"),
    ("a loading at another height", (axioms.loads(SURFACE.put_in({M: M - 1})),), Load(i, j), 0,
     TOP, "surfaces at M and M − 1 differ", "normal forms"),
    ("a condition not discharged", (axioms.loads(LOADED_VERTICALLY),), ForcePlus(k, l), 0,
     Where.of(l >= 0), "the bead may carry others", "normal forms"),
    ("another dimension", (axioms.base(),), ORIGIN, 0,
     Where(dimension=3), "the axiom is of the plane", "normal forms"),
    ("a sum over an index of the domain", (SPLIT, ON_SURFACE), Load(i, j), f_load * e_y,
     Where.of(Eq(j, M - 1), n <= M - 1, n >= 0, j >= 0, loading=SURFACE),
     "it has no load; n ≤ M − 1 is said of another n", "normal forms"),
):  # fmt: skip
    _attack("rewrite", name, false, refused)(
        lambda f=facts, a=left, b=right, w=where: _told(rules.rewrite(*f), a, b, w)  # type: ignore[misc]
    )


@_attack("rewrite", "a divisor that is zero once put in", "0/0 has no value", "rational function")
def _() -> object:
    ratio = ForcePlus(i, j) / ForceMinus(i, j)
    return _told(rules.rewrite(ON_SURFACE), ratio, ratio, TOP)


@_attack(
    "rewrite", "a quantity times what may vanish", "n = 1 says nothing of it", "vanish nowhere"
)
def _() -> object:
    where = Where.of(j >= 0, Eq(n, 1))
    fact = _told(rules.rewrite(), (n - 1) * HERE, 0, where)
    return _told(rules.rewrite(fact), HERE, 0, where)


@_attack("rewrite", "a quantity times a force that vanishes", "0 = 0 says nothing of it", "vanish")
def _() -> object:
    squared = _told(rules.rewrite(ON_LOADED), DeltaR(k, l) * ForcePlus(k, l) ** 2, 0, AT_LOAD)
    return _told(rules.rewrite(squared), DeltaR(k, l), 0, AT_LOAD)


@_attack("rewrite", "a force over itself that vanishes", "0/0 is not 1", "may vanish")
def _() -> object:
    five = _over_itself(DeltaR(k, l), 5)
    return _told(rules.rewrite(five), DeltaR(k, l), 5, AT_LOAD)


@_attack("rewrite", "a square of a force over itself", "0/0 is not 1", "vanish nowhere")
def _() -> object:
    force = times(ForcePlus(k, l) ** 2, Pow(ForcePlus(k, l), -2))
    ratio = _told(
        rules.follows(_no_force(DeltaR(k, l) - 5)), times(DeltaR(k, l), force), 5, AT_LOAD
    )
    return _told(rules.rewrite(ratio), DeltaR(k, l), 5, AT_LOAD)


def _over_itself(quantity: sympy.Expr, number: int) -> Theorem:
    """quantity = number · f⁺/f⁺, where f⁺ vanishes: both sides times f⁺ are zero."""
    ratio = times(Integer(number), ForcePlus(k, l), Pow(ForcePlus(k, l), -1))
    return _told(rules.follows(_no_force(quantity - number)), quantity, ratio, AT_LOAD)


# follows

for name, source, left, right, where, false, refused in (
    ("another equation", axioms.base(), DeltaX(i, 0), n_plus, AT_BASE, "it stays", "no multiple"),
    ("nothing at all", axioms.base(), HERE, ABOVE, BEADS, "they are independent", "not hold on"),
    ("a larger domain", ON_SURFACE[0], Load(site_r, site_s), 0,
     Where.of(site_s >= 0, loading=SURFACE), "the surface is loaded", "on all of its domain"),
    ("another loading", ON_SURFACE[0], Load(site_r, site_s), 0,
     Where.of(site_s >= 0, site_s <= M - 1), "they may be loaded", "on all of its domain"),
    ("0 = 0", _told(rules.rewrite(), HERE, HERE), HERE, ABOVE, BEADS, "they are independent",
     "no multiple"),
    ("one part of a vector", axioms.base(), DeltaX(i, 0), Dot(n_plus, DeltaX(i, 0)) * b_plus
     + n_plus, AT_BASE, "it has another part", "no multiple"),
    ("a number from a vector", axioms.base(), Dot(e_y, DeltaX(i, 0)), 0, AT_BASE,
     "they are not of one kind", "a number, the other a vector"),
):  # fmt: skip
    _attack("follows", name, false, refused)(
        lambda t=source, a=left, b=right, w=where: _told(rules.follows(t), a, b, w)  # type: ignore[misc]
    )


@_attack("follows", "times what vanishes somewhere", "it says nothing where j = 3", "no multiple")
def _() -> object:
    zero = _told(rules.rewrite(), (j - 3) * HERE, 0, Where.of(Eq(j, 3)))
    return _told(rules.follows(zero), HERE, 0, Where.of(Eq(j, 3)))


@_attack("follows", "divided by what vanishes", "0 = 0 follows from anything", "no multiple")
def _() -> object:
    zero = _told(rules.rewrite(), (n - m) * HERE, (n - m) * ABOVE, Where.of(j >= 0, Eq(n, m)))
    return _told(rules.follows(zero), HERE, ABOVE, Where.of(j >= 0, Eq(n, m)))


@_attack("follows", "divided by a force that vanishes", "0 = 0 says nothing of δr", "no multiple")
def _() -> object:
    return _told(rules.follows(_no_force(DeltaR(k, l))), DeltaR(k, l), 0, AT_LOAD)


@_attack("follows", "from a force over another, both being zero", "17 is not 18", "not divide by")
def _() -> object:
    where = Where.of(Eq(l, M), l >= 0, loading=SURFACE)
    return _told(rules.follows(_over_no_force(18), _over_no_force(17)), Integer(17), 18, where)


# components, orders


@_attack("along", "along no vector", "half of a vector is no component", "no base vector")
def _() -> object:
    return rules.along(axioms.base(), phi)


def _contact(power: int, left: sympy.Expr, where: Where | None = None) -> Theorem:
    contact = axioms.contact(1)
    return _told(rules.order(contact, power), left, 0, where or contact.where)


def _stretched() -> sympy.Expr:
    left, right = axioms.contact(1).formula.args
    return sympy.expand(left - right).coeff(epsilon, 1)


_attack("order", "another order", "order 0 says nothing of δx", "not the order 0")(
    lambda: _contact(0, _stretched())
)
_attack("order", "beyond all orders", "it says 0 = 0", "not the order 9")(lambda: _contact(9, HERE))
_attack("order", "on a larger domain", "beads of the base touch none below", "domains differ")(
    lambda: _told(rules.order(axioms.contact(1), 0), ONE, 1, Where.of(j >= 0))
)


@_attack("order", "a force over itself that vanishes", "0/0 is not 1", "not the order 0")
def _() -> object:
    return _told(rules.order(_over_itself(DeltaR(k, l), 5), 0), DeltaR(k, l), 5, AT_LOAD)


# solve

SUPPORT, WEIGHT = Position(i, j), 2 * r * n_plus
STEP_UP = axioms.ordered()[1]
NEXT = Position(i + 1, j + 1)


def _cartesian() -> Theorem:
    """A step up along n⁺, written with the unit matrix."""
    unit = MatrixTimes(1, 0, 0, 1, NEXT - SUPPORT)
    return _told(rules.follows(STEP_UP), unit, WEIGHT)


MIXED = Dot(n_plus, SUPPORT + WEIGHT) * e_x + Dot(n_minus, SUPPORT + WEIGHT) * e_y
ALONG_X = _told(rules.follows(rules.along(STEP_UP, n_plus)), Dot(n_plus, NEXT - SUPPORT), 2 * r)

for name, rows, unknowns, left, right, where, false, refused in (
    ("no rows", (), (HERE,), HERE, 0, BEADS, "nothing fixes it", "0 equations for 1"),
    ("no unknowns", (), (), HERE, 0, BEADS, "nothing fixes it", "not what is solved for"),
    ("too few rows", (ALONG_X,), (NEXT,), NEXT, SUPPORT + WEIGHT, BEADS,
     "one part of it is not fixed", "1 equations for 2"),
    ("one row twice", (ALONG_X, ALONG_X), (NEXT,), NEXT, SUPPORT + WEIGHT, BEADS,
     "one part of it is not fixed", "vanish nowhere"),
    ("a row that does not hold", (axioms.base(),), (DeltaX(i, j),), DeltaX(i, j), 0, BEADS,
     "only the base stays", "does not hold on all"),
    ("another solution", (STEP_UP,), (NEXT,), NEXT, SUPPORT, BEADS, "it is above", "not the solu"),
    ("another unknown", (STEP_UP,), (NEXT,), SUPPORT, NEXT, BEADS, "it is below", "solved for"),
    ("a number for a vector", (STEP_UP,), (NEXT,), NEXT, 2 * r, BEADS, "it is no vector",
     "equal to a vector"),
    ("components of another basis", (_cartesian(),), (NEXT,), NEXT, MIXED, BEADS,
     "e_x and e_y are not b⁺ and b⁻", "not the solution"),
    ("what it is solved for on both sides", (STEP_UP,), (NEXT,), NEXT, 2 * NEXT - SUPPORT - WEIGHT,
     BEADS, "it says what it is from itself", "not one quantity"),
):  # fmt: skip
    _attack("solve", name, false, refused)(
        lambda rs=rows, u=unknowns, a=left, b=right, w=where: _told(rules.solve(rs, u), a, b, w)  # type: ignore[misc]
    )


def _solved(row: Theorem, wrong: sympy.Expr | int, where: Where) -> Theorem:
    about = DeltaR(*(where.loading.place if where.loading else (i, j)))
    return _told(rules.solve([row], [about]), about, wrong, where)


@_attack("solve", "times what vanishes somewhere", "it says nothing where j = 3", "vanish nowhere")
def _() -> object:
    where = Where.of(Eq(j, 3))
    return _solved(_told(rules.rewrite(), (j - 3) * HERE, 0, where), 0, where)


@_attack("solve", "times a force that vanishes", "0 = 0 says nothing of δr", "vanish nowhere")
def _() -> object:
    return _solved(_no_force(DeltaR(k, l)), 0, AT_LOAD)


@_attack("solve", "a row divided by a force that vanishes", "0/0 is not 1", "divides by a force")
def _() -> object:
    return _solved(_over_itself(DeltaR(k, l), 5), 5, AT_LOAD)


@_attack("solve", "a determinant of first order", "changes have no inverse", "vanish nowhere")
def _() -> object:
    first = _told(rules.rewrite(), HERE * ABOVE, 0, BEADS)
    return _solved(first, 0, BEADS)


@_attack("solve", "a square", "±1 solve it, and so does 0 = 0", "not linear")
def _() -> object:
    row = _told(rules.rewrite(ON_LOADED), ForcePlus(k, l) ** 2 + ForcePlus(k, l), 0, AT_LOAD)
    return _told(rules.solve([row], [ForcePlus(k, l)]), ForcePlus(k, l), 0, AT_LOAD)


@_attack("solve", "a product of unknowns", "two rows fix more than one pair", "not linear")
def _() -> object:
    where = Where.of(Eq(l, M), l >= 0, loading=SURFACE)
    plus, minus = ForcePlus(k, l), ForceMinus(k, l)
    rows = [
        _told(rules.rewrite(ON_SURFACE), plus * minus + plus, 0, where),
        _told(rules.rewrite(ON_SURFACE), minus, 0, where),
    ]
    return _told(rules.solve(rows, [plus, minus]), plus, 0, where)


# below

BALANCE = axioms.balance()

_attack("below", "no contact force", "a balance fixes two forces", "no contact force")(
    lambda: _told(rules.below(BALANCE), HERE, 0)
)
_attack("below", "under a bead with a load", "it carries that load", "not the solution")(
    lambda: _told(
        rules.below(BALANCE, ON_SURFACE),
        ForcePlus(i, j),
        0,
        Where.of(j >= 0, Eq(j, M - 1), loading=SURFACE),
    )
)
_attack("below", "the mirror image's", "it is f_load/2n_y to order 0 only", "not the solution")(
    lambda: _told(
        rules.below(BALANCE, ON_SURFACE),
        ForcePlus(i, j),
        f_load / (2 * n_y),
        Where.of(j >= 0, Eq(j, M - 1), loading=SURFACE),
    )
)

# cases


def _in_cases(formula: sympy.Eq, where: Where, *parts: sympy.Basic, rule: Rule) -> Theorem:
    return rules.cases(rule, *((one,) for one in parts))(formula, where)


NO_LOAD = equation(Load(i, j), 0)
WITH_TOP = Where.of(j >= 0, j <= M, loading=SURFACE)

for name, parts, false in (
    ("the top is left out", (j <= M - 1,), "the surface is loaded"),
    ("one layer is left out", (j <= M - 1, j >= M + 1), "the surface is loaded"),
    ("no case", (), "the surface is loaded"),
):
    _attack("cases", name, false, "leave something")(
        lambda c=parts: _in_cases(NO_LOAD, WITH_TOP, *c, rule=rules.rewrite(ON_SURFACE))  # type: ignore[misc]
    )
_attack("cases", "one case is not proved", "the surface is loaded", "normal forms")(
    lambda: _in_cases(NO_LOAD, WITH_TOP, j <= M - 1, Eq(j, M), rule=rules.rewrite(ON_SURFACE))
)
_attack("cases", "of an index of sums", "n is bound", "does not say what n is")(
    lambda: _in_cases(
        equation(IN_TWO, 0),
        Where.of(Eq(j, M - 1), j >= 0, loading=SURFACE),
        n <= M - 1,
        n >= M,
        rule=rules.rewrite(ON_SURFACE),
    )
)


def _another(_formula: sympy.Eq, _where: Where) -> Theorem:
    """A rule that proves another statement."""
    return axioms.base()


def _fewer(formula: sympy.Eq, where: Where) -> Theorem:
    """A rule that proves it on another domain."""
    return rules.walk({i: k}, {i: i - 1}, q)(formula, where)


PLACE, COUNTED = equation(i, k - q), Where.of(q >= 0, indices=(i, k))

_attack("cases", "by a rule that proves another statement", "it is none of i", "another statement")(
    lambda: _in_cases(equation(DeltaX(i, j), 0), BEADS, j >= 0, rule=_another)
)
_attack("cases", "by a rule that adds to the domain", "i is any place", "another statement")(
    lambda: _in_cases(PLACE, COUNTED, q >= 0, rule=_fewer)
)

# instance


def _moved(theorem: Theorem, where: Where, **image: sympy.Expr) -> Theorem:
    return rules.instance(theorem, {getattr(sy, name): to for name, to in image.items()}, where)


for name, theorem, image, where, false, refused in (
    ("out of its domain", axioms.contact(1), {"j": Integer(0)}, Where((i,), even=(i,)),
     "beads of the base touch none below", "does not hold there"),
    ("off the lattice", axioms.contact(1), {"i": i + 1}, Where.of(j >= 1), "no bead is there",
     "does not hold there"),
    ("what is no index", axioms.contact(1), {"phi": ONE}, Where.of(j >= 1), "φ is below ½",
     "does not hold there"),
    ("an index that is summed over", _told(rules.rewrite(), Sum(i, (n, 1, 2)), Sum(i, (n, 0, 1)),
     Where((i,))), {"i": n}, Where((i,)), "1 + 2 is not 0 + 1", "none of the domain"),
    ("under another loading", ON_SURFACE[0], {}, Where.of(site_s >= 0, site_s <= M - 1),
     "it may be loaded", "does not hold there"),
    ("with another load's place", ON_LOADED[0], {"k": k + 1, "l": l + 1}, AT_LOAD,
     "that bead has forces above it", "does not hold there"),
):  # fmt: skip
    _attack("instance", name, false, refused)(
        lambda t=theorem, to=image, w=where: _moved(t, w, **to)  # type: ignore[misc]
    )


@_attack("instance", "where a ratio of forces that vanish becomes 1", "1 is not 17", "is lost")
def _() -> object:
    where = Where.of(l <= M, l >= M, j <= M, j >= M, l >= 0, loading=SURFACE)
    plus = _told(rules.rewrite(ON_SURFACE), ForcePlus(k, l), 17 * ForcePlus(i, j), where)
    ratio = _told(rules.follows(plus), ForcePlus(k, l) / ForcePlus(i, j), 17, where)
    return rules.instance(ratio, {k: i, l: j}, Where.of(Eq(j, M), j >= 0, loading=SURFACE))


# in terms of other indices


def _in_terms(
    image: dict[sympy.Symbol, sympy.Expr],
    back: dict[sympy.Symbol, sympy.Expr],
    other: Where,
    where: Where,
    formula: sympy.Eq = NO_LOAD,
    rule: Rule | None = None,
) -> Theorem:
    rule = rule or rules.rewrite(ON_SURFACE)
    return rules.in_terms_of(image, back, other, rule)(formula, where)


BY_DEPTH = {j: M - q}

for name, image, back, other, where, false, refused in (
    ("that leave the top out", BY_DEPTH, {q: M - j},
     Where.of(q >= 1, q <= M, loading=SURFACE, indices=(i,)), WITH_TOP, "it is loaded", "reach"),
    ("that are not those of the statement", {j: j - 1}, {j: j}, BELOW, BELOW,
     "j − 1 does not reach M − 1", "do not reach"),
    ("without saying what becomes of one", {}, {j: j - 1}, BELOW, WITH_TOP, "it is loaded",
     "do not reach"),
    ("an index from nowhere", {}, {}, BELOW.also(q <= 3, indices=(q,)), BELOW.also(q <= 3,
     indices=(q,)).put_in({q: Integer(9)}, (i, j, M)), "q is any number", "nothing"),
    ("another loading", {}, {}, BELOW, BELOW.loaded(None), "it may be loaded", "packings differ"),
    ("another load's place", {j: j - 1, M: M - 1}, {j: j + 1, M: M + 1}, BELOW,
     Where.of(j >= -1, j <= M - 1, loading=SURFACE), "surfaces at M and M + 1 differ", ""),
    ("another dimension", {}, {}, BELOW, replace(BELOW, dimension=3), "these are disks",
     "packings differ"),
    ("what is no index", {phi: ONE}, {}, BELOW, BELOW, "φ is below ½", "no index of the domain"),
    ("beads where there are none", {}, {}, replace(BELOW, even=(i + j + 1,)), BELOW,
     "beads are where i + j is even", "do not reach"),
):  # fmt: skip
    _attack("in_terms_of", name, false, refused)(
        lambda to=image, b=back, o=other, w=where: _in_terms(to, b, o, w)  # type: ignore[misc]
    )
_attack(
    "in_terms_of", "by a rule that proves another statement", "beads move", "another statement"
)(lambda: _in_terms({}, {}, BEADS, BEADS, equation(DeltaX(i, j), 0), _another))

# mirror

for name, left, right, where, false in (
    ("an index across the packing", i * HERE, DeltaR(i, j) * i, BEADS, "i becomes −i"),
    ("a sum up to it", Sum(HERE, (n, 1, i)), i * HERE, Where.of(j >= 0, i >= 0), "i becomes −i"),
    ("a matrix", MatrixTimes(0, 1, 0, 0, DeltaX(i, j)), Dot(e_y, DeltaX(i, j)) * e_x, BEADS,
     "its entries change their signs"),
):  # fmt: skip
    _attack("mirror", name, false, "beside its places")(
        lambda a=left, b=right, w=where: rules.mirror(_told(rules.rewrite(), a, b, w))  # type: ignore[misc]
    )


@_attack("mirror", "the domain as it was", "f⁻ is none of it", "on all of its domain")
def _() -> object:
    where = Where.of(j >= 0, j <= k - i, indices=(k, l))
    mirrored = rules.mirror(_told(rules.rewrite(), ForcePlus(i, j), ForcePlus(i, j) + 0, where))
    other = _told(rules.rewrite(), HERE, HERE, where)
    return mirrored, _told(rules.follows(rules.mirror(other)), HERE, ABOVE, where)


@_attack("mirror", "a load from one side", "f⁺ enters, f⁻ does not", "on all of its domain")
def _() -> object:
    where = Where.of(Eq(site_s, l - 1), site_s >= 0, loading=ENTERING)
    beside = next(one for one in axioms.loads(ENTERING) if one.formula.lhs.func is ForceMinus)
    return _told(rules.follows(rules.mirror(beside)), ForcePlus(site_r, site_s), 0, where)


@_attack("mirror", "what is supposed of one place", "it is not supposed of −i", "one place across")
def _() -> object:
    return rules.mirror(rules.suppose(equation(HERE, 0), BEADS, Supposition(i), 2))


# induct: what is said of the origin is false but for 0

STAYS = rules.rewrite(axioms.base())
COUNT = Where.of(q >= 0)


def _by_itself(moved: dict[sympy.Symbol, sympy.Expr]) -> Callable[[tuple[Theorem, ...]], Rule]:
    """A step that takes the statement itself from what is supposed."""

    def step(supposed: tuple[Theorem, ...]) -> Rule:
        return lambda formula, where: rules.follows(
            rules.instance(supposed[0], moved, where) if moved else supposed[0]
        )(formula, where)

    return step


def _supposed(supposed: tuple[Theorem, ...]) -> Rule:
    return rules.rewrite(*supposed)


def _by_shift(supposed: tuple[Theorem, ...]) -> Rule:
    return rules.in_terms_of({q: q - 1}, {q: q + 1}, Where.of(q >= 1), rules.follows(supposed[0]))


def _never(_supposed: tuple[Theorem, ...]) -> Rule:
    return rules.rewrite()


for name, size, where, over, start, base, step, false, refused in (
    ("no step", _steps(q), COUNT, q, 0, STAYS, _never, "it moves at q = 1", "normal forms"),
    ("no base", q + 1, COUNT, q, 0, STAYS, _by_itself({}), "it moves at q = 0", "normal forms"),
    ("what is supposed for the next", _steps(q), COUNT, q, 0, STAYS, _by_itself({q: q + 1}),
     "q − 1 says nothing of q", "does not hold there"),
    ("what is supposed in other indices", _steps(q), COUNT, q, 0, STAYS, _by_shift,
     "q − 1 says nothing of q", "put elsewhere"),
    ("a start beyond the domain's", q * (q + 1) * (q - 1), Where.of(q >= -9), q, 0, STAYS,
     _supposed, "it moves at q = −5", "goes beyond"),
    ("an index that is none", _steps(p), Where.of(p >= 0), q, 0, STAYS, _never,
     "it moves at p = 1", "goes beyond"),
    ("a step by a rule that proves another statement", _steps(q), COUNT, q, 0, STAYS,
     lambda _: _another, "it moves at q = 1", "another statement"),
    ("a base by a rule that proves another statement", q + 1, COUNT, q, 0, _another,
     lambda _: _another, "it moves at q = 0", "another statement"),
):  # fmt: skip
    _attack("induct", name, false, refused)(
        lambda s=size, w=where, o=over, a=start, b=base, t=step: rules.induct(  # type: ignore[misc]
            o, Integer(a), b, t
        )(_displaced(s), w)
    )


@_attack("induct", "down, beyond its start", "it moves at q = 5", "goes beyond")
def _() -> object:
    rule = rules.induct(q, Integer(0), STAYS, _by_itself({}), down=True)
    return rule(_displaced(q), COUNT)


@_attack("induct", "down, from a start that is put elsewhere", "M + 1 is further up", "not hold")
def _() -> object:
    rule = rules.induct(p, M - 1, STAYS, _by_itself({M: M + 1}), down=True)
    return rule(_displaced(_steps(M - 1 - p)), Where.of(p >= 0, p <= M - 1))


@_attack("induct", "a member of the family that is not proved", "radii differ", "normal forms")
def _() -> object:
    family = ((equation(DeltaR(k, l), 0), Where.of(l >= 0, q >= 0, indices=(k,))),)
    return rules.induct(q, Integer(0), STAYS, _never, family=family)(_displaced(Integer(0)), COUNT)


@_attack("induct", "one within another, at other places of the first", "it moves at 2", "within")
def _() -> object:
    def outer(supposed: tuple[Theorem, ...]) -> Rule:
        def first(formula: sympy.Eq, where: Where) -> Theorem:
            if Eq(q, 1) in where.relations:
                return STAYS(formula, where)
            return rules.follows(rules.instance(supposed[0], {p: ONE}, where))(formula, where)

        base = rules.cases(first, (Eq(q, 1),), (q >= 2,))
        return rules.induct(p, Integer(0), base, _by_itself({q: q + 1}))

    rule = rules.induct(q, Integer(0), rules.cases(STAYS, (Eq(p, 0),)), outer)
    return rule(_displaced((p + q) * (p + q - 1)), Where.of(p >= 0, q >= 0, p <= 4 * q))


@_attack("induct", "what was supposed in another one", "it holds in that one alone", "within")
def _() -> object:
    kept: list[Theorem] = []

    def leak(supposed: tuple[Theorem, ...]) -> Rule:
        kept.extend(supposed)
        return rules.rewrite(axioms.base())

    rules.induct(q, Integer(0), STAYS, leak)(_displaced(Integer(0)), COUNT)
    wrong = rules.suppose(_displaced(ONE), COUNT, Supposition(q), 1)
    step = rules.follows(wrong, kept[0])
    return rules.induct(q, Integer(1), STAYS, lambda _: step)(_displaced(q - 1), Where.of(q >= 1))


# reach, walk, inverse, differentiate

ORDERED = axioms.ordered()
EQ_1 = r * (j + i) * n_plus + r * (j - i) * n_minus


def _reached(value: sympy.Expr, origin: Theorem, *up: Theorem) -> Theorem:
    return _told(rules.reach(origin, up), Position(i, j), value)


def _on_layer_5() -> list[Theorem]:
    where = Where.of(Eq(j, 5))
    return [rules.follows(one)(one.formula, where) for one in ORDERED[1:]]


for name, value, axiom, false, refused in (
    ("other steps", 2 * EQ_1, ORDERED, "they are twice as long", "does not obey"),
    ("another origin", EQ_1 + n_plus, ORDERED, "(0, 0) is the origin", "does not obey"),
    ("one step alone", r * (j + i) * n_plus, ORDERED[:2], "(−1, 1) is never reached", "not reach"),
    ("no origin", EQ_1 + n_plus, (ORDERED[1], *ORDERED[1:]), "it is anywhere", "not reach every"),
    ("steps from one layer", EQ_1 + j * (j - 11) * r * n_plus, (ORDERED[0], *_on_layer_5()),
     "others are never reached", "not reach every"),
):  # fmt: skip
    _attack("reach", name, false, refused)(
        lambda v=value, a=axiom: _reached(v, *a)  # type: ignore[misc]
    )
_attack("reach", "of one bead", "it says nothing of others", "not about")(
    lambda: _told(rules.reach(ORDERED[0], ORDERED[1:]), Position(i + 2, j), EQ_1)
)

for name, value, start, step, where, false, refused in (
    ("other steps", k - 2 * q, {i: k}, {i: i - 1}, COUNTED, "each is one place", "lead there"),
    ("another start", k - 1 - q, {i: k}, {i: i - 1}, COUNTED, "it starts at k", "not lead there"),
    ("another index", k - q, {j: k}, {j: j - 1}, COUNTED, "nothing is said of i", "no index of"),
    ("without a step for it", k - q, {i: k}, {}, COUNTED, "nothing is said of i", "no index of"),
    ("a site by itself", i, {i: i}, {i: i}, COUNTED, "it says nothing", "by the number of steps"),
):  # fmt: skip
    _attack("walk", name, false, refused)(
        lambda v=value, a=start, b=step, w=where: _told(rules.walk(a, b, q), i, v, w)  # type: ignore[misc]
    )


def _inverse(entries: list[list[sympy.Expr]], other: list[list[sympy.Expr]]) -> Theorem:
    matrix = Pow(sympy.ImmutableMatrix(entries), -1, evaluate=False)
    return rules.inverse(equation(matrix, sympy.ImmutableMatrix(other)), Where())


_attack("inverse", "another matrix", "their product is not 1", "normal forms")(
    lambda: _inverse([[n_x, n_y], [-n_x, n_y]], [[n_x, n_y], [-n_x, n_y]])
)
_attack("inverse", "no inverse", "a matrix is not its own", "no inverse matrix")(
    lambda: rules.inverse(equation(sympy.eye(2), sympy.eye(2)), Where())
)
_attack("inverse", "of a number", "it is no matrix", "no inverse matrix")(
    lambda: rules.inverse(equation(1 / (2 * r), 1 / (2 * r)), Where())
)
_attack("inverse", "where it has none", "φ vanishes somewhere", "not shown to differ")(
    lambda: _inverse([[phi]], [[1 / phi]])
)

LENGTH = sympy.Symbol("x", real=True)
SQUARE = LENGTH**2 + 1

for name, left, right, root, square, where, false, refused in (
    ("another derivative", sympy.Derivative(sympy.sqrt(SQUARE), LENGTH), LENGTH / SQUARE, ROOT,
     SQUARE, Where(), "it is x over the root", "derivatives differ"),
    ("a root of one's own", sympy.sqrt(2), r, r, Integer(2), Where(), "r is any radius",
     "not the root"),
    ("a root that may be negative", sympy.sqrt(SQUARE), -sympy.sqrt(SQUARE),
     sympy.Symbol("root"), SQUARE, Where(), "roots are positive", "not the root"),
    ("the root of what may be negative", sympy.sqrt(phi) / phi, phi ** sympy.Rational(-1, 2),
     ROOT, phi, Where(), "φ may vanish", "not the root"),
    ("what SymPy cancels", times(phi, Pow(phi, -1)), ONE, ROOT, SQUARE, Where(),
     "0/0 is not 1", "not shown to differ"),
    ("what SymPy sums", Sum(n, (n, 1, j)), j * (j + 1) / 2, ROOT, SQUARE, Where.of(j >= -5),
     "the sum may end below its start", "more than one below"),
):  # fmt: skip
    _attack("differentiate", name, false, refused)(
        lambda a=left, b=right, o=root, s=square, w=where: _told(  # type: ignore[misc]
            rules.differentiate(o, s), a, b, w
        )
    )
