"""Eq. B10: mean contact stress, to second order: what becomes of a constant stress ratio."""

from collections.abc import Iterator
from functools import cache

import sympy
from force_diffusion.derivations import eq11_total_force as eq11
from force_diffusion.derivations.beyond import t4_second_order as t4
from force_diffusion.derivations.beyond.stress import (
    BY_FLUX,
    MEAN_XX,
    MEAN_YY,
    RATIO,
    S_XX,
    S_YY,
    SYMBOLS,
    VERTICAL,
    Stress,
    means,
)
from force_diffusion.derivations.framework.exact_cases import exact_cases, exact_steps
from force_diffusion.derivations.framework.follows import identity
from force_diffusion.derivations.framework.record import Claim, Derivation, Step, usual
from force_diffusion.symbolic.as_printed import equation, minus, power, terms, times
from force_diffusion.symbolic.kernel.decisions import Ruling, all_of, decide_identity
from force_diffusion.symbolic.mechanics import second_order
from force_diffusion.symbolic.symbols import L_minus, L_plus, M, j, n_x, n_y, phi, r, sigma, t

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
    equation(
        terms(BY_FLUX, -1),
        times(
            1 / ((1 - phi**2) * (1 + phi)) / 2,
            terms(3, times(8, j), minus(times(4, M))),
            power(times(sigma, 1 / r), 2),
        ),
    ),
)

STRESS = Stress("surface", cache(lambda: eq11.in_radii(eq11.PRINTED.rhs)))


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
        lambda _, candidate: STRESS.decide(0, candidate),
        ("step 2", "Eq. 11"),
    )
    yield Step(
        "The vertical moment itself:",
        PRINTED[1],
        lambda _, candidate: STRESS.decide(1, candidate),
        ("step 2", "Eq. 11"),
    )
    yield from STRESS.flux_steps(2)
    yield Step(
        "The four covariances put in there:",
        PRINTED[2],
        lambda _, candidate: STRESS.decide(2, candidate),
        ("Eq. 11", "step 5"),
    )
    yield from exact_steps(
        RATIO - 1, STRESS.ratio(), "the four covariances there", "step 2", "step 3"
    )


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
    stated = 4 * (j * (1 + phi) - 2 * phi * M) * (sigma / r) ** 2 / (1 - phi**2) ** 2
    return STRESS.leading_is(stated, "4M[(1 + φ)z − 2φ](σ/r)²/(1−φ²)²")


def _flux() -> Ruling:
    """The mean vertical momentum at order ε² vanishes, which is what ⟨α₂⟩ says."""
    balance = second_order.vertical_balance()
    return decide_identity(
        balance.xreplace({second_order.mean_force: second_order.FORCE}), sympy.Integer(0)
    )


DERIVATION = Derivation(
    number="B10",
    name="stress",
    title="Mean contact stress under a surface load, to second order",
    symbols=(
        *SYMBOLS,
        *usual(sigma, r, M, phi),
    ),
    assumptions=(
        "the radii are independent, of zero mean and variance σ², of whatever law",
        "second order in δr",
        "a vertical surface load",
        "printed form: 2 ≤ j ≤ M − 2; exact forms of the ratio: every 0 ≤ j < M",
    ),
    premises=(eq11.DERIVATION, t4.B4, t4.B5),
    printed=PRINTED,
    domain=(sympy.Ge(j, 2), sympy.Ge(M, j + 2)),
    exact=lambda: exact_cases(RATIO - 1, STRESS.ratio(), "second order"),
    steps=steps,
    decide=STRESS.decide,
    search=STRESS.search,
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
        Claim("over all layers, edges included, moments and flux agree", STRESS.virial),
    ),
    witnesses=STRESS.witnesses,
    remarks=(
        "S_yy, the contact moment, and the vertical momentum through a horizontal cut differ at "
        "order σ²: the latter is fixed by the load, the former weighs each contact's momentum with "
        "its height, and contacts that stand steeper carry other forces.",
    ),
)

if __name__ == "__main__":
    from force_diffusion.derivations.commands.alone import run_alone

    raise SystemExit(run_alone(DERIVATION))
