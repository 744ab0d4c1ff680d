"""A check of packings that shares nothing with what found them: no solver, no lattice, no module.

A file holds radii, loads, centres and contacts. Where contacts aren't closed to rounding, the
centres are improved by Newton's steps, in balls. By Krawczyk's operator, with an inverse whose norm
a factorisation of AᵀA bounds, an exact packing is then shown to touch at these contacts within a
distance ρ of the centres in the file; its forces are enclosed and shown to be positive, and all
other gaps too, those between beads of the base included. No other bead bears a load, radii are
positive, and no bead lies below the base.
Then the packing is a strict local minimum of the load's energy in the coordinates of the beads
that contacts hold. Of all others it is shown that they touch nothing, and not how far they could
go. A contact that bears no force, and beads that touch without one, can't be proved: no enclosure
tells zero from what is next to it. All pairs of beads are looked at, one by one; with a period
above four radii one image of each is enough.
"""

import json
from collections.abc import Callable
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Annotated, Any, Literal

import flint
import numpy as np
from pydantic import BaseModel, ConfigDict, Field, ValidationError
from scipy.sparse import csc_array, diags_array, eye_array
from scipy.sparse.linalg import splu

from ..arithmetic.errors import ForceDiffusionError, rule
from ..arithmetic.foreign import ForeignFileError, opened
from ..arithmetic.systems import in_flint

BITS = 256
LARGEST = 1e100  # of all numbers: beyond, products of floats end
LARGEST_FILE = 100_000_000
OPEN = 1e-5  # of gaps of contacts: no inverse of a Jacobian has a norm below a quarter
CLOSED = 1e-12  # of gaps of contacts: up to here centres are improved by Newton's steps
FAR = 1e-6  # of an exact packing, from the centres of the file
UNPROVABLE = "(of beads that touch without force nothing can be proved)"
Number = Annotated[str, Field(pattern=r"^-?[0-9]{1,400}(\.[0-9]{1,400})?(e-?[0-9]{1,4})?$")]
Bead = Annotated[int, Field(ge=0)]


class PackingFileError(ForceDiffusionError, ValueError):
    """A file of packings is not one."""


class _Packing(BaseModel):
    """Beads by number; the first ``fixed`` are the base. Numbers are exact decimals, as text."""

    model_config = ConfigDict(extra="forbid", strict=True)
    period: Number
    fixed: Annotated[int, Field(ge=1)]
    radii: Annotated[list[Number], Field(min_length=2, max_length=40_000)]
    loads: list[Annotated[list[Number], Field(min_length=2, max_length=2)]]
    centres: list[Annotated[list[Number], Field(min_length=2, max_length=2)]]
    contacts: list[Annotated[list[Bead], Field(min_length=2, max_length=2)]]


class _File(BaseModel):
    model_config = ConfigDict(extra="forbid", strict=True)
    format: Literal["force-diffusion packings 1"]
    packings: Annotated[list[_Packing], Field(min_length=1)]


@dataclass(frozen=True)
class Verdict:
    """What was found of one packing.

    ``proved`` says that it is a strict local minimum in the coordinates of the beads that contacts
    hold. ``within``: ρ, in units of the file; ``smallest_force`` and ``smallest_gap``: certified
    lower bounds; ``rattlers``: beads without contacts, whose places are some of many.
    """

    proved: bool
    why: str
    contacts: int
    rattlers: int
    within: float | None = None
    smallest_force: float | None = None
    smallest_gap: float | None = None

    def data(self) -> dict[str, Any]:
        """Give what JSON can hold."""
        return asdict(self)

    def __str__(self) -> str:
        """Say it in a line."""
        if not self.proved:
            return f"NOT proved: {self.why}"
        return (
            f"proved: an exact packing within {self.within:.2g} of these centres is a strict local "
            f"minimum in the coordinates of beads that contacts hold; {self.contacts} contacts, "
            f"all forces above {self.smallest_force:.3g}, all other gaps above "
            f"{self.smallest_gap:.3g}; {self.rattlers} rattlers, whose places are some of many"
        )


def _wrong(error: ValidationError) -> str:
    """Say in a line what of a file is wrong first."""
    first = error.errors()[0]
    words = {"model_type": "must be an object, {…}", "missing": "is missing"}
    wrong = words.get(first["type"]) or rule(error)
    return f"{'.'.join(map(str, first['loc'])) or 'all of it'} {wrong}"


