"""What is no statement, and theorems of one's own."""

from collections.abc import Callable
from dataclasses import replace

import sympy
from force_diffusion.symbolic import symbols as sy
from force_diffusion.symbolic.algebra.exact import UNKNOWNS
from force_diffusion.symbolic.as_printed import equation
from force_diffusion.symbolic.kernel import axioms
from force_diffusion.symbolic.kernel.theorem import NotProvedError, Theorem, check
from force_diffusion.symbolic.kernel.where import ENTERING, Where
from force_diffusion.symbolic.symbols import (
    DeltaR,
    DeltaX,
    Variance,
    e_y,
    epsilon,
    i,
    j,
    k,
    l,
    m,
    n,
    n_plus,
    n_x,
    n_y,
    p,
    phi,
    q,
    r,
    site_r,
    site_s,
)
from sympy import Sum

from .attack import BEADS, HERE, ONE, attack, checked, displaced

# what is a statement

for name, side, where, false, refused in (
    ("a divisor", HERE / (j - 3), BEADS, "it vanishes in layer 3", "not shown to differ"),
    ("a divisor in n", HERE / (n_x - n_y), BEADS, "it vanishes at φ = 0", "not shown to differ"),
    ("a divisor that is zero", HERE / ((j + 1) ** 2 - j**2 - 2 * j - 1), BEADS,
     "0 has no inverse", "not shown to differ"),
    ("ε as a divisor", HERE / epsilon, BEADS, "it vanishes without disorder", "not shown to dif"),
    ("a divisor of first order", 1 / HERE, BEADS, "it vanishes at order 0", "not shown to differ"),
    ("a divisor with a change", 1 / (1 + epsilon * HERE), BEADS, "it is not read as a series",
     "not shown to differ"),
    ("a root", sympy.sqrt(phi) * HERE, BEADS, "φ may be negative", "may be negative"),
    ("a root of what φ may make negative", sympy.sqrt(phi * Variance(HERE)), BEADS,
     "φ may be negative", "may be negative"),
    ("a root of a sum", sympy.sqrt(Sum(phi * Variance(DeltaR(i + 2 * m, j)), (m, 0, j))), BEADS,
     "φ may be negative", "may be negative"),
    ("a power that is no number", r**phi * HERE, BEADS, "no rule is sound for it",
     "is not read here"),
    ("a function", sympy.Abs(phi) * HERE, BEADS, "no rule is sound for it", "not in the language"),
    ("a float", sympy.Float(0.1) * HERE, BEADS, "it is no exact number", "not in the language"),
    ("symbols that do not commute", sympy.Symbol("x", commutative=False) * HERE, BEADS,
     "x y − y x would be 0", "not in the language"),
    ("an index undeclared", k * HERE, BEADS, "nobody says what k is", "does not say what k is"),
    ("a relation of an index undeclared", HERE, Where((i, j), (j >= 0, n >= 3), even=(i + j,)),
     "a sum over n would be taken from 3 on", "does not say what n is"),
    ("an index summed over and free", n * Sum(n, (n, 1, 2)), Where((n,)), "n has two meanings",
     "two meanings of n"),
    ("an index summed over and declared", Sum(n, (n, 1, 2)), Where((n,), (n >= 2,)),
     "the term n = 1 would be left out", "two meanings of n"),
    ("an index summed over twice", Sum(n * Sum(n, (n, 1, 2)), (n, 1, 2)), BEADS,
     "n has two meanings", "two meanings of n"),
    ("a sum over i", Sum(i, (i, 1, 2)), Where(), "i is the place of a bead", "a sum over i"),
    ("a sum that may end below its start", Sum(ONE, (n, 3, j)), BEADS, "it would be −2 at j = 0",
     "more than one below"),
    ("a site off the lattice", DeltaR(i + 1, j), BEADS, "no bead is there", "not shown to be at a"),
    ("a site below the base", DeltaR(i - 1, j - 1), BEADS, "no bead is there", "not shown to be"),
    ("a site that is no place", DeltaR(i * j, j), BEADS, "no bead is there", "not a whole-number"),
    ("an empty domain", HERE, Where.of(j >= 0, j <= -1), "everything holds there", "nothing is in"),
    ("a domain without whole numbers", ONE, Where.of(2 * q >= 2 * p + 1, 2 * q <= 2 * p + 1),
     "everything holds there", "nothing is in"),
    ("the plane's vectors in space", n_plus, Where(dimension=3), "they are of the plane",
     "belongs to the plane"),
    ("one dimension", 1 / (1 + 2 * phi), Where(dimension=1), "φ may be −½ there", "two dimensions"),
    ("a name of the kernel's own", UNKNOWNS[1][0], BEADS, "it may stand for an unknown as well",
     "name of the kernel"),
    ("a quantity of one's own", type("DeltaR", (sy.SiteFunction,), {})(i, j), BEADS,
     "it would be taken for δr", "no quantity of a packing"),
):  # fmt: skip
    attack("statement", name, false, refused)(lambda s=side, w=where: checked(s, w))  # type: ignore[misc]

attack("statement", "no equation", "it says nothing", "no equation")(
    lambda: check(sympy.Ge(j, 0), BEADS)
)


def _forged(theorem: Callable[[], Theorem]) -> Theorem:
    """A theorem not made by a rule, which is no way to call it."""
    try:
        return theorem()
    except TypeError as reason:
        raise NotProvedError(str(reason)) from None


attack("statement", "a theorem of one's own", "nobody has proved it", "made by the rules")(
    lambda: _forged(lambda: Theorem(displaced(ONE), Where(), "of course"))
)
attack("statement", "a theorem changed", "nobody has proved it", "made by the rules")(
    lambda: _forged(lambda: replace(axioms.base(), formula=equation(DeltaX(i, 0), e_y)))
)
attack("statement", "another kind of relation", "j ≠ 3 does not order layers", "no relation")(
    lambda: Where.of(sympy.Ne(j, 3))
)
attack("statement", "a load at any bead", "(r, s) stands for all others", "stand for any bead")(
    lambda: ENTERING.put_in({k: site_r, l: site_s})
)
