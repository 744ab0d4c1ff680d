"""Means over N neighbours of one layer: Eqs. B7, B8 and B21 of T6."""

from functools import cache
from itertools import product

import sympy
from force_diffusion.derivations import eq04_contact_plus as eq04
from force_diffusion.derivations import eq05_contact_minus as eq05
from force_diffusion.derivations import eq11_total_force as eq11
from force_diffusion.derivations import eq13_surface_diffusion as eq13
from force_diffusion.derivations import eq14_bulk_diffusion as eq14
from force_diffusion.derivations.framework.grounds import OfBoth, Source
from force_diffusion.derivations.framework.record import FIRST_ORDER, usual
from force_diffusion.derivations.framework.vocabulary import (
    UNIT,
    Chain,
    Derivation,
    Lines,
    Where,
    Within,
    asymptotic,
    equation,
    formula,
    minus,
    relations,
    rewrite,
    terms,
    times,
)
from force_diffusion.derivations.parts.neighbours import (
    COVARIANCES,
    FAR,
    KEPT,
    OF_MEAN,
    OWN,
    SPREAD,
    Means,
    Window,
)
from force_diffusion.symbolic.kernel.where import BULK, SURFACE, at_fixed_height
from force_diffusion.symbolic.mechanics.lattice import mirror
from force_diffusion.symbolic.notation import Symbol
from force_diffusion.symbolic.symbols import (
    DeltaNMinus,
    DeltaNPlus,
    Dot,
    ForceMinus,
    ForcePlus,
    M,
    N,
    e_y,
    f_load,
    i,
    j,
    m_g,
    n_minus,
    n_plus,
    n_y,
    p,
    phi,
    r,
    sigma,
)
from sympy import Ge

IN_BULK = Chain((Within(eq14.steps, 1, "Eq. 14"), eq11.DIRECTIONS))

ON_SURFACE = ForcePlus(i, j) / (f_load / (2 * n_y))
OF_BULK = ForcePlus(i, j) / ((M - j) * m_g / (2 * n_y))
"""f⁺ over its mean."""

K = M - j
"""Layers of loads above a contact."""


# --- within a layer: neighbouring contacts --------------------------------------------------------


def _of_contacts(means: Means, first: str, far: str, printed: str, *after: Source) -> Lines:
    """Covariances of two neighbouring contacts, none beyond the second neighbour, their sum."""
    lines = means.lines()
    inside = tuple(means.on(j >= low, Ge(M, j + 2)) for low in (2, 3, 4))
    found = map(means.value, COVARIANCES, inside)
    near = lines.show(
        first, sympy.Tuple(*map(equation, COVARIANCES, found)), where=inside, after=after
    )
    none = lines.show(far, equation(FAR, 0), where=means.on(*relations("3 ≤ p ≤ j − 2, j < M")))
    of_mean = lines.show(
        "So the variance of the mean of N is",
        equation(means.symbol, OF_MEAN),
        where=means.where.also(N >= 3, Ge(M, j + 2)),
        after=(near, none),
    )
    spread = lines.show(
        "What grows with M cancels in",
        equation(SPREAD, (1 - phi) ** 4 / 2 * UNIT),
        where=inside[2],
        after=(near,),
    )
    lines.show(printed, means.printed, after=(near, of_mean, spread))
    return lines


CONTACTS = (*map(sympy.Integer, (1, 2)), j - 1, j, j + 1, j + 2)
"""Places apart at which two contacts of a layer may be correlated."""
MEAN_OF_N = Symbol(
    "mean_of_N_variance",
    r"\frac{\sigma^2(\overline{f^{\pm}}_{N})}{\langle f\rangle^2}",
    "σ²(mean of N f^±)/⟨f⟩²",
)


def _at_base(missed: bool) -> dict[str, Window]:
    """Windows in the two layers next to the base; the lowest packing may be ``missed``."""

    def window(at: int, count: str) -> Window:
        low = at + 1 + missed
        return Window(f"j = {at}, {count} and M ≥ {low}", missed=at + 1 if missed else None)

    return {
        "base": window(0, "N ≥ 2"),
        "base+1": window(1, "N ≥ 3"),
        "base+1, N=2": window(1, "N = 2"),
    }


