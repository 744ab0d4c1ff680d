"""Eq. 15: σ_f/⟨f⟩ averaged over the system, and the height M* at which forces turn tensile."""

from collections.abc import Iterator
from functools import cache

import sympy
from force_diffusion.derivations import eq03_extrapolation as eq03
from force_diffusion.derivations import eq13_surface_diffusion as eq13
from force_diffusion.derivations import eq14_bulk_diffusion as eq14
from force_diffusion.derivations.framework.follows import Decide, identity
from force_diffusion.derivations.framework.record import (
    Claim,
    Derivation,
    ExactCase,
    Missed,
    Step,
    Witness,
    usual,
)
from force_diffusion.derivations.parts import mean_deviation, tensile
from force_diffusion.derivations.parts.tensile import HEIGHT
from force_diffusion.derivations.witnesses import squared_weights as witnesses
from force_diffusion.symbolic.algebra.affine import Region
from force_diffusion.symbolic.algebra.exact import FIELD, NotExactError, RationalFunction
from force_diffusion.symbolic.algebra.signs import sign
from force_diffusion.symbolic.as_printed import equation, power, terms, times
from force_diffusion.symbolic.kernel.decisions import (
    Ruling,
    all_of,
    decide_identity,
    from_test,
    proved,
    refuted,
    undecided,
)
from force_diffusion.symbolic.notation import Symbol
from force_diffusion.symbolic.printing.structure import rebuilt
from force_diffusion.symbolic.printing.text import text
from force_diffusion.symbolic.search.limits import not_proportional
from force_diffusion.symbolic.symbols import (
    Dot,
    M,
    j,
    k,
    n_minus,
    n_plus,
    n_x,
    n_y,
    phi,
    r,
    sigma,
    z,
)
from force_diffusion.symbolic.variances.averages import LayerAverage, layer_average, uniform_order
from force_diffusion.symbolic.variances.orders import UNIT
from force_diffusion.symbolic.variances.variance import grows_evenly, leading, order, variance

DEVIATION = Symbol("relative_deviation", r"\frac{\sigma_f}{\langle f\rangle}", "σ_f/⟨f⟩")
MEAN_SQUARE = Symbol(
    "mean_square", r"\overline{\sigma_f^2/\langle f\rangle^2}", "mean of σ_f²/⟨f⟩²"
)
PRINTED = equation(DEVIATION, times(power(M, sympy.Rational(3, 2)), sigma, 1 / r))
PRINTED_HEIGHT = equation(HEIGHT, power(times(sigma, 1 / r), sympy.Rational(-2, 3)))

LOADS = {"surface": eq13, "bulk": eq14}

LEADING = {"surface": sympy.Integer(1), "bulk": sympy.Rational(1, 5)}
"""Mean of σ_f²/⟨f⟩² over the layers, in units of M³ (σ/r)²/(1−φ²)²."""

NEXT = {"surface": -sympy.Rational(1, 2), "bulk": sympy.Rational(11, 40)}
"""Its next order, in units of M² (σ/r)²/(1−φ²)²."""

HEIGHT_SHIFT = {"surface": sympy.Rational(1, 6), "bulk": sympy.Rational(-11, 24)}
"""M at which the exact mean is 1, less M*, as M* → ∞."""


@cache
def averages() -> dict[str, LayerAverage]:
    """Exact mean of σ_f²/⟨f⟩² over all layers, for either load."""
    return {load: layer_average(module.exact_forms()) for load, module in LOADS.items()}


def at_finite_size() -> dict[str, ExactCase]:
    """The exact averages, load by load."""
    return {
        f"{load}-load": ExactCase(
            MEAN_SQUARE,
            f"mean over all layers 0 ≤ j < M under a {load} load, M ≥ 3",
            average.expression,
            missed=tuple(
                Missed(f"M = {height}", (sympy.Eq(M, height),), value)
                for height, value in average.exceptions
            ),
        )
        for load, average in averages().items()
    }


def critical_height(load: str) -> sympy.Expr:
    """M*: where the leading order of the mean of σ_f²/⟨f⟩² is 1."""
    scale = times(terms(1, -(phi**2)), r, 1 / sigma)
    number = LEADING[load] ** sympy.Rational(-1, 3)
    root = power(scale, sympy.Rational(2, 3))
    return root if number == 1 else times(number, root)


