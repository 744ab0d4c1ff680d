"""A tolerance chooses the arithmetic: the first of float64, pairs and balls that should do.

What is promised is measured afterwards: a bound by balls, or an estimate, and a method whose
estimate misses the tolerance gives way to the next (see ``run``). Last come balls, whose bits are
raised until their bound fits. What a scene names is never replaced: all methods answer the same
question about the same packings.
"""

from collections.abc import Iterator
from dataclasses import replace
from fractions import Fraction

from ..arithmetic.carried import LONGER, PAIRS
from ..arithmetic.decimals import short
from ..arithmetic.systems import FLOAT64, Balls
from ..mechanics.problem import Problem, Route
from ..scene.sections import SceneError
from ..theory.critical_height import critical_height
from .expected_error import expected, initial_bits
from .plan import Candidate, Choice, Method, Plan
from .prepared import PreparedScene

# Where so many realisations agree with a longer significand, the others are taken to do so, too.
FEW = 4
# Nearer to M* than this, disorder itself grows with the height, and rounding errors with it.
SOUND = 0.5


def choose(scene: PreparedScene, tolerance: Fraction, *, certified: bool) -> Plan:
    """Give the plan of the first method that should do, with all that were looked at.

    Raises ``SceneError`` if no method is possible.
    """
    found = list(_candidates(scene, tolerance, certified))
    possible = [candidate for candidate in found if not candidate.out]
    if not possible:
        scene.plan(Method(Balls(initial_bits(tolerance, scene.problem.height))))  # says why not
    reason = f"the first of {len(possible)} that should meet it"
    if certified:
        reason = "certified was asked for, and only balls certify"
    elif len(possible) == 1:
        reason = "the only one that should meet it"
    found.sort(key=lambda candidate: bool(candidate.out))
    first = found[0].plan
    assert first is not None
    return replace(first, choice=Choice(tolerance, reason, tuple(found)))


def _candidates(scene: PreparedScene, tolerance: Fraction, certified: bool) -> Iterator[Candidate]:
    """Look at all methods, in the order in which they are tried."""
    problem = scene.problem
    for method in _methods(tolerance, problem):
        error = expected(method, problem.height, problem.realisations)
        out = "" if method.certified else _why_not(method, problem, error, tolerance, certified)
        made = None
        try:
            made = scene.plan(method)
        except SceneError as refused:
            out = out or str(refused)
        name = method.system.name
        yield Candidate(
            scene.algorithm, name, method.certified, method.repeated, error, out,
            None if out else made,
        )  # fmt: skip


def _methods(tolerance: Fraction, problem: Problem) -> Iterator[Method]:
    """Give the arithmetics in their order; few realisations are repeated rather than all."""
    if problem.realisations > FEW:
        yield Method(FLOAT64, LONGER, FEW)
    yield Method(FLOAT64, LONGER, problem.realisations)
    yield Method(PAIRS, PAIRS, problem.realisations)
    yield Method(Balls(initial_bits(tolerance, problem.height)))


def _why_not(
    method: Method, problem: Problem, error: Fraction, tolerance: Fraction, certified: bool
) -> str:
    """Say why an estimate won't do; an empty string where it may."""
    if certified:
        return "its error would be estimated, and certified was asked for"
    if problem.stop_at_tension:
        return "where the sweep stops hangs on the signs of forces, which only balls decide"
    highest = critical_height(problem.radii.relative_std())
    if problem.route == Route.EXACT and problem.height > highest * SOUND:
        return f"the height is above M*/2 = {highest / 2:.3g}, where rounding errors grow with it"
    if error > tolerance:
        return f"expected to err by {short(error)}"
    return ""
