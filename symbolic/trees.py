"""SymPy's trees as they are written: no equation is evaluated, and no divisor cancelled."""

from collections.abc import Iterator, Mapping
from typing import Any

import sympy


def equation(left: sympy.Expr, right: sympy.Expr) -> sympy.Eq:
    """An equation that is not evaluated to true or false."""
    return sympy.Eq(left, right, evaluate=False)


def nodes(tree: sympy.Basic, leaf: Any = None) -> Iterator[sympy.Basic]:
    """What a tree is made of, parts before what is made of them; one it holds twice comes once.

    Args:
        tree: a node with all that it holds.
        leaf: a node whose parts are left out.
    """
    seen: set[int] = set()
    left: list[tuple[sympy.Basic, bool]] = [(tree, False)]
    while left:
        node, its_parts_came = left.pop()
        if its_parts_came:
            yield node
        elif id(node) not in seen:
            seen.add(id(node))
            left.append((node, True))
            left += [(arg, False) for arg in node.args] if node != leaf else []


def in_place(tree: sympy.Basic, meaning: Mapping[Any, Any]) -> sympy.Basic:
    """What is written in short, put in one after the other; no divisor is cancelled by it."""
    for what, image in meaning.items():
        tree = _in_place(tree, what, image)
    return tree


def _in_place(tree: sympy.Basic, what: Any, image: Any) -> sympy.Basic:
    """`what`, a node or a class of them, put in wherever the tree has it, without recursion."""
    put: dict[int, sympy.Basic] = {}
    for node in nodes(tree, what):
        if node == what:
            put[id(node)] = image
            continue
        args = [put[id(arg)] for arg in node.args]
        if isinstance(what, type) and isinstance(node, what):
            put[id(node)] = image(*args)
        elif all(new is old for new, old in zip(args, node.args, strict=True)):
            put[id(node)] = node
        elif isinstance(node, sympy.Add | sympy.Mul | sympy.Pow | sympy.Eq):
            put[id(node)] = node.func(*args, evaluate=False)
        else:
            put[id(node)] = node.func(*args)
    return put[id(tree)]
