"""T9: the response to a point load in three dimensions, Eq. B19: what is zero, and all variances.

A face of the cone below the loaded bead O holds the beads p steps along one vector and q along
another below it, p, q ≥ 1, in layer j = l − p − q; a leg has q = 0.
"""

from functools import cache

import sympy
from force_diffusion.derivations import eq16_response as eq16
from force_diffusion.derivations.beyond import t8_any_dimension as t8
from force_diffusion.derivations.framework.record import FIRST_ORDER, ExactCase, Piece, usual
from force_diffusion.derivations.framework.vocabulary import (
    Derivation,
    Lines,
    Where,
    equation,
    formula,
    minus,
    moment,
    rewrite,
    terms,
    times,
)
from force_diffusion.derivations.parts import cone
from force_diffusion.symbolic.kernel.any_dimension import POINT
from force_diffusion.symbolic.notation import Symbol
from force_diffusion.symbolic.symbols import (
    ForceBelow,
    Mean,
    PushBelow,
    Variance,
    d,
    f_load,
    j,
    l,
    p,
    phi,
    q,
    r,
    sigma,
)
from sympy import Integer, Rational

_OVER_LOAD = r"{(f^{\mathrm{load}})^{2}}"
ON_FACE = Symbol(
    "face_response",
    rf"\frac{{\sigma_{{\mathrm{{face}}}}^{{2}}(n_{{z}} f)}}{_OVER_LOAD}",
    "σ²(n_z f on a face)/f_load²",
)
BEAD = Symbol(
    "face_bead_response",
    rf"\frac{{\sigma_{{\mathrm{{face}}}}^{{2}}(p)}}{_OVER_LOAD}",
    "σ²(p on a face)/f_load²",
)
ON_LEG = eq16.ON_LEG
LEG_MAGNITUDE = eq16.LEG_MAGNITUDE

UNIT = t8.IN_THREE
SHARE = 1 + 2 * phi + 2 * phi**2
_FACE = formula("[(1 + 2φ + 2φ²)(12(j + q) − 9) + 3 + φ²]/2")
_BEAD = formula("(1 + 2φ + 2φ²)(6(l + j) − 9) + 3 + φ²")
_BELOW = formula("2φ²j + 1/2 + 3φ + 7φ²")
_LEG = formula("(6 + 12φ + 10φ²)l + 4j − 4(1 + φ − φ²)")
_LEG_FORCE = formula("(6 + 12φ + 10φ²)l + 4φ²j − 5 − 12φ + 3φ² + 8φ³ + 2φ⁴")