def _average(load: str) -> Decide:
    """The exact mean over the layers: its rational part, and the harmonic sum where it has one."""
    average, sum_of_inverses = averages()[load], sympy.Symbol("H")
    known = average.rational.to_sympy() + average.harmonic.to_sympy() * sum_of_inverses

    def decide(_: int, candidate: sympy.Eq) -> Ruling:
        if candidate.lhs != MEAN_SQUARE:
            return undecided(f"the left-hand side is not {text(MEAN_SQUARE)}")
        sums = candidate.rhs.atoms(sympy.Sum)
        if any(one.limits != (sympy.Tuple(k, 2, M - 2),) for one in sums):
            return undecided("only a sum over 2 ≤ k ≤ M − 2 is known")
        named = {one: one.function * k * sum_of_inverses for one in sums}
        return decide_identity(candidate.rhs.xreplace(named), known)

    return decide


def _two_orders(load: str) -> Decide:
    """The exact mean less the right-hand side is of an order below the second highest."""
    average = averages()[load]
    second = average.leading_orders()[1]  # refuses a harmonic part that counts

    def decide(_: int, candidate: sympy.Eq) -> Ruling:
        if candidate.lhs != MEAN_SQUARE:
            return undecided(f"the left-hand side is not {text(MEAN_SQUARE)}")
        rest = order(average.rational - FIELD.from_sympy(candidate.rhs))
        return from_test(rest < order(second), f"what is left is of order M^{rest}")

    return decide


def _height(load: str) -> Decide:
    """At this height the leading order of the mean is one, and it is positive."""

    def decide(_: int, candidate: sympy.Eq) -> Ruling:
        if candidate.lhs != HEIGHT:
            return undecided(f"the left-hand side is not {text(HEIGHT)}")
        height = rebuilt(candidate.rhs)
        return all_of(
            decide_identity(sympy.expand(height**3) * LEADING[load] * UNIT, _ONE),
            from_test(sign(height) == 1, "it is positive"),
        )

    return decide


def steps() -> Iterator[Step]:
    """Average the exact variances; set the average to one; count negative Gaussian forces."""
    for load, average in averages().items():
        yield Step(
            "The same number of contacts starts in every layer 0 ≤ j < M: the mean over all "
            f"contacts is the mean over the layers. Exact under a {load} load, M ≥ 3, those at the "
            "edges included, each sum of powers by a telescoping certificate:",
            equation(MEAN_SQUARE, average.expression),
            _average(load),
            (f"Eq. {LOADS[load].DERIVATION.number}",),
            positive=(M - 1, k),
        )
        for height, value in average.exceptions:
            yield Step(
                f"… and at M = {height}:",
                equation(MEAN_SQUARE, value),
                identity({MEAN_SQUARE: value}),
                (f"Eq. {LOADS[load].DERIVATION.number}",),
            )
    for place, (load, module) in enumerate(LOADS.items()):
        yield Step(
            f"Its two leading orders, {load} load:",
            equation(MEAN_SQUARE, times(terms(LEADING[load] * M**3, NEXT[load] * M**2), UNIT)),
            _two_orders(load),
            (f"step {1 + 3 * place}",),
            relation="∼",
        )
        yield Step(
            "The first of them is the mean of the printed variance:",
            equation(sympy.Integral(module.PRINTED.rhs, (z, 0, 1)), LEADING[load] * M**3 * UNIT),
            _mean_of_printed,
            (f"Eq. {module.DERIVATION.number}",),
        )
    yield Step("So its root goes as printed, for both loads alike.", PRINTED, decide, FROM_ORDERS)
    for place, load in enumerate(LOADS):
        _, c, q = mean_deviation.ROOTS[load]
        root = terms(1, times(c, z))
        yield Step(
            "The mean of σ_f/⟨f⟩ itself goes the same way with another prefactor, in units of "
            f"M^(3/2) (σ/r)/(1−φ²). Under a {load} load, for an antiderivative,",
            equation(
                sympy.Derivative(times(q, power(root, sympy.Rational(3, 2))), z),
                times(terms(1, -z), power(root, sympy.S.Half)),
            ),
            mean_deviation.antiderivative(load),
        )
        yield Step(
            "so that the mean is",
            equation(mean_deviation.integral(load), mean_deviation.MEAN_DEVIATION[load]),
            mean_deviation.mean_root(load),
            (f"Eq. {LOADS[load].DERIVATION.number}", f"step {12 + 2 * place}"),
        )
    yield Step(
        "M* is defined here as the height at which the leading order of the mean of σ_f²/⟨f⟩² is "
        "one. It goes as the paper says.",
        PRINTED_HEIGHT,
        _decide_height,
        FROM_ORDERS,
    )
    for load in LOADS:
        yield Step(
            f"With its prefactor, {load} load:",
            equation(HEIGHT, critical_height(load)),
            _height(load),
            FROM_ORDERS,
        )
    yield Step(
        "The probability of a Gaussian force below a given one, with mean 1 and variance v: its "
        "derivative is the density, and far below it vanishes.",
        tensile.GAUSSIAN,
        tensile.gaussian,
        positive=(sympy.pi,),
    )
    for place, load in enumerate(LOADS):
        yield Step(
            "At f = 0 it is ½ erfc(1/√(2v)), the probability of a tensile contact. The forces are "
            "Gaussian, to first order, for normal radii, and in the limit for all radii of finite "
            "variance: no radius dominates, by Eqs. 13 and 14, which is what Lindeberg's theorem "
            "needs. Averaged over the layers as M → ∞ at fixed M/M*, the expected fraction under a "
            f"{load} load is",
            equation(tensile.TENSILE, tensile.tensile_fraction(load)),
            tensile.is_tensile(LOADS[load].PRINTED.rhs, critical_height(load)),
            (f"Eq. {LOADS[load].DERIVATION.number}", f"step {17 + place}", "step 19"),
        )


