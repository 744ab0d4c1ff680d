"""Beads and contacts of solved packings as arrays, and as files for other programs."""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..arithmetic.systems import Array, as_floats


@dataclass(frozen=True, eq=False)
class Beads:
    """All beads, layer by layer from the base up; for N packings there is a first axis of length N.

    Attributes:
        positions: centres, (beads, 2), for spheres (beads, 3); in the unit of the radii.
        radii: (beads,).
        layers: j, (beads,).
    """

    positions: Array
    radii: Array
    layers: Array

    def __repr__(self) -> str:
        return f"<{len(self.layers)} beads in {self.layers[-1] + 1} layers>"


@dataclass(frozen=True, eq=False)
class Contacts:
    """All n contacts, sorted by layer and column of the lower bead, then by branch.

    For N packings all but ``pairs``, ``branch`` and ``wraps`` have a first axis of length N.
    Points, normals and force vectors are float64.

    Attributes:
        pairs: numbers of the lower and the upper bead, (n, 2): their rows in ``beads``.
        branch: "+" or "-", for spheres "1", "2" or "3", (n,).
        wraps: whether the contact crosses the seam of the periodic packing, (n,). Its upper bead is
            then the image beside the lower one.
        force: positive if it pushes, (n,).
        change: the force minus that of the ordered packing, (n,).
        points: where the beads touch, (n, 2), for spheres (n, 3).
        normals: unit vectors from the lower to the upper bead, (n, 2) or (n, 3).
        force_vector: the force on the upper bead, (n, 2) or (n, 3).
        ends: centres of both beads, (n, 2, 2) or (n, 2, 3).
    """

    pairs: Array
    branch: Array
    wraps: Array
    force: Array
    change: Array
    points: Array
    normals: Array
    force_vector: Array
    ends: Array

    def __repr__(self) -> str:
        return f"<{len(self.pairs)} contacts, {int(self.wraps.sum())} of them across the seam>"

    def of(self, packing: int) -> "Contacts":
        """The contacts of one of several packings."""
        if self.force.ndim == 1:
            return self
        shared = {"pairs", "branch", "wraps"}
        values = vars(self).items()
        return Contacts(**{name: v if name in shared else v[packing] for name, v in values})


def vtk(beads: Array, radii: Array, contacts: Contacts) -> str:
    """Legacy VTK of the contacts of one packing: lines between centres, with forces.

    The points are the beads, followed by the images across the seam at which contacts end.
    """
    ends = contacts.pairs.copy()
    images = np.flatnonzero(contacts.wraps)
    ends[images, 1] = len(beads) + np.arange(len(images))
    points = _three(np.concatenate([beads, contacts.ends[images, 1]]))
    radii = np.concatenate([radii, radii[contacts.pairs[images, 1]]])
    n, (_, branch) = len(ends), np.unique(contacts.branch, return_inverse=True)
    columns = {
        "force double": as_floats(contacts.force),
        "change double": as_floats(contacts.change),
        "wraps int": contacts.wraps.astype(int),
        "branch int": branch,
    }
    return "\n".join(
        [
            "# vtk DataFile Version 3.0",
            "force-diffusion: contacts of a packing",
            "ASCII",
            "DATASET POLYDATA",
            f"POINTS {len(points)} double",
            *map(_words, points.tolist()),
            f"LINES {n} {3 * n}",
            *(f"2 {a} {b}" for a, b in ends.tolist()),
            f"POINT_DATA {len(points)}",
            *_scalars("radius double", radii),
            f"CELL_DATA {n}",
            *(line for name, column in columns.items() for line in _scalars(name, column)),
            "VECTORS force_vector double",
            *map(_words, _three(contacts.force_vector).tolist()),
            "",
        ]
    )


def dump_local(contacts: Contacts, box: list[str]) -> str:
    """LAMMPS's format *dump local*: a line per contact, with the numbers of its beads, from 1."""
    pairs, vectors = contacts.pairs + 1, _three(contacts.force_vector)
    rows = zip(pairs.tolist(), as_floats(contacts.force).tolist(), vectors.tolist(), strict=True)
    header = _header("ENTRIES", len(pairs), box, "index batom1 batom2 force fx fy fz")
    lines = (_words([k, *pair, force, *v]) for k, (pair, force, v) in enumerate(rows, 1))
    return "\n".join([*header, *lines, ""])


def dump(beads: Array, radii: Array, box: list[str]) -> str:
    """LAMMPS's format *dump*: a line per bead, with its number, from 1."""
    header = _header("ATOMS", len(beads), box, "id type x y z radius")
    rows = zip(_three(beads).tolist(), radii.tolist(), strict=True)
    return "\n".join([*header, *(_words([k, 1, *x, r]) for k, (x, r) in enumerate(rows, 1)), ""])


def box_of(beads: Array, radii: Array, period: float) -> list[str]:
    """Bounds of a packing for LAMMPS: periodic across, open upwards; for spheres the box leans."""
    low, high = (beads[:, -1] - radii).min(), (beads[:, -1] + radii).max()
    largest = float(radii.max())
    if beads.shape[1] == 2:
        bounds = [[0, period], [low, high], [-largest, largest]]
        return ["pp ff pp", *(_words(map(float, pair)) for pair in bounds)]
    lean, deep = period / 2, period * 3**0.5 / 2
    leaning = [[0, period + lean, lean], [0, deep, 0], [low, high, 0]]
    return ["xy xz yz pp pp ff", *(_words(map(float, three)) for three in leaning)]


def _header(item: str, count: int, box: list[str], columns: str) -> list[str]:
    kinds, *bounds = box
    return [
        "ITEM: TIMESTEP",
        "0",
        f"ITEM: NUMBER OF {item}",
        str(count),
        f"ITEM: BOX BOUNDS {kinds}",
        *bounds,
        f"ITEM: {item} {columns}",
    ]


def _scalars(name: str, values: Array) -> list[str]:
    return [f"SCALARS {name} 1", "LOOKUP_TABLE default", *map(repr, values.tolist())]


def _three(vectors: Array) -> Array:
    """Vectors of the plane with a third component, 0."""
    return np.pad(vectors, ((0, 0), (0, 3 - vectors.shape[1])))


def _words(values: Iterable[Any]) -> str:
    return " ".join(map(repr, values))
