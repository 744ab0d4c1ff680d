"""Contact forces and positions for your own radii, as arrays."""

import math
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from decimal import Decimal
from fractions import Fraction
from numbers import Integral
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ..accuracy import CARRIED, Accuracy
from ..arithmetic.carried import bound_error
from ..arithmetic.decimals import Exact
from ..arithmetic.errors import ForceDiffusionError, checked
from ..arithmetic.systems import FLOAT64, Array
from ..disorder.radii import ArrayRadii
from ..lattice.layers import whole
from ..mechanics.loads import LoadSpec
from ..mechanics.physicality import Physicality
from ..mechanics.sweep import swept
from ..planning.planner import plan
from ..planning.sources import CLOSEST_UNIT, FARTHEST_UNIT
from ..scene.sections import GivenRadii, Load, Packing, SceneError, SurfaceLoad
from .running import read_tolerance, run
from .solution import Solution, in_shape, scene_of

# Beads that are solved at once, without a plan.
AT_ONCE = 2_000_000
# Changes below this are left to a plan, which has balls.
SMALL = 1e-140


def _directly(sections: Mapping[str, Any], mean: float) -> Solution | None:
    """Solve packings under loads on layers; None for what is out of the ordinary, or can't be.

    ``mean``: of what is given, radii or deviations.
    """
    packing, given, load = sections.values()
    d, values, r = packing.dimension, given.values, packing.radius
    shape, n_x, origin = values.shape, packing.n_x, r if given.delta_r is None else Fraction(0)
    layers, row = shape[-d], shape[-1] ** (d - 1)
    usual = all(CLOSEST_UNIT < x < FARTHEST_UNIT for x in (r, load.magnitude))
    apart = n_x > 1 / 2 and 2 * n_x**2 < 1 + 1 / d
    on_layers = load.kind in {"surface", "bulk"} and not load.angle_deg
    if not (usual and apart and on_layers and values.size <= AT_ONCE):
        return None
    if abs(mean - float(origin)) > float(r) / 2:
        return None
    region, spec = whole(row, layers - 1, d), LoadSpec(load.kind, layers - 1, row, dimension=d)
    radii = ArrayRadii(values.reshape(-1, layers, row), origin, r)
    packings, physical = range(len(radii.values)), Physicality()
    with FLOAT64.active():
        try:
            solved = swept(n_x, radii, spec, region, region.rows, packings, FLOAT64, carried=True)
        except ForceDiffusionError:
            return None
        physical.look_at(solved, packings)
        unseen = solved.sizes.unseen(layers - 1)[0]
        below = (*shape[:-d], d, layers - 1, *shape[1 - d :])
        change, ordered = solved.g.reshape(below), solved.F.reshape(below[-d - 1 :])
        largest = max(float(change.max()), -float(change.min()))
        _by_lower_bead(change, d)
        force = change + ordered  # of loads on layers, which are alike there
        if load.magnitude != 1:
            magnitude = FLOAT64.number(load.magnitude)
            change, force = change * magnitude, force * magnitude
    if not (largest > SMALL and solved.sizes.moved + unseen < math.inf):
        return None
    roundings = 1 if load.magnitude == 1 else 3
    bound = bound_error(roundings, unseen / largest)
    if physical.smallest_gap is not None:
        physical.smallest_gap *= float(r)
    accuracy = Accuracy(bound, False, FLOAT64.name, CARRIED)
    return Solution(sections, force, change, accuracy, physical)


def _by_lower_bead(values: Array, d: int) -> None:
    """Put what lies by the upper beads of contacts, (…, d, layers, W), by their lower ones."""
    if d == 2:  # (i + 1, j + 1) is of the same column where j is even, (i − 1, j + 1) where odd
        odd, even = values[..., 0, 1::2, :], values[..., 1, 0::2, :]
        odd[...] = np.concatenate((odd[..., 1:], odd[..., :1]), -1)
        even[...] = np.concatenate((even[..., -1:], even[..., :-1]), -1)
    else:
        first, second = values[..., 0, :, :, :], values[..., 1, :, :, :]
        first[...], second[...] = np.roll(first, -1, -2), np.roll(second, -1, -1)


@contextmanager
def _named_as_here() -> Iterator[None]:
    """Name arguments of ``solve`` in errors, and not the keys of a scene that they become."""
    try:
        yield
    except SceneError as error:
        section, _, name = error.key.rpartition(".")
        name = error.key if section == "load" else name
        raise type(error)(name, error.value, error.allowed) from None


