"""Which radii the first-order change of a contact force reads, below loads on single beads."""

from fractions import Fraction
from types import SimpleNamespace
from typing import Any

import pytest
from force_diffusion.numeric.mechanics.first_order import (
    beads_read,
    contact_change,
    crossing_layers,
    lines_read,
)
from force_diffusion.numeric.mechanics.loads import LoadSpec

FRACTIONS: Any = SimpleNamespace(number=Fraction)
TOP = 5
CONTACTS = [
    (i, j, branch)
    for j in range(TOP)
    for i in range(-TOP - 2, TOP + 3)
    for branch in "+-"
    if (i + j) % 2 == 0
]


@pytest.mark.parametrize("at", [(1, TOP), (0, 4), (-1, 1)])
def test_beads_are_counted_as_they_are_read(at: tuple[int, int]) -> None:
    load = LoadSpec("point", TOP, None, at=at)
    counts = set()
    for contact in CONTACTS:
        read = set()

        def radius_at(i: int, j: int, read: set[tuple[int, int]] = read) -> Fraction:
            read.add((i, j))
            return Fraction(1, 100 + 7 * i + j)

        above, below = crossing_layers(contact, load)
        _, count = contact_change(
            contact,
            own=Fraction(1) if load.carries(*contact) else None,
            above=dict.fromkeys(above, Fraction(1)),
            below=dict.fromkeys(below, Fraction(1)),
            radius_at=radius_at,
            n_x=Fraction(3, 5),
            system=FRACTIONS,
        )
        listed = {
            (line.at(m), m) for line in lines_read(contact, load) for m in range(line.top + 1)
        }
        assert count == len(read) == beads_read(contact, load), contact
        assert read == listed
        counts.add(bool(above or below) + 2 * load.carries(*contact))
    assert 0 in counts  # outside of the cone nothing is read
    assert at[1] == 1 or {1, 2} & counts