BULK_MEAN = equation(
    MEAN_OF_N,
    formula("""
        ((1 − φ)²/(2N(φ + 1)²)) (σ_δr/r)²
        + (1/(60N²(1 − φ²)²)) [12(M − j)²(M + 4j) + 15(M − j)² + (M − j)(20 − 60φ + 140φ²)
            + 60j(1 + 2φ²) + 120φ³ − 210φ² + 240φ − 105
            + (28 − 90φ + 100φ² − 30φ³)/(M − j)] (σ_δr/r)²"""),
)
UNDER_BULK = Means(
    MEAN_OF_N,
    OF_BULK,
    BULK,
    CONTACTS,
    "2 ≤ N ≤ j − 1",
    BULK_MEAN,
    {
        "N=j": Window("N = j ≥ 2", 3 * phi * (K + 1) / 4),
        "N=j+1": Window("N = j + 1 ≥ 3", phi * (K + 7) / 4),
        "N>j+1": Window("N ≥ j + 2 ≥ 4", 2 * phi),
        **_at_base(missed=False),
    },
    (IN_BULK,),
)

CONTACT_MEAN = equation(
    MEAN_OF_N,
    formula("""
        ((1 − φ)²/(2N(φ + 1)²)) (σ_δr/r)²
        + (1/(3N²(1 − φ²)²)) [4(M − j)²(M + 2j) − 3M² − 6M j + 9j² + 3φ²(5M − 3j)
            − 6φ(M − j) + 2(M + 2j) + 6φ³ − 18φ² + 15φ − 6] (σ_δr/r)²"""),
)
_LESS = (1 - phi) ** 3 / 2
"""What is added one layer below the surface, where the form of a bulk load holds."""
UNDER_SURFACE = Means(
    MEAN_OF_N,
    ON_SURFACE,
    SURFACE,
    CONTACTS,
    "2 ≤ N ≤ j − 1 and M ≥ j + 2",
    CONTACT_MEAN,
    {
        "N=j": Window("N = j ≥ 2 and M ≥ j + 2", 3 * phi * K / 2),
        "N=j+1": Window("N = j + 1 ≥ 3 and M ≥ j + 2", phi * (K + 3) / 2),
        "N>j+1": Window("N ≥ j + 2 ≥ 4 and M ≥ j + 2", 2 * phi),
        "surface": Window("M = j + 1 and 2 ≤ N ≤ j − 1", _LESS),
        "surface, N=j": Window("M = j + 1 and N = j ≥ 2", _LESS + 3 * phi / 2),
        "surface, N>j": Window("M = j + 1 and N ≥ j + 1 ≥ 3", _LESS + 2 * phi),
        **_at_base(missed=True),
    },
    (eq11.IN_RADII,),
)

BANDS = (
    (j - 1, 3 * phi * K / 4),
    (j, phi * (3 - 5 * K) / 4),
    (j + 1, phi * (K - 2) / 4),
    (j + 2, phi * (K - 1) / 4),
)
"""Places apart at which two contacts of a layer are correlated after all, in ``UNIT``."""


@cache
def contact_steps() -> Lines:
    """Covariances of two; none beyond the second neighbour; their sum."""
    means = UNDER_SURFACE
    lines = _of_contacts(
        means,
        "Eq. 11 in the radii is a sum of second differences on one diagonal, and of what hangs on "
        "single sites. Two neighbouring contacts, p places apart, share radii on two of three "
        "lines (p = 1) or one (p = 2). Their covariances over ⟨f⟩², for p = 0, 1, 2:",
        "From p = 3 on it is zero, exactly, for p ≤ j − 2: first differences of one contact's tilt "
        "cross the second differences of the other, and the products add up to nothing.",
        "All of it:",
    )
    means.claim_shares(lines, eq13.PRINTED.rhs, 13)
    means.claim_pairs(
        lines,
        "from N = j on four more join in, of p = j − 1, …, j + 2, where the lines of one contact's "
        "tilt reach the base beside the other's diagonal; they are of order M",
        BANDS,
    )
    beyond = means.on(p >= j + 3, j >= 0, j < M)
    lines.claim("beyond these there are none", equation(FAR, 0), where=beyond)
    lines.claim(
        "the part that falls as 1/N has no M in it, and stays from N = j on: these four add up to "
        "zero, and leave 2φ/N² from N = j + 2 on, in units of (σ/r)²/(1−φ²)²; it takes over from "
        "N of order M³ on",
        sympy.Tuple(
            equation(terms(*(value for _, value in BANDS)), 0),
            equation(minus(times(2, terms(*(at * value for at, value in BANDS)))), 2 * phi),
        ),
        rewrite(),
        where=Where.of(j >= 0, j < M),
    )
    means.claim_windows(lines, "the forms of all other N ≥ 2, j and M")
    return lines


