"""Eqs. B9, B19, B22 and B23: the response to loads on single beads."""

# fmt: off
import sympy
from force_diffusion.derivations.beyond.variances import IN_SPACE
from force_diffusion.derivations.calculator.loads import point
from force_diffusion.derivations.calculator.statistics import mean, mean_over, response, variance
from force_diffusion.derivations.framework.closed_form import ClosedForm
from force_diffusion.derivations.framework.catalogue import Number
from force_diffusion.derivations.framework.layers import UNIT
from force_diffusion.derivations.framework.rows import (
    Forms, Row, adds_up_to_zero, equals, goes_as, turns_positive)
from force_diffusion.symbolic.notation import Symbol
from force_diffusion.symbolic.symbols import (
    ForceAlong, ForcePlus, N, VerticalAlong, i, j, k, l, p, phi, q, z)
from sympy import Ge, Rational, sqrt
# fmt: on

_FORCE_LOAD = r"(f^{\mathrm{load}})^{2}"
CONTACT = Symbol(
    "mean_response",
    r"\frac{\delta\langle f^{+}_{ij}\rangle}{f^{\mathrm{load}}/2 n_{y}}",
    "δ⟨f⁺_ij⟩/(f_load/2n_y)",
)
PUSH = Symbol("mean_push", r"\frac{\delta\langle p\rangle}{f^{\mathrm{load}}}", "δ⟨p⟩/f_load")
FACE, FACE_BEAD, LEG, INSIDE = (
    Symbol(name, rf"\frac{{\sigma_{{\mathrm{{{where}}}}}^{{2}}({of})}}{{{over}}}", words)
    for name, where, of, over, words in (
        ("face_response", "face", "n_{z} f", _FORCE_LOAD, "σ²(n_z f on a face)/f_load²"),
        (
            "face_bead_response",
            "face",
            "n_{z} f^1 + n_{z} f^2",
            _FORCE_LOAD,
            "σ²(n_z f¹ + n_z f² on a face)/f_load²",
        ),
        ("leg_response", "leg", "n_{z} f", _FORCE_LOAD, "σ²(n_z f on a leg)/f_load²"),
        ("inside_force", "inside", "f", "f_{0}^{2}", "σ²(f inside)/f₀²"),
    )
)
OVER_LOADS, OVER_BEADS, OVER_BOTH, OVER_PAIRS = (
    Symbol(
        f"mean_over_{over}",
        rf"\frac{{\sigma^2(\overline{{p}}_{{\mathrm{{{over}}}}})}}{{{_FORCE_LOAD}}}",
        f"σ²(mean of p over {words})/f_load²",
    )
    for over, words in (
        ("loads", "N loads"),
        ("beads", "N beads"),
        ("both", "N loads and N beads"),
        ("pairs", "N loads with a bead each"),
    )
)
SHARE = 1 + 2 * phi + 2 * phi**2

# twice the steps along n⁺ and along n⁻ from the load (k, l) down to bead (i, j)
_DOWN, _ACROSS = l - j + k - i, l - j - k + i
_WIDTH = 2 * (N - 1)
_BELOW_ONE = N >= 2, Ge(_DOWN, 2), Ge(_ACROSS, 2)
_BELOW_LOADS = N >= 2, Ge(_DOWN, 2), Ge(_ACROSS - _WIDTH, 2)
_BELOW_ALL = N >= 2, Ge(_DOWN - _WIDTH, 2), Ge(_ACROSS - _WIDTH, 2)
_BEADS_BELOW = N >= 2, Ge(_DOWN - _WIDTH, 2), Ge(_ACROSS, 2)


def _far(*relations: sympy.Basic) -> tuple[sympy.Basic, ...]:
    """Away from the legs of all cones."""
    return (N >= 3, Ge(_DOWN - _WIDTH, 6), Ge(_ACROSS - _WIDTH, 6), *relations)


def _of_bead() -> Forms:
    load, pushed = point(k, l), response(i, j)
    both = mean_over(mean_over(pushed, N), N, k)
    return {
        "loads": variance(mean_over(pushed, N, k), load=load, where=_BELOW_LOADS).named(OVER_LOADS),
        "beads": variance(mean_over(pushed, N), load=load, where=_BEADS_BELOW).named(OVER_BEADS),
        "both": variance(both, load=load, where=_BELOW_ALL).named(OVER_BOTH),
    }


