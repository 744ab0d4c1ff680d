"""The certified reference of a study of cost: balls far smaller than every error shown."""

from fractions import Fraction

from ..accuracy import ToleranceError, enclosed
from ..arithmetic.systems import Balls
from ..mechanics.work import Work
from ..planning import planner
from ..scene.scene import Scene
from ..scene.sections import SceneError
from .distances import Enclosed, changes
from .ways import DIGITS

# The reference's radius has to lie this far below the last digit of the most precise way.
BEYOND = Fraction(1, 10 ** (max(DIGITS) + 20))


def certified(scene: Scene) -> Enclosed:
    """Enclose a packing's changes so tightly that no error shown depends on the radius.

    Raises ``ToleranceError``, and ``SceneError`` where nothing changes.
    """
    plan = planner.plan(scene, BEYOND, certified=True)
    plan, found, (accuracy,) = enclosed(plan, Work(repeating=True))
    assert isinstance(plan.system, Balls)
    true = Enclosed(changes(found.table), plan.system)
    if true.largest.is_zero() and true.radius.is_zero():
        raise SceneError("ask.quantity", scene.ask.quantity, "it is exactly zero")
    if not true.sound:
        raise ToleranceError(f"no certified reference was found: {accuracy.note}")
    return true
