"""Loads derivations by their numbers, alone or with all that they rest on."""

import copyreg
from collections.abc import Callable, Iterable
from importlib import import_module
from typing import Any

from .catalogue import Number, modules
from .record import Derivation, Statement


def load(number: Number) -> Statement:
    """The derivation of one equation, or a row of the calculator.

    A module has one, ``DERIVATION``, or several by their numbers, ``DERIVATIONS``.
    """
    module = import_module(f"force_diffusion.derivations.{modules()[number]}")
    several: dict[Number, Statement] = getattr(module, "DERIVATIONS", {})
    return several[number] if several else module.DERIVATION


def pickled(statement: Statement) -> tuple[Callable[[Number], Any], tuple[Number]]:
    """Say how a derivation is had again: by its number, since it is made of functions."""
    return load, (statement.number,)


copyreg.pickle(Derivation, pickled)


def with_premises(wanted: Iterable[Statement]) -> list[Statement]:
    """The derivations wanted and all that they rest on, premises first."""
    ordered: dict[Number, Statement] = {}

    def visit(statement: Statement) -> None:
        if statement.number not in ordered:
            for premise in statement.premises:
                visit(premise)
            ordered[statement.number] = statement

    for statement in wanted:
        visit(statement)
    return list(ordered.values())