def _dimension_of(given: GivenRadii, asked: Any) -> int:
    """Give the dimension of a packing, which shapes tell, but for that of a stack of squares."""
    shape = given.values.shape
    if asked is not None and not (isinstance(asked, Integral) and int(asked) in {2, 3}):
        raise SceneError("dimension", asked, "must be 2, of discs, or 3, of spheres")
    if asked is None and len(shape) == 3 and shape[1] == shape[2]:
        count, side = shape[:2]
        raise given.wrong(
            given.name,
            f"shape {shape}: say dimension=3 if it is one packing of spheres in {count} layers of "
            f"{side} × {side}, or dimension=2 if it is {count} packings of discs in {side} layers "
            f"of {side}",
        )
    dimension = int(asked or (3 if len(shape) == 4 else 2))
    beads, form = ("discs", "(layers, W)") if dimension == 2 else ("spheres", "(layers, W, W)")
    if len(shape) not in {dimension, dimension + 1} or len(set(shape[1 - dimension :])) > 1:
        allowed = f"shape {shape}: {beads} take {form}, with an axis before it for several packings"
        raise given.wrong(given.name, allowed)
    return dimension


@checked
@_named_as_here()
def solve(
    radii: ArrayLike | None = None,
    *,
    delta_r: ArrayLike | None = None,
    radius: float | Fraction | Decimal | None = None,
    spacing: float | Fraction | Decimal | None = None,
    load: Load | None = None,
    dimension: int | None = None,
    tolerance: Exact | None = None,
    certified: bool = False,
    allow_images: bool = False,
) -> Solution:
    """Solve periodic packings of given radii exactly: contact forces, positions and their errors.

    Args:
        radii: array of shape (M + 1, W), layer 0 the base; (N, M + 1, W) for N packings. For
            spheres (M + 1, W, W) or (N, M + 1, W, W), where [j, p, q] is bead (p, q, j).
        delta_r: deviations from ``radius``, instead of ``radii``; the same shapes.
        radius: r, the radius of the ordered packing, in the same unit; by default the mean of
            ``radii`` (over all N packings, so give it to compare a packing of a batch with the same
            one alone), or 1 with ``delta_r``.
        spacing: s, the distance between neighbours in the base, 2 r < s < 2√3 r (for spheres
            2 r < s < √(32/3) r); by default 3 r.
        load: ``SurfaceLoad()`` by default, ``BulkLoad()``, ``PointLoad(at=(k, l))`` or, for
            spheres, ``PointLoad(at=(p, q, l))``.
        dimension: 2 for discs, 3 for spheres; needed only for an array of shape (N, W, W), which
            could be either.
        tolerance: the largest error allowed, relative to the largest change; balls are used if
            float64 doesn't meet it.
        certified: accept only a rigorous bound; needs a tolerance.
        allow_images: allow W ≤ M, so that a bead may bear on another both directly and around
            the period; otherwise such an array, which may be transposed, is refused.

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
    given = GivenRadii(radii=radii) if delta_r is None else GivenRadii(delta_r=delta_r)
    if load is not None and not isinstance(load, Load):
        allowed = "must be SurfaceLoad(), BulkLoad(), PointLoad(at=(k, l)) or Load(kind=…)"
        raise SceneError("load", load, allowed)
    dimension = _dimension_of(given, dimension)
    shape = given.values.shape
    *batch, layers = shape[: 1 - dimension]
    if layers < 2:
        raise given.wrong(given.name, f"shape {shape}: a packing has at least 2 layers")
    if shape[-1] < layers and not allow_images:
        beads = " × ".join(map(str, shape[1 - dimension :]))
        turned = "swapaxes(-1, -2)" if batch else "T"
        remedy = (
            f"if transposed, give {given.name}.{turned}; " if dimension == 2 <= shape[-1] else ""
        )
        raise given.wrong(
            given.name,
            f"shape {shape}: {layers} layers of {beads} beads would bear on their "
            f"own images; {remedy}if you want that, say allow_images=True",
        )
    mean = float(given.values.mean())
    if radius is None:
        if delta_r is None and mean <= 0:
            raise SceneError("radii", None, f"must be positive; their mean is {mean:.6g}")
        radius = Fraction(mean) if delta_r is None else 1
    packing = Packing(
        height=layers - 1,
        width=shape[-1],
        dimension=dimension,
        radius=radius,
        spacing=spacing,
        allow_images=allow_images,
    )
    load = SurfaceLoad() if load is None else load
    sections: dict[str, Any] = {"packing": packing, "disorder": given, "load": load}
    if tolerance is None and not certified and (found := _directly(sections, mean)) is not None:
        return found
    scene = scene_of(sections)
    asked = None if tolerance is None else read_tolerance(tolerance)
    forces = run(plan(scene, asked, certified=certified, text=False))
    below = (*batch, layers - 1, *shape[1 - dimension :], dimension)
    force, change = (
        np.moveaxis(in_shape(forces, name, below), -1, -dimension - 1)
        for name in ("force", "change")
    )
    solution = Solution(sections, force, change, forces.accuracy, forces.physical)
    vars(solution).update(scene=scene, plan=forces.plan, forces=forces)
    return solution
