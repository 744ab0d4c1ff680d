"""The shape of a derivation: what every ``eqNN_…`` module states, and what running it yields."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property

import sympy
from force_diffusion.numeric.arithmetic.errors import ForceDiffusionError
from force_diffusion.symbolic import symbols as sy
from force_diffusion.symbolic.algebra.exact import NotExactError
from force_diffusion.symbolic.kernel import rules
from force_diffusion.symbolic.kernel.decisions import (
    Ruling,
    Verdict,
    in_words,
    not_a_statement,
    proved,
    refuted,
    undecided,
)
from force_diffusion.symbolic.kernel.language import (
    is_of_vectors,
    says_less,
    unreadable,
    usual_form,
)
from force_diffusion.symbolic.kernel.theorem import NotProvedError, Theorem
from force_diffusion.symbolic.kernel.where import Where
from force_diffusion.symbolic.printing.latex import RELATIONS
from force_diffusion.symbolic.printing.lines import column_width, latex_body, text_lines
from force_diffusion.symbolic.printing.text import text
from force_diffusion.symbolic.search.values import WithoutValue

from ..formulas.closed_form import ClosedForm
from .catalogue import Number
from .proving import (
    Line,
    Lines,
    Refuted,
    assumptions,
    fixes_it,
    no_statement,
)


class KernelError(ForceDiffusionError, RuntimeError):
    """The checker is at fault: its verdict on a statement is wrong. Nothing it says then counts."""


_ALARM = 24  # points at which what was proved is looked at all the same


@dataclass(frozen=True)
class Claim:
    """Something that a decision procedure rules on."""

    name: str
    decide: Callable[[], Ruling]


_MEANINGS = {
    sy.sigma: "standard deviation σ_δr of the radii",
    sy.r: "mean radius",
    sy.M: "height of the packing",
    sy.z: "relative height j/M",
    sy.phi: "n⁺·n⁻",
    sy.N: "number of neighbours",
    sy.t: "L⁻/L⁺ of the load −(L⁺n⁺ + L⁻n⁻)",
    sy.t_2: "L²/L¹ of the load −Σ_a L^a n^a",
    sy.t_3: "L³/L¹",
}


def usual(*symbols: sympy.Symbol) -> tuple[tuple[sympy.Symbol, str], ...]:
    """Symbols with their usual meaning in words, those that have one: σ, r, M, z, φ and others."""
    return tuple((symbol, _MEANINGS[symbol]) for symbol in symbols if symbol in _MEANINGS)


FIRST_ORDER = ("the radii are independent, of zero mean and variance σ²", "first order in δr")
SECOND_ORDER = (
    "the radii are independent, of zero mean and variance σ², of whatever law",
    "second order in δr",
)
"""What is assumed of all variances and covariances, and of all mean values."""


class Statement:
    """An equation and how it is decided: a derivation, or a row of the calculator."""

    number: Number
    name: str
    title: str
    symbols: tuple[tuple[sympy.Basic, str], ...]
    assumptions: tuple[str, ...]
    premises: tuple["Statement", ...]
    printed: tuple[sympy.Eq, ...]
    claims: tuple[Claim, ...]
    remarks: tuple[str, ...]
    relation: str
    dimension: int
    loads: tuple[str, ...]
    steps: Callable[[], Lines]
    exact: Callable[[], dict[str, ClosedForm]] | None
    call: str
    """How the calculator is asked for it; "" where it is no row of that."""

    @cached_property
    def exact_forms(self) -> dict[str, ClosedForm]:
        """Closed forms, exact at finite size, by name; the first is the usual one."""
        return self.exact() if self.exact else {}

    def latex(self, columns: int = 1) -> str:
        """What is printed, for one display in text of one column or of two."""
        return latex_body(self.printed, RELATIONS[self.relation], column_width(columns))

    def displays(self, columns: int = 1) -> list[str]:
        """The same, in as many displays as it takes to fit pages."""
        return [self.latex(columns)]

    def lines(self, room: int) -> list[str]:
        """What is printed, as lines of plain text."""
        return [
            line for equation in self.printed for line in text_lines(equation, self.relation, room)
        ]

    def domain_of(self, part: int) -> Where:
        """Where one of ``printed`` is proved."""
        line, place = self._line_of(self.printed[part])
        return line.domain(place)

    def rule_on(self, part: int, candidate: sympy.Eq, where: Where | None = None) -> Ruling:
        """Rule on a candidate for one of ``printed``: decided, in the language, and searched.

        The kernel rules on it on another domain, too: ``where``.

        Raises:
            KernelError: it was proved, and explicit values refute it.
        """
        if reason := self.unlike(part):
            return undecided(reason)
        named = [symbol for symbol, _ in self.symbols]
        if refusal := unreadable(candidate, self.printed, named, self.dimension):
            return refusal
        candidate = usual_form(candidate, self.printed)
        return self._by_the_kernel(part, candidate, where)

    def unlike(self, part: int) -> str:
        """Why the printed sign of a part is not that of what is proved; "" when it is.

        What holds to leading order would be taken for exact otherwise, or the reverse.
        """
        try:
            line, place = self._line_of(self.printed[part])
        except LookupError as missing:
            return str(missing)
        return line.unlike(self.relation, place, self.words)

    @property
    def words(self) -> str:
        """How a line that rests on it names it."""
        return f"Eq. {self.number}"

    @property
    def theorems(self) -> tuple[Theorem, ...]:
        """What the kernel proves of it, one theorem for each printed equation."""
        return tuple(line.theorems[place] for line, place in map(self._line_of, self.printed))

    @property
    def assumed(self) -> list[str]:
        """What is assumed of its printed equations that no rule ends."""
        return assumptions(self.theorems)

    @property
    def all_claims(self) -> tuple[Claim, ...]:
        """What else is claimed of it, by the kernel's lines and by procedures of its own."""
        further = self.steps().claims
        return (*(Claim(one.reason, one.decide) for one in further), *self.claims)

    @property
    def refuted(self) -> tuple[Refuted, ...]:
        """The printed statements that are known not to hold; ``printed`` are those that do."""
        return tuple(self.steps().refuted)

    def _line_of(self, printed: sympy.Eq) -> tuple[Line, int]:
        """The line that shows a printed equation, and its place there.

        Raises:
            LookupError: there is none.
        """
        for line in self.steps():
            if printed in line.equations:
                return line, line.equations.index(printed)
        raise LookupError(f"no line of {self.words} shows what is printed")

    def _by_the_kernel(self, part: int, candidate: sympy.Eq, where: Where | None) -> Ruling:
        printed = self.printed[part]
        line, place = self._line_of(printed)
        line = line if where is None else replace(line, where=where)
        ruling = proved_by_line(self, line, place, printed, candidate)
        if not ruling.verdict.is_proved:
            return ruling
        try:
            theorems = self.theorems
        except NotProvedError:  # what is printed is none, and the candidate is
            theorems = (line.prove(place, candidate),)
        if any(one.supposed for one in theorems):
            return undecided("it rests on what is only supposed")
        return ruling

    def fault(self, statement: sympy.Eq, words: str) -> KernelError:
        """The error that says what the checker got wrong."""
        return KernelError(
            f"the checker is at fault, and its verdicts count for nothing. Of Eq. {self.number} it "
            f"got wrong: {_shown(statement)} ({words})"
        )


