"""Eq. B9: the mean response to a point load, to second order: a plateau inside of the cone."""

from collections.abc import Iterator
from fractions import Fraction
from functools import cache

import sympy
from force_diffusion.derivations import eq11_total_force as eq11
from force_diffusion.derivations import eq16_response as eq16
from force_diffusion.derivations.beyond import b4_settling as b4
from force_diffusion.derivations.beyond.mean_forces import SUM_OF_RADII
from force_diffusion.derivations.beyond.means import decide_in_field
from force_diffusion.derivations.framework.follows import identity, linear
from force_diffusion.derivations.framework.record import Claim, Derivation, Step, Witness, usual
from force_diffusion.derivations.parts import cone
from force_diffusion.derivations.witnesses import second_order as witnesses
from force_diffusion.derivations.witnesses.draws import SmallPacking
from force_diffusion.derivations.witnesses.squared_weights import compare
from force_diffusion.symbolic.algebra import explicit
from force_diffusion.symbolic.algebra.affine import Region
from force_diffusion.symbolic.algebra.exact import FIELD
from force_diffusion.symbolic.as_printed import equation, minus, power, terms, times
from force_diffusion.symbolic.kernel.decisions import (
    Ruling,
    all_of,
    decide_identity,
    from_test,
    undecided,
)
from force_diffusion.symbolic.mechanics import second_order
from force_diffusion.symbolic.mechanics.contacts import radii
from force_diffusion.symbolic.mechanics.second_order import (
    SETTLED,
    TURN,
    d_minus,
    d_plus,
    mean_square,
    tilt,
    with_force,
    with_radii,
)
from force_diffusion.symbolic.notation import Symbol
from force_diffusion.symbolic.printing.text import text
from force_diffusion.symbolic.symbols import (
    Dot,
    b_minus,
    b_plus,
    j,
    l,
    n_x,
    n_y,
    p,
    phi,
    q,
    r,
    sigma,
)
from force_diffusion.symbolic.variances.cases import Case
from force_diffusion.symbolic.variances.means import covariance, covariances_by_case
from force_diffusion.symbolic.variances.orders import UNIT

INSIDE = Symbol(
    "mean_inside",
    r"\frac{\langle f^{\pm}_{ij}\rangle_{\mathrm{inside}}}{f^{\mathrm{load}}/2 n_{y}}",
    "⟨f^±_ij inside⟩/(f_load/2n_y)",
)
ON_LEG = Symbol(
    "mean_on_leg",
    r"\frac{\langle f_{ij}\rangle_{\mathrm{leg}}}{f^{\mathrm{load}}/2 n_{y}}",
    "⟨f_ij on a leg⟩/(f_load/2n_y)",
)

PRINTED = (
    equation(
        INSIDE,
        times(
            1 / (1 - phi**2) ** 2,
            terms(times(2, phi**2), times(3, phi), -1),
            power(times(sigma, 1 / r), 2),
        ),
    ),
    equation(
        terms(ON_LEG, -1),
        times(
            1 / (1 - phi**2) ** 2,
            terms(
                times(2, l, terms(1, -phi) ** 2),
                minus(times(terms(times(2, phi**2), phi, 1), terms(l, -j))),
                minus(times(sympy.Rational(1, 2), phi**3)),
                times(sympy.Rational(9, 4), phi**2),
                times(3, phi),
                minus(sympy.Rational(3, 4)),
            ),
            power(times(sigma, 1 / r), 2),
        ),
    ),
)


@cache
def _inside() -> tuple[Case, ...]:
    """⟨να₁⟩/σ² of a contact f⁺ inside of the cone, by case: p, q ≥ 1."""
    force, slant = eq11.in_radii(cone.UPPER_RIGHT), eq11.in_radii(b4.TILT)
    return tuple(covariances_by_case(slant, force, {j: 0, p: 1, q: 1}, 3))


@cache
def _leg() -> tuple[Case, ...]:
    """The same of a contact of the left leg, p ≥ 1 steps below the load."""
    force = eq11.in_radii(cone.LEG_CONTACT).xreplace(cone.ON_LEFT_LEG)
    return tuple(covariances_by_case(eq11.in_radii(b4.TILT), force, {j: 0, p: 1}, 3))


