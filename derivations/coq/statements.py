"""Printed equations as statements for the proof assistant Coq, in the words of ``proofs/Model.v``.

A statement is made from what a derivation prints, and never typed: its formula from the SymPy
object, its index ranges from the domain, its sites from the left-hand side. This module adds only
the hypotheses of ``Model.v`` that the equation needs. Tactics in ``proofs/`` find the proofs.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import partial

import sympy
from force_diffusion.symbolic import symbols as sy
from force_diffusion.symbolic.mechanics.lattice import mirror, mirrored_relation
from force_diffusion.symbolic.printing.structure import is_vector
from force_diffusion.symbolic.words import Style, parts

from ..framework.catalogue import Number
from ..framework.record import Derivation, Statement
from .files import Companion, CoqStatement
from .record import record
from .words import FIXED, HEIGHT, argument, index, words

_OF_RHO = "fun rho e => let X := Xs rho in let F := Fs rho in"
_UNIT = "((sigma / r G) ^ 2 / (1 - phi G ^ 2) ^ 2)"
_HORIZONTAL = (sy.i, sy.k, sy.site_r)
_IN_COQ = Style(index, " = ", " <= ", " >= ")
_IN_CONE = {sy.k: sy.i + sy.p - sy.q, sy.l: sy.j + sy.p + sy.q}
"""The loaded bead (k, l) seen from (i, j), p steps along n⁺ and q along n⁻ below it."""
_MIRRORED = (8, 9, 10, 11)  # stated of f⁻, too
_IN_EVERY_LAYER = (13, 14)  # whose exact forms are stated, too


def _all(conditions: Iterable[str]) -> str:
    return " /\\\n  ".join(conditions)


def _relation(relation: sympy.Basic) -> str:
    left, right = map(index, relation.args)
    return f"({left} {relation.rel_op.replace('==', '=')} {right})%Z"


# What a statement is about


@dataclass(frozen=True)
class CoqLoad:
    """A load in the words of ``Model.v``: what is quantified and supposed on its account.

    ``example`` is a value of the variable; ``mean`` the force of a contact in the ordered packing.
    """

    words: str
    mean: str = ""
    variable: str = "(f_load : R)"
    example: str = "5"
    supposed: tuple[str, ...] = ("0 < f_load",)


def _entered(entering: str, other: str, loaded: str) -> CoqLoad:
    """Any loads, but none on bead (r, s), which the force of one of its upper contacts enters."""
    alone = f"{other} F site_r site_s e = 0 /\\ {entering} F site_r site_s e <> 0"
    supposed = ("load site_r site_s = zero", f"near (fun e => {alone})")
    return CoqLoad("load", "", "(load : Z -> Z -> vector)", f"(single {loaded} 6 5)", supposed)


_SINGLE = ("loaded", "loaded vertically", "entering", "point")
LOADS = {
    **dict.fromkeys(_SINGLE, CoqLoad("single k l f_load")),
    "surface": CoqLoad("surface M f_load", "f_load / (2 * n_y G)"),
    "bulk": CoqLoad("bulk f_load", "(IZR M - IZR j) * (f_load / (2 * n_y G))"),
    "passing": _entered("f_plus", "f_minus", "2"),
    "passing, mirrored": _entered("f_minus", "f_plus", "(-2)"),
}


def _load(derivation: Derivation) -> CoqLoad | None:
    loading = derivation.domain.loading
    return LOADS[loading.name] if loading else None


def _about(
    numbers: str,
    example: Iterable[str],
    conditions: Iterable[str],
    load: CoqLoad | None,
    *,
    random: bool,
) -> tuple[tuple[str, ...], Companion]:
    """What stands before a conclusion, and that something obeys it: numbers for an example.

    If ``random`` it is a family of packings, one for each choice of the radii, and their law.
    """
    if random:
        given = "forall (G : lattice) (sigma : R), 0 < sigma ->"
        objects = "(L : law W M sigma) (Xs : radii -> centres) (Fs : radii -> forces)"
        packing, carries = "packing G M rho (Xs rho)", "carries M (Xs rho) ({}) (Fs rho)"
        packing, carries = (f"(forall rho, {hypothesis})" for hypothesis in (packing, carries))
    else:
        given, objects = "forall (G : lattice) (rho : radii),", "(X : centres)"
        packing, carries = "packing G M rho X", "carries M X ({}) F"
        objects += " (F : forces)" if load else ""
    hypotheses, values = [packing, *conditions], [*example]
    if load:
        hypotheses += [carries.format(load.words), *load.supposed]
        numbers, values = f"{numbers} {load.variable}", [*values, load.example]
    variables = f"{numbers}\n    {objects}"
    supposed = (f"  {hypothesis} ->" for hypothesis in hypotheses)
    before = (f"  {given}", f"  forall {variables},", *supposed)
    exists = f"  {given}\n  exists {variables},\n  {_all(hypotheses)}"
    proof = f"intros. exists {', '.join(values)}. something."
    return before, Companion("is_about_something", exists, proof)


# What it says


def _to_first_order(equation: sympy.Eq) -> str:
    kind = "first_order_vector" if is_vector(equation.lhs) else "first_order"
    left, right = map(words, equation.args)
    return f"{kind}\n    (fun e => {left})\n    (fun e => {right})"


def _exactly(equation: sympy.Eq) -> str:
    """At ε = 0, or near it where something depends on ε."""
    left, right = ("zero" if side == 0 else words(side) for side in equation.args)
    kinds = {type(site) for site in equation.atoms(sy.SiteFunction)}
    equality = f"{left} = {right}"
    return equality if kinds <= FIXED.keys() else f"near (fun e => {equality})"


def _up_to_variance(size: str, equation: sympy.Eq) -> str:
    """Both sides to first order; the mean square of their difference is at most a size."""
    left, right = map(words, equation.args)
    return (
        "exists left right,\n"
        f"    linearised ({_OF_RHO} {left}) left /\\\n"
        f"    linearised ({_OF_RHO} {right}) right /\\\n"
        f"    expect L (fun rho => (left rho - right rho) ^ 2) <= {size} * {_UNIT}"
    )


def _near(quantity: str, size: str, equation: sympy.Eq) -> str:
    """A statistic of f, which is a quantity to first order, is the right side up to a size."""
    return (
        f"exists f, linearised ({_OF_RHO} {quantity} e) f /\\\n"
        f"    Rabs ({words(equation.lhs)} - ({words(equation.rhs)})) <= {size} * {_UNIT}"
    )


_AT = {sy.M: 7, sy.i: 1, sy.j: 3}


@dataclass(frozen=True)
class Setting:
    """What an equation is about, besides what its derivation says: ranges, sites and the load.

    Attributes:
        example: indices that obey all conditions, M first.
        conclude: what an equation says, given the hypotheses.
        conditions: on indices, besides ranges and sites.
    """

    example: Mapping[sympy.Symbol, int] = field(default_factory=lambda: _AT)
    conclude: Callable[[sympy.Eq], str] = _to_first_order
    conditions: tuple[str, ...] = ()


def _variance(size: str) -> Setting:
    every_contact = ("contact M i j", "(0 <= j)%Z", "(j < M)%Z")
    conclude = partial(_near, "f_plus F i j", size)
    return Setting(_AT, conclude, every_contact)


_BELOW = {sy.M: 7, sy.k: 6, sy.l: 6}
_BELOW_AT_A_DISTANCE = {sy.M: 7, sy.k: 2, sy.l: 6, sy.i: 1, sy.j: 1, sy.p: 3, sy.q: 2}

SETTINGS: dict[Number, Setting] = {  # those of Eqs. 2 to 5 and 11 are the default
    1: Setting(conclude=_exactly),
    6: Setting(_BELOW, _exactly),
    7: Setting(_BELOW),
    8: Setting({sy.M: 7, sy.site_r: 1, sy.site_s: 5}),
    9: Setting({**_BELOW, sy.i: 4, sy.j: 4}),
    10: Setting({**_BELOW, sy.i: 5, sy.j: 1, sy.n: 2}),
    12: Setting(_AT, partial(_up_to_variance, "29 * IZR M ^ 2")),
    13: _variance("(2 * IZR M ^ 2 + IZR M)"),
    14: _variance("(3 / 8 * IZR M ^ 2 + 5 / 4 * IZR M)"),
    16: Setting(
        _BELOW_AT_A_DISTANCE,
        partial(_near, "pressed_down X F i j", "47"),
        (
            "(p >= 1)%Z",
            "(q >= 1)%Z",
            *(f"({x.in_code} = {index(at)})%Z" for x, at in _IN_CONE.items()),
            "bead M i j",
            "bead M k l",
        ),
    ),
}


def _spoken_of(side: sympy.Expr) -> Iterator[str]:
    """Beads and contacts of the left-hand side: those of the packing."""
    for site in sorted(side.atoms(sy.SiteFunction), key=str):
        bead = isinstance(site, sy.DeltaR | sy.DeltaX | sy.Position | sy.LoadForce)
        at = " ".join(argument(index(place)) for place in site.args)
        yield f"{'bead' if bead else 'contact'} M {at}"


def statement(derivation: Derivation, part: int, *, mirrored: bool = False) -> CoqStatement:
    """State a printed equation of a derivation, or its mirror image."""
    number, printed = derivation.number, derivation.printed[part]
    setting = SETTINGS.get(number, Setting())
    name = f"equation_{number}" + (f"_part_{part + 1}" if len(derivation.printed) > 1 else "")
    load = _load(derivation)
    example = dict(setting.example)
    if mirrored:
        name, printed = f"{name}_mirrored", mirror(printed)
        load = LOADS["passing, mirrored"] if load is LOADS["passing"] else load
        example |= {symbol: -example[symbol] for symbol in _HORIZONTAL if symbol in example}
    # an asymptotic equation is stated of every contact, with a bound, and of random radii
    random = derivation.domain.limit is not None
    relations = () if random else derivation.domain.relations
    ranges = map(_relation, map(mirrored_relation, relations) if mirrored else relations)
    sites = dict.fromkeys((*_spoken_of(printed.lhs), *ranges, *setting.conditions))
    free = "(Z.abs i + M + 2 <= W)%Z"  # no horizontal boundary is met within a height
    symbols, values = [symbol.in_code for symbol in example], [*example.values()]
    if random:
        symbols, values = [*symbols, "W"], [*values, example[sy.M] + abs(example[sy.i]) + 2]
    before, something = _about(
        f"({' '.join(symbols)} : Z)",
        [f"({value})%Z" for value in values],
        (*sites, *([free] if random else [])),
        load,
        random=random,
    )
    companions = [something]
    sums = (total.limits[0] for total in sorted(printed.atoms(sympy.Sum), key=str))
    if orders := [f"({index(low)} <= {index(high + 1)})%Z" for _, low, high in sums]:
        indices = " ".join(symbol.in_code for symbol in example)
        says = f"forall {indices} : Z,\n  {_all(sites)} -> {_all(orders)}"
        companions.append(Companion("sums_in_order", says, "site."))
    return CoqStatement(
        name, before, setting.conclude(printed), f"prove_{number}", (*companions,), (*sites,)
    )


def _averages(derivation: Derivation) -> CoqStatement:
    """Eq. 15 for its loads: in proportion, by constants that depend on φ alone."""
    deviation, height = derivation.printed
    proportional = f"(c (phi G) * ({words(deviation.rhs)}))"
    at_height = f"c (phi G) * ({words(deviation.rhs.xreplace({sy.M: HEIGHT}))})"
    layers = ("(1 <= M)%Z", "(0 <= j < M)%Z", "contact M (across j) j")
    claims, companions = [], []
    for load in derivation.exact_forms:
        free = "contact M (across j) j /\\ (Z.abs (across j) + M + 2 <= W)%Z"
        before, something = _about(
            "(M W : Z) (across : Z -> Z)",
            ("3%Z", "8%Z", "(fun j => j)"),
            ("(1 <= M)%Z", f"(forall j, (0 <= j < M)%Z -> {free})"),
            LOADS[load],
            random=True,
        )
        companions.append(replace(something, name=f"{load}_{something.name}"))
        claim = "\n".join(
            (
                "(exists c d, constant c /\\ constant d /\\ (",
                *before,
                "  exists f, (forall j, (0 <= j < M)%Z ->",
                "      linearised (fun rho => f_plus (Fs rho) (across j) j) (f j)) /\\",
                f"    Rabs ({words(deviation.lhs)} - {proportional})",
                f"      <= 10 / IZR M * {proportional})",
                "  /\\ forall (G : lattice) (sigma M_star : R), 0 < sigma -> 0 < M_star ->",
                f"  (({at_height}) ^ 2 = 1 <->",
                f"    {words(height.lhs)} = d (phi G) * ({words(height.rhs)})))",
            )
        )
        claims.append(claim)
    return CoqStatement("equation_15", (), _all(claims), "prove_15", (*companions,), layers)


# What is stated beside the printed equations


def _exact(derivation: Derivation) -> CoqStatement:
    """Mean and variance of one contact's force in every layer."""
    printed, load = statement(derivation, 0), _load(derivation)
    assert load is not None
    statistic = words(derivation.printed[0].lhs)
    (form,) = derivation.exact_forms.values()
    layers = {_all_of(part): piece.expr for piece in form.pieces for part in piece.where}
    claims = [
        f"exists f, linearised ({_OF_RHO} f_plus F i j e) f",
        f"expect L f = {load.mean}",
        *(f"({at} ->\n    {statistic} = {words(is_)})" for at, is_ in layers.items()),
    ]
    every = "forall M j : Z, (0 <= j < M)%Z ->\n  " + " \\/\n  ".join(layers)
    return replace(
        printed,
        name=f"{printed.name}_exact",
        conclusion=_all(claims),
        tactic=f"{printed.tactic}_exact",
        companions=(*printed.companions, Companion("of_every_layer", every, "lia.")),
    )


