"""What is found of a statement, and on what that rests.

A refutation is an explicit counterexample, found with Fractions on a small packing; a proof is
a normal form that is zero. The two share no code, and what neither settles is undecided. What has
no value, or no single meaning, somewhere on its domain is not a statement: neither is asked.
"""

from collections.abc import Iterable
from dataclasses import dataclass
from enum import StrEnum
from fractions import Fraction

import sympy

from .. import symbols as sy
from ..algebra import explicit
from ..algebra.exact import Domain, NotExactError, RationalFunction
from ..notation import by_name


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


@dataclass(frozen=True)
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


def proved(note: str = "", assuming: Iterable[str] = ()) -> Ruling:
    """Return the ruling of a proof, and of what it assumes."""
    kept = tuple(dict.fromkeys(assuming))
    return Ruling(Verdict.ASSUMING if kept else Verdict.PROVED, note, kept)


def refuted(note: str) -> Ruling:
    """Return the ruling of a counterexample."""
    return Ruling(Verdict.REFUTED, note)


def undecided(note: str) -> Ruling:
    """Return the ruling that says why nothing was decided."""
    return Ruling(Verdict.UNDECIDED, note)


def not_a_statement(note: str) -> Ruling:
    """Return the ruling on what has no value, or no single meaning, somewhere on its domain."""
    return Ruling(Verdict.NOT_A_STATEMENT, note)


GEOMETRIES = (
    explicit.geometry(Fraction(3, 5), Fraction(4, 5), Fraction(7, 3)),
    explicit.geometry(Fraction(21, 29), Fraction(20, 29), Fraction(5, 11)),
)
"""Two rational lattices, with φ of either sign, on which counterexamples are looked for."""


def decide_identity(left: sympy.Expr, right: sympy.Expr) -> Ruling:
    """Rule on left = right as rational functions, n_x² + n_y² = 1 and φ = n_y² − n_x² given.

    All other symbols and lattice quantities are independent variables here; both sides may be
    undefined where a denominator vanishes.
    """
    unknowns = by_name(
        left.free_symbols
        | right.free_symbols
        | left.atoms(sy.SiteFunction)
        | right.atoms(sy.SiteFunction)
    )
    field = Domain(dict.fromkeys([*unknowns, sy.n_x, sy.n_y, sy.phi]))
    try:
        difference = field.from_sympy(left) - field.from_sympy(right)
    except NotExactError as reason:
        return undecided(str(reason))
    if difference.is_zero():
        return proved("the difference is the zero rational function")
    return _apart(difference)


def _apart(difference: RationalFunction) -> Ruling:
    """Refute an identity by values of its symbols at which the two sides differ."""
    generators = difference.domain.generators
    for geometry in GEOMETRIES:
        # distinct odd primes for what is free; n_x, n_y and φ as on one of the lattices
        values = {g: Fraction(sympy.prime(place + 2)) for place, g in enumerate(generators)}
        values |= {s: Fraction(geometry[s]) for s in (sy.n_x, sy.n_y, sy.phi)}
        try:
            found = difference.at(values)
        except ZeroDivisionError:
            continue
        if found:
            where = ", ".join(f"{g} = {values[g]}" for g in generators if difference.holds(g))
            return refuted(f"left minus right is {found} at {where or 'any value'}")
    return undecided("the difference is not the zero function, yet no values show it")


def all_of(*rulings: Ruling) -> Ruling:
    """Return the worst of several rulings; all proved, their notes and assumptions together."""
    for verdict in (Verdict.REFUTED, Verdict.NOT_A_STATEMENT, Verdict.UNDECIDED):
        for ruling in rulings:
            if ruling.verdict is verdict:
                return ruling
    notes = dict.fromkeys(ruling.note for ruling in rulings)
    return proved("; ".join(notes), (one for ruling in rulings for one in ruling.assuming))