_SCALE = sigma**2 / (r**2 * (1 - phi**2))
WITHIN = 2 * phi * _SCALE
"""⟨να₁⟩ of every contact inside of the cone, j ≥ 2."""
AT_LOAD = (8 * phi * j + 2 * phi**3 - phi**2 + 6 * phi - 1) / 4 * _SCALE
"""⟨να₁⟩ of a leg's contact below the loaded bead, j ≥ 2."""
FURTHER = phi * (4 * j + phi**2 + 2) / 2 * _SCALE
"""⟨να₁⟩ of a leg's contact two or more steps below the load, j ≥ 2."""


@cache
def turned() -> tuple[sympy.Expr, sympy.Expr]:
    """⟨n⁺·u₂⟩ and ⟨n⁻·u₂⟩ of a contact along n⁺ in layer j ≥ 1 (Eq. B4)."""
    square, _ = b4.tilt_variance()
    slant = eq11.in_radii(b4.TILT)
    both = covariance(slant, SUM_OF_RADII, Region({j: 1})).to_sympy()
    means = {d_plus: SETTLED, d_minus: SETTLED, tilt * radii: with_radii}
    first, second = (
        sympy.expand(part).subs(means).subs({mean_square: square.to_sympy(), with_radii: both})
        for part in TURN
    )
    return first, second


def along(own: sympy.Expr, other: sympy.Expr) -> sympy.Expr:
    """b⁺·v of a vector with the parts ``own`` along n⁺ and ``other`` along n⁻."""
    return (own - phi * other) / (1 - phi**2)


def kept(upper: sympy.Expr, lower: sympy.Expr) -> sympy.Expr:
    """b⁺ times ⟨α₁δn⟩ of the upper contacts less the lower: (⟨να₁⟩ of f⁺, of f⁻) of each."""
    own, other = upper[0] - lower[0], upper[1] - lower[1]
    return (-phi * own + other) / (1 - phi**2)


def above(value: sympy.Expr) -> sympy.Expr:
    """The same in the layer above."""
    return value.xreplace({j: j + 1})


ZERO = sympy.Integer(0)


def entry(upper: sympy.Expr = FURTHER) -> sympy.Expr:
    """⟨α₂⟩ of the f⁺ that leaves the right leg, j ≥ 2.

    ``upper`` is ⟨να₁⟩ of the leg's contact above: another one straight below the loaded bead.
    """
    own, other = turned()  # of f⁺; those of f⁻ are the mirror image
    leg = along(above(other) - other, above(own) - own)
    return kept((ZERO, above(upper)), (WITHIN, FURTHER)) + leg


def passed_on() -> sympy.Expr:
    """What f⁺ gains at a bead inside of the cone."""
    return kept((WITHIN, WITHIN), (WITHIN, WITHIN))


def leg_step(upper: sympy.Expr = FURTHER) -> sympy.Expr:
    """What the left leg gains at one bead, ``upper`` being ⟨να₁⟩ of the contact above it."""
    own, other = turned()
    return kept((above(upper), ZERO), (FURTHER, WITHIN)) + along(
        above(own) - own, above(other) - other
    )


def split() -> sympy.Expr:
    """⟨α₂⟩ of the leg's first contact, in layer j: the loaded bead's balance, nothing above."""
    own, other = turned()
    return kept((ZERO, ZERO), (AT_LOAD, AT_LOAD)) - along(own + other, other + own)


def leg() -> sympy.Expr:
    """⟨α₂⟩ on the leg in layer j ≥ 2, two or more steps below the load: all steps, summed."""
    first = split().xreplace({j: l - 1})
    second = leg_step(AT_LOAD).xreplace({j: l - 2})
    return first + second + (l - 2 - j) * leg_step()


LOSS = Symbol("leg_loss", r"\Delta_{\mathrm{leg}}", "loss of a leg per layer")


def _stated(part: int, candidate: sympy.Eq) -> Ruling:
    """⟨να₁⟩ in every case of j ≥ 2: inside, further down a leg, on its first contact."""
    if candidate.lhs != with_force:
        return undecided(f"the left-hand side is not {text(with_force)}")
    cases = _leg() if part else _inside()
    deep = [
        case
        for case in cases
        if case.at.get(j, 2) >= 2
        and case.lower.get(j, 2) >= 2
        and (not part or (case.at.get(p) == 1) == (part == 2))
    ]
    stated = FIELD.from_sympy(candidate.rhs / sigma**2)
    return from_test(
        bool(deep) and all((case.value - case.put_in(stated)).is_zero() for case in deep),
        f"{len(deep)} cases, which cover all such contacts with j ≥ 2, agree",
    )


