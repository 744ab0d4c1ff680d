"""How large an expression is: what would take too long to be read is refused before."""

import sympy

from .trees import nodes


def written_out(tree: sympy.Basic) -> int:
    """How many nodes a tree has when a part that it holds twice is counted twice."""
    count: dict[int, int] = {}
    for node in nodes(tree):
        count[id(node)] = 1 + sum(count[id(arg)] for arg in node.args)
    return count[id(tree)]


Lengths = tuple[int, dict[sympy.Basic, int]]
"""Bits of a numerator, and of each factor of the denominator."""


def bits(tree: sympy.Basic) -> int:
    """A bound on the length of its numbers when all of it is carried out; symbols count eight."""
    lengths: dict[int, Lengths] = {}
    for node in nodes(tree):
        lengths[id(node)] = _length(node, [lengths[id(arg)] for arg in node.args])
    return _whole(lengths[id(tree)])


def _whole(length: Lengths) -> int:
    return length[0] + sum(length[1].values())


def _length(node: sympy.Basic, parts: list[Lengths]) -> Lengths:
    """The lengths of a node from those of its parts; terms of a sum share their divisors."""
    if isinstance(node, sympy.Rational):
        divisor = sympy.Integer(node.q)
        return int(node.p).bit_length(), {divisor: node.q.bit_length()} if node.q > 1 else {}
    if isinstance(node, sympy.Pow) and isinstance(node.exp, sympy.Rational):
        times = max(1, -(-abs(int(node.exp.p)) // int(node.exp.q)))
        top, divisors = parts[0]
        if node.exp < 0:
            return times * sum(divisors.values()), {node.base: times * top}
        return times * top, {base: times * length for base, length in divisors.items()}
    if isinstance(node, sympy.Piecewise):  # each alternative is read by itself
        return max(map(_whole, parts), default=0), {}
    shared: dict[sympy.Basic, int] = {}
    for _, divisors in parts:
        for base, length in divisors.items():
            before = shared.get(base, 0)
            shared[base] = max(before, length) if isinstance(node, sympy.Add) else before + length
    tops = [top for top, _ in parts]
    if isinstance(node, sympy.Add):  # numerators are multiplied by the others' divisors
        return 8 + len(tops).bit_length() + max(tops) + sum(shared.values()), shared
    return 8 + sum(tops), shared


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
