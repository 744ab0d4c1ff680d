"""How a witness compares what is stated with what exact packings say."""

from collections.abc import Iterable, Iterator
from fractions import Fraction

import sympy
from force_diffusion.derivations.framework.layered import Layered
from force_diffusion.symbolic.algebra import explicit
from force_diffusion.symbolic.symbols import M, j


def assert_equal(pairs: Iterable[tuple[str, Fraction, Fraction] | tuple[str, int, int]]) -> None:
    """There are pairs of values, the stated and the exact one, and all are equal."""
    count = 0
    for where, stated, exact in pairs:
        assert stated == exact, where
        count += 1
    assert count


def stated(
    layered: Layered, up_to: int, values: explicit.Values
) -> Iterator[tuple[int, int, Fraction]]:
    """M, j and what is stated there, for every layer of all packings of M ≤ ``up_to``."""
    for height in range(1, up_to + 1):
        for layer in range(height):
            form = _form_at(layered, height, layer)
            yield height, layer, explicit.number(form, {**values, M: height, j: layer})


def _form_at(layered: Layered, height: int, layer: int) -> sympy.Expr:
    """The form of a layer of one packing, by the domains of the cases."""
    for name, form in layered.forms.items():
        for size, at, value in form.exceptions:
            if (size, at) == (height, layer):
                return value
        if layered.where(name).holds({M: height, j: layer}):
            return form.expression
    raise LookupError(f"no exact form is for M = {height}, j = {layer}")
