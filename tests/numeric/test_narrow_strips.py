"""Every question about a periodic strip, seams and images included, against a small solver.

``tests.properties.packing`` solves all beads of the strip at 100 digits, and knows no regions.
The answers here are certified, so that an enclosure has to hold the true value.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from fractions import Fraction
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import flint
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import force_diffusion as fd
from tests.numeric.scenes import question
from tests.properties.packing import Packing, mp
from tests.properties.reading import Plane, place, steps_to

TINY = "1e-30"  # for slopes: the error, of third order, is a share 1e-60
ROOM = "1e-50"  # far above both and their roundings, far below what is asked for
TOLERANCE = 1e-25
GEOMETRIES = ("ordered", "first-order", "exact")


@dataclass(frozen=True)
class Drawn:
    """A strip, its load, and one contact; ``delta`` are δr in units of 2⁻¹⁴."""

    r: Fraction
    spacing: Fraction  # over r
    delta: np.ndarray
    kind: str
    angle: int
    loads: dict[tuple[int, int], tuple[int, int]]
    contact: tuple[int, int, str]

    @property
    def width(self) -> int:
        return self.delta.shape[1]

    @property
    def height(self) -> int:
        return self.delta.shape[0] - 1

    def outcome(self, geometry: str, quantity: str, at: list[Any] | None = None) -> fd.Outcome:
        with TemporaryDirectory() as folder:
            load: dict[str, Any] = {"kind": self.kind, "angle_deg": self.angle}
            if self.kind == "point":
                load["at"] = list(next(iter(self.loads)))
            elif self.kind == "file":
                rows = [f"{i},{j},{x},{y}" for (i, j), (x, y) in self.loads.items()]
                Path(folder, "loads.csv").write_text("\n".join(["i,j,fx,fy", *rows, ""]))
                load = {"kind": "file", "file": "loads.csv", "magnitude": 2}
            scene = question(
                quantity, self.height, self.width, radius=self.r, spacing=self.spacing * self.r,
                radii=fd.GivenRadii(delta_r=self.delta * 2.0**-14), load=fd.Load(**load),
                effects={"geometry": geometry}, at=at, folder=Path(folder),
            )  # fmt: skip
            return scene.run(TOLERANCE, certified=True)

    def strip(self, strength: Any) -> Plane:
        """The strip with deviations that are ``strength`` times as large."""
        n_x = number(self.spacing) / 4
        packing = Packing(1 - 2 * n_x**2, self.width, self.height, number(self.r))
        sites = [site for layer in range(self.height + 1) for site in packing.sites(layer)]
        change = {}
        for site in sites:
            i, j = place(site)
            delta = int(self.delta[j, i % (2 * self.width) // 2])
            change[site] = strength * delta / mp.mpf(2) ** 14
        turn = mp.radians(self.angle)
        unit = mp.sin(turn), -mp.cos(turn)
        top = self.height if self.kind == "surface" else 0
        loads = {site: unit for site in sites if sum(site) >= top}
        if self.kind in ("point", "file"):
            given = self.loads if self.kind == "file" else dict.fromkeys([*self.loads][:1], unit)
            loads = {packing.home(steps_to(*at)): load for at, load in given.items()}
        return Plane(replace(packing, change=change), loads)


def number(value: Fraction) -> Any:
    return mp.mpf(value.numerator) / value.denominator


def truth(drawn: Drawn, geometry: str, read: Callable[[Plane], list[Any]]) -> list[tuple[Any, Any]]:
    """(value, change) of what ``read`` takes from a strip, by one of the three theories."""
    ordered = read(drawn.strip(0))
    if geometry == "ordered":
        return [(value, mp.mpf(0)) for value in ordered]
    if geometry == "exact":
        pairs = [(value, value - still) for value, still in
                 zip(read(drawn.strip(1)), ordered, strict=True)]  # fmt: skip
    else:
        step = mp.mpf(TINY)
        ends = read(drawn.strip(step)), read(drawn.strip(-step))
        slopes = [(up - down) / (2 * step) for up, down in zip(*ends, strict=True)]
        pairs = [(still + slope, slope) for still, slope in zip(ordered, slopes, strict=True)]
    return pairs


def holds(enclosure: Any, value: Any) -> bool:
    with flint.ctx.workprec(400):
        near = flint.arb(f"{mp.nstr(value, 70)} +/- {ROOM}")
        narrow = enclosure.rad() < 1e-20 if isinstance(enclosure, flint.arb) else True
        return bool(narrow and flint.arb(enclosure).overlaps(near))


@st.composite
def strips(draw: st.DrawFn) -> Drawn:
    """Strips of one to five beads a layer; as high, and so often much higher than wide."""
    width, height = draw(st.integers(1, 5)), draw(st.integers(1, 5))
    count = width * (height + 1)
    delta = draw(st.lists(st.integers(-64, 64), min_size=count, max_size=count))
    beads = [(i, j) for j in range(height + 1) for i in range(j % 2, 2 * width, 2)]
    forces = st.tuples(st.integers(-3, 3), st.integers(-4, -1))
    kind = draw(st.sampled_from(["surface", "bulk", "file", "point", "point"]))
    loaded = beads[width:] if kind == "point" else beads
    j = draw(st.integers(0, height - 1))
    i = j % 2 + 2 * draw(st.integers(0, width - 1))
    return Drawn(
        draw(st.sampled_from([Fraction(1), Fraction(1, 2), Fraction(3)])),
        draw(st.sampled_from([Fraction(n, 10) for n in (21, 24, 30, 34)])),
        np.array(delta).reshape(height + 1, width),
        kind,
        draw(st.integers(-20, 20)),
        draw(st.dictionaries(st.sampled_from(loaded), forces, min_size=1, max_size=3)),
        (i, j, draw(st.sampled_from("+-"))),
    )


def force(strip: Plane, i: int, j: int, branch: str) -> Any:
    return strip.quantity("ForcePlus" if branch == "+" else "ForceMinus", i, j)


def direction(strip: Plane, i: int, j: int, branch: str) -> Any:
    return strip.packing.direction((steps_to(i, j), "+-".index(branch)))


def places(outcome: fd.Outcome, *names: str) -> list[tuple[Any, ...]]:
    return list(zip(*(outcome.arrays[name] for name in names), strict=True))


def enclosed(outcome: fd.Outcome, names: tuple[str, str], pairs: list[tuple[Any, Any]]) -> None:
    for enclosures, true in zip(places(outcome, *names), pairs, strict=True):
        assert all(holds(*pair) for pair in zip(enclosures, true, strict=True)), (names, true)


@pytest.mark.parametrize("geometry", GEOMETRIES)
@settings(max_examples=settings.default.max_examples // 2)
@given(strips())
def test_every_question_about_a_strip(geometry, drawn):
    beads = [(i, j) for j in range(drawn.height + 1) for i in range(j % 2, 2 * drawn.width, 2)]
    every = [(i, j, branch) for i, j in beads for branch in "+-" if j < drawn.height]

    def read(strip: Plane) -> list[Any]:
        """Take all forces, their vertical parts, and x and y of all beads."""
        forces = [force(strip, *at) for at in every]
        vertical = [f * direction(strip, *at)[1] for f, at in zip(forces, every, strict=True)]
        centres = [strip.packing.centre(steps_to(*bead)) for bead in beads]
        return [*forces, *vertical, *(centre[axis] for axis in (0, 1) for centre in centres)]

    pairs = truth(drawn, geometry, read)
    of_force = dict(zip(every, pairs, strict=False))
    of_vertical = dict(zip(every, pairs[len(every) :], strict=False))
    x, y = np.reshape(pairs[2 * len(every) :], (2, len(beads), 2)).tolist()

    contacts = drawn.outcome(geometry, "contact_forces")
    assert places(contacts, "i", "j", "branch") == every
    enclosed(contacts, ("force", "change"), [*of_force.values()])
    single = drawn.outcome(geometry, "contact", list(drawn.contact))
    enclosed(single, ("force", "change"), [of_force[drawn.contact]])

    profile, means = drawn.outcome(geometry, "profile"), []
    for layer in places(profile, "j", "branch"):
        alike = [value for at, value in of_force.items() if at[1:] == layer]
        means.append(tuple(mp.fsum(column) / drawn.width for column in zip(*alike, strict=True)))
    enclosed(profile, ("mean", "mean_change"), means)

    positions = drawn.outcome(geometry, "positions")
    assert places(positions, "i", "j") == beads
    bead = drawn.outcome(geometry, "positions", list(drawn.contact[:2]))
    place = beads.index(drawn.contact[:2])
    for names, true in ((("x", "dx"), x), (("y", "dy"), y)):
        enclosed(positions, names, true)
        enclosed(bead, names, [true[place]])

    if drawn.kind == "point":
        response = drawn.outcome(geometry, "response")
        there = places(response, "i", "j", "branch")
        enclosed(response, ("force", "change"), [of_force[at] for at in there])
        parts = ("vertical", "vertical_change")
        enclosed(response, parts, [of_vertical[at] for at in there])
