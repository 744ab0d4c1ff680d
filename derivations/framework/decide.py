"""Decides what is said of an equation: one function for a step, a candidate and a closed form."""

from collections.abc import Iterator, Mapping, Sequence

import sympy
from force_diffusion.symbolic import symbols as sy
from force_diffusion.symbolic.algebra.exact import NotAStatementError
from force_diffusion.symbolic.as_printed import equation, in_place, nodes
from force_diffusion.symbolic.kernel import axioms, rules
from force_diffusion.symbolic.kernel.decisions import (
    Ruling,
    not_a_statement,
    proved,
    refuted,
    undecided,
)
from force_diffusion.symbolic.kernel.domain import Domain
from force_diffusion.symbolic.kernel.limits import asymptotic, negligible
from force_diffusion.symbolic.kernel.rules import Rule
from force_diffusion.symbolic.kernel.statistics import moment
from force_diffusion.symbolic.kernel.theorem import (
    FalseStatementError,
    Group,
    NotProvedError,
    Theorem,
)
from force_diffusion.symbolic.notation import by_name
from force_diffusion.symbolic.printing.text import text

from .loading import load
from .record import Derivation

OURS = {symbol.name: symbol for symbol in (*sy.INDICES, *sy.PARAMETERS, *sy.VECTORS)}


def decide(formula: sympy.Eq, domain: Domain, attempts: Sequence[Rule]) -> Ruling:
    """Rule on a statement: the first rule that proves it, or shows that it is false, decides.

    Args:
        formula: the statement.
        domain: where it is to hold.
        attempts: rules; none of them is trusted to fit the statement.
    """
    reasons = []
    for rule in attempts:
        try:
            theorem = rules.proved_by(rule, formula, domain)
        except NotAStatementError as reason:
            return not_a_statement(str(reason))
        except FalseStatementError as reason:
            return refuted(str(reason))
        except (NotProvedError, RecursionError) as reason:
            reasons.append(str(reason) or "it is nested too deeply")
        else:
            if theorem.supposed:
                return undecided("it rests on what is only supposed")
            return proved(f"by the rule: {theorem.rule}", sorted(theorem.assuming))
    return undecided(reasons[-1] if reasons else "no rule decides it")


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
    named = {str(symbol): symbol for symbol, _ in statement.symbols}
    if reason := strange_symbol(candidate, {**OURS, **named}):
        return not_a_statement(reason)
    step, place = statement.step_of(part)
    domain = step.domains[place]
    if at:
        if domain.limit:
            return not_a_statement(f"it is one in a limit ({domain.limit.words}), of no one packing")
        domain = domain.also(*(sympy.Eq(s, n, evaluate=False) for s, n in at.items()))
    meant = in_place(candidate, step.definitions[place])
    attempts = [step.rules[place], *_further(statement, domain)]
    ruling = decide(meant, domain, attempts)
    if not ruling.verdict.is_proved and (squares := _squares(meant)):
        return decide(squares, domain, attempts)
    return ruling


def strange_symbol(formula: sympy.Basic, known: Mapping[str, sympy.Basic]) -> str:
    """Why a symbol may be taken for another one of the same name; "" where none may be.

    Args:
        formula: whatever is said.
        known: symbols by name.
    """
    for symbol in by_name(formula.free_symbols):
        ours = known.get(symbol.name, symbol)
        if ours != symbol:
            return f"{symbol.name} is another symbol than the {text(ours)} of the equation"
    return ""


def _further(statement: Derivation, domain: Domain) -> Iterator[Rule]:
    """Rules that decide more than the step does."""
    theorems = statement.theorems
    for theorem in theorems:
        yield rules.follows(theorem)
        yield from (_component(theorem, vector) for vector in (sy.e_x, *sy.VECTORS))
    groups = (*statement.ground(),) or (theorems, *_geometry())
    match domain.limit.relation if domain.limit else "=":
        case "∼":
            yield asymptotic(*groups)
        case "≈":
            yield negligible(*groups)
        case "=":
            yield moment(*groups)
            yield rules.rewrite(*groups)


def _component(theorem: Theorem, vector: sympy.Expr) -> Rule:
    return lambda formula, domain: rules.follows(rules.along(theorem, vector))(formula, domain)


def _geometry() -> tuple[Group, ...]:
    """Contact directions, and the positions in which they are, in the radii."""
    positions, plus, minus = (load(number).theorem for number in (3, 4, 5))
    return (plus, minus), (positions, axioms.base())


def _squares(formula: sympy.Eq) -> sympy.Eq | None:
    """Both sides squared, where both are roots that are not negative; None for other equations."""
    sides = []
    for side in formula.args:
        square = sympy.S.One
        for factor in sympy.Mul.make_args(side):
            base, exponent = factor.as_base_exp()
            if not (2 * exponent).is_Integer or (exponent.is_Integer and not base.is_positive):
                return None
            square = sympy.Mul(square, sympy.Pow(base, 2 * exponent, evaluate=False))
        sides.append(square)
    has_root = any(one.is_Pow and one.exp.q == 2 for one in nodes(formula) if one.is_Pow)
    return equation(*sides) if has_root else None
