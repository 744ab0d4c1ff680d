"""The axioms: what is assumed of a packing and its forces, and nothing else is.

First order in the disorder is the arithmetic of dual numbers; that a packing depends smoothly on
its radii is assumed with it. The lattice, the base vectors n^± = (±n_x, n_y) of length 1 with
|φ| < ½, and their reciprocals b^± are part of the reading of every statement.
"""

from functools import cache

import sympy

from .. import symbols as sy
from ..algebra.exact import NotProvedError
from ..mechanics import lattice
from ..symbols import i, j, n_minus, n_plus, r, site_r, site_s
from ..trees import equation
from .domain import Domain, Loading
from .theorem import Theorem, made

_ANY_BEAD = Domain.of(j >= 0)


def _axiom(left: sympy.Expr, right: sympy.Expr | int, domain: Domain) -> Theorem:
    return made(equation(left, sympy.sympify(right)), domain, "an axiom")


@cache
def ordered() -> tuple[Theorem, Theorem, Theorem]:
    """The ordered packing: bead (0, 0) is the origin, and each touches the two above it."""
    here = sy.Position(i, j)
    return (
        _axiom(sy.Position(0, 0), 0, Domain()),
        _axiom(sy.Position(i + 1, j + 1) - here, 2 * r * n_plus, _ANY_BEAD),
        _axiom(sy.Position(i - 1, j + 1) - here, 2 * r * n_minus, _ANY_BEAD),
    )


@cache
def base() -> Theorem:
    """The beads of the base stay where they are."""
    return _axiom(sy.DeltaX(i, j), 0, Domain.of(sympy.Eq(j, 0)))


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
    squared = separation[0] ** 2 + separation[1] ** 2
    return _axiom(squared, (2 * r + sy.epsilon * radii) ** 2, Domain.of(j >= 1))


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
        sy.LoadForce(*here),
        (n_plus + sy.DeltaNPlus(*left)) * sy.ForcePlus(*left),
        (n_minus + sy.DeltaNMinus(*right)) * sy.ForceMinus(*right),
        -(n_plus + sy.DeltaNPlus(*here)) * sy.ForcePlus(*here),
        -(n_minus + sy.DeltaNMinus(*here)) * sy.ForceMinus(*here),
    )
    return _axiom(sympy.Add(*forces), 0, Domain.of(site_s >= 1))


@cache
def loads(loading: Loading) -> tuple[Theorem, ...]:
    """What a loading says of the loads and of the forces above them.

    Raises:
        NotProvedError: it is none of those below, nor one of them at another place.
    """
    if not any(loading.is_like(kind) for kind in LOADINGS):
        raise NotProvedError(f"{loading.name} is not a known loading")
    at_place = Domain.of(sympy.Ge(loading.place[-1], 0), loading=loading)
    given = [made(item, at_place, "the load") for item in loading.given]
    beads = Domain.of(site_s >= 0, indices=(site_r,), loading=loading)
    everywhere = [made(law, beads.also(*when), "the load") for law, when in loading.everywhere]
    return (*given, *everywhere)


GAUSSIAN_FORCES = "Gaussian forces"
"""An assumption that is not proved: forces are normally distributed, given mean and variance."""


# loads

_PLUS, _MINUS = sy.ForcePlus, sy.ForceMinus


def _zero(quantity: sympy.Expr) -> sympy.Eq:
    return sympy.Eq(quantity, 0, evaluate=False)


_BEAD = (sy.site_r, sy.site_s)
_DOWN = sympy.Eq(sy.LoadForce(sy.k, sy.l), -sy.f_load * sy.e_y, evaluate=False)
_NOTHING_ABOVE = (_zero(_PLUS(sy.k, sy.l)), _zero(_MINUS(sy.k, sy.l)))

LOADED = Loading("loaded", "bead (k, l) carries nothing but its load", (sy.k, sy.l), _NOTHING_ABOVE)
"""A loaded bead that no contact presses from above."""

LOADED_VERTICALLY = Loading(
    "loaded vertically",
    "bead (k, l) carries nothing but its load, which points straight down",
    (sy.k, sy.l),
    (*_NOTHING_ABOVE, _DOWN),
)
"""The same, its load being of magnitude f_load and vertical."""

PASSING = Loading(
    "passing",
    "bead (r, s) carries no load of its own, and f⁺_rs alone enters it",
    _BEAD,
    (_zero(sy.LoadForce(*_BEAD)), _zero(_MINUS(*_BEAD))),
    acting=(_PLUS(*_BEAD),),
)
"""A bead that one contact force passes."""

