"""Where the derivations are: a module for each equation of the paper, and for each subject beyond.

The paper's equations have its numbers, 1 to 16; those of ``beyond/`` are this project's own and
have labels, "B1" and so on.

Nothing here imports SymPy.
"""

import re
from collections.abc import Iterable
from functools import cache
from numbers import Integral
from pathlib import Path
from typing import TypeAlias, cast

from force_diffusion.numeric.arithmetic.errors import ForceDiffusionError, quoted

Number: TypeAlias = int | str
"""A number of the paper, or a label such as "B1"."""


class NoSuchFormError(ForceDiffusionError, ValueError):
    """No such equation, or no such exact form; the message lists those that exist."""


_FOLDER = Path(__file__).parents[1]
_PREFIX = re.compile(r"eq(uation|n|s)?\.?", re.IGNORECASE)
_LONGEST = 40  # characters of what may be a number


_BEYOND = {
    "leaning": ("B1",),
    "beyond.variances": ("B2", "B3", "B11", "B13", "B14", "B20", "B24", "B25"),
    "beyond.means": ("B4", "B5", "B6", "B15", "B16"),
    "beyond.stress": ("B10", "B17", "B18"),
    "beyond.correlations": ("B7", "B8", "B12", "B21"),
    "beyond.response": ("B9", "B19", "B22", "B23"),
}
"""The labels by the modules that have them; the forces of B1 are what the calculator rests on."""


@cache
def modules() -> dict[Number, str]:
    """Equation numbers and the modules that derive them: the paper's, then those beyond it."""
    stems = sorted(path.stem for path in _FOLDER.glob("eq[0-9][0-9]_*.py"))
    by_number: dict[Number, str] = {int(stem[2:4]): stem for stem in stems}
    beyond = {label: module for module, labels in _BEYOND.items() for label in labels}
    return by_number | dict(sorted(beyond.items(), key=lambda item: int(item[0][1:])))


def in_order(numbers: Iterable[Number]) -> tuple[Number, ...]:
    """Numbers in the order of the paper, each of them once."""
    wanted = {*numbers}
    return tuple(number for number in modules() if number in wanted)


def number_of(given: object) -> Number:
    """The number or label that a number or a word from outside stands for.

    >>> number_of("13"), number_of("b5"), number_of("Eq. (13)")
    (13, 'B5', 13)

    Raises:
        NoSuchFormError: there is no such equation.
    """
    number = given
    if isinstance(given, str):
        word = _PREFIX.sub("", given[:_LONGEST].strip()).strip("() ")
        number = int(word) if word.isascii() and word.isdigit() and len(word) < 5 else word.upper()
    if isinstance(number, Integral | str) and not isinstance(number, bool) and number in modules():
        return cast(Number, number)
    own = [label for label in modules() if isinstance(label, str)]
    several = "; put spaces between several" if isinstance(given, str) and "," in given else ""
    raise NoSuchFormError(
        f"there is no equation {quoted(given)}: give a number from {min(paper())} to "
        f"{max(paper())}, or {own[0]} to {own[-1]}{several}"
    )


def paper() -> list[int]:
    """The numbers of the paper's equations."""
    return [number for number in modules() if isinstance(number, int)]
