"""Answers: the numbers that a quantity consists of, gathered from solved realisations.

A table has index columns (sites, branches, realisations) and number columns in the arithmetic of
the run. Its ``small`` columns are the deviations from the ordered packing: accuracy is judged by
their error, relative to the largest of them.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import numpy as np
from force_diffusion.numeric import closed_forms
from force_diffusion.numeric.arithmetic.decimals import decimal_string
from force_diffusion.numeric.arithmetic.systems import NumberSystem, array
from force_diffusion.numeric.disorder.radii import DrawnRadii
from force_diffusion.numeric.lattice.layers import Array, Layer, pick
from force_diffusion.numeric.mechanics import plain
from force_diffusion.numeric.mechanics.engine import Solved
from force_diffusion.numeric.mechanics.forces import Forces
from force_diffusion.numeric.planning.plan import Plan
from force_diffusion.numeric.statistics.moments import Moments, unit_near


@dataclass(frozen=True)
class Table:
    """Rows of an answer, column by column; all columns have the same length."""

    index: dict[str, list[Any]]
    numbers: dict[str, Array]
    small: tuple[str, ...]


class Gatherer:
    """Collects realisations of one quantity; ``table`` gives what was found."""

    def __init__(self, plan: Plan, system: NumberSystem) -> None:
        """Start empty."""
        self.plan, self.system = plan, system
        self.parts: list[Table] = []

    def add(self, solved: Solved, realisations: Sequence[int]) -> None:
        """Take in solved realisations (in a batch, the first axis of the arrays)."""
        for number, realisation in enumerate(realisations):
            index = None if len(realisations) == 1 else number
            part = self._one(solved, index)
            if self.plan.realisations > 1:
                rows = len(next(iter(part.numbers.values()), []))
                part.index["realisation"] = [realisation] * rows
            self.parts.append(part)

    def table(self) -> Table:
        """Put the realisations below each other."""
        first = self.parts[0]
        return Table(
            {k: [v for part in self.parts for v in part.index[k]] for k in first.index},
            {k: np.concatenate([part.numbers[k] for part in self.parts]) for k in first.numbers},
            first.small,
        )

    def _one(self, solved: Solved, number: int | None) -> Table:
        raise NotImplementedError

    def _unit(self) -> float:
        return unit_near(self.plan.radii.relative_std())

    def _home(self, i: int) -> int:
        width = self.plan.scene.packing.width
        return i if width is None else i % (2 * width)


def _of(values: Array, number: int | None) -> Array:
    return values if number is None else values[number]


def _both(forces: Forces, j: int, number: int | None) -> list[tuple[str, int, Array, Array]]:
    """(branch, step to the lower bead, F, g) of the contacts below row j."""
    return [
        ("+", -1, forces.ordered_plus[j], _of(forces.change_plus[j], number)),
        ("-", +1, forces.ordered_minus[j], _of(forces.change_minus[j], number)),
    ]


class Contact(Gatherer):
    """One contact force."""

    def _one(self, solved: Solved, number: int | None) -> Table:
        i, j, branch = self.plan.scene.contact
        if solved.single is not None:
            force, change = solved.single
            force = force + change
        elif solved.forces is not None and len(_below(solved.forces, j + 1)[0]):
            plus = branch == "+"
            F = _below(solved.forces, j + 1)[0 if plus else 1]
            g = solved.forces.change_plus if plus else solved.forces.change_minus
            change = _of(g[j + 1], number)[0]
            force = F[0] + change
        else:  # stopped at tension above it
            return self._named([], [], [])
        return self._named([(self._home(i), j, branch)], [force], [change])

    def _named(
        self, contacts: list[tuple[int, int, str]], force: list[Any], change: list[Any]
    ) -> Table:
        return Table(
            {name: [c[k] for c in contacts] for k, name in enumerate(("i", "j", "branch"))},
            {"force": _column(force, self.system), "change": _column(change, self.system)},
            ("change",),
        )


def _below(forces: Forces, j: int) -> tuple[Array, Array]:
    return forces.ordered_plus[j], forces.ordered_minus[j]


def _column(values: Sequence[Any], system: NumberSystem) -> Array:
    column = np.empty(len(values), dtype=system.dtype)
    for q, value in enumerate(values):
        column[q] = value
    return column


class ContactForces(Gatherer):
    """All contact forces; of a periodic packing also those that no load reaches, exactly zero."""

    def _one(self, solved: Solved, number: int | None) -> Table:
        forces = solved.forces
        assert forces is not None
        width = self.plan.scene.packing.width
        i: list[int] = []
        j: list[int] = []
        branches: list[str] = []
        columns: list[tuple[Array, Array]] = []
        last = self.plan.scene.packing.height if width is not None else len(forces.rows) - 1
        lowest = 0 if forces.stopped is None else forces.stopped[1]
        zero = array(self.system, [Fraction(0)])[0]
        for upper in range(lowest + 1, last + 1):
            everything = None if width is None else Layer(upper, upper % 2, width)
            for branch, step in (("+", -1), ("-", 1)):
                if upper < len(forces.rows):
                    layer = forces.rows[upper]
                    F, g = next(
                        (F, g) for b, _, F, g in _both(forces, upper, number) if b == branch
                    )
                else:
                    layer = Layer(upper, upper % 2, 0)
                    F = g = array(self.system, [])
                if everything is not None and layer.count < everything.count:
                    F = pick(F, layer, everything, width, zero)
                    g = pick(g, layer, everything, width, zero)
                    layer = everything
                i += [self._home(site + step) for site in layer.sites()]
                j += [upper - 1] * layer.count
                branches += [branch] * layer.count
                columns.append((F + g, g))
        empty = array(self.system, [])
        return Table(
            {"i": i, "j": j, "branch": branches},
            {
                "force": np.concatenate([empty, *(c[0] for c in columns)]),
                "change": np.concatenate([empty, *(c[1] for c in columns)]),
            },
            ("change",),
        )


class Positions(Gatherer):
    """Bead positions, in the scene's unit of length."""

    def _one(self, solved: Solved, number: int | None) -> Table:
        scene, system = self.plan.scene, self.system
        nx, ny = plain.axes(scene.n_x, system)
        r = system.number(scene.packing.radius)
        if scene.ask.at is not None:
            i, j = scene.site
            rows = [Layer(j, i, 1)]
        else:
            rows = list(self.plan.region.rows)
        index: dict[str, list[Any]] = {"i": [], "j": []}
        columns: dict[str, list[Array]] = {"x": [], "y": [], "dx": [], "dy": []}
        for layer in rows:
            cp, cm = self._line_sums(solved, layer, number)
            sites = list(layer.sites())
            dx, dy = (cp - cm) / (2 * nx) * r, (cp + cm) / (2 * ny) * r
            index["i"] += [self._home(i) for i in sites]
            index["j"] += [layer.j] * len(sites)
            columns["x"].append(array(system, [i * scene.spacing / 2 for i in sites]) + dx)
            columns["y"].append(dy + 2 * layer.j * (ny * r))
            columns["dx"].append(dx)
            columns["dy"].append(dy)
        return Table(index, {k: np.concatenate(v) for k, v in columns.items()}, ("dx", "dy"))

    def _line_sums(self, solved: Solved, layer: Layer, number: int | None) -> tuple[Array, Array]:
        if solved.single is not None:
            return _column([solved.single[0]], self.system), _column(
                [solved.single[1]], self.system
            )
        if solved.packing is None:
            nothing = array(self.system, [Fraction(0)] * layer.count)
            return nothing, nothing
        source = solved.packing.region.rows[layer.j]
        width = solved.packing.region.width
        cp, cm = solved.packing.c_plus[layer.j], solved.packing.c_minus[layer.j]
        return (
            pick(_of(cp, number), source, layer, width),
            pick(_of(cm, number), source, layer, width),
        )


