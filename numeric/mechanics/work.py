"""What a run hands on from one pass to the next: whom it tells of its progress."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

Progress = Callable[[str, int], None]
"""Called with the kind of work and the number of beads just done."""


@dataclass
class Work:
    """A run under way; ``settled``: where beads came to rest in float64, for more bits."""

    progress: Progress | None = None
    settled: Any = None

    def did(self, kind: str, beads: int) -> None:
        """Tell that beads were "deposited", "balanced", "summed" or "checked"."""
        if self.progress is not None:
            self.progress(kind, beads)
