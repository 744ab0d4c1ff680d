"""Tiny derivations with a known fate, for tests of all that surrounds a derivation."""

from collections.abc import Callable
from dataclasses import dataclass, replace

import sympy
from force_diffusion.derivations.framework.proving import Lines
from force_diffusion.derivations.framework.record import Claim, Derivation
from force_diffusion.symbolic.as_printed import equation, terms
from force_diffusion.symbolic.kernel.decisions import Ruling, Verdict
from force_diffusion.symbolic.kernel.where import Where
from force_diffusion.symbolic.symbols import DeltaR, SecondDifference, i, j

TRUE = equation(SecondDifference(i, j), terms(DeltaR(i, j), DeltaR(i - 1, j)))
SAME = equation(DeltaR(i, j), DeltaR(i, j))


def decide(_: int, candidate: sympy.Eq) -> Ruling:
    """Only the same terms will do, in any order."""
    same = candidate.lhs == TRUE.lhs and sympy.expand(candidate.rhs - TRUE.rhs) == 0
    return Ruling(Verdict.PROVED if same else Verdict.REFUTED, "terms compared")


GUESS = "a lucky guess"


def always(verdict: Verdict) -> Ruling:
    return Ruling(verdict, "said so", (GUESS,) if verdict is Verdict.ASSUMING else ())


@dataclass(frozen=True)
class Step:
    """A line whose fate is said."""

    reason: str
    formula: sympy.Eq
    fate: Callable[[int, sympy.Eq], Ruling]
    uses: tuple[str, ...] = ()
    relation: str = "="

    @property
    def equations(self) -> tuple[sympy.Eq, ...]:
        return (self.formula,)

    def rule_on(self, part: int, candidate: sympy.Eq) -> Ruling:
        return self.fate(part, candidate)

    @property
    def ruling(self) -> Ruling:
        return self.rule_on(0, self.formula)

    @property
    def verdict(self) -> Verdict:
        return self.ruling.verdict


def lines(*steps: Step) -> Lines:
    made = Lines(Where())
    made.extend(steps)  # type: ignore[arg-type]
    return made


@dataclass(frozen=True)
class Fake(Derivation):
    """A derivation whose printed equation has a procedure of its own."""

    decide: Callable[[int, sympy.Eq], Ruling] = decide

    def rule_on(self, part: int, candidate: sympy.Eq, where: Where | None = None) -> Ruling:
        return self.decide(part, candidate)

    @property
    def assumed(self) -> list[str]:
        return []


PREMISE = Fake(
    number=1,
    name="premise",
    title="A premise, with δr_(i−1,j) in its title",
    symbols=((DeltaR(i, j), "deviation of a radius, 100 % made up & simple"),),
    assumptions=("j ≥ 1",),
    premises=(),
    printed=(TRUE,),
    steps=lambda: lines(
        Step("Add the two radii.", TRUE, decide, ("an assumption",)),
        Step("They are n⁺ apart.", SAME, lambda _, one: always(Verdict.PROVED), ("step 1",)),
    ),
    claims=(Claim("a claim", lambda: always(Verdict.PROVED)),),
    remarks=("A remark about n⁺·δn⁺ = 0.",),
)

CONCLUSION = replace(PREMISE, number=2, name="conclusion", title="B", premises=(PREMISE,))


def with_claim(verdict: Verdict) -> Derivation:
    return replace(CONCLUSION, claims=(Claim("doubtful", lambda: always(verdict)),))


def with_step(verdict: Verdict) -> Derivation:
    doubtful = Step("So it is.", SAME, lambda *_: always(verdict), ("step 1",))
    return replace(CONCLUSION, steps=lambda: lines(*CONCLUSION.steps(), doubtful))
