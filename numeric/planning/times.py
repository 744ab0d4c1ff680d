"""About how long a plan takes: a small table, measured once on one machine.

Good to a factor of a few; what it decides is only between algorithms of one arithmetic, and what
would take longer than a day.
"""

from collections.abc import Mapping
from typing import NamedTuple

from ..arithmetic.systems import FLOAT64, LONGDOUBLE, Balls, NumberSystem
from ..mechanics.engine import COMPILED_FROM
from ..mechanics.problem import Problem, Route
from ..quantities.base import Quantity
from .plan import Method


class _Times(NamedTuple):
    """Seconds: of a layer (line sums: of a realisation), of a bead, of a bead and kilobit."""

    layer: float
    bead: float
    kilobit: float = 0.0


_SWEEPS = {
    ("float64", Route.EXACT): _Times(6e-4, 1e-6),
    ("float64", Route.FIRST_ORDER): _Times(2e-4, 2e-7),
    ("float64", Route.LINE_SUMS): _Times(7e-4, 8e-6),
    ("longdouble", Route.EXACT): _Times(6e-4, 1.6e-6),
    ("longdouble", Route.FIRST_ORDER): _Times(2e-4, 5e-7),
    ("longdouble", Route.LINE_SUMS): _Times(6e-4, 5e-6),
    ("mpmath", Route.EXACT): _Times(7e-4, 2.5e-4, 5e-5),
    ("mpmath", Route.FIRST_ORDER): _Times(4e-4, 8e-5, 2e-5),
    ("mpmath", Route.LINE_SUMS): _Times(5e-4, 1.6e-5, 1e-6),
    ("balls", Route.EXACT): _Times(6e-4, 2e-5, 2e-5),
    ("balls", Route.FIRST_ORDER): _Times(2e-4, 7e-6, 7e-6),
    ("balls", Route.LINE_SUMS): _Times(5e-4, 5e-6, 1e-6),
}
# Seconds of a row of the answer: gathered, certified, and printed; of one that is compared only.
_ROWS = {"float64": 1e-6, "longdouble": 2e-5, "mpmath": 6e-5, "balls": 1e-5}
_COMPARED = {"float64": 1e-7, "longdouble": 1e-7, "mpmath": 6e-5, "balls": 1e-5}
# Loading the compiled sweeps, and how much quicker the whole is with them.
_COMPILER, _COMPILED = 0.7, 0.6
# How much longer a bead takes in three dimensions.
_SPHERE = 3


def predicted(quantity: Quantity, problem: Problem, method: Method, together: int) -> float:
    """Predict the seconds of a method: its own pass, and what is repeated.

    ``together``: realisations that are swept at once.
    """
    seconds = _pass(quantity, problem, method.system, problem.realisations, together)
    if method.longer is not None:
        if method.repeated < problem.realisations:
            seconds += _pass(quantity, problem, method.system, method.repeated, together, _COMPARED)
        seconds += _pass(quantity, problem, method.longer, method.repeated, together, _COMPARED)
    return seconds


def _pass(
    quantity: Quantity,
    problem: Problem,
    system: NumberSystem,
    n: int,
    together: int,
    of_row: Mapping[str, float] = _ROWS,
) -> float:
    family = _family(system)
    bits = system.bits / 1000 if system.dtype is object else 0.0
    rows = quantity.answer_rows(problem.region, 1 if quantity.merged else n)
    spent = rows * of_row[family] * (1 + bits)
    if problem.route == Route.ORDERED:
        return spent
    region = problem.region
    if problem.route == Route.UNILATERAL:  # half of M*; far from it much less, beyond it more
        return spent + n * (1e-3 + 1e-5 * float(region.beads**1.85))
    layer, bead, kilobit = _SWEEPS[family, problem.route]
    if problem.route == Route.LINE_SUMS:
        beads = quantity.line_beads(problem.load)
        return spent + n * (layer + beads * (bead + kilobit * bits))
    chunks = -(-n // together)
    beads = region.beads * n + quantity.gathered(region, n)
    work = beads * (bead + kilobit * bits * (1 + bits / 10))
    work *= _SPHERE if problem.dimension == 3 else 1
    if system is FLOAT64 and problem.route == Route.EXACT and region.beads * n >= COMPILED_FROM:
        work = _COMPILER + work * _COMPILED
    return spent + len(region.rows) * chunks * layer + work


def _family(system: NumberSystem) -> str:
    if isinstance(system, Balls):
        return "balls"
    if system in (FLOAT64, LONGDOUBLE):
        return system.name
    return "mpmath"
