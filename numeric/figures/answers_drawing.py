"""Pictures of one answer, by quantity; of listed packings the first one. Lengths in units of r."""

from collections.abc import Callable, Mapping
from math import ceil, radians, sqrt, tan

import numpy as np

from .. import closed_forms
from ..arithmetic.systems import FLOAT64, Array, as_floats
from ..lattice.branch import Branch, PerBranch, per_direction
from ..planning.plan import Plan
from ..quantities.base import first_order_std
from ..scene.sections import SceneError
from ..unilateral.network import Network
from . import specification as spec
from .elements import base, cone, point_load, surface_load

Columns = Mapping[str, Array]
NESTED = 0.66
"""By so much markers that may lie on each other are smaller than the last ones."""


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


def contact_forces(
    plan: Plan, columns: Columns, errors: Columns, network: Network | None
) -> spec.Picture:
    """Draw force chains on the ordered lattice: a line as thick as the force of its contact.

    Of an ensemble, which has no one packing, lines are as thick as σ_f. Under unilateral contacts
    they lie where the beads rest.
    """
    if network is not None:
        ends, forces, surface = _at_rest(plan, network)
        panel = _chains(plan, ends, forces, "f", surface)
    else:
        rows = of_first(columns)
        ends, what = _contacts(plan, rows), "force" if "force" in rows else "std"
        panel = _chains(plan, ends, rows[what], "f" if what == "force" else r"\sigma_f")
    return spec.Picture([panel], _height(ends), page=True)


def _at_rest(plan: Plan, network: Network) -> tuple[Array, Array, Array]:
    """Give both ends of contacts, (contacts, 2, 2), their forces, and the beads of the surface."""
    x, period = as_floats(network.x), float(network.frame.period)
    low, high = x[network.pairs[:, 1]], x[network.pairs[:, 0]]
    high[:, 0] -= period * np.round((high[:, 0] - low[:, 0]) / period)
    forces = as_floats(network.forces) * float(plan.scene.load.magnitude)
    return np.stack([low, high], axis=1), forces, x[-network.width :]


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


def _chains(
    plan: Plan, ends: Array, forces: Array, what: str, surface: Array | None = None
) -> spec.Panel:
    """Draw lines between the ends of contacts, the base and the load.

    ``surface``: the beads of the surface where they rest, (W, 2); else they are on the lattice.
    """
    nx, ny = _axes(plan)
    left, right = float(ends[..., 0].min()), float(ends[..., 0].max())
    load, M = plan.scene.load, plan.problem.height
    top = float(ends[..., 1].max())
    elements: list[spec.Element] = [spec.Chains(ends, forces, _shown(forces, what))]
    low = float(ends[..., 1].min())
    if low < 2:  # else layers further below are left out
        elements.append(base(left, right))
    if load.at is not None:
        x, y = _apex(plan)
        y = y if surface is None else float(surface[:, 1].max())
        elements += point_load(x, y)
        top = max(top, y) + 10
    elif load.kind == "surface":
        if surface is None:
            i = np.arange(ceil(left / (2 * nx)), right / (2 * nx) + spec.EQUAL)
            i = i[(i - M) % 2 == 0]
            surface = np.stack([2 * nx * i, np.full(len(i), 2 * ny * M)], axis=1)
        elements += surface_load(surface, tan(radians(plan.problem.load.angle_deg)))
        top = max(top, float(surface[:, 1].max())) + 5
    return spec.Panel(
        elements,
        spec.Axis(low=left - 1, high=right + 1),
        spec.Axis(low=low - 1.5, high=top + 1),
        legend="below",
        columns=3,
        scaled=True,
        bare=True,
    )


def _shown(forces: Array, what: str) -> list[tuple[float, str]]:
    """Choose the forces that the legend shows, and name them."""
    mean, largest, smallest = (float(v) for v in (forces.mean(), forces.max(), forces.min()))
    if spec.alike(forces):
        if largest - smallest < spec.EQUAL * largest:
            return [(mean, f"all, ${what}={mean:.3g}$")]
        shown = [(mean, f"mean, ${what}={mean:.3g}$")]
        for name, force in (("smallest", smallest), ("largest", largest)):
            shown.append((force, f"{name}, ${100 * (force / mean - 1):+.2g}" + r"\%$"))
        return shown
    size = float(np.abs(forces).mean())
    shown = [(size, f"mean, ${what}={size:.3g}$"), (largest, f"largest, ${what}={largest:.3g}$")]
    if smallest < 0:
        shown.append((smallest, f"pulling, ${what}={smallest:.3g}$ at most"))
    return shown


