"""Rules of the kernel with what they rest on: the grounds that a line names.

What a rule rests on are objects, lines, equations and axioms, and is resolved when something is to
be proved.
"""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cache, cached_property
from typing import Any, Protocol

import sympy
from force_diffusion.symbolic.as_printed import equation
from force_diffusion.symbolic.kernel import limits, rules, statistics
from force_diffusion.symbolic.kernel.rules import Rule
from force_diffusion.symbolic.kernel.theorem import (
    Supposition,
    Theorem,
    flat,
    put_in,
)
from force_diffusion.symbolic.kernel.where import Where


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

    lines: Callable[[], Sequence[Proved]]
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


def moment(*facts: Source) -> By:
    """Both sides are the same once facts are put in and means and variances are worked out."""
    return By(lambda supposed: statistics.moment(*flat(facts_of(facts, supposed))), facts)


def closed(theorems: Callable[[], tuple[Theorem, ...]], *facts: Source) -> By:
    """A closed form, as it is known on parts of its domain; other formulas as by ``moment``."""

    def rule(supposed: tuple[Theorem, ...]) -> Rule:
        def prove(formula: sympy.Eq, where: Where) -> Theorem:
            for one in theorems():
                if one.formula == formula and one.where == where:
                    return one
            return statistics.moment(*flat(facts_of(facts, supposed)))(formula, where)

        return prove

    return By(rule, facts)


def asymptotic(*facts: Source) -> By:
    """Both sides are of the same leading order, moments worked out at finite size."""
    return By(
        lambda supposed: limits.asymptotic(*facts_of(facts, supposed)),
        facts,
        lambda formula, where: statistics.worked_out(formula, where, flat(facts_of(facts))),
    )


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

    first = sympy.Integer(start) if isinstance(start, int) else start

    def rule(supposed: tuple[Theorem, ...]) -> Rule:
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
