"""About how long a plan takes: a small table, measured once on one machine.

Good to a factor of a few; what it decides is only between algorithms of one arithmetic, and what
would take longer than a day.
"""

import math
from collections.abc import Mapping
from dataclasses import replace
from importlib.util import find_spec
from typing import NamedTuple

from ..arithmetic.carried import PAIRS, Pairs
from ..arithmetic.systems import FLOAT64, LONGDOUBLE, Balls, NumberSystem
from ..mechanics.engine import worth_compiling
from ..mechanics.problem import Problem, Route
from ..quantities.base import Quantity
from ..theory.expected import expected_tension
from ..theory.tension import LOADS
from .plan import Method


class _Times(NamedTuple):
    """Seconds: of a layer (line sums: of a realisation), of a bead, of a bead and kilobit."""

    layer: float
    bead: float
    kilobit: float = 0.0


_SWEEPS = {
    ("float64", Route.EXACT): _Times(4e-4, 2.5e-7),
    ("float64", Route.FIRST_ORDER): _Times(8e-5, 5e-8),
    ("float64", Route.LINE_SUMS): _Times(5e-4, 1.5e-6),
    ("longdouble", Route.EXACT): _Times(1.6e-4, 6.5e-7),
    ("longdouble", Route.FIRST_ORDER): _Times(1.2e-4, 3e-7),
    ("longdouble", Route.LINE_SUMS): _Times(5e-4, 4e-6),
    ("pairs", Route.EXACT): _Times(4e-3, 3e-6),
    ("pairs", Route.FIRST_ORDER): _Times(2e-3, 2e-6),
    ("pairs", Route.LINE_SUMS): _Times(5e-4, 2e-5),
    ("mpmath", Route.EXACT): _Times(7e-4, 2.5e-4, 5e-5),
    ("mpmath", Route.FIRST_ORDER): _Times(4e-4, 8e-5, 2e-5),
    ("mpmath", Route.LINE_SUMS): _Times(5e-4, 1.6e-5, 1e-6),
    ("balls", Route.EXACT): _Times(6e-4, 2e-5, 2e-5),
    ("balls", Route.FIRST_ORDER): _Times(2e-4, 7e-6, 7e-6),
    ("balls", Route.LINE_SUMS): _Times(5e-4, 5e-6, 1e-6),
}
# Seconds of a row of the answer: gathered, certified, and printed; of one that is compared only.
_ROWS = {"float64": 1e-6, "longdouble": 2e-5, "pairs": 6e-5, "mpmath": 6e-5, "balls": 1e-5}
_COMPARED = {"float64": 1e-7, "longdouble": 1e-7, "pairs": 6e-5, "mpmath": 6e-5, "balls": 1e-5}
# Loading the compiled sweeps; a bead with them, all steps together.
_COMPILER, _COMPILED = 0.8, 8e-8
# How much longer a bead takes in three dimensions.
_SPHERE = 3


def predicted(quantity: Quantity, problem: Problem, method: Method, together: int) -> float:
    """Predict the seconds of a method: its own pass, and what is repeated.

    ``together``: realisations that are swept at once.
    """
    seconds = _pass(quantity, problem, method.system, problem.realisations, together)
    if method.carries:
        each = _pass(quantity, problem, PAIRS, method.repeated, together, _COMPARED)
        seconds = each + (seconds if method.repeated < problem.realisations else 0)
    elif method.longer is not None:
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
    if problem.route == Route.UNILATERAL:
        return spent + n * _relaxed(problem)
    layer, bead, kilobit = _SWEEPS[family, problem.route]
    if problem.route == Route.LINE_SUMS:
        beads = quantity.line_beads(problem.load)
        return spent + n * (layer + beads * (bead + kilobit * bits))
    chunks = -(-n // together)
    beads = region.beads * n + quantity.gathered(region, n)
    work = beads * (bead + kilobit * bits * (1 + bits / 10))
    size = _SPHERE if problem.dimension == 3 else 1
    if problem.route == Route.EXACT and compiles(problem, system, n):
        return spent + _COMPILER + _COMPILED * size * beads
    return spent + len(region.rows) * chunks * layer + size * work


def compiles(problem: Problem, system: NumberSystem, n: int) -> bool:
    """Say whether compiled sweeps will solve so many realisations, without loading them."""
    many = worth_compiling(replace(problem, realisations=n), system)
    return many and find_spec("numba") is not None


def _relaxed(problem: Problem) -> float:
    """Predict the seconds of a packing with unilateral contacts: most, where none pulls, need few.

    Where some do, times of both protocols lay within a factor of four of this.
    """
    beads, load, relaxing = problem.region.beads, problem.load, 1.0
    if load.kind in LOADS and not load.angle_deg and problem.width is not None:
        phi, std = float(1 - 2 * problem.n_x**2), float(problem.radii.relative_std())
        found = expected_tension(problem.height, problem.width, phi, std, load.kind)
        relaxing = -math.expm1(-found.contacts)
    return 5e-3 + 4e-5 * beads + relaxing * 1e-5 * float(beads**1.85)


def _family(system: NumberSystem) -> str:
    if isinstance(system, Balls):
        return "balls"
    if system in (FLOAT64, LONGDOUBLE):
        return system.name
    if isinstance(system, Pairs):
        return "pairs"
    return "mpmath"
