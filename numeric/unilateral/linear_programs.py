"""The protocol for size: linear programs in a row, each on the gaps linearised, until beads rest.

Minimise the load's energy over moves u with g + n·Δu ≥ 0 for all near pairs and |u| ≤ Δ a
coordinate; move; repeat. A gap is never smaller than its linearisation, so that no step overlaps
beads, and the energy falls. Where it ends depends on Δ, which therefore belongs to the protocol.
"""

from collections.abc import Callable

import numpy as np

from ..arithmetic.errors import ForceDiffusionError
from ..arithmetic.systems import Array
from .grains import Grains, Pairs
from .network import UnfinishedError

# Δ, in units of r.
TRUST = 0.8
# The energy of the load, relative to its own scale, that a program must gain for another to follow.
GAIN = 1e-12
MOST_PROGRAMS = 400


class MissingSolverError(ForceDiffusionError, ImportError):
    """The solver of linear programs is not installed."""


def relax(grains: Grains, progress: Callable[[int], None]) -> tuple[Pairs, Array, int]:
    """Move ``grains``, which must not overlap, until they rest.

    Gives near pairs, the force of each, and the number of programs. Raises ``UnfinishedError``, and
    ``MissingSolverError`` without highspy.
    """
    scale = float(np.abs(grains.weights).sum())
    for program in range(1, MOST_PROGRAMS + 1):
        pairs = grains.near(2 * np.sqrt(2) * TRUST)
        move, forces = _solved(grains, pairs)
        before = grains.energy()
        grains.x = grains.x.copy()
        grains.x[grains.fixed :] += move.reshape(-1, 2)
        gain = before - grains.energy()
        # the solver is exact to about 1e-9 of what it minimises
        if gain < -1e-7 * scale:
            raise UnfinishedError(
                f"the energy of the load rose by {-gain:.3g} in a program: please report this"
            )
        progress(program)
        if gain < GAIN * scale:
            _, forces = _solved(grains, pairs, vertex=True)
            return pairs, forces, program
    raise UnfinishedError(f"beads still move after {MOST_PROGRAMS} linear programs")


def _solved(grains: Grains, pairs: Pairs, *, vertex: bool = False) -> tuple[Array, Array]:
    """Solve one program by interior points: moves, and forces as multipliers of the gaps.

    At a ``vertex``, which takes longer, forces are exactly zero but for those of a basis.
    """
    try:
        import highspy
    except ImportError:
        raise MissingSolverError(
            'protocol = "linear-programs" needs highspy, "force-diffusion[unilateral]"; '
            'protocol = "event-driven" does without'
        ) from None
    A = grains.jacobian(pairs)
    program = highspy.HighsLp()
    program.num_col_, program.num_row_ = A.shape[1], A.shape[0]
    program.col_cost_ = -grains.weights
    program.col_lower_ = np.full(A.shape[1], -TRUST)
    program.col_upper_ = np.full(A.shape[1], TRUST)
    program.row_lower_ = -np.maximum(grains.gaps(pairs), 0)
    program.row_upper_ = np.full(A.shape[0], highspy.kHighsInf)
    program.a_matrix_.format_ = highspy.MatrixFormat.kRowwise
    program.a_matrix_.start_ = A.indptr
    program.a_matrix_.index_ = A.indices
    program.a_matrix_.value_ = A.data
    solver = highspy.Highs()  # type: ignore[no-untyped-call]
    crossover = "on" if vertex else "off"
    for option, value in (
        ("output_flag", False), ("solver", "ipm"), ("run_crossover", crossover), ("threads", 1),
    ):  # fmt: skip
        solver.setOptionValue(option, value)
    solver.passModel(program)
    solver.run()
    status = solver.getModelStatus()
    if status != highspy.HighsModelStatus.kOptimal:
        raise UnfinishedError(
            f"a linear program was not solved: {solver.modelStatusToString(status)}"
        )
    solution = solver.getSolution()
    return np.array(solution.col_value), np.array(solution.row_dual)
