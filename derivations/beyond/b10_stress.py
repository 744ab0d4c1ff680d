"""Eq. B10: mean contact stress, to second order: what becomes of a constant stress ratio."""

from collections.abc import Iterator
from fractions import Fraction
from functools import cache

import sympy
from force_diffusion.derivations import eq11_total_force as eq11
from force_diffusion.derivations.beyond import b4_settling as b4
from force_diffusion.derivations.beyond import b5_mean_surface as b5
from force_diffusion.derivations.beyond.mean_forces import SUM_OF_RADII, combined
from force_diffusion.derivations.beyond.means import decide_in_field
from force_diffusion.derivations.framework.exact_cases import exact_cases, exact_steps
from force_diffusion.derivations.framework.follows import identity
from force_diffusion.derivations.framework.record import (
    Claim,
    Derivation,
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
    Verdict,
    all_of,
    decide_identity,
    from_test,
    undecided,
)
from force_diffusion.symbolic.mechanics import second_order
from force_diffusion.symbolic.mechanics.second_order import (
    mean_square,
    with_both,
    with_force,
    with_radii,
)
from force_diffusion.symbolic.notation import Symbol
from force_diffusion.symbolic.symbols import L_minus, L_plus, M, j, n_x, n_y, phi, r, sigma, t
from force_diffusion.symbolic.variances.means import covariance
from force_diffusion.symbolic.variances.variance import (
    ClosedForm,
    by_layer,
    leading,
    packings,
    value_at,
)

RATIO = Symbol(
    "stress_ratio",
    r"\frac{1+\phi}{1-\phi}\,\frac{\langle S_{xx}\rangle}{\langle S_{yy}\rangle}",
    "(1 + φ)/(1 − φ) ⟨S_xx⟩/⟨S_yy⟩",
)
VERTICAL = Symbol(
    "vertical_moment",
    r"\frac{\langle S_{yy}\rangle}{S_{yy}^{0}}",
    "⟨S_yy⟩/S⁰_yy",
)

PRINTED = (
    equation(
        terms(RATIO, -1),
        times(
            1 / (1 - phi**2) ** 2,
            terms(
                times(4, j, terms(1, phi)),
                minus(times(8, phi, M)),
                times(4, phi),
                phi**2,
                minus(phi**3),
            ),
            power(times(sigma, 1 / r), 2),
        ),
    ),
    equation(
        terms(VERTICAL, -1),
        times(
            1 / ((1 - phi**2) * (1 + phi)) / 2,
            terms(3, minus(phi**2), minus(times(4, terms(M, -j)))),
            power(times(sigma, 1 / r), 2),
        ),
    ),
)

S_XX = Symbol("moment_xx", "s_{xx}", "s_xx")
S_YY = Symbol("moment_yy", "s_{yy}", "s_yy")
"""f ℓ N_x² and f ℓ N_y² of a contact over their ordered values, at order ε²."""
MEAN_XX = Symbol("mean_xx", r"\langle s_{xx}\rangle", "⟨s_xx⟩")
MEAN_YY = Symbol("mean_yy", r"\langle s_{yy}\rangle", "⟨s_yy⟩")


def means() -> tuple[sympy.Expr, sympy.Expr]:
    """⟨s_xx⟩ and ⟨s_yy⟩ in the four means of products of first-order quantities."""
    first, second = (second_order.mean_of(part) for part in second_order.contact_moment())
    return first, second


def _forms(expression: sympy.Expr) -> dict[str, ClosedForm]:
    """A combination of the four means, in closed form at every layer."""
    tilt, force = eq11.in_radii(b4.TILT), eq11.in_radii(eq11.PRINTED.rhs) - 1

    def value(at: dict[sympy.Symbol, sympy.Expr], region: Region) -> RationalFunction:
        nu, rho, alpha = (e.xreplace(at) for e in (tilt, SUM_OF_RADII, force))
        known = {
            mean_square: covariance(nu, nu, region),
            with_radii: covariance(nu, rho, region),
            with_force: covariance(nu, alpha, region),
            with_both: covariance(alpha, rho, region),
        }
        return combined(expression, known)

    return by_layer(value)


@cache
def ratio_forms() -> dict[str, ClosedForm]:
    """The stress ratio over its ordered value, less 1, at every layer, exact to order σ²."""
    first, second = means()
    return _forms(sympy.expand(first - second))


@cache
def vertical_forms() -> dict[str, ClosedForm]:
    """⟨S_yy⟩ over its ordered value, less 1, likewise."""
    return _forms(means()[1])


def steps() -> Iterator[Step]:
    """The contact moment at order ε², its mean, and the covariances."""
    moment = second_order.contact_moment()
    first, second = means()
    yield Step(
        "The contacts of a layer have the moment S = Σ f ℓ N⊗N, ℓ = 2r + ερ being the distance of "
        "the centres. With f = 1 + εα₁ + ε²α₂ and N = n⁺ + εν b⁻ + ε²u₂, at order ε² and over the "
        "ordered values:",
        sympy.Tuple(equation(S_XX, moment[0]), equation(S_YY, moment[1])),
        identity({S_XX: moment[0], S_YY: moment[1]}),
        ("Eq. 11",),
    )
    yield Step(
        "In the mean, with ⟨α₂⟩ of Eq. B5 and ⟨u₂⟩ of Eq. B4:",
        sympy.Tuple(equation(MEAN_XX, first), equation(MEAN_YY, second)),
        identity({MEAN_XX: first, MEAN_YY: second}),
        ("step 1", "Eq. B4", "Eq. B5"),
    )
    yield Step(
        "f⁻ gives the same, and S_xy of the opposite sign. The ratio of the means changes by "
        "⟨s_xx⟩ − ⟨s_yy⟩; all covariances in closed form, for 2 ≤ j ≤ M − 2:",
        PRINTED[0],
        lambda _, candidate: decide(0, candidate),
        ("step 2", "Eq. 11"),
    )
    yield Step(
        "The vertical moment itself:",
        PRINTED[1],
        lambda _, candidate: decide(1, candidate),
        ("step 2", "Eq. 11"),
    )
    yield from exact_steps(
        RATIO - 1, ratio_forms(), "the four covariances there", "step 2", "step 3"
    )


