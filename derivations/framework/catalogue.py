"""Where the derivations are: one module an equation of the paper, one a theorem beyond it.

The paper's equations have its numbers, 1 to 16; those of ``beyond/`` are this project's own and
have labels, "B1" and so on: several of them are cases of one theorem.

Nothing here imports SymPy.
"""

import re
from functools import cache
from pathlib import Path
from typing import TypeAlias

Number: TypeAlias = int | str
"""A number of the paper, or a label such as "B1"."""

_FOLDER = Path(__file__).parents[1]
_MODULE = re.compile(r"eq(\d\d)_\w+")
_BEYOND = re.compile(r"b(\d+)_\w+")

THEOREMS = {
    "t1_forces": (1,),
    "t2_variance": (2, 3),
    "t4_second_order": (4, 5, 6, 15, 16),
    "t5_stress": (10, 17, 18),
    "t6_correlations": (7, 8, 12, 21),
    "t7_response": (9,),
    "t8_any_dimension": (11, 13, 14, 20),
    "t9_spheres_response": (19,),
}
"""Modules of ``beyond/``, and the numbers of the equations that each derives."""


@cache
def modules() -> dict[Number, str]:
    """Equation numbers and the modules that derive them: the paper's, then those beyond it."""
    stems = sorted(path.stem for path in _FOLDER.glob("eq*.py"))
    printed: dict[Number, str] = {
        int(found[1]): stem for stem in stems if (found := _MODULE.fullmatch(stem))
    }
    beyond = {
        int(found[1]): path.stem
        for path in _FOLDER.glob("beyond/b*.py")
        if (found := _BEYOND.fullmatch(path.stem))
    }
    there = {path.stem for path in _FOLDER.glob("beyond/t*.py")}
    beyond |= {one: stem for stem, own in THEOREMS.items() if stem in there for one in own}
    return {**printed, **{f"B{number}": f"beyond.{beyond[number]}" for number in sorted(beyond)}}


def paper() -> list[int]:
    """The numbers of the paper's equations."""
    return [number for number in modules() if isinstance(number, int)]


def allowed() -> str:
    """The numbers that there are, in words."""
    own = [number for number in modules() if isinstance(number, str)]
    further = f", or {own[0]} to {own[-1]}" if len(own) > 1 else f", or {own[0]}" if own else ""
    return f"from {min(paper())} to {max(paper())}{further}"
