"""The rules: each makes a theorem of a statement on a domain, or says why it does not.

A rule is a function of the statement, so that a printed equation, a changed one and anything that a
user says take the same way: ``rule(formula, where)`` is a theorem, or raises ``NotProvedError``.
What finds a proof (places, factors, unknowns) is not trusted; that it is one is checked.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from itertools import permutations

import sympy

from .. import symbols as sy
from ..algebra import affine
from ..algebra.bases import LINE_SUM, Basis
from ..algebra.exact import FIELD, UNKNOWNS, RationalFunction
from ..algebra.linear_forms import LinearForm
from ..as_printed import equation
from ..mechanics import lattice
from ..printing.text import text
from .theorem import (
    Normal,
    NotProvedError,
    Supposition,
    Theorem,
    applies,
    basis,
    check,
    divisors,
    flat,
    holds,
    isolated,
    made,
    put_in,
)
from .where import LATTICE, Where

Rule = Callable[[sympy.Eq, Where], Theorem]
"""Proves a statement on a domain.

Raises:
    NotProvedError: it does not, and why.
"""

_NOTHING = sympy.S.Zero
_PARAMETERS = {*sy.INDICES, *sy.PARAMETERS, *sy.VECTORS}
_ACROSS = {across for across, _ in LATTICE}


def at(formula: sympy.Eq, image: Mapping[sympy.Symbol, sympy.Expr]) -> sympy.Eq:
    """An equation with other indices."""
    return equation(*(side.xreplace(dict(image)) for side in formula.args))


def proved_by(rule: Rule, formula: sympy.Eq, where: Where) -> Theorem:
    """What a rule proves, if it is just this statement on just this domain."""
    theorem = rule(formula, where)
    if theorem.formula != formula or theorem.where != where:
        raise NotProvedError("the rule proved another statement")
    return theorem


def rewrite(*facts: Theorem | tuple[Theorem, ...]) -> Rule:
    """Both sides have one normal form, once facts are put in, one after the other."""

    def rule(formula: sympy.Eq, where: Where) -> Theorem:
        check(formula, where)
        known = equation(*(put_in(side, facts, where, facts) for side in formula.args))
        if not holds(known, where):
            raise NotProvedError("the normal forms of both sides differ")
        return made(formula, where, "rewrite", flat(facts))

    return rule


def follows(theorem: Theorem, *facts: Theorem | tuple[Theorem, ...]) -> Rule:
    """It says what a theorem says, times a factor that vanishes nowhere."""

    def rule(formula: sympy.Eq, where: Where) -> Theorem:
        check(formula, where)
        if not applies(theorem, _itself(theorem), where, facts):
            raise NotProvedError("what it is to follow from does not hold on all of its domain")
        sides = [
            tuple(put_in(side, facts, where, facts) for side in one.args)
            for one in (formula, theorem.formula)
        ]
        normal = Normal(where, *sides[0], *sides[1])
        new, old = (normal.difference(equation(*pair)) for pair in sides)
        spared, given = (divisors(one, where) for one in (formula, theorem.formula))
        if given - spared:
            raise NotProvedError("it does not divide by the forces that what it follows from does")
        for factor in _factors(new, old):
            same = _are_equal(new, tuple(one.scaled(factor) for one in old))
            if same and normal.never_zero(factor, spared - given):
                return made(formula, where, "follows", (theorem, *flat(facts)))
        raise NotProvedError("it is no multiple of what it is to follow from")

    return rule


def _factors(new: Sequence[LinearForm], old: Sequence[LinearForm]) -> Iterator[RationalFunction]:
    """What one form may be of the other, by the weight of any place: found, and then checked."""
    if len(new) != len(old):
        raise NotProvedError("one is a number, the other a vector")
    for one, other in zip(new, old, strict=True):
        yield from (one.sites[at] / w for at, w in other.sites.items() if at in one.sites)
        yield from (one.rays[at] / w for at, w in other.rays.items() if at in one.rays)


def _are_equal(left: Iterable[LinearForm], right: Iterable[LinearForm]) -> bool:
    return all((a - b).is_zero() for a, b in zip(left, right, strict=True))


def along(theorem: Theorem, vector: sympy.Expr) -> Theorem:
    """The component of an equation between vectors along a base vector, or along e_x."""
    formula = equation(*(sy.Dot(vector, side) for side in theorem.formula.args))
    if vector not in (*sy.VECTORS, sy.e_x):
        raise NotProvedError(f"{text(vector)} is no base vector")
    return made(formula, theorem.where, "component", (theorem,))


def order(theorem: Theorem, power: int) -> Rule:
    """The coefficient of ε to a power, of an equation that holds for every strength ε."""

    def rule(formula: sympy.Eq, where: Where) -> Theorem:
        check(formula, where)
        if theorem.where != where:
            raise NotProvedError("the domains differ")
        normal = Normal(where, *formula.args, *theorem.formula.args)
        new, old = normal.difference(formula), normal.difference(theorem.formula)
        wanted = tuple(one.mapped(lambda weight: _coefficient(weight, power)) for one in old)
        same = divisors(formula, where) == divisors(theorem.formula, where)
        if not (same and _are_equal(new, wanted)):
            raise NotProvedError(f"it is not the order {power} in ε")
        return made(formula, where, f"order {power} in ε", (theorem,))

    return rule


def _coefficient(weight: RationalFunction, power: int) -> RationalFunction:
    found = weight.coefficients(sy.epsilon)
    return found[power] if power < len(found) else FIELD.zero


def solve(
    rows: Sequence[Theorem],
    unknowns: Sequence[sympy.Expr],
    *facts: Theorem | tuple[Theorem, ...],
) -> Rule:
    """A quantity that as many equations fix as there are unknowns, by Cramer's rule.

    The determinant at order 0 vanishes nowhere. A vector counts for two, unknown or equation.
    """

    def rule(formula: sympy.Eq, where: Where) -> Theorem:
        check(formula, where)
        about, value = isolated(formula, where)
        if about not in unknowns:
            raise NotProvedError(f"{text(about)} is not what is solved for")
        value = put_in(value, facts, where, facts)
        known = []
        for row in rows:
            if not applies(row, _itself(row), where, facts):
                raise NotProvedError("an equation to be solved does not hold on all of the domain")
            if divisors(row.formula, where):
                raise NotProvedError("an equation to be solved divides by a force")
            known.append([put_in(side, facts, where, facts) for side in row.formula.args])
        image, names = _named(unknowns, basis(value, *(side for one in known for side in one)))
        sides = [equation(*(side.xreplace(image) for side in one)) for one in known]
        normal = Normal(where, value, *(side for one in sides for side in one.args))
        system = [part for one in sides for part in normal.difference(one)]
        held = [name for one in unknowns for name in names[one]]
        if len(system) != len(held):
            raise NotProvedError(f"{len(system)} equations for {len(held)} unknown numbers")
        matrix = [[_slope(row, name, held) for name in held] for row in system]
        rest = [row.mapped(lambda w: _without(w, held)) for row in system]
        determinant = _determinant(matrix)
        if not normal.never_zero(determinant.at_zero):
            raise NotProvedError("the determinant is not shown to vanish nowhere")
        claimed = normal(value)
        if len(claimed) != len(names[about]):
            raise NotProvedError("a number is set equal to a vector")
        for name, one in zip(names[about], claimed, strict=True):
            replaced = [
                [side if other == name else entry for other, entry in zip(held, row, strict=True)]
                for row, side in zip(matrix, rest, strict=True)
            ]
            if not (determinant.times(one) + _determinant(replaced)).is_zero():
                raise NotProvedError(f"{text(about)} is not the solution")
        return made(formula, where, "solve", (*rows, *flat(facts)))

    return rule


def below(balance: Theorem, *facts: Theorem | tuple[Theorem, ...]) -> Rule:
    """A contact's force, by ``solve`` from the balance of the bead above it."""

    def rule(formula: sympy.Eq, where: Where) -> Theorem:
        about, value = isolated(formula, where)
        branch = BRANCHES.get(type(about))
        if branch is None:
            raise NotProvedError(f"{text(about)} is no contact force")
        across, layer = about.args[0] + branch, about.args[1] + 1
        bead = dict(zip((sy.site_r, sy.site_s), map(sympy.expand, (across, layer)), strict=True))
        row = instance(balance, bead, where)
        unknowns = [force(*_from(bead, one)) for force, one in BRANCHES.items()]
        own = next(one for one in unknowns if type(one) is type(about))
        solve([row], unknowns, *facts)(equation(own, value), where)
        return made(formula, where, "balance of the bead above", (balance, *flat(facts)))

    return rule


