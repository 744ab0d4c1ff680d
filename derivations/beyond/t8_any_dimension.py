"""T8: variance of the contact forces in any dimension; Eqs. B11, B13, B14, B20, B24, B25.

The kernel has it exactly, at finite size, for every d and for loads that lean: leading orders for
any d (B11, B20), and closed forms for d = 3 (B13, B14; leaning, B24, B25).
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache, partial

import sympy
from force_diffusion.derivations import eq11_total_force as eq11
from force_diffusion.derivations import eq13_surface_diffusion as eq13
from force_diffusion.derivations import eq14_bulk_diffusion as eq14
from force_diffusion.derivations.beyond import t2_variance as t2
from force_diffusion.derivations.framework.averaging import integral
from force_diffusion.derivations.framework.catalogue import Number
from force_diffusion.derivations.framework.record import FIRST_ORDER, usual
from force_diffusion.derivations.framework.vocabulary import (
    Derivation,
    Layered,
    Lines,
    Where,
    asymptotic,
    equation,
    formula,
    minus,
    moment,
    rewrite,
    terms,
    times,
)
from force_diffusion.symbolic.kernel.any_dimension import (
    BULK,
    BULK_LEANING,
    SURFACE,
    SURFACE_LEANING,
)
from force_diffusion.symbolic.kernel.where import Loading
from force_diffusion.symbolic.notation import Symbol
from force_diffusion.symbolic.symbols import (
    ForceOfLayer,
    M,
    Variance,
    d,
    j,
    kappa,
    m,
    phi,
    r,
    sigma,
    t,
    tau_1,
    tau_2,
    z,
)
from force_diffusion.symbolic.variances.variance import ClosedForm
from sympy import Rational

CROSS = Symbol("kappa_cross", r"\kappa'", "κ′", real=True)
BELOW = formula("(1 − φ)[1 + (d − 1)φ]")
KAPPA: sympy.Expr = formula("1 + (d − 2)φ") / BELOW
"""b^a·b^a of the reciprocal vectors of d base vectors with the mutual dot product φ."""
CROSSED: sympy.Expr = -phi / BELOW
"""b^a·b^c of two of them."""
IN_THREE = (sigma / r) ** 2 / ((1 - phi) ** 2 * (1 + 2 * phi) ** 2)

SURFACE_PROFILE, BULK_PROFILE = formula("M³(1 − z)²(2z + 1)"), formula("M³(1 − z)²(4z + 1)")


def _at(dimension: int, expression: sympy.Expr) -> sympy.Expr:
    return expression.doit().xreplace({d: sympy.Integer(dimension)})


@dataclass(frozen=True, eq=False)
class Case:
    """What is printed of the variance, for one load and one dimension, or any.

    Attributes:
        scale: number and powers of d in front of κ² and the profile.
        next_order: the M² term at fixed z, without (σ/r)²/[(1−φ)²(1+2φ)²]; for d = 3, upright.
    """

    number: Number
    symbol: sympy.Symbol
    loading: Loading
    dimension: int | sympy.Symbol
    scale: tuple[sympy.Expr, ...]
    profile: sympy.Expr
    next_order: sympy.Expr = sympy.S.Zero

    @property
    def leaning(self) -> bool:
        """Whether loads lean."""
        return self.loading in (SURFACE_LEANING, BULK_LEANING)

    @property
    def bulk(self) -> bool:
        """Whether every bead is loaded."""
        return self.loading in (BULK, BULK_LEANING)

    @property
    def printed(self) -> sympy.Eq:
        """σ_f²/⟨f⟩² to leading order."""
        number, *factors = self.scale
        first, *rest = self.profile.args
        leading = (number * kappa**2 * first, *factors, *rest)
        return equation(self.symbol, times(*leading, formula("(σ_δr/r)²")))

    @property
    def forms(self) -> dict[str, ClosedForm]:
        """The closed form of every layer."""
        return self.variance.forms

    @property
    def variance(self) -> Layered:
        """The variance of a contact's force over its mean, at every layer."""
        if self not in _VARIANCES:
            own = KAPPA if self.dimension == d else _at(int(self.dimension), KAPPA)
            of = Variance(ForceOfLayer(j))
            _VARIANCES[self] = Layered(
                self.symbol,
                of,
                (),
                self.loading,
                {kappa: own},
                dimension=self.dimension,
                ordered_by=(tau_1, tau_2) if self.leaning else (),
            )
        return _VARIANCES[self]


