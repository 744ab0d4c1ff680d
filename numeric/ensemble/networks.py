"""What one packing adds whose contacts are unilateral: samples that differ in number."""

import numpy as np

from ..arithmetic.errors import UndecidedError
from ..arithmetic.systems import Array, Balls
from ..mechanics.work import Work
from ..unilateral.network import Relaxed
from .measure import Measurement

# Bits with which a packing is proved, one after the other until it is.
BITS = (64, 128, 256)


def measured(m: Measurement, number: int) -> tuple[Array, Array]:
    """Solve a realisation; give its samples, their sum less the ordered forces', and squares'.

    These are (3, groups); then the counts of bins. What the protocol raises is passed on.
    """
    from ..unilateral.relaxation import packings  # SciPy's solvers take 35 MB

    for bits in BITS:
        system = Balls(bits)
        try:
            with system.active():
                ((solved, _),) = packings(m.problem, [number], system, Work())
                assert isinstance(solved, Relaxed)
                counts = np.zeros(0, np.int64)
                if m.counted:
                    _, forces = m.network.samples(m.problem, solved.network)
                    places = np.searchsorted(np.array(m.edges), forces, side="right")
                    counts = np.bincount(places, minlength=m.counted)
                return m.network.sums(m.problem, solved.network), counts
        except UndecidedError:
            if bits == BITS[-1]:
                raise
    raise AssertionError
