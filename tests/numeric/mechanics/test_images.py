"""Whether a strip sees its images: judged by the slab's own answer."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import product
from pathlib import Path
from typing import Any

import pytest
from force_diffusion.numeric.arithmetic.systems import Array, NumberSystem
from force_diffusion.numeric.disorder.radii import DrawnRadii
from force_diffusion.numeric.lattice.layers import Rows
from force_diffusion.numeric.planning.plan import Plan
from force_diffusion.numeric.run.running import run

from tests.numeric.scenes import basic, planned, radii_read


@dataclass(frozen=True)
class Known:
    """Radii by site: ``special`` ones, and the others by a rule, of (i modulo 2W, j)."""

    special: dict[tuple[int, int], Fraction]
    period: int

    def relative_std(self) -> Fraction:
        return Fraction(1, 1000)

    def at(self, sites: Sequence[tuple[int, int]], realisation: int, system: NumberSystem) -> Array:
        values = [self.special.get(s, _rule(s[0] % self.period, s[1])) for s in sites]
        return system.array(values)

    def of(self, rows: Rows, realisations: Sequence[int], system: NumberSystem) -> Array:
        i, j = (one.tolist() for one in rows.sites)
        return self.at(list(zip(i, j, strict=True)), 0, system)[None]


def _rule(i: int, j: int) -> Fraction:
    return Fraction((i * i * 7919 + 104729 * j + 31 * i * j + 17) % 10007 - 5003, 5_000_000)


def slab_differs(sections: dict[str, dict[str, Any]], width: int, folder: Path = Path()) -> bool:
    """Solve in the slab with other radii wherever a bead is an image of another that is read."""
    packing = {k: v for k, v in sections["packing"].items() if k not in {"width", "allow_images"}}
    slab = planned({**sections, "packing": packing}, folder)
    strip = planned(sections, folder)
    special, met = {}, set()
    for i, j in radii_read(slab)[1]:
        home = (i % (2 * width), j)
        if home in met and (i, j) not in special:
            special[i, j] = _rule(*home) + Fraction(i - home[0] + 1, 7_000_000)
        met.add(home)
    return _changes(strip, Known({}, 2 * width)) != _changes(slab, Known(special, 2 * width))


def _changes(plan: Plan, radii: Known) -> list[str]:
    if isinstance(plan.problem.radii, DrawnRadii):
        plan = replace(plan, problem=replace(plan.problem, radii=radii))
    drop = {"i"}
    return [str({k: v for k, v in row.items() if k not in drop}) for row in run(plan).decimals()]


def strip(height: int, width: int, geometry: str, at: list[Any]) -> dict[str, dict[str, Any]]:
    quantity = "contact" if len(at) == 3 else "positions"
    sections = basic(height, width, quantity=quantity, at=at)
    sections["packing"]["allow_images"] = True
    sections["effects"] = {"geometry": geometry}
    return sections


@pytest.mark.long(sample=1)
@pytest.mark.parametrize("geometry", ["exact", "first-order"])
@pytest.mark.parametrize("load", ["surface", "bulk"])
def test_a_contact_sees_images_exactly_where_the_slab_differs(geometry: str, load: str) -> None:
    for height, width in product((1, 2, 3, 4), range(1, 9)):
        for j, branch in product(range(height), "+-"):
            sections = strip(height, width, geometry, [j % 2 + 2 * (width // 2), j, branch])
            if sections["ask"]["at"][0] >= 2 * width:
                sections["ask"]["at"][0] -= 2
            sections["load"] = {"kind": load}
            seen = planned(sections).sees_images
            assert seen == slab_differs(sections, width), (height, width, sections["ask"])


@pytest.mark.parametrize("geometry", ["exact", "first-order"])
def test_a_position_sees_images_exactly_where_the_slab_differs(geometry: str) -> None:
    for width, j in product(range(1, 6), range(5)):
        sections = strip(4, width, geometry, [j % 2, j])
        assert planned(sections).sees_images == slab_differs(sections, width), (width, j)


@pytest.mark.parametrize("geometry", ["exact", "first-order"])
def test_a_point_load_sees_images_exactly_where_the_slab_differs(geometry: str) -> None:
    seen = set()
    for width, (k, top) in product((2, 3, 4, 5, 7), ((1, 1), (2, 2), (1, 3), (2, 4))):
        for i, j, branch in ((2, 0, "+"), (2, 0, "-"), (1, 1, "+"), (3, 1, "-"), (2, 2, "+")):
            if max(k, i) >= 2 * width:
                continue
            sections = strip(5, width, geometry, [i, j, branch])
            sections["load"] = {"kind": "point", "at": [k, top]}
            x, y = i + (1 if branch == "+" else -1), j + 1
            if abs(k - x) > top - y:
                continue  # the load itself does not reach the contact
            sees = planned(sections).sees_images
            assert sees == slab_differs(sections, width), (width, k, top, i, j, branch)
            seen.add(sees)
    assert seen == {True, False}


def test_the_widest_strip_is_looked_at_where_its_load_is() -> None:
    """A trillion beads of a layer are not listed."""
    sections = basic(4, 10**12, quantity="response")
    sections["load"] = {"kind": "point", "at": [0, 4]}
    for geometry in ("exact", "first-order", "ordered"):
        assert not planned({**sections, "effects": {"geometry": geometry}}).sees_images


@pytest.mark.long(sample=1)
@pytest.mark.parametrize("geometry", ["exact", "first-order", "ordered"])
@pytest.mark.parametrize(
    ("quantity", "load"),
    [("contact_forces", "surface"), ("contact_forces", "point"), ("profile", "bulk")],
)
def test_many_contacts_see_images_where_any_one_does(
    geometry: str, quantity: str, load: str
) -> None:
    for width, height, layer in product((1, 2, 3, 5, 8), (1, 2, 4), (1, 2, 4)):
        if layer > height:
            continue
        sections = basic(height, width, quantity=quantity)
        sections["packing"]["allow_images"] = True
        sections["effects"] = {"geometry": geometry}
        sections["load"] = {"kind": load, **({"at": [layer % 2, layer]} if load == "point" else {})}
        ones = []
        for j, i, branch in product(range(height), range(2 * width), "+-"):
            if (i + j) % 2 == 0:
                one = {**sections, "ask": {"quantity": "contact", "at": [i, j, branch]}}
                ones.append(planned(one).sees_images)
        assert planned(sections).sees_images == any(ones), (width, height, layer)


def test_what_is_seen_does_not_depend_on_how_a_load_is_written(tmp_path: Path) -> None:
    (tmp_path / "loads.csv").write_text("i,j,fx,fy\n6,6,0,-1\n")
    for width, geometry in product((3, 5, 6, 7, 10), ("exact", "first-order")):
        sections = basic(6, width)
        sections["packing"]["allow_images"] = True
        sections["effects"] = {"geometry": geometry}
        at = [6 % (2 * width), 6]
        (tmp_path / "loads.csv").write_text(f"i,j,fx,fy\n{at[0]},6,0,-1\n")
        sections["load"] = {"kind": "file", "file": "loads.csv"}
        file = planned(sections, tmp_path).sees_images
        sections["load"] = {"kind": "point", "at": at}
        assert file == planned(sections).sees_images
        assert file == (width <= 6)


def test_loads_far_apart_do_not_see_the_beads_between_them(tmp_path: Path) -> None:
    (tmp_path / "loads.csv").write_text("i,j,fx,fy\n0,2,0,-1\n10,2,0,-1\n")
    sections = basic(2, 8, quantity="contact_forces")
    sections["load"] = {"kind": "file", "file": "loads.csv"}
    assert not planned(sections, tmp_path).sees_images