# The first that fits holds; ``further`` says where none before it does.
_BESIDE_LEG = _BEAD + formula("−2 − 7φ/2 − φ²/2")
CONTACT_PIECES = (
    Piece("j = 0, one step from the leg", {j: 0, q: 1}, formula("7/2 + 4φ + 5φ²")),
    Piece("every other contact of a face", {}, _FACE, (j + q >= 2,)),
)
BEAD_PIECES = (
    Piece("j = 0, l = 2", {j: 0, p: 1, q: 1}, _BEAD + formula("−1/2 + 2φ + 9φ²")),
    Piece("j = 0, beside a leg (p = 1)", {j: 0, p: 1}, _BESIDE_LEG, (q >= 2,)),
    Piece("j = 0, beside a leg (q = 1)", {j: 0, q: 1}, _BESIDE_LEG, (p >= 2,)),
    Piece("j = 0, further inside", {j: 0}, _BEAD - 3 * (1 + phi) ** 2, (p >= 2, q >= 2)),
    Piece("j = 1, l = 3", {j: 1, p: 1, q: 1}, _BEAD + _BELOW + 4 * (1 + phi) ** 2),
    Piece("j = 1, l > 3", {j: 1}, _BEAD + 4 * (1 + phi) ** 2, (p + q >= 3,)),
    Piece("j = 2, l = 4", {j: 2, p: 1, q: 1}, _BEAD + _BELOW - formula("3(1 + φ)²/2")),
    Piece("j = 2, l > 4", {j: 2}, _BEAD - formula("3(1 + φ)²/2"), (p + q >= 3,)),
    Piece("j = l − 2 ≥ 3", {p: 1, q: 1}, _BEAD + _BELOW, (j >= 3,)),
    Piece("j ≥ 3, every other bead of a face", {}, _BEAD, (j >= 3, p + q >= 3)),
)
LEG_PIECES = (
    Piece("j = 0, l = 1", {j: 0, p: 1}, formula("3(1 + 4φ + 4φ²)/2")),
    Piece("j = 0, l = 2", {j: 0, p: 2}, _LEG - formula("(5 + 14φ + 7φ²)/2")),
    Piece("j = 0, l > 2", {j: 0}, _LEG - formula("(5 + 14φ + 4φ²)/2"), (p >= 3,)),
    Piece("j = 1, l = 2", {j: 1, p: 1}, _LEG + formula("3 + 10φ − 15φ²/2")),
    Piece("j = 1, l > 2", {j: 1}, _LEG + formula("3(1 + φ)"), (p >= 2,)),
    Piece("j = l − 1 ≥ 2", {p: 1}, _LEG + formula("4φj + 3φ(1 − 2φ)"), (j >= 2,)),
    Piece("2 ≤ j ≤ l − 2, on a leg", {}, _LEG, (j >= 2, p >= 2)),
)
LEG_FORCE_PIECES = (
    Piece("j = 0, l = 1", {j: 0, p: 1}, formula("2 − 2φ + 27φ²/2 − 2φ³ + 2φ⁴")),
    Piece("j = 0, l = 2", {j: 0, p: 2}, _LEG_FORCE - formula("φ(3 + 6φ + 4φ²)")),
    Piece("j = 0, l > 2", {j: 0}, _LEG_FORCE - formula("φ(6 + 9φ + 8φ²)/2"), (p >= 3,)),
    Piece("j = 1, l = 2", {j: 1, p: 1}, _LEG_FORCE + formula("φ(6 + 17φ − 12φ²)/2")),
    Piece("j = 1, l > 2", {j: 1}, _LEG_FORCE + formula("3φ(1 + φ)"), (p >= 2,)),
    Piece("j = l − 1 ≥ 2", {p: 1}, _LEG_FORCE + formula("φ²(4j + 3 − 6φ)"), (j >= 2,)),
    Piece("2 ≤ j ≤ l − 2, on a leg", {}, _LEG_FORCE, (j >= 2, p >= 2)),
)


def _printed(symbol: sympy.Symbol, share: str, number: int) -> sympy.Eq:
    unit = 1 / ((1 - phi) ** 2 * (1 + 2 * phi) ** 2) / number
    return equation(symbol, times(unit, formula(share), formula("(σ_δr/r)²")))


PRINTED = (
    _printed(ON_FACE, "(1 + 2φ + 2φ²)[12(j + q) − 9] + 3 + φ²", 18),
    _printed(BEAD, "(1 + 2φ + 2φ²)[6(l + j) − 9] + 3 + φ²", 9),
    _printed(ON_LEG, "2(3 + 6φ + 5φ²)l + 4j − 4(1 + φ − φ²)", 9),
)

ONE, TWO, NONE = Integer(1), Integer(2), Integer(0)
ALONG_FACE, ALONG_LEG = l - j - q, l - j
"""The steps p down the first vector."""


def _below(*relations: sympy.Basic) -> Where:
    """Sites below the load."""
    return Where((j, l, q), relations, POINT, dimension=3)


INSIDE = (j >= 0, q >= 1, l >= j + q + 1)
"""The sites of a face."""
DOWN = (j >= 0, l >= j + 1)
"""Those of a leg."""


_CONTACT = PushBelow(TWO, ALONG_FACE, q, NONE)
_BESIDE = PushBelow(ONE, ALONG_FACE, q, NONE)
_UP_LEG = (ONE, ALONG_LEG, NONE, NONE)
_ON_FACE = (_below(*INSIDE), {p: ALONG_FACE, q: q})
_ON_LEG = (_below(*DOWN), {p: ALONG_LEG})


