"""T6 (Eqs. B7, B8, B12, B21): correlations of contact forces, and means over N neighbours."""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from functools import cache, cached_property, partial
from itertools import combinations, product

import sympy
from force_diffusion.derivations import eq04_contact_plus as eq04
from force_diffusion.derivations import eq05_contact_minus as eq05
from force_diffusion.derivations import eq11_total_force as eq11
from force_diffusion.derivations import eq12_delta_weights as eq12
from force_diffusion.derivations import eq13_surface_diffusion as eq13
from force_diffusion.derivations import eq14_bulk_diffusion as eq14
from force_diffusion.derivations.framework.catalogue import Number
from force_diffusion.derivations.framework.proving import By, Line, Source, facts_of
from force_diffusion.derivations.framework.record import ExactCase, Missed, usual
from force_diffusion.derivations.framework.vocabulary import (
    UNIT,
    Chain,
    Claim,
    Derivation,
    Lines,
    Where,
    Within,
    Witness,
    asymptotic,
    cases,
    equation,
    minus,
    moment,
    power,
    rewrite,
    terms,
    times,
)
from force_diffusion.derivations.witnesses import modular, neighbours
from force_diffusion.derivations.witnesses.draws import SmallPacking
from force_diffusion.derivations.witnesses.squared_weights import compare
from force_diffusion.symbolic.algebra import explicit
from force_diffusion.symbolic.as_written import formula
from force_diffusion.symbolic.kernel import moments, rules
from force_diffusion.symbolic.kernel.decisions import Ruling, from_test
from force_diffusion.symbolic.kernel.theorem import Theorem
from force_diffusion.symbolic.kernel.where import BULK, SURFACE, Limit, Loading, at_fixed_height
from force_diffusion.symbolic.mechanics.lattice import mirror
from force_diffusion.symbolic.notation import Symbol
from force_diffusion.symbolic.printing.text import text
from force_diffusion.symbolic.symbols import (
    Covariance,
    DeltaNMinus,
    DeltaNPlus,
    Dot,
    ForceMinus,
    ForcePlus,
    M,
    N,
    Variance,
    e_y,
    f_load,
    i,
    j,
    k,
    l,
    m,
    m_g,
    n_minus,
    n_plus,
    n_y,
    p,
    phi,
    r,
    sigma,
    z,
)
from sympy import Eq, Ge, Le, Rational

_RADII = power(times(sigma, 1 / r), 2)
DIRECTIONS = (eq04.DERIVATION, eq05.DERIVATION)
IN_BULK = Chain((Within(eq14.steps, 1, "Eq. 14"), DIRECTIONS))

ON_SURFACE = ForcePlus(i, j) / (f_load / (2 * n_y))
OF_BULK = ForcePlus(i, j) / ((M - j) * m_g / (2 * n_y))
"""f⁺ over its mean."""

ASSUMED = ("the radii are independent, of zero mean and variance σ²", "first order in δr")
K = M - j
"""Layers of loads above a contact."""


# --- within a layer: covariances of neighbours, and the variance of their mean -------------------

COVARIANCES = tuple(
    Symbol(f"C_{place}", f"C_{{{place}}}", f"C{lowered}") for place, lowered in enumerate("₀₁₂")
)
"""Covariances of two that are 0, 1, 2 places apart, over the squared mean of one."""
FAR = Symbol("C_p", "C_{p}", "C_p")
"""That of two that are p places apart."""
OWN, FIRST, SECOND = COVARIANCES
OF_MEAN = (N * OWN + 2 * (N - 1) * FIRST + 2 * (N - 2) * SECOND) / N**2
"""Variance of the mean of N of them, if those farther apart are uncorrelated."""


def apart(quantity: sympy.Expr, places: sympy.Expr | int) -> sympy.Expr:
    """The same of the contact or bead so many places to the right, in the same layer."""
    return quantity.xreplace({i: i + 2 * places})


@dataclass(frozen=True)
class Window:
    """Numbers of neighbours, layers and heights with a closed form of their own.

    Attributes:
        validity: which, in words.
        relations: the same as relations.
        added: what it has beyond the printed form, in units of ``UNIT``/N²; None for a closed form
            that is found.
        missed: the height M with a value of its own, if there is one.
        parts: on which it is proved one by one, where too many places may be one on all of it.
    """

    validity: str
    relations: tuple[sympy.Basic, ...]
    added: sympy.Expr | None = None
    missed: int | None = None
    parts: tuple[tuple[sympy.Basic, ...], ...] = ((),)


