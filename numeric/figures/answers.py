"""Figures of one answer, of a run or an ensemble, by quantity; of listed packings the first one.

Lengths are in units of r. Importing this module raises ``MissingLibraryError`` where there is no
matplotlib (the extra ``plots``).
"""

from . import style  # first: it says what to install

# isort: split
from collections.abc import Mapping
from math import ceil, cos, radians, sin, sqrt
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ..arithmetic.systems import FLOAT64, Array, as_floats
from ..lattice.branch import Branch
from ..lattice.layers import Rows
from ..mechanics.problem import ordered_places
from ..planning.plan import Plan
from ..quantities.base import first_order_std
from ..scene.scene import refuse
from ..scene.sections import SceneError
from ..theory.expected import leading_stds, stds_by_layer
from ..unilateral.network import Network
from . import beads

Columns = Mapping[str, Array]
# Columns of contacts, which are drawn on the lattice.
PLACES = {"x", "y", "upper_x", "upper_y"}
# Numbers that are drawn: floats hold their sums, and the shares that they have of each other.
LEAST, MOST = 1e-300, 1e280
NESTED = 0.66
"""By so much markers that may lie on each other are smaller than the last ones."""


def figure_of(
    plan: Plan, columns: Columns, errors: Columns, network: Network | None = None
) -> Figure:
    """Draw an answer; ``columns`` are those of its table, ``errors`` standard errors of some.

    ``network``: where beads came to rest under unilateral contacts.

    Raises ``SceneError`` for a quantity that has no figure, for an answer of no rows, or for
    numbers beyond what floats can draw.
    """
    refuse("figures", plan.scene)
    if not len(next(iter(columns.values()), [])):
        raise SceneError("ask.quantity", plan.quantity.name, "the answer has no rows to be drawn")
    _check_sizes(plan, columns)
    with style.house_style():
        return DRAWN[plan.quantity.name](plan, columns, errors, network)


def contacts_of(
    plan: Plan,
    ends: Array,
    forces: Array,
    surface: Array,
    *,
    axes: Axes | None = None,
    values: Array | None = None,
    label: str = "",
) -> Axes:
    """Draw the contacts of a packing where they are, on ``axes`` or on a page of their own.

    They lie between ``ends``, (contacts, 2, 2), and are as thick as ``forces``; ``surface``: the
    beads of the surface, (W, 2). ``values``, (contacts,), colour them, under a bar with their
    ``label``; without any a page has a legend. Raises ``SceneError`` for numbers beyond what floats
    can draw.
    """
    _check_sizes(plan, {"force": forces})
    with style.house_style():
        shown = [] if axes is not None else named(forces, "f")
        if axes is None:
            _, (axes,) = style.panels("a", style.PAGE, height_of(ends))
        if values is not None:
            beads.draw_coloured(axes, ends, forces, values, label)
        else:
            beads.draw_chains(axes, ends, forces, shown)
        surroundings(axes, plan, ends, surface)
    return axes


def _check_sizes(plan: Plan, columns: Columns) -> None:
    """Raise ``SceneError`` for numbers beyond what floats can draw."""
    for name, values in columns.items():
        if values.dtype.kind not in "fO" or (name in PLACES and plan.quantity.name != "positions"):
            continue
        sizes, exact = np.abs(as_floats(values)), values.dtype == object
        if not exact:  # NaN says that something is not known
            sizes = sizes[np.isfinite(sizes)]
        largest = sizes.max(initial=0)
        vanished = not largest and (name == "high" or (exact and any(v != 0 for v in values)))
        if vanished or 0 < largest < LEAST or not largest <= MOST:
            unit, key = plan.scene.load.magnitude, "load.magnitude"
            if plan.quantity.name == "positions":
                unit, key = plan.scene.packing.radius, "packing.radius"
            allowed = f"what is drawn must lie between {LEAST:g} and {MOST:g}: choose another unit"
            raise SceneError(key, unit, allowed)


def floats(column: Array) -> Array:
    """Round numbers of any arithmetic; leave words and whole numbers."""
    return as_floats(column) if column.dtype.kind in "Of" else column


