"""What holds is proved: a true example of each rule of the kernel, and what it then rests on."""

from collections.abc import Callable

import pytest
import sympy
from force_diffusion.symbolic.as_printed import equation
from force_diffusion.symbolic.kernel import axioms, rules
from force_diffusion.symbolic.kernel.rules import Rule
from force_diffusion.symbolic.kernel.theorem import NotProvedError, Supposition, Theorem
from force_diffusion.symbolic.kernel.where import LOADED_VERTICALLY, SURFACE, Where
from force_diffusion.symbolic.symbols import (
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
    e_y,
    epsilon,
    f_load,
    i,
    j,
    k,
    l,
    n,
    n_minus,
    n_plus,
    n_x,
    n_y,
    phi,
    q,
    r,
    site_r,
    site_s,
)
from sympy import Eq, Integer, Sum, sqrt

BEADS = Where.of(j >= 0)
ON_SURFACE = axioms.loads(SURFACE)
TOP = Where.of(Eq(j, M), j >= 0, loading=SURFACE)
ORIGIN, UP, _ = axioms.ordered()
HERE, NEXT = Position(i, j), Position(i + 1, j + 1)
LINE = Sum(DeltaR(i - j + n, n), (n, 0, j))
EQ_1 = r * (j + i) * n_plus + r * (j - i) * n_minus
X, ROOT = sympy.Symbol("x", real=True), sympy.Symbol("root", positive=True)
MATRIX = sympy.ImmutableMatrix([[n_x, n_y], [-n_x, n_y]])


def stretched() -> sympy.Expr:
    """What the contact of a bead with its left support says at order 1 in ε."""
    left, right = axioms.contact(1).formula.args
    return sympy.expand(left - right).coeff(epsilon, 1)


def from_layer_below(supposed: tuple[Theorem, ...]) -> Rule:
    return rules.rewrite(*supposed)


PROVED: dict[str, tuple[Callable[[], Rule], sympy.Expr, sympy.Expr | int, Where]] = {
    "rewrite": (rules.rewrite, LINE, Sum(DeltaR(i - n, j - n), (n, 0, j)), BEADS),
    "rewrite, facts put in": (lambda: rules.rewrite(ON_SURFACE), Load(i, j), 0,
                              Where.of(j >= 0, j < M, loading=SURFACE)),
    "follows": (lambda: rules.follows(UP), (NEXT - HERE) / (1 - phi**2),
                2 * r * n_plus / (1 - phi**2), BEADS),
    "follows, one part": (lambda: rules.follows(rules.along(UP, n_minus)),
                          Dot(n_minus, NEXT - HERE), 2 * r * phi, BEADS),
    "order 0": (lambda: rules.order(axioms.contact(1), 0), 4 * r**2 * (n_x**2 + n_y**2),
                4 * r**2, Where.of(j >= 1)),
    "order 1": (lambda: rules.order(axioms.contact(1), 1), stretched(), 0, Where.of(j >= 1)),
    "solve": (lambda: rules.solve([UP], [NEXT]), NEXT, HERE + 2 * r * n_plus, BEADS),
    "cases": (lambda: rules.cases(rules.rewrite(ON_SURFACE), (Eq(j, M),), (j > M,)),
              Load(i, j), Load(i, j), Where.of(j >= 0, j >= M)),
    "in terms of other indices": (
        lambda: rules.in_terms_of({j: M - q}, {q: M - j}, Where.of(
            q >= 1, q <= M, loading=SURFACE, indices=(i, j)).put_in({j: M - q}, (i, q, M)),
            rules.rewrite(ON_SURFACE)),
        Load(i, j), 0, Where.of(j >= 0, j <= M - 1, loading=SURFACE)),
    "induct": (lambda: rules.induct(q, Integer(0), rules.rewrite(axioms.base()), from_layer_below),
               DeltaX(0, 0), 0, Where.of(q >= 0)),
    "reach": (lambda: rules.reach(ORIGIN, axioms.ordered()[1:]), HERE, EQ_1, BEADS),
    "walk": (lambda: rules.walk({i: k}, {i: i - 1}, q), i, k - q,
             Where.of(q >= 0, indices=(i, k))),
    "inverse": (lambda: rules.inverse, sympy.Pow(MATRIX, -1, evaluate=False), MATRIX.inv(),
                Where()),
    "differentiate": (lambda: rules.differentiate(ROOT, X**2 + 1),
                      sympy.Derivative(sqrt(X**2 + 1), X), X / sqrt(X**2 + 1), Where()),
}  # fmt: skip


