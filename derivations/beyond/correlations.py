"""Eqs. B7, B8, B12 and B21: correlations of contact forces, and means over neighbours."""

# fmt: off
import sympy
from force_diffusion.derivations import eq13_surface_diffusion as eq13
from force_diffusion.derivations.beyond.variances import PAPER
from force_diffusion.derivations.calculator.statistics import (
    covariance, mean_over, response, variance)
from force_diffusion.derivations.framework.catalogue import Number
from force_diffusion.derivations.framework.closed_form import ClosedForm
from force_diffusion.derivations.framework.layers import UNIT
from force_diffusion.derivations.framework.rows import Row, are_same, equals, goes_as, highest
from force_diffusion.symbolic.kernel.decisions import Ruling
from force_diffusion.symbolic.notation import Symbol
from force_diffusion.symbolic.symbols import ForcePlus, M, N, i, j, k, l, phi, r, sigma, z
from sympy import Eq, Rational
# fmt: on

FORCE_MEAN = Symbol(
    "mean_of_N_variance",
    r"\frac{\sigma^2(\overline{f^{\pm}}_{N})}{\langle f\rangle^2}",
    "σ²(mean of N f^±)/⟨f⟩²",
)
BEAD_MEAN = Symbol(
    "mean_of_N_beads",
    r"\frac{\sigma^2(\overline{p}_{N})}{(f^{\mathrm{load}})^{2}}",
    "σ²(mean of N p)/f_load²",
)
BEAD = Symbol("bead", r"\frac{\sigma^2(p)}{(f^{\mathrm{load}})^{2}}", "σ²(p)/f_load²")
APART = Symbol(
    "places_covariance",
    r"\frac{\langle\Delta f^{+}_{ij}\,\Delta f^{+}_{i+2k,\,j}\rangle}{\langle f\rangle^2}",
    "⟨Δf⁺_ij Δf⁺_{i+2k,j}⟩/⟨f⟩²",
)
LAYERS, BULK_LAYERS = (
    Symbol(
        f"{load}layers_covariance",
        r"\frac{\langle\Delta f^{+}_{ij}\,\Delta f^{+}_{i+l-j,\,l}\rangle}"
        r"{\langle f_{ij}\rangle\langle f_{i+l-j,\,l}\rangle}",
        "⟨Δf⁺_ij Δf⁺_{i+l−j,l}⟩/⟨f_ij⟩⟨f_{i+l−j,l}⟩",
    )
    for load in ("", "bulk_")
)
z_upper = Symbol("z_upper", "z'", "z′", positive=True)
"""Relative height l/M of the upper contact."""
AT_HEIGHTS = {j: z * M, l: z_upper * M}
ON_DIAGONAL = {
    "surface": M**3 * (1 - z_upper) * (3 * (1 - z**2) - (1 - z_upper) ** 2) * UNIT,
    "bulk": M**3 * (1 - z_upper) / (10 * (1 - z)) * UNIT
    * (3 + 6 * z_upper - 15 * z**2 - 6 * z_upper**2 + 10 * z**3 + 2 * z_upper**3),
}  # fmt: skip
"""Leading orders of the covariance of two contacts of a diagonal, at the heights z and z′."""
_BY_LOAD = {"layers": "surface", "bulk": "bulk"}
_INSIDE = (j >= 2, j <= l - 2, l <= M - 2)
_DEEP = (j >= 4, j + 6 <= M)
_LONG = (j + 2 <= N, j >= 2, j + 2 <= M)


def _contacts(number: Number, name: str, load: str) -> Row:
    leading = PAPER[load].PRINTED.rhs.doit()
    argument = f'load="{load}"'

    def beside(apart: ClosedForm, places: int, share: Rational) -> Ruling:
        return goes_as(apart, share * leading, Eq(k, places), *_DEEP, at={j: z * M})

    return Row(
        number=number,
        name=name,
        title=f"Mean over N neighbouring contacts of one branch under a {load} load",
        call=f"variance(mean_over(f_plus(i, j), N), {argument})",
        exact=lambda: {
            "mean": variance(mean_over(ForcePlus(i, j), N), load=load).named(FORCE_MEAN),
            "apart": covariance(ForcePlus(i, j), ForcePlus(i + 2 * k, j), load=load).named(APART),
        },
        meaning="N independent contacts would have σ_f²/N. Along a layer fluctuations nearly "
        "cancel for N up to order M³; beyond that the radii of the two layers in contact dominate.",
        quantities=(
            (FORCE_MEAN, "variance of the mean of f^± over N neighbours of one layer"),
            (APART, "covariance of two contacts of a layer that are k places apart"),
        ),
        claimed=lambda of: {
            "to leading order the correlation of a contact with its first neighbour is −2/3":
                beside(of["apart"], 1, Rational(-2, 3)),
            "and with its second neighbour 1/6": beside(of["apart"], 2, Rational(1, 6)),
            "from the third neighbour on there is none, exactly, for k ≤ j − 2":
                equals(of["apart"], sympy.S.Zero, k >= 3, k <= j - 2),
            "nor for k ≥ j + 3": equals(of["apart"], sympy.S.Zero, k >= j + 3),
            f"of Eq. {PAPER[load].DERIVATION.number} a mean over few neighbours has 2/(3N²)":
                goes_as(of["mean"], Rational(2, 3) / N**2 * leading, N >= 2, j - 1 >= N, j + 2 <= M,
                        at={j: z * M}),
            "over many neighbours it falls as 1/N, and M does not count: as "
            "(1 − φ)²(σ/r)²/[2N(1 + φ)²]":
                goes_as(of["mean"], (1 - phi) ** 2 * sigma**2 / (2 * N * (1 + phi) ** 2 * r**2),
                        *_LONG, growing=N),
        },
    )  # fmt: skip


