"""What a run really did: counters that the sweeps themselves advance, and progress from them."""

from collections.abc import Callable
from dataclasses import dataclass, field

from numeric.lattice import Layer

Progress = Callable[[str, int], None]
"""Called with the kind of work and the number of beads just done."""


@dataclass
class Work:
    """Beads visited by each kind of work; with ``trace`` on, their rows too."""

    radii: int = 0
    deposited: int = 0
    balanced: int = 0
    summed: int = 0
    progress: Progress | None = None
    trace: bool = False
    rows: dict[str, list[Layer]] = field(default_factory=dict)

    def did(self, kind: str, layer: Layer, times: int = 1) -> None:
        """Count a row of beads: "radii", "deposited", "balanced" or "summed"."""
        beads = layer.count * times
        setattr(self, kind, getattr(self, kind) + beads)
        if self.trace:
            self.rows.setdefault(kind, []).append(layer)
        if self.progress is not None:
            self.progress(kind, beads)
