"""The lines of a derivation: what each says, where, by which rule, and what it rests on.

A line names a rule of the kernel and, as objects, the lines, equations and axioms that the rule
uses. The kernel proves what is shown; anything else said in its place goes the same way.
"""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache, cached_property
from typing import Any, Protocol

import sympy
from force_diffusion.symbolic import symbols as sy
from force_diffusion.symbolic.algebra.exact import NotExactError
from force_diffusion.symbolic.as_printed import equation, in_place, too_large
from force_diffusion.symbolic.kernel import limits, moments, rules
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
    NotAStatementError,
    NotProvedError,
    Supposition,
    Theorem,
    check,
    isolated,
    put_in,
    subject,
)
from force_diffusion.symbolic.kernel.where import Where
from force_diffusion.symbolic.printing.text import text
from force_diffusion.symbolic.search.counterexample import counterexample
from force_diffusion.symbolic.search.values import WithoutValue
from force_diffusion.symbolic.symbols import ForceMinus, ForcePlus

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


class Proved(Protocol):
    """A line, or an equation, whose theorems may be used."""

    @property
    def theorems(self) -> tuple[Theorem, ...]:
        """One for each of its equations."""

    @property
    def words(self) -> str:
        """How another line names it: "Eq. 2" or "step 1"."""


Source = Any
"""A line, an equation, a theorem of the kernel, several of these, or what is supposed."""

_FEW = 4  # points at which what may be no statement is looked at

SUPPOSED = object()
"""What an induction supposes."""


@dataclass(frozen=True, eq=False)
class By:
    """A rule and what it rests on, resolved when something is to be proved.

    Attributes:
        rule: the rule, given what is supposed.
        sources: what it rests on.
        finite: of a statement in a limit, what it says at finite size, where explicit values are
            looked for.
        force: where that depends on what a force is, an equation that says so.
    """

    rule: Callable[[tuple[Theorem, ...]], Rule]
    sources: tuple[Source, ...] = ()
    finite: Callable[[sympy.Eq, Where], sympy.Eq] | None = None
    force: Callable[[Where], sympy.Eq] | None = None

    def names(self) -> tuple[str, ...]:
        """The lines and equations that it rests on."""
        return tuple(dict.fromkeys(_names(self.sources)))


def _names(sources: Iterable[Source]) -> Iterable[str]:
    for one in sources:
        if isinstance(one, By):
            yield from one.names()
        elif isinstance(one, tuple):
            yield from _names(one)
        else:
            first = one.sources[0] if isinstance(one, Chain) else one
            if hasattr(first, "words"):
                yield first.words


@dataclass(frozen=True)
class Chain:
    """Equations put in one after the other, under the name of the first; it rests on the others."""

    sources: tuple[Source, ...]


@dataclass(frozen=True)
class OfBoth:
    """An equation about one branch, and its mirror image about the other."""

    of: Proved

    @cached_property
    def theorems(self) -> tuple[Theorem, ...]:
        """Its theorem and the mirror image of that."""
        (theorem,) = self.of.theorems
        return theorem, rules.mirror(theorem)

    @property
    def words(self) -> str:
        """How another line names it."""
        return self.of.words


@dataclass(frozen=True, eq=False)
class Beside:
    """Theorems that no line shows; what they follow from is named by the line that uses them."""

    prove: Callable[[], tuple[Theorem, ...]]

    @cached_property
    def theorems(self) -> tuple[Theorem, ...]:
        """All of them."""
        return self.prove()


def known(source: Source, supposed: tuple[Theorem, ...]) -> tuple[Theorem, ...]:
    """The theorems of a source."""
    if source is SUPPOSED:
        return supposed
    if isinstance(source, Theorem):
        return (source,)
    if isinstance(source, tuple):
        return tuple(theorem for one in source for theorem in known(one, supposed))
    found: tuple[Theorem, ...] = source.theorems
    return found


@dataclass(frozen=True)
class Part:
    """One of several equations of a line."""

    of: Proved
    number: int

    @property
    def theorems(self) -> tuple[Theorem, ...]:
        """The theorem of that part."""
        return (self.of.theorems[self.number],)

    @property
    def words(self) -> str:
        """How another line names it."""
        return self.of.words


