"""What derivations of one's own use beside the vocabulary: premises, forces in the radii, layers.

``force_diffusion.derivation`` gives all of it; the guide *Derive your own* has an example.
"""

from collections.abc import Iterator, Mapping
from fractions import Fraction

import sympy
from force_diffusion.numeric.arithmetic.errors import ForceDiffusionError
from force_diffusion.symbolic.algebra import explicit
from force_diffusion.symbolic.kernel.decisions import Ruling
from force_diffusion.symbolic.kernel.where import BULK, SURFACE, Loading
from force_diffusion.symbolic.symbols import M, j, sigma

from .. import eq04_contact_plus as eq04
from .. import eq05_contact_minus as eq05
from .. import eq11_total_force as eq11
from .. import eq14_bulk_diffusion as eq14
from ..framework.catalogue import Number
from ..framework.grounds import Chain, OfBoth
from ..framework.layered import Case, Layered
from ..framework.loading import load
from ..framework.record import Derivation, Witness
from ..witnesses.draws import SmallPacking
from ..witnesses.squared_weights import compare, weights_of_forces
from .equation import equation

_LOADS = {SURFACE: "surface", BULK: "bulk"}


def premise(number: Number) -> Derivation:
    """The derivation of an equation, for a derivation of one's own to rest on.

    >>> premise(11).title
    'Contact force under a surface load'

    Raises:
        NoSuchFormError: there is no such equation.
    """
    return load(equation(number).number)


def forces(loading: Loading) -> Chain:
    """What gives f⁺ and f⁻ of every bead in the radii, to first order: Eqs. 4 and 5 in Eq. 11.

    Args:
        loading: ``SURFACE``, or ``BULK`` (then what Eq. 14 says of a force).
    """
    _assert_known(loading)
    force = eq11.DERIVATION if loading == SURFACE else eq14.FORCE
    return Chain((OfBoth(force), (eq04.DERIVATION, eq05.DERIVATION)))


def mean_force(loading: Loading) -> sympy.Expr:
    """⟨f⟩, the force of the contacts above a bead of layer j in the ordered packing.

    >>> mean_force(SURFACE), mean_force(BULK)
    (f_load/(2*n_y), m_g*(M - j)/(2*n_y))
    """
    _assert_known(loading)
    return eq11.ORDERED if loading == SURFACE else eq14.ORDERED[eq14.MEAN_FORCE]


def layers(first: int = 2) -> dict[str, Case]:
    """All layers 0 ≤ j < M, where the closed form of the interior begins with layer ``first``.

    Each layer below it is a case of its own, and so is the one below the surface; the smallest
    packings have values of their own.

    >>> [case.validity for case in layers(1).values()]
    ['1 ≤ j ≤ M − 2', 'j = 0 and M ≥ 2', 'j = M − 1 and M ≥ 2']
    """
    small = [(k + 1, k) for k in range(first)]
    inside = Case(f"{first} ≤ j ≤ M − 2", (j >= first, j + 2 <= M))
    below = {
        f"base+{k}" if k else "base": Case(
            f"j = {k} and M ≥ {k + 2}", (sympy.Eq(j, k), k + 2 <= M), (small[k],)
        )
        for k in range(first)
    }
    top = Case(f"j = M − 1 and M ≥ {first + 1}", (sympy.Eq(j, M - 1), first + 1 <= M), tuple(small))
    return {"interior": inside, **below, "surface": top}


def on_small_packings(
    variance: Layered, shares: Mapping[str, int | Fraction], up_to: int = 5
) -> Witness:
    """Compare the variance of a sum of a bead's two forces with exact packings, as fractions.

    It shares no code with the proof: of packings with rational directions the weight of every
    radius is a coefficient of the exact, nonlinear forces, squared and summed here.

    Args:
        variance: at every layer.
        shares: what f⁺/⟨f⟩ ("+") and f⁻/⟨f⟩ ("-") of a bead are multiplied by and added.
        up_to: height of the packings; all layers of all up to it are compared.
    """
    _assert_known(variance.loading)

    def run(packing: SmallPacking) -> Ruling:
        return compare(_pairs(variance, shares, up_to, packing))

    name = f"exact variances equal sums of squared weights of exact packings, all j < M ≤ {up_to}"
    return Witness(name, run)


def _pairs(
    variance: Layered, shares: Mapping[str, int | Fraction], up_to: int, packing: SmallPacking
) -> Iterator[tuple[str, Fraction, Fraction]]:
    known = {**explicit.geometry(*packing.n, Fraction(1)), sigma: 1}
    load = _LOADS[variance.loading]
    for height, layer, stated in variance.stated(up_to, known):
        total: dict[tuple[int, int], Fraction] = {}
        for branch, share in shares.items():
            weights = weights_of_forces(height, packing.n, load, branch=branch)[layer]
            for site, weight in weights.items():
                total[site] = total.get(site, Fraction(0)) + share * weight
        squares = sum((weight**2 for weight in total.values()), Fraction(0))
        yield f"M = {height}, j = {layer}", stated, squares


def _assert_known(loading: Loading) -> None:
    if loading not in _LOADS:
        raise ForceDiffusionError("the loading must be SURFACE or BULK")