def decide(part: int, candidate: sympy.Eq) -> Ruling:
    """Compare with the means from the covariances, for 2 ≤ j ≤ M − 2."""
    subject, forms = ((RATIO, ratio_forms), (VERTICAL, vertical_forms))[part]
    mean = 1 + forms()["interior"].expression
    ruling = decide_in_field(candidate.rhs, candidate.lhs.xreplace({subject: mean}))
    if ruling.verdict is Verdict.PROVED and not candidate.lhs.has(subject):
        return undecided("the left-hand side does not speak of the stress")
    return ruling


def search(candidate: sympy.Eq) -> str | None:
    """Exact packings in which the stress is another."""
    values = {**explicit.geometry(*witnesses.N, Fraction(1)), sigma: 1}
    for height, layer in ((4, 2), (5, 2), (5, 3)):
        x, y = witnesses.moments(height, witnesses.N)[layer]
        at = {**values, M: height, j: layer, RATIO: 1 + x - y, VERTICAL: 1 + y}
        try:
            left, right = (explicit.number(side, at) for side in candidate.args)
        except explicit.AmbiguousError:
            return None
        if left != right:
            return f"for M = {height}, j = {layer}, n_x = {witnesses.N[0]}: {left}, not {right}"
    return None


def _order_zero() -> Ruling:
    """Stress of the ordered packing under L⁺n⁺ + L⁻n⁻: its ratio, and the angle of its axes."""
    both = L_plus + L_minus
    xx, yy, xy = n_x**2 * both, n_y**2 * both, n_x * n_y * (L_plus - L_minus)
    turned = 2 * xy / (yy - xx)
    return all_of(
        decide_identity(xx / yy, (1 - phi) / (1 + phi)),
        decide_identity(
            turned.xreplace({L_minus: t * L_plus}),
            2 * n_x * n_y * (1 - t) / (phi * (1 + t)),
        ),
    )


def _leading() -> Ruling:
    stated = FIELD.from_sympy(4 * (j * (1 + phi) - 2 * phi * M) * (sigma / r) ** 2)
    stated = stated / FIELD.from_sympy((1 - phi**2) ** 2)
    return from_test(
        (leading(ratio_forms()["interior"].value) - stated).is_zero(),
        "to leading order the ratio changes by 4M[(1 + φ)z − 2φ](σ/r)²/(1−φ²)²",
    )


def _flux() -> Ruling:
    """The mean vertical momentum at order ε² vanishes, which is what ⟨α₂⟩ says."""
    balance = second_order.vertical_balance()
    return decide_identity(
        balance.xreplace({second_order.mean_force: second_order.FORCE}), sympy.Integer(0)
    )


def _witness(packing: SmallPacking) -> Ruling:
    values = {**explicit.geometry(*packing.n, Fraction(1)), sigma: 1}

    def pairs() -> Iterator[tuple[str, Fraction, Fraction]]:
        for height, layer, case in packings(5):
            x, y = witnesses.moments(height, packing.n)[layer]
            for name, forms, true in (
                ("ratio", ratio_forms(), x - y),
                ("vertical", vertical_forms(), y),
            ):
                stated = explicit.number(value_at(forms, height, layer, case), values)
                yield f"{name}, M = {height}, j = {layer}", stated, true

    return compare(pairs())


DERIVATION = Derivation(
    number="B10",
    name="stress",
    title="Mean contact stress under a surface load, to second order",
    symbols=(
        (RATIO, "mean contact moments S = Σ f ℓ N⊗N of a layer, over the ratio (1−φ)/(1+φ)"),
        (VERTICAL, "the vertical one over its value in the ordered packing"),
        *usual(sigma, r, M, phi),
    ),
    assumptions=(
        "the radii are independent, of zero mean and variance σ², of whatever law",
        "second order in δr",
        "a vertical surface load",
        "printed form: 2 ≤ j ≤ M − 2; exact forms of the ratio: every 0 ≤ j < M",
    ),
    premises=(eq11.DERIVATION, b4.DERIVATION, b5.DERIVATION),
    printed=PRINTED,
    domain=(sympy.Ge(j, 2), sympy.Ge(M, j + 2)),
    exact=lambda: exact_cases(RATIO - 1, ratio_forms(), "second order"),
    steps=steps,
    decide=decide,
    search=search,
    claims=(
        Claim(
            "in the ordered packing σ_xx = (1−φ)/(1+φ) σ_yy for every load, while the principal "
            "axes turn with the load",
            _order_zero,
        ),
        Claim(
            "to leading order the ratio changes by 4M[(1 + φ)z − 2φ](σ/r)²/(1−φ²)²: no constant",
            _leading,
        ),
        Claim("the mean vertical momentum through a layer does not change", _flux),
    ),
    witnesses=(Witness("exact packings, ε²: both moments of every layer, as fractions", _witness),),
    remarks=(
        "S_yy, the contact moment, and the vertical momentum through a horizontal cut differ at "
        "order σ²: the latter is fixed by the load, the former weighs each contact's momentum with "
        "its height, and contacts that stand steeper carry other forces.",
    ),
)

if __name__ == "__main__":
    from force_diffusion.derivations.commands.alone import run_alone

    raise SystemExit(run_alone(DERIVATION))
