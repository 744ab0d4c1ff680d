"""Attacks on sums of squares: radii that two sums along the lattice may share."""

import sympy
from force_diffusion.symbolic.kernel import statistics
from force_diffusion.symbolic.kernel.where import Where
from force_diffusion.symbolic.symbols import DeltaR, Variance, i, j, k, l, m, sigma
from sympy import Sum

from .attack import BEADS, attack, told


def _below(across: sympy.Expr, layer: sympy.Expr, slope: int) -> sympy.Expr:
    """The radii of all beads below one, on the line through it up to the right, or to the left."""
    base = across - slope * layer
    return Sum(DeltaR(base + slope * m, m), (m, 0, layer)) - DeltaR(across, layer)


TWO_BEADS = Where.of(j >= 0, l >= 0)

for tried, total, where, number, false, refused in (
    ("two lines that may be one", _below(i, j, 1) + _below(k, l, 1), TWO_BEADS, j + l,
     "it is more where k − l = i − j", "the true value less this one is"),
    ("two lines that may be one, to the left", _below(i, j, -1) + _below(k, l, -1), TWO_BEADS,
     j + l, "it is more where k + l = i + j", "the true value less this one is"),
    ("two lines that may cross", _below(i, j, 1) + _below(k, l, -1), TWO_BEADS, j + l,
     "it is more where they share a bead", "the true value less this one is"),
    ("two lines that may cross, beside the origin", _below(k, l, 1) + _below(i, j, -1),
     TWO_BEADS.also(k >= 1), j + l, "it is more where they share a bead",
     "the true value less this one is"),
    ("a line and a bead of it, perhaps", _below(i, j, 1) + DeltaR(i - j + l, l),
     Where.of(j >= 1, l >= 0), j + 3, "the bead may be above it",
     "the true value less this one is"),
    ("one line, twice", _below(i, j, 1) + 2 * _below(i, j, 1), BEADS, 5 * j,
     "every radius has the weight 3", "the true value less this one is"),
    ("two lines that cross", _below(i, j, 1) + _below(i, j, -1) + DeltaR(i, j), BEADS, 2 * j + 4,
     "bead (i, j) has the weight 1", "the true value less this one is"),
):  # fmt: skip

    @attack("moment", tried, false, refused)
    def _(
        form: sympy.Expr = total, right: sympy.Expr = number * sigma**2, where: Where = where
    ) -> object:
        return told(statistics.moment(), Variance(form), right, where)
