"""What a sweep by segments keeps on its way."""

from ..arithmetic.systems import Array


class Kept:
    """Arrays by name, in memory; a checkpoint keeps them in a file, too, for a later run."""

    def __init__(self) -> None:
        """Nothing is kept."""
        self._kept: dict[str, Array] = {}

    def get(self, name: str) -> Array | None:
        """Give what was kept under a name, or None."""
        return self._kept.get(name)

    def put(self, name: str, values: Array) -> None:
        """Keep an array."""
        self._kept[name] = values

    def drop(self, name: str) -> None:
        """Forget it."""
        self._kept.pop(name, None)

    def save(self, *, now: bool = True) -> None:
        """Make sure of it; if not ``now``, where that takes little of the time."""
