"""What is found of a statement, and on what that rests.

A proof is a normal form that is zero. A refutation names a place, and a radius, at which one is
not. What neither settles is undecided; what has no value, or no single meaning, somewhere on its
domain is not a statement.
"""

from collections.abc import Iterable, Sequence
from contextlib import suppress
from dataclasses import dataclass
from enum import StrEnum

import sympy

from ..algebra.exact import NotAStatementError, NotProvedError
from ..printing.text import text
from .domain import Domain
from .rules import Rule, proved_by
from .theorem import FalseStatementError, Theorem, names_for


class Verdict(StrEnum):
    """What a decision procedure found."""

    PROVED = "proved"
    ASSUMING = "proved, assuming"
    REFUTED = "refuted"
    UNDECIDED = "undecided"
    NOT_A_STATEMENT = "not a statement"

    @property
    def is_proved(self) -> bool:
        """Whether it is proved, be it on an assumption."""
        return self in (Verdict.PROVED, Verdict.ASSUMING)


def in_words(verdict: str, assuming: Iterable[str] = ()) -> str:
    """A verdict with the assumptions that it rests on: "proved, assuming Gaussian forces"."""
    return " ".join(filter(None, (str(verdict), " and ".join(assuming))))


@dataclass(frozen=True, repr=False)
class Ruling:
    """A verdict and, in plain words, what it rests on (or the counterexample).

    Attributes:
        verdict: what was found.
        note: why, or at which values.
        assuming: what a proof assumes and no rule discharges; then, and only then, the verdict is
            "proved, assuming".
    """

    verdict: Verdict
    note: str = ""
    assuming: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        if bool(self.assuming) != (self.verdict is Verdict.ASSUMING):
            raise ValueError(f"{self.verdict} with the assumptions {self.assuming}")

    @property
    def words(self) -> str:
        """The verdict, and what is assumed."""
        return in_words(self.verdict, self.assuming)

    def __str__(self) -> str:
        return f"{self.words}: {self.note}" if self.note else self.words

    def __repr__(self) -> str:
        return f"<{self}>"


def proved(note: str = "", assuming: Iterable[str] = ()) -> Ruling:
    """Return the ruling of a proof, and of what it assumes."""
    assumptions = tuple(dict.fromkeys(assuming))
    return Ruling(Verdict.ASSUMING if assumptions else Verdict.PROVED, note, assumptions)


def proved_by_rules(theorems: Sequence[Theorem]) -> Ruling:
    """Return the ruling on theorems: the rules that proved them, and what they assume."""
    rules = dict.fromkeys(theorem.rule for theorem in theorems)
    assuming = set[str]().union(*(theorem.assuming for theorem in theorems))
    return proved(f"by {', '.join(rules)}", sorted(assuming))


def refuted(note: str) -> Ruling:
    """Return the ruling of a counterexample."""
    return Ruling(Verdict.REFUTED, note)


def undecided(note: str) -> Ruling:
    """Return the ruling that says why nothing was decided."""
    return Ruling(Verdict.UNDECIDED, note)


def not_a_statement(note: str) -> Ruling:
    """Return the ruling on what has no value, or no single meaning, somewhere on its domain."""
    return Ruling(Verdict.NOT_A_STATEMENT, note)


def all_of(*rulings: Ruling) -> Ruling:
    """Return the worst of several rulings; all proved, their notes and assumptions together."""
    for verdict in (Verdict.REFUTED, Verdict.NOT_A_STATEMENT, Verdict.UNDECIDED):
        for ruling in rulings:
            if ruling.verdict is verdict:
                return ruling
    notes = dict.fromkeys(ruling.note for ruling in rulings)
    return proved(
        "; ".join(notes), (assumption for ruling in rulings for assumption in ruling.assuming)
    )


def decide(formula: sympy.Eq, domain: Domain, attempts: Sequence[Rule]) -> Ruling:
    """Rule on a statement: the first rule that proves it, or shows that it is false, decides.

    Args:
        formula: the statement.
        domain: where it is to hold.
        attempts: rules; none of them is trusted to fit the statement.
    """
    reasons = []
    for rule in attempts:
        try:
            theorem = proved_by(rule, formula, domain)
        except NotAStatementError as reason:
            return not_a_statement(_for_users(reason, formula))
        except FalseStatementError as reason:
            return refuted(_for_users(reason, formula))
        except (RecursionError, ValueError) as reason:
            reasons.append(_for_users(reason, formula))
        else:
            if theorem.supposed:
                return undecided("it rests on what is only supposed")
            return proved_by_rules([theorem])
    return undecided(reasons[-1] if reasons else "no rule decides it")


def _for_users(reason: Exception, formula: sympy.Eq) -> str:
    """A reason that names a user's own symbols, and not what stands for them."""
    words = " ".join(str(reason).split()) or "it is nested too deeply"
    with suppress(NotProvedError):  # there are too many of them
        for symbol, stand_in in names_for(formula).items():
            words = words.replace(text(stand_in), text(symbol))
    return words