@cache
def bulk_steps() -> Lines:
    """As for Eq. B7, with the force of Eq. 14."""
    means = UNDER_BULK
    lines = _of_contacts(
        means,
        "Over its mean a force is the average of Eq. 11 over the loads of all layers above, as in "
        "Eq. 14. Covariances of contacts p = 0, 1, 2 places apart, over ⟨f⟩²:",
        "For 3 ≤ p ≤ j − 2 it is zero, as in Eq. B7:",
        "All of it:",
    )
    means.claim_shares(lines, eq14.PRINTED.rhs, 14)
    means.claim_windows(
        lines,
        "the forms of all other N ≥ 2, j and M; a long window has 2φ/N² more, as in Eq. B7",
    )
    return lines


# --- the vertical force on a bead ---------------------------------------------------------------

BEAD = Symbol("p_bead", "p", "p")
"""The vertical force that a bead gets from both upper contacts."""
ON_BEAD = (
    Dot(
        e_y,
        (n_plus + DeltaNPlus(i, j)) * ForcePlus(i, j)
        + (n_minus + DeltaNMinus(i, j)) * ForceMinus(i, j),
    )
    / f_load
)
"""What that is, over f_load."""
VERTICAL = terms(
    (eq11.PRINTED.rhs + mirror(eq11.PRINTED.rhs)) / 2,
    -1,
    (Dot(n_minus, DeltaNPlus(i, j)) + Dot(n_plus, DeltaNMinus(i, j))) / (2 * (1 + phi)),
)
"""p/f_load − 1: n_y(f⁺ + f⁻) and the tilts of both contacts, to first order."""
BEAD_MEAN_OF_N = Symbol(
    "mean_of_N_beads",
    r"\frac{\sigma^2(\overline{p}_{N})}{(f^{\mathrm{load}})^{2}}",
    "σ²(mean of N p)/f_load²",
)
BEAD_MEAN = equation(
    BEAD_MEAN_OF_N,
    formula("""
        (1/(12N²(1 − φ²)²)) [8(M − j)²(M + 2j) − 6(M − j)² + (M − j)(6φ² + 24φ − 2)
            + 3(1 − φ)²] (σ_δr/r)²"""),
)
BOTH = Chain((OfBoth(eq11.DERIVATION), eq11.DIRECTIONS))
"""Eq. 11 for both branches."""


def _windows_of_beads() -> dict[str, Window]:
    """All windows but the printed ones: what reaches the base adds to what reaches the surface."""
    low = {
        "": ("2 ≤ N ≤ j − 2", 0),
        "N=j-1": ("N = j − 1 ≥ 2", -3 * K**2 / 8),
        "N=j": ("N = j ≥ 2", K**2 / 4),
        "N=j+1": ("N = j + 1 ≥ 3", K**2 / 8),
        "N>j+1": ("N ≥ j + 2 ≥ 4", 0),
        "base+1": ("j = 1 and N ≥ 3", 3 * K**2 / 4),
        "base+1, N=2": ("j = 1 and N = 2", 7 * K**2 / 8),
        "base": ("j = 0 and N ≥ 2", M * (2 - 2 * phi - M) / 2),
    }
    high = {
        "": ("N ≤ M − j − 1", 0),
        "N=M-j": ("M = j + N", -(3 * phi**2 - 2 * phi + 3) / 8),
        "N>M-j": ("N ≥ M − j + 1 ≥ 2", -(1 + phi**2) / 2),
    }
    parts = tuple(
        map(relations, ("M = j + 1", "M = j + 2", "j + 3 ≤ M = 2j", "j + 3 ≤ M ≤ 2j − 1"))
    )
    found = {}
    for (below, (start, first)), (above, (end, last)) in product(low.items(), high.items()):
        name = ", ".join(one for one in (below, above) if one)
        parted = above == "N>M-j" and below in ("N=j-1", "N=j", "N=j+1")
        found[name] = Window(f"{start}, {end}", first + last, parts=parts if parted else ((),))
    del found[""]  # the printed form
    return found


OF_BEADS = Means(
    BEAD_MEAN_OF_N,
    ON_BEAD,
    SURFACE,
    (*map(sympy.Integer, (1, 2)), *(j + one for one in (-2, -1, 0, 1, 2)), K - 1, K, K + 1),
    "2 ≤ N ≤ j − 2, N ≤ M − j − 1",
    BEAD_MEAN,
    _windows_of_beads(),
    (BOTH,),
)


