"""Whether a strip sees its images: judged by the slab's own answer."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import product
from pathlib import Path
from typing import Any

from force_diffusion.numeric.arithmetic.systems import Array, NumberSystem
from force_diffusion.numeric.disorder.radii import DrawnRadii
from force_diffusion.numeric.lattice.layers import Rows
from force_diffusion.numeric.planning.plan import Plan
from force_diffusion.numeric.run.running import run
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st

import force_diffusion as fd
from tests.numeric.scenes import basic, listed_loads, planned, question, radii_read


@dataclass(frozen=True)
class SiteRadii:
    """Radii by site: ``special`` ones, and the others by a rule, of (i modulo 2W, j)."""

    special: dict[tuple[int, int], Fraction]
    period: int

    @property
    def relative_std(self) -> Fraction:
        return Fraction(1, 1000)

    def of(self, rows: Rows, realisations: Sequence[int], system: NumberSystem) -> Array:
        sites = zip(*(column.tolist() for column in rows.sites), strict=True)
        values = [self.special.get((i, j), _rule(i % self.period, j)) for i, j in sites]
        return system.array(values)[None]


def _rule(i: int, j: int) -> Fraction:
    return Fraction((i * i * 7919 + 104729 * j + 31 * i * j + 17) % 10007 - 5003, 5_000_000)


def slab_differs(sections: dict[str, dict[str, Any]], width: int, folder: Path = Path()) -> bool:
    """Solve in the slab with other radii wherever a bead is an image of another that is read."""
    packing = {k: v for k, v in sections["packing"].items() if k not in {"width", "allow_images"}}
    slab = planned({**sections, "packing": packing}, folder)
    special, met = {}, set()
    for i, j in radii_read(slab)[1]:
        home = (i % (2 * width), j)
        if home in met and (i, j) not in special:
            special[i, j] = _rule(*home) + Fraction(i - home[0] + 1, 7_000_000)
        met.add(home)
    usual = _changes(planned(sections, folder), SiteRadii({}, 2 * width))
    return usual != _changes(slab, SiteRadii(special, 2 * width))


def _changes(plan: Plan, radii: SiteRadii) -> list[str]:
    if isinstance(plan.problem.radii, DrawnRadii):
        plan = replace(plan, problem=replace(plan.problem, radii=radii))
    return [str({k: v for k, v in row.items() if k != "i"}) for row in run(plan).decimals()]


def strip(height: int, width: int, geometry: str, at: list[Any]) -> dict[str, dict[str, Any]]:
    quantity = "contact" if len(at) == 3 else "positions"
    sections = basic(height, width, quantity=quantity, at=at)
    sections["packing"]["allow_images"] = True
    sections["effects"] = {"geometry": geometry}
    return sections


@st.composite
def single(draw: st.DrawFn) -> tuple[dict[str, dict[str, Any]], int]:
    """Ask for a bead, or for a contact below any load; and the width."""
    height, width = draw(st.integers(1, 5)), draw(st.integers(1, 8))
    j = draw(st.integers(0, height - 1))
    i, branch = j % 2 + 2 * draw(st.integers(0, width - 1)), draw(st.sampled_from("+-"))
    kind = draw(st.sampled_from([None, "surface", "bulk", "point"]))
    geometry = draw(st.sampled_from(["exact", "first-order"]))
    sections = strip(height, width, geometry, [i, j, branch] if kind else [i, j])
    if kind:
        sections["load"] = {"kind": kind}
    if kind == "point":  # which reaches the contact
        above = draw(st.integers(0, height - j - 1))
        k = i + (1 if branch == "+" else -1) - above + 2 * draw(st.integers(0, above))
        assume(0 <= k < 2 * width)
        sections["load"]["at"] = [k, j + 1 + above]
    return sections, width


@settings(max_examples=2 * settings.default.max_examples)
@given(single())
@example(({**strip(3, 5, "exact", [1, 1, "+"]), "load": {"kind": "surface"}}, 5))  # just none
@example(  # an image that lies exactly on the other diagonal
    ({**strip(5, 2, "first-order", [3, 3, "-"]), "load": {"kind": "point", "at": [3, 5]}}, 2)
)
def test_images_are_seen_exactly_where_the_slab_differs(asked):
    sections, width = asked
    assert planned(sections).sees_images == slab_differs(sections, width)


def test_the_widest_strip_is_looked_at_where_its_load_is():
    """A trillion beads of a layer are not listed."""
    sections = basic(4, 10**12, quantity="response")
    sections["load"] = {"kind": "point", "at": [0, 4]}
    for geometry in ("exact", "first-order", "ordered"):
        assert not planned({**sections, "effects": {"geometry": geometry}}).sees_images


@given(
    st.integers(1, 6), st.integers(1, 4), st.integers(1, 4),
    st.sampled_from(["exact", "first-order", "ordered"]),
    st.sampled_from(["contact_forces", "profile"]), st.sampled_from(["surface", "bulk", "point"]),
)  # fmt: skip
def test_many_contacts_see_images_where_one_does(width, height, layer, geometry, quantity, load):
    layer = min(layer, height)
    sections = basic(height, width, quantity=quantity)
    sections["packing"]["allow_images"] = True
    sections["effects"] = {"geometry": geometry}
    sections["load"] = {"kind": load, **({"at": [layer % 2, layer]} if load == "point" else {})}
    answers = [
        planned({**sections, "ask": {"quantity": "contact", "at": [i, j, branch]}}).sees_images
        for j, i, branch in product(range(height), range(2 * width), "+-")
        if (i + j) % 2 == 0
    ]
    assert planned(sections).sees_images == any(answers)


def test_what_is_seen_does_not_depend_on_how_a_load_is_written(tmp_path):
    for width, geometry in product((3, 5, 6, 7, 10), ("exact", "first-order")):
        at, effects = (6 % (2 * width), 6), {"geometry": geometry}
        for load in (listed_loads(tmp_path, [(*at, 0, -1)]), fd.PointLoad(at=at)):
            asked = question("contact_forces", 6, width, load=load, effects=effects)
            assert asked.explain().sees_images == (width <= 6)


def test_loads_far_apart_do_not_see_the_beads_between_them(tmp_path):
    load = listed_loads(tmp_path, [(0, 2, 0, -1), (10, 2, 0, -1)])
    assert not question("contact_forces", 2, 8, load=load).explain().sees_images