FROM_ORDERS = ("step 7", "step 9")


def _mean_of_printed(_: int, candidate: sympy.Eq) -> Ruling:
    """The integral of a polynomial, power by power."""
    average = candidate.lhs
    if not isinstance(average, sympy.Integral) or average.limits != (sympy.Tuple(z, 0, 1),):
        return undecided("the left-hand side is no mean over 0 < z < 1")
    return decide_identity(_mean_over_z(average.function), candidate.rhs)


def _decide_height(_: int, candidate: sympy.Eq) -> Ruling:
    return decide(1, candidate)


def decide(part: int, candidate: sympy.Eq) -> Ruling:
    """The squared candidate over the exact mean of σ_f², at leading order, depends on φ alone."""
    if candidate.lhs != (DEVIATION, HEIGHT)[part]:
        return undecided(f"the left-hand side is not {text((DEVIATION, HEIGHT)[part])}")
    return all_of(*(_decide_for(load, part, candidate.rhs) for load in LOADS))


def _decide_for(load: str, part: int, side: sympy.Expr) -> Ruling:
    first, _ = averages()[load].leading_orders()
    try:
        ratio = _squared_ratio(first, part, rebuilt(side)).reduced()
    except NotExactError as reason:
        return undecided(str(reason))
    grows = order(ratio, M)
    what = f"{load} load: leading order of the mean of σ_f²/⟨f⟩² " + (
        "over the squared right-hand side" if part == 0 else "at M equal to the right-hand side"
    )
    others = (symbol for symbol in FIELD.generators if symbol not in (phi, n_x, n_y))
    limit = leading(ratio, M)
    names = [text(symbol) for symbol in others if limit.holds(symbol)]
    if grows or names:
        on = ", ".join(names) or text(M)
        return refuted(f"{what} is {text(ratio.to_sympy())}, which depends on {on}")
    side_of_zero = sign(_dominant(rebuilt(side)))
    if side_of_zero < 0:
        return refuted(f"{text(side)} is negative, which neither a deviation nor a height is")
    if not (side_of_zero and sign(limit.to_sympy()) and grows_evenly(ratio, M)):
        return undecided(f"{text(side)} is not shown to be finite and positive for every φ")
    return proved(f"{what} is {text(limit.to_sympy())}")


