"""Loads derivations by their numbers, alone or with all that they rest on."""

import copyreg
from collections.abc import Callable, Iterable
from importlib import import_module

from .catalogue import Number, modules
from .record import Derivation


def load(number: Number) -> Derivation:
    """The derivation of one equation.

    A module has one, ``DERIVATION``, or several by their numbers, ``DERIVATIONS``.
    """
    module = import_module(f"force_diffusion.derivations.{modules()[number]}")
    several: dict[Number, Derivation] = getattr(module, "DERIVATIONS", {})
    return several[number] if several else module.DERIVATION


def _pickled(derivation: Derivation) -> tuple[Callable[[Number], Derivation], tuple[Number]]:
    """Say how a derivation is had again: by its number, since it is made of functions."""
    return load, (derivation.number,)


copyreg.pickle(Derivation, _pickled)


def with_premises(wanted: Iterable[Derivation]) -> list[Derivation]:
    """The derivations wanted and all that they rest on, premises first."""
    ordered: dict[Number, Derivation] = {}

    def visit(derivation: Derivation) -> None:
        if derivation.number not in ordered:
            for premise in derivation.premises:
                visit(premise)
            ordered[derivation.number] = derivation

    for derivation in wanted:
        visit(derivation)
    return list(ordered.values())