_VARIANCES: dict[Case, Layered] = {}
OF_SURFACE, OF_BULK = eq13.PRINTED.lhs, eq14.PRINTED.lhs
_ANY = (terms(d, -1), terms(times(2, d), -1))
B11 = Case("B11", OF_SURFACE, SURFACE, d, (Rational(2, 3), *_ANY), SURFACE_PROFILE)
B20 = Case("B20", OF_BULK, BULK, d, (Rational(1, 10), *_ANY), BULK_PROFILE)
B13 = Case("B13", OF_SURFACE, SURFACE, 3, (Rational(20, 3),), SURFACE_PROFILE,
           formula("−M²(1 − z)[5 + 16φ + 5φ² + 3z(5 + 8φ + φ²)]"))  # fmt: skip
B14 = Case("B14", OF_BULK, BULK, 3, (sympy.S.One,), BULK_PROFILE,
           formula("M²(1 − z)[5 + 4φ + 3φ² − z(5 + 4φ − 13φ²)]/4"))  # fmt: skip

OF_LEANING = Symbol(
    "leaning_variance",
    r"\frac{\sigma^2(f^{1})}{\langle f^{1}\rangle^2}",
    "σ²(f¹)/⟨f¹⟩²",
)
_SHARES = terms(times(2, tau_1**2), tau_2)
B24 = Case("B24", OF_LEANING, SURFACE_LEANING, 3, (Rational(2, 3), _SHARES), SURFACE_PROFILE)
B25 = Case("B25", OF_LEANING, BULK_LEANING, 3, (Rational(1, 10), _SHARES), BULK_PROFILE)
ONE_BELOW = formula("M[τ₁²(1 + φ)² + τ₂(1 + 2φ + 3φ²) + 2φ²(τ₁ + 2)]")
"""What the variance one layer below the surface goes as, without (σ/r)²/[(1−φ)²(1+2φ)²]."""
VERTICAL = {tau_1: sympy.Integer(2), tau_2: sympy.Integer(2)}
"""The load along the sum of three base vectors."""


def exact_forms(case: Case) -> dict[str, ClosedForm]:
    """Exact σ_f²/⟨f⟩² at every layer."""
    return case.variance.forms


# what the lines say


def _any_dimension(case: Case) -> Lines:
    """Reciprocal vectors; the lines along the contact; the leading order of the exact variance."""
    variance, k = case.variance, M - j
    geometry = Where((M,), dimension=d)
    lines = Lines(variance.in_the_limit)
    products = lines.show(
        "Let a bead rest on d others, along base vectors n^a of equal mutual dot product φ. The "
        "reciprocal vectors have the products κ, with themselves, and κ′, with each other:",
        sympy.Tuple(
            equation(times(kappa, BELOW), formula("1 + (d − 2)φ")),
            equation(times(CROSS, BELOW), -phi),
        ),
        rewrite(),
        where=geometry,
        meaning={kappa: KAPPA, CROSS: CROSSED},
    )
    carried = (
        "The load on a layer acts as the surface load of a packing of its height: averaged over "
        "the layers above the contact, a bead m steps up the path"
        if case.bulk
        else "Each contact fixes n^a·δx again, a line sum along n^a, and to first order the force "
        "above a bead is what enters it and b^a·Σ_c(δn^c − δn^c below). With b = a, each of the "
        "d − 1 other directions c puts line sums along the contact on its own line, with −2κ, and "
        "on two next to it, with κ. A bead m steps up the path"
    )
    squares = 2 * (d - 1) * (2 * d - 1) * kappa**2
    met = (k - m) * (k - m + 1) / (2 * k) if case.bulk else k - m
    counted = lines.show(
        f"{carried} is met by the lines that begin above it, one below the contact by all:",
        equation(
            sympy.Add(
                *(
                    (times(2, kappa, terms(d, -1)) ** 2 + times(2, terms(d, -1), kappa**2)) * part
                    for part in (met.xreplace({m: sympy.S.Zero}) ** 2 * j,
                                 sympy.Sum(met**2, (m, 1, k - 1)))
                ),
                evaluate=False,
            ),
            squares * (_BULK_SUM if case.bulk else _SURFACE_SUM),
        ),
        rewrite(),
        where=Where.of(j >= 1, j + 2 <= M),
        after=(products,),
    )  # fmt: skip
    lines.show(
        "What is left are tilts of the contact itself, and sums over its path of line sums along a "
        "third direction, each an area of weights of order 1. The variance with all of them, "
        "exact for every d, is to leading order:",
        case.printed,
        asymptotic(),
        meaning=variance.meant,
        after=(counted, eq11.DERIVATION),
    )
    _claim_any(case, lines, geometry)
    return lines