@dataclass(frozen=True)
class Within:
    """A line of another equation, under the name of that equation."""

    lines: Callable[[], Sequence["Line"]]
    place: int
    words: str

    @property
    def theorems(self) -> tuple[Theorem, ...]:
        """One for each of its equations."""
        return self.lines()[self.place].theorems


def facts_of(
    sources: Sequence[Source], supposed: tuple[Theorem, ...] = ()
) -> tuple[tuple[Theorem, ...], ...]:
    """The theorems of sources, to be put in one after the other; those of a source at once."""
    parts = (one.sources if isinstance(one, Chain) else (one,) for one in sources)
    return tuple(known(one, supposed) for part in parts for one in part)


# the rules of the kernel, with what they rest on


def rewrite(*facts: Source) -> By:
    """Both sides are the same once facts are put in, one after the other."""
    return By(lambda supposed: rules.rewrite(*facts_of(facts, supposed)), facts)


def moment(*facts: Source, **parts: Any) -> By:
    """Both sides are the same once facts are put in and means and variances are worked out."""
    return By(lambda supposed: moments.moment(*facts_of(facts, supposed), **parts), facts)


def asymptotic(*facts: Source, late: Iterable[sympy.Basic] = ()) -> By:
    """Both sides are of the same leading order, moments worked out at finite size."""
    late = tuple(late)
    return By(
        lambda supposed: limits.asymptotic(*facts_of(facts, supposed), late=late),
        facts,
        lambda formula, where: moments.without_moments(
            formula, facts_of(facts), where, where.also(*late)
        ),
    )


def exhausting(whole: Where, parts: Iterable[Where], by: By) -> By:
    """The same rule for several statements, if their domains leave nothing of a whole one out."""
    parts = tuple(parts)

    def rule(supposed: tuple[Theorem, ...]) -> Rule:
        if not whole.covered_by(parts):
            raise NotProvedError("the statements leave something out")
        return by.rule(supposed)

    return By(rule, (by,))


def bounded(*facts: Source) -> By:
    """No radius has more than a share of some order in a variance."""
    return By(lambda supposed: limits.bounded(*facts_of(facts, supposed)), facts)


def negligible(force: Proved, *facts: Source) -> By:
    """What a statement about one force drops varies less, by an order, than that force.

    ``force`` says what the force is, ``facts`` what stands in it and in the statement.
    """
    whole = (Chain((OfBoth(force), *facts)),)
    return By(
        lambda supposed: limits.negligible(*facts_of(whole, supposed)),
        whole,
        lambda formula, where: _put_in(formula, facts, where),
        cache(lambda where: _put_in(force.theorems[0].formula, facts, where)),
    )


def heaviest(*facts: Source) -> By:
    """All weights of left less right are of a lower order than the largest of left."""
    return By(lambda supposed: limits.heaviest(*facts_of(facts, supposed)), facts)


def _put_in(formula: sympy.Eq, facts: tuple[Source, ...], where: Where) -> sympy.Eq:
    told = facts_of(facts)
    return equation(*(put_in(side, told, where, told) for side in formula.args))


def follows(source: Source, *facts: Source) -> By:
    """It says what one theorem says, facts put in."""

    def rule(supposed: tuple[Theorem, ...]) -> Rule:
        (theorem,) = known(source, supposed)
        return rules.follows(theorem, *facts_of(facts, supposed))

    return By(rule, (source, *facts))


def order(source: Source, power: int) -> By:
    """The coefficient of ε to a power."""

    def rule(supposed: tuple[Theorem, ...]) -> Rule:
        (theorem,) = known(source, supposed)
        return rules.order(theorem, power)

    return By(rule, (source,))


def along(source: Source, vector: sympy.Symbol, *facts: Source) -> By:
    """The component of an equation between vectors along a base vector."""

    def rule(supposed: tuple[Theorem, ...]) -> Rule:
        (theorem,) = known(source, supposed)
        return rules.follows(rules.along(theorem, vector), *facts_of(facts, supposed))

    return By(rule, (source, *facts))


def solve(rows: Source, unknowns: Sequence[sympy.Expr], *facts: Source) -> By:
    """What as many equations fix as there are unknowns."""
    return By(
        lambda supposed: rules.solve(known(rows, supposed), unknowns, *facts_of(facts, supposed)),
        (rows, *facts),
    )


