"""Radii measured in an image: a lattice is fitted, and beads are assigned to its sites."""

import math
from dataclasses import dataclass
from numbers import Real
from pathlib import Path

import numpy as np
from scipy.sparse import csr_array
from scipy.sparse.csgraph import breadth_first_order
from scipy.spatial import cKDTree

from ..arithmetic.errors import WrongTypeError, checked, quoted
from ..arithmetic.systems import Array
from .files import TableError, numbers_of, rows_of_table
from .sections import SceneError

TOUCHING = 1.25  # distance of neighbours over both radii, at most
LEVEL = math.radians(15)  # between neighbours of a layer; contacts are steeper
OFF = 0.5  # r: farther from its site no bead is placed


@dataclass(frozen=True, eq=False)
class ImageRadii:
    """Radii of a packing in an image, for ``solve(image.radii, spacing=image.spacing)``.

    Attributes:
        radii: (M + 1, W), layer 0 the base, in units of length.
        spacing: s, in units of length.
        origin: bead (0, 0) of the lattice, in pixels.
        rotation: of the layers in the image, in degrees.
        scale: pixels per unit of length.
        residual: root mean square distance of the centres from the lattice, over the mean radius.
    """

    radii: Array
    spacing: float
    origin: tuple[float, float]
    rotation: float
    scale: float
    residual: float

    def __repr__(self) -> str:
        layers, width = self.radii.shape
        x, y = self.origin
        return (
            f"<{layers} layers of {width} beads, mean radius {self.radii.mean():.6g}, spacing "
            f"{self.spacing:.6g}; origin ({x:.6g}, {y:.6g}), rotation {self.rotation:.4g}°, "
            f"{self.scale:.6g} pixels per unit; centres lie {self.residual:.2g} r from the lattice>"
        )


@checked
def read_radii(
    path: str | Path,
    *,
    spacing: float | None = None,
    scale: float | None = None,
    rotation: float | None = None,
    origin: tuple[float, float] | None = None,
    y_down: bool = True,
) -> ImageRadii:
    """Read centres and radii of beads in an image, and assign the beads to sites of the lattice.

    Whatever is not given of the lattice is fitted to the centres by least squares. Beads get their
    sites one after another, from neighbour to neighbour.

    Args:
        path: a table with columns ``x``, ``y`` and ``r`` or ``radius``, in pixels; other columns
            are ignored. Commas, semicolons or tabs separate them.
        spacing: s in units of length, which sets the scale.
        scale: pixels per unit of length; 1 if neither is given.
        rotation: of the layers, in degrees anticlockwise; only rotations below 15° are fitted.
        origin: where bead (0, 0) of the ordered packing is, (x, y) in pixels.
        y_down: whether y points downwards, as it does in most images.

    Raises:
        TableError: the file can't be read, a bead fits no site, or a site has no bead or two.
        SceneError: an argument is not allowed.

    >>> import tempfile
    >>> base, surface = [(10, 90), (40, 90), (70, 90)], [(25, 76.77), (55, 76.77), (85, 76.77)]
    >>> table = "x;y;radius\\n" + "".join(f"{x};{y};10\\n" for x, y in base + surface)
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     _ = Path(folder, "beads.csv").write_text(table)
    ...     image = read_radii(Path(folder, "beads.csv"), spacing=3)
    >>> image.radii.round(3).tolist(), round(image.scale, 3), round(image.residual, 3)
    ([[1.0, 1.0, 1.0], [1.0, 1.0, 1.0]], 10.0, 0.0)
    """
    if not isinstance(path, str | Path):
        raise WrongTypeError(f"read_radii takes the path of a file, not {quoted(path)}")
    numbers = (("spacing", spacing, 0), ("scale", scale, 0), ("rotation", rotation, -180))
    for name, value, least in numbers:
        if value is not None and not (isinstance(value, Real) and least < value < math.inf):
            raise SceneError(name, value, f"must be a number above {least}")
    given = np.array(origin, dtype=object).ravel()
    corner = [float(c) for c in given if isinstance(c, Real) and math.isfinite(c)]
    if origin is not None and not len(corner) == len(given) == 2:
        raise SceneError("origin", origin, "must be two numbers, x and y")
    wheres, table = [], []
    for where, header, row in rows_of_table("radii", Path(path), ["x", "y", "r"]):
        wheres.append(where)
        table.append([float(number) for number in numbers_of(where, header, row)])
    if len(table) < 4:
        raise TableError(f"radii: {Path(path).name}: a packing has at least 4 beads")
    x, y, pixels = np.array(table).T
    if not pixels.min() > 0:
        raise TableError(f"{wheres[int(pixels.argmin())]}: r must be positive")
    upwards = -1 if y_down else 1
    places, r = x + upwards * 1j * y, float(pixels.mean())
    turn = np.exp(1j * math.radians(rotation or 0))
    i, j = _placed(places / turn, pixels, wheres)
    known = None if spacing is None or scale is None else float(spacing * scale)
    fixed = turn if rotation is not None else None
    start = complex(corner[0], upwards * corner[1]) if corner else None
    s, ahead, start, sites = _fitted(places, i, j, r, known, fixed, start, Path(path).name)
    off = np.abs(places - start - ahead * sites) / r
    worst = int(off.argmax())
    if off[worst] > OFF:
        raise TableError(
            f"{wheres[worst]}: the bead lies {off[worst]:.2g} r from site ({i[worst]}, {j[worst]}) "
            f"of the lattice, and {OFF} r is allowed"
        )
    unit = scale if scale is not None else s / spacing if spacing is not None else 1.0
    return ImageRadii(
        radii=_grid(i, j, pixels / unit, wheres),
        spacing=float(s / unit),
        origin=(float(start.real), float(upwards * start.imag)),
        rotation=math.degrees(float(np.angle(ahead))),
        scale=float(unit),
        residual=float(np.sqrt((off**2).mean())),
    )


