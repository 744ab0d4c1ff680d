"""Figure 3 drawn: simulation, exact finite-M curves and the printed curve; below, their ratio."""

import math

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from .. import closed_forms
from . import style
from .comparison import LEVEL, NOTEWORTHY, Comparison, Height
from .models.q_model import weight_variance


def draw(data: Comparison) -> Figure:
    """Draw simulation, exact finite-M curves and the printed curve, scaled by M^(3/2)."""
    columns = 2 if data.q_model else 1
    figure = style.figure(style.PAGE if data.q_model else style.COLUMN, 3.5)
    grid = figure.add_gridspec(2, columns, height_ratios=(2.6, 1))
    top, ratio = figure.add_subplot(grid[0, 0]), figure.add_subplot(grid[1, 0])
    _theory_and_simulation(top, data)
    _ratio(ratio, data)
    if data.q_model:
        beside = figure.add_subplot(grid[:, 1])
        _shapes(beside, data)
        style.letter((top, beside))
    return figure


def _theory_and_simulation(axes: Axes, data: Comparison) -> None:
    z = np.linspace(0, 1, 201)
    phi, std = float(data.medium.phi), data.medium.std
    one_layer = [closed_forms.surface_diffusion(1, v, phi, std, 1.0) for v in z]
    power = -math.floor(math.log10(std))
    scale = 10.0**power
    axes.plot(z, scale * np.sqrt(one_layer), "--", color="black", label="Eq. (13), printed")
    handles: list[Artist] = [style.line("black", "--", "Eq. (13), printed")]
    handles.append(style.line("0.35", "-", "exact at finite $M$"))
    for number, one in enumerate(data.heights):
        colour, marker = style.series(number)
        by = scale * one.height**-1.5
        axes.plot(one.z, by * one.exact, color=colour, lw=0.9)
        low, high = one.band.limits
        axes.fill_between(one.z, by * low, by * high, color=colour, alpha=0.25, lw=0)
        if one.height == 1:  # of a single layer neither a curve nor a band would show
            axes.vlines(one.z, by * low, by * high, color=colour, lw=0.7)
            axes.plot(one.z, by * one.exact, "_", color=colour, ms=7, mew=0.9)
        if np.abs(np.expm1(one.correction.log)).max() > NOTEWORTHY:
            axes.plot(one.z, by * one.corrected, ":", color=colour, lw=0.9)
        some = _some(one, number)
        (points,) = axes.plot(
            one.z[some], by * np.exp(one.band.estimate.log)[some], marker, color=colour,
            markerfacecolor="white", ms=3.4, mew=0.7, clip_on=False,
            label=f"simulated, $M={one.height}$",
        )  # fmt: skip
        handles.append(points)
    handles.append(style.shade("0.35", f"{LEVEL:.0%} band"))
    axes.set_xlim(0, 1)
    axes.set_ylim(0, None)
    axes.tick_params(labelbottom=False)
    axes.set_ylabel(rf"$10^{{{power}}}\,M^{{-3/2}}\,\sigma_f/\langle f\rangle$")
    axes.legend(handles=handles, loc="lower left")


def _some(one: Height, number: int) -> slice:
    """Choose the layers that get a marker, other ones for each height."""
    step = -(-one.height // 16)
    return slice(number * step // 3, None, step)


def _ratio(axes: Axes, data: Comparison) -> None:
    """Draw simulation over exact finite-M theory: all of a band has to hold the zero line."""
    axes.axhline(0, color="0.35", lw=0.8)
    widest = 0.0
    for number, one in enumerate(data.heights):
        colour, marker = style.series(number)
        low, high = (100 * (edge / one.exact - 1) for edge in one.band.limits)
        off = 100 * (np.exp(one.band.estimate.log) / one.exact - 1)
        widest = max(widest, float(np.abs(low).max()), float(np.abs(high).max()))
        axes.fill_between(one.z, low, high, color=colour, alpha=0.18, lw=0)
        for edge in (low, high):
            axes.plot(one.z, edge, color=colour, lw=0.5)
        if one.height == 1:
            axes.vlines(one.z, low, high, color=colour, lw=0.7)
        some = _some(one, number)
        axes.plot(
            one.z[some],
            off[some],
            marker,
            color=colour,
            mfc="white",
            ms=2.6,
            mew=0.6,
            clip_on=False,
        )
    axes.set_xlim(0, 1)
    axes.set_ylim(-1.15 * widest, 1.15 * widest)
    axes.set_xlabel("relative height $z=j/M$")
    axes.set_ylabel(r"sim./exact $-\,1$ (%)")


def _shapes(axes: Axes, data: Comparison) -> None:
    z = np.linspace(0, 1, 201)
    axes.plot(z, np.sqrt((1 - z) ** 2 * (2 * z + 1)), color="black", label="Eq. (13), printed")
    axes.plot(z, np.sqrt(1 - z), color="0.45", ls=(0, (1, 1.2)), label=r"Brownian, $\sqrt{1-z}$")
    for number, one in enumerate(data.heights):
        colour, marker = style.series(number)
        std = np.sqrt(weight_variance(one.height))
        depth = np.arange(one.height + 1)
        axes.plot(
            1 - depth / one.height, std / std[-1], color=colour, lw=0.8, marker=marker,
            ms=2.8, mew=0.6, markerfacecolor="white", markevery=max(1, one.height // 16),
            label=f"$q$-model, $M={one.height}$",
        )  # fmt: skip
    axes.set_xlim(0, 1)
    axes.set_ylim(0, 1.04)
    axes.set_xlabel("relative height $z=j/M$")
    axes.set_ylabel(r"$\sigma(z)\,/\,\sigma(0)$")
    axes.legend(loc="lower left")
