"""A sequence of linear programs, each with newly linearised gaps, until beads rest.

Minimise the load's energy over moves u with g + n·Δu ≥ 0 for all near pairs and |u| ≤ Δ a
coordinate; move; repeat. A gap is never smaller than its linearisation, so that no step overlaps
beads, and the energy falls. Where it ends depends on Δ.
"""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ..arithmetic.errors import MissingLibraryError
from ..arithmetic.systems import Array
from .grains import Grains, Pairs
from .network import UnfinishedError

# Δ, in units of r.
TRUST = 0.8
# The energy of the load, relative to its own scale, that a program must gain for another to follow.
GAIN = 1e-12
# Programs over which the fall of beads that don't come to rest is averaged.
LATE = 100
# Gaps up to this are constraints; a move ends where it would close another one.
CLOSE = 0.8
# Where fewer contacts than this are new, the simplex method goes on from the last vertex: it costs
# what has changed. Before, interior points are faster.
FEW = 200
# Forces below this share of the largest one are none: what float64 and the programs leave.
NO_FORCE = 1e-7


def relax(grains: Grains, most: int, progress: Callable[[int], None]) -> tuple[Pairs, Array, int]:
    """Move ``grains``, which must not overlap, until they rest.

    Gives near pairs, the force of each, and how many programs it took. Raises ``UnfinishedError``
    after ``most`` programs, and ``MissingLibraryError`` without highspy.
    """
    scale, gains = float(np.abs(grains.weights).sum()), []
    programs, by_simplex, bore = _Programs(grains), False, np.array([])
    for program in range(1, most + 1):
        pairs, move, forces = programs.solve(by_simplex)
        before = grains.energy()
        grains.move(move)
        gain = before - grains.energy()
        gains.append(gain)
        # the solver is exact to about 1e-9 of what it minimises
        if gain < -1e-7 * scale:
            raise UnfinishedError(
                f"the energy of the load rose by {-gain:.3g} in a program: please report this"
            )
        progress(program)
        at_rest = gain < GAIN * scale
        if at_rest and by_simplex:
            return pairs, forces, program
        bear = grains.named(pairs[forces > NO_FORCE * forces.max(initial=0)])
        by_simplex = at_rest or len(np.setdiff1d(bear, bore)) < FEW
        bore = bear
    raise UnfinishedError(_still_moving(grains, np.array(gains) / np.hypot(*grains.load.T).sum()))


def _still_moving(grains: Grains, falls: Array) -> str:
    """Say how beads move on; ``falls``: of a loaded bead a program in the mean, along the load."""
    loaded = grains.fixed + np.flatnonzero(grains.load[grains.fixed :].any(axis=1))
    height = float(grains.x[loaded, 1].mean())
    late = float(falls[-LATE:].mean())
    through = int(np.count_nonzero(grains.x[loaded, 1] < grains.x[: grains.fixed, 1].min()))
    verdict = f"beads still slide after {len(falls)} linear programs (effects.most_programs)"
    if through:
        verdict = (
            f"{through} beads that bear loads, of {len(loaded)}, fell through the base: "
            f"{grains.hole_and_smallest()}"
        )
    return f"{verdict}; a loaded bead falls by {late:.2g} r a program, at y = {height:.3g} r"


@dataclass
class _Programs:
    """One program after the other; the last vertex is kept, its rows by the pairs' names."""

    grains: Grains
    columns: list[Any] = field(default_factory=list)
    rows: dict[int, Any] = field(default_factory=dict)

    def solve(self, by_simplex: bool) -> tuple[Pairs, Array, Array]:
        """Give pairs, moves, and forces as multipliers of the gaps, zero off the vertex."""
        near = self.grains.near(2 * np.sqrt(2) * TRUST)
        gaps = np.maximum(self.grains.gaps(near), 0)
        A = self.grains.jacobian(near)
        close = gaps < CLOSE
        move, forces = self._solved(near[close], gaps[close], A[close], by_simplex)
        narrower = -(A @ move)
        meet = ~close & (narrower > gaps)
        move *= (gaps[meet] / narrower[meet]).min(initial=1.0)
        return near[close], move, forces

    def _solved(self, pairs: Pairs, gaps: Array, A: Any, by_simplex: bool) -> tuple[Array, Array]:
        """Solve by the simplex method from the last vertex, or by interior points.

        These cross over to a vertex where there is no last one, or it is too far away.
        """
        try:
            import highspy
        except ImportError:
            raise MissingLibraryError(
                'contacts that open need highspy: pip install "force-diffusion[unilateral]"'
            ) from None
        program = highspy.HighsLp()
        program.num_col_, program.num_row_ = A.shape[1], A.shape[0]
        program.col_cost_ = -self.grains.weights
        program.col_lower_ = np.full(A.shape[1], -TRUST)
        program.col_upper_ = np.full(A.shape[1], TRUST)
        program.row_lower_ = -gaps
        program.row_upper_ = np.full(A.shape[0], highspy.kHighsInf)
        program.a_matrix_.format_ = highspy.MatrixFormat.kRowwise
        program.a_matrix_.start_ = A.indptr
        program.a_matrix_.index_ = A.indices
        program.a_matrix_.value_ = A.data
        solver = highspy.Highs()  # type: ignore[no-untyped-call]
        _set(solver)
        solver.passModel(program)
        names = self.grains.named(pairs).tolist()
        optimal = highspy.HighsModelStatus.kOptimal
        if by_simplex and self.columns:
            # primal, and given up where it takes long
            most, exact = A.shape[1] // 4, 1e-10
            _set(
                solver, solver="simplex", presolve="off", simplex_strategy=4,
                simplex_iteration_limit=most, primal_feasibility_tolerance=exact,
                dual_feasibility_tolerance=exact,
            )  # fmt: skip
            basis, inactive = highspy.HighsBasis(), highspy.HighsBasisStatus.kBasic
            basis.valid = basis.alien = True
            basis.col_status = self.columns
            basis.row_status = [self.rows.get(name, inactive) for name in names]
            solver.setBasis(basis)
            solver.run()
        if solver.getModelStatus() != optimal:
            _set(solver, solver="ipx", run_crossover="on" if by_simplex else "off")
            solver.clearSolver()
            solver.run()
        status = solver.getModelStatus()
        if status != optimal:
            raise UnfinishedError(
                f"a linear program was not solved: {solver.modelStatusToString(status)}"
            )
        self.columns = []
        if by_simplex:
            vertex = solver.getBasis()
            self.columns = list(vertex.col_status)
            self.rows = dict(zip(names, vertex.row_status, strict=True))
        solution = solver.getSolution()
        return np.array(solution.col_value), np.array(solution.row_dual)


def _set(solver: Any, /, **options: Any) -> None:
    """Set these options of HiGHS, and all others as they are by default; it works in silence."""
    solver.resetOptions()
    for name, value in {"output_flag": False, "threads": 1, **options}.items():
        solver.setOptionValue(name, value)