BRANCHES = {sy.ForcePlus: 1, sy.ForceMinus: -1}
"""Forces of contacts, and the side of the upper bead."""


def _from(bead: Mapping[sympy.Symbol, sympy.Expr], branch: int) -> tuple[sympy.Expr, sympy.Expr]:
    """The support of a bead from which a branch leads to it."""
    across, layer = bead.values()
    return sympy.expand(across - branch), sympy.expand(layer - 1)


def _named(
    unknowns: Sequence[sympy.Expr], components: Basis
) -> tuple[dict[sympy.Expr, sympy.Expr], dict[sympy.Expr, tuple[sympy.Symbol, ...]]]:
    """Names for unknown numbers; two for a vector, its components in a basis."""
    image: dict[sympy.Expr, sympy.Expr] = {}
    names: dict[sympy.Expr, tuple[sympy.Symbol, ...]] = {}
    spare = list(reversed(UNKNOWNS[1]))
    first, second = (sy.b_plus, sy.b_minus) if components is LINE_SUM else (sy.e_x, sy.e_y)
    for one in unknowns:
        if getattr(one, "is_vector", False):
            names[one] = (spare.pop(), spare.pop())
            image[one] = names[one][0] * first + names[one][1] * second
        else:
            names[one] = (spare.pop(),)
            image[one] = names[one][0]
    return image, names