_K = M - j
_SURFACE_SUM = j * _K**2 + (_K - 1) * _K * (2 * _K - 1) / 6
_BULK_SUM = j * (_K + 1) ** 2 / 4 + (_K**2 - 1) * (3 * _K**2 - 2) / (60 * _K)


def _claim_any(case: Case, lines: Lines, geometry: Where) -> None:
    own, crossed = times(terms(d, -1), phi, CROSSED), times(terms(d, -2), phi, CROSSED)
    two = {"where": Where((M,)), "meaning": {kappa: _at(2, KAPPA)}}
    plane = eq14 if case.bulk else eq13
    if case is B11:
        lines.claim(
            "the products of the reciprocal vectors: with those of the base vectors they give 1",
            sympy.Tuple(
                equation(terms(KAPPA, own), sympy.S.One),
                equation(terms(times(phi, KAPPA), CROSSED, crossed), sympy.S.Zero),
            ),
            rewrite(),
            where=geometry,
        )
        lines.claim(
            "no overlap: (1 − 2φ) > 0 for neighbours in a layer, (d−1)(1 + dφ) > 0 for the bead "
            "straight above",
            sympy.Tuple(
                equation(formula("2(1 − φ) − 1"), formula("1 − 2φ")),
                equation(formula("d + d(d − 1)φ − 1"), formula("(d − 1)(1 + dφ)")),
            ),
            rewrite(),
            where=geometry,
        )
    lines.claim(
        f"for d = 2 it is Eq. {plane.DERIVATION.number}",
        equation(_at(2, case.printed.rhs), plane.PRINTED.rhs),
        rewrite(),
        **two,
    )
    if case is B20:
        lines.claim(
            "for d = 3 it is Eq. B14",
            equation(_at(3, case.printed.rhs), B14.printed.rhs),
            rewrite(),
            where=geometry,
        )
        lines.claim(
            "it is to Eq. B11 as Eq. 14 is to Eq. 13",
            equation(
                case.printed.rhs.doit() * eq13.PRINTED.rhs.doit(),
                B11.printed.rhs.doit() * eq14.PRINTED.rhs.doit(),
            ),
            rewrite(),
            where=geometry,
        )
    mean, height = (Rational(2, 3), "15") if case.bulk else (Rational(1, 2), "3")
    lines.claim(
        f"the mean of the profile over z is {mean}: M* is [{height} r²/((d−1)(2d−1)κ²σ²)]^(1/3), "
        "and the exponent −2/3 stays",
        equation(sympy.Integral(times(*case.profile.args[1:]), (z, 0, 1)), mean),
        integral(),
        where=geometry,
    )
    lines.claim(
        "one layer below the surface both loads have one form, for every d",
        equation(case.symbol, _below_surface()),
        moment(),
        where=case.variance.where("surface"),
        meaning=case.variance.meant,
    )


@cache
def _below_surface() -> sympy.Expr:
    return exact_forms(B11)["surface"].expression


