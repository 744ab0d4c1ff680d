"""Rules of averages over the layers, and of what they go to, with what they rest on."""

from collections.abc import Callable

import sympy
from force_diffusion.symbolic.as_printed import equation
from force_diffusion.symbolic.kernel import averages
from force_diffusion.symbolic.kernel.rules import Rule
from force_diffusion.symbolic.kernel.theorem import Theorem
from force_diffusion.symbolic.kernel.where import Where

from .grounds import By, Proved, Source, known


def _by(rule: Callable[..., Rule], *sources: Source) -> By:
    return By(lambda supposed: rule(*known(sources, supposed)), sources)


def total(layers: Source) -> By:
    """A sum over all layers, from what is known of each."""
    return _by(averages.total, layers)


def expansion(*exact: Source) -> By:
    """As many leading orders as the limit says, of what is known at finite size."""
    return _by(averages.expansion, *exact)


def unit_height(order: Source) -> By:
    """The height at which a leading order is one."""
    return _by(averages.unit_height, order)


def proportional(order: Source, exact: Source, height: Proved | None = None) -> By:
    """Left over right goes to a positive number that depends on φ alone.

    Args:
        order: the leading order of the mean on the left, or of which the height on the left is.
        exact: the same mean at finite size, where explicit values are looked for.
        height: what that height is.
    """
    facts = (height or order,)

    def finite(formula: sympy.Eq, _where: Where) -> sympy.Eq:
        image = {one.formula.lhs: one.formula.rhs for one in known((exact, *facts), ())}
        return equation(*(side.xreplace(image) for side in formula.args))

    return By(lambda supposed: averages.proportional(*known(facts, supposed)), (order,), finite)


def restated(theorem: Source, *heights: Source) -> By:
    """What a theorem in a limit says, with heights put in."""
    return _by(averages.restated, theorem, *heights)


def integral(*slopes: Source) -> By:
    """A mean over 0 < z < 1, of a polynomial or by an antiderivative."""
    return _by(averages.integral, *slopes)


def mean_of_roots(layers: Source) -> By:
    """The mean of the root of a variance goes as an integral."""
    return _by(averages.mean_of_roots, layers)


def density() -> By:
    """SymPy differentiates an error function."""
    return By(lambda _: averages.density)


def tensile(layers: Source, height: Source, probability: Source, means: Proved) -> By:
    """The mean over the layers of P(f < 0), assuming Gaussian forces."""

    def rule(supposed: tuple[Theorem, ...]) -> Rule:
        (below,), (at,) = known(probability, supposed), known(height, supposed)
        return averages.tensile(below, at, known(layers, supposed), known(means, supposed))

    return By(rule, (layers, height, probability))
