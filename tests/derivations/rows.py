"""Equations as parameters of tests: those soon derived always, the others where CI runs."""

from collections.abc import Iterable
from typing import Any

import pytest
from force_diffusion.derivations.framework.catalogue import Number, modules, paper

SOON = {"B1", "B5", "B13", *paper()}
"""Equations of the paper, and rows that take a second at most: of discs, and of spheres."""
PLACES = {str(number): place for place, number in enumerate(modules())}


def each(numbers: Iterable[Number]) -> list[Any]:
    """Mark the other rows as long: a run of CI tries one in three, the same ones in every test."""
    return [number if number in SOON else late([number], share=3)[0] for number in numbers]


def late(cases: Iterable[Any], **wanted: int) -> list[Any]:
    """Mark cases as long; those about one row, or several that begin with it, go together."""
    marked = []
    for position, case in enumerate(cases):
        row = str(getattr(case, "number", case)).partition(",")[0]
        mark = pytest.mark.long(place=PLACES.get(row, position), **wanted)
        marked.append(pytest.param(case, marks=mark))
    return marked
