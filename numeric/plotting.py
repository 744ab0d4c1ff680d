"""What all plots share: a figure without a display, powers of ten on an axis, files as bytes.

Needs matplotlib (the extra ``plots``); only modules that draw import this one.
"""

import io
import math
from collections.abc import Sequence

from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.ticker import FixedLocator, FuncFormatter
from PIL import Image
from PIL.PngImagePlugin import PngInfo


def new_figure(width: float, height: float) -> Figure:
    """Make a figure of so many inches that can be drawn without a display."""
    figure = Figure(figsize=(width, height))
    FigureCanvasAgg(figure)
    return figure


def saved(figure: Figure, stem: str, title: str, command: str) -> dict[str, str | bytes]:
    """Give ``stem``.png and ``stem``.svg; both hold the command that reproduces them.

    Lines and letters have few colours: a palette makes the PNG a third as large.
    """
    drawn, png, svg = io.BytesIO(), io.BytesIO(), io.BytesIO()
    about = {"Title": title, "Description": command}
    figure.savefig(drawn, format="png", dpi=150)
    words = PngInfo()
    for key, value in about.items():
        words.add_text(key, value)
    image = Image.open(drawn).convert("RGB").quantize(256, dither=Image.Dither.NONE)
    image.save(png, format="png", optimize=True, pnginfo=words, dpi=(150, 150))
    figure.savefig(svg, format="svg", metadata={**about, "Date": None})
    return {f"{stem}.png": png.getvalue(), f"{stem}.svg": svg.getvalue()}


def powers_of_ten(axes: Axes, axis: str, values: Sequence[float], room: float) -> None:
    """Fit the axis "x" or "y" to values of log10, and mark whole powers of ten.

    ``room`` is left at both ends, as a share of the span. Logarithms, because what is drawn may lie
    beyond a float's range.
    """
    low, high = min(values), max(values)
    more = max((high - low) * room, 0.3)
    low, high = low - more, high + more
    getattr(axes, f"set_{axis}lim")(low, high)
    step = max(1, math.ceil((high - low) / 8))
    step = next((s for s in (1, 2, 5, 10, 20, 50, 100) if s >= step), step)
    ticks = range(math.ceil(low / step) * step, math.floor(high) + 1, step)
    part = getattr(axes, f"{axis}axis")
    part.set_major_locator(FixedLocator(list(ticks)))
    part.set_major_formatter(FuncFormatter(lambda power, _: f"$10^{{{power:.0f}}}$"))