def _fitted(
    places: Array,
    i: Array,
    j: Array,
    r: float,
    known: float | None,
    turn: complex | None,
    start: complex | None,
    name: str,
) -> tuple[float, complex, complex, Array]:
    """Fit s, the direction of layers, bead (0, 0) and the lattice, by least squares; or keep them.

    Raises ``TableError``.
    """
    coordinates = np.stack([np.ones(len(i)), i, j], axis=1)
    s = known or 2 * float(abs(np.linalg.lstsq(coordinates, places)[0][1]))
    for _ in range(4):  # the height of a layer depends on s
        if not 2 * r < s < 2 * math.sqrt(3) * r:
            raise TableError(
                f"radii: {name}: neighbours of a layer are {s / r:.4g} r apart, and 2 r to 3.46 r "
                "are possible: are x, y and r in the same unit, and are layers not turned by more "
                "than 15° (rotation=…)?"
            )
        sites = s / 2 * i + 2j * math.sqrt(r**2 - s**2 / 16) * j
        centre, middle = (places.mean(), sites.mean()) if start is None else (start, 0)
        lattice = sites - middle
        ahead = complex((lattice.conj() * (places - centre)).sum() / (np.abs(lattice) ** 2).sum())
        if turn is not None:
            ahead = (ahead / turn).real * turn
        s *= 1 if known else abs(ahead)
        ahead /= abs(ahead)
    return s, ahead, complex((places - ahead * sites).mean() if start is None else start), sites


def _placed(places: Array, pixels: Array, wheres: list[str]) -> tuple[Array, Array]:
    """Name each bead (i, j), going from neighbour to neighbour. Raises ``TableError``."""
    tree = cKDTree(np.stack([places.real, places.imag], axis=1))
    pairs = tree.query_pairs(2 * TOUCHING * pixels.max(), output_type="ndarray")
    apart = places[pairs[:, 1]] - places[pairs[:, 0]]
    near = np.abs(apart) <= TOUCHING * pixels[pairs].sum(axis=1)
    pairs, apart = pairs[near], apart[near]
    across, up = np.sign(apart.real), np.sign(apart.imag)
    level = np.abs(apart.imag) < math.tan(LEVEL) * np.abs(apart.real)
    steep = np.abs(apart.real) < math.tan(LEVEL) * np.abs(apart.imag)
    across, up = np.where(level, 2 * across, across * ~steep), np.where(steep, 2 * up, up * ~level)
    steps = np.stack([across, up], axis=1).astype(np.int64)
    step_of = {}
    for (a, b), step in zip(pairs.tolist(), steps, strict=True):
        step_of[a, b], step_of[b, a] = step, -step
    graph = csr_array((np.ones(len(pairs)), pairs.T), (len(wheres), len(wheres)))
    reached, before = breadth_first_order(graph, 0, directed=False)
    names = np.zeros((len(wheres), 2), dtype=np.int64)
    for b in reached[1:].tolist():
        names[b] = names[before[b]] + step_of[before[b], b]
    if len(reached) < len(wheres):
        alone = np.setdiff1d(np.arange(len(wheres)), reached)[0]
        raise TableError(f"{wheres[alone]}: the bead touches none of those above it in the table")
    wrong = (names[pairs[:, 1]] - names[pairs[:, 0]] != steps).any(axis=1)
    if wrong.any():
        a, b = pairs[wrong][0]
        raise TableError(
            f"{wheres[b]}: the bead fits no site beside that of {wheres[a].rpartition(', ')[2]}: "
            "is one missing, or are layers turned by more than 15° (rotation=…)?"
        )
    i, j = names.T
    j = j - j.min()
    return i - i[j == 0].min(), j


def _grid(i: Array, j: Array, radii: Array, wheres: list[str]) -> Array:
    """Radii by layer and column of a periodic packing, (M + 1, W). Raises ``TableError``."""
    width, layers = int((j == 0).sum()), int(j.max()) + 1
    column = (i - j % 2) // 2 % width
    grid, owner = np.zeros((layers, width)), np.full((layers, width), -1)
    for k, at in enumerate(zip(j.tolist(), column.tolist(), strict=True)):
        if owner[at] >= 0:
            raise TableError(
                f"{wheres[k]}: the bead has the site ({i[k]}, {j[k]}) of that of "
                f"{wheres[owner[at]].rpartition(', ')[2]}, in layers of {width} beads as the base"
            )
        owner[at], grid[at] = k, radii[k]
    if (owner < 0).any():
        layer, q = np.argwhere(owner < 0)[0]
        table = wheres[0].partition(", line")[0]
        raise TableError(
            f"{table}: bead ({2 * q + layer % 2}, {layer}) is missing: each layer needs the "
            f"{width} beads of the base"
        )
    return grid
