"""Attacks on ``reach``, ``walk``, ``inverse`` and ``differentiate``."""

import sympy
from force_diffusion.symbolic.as_printed import equation, minus, terms, times
from force_diffusion.symbolic.kernel import axioms, rules
from force_diffusion.symbolic.kernel.theorem import Theorem
from force_diffusion.symbolic.kernel.where import Where
from force_diffusion.symbolic.symbols import (
    DeltaX,
    Dot,
    L_minus,
    L_plus,
    Position,
    e_x,
    e_y,
    i,
    j,
    k,
    n,
    n_minus,
    n_plus,
    n_x,
    n_y,
    phi,
    q,
    r,
    spacing,
    z,
)
from sympy import Eq, Integer, Pow, Rational, Sum

from .attack import COUNTED, NO_SITE, ONE, ROOT, attack, told

# reach, walk, inverse, differentiate

ORDERED = axioms.ordered()
EQ_1 = r * (j + i) * n_plus + r * (j - i) * n_minus


def _reached(value: sympy.Expr, origin: Theorem, *up: Theorem) -> Theorem:
    return told(rules.reach(origin, up), Position(i, j), value)


def _on_layer_5() -> list[Theorem]:
    where = Where.of(Eq(j, 5))
    return [rules.follows(one)(one.formula, where) for one in ORDERED[1:]]


for name, value, axiom, false, refused in (
    ("other steps", 2 * EQ_1, ORDERED, "they are twice as long", "does not obey"),
    ("another origin", EQ_1 + n_plus, ORDERED, "(0, 0) is the origin", "does not obey"),
    ("one step alone", r * (j + i) * n_plus, ORDERED[:2], "(−1, 1) is never reached", "not reach"),
    ("no origin", EQ_1 + n_plus, (told(rules.rewrite(), Integer(1), 1, Where()), *ORDERED[1:]),
     "it is anywhere", "not reach every"),
    ("one step for the origin", EQ_1 + n_plus, (ORDERED[1], *ORDERED[1:]), "it is anywhere",
     "not reach every"),
    ("steps from one layer", EQ_1 + j * (j - 11) * r * n_plus, (ORDERED[0], *_on_layer_5()),
     "others are never reached", "not reach every"),
):  # fmt: skip
    attack("reach", name, false, refused)(
        lambda v=value, a=axiom: _reached(v, *a)  # type: ignore[misc]
    )
attack("reach", "no statement", "no bead is there", "not shown to be at a bead")(
    lambda: _reached(terms(EQ_1, e_y * NO_SITE, minus(e_y * NO_SITE)), *ORDERED)
)
attack("reach", "of one bead", "it says nothing of others", "do not reach")(
    lambda: told(rules.reach(ORDERED[0], ORDERED[1:]), Position(i + 2, j), EQ_1)
)

for name, value, start, step, where, false, refused in (
    ("other steps", k - 2 * q, {i: k}, {i: i - 1}, COUNTED, "each is one place", "lead there"),
    ("from nowhere", k - q, {i: k}, {i: i - 1}, Where.of(q >= 0, indices=(i,)),
     "nobody says what k is", "does not say what k is"),
    ("another start", k - 1 - q, {i: k}, {i: i - 1}, COUNTED, "it starts at k", "not lead there"),
    ("another index", k - q, {j: k}, {j: j - 1}, COUNTED, "nothing is said of i", "no index of"),
    ("without a start for it", k - q, {}, {i: i - 1}, COUNTED, "it is anywhere", "no index of"),
    ("without a step for it", k - q, {i: k}, {}, COUNTED, "nothing is said of i", "no index of"),
    ("a site by itself", i, {i: i}, {i: i}, COUNTED, "it says nothing", "by the number of steps"),
):  # fmt: skip
    attack("walk", name, false, refused)(
        lambda v=value, a=start, b=step, w=where: told(rules.walk(a, b, q), i, v, w)  # type: ignore[misc]
    )


def _inverse(entries: list[list[sympy.Expr]], other: list[list[sympy.Expr]]) -> Theorem:
    matrix = Pow(sympy.ImmutableMatrix(entries), -1, evaluate=False)
    return rules.inverse(equation(matrix, sympy.ImmutableMatrix(other)), Where())


