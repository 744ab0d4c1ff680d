"""Which radii the first-order change of a contact force reads, below loads on single beads."""

from fractions import Fraction
from typing import Any

import pytest
from force_diffusion.numeric.arithmetic.systems import FLOAT64
from force_diffusion.numeric.lattice.branch import Branch, Contact
from force_diffusion.numeric.mechanics import first_order
from force_diffusion.numeric.mechanics.loads import LoadSpec

TOP = 5
CONTACTS = [
    Contact(i, j, branch)
    for j in range(TOP)
    for i in range(-TOP - 2, TOP + 3)
    for branch in Branch
    if (i + j) % 2 == 0
]


@pytest.mark.parametrize("at", [(1, TOP), (0, 4), (-1, 1)])
def test_beads_are_counted_as_they_are_read(at: tuple[int, int]) -> None:
    load = LoadSpec("point", TOP, None, at=at)
    counts = set()
    for contact in CONTACTS:
        lines = first_order.lines_read(contact, load)
        listed = {site for line in lines.values() for site in line.sites()}
        read = set()

        class Noted(dict[tuple[int, int], float]):
            def __missing__(self, site: tuple[int, int], read: Any = read) -> float:
                read.add(site)
                return 1 / (100 + 7 * site[0] + site[1])

        first_order.contact_change(contact, load, Noted(), Fraction(3, 5), FLOAT64)
        assert len(read) == first_order.beads_read(contact, load), contact
        assert read == listed
        above, below = first_order.crossing_layers(contact, load)
        counts.add(bool(above or below) + 2 * load.carries(*contact))
    assert 0 in counts  # outside of the cone nothing is read
    assert at[1] == 1 or {1, 2} & counts
