"""Every question about a periodic strip, seams and images included, against a small solver.

``tests.strip`` solves all beads of the strip at 100 digits, and knows neither regions nor layers.
The answers here are certified, so that an enclosure has to hold the true value.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import flint
import mpmath
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import force_diffusion as fd
from tests.strip import Strip

DIGITS = 100
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
                load = {"kind": "file", "file": "loads.csv"}
            scene = fd.Scene(
                packing=fd.Packing(
                    height=self.height,
                    width=self.width,
                    radius=self.r,
                    spacing=self.spacing * self.r,
                    allow_images=True,
                ),
                disorder=fd.GivenRadii(delta_r=self.delta * 2.0**-14),
                load=fd.Load(**load),
                effects=fd.Effects(geometry=geometry),
                ask=fd.Ask(quantity=quantity, at=at),
                folder=Path(folder),
            )
            return scene.run(TOLERANCE, certified=True)

    def strip(self, strength: Any) -> Strip:
        """The strip with deviations that are ``strength`` times as large."""
        turn = mpmath.radians(self.angle)
        unit = mpmath.sin(turn), -mpmath.cos(turn)
        single: dict[tuple[int, int], Any] = dict(self.loads)
        if self.kind == "point":
            single = dict.fromkeys(list(single)[:1], unit)
        elif self.kind != "file":
            layers = range(self.height if self.kind == "surface" else 0, self.height + 1)
            single = {(i, j): unit for j in layers for i in range(j % 2, 2 * self.width, 2)}
        n_x = number(self.spacing) / 4

        def radius(i: int, j: int) -> Any:
            return number(self.r) + strength * int(self.delta[j, i // 2]) / mpmath.mpf(2) ** 14

        n = n_x, mpmath.sqrt(1 - n_x**2)
        return Strip(self.width, self.height, n, radius, single, mpmath.sqrt, number(self.r))


def number(value: Fraction) -> Any:
    return mpmath.mpf(value.numerator) / value.denominator


def truth(drawn: Drawn, geometry: str, read: Callable[[Strip], list[Any]]) -> list[tuple[Any, Any]]:
    """(value, change) of what ``read`` takes from a strip, by one of the three theories."""
    ordered = read(drawn.strip(0))
    if geometry == "ordered":
        return [(value, mpmath.mpf(0)) for value in ordered]
    if geometry == "exact":
        found = [(value, value - still) for value, still in
                 zip(read(drawn.strip(1)), ordered, strict=True)]  # fmt: skip
    else:
        step = mpmath.mpf(TINY)
        ends = read(drawn.strip(step)), read(drawn.strip(-step))
        slopes = [(up - down) / (2 * step) for up, down in zip(*ends, strict=True)]
        found = [(still + slope, slope) for still, slope in zip(ordered, slopes, strict=True)]
    return found


def holds(enclosure: Any, value: Any) -> bool:
    with flint.ctx.workprec(400):
        near = flint.arb(f"{mpmath.nstr(value, 70)} +/- {ROOM}")
        narrow = enclosure.rad() < 1e-20 if isinstance(enclosure, flint.arb) else True
        return bool(narrow and flint.arb(enclosure).overlaps(near))


@st.composite
def strips(draw: st.DrawFn, **loads: Any) -> Drawn:
    """Strips of one to six beads a layer; as high, and so often much higher than wide."""
    width, height = draw(st.integers(1, 6)), draw(st.integers(1, 6))
    count = width * (height + 1)
    delta = draw(st.lists(st.integers(-64, 64), min_size=count, max_size=count))
    beads = [(i, j) for j in range(height + 1) for i in range(j % 2, 2 * width, 2)]
    forces = st.tuples(st.integers(-3, 3), st.integers(-4, -1))
    kind = draw(st.sampled_from(loads.get("kinds", ["surface", "bulk", "point", "file"])))
    j = draw(st.integers(0, height - 1))
    i = j % 2 + 2 * draw(st.integers(0, width - 1))
    return Drawn(
        draw(st.sampled_from([Fraction(1), Fraction(1, 2), Fraction(3)])),
        draw(st.sampled_from([Fraction(n, 10) for n in (21, 24, 30, 34)])),
        np.array(delta).reshape(height + 1, width),
        kind,
        draw(st.integers(-20, 20)),
        draw(st.dictionaries(st.sampled_from(beads), forces, min_size=1, max_size=3)),
        (i, j, draw(st.sampled_from("+-"))),
    )


def side(branch: str) -> int:
    return 1 if branch == "+" else -1


def forces(places: list[tuple[int, int, str]]) -> Callable[[Strip], list[Any]]:
    return lambda strip: [strip.force(i, j, side(branch)) for i, j, branch in places]


def places(outcome: fd.Outcome) -> list[tuple[int, int, str]]:
    return list(zip(*(outcome.arrays[name] for name in ("i", "j", "branch")), strict=True))


def enclosed(outcome: fd.Outcome, names: tuple[str, str], found: list[tuple[Any, Any]]) -> None:
    columns = (outcome.arrays[name] for name in names)
    for enclosures, true in zip(zip(*columns, strict=True), found, strict=True):
        assert all(holds(*pair) for pair in zip(enclosures, true, strict=True)), (names, true)


@pytest.fixture(autouse=True)
def digits() -> Iterator[None]:
    with mpmath.workdps(DIGITS):
        yield


@pytest.mark.parametrize("geometry", GEOMETRIES)
@given(strips())
def test_one_contact(geometry: str, drawn: Drawn) -> None:
    outcome = drawn.outcome(geometry, "contact", list(drawn.contact))
    assert places(outcome) == [drawn.contact]
    enclosed(outcome, ("force", "change"), truth(drawn, geometry, forces([drawn.contact])))


@pytest.mark.parametrize("geometry", GEOMETRIES)
@given(strips())
def test_all_contacts_and_their_means(geometry: str, drawn: Drawn) -> None:
    outcome = drawn.outcome(geometry, "contact_forces")
    every = places(outcome)
    assert sorted(every) == sorted(
        (i, j, branch)
        for j in range(drawn.height)
        for i in range(j % 2, 2 * drawn.width, 2)
        for branch in "+-"
    )
    found = truth(drawn, geometry, forces(every))
    enclosed(outcome, ("force", "change"), found)
    profile = drawn.outcome(geometry, "profile")
    means = []
    for j, branch in zip(profile.arrays["j"], profile.arrays["branch"], strict=True):
        layer = [f for f, at in zip(found, every, strict=True) if at[1:] == (j, branch)]
        means.append(
            tuple(mpmath.fsum(column) / drawn.width for column in zip(*layer, strict=True))
        )
    enclosed(profile, ("mean", "mean_change"), means)


@pytest.mark.parametrize("geometry", GEOMETRIES)
@given(strips(), st.booleans())
def test_positions(geometry: str, drawn: Drawn, one: bool) -> None:
    at = [drawn.contact[0], drawn.contact[1]] if one else None
    outcome = drawn.outcome(geometry, "positions", at)
    beads = list(zip(outcome.arrays["i"], outcome.arrays["j"], strict=True))
    assert len(beads) == (1 if one else drawn.width * (drawn.height + 1))
    for axis, names in enumerate((("x", "dx"), ("y", "dy"))):
        read = lambda strip, axis=axis: [strip.centre(*bead)[axis] for bead in beads]  # noqa: E731
        enclosed(outcome, names, truth(drawn, geometry, read))


@pytest.mark.parametrize("geometry", GEOMETRIES)
@given(strips())
def test_base_reactions(geometry: str, drawn: Drawn) -> None:
    outcome = drawn.outcome(geometry, "base_reactions")
    beads = list(outcome.arrays["i"])
    assert beads == list(range(0, 2 * drawn.width, 2))

    def read(strip: Strip, axis: int) -> list[Any]:
        return [
            sum(strip.force(i, 0, step) * strip.direction(i, 0, step)[axis] for step in (1, -1))
            - strip.loads.get((i, 0), (0, 0))[axis]
            for i in beads
        ]

    for axis, names in enumerate((("fx", "change_x"), ("fy", "change_y"))):
        enclosed(outcome, names, truth(drawn, geometry, lambda s, axis=axis: read(s, axis)))


@pytest.mark.parametrize("geometry", GEOMETRIES)
@given(strips(kinds=["point"]))
def test_response(geometry: str, drawn: Drawn) -> None:
    outcome = drawn.outcome(geometry, "response")
    there = places(outcome)
    enclosed(outcome, ("force", "change"), truth(drawn, geometry, forces(there)))

    def vertical(strip: Strip) -> list[Any]:
        return [strip.force(i, j, side(b)) * strip.direction(i, j, side(b))[1] for i, j, b in there]

    enclosed(outcome, ("vertical", "vertical_change"), truth(drawn, geometry, vertical))
