"""Exact positions and forces at 80 digits: what is left beside first order falls as ε²."""

from collections.abc import Callable, Iterator
from fractions import Fraction
from typing import TYPE_CHECKING, Any, TypeAlias

import mpmath
import sympy
from force_diffusion.symbolic import symbols as sy
from force_diffusion.symbolic.kernel.decisions import Ruling, Verdict

from .both_sides import Dual, ExactSolution, Vector, evaluate
from .draws import SmallPacking

if TYPE_CHECKING:
    from force_diffusion.numeric.mechanics.small_packing import (
        Solution,  # brings NumPy, which no proof needs
    )

    Reading: TypeAlias = Callable[[Solution], list[Any]]

DIGITS = 80
STRENGTHS = ("1e-14", "1e-17", "1e-20")


def _orders(
    solutions: "list[Solution]", slopes: list[Fraction], read: "Reading", strength: str
) -> Iterator[Any]:
    """Measured order log₂ R(ε)/R(ε/2), for each quantity whose remainder R is not zero."""
    epsilon = mpmath.mpf(strength)
    for slope, full, halved in zip(slopes, read(solutions[0]), read(solutions[1]), strict=True):
        linear = mpmath.mpf(slope.numerator) / slope.denominator
        whole = abs(mpmath.mpf(full) - epsilon * linear)
        part = abs(mpmath.mpf(halved) - epsilon / 2 * linear)
        # rounding is about 1e-75; a remainder below 1e-10 ε² is taken for an exact zero
        if whole > epsilon**2 * mpmath.mpf(10) ** -10:
            yield mpmath.log(whole / part, 2)


def second_order(packing: SmallPacking, slopes: list[Fraction], read: "Reading") -> Ruling:
    """Measure the order of exact − first order, at ε and ε/2.

    ``slopes`` are the first-order coefficients of the quantities that ``read`` takes from a
    solution. The remainder is Aε² + Bε³ + …: the measured order is 2 + O(εB/A), or 3 where A = 0.
    For rational radii with one digit above and below, B/A stays far below the 1e12 allowed.
    """
    from force_diffusion.numeric.arithmetic.systems import BigFloat
    from force_diffusion.numeric.mechanics.small_packing import solve

    loads = packing.surface_load()
    worst, count = mpmath.mpf(0), 0
    with mpmath.workdps(DIGITS):
        for strength in STRENGTHS:
            solutions = [
                solve(
                    packing.width,
                    packing.height,
                    n_x=packing.n[0],
                    rho=packing.rho,
                    loads=loads,
                    strength=value,
                    system=BigFloat(DIGITS),
                )
                for value in (Fraction(strength), Fraction(strength) / 2)
            ]
            for order in _orders(solutions, slopes, read, strength):
                away = 2 - order if order < 2.5 else mpmath.mpf(0)
                if abs(away) > mpmath.mpf(strength) * 10**12:
                    return Ruling(
                        Verdict.DISAGREES, f"order {mpmath.nstr(order, 8)} at ε = {strength}"
                    )
                worst, count = max(worst, abs(away)), count + 1
        if not count:
            return Ruling(Verdict.AGREES, "every remainder is zero")
        return Ruling(
            Verdict.AGREES,
            f"{count} orders measured, ε = {', '.join(STRENGTHS)}: 2 within "
            f"{mpmath.nstr(worst, 2)}",
        )


def _vector(value: Dual | Vector) -> Vector:
    assert isinstance(value, tuple)
    return value


def _scalar(value: Dual | Vector) -> Dual:
    assert isinstance(value, Dual)
    return value


def positions(printed: sympy.Expr, packing: SmallPacking) -> Ruling:
    """Exact displacements at strength ε less ε times Eq. 3."""
    solution = ExactSolution(packing, "none")
    sites = [(i + 1, j + 1) for i, j in packing.contacts]
    slopes = [
        component.slope
        for i, j in sites
        for component in _vector(evaluate(printed, solution, {sy.i: i, sy.j: j}))
    ]
    return second_order(
        packing, slopes, lambda s: [part for site in sites for part in s.displacement(*site)]
    )


def forces(printed: sympy.Expr, packing: SmallPacking) -> Ruling:
    """Exact changes of contact forces under a surface load, at strength ε, less ε times Eq. 11."""
    solution = ExactSolution(packing, "surface")
    ordered = packing.load / (2 * packing.n[1])
    slopes = [
        ordered
        * _scalar(evaluate(printed, solution, {sy.i: i, sy.j: j, sy.M: packing.height})).slope
        for i, j in packing.contacts
    ]
    return second_order(
        packing, slopes, lambda s: [s.change(i, j, "+") for i, j in packing.contacts]
    )
