"""Eqs. B10, B17 and B18: mean contact stress under loads in any direction, to second order.

S = Σ f ℓ N⊗N over the two contacts above a bead, each relative to its value in the ordered packing.
"""

# fmt: off
import sympy
from force_diffusion.derivations.calculator.loads import leaning
from force_diffusion.derivations.calculator.statistics import force_moment, mean
from force_diffusion.derivations.framework.closed_form import ClosedForm
from force_diffusion.derivations.framework.catalogue import Number
from force_diffusion.derivations.framework.layers import UNIT
from force_diffusion.derivations.framework.rows import (
    Forms, Row, adds_up_to_zero, is_free_of, leads, turns_positive)
from force_diffusion.symbolic.notation import Symbol
from force_diffusion.symbolic.symbols import (
    DeltaX, Dot, L_plus, M, e_x, e_y, i, j, n_x, n_y, phi, r, t, z)
# fmt: on

RATIO = Symbol(
    "stress_ratio",
    r"\frac{1+\phi}{1-\phi}\,\frac{\langle S_{xx}\rangle}{\langle S_{yy}\rangle}",
    "(1 + φ)/(1 − φ) ⟨S_xx⟩/⟨S_yy⟩",
)
VERTICAL = Symbol("vertical_moment", r"\frac{\langle S_{yy}\rangle}{S_{yy}^{0}}", "⟨S_yy⟩/S⁰_yy")
BY_FLUX = Symbol(
    "moment_over_flux",
    r"\frac{T_{yy}^{\mathrm{moment}}}{T_{yy}^{\mathrm{flux}}}",
    "T_yy(moment)/T_yy(flux)",
)
SHEAR, AXES = (
    {
        load: Symbol(f"{name}_{load}", rf"{latex}_{{\mathrm{{{load}}}}}", f"{words}_{load}")
        for load in ("surface", "bulk")
    }
    for name, latex, words in (
        ("shear", r"\left(\frac{\langle S_{xy}\rangle}{S_{xy}^{0}}\right)", "(⟨S_xy⟩/S⁰_xy)"),
        (
            "axes",
            r"\left(2 n_{x}n_{y}\,\frac{1-t}{1+t}\operatorname{cot}2\psi\right)",
            "[2n_x n_y (1−t)/(1+t) cot 2ψ]",
        ),
    )
)
LAYERS = {"surface": sympy.S.One, "bulk": M - j}
"""How many layers of load a contact carries."""
X, Y = e_x / n_x, e_y / n_y
"""Along both axes, so that (X·n)² and (Y·n)² are 1 in the ordered packing."""
RISE = Dot(e_y, DeltaX(i + 1, j + 1) - DeltaX(i, j)) / (2 * r * n_y)
"""How much more than in the ordered packing a contact leads up, over that."""


def _over_ordered(
    first: sympy.Expr, second: sympy.Expr, load: str, carried: sympy.Expr = 1 + t
) -> sympy.Expr:
    """A component of S over its ordered value, to which L⁺ + L⁻ or L⁺ − L⁻ contribute."""
    return force_moment(i, j, first, second) / (2 * r * L_plus * carried * LAYERS[load])


def _mean(observable: sympy.Expr, load: str, shown: sympy.Expr) -> ClosedForm:
    form = mean(observable, order=2, load=leaning(t, load), relative=False)
    return form.named(shown)


def _forms(load: str) -> Forms:
    xx, yy = _over_ordered(X, X, load), _over_ordered(Y, Y, load)
    return {
        "ratio": _mean(xx - yy, load, RATIO - 1),
        "vertical": _mean(yy, load, VERTICAL - 1),
        "flux": _mean(yy - RISE, load, BY_FLUX - 1),
    }


