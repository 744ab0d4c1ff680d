"""From a scene to a plan: which beads, what is done with them, what is left out, in which digits.

One planner serves both explaining and running: ``run`` takes its problem and its method from here
and adds nothing but the measured cost.
"""

from collections.abc import Callable
from fractions import Fraction
from functools import lru_cache
from time import monotonic

from ..arithmetic.carried import LONGER, Pairs
from ..arithmetic.errors import ForceDiffusionError
from ..arithmetic.machine import memory_limit as free_memory
from ..arithmetic.systems import FLOAT64, Balls, NumberSystem
from ..mechanics.problem import Route
from ..quantities import quantity_of
from ..scene.scene import Scene
from ..scene.sections import SceneError
from . import budget
from .choice import choose
from .expected_error import initial_bits
from .plan import Method, Plan
from .prepared import prepared

# Realisations that are solved twice to estimate the error: four of packings that are small.
FEW, SMALL = 4, 20_000
# To which packings are enclosed whose contacts open, relative to the largest force.
TOUCHING = Fraction(1, 10**17)


def plan(
    scene: Scene,
    tolerance: Fraction | None = None,
    memory_limit: int | None = None,
    *,
    certified: bool = False,
    system: NumberSystem = FLOAT64,
    text: bool = True,
) -> Plan:
    """Plan a scene; ``tolerance`` and ``certified`` override the scene's own.

    With a tolerance the first of float64, pairs and balls is chosen that should meet it;
    ``certified`` keeps the choice to balls. Without one ``system`` is the arithmetic. Room is left
    for rows as ``text``, as files and screens have them. Reads the
    scene's files. Raises ``SceneError`` for a scene that is too large for the memory
    (``memory_limit`` bytes, by default most of what is free), and ``TableError``.
    """
    tolerance = tolerance or scene.ask.tolerance
    certified = certified or scene.ask.certified
    if certified and tolerance is None:
        raise SceneError("ask.certified", True, "needs a tolerance, as tolerance = 1e-30")
    limit = _free(int(monotonic()), free_memory) if memory_limit is None else memory_limit
    try:
        return _plan(scene, tolerance, limit, system, certified=certified, text=text)
    except budget.TooLargeError as refused:
        if tolerance is None or certified:
            raise
        try:
            free = _plan(scene, None, limit, system, certified=False, text=text)
        except ForceDiffusionError:
            raise refused from None
        takes = f"about {budget.size(free.memory)}"
        said = f"{refused.allowed}; without the tolerance it would take {takes}"
        raise budget.TooLargeError(refused.key, refused.value, said) from None


@lru_cache(maxsize=1)
def _free(second: int, look: Callable[[], int]) -> int:
    """Give the free memory; it is looked up once in a second."""
    return look()


def _plan(
    scene: Scene,
    tolerance: Fraction | None,
    limit: int,
    system: NumberSystem,
    *,
    certified: bool,
    text: bool,
) -> Plan:
    """Plan a scene with this very tolerance."""
    found = prepared(scene, quantity_of(scene), limit, tolerance, text=text)
    first = found.problem
    if first.route == Route.ORDERED:  # exactly known, whatever is asked
        bits = initial_bits(tolerance or Fraction(1, 2**60), first.height)
        return found.plan(Method(Balls(bits)))
    if first.route == Route.UNILATERAL:  # found in float64, proved in balls
        return found.plan(Method(Balls(initial_bits(tolerance or TOUCHING, 1))))
    if tolerance is None:
        few = FEW if first.region.beads < SMALL else 1
        all_listed = _method(system, 1).carries and not found.quantity.merged
        few = first.realisations if all_listed else min(first.realisations, few)
        return found.plan(_method(system, few))
    return choose(found, tolerance, certified=certified)


def _method(system: NumberSystem, repeated: int) -> Method:
    """Say how the error of an answer in this arithmetic becomes known."""
    if isinstance(system, Balls):
        return Method(system)
    if isinstance(system, Pairs):
        return Method(system, system, repeated)
    return Method(system, LONGER if system is FLOAT64 else Balls(system.bits + 128), repeated)
