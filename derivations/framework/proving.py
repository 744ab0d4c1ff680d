"""The lines of a derivation: what each says, where, by which rule, and what it rests on.

A line names a rule of the kernel and, as objects, the lines, equations and axioms that the rule
uses. The kernel proves what is shown; anything else said in its place goes the same way.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, Protocol

import sympy
from force_diffusion.symbolic import symbols as sy
from force_diffusion.symbolic.algebra.exact import NotExactError
from force_diffusion.symbolic.as_printed import equation, in_place, too_large
from force_diffusion.symbolic.kernel.decisions import (
    Ruling,
    Verdict,
    all_of,
    not_a_statement,
    proved,
    refuted,
    undecided,
)
from force_diffusion.symbolic.kernel.disproofs import Disproof, other_leading_order
from force_diffusion.symbolic.kernel.rules import Rule
from force_diffusion.symbolic.kernel.theorem import (
    DisprovedError,
    NotAStatementError,
    NotProvedError,
    Theorem,
    check,
    isolated,
    subject,
)
from force_diffusion.symbolic.kernel.where import Where
from force_diffusion.symbolic.printing.text import text
from force_diffusion.symbolic.search.counterexample import counterexample
from force_diffusion.symbolic.search.values import WithoutValue
from force_diffusion.symbolic.symbols import ForceMinus, ForcePlus

from .grounds import By, Proved

Meaning = Mapping[Any, Any]
"""What a line writes in short: for a symbol, or for a function of its arguments."""


class Shown(Protocol):
    """What every shown step has, a line of the kernel's or one with a procedure of its own."""

    @property
    def reason(self) -> str:
        """Why it holds, in plain words."""

    @property
    def formula(self) -> sympy.Basic:
        """An equation, or a Tuple of equations."""

    @property
    def relation(self) -> str:
        """How the equation relates its sides."""

    @property
    def uses(self) -> tuple[str, ...]:
        """What it follows from, in words."""

    @property
    def equations(self) -> tuple[sympy.Eq, ...]:
        """Its equations, one by one."""

    @property
    def ruling(self) -> Ruling:
        """What is decided of it as it is shown."""

    @property
    def verdict(self) -> Verdict:
        """That of ``ruling``."""

    def rule_on(self, part: int, candidate: sympy.Eq) -> Ruling:
        """Rule on a candidate for one of its equations."""


_FEW = 4  # points at which what may be no statement is looked at


