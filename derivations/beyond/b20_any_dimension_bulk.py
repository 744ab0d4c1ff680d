"""Eq. B20: variance of the contact forces in any dimension under a bulk load, to leading order."""

from collections.abc import Iterator

import sympy
from force_diffusion.derivations import eq11_total_force as eq11
from force_diffusion.derivations import eq14_bulk_diffusion as eq14
from force_diffusion.derivations.beyond import b11_any_dimension as b11
from force_diffusion.derivations.beyond import b14_spheres_bulk as b14
from force_diffusion.derivations.beyond.b11_any_dimension import LINES, OWN, SHARED
from force_diffusion.derivations.framework.follows import identity
from force_diffusion.derivations.framework.record import Claim, Derivation, Step, Witness
from force_diffusion.symbolic.as_printed import equation, power, terms, times
from force_diffusion.symbolic.kernel.decisions import Ruling, all_of, decide_identity, from_test
from force_diffusion.symbolic.symbols import M, d, j, kappa, l, r, sigma, z

VARIANCE = eq14.PRINTED.lhs
PRINTED = equation(
    VARIANCE,
    times(
        sympy.Rational(1, 10) * kappa**2 * M**3,
        terms(d, -1),
        terms(times(2, d), -1),
        terms(1, -z) ** 2,
        terms(times(4, z), 1),
        power(times(sigma, 1 / r), 2),
    ),
)


def lines() -> sympy.Expr:
    """X of Eq. B11, averaged over the surface loads of all layers above the contact."""
    return sympy.Sum(LINES.xreplace({M: l}), (l, j + 1, M)) / (M - j)


decide = b11.to_leading_order(VARIANCE, lines)


def steps() -> Iterator[Step]:
    """The line sums along the contact, weighed by what the path carries; the rest; squares."""
    own, shared = (of(lines()).to_sympy() for of in (b11.one_direction, b11.two_directions))
    yield Step(
        "The load on a layer acts as the surface load of a packing of its height, as for Eq. 14. "
        "So X of Eq. B11 becomes its average over the heights j + 1, …, M. In the plane of the "
        "contact and one other direction it has the variance",
        equation(OWN, own),
        identity({OWN: own}),
        ("Eq. 11", "Eq. 14", "Eq. B11"),
    )
    yield Step(
        "and with another direction it shares the contact's own line:",
        equation(SHARED, shared),
        identity({SHARED: shared}),
        ("Eq. 11", "Eq. 14", "Eq. B11"),
    )
    yield Step(
        "The tilts of the path telescope here too, as the load that a contact carries is what "
        "enters it, and line sums along third directions have weights that are at most those of a "
        "surface load: both are of order M², by Eq. B11. To leading order:",
        PRINTED,
        decide,
        ("Eq. B11", "step 1", "step 2"),
    )


def _known() -> Ruling:
    """For d = 2 it is Eq. 14, for d = 3 Eq. B14."""
    two, three = ({d: sympy.Integer(n)} for n in (2, 3))
    whole = PRINTED.rhs.doit()
    return all_of(
        decide_identity(whole.xreplace({kappa: b11.KAPPA}).xreplace(two), eq14.PRINTED.rhs.doit()),
        decide_identity(whole.xreplace(three), b14.PRINTED.rhs.doit()),
    )


def _same_factor() -> Ruling:
    """Over Eq. 14 it is what Eq. B11 is over Eq. 13, in every dimension; its mean over z."""
    profiles = (1 - z) ** 2 * (1 + 4 * z), (1 - z) ** 2 * (1 + 2 * z)
    mean = sympy.integrate(sympy.expand(profiles[0]), (z, 0, 1))
    ratio = PRINTED.rhs.doit() / b11.PRINTED.rhs.doit()
    return all_of(
        decide_identity(ratio, sympy.Rational(3, 20) * profiles[0] / profiles[1]),
        from_test(
            mean == sympy.Rational(2, 3),
            "the mean of the printed form over z is (d−1)(2d−1) κ² M³ (σ/r)²/15",
        ),
    )


DERIVATION = Derivation(
    number="B20",
    name="any_dimension_bulk",
    title="Variance of the forces in any dimension under a bulk load, to leading order",
    symbols=b11.DERIVATION.symbols,
    assumptions=(
        "the radii are independent, of zero mean and variance σ²",
        "first order in δr",
        "every bead above the base carries the same load, along the sum of the base vectors",
        "M → ∞ at fixed z",
        "the base is flat and does not move",
    ),
    premises=(eq11.DERIVATION, eq14.DERIVATION, b11.DERIVATION, b14.DERIVATION),
    printed=(PRINTED,),
    relation="∼",
    steps=steps,
    decide=decide,
    search=b11.parting(VARIANCE, lines),
    claims=(
        Claim("for d = 2 it is Eq. 14, for d = 3 Eq. B14", _known),
        Claim(
            "it is to Eq. B11 as Eq. 14 is to Eq. 13; M* is [15 r²/((d−1)(2d−1)κ²σ²)]^(1/3)",
            _same_factor,
        ),
    ),
    witnesses=(
        Witness(
            "the variance along the lines, exact at finite M, in two, three and four dimensions",
            lambda packing: b11.witness_of_lines(packing, lines(), bulk=True),
        ),
    ),
)

if __name__ == "__main__":
    from force_diffusion.derivations.commands.alone import run_alone

    raise SystemExit(run_alone(DERIVATION))
