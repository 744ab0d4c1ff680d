"""Mechanical changes: every kind, each once, none that changes nothing."""

import sympy
from force_diffusion.symbolic.as_printed import terms, times
from force_diffusion.symbolic.symbols import Braces, DeltaR, DeltaX, Dot, M, i, j, m, n_plus
from force_diffusion.symbolic.trees import equation

from tests.properties.mutants import mutants

EQUATION = equation(
    Dot(n_plus, DeltaX(i, j)),
    terms(
        times(2, DeltaR(i, j)),
        sympy.Sum(Braces(M - j, M - m, m, j) * DeltaR(i, m), (m, 1, M)),
        sympy.sqrt(M),
    ),
)


def test_every_kind_occurs_and_nothing_twice():
    found = list(mutants(EQUATION))
    words = " ".join(mutant.change for mutant in found)
    for kind in ("flipped", "dropped", "changed", "bound m", "case m", "δr_(i+2,j)", "replaced"):
        assert kind in words
    equations = [one.equation for one in found]
    assert len(set(equations)) == len(equations)
    assert EQUATION not in equations
    for one in found:
        changed_left = one.equation.lhs != EQUATION.lhs
        assert changed_left != (one.equation.rhs != EQUATION.rhs)
        assert one.change.startswith("left: ") == changed_left
