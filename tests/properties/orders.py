"""How what is left beside a printed equation has to fall with the strength ε of the disorder."""

from collections.abc import Iterable, Mapping

import sympy
from force_diffusion.symbolic import symbols as sy

import force_diffusion as fd
from tests.properties.drawn import Drawn, exactly, solved
from tests.properties.packing import Number, mp
from tests.properties.reading import Value

At = Mapping[sympy.Symbol, Value]

STRENGTHS = mp.mpf("1e-20"), mp.mpf("1e-22")
"""So small that what is left is ε² times a number up to a share of about 10⁻²⁰, and large enough:
ε² = 10⁻⁴⁴ stands 36 digits above ``ROUNDING``."""

ROUNDING = mp.mpf("1e-80")
"""Of 100 digits, 20 are for what a few layers lose (``test_packing.py`` measures it), and for
numbers above one."""


def printed(number: int | str) -> tuple[sympy.Eq, ...]:
    """The lines of an equation, as the package has them."""
    expression = fd.equation(number).expr
    return tuple(expression) if isinstance(expression, sympy.Tuple) else (expression,)


def size(value: Value) -> Number:
    """Of a vector, its largest component."""
    return max(map(abs, value)) if isinstance(value, tuple) else mp.mpf(abs(value))


def left_beside(equation: sympy.Eq, drawn: Drawn, at: At) -> list[Number]:
    """The left-hand side less the right-hand side, at both strengths."""
    weight, t = exactly(drawn.weight), exactly(drawn.t)
    at = {sy.f_load: weight, sy.L_plus: weight, sy.L_minus: t * weight, sy.t: t, **at}
    return [size(solved(drawn, epsilon).rest(equation, at)) for epsilon in STRENGTHS]


def falls(sizes: Iterable[Number], order: int, small: tuple[Number, Number] = STRENGTHS) -> bool:
    """Whether sizes at two small numbers fall at least with this power of them.

    The factor 2 is for what is of higher order: one power too few would be a factor of 100.
    """
    larger, smaller = sizes
    return bool(smaller <= 2 * larger * (small[1] / small[0]) ** order + ROUNDING)


def holds_to_first_order(equation: sympy.Eq, drawn: Drawn, places: Iterable[At]) -> None:
    """What is left is of order ε², at every place."""
    for at in places:
        sizes = left_beside(equation, drawn, at)
        assert falls(sizes, 2), f"{differ(at, sizes)}, which does not fall as ε²"


def is_identity(equation: sympy.Eq, drawn: Drawn, places: Iterable[At]) -> None:
    """Nothing is left, at every place and at both strengths."""
    for at in places:
        sizes = left_beside(equation, drawn, at)
        assert max(sizes) <= ROUNDING, f"{differ(at, sizes)}, and must not differ at all"


def differ(at: At, sizes: Iterable[Number], small: tuple[Number, Number] = STRENGTHS) -> str:
    """Where, and by how much, the two sides of an equation differ."""
    place = ", ".join(f"{symbol} = {value}" for symbol, value in at.items())
    by, strengths = (" and ".join(mp.nstr(size, 3) for size in two) for two in (sizes, small))
    return f"at {place} both sides differ by {by} for ε = {strengths}"
