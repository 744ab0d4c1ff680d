"""Dependency regions against walks from bead to bead, in strips of any width and in the slab."""

from collections.abc import Iterable

from force_diffusion.numeric.lattice import regions
from force_diffusion.numeric.lattice.branch import Branch, Contact
from force_diffusion.numeric.lattice.layers import Layer
from hypothesis import given, settings
from hypothesis import strategies as st

# a walk takes no time, and cases such as two loads on either side of a seam are rare
often = settings(max_examples=5 * settings.default.max_examples)

Sites = set[tuple[int, int]]

widths = st.one_of(st.none(), st.integers(1, 9))
heights = st.integers(1, 8)


def home(i: int, width: int | None) -> int:
    return i if width is None else i % (2 * width)


def walk(start: Iterable[tuple[int, int]], up: int, top: int, width: int | None) -> Sites:
    """All beads reached by steps up (or down) to either side, within layers 0 … top."""
    visited = {(home(i, width), j) for i, j in start}
    edge = visited
    while edge:
        steps = {(home(i + by, width), j + up) for i, j in edge for by in (1, -1)}
        edge = {site for site in steps if 0 <= site[1] <= top} - visited
        visited = visited | edge
    return visited


def sites(rows: Iterable[Layer], width: int | None) -> Sites:
    listed = [(home(i, width), row.j) for row in rows for i in row.sites()]
    assert len(listed) == len(set(listed))  # no bead twice
    return set(listed)


@st.composite
def beads(draw: st.DrawFn, low: int, high: int, width: int | None) -> tuple[int, int]:
    j = draw(st.integers(low, high))
    return 2 * draw(st.integers(-9, 9) if width is None else st.integers(0, width - 1)) + j % 2, j


@often
@given(st.data(), widths, heights)
def test_loads_reach_all_below_them_and_may_reach_what_lies_between(data, width, top):
    loaded = data.draw(st.lists(beads(0, top, width), min_size=1, max_size=3))
    rows = regions.downward_cone(loaded, width)
    reached = walk(loaded, -1, top, width)
    assert sites(rows, width) >= reached
    assert [row.j for row in rows] == list(range(1 + max(j for _, j in loaded)))
    if len(loaded) == 1:
        assert sites(rows, width) == reached


@often
@given(st.data(), widths, heights, st.sampled_from("+-"))
def test_a_contact_needs_what_stands_on_it_and_bears_load(data, width, top, branch):
    """No bead more, but where images split the row that bears load."""
    i, j = data.draw(beads(0, top - 1, width))
    surface = [(2 * q + top % 2, top) for q in range(width or 9)]
    some = st.lists(beads(0, top, width), min_size=1, max_size=2)
    loaded = data.draw(some | st.just(surface))
    reach = regions.downward_cone(loaded, width)
    x = (i + (1 if branch == "+" else -1), j + 1)
    needed = walk([x], 1, len(reach) - 1, width) & sites(reach, width)
    result = sites(regions.contact_rows(Contact(i, j, Branch(branch)), reach, width), width)
    if (home(x[0], width), x[1]) not in needed:
        assert not result
        return
    assert needed <= result <= sites(reach, width)
    if width is None or all(
        up.count + row.count <= width or width in (up.count, row.count)
        for up, row in zip(regions.upward_cone(x, len(reach) - 1, width), reach, strict=True)
    ):
        assert result == needed
