"""Rulings on the orders of a variance in M: a printed leading order, edges, the next order."""

import sympy
from force_diffusion.symbolic.algebra.exact import FIELD, NotExactError, RationalFunction
from force_diffusion.symbolic.kernel.decisions import Ruling, from_test, proved, refuted, undecided
from force_diffusion.symbolic.printing.text import text
from force_diffusion.symbolic.symbols import M, j, phi, r, sigma, z
from force_diffusion.symbolic.variances.variance import (
    CASES,
    ClosedForm,
    at_fixed_z,
    grows_evenly,
    largest_weight,
    leading,
    order,
)


def compare_leading_order(exact: RationalFunction, candidate: sympy.Expr) -> Ruling:
    """Rule on a candidate in M and z: exact − candidate must be of lower order than exact."""
    try:
        difference = (exact - FIELD.from_sympy(candidate.xreplace({z: j / M}))).reduced()
    except NotExactError as reason:
        return undecided(str(reason))
    if difference.is_zero():
        return proved("equal at every order")
    power = order(difference)
    shown = f"{text(at_fixed_z(difference))} · M^{power}"
    if power < order(exact):
        if not grows_evenly(difference):
            return undecided(f"the order of {shown} is not shown to hold at every z and φ")
        return proved(f"exact − printed is of order M^{power}: {shown}")
    return refuted(f"exact − candidate is of the leading order M^{power} itself: {shown}")


def weights_follow(sum_of_squares: sympy.Expr, printed: sympy.Expr, note: str) -> Ruling:
    """A sum of squared weights in M and j has the leading order that is printed in M and z."""
    total = FIELD.from_sympy(sum_of_squares)
    in_layers = FIELD.from_sympy(printed.xreplace({z: j / M}))
    return from_test((leading(total) - leading(in_layers)).is_zero(), note)


def edges_follow(forms: dict[str, ClosedForm], printed: sympy.Expr) -> Ruling:
    """The exact forms of the base and of the layer below the surface, at leading order in M."""
    at_zero = FIELD.from_sympy(printed.xreplace({z: sympy.Integer(0)}))
    surface = FIELD.from_sympy(2 * M * (1 + phi**2) * (sigma / r) ** 2 / (1 - phi**2) ** 2)
    return from_test(
        (leading(forms["base"].value) - at_zero).is_zero()
        and (leading(forms["surface"].value) - surface).is_zero(),
        "at j = 0 the leading order is the printed form at z = 0; at j = M − 1 it is 2(1+φ²) M in "
        "units of (σ/r)²/(1−φ²)²",
    )


def next_order_is(forms: dict[str, ClosedForm], printed: sympy.Expr, stated: sympy.Expr) -> Ruling:
    """Exact less printed form is ``stated`` at leading order, in units of (σ/r)²/(1−φ²)²."""
    unit = (sigma / r) ** 2 / (1 - phi**2) ** 2
    rest = forms["interior"].value - FIELD.from_sympy(printed.xreplace({z: j / M}))
    expected = FIELD.from_sympy((stated * unit).xreplace({z: j / M}))
    return from_test(
        (leading(rest) - expected).is_zero(),
        f"in units of (σ/r)²/(1−φ²)² the next order is {text(stated)}",
    )


def no_radius_dominates(force: sympy.Expr, forms: dict[str, ClosedForm]) -> Ruling:
    """The largest squared weight over the variance: what the central limit theorem needs."""
    shares = [
        2 * largest_weight(force.xreplace(at), region) - order(forms[case].value)
        for case, (at, region, *_) in CASES.items()
    ]
    return from_test(
        max(shares) == -1, "a radius has a share of order 1/M in the variance, in every layer"
    )