def _slope(row: LinearForm, name: sympy.Symbol, names: Sequence[sympy.Symbol]) -> LinearForm:
    """The factor of an unknown number, of which a row is a linear function."""

    def one(weight: RationalFunction) -> RationalFunction:
        found = weight.coefficients(name)
        if len(found) > 2 or any(found[-1].holds(other) for other in names if len(found) == 2):
            raise NotProvedError("an equation to be solved is not linear")
        return found[1] if len(found) == 2 else FIELD.zero

    return row.mapped(one)


def _without(weight: RationalFunction, names: Sequence[sympy.Symbol]) -> RationalFunction:
    return weight.substitute(dict.fromkeys(names, FIELD.zero))


def _determinant(matrix: Sequence[Sequence[LinearForm]]) -> LinearForm:
    total = LinearForm()
    for columns in permutations(range(len(matrix))):
        odd = sum(a > b for n, a in enumerate(columns) for b in columns[n + 1 :]) % 2
        product = LinearForm.constant(FIELD.constant(-1 if odd else 1))
        for row, column in zip(matrix, columns, strict=True):
            product = product.times(row[column])
        total = total + product
    return total


def cases(rule: Rule, *parts: Iterable[sympy.Basic]) -> Rule:
    """The same rule on parts of the domain, which leave no integer point of it out."""

    def split(formula: sympy.Eq, where: Where) -> Theorem:
        check(formula, where)
        wheres = [where.also(*relations) for relations in parts]
        if not where.covered_by(wheres):
            raise NotProvedError("the cases leave something of the domain out")
        theorems = [_on_part(rule, formula, one) for one in wheres if not one.is_empty]
        return made(formula, where, "cases", theorems)

    return split


def _on_part(rule: Rule, formula: sympy.Eq, where: Where) -> Theorem:
    """On a part where equations fix indices these are put in, so that a sum may be empty there."""
    return proved_by(rule, at(formula, where.solved), where)


def instance(theorem: Theorem, image: Mapping[sympy.Symbol, sympy.Expr], where: Where) -> Theorem:
    """A theorem at another place.

    Raises:
        NotProvedError: it does not hold on all of the domain there.
    """
    whole = {**_itself(theorem), **image}
    if set(whole) != set(theorem.indices) or not applies(theorem, whole, where, ()):
        raise NotProvedError("the theorem does not hold there")
    formula = at(theorem.formula, whole)
    check(formula, where)
    held = set().union(*(one.free_symbols for one in image.values())) & set(sy.INDICES)
    if not held <= set(where.indices):
        raise NotProvedError("an index that is put in is none of the domain")
    if divisors(formula, where) != divisors(theorem.formula, where, whole):
        raise NotProvedError("a force that it divides by is lost")
    return made(formula, where, "instance", (theorem,))