def _shear_forms(load: str) -> Forms:
    xx, yy = _over_ordered(X, X, load), _over_ordered(Y, Y, load)
    xy = _over_ordered(X, Y, load, 1 - t)
    turned = (1 + phi) / 2 * yy - (1 - phi) / 2 * xx - phi * xy
    return {
        f"shear_{load}": _mean(xy, load, SHEAR[load] - 1),
        f"axes_{load}": _mean(turned, load, AXES[load] - phi),
    }


def _stress(number: Number, load: str, leading: sympy.Expr, turns: sympy.Expr) -> Row:
    return Row(
        number=number,
        name="stress" if load == "surface" else "stress_bulk",
        title=f"Mean contact stress under a {load} load, to second order",
        call="mean((force_moment(i, j, e_x, e_x)/n_x**2 - force_moment(i, j, e_y, e_y)/n_y**2)"
        f"/(2*r*L_plus*(1 + t){'*(M - j)' if load == 'bulk' else ''}), order=2, "
        f'load=leaning(t, "{load}"), relative=False)',
        exact=lambda: _forms(load),
        meaning="The stress ratio depends on the layer and on the kind of load, but not on its "
        "direction, so it is no property of the material alone. The contact moment and the "
        "vertical momentum through a cut differ at order σ²: the load fixes the latter, while the "
        "former weighs the momentum of each contact by its height.",
        quantities=(
            (RATIO, "of mean contact moments of a layer, over the ratio (1−φ)/(1+φ)"),
            (VERTICAL, "the vertical one over its value in the ordered packing"),
            (BY_FLUX, "⟨S_yy⟩ over width and mean height of the layer; over load by width"),
        ),
        claimed=lambda of: {
            "the leading order of the ratio": leads(of["ratio"], leading * UNIT),
            "it is larger than in the ordered packing above "
            f"z = {'2φ/(1 + φ)' if load == 'surface' else 'φ'} and smaller below":
                turns_positive(of["ratio"], z, turns),
            **{f"it does not depend on the load's direction: {name}": is_free_of(of[name], t)
               for name in ("ratio", "vertical", "flux")},
            "over all layers, weighted as the ordered stress is, moments and flux agree":
                adds_up_to_zero(of["flux"], j, LAYERS[load]),
        },
    )  # fmt: skip


DERIVATIONS: dict[Number, Row] = {
    "B10": _stress(
        "B10", "surface", 4 * M * (z * (1 + phi) - 2 * phi), 2 * phi / (1 + phi)
    ),
    "B17": _stress("B17", "bulk", 4 * M * (z - phi), phi),
    "B18": Row(
        number="B18",
        name="shear_stress",
        title="Mean shear stress under loads in any direction, to second order",
        call="mean(force_moment(i, j, e_x, e_y)/(2*r*n_x*n_y*L_plus*(1 - t)), order=2, "
        "load=leaning(t), relative=False)",
        exact=lambda: {**_shear_forms("surface"), **_shear_forms("bulk")},
        meaning="The principal axes turn with the height j, whatever M is.",
        quantities=(
            *((SHEAR[load], f"mean S_xy over that of the ordered packing, {load} load, t ≠ 1")
              for load in LAYERS),
            *((AXES[load], f"ψ: angle of a principal axis of ⟨S⟩ to the vertical, {load} load")
              for load in LAYERS),
        ),
        claimed=lambda of: {
            "the leading order under a surface load":
                leads(of["shear_surface"], 2 * M * (1 - 3 * z) * UNIT * (1 - phi)),
            "the leading order under a bulk load":
                leads(of["shear_bulk"], M * (1 - 5 * z) * UNIT * (1 - phi)),
            **{f"the axes turn as −2j (1 − 3φ), in units of (σ/r)²/[(1−φ²)(1+φ)]: {load} load":
                   leads(of[f"axes_{load}"], -2 * M * z * (1 - 3 * phi) * UNIT * (1 - phi))
               for load in LAYERS},
            **{f"it does not depend on the load's direction: {name}_{load}":
                   is_free_of(of[f"{name}_{load}"], t)
               for name in ("shear", "axes") for load in LAYERS},
        },
    ),
}  # fmt: skip