def below(balance: Source, *facts: Source) -> By:
    """A contact's force, from the balance of the bead above it."""

    def rule(supposed: tuple[Theorem, ...]) -> Rule:
        (theorem,) = known(balance, supposed)
        return rules.below(theorem, *facts_of(facts, supposed))

    return By(rule, (balance, *facts))


def cases(by: By, *parts: Iterable[sympy.Basic]) -> By:
    """The same rule on parts of the domain."""
    return By(lambda supposed: rules.cases(by.rule(supposed), *parts), (by,))


def in_cases(*choices: tuple[sympy.Symbol, Sequence[Iterable[sympy.Basic]]], by: By) -> By:
    """The same rule, on parts of the domain of a statement that has an index."""

    def rule(supposed: tuple[Theorem, ...]) -> Rule:
        def choose(formula: sympy.Eq, where: Where) -> Theorem:
            for index, parts in choices:
                if index in where.indices:
                    return rules.cases(by.rule(supposed), *parts)(formula, where)
            return by.rule(supposed)(formula, where)

        return choose

    return By(rule, (by,))


def induct(over: sympy.Symbol, start: sympy.Expr | int, base: By, step: By, **how: Any) -> By:
    """From the first value of an index on; ``step`` may use what is SUPPOSED."""

    def rule(supposed: tuple[Theorem, ...]) -> Rule:
        first = sympy.sympify(start)
        return rules.induct(over, first, base.rule(supposed), step.rule, **how)

    return By(rule, (base, step))


def supposing(formula: sympy.Eq, where: Where, over: sympy.Symbol, by: By) -> By:
    """By a rule that uses what is SUPPOSED of the layer before; only an induction ends it."""

    def rule(_: tuple[Theorem, ...]) -> Rule:
        return by.rule((rules.suppose(formula, where, Supposition(over), 1),))

    return By(rule, (by,))


def in_terms_of(
    image: Mapping[sympy.Symbol, sympy.Expr],
    back: Mapping[sympy.Symbol, sympy.Expr],
    other: Where,
    by: By,
) -> By:
    """A statement in other indices."""
    return By(lambda supposed: rules.in_terms_of(image, back, other, by.rule(supposed)), (by,))


def mirror_of(source: Source) -> By:
    """The mirror image of what was proved."""

    def rule(supposed: tuple[Theorem, ...]) -> Rule:
        (theorem,) = known(source, supposed)
        return rules.follows(rules.mirror(theorem))

    return By(rule, (source,))


def reach(source: Source) -> By:
    """A quantity of every bead, known at (0, 0) and by what it gains on both steps up."""

    def rule(supposed: tuple[Theorem, ...]) -> Rule:
        origin, *up = known(source, supposed)
        return rules.reach(origin, up)

    return By(rule, (source,))


def walk(
    start: Mapping[sympy.Symbol, sympy.Expr],
    following: Mapping[sympy.Symbol, sympy.Expr],
    count: sympy.Symbol,
    *sources: Source,
) -> By:
    """The site that a number of steps leads to."""
    return By(lambda _: rules.walk(start, following, count), sources)


def inverse(*sources: Source) -> By:
    """The right-hand side is the inverse matrix."""
    return By(lambda _: rules.inverse, sources)


def differentiate(root: sympy.Symbol, square: sympy.Expr, *sources: Source) -> By:
    """SymPy differentiates; the root is of what is positive."""
    return By(lambda _: rules.differentiate(root, square), sources)


def slope(*sources: Source) -> By:
    """SymPy differentiates by z."""
    return By(lambda _: rules.slope, sources)


# lines


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
        where: Where = _at(0, self.where)
        return where.limit.relation.split()[0] if where.limit else "="

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
        """Add a line and return it; ``options`` are further attributes of it."""
        self.append(self._line(reason, formula, by, number=len(self) + 1, **options))
        return self[-1]


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
    known = {*sy.INDICES, *sy.PARAMETERS, *sy.VECTORS, sy.d, sy.kappa, sy.N}
    about = printed.lhs.free_symbols - known
    if printed.lhs.has(sy.SiteFunction) or len(about) != 1:
        return ""
    (symbol,) = about
    slope = sympy.diff(candidate.lhs - candidate.rhs, symbol)
    if slope.has(symbol) or not where.never_zero(slope):
        return f"it does not fix {text(symbol)} everywhere"
    return ""
