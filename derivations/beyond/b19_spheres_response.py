"""Eq. B19: the response to a point load in three dimensions: what is zero, and all variances."""

from collections.abc import Callable, Iterator
from fractions import Fraction
from functools import cache
from itertools import product

import sympy
from force_diffusion.derivations import eq16_response as eq16
from force_diffusion.derivations.beyond import b11_any_dimension as b11
from force_diffusion.derivations.beyond import pyramid
from force_diffusion.derivations.beyond.pyramid import Weights, down, up
from force_diffusion.derivations.beyond.spheres import UNIT
from force_diffusion.derivations.framework.follows import Decide, identity
from force_diffusion.derivations.framework.record import (
    Claim,
    Derivation,
    ExactCase,
    Missed,
    Step,
    Witness,
    usual,
)
from force_diffusion.derivations.witnesses import dimensions as witnesses
from force_diffusion.derivations.witnesses.draws import SmallPacking
from force_diffusion.derivations.witnesses.squared_weights import compare
from force_diffusion.symbolic.algebra import affine, explicit
from force_diffusion.symbolic.algebra.affine import Affine, Region
from force_diffusion.symbolic.algebra.exact import FIELD
from force_diffusion.symbolic.as_printed import equation, minus, power, terms, times
from force_diffusion.symbolic.kernel.decisions import (
    Ruling,
    all_of,
    decide_identity,
    from_test,
    undecided,
)
from force_diffusion.symbolic.notation import Symbol
from force_diffusion.symbolic.symbols import d, f_load, j, l, p, phi, q, r, sigma
from force_diffusion.symbolic.variances.cases import Case, Piece, first_difference
from sympy import Rational

ON_FACE = Symbol(
    "face_response",
    r"\frac{\sigma_{\mathrm{face}}^{2}(n_{z} f)}{(f^{\mathrm{load}})^{2}}",
    "σ²(n_z f on a face)/f_load²",
)
BEAD = Symbol(
    "face_bead_response",
    r"\frac{\sigma_{\mathrm{face}}^{2}(p)}{(f^{\mathrm{load}})^{2}}",
    "σ²(p on a face)/f_load²",
)
ON_LEG = Symbol(
    "leg_response",
    r"\frac{\sigma_{\mathrm{leg}}^{2}(p)}{(f^{\mathrm{load}})^{2}}",
    "σ²(p on a leg)/f_load²",
)
LEG_MAGNITUDE = Symbol(
    "leg_force",
    r"\frac{\sigma_{\mathrm{leg}}^{2}(f)}{\langle f\rangle^{2}}",
    "σ²(f on a leg)/⟨f⟩²",
)

# The closed forms, all proved below. A face of the cone holds the beads p steps along one vector
# and q along another below the loaded bead, p, q ≥ 1, in layer j = l − p − q; a leg has q = 0.
SHARE = 1 + 2 * phi + 2 * phi**2
_HALF = Rational(1, 2)
_FACE = (SHARE * (12 * (j + q) - 9) + 3 + phi**2) / 2
_BEAD = SHARE * (6 * (l + j) - 9) + 3 + phi**2
_BELOW = 2 * phi**2 * j + _HALF + 3 * phi + 7 * phi**2
_LEG = (6 + 12 * phi + 10 * phi**2) * l + 4 * j - 4 * (1 + phi - phi**2)
_LEG_FORCE = (
    (6 + 12 * phi + 10 * phi**2) * l
    + 4 * phi**2 * j
    - 5 - 12 * phi + 3 * phi**2 + 8 * phi**3 + 2 * phi**4
)  # fmt: skip

