"""Printed equations as statements for the proof assistant Coq, in the words of ``proofs/Model.v``.

A statement is made from what a derivation prints, never typed: its formula symbol by symbol, its
index ranges from the assumptions, its sites from the left-hand side. What is written here is only
which hypotheses of ``Model.v`` an equation is about. Proofs are found by tactics in ``proofs/``.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import partial

import sympy
from force_diffusion.symbolic import symbols as sy
from force_diffusion.symbolic.mechanics.lattice import mirror, mirrored_relation
from force_diffusion.symbolic.mechanics.paths import IN_CONE

from ..framework.catalogue import Number, paper
from ..framework.record import Derivation, ExactCase
from .cases import LOADS, Case, Load, all_of, far, one_packing, random_packings
from .files import Companion, Statement
from .words import (
    EXPANSION,
    FIXED,
    HEIGHT,
    NotStatedError,
    atom,
    index,
    is_vector,
    operand,
    real,
    vector,
)


def ranges(derivation: Derivation) -> Iterator[str]:
    """What the domain of the printed equation says of the indices.

    Of an asymptotic one nothing: it is stated of every contact, with a bound.

    Raises:
        NotStatedError: it has no domain.
    """
    if derivation.where is None:
        raise NotStatedError(f"Eq. {derivation.number} has no domain")
    if derivation.where.limit is None:
        yield from map(_relation, derivation.where.relations)


def _relation(relation: sympy.Basic) -> str:
    left, right = map(index, relation.args)
    return f"({left} {relation.rel_op.replace('==', '=')} {right})%Z"


def _spoken_of(side: sympy.Expr) -> Iterator[str]:
    """Beads and contacts of the left-hand side: those of the packing."""
    for site in sorted(side.atoms(sy.SiteFunction), key=str):
        bead = isinstance(site, sy.DeltaR | sy.DeltaX | sy.Position | sy.Load)
        at = " ".join(atom(index(argument)) for argument in site.args)
        yield f"{'bead' if bead else 'contact'} M {at}"


def _to_first_order(equation: sympy.Eq) -> str:
    of_vectors = any(map(is_vector, equation.args))
    left, right = map(vector if of_vectors else real, equation.args)
    kind = "first_order_vector" if of_vectors else "first_order"
    return f"{kind}\n    (fun {EXPANSION} => {left})\n    (fun {EXPANSION} => {right})"


def _exactly(equation: sympy.Eq) -> str:
    """At ε = 0, or near it where something depends on ε."""
    left, right = map(vector, equation.args)
    kinds = {type(site).__name__ for site in equation.atoms(sy.SiteFunction)}
    if kinds <= set(FIXED):
        return f"{left} = {right}"
    return f"near (fun {EXPANSION} =>\n    {left} = {right})"


_OF_RHO = f"fun rho {EXPANSION} => let X := Xs rho in let F := Fs rho in"
_UNIT = "((sigma / r G) ^ 2 / (1 - phi G ^ 2) ^ 2)"

_STATISTICS = {
    "relative_variance": "relative_variance L f",
    "relative_deviation": "root_mean_square L f",
    "response": "variance L f / f_load ^ 2",
    "variance_plus": "relative_variance L f",
    "variance_minus": "relative_variance L f",
    "layers_covariance": "relative_covariance L f g",
}
"""Left-hand sides that are a statistic of a quantity f, by the name of their symbol."""


def _statistic(side: sympy.Expr) -> str:
    name = side.name if isinstance(side, sympy.Symbol) else ""
    if name not in _STATISTICS:
        raise NotStatedError(f"{side} is no statistic in the words of Model.v")
    return _STATISTICS[name]


def _up_to_variance(size: str) -> Callable[[sympy.Eq], str]:
    """Both sides to first order; the mean square of their difference is at most a size."""

    def conclude(equation: sympy.Eq) -> str:
        left, right = map(real, equation.args)
        return (
            "exists left right,\n"
            f"    linearised ({_OF_RHO} {left}) left /\\\n"
            f"    linearised ({_OF_RHO} {right}) right /\\\n"
            f"    expect L (fun rho => (left rho - right rho) ^ 2) <= {size} * {_UNIT}"
        )

    return conclude


def _near(quantity: str, size: str) -> Callable[[sympy.Eq], str]:
    """A statistic of f, which is a quantity to first order, is the right side up to a size."""

    def conclude(equation: sympy.Eq) -> str:
        return (
            f"exists f, linearised ({_OF_RHO} {quantity} {EXPANSION}) f /\\\n"
            f"    Rabs ({_statistic(equation.lhs)} - {operand(equation.rhs)}) <= {size} * {_UNIT}"
        )

    return conclude


def _of_its_branch(sizes: Mapping[str, str]) -> Callable[[sympy.Eq], str]:
    """The same for the force that the left-hand side names, with the size of that branch."""

    def conclude(equation: sympy.Eq) -> str:
        branch = getattr(equation.lhs, "name", "").removeprefix("variance_")
        if branch not in sizes:
            raise NotStatedError(f"{equation.lhs} is no variance of f⁺ or f⁻")
        return _near(f"f_{branch} F i j", sizes[branch])(equation)

    return conclude


def _of_both(first: sy.SiteFunction, second: sy.SiteFunction) -> Callable[[sympy.Eq], str]:
    """A statistic of two quantities, exactly."""

    def conclude(equation: sympy.Eq) -> str:
        return (
            "exists f g,\n"
            f"    linearised ({_OF_RHO} {real(first)}) f /\\\n"
            f"    linearised ({_OF_RHO} {real(second)}) g /\\\n"
            f"    {_statistic(equation.lhs)} = {real(equation.rhs)}"
        )

    return conclude


@dataclass(frozen=True)
class Frame:
    """What an equation is about, besides what its derivation says: ranges, sites and the load.

    Attributes:
        example: indices that obey all conditions, M first.
        conclude: what an equation says, given the hypotheses.
        conditions: on indices, besides ranges and sites.
        of_part: a condition for each of the printed equations, if they have any of their own.
        random: whether the packing is one of a family, with a law of the radii.
        reach: how many heights M on each side have to be free of a horizontal boundary.
    """

    example: dict[sympy.Symbol, int]
    conclude: Callable[[sympy.Eq], str] = _to_first_order
    conditions: tuple[str, ...] = ()
    of_part: tuple[str, ...] = ()
    random: bool = False
    reach: int = 1


_HIGH = 1_000_000  # so that what is of lower order is small
_BELOW = {sy.M: 7, sy.k: 6, sy.l: 6}
_AT = {sy.M: 7, sy.i: 1, sy.j: 3}
_EVERY_CONTACT = ("contact M i j", "(0 <= j)%Z", "(j < M)%Z")


_HIGH_UP = {sy.M: _HIGH, sy.i: 0, sy.j: 3 * _HIGH // 10}
_LEANING = "((2 * IZR M ^ 2 + IZR M) * {0} ^ 2 + 2 * IZR M * {0} + IZR M / 2)"


def _variance(size: str) -> Frame:
    return Frame(
        _HIGH_UP,
        _near("f_plus F i j", size),
        _EVERY_CONTACT,
        random=True,
    )


FRAMES: dict[Number, Frame] = {
    1: Frame(_AT, _exactly),
    2: Frame(_AT),
    3: Frame(_AT),
    4: Frame(_AT),
    5: Frame(_AT),
    6: Frame(_BELOW, _exactly),
    7: Frame(_BELOW),
    8: Frame({sy.M: 7, sy.site_r: 1, sy.site_s: 5}),
    9: Frame({**_BELOW, sy.i: 4, sy.j: 4}),
    10: Frame(
        {**_BELOW, sy.i: 5, sy.j: 1, sy.n: 2},
    ),
    11: Frame(_AT),
    12: Frame(_AT, _up_to_variance("29 * IZR M ^ 2"), random=True),
    13: _variance("(2 * IZR M ^ 2 + IZR M)"),
    14: _variance("(3 / 8 * IZR M ^ 2 + 5 / 4 * IZR M)"),
    16: Frame(
        {
            **{sy.M: 6 * _HIGH, sy.k: 2 * _HIGH, sy.l: 5 * _HIGH},
            **{sy.i: 0, sy.j: _HIGH, sy.p: 3 * _HIGH, sy.q: _HIGH},
        },
        _near("pressed_down X F i j", "47"),
        (
            *(f"({x.in_code} = {index(at)})%Z" for x, at in IN_CONE.items()),
            "bead M i j",
            "bead M k l",
        ),
        random=True,
    ),
    "B1": Frame(_AT, of_part=("0 < L_plus", "0 < L_minus")),
    "B2": Frame(
        _HIGH_UP,
        _of_its_branch({"plus": _LEANING.format("t"), "minus": _LEANING.format("(1 / t)")}),
        (*_EVERY_CONTACT, "0 < L_plus", "0 < L_minus"),
        random=True,
    ),
    "B12": Frame(
        {sy.M: 12, sy.i: 1, sy.j: 3, sy.l: 7},
        _of_both(sy.ForcePlus(sy.i, sy.j), sy.ForcePlus(sy.i + sy.l - sy.j, sy.l)),
        ("contact M i j",),
        random=True,
        reach=2,
    ),
}
MIRRORED = (8, 9, 10, 11)  # stated of f⁻, too
AVERAGES = 15  # the one equation about all layers together
STATED: tuple[Number, ...] = (*paper(), *(n for n in FRAMES if isinstance(n, str)))
"""Numbers of the equations that can be stated."""


_LAYERS = ("(1 <= M)%Z", "(0 <= j < M)%Z", "contact M (across j) j")


def _across_layers(load: Load) -> Case:
    """One contact of each layer, at ``across j`` in layer j."""
    return random_packings(
        "(across : Z -> Z)",
        (
            "(1 <= M)%Z",
            "(forall j, (0 <= j < M)%Z ->\n"
            "    contact M (across j) j /\\ (Z.abs (across j) + M + 2 <= W)%Z)",
        ),
        load,
        {"M": "3%Z", "W": "8%Z", "across": "(fun j => j)"},
    )


def _averages(derivation: Derivation, part: int, stated: sympy.Eq) -> str:
    """Eq. 15 for its loads: in proportion, by a constant that depends on φ alone."""
    first = derivation.printed[0]
    deviation = stated if part == 0 else first
    if part == 1 and getattr(stated.lhs, "name", "") != HEIGHT.name:
        raise NotStatedError(f"{stated.lhs} is no height")
    in_proportion = f"(c (phi G) * {operand(deviation.rhs)})"
    claims = []
    for load in derivation.loads:
        claim = "\n".join(
            (
                *_across_layers(LOADS[load]).before(),
                "  exists f, (forall j, (0 <= j < M)%Z ->",
                "      linearised (fun rho => f_plus (Fs rho) (across j) j) (f j)) /\\",
                f"    Rabs ({_statistic(deviation.lhs)} - {in_proportion}) "
                f"<= 10 / IZR M * {in_proportion}",
            )
        )
        if part == 0:
            claims.append(f"(exists c, constant c /\\\n{claim})")
        else:
            at_height = f"c (phi G) * {operand(first.rhs.xreplace({sy.M: HEIGHT}))}"
            claims.append(
                f"(exists c d, constant c /\\ constant d /\\ (\n{claim}) /\\\n"
                "  forall (G : lattice) (sigma M_star : R), 0 < sigma -> 0 < M_star ->\n"
                f"  (({at_height}) ^ 2 = 1 <-> M_star = d (phi G) * {operand(stated.rhs)}))"
            )
    return all_of(claims)


def statements(derivation: Derivation) -> list[Statement]:
    """The printed equations of a derivation in Coq, part by part, and what is stated beside them.

    Raises:
        NotStatedError: when there are no words for one.
    """
    made = _printed(derivation)
    if derivation.number in MIRRORED:
        made += _printed(mirror_image(derivation), mirrored=True)
    return [*made, *(one(derivation) for one in BESIDE.get(derivation.number, ()))]


def _printed(derivation: Derivation, *, mirrored: bool = False) -> list[Statement]:
    parts = range(len(derivation.printed))
    return [statement(derivation, part, mirrored=mirrored) for part in parts]


def mirror_image(derivation: Derivation) -> Derivation:
    """The same of the other branch: printed equations and domain."""
    if derivation.where is None:
        raise NotStatedError(f"Eq. {derivation.number} has no domain")
    relations = tuple(map(mirrored_relation, derivation.where.relations))
    return replace(
        derivation,
        printed=tuple(map(mirror, derivation.printed)),
        where=replace(derivation.where, relations=relations),
    )


def exact_statement(
    derivation: Derivation,
    exact: Mapping[str, ExactCase] | None = None,
    at: Mapping[sympy.Symbol, int] | None = None,
    *,
    branch: str = "plus",
) -> Statement:
    """State mean and variance of one contact's force in every layer, or others in their place.

    Of f⁻ those of f⁺ are stated, with 1/t for t.
    """
    forms = derivation.exact() if exact is None and derivation.exact else exact or {}
    part, other = (0, {}) if branch == "plus" else (1, {sy.t: 1 / sy.t})
    formula = derivation.printed[part]
    printed = statement(derivation, part, formula, at=at)
    mean = LOADS[derivation.loads[0]].mean.format(branch)
    layers: dict[tuple[str, ...], sympy.Expr] = {}
    for case in forms.values():
        domain = [_relation(one) for one in case.domain]
        missed = [[_relation(one) for one in other.when] for other in case.missed]
        layers[*domain, *(f"~ ({_and(one)})" for one in missed)] = case.expression
        layers |= {
            (*one,): small.expression for one, small in zip(missed, case.missed, strict=True)
        }
    statistic = _statistic(formula.lhs)
    claims = [
        f"exists f, linearised ({_OF_RHO} f_{branch} F i j {EXPANSION}) f",
        f"expect L f = {mean}",
        *(
            f"({' -> '.join(when)} ->\n    {statistic} = {real(is_.xreplace(other))})"
            for when, is_ in layers.items()
        ),
    ]
    every = " \\/\n  ".join(f"({_and(when)})" for when in layers)
    name = f"{printed.name}_exact"
    return replace(
        printed,
        name=name,
        disproof=printed.disproof.replace(f"pose proof {printed.name} ", f"pose proof {name} "),
        beside=None if exact is None else exact_statement(derivation),
        conclusion=" /\\\n    ".join(claims),
        tactic=f"{printed.tactic}_exact",
        companions=(
            *printed.companions,
            Companion("of_every_layer", f"forall M j : Z, (0 <= j < M)%Z ->\n  {every}", "lia."),
        ),
    )


def _nothing_else(derivation: Derivation, *, mirrored: bool = False) -> Statement:
    """Beside Eqs. 9 and 10: no other contact below a loaded bead bears a force to first order."""
    force, across = sy.ForcePlus(sy.i, sy.j), ("k - i", "i - k")
    at = {sy.M: 7, sy.k: 6, sy.l: 6, sy.i: 0, sy.j: 2}
    if mirrored:
        force, across, at = mirror(force), across[::-1], at | {sy.i: 12}
    outside = f"({across[0]} > l - j \\/ {across[1]} >= l - j)%Z"
    case = one_packing(at, ("bead M k l", "contact M i j", "(j < l)%Z", outside), LOADS["single"])
    return Statement(
        f"equation_{derivation.number}_else_nothing" + ("_mirrored" if mirrored else ""),
        case.before(),
        _to_first_order(sympy.Eq(force, sympy.S.Zero, evaluate=False)),
        "prove_nothing_else",
        (case.companion(),),
        disproof=case.disproof,
    )


def _second_differences(derivation: Derivation) -> Statement:
    """Beside Eq. 12: the variance of one Δ."""
    delta = real(sy.SecondDifference(sy.i, sy.j)).removesuffix(f" {EXPANSION}")
    window = "within W M (i - 2) j /\\ within W M i j /\\ within W M (i + 2) j"
    return Statement(
        f"equation_{derivation.number}_second_difference",
        ("  forall (sigma : R) (M W : Z) (L : law W M sigma) (i j : Z),", f"  {window} ->"),
        f"variance L (fun rho => {delta} 1) = 6 * sigma ^ 2",
        "prove_second_difference",
        (
            Companion(
                "is_about_something",
                f"forall sigma : R, exists (M W : Z) (L : law W M sigma) (i j : Z), {window}",
                "intros. destruct (law_exists 3 2 sigma) as [L _]. exists 2%Z, 3%Z, L, 0%Z, 0%Z.\n"
                "  unfold within, bead; lia.",
            ),
        ),
    )


def _maximum(derivation: Derivation) -> Statement:
    """Beside Eq. 14: the printed form is largest at z = 1/6, and there alone."""
    (printed,) = derivation.printed
    here, top = real(printed.rhs), real(printed.rhs.xreplace({sy.z: sympy.Rational(1, 6)}))
    return Statement(
        f"equation_{derivation.number}_maximum",
        (
            "  forall (G : lattice) (sigma : R) (M j : Z),",
            *("  0 < sigma ->", "  (0 <= j)%Z ->", "  (j < M)%Z ->"),
        ),
        f"{here} <= {top} /\\\n  ({here} = {top} -> (M = 6 * j)%Z)",
        "prove_maximum",
        (
            Companion(
                "is_about_something",
                "exists (G : lattice) (sigma : R) (M j : Z),\n"
                "  0 < sigma /\\ (0 <= j)%Z /\\ (j < M)%Z /\\ (M = 6 * j)%Z",
                "destruct some_lattice as [G _]. exists G, 1, 6%Z, 1%Z.\n"
                "  repeat split; (lia || lra).",
            ),
        ),
    )


BESIDE: dict[Number, tuple[Callable[[Derivation], Statement], ...]] = {
    10: (_nothing_else, partial(_nothing_else, mirrored=True)),
    12: (_second_differences,),
    13: (exact_statement,),
    14: (exact_statement, _maximum),
    "B2": (exact_statement, partial(exact_statement, branch="minus")),
}
"""What is stated beside the printed equations, besides their mirror images."""


def _and(conditions: Iterable[str]) -> str:
    return " /\\ ".join(conditions)


def statement(
    derivation: Derivation,
    part: int,
    equation: sympy.Eq | None = None,
    *,
    mirrored: bool = False,
    at: Mapping[sympy.Symbol, int] | None = None,
) -> Statement:
    """State a printed equation of a derivation, or a candidate in its place.

    Hypotheses are those of the printed equation, whatever the candidate says. Of a mirror image
    the example is mirrored, too; ``at`` are the indices of another one.

    Raises:
        NotStatedError: when there are no words for it.
    """
    printed = derivation.printed[part]
    stated = printed if equation is None else equation
    several = len(derivation.printed) > 1
    name = f"equation_{derivation.number}" + (f"_part_{part + 1}" if several else "")
    name += "_mirrored" if mirrored else ""
    tactic = f"prove_{derivation.number}"
    if derivation.number == AVERAGES:
        companions = [
            _across_layers(LOADS[one]).companion(f"{one}_is_about_something")
            for one in derivation.loads
        ]
        claims = _averages(derivation, part, stated)
        return Statement(name, (), claims, f"{tactic}_{part + 1}", (*companions,), about=_LAYERS)
    if derivation.number not in FRAMES:
        raise NotStatedError(f"Eq. {derivation.number} has no hypotheses in Model.v yet")
    frame = FRAMES[derivation.number]
    frame = replace(frame, example={**frame.example, **(at or {})})
    if mirrored and sy.k in frame.example:
        across = 2 * frame.example[sy.k] - frame.example[sy.i]
        frame = replace(frame, example={**frame.example, sy.i: across})
    strange = stated.free_symbols & set(sy.INDICES) - printed.free_symbols - set(frame.example)
    if strange:
        raise NotStatedError(f"{min(map(str, strange))} is no index of Eq. {derivation.number}")
    conditions = tuple(
        dict.fromkeys((*_spoken_of(printed.lhs), *ranges(derivation), *frame.conditions))
    )
    supposed = (*conditions, *frame.of_part[part : part + 1])
    load = LOADS[derivation.loads[0]] if derivation.loads else None
    if mirrored and load is LOADS["any"]:
        load = LOADS["any, mirrored"]
    indices = " ".join(symbol.in_code for symbol in frame.example if symbol != sy.M)
    if frame.random and load:
        values = {symbol.in_code: f"{value}%Z" for symbol, value in frame.example.items()}
        window = 2 + frame.reach * frame.example[sy.M] + abs(frame.example[sy.i])
        case = random_packings(
            f"({indices} : Z)",
            (*supposed, far(frame.reach)),
            load,
            {"M": values.pop("M"), "W": f"{window}%Z", **values},
        )
    else:
        case = one_packing(frame.example, supposed, load)
    of_statistic = frame.random and getattr(printed.lhs, "name", "") in _STATISTICS
    beside = statement(derivation, part) if of_statistic and equation is not None else None
    companions = [case.companion()]
    orders = [f"({index(low)} <= {index(high + 1)})%Z" for low, high in _bounds(stated)]
    if orders:
        companions.append(
            Companion(
                "sums_in_order",
                f"forall M {indices} : Z,\n  {all_of(conditions)} -> {all_of(orders)}",
                "site.",
            )
        )
    return Statement(
        name,
        case.before(),
        frame.conclude(stated),
        tactic,
        (*companions,),
        about=supposed,
        disproof=case.disproof.format(name) if beside or not frame.random else "",
        beside=beside,
    )


def _bounds(equation: sympy.Eq) -> Iterator[tuple[sympy.Expr, sympy.Expr]]:
    for total in sorted(equation.atoms(sympy.Sum), key=str):
        ((_, low, high),) = total.limits
        yield low, high
