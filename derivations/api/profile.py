"""The exact values in every layer of a packing, each from the form that its layer has."""

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import numpy as np
import sympy
from force_diffusion.numeric.theory.expected import critical_height
from force_diffusion.symbolic import symbols as sy
from force_diffusion.symbolic.printing.text import text

from ..export.prose import both
from ..framework.record import Derivation, ExactCase
from .arrays import is_several
from .evaluation import (
    TOGETHER,
    ArgumentError,
    Evaluation,
    Number,
    holds,
    in_order,
    read_arguments,
)
from .exact import evaluation_of

PRINTED = "printed"
"""Stands for the printed equation among the names of exact forms."""


@dataclass(frozen=True, eq=False)
class Profile:
    """Exact values by layer, as :meth:`Equation.profile` gives them; it prints as a table.

    Attributes:
        heading: the equation, what was given, the quantity, and M* where the packing has a height.
        j: the layers, shape (layers,), from the base up unless others were asked for.
        height: M; None where the packing has no surface, below a load on one bead.
        values: shape (layers,); float64, or SymPy's exact numbers where only such were given.
        cases: for each layer the exact form that holds there; "printed" for the printed equation.
    """

    heading: str
    j: Any
    height: int | None
    values: Any
    cases: tuple[str, ...]

    @property
    def z(self) -> Any:
        """The relative heights j/M as floats, shape (layers,).

        Raises:
            ArgumentError: the packing has no height.
        """
        if self.height is None:
            raise ArgumentError("z = j/M needs M, which this profile does not have: use j")
        return self.j / self.height

    def __str__(self) -> str:
        heights = [""] * len(self.j) if self.height is None else [f" {z:>7.4g}" for z in self.z]
        rows = [
            (str(j), z, f"{value:.6g}" if isinstance(value, float) else str(value), case)
            for j, z, value, case in zip(self.j, heights, self.values, self.cases, strict=True)
        ]
        width = max(12, *(len(value) for _, _, value, _ in rows))
        z = "" if self.height is None else f" {'z':>7}"
        table = [("j", z, "value", "exact form"), *reversed(rows)]
        return "\n".join(
            [self.heading, *(f"{j:>3}{z} {v:>{width}}  {case}" for j, z, v, case in table)]
        )

    __repr__ = __str__


def profile(
    derivation: Derivation,
    case: str,
    exact: Mapping[str, ExactCase],
    layers: Iterable[int] | None,
    arguments: Mapping[str, Number],
) -> Profile:
    """The values of one exact form's quantity, by layer.

    Args:
        derivation: the equation.
        case: the form whose quantity is meant.
        exact: all forms, by name.
        layers: j of those that are asked for; all by default.
        arguments: values by name, but of j.

    Raises:
        ArgumentError: a name is unknown or missing, a value is not allowed, or a layer has no form.
    """
    about = f"Eq. {derivation.number}'s profile"
    forms = _forms(derivation, exact, exact[case].quantity)
    needed = set().union(*(form.needed for form in forms.values()))
    if sy.j not in needed:
        raise ArgumentError(
            f"Eq. {derivation.number}, exact form '{case}', is of no single layer: "
            f"exact('{case}').at(…) gives its value"
        )
    if "j" in arguments:
        raise ArgumentError(f"j is every layer; give layers=[{arguments['j']}] for this one alone")
    for name, value in arguments.items():
        if is_several(value):
            raise ArgumentError(
                f"{name} = {value!r}: a profile is of one packing, so give a number"
            )
    dimension = derivation.dimension
    packing, is_exact = read_arguments(about, needed - {sy.j}, arguments, dimension)
    wanted = _every_layer(packing) if layers is None else _asked(layers)
    names: list[str] = []
    values: list[Any] = []
    without: list[Any] = []
    for j in wanted:
        at, _ = read_arguments(about, needed, {**arguments, "j": j}, dimension)
        fitting = [n for n, one in forms.items() if all(holds(d, at) for d in one.domain)]
        if fitting:
            names.append(fitting[0])
            values.append(forms[fitting[0]].value(at, exact=is_exact))
        else:
            without.append(j)
    if without:
        raise ArgumentError(_missing(derivation, case, without, wanted))
    made = np.empty(len(values), dtype=object if is_exact else float)
    made[:] = values
    given = ", ".join(
        f"{text(symbol)} = {arguments[symbol.in_code]}"
        for symbol in sorted(packing, key=lambda one: in_order(arguments).index(one.in_code))
    )
    heading = f"Eq. {derivation.number}, {given}: {text(exact[case].quantity)}"
    if {sy.M, sy.sigma, sy.r} <= set(packing):
        scatter = packing[sy.sigma] / packing[sy.r]
        highest = critical_height(Fraction(int(scatter.p), int(scatter.q)))
        if highest < math.inf:
            heading += f"\nTo first order in δr, for M well below M* = {highest:.4g}."
    return Profile(
        heading=heading,
        j=np.array(wanted, dtype=int),
        height=int(packing[sy.M]) if sy.M in packing else None,
        values=made,
        cases=tuple(names),
    )


def _forms(
    derivation: Derivation, exact: Mapping[str, ExactCase], quantity: sympy.Expr
) -> dict[str, Evaluation]:
    """The forms of a quantity by name, among them the printed equation where it is one."""
    found = {
        name: evaluation_of(derivation, name, form)
        for name, form in exact.items()
        if form.quantity == quantity
    }
    for part, line in enumerate(derivation.printed):
        is_exact = derivation.relation == "=" and derivation.domain
        if is_exact and line.lhs == quantity and not derivation.unlike(part):
            found[PRINTED] = Evaluation(
                about=f"Eq. {derivation.number}",
                sides=(line.rhs,),
                dimension=derivation.dimension,
                domain=derivation.domain,
            )
    return found


def _every_layer(packing: Mapping[sympy.Symbol, sympy.Rational]) -> list[int]:
    """The layers that a packing has below its surface, or below the bead that bears the load."""
    top = packing[sy.M] if sy.M in packing else packing[sy.l]
    return [
        j
        for j in range(int(top))
        if all(
            allowed(*({**packing, sy.j: sympy.Integer(j)}[symbol] for symbol in pair))
            for pair, (_, allowed) in TOGETHER.items()
            if sy.j in pair and set(pair) <= {*packing, sy.j}
        )
    ]


def _asked(layers: Any) -> list[Any]:
    if not is_several(layers) or not len(layers) or np.ndim(layers) != 1:
        raise ArgumentError(f"layers = {layers!r}: several layers are allowed, as range(2, 5)")
    return list(layers)


def _missing(derivation: Derivation, case: str, without: list[Any], wanted: list[Any]) -> str:
    """Say which layers have no form, and how to have the others."""
    told = f"Eq. {derivation.number} has no exact form for {_these(without)} here"
    left = [j for j in wanted if j not in without]
    if not left:
        return f"{told}, which are all layers that are asked for ('{case}')"
    run = left == list(range(left[0], left[-1] + 1))
    start = "" if left[0] == 0 else f"{left[0]}, "
    return f"{told}; give layers={f'range({start}{left[-1] + 1})' if run else left} for the others"


def _these(layers: list[Any]) -> str:
    return both([f"j = {j}" for j in layers]) if len(layers) < 6 else f"{len(layers)} layers"
