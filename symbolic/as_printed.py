"""Build expressions that keep the paper's order of terms and factors."""

from collections.abc import Iterator, Mapping
from typing import Any

import sympy


def terms(*summands: sympy.Expr) -> sympy.Add:
    """A sum that is not reordered."""
    return sympy.Add(*summands, evaluate=False)


def times(*factors: sympy.Expr) -> sympy.Mul:
    """A product that is not reordered or expanded; a factor of 1 is left out."""
    return sympy.Mul(*(one for one in factors if one != 1), evaluate=False)


def power(base: sympy.Expr, exponent: sympy.Expr | int) -> sympy.Pow:
    """A power that is not distributed over its base's factors."""
    return sympy.Pow(base, exponent, evaluate=False)


def minus(expression: sympy.Expr) -> sympy.Mul:
    """The negative, kept as a product with −1."""
    return sympy.Mul(-1, expression, evaluate=False)


def equation(left: sympy.Expr, right: sympy.Expr) -> sympy.Eq:
    """An equation that is not evaluated to true or false."""
    return sympy.Eq(left, right, evaluate=False)


def nodes(tree: sympy.Basic) -> Iterator[sympy.Basic]:
    """What a tree is made of, parts before what is made of them; one it holds twice comes once."""
    seen: set[int] = set()
    left: list[tuple[sympy.Basic, bool]] = [(tree, False)]
    while left:
        node, its_parts_came = left.pop()
        if its_parts_came:
            yield node
        elif id(node) not in seen:
            seen.add(id(node))
            left.append((node, True))
            left += [(one, False) for one in node.args]


def written_out(tree: sympy.Basic) -> int:
    """How many nodes a tree has when a part that it holds twice is counted twice."""
    count: dict[int, int] = {}
    for node in nodes(tree):
        count[id(node)] = 1 + sum(count[id(one)] for one in node.args)
    return count[id(tree)]


def bits(tree: sympy.Basic) -> int:
    """A bound on the length of its numbers when all of it is carried out; symbols count eight."""
    found: dict[int, int] = {}
    for node in nodes(tree):
        parts = [found[id(one)] for one in node.args]
        if isinstance(node, sympy.Rational):
            length = sum(int(part).bit_length() for part in (node.p, node.q))
        elif isinstance(node, sympy.Pow) and isinstance(node.exp, sympy.Rational):
            length = parts[0] * max(1, -(-abs(int(node.exp.p)) // int(node.exp.q)))
        elif isinstance(node, sympy.Piecewise):  # each alternative is read by itself
            length = max(parts, default=0)
        else:
            length = 8 + sum(parts)
        found[id(node)] = length
    return found[id(tree)]


_MOST_NODES = 100_000
"""Of what is read, written out: a hundred times the longest printed statement."""

_MOST_BITS = 50_000
"""Of its numbers: ten times those of the longest one."""


def too_large(tree: sympy.Basic) -> str:
    """Why a tree would take too long to be read; "" when it would not."""
    if written_out(tree) > _MOST_NODES:
        return f"it is too large: at most {_MOST_NODES} parts are read"
    if bits(tree) > _MOST_BITS:
        return f"it is too large: carried out, it may hold numbers of more than {_MOST_BITS} bits"
    return ""


def in_place(tree: sympy.Basic, meaning: Mapping[Any, Any]) -> sympy.Basic:
    """What is written in short, put in one after the other; no divisor is cancelled by it."""
    for what, image in meaning.items():
        tree = _in_place(tree, what, image)
    return tree


def _in_place(tree: sympy.Basic, what: Any, image: Any) -> sympy.Basic:
    """`what`, a node or a class of them, put in wherever the tree has it, without recursion."""
    put: dict[int, sympy.Basic] = {}
    for node in nodes(tree):
        args = [put[id(one)] for one in node.args]
        if node == what:
            put[id(node)] = image
        elif isinstance(what, type) and isinstance(node, what):
            put[id(node)] = image(*args)
        elif all(new is old for new, old in zip(args, node.args, strict=True)):
            put[id(node)] = node
        elif isinstance(node, sympy.Add | sympy.Mul | sympy.Pow | sympy.Eq):
            put[id(node)] = node.func(*args, evaluate=False)
        else:
            put[id(node)] = node.func(*args)
    return put[id(tree)]


def certificate(total: sympy.Sum, up_to_n: sympy.Expr) -> tuple[sympy.Eq, sympy.Eq]:
    """What a sum up to n is, and its term at n as what that gains there: two lines of a step."""
    index, _, high = total.limits[0]
    parts = up_to_n.args if isinstance(up_to_n, sympy.Add) else (up_to_n,)
    after = [part for part in parts if part.has(high)]  # the others cancel
    before = [-part.xreplace({high: high - 1}) for part in after]
    term = total.function.xreplace({index: high})
    return equation(total, up_to_n), equation(term, terms(*after, *before))