def steps() -> Iterator[Step]:
    """Balance every bead in the mean; the sources are three covariances."""
    yield Step(
        "At order ε² the momentum of a contact is α₂n + α₁δn + α₀u₂, with α₀ = 1 on the legs of "
        "the cone and 0 inside. In the mean it balances at every bead: along b⁺, with δn^± = "
        "ν b^∓, ⟨α₂⟩ of the lower f⁺ is that of the upper one, and what is lost of ⟨να₁⟩ and ⟨u₂⟩ "
        "on the way. For that,",
        sympy.Tuple(
            equation(Dot(b_plus, b_plus), 1 / (1 - phi**2)),
            equation(Dot(b_plus, b_minus), -phi / (1 - phi**2)),
        ),
        linear(),
    )
    yield Step(
        "α₁ is Eq. 10 inside, Eqs. 7 and 9 on a leg. ⟨να₁⟩ inside, on a leg, and on its first "
        "contact, for j ≥ 2:",
        sympy.Tuple(*(equation(with_force, one) for one in (WITHIN, FURTHER, AT_LOAD))),
        _stated,
        ("Eq. 11", "Eq. 16"),
    )
    yield Step(
        "Inside it is the same for all contacts: nothing is lost, and f⁺ stays as it entered. At "
        "the right leg it enters with what the tilt of the leg changes from layer to layer, the "
        "same at each height:",
        PRINTED[0],
        decide,
        ("Eq. B4", "step 1", "step 2"),
    )
    yield Step(
        "The leg pays for it: it loses per layer",
        equation(LOSS, FIELD.from_sympy(-leg_step()).to_sympy()),
        identity({LOSS: -leg_step()}),
        ("Eq. B4", "step 1", "step 2"),
    )
    yield Step(
        "From the loaded bead downwards, summed:",
        PRINTED[1],
        lambda _, candidate: decide(1, candidate),
        ("step 4",),
    )


def decide(part: int, candidate: sympy.Eq) -> Ruling:
    """Compare with the balance of the beads."""
    subject, mean = ((INSIDE, entry()), (ON_LEG, 1 + leg()))[part]
    ruling = decide_in_field(candidate.rhs, candidate.lhs.xreplace({subject: mean}))
    return ruling


LEVEL, HIGHER = 5, 6
N = witnesses.N


def search(candidate: sympy.Eq) -> str | None:
    """Exact packings in which the mean response is another."""
    found = witnesses.response(LEVEL, N)
    at: tuple[int, ...] = (2, 3)
    values = {**explicit.geometry(*N, Fraction(1)), sigma: 1, l: LEVEL}
    for layer in at:
        # contact f⁺ beside the right leg; contact f⁺ of the left leg
        depth = LEVEL - layer
        values |= {
            j: layer,
            INSIDE: found[(depth - 2, layer), "+"],
            ON_LEG: 1 + found[(-depth, layer), "+"],
        }
        if layer == LEVEL - 2 and candidate.has(INSIDE):
            continue  # it has turned at the bead straight below the load
        try:
            left, right = (explicit.number(side, values) for side in candidate.args)
        except explicit.AmbiguousError:
            return None
        if left != right:
            return f"for l = {LEVEL}, j = {layer}, n_x = {N[0]}: {left} on the left, {right}"
    return None


def _constant() -> Ruling:
    """What enters is the same in all layers, and nothing changes it."""
    return all_of(
        decide_identity(passed_on(), ZERO),
        decide_identity(above(entry()), entry()),
        decide_identity(above(leg_step()), leg_step()),
    )


FIRST_LINES = (7 * phi**2 + 14 * phi - 5) / 4 * UNIT
"""⟨α₂⟩ on the two lines of contacts that start at the bead straight below the load, j ≥ 2."""


def _first_lines() -> Ruling:
    return decide_identity(entry(AT_LOAD), FIRST_LINES)


def _unit_vectors() -> Ruling:
    """|b|² and b⁺·b⁻, and that b⁺ takes the part stated out of a vector."""
    plus, other = second_order.B_PLUS, second_order.B_MINUS
    return all_of(
        decide_identity(plus.dot(plus), 1 / (1 - phi**2)),
        decide_identity(plus.dot(other), -phi / (1 - phi**2)),
        decide_identity(along(n_x, -n_x), plus[0]),
        decide_identity(along(n_y, n_y), plus[1]),
    )


