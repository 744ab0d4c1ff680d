"""Averages of the response to point loads, over loads and over beads: Eq. B22 of T7.

All loads are equal, on beads of layer l; the beads whose p is averaged are in layer j, inside of
all cones. The first bead lies p and q steps below the first load; load m and bead m are m places to
the right of these.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from itertools import product

import sympy
from force_diffusion.derivations import eq04_contact_plus as eq04
from force_diffusion.derivations import eq05_contact_minus as eq05
from force_diffusion.derivations import eq10_branched_path as eq10
from force_diffusion.derivations import eq11_total_force as eq11
from force_diffusion.derivations import eq16_response as eq16
from force_diffusion.derivations.framework.proving import Line
from force_diffusion.derivations.framework.record import FIRST_ORDER, ExactCase, Missed, usual
from force_diffusion.derivations.framework.vocabulary import (
    UNIT,
    By,
    Derivation,
    Lines,
    Where,
    asymptotic,
    equation,
    exhausting,
    formula,
    minus,
    moment,
    relations,
    rewrite,
    terms,
    times,
)
from force_diffusion.derivations.parts import cone
from force_diffusion.symbolic.kernel.where import Limit
from force_diffusion.symbolic.mechanics.paths import STEPS_BELOW
from force_diffusion.symbolic.notation import Symbol
from force_diffusion.symbolic.symbols import (
    DeltaNMinus,
    DeltaNPlus,
    Dot,
    ForceMinus,
    ForcePlus,
    N,
    Variance,
    f_load,
    i,
    j,
    l,
    m,
    n,
    n_minus,
    n_plus,
    p,
    phi,
    q,
    r,
    sigma,
)
from sympy import Eq, Integer, Rational


def _symbol(name: str, over: str, words: str) -> sympy.Symbol:
    return Symbol(
        name,
        rf"\frac{{\sigma^2(\overline{{p}}_{{\mathrm{{{over}}}}})}}{{(f^{{\mathrm{{load}}}})^{{2}}}}",
        f"σ²(mean of p over {words})/f_load²",
    )


OVER_LOADS = _symbol("mean_over_loads", "loads", "N loads")
OVER_BEADS = _symbol("mean_over_beads", "beads", "N beads")
OVER_BOTH = _symbol("mean_over_both", "both", "N loads and N beads")
OVER_PAIRS = _symbol("mean_over_pairs", "pairs", "N loads with a bead each")


def places(*relations: sympy.Basic) -> Where:
    """Places of the first bead below the first load; what is said is about the radii alone."""
    return Where.of(Eq(l, j + p + q), *relations, indices=(i,))


def pushed(load: sympy.Expr | int, bead: sympy.Expr | int) -> sympy.Expr:
    """p/f_load of a bead below a load, both by their places (Eq. 16)."""
    plus = eq10.branched_plus(i + 2 * bead, j, p + load - bead)
    minus_ = eq10.PRINTED.rhs.xreplace({n: q - load + bead}).xreplace({i: i + 2 * bead})
    return (plus + minus_) / 2


def _over_beads(load: sympy.Expr | int) -> sympy.Expr:
    """The sum of N beads below one load: the tilts at both ends of two stretches of its legs."""
    tilts = (
        (DeltaNMinus, n_plus, i + p + load, j + p + load, 1),
        (DeltaNMinus, n_plus, i + p + N + load, j + p - N + load, -1),
        (DeltaNPlus, n_minus, i - q + load + N - 1, j + q - load + N - 1, 1),
        (DeltaNPlus, n_minus, i - q + load - 1, j + q - load - 1, -1),
    )
    summed = terms(*(sign * Dot(v, delta(across, up)) for delta, v, across, up, sign in tilts))
    return times(1 / (1 - phi**2), summed) / 2


# --- N loads, N beads, or both --------------------------------------------------------------------

_SIGNS = {Eq: "=", sympy.Ge: "≥"}
_BEADS_LOW = {
    "": ("j ≥ N + 2 and N ≥ 2", 0),
    "N=j-1": ("N = j − 1 ≥ 2", -Rational(3, 2)),
    "N=j": ("N = j ≥ 2", 1),
    "N=j+1": ("N = j + 1 ≥ 3", Rational(1, 2)),
    "N>j+1": ("2 ≤ j ≤ N − 2", 0),
    "base+1, N=2": ("j = 1 and N = 2", Rational(7, 2)),
    "base+1": ("j = 1 and N ≥ 3", 3),
    "base": ("j = 0 and N ≥ 2", -2),
}
_LOADS_LOW = {
    "": ("j ≥ 3 and N ≥ 2", 0),
    "base+2": ("j = 2 and N ≥ 2", -Rational(3, 2)),
    "base+1": ("j = 1 and N ≥ 2", 4),
    "base": ("j = 0 and N ≥ 2", -3),
}


@dataclass(frozen=True, eq=False)
class Average:
    """A mean of p over loads and beads below them, with a closed form at every site inside.

    Attributes:
        name: of its exact forms.
        symbol: its variance.
        of: the mean.
        printed: that variance away from the base.
        scale: of what is added to it elsewhere, in ``UNIT``.
        share: of a bead beside a leg of the cone of a load: only 1/N of its pairs are.
        least: the smallest p and q for which all beads are inside of all cones.
        low: where it has more next to the base, in words, and how much in ``scale``.
    """

    name: str
    symbol: sympy.Symbol
    of: sympy.Expr
    printed: sympy.Eq
    scale: sympy.Expr
    share: sympy.Expr
    least: tuple[sympy.Expr, sympy.Expr]
    low: dict[str, tuple[str, sympy.Expr | int]]

    @property
    def whole(self) -> Where:
        """All sites."""
        return places(*self._inside, N >= 2, j >= 0)

    def _beside_legs(self, layer: str) -> Iterator[tuple[str, tuple[sympy.Basic, ...], sympy.Expr]]:
        """In words and relations, and what is added; the last is off all legs."""
        first, second = self.least
        at_both, at_base = (1 + phi) ** 2 * self.share**2 / 2, (1 - phi) * self.share
        more = 2 * at_base if layer == "base" else Integer(0)
        yield "beside both legs", (Eq(p, first), Eq(q, second)), at_both + more
        if layer == "base":
            yield "beside the left leg", (Eq(q, second), p >= first + 1), at_base
            yield "beside the right leg", (Eq(p, first), q >= second + 1), at_base
            yield "", (p >= first + 1, q >= second + 1), Integer(0)
        else:
            yield "", (p + q >= first + second + 1,), Integer(0)

    @property
    def _inside(self) -> tuple[sympy.Basic, ...]:
        return p >= self.least[0], q >= self.least[1]

    def forms(self) -> Iterator[tuple[str, str, tuple[sympy.Basic, ...], sympy.Expr, Where]]:
        """Layer, words and relations of the legs, value, domain: every site inside, once."""
        for layer, (words, added) in self.low.items():
            for beside, at, more in self._beside_legs(layer):
                value = self.printed.rhs
                if added + more:
                    value = terms(value, times(sympy.factor((added + more) * self.scale), UNIT))
                yield layer, beside, at, value, places(*relations(words), *at, *self._inside)

    def exact(self) -> dict[str, ExactCase]:
        """The same as users get it."""
        found: dict[str, ExactCase] = {}
        missed: list[Missed] = []
        inside = tuple(
            sympy.Ge(STEPS_BELOW[s], least) for s, least in zip((p, q), self.least, strict=True)
        )
        for layer, beside, at, value, where in self.forms():
            words = self.low[layer][0]
            if beside:
                whens = tuple(one.xreplace(STEPS_BELOW) for one in at if isinstance(one, Eq))
                place = ", ".join(f"{one.lhs} {_SIGNS[type(one)]} {one.rhs}" for one in at)
                missed.append(Missed(f"{beside}, {place}, {words}", whens, value))
                continue
            line = Line(words, equation(self.symbol, value), self.by(layer), where, self.meaning)
            found[", ".join(filter(None, (self.name, layer)))] = ExactCase(
                self.symbol, words, value, (*relations(words), *inside), tuple(missed), line=line
            )
            missed = []
        return found

    def by(self, layer: str = "") -> By:
        """How a form is proved: by the distances from the legs of cones, further ones low down."""
        tiers = 4 if layer.startswith("base+") else 2
        near = (
            (*((Eq(s, low + step),) for step in range(tiers)), (s >= low + tiers,))
            for s, low in zip((p, q), self.least, strict=True)
        )
        return moment(eq11.DIRECTIONS, cases=[(*a, *b) for a, b in product(*near)])

    @property
    def meaning(self) -> dict[sympy.Symbol, sympy.Expr]:
        """What the symbol stands for."""
        return {self.symbol: Variance(self.of)}


_EACH = sympy.Sum(pushed(m, 0), (m, 0, N - 1))


def printed(symbol: sympy.Symbol, prefactor: sympy.Expr, change: str) -> sympy.Eq:
    """``change`` (σ/r)², over ``prefactor`` (1 − φ²)²."""
    unit = 1 / times(prefactor, (1 - phi**2) ** 2)
    return equation(symbol, times(unit, formula(change), formula("(σ_δr/r)²")))


PRINTED = (
    printed(OVER_LOADS, 4 * N, "6N(l + j) − 2N² − 3N − 1 + φ²"),
    printed(OVER_BEADS, 2 * N**2, "2(l + j) − 2 + φ²"),
    printed(OVER_BOTH, 6 * N**3, "6N(l + j) − 2N² − 3N − 1 + 3φ²"),
)
OF_A_SUM = 1 / (4 * N**2)
LOADS = Average(
    "loads", OVER_LOADS, _EACH / N, PRINTED[0],
    Rational(1, 4), 1 / N, (Integer(1), N), _LOADS_LOW,
)  # fmt: skip
BEADS = Average(
    "beads", OVER_BEADS, _over_beads(0) / N, PRINTED[1],
    OF_A_SUM, Integer(1), (N, Integer(1)), _BEADS_LOW,
)  # fmt: skip
BOTH = Average(
    "both", OVER_BOTH, sympy.Sum(_over_beads(m), (m, 0, N - 1)) / N**2, PRINTED[2],
    OF_A_SUM, 1 / N, (N, N), _BEADS_LOW,
)  # fmt: skip
BLOCKS = (LOADS, BEADS, BOTH)
MEANING = {symbol: of for one in BLOCKS for symbol, of in one.meaning.items()}
WHERE = places(*relations("p ≥ N, q ≥ N, p + q ≥ 2N + 1, j ≥ N + 2"), N >= 2)
"""Where all three hold."""

_FIXED = "l → ∞ at fixed j/l, (i − k)/l and N/l, all beads inside of all cones"
NEAR, FAR = (
    places(*relations(f"p ≥ N + 1, q ≥ N + 1, {words}"), N >= 3).in_the_limit(
        Limit("∼", _FIXED, (j, p, q, N), (p - N, q - N, *positive))
    )
    for words, positive in (("j ≥ N + 3", (j - N, N)), ("3 ≤ j ≤ N − 3", (j, N - j)))
)
LEADING = tuple(map(formula, ("3(l + j)/2 − N/2", "(l + j)/N²", "(l + j)/N² − 1/(3N)")))
"""In ``UNIT``, by the average; N/l may be small."""


@cache
def steps() -> Lines:
    """Where paths turn; what telescopes; squares."""
    lines = Lines(WHERE, rewrite(), MEANING)
    turned = lines.show(
        "By Eq. 10 the force that bead b takes from load a turns at one bead of each leg of the "
        "cone of that load, p + a − b steps up n⁺ and q − a + b up n⁻. From load to load the bead "
        "where it turns moves along the contact's own diagonal; so the same radii enter again:",
        equation(
            pushed(m, 0),
            times(
                1 / (2 * (1 - phi**2)),
                terms(
                    Dot(n_plus, DeltaNMinus(i + p + m, j + p + m)),
                    minus(Dot(n_plus, DeltaNMinus(i + p + m + 1, j + p + m - 1))),
                    Dot(n_minus, DeltaNPlus(i - q + m, j + q - m)),
                    minus(Dot(n_minus, DeltaNPlus(i - q + m - 1, j + q - m - 1))),
                ),
            ),
        ),
        rewrite(),
        where=places(p >= 1, q >= m + 1, m >= 0, j >= 0),
        after=(eq10.DERIVATION,),
    )
    lines.show(
        "Averaged over N loads, for 1 ≤ p, N ≤ q and j ≥ 3:",
        PRINTED[0],
        LOADS.by(),
        where=places(*relations("p ≥ 1, q ≥ N, p + q ≥ N + 2, j ≥ 3"), N >= 2),
        after=(turned, eq16.DERIVATION),
    )
    summed = lines.show(
        "From bead to bead it moves along the leg, and the sum over N beads telescopes. What is "
        "left are the tilts of the contacts at the ends of these stretches of both legs:",
        equation(sympy.Sum(pushed(0, m), (m, 0, N - 1)), _over_beads(0)),
        rewrite(),
        where=BEADS.whole,
        after=(turned,),
    )
    beads = lines.show("Averaged over N beads:", PRINTED[1], BEADS.by(), after=(summed,))
    lines.show("Over N loads and N beads:", PRINTED[2], BOTH.by(), after=(summed, beads))
    lines.claim(
        "inside of the cone of every load f⁺ and f⁻ are those of Eq. 10, so that p is their sum",
        sympy.Tuple(
            equation(ForcePlus(i, j) / cone.ORDERED, cone.UPPER_RIGHT),
            equation(ForceMinus(i, j) / cone.ORDERED, cone.UPPER_LEFT),
            equation(terms(cone.UPPER_RIGHT / 2, cone.UPPER_LEFT / 2), pushed(0, 0)),
        ),
        rewrite(cone.FORCES),
        where=cone.INSIDE,
    )
    for one, words in zip(BLOCKS, ("N loads", "N beads", "both"), strict=True):
        forms = [*one.forms()]
        domains = [where for *_, where in forms]
        lines.claim_each(
            f"the exact variance over {words}, at every site inside",
            ((one.symbol, value, where) for *_, value, where in forms),
            tuple(exhausting(one.whole, domains, one.by(layer)) for layer, *_ in forms),
        )
    lines.claim_each(
        "to leading order, in units of (σ/r)²/(1−φ²)²: 3(l+j)/2 − N/2 over loads, (l+j)/N² over "
        "beads, (l+j)/N² − 1/(3N) over both; N loads take off a third of it at most",
        (
            (one.symbol, times(goes, UNIT), where)
            for one, goes in zip(BLOCKS, LEADING, strict=True)
            for where in (NEAR, FAR)
        ),
        asymptotic(eq11.DIRECTIONS),
    )
    return lines


OF_LOADS = (
    (f_load, "each of the loads, downwards"),
    (l, "layer of the loaded beads, j that of the beads whose p is averaged"),
    (p, "steps along n⁺ from the first load down to the first bead (p is no force there)"),
    (q, "steps along n⁻"),
    *usual(sigma, r, phi),
)
PREMISES = tuple(one.DERIVATION for one in (eq04, eq05, eq10, eq11, eq16))
PUSH = "p is the vertical force on a bead, from both upper contacts, which one load makes"

B22 = Derivation(
    number="B22",
    name="averaged_response",
    title="Response averaged over N loads, over N beads, and over both",
    symbols=(
        (OVER_LOADS, "variance of p of one bead, averaged over N neighbouring loads"),
        (OVER_BEADS, "the same below one load, averaged over N neighbouring beads"),
        (OVER_BOTH, "the same averaged over N loads and N beads, N² pairs"),
        (N, "number of neighbouring loads, or beads, or both"),
        *OF_LOADS,
    ),
    assumptions=(
        *FIRST_ORDER,
        PUSH,
        "every bead is inside of the cone of every load",
        "printed forms: N ≥ 2, j ≥ N + 2, p, q ≥ N and p + q > 2N; exact forms: every site inside",
    ),
    premises=PREMISES,
    printed=PRINTED,
    domain=(N >= 2, sympy.Ge(j, N + 2), sympy.Ge(l, j + 2 * N + 1)),
    where=WHERE,
    exact=lambda: {name: form for one in BLOCKS for name, form in one.exact().items()},
    steps=steps,
    remarks=(
        "Averaging over loads reduces the noise by a third at most, since one bead hears all of "
        "them through the same radii; averaging over beads reduces σ(p) as 1/N.",
        "The plateau of Eq. B9 in p, (5φ − 1)(σ/r)²/(1−φ²)² f_load, is as large as the noise of N "
        "beads for N = (r/σ) (1−φ²) √(l + j)/|5φ − 1|. A row inside of one cone has less than "
        "l − j beads: it shows in packings of more than (r/σ)²(1−φ²)²/(5φ − 1)² layers, and these "
        "are far higher than M*, below which contacts begin to pull.",
    ),
)
