"""Eq. B18: mean shear stress under loads in any direction, to second order; the principal axes."""

from collections.abc import Iterator
from fractions import Fraction
from functools import cache

import sympy
from force_diffusion.derivations import eq11_total_force as eq11
from force_diffusion.derivations import eq14_bulk_diffusion as eq14
from force_diffusion.derivations.beyond import b3_bulk_direction as b3
from force_diffusion.derivations.beyond import b4_settling as b4
from force_diffusion.derivations.beyond import b10_stress as b10
from force_diffusion.derivations.beyond import b15_mean_surface_direction as b15
from force_diffusion.derivations.beyond import b16_mean_bulk_direction as b16
from force_diffusion.derivations.beyond import b17_stress_bulk as b17
from force_diffusion.derivations.beyond import t1_forces as b1
from force_diffusion.derivations.beyond.mean_directions import in_means, mirrored, ratio_stays
from force_diffusion.derivations.beyond.means import decide_in_field
from force_diffusion.derivations.beyond.stress import Stress
from force_diffusion.derivations.framework.exact_cases import exact_cases, exact_steps
from force_diffusion.derivations.framework.follows import identity
from force_diffusion.derivations.framework.record import (
    Claim,
    Derivation,
    ExactCase,
    Step,
    Witness,
    usual,
)
from force_diffusion.derivations.witnesses import second_order as witnesses
from force_diffusion.derivations.witnesses.draws import SmallPacking
from force_diffusion.derivations.witnesses.squared_weights import compare
from force_diffusion.symbolic.algebra import explicit
from force_diffusion.symbolic.algebra.affine import Region
from force_diffusion.symbolic.algebra.exact import FIELD, RationalFunction
from force_diffusion.symbolic.as_printed import equation, minus, power, terms, times
from force_diffusion.symbolic.kernel.decisions import (
    Ruling,
    all_of,
    from_test,
    undecided,
)
from force_diffusion.symbolic.mechanics import second_order
from force_diffusion.symbolic.mechanics.second_order import FORCE_AT_ANGLE
from force_diffusion.symbolic.notation import Symbol
from force_diffusion.symbolic.symbols import M, j, phi, r, sigma, t
from force_diffusion.symbolic.variances.orders import UNIT
from force_diffusion.symbolic.variances.variance import (
    ClosedForm,
    by_layer,
    leading,
    packings,
    value_at,
)

SUBJECTS = tuple(
    Symbol(
        f"shear_{load}",
        rf"\left(\frac{{\langle S_{{xy}}\rangle}}{{S_{{xy}}^{{0}}}}\right)_{{\mathrm{{{load}}}}}",
        f"(⟨S_xy⟩/S⁰_xy)_{load}",
    )
    for load in ("surface", "bulk")
)
AXES = tuple(
    Symbol(
        f"axes_{load}",
        r"\left(2 n_{x}n_{y}\,\frac{1-t}{1+t}\operatorname{cot}2\psi\right)"
        rf"_{{\mathrm{{{load}}}}}",
        f"[2n_x n_y (1−t)/(1+t) cot 2ψ]_{load}",
    )
    for load in ("surface", "bulk")
)
S_XY = Symbol("moment_xy", "s_{xy}", "s_xy")
MEAN_XY = Symbol("mean_xy", r"\langle s_{xy}\rangle", "⟨s_xy⟩")
"""f ℓ N_x N_y of a contact along n⁺ over its ordered value, at order ε², and its mean."""

_HALF_UNIT = 1 / ((1 - phi**2) * (1 + phi)) / 2
_VARIANCE = power(times(sigma, 1 / r), 2)
_OF_AXES = (times(phi, terms(2, -phi, phi**2)), minus(times(4, j, terms(1, minus(times(3, phi))))))
PRINTED = (
    equation(
        terms(SUBJECTS[0], -1),
        times(_HALF_UNIT, terms(times(4, M), minus(times(12, j)), -3, -(phi**2)), _VARIANCE),
    ),
    equation(
        terms(SUBJECTS[1], -1),
        times(
            _HALF_UNIT,
            terms(times(2, M), minus(times(10, j)), -1, -(phi**2), (1 - phi) / (M - j)),
            _VARIANCE,
        ),
    ),
    equation(terms(AXES[0], -phi), times(_HALF_UNIT, terms(*_OF_AXES), _VARIANCE)),
    equation(
        terms(AXES[1], -phi),
        times(_HALF_UNIT, terms(*_OF_AXES, minus((1 - phi**2) / (M - j))), _VARIANCE),
    ),
)

LOADS = {
    "surface": (lambda: b1.in_radii(0), b10.STRESS),
    "bulk": (lambda: eq11.in_radii(b1.bulk_force()), b17.STRESS),
}
"""f⁺ in the radii for any direction of each load, and its stress for a vertical one."""


