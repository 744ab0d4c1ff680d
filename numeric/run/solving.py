"""Contact forces and positions for radii of one's own, as arrays."""

import math
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import Any

import numpy as np

from ..accuracy.accuracy import Accuracy
from ..arithmetic.named import system_of
from ..arithmetic.systems import FLOAT64, Array, as_floats
from ..mechanics.physicality import Physicality
from ..mechanics.problem import Route
from ..planning.planner import plan
from ..scene.scene import Scene
from ..scene.sections import Ask, GivenRadii, Load, Packing, SceneError, SurfaceLoad
from .outcome import Outcome
from .running import read_tolerance, run


@dataclass(frozen=True, eq=False, repr=False)
class Solution:
    """Periodic packings on an ordered base, solved exactly; shapes are for a single packing.

    A batch of N packings adds a first axis of length N everywhere. M layers lie above the base, W
    beads in each. Bead (j, q) is the paper's (i, j) with i = 2q + j mod 2. Forces are in the unit
    in which the load's magnitude is written, lengths in that of the radii.

    Numbers are float64, or objects of a longer arithmetic where one was chosen or a tolerance needs
    it. A ball of python-flint prints few digits, and holds all: ``.astype(float)`` rounds an array,
    ``forces.decimals()`` and ``positions.decimals()`` write every digit that is known.
    """

    forces: Outcome
    """The run behind the forces: plan, error, rows and decimals."""
    scene: Scene

    @property
    def sees_images(self) -> bool:
        """Whether some bead bears on another by two ways around the period."""
        return self.forces.plan.sees_images

    @property
    def force(self) -> Array:
        """f^±_ij, shape (2, M, W): branch (0: "+", 1: "-"), layer j and column q of the lower bead.

        Compressive forces are positive.
        """
        return self._contacts("force")

    @property
    def change(self) -> Array:
        """f^±_ij less its value in the ordered packing, (2, M, W); found without cancelling."""
        return self._contacts("change")

    @property
    def position(self) -> Array:
        """Bead centres, shape (M + 1, W, 2): layer, column, (x, y)."""
        return self._beads("x", "y")

    @property
    def displacement(self) -> Array:
        """Bead centres less those of the ordered packing (Eqs. 1 to 3), shape (M + 1, W, 2)."""
        return self._beads("dx", "dy")

    @property
    def accuracy(self) -> Accuracy:
        """The error of the forces, relative to the largest change, and how it is known."""
        return self.forces.accuracy

    @property
    def error(self) -> float:
        """Bound or estimate of the largest error of a change, relative to the largest change."""
        return float(self.accuracy.error_bound)

    @property
    def certified(self) -> bool:
        """Whether ``error`` is a rigorous bound, and not an estimate."""
        return self.accuracy.certified

    @property
    def physical(self) -> Physicality | None:
        """Overlaps and tensile contacts, over all packings; None where all radii are equal."""
        return self.forces.physical

    @cached_property
    def positions(self) -> Outcome:
        """The run behind the positions and their ``accuracy``, made when first asked for."""
        ask = self.scene.ask.model_copy(update={"quantity": "positions"})
        made = self.forces.plan
        scene = self.scene.model_copy(update={"ask": ask})
        certified = made.tolerance is not None and made.method.certified
        return run(plan(scene, made.tolerance, certified=certified, system=made.system, text=False))

    @property
    def _shape(self) -> tuple[int, ...]:
        """(…, M, W)."""
        given = self.scene.disorder
        assert isinstance(given, GivenRadii)
        *batch, layers, width = given.values.shape
        return (*batch, layers - 1, width)

    def _contacts(self, name: str) -> Array:
        *batch, M, W = self._shape
        rows = self._numbers(self.forces, name).reshape(*batch, M, W, 2)
        return np.moveaxis(rows, -1, -3)

    def _beads(self, *names: str) -> Array:
        *batch, M, W = self._shape
        columns = [self._numbers(self.positions, name) for name in names]
        return np.stack([column.reshape(*batch, M + 1, W) for column in columns], axis=-1)

    def _numbers(self, outcome: Outcome, name: str) -> Array:
        """Give a column; of equal radii, which are solved once, in balls, as was asked for."""
        values = outcome.arrays[name]
        if outcome.plan.problem.route != Route.ORDERED:
            return values
        values = np.tile(values, math.prod(self._shape[:-2]))
        return values if outcome.plan.tolerance is not None else as_floats(values)

    def __str__(self) -> str:
        """Say what was found, how accurately, and what was done for it."""
        return str(self.forces)

    __repr__ = __str__