def _all_of(relations: Iterable[sympy.Basic]) -> str:
    return "(" + " /\\ ".join(f"({relation})%Z" for relation in parts(relations, _IN_COQ)) + ")"


def printed(derivation: Derivation) -> list[CoqStatement]:
    """The printed equations in Coq, part by part, and their mirror images."""
    if derivation.number == 15:
        return [_averages(derivation)]
    images = (False, True) if derivation.number in _MIRRORED else (False,)
    places = range(len(derivation.printed))
    return [statement(derivation, part, mirrored=image) for image in images for part in places]


def statements(derivation: Derivation) -> list[CoqStatement]:
    """The printed equations in Coq, and the statements that go with them."""
    beside = [_exact(derivation)] if derivation.number in _IN_EVERY_LAYER else []
    return [*printed(derivation), *beside]


def recorded(derivation: Statement) -> str:
    """What Coq said of the printed equations when it was last asked."""
    accepted = {made["number"]: made for made in record()["equations"] if made["accepted"]}
    certificate = accepted.get(derivation.number)
    if certificate is None or not isinstance(derivation, Derivation):
        return "not on record"
    theorems = {made.name: made.hash for made in printed(derivation)}
    if theorems.items() <= certificate["theorems"].items():
        return f"accepted by {certificate['checker']}"
    return "not asked since the equation changed"
