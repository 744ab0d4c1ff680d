"""The style of all figures (``house.mplstyle``), and their files. Needs matplotlib.

Each colour comes with its own marker or line style, for print in grey. Importing this module raises
``MissingLibraryError`` where there is no matplotlib (the extra ``plots``).
"""

import io
from collections.abc import Sequence
from contextlib import AbstractContextManager
from pathlib import Path
from typing import Any

from ..arithmetic.errors import MissingLibraryError
from ..arithmetic.systems import Array

try:
    from matplotlib import style
    from matplotlib.axes import Axes
    from matplotlib.axis import Axis
    from matplotlib.backend_bases import RendererBase
    from matplotlib.container import ErrorbarContainer
    from matplotlib.figure import Figure
    from matplotlib.ticker import LogLocator, NullFormatter
except ModuleNotFoundError as error:
    raise MissingLibraryError(
        "figures need matplotlib, which is missing; pip install 'force-diffusion[plots]'"
    ) from error

COLUMN, PAGE = 3.4, 7.0  # inches
MARKERS = "os^DvP"
"""Of the series C0, C1, ..."""
MARKED = 16
"""Layers that get a marker: between more of them no curve would be seen."""
GREY = "0.35"
"""Of keys that stand for all colours."""
RELATIVE_HEIGHT = "relative height $z=j/M$"


def house_style() -> AbstractContextManager[None]:
    """Draw in the house style, whatever a user's own matplotlibrc says."""
    return style.context(Path(__file__).with_name("house.mplstyle"), after_reset=True)


class HouseFigure(Figure):
    """A figure that looks the same wherever it is drawn later, and shows itself in a notebook."""

    def draw(self, renderer: RendererBase) -> None:
        """Draw it in the house style."""
        with house_style():
            super().draw(renderer)

    def _repr_png_(self) -> bytes:
        painted = io.BytesIO()
        self.savefig(painted, format="png", dpi=150)
        return painted.getvalue()


def panels(
    mosaic: str, width: float, height: float, **layout: Any
) -> tuple[HouseFigure, list[Axes]]:
    """Start a figure of so many inches; give its panels, with letters where there are several.

    ``mosaic``: "ab" side by side, "a;b" one above the other; ``layout`` as ``subplot_mosaic`` has
    it.
    """
    figure = HouseFigure(figsize=(width, height))
    named = figure.subplot_mosaic(mosaic, **layout)
    axes = [named[letter] for letter in sorted(named)]
    if len(axes) > 1:
        for letter, panel in zip("abcdef", axes, strict=False):
            panel.set_title(f"({letter})", loc="left")
    return figure, axes


def points(
    axes: Axes, x: Any, y: Any, series: int, label: str = "", error: Any = None, **look: Any
) -> ErrorbarContainer:
    """Draw what was found, with error bars: half-widths, or those below and above."""
    drawn = axes.errorbar(
        x, y, error, fmt=MARKERS[series], color=f"C{series}", elinewidth=0.7, zorder=2.5,
        label=label or None, **look,
    )  # fmt: skip
    drawn.lines[0].set_clip_on(not len(x))  # markers on an axis are drawn in full, bars end there
    return drawn


def marked(layers: int, series: int, of: int) -> slice:
    """Choose the layers that get a marker, of many only some; other ones in each ``of`` series."""
    step = -(-layers // MARKED)
    return slice(series * step // of, None, step)


def curve(axes: Axes, x: Array, y: Array, bulk: slice, series: int) -> None:
    """Draw a curve through the bulk, and a dash wherever beside it a place has its own value."""
    axes.plot(x[bulk], y[bulk], color=f"C{series}")
    for at in set(range(len(x))).difference(range(len(x))[bulk]):
        axes.plot(x[at], y[at], "_", color=f"C{series}", ms=7, mew=0.9, clip_on=False)


def label_logarithmic(axis: Axis) -> None:
    """Label 1, 2, 5, 10, … where powers of ten alone would say too little."""
    low, high = axis.get_view_interval()
    if high < 1000 * low:
        axis.set_major_locator(LogLocator(10, (1, 2, 5)))
        axis.set_major_formatter("{x:g}")
        axis.set_minor_formatter(NullFormatter())


def images(
    figure: Figure, name: str, title: str, command: str, kinds: Sequence[str]
) -> dict[str, bytes]:
    """Save it as "png", "svg" and "pdf", the same bytes each time: they hold no date."""
    about = {"Title": title, "Description": command}
    metadata: dict[str, dict[str, Any]] = {
        "png": about,
        "svg": {**about, "Date": None},
        "pdf": {"Title": title, "Subject": command, "CreationDate": None},
    }
    files = {}
    with house_style():
        for kind in kinds:
            file = io.BytesIO()
            figure.savefig(file, format=kind, metadata=metadata[kind])
            files[f"{name}.{kind}"] = file.getvalue()
    return files