def check_packings(path: str | Path) -> list[Verdict]:
    """Check the packings of a file that ``run --out`` wrote.

    Raises ``PackingFileError``.
    """
    path = Path(path)
    if path.is_dir():
        raise PackingFileError(f"{path}: is a folder; give a packings.json in it")
    try:
        with opened(path, LARGEST_FILE) as file:
            content = file.read(LARGEST_FILE)
    except ForeignFileError as error:
        raise PackingFileError(f"{path}: {error}") from None
    try:
        found = _File.model_validate(json.loads(content))
    except (ValueError, RecursionError) as error:
        what = "no JSON"
        if isinstance(error, ValidationError):
            what = _wrong(error)
        raise PackingFileError(
            f"{path.name}: no file of packings, as run --out writes: {what}"
        ) from None
    with in_flint(prec=BITS):
        return [_checked(packing, path.name) for packing in found.packings]


def _checked(packing: _Packing, name: str) -> Verdict:
    beads = len(packing.radii)
    if not len(packing.loads) == len(packing.centres) == beads > packing.fixed:
        raise PackingFileError(f"{name}: radii, loads and centres must be equally many")
    highest = max((bead for pair in packing.contacts for bead in pair), default=0)
    if highest >= beads:
        raise PackingFileError(f"{name}: contacts name bead {highest} of {beads}")
    contacts = np.array(packing.contacts, dtype=np.int64).reshape(-1, 2)
    if len({frozenset(pair) for pair in packing.contacts}) < len(contacts):
        raise PackingFileError(f"{name}: a contact stands there twice")
    free = sorted({int(b) for b in contacts.ravel() if b >= packing.fixed})
    rattlers = beads - packing.fixed - len(free)

    def no(why: str) -> Verdict:
        return Verdict(False, why, len(contacts), rattlers)

    if not free or len(contacts) != 2 * len(free):
        return no(f"{len(contacts)} contacts hold {len(free)} beads: twice as many are needed")
    if (contacts[:, 0] == contacts[:, 1]).any() or (contacts < packing.fixed).all(axis=1).any():
        return no("a contact joins a bead to itself, or two beads of the base")
    proof = _Proof(packing, contacts, free)
    wrong = proof.impossible()
    return no(wrong) if wrong else proof.verdict(no, rattlers)