@dataclass(frozen=True, eq=False)
class Means:
    """Covariances of a quantity and its neighbours in a layer, and the variance of their mean.

    Attributes:
        symbol: what is printed for the variance of the mean of N.
        quantity: at (i, j), over its mean.
        loading: of the packing.
        alone: how many places apart two may be correlated; at all others they are not.
        relations: the domain of the printed form.
        printed: that form.
        windows: all others.
        facts: what gives its forces in the radii.
    """

    symbol: sympy.Symbol
    quantity: sympy.Expr
    loading: Loading
    alone: tuple[sympy.Expr, ...]
    relations: tuple[sympy.Basic, ...]
    printed: sympy.Eq
    windows: Mapping[str, Window]
    facts: tuple[Source, ...] = field(repr=False, default=())

    def on(self, *relations: sympy.Basic) -> Where:
        """A domain of statements about it."""
        return Where.of(*relations, loading=self.loading).tightened()

    @cached_property
    def where(self) -> Where:
        """The domain of the printed form."""
        return self.on(*self.relations)

    @cached_property
    def meaning(self) -> dict[sympy.Expr, sympy.Expr]:
        """What the symbols of its lines stand for."""
        both = {one: apart(self.quantity, place) for place, one in enumerate(COVARIANCES)}
        summed = sympy.Sum(apart(self.quantity, m), (m, 0, N - 1))
        return {
            **{one: Covariance(self.quantity, other) for one, other in both.items()},
            FAR: Covariance(self.quantity, apart(self.quantity, p)),
            self.symbol: Variance(summed / N),
        }

    @property
    def by(self) -> By:
        """How all of it is proved."""
        return moment(*self.facts, alone=self.alone)

    def in_parts(self, window: Window) -> By:
        """How the form of a window is proved."""
        return self.by if window.parts == ((),) else cases(self.by, *window.parts)

    def value(self, symbol: sympy.Symbol, where: Where) -> sympy.Expr:
        """What one of the symbols is found to be; a line says that this is right."""
        facts = facts_of(self.facts)
        found = moments.value(self.meaning[symbol], facts, where, alone=self.alone)
        return found.to_sympy()

    @cached_property
    def exact(self) -> dict[str, ExactCase]:
        """The forms beside the printed one, as users get them."""
        found = {}
        for name, window in self.windows.items():
            where = self.on(*window.relations)
            if window.added is None:
                form = self.value(self.symbol, where)
            else:
                added = sympy.factor(window.added / N**2)
                form = terms(self.printed.rhs, times(added, UNIT))
            domain, missed = window.relations, tuple[Missed, ...]()
            if window.missed:
                domain = tuple(one for one in domain if not one.has(M))
                small = Eq(M, window.missed)
                value = self.value(self.symbol, self.on(*domain, small))
                missed = (Missed(f"M = {window.missed}", (small,), value),)
            by = self.in_parts(window)
            line = Line(window.validity, equation(self.symbol, form), by, where, self.meaning)
            found[name] = ExactCase(self.symbol, window.validity, form, domain, missed, line=line)
        return found

    def claim_windows(self, lines: Lines, name: str) -> None:
        """Claim what all windows, layers and heights have that the printed form is not for."""
        forms = []
        for case, form in self.exact.items():
            by, domain = self.in_parts(self.windows[case]), self.windows[case].relations
            forms.append((self.on(*domain), form.expression, by))
            forms += [(self.on(*form.domain, *one.when), one.expression, by) for one in form.missed]
        lines.claim(
            name,
            sympy.Tuple(*(equation(self.symbol, form) for _, form, _ in forms)),
            tuple(by for *_, by in forms),
            where=tuple(where for where, *_ in forms),
            meaning=self.meaning,
        )

    def claim_pairs(
        self, lines: Lines, name: str, pairs: Iterable[tuple[sympy.Expr, sympy.Expr]]
    ) -> None:
        """Claim covariances of two so many places apart, in units of ``UNIT``, deep inside."""
        pairs = tuple(pairs)
        deep = (j >= 6, Ge(M, j + 6))
        lines.claim(
            name,
            sympy.Tuple(*(equation(FAR, times(value, UNIT)) for _, value in pairs)),
            self.by,
            where=tuple(self.on(*deep, Eq(p, place)) for place, _ in pairs),
            meaning=self.meaning,
        )

    def claim_shares(self, lines: Lines, variance: sympy.Expr, number: int) -> None:
        """Claim the correlations of neighbours to leading order, and what a mean keeps."""
        lines.claim(
            "to leading order a contact's correlation with its first neighbour is −2/3, with its "
            f"second 1/6: of Eq. {number} the mean keeps 2/(3N²)",
            sympy.Tuple(
                equation(FIRST, times(-Rational(2, 3), variance)),
                equation(SECOND, times(Rational(1, 6), variance)),
                equation(KEPT, times(Rational(2, 3), variance)),
            ),
            asymptotic(*self.facts),
            where=self.on(j >= 4, Ge(M, j + 2)).in_the_limit(at_fixed_height("∼")),
            meaning=self.meaning,
        )

    def witnesses(self, quantity: str) -> tuple[Witness, ...]:
        """Packings in which weights of neighbours are summed before they are squared."""

        def stated(height: int, layer: int, count: int, cosine: Fraction) -> Fraction:
            at = {M: height, j: layer, N: count}
            form = next(form for where, form in self._forms() if where.holds(at))
            return explicit.number(form, {**at, phi: cosine, sigma: 1, r: 1})

        return (
            Witness(
                "exact packings of M ≤ 4: squares of summed weights, as fractions",
                partial(neighbours.agree_in_small_ones, quantity, stated),
            ),
            Witness(
                "packings to first order, M from 12 to 15, every N ≤ 2M, modulo a prime",
                partial(neighbours.agree_in_high_ones, quantity, stated),
            ),
        )

    def _forms(self) -> Iterator[tuple[Where, sympy.Expr]]:
        yield self.where, self.printed.rhs
        for form in self.exact.values():
            yield from ((self.on(*form.domain, *one.when), one.expression) for one in form.missed)
            yield self.on(*form.domain), form.expression


SPREAD = OWN + 2 * FIRST + 2 * SECOND
"""What each of many neighbours adds to the variance of their sum."""
KEPT = -2 * FIRST - 4 * SECOND
"""What is left of that variance beside N times ``SPREAD``."""


def _of_contacts(means: Means, first: str, far: str, printed: str, *after: Source) -> Lines:
    """Covariances of two neighbouring contacts, none beyond the second neighbour, their sum."""
    lines = Lines(means.where)
    inside = (means.on(j >= 2, Ge(M, j + 2)), *(means.on(j >= low, Ge(M, j + 2)) for low in (3, 4)))
    near = lines.show(
        first,
        sympy.Tuple(
            *(
                equation(one, means.value(one, where))
                for one, where in zip(COVARIANCES, inside, strict=True)
            )
        ),
        means.by,
        where=inside,
        meaning=means.meaning,
        after=after,
    )
    none = lines.show(
        far,
        equation(FAR, 0),
        means.by,
        where=means.on(p >= 3, p <= j - 2, j < M),
        meaning=means.meaning,
    )
    of_mean = lines.show(
        "So the variance of the mean of N is",
        equation(means.symbol, OF_MEAN),
        means.by,
        where=means.where.also(N >= 3, Ge(M, j + 2)),
        meaning=means.meaning,
        after=(near, none),
    )
    spread = lines.show(
        "What grows with M cancels in",
        equation(SPREAD, (1 - phi) ** 4 / 2 * UNIT),
        means.by,
        where=inside[2],
        meaning=means.meaning,
        after=(near,),
    )
    lines.show(
        printed, means.printed, means.by, meaning=means.meaning, after=(near, of_mean, spread)
    )
    return lines