@pytest.mark.parametrize("name", PROVED)
def test_it_is_proved(name: str) -> None:
    rule, left, right, where = PROVED[name]
    formula = equation(left, sympy.sympify(right))
    theorem = rule()(formula, where)
    assert theorem.formula == formula
    assert not theorem.supposed
    assert theorem.where == (where.also(formula) if name == "walk" else where)


def test_an_instance_is_proved() -> None:
    theorem = rules.instance(axioms.contact(1), {i: i + 1, j: j + 1}, BEADS)
    assert theorem.where == BEADS
    assert theorem.premises == (axioms.contact(1),)


def test_a_mirror_image_is_proved() -> None:
    theorem = rules.mirror(UP)
    assert theorem.formula == equation(Position(i - 1, j + 1) - HERE, 2 * r * n_minus)


def test_a_supposition_is_kept_until_its_induction_ends() -> None:
    supposition = Supposition(j)
    supposed = rules.suppose(equation(DeltaR(i, j), 0), BEADS, supposition, 2)
    told = rules.rewrite(supposed)(equation(DeltaR(i, j - 2), 0), Where.of(j >= 2))
    assert told.supposed == {supposition}
    assert told.indices == (i,)


def test_nothing_is_put_in_for_the_start_of_an_induction() -> None:
    where = Where.of(j >= 0, j <= M - 1)
    supposed = rules.suppose(equation(DeltaR(i, j), 0), where, Supposition(j, M - 1), -2)
    assert supposed.indices == (i,)


def test_a_ratio_of_forces_is_proved_and_used() -> None:
    """f⁺ is 0 where f⁻ is: their ratio says so, and no more."""
    minus, plus = ForceMinus(site_r, site_s), ForcePlus(site_r, site_s)
    where = Where.of(Eq(site_s, M), site_s >= 0, loading=SURFACE)
    both = rules.rewrite(ON_SURFACE)(equation(plus, 3 * minus), where)
    ratio = rules.follows(both)(equation(plus / minus, Integer(3)), where)
    assert rules.rewrite(ratio)(equation(plus * e_y, 3 * minus * e_y), where)


def split(across: sympy.Expr, layer: sympy.Expr) -> sympy.Eq:
    """f⁺ below a bead that carries f_load alone, straight down (Eq. 7)."""
    left, right = (across - 1, layer - 1), (across + 1, layer - 1)
    tilt = phi * Dot(n_minus, DeltaNPlus(*left)) - Dot(n_plus, DeltaNMinus(*right))
    return equation(ForcePlus(*left), f_load / (2 * n_y) * (1 + tilt / (1 - phi**2)))


def test_forces_below_a_bead_are_proved() -> None:
    top = Where.of(Eq(l, M), l >= 1, loading=SURFACE)
    assert rules.below(axioms.balance(), ON_SURFACE)(split(k, l), top)


def test_a_condition_is_discharged_by_what_is_known() -> None:
    """What holds of a loaded bead holds of the surface's beads: nothing presses them from above."""
    loads = axioms.loads(LOADED_VERTICALLY)
    loaded = Where.of(l >= 1, loading=LOADED_VERTICALLY)
    known = rules.below(axioms.balance(), loads)(split(k, l), loaded)
    top = Where.of(Eq(j, M - 1), j >= 0, loading=SURFACE)
    claimed = split(i + 1, j + 1)
    assert rules.rewrite(known, ON_SURFACE)(claimed, top)
    with pytest.raises(NotProvedError, match="normal forms"):
        rules.rewrite(known)(claimed, top)