def of_first(columns: Columns) -> dict[str, Array]:
    """Give the rows of the first packing that is listed, numbers as float64."""
    rows: Any = ...
    if "realisation" in columns:
        rows = columns["realisation"] == columns["realisation"][0]
    return {name: floats(column[rows]) for name, column in columns.items()}


def ordered(plan: Plan, i: Any, j: Any) -> Array:
    """Give ordered centres of beads, (beads, 2)."""
    return np.stack(ordered_places((np.asarray(i), np.asarray(j)), plan.problem, FLOAT64), axis=-1)


def theory(plan: Plan) -> Array | None:
    """Give σ_f to first order, (directions, M); None where no closed form applies."""
    branches, M = plan.quantity.branches, plan.problem.height
    stds = first_order_std(plan.problem, ((j, own) for own in branches for j in range(M)))
    if stds is None:
        return None
    return as_floats(stds * plan.scene.load.magnitude).reshape(-1, M)


def contact_forces(
    plan: Plan, columns: Columns, errors: Columns, network: Network | None
) -> Figure:
    """Draw force chains on the ordered lattice: a line as thick as the force of its contact.

    Of an ensemble, which has no one packing, lines are as thick as σ_f. Under unilateral contacts
    they lie where the beads rest.
    """
    rows, surface = of_first(columns), None
    forces, what = rows["force" if "force" in rows else "std"], "f"
    if network is not None:
        places = [rows[name] for name in ("x", "y", "upper_x", "upper_y")]
        ends = np.stack(places, axis=1).reshape(-1, 2, 2) / float(plan.scene.packing.radius)
        surface = as_floats(network.x[-network.width :])
    else:
        ends, what = contacts(plan, rows), "f" if "force" in rows else r"\sigma_f"
    figure, (axes,) = style.panels("a", style.PAGE, height_of(ends))
    beads.draw_chains(axes, ends, forces, named(forces, what))
    surroundings(axes, plan, ends, surface)
    return figure


def contacts(plan: Plan, rows: Columns) -> Array:
    """Give both ends of contacts, (contacts, 2, 2); periodic ones leave the strip at its edges."""
    side = np.array([Branch(branch).side for branch in rows["branch"]])
    i, j = unwrapped(plan, rows["i"]), rows["j"]
    return np.stack([ordered(plan, i, j), ordered(plan, i + side, j + 1)], axis=1)


def unwrapped(plan: Plan, i: Array) -> Array:
    """Give columns of a cone that may cross the edge of a periodic packing, nearest to its apex."""
    at, width = plan.scene.load.at, plan.problem.width
    if at is None or width is None:
        return i
    return np.asarray(i + 2 * width * np.rint((int(at[0]) - i) / (2 * width)))


def surroundings(axes: Axes, plan: Plan, ends: Array, surface: Array | None = None) -> None:
    """Draw the base and the load around contacts, and nothing else beside these.

    ``surface``: the beads of the surface where they rest, (W, 2); else they are on the lattice.
    """
    (left, low), (right, top) = ends.min(axis=(0, 1)), ends.max(axis=(0, 1))
    load, M = plan.scene.load, plan.problem.height
    if low < 2:  # else layers further below are left out
        beads.draw_base(axes, left, right)
    if load.at is not None:
        bead = apex(plan)
        if surface is not None:
            bead[1] = surface[:, 1].max()
        beads.draw_point_load(axes, bead, along(plan))
        top = max(top, bead[1]) + 10
    elif load.kind == "surface":
        if surface is None:
            step = 2 * float(plan.problem.n_x)
            i = np.arange(ceil(left / step), right / step + beads.EQUAL)
            i = i[(i - M) % 2 == 0]
            surface = ordered(plan, i, np.full(len(i), M))
        beads.draw_surface_load(axes, surface, along(plan))
        top = max(top, surface[:, 1].max()) + 5
    beads.bare(axes, left - 1, right + 1, low - 1.5, top + 1)


