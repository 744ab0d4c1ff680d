"""Equations as parameters of tests: those soon derived always, the others where CI runs."""

from collections.abc import Iterable
from typing import Any

import pytest
from force_diffusion.derivations.framework.catalogue import Number, paper

SOON = {"B1", "B5", "B13", *paper()}
"""Equations of the paper, and rows that take a second at most: of discs, and of spheres."""


def each(numbers: Iterable[Number]) -> list[Any]:
    """Mark the other rows as long: a run of CI tries one in three, the same ones in every test."""
    return [number if number in SOON else late([number], share=3)[0] for number in numbers]


def late(cases: Iterable[Any], share: int = 1) -> list[Any]:
    """Mark cases as long."""
    return [pytest.param(case, marks=pytest.mark.long(share=share)) for case in cases]
