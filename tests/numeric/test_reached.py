"""Contacts that no load reaches are none of a histogram, nor of a slab's contact forces."""

import tracemalloc
from pathlib import Path
from typing import Any

from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import force_diffusion as fd
from tests.numeric.scenes import listed_loads, question

Bead = tuple[int, ...]


def below(loads: set[Bead], width: int | None) -> set[tuple[Any, ...]]:
    """Contacts (lower bead, branch) that loads reach, bead by bead; a width of discs."""
    todo, contacts = set(loads), set()
    while todo:
        i, j = todo.pop()
        for side, branch in ((-1, "+"), (1, "-")) if j else ():
            lower = (i + side if width is None else (i + side) % (2 * width)), j - 1
            contacts.add((*lower, branch))
            todo.add(lower)
    return contacts


def asked(
    folder: Path, loads: set[Bead], width: int | None, height: int, quantity: str, **ask: Any
) -> fd.Scene:
    rows: list[tuple[float, ...]] = [(*bead, 0.01, -1) for bead in loads]
    if width is None:
        rows.append((80 + height % 2, height, 0, 0))  # no load
    return question(quantity, height, width, load=listed_loads(folder, rows), **ask)


def count(asked: fd.Scene) -> int:
    return int(sum(asked.run().arrays["count"]))


def test_two_loads_that_are_far_apart(tmp_path):
    loads: set[Bead] = {(0, 4), (40, 4)}
    assert count(asked(tmp_path, loads, 60, 4, "histogram", layers=[3])) == 4
    assert fd.ensemble(asked(tmp_path, loads, 60, 4, "histogram"), 4, reach=0.01).samples == 160


def test_a_point_load_on_spheres():
    """Its cone has 1, 3 and 6 beads; layers of 7 × 7 are solved."""
    load = fd.PointLoad(at=(5, 6, 3))
    assert count(question("histogram", 3, 7, dimension=3, load=load)) == 3 * (1 + 3 + 6)


def test_layers_above_a_load_take_no_memory():
    low, high = (
        question("contact_forces", height, None, std=1e-12, load=fd.PointLoad(at=(0, 4)))
        for height in (4, 10**7)
    )
    low.run()  # loads what is needed
    tracemalloc.start()
    try:
        high.run()
        _, most = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert most < 10**7  # a byte a layer


@st.composite
def loaded(draw: st.DrawFn) -> tuple[set[Bead], int | None, int]:
    height = draw(st.integers(1, 5))
    width = draw(st.none() | st.integers(1, 9))
    columns = st.integers(0, 12 if width is None else width - 1)
    beads = st.tuples(columns, st.integers(1, height)).map(
        lambda at: (2 * at[0] + at[1] % 2, at[1])
    )
    return draw(st.sets(beads, min_size=1, max_size=4)), width, height


@settings(
    max_examples=settings.default.max_examples // 2,
    suppress_health_check=[HealthCheck.function_scoped_fixture],
)
@given(loaded())
def test_contacts_are_those_below_loads(tmp_path, drawn):
    loads, width, height = drawn
    expected = below(loads, width)
    arrays = asked(tmp_path, loads, width, height, "contact_forces").run().arrays
    contacts = list(zip(arrays["i"].tolist(), arrays["j"].tolist(), arrays["branch"], strict=True))
    if width is None:
        assert set(contacts) == expected
        assert len(contacts) == len(expected)
        return
    assert count(asked(tmp_path, loads, width, height, "histogram")) == len(expected)
    pressed = {contact for contact, force in zip(contacts, arrays["force"], strict=True) if force}
    assert pressed <= expected