def _itself(theorem: Theorem) -> dict[sympy.Symbol, sympy.Expr]:
    return {symbol: symbol for symbol in theorem.indices}


def in_terms_of(
    image: Mapping[sympy.Symbol, sympy.Expr],
    back: Mapping[sympy.Symbol, sympy.Expr],
    other: Where,
    rule: Rule,
) -> Rule:
    """A statement in other indices: ``image`` gives its own by them, ``back`` them by its own."""

    def moved(formula: sympy.Eq, where: Where) -> Theorem:
        check(formula, where)
        loading = other.loading and other.loading.put_in(back)
        if loading != where.loading or other.dimension != where.dimension:
            raise NotProvedError("the packings differ")
        if not set(image) <= set(where.indices):
            raise NotProvedError("what is put in is no index of the domain")
        own = {symbol: image.get(symbol, symbol) for symbol in where.indices}
        whole = [
            *(at(one, back) if isinstance(one, sympy.Eq) else
              one.func(*(side.xreplace(dict(back)) for side in one.args), evaluate=False)
              for one in other.relations),
            *(equation(value.xreplace(dict(back)), symbol) for symbol, value in own.items()),
        ]  # fmt: skip
        even = (affine.from_sympy(sympy.expand(one.xreplace(dict(back)))) for one in other.even)
        if not (all(map(where.implies, whole)) and all(map(where.is_even, even))):
            raise NotProvedError("the other indices do not reach all of the domain")
        theorem = proved_by(rule, at(formula, image), other)
        if theorem.fixed & {*image, *back}:
            raise NotProvedError("it is supposed for one value of an index that is put elsewhere")
        return made(formula, where, "in other indices", (theorem,))

    return moved


def mirror(theorem: Theorem) -> Theorem:
    """The mirror image at a vertical line: that of a packing is a packing.

    Raises:
        NotProvedError: it holds an index across the packing beside its places.
    """
    if _ACROSS & theorem.fixed:
        raise NotProvedError("it is supposed for one place across the packing")
    formula = lattice.mirror(theorem.formula)
    if any(map(_across_by_itself, formula.args)):
        raise NotProvedError("it holds an index across the packing beside its places")
    return made(formula, theorem.where.mirrored(), "mirror", (theorem,))


def _across_by_itself(node: sympy.Basic) -> bool:
    """Whether an index across the packing, or a matrix, stands where the mirror leaves it."""
    if isinstance(node, sy.SiteFunction):
        return False
    if isinstance(node, sy.MatrixTimes) or node in _ACROSS:
        return True
    return any(map(_across_by_itself, node.args))


def suppose(formula: sympy.Eq, where: Where, supposition: Supposition, before: int) -> Theorem:
    """What is supposed of the layer, or the number of steps, ``before`` the one considered.

    It holds for every value of the other indices; the supposition ends in an induction alone.
    """
    check(formula, where)
    image = {supposition.index: supposition.index - before}
    about, value = isolated(formula, where)
    moved = where.put_in(image, where.indices)
    return made(at(equation(about, value), image), moved, "supposition", supposed=(supposition,))


def induct(
    over: sympy.Symbol,
    start: sympy.Expr,
    base: Rule,
    step: Callable[[tuple[Theorem, ...]], Rule],
    *,
    down: bool = False,
    mirrored: bool = False,
    family: Sequence[tuple[sympy.Eq, Where]] = (),
) -> Rule:
    """From the first value of an index on, upwards or downwards, for a statement and its family.

    Args:
        over: the index; ``start`` its first value.
        base: proves each statement there, ``step`` each one from all of them before.
        down: whether the index falls from its first value on.
        mirrored: whether the mirror images of what is supposed are put in, too.
        family: further statements, proved together with it, each with its domain.
    """

    def rule(formula: sympy.Eq, where: Where) -> Theorem:
        members = [(formula, where), *family]
        return inducted(over, start, base, step, members, down=down, mirrored=mirrored)[0]

    return rule


