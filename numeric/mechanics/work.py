"""What a run really did: counters, which are advanced where it is done, and progress."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

from ..lattice.layers import Layer

Progress = Callable[[str, int], None]
"""Called with the kind of work and the number of beads just done."""


@dataclass
class Work:
    """Beads visited by each kind of work, over all passes of a run.

    ``arithmetic`` names the number systems of the passes. With ``trace`` on, rows are kept too.
    ``settled``: where beads came to rest in float64, for passes with more bits.
    """

    radii: int = 0
    deposited: int = 0
    balanced: int = 0
    summed: int = 0
    checked: int = 0
    arithmetic: list[str] = field(default_factory=list)
    progress: Progress | None = None
    trace: bool = False
    rows: dict[str, list[Layer]] = field(default_factory=dict)
    settled: Any = None

    def did(self, kind: str, layer: Layer, times: int = 1) -> None:
        """Count a row of beads: "radii", "deposited", "balanced", "summed" or "checked"."""
        beads = layer.count * times
        setattr(self, kind, getattr(self, kind) + beads)
        if self.trace:
            self.rows.setdefault(kind, []).append(layer)
        if self.progress is not None:
            self.progress(kind, beads)

    def did_rows(self, kind: str, rows: Sequence[Layer], beads: int) -> None:
        """Count rows of beads at once; ``beads`` are all that were visited."""
        if not self.trace:
            self.did(kind, Layer(0, 0, beads))
            return
        rows = [layer for layer in rows if layer.count]
        for layer in rows:
            self.did(kind, layer, beads // sum(row.count for row in rows))

    def uses(self, name: str) -> None:
        """Note the number system of a pass."""
        if name not in self.arithmetic:
            self.arithmetic.append(name)