class _Proof:
    def __init__(self, packing: _Packing, contacts: Any, free: list[int]) -> None:
        self.contacts, self.free = contacts, free
        self.fixed, self.period = packing.fixed, flint.arb(packing.period)
        self.radii = [flint.arb(r) for r in packing.radii]
        self.x = [[flint.arb(v) for v in centre] for centre in packing.centres]
        self.loads = [[flint.arb(v) for v in load] for load in packing.loads]
        self.column = {bead: 2 * k for k, bead in enumerate(free)}
        self.directions: list[tuple[Any, Any]] = []  # of the contacts, over the box looked at last

    def impossible(self) -> str:
        """Say why no equilibrium of these contacts can exist, or be shown to; empty if it may."""
        numbers = [self.period, *self.radii, *(v for pair in self.x + self.loads for v in pair)]
        if not all(abs(value) < LARGEST for value in numbers):
            return f"a number is not below {LARGEST:g}"
        for bead, radius in enumerate(self.radii):
            if not radius > 0:
                return f"the radius of bead {bead} is not positive"
            if not self.period > 4 * radius:
                return f"the period is not above 4 radii of bead {bead}: images may meet"
        for bead in range(self.fixed, len(self.radii)):
            if bead not in self.column and not all(load == 0 for load in self.loads[bead]):
                return f"bead {bead} bears a load, and no contact holds it"
        return ""

    def below(self, within: float) -> int | None:
        """Give a bead that is not shown to lie above the lowest one of the base, if any does."""
        lowest = min((self.x[bead][1] for bead in range(self.fixed)), key=float)
        spread = flint.arb(0, within)
        for bead in range(self.fixed, len(self.x)):
            if not self.x[bead][1] + spread > lowest:
                return bead
        return None

    def difference(self, a: int, b: int, spread: Any) -> tuple[Any, Any]:
        """Give x_a − x_b, nearest image, each coordinate of a free bead being off by ``spread``."""
        dx, dy = self.x[a][0] - self.x[b][0], self.x[a][1] - self.x[b][1]
        dx = dx - round(float(dx) / float(self.period)) * self.period
        width = spread * ((a in self.column) + (b in self.column))
        return dx + width, dy + width

    def gap(self, a: int, b: int) -> Any:
        """Give the gap at the centres."""
        dx, dy = self.difference(a, b, flint.arb(0))
        return (dx * dx + dy * dy).sqrt() - self.radii[a] - self.radii[b]

    def jacobian(self, spread: Any) -> tuple[Any, Any, list[Any]]:
        """Give the derivatives of the gaps over the box: rows, columns, and balls."""
        rows, columns, values = [], [], []
        self.directions = []
        for row, (a, b) in enumerate(self.contacts.tolist()):
            dx, dy = self.difference(a, b, spread)
            length = (dx * dx + dy * dy).sqrt()
            direction = dx / length, dy / length
            self.directions.append(direction)
            for bead, sign in ((a, 1), (b, -1)):
                if bead in self.column:
                    rows += [row, row]
                    columns += [self.column[bead], self.column[bead] + 1]
                    values += [sign * direction[0], sign * direction[1]]
        return rows, columns, values

    def verdict(self, no: Callable[[str], Verdict], rattlers: int) -> Verdict:
        """Prove, or say what fails."""
        gaps = [self.gap(a, b) for a, b in self.contacts.tolist()]
        worst = _largest(gaps)
        least, pair = self.smallest_gap()
        if worst > OPEN:
            return no(f"the contacts are open or overlap by up to {worst:.2g}")
        if not least > 0:  # so far contacts may be any; what touches and is apart has few factors
            return no(
                f"beads {pair[0]} and {pair[1]} overlap, or are not shown to be apart " + UNPROVABLE
            )
        n, moved, before = len(gaps), 0.0, np.inf
        while True:
            rows, columns, values = self.jacobian(flint.arb(0))
            middle = [float(value.mid()) for value in values]
            A = csc_array((middle, (rows, columns)), shape=(n, n))
            try:
                factors = splu(A)
            except RuntimeError:
                return no("the Jacobian of the gaps is singular: the packing is not rigid")
            if worst < CLOSED or not worst < before / 2:
                break
            newton = factors.solve(np.array([-float(gap.mid()) for gap in gaps]))
            moved, before = moved + float(abs(newton).max()) * (1 + 1e-9), worst
            if not moved < FAR:
                return no(f"the contacts are open or overlap by up to {worst:.2g}")
            self.move(newton)
            gaps = [self.gap(a, b) for a, b in self.contacts.tolist()]
            worst = _largest(gaps)
        if moved:
            least, pair = self.smallest_gap()
        sigma = _least_singular_value(A, factors)
        if not sigma > 0:
            return no("the Jacobian of the gaps is too near to a singular one")
        root = n**0.5 * (1 + 1e-9)  # of a vector: its length is at most this times its largest
        step = root * worst / sigma * (1 + 1e-9)  # at least |A⁻¹ g|
        if not moved + step < FAR:
            return no(f"the contacts are open or overlap by up to {worst:.2g}")
        within = 2 * step + 1e-60
        *_, values = self.jacobian(flint.arb(0, within))
        spread = [_upper(value - m) for value, m in zip(values, middle, strict=True)]
        change = float(np.linalg.norm(spread)) * (1 + 1e-9)  # of the Jacobian, over the box
        factor = root * change / sigma * (1 + 1e-9)
        if not (step + factor * within < within and change < sigma / 2):
            return no(f"Krawczyk's operator does not map the box into itself: {factor:.2g}")
        forces, error = self.forces(factors, root / (sigma - change) * (1 + 1e-9))
        smallest = float((forces * (1 - 1e-15) - error).min())  # they are rounded
        if not smallest > 0:
            k = int(np.argmin(forces))
            a, b = self.contacts[k]
            return no(
                f"the force between beads {a} and {b}, {forces[k]:.3g}, may not be positive "
                + UNPROVABLE
            )
        below = self.below(within)
        if below is not None:
            return no(f"bead {below} lies below the base, or is not shown to lie above it")
        gap = least - 3 * within
        if not gap > 0:
            return no(
                f"beads {pair[0]} and {pair[1]} overlap, or are not shown to be apart " + UNPROVABLE
            )
        return Verdict(True, "", n, rattlers, (moved + within) * (1 + 1e-9), smallest, gap)

    def move(self, step: Any) -> None:
        """Move the beads that contacts hold."""
        for bead, column in self.column.items():
            self.x[bead] = [(self.x[bead][k] + float(step[column + k])).mid() for k in (0, 1)]

    def forces(self, factors: Any, norm: float) -> tuple[Any, float]:
        """Give forces, and a bound on their error: the largest residual over the box times norm.

        They are corrected by what they leave, in balls, while that falls.
        """
        load = [v for bead in self.free for v in self.loads[bead]]
        forces = [flint.arb(0)] * len(load)
        rest, left, before = load, _largest(load), np.inf
        while left < before / 2:
            best, before = forces, left
            step = factors.solve(np.array([-float(v.mid()) for v in rest]), trans="T")
            forces = [(f + float(s)).mid() for f, s in zip(forces, step, strict=True)]
            rest = list(load)
            for (a, b), force, direction in zip(
                self.contacts.tolist(), forces, self.directions, strict=True
            ):
                for bead, sign in ((a, 1), (b, -1)):
                    if bead in self.column:
                        for k in (0, 1):
                            at = self.column[bead] + k
                            rest[at] = rest[at] + sign * force * direction[k]
            left = _largest(rest)
        if left < before:
            best, before = forces, left
        return np.array([float(f) for f in best]), norm * before * (1 + 1e-9)

    def smallest_gap(self) -> tuple[float, tuple[int, int]]:
        """Give the smallest gap at the centres, of all pairs that are no contacts, rounded down.

        Of nearest images: all others are half a period apart, or more, and so above two radii.
        """
        x = np.array([[float(v) for v in centre] for centre in self.x])
        r, period = np.array([float(v) for v in self.radii]), float(self.period)
        touching = {(min(p), max(p)) for p in self.contacts.tolist()}
        least, pair = np.inf, (0, 0)
        for a in range(len(x)):
            others = np.arange(a + 1, len(x))
            d = x[others] - x[a]
            d[:, 0] -= period * np.round(d[:, 0] / period)
            gaps = np.hypot(d[:, 0], d[:, 1]) - r[others] - r[a]
            for k in np.flatnonzero(gaps <= min(least, 1.0)):
                b = int(others[k])
                if (a, b) not in touching and gaps[k] < least:
                    least, pair = float(gaps[k]), (a, b)
        room = 1e-13 * (1 + float(np.abs(x).max()) + period)
        return float(min(least, 1.0)) - room, pair


