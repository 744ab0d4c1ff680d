"""One answer drawn, by quantity; of listed packings the first one. Lengths are in units of r."""

from collections.abc import Callable, Mapping
from math import sqrt

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from .. import closed_forms
from ..arithmetic.systems import FLOAT64, Array, as_floats
from ..lattice.branch import Branch, PerBranch, per_direction
from ..planning.plan import Plan
from ..quantities.base import first_order_std
from ..scene.sections import SceneError
from . import parts, style

Columns = Mapping[str, Array]


def of_first(columns: Columns) -> dict[str, Array]:
    """Give the rows of the first packing that is listed, numbers as float64."""
    rows = np.ones(len(next(iter(columns.values()))), dtype=bool)
    if "realisation" in columns:
        rows = columns["realisation"] == columns["realisation"][0]
    return {name: floats(column[rows]) for name, column in columns.items()}


def floats(column: Array) -> Array:
    """Round numbers of any arithmetic; leave words and whole numbers."""
    return as_floats(column) if column.dtype.kind in "Of" else column


def _axes(plan: Plan) -> tuple[float, float]:
    nx = float(plan.problem.n_x)
    return nx, sqrt(1 - nx * nx)


def _theory(plan: Plan) -> PerBranch[Array] | None:
    """Give σ_f of layers 0 … M − 1 to first order; None where no closed form applies."""
    found = first_order_std(plan.problem)
    if found is None:
        return None
    unit = plan.scene.load.magnitude
    rows = [np.array([float(v * unit) for v in layers]) for _, layers in found]
    return per_direction(rows)


def contact_forces(plan: Plan, columns: Columns, errors: Columns) -> Figure:
    """Draw force chains on the ordered lattice: a line as thick as the force of its contact.

    Of an ensemble, which has no one packing, lines are as thick as σ_f.
    """
    rows = of_first(columns)
    forces = rows["force"] if "force" in rows else rows["std"]
    ends = _contacts(plan, rows)
    figure = style.figure(style.PAGE, height_of(ends))
    axes = figure.subplots()
    chains(axes, plan, ends, forces)
    size, what = np.abs(forces), "f" if "force" in rows else r"\sigma_f"
    shown = [(size.mean(), f"mean, ${what}={size.mean():.3g}$")]
    shown.append((forces.max(), f"largest, ${what}={forces.max():.3g}$"))
    if forces.min() < 0:
        shown.append((forces.min(), f"pulling, ${what}={forces.min():.3g}$ at most"))
    keys = parts.chain_keys(forces, shown)
    figure.legend(handles=keys, loc="outside lower center", ncols=3)
    return figure


def _contacts(plan: Plan, rows: Mapping[str, Array]) -> Array:
    """Give both ends of contacts, (contacts, 2, 2); periodic ones leave the strip at its edges."""
    nx, ny = _axes(plan)
    side = np.array([Branch(branch).side for branch in rows["branch"]])
    i, j = _unwrapped(plan, rows["i"]), rows["j"]
    low = np.stack([2 * nx * i, 2 * ny * j], axis=-1)
    high = np.stack([2 * nx * (i + side), 2 * ny * (j + 1)], axis=-1)
    return np.stack([low, high], axis=1)


def _unwrapped(plan: Plan, i: Array) -> Array:
    """Give columns of a cone that may cross the edge of a periodic packing, nearest to its apex."""
    at, width = plan.scene.load.at, plan.problem.width
    if at is None or width is None:
        return i
    return np.asarray(i + 2 * width * np.rint((int(at[0]) - i) / (2 * width)))


def chains(axes: Axes, plan: Plan, ends: Array, forces: Array, top: float | None = None) -> None:
    """Draw lines between the ends of contacts, and the load; ``top`` is where the surface lies."""
    _, ny = _axes(plan)
    parts.force_chains(axes, ends, forces)
    left, right = ends[..., 0].min(), ends[..., 0].max()
    load = plan.scene.load
    surface = 2 * ny * plan.problem.height if top is None else top
    room = 1.0
    if load.kind == "surface":
        parts.surface_load(axes, left, right, surface)
        room = 5.0
    elif load.at is not None:
        x, own = _apex(plan)
        if top is None:
            surface = own
        parts.point_load(axes, x, surface)
        room = 10.0
        axes.plot([left, right], [-0.9, -0.9], color="black", lw=1)
    axes.set_xlim(left - 1, right + 1)
    axes.set_ylim(-1.5, max(surface, ends[..., 1].max()) + room)
    axes.set_aspect("equal")
    axes.axis("off")


def _apex(plan: Plan) -> tuple[float, float]:
    """Give the ordered centre of the loaded bead."""
    nx, ny = _axes(plan)
    assert plan.scene.load.at is not None
    i, j = map(int, plan.scene.load.at)
    return 2 * nx * i, 2 * ny * j