def _variance(
    symbol: sympy.Symbol,
    force: sympy.Expr,
    pieces: tuple[Piece, ...],
    unit: sympy.Expr,
    sites: tuple[Where, dict[sympy.Symbol, sympy.Expr]],
) -> cone.Below:
    where, steps = sites
    return cone.Below(symbol, Variance(force), where, pieces, unit, steps)


QUANTITIES = {
    "contact": _variance(ON_FACE, _CONTACT / 3, CONTACT_PIECES, UNIT / 9, _ON_FACE),
    "bead": _variance(BEAD, (_CONTACT + _BESIDE) / 3, BEAD_PIECES, UNIT / 9, _ON_FACE),
    "leg": _variance(ON_LEG, PushBelow(*_UP_LEG) / 3, LEG_PIECES, UNIT / 9, _ON_LEG),
    "leg-force": _variance(LEG_MAGNITUDE, ForceBelow(*_UP_LEG), LEG_FORCE_PIECES, UNIT, _ON_LEG),
}
"""By the names of their exact forms; the vertical force of a contact is a third of the load on a
leg."""

MEANING = {one.symbol: one.of for one in QUANTITIES.values()}
WHERE = _below(j >= 3, q >= 1, l >= j + q + 1, l >= j + 3)
"""Where all that is printed holds."""


def at_finite_size() -> dict[str, ExactCase]:
    """The exact forms of a face's beads and contacts, and of a leg's."""
    return {name: one.exact() for name, one in QUANTITIES.items()}


TILTS = tuple(
    Symbol(f"nu_{b}{place}", rf"\nu_{{{b}}}^{{{raised}}}", f"ν_{b}{prime}", real=True)
    for b in (2, 3)
    for place, raised, prime in (("", "", ""), ("_below", r"\prime", "′"))
)
TURNED = Symbol("turned", r"g_{12}", "g₁₂", real=True)
_GEOMETRY = Where((l,), dimension=3)


