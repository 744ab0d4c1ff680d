"""How all figures look, and how they become files, the same bytes whenever they are made.

Widths are those of a journal: one column or two. Colours (Okabe and Ito's palette) can be told
apart by the colour-blind, and each comes with its own marker or line style, for print in grey.
Fonts are those that matplotlib brings along. Needs matplotlib (the extra ``plots``).
"""

import io
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import Any

import matplotlib as mpl
from matplotlib.axes import Axes
from matplotlib.backend_bases import RendererBase
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from PIL import Image
from PIL.PngImagePlugin import PngInfo

COLUMN, PAGE = 3.4, 7.0  # inches
DPI = 300
BLUE, VERMILLION, GREEN, PURPLE, ORANGE, SKY = (
    "#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9",
)  # fmt: skip
_COLOURS = (BLUE, VERMILLION, GREEN, PURPLE, ORANGE, SKY)
_MARKERS = ("o", "s", "^", "D", "v", "P")
_RC: dict[Any, Any] = {
    "font.family": "STIXGeneral",
    "mathtext.fontset": "stix",
    "font.size": 8,
    "axes.labelsize": 8.5,
    "axes.titlesize": 8.5,
    "legend.fontsize": 7.5,
    "xtick.labelsize": 7.5,
    "ytick.labelsize": 7.5,
    "axes.linewidth": 0.6,
    "lines.linewidth": 1.0,
    "xtick.direction": "in",
    "ytick.direction": "in",
    "xtick.top": True,
    "ytick.right": True,
    "xtick.major.width": 0.6,
    "ytick.major.width": 0.6,
    "xtick.major.size": 3,
    "ytick.major.size": 3,
    "legend.frameon": False,
    "legend.handlelength": 1.8,
    "legend.labelspacing": 0.3,
    "legend.borderaxespad": 0.6,
    "axes.unicode_minus": True,
    "savefig.dpi": DPI,
    "svg.hashsalt": "force-diffusion",
    "pdf.fonttype": 42,
}


def series(number: int) -> tuple[str, str]:
    """Give colour and marker of the n-th series."""
    return _COLOURS[number % len(_COLOURS)], _MARKERS[number % len(_MARKERS)]


@contextmanager
def house_style() -> Iterator[None]:
    """Leave out what a user's own matplotlibrc says."""
    defaults = dict[Any, Any](mpl.rcParamsDefault)
    for key in [key for key in defaults if key.startswith("backend")]:
        del defaults[key]
    with mpl.rc_context(defaults | _RC):
        yield


class HouseFigure(Figure):
    """A figure that looks the same wherever it is drawn later, and shows itself in a notebook."""

    def draw(self, renderer: RendererBase) -> None:
        """Draw it in the house style."""
        with house_style():
            super().draw(renderer)

    def _repr_png_(self) -> bytes:
        painted = io.BytesIO()
        self.savefig(painted, format="png", dpi=DPI / 2)
        return painted.getvalue()


def figure(width: float, height: float) -> Figure:
    """Start a figure; sizes in inches."""
    made = HouseFigure(figsize=(width, height), layout="constrained")
    FigureCanvasAgg(made)
    return made


def letter(panels: Sequence[Axes]) -> None:
    """Name panels (a), (b), … above their upper left corners."""
    for axes, name in zip(panels, "abcdef", strict=False):
        axes.set_title(f"({name})", loc="left", pad=4)


def images(
    draw: Callable[[], Figure], name: str, title: str, command: str, kinds: Sequence[str]
) -> dict[str, bytes]:
    """Draw it as "png", "svg" and "pdf"; each holds the command, none a date."""
    about = {"Title": title, "Description": command}
    metadata: dict[str, dict[str, Any]] = {
        "svg": {**about, "Date": None},
        "pdf": {"Title": title, "Subject": command, "CreationDate": None},
    }
    files = {}
    with house_style():
        drawn = draw()
        drawn.set_dpi(DPI)
        drawn.draw_without_rendering()  # finds the place of every panel,
        drawn.set_layout_engine(None)  # the same in all files
        for kind in kinds:
            file = io.BytesIO()
            if kind == "png":
                _png(drawn, about, file)
            else:
                drawn.savefig(file, format=kind, metadata=metadata[kind])
            files[f"{name}.{kind}"] = file.getvalue()
    return files


def _png(drawn: Figure, about: dict[str, str], file: io.BytesIO) -> None:
    """Lines and letters have few colours: a palette makes the file a third as large."""
    painted = io.BytesIO()
    drawn.savefig(painted, format="rgba")
    size = drawn.canvas.get_width_height()  # with the dots per inch of ``images``
    words = PngInfo()
    for key, value in about.items():
        words.add_text(key, value)
    image = Image.frombytes("RGBA", size, painted.getvalue()).convert("RGB")
    image = image.quantize(256, dither=Image.Dither.NONE)
    image.save(file, format="png", optimize=True, pnginfo=words, dpi=(DPI, DPI))