CONTACT_PIECES = (
    Piece("j = 0, one step from the leg", {j: 0, q: 1}, Rational(7, 2) + 4 * phi + 5 * phi**2),
    Piece("every other contact of a face", {}, _FACE),
)
BEAD_PIECES = (
    Piece("j = 0, l = 2", {j: 0, p: 1, q: 1}, _BEAD - _HALF + 2 * phi + 9 * phi**2),
    *(
        Piece(
            f"j = 0, beside a leg ({steps} = 1)",
            {j: 0, steps: 1},
            _BEAD - 2 - 7 * phi / 2 - phi**2 / 2,
        )
        for steps in (p, q)
    ),
    Piece("j = 0, further inside", {j: 0}, _BEAD - 3 * (1 + phi) ** 2),
    Piece("j = 1, l = 3", {j: 1, p: 1, q: 1}, _BEAD + _BELOW + 4 * (1 + phi) ** 2),
    Piece("j = 1, l > 3", {j: 1}, _BEAD + 4 * (1 + phi) ** 2),
    Piece("j = 2, l = 4", {j: 2, p: 1, q: 1}, _BEAD + _BELOW - 3 * _HALF * (1 + phi) ** 2),
    Piece("j = 2, l > 4", {j: 2}, _BEAD - 3 * _HALF * (1 + phi) ** 2),
    Piece("j = l − 2 ≥ 3", {p: 1, q: 1}, _BEAD + _BELOW),
    Piece("j ≥ 3, every other bead of a face", {}, _BEAD),
)
LEG_PIECES = (
    Piece("j = 0, l = 1", {j: 0, p: 1}, 3 * _HALF * (1 + 4 * phi + 4 * phi**2)),
    Piece("j = 0, l = 2", {j: 0, p: 2}, _LEG - (5 + 14 * phi + 7 * phi**2) / 2),
    Piece("j = 0, l > 2", {j: 0}, _LEG - (5 + 14 * phi + 4 * phi**2) / 2),
    Piece("j = 1, l = 2", {j: 1, p: 1}, _LEG + 3 + 10 * phi - 15 * phi**2 / 2),
    Piece("j = 1, l > 2", {j: 1}, _LEG + 3 * (1 + phi)),
    Piece("j = l − 1 ≥ 2", {p: 1}, _LEG + 4 * phi * j + 3 * phi * (1 - 2 * phi)),
    Piece("2 ≤ j ≤ l − 2, on a leg", {}, _LEG),
)
LEG_FORCE_PIECES = (
    Piece("j = 0, l = 1", {j: 0, p: 1}, 2 - 2 * phi + 27 * phi**2 / 2 - 2 * phi**3 + 2 * phi**4),
    Piece("j = 0, l = 2", {j: 0, p: 2}, _LEG_FORCE - phi * (3 + 6 * phi + 4 * phi**2)),
    Piece("j = 0, l > 2", {j: 0}, _LEG_FORCE - phi * (6 + 9 * phi + 8 * phi**2) / 2),
    Piece("j = 1, l = 2", {j: 1, p: 1}, _LEG_FORCE + phi * (6 + 17 * phi - 12 * phi**2) / 2),
    Piece("j = 1, l > 2", {j: 1}, _LEG_FORCE + 3 * phi * (1 + phi)),
    Piece("j = l − 1 ≥ 2", {p: 1}, _LEG_FORCE + phi**2 * (4 * j + 3 - 6 * phi)),
    Piece("2 ≤ j ≤ l − 2, on a leg", {}, _LEG_FORCE),
)

_VARIANCE = power(times(sigma, 1 / r), 2)
_BELOW_LINE = 1 / ((1 - phi) ** 2 * (1 + 2 * phi) ** 2)
_OF_FACE = terms(1, times(2, phi), times(2, phi**2))
PRINTED = (
    equation(
        ON_FACE,
        times(
            _BELOW_LINE / 18,
            terms(times(_OF_FACE, terms(times(12, terms(j, q)), -9)), 3, phi**2),
            _VARIANCE,
        ),
    ),
    equation(
        BEAD,
        times(
            _BELOW_LINE / 9,
            terms(times(_OF_FACE, terms(times(6, terms(l, j)), -9)), 3, phi**2),
            _VARIANCE,
        ),
    ),
    equation(
        ON_LEG,
        times(
            _BELOW_LINE / 9,
            terms(
                times(2, terms(3, times(6, phi), times(5, phi**2)), l),
                times(4, j),
                minus(times(4, terms(1, phi, -(phi**2)))),
            ),
            _VARIANCE,
        ),
    ),
)

OWN, CROSS = 1 + phi, -phi
"""b^a·b^a and b^a·b^c of the reciprocal vectors, times (1−φ)(1+2φ)."""
Indices = dict[sympy.Symbol, Affine]


def _start(indices: Indices, region: Region) -> Weights:
    top = affine.ZERO
    for steps in indices.values():
        top = affine.add(top, steps)
    return Weights(region, top)