class BaseReactions(Gatherer):
    """The force with which the base holds each of its beads, own load included."""

    def _one(self, solved: Solved, number: int | None) -> Table:
        scene, system = self.plan.scene, self.system
        nx, ny = plain.axes(scene.n_x, system)
        strength = self.plan.load.strength(scene.n_x, system)
        width = scene.packing.width
        rows = self.plan.force_rows
        layer = rows[0]
        if width is not None:
            layer = Layer(0, 0, width)
        forces = solved.forces
        if forces is not None and forces.stopped is not None and forces.stopped[1]:
            layer = Layer(0, 0, 0)  # the sweep did not come down to the base
        own = self.plan.load.on((layer,), strength, system)
        zero = array(system, [Fraction(0)] * layer.count)
        plus = zero if own.plus[0] is None else own.plus[0]
        minus = zero if own.minus[0] is None else own.minus[0]
        change_plus, change_minus = zero, zero
        if forces is not None and len(rows) > 1 and layer.count:
            F, g, a, b = self._above(solved, layer, number)
            plus, minus = plus + F["+"], minus + F["-"]
            # to first order, a change of the force times one of its direction is left out
            f = F if self.plan.route == "first-order" else {s: F[s] + g[s] for s in "+-"}
            change_plus = g["+"] + (f["+"] * a["+"] + f["-"] * a["-"])
            change_minus = g["-"] + (f["+"] * b["+"] + f["-"] * b["-"])
        cx, cy = (change_plus - change_minus) * nx, (change_plus + change_minus) * ny
        return Table(
            {"i": [self._home(i) for i in layer.sites()], "j": [0] * layer.count},
            {
                "fx": (plus - minus) * nx + cx,
                "fy": (plus + minus) * ny + cy,
                "change_x": cx,
                "change_y": cy,
            },
            ("change_x", "change_y"),
        )

    def _above(
        self, solved: Solved, layer: Layer, number: int | None
    ) -> tuple[dict[str, Array], ...]:
        """F, g and the components of δn of the two contacts above each base bead."""
        forces, system = solved.forces, self.system
        assert forces is not None
        width = self.plan.scene.packing.width
        zero = array(system, [Fraction(0)])[0]
        F, g, a, b = {}, {}, {}, {}
        for branch, step in (("+", 1), ("-", -1)):
            at = Layer(1, layer.first + step, layer.count)
            for name, _, ordered, change in _both(forces, 1, number):
                if name == branch:
                    F[branch] = pick(ordered, forces.rows[1], at, width, zero)
                    g[branch] = pick(change, forces.rows[1], at, width, zero)
            if solved.packing is None:
                a[branch] = b[branch] = array(system, [Fraction(0)] * layer.count)
                continue
            source = solved.packing.region.rows[1]
            dn = solved.packing.plus[1] if branch == "+" else solved.packing.minus[1]
            a[branch], b[branch] = (pick(_of(v, number), source, at, width, zero) for v in dn)
        return F, g, a, b