CONTACTS = (*map(sympy.Integer, (1, 2)), j - 1, j, j + 1, j + 2)
"""Places apart at which two contacts of a layer may be correlated."""
MEAN_OF_N = Symbol(
    "mean_of_N_variance",
    r"\frac{\sigma^2(\overline{f^{\pm}}_{N})}{\langle f\rangle^2}",
    "σ²(mean of N f^±)/⟨f⟩²",
)
_PER_CONTACT = times((1 - phi) ** 2 / (2 * N * (1 + phi) ** 2), _RADII)
UP_TO_BASE = (N >= 2, Le(N, j - 1))
"""Windows that are shorter than the way to the base."""


def _at_base(missed: bool) -> dict[str, Window]:
    """Windows in the two layers next to the base; the lowest packing may be ``missed``."""

    def window(at: int, *counts: sympy.Basic) -> Window:
        low = at + 1 + missed
        words = f"j = {at}, {text(counts[0])} and M ≥ {low}"
        height = Ge(M, low, evaluate=False)  # M is positive
        return Window(words, (Eq(j, at), *counts, height), None, at + 1 if missed else None)

    return {
        "base": window(0, N >= 2),
        "base+1": window(1, N >= 3),
        "base+1, N=2": window(1, Eq(N, 2)),
    }


BULK_MEAN = equation(
    MEAN_OF_N,
    terms(
        _PER_CONTACT,
        times(
            1 / (60 * N**2 * (1 - phi**2) ** 2),
            terms(
                times(12, terms(M, -j) ** 2, terms(M, times(4, j))),
                times(15, terms(M, -j) ** 2),
                times(terms(M, -j), terms(20, minus(times(60, phi)), times(140, phi**2))),
                times(60, j, terms(1, times(2, phi**2))),
                times(120, phi**3),
                minus(times(210, phi**2)),
                times(240, phi),
                -105,
                (28 - 90 * phi + 100 * phi**2 - 30 * phi**3) / (M - j),
            ),
            _RADII,
        ),
    ),
)
UNDER_BULK = Means(
    MEAN_OF_N,
    OF_BULK,
    BULK,
    CONTACTS,
    (*UP_TO_BASE, Ge(M, j + 1)),
    BULK_MEAN,
    {
        "N=j": Window("N = j ≥ 2", (Eq(N, j), j >= 2, Ge(M, j + 1)), 3 * phi * (K + 1) / 4),
        "N=j+1": Window("N = j + 1 ≥ 3", (Eq(N, j + 1), j >= 2, Ge(M, j + 1)), phi * (K + 7) / 4),
        "N>j+1": Window("N ≥ j + 2 ≥ 4", (Ge(N, j + 2), j >= 2, Ge(M, j + 1)), 2 * phi),
        **_at_base(missed=False),
    },
    (IN_BULK,),
)

