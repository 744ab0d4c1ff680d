"""What draws is an extra: here it is looked for."""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

from ..arithmetic.errors import NotReachedError

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from .specification import Picture

KINDS = ("png", "svg", "pdf")
"""What figures are written as."""


class MissingLibraryError(NotReachedError):
    """A library that figures need is not installed; the message says how to install it."""

    def __init__(self, name: str) -> None:
        """Say which."""
        super().__init__(
            f"figures need {name}, which is missing; pip install 'force-diffusion[plots]'"
        )


def drawn(picture: "Picture") -> "Figure":
    """Draw a picture. Raises ``MissingLibraryError``."""
    with drawing():
        from .drawing import draw

        return draw(picture)


@contextmanager
def drawing() -> Iterator[None]:
    """Draw in the house style. Raises ``MissingLibraryError``.

    Modules that import matplotlib are imported inside of the block.
    """
    try:
        import matplotlib  # noqa: F401

        from .style import house_style
    except ModuleNotFoundError as error:
        name = (error.name or "").split(".")[0]
        if name not in {"matplotlib", "PIL"}:
            raise
        raise MissingLibraryError(name) from None
    with house_style():
        yield