class Profile(Gatherer):
    """Mean force, mean and standard deviation of its change, by layer and branch.

    Under a surface or bulk load all ordered forces of a layer are equal, and the standard deviation
    of the change is that of the force, σ_f.
    """

    def __init__(self, plan: Plan, system: NumberSystem) -> None:
        """Start empty."""
        super().__init__(plan, system)
        self.moments: dict[tuple[int, str], tuple[Any, Moments]] = {}

    def add(self, solved: Solved, realisations: Sequence[int]) -> None:
        """Merge the changes of the contacts; ordered forces only enter the mean."""
        forces = solved.forces
        assert forces is not None
        width = self.plan.scene.packing.width
        assert width is not None
        zero = array(self.system, [Fraction(0)])[0]
        for upper in range(1, self.plan.scene.packing.height + 1):
            if forces.stopped is not None and upper <= forces.stopped[1]:
                continue
            for branch in "+-":
                F, g = self._whole(forces, upper, branch, width, zero)
                ordered, moments = self.moments.get((upper, branch), (None, Moments(self._unit())))
                if ordered is None:
                    # under a surface or bulk load F is one number, which a sum would round
                    ordered = F[0] if self.plan.load.loaded is None else F.sum() / len(F)
                moments.add(g.reshape(-1))
                self.moments[upper, branch] = (ordered, moments)

    def _whole(
        self, forces: Forces, upper: int, branch: str, width: int, zero: Any
    ) -> tuple[Array, Array]:
        everything = Layer(upper, upper % 2, width)
        if upper >= len(forces.rows):
            nothing = array(self.system, [Fraction(0)] * width)
            return nothing, nothing
        F, g = (
            (forces.ordered_plus, forces.change_plus)
            if branch == "+"
            else (forces.ordered_minus, forces.change_minus)
        )
        layer = forces.rows[upper]
        return (
            pick(F[upper], layer, everything, width, zero),
            pick(g[upper], layer, everything, width, zero),
        )

    def table(self) -> Table:
        """One row a layer and branch, base first."""
        keys = sorted(self.moments)
        ordered = [self.moments[key][0] for key in keys]
        mean = [self.moments[key][1].average().item() for key in keys]
        std = [self.moments[key][1].std(self.system).item() for key in keys]
        count = [self.moments[key][1].count for key in keys]
        index: dict[str, list[Any]] = {
            "j": [j - 1 for j, _ in keys],
            "branch": [branch for _, branch in keys],
            "samples": count,
        }
        if self.theory_applies():
            index["first_order_std"] = [
                self._theory(j - 1, float(mean)) for (j, _), mean in zip(keys, ordered, strict=True)
            ]
        return Table(
            index,
            {
                "mean": _column([a + b for a, b in zip(ordered, mean, strict=True)], self.system),
                "mean_change": _column(mean, self.system),
                "std": _column(std, self.system),
            },
            ("mean_change", "std"),
        )

    def theory_applies(self) -> bool:
        """Say whether Eqs. 13 and 14 at finite M hold for the packings of this plan."""
        plan = self.plan
        width, height = plan.scene.packing.width, plan.scene.packing.height
        return (
            plan.route != "ordered"
            and plan.load.loaded is None
            and not plan.load.angle_deg
            and isinstance(plan.radii, DrawnRadii)
            and width is not None
            and width > height
        )

    def _theory(self, j: int, ordered: float) -> str:
        """Print √(exact first-order variance), Eqs. 13 and 14 at finite M."""
        plan = self.plan
        bulk = plan.load.kind == "bulk"
        variance = closed_forms.bulk_variance if bulk else closed_forms.surface_variance
        phi = 1 - 2 * plan.scene.n_x**2
        factor = float(variance(plan.scene.packing.height, j, phi, 1, 1))
        std, size = plan.radii.relative_std(), math.sqrt(factor) * ordered
        if std > Fraction(1, 10**290):
            return f"{size * float(std):.12g}"
        value = Fraction(size) * std  # a float would round it to zero
        return decimal_string(value, abs(value) / 10**12)