def _turn(form: Weights, leg: int, into: int, steps: Affine) -> None:
    """What turns from a leg into a face: b^a·(δn^c − δn^c below) at the leg's bead."""
    bead = down(leg, steps)
    for along, factor in ((into, OWN), (3 - leg - into, CROSS)):
        form.add_tilt(bead, leg, along, factor)
        form.add_tilt(up(bead, leg, -1), leg, along, -factor)


def face_contact(indices: Indices, region: Region) -> Weights:
    """The contact along 2 from O − p e_1 − q e_2, whose path turns at O − p e_1.

    All forms are times (1−φ)(1+2φ).
    """
    form = _start(indices, region)
    _turn(form, 0, 1, indices[p])
    return form


def face_bead(indices: Indices, region: Region) -> Weights:
    """Both upper contacts of that bead together."""
    form = face_contact(indices, region)
    _turn(form, 1, 0, indices[q])
    return form


def leg_force(indices: Indices, region: Region) -> Weights:
    """The contact along 1 from O − p e_1, less 1: the split at O, and its own tilt."""
    form = _start(indices, region)
    for other in (1, 2):
        first = down(other, affine.constant(1))
        form.add_tilt(first, other, 0, -OWN)
        form.add_tilt(first, other, 3 - other, -CROSS)
        form.add_tilt(down(0, indices[p]), 0, other, -CROSS)
    return form


def leg_contact(indices: Indices, region: Region) -> Weights:
    """Its vertical component over that of the ordered force, less 1."""
    form = leg_force(indices, region)
    for other in (1, 2):
        form.add_tilt(down(0, indices[p]), 0, other, 1 - phi)
    return form


IN_FACE, IN_LEG = {l: j + p + q}, {l: j + p}
ALL: dict[sympy.Symbol, tuple[pyramid.Build, tuple[Piece, ...], sympy.Expr]] = {
    ON_FACE: (face_contact, CONTACT_PIECES, UNIT / 9),
    BEAD: (face_bead, BEAD_PIECES, UNIT / 9),
    ON_LEG: (leg_contact, LEG_PIECES, UNIT / 9),
    LEG_MAGNITUDE: (leg_force, LEG_FORCE_PIECES, UNIT),
}
"""By quantity: its form, the closed forms of its squares, and their unit."""


def _lower(quantity: sympy.Symbol) -> dict[sympy.Symbol, int]:
    return {j: 0, p: 1} if quantity in (ON_LEG, LEG_MAGNITUDE) else {j: 0, p: 1, q: 1}


def _coordinates(quantity: sympy.Symbol) -> dict[sympy.Symbol, sympy.Expr]:
    return IN_LEG if quantity in (ON_LEG, LEG_MAGNITUDE) else IN_FACE


@cache
def cases(quantity: sympy.Symbol) -> tuple[Case, ...]:
    """Σ weight², r = 1, for all indices."""
    return tuple(pyramid.cases(ALL[quantity][0], _lower(quantity)))


@cache
def deep(quantity: sympy.Symbol) -> sympy.Expr:
    """The variance where no two of the form's beads coincide."""
    (found,) = (case.value for case in cases(quantity) if not case.at)
    return found.to_sympy() * ALL[quantity][2]


def _value(quantity: sympy.Symbol) -> Decide:
    known = {quantity: deep(quantity), **_coordinates(quantity)}
    return lambda _, candidate: decide_identity(*(side.xreplace(known) for side in candidate.args))


def decide(part: int, candidate: sympy.Eq) -> Ruling:
    """Compare with the squared weights."""
    quantity = PRINTED[part].lhs
    if candidate.lhs != quantity:
        return undecided("the left-hand side is not the variance that is meant")
    return _value(quantity)(0, candidate)


COSINE = Fraction(1, 5)


def search(candidate: sympy.Eq) -> str | None:
    """Squared weights of a small pyramid, by the recursion from bead to bead."""
    for layer, first, second in ((3, 2, 2), (3, 2, 3), (4, 3, 2)):
        other = 0 if candidate.lhs in (ON_LEG, LEG_MAGNITUDE) else second
        level = layer + first + other
        at: explicit.Values = {j: layer, p: first, q: other, l: level, phi: COSINE, sigma: 1, r: 1}
        true = _exact(candidate.lhs, level, first, other, COSINE)
        try:
            found = explicit.number(candidate.rhs, at)
        except explicit.AmbiguousError:
            return None
        if true is not None and found != true:
            return f"for j = {layer}, l = {level}, φ = {COSINE}: {found}, not {true}"
    return None