def height_of(points: Array) -> float:
    """Give the height of a figure that is a page wide, in inches."""
    wide, high = np.ptp(points.reshape(-1, 2), axis=0)
    return float(np.clip(style.PAGE * (high + 8) / (wide + 2) + 0.3, 1.6, 8))


def positions(plan: Plan, columns: Columns, errors: Columns) -> Figure:
    """Draw the beads where they lie, each with its radius, as dark as it is displaced."""
    rows = of_first(columns)
    sites = list(zip(rows["i"].tolist(), rows["j"].tolist(), strict=True))
    unit = float(plan.scene.packing.radius)
    with FLOAT64.active():
        radii = unit * (1 + plan.problem.radii.at(sites, 0, FLOAT64))
    points = np.stack([rows["x"], rows["y"]], axis=-1)
    figure = style.figure(style.PAGE, height_of(points / unit) + 0.4)
    axes = figure.subplots()
    circles = list(zip(rows["x"].tolist(), rows["y"].tolist(), radii.tolist(), strict=True))
    away = np.hypot(rows["dx"], rows["dy"])
    beads = parts.discs(axes, circles, away)
    beads.set_clim(0, 1.15 * (away.max() or 1))
    axes.set_aspect("equal")
    axes.autoscale_view()
    axes.set_xlabel("$x$")
    axes.set_ylabel("$y$")
    name = r"displacement $(\delta x^2+\delta y^2)^{1/2}$"
    figure.colorbar(beads, ax=axes, location="bottom", shrink=0.6, aspect=30, label=name)
    return figure


def profile(plan: Plan, columns: Columns, errors: Columns) -> Figure:
    """Draw σ_f over the relative height, with its standard errors, beside Eq. 13 or 14."""
    figure = style.figure(style.COLUMN, 2.8)
    axes = figure.subplots()
    M, theory = plan.problem.height, _theory(plan)
    branch, z, std = columns["branch"], columns["j"] / M, floats(columns["std"])
    layers = np.arange(M) / M
    if theory is not None and plan.problem.load.angle_deg:
        for dashes, (own, exact) in zip("-:", theory, strict=True):
            axes.plot(layers, exact, dashes, color="0.35", label=f"exact at finite $M$, $f^{own}$")
    elif theory is not None:
        axes.plot(layers, theory.plus, color="0.35", label="exact at finite $M$")
    if theory is not None and not plan.problem.load.angle_deg and plan.problem.dimension == 2:
        number = 14 if plan.problem.load.kind == "bulk" else 13
        name = f"Eq. ({number}), printed"
        axes.plot(layers, theory.plus * _printed_over_exact(plan), "--", color="black", label=name)
    for number, own in enumerate(plan.quantity.branches):
        rows = branch == own
        error = errors["std"][rows] if "std" in errors else None
        colour, marker = style.series(number)
        axes.errorbar(
            z[rows], std[rows], error, fmt=marker, color=colour, mfc="white", ms=3.4, mew=0.7,
            elinewidth=0.7, label=f"simulated, $f^{own}$", clip_on=False,
        )  # fmt: skip
    axes.set_xlim(0, 1)
    axes.set_ylim(0, None)
    axes.set_xlabel("relative height $z=j/M$")
    axes.set_ylabel(
        r"$\sigma_f$" if plan.problem.load.loaded is None else r"$\sigma$ of the change"
    )
    axes.legend(loc="best")
    return figure


def _printed_over_exact(plan: Plan) -> Array:
    """Give σ_f of the printed Eq. 13 or 14 over the exact one, by layer 0 … M − 1."""
    M, phi = plan.problem.height, float(1 - 2 * plan.problem.n_x**2)
    bulk = plan.problem.load.kind == "bulk"
    printed = closed_forms.bulk_diffusion if bulk else closed_forms.surface_diffusion
    exact = closed_forms.bulk_variance if bulk else closed_forms.surface_variance
    ratios = [printed(M, j / M, phi, 1, 1) / exact(M, j, phi, 1, 1) for j in range(M)]
    return np.sqrt(ratios)


