"""Rulings on candidates for an exact form, at every size that it is for."""

from collections.abc import Iterator
from typing import Any

import sympy
from force_diffusion.symbolic import symbols as sy
from force_diffusion.symbolic.as_printed import equation, in_place
from force_diffusion.symbolic.kernel.decisions import (
    Ruling,
    all_of,
    decide_identity,
    not_a_statement,
    refuted,
    undecided,
)
from force_diffusion.symbolic.kernel.language import says_less, unreadable, usual_form
from force_diffusion.symbolic.kernel.where import Where
from force_diffusion.symbolic.mechanics.lattice import kappa_in
from force_diffusion.symbolic.notation import by_name
from force_diffusion.symbolic.search.counterexample import counterexample
from force_diffusion.symbolic.search.values import WithoutValue

from .proving import no_statement
from .record import (
    Derivation,
    ExactCase,
    proved_by_line,
)

_EVERYWHERE: tuple[Any, ...] = (
    sympy.Ge(sy.M, 1, evaluate=False),
    sy.j >= 0,
    sy.l >= 0,
    sy.j <= sy.M - 1,
    sy.j <= sy.l,
)
"""What holds of heights and layers wherever they stand together."""


def in_whole_numbers(relation: sympy.Basic) -> sympy.Basic:
    """A relation without fractions."""
    left, right = relation.args
    apart = sympy.expand(left - right)
    common = sympy.ilcm(1, *(one.q for one in apart.as_coefficients_dict().values()))
    return (
        relation.func(sympy.expand(common * apart), 0, evaluate=False) if common > 1 else relation
    )


def rule_on_exact(derivation: Derivation, case: ExactCase, candidate: sympy.Eq) -> Ruling:
    """Rule on a candidate for an exact form, on all of the form's domain, with "=".

    By the line that proves the form; where it has none yet, by comparison with the form: both are
    the same rational function on each part of its domain, or explicit numbers are looked for.
    Sums that the form itself holds are the same number on both sides.

    Raises:
        KernelError: the checker is at fault.
    """
    sums = {one: sympy.Dummy(f"sum_{n}") for n, one in enumerate(case.expression.atoms(sympy.Sum))}
    printed = equation(case.quantity, case.expression)
    own = equation(case.quantity, in_place(case.expression, sums))
    held = set().union(*(one.free_symbols for one in (*case.domain, *_whens(case))))
    named = [*(symbol for symbol, _ in derivation.symbols), *held, *sums.values()]
    given = in_place(candidate, sums)
    if refusal := unreadable(given, (own,), named, derivation.dimension):
        return refusal
    if case.line:
        usual = usual_form(candidate, (printed,))
        place = case.line.equations.index(printed)
        if reason := case.line.unlike("=", place, f"the exact form of {derivation.words}"):
            return undecided(reason)
        return proved_by_line(derivation, case.line, place, printed, usual)
    return _compared(derivation, case, own, usual_form(given, (own,)), sums)


def _compared(
    derivation: Derivation,
    case: ExactCase,
    own: sympy.Eq,
    given: sympy.Eq,
    sums: dict[sympy.Basic, sympy.Dummy],
) -> Ruling:
    """Rule on a candidate by comparison with the form, on each part of its domain."""
    if given.has(sy.SiteFunction):
        return undecided("it holds what belongs to a single bead, which is not read here")
    parts = list(_parts(case, own, given))
    for where in parts:
        if reason := no_statement(given, where):
            return not_a_statement(reason)
    if less := says_less(given, own):
        return undecided(less)
    known = {**_observed(own), sy.kappa: kappa_in(derivation.dimension)}
    rulings = []
    for where in parts:
        sides = [side.xreplace(known).xreplace(dict(where.solved)) for side in given.args]
        ruling = decide_identity(*sides)
        if not ruling.verdict.is_proved:
            back = {dummy: series for series, dummy in sums.items()}
            asked = equation(*(side.xreplace(known).xreplace(back) for side in given.args))
            found = counterexample(asked, where)
            if isinstance(found, WithoutValue):
                return not_a_statement(str(found))
            return refuted(found) if found else undecided("it is not shown to be the exact form")
        rulings.append(ruling)
    return all_of(*rulings)


def _observed(own: sympy.Eq) -> dict[sympy.Basic, sympy.Expr]:
    """The statistic that a form is about, in terms of indices and parameters."""
    about = own.lhs.free_symbols - {*sy.INDICES, *sy.PARAMETERS}
    if len(about) != 1:
        return {own.lhs: own.rhs}
    (symbol,) = about
    return {symbol: (own.rhs - own.lhs.xreplace({symbol: sympy.S.Zero})) / own.lhs.coeff(symbol)}


def _whens(case: ExactCase) -> list[sympy.Basic]:
    return [one for missed in case.missed for one in missed.when]


def _parts(case: ExactCase, own: sympy.Eq, given: sympy.Eq) -> Iterator[Where]:
    """The domain of a form, without the packings that it is not for, in parts with packings."""
    domain = [in_whole_numbers(one) for one in case.domain]
    held = (*domain, *_whens(case), own, given)
    free = set().union(*(one.free_symbols for one in held)) & {*sy.INDICES}
    general = [one for one in _EVERYWHERE if one.free_symbols <= free]
    parts = [Where.of(*domain, *general, indices=by_name(free))]
    for missed in case.missed:
        outside = [in_whole_numbers(one) for one in _opposites(missed.when)]
        parts = [part.also(one) for part in parts for one in outside]
        parts = [part for part in parts if not part.is_empty]
    yield from parts


def _opposites(relations: tuple[sympy.Basic, ...]) -> Iterator[sympy.Basic]:
    """Relations between whole numbers of which at least one holds where not all of these do."""
    for one in relations:
        left, right = one.args
        if isinstance(one, sympy.Eq):
            yield sympy.Lt(left, right, evaluate=False)
            yield sympy.Gt(left, right, evaluate=False)
        else:
            yield one.negated