def inducted(
    over: sympy.Symbol,
    start: sympy.Expr,
    base: Rule,
    step: Callable[[tuple[Theorem, ...]], Rule],
    members: Sequence[tuple[sympy.Eq, Where]],
    *,
    down: bool = False,
    mirrored: bool = False,
) -> tuple[Theorem, ...]:
    """All of a family of statements, by ``induct``."""
    one = -1 if down else 1
    supposition = Supposition(over, start)
    supposed = []
    for claim, domain in members:
        first, later = (over, start) if not down else (start, over)
        if not domain.implies(sympy.Ge(first, later)):
            raise NotProvedError(f"the domain goes beyond {text(over)} = {text(start)}")
        supposed.append(suppose(claim, domain, supposition, one))
    if mirrored:
        supposed += [mirror(theorem) for theorem in supposed]
    premises = []
    for claim, domain in members:
        left = [symbol for symbol in domain.indices if symbol != over]
        first_where = domain.put_in({over: start}, left)
        if not first_where.is_empty:
            premises.append(proved_by(base, at(claim, {over: start}), first_where))
        rest = sympy.Le(over, start - 1) if down else sympy.Ge(over, start + 1)
        if not domain.also(rest).is_empty:
            premises.append(proved_by(step(tuple(supposed)), claim, domain.also(rest)))
    if any(one.supposed - {supposition} for one in premises):
        raise NotProvedError("an induction within another one is not read")
    return tuple(
        made(claim, domain, "induction", premises, ended=(supposition,))
        for claim, domain in members
    )


def reach(origin: Theorem, up: Sequence[Theorem]) -> Rule:
    """A quantity of every bead, known at (0, 0), and what it gains on both steps up.

    Every bead in or above the base is reached by steps to (i ± 1, j + 1) and back.
    """

    def rule(formula: sympy.Eq, where: Where) -> Theorem:
        check(formula, where)
        about, value = isolated(formula, where)
        if not isinstance(about, sy.SiteFunction):
            raise NotProvedError(f"{text(about)} belongs to no bead")

        def known(across: sympy.Expr, layer: sympy.Expr) -> sympy.Expr:
            return value.xreplace({sy.i: across, sy.j: layer})

        gained = {type(about)(sy.i + one, sy.j + 1) - about for one in (1, -1)}
        steps = {one.formula.lhs for one in up}
        whole = [(origin, Where()), *((one, Where.of(sy.j >= 0)) for one in up)]
        if (
            origin.formula.lhs != about.func(0, 0)
            or steps != gained
            or not all(applies(one, _itself(one), beads, ()) for one, beads in whole)
        ):
            raise NotProvedError("the steps do not reach every bead")
        for one in (origin, *up):
            sides = (side.replace(type(about), known) for side in one.formula.args)
            if not holds(equation(*sides), one.where):
                raise NotProvedError(f"it does not obey {text(one.formula.lhs)}")
        return made(formula, where, "reach", (origin, *up))

    return rule


def walk(
    start: Mapping[sympy.Symbol, sympy.Expr],
    following: Mapping[sympy.Symbol, sympy.Expr],
    count: sympy.Symbol,
) -> Rule:
    """The site that a number of steps leads to, from ``start``; ``following`` is one step.

    The theorem holds for that site alone, which its domain says.
    """

    def rule(formula: sympy.Eq, where: Where) -> Theorem:
        check(formula, where)
        index, value = formula.args
        if index not in start or index not in following:
            raise NotProvedError(f"{text(index)} is no index of the site")
        if value.free_symbols & set(start):
            raise NotProvedError("the site is not given by the number of steps alone")
        first = equation(value.xreplace({count: _NOTHING}), start[index])
        after = following[index].xreplace({index: value})
        if not (
            holds(first, where)
            and holds(equation(value.xreplace({count: count + 1}), after), where)
        ):
            raise NotProvedError("the steps do not lead there")
        return made(formula, where.also(formula), "walk")

    return rule


