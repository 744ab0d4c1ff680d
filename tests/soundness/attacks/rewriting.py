"""Attacks on ``rewrite``, ``follows``, ``along`` and ``order``."""

import sympy
from force_diffusion.symbolic.as_printed import times
from force_diffusion.symbolic.kernel import axioms, rules
from force_diffusion.symbolic.kernel.theorem import Theorem
from force_diffusion.symbolic.kernel.where import LOADED, LOADED_VERTICALLY, PASSING, SURFACE, Where
from force_diffusion.symbolic.symbols import (
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
    site_r,
    site_s,
)
from sympy import Eq, Integer, Pow, Sum

from .attack import (
    ABOVE,
    AT_BASE,
    AT_LOAD,
    BEADS,
    HERE,
    IN_TWO,
    NO_SITE,
    ON_LOADED,
    ON_SURFACE,
    ONE,
    ORIGIN,
    TOP,
    attack,
    no_force,
    over_itself,
    over_no_force,
    told,
)

# rewrite: normal forms, and what is put in

SPLIT = told(rules.rewrite(), Load(i, j), IN_TWO - Load(i + 1, j + 1))

for name, facts, left, right, where, false, refused in (
    ("no statement", (), NO_SITE, NO_SITE, BEADS, "no bead is there", "not shown to be at a bead"),
    ("two quantities", (), HERE, ABOVE, BEADS, "they are independent", "normal forms"),
    ("a change of first order", (), HERE, 0, BEADS, "radii differ", "normal forms"),
    ("ε in front of it", (), epsilon * HERE, HERE, BEADS, "ε is not 1", "normal forms"),
    ("one part of a vector", (), Dot(n_plus, n_minus) * n_plus, n_minus, BEADS,
     "only their parts along n⁺ agree", "normal forms"),
    ("a vector and a number", (), DeltaX(i, j), HERE, BEADS, "one is a vector", "equal to a v"),
    ("a vector that is zero and a number", (), (n_x**2 + n_y**2 - 1) * n_plus, HERE, BEADS,
     "radii differ", "equal to a vector"),
    ("more forces than can be told apart", (), sympy.Add(*(ForcePlus(i + 2 * a, j) for a in
     range(9))), 0, BEADS, "they act", "too many unknown"),
    ("a sum where all indices of sums are taken", (SPLIT,), Load(i, j), Load(i, j),
     BEADS.also(m >= 0, n >= 0, indices=(m, n, p, q)), "one of them would have two meanings",
     "two meanings"),
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
    ("a condition that facts contradict", (axioms.loads(PASSING), ON_SURFACE), Load(i, j), 0, TOP,
     "the surface is loaded", "normal forms"),
    ("another dimension", (axioms.base(),), ORIGIN, 0,
     Where(dimension=3), "the axiom is of the plane", "normal forms"),
    ("a sum over an index of the domain", (SPLIT, ON_SURFACE), Load(i, j), f_load * e_y,
     Where.of(Eq(j, M - 1), n <= M - 1, n >= 0, j >= 0, loading=SURFACE),
     "it has no load; n ≤ M − 1 is said of another n", "normal forms"),
):  # fmt: skip
    attack("rewrite", name, false, refused)(
        lambda f=facts, a=left, b=right, w=where: told(rules.rewrite(*f), a, b, w)  # type: ignore[misc]
    )


@attack("rewrite", "a divisor that is zero once put in", "0/0 has no value", "rational function")
def _() -> object:
    ratio = ForcePlus(i, j) / ForceMinus(i, j)
    return told(rules.rewrite(ON_SURFACE), ratio, ratio, TOP)


@attack("rewrite", "a quantity times what may vanish", "n = 1 says nothing of it", "vanish nowhere")
def _() -> object:
    where = Where.of(j >= 0, Eq(n, 1))
    fact = told(rules.rewrite(), (n - 1) * HERE, 0, where)
    return told(rules.rewrite(fact), HERE, 0, where)


@attack("rewrite", "a quantity times a force that vanishes", "0 = 0 says nothing of it", "vanish")
def _() -> object:
    squared = told(rules.rewrite(ON_LOADED), DeltaR(k, l) * ForcePlus(k, l) ** 2, 0, AT_LOAD)
    return told(rules.rewrite(squared), DeltaR(k, l), 0, AT_LOAD)


@attack("rewrite", "a force over itself that vanishes", "0/0 is not 1", "may vanish")
def _() -> object:
    five = over_itself(DeltaR(k, l), 5)
    return told(rules.rewrite(five), DeltaR(k, l), 5, AT_LOAD)


