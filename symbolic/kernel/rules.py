"""The rules: each makes a theorem of a statement on a domain, or says why it does not.

A rule is a function of the statement, so that a printed equation, a changed one and anything that a
user says take the same way: ``rule(formula, domain)`` is a theorem, or raises ``NotProvedError``.
What finds a proof (places, factors, unknowns) is not trusted; that it is one is checked.
"""

from collections.abc import Callable, Sequence

import sympy

from .. import symbols as sy
from ..algebra.exact import FIELD, NotProvedError, RationalFunction
from ..elimination import eliminated
from ..forms import NUMBER, Form
from ..mechanics import lattice
from ..printing.text import text
from ..signs import never_zero
from ..trees import equation
from ..weights import Weights
from .domain import LATTICE, Domain
from .refuted import refuse
from .theorem import (
    Group,
    Supposition,
    Theorem,
    both_sides,
    check_domain,
    difference,
    flat,
    instance,
    isolated,
    knowing,
    made,
    read,
    with_indices,
)

Rule = Callable[[sympy.Eq, Domain], Theorem]
"""Proves a statement on a domain.

Raises:
    NotProvedError: it does not, and why; ``FalseStatementError`` where it is false.
"""

_ACROSS = {across for across, _ in LATTICE}


def proved_by(rule: Rule, formula: sympy.Eq, domain: Domain) -> Theorem:
    """What a rule proves, if it is just this statement on just this domain."""
    theorem = rule(formula, domain)
    if type(theorem) is not Theorem:
        raise NotProvedError("the rule made no theorem")
    if theorem.formula != formula or theorem.domain != domain:
        raise NotProvedError("the rule proved another statement")
    return theorem


def same(theorem: Theorem) -> Rule:
    """It is a theorem already."""

    def rule(formula: sympy.Eq, domain: Domain) -> Theorem:
        if (formula, domain) != (theorem.formula, theorem.domain):
            raise NotProvedError("the theorem is another statement")
        return theorem

    return rule


def rewrite(*groups: Group) -> Rule:
    """Both sides have one normal form, once theorems are put in, one group after the other."""

    def rule(formula: sympy.Eq, domain: Domain) -> Theorem:
        apart = difference(read(formula, domain, groups), domain)
        if any(form.parts for form in apart):
            raise refuse(apart, domain, groups, formula)
        return made(formula, domain, "comparing both sides", flat(groups))

    return rule


def follows(theorem: Theorem, *groups: Group) -> Rule:
    """It says what a theorem says, times a factor that vanishes nowhere."""

    def rule(formula: sympy.Eq, domain: Domain) -> Theorem:
        here = instance(theorem, {}, domain)
        new = difference(read(formula, domain, groups), domain)
        old = difference(read(here.formula, domain, groups), domain)
        if len(new) != len(old):
            raise NotProvedError("one is a number, the other a vector")
        factor = _factor(new, old)
        rest = (a - b.scaled(factor) for a, b in zip(new, old, strict=True))
        if not all(form.is_zero() for form in rest):
            raise NotProvedError("it is not a multiple of what it should follow from")
        if not never_zero(factor, domain.points, domain.dimension):
            raise NotProvedError("it is a multiple of it by a factor that may be zero")
        return made(formula, domain, "scaling a theorem", (theorem, *flat(groups)))

    return rule


def _factor(new: Sequence[Form], old: Sequence[Form]) -> RationalFunction:
    """What one form may be of the other, by the weight of any place: found, and then checked."""
    for form, other in zip(new, old, strict=True):
        for key, weights in other.parts.items():
            for points, value in weights.pieces:
                for there, own in form.parts.get(key, Weights()).pieces:
                    if not points.is_disjoint(there):
                        return own / value
    return FIELD.one


def along(theorem: Theorem, vector: sympy.Expr) -> Theorem:
    """The component of an equation between vectors along a base vector, or along e_x."""
    if vector not in (*sy.VECTORS, sy.e_x):
        raise NotProvedError(f"{text(vector)} is not a base vector")
    formula = equation(*(sy.Dot(vector, side) for side in theorem.formula.args))
    return made(formula, theorem.domain, "taking a component", (theorem,))