@cache
def bead_steps() -> Lines:
    """The same for what a bead gets from both upper contacts."""
    means = OF_BEADS
    lines = means.lines()
    vertical = lines.show(
        "The vertical force that bead (i, j) gets from both upper contacts, over f_load and less "
        "1, by Eq. 11, its mirror image, and the tilts of both:",
        equation(terms(BEAD / f_load, -1), VERTICAL),
        rewrite(BOTH.sources[0]),
        where=eq11.WHERE,
        meaning={BEAD: ON_BEAD * f_load},
    )
    deep = means.on(*relations("j ≥ 5, M ≥ j + 4"))
    near = lines.show(
        "Covariances of beads p = 0, 1, 2 places apart:",
        sympy.Tuple(*(equation(one, means.value(one, deep)) for one in COVARIANCES)),
        where=deep,
        after=(vertical,),
    )
    none = lines.show(
        "For 3 ≤ p ≤ j − 3, p ≤ M − j − 2 it is zero:",
        equation(FAR, 0),
        where=means.on(*relations("3 ≤ p ≤ j − 3, p ≤ M − j − 2")),
        after=(vertical,),
    )
    spread = lines.show(
        "This sum is zero exactly: the vertical force through a layer is the load, so that a "
        "window's sum changes through its ends alone.",
        equation(SPREAD, 0),
        where=deep,
        after=(near,),
    )
    left = lines.show(
        "So what is left of the variance of the mean is",
        equation(BEAD_MEAN_OF_N, KEPT / N**2),
        where=means.where.also(N >= 3),
        after=(none, spread),
    )
    lines.show("With these covariances:", BEAD_MEAN, after=(near, left))
    lines.claim(
        "for a single bead it is half of Eq. 13, to leading order: the two contacts of a bead are "
        "uncorrelated to leading order",
        equation(OWN, eq13.PRINTED.rhs / 2),
        asymptotic(*means.facts),
        where=deep.in_the_limit(at_fixed_height("∼")),
    )
    means.claim_windows(
        lines,
        "windows that reach as far along the layer as base or surface are away: from N = j + 2 on "
        "the base leaves nothing, while the surface leaves −(1+φ²)/2, in the same unit over N²",
    )
    return lines


# --- the equations ------------------------------------------------------------------------------

_NEIGHBOURS = (
    (MEAN_OF_N, "variance of the mean of f^± over N neighbours of one layer"),
    (N, "number of neighbouring contacts"),
    *usual(sigma, r, M, phi),
)
B7 = Derivation(
    number="B7",
    name="neighbouring_contacts",
    title="Mean over N neighbouring contacts of one branch",
    symbols=_NEIGHBOURS,
    assumptions=(*FIRST_ORDER, "a surface load", "2 ≤ N ≤ j − 1 and M ≥ j + 2"),
    premises=(eq04.DERIVATION, eq05.DERIVATION, eq11.DERIVATION, eq13.DERIVATION),
    printed=(CONTACT_MEAN,),
    domain=UNDER_SURFACE.relations,
    where=UNDER_SURFACE.where,
    steps=contact_steps,
    exact=lambda: UNDER_SURFACE.exact,
    remarks=(
        "N independent contacts would have σ_f²/N. Force fluctuations nearly cancel along a "
        "layer up to N of order M³, where the radii of the two layers that touch take over.",
    ),
)  # fmt: skip
B8 = Derivation(
    number="B8",
    name="neighbouring_beads",
    title="Mean vertical force over N neighbouring beads",
    symbols=(
        (BEAD_MEAN_OF_N, "variance of the mean of p over N neighbours of one layer"),
        (N, "number of neighbouring beads"),
        *usual(sigma, r, M, phi),
    ),
    assumptions=(
        *FIRST_ORDER,
        "a surface load; p is the vertical force that a bead gets from both upper contacts",
        "2 ≤ N ≤ j − 2 and N ≤ M − j − 1",
    ),
    premises=(eq11.DERIVATION, eq13.DERIVATION, B7),
    printed=(BEAD_MEAN,),
    domain=OF_BEADS.relations,
    where=OF_BEADS.where,
    steps=bead_steps,
    exact=lambda: OF_BEADS.exact,
)  # fmt: skip
B21 = Derivation(
    number="B21",
    name="neighbouring_contacts_bulk",
    title="Mean over N neighbouring contacts of one branch under a bulk load",
    symbols=_NEIGHBOURS,
    assumptions=(
        *FIRST_ORDER,
        "every bead above the base carries the same load, whatever its radius",
        "2 ≤ N ≤ j − 1",
    ),
    premises=(eq11.DERIVATION, eq14.DERIVATION, B7),
    printed=(BULK_MEAN,),
    domain=UNDER_BULK.relations,
    where=UNDER_BULK.where,
    steps=bulk_steps,
    exact=lambda: UNDER_BULK.exact,
)  # fmt: skip