def _least_singular_value(A: Any, factors: Any) -> float:
    """Bound A's smallest singular value from below; 0 where it is not shown to be above 1e-7 or so.

    AᵀA − s = B Bᵀ + E, whatever B is: no eigenvalue of AᵀA lies below s − ‖E‖.
    """
    n, unit = A.shape[0], 2.0**-53 * (1 + 1e-6)
    v = np.cos(np.arange(n))
    for _ in range(10):  # of the power method
        v = factors.solve(factors.solve(v / np.linalg.norm(v), trans="T"))
    s, ones = 0.5 / float(np.linalg.norm(v)), np.ones(n)
    terms = int(np.diff(A.indptr).max()) + 2
    own = terms * unit * (abs(A).T @ (abs(A) @ ones) + s)  # roundings of AᵀA − s, by row
    while s > own.max():
        shifted = (A.T @ A - s * eye_array(n)).tocsc()
        lu = splu(shifted, "MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
        if (pivots := lu.U.diagonal()).min() > 0:
            B = (lu.L @ diags_array(np.sqrt(pivots))).tocsr()[np.array(lu.perm_r)]
            E = abs(shifted - B @ B.T) @ ones * (1 + 1e-9) + own
            E += (np.diff(B.indptr) + 2) * unit * (abs(B) @ (abs(B).T @ ones))
            return float(np.sqrt(max(s - float(E.max()) * (1 + 1e-9), 0.0))) * (1 - 1e-9)
        s /= 4
    return 0.0


def _largest(balls: list[Any]) -> float:
    return max(_upper(ball) for ball in balls)


def _upper(ball: Any) -> float:
    """Round the largest size of a ball up; infinite where it is no number."""
    value = float(abs(ball).upper()) * (1 + 1e-12) + 1e-300
    return value if value < np.inf else np.inf