def inverse(formula: sympy.Eq, where: Where) -> Theorem:
    """The right-hand side is the inverse matrix: their product is 1, entry by entry."""
    matrix, exponent = formula.lhs.as_base_exp()
    if exponent != -1 or not isinstance(matrix, sympy.MatrixBase) or matrix.rows != matrix.cols:
        raise NotProvedError("the left-hand side is no inverse matrix")
    for one in (*matrix, *formula.rhs):
        check(equation(one, _NOTHING), where)
    product = matrix * formula.rhs
    for entry, one in zip(product, sympy.eye(matrix.rows), strict=True):
        rewrite()(equation(entry, one), where)
    return made(formula, where, "inverse matrix")


_LINKED = (
    {sy.phi, sy.n_x, sy.n_y, *sy.VECTORS},
    {sy.r, sy.spacing, sy.n_x},
    {sy.L_plus, sy.L_minus, sy.t},
)
"""Parameters of which one is a function of others."""


def _refuse_functions_of(by: sympy.Symbol, formula: sympy.Eq) -> None:
    """Refuse a derivative by what another symbol of the formula may be a function of.

    Parameters are told apart from one another, and further symbols; not one kind from the other.
    """
    others, known = formula.free_symbols - {by}, {*sy.PARAMETERS, *sy.VECTORS}
    linked = set().union(*(group for group in _LINKED if by in group))
    strange = others - known | others & linked if by in known else others & {*known, *sy.INDICES}
    if by in sy.INDICES or strange or formula.atoms(sy.SiteFunction):
        raise NotProvedError(f"it holds what may depend on {text(by)}, or that is a whole number")


def differentiate(root: sympy.Symbol, square: sympy.Expr) -> Rule:
    """SymPy differentiates; ``root`` is positive, and stands for the root of what is positive.

    What is differentiated has a value everywhere; no other symbol is a function of that by which.
    """

    def rule(formula: sympy.Eq, where: Where) -> Theorem:
        held = square.free_symbols & _PARAMETERS
        if formula.has(root) or (held and where.sign(square) != 1):
            raise NotProvedError(f"{text(root)} is not the root of what is positive")
        for one in formula.atoms(sympy.Derivative):
            for by in one.variables:
                _refuse_functions_of(by, formula)
            inside = read(one.expr)
            check(equation(inside, inside), where)  # what SymPy cancels has a value

        sides = [read(side) for side in formula.args]
        check(equation(*sides), where)
        apart = sympy.together(sides[0] - sides[1])
        left = sympy.rem(sympy.fraction(apart)[0], root**2 - square, root)
        if not holds(equation(sympy.expand(left), _NOTHING), where):
            raise NotProvedError("the derivatives differ")
        return made(formula, where, "differentiate")

    def read(node: sympy.Basic) -> sympy.Basic:
        """The same, differentiated, and nothing else of it carried out."""
        if isinstance(node, sympy.Derivative):
            node = node.doit()
        if isinstance(node, sympy.Pow) and node.base == square:
            return root ** (2 * node.exp)
        if not isinstance(node, sympy.Add | sympy.Mul | sympy.Pow):
            return node
        return node.func(*map(read, node.args), evaluate=False)

    return rule


def slope(formula: sympy.Eq, where: Where) -> Theorem:
    """SymPy differentiates by the relative height z, of which no other symbol is a function."""
    found = {by for one in formula.atoms(sympy.Derivative) for by in one.variables}
    if found != {sy.z}:
        raise NotProvedError(f"it is not about a derivative by {text(sy.z)}")
    if formula.atoms(sy.SiteFunction) or formula.free_symbols - {*sy.PARAMETERS}:
        raise NotProvedError(f"it holds what may depend on {text(sy.z)}")
    for one in formula.atoms(sympy.Derivative):
        check(equation(one.expr, one.expr), where)  # what SymPy cancels has a value

    def read(node: sympy.Basic) -> sympy.Basic:
        """The same, differentiated, and nothing else of it carried out."""
        if isinstance(node, sympy.Derivative):
            return node.doit()
        if not node.has(sympy.Derivative):
            return node
        return node.func(*map(read, node.args), evaluate=False)

    sides = list(map(read, formula.args))
    check(equation(*sides), where)
    if not holds(equation(*sides), where):
        raise NotProvedError("the derivatives differ")
    return made(formula, where, "slope")
