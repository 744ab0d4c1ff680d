"""What is measured of each packing of an ensemble: changes of contact forces, in groups.

A group holds contacts that are alike: a layer and branch of a profile, or one contact. The changes
are those of the engine in float64, and each depends on the scene and the realisation alone.
"""

import math
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import Any

import numpy as np
from force_diffusion.numeric import closed_forms
from force_diffusion.numeric.arithmetic.systems import FLOAT64
from force_diffusion.numeric.disorder.radii import DrawnRadii
from force_diffusion.numeric.lattice.layers import Array, Layer, pick
from force_diffusion.numeric.mechanics import plain
from force_diffusion.numeric.mechanics.engine import Solved
from force_diffusion.numeric.planning.planner import Plan
from force_diffusion.numeric.statistics.moments import unit_near


@dataclass(frozen=True)
class Measurement:
    """What is measured, and how it is summed up; ``plan`` has one realisation.

    ``edges`` are those of the bins, float64; ``covariance`` asks for that of the groups.
    """

    plan: Plan
    edges: tuple[float, ...]
    covariance: bool

    @property
    def quantity(self) -> str:
        """What the scene asks."""
        return self.plan.scene.ask.quantity

    @cached_property
    def unit(self) -> int:
        """The power of two in which means of single packings are rounded (σ/r is near it)."""
        return math.frexp(unit_near(self.plan.radii.relative_std()))[1] - 1

    @cached_property
    def _rows(self) -> list[tuple[int, str, Layer]]:
        """(upper layer, branch, row of upper beads) in the order of the groups or contacts."""
        rows = self.plan.force_rows
        if self.quantity == "profile":
            width, height = self.plan.scene.packing.width, self.plan.scene.packing.height
            assert width is not None
            layers = [Layer(j, j % 2, width) for j in range(1, height + 1)]
        else:
            layers = [row for row in rows[1:] if row.count]
        return [(row.j, branch, row) for row in layers for branch in "+-"]

    @cached_property
    def labels(self) -> dict[str, list[Any]]:
        """Columns that name the groups, each of length ``groups``."""
        if self.quantity == "profile":
            return {
                "j": [j - 1 for j, _, _ in self._rows],
                "branch": [branch for _, branch, _ in self._rows],
            }
        if self.plan.single_contact:
            i, j, branch = self.plan.scene.contact
            return {"i": [i], "j": [j], "branch": [branch]}
        if self.quantity == "histogram":
            return {}
        width = self.plan.scene.packing.width
        period = None if width is None else 2 * width
        contacts = [
            (i if period is None else i % period, j - 1, branch)
            for j, branch, row in self._rows
            for i in (site + (-1 if branch == "+" else 1) for site in row.sites())
        ]
        names = ("i", "j", "branch")
        labels: dict[str, list[Any]] = {n: [c[k] for c in contacts] for k, n in enumerate(names)}
        if self.quantity == "response":
            labels = {name: 2 * column for name, column in labels.items()}
            labels["component"] = ["force"] * len(contacts) + ["vertical"] * len(contacts)
        return labels

    @cached_property
    def groups(self) -> int:
        """How many groups there are."""
        return len(next(iter(self.labels.values()), [None]))

    @cached_property
    def members(self) -> int:
        """Contacts in a group."""
        if self.quantity == "profile":
            width = self.plan.scene.packing.width
            assert width is not None
            return width
        if self.quantity == "histogram" and not self.plan.single_contact:
            return sum(row.count for _, _, row in self._rows)
        return 1

    @property
    def variables(self) -> int:
        """Size of the covariance matrix."""
        return self.groups if self.covariance else 0

    def changes(self, solved: Solved, realisations: int) -> tuple[Array, Array]:
        """Give ordered forces (groups, 1 or members) and changes (groups, realisations, members).

        Of a response the second half of the groups is vertical: f N_y, its change likewise.
        """
        if self.plan.single_contact:
            return self._single(solved, realisations)
        forces = solved.forces
        assert forces is not None
        whole = self.quantity == "profile"
        ordered, parts = [], []
        for upper, branch, row in self._rows:
            plus = branch == "+"
            if upper >= len(forces.rows):  # above every load
                ordered.append(np.zeros(row.count))
                parts.append(np.zeros((realisations, row.count)))
                continue
            F = (forces.ordered_plus if plus else forces.ordered_minus)[upper]
            g = (forces.change_plus if plus else forces.change_minus)[upper]
            g = g.reshape(realisations, -1)
            if whole and forces.rows[upper] != row:
                width = row.count
                F = pick(F, forces.rows[upper], row, width, 0.0)
                g = pick(g, forces.rows[upper], row, width, 0.0)
            ordered.append(F)
            parts.append(g)
        if whole:
            return np.stack(ordered), np.stack(parts)
        F, g = np.concatenate(ordered), np.concatenate(parts, axis=1)
        if self.quantity == "histogram":
            return F[None], g[None]
        if self.quantity == "response":
            vertical = self._vertical(solved, F, g)
            F = np.concatenate([F, F * self._ny])
            g = np.concatenate([g, vertical], axis=1)
        return F[:, None], g.T[:, :, None]

    def _single(self, solved: Solved, realisations: int) -> tuple[Array, Array]:
        _, j, branch = self.plan.scene.contact
        if solved.single is not None:  # line sums
            force, change = solved.single
            return np.array([[force]]), np.array([[[change]]])
        forces = solved.forces
        assert forces is not None
        plus = branch == "+"
        F = (forces.ordered_plus if plus else forces.ordered_minus)[j + 1]
        g = (forces.change_plus if plus else forces.change_minus)[j + 1]
        return F[:1, None], g.reshape(realisations, -1)[None, :, :1]

    @cached_property
    def _ny(self) -> float:
        return float(plain.axes(self.plan.scene.n_x, FLOAT64)[1])

    def _vertical(self, solved: Solved, F: Array, g: Array) -> Array:
        """Change of the vertical components f N_y; shape of ``g``."""
        packing = solved.packing
        assert packing is not None
        tilts = []
        for upper, branch, row in self._rows:
            a, b = (packing.plus if branch == "+" else packing.minus)[upper]
            source, width = packing.region.rows[upper], packing.region.width
            tilts.append(pick(a, source, row, width) + pick(b, source, row, width))
        tilt = np.concatenate([t.reshape(len(g), -1) for t in tilts], axis=1)
        force = F + (g if self.plan.route == "exact" else 0)
        return np.asarray((g + force * tilt) * self._ny)

    def ordered(self) -> list[Fraction]:
        """Give the ordered force of each group (of a group whose forces differ, their mean)."""
        load, rows = self.plan.load, self.plan.force_rows
        strength = load.strength(self.plan.scene.n_x, FLOAT64)
        if self.plan.single_contact:
            force = load.ordered_force(self.plan.scene.contact, strength, FLOAT64)
            return [Fraction(float(force))]
        forces = load.ordered_forces(rows, strength, FLOAT64)
        of = {"+": forces.ordered_plus, "-": forces.ordered_minus}
        found = [
            [Fraction(float(F)) for F in of[branch][upper]] if upper < len(rows) else []
            for upper, branch, _ in self._rows
        ]
        if self.quantity == "profile":
            return [sum(row, Fraction(0)) / self.members for row in found]
        single = [force for row in found for force in row]
        if self.quantity == "histogram":
            return [sum(single, Fraction(0)) / len(single)]
        if self.quantity == "response":
            single += [force * Fraction(self._ny) for force in single]
        return single

    def theory(self) -> list[Fraction] | None:
        """Give σ_f of layers j = 0 … M − 1, exact to first order (Eqs. 13 and 14 at finite M).

        None where they don't apply. Each is a float64 times the exact σ/r.
        """
        p, radii = self.plan, self.plan.radii
        width, height = p.scene.packing.width, p.scene.packing.height
        if (
            not isinstance(radii, DrawnRadii)
            or p.load.loaded is not None
            or p.load.angle_deg
            or not (width is None or width > height)
        ):
            return None
        variance = (
            closed_forms.bulk_variance if p.load.kind == "bulk" else closed_forms.surface_variance
        )
        phi, strength = float(1 - 2 * p.scene.n_x**2), p.load.strength(p.scene.n_x, FLOAT64)
        found = []
        for j in range(height):
            force = float(p.load.ordered_force((j % 2, j, "+"), strength, FLOAT64))
            root = math.sqrt(float(variance(height, j, phi, 1, 1)))
            found.append(Fraction(root * force) * radii.std)
        return found
