"""Loads derivations by their numbers, alone or with all that they rest on."""

import copyreg
from collections.abc import Callable, Iterable
from importlib import import_module

from .catalogue import Number, modules
from .record import Derivation, Statement
from .rows import Row


def load(number: Number) -> Statement:
    """The derivation of one equation.

    A module has one, ``DERIVATION``, or several by their numbers, ``DERIVATIONS``.
    """
    module = import_module(f"force_diffusion.derivations.{modules()[number]}")
    several: dict[Number, Statement] = getattr(module, "DERIVATIONS", {})
    return several[number] if several else module.DERIVATION


def _pickled(derivation: Statement) -> tuple[Callable[[Number], Statement], tuple[Number]]:
    """Say how a derivation is had again: by its number, since it is made of functions."""
    return load, (derivation.number,)


for kind in (Derivation, Row):
    copyreg.pickle(kind, _pickled)


def with_premises(wanted: Iterable[Statement]) -> list[Statement]:
    """The derivations wanted and all that they rest on, premises first."""
    ordered: dict[Number, Statement] = {}

    def visit(derivation: Statement) -> None:
        if derivation.number not in ordered:
            for premise in derivation.premises:
                visit(premise)
            ordered[derivation.number] = derivation

    for derivation in wanted:
        visit(derivation)
    return list(ordered.values())