CONTACT_MEAN = equation(
    MEAN_OF_N,
    terms(
        _PER_CONTACT,
        times(
            1 / (3 * N**2 * (1 - phi**2) ** 2),
            terms(
                times(4, terms(M, -j) ** 2, terms(M, times(2, j))),
                minus(times(3, M**2)),
                minus(times(6, M, j)),
                times(9, j**2),
                times(3, phi**2, terms(times(5, M), minus(times(3, j)))),
                minus(times(6, phi, terms(M, -j))),
                times(2, terms(M, times(2, j))),
                times(6, phi**3),
                minus(times(18, phi**2)),
                times(15, phi),
                -6,
            ),
            _RADII,
        ),
    ),
)
_TOP = {M: j + 1}
_LESS = (1 - phi) ** 3 / 2
"""What is added one layer below the surface, where the form of a bulk load holds."""
UNDER_SURFACE = Means(
    MEAN_OF_N,
    ON_SURFACE,
    SURFACE,
    CONTACTS,
    (*UP_TO_BASE, Ge(M, j + 2)),
    CONTACT_MEAN,
    {
        "N=j": Window("N = j ≥ 2 and M ≥ j + 2", (Eq(N, j), j >= 2, Ge(M, j + 2)), 3 * phi * K / 2),
        "N=j+1": Window(
            "N = j + 1 ≥ 3 and M ≥ j + 2", (Eq(N, j + 1), j >= 2, Ge(M, j + 2)), phi * (K + 3) / 2
        ),
        "N>j+1": Window(
            "N ≥ j + 2 ≥ 4 and M ≥ j + 2", (Ge(N, j + 2), j >= 2, Ge(M, j + 2)), 2 * phi
        ),
        "surface": Window("j = M − 1 and 2 ≤ N ≤ j − 1", (*UP_TO_BASE, Eq(M, j + 1)), _LESS),
        "surface, N=j": Window(
            "j = M − 1 and N = j ≥ 2", (Eq(N, j), j >= 2, Eq(M, j + 1)), _LESS + 3 * phi / 2
        ),
        "surface, N>j": Window(
            "j = M − 1 and N ≥ j + 1 ≥ 3", (Ge(N, j + 1), j >= 2, Eq(M, j + 1)), _LESS + 2 * phi
        ),
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
    lines.claim(
        "beyond these there are none",
        equation(FAR, 0),
        means.by,
        where=means.on(p >= j + 3, j >= 0, j < M),
        meaning=means.meaning,
    )
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
    times(
        1 / (12 * N**2 * (1 - phi**2) ** 2),
        terms(
            times(8, terms(M, -j) ** 2, terms(M, times(2, j))),
            minus(times(6, terms(M, -j) ** 2)),
            times(terms(M, -j), terms(times(6, phi**2), times(24, phi), -2)),
            times(3, terms(1, -phi) ** 2),
        ),
        power(times(sigma, 1 / r), 2),
    ),
)


@dataclass(frozen=True)
class _Mirrored:
    """Eq. 11 for both branches."""

    words: str = "Eq. 11"

    @cached_property
    def theorems(self) -> tuple[Theorem, ...]:
        """Of f⁺, and its mirror image."""
        (own,) = eq11.DERIVATION.theorems
        return own, rules.mirror(own)


BOTH = Chain((_Mirrored(), DIRECTIONS))
SHORTER = Ge(M, j + N + 1)
"""N ≤ M − j − 1: windows that are shorter than the way to the surface."""


def _windows_of_beads() -> dict[str, Window]:
    """All windows but the printed ones: what reaches the base adds to what reaches the surface."""
    low = {
        "": ("2 ≤ N ≤ j − 2", (N >= 2, Le(N, j - 2)), 0),
        "N=j-1": ("N = j − 1 ≥ 2", (Eq(N, j - 1), N >= 2), -3 * K**2 / 8),
        "N=j": ("N = j ≥ 2", (Eq(N, j), j >= 2), K**2 / 4),
        "N=j+1": ("N = j + 1 ≥ 3", (Eq(N, j + 1), j >= 2), K**2 / 8),
        "N>j+1": ("N ≥ j + 2 ≥ 4", (Ge(N, j + 2), j >= 2), 0),
        "base+1": ("j = 1 and N ≥ 3", (Eq(j, 1), N >= 3), 3 * K**2 / 4),
        "base+1, N=2": ("j = 1 and N = 2", (Eq(j, 1), Eq(N, 2)), 7 * K**2 / 8),
        "base": ("j = 0 and N ≥ 2", (Eq(j, 0), N >= 2), M * (2 - 2 * phi - M) / 2),
    }
    long = -(1 + phi**2) / 2
    high = {
        "": ("N ≤ M − j − 1", (SHORTER,), 0),
        "N=M-j": ("N = M − j", (Eq(M, j + N),), -(3 * phi**2 - 2 * phi + 3) / 8),
        "N>M-j": ("N ≥ M − j + 1 ≥ 2", (Ge(M, j + 1), Le(M, j + N - 1)), long),
    }
    parts = (
        (Eq(M, j + 1),),
        (Eq(M, j + 2),),
        (Ge(M, j + 3), Eq(M, 2 * j)),
        (Ge(M, j + 3), Le(M, 2 * j - 1)),
    )
    found = {}
    for (below, (start, there, first)), (above, (end, here, last)) in product(
        low.items(), high.items()
    ):
        name = ", ".join(one for one in (below, above) if one)
        parted = above == "N>M-j" and below in ("N=j-1", "N=j", "N=j+1")
        found[name] = Window(
            f"{start}, {end}",
            (*there, *here),
            first + last,
            parts=parts if parted else ((),),
        )
    del found[""]  # the printed form
    return found


OF_BEADS = Means(
    BEAD_MEAN_OF_N,
    ON_BEAD,
    SURFACE,
    (*map(sympy.Integer, (1, 2)), *(j + one for one in (-2, -1, 0, 1, 2)), K - 1, K, K + 1),
    (N >= 2, Le(N, j - 2), SHORTER),
    BEAD_MEAN,
    _windows_of_beads(),
    (BOTH,),
)


@cache
def bead_steps() -> Lines:
    """The same for what a bead gets from both upper contacts."""
    means = OF_BEADS
    lines = Lines(means.where)
    change = terms(BEAD / f_load, -1)
    vertical = lines.show(
        "The vertical force that bead (i, j) gets from both upper contacts, over f_load and less "
        "1, by Eq. 11, its mirror image, and the tilts of both:",
        equation(change, VERTICAL),
        rewrite(BOTH.sources[0]),
        where=eq11.WHERE,
        meaning={BEAD: ON_BEAD * f_load},
    )
    deep = means.on(j >= 5, Ge(M, j + 4))
    near = lines.show(
        "Covariances of beads p = 0, 1, 2 places apart:",
        sympy.Tuple(*(equation(one, means.value(one, deep)) for one in COVARIANCES)),
        means.by,
        where=deep,
        meaning=means.meaning,
        after=(vertical,),
    )
    none = lines.show(
        "For 3 ≤ p ≤ j − 3, p ≤ M − j − 2 it is zero:",
        equation(FAR, 0),
        means.by,
        where=means.on(p >= 3, p <= j - 3, p <= M - j - 2),
        meaning=means.meaning,
        after=(vertical,),
    )
    spread = lines.show(
        "This sum is zero exactly: the vertical force through a layer is the load, so that a "
        "window's sum changes through its ends alone.",
        equation(SPREAD, 0),
        means.by,
        where=deep,
        meaning=means.meaning,
        after=(near,),
    )
    left = lines.show(
        "So what is left of the variance of the mean is",
        equation(BEAD_MEAN_OF_N, KEPT / N**2),
        means.by,
        where=means.where.also(N >= 3),
        meaning=means.meaning,
        after=(none, spread),
    )
    lines.show(
        "With these covariances:", BEAD_MEAN, means.by, meaning=means.meaning, after=(near, left)
    )
    lines.claim(
        "for a single bead it is half of Eq. 13, to leading order: the two contacts of a bead are "
        "uncorrelated to leading order",
        equation(OWN, eq13.PRINTED.rhs / 2),
        asymptotic(*means.facts),
        where=deep.in_the_limit(at_fixed_height("∼")),
        meaning=means.meaning,
    )
    means.claim_windows(
        lines,
        "windows that reach as far along the layer as base or surface are away: from N = j + 2 on "
        "the base leaves nothing, while the surface leaves −(1+φ²)/2, in the same unit over N²",
    )
    return lines


# --- between layers -----------------------------------------------------------------------------

COVARIANCE = Symbol(
    "layers_covariance",
    r"\frac{\langle\Delta f^{+}_{ij}\,\Delta f^{+}_{i+l-j,\,l}\rangle}{\langle f\rangle^2}",
    "⟨Δf⁺_ij Δf⁺_{i+l−j,l}⟩/⟨f⟩²",
)
CORRELATION = Symbol("layers_correlation", r"\rho_{jl}", "ρ_jl")
z_upper = Symbol("z_upper", "z'", "z′", positive=True)
"""Relative height l/M of the upper contact."""
AT_HEIGHTS = {z: j / M, z_upper: l / M}

LAYERS = equation(
    COVARIANCE,
    times(
        1 / (4 * (1 - phi**2) ** 2),
        terms(
            times(
                terms(M, -l),
                terms(
                    times(8, M**2), times(8, M, l), minus(times(12, j**2)), minus(times(4, l**2))
                ),
            ),
            minus(times(6, M, terms(M, j, l))),
            times(6, terms(j**2, times(j, l), l**2)),
            times(2, phi**2, terms(times(9, terms(M, -l)), -4)),
            times(2, phi, terms(times(2, M), -j, -l, -2)),
            minus(times(8, M)),
            times(7, j),
            times(9, l),
            6,
        ),
        power(times(sigma, 1 / r), 2),
    ),
)

UPPER = (j >= 0, l >= j, Ge(M, l + 1))
"""A contact of layer j and one of layer l, which is not below it."""
APART = (j >= 2, l >= j + 2)
INSIDE = (*APART, Ge(M, l + 2))
WEIGHTS = Symbol("products", r"\sum w\,w'", "Σw w′")
"""Sum over all radii of the products of both weights in Eq. 12, its prefactor left out."""
PRODUCTS = times(
    6,
    terms(
        times(terms(M, -l), sympy.Sum(M - j, (m, 1, j))),
        times(terms(M, -l), sympy.Sum(M - m, (m, j + 1, l))),
        sympy.Sum((M - m) ** 2, (m, l + 1, M)),
    ),
)
HIGHEST = times(terms(M, -l), terms(times(2, M**2), times(2, M, l), minus(times(3, j**2)), -(l**2)))
REST = minus(times(terms(M, -l), terms(times(3, M), minus(times(3, j)), -1)))
ON_SURFACE_LEADING = times(
    M**3,
    terms(1, -z_upper),
    terms(times(3, terms(1, -(z**2))), minus(terms(1, -z_upper) ** 2)),
    UNIT,
)
IN_BULK_LEADING = times(
    M**3 / (10 * (1 - z)),
    terms(1, -z_upper),
    terms(
        3, times(6, z_upper), minus(times(15, z**2)), minus(times(6, z_upper**2)),
        times(10, z**3), times(2, z_upper**3),
    ),
    UNIT,
)  # fmt: skip
"""The same for a bulk load, both forces over their own means."""
AT_TWO_HEIGHTS = Limit(
    "∼", "M → ∞ at fixed z = j/M and z′ = l/M, 0 < z < z′ < 1", (M, j, l), (j, l - j, M - l)
)


def between(*relations: sympy.Basic, loading: Loading | None = SURFACE) -> Where:
    """A domain of two layers, of the indices i, j, l, M and p."""
    return Where.of(*relations, loading=loading).without((k,))


def higher(quantity: sympy.Expr, places: sympy.Expr | int = 0) -> sympy.Expr:
    """The same in layer l, so many places to the right of the diagonal of (i, j)."""
    return quantity.xreplace({i: i + l - j + 2 * places, j: l})


MEANT = {COVARIANCE: Covariance(ON_SURFACE, higher(ON_SURFACE))}
FAR_LEFT = Symbol("C_minus_p", "C_{-p}", "C_−p")
FAR_APART = {
    FAR: Covariance(ON_SURFACE, higher(ON_SURFACE, p)),
    FAR_LEFT: Covariance(ON_SURFACE, higher(ON_SURFACE, -p)),
}
"""Covariances of contacts whose diagonals are p places apart."""
UNCORRELATED: tuple[tuple[sympy.Symbol, tuple[sympy.Basic, ...]], ...] = (
    (FAR, (p >= 3, p <= j - 2)),
    (FAR, (p >= j + 3,)),
    (FAR_LEFT, (p >= 3, p <= l - j - 2)),
    (FAR_LEFT, (p >= l - j + 2, p <= l - 2)),
    (FAR_LEFT, (p >= l + 3,)),
)
"""Where they are, away from base and surface."""


def _ends(above: sympy.Expr) -> tuple[sympy.Expr, ...]:
    """What is left at p = j − 1, …, j + 2, ``above`` layers of the other contact's path up."""
    return tuple(value.xreplace({M: above + j}).expand() for _, value in BANDS)


LEFT_OVER: tuple[tuple[sympy.Symbol, sympy.Expr, sympy.Expr], ...] = (
    *((FAR, j + at, value) for at, value in enumerate(_ends(M - l), start=-1)),
    *((FAR_LEFT, l + at, value) for at, value in enumerate(_ends(M - j), start=-1)),
    (FAR_LEFT, l - j - 1, -(phi**2) * (4 * j + 3 - 2 * phi) / 4),
    (FAR_LEFT, l - j, phi**2 * (4 * j + 1) / 2),
    (FAR_LEFT, l - j + 1, -(phi**2) * (4 * j - 1 + 2 * phi) / 4),
)
"""Places where two contacts are correlated after all, in ``UNIT``."""

OTHER_BRANCH = Covariance(ON_SURFACE, ForceMinus(i + 2 * p + j - l, l) / (f_load / (2 * n_y)))
"""Of f⁺_ij and the f⁻ of layer l whose diagonal crosses that of f⁺, p layers above (i, j)."""
CROSSINGS: tuple[tuple[sympy.Basic, ...], ...] = (
    (p <= -4, p >= 4 - j),
    (p >= 4, p <= l - j - 4),
    (p >= l - j + 4, p <= M - j - 4, p <= l - 4),
    (p >= l - j + 4, p <= M - j - 4, p >= l + 4),
)
"""Where these two are uncorrelated: below both, between both, above both."""

_BETWEEN = (j >= 4, Ge(l, j + 6), Ge(M, l + 4))
_APART_AT_BASE = (
    (*_BETWEEN, Ge(M, l + j + 6)),
    (*_BETWEEN, Le(M, l + j - 6)),
)
"""Where the tilts' lines do not meet at the base while the diagonals cross at the surface."""


def _beside(
    place: sympy.Expr | int, first: int, *written: str, where: tuple[sympy.Basic, ...] = _BETWEEN
) -> tuple[tuple[tuple[sympy.Basic, ...], sympy.Expr], ...]:
    """Covariances where the crossing is so many layers and more above ``place``, in ``UNIT``."""
    return tuple(
        ((*where, Eq(p, place + at)), formula(one)) for at, one in enumerate(written, start=first)
    )


CROSSED = {
    "the lower contact": _beside(
        0, -1,
        "−φ(M − l − 1)(4j − 1 + 2φ)/4",
        "φ[(M − l)(12j + 1 + 2φ) − 8j − 2]/4",
        "−φ[(M − l)(12j + 5 − 2φ) − 4j − 3 + 2φ]/4",
        "φ(M − l)(4j + 3 − 2φ)/4",
    ),
    "the upper contact": _beside(
        l - j, -1,
        "−φ[4l(M − l) + 2(l² − j²) − M − 5j + 2l + 2φ(M + j − 2l) − φ² + 4φ − 4]/4",
        "φ[12l(M − l) + 6(l² − j²) + M − 7j − 2l + 2φ(M + j − 2l) + 5φ² + 2φ − 1]/4",
        "−φ[12l(M − l) + 6(l² − j²) + 5M + j − 10l − 2φ(M + j − 2l) + 5φ² + 4φ − 2]/4",
        "φ[4l(M − l) + 2(l² − j²) + 3M + 3j − 6l − 2φ(M + j − 2l) − φ² + 6φ − 5]/4",
    ),
    "the base": _beside(
        -j, -2,
        "(M − j − 1)(M − l − 1)/4",
        "−(2M − j − l − 2)/4",
        "−[6(M − j)(M − l) − 5(2M − j − l) + 3]/4",
        "[8(M − j)(M − l) − 3(2M − j − l)]/4",
        "−3(M − j)(M − l)/4",
    ),
    "the base, where the lines of the tilts meet": _beside(
        l, 0, "−3φ²/4", "φ²/2", "φ²/4", where=_APART_AT_BASE[0]
    ),
    "the surface": tuple(
        one
        for where in _APART_AT_BASE
        for one in _beside(
            M - j, -1, "−(3 − 2φ + 3φ²)/4", "(1 − φ)²/2", "(1 + φ)²/4", where=where
        )
    ),
}  # fmt: skip
"""Where they are correlated after all, by what their diagonals cross next to."""

EDGES: dict[str, tuple[str, tuple[sympy.Basic, ...]]] = {
    "next": ("2 ≤ j = l − 1 ≤ M − 3", (j >= 2, Eq(l, j + 1), Ge(M, l + 2))),
    "base": ("j = 0 and 2 ≤ l ≤ M − 2", (Eq(j, 0), l >= 2, Ge(M, l + 2))),
    "base, next": ("j = 0, l = 1 and M ≥ 3", (Eq(j, 0), Eq(l, 1), M >= 3)),
    "base+1": ("j = 1 and 3 ≤ l ≤ M − 2", (Eq(j, 1), l >= 3, Ge(M, l + 2))),
    "base+1, next": ("j = 1, l = 2 and M ≥ 4", (Eq(j, 1), Eq(l, 2), M >= 4)),
    "surface": ("2 ≤ j ≤ l − 2 and l = M − 1", (*APART, Eq(M, l + 1))),
    "surface, next": ("2 ≤ j = l − 1 = M − 2", (j >= 2, Eq(l, j + 1), Eq(M, l + 1))),
    "base, surface": ("j = 0 and 2 ≤ l = M − 1", (Eq(j, 0), l >= 2, Eq(M, l + 1))),
    "base, next, surface": ("j = 0, l = 1 and M = 2", (Eq(j, 0), Eq(l, 1), Eq(M, 2))),
    "base+1, next, surface": ("j = 1, l = 2 and M = 3", (Eq(j, 1), Eq(l, 2), Eq(M, 3))),
    "base+1, surface": ("j = 1 and 3 ≤ l = M − 1", (Eq(j, 1), l >= 3, Eq(M, l + 1))),
}
"""Pairs of layers with a closed form of their own."""


@cache
def edges() -> dict[str, ExactCase]:
    """The covariance at the edges, as users get it."""
    facts, found = facts_of((eq11.IN_RADII,)), {}
    for name, (validity, relations) in EDGES.items():
        where = between(*relations)
        form = moments.value(MEANT[COVARIANCE], facts, where).to_sympy()
        line = Line(validity, equation(COVARIANCE, form), moment(eq11.IN_RADII), where, MEANT)
        found[name] = ExactCase(COVARIANCE, validity, form, relations, line=line)
    return found


@cache
def layer_steps() -> Lines:
    """Products of the weights of Eq. 12; exactly; beside the diagonal; as a correlation."""
    lines = Lines(between(*INSIDE))
    products = lines.show(
        "By Eq. 12 the forces of two contacts on one diagonal, j < l, are sums of the same Δ on "
        "it, with the weights M − max(j, m) and M − max(l, m). The squares of the radii in one Δ "
        "add up to 6. So the products of both weights are",
        equation(WEIGHTS, PRODUCTS),
        moment(),
        where=between(j >= 1, l >= j + 1, Ge(M, l + 1), loading=None),
        meaning={WEIGHTS: Covariance(OF_DELTA, higher(OF_DELTA)) / sigma**2},
        after=(eq12.DERIVATION,),
    )
    added = lines.show(
        "Added up:",
        equation(PRODUCTS, terms(HIGHEST, REST)),
        rewrite(),
        where=between(*UPPER, loading=None),
        after=(products,),
    )
    highest = lines.show(
        "The first term, with the prefactor of Eq. 12 squared, is the leading order, z = j/M being "
        "the height of the lower contact and z′ = l/M that of the upper one:",
        equation(times(eq12.PREFACTOR**2, sigma**2, HIGHEST), ON_SURFACE_LEADING),
        rewrite(),
        where=between(*UPPER, loading=None),
        meaning=AT_HEIGHTS,
        after=(added,),
    )
    exact = lines.show(
        "Eq. 11 in the radii, weight by weight, for 2 ≤ j ≤ l − 2 and l ≤ M − 2:",
        LAYERS,
        moment(eq11.IN_RADII),
        meaning=MEANT,
    )
    limit = between(*INSIDE).in_the_limit(AT_TWO_HEIGHTS)
    leading = lines.show(
        "Its leading order is that of step 3; for z′ = z it is Eq. 13:",
        equation(COVARIANCE, ON_SURFACE_LEADING),
        asymptotic(eq11.IN_RADII),
        where=limit,
        meaning={**MEANT, **AT_HEIGHTS},
        after=(highest, exact),
    )
    lines.show(
        "Contacts of layer l whose diagonals are p ≥ 3 places away: to the right, where p is none "
        "of j − 1, …, j + 2; to the left, where it is none of l − 1, …, l + 2, nor of l − j − 1, "
        "…, l − j + 1. At those places a line of one contact's tilt meets the other's path where "
        "that begins or ends.",
        sympy.Tuple(*(equation(one, 0) for one, _ in UNCORRELATED)),
        moment(eq11.IN_RADII),
        where=tuple(between(*relations, *INSIDE) for _, relations in UNCORRELATED),
        meaning=FAR_APART,
    )
    below, above = (eq13.PRINTED.rhs.xreplace({z: at}) for at in (z, z_upper))
    lines.show(
        "As a correlation, with Eq. 13 for both variances:",
        equation(CORRELATION**2, SQUARED),
        rewrite(),
        where=between(*UPPER, loading=None),
        meaning={CORRELATION**2: ON_SURFACE_LEADING**2 / (below * above), **AT_HEIGHTS},
        after=(eq13.DERIVATION, leading),
    )
    lines.claim(
        "beside the diagonal, one and two places away, the covariances are −2/3 and 1/6 of it "
        "to leading order, as within a layer",
        sympy.Tuple(
            *(
                equation(
                    Covariance(ON_SURFACE, higher(ON_SURFACE, side * places)),
                    times(share, ON_SURFACE_LEADING),
                )
                for places, share in ((1, -Rational(2, 3)), (2, Rational(1, 6)))
                for side in (1, -1)
            )
        ),
        asymptotic(eq11.IN_RADII),
        where=between(j >= 4, l >= j + 4, Ge(M, l + 2)).in_the_limit(AT_TWO_HEIGHTS),
        meaning=AT_HEIGHTS,
    )
    deep = (j >= 4, l >= j + 4, Ge(M, l + 2))
    lines.claim(
        "where the diagonal is p = j − 1, …, j + 2 places to the right, or to the left "
        "l − 1, …, l + 2 or l − j − 1, …, l − j + 1, a covariance of order M is left, for j and "
        "l − j from 4 on and M − l from 2 on, and none for φ = 0",
        sympy.Tuple(*(equation(one, times(value, UNIT)) for one, _, value in LEFT_OVER)),
        moment(eq11.IN_RADII),
        where=tuple(between(*deep, Eq(p, at)) for _, at, _ in LEFT_OVER),
        meaning=FAR_APART,
    )
    lines.claim(
        "f⁺ and f⁻ are uncorrelated, exactly, where their diagonals cross four layers or more "
        "from both, from the base and from the surface, and, if q layers above both, where q "
        "and j differ by four or more",
        sympy.Tuple(*(equation(OTHER_BRANCH, 0) for _ in CROSSINGS)),
        moment(BOTH),
        where=tuple(between(*relations, *UPPER) for relations in CROSSINGS),
    )
    crossed = [one for group in CROSSED.values() for one in group]
    lines.claim(
        "where their diagonals cross next to one of both, or to the base, a covariance of order M² "
        "is left, next to the surface one of order 1; for j from 4 on, l − j from 6 on and M − l "
        "from 4 on",
        sympy.Tuple(*(equation(OTHER_BRANCH, times(value, UNIT)) for _, value in crossed)),
        moment(BOTH),
        where=tuple(between(*relations) for relations, _ in crossed),
    )
    lines.claim(
        "next to each of both, and to the base, these covariances add up to zero",
        sympy.Tuple(
            *(
                equation(terms(*(value for _, value in group)), 0)
                for name, group in CROSSED.items()
                if name != "the surface"
            )
        ),
        rewrite(),
        where=between(*UPPER, loading=None),
    )
    of_bulk = Covariance(OF_BULK, higher(OF_BULK))
    lines.claim(
        "under a bulk load, over both means, it goes as M³(1−z′)Q (σ/r)²/(1−φ²)², where "
        "10(1−z)Q = 3 + 6z′ − 15z² − 6z′² + 10z³ + 2z′³",
        equation(of_bulk, IN_BULK_LEADING),
        asymptotic(IN_BULK),
        where=between(*APART, Ge(M, l + 1), loading=BULK).in_the_limit(AT_TWO_HEIGHTS),
        meaning=AT_HEIGHTS,
    )
    bulk_squared = IN_BULK_LEADING.xreplace({1 - z_upper: sympy.S.One}) ** 2 / (
        eq14.PRINTED.rhs * eq14.PRINTED.rhs.xreplace({z: z_upper})
    ).xreplace({1 - z_upper: sympy.S.One})
    ends = {z: sympy.Integer(0), z_upper: sympy.Integer(1)}
    lines.claim(
        "along a diagonal from the base to the surface a correlation of √3/2 is left under a "
        "surface load, of √5/3 under a bulk load, as M → ∞ and then z′ → 1",
        sympy.Tuple(
            equation(SQUARED.xreplace(ends), Rational(3, 4)),
            equation(bulk_squared.xreplace(ends), Rational(5, 9)),
        ),
        rewrite(),
        where=between(*UPPER, loading=None),
    )
    lines.claim(
        "the forms next to base and surface, and of neighbouring layers",
        sympy.Tuple(*(equation(COVARIANCE, one.expression) for one in edges().values())),
        moment(eq11.IN_RADII),
        where=tuple(between(*relations) for _, relations in EDGES.values()),
        meaning=MEANT,
    )
    return lines


OF_DELTA = sympy.Sum(times(eq12.BRACES, eq12.ON_DIAGONAL), (m, 1, M))
"""Eq. 12 without its prefactor."""
SQUARED = times(
    terms(times(3, terms(1, -(z**2))), minus(terms(1, -z_upper) ** 2)) ** 2,
    1 / (4 * terms(1, -z) ** 2),
    1 / terms(1, times(2, z)),
    1 / terms(1, times(2, z_upper)),
)
"""The squared correlation of two contacts of one diagonal."""


def _mean_of_diagonal() -> Ruling:
    """Twice the integral over 0 < z < z′ < 1, against that of the variance, by powers."""
    lower, upper = sympy.symbols("a b")
    of_pair = sympy.expand((1 - upper) * (3 * (1 - lower**2) - (1 - upper) ** 2))
    up_to = sympy.Poly(of_pair, lower).integrate().as_expr().xreplace({lower: upper})
    whole = 2 * sympy.Poly(up_to, upper).integrate()(1)
    single = sympy.Poly(2 * (1 - z) ** 2 * (1 + 2 * z), z).integrate()(1)
    return from_test(
        whole == Rational(4, 5) and single == 1,
        "the mean over a diagonal has 4/5 of the variance that a contact of it has on average",
    )


def _covariances(
    heights: Iterable[int], cosine: Fraction
) -> Iterator[tuple[str, tuple[int, int, int], Fraction]]:
    """What is stated of pairs of layers: where, (M, j, l), the covariance for r = σ = 1."""
    stated = [(between(*INSIDE), LAYERS.rhs)]
    stated += [(between(*one.domain), one.expression) for one in edges().values()]
    for height in heights:
        for lower, upper in combinations(range(height), 2):
            at = {M: height, j: lower, l: upper}
            form = next(form for where, form in stated if where.holds(at))
            value = explicit.number(form, {**at, phi: cosine, sigma: 1, r: 1})
            yield f"M = {height}, j = {lower}, l = {upper}", (height, lower, upper), value


def _layers_of_small_ones(packing: SmallPacking) -> Ruling:
    stated = _covariances((2, 3, 4, 5), packing.n[1] ** 2 - packing.n[0] ** 2)
    return compare(
        (where, value, neighbours.between_layers(*at, packing.n)) for where, at, value in stated
    )


def _layers_of_high_ones(packing: SmallPacking) -> Ruling:
    cosine = packing.n[1] ** 2 - packing.n[0] ** 2
    return compare(
        (
            (where, modular.residue(value), modular.between_layers(*at, 0, cosine))
            for where, at, value in _covariances((13, 20), cosine)
        ),
        modular.EQUAL,
    )


# --- the equations ------------------------------------------------------------------------------

_LOADED = "a surface load"
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
    assumptions=(*ASSUMED, _LOADED, "2 ≤ N ≤ j − 1 and M ≥ j + 2"),
    premises=(eq04.DERIVATION, eq05.DERIVATION, eq11.DERIVATION, eq13.DERIVATION),
    printed=(CONTACT_MEAN,),
    domain=UNDER_SURFACE.relations,
    where=UNDER_SURFACE.where,
    steps=contact_steps,
    exact=lambda: UNDER_SURFACE.exact,
    witnesses=UNDER_SURFACE.witnesses("force"),
    remarks=(
        "N independent contacts would have σ_f²/N. Force fluctuations are hyperuniform along a "
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
        *ASSUMED,
        "a surface load; p is the vertical force that a bead gets from both upper contacts",
        "2 ≤ N ≤ j − 2 and N ≤ M − j − 1",
    ),
    premises=(eq11.DERIVATION, eq13.DERIVATION, B7),
    printed=(BEAD_MEAN,),
    domain=OF_BEADS.relations,
    where=OF_BEADS.where,
    steps=bead_steps,
    exact=lambda: OF_BEADS.exact,
    witnesses=OF_BEADS.witnesses("bead"),
)  # fmt: skip
B12 = Derivation(
    number="B12",
    name="between_layers",
    title="Covariance of contact forces in different layers",
    symbols=(
        (COVARIANCE, "covariance of f⁺_ij and of f⁺ in layer l on the same diagonal, over ⟨f⟩²"),
        (l, "layer of the upper contact, j that of the lower one"),
        *usual(sigma, r, M, phi),
    ),
    assumptions=(*ASSUMED, _LOADED, "2 ≤ j ≤ l − 2 and l ≤ M − 2"),
    premises=(eq11.DERIVATION, eq12.DERIVATION, eq13.DERIVATION, eq14.DERIVATION),
    printed=(LAYERS,),
    domain=INSIDE,
    where=between(*INSIDE),
    steps=layer_steps,
    exact=edges,
    claims=(
        Claim(
            "the mean over all contacts of a diagonal keeps 4/5 of the mean variance, to leading "
            "order",
            _mean_of_diagonal,
        ),
    ),
    witnesses=(
        Witness(
            "exact packings of M ≤ 5: products of weights, as fractions", _layers_of_small_ones
        ),
        Witness(
            "packings to first order, M = 13 and 20, every pair of layers, modulo a prime",
            _layers_of_high_ones,
        ),
    ),
    remarks=(
        "Within a layer fluctuations cancel over neighbours (Eq. B7); along a diagonal they do "
        "not: a force that is large stays so through the whole packing. What a mean over a region "
        "leaves of them depends on its shape.",
    ),
)
B21 = Derivation(
    number="B21",
    name="neighbouring_contacts_bulk",
    title="Mean over N neighbouring contacts of one branch under a bulk load",
    symbols=_NEIGHBOURS,
    assumptions=(
        *ASSUMED,
        "every bead above the base carries the same load, whatever its radius",
        "2 ≤ N ≤ j − 1",
    ),
    premises=(eq11.DERIVATION, eq14.DERIVATION, B7),
    printed=(BULK_MEAN,),
    domain=UNDER_BULK.relations,
    where=UNDER_BULK.where,
    steps=bulk_steps,
    exact=lambda: UNDER_BULK.exact,
    witnesses=UNDER_BULK.witnesses("bulk"),
)  # fmt: skip

DERIVATIONS: dict[Number, Derivation] = {one.number: one for one in (B7, B8, B12, B21)}

if __name__ == "__main__":
    from force_diffusion.derivations.commands.alone import run_alone

    raise SystemExit(run_alone(DERIVATIONS))
