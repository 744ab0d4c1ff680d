"""Loads derivations by their numbers, alone or with all that they rest on."""

import copyreg
from collections.abc import Callable, Iterable, Iterator
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


def with_premises(
    wanted: Iterable[Number], watch: Callable[[Statement], None] = lambda _: None
) -> Iterator[Statement]:
    """Those wanted and all that they rest on, premises first, each as soon as it is known.

    Proofs say what they rest on: each one is run.

    Args:
        wanted: their numbers.
        watch: called with each before its proof is run.
    """
    seen: set[Number] = set()

    def visit(number: Number) -> Iterator[Statement]:
        if number not in seen:
            seen.add(number)
            statement = load(number)
            watch(statement)
            for premise in statement.premises:
                yield from visit(premise)
            yield statement

    for number in wanted:
        yield from visit(number)
