"""An answer under unilateral contacts drawn, by quantity; of several packings the first one."""

from collections.abc import Callable, Sequence
from functools import partial

import numpy as np
from matplotlib.figure import Figure

from ..arithmetic.systems import as_floats
from ..planning.plan import Plan
from ..unilateral.network import Network
from . import parts, style
from .answers_drawing import Columns, chains, floats, height_of, of_first, positions

Drawing = Callable[[Plan, Columns, Columns], Figure]


def contact_forces(network: Network, plan: Plan, columns: Columns, errors: Columns) -> Figure:
    """Draw force chains between beads where they rest: a line as thick as the force."""
    x, period = as_floats(network.x), float(network.frame.period)
    low, high = x[network.pairs[:, 1]], x[network.pairs[:, 0]]
    high[:, 0] -= period * np.round((high[:, 0] - low[:, 0]) / period)
    forces = as_floats(network.forces) * float(plan.scene.load.magnitude)
    ends = np.stack([low, high], axis=1)
    figure = style.figure(style.PAGE, height_of(ends))
    axes = figure.subplots()
    chains(axes, plan, ends, forces, float(x[:, 1].max()))
    shown = [
        (forces.mean(), f"mean, $f={forces.mean():.3g}$"),
        (forces.max(), f"largest, $f={forces.max():.3g}$"),
    ]
    keys = parts.chain_keys(forces, shown)
    figure.legend(handles=keys, loc="outside lower center", ncols=2)
    return figure


def profile(plan: Plan, columns: Columns, errors: Columns) -> Figure:
    """Draw σ_f and ⟨f⟩ over the relative height, with standard errors."""
    figure = style.figure(style.COLUMN, 2.8)
    axes = figure.subplots()
    z = columns["j"] / plan.problem.height
    for number, (name, symbol) in enumerate((("std", r"$\sigma_f$"), ("mean", r"$⟨f⟩$"))):
        colour, marker = style.series(number)
        axes.errorbar(
            z, floats(columns[name]), columns.get(f"{name}_error"), fmt=marker, color=colour,
            mfc="white", ms=3.4, mew=0.7, elinewidth=0.7, label=symbol, clip_on=False,
        )  # fmt: skip
    axes.set_xlim(0, 1)
    axes.set_ylim(0, None)
    axes.set_xlabel("relative height $z=j/M$")
    axes.set_ylabel("force")
    axes.legend(loc="best")
    return figure


def histogram(plan: Plan, columns: Columns, errors: Columns) -> Figure:
    """Draw P(f), with errors where they are known: of an ensemble."""
    figure = style.figure(style.COLUMN, 2.8)
    axes = figure.subplots()
    some = np.isfinite(columns["low"]) & np.isfinite(columns["high"]) & (columns["count"] > 0)
    low, high = columns["low"][some], columns["high"][some]
    error = columns.get("share_error")
    width = high - low
    parts.densities(
        axes,
        (low + high) / 2,
        columns["count"][some] / columns["count"].sum() / width,
        None if error is None else error[some] / width,
        style.series(0),
        "simulated",
    )
    axes.set_xlabel("$f$")
    axes.set_ylabel("$P$")
    return figure


def base_reactions(plan: Plan, columns: Columns, errors: Columns) -> Figure:
    """Draw what the base bears along it."""
    rows = of_first(columns)
    figure = style.figure(style.COLUMN, 2.4)
    axes = figure.subplots()
    for number, name in enumerate("xy"):
        colour, marker = style.series(number)
        axes.plot(
            rows["i"], rows[f"f{name}"], marker, color=colour, mfc="white", ms=3.2, mew=0.7,
            label=f"${name}$",
        )  # fmt: skip
    axes.set_xlabel("bead $i$ of the base")
    axes.set_ylabel("reaction of the base")
    axes.legend(loc="best")
    return figure


def drawn(quantity: str, networks: Sequence[Network]) -> Drawing | None:
    """Give what draws a quantity; None where it has no figure."""
    if networks and quantity in ("contact_forces", "response"):
        return partial(contact_forces, networks[0])
    return {
        "positions": positions,
        "profile": profile,
        "histogram": histogram,
        "base_reactions": base_reactions,
    }.get(quantity)