def _exact(
    quantity: sympy.Basic, level: int, first: int, other: int, cosine: Fraction
) -> Fraction | None:
    """The variance for σ = r = 1 by the recursion; None for what is none of the quantities."""
    bead = (first, other, 0)
    contacts = {
        ON_FACE: ((bead, 1),),
        BEAD: ((bead, 0), (bead, 1)),
        ON_LEG: ((bead, 0),),
        LEG_MAGNITUDE: ((bead, 0),),
    }.get(quantity)
    if contacts is None:
        return None
    whole = witnesses.response_variance(level, cosine, contacts, vertical=quantity == ON_LEG)
    return whole if quantity == LEG_MAGNITUDE else whole / 9


def at_finite_size() -> dict[str, ExactCase]:
    """The exact forms of a face's beads and contacts, and of a leg's."""

    def case(quantity: sympy.Symbol) -> ExactCase:
        _, pieces, unit = ALL[quantity]
        steps = {p: l - j} if _coordinates(quantity) is IN_LEG else {p: l - j - q}

        def put_in(piece: Piece) -> sympy.Expr:
            numbers = {symbol: sympy.Integer(value) for symbol, value in piece.at.items()}
            expression = piece.expression.xreplace({j: numbers[j]} if j in numbers else {})
            return sympy.together(expression) * unit  # one fraction: 5/2 alone is no whole number

        *edges, main = (
            Missed(
                piece.where,
                tuple(sympy.Eq(steps.get(s, s), value) for s, value in piece.at.items()),
                put_in(piece),
            )
            for piece in pieces
        )
        inside = [sympy.Ge(steps[p], 1), *([sympy.Ge(q, 1)] if steps[p].has(q) else [])]
        return ExactCase(quantity, main.where, main.expression, tuple(inside), tuple(edges))

    names = ("contact", "bead", "leg", "leg-force")
    return {name: case(quantity) for name, quantity in zip(names, ALL, strict=True)}


TILTS = tuple(
    Symbol(f"nu_{b}{place}", rf"\nu_{{{b}}}^{{{raised}}}", f"ν_{b}{prime}", real=True)
    for b in (2, 3)
    for place, raised, prime in (("", "", ""), ("_below", r"\prime", "′"))
)
TURNED = Symbol("turned", r"g_{12}", "g₁₂", real=True)


def _reciprocal() -> sympy.Matrix:
    """Products of the reciprocal vectors: the inverse of those of the base vectors."""
    gram = sympy.Matrix(3, 3, lambda a, b: 1 if a == b else phi)
    return gram.inv()


def steps() -> Iterator[Step]:
    """Where a force turns; what turns; squares."""
    nu_2, below_2, nu_3, below_3 = TILTS
    tilts = sympy.Matrix([0, nu_2 - below_2, nu_3 - below_3])
    yield Step(
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
        identity({TURNED: (_reciprocal() * tilts)[1]}),
        ("Eq. B11",),
    )
    yield Step(
        "It runs down a line of the face between both legs, and turns no more. A contact off legs "
        "and faces hangs below a contact that enters a face, or the cone, from outside, where "
        "there is nothing: it carries no force. In the face the bead p steps along 1 and q along "
        "2 below the load is in layer j:",
        equation(l, IN_FACE[l]),
        identity(IN_FACE),
        ("step 1",),
    )
    yield Step(
        "Both ν are differences of line sums down 2 and down 3, in the planes of these and of the "
        "leg, and of radii of the leg. Squared and summed, and with the share ⅓ of the vertical, "
        "one contact of a face has, but for j = 0 and q = 1,",
        PRINTED[0],
        _value(ON_FACE),
        ("Eq. B11", "step 1", "step 2"),
    )
    yield Step(
        "The vertical force of both contacts of the face on a bead: where lines of both cross, the "
        "products of their weights add up to zero, for j ≥ 3 and p + q ≥ 3. The layers j + q and "
        "j + p, where they turn, add up to l + j:",
        PRINTED[1],
        _value(BEAD),
        ("step 3",),
    )
    yield Step(
        "On a leg the sum telescopes: what is left is the split at the loaded bead and the tilt of "
        "the contact itself. Its vertical component, for 2 ≤ j ≤ l − 2:",
        PRINTED[2],
        _value(ON_LEG),
        ("Eq. B11", "step 1"),
    )
    yield Step(
        "The magnitude of that force, over its mean squared:",
        equation(LEG_MAGNITUDE, LEG_FORCE_PIECES[-1].expression * UNIT),
        _value(LEG_MAGNITUDE),
        ("step 5",),
    )


