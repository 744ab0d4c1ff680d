"""Closed forms of Eqs. 13–16, and of rows beyond the paper, for small packings.

A variance, a covariance or the shift of a mean as the package states it is compared with what
nonlinear packings give, at every place of a packing.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from fractions import Fraction
from itertools import product

import pytest
from force_diffusion.symbolic.symbols import M, N, i, j, k, l, p, q, sigma
from hypothesis import given
from hypothesis import strategies as st

import force_diffusion as fd
from tests.derivations.rows import SOON, late
from tests.properties.drawn import FEWER, exactly, geometries, lengths
from tests.properties.moments import ACCURATE, At, Slab, moment, read
from tests.properties.packing import Number, mp

Places = Callable[[int], Iterator[At]]
"""From the height of a packing, M or l."""


def layers(height: int) -> Iterator[At]:
    """One contact, or bead, of each layer below the surface."""
    return ({i: layer, j: layer} for layer in range(height))


def neighbours(height: int) -> Iterator[At]:
    return ({**at, N: count} for at in layers(height) for count in (1, 2, 3))


def pairs(height: int) -> Iterator[At]:
    """A contact, and the one k places to its right."""
    return ({**at, k: apart} for at in layers(height) for apart in range(-3, 4))


def two_layers(height: int) -> Iterator[At]:
    """A contact, and one above it on the same diagonal."""
    return ({**at, l: above} for at in layers(height) for above in range(at[j], height))


def below(height: int) -> Iterator[At]:
    """The cone below a load on bead (k, l)."""
    first = height % 2
    for layer in range(height):
        for across in range(layer - height, height - layer + 1, 2):
            yield {k: first, l: height, i: first + across, j: layer}


def inside_in_space(height: int) -> Iterator[At]:
    """Beads p and q steps down along two base vectors from the loaded one, off the faces."""
    steps = product(range(1, height), repeat=2)
    return ({i: 0, k: 0, l: height, p: a, q: b} for a, b in steps if a + b <= height)


@dataclass(frozen=True)
class Form:
    """A closed form, and where it is looked at.

    Attributes:
        number: of its equation.
        name: of the form.
        load: as of a ``Slab``.
        places: as many as a height has.
        order: 2 for the shift of a mean.
        reach: as of a ``Slab``.
        leaning: the components of the load differ.
        dimensions: 3 for spheres.
        highest: of the packings.
    """

    number: int | str
    name: str
    load: str
    places: Places = layers
    order: int = 1
    reach: int = 0
    leaning: bool = False
    dimensions: int = 2
    highest: int = 4

    def __str__(self) -> str:
        return f"{self.number}-{self.name}"


FORMS = [
    Form(13, "layer", "surface"),
    Form(14, "layer", "bulk"),
    Form(16, "bead", "point", below),
    Form("B2", "plus", "surface", leaning=True),
    Form("B3", "minus", "bulk", leaning=True),
    Form("B4", "height", "surface", order=2),
    Form("B5", "force", "surface", order=2),
    Form("B7", "apart", "surface", pairs, reach=3, highest=3),
    Form("B8", "mean", "surface", neighbours, reach=2, highest=3),
    Form("B9", "contact", "point", below, order=2, highest=3),
    Form("B10", "ratio", "surface", order=2, leaning=True, highest=3),
    Form("B12", "layers", "surface", two_layers),
    Form("B19", "bead", "point", inside_in_space, dimensions=3, highest=3),
]


@pytest.mark.parametrize(
    "form", [form if form.number in SOON else late([form])[0] for form in FORMS], ids=str
)
@FEWER
@given(st.data(), geometries, lengths)
def test_closed_forms_are_moments_of_packings(form, data, geometry, sd):
    # forces of spheres are in units of the load's first component
    first = data.draw(lengths, "L⁺") if form.dimensions == 2 else Fraction(1)
    shares = [first] * form.dimensions
    if form.leaning:
        shares[1:] = (data.draw(lengths, "L⁻") for _ in shares[1:])
    closed_form = fd.equation(form.number).exact(form.name)
    for height in range(1, form.highest + 1):
        slab = Slab(geometry, height, form.load, tuple(shares), form.reach, form.order)
        for place in form.places(height):
            at = {M: height, **place, sigma: exactly(sd)}
            value = stated_value(closed_form, slab, at)
            measured = moment(slab, closed_form.statistic, at)
            assert abs(measured - value) < ACCURATE, (
                f"at {at}: {mp.nstr(measured, 5)}, where {mp.nstr(value, 5)} is stated"
            )


def stated_value(closed_form: fd.ClosedForm, slab: Slab, at: At) -> Number:
    nowhere = (0,) * (len(slab.shares) - 1)
    return read(slab, closed_form.expr * closed_form.divisor, at, 0, mp.mpf(0), nowhere)
