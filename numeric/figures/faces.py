"""Figure B19: fluctuations of the response to a point load in a packing of spheres.

Simulated are exact, nonlinear packings, W = 2l. Drawn is one layer: p, the vertical force that a
bead gets from its three upper contacts, along a face of the cone, and in rows further inside, where
nothing is of first order. The curve is Eq. B19.
"""

from math import sqrt
from typing import Any

import numpy as np

from .. import closed_forms
from ..arithmetic.systems import Array
from ..lattice.branch import PerAxis
from ..mechanics.problem import Solved
from ..scene.sections import PointLoad
from . import specification as spec
from .elements import across_cone, base_vectors, point_load_in_space
from .packings import (
    PAPER_STD,
    PHI,
    Options,
    band_of_means,
    forces_of,
    gathered,
    of_ensembles,
    planned,
)

APEX, LAYER = 10, 4
ROWS = (0, 1, 2)
"""Steps along the third vector: a face of the cone, and rows inside of it."""


def places(row: int) -> list[tuple[int, int, int]]:
    """Steps down from the loaded bead to the beads of a row, those on legs left out."""
    left = APEX - LAYER - row
    return [(left - q, q, row) for q in range(1, left)]


SCATTER = r"$\sigma(p)/f^{\mathrm{load}}$ over $\sigma_{\delta r}/r$"
BEADS = [bead for row in ROWS for bead in places(row)]
FACE = len(places(0))


def theory() -> Array:
    """σ(p)/f_load over σ/r along the face (Eq. B19); shape (l − j − 1,)."""
    form = closed_forms.spheres_response
    return np.sqrt([float(form(steps, APEX, float(PHI), 1.0, 1.0)) for steps in places(0)])


def cone() -> spec.Panel:
    """σ(p) over σ/r by Eq. B19 on legs and faces, in space; the face behind is left out."""
    steps = [
        (a, b, layers - a - b)
        for layers in range(1, APEX + 1)
        for a in range(layers + 1)
        for b in range(layers - a + 1)
        if 0 in (a, layers - a - b)
    ]
    form = closed_forms.spheres_response
    shades = np.sqrt([float(form(own, APEX, float(PHI), 1.0, 1.0)) for own in steps])
    centres = -2 * np.array(steps) @ base_vectors(float(PHI))
    beads = spec.Beads(
        centres,
        shades=shades,
        bar=SCATTER,
        side="left",
        least=0.9 * float(shades.min()),
        most=float(shades.max()),
        size=5.5,
    )
    layer = across_cone(float(PHI), APEX - LAYER, 0, f"layer $j={LAYER}$, of (b)")
    return spec.Panel(
        [beads, layer, *point_load_in_space(float(PHI), APEX)],
        legend="lower right",
        scaled=True,
        bare=True,
        spatial=True,
    )


def vertical(change: PerAxis[Any], ordered: float, steps: tuple[int, int, int]) -> Array:
    """p/f_load of a bead, so many steps below the loaded one; shape (realisations,).

    A contact is found by its upper bead, in a layer of W × W.
    """
    total = np.zeros(1)
    for axis, (_, layers) in enumerate(change):
        upper = [count - (place == axis) for place, count in enumerate(steps)]
        beads = layers[APEX - sum(upper)]
        width = round(sqrt(beads.shape[-1]))
        at = (-upper[0] % width) * width + -upper[1] % width
        total = total + beads[..., at] / (3 * ordered)
    return total


def squares(answer: Solved, number: int) -> tuple[Array]:
    """p² of ``BEADS``, averaged over the three vectors, which are alike; (number, beads)."""
    forces = forces_of(answer)
    assert isinstance(forces.change, PerAxis)
    ordered = float(np.ravel(forces.ordered.plus[APEX])[0])
    each = np.zeros((number, len(BEADS)))
    for place, (p, q, row) in enumerate(BEADS):
        for steps in ((p, q, row), (q, row, p), (row, p, q)):
            each[:, place] += vertical(forces.change, ordered, steps) ** 2 / 3
    return (each,)


def simulated(o: Options) -> tuple[spec.Comparison, Array]:
    """Simulate; σ(p)/f_load along the face, and inside, where theory says nothing."""
    ensemble = planned(
        "response", height=APEX, seed=o.seed, realisations=o.realisations,
        load=PointLoad(at=(0, 0, APEX)), dimension=3,
    )  # fmt: skip
    (square,) = gathered(ensemble, o.notice, "figure B19", squares)
    band = band_of_means(square[:, :FACE], o.seed, 0.5)
    face = spec.Comparison(f"l = {APEX}, j = {LAYER}: Eq. B19", band, theory() * PAPER_STD)
    return face, np.sqrt(square.mean(axis=0)[FACE:])


def figure(o: Options) -> spec.Figure:
    """σ(p) over σ/r, against the place in the row; logarithmic, for the inside to be seen."""
    face, inside = simulated(o)
    share = float(inside.max() / face.theory.min())
    row, q = np.array([(row, q) for _, q, row in BEADS]).T
    panel = spec.Panel(
        [
            spec.Line(q[:FACE], face.theory / PAPER_STD, 0, name="exact first order"),
            face.points(q[:FACE], 0, "face of the cone", unit=PAPER_STD),
            *(
                spec.Points(
                    (q + row / 2)[row == own], inside[row[FACE:] == own] / PAPER_STD, own,
                    f"{own} step{'s' * (own > 1)} inside",
                )
                for own in ROWS[1:]
            ),
        ],
        spec.Axis("place along the row", ticks=q[:FACE].tolist()),
        spec.Axis(SCATTER, log=True),
        legend="center right",
    )  # fmt: skip
    rest = len(inside)
    return spec.Figure(
        spec.Picture([cone(), panel], 2.7, page=True),
        tables={
            "figureB19": {
                "row": row,
                "q": q,
                "simulated": [*face.band.value.tolist(), *inside.tolist()],
                "band_low": [*face.band.limits[0].tolist(), *[None] * rest],
                "band_high": [*face.band.limits[1].tolist(), *[None] * rest],
                "exact_first_order": [*face.theory.tolist(), *[0.0] * rest],
            }
        },
        facts={
            **of_ensembles(o, PAPER_STD, apex=APEX, layer=LAYER, phi=float(PHI)),
            **face.fact(),
            "largest_inside_over_face": share,
        },
        words=[
            f"{face.verdict()}; inside of the cone σ(p) is at most {share:.1g} of that on its faces"
        ],
        comparisons=[face],
    )