def _correlation(form: ClosedForm, load: str, squared: Rational) -> Ruling:
    """The squared correlation of a contact at the base and one of its diagonal, as z′ → 1."""
    both = highest(form.on(*_INSIDE).xreplace(AT_HEIGHTS), M)
    lower = PAPER[load].PRINTED.rhs.doit()
    upper = lower.xreplace({z: z_upper})
    square = sympy.cancel(both**2 / (lower * upper)).subs(z, 0).subs(z_upper, 1)
    return are_same(square, squared)


def _share_of_a_diagonal(form: ClosedForm, load: str, share: Rational) -> Ruling:
    """The variance of the mean over a diagonal, over that of one of its contacts on average."""
    both = sympy.expand(highest(form.on(*_INSIDE).xreplace(AT_HEIGHTS), M))
    whole = 2 * sympy.integrate(sympy.integrate(both, (z, 0, z_upper)), (z_upper, 0, 1))
    lower = sympy.expand(PAPER[load].PRINTED.rhs.doit())
    return are_same(whole / sympy.integrate(lower, (z, 0, 1)), share)


DERIVATIONS: dict[Number, Row] = {
    "B7": _contacts("B7", "neighbouring_contacts", "surface"),
    "B8": Row(
        number="B8",
        name="neighbouring_beads",
        title="Mean vertical force over N neighbouring beads",
        call="variance(mean_over(response(i, j), N))",
        exact=lambda: {
            "mean": variance(mean_over(response(i, j), N)).named(BEAD_MEAN),
            "bead": variance(response(i, j)).named(BEAD),
        },
        meaning="The vertical force through a layer is the load: the sum over a window changes "
        "through its ends alone, and the variance of its mean falls as 1/N².",
        quantities=(
            (BEAD_MEAN, "variance of the mean of p over N neighbours of one layer"),
            (BEAD, "variance of the vertical force p that a bead gets from both upper contacts"),
        ),
        claimed=lambda of: {
            "of Eq. 13 a mean over few neighbours has 1/(3N²)":
                goes_as(of["mean"], eq13.PRINTED.rhs.doit() / (3 * N**2), N >= 2, j - 2 >= N,
                        M - j - 1 >= N, at={j: z * M}),
            "the mean over many neighbours goes as 1/N², too":
                goes_as(of["mean"],
                        (8 * (M - j) ** 2 * (M + 2 * j) - 6 * (M - j) ** 2
                         + (M - j) * (6 * phi**2 + 24 * phi - 2) - 3 * (1 + phi) ** 2)
                        / (12 * N**2) * UNIT,
                        *_LONG, M - j + 1 <= N, growing=N),
        },
    ),
    "B12": Row(
        number="B12",
        name="layers",
        title="Covariance of contact forces of different layers",
        call="covariance(f_plus(i, j), f_plus(i + l - j, l), where=[j <= l])",
        exact=lambda: {
            name: covariance(
                ForcePlus(i, j), ForcePlus(i + l - j, l), load=load, where=(j <= l,)
            ).named(symbol)
            for (name, load), symbol in zip(_BY_LOAD.items(), (LAYERS, BULK_LAYERS), strict=True)
        },
        meaning="Along a diagonal forces stay correlated over the whole height of the packing, so "
        "averaging along it hardly helps; along a layer their fluctuations cancel.",
        quantities=(
            (LAYERS, "covariance of two contacts of one diagonal, over both means; surface load"),
            (BULK_LAYERS, "the same under a bulk load"),
            (l, "layer of the upper contact, j that of the lower one"),
        ),
        claimed=lambda of: {
            **{f"the leading order at the heights z = j/M and z′ = l/M, {load} load":
                   goes_as(of[name], ON_DIAGONAL[load], *_INSIDE, at=AT_HEIGHTS)
               for name, load in _BY_LOAD.items()},
            "along a diagonal from the base to the surface a correlation of √3/2 is left under a "
            "surface load, as M → ∞ and then z′ → 1":
                _correlation(of["layers"], "surface", Rational(3, 4)),
            "and of √5/3 under a bulk load": _correlation(of["bulk"], "bulk", Rational(5, 9)),
            "the mean over a whole diagonal has 4/5 of the variance of one of its contacts, "
            "surface load": _share_of_a_diagonal(of["layers"], "surface", Rational(4, 5)),
        },
    ),
    "B21": _contacts("B21", "neighbouring_contacts_bulk", "bulk"),
}  # fmt: skip