def _stated(quantity: sympy.Symbol) -> Callable[[], Ruling]:
    def rule() -> Ruling:
        found = cases(quantity)
        wrong = first_difference(ALL[quantity][1], found, FIELD.one, _coordinates(quantity))
        return from_test(
            wrong is None, f"{len(found)} cases, which cover all sites, agree", f"not so: {wrong}"
        )

    return rule


def _balances() -> Ruling:
    """The forces stated, at the loaded bead, at those of a leg, and at all others."""
    inverse = _reciprocal()
    contacts = ("here", "below", "first")
    dn = {
        (c, place): sympy.Matrix(
            [0 if b == c else sympy.Dummy(f"n{b}·dn{c} {place}") for b in range(3)]
        )
        for c, place in product(range(3), contacts)
    }

    def along(a: int, c: int, place: str) -> sympy.Expr:
        """b^a·δn^c of the contact of leg c at a place."""
        return (inverse * dn[c, place])[a]

    def leg(c: int, place: str) -> sympy.Expr:
        """Change of the force of leg c: the split at O, and the tilt of the contact."""
        others = sum(along(c, other, "first") for other in range(3) if other != c)
        return -others - along(c, c, place)

    found = []
    for a in range(3):
        split = -sum(along(a, c, "first") for c in range(3))
        found.append(decide_identity(leg(a, "first"), split))
        for c in range(3):
            turned = along(a, c, "here") - along(a, c, "below")
            if a == c:
                found.append(decide_identity(leg(c, "below") - leg(c, "here"), turned))
                continue
            third = 3 - a - c
            own, cross = inverse[a, a], inverse[a, third]
            change = dn[c, "here"] - dn[c, "below"]
            found.append(decide_identity(own * change[a] + cross * change[third], turned))
    return all_of(*found)


def _position() -> Ruling:
    """On a face p does not depend on where the bead lies, but for l + j, for j ≥ 3."""
    rest = [
        case
        for case in cases(BEAD)
        if case.lower.get(j, case.at.get(j, 0)) >= 3 and (case.at.get(p), case.at.get(q)) != (1, 1)
    ]
    stated = FIELD.from_sympy(_BEAD.xreplace(IN_FACE))
    return from_test(
        bool(rest) and all((case.value - case.put_in(stated)).is_zero() for case in rest),
        f"{len(rest)} cases with j ≥ 3, all but p = q = 1, depend on l + j alone",
    )


def _leading() -> Ruling:
    """What stands for κ² of discs, and that it does."""
    whole = SHARE / ((1 - phi) ** 2 * (1 + 2 * phi) ** 2)
    discs = eq16.PRINTED.rhs.doit() / (Rational(3, 2) * (l + j) * (sigma / r) ** 2)
    spheres, plane = (
        (b11.KAPPA**2 + (d - 2) * b11.CROSSED**2).xreplace({d: sympy.Integer(n)}) for n in (3, 2)
    )
    return all_of(decide_identity(spheres, whole), decide_identity(plane, discs))


def _squares(packing: SmallPacking) -> Ruling:
    cosine = witnesses.cosine_of(packing)
    values: explicit.Values = {phi: cosine, sigma: 1, r: 1}

    def pairs() -> Iterator[tuple[str, Fraction, Fraction]]:
        for layer, first, second in product(range(4), (1, 2, 3), (1, 2)):
            for quantity, (_, pieces, unit) in ALL.items():
                on_leg = _coordinates(quantity) is IN_LEG
                if on_leg and second > 1:
                    continue
                other = 0 if on_leg else second
                at = {j: layer, p: first, q: other, l: layer + first + other}
                piece = next(one for one in pieces if one.at.items() <= at.items())
                stated = explicit.number(piece.expression * unit, {**values, **at})
                true = _exact(quantity, at[l], first, other, cosine)
                if true is not None:
                    yield f"{quantity.name}, j = {layer}, p = {first}, q = {other}", stated, true

    return compare(pairs())