@cache
def steps() -> Lines:
    """Where a force turns; what turns; squares."""
    nu_2, below_2, nu_3, below_3 = TILTS
    gram = sympy.Matrix(3, 3, lambda a, b: 1 if a == b else phi)
    tilts = sympy.Matrix([0, nu_2 - below_2, nu_3 - below_3])
    lines = Lines(WHERE, moment(), MEANING)
    turned = lines.show(
        "The ordered load goes straight down the three legs, as the same force f in each contact. "
        "To first order what enters a bead from above along e_a leaves it along e_a, plus "
        "b^a·Σ_c(f^c δn^c − f^c δn^c below). So a force turns only on a leg. From leg 1 into 2 it "
        "is, over f, with ν_b = n^b·δn^1 of the leg's contact above the bead and ν′_b below it:",
        equation(
            TURNED,
            times(
                1 / ((1 - phi) * (1 + 2 * phi)),
                terms(
                    times(terms(1, phi), terms(nu_2, -below_2)),
                    minus(times(phi, terms(nu_3, -below_3))),
                ),
            ),
        ),
        rewrite(),
        where=_GEOMETRY,
        meaning={TURNED: (gram.inv() * tilts)[1]},
        after=(t8.ANY_SURFACE,),
    )
    nothing = lines.show(
        "It runs down a line of the face between both legs, and turns no more. A contact off legs "
        "and faces hangs below a contact that enters a face, or the cone, from outside, where "
        "there is nothing: it carries no force, in no packing. Nor does one of a face on average:",
        sympy.Tuple(
            equation(Variance(ForceBelow(Integer(3), ALONG_FACE, q, NONE)), NONE),
            equation(Variance(ForceBelow(ONE, ALONG_FACE - 1, q, ONE)), NONE),
            equation(Mean(ForceBelow(TWO, ALONG_FACE, q, NONE)), NONE),
        ),
        where=(_below(*INSIDE), _below(j >= 0, q >= 1, l >= j + q + 2), _below(*INSIDE)),
        after=(turned,),
    )

    lines.show(
        "Both ν are differences of line sums down 2 and down 3, in the planes of these and of the "
        "leg, and of radii of the leg. In the face the bead p steps along 1 and q along 2 below "
        "the load is in layer j = l − p − q. Squared and summed, and with the share ⅓ of the "
        "vertical, one contact of a face has, but for j = 0 and q = 1,",
        PRINTED[0],
        where=_below(*INSIDE, j + q >= 2),
        after=(turned, nothing),
    )
    lines.show(
        "The vertical force of both contacts of the face on a bead: where lines of both cross, the "
        "products of their weights add up to zero, for j ≥ 3 and p + q ≥ 3. The layers j + q and "
        "j + p, where they turn, add up to l + j:",
        PRINTED[1],
        after=(turned, nothing),
    )
    inside = _below(j >= 2, l >= j + 2)
    lines.show(
        "On a leg the sum telescopes: what is left is the split at the loaded bead and the tilt of "
        "the contact itself. Its vertical component, for 2 ≤ j ≤ l − 2:",
        PRINTED[2],
        where=inside,
        after=(turned, nothing),
    )
    lines.show(
        "The magnitude of that force, over its mean squared:",
        equation(LEG_MAGNITUDE, _LEG_FORCE * UNIT),
        where=inside,
        after=(turned,),
    )
    for name, words in (
        ("contact", "the exact variance of every contact of a face"),
        ("bead", "the exact variance of p at every bead of a face; for j ≥ 3 it depends on l + j "
         "alone, but for p = q = 1"),
        ("leg", "the exact variance on a leg, vertical"),
        ("leg-force", "and of the magnitude there"),
    ):  # fmt: skip
        lines.claim_each(words, QUANTITIES[name].forms())
    of_three, of_two = (
        (t8.KAPPA**2 + (d - 2) * t8.CROSSED**2).xreplace({d: Integer(n)}) for n in (3, 2)
    )
    lines.claim(
        "κ² + κ′² takes the place of κ² = 1/(1−φ²)² of discs, ⅓ that of ½",
        sympy.Tuple(
            equation(of_three, SHARE / ((1 - phi) ** 2 * (1 + 2 * phi) ** 2)),
            equation(of_two * Rational(3, 2) * (l + j) * (sigma / r) ** 2, eq16.PRINTED.rhs.doit()),
        ),
        rewrite(),
        where=(_GEOMETRY, Where((j, l))),
    )
    return lines


DERIVATION = Derivation(
    number="B19",
    name="spheres_response",
    title="Response to a point load in three dimensions",
    symbols=(
        (ON_FACE, "variance of the vertical force of one contact in a face of the cone"),
        (BEAD, "the same of both contacts above a bead of a face together"),
        (ON_LEG, "the same of the contact on a leg of the cone"),
        (LEG_MAGNITUDE, "variance of its magnitude over the squared mean"),
        (f_load, "the load on one bead, downwards"),
        (l, "layer of the loaded bead, j that of the bead below the contact"),
        (q, "steps along that contact's own vector, from the leg where its path turns"),
        (p, "steps down the leg (p is no force there)"),
        *usual(sigma, r),
        (phi, "mutual dot product of the three base vectors, −1/3 < φ < ½"),
    ),
    assumptions=(
        "every bead rests on three others, along base vectors with one mutual dot product φ",
        *FIRST_ORDER,
        "printed forms: p, q ≥ 1 and j + q ≥ 2; p, q ≥ 1, j ≥ 3 and l ≥ j + 3; 2 ≤ j ≤ l − 2. "
        "Exact forms: every site",
    ),
    premises=(eq16.DERIVATION, t8.ANY_SURFACE),
    printed=PRINTED,
    domain=WHERE.relations,
    where=WHERE,
    dimension=3,
    exact=at_finite_size,
    steps=steps,
    remarks=(
        "Inside of the cone, off its three legs and three faces, no force is of first order: not "
        "on average, but in every packing. For discs the two legs enclose one face, and this face "
        "is all of the inside.",
    ),
)

if __name__ == "__main__":
    from force_diffusion.derivations.commands.alone import run_alone

    raise SystemExit(run_alone(DERIVATION))
