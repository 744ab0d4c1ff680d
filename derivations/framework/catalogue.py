"""Where the derivations are: one module per equation, known by its file name alone.

Nothing here imports SymPy until a derivation is loaded.
"""

import re
from functools import cache
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable

    from force_diffusion.derivations.framework.record import Derivation

_MODULE = re.compile(r"eq(\d\d)_\w+")


@cache
def modules() -> dict[int, str]:
    """Equation numbers and the modules that derive them, in the paper's order."""
    stems = sorted(path.stem for path in Path(__file__).parents[1].glob("eq*.py"))
    return {int(found[1]): stem for stem in stems if (found := _MODULE.fullmatch(stem))}


def load(number: int) -> "Derivation":
    """The derivation of one equation."""
    module = import_module(f"force_diffusion.derivations.{modules()[number]}")
    derivation: Derivation = module.DERIVATION
    return derivation


def with_premises(wanted: "Iterable[Derivation]") -> "list[Derivation]":
    """The derivations wanted and all that they rest on, premises first."""
    ordered: dict[int, Derivation] = {}

    def visit(derivation: "Derivation") -> None:
        if derivation.number not in ordered:
            for premise in derivation.premises:
                visit(premise)
            ordered[derivation.number] = derivation

    for derivation in wanted:
        visit(derivation)
    return list(ordered.values())