@cache
def exact_forms(load: str) -> dict[str, ClosedForm]:
    """⟨S_xy⟩ over its ordered value, less 1, at every layer, exact to order σ²."""
    part = second_order.mean_of(second_order.contact_moment()[2], FORCE_AT_ANGLE)
    force = LOADS[load][0]()

    def value(at: dict[sympy.Symbol, sympy.Expr], region: Region) -> RationalFunction:
        own = in_means(part, force, at, region)
        ordered = FIELD.from_sympy(1 - t)
        return ((own - FIELD.generator(t) * mirrored(own)) / ordered).reduced()

    return by_layer(value)


@cache
def axes(load: str) -> RationalFunction:
    """The cotangent less φ, in the units of ``AXES``, for 2 ≤ j ≤ M − 2."""
    vertical, shear = LOADS[load][1], exact_forms(load)
    shares = (vertical.vertical(), vertical.ratio(), shear)
    total = FIELD.zero
    for factor, forms in zip((phi, (phi - 1) / 2, -phi), shares, strict=True):
        total = total + FIELD.from_sympy(factor) * forms["interior"].value
    return total.reduced()


def changes() -> tuple[RationalFunction, ...]:
    """What is printed, less the ordered value, for 2 ≤ j ≤ M − 2."""
    shear = (exact_forms(load)["interior"].value for load in LOADS)
    return (*shear, *map(axes, LOADS))


def at_every_layer() -> dict[str, ExactCase]:
    """The exact shear of both loads."""
    surface, bulk = (
        exact_cases(subject - 1, exact_forms(load), "second order")
        for subject, load in zip(SUBJECTS, LOADS, strict=True)
    )
    return surface | {f"bulk-{place}": one for place, one in bulk.items()}


def decide(part: int, candidate: sympy.Eq) -> Ruling:
    """Compare with the means from the covariances, for 2 ≤ j ≤ M − 2."""
    subject, ordered = (*SUBJECTS, *AXES)[part], (1, 1, phi, phi)[part]
    if not candidate.lhs.has(subject):
        return undecided("the left-hand side does not speak of the stress")
    mean = ordered + changes()[part].to_sympy()
    return decide_in_field(candidate.rhs, candidate.lhs.xreplace({subject: mean}))


def _exact(
    height: int, layer: int, n: tuple[Fraction, Fraction], share: Fraction
) -> dict[sympy.Symbol, Fraction]:
    """What exact packings say of all that is printed, less the ordered value, for r = σ = 1."""
    x, y = n[0] ** 2, n[1] ** 2
    found: dict[sympy.Symbol, Fraction] = {}
    for load, shear, axis in zip(LOADS, SUBJECTS, AXES, strict=True):
        xx, yy, xy = witnesses.moments(height, n, load, share)[layer]
        found |= {shear: xy, axis: y * yy - x * xx - (y - x) * xy}
    return found


def search(candidate: sympy.Eq) -> str | None:
    """Exact packings in which the stress is another, at t = 3/5."""

    def exact(height: int, layer: int) -> dict[sympy.Symbol, Fraction]:
        x, y = witnesses.N
        found = _exact(height, layer, witnesses.N, witnesses.SHARE)
        return {
            subject: (y * y - x * x if subject in AXES else 1) + change
            for subject, change in found.items()
        }

    return witnesses.fails(candidate, exact)


def steps() -> Iterator[Step]:
    """The shear part of the contact moment, its mean, both branches; the axes."""
    moment = second_order.contact_moment()[2]
    mean = second_order.mean_of(moment, FORCE_AT_ANGLE)
    yield Step(
        "As in Eq. B10, a contact along n⁺ has at order ε², over the ordered value,",
        equation(S_XY, moment),
        identity({S_XY: moment}),
        ("Eq. B10",),
    )
    yield Step(
        "In the mean, with ⟨α₂⟩ of Eqs. B15 and B16 and ⟨u₂⟩ of Eq. B4:",
        equation(MEAN_XY, mean),
        identity({MEAN_XY: mean}),
        ("step 1", "Eq. B4", "Eq. B15", "Eq. B16"),
    )
    yield Step(
        "A contact along n⁻ is a mirror image: −t times the same, with 1/t in place of t. Of both "
        "together t drops out. With α₁ of Eqs. B1 and B3, for 2 ≤ j ≤ M − 2:",
        sympy.Tuple(*PRINTED[:2]),
        decide,
        ("Eq. 11", "Eq. B1", "Eq. B3", "step 2"),
    )
    yield Step(
        "One principal axis stands at the angle ψ to the vertical, cot 2ψ = (S_yy − S_xx)/2S_xy. "
        "With S_xx and S_yy of Eqs. B10 and B17, which do not know the load's direction:",
        sympy.Tuple(*PRINTED[2:]),
        lambda part, candidate: decide(part + 2, candidate),
        ("Eq. B10", "Eq. B17", "step 3"),
    )
    for load, subject in zip(LOADS, SUBJECTS, strict=True):
        yield from exact_steps(
            subject - 1,
            exact_forms(load),
            f"{load} load, the covariances there",
            "step 2",
            "step 3",
        )