@dataclass(frozen=True)
class Derivation(Statement):
    """One numbered equation: what is printed, why it holds, and how it is checked.

    ``steps`` is a function so that importing a derivation proves nothing and costs nothing. One
    of its lines is the printed equation: anything said in its place is proved by the same rule, or
    not.

    Attributes:
        number: of the paper; beyond it a label such as "B1".
        name: in code and JSON.
        title: in words.
        symbols: each with its meaning; ``usual`` gives the common ones.
        assumptions: in words.
        premises: the derivations that it rests on.
        printed: the equations, each of which is the formula of a line.
        steps: gives the lines.
        claims: what else a procedure of its own decides.
        remarks: in words.
        where: where the kernel proves it, with the load and the limit.
        dimension: of the packing.
        loads: in words, for Coq: "surface", "bulk" or "single".
        relation: the printed sign, as the line of ``printed`` has to prove it: "=", at every size
            in its domain; "∼", left over right goes to 1 in its limit (``asymptotic``); "≈",
            what is dropped varies less, by an order, than the force it is about (``negligible``);
            "∝", left over right goes to a positive function of φ alone. With another sign nothing
            is decided of it.
        exact: gives closed forms, exact at finite size, by name; the first is the usual one.
    """

    call = ""
    number: Number
    name: str
    title: str
    symbols: tuple[tuple[sympy.Basic, str], ...]
    assumptions: tuple[str, ...]
    premises: tuple[Statement, ...]
    printed: tuple[sympy.Eq, ...]
    steps: Callable[[], Lines]
    claims: tuple[Claim, ...] = ()
    remarks: tuple[str, ...] = ()
    where: Where | None = None  # with the load
    dimension: int = 2  # of the packing: −1/d < φ < 1/2
    loads: tuple[str, ...] = ()  # "single", "surface", "bulk", or "any" but on the bead passed
    relation: str = "="  # how the printed equation relates its sides: "=", "≈", "∼" or "∝"
    exact: Callable[[], dict[str, ClosedForm]] | None = None  # at finite size, by name


