"""Attacks on ``cases``, ``instance``, ``in_terms_of`` and ``mirror``."""

from dataclasses import replace

import sympy
from force_diffusion.symbolic.as_printed import equation
from force_diffusion.symbolic.kernel import axioms, rules
from force_diffusion.symbolic.kernel.rules import Rule
from force_diffusion.symbolic.kernel.theorem import Supposition, Theorem
from force_diffusion.symbolic.kernel.where import (
    BULK_TILTED,
    ENTERING,
    SURFACE,
    SURFACE_TILTED,
    Where,
)
from force_diffusion.symbolic.symbols import (
    DeltaR,
    DeltaX,
    Dot,
    ForceMinus,
    ForcePlus,
    L_plus,
    Load,
    M,
    MatrixTimes,
    e_x,
    e_y,
    i,
    j,
    k,
    l,
    n,
    n_minus,
    n_plus,
    p,
    phi,
    q,
    site_r,
    site_s,
    t,
)
from sympy import Eq, Integer, Sum

from .attack import (
    ABOVE,
    AT_LOAD,
    BEADS,
    BELOW,
    COUNTED,
    HERE,
    IN_TWO,
    ON_LOADED,
    ON_SURFACE,
    ONE,
    another,
    attack,
    told,
)

# cases


def _in_cases(formula: sympy.Eq, where: Where, *parts: sympy.Basic, rule: Rule) -> Theorem:
    return rules.cases(rule, *((one,) for one in parts))(formula, where)


NO_LOAD = equation(Load(i, j), 0)
WITH_TOP = Where.of(j >= 0, j <= M, loading=SURFACE)

for name, parts, false in (
    ("the top is left out", (j <= M - 1,), "the surface is loaded"),
    ("one layer is left out", (j <= M - 1, j >= M + 1), "the surface is loaded"),
    ("no case", (), "the surface is loaded"),
):
    attack("cases", name, false, "leave something")(
        lambda c=parts: _in_cases(NO_LOAD, WITH_TOP, *c, rule=rules.rewrite(ON_SURFACE))  # type: ignore[misc]
    )
attack("cases", "of nothing", "all holds there", "nothing is in its domain")(
    lambda: _in_cases(NO_LOAD, BELOW.also(j <= -1), j >= 0, rule=rules.rewrite())
)
attack("cases", "one case is not proved", "the surface is loaded", "normal forms")(
    lambda: _in_cases(NO_LOAD, WITH_TOP, j <= M - 1, Eq(j, M), rule=rules.rewrite(ON_SURFACE))
)
attack("cases", "of an index of sums", "n is bound", "does not say what n is")(
    lambda: _in_cases(
        equation(IN_TWO, 0),
        Where.of(Eq(j, M - 1), j >= 0, loading=SURFACE),
        n <= M - 1,
        n >= M,
        rule=rules.rewrite(ON_SURFACE),
    )
)


def fewer(formula: sympy.Eq, where: Where) -> Theorem:
    """A rule that proves it on another domain."""
    return rules.walk({i: k}, {i: i - 1}, q)(formula, where)


PLACE = equation(i, k - q)

attack("cases", "by a rule that proves another statement", "it is none of i", "another statement")(
    lambda: _in_cases(equation(DeltaX(i, j), 0), BEADS, j >= 0, rule=another)
)
attack("cases", "by a rule that adds to the domain", "i is any place", "another statement")(
    lambda: _in_cases(PLACE, COUNTED, q >= 0, rule=fewer)
)


# instance


for name, theorem, places, where, false, refused in (
    ("out of its domain", axioms.contact(1), {j: Integer(0)}, Where((i,), even=(i,)),
     "beads of the base touch none below", "does not hold there"),
    ("off the lattice", axioms.contact(1), {i: i + 1}, Where.of(j >= 1), "no bead is there",
     "does not hold there"),
    ("where it has no value", told(rules.rewrite(), p, p, Where((p,))), {p: 1 / phi}, Where(),
     "φ may be 0", "not shown to differ"),
    ("what is no index", axioms.contact(1), {phi: ONE}, Where.of(j >= 1), "φ is below ½",
     "does not hold there"),
    ("an index that is summed over", told(rules.rewrite(), Sum(i, (n, 1, 2)), Sum(i, (n, 0, 1)),
     Where((i,))), {i: n}, Where((i,)), "1 + 2 is not 0 + 1", "none of the domain"),
    ("under another loading", ON_SURFACE[0], {}, Where.of(site_s >= 0, site_s <= M - 1),
     "it may be loaded", "does not hold there"),
    ("with another load's place", ON_LOADED[0], {k: k + 1, l: l + 1}, AT_LOAD,
     "that bead has forces above it", "does not hold there"),
):  # fmt: skip
    attack("instance", name, false, refused)(
        lambda t=theorem, to=places, w=where: rules.instance(t, to, w)  # type: ignore[misc]
    )


@attack("instance", "where a ratio of forces that vanish becomes 1", "1 is not 17", "is lost")
def _() -> object:
    where = Where.of(l <= M, l >= M, j <= M, j >= M, l >= 0, loading=SURFACE)
    plus = told(rules.rewrite(ON_SURFACE), ForcePlus(k, l), 17 * ForcePlus(i, j), where)
    ratio = told(rules.follows(plus), ForcePlus(k, l) / ForcePlus(i, j), 17, where)
    return rules.instance(ratio, {k: i, l: j}, Where.of(Eq(j, M), j >= 0, loading=SURFACE))


