"""The packings of which stability is measured: periodic strips under a surface load.

The *deviation form* is the engine's, in line-sum coordinates; the *plain form* solves for positions
and forces and subtracts the ordered values. Strips are a valid problem of their own, however narrow
they are, so that heights of thousands of layers stay small.
"""

from decimal import Decimal
from fractions import Fraction

from ...planning import planner
from ...planning.plan import Plan
from ...scene.scene import Scene
from ...scene.sections import Ask, Disorder, Packing
from ..distances import Enclosed

SEED = 1


def strip(height: int, width: int, relative_std: Fraction, spacing: Fraction) -> Plan:
    """Plan to solve all contact forces of a strip; ``spacing``: s/r."""
    return planner.plan(
        Scene(
            packing=Packing(height=height, width=width, spacing=spacing, allow_images=True),
            disorder=Disorder(kind="uniform", relative_std=relative_std, seed=SEED),
            ask=Ask(quantity="contact_forces"),
        )
    )


def bits_lost(found: Enclosed) -> float | None:
    """Give the bits of the arithmetic that enclosures leave uncertain; None where all are."""
    if not found.sound:
        return None
    radius = found.relative(found.radius)
    lost = found.system.bits + float(radius.ln() / Decimal(2).ln()) if radius else 0.0
    return round(max(lost, 0.0), 1)