def _three_dimensions(case: Case) -> Lines:
    """Every layer's exact form, the leading order and the next one."""
    variance = case.variance
    lines = Lines(variance.in_the_limit)
    inside = variance.show_forms(
        lines,
        "every radius of the contact's lines, of those beside its path and of those along the "
        "other two vectors is met once, slice by slice, and each sum has its certificate",
    )
    leading = variance.show_leading(
        lines, "To leading order in M at fixed z:", case.printed, inside
    )
    if not case.leaning:
        variance.show_leading(
            lines,
            "The next order, to which the line sums along third directions contribute:",
            equation(terms(case.symbol, minus(case.printed.rhs)), times(IN_THREE, case.next_order)),
            leading,
        )
    variance.claim_edges(
        lines,
        "leading orders of the exact forms: at j = 0 the printed form at z = 0, at j = M − 1 "
        "(τ₁²(1 + φ)² + τ₂(1 + 2φ + 3φ²) + 2φ²(τ₁ + 2)) M in units of (σ/r)²/[(1−φ)²(1+2φ)²], "
        "6(1 + 2φ + 3φ²) M for τ₁ = τ₂ = 2, a load along the sum of the base vectors",
        base=case.printed.rhs.xreplace({z: sympy.S.Zero}),
        surface=(ONE_BELOW if case.leaning else ONE_BELOW.xreplace(VERTICAL)) * IN_THREE,
    )
    if case.leaning:
        _claim_leaning(case, lines)
        return lines
    any_d = B20 if case.bulk else B11
    lines.claim(
        f"the leading order is Eq. {any_d.number} for d = 3",
        equation(_at(3, any_d.printed.rhs), case.printed.rhs),
        rewrite(),
        where=Where((M,), dimension=3),
    )
    if case is B14:
        lines.claim(
            "it is to Eq. 14 as Eq. B13 is to Eq. 13: the factor is one",
            equation(
                case.printed.rhs.doit() * eq13.PRINTED.rhs.doit(),
                B13.printed.rhs.doit() * eq14.PRINTED.rhs.doit(),
            ),
            rewrite(),
            where=Where((M,), dimension=3),
        )
        lines.claim(
            "at j = M − 1 it is that of a surface load",
            equation(case.symbol, exact_forms(B13)["surface"].expression),
            moment(),
            where=variance.where("surface"),
            meaning=variance.meant,
        )
    return lines


def _claim_leaning(case: Case, lines: Lines) -> None:
    variance, upright = case.variance, B14 if case.bulk else B13
    layers = tuple(map(variance.where, variance.forms))
    lines.claim_each(
        f"for τ₁ = τ₂ = 2 each closed form is that of Eq. {upright.number}",
        (
            (form.expression.xreplace(VERTICAL), exact_forms(upright)[name].expression, where)
            for (name, form), where in zip(variance.forms.items(), layers, strict=True)
        ),
        rewrite(),
    )
    lines.claim_each(
        "as the other vectors are unloaded, τ₁, τ₂ → 0, the tilt of the contact itself is left, "
        "which does not know the height: φ²(4j + 1 + 2φ²) in units of (σ/r)²/[(1−φ)²(1+2φ)²]",
        (
            (
                variance.forms["interior"].expression.xreplace({tau_1: 0 * d, tau_2: 0 * d}),
                times(formula("φ²(4j + 1 + 2φ²)"), IN_THREE),
                layers[0],
            ),
        ),
        rewrite(),
    )
    anywhere = replace(variance.in_the_limit, dimension=d)
    lines.claim(
        "for any d it goes the same way, with the κ of that d",
        equation(case.symbol, case.printed.rhs.xreplace({kappa: KAPPA})),
        asymptotic(),
        where=anywhere,
        meaning=variance.meant,
    )
    plane = t2.DERIVATIONS["B3" if case.bulk else "B2"]
    lines.claim(
        f"for d = 2, τ₁ = t and τ₂ = t², it is Eq. {plane.number}",
        equation(
            _at(2, case.printed.rhs.xreplace({kappa: KAPPA, tau_1: t, tau_2: t**2})),
            plane.printed[0].rhs,
        ),
        rewrite(),
        where=Where((M,)),
    )


# what is derived

_FLAT = "the base is flat and does not move"
_IN_ANY = (
    (d, "dimensions; every bead rests on d others, along base vectors with one dot product φ"),
    (kappa, "b^a·b^a = [1 + (d−2)φ]/{(1−φ)[1 + (d−1)φ]}; 1/(1−φ²) for d = 2"),
    *usual(sigma, r, M, z),
    (phi, "mutual dot product of the base vectors, −1/d < φ < ½"),
)
_OF_LEANING = (
    (OF_LEANING, "variance of the force along base vector 1, over its mean squared"),
    (tau_1, "L^2/L^1 + L^3/L^1 for loads −Σ_a L^a n^a; in any dimension the sum over a ≠ 1"),
    (tau_2, "the sum of their squares"),
)
_OF_SPHERES = (
    (kappa, "b^a·b^a = (1+φ)/(1+φ−2φ²)"),
    *usual(sigma, r, M, z),
    (phi, "mutual dot product of the three base vectors, −1/3 < φ < ½"),
)


