"""The shape of a derivation: what every ``eqNN_…`` module states, and what running it yields."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field

import sympy
from force_diffusion.derivations.framework.catalogue import Number
from force_diffusion.derivations.witnesses.draws import SmallPacking
from force_diffusion.symbolic.kernel.decisions import (
    KernelError,
    Ruling,
    Verdict,
    refuted,
    undecided,
)
from force_diffusion.symbolic.kernel.language import unreadable, without_value


@dataclass(frozen=True)
class Step:
    """One line of reasoning: a reason in plain words (Unicode) and the formula that it gives."""

    reason: str
    formula: sympy.Basic | None = None


@dataclass(frozen=True)
class Claim:
    """Something that a decision procedure rules on."""

    name: str
    decide: Callable[[], Ruling]


@dataclass(frozen=True)
class Witness:
    """A check of another kind: exact or high-precision numbers of a small packing."""

    name: str
    run: Callable[[SmallPacking], Ruling]


@dataclass(frozen=True)
class Derivation:
    """One numbered equation: what is printed, why it holds, and how it is checked.

    ``steps`` and ``decide`` are functions so that importing a derivation proves nothing and
    costs nothing. ``decide`` rules on a candidate for the printed equations, one by one in
    ``printed``; it is the same procedure for the true equation and for its mutants.
    """

    number: Number
    name: str
    title: str
    symbols: tuple[tuple[sympy.Basic, str], ...]
    assumptions: tuple[str, ...]
    premises: tuple["Derivation", ...]
    printed: tuple[sympy.Eq, ...]
    steps: Callable[[], Iterable[Step]]
    decide: Callable[[int, sympy.Eq], Ruling]
    claims: tuple[Claim, ...] = ()
    witnesses: tuple[Witness, ...] = ()
    remarks: tuple[str, ...] = ()
    relation: str = "="  # how the printed equation relates its sides: "=", "≈", "∼" or "∝"
    exact: Callable[[], dict[str, "ExactCase"]] | None = None  # forms at finite size, by case
    # explicit values at which a candidate is false, or None; knows nothing of how it is decided
    search: Callable[[sympy.Eq], str | None] | None = None

    def rule_on(self, part: int, candidate: sympy.Eq) -> Ruling:
        """Rule on a candidate for one of ``printed``: decided, in the language, and searched.

        Raises:
            KernelError: it was proved, and explicit values refute it.
        """
        if reason := unreadable(candidate, self.printed):
            return undecided(reason)
        try:
            ruling = self.decide(part, candidate)
        except (ArithmeticError, TypeError, ValueError) as failure:
            ruling = undecided(f"it could not be read: {failure or type(failure).__name__}")
        proven = ruling.verdict is Verdict.PROVED
        if proven and (reason := without_value(candidate)):
            proven, ruling = False, undecided(reason)
        if ruling.verdict is Verdict.REFUTED or not self.search:
            return ruling
        found = self.search(candidate)
        if found and proven:
            raise KernelError(f"Eq. {self.number} was proved, yet is false: {found}")
        return refuted(found) if found else ruling


@dataclass(frozen=True)
class Missed:
    """Packings or sites of an exact case that its form is not for, with their own value."""

    where: str
    when: tuple[sympy.Basic, ...]  # relations between whole numbers; all of them hold there
    expression: sympy.Expr


@dataclass(frozen=True)
class ExactCase:
    """An exact form at finite size, for some layers, loads or sites.

    Attributes:
        quantity: what it is the value of.
        validity: where it holds, in words.
        expression: the closed form.
        domain: relations between whole numbers, all of which hold for form and ``missed`` together.
        missed: what of the domain the form is not for; the first that fits holds.
    """

    quantity: sympy.Expr
    validity: str
    expression: sympy.Expr
    domain: tuple[sympy.Basic, ...] = ()
    missed: tuple[Missed, ...] = ()


@dataclass(frozen=True)
class Check:
    """A claim or a witness that has been run."""

    kind: str  # "proof" or "witness"
    name: str
    verdict: Verdict
    seconds: float
    note: str = ""


@dataclass(frozen=True)
class Mutant:
    """A printed equation with one mechanical change, and what the checker said of it."""

    kind: str
    change: str
    equation: sympy.Eq
    ruling: Ruling

    @property
    def equivalent(self) -> bool:
        """Whether it is an equivalent rewriting, with its proof."""
        return self.ruling.verdict is Verdict.PROVED

    @property
    def verdict(self) -> str:
        """The ruling's verdict in words, "equivalent" for "proved"."""
        return "equivalent" if self.equivalent else str(self.ruling.verdict)


@dataclass(frozen=True)
class Outcome:
    """All that running one derivation found."""

    derivation: Derivation
    verdict: Verdict
    checks: tuple[Check, ...]
    mutants: tuple[Mutant, ...] = field(default=())
    seconds: float = 0.0
