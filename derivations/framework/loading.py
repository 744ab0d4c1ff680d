"""Loads derivations by their numbers, alone or with all that they rest on."""

from collections.abc import Iterable
from importlib import import_module

from force_diffusion.derivations.framework.catalogue import Number, modules
from force_diffusion.derivations.framework.record import Derivation
from force_diffusion.numeric.arithmetic.errors import ForceDiffusionError


def load(number: Number) -> Derivation:
    """The derivation of one equation.

    A module has one, ``DERIVATION``, or several by their numbers, ``DERIVATIONS``.
    """
    module = import_module(f"force_diffusion.derivations.{modules()[number]}")
    several: dict[Number, Derivation] = getattr(module, "DERIVATIONS", {})
    return several[number] if several else module.DERIVATION


def with_premises(wanted: Iterable[Derivation]) -> list[Derivation]:
    """The derivations wanted and all that they rest on, premises first.

    Raises:
        ForceDiffusionError: two of a user's own have one label.
    """
    ordered: dict[Number, Derivation] = {}

    def visit(derivation: Derivation) -> None:
        if derivation.number not in ordered:
            for premise in derivation.premises:
                visit(premise)
            ordered[derivation.number] = derivation
        elif derivation.number not in modules() and ordered[derivation.number] is not derivation:
            raise ForceDiffusionError(f"two derivations are called {derivation.number!r}")

    for derivation in wanted:
        visit(derivation)
    return list(ordered.values())