def _derivation(
    case: Case,
    name: str,
    title: str,
    load: str,
    premises: tuple[Derivation, ...],
    remarks: tuple[str, ...] = (),
) -> Derivation:
    any_d = case.dimension == d
    steps: Callable[[], Lines] = cache(
        partial(_any_dimension if any_d else _three_dimensions, case)
    )
    own = "every bead rests on three others, along base vectors with one mutual dot product φ"
    limit = "M → ∞ at fixed z"
    assumptions = (
        (*FIRST_ORDER, load, limit, _FLAT)
        if any_d
        else (own, *FIRST_ORDER, _FLAT, load,
              f"printed form: {limit}; exact form: every 0 ≤ j < M")
    )  # fmt: skip
    return Derivation(
        number=case.number,
        name=name,
        title=title,
        symbols=_IN_ANY if any_d else (*(_OF_LEANING if case.leaning else ()), *_OF_SPHERES),
        dimension=2 if any_d else 3,
        assumptions=assumptions,
        premises=premises,
        printed=(case.printed,),
        relation="∼",
        exact=None if any_d else case.variance.exact,
        steps=steps,
        where=case.variance.in_the_limit,
        remarks=remarks,
    )


_ALONG = "along the sum of the base vectors"
ANY_SURFACE = _derivation(
    B11,
    "any_dimension",
    "Variance of the forces in any dimension, to leading order",
    f"a surface load {_ALONG}",
    (eq11.DERIVATION, eq13.DERIVATION),
    (
        "What is special to discs is that nothing is left but lines: for d ≥ 3 the force also "
        "holds line sums along every third direction, summed over the contact's path. They cover "
        "an area with weights of order 1, and drop out of the leading order alone.",
        "Eqs. B13 and B14 are the exact forms at finite M for d = 3; Eq. B20 is for a bulk load.",
    ),
)
SPHERES_SURFACE = _derivation(
    B13,
    "spheres_surface",
    "Variance of the forces in three dimensions under a surface load",
    f"a surface load {_ALONG}",
    (ANY_SURFACE,),
    (
        "At finite M line sums along all three vectors count: at z = 0 the next order is a share "
        "of −3(5 + 16φ + 5φ²)/[20(1+φ)² M], against −3/(4M) for discs.",
    ),
)
SPHERES_BULK = _derivation(
    B14,
    "spheres_bulk",
    "Variance of the forces in three dimensions under a bulk load",
    f"a bulk load {_ALONG}",
    (eq13.DERIVATION, eq14.DERIVATION, ANY_SURFACE, SPHERES_SURFACE),
)
ANY_BULK = _derivation(
    B20,
    "any_dimension_bulk",
    "Variance of the contact forces in any dimension under a bulk load, to leading order",
    f"every bead above the base carries the same load, {_ALONG}",
    (eq11.DERIVATION, eq14.DERIVATION, ANY_SURFACE, SPHERES_BULK),
)

_LEANS = "−Σ_a L^a n^a, all L^a > 0"
LEANING_SURFACE = _derivation(
    B24,
    "leaning_surface",
    "Variance of the forces in three dimensions under a surface load in any direction",
    f"a surface load {_LEANS}",
    (t2.DERIVATIONS["B2"], ANY_SURFACE, SPHERES_SURFACE),
    (
        "A force is fed by the loads along the other vectors: it fluctuates the more, in units of "
        "its own mean, the less of the load points along its own. M* of contacts along 1 is "
        "[3r²/((2τ₁² + τ₂)κ²σ²)]^(1/3).",
        "The leading order holds in any dimension, with the κ, τ₁ and τ₂ of that.",
    ),
)
LEANING_BULK = _derivation(
    B25,
    "leaning_bulk",
    "Variance of the forces in three dimensions under a bulk load in any direction",
    f"every bead above the base carries the same load {_LEANS}",
    (t2.DERIVATIONS["B3"], ANY_BULK, SPHERES_BULK, LEANING_SURFACE),
)

DERIVATIONS = {
    one.number: one
    for one in (
        ANY_SURFACE,
        SPHERES_SURFACE,
        SPHERES_BULK,
        ANY_BULK,
        LEANING_SURFACE,
        LEANING_BULK,
    )
}

if __name__ == "__main__":
    from force_diffusion.derivations.commands.alone import run_alone

    raise SystemExit(run_alone(DERIVATIONS))