def histogram(plan: Plan, columns: Columns, errors: Columns) -> Figure:
    """Draw P of the changes, with the Gaussian of theory where there is one.

    All contacts together have a Gaussian a layer. Errors are drawn where they are known: of one
    contact, or of an ensemble.
    """
    figure = style.figure(style.COLUMN, 2.8)
    axes = figure.subplots()
    known, contact = _theory(plan), plan.problem.contact
    asked = slice(None) if plan.scene.ask.layers is None else list(plan.scene.ask.layers)
    theory = None if known is None else np.concatenate([rows[asked] for _, rows in known])
    if known is not None and contact is not None:
        theory = known[contact.branch][[contact.j]]
    unit = 1.0
    if theory is not None:
        largest = float(theory.max())  # squares of small ones are below what a float holds
        unit = largest * sqrt(float(((theory / largest) ** 2).mean()))
    inside = np.isfinite(columns["low"]) & np.isfinite(columns["high"])
    low, high = columns["low"][inside] / unit, columns["high"][inside] / unit
    count = columns["count"]
    error = columns.get("share_error")
    if error is None and contact is not None:  # one a packing: these are independent
        error = np.sqrt(count) / count.sum()
    some = count[inside] > 0
    width = high - low
    with np.errstate(all="ignore"):
        density = (count[inside] / count.sum() / width)[some]
    if not np.isfinite(density).all():
        allowed = "has no density to be drawn: all changes are alike, or nearly"
        raise SceneError("ask.quantity", plan.quantity.name, allowed)
    parts.densities(
        axes,
        ((low + high) / 2)[some],
        density,
        None if error is None else (error[inside] / width)[some],
        style.series(0),
        "simulated",
    )
    if theory is not None:
        v = np.linspace(low[0], high[-1], 321)
        ratio = (theory / unit)[:, None]
        gauss = np.exp(-((v / ratio) ** 2) / 2) / ratio / sqrt(2 * np.pi)
        name = "Gaussian of theory" if contact is not None else "theory: a Gaussian a layer"
        axes.plot(v, gauss.mean(axis=0), color="black", lw=1.0, label=name)
        axes.set_ylim(0.3 / count.sum() / width.max(), None)
    own = r"\sigma_f" if contact is not None else r"\sigma"
    change = r"f-f^{\rm ordered}"
    axes.set_xlabel(f"$({change})\\,/\\,{own}$" if unit != 1 else f"${change}$")
    axes.set_ylabel(f"${own}\\,P$" if unit != 1 else "$P$")
    axes.legend(loc="lower center")
    return figure


def response(plan: Plan, columns: Columns, errors: Columns) -> Figure:
    """Draw p, the vertical force that a bead gets from both its upper contacts, and the contacts.

    Of one packing these are as thick as their force, of several as σ of it; p is the mean then.
    """
    one = "vertical" in columns
    rows = {name: floats(column) for name, column in columns.items()}
    rows["i"] = _unwrapped(plan, rows["i"])
    vertical = rows["vertical" if one else "vertical_mean"]
    found: dict[tuple[int, int], float] = {}
    for i, j, own in zip(rows["i"].tolist(), rows["j"].tolist(), vertical.tolist(), strict=True):
        found[int(i), int(j)] = found.get((int(i), int(j)), 0.0) + own
    nx, ny = _axes(plan)
    figure = style.figure(style.PAGE, 2.9)
    left, right = figure.subplots(1, 2)
    parts.cone(
        left,
        [(2 * nx * i, 2 * ny * j) for i, j in found],
        np.array(list(found.values())),
        _apex(plan),
        r"$p\,/\,f^{\rm load}$" if one else r"$\langle p\rangle\,/\,f^{\rm load}$",
        "bottom",
        max(found.values()),
    )
    forces = rows["force" if one else "force_std"]
    chains(right, plan, _contacts(plan, rows), forces)
    what = "f" if one else r"\sigma_f"
    shown = [(forces.max(), f"largest, ${what}={forces.max():.3g}$")]
    if forces.min() < 0:
        shown.append((forces.min(), f"pulling, ${what}={forces.min():.3g}$ at most"))
    keys = parts.chain_keys(forces, shown)
    right.legend(handles=keys, loc="upper center", bbox_to_anchor=(0.5, 0), ncols=2)
    style.letter((left, right))
    return figure


def base_reactions(plan: Plan, columns: Columns, errors: Columns) -> Figure:
    """Draw what the base bears along it: forces above, their changes below."""
    rows = of_first(columns)
    figure = style.figure(style.COLUMN, 3.6)
    above, below = figure.subplots(2, 1, sharex=True)
    for axes, names in ((above, ("fx", "fy")), (below, ("change_x", "change_y"))):
        for number, (name, symbol) in enumerate(zip(names, "xy", strict=True)):
            colour, marker = style.series(number)
            axes.plot(
                rows["i"], rows[name], marker, color=colour, mfc="white", ms=3.2, mew=0.7,
                label=f"${symbol}$",
            )  # fmt: skip
    above.set_ylabel("reaction of the base")
    below.set_ylabel("its change")
    below.set_xlabel("bead $i$ of the base")
    handles, names = above.get_legend_handles_labels()
    figure.legend(handles, names, loc="outside upper right", ncols=2)
    return figure


DRAWN: dict[str, Callable[[Plan, Columns, Columns], Figure]] = {
    "contact_forces": contact_forces,
    "positions": positions,
    "profile": profile,
    "histogram": histogram,
    "response": response,
    "base_reactions": base_reactions,
}