attack("inverse", "another matrix", "their product is not 1", "normal forms")(
    lambda: _inverse([[n_x, n_y], [-n_x, n_y]], [[n_x, n_y], [-n_x, n_y]])
)
attack("inverse", "no inverse", "a matrix is not its own", "no inverse matrix")(
    lambda: rules.inverse(equation(sympy.eye(2), sympy.eye(2)), Where())
)
attack("inverse", "of a number", "it is no matrix", "no inverse matrix")(
    lambda: rules.inverse(equation(1 / r, 1 / r), Where())
)
attack("inverse", "of what is no square", "it has one on one side alone", "no inverse matrix")(
    lambda: _inverse([[ONE, ONE - ONE]], [[ONE], [ONE - ONE]])
)
attack("inverse", "where it has none", "φ vanishes somewhere", "not shown to differ")(
    lambda: _inverse([[phi]], [[1 / phi]])
)

LENGTH = sympy.Symbol("x", real=True)
SQUARE, ZERO = LENGTH**2 + 1, Integer(0)

for name, left, right, root, square, where, false, refused in (
    ("another derivative", sympy.Derivative(sympy.sqrt(SQUARE), LENGTH), LENGTH / SQUARE, ROOT,
     SQUARE, Where(), "it is x over the root", "derivatives differ"),
    ("a root of one's own", sympy.sqrt(2), r, r, Integer(2), Where(), "r is any radius",
     "not the root"),
    ("the root of what may be negative", sympy.sqrt(phi) / phi, phi ** sympy.Rational(-1, 2),
     ROOT, phi, Where(), "φ may vanish", "not the root"),
    ("what SymPy cancels", times(phi, Pow(phi, -1)), ONE, ROOT, SQUARE, Where(),
     "0/0 is not 1", "not shown to differ"),
    ("what SymPy sums", Sum(n, (n, 1, j)), j * (j + 1) / 2, ROOT, SQUARE, Where.of(j >= -5),
     "the sum may end below its start", "more than one below"),
    ("what SymPy cancels below it", sympy.Derivative(times(phi, Pow(phi, -1), z), z), ONE, ROOT,
     SQUARE, Where(), "0/0 is not 1", "not shown to differ"),
    ("a step", sympy.Derivative(z + sympy.Piecewise((0, z < Rational(1, 2)), (1, True)), z), ONE,
     ROOT, SQUARE, Where(), "it has no slope at z = ½", "Piecewise is not"),
    ("by what cosines depend on", sympy.Derivative(n_x, phi), ZERO, ROOT, SQUARE, Where(),
     "n_x² is (1 − φ)/2", "may depend on φ"),
    ("by what directions depend on", sympy.Derivative(Dot(n_plus, e_x), phi), ZERO, ROOT, SQUARE,
     Where(), "it is n_x", "may depend on φ"),
    ("by what the spacing depends on", sympy.Derivative(spacing, r), ZERO, ROOT, SQUARE, Where(),
     "it is 4 n_x", "may depend on r"),
    ("by what a load depends on", sympy.Derivative(L_minus, L_plus), ZERO, ROOT, SQUARE, Where(),
     "it is t", "may depend on L⁺"),
    ("of a layer by its height", sympy.Derivative(j, z), ZERO, ROOT, SQUARE, Where.of(j >= 0),
     "j is z M", "may depend on z"),
    ("by a layer", sympy.Derivative(z, j), ZERO, ROOT, SQUARE, Where.of(j >= 0), "z is j/M",
     "or that is a whole number"),
    ("of a power of a layer", sympy.Derivative(j**2, j), 2 * j, ROOT, SQUARE, Where.of(j >= 0),
     "a whole number has no neighbours", "or that is a whole number"),
    ("of an unknown number", sympy.Derivative(LENGTH, phi), ZERO, ROOT, SQUARE, Where(),
     "it may depend on φ", "may depend on φ"),
    ("by an unknown number", sympy.Derivative(phi, LENGTH), ZERO, ROOT, SQUARE, Where(),
     "φ may depend on it", "may depend on x"),
    ("of what belongs to a bead", sympy.Derivative(Dot(e_y, DeltaX(0, 2)), phi), ZERO, ROOT, SQUARE,
     Where(), "its line sums are along n^±", "may depend on φ"),
):  # fmt: skip
    attack("differentiate", name, false, refused)(
        lambda a=left, b=right, o=root, s=square, w=where: told(  # type: ignore[misc]
            rules.differentiate(o, s), a, b, w
        )
    )