@dataclass(frozen=True)
class Line:
    """One line of reasoning: a statement, where it holds, and the rule that proves it.

    Attributes:
        reason: why it holds, in plain words (Unicode).
        formula: an equation, or a Tuple of equations.
        by: the rule; one for each equation, or one for all.
        where: the domain; one for each equation, or one for all.
        meaning: what is written in short; one for each equation, or one for all.
        after: lines and equations that it follows in the text, beside those that its rule uses.
        number: its place among the lines, from 1.
        alike: lines that say the same of other packings, and have to be proved as well.
    """

    reason: str
    formula: sympy.Basic
    by: By | tuple[By, ...]
    where: Where | tuple[Where, ...]
    meaning: Meaning | tuple[Meaning, ...] | None = None
    after: tuple[Proved, ...] = ()
    number: int = 0
    alike: tuple["Line", ...] = ()

    @property
    def relation(self) -> str:
        """How it relates its sides: "=", or as in the limit that it is about."""
        return _sign(self.domain(0))

    @property
    def words(self) -> str:
        """How another line names it."""
        return f"step {self.number}"

    @property
    def equations(self) -> tuple[sympy.Eq, ...]:
        """Its equations, one by one."""
        formula = self.formula
        return tuple(formula) if isinstance(formula, sympy.Tuple) else (formula,)

    @property
    def uses(self) -> tuple[str, ...]:
        """What it follows from, in words."""
        rules_of = self.by if isinstance(self.by, tuple) else (self.by,)
        names = [name for one in rules_of for name in one.names()]
        names += [one.words for one in self.after]
        names += [name for one in self.alike for name in one.uses]
        return tuple(sorted(dict.fromkeys(names), key=_in_order))

    def domain(self, part: int) -> Where:
        """Where one of its equations holds."""
        where: Where = _at(part, self.where)
        return where

    def unlike(self, sign: str, part: int, name: str) -> str:
        """Why the sign that is printed is not that of what is proved; "" when it is.

        Args:
            sign: "=", "≈", "∼" or "∝".
            part: the place of the equation.
            name: what prints it, such as "Eq. 13".
        """
        where = self.domain(part)
        meant = _sign(where)
        # "=" of a limit is of what both sides go to, which a printed "=" does not say
        if sign == meant and (sign != "=" or not where.limit):
            return ""
        how = _PROVED.get(meant if where.limit else "", "in a limit only")
        return f"the printed sign of {name} is {sign}, but its line is proved {how}"

    def prove(self, part: int, candidate: sympy.Eq) -> Theorem:
        """The theorem that a candidate for one of its equations is.

        Raises:
            NotProvedError: the rule does not prove it.
        """
        return self._proofs(part, candidate)[0]

    def _proofs(self, part: int, candidate: sympy.Eq) -> tuple[Theorem, ...]:
        """The theorem, and those of the lines alike."""
        others = [one.prove(part, candidate) for one in self.alike]
        rule: Rule = _at(part, self.by).rule(())
        return (rule(self._meant(part, candidate), self.domain(part)), *others)

    def rule_on(self, part: int, candidate: sympy.Eq) -> Ruling:
        """Rule on a candidate: proved by the rule, or searched for explicit values against it.

        What the kernel sees no statement in is refuted only where both sides have values.
        """
        if large := too_large(candidate):
            return undecided(large)
        meant, where = self._meant(part, candidate), self.domain(part)
        try:
            theorem, *others = self._proofs(part, candidate)
        except DisprovedError as reason:
            return refuted(str(reason))
        except (ArithmeticError, RecursionError, TypeError, ValueError) as reason:
            none = isinstance(reason, NotAStatementError) and no_statement(meant, where)
            # what has no value somewhere is mostly without one at a place that no packing shows
            found = self.counterexample(part, candidate, _FEW if none else None)
            if found and not isinstance(found, WithoutValue):
                return refuted(found)
            if none or found:
                return not_a_statement(str(reason) if none else str(found))
            return undecided(str(reason) or type(reason).__name__)
        return proved(f"by the rule: {theorem.rule}", assumptions((theorem, *others)))

    def counterexample(
        self, part: int, candidate: sympy.Eq, at_most: int | None = None
    ) -> str | None:
        """Explicit values at which a candidate is false, found without the rule; or None."""
        by, where = _at(part, self.by), self.domain(part)
        meant = self._meant(part, candidate)
        finite = where.in_the_limit(None)
        try:
            found = by.finite(meant, finite) if by.finite else meant
            force = by.force(finite) if by.force else None
        except (ArithmeticError, RecursionError, TypeError, ValueError):
            return None  # what it says at finite size is not known
        return counterexample(found, where, at_most=at_most, force=force)

    def _meant(self, part: int, candidate: sympy.Eq) -> sympy.Eq:
        meaning = _at(part, self.meaning)
        return in_place(candidate, meaning or {})

    @cached_property
    def theorems(self) -> tuple[Theorem, ...]:
        """What it proves, one theorem for each equation.

        Raises:
            NotProvedError: one of them is not proved.
        """
        return tuple(self.prove(part, one) for part, one in enumerate(self.equations))

    @cached_property
    def ruling(self) -> Ruling:
        """What the kernel says of it as it is shown."""
        return all_of(*(self.rule_on(part, one) for part, one in enumerate(self.equations)))

    @property
    def verdict(self) -> Verdict:
        """That of ``ruling``."""
        return self.ruling.verdict

    def decide(self) -> Ruling:
        """The same as ``ruling``, for what asks a function."""
        return self.ruling


_PROVED = {
    "": "exactly",
    "∼": "to leading order only",
    "≈": "but for terms of lower order",
    "∝": "but for a factor",
}
"""How far a line is proved, by the relation of its limit."""


def _sign(where: Where) -> str:
    return where.limit.relation.split()[0] if where.limit else "="


def _at(part: int, one: Any) -> Any:
    return one[part] if isinstance(one, tuple) else one


def _in_order(name: str) -> tuple[bool, int]:
    kind, number = name.split()
    return kind == "step", int(number) if number.isdigit() else 0


@dataclass(frozen=True)
class Refuted:
    """A printed statement that does not hold, which a theorem contradicts.

    Attributes:
        reading: how the words of the paper are read in it.
        formula: the equation.
        by: the line with the theorem.
        where: its domain.
        meaning: what is written in short.
    """

    reading: str
    formula: sympy.Eq
    by: Line
    where: Where
    meaning: Meaning

    @property
    def relation(self) -> str:
        """How it relates its sides."""
        return self.where.limit.relation if self.where.limit else "="

    def disprove(self) -> Disproof:
        """The kernel's disproof.

        Raises:
            NotProvedError: it is not shown to be false.
        """
        (theorem,) = self.by.theorems
        meant = equation(*(in_place(side, self.meaning) for side in self.formula.args))
        return other_leading_order(theorem)(meant, self.where)

    @cached_property
    def ruling(self) -> Ruling:
        """``refuted``, with what the quantity does instead, or ``undecided``."""
        try:
            return refuted(self.disprove().reason)
        except (ArithmeticError, RecursionError, TypeError, ValueError) as reason:
            return undecided(str(reason) or type(reason).__name__)