def _of_spheres() -> Forms:
    def of(observable: sympy.Expr, *where: sympy.Basic) -> ClosedForm:
        return variance(observable, load="point", dimension=3, where=where)

    face, leg = (p >= 1, q >= 1, p + q <= l), (p >= 1,)
    on_face, on_leg = (-q, -p, l), (-p, 0, l)
    pushed = VerticalAlong(1, *on_face) + VerticalAlong(2, *on_face)
    inside = (p >= 1, q >= 1, p + q <= l - j - 1)
    return {
        "contact": of(VerticalAlong(1, *on_face), *face).named(FACE),
        "bead": of(pushed, *face).named(FACE_BEAD),
        "leg": of(VerticalAlong(1, *on_leg), *leg).named(LEG),
        "inside": of(ForceAlong(1, -p, -q, j + p + q), *inside).named(INSIDE),
    }


_X = Symbol("x", positive=True)
_AT = {j: z * l, N: _X * l}
"""j/l and N/l fixed as l grows."""


DERIVATIONS: dict[Number, Row] = {
    "B9": Row(
        number="B9",
        name="mean_response",
        title="Mean response to a point load, to second order",
        call="mean(f_plus(i, j), order=2, load=point(k, l))",
        exact=lambda: {
            "contact": mean(ForcePlus(i, j), order=2, load=point(k, l)).named(CONTACT),
            "bead": mean(response(i, j), order=2, load=point(k, l)).named(PUSH),
        },
        meaning="Between the two rays of the ordered packing the mean response is a plateau: "
        "above the two lowest layers it depends neither on height nor on position, and does not "
        "spread as a diffusing ray would. The average over the ensemble and that over N equal "
        "loads and N contacts have the same mean. In p, the vertical force on a bead, the legs "
        "lose what the plateau gains.",
        quantities=(
            (CONTACT, "what disorder adds to the mean of f⁺ below the load on bead (k, l)"),
            (PUSH, "the same of p, the vertical force that bead (i, j) gets from both contacts"),
            (l, "layer of the loaded bead"),
        ),
        claimed=lambda of: {
            "the plateau of f is positive for φ > (√17 − 3)/4, and negative below":
                turns_positive(of["contact"], phi, (sqrt(17) - 3) / 4, j >= 2, Ge(_DOWN, 2),
                               Ge(_ACROSS, 4)),
            "that of p for φ > 1/5, down to the base":
                turns_positive(of["bead"], phi, Rational(1, 5), Ge(_DOWN, 4), Ge(_ACROSS, 4)),
            "a leg loses 2φ² + φ + 1 per layer in f, in units of (σ/r)²/(1−φ²)²":
                goes_as(of["contact"], (2 * phi**2 + phi + 1) * j * UNIT, sympy.Eq(i, j + k - l),
                        j >= 2, j <= l - 2, growing=j),
            "in p nothing is lost: in each layer all beads add up to no change":
                adds_up_to_zero(of["bead"], i),
        },
    ),
    "B19": Row(
        number="B19",
        name="spheres_response",
        title="Response to a point load in three dimensions",
        call='variance(p_along(1, -q, -p, l), load="point", dimension=3, '
        "where=[p >= 1, q >= 1, p + q <= l])",
        exact=_of_spheres,
        meaning="Fluctuations fill the three legs and the three faces of a cone. Inside it no "
        "force changes to first order, in any packing. For discs one face fills the cone.",
        quantities=(
            (FACE, "variance of the vertical force of one contact in a face of the cone"),
            (FACE_BEAD, "the same of both contacts of the face above a bead together"),
            (LEG, "the same of the contact on a leg of the cone"),
            (INSIDE, "variance of a contact's magnitude inside the cone, over the squared mean f₀² "
             "on a leg"),
            (l, "layer of the loaded bead (0, 0, l)"),
            (q, "steps along that contact's own vector, from the leg where its path branches off"),
            (p, "steps down that leg"),
        ),
        claimed=lambda of: {
            "on a face, for p = q = zl, the vertical force on a bead goes as (2/3)(1 + 2φ + "
            "2φ²)(l + j), in units of (σ/r)²/[(1−φ)(1+2φ)]²":
                goes_as(of["bead"], Rational(4, 3) * SHARE * l * (1 - z) * IN_SPACE, p >= 1, q >= 1,
                        p + q >= 3, p + q <= l - 3, growing=l, at={p: z * l, q: z * l}),
            "on a leg it goes as [2(3 + 6φ + 5φ²)l + 4j]/9, at p = zl":
                goes_as(of["leg"], (2 * (3 + 6 * phi + 5 * phi**2) + 4 * (1 - z)) * l / 9
                        * IN_SPACE, p >= 2, p <= l - 2, growing=l, at={p: z * l}),
            "inside the cone no force changes": equals(of["inside"], sympy.S.Zero),
        },
    ),
    "B22": Row(
        number="B22",
        name="averaged_response",
        title="Response averaged over N loads, over N beads, and over both",
        call="variance(mean_over(response(i, j), N, k), load=point(k, l), "
        "where=[N >= 2, l - j + k - i >= 2, l - j - k + i >= 2*N])",
        exact=_of_bead,
        meaning="Averaging over loads lowers the variance by less than a third, since all of them "
        "act on a bead through the same radii; averaging over beads lowers σ(p) as 1/N.",
        quantities=(
            (OVER_LOADS, "variance of p of one bead, averaged over N neighbouring loads"),
            (OVER_BEADS, "the same below one load, averaged over N neighbouring beads"),
            (OVER_BOTH, "the same averaged over N loads and N beads, N² pairs"),
            (N, "number of neighbouring loads, or beads, or both, all beads inside all cones"),
            (l, "layer of the loaded beads, j that of the beads whose p is averaged"),
        ),
        claimed=lambda of: {
            "over loads it goes as 3(l + j)/2 − N/2, in units of (σ/r)²/(1−φ²)², as l → ∞ at "
            "fixed j/l and N/l":
                goes_as(of["loads"], (3 * (1 + z) - _X) / 2 * l * UNIT, *_far(j >= 3), growing=l,
                        at=_AT),
            **{f"over beads as (l + j)/N², {words}":
                   goes_as(of["beads"], (1 + z) / (_X**2 * l) * UNIT, *_far(*where), growing=l,
                           at=_AT)
               for words, *where in (("N < j", j >= N + 3), ("N > j", j >= 3, j + 3 <= N))},
            **{f"over both as (l + j)/N² − 1/(3N), {words}":
                   goes_as(of["both"], ((1 + z) / _X**2 - 1 / (3 * _X)) / l * UNIT, *_far(*where),
                           growing=l, at=_AT)
               for words, *where in (("N < j", j >= N + 3), ("N > j", j >= 3, j + 3 <= N))},
        },
    ),
    "B23": Row(
        number="B23",
        name="averaged_pairs",
        title="Response averaged over N loads, each with a bead of its own",
        call="variance(mean_over(response(i, j), N, i, k), load=point(k, l), "
        "where=[N >= 2, l - j + k - i >= 2, l - j - k + i >= 2])",
        exact=lambda: {
            "pairs": variance(
                mean_over(response(i, j), N, i, k), load=point(k, l), where=_BELOW_ONE
            ).named(OVER_PAIRS)
        },
        meaning="This averages along one packing instead of over the ensemble: each load is a "
        "sample. The standard deviation falls as 1/N at first, faster than for independent "
        "samples, and as 1/√N once N exceeds the height of the packing.",
        quantities=(
            (OVER_PAIRS, "variance of the mean of p over N neighbouring loads and a bead below "
             "each, inside its cone"),
            (N, "number of neighbouring loads, and of beads"),
            (l, "layer of the loaded beads, j that of the beads"),
        ),
        claimed=lambda of: {
            "over many pairs it goes as (1 − φ)²/(4N), in units of (σ/r)²/(1−φ²)², whatever "
            "the height":
                goes_as(of["pairs"], (1 - phi) ** 2 / (4 * N) * UNIT, j >= 2, j + 3 <= N,
                        Ge(k - i, 3), growing=N),
            "over few as (l + j)/N²: of Eq. 16 two thirds, over N²":
                goes_as(of["pairs"], (1 + z) * l / N**2 * UNIT, N >= 2, j - 2 >= N, Ge(k - i, 3),
                        growing=l, at={j: z * l}),
        },
    ),
}  # fmt: skip