def order(theorem: Theorem, power: int) -> Rule:
    """The coefficient of ε to a power, of an equation that holds for every strength ε."""

    def coefficient(value: RationalFunction) -> RationalFunction:
        terms = value.coefficients(sy.epsilon)
        return terms[power] if power < len(terms) else FIELD.zero

    def rule(formula: sympy.Eq, domain: Domain) -> Theorem:
        if theorem.domain != domain or power < 0:
            raise NotProvedError("the domains differ, or there is no such power")
        new, old = (difference(read(line, domain), domain) for line in (formula, theorem.formula))
        wanted = [form.mapped(lambda weights: weights.mapped(coefficient)) for form in old]
        if len(new) != len(wanted) or not all(
            (a - b).is_zero() for a, b in zip(new, wanted, strict=True)
        ):
            raise NotProvedError(f"it is not the order {power} in ε")
        return made(formula, domain, f"comparing order {power} in ε", (theorem,))

    return rule


def solve(rows: Sequence[Theorem], unknowns: Sequence[sympy.Expr], *groups: Group) -> Rule:
    """A quantity that as many equations fix as there are unknowns, by Cramer's rule.

    The equations, times factors that are found, add up to the quantity less what it is said to be,
    times the determinant. That vanishes nowhere at order 0. A vector counts for two, unknown or
    equation.
    """

    def rule(formula: sympy.Eq, domain: Domain) -> Theorem:
        check_domain(formula, domain)
        about, value = isolated(formula, domain)
        if about not in unknowns:
            raise NotProvedError(f"{text(about)} is not what is solved for")
        reader = knowing(domain.reader(), domain, groups)

        def forms(line: sympy.Eq) -> tuple[Form, ...]:
            return difference(both_sides(line, domain, reader), domain)

        moved_rows = [instance(row, {}, domain).formula for row in rows]
        determinant, factors = eliminated(moved_rows, about, unknowns, forms)
        for key, weights in determinant.parts.items():
            located = any(isinstance(factor, str) for factor, _ in key)
            if key != NUMBER and not located and not weights.on(domain.points).is_zero():
                raise NotProvedError("the determinant holds a force, which may have any value")
        pivot = determinant.parts.get(NUMBER, Weights()).on(domain.points).formulas()
        if len(pivot) != 1 or not domain.points.is_subset(pivot[0][0]) or not never_zero(
            pivot[0][1], domain.points, domain.dimension
        ):  # fmt: skip
            raise NotProvedError("the determinant may be zero")
        system = [part for row in moved_rows for part in forms(row)]
        claimed = forms(equation(about, value))
        for component, own in zip(claimed, factors, strict=True):
            apart = determinant.times(component)
            for factor, row in zip(own, system, strict=True):
                apart = apart - factor.times(row)
            if not apart.on(domain.points).is_zero():
                raise NotProvedError(f"{text(about)} is not the solution")
        return made(formula, domain, "solving linear equations", (*rows, *flat(groups)))

    return rule


def mirror(theorem: Theorem) -> Theorem:
    """The mirror image of a theorem at a vertical line: i → −i at every bead, n⁺ ↔ n⁻, b⁺ ↔ b⁻.

    Raises:
        NotProvedError: an index across the packing, or a matrix, stands beside its places.
    """
    if any(map(_across_by_itself, theorem.formula.args)):
        raise NotProvedError("it has a horizontal index outside the places of its quantities")
    if theorem.fixed & _ACROSS:
        raise NotProvedError("what is supposed of one column has no mirror image")
    formula = lattice.mirror(theorem.formula)
    return made(formula, theorem.domain.mirrored(), "taking the mirror image", (theorem,))


def _across_by_itself(node: sympy.Basic) -> bool:
    """Whether an index across the packing, or a matrix, stands where the mirror leaves it."""
    if isinstance(node, sy.SiteFunction):
        return False
    if isinstance(node, sy.MatrixTimes) or node in _ACROSS:
        return True
    return any(map(_across_by_itself, node.args))


