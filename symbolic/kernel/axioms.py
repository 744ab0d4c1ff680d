"""The axioms: what is assumed of a packing and its forces, and nothing else is.

First order in the disorder is the arithmetic of dual numbers; that a packing depends smoothly on
its radii is assumed with it. The lattice, the base vectors n^± = (±n_x, n_y) of length 1 with
|φ| < ½, and their reciprocals b^± are part of the reading of every statement.
"""

from functools import cache

import sympy

from .. import symbols as sy
from ..as_printed import equation, terms
from ..notation import Symbol
from ..symbols import i, j, n_minus, n_plus, r, site_r, site_s
from .theorem import Theorem, made
from .where import Loading, Where

_ANY_BEAD = Where.of(j >= 0)


def _axiom(left: sympy.Expr, right: sympy.Expr | int, where: Where) -> Theorem:
    return made(equation(left, sympy.sympify(right)), where, "axiom")


@cache
def ordered() -> tuple[Theorem, Theorem, Theorem]:
    """The ordered packing: bead (0, 0) is the origin, and each touches the two above it."""
    here = sy.Position(i, j)
    return (
        _axiom(sy.Position(0, 0), 0, Where()),
        _axiom(sy.Position(i + 1, j + 1) - here, 2 * r * n_plus, _ANY_BEAD),
        _axiom(sy.Position(i - 1, j + 1) - here, 2 * r * n_minus, _ANY_BEAD),
    )


@cache
def base() -> Theorem:
    """The beads of the base stay where they are."""
    return _axiom(sy.DeltaX(i, 0), 0, Where((i,), even=(i,)))


@cache
def contact(branch: int) -> Theorem:
    """Bead (i, j), j ≥ 1, touches its support to the left (1) or to the right (−1).

    The centres are as far apart as the radii together, at every strength ε of the disorder:
    |x_ij − x_support + ε(δx_ij − δx_support)|² = (2r + ε(δr_ij + δr_support))².
    """
    support = (i - branch, j - 1)
    apart = (n_plus if branch == 1 else n_minus) * 2 * r
    moved = sy.DeltaX(i, j) - sy.DeltaX(*support)
    radii = sy.DeltaR(i, j) + sy.DeltaR(*support)
    separation = [sy.Dot(e, apart) + sy.epsilon * sy.Dot(e, moved) for e in (sy.e_x, sy.e_y)]
    return _axiom(
        separation[0] ** 2 + separation[1] ** 2, (2 * r + sy.epsilon * radii) ** 2, Where.of(j >= 1)
    )


@cache
def direction(branch: int) -> Theorem:
    """What δn^± is: n^± + εδn^± is the separation of two touching beads over their radii.

    At every strength ε, with bead (i, j) below: (n^± + εδn^±)(2r + ε(δr_ij + δr_above)) =
    2r n^± + ε(δx_above − δx_ij).
    """
    above = (i + branch, j + 1)
    unit, change = (n_plus, sy.DeltaNPlus(i, j)) if branch == 1 else (n_minus, sy.DeltaNMinus(i, j))
    radii = sy.DeltaR(i, j) + sy.DeltaR(*above)
    moved = sy.DeltaX(*above) - sy.DeltaX(i, j)
    left = (unit + sy.epsilon * change) * (2 * r + sy.epsilon * radii)
    return _axiom(left, 2 * r * unit + sy.epsilon * moved, _ANY_BEAD)


@cache
def balance() -> Theorem:
    """Load and contact forces of a bead (r, s), s ≥ 1, add up to zero; there is no friction."""
    here, left, right = (site_r, site_s), (site_r - 1, site_s - 1), (site_r + 1, site_s - 1)
    forces = (
        sy.Load(*here),
        (n_plus + sy.DeltaNPlus(*left)) * sy.ForcePlus(*left),
        (n_minus + sy.DeltaNMinus(*right)) * sy.ForceMinus(*right),
        -(n_plus + sy.DeltaNPlus(*here)) * sy.ForcePlus(*here),
        -(n_minus + sy.DeltaNMinus(*here)) * sy.ForceMinus(*here),
    )
    return _axiom(sympy.Add(*forces), 0, Where.of(site_s >= 1))


@cache
def loads(loading: Loading) -> tuple[Theorem, ...]:
    """What a loading says of the loads and of the forces above them."""
    at_place = Where(loading=loading)
    given = [made(one, at_place, "loading") for one in loading.given]
    beads = Where.of(indices=(site_r, site_s), loading=loading)
    everywhere = [made(one, beads.also(*when), "loading") for one, when in loading.everywhere]
    return (*given, *everywhere)


GAUSSIAN_FORCES = "Gaussian forces"
"""An assumption that no rule ends: forces are normally distributed, given mean and variance."""

FORCE = Symbol("f_rel", "f", "f", real=True)
"""A force over its mean."""
SQUARE = Symbol("v", positive=True)
"""Its variance."""

GAUSSIAN_BELOW = equation(
    sympy.Derivative(
        sympy.erfc(terms(1, -FORCE) / sympy.sqrt(2 * SQUARE), evaluate=False) / 2, FORCE
    ),
    sympy.exp(-(terms(1, -FORCE) ** 2) / (2 * SQUARE)) / sympy.sqrt(2 * sympy.pi * SQUARE),
)
"""The probability of a Gaussian force below f, which vanishes as f → −∞, and its density."""
