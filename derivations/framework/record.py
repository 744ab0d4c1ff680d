"""The shape of a derivation: what every ``eqNN_…`` module states, and what proving it found."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import sympy
from force_diffusion.symbolic import symbols as sy
from force_diffusion.symbolic.kernel.decisions import Verdict, in_words
from force_diffusion.symbolic.kernel.domain import Domain
from force_diffusion.symbolic.kernel.theorem import Group, Theorem

from .catalogue import Number
from .proof import Refuted, Step, Steps

_MEANINGS = {
    sy.sigma: "standard deviation σ_δr of the radii",
    sy.r: "mean radius",
    sy.M: "height of the packing",
    sy.z: "relative height j/M",
    sy.phi: "n⁺·n⁻",
}


def usual(*symbols: sympy.Symbol) -> tuple[tuple[sympy.Symbol, str], ...]:
    """Symbols with their usual meaning in words: σ, r, M, z and φ."""
    return tuple((symbol, _MEANINGS[symbol]) for symbol in symbols)


FIRST_ORDER = ("the radii are independent, of zero mean and variance σ²", "first order in δr")
SECOND_ORDER = (
    "the radii are independent, of zero mean and variance σ², of whatever law",
    "second order in δr",
)
"""What is assumed of all variances and covariances, and of all mean values."""


@dataclass(frozen=True)
class Derivation:
    """One numbered equation: what is printed, why it holds, and what else is known of it.

    ``steps`` is a function so that importing a derivation proves nothing and costs nothing. One
    of its steps is the printed equation.

    Attributes:
        number: of the paper; beyond it a label such as "B1".
        name: in code and JSON.
        title: in words.
        symbols: each with its meaning; ``usual`` gives the common ones.
        assumptions: in words.
        printed: the equations, each of which is the formula of a step.
        domain: where they are proved, with the load and the limit.
        steps: proves them.
        remarks: in words.
        loads: in words, for Coq: "surface", "bulk" or "single"; "any" but on the bead passed.
        relation: the printed sign: "=", at every size in its domain; "∼", left over right goes to 1
            in its limit; "≈", what is dropped varies less, by an order, than the force it is about;
            "∝", left over right goes to a positive function of φ alone.
        exact: gives closed forms, exact at finite size, by name; the first is the usual one.
        ground: theorems that say of the quantities in ``printed`` what they are in the radii, by
            which anything said of them is decided.
    """

    number: Number
    name: str
    title: str
    symbols: tuple[tuple[sympy.Basic, str], ...]
    assumptions: tuple[str, ...]
    printed: tuple[sympy.Eq, ...]
    domain: Domain
    steps: Callable[[], Steps]
    remarks: tuple[str, ...] = ()
    loads: tuple[str, ...] = ()
    relation: str = "="
    exact: Callable[[], dict[str, object]] | None = None
    ground: Callable[[], Sequence[Group]] = tuple

    @property
    def words(self) -> str:
        """How a step that rests on it names it."""
        return f"Eq. {self.number}"

    def step_of(self, part: int) -> tuple[Step, int]:
        """The step that shows one of ``printed``, and its place there.

        Raises:
            LookupError: there is none of its domain and sign.
        """
        for step in self.steps():
            shown = zip(step.equations, step.domains, strict=True)
            for place, pair in enumerate(shown):
                if pair == (self.printed[part], self.domain) and step.relation == self.relation:
                    return step, place
        raise LookupError(f"no step of {self.words} shows what is printed, on its domain")

    @property
    def theorems(self) -> tuple[Theorem, ...]:
        """What the kernel proves of it, one theorem for each printed equation."""
        parts = (self.step_of(part) for part in range(len(self.printed)))
        return tuple(step.theorems[place] for step, place in parts)

    @property
    def theorem(self) -> Theorem:
        """The theorem of a derivation with one printed equation."""
        (theorem,) = self.theorems
        return theorem

    @property
    def premises(self) -> tuple[str, ...]:
        """The equations that it rests on, in words, as its theorems say."""
        uses = (words for step in self.steps() for words in step.uses)
        return tuple(dict.fromkeys(words for words in uses if words.startswith("Eq.")))

    @property
    def refuted(self) -> tuple[Refuted, ...]:
        """The printed statements that do not hold; ``printed`` are those that do."""
        return tuple(self.steps().refuted)


@dataclass(frozen=True)
class Check:
    """A step, a claim or a printed statement that has been decided."""

    kind: str  # "step", "proof", or "refutation" of a printed statement
    name: str
    verdict: Verdict
    seconds: float
    note: str = ""
    assuming: tuple[str, ...] = ()

    @property
    def words(self) -> str:
        """Its verdict, and what it assumes."""
        return in_words(self.verdict, self.assuming)

    @property
    def is_expected(self) -> bool:
        """Whether a printed statement that is known not to hold was refuted."""
        return self.kind == "refutation" and self.verdict is Verdict.REFUTED