def _sign() -> Ruling:
    """The plateau as its roots say, and what the leg loses, which is positive."""
    root = (sympy.sqrt(17) - 3) / 4
    return all_of(
        decide_identity(
            sympy.expand(2 * (phi - root) * (phi + root + sympy.Rational(3, 2))),
            2 * phi**2 + 3 * phi - 1,
        ),
        decide_identity(-leg_step(), (2 * phi**2 + phi + 1) * UNIT),
        decide_identity(8 * (2 * phi**2 + phi + 1), (4 * phi + 1) ** 2 + 7),
    )


def _witness(packing: SmallPacking) -> Ruling:
    values = {**explicit.geometry(*packing.n, Fraction(1)), sigma: 1, l: HIGHER}

    def pairs() -> Iterator[tuple[str, Fraction, Fraction]]:
        found = witnesses.response(HIGHER, packing.n)
        for layer in range(2, HIGHER - 1):
            at = {**values, j: layer}
            depth = HIGHER - layer
            for branch, side in (("+", 1), ("-", -1)):
                yield (
                    f"leg, j = {layer}, f{branch}",
                    explicit.number(PRINTED[1].rhs, at),
                    found[(-side * depth, layer), branch],
                )
                for across in range(-depth + 4, depth, 2):
                    yield (
                        f"i − k = {side * across}, j = {layer}, f{branch}",
                        explicit.number(PRINTED[0].rhs, at),
                        found[(side * across, layer), branch],
                    )
                yield (
                    f"first line, j = {layer}, f{branch}",
                    explicit.number(FIRST_LINES, at),
                    found[(side * (2 - depth), layer), branch],
                )
                outside = found[(side * depth, layer), branch]
                yield f"outside, j = {layer}, f{branch}", Fraction(0), outside

    return compare(pairs())


DERIVATION = Derivation(
    number="B9",
    name="mean_response",
    title="Mean response to a point load, to second order",
    symbols=(
        (INSIDE, "mean of a contact inside of the cone of the load on bead (k, l)"),
        (ON_LEG, "mean on a leg of the cone, over its value in the ordered packing"),
        (l, "layer of the loaded bead"),
        *usual(sigma, r, phi),
    ),
    assumptions=(
        "the radii are independent, of zero mean and variance σ², of whatever law",
        "second order in δr",
        "inside: 2 ≤ j ≤ l − 3, and not on the two lines of contacts that start at the bead "
        "straight below the load; leg: 2 ≤ j ≤ l − 2",
    ),
    premises=(eq11.DERIVATION, eq16.DERIVATION, b4.DERIVATION),
    printed=PRINTED,
    domain=(sympy.Ge(j, 2), sympy.Ge(l, j + 3)),  # where both lines have a contact
    steps=steps,
    decide=decide,
    search=search,
    claims=(
        Claim("the parts of a vector along b⁺", _unit_vectors),
        Claim(
            "what enters the cone is the same at every height j ≥ 2, and forces pass through the "
            "beads inside unchanged: the mean response inside is a plateau",
            _constant,
        ),
        Claim(
            "on the two lines of contacts that start at the bead straight below the load it is "
            "¼(7φ² + 14φ − 5)(σ/r)²/(1−φ²)² for 2 ≤ j ≤ l − 2",
            _first_lines,
        ),
        Claim(
            "the plateau is positive for φ > (√17 − 3)/4 and negative below; the legs lose "
            "2φ² + φ + 1 > 0 per layer, in units of (σ/r)²/(1−φ²)²",
            _sign,
        ),
    ),
    witnesses=(
        Witness("exact packings, ε²: the mean of every contact of a cone, as fractions", _witness),
    ),
    remarks=(
        "The paper leaves open whether ensemble averaging and coarse graining agree. In the mean "
        "they do, exactly: loads superpose, and the ensemble is the same at every place, so that "
        "the response to N equal loads, averaged over N contacts, has the mean of this equation "
        "for each load and contact. Neither gives anything but two rays at order σ⁰; at order σ² "
        "both give the plateau between them.",
        "The plateau does not depend on the height, the depth or the place, but for the two layers "
        "of contacts next to the base, j = 0 and 1, which go their own way: the response does not "
        "spread as a diffusing ray would, and it does not decay away from the legs.",
    ),
)

if __name__ == "__main__":
    from force_diffusion.derivations.commands.alone import run_alone

    raise SystemExit(run_alone(DERIVATION))