def _any_direction() -> Ruling:
    return all_of(
        from_test(
            not any(form.value.holds(t) for load in LOADS for form in exact_forms(load).values()),
            "S_xy over its ordered value does not hold t",
        ),
        ratio_stays(eq11.in_radii(b1.bulk_force()), eq11.in_radii(eq14.bulk_force())),
    )


def _leading() -> Ruling:
    turned = -2 * j * (1 - 3 * phi)
    stated = (2 * M - 6 * j, M - 5 * j, turned, turned)
    return from_test(
        all(
            (leading(value) - FIELD.from_sympy(one * (1 - phi) * UNIT)).is_zero()
            for value, one in zip(changes(), stated, strict=True)
        ),
        "2M(1 − 3z), M(1 − 5z) and, for both loads, −2j(1 − 3φ), in units of (σ/r)²/[(1−φ²)(1+φ)]",
    )


def _by_flux() -> Ruling:
    """S_xy over the area less the flux, against the same of S_yy, in every layer."""

    def differences(load: str, stress: Stress) -> Iterator[RationalFunction]:
        vertical, flux = stress.vertical(), stress.by_flux()
        for case, form in exact_forms(load).items():
            yield form.value - vertical[case].value + flux[case].value + flux[case].value

    found = (one for load, (_, stress) in LOADS.items() for one in differences(load, stress))
    return from_test(
        all(one.is_zero() for one in found),
        "σ_xy by contact moments exceeds its flux by what σ_yy falls short of its own, as shares",
    )


def _witness(packing: SmallPacking) -> Ruling:
    plus, other = packing.components
    share = other / plus if other != plus else witnesses.SHARE
    values = {**explicit.geometry(*packing.n, Fraction(1)), sigma: 1}
    inside = {axis: value.to_sympy() for axis, value in zip(AXES, changes()[2:], strict=True)}

    def pairs() -> Iterator[tuple[str, Fraction, Fraction]]:
        for height, layer, case in packings(4):
            for subject, true in _exact(height, layer, packing.n, share).items():
                if subject in AXES and case != "interior":
                    continue
                form = inside.get(subject)
                if form is None:
                    load = tuple(LOADS)[SUBJECTS.index(subject)]
                    form = value_at(exact_forms(load), height, layer, case)
                stated = explicit.number(form, {**values, M: height, j: layer})
                yield f"{subject.name}, M = {height}, j = {layer}", stated, true

    return compare(pairs())


DERIVATION = Derivation(
    number="B18",
    name="shear_stress",
    title="Mean shear stress under loads in any direction, to second order",
    symbols=(
        (SUBJECTS[0], "mean contact moment S_xy of a layer over that of the ordered packing"),
        (SUBJECTS[1], "the same under a bulk load"),
        (AXES[0], "ψ: angle of a principal axis of ⟨S⟩ to the vertical, surface load"),
        (AXES[1], "the same under a bulk load"),
        (t, "L⁻/L⁺ of the load −(L⁺n⁺ + L⁻n⁻), t ≠ 1"),
        *usual(sigma, r, M, phi),
    ),
    assumptions=(
        "the radii are independent, of zero mean and variance σ², of whatever law",
        "second order in δr",
        "L⁺, L⁻ > 0, not equal; a load on the surface, or the same on every bead above the base",
        "printed form: 2 ≤ j ≤ M − 2; exact forms of the shear: every 0 ≤ j < M",
    ),
    premises=(
        b1.B1,
        *(one.DERIVATION for one in (eq11, eq14, b3, b4, b10, b15, b16, b17)),
    ),
    printed=PRINTED,
    domain=(sympy.Ge(j, 2), sympy.Ge(M, j + 2)),
    exact=at_every_layer,
    steps=steps,
    decide=decide,
    search=search,
    claims=(
        Claim("no component of the mean stress, over its ordered value, knows t", _any_direction),
        Claim("leading orders: the axes turn with the height j, whatever M is", _leading),
        Claim("moments and flux differ for σ_xy as for σ_yy, with the opposite sign", _by_flux),
    ),
    witnesses=(Witness("exact packings, ε²: all moments of every layer, as fractions", _witness),),
)

if __name__ == "__main__":
    from force_diffusion.derivations.commands.alone import run_alone

    raise SystemExit(run_alone(DERIVATION))
