"""Eqs. B4, B5, B6, B9, B15 and B16: means of positions and forces, to second order in the radii."""

from force_diffusion.derivations import eq03_extrapolation as eq03
from force_diffusion.derivations import eq11_total_force as eq11
from force_diffusion.derivations.calculator.statistics import mean
from force_diffusion.derivations.framework.catalogue import Number
from force_diffusion.derivations.framework.record import SECOND_ORDER, usual
from force_diffusion.derivations.framework.rows import Row, leads
from force_diffusion.symbolic.notation import Symbol
from force_diffusion.symbolic.symbols import ForcePlus, M, i, j, phi, r, sigma, z

FORCE = Symbol(
    "mean_force_shift",
    r"\frac{\langle f^{\pm}_{ij}\rangle}{f^{\mathrm{load}}/2 n_{y}} - 1",
    "⟨f^±_ij⟩/(f_load/2n_y) − 1",
)
_UNIT = (sigma / r) ** 2 / ((1 - phi**2) * (1 + phi))

DERIVATIONS: dict[Number, Row] = {
    "B5": Row(
        number="B5",
        name="mean_surface",
        title="Mean contact force under a surface load, to second order",
        call="mean(f_plus(i, j), order=2)",
        forms=lambda: {"force": mean(ForcePlus(i, j), order=2).named(FORCE)},
        meaning="Forces rise above z = φ and fall below, by shares of order M(σ/r)².",
        symbols=((FORCE, "mean of f⁺ and of f⁻ over its ordered value, less 1"),
                 *usual(sigma, r, M, phi)),
        assumptions=SECOND_ORDER,
        premises=(eq03.DERIVATION, eq11.DERIVATION),
        statements=(
            ("the leading order, which changes its sign at z = φ",
             lambda forms: leads(forms["force"], 2 * M * (z - phi) * _UNIT)),
        ),
    ),
}  # fmt: skip
