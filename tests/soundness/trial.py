"""The checker on trial: changes of what is printed, and statements of known truth.

A change that is proved has to be listed as one that says the same. No false statement may be
proved, and no true one refuted.
"""

import gc
from collections.abc import Iterator
from functools import _lru_cache_wrapper, cached_property

from force_diffusion.derivations.framework.catalogue import modules
from force_diffusion.derivations.framework.loading import load
from force_diffusion.derivations.framework.record import Derivation, KernelError
from force_diffusion.derivations.framework.runner import run
from force_diffusion.symbolic.kernel.decisions import Ruling, Verdict

from tests.properties.mutants import EQUIVALENT, Mutated, mutants
from tests.soundness.corpus import Statement, statements
from tests.soundness.sources import Form, Source

DERIVED = [number for number in modules() if isinstance(load(number), Derivation)]
"""The equations that the rules prove step by step; rows are closed forms."""


class FaultError(AssertionError):
    """The checker is at fault: its verdict on a statement is wrong."""


def source_of(derivation: Derivation, part: int) -> Source:
    """One of the printed equations, as other statements are made from it."""
    printed, where = derivation.printed[part], derivation.domain_of(part)
    forms = (
        Form(f"{name}, {piece.domain}", piece.expr, place > 0)
        for name, form in derivation.exact_forms.items()
        if form.quantity == printed.lhs and where.limit
        for place, piece in enumerate(form.pieces)
    )
    return Source(printed, derivation.relation, tuple(forms), where, derivation.dimension)


def judged_mutants(derivation: Derivation) -> Iterator[tuple[Mutated, Ruling]]:
    """Change each printed equation mechanically and let the same procedure rule on it.

    Raises:
        FaultError: one is proved that is not listed as saying the same.
    """
    listed = EQUIVALENT.get(derivation.number, {})
    for place, equation in enumerate(derivation.printed):
        for mutant in mutants(equation):
            ruling = derivation.rule_on(place, mutant.equation)
            if ruling.verdict.is_proved and mutant.change not in listed:
                raise FaultError(f"Eq. {derivation.number}, proved: {mutant.change}")
            yield mutant, ruling


def tried(derivation: Derivation) -> Iterator[tuple[Statement, Ruling]]:
    """Try the same procedure on statements that are known to be false, or true.

    One of each kind for each printed equation; other ones for other equations.

    Raises:
        FaultError: a false one is proved, or a true one refuted.
    """
    turn = sum(map(ord, str(derivation.number)))
    for place in range(len(derivation.printed)):
        for statement in statements(source_of(derivation, place), turn):
            ruling = derivation.rule_on(place, statement.equation, statement.where)
            refuted = ruling.verdict is Verdict.REFUTED
            if refuted if statement.holds else ruling.verdict.is_proved:
                raise FaultError(f"Eq. {derivation.number}, {ruling.verdict}: {statement.reason}")
            yield statement, ruling


def is_noticed(derivation: Derivation) -> bool:
    """Whether an equation's proofs, changes of it, or statements show that something is wrong."""
    try:
        return (
            not run(derivation).verdict.is_proved
            or any(ruling.verdict is Verdict.UNDECIDED for _, ruling in judged_mutants(derivation))
            or any(one.holds and not ruling.verdict.is_proved for one, ruling in tried(derivation))
        )
    except (FaultError, KernelError):
        return True


def forget() -> None:
    """Forget all that was worked out, since a planted fault may have had a part in it."""
    for one in gc.get_objects():
        if isinstance(one, _lru_cache_wrapper):
            function = one.__wrapped__
            if _is_own(getattr(function, "func", function)):  # that of a partial
                one.cache_clear()
        elif _is_own(type(one)) and hasattr(one, "__dict__"):
            for name in [*vars(one)]:
                if isinstance(getattr(type(one), name, None), cached_property):
                    del vars(one)[name]


def _is_own(one: object) -> bool:
    module = getattr(one, "__module__", None)
    return isinstance(module, str) and module.startswith(
        ("force_diffusion.symbolic", "force_diffusion.derivations", "tests.soundness.attacks")
    )
