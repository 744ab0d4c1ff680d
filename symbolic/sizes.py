"""How large an expression is: what would take too long to be read is refused before."""

import sympy

from .trees import nodes


def written_out(tree: sympy.Basic) -> int:
    """How many nodes a tree has when a part that it holds twice is counted twice."""
    count: dict[int, int] = {}
    for node in nodes(tree):
        count[id(node)] = 1 + sum(count[id(arg)] for arg in node.args)
    return count[id(tree)]


def bits(tree: sympy.Basic) -> int:
    """A bound on the length of its numbers when all of it is carried out; symbols count eight."""
    lengths: dict[int, int] = {}
    for node in nodes(tree):
        parts = [lengths[id(arg)] for arg in node.args]
        if isinstance(node, sympy.Rational):
            length = sum(int(part).bit_length() for part in (node.p, node.q))
        elif isinstance(node, sympy.Pow) and isinstance(node.exp, sympy.Rational):
            length = parts[0] * max(1, -(-abs(int(node.exp.p)) // int(node.exp.q)))
        elif isinstance(node, sympy.Piecewise):  # each alternative is read by itself
            length = max(parts, default=0)
        else:
            length = 8 + sum(parts)
        lengths[id(node)] = length
    return lengths[id(tree)]


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