class Response(Gatherer):
    """The contacts within a point load's cone: one packing, or mean and std over realisations.

    ``vertical`` is the vertical component of the contact force, f N_y.
    """

    def __init__(self, plan: Plan, system: NumberSystem) -> None:
        """Start empty."""
        super().__init__(plan, system)
        self.moments = Moments(self._unit())
        self.last: Table | None = None
        self.ordered: tuple[Array, Array] = (array(system, []), array(system, []))

    def add(self, solved: Solved, realisations: Sequence[int]) -> None:
        """Take in realisations."""
        for number in range(len(realisations)):
            table = self._one(solved, None if len(realisations) == 1 else number)
            self.last = table
            if self.plan.realisations > 1:
                both = [table.numbers["change"], table.numbers["vertical_change"]]
                self.moments.add(np.stack([np.concatenate(both)]))

    def _one(self, solved: Solved, number: int | None) -> Table:
        forces, system = solved.forces, self.system
        assert forces is not None
        ny = plain.axes(self.plan.scene.n_x, system)[1]
        index: dict[str, list[Any]] = {"i": [], "j": [], "branch": []}
        parts: list[tuple[Array, ...]] = []
        lowest = 0 if forces.stopped is None else forces.stopped[1]
        for upper in range(lowest + 1, len(forces.rows)):
            layer = forces.rows[upper]
            for branch, step, F, g in _both(forces, upper, number):
                tilt = array(system, [Fraction(0)] * layer.count)
                if solved.packing is not None:
                    dn = solved.packing.plus if branch == "+" else solved.packing.minus
                    source = solved.packing.region.rows[upper]
                    width = solved.packing.region.width
                    a, b = (pick(_of(v, number), source, layer, width) for v in dn[upper])
                    tilt = a + b
                f = F + (g if self.plan.route == "exact" else 0)
                vertical_change = (g + f * tilt) * ny
                index["i"] += [self._home(i + step) for i in layer.sites()]
                index["j"] += [upper - 1] * layer.count
                index["branch"] += [branch] * layer.count
                parts.append((F + g, g, F * ny + vertical_change, vertical_change, F))
        nothing = array(system, [])
        columns = [np.concatenate([nothing, *(part[k] for part in parts)]) for k in range(5)]
        self.ordered = (columns[4], columns[4] * ny)
        names = ("force", "change", "vertical", "vertical_change")
        return Table(index, dict(zip(names, columns, strict=False)), ("change", "vertical_change"))

    def table(self) -> Table:
        """One row a contact."""
        assert self.last is not None
        if self.plan.realisations == 1:
            return self.last
        half = len(self.last.index["i"])
        mean, std = self.moments.average(), self.moments.std(self.system)
        return Table(
            self.last.index,
            {
                "force_mean": self.ordered[0] + mean[:half],
                "force_mean_change": mean[:half],
                "force_std": std[:half],
                "vertical_mean": self.ordered[1] + mean[half:],
                "vertical_mean_change": mean[half:],
                "vertical_std": std[half:],
            },
            ("force_mean_change", "force_std", "vertical_mean_change", "vertical_std"),
        )


class Changes(Gatherer):
    """All changes of contact forces, for a histogram."""

    def _one(self, solved: Solved, number: int | None) -> Table:
        if self.plan.single_contact:
            return Contact(self.plan, self.system)._one(solved, number)
        forces = solved.forces
        assert forces is not None
        parts = [g for j in range(1, len(forces.rows)) for _, _, _, g in _both(forces, j, number)]
        nothing = array(self.system, [])
        return Table({}, {"change": np.concatenate([nothing, *parts])}, ("change",))


GATHERERS: dict[str, Callable[[Plan, NumberSystem], Gatherer]] = {
    "contact": Contact,
    "contact_forces": ContactForces,
    "positions": Positions,
    "base_reactions": BaseReactions,
    "profile": Profile,
    "response": Response,
    "histogram": Changes,
}