# induction

Member = tuple[sympy.Eq, Domain]
"""A statement and its domain."""


def suppose(formula: sympy.Eq, domain: Domain, supposition: Supposition) -> Theorem:
    """What is supposed of a statement, of the value before the one considered of an index.

    It holds for every value of the other indices; the supposition ends in an induction alone.

    Raises:
        NotProvedError: the statement is none of that induction.
    """
    if (formula, domain) not in supposition.members:
        raise NotProvedError("it is not what the induction is about")
    check_domain(formula, domain)
    image = {supposition.index: supposition.index - supposition.before}
    shifted = with_indices(equation(*isolated(formula, domain)), image)
    return made(shifted, domain.put_in(image), "supposition", supposed=(supposition,))


def inducted(
    over: sympy.Symbol,
    start: sympy.Expr | int,
    base: Rule,
    step: Callable[[tuple[Theorem, ...]], Rule],
    members: Sequence[Member],
    *,
    down: bool = False,
    mirrored: bool = False,
) -> tuple[Theorem, ...]:
    """Statements proved together, from the first value of an index on, upwards or downwards.

    Args:
        over: the index.
        start: its first value.
        base: proves each statement there.
        step: proves each one from all of them before, which are supposed.
        members: the statements, each with its domain.
        down: whether the index falls from its first value on.
        mirrored: whether the mirror images of what is supposed are put in, too.
    """
    first = sympy.sympify(start)
    supposition = Supposition(over, first, -1 if down else 1, tuple(members))
    supposed = []
    for claim, domain in members:
        ends = (over, first) if down else (first, over)
        known = {*domain.indices} - first.free_symbols
        if over not in known or not domain.implies(sympy.Le(*ends, evaluate=False)):
            raise NotProvedError(f"the domain goes beyond {text(over)} = {text(first)}")
        supposed.append(suppose(claim, domain, supposition))
    if mirrored:
        supposed += [mirror(theorem) for theorem in supposed]
    premises = []
    for claim, domain in members:
        at_first = domain.also(sympy.Eq(over, first, evaluate=False))
        if not at_first.points.is_empty():
            premises.append(proved_by(base, claim, at_first))
            if premises[-1].supposed:
                raise NotProvedError("what holds at the start must rest on nothing supposed")
        ends = (over, first - 1) if down else (first + 1, over)
        later = domain.also(sympy.Le(*ends, evaluate=False))
        if not later.points.is_empty():
            premises.append(proved_by(step(tuple(supposed)), claim, later))
    if any(premise.supposed - {supposition} for premise in premises):
        raise NotProvedError("inductions can't be nested")
    return tuple(
        made(claim, domain, "induction", premises, ended=(supposition,))
        for claim, domain in members
    )


# derivatives


def differentiate(formula: sympy.Eq, domain: Domain) -> Theorem:
    """SymPy differentiates by z, or by symbols that are none of this package's.

    Of z no other symbol is a function; beside others none of this package may stand.
    """
    variables = {by for atom in formula.atoms(sympy.Derivative) for by in atom.variables}
    ours = {*sy.PARAMETERS, *sy.INDICES, *sy.VECTORS}
    strange = formula.free_symbols & ours if variables - {sy.z} else formula.free_symbols - ours
    if not variables or strange or formula.free_symbols & {*sy.INDICES}:
        raise NotProvedError("a part of it may depend on the variable of the derivative")
    for atom in formula.atoms(sympy.Derivative):
        read(equation(atom.expr, atom.expr), domain)  # what SymPy cancels has a value
    done = equation(*(_done(side) for side in formula.args))
    apart = difference(read(done, domain), domain)
    if any(form.parts for form in apart):
        raise refuse(apart, domain)
    return made(formula, domain, "differentiating")


def _done(node: sympy.Basic) -> sympy.Basic:
    """The same, differentiated, and nothing else of it carried out."""
    if isinstance(node, sympy.Derivative):
        return node.doit()
    if not node.has(sympy.Derivative):
        return node
    return node.func(*map(_done, node.args), evaluate=False)
