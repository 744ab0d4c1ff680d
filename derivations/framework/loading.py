"""Loads derivations by their numbers, alone or with all that they rest on."""

from collections.abc import Iterable
from importlib import import_module

from force_diffusion.derivations.framework.catalogue import Number, modules
from force_diffusion.derivations.framework.record import Derivation


def load(number: Number) -> Derivation:
    """The derivation of one equation."""
    module = import_module(f"force_diffusion.derivations.{modules()[number]}")
    derivation: Derivation = module.DERIVATION
    return derivation


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