def _spheres(packing: SmallPacking) -> Ruling:
    cosine, level = witnesses.cosine_of(packing), 4
    drawn = list(packing.rho.values())
    beads = [u for u in product(range(level + 1), repeat=3) if sum(u) <= level]
    rho = {bead: drawn[place % len(drawn)] for place, bead in enumerate(beads)}
    exact = witnesses.response_of_spheres(cosine, level, rho)
    unit = (1 - cosine) * (1 + 2 * cosine)

    def force(bead: tuple[int, ...], axis: int) -> Fraction:
        """What the forms say: of legs and faces, and zero elsewhere."""
        others = [a for a in range(3) if a != axis and bead[a]]
        if not bead[axis] or len(others) > 1:
            return Fraction(0)
        # steps by the vectors 1, 2, 3 of the forms: the leg, the face, what is left
        leg = others[0] if others else axis
        order = [leg, *sorted((a for a in range(3) if a != leg), key=lambda a: a != axis)]
        build = face_contact if others else leg_force
        numbers = {j: level - sum(bead), p: bead[leg]} | ({q: bead[axis]} if others else {})
        indices = {symbol: affine.constant(value) for symbol, value in numbers.items()}
        total = Fraction(0)
        for place, weight in build(indices, Region({})).beads().items():
            at = dict(zip(order, place, strict=True))
            share = explicit.number(weight, {phi: cosine})
            total += share * rho[at[0], at[1], at[2]]
        return total / unit

    return compare(
        (f"from O − {bead} along {axis + 1}", force(bead, axis), true)
        for (bead, axis), true in exact.items()
        if min(bead) >= 0
    )


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
        (q, "steps of that contact from the leg where its path turns"),
        (p, "steps down the leg"),
        *usual(sigma, r),
        (phi, "mutual dot product of the three base vectors, −1/3 < φ < ½"),
    ),
    assumptions=(
        "every bead rests on three others, along base vectors with one mutual dot product φ",
        "the radii are independent, of zero mean and variance σ²",
        "first order in δr",
        "printed forms: p, q ≥ 1 and j + q ≥ 2; p, q ≥ 1, j ≥ 3 and l ≥ j + 3; 2 ≤ j ≤ l − 2. "
        "Exact forms: every site",
    ),
    premises=(eq16.DERIVATION, b11.DERIVATION),
    printed=PRINTED,
    domain=(sympy.Ge(j, 3), sympy.Ge(q, 1), sympy.Ge(l, j + q + 1), sympy.Ge(l, j + 3)),
    dimension=3,
    exact=at_finite_size,
    steps=steps,
    decide=decide,
    search=search,
    claims=(
        Claim(
            "the forces stated balance: at the loaded bead, on the legs, and, passed on unchanged, "
            "everywhere else; off legs and faces there are none",
            _balances,
        ),
        Claim("the exact variance of every contact of a face", _stated(ON_FACE)),
        Claim("the exact variance of p at every bead of a face", _stated(BEAD)),
        Claim("for j ≥ 3 it does not depend on the place along the face", _position),
        Claim("the exact variance on a leg, vertical", _stated(ON_LEG)),
        Claim("and of the magnitude there", _stated(LEG_MAGNITUDE)),
        Claim("κ² + κ′² takes the place of κ² = 1/(1−φ²)² of discs, ⅓ that of ½", _leading),
    ),
    witnesses=(
        Witness("squared weights by the recursion from bead to bead, as fractions", _squares),
        Witness(
            "exact packing of spheres with one load, l = 4: order ε¹ of every contact, and exact "
            "zeros off legs and faces",
            _spheres,
        ),
    ),
    remarks=(
        "Inside of the cone, off its three legs and three faces, no force is of first order: not "
        "on average, but in every packing. For discs the two legs enclose one face, and this face "
        "is all of the inside.",
    ),
)

if __name__ == "__main__":
    from force_diffusion.derivations.commands.alone import run_alone

    raise SystemExit(run_alone(DERIVATION))