def named(forces: Array, what: str) -> list[tuple[float, str]]:
    """Choose the forces that the legend shows, and name them."""
    mean, largest, smallest = (float(v) for v in (forces.mean(), forces.max(), forces.min()))
    if beads.alike(forces):
        if largest - smallest < beads.EQUAL * largest:
            return [(mean, f"all, ${what}={mean:.3g}$")]
        return [(mean, f"mean, ${what}={mean:.3g}$"), *beads.extremes(forces, mean)]
    size = float(np.abs(forces).mean())
    shown = [(size, f"mean, ${what}={size:.3g}$"), (largest, f"largest, ${what}={largest:.3g}$")]
    if smallest < 0:
        shown.append((smallest, f"pulling, ${what}={smallest:.3g}$ at most"))
    return shown


def apex(plan: Plan) -> Array:
    """Give the ordered centre of the loaded bead, (2,)."""
    assert plan.scene.load.at is not None
    return np.array(ordered(plan, *map(int, plan.scene.load.at)), float)


def along(plan: Plan) -> Array:
    """Give the direction of the load, (2,)."""
    angle = radians(plan.problem.load.angle_deg)
    return np.array([sin(angle), -cos(angle)])


def height_of(places: Array) -> float:
    """Give the height of a figure that is a page wide, in inches."""
    wide, high = np.ptp(places.reshape(-1, 2), axis=0)
    return float(np.clip(style.PAGE * (high + 8) / (wide + 2) + 0.3, 1.6, 8))


def positions(plan: Plan, columns: Columns, errors: Columns, network: Network | None) -> Figure:
    """Draw the beads where they lie, each with its radius, as dark as it is displaced."""
    rows = of_first(columns)
    places = plan.problem.region.rows
    if plan.scene.ask.at is not None:
        places = Rows(rows["i"], [1], int(rows["j"][0]))
    with FLOAT64.active():
        radii = 1 + plan.problem.radii.of(places, [0], FLOAT64)[0]
    r = float(plan.scene.packing.radius)
    centres = np.stack([rows["x"], rows["y"]], axis=-1) / r
    away = np.hypot(rows["dx"], rows["dy"]) / r
    figure, (axes,) = style.panels("a", style.PAGE, height_of(centres) + 0.4)
    name = r"displacement $(\delta x^2+\delta y^2)^{1/2}/r$"
    circles = beads.draw_beads(axes, centres, radii)
    beads.shade(axes, circles, away, float(away.max()) or 1.0, location="bottom", label=name)
    axes.set(xlabel="$x/r$", ylabel="$y/r$", aspect="equal")
    return figure


def profile(plan: Plan, columns: Columns, errors: Columns, network: Network | None) -> Figure:
    """Draw σ_f over the relative height, with its standard errors, beside Eq. 13 or 14."""
    figure, (axes,) = style.panels("a", style.COLUMN, 2.8)
    M, exact, load = plan.problem.height, theory(plan), plan.problem.load
    z = np.arange(M) / M
    if exact is not None and load.angle_deg:
        for dashes, own, std in zip("-:", plan.quantity.branches, exact, strict=True):
            axes.plot(z, std, dashes, color=style.GREY, label=f"exact at finite $M$, $f^{own}$")
    elif exact is not None:
        axes.plot(z, exact[0], color=style.GREY, label="exact at finite $M$")
        if plan.problem.dimension == 2:
            name = f"Eq. ({14 if load.kind == 'bulk' else 13}), printed"
            kind, phi = load.kind, float(plan.problem.phi)
            printed_over_exact = leading_stds(kind, M, z, phi) / stds_by_layer(kind, M, phi)
            axes.plot(z, exact[0] * printed_over_exact, "k--", label=name)
    for c, own in enumerate(plan.quantity.branches):
        rows = np.flatnonzero(columns["branch"] == own)
        rows = rows[style.marked(M, c, len(plan.quantity.branches))]
        error = errors["std"][rows] if "std" in errors else None
        std, name = floats(columns["std"])[rows], f"simulated, $f^{own}$"
        style.points(axes, columns["j"][rows] / M, std, c, name, error, ms=5.2 * NESTED**c)
    what = r"$\sigma_f$" if load.loaded is None else r"$\sigma$ of the change"
    axes.set(xlabel=style.RELATIVE_HEIGHT, xlim=(0, 1), ylabel=what)
    axes.set_ylim(bottom=0)
    axes.legend()
    return figure


