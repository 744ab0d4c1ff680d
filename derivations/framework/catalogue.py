"""Where the derivations are: one module an equation of the paper, one a theorem beyond it.

The paper's equations have its numbers, 1 to 16; those of ``beyond/`` are this project's own and
have labels, "B1" and so on. Each is a case of a theorem, "T1" and so on.

Nothing here imports SymPy.
"""

import re
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import TypeAlias

Number: TypeAlias = int | str
"""A number of the paper, or a label such as "B1"."""

_FOLDER = Path(__file__).parents[1]
_MODULE = re.compile(r"eq(\d\d)_\w+")


@dataclass(frozen=True)
class Theorem:
    """What one module of ``beyond/`` proves, for every load and direction that its cases have.

    Attributes:
        name: "T1" and so on.
        title: what it is about.
        module: the file below ``beyond/``.
        cases: the labels of its equations.
    """

    name: str
    title: str
    module: str
    cases: tuple[str, ...]


THEOREMS = (
    Theorem("T1", "forces under loads in any direction", "t1_forces", ("B1",)),
    Theorem("T2", "variance of the forces", "t2_variance", ("B2", "B3")),
    Theorem(
        "T4",
        "mean positions and forces, to second order",
        "t4_second_order",
        ("B4", "B5", "B6", "B15", "B16"),
    ),
    Theorem("T5", "mean stress, and closures for it", "t5_stress", ("B10", "B17", "B18")),
    Theorem(
        "T6",
        "correlations, and means over neighbours",
        "t6_correlations",
        ("B7", "B8", "B12", "B21"),
    ),
    Theorem(
        "T7",
        "mean response to a point load, and averages of the response",
        "t7_response",
        ("B9", "B22", "B23"),
    ),
    Theorem(
        "T8",
        "any dimension",
        "t8_any_dimension",
        ("B11", "B20", "B13", "B14", "B24", "B25"),
    ),
    Theorem("T9", "response in three dimensions", "t9_spheres_response", ("B19",)),
)
"""The theorems beyond the paper; T3, how far Eq. 13 is valid, is fitted, and not proved yet."""


@cache
def modules() -> dict[Number, str]:
    """Equation numbers and the modules that derive them: the paper's, then those beyond it."""
    stems = sorted(path.stem for path in _FOLDER.glob("eq*.py"))
    printed: dict[Number, str] = {
        int(found[1]): stem for stem in stems if (found := _MODULE.fullmatch(stem))
    }
    beyond: dict[Number, str] = {
        label: f"beyond.{one.module}" for one in THEOREMS for label in one.cases
    }
    return {**printed, **dict(sorted(beyond.items(), key=lambda one: int(str(one[0])[1:])))}


def number_of(word: str) -> Number | None:
    """The number or label that a word from outside stands for; None where there is none.

    >>> number_of("13"), number_of("b5"), number_of("17")
    (13, 'B5', None)
    """
    is_short = word.isascii() and len(word) < 5
    number: Number = int(word) if is_short and word.isdigit() else word.upper()
    return number if number in modules() else None


def theorem_of(number: Number) -> Theorem | None:
    """The theorem that an equation is a case of; None for those of the paper."""
    return next((one for one in THEOREMS if number in one.cases), None)


def cases_of(name: Number) -> tuple[str, ...]:
    """The labels of a theorem's equations, by its name; none where there is no such theorem."""
    return next((one.cases for one in THEOREMS if one.name == name), ())


def paper() -> list[int]:
    """The numbers of the paper's equations."""
    return [number for number in modules() if isinstance(number, int)]


def allowed() -> str:
    """The numbers that there are, in words."""
    own = [number for number in modules() if isinstance(number, str)]
    return f"from {min(paper())} to {max(paper())}, or {own[0]} to {own[-1]}"
