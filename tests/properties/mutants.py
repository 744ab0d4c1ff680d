"""Printed equations with one mechanical change each: what the checker must be able to refuse.

Operators: flip the sign of a term, drop a term, change a whole-number or rational coefficient or
an exponent (a fractional one also by one and in sign), shift an index or a sum's bound (or the
bound between two cases) by one, and swap n⁺ with n⁻, b⁺ with b⁻, δn⁺ with δn⁻, f⁺ with f⁻. Both
sides are changed.
"""

from collections.abc import Iterator
from typing import NamedTuple

import sympy
from force_diffusion.symbolic import symbols as sy
from force_diffusion.symbolic.mechanics.lattice import MIRRORED_FUNCTIONS, MIRRORED_SYMBOLS
from force_diffusion.symbolic.printing.text import text

Change = tuple[str, sympy.Basic]
"""Its description, and what it makes of an expression."""


_ONE_LAYER = "Δ in one layer, with a weight of order M: of the variance M², and M³ is kept"
EQUIVALENT: dict[int | str, dict[str, str]] = {
    12: {
        "lower bound m = 1 shifted to 0": _ONE_LAYER,
        "lower bound m = 1 shifted to 2": _ONE_LAYER,
        "upper bound m = M shifted to M + 1": "Δ in the layer M + 1, with the weight −1",
        "upper bound m = M shifted to M − 1": "the weight at m = M is M − m = 0",
        "case m ≤ j shifted to j + 1": "at m = j + 1 the weights of the two cases differ by 1",
        "case m ≤ j shifted to j − 1": "at m = j the two cases agree: nothing changes",
    }
}
"""The mechanical changes of an equation that say the same at the order that it keeps, and why."""


class Mutated(NamedTuple):
    """An equation with one mechanical change."""

    change: str
    equation: sympy.Eq


def mutants(equation: sympy.Eq) -> Iterator[Mutated]:
    """Yield every single change of either side.

    Changes that give the same expression again, or one already seen, are left out.
    """
    seen = set(equation.args)
    for change, left in _changes(equation.lhs):
        if left not in seen:
            seen.add(left)
            yield Mutated(f"left: {change}", sympy.Eq(left, equation.rhs, evaluate=False))
    for change, right in _changes(equation.rhs):
        if right not in seen:
            seen.add(right)
            yield Mutated(change, sympy.Eq(equation.lhs, right, evaluate=False))


def _changes(node: sympy.Basic) -> Iterator[Change]:
    yield from _here(node)
    if isinstance(node, sy.SiteFunction):
        yield from _shifted_indices(node)
        return
    if isinstance(node, sympy.Sum):
        yield from _shifted_bounds(node)
        for change, body in _changes(node.function):
            yield change, sympy.Sum(body, *node.limits)
        return
    if isinstance(node, sympy.MatrixBase):
        for number, entry in enumerate(node.flat()):
            for change, changed in _changes(entry):
                entries = [*node.flat()[:number], changed, *node.flat()[number + 1 :]]
                yield change, node.func(*node.shape, entries)
        return
    for number, argument in enumerate(node.args):
        for change, changed in _changes(argument):
            yield change, _with_argument(node, number, changed)


def _here(node: sympy.Basic) -> Iterator[Change]:
    if isinstance(node, sympy.Add):
        for number, term in enumerate(node.args):
            before, after = node.args[:number], node.args[number + 1 :]
            flipped = node.func(*before, -term, *after, evaluate=False)
            yield f"sign of {_brief(term)} flipped", flipped
            others = (*before, *after)
            rest = others[0] if len(others) == 1 else node.func(*others, evaluate=False)
            yield f"{_brief(term)} dropped", rest
    elif isinstance(node, sympy.Integer) and node not in (sympy.S.Zero, sympy.S.NegativeOne):
        yield f"{node} changed to {node + 1}", node + 1
    elif isinstance(node, sympy.Rational) and not isinstance(node, sympy.Integer):
        yield f"{node} changed to {2 * node}", 2 * node
    elif isinstance(node, sympy.Pow) and node.exp.is_Rational and not node.exp.is_Integer:
        for exponent in (node.exp + 1, node.exp - 1, -node.exp):
            changed = sympy.Pow(node.base, exponent, evaluate=False)
            yield f"exponent {node.exp} changed to {exponent}", changed
    elif node in MIRRORED_SYMBOLS:
        other = MIRRORED_SYMBOLS[node]
        yield f"{_brief(node)} replaced by {_brief(other)}", other
    elif type(node) in MIRRORED_FUNCTIONS:
        changed = MIRRORED_FUNCTIONS[type(node)](*node.args)
        yield f"{_brief(node)} replaced by {_brief(changed)}", changed
    elif isinstance(node, sy.Braces):
        first, second, index, last = node.args
        for by in (1, -1):
            changed = node.func(first, second, index, last + by)
            yield f"case {index} ≤ {_brief(last)} shifted to {_brief(last + by)}", changed
    elif isinstance(node, sympy.Sum | sy.Dot):
        yield f"sign of {_brief(node)} flipped", sympy.Mul(-1, node, evaluate=False)


def _with_argument(node: sympy.Basic, number: int, changed: sympy.Basic) -> sympy.Basic:
    arguments = (*node.args[:number], changed, *node.args[number + 1 :])
    if isinstance(node, sympy.Add | sympy.Mul | sympy.Pow):
        return node.func(*arguments, evaluate=False)
    return node.func(*arguments)


def _shifted_indices(node: sy.SiteFunction) -> Iterator[Change]:
    # one index by one, which leaves the lattice, and to two neighbours that are on it
    across, layer = node.args
    for right, up in ((1, 0), (0, -1), (2, 0), (-1, 1)):
        changed = node.func(across + right, layer + up)
        yield f"{_brief(node)} shifted to {_brief(changed)}", changed


def _shifted_bounds(node: sympy.Sum) -> Iterator[Change]:
    index, low, high = node.limits[0]
    for by in (1, -1):
        for name, bound, limits in (
            ("lower", low, (index, low + by, high)),
            ("upper", high, (index, low, high + by)),
        ):
            words = f"{name} bound {index} = {_brief(bound)} shifted to {_brief(bound + by)}"
            yield words, sympy.Sum(node.function, limits)


def _brief(node: sympy.Basic) -> str:
    shown = text(node)
    return shown if len(shown) <= 64 else shown[:62].rsplit(" ", 1)[0] + " …"
