"""Decides candidates that are put in the place of a printed equation."""

from collections.abc import Iterator, Mapping

import sympy
from force_diffusion.symbolic import sets
from force_diffusion.symbolic import symbols as sy
from force_diffusion.symbolic.algebra.exact import NotAStatementError, NotExactError, NotProvedError
from force_diffusion.symbolic.kernel import axioms, rules
from force_diffusion.symbolic.kernel.decisions import Ruling, decide, not_a_statement, undecided
from force_diffusion.symbolic.kernel.domain import Domain, Limit
from force_diffusion.symbolic.kernel.limits import large
from force_diffusion.symbolic.kernel.rules import Rule
from force_diffusion.symbolic.kernel.statistics import moment
from force_diffusion.symbolic.kernel.theorem import Group, Theorem
from force_diffusion.symbolic.signs import sign
from force_diffusion.symbolic.trees import equation, in_place

from .deciding import alternatives_of, cases_of, strange_symbol
from .record import Derivation, load

OURS = {*sy.INDICES, *sy.PARAMETERS, *sy.VECTORS}


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
    formula = in_place(candidate, step.definitions[place])
    if domain.limit and formula.has(sympy.Piecewise):
        try:
            formula = _in_limit(formula, domain, domain.limit)
        except NotAStatementError as reason:
            return not_a_statement(str(reason))
        except NotExactError as reason:
            return undecided(str(reason))
    attempts = [step.rules[place], *_further(statement, formula, domain)]
    ruling = decide(formula, domain, attempts)
    if not ruling.verdict.is_proved and (squares := _squares(formula, domain)) is not None:
        return decide(squares, domain, attempts)
    return ruling


def _in_limit(formula: sympy.Eq, domain: Domain, limit: Limit) -> sympy.Eq:
    """A formula with the case of a ``Piecewise`` that holds wherever all that grows is large.

    Raises:
        NotExactError: there is none, or its relations are not read.
    """
    cases = cases_of(formula)
    late = large(domain, limit) & domain.points
    for value, relations in alternatives_of(cases):
        here = late & sets.where(*map(domain.straight.relation, relations))
        if late.is_subset(here):
            return in_place(formula, {cases: value})
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


def _squares(formula: sympy.Eq, domain: Domain) -> sympy.Eq | None:
    """Both sides squared, where both are roots that are not negative; None for other equations."""
    sides = []
    for side in formula.args:
        factors = list(_factors(side))
        has_root = any((2 * exponent).is_odd for _, exponent in factors)
        if not has_root or not all(_is_root(*factor, domain) for factor in factors):
            return None
        squares = (sympy.Pow(base, 2 * exponent, evaluate=False) for base, exponent in factors)
        sides.append(sympy.Mul(*squares, evaluate=False))
    return equation(*sides)


def _factors(side: sympy.Expr) -> Iterator[tuple[sympy.Expr, sympy.Expr]]:
    """Bases and exponents; an absolute value is the root of a square."""
    for factor in sympy.Mul.make_args(side):
        base, exponent = factor.as_base_exp()
        if factor.is_Mul:
            yield from _factors(factor)
        elif isinstance(base, sympy.Abs):
            yield base.args[0] ** 2, exponent / 2
        else:
            yield base, exponent


def _is_root(base: sympy.Expr, exponent: sympy.Expr, domain: Domain) -> bool:
    """Whether a power has a rational square, and is not negative on a domain."""
    if not (2 * exponent).is_Integer:
        return False
    if base.is_nonnegative or isinstance(base, sy.Variance):
        return True
    value = base.xreplace({sy.z: sy.j / sy.M}) if sy.j in domain.indices else base
    try:
        return sign(domain.reader().scalar(value), domain.points) == 1
    except NotExactError:
        return False