# in terms of other indices


def _in_terms(
    image: dict[sympy.Symbol, sympy.Expr],
    back: dict[sympy.Symbol, sympy.Expr],
    other: Where,
    where: Where,
    formula: sympy.Eq = NO_LOAD,
    rule: Rule | None = None,
) -> Theorem:
    rule = rule or rules.rewrite(ON_SURFACE)
    return rules.in_terms_of(image, back, other, rule)(formula, where)


BY_DEPTH = {j: M - q}

for name, image, back, other, where, false, refused in (
    ("that leave the top out", BY_DEPTH, {q: M - j}, BELOW.put_in(BY_DEPTH, (i, q, M)), WITH_TOP,
     "it is loaded", "do not reach"),
    ("that are not those of the statement", {j: j - 1}, {j: j}, BELOW, BELOW,
     "j − 1 does not reach M − 1", "do not reach"),
    ("without saying what becomes of one", {}, {j: j - 2}, BELOW, WITH_TOP, "it is loaded",
     "do not reach"),
    ("another loading", {}, {}, BELOW, BELOW.loaded(None), "it may be loaded", "packings differ"),
    ("another load's place", {M: M - 1}, {M: M + 1}, BELOW, WITH_TOP,
     "surfaces at M and M + 1 differ", "packings differ"),
    ("an empty domain", {}, {}, BELOW, BELOW.also(j <= -1), "all holds there", "nothing is in"),
    ("another dimension", {}, {}, BELOW, replace(BELOW, dimension=3), "these are disks",
     "packings differ"),
    ("what is no index", {phi: ONE}, {}, BELOW, BELOW, "φ is below ½", "no index of the domain"),
    ("beads where there are none", {}, {}, replace(BELOW, even=(i + j + 1,)), BELOW,
     "beads are where i + j is even", "do not reach"),
):  # fmt: skip
    attack("in_terms_of", name, false, refused)(
        lambda to=image, b=back, o=other, w=where: _in_terms(to, b, o, w)  # type: ignore[misc]
    )
attack("in_terms_of", "by a rule that proves another statement", "beads move", "another statement")(
    lambda: _in_terms({}, {}, BEADS, BEADS, equation(DeltaX(i, j), 0), another)
)


# mirror

for name, left, right, where, false in (
    ("an index across the packing", i * HERE, DeltaR(i, j) * i, BEADS, "i becomes −i"),
    ("a sum up to it", Sum(HERE, (n, 1, i)), i * HERE, Where.of(j >= 0, i >= 0), "i becomes −i"),
    ("a matrix", MatrixTimes(0, 1, 0, 0, DeltaX(i, j)), Dot(e_y, DeltaX(i, j)) * e_x, BEADS,
     "its entries change their signs"),
):  # fmt: skip
    attack("mirror", name, false, "beside its places")(
        lambda a=left, b=right, w=where: rules.mirror(told(rules.rewrite(), a, b, w))  # type: ignore[misc]
    )


@attack("mirror", "the domain as it was", "f⁻ is none of it", "on all of its domain")
def _() -> object:
    where = Where.of(j >= 0, j <= k - i, indices=(k, l))
    mirrored = rules.mirror(told(rules.rewrite(), ForcePlus(i, j), ForcePlus(i, j) + 0, where))
    other = told(rules.rewrite(), HERE, HERE, where)
    return mirrored, told(rules.follows(rules.mirror(other)), HERE, ABOVE, where)


@attack("mirror", "a load from one side", "f⁺ enters, f⁻ does not", "on all of its domain")
def _() -> object:
    where = Where.of(Eq(site_s, l - 1), site_s >= 0, loading=ENTERING)
    beside = next(one for one in axioms.loads(ENTERING) if one.formula.lhs.func is ForceMinus)
    return told(rules.follows(rules.mirror(beside)), ForcePlus(site_r, site_s), 0, where)


@attack("mirror", "a load that is not vertical", "t belongs to n⁻", "on all of its domain")
def _() -> object:
    where = Where.of(Eq(j, M), j >= 0, loading=SURFACE_TILTED)
    carried = -L_plus * (n_plus + t * n_minus)
    tilted = told(rules.rewrite(axioms.loads(SURFACE_TILTED)), Load(i, j), carried, where)
    exchanged = carried.xreplace({n_plus: n_minus, n_minus: n_plus})
    return told(rules.follows(rules.mirror(tilted)), Load(i, j), exchanged, where)


@attack("rewrite", "the load of every bead, where the surface alone is loaded", "it has none below",
        "normal forms")  # fmt: skip
def _() -> object:
    where = Where.of(j >= 0, j <= M - 1, loading=SURFACE_TILTED)
    carried = -L_plus * (n_plus + t * n_minus)
    return told(rules.rewrite(axioms.loads(BULK_TILTED)), Load(i, j), carried, where)


@attack("mirror", "what is supposed of one place", "it is not supposed of −i", "one place across")
def _() -> object:
    return rules.mirror(rules.suppose(equation(HERE, 0), BEADS, Supposition(i), 2))
