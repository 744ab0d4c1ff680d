"""Solved packings as arrays, drawings and files."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from numbers import Integral, Real
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from ..accuracy import Accuracy
from ..arithmetic.errors import WrongTypeError, checked, quoted
from ..arithmetic.machine import write_whole
from ..arithmetic.systems import Array, as_floats
from ..lattice.branch import axis_names, bead_names, directions
from ..lattice.layers import contacts_of, whole
from ..mechanics.physicality import Physicality
from ..mechanics.problem import Route
from ..planning.plan import Plan
from ..planning.planner import plan
from ..quantities.contact_forces import steps_up
from ..scene.combinations import either
from ..scene.sections import Ask, SceneError
from ..tables import Tabled
from .contacts import Beads, Contacts, box_of, dump, dump_local, vtk
from .outcome import Outcome
from .running import Scene, run

if TYPE_CHECKING:
    from matplotlib.axes import Axes


@dataclass(frozen=True, eq=False, repr=False)
class Solution(Tabled):
    """Periodic packings on an ordered base, solved exactly; shapes are for a single packing.

    For a batch of N packings all arrays have a first axis of length N. M layers of W beads lie
    above the base. Bead (j, q) is the paper's (i, j) with i = 2q + j mod 2. Forces have the unit of
    the load's magnitude, lengths that of the radii.

    A layer of spheres holds W × W beads: shapes then have p and q instead of the column, and three
    axes instead of two branches.

    Numbers are float64 or, if a tolerance needs more, balls: numbers of any length, each with a
    rigorous error. ``print`` shows only a few digits of a ball. ``.astype(float)`` rounds an array;
    ``forces.decimals()`` and ``positions.decimals()`` give all known digits.

    Attributes:
        force: f^±_ij, shape (2, M, W): branch (0: "+", 1: "-"), layer j and column q of the lower
            bead. Compressive forces are positive. For spheres (3, M, W, W): axis, layer j, p and q.
        change: each force minus its value in the ordered packing, computed without cancellation.
        accuracy: the error of the forces, relative to the largest change; certified or estimated.
        physical: overlaps and tensile contacts, over all packings; None if all radii are equal.
            ``physical.smallest_gap`` is in the unit of the radii.
    """

    sections: Mapping[str, Any]
    force: Array
    change: Array
    accuracy: Accuracy
    physical: Physicality | None

    @cached_property
    def scene(self) -> Scene:
        """The same packing as a scene."""
        return scene_of(self.sections)

    @cached_property
    def plan(self) -> Plan:
        """How the forces are computed: method and expected error."""
        return plan(self.scene, text=False)

    @cached_property
    def forces(self) -> Outcome:
        """The forces as an ``Outcome``, with rows and decimals; made when first asked for."""
        return run(self.plan)

    @property
    def sees_images(self) -> bool:
        """Whether some bead bears on another both directly and around the period."""
        return self.plan.sees_images

    @property
    def position(self) -> Array:
        """Bead centres, (M + 1, W, 2): layer, column, (x, y); for spheres (M + 1, W, W, 3)."""
        return self._beads("")

    @property
    def displacement(self) -> Array:
        """Bead centres minus those of the ordered packing (Eqs. 1 to 3), of the same shape."""
        return self._beads("d")

    @cached_property
    def beads(self) -> Beads:
        """All beads, as arrays with a row for each: positions, radii and layers."""
        d, given, shape = self._dimension, self.sections["disorder"], self._shape
        radii = given.values
        if given.delta_r is not None:
            radii = radii + float(self.scene.packing.radius)
        lead, layers = shape[:-d], np.arange(shape[-d])
        return Beads(
            self.position.reshape(*lead, -1, d),
            radii.reshape(*lead, -1),
            np.repeat(layers, math.prod(shape[1 - d :])),
        )

    @cached_property
    def contacts(self) -> Contacts:
        """All contacts, as arrays with a row for each; ``pairs`` holds row numbers of ``beads``.

        >>> import force_diffusion as fd
        >>> radii = 1 + 1e-3 * np.random.default_rng(1).uniform(-1, 1, (5, 12))
        >>> solution = fd.solve(radii)
        >>> solution.contacts
        <96 contacts, 4 of them across the seam>
        >>> lower, upper = solution.contacts.pairs.T
        >>> solution.contacts.points.shape, solution.beads.layers[upper].min()
        ((96, 2), np.int64(1))
        """
        d, problem, beads = self._dimension, self.plan.problem, self.beads
        lead = self._shape[:-d]
        region = whole(math.prod(self._shape[1 - d :]), problem.height, d)
        pairs, number, wraps = contacts_of(region)
        lower, upper = pairs.T
        straight = float(self.scene.packing.radius) * steps_up(problem)
        moved = as_floats(self.displacement).reshape(*lead, -1, d)
        first = as_floats(beads.positions)[..., lower, :]
        apart = straight[number] + (moved[..., upper, :] - moved[..., lower, :])
        own, other = beads.radii[..., lower, None], beads.radii[..., upper, None]
        normals = apart / (own + other)
        force, change = (
            np.moveaxis(values, -d - 1, -1).reshape(*lead, -1)
            for values in (self.force, self.change)
        )
        return Contacts(
            pairs=pairs,
            branch=np.array(directions(d))[number],
            wraps=wraps,
            force=force,
            change=change,
            points=first + own * normals,
            normals=normals,
            force_vector=as_floats(force)[..., None] * normals,
            ends=np.stack([first, first + apart], axis=-2),
        )

    @property
    def arrays(self) -> dict[str, Array]:
        """The columns of a table of contacts: those of ``contact_forces``, and both radii."""
        d, contacts, beads = self._dimension, self.contacts, self.beads
        lower, upper = contacts.pairs.T
        j, *columns = np.unravel_index(lower, self._shape[-d:])
        if d == 2:
            columns[0] = 2 * columns[0] + j % 2
        packings = math.prod(self._shape[:-d])
        named = dict(zip(bead_names(d), [*columns, j], strict=True)) | {"branch": contacts.branch}
        named |= {"lower": lower, "upper": upper, "wraps": contacts.wraps}
        table = {name: np.tile(column, packings) for name, column in named.items()}
        if len(self._shape) > d:
            table["realisation"] = np.repeat(np.arange(packings), len(lower))
        ends = contacts.ends.reshape(-1, 2, d)
        for k, (before, bead) in enumerate((("", lower), ("upper_", upper))):
            table |= {before + a: ends[:, k, x] for x, a in enumerate(axis_names(d))}
            table[before + "radius"] = beads.radii[..., bead].reshape(-1)
        return table | {"force": contacts.force.reshape(-1), "change": contacts.change.reshape(-1)}

    @checked
    def plot(
        self,
        ax: Axes | None = None,
        *,
        color: str | ArrayLike | None = None,
        least: float = 0,
        packing: int = 0,
    ) -> Axes:
        """Draw force chains: a line for each contact, as thick as its force; lengths in units of r.

        Args:
            ax: matplotlib axes to draw on; by default those of a new figure, which is the
                ``.figure`` of the axes that are returned.
            color: a column of ``contacts`` that colours the lines, "force", "change", "branch" or
                "wraps", or an array of your own, (n,). By default contacts that pull stand out.
            least: the smallest force that is drawn, pushing or pulling.
            packing: the number of the packing in a batch.

        Raises:
            SceneError: there is no such column or packing, the beads are spheres, or no contact
                bears as much as ``least``.
            WrongTypeError: ``ax`` is not an axes of matplotlib.
            MissingLibraryError: matplotlib is missing.
        """
        from ..figures.answers import contacts_of

        if self._dimension > 2:
            raise SceneError("plot", None, "spheres can't be drawn in the plane: use .to_vtk(path)")
        if ax is not None and not hasattr(ax, "add_collection"):
            raise WrongTypeError(f"ax must be axes of matplotlib, not {quoted(ax)}")
        at, r = self._packing(packing), float(self.scene.packing.radius)
        if not isinstance(least, Real):
            raise SceneError("least", least, "must be a number")
        contacts = self.contacts.of(at)
        beads = as_floats(self.position).reshape(-1, *self._shape[-2:], 2)
        forces = as_floats(contacts.force)
        some, largest = np.abs(forces) >= least, np.abs(forces).max()
        if not some.any():
            raise SceneError("least", least, f"no contact bears more than {largest:.3g}")
        values = None if color is None else _colours(contacts, color)[some]
        return contacts_of(
            self.plan,
            contacts.ends[some] / r,
            forces[some],
            beads[at, -1] / r,
            axes=ax,
            values=values,
            label=color if isinstance(color, str) else "",
        )

    def to_vtk(self, path: str | Path, *, packing: int = 0) -> None:
        """Write the contacts of one packing as lines for ParaView: legacy VTK, with their forces.

        Lengths and forces are those of ``contacts``; each point has a ``radius``.
        """
        _write(path, vtk(*self._places(packing), self.contacts.of(packing)))

    def to_dump(self, path: str | Path, *, packing: int = 0) -> None:
        """Write the beads of one packing as a *dump* of LAMMPS, which OVITO opens."""
        places = self._places(packing)
        _write(path, dump(*places, box_of(*places, self._period)))

    def to_dump_local(self, path: str | Path, *, packing: int = 0) -> None:
        """Write the contacts of one packing as a *dump local* of LAMMPS, a line for each.

        ``batom1`` and ``batom2`` are the lower and the upper bead, numbered from 1 as in
        ``to_dump``. In OVITO open the beads, then load this file by the modifier *Load trajectory*.
        """
        box = box_of(*self._places(packing), self._period)
        _write(path, dump_local(self.contacts.of(packing), box))

    def _packing(self, number: int) -> int:
        """The number of a packing. Raises ``SceneError``."""
        count = math.prod(self._shape[: -self._dimension])
        if not isinstance(number, Integral) or not 0 <= number < count:
            raise SceneError("packing", number, f"must be a whole number from 0 to {count - 1}")
        return int(number)

    def _places(self, packing: int) -> tuple[Array, Array]:
        """Centres and radii of one packing. Raises ``SceneError``."""
        at, beads = self._packing(packing), self.beads
        count = len(beads.layers)
        positions = as_floats(beads.positions).reshape(-1, count, self._dimension)
        return positions[at], beads.radii.reshape(-1, count)[at]

    @property
    def _period(self) -> float:
        return self._shape[-1] * float(self.scene.packing.s)

    @property
    def error(self) -> float:
        """Bound or estimate of the largest error of a change, relative to the largest change."""
        return float(self.accuracy.error_bound)

    @property
    def certified(self) -> bool:
        """Whether ``error`` is a rigorous bound, and not an estimate."""
        return self.accuracy.certified

    @cached_property
    def positions(self) -> Outcome:
        """The positions as an ``Outcome``, with their ``accuracy``; made when first asked for."""
        scene, tolerance = self.scene.asking(quantity="positions"), self.plan.tolerance
        certified = tolerance is not None and self.plan.certified
        return run(plan(scene, tolerance, certified=certified, text=False))

    @property
    def _dimension(self) -> int:
        return int(self.sections["packing"].dimension)

    @property
    def _shape(self) -> tuple[int, ...]:
        """(…, M + 1, W), or of spheres (…, M + 1, W, W)."""
        return tuple(self.sections["disorder"].values.shape)

    def _beads(self, kind: str) -> Array:
        names = [kind + axis for axis in axis_names(self._dimension)]
        return np.stack([in_shape(self.positions, name, self._shape) for name in names], axis=-1)

    def __str__(self) -> str:
        """Say what was found, how accurately, and what was done for it."""
        return str(self.forces)

    def __repr__(self) -> str:
        """Say which packing it is, whether beads could make it, and the error, on one line."""
        d, physical = self._dimension, self.physical
        *batch, layers = self._shape[: 1 - d]
        across = " × ".join(map(str, self._shape[1 - d :]))
        several = f"{batch[0]} packings: " if batch else ""
        verdict = "all radii are equal"
        if physical is not None:
            pulls = f"{physical.tensile} of {physical.contacts} contacts are tensile"
            overlaps = f"{physical.overlaps} overlaps, " if physical.overlaps else ""
            verdict = "physical" if physical.sound else f"NOT physical: {overlaps}{pulls}"
        known = "certified" if self.certified else "estimated"
        beads = f"{layers} layers of {across} {'discs' if d == 2 else 'spheres'}"
        return f"<{several}{beads}; {verdict}; error {self.error:.2g} ({known})>"


def _write(path: str | Path, text: str) -> None:
    """Write a file. Raises ``SceneError`` where there is no such folder, or it is not ours."""
    try:
        write_whole(Path(path), text.encode())
    except OSError as error:
        raise SceneError("path", str(path), f"can't be written ({error.strerror})") from None


def _colours(contacts: Contacts, color: Any) -> Array:
    """A column of contacts, or numbers of one's own, as numbers. Raises ``SceneError``."""
    names = ("force", "change", "branch", "wraps")
    if isinstance(color, str):
        if color not in names:
            raise SceneError("color", color, f"must be {either(names)}, or an array of numbers")
        values = getattr(contacts, color)
        return np.unique(values, return_inverse=True)[1] if color == "branch" else as_floats(values)
    values = np.asarray(color)
    if values.shape != contacts.branch.shape or values.dtype.kind not in "biuf":
        allowed = f"must hold a number for each of the {len(contacts.pairs)} contacts"
        raise SceneError("color", None, allowed)
    return values


def in_shape(outcome: Outcome, name: str, shape: tuple[int, ...]) -> Array:
    """Give a column in shape; of equal radii, which are solved once, in balls, as asked for."""
    values, plan = outcome.arrays[name], outcome.plan
    if plan.problem.route == Route.ORDERED:
        values = np.tile(values, math.prod(shape) // len(values))
        values = values if plan.tolerance is not None else as_floats(values)
    return values.reshape(shape)


def scene_of(sections: Mapping[str, Any]) -> Scene:
    """Give the scene that asks for all contact forces of all packings that are given."""
    values, d = sections["disorder"].values, sections["packing"].dimension
    packings = len(values) if values.ndim > d else 1
    return Scene(**sections, ask=Ask(quantity="contact_forces", realisations=packings))
