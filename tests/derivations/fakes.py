"""Tiny derivations with a known fate, for tests of all that surrounds a derivation."""

from collections.abc import Callable
from dataclasses import replace

import sympy
from force_diffusion.derivations.framework.proof import Steps
from force_diffusion.derivations.framework.record import Derivation
from force_diffusion.symbolic.algebra.exact import NotProvedError
from force_diffusion.symbolic.as_printed import terms
from force_diffusion.symbolic.kernel.domain import Domain
from force_diffusion.symbolic.kernel.rules import Rule, rewrite
from force_diffusion.symbolic.kernel.theorem import Theorem, made
from force_diffusion.symbolic.symbols import DeltaR, SecondDifference, i, j
from force_diffusion.symbolic.trees import equation

BEADS = Domain.of(j >= 0)
PRINTED = equation(SecondDifference(i, j), SecondDifference(i, j).doit())
TWICE = equation(terms(DeltaR(i, j), DeltaR(i, j)), 2 * DeltaR(i, j))

GUESS = "a lucky guess"


def guessed(formula: sympy.Eq, domain: Domain) -> Theorem:
    """Prove anything, on an assumption."""
    return made(formula, domain, "a guess", assuming=(GUESS,))


def baffled(formula: sympy.Eq, domain: Domain) -> Theorem:
    """Prove nothing."""
    raise NotProvedError("nobody knows")


def premise(steps: Steps) -> None:
    steps.show("Subtract two radii:", PRINTED, rewrite())
    steps.show("Two and two are n⁺ apart.", TWICE, rewrite())
    steps.claim("a claim", TWICE, rewrite())


def conclusion(steps: Steps) -> None:
    steps.show("Again:", PRINTED, rewrite(PREMISE.theorem))


PREMISE = Derivation(
    number=1,
    name="premise",
    title="A premise, with δr_(i−1,j) in its title",
    symbols=((DeltaR(i, j), "deviation of a radius, 100 % made up & simple"),),
    assumptions=("j ≥ 1",),
    printed=(PRINTED,),
    domain=BEADS,
    show_steps=premise,
    remarks=("A remark about n⁺·δn⁺ = 0.",),
)

ASSUMED = replace(PREMISE, show_steps=lambda steps: steps.show("A guess:", PRINTED, guessed))

CONCLUSION = replace(PREMISE, number=2, name="conclusion", title="B", show_steps=conclusion)


def with_claim(rule: Rule) -> Derivation:
    """The conclusion with a claim that a rule is to prove."""
    return _with(lambda steps: steps.claim("doubtful", TWICE, rule))


def with_step(rule: Rule) -> Derivation:
    """The conclusion with a step that a rule is to prove."""
    return _with(lambda steps: steps.show("So it is.", TWICE, rule))


def _with(added: Callable[[Steps], object]) -> Derivation:
    def show_steps(steps: Steps) -> None:
        conclusion(steps)
        added(steps)

    return replace(CONCLUSION, show_steps=show_steps)
