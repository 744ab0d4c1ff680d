"""Decides candidates that are put in the place of a printed equation."""

from collections.abc import Iterator, Mapping

import sympy
from force_diffusion.symbolic import sets
from force_diffusion.symbolic import symbols as sy
from force_diffusion.symbolic.algebra.exact import NotExactError, NotProvedError
from force_diffusion.symbolic.kernel import axioms, rules
from force_diffusion.symbolic.kernel.decisions import Ruling, decide, not_a_statement, undecided
from force_diffusion.symbolic.kernel.domain import Domain, Limit
from force_diffusion.symbolic.kernel.limits import large
from force_diffusion.symbolic.kernel.rules import Rule
from force_diffusion.symbolic.kernel.statistics import moment
from force_diffusion.symbolic.kernel.theorem import Group, Theorem
from force_diffusion.symbolic.notation import by_name
from force_diffusion.symbolic.piecewise import alternatives_of
from force_diffusion.symbolic.printing.text import text
from force_diffusion.symbolic.trees import in_place

from .deciding import OURS, over_read_indices, strange_symbol, unread
from .record import Derivation, load


def candidate_for(
    statement: Derivation,
    part: int,
    candidate: sympy.Eq,
    at: Mapping[sympy.Symbol, sympy.Integer] | None = None,
) -> Ruling:
    """Rule on a candidate for one of the printed equations.

    Args:
        statement: a derivation.
        part: which of its printed equations is meant.
        candidate: what is said in its place.
        at: indices, at which alone it is to hold.
    """
    named = {symbol for symbol, _ in statement.symbols if isinstance(symbol, sympy.Symbol)}
    if reason := strange_symbol(candidate, {*OURS, *named, *statement.domain.indices}):
        return not_a_statement(reason)
    step, place = statement.step_of(part)
    domain = step.domains[place]
    if at:
        if domain.limit:
            words = f"it holds in a limit ({domain.limit.words}), not in one packing"
            return not_a_statement(words)
        domain = domain.also(*(sympy.Eq(s, n, evaluate=False) for s, n in at.items()))
    formula = in_place(over_read_indices(candidate, domain), step.definitions[place])
    if domain.limit and formula.has(sympy.Piecewise):
        try:
            formula = _in_limit(formula, domain, domain.limit)
        except NotExactError as error:
            return unread(error)
    if domain.limit and (own := by_name(formula.free_symbols - OURS - {sy.H_M})):
        return undecided(f"a limit is read in the equation's symbols, and {text(own[0])} is none")
    return decide(formula, domain, [step.rules[place], *_further(statement, formula, domain)])


def _in_limit(formula: sympy.Eq, domain: Domain, limit: Limit) -> sympy.Eq:
    """A formula with the case of a ``Piecewise`` that holds wherever all that grows is large.

    Raises:
        NotExactError: there is none, or its relations are not read.
    """
    late = large(domain, limit) & domain.points
    for inside, relations in alternatives_of(formula):
        here = late & sets.where(*map(domain.straight.relation, relations))
        if late.is_subset(here):
            return inside
        if not here.is_empty():
            break
    raise NotExactError(f"no case of it holds in all of {limit.words}")


def _further(statement: Derivation, formula: sympy.Eq, domain: Domain) -> Iterator[Rule]:
    """Rules that decide more than the step does."""
    if domain.limit:
        yield from statement.deciders()
        return
    theorems = statement.theorems
    loads = axioms.loads(domain.loading) if domain.loading else ()
    groups = (*theorems, *loads), *_geometry()
    if formula.has(sy.Moment):
        yield moment(*groups)
        return
    for theorem in theorems:
        yield rules.follows(theorem)
        for vector in (sy.e_x, *sy.VECTORS):
            yield rules.follows(rules.along(theorem, vector))
    if domain.loading == axioms.LOADED:
        yield _under_a_vertical_load
    else:
        yield rules.rewrite(*groups)


def _under_a_vertical_load(formula: sympy.Eq, domain: Domain) -> Theorem:
    """Refute what is to hold under any load on a bead, if it fails under a vertical one."""
    loads = axioms.loads(axioms.LOADED_VERTICALLY)
    groups = (*load(7).theorems, *loads), *_geometry()
    rules.rewrite(*groups)(formula, domain.loaded(axioms.LOADED_VERTICALLY))
    raise NotProvedError("it holds under a vertical load; whether under any is not decided")


def _geometry() -> tuple[Group, ...]:
    """Contact directions, and the positions in which they are, in the radii."""
    positions, plus, minus = (load(number).theorem for number in (3, 4, 5))
    return (plus, minus), (positions, axioms.base())
