"""What is found of a statement, and on what that rests.

A proof is a normal form that is zero. A refutation names a place, and a radius, at which one is
not. What neither settles is undecided; what has no value, or no single meaning, somewhere on its
domain is not a statement.
"""

from collections.abc import Iterable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from enum import StrEnum

import sympy

from .. import symbols as sy
from ..algebra.exact import NotAStatementError, NotExactError, NotProvedError
from ..printing.text import text
from ..signs import sign
from ..trees import equation
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

    If none proves an equation of two roots that are not negative, their squares decide.

    Args:
        formula: the statement.
        domain: where it is to hold.
        attempts: rules; none of them is trusted to fit the statement.
    """
    ruling = _first(formula, domain, attempts)
    if ruling.verdict.is_proved or (squares := _squares(formula, domain)) is None:
        return ruling
    squared = _first(squares, domain, attempts)
    if squared.verdict.is_proved:
        return squared
    return replace(squared, note=f"both sides squared: {squared.note}")


def _first(formula: sympy.Eq, domain: Domain, attempts: Sequence[Rule]) -> Ruling:
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


def _squares(formula: sympy.Eq, domain: Domain) -> sympy.Eq | None:
    """Both sides squared, where both are roots that are not negative; None for other equations.

    Of one root it need not be known that it is one of what is not negative: if the squares are
    equal, it is.
    """
    sides, of_unknown_sign = [], 0
    for side in formula.args:
        squares = [(base, 2 * exponent) for base, exponent in _factors(side)]
        roots = [base for base, power in squares if power.is_odd]
        if not roots or not all(power.is_Integer for _, power in squares):
            return None
        signless = [base for base, _ in squares if not _is_nonnegative(base, domain)]
        of_unknown_sign += sum(1 if base in roots else 2 for base in signless)
        powers = (sympy.Pow(*square, evaluate=False) for square in squares)
        sides.append(sympy.Mul(*powers, evaluate=False))
    return equation(*sides) if of_unknown_sign <= 1 else None


def _factors(side: sympy.Expr) -> Iterator[tuple[sympy.Expr, sympy.Expr]]:
    """Bases and exponents; an absolute value is the root of a square."""
    for factor in sympy.Mul.make_args(side):
        base, exponent = factor.as_base_exp()
        if base.is_Mul:
            yield from ((inner, power * exponent) for inner, power in _factors(base))
        elif isinstance(base, sympy.Abs):
            yield base.args[0] ** 2, exponent / 2
        else:
            yield base, exponent


def _is_nonnegative(base: sympy.Expr, domain: Domain) -> bool:
    """Whether it is shown to be nowhere negative on a domain."""
    if base.is_nonnegative or isinstance(base, sy.Variance):
        return True
    value = base.xreplace({sy.z: sy.j / sy.M}) if sy.j in domain.indices else base
    try:
        return sign(domain.reader().scalar(value), domain.points) == 1
    except NotExactError:
        return False
