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
    all_mutants = list(mutants(EQUATION))
    words = " ".join(mutant.change for mutant in all_mutants)
    for kind in ("flipped", "dropped", "changed", "bound m", "case m", "δr_(i+2,j)", "replaced"):
        assert kind in words
    equations = [mutant.equation for mutant in all_mutants]
    assert len(set(equations)) == len(equations)
    assert EQUATION not in equations
    for mutant in all_mutants:
        changed_left = mutant.equation.lhs != EQUATION.lhs
        assert changed_left != (mutant.equation.rhs != EQUATION.rhs)
        assert mutant.change.startswith("left: ") == changed_left