@contextmanager
def _named_as_here() -> Iterator[None]:
    """Name arguments of ``solve`` in errors, and not the keys of a scene that they become."""
    try:
        yield
    except SceneError as error:
        name = error.key.removeprefix("packing.").removeprefix("disorder.")
        raise SceneError(name, error.value, error.allowed) from None


def solve(
    radii: Any = None,
    *,
    delta_r: Any = None,
    radius: Any = None,
    spacing: Any = None,
    load: Load | None = None,
    tolerance: Any = None,
    certified: bool = False,
    arithmetic: str | None = None,
    allow_images: bool = False,
) -> Solution:
    """Solve periodic packings of given radii exactly: contact forces, positions and their errors.

    Args:
        radii: array of shape (M + 1, W), layer 0 the base; (N, M + 1, W) for N packings.
        delta_r: their deviations from ``radius``, in place of ``radii``; the same shapes.
        radius: r, the radius of the ordered packing, in the same unit; by default the mean of
            ``radii`` (over all N packings: changes of a packing by itself need its own), and 1
            where ``delta_r`` is given.
        spacing: s, the distance of neighbours in the base, 2 r < s < 2√3 r; by default 3 r.
        load: ``SurfaceLoad()`` by default, ``BulkLoad()`` or ``PointLoad(at=(k, l))``.
        tolerance: error allowed, relative to the largest change; the first of float64, pairs
            and balls that meets it is taken.
        certified: with a tolerance, only a rigorous bound will do.
        arithmetic: "float64" (the default), "pairs" (a number
            and its error, about 28 digits), "longdouble", "mpmath N" or "balls N" with N decimal
            digits; not with a tolerance, which chooses it.
        allow_images: let W be as small as M or smaller, so that a bead bears on one by two ways
            around the period; without it such an array, a transposed one perhaps, is refused.

    Raises:
        SceneError: an argument is not allowed; the message names it, and what is allowed.
        UnbuildableError: a bead can't rest on its two supports; the message names it.
        ToleranceError: the tolerance can't be reached.

    >>> import numpy as np
    >>> radii = 1 + 1e-3 * np.random.default_rng(1).uniform(-1, 1, (5, 12))
    >>> solution = solve(radii, spacing=3)
    >>> solution.force.shape, solution.position.shape, solution.error < 1e-12
    ((2, 4, 12), (5, 12, 2), True)
    """
    if (radii is None) == (delta_r is None):
        raise SceneError("radii", None, "give either radii or delta_r")
    with _named_as_here():
        given = GivenRadii(radii=radii) if delta_r is None else GivenRadii(delta_r=delta_r)
    if load is not None and not isinstance(load, Load):
        allowed = "must be SurfaceLoad(), BulkLoad(), PointLoad(at=(k, l)) or Load(kind=…)"
        raise SceneError("load", load, allowed)
    if tolerance is not None and arithmetic is not None:
        raise SceneError("arithmetic", arithmetic, "a tolerance chooses it: leave one of them out")
    if certified and tolerance is None:
        raise SceneError("certified", True, "needs a tolerance, as tolerance=1e-30")
    shape = given.values.shape
    if shape[-2] < 2:
        raise SceneError(given.name, None, f"shape {shape}: a packing has at least 2 layers")
    if shape[-1] < shape[-2] and not allow_images:
        raise SceneError(
            given.name,
            None,
            f"shape {shape}: {shape[-2]} layers of {shape[-1]} beads bear on their own periodic "
            "images; layers come before columns: if that is what it is, say allow_images=True",
        )
    if radius is None:
        radius = Fraction(float(given.values.mean())) if delta_r is None else 1
    with _named_as_here():
        scene = Scene(
            packing=Packing(
                height=shape[-2] - 1,
                width=shape[-1],
                radius=radius,
                spacing=spacing,
                allow_images=allow_images,
            ),
            disorder=given,
            load=SurfaceLoad() if load is None else load,
            ask=Ask(quantity="contact_forces", realisations=shape[0] if len(shape) == 3 else 1),
        )
    asked = None if tolerance is None else read_tolerance(tolerance)
    try:
        system = FLOAT64 if arithmetic is None else system_of(arithmetic)
    except ValueError as error:
        raise SceneError("arithmetic", arithmetic, str(error)) from None
    made = plan(scene, asked, certified=certified, system=system, text=False)
    return Solution(run(made), scene)