def _apex(plan: Plan) -> tuple[float, float]:
    """Give the ordered centre of the loaded bead."""
    nx, ny = _axes(plan)
    assert plan.scene.load.at is not None
    i, j = map(int, plan.scene.load.at)
    return 2 * nx * i, 2 * ny * j


def _height(points: Array) -> float:
    """Give the height of a figure that is a page wide, in inches."""
    wide, high = np.ptp(points.reshape(-1, 2), axis=0)
    return float(np.clip(7.0 * (high + 8) / (wide + 2) + 0.3, 1.6, 8))


def positions(
    plan: Plan, columns: Columns, errors: Columns, network: Network | None
) -> spec.Picture:
    """Draw the beads where they lie, each with its radius, as dark as it is displaced."""
    rows = of_first(columns)
    sites = list(zip(rows["i"].tolist(), rows["j"].tolist(), strict=True))
    unit = float(plan.scene.packing.radius)
    with FLOAT64.active():
        radii = unit * (1 + plan.problem.radii.at(sites, 0, FLOAT64))
    centres, away = np.stack([rows["x"], rows["y"]], axis=-1), np.hypot(rows["dx"], rows["dy"])
    name = r"displacement $(\delta x^2+\delta y^2)^{1/2}$"
    beads = spec.Beads(centres, radii, away, name, most=float(away.max()) or 1.0)
    panel = spec.Panel([beads], spec.Axis("$x$"), spec.Axis("$y$"), scaled=True)
    return spec.Picture([panel], _height(centres / unit) + 0.4, page=True)


def profile(plan: Plan, columns: Columns, errors: Columns, network: Network | None) -> spec.Picture:
    """Draw σ_f over the relative height, with its standard errors, beside Eq. 13 or 14."""
    M, theory, load = plan.problem.height, _theory(plan), plan.problem.load
    z, layers, what = columns["j"] / M, np.arange(M) / M, r"$\sigma_f$"
    elements: list[spec.Line | spec.Points] = []
    if theory is not None and load.angle_deg:
        for dashes, (own, exact) in zip("-:", theory, strict=True):
            name = f"exact at finite $M$, $f^{own}$"
            elements.append(spec.Line(layers, exact, dashes=dashes, name=name))
    elif theory is not None:
        elements.append(spec.Line(layers, theory.plus, name="exact at finite $M$"))
        if plan.problem.dimension == 2:
            name = f"Eq. ({14 if load.kind == 'bulk' else 13}), printed"
            printed = theory.plus * _printed_over_exact(plan)
            elements.append(spec.Line(layers, printed, "black", "--", name))
    for c, own in enumerate(plan.quantity.branches):
        rows = columns["branch"] == own
        error = errors["std"][rows] if "std" in errors else None
        std, name = floats(columns["std"])[rows], f"simulated, $f^{own}$"
        elements.append(spec.Points(z[rows], std, c, name, error, 5.2 * NESTED**c))
    what = what if load.loaded is None else r"$\sigma$ of the change"
    return spec.Picture([spec.Panel(elements, spec.RELATIVE_HEIGHT, spec.Axis(what, 0))], 2.8)


def _printed_over_exact(plan: Plan) -> Array:
    """Give σ_f of the printed Eq. 13 or 14 over the exact one, by layer 0 … M − 1."""
    M, phi = plan.problem.height, float(1 - 2 * plan.problem.n_x**2)
    bulk = plan.problem.load.kind == "bulk"
    printed = closed_forms.bulk_diffusion if bulk else closed_forms.surface_diffusion
    exact = closed_forms.bulk_variance if bulk else closed_forms.surface_variance
    ratios = [printed(M, j / M, phi, 1, 1) / exact(M, j, phi, 1, 1) for j in range(M)]
    return np.sqrt(ratios)