@attack("rewrite", "a square of a force over itself", "0/0 is not 1", "vanish nowhere")
def _() -> object:
    force = times(ForcePlus(k, l) ** 2, Pow(ForcePlus(k, l), -2))
    ratio = told(rules.follows(no_force(DeltaR(k, l) - 5)), times(DeltaR(k, l), force), 5, AT_LOAD)
    return told(rules.rewrite(ratio), DeltaR(k, l), 5, AT_LOAD)


# follows

for name, source, left, right, where, false, refused in (
    ("another equation", axioms.base(), DeltaX(i, 0), n_plus, AT_BASE, "it stays", "no multiple"),
    ("no statement", axioms.base(), DeltaX(i, 0) + e_y * DeltaR(i + 1, 0), e_y * DeltaR(i + 1, 0),
     AT_BASE, "no bead is there", "not shown to be at a bead"),
    ("nothing at all", axioms.base(), HERE, ABOVE, BEADS, "they are independent", "not hold on"),
    ("a larger domain", ON_SURFACE[0], Load(site_r, site_s), 0,
     Where.of(site_s >= 0, loading=SURFACE), "the surface is loaded", "on all of its domain"),
    ("another loading", ON_SURFACE[0], Load(site_r, site_s), 0,
     Where.of(site_s >= 0, site_s <= M - 1), "they may be loaded", "on all of its domain"),
    ("0 = 0", told(rules.rewrite(), HERE, HERE), HERE, ABOVE, BEADS, "they are independent",
     "no multiple"),
    ("one part of a vector", axioms.base(), DeltaX(i, 0), Dot(n_plus, DeltaX(i, 0)) * b_plus
     + n_plus, AT_BASE, "it has another part", "no multiple"),
    ("a number from a vector", axioms.base(), Dot(e_y, DeltaX(i, 0)), 0, AT_BASE,
     "they are not of one kind", "a number, the other a vector"),
):  # fmt: skip
    attack("follows", name, false, refused)(
        lambda t=source, a=left, b=right, w=where: told(rules.follows(t), a, b, w)  # type: ignore[misc]
    )


@attack("follows", "times what vanishes somewhere", "it says nothing where j = 3", "no multiple")
def _() -> object:
    zero = told(rules.rewrite(), (j - 3) * HERE, 0, Where.of(Eq(j, 3)))
    return told(rules.follows(zero), HERE, 0, Where.of(Eq(j, 3)))


@attack("follows", "divided by what vanishes", "0 = 0 follows from anything", "no multiple")
def _() -> object:
    zero = told(rules.rewrite(), (n - m) * HERE, (n - m) * ABOVE, Where.of(j >= 0, Eq(n, m)))
    return told(rules.follows(zero), HERE, ABOVE, Where.of(j >= 0, Eq(n, m)))


@attack("follows", "divided by a force that vanishes", "0 = 0 says nothing of δr", "no multiple")
def _() -> object:
    return told(rules.follows(no_force(DeltaR(k, l))), DeltaR(k, l), 0, AT_LOAD)


@attack("follows", "from a force over another, both being zero", "17 is not 18", "not divide by")
def _() -> object:
    where = Where.of(Eq(l, M), l >= 0, loading=SURFACE)
    return told(rules.follows(over_no_force(18), over_no_force(17)), Integer(17), 18, where)


# components, orders


@attack("along", "along no vector", "half of a vector is no component", "no base vector")
def _() -> object:
    return rules.along(axioms.base(), phi)


def _contact(power: int, left: sympy.Expr, where: Where | None = None) -> Theorem:
    contact = axioms.contact(1)
    return told(rules.order(contact, power), left, 0, where or contact.where)


def _stretched() -> sympy.Expr:
    left, right = axioms.contact(1).formula.args
    return sympy.expand(left - right).coeff(epsilon, 1)


attack("order", "another order", "order 0 says nothing of δx", "not the order 0")(
    lambda: _contact(0, _stretched())
)
attack("order", "no statement", "no bead is there", "not shown to be at a bead")(
    lambda: told(rules.order(axioms.contact(1), 2), NO_SITE, NO_SITE, Where.of(j >= 1))
)
attack("order", "beyond all orders", "it says 0 = 0", "not the order 9")(lambda: _contact(9, HERE))
attack("order", "on a larger domain", "beads of the base touch none below", "domains differ")(
    lambda: told(rules.order(axioms.contact(1), 0), ONE, 1, Where.of(j >= 0))
)


@attack("order", "a force over itself that vanishes", "0/0 is not 1", "not the order 0")
def _() -> object:
    return told(rules.order(over_itself(DeltaR(k, l), 5), 0), DeltaR(k, l), 5, AT_LOAD)