ENTERING = Loading(
    "entering",
    "f⁺ enters through the contact from (k−1, l−1) to (k, l), and nothing else does",
    (sy.k, sy.l),
    (),
    (
        (_zero(sy.LoadForce(*_BEAD)), (sy.site_s <= sy.l - 1,)),
        (_zero(_MINUS(*_BEAD)), (sympy.Eq(sy.site_s, sy.l - 1),)),
        (_zero(_PLUS(*_BEAD)), (sympy.Eq(sy.site_s, sy.l - 1), sy.site_r <= sy.k - 2)),
        (_zero(_PLUS(*_BEAD)), (sympy.Eq(sy.site_s, sy.l - 1), sy.site_r >= sy.k)),
    ),
    (_PLUS(sy.k - 1, sy.l - 1),),
)
"""What one contact force contributes below itself."""

_AT_SURFACE = sympy.Eq(sy.site_s, sy.M)
_FREE_SURFACE = ((_zero(_PLUS(*_BEAD)), (_AT_SURFACE,)), (_zero(_MINUS(*_BEAD)), (_AT_SURFACE,)))


def _carries(load: sympy.Expr, *where: sympy.Basic) -> tuple[sympy.Eq, tuple[sympy.Basic, ...]]:
    return sympy.Eq(sy.LoadForce(*_BEAD), load, evaluate=False), where


def _on_surface(name: str, words: str, load: sympy.Expr) -> Loading:
    """A load on each bead of the surface j = M."""
    none_below = (_zero(sy.LoadForce(*_BEAD)), (sy.site_s <= sy.M - 1,))
    everywhere = (none_below, _carries(load, _AT_SURFACE), *_FREE_SURFACE)
    return Loading(name, words, (sy.M,), (), everywhere)


def _on_every_bead(name: str, words: str, load: sympy.Expr) -> Loading:
    """A load on each bead of a packing of height M; the base bears its own."""
    loaded = _carries(load, sy.site_s >= 1, sy.site_s <= sy.M)
    return Loading(name, words, (sy.M,), (), (loaded, *_FREE_SURFACE))


_TILTED = -sy.L_plus * (sy.n_plus + sy.t * sy.n_minus)

SURFACE = _on_surface(
    "surface",
    "each bead of the surface j = M carries f_load straight down, no other a load",
    -sy.f_load * sy.e_y,
)
"""A load on the surface of a packing of height M."""

BULK = _on_every_bead(
    "bulk",
    "each bead above the base carries its weight mg straight down, and nothing lies above j = M",
    -sy.m_g * sy.e_y,
)
"""A weight on every bead of a packing of height M."""

SURFACE_TILTED = _on_surface(
    "surface tilted",
    "each bead of the surface j = M carries −(L⁺n⁺ + L⁻n⁻), L⁻ = tL⁺, no other a load",
    _TILTED,
)
"""A load in any direction on the surface of a packing of height M."""

BULK_TILTED = _on_every_bead(
    "bulk tilted",
    "each bead above the base carries −(L⁺n⁺ + L⁻n⁻), L⁻ = tL⁺, and nothing lies above j = M",
    _TILTED,
)
"""A load in any direction on every bead of a packing of height M."""

_LEFT_OF_IT = (sympy.Eq(sy.site_s, sy.l), sy.site_r <= sy.k - 2)

POINT = Loading(
    "point",
    "bead (k, l) carries f_load straight down, no other bead in its layer or below it a load, and "
    "no force comes from above",
    (sy.k, sy.l),
    (_DOWN,),
    (
        (_zero(sy.LoadForce(*_BEAD)), (sy.site_s <= sy.l - 1,)),
        (_zero(sy.LoadForce(*_BEAD)), _LEFT_OF_IT),
        (_zero(sy.LoadForce(*_BEAD)), tuple(map(lattice.mirrored_relation, _LEFT_OF_IT))),
        (_zero(_PLUS(*_BEAD)), (sympy.Eq(sy.site_s, sy.l),)),
        (_zero(_MINUS(*_BEAD)), (sympy.Eq(sy.site_s, sy.l),)),
    ),
)
"""A load on one bead, and nothing else."""

LOADINGS = (
    LOADED, LOADED_VERTICALLY, PASSING, ENTERING, SURFACE, BULK, SURFACE_TILTED, BULK_TILTED, POINT
)  # fmt: skip
"""All of them."""