def histogram(
    plan: Plan, columns: Columns, errors: Columns, network: Network | None
) -> spec.Picture:
    """Draw P of the changes, with the Gaussian of theory where there is one.

    All contacts together have a Gaussian a layer. Errors are drawn where they are known: of one
    contact, or of an ensemble.
    """
    known, contact = _theory(plan), plan.problem.contact
    asked = slice(None) if plan.scene.ask.layers is None else list(plan.scene.ask.layers)
    theory = None if known is None else np.concatenate([rows[asked] for _, rows in known])
    if known is not None and contact is not None:
        theory = known[contact.branch][[contact.j]]
    unit = 1.0
    if theory is not None:
        largest = float(theory.max())  # squares of small ones are below what a float holds
        unit = largest * sqrt(float(((theory / largest) ** 2).mean()))
    count = columns["count"]
    some = np.isfinite(columns["low"]) & np.isfinite(columns["high"])
    low, high = columns["low"][some] / unit, columns["high"][some] / unit
    error = columns.get("share_error")
    if error is None and contact is not None:  # one a packing: these are independent
        error = np.sqrt(count) / count.sum()
    full = count[some] > 0
    with np.errstate(all="ignore"):
        density = (count[some] / count.sum() / (high - low))[full]
        error = None if error is None else (error[some] / (high - low))[full]
    if not np.isfinite(density).all():
        allowed = "has no density to be drawn: all changes are alike, or nearly"
        raise SceneError("ask.quantity", plan.quantity.name, allowed)
    elements: list[spec.Line | spec.Points] = [
        spec.Points(((low + high) / 2)[full], density, 0, "simulated", error)
    ]
    own, least = r"\sigma_f" if contact is not None else r"\sigma", None
    if theory is not None:
        v, ratio = np.linspace(low[0], high[-1], 321), (theory / unit)[:, None]
        gauss = np.exp(-((v / ratio) ** 2) / 2) / ratio / sqrt(2 * np.pi)
        name = "Gaussian of theory" if contact is not None else "theory: a Gaussian a layer"
        elements.append(spec.Line(v, gauss.mean(axis=0), "black", name=name, width=1.0))
        least = 0.3 / count.sum() / (high - low).max()
    change = r"f-f^{\rm ordered}"
    panel = spec.Panel(
        elements,
        spec.Axis(f"$({change})\\,/\\,{own}$" if unit != 1 else f"${change}$"),
        spec.Axis(f"${own}\\,P$" if unit != 1 else "$P$", least, log=True),
        legend="lower center",
    )
    return spec.Picture([panel], 2.8)


def response(
    plan: Plan, columns: Columns, errors: Columns, network: Network | None
) -> spec.Picture:
    """Draw p, the vertical force that a bead gets from both its upper contacts, and the contacts.

    Of one packing these are as thick as their force, of several as σ of it; p is the mean then.
    """
    one = "vertical" in columns
    rows = {name: floats(column) for name, column in columns.items()}
    rows["i"] = _unwrapped(plan, rows["i"])
    found: dict[tuple[int, int], float] = {}
    vertical = rows["vertical" if one else "vertical_mean"]
    for i, j, own in zip(rows["i"].tolist(), rows["j"].tolist(), vertical.tolist(), strict=True):
        found[int(i), int(j)] = found.get((int(i), int(j)), 0.0) + own
    centres = np.array(list(found)) * (2 * np.array(_axes(plan)))
    name = r"$p\,/\,f^{\rm load}$" if one else r"$\langle p\rangle\,/\,f^{\rm load}$"
    shades = np.array(list(found.values()))
    left = cone(centres, shades, _apex(plan), name, "bottom", float(shades.max()))
    forces, what = rows["force" if one else "force_std"], "f" if one else r"\sigma_f"
    return spec.Picture([left, _chains(plan, _contacts(plan, rows), forces, what)], 2.9, page=True)


DRAWN: dict[str, Callable[[Plan, Columns, Columns, Network | None], spec.Picture]] = {
    "contact_forces": contact_forces,
    "positions": positions,
    "profile": profile,
    "histogram": histogram,
    "response": response,
}