def search(candidate: sympy.Eq) -> str | None:
    """Values at which the candidate is no positive number, or not in proportion to the exact one.

    What differs between the loads is a number; the surface load is enough.
    """
    side = candidate.rhs
    if candidate.lhs == DEVIATION:
        mean = averages()["surface"].rational.to_sympy()
        return not_proportional(side, side**2 / mean)
    return not_proportional(side, side**3 * UNIT) if candidate.lhs == HEIGHT else None


def _squared_ratio(first: RationalFunction, part: int, side: sympy.Expr) -> RationalFunction:
    if part == 0:
        return first / FIELD.from_sympy(side**2)
    # the leading order is M³ times what holds no M
    return first / FIELD.generator(M) ** 3 * FIELD.from_sympy(side**3)


def _dominant(side: sympy.Expr) -> sympy.Expr:
    """What a product of sums and powers goes as when M grows: every sum by its leading order."""
    if isinstance(side, sympy.Mul):
        return sympy.Mul(*map(_dominant, side.args))
    if isinstance(side, sympy.Pow):
        return _dominant(side.base) ** side.exp
    return leading(FIELD.from_sympy(side).reduced(), M).to_sympy()


def _mean_over_z(profile: sympy.Expr) -> sympy.Expr:
    """∫ from 0 to 1 of a polynomial in z: zⁿ gives 1/(n + 1)."""
    total = FIELD.zero
    for degree, coefficient in enumerate(FIELD.from_sympy(profile).coefficients(z)):
        total = total + coefficient / FIELD.constant(degree + 1)
    return total.to_sympy()


def _height_next_order() -> Ruling:
    """At M = M* + shift the exact mean is M*³ · unit up to a rest below order M*²."""
    rests = []
    for load, average in averages().items():
        moved = FIELD.generator(M) + FIELD.constant(HEIGHT_SHIFT[load])
        aim = FIELD.from_sympy(LEADING[load] * M**3 * UNIT)
        rests.append(order(average.rational.substitute({M: moved}) - aim))
        average.leading_orders()  # refuses a harmonic part that counts
    return from_test(
        max(rests) <= 1,
        "the exact mean is 1 at M = M* + 1/6 under a surface load, at M = M* − 11/24 under a bulk "
        "load, up to a term that vanishes as M* → ∞",
        f"rests of orders {rests}",
    )


def _mean_of_deviation() -> Ruling:
    """A uniform bound on the variances lets their roots be averaged at leading order."""
    rulings = []
    for load, module in LOADS.items():
        a, c, _ = mean_deviation.ROOTS[load]
        in_units = times(a, terms(1, -z) ** 2, terms(1, times(c, z)))
        rulings += [
            from_test(
                uniform_order(module.exact_forms(), module.PRINTED.rhs) <= 2,
                "exact and printed variance differ by at most C M² in every layer, so that their "
                "roots differ by at most √C M, which is below M^(3/2)",
            ),
            decide_identity(module.PRINTED.rhs, in_units * M**3 * UNIT),
        ]
    return all_of(*rulings)


def _function_of_the_ratio() -> Ruling:
    """σ_f²/⟨f⟩² at leading order is (M/M*)³ times a profile of mean one."""
    rulings = []
    for load, module in LOADS.items():
        cubed = M**3 * LEADING[load] * UNIT  # (M/M*)³, for M*³ · LEADING · UNIT = 1
        rulings += [
            decide_identity(module.PRINTED.rhs, cubed * tensile.PROFILES[load]),
            decide_identity(rebuilt(critical_height(load)) ** 3 * LEADING[load] * UNIT, _ONE),
            decide_identity(_mean_over_z(tensile.PROFILES[load]), _ONE),
            decide_identity(rebuilt(tensile.SPREAD[load]) ** 2, 2 * tensile.PROFILES[load]),
        ]
    return all_of(*rulings)


_ONE = sympy.Integer(1)


def _displacements() -> Ruling:
    """The geometry diffuses as j: (4j − 2)σ² along either direction, exactly."""
    region, stated = Region({j: 2}), FIELD.from_sympy((4 * j - 2) * sigma**2)
    found = [variance(Dot(unit, eq03.PRINTED.rhs), region) for unit in (n_plus, n_minus)]
    height = (r / sigma) ** 2 / 4
    ratio = rebuilt(PRINTED_HEIGHT.rhs) / height
    return all_of(
        from_test(
            all((exact - stated).is_zero() for exact in found),
            "the variance of n^±·δx is (4j − 2)σ² for j ≥ 2; to leading order that is r² at "
            "j = ¼(σ/r)^(−2)",
        ),
        decide_identity(leading(stated).to_sympy().xreplace({j: height}), r**2),
        decide_identity(ratio**3, (4 * (sigma / r) ** sympy.Rational(4, 3)) ** 3),
    )