def histogram(plan: Plan, columns: Columns, errors: Columns, network: Network | None) -> Figure:
    """Draw P of the changes, with the Gaussian of theory where there is one.

    All contacts together have one Gaussian per layer. Errors are drawn where they are known: of one
    contact, or of an ensemble.
    """
    known, contact, stds = theory(plan), plan.problem.contact, None
    if known is not None and contact is not None:
        stds = known[contact.branch.number, [contact.j]]
    elif known is not None:
        asked = slice(None) if plan.scene.ask.layers is None else list(plan.scene.ask.layers)
        stds = known[:, asked].ravel()
    unit = 1.0
    if stds is not None:
        largest = float(stds.max())  # squares of small ones are below what a float holds
        unit = largest * sqrt(float(((stds / largest) ** 2).mean()))
    count = columns["count"]
    some = np.isfinite(columns["low"]) & np.isfinite(columns["high"]) & (count > 0)
    low, high = columns["low"][some] / unit, columns["high"][some] / unit
    error = columns.get("share_error")
    if error is None and contact is not None:  # one a packing: these are independent
        error = np.sqrt(count) / count.sum()
    with np.errstate(all="ignore"):
        density = count[some] / count.sum() / (high - low)
        error = None if error is None else error[some] / (high - low)
    if not np.isfinite(density).all():
        allowed = "has no density to be drawn: all changes are alike, or nearly"
        raise SceneError("ask.quantity", plan.quantity.name, allowed)
    figure, (axes,) = style.panels("a", style.COLUMN, 2.8)
    style.points(axes, (low + high) / 2, density, 0, "simulated", error)
    axes.set_yscale("log")
    if stds is not None:
        v, ratio = np.linspace(low[0], high[-1], 321), (stds / unit)[:, None]
        gauss = np.exp(-((v / ratio) ** 2) / 2) / ratio / sqrt(2 * np.pi)
        name = "Gaussian of theory" if contact is not None else "theory: one Gaussian per layer"
        axes.plot(v, gauss.mean(axis=0), "k", lw=1, label=name)
        axes.set_ylim(bottom=0.3 / count.sum() / (high - low).max())
    style.label_logarithmic(axes.yaxis)
    change, own = r"f-f^{\rm ordered}", r"\sigma_f" if contact is not None else r"\sigma"
    axes.set_xlabel(f"$({change})\\,/\\,{own}$" if stds is not None else f"${change}$")
    axes.set_ylabel(f"${own}\\,P$" if stds is not None else "$P$")
    axes.legend(loc="lower center")
    return figure


def response(plan: Plan, columns: Columns, errors: Columns, network: Network | None) -> Figure:
    """Draw p, the vertical force that a bead gets from both its upper contacts, and the contacts.

    Of one packing these are as thick as their force, of several as σ of it; p is the mean then.
    """
    vertical = "vertical" in columns
    rows = {name: floats(column) for name, column in columns.items()}
    places = np.stack([unwrapped(plan, rows["i"]), rows["j"]], axis=1)
    sites, which = np.unique(places, axis=0, return_inverse=True)
    unit = float(plan.scene.load.magnitude)
    p = np.bincount(which, rows["vertical" if vertical else "vertical_mean"]) / unit
    figure, (left, right) = style.panels("ab", style.PAGE, 2.9)
    name = r"$p\,/\,f^{\rm load}$" if vertical else r"$\langle p\rangle\,/\,f^{\rm load}$"
    centres = ordered(plan, *sites.T)
    most, load = float(p.max()), along(plan)
    beads.draw_cone(left, centres, p, apex(plan), most, load, location="bottom", label=name)
    forces, what = rows["force" if vertical else "force_std"], "f" if vertical else r"\sigma_f"
    ends = contacts(plan, rows)
    beads.draw_chains(right, ends, forces, named(forces, what))
    surroundings(right, plan, ends)
    return figure


DRAWN = {own.__name__: own for own in (contact_forces, positions, profile, histogram, response)}
