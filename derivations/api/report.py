"""All that the package finds as one HTML page."""

from collections.abc import Callable
from dataclasses import dataclass
from datetime import UTC, datetime
from functools import partial
from pathlib import Path

from force_diffusion.numeric.arithmetic.errors import NotReachedError
from force_diffusion.numeric.arithmetic.processes import Start

from .derived import Derived, derive


@dataclass(frozen=True)
class Report:
    """The page that :func:`report` made.

    Attributes:
        html: the page, which asks nothing of a network.
        derived: what was found of the equations.
    """

    html: str
    derived: Derived

    def save(self, path: str | Path) -> None:
        """Write the page to a file."""
        Path(path).write_text(self.html, encoding="utf-8")

    def __repr__(self) -> str:
        size = len(self.html.encode()) / 1e6
        return f"<Report: {self.derived.counts()}; a page of {size:.2f} MB>"


def find_libraries() -> None:
    """Look for what the extra ``report`` installs. Raises ``NotReachedError``."""
    try:
        import jinja2  # noqa: F401
        import math_core  # noqa: F401
        import matplotlib  # noqa: F401
    except ImportError as missing:
        raise NotReachedError(
            f"{missing.name} is missing; pip install 'force-diffusion[report]'"
        ) from None


def report(
    derived: Derived | None = None,
    *,
    notice: Callable[[str], None] | None = None,
    command: str = "force-diffusion report",
) -> Report:
    """Derive all equations, draw all figures, measure cost and stability: one HTML page.

    Takes about a minute, and needs the extra ``report``.

    Args:
        derived: what :func:`derive` has found of all equations; by default they are derived here.
        notice: told what is drawn or measured next.
        command: what the page says that made it.

    Raises:
        NotReachedError: a library of the extra is missing.
    """
    find_libraries()
    tell = notice or (lambda _: None)
    return made(lambda _: derived or derive(notice=notice), tell, command, partial)


def made(
    deriving: Callable[[Start], Derived], notice: Callable[[str], None], command: str, start: Start
) -> Report:
    """Make the page; what is measured by the clock is started first."""
    from ..export.page import sections
    from ..export.page.page import page

    measured = [start(part) for part in (sections.cost_part, sections.stability_part)]
    derived = deriving(start)
    parts = [sections.figures_part(notice)]
    notice("cost and stability")
    parts += [part() for part in measured]
    now = f"{datetime.now(UTC):%Y-%m-%d %H:%M} UTC"
    return Report(page(derived.outcomes, parts, command, now), derived)
