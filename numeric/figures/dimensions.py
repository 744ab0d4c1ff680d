"""Figure B11: σ_f/⟨f⟩ of a surface load in two, three and four dimensions.

The points are exact to first order at finite M: all weights of the radii, as fractions, squared and
summed. The curves are the leading order, Eq. B11.
"""

from fractions import Fraction

import numpy as np

from .. import closed_forms
from ..arithmetic.systems import Array
from ..mechanics.any_dimension import force_weights, squared, together
from . import specification as spec
from .packings import Options

HEIGHT = 24
DIMENSIONS = (2, 3, 4)
PHI = Fraction(1, 5)


def exact(dimension: int) -> Array:
    """σ_f/⟨f⟩ over σ/r by layer, shape (M,)."""
    found = [squared(together(force_weights(dimension, HEIGHT, j, PHI))) for j in range(HEIGHT)]
    return np.sqrt([float(value) for value in found])


def printed(dimension: int, z: Array) -> Array:
    """The leading order at relative heights z (Eq. B11)."""
    form = closed_forms.diffusion_in_dimensions
    return np.sqrt([form(dimension, HEIGHT, at, float(PHI), 1.0, 1.0) for at in z])


def figure(o: Options) -> spec.Figure:
    """Points and curves over M^(3/2)."""
    found = {}
    for d in DIMENSIONS:
        o.notice(f"figure B11, d = {d}")
        found[d] = exact(d)
    z, fine, unit = np.arange(HEIGHT) / HEIGHT, np.linspace(0, 1, 101), HEIGHT**1.5
    leading = {d: printed(d, z) for d in DIMENSIONS}
    ratios = {d: float(found[d][0] / leading[d][0]) for d in DIMENSIONS}
    panel = spec.Panel(
        [
            spec.Line(name="leading order"),
            *(
                (
                    spec.Line(fine, printed(d, fine) / unit, c),
                    spec.Points(z, found[d] / unit, c, f"$d={d}$, exact at $M={HEIGHT}$"),
                )
                for c, d in enumerate(DIMENSIONS)
            ),
        ],
        spec.RELATIVE_HEIGHT,
        spec.Axis(r"$M^{-3/2}\,(\sigma_f/\langle f\rangle)\,/\,(\sigma_{\delta r}/r)$", 0),
        legend="upper right",
    )
    rows = [
        (d, j, float(z[j]), float(found[d][j]), float(leading[d][j]))
        for d in DIMENSIONS
        for j in range(HEIGHT)
    ]
    told = ", ".join(f"{ratio:.3f} for d = {d}" for d, ratio in ratios.items())
    return spec.Figure(
        spec.Picture([panel], 2.6),
        tables={"figureB11": spec.table("dimension j z exact_finite_M printed", rows)},
        facts={
            "height": HEIGHT,
            "phi": float(PHI),
            "exact_over_printed_at_base": list(ratios.values()),
        },
        words=[f"M = {HEIGHT}: exact over leading σ_f at the base: {told}"],
    )