DERIVATION = Derivation(
    number=15,
    name="general_form",
    title="Average over the system, and the height of tensile contacts",
    symbols=(
        (DEVIATION, "relative standard deviation of the forces: root of the mean of its square"),
        (HEIGHT, "height at which the leading order of the mean of σ_f²/⟨f⟩² is one"),
        (MEAN_SQUARE, "mean over all contacts"),
        (tensile.TENSILE, "expected fraction of contacts with f < 0"),
        *usual(sigma, r, M, z, phi),
    ),
    assumptions=(
        "the radii are independent, of zero mean and variance σ²",
        "first order in δr",
        "printed form: M → ∞; exact averages: every M",
        "the fraction of tensile contacts: Gaussian forces, M → ∞ at fixed M/M*",
    ),
    premises=(eq03.DERIVATION, eq13.DERIVATION, eq14.DERIVATION),
    printed=(PRINTED, PRINTED_HEIGHT),
    loads=("surface", "bulk"),
    relation="∝",
    exact=at_finite_size,
    steps=steps,
    decide=decide,
    search=search,
    claims=(
        Claim("as M* → ∞ the exact mean is 1 at M* + 1/6 and at M* − 11/24", _height_next_order),
        Claim(
            "the mean of σ_f/⟨f⟩ itself is that of the root of the printed variance, to leading "
            "order in M",
            _mean_of_deviation,
        ),
        Claim(
            "at leading order σ_f²/⟨f⟩² is (M/M*)³ times a profile of mean one",
            _function_of_the_ratio,
        ),
        Claim(
            "displacements are of order M^(1/2) σ, so of order r at a height (σ/r)^(−2), far "
            "above M*",
            _displacements,
        ),
        Claim(
            "the expected fraction of tensile contacts depends on M/M* alone, and lies between 0 "
            "and ½ for every M/M*: it is finite at heights of the order of M*",
            tensile.fraction_of_the_ratio,
        ),
        Claim(
            "at leading order σ_f²/⟨f⟩² is nowhere above 2 (M/M*)³ under a surface load, nor above "
            "(125/72) (M/M*)³ under a bulk load; at M = M*/(8c ln M)^(1/3) every 1/2σ_f² is at "
            "least 2c ln M",
            tensile.peaks,
        ),
    ),
    witnesses=(
        Witness(
            "exact averages equal means of squared weights of exact packings, all M ≤ 4",
            lambda packing: witnesses.averages(
                {load: average.value_at for load, average in averages().items()}, packing
            ),
        ),
    ),
    remarks=(
        "The paper writes M* = O[(σ/r)^(−2/3)] in the text; it is checked here as ∝, with the "
        "definition given, and the prefactor is found: (1−φ²)^(2/3) for a surface load, 5^(1/3) "
        "times that for a bulk load.",
        "M* is a definition: the paper says of it that a finite fraction of the forces is negative "
        "there, which the fraction below bears out.",
        "The fraction of tensile contacts is an estimate: the forces are Gaussian exactly for "
        "normal radii and else in the limit, to first order in δr. That they are in the limit is "
        "Lindeberg's theorem; its condition is decided, the theorem is quoted.",
        "To let the expected number of tensile contacts vanish, rather than their fraction, the "
        "paper expects a much lower M*. With Gaussian forces M* divided by the cube root of "
        "8c ln M, c > 1, is enough for a square packing, to leading order: a logarithm, not "
        "another power of σ/r. The bound on the variance is decided; Chernoff's inequality, "
        "P(f < 0) ≤ exp(−1/2σ_f²) = M^(−2c) for each of the M² contacts, is quoted.",
    ),
)

if __name__ == "__main__":
    from force_diffusion.derivations.commands.alone import run_alone

    raise SystemExit(run_alone(DERIVATION))