def proved_by_line(
    derivation: Statement, line: Line, place: int, printed: sympy.Eq, candidate: sympy.Eq
) -> Ruling:
    """Rule on a candidate for what a line prints: by its rule, as the whole or as a component.

    Raises:
        KernelError: it was proved, and explicit values refute it.
    """
    where = line.domain(place)
    if is_of_vectors(printed) and not is_of_vectors(candidate):
        ruling = _component(line, place, candidate)
    else:
        ruling = line.rule_on(place, candidate)
        less = fixes_it(candidate, printed, where) or says_less(candidate, printed)
        if ruling.verdict.is_proved and less:
            return undecided(less)
    if not ruling.verdict.is_proved or candidate == printed:
        return ruling
    if found := line.counterexample(place, candidate, _ALARM):
        raise derivation.fault(candidate, f"proved, yet false: {found}")
    return ruling


def _component(line: Line, place: int, candidate: sympy.Eq) -> Ruling:
    """Rule on what is said of one component of an equation between vectors."""
    theorem = line.theorems[place]
    for vector in (sy.e_x, *sy.VECTORS):
        try:
            rules.follows(rules.along(theorem, vector))(candidate, theorem.where)
        except (NotProvedError, NotExactError, ArithmeticError, RecursionError):
            continue
        return proved(
            f"the component along {text(vector)}, by the rule: follows", assumptions([theorem])
        )
    found = line.counterexample(place, candidate)
    if found and not isinstance(found, WithoutValue):
        return refuted(found)
    if reason := no_statement(candidate, theorem.where) or found:
        return not_a_statement(str(reason))
    return undecided("it is no component of the equation")


def _shown(candidate: sympy.Eq) -> str:
    shown = f"{text(candidate.lhs)} = {text(candidate.rhs)}"
    return shown if len(shown) <= 200 else shown[:198] + " …"


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


@dataclass(frozen=True)
class Outcome:
    """All that running one derivation found."""

    derivation: Statement
    verdict: Verdict
    checks: tuple[Check, ...]
    seconds: float = 0.0

    @property
    def refuted(self) -> tuple[Check, ...]:
        """The printed statements that were refuted as expected; the verdict is on the others."""
        return tuple(check for check in self.checks if check.is_expected)

    @property
    def assuming(self) -> tuple[str, ...]:
        """What its proofs assume and no rule discharges, where it is proved."""
        if not self.verdict.is_proved:
            return ()
        return tuple(dict.fromkeys(words for one in self.checks for words in one.assuming))

    @property
    def words(self) -> str:
        """Its verdict, and what it assumes."""
        return in_words(self.verdict, self.assuming)