class Lines(list[Line]):
    """The lines of a derivation, which number themselves.

    Args:
        where: the domain of a line that does not have its own.
        by: the rule of a line that names none.
        meaning: what is written in short in all lines that do not say it themselves.
    """

    def __init__(self, where: Where, by: By | None = None, meaning: Meaning | None = None):
        super().__init__()
        self._where, self._by, self._meaning = where, by, meaning
        self.claims: list[Line] = []
        self.refuted: list[Refuted] = []

    def _line(
        self,
        reason: str,
        formula: sympy.Basic,
        by: By | tuple[By, ...] | None,
        where: Where | tuple[Where, ...] | None = None,
        meaning: Meaning | tuple[Meaning, ...] | None = None,
        **others: Any,
    ) -> Line:
        rule = self._by if by is None else by
        if rule is None:
            raise TypeError("a line needs a rule")
        domain = self._where if where is None else where
        said = self._meaning if meaning is None else meaning
        return Line(reason, formula, rule, domain, said, **others)

    def claim(
        self,
        name: str,
        formula: sympy.Basic,
        by: By | tuple[By, ...] | None = None,
        **options: Any,
    ) -> Line:
        """Add a further statement that the lines prove, and return it; it is not one of them."""
        self.claims.append(self._line(name, formula, by, **options))
        return self.claims[-1]

    def claim_each(
        self,
        name: str,
        said: Iterable[tuple[sympy.Expr, sympy.Expr, Where]],
        by: By | tuple[By, ...] | None = None,
        **options: Any,
    ) -> Line:
        """Claim several equations, each given by its sides and its own domain."""
        lefts, rights, wheres = zip(*said, strict=True)
        formulas = sympy.Tuple(*map(equation, lefts, rights))
        return self.claim(name, formulas, by, where=wheres, **options)

    def refute(
        self, reading: str, formula: sympy.Eq, by: Line, *, where: Where, meaning: Meaning
    ) -> None:
        """Add a printed statement that a line contradicts: it is expected to be refuted."""
        self.refuted.append(Refuted(reading, formula, by, where, meaning))

    def add(self, line: Line, after: tuple[Proved, ...] = ()) -> Line:
        """Add a line that is there already, under the number that it has."""
        if line.number != len(self) + 1:
            raise ValueError(f"line {line.number} in place {len(self) + 1}")
        self.append(line if not after else replace(line, after=after))
        return line

    def show(
        self,
        reason: str,
        formula: sympy.Basic,
        by: By | tuple[By, ...] | None = None,
        **options: Any,
    ) -> Line:
        """Add a line and return it; ``options`` are further attributes of it.

        Raises:
            ValueError: its equations do not have one sign, in which it could be shown.
        """
        line = self._line(reason, formula, by, number=len(self) + 1, **options)
        signs = dict.fromkeys(_sign(line.domain(part)) for part in range(len(line.equations)))
        if len(signs) > 1:
            related = f"its equations are related by {' and '.join(signs)}"
            raise ValueError(f"{related}: show them in lines of their own")
        self.append(line)
        return line


def no_statement(formula: sympy.Eq, where: Where) -> str:
    """Why a formula is seen to be no statement on a domain; "" when that is not seen."""
    try:
        check(formula, where, in_a_limit=where.limit is not None)
    except NotAStatementError as reason:
        return str(reason)
    except NotExactError:  # a bound that is not read
        return ""
    return ""


def assumptions(theorems: Iterable[Theorem]) -> list[str]:
    """What theorems rest on and no rule ends, in words."""
    return sorted(set().union(*(one.assuming for one in theorems)))


def fixes_it(candidate: sympy.Eq, printed: sympy.Eq, where: Where) -> str:
    """Why a candidate may say less than the printed equation; "" when it says as much.

    Where the printed equation is about one quantity, the candidate fixes that everywhere. (A
    printed balance is about none, and its rule compares all of it; what drops a part of a force is
    about that of the printed equation, not of one layer alone.)
    """
    if subject(printed.lhs) is None:
        told, meant = (one.atoms(ForcePlus, ForceMinus) for one in (candidate, printed))
        if where.limit and told != meant:
            return "it is about another force"
        return _fixes_the_symbol(candidate, printed, where)
    try:
        about, _ = isolated(candidate, where)
    except NotProvedError as reason:
        return str(reason)
    return "" if about == subject(printed.lhs) else "it is about another quantity"


def _fixes_the_symbol(candidate: sympy.Eq, printed: sympy.Eq, where: Where) -> str:
    """The same where a symbol stands beside others on the left, as in ⟨f⟩/f₀ − 1."""
    known = {*sy.INDICES, *sy.PARAMETERS, *sy.VECTORS}
    about = printed.lhs.free_symbols - known
    if printed.lhs.has(sy.SiteFunction) or len(about) != 1:
        return ""
    (symbol,) = about
    slope = sympy.diff(candidate.lhs - candidate.rhs, symbol)
    if slope.has(symbol) or not where.never_zero(slope):
        return f"it does not fix {text(symbol)} everywhere"
    return ""
