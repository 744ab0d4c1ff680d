"""Attacks on ``induct``: what is said of the origin is false but for 0."""

from collections.abc import Callable

import sympy
from force_diffusion.symbolic.as_printed import equation
from force_diffusion.symbolic.kernel import axioms, rules
from force_diffusion.symbolic.kernel.rules import Rule
from force_diffusion.symbolic.kernel.theorem import Supposition, Theorem
from force_diffusion.symbolic.kernel.where import Where
from force_diffusion.symbolic.symbols import DeltaR, M, k, l, p, q
from sympy import Eq, Integer

from .attack import ONE, another, attack, displaced, steps

# induct: what is said of the origin is false but for 0

STAYS = rules.rewrite(axioms.base())
COUNT = Where.of(q >= 0)


def _by_itself(moved: dict[sympy.Symbol, sympy.Expr]) -> Callable[[tuple[Theorem, ...]], Rule]:
    """A step that takes the statement itself from what is supposed."""

    def step(supposed: tuple[Theorem, ...]) -> Rule:
        return lambda formula, where: rules.follows(
            rules.instance(supposed[0], moved, where) if moved else supposed[0]
        )(formula, where)

    return step


def _supposed(supposed: tuple[Theorem, ...]) -> Rule:
    return rules.rewrite(*supposed)


def _by_shift(supposed: tuple[Theorem, ...]) -> Rule:
    return rules.in_terms_of({q: q - 1}, {q: q + 1}, Where.of(q >= 1), rules.follows(supposed[0]))


def _never(_supposed: tuple[Theorem, ...]) -> Rule:
    return rules.rewrite()


for name, size, where, over, start, base, step, false, refused in (
    ("no step", steps(q), COUNT, q, 0, STAYS, _never, "it moves at q = 1", "normal forms"),
    ("no base", q + 1, COUNT, q, 0, STAYS, _by_itself({}), "it moves at q = 0", "normal forms"),
    ("what is supposed for the next", steps(q), COUNT, q, 0, STAYS, _by_itself({q: q + 1}),
     "q − 1 says nothing of q", "does not hold there"),
    ("what is supposed in other indices", steps(q), COUNT, q, 0, STAYS, _by_shift,
     "q − 1 says nothing of q", "put elsewhere"),
    ("a start beyond the domain's", q * (q + 1) * (q - 1), Where.of(q >= -9), q, 0, STAYS,
     _supposed, "it moves at q = −5", "goes beyond"),
    ("an index that is none", steps(p), Where.of(p >= 0), q, 0, STAYS, _never,
     "it moves at p = 1", "goes beyond"),
    ("a step by a rule that proves another statement", steps(q), COUNT, q, 0, STAYS,
     lambda _: another, "it moves at q = 1", "another statement"),
    ("a base by a rule that proves another statement", q + 1, COUNT, q, 0, another,
     lambda _: another, "it moves at q = 0", "another statement"),
):  # fmt: skip
    attack("induct", name, false, refused)(
        lambda s=size, w=where, o=over, a=start, b=base, t=step: rules.induct(  # type: ignore[misc]
            o, Integer(a), b, t
        )(displaced(s), w)
    )


@attack("induct", "down, beyond its start", "it moves at q = 5", "goes beyond")
def _() -> object:
    rule = rules.induct(q, Integer(0), STAYS, _by_itself({}), down=True)
    return rule(displaced(q), COUNT)


@attack("induct", "down, from a start that is put elsewhere", "M + 1 is further up", "not hold")
def _() -> object:
    rule = rules.induct(p, M - 1, STAYS, _by_itself({M: M + 1}), down=True)
    return rule(displaced(steps(M - 1 - p)), Where.of(p >= 0, p <= M - 1))


@attack("induct", "a member of the family that is not proved", "radii differ", "normal forms")
def _() -> object:
    family = ((equation(DeltaR(k, l), 0), Where.of(l >= 0, q >= 0, indices=(k,))),)
    return rules.induct(q, Integer(0), STAYS, _never, family=family)(displaced(Integer(0)), COUNT)


@attack("induct", "one within another, at other places of the first", "it moves at 2", "within")
def _() -> object:
    def outer(supposed: tuple[Theorem, ...]) -> Rule:
        def first(formula: sympy.Eq, where: Where) -> Theorem:
            if Eq(q, 1) in where.relations:
                return STAYS(formula, where)
            return rules.follows(rules.instance(supposed[0], {p: ONE}, where))(formula, where)

        base = rules.cases(first, (Eq(q, 1),), (q >= 2,))
        return rules.induct(p, Integer(0), base, _by_itself({q: q + 1}))

    rule = rules.induct(q, Integer(0), rules.cases(STAYS, (Eq(p, 0),)), outer)
    return rule(displaced((p + q) * (p + q - 1)), Where.of(p >= 0, q >= 0, p <= 4 * q))


@attack("induct", "what was supposed in another one", "it holds in that one alone", "within")
def _() -> object:
    kept: list[Theorem] = []

    def leak(supposed: tuple[Theorem, ...]) -> Rule:
        kept.extend(supposed)
        return rules.rewrite(axioms.base())

    rules.induct(q, Integer(0), STAYS, leak)(displaced(Integer(0)), COUNT)
    wrong = rules.suppose(displaced(ONE), COUNT, Supposition(q), 1)
    step = rules.follows(wrong, kept[0])
    return rules.induct(q, Integer(1), STAYS, lambda _: step)(displaced(q - 1), Where.of(q >= 1))
